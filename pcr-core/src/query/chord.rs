//! The relative motion of two agents between two instants, as if it were straight and uniform.
//!
//! ```text
//!   from ------- foot ------- to        x from 0 to length
//!                 |  offset
//!               contact is within a radius of here
//! ```

use crate::geometry::{Direction, Interval, Vector};
use crate::scalar::{Scalar, Wide};

/// The line from one relative position to another, seen from the origin.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Chord<S> {
    /// \[m\]
    pub(crate) length: S,
    /// Where on the chord the origin projects to, from its start; anywhere \[m\].
    foot: S,
    /// Distance of the origin from the line \[m\].
    offset: S,
}

impl<S: Scalar> Chord<S> {
    /// Cost: a square root and a division.
    pub(crate) fn between(from: Vector<S>, to: Vector<S>) -> Self {
        let way = between(from, to);
        let length = way.norm_squared().sqrt();
        if length <= S::ZERO {
            return Self { length: S::ZERO, foot: S::ZERO, offset: from.norm_squared().sqrt() };
        }
        let [cos, sin] = S::unit_vector(way.x, way.y, length);
        let direction = Direction { cos, sin };
        Self { length, foot: -from.along(direction), offset: from.across(direction).abs() }
    }

    /// The part of the chord within `radius` of the origin.
    pub(crate) fn within(&self, radius: S) -> Option<Interval<S>> {
        if radius < self.offset {
            return None;
        }
        let half = (radius - self.offset).times(radius + self.offset).sqrt();
        let (lo, hi) = (self.foot - half, self.foot + half);
        (lo <= self.length && hi >= S::ZERO).then(|| Interval::new(lo.max(S::ZERO), hi.min(self.length)))
    }

    /// Where the chord is nearest to the origin, and how near \[m\].
    pub(crate) fn nearest(&self) -> (S, S) {
        let at = self.foot.clamp(S::ZERO, self.length);
        let beyond = self.foot - at;
        (at, (self.offset.times(self.offset) + beyond.times(beyond)).sqrt())
    }
}

fn between<S: Scalar>(from: Vector<S>, to: Vector<S>) -> Vector<S> {
    Vector { x: to.x - from.x, y: to.y - from.y }
}

/// Whether the relative position stays out of a circle between two places outside, if it deviates from the chord by no
/// more than `error` in its middle; what is computed is right within `pad`.
///
/// With the part ξ of the chord, p₀ and p₁ the squares of the tangents from its ends, L its length and y = 4 e ξ (1 - ξ)
/// the deviation, |chord|² - ϱ² = p₀ (1 - ξ) + p₁ ξ - L² ξ (1 - ξ) is to be at least 2 ϱ y + y², for which y² <= y e. Divided by
/// ξ (1 - ξ), the left side is least at (√p₀ + √p₁)² - L².
pub(crate) fn clears<S: Scalar>([from, to]: [Vector<S>; 2], radius: S, error: S, pad: S) -> bool {
    let square = radius.times(radius);
    let tangents = [from, to].map(|end| (end.norm_squared() - square).sqrt());
    let sum = tangents[0] + tangents[1] - pad;
    let part = sum.half().half();
    tangents[0].min(tangents[1]) > S::ZERO && error <= part && {
        let bulge = error.double().double().times(radius.double() + error);
        sum.times(sum) >= between(from, to).norm_squared() + bulge
    }
}

/// Whether the relative position stays in a circle between two places inside, as [`clears`] tells of one that stays
/// outside: 2 ϱ y is to be no more than ϱ² - |chord|², which is L² ξ (1 - ξ) at least.
pub(crate) fn keeps<S: Scalar>([from, to]: [Vector<S>; 2], radius: S, error: S) -> bool {
    let square = radius.times(radius);
    let inside = |end: Vector<S>| end.norm_squared() <= square;
    inside(from) && inside(to) && error <= radius && {
        let length = between(from, to).norm_squared();
        length >= error.times(radius).double().double().double()
    }
}
