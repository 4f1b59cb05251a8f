//! Points, directions, poses, intervals and boxes in the plane.
//!
//! One sign convention for the whole library: `x` along the direction of travel, `y` to its left, angles and
//! turns counter-clockwise positive.

use crate::scalar::{Angle, Scalar, Unit};
use core::ops::{Add, Sub};

/// A point in the plane \[m\].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Point<S> {
    /// x-coordinate \[m\].
    pub x: S,
    /// y-coordinate \[m\].
    pub y: S,
}

impl<S> Point<S> {
    /// The point `(x, y)`.
    pub const fn new(x: S, y: S) -> Self {
        Self { x, y }
    }
}

impl<S: Scalar> Sub for Point<S> {
    type Output = Vector<S>;
    fn sub(self, from: Self) -> Vector<S> {
        Vector { x: self.x - from.x, y: self.y - from.y }
    }
}

impl<S: Scalar> Add<Vector<S>> for Point<S> {
    type Output = Self;
    fn add(self, by: Vector<S>) -> Self {
        Self { x: self.x + by.x, y: self.y + by.y }
    }
}

/// Difference of two points \[m\].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Vector<S> {
    /// Component along the x-axis \[m\].
    pub x: S,
    /// Component along the y-axis \[m\].
    pub y: S,
}

impl<S: Scalar> Vector<S> {
    /// Component along a direction \[m\].
    pub fn along(self, direction: Direction<S>) -> S {
        S::combine(self.x, direction.cos, self.y, direction.sin)
    }

    /// Component across a direction, left positive \[m\].
    pub fn across(self, direction: Direction<S>) -> S {
        S::combine(self.y, direction.cos, self.x, -direction.sin)
    }

    /// Square of the Euclidean norm \[m²\].
    pub fn norm_squared(self) -> S::Wide {
        self.x.times(self.x) + self.y.times(self.y)
    }
}

/// Unit vector.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(
    feature = "serde",
    serde(bound(serialize = "S::Unit: serde::Serialize", deserialize = "S::Unit: serde::Deserialize<'de>"))
)]
pub struct Direction<S: Scalar> {
    /// Cosine of the angle from the x-axis.
    pub cos: S::Unit,
    /// Sine of the angle from the x-axis.
    pub sin: S::Unit,
}

impl<S: Scalar> Direction<S> {
    /// The x-axis.
    pub const X: Self = Self { cos: S::Unit::ONE, sin: S::Unit::ZERO };

    /// The direction at an angle from the x-axis.
    pub fn at(angle: S::Angle) -> Self {
        let (sin, cos) = angle.sin_cos();
        Self { cos, sin }
    }

    /// The direction at the sum of both angles.
    pub(crate) fn plus(self, by: Self) -> Self {
        let cos = S::Unit::combine(self.cos, by.cos, -self.sin, by.sin);
        Self { cos, sin: S::Unit::combine(self.sin, by.cos, self.cos, by.sin) }
    }

    /// The direction of the opposite angle.
    pub(crate) fn mirrored(self) -> Self {
        Self { cos: self.cos, sin: -self.sin }
    }

    /// The direction after a turn by an angle whose square is negligible.
    pub(crate) fn turned_by(self, angle: S::Angle) -> Self {
        let (sin, _) = angle.sin_cos();
        Self { cos: self.cos - self.sin.times(sin), sin: self.sin + self.cos.times(sin) }
    }

    /// Cosine of the angle to another direction.
    pub fn dot(self, other: Self) -> S::Unit {
        Unit::combine(self.cos, other.cos, self.sin, other.sin)
    }

    /// Sine of the angle to another direction, positive if it lies to the left.
    pub fn cross(self, other: Self) -> S::Unit {
        Unit::combine(self.cos, other.sin, -self.sin, other.cos)
    }

    /// The vector with these components along and across the direction.
    pub fn vector(self, along: S, across: S) -> Vector<S> {
        Vector { x: S::combine(along, self.cos, across, -self.sin), y: S::combine(along, self.sin, across, self.cos) }
    }
}

/// The direction of the angle of the first minus that of the second.
pub(crate) fn turned_back<S: Scalar>(direction: Direction<S>, by: Direction<S>) -> Direction<S> {
    Direction { cos: by.dot(direction), sin: by.cross(direction) }
}

