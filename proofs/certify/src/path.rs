//! From the numbers of a path to its segments in the plane, with 106 bits.

use crate::ball::{Ball, Real106};
use crate::distance_claim::SegmentCarrier;
use crate::double_double::DoubleDouble;
use crate::error::{CertifyError, InputPart};
use crate::plane::{BallCarrier, BallVector};
use crate::raw::{RawAngle, RawPath, RawSegment};

/// How far before the end of a segment a length is that rounding would put there, as a part of the segment: 2^-80.
const BELOW: f64 = 1.0 / (1_u128 << 80) as f64;
/// No number of a path is larger.
const MOST: f64 = 1e15;
/// No direction at a start is farther from 0 \[rad, or turns\]: 2^24, as in the library.
const MOST_HEADING: f64 = 16_777_216.0;
/// No length but 0, and no radius, is smaller \[m\]: so that the parts of a length that are told apart, as [`BELOW`], are numbers.
/// The library takes lengths below 1e-150 m as 0, and no radii below 1e-75 m.
pub(crate) const LEAST: f64 = 1e-200;

/// A segment in the plane, and its lengths along the path.
#[derive(Clone, Debug)]
pub struct PreparedSegment {
    /// In the plane.
    pub placed: SegmentCarrier,
    /// Exact length of the path before it \[m\].
    pub before: DoubleDouble,
    from: f64,
    to: f64,
    step: f64,
}

impl PreparedSegment {
    /// From the first to the last length of the number format in a part of the segment; none, if there is none.
    pub fn of_format(&self, [lo, hi]: [DoubleDouble; 2]) -> Option<[DoubleDouble; 2]> {
        if self.step == 0.0 {
            return Some([lo, hi]);
        }
        // A power of two, and lengths below 2^50 digits: nothing of this is rounded but the number that is looked at first.
        let steps = |length: DoubleDouble| length * (1.0 / self.step);
        let up = |steps: DoubleDouble| {
            let near = DoubleDouble::from(steps.to_f64().round());
            if near < steps { near + DoubleDouble::from(1.0) } else { near }
        };
        let (lo, hi) = (up(steps(lo)), -up(-steps(hi)));
        (lo <= hi).then(|| [lo, hi].map(|steps| steps * self.step))
    }

    /// Whether a length along the path is one of the number format.
    pub fn is_of_format(&self, length: f64) -> bool {
        is_multiple(length, self.step)
    }

    /// The length along the segment at a length along the path. An end is one if it is the same number as that of the segment.
    pub fn along(&self, length: f64) -> DoubleDouble {
        if length == self.from {
            DoubleDouble::ZERO
        } else if length == self.to {
            self.placed.length
        } else {
            // The rounding of `to` may put a length before it at the exact end, or beyond. It is none of the end all the same: what
            // ends there does not hold `to`.
            let below = self.placed.length - self.placed.length * BELOW;
            (DoubleDouble::from(length) - DoubleDouble::from(self.from)).clamp(DoubleDouble::ZERO, below)
        }
    }

    /// What of the segment lies between lengths along the path that need be no numbers of the table; none, if nothing does.
    pub fn common(&self, [lo, hi]: [DoubleDouble; 2]) -> Option<[DoubleDouble; 2]> {
        let (from, to) = (DoubleDouble::from(self.from), DoubleDouble::from(self.to));
        let along = |length: DoubleDouble| (length - from).clamp(DoubleDouble::ZERO, self.placed.length);
        if hi < from || to < lo {
            return None;
        }
        // All of it, whatever the sum of lengths is rounded to.
        Some([along(lo), if hi < to { along(hi) } else { self.placed.length }])
    }

    /// Whether a length along the path is on the segment.
    pub fn contains(&self, length: f64) -> bool {
        self.from <= length && length <= self.to
    }

    /// Which way an arc turns, of a line nothing.
    pub fn turns_left(&self) -> Option<bool> {
        match self.placed.exact {
            BallCarrier::Line { .. } => None,
            BallCarrier::Circle { left, .. } => Some(left),
        }
    }

