//! A pair of agents in coordination space: all pieces of their collision regions, joined.
//!
//! Coordination space (l₁, l₂) holds the lengths along both paths. The set of colliding lengths there depends
//! on the paths and the combined radius alone, so it serves both directions of the pair and every motion on the paths
//! (but for what the rounding of times adds to the radius).

pub(crate) mod cells;
pub(crate) mod events;
pub(crate) mod footprint;
mod laps;
pub(crate) mod lengths;
pub(crate) mod offset;

use crate::bits::Ones;
use crate::error::Full;
use crate::geometry::Interval;
use crate::motion::Motion;
use crate::pieces::{Piece, Pieces};
use crate::scalar::Scalar;
use crate::segment::{ROW, Segment, in_box};
use cells::SegmentPair;
use core::hint::select_unpredictable as select;
use events::wraps;
use footprint::Footprint;

/// Two agents, seen as a pair.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pair<'a, S: Scalar> {
    pub(crate) first: &'a Motion<'a, S>,
    pub(crate) second: &'a Motion<'a, S>,
    /// Residual that rounding may cause \[m\].
    pub(crate) slack: S,
    /// Sum of the radii plus slack \[m\]: what is computed with contains what is asked for.
    pub(crate) radius: S,
}

impl<'a, S: Scalar> Pair<'a, S> {
    pub(crate) fn new(first: &'a Motion<'a, S>, second: &'a Motion<'a, S>) -> Self {
        let slack = S::slack(first.extent().max(second.extent())) + first.drift() + second.drift();
        let slack = slack + first.lag().max(second.lag());
        Self { first, second, slack, radius: first.radius() + second.radius() + slack }
    }

    /// What is computed with is larger than the combined radius by one slack, and distances are off by another one at
    /// most \[m\].
    pub(crate) fn excess(&self) -> S {
        self.slack.double()
    }

    /// Adds the pieces of the pair to the pending ones, joined where they are connected, as lengths along the paths. Whether the
    /// boxes of both paths meet has been asked before ([`Motion::swept`]).
    ///
    /// Cost: a box test a pair of segments, and a few hundred operations a pair of segments that meet.
    pub(crate) fn find<P: AsRef<[Piece<S>]> + AsMut<[Piece<S>]>>(&self, pieces: &mut Pieces<S, P>) -> Result<(), Full> {
        let reach = self.radius + self.slack;
        let first = self.first.bounds().expanded(reach);
        for (j, other) in (0..u16::MAX).zip(self.second.path().segments()) {
            if !first.meets(other.bounds) {
                continue;
            }
            let around = other.bounds.expanded(reach);
            for (row, begin) in self.first.path().segments().chunks(ROW).zip((0..u16::MAX).step_by(ROW)) {
                for place in Ones(in_box(row, around)) {
                    let Some(own) = row.get(place as usize) else { break };
                    if own.near(other, reach) {
                        let indices = [begin.wrapping_add(place as u16), j];
                        let (radius, slack) = (self.radius, self.slack);
                        SegmentPair { first: own, second: other, indices, radius, slack }.find(pieces)?;
                    }
                }
            }
        }
        self.join(pieces);
        self.place(pieces);
        Ok(())
    }

    /// Joins pieces across the joints of either path (paper Fig. 14c).
    fn join<P: AsRef<[Piece<S>]> + AsMut<[Piece<S>]>>(&self, pieces: &mut Pieces<S, P>) {
        let mut a = pieces.first_pending();
        while let Some(&before) = pieces.slots().get(a as usize) {
            // They are in the order of the second segments, then of the first ones: joints lie ahead, one row at most.
            let mut b = before.next;
            while let Some(&after) = pieces.slots().get(b as usize) {
                if after.second_segment.saturating_sub(before.second_segment) > 1 {
                    break;
                }
                if self.meet_at_joint_of_second(&before, &after) || self.meet_at_joint_of_first(&before, &after) {
                    pieces.join(a, b);
                }
                b = after.next;
            }
            a = before.next;
        }
    }

    /// At a joint of the second path both pieces end in slices about the same point. They meet if they share one.
    fn meet_at_joint_of_second(&self, before: &Piece<S>, after: &Piece<S>) -> bool {
        let neighbours = after.first_segment == before.first_segment
            && after.second_segment.checked_sub(1) == Some(before.second_segment)
            && after.second.lo == S::ZERO
            && before.first.meets(after.first);
        if !neighbours {
            return false;
        }
        let (Some(own), Some(other)) = self.segments(before) else {
            return false;
        };
        if before.second.hi != other.length {
            return false;
        }
        // Where one interval at most is covered both pieces hold it.
        if !wraps(own, self.radius, self.slack) {
            return true;
        }
        let slices = Footprint::of(other.end, own).reach(own, self.radius).intervals(own);
        let [before, after] = [before, after].map(|piece| piece.at_joint(slices, own));
        before.into_iter().flatten().any(|slice| after.contains(&Some(slice)))
    }

