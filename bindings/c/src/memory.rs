//! Converts pointers of C to references of Rust. All accesses to raw memory are in this module.
//!
//! It is sound if the caller keeps the promises in the documentation of the crate; it assumes nothing else.

use core::cell::Cell;
use core::mem::{align_of, size_of};
use core::ptr::NonNull;
use core::slice;

/// Memory for values of type `R`, of which the first `len` are initialized.
pub(crate) struct Stack<R> {
    first: NonNull<R>,
    room: usize,
    len: usize,
}

impl<R: Copy + 'static> Stack<R> {
    /// In C records that have room for an `R` each, and for more where a build leaves out outlines; `None` for a null pointer, but where there is none of them.
    pub(crate) fn new<C>(first: *mut C, room: usize) -> Option<Self> {
        const { assert!(size_of::<C>() >= size_of::<R>() && align_of::<C>() >= align_of::<R>()) };
        if room == 0 {
            return Some(Self::none());
        }
        NonNull::new(first.cast::<R>()).map(|first| Self { first, room, len: 0 })
    }

    /// A stack without memory.
    pub(crate) const fn none() -> Self {
        Self { first: NonNull::dangling(), room: 0, len: 0 }
    }

    /// Adds a value; `false` if there is no room.
    pub(crate) fn push(&mut self, value: R) -> bool {
        if self.is_full() {
            return false;
        }
        // SAFETY: the caller promises that this memory exists as long as the fleet, and that only the fleet uses it.
        unsafe { self.first.add(self.len).write(value) };
        self.len += 1;
        true
    }

    /// Whether there is no more room.
    pub(crate) fn is_full(&self) -> bool {
        self.len >= self.room
    }

    /// Removes a value; the values behind it move down.
    pub(crate) fn remove(&mut self, index: usize) {
        if index >= self.len {
            return;
        }
        let places = Cell::from_mut(self.values_mut()).as_slice_of_cells();
        for neighbours in places.windows(2).skip(index) {
            if let [place, next] = neighbours {
                place.set(next.get());
            }
        }
        self.len = self.len.saturating_sub(1);
    }

    /// The initialized values.
    pub(crate) fn values(&self) -> &[R] {
        // SAFETY: the first `len` values were written.
        unsafe { slice::from_raw_parts(self.first.as_ptr(), self.len) }
    }

    /// The value at an index.
    pub(crate) fn get_mut(&mut self, index: usize) -> Option<&mut R> {
        // SAFETY: as above.
        unsafe { slice::from_raw_parts_mut(self.first.as_ptr(), self.len) }.get_mut(index)
    }

    /// The initialized values, mutable.
    pub(crate) fn values_mut(&mut self) -> &mut [R] {
        // SAFETY: as above.
        unsafe { slice::from_raw_parts_mut(self.first.as_ptr(), self.len) }
    }

    /// All of the memory; the rest is filled with this value.
    pub(crate) fn filled(mut self, value: R) -> &'static mut [R] {
        while self.push(value) {}
        // SAFETY: as above, and no other copy of the pointer is kept.
        unsafe { slice::from_raw_parts_mut(self.first.as_ptr(), self.len) }
    }
}

/// C records that have room for an `A` and a `B` each: first all of the one, then all of the other. `None` for a null pointer, but
/// where there is none of them.
pub(crate) fn both<C, A: Copy + 'static, B: Copy + 'static>(
    first: *mut C,
    room: usize,
) -> Option<(Stack<A>, Stack<B>)> {
    const {
        assert!(size_of::<C>() == size_of::<A>() + size_of::<B>() && size_of::<A>().is_multiple_of(align_of::<B>()));
        assert!(align_of::<C>() >= align_of::<A>() && align_of::<C>() >= align_of::<B>());
    };
    if room == 0 {
        return Some((Stack::none(), Stack::none()));
    }
    let first = NonNull::new(first.cast::<A>())?;
    // SAFETY: the caller promises room for this number of both.
    let behind = unsafe { first.add(room) }.cast::<B>();
    Some((Stack { first, room, len: 0 }, Stack { first: behind, room, len: 0 }))
}

/// Memory from which consecutive parts are taken; they stay in use until they are given back.
pub(crate) struct Arena<R> {
    first: NonNull<R>,
    room: usize,
    /// Number of values that are in use.
    len: usize,
}