    /// Whether it is an arc whose radius is a number, or differs from it by no more than another one does.
    pub fn turns_within(&self, number: Real106, other: Real106) -> bool {
        match self.placed.exact {
            BallCarrier::Line { .. } => false,
            BallCarrier::Circle { radius, .. } => (radius - number).abs().mid <= (other - number).abs().mid,
        }
    }

    /// The part of the segment between lengths along the path. Both ends of a segment that is too short for them to differ are
    /// the same number: then it is all of it.
    pub fn range(&self, [lo, hi]: [f64; 2]) -> [DoubleDouble; 2] {
        [self.along(lo), if hi == self.to { self.placed.length } else { self.along(hi) }]
    }

    /// The length along the path at a length along the segment, rounded.
    pub fn on_path(&self, length: DoubleDouble) -> f64 {
        (DoubleDouble::from(self.from) + length).to_f64().clamp(self.from, self.to)
    }
}

/// An angle \[rad\].
pub(crate) fn radians(angle: RawAngle) -> Real106 {
    match angle {
        RawAngle::Radians(angle) => Ball::from(angle),
        // The product is right within 2^-102 of itself, the constant within 2^-108.
        RawAngle::Turns(turns) => Ball { mid: DoubleDouble::TURN * (turns - turns.round()), err: 1e-30 },
    }
}

/// The unit vector in a direction: up to 2^25 rad the sine and cosine are as right as those of smaller angles (`twofold.rs`).
///
/// Always from the sum of all angles: a vector that is turned again and again has a bound that grows by up to √2 each time.
pub(crate) fn unit(heading: Real106) -> Result<BallVector<DoubleDouble>, CertifyError> {
    let allowed = 2.0 * MOST_HEADING;
    // What is no number is not within it either.
    if heading.to_f64().abs().partial_cmp(&allowed).is_none_or(std::cmp::Ordering::is_gt) {
        let (name, angle) = ("its direction of", heading.to_f64());
        return Err(CertifyError::AngleTooLarge { name, angle, unit: " rad", most: allowed });
    }
    let (sin, cos) = heading.mid.sin_cos();
    let err = heading.err + 8e-31;
    let [y, x] = [sin, cos].map(|mid| Ball { mid, err });
    Ok(BallVector { x, y })
}

fn fits(value: f64, name: &'static str) -> Result<(), CertifyError> {
    if value.abs() <= MOST { Ok(()) } else { Err(CertifyError::ValueOutOfRange(name, value)) }
}

/// The segments of a path.
///
/// # Errors
/// What is wrong with it.
pub fn stretches(path: &RawPath) -> Result<Vec<PreparedSegment>, CertifyError> {
    let [x, y] = path.start;
    fits(x, "x")?;
    fits(y, "y")?;
    // A power of two has no bit set in its fraction.
    let is_power = path.step.to_bits() << 12 == 0 && (2.0_f64.powi(-32)..=1.0).contains(&path.step);
    if path.step != 0.0 && !is_power {
        return Err(CertifyError::Step(path.step));
    }
    let (RawAngle::Radians(heading) | RawAngle::Turns(heading)) = path.heading;
    if heading.abs() > MOST_HEADING || heading.is_nan() {
        return Err(CertifyError::AngleTooLarge { name: "heading", angle: heading, unit: "", most: MOST_HEADING });
    }
    let mut heading = radians(path.heading);
    let mut at = BallVector { x: Ball::from(x), y: Ball::from(y) };
    let mut before = DoubleDouble::ZERO;
    let (mut stretches, mut sum) = (Vec::with_capacity(path.segments.len()), 0.0);
    for (place, segment) in path.segments.iter().enumerate() {
        let wrong = CertifyError::of(InputPart::Segment(place));
        checked(segment, sum).map_err(wrong)?;
        heading = segment.turns.iter().fold(heading, |heading, &by| heading + radians(by));
        let direction = unit(heading).map_err(wrong)?;
        let carrier = match segment.radius {
            None => BallCarrier::Line { start: at, along: direction },
            Some(bend) => {
                let (left, radius) = (bend > 0.0, Ball::from(bend.abs()));
                let to_centre = if left { direction.left() } else { direction.left().times(Ball::from(-1.0)) };
                let start = to_centre.times(Ball::from(-1.0));
                BallCarrier::Circle { centre: at + to_centre.times(radius), radius, start, left }
            }
        };
        let length = DoubleDouble::from(segment.length);
        let placed = SegmentCarrier::new(carrier, length);
        at = carrier.point(Ball::from(segment.length));
        if let Some(bend) = segment.radius {
            heading = heading + Ball::from(segment.length) / Ball::from(bend);
        }
        for (end, exact) in [(segment.from, before), (segment.to, before + length)] {
            let off = (DoubleDouble::from(end) - exact).abs().to_f64();
            // Whatever is no number is wrong.
            if off.partial_cmp(&path.rounding).is_none_or(std::cmp::Ordering::is_gt) {
                return Err(wrong(CertifyError::LengthsOff(off)));
            }
        }
        let step = path.step;
        if ![segment.length, segment.from, segment.to].into_iter().all(|length| is_multiple(length, step)) {
            return Err(wrong(CertifyError::NoMultiples(step)));
        }
        stretches.push(PreparedSegment { placed, before, from: segment.from, to: segment.to, step });
        (before, sum) = (before + length, segment.to);
    }
    if stretches.is_empty() { Err(CertifyError::NoSegments) } else { Ok(stretches) }
}

