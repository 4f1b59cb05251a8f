//! Numbers with a bound on their error.
//!
//! A [`Ball`] stands for a number that is not known but lies within `err` of `mid`. Every operation bounds what it
//! rounds by, once, here; nothing above this file knows about rounding, and a comparison is answered only if it holds
//! for all numbers that the balls stand for ([`Ternary`]).
//!
//! The same code runs in `f64`, which settles most, and in [`DoubleDouble`] for what is too close for it. The bounds:
//!
//! | | sum, product, quotient, root (relative) | sine, cosine (absolute) |
//! |---|---|---|
//! | `f64` | 2^-53: IEEE 754 rounds to nearest | 2^-50, `sin_cos` |
//! | `DoubleDouble` | 2^-102, `twofold.rs` | 2^-99, `twofold.rs` |
//!
//! The radius itself is computed in `f64`. All its terms are non-negative and there are fewer than ten, so that it is
//! too small by a factor of 1 - 16 * 2^-53 at most; `UP` makes up for that, and for taking the leading part of a `DoubleDouble`
//! as its magnitude. `TINY` is more than what underflow can take from a product or quotient, its error term included. Where the result is
//! divided by a number that may be as small, `LOST` is added before: it is more than underflow takes from any product (2^-1070,
//! `twofold.rs`), that of the radius, too.

use crate::double_double::DoubleDouble;
use std::f64::consts::{FRAC_PI_2, PI};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// More than what the rounding of a radius takes.
const UP: f64 = 1.0 + 32.0 * f64::EPSILON;

/// 2^-900.
const TINY: f64 = 1.183e-271;

/// 2^-1000.
const LOST: f64 = 9.333e-302;

/// What a ball has in its middle.
pub trait BallReal:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self>
{
    /// Bound on the relative error of a sum, product, quotient or root.
    const ROUND: f64;
    /// Bound on the absolute error of a sine or cosine of an angle up to 16 rad.
    const TRIG: f64;
    /// The exact value of an `f64`.
    fn from_f64(value: f64) -> Self;
    /// The nearest number of the type, and what it is off at most.
    fn from_twofold(value: DoubleDouble) -> (Self, f64);
    /// The nearest `f64`.
    fn to_f64(self) -> f64;
    /// Square root; 0 of what is not positive.
    fn sqrt(self) -> Self;
    /// Sine and cosine.
    fn sin_cos(self) -> (Self, Self);
}

impl BallReal for f64 {
    const ROUND: f64 = 0.5 * f64::EPSILON;
    const TRIG: f64 = 4.0 * f64::EPSILON;
    fn from_f64(value: f64) -> Self {
        value
    }
    fn from_twofold(value: DoubleDouble) -> (Self, f64) {
        let [hi, lo] = value.parts();
        (hi, lo.abs())
    }
    fn to_f64(self) -> f64 {
        self
    }
    fn sqrt(self) -> Self {
        f64::sqrt(self.max(0.0))
    }
    fn sin_cos(self) -> (Self, Self) {
        sin_cos(self)
    }
}

impl BallReal for DoubleDouble {
    const ROUND: f64 = 1.972_152_263_052_529_5e-31;
    const TRIG: f64 = 8.0 * Self::ROUND;
    fn from_f64(value: f64) -> Self {
        Self::from(value)
    }
    fn from_twofold(value: DoubleDouble) -> (Self, f64) {
        (value, 0.0)
    }
    fn to_f64(self) -> f64 {
        Self::to_f64(self)
    }
    fn sqrt(self) -> Self {
        Self::sqrt(self)
    }
    fn sin_cos(self) -> (Self, Self) {
        Self::sin_cos(self)
    }
}

/// Sine and cosine in `f64`, right within 2^-50 up to 16 rad, from sums and products alone: how right those of a platform
/// are nobody promises.
///
/// The angle less `q` quarter turns: `q` times the head of π/2, of 33 bits, is exact; the difference, the product with the
/// tail and the second difference are rounded by 0.8u, 2^-30 u and 0.8u. In the two series a coefficient, a product and
/// a difference are rounded in each step, by 1.7u together of a term of 0.31 at most, and the steps before count with a
/// share of 0.31 or less: 2.5u; the product with the angle another u. The first terms left out are below 2^-58.
/// Together 5.1u, and 8u are allowed (u = 2^-53).
fn sin_cos(angle: f64) -> (f64, f64) {
    const HEAD: f64 = 1.570_796_326_734_125_6;
    const TAIL: f64 = 6.077_100_506_506_192e-11;
    let quarters = (angle / FRAC_PI_2).round();
    let x = (angle - quarters * HEAD) - quarters * TAIL;
    let square = x * x;
    let (mut sin, mut cos) = (1.0, 1.0);
    for k in (1..=9_u32).rev() {
        let k = f64::from(2 * k);
        sin = 1.0 - sin * (square / (k * (k + 1.0)));
        cos = 1.0 - cos * (square / (k * (k - 1.0)));
    }
    let sin = sin * x;
    match quarters.rem_euclid(4.0) as u8 {
        0 => (sin, cos),
        1 => (cos, -sin),
        2 => (-sin, -cos),
        _ => (-cos, sin),
    }
}

