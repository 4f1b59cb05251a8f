//! The motions from which a speed plan is chosen if the agent may nowhere be faster than a given motion.
//!
//! Each phase of the given motion is divided into equal cells. At the border of two cells the agent has the speed v of
//! that motion, or less: the squares of the five speeds are 0, 1/4, 1/2, 3/4 and 1 times v². At a constant acceleration
//! the square of the speed is linear in the length. So a motion whose speed changes over the whole cell, from one of
//! these to another, is nowhere faster than the given one. Where that has a constant speed, the speed may also change
//! in a part of the cell. No acceleration is larger than the least one of the given motion between the same two stops.
//! Where that motion stands, the agent stands at least as long.

use crate::error::InvalidInput;
use crate::geometry::Interval;
use crate::plan::lattice::{LEVELS, LatticeEdge, SpeedLattice, level};
use crate::profile::{Phase, ProfileRef};
use crate::scalar::{Scalar, Wide};
use core::borrow::Borrow;

/// Index of the speed of the given motion.
const TOP: usize = LEVELS - 1;

/// Cells are not divided into parts of less than 2 to the power of minus this of the path.
const FINEST: u32 = 12;

/// The motion that is not exceeded, on a path of this length.
#[derive(Clone, Copy, Debug)]
pub(super) struct CappedLattice<'p, S> {
    phases: &'p [Phase<S>],
    /// Length of the path \[m\].
    length: S,
    /// No cell is divided into halves that are shorter than this \[m\].
    shortest: S,
}

/// A cell: a part of a phase.
#[derive(Clone, Copy, Debug)]
pub(super) struct CappedCell<'p, S> {
    phase: &'p Phase<S>,
    /// Lengths along the path \[m\].
    length: Interval<S>,
    /// Largest acceleration and deceleration \[m/s²\].
    acceleration: S,
}

impl<'p, S: Scalar> CappedLattice<'p, S> {
    /// A lattice of at most `most` cells.
    pub(super) fn new(profile: ProfileRef<'p, S>, length: S, most: usize) -> Result<Self, InvalidInput> {
        let phases = profile.phases();
        let lasts = |phase: &Phase<S>| phase.time().length() > S::ZERO;
        // The length of such a phase was rounded away.
        if phases.iter().any(|phase| !moves(phase) && lasts(phase) && phase.speed() != [S::ZERO; 2]) {
            return Err(InvalidInput::OutOfRange("length of a phase"));
        }
        let shortest = (0..FINEST).fold(length, |part, _| part.half()).max(S::slack(length));
        let mut below = Self { phases, length, shortest };
        while below.cells().nth(most).is_some() {
            if below.shortest <= S::ZERO || below.shortest > length {
                return Err(InvalidInput::Full("station"));
            }
            below.shortest = below.shortest.double();
        }
        // The path may be shorter than the profile by its tolerance, and cells shorter than a rounding.
        if below.cells().any(|cell| cell.length.length() <= S::ZERO) {
            return Err(InvalidInput::OutOfRange("length of a phase"));
        }
        Ok(below)
    }

    /// The cells of a phase.
    fn within(&self, phase: &'p Phase<S>) -> impl DoubleEndedIterator<Item = CappedCell<'p, S>> + use<'p, S> {
        let acceleration = self.acceleration(phase);
        let [before, after] = phase.speed();
        let fast = before.max(after);
        // From one speed to the next: v² / 8 a. Without acceleration there is one speed only, and cells may be short.
        let changes = acceleration > S::ZERO;
        let ramp =
            if changes { fast.times(fast.quotient(acceleration)).half().half().half().narrow() } else { S::ZERO };
        let least = ramp.max(self.shortest);
        let (mut part, mut count) = (phase.length().length(), 1_usize);
        while part.half() >= least && part.half() > S::ZERO {
            (part, count) = (part.half(), count.saturating_mul(2));
        }
        let is_last = phase.length().hi >= self.phases.last().map_or(S::ZERO, |last| last.length().hi);
        let end = if is_last { self.length } else { phase.length().hi };
        (0..count).map(move |cell| {
            let next = cell.saturating_add(1);
            let lo = phase.length().lo + multiple(part, cell);
            let hi = if next == count { end } else { phase.length().lo + multiple(part, next) };
            CappedCell { phase, length: Interval::new(lo, hi), acceleration }
        })
    }

