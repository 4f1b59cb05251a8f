//! A pair of agents in coordination space: computes all pieces of their collision regions and joins those that are
//! connected.
//!
//! A point (l₁, l₂) of coordination space holds the lengths along both paths. The set of points at which the agents
//! collide depends only on the paths and the combined radius. So it serves both directions of the pair and all motions
//! on the paths (except that the rounding of times adds to the radius).
//!
//! Two discs have kernels of their own. Pairs with an outline that is no disc have those in [`outline`], behind the same
//! door: [`AgentPair::find`], and the slices of pieces.

pub(crate) mod disc_on_segment;
pub(crate) mod events;
pub(crate) mod lateral_offset;
pub(crate) mod lengths;
pub(crate) mod outline;
pub(crate) mod slabs;
mod windings;

use crate::bit_rows::SetBits;
use crate::error::CapacityError;
use crate::geometry::Interval;
use crate::motion::Motion;
use crate::piece_store::{Piece, PieceStore};
use crate::scalar::Scalar;
use crate::segment::{ROW, Segment, in_box};
use core::hint::select_unpredictable as select;
use disc_on_segment::CarrierCoordinates;
use events::wraps;
use slabs::SegmentPair;

/// Two agents as an unordered pair.
#[derive(Clone, Copy, Debug)]
pub(crate) struct AgentPair<'a, S: Scalar> {
    pub(crate) first: &'a Motion<'a, S>,
    pub(crate) second: &'a Motion<'a, S>,
    /// Bound on the rounding error of a distance \[m\].
    pub(crate) slack: S,
    /// Sum of the radii plus slack \[m\]. Regions are computed with it, so that they contain the exact ones.
    pub(crate) radius: S,
}

impl<'a, S: Scalar> AgentPair<'a, S> {
    pub(crate) fn new(first: &'a Motion<'a, S>, second: &'a Motion<'a, S>) -> Self {
        let slack = S::slack(first.extent().max(second.extent())) + first.drift() + second.drift();
        let slack = slack + first.allowance().max(second.allowance());
        Self { first, second, slack, radius: first.rounding_radius() + second.rounding_radius() + slack }
    }

    /// Error bound of the regions \[m\]: they are computed with a radius that is larger by one slack, and distances are
    /// off by at most another slack.
    pub(crate) fn excess(&self) -> S {
        self.slack.double()
    }

    /// Adds the pieces of the pair, pending, and forms regions of those that are connected. Lengths are along the paths.
    /// The caller has checked that the boxes of both paths meet ([`Motion::swept`]).
    ///
    /// Cost: a box test for each pair of segments, and a few hundred operations for each pair of segments that meet.
    pub(crate) fn find<P: AsRef<[Piece<S>]> + AsMut<[Piece<S>]>>(
        &self,
        pieces: &mut PieceStore<S, P>,
    ) -> Result<(), CapacityError> {
        let outlines = self.has_outline();
        let mut reach = self.radius + self.slack;
        if outlines {
            reach = reach + self.first.outline().spread() + self.second.outline().spread();
        }
        let first = self.first.bounds().expanded(reach);
        for (j, other) in (0..u16::MAX).zip(self.second.path().segments()) {
            if !first.meets(other.bounds) {
                continue;
            }
            let around = other.bounds.expanded(reach);
            for (row, begin) in self.first.path().segments().chunks(ROW).zip((0..u16::MAX).step_by(ROW)) {
                for place in SetBits(in_box(row, around)) {
                    let Some(own) = row.get(place as usize) else { break };
                    if own.near(other, reach) {
                        let indices = [begin.wrapping_add(place as u16), j];
                        if outlines {
                            self.find_of_outlines([own, other], indices, pieces)?;
                            continue;
                        }
                        let (radius, slack) = (self.radius, self.slack);
                        SegmentPair { first: own, second: other, indices, radius, slack }.find(pieces)?;
                    }
                }
            }
        }
        self.join(pieces);
        pieces.form_regions(|piece| self.place(piece));
        Ok(())
    }

