//! Numbers with three digits and their units.

/// Three digits, and all of a number from 1000 on.
pub fn digits(value: f64) -> String {
    let before = value.abs().log10().floor();
    let decimals = if before.is_finite() { (2.0 - before).clamp(0.0, 3.0) } else { 0.0 };
    format!("{value:.*}", decimals as usize)
}

/// To the third digit behind the point, as most tables have it. What becomes 0 has no minus.
pub fn thousandths(value: f64) -> String {
    let text = format!("{value:.3}");
    if text == "-0.000" { "0.000".into() } else { text }
}

/// Returns the largest number of three digits behind the point that is not above the value, for a bound from below. A value that such a text
/// denotes, read back as `f64`, stays as it is.
pub fn below(value: f64) -> String {
    towards(value, |printed| printed > value, -1)
}

/// Returns the least number of three digits behind the point that is not below the value, for a bound from above.
pub fn above(value: f64) -> String {
    towards(value, |printed| printed < value, 1)
}

/// Returns the ends of an interval that contains what is printed of it, to the third digit behind the point.
pub fn outward([lo, hi]: [f64; 2]) -> [String; 2] {
    [below(lo), above(hi)]
}

/// Returns the same of an interval whose ends are on a thousandth but for a rounding, less than 1e-9: such an end stays there. Edges of layouts
/// have lengths like that, and a rounding does not add a millimetre to their locks.
pub(crate) fn outward_but_for_rounding([lo, hi]: [f64; 2]) -> [String; 2] {
    const ROUNDING: f64 = 1e-9;
    outward([lo + ROUNDING, hi - ROUNDING])
}

/// Returns all digits, at least three behind the point: a number that is copied has to be the same, such as a start delay, for which another
/// one nearby may not be free of conflicts.
pub fn exact(value: f64) -> String {
    let (short, whole) = (thousandths(value), value.to_string());
    if short.parse() == Ok(value) { short } else { whole }
}

/// The nearest number of three digits behind the point, or its neighbour where it is on the wrong side. Numbers that are too large for a
/// whole number of thousandths have no more digits than that.
fn towards(value: f64, is_wrong: impl Fn(f64) -> bool, step: i128) -> String {
    let text = thousandths(value);
    match (text.parse::<f64>().is_ok_and(is_wrong), text.replace('.', "").parse::<i128>()) {
        (true, Ok(count)) => {
            let count = count + step;
            let (sign, [whole, part]) = (if count < 0 { "-" } else { "" }, [count.abs() / 1000, count.abs() % 1000]);
            format!("{sign}{whole}.{part:03}")
        }
        _ => text,
    }
}

/// A length in metres: to the millimetre, and three digits of what is shorter than that.
pub fn small(length: f64) -> String {
    if length == 0.0 {
        return "0".into();
    }
    if length.abs() >= 1e-3 {
        return thousandths(length);
    }
    let text = format!("{length:.2e}");
    let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    format!("{}e{exponent}", mantissa.trim_end_matches('0').trim_end_matches('.'))
}

/// A length in metres as it was given, without what sums and differences of such lengths have beyond the nanometre.
pub fn given(length: f64) -> String {
    let rounded = (1e9 * length).round() / 1e9;
    if rounded > 0.0 { rounded.to_string() } else { length.to_string() }
}

/// A time that is given in milliseconds.
pub fn time(ms: f64) -> String {
    match ms {
        0.0..1e-3 => format!("{} ns", digits(1e6 * ms)),
        1e-3..1.0 => format!("{} µs", digits(1e3 * ms)),
        1.0..1e3 => format!("{} ms", digits(ms)),
        _ => format!("{} s", digits(1e-3 * ms)),
    }
}

/// How many times something.
pub fn times(ratio: f64) -> String {
    format!("{} ×", if ratio < 1.0 { format!("{ratio:.2}") } else { digits(ratio) })
}

/// A number of bytes.
pub fn bytes(count: usize) -> String {
    let count = count as f64;
    match count {
        0.0..1e3 => format!("{count} B"),
        1e3..1e6 => format!("{} kB", digits(count / 1e3)),
        _ => format!("{} MB", digits(count / 1e6)),
    }
}

/// An error in seconds.
pub fn seconds(time: f64) -> String {
    match time {
        0.0 => "0 s".into(),
        ..1e-3 => format!("{time:.0e} s"),
        _ => format!("{} ms", digits(1e3 * time)),
    }
}

/// A share in per cent; a dash for a share of nothing.
pub fn share(part: f64) -> String {
    match part {
        _ if part.is_nan() => "–".into(),
        0.0 => "0 %".into(),
        ..1e-4 => format!("{part:.0e}"),
        _ => format!("{} %", digits(100.0 * part)),
    }
}

