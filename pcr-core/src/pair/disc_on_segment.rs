//! P1, disc against segment: which lengths of a line or arc lie within `r` of a point.
//!
//! Let `(x, y)` be the local coordinates of the point in the frame of the start of the segment (`x` along, `y` towards
//! the centre of an arc, left of a line), `ϱ` the radius of the arc and `d` the distance of the point from its centre:
//!
//! ```text
//! d = √(x² + (ϱ - y)²)                distance from the centre
//! n = ϱ - d = (2 ϱ y - x² - y²) / (ϱ + d)     lateral offset, without cancellation for ϱ ≫ |x|, |y|
//! u = ϱ atan2(x, ϱ - y)               length at the foot
//! H = 2 ϱ atan2(√((r - |n|)(r + |n|)), √((ϱ + d - r)(ϱ + d + r)))   half-width
//! ```
//!
//! and `n = y`, `u = x`, `H = √((r - |n|)(r + |n|))` on a line. The segment is within `r` at the lengths
//! `[u - H, u + H]`, on every lap of the circle. This is Eq. (13) and, corrected, Eq. (26)-(29) of the paper, in one
//! form that is right for every radius, also for `r > ϱ` (docs/theory/equations.md).

use crate::geometry::{Direction, Interval, Point};
use crate::lap::{Winding, shift};
use crate::scalar::{Angle, Scalar, Unit, Wide};
use crate::segment::{Curve, Segment};

/// A point in the coordinates of the carrier (infinite line or full circle) of a segment.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CarrierCoordinates<S> {
    /// Local coordinates, mirrored for an arc that turns right, so that its centre is at `(0, ϱ)`.
    x: S,
    y: S,
    /// Distance from the centre of an arc; 0 on a line.
    distance: S,
    /// Lateral distance from the carrier, positive towards the centre of an arc or left of a line.
    pub(crate) offset: S,
}

/// The lengths of a carrier that lie within a radius of a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum CarrierCover<S> {
    /// No length.
    Nothing,
    /// The lengths within `half` of `foot`, on every lap.
    Around {
        /// Length at the foot of the point.
        foot: S,
        /// Half the width of the interval.
        half: S,
    },
    /// All lengths: the whole circle is inside the disc.
    Whole,
}

/// The parts of a segment that a disc covers.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SegmentCover {
    /// The start of the segment.
    pub(crate) start: bool,
    /// The end of the segment.
    pub(crate) end: bool,
    /// Any part of it.
    pub(crate) any: bool,
}

impl<S: Scalar> CarrierCoordinates<S> {
    /// Cost: a square root and a division on an arc, none on a line.
    pub(crate) fn of(point: Point<S>, segment: &Segment<S>) -> Self {
        let from_start = point - segment.start;
        let x = from_start.along(segment.direction);
        let y = from_start.across(segment.direction);
        match segment.curve {
            Curve::Line | Curve::Pivot { .. } => Self { x, y, distance: S::ZERO, offset: y },
            Curve::Arc { radius, .. } => {
                let y = y.negate_if(segment.mirrored());
                let below = radius - y;
                let distance = (x.times(x) + below.times(below)).sqrt();
                let squares = y.times(radius.double() - y) - x.times(x);
                Self { x, y, distance, offset: S::difference(radius, distance, squares) }
            }
        }
    }

    /// Length at the foot; on an arc, the foot that is nearest to the middle of the segment.
    pub(crate) fn foot(&self, segment: &Segment<S>) -> S {
        let Curve::Arc { radius, .. } = segment.curve else {
            return self.x;
        };
        near_middle(S::Angle::atan2(self.x, radius - self.y).arc_length(radius), segment)
    }

    /// Direction of the carrier at the foot, in the (mirrored) frame of the start of the segment.
    pub(crate) fn direction(&self, segment: &Segment<S>) -> Direction<S> {
        match segment.curve {
            Curve::Arc { radius, .. } if self.distance > S::ZERO => {
                let [cos, sin] = S::unit_vector(radius - self.y, self.x, self.distance);
                Direction { cos, sin }
            }
            _ => Direction { cos: S::Unit::ONE, sin: S::Unit::ZERO },
        }
    }