/// The answer to a question about numbers that are not known exactly.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ternary {
    /// It is so for all that the balls stand for.
    Yes,
    /// It is not so for any.
    No,
    /// Not decided.
    Doubt,
}

impl Ternary {
    /// Both.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        match (self, other) {
            (Self::No, _) | (_, Self::No) => Self::No,
            (Self::Yes, Self::Yes) => Self::Yes,
            _ => Self::Doubt,
        }
    }

    /// Either.
    #[must_use]
    pub fn or(self, other: Self) -> Self {
        match (self, other) {
            (Self::Yes, _) | (_, Self::Yes) => Self::Yes,
            (Self::No, Self::No) => Self::No,
            _ => Self::Doubt,
        }
    }

    /// Whether it is certain.
    pub fn is_certain(self) -> bool {
        self == Self::Yes
    }
}

/// A number within `err` of `mid`.
#[derive(Clone, Copy, Debug)]
pub struct Ball<R> {
    /// The middle.
    pub mid: R,
    /// The radius.
    pub err: f64,
}

/// A number of 106 bits and a bound on its error.
pub(crate) type Real106 = Ball<DoubleDouble>;

impl<R: BallReal> From<f64> for Ball<R> {
    fn from(value: f64) -> Self {
        Self { mid: R::from_f64(value), err: 0.0 }
    }
}

impl<R: BallReal> Neg for Ball<R> {
    type Output = Self;
    fn neg(self) -> Self {
        Self { mid: -self.mid, err: self.err }
    }
}

impl<R: BallReal> Add for Ball<R> {
    type Output = Self;
    fn add(self, rhs: Self) -> Self {
        let mid = self.mid + rhs.mid;
        Self { mid, err: (self.err + rhs.err + mid.to_f64().abs() * R::ROUND) * UP }
    }
}

impl<R: BallReal> Sub for Ball<R> {
    type Output = Self;
    fn sub(self, rhs: Self) -> Self {
        self + -rhs
    }
}

impl<R: BallReal> Mul for Ball<R> {
    type Output = Self;
    fn mul(self, rhs: Self) -> Self {
        let mid = self.mid * rhs.mid;
        let (a, b) = (self.mid.to_f64().abs(), rhs.mid.to_f64().abs());
        let carried = a * rhs.err + b * self.err + self.err * rhs.err;
        Self { mid, err: (carried + mid.to_f64().abs() * R::ROUND) * UP + TINY }
    }
}

impl<R: BallReal> Div for Ball<R> {
    type Output = Self;
    /// `|a'/b' - a/b| <= (|a' - a| + |a/b| |b' - b|) / |b'|`.
    fn div(self, rhs: Self) -> Self {
        let divisor = rhs.mid.to_f64().abs();
        if divisor <= 2.0 * rhs.err || divisor == 0.0 {
            return Self::unknown();
        }
        let mid = self.mid / rhs.mid;
        let size = mid.to_f64().abs();
        let carried = (self.err + size * rhs.err + LOST) / (divisor - rhs.err);
        Self { mid, err: (carried + size * R::ROUND) * UP * UP + TINY }
    }
}

impl<R: BallReal> Ball<R> {
    /// Any number.
    fn unknown() -> Self {
        Self { mid: R::from_f64(0.0), err: f64::INFINITY }
    }

    /// A number of 106 bits and what it may be off.
    pub fn from_twofold(ball: Ball<DoubleDouble>) -> Self {
        let (mid, off) = R::from_twofold(ball.mid);
        Self { mid, err: (ball.err + off) * UP }
    }

    /// Half of it.
    #[must_use]
    pub fn half(self) -> Self {
        self * Self::from(0.5)
    }

    /// Its magnitude.
    #[must_use]
    pub fn abs(self) -> Self {
        // By its sign: a zero may be negative, and the angle to a negative zero is the other one.
        if self.mid.to_f64().is_sign_negative() { -self } else { self }
    }

    /// The lesser one of two: it moves by no more than either does.
    #[must_use]
    pub fn min(self, other: Self) -> Self {
        let lesser = if (self.mid - other.mid).to_f64() <= 0.0 { self.mid } else { other.mid };
        // What is no number must stay none.
        let wider = if self.err.is_nan() || self.err > other.err { self.err } else { other.err };
        Self { mid: lesser, err: wider }
    }

    /// The greater one of two.
    #[must_use]
    pub fn max(self, other: Self) -> Self {
        -(-self).min(-other)
    }

