//! From events to pieces: the collision region of one segment against one segment.
//!
//! The events cut the second segment into slabs. In a slab, every lap of the first segment that the disc
//! covers is a cell whose ends are monotone; cells of neighbouring slabs with the same lap are parts of one piece.
//! Cells of different laps can only meet where the disc covers the whole circle. The lengths of a piece are the hull
//! of its slices at the slab ends: nothing between them can be extreme (math: pair/events.rs).

use super::events::{Events, wraps};
use super::footprint::{Footprint, Lap, Reach, shift};
use crate::error::Full;
use crate::geometry::{Interval, Point};
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
}

/// What the disc covers at one length of the second segment.
#[derive(Clone, Copy)]
struct Section<S> {
    foot: S,
    reach: Reach<S>,
}

/// The piece that is open in each lap, by [`Lap`].
type Open = [Option<u32>; Lap::ALL.len()];

impl<S: Scalar> SegmentPair<'_, S> {
    /// Adds the pieces of this pair, joined where they are connected. Lengths are those along the segments.
    pub(crate) fn find<P: AsRef<[Piece<S>]> + AsMut<[Piece<S>]>>(&self, pieces: &mut Pieces<S, P>) -> Result<(), Full> {
        let events = Events::of(self.first, self.second, self.radius);
        let events = events.in_order();
        let mut open = Open::default();
        let mut before: Option<Section<S>> = None;
        for (&lo, &hi) in events.iter().zip(events.iter().skip(1)) {
            // Events may coincide; a second segment of length 0 has this one slab only.
            if lo >= hi && self.second.length > S::ZERO {
                continue;
            }
            let slab = Interval::new(lo, hi);
            let middle = self.section(slab.middle());
            let laps = before.map_or(0, |before| self.laps_lost(&before, &middle, lo));
            open = self.extend(pieces, slab, &middle, open, laps)?;
            before = Some(middle);
        }
        Ok(())
    }

    fn section(&self, s: S) -> Section<S> {
        Section::of(self.first, self.second.point_at(s), self.radius)
    }

    /// Adds the cells of one slab to the pieces that are open at its beginning; returns those open at its end.
    fn extend<P: AsRef<[Piece<S>]> + AsMut<[Piece<S>]>>(
        &self,
        pieces: &mut Pieces<S, P>,
        slab: Interval<S>,
        middle: &Section<S>,
        open: Open,
        laps_lost: i8,
    ) -> Result<Open, Full> {
        let mut now = Open::default();
        if middle.reach == Reach::Nothing {
            return Ok(now);
        }
        let ends = [self.section(slab.lo), self.section(slab.hi)];
        for lap in Lap::ALL {
            let Some(mut covered) = middle.reach.on(self.first, lap) else {
                continue;
            };
            for end in &ends {
                covered = covered.hull(self.limit(end, middle, lap));
            }
            let ongoing = lap.less(laps_lost).and_then(|lap| open[lap as usize]);
            let index = match ongoing.and_then(|index| pieces.get_mut(index)) {
                Some(piece) if laps_lost == 0 => {
                    piece.first = piece.first.hull(covered);
                    piece.second.hi = slab.hi;
                    ongoing
                }
                _ => Some(pieces.push(Piece::new(self.indices, lap, covered, slab))?),
            };
            now[lap as usize] = index;
            if let (Some(index), Some(ongoing)) = (index, ongoing) {
                pieces.join(ongoing, index);
            }
        }
        // Where the whole circle is covered every lap meets.
        for (whole, laps) in [(now[Lap::Whole as usize], open), (open[Lap::Whole as usize], now)] {
            if let Some(whole) = whole {
                laps.into_iter().flatten().for_each(|lap| pieces.join(whole, lap));
            }
        }
        Ok(now)
    }

    /// The slice of a cell at an end of its slab. There it may have shrunk to a point, or grown to the whole
    /// circle, and rounding may have taken it a little beyond.
    fn limit(&self, end: &Section<S>, middle: &Section<S>, lap: Lap) -> Interval<S> {
        let all = Interval::new(S::ZERO, self.first.length);
        let half = match (end.reach, lap) {
            (_, Lap::Whole) => return all,
            (Reach::Nothing, _) => S::ZERO,
            (Reach::Around { half, .. }, _) => half,
            (Reach::Whole, _) => self.first.circumference.half(),
        };
        let mut foot = end.foot;
        if self.changes_lap(middle, end, end) {
            foot = if middle.foot > foot { foot + self.first.circumference } else { foot - self.first.circumference };
        }
        let foot = shift(foot, self.first, lap);
        Interval::new(foot - half, foot + half).widen(S::ZERO, all)
    }

    /// How many laps the foot has lost between two slabs: it passes from the end of the lap to its beginning.
    fn laps_lost(&self, before: &Section<S>, after: &Section<S>, event: S) -> i8 {
        if !wraps(self.first, self.radius) || !self.changes_lap(before, after, &self.section(event)) {
            0
        } else if before.foot > after.foot {
            1
        } else {
            -1
        }
    }

    /// Whether the feet of two sections lie on different sides of the middle of the segment because the foot
    /// left its lap, at `between`, on the far half of the circle.
    fn changes_lap(&self, a: &Section<S>, b: &Section<S>, between: &Section<S>) -> bool {
        let middle = self.first.length.half();
        let far = (between.foot - middle).abs() > self.first.circumference.half().half();
        self.first.circumference > S::ZERO && (a.foot > middle) != (b.foot > middle) && far
    }
}

impl<S: Scalar> Section<S> {
    fn of(segment: &Segment<S>, centre: Point<S>, radius: S) -> Self {
        let footprint = Footprint::of(centre, segment);
        match footprint.reach(segment, radius) {
            reach @ Reach::Around { foot, .. } => Self { foot, reach },
            reach => Self { foot: footprint.foot(segment), reach },
        }
    }
}
