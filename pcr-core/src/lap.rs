//! Which of several intervals of a segment a disc covers: the lap on a circle, and the share of a piece.

use crate::geometry::Interval;
use crate::scalar::Scalar;
use crate::segment::Segment;

/// The lap of an interval that a disc cuts out of a circle: by how many circumferences its foot is shifted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub(crate) enum Winding {
    /// The foot minus one circumference.
    Previous,
    /// The foot that is nearest to the middle of the segment; the only lap on a line.
    Same,
    /// The foot plus one circumference.
    Next,
    /// The whole circle is inside the disc.
    Whole,
}

impl Winding {
    pub(crate) const ALL: [Self; 4] = [Self::Previous, Self::Same, Self::Next, Self::Whole];

    /// This lap, counted from a foot that has passed backwards through a number of laps.
    pub(crate) fn less(self, laps: i8) -> Option<Self> {
        match self as i8 - laps {
            _ if self == Self::Whole => Some(self),
            0 => Some(Self::Previous),
            1 => Some(Self::Same),
            2 => Some(Self::Next),
            _ => None,
        }
    }
}

/// The other disc can cover two intervals of a segment at once; this says which of them belongs to a piece.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum Branch {
    /// The only interval.
    Only,
    /// The first of two, at the start of the segment. There are two if the gap between them lies inside the segment.
    Start,
    /// The second of two, at the end of the segment.
    End,
}

impl Branch {
    /// The covered intervals that belong to the piece. Near an end of the piece rounding may turn one interval into
    /// two, or two into one, a little away from the end of the segment; then those intervals are returned that reach
    /// into `hull`, the range of the piece.
    pub(crate) fn of<S: Scalar>(
        self,
        intervals: [Option<Interval<S>>; 2],
        segment: &Segment<S>,
        hull: Interval<S>,
    ) -> [Option<Interval<S>>; 2] {
        match (self, intervals) {
            (Self::Only, [Some(_), None]) => return intervals,
            (Self::Start, [first, Some(_)]) => return [first, None],
            (Self::End, [_, Some(last)]) => return [Some(last), None],
            _ => {}
        }
        intervals.map(|interval| {
            interval.filter(|interval| {
                let (from_start, from_end) = (interval.lo, segment.length - interval.hi);
                interval.meets(hull)
                    && match self {
                        Self::Only => true,
                        Self::Start => from_start <= from_end,
                        Self::End => from_end <= from_start,
                    }
            })
        })
    }

    /// Whether the length `l` lies in an interval of the piece. A length that is in no interval, because of rounding,
    /// may belong to any piece.
    pub(crate) fn holds<S: Scalar>(
        self,
        l: S,
        intervals: [Option<Interval<S>>; 2],
        segment: &Segment<S>,
        hull: Interval<S>,
    ) -> bool {
        let hold = |intervals: [Option<Interval<S>>; 2]| intervals.into_iter().flatten().any(|slice| slice.contains(l));
        hold(self.of(intervals, segment, hull)) || !hold(intervals)
    }
}

pub(crate) fn shift<S: Scalar>(foot: S, segment: &Segment<S>, lap: Winding) -> S {
    match lap {
        Winding::Previous => foot - segment.circumference,
        Winding::Next => foot + segment.circumference,
        Winding::Same | Winding::Whole => foot,
    }
}
