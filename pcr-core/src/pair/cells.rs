//! From events to pieces: the collision region of one segment against one segment.
//!
//! The events cut the second segment into slabs. In a slab, every lap of the first segment that the disc
//! covers is a cell; cells of neighbouring slabs with the same lap are parts of one piece. Cells of different
//! laps can only meet where the disc covers the whole circle.
//!
//! The lengths of a piece are the hull of its slices at the turning points, at the slab ends and in the middle of each
//! slab, and of the ends of the first segment that are in contact: nothing between them can be extreme. (Where contact is
//! transversal the slab ends inside the second segment would not be needed; between almost parallel lines a turning point
//! may be anywhere between them, and be lost.)

use super::events::{Events, turning_points, wraps};
use super::footprint::{Footprint, Lap, Reach, Share, shift};
use crate::error::Full;
use crate::geometry::Interval;
use crate::pieces::{NONE, Piece, Pieces};
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
    /// Whether two laps of the first segment can be covered at once.
    pub(crate) wraps: bool,
}

/// What the disc covers of the first segment at one length of the second.
#[derive(Clone, Copy)]
struct Section<S> {
    footprint: Footprint<S>,
    reach: Reach<S>,
}

/// A slab as its neighbours see it.
#[derive(Clone, Copy)]
struct Slab<S> {
    /// Whether anything of the segment is covered.
    covered: bool,
    /// The foot in its middle, where laps matter.
    foot: S,
}

/// The piece that is open in each lap, by [`Lap`], or [`NONE`].
type Open = [u32; Lap::ALL.len()];

impl<'a, S: Scalar> SegmentPair<'a, S> {
    pub(crate) fn new(first: &'a Segment<S>, second: &'a Segment<S>, indices: [u16; 2], radius: S, slack: S) -> Self {
        Self { first, second, indices, radius, slack, wraps: wraps(first, radius) }
    }

    /// Adds the pieces of this pair, joined where they are connected. Lengths are those along the segments.
    pub(crate) fn find<P: AsRef<[Piece<S>]> + AsMut<[Piece<S>]>>(&self, pieces: &mut Pieces<S, P>) -> Result<(), Full> {
        let events = Events::of(self.first, self.second, self.radius, self.slack);
        let begin = pieces.last_pending();
        let mut open = [NONE; Lap::ALL.len()];
        let mut before = Slab { covered: false, foot: S::ZERO };
        let lengths = events.in_order();
        for (&lo, &hi) in lengths.iter().zip(lengths.iter().skip(1)) {
            // Events may coincide; a second segment of length 0 has this one slab only.
            if lo >= hi && self.second.length > S::ZERO {
                continue;
            }
            let range = Interval::new(lo, hi);
            let middle = self.section(range.middle());
            let slab = self.slab(&middle);
            let ends = before.covered != slab.covered || (self.wraps && slab.covered);
            let mut laps_lost = 0;
            let mut begin = None;
            if ends {
                let edge = self.edge(lo);
                self.limit_open(pieces, &open, &edge, before);
                laps_lost = self.laps_lost(before, slab, &edge);
                begin = Some(edge);
            }
            if slab.covered {
                self.extend(pieces, range, &middle, begin.as_ref(), &mut open, laps_lost)?;
            } else {
                open = [NONE; Lap::ALL.len()];
            }
            before = slab;
        }
        if before.covered {
            self.limit_open(pieces, &open, &self.edge(self.second.length), before);
        }
        if pieces.last_pending() != begin {
            if !self.wraps {
                // A turning point so near an end of the segment that rounding finds it beyond.
                for (l, contacts) in [S::ZERO, self.first.length].into_iter().zip(events.ends) {
                    contacts.into_iter().flatten().for_each(|s| self.turn_back(pieces, begin, l, s));
                }
            }
            turning_points(self.first, self.second, self.radius, self.slack, |l, s| {
                self.turn_back(pieces, begin, l, s)
            });
        }
        Ok(())
    }

