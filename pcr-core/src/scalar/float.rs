//! The formats `f32` and `f64`.
//!
//! All functions come from `libm` or from `trig`, so results have the same bits on every machine. The feature `std` and
//! the FPU of a Cortex-M only replace the square root, which is correctly rounded everywhere. `f32` never computes in
//! `f64`.

use super::trig::Trig;
use super::{AccelerationRamp, Angle, AngleSector, Scalar, Unit, Wide};
use crate::array_vec::ArrayVec;
use core::ops::{Add, Neg, Sub};

/// Angle in radians.
#[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Radians<T>(
    /// The angle \[rad\].
    pub T,
);

impl<T: Add<Output = T>> Add for Radians<T> {
    type Output = Self;
    fn add(self, rhs: Self) -> Self {
        Self(self.0 + rhs.0)
    }
}

impl<T: Sub<Output = T>> Sub for Radians<T> {
    type Output = Self;
    fn sub(self, rhs: Self) -> Self {
        Self(self.0 - rhs.0)
    }
}

impl<T: Neg<Output = T>> Neg for Radians<T> {
    type Output = Self;
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

macro_rules! impl_float {
    ($t:ident, bits: $bits:ident, limit: $limit:literal, heading: $heading:literal, least: $least:literal, split: $split:literal, tolerance: $tolerance:literal, sqrt: $sqrt:path) => {
        impl Scalar for $t {
            type Wide = $t;
            type Unit = $t;
            type Angle = Radians<$t>;

            const ZERO: Self = 0.0;
            const LIMIT: Self = $limit;
            const LEAST: Self = $least;

            fn is_finite(self) -> bool {
                $t::is_finite(self)
            }
            fn times(self, rhs: Self) -> $t {
                self * rhs
            }
            fn scale(self, by: $t) -> Self {
                self * by
            }
            fn digest(self) -> u32 {
                // All bits of `f32`; the two halves of `f64` combined: a shift by 0 or 32.
                let bits = u64::from(self.to_bits());
                (bits ^ (bits >> 32)) as u32
            }
            fn millimetres(self) -> u32 {
                // A cast saturates.
                (1e3 * self) as u32
            }
            fn half(self) -> Self {
                0.5 * self
            }
            fn abs(self) -> Self {
                $t::abs(self)
            }
            fn negate_if(self, negated: bool) -> Self {
                $t::from_bits(self.to_bits() ^ (<$bits>::from(negated) << ($bits::BITS - 1)))
            }
            fn sum(self, rhs: Self) -> (Self, Self) {
                // Knuth's two-sum; exact whatever the order of magnitudes.
                let sum = self + rhs;
                let added = sum - self;
                (sum, (self - (sum - added)) + (rhs - added))
            }
            fn sum_up(self, rhs: Self) -> Self {
                let (sum, rest) = Scalar::sum(self, rhs);
                if rest > 0.0 { sum.next_up() } else { sum }
            }
            fn quotient(self, divisor: Self) -> Self {
                if self == 0.0 {
                    return 0.0;
                }
                (self / divisor).clamp(-2.0 * Self::LIMIT, 2.0 * Self::LIMIT)
            }
            fn quotient_unit(self, divisor: $t) -> Option<Self> {
                let quotient = self / divisor;
                (quotient.abs() < Self::LIMIT).then_some(quotient)
            }
            fn unit_vector(x: Self, y: Self, norm: Self) -> [$t; 2] {
                [x / norm, y / norm]
            }
            fn difference(a: Self, b: Self, squares: $t) -> Self {
                if a + b > 0.0 { squares / (a + b) } else { 0.0 }
            }
            fn quadratic_roots(b: Self, g: $t, doubt: $t) -> Option<[Self; 2]> {
                // -b ∓ √(b² - g) with the sign that adds magnitudes; the other root is g divided by this one.
                let discriminant = b * b - g;
                if discriminant < 0.0 {
                    return (discriminant + doubt >= 0.0).then_some([-b; 2]);
                }
                let q = -(b + $sqrt(discriminant).copysign(b));
                Some([q, if q == 0.0 { 0.0 } else { g / q }])
            }
            fn half_tangent_roots(
                equations: impl Iterator<Item = [$t; 4]>,
                sector: AngleSector<$t>,
                mut found: impl FnMut(Radians<$t>),
            ) {
                let mut vectors = ArrayVec::<_, 4>::new([0.0; 2]);
                let ([base_cos, base_sin], [middle_cos, middle_sin]) = (sector.from, sector.middle);
                for [a, b, g, doubt] in equations {
                    let discriminant = b * b - a * g;
                    // τ = q/a and τ = g/q, kept as fractions: a = 0 is the far end of the diameter (τ = ∞).
                    let q = -(b + Wide::<$t>::sqrt(discriminant).copysign(b));
                    let mut add = |n: $t, m: $t, real: bool| {
                        // The cosine and sine of 2 atan(n/m), and their common denominator.
                        let (cos, sin, norm) = (m * m - n * n, 2.0 * (m * n), m * m + n * n);
                        let (x, y) = (cos * base_cos - sin * base_sin, sin * base_cos + cos * base_sin);
                        vectors.add([y, x], real & (x * middle_cos + y * middle_sin >= norm * sector.least));
                    };
                    // Real only because of `doubt`: a double root, -b/a = -g/b, computed with the larger of the two
                    // uncertain coefficients.
                    let (two, larger) = (discriminant >= 0.0, a.abs() > g.abs());
                    let one = discriminant + doubt * (a + g).abs() >= 0.0;
                    add(q, a, two | (one & larger));
                    add(g, q, two | (one & !larger));
                }
                Trig::angles(vectors.as_slice(), |angle| found(Radians(angle)));
            }
            fn ramp_length(ramp: AccelerationRamp<Self>, elapsed: Self) -> Self {
                (ramp.slow + 0.5 * ramp.acceleration * elapsed) * elapsed
            }
            fn ramp_time(ramp: AccelerationRamp<Self>, length: Self) -> Self {
                if ramp.acceleration == 0.0 {
                    return length.quotient(ramp.slow);
                }
                // Δt = 2 Δl / (v + √(v² + 2 a Δl))
                let fast = Wide::<$t>::sqrt(ramp.slow * ramp.slow + 2.0 * (ramp.acceleration * length));
                (2.0 * length).quotient(ramp.slow + fast)
            }
            fn portion(self, part: Self, whole: Self) -> Self {
                self * (part / whole)
            }
            fn tolerance(extent: Self) -> Self {
                $tolerance * extent
            }
            fn slack(extent: Self) -> Self {
                0.5 * SLACK as $t * $t::EPSILON * extent
            }
            fn rounding(of: Self) -> Self {
                2.0 * $t::EPSILON * of
            }
            fn lag(speed: Self, time: Self) -> Self {
                // One roundoff of the time for the elapsed time, two for the two ends of a phase, two for the place of
                // a stop, one for a phase without duration.
                4.0 * $t::EPSILON * speed * time
            }
        }

        impl Wide<$t> for $t {
            const ZERO: Self = 0.0;
            fn sqrt(self) -> $t {
                if self > 0.0 { $sqrt(self) } else { 0.0 }
            }
            fn narrow(self) -> $t {
                self
            }
            fn half(self) -> $t {
                0.5 * self
            }
        }

        impl Unit for $t {
            const ZERO: Self = 0.0;
            const ONE: Self = 1.0;
            const COARSE: Self = 1024.0 * $t::EPSILON;
            fn times(self, rhs: Self) -> Self {
                self * rhs
            }
            fn abs(self) -> Self {
                $t::abs(self)
            }
        }

        impl Angle<$t> for Radians<$t> {
            const ZERO: Self = Radians(0.0);
            fn is_finite(self) -> bool {
                self.0.is_finite()
            }
            fn digest(self) -> u32 {
                Scalar::digest(self.0)
            }
            fn is_in_range(self) -> bool {
                self.0.abs() <= $heading
            }
            fn subtended(length: $t, radius: $t) -> Self {
                Radians(length / radius)
            }
            fn half_subtended(length: $t, radius: $t) -> Self {
                Radians(0.5 * (length / radius))
            }
            fn subtended_rest(self, length: $t, radius: $t) -> Self {
                // The remainder of the division, exact by Dekker's product.
                let halves = |x: $t| {
                    let t = $split * x;
                    let high = t - (t - x);
                    (high, x - high)
                };
                let product = self.0 * radius;
                let ((a, b), (c, d)) = (halves(self.0), halves(radius));
                let error = ((a * c - product) + a * d + b * c) + b * d;
                Radians(((length - product) - error) / radius)
            }
            fn sum(self, rhs: Self) -> (Self, Self) {
                let (sum, rest) = Scalar::sum(self.0, rhs.0);
                (Radians(sum), Radians(rest))
            }
            fn sin_cos(self) -> ($t, $t) {
                Trig::sin_cos(self.0)
            }
            fn atan2(y: $t, x: $t) -> Self {
                Radians(Trig::atan2(y, x))
            }
            fn atan2_each(y: [$t; 2], x: [$t; 2]) -> [Self; 2] {
                Trig::atan2_each(y, x).map(Radians)
            }
            fn arc_length(self, radius: $t) -> $t {
                self.0 * radius
            }
            fn circumference(radius: $t) -> $t {
                core::$t::consts::TAU * radius
            }
        }
    };
}

/// Slack in unit roundoffs of the extent: the sum of the worst cases, docs/theory/errors.md.
const SLACK: u8 = 64;

// `tolerance` 2^-32 and 2^-16 of the extent; `split` is 1 more than the power of 2 that halves a significand.
impl_float!(f64, bits: u64, limit: 1e12, heading: 16_777_216.0, least: 1e-75, split: 134_217_729.0, tolerance: 2.328_306_436_538_696_3e-10, sqrt: sqrt_f64);
impl_float!(f32, bits: u32, limit: 1e6, heading: 1_024.0, least: 1e-9, split: 4_097.0, tolerance: 1.525_878_9e-5, sqrt: sqrt_f32);

#[cfg(feature = "std")]
extern crate std;

fn sqrt_f64(x: f64) -> f64 {
    #[cfg(feature = "std")]
    return x.sqrt();
    #[cfg(not(feature = "std"))]
    libm::sqrt(x)
}

fn sqrt_f32(x: f32) -> f32 {
    #[cfg(feature = "std")]
    return x.sqrt();
    #[cfg(all(not(feature = "std"), target_arch = "arm", target_abi = "eabihf"))]
    return super::vsqrt::sqrt(x);
    #[cfg(all(not(feature = "std"), not(all(target_arch = "arm", target_abi = "eabihf"))))]
    libm::sqrtf(x)
}

#[cfg(test)]
mod tests;
