//! A floating-point number of 31 significant bits and an exponent, for the formulas whose intermediate results have no
//! common scale. The relative error of an operation is 2⁻³⁰.

use crate::integer::{divide, sqrt};

/// `mantissa · 2^exponent`. The magnitude of the mantissa is 2³⁰ to 2³¹ - 1; 0 has the least exponent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Scaled {
    mantissa: i32,
    exponent: i32,
}

impl Scaled {
    /// The exponent is far below that of any other number, also when it is doubled.
    const ZERO: Self = Self { mantissa: 0, exponent: -1024 };

    /// `value · 2^exponent`.
    pub(crate) fn new(value: i64, exponent: i32) -> Self {
        if value == 0 {
            return Self::ZERO;
        }
        // With 33 leading zeros, 31 bits are left. One more bit is kept for rounding, and the carry must not reach bit
        // 32.
        let shift = 33 - value.unsigned_abs().leading_zeros() as i32;
        let mantissa = if shift > 0 { ((value >> (shift - 1)) + 1) >> 1 } else { value << -shift };
        let most = i64::from(i32::MAX);
        Self { mantissa: mantissa.clamp(-most, most) as i32, exponent: exponent + shift }
    }

    pub(crate) fn is_negative(self) -> bool {
        self.mantissa < 0
    }

    pub(crate) fn minus(self) -> Self {
        Self { mantissa: -self.mantissa, ..self }
    }

    pub(crate) fn magnitude(self) -> Self {
        Self { mantissa: self.mantissa.abs(), ..self }
    }

    pub(crate) fn plus(self, rhs: Self) -> Self {
        let exponent = self.exponent.max(rhs.exponent);
        // 62 bits each: no bit of the smaller term that the result could hold is lost.
        let aligned = |term: Self| (i64::from(term.mantissa) << 31) >> (exponent - term.exponent).min(63);
        Self::new(aligned(self) + aligned(rhs), exponent - 31)
    }

    pub(crate) fn times(self, rhs: Self) -> Self {
        Self::new(i64::from(self.mantissa) * i64::from(rhs.mantissa), self.exponent + rhs.exponent)
    }

    /// `self / divisor`; for a divisor of 0 the result is some large number.
    pub(crate) fn over(self, divisor: Self) -> Self {
        let by = divisor.mantissa.unsigned_abs();
        let magnitude = i64::from(divide((u64::from(self.mantissa.unsigned_abs()) << 31) + u64::from(by >> 1), by));
        let quotient = if (self.mantissa < 0) == (divisor.mantissa < 0) { magnitude } else { -magnitude };
        Self::new(quotient, self.exponent - divisor.exponent - 31)
    }

    /// Square root of a number that is not negative.
    pub(crate) fn sqrt(self) -> Self {
        // The exponent becomes even, and the mantissa has 62 or 63 bits.
        let shift = 31 + ((self.exponent + 1) & 1);
        let root = sqrt(u64::from(self.mantissa.unsigned_abs()) << shift);
        Self::new(i64::from(root), (self.exponent - shift) >> 1)
    }

    /// The nearest integer if the magnitude is below 2²⁹; 2³⁰ from there on.
    pub(crate) fn round(self) -> i32 {
        const MOST: i32 = 1 << 30;
        match self.exponent {
            // Half of the last place is added before that place is dropped; 31 bits leave room for it.
            ..-1 => ((self.mantissa >> (-1 - self.exponent).min(31)) + 1) >> 1,
            _ => self.mantissa.signum() * MOST,
        }
    }

    /// Two numbers with a common exponent; the larger one has 31 bits.
    pub(crate) fn aligned(self, rhs: Self) -> [i32; 2] {
        let exponent = self.exponent.max(rhs.exponent);
        [self, rhs].map(|term| term.mantissa >> (exponent - term.exponent).min(31))
    }
}

#[cfg(test)]
mod tests {
    extern crate std;

    use super::*;
    use std::vec::Vec;

    const DIGITS: i64 = 1 << 30;

    /// Mantissas of either sign, including the ends of their range.
    fn mantissas() -> Vec<i64> {
        let random = (1..40_i64).map(|k| DIGITS + (k * 988_765_433) % DIGITS);
        let ends = [DIGITS, DIGITS + 1, DIGITS + 2, 2 * DIGITS - 2, 2 * DIGITS - 1];
        random.chain(ends).flat_map(|mantissa| [mantissa, -mantissa]).collect()
    }

    fn pairs() -> impl Iterator<Item = (i64, i64)> {
        mantissas().into_iter().flat_map(|a| mantissas().into_iter().map(move |b| (a, b)))
    }

    /// `found · 2^exponent`, which is an integer.
    fn whole(found: Scaled, exponent: i32) -> i128 {
        i128::from(found.mantissa) << (found.exponent + exponent)
    }

