//! Angles as 32-bit fractions of a turn, which wrap around as angles do.

use crate::integer::{divide, multiply};
use crate::q::Q;
use crate::sine::Sine;
use crate::trigonometry::{atan2, sin_cos};
use core::ops::{Add, Neg, Sub};
use pcr_core::scalar::Angle;

/// Angle, counter-clockwise positive, modulo one turn: 2³² units are a turn, one unit is 1.5·10⁻⁹ rad.
///
/// ```
/// use pcr_fixed::Turns;
/// assert_eq!(Turns::HALF + Turns::HALF, Turns::ZERO);
/// assert_eq!(Turns::from_radians(-core::f64::consts::FRAC_PI_2), Ok(-Turns::QUARTER));
/// ```
#[derive(Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(transparent))]
pub struct Turns(i32);

impl Turns {
    /// The zero angle.
    pub const ZERO: Self = Self(0);
    /// A quarter turn to the left.
    pub const QUARTER: Self = Self(1 << 30);
    /// Half a turn. It is its own negative.
    pub const HALF: Self = Self(i32::MIN);

    /// The angle `bits / 2³²` of a turn.
    pub const fn from_bits(bits: i32) -> Self {
        Self(bits)
    }

    /// The angle in units of 2⁻³² of a turn, from -2³¹ (half a turn) to 2³¹ - 1.
    pub const fn to_bits(self) -> i32 {
        self.0
    }
}

impl Add for Turns {
    type Output = Self;
    fn add(self, rhs: Self) -> Self {
        Self(self.0.wrapping_add(rhs.0))
    }
}

impl Sub for Turns {
    type Output = Self;
    fn sub(self, rhs: Self) -> Self {
        Self(self.0.wrapping_sub(rhs.0))
    }
}

impl Neg for Turns {
    type Output = Self;
    fn neg(self) -> Self {
        Self(self.0.wrapping_neg())
    }
}

/// `length / radius` \[rad\] times 2²⁹, up to one turn.
///
/// The division for an arc: its angle is a length divided by a radius.
fn sweep<const F: u32>(length: Q<F>, radius: Q<F>) -> u64 {
    let (length, radius) = (length.to_bits().unsigned_abs(), radius.to_bits().unsigned_abs());
    u64::from(divide((u64::from(length) << 29) + u64::from(radius >> 1), radius))
}

/// `2³² · 2 / π`: converts radians times 2²⁹ to units of 2⁻³³ of a turn, times 2³².
const TURNS: u64 = 2_734_261_102;

impl<const F: u32> Angle<Q<F>> for Turns {
    const ZERO: Self = Self::ZERO;

    fn is_finite(self) -> bool {
        true
    }
    fn digest(self) -> u32 {
        self.0 as u32
    }
    /// A turn to the left: the length is not negative.
    fn subtended(length: Q<F>, radius: Q<F>) -> Self {
        Self(((sweep(length, radius) * TURNS + (1 << 30)) >> 31) as i32)
    }
    fn half_subtended(length: Q<F>, radius: Q<F>) -> Self {
        Self(((sweep(length, radius) * TURNS + (1 << 31)) >> 32) as i32)
    }
    fn sin_cos(self) -> (Sine, Sine) {
        let (sin, cos) = sin_cos(self.0);
        (Sine::from_bits(sin), Sine::from_bits(cos))
    }
    fn atan2(y: Q<F>, x: Q<F>) -> Self {
        Self(atan2(y.to_bits(), x.to_bits()))
    }
    fn arc_length(self, radius: Q<F>) -> Q<F> {
        /// `2²⁹ π`
        const HALF_TURN: i32 = 1_686_629_713;
        let radians = multiply::<31>(self.0, HALF_TURN);
        Q::from_bits(multiply::<29>(radians, radius.to_bits()))
    }
    fn circumference(radius: Q<F>) -> Q<F> {
        /// `2²⁸ · 2π`
        const TURN: i32 = 1_686_629_713;
        Q::from_bits(multiply::<28>(radius.to_bits(), TURN))
    }
}

#[cfg(test)]
mod tests {
    extern crate std;

    use super::*;
    use crate::Q16;
    use std::f64::consts::{PI, TAU};

    type A = Turns;

    fn q(bits: i32) -> Q16 {
        Q16::from_bits(bits)
    }

    #[test]
    fn angles_wrap() {
        let (quarter, half) = (Turns::QUARTER, Turns::HALF);
        assert_eq!(
            [quarter + quarter, -half, half + half, half - quarter, -quarter - half],
            [half, half, Turns::ZERO, quarter, quarter]
        );
    }

    #[test]
    fn an_arc_subtends_its_length_by_its_radius() {
        // One radian: 2^32 / 2π = 683,565,275.6.
        for radius in [1, 7, 1 << 16, (1 << 27) - 1] {
            assert_eq!(A::subtended(q(radius), q(radius)), Turns(683_565_276));
            assert_eq!(A::half_subtended(q(radius), q(radius)), Turns(341_782_638));
        }
        let mut worst = [0.0_f64; 2];
        for k in 1..20_000 {
            let radius = 1 + (k * 6_701) % 130_000;
            let length = (f64::from(radius) * TAU * f64::from(k) / 20_000.0) as i32;
            let (sweep, exact) = (sweep(q(length), q(radius)) as i64, i64::from(length) << 29);
            assert!((2 * (sweep * i64::from(radius) - exact)).abs() <= i64::from(radius), "{length} {radius}");
            let turn = f64::from(length) / f64::from(radius) / TAU * 4_294_967_296.0;
            let off = |found: Turns, exact: f64| {
                let off = f64::from(found.0) - exact;
                (off - 4_294_967_296.0 * (off / 4_294_967_296.0).round()).abs()
            };
            worst[0] = worst[0].max(off(A::subtended(q(length), q(radius)), turn));
            worst[1] = worst[1].max(off(A::half_subtended(q(length), q(radius)), 0.5 * turn));
        }
        assert!(worst[0] < 1.9 && worst[1] < 1.2, "{worst:?} of 2^-32 of a turn");
    }

    #[test]
    fn an_angle_subtends_the_nearest_length() {
        let mut worst = 0.0_f64;
        for k in 0..20_000_i32 {
            let (angle, radius) = (k.wrapping_mul(-1_640_531_527), 1 + k * 13);
            let exact = f64::from(angle) / 2_147_483_648.0 * PI * f64::from(radius);
            worst = worst.max((f64::from(Turns(angle).arc_length(q(radius)).to_bits()) - exact).abs());
        }
        assert!(worst > 0.49 && worst < 0.501, "{worst} last digits");
        assert_eq!(
            [1, 2, 3, 4, 1 << 24].map(|radius| A::circumference(q(radius)).to_bits()),
            [6, 13, 19, 25, 105_414_357]
        );
        assert!(<Turns as Angle<Q16>>::is_finite(Turns::HALF));
    }
}