    /// The laps that can be covered.
    fn laps(&self) -> &'static [Lap] {
        if self.wraps { &Lap::ALL } else { &[Lap::Same] }
    }

    fn slab(&self, middle: &Section<S>) -> Slab<S> {
        // With several laps every end of a slab is looked at anyway.
        let covered = match middle.reach {
            Reach::Around { .. } if !self.wraps => middle.reach.on(self.first, Lap::Same).is_some(),
            reach => reach != Reach::Nothing,
        };
        Slab { covered, foot: if self.wraps { middle.foot(self.first) } else { S::ZERO } }
    }

    fn section(&self, s: S) -> Section<S> {
        let footprint = Footprint::of(self.second.point_at(s), self.first);
        Section { footprint, reach: footprint.reach(self.first, self.radius) }
    }

    /// What bounds the cells next to the end `s` of a slab: the section there. Inside the second segment cells of one lap
    /// begin and end in a point, the foot.
    fn edge(&self, s: S) -> Section<S> {
        if self.wraps || s <= S::ZERO || s >= self.second.length {
            return self.section(s);
        }
        Section { footprint: Footprint::of(self.second.point_at(s), self.first), reach: Reach::Nothing }
    }

    /// Adds the slice at the end of their slab to the pieces that are open in it.
    fn limit_open<P>(&self, pieces: &mut Pieces<S, P>, open: &Open, end: &Section<S>, slab: Slab<S>)
    where
        P: AsRef<[Piece<S>]> + AsMut<[Piece<S>]>,
    {
        for &lap in self.laps() {
            if let Some(piece) = pieces.get_mut(open[lap as usize]) {
                piece.first = piece.first.hull(self.limit(end, slab.foot, lap));
            }
        }
    }

    /// Adds the cells of one slab to the pieces that are open at its beginning; then those open at its end are.
    fn extend<P: AsRef<[Piece<S>]> + AsMut<[Piece<S>]>>(
        &self,
        pieces: &mut Pieces<S, P>,
        range: Interval<S>,
        middle: &Section<S>,
        begin: Option<&Section<S>>,
        open: &mut Open,
        laps_lost: i8,
    ) -> Result<(), Full> {
        let before = core::mem::replace(open, [NONE; Lap::ALL.len()]);
        let several = self.wraps && middle.reach.intervals(self.first)[1].is_some();
        let mut share = if several { Share::Start } else { Share::Only };
        for &lap in self.laps() {
            let Some(mut covered) = middle.reach.on(self.first, lap) else {
                continue;
            };
            if let Some(begin) = begin {
                covered = covered.hull(self.limit(begin, self.slab(middle).foot, lap));
            }
            let ongoing = lap.less(laps_lost).map_or(NONE, |lap| before[lap as usize]);
            let index = match pieces.get_mut(ongoing) {
                Some(piece) if piece.lap == lap && piece.share == share => {
                    piece.first = piece.first.hull(covered);
                    piece.second.hi = range.hi;
                    ongoing
                }
                _ => {
                    let index = pieces.push(Piece::new(self.indices, lap, share, covered, range))?;
                    pieces.join(ongoing, index);
                    index
                }
            };
            open[lap as usize] = index;
            if several {
                share = Share::End;
            }
        }
        if self.wraps {
            // Where the whole circle is covered every lap meets.
            for (whole, laps) in [(open[Lap::Whole as usize], before), (before[Lap::Whole as usize], *open)] {
                laps.into_iter().for_each(|lap| pieces.join(whole, lap));
            }
        }
        Ok(())
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

    /// The slice of a cell at an end of its slab, whose middle has this foot. There it may have shrunk to a point, or
    /// grown to the whole circle, and rounding may have taken it a little beyond.
    fn limit(&self, end: &Section<S>, middle: S, lap: Lap) -> Interval<S> {
        let all = Interval::new(S::ZERO, self.first.length);
        let (mut foot, half) = match (end.reach, lap) {
            (_, Lap::Whole) => return all,
            (Reach::Around { foot, half }, _) => (foot, half),
            (Reach::Nothing, _) => (end.foot(self.first), S::ZERO),
            (Reach::Whole, _) => (end.foot(self.first), self.first.circumference.half()),
        };
        if self.wraps {
            if self.changes_lap(middle, foot, foot) {
                let lap = self.first.circumference;
                foot = if middle > foot { foot + lap } else { foot - lap };
            }
            foot = shift(foot, self.first, lap);
        }
        Interval::new(foot - half, foot + half).widen(S::ZERO, all)
    }

    /// How many laps the foot has lost between two slabs: it passes from the end of the lap to its beginning.
    fn laps_lost(&self, before: Slab<S>, after: Slab<S>, between: &Section<S>) -> i8 {
        if !self.wraps || !before.covered || !self.changes_lap(before.foot, after.foot, between.foot(self.first)) {
            0
        } else if before.foot > after.foot {
            1
        } else {
            -1
        }
    }

    /// Whether two feet lie on different sides of the middle of the segment because the foot left its lap, at `between`,
    /// on the far half of the circle.
    fn changes_lap(&self, a: S, b: S, between: S) -> bool {
        let middle = self.first.length.half();
        let quarter = self.first.circumference.half().half();
        (a > middle) != (b > middle) && (between - middle).abs() > quarter
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
