//! Storage of region pieces with a fixed capacity. A piece is the part of a region that belongs to one pair of
//! segments.
//!
//! The pieces of a region are a linked list inside the storage, so a region of any number of pieces can be added or
//! removed without moving others. While a pair of agents is computed, its pieces are in one *pending* list, in which
//! pieces that are joined have the same group. At the end the list is split into regions; if the storage is full, the
//! whole list is freed.

use crate::error::CapacityError;
use crate::geometry::Interval;
use crate::lap::{Branch, Winding};
use crate::scalar::Scalar;
use crate::segment::Segment;
use core::marker::PhantomData;

/// End of a list. Indices of pieces count from 1, so that an empty table is all zeros: a static with one takes no room in flash.
pub(crate) const NONE: u32 = 0;

/// The slot of a piece, counted from 0; for [`NONE`] one that no storage has.
#[inline(always)]
const fn slot(index: u32) -> usize {
    index.wrapping_sub(1) as usize
}

/// Bit in the group of a piece that says that other pieces have the same group.
const JOINED: u16 = 1 << 15;

/// Largest number of groups of a pair.
const GROUPS: u16 = JOINED - 1;

/// A piece: the part of a collision region that belongs to one pair of segments and has one closed form.
///
/// It stores its ranges of lengths along both paths; within these it is bounded by the slices of
/// [`RegionRef`](crate::RegionRef). 28 bytes for `f32`, 48 for `f64`.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Piece<S> {
    pub(crate) first: Interval<S>,
    pub(crate) second: Interval<S>,
    pub(crate) first_segment: u16,
    pub(crate) second_segment: u16,
    /// Which of the intervals of a slice of the first segment belongs to the piece. For two discs, the lap of the first segment, which connects
    /// neighbouring slabs, and the share; for outlines, k and n of the k-th of n intervals.
    rank: [u8; 2],
    group: u16,
    pub(crate) next: u32,
}

const _: () = assert!(size_of::<Piece<f32>>() == 28, "the documented size of a piece");
const _: () = assert!(size_of::<Piece<f64>>() == 48, "the documented size of a piece");

impl<S: Scalar> Piece<S> {
    /// An unused slot, to fill a storage with.
    pub const EMPTY: Self = Self {
        first: Interval::new(S::ZERO, S::ZERO),
        second: Interval::new(S::ZERO, S::ZERO),
        first_segment: 0,
        second_segment: 0,
        rank: [0; 2],
        group: 0,
        next: NONE,
    };

    pub(crate) fn new(
        segments: [u16; 2],
        lap: Winding,
        share: Branch,
        first: Interval<S>,
        second: Interval<S>,
    ) -> Self {
        Self::ranked(segments, [lap as u8, share as u8], first, second)
    }

    /// The piece of two outlines that is the k-th of n intervals, counted from 0.
    pub(crate) fn ranked(segments: [u16; 2], rank: [u8; 2], first: Interval<S>, second: Interval<S>) -> Self {
        let [first_segment, second_segment] = segments;
        Self { first, second, first_segment, second_segment, rank, group: 0, next: NONE }
    }

    /// Lap of the first segment of a piece of two discs.
    pub(crate) fn lap(&self) -> Winding {
        Winding::ALL.get(usize::from(self.rank[0])).copied().unwrap_or(Winding::Whole)
    }

    /// Share of the first segment of a piece of two discs.
    pub(crate) fn share(&self) -> Branch {
        match self.rank[1] {
            0 => Branch::Only,
            1 => Branch::Start,
            _ => Branch::End,
        }
    }

    /// For a piece of two outlines, k and n: it is the k-th of n intervals, counted from 0.
    pub(crate) fn rank(&self) -> [u8; 2] {
        self.rank
    }

    /// The intervals at a joint that belong to this piece, as lengths along segments. Of two, only the longer one: the
    /// shorter one is thin and due to rounding. If the whole circle is covered, both, because rounding may cut the
    /// circle anywhere.
    pub(crate) fn at_joint(&self, covered: [Option<Interval<S>>; 2], segment: &Segment<S>) -> [Option<Interval<S>>; 2] {
        match self.share().of(covered, segment, self.first) {
            [Some(a), Some(b)] if self.lap() != Winding::Whole => {
                [Some(if a.length() < b.length() { b } else { a }), None]
            }
            intervals => intervals,
        }
    }
}

