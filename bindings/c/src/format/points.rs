//! Handles the arguments of all functions: reports null pointers, checks numbers, and counts results that do not fit.

use super::fleet::{Fleet, number};
use super::number::{S, plain};
use super::types::{PcrFleet, PcrInterval};
use crate::memory::{self, Place};
use crate::status::{PcrStatus, given};
use pcr_core::Interval;

// SAFETY: the type consists of integers and is opaque.
unsafe impl Place for PcrFleet {
    type Value = Fleet;
}

/// The status for C.
pub(super) fn status(outcome: Result<(), PcrStatus>) -> PcrStatus {
    outcome.err().unwrap_or(PcrStatus::Ok)
}

/// Calls `work` with a fleet.
pub(super) fn ask(place: Option<&PcrFleet>, work: impl FnOnce(&Fleet) -> Result<(), PcrStatus>) -> PcrStatus {
    status(given(place).and_then(|place| work(memory::get(place))))
}

/// Calls `work` with a mutable fleet.
pub(super) fn change(
    place: Option<&mut PcrFleet>,
    work: impl FnOnce(&mut Fleet) -> Result<(), PcrStatus>,
) -> PcrStatus {
    status(given(place).and_then(|place| work(memory::get_mut(place))))
}

/// The caller's buffer for values, and the place for their count.
pub(super) struct Room<'a, T> {
    places: &'a mut [T],
    count: &'a mut usize,
}

impl<'a, T: Copy> Room<'a, T> {
    pub(super) fn new(out: *mut T, capacity: usize, count: Option<&'a mut usize>) -> Result<Self, PcrStatus> {
        Ok(Self { places: given(memory::places(out, capacity))?, count: given(count)? })
    }

    /// Copies values to the buffer and writes their count; those that do not fit are counted, too.
    pub(super) fn fill(self, all: impl Iterator<Item = T>) -> Result<(), PcrStatus> {
        let mut places = self.places.iter_mut();
        let mut fits = true;
        *self.count = 0;
        for value in all {
            match places.next() {
                Some(place) => *place = value,
                None => fits = false,
            }
            *self.count = self.count.saturating_add(1);
        }
        if fits { Ok(()) } else { Err(PcrStatus::BufferTooSmall) }
    }
}

/// Checks an interval of numbers.
pub(super) fn range(interval: PcrInterval) -> Result<Interval<S>, PcrStatus> {
    let (lo, hi) = (number(interval.lo)?, number(interval.hi)?);
    if lo <= hi { Ok(Interval::new(lo, hi)) } else { Err(PcrStatus::OutOfRange) }
}

/// Converts an interval to C.
pub(super) fn interval(interval: Interval<S>) -> PcrInterval {
    PcrInterval { lo: plain(interval.lo), hi: plain(interval.hi) }
}

/// Index of an agent in a record.
pub(super) fn short(agent: usize) -> u16 {
    u16::try_from(agent).unwrap_or(u16::MAX)
}
