//! `f32` and `f64`.
//!
//! All functions come from `libm` or from here, so a result has the same bits on every machine; the feature `std`
//! only replaces the square root, which is correctly rounded in both. `f32` never computes in `f64`: libm's own
//! `f32` sine and cosine would, hence the polynomials below. The `f64` arctangent is here because it is a fifth of
//! the kernels' work and libm's divides twice.

use super::{Angle, Scalar, Unit, Wide};
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
    ($t:ident, limit: $limit:literal, slack: $slack:literal, sqrt: $sqrt:path, atan2: $atan2:path, sin_cos: $sin_cos:path) => {
        impl Scalar for $t {
            type Wide = $t;
            type Unit = $t;
            type Angle = Radians<$t>;

            const ZERO: Self = 0.0;
            const LIMIT: Self = $limit;

            fn is_finite(self) -> bool {
                $t::is_finite(self)
            }
            fn times(self, rhs: Self) -> $t {
                self * rhs
            }
            fn scale(self, by: $t) -> Self {
                self * by
            }
            fn half(self) -> Self {
                0.5 * self
            }
            fn abs(self) -> Self {
                $t::abs(self)
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
            fn over_norm(self, norm: Self) -> $t {
                if norm > 0.0 { self / norm } else { 0.0 }
            }
            fn difference(a: Self, b: Self, squares: $t) -> Self {
                if a + b > 0.0 { squares / (a + b) } else { 0.0 }
            }
            fn quadratic_roots(b: Self, g: $t) -> Option<[Self; 2]> {
                // -b ∓ √(b² - g) with the sign that adds magnitudes; the other root from their product g.
                let discriminant = b * b - g;
                if discriminant < 0.0 {
                    return None;
                }
                let q = -(b + $sqrt(discriminant).copysign(b));
                Some([q, if q == 0.0 { 0.0 } else { g / q }])
            }
            fn half_tangent_roots(a: $t, b: $t, g: $t) -> Option<[Radians<$t>; 2]> {
                let discriminant = b * b - a * g;
                if discriminant < 0.0 {
                    return None;
                }
                // τ = q/a and τ = g/q, left as fractions: a = 0 is the far end of the diameter (τ = ∞).
                let q = -(b + $sqrt(discriminant).copysign(b));
                let angle = |n: $t, m: $t| {
                    let (n, m) = if m < 0.0 { (-n, -m) } else { (n, m) };
                    Radians(2.0 * $atan2(n, m))
                };
                Some([angle(q, a), angle(g, q)])
            }
            fn slack(extent: Self) -> Self {
                0.5 * $slack * $t::EPSILON * extent
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
        }

        impl Unit for $t {
            const ZERO: Self = 0.0;
            const ONE: Self = 1.0;
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
            fn half(self) -> Self {
                Radians(0.5 * self.0)
            }
            fn subtended(length: $t, radius: $t) -> Self {
                Radians(length / radius)
            }
            fn sin_cos(self) -> ($t, $t) {
                $sin_cos(self.0)
            }
            fn atan2(y: $t, x: $t) -> Self {
                Radians($atan2(y, x))
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

// `slack` in unit roundoffs of the extent.
impl_float!(f64, limit: 1e12, slack: 8.0, sqrt: sqrt_f64, atan2: atan2_f64, sin_cos: libm::sincos);
impl_float!(f32, limit: 1e6, slack: 16.0, sqrt: sqrt_f32, atan2: libm::atan2f, sin_cos: sin_cos_f32);

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
    #[cfg(not(feature = "std"))]
    libm::sqrtf(x)
}

/// Angle of the vector `(x, y)`, absolute error below 1e-15; signed zeros as in C.
///
/// With one division: the angle of the smaller to the larger component, less an eighth of a turn where it is nearer to
/// that, is `atan(t)` with `|t| <= tan(π/8)`, where the polynomial of fdlibm's `atan` (Sun 1993) holds.
fn atan2_f64(y: f64, x: f64) -> f64 {
    use core::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};
    const TAN_PI_8: f64 = 0.414_213_562_373_095_03;
    const ODD: [f64; 6] = [
        3.333_333_333_333_293e-1,
        1.428_571_427_250_346_6e-1,
        9.090_887_133_436_507e-2,
        6.661_073_137_387_531e-2,
        4.976_877_994_615_932e-2,
        1.628_582_011_536_578_2e-2,
    ];
    const EVEN: [f64; 5] = [
        -1.999_999_999_987_648_3e-1,
        -1.111_111_040_546_235_6e-1,
        -7.691_876_205_044_83e-2,
        -5.833_570_133_790_573_5e-2,
        -3.653_157_274_421_691_6e-2,
    ];
    let (small, large) = if y.abs() > x.abs() { (x.abs(), y.abs()) } else { (y.abs(), x.abs()) };
    let (n, m, eighth) =
        if small > TAN_PI_8 * large { (small - large, small + large, FRAC_PI_4) } else { (small, large, 0.0) };
    let t = if m > 0.0 { n / m } else { 0.0 };
    let z = t * t;
    let w = z * z;
    let odd = ODD[0] + w * (ODD[1] + w * (ODD[2] + w * (ODD[3] + w * (ODD[4] + w * ODD[5]))));
    let even = EVEN[0] + w * (EVEN[1] + w * (EVEN[2] + w * (EVEN[3] + w * EVEN[4])));
    let octant = eighth + (t - t * (z * odd + w * even));
    let quadrant = if y.abs() > x.abs() { FRAC_PI_2 - octant } else { octant };
    let half = if x.is_sign_negative() { PI - quadrant } else { quadrant };
    half.copysign(y)
}

/// Sine and cosine in `f32` arithmetic, absolute error below 1.2e-7 for `|x| <= 128`: twenty turns.
///
/// Reduction by quarter turns in three parts (Cody and Waite), then the minimax polynomials of Cephes'
/// `sinf`/`cosf` (Moshier 1989) on `[-π/4, π/4]`.
fn sin_cos_f32(x: f32) -> (f32, f32) {
    const PARTS: [f32; 3] = [1.570_312_5, 4.837_513e-4, 7.549_79e-8];
    let turns = x * core::f32::consts::FRAC_2_PI;
    let quarter = if turns < 0.0 { turns - 0.5 } else { turns + 0.5 } as i32;
    let k = quarter as f32;
    let r = ((x - k * PARTS[0]) - k * PARTS[1]) - k * PARTS[2];
    let z = r * r;
    let sin = r + r * z * (-1.666_665_5e-1 + z * (8.332_161e-3 + z * -1.951_529_6e-4));
    let cos = 1.0 - 0.5 * z + z * z * (4.166_664_6e-2 + z * (-1.388_731_6e-3 + z * 2.443_315_7e-5));
    match quarter & 3 {
        0 => (sin, cos),
        1 => (cos, -sin),
        2 => (-sin, -cos),
        _ => (-cos, sin),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Bound on the error of `sin_cos_f32` for arguments up to 128 rad in magnitude.
    const SIN_COS_F32_ERROR: f64 = 1.2e-7;

    #[test]
    fn sin_cos_f32_stays_within_its_bound() {
        let mut worst = 0.0_f64;
        for step in -2_000_003_i32..=2_000_003 {
            let x = step as f32 * 6.4e-5;
            let (sin, cos) = sin_cos_f32(x);
            let (exact_sin, exact_cos) = libm::sincos(f64::from(x));
            worst = worst.max((f64::from(sin) - exact_sin).abs()).max((f64::from(cos) - exact_cos).abs());
        }
        assert!(worst < SIN_COS_F32_ERROR, "largest error {worst:e}");
        assert!(worst > 0.2 * SIN_COS_F32_ERROR, "the stated bound is idle: largest error {worst:e}");
    }

    #[test]
    fn atan2_f64_stays_within_its_bound() {
        let mut worst = 0.0_f64;
        for step in 0..2_000_003_u32 {
            // Every direction, at lengths from 1e-8 to 1e8.
            let (sin, cos) = libm::sincos(f64::from(step) * 3.141_6e-6);
            let length = libm::exp10(f64::from(step % 17) - 8.0);
            let (y, x) = (length * sin, length * cos);
            worst = worst.max((atan2_f64(y, x) - libm::atan2(y, x)).abs());
        }
        assert!(worst < 1e-15, "largest error {worst:e}");
        for (y, x) in
            [(0.0, 0.0), (0.0, 1.0), (0.0, -1.0), (-0.0, 1.0), (-0.0, -1.0), (1.0, 0.0), (-1.0, 0.0), (1.0, 1.0)]
        {
            assert_eq!(atan2_f64(y, x).to_bits(), libm::atan2(y, x).to_bits(), "atan2({y}, {x})");
        }
        for tiny in [1e-300, 1e-20] {
            assert_eq!(atan2_f64(tiny, 1.0), tiny);
        }
    }

    #[test]
    fn quadratics_keep_the_small_root() {
        // u² - 2e4 u + 1 = 0: the naive small root of f32 is 0.
        let [large, small] = f32::quadratic_roots(-1e4, 1.0).unwrap();
        assert_eq!((large, small), (2e4, 5e-5));
        assert_eq!(f64::quadratic_roots(0.0, 1.0), None);
        assert_eq!(f64::quadratic_roots(0.0, 0.0), Some([-0.0, 0.0]));
    }

    #[test]
    fn half_tangent_roots_reach_the_far_end_of_the_diameter() {
        // τ² - 1 = 0: ± a quarter turn; a = 0: τ = ∞ is half a turn.
        let quarter = core::f64::consts::FRAC_PI_2;
        let [r, s] = f64::half_tangent_roots(1.0, 0.0, -1.0).unwrap();
        assert!((r.0.abs() - quarter).abs() < 1e-15 && (r.0 + s.0).abs() < 1e-15);
        let [r, s] = f64::half_tangent_roots(0.0, 1.0, 0.0).unwrap();
        assert!((r.0.abs() - 2.0 * quarter).abs() < 1e-15 && s.0 == 0.0);
    }

    #[test]
    fn differences_of_close_numbers_do_not_cancel() {
        // √(1e8 + 1) - 1e4 = 5e-5 - 1.25e-13
        let a = (1e8_f64 + 1.0).sqrt();
        assert!((f64::difference(a, 1e4, 1.0) - 4.999_999_987_5e-5).abs() < 1e-19);
        assert_eq!(f32::difference(0.0, 0.0, 0.0), 0.0);
    }
}
