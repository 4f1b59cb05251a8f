//! Numbers of 106 bits as the unevaluated sum of two `f64` (Dekker 1971), with what a position on a path needs:
//! sums, products, quotients, square roots, sines and cosines.
//!
//! With u = 2^-53, each operation is right within 16 u² = 2^-102 of its result, the sine and cosine within 64 u² = 2^-100 of 1,
//! as long as nothing overflows, no product that is part of it is below 2^-900, and for quotients and roots the number itself is not:
//!
//! - *Sum*: 3u² (Joldes, Muller, Popescu, Tight and rigorous error bounds for basic building blocks of double-word arithmetic, ACM
//!   TOMS 44, 2017, algorithm 6; the proofs have been checked by Coq: Muller, Rideau, ACM TOMS 48, 2022).
//! - *Product*: 7u² (there, algorithm 10), with an `f64` 3u² (algorithm 8).
//! - *Quotient* a/b: the first digit is off by 3u, what it leaves is found with 3u² |a| for the product and as much of
//!   itself for the difference; of that the second digit is right within 3u, the third takes away what that leaves but for 3u more:
//!   27u³. The first two are added exactly, the third with 3u². Together less than 7u².
//! - *Root*: what the `f64` root leaves of the number is found with 3u² of itself; it is 3u at most. Twice the root for the sum
//!   of both roots costs 1.5u of the correction of 1.5u, its leading part and the division u each: 5.3u².
//! - *Sine and cosine*, up to 2^25: the number of quarter turns is below 2^25, too, and off by 2^-27 more than rounded, that is by what the
//!   `f64` of the angle leaves out and the quotient is rounded. Times each of three parts of π/2 it is exact; what follows them is below
//!   2^-162, and 2^-137 as often; three differences, 3u² each of what they leave: 8u² of 1. Of the eighth, below 0.0982, the square is right within 7u², the series within
//!   3u² and 0.0017 of the steps before, so that sine and versine are right within 11u² of themselves. A doubling costs the
//!   sine 7u², and what the cosine is off, 4u² at most; the versine twice what the sine is off and 7u². After three the sine is
//!   off by 44u² of itself, the versine by 73u² of itself, at most 0.2929: 31u² and 22u². With the angle, less than 40u².
//!
//! *What is smaller.* Sums lose nothing: all numbers are multiples of 2^-1074, and so is what is rounded. A product is off by 2^-1070 more at
//! most: the parts of its error term are rounded to such a multiple, each by 2^-1075, a few of them. A quotient and a root are found by what
//! their first digits leave, so that they are off by that much over the divisor, or over twice the root, and that may be anything.
//! `Ball` adds it.

use std::cmp::Ordering;
use std::f64::consts::FRAC_PI_2;
use std::ops::{Add, Div, Mul, Neg, Sub};
use std::sync::LazyLock;

/// Terms of the series of the sine and cosine. For angles up to π/32 the first one left out, x^23/23!, is below 2^-151.
const TERMS: usize = 10;

/// 1 / 2k(2k + 1) and 1 / (2k + 1)(2k + 2), for k from 1.
static RECIPROCALS: LazyLock<[[DoubleDouble; 2]; TERMS]> = LazyLock::new(|| {
    std::array::from_fn(|index| {
        let k = 2.0 * (index as f64 + 1.0);
        [k * (k + 1.0), (k + 1.0) * (k + 2.0)].map(|product| DoubleDouble::from(1.0) / DoubleDouble::from(product))
    })
});

/// The sum of two `f64`, the second no larger than half a unit in the last place of the first.
#[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd)]
pub struct DoubleDouble {
    hi: f64,
    lo: f64,
}

impl From<f64> for DoubleDouble {
    fn from(hi: f64) -> Self {
        Self::new(hi)
    }
}

/// `a + b` and what it was rounded by (Knuth).
fn sum(a: f64, b: f64) -> (f64, f64) {
    let s = a + b;
    let t = s - a;
    (s, (a - (s - t)) + (b - t))
}

/// The same for `|a| >= |b|`.
fn sum_of_larger(a: f64, b: f64) -> DoubleDouble {
    let hi = a + b;
    DoubleDouble { hi, lo: b - (hi - a) }
}

/// `a` as the sum of two numbers of 26 bits.
fn halves(a: f64) -> (f64, f64) {
    const SPLIT: f64 = 134_217_729.0;
    let t = SPLIT * a;
    let high = t - (t - a);
    (high, a - high)
}

