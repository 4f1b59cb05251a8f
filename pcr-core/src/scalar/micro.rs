//! [`Micro`]: `f32` with the approximations of the crate `micromath`, refined.
//!
//! micromath trades accuracy for size and speed: its square root is off by 6 %, its arctangent by 2.8e-3 rad, its sine
//! by 1.1e-3. Regions that are computed with these would not contain the exact ones. But they are good initial guesses:
//! Newton's method squares their errors, and three steps for a root or one for an angle reach the last digits of `f32`.
//! There is no such method for sines; those use the polynomials of `f32`.
//!
//! On a core with an FPU `f32` is both faster and more accurate, because its root is one instruction and its arctangent
//! one polynomial; `docs/maintain/firmware.md` of the repository has the figures. This type is for programs that use micromath already and need a
//! guaranteed accuracy.

use super::trig::Trig;
use super::{AccelerationRamp, Angle, AngleSector, Radians, Scalar, Wide};
use core::ops::{Add, Neg, Sub};
use micromath::F32Ext;

/// `f32` with micromath's square root and arctangent, refined by Newton's method.
#[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Micro(
    /// The number.
    pub f32,
);

impl Micro {
    /// Slack in unit roundoffs of the extent: that of `f32`, and more because roots are right to 1.5 last digits
    /// instead of 0.5, and angles to 7 roundoffs instead of 6.
    const SLACK: f32 = 70.0;
}

impl Add for Micro {
    type Output = Self;
    fn add(self, rhs: Self) -> Self {
        Self(self.0 + rhs.0)
    }
}

impl Sub for Micro {
    type Output = Self;
    fn sub(self, rhs: Self) -> Self {
        Self(self.0 - rhs.0)
    }
}

impl Neg for Micro {
    type Output = Self;
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

/// Operations that need neither roots nor angles are those of `f32`.
impl Scalar for Micro {
    type Wide = Self;
    type Unit = f32;
    type Angle = Radians<Self>;

    const ZERO: Self = Self(0.0);
    const LIMIT: Self = Self(<f32 as Scalar>::LIMIT);
    const LEAST: Self = Self(<f32 as Scalar>::LEAST);