fn is_multiple(length: f64, step: f64) -> bool {
    step == 0.0 || (length / step).fract() == 0.0
}

fn checked(segment: &RawSegment, sum: f64) -> Result<(), CertifyError> {
    fits(segment.length, "length")?;
    fits(segment.radius.unwrap_or(1.0), "radius")?;
    if segment.length < 0.0 || segment.radius == Some(0.0) {
        return Err(CertifyError::LengthOrRadius);
    }
    for (name, value) in [("length", Some(segment.length)), ("radius", segment.radius)] {
        if let Some(value) = value.filter(|&value| value != 0.0 && value.abs() < LEAST) {
            return Err(CertifyError::TooSmall { name, value, least: LEAST });
        }
    }
    // A full turn rounded to the last digit of a format may be more: 13 digits for a radius of 2.
    if segment.radius.is_some_and(|radius| segment.length > 7.0 * radius.abs()) {
        return Err(CertifyError::MoreThanATurn);
    }
    if segment.from != sum || segment.to.is_nan() || segment.to < segment.from {
        return Err(CertifyError::SegmentGap);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn arcs(count: u32, radius: f64, length: f64, sum: impl Fn(u32) -> f64) -> Vec<PreparedSegment> {
        let segment = |k| RawSegment { length, radius: Some(radius), turns: vec![], from: sum(k), to: sum(k + 1) };
        let heading = RawAngle::Turns(0.1);
        stretches(&RawPath {
            start: [0.0; 2],
            heading,
            segments: (0..count).map(segment).collect(),
            rounding: 1e-9,
            step: 0.0,
        })
        .unwrap()
    }

    #[test]
    fn a_range_holds_all_of_a_segment_whose_ends_are_the_same_number() {
        let tiny = &arcs(1, 1e-9, 1e-16, |_| 0.0)[0];
        assert_eq!(tiny.range([0.0, 0.0]), [DoubleDouble::ZERO, DoubleDouble::from(1e-16)]);
    }

    #[test]
    fn what_is_no_number_is_no_path() {
        let segment = RawSegment { length: 1.0, radius: None, turns: vec![], from: 0.0, to: 1.0 };
        let path = RawPath {
            start: [0.0; 2],
            heading: RawAngle::Turns(0.0),
            segments: vec![segment],
            rounding: 0.0,
            step: 0.0,
        };
        assert!(stretches(&path).is_ok());
        let wrong = |change: &dyn Fn(&mut RawPath)| {
            let mut other = path.clone();
            change(&mut other);
            stretches(&other).is_err()
        };
        for nothing in [f64::NAN, f64::INFINITY, -f64::INFINITY] {
            assert!(wrong(&|path| path.start[1] = nothing));
            assert!(wrong(&|path| path.heading = RawAngle::Turns(nothing)));
            assert!(wrong(&|path| path.segments[0].length = nothing));
            assert!(wrong(&|path| path.segments[0].radius = Some(nothing)));
            assert!(wrong(&|path| path.segments[0].from = nothing));
            assert!(wrong(&|path| path.segments[0].to = nothing));
        }
        assert!(wrong(&|path| path.rounding = f64::NAN));
        assert!(wrong(&|path| path.step = f64::NAN));
    }

    #[test]
    fn paths_of_many_turns_are_where_they_are() {
        let line = |heading, turns: &[f64]| {
            let turns = turns.iter().map(|&by| RawAngle::Radians(by)).collect();
            let segments = vec![RawSegment { length: 1.0, radius: None, turns, from: 0.0, to: 1.0 }];
            let path = RawPath { start: [0.0; 2], heading, segments, rounding: 0.0, step: 0.0 };
            let stretch = stretches(&path)?.remove(0);
            Ok::<_, CertifyError>(stretch.placed.exact.point(Ball::from(1.0)))
        };
        // The sine to 32 digits, also of about the largest one and of the nearest to a quarter turn.
        let sines = [
            (6001.0, 0.529_517_469_867_720_9, -8.054_555_421_145_84e-18),
            (1e7, 0.420_547_793_190_782_5, -1.269_293_621_916_956e-17),
            (33_554_431.5, -0.753_687_567_558_517_7, 1.600_564_761_271_486e-17),
            (5_419_351.0, -3.820_047_507_089_660_5e-8, 3.304_751_899_610_767_4e-24),
        ];
        for (heading, sine, rest) in sines {
            let there = match line(RawAngle::Radians(heading), &[]) {
                Ok(there) => there,
                Err(refused) => {
                    let allowed = "heading 33554431.5 is out of range; allowed is up to 1.6777216e7 in magnitude";
                    assert_eq!(refused.to_string(), allowed);
                    line(RawAngle::Radians(0.5 * heading), &[0.5 * heading]).unwrap()
                }
            };
            let off = there.y - Ball::from(sine) - Ball::from(rest);
            assert!(off.to_f64().abs() <= there.y.err && there.y.err < 1e-23, "{heading}: {there:?}");
        }
        // Nothing is told of what is beyond, and it is named.
        let refused = line(RawAngle::Radians(0.0), &[2e7, 2e7]).unwrap_err();
        let allowed = "its direction of 40000000 rad is out of range; allowed is up to 3.3554432e7 in magnitude";
        assert_eq!(refused.to_string(), format!("segment 0: {allowed}"));
        assert!(line(RawAngle::Radians(0.0), &[f64::NAN]).is_err());
    }

    #[test]
    fn what_is_all_but_nothing_is_no_length_and_no_radius() {
        let path = |length: f64, radius| RawPath {
            start: [0.0; 2],
            heading: RawAngle::Turns(0.0),
            segments: vec![RawSegment { length, radius, turns: vec![], from: 0.0, to: length }],
            rounding: 0.0,
            step: 0.0,
        };
        for (length, radius) in [(0.0, None), (1e-150, None), (0.0, Some(1e-75)), (1e-75, Some(-1e-75))] {
            assert!(stretches(&path(length, radius)).is_ok(), "{length} {radius:?}");
        }
        // The quotient of the first two is right within 2^-13 only.
        for (length, radius) in [(8.7e-316, Some(3.3e-316)), (1e-250, None), (0.0, Some(-1e-201))] {
            let refused = stretches(&path(length, radius)).unwrap_err().to_string();
            assert!(refused.contains("is out of range; the least one is 1e-200"), "{refused}");
        }
    }

    #[test]
    fn bounds_stay_small_on_paths_of_a_thousand_arcs() {
        let BallCarrier::Circle { centre, .. } = arcs(1000, 1.5, 1.0, f64::from)[999].placed.exact else { panic!() };
        assert!(centre.x.err.max(centre.y.err) < 1e-22, "{centre:?}");
    }
}
