//! Sets of times with a fixed capacity.

use crate::geometry::Interval;
use crate::scalar::Scalar;
use heapless::Vec;

/// Largest number of intervals of a set. The functions below say what is lost when there are more.
const MOST: usize = 8;

/// Disjoint closed intervals of time \[s\] in increasing order.
#[derive(Clone, Debug)]
pub(super) struct TimeSet<S> {
    intervals: Vec<Interval<S>, MOST>,
}

impl<S: Scalar> TimeSet<S> {
    pub(super) const NONE: Self = Self { intervals: Vec::new() };

    pub(super) fn iter(&self) -> impl DoubleEndedIterator<Item = Interval<S>> + Clone {
        self.intervals.iter().copied()
    }

    pub(super) fn is_empty(&self) -> bool {
        self.intervals.is_empty()
    }

    pub(super) fn clear(&mut self) {
        self.intervals.clear();
    }

    /// Adds an interval. If the set is full, the last but one is dropped: the earliest times are the best ones, and the
    /// last ones are those at which all other agents have arrived.
    pub(super) fn add(&mut self, interval: Interval<S>) {
        let interval = self.absorb(interval);
        let at = self.intervals.partition_point(|before| before.lo < interval.lo);
        if self.intervals.push(interval).is_ok() {
            self.carry(at, interval);
            return;
        }
        // Of the full set and the new interval together, the last but one is dropped.
        let mut last_two = self.intervals.iter_mut().rev();
        let (Some(last), Some(before)) = (last_two.next(), last_two.next()) else { return };
        if interval.lo > last.lo {
            *last = interval;
        } else if interval.lo < before.lo {
            let mut entry = interval;
            let room = MOST.saturating_sub(2);
            // The entry that is dropped makes room for those that move up.
            self.intervals
                .iter_mut()
                .take(room.saturating_add(1))
                .skip(at)
                .for_each(|p| core::mem::swap(p, &mut entry));
        }
    }

    /// Adds an interval to a set that may become too large, but not too small: if the set is full, the two neighbours with the least
    /// gap are merged.
    pub(super) fn cover(&mut self, interval: Interval<S>) {
        let interval = self.absorb(interval);
        let at = self.intervals.partition_point(|before| before.lo < interval.lo);
        if self.intervals.push(interval).is_ok() {
            self.carry(at, interval);
            return;
        }
        let before = core::mem::replace(&mut self.intervals, Vec::new());
        let all = || before.iter().take(at).chain([&interval]).chain(before.iter().skip(at));
        let gaps = all().zip(all().skip(1)).map(|(first, second)| second.lo - first.hi);
        // One more than there is room for.
        let places = 0..MOST.saturating_add(1);
        let narrowest =
            places.clone().skip(1).zip(gaps).reduce(|least, next| if next.1 < least.1 { next } else { least });
        for (place, &next) in places.zip(all()) {
            match self.intervals.last_mut().filter(|_| narrowest.is_some_and(|(second, _)| second == place)) {
                Some(last) => *last = last.hull(next),
                // Two became one, so there is room.
                None => _ = self.intervals.push(next),
            }
        }
    }

    /// Removes the interior of an interval from the set; its ends stay. If the set is full, as [`TimeSet::add`].
    pub(super) fn remove(&mut self, inside: Interval<S>) {
        if !self.iter().any(|interval| interval.lo < inside.hi && inside.lo < interval.hi) {
            return;
        }
        let before = core::mem::replace(self, Self::NONE);
        for interval in before.iter() {
            if interval.hi <= inside.lo || inside.hi <= interval.lo {
                self.add(interval);
                continue;
            }
            if interval.lo <= inside.lo {
                self.add(Interval::new(interval.lo, inside.lo));
            }
            if inside.hi <= interval.hi {
                self.add(Interval::new(inside.hi, interval.hi));
            }
        }
    }

    /// Removes all intervals that meet this one, and returns their hull with it.
    fn absorb(&mut self, mut interval: Interval<S>) -> Interval<S> {
        // `Vec::retain` cannot be proved free of panics.
        let before = core::mem::replace(&mut self.intervals, Vec::new());
        for &other in &before {
            if other.meets(interval) {
                interval = interval.hull(other);
            } else {
                let _ = self.intervals.push(other);
            }
        }
        interval
    }

