//! Lenient reading of JSON: `null` counts as missing, and errors name a value of the wrong type.

use super::ImportError;
use crate::json::{self, JsonData, JsonMember, JsonNode, Position};
use crate::scenario::LIMIT;
use std::fmt;

/// Whether the last line of a text does not end, as where the text was cut within it.
pub(super) fn is_open(text: &str) -> bool {
    !text.is_empty() && !text.ends_with('\n')
}

/// The values in a text of several, one after the other. An object with a key twice is refused.
pub(super) fn several(text: &str) -> impl Iterator<Item = Result<JsonNode<'_>, ImportError>> {
    json::parse_sequence(text).map(|value| value.map_err(ImportError::of_json))
}

/// Parses the value in a JSON text; a byte order mark at its start is skipped. An object with a key twice is refused.
///
/// # Errors
/// Why it cannot be read.
pub fn parse(text: &str) -> Result<JsonNode<'_>, ImportError> {
    json::parse_strict(text).map_err(ImportError::of_json)
}

/// An object and how messages name it.
#[derive(Clone, Debug)]
pub(super) struct JsonObject<'j> {
    pub(super) name: String,
    position: Position,
    members: &'j [JsonMember<'j>],
}

impl<'j> JsonObject<'j> {
    pub(super) fn new(name: impl Into<String>, value: &'j JsonNode<'j>) -> Result<Self, ImportError> {
        let name = name.into();
        match &value.data {
            JsonData::Object(members) => Ok(Self { name, position: value.position, members }),
            other => {
                let problem = format!("{name}: {} where an object is expected", kind(other));
                Err(ImportError::in_json(value.position, problem))
            }
        }
    }

    /// The same under another name.
    pub(super) fn called(self, name: impl Into<String>) -> Self {
        Self { name: name.into(), ..self }
    }

    /// All members with their names.
    pub(super) fn members(&self) -> impl Iterator<Item = (&'j str, &'j JsonNode<'j>)> + use<'j> {
        self.members.iter().map(|(key, value)| (&**key, value))
    }

    /// A member that is there and not `null`.
    pub(super) fn get(&self, field: &str) -> Option<&'j JsonNode<'j>> {
        self.members().find(|(key, value)| *key == field && !value.is_null()).map(|(_, value)| value)
    }

    /// The error about the object.
    pub(super) fn error(&self, problem: impl fmt::Display) -> ImportError {
        ImportError::in_json(self.position, format!("{}: {problem}", self.name))
    }

    /// The error about a field, at its value if it is there.
    pub(super) fn field_error(&self, field: &str, problem: impl fmt::Display) -> ImportError {
        let position = self.get(field).map_or(self.position, |value| value.position);
        ImportError::in_json(position, format!("{}, {field}: {problem}", self.name))
    }

    /// The error about a key.
    pub(super) fn key_error(&self, key: &str, problem: impl fmt::Display) -> ImportError {
        let position = self.get(key).map_or(self.position, |value| value.position);
        ImportError::in_json(position, format!("{}: its key {key} {problem}", self.name))
    }

    pub(super) fn missing(&self, field: &str) -> ImportError {
        self.field_error(field, "missing")
    }

    fn unexpected(&self, field: &str, found: &JsonNode<'_>, expected: &str) -> ImportError {
        self.field_error(field, format_args!("{} where {expected} is expected", kind(&found.data)))
    }

    pub(super) fn object(&self, field: &str) -> Result<Option<JsonObject<'j>>, ImportError> {
        self.get(field).map(|value| JsonObject::new(format!("{}, {field}", self.name), value)).transpose()
    }