/// `a b` and what it was rounded by.
fn product(a: f64, b: f64) -> (f64, f64) {
    let p = a * b;
    let ((ah, al), (bh, bl)) = (halves(a), halves(b));
    (p, ((ah * bh - p) + ah * bl + al * bh) + al * bl)
}

impl Add for DoubleDouble {
    type Output = Self;
    fn add(self, rhs: Self) -> Self {
        let (s, e) = sum(self.hi, rhs.hi);
        let (t, f) = sum(self.lo, rhs.lo);
        let r = sum_of_larger(s, e + t);
        sum_of_larger(r.hi, r.lo + f)
    }
}

impl Neg for DoubleDouble {
    type Output = Self;
    fn neg(self) -> Self {
        Self { hi: -self.hi, lo: -self.lo }
    }
}

impl Sub for DoubleDouble {
    type Output = Self;
    fn sub(self, rhs: Self) -> Self {
        self + -rhs
    }
}

impl Mul for DoubleDouble {
    type Output = Self;
    fn mul(self, rhs: Self) -> Self {
        let (p, e) = product(self.hi, rhs.hi);
        sum_of_larger(p, e + (self.hi * rhs.lo + self.lo * rhs.hi))
    }
}

impl Mul<f64> for DoubleDouble {
    type Output = Self;
    fn mul(self, rhs: f64) -> Self {
        let (p, e) = product(self.hi, rhs);
        sum_of_larger(p, e + self.lo * rhs)
    }
}

impl Div for DoubleDouble {
    type Output = Self;
    fn div(self, rhs: Self) -> Self {
        let first = self.hi / rhs.hi;
        let rest = self - rhs * first;
        let second = rest.hi / rhs.hi;
        let third = (rest - rhs * second).hi / rhs.hi;
        sum_of_larger(first, second) + Self::from(third)
    }
}

impl DoubleDouble {
    /// Zero.
    pub const ZERO: Self = Self { hi: 0.0, lo: 0.0 };
    /// 2π, right within 2^-106.
    pub const TURN: Self = Self { hi: 4.0 * Self::HALF_PI[0], lo: 4.0 * Self::HALF_PI[1] };
    const HALF_PI: [f64; 3] = [FRAC_PI_2, 6.123_233_995_736_766e-17, -1.497_384_904_859_169_8e-33];

    /// An `f64` as it is.
    pub const fn new(hi: f64) -> Self {
        Self { hi, lo: 0.0 }
    }

    /// The two numbers whose sum it is, the larger one first.
    pub fn parts(self) -> [f64; 2] {
        [self.hi, self.lo]
    }

    /// The `f64` nearest to it.
    pub fn to_f64(self) -> f64 {
        self.hi
    }

    /// Half of it.
    pub fn half(self) -> Self {
        Self { hi: 0.5 * self.hi, lo: 0.5 * self.lo }
    }

    /// Its magnitude.
    pub fn abs(self) -> Self {
        if self < Self::ZERO { -self } else { self }
    }

    /// Whether it is no number.
    pub fn is_nan(self) -> bool {
        self.hi.is_nan() || self.lo.is_nan()
    }

    /// The order of numbers, in which what is no number has a place, too, so that it leaves the others sorted.
    pub fn total_cmp(&self, other: &Self) -> Ordering {
        self.hi.total_cmp(&other.hi).then(self.lo.total_cmp(&other.lo))
    }

    /// It, but not outside `[lo, hi]`.
    pub fn clamp(self, lo: Self, hi: Self) -> Self {
        match self {
            low if low < lo => lo,
            high if high > hi => hi,
            between => between,
        }
    }

    /// Square root; 0 of what is not positive.
    pub fn sqrt(self) -> Self {
        if self <= Self::ZERO {
            return Self::ZERO;
        }
        let root = self.hi.sqrt();
        let rest = self - Self::from(root) * root;
        sum_of_larger(root, rest.hi / (2.0 * root))
    }

    /// Sine and cosine, of angles up to 2^25.
    pub fn sin_cos(self) -> (Self, Self) {
        let quarters = (self.hi / FRAC_PI_2).round();
        let [a, b, c] = Self::HALF_PI;
        let part = |by: f64| {
            let (p, e) = product(by, quarters);
            Self { hi: p, lo: e }
        };
        let angle = self - part(a) - part(b) - part(c);
        let (sin, cos) = angle.sin_cos_below_eighth();
        match quarters.rem_euclid(4.0) as u8 {
            0 => (sin, cos),
            1 => (cos, -sin),
            2 => (-sin, -cos),
            _ => (-cos, sin),
        }
    }