    /// Joins pieces across the joints of either path (paper, Fig. 14c).
    ///
    /// Pieces are sorted by the second segment, then by the first. So the neighbours across a joint of the first path
    /// follow at once, and those across a joint of the second path begin at an index that never goes back.
    fn join<P: AsRef<[Piece<S>]> + AsMut<[Piece<S>]>>(&self, pieces: &mut PieceStore<S, P>) {
        let place = |piece: &Piece<S>| (u32::from(piece.second_segment) << 16) | u32::from(piece.first_segment);
        let last = pieces.pending();
        let mut next_row = 1;
        for a in 1..last {
            let Some(&before) = pieces.get(a) else { break };
            // A path has at most 2^16 - 1 segments, so the first index does not reach the second.
            let (beside, above) = (place(&before).saturating_add(1), place(&before).saturating_add(1 << 16));
            while next_row <= last && pieces.get(next_row).is_some_and(|piece| place(piece) < above) {
                next_row = next_row.wrapping_add(1);
            }
            let mut b = a.wrapping_add(1);
            while b <= last
                && let Some(&after) = pieces.get(b)
                && place(&after) <= above
            {
                let at = place(&after);
                if (at == beside && self.meet_at_joint_of_first(&before, &after))
                    || (at == above && self.meet_at_joint_of_second(&before, &after))
                {
                    pieces.join(a, b);
                }
                // A pair has less than 2^16 pieces.
                b = if beside < at && at < above { next_row } else { b.wrapping_add(1) };
            }
        }
    }

    /// Pieces of neighbouring segments of the second path, and of one segment of the first.
    ///
    /// At a joint of the second path both pieces end in slices of the first path around the same point. They meet if
    /// they share a slice.
    fn meet_at_joint_of_second(&self, before: &Piece<S>, after: &Piece<S>) -> bool {
        if after.second.lo != S::ZERO || !before.first.meets(after.first) {
            return false;
        }
        let (Some(own), Some(other)) = self.segments(before) else {
            return false;
        };
        if before.second.hi != other.length {
            return false;
        }
        if self.has_outline() {
            return self.outlines_meet_at_joint_of_second(before, after);
        }
        // If at most one interval is covered, both pieces contain it.
        if !wraps(own, self.radius, self.slack) {
            return true;
        }
        let slices = CarrierCoordinates::of(other.end, own).reach(own, self.radius).intervals(own);
        let [before, after] = [before, after].map(|piece| piece.at_joint(slices, own));
        before.into_iter().flatten().any(|slice| after.contains(&Some(slice)))
    }

    /// Pieces of neighbouring segments of the first path, and of one segment of the second.
    ///
    /// At a joint of the first path the pieces share intervals of the second segment: those within reach of the joint.
    /// The pieces meet if the middle of one of these intervals belongs to both.
    fn meet_at_joint_of_first(&self, before: &Piece<S>, after: &Piece<S>) -> bool {
        if after.first.lo != S::ZERO || !before.second.meets(after.second) {
            return false;
        }
        let (Some(own), Some(next), Some(other)) = (
            segment(self.first, before.first_segment),
            segment(self.first, after.first_segment),
            segment(self.second, before.second_segment),
        ) else {
            return false;
        };
        if before.first.hi != own.length {
            return false;
        }
        if self.has_outline() {
            return self.outlines_meet_at_joint_of_first(before, after);
        }
        // At most one interval of the second segment is within reach of the joint, so both pieces contain it.
        if !wraps(other, self.radius, self.slack) {
            return true;
        }
        let belongs = |piece: &Piece<S>, segment, s: S, l: S| {
            let slices =
                CarrierCoordinates::of(other.point_at(s), segment).reach(segment, self.radius).intervals(segment);
            let near = |slice: Interval<S>| slice.lo - self.slack <= l && l <= slice.hi + self.slack;
            piece.second.contains(s) && piece.at_joint(slices, segment).into_iter().flatten().any(near)
        };
        let shared = CarrierCoordinates::of(own.end, other).reach(other, self.radius).intervals(other);
        shared.into_iter().flatten().any(|shared| {
            let s = shared.middle();
            belongs(before, own, s, own.length) && belongs(after, next, s, S::ZERO)
        })
    }

