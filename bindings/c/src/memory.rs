//! From C's pointers to Rust's references: all of the crate's dealings with raw memory.
//!
//! Sound under what the crate's documentation asks of the caller, and no more is assumed.

use crate::fleet::Fleet;
use crate::types::PcrFleet;
use core::mem::{align_of, size_of};
use core::ptr::NonNull;
use core::slice;

/// Memory for values of type `R`, the first ones of which are there.
pub(crate) struct Stack<R> {
    first: NonNull<R>,
    room: usize,
    len: usize,
}

impl<R: Copy + 'static> Stack<R> {
    /// In C records that have room for an `R` each; `None` for a null pointer.
    pub(crate) fn new<C>(first: *mut C, room: usize) -> Option<Self> {
        const { assert!(size_of::<C>() == size_of::<R>() && align_of::<C>() >= align_of::<R>()) };
        NonNull::new(first.cast::<R>()).map(|first| Self { first, room, len: 0 })
    }

    /// Adds a value; `false` where there is no room.
    pub(crate) fn push(&mut self, value: R) -> bool {
        if self.is_full() {
            return false;
        }
        // SAFETY: the caller promises this much room, for good and for the fleet alone.
        unsafe { self.first.add(self.len).write(value) };
        self.len += 1;
        true
    }

    /// Whether there is no more room.
    pub(crate) fn is_full(&self) -> bool {
        self.len >= self.room
    }

    /// The values that are there.
    pub(crate) fn values(&self) -> &[R] {
        // SAFETY: this many were written.
        unsafe { slice::from_raw_parts(self.first.as_ptr(), self.len) }
    }

    /// The value at a place.
    pub(crate) fn get_mut(&mut self, index: usize) -> Option<&mut R> {
        // SAFETY: as above.
        unsafe { slice::from_raw_parts_mut(self.first.as_ptr(), self.len) }.get_mut(index)
    }

    /// The values that are there, to be changed.
    pub(crate) fn values_mut(&mut self) -> &mut [R] {
        // SAFETY: as above.
        unsafe { slice::from_raw_parts_mut(self.first.as_ptr(), self.len) }
    }

    /// All of the memory, filled up with this value.
    pub(crate) fn filled(mut self, value: R) -> &'static mut [R] {
        while self.push(value) {}
        // SAFETY: as above, and nothing else keeps the pointer.
        unsafe { slice::from_raw_parts_mut(self.first.as_ptr(), self.len) }
    }
}

/// Memory of which one part after the other is taken for good, until it is given back.
pub(crate) struct Arena<R> {
    first: NonNull<R>,
    room: usize,
    /// How much is taken.
    len: usize,
}

impl<R: Copy + 'static> Arena<R> {
    /// All of it free, and filled with this value.
    pub(crate) fn new(all: Stack<R>, value: R) -> Self {
        let (first, room) = (all.first, all.room);
        for place in 0..room {
            // SAFETY: the caller promises this much room, for good and for the fleet alone.
            unsafe { first.add(place).write(value) };
        }
        Self { first, room, len: 0 }
    }

    /// What is free.
    pub(crate) fn free(&mut self) -> &mut [R] {
        // SAFETY: it was filled, and no part of it is taken.
        unsafe { slice::from_raw_parts_mut(self.first.as_ptr().add(self.len), self.room.saturating_sub(self.len)) }
    }

    /// The part that comes next. It is not taken before [`Arena::take`]: until then, [`Arena::free`] ends its use.
    pub(crate) fn next(&self, count: usize) -> &'static [R] {
        self.part(self.len, count)
    }

    /// Takes the part that comes next.
    pub(crate) fn take(&mut self, count: usize) {
        self.len = self.len.saturating_add(count).min(self.room);
    }

    /// Where a part begins.
    pub(crate) fn place(&self, part: &[R]) -> usize {
        (part.as_ptr() as usize).wrapping_sub(self.first.as_ptr() as usize) / const { size_of::<R>() }
    }

    /// Moves a part down, and gives where it is now. Whatever lies there or borrows the part is not used any more.
    pub(crate) fn moved(&mut self, from: usize, to: usize, count: usize) -> &'static [R] {
        if from.max(to).checked_add(count).is_some_and(|end| end <= self.room) {
            // SAFETY: both are within the memory.
            unsafe { self.first.add(from).copy_to(self.first.add(to), count) };
        }
        self.part(to, count)
    }

    /// Gives back all from a place on.
    pub(crate) fn give_back(&mut self, from: usize) {
        self.len = self.len.min(from);
    }

    fn part(&self, from: usize, count: usize) -> &'static [R] {
        let count = count.min(self.room.saturating_sub(from));
        // SAFETY: it was filled; whoever changes it knows of what borrows it.
        unsafe { slice::from_raw_parts(self.first.as_ptr().add(from.min(self.room)), count) }
    }
}

/// The values at a pointer; `None` for a null pointer, unless there are none.
pub(crate) fn values<'a, T>(first: *const T, count: usize) -> Option<&'a [T]> {
    match NonNull::new(first.cast_mut()) {
        // SAFETY: the caller promises `count` values.
        Some(first) => Some(unsafe { slice::from_raw_parts(first.as_ptr(), count) }),
        None => (count == 0).then_some(&[]),
    }
}

/// The places at a pointer; `None` for a null pointer, unless there are none.
pub(crate) fn places<'a, T>(first: *mut T, count: usize) -> Option<&'a mut [T]> {
    match NonNull::new(first) {
        // SAFETY: the caller promises `count` places.
        Some(first) => Some(unsafe { slice::from_raw_parts_mut(first.as_ptr(), count) }),
        None => (count == 0).then_some(&mut []),
    }
}

const _: () = assert!(size_of::<Fleet>() <= size_of::<PcrFleet>() && align_of::<Fleet>() <= align_of::<PcrFleet>());

/// Puts a fleet in its place.
pub(crate) fn put(place: &mut PcrFleet, fleet: Fleet) {
    // SAFETY: there is room, as asserted above; what was there needs no drop.
    unsafe { core::ptr::from_mut(place).cast::<Fleet>().write(fleet) };
}

/// The fleet that was put there.
pub(crate) fn fleet(place: &PcrFleet) -> &Fleet {
    // SAFETY: the caller promises that `pcr_fleet_init` succeeded on it.
    unsafe { &*core::ptr::from_ref(place).cast::<Fleet>() }
}

/// The fleet that was put there.
pub(crate) fn fleet_mut(place: &mut PcrFleet) -> &mut Fleet {
    // SAFETY: as above.
    unsafe { &mut *core::ptr::from_mut(place).cast::<Fleet>() }
}
