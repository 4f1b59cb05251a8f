//! Traits for number formats: the operations that the closed forms need.
//!
//! One algorithm serves every format. It is generic over four types that belong together, so that the compiler does not
//! confuse a length with a product of lengths, or with a cosine:
//!
//! | type | holds | example in fixed point |
//! |---|---|---|
//! | [`Scalar`] | lengths \[m\], times \[s\], speeds \[m/s\], accelerations \[m/s²\] | Q16.16 in 32 bits |
//! | [`Scalar::Wide`] | a product of two of them, not narrowed | Q32.32 in 64 bits |
//! | [`Scalar::Unit`] | sines, cosines, components of unit vectors | Q2.30 in 32 bits |
//! | [`Scalar::Angle`] | angles, modulo one turn or in radians | binary turns in 32 bits |
//!
//! Some methods are named after the equation that they solve (`difference`, `quadratic_roots`, `half_tangent_roots`)
//! and not after an operator. Which form of the solution is free of cancellation depends on the format, and these
//! methods are the only place where formats may differ.
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
#[cfg(feature = "micromath")]
mod micro;
#[cfg(feature = "libm")]
mod trig;
#[cfg(feature = "libm")]
pub use float::Radians;
#[cfg(feature = "micromath")]
pub use micro::Micro;
#[cfg(all(feature = "libm", not(feature = "std"), target_arch = "arm", target_abi = "eabihf"))]
mod vsqrt;

