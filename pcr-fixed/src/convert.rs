//! Conversions from floating point, rounded to nearest, and back, exact.

use crate::q::Q;
use crate::sine::Sine;
use crate::turns::Turns;
use core::fmt;

/// The value is not a number of the format: NaN, or too large.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct OutOfRange;

impl fmt::Display for OutOfRange {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("not a number of the fixed-point format")
    }
}

impl core::error::Error for OutOfRange {}

/// The integer nearest to `value`, halves away from 0, if it fits into 32 bits.
const fn nearest(value: f64) -> Option<i32> {
    // NaN fails this as well.
    if !(value > i32::MIN as f64 - 0.5 && value < i32::MAX as f64 + 0.5) {
        return None;
    }
    // Within 2³² both the integer part and the rest are exact.
    let whole = value as i64;
    let rest = value - whole as f64;
    let rounded = whole + (rest >= 0.5) as i64 - (rest <= -0.5) as i64;
    Some(rounded as i32)
}

impl<const F: u32> Q<F> {
    const DIGITS_OF_ONE: f64 = (1_i64 << F) as f64;

    /// The nearest number of the format, halves away from 0.
    ///
    /// # Errors
    /// [`OutOfRange`] for NaN and for what is beyond the 32 bits. The constructors of `pcr-core` accept an eighth
    /// of that range, [`Scalar::LIMIT`](pcr_core::Scalar::LIMIT).
    pub const fn from_f64(value: f64) -> Result<Self, OutOfRange> {
        // A power of two: the product is exact.
        match nearest(value * Self::DIGITS_OF_ONE) {
            Some(bits) => Ok(Self::from_bits(bits)),
            None => Err(OutOfRange),
        }
    }

    /// As [`Q::from_f64`].
    ///
    /// # Errors
    /// [`OutOfRange`].
    pub const fn from_f32(value: f32) -> Result<Self, OutOfRange> {
        Self::from_f64(value as f64)
    }

    /// The same number, exactly.
    pub const fn to_f64(self) -> f64 {
        self.to_bits() as f64 / Self::DIGITS_OF_ONE
    }

    /// The nearest `f32`.
    pub const fn to_f32(self) -> f32 {
        self.to_f64() as f32
    }
}

impl<const F: u32> TryFrom<f64> for Q<F> {
    type Error = OutOfRange;
    fn try_from(value: f64) -> Result<Self, OutOfRange> {
        Self::from_f64(value)
    }
}

impl<const F: u32> TryFrom<f32> for Q<F> {
    type Error = OutOfRange;
    fn try_from(value: f32) -> Result<Self, OutOfRange> {
        Self::from_f32(value)
    }
}

impl<const F: u32> From<Q<F>> for f64 {
    fn from(number: Q<F>) -> f64 {
        number.to_f64()
    }
}

impl Sine {
    /// The same number, exactly.
    pub const fn to_f64(self) -> f64 {
        self.to_bits() as f64 / (1_i64 << Self::FRACTION_BITS) as f64
    }
}

impl Turns {
    /// The nearest angle, whole turns taken off; right to 10⁻⁹ rad up to a million turns.
    ///
    /// # Errors
    /// [`OutOfRange`] for NaN and above 10⁹ turns, where an `f64` does not know the angle any more.
    pub const fn from_radians(radians: f64) -> Result<Self, OutOfRange> {
        const MOST_TURNS: f64 = 1e9;
        let turns = radians / core::f64::consts::TAU;
        if !(turns > -MOST_TURNS && turns < MOST_TURNS) {
            return Err(OutOfRange);
        }
        // The part of a turn first, so that no digit of it is lost.
        let part = turns - (turns as i64) as f64;
        let bits = part * (1_i64 << 32) as f64;
        let whole = bits as i64;
        let rest = bits - whole as f64;
        Ok(Self::from_bits((whole + (rest >= 0.5) as i64 - (rest <= -0.5) as i64) as i32))
    }

    /// The angle in `[-π, π)` \[rad\].
    pub const fn to_radians(self) -> f64 {
        self.to_bits() as f64 * (core::f64::consts::TAU / (1_i64 << 32) as f64)
    }
}