    /// A number that is one of two, or between them.
    #[must_use]
    pub fn between(self, other: Self) -> Self {
        let (middle, apart) = ((self + other).half(), (self - other).half());
        Self { mid: middle.mid, err: (middle.err + apart.mid.to_f64().abs() + apart.err) * UP }
    }

    /// The first number if it is certain that the answer is yes, the second one if it is certain that it is no.
    #[must_use]
    pub fn either(answer: Ternary, yes: Self, no: Self) -> Self {
        match answer {
            Ternary::Yes => yes,
            Ternary::No => no,
            Ternary::Doubt => yes.between(no),
        }
    }

    /// Square root of a number that is not negative: `|√a' - √a| = |a' - a| / (√a' + √a)`.
    #[must_use]
    pub fn sqrt(self) -> Self {
        let most = (self.mid.to_f64() + self.err) * UP;
        if !most.is_finite() {
            return Self::unknown();
        }
        if self.mid.to_f64() <= self.err {
            return Self { mid: R::from_f64(0.0), err: most.max(0.0).sqrt() * UP };
        }
        let mid = self.mid.sqrt();
        let root = mid.to_f64();
        Self { mid, err: ((self.err + LOST) / root + root * R::ROUND) * UP * UP + TINY }
    }

    /// Sine and cosine of an angle up to 16 rad in magnitude: neither moves by more than the angle does.
    pub fn sin_cos(self) -> [Self; 2] {
        let (sin, cos) = self.mid.sin_cos();
        let err = if self.mid.to_f64().abs() <= 16.0 { (self.err + R::TRIG) * UP } else { f64::INFINITY };
        [sin, cos].map(|mid| Self { mid, err })
    }

    /// The angle of the vector `(x, |y|)`, from 0 to π; any, if it may be zero.
    ///
    /// A guess, and how far it is off, exactly but for the third order: nothing rests on the guess.
    pub fn angle(x: Self, y: Self) -> Self {
        let y = y.abs();
        let norm = (x * x + y * y).sqrt();
        let guess = Self::from(y.mid.to_f64().atan2(x.mid.to_f64()));
        let [sin, cos] = guess.sin_cos();
        let rest = (y * cos - x * sin) / norm;
        let size = rest.mid.to_f64().abs() + rest.err;
        if size <= 0.1 && (x * cos + y * sin).is_positive().is_certain() {
            // |asin r - r| <= |r|³ there.
            let angle = guess + rest;
            Self { mid: angle.mid, err: (angle.err + size * size * size) * UP }
        } else {
            Self { mid: R::from_f64(0.5 * PI), err: 0.5 * PI * UP }
        }
    }

    /// Whether it is above 0.
    pub fn is_positive(self) -> Ternary {
        let mid = self.mid.to_f64();
        match mid {
            above if above > self.err * UP => Ternary::Yes,
            below if below < -self.err * UP => Ternary::No,
            _ => Ternary::Doubt,
        }
    }

    /// Whether it is above another one.
    pub fn above(self, other: Self) -> Ternary {
        (self - other).is_positive()
    }

    /// The nearest `f64`.
    pub fn to_f64(self) -> f64 {
        self.mid.to_f64()
    }

