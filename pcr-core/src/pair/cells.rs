//! From events to pieces: the collision region of one segment against one segment.
//!
//! The events cut the second segment into slabs, in each of which the disc covers something of the first one all along or
//! nothing at all: its middle tells. Neighbouring slabs that are covered are parts of one piece, if one lap at most of the
//! first segment can be covered ([`super::laps`] is for the others).
//!
//! The lengths of a piece are the hull of its slices where it begins and ends, of the ends of the first segment where they
//! are covered, and of the turning points: nothing between them can be extreme. Inside the second segment a piece begins
//! and ends in a point. There it is the foot, which is right where a turning point between almost parallel lines is lost
//! to rounding.

use super::events::{add_events, add_turning_lengths, wraps};
use super::footprint::{Footprint, Lap, Reach, Share};
use super::lengths::Lengths;
use super::offset::on_first_lap;
use crate::bits::Runs;
use crate::error::Full;
use crate::geometry::Interval;
use crate::pieces::{Piece, Pieces};
use crate::scalar::Scalar;
use crate::segment::Segment;

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

/// What is covered of the first segment, a bit a slab: no branch depends on what is as good as random.
struct Slabs {
    /// Anything.
    any: u32,
    /// Its start.
    start: u32,
    /// Its end.
    end: u32,
}

impl<S: Scalar> SegmentPair<'_, S> {
    /// Adds the pieces of this pair, joined where they are connected. Lengths are those along the segments.
    pub(crate) fn find<P: AsRef<[Piece<S>]> + AsMut<[Piece<S>]>>(&self, pieces: &mut Pieces<S, P>) -> Result<(), Full> {
        let (mut events, mut turning) = (Lengths::new(S::ZERO), Lengths::new(S::ZERO));
        let ends = add_events(self.first, self.second, self.radius, self.slack, &mut events);
        // Taken from where it is needed: a processor that looks ahead has something to do while events are put in order.
        add_turning_lengths(self.first, self.second, ends, self.radius, self.slack, &mut turning);
        events.sort();
        let in_order = events.as_slice();
        let begin = pieces.last_pending();
        if wraps(self.first, self.radius, self.slack) {
            self.find_laps(in_order, pieces)?;
        } else {
            self.find_one_lap(in_order, pieces)?;
        }
        if pieces.last_pending() == begin {
            return Ok(());
        }
        for &l in turning.as_slice() {
            self.turn_back(pieces, begin, l);
        }
        Ok(())
    }

    /// Whether this slab, between two neighbouring events, is one. Events may coincide; a second segment of length 0 has one
    /// slab only.
    pub(super) fn is_slab(&self, slab: Interval<S>) -> bool {
        (slab.lo < slab.hi) | (self.second.length == S::ZERO)
    }

    /// The pieces where one lap at most can be covered: runs of slabs.
    fn find_one_lap<P: AsRef<[Piece<S>]> + AsMut<[Piece<S>]>>(
        &self,
        in_order: &[S],
        pieces: &mut Pieces<S, P>,
    ) -> Result<(), Full> {
        let Slabs { mut any, start, end } = self.slabs(in_order, self.radius);
        if Runs(any).rest() != 0 {
            // A gap between two runs may be one by rounding alone, and the turning points in it then those of no piece.
            let near = self.slabs(in_order, self.reach()).any;
            let between = !(any ^ any.wrapping_sub(1)) & u32::MAX.wrapping_shr(any.leading_zeros());
            for gap in Runs(between & !any) {
                any |= if gap & !near == 0 { gap } else { 0 };
            }
        }
        let event = |place: u32| in_order.get(place as usize).copied().unwrap_or(self.second.length);
        for run in Runs(any) {
            let second = Interval::new(event(run.trailing_zeros()), event(u32::BITS - run.leading_zeros()));
            let slices = self.slice_at_end(second.lo).hull(self.slice_at_end(second.hi));
            let first = Interval::new(
                if start & run != 0 { S::ZERO } else { slices.lo },
                if end & run != 0 { self.first.length } else { slices.hi },
            );
            pieces.push(Piece::new(self.indices, Lap::Same, Share::Only, first, second))?;
        }
        Ok(())
    }

    /// As far as rounding may take a contact: half a slack more, so that what is off by as much is still within R + ε.
    fn reach(&self) -> S {
        self.radius + self.slack.half()
    }

    /// What a disc of this radius covers in the middle of each slab.
    #[inline(never)]
    fn slabs(&self, in_order: &[S], radius: S) -> Slabs {
        let mut slabs = Slabs { any: 0, start: 0, end: 0 };
        let mut bit = 1_u32;
        for neighbours in in_order.windows(2) {
            let &[lo, hi] = neighbours else { break };
            let slab = Interval::new(lo, hi);
            if self.is_slab(slab) {
                let point = self.second.point_at(slab.middle());
                let covered = Footprint::of(point, self.first).covered(point, self.first, radius);
                slabs.any |= if covered.any { bit } else { 0 };
                slabs.start |= if covered.start { bit } else { 0 };
                slabs.end |= if covered.end { bit } else { 0 };
            } else {
                // It separates nothing.
                slabs.any |= (slabs.any << 1) & bit;
            }
            bit <<= 1;
        }
        slabs
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

    /// Adds a turning point to the pieces after `begin` whose second range comes within reach of it: by one of its ends, where
    /// its foot `s` is not in it.
    ///
    /// The foot alone would not do: its error is not a few slacks but ϱ / |ϱ - R| times that beside the centre of an arc, and two
    /// turning points on either side of a gap may be one by rounding, whose foot is in the gap. The distance is right
    /// whatever the foot, and of all points of a range it is least at the foot or at an end.
    fn turn_back<P: AsRef<[Piece<S>]> + AsMut<[Piece<S>]>>(&self, pieces: &mut Pieces<S, P>, begin: u32, l: S) {
        let point = self.first.point_at(l);
        let footprint = Footprint::of(point, self.second);
        if footprint.offset.abs() > self.radius + self.slack {
            return;
        }
        let reach = self.reach();
        let by_laps = wraps(self.first, self.radius, self.slack);
        let s = on_first_lap(footprint.foot(self.second), self.second, S::ZERO);
        let near = |s| (self.second.point_at(s) - point).norm_squared() <= reach.times(reach);
        let mut index = pieces.pending_after(begin);
        while let Some(piece) = pieces.get_mut(index) {
            let Interval { lo, hi } = piece.second;
            let place = if piece.second.contains(s) { Some(s) } else { [lo, hi].into_iter().find(|&end| near(end)) };
            let belongs = place.is_some_and(|s| {
                if !by_laps {
                    return true;
                }
                let footprint = Footprint::of(self.second.point_at(s), self.first);
                // What is but one interval by rounding is that of both pieces. Further out only what none holds before.
                [reach, self.radius + self.slack].into_iter().all(|radius| {
                    let laps = footprint.reach(self.first, radius).intervals(self.first);
                    piece.share.holds(l, laps, self.first, piece.first)
                })
            });
            if belongs {
                piece.first = piece.first.hull(Interval::new(l, l));
            }
            index = piece.next;
        }
    }
}
