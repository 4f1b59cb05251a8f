//! Implements the traits of `pcr-core` for the number type.

use crate::integer::divide;
use crate::product::Product;
use crate::q::Q;
use crate::sine::Sine;
use crate::turns::Turns;
use crate::{ramp, roots};
use pcr_core::Scalar;
use pcr_core::scalar::{AccelerationRamp, Angle, AngleSector, Unit, Wide};

/// Largest bits that constructors accept: the kernels need eight times as much (docs/theory/errors-fixed.md).
const LIMIT: i32 = 1 << 28;

/// Quotients saturate at this.
const MOST: u64 = 2 * LIMIT as u64;

/// Bound on rounding errors in a small arena, in last digits: 7.2 by docs/theory/errors.md, plus 0.8 for the part that
/// [`Scalar::drift`] leaves out.
const SLACK: i32 = 8;
/// Directions and angles are right to a few 2⁻³⁰: the bound grows by 16 times 2⁻³⁰ of the extent, of which 11.6 are
/// needed.
const SLACK_SHIFT: u32 = 26;

impl<const F: u32> Scalar for Q<F> {
    type Wide = Product<F>;
    type Unit = Sine;
    type Angle = Turns;

    const ZERO: Self = Self::from_bits(0);
    const LIMIT: Self = Self::from_bits(LIMIT);
    /// Products keep all their digits, so the least radius is a last digit.
    const LEAST: Self = Self::LAST_DIGIT;

