//! Products of two numbers, not narrowed.

use crate::integer::sqrt;
use crate::q::Q;
use core::ops::{Add, Neg, Sub};
use pcr_core::scalar::Wide;

/// Product of two [`Q`]: 64 bits, `2 F` of them after the binary point, nothing lost.
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
        /// Twice the limit, as a quotient: three such numbers can be added.
        const MOST: i64 = 1 << 29;
        // Half a last digit is added after all other digits are gone, where it cannot overflow.
        let nearest = ((self.0 >> (F - 1)) + 1) >> 1;
        Q::from_bits(nearest.clamp(-MOST, MOST) as i32)
    }
    fn half(self) -> Self {
        Self(self.0 >> 1)
    }
}
