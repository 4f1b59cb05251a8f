//! The product of two numbers in twice the width.

use crate::integer::sqrt;
use crate::q::Q;
use core::ops::{Add, Neg, Sub};
use pcr_core::scalar::Wide;

/// Product of two [`Q`]: 64 bits, `2 F` of them after the binary point; exact.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Product<const F: u32>(i64);

impl<const F: u32> Product<F> {
    /// The number `bits / 2^(2 F)`.
    pub const fn from_bits(bits: i64) -> Self {
        Self(bits)
    }

    /// The number times `2^(2 F)`.
    pub const fn to_bits(self) -> i64 {
        self.0
    }
}

impl<const F: u32> Add for Product<F> {
    type Output = Self;
    fn add(self, rhs: Self) -> Self {
        Self(self.0 + rhs.0)
    }
}

impl<const F: u32> Sub for Product<F> {
    type Output = Self;
    fn sub(self, rhs: Self) -> Self {
        Self(self.0 - rhs.0)
    }
}

impl<const F: u32> Neg for Product<F> {
    type Output = Self;
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl<const F: u32> Wide<Q<F>> for Product<F> {
    const ZERO: Self = Self(0);

    /// Rounded to nearest.
    fn sqrt(self) -> Q<F> {
        let root = u64::try_from(self.0).map_or(0, sqrt);
        Q::from_bits(root.min(i32::MAX as u32) as i32)
    }
    fn narrow(self) -> Q<F> {
        /// Results saturate at twice the limit, like quotients, so that three of them can be added.
        const MOST: i64 = 1 << 29;
        // Half a last digit is added after the other digits are dropped, so that it cannot overflow.
        let nearest = ((self.0 >> (F - 1)) + 1) >> 1;
        Q::from_bits(nearest.clamp(-MOST, MOST) as i32)
    }
    fn half(self) -> Self {
        Self(self.0 >> 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    type P = Product<16>;

    fn narrow(bits: i64) -> i32 {
        P::from_bits(bits).narrow().to_bits()
    }

    #[test]
    fn products_are_narrowed_to_nearest_and_saturate() {
        let half = 1 << 15;
        let found = [half - 1, half, -half, -half - 1, 3 * half - 1, 3 * half].map(narrow);
        assert_eq!(found, [0, 1, 0, -1, 1, 2]);
        let most = 1 << 29;
        for bits in [1 << 45, (1 << 46) + half, i64::MAX] {
            assert_eq!([narrow(bits), narrow(-bits)], [most, -most]);
        }
        assert_eq!([narrow((1 << 45) - half), narrow((1 << 45) - half - 1)], [most, most - 1]);
        assert_eq!([narrow(half - 1 - (1 << 45)), narrow(half - (1 << 45))], [-most, 1 - most]);
    }

    #[test]
    fn sums_halves_and_roots_are_those_of_the_bits() {
        let [a, b] = [P::from_bits(5 << 32), P::from_bits(3 << 32)];
        assert_eq!(
            [a + b, a - b, -a, a.half(), a.double()].map(P::to_bits),
            [8, 2, -5, 5, 10].map(|x: i64| { if x == 5 { 5 << 31 } else { x << 32 } })
        );
        assert_eq!([4_i64 << 32, -1, 0].map(|bits| P::from_bits(bits).sqrt().to_bits()), [2 << 16, 0, 0]);
        let near = [(1_i64 << 62) - (1 << 31), 1 << 62, i64::MAX].map(|bits| P::from_bits(bits).sqrt().to_bits());
        assert_eq!(near, [i32::MAX; 3]);
    }
}