impl<R: Copy + 'static> Arena<R> {
    /// An arena that is filled with this value and not in use.
    pub(crate) fn new(all: Stack<R>, value: R) -> Self {
        let (first, room) = (all.first, all.room);
        for place in 0..room {
            // SAFETY: the caller promises that this memory exists as long as the fleet, and that only the fleet uses
            // it.
            unsafe { first.add(place).write(value) };
        }
        Self { first, room, len: 0 }
    }

    /// The values that are not in use.
    pub(crate) fn free(&mut self) -> &mut [R] {
        // SAFETY: the memory was filled, and no part of this range is in use.
        unsafe { slice::from_raw_parts_mut(self.first.as_ptr().add(self.len), self.room.saturating_sub(self.len)) }
    }

    /// The next part, which is not in use until [`Arena::take`] is called. The reference must not be used after a call
    /// of [`Arena::free`].
    pub(crate) fn next(&self, count: usize) -> &'static [R] {
        self.part(self.len, count)
    }

    /// Copies values into the next part, which is not in use until [`Arena::take`] is called; `None` without room.
    pub(crate) fn copied(&mut self, values: &[R]) -> Option<&'static [R]> {
        self.free().get_mut(..values.len())?.iter_mut().zip(values).for_each(|(slot, value)| *slot = *value);
        Some(self.next(values.len()))
    }

    /// Marks the next part as in use.
    pub(crate) fn take(&mut self, count: usize) {
        self.len = self.len.saturating_add(count).min(self.room);
    }

    /// Index at which a part begins.
    pub(crate) fn place(&self, part: &[R]) -> usize {
        (part.as_ptr() as usize).wrapping_sub(self.first.as_ptr() as usize) / const { size_of::<R>() }
    }

    /// Moves a part down, and returns it at its new place. The caller no longer uses the part, or the values at its new
    /// place.
    pub(crate) fn moved(&mut self, from: usize, to: usize, count: usize) -> &'static [R] {
        if from.max(to).checked_add(count).is_some_and(|end| end <= self.room) {
            // SAFETY: both ranges are within the memory.
            unsafe { self.first.add(from).copy_to(self.first.add(to), count) };
        }
        self.part(to, count)
    }

    /// Number of values that are in use.
    pub(crate) fn len(&self) -> usize {
        self.len
    }

    /// Gives back all values from an index on.
    pub(crate) fn give_back(&mut self, from: usize) {
        self.len = self.len.min(from);
    }

    fn part(&self, from: usize, count: usize) -> &'static [R] {
        let count = count.min(self.room.saturating_sub(from));
        // SAFETY: the memory was filled; callers that change it know what borrows it.
        unsafe { slice::from_raw_parts(self.first.as_ptr().add(from.min(self.room)), count) }
    }
}

/// The values at a pointer; `None` if the pointer is null and `count` is not 0.
pub(crate) fn values<'a, T>(first: *const T, count: usize) -> Option<&'a [T]> {
    match NonNull::new(first.cast_mut()) {
        // SAFETY: the caller promises `count` values.
        Some(first) => Some(unsafe { slice::from_raw_parts(first.as_ptr(), count) }),
        None => (count == 0).then_some(&[]),
    }
}

/// The values at a pointer, mutable; `None` if the pointer is null and `count` is not 0.
pub(crate) fn places<'a, T>(first: *mut T, count: usize) -> Option<&'a mut [T]> {
    match NonNull::new(first) {
        // SAFETY: the caller promises `count` values.
        Some(first) => Some(unsafe { slice::from_raw_parts_mut(first.as_ptr(), count) }),
        None => (count == 0).then_some(&mut []),
    }
}

/// A C type whose memory holds a value of the library.
///
/// # Safety
/// Any bytes are valid for the type, and only this module reads them.
pub(crate) unsafe trait Place {
    /// Type of the value that is stored.
    type Value;
}

/// Stores a value.
pub(crate) fn put<P: Place>(place: &mut P, value: P::Value) {
    const { assert!(size_of::<P::Value>() <= size_of::<P>() && align_of::<P::Value>() <= align_of::<P>()) };
    // SAFETY: it fits, as asserted above, and the bytes that it overwrites need no drop.
    unsafe { core::ptr::from_mut(place).cast::<P::Value>().write(value) };
}

/// The stored value.
pub(crate) fn get<P: Place>(place: &P) -> &P::Value {
    // SAFETY: the caller promises that it was initialized.
    unsafe { &*core::ptr::from_ref(place).cast::<P::Value>() }
}

/// The stored value, mutable.
pub(crate) fn get_mut<P: Place>(place: &mut P) -> &mut P::Value {
    // SAFETY: as above.
    unsafe { &mut *core::ptr::from_mut(place).cast::<P::Value>() }
}
