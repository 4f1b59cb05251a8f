//! From events to pieces: the part of a collision region that belongs to one pair of segments.
//!
//! The events cut the second segment into slabs. In a slab the disc either covers something of the first segment
//! everywhere, or nothing at all; its middle shows which. Neighbouring covered slabs belong to the same piece if at
//! most one lap of the first segment can be covered ([`super::windings`] handles the other case).
//!
//! The range of a piece along the first segment is the hull of its slices at both ends, of those ends of the first
//! segment that are covered, and of the turning points; no other point can be extreme. Inside the second segment a
//! piece begins and ends in a single point. The foot is used for it, because it is right even if the turning point
//! between almost parallel lines is lost to rounding.

use super::disc_on_segment::{CarrierCoordinates, CarrierCover};
use super::events::{add_events, add_turning_lengths, wraps};
use super::lateral_offset::on_first_lap;
use super::lengths::LengthList;
use crate::bit_rows::BitRuns;
use crate::error::CapacityError;
use crate::geometry::Interval;
use crate::lap::{Branch, Winding};
use crate::piece_store::{Piece, PieceStore};
use crate::scalar::Scalar;
use crate::segment::Segment;

/// Two segments, and their indices in the two paths.
#[derive(Clone, Copy)]
pub(crate) struct SegmentPair<'a, S: Scalar> {
    pub(crate) first: &'a Segment<S>,
    pub(crate) second: &'a Segment<S>,
    pub(crate) indices: [u16; 2],
    /// Combined radius, including the slack \[m\].
    pub(crate) radius: S,
    /// Bound on the rounding error of distances \[m\].
    pub(crate) slack: S,
}

/// What is covered of the first segment, one bit for each slab. No branch depends on outcomes that are unpredictable.
struct SlabBits {
    /// Any part of it.
    any: u32,
    /// Its start.
    start: u32,
    /// Its end.
    end: u32,
}

