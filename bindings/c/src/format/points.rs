//! What all functions do with what C hands over: null pointers are told, numbers are checked, what does not fit is counted.

use super::fleet::Fleet;
use super::number::{Real, S, inner, plain};
use super::types::{PcrFleet, PcrInterval};
use crate::memory::{self, Place};
use crate::status::PcrStatus;
use pcr_core::{Interval, Scalar};

// SAFETY: it is made of integers, and opaque.
unsafe impl Place for PcrFleet {
    type Value = Fleet;
}

/// What C gets to know.
pub(super) fn status(outcome: Result<(), PcrStatus>) -> PcrStatus {
    outcome.err().unwrap_or(PcrStatus::Ok)
}

/// Does something with a fleet.
pub(super) fn ask(place: Option<&PcrFleet>, work: impl FnOnce(&Fleet) -> Result<(), PcrStatus>) -> PcrStatus {
    status(given(place).and_then(|place| work(memory::get(place))))
}

/// Does something to a fleet.
pub(super) fn change(
    place: Option<&mut PcrFleet>,
    work: impl FnOnce(&mut Fleet) -> Result<(), PcrStatus>,
) -> PcrStatus {
    status(given(place).and_then(|place| work(memory::get_mut(place))))
}

/// A pointer that must not be null.
pub(super) fn given<T>(pointer: Option<T>) -> Result<T, PcrStatus> {
    pointer.ok_or(PcrStatus::Null)
}

/// The caller's places for values, and for how many there are.
pub(super) struct Room<'a, T> {
    places: &'a mut [T],
    count: &'a mut usize,
}

impl<'a, T: Copy> Room<'a, T> {
    pub(super) fn new(out: *mut T, capacity: usize, count: Option<&'a mut usize>) -> Result<Self, PcrStatus> {
        Ok(Self { places: given(memory::places(out, capacity))?, count: given(count)? })
    }

    /// Copies values out, and tells how many there are; those that do not fit are counted.
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

/// A number that the format takes.
pub(super) fn number(value: Real) -> Result<S, PcrStatus> {
    let value = inner(value);
    match value {
        _ if !Scalar::is_finite(value) => Err(PcrStatus::NonFinite),
        _ if value > S::LIMIT || value < -S::LIMIT => Err(PcrStatus::OutOfRange),
        _ => Ok(value),
    }
}

/// An interval of such numbers.
pub(super) fn range(interval: PcrInterval) -> Result<Interval<S>, PcrStatus> {
    let (lo, hi) = (number(interval.lo)?, number(interval.hi)?);
    if lo <= hi { Ok(Interval::new(lo, hi)) } else { Err(PcrStatus::OutOfRange) }
}

/// An interval as C has it.
pub(super) fn interval(interval: Interval<S>) -> PcrInterval {
    PcrInterval { lo: plain(interval.lo), hi: plain(interval.hi) }
}

/// The index of an agent in a record.
pub(super) fn short(agent: usize) -> u16 {
    u16::try_from(agent).unwrap_or(u16::MAX)
}
