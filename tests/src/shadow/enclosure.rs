//! Numbers of 106 bits with a bound on how far they are off: what a number of any format would be without rounding.

use pcr_certify::ball::Ball;
use pcr_certify::double_double::DoubleDouble;
use std::f64::consts::{PI, TAU};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// Holds a number that is not known exactly.
#[derive(Clone, Copy, Debug)]
pub struct Enclosure(Ball<DoubleDouble>);

impl Enclosure {
    /// Any number.
    pub const ALL: Self = Self(Ball { mid: DoubleDouble::ZERO, err: f64::INFINITY });
    /// 2π, which `DoubleDouble` has within 2^-106.
    pub const TURN: Self = Self(Ball { mid: DoubleDouble::TURN, err: 1e-30 });

    /// A number as it is.
    pub const fn at(value: f64) -> Self {
        Self(Ball { mid: DoubleDouble::new(value), err: 0.0 })
    }

    /// What is no number, as a product of nothing and anything, may be any.
    fn of(ball: Ball<DoubleDouble>) -> Self {
        if ball.err.is_finite() && ball.mid.to_f64().is_finite() { Self(ball) } else { Self::ALL }
    }

    /// The `f64` nearest to its middle.
    pub fn to_f64(self) -> f64 {
        self.0.to_f64()
    }

    /// Distance of a number from the farthest one in it.
    pub fn farthest(self, from: f64) -> f64 {
        let Ball { mid, err } = (self - Self::at(from)).0;
        (mid.abs().to_f64() + err) * (1.0 + 4.0 * f64::EPSILON)
    }

    /// Magnitude.
    pub fn abs(self) -> Self {
        Self::of(self.0.abs())
    }

    /// Square root, 0 for what is negative.
    pub fn sqrt(self) -> Self {
        Self::of(self.0.sqrt())
    }

    /// Sine and cosine of an angle up to 16 rad; of others any.
    pub fn sin_cos(self) -> (Self, Self) {
        let [sin, cos] = self.0.sin_cos();
        (Self::of(sin), Self::of(cos))
    }

    /// Angle of the vector `(x, self)` on the turn that is nearest to `near` \[rad\].
    pub fn atan2(self, x: Self, near: f64) -> Self {
        let upper = Ball::angle(x.0, self.0);
        if upper.err >= 1.0 || upper.err.is_nan() {
            return Self(Ball { mid: DoubleDouble::new(near), err: 1.001 * PI });
        }
        let angle = Self(if self.to_f64() < 0.0 { -upper } else { upper });
        angle + Self::TURN * Self::at(((near - angle.to_f64()) / TAU).round())
    }
}

impl Add for Enclosure {
    type Output = Self;
    fn add(self, rhs: Self) -> Self {
        Self::of(self.0 + rhs.0)
    }
}

impl Neg for Enclosure {
    type Output = Self;
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl Sub for Enclosure {
    type Output = Self;
    fn sub(self, rhs: Self) -> Self {
        self + -rhs
    }
}

impl Mul for Enclosure {
    type Output = Self;
    fn mul(self, rhs: Self) -> Self {
        Self::of(self.0 * rhs.0)
    }
}

impl Div for Enclosure {
    type Output = Self;
    fn div(self, rhs: Self) -> Self {
        Self::of(self.0 / rhs.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generators::Dice;

    fn holds(held: Enclosure, exact: DoubleDouble, by: f64) -> bool {
        let off = (held.0.mid - exact).abs().to_f64();
        off <= held.0.err + by && held.0.err < 1e-24
    }

    #[test]
    fn angles_are_those_of_their_sines_and_cosines_on_any_turn() {
        for seed in 0..5_000 {
            let mut dice = Dice::seeded(seed);
            let angle = Enclosure::at(dice.range(-9.0, 9.0));
            let size = Enclosure::at(dice.magnitude(1e-6, 1e6));
            let (sin, cos) = angle.sin_cos();
            let found = (size * sin).atan2(size * cos, angle.to_f64() + dice.range(-3.0, 3.0));
            assert!(holds(found, angle.0.mid, 1e-28), "{seed}: {found:?} for {angle:?}");
        }
    }

    #[test]
    fn what_is_not_known_stays_unknown() {
        let (zero, one) = (Enclosure::at(0.0), Enclosure::at(1.0));
        let unknown = Enclosure::ALL;
        for number in [one + unknown, zero * unknown, one / zero, one / unknown, unknown.sqrt(), unknown.sin_cos().0] {
            assert_eq!(number.farthest(1.0), f64::INFINITY, "{number:?}");
        }
        // A vector that may be nothing has any angle.
        assert!(zero.atan2(zero, 1.0).farthest(1.0) >= PI && unknown.atan2(one, -1.0).farthest(-1.0) >= PI);
        assert_eq!((one - Enclosure::at(2.0)).sqrt().farthest(0.0), 0.0);
    }

    #[test]
    fn errors_are_carried_along() {
        // A third is off by 2^-102 of itself at most, and three of them by thrice that.
        let third = Enclosure::at(1.0) / Enclosure::at(3.0);
        assert!(third.0.err > 0.0 && holds(third * Enclosure::at(3.0), DoubleDouble::new(1.0), 0.0));
        assert!(third.farthest(1.0 / 3.0) > 1e-17, "{third:?}");
    }
}
