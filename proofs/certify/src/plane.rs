//! Points, lines and arcs of the plane, and the distances between a point and a part of a line or arc, in closed form.

use crate::ball::{Ball, BallReal, Ternary};
use crate::double_double::DoubleDouble;
use std::ops::{Add, Sub};

/// A point or vector \[m\].
#[derive(Clone, Copy, Debug)]
pub struct BallVector<R> {
    /// Abscissa.
    pub x: Ball<R>,
    /// Ordinate.
    pub y: Ball<R>,
}

impl<R: BallReal> Add for BallVector<R> {
    type Output = Self;
    fn add(self, rhs: Self) -> Self {
        Self { x: self.x + rhs.x, y: self.y + rhs.y }
    }
}

impl<R: BallReal> Sub for BallVector<R> {
    type Output = Self;
    fn sub(self, rhs: Self) -> Self {
        Self { x: self.x - rhs.x, y: self.y - rhs.y }
    }
}

impl<R: BallReal> BallVector<R> {
    /// A vector of numbers of 106 bits.
    pub fn of(vector: BallVector<DoubleDouble>) -> Self {
        Self { x: Ball::from_twofold(vector.x), y: Ball::from_twofold(vector.y) }
    }

    /// The vector times a number.
    #[must_use]
    pub fn times(self, factor: Ball<R>) -> Self {
        Self { x: self.x * factor, y: self.y * factor }
    }

    /// The vector turned by the angle of which these are sine and cosine.
    #[must_use]
    pub fn turned(self, [sin, cos]: [Ball<R>; 2]) -> Self {
        Self { x: self.x * cos - self.y * sin, y: self.x * sin + self.y * cos }
    }

    /// A quarter turn to the left.
    #[must_use]
    pub fn left(self) -> Self {
        Self { x: -self.y, y: self.x }
    }

    /// Scalar product.
    pub fn dot(self, other: Self) -> Ball<R> {
        self.x * other.x + self.y * other.y
    }

    /// The part of `other` that lies to the left, times the length of this.
    pub fn cross(self, other: Self) -> Ball<R> {
        self.x * other.y - self.y * other.x
    }

    /// Length.
    pub fn norm(self) -> Ball<R> {
        self.dot(self).sqrt()
    }
}

/// The infinite line or full circle that a segment lies on, and where on it the segment starts.
#[derive(Clone, Copy, Debug)]
pub enum BallCarrier<R> {
    /// Start and unit vector along.
    Line {
        /// Start of the segment.
        start: BallVector<R>,
        /// Unit vector along.
        along: BallVector<R>,
    },
    /// Of an arc.
    Circle {
        /// Centre.
        centre: BallVector<R>,
        /// Radius \[m\].
        radius: Ball<R>,
        /// Unit vector from the centre to the start.
        start: BallVector<R>,
        /// Whether the arc turns left.
        left: bool,
    },
}

impl<R: BallReal> BallCarrier<R> {
    /// The same with numbers of another type.
    pub fn of(carrier: BallCarrier<DoubleDouble>) -> Self {
        match carrier {
            BallCarrier::Line { start, along } => {
                Self::Line { start: BallVector::of(start), along: BallVector::of(along) }
            }
            BallCarrier::Circle { centre, radius, start, left } => Self::Circle {
                centre: BallVector::of(centre),
                radius: Ball::from_twofold(radius),
                start: BallVector::of(start),
                left,
            },
        }
    }

    /// The point after a length along it \[m\].
    pub fn point(&self, length: Ball<R>) -> BallVector<R> {
        match *self {
            Self::Line { start, along } => start + along.times(length),
            Self::Circle { centre, radius, .. } => centre + self.axis(length).times(radius),
        }
    }

    /// Unit vector from the centre of a circle to the point after a length along it.
    fn axis(&self, length: Ball<R>) -> BallVector<R> {
        match *self {
            Self::Line { along, .. } => along,
            Self::Circle { radius, start, left, .. } => {
                let angle = length / radius;
                start.turned((if left { angle } else { -angle }).sin_cos())
            }
        }
    }

    /// Unit vector along it after a length.
    pub fn direction(&self, length: Ball<R>) -> BallVector<R> {
        let axis = self.axis(length);
        match *self {
            Self::Line { .. } => axis,
            Self::Circle { left: true, .. } => axis.left(),
            Self::Circle { left: false, .. } => axis.left().times(Ball::from(-1.0)),
        }
    }
}

/// The least and the greatest value of a function.
#[derive(Clone, Copy, Debug)]
pub struct BallRange<R> {
    /// The least one.
    pub lo: Ball<R>,
    /// The greatest one.
    pub hi: Ball<R>,
}

/// A part of a segment.
#[derive(Clone, Copy, Debug)]
pub struct SegmentPart<R> {
    /// The point in its middle.
    pub middle: BallVector<R>,
    /// Half its length \[m\].
    pub half: Ball<R>,
    /// Its ends.
    pub ends: [BallVector<R>; 2],
    /// Unit vector along it in the middle of a line, from the centre to the middle of an arc.
    pub axis: BallVector<R>,
    /// Of an arc.
    pub circle: Option<ArcCircle<R>>,
}

/// The circle of a part of an arc.
#[derive(Clone, Copy, Debug)]
pub struct ArcCircle<R> {
    /// Centre.
    pub centre: BallVector<R>,
    /// Radius \[m\].
    pub radius: Ball<R>,
    /// Half the angle of the part, seen from the centre.
    pub half_angle: Ball<R>,
    /// Whether the arc turns left.
    pub left: bool,
}

