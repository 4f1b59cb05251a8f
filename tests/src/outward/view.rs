//! The checks of an ordered pair.

use super::search::{bisect, descend, valley};
use super::{Seen, Violation};
use crate::exact::{DoubleDouble, Route, Travel};
use crate::generators::Dice;
use crate::neighbour::neighbour;
use crate::oracle::line;
use pcr_core::{Interval, Motion, RegionRef};
use pcr_planning::fleet::HostScalar;

macro_rules! ensure {
    ($condition:expr, $($message:tt)+) => {
        let holds: bool = $condition;
        if !holds {
            return Err(format!($($message)+));
        }
    };
}

/// An ordered pair: the ego first.
pub(super) struct View<'a, S: HostScalar> {
    pub(super) motions: [&'a Motion<'a, S>; 2],
    pub(super) routes: [&'a Route; 2],
    pub(super) travel: Travel,
    pub(super) radius: DoubleDouble,
    pub(super) doubt: f64,
    pub(super) regions: Vec<RegionRef<'a, S>>,
    /// Stated excess of these regions \[m\].
    pub(super) excess: f64,
}

/// What 106 bits may be off at this magnitude.
fn noise(value: DoubleDouble) -> DoubleDouble {
    value.abs() * 1e-28
}

impl<'a, S: HostScalar> View<'a, S> {
    /// Signed distance from contact at a length of the other's path and one of the ego's \[m\].
    fn exact(&self, s: DoubleDouble, l: DoubleDouble, seen: &mut Seen) -> f64 {
        seen.decided += 1;
        let (p, q) = (self.routes[0].at(l), self.routes[1].at(s));
        let [x, y] = [p[0] - q[0], p[1] - q[1]];
        ((x * x + y * y).sqrt() - self.radius).to_f64()
    }

    /// The same, off by the doubt at most.
    fn near(&self, s: f64, l: f64) -> f64 {
        let (p, q) = (self.routes[0].near(l.into()), self.routes[1].near(s.into()));
        (p[0] - q[0]).hypot(p[1] - q[1]) - self.radius.to_f64()
    }

    /// The side of `threshold` on which the clearance lies, exactly: whether it is above.
    fn above(&self, s: DoubleDouble, l: DoubleDouble, threshold: f64, seen: &mut Seen) -> bool {
        let rough = self.near(s.to_f64(), l.to_f64()) - threshold;
        if rough.abs() > self.doubt { rough > 0.0 } else { self.exact(s, l, seen) > threshold }
    }

    fn lengths(&self) -> [f64; 2] {
        self.motions.map(|motion| motion.path().length().to_f64())
    }

    /// One point in time and length, as the format writes it, against all regions.
    fn point(&self, time: S, length: S, seen: &mut Seen) -> Result<(), Violation> {
        let length = length.clamp(S::ZERO, self.motions[0].path().length());
        let s = self.travel.length_at(time.to_f64().into());
        let l = DoubleDouble::from(length.to_f64());
        let mut holding = self.regions.iter().filter(|region| region.contains(time, length)).peekable();
        if !self.above(s, l, 0.0, seen) {
            seen.inside += 1;
            if holding.peek().is_none() {
                return Err(format!(
                    "lost: ({time:?}, {length:?}) is {:e} of {:e} deep",
                    -self.exact(s, l, seen),
                    self.excess
                ));
            }
            // Two regions that end at a joint may both have the point, as the time is rounded; one of them has all of it.
            let found: Vec<_> = holding.map(|holder| self.tells(holder, length, s)).collect();
            if let (true, Some(problem)) = (found.iter().all(Result::is_err), found.into_iter().find(Result::is_err)) {
                return problem;
            }
        } else if self.above(s, l, self.excess, seen) {
            seen.outside += 1;
            ensure!(
                holding.peek().is_none(),
                "invented: ({time:?}, {length:?}) is {:e} clear, excess {:e}",
                self.exact(s, l, seen),
                self.excess
            );
        }
        Ok(())
    }

