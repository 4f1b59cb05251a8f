//! Formats numbers as decimals, without floating point.

use crate::q::Q;
use crate::turns::Turns;
use core::fmt;

/// Largest number of decimals of a binary fraction of 24 bits.
const MOST: usize = 24;

/// Largest number of digits before the point: of a magnitude of 32 bits.
const WHOLE: usize = 10;

/// Writes `magnitude / 2^places` with a sign: all decimals, or as many as the requested precision; the last one is
/// rounded, halves up. Width, fill and alignment are those of numbers.
fn decimal(f: &mut fmt::Formatter<'_>, negative: bool, magnitude: u32, places: u32) -> fmt::Result {
    let mask = (1_u64 << places) - 1;
    let mut whole = u64::from(magnitude) >> places;
    let mut rest = u64::from(magnitude) & mask;
    // The whole part, the decimal point and the decimals.
    let mut text = [b'0'; WHOLE + 1 + MOST];
    let (integer, fraction) = text.split_at_mut(WHOLE);
    fraction[0] = b'.';
    let asked = f.precision();
    let mut count = 0;
    for digit in fraction.iter_mut().skip(1).take(asked.unwrap_or(MOST)) {
        if rest == 0 && asked.is_none() {
            break;
        }
        *digit = b'0' + ((10 * rest) >> places) as u8;
        rest = (10 * rest) & mask;
        count += 1;
    }
    let mut carry = 2 * rest > mask;
    for digit in fraction.iter_mut().skip(1).take(count).rev() {
        if carry && *digit == b'9' {
            *digit = b'0';
        } else {
            *digit += u8::from(carry);
            carry = false;
        }
    }
    whole += u64::from(carry);
    let mut first = WHOLE;
    for digit in integer.iter_mut().rev() {
        *digit = b'0' + (whole % 10) as u8;
        whole /= 10;
        first -= 1;
        if whole == 0 {
            break;
        }
    }
    let end = if count > 0 { WHOLE + 1 + count } else { WHOLE };
    f.pad_integral(!negative, "", core::str::from_utf8(text.get(first..end).unwrap_or_default()).unwrap_or_default())
}

/// Writes all decimals, or as many as requested.
impl<const F: u32> fmt::Display for Q<F> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        decimal(f, self.to_bits() < 0, self.to_bits().unsigned_abs(), F)
    }
}

/// As [`Display`](fmt::Display): the value of the number.
impl<const F: u32> fmt::Debug for Q<F> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

/// Writes the bits, which differ for different angles.
impl fmt::Debug for Turns {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Turns({} / 2^32)", self.to_bits())
    }
}

#[cfg(feature = "defmt")]
impl<const F: u32> defmt::Format for Q<F> {
    fn format(&self, f: defmt::Formatter<'_>) {
        defmt::write!(f, "{=i32} / 2^{=u32}", self.to_bits(), F);
    }
}

#[cfg(feature = "defmt")]
impl defmt::Format for Turns {
    fn format(&self, f: defmt::Formatter<'_>) {
        defmt::write!(f, "{=i32} / 2^32 turns", self.to_bits());
    }
}

#[cfg(test)]
mod tests {
    extern crate std;

    use crate::{Q12, Q16, Turns};
    use std::format;

    #[test]
    fn numbers_are_written_exactly_or_rounded() {
        let number = |x: f64| Q16::from_f64(x).expect("a number");
        let all = [0.0, -1.5, 4096.0, 0.062_5].map(|x| format!("{}", number(x)));
        assert_eq!(all, ["0", "-1.5", "4096", "0.0625"]);
        assert_eq!(format!("{:?} {:+}", Q16::LAST_DIGIT, Q16::ONE), "0.0000152587890625 +1");
        assert_eq!(format!("{} {}", Q12::from_bits(-1), Q12::from_bits(i32::MIN)), "-0.000244140625 -524288");
        // Halves are rounded up; a carry propagates to the digit before, and to the integer part.
        let one = [0.25, 0.75, 0.249, 0.96, 9.96, -9.96].map(|x| format!("{:.1}", number(x)));
        assert_eq!(one, ["0.3", "0.8", "0.2", "1.0", "10.0", "-10.0"]);
        let two = [0.125, 0.994, 0.996, 1.5, 0.495_1].map(|x| format!("{:.2}", number(x)));
        assert_eq!(two, ["0.13", "0.99", "1.00", "1.50", "0.50"]);
        assert_eq!([0.5, 1.5, 0.49].map(|x| format!("{:.0}", number(x))), ["1", "2", "0"]);
        assert_eq!(
            format!("{:>8.2}|{:<7}|{:+08.1}", number(-1.5), number(0.5), number(2.0)),
            "   -1.50|0.5    |+00002.0"
        );
        assert_eq!(format!("{:.30}", number(0.5)), format!("0.5{}", "0".repeat(23)));
    }

    #[test]
    fn angles_are_written_as_their_bits() {
        assert_eq!(format!("{:?}", Turns::from_bits(-5)), "Turns(-5 / 2^32)");
    }
}
