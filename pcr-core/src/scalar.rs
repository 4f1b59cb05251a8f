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
    /// Largest magnitude of a coordinate, length, radius, time, speed or acceleration that constructors accept. The
    /// diameter of an arc counts as a length, and its box as coordinates.
    const LIMIT: Self;
    /// Least radius of a disc or an arc. A product of four of them, as in the discriminants of P3, has all its digits: below
    /// it would lose them to underflow, and contacts with them. Coordinates and lengths may be 0 and as small as they like,
    /// as they are compared and added, and multiplied with radii only.
    const LEAST: Self;

    /// Neither NaN nor infinite. Fixed-point formats are always finite.
    fn is_finite(self) -> bool;
    /// Its bits, folded to 32: what tells one number from another in a checksum.
    fn digest(self) -> u32;
    /// A length in whole millimetres, for messages; 0 for what is less, the largest number for what is more.
    fn millimetres(self) -> u32;
    /// `self · rhs`, wide.
    fn times(self, rhs: Self) -> Self::Wide;
    /// `self · by`, rounded to nearest.
    fn scale(self, by: Self::Unit) -> Self;
    /// `a u + b v`, a component of a turned vector. Fixed point rounds once.
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
    /// `-self` if `negated`. Which way an arc turns is as good as random to a processor: best without a branch.
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
    /// `self + rhs`, and what it was rounded by: nothing in a format that adds exactly.
    fn sum(self, rhs: Self) -> (Self, Self) {
        (self + rhs, Self::ZERO)
    }
    /// `self + rest + length · by`, a coordinate at the end of a line, and what that was rounded by: the `rest` of the
    /// next call, in a unit of the format's own.
    fn advance(self, rest: Self, length: Self, by: Self::Unit) -> (Self, Self) {
        self.sum(length.scale(by) + rest)
    }
    /// `self + rhs`, rounded up.
    fn sum_up(self, rhs: Self) -> Self {
        self + rhs
    }
    /// `self` limited to `[lo, hi]`.
    fn clamp(self, lo: Self, hi: Self) -> Self {
        self.max(lo).min(hi)
    }
    /// `self / divisor` for dimensions that divide (a length by a speed). Saturates at a magnitude above
    /// [`Scalar::LIMIT`]; `0 / 0` is 0.
    fn quotient(self, divisor: Self) -> Self;
    /// `self · part / whole` with a whole above 0. A format of constant absolute precision should round once, at the end: a
    /// quotient on the way does not have the digits, and the product may be beyond what it holds. Where the part is larger than
    /// the whole, it saturates as [`Scalar::quotient`] does.
    fn portion(self, part: Self, whole: Self) -> Self;
    /// `self / divisor` for a sine or cosine, `None` where it is not below [`Scalar::LIMIT`].
    fn quotient_unit(self, divisor: Self::Unit) -> Option<Self>;
    /// The vector `(x, y)` of this norm, not zero, as a unit vector. A format of constant absolute precision takes the
    /// norm from the components: one of a few last digits would not make the vector one of length 1.
    fn unit_vector(x: Self, y: Self, norm: Self) -> [Self::Unit; 2];
    /// `a - b` for two non-negative numbers, given `a² - b²` as well, without cancellation.
    fn difference(a: Self, b: Self, squares: Self::Wide) -> Self;
    /// Both roots of `u² + 2 b u + g = 0`, `None` if they are not real. A double root where an error of `doubt` in `g`
    /// would make one.
    fn quadratic_roots(b: Self, g: Self::Wide, doubt: Self::Wide) -> Option<[Self; 2]>;
    /// Tells `found` the angles `φ + 2 atan τ` for all real `τ` of the equations `a τ² + 2 b τ + g = 0`, each given as
    /// `[a, b, g, doubt]`; `φ` is the angle of `sector.from`, and what lies outside of the sector may be left out. One root
    /// where only an error of `doubt` in both `a` and `g` would make it real. At most two equations; angles in `[-π, π]`.
    fn half_tangent_roots(
        equations: impl Iterator<Item = [Self::Wide; 4]>,
        sector: Sector<Self::Unit>,
        found: impl FnMut(Self::Angle),
    );
    /// The vector from the start of an arc to its point after twice the angle `half`, `2ϱ sin(h) e(ϑ ± h)`: `direction` is
    /// `(cos ϑ, sin ϑ)` at the start. Fixed point rounds once.
    fn chord(radius: Self, half: Self::Angle, right: bool, direction: [Self::Unit; 2]) -> [Self; 2] {
        let (sin, cos) = half.sin_cos();
        let chord = radius.double().scale(sin);
        let across = chord.scale(sin);
        let (along, across) = (chord.scale(cos), across.negate_if(right));
        let [cos, sin] = direction;
        [Self::combine(along, cos, across, -sin), Self::combine(along, sin, across, cos)]
    }
    /// Length travelled in the time `elapsed` since the slow end of a ramp.
    fn ramp_length(ramp: Ramp<Self>, elapsed: Self) -> Self;
    /// Time since the slow end of a ramp after which `length` is travelled: the inverse of [`Scalar::ramp_length`].
    fn ramp_time(ramp: Ramp<Self>, length: Self) -> Self;
    /// The residual that rounding may cause in a configuration of the given extent, [`Motion::extent`](crate::Motion::extent):
    /// every distance that the kernels compare with a radius is right within this. `docs/errors.md` derives it for each
    /// format.
    fn slack(extent: Self) -> Self;
    /// What a sum, a product or a quotient of a few numbers of this magnitude may be off.
    fn rounding(of: Self) -> Self;
    /// How far a path of so many arcs may be off for what cannot be carried on from one to the next, and for the rounding
    /// of angles; `span` is its extent and the largest diameter of an arc.
    fn drift(arcs: usize, span: Self) -> Self {
        let _ = (arcs, span);
        Self::ZERO
    }
    /// How far the rounding of times up to `time`, of the phases and of a query, moves an agent of this speed: not at all
    /// in a format that adds exactly.
    fn lag(speed: Self, time: Self) -> Self {
        let _ = (speed, time);
        Self::ZERO
    }
    /// Where a search for a contact stops, in a configuration of the given extent: discs this near to one another may be
    /// reported as touching. Not a bound on an error but a choice: it takes steps to come nearer. At least two slacks.
    fn tolerance(extent: Self) -> Self {
        Self::slack(extent).double().double().double().double()
    }
}