    /// Whether the ranges of a region hold a point of it, at the exact length `s` of the other path.
    fn tells(&self, holder: &RegionRef<'_, S>, length: S, s: DoubleDouble) -> Result<(), Violation> {
        ensure!(holder.length().contains(length), "{length:?} is outside the length range {:?}", holder.length());
        let range = holder.other_length();
        let end = self.lengths()[1];
        ensure!(
            DoubleDouble::from(range.lo.to_f64()) <= s && (s <= range.hi.to_f64().into() || range.hi.to_f64() >= end),
            "{s:?} is outside the length range {range:?}"
        );
        let [first, last] = self.travel.times_at(s);
        let range = holder.time();
        ensure!(
            DoubleDouble::from(range.lo.to_f64()) - noise(first) <= first
                && last <= DoubleDouble::from(range.hi.to_f64()) + noise(last),
            "{first:?} to {last:?} is outside the time range {range:?}"
        );
        Ok(())
    }

    /// Both sides of the ends of slices, and the middles of them.
    pub(super) fn slices(&self, dice: &mut Dice, seen: &mut Seen) -> Result<(), Violation> {
        for region in &self.regions {
            let range = region.time();
            // At one end of it, and anywhere.
            for part in [dice.below(2) as f64, dice.face()] {
                let time = range.lo.to_f64() + part * (range.hi.to_f64() - range.lo.to_f64());
                let time = S::from_f64(time).clamp(range.lo, range.hi);
                let s = self.travel.length_at(time.to_f64().into());
                for slice in region.slice_at(time) {
                    self.slice(region, time, s, slice, seen)?;
                }
            }
        }
        Ok(())
    }

    fn slice(
        &self,
        region: &RegionRef<'a, S>,
        time: S,
        s: DoubleDouble,
        slice: Interval<S>,
        seen: &mut Seen,
    ) -> Result<(), Violation> {
        for (end, above) in [(slice.lo, false), (slice.hi, true)] {
            let clearance = self.exact(s, end.to_f64().into(), seen);
            seen.excess = seen.excess.max(clearance / self.excess);
            ensure!(clearance <= self.excess, "{slice:?} at {time:?} is {clearance:e} clear, excess {:e}", self.excess);
            let next = neighbour(end, above);
            if next < S::ZERO || next > self.motions[0].path().length() {
                continue;
            }
            let elsewhere = self.regions.iter().any(|region| region.contains(time, next));
            if !elsewhere {
                seen.margin = seen.margin.min(clearance / self.excess);
                ensure!(
                    clearance > 0.0 || self.exact(s, next.to_f64().into(), seen) > 0.0,
                    "lost: beyond {slice:?} at {time:?}, {:e} of {:e} deep; lengths {:?} {:?}",
                    -clearance,
                    self.excess,
                    region.length(),
                    region.other_length()
                );
            }
        }
        self.point(time, slice.middle(), seen)
    }

    /// Points on both sides of the boundary.
    pub(super) fn points(&self, dice: &mut Dice, seen: &mut Seen) -> Result<(), Violation> {
        const SAMPLES: usize = 8;
        const WALKS: usize = 2;
        let [ego, other] = self.lengths();
        let [departure, arrival] = self.travel.time().map(DoubleDouble::to_f64);
        let span = arrival - departure;
        // In time, and a little before and after the travel.
        let at = |t: f64| self.travel.length_at(t.into()).to_f64();
        let points: Vec<[f64; 2]> = (0..SAMPLES)
            .map(|_| {
                let part = dice.range(-0.05, 1.05);
                [departure + part * span, dice.face() * ego]
            })
            .collect();
        for &[t, l] in &points {
            self.point(S::from_f64(t), S::from_f64(l), seen)?;
        }
        let value = |p: [f64; 2]| self.near(at(p[0]), p[1]);
        let deepest = points.iter().copied().min_by(|a, b| value(*a).total_cmp(&value(*b))).expect("samples");
        let deepest = if value(deepest) > 0.0 {
            let [s, l] = descend(|[s, l]| self.near(s, l), [at(deepest[0]), deepest[1]], [other, ego]);
            let [first, last] = self.travel.times_at(s.into()).map(DoubleDouble::to_f64);
            let t = first + 0.5 * (last - first);
            self.around([t, l], seen)?;
            [t, l]
        } else {
            deepest
        };
        for threshold in [0.0, 1.02 * self.excess] {
            if value(deepest) > threshold {
                break;
            }
            for &target in points.iter().take(WALKS) {
                if value(target) > threshold {
                    self.around(bisect(value, deepest, target, threshold), seen)?;
                }
            }
        }
        Ok(())
    }

