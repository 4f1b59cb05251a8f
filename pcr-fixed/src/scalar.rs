//! How the number type fulfils the contract of `pcr-core`.

use crate::integer::divide;
use crate::product::Product;
use crate::q::Q;
use crate::sine::Sine;
use crate::turns::Turns;
use crate::{ramp, roots};
use pcr_core::Scalar;
use pcr_core::scalar::{Angle, Ramp, Sector, Unit, Wide};

/// Largest bits that constructors accept: eight times that is what the kernels need (docs/errors-fixed.md).
const LIMIT: i32 = 1 << 28;

/// At which quotients saturate.
const MOST: u64 = 2 * LIMIT as u64;

/// The residual that rounding may cause, in last digits, in a small arena: 7.2 by docs/errors.md, and 0.8 for what
/// [`Scalar::drift`] leaves out.
const SLACK: i32 = 8;
/// Directions and angles are right to a few 2⁻³⁰: the residual grows by 16 of these parts of the extent, of which 11.6 are
/// needed.
const SLACK_SHIFT: u32 = 26;

impl<const F: u32> Scalar for Q<F> {
    type Wide = Product<F>;
    type Unit = Sine;
    type Angle = Turns;

    const ZERO: Self = Self::from_bits(0);
    const LIMIT: Self = Self::from_bits(LIMIT);
    /// Products keep all their digits.
    const LEAST: Self = Self::LAST_DIGIT;

    fn is_finite(self) -> bool {
        true
    }
    fn digest(self) -> u32 {
        self.0 as u32
    }
    fn millimetres(self) -> u32 {
        // Not above 2³¹ for 12 digits and more behind the point.
        (i64::from(self.0.max(0)).wrapping_mul(1000) >> F) as u32
    }
    fn times(self, rhs: Self) -> Product<F> {
        Product::from_bits(i64::from(self.0) * i64::from(rhs.0))
    }
    fn scale(self, by: Sine) -> Self {
        Self(by.of(self.0))
    }
    fn combine(a: Self, u: Sine, b: Self, v: Sine) -> Self {
        Self(Sine::combine(a.0, u, b.0, v))
    }
    fn half(self) -> Self {
        Self(self.0 >> 1)
    }
    /// A length by a speed, a speed by an acceleration: what the constructor of a profile divides.
    fn quotient(self, divisor: Self) -> Self {
        let (dividend, by) = (u64::from(self.0.unsigned_abs()) << F, divisor.0.unsigned_abs());
        let magnitude = if dividend == 0 {
            0
        } else if dividend >= MOST * u64::from(by) {
            MOST as u32
        } else {
            divide(dividend + u64::from(by >> 1), by)
        };
        Self(signed(magnitude, (self.0 < 0) != (divisor.0 < 0)))
    }
    fn portion(self, part: Self, whole: Self) -> Self {
        let (magnitude, by) = (self.0.unsigned_abs(), whole.0.unsigned_abs());
        let product = u64::from(magnitude) * u64::from(part.0.unsigned_abs());
        let magnitude =
            if product >= MOST * u64::from(by) { MOST as u32 } else { divide(product + u64::from(by >> 1), by) };
        Self(signed(magnitude, (self.0 < 0) != (part.0 < 0)))
    }
    /// The one division of two lines that cross: their distance by the sine of their angle.
    fn quotient_unit(self, divisor: Sine) -> Option<Self> {
        let (bits, by) = (divisor.to_bits(), divisor.to_bits().unsigned_abs());
        let dividend = u64::from(self.0.unsigned_abs()) << Sine::FRACTION_BITS;
        let magnitude = (dividend < LIMIT as u64 * u64::from(by)).then(|| divide(dividend + u64::from(by >> 1), by))?;
        Some(Self(signed(magnitude, (self.0 < 0) != (bits < 0))))
    }
    fn unit_vector(x: Self, y: Self, _: Self) -> [Sine; 2] {
        Sine::unit_vector(x.0, y.0)
    }
    /// The difference itself: what cancels in floating point is exact here, and `b` is a root rounded to nearest.
    fn difference(a: Self, b: Self, _: Product<F>) -> Self {
        a - b
    }
    /// `-b ± √(b² - g)`: either is off by the rounding of the root, half a last digit.
    fn quadratic_roots(b: Self, g: Product<F>, doubt: Product<F>) -> Option<[Self; 2]> {
        let discriminant = b.times(b) - g;
        if discriminant < -doubt {
            return None;
        }
        let root = discriminant.sqrt();
        Some([-b - root, -b + root])
    }
    fn half_tangent_roots(
        equations: impl Iterator<Item = [Product<F>; 4]>,
        sector: Sector<Sine>,
        found: impl FnMut(Turns),
    ) {
        roots::half_tangent(equations.map(|equation| equation.map(Product::to_bits)), sector, found);
    }
    fn chord(radius: Self, half: Turns, right: bool, direction: [Sine; 2]) -> [Self; 2] {
        let (sin, cos) = Angle::<Self>::sin_cos(half);
        let (along, across) = (sin.times(cos), if right { -sin.times(sin) } else { sin.times(sin) });
        let [cos, sin] = direction;
        let unit = [Unit::combine(along, cos, across, -sin), Unit::combine(along, sin, across, cos)];
        unit.map(|unit| radius.double().scale(unit))
    }
    fn ramp_length(ramp: Ramp<Self>, elapsed: Self) -> Self {
        ramp::length(ramp, elapsed)
    }
    fn ramp_time(ramp: Ramp<Self>, length: Self) -> Self {
        ramp::time(ramp, length)
    }
    fn slack(extent: Self) -> Self {
        Self(SLACK + (extent.0 >> SLACK_SHIFT))
    }
    /// The product is added with all its digits.
    fn advance(self, rest: Self, length: Self, by: Sine) -> (Self, Self) {
        let (whole, rest) = by.of_with_rest(length.0, rest.0);
        (Self(self.0 + whole), Self(rest))
    }
    fn rounding(of: Self) -> Self {
        Self(1 + (of.0 >> 28))
    }
    /// Half a last digit of the chord of each arc; the rounding of its angles, 3 · 2⁻³⁰ of the span; twice that for the points
    /// of an arc, whose angles are rounded anew. Up to 0.4 of a last digit are left out: part of the slack.
    fn drift(arcs: usize, span: Self) -> Self {
        const UNIT: i64 = 1 << 30;
        if arcs == 0 {
            return Self(0);
        }
        let arcs = arcs as i64;
        Self(((arcs * (UNIT / 2) + 3 * (arcs + 2) * i64::from(span.0) + UNIT / 5 * 3) >> 30) as i32)
    }
}

/// A number of this magnitude, below 2³¹.
fn signed(magnitude: u32, negative: bool) -> i32 {
    if negative { -(magnitude as i32) } else { magnitude as i32 }
}
