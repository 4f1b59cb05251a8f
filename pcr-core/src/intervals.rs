//! Unions and gaps of intervals, computed on demand and without storage.

use crate::geometry::Interval;
use crate::scalar::Scalar;

/// The union of intervals, which may be in any order, as disjoint intervals in increasing order. Cost of each interval
/// of the union: one pass over the intervals to find it, and one more each time that it grows.
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
/// are equal to ends of its neighbours; gaps of length 0 are left out.
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
        // Reversed ends are swapped and a NaN end counts as unbounded, so nothing is reported as free by mistake and
        // the iteration ends.
        let whole = |interval: Interval<S>| if interval.lo <= interval.hi { interval } else { interval.limited() };
        let mut lowest: Option<Interval<S>> = None;
        for interval in self.intervals.clone().map(whole) {
            let beyond = self.after.is_none_or(|after| interval.lo > after);
            if beyond && lowest.is_none_or(|lowest| interval.lo < lowest.lo) {
                lowest = Some(interval);
            }
        }
        let mut next = lowest?;
        loop {
            let grown = self.intervals.clone().map(whole).filter(|other| other.meets(next)).fold(next, Interval::hull);
            if grown == next {
                break;
            }
            next = grown;
        }
        self.after = Some(next.hi);
        Some(next)
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
            let Some(interval) = self.intervals.next().filter(|interval| interval.lo < rest.hi) else {
                return (rest.lo < rest.hi).then_some(rest);
            };
            self.rest = Some(Interval::new(rest.lo.max(interval.hi), rest.hi)).filter(|rest| rest.lo < rest.hi);
            if rest.lo < interval.lo {
                return Some(Interval::new(rest.lo, interval.lo));
            }
        }
    }
}