#[cfg(test)]
mod tests {
    use super::{above, below, exact, given, outward, outward_but_for_rounding, seconds, share, small, thousandths};
    use pcr_formats::splitmix64::SplitMix64;

    #[test]
    fn sums_are_told_as_they_were_given() {
        assert_eq!([0.4 + 0.2, 0.3, 1.75, 1e-11].map(given), ["0.6", "0.3", "1.75", "0.00000000001"]);
    }

    #[test]
    fn nothing_and_shares_of_nothing_are_told() {
        assert_eq!([0.0, 2e-5, 0.25, f64::NAN].map(share), ["0 %", "2e-5", "25.0 %", "–"]);
        assert_eq!([0.0, 2e-5, 0.25].map(seconds), ["0 s", "2e-5 s", "250 ms"]);
    }

    #[test]
    fn there_is_no_minus_before_zero() {
        let texts = [-0.0, -4e-4, -6e-4, 0.0, -1.5].map(thousandths);
        assert_eq!(texts, ["0.000", "0.000", "-0.001", "0.000", "-1.500"]);
    }

    #[test]
    fn intervals_are_rounded_outward() {
        assert_eq!(outward([1.2344, 3.20049]), ["1.234", "3.201"]);
        assert_eq!(outward([-3.20049, -1.2344]), ["-3.201", "-1.234"]);
        assert_eq!(outward([-0.0004, 0.0004]), ["-0.001", "0.001"]);
        assert_eq!(outward([-0.0, -0.0004]), ["0.000", "0.000"]);
        assert_eq!(outward([-1.0, -0.9999]), ["-1.000", "-0.999"]);
        // Half of a thousandth, and next to it.
        assert_eq!(outward([0.0625, 0.0625]), ["0.062", "0.063"]);
        assert_eq!(outward([2.0005, 2.0005]), ["2.000", "2.001"]);
        // What is read back as the same number is not moved; the least more is.
        assert_eq!(outward([0.1, 3.2]), ["0.100", "3.200"]);
        assert_eq!(outward([0.1_f64.next_down(), 3.2_f64.next_up()]), ["0.099", "3.201"]);
        assert_eq!(outward([9.9996, 9.9996]), ["9.999", "10.000"]);
        assert_eq!(outward([-9.9996, 999.999_5]), ["-10.000", "1000.000"]);
        let huge = [1e15 + 0.125, 1e300];
        assert_eq!(outward(huge).map(|text| text.parse::<f64>().expect("a number")), huge);
        assert_eq!(outward([f64::NEG_INFINITY, f64::INFINITY]), ["-inf", "inf"]);
        assert_eq!([below(f64::NAN), above(f64::NAN)], ["NaN", "NaN"]);
    }

    #[test]
    fn a_rounding_adds_no_thousandth() {
        assert_eq!(outward_but_for_rounding([0.1_f64.next_down(), 3.850_000_000_000_001_4]), ["0.100", "3.850"]);
        assert_eq!(outward_but_for_rounding([-0.500_000_000_000_1, 0.0]), ["-0.500", "0.000"]);
        assert_eq!(outward_but_for_rounding([0.0999, 3.850_000_1]), ["0.099", "3.851"]);
    }

    #[test]
    fn what_is_printed_contains_what_it_is_about() {
        let mut random = SplitMix64(1);
        for _ in 0..200_000 {
            let value = f64::from_bits(random.bits());
            // Numbers of all magnitudes, and many of those that lengths and times have.
            let usual = (value.to_bits() >> 40) as f64 / 1_048_576.0 - 4.0;
            for value in [value, usual, usual * 1e4].into_iter().filter(|value| !value.is_nan()) {
                let [lo, hi] = outward([value; 2]).map(|text| text.parse::<f64>().expect("a number"));
                assert!(lo <= value && value <= hi, "{value:?} in {lo} to {hi}");
                // In fact no farther than a thousandth, and what rounding adds to that.
                assert!(hi - lo <= 0.001 + 2.0 * f64::EPSILON * value.abs() || hi == lo, "{value:?} in {lo} to {hi}");
            }
        }
    }

    #[test]
    fn a_number_to_copy_has_all_digits() {
        assert_eq!(
            [0.0, -0.0, 1.5, 3.20049, 1.0 / 3.0].map(exact),
            ["0.000", "0.000", "1.500", "3.20049", "0.3333333333333333"]
        );
    }

    #[test]
    fn what_is_small_is_not_zero() {
        let expected = [
            (0.0, "0"),
            (6.2e-6, "6.2e-6"),
            (1.23456e-9, "1.23e-9"),
            (-4e-4, "-4e-4"),
            (9.999e-4, "1e-3"),
            (0.001, "0.001"),
            (0.5, "0.500"),
            (12.34567, "12.346"),
        ];
        for (length, text) in expected {
            assert_eq!(small(length), text);
        }
    }
}