    /// At a joint of the first path the pieces share intervals of the second segment: those within reach of
    /// the joint. They meet if the middle of one of them belongs to both.
    fn meet_at_joint_of_first(&self, before: &Piece<S>, after: &Piece<S>) -> bool {
        let neighbours = after.second_segment == before.second_segment
            && after.first_segment.checked_sub(1) == Some(before.first_segment)
            && after.first.lo == S::ZERO
            && before.second.meets(after.second);
        if !neighbours {
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
        // One interval at most of the second segment is within reach of the joint: both pieces hold it.
        if !wraps(other, self.radius, self.slack) {
            return true;
        }
        let belongs = |piece: &Piece<S>, segment, s: S, l: S| {
            let slices = Footprint::of(other.point_at(s), segment).reach(segment, self.radius).intervals(segment);
            let near = |slice: Interval<S>| slice.lo - self.slack <= l && l <= slice.hi + self.slack;
            piece.second.contains(s) && piece.at_joint(slices, segment).into_iter().flatten().any(near)
        };
        let shared = Footprint::of(own.end, other).reach(other, self.radius).intervals(other);
        shared.into_iter().flatten().any(|shared| {
            let s = shared.middle();
            belongs(before, own, s, own.length) && belongs(after, next, s, S::ZERO)
        })
    }

    /// Turns lengths along segments into lengths along paths.
    fn place<P: AsRef<[Piece<S>]> + AsMut<[Piece<S>]>>(&self, pieces: &mut Pieces<S, P>) {
        let mut index = pieces.first_pending();
        while let Some(piece) = pieces.get_mut(index) {
            if let Some(own) = segment(self.first, piece.first_segment) {
                piece.first = along_path(piece.first, own);
            }
            if let Some(other) = segment(self.second, piece.second_segment) {
                piece.second = along_path(piece.second, other);
            }
            index = piece.next;
        }
    }

    /// The parts of the first path that a piece covers at the length `s` of the second one.
    pub(crate) fn slices_of_first(&self, piece: &Piece<S>, s: S) -> [Option<Interval<S>>; 2] {
        let (Some(own), Some(other)) = self.segments(piece) else {
            return [None; 2];
        };
        if !piece.second.contains(s) {
            return [None; 2];
        }
        let covered = Footprint::of(other.point_at(s - other.from), own).reach(own, self.radius).intervals(own);
        let slices = piece.share.of(covered, own, self.hull(piece, own));
        slices.map(|slice| slice.map(|slice| along_path(slice, own)))
    }

    /// The parts of the second path that a piece covers at the length `l` of the first one.
    pub(crate) fn slices_of_second(&self, piece: &Piece<S>, l: S) -> [Option<Interval<S>>; 2] {
        let (Some(own), Some(other)) = self.segments(piece) else {
            return [None; 2];
        };
        if !piece.first.contains(l) {
            return [None; 2];
        }
        let covered = Footprint::of(own.point_at(l - own.from), other).reach(other, self.radius).intervals(other);
        // An interval is connected, hence part of one region, that of each piece that it meets. But where two laps of the
        // first segment may be covered, the next part of it may be that of the other lap: then each piece has its own part.
        covered.map(|slice| {
            let slice = Some(along_path(slice?, other)).filter(|slice| slice.meets(piece.second))?;
            if !wraps(own, self.radius, self.slack) {
                return Some(slice);
            }
            let part = slice.common(piece.second);
            let footprint = Footprint::of(other.point_at(part.middle() - other.from), own);
            // What only just is covered of the second segment may not seem to be from here.
            let laps = footprint.reach(own, self.radius + self.slack).intervals(own);
            piece.share.holds(l - own.from, laps, own, self.hull(piece, own)).then_some(part)
        })
    }

    /// Where a piece lies along its first segment, and a slack more.
    fn hull(&self, piece: &Piece<S>, own: &Segment<S>) -> Interval<S> {
        Interval::new(piece.first.lo - own.from - self.slack, piece.first.hi - own.from + self.slack)
    }

    fn segments(&self, piece: &Piece<S>) -> (Option<&'a Segment<S>>, Option<&'a Segment<S>>) {
        (segment(self.first, piece.first_segment), segment(self.second, piece.second_segment))
    }
}

/// A part of a segment as lengths of the path. Its ends stay ends: neighbours meet in the same number.
#[cfg_attr(not(feature = "std"), inline(never))]
fn along_path<S: Scalar>(part: Interval<S>, segment: &Segment<S>) -> Interval<S> {
    let at = |u: S| select(u < segment.length, (u + segment.from).min(segment.to), segment.to);
    Interval::new(at(part.lo), at(part.hi))
}

fn segment<'a, S: Scalar>(motion: &'a Motion<'_, S>, index: u16) -> Option<&'a Segment<S>> {
    motion.path().segments().get(usize::from(index))
}
