//! Lenient reading of JSON: `null` counts as missing, and errors name a value of the wrong type.

use super::ImportError;
use crate::byte_order_mark::unmarked;
use crate::scenario::LIMIT;
use crate::unique_keys::UniqueKeysJson;
use serde_json::{Map, Value};

/// Whether the last line of a text does not end, as where the text was cut within it.
pub(super) fn is_open(text: &str) -> bool {
    !text.is_empty() && !text.ends_with('\n')
}

/// The values in a text of several, one after the other. An object with a key twice is refused.
pub(super) fn several(text: &str) -> impl Iterator<Item = Result<Value, ImportError>> + use<'_> {
    let values = serde_json::Deserializer::from_str(unmarked(text)).into_iter::<UniqueKeysJson>();
    values.map(move |value| value.map(|once| once.0).map_err(|error| not_json(text, &error)))
}

fn not_json(text: &str, error: &serde_json::Error) -> ImportError {
    ImportError::of_json(unmarked(text), error, "JSON")
}

/// The value in a JSON text; a byte order mark at its start is skipped. An object with a key twice is refused.
///
/// # Errors
/// Why it cannot be read.
pub fn parse(text: &str) -> Result<Value, ImportError> {
    let value: Result<UniqueKeysJson, _> = serde_json::from_str(unmarked(text));
    value.map(|once| once.0).map_err(|error| not_json(text, &error))
}

/// An object and how messages name it.
#[derive(Clone, Debug)]
pub(super) struct JsonObject<'j> {
    pub(super) name: String,
    members: &'j Map<String, Value>,
}

impl<'j> JsonObject<'j> {
    pub(super) fn new(name: impl Into<String>, value: &'j Value) -> Result<Self, ImportError> {
        let name = name.into();
        match value {
            Value::Object(members) => Ok(Self { name, members }),
            other => Err(ImportError::new(format!("{name}: {} where an object is expected", kind(other)))),
        }
    }

    /// The same under another name.
    pub(super) fn called(self, name: impl Into<String>) -> Self {
        Self { name: name.into(), ..self }
    }

    /// All members with their names.
    pub(super) fn members(&self) -> impl Iterator<Item = (&'j String, &'j Value)> + use<'j> {
        self.members.iter()
    }

    /// A member that is there and not `null`.
    pub(super) fn get(&self, field: &str) -> Option<&'j Value> {
        self.members.get(field).filter(|value| !value.is_null())
    }

    pub(super) fn missing(&self, field: &str) -> ImportError {
        ImportError::new(format!("{}, {field}: missing", self.name))
    }

    fn unexpected(&self, field: &str, found: &Value, expected: &str) -> ImportError {
        ImportError::new(format!("{}, {field}: {} where {expected} is expected", self.name, kind(found)))
    }

    pub(super) fn object(&self, field: &str) -> Result<Option<JsonObject<'j>>, ImportError> {
        self.get(field).map(|value| JsonObject::new(format!("{}, {field}", self.name), value)).transpose()
    }

    /// The elements of a list; none where it is missing.
    pub(super) fn list(&self, field: &str) -> Result<&'j [Value], ImportError> {
        match self.get(field) {
            None => Ok(&[]),
            Some(Value::Array(elements)) => Ok(elements),
            Some(other) => Err(self.unexpected(field, other, "a list")),
        }
    }

    /// A number of a magnitude that can be computed with.
    pub(super) fn number(&self, field: &str) -> Result<Option<f64>, ImportError> {
        let Some(value) = self.get(field) else {
            return Ok(None);
        };
        let number = value.as_f64().ok_or_else(|| self.unexpected(field, value, "a number"))?;
        if number.abs() <= LIMIT {
            Ok(Some(number))
        } else {
            Err(ImportError::new(format!(
                "{}, {field}: {number:e} is out of range; allowed is up to {LIMIT:e}",
                self.name
            )))
        }
    }

    pub(super) fn required(&self, field: &str) -> Result<f64, ImportError> {
        self.number(field)?.ok_or_else(|| self.missing(field))
    }

    /// A number above zero.
    pub(super) fn positive(&self, field: &str) -> Result<Option<f64>, ImportError> {
        match self.number(field)? {
            Some(number) if number <= 0.0 => {
                Err(ImportError::new(format!("{}, {field}: {number} where a number above 0 is expected", self.name)))
            }
            number => Ok(number),
        }
    }

    pub(super) fn text(&self, field: &str) -> Result<Option<&'j str>, ImportError> {
        self.get(field).map(|value| value.as_str().ok_or_else(|| self.unexpected(field, value, "a text"))).transpose()
    }

    /// A name: a text, or a number as some tools write one.
    pub(super) fn label(&self, field: &str) -> Result<Option<String>, ImportError> {
        match self.get(field) {
            Some(Value::Number(number)) => Ok(Some(number.to_string())),
            _ => self.text(field).map(|text| text.map(str::to_owned)),
        }
    }

    /// True or false.
    pub(super) fn flag(&self, field: &str) -> Result<Option<bool>, ImportError> {
        let flag = |value: &'j Value| value.as_bool().ok_or_else(|| self.unexpected(field, value, "true or false"));
        self.get(field).map(flag).transpose()
    }

    /// `x` and `y`.
    pub(super) fn point(&self) -> Result<[f64; 2], ImportError> {
        Ok([self.required("x")?, self.required("y")?])
    }
}

fn kind(value: &Value) -> &'static str {
    match value {
        Value::Null => "null",
        Value::Bool(_) => "true or false",
        Value::Number(_) => "a number",
        Value::String(_) => "a text",
        Value::Array(_) => "a list",
        Value::Object(_) => "an object",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mark_before_the_text_is_skipped_and_what_is_there_twice_is_refused() {
        let text = r#"{"a": [1, 0.5, null], "b": {"a": "x"}}"#;
        let expected: Value = serde_json::from_str(text).unwrap();
        assert_eq!(parse(text).unwrap(), expected);
        assert_eq!(parse(&format!("\u{feff}{text}")).unwrap(), expected);
        let error = parse(r#"{"a": 1, "a": 1}"#).unwrap_err().to_string();
        assert_eq!(error, "line 1, column 12: not JSON: \"a\" is there twice");
        let error = parse("{\"a\": 1,\n\"é\": x}").unwrap_err();
        assert_eq!(error.in_file("f.json"), "f.json:2:6: not JSON: expected value");
        assert!(parse("{\"a\": 1} x").is_err() && parse("{\"a\": 1").is_err());
    }
}