impl<R: BallReal> SegmentPart<R> {
    /// The part between two lengths along a carrier \[m\], exact numbers.
    pub fn new(carrier: &BallCarrier<R>, [lo, hi]: [DoubleDouble; 2]) -> Self {
        let exact = |mid| Ball::from_twofold(Ball::<DoubleDouble> { mid, err: 0.0 });
        let [from, to]: [Ball<R>; 2] = [exact(lo), exact(hi)];
        let (at, half) = ((from + to).half(), (to - from).half());
        match *carrier {
            BallCarrier::Line { along, .. } => {
                let ends = [carrier.point(from), carrier.point(to)];
                Self { middle: carrier.point(at), half, ends, axis: along, circle: None }
            }
            BallCarrier::Circle { centre, radius, left, .. } => {
                let axis = carrier.axis(at);
                let half_angle = half / radius;
                let [sin, cos] = half_angle.sin_cos();
                let on = |axis: BallVector<R>| centre + axis.times(radius);
                let mut ends = [on(axis.turned([-sin, cos])), on(axis.turned([sin, cos]))];
                if !left {
                    ends.swap(0, 1);
                }
                let circle = Some(ArcCircle { centre, radius, half_angle, left });
                Self { middle: on(axis), half, ends, axis, circle }
            }
        }
    }

    /// Whether the part is certain not to hold the point of its circle in a direction from the centre, and the one opposite.
    fn misses(&self, circle: &ArcCircle<R>, direction: BallVector<R>) -> [Ternary; 2] {
        let angle = Ball::angle(self.axis.dot(direction), self.axis.cross(direction));
        let opposite = Ball::from(std::f64::consts::PI) - angle;
        // The `f64` nearest to π is below it by less than 2^-52.
        let opposite = Ball { err: opposite.err + f64::EPSILON, ..opposite };
        [angle.above(circle.half_angle), opposite.above(circle.half_angle)]
    }

    fn distances_of_ends(&self, point: BallVector<R>) -> [Ball<R>; 2] {
        self.ends.map(|end| (point - end).norm())
    }

    /// The least distance of a point from the part \[m\]. Where it is in doubt whether the foot of the point lies on the part,
    /// so is which of two distances it is.
    pub fn nearest(&self, point: BallVector<R>) -> Ball<R> {
        let (carrier, off) = match &self.circle {
            None => {
                let from_middle = point - self.middle;
                (self.axis.cross(from_middle).abs(), self.axis.dot(from_middle).abs().above(self.half))
            }
            Some(circle) => {
                let from_centre = point - circle.centre;
                let carrier = (from_centre.norm() - circle.radius).abs();
                (carrier, self.misses(circle, from_centre)[0])
            }
        };
        if off == Ternary::No {
            return carrier;
        }
        let [a, b] = self.distances_of_ends(point);
        Ball::either(off, a.min(b), carrier)
    }

    /// Where on the part, as a length from its middle, about, the point nearest to another one lies \[m\]: for messages.
    pub fn foot(&self, point: BallVector<R>) -> f64 {
        let half = self.half.to_f64();
        let foot = match &self.circle {
            None => self.axis.dot(point - self.middle).to_f64(),
            Some(circle) => {
                let from_centre = point - circle.centre;
                let (along, across) = (self.axis.dot(from_centre), self.axis.cross(from_centre));
                let angle = across.to_f64().atan2(along.to_f64());
                circle.radius.to_f64() * if circle.left { angle } else { -angle }
            }
        };
        if foot.abs() <= half {
            return foot;
        }
        let [a, b] = self.distances_of_ends(point);
        if a.to_f64() < b.to_f64() { -half } else { half }
    }

    /// The greatest distance of a point from the part \[m\].
    pub fn farthest(&self, point: BallVector<R>) -> Ball<R> {
        let [a, b] = self.distances_of_ends(point);
        let ends = a.max(b);
        let Some(circle) = &self.circle else { return ends };
        let from_centre = point - circle.centre;
        Ball::either(self.misses(circle, from_centre)[1], ends, from_centre.norm() + circle.radius)
    }

    /// The components of the part from `origin` in a direction of length 1: its extremes are at the ends and, on an arc,
    /// where the direction from the centre is the one asked for or its opposite.
    pub fn components(&self, origin: BallVector<R>, direction: BallVector<R>) -> BallRange<R> {
        let [a, b] = self.ends.map(|end| direction.dot(end - origin));
        let (lo, hi) = (a.min(b), a.max(b));
        let Some(circle) = &self.circle else { return BallRange { lo, hi } };
        let centre = direction.dot(circle.centre - origin);
        let [with, against] = self.misses(circle, direction);
        let (least, most) = (centre - circle.radius, centre + circle.radius);
        BallRange { lo: Ball::either(against, lo, least), hi: Ball::either(with, hi, most) }
    }

    /// How far the direction in which the points of the part are seen from `origin` may be from that of its middle \[rad\],
    /// `at` being the vector to that.
    ///
    /// Of the way from the middle to another point no more than `A = min(h, |t| h + h²/2ϱ)` lies across `at`, with `t` the part
    /// of the direction that is across, and no more than h along it: the angle is at most that of the vector (D - h, A),
    /// and no angle is above its tangent.
    pub fn spread(&self, at: BallVector<R>) -> Ball<R> {
        let any = Ball::from(4.0);
        let distance = at.norm();
        let rest = distance - self.half;
        if !rest.is_positive().is_certain() {
            return any;
        }
        let across = match &self.circle {
            None => self.axis.cross(at).abs() / distance * self.half,
            Some(circle) => {
                let across = self.axis.dot(at).abs() / distance * self.half;
                across + (self.half * self.half / circle.radius).half()
            }
        };
        (across.min(self.half) / rest).min(any)
    }
}