    /// For magnitudes up to π/4: the series of an eighth of it, doubled three times.
    fn sin_cos_below_eighth(self) -> (Self, Self) {
        const DOUBLINGS: u32 = 3;
        let scale = f64::from(1_u32 << DOUBLINGS);
        let x = Self { hi: self.hi / scale, lo: self.lo / scale };
        let square = x * x;
        // sin x / x, and (1 - cos x) / x², which doubling keeps accurate.
        let (mut sin, mut versine) = (Self::from(1.0), Self::from(1.0));
        for [odd, even] in RECIPROCALS.iter().rev() {
            sin = Self::from(1.0) - sin * square * *odd;
            versine = Self::from(1.0) - versine * square * *even;
        }
        let (mut sin, mut versine) = (sin * x, (versine * square).half());
        for _ in 0..DOUBLINGS {
            let cos = Self::from(1.0) - versine;
            // 1 - cos 2x = 2 sin² x, sin 2x = 2 sin x cos x.
            (sin, versine) = (sin * cos * 2.0, sin * sin * 2.0);
        }
        (sin, Self::from(1.0) - versine)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Bound on the error of sines, cosines and of what the identities below compare: 2^-100.
    const BOUND: f64 = 7.9e-31;

    fn close(a: DoubleDouble, b: DoubleDouble) -> bool {
        (a - b).abs().hi < BOUND
    }

    /// A number of 106 bits in [0, 1).
    fn number(seed: u32) -> DoubleDouble {
        let part = |k: u32| f64::from(seed.wrapping_mul(k).wrapping_add(k)) / f64::from(u32::MAX);
        DoubleDouble::from(part(2_654_435_769)) + DoubleDouble::from(part(2_246_822_519) * 2.0_f64.powi(-53))
    }

    #[test]
    fn constants_have_thirty_digits() {
        // sin 1, cos 1, √2, 1/3 to 32 digits, each as the nearest f64 and the rest.
        let one = DoubleDouble::from(1.0);
        let (sin, cos) = one.sin_cos();
        let known = |hi: f64, rest: f64| DoubleDouble::from(hi) + DoubleDouble::from(rest);
        assert!(close(sin, known(0.841_470_984_807_896_5, 1.776_845_092_935_536e-18)), "{sin:?}");
        assert!(close(cos, known(0.540_302_305_868_139_8, -4.760_954_612_604_417e-17)), "{cos:?}");
        assert!(close(DoubleDouble::from(2.0).sqrt(), known(2.0_f64.sqrt(), -9.667_293_313_452_913e-17)));
        assert!(close(one / DoubleDouble::from(3.0), known(1.0 / 3.0, 1.850_371_707_708_594e-17)));
    }

    #[test]
    fn identities_hold_to_thirty_digits() {
        let one = DoubleDouble::from(1.0);
        for seed in 0..20_000 {
            let (x, y) = (number(seed) * 40.0 - DoubleDouble::from(20.0), number(seed + 77_777));
            let ((sx, cx), (sy, cy), (sum_sin, sum_cos)) = (x.sin_cos(), y.sin_cos(), (x + y).sin_cos());
            assert!(close(sx * sx + cx * cx, one));
            assert!(close(sum_sin, sx * cy + cx * sy) && close(sum_cos, cx * cy - sx * sy), "{x:?} {y:?}");
            assert!(close(y.sqrt() * y.sqrt(), y));
            assert!(close(x / (y + one) * (y + one), x));
            assert!(((x + y) - x - y).abs().hi < 32.0 * BOUND);
        }
    }

    #[test]
    fn small_sines_keep_their_relative_accuracy() {
        for exponent in 1..200 {
            let x = number(exponent) * 2.0_f64.powi(-i32::try_from(exponent).unwrap());
            let (sin, _) = x.sin_cos();
            // x - x³/6 + x⁵/120 is off by x⁷/5040.
            let square = x * x;
            let series = x - x * square / DoubleDouble::from(6.0)
                * (DoubleDouble::from(1.0) - square / DoubleDouble::from(20.0));
            let error = (sin - series).abs().hi / x.hi;
            assert!(error <= x.hi.powi(6) / 5000.0 + BOUND, "at {x:?}: {error:e}");
        }
    }
}