/// Position and heading.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "S: serde::Serialize, S::Angle: serde::Serialize",
        deserialize = "S: serde::Deserialize<'de>, S::Angle: serde::Deserialize<'de>"
    ))
)]
pub struct Pose<S: Scalar> {
    /// Position \[m\].
    pub position: Point<S>,
    /// Angle of the direction of travel from the x-axis.
    pub heading: S::Angle,
}

/// A closed interval, `lo <= hi`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Interval<S> {
    /// Lower end.
    pub lo: S,
    /// Upper end.
    pub hi: S,
}

impl<S: Scalar> Interval<S> {
    /// The interval from `lo` to `hi`.
    pub const fn new(lo: S, hi: S) -> Self {
        Self { lo, hi }
    }

    /// Whether `x` lies in the interval, ends included.
    pub fn contains(self, x: S) -> bool {
        self.lo <= x && x <= self.hi
    }

    /// Whether two intervals have a point in common.
    pub fn meets(self, other: Self) -> bool {
        // `&` instead of `&&`: most box tests end here, and one branch is predicted better than two.
        (self.lo <= other.hi) & (other.lo <= self.hi)
    }

    /// The smallest interval that contains both.
    pub fn hull(self, other: Self) -> Self {
        Self { lo: self.lo.min(other.lo), hi: self.hi.max(other.hi) }
    }

    /// `hi - lo`.
    pub fn length(self) -> S {
        self.hi - self.lo
    }

    /// The midpoint.
    pub fn middle(self) -> S {
        self.lo + (self.hi - self.lo).half()
    }

    /// Differences of times in this interval are not told apart below this \[s\]: the [`Scalar::tolerance`] of its length, which is
    /// that of the motions in it, however late they are; but not less than what rounding moves times as late as that.
    pub(crate) fn resolution(self) -> S {
        let latest = self.lo.abs().max(self.hi.abs());
        S::tolerance(self.length()).max(S::rounding(latest).double().double())
    }

    /// Both ends clamped to the range that constructors accept, in which all motions are; an end that is NaN becomes
    /// unlimited.
    pub(crate) fn limited(self) -> Self {
        let end = |end: S, beyond: S| if -S::LIMIT <= end && end <= S::LIMIT { end } else { beyond };
        let (lo, hi) = (
            if self.lo > S::LIMIT { S::LIMIT } else { -S::LIMIT },
            if self.hi < -S::LIMIT { -S::LIMIT } else { S::LIMIT },
        );
        let (lo, hi) = (end(self.lo, lo), end(self.hi, hi));
        Self { lo: lo.min(hi), hi: hi.max(lo) }
    }

    /// The intersection with an interval that meets this one.
    pub(crate) fn common(self, other: Self) -> Self {
        Self { lo: self.lo.max(other.lo), hi: self.hi.min(other.hi) }
    }

    /// Moves both ends apart by `by`, but not out of `[lo, hi]` of `within`.
    #[cfg_attr(not(feature = "std"), inline(never))]
    pub(crate) fn widen(self, by: S, within: Self) -> Self {
        Self { lo: (self.lo - by).clamp(within.lo, within.hi), hi: (self.hi + by).clamp(within.lo, within.hi) }
    }
}

/// Axis-parallel box \[m\].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Aabb<S> {
    /// Range of x-coordinates.
    pub x: Interval<S>,
    /// Range of y-coordinates.
    pub y: Interval<S>,
}

impl<S: Scalar> Aabb<S> {
    /// The smallest box around two points.
    pub fn around(a: Point<S>, b: Point<S>) -> Self {
        Self { x: Interval::new(a.x.min(b.x), a.x.max(b.x)), y: Interval::new(a.y.min(b.y), a.y.max(b.y)) }
    }

    /// The smallest box that contains both.
    pub fn hull(self, other: Self) -> Self {
        Self { x: self.x.hull(other.x), y: self.y.hull(other.y) }
    }

    /// The box with all sides moved outward by `by`.
    pub fn expanded(self, by: S) -> Self {
        Self { x: Interval::new(self.x.lo - by, self.x.hi + by), y: Interval::new(self.y.lo - by, self.y.hi + by) }
    }

    /// Whether two boxes have a point in common.
    pub fn meets(self, other: Self) -> bool {
        self.x.meets(other.x) & self.y.meets(other.y)
    }

    /// Largest magnitude of a coordinate \[m\].
    pub fn extent(self) -> S {
        self.x.lo.abs().max(self.x.hi.abs()).max(self.y.lo.abs()).max(self.y.hi.abs())
    }
}