impl<S: Scalar> Default for Piece<S> {
    fn default() -> Self {
        Self::EMPTY
    }
}

/// The storage: slots of the caller; slots in use are in lists, free ones in a list of their own.
#[derive(Clone, Debug)]
pub(crate) struct PieceStore<S, P> {
    slots: P,
    /// Number of slots that were ever used; they are the first ones.
    fresh: u32,
    /// Head of the list of freed slots.
    free: u32,
    /// Number of slots in use.
    used: u32,
    pending: PendingPieces,
    scalar: PhantomData<S>,
}

/// The list of the pair that is being computed.
#[derive(Clone, Copy, Debug)]
struct PendingPieces {
    first: u32,
    last: u32,
    /// Number of groups used so far.
    groups: u16,
}

impl PendingPieces {
    const NOTHING: Self = Self { first: NONE, last: NONE, groups: 0 };
}

impl<S, P> PieceStore<S, P> {
    pub(crate) const fn new(slots: P) -> Self {
        Self { slots, fresh: 0, free: NONE, used: 0, pending: PendingPieces::NOTHING, scalar: PhantomData }
    }

    /// Frees all pieces.
    pub(crate) fn clear(&mut self) {
        (self.fresh, self.free, self.used, self.pending) = (0, NONE, 0, PendingPieces::NOTHING);
    }

    /// The container of the slots; more slots may be added at its end.
    #[cfg(feature = "alloc")]
    pub(crate) fn storage(&mut self) -> &mut P {
        &mut self.slots
    }

    /// Number of pieces stored.
    pub(crate) const fn len(&self) -> usize {
        self.used as usize
    }

    /// The first pending piece, or [`NONE`].
    pub(crate) const fn first_pending(&self) -> u32 {
        self.pending.first
    }

    /// Whether the groups of this pair are used up.
    pub(crate) const fn pair_is_full(&self) -> bool {
        self.pending.groups == GROUPS
    }

    /// The last pending piece, or [`NONE`].
    pub(crate) const fn last_pending(&self) -> u32 {
        self.pending.last
    }
}

impl<S, P: AsRef<[Piece<S>]>> PieceStore<S, P> {
    /// The slots, for following a list.
    pub(crate) fn slots(&self) -> &[Piece<S>] {
        self.slots.as_ref()
    }

    /// The piece at this index.
    pub(crate) fn get(&self, index: u32) -> Option<&Piece<S>> {
        self.slots().get(slot(index))
    }

    /// The pending piece after this one; the first one for [`NONE`].
    pub(crate) fn pending_after(&self, index: u32) -> u32 {
        self.get(index).map_or(self.pending.first, |piece| piece.next)
    }
}

impl<S: Scalar, P: AsMut<[Piece<S>]>> PieceStore<S, P> {
    /// Stores the same pieces as another storage, at the same indices; this one is unchanged if they do not fit.
    pub(crate) fn copy_from<O: AsRef<[Piece<S>]>>(&mut self, other: &PieceStore<S, O>) -> Result<(), CapacityError> {
        let (room, used) = (self.slots.as_mut().iter_mut(), other.slots().iter().take(other.fresh as usize));
        if room.len() < used.len() {
            return Err(CapacityError::Pieces { needed: used.len(), capacity: room.len() });
        }
        room.zip(used).for_each(|(slot, piece)| *slot = *piece);
        (self.fresh, self.free, self.used, self.pending) = (other.fresh, other.free, other.used, other.pending);
        Ok(())
    }

    /// Adds a piece to the pending list, with a group of its own.
    pub(crate) fn push(&mut self, piece: Piece<S>) -> Result<u32, CapacityError> {
        let PendingPieces { first, last, groups } = self.pending;
        let index = if self.free == NONE { self.fresh.wrapping_add(1) } else { self.free };
        let (needed, slots) = (self.len().saturating_add(1), self.slots.as_mut());
        let full = CapacityError::Pieces { needed, capacity: slots.len() };
        if groups == GROUPS {
            return Err(full);
        }
        let groups = groups.wrapping_add(1);
        let place = slots.get_mut(slot(index)).ok_or(full)?;
        if self.free == NONE {
            self.fresh = index;
        } else {
            self.free = place.next;
        }
        *place = Piece { group: groups, next: NONE, ..piece };
        if let Some(last) = slots.get_mut(slot(last)) {
            last.next = index;
        }
        // A slot with this index exists, so this does not saturate.
        self.used = self.used.saturating_add(1);
        self.pending = PendingPieces { first: if first == NONE { index } else { first }, last: index, groups };
        Ok(index)
    }

