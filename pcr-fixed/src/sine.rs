//! Sines, cosines and components of unit vectors.

use crate::integer::{divide, multiply, sqrt};
use core::ops::{Add, Neg, Sub};
use pcr_core::scalar::Unit;

/// A number between -2 and 2 in 32 bits, 30 of them after the binary point. Directions are right to 10⁻⁹ rad.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(transparent))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Sine(i32);

impl Sine {
    pub(crate) const FRACTION_BITS: u32 = 30;

    /// The number `bits / 2³⁰`.
    pub const fn from_bits(bits: i32) -> Self {
        Self(bits)
    }

    /// The number times 2³⁰.
    pub const fn to_bits(self) -> i32 {
        self.0
    }

    /// `self · number`, rounded to nearest.
    pub(crate) fn of(self, number: i32) -> i32 {
        multiply::<{ Self::FRACTION_BITS }>(number, self.0)
    }

    /// `self · number` plus `rest` in units of 2⁻³⁰, rounded to nearest, and the new rest in units of 2⁻³⁰.
    pub(crate) fn of_with_rest(self, number: i32, rest: i32) -> (i32, i32) {
        let sum = i64::from(number) * i64::from(self.0) + i64::from(rest);
        let whole = (sum + (1 << (Self::FRACTION_BITS - 1))) >> Self::FRACTION_BITS;
        (whole as i32, (sum - (whole << Self::FRACTION_BITS)) as i32)
    }

    /// `a u + b v`, rounded once.
    #[inline(never)]
    pub(crate) fn combine(a: i32, u: Self, b: i32, v: Self) -> i32 {
        let sum = i64::from(a) * i64::from(u.0) + i64::from(b) * i64::from(v.0);
        ((sum + (1 << (Self::FRACTION_BITS - 1))) >> Self::FRACTION_BITS) as i32
    }

    /// The direction of `(x, y)`, which must not be zero; right to 2 · 2⁻³⁰.
    ///
    /// Cost: one root and one division: multiplying by the reciprocal of the norm avoids a second division.
    pub(crate) fn unit_vector(x: i32, y: i32) -> [Self; 2] {
        // The larger component fills 31 bits, so that the norm has 31 or 31.5 bits.
        let shift = (x.unsigned_abs() | y.unsigned_abs()).leading_zeros().saturating_sub(1);
        let (x, y) = (x << shift, y << shift);
        let square = |x: i32| i64::from(x).unsigned_abs().pow(2);
        let norm = sqrt(square(x) + square(y));
        let reciprocal = divide((1 << 62) + u64::from(norm >> 1), norm);
        [x, y].map(|x| Self(((i64::from(x) * i64::from(reciprocal) + (1 << 31)) >> 32) as i32))
    }
}

impl Add for Sine {
    type Output = Self;
    fn add(self, rhs: Self) -> Self {
        Self(self.0 + rhs.0)
    }
}

impl Sub for Sine {
    type Output = Self;
    fn sub(self, rhs: Self) -> Self {
        Self(self.0 - rhs.0)
    }
}

impl Neg for Sine {
    type Output = Self;
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl Unit for Sine {
    const ZERO: Self = Self(0);
    const ONE: Self = Self(1 << Self::FRACTION_BITS);
    /// Sectors are compared with 14 bits (`roots.rs`).
    const COARSE: Self = Self(1 << (Self::FRACTION_BITS - 9));

    fn times(self, rhs: Self) -> Self {
        Self(self.of(rhs.0))
    }
    fn combine(a: Self, u: Self, b: Self, v: Self) -> Self {
        Self(Self::combine(a.0, u, b.0, v))
    }
}

#[cfg(test)]
mod tests {
    extern crate std;

    use super::*;
    use std::iter;

    const ONE: i64 = 1 << 30;

    /// Numbers that use all 32 bits, the same in every run.
    fn numbers() -> impl Iterator<Item = i32> {
        iter::successors(Some(1_u32), |x| Some(x.wrapping_mul(1_664_525).wrapping_add(1_013_904_223))).map(|x| x as i32)
    }

    #[test]
    fn products_are_rounded_once_and_nothing_of_them_is_lost() {
        let mut numbers = numbers();
        for _ in 0..1000 {
            let [a, b, u, v, rest] = [(); 5].map(|()| numbers.next().unwrap_or(0) >> 2);
            let (sine, other) = (Sine(u), Sine(v));
            let exact = i64::from(a) * i64::from(u);
            // Twice the error, which is at most a half; halves are rounded up.
            let off = |found: i32, exact: i64| 2 * ((i64::from(found) << 30) - exact);
            let nearest = |found: i32, exact: i64| -ONE < off(found, exact) && off(found, exact) <= ONE;
            assert!(nearest(sine.of(a), exact) && nearest(sine.times(Sine(a)).0, exact));
            assert!(nearest(Sine::combine(a, sine, b, other), exact + i64::from(b) * i64::from(v)));
            assert_eq!(Unit::combine(Sine(a), sine, Sine(b), other).0, Sine::combine(a, sine, b, other));
            let (whole, left) = sine.of_with_rest(a, rest);
            assert_eq!((i64::from(whole) << 30) + i64::from(left), exact + i64::from(rest));
            assert!(nearest(whole, exact + i64::from(rest)));
            assert_eq!([sine + other, sine - other, -sine].map(Sine::to_bits), [u + v, u - v, -u]);
            assert_eq!(Unit::abs(sine).0, u.abs());
        }
        let half = Sine(1 << 29);
        assert_eq!([half.of(1), half.of(-1), half.of(3), Sine::combine(1, half, 2, half)], [1, 0, 2, 2]);
        assert_eq!([half.of_with_rest(1, 0), half.of_with_rest(1, -1)], [(1, -(1 << 29)), (0, (1 << 29) - 1)]);
    }

    #[test]
    fn unit_vectors_are_right_to_two_last_digits() {
        let mut numbers = numbers();
        let mut worst = 0.0_f64;
        for k in 0..20_000 {
            let [x, y] = [(); 2].map(|()| numbers.next().unwrap_or(0) >> (1 + k % 29));
            if (x, y) != (0, 0) {
                let norm = f64::from(x).hypot(f64::from(y));
                let off = |found: Sine, x: i32| (f64::from(found.0) - f64::from(x) / norm * ONE as f64).abs();
                let [u, v] = Sine::unit_vector(x, y);
                worst = worst.max(off(u, x)).max(off(v, y));
            }
        }
        assert!(worst <= 2.0 && worst > 1.0, "{worst} last digits");
        for length in [1, 3, 1 << 16, (1 << 30) + 1, i32::MAX] {
            let found = [[length, 0], [0, length], [-length, 0], [0, -length]].map(|[x, y]| Sine::unit_vector(x, y));
            assert_eq!(
                found.map(|unit| unit.map(Sine::to_bits)),
                [[1, 0], [0, 1], [-1, 0], [0, -1]].map(|unit| unit.map(|u: i32| u << 30))
            );
        }
    }
}