/// Motion at constant acceleration, told from its slow end, where neither map between time and length cancels.
///
/// The acceleration follows from the rest. Floating point computes with it; in fixed point its last digit would weigh
/// half the square of the elapsed time, so that the maps go through both ends of the ramp instead.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Ramp<S> {
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

/// From where an angle is counted, and which ones are of interest: those whose cosine to a direction is `least` or more,
/// where on its circle an arc lies. It tells without an arctangent which angles need one.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Sector<U> {
    /// Cosine and sine of the angle that is counted from.
    pub from: [U; 2],
    /// Cosine and sine of the middle.
    pub middle: [U; 2],
    /// Cosine of half the width, less [`Unit::COARSE`] or more.
    pub least: U,
}

impl<U: Unit> Sector<U> {
    /// All angles.
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
    /// The product as a scalar, rounded to nearest: a speed times a time is a length. Saturates, where the format
    /// would overflow, at a magnitude above [`Scalar::LIMIT`].
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
    /// More than what a sector is off when it is compared with an angle.
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
    /// Whether a heading of so many turns still has a direction that is right: any, where angles are modulo one turn.
    fn is_in_range(self) -> bool {
        true
    }
    /// The angle that an arc of this length and radius subtends. The radius is positive, the length that of one turn
    /// at most.
    fn subtended(length: S, radius: S) -> Self;
    /// Half the angle that an arc of this length and radius subtends: where angles are modulo one turn it cannot be
    /// had from the whole, which a full turn makes 0.
    fn half_subtended(length: S, radius: S) -> Self;
    /// What `subtended` was rounded by; 0 in a format whose angles are so fine that it does not matter.
    fn subtended_rest(self, length: S, radius: S) -> Self {
        let _ = (length, radius);
        Self::ZERO
    }
    /// `self + rhs`, and what it was rounded by: nothing in a format that adds exactly.
    fn sum(self, rhs: Self) -> (Self, Self) {
        (self + rhs, Self::ZERO)
    }
    /// Sine and cosine.
    fn sin_cos(self) -> (S::Unit, S::Unit);
    /// Angle of the vector `(x, y)` in `[-π, π]`; 0 for the zero vector.
    fn atan2(y: S, x: S) -> Self;
    /// Those of two vectors.
    fn atan2_each([y, v]: [S; 2], [x, u]: [S; 2]) -> [Self; 2] {
        [Self::atan2(y, x), Self::atan2(v, u)]
    }
    /// Signed length of the arc of this radius that subtends the angle.
    fn arc_length(self, radius: S) -> S;
    /// Length of a full circle of this radius, at most [`Scalar::LIMIT`] times a small constant.
    fn circumference(radius: S) -> S;
}
