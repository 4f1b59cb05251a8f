//! Certified intervals of a function of one variable that changes no faster than its argument.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// Where `f <= 0`: intervals that are sure, and intervals that may be.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Intervals {
    /// `f <= 0` in all of them; disjoint, increasing.
    pub inner: Vec<(f64, f64)>,
    /// `f > margin` outside all of them; disjoint, increasing.
    pub outer: Vec<(f64, f64)>,
}

/// Most evaluations that [`below`] spends: a function that is 0 throughout would take any number.
const BUDGET: usize = 4_000;

/// Most evaluations that [`reaches`] spends, which seldom takes many: a function that hovers a little above the margin.
const SEARCH: usize = 1_000_000;

/// Where in `[lo, hi]` a function of slope at most 1 is `<= 0`, ends known within `tolerance`. Points where it is at
/// most `margin` count as possible: that much its evaluation, or the claim that is to be checked, may be off.
pub fn below(f: impl Fn(f64) -> f64, lo: f64, hi: f64, margin: f64, tolerance: f64) -> Intervals {
    let mut found = Intervals::default();
    let mut stack = vec![(lo, hi)];
    let mut spent = 0;
    while let Some((a, b)) = stack.pop() {
        let half = 0.5 * (b - a);
        let value = f(a + half);
        spent += 1;
        if value - half > margin {
            continue;
        }
        if value + half <= 0.0 {
            append(&mut found.inner, a, b);
        } else if half > tolerance && spent < BUDGET {
            stack.extend([(a + half, b), (a, a + half)]);
            continue;
        }
        append(&mut found.outer, a, b);
    }
    found
}

fn append(intervals: &mut Vec<(f64, f64)>, a: f64, b: f64) {
    match intervals.last_mut() {
        Some(last) if last.1 == a => last.1 = b,
        _ => intervals.push((a, b)),
    }
}

/// Whether the function is at most `margin` anywhere in `[lo, hi]`, as far as steps of `tolerance` can tell: `false`
/// is certain.
pub fn reaches(f: impl Fn(f64) -> f64, lo: f64, hi: f64, margin: f64, tolerance: f64) -> bool {
    let part = |a, b| Part { value: f(0.5 * (a + b)), a, b };
    // The lowest one first: in order of place a valley that only just reaches the margin would be cut all over its sides.
    let mut parts = BinaryHeap::from([part(lo, hi)]);
    let mut spent = 1;
    while let Some(Part { value, a, b }) = parts.pop() {
        let half = 0.5 * (b - a);
        if value - half > margin {
            continue;
        }
        if value <= margin || half <= tolerance || spent >= SEARCH {
            return true;
        }
        parts.extend([part(a, a + half), part(a + half, b)]);
        spent += 2;
    }
    false
}

/// A part of the range with the value in its middle, the lowest one the greatest.
struct Part {
    value: f64,
    a: f64,
    b: f64,
}

impl Ord for Part {
    fn cmp(&self, other: &Self) -> Ordering {
        other.value.total_cmp(&self.value)
    }
}

impl PartialOrd for Part {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Part {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Part {}

/// About the least value in `[lo, hi]`: for messages, nothing is decided with it.
pub fn nearest(f: impl Fn(f64) -> f64, lo: f64, hi: f64) -> f64 {
    const STEPS: u32 = 100_000;
    (0..=STEPS).map(|k| f(lo + (hi - lo) * f64::from(k) / f64::from(STEPS))).fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_valleys_are_two_intervals() {
        let found = below(|x| (x.abs() - 2.0).abs() - 1.0, -5.0, 5.0, 0.0, 1e-9);
        assert_eq!((found.inner.len(), found.outer.len()), (2, 2));
        for (got, want) in found.inner.iter().zip([(-3.0, -1.0), (1.0, 3.0)]) {
            assert!((got.0 - want.0).abs() < 1e-8 && (got.1 - want.1).abs() < 1e-8, "{got:?}");
        }
        assert!(!reaches(|x| x.abs() + 1e-6, -1.0, 1.0, 0.0, 1e-9));
    }

    #[test]
    fn the_bottom_of_a_flat_valley_is_found_without_cutting_its_sides() {
        let spent = std::cell::Cell::new(0);
        let valley = |x: f64| {
            spent.set(spent.get() + 1);
            0.5 * (x - 0.1234) * (x - 0.1234)
        };
        assert!(reaches(valley, -0.7, 1.3, 1e-14, 1e-15));
        assert!(spent.get() < 200, "{} evaluations", spent.get());
        assert!(!reaches(|x| valley(x) + 1e-4, -0.7, 1.3, 0.0, 1e-9));
    }
}
