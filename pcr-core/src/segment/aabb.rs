//! Boxes around an arc: along the axes of the plane, and along its chord.

use super::{Segment, TurnSide};
use crate::geometry::{Aabb, Direction, Point};
use crate::scalar::{Scalar, Unit};

impl<S: Scalar> Segment<S> {
    /// Computes the boxes of an arc whose ends are known.
    pub(super) fn enclose(&mut self, radius: S, turn: TurnSide) {
        self.bounds = self.arc_bounds(radius, turn);
        let along = (self.end - self.start).along(self.axis).half();
        let bulge = (self.point_at(self.length.half()) - self.start).across(self.axis).half();
        self.middle = self.start + self.axis.vector(along, bulge);
        // Beyond half a turn an arc is wider than its chord.
        self.half = [if self.half_turn.cos < S::Unit::ZERO { radius } else { along }, bulge.abs()];
    }

    /// Below half a turn a coordinate is extreme at an end, or on the axis where the other component of the heading
    /// changes its sign. From half a turn on, the whole circle is used.
    fn arc_bounds(&self, radius: S, turn: TurnSide) -> Aabb<S> {
        let (start, end) = (self.start, self.end);
        let (leaving, arriving) = (self.direction, Direction::<S>::at(self.heading_at_end));
        let left = match turn {
            TurnSide::Left => radius,
            TurnSide::Right => -radius,
        };
        let centre = start + leaving.vector(S::ZERO, left);
        let low = Point::new(centre.x - radius, centre.y - radius);
        let high = Point::new(centre.x + radius, centre.y + radius);
        let mut bounds = Aabb::around(start, end);
        if self.length.double() >= self.circumference {
            return bounds.hull(Aabb::around(low, high));
        }
        let negative = |unit: S::Unit| unit < S::Unit::ZERO;
        match (negative(leaving.cos), negative(arriving.cos)) {
            (false, true) => bounds.x.hi = bounds.x.hi.max(high.x),
            (true, false) => bounds.x.lo = bounds.x.lo.min(low.x),
            _ => {}
        }
        match (negative(leaving.sin), negative(arriving.sin)) {
            (false, true) => bounds.y.hi = bounds.y.hi.max(high.y),
            (true, false) => bounds.y.lo = bounds.y.lo.min(low.y),
            _ => {}
        }
        bounds
    }
}

#[cfg(all(test, feature = "libm"))]
mod tests {
    use super::*;
    use crate::{Pose, Radians};

    fn origin(heading: f64) -> Segment<f64> {
        Segment::standing(Pose { position: Point::new(0.0, 0.0), heading: Radians(heading) }).unwrap()
    }

    #[test]
    fn boxes_hold_the_arc_and_touch_it() {
        for k in 0..64 {
            for turn in [TurnSide::Left, TurnSide::Right] {
                let arc = origin(0.1 * f64::from(k)).then_arc(1.5, turn, 0.14 * f64::from(k)).unwrap();
                let points = (0..=1000).map(|n| arc.point_at(arc.length * f64::from(n) / 1000.0));
                let seen = points.map(|p| Aabb::around(p, p)).reduce(Aabb::hull).unwrap();
                let bounds = arc.bounds;
                assert_eq!(bounds.hull(seen), bounds, "holds");
                if arc.length.double() < arc.circumference {
                    assert!((bounds.x.length() - seen.x.length()) < 1e-5, "touches");
                }
            }
        }
    }

    /// Compares with points on the sides, also for almost straight arcs. A thousandth of an arc bulges by less than
    /// 1e-5 here; the rest is rounding.
    #[test]
    fn the_box_along_the_chord_holds_the_arc_and_touches_it() {
        for k in 1..64 {
            for (turn, radius) in [(TurnSide::Left, 1.5), (TurnSide::Right, 1.5), (TurnSide::Left, 1e9)] {
                let arc = origin(0.3 * f64::from(k)).then_arc(radius, turn, 0.147 * f64::from(k)).unwrap();
                let points = (0..=1000).map(|n| arc.point_at(arc.length * f64::from(n) / 1000.0) - arc.middle);
                let seen = points.map(|way| Point::new(way.along(arc.axis), way.across(arc.axis)));
                let seen = seen.map(|p| Aabb::around(p, p)).reduce(Aabb::hull).unwrap();
                for (seen, half) in [(seen.x, arc.half[0]), (seen.y, arc.half[1])] {
                    assert!((seen.lo + half).abs() < 1e-5 && (seen.hi - half).abs() < 1e-5, "touches: {seen:?} {half}");
                    assert!(seen.lo >= -half - 4e-15 && seen.hi <= half + 4e-15, "holds: {seen:?} {half}");
                }
            }
        }
    }
}
