//! P1, disc against piece: which lengths of a line or arc lie within `r` of a point.
//!
//! With the local coordinates `(x, y)` of the point in the frame of the start of the piece (`x` along, `y`
//! towards the centre of an arc, left of a line), `ϱ` the radius of the arc and `d` the distance of the point
//! from its centre:
//!
//! ```text
//! d = √(x² + (ϱ - y)²)                distance from the centre
//! n = ϱ - d = (2 ϱ y - x² - y²) / (ϱ + d)     lateral offset, without cancellation for ϱ ≫ |x|, |y|
//! u = ϱ atan2(x, ϱ - y)               length at the foot
//! H = 2 ϱ atan2(√((r - |n|)(r + |n|)), √((ϱ + d - r)(ϱ + d + r)))   half-width
//! ```
//!
//! and `n = y`, `u = x`, `H = √((r - |n|)(r + |n|))` on a line. The piece is within `r` for the lengths
//! `[u - H, u + H]`, on every lap of the circle. This is Eq. (13) and, corrected, Eq. (26)-(29) of the paper
//! in one form that is right for every radius, `r > ϱ` included (docs/equations.md).

use crate::geometry::{Direction, Interval, Point};
use crate::scalar::{Angle, Scalar, Unit, Wide};
use crate::segment::{Curve, Segment};

/// A point seen from the carrier (infinite line or full circle) of a segment.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Footprint<S> {
    /// Local coordinates, mirrored for an arc that turns right, so that its centre is at `(0, ϱ)`.
    x: S,
    y: S,
    /// Distance from the centre of an arc; 0 on a line.
    distance: S,
    /// Lateral distance from the carrier, positive towards the centre of an arc, left of a line.
    pub(crate) offset: S,
}

/// The lengths of a carrier that lie within a radius of a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Reach<S> {
    /// None.
    Nothing,
    /// Those within `half` of `foot`, on every lap.
    Around {
        /// Length at the foot of the point.
        foot: S,
        /// Half the width of the interval.
        half: S,
    },
    /// All of them: the whole circle is inside the disc.
    Whole,
}

impl<S: Scalar> Footprint<S> {
    /// Cost: two square roots and a division on an arc, none on a line.
    pub(crate) fn of(point: Point<S>, segment: &Segment<S>) -> Self {
        let from_start = point - segment.start;
        let x = from_start.along(segment.direction);
        let y = from_start.across(segment.direction);
        match segment.curve {
            Curve::Line => Self { x, y, distance: S::ZERO, offset: y },
            Curve::Arc { radius, .. } => {
                let y = if segment.mirrored() { -y } else { y };
                let below = radius - y;
                let distance = (x.times(x) + below.times(below)).sqrt();
                let squares = y.times(radius.double() - y) - x.times(x);
                Self { x, y, distance, offset: S::difference(radius, distance, squares) }
            }
        }
    }

    /// Length at the foot; on an arc the one nearest to the middle of the segment.
    pub(crate) fn foot(&self, segment: &Segment<S>) -> S {
        let Curve::Arc { radius, .. } = segment.curve else {
            return self.x;
        };
        let foot = S::Angle::atan2(self.x, radius - self.y).arc_length(radius);
        if foot < (segment.length - segment.circumference).half() { foot + segment.circumference } else { foot }
    }

    /// Direction of the carrier at the foot, in the (mirrored) frame of the start of the segment.
    pub(crate) fn direction(&self, segment: &Segment<S>) -> Direction<S> {
        match segment.curve {
            Curve::Arc { radius, .. } if self.distance > S::ZERO => {
                Direction { cos: (radius - self.y).over_norm(self.distance), sin: self.x.over_norm(self.distance) }
            }
            _ => Direction { cos: S::Unit::ONE, sin: S::Unit::ZERO },
        }
    }