    fn is_finite(self) -> bool {
        self.0.is_finite()
    }
    fn times(self, rhs: Self) -> Self {
        Self(self.0 * rhs.0)
    }
    fn scale(self, by: f32) -> Self {
        Self(self.0 * by)
    }
    fn digest(self) -> u32 {
        self.0.to_bits()
    }
    fn millimetres(self) -> u32 {
        self.0.millimetres()
    }
    fn half(self) -> Self {
        Self(0.5 * self.0)
    }
    fn abs(self) -> Self {
        Self(f32::abs(self.0))
    }
    fn quotient(self, divisor: Self) -> Self {
        Self(self.0.quotient(divisor.0))
    }
    fn quotient_unit(self, divisor: f32) -> Option<Self> {
        self.0.quotient_unit(divisor).map(Self)
    }
    fn unit_vector(x: Self, y: Self, norm: Self) -> [f32; 2] {
        f32::unit_vector(x.0, y.0, norm.0)
    }
    fn difference(a: Self, b: Self, squares: Self) -> Self {
        Self(f32::difference(a.0, b.0, squares.0))
    }
    fn quadratic_roots(b: Self, g: Self, doubt: Self) -> Option<[Self; 2]> {
        let discriminant = b.0 * b.0 - g.0;
        if discriminant < 0.0 {
            return (discriminant + doubt.0 >= 0.0).then_some([-b; 2]);
        }
        let q = -(b.0 + sqrt(discriminant).copysign(b.0));
        Some([Self(q), Self(if q == 0.0 { 0.0 } else { g.0 / q })])
    }
    fn half_tangent_roots(
        equations: impl Iterator<Item = [Self; 4]>,
        sector: AngleSector<f32>,
        mut found: impl FnMut(Radians<Self>),
    ) {
        let ([base_cos, base_sin], [middle_cos, middle_sin]) = (sector.from, sector.middle);
        for [a, b, g, doubt] in equations.map(|equation| equation.map(|coefficient| coefficient.0)) {
            let discriminant = b * b - a * g;
            let (two, one) = (discriminant >= 0.0, discriminant + doubt * (a + g).abs() >= 0.0);
            if !(two | one) {
                continue;
            }
            let q = -(b + sqrt(discriminant).copysign(b));
            for (n, m, real) in [(q, a, two || a.abs() > g.abs()), (g, q, two || a.abs() <= g.abs())] {
                let (cos, sin, norm) = (m * m - n * n, 2.0 * (m * n), m * m + n * n);
                let (x, y) = (cos * base_cos - sin * base_sin, sin * base_cos + cos * base_sin);
                if real && x * middle_cos + y * middle_sin >= norm * sector.least {
                    found(Radians(Self(atan2(y, x))));
                }
            }
        }
    }
    fn ramp_length(ramp: AccelerationRamp<Self>, elapsed: Self) -> Self {
        Self((ramp.slow.0 + 0.5 * ramp.acceleration.0 * elapsed.0) * elapsed.0)
    }
    fn ramp_time(ramp: AccelerationRamp<Self>, length: Self) -> Self {
        let fast = sqrt(ramp.slow.0 * ramp.slow.0 + 2.0 * (ramp.acceleration.0 * length.0));
        Self((2.0 * length.0).quotient(ramp.slow.0 + fast))
    }
    fn sum(self, rhs: Self) -> (Self, Self) {
        let (sum, rest) = Scalar::sum(self.0, rhs.0);
        (Self(sum), Self(rest))
    }
    fn sum_up(self, rhs: Self) -> Self {
        Self(self.0.sum_up(rhs.0))
    }
    fn lag(speed: Self, time: Self) -> Self {
        Self(f32::lag(speed.0, time.0))
    }
    fn portion(self, part: Self, whole: Self) -> Self {
        Self(self.0.portion(part.0, whole.0))
    }
    fn rounding(of: Self) -> Self {
        Self(f32::rounding(of.0))
    }
    fn slack(extent: Self) -> Self {
        Self(0.5 * Self::SLACK * f32::EPSILON * extent.0)
    }
}

impl Wide<Self> for Micro {
    const ZERO: Self = Self(0.0);
    fn sqrt(self) -> Self {
        Self(sqrt(self.0))
    }
    fn narrow(self) -> Self {
        self
    }
    fn half(self) -> Self {
        Self(0.5 * self.0)
    }
}

impl Angle<Micro> for Radians<Micro> {
    const ZERO: Self = Radians(Micro(0.0));
    fn is_finite(self) -> bool {
        self.0.0.is_finite()
    }
    fn digest(self) -> u32 {
        Scalar::digest(self.0)
    }
    fn is_in_range(self) -> bool {
        self.0.0.abs() <= 1_024.0
    }
    fn subtended(length: Micro, radius: Micro) -> Self {
        Radians(Micro(length.0 / radius.0))
    }
    fn half_subtended(length: Micro, radius: Micro) -> Self {
        Radians(Micro(0.5 * (length.0 / radius.0)))
    }
    fn subtended_rest(self, length: Micro, radius: Micro) -> Self {
        Radians(Micro(Angle::<f32>::subtended_rest(Radians(self.0.0), length.0, radius.0).0))
    }
    fn sum(self, rhs: Self) -> (Self, Self) {
        let (sum, rest) = Scalar::sum(self.0, rhs.0);
        (Radians(sum), Radians(rest))
    }
    fn sin_cos(self) -> (f32, f32) {
        Trig::sin_cos(self.0.0)
    }
    fn atan2(y: Micro, x: Micro) -> Self {
        Radians(Micro(atan2(y.0, x.0)))
    }
    fn arc_length(self, radius: Micro) -> Micro {
        Micro(self.0.0 * radius.0)
    }
    fn circumference(radius: Micro) -> Micro {
        Micro(core::f32::consts::TAU * radius.0)
    }
}

/// √x; 0 if x is not positive. Right to 1.5 last digits for normal numbers.
fn sqrt(x: f32) -> f32 {
    if x > 0.0 {
        // Heron's step turns a relative error e into e²/2: 6e-2, 1.8e-3, 1.6e-6, 1.3e-12.
        (0..3).fold(F32Ext::sqrt(x), |root, _| 0.5 * (root + x / root))
    } else {
        0.0
    }
}

/// Angle of the vector `(x, y)`, right to 7 unit roundoffs of itself (docs/theory/errors.md); 0 for the zero vector.
fn atan2(y: f32, x: f32) -> f32 {
    use core::f32::consts::PI;
    /// Below this, micromath's squares would lose their digits; above its inverse, they overflow.
    const SMALL: f32 = 1e-12;
    const LARGER: f32 = 1e24;
    if x == 0.0 && y == 0.0 {
        return 0.0;
    }
    let most = x.abs().max(y.abs());
    let scale = if most < SMALL {
        LARGER
    } else if most > 1.0 / SMALL {
        1.0 / LARGER
    } else {
        1.0
    };
    let (y, x) = (scale * y, scale * x);
    // The angle between the guess and the vector, without the cubic term, a third of its cube: for 2.8e-3 that is 7e-9.
    let guess = F32Ext::atan2(y, x);
    let (sin, cos) = Trig::sin_cos(guess);
    (guess + (y * cos - x * sin) / (x * cos + y * sin)).clamp(-PI, PI)
}

#[cfg(test)]
mod tests;
