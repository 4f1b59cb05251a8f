//! The relative motion of two agents between two instants, approximated by a straight uniform motion.
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
pub(crate) struct LinearRelativeMotion<S> {
    /// Length of the chord \[m\].
    pub(crate) length: S,
    /// Projection of the origin onto the line, as a length from the start of the chord; it may lie outside the chord
    /// \[m\].
    foot: S,
    /// Distance of the origin from the line \[m\].
    offset: S,
}

impl<S: Scalar> LinearRelativeMotion<S> {
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
        // No relative position is further away, and the sum below cannot overflow.
        let radius = radius.min(S::LIMIT.double().double());
        if radius < self.offset {
            return None;
        }
        let half = (radius - self.offset).times(radius + self.offset).sqrt();
        let (lo, hi) = (self.foot - half, self.foot + half);
        (lo <= self.length && hi >= S::ZERO).then(|| Interval::new(lo.max(S::ZERO), hi.min(self.length)))
    }

    /// Whether a relative position that is in a circle at the begin of the chord stays in it until the chord enters a
    /// circle that is smaller by `error`. With ξ and y as in [`clears`], (ϱ - y)² - |chord|² is not negative at either
    /// place. It is concave if L² >= 8 ϱ e + 16 e², because the second derivative of y² is 32 e² at most.
    pub(crate) fn dives(&self, radius: S, error: S) -> bool {
        let square = |length: S| length.times(length);
        square(self.foot) + square(self.offset) <= square(radius)
            && square(self.length) >= error.times(radius + error.double()).double().double().double()
    }

    /// The place of the chord that is nearest to the origin, and its distance from it \[m\].
    pub(crate) fn nearest(&self) -> (S, S) {
        let at = self.foot.clamp(S::ZERO, self.length);
        let beyond = self.foot - at;
        (at, (self.offset.times(self.offset) + beyond.times(beyond)).sqrt())
    }
}

fn between<S: Scalar>(from: Vector<S>, to: Vector<S>) -> Vector<S> {
    Vector { x: to.x - from.x, y: to.y - from.y }
}

/// Whether the relative position stays outside a circle between two places outside, if it deviates from the chord by at
/// most `error` in its middle. Computed distances are right within `pad`.
///
/// Let ξ be the fraction of the chord, p₀ and p₁ the squared lengths of the tangents from its ends, L its length and y
/// = 4 e ξ (1 - ξ) the deviation. Then |chord|² - ϱ² = p₀ (1 - ξ) + p₁ ξ - L² ξ (1 - ξ) has to be at least 2 ϱ y + y²,
/// where y² <= y e. Divided by ξ (1 - ξ), the left side is least at (√p₀ + √p₁)² - L².
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

/// Whether the relative position stays in a circle between two places inside; the counterpart of [`clears`]. 2 ϱ y has
/// to be at most ϱ² - |chord|² = d₀ (1 - ξ) + d₁ ξ + L² ξ (1 - ξ), which is at least d₀ + d₁ + L² times ξ (1 - ξ).
pub(crate) fn keeps<S: Scalar>([from, to]: [Vector<S>; 2], radius: S, error: S) -> bool {
    let square = radius.times(radius);
    let [near, far] = [from, to].map(|end| end.norm_squared());
    near <= square && far <= square && error <= radius && {
        let depths = (square - near) + (square - far);
        depths + between(from, to).norm_squared() >= error.times(radius).double().double().double()
    }
}

#[cfg(all(test, feature = "libm"))]
mod tests {
    use super::*;
    use crate::pair::outline::distance::tests::Random;

    const PARTS: u32 = 200;

    /// 8 ϱ e + 16 e² is 9/16 for a sixteenth of the radius.
    #[test]
    fn chords_dive_from_the_length_at_which_they_are_proved_to() {
        let dives = |length: f64| LinearRelativeMotion { length, foot: 0.5, offset: 0.25 }.dives(1.0, 1.0 / 16.0);
        assert!(dives(0.75) && !dives(0.75_f64.next_down()));
    }

    /// Relative motions that deviate sideways from their chord by `error` in the middle: their ends, the error, and the
    /// distance from the origin as a function of the fraction of the way.
    fn motions() -> impl Iterator<Item = ([Vector<f64>; 2], f64, impl Fn(f64) -> f64)> {
        let mut numbers = Random(7);
        let mut random = move || numbers.unit();
        (0..20_000).map(move |_| {
            let mut vector = |scale: f64| {
                let (sin, cos) = libm::sincos(core::f64::consts::TAU * random());
                let length = scale * random();
                Vector { x: length * cos, y: length * sin }
            };
            let (from, to, side) = (vector(2.0), vector(2.0), vector(0.4));
            let at = move |part: f64| {
                let bend = 4.0 * part * (1.0 - part);
                let [x, y] =
                    [(from.x, to.x, side.x), (from.y, to.y, side.y)].map(|(a, b, c)| a + part * (b - a) + bend * c);
                (x * x + y * y).sqrt()
            };
            ([from, to], side.norm_squared().sqrt(), at)
        })
    }

    /// Largest and least distance up to a fraction of the way.
    fn distances(at: impl Fn(f64) -> f64, until: f64) -> (f64, f64) {
        let distances = (0..=PARTS).map(|k| at(until * f64::from(k) / f64::from(PARTS)));
        distances.fold((0.0_f64, f64::MAX), |(most, least), distance| (most.max(distance), least.min(distance)))
    }

    #[test]
    fn what_keeps_stays_inside_and_what_clears_outside() {
        let (mut kept, mut deep, mut cleared) = (0, 0, 0);
        for (ends, error, at) in motions() {
            let (most, least) = distances(&at, 1.0);
            if keeps(ends, 1.0, error) {
                assert!(most <= 1.0 + 1e-15, "{ends:?} {error}");
                kept += 1;
                // Cases in which the depth of the ends alone decides.
                deep += u32::from(between(ends[0], ends[1]).norm_squared() < 8.0 * error);
            }
            if clears(ends, 1.0, error, 1e-12) {
                assert!(least >= 1.0 - 1e-15, "{ends:?} {error}");
                cleared += 1;
            }
        }
        assert!(kept > 2000 && deep > 200 && cleared > 1000, "{kept} {deep} {cleared}");
    }

    #[test]
    fn what_dives_stays_inside_until_it_is_deep() {
        let mut dived = 0;
        for (ends, error, at) in motions() {
            let chord = LinearRelativeMotion::between(ends[0], ends[1]);
            if let Some(deep) = chord.within(1.0 - error)
                && deep.lo > 0.0
                && chord.dives(1.0, error)
            {
                assert!(distances(&at, deep.hi / chord.length).0 <= 1.0 + 1e-15, "{ends:?} {error}");
                dived += 1;
            }
        }
        assert!(dived > 200, "{dived}");
    }
}