    /// The elements of a list; none where it is missing.
    pub(super) fn list(&self, field: &str) -> Result<&'j [JsonNode<'j>], ImportError> {
        let Some(value) = self.get(field) else { return Ok(&[]) };
        value.as_array().ok_or_else(|| self.unexpected(field, value, "a list"))
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
            Err(self.field_error(field, format_args!("{number:e} is out of range; allowed is up to {LIMIT:e}")))
        }
    }

    pub(super) fn required(&self, field: &str) -> Result<f64, ImportError> {
        self.number(field)?.ok_or_else(|| self.missing(field))
    }

    /// A number above zero.
    pub(super) fn positive(&self, field: &str) -> Result<Option<f64>, ImportError> {
        match self.number(field)? {
            Some(number) if number <= 0.0 => {
                Err(self.field_error(field, format_args!("{number} where a number above 0 is expected")))
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
            Some(number) if matches!(number.data, JsonData::Number(_)) => Ok(Some(number.to_string())),
            _ => self.text(field).map(|text| text.map(str::to_owned)),
        }
    }

    /// True or false.
    pub(super) fn flag(&self, field: &str) -> Result<Option<bool>, ImportError> {
        let flag =
            |value: &'j JsonNode<'j>| value.as_bool().ok_or_else(|| self.unexpected(field, value, "true or false"));
        self.get(field).map(flag).transpose()
    }

    /// `x` and `y`.
    pub(super) fn point(&self) -> Result<[f64; 2], ImportError> {
        Ok([self.required("x")?, self.required("y")?])
    }
}

fn kind(data: &JsonData<'_>) -> &'static str {
    match data {
        JsonData::Null => "null",
        JsonData::Bool(_) => "true or false",
        JsonData::Number(_) => "a number",
        JsonData::Text(_) => "a text",
        JsonData::Array(_) => "a list",
        JsonData::Object(_) => "an object",
    }
}

#[cfg(test)]
mod tests {
    use super::super::{ImportOptions, InputFormat, Warnings, layout, scenario};
    use super::*;

    #[test]
    fn errors_say_where_in_the_file_they_are() {
        let error = parse("{\"a\": 1,\n\"é\": x}").unwrap_err();
        assert_eq!(error.in_file("f.json"), "f.json:2:6: not JSON: x where a value is expected");
        for (format, text, expected) in [
            (
                InputFormat::Nav2,
                "{\"type\": \"FeatureCollection\", \"features\": [\n  {\"geometry\": {\"type\": \"Point\",\n    \"coordinates\": [0]}, \"properties\": {\"id\": 1}}]}",
                "f:3:20: feature 1, geometry, coordinates: two numbers are expected; --partial leaves that out",
            ),
            (
                InputFormat::Lif,
                "{\"metaInformation\": {\"lifVersion\": \"1.0.0\"}, \"layouts\": [{\"nodes\": [\n{\"nodeId\": \"A\", \"mapId\": \"m\",\n \"nodePosition\": {\"x\": 0, \"y\": \"1\"}}], \"edges\": []}]}",
                "f:3:32: node A, nodePosition, y: a text where a number is expected; --partial leaves that out",
            ),
            (
                InputFormat::Rmf,
                "name: b\ncoordinate_system: cartesian_meters\nlevels:\n  L1:\n    vertices:\n      - [0, 0, 0]\n    lanes:\n      - [0, 7]\n",
                "f:8:9: lane L1/0: there is no vertex 7; --partial leaves that out",
            ),
        ] {
            let error = layout(format, text, &ImportOptions::default(), &mut Warnings::default()).unwrap_err();
            assert_eq!(error.in_file("f"), expected);
        }
        let order = "[{\"orderId\": \"o\", \"orderUpdateId\": 0, \"nodes\": [\n  {\"nodeId\": \"A\", \"sequenceId\": 0, \"released\": true,\n   \"nodePosition\": {\"x\": 0, \"y\": 0, \"mapId\": \"m\", \"theta\": \"north\"}}], \"edges\": []}]";
        let refusal = |order: &str| {
            let options = ImportOptions { radius: Some(0.5), ..ImportOptions::default() };
            scenario(InputFormat::Vda5050, order, &options, &mut Warnings::default()).unwrap_err().in_file("f")
        };
        assert_eq!(refusal(order), "f:3:60: order o, node A, nodePosition, theta: a text where a number is expected");
        let typed = refusal(&order.replace("\"x\": 0", "\"x\": \"0\""));
        assert!(typed.starts_with("f:3:26: order o, nodes[0].nodePosition.x: "), "{typed}");
    }
}
