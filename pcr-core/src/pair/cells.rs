//! From events to pieces: the collision region of one segment against one segment.
//!
//! The events cut the second segment into slabs. In a slab, every lap of the first segment that the disc
//! covers is a cell; cells of neighbouring slabs with the same lap are parts of one piece. Cells of different
//! laps can only meet where the disc covers the whole circle.
//!
//! The lengths of a piece are the hull of its slices at the turning points, at the slab ends and in the middle of each
//! slab: nothing between them can be extreme. (Where contact is transversal the slab ends inside the second segment
//! would not be needed; between almost parallel lines a turning point may be anywhere between them, and be lost.)

use super::events::{Events, turning_points, wraps};
use super::footprint::{Footprint, Lap, Reach, Share, shift};
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
    /// Whether two laps of the first segment can be covered at once.
    pub(crate) wraps: bool,
}

/// What the disc covers of the first segment at one length of the second.
#[derive(Clone, Copy)]
struct Section<S> {
    footprint: Footprint<S>,
    reach: Reach<S>,
}

/// The piece that is open in each lap, by [`Lap`].
type Open = [Option<u32>; Lap::ALL.len()];

impl<'a, S: Scalar> SegmentPair<'a, S> {
    pub(crate) fn new(first: &'a Segment<S>, second: &'a Segment<S>, indices: [u16; 2], radius: S) -> Self {
        Self { first, second, indices, radius, wraps: wraps(first, radius) }
    }

    /// Adds the pieces of this pair, joined where they are connected. Lengths are those along the segments.
    pub(crate) fn find<P: AsRef<[Piece<S>]> + AsMut<[Piece<S>]>>(&self, pieces: &mut Pieces<S, P>) -> Result<(), Full> {
        let events = Events::of(self.first, self.second, self.radius);
        let events = events.in_order();
        let begin = pieces.last_pending();
        let mut open = Open::default();
        let mut before: Option<Section<S>> = None;
        // The section at the end of the slab before, if that is covered.
        let mut edge: Option<Section<S>> = None;
        for (&lo, &hi) in events.iter().zip(events.iter().skip(1)) {
            // Events may coincide; a second segment of length 0 has this one slab only.
            if lo >= hi && self.second.length > S::ZERO {
                continue;
            }
            let slab = Interval::new(lo, hi);
            let middle = self.section(slab.middle());
            let laps_lost = before.map_or(0, |before| self.laps_lost(&before, &middle, lo));
            open = match middle.reach {
                Reach::Nothing => {
                    edge = None;
                    Open::default()
                }
                _ => self.extend(pieces, slab, &middle, &mut edge, open, laps_lost)?,
            };
            before = Some(middle);
        }
        if pieces.last_pending() != begin {
            turning_points(self.first, self.second, self.radius, |l, s| self.turn_back(pieces, begin, l, s));
        }
        Ok(())
    }

