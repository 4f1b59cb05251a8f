//! From events to pieces: a walk along the second segment.
//!
//! Between two events the number of intervals of a slice of the first segment is constant, and they move continuously in their order
//! (Theorem 1). A piece is the k-th of n intervals, as long as it is that. Slices are taken a little beside each event, on both sides, and where
//! an end may be extreme, and in the middle; the range of a piece is their hull.
//!
//! A little means that no corner moves farther than a quarter of the slack σ. Regions are computed for R + σ. So whatever is
//! within R at the event, or between it and the slice, is also in the slice: no range misses it, although the limit at a tangential event moves
//! with the square root of a step. For the same reason two intervals on both sides of an event that are connected within R have
//! lengths in common; and if they have, they are connected within R + 2σ.
//!
//! If the number of intervals changes without an event, which only rounding can cause, the place is found by bisection and taken as an event.
//! It is found to within a little, too: a piece that ends there holds no point that is farther.

use super::contacts::Standing;
use super::events::{Carriers, Events};
use super::slice::{MOST_PARTS, Parts, parts, parts_beside};
use crate::error::CapacityError;
use crate::geometry::Interval;
use crate::piece_store::{NO_NUMBER, Piece, PieceStore};
use crate::scalar::Scalar;

/// Largest number of halvings of a gap between two slices of different structure: enough for the digits of any format.
pub(crate) const HALVINGS: u32 = 64;

/// A slice, and the numbers of the pieces of its intervals.
struct Front<S> {
    parts: Parts<S>,
    pieces: [u16; MOST_PARTS],
}