    /// Which parts of a segment a disc around the point covers, if it covers at most one lap. Needs no square root and
    /// no arctangent.
    pub(crate) fn covered(&self, point: Point<S>, segment: &Segment<S>, r: S) -> SegmentCover {
        let square = r.times(r);
        let start = self.x.times(self.x) + self.y.times(self.y) <= square;
        let end = (point - segment.end).norm_squared() <= square;
        let near = self.offset.abs() <= r;
        SegmentCover { start: near & start, end: near & end, any: near & (start | end | self.foot_is_on(segment)) }
    }

    /// Whether the foot lies on the segment, which is at most half a turn long.
    fn foot_is_on(&self, segment: &Segment<S>) -> bool {
        match segment.curve {
            Curve::Line | Curve::Pivot { .. } => (S::ZERO <= self.x) & (self.x <= segment.length),
            Curve::Arc { radius, .. } => {
                let turn = segment.turn_at_end();
                (S::ZERO <= self.x) & (S::combine(radius - self.y, turn.sin, self.x, -turn.cos) >= S::ZERO)
            }
        }
    }

    /// The lengths of the carrier within `r` of the point. Cost on an arc: two square roots and two arctangents.
    pub(crate) fn reach(&self, segment: &Segment<S>, r: S) -> CarrierCover<S> {
        let offset = self.offset.abs();
        if offset > r {
            return CarrierCover::Nothing;
        }
        let Curve::Arc { radius, .. } = segment.curve else {
            return CarrierCover::Around { foot: self.x, half: (r - offset).times(r + offset).sqrt() };
        };
        let diameter = radius + self.distance;
        if diameter <= r {
            return CarrierCover::Whole;
        }
        let near = (r - offset).times(r + offset).sqrt();
        let far = (diameter - r).times(diameter + r).sqrt();
        let [foot, half] = S::Angle::atan2_each([self.x, near], [radius - self.y, far]);
        let half = half.arc_length(radius).double();
        CarrierCover::Around { foot: near_middle(foot.arc_length(radius), segment), half }
    }
}

/// Moves a length on a circle, within half a turn of its start, to the lap that is nearest to the middle of the
/// segment.
fn near_middle<S: Scalar>(foot: S, segment: &Segment<S>) -> S {
    if foot < (segment.length - segment.circumference).half() { foot + segment.circumference } else { foot }
}

impl<S: Scalar> CarrierCover<S> {
    /// The part of the segment that this lap of the interval covers, if any.
    pub(crate) fn on(self, segment: &Segment<S>, lap: Winding) -> Option<Interval<S>> {
        let all = Interval::new(S::ZERO, segment.length);
        match (self, lap) {
            (CarrierCover::Whole, Winding::Whole) => Some(all),
            (CarrierCover::Around { .. }, Winding::Previous | Winding::Next) if segment.curve == Curve::Line => None,
            (CarrierCover::Around { foot, half }, Winding::Previous | Winding::Same | Winding::Next) => {
                let foot = shift(foot, segment, lap);
                let covered = Interval::new(foot - half, foot + half);
                covered.meets(all).then(|| covered.common(all))
            }
            _ => None,
        }
    }
}

impl<S: Scalar> CarrierCover<S> {
    /// The covered parts of the segment: at most two intervals, in increasing order.
    pub(crate) fn intervals(self, segment: &Segment<S>) -> [Option<Interval<S>>; 2] {
        let mut intervals = [None; 2];
        for interval in Winding::ALL.into_iter().filter_map(|lap| self.on(segment, lap)) {
            match intervals {
                [None, _] => intervals[0] = Some(interval),
                [Some(low), None] if !interval.meets(low) => intervals[1] = Some(interval),
                // Rounding, just before the whole circle is covered.
                [Some(low), None] => intervals[0] = Some(low.hull(interval)),
                [Some(low), Some(high)] => intervals = [Some(low.hull(high).hull(interval)), None],
            }
        }
        intervals
    }
}