    /// The pending piece at an index returned by [`PieceStore::push`].
    pub(crate) fn get_mut(&mut self, index: u32) -> Option<&mut Piece<S>> {
        self.slots.as_mut().get_mut(slot(index))
    }

    /// Puts two pending pieces, and all pieces that were joined with them, into one region. [`NONE`] is ignored. O(1)
    /// if one of them has not been joined yet, otherwise O(pending pieces).
    pub(crate) fn join(&mut self, a: u32, b: u32) {
        let slots = self.slots.as_mut();
        let group = |index: u32| slots.get(slot(index)).map(|piece| piece.group);
        let (Some(kept), Some(gone)) = (group(a), group(b)) else {
            return;
        };
        if kept == gone {
            return;
        }
        if kept & gone & JOINED == 0 {
            let group = JOINED | if gone & JOINED == 0 { kept } else { gone };
            for index in [a, b] {
                if let Some(piece) = slots.get_mut(slot(index)) {
                    piece.group = group;
                }
            }
            return;
        }
        let mut index = self.pending.first;
        while let Some(piece) = slots.get_mut(slot(index)) {
            if piece.group == gone {
                piece.group = kept;
            }
            index = piece.next;
        }
    }

    /// Moves the first pending piece, and those that were joined with it, from the pending list to a list of their own.
    /// O(1) if there are none, otherwise O(pending pieces).
    pub(crate) fn take_region(&mut self) -> Option<u32> {
        let slots = self.slots.as_mut();
        let head = self.pending.first;
        let group = slots.get(slot(head))?.group;
        let (mut taken, mut rest) = (NONE, NONE);
        let (mut index, mut rest_head) = (head, NONE);
        while let Some(piece) = slots.get_mut(slot(index)) {
            let (member, next) = (piece.group == group, piece.next);
            piece.next = NONE;
            let tail = if member { &mut taken } else { &mut rest };
            let before = core::mem::replace(tail, index);
            match slots.get_mut(slot(before)) {
                Some(before) => before.next = index,
                None if !member => rest_head = index,
                None => {}
            }
            index = next;
            // A piece that was never joined is a region of its own; the rest of the list is unchanged.
            if group & JOINED == 0 {
                (rest_head, rest) = (next, self.pending.last);
                break;
            }
        }
        self.pending = PendingPieces { first: rest_head, last: rest, ..self.pending };
        if rest_head == NONE {
            self.pending = PendingPieces::NOTHING;
        }
        Some(head)
    }

    /// Frees the pieces of a list.
    pub(crate) fn release(&mut self, head: u32) {
        let mut index = head;
        while let Some(piece) = self.slots.as_mut().get_mut(slot(index)) {
            let next = core::mem::replace(&mut piece.next, self.free);
            self.free = index;
            self.used = self.used.saturating_sub(1);
            index = next;
        }
    }

    /// Frees all pending pieces.
    pub(crate) fn take_back(&mut self) {
        let head = self.pending.first;
        self.pending = PendingPieces::NOTHING;
        self.release(head);
    }
}

/// Iterator over the pieces of a list.
#[derive(Debug)]
pub(crate) struct PieceList<'a, S> {
    slots: &'a [Piece<S>],
    next: u32,
}

impl<S> Clone for PieceList<'_, S> {
    fn clone(&self) -> Self {
        Self { ..*self }
    }
}

impl<'a, S> PieceList<'a, S> {
    pub(crate) const fn new(slots: &'a [Piece<S>], head: u32) -> Self {
        Self { slots, next: head }
    }
}

impl<'a, S> Iterator for PieceList<'a, S> {
    type Item = &'a Piece<S>;
    fn next(&mut self) -> Option<&'a Piece<S>> {
        let piece = self.slots.get(slot(self.next))?;
        self.next = piece.next;
        Some(piece)
    }
}

#[cfg(all(test, feature = "libm"))]
mod tests {
    use super::*;
    use crate::geometry::{Point, Pose};
    use crate::path::Path;
    use crate::scalar::Radians;

    fn piece(k: u16) -> Piece<f32> {
        Piece { first_segment: k, ..Piece::EMPTY }
    }