    /// The laps that can be covered.
    fn laps(&self) -> &'static [Lap] {
        if self.wraps { &Lap::ALL } else { &[Lap::Same] }
    }

    fn section(&self, s: S) -> Section<S> {
        let footprint = Footprint::of(self.second.point_at(s), self.first);
        Section { footprint, reach: footprint.reach(self.first, self.radius) }
    }

    /// Adds the cells of one slab to the pieces that are open at its beginning; returns those open at its end.
    fn extend<P: AsRef<[Piece<S>]> + AsMut<[Piece<S>]>>(
        &self,
        pieces: &mut Pieces<S, P>,
        slab: Interval<S>,
        middle: &Section<S>,
        edge: &mut Option<Section<S>>,
        open: Open,
        laps_lost: i8,
    ) -> Result<Open, Full> {
        let mut now = Open::default();
        let ends = [edge.unwrap_or_else(|| self.section(slab.lo)), self.section(slab.hi)];
        *edge = Some(ends[1]);
        let several = self.wraps && middle.reach.intervals(self.first)[1].is_some();
        let mut share = if several { Share::Start } else { Share::Only };
        for &lap in self.laps() {
            let Some(mut covered) = middle.reach.on(self.first, lap) else {
                continue;
            };
            for end in &ends {
                covered = covered.hull(self.limit(end, middle, lap));
            }
            let ongoing = lap.less(laps_lost).and_then(|lap| open[lap as usize]);
            let index = match ongoing.and_then(|index| pieces.get_mut(index)) {
                Some(piece) if piece.lap == lap && piece.share == share => {
                    piece.first = piece.first.hull(covered);
                    piece.second.hi = slab.hi;
                    ongoing
                }
                _ => Some(pieces.push(Piece::new(self.indices, lap, share, covered, slab))?),
            };
            now[lap as usize] = index;
            if let (Some(index), Some(ongoing)) = (index, ongoing) {
                pieces.join(ongoing, index);
            }
            if several {
                share = Share::End;
            }
        }
        if !self.wraps {
            return Ok(now);
        }
        // Where the whole circle is covered every lap meets.
        for (whole, laps) in [(now[Lap::Whole as usize], open), (open[Lap::Whole as usize], now)] {
            if let Some(whole) = whole {
                laps.into_iter().flatten().for_each(|lap| pieces.join(whole, lap));
            }
        }
        Ok(now)
    }

    /// Adds the slice at a turning point, which ends at `l`, to the pieces after `begin` that cover it.
    fn turn_back<P>(&self, pieces: &mut Pieces<S, P>, begin: u32, l: S, s: S)
    where
        P: AsRef<[Piece<S>]> + AsMut<[Piece<S>]>,
    {
        // With one lap there is no doubt whose end it is.
        let point = [Some(Interval::new(l, l)), None];
        let intervals = self.wraps.then(|| self.section(s).reach.intervals(self.first));
        let mut index = pieces.pending_after(begin);
        while let Some(piece) = pieces.get_mut(index) {
            if piece.second.contains(s) {
                let covered = intervals.map_or(point, |intervals| piece.share.of(intervals, self.first, piece.first));
                piece.first = covered.into_iter().flatten().fold(piece.first, Interval::hull);
            }
            index = piece.next;
        }
    }

    /// The slice of a cell at an end of its slab. There it may have shrunk to a point, or grown to the whole
    /// circle, and rounding may have taken it a little beyond.
    fn limit(&self, end: &Section<S>, middle: &Section<S>, lap: Lap) -> Interval<S> {
        let all = Interval::new(S::ZERO, self.first.length);
        let (mut foot, half) = match (end.reach, lap) {
            (_, Lap::Whole) => return all,
            (Reach::Around { foot, half }, _) => (foot, half),
            (Reach::Nothing, _) => (end.foot(self.first), S::ZERO),
            (Reach::Whole, _) => (end.foot(self.first), self.first.circumference.half()),
        };
        if self.wraps && self.changes_lap(middle, end, end) {
            let lap = self.first.circumference;
            foot = if middle.foot(self.first) > foot { foot + lap } else { foot - lap };
        }
        let foot = shift(foot, self.first, lap);
        Interval::new(foot - half, foot + half).widen(S::ZERO, all)
    }

    /// How many laps the foot has lost between two slabs: it passes from the end of the lap to its beginning.
    fn laps_lost(&self, before: &Section<S>, after: &Section<S>, event: S) -> i8 {
        if !self.wraps || !self.changes_lap(before, after, &self.section(event)) {
            0
        } else if before.foot(self.first) > after.foot(self.first) {
            1
        } else {
            -1
        }
    }

    /// Whether the feet of two sections lie on different sides of the middle of the segment because the foot
    /// left its lap, at `between`, on the far half of the circle.
    fn changes_lap(&self, a: &Section<S>, b: &Section<S>, between: &Section<S>) -> bool {
        let middle = self.first.length.half();
        let beyond = |section: &Section<S>| section.foot(self.first) > middle;
        let quarter = self.first.circumference.half().half();
        beyond(a) != beyond(b) && (between.foot(self.first) - middle).abs() > quarter
    }
}

impl<S: Scalar> Section<S> {
    fn foot(&self, segment: &Segment<S>) -> S {
        match self.reach {
            Reach::Around { foot, .. } => foot,
            Reach::Nothing | Reach::Whole => self.footprint.foot(segment),
        }
    }
}
