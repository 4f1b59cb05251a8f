//! A number of 31 significant bits and an exponent, for the three formulas whose intermediate results have no common
//! scale. Rounding to nearest throughout: every operation is right to 2⁻³⁰ of its result.

use crate::integer::{divide, sqrt};

/// `mantissa · 2^exponent`, the magnitude of the mantissa from 2³⁰ to 2³¹ - 1; or 0, with the least exponent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Scaled {
    mantissa: i32,
    exponent: i32,
}

impl Scaled {
    /// Far below the exponent of any number, and its double is one too.
    const ZERO: Self = Self { mantissa: 0, exponent: -1024 };

    /// `value · 2^exponent`.
    pub(crate) fn new(value: i64, exponent: i32) -> Self {
        if value == 0 {
            return Self::ZERO;
        }
        // 33 leading zeros make 31 bits. One place is left to round by, which may not carry into bit 32.
        let shift = 33 - value.unsigned_abs().leading_zeros() as i32;
        let mantissa = if shift > 0 { ((value >> (shift - 1)) + 1) >> 1 } else { value << -shift };
        let most = i64::from(i32::MAX);
        Self { mantissa: mantissa.clamp(-most, most) as i32, exponent: exponent + shift }
    }

    pub(crate) fn is_negative(self) -> bool {
        self.mantissa < 0
    }

    pub(crate) fn minus(self) -> Self {
        Self { mantissa: -self.mantissa, ..self }
    }

    pub(crate) fn magnitude(self) -> Self {
        Self { mantissa: self.mantissa.abs(), ..self }
    }

    pub(crate) fn plus(self, rhs: Self) -> Self {
        let exponent = self.exponent.max(rhs.exponent);
        // 62 bits each: nothing is lost of the smaller one that the result could hold.
        let aligned = |term: Self| (i64::from(term.mantissa) << 31) >> (exponent - term.exponent).min(63);
        Self::new(aligned(self) + aligned(rhs), exponent - 31)
    }

    pub(crate) fn times(self, rhs: Self) -> Self {
        Self::new(i64::from(self.mantissa) * i64::from(rhs.mantissa), self.exponent + rhs.exponent)
    }

    /// `self / divisor`; a divisor of 0 gives something large.
    pub(crate) fn over(self, divisor: Self) -> Self {
        let by = divisor.mantissa.unsigned_abs();
        let magnitude = i64::from(divide((u64::from(self.mantissa.unsigned_abs()) << 31) + u64::from(by >> 1), by));
        let quotient = if (self.mantissa < 0) == (divisor.mantissa < 0) { magnitude } else { -magnitude };
        Self::new(quotient, self.exponent - divisor.exponent - 31)
    }

    /// Square root of a number that is not negative.
    pub(crate) fn sqrt(self) -> Self {
        // An even exponent is left, and 62 or 63 bits.
        let shift = 31 + ((self.exponent + 1) & 1);
        let root = sqrt(u64::from(self.mantissa.unsigned_abs()) << shift);
        Self::new(i64::from(root), (self.exponent - shift) >> 1)
    }

    /// The nearest integer, saturating at 2³⁰.
    pub(crate) fn round(self) -> i32 {
        const MOST: i32 = 1 << 30;
        match self.exponent {
            // Half of the last place is added before that is dropped: in 31 bits there is room for it.
            ..-1 => ((self.mantissa >> (-1 - self.exponent).min(31)) + 1) >> 1,
            _ => self.mantissa.signum() * MOST,
        }
    }

    /// Two numbers on one scale, the larger one of 31 bits.
    pub(crate) fn aligned(self, rhs: Self) -> [i32; 2] {
        let exponent = self.exponent.max(rhs.exponent);
        [self, rhs].map(|term| term.mantissa >> (exponent - term.exponent).min(31))
    }
}
