//! A set of motions from which a speed plan is chosen.
//!
//! The path is divided into cells. At the border of two cells the agent has one of a few speeds, one of which is rest.
//! Inside a cell its speed changes over the whole cell, or it speeds up at once and slows down as late as possible, at
//! full acceleration:
//!
//! ```text
//! speed   ____        ____
//!        /                \        the fastest motions between two speeds
//!       /                  \       that stay at or below the higher one
//! ```

use crate::geometry::Interval;
use crate::profile::Phase;
use crate::scalar::{Scalar, Wide};
use core::borrow::Borrow;

/// Number of speeds at the borders of cells: rest and four others, the last of which is the top speed.
pub(super) const LEVELS: usize = 5;
/// Number of slabs into which a cell is divided; for each slab it is known when it is blocked.
pub(super) const SLABS: usize = 4;

/// Cells, and the motions between speeds at their borders. Speeds are given by index; 0 is rest.
pub(super) trait SpeedLattice<S: Scalar> {
    /// A cell of the path.
    type Cell: Copy;

    /// The cells in order.
    fn cells(&self) -> impl DoubleEndedIterator<Item = Self::Cell>;
    /// End of a cell that begins at a length \[m\].
    fn end(&self, cell: Self::Cell, from: S) -> S;
    /// The motion over a cell from one speed to another.
    fn edge(&self, cell: Self::Cell, from: usize, to: usize) -> Option<impl Borrow<LatticeEdge<S>>>;
    /// Indices of the speeds at the start and at the goal.
    fn ends(&self) -> [usize; 2];
    /// Speed at the start \[m/s\].
    fn speed(&self) -> S;
    /// How long the agent has to stand at a length, at least \[s\].
    fn stands_at(&self, length: S) -> S {
        let _ = length;
        S::ZERO
    }
}

/// A motion over a cell from one speed to another, nowhere faster than the higher one.
#[derive(Clone, Copy, Debug)]
pub(super) struct LatticeEdge<S> {
    phases: [Phase<S>; 2],
    /// Times at which each slab is entered and the last one is left, from the begin of the cell on \[s\].
    pub(super) passes: [S; SLABS + 1],
}

impl<S: Scalar> LatticeEdge<S> {
    /// The motion that changes its speed at this acceleration, and otherwise has the higher speed. `None` if the speeds
    /// are too far apart for the cell.
    pub(super) fn new(from: S, to: S, length: S, acceleration: S) -> Option<Self> {
        let (slow, fast) = (from.min(to), from.max(to));
        if fast <= S::ZERO || length <= S::ZERO {
            return None;
        }
        let ramp = (fast - slow).quotient(acceleration);
        let mut way = (slow + fast).times(ramp).half().narrow();
        let rounding = S::rounding(length);
        if way > length + rounding.double() {
            return None;
        }
        // A rest of the cell that is due to rounding does not get a phase of its own.
        if length - way <= rounding.double() {
            way = length;
        }
        let cruise = (length - way).quotient(fast);
        let origin = Phase::origin(from);
        let phases = if from < to {
            let first = origin.until(ramp, way, to, acceleration);
            [first, first.until(cruise, length, to, S::ZERO)]
        } else {
            let first = origin.until(cruise, length - way, from, S::ZERO);
            [first, first.until(ramp, length, to, -acceleration)]
        };
        Some(Self::of(phases))
    }

    /// The motion whose speed changes over the whole cell, in this time.
    pub(super) fn steady(from: S, to: S, length: S, duration: S, acceleration: S) -> Self {
        let whole = Phase::origin(from).until(duration, length, to, acceleration);
        Self::of([whole, whole.until(S::ZERO, length, to, S::ZERO)])
    }

    fn of(phases: [Phase<S>; 2]) -> Self {
        let mut passes = [S::ZERO; SLABS + 1];
        let [first, second] = &phases;
        let length = second.length().hi;
        for (pass, border) in passes.iter_mut().zip(borders(Interval::new(S::ZERO, length))) {
            let phase = if border <= first.length().hi { first } else { second };
            *pass = phase.time_at(border);
        }
        if let Some(last) = passes.last_mut() {
            *last = second.time().hi;
        }
        Self { phases, passes }
    }

    /// Time that the agent takes for the cell \[s\].
    pub(super) fn duration(&self) -> S {
        let [_, last] = &self.phases;
        last.time().hi
    }

    /// The phases of non-zero duration: duration, length, final speed, acceleration.
    pub(super) fn phases(&self) -> impl Iterator<Item = (S, S, S, S)> {
        let phases = self.phases.iter().filter(|phase| phase.time().length() > S::ZERO);
        phases.map(|phase| {
            let [_, after] = phase.speed();
            (phase.time().length(), phase.length().length(), after, phase.acceleration())
        })
    }
}

/// The speed with this index where the top speed is `top` \[m/s\]: squares are evenly spaced.
pub(super) fn level<S: Scalar>(top: S, index: usize) -> S {
    let square = top.times(top);
    let (half, quarter) = (square.half(), square.half().half());
    match index {
        0 => S::ZERO,
        1 => quarter.sqrt(),
        2 => half.sqrt(),
        3 => (half + quarter).sqrt(),
        _ => top,
    }
}

/// The borders of the slabs of a cell.
fn borders<S: Scalar>(cell: Interval<S>) -> [S; SLABS + 1] {
    let (quarter, half) = (cell.length().half().half(), cell.length().half());
    [cell.lo, cell.lo + quarter, cell.lo + half, cell.lo + half + quarter, cell.hi]
}

/// The slabs of a cell, one after the other, and its end.
pub(super) fn parts<S: Scalar>(cell: Interval<S>) -> [Interval<S>; SLABS + 1] {
    let [lo, first, middle, last, hi] = borders(cell);
    [[lo, first], [first, middle], [middle, last], [last, hi], [hi, hi]].map(|[from, to]| Interval::new(from, to))
}