    /// The numbers of the format about a point.
    fn around(&self, [t, l]: [f64; 2], seen: &mut Seen) -> Result<(), Violation> {
        let (time, length) = (S::from_f64(t), S::from_f64(l));
        self.point(time, length, seen)?;
        for above in [false, true] {
            self.point(neighbour(time, above), length, seen)?;
            self.point(time, neighbour(length, above), seen)?;
        }
        Ok(())
    }

    /// The ends of ranges are within the excess of a collision; times are those of the lengths, rounded outward.
    pub(super) fn ranges(&self, dice: &mut Dice, seen: &mut Seen) -> Result<(), Violation> {
        let exact = |value: S| DoubleDouble::from(value.to_f64());
        // A time may be off by its own rounding, and by that of a length: where the agent is slow that is more.
        let (allowed, half) = (exact(self.motions[1].time_excess()), DoubleDouble::from(0.5 * self.excess));
        for region in &self.regions {
            let (s, l, time) = (region.other_length(), region.length(), region.time());
            // The end of the path is where the library sums it up to.
            let end =
                if s.hi >= self.motions[1].path().length() { self.routes[1].length() + half } else { exact(s.hi) };
            let first = [exact(s.lo) - half, exact(s.lo) + half].map(|s| self.travel.times_at(s)[0]);
            let last = [end - half, end + half].map(|s| self.travel.times_at(s)[1]);
            ensure!(
                first[0] - allowed <= exact(time.lo) && exact(time.lo) <= first[1] + noise(first[1]),
                "{time:?} does not begin with {s:?}, between {first:?}"
            );
            ensure!(
                last[0] - noise(last[0]) <= exact(time.hi) && exact(time.hi) <= last[1] + allowed,
                "{time:?} does not end with {s:?}, between {last:?}"
            );
            let [s, l] = [s, l].map(|range| [range.lo.to_f64(), range.hi.to_f64()]);
            // One end of either range. Along paths that only just touch, rounding may find the ends of the two ranges at
            // different places: no further apart than the ranges are long.
            let [ego, other] = self.lengths();
            let beyond = |[lo, hi]: [f64; 2], by: [f64; 2], whole: f64| {
                [(lo - (by[1] - by[0])).max(0.0), (hi + (by[1] - by[0])).min(whole)]
            };
            let end = s[dice.below(2)];
            self.reaches(|l| [end, l], l, beyond(l, s, ego), seen)?;
            let end = l[dice.below(2)];
            self.reaches(|s| [s, end], s, beyond(s, l, other), seen)?;
        }
        Ok(())
    }

    /// Somewhere on the line the clearance is at most the excess: it is looked for between `lo` and `hi`, and missed
    /// only if it is not between `least` and `most` either.
    fn reaches(
        &self,
        at: impl Fn(f64) -> [f64; 2],
        [lo, hi]: [f64; 2],
        [least, most]: [f64; 2],
        seen: &mut Seen,
    ) -> Result<(), Violation> {
        const SAMPLES: u32 = 12;
        let value = |x: f64| {
            let [s, l] = at(x);
            self.near(s, l)
        };
        let sample = |k: u32| lo + (hi - lo) * f64::from(k) / f64::from(SAMPLES);
        let best = (0..=SAMPLES).map(sample).min_by(|a, b| value(*a).total_cmp(&value(*b))).expect("samples");
        let step = (hi - lo) / f64::from(SAMPLES);
        let best = valley(value, (best - step).max(lo), (best + step).min(hi));
        let [s, l] = at(best);
        if self.above(s.into(), l.into(), self.excess, seen) {
            // Sampling may have looked in the wrong place; this is certain, but for what `f64` may be off.
            let reached = line::reaches(value, least, most, self.excess + self.doubt, 0.1 * self.excess);
            ensure!(reached, "the range ends at {:?}, {:e} clear, excess {:e}", at(best), value(best), self.excess);
        }
        Ok(())
    }
}