    /// The lengths of the carrier within `r` of the point. Cost: two square roots and two arctangents on an arc.
    pub(crate) fn reach(&self, segment: &Segment<S>, r: S) -> Reach<S> {
        let offset = self.offset.abs();
        if offset > r {
            return Reach::Nothing;
        }
        let Curve::Arc { radius, .. } = segment.curve else {
            return Reach::Around { foot: self.x, half: (r - offset).times(r + offset).sqrt() };
        };
        let diameter = radius + self.distance;
        if diameter <= r {
            return Reach::Whole;
        }
        let near = (r - offset).times(r + offset).sqrt();
        let far = (diameter - r).times(diameter + r).sqrt();
        let half = S::Angle::atan2(near, far).arc_length(radius).double();
        Reach::Around { foot: self.foot(segment), half }
    }
}

/// Which of the intervals that a disc cuts out of a circle: its foot, moved by so many laps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub(crate) enum Lap {
    /// The foot less one circumference.
    Previous,
    /// The foot nearest to the middle of the segment; the only one on a line.
    Same,
    /// The foot plus one circumference.
    Next,
    /// The circle is inside the disc.
    Whole,
}

impl Lap {
    pub(crate) const ALL: [Self; 4] = [Self::Previous, Self::Same, Self::Next, Self::Whole];

    /// This lap counted from a foot that has lost so many laps since.
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

impl<S: Scalar> Reach<S> {
    /// The part of the segment that this lap of the interval covers, if any.
    pub(crate) fn on(self, segment: &Segment<S>, lap: Lap) -> Option<Interval<S>> {
        let all = Interval::new(S::ZERO, segment.length);
        match (self, lap) {
            (Reach::Whole, Lap::Whole) => Some(all),
            (Reach::Around { .. }, Lap::Previous | Lap::Next) if segment.curve == Curve::Line => None,
            (Reach::Around { foot, half }, Lap::Previous | Lap::Same | Lap::Next) => {
                let foot = shift(foot, segment, lap);
                let (lo, hi) = (foot - half, foot + half);
                (lo <= all.hi && hi >= all.lo).then(|| Interval::new(lo, hi).widen(S::ZERO, all))
            }
            _ => None,
        }
    }
}

impl<S: Scalar> Reach<S> {
    /// What is covered of the segment, at most two intervals in increasing order.
    pub(crate) fn intervals(self, segment: &Segment<S>) -> [Option<Interval<S>>; 2] {
        let mut intervals = [None; 2];
        for interval in Lap::ALL.into_iter().filter_map(|lap| self.on(segment, lap)) {
            match intervals {
                [None, _] => intervals[0] = Some(interval),
                [Some(low), None] if !interval.meets(low) => intervals[1] = Some(interval),
                // Rounding where the whole circle is about to be covered.
                [Some(low), None] => intervals[0] = Some(low.hull(interval)),
                [Some(low), Some(high)] => intervals = [Some(low.hull(high).hull(interval)), None],
            }
        }
        intervals
    }
}

/// Which of the intervals that are covered at one length a piece stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub(crate) enum Share {
    /// The only one.
    Only,
    /// Of two, the one at the start of the segment. There are two where the gap between them lies inside the segment.
    Start,
    /// Of two, the one at the end of the segment.
    End,
}

impl Share {
    /// The intervals it stands for, of those that are covered. Next to an end of the piece rounding may show a
    /// second one where there is one; then those that reach into `hull`, where the piece lies.
    pub(crate) fn of<S: Scalar>(
        self,
        intervals: [Option<Interval<S>>; 2],
        segment: &Segment<S>,
        hull: Interval<S>,
    ) -> [Option<Interval<S>>; 2] {
        let single = intervals[1].is_none();
        intervals.map(|interval| {
            interval.filter(|interval| match self {
                Self::Only => single || interval.meets(hull),
                Self::Start => interval.lo <= S::ZERO,
                Self::End => interval.hi >= segment.length,
            })
        })
    }
}

pub(crate) fn shift<S: Scalar>(foot: S, segment: &Segment<S>, lap: Lap) -> S {
    match lap {
        Lap::Previous => foot - segment.circumference,
        Lap::Next => foot + segment.circumference,
        Lap::Same | Lap::Whole => foot,
    }
}