    /// Moves the last interval, which is `entry`, to its place in the order.
    fn carry(&mut self, at: usize, mut entry: Interval<S>) {
        self.intervals.iter_mut().skip(at).for_each(|place| core::mem::swap(place, &mut entry));
    }
}

#[cfg(all(test, feature = "libm"))]
mod tests {
    use super::*;

    fn set(intervals: &[(f64, f64)]) -> TimeSet<f64> {
        let mut set = TimeSet::NONE;
        intervals.iter().for_each(|&(lo, hi)| set.add(Interval::new(lo, hi)));
        set
    }

    fn is(set: &TimeSet<f64>, intervals: &[(f64, f64)]) -> bool {
        set.iter().eq(intervals.iter().map(|&(lo, hi)| Interval::new(lo, hi)))
    }

    #[test]
    fn intervals_that_meet_become_one() {
        assert!(is(&set(&[(5.0, 6.0), (1.0, 2.0), (2.0, 3.0), (5.5, 7.0)]), &[(1.0, 3.0), (5.0, 7.0)]));
    }

    #[test]
    fn intervals_are_in_order_whatever_comes_first() {
        let sorted = [(0.0, 1.0), (2.0, 3.0), (4.0, 5.0), (6.0, 7.0)];
        for turn in 0..4 {
            let mut turned = sorted;
            turned.rotate_left(turn);
            let mut covered = TimeSet::NONE;
            turned.iter().for_each(|&(lo, hi)| covered.cover(Interval::new(lo, hi)));
            assert!(is(&set(&turned), &sorted) && is(&covered, &sorted), "{turned:?}");
            turned.reverse();
            assert!(is(&set(&turned), &sorted), "{turned:?}");
        }
    }

    #[test]
    fn the_ends_of_what_is_removed_stay() {
        let mut times = set(&[(0.0, 4.0), (6.0, 8.0)]);
        times.remove(Interval::new(3.0, 6.0));
        assert!(is(&times, &[(0.0, 3.0), (6.0, 8.0)]));
        times.remove(Interval::new(1.0, 2.0));
        assert!(is(&times, &[(0.0, 1.0), (2.0, 3.0), (6.0, 8.0)]));
    }

    #[test]
    fn without_room_the_last_but_one_is_lost() {
        let all: Vec<(f64, f64), 9> = (0..9).map(|k| (f64::from(2 * k), f64::from(2 * k + 1))).collect();
        for new in 0..9 {
            let mut order = all.clone();
            let late = order.remove(new);
            order.push(late).unwrap();
            let mut kept = all.clone();
            kept.remove(7);
            assert!(is(&set(&order), &kept), "{new}");
        }
    }

    #[test]
    fn a_cover_loses_nothing() {
        let mut times = TimeSet::NONE;
        (0..12).for_each(|k| times.cover(Interval::new(f64::from(5 * k % 12), f64::from(5 * k % 12) + 0.5)));
        (0..12).for_each(|k| assert!(times.iter().any(|i| i.lo <= f64::from(k) && f64::from(k) + 0.5 <= i.hi)));
        assert_eq!(times.iter().count(), MOST);
    }

    #[test]
    fn a_cover_without_room_closes_the_least_gap() {
        let whole: Vec<(f64, f64), 9> = (0..9).map(|k| (10.0 * f64::from(k), 10.0 * f64::from(k) + 1.0)).collect();
        for near in 1..9_usize {
            let mut all = whole.clone();
            all[near].0 -= 2.0;
            let mut expected = all.clone();
            expected[near - 1].1 = expected.remove(near).1;
            for last in 0..9 {
                let mut times = TimeSet::NONE;
                let order = all.iter().enumerate().filter(|(k, _)| *k != last).chain([(last, &all[last])]);
                order.for_each(|(_, &(lo, hi))| times.cover(Interval::new(lo, hi)));
                assert!(is(&times, &expected), "{near} {last}");
            }
        }
    }
}
