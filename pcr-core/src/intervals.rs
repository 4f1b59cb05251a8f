//! Unions and gaps of intervals, computed on demand and without storage.

use crate::geometry::Interval;
use crate::scalar::Scalar;

/// The union of intervals, which may be in any order, as disjoint intervals in increasing order. Cost of each interval
/// of the union: one pass over the intervals, and one more each time that it has grown to one that came too early.
///
/// ```
/// use pcr_core::{Interval, gaps, union};
/// let intervals = [(3.0, 4.0), (0.5, 1.0), (3.5, 6.0), (1.0, 2.0)].map(|(lo, hi)| Interval::new(lo, hi));
/// assert!(union(intervals.into_iter()).eq([Interval::new(0.5, 2.0), Interval::new(3.0, 6.0)]));
/// let gaps = gaps(union(intervals.into_iter()), Interval::new(0.0, 5.0));
/// assert!(gaps.eq([Interval::new(0.0, 0.5), Interval::new(2.0, 3.0)]));
/// ```
pub fn union<S: Scalar, I: Iterator<Item = Interval<S>> + Clone>(intervals: I) -> Union<S, I> {
    Union { intervals, after: None }
}

/// The gaps between disjoint intervals, which are in increasing order, within the interval `within`. The ends of a gap
/// are equal to ends of its neighbours; gaps of length 0 are left out. A `within` of length 0 is a gap if no interval
/// contains it.
pub fn gaps<S: Scalar, I: Iterator<Item = Interval<S>>>(intervals: I, within: Interval<S>) -> Gaps<S, I> {
    Gaps { intervals, rest: Some(within) }
}

/// Iterator of [`union`].
#[derive(Clone, Debug)]
pub struct Union<S, I> {
    intervals: I,
    after: Option<S>,
}

#[cfg(feature = "defmt")]
impl<S: defmt::Format, I> defmt::Format for Union<S, I> {
    fn format(&self, f: defmt::Formatter<'_>) {
        defmt::write!(f, "disjoint intervals after {}", self.after);
    }
}

impl<S: Scalar, I: Iterator<Item = Interval<S>> + Clone> Iterator for Union<S, I> {
    type Item = Interval<S>;

    fn next(&mut self) -> Option<Interval<S>> {
        LowestInterval::next(&mut self.after, |lowest| {
            self.intervals.clone().map(whole).for_each(|interval| lowest.add(interval));
        })
    }
}

/// Reversed ends are swapped, and an end that is NaN counts as unbounded: nothing is reported as free by mistake, and the
/// iteration ends.
fn whole<S: Scalar>(interval: Interval<S>) -> Interval<S> {
    if interval.lo <= interval.hi { interval } else { interval.limited() }
}

/// The lowest interval of a union, while its intervals come one by one in any order.
pub(crate) struct LowestInterval<S> {
    /// End of the part of the union that is known already.
    pub(crate) after: Option<S>,
    pub(crate) found: Option<Interval<S>>,
    /// The lowest begin of the intervals that were above what had been found.
    above: Option<S>,
}

impl<S: Scalar> LowestInterval<S> {
    /// The next interval of a union, of which all is known up to `after`. Each call of `pass` adds all intervals,
    /// or at least those from `after` to the end of what has been found.
    pub(crate) fn next(after: &mut Option<S>, mut pass: impl FnMut(&mut Self)) -> Option<Interval<S>> {
        let mut lowest = Self { after: *after, found: None, above: None };
        loop {
            pass(&mut lowest);
            let (found, above) = (lowest.found?, lowest.above.take());
            // What was above it when it came may belong to it now.
            if above.is_none_or(|above| found.hi < above) {
                *after = Some(found.hi);
                return Some(found);
            }
        }
    }

    pub(crate) fn add(&mut self, interval: Interval<S>) {
        if self.after.is_some_and(|after| interval.lo <= after) {
            return;
        }
        let Some(found) = self.found else {
            self.found = Some(interval);
            return;
        };
        if found.meets(interval) {
            self.found = Some(found.hull(interval));
            return;
        }
        let (lower, upper) = if interval.lo < found.lo { (interval, found) } else { (found, interval) };
        self.found = Some(lower);
        self.is_below(upper.lo);
    }

    /// Whether intervals from `lo` on neither meet what has been found nor are lower; if so, they need not be added.
    pub(crate) fn is_below(&mut self, lo: S) -> bool {
        let below = self.found.is_some_and(|found| found.hi < lo);
        if below {
            self.above = Some(self.above.map_or(lo, |above| above.min(lo)));
        }
        below
    }
}