impl<S: Scalar> Carriers<'_, S> {
    /// Adds the pieces of this pair of segments and joins those that are connected. Lengths are along the segments.
    ///
    /// # Errors
    /// [`CapacityError::Pieces`]; [`CapacityError::Contacts`] if a list of contacts is too short.
    // Not inlined: pairs of discs would need the stack of it.
    #[inline(never)]
    pub(crate) fn find<P: AsRef<[Piece<S>]> + AsMut<[Piece<S>]>>(
        &self,
        indices: [u16; 2],
        pieces: &mut PieceStore<S, P>,
    ) -> Result<(), CapacityError> {
        if self.first.is_straight() && self.second.is_straight() {
            return self.find_on_lines(indices, pieces);
        }
        let events = self.events().ok_or(CapacityError::Contacts)?;
        let mut turning = None;
        let beside = self.second.within(self.slack.half().half());
        let mut front = Front { parts: Parts::new(Interval::new(S::ZERO, S::ZERO)), pieces: [NO_NUMBER; MOST_PARTS] };
        let events = events.as_slice();
        let slabs = events.iter().zip(events.iter().skip(1)).map(|(&lo, &hi)| Interval::new(lo, hi));
        for slab in slabs.filter(|slab| slab.lo < slab.hi || self.second.segment.length == S::ZERO) {
            let wide = slab.length() > beside.double();
            let [lo, hi] = if wide { [slab.lo + beside, slab.hi - beside] } else { [slab.middle(); 2] };
            let slice = self.slice(lo)?;
            front = self.cross(&front, slice, slab, indices, pieces)?;
            // An event is off by more than a little where the outlines touch at a small angle, and both ends of a slab may be empty although its
            // middle is not.
            let (middle, mut all) = (slab.middle(), Events::new(S::ZERO));
            let covered = !front.parts.as_slice().is_empty() || wide && !self.slice(middle)?.as_slice().is_empty();
            if covered && wide {
                if turning.is_none() {
                    turning = Some(self.turning().ok_or(CapacityError::Contacts)?);
                }
                let places = turning.as_ref().map(|turning| turning.as_slice()).unwrap_or_default();
                let inside = places.iter().copied().filter(|&place| lo < place && place < hi && place != middle);
                if !inside.chain([middle]).all(|place| all.push(place)) {
                    return Err(CapacityError::Contacts);
                }
                all.sort();
            }
            let mut from = lo;
            for to in all.as_slice().iter().copied().chain(wide.then_some(hi)) {
                let slice = self.slice(to)?;
                front = self.follow(front, slice, Interval::new(from, to), [slab.hi, beside], indices, pieces)?;
                from = to;
            }
        }
        Ok(())
    }

    /// The parts of the first segment that are covered at a length of the second.
    fn slice(&self, at: S) -> Result<Parts<S>, CapacityError> {
        parts_beside(&self.first, &self.second, at, [self.radius, self.slack]).ok_or(CapacityError::Contacts)
    }

    /// The parts of the second segment that are covered at a length of the first.
    pub(crate) fn slice_of_second(&self, at: S) -> Option<Parts<S>> {
        parts_beside(&self.second, &self.first, at, [self.radius, self.slack])
    }

    /// The parts of the first segment that are covered at a length of the second.
    pub(crate) fn slice_of_first(&self, at: S) -> Option<Parts<S>> {
        let corners = self.second.at(at, self.first.origin);
        parts(&self.first, Standing { corners: corners.as_slice(), radius: self.radius, slack: self.slack })
    }

    /// Continues the pieces from one slice to the next one in a slab, which ends at `until`. Within `beside` no corner moves more than a little.
    fn follow<P: AsRef<[Piece<S>]> + AsMut<[Piece<S>]>>(
        &self,
        mut front: Front<S>,
        slice: Parts<S>,
        step: Interval<S>,
        [until, beside]: [S; 2],
        indices: [u16; 2],
        pieces: &mut PieceStore<S, P>,
    ) -> Result<Front<S>, CapacityError> {
        let mut from = step.lo;
        // A change of structure takes one round; more than a few are not due to rounding, and then one step crosses them all.
        for round in 0..4 {
            if front.parts.as_slice().len() == slice.as_slice().len() {
                break;
            }
            let (mut near, mut to) = (slice, step.hi);
            for _ in 0..HALVINGS {
                let middle = Interval::new(from, to).middle();
                if round == 3 || to - from <= beside || middle <= from || middle >= to {
                    break;
                }
                let between = self.slice(middle)?;
                if between.as_slice().len() == front.parts.as_slice().len() {
                    extend(&front, &between, pieces);
                    from = middle;
                } else {
                    (near, to) = (between, middle);
                }
            }
            for &piece in front.pieces.iter().take(front.parts.as_slice().len()) {
                if let Some(piece) = pieces.get_mut(piece) {
                    piece.second.hi = to;
                }
            }
            front = self.cross(&front, near, Interval::new(from, until), indices, pieces)?;
            from = to;
        }
        extend(&front, &slice, pieces);
        front.parts = slice;
        Ok(front)
    }

    /// Begins or continues a piece for each interval of a slice behind an event, and joins it with those that it is connected with.
    fn cross<P: AsRef<[Piece<S>]> + AsMut<[Piece<S>]>>(
        &self,
        before: &Front<S>,
        slice: Parts<S>,
        second: Interval<S>,
        indices: [u16; 2],
        pieces: &mut PieceStore<S, P>,
    ) -> Result<Front<S>, CapacityError> {
        let mut front = Front { parts: slice, pieces: [NO_NUMBER; MOST_PARTS] };
        let (old, new) = (before.parts.as_slice(), slice.as_slice());
        for (k, &part) in new.iter().enumerate() {
            let goes_on = old.len() == new.len() && old.get(k).is_some_and(|old| old.meets(part));
            let same = before.pieces.get(k).copied().filter(|_| goes_on);
            let index = match same.and_then(|index| pieces.get_mut(index).map(|piece| (index, piece))) {
                Some((index, piece)) => {
                    piece.first = piece.first.hull(part);
                    piece.second.hi = second.hi;
                    index
                }
                None => pieces.push(Piece::ranked(indices, [k as u8, new.len() as u8], part, second))?,
            };
            if let Some(place) = front.pieces.get_mut(k) {
                *place = index;
            }
            for (old, &piece) in old.iter().zip(&before.pieces) {
                if old.meets(part) {
                    pieces.join(piece, index);
                }
            }
        }
        Ok(front)
    }
}

/// Extends the ranges of pieces by the intervals of another slice of the same structure.
fn extend<S: Scalar, P: AsRef<[Piece<S>]> + AsMut<[Piece<S>]>>(
    front: &Front<S>,
    slice: &Parts<S>,
    pieces: &mut PieceStore<S, P>,
) {
    for (&part, &piece) in slice.as_slice().iter().zip(&front.pieces) {
        if let Some(piece) = pieces.get_mut(piece) {
            piece.first = piece.first.hull(part);
        }
    }
}
