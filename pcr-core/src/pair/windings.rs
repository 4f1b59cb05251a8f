//! From events to pieces if two laps of the first segment can be covered at once: for an arc of half a turn or more, or
//! one that fits into the disc.
//!
//! In a slab, every lap that the disc covers is a cell; cells of neighbouring slabs with the same lap belong to the
//! same piece. Cells of different laps can meet only where the disc covers the whole circle.

use super::disc_on_segment::{CarrierCoordinates, CarrierCover};
use super::slabs::SegmentPair;
use crate::error::CapacityError;
use crate::geometry::Interval;
use crate::lap::{Branch, Winding, shift};
use crate::piece_store::{NO_NUMBER, Piece, PieceStore};
use crate::scalar::Scalar;
use crate::segment::Segment;

/// The part of the first segment that the disc covers at one length of the second.
#[derive(Clone, Copy)]
struct DiscSection<S> {
    footprint: CarrierCoordinates<S>,
    reach: CarrierCover<S>,
}

/// The data of a slab that its neighbours need.
#[derive(Clone, Copy)]
struct SlabState<S> {
    /// Whether anything of the segment is covered.
    covered: bool,
    /// The foot in the middle of the slab.
    foot: S,
}

/// The number of the piece that is open in each lap, indexed by [`Winding`].
type OpenBits = [u16; Winding::ALL.len()];

impl<S: Scalar> SegmentPair<'_, S> {
    /// Adds the pieces of the slabs and joins those that are connected.
    pub(super) fn find_laps<P: AsRef<[Piece<S>]> + AsMut<[Piece<S>]>>(
        &self,
        in_order: &[S],
        pieces: &mut PieceStore<S, P>,
    ) -> Result<(), CapacityError> {
        let mut open = [NO_NUMBER; Winding::ALL.len()];
        let mut before = SlabState { covered: false, foot: S::ZERO };
        let slabs = in_order.iter().zip(in_order.iter().skip(1)).map(|(&lo, &hi)| Interval::new(lo, hi));
        for range in slabs.filter(|&slab| self.is_slab(slab)) {
            let middle = self.section(range.middle());
            let slab = SlabState { covered: middle.reach != CarrierCover::Nothing, foot: middle.foot(self.first) };
            if before.covered || slab.covered {
                let edge = self.section(range.lo);
                self.limit_open(pieces, &open, &edge, before);
                if slab.covered {
                    let laps_lost = self.laps_lost(before, slab, &edge);
                    self.extend(pieces, range, &middle, &edge, &mut open, laps_lost)?;
                } else {
                    open = [NO_NUMBER; Winding::ALL.len()];
                }
            }
            before = slab;
        }
        if before.covered {
            self.limit_open(pieces, &open, &self.section(self.second.length), before);
        }
        Ok(())
    }

    fn section(&self, s: S) -> DiscSection<S> {
        let footprint = CarrierCoordinates::of(self.second.point_at(s), self.first);
        DiscSection { footprint, reach: footprint.reach(self.first, self.radius) }
    }

    /// Adds the slice at the end of their slab to the open pieces.
    fn limit_open<P>(&self, pieces: &mut PieceStore<S, P>, open: &OpenBits, end: &DiscSection<S>, slab: SlabState<S>)
    where
        P: AsRef<[Piece<S>]> + AsMut<[Piece<S>]>,
    {
        for lap in Winding::ALL {
            if let Some(piece) = pieces.get_mut(open[lap as usize]) {
                piece.first = piece.first.hull(self.limit(end, slab.foot, lap));
            }
        }
    }

    /// Adds the cells of one slab to the pieces that are open at its beginning; afterwards `open` holds those open at
    /// its end.
    fn extend<P: AsRef<[Piece<S>]> + AsMut<[Piece<S>]>>(
        &self,
        pieces: &mut PieceStore<S, P>,
        range: Interval<S>,
        middle: &DiscSection<S>,
        begin: &DiscSection<S>,
        open: &mut OpenBits,
        laps_lost: i8,
    ) -> Result<(), CapacityError> {
        let before = core::mem::replace(open, [NO_NUMBER; Winding::ALL.len()]);
        let several = middle.reach.intervals(self.first)[1].is_some();
        let mut share = if several { Branch::Start } else { Branch::Only };
        for lap in Winding::ALL {
            let Some(covered) = middle.reach.on(self.first, lap) else {
                continue;
            };
            let covered = covered.hull(self.limit(begin, middle.foot(self.first), lap));
            let ongoing = lap.less(laps_lost).map_or(NO_NUMBER, |lap| before[lap as usize]);
            let number = match pieces.get_mut(ongoing) {
                Some(piece) if piece.lap() == lap && piece.share() == share => {
                    piece.first = piece.first.hull(covered);
                    piece.second.hi = range.hi;
                    ongoing
                }
                _ => {
                    let number = pieces.push(Piece::new(self.indices, lap, share, covered, range))?;
                    pieces.join(ongoing, number);
                    number
                }
            };
            open[lap as usize] = number;
            if several {
                share = Branch::End;
            }
        }
        // If the whole circle is covered, all laps meet.
        for (whole, laps) in [(open[Winding::Whole as usize], before), (before[Winding::Whole as usize], *open)] {
            laps.into_iter().for_each(|lap| pieces.join(whole, lap));
        }
        Ok(())
    }

    /// The slice of a cell at an end of its slab; `middle` is the foot in the middle of the slab. At the end the slice
    /// may have shrunk to a point, or grown to the whole circle, and rounding may have moved it a little beyond.
    fn limit(&self, end: &DiscSection<S>, middle: S, lap: Winding) -> Interval<S> {
        let all = Interval::new(S::ZERO, self.first.length);
        let (mut foot, half) = match (end.reach, lap) {
            (_, Winding::Whole) => return all,
            (CarrierCover::Around { foot, half }, _) => (foot, half),
            (CarrierCover::Nothing, _) => (end.foot(self.first), S::ZERO),
            (CarrierCover::Whole, _) => (end.foot(self.first), self.first.circumference.half()),
        };
        if self.changes_lap(middle, foot, foot) {
            let lap = self.first.circumference;
            foot = if middle > foot { foot + lap } else { foot - lap };
        }
        foot = shift(foot, self.first, lap);
        Interval::new(foot - half, foot + half).widen(S::ZERO, all)
    }

    /// How many laps the foot passes backwards between two slabs: it goes from the end of a lap to its beginning.
    fn laps_lost(&self, before: SlabState<S>, after: SlabState<S>, between: &DiscSection<S>) -> i8 {
        if !before.covered || !self.changes_lap(before.foot, after.foot, between.foot(self.first)) {
            0
        } else if before.foot > after.foot {
            1
        } else {
            -1
        }
    }

    /// Whether two feet lie on different sides of the middle of the segment because the foot left its lap, at
    /// `between`, on the far half of the circle.
    fn changes_lap(&self, a: S, b: S, between: S) -> bool {
        let middle = self.first.length.half();
        let quarter = self.first.circumference.half().half();
        // A line has no laps, and no circumference.
        quarter > S::ZERO && (a > middle) != (b > middle) && (between - middle).abs() > quarter
    }
}

impl<S: Scalar> DiscSection<S> {
    fn foot(&self, segment: &Segment<S>) -> S {
        match self.reach {
            CarrierCover::Around { foot, .. } => foot,
            CarrierCover::Nothing | CarrierCover::Whole => self.footprint.foot(segment),
        }
    }
}
