//! Conversions from floating point, rounded to nearest, and back, which are exact.

use crate::q::Q;
use crate::sine::Sine;
use crate::turns::Turns;
use core::fmt;

/// The value cannot be represented in the format: it is NaN or too large.
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
    // NaN fails this test as well.
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

    /// The nearest number of the format; halves are rounded away from 0.
    ///
    /// # Errors
    /// [`OutOfRange`] for NaN and for values beyond the 32 bits. The constructors of `pcr-core` accept an eighth of
    /// that range, [`Scalar::LIMIT`](pcr_core::Scalar::LIMIT).
    pub const fn from_f64(value: f64) -> Result<Self, OutOfRange> {
        // The factor is a power of two, so the product is exact.
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

    /// Converts the number exactly.
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
    /// Converts the number exactly.
    pub const fn to_f64(self) -> f64 {
        self.to_bits() as f64 / (1_i64 << Self::FRACTION_BITS) as f64
    }
}

impl Turns {
    /// The nearest angle, without whole turns; right to 10⁻⁹ rad up to a million turns.
    ///
    /// # Errors
    /// [`OutOfRange`] for NaN and above 10⁹ turns, where an `f64` is too coarse for an angle.
    pub const fn from_radians(radians: f64) -> Result<Self, OutOfRange> {
        const MOST_TURNS: f64 = 1e9;
        let turns = radians / core::f64::consts::TAU;
        if !(turns > -MOST_TURNS && turns < MOST_TURNS) {
            return Err(OutOfRange);
        }
        // The fraction of a turn is taken first, so that none of its digits is lost.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Q16;
    use core::f64::consts::{FRAC_PI_2, TAU};

    const DIGIT: f64 = 1.0 / 65_536.0;

    fn bits(digits: f64) -> Option<i32> {
        Q16::from_f64(digits * DIGIT).ok().map(Q16::to_bits)
    }

    #[test]
    fn halves_are_rounded_away_from_zero() {
        let found = [0.499, 0.5, 1.0, 1.499, 1.5, 7.5].map(|digits| [bits(digits), bits(-digits)]);
        assert_eq!(found, [0, 1, 1, 1, 2, 8].map(|digits: i32| [Some(digits), Some(-digits)]));
        assert_eq!(Q16::from_f32(-2.5).map(Q16::to_f32), Ok(-2.5));
        assert_eq!([Q16::try_from(0.25_f32), Q16::try_from(0.25_f64)], [Ok(Q16::from_bits(1 << 14)); 2]);
        assert_eq!(f64::from(Q16::from_bits(-3)), -3.0 * DIGIT);
        assert_eq!(Sine::from_bits(-3 << 28).to_f64(), -0.75);
    }

    #[test]
    fn what_does_not_fit_is_refused() {
        let (most, least) = (f64::from(i32::MAX), f64::from(i32::MIN));
        assert_eq!([bits(most + 0.499), bits(most)], [Some(i32::MAX); 2]);
        assert_eq!([bits(least - 0.499), bits(least)], [Some(i32::MIN); 2]);
        for digits in [most + 0.5, least - 0.5, 1e300, f64::INFINITY, f64::NAN] {
            assert_eq!((bits(digits), Q16::from_f32(digits as f32).ok()), (None, None), "{digits}");
        }
    }

    #[test]
    fn angles_are_rounded_to_nearest_and_whole_turns_taken_off() {
        let turn = |digits: f64| Turns::from_radians(digits * (TAU / 4_294_967_296.0)).map(Turns::to_bits);
        for (digits, rounded) in [(0.0, 0), (0.4, 0), (0.6, 1), (2.4, 2), (2.6, 3)] {
            assert_eq!([turn(digits), turn(-digits)], [Ok(rounded), Ok(-rounded)], "{digits}");
        }
        for quarters in [1.0, 5.0, 401.0, -3.0, -403.0] {
            assert_eq!(Turns::from_radians(quarters * FRAC_PI_2), Ok(Turns::QUARTER), "{quarters}");
        }
        // An exact half of the last place; its quotient by 2π is exact as well.
        assert_eq!(
            [TAU, -TAU].map(|turn| Turns::from_radians(turn * 1.25).map(Turns::to_bits)),
            [Ok(1 << 30), Ok(-1 << 30)]
        );
        assert_eq!([0.5, 1.5, 2.5].map(turn), [Ok(1), Ok(2), Ok(3)]);
        assert_eq!([-0.5, -1.5, -2.5].map(turn), [Ok(-1), Ok(-2), Ok(-3)]);
        // As accurately as an `f64` represents the angle.
        for k in 1..1000 {
            let radians = TAU * (1_048_576.0 + f64::from(k) / 4_294_967_296.0);
            let digits = ((radians / TAU).fract() * 4_294_967_296.0).round() as i32;
            assert_eq!(Turns::from_radians(radians).map(Turns::to_bits), Ok(digits));
        }
        for turns in [1e9, -1e9, 2e9, f64::INFINITY, f64::NAN] {
            assert_eq!(Turns::from_radians(turns * TAU), Err(OutOfRange), "{turns}");
        }
        assert!(Turns::from_radians(0.999e9 * TAU).is_ok() && Turns::from_radians(-0.999e9 * TAU).is_ok());
        assert_eq!([Turns::QUARTER, Turns::HALF].map(Turns::to_radians), [FRAC_PI_2, -2.0 * FRAC_PI_2]);
    }
}