    /// The same of a length in metres that is told: no number, where neither its sign is certain nor a micrometre of it. The middle of what
    /// may be any number says nothing.
    pub fn display_length(self) -> f64 {
        let mid = self.mid.to_f64();
        if self.err <= mid.abs().max(1e-6) { mid } else { f64::NAN }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dice::Dice;

    fn contains(ball: Ball<f64>, exact: DoubleDouble) -> bool {
        (exact - DoubleDouble::from(ball.mid)).abs().to_f64() <= ball.err
    }

    #[test]
    fn balls_of_53_bits_hold_what_106_bits_find() {
        let mut dice = Dice(1);
        for _ in 0..100_000 {
            let [a, b] = [(); 2].map(|()| {
                let (size, part) = ((dice.unit() * 40.0).exp2(), dice.unit() - 0.5);
                size * part
            });
            let offs = [a, b].map(|x| x * (dice.unit() - 0.5) * (-60.0 * dice.unit()).exp2());
            let exact = [0, 1].map(|k| DoubleDouble::from([a, b][k]) + DoubleDouble::from(offs[k]));
            let balls = [0, 1].map(|k| Ball { mid: [a, b][k], err: offs[k].abs() });
            let [x, y] = balls;
            assert!(contains(x + y, exact[0] + exact[1]) && contains(x - y, exact[0] - exact[1]));
            assert!(contains(x * y, exact[0] * exact[1]) && contains(x / y, exact[0] / exact[1]));
            assert!(contains(x.abs().sqrt(), exact[0].abs().sqrt()));
            let angle = Ball::angle(x, y);
            let (sin, cos) = DoubleDouble::from(angle.mid).sin_cos();
            let norm = (exact[0] * exact[0] + exact[1] * exact[1]).sqrt();
            let off = (exact[1].abs() * cos - exact[0] * sin) / norm;
            // The sine of what it is off, which is less than that by its third power.
            assert!(angle.err > 1.0 || off.abs().to_f64() <= angle.err, "{x:?} {y:?} {angle:?} {off:?}");
        }
    }

    #[test]
    fn sines_stay_within_an_eighth_of_their_bound_and_the_bound() {
        let mut dice = Dice(2);
        let mut worst = 0.0_f64;
        for _ in 0..400_000 {
            let x = 16.0 * (2.0 * dice.unit() - 1.0);
            let ((sin, cos), exact) = (sin_cos(x), DoubleDouble::from(x).sin_cos());
            for (near, exact) in [(sin, exact.0), (cos, exact.1)] {
                worst = worst.max((exact - DoubleDouble::from(near)).abs().to_f64());
            }
        }
        assert!(worst < f64::TRIG, "{worst:e}");
        assert!(worst > 0.01 * f64::TRIG, "{worst:e}: too good to be measured");
    }

    #[test]
    fn quotients_and_roots_of_what_is_all_but_nothing_are_right() {
        fn hold<R: BallReal>(least: i32) {
            let mut dice = Dice(3);
            let within = |ball: Ball<R>, exact: DoubleDouble| {
                let mid = Ball::from_twofold(Ball { mid: exact, err: 0.0 });
                let off = (ball - mid).mid.to_f64().abs();
                // The exact one is of 106 bits.
                assert!(off <= ball.err + mid.err + exact.to_f64().abs() * 1e-30, "{off:e}, {:e}", ball.err);
                ball.err
            };
            for _ in 0..20_000 {
                let [a, b] = [(); 2].map(|()| (1.0 + (dice.unit() * 30.0).exp2()).floor());
                let exponent = least + (2.0 * dice.unit() * 100.0) as i32 / 2 * 2;
                let tiny =
                    |number: f64| Ball::<R>::from(number * 2.0_f64.powi(exponent / 2) * 2.0_f64.powi(exponent / 2));
                within(tiny(a) / tiny(b), DoubleDouble::from(a) / DoubleDouble::from(b));
                within(tiny(a).sqrt(), DoubleDouble::from(a).sqrt() * 2.0_f64.powi(exponent / 2));
            }
            let (third, root) = (Ball::<R>::from(1e-200) / Ball::from(3e-200), Ball::<R>::from(2e-200).sqrt());
            assert!(third.err < 1e-15 && root.err < 1e-115, "{:e} {:e}", third.err, root.err);
        }
        hold::<f64>(-1074);
        hold::<DoubleDouble>(-1074);
    }

    #[test]
    fn the_angle_to_a_negative_zero_is_half_a_turn() {
        for zero in [0.0, -0.0] {
            let angle = Ball::<f64>::angle(Ball::from(-1.0), Ball::from(zero));
            assert!((angle.mid - PI).abs() <= angle.err && angle.err < 1e-14, "{angle:?}");
            let angle = Ball::<DoubleDouble>::angle(Ball::from(-1.0), Ball::from(zero));
            assert!((angle.to_f64() - PI).abs() < 1e-14, "{angle:?}");
        }
    }

    #[test]
    fn what_is_not_known_is_not_told() {
        let told = |mid, err| Ball::<f64> { mid, err }.display_length();
        assert_eq!((told(-0.5, 0.4), told(1e-9, 1e-7)), (-0.5, 1e-9));
        for unknown in [told(-0.5, 0.6), told(-0.5, f64::INFINITY), told(0.0, f64::NAN), told(f64::NAN, 0.0)] {
            assert!(unknown.is_nan());
        }
    }

    #[test]
    fn doubt_is_never_an_answer() {
        let ball = |mid, err| Ball::<f64> { mid, err };
        assert_eq!(ball(1.0, 0.5).above(ball(0.0, 0.25)), Ternary::Yes);
        assert_eq!(ball(0.0, 0.25).above(ball(1.0, 0.5)), Ternary::No);
        assert_eq!(ball(1.0, 0.5).above(ball(0.0, 0.5)), Ternary::Doubt);
        assert_eq!(ball(f64::NAN, 0.0).is_positive(), Ternary::Doubt);
        assert_eq!((ball(1.0, 0.0) / ball(0.1, 0.2)).is_positive(), Ternary::Doubt);
        assert_eq!(ball(-1.0, f64::INFINITY).sqrt().is_positive(), Ternary::Doubt);
        assert_eq!(ball(1e300, 0.0).sin_cos()[0].is_positive(), Ternary::Doubt);
    }
}
