//! What a piece of a pair of outlines covers.
//!
//! Rounding may change the number of intervals of a slice near an event, or where two outlines touch without moving apart. Then k and n do not
//! tell which interval belongs to the piece, and all that meet its range do: an interval too many is within R, but one too few would be a lost collision.

use super::events::Carriers;
use super::slice::Parts;
use crate::array_vec::ArrayVec;
use crate::error::CapacityError;
use crate::geometry::Interval;
use crate::motion::Motion;
use crate::outline::placed::Carried;
use crate::pair::AgentPair;
use crate::piece_store::{Piece, PieceStore};
use crate::scalar::Scalar;
use crate::segment::Segment;

impl<'a, S: Scalar> Carriers<'a, S> {
    pub(crate) fn new(pair: &AgentPair<'a, S>, first: &'a Segment<S>, second: &'a Segment<S>) -> Self {
        let carried = |segment, motion: &Motion<'_, S>| Carried::new(segment, motion.outline());
        let (first, second) = (carried(first, pair.first), carried(second, pair.second));
        Self { first, second, radius: pair.radius, slack: pair.slack }
    }
}

impl<'a, S: Scalar> AgentPair<'a, S> {
    /// Adds the pieces of a pair of segments and joins those that are connected. Lengths are along the segments.
    // Not inlined: pairs of discs would need the stack of it.
    #[inline(never)]
    pub(crate) fn find_of_outlines<P: AsRef<[Piece<S>]> + AsMut<[Piece<S>]>>(
        &self,
        [first, second]: [&'a Segment<S>; 2],
        indices: [u16; 2],
        pieces: &mut PieceStore<S, P>,
    ) -> Result<(), CapacityError> {
        Carriers::new(self, first, second).find(indices, pieces)
    }
}

impl<S: Scalar> Carriers<'_, S> {
    /// The intervals of a slice of the first segment that belong to a piece with this range, as lengths along the segment;
    /// all of its range, if the slice could not be computed.
    pub(crate) fn of_piece(&self, rank: [u8; 2], range: Interval<S>, at: S) -> Parts<S> {
        let mut own = ArrayVec::new(range);
        let Some(slice) = self.slice_of_first(at) else {
            own.add(range, true);
            return own;
        };
        let [k, of] = rank.map(usize::from);
        let range = range.widen(self.slack, Interval::new(S::ZERO, self.first.segment.length));
        if slice.as_slice().len() == of
            && let Some(&part) = slice.as_slice().get(k)
            && part.meets(range)
        {
            own.add(part, true);
            return own;
        }
        for part in slice.as_slice().iter().filter(|part| part.meets(range)) {
            own.add(part.common(range), true);
        }
        own
    }

    /// The intervals of a slice of the second segment at a length of the first that belong to a piece with these ranges.
    ///
    /// An interval is connected, so it belongs to the region of a piece if any place of it does. A place that is in no interval of the
    /// slice of the first segment, which only rounding can cause, may belong to any piece.
    pub(crate) fn of_piece_on_second(&self, rank: [u8; 2], [first, second]: [Interval<S>; 2], at: S) -> Parts<S> {
        let mut own = ArrayVec::new(second);
        let Some(slice) = self.slice_of_second(at) else {
            own.add(second, true);
            return own;
        };
        for part in slice.as_slice().iter().filter(|part| part.meets(second)) {
            let part = part.common(second);
            let middle = part.middle();
            let places = [
                middle,
                part.lo,
                part.hi,
                Interval::new(part.lo, middle).middle(),
                Interval::new(middle, part.hi).middle(),
            ];
            own.add(part, places.into_iter().any(|place| self.holds(rank, first, at, place)));
        }
        own
    }

    /// Whether a point belongs to a piece, or to none.
    fn holds(&self, rank: [u8; 2], range: Interval<S>, at: S, place: S) -> bool {
        let near = |part: &Interval<S>| part.lo - self.slack <= at && at <= part.hi + self.slack;
        let own = self.of_piece(rank, range, place);
        own.as_slice().iter().any(near)
            || self.slice_of_first(place).is_none_or(|slice| !slice.as_slice().iter().any(near))
    }
}

impl<S: Scalar> AgentPair<'_, S> {
    /// Whether any of the two is not a disc about its reference point.
    pub(crate) fn has_outline(&self) -> bool {
        self.first.has_outline() | self.second.has_outline()
    }

    /// Returns the interval at this index of a slice of a piece of outlines, along the path of the first agent or of the second one, and whether
    /// there may be more.
    // Not inlined: pairs of discs would need the stack of it.
    #[inline(never)]
    pub(crate) fn part_at(
        &self,
        piece: &Piece<S>,
        of_second: bool,
        at: S,
        index: usize,
    ) -> (Option<Interval<S>>, bool) {
        let (Some(own), Some(other)) = self.segments(piece) else { return (None, false) };
        let range = if of_second { piece.first } else { piece.second };
        if !range.contains(at) {
            return (None, false);
        }
        let carriers = Carriers::new(self, own, other);
        let [first, second] = [along(piece.first, own), along(piece.second, other)];
        let (parts, segment) = if of_second {
            (carriers.of_piece_on_second(piece.rank(), [first, second], at - own.from), other)
        } else {
            (carriers.of_piece(piece.rank(), first, at - other.from), own)
        };
        let parts = parts.as_slice();
        let part = parts.get(index).map(|&part| crate::pair::along_path(part, segment));
        (part, index.saturating_add(1) < parts.len())
    }

    /// Whether two pieces of neighbouring segments of the second path, and of one segment of the first, share a length at the joint.
    // Not inlined: pairs of discs would need the stack of it.
    #[inline(never)]
    pub(crate) fn outlines_meet_at_joint_of_second(&self, before: &Piece<S>, after: &Piece<S>) -> bool {
        let ((Some(own), Some(other)), (_, Some(next))) = (self.segments(before), self.segments(after)) else {
            return false;
        };
        let [end, begin] = [
            Carriers::new(self, own, other).of_piece(before.rank(), before.first, other.length),
            Carriers::new(self, own, next).of_piece(after.rank(), after.first, S::ZERO),
        ];
        end.as_slice().iter().any(|part| begin.as_slice().iter().any(|other| other.meets(*part)))
    }

    /// Whether two pieces of neighbouring segments of the first path, and of one segment of the second, share a length at the joint.
    // Not inlined: pairs of discs would need the stack of it.
    #[inline(never)]
    pub(crate) fn outlines_meet_at_joint_of_first(&self, before: &Piece<S>, after: &Piece<S>) -> bool {
        let ((Some(own), Some(other)), (Some(next), _)) = (self.segments(before), self.segments(after)) else {
            return false;
        };
        let [end, begin] = [
            Carriers::new(self, own, other).of_piece_on_second(
                before.rank(),
                [before.first, before.second],
                own.length,
            ),
            Carriers::new(self, next, other).of_piece_on_second(after.rank(), [after.first, after.second], S::ZERO),
        ];
        end.as_slice().iter().any(|part| begin.as_slice().iter().any(|other| other.meets(*part)))
    }
}

/// Lengths of a path as lengths of a segment of it.
fn along<S: Scalar>(part: Interval<S>, segment: &Segment<S>) -> Interval<S> {
    let at = |length: S| if length < segment.to { (length - segment.from).max(S::ZERO) } else { segment.length };
    Interval::new(at(part.lo), at(part.hi))
}
