//! From events to pieces: the collision region of one segment against one segment.
//!
//! The events cut the second segment into slabs, in each of which the disc covers something of the first one all along or
//! nothing at all: its middle tells. Neighbouring slabs that are covered are parts of one piece, if one lap at most of the
//! first segment can be covered and no disc fits an arc ([`super::laps`] is for the others).
//!
//! The lengths of a piece are the hull of its slices where it begins and ends, of the ends of the first segment where they
//! are covered, and of the turning points: nothing between them can be extreme. Inside the second segment a piece begins
//! and ends in a point. There it is the foot, which is right where a turning point between almost parallel lines is lost
//! to rounding.

use super::events::{Events, turning_points, wraps};
use super::footprint::{Footprint, Lap, Reach, Share};
use crate::error::Full;
use crate::geometry::Interval;
use crate::pieces::{Piece, Pieces};
use crate::scalar::Scalar;
use crate::segment::{Curve, Segment};

/// Two segments, by their places in the two paths.
#[derive(Clone, Copy)]
pub(crate) struct SegmentPair<'a, S: Scalar> {
    pub(crate) first: &'a Segment<S>,
    pub(crate) second: &'a Segment<S>,
    pub(crate) indices: [u16; 2],
    /// Combined radius, slack included \[m\].
    pub(crate) radius: S,
    /// What distances may be off \[m\].
    pub(crate) slack: S,
}

impl<S: Scalar> SegmentPair<'_, S> {
    /// Adds the pieces of this pair, joined where they are connected. Lengths are those along the segments.
    pub(crate) fn find<P: AsRef<[Piece<S>]> + AsMut<[Piece<S>]>>(&self, pieces: &mut Pieces<S, P>) -> Result<(), Full> {
        let events = Events::of(self.first, self.second, self.radius, self.slack);
        let in_order = events.in_order();
        // Events may coincide; a second segment of length 0 has one slab only.
        let slabs = in_order.iter().zip(in_order.iter().skip(1)).map(|(&lo, &hi)| Interval::new(lo, hi));
        let slabs = slabs.filter(|slab| slab.lo < slab.hi || self.second.length == S::ZERO);
        let by_laps = wraps(self.first, self.radius) || self.fits(self.first) || self.fits(self.second);
        let begin = pieces.last_pending();
        if by_laps {
            self.find_laps(slabs, pieces)?;
        } else {
            self.find_one_lap(slabs, pieces)?;
        }
        if pieces.last_pending() != begin {
            turning_points(self.first, self.second, &events, self.radius, self.slack, |l, s| {
                let slices = if by_laps { self.slices(s) } else { [Some(Interval::new(l, l)), None] };
                self.turn_back(pieces, begin, slices, s, by_laps);
            });
        }
        Ok(())
    }

    /// Whether a disc fits an arc so well that contact from inside is contact all around: then rounding decides where
    /// it is, and slices are taken everywhere.
    fn fits(&self, segment: &Segment<S>) -> bool {
        let around = (0..6).fold(self.slack, |slack, _| slack.double());
        matches!(segment.curve, Curve::Arc { radius, .. } if (radius - self.radius).abs() <= around)
    }

    fn find_one_lap<P: AsRef<[Piece<S>]> + AsMut<[Piece<S>]>>(
        &self,
        slabs: impl Iterator<Item = Interval<S>>,
        pieces: &mut Pieces<S, P>,
    ) -> Result<(), Full> {
        let mut open = None;
        for slab in slabs {
            let point = self.second.point_at(slab.middle());
            let covered = Footprint::of(point, self.first).covered(point, self.first, self.radius);
            open = match (open, covered) {
                (None, None) => None,
                (None, Some(first)) => Some((first.hull(self.slice_at_end(slab.lo)), slab)),
                (Some((first, second)), Some(covered)) => Some((first.hull(covered), second.hull(slab))),
                (Some((first, second)), None) => {
                    self.push(first, second, pieces)?;
                    None
                }
            };
        }
        match open {
            Some((first, second)) => self.push(first, second, pieces),
            None => Ok(()),
        }
    }

    fn push<P: AsRef<[Piece<S>]> + AsMut<[Piece<S>]>>(
        &self,
        first: Interval<S>,
        second: Interval<S>,
        pieces: &mut Pieces<S, P>,
    ) -> Result<(), Full> {
        let first = first.hull(self.slice_at_end(second.hi));
        pieces.push(Piece::new(self.indices, Lap::Same, Share::Only, first, second)).map(|_| ())
    }

    /// The slice where a piece begins or ends. Inside the second segment it is a point, the foot.
    fn slice_at_end(&self, s: S) -> Interval<S> {
        let footprint = Footprint::of(self.second.point_at(s), self.first);
        let outer = s <= S::ZERO || s >= self.second.length;
        let (foot, half) = match if outer { footprint.reach(self.first, self.radius) } else { Reach::Nothing } {
            Reach::Around { foot, half } => (foot, half),
            Reach::Nothing | Reach::Whole => (footprint.foot(self.first), S::ZERO),
        };
        Interval::new(foot - half, foot + half).widen(S::ZERO, Interval::new(S::ZERO, self.first.length))
    }

    /// Adds the slices at a turning point to the pieces after `begin` that cover it.
    fn turn_back<P: AsRef<[Piece<S>]> + AsMut<[Piece<S>]>>(
        &self,
        pieces: &mut Pieces<S, P>,
        begin: u32,
        slices: [Option<Interval<S>>; 2],
        s: S,
        by_laps: bool,
    ) {
        let mut index = pieces.pending_after(begin);
        while let Some(piece) = pieces.get_mut(index) {
            if piece.second.contains(s) {
                // With one lap there is no doubt whose end it is.
                let own = if by_laps { piece.share.of(slices, self.first, piece.first) } else { slices };
                for slice in own {
                    piece.first = slice.map_or(piece.first, |slice| piece.first.hull(slice));
                }
            }
            index = piece.next;
        }
    }
}
