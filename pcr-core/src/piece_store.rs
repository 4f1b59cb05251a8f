//! Storage of region pieces with a fixed capacity. A piece is the part of a region that belongs to one pair of
//! segments.
//!
//! The slots in use are the first ones. While a pair of agents is computed, its pieces are *pending*: the last ones, and
//! numbered from 1. Those that are joined are in one tree of a union-find forest. At the end the pieces of each tree
//! become a region, which is a linked list inside the storage. When regions are removed, pieces from the end take the
//! slots of theirs.

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

/// The number of no pending piece.
pub(crate) const NO_NUMBER: u16 = 0;

/// Bit in the parent of a pending piece that says that a region begins with it. The rest is the number of the last piece of the region so far.
const FIRST: u16 = 1 << 15;

/// Largest number of pieces of a pair.
const MOST_PENDING: u16 = (1 << 15) - 1;

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
    /// Of a pending piece, the number of one of the same region that is not behind it: itself at the root of a tree.
    parent: u16,
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
        parent: 0,
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
        Self { first, second, first_segment, second_segment, rank, parent: 0, next: NONE }
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

/// The storage, in slots of the caller.
#[derive(Clone, Debug)]
pub(crate) struct PieceStore<S, P> {
    slots: P,
    /// Number of slots in use.
    used: u32,
    /// Number of pieces that are not pending.
    settled: u32,
    /// Number of the first piece of the region that was taken last.
    taken: u16,
    scalar: PhantomData<S>,
}

impl<S, P> PieceStore<S, P> {
    pub(crate) const fn new(slots: P) -> Self {
        Self { slots, used: 0, settled: 0, taken: NO_NUMBER, scalar: PhantomData }
    }

    /// Frees all pieces.
    pub(crate) fn clear(&mut self) {
        (self.used, self.settled, self.taken) = (0, 0, NO_NUMBER);
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

    /// Number of pending pieces, and so the number of the last one.
    pub(crate) const fn pending(&self) -> u16 {
        self.used.wrapping_sub(self.settled) as u16
    }

    /// Whether this pair has as many pieces as a pair can have.
    pub(crate) const fn pair_is_full(&self) -> bool {
        self.pending() == MOST_PENDING
    }

    /// Index of the pending piece with this number.
    const fn index(&self, number: u16) -> u32 {
        self.settled.wrapping_add(number as u32)
    }

    /// Frees all pending pieces.
    pub(crate) fn take_back(&mut self) {
        self.used = self.settled;
    }

    /// Ends the pair: its pieces are no longer pending.
    pub(crate) fn settle(&mut self) {
        (self.settled, self.taken) = (self.used, NO_NUMBER);
    }
}

impl<S, P: AsRef<[Piece<S>]>> PieceStore<S, P> {
    /// The slots, for following a list.
    pub(crate) fn slots(&self) -> &[Piece<S>] {
        self.slots.as_ref()
    }

    /// The pending piece with this number.
    pub(crate) fn get(&self, number: u16) -> Option<&Piece<S>> {
        self.slots().get(slot(self.index(number)))
    }

    /// Makes the next region of those that [`PieceStore::form_regions`] has formed a list, and returns its first piece. After the last one, no
    /// piece is pending. O(pieces of the pair), for all its regions together.
    pub(crate) fn take_region(&mut self) -> Option<u32> {
        while self.taken < self.pending() {
            self.taken = self.taken.wrapping_add(1);
            if self.get(self.taken).is_some_and(|piece| piece.parent & FIRST != 0) {
                return Some(self.index(self.taken));
            }
        }
        self.settle();
        None
    }
}

impl<S: Scalar, P: AsMut<[Piece<S>]>> PieceStore<S, P> {
    /// Stores the same pieces as another storage, at the same indices; this one is unchanged if they do not fit.
    pub(crate) fn copy_from<O: AsRef<[Piece<S>]>>(&mut self, other: &PieceStore<S, O>) -> Result<(), CapacityError> {
        let (room, used) = (self.slots.as_mut().iter_mut(), other.slots().iter().take(other.len()));
        if room.len() < used.len() {
            return Err(CapacityError::Pieces { needed: used.len(), capacity: room.len() });
        }
        room.zip(used).for_each(|(slot, piece)| *slot = *piece);
        (self.used, self.settled, self.taken) = (other.used, other.settled, other.taken);
        Ok(())
    }

    /// Adds a pending piece, as a region of its own, and returns its number.
    pub(crate) fn push(&mut self, piece: Piece<S>) -> Result<u16, CapacityError> {
        let (needed, is_full, slots) = (self.len().saturating_add(1), self.pair_is_full(), self.slots.as_mut());
        let full = CapacityError::Pieces { needed, capacity: slots.len() };
        let place = slots.get_mut(self.used as usize).filter(|_| !is_full).ok_or(full)?;
        // A slot with this index exists, and a pair has less than 2^16 pieces.
        self.used = self.used.wrapping_add(1);
        let number = self.used.wrapping_sub(self.settled) as u16;
        *place = Piece { parent: number, next: NONE, ..piece };
        Ok(number)
    }