#[cfg(all(test, feature = "libm"))]
mod tests {
    use super::*;
    use crate::{Pose, Radians, TurnSide};
    use core::f64::consts::{FRAC_PI_2, PI, TAU};

    fn origin() -> Segment<f64> {
        Segment::standing(Pose { position: Point::new(0.0, 0.0), heading: Radians(0.0) }).unwrap()
    }

    fn close(interval: Option<Interval<f64>>, lo: f64, hi: f64) -> bool {
        interval.is_some_and(|interval| (interval.lo - lo).abs() < 1e-15 && (interval.hi - hi).abs() < 1e-15)
    }

    #[test]
    fn a_disc_beside_a_line_covers_the_chord_of_a_3_4_5_triangle() {
        let line = origin().then_line(10.0).unwrap();
        let covered =
            |x: f64, y: f64| CarrierCoordinates::of(Point::new(x, y), &line).reach(&line, 5.0).intervals(&line);
        assert!(close(covered(5.0, 3.0)[0], 1.0, 9.0));
        assert!(close(covered(1.0, -3.0)[0], 0.0, 5.0));
        assert!(close(covered(5.0, 5.0)[0], 5.0, 5.0));
        assert_eq!(covered(5.0, 5.000_000_000_000_001), [None, None]);
        assert_eq!(covered(-4.1, 3.0), [None, None]);
    }

    #[test]
    fn a_disc_on_a_circle_covers_an_angle_either_way_round() {
        // A chord of length R = √2 in the unit circle spans a quarter turn.
        for turn in [TurnSide::Left, TurnSide::Right] {
            let arc = origin().then_arc(1.0, turn, PI).unwrap();
            let covered =
                |u: f64| CarrierCoordinates::of(arc.point_at(u), &arc).reach(&arc, 2.0_f64.sqrt()).intervals(&arc);
            assert!(close(covered(FRAC_PI_2)[0], 0.0, PI));
            assert!(close(covered(0.0)[0], 0.0, FRAC_PI_2));
        }
    }

    #[test]
    fn a_disc_at_the_seam_of_a_full_turn_covers_both_ends() {
        let circle = origin().then_arc(1.0, TurnSide::Left, TAU).unwrap();
        let [start, end] = CarrierCoordinates::of(Point::new(0.0, 0.0), &circle).reach(&circle, 1.0).intervals(&circle);
        let third = PI / 3.0;
        assert!(
            close(start, 0.0, third) && end.is_some_and(|end| (end.lo - (TAU - third)).abs() < 1e-15 && end.hi == TAU)
        );
    }

    #[test]
    fn a_disc_larger_than_the_circle_covers_all_nothing_or_the_near_side() {
        let circle = origin().then_arc(1.0, TurnSide::Left, TAU).unwrap();
        let reach = |y: f64| CarrierCoordinates::of(Point::new(0.0, y), &circle).reach(&circle, 2.0);
        assert_eq!(reach(1.0), CarrierCover::Whole);
        assert_eq!(reach(-2.5), CarrierCover::Nothing);
        assert_eq!(reach(5.0), CarrierCover::Nothing);
        // The centre of the disc is at the lowest point of the circle: the far point is exactly 2 away.
        assert_eq!(reach(0.0), CarrierCover::Whole);
        assert!(
            matches!(reach(-1.0), CarrierCover::Around { foot: 0.0, half } if (half - 1.318_116_071_652_818).abs() < 1e-14)
        );
    }

    #[test]
    fn the_offset_of_a_nearly_straight_arc_does_not_cancel() {
        // y = 0 and x = 3 on a circle of radius 1e9: offset -x²/2ϱ.
        let arc = origin().then_arc(1e9, TurnSide::Left, 10.0).unwrap();
        let footprint = CarrierCoordinates::of(Point::new(3.0, 0.0), &arc);
        assert!((footprint.offset + 4.5e-9).abs() < 1e-23);
        assert!((footprint.foot(&arc) - 3.0).abs() < 1e-15);
    }
}