    fn is_finite(self) -> bool {
        true
    }
    fn digest(self) -> u32 {
        self.0 as u32
    }
    fn millimetres(self) -> u32 {
        // With 8 to 11 fraction bits, numbers far beyond the limit have more millimetres than 32 bits.
        (i64::from(self.0.max(0)).wrapping_mul(1000) >> F).min(u32::MAX.into()) as u32
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
    /// A length by a speed, or a speed by an acceleration: the divisions of the constructor of a profile.
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
    /// The only division for two lines that cross: their distance by the sine of their angle.
    fn quotient_unit(self, divisor: Sine) -> Option<Self> {
        let (bits, by) = (divisor.to_bits(), divisor.to_bits().unsigned_abs());
        let dividend = u64::from(self.0.unsigned_abs()) << Sine::FRACTION_BITS;
        let magnitude = (dividend < LIMIT as u64 * u64::from(by)).then(|| divide(dividend + u64::from(by >> 1), by))?;
        Some(Self(signed(magnitude, (self.0 < 0) != (bits < 0))))
    }
    fn unit_vector(x: Self, y: Self, _: Self) -> [Sine; 2] {
        Sine::unit_vector(x.0, y.0)
    }
    /// The plain difference: it cancels in floating point but is exact here, and `b` is a root rounded to nearest.
    fn difference(a: Self, b: Self, _: Product<F>) -> Self {
        a - b
    }
    /// `-b ± √(b² - g)`: both are off by the rounding error of the root, half a last digit.
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
        sector: AngleSector<Sine>,
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
    fn ramp_length(ramp: AccelerationRamp<Self>, elapsed: Self) -> Self {
        ramp::length(ramp, elapsed)
    }
    fn ramp_time(ramp: AccelerationRamp<Self>, length: Self) -> Self {
        ramp::time(ramp, length)
    }
    fn ramp_bulge(ramp: AccelerationRamp<Self>, duration: Self) -> Self {
        ramp::bulge(ramp, duration)
    }
    fn ramps_alike(one: AccelerationRamp<Self>, other: AccelerationRamp<Self>) -> bool {
        ramp::alike(one, other)
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
    /// Half a last digit of the chord for each arc; the rounding of its angles, 3 · 2⁻³⁰ of the span; and twice that
    /// for the points of an arc, whose angles are rounded again. Up to 0.4 of a last digit are left out here and
    /// included in the slack.
    fn drift(arcs: usize, span: Self) -> Self {
        const UNIT: i64 = 1 << 30;
        if arcs == 0 {
            return Self(0);
        }
        let arcs = arcs as i64;
        Self(((arcs * (UNIT / 2) + 3 * (arcs + 2) * i64::from(span.0) + UNIT / 5 * 3) >> 30) as i32)
    }
}

/// The number with this magnitude, which is below 2³¹, and this sign.
fn signed(magnitude: u32, negative: bool) -> i32 {
    if negative { -(magnitude as i32) } else { magnitude as i32 }
}

#[cfg(test)]
mod tests {
    extern crate std;

    use super::*;
    use crate::{Q12, Q16, Q20};
    use std::vec::Vec;

    const L: i64 = LIMIT as i64;

    fn q(bits: i64) -> Q16 {
        Q16::from_bits(bits as i32)
    }

    /// Numbers of either sign, up to the limit.
    fn numbers() -> Vec<i64> {
        let random = (1..30_i64).map(|k| (k * k * 7_919_777) % (L >> (k % 20)));
        [1, 2, 3, 7, 65_535, 65_536, 65_537, L - 1, L].into_iter().chain(random).flat_map(|x| [x, -x]).collect()
    }

    /// `dividend / divisor`, rounded to nearest, halves away from 0; at most `most`.
    fn nearest(dividend: i128, divisor: i128, most: i128) -> i128 {
        let magnitude = (2 * dividend.abs() + divisor.abs()) / (2 * divisor.abs());
        magnitude.min(most) * dividend.signum() * divisor.signum()
    }

    #[test]
    fn quotients_are_nearest_and_saturate() {
        let most = 2 * i128::from(L);
        for a in numbers() {
            for b in numbers() {
                let (x, y) = (i128::from(a), i128::from(b));
                assert_eq!(i128::from(q(a).quotient(q(b)).0), nearest(x << 16, y, most), "{a} / {b}");
                for part in [0, 1, -5, 1 << 16, L] {
                    let whole = b.abs();
                    let portion = q(a).portion(q(part), q(whole)).0;
                    assert_eq!(i128::from(portion), nearest(x * i128::from(part), y.abs(), most), "{a} {part} {whole}");
                }
                let found = q(a).quotient_unit(Sine::from_bits(b as i32)).map(|q| i128::from(q.0));
                let exact = ((x.abs() << 30) < i128::from(L) * y.abs()).then(|| nearest(x << 30, y, most));
                assert_eq!(found, exact, "{a} / {b}");
            }
            assert_eq!(q(a).quotient(q(0)).0, a.signum() as i32 * MOST as i32);
            assert_eq!((q(0).quotient(q(a)), q(0).portion(q(a), q(1)), q(0).quotient(q(0))), (q(0), q(0), q(0)));
            assert_eq!(q(a).quotient_unit(Sine::ZERO), None);
        }
        let digit = Sine::from_bits(1 << 30);
        assert_eq!(
            [q(L - 1), q(L), q(1 - L), q(-L)].map(|q| q.quotient_unit(digit)),
            [Some(q(L - 1)), None, Some(q(1 - L)), None]
        );
    }

    #[test]
    fn bounds_are_as_documented() {
        assert_eq!([0, (1 << 26) - 1, 1 << 26, L].map(|extent| Q16::slack(q(extent)).0), [8, 8, 9, 12]);
        assert_eq!([0, L - 1, L].map(|of| Q16::rounding(q(of)).0), [1, 1, 2]);
        assert_eq!(Q16::tolerance(q(L)).0, 16 * 12);
        assert_eq!(Q16::lag(q(1 << 16), q(L)).0, 0);
        // Half a digit for each arc, 3/2^30 of the span for each arc and two more, and 0.6.
        assert_eq!([0, 1, 2, 3, 8, 9].map(|arcs| Q16::drift(arcs, q(0)).0), [0, 1, 1, 2, 4, 5]);
        assert_eq!([0, 1, 2, 3].map(|arcs| Q16::drift(arcs, q(L)).0), [0, 3, 4, 5]);
    }

    #[test]
    fn numbers_are_told_by_their_bits_and_millimetres() {
        assert_eq!([q(5), q(-5)].map(Scalar::digest), [5, u32::MAX - 4]);
        assert_eq!([q(65), q(66), q(65_536), q(-65_536), q(L)].map(Scalar::millimetres), [0, 1, 1000, 0, 4_096_000]);
        assert_eq!(Q12::LIMIT.millimetres(), 65_536_000);
        assert_eq!(Q20::LIMIT.millimetres(), 256_000);
        assert_eq!(Q::<8>::from_bits(i32::MAX).millimetres(), u32::MAX);
        assert_eq!(
            [q(5).half(), q(-5).half(), q(-5).abs(), q(5).negate_if(true), q(5).negate_if(false)],
            [q(2), q(-3), q(5), q(-5), q(5)]
        );
        assert!(Scalar::is_finite(q(5)));
        assert_eq!((Scalar::sum(q(5), q(3)), q(5).sum_up(q(3)), q(5).double()), ((q(8), q(0)), q(8), q(10)));
        assert_eq!([1, 3, 9].map(|x| Scalar::clamp(q(x), q(2), q(4))), [2, 3, 4].map(q));
        let (angle, rest) = Angle::<Q16>::sum(Turns::QUARTER, Turns::QUARTER);
        assert_eq!((angle, rest), (Turns::HALF, Turns::ZERO));
    }

    #[test]
    fn what_a_sum_leaves_goes_on_to_the_next() {
        let (mut at, mut rest) = (q(7), q(0));
        let by = Sine::from_bits(357_913_941);
        for _ in 0..1000 {
            (at, rest) = at.advance(rest, q(1), by);
        }
        // A third of 2^30, minus a third of a digit.
        assert_eq!((i64::from(at.0 - 7) << 30) + i64::from(rest.0), 357_913_941_000);
        assert_eq!((at, q(3).advance(q(0), q(2), Sine::from_bits(1 << 30))), (q(340), (q(5), q(0))));
        let half = Sine::from_bits(1 << 29);
        assert_eq!(
            (q(3).scale(half), Q16::combine(q(3), half, q(4), half), Q16::combine(q(3), half, q(5), -half)),
            (q(2), q(4), q(-1))
        );
    }

    #[test]
    fn roots_are_half_a_digit_off_and_doubtful_ones_are_double() {
        let (b, square) = (q(-5), |bits: i64| Product::<16>::from_bits(bits));
        let roots = |g: i64, doubt: i64| Q16::quadratic_roots(b, square(g), square(doubt));
        assert_eq!([roots(9, 0), roots(25, 0), roots(26, 0)], [Some([q(1), q(9)]), Some([q(5), q(5)]), None]);
        assert_eq!([roots(26, 1), roots(27, 1), roots(5, 7)], [Some([q(5), q(5)]), None, Some([q(1), q(9)])]);
        assert_eq!([Q16::difference(q(9), q(4), square(65)), q(9).times(q(-4)).narrow()], [q(5), q(0)]);
    }

    #[test]
    fn chords_are_rounded_once() {
        let radius = q(1 << 20);
        let mut worst = 0.0_f64;
        for k in 0..5000_i32 {
            let half = Turns::from_bits((k * 429_497) & (i32::MAX >> 1));
            let heading = Turns::from_bits(k.wrapping_mul(-1_640_531_527));
            let (sin, cos) = Angle::<Q16>::sin_cos(heading);
            for right in [false, true] {
                let turned = heading.to_radians() + if right { -half.to_radians() } else { half.to_radians() };
                let length = 2.0 * f64::from(radius.0) * half.to_radians().sin();
                let exact = [length * turned.cos(), length * turned.sin()];
                for (found, exact) in Q16::chord(radius, half, right, [cos, sin]).into_iter().zip(exact) {
                    worst = worst.max((f64::from(found.0) - exact).abs());
                }
            }
        }
        assert!(worst > 0.49 && worst < 0.51, "{worst} last digits");
    }
}
