//! Whether and where two segments may come near each other, decided by boxes along the chords of both and by circles.
//! This rejects most pairs before any closed form is evaluated.

use super::{Curve, Segment};
use crate::bit_rows;
use crate::geometry::{Aabb, Interval};
use crate::scalar::{Scalar, Unit};

/// Number of segments whose boxes are compared at once.
pub(crate) const ROW: usize = u32::BITS as usize;

/// Which segments of a row have boxes that meet `around`, one bit each.
pub(crate) fn in_box<S: Scalar>(row: &[Segment<S>], around: Aabb<S>) -> u32 {
    bit_rows::row(row.iter().map(|segment| around.meets(segment.bounds)))
}

impl<S: Scalar> Segment<S> {
    /// Whether this segment may come nearer than `reach` to another one: the boxes along both chords come that near,
    /// and the circle of an arc comes that near to the box of the other.
    #[cfg_attr(feature = "std", inline(always))]
    pub(crate) fn near(&self, other: &Self, reach: S) -> bool {
        let (cos, sin) = (self.axis.dot(other.axis).abs(), self.axis.cross(other.axis).abs());
        let apart = other.middle - self.middle;
        let separated = |a: &Self, b: &Self| {
            (apart.along(a.axis).abs() > a.half[0] + b.half[0].scale(cos) + b.half[1].scale(sin) + reach)
                | (apart.across(a.axis).abs() > a.half[1] + b.half[0].scale(sin) + b.half[1].scale(cos) + reach)
        };
        !(separated(self, other) | separated(other, self))
            && self.circle_near(other, reach)
            && other.circle_near(self, reach)
    }

    /// Where this segment may come nearer than `reach` to another one, as lengths along it: the part of a line that is
    /// that near to the box of the other, or the whole of an arc.
    pub(crate) fn beside(&self, other: &Self, reach: S) -> Option<Interval<S>> {
        let whole = Interval::new(S::ZERO, self.length);
        if self.curve != Curve::Line {
            return Some(whole);
        }
        // At the length u the distance from the middle along an axis is x + u c, with x its value at the start and c
        // the slope.
        let within = |x: S, slope: S::Unit, half: S| {
            let ends = [-half - x, half - x].map(|way| way.quotient_unit(slope));
            let [Some(a), Some(b)] = ends else { return whole };
            Interval::new(a.min(b), a.max(b))
        };
        let from = self.start - other.middle;
        let along = within(from.along(other.axis), other.axis.dot(self.direction), other.half[0] + reach);
        let across = within(from.across(other.axis), other.axis.cross(self.direction), other.half[1] + reach);
        let part = whole.common(along).common(across);
        (part.lo <= part.hi).then_some(part)
    }

    /// Whether the circle of an arc may come nearer than `reach` to the box of another segment.
    fn circle_near(&self, other: &Self, reach: S) -> bool {
        let Curve::Arc { radius, .. } = self.curve else {
            return true;
        };
        // The centre of a large circle is known less accurately.
        let reach = reach + S::slack(radius.double());
        let apart = other.middle - self.centre(radius);
        let (along, across) = (apart.along(other.axis).abs(), apart.across(other.axis).abs());
        let [half_along, half_across] = other.half;
        let squares = |x: S, y: S| x.times(x) + y.times(y);
        let nearest = squares((along - half_along).max(S::ZERO), (across - half_across).max(S::ZERO));
        let farthest = squares(along + half_along, across + half_across);
        let (outside, inside) = (radius + reach, (radius - reach).max(S::ZERO));
        (nearest <= outside.times(outside)) & (farthest >= inside.times(inside))
    }
}

#[cfg(all(test, feature = "libm"))]
mod tests {
    use crate::{Point, Pose, Radians, Segment, TurnSide};

    #[test]
    fn near_is_never_wrong_about_segments_that_touch() {
        let start = Segment::standing(Pose { position: Point::new(0.0, 0.0), heading: Radians(0.3) }).unwrap();
        for k in 0..200 {
            let k = f64::from(k);
            let own = start.then_arc(0.7, TurnSide::Right, 0.02 * k).unwrap();
            let other = own.then_arc(0.4, TurnSide::Left, 1.0 + 0.001 * k).unwrap();
            assert!(own.near(&other, 1e-12) && other.near(&own, 1e-12));
            let away = start.then_line(5.0).unwrap().then_line(1.0).unwrap();
            assert!(!own.near(&away, 0.5));
        }
    }
}