    /// Converts lengths along segments into lengths along paths.
    fn place(&self, piece: &mut Piece<S>) {
        let (own, other) = self.segments(piece);
        if let Some(own) = own {
            piece.first = along_path(piece.first, own);
        }
        if let Some(other) = other {
            piece.second = along_path(piece.second, other);
        }
    }

    /// The parts of the first path that a piece covers at the length `s` of the second path.
    pub(crate) fn slices_of_first(&self, piece: &Piece<S>, s: S) -> [Option<Interval<S>>; 2] {
        let (Some(own), Some(other)) = self.segments(piece) else {
            return [None; 2];
        };
        if !piece.second.contains(s) {
            return [None; 2];
        }
        let covered =
            CarrierCoordinates::of(other.point_at(s - other.from), own).reach(own, self.radius).intervals(own);
        let slices = piece.share().of(covered, own, self.hull(piece, own));
        slices.map(|slice| slice.map(|slice| along_path(slice, own)))
    }

    /// The parts of the second path that a piece covers at the length `l` of the first path.
    pub(crate) fn slices_of_second(&self, piece: &Piece<S>, l: S) -> [Option<Interval<S>>; 2] {
        let (Some(own), Some(other)) = self.segments(piece) else {
            return [None; 2];
        };
        if !piece.first.contains(l) {
            return [None; 2];
        }
        let covered =
            CarrierCoordinates::of(own.point_at(l - own.from), other).reach(other, self.radius).intervals(other);
        // An interval is connected, hence belongs to one region, that of every piece that it meets. But if two laps of
        // the first segment may be covered, the neighbouring part of the interval may belong to the other lap; then
        // each piece has its own part.
        covered.map(|slice| {
            let slice = Some(along_path(slice?, other)).filter(|slice| slice.meets(piece.second))?;
            if !wraps(own, self.radius, self.slack) {
                return Some(slice);
            }
            let part = slice.common(piece.second);
            let footprint = CarrierCoordinates::of(other.point_at(part.middle() - other.from), own);
            // With a slack: a part of the second segment that is barely covered may seem uncovered when computed from
            // here.
            let laps = footprint.reach(own, self.radius + self.slack).intervals(own);
            piece.share().holds(l - own.from, laps, own, self.hull(piece, own)).then_some(part)
        })
    }

    /// Range of a piece along its first segment, extended by a slack.
    fn hull(&self, piece: &Piece<S>, own: &Segment<S>) -> Interval<S> {
        Interval::new(piece.first.lo - own.from - self.slack, piece.first.hi - own.from + self.slack)
    }

    pub(crate) fn segments(&self, piece: &Piece<S>) -> (Option<&'a Segment<S>>, Option<&'a Segment<S>>) {
        (segment(self.first, piece.first_segment), segment(self.second, piece.second_segment))
    }
}

/// Converts a part of a segment to lengths of the path. An end of the segment becomes exactly an end in the path, so
/// that neighbours meet.
#[cfg_attr(not(feature = "std"), inline(never))]
pub(crate) fn along_path<S: Scalar>(part: Interval<S>, segment: &Segment<S>) -> Interval<S> {
    let at = |u: S| select(u < segment.length, (u + segment.from).min(segment.to), segment.to);
    Interval::new(at(part.lo), at(part.hi))
}

fn segment<'a, S: Scalar>(motion: &'a Motion<'_, S>, index: u16) -> Option<&'a Segment<S>> {
    motion.path().segments().get(usize::from(index))
}