/// A number format for the closed forms: lengths, times, speeds and accelerations in SI units.
///
/// Implemented for `f32` and `f64` with the feature `libm`. The operators neither panic nor overflow for values that
/// the constructors of this crate accept (magnitudes up to [`Scalar::LIMIT`]).
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
    /// Largest magnitude of a coordinate, length, radius, time, speed or acceleration that constructors accept. The
    /// diameter of an arc counts as a length, and its box as coordinates.
    const LIMIT: Self;
    /// Least radius of a disc or an arc. A product of four radii, as in the discriminants of P3, then keeps all its
    /// digits; smaller radii would lose digits to underflow, and contacts with them. Coordinates may be 0 or arbitrarily
    /// small, because they are only added, compared, and multiplied by radii. A length of a path below the square of
    /// this is taken as 0, which moves no position by a representable amount.
    const LEAST: Self;

    /// Neither NaN nor infinite. Fixed-point formats are always finite.
    fn is_finite(self) -> bool;
    /// The bits of the number, folded to 32, for a checksum.
    fn digest(self) -> u32;
    /// A length in whole millimetres, for messages; rounded down to 0, and saturating at the largest `u32`.
    fn millimetres(self) -> u32;
    /// `self · rhs`, wide.
    fn times(self, rhs: Self) -> Self::Wide;
    /// `self · by`, rounded to nearest.
    fn scale(self, by: Self::Unit) -> Self;
    /// `a u + b v`, a component of a rotated vector. Fixed point rounds once.
    fn combine(a: Self, u: Self::Unit, b: Self, v: Self::Unit) -> Self {
        a.scale(u) + b.scale(v)
    }
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
    /// `-self` if `negated`. Without a branch, because processors cannot predict which way an arc turns.
    fn negate_if(self, negated: bool) -> Self {
        if negated { -self } else { self }
    }
    /// The smaller of two numbers.
    fn min(self, rhs: Self) -> Self {
        if rhs < self { rhs } else { self }
    }
    /// The larger of two numbers.
    fn max(self, rhs: Self) -> Self {
        if rhs > self { rhs } else { self }
    }
    /// `self + rhs` and its rounding error, which is 0 in a format that adds exactly.
    fn sum(self, rhs: Self) -> (Self, Self) {
        (self + rhs, Self::ZERO)
    }
    /// `self + rest + length · by`, a coordinate at the end of a line, and its rounding error: the `rest` of the next
    /// call, in a unit that the format chooses.
    fn advance(self, rest: Self, length: Self, by: Self::Unit) -> (Self, Self) {
        self.sum(length.scale(by) + rest)
    }
    /// `self + rhs`, rounded up. A format that does not add exactly has to override it, like [`Scalar::sum`].
    fn sum_up(self, rhs: Self) -> Self {
        self + rhs
    }
    /// `self` clamped to `[lo, hi]`.
    fn clamp(self, lo: Self, hi: Self) -> Self {
        self.max(lo).min(hi)
    }
    /// `self / divisor` for quantities of different dimensions (a length by a speed). Saturates at a magnitude above
    /// [`Scalar::LIMIT`]; `0 / 0` is 0.
    fn quotient(self, divisor: Self) -> Self;
    /// `self · part / whole`, with `whole` above 0. A format of constant absolute precision should round once, at the
    /// end: an intermediate quotient would not have enough digits, and the product may exceed the range. If `part` is
    /// larger than `whole`, it saturates like [`Scalar::quotient`].
    fn portion(self, part: Self, whole: Self) -> Self;
    /// `self / divisor` for a sine or cosine; `None` if the result is not below [`Scalar::LIMIT`].
    fn quotient_unit(self, divisor: Self::Unit) -> Option<Self>;
    /// The vector `(x, y)` as a unit vector; `norm` is its norm, which is not zero. A format of constant absolute
    /// precision computes the norm from the components, because a norm of a few last digits would be too inaccurate.
    fn unit_vector(x: Self, y: Self, norm: Self) -> [Self::Unit; 2];
    /// `a - b` for two non-negative numbers, without cancellation; `squares` is `a² - b²`.
    fn difference(a: Self, b: Self, squares: Self::Wide) -> Self;
    /// Both roots of `u² + 2 b u + g = 0`, `None` if they are not real. If they would be real only with an error of up
    /// to `doubt` in `g`, a double root.
    fn quadratic_roots(b: Self, g: Self::Wide, doubt: Self::Wide) -> Option<[Self; 2]>;
    /// Calls `found` with the angles `φ + 2 atan τ` for all real `τ` of the equations `a τ² + 2 b τ + g = 0`, each
    /// given as `[a, b, g, doubt]`. `φ` is the angle of `sector.from`; angles outside of the sector may be left out. If
    /// roots would be real only with an error of up to `doubt` in both `a` and `g`, one root. At most two equations;
    /// angles are in `[-π, π]`.
    fn half_tangent_roots(
        equations: impl Iterator<Item = [Self::Wide; 4]>,
        sector: AngleSector<Self::Unit>,
        found: impl FnMut(Self::Angle),
    );
    /// The vector from the start of an arc to its point after twice the angle `half`: `2ϱ sin(h) e(ϑ ± h)`. `direction`
    /// is `(cos ϑ, sin ϑ)` at the start. Fixed point rounds once.
    fn chord(radius: Self, half: Self::Angle, right: bool, direction: [Self::Unit; 2]) -> [Self; 2] {
        let (sin, cos) = half.sin_cos();
        let chord = radius.double().scale(sin);
        let across = chord.scale(sin);
        let (along, across) = (chord.scale(cos), across.negate_if(right));
        let [cos, sin] = direction;
        [Self::combine(along, cos, across, -sin), Self::combine(along, sin, across, cos)]
    }
    /// Length travelled in the time `elapsed` since the slow end of a ramp.
    fn ramp_length(ramp: AccelerationRamp<Self>, elapsed: Self) -> Self;
    /// Time since the slow end of a ramp after which `length` is travelled: the inverse of [`Scalar::ramp_length`].
    fn ramp_time(ramp: AccelerationRamp<Self>, length: Self) -> Self;
    /// Largest distance \[m\] of the map from time to length on a ramp from a line, over a part of the ramp that takes `duration`: h²/8 times
    /// its second derivative. It is that of the map as it is computed; fixed point rounds it to nearest.
    fn ramp_bulge(ramp: AccelerationRamp<Self>, duration: Self) -> Self {
        let gain = ramp.acceleration.times(duration).narrow();
        gain.times(duration).narrow().half().half().half()
    }
    /// Whether two ramps have the same second derivative, so that lengths on them differ by a linear function of the time.
    fn ramps_alike(one: AccelerationRamp<Self>, other: AccelerationRamp<Self>) -> bool {
        one.acceleration == other.acceleration
    }
    /// Bound on the rounding error of every distance that the kernels compare with a radius, in a configuration of the
    /// given extent ([`Motion::extent`](crate::Motion::extent)). `docs/theory/errors.md` derives it for each format.
    fn slack(extent: Self) -> Self;
    /// Bound on the rounding error of a sum, a product or a quotient of a few numbers of this magnitude.
    fn rounding(of: Self) -> Self;
    /// Bound on the error of a path of this number of arcs that cannot be carried over from one arc to the next, including the
    /// rounding of angles. `span` is the extent of the path plus the largest diameter of an arc.
    fn drift(arcs: usize, span: Self) -> Self {
        let _ = (arcs, span);
        Self::ZERO
    }
    /// Bound on the distance by which the rounding of times up to `time`, of phases and of a query, moves an agent of
    /// this speed; 0 in a format that adds exactly.
    fn lag(speed: Self, time: Self) -> Self {
        let _ = (speed, time);
        Self::ZERO
    }
    /// Distance at which a search for a contact stops, in a configuration of the given extent: discs this close to each
    /// other may be reported as touching. It is not an error bound but a choice, because a smaller value takes more
    /// steps. At least two slacks.
    fn tolerance(extent: Self) -> Self {
        Self::slack(extent).double().double().double().double()
    }
}

