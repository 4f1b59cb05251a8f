//! Intervals of `f64`, rounded outward.

use std::f64::consts::{PI, TAU};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// What the functions of the standard library may be off, and the rounding of a sum with that: a part of 1.
const LIBRARY: f64 = 8.0 * f64::EPSILON;

/// Holds a number that is not known exactly.
#[derive(Clone, Copy, Debug)]
pub struct Enclosure {
    lo: f64,
    hi: f64,
}

impl Enclosure {
    /// Any number.
    pub const ALL: Self = Self { lo: f64::NEG_INFINITY, hi: f64::INFINITY };
    /// 2π.
    pub const TURN: Self = Self { lo: TAU, hi: TAU.next_up() };

    /// A number as it is.
    pub const fn at(value: f64) -> Self {
        Self { lo: value, hi: value }
    }

    fn around(middle: f64, by: f64) -> Self {
        if by.is_finite() { Self { lo: (middle - by).next_down(), hi: (middle + by).next_up() } } else { Self::ALL }
    }

    /// Distance of a number from the farthest one in it.
    pub fn farthest(self, from: f64) -> f64 {
        (from - self.lo).abs().max((self.hi - from).abs()).next_up()
    }

    fn middle(self) -> [f64; 2] {
        let middle = 0.5 * (self.lo + self.hi);
        [middle, self.farthest(middle)]
    }

    /// Square root, 0 for what is negative.
    pub fn sqrt(self) -> Self {
        let root = |x: f64| x.max(0.0).sqrt();
        Self { lo: root(self.lo).next_down().max(0.0), hi: root(self.hi).next_up() }
    }

    /// Sine and cosine: they change no faster than the angle.
    pub fn sin_cos(self) -> (Self, Self) {
        let [middle, by] = self.middle();
        let (sin, cos) = middle.sin_cos();
        (Self::around(sin, by + LIBRARY), Self::around(cos, by + LIBRARY))
    }

    /// Angle of the vector `(x, self)` on the turn that is nearest to `near` \[rad\].
    pub fn atan2(self, x: Self, near: f64) -> Self {
        let ([y, dy], [x, dx]) = (self.middle(), x.middle());
        // The angle changes by asin(moved / distance), π/2 times that at most.
        let part = (dy.hypot(dx) / y.hypot(x)).next_up();
        if part.is_nan() || part >= 1.0 {
            return Self::around(near, PI);
        }
        let angle = y.atan2(x);
        let angle = angle + TAU * ((near - angle) / TAU).round();
        Self::around(angle, 0.5 * PI * part + LIBRARY * (1.0 + angle.abs()))
    }
}

impl Add for Enclosure {
    type Output = Self;
    fn add(self, rhs: Self) -> Self {
        Self { lo: (self.lo + rhs.lo).next_down(), hi: (self.hi + rhs.hi).next_up() }
    }
}

impl Neg for Enclosure {
    type Output = Self;
    fn neg(self) -> Self {
        Self { lo: -self.hi, hi: -self.lo }
    }
}

impl Sub for Enclosure {
    type Output = Self;
    fn sub(self, rhs: Self) -> Self {
        self + -rhs
    }
}

fn hull(corners: [f64; 4]) -> Enclosure {
    if corners.iter().any(|corner| corner.is_nan()) {
        return Enclosure::ALL;
    }
    let lo = corners.into_iter().fold(f64::INFINITY, f64::min);
    let hi = corners.into_iter().fold(f64::NEG_INFINITY, f64::max);
    Enclosure { lo: lo.next_down(), hi: hi.next_up() }
}

impl Mul for Enclosure {
    type Output = Self;
    fn mul(self, rhs: Self) -> Self {
        hull([self.lo * rhs.lo, self.lo * rhs.hi, self.hi * rhs.lo, self.hi * rhs.hi])
    }
}

impl Div for Enclosure {
    type Output = Self;
    fn div(self, rhs: Self) -> Self {
        if rhs.lo <= 0.0 && 0.0 <= rhs.hi {
            return Self::ALL;
        }
        hull([self.lo / rhs.lo, self.lo / rhs.hi, self.hi / rhs.lo, self.hi / rhs.hi])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::Twofold;
    use crate::generators::Dice;

    #[test]
    fn what_106_bits_say_lies_within() {
        for seed in 0..2_000 {
            let mut dice = Dice::seeded(seed);
            let [a, b] = [0, 1].map(|_| dice.sign() * dice.magnitude(1e-6, 1e3));
            let ([x, y], [p, q]) = ([a, b].map(Enclosure::at), [a, b].map(Twofold::from));
            let (sin, cos) = p.sin_cos();
            let roots = (Enclosure::at(a.abs()).sqrt(), Twofold::from(a.abs()).sqrt());
            let angles = x.sin_cos();
            for (held, exact) in [
                (x + y, p + q),
                (x - y, p - q),
                (x * y, p * q),
                (x / y, p / q),
                roots,
                (angles.0, sin),
                (angles.1, cos),
            ] {
                assert!(
                    Twofold::from(held.lo) <= exact && exact <= Twofold::from(held.hi),
                    "{seed}: {held:?} {exact:?}"
                );
                assert!(held.hi - held.lo <= 20.0 * f64::EPSILON * exact.to_f64().abs().max(1.0), "{seed}: {held:?}");
            }
        }
    }
}