    /// The pending piece with this number.
    pub(crate) fn get_mut(&mut self, number: u16) -> Option<&mut Piece<S>> {
        let index = self.index(number);
        self.slots.as_mut().get_mut(slot(index)).filter(|_| number != NO_NUMBER)
    }

    /// The pending pieces behind the one with this number.
    pub(crate) fn behind(&mut self, number: u16) -> &mut [Piece<S>] {
        let (first, used) = (self.index(number) as usize, self.len());
        self.slots.as_mut().get_mut(first..used).unwrap_or_default()
    }

    /// Puts two pending pieces, and all pieces that were joined with them, into one region. [`NO_NUMBER`] is ignored.
    /// O(log pending pieces), averaged over all that are joined.
    pub(crate) fn join(&mut self, a: u16, b: u16) {
        if a != NO_NUMBER && b != NO_NUMBER {
            let (a, b) = (self.root(a), self.root(b));
            self.set_parent(a.max(b), a.min(b));
        }
    }

    fn parent(&mut self, number: u16) -> u16 {
        self.get_mut(number).map_or(number, |piece| piece.parent)
    }

    fn set_parent(&mut self, number: u16, parent: u16) {
        if let Some(piece) = self.get_mut(number) {
            piece.parent = parent;
        }
    }

    /// The number of the first of all pieces that a pending piece was joined with. Every step halves the way to it for later ones.
    fn root(&mut self, mut number: u16) -> u16 {
        loop {
            let parent = self.parent(number);
            if parent == number {
                return number;
            }
            let before = self.parent(parent);
            self.set_parent(number, before);
            number = before;
        }
    }

    /// Makes a list of the pieces of each region, in their order, and calls `each` with every piece. Afterwards no piece may be added or
    /// joined. O(pending pieces).
    pub(crate) fn form_regions(&mut self, mut each: impl FnMut(&mut Piece<S>)) {
        let settled = self.settled;
        let pending = self.behind(NO_NUMBER);
        for place in 0..pending.len() {
            let number = (place as u16).wrapping_add(1);
            let Some(piece) = pending.get_mut(place) else { break };
            each(piece);
            let parent = core::mem::replace(&mut piece.parent, FIRST | number);
            if parent == number {
                continue;
            }
            // Of the pieces before this one, each that is not the first of its region has that one as its parent.
            let Some(before) = pending.get(slot(parent.into())) else { break };
            let first = if before.parent & FIRST == 0 { before.parent } else { parent };
            if let Some(piece) = pending.get_mut(place) {
                piece.parent = first;
            }
            let Some(first) = pending.get_mut(slot(first.into())) else { break };
            let last = core::mem::replace(&mut first.parent, FIRST | number) & !FIRST;
            if let Some(last) = pending.get_mut(slot(last.into())) {
                last.next = settled.wrapping_add(number.into());
            }
        }
    }

    /// Frees all pieces but those of these lists, and moves the latter to the first slots: `head` tells the first piece of a list.
    /// O(pieces).
    pub(crate) fn keep<L>(&mut self, lists: &mut [L], head: impl Fn(&mut L) -> &mut u32) {
        let (used, slots) = (self.len(), self.slots.as_mut());
        // The parent of a settled piece says whether it is kept.
        slots.iter_mut().take(used).for_each(|piece| piece.parent = 0);
        let mut kept = 0_u32;
        for list in &mut *lists {
            let mut index = *head(list);
            while let Some(piece) = slots.get_mut(slot(index)) {
                (piece.parent, index) = (1, piece.next);
                // A slot with this index exists.
                kept = kept.wrapping_add(1);
            }
        }
        let mut free = NONE;
        // The index of a piece that is at `index` now.
        let mut moved = |slots: &mut [Piece<S>], index: u32| {
            let Some(&piece) = slots.get(slot(index)).filter(|_| index > kept) else { return index };
            // There are as many free slots as pieces behind the last slot that is kept.
            loop {
                free = free.wrapping_add(1);
                match slots.get_mut(slot(free)) {
                    Some(place) if place.parent == 0 => *place = piece,
                    Some(_) => continue,
                    None => {}
                }
                return free;
            }
        };
        for list in lists {
            let mut index = moved(slots, *head(list));
            *head(list) = index;
            while let Some(next) = slots.get(slot(index)).map(|piece| piece.next) {
                let next = moved(slots, next);
                if let Some(piece) = slots.get_mut(slot(index)) {
                    piece.next = next;
                }
                index = next;
            }
        }
        (self.used, self.settled) = (kept, kept);
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
        let numbers: heapless::Vec<u16, 6> = (0..6).map(|k| pieces.push(piece(k)).unwrap()).collect();
        pieces.join(numbers[4], numbers[1]);
        pieces.join(numbers[3], numbers[5]);
        pieces.join(numbers[5], numbers[4]);
        pieces.form_regions(|_| {});
        let regions = [(); 3].map(|()| pieces.take_region().unwrap());
        assert_eq!(pieces.take_region(), None);
        assert_eq!(members(&pieces, regions[0])[..], [0]);
        assert_eq!(members(&pieces, regions[1])[..], [1, 3, 4, 5]);
        assert_eq!(members(&pieces, regions[2])[..], [2]);
    }

