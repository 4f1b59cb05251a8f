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
        let way = Vector { x: to.x - from.x, y: to.y - from.y };
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
