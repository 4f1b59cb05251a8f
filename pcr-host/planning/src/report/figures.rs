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
    use super::{given, seconds, share, small, thousandths};

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