    fn members<const N: usize>(pieces: &PieceStore<f32, [Piece<f32>; N]>, head: u32) -> heapless::Vec<u16, N> {
        PieceList::new(pieces.slots(), head).map(|piece| piece.first_segment).collect()
    }

    #[test]
    fn of_two_intervals_at_a_joint_one_is_thin_but_on_a_whole_circle() {
        let start = Pose { position: Point::new(0.0, 0.0), heading: Radians(0.0) };
        let path = Path::<f32, 1>::starting_at(start).unwrap().line(4.0).unwrap();
        let segment = &path.as_path().segments()[0];
        let [thin, thick, equal] = [(0.0, 0.25), (1.0, 3.0), (0.5, 2.5)].map(|(lo, hi)| Interval::new(lo, hi));
        let at_joint = |lap, both: [Interval<f32>; 2]| {
            let all = Interval::new(0.0, 4.0);
            Piece::new([0; 2], lap, Branch::Only, all, all).at_joint(both.map(Some), segment)
        };
        for lap in [Winding::Previous, Winding::Same, Winding::Next] {
            for both in [[thin, thick], [thick, thin], [thick, equal]] {
                assert_eq!(at_joint(lap, both), [Some(thick), None]);
            }
        }
        assert_eq!(at_joint(Winding::Whole, [thin, thick]), [Some(thin), Some(thick)]);
    }

    #[test]
    fn joined_pieces_become_one_region_in_their_order() {
        let mut pieces = PieceStore::new([Piece::EMPTY; 6]);
        let index: heapless::Vec<u32, 6> = (0..6).map(|k| pieces.push(piece(k)).unwrap()).collect();
        pieces.join(index[4], index[1]);
        pieces.join(index[3], index[5]);
        pieces.join(index[5], index[4]);
        let regions = [(); 3].map(|()| pieces.take_region().unwrap());
        assert_eq!(pieces.take_region(), None);
        assert_eq!(members(&pieces, regions[0])[..], [0]);
        assert_eq!(members(&pieces, regions[1])[..], [1, 3, 4, 5]);
        assert_eq!(members(&pieces, regions[2])[..], [2]);
    }

    #[test]
    fn whatever_is_joined_in_whatever_order_is_one_region() {
        let mut state = 1_u32;
        let mut random = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 16) % 24
        };
        for joins in 0..400 {
            let mut pieces = PieceStore::new([Piece::EMPTY; 24]);
            (0..24).for_each(|k| assert_eq!(pieces.push(piece(k)), Ok(u32::from(k) + 1)));
            let mut groups: [u32; 24] = core::array::from_fn(|k| k as u32);
            for _ in 0..joins % 40 {
                let (a, b) = (random(), random());
                pieces.join(a + 1, b + 1);
                let [kept, gone] = [a, b].map(|index| groups[index as usize]);
                groups.iter_mut().filter(|group| **group == gone).for_each(|group| *group = kept);
            }
            while let Some(head) = pieces.take_region() {
                let all: heapless::Vec<u16, 24> =
                    (0..24).filter(|&k| groups[usize::from(k)] == groups[slot(head)]).collect();
                assert_eq!(members(&pieces, head), all);
                all.iter().for_each(|&k| groups[usize::from(k)] = 24 + u32::from(k));
            }
            assert!(groups.iter().all(|&group| group >= 24));
        }
    }

    #[test]
    fn a_full_store_refuses_and_what_is_released_is_used_again() {
        let mut pieces = PieceStore::new([Piece::EMPTY; 3]);
        for k in 0..2 {
            pieces.push(piece(k)).unwrap();
        }
        let (first, second) = (pieces.take_region().unwrap(), pieces.take_region().unwrap());
        pieces.push(piece(7)).unwrap();
        assert_eq!(pieces.push(piece(8)), Err(CapacityError::Pieces { needed: 4, capacity: 3 }));
        pieces.take_back();
        assert_eq!((&members(&pieces, first)[..], pieces.len()), (&[0][..], 2));
        pieces.release(second);
        for k in 10..12 {
            pieces.push(piece(k)).unwrap();
        }
        assert_eq!(pieces.push(piece(12)), Err(CapacityError::Pieces { needed: 4, capacity: 3 }));
        assert_eq!(members(&pieces, first)[..], [0]);
    }
}
