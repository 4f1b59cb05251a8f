//! What a scalar stands for.
//!
//! Without a tag or quotes: null, the booleans of YAML 1.1 (`yes` and `off` are some), integers in decimal, hexadecimal, octal
//! (`0o17`) and binary, with single `_` between their digits, decimal numbers, and otherwise a text. Dates are texts. With a zero before
//! other digits a number is not an integer.

use super::ScalarTag;
use serde_json::{Number, Value};
use std::fmt;

/// Why a scalar has no value.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum ScalarError {
    /// It is not what its tag tells.
    NotItsTag(String),
    /// It is not a finite number.
    NotFinite(String),
}

impl fmt::Display for ScalarError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotItsTag(text) => write!(f, "{text:?} is not what its tag tells"),
            Self::NotFinite(text) => write!(f, "{text} is not a finite number"),
        }
    }
}

/// The value of a scalar, or why it has none.
pub(super) fn value(kind: ScalarTag, text: &str) -> Result<Value, ScalarError> {
    // Blanks can only be around what is in quotes.
    let inner = text.trim_matches([' ', '\t', '\r', '\n']);
    let read = match kind {
        ScalarTag::Text => return Ok(Value::String(text.to_owned())),
        ScalarTag::Any | ScalarTag::Unknown | ScalarTag::Merge => return plain(text),
        ScalarTag::Null => return Ok(Value::Null),
        ScalarTag::Flag => flag(inner).map(Value::Bool),
        ScalarTag::Integer => integer(inner).map(Value::Number),
        ScalarTag::Float => float(inner)?.map(Value::Number),
        ScalarTag::Sequence | ScalarTag::Mapping => None,
    };
    read.ok_or_else(|| ScalarError::NotItsTag(text.to_owned()))
}

fn plain(text: &str) -> Result<Value, ScalarError> {
    if text.starts_with(|first: char| first.is_ascii_digit() || matches!(first, '+' | '-' | '.')) {
        let number = match integer(text) {
            Some(number) => Some(number),
            None => float(text)?,
        };
        return Ok(number.map_or_else(|| Value::String(text.to_owned()), Value::Number));
    }
    if is_null(text) {
        return Ok(Value::Null);
    }
    Ok(flag(text).map_or_else(|| Value::String(text.to_owned()), Value::Bool))
}

/// Whether it stands for nothing if it has no tag and no quotes.
pub(super) fn is_null(text: &str) -> bool {
    text.is_empty() || text == "~" || text.eq_ignore_ascii_case("null")
}

fn flag(text: &str) -> Option<bool> {
    let is = |words: [&str; 4]| words.iter().any(|word| text.eq_ignore_ascii_case(word));
    if is(["true", "yes", "on", "y"]) { Some(true) } else { is(["false", "no", "off", "n"]).then_some(false) }
}

/// An integer of 64 bits.
pub(super) fn integer(text: &str) -> Option<Number> {
    let positive = text.strip_prefix('+').unwrap_or(text);
    let unsigned = text.strip_prefix('-').unwrap_or(positive);
    let (radix, digits) = match unsigned.get(..2) {
        Some("0x" | "0X") => (16, unsigned.get(2..)?),
        Some("0o" | "0O") => (8, unsigned.get(2..)?),
        Some("0b" | "0B") => (2, unsigned.get(2..)?),
        _ if unsigned != "0" && unsigned.starts_with('0') => return None,
        _ => (10, unsigned),
    };
    let mut magnitude: u64 = 0;
    let mut is_after_digit = false;
    for sign in digits.chars() {
        is_after_digit = match sign.to_digit(radix) {
            Some(digit) => {
                magnitude = magnitude.checked_mul(radix.into())?.checked_add(digit.into())?;
                true
            }
            None if sign == '_' && is_after_digit => false,
            None => return None,
        };
    }
    match () {
        () if !is_after_digit => None,
        () if text.starts_with('-') => 0_i64.checked_sub_unsigned(magnitude).map(Number::from),
        () => Some(Number::from(magnitude)),
    }
}

/// A finite number; `None` for what is none.
fn float(text: &str) -> Result<Option<Number>, ScalarError> {
    let unsigned = text.strip_prefix(['+', '-']).unwrap_or(text);
    let not_finite = || ScalarError::NotFinite(text.to_owned());
    if [".inf", ".nan"].iter().any(|name| unsigned.eq_ignore_ascii_case(name)) {
        return Err(not_finite());
    }
    // Words such as `inf` are texts here.
    if !unsigned.starts_with(|first: char| first.is_ascii_digit() || first == '.') {
        return Ok(None);
    }
    match text.parse::<f64>() {
        Ok(number) => Number::from_f64(number).map(Some).ok_or_else(not_finite),
        Err(_) => Ok(None),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn scalars_without_tags_are_numbers_words_or_texts() {
        let cases = [
            (json!(null), "~ null Null nULL"),
            (json!(true), "true True yes ON y"),
            (json!(false), "false FALSE no Off N"),
            (json!(31), "31 +31 0x1F 0X1f 0o37 0b1_1111 3_1"),
            (json!(-8), "-8 -0o10 -0x8"),
            (json!(0), "0 -0 +0"),
            (json!(u64::MAX), "18446744073709551615 0xffffffffffffffff"),
            (json!(i64::MIN), "-9223372036854775808"),
            // With a zero before other digits it may be meant as an octal number: no index of anything.
            (json!(7.0), "7.0 7. 007 +07.0 70e-1 .7E+1"),
            (json!(2f64.powi(64)), "18446744073709551616"),
        ];
        for (expected, texts) in cases {
            for text in texts.split(' ') {
                assert_eq!(value(ScalarTag::Any, text), Ok(expected.clone()), "{text}");
            }
        }
        let texts =
            "nan inf -Infinity 1__0 _1 1_ 0x 0b2 0o8 0x_1 1_0.5 1e 2001-01-01 12:30 1,5 -- . + ++1 -+1 1f tru << = ١";
        for text in texts.split(' ') {
            assert_eq!(value(ScalarTag::Any, text), Ok(json!(text)));
        }
        assert_eq!(value(ScalarTag::Any, ""), Ok(Value::Null));
        for text in ".inf -.INF +.inf .nan 1e999 -1e999 .1e999".split(' ') {
            assert_eq!(value(ScalarTag::Any, text), Err(ScalarError::NotFinite(text.to_owned())));
        }
    }

    #[test]
    fn tags_are_obeyed() {
        for (kind, text, expected) in [
            (ScalarTag::Text, "0x1F", json!("0x1F")),
            (ScalarTag::Text, "", json!("")),
            (ScalarTag::Integer, " 0x1F\n", json!(31)),
            (ScalarTag::Float, "31", json!(31.0)),
            (ScalarTag::Flag, "off", json!(false)),
            (ScalarTag::Null, "7", json!(null)),
        ] {
            assert_eq!(value(kind, text), Ok(expected));
        }
        for (kind, text) in
            [(ScalarTag::Integer, "1.5"), (ScalarTag::Float, "x"), (ScalarTag::Flag, "1"), (ScalarTag::Integer, "")]
        {
            assert_eq!(value(kind, text), Err(ScalarError::NotItsTag(text.to_owned())));
        }
        assert!(value(ScalarTag::Float, ".nan").is_err());
    }
}