impl<S: Scalar> SegmentPair<'_, S> {
    /// Adds the pieces of this pair of segments and joins those that are connected. Lengths are along the segments.
    pub(crate) fn find<P: AsRef<[Piece<S>]> + AsMut<[Piece<S>]>>(
        &self,
        pieces: &mut PieceStore<S, P>,
    ) -> Result<(), CapacityError> {
        let (mut events, mut turning) = (LengthList::new(S::ZERO), LengthList::new(S::ZERO));
        let ends = add_events(self.first, self.second, self.radius, self.slack, &mut events);
        // Computed before the events are sorted, so that the processor can overlap the two computations.
        add_turning_lengths(self.first, self.second, ends, self.radius, self.slack, &mut turning);
        events.sort();
        let in_order = events.as_slice();
        let begin = pieces.pending();
        if wraps(self.first, self.radius, self.slack) {
            self.find_laps(in_order, pieces)?;
        } else {
            self.find_one_lap(in_order, pieces)?;
        }
        if pieces.pending() == begin {
            return Ok(());
        }
        for &l in turning.as_slice() {
            self.turn_back(pieces, begin, l);
        }
        Ok(())
    }

    /// Whether the part between two neighbouring events is a slab: events may coincide. A second segment of length 0
    /// has one slab only.
    pub(super) fn is_slab(&self, slab: Interval<S>) -> bool {
        (slab.lo < slab.hi) | (self.second.length == S::ZERO)
    }

    /// Finds the pieces if at most one lap can be covered: they are runs of covered slabs.
    fn find_one_lap<P: AsRef<[Piece<S>]> + AsMut<[Piece<S>]>>(
        &self,
        in_order: &[S],
        pieces: &mut PieceStore<S, P>,
    ) -> Result<(), CapacityError> {
        let SlabBits { mut any, start, end } = self.slabs(in_order, self.radius);
        if BitRuns(any).rest() != 0 {
            // A gap between two runs may exist only because of rounding; turning points in it would then belong to no
            // piece.
            let near = self.slabs(in_order, self.reach()).any;
            let between = !(any ^ any.wrapping_sub(1)) & u32::MAX.wrapping_shr(any.leading_zeros());
            for gap in BitRuns(between & !any) {
                any |= if gap & !near == 0 { gap } else { 0 };
            }
        }
        let event = |place: u32| in_order.get(place as usize).copied().unwrap_or(self.second.length);
        for run in BitRuns(any) {
            let second = Interval::new(event(run.trailing_zeros()), event(u32::BITS - run.leading_zeros()));
            let slices = self.slice_at_end(second.lo).hull(self.slice_at_end(second.hi));
            let first = Interval::new(
                if start & run != 0 { S::ZERO } else { slices.lo },
                if end & run != 0 { self.first.length } else { slices.hi },
            );
            pieces.push(Piece::new(self.indices, Winding::Same, Branch::Only, first, second))?;
        }
        Ok(())
    }

    /// The radius to which rounding may move a contact: half a slack more, so that a point that is off by as much is
    /// still within R + ε.
    fn reach(&self) -> S {
        self.radius + self.slack.half()
    }

    /// The parts covered by a disc of this radius in the middle of each slab.
    #[inline(never)]
    fn slabs(&self, in_order: &[S], radius: S) -> SlabBits {
        let mut slabs = SlabBits { any: 0, start: 0, end: 0 };
        let mut bit = 1_u32;
        for neighbours in in_order.windows(2) {
            let &[lo, hi] = neighbours else { break };
            let slab = Interval::new(lo, hi);
            if self.is_slab(slab) {
                let point = self.second.point_at(slab.middle());
                let covered = CarrierCoordinates::of(point, self.first).covered(point, self.first, radius);
                slabs.any |= if covered.any { bit } else { 0 };
                slabs.start |= if covered.start { bit } else { 0 };
                slabs.end |= if covered.end { bit } else { 0 };
            } else {
                // An empty slab does not separate its neighbours.
                slabs.any |= (slabs.any << 1) & bit;
            }
            bit <<= 1;
        }
        slabs
    }

    /// The slice at which a piece begins or ends. Inside the second segment it is a single point, the foot.
    fn slice_at_end(&self, s: S) -> Interval<S> {
        let footprint = CarrierCoordinates::of(self.second.point_at(s), self.first);
        let outer = s <= S::ZERO || s >= self.second.length;
        let (foot, half) = match if outer { footprint.reach(self.first, self.radius) } else { CarrierCover::Nothing } {
            CarrierCover::Around { foot, half } => (foot, half),
            CarrierCover::Nothing | CarrierCover::Whole => (footprint.foot(self.first), S::ZERO),
        };
        Interval::new(foot - half, foot + half).widen(S::ZERO, Interval::new(S::ZERO, self.first.length))
    }

    /// Adds a turning point to the pieces after `begin` whose second range comes within reach of it. If its foot `s` is
    /// not in the range, the ends of the range are tested.
    ///
    /// The foot alone is not enough. Near the centre of an arc its error is ϱ / |ϱ - R| times a few slacks, and two
    /// turning points on either side of a gap may coincide because of rounding, with a foot in the gap. The distance is
    /// accurate whatever the foot, and over a range it is least at the foot or at an end.
    fn turn_back<P: AsRef<[Piece<S>]> + AsMut<[Piece<S>]>>(&self, pieces: &mut PieceStore<S, P>, begin: u16, l: S) {
        let point = self.first.point_at(l);
        let footprint = CarrierCoordinates::of(point, self.second);
        if footprint.offset.abs() > self.radius + self.slack {
            return;
        }
        let reach = self.reach();
        let by_laps = wraps(self.first, self.radius, self.slack);
        let s = on_first_lap(footprint.foot(self.second), self.second, S::ZERO);
        let near = |s| (self.second.point_at(s) - point).norm_squared() <= reach.times(reach);
        for piece in pieces.behind(begin) {
            let Interval { lo, hi } = piece.second;
            let place = if piece.second.contains(s) { Some(s) } else { [lo, hi].into_iter().find(|&end| near(end)) };
            let belongs = place.is_some_and(|s| {
                if !by_laps {
                    return true;
                }
                let footprint = CarrierCoordinates::of(self.second.point_at(s), self.first);
                // If two intervals are one by rounding, the point belongs to both pieces. Further out, only a point
                // that no piece has yet is added.
                [reach, self.radius + self.slack].into_iter().all(|radius| {
                    let laps = footprint.reach(self.first, radius).intervals(self.first);
                    piece.share().holds(l, laps, self.first, piece.first)
                })
            });
            if belongs {
                piece.first = piece.first.hull(Interval::new(l, l));
            }
        }
    }
}