/// Motion at constant acceleration, described from its slow end, where neither map between time and length cancels.
///
/// The acceleration follows from the other fields, up to its rounding. Floating point computes with it. In fixed point its rounding error
/// would count multiplied by half the square of the elapsed time, so the maps interpolate between both ends of the ramp
/// instead.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct AccelerationRamp<S> {
    /// Speed at the slow end \[m/s\].
    pub slow: S,
    /// Speed at the fast end \[m/s\].
    pub fast: S,
    /// Magnitude of the acceleration \[m/s²\].
    pub acceleration: S,
    /// Time between the ends \[s\].
    pub duration: S,
    /// Length between the ends \[m\].
    pub length: S,
}

/// The origin from which angles are counted, and the range of angles that are needed: those whose cosine to a direction
/// is at least `least`, which is where an arc lies on its circle. With it, angles can be discarded without computing an
/// arctangent.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct AngleSector<U> {
    /// Cosine and sine of the angle that is the origin.
    pub from: [U; 2],
    /// Cosine and sine of the middle of the range.
    pub middle: [U; 2],
    /// Cosine of half the width of the range, reduced by at least [`Unit::COARSE`].
    pub least: U,
}

impl<U: Unit> AngleSector<U> {
    /// The range of all angles.
    pub fn all(from: [U; 2]) -> Self {
        Self { from, middle: [U::ONE, U::ZERO], least: -U::ONE - U::COARSE }
    }
}

/// Product of two [`Scalar`]s.
pub trait Wide<S>: Copy + PartialOrd + Debug + Add<Output = Self> + Sub<Output = Self> + Neg<Output = Self> {
    /// Zero.
    const ZERO: Self;
    /// Square root, 0 for a negative argument.
    fn sqrt(self) -> S;
    /// The product as a scalar, rounded to nearest; for example, a speed times a time is a length. Saturates at a
    /// magnitude above [`Scalar::LIMIT`] instead of overflowing.
    fn narrow(self) -> S;
    /// `self / 2`.
    fn half(self) -> Self;
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
    /// A bound on the error with which angles are compared with a sector.
    const COARSE: Self;
    /// `self · rhs`, rounded to nearest.
    fn times(self, rhs: Self) -> Self;
    /// `a u + b v`, as [`Scalar::combine`].
    fn combine(a: Self, u: Self, b: Self, v: Self) -> Self {
        a.times(u) + b.times(v)
    }
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
    /// The bits of the angle, folded to 32, for a checksum.
    fn digest(self) -> u32;
    /// Whether a heading with this number of turns still has an accurate direction; always if angles are modulo one turn.
    fn is_in_range(self) -> bool {
        true
    }
    /// The angle that an arc of this length and radius subtends. The radius is positive; the length is at most that of
    /// one turn.
    fn subtended(length: S, radius: S) -> Self;
    /// Half the angle that an arc of this length and radius subtends. If angles are modulo one turn, it cannot be
    /// computed from the whole angle, which is 0 for a full turn.
    fn half_subtended(length: S, radius: S) -> Self;
    /// Rounding error of `subtended`; 0 in a format whose angles are so fine that it does not matter.
    fn subtended_rest(self, length: S, radius: S) -> Self {
        let _ = (length, radius);
        Self::ZERO
    }
    /// `self + rhs` and its rounding error, which is 0 in a format that adds exactly.
    fn sum(self, rhs: Self) -> (Self, Self) {
        (self + rhs, Self::ZERO)
    }
    /// Sine and cosine.
    fn sin_cos(self) -> (S::Unit, S::Unit);
    /// Angle of the vector `(x, y)` in `[-π, π]`; 0 for the zero vector, or ±π where `x` is a negative zero.
    fn atan2(y: S, x: S) -> Self;
    /// The angles of two vectors.
    fn atan2_each([y, v]: [S; 2], [x, u]: [S; 2]) -> [Self; 2] {
        [Self::atan2(y, x), Self::atan2(v, u)]
    }
    /// Signed length of the arc of this radius that subtends the angle.
    fn arc_length(self, radius: S) -> S;
    /// Length of a full circle of this radius, at most [`Scalar::LIMIT`] times a small constant.
    fn circumference(radius: S) -> S;
}
