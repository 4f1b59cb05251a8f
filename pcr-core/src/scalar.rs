//! The number formats: what the closed forms ask of a number, and nothing else.
//!
//! One algorithm serves every format. It is written over four types that belong together, so that a length
//! cannot be confused with a product of lengths, nor with a cosine:
//!
//! | type | holds | example in fixed point |
//! |---|---|---|
//! | [`Scalar`] | lengths \[m\], times \[s\], speeds \[m/s\], accelerations \[m/s²\] | Q16.16 in 32 bits |
//! | [`Scalar::Wide`] | a product of two of them, not narrowed | Q32.32 in 64 bits |
//! | [`Scalar::Unit`] | sines, cosines, components of unit vectors | Q2.30 in 32 bits |
//! | [`Scalar::Angle`] | angles, modulo one turn or in radians | binary turns in 32 bits |
//!
//! A few methods are named after the equation they solve (`difference`, `quadratic_roots`,
//! `half_tangent_roots`) rather than after an operator: which form of the solution is free of cancellation
//! depends on the format, and this is the only place where a format may differ.
//!
//! A product of lengths is not a length, and formats do not mix:
//!
//! ```compile_fail,E0308
//! fn area<S: pcr_core::Scalar>(a: S, b: S) -> S {
//!     a.times(b) // a `Wide`
//! }
//! ```
//! ```compile_fail,E0369
//! fn area<S: pcr_core::Scalar>(a: S, b: S) -> S {
//!     a * b // no such operator
//! }
//! ```
//! ```compile_fail,E0308
//! # use pcr_core::Point;
//! let p: Point<f64> = Point::new(0.0_f32, 0.0_f32);
//! ```

use core::fmt::Debug;
use core::ops::{Add, Neg, Sub};

#[cfg(feature = "libm")]
mod float;
#[cfg(feature = "libm")]
pub use float::Radians;

/// Number format of the closed forms: lengths, times, speeds and accelerations in SI units.
///
/// Implemented for `f32` and `f64` with the feature `libm`. The operators neither panic nor overflow for the
/// values that the constructors of this crate let through (magnitudes up to [`Scalar::LIMIT`]).
pub trait Scalar:
    Copy + PartialEq + PartialOrd + Debug + Default + Add<Output = Self> + Sub<Output = Self> + Neg<Output = Self> + 'static
{
    /// Product of two scalars, not narrowed.
    type Wide: Wide<Self>;
    /// Sine, cosine, or component of a unit vector.
    type Unit: Unit;
    /// Plane angle, counter-clockwise positive.
    type Angle: Angle<Self>;

    /// Zero.
    const ZERO: Self;
    /// Largest magnitude of a coordinate, length, radius, time, speed or acceleration that constructors accept.
    const LIMIT: Self;

    /// Neither NaN nor infinite. Fixed-point formats are always finite.
    fn is_finite(self) -> bool;
    /// `self · rhs`, wide.
    fn times(self, rhs: Self) -> Self::Wide;
    /// `self · by`, rounded to nearest.
    fn scale(self, by: Self::Unit) -> Self;
    /// `self / 2`.
    fn half(self) -> Self;
    /// `2 self`.
    fn double(self) -> Self {
        self + self
    }
    /// Absolute value.
    fn abs(self) -> Self {
        if self < Self::ZERO { -self } else { self }
    }
    /// The smaller of two numbers.
    fn min(self, rhs: Self) -> Self {
        if rhs < self { rhs } else { self }
    }
    /// The larger of two numbers.
    fn max(self, rhs: Self) -> Self {
        if rhs > self { rhs } else { self }
    }
    /// `self` limited to `[lo, hi]`.
    fn clamp(self, lo: Self, hi: Self) -> Self {
        self.max(lo).min(hi)
    }
    /// `self / divisor` for dimensions that divide (a length by a speed). Saturates at a magnitude above
    /// [`Scalar::LIMIT`]; `0 / 0` is 0.
    fn quotient(self, divisor: Self) -> Self;
    /// `self / divisor` for a sine or cosine, `None` where it is not below [`Scalar::LIMIT`].
    fn quotient_unit(self, divisor: Self::Unit) -> Option<Self>;
    /// Component of a unit vector: `self / norm` with `|self| <= norm`; 0 for a zero norm.
    fn over_norm(self, norm: Self) -> Self::Unit;
    /// `a - b` for two non-negative numbers, given `a² - b²` as well, without cancellation.
    fn difference(a: Self, b: Self, squares: Self::Wide) -> Self;
    /// Both roots of `u² + 2 b u + g = 0`, `None` if they are not real.
    fn quadratic_roots(b: Self, g: Self::Wide) -> Option<[Self; 2]>;
    /// Both angles `2 atan τ` in `[-π, π]` with `a τ² + 2 b τ + g = 0`, `None` if they are not real.
    fn half_tangent_roots(a: Self::Wide, b: Self::Wide, g: Self::Wide) -> Option<[Self::Angle; 2]>;
    /// The residual that rounding may cause in a configuration of the given extent: every distance that the
    /// kernels compare with a radius is right within this. `docs/errors.md` states it for each format.
    fn slack(extent: Self) -> Self;
}

/// Product of two [`Scalar`]s.
pub trait Wide<S>: Copy + PartialOrd + Debug + Add<Output = Self> + Sub<Output = Self> + Neg<Output = Self> {
    /// Zero.
    const ZERO: Self;
    /// Square root, 0 for a negative argument.
    fn sqrt(self) -> S;
    /// The product as a scalar, rounded to nearest: a speed times a time is a length.
    fn narrow(self) -> S;
    /// `2 self`.
    fn double(self) -> Self {
        self + self
    }
}

/// Sine or cosine.
pub trait Unit: Copy + PartialOrd + Debug + Add<Output = Self> + Sub<Output = Self> + Neg<Output = Self> {
    /// Zero.
    const ZERO: Self;
    /// One.
    const ONE: Self;
    /// `self · rhs`, rounded to nearest.
    fn times(self, rhs: Self) -> Self;
    /// Absolute value.
    fn abs(self) -> Self {
        if self < Self::ZERO { -self } else { self }
    }
}

/// Plane angle, counter-clockwise positive.
pub trait Angle<S: Scalar>:
    Copy + PartialOrd + Debug + Add<Output = Self> + Sub<Output = Self> + Neg<Output = Self>
{
    /// The zero angle.
    const ZERO: Self;
    /// Neither NaN nor infinite.
    fn is_finite(self) -> bool;
    /// `self / 2`.
    fn half(self) -> Self;
    /// The angle that an arc of this length and radius subtends. The radius is positive.
    fn subtended(length: S, radius: S) -> Self;
    /// Sine and cosine.
    fn sin_cos(self) -> (S::Unit, S::Unit);
    /// Angle of the vector `(x, y)` in `[-π, π]`; 0 for the zero vector.
    fn atan2(y: S, x: S) -> Self;
    /// Signed length of the arc of this radius that subtends the angle.
    fn arc_length(self, radius: S) -> S;
    /// Length of a full circle of this radius, at most [`Scalar::LIMIT`] times a small constant.
    fn circumference(radius: S) -> S;
}