/// Iterator of [`gaps`].
#[derive(Clone, Debug)]
pub struct Gaps<S, I> {
    intervals: I,
    /// The part that has not been examined yet.
    rest: Option<Interval<S>>,
}

#[cfg(feature = "defmt")]
impl<S: defmt::Format, I> defmt::Format for Gaps<S, I> {
    fn format(&self, f: defmt::Formatter<'_>) {
        defmt::write!(f, "gaps in {}", self.rest);
    }
}

impl<S: Scalar, I: Iterator<Item = Interval<S>>> Iterator for Gaps<S, I> {
    type Item = Interval<S>;

    fn next(&mut self) -> Option<Interval<S>> {
        loop {
            let rest = self.rest.take()?;
            let Some(interval) = self.intervals.next().map(whole).filter(|interval| interval.lo <= rest.hi) else {
                return (rest.lo <= rest.hi).then_some(rest);
            };
            let after = Interval::new(rest.lo.max(interval.hi), rest.hi);
            self.rest = Some(after).filter(|after| after.lo < after.hi || interval.hi < rest.lo);
            if rest.lo < interval.lo {
                return Some(Interval::new(rest.lo, interval.lo));
            }
        }
    }
}

#[cfg(all(test, feature = "libm"))]
mod tests {
    use super::*;
    use core::cell::Cell;

    /// The number of parts of a union, their length, and how often an interval was looked at.
    fn looked_at(intervals: impl Iterator<Item = i32> + Clone) -> (usize, f64, usize) {
        let looks = Cell::new(0);
        let counted = intervals.map(|lo| {
            looks.set(looks.get() + 1);
            Interval::new(f64::from(lo), f64::from(lo + 1))
        });
        let (parts, length) = union(counted).fold((0, 0.0), |(parts, sum), part| (parts + 1, sum + part.length()));
        (parts, length, looks.get())
    }

    #[test]
    fn a_part_of_a_union_takes_one_pass_and_one_more_for_those_that_came_too_early() {
        // Each interval begins where the one before it ends. The last pass finds nothing.
        assert_eq!(looked_at(0..100), (1, 100.0, 200));
        assert_eq!(looked_at((0..100).rev()), (1, 100.0, 200));
        assert_eq!(looked_at((0..100).chain(200..300)), (2, 200.0, 600));
        assert_eq!(looked_at((50..100).chain(0..50)), (1, 100.0, 300));
    }

    #[test]
    fn a_point_is_a_gap_unless_an_interval_contains_it() {
        let intervals = [(0.0, 1.0), (2.0, 2.0), (3.0, 4.0)].map(|(lo, hi)| Interval::new(lo, hi));
        for (at, free) in [
            (-1.0, true),
            (0.0, false),
            (0.5, false),
            (1.0, false),
            (1.5, true),
            (2.0, false),
            (2.5, true),
            (4.0, false),
            (5.0, true),
        ] {
            let point = Interval::new(at, at);
            assert!(gaps(intervals.into_iter(), point).eq(free.then_some(point)), "{at}");
        }
        // Within more than a point, gaps without a length are none.
        let between = |lo, hi| gaps(intervals.into_iter(), Interval::new(lo, hi));
        assert!(between(0.0, 1.0).eq([]) && between(0.25, 0.5).eq([]) && between(1.5, 1.0).eq([]));
        assert!(between(2.0, 3.0).eq([Interval::new(2.0, 3.0)]) && between(1.0, 2.0).eq([Interval::new(1.0, 2.0)]));
    }

    #[test]
    fn what_is_no_number_or_reversed_is_not_free() {
        let within = Interval::new(0.0, 10.0);
        for (interval, free) in [
            (Interval { lo: f64::NAN, hi: 5.0 }, &[Interval { lo: 5.0, hi: 10.0 }][..]),
            (Interval { lo: 2.0, hi: f64::NAN }, &[Interval { lo: 0.0, hi: 2.0 }]),
            (Interval { lo: 6.0, hi: 4.0 }, &[Interval { lo: 0.0, hi: 4.0 }, Interval { lo: 6.0, hi: 10.0 }]),
        ] {
            assert!(gaps([interval].into_iter(), within).eq(free.iter().copied()), "{interval:?}");
        }
    }
}