    /// The least acceleration or deceleration of the given motion between the stops before and after a phase; 0 if its
    /// speed is the same all the time there.
    fn acceleration(&self, of: &Phase<S>) -> S {
        let (mut least, mut is_found) = (None, false);
        for phase in self.phases.iter().filter(|phase| moves(phase)) {
            let [before, _] = phase.speed();
            if before <= S::ZERO {
                if is_found {
                    break;
                }
                least = None;
            }
            is_found |= core::ptr::eq(phase, of);
            let acceleration = phase.acceleration().abs();
            if acceleration > S::ZERO {
                least = Some(least.map_or(acceleration, |least| acceleration.min(least)));
            }
        }
        least.unwrap_or_default()
    }
}

impl<'p, S: Scalar> SpeedLattice<S> for CappedLattice<'p, S> {
    type Cell = CappedCell<'p, S>;

    fn cells(&self) -> impl DoubleEndedIterator<Item = CappedCell<'p, S>> {
        self.phases.iter().filter(|phase| moves(phase)).flat_map(|phase| self.within(phase))
    }

    fn end(&self, cell: CappedCell<'p, S>, _: S) -> S {
        cell.length.hi
    }

    fn edge(
        &self,
        CappedCell { phase, length, acceleration }: CappedCell<'p, S>,
        from: usize,
        to: usize,
    ) -> Option<impl Borrow<LatticeEdge<S>>> {
        // At its ends the times of the phase itself: far along a path, the length of a turn in place has few digits.
        let times = [length.lo, length.hi].map(|length| match length {
            _ if length == phase.length().lo => phase.time().lo,
            _ if length == phase.length().hi => phase.time().hi,
            _ => phase.time_at(length),
        });
        let [before, after] = times.map(|time| phase.speed_at(time));
        let is_rest = |speed: S, index: usize| speed <= S::ZERO && index > 0;
        if is_rest(before, from) || is_rest(after, to) {
            return None;
        }
        let (start, goal) = (level(before, from), level(after, to));
        let is_top = |speed: S, level: usize| level == TOP || speed <= S::ZERO;
        if is_top(before, from) && is_top(after, to) {
            let [enters, leaves] = times;
            return Some(LatticeEdge::steady(start, goal, length.length(), leaves - enters, phase.acceleration()));
        }
        if phase.acceleration() == S::ZERO {
            return LatticeEdge::new(start, goal, length.length(), acceleration);
        }
        let sum = start + goal;
        if sum <= S::ZERO {
            return None;
        }
        let duration = length.length().double().quotient(sum);
        let change = (goal - start).quotient(duration);
        (duration <= S::LIMIT && change.abs() <= acceleration)
            .then(|| LatticeEdge::steady(start, goal, length.length(), duration, change))
    }

    fn ends(&self) -> [usize; 2] {
        let first = self.phases.first().map_or(S::ZERO, |first| first.speed()[0]);
        let last = self.phases.last().map_or(S::ZERO, |last| last.speed()[1]);
        [first, last].map(|speed| if speed > S::ZERO { TOP } else { 0 })
    }

    fn speed(&self) -> S {
        self.phases.first().map_or(S::ZERO, |first| first.speed()[0])
    }

    fn stands_at(&self, length: S) -> S {
        let end = self.phases.last().map_or(S::ZERO, |last| last.length().hi);
        let place = |phase: &Phase<S>| if phase.length().hi >= end { self.length } else { phase.length().hi };
        let stands = self.phases.iter().filter(|&phase| !moves(phase) && place(phase) == length);
        stands.fold(S::ZERO, |sum, phase| sum + phase.time().length())
    }
}

/// Whether the agent gets any further in a phase.
fn moves<S: Scalar>(phase: &Phase<S>) -> bool {
    phase.length().length() > S::ZERO
}

/// A length, multiplied by `times`.
fn multiple<S: Scalar>(mut length: S, mut times: usize) -> S {
    let mut sum = S::ZERO;
    while times > 0 {
        if times & 1 == 1 {
            sum = sum + length;
        }
        (length, times) = (length.double(), times >> 1);
    }
    sum
}