    /// Numbers below `below`, from a linear congruential generator.
    fn random(state: &mut u32, below: usize) -> usize {
        *state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (*state >> 16) as usize % below
    }

    #[test]
    fn whatever_is_joined_in_whatever_order_is_one_region() {
        let mut state = 1;
        for joins in 0..400 {
            let mut pieces = PieceStore::new([Piece::EMPTY; 24]);
            (0..24).for_each(|k| assert_eq!(pieces.push(piece(k)), Ok(k + 1)));
            let mut groups: [usize; 24] = core::array::from_fn(|k| k);
            for _ in 0..joins % 40 {
                let pair = [(); 2].map(|()| random(&mut state, 24));
                pieces.join(pair[0] as u16 + 1, pair[1] as u16 + 1);
                let [kept, gone] = pair.map(|k| groups[k]);
                groups.iter_mut().filter(|group| **group == gone).for_each(|group| *group = kept);
            }
            pieces.form_regions(|_| {});
            for first in 0..24 {
                let all: heapless::Vec<u16, 24> =
                    (0..24).filter(|&k| groups[usize::from(k)] == groups[usize::from(first)]).collect();
                if all[0] == first {
                    let head = pieces.take_region().unwrap();
                    assert_eq!(members(&pieces, head), all);
                }
            }
            assert_eq!((pieces.take_region(), pieces.pending()), (None, 0));
        }
    }

    /// Adds a region of the pieces with these numbers.
    fn add<const N: usize>(pieces: &mut PieceStore<f32, [Piece<f32>; N]>, all: core::ops::Range<u16>) -> u32 {
        for k in all {
            let number = pieces.push(piece(k)).unwrap();
            pieces.join(1, number);
        }
        pieces.form_regions(|_| {});
        let head = pieces.take_region().unwrap();
        assert_eq!(pieces.take_region(), None);
        head
    }

    #[test]
    fn what_is_kept_stays_as_it_is_and_takes_the_first_slots() {
        let mut state = 1;
        for _ in 0..400 {
            let mut pieces = PieceStore::new([Piece::EMPTY; 40]);
            let mut lists = heapless::Vec::<(core::ops::Range<u16>, u32), 40>::new();
            for round in 0..8 {
                while let begin = 100 * round + pieces.len() as u16
                    && let count @ 1.. = random(&mut state, 7)
                    && pieces.len() + count <= 40
                {
                    let all = begin..begin + count as u16;
                    let head = add(&mut pieces, all.clone());
                    lists.push((all, head)).unwrap();
                }
                lists.retain(|_| random(&mut state, 3) > 0);
                // Tables are not in the order of their slots.
                lists.sort_unstable_by_key(|(all, _)| all.start % 7);
                pieces.keep(&mut lists, |(_, head)| head);
                assert_eq!(pieces.len(), lists.iter().map(|(all, _)| all.len()).sum());
                for (all, head) in &lists {
                    assert!(members(&pieces, *head).into_iter().eq(all.clone()));
                }
            }
        }
    }

    #[test]
    fn a_full_store_refuses_and_what_is_freed_is_used_again() {
        let mut pieces = PieceStore::new([Piece::EMPTY; 3]);
        let (first, _) = (add(&mut pieces, 0..1), add(&mut pieces, 1..2));
        pieces.push(piece(7)).unwrap();
        assert_eq!(pieces.push(piece(8)), Err(CapacityError::Pieces { needed: 4, capacity: 3 }));
        pieces.take_back();
        assert_eq!((&members(&pieces, first)[..], pieces.len()), (&[0][..], 2));
        pieces.keep(&mut [first], |head| head);
        for k in 10..12 {
            pieces.push(piece(k)).unwrap();
        }
        assert_eq!(pieces.push(piece(12)), Err(CapacityError::Pieces { needed: 4, capacity: 3 }));
        assert_eq!(members(&pieces, first)[..], [0]);
    }

    #[test]
    fn a_pair_has_at_most_32767_pieces_whatever_there_is_room_for() {
        extern crate std;
        let mut pieces = PieceStore::new(std::vec![Piece::EMPTY; 100_000]);
        for round in 1..=2 {
            for k in 0..32767 {
                let number = pieces.push(piece(k)).unwrap();
                // Three regions that take turns.
                pieces.join(number.saturating_sub(3), number);
            }
            assert!(pieces.pair_is_full());
            assert!(pieces.push(piece(0)).is_err());
            pieces.form_regions(|_| {});
            for k in 0..3 {
                let head = pieces.take_region().unwrap();
                let all = PieceList::new(pieces.slots(), head).map(|piece| piece.first_segment);
                assert!(all.eq((k..32767).step_by(3)));
            }
            assert_eq!((pieces.take_region(), pieces.len()), (None, round * 32767));
        }
    }
}