    #[test]
    fn numbers_are_rounded_to_31_digits() {
        for (bits, mantissa, exponent) in [
            (1, DIGITS, -30),
            (-3, -3 * DIGITS / 2, -29),
            (DIGITS + 1, DIGITS + 1, 0),
            ((DIGITS << 1) + 1, DIGITS + 1, 1),
            ((DIGITS << 2) + 1, DIGITS, 2),
            ((DIGITS << 2) + 2, DIGITS + 1, 2),
            (-((DIGITS << 2) + 2), -DIGITS, 2),
            (-((DIGITS << 2) + 3), -DIGITS - 1, 2),
            // A carry would add a digit.
            ((DIGITS << 10) - 1, 2 * DIGITS - 1, 9),
            (1 - (DIGITS << 10), 1 - 2 * DIGITS, 9),
            (i64::MAX, 2 * DIGITS - 1, 32),
            (i64::MIN, -DIGITS, 33),
        ] {
            let expected = Scaled { mantissa: mantissa as i32, exponent: exponent + 7 };
            assert_eq!(Scaled::new(bits, 7), expected, "{bits}");
        }
        assert_eq!(Scaled::new(0, 7), Scaled::ZERO);
        assert!(Scaled::new(-1, 0).is_negative() && !Scaled::new(1, 0).is_negative() && !Scaled::ZERO.is_negative());
        assert_eq!([Scaled::new(-3, 2).minus(), Scaled::new(-3, 2).magnitude()], [Scaled::new(3, 2); 2]);
        assert_eq!([Scaled::new(3, 2).minus(), Scaled::new(3, 2).magnitude()], [Scaled::new(-3, 2), Scaled::new(3, 2)]);
    }

    #[test]
    fn sums_are_those_of_the_numbers_rounded_once() {
        for (a, b) in pairs() {
            for apart in 0..31 {
                let (larger, smaller) = (Scaled::new(a, apart - 9), Scaled::new(b, -9));
                let exact = Scaled::new((a << apart) + b, -9);
                assert_eq!([larger.plus(smaller), smaller.plus(larger)], [exact; 2]);
            }
            // Next to a power of 2, a sum that is a little less has other digits.
            for apart in [40, 62, 63, 64, 65, 100].into_iter().filter(|_| a.abs() != DIGITS) {
                let (larger, smaller) = (Scaled::new(a, apart), Scaled::new(b, 0));
                assert_eq!([larger.plus(smaller), smaller.plus(larger)], [larger; 2]);
            }
            assert_eq!(
                [Scaled::new(a, 3).plus(Scaled::ZERO), Scaled::ZERO.plus(Scaled::new(a, 3))],
                [Scaled::new(a, 3); 2]
            );
        }
    }

    #[test]
    fn products_quotients_and_roots_are_right_to_31_digits() {
        for (a, b) in pairs() {
            let (x, y) = (Scaled::new(a, 5), Scaled::new(b, -2));
            let (product, exact) = (x.times(y), i128::from(a) * i128::from(b));
            assert!((whole(product, -3) - exact).abs() << 31 <= exact.abs(), "{a} {b}");
            let (quotient, exact) = (x.over(y), i128::from(a) << 40);
            assert!((whole(quotient, 33) * i128::from(b) - exact).abs() << 30 <= exact.abs(), "{a} {b}");
            assert_eq!(Scaled::new(6 * a.signum(), 5).over(Scaled::new(3, -2)), Scaled::new(2 * a.signum(), 7));
            assert_eq!(x.over(x), Scaled::new(1, 0));
        }
        for mantissa in mantissas().into_iter().filter(|&mantissa| mantissa > 0) {
            for exponent in [-30, -5, 0, 1, 8, 31] {
                let root = Scaled::new(mantissa, exponent).sqrt();
                let (square, exact) =
                    (i128::from(root.mantissa).pow(2), i128::from(mantissa) << (exponent - 2 * root.exponent));
                assert!((square - exact).abs() << 29 <= exact, "{mantissa} {exponent}");
            }
            let short = mantissa >> 16;
            assert_eq!(Scaled::new(short * short, 6).sqrt(), Scaled::new(short, 3));
        }
        assert_eq!([Scaled::new(2, 1).sqrt(), Scaled::new(9, -4).sqrt()], [Scaled::new(2, 0), Scaled::new(3, -2)]);
        assert_eq!(Scaled::ZERO.sqrt(), Scaled::ZERO);
        assert_eq!([1, -1].map(|x| Scaled::new(x, 0).over(Scaled::ZERO).round()), [1 << 30, -1 << 30]);
    }

    #[test]
    fn integers_are_nearest_and_saturate() {
        let halves = [5, 3, 1, -1, -3, -5].map(|halves| Scaled::new(halves, -1).round());
        assert_eq!(halves, [3, 2, 1, 0, -1, -2]);
        assert_eq!([7, 9, -7, -9].map(|x| Scaled::new(x, -3).round()), [1, 1, -1, -1]);
        let large = (1 << 29) - 1;
        assert_eq!([large, -large].map(|x| Scaled::new(x, 0).round()), [large as i32, -large as i32]);
        assert_eq!(
            [(1, 29), (-1, 29), (1, 30), (1, 900)].map(|(x, e)| Scaled::new(x, e).round()),
            [1 << 30, -1 << 30, 1 << 30, 1 << 30]
        );
        assert_eq!([(1, -2), (-1, -2), (1, -40), (-1, -40), (0, 5)].map(|(x, e)| Scaled::new(x, e).round()), [0; 5]);
    }

    #[test]
    fn numbers_are_put_on_one_scale() {
        let [a, b, c] = [Scaled::new(3, 0), Scaled::new(-5, -10), Scaled::new(7, -100)];
        assert_eq!(a.aligned(b), [3 << 29, -5 << 19]);
        assert_eq!(b.aligned(a), [-5 << 19, 3 << 29]);
        assert_eq!([a.aligned(c), b.aligned(c)], [[3 << 29, 0], [-5 << 28, 0]]);
        assert_eq!([a.aligned(Scaled::ZERO), c.aligned(b)], [[3 << 29, 0], [0, -5 << 28]]);
    }
}
