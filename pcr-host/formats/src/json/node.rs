//! Values as they were parsed, with the place of each.

use serde_json::Value;
use std::borrow::Cow;
use std::fmt;
use std::ops::Range;

/// A value and where it begins. Words and strings without escapes are parts of the text. Nodes are equal if their values are.
#[derive(Clone, Debug)]
pub struct JsonNode<'t> {
    /// Where it begins.
    pub position: Position,
    /// First byte, and the one behind the last. Trees are large: the numbers are small.
    bytes: [u32; 2],
    /// What it is.
    pub data: JsonData<'t>,
}

/// A place in a text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Position {
    /// Counted from 1.
    pub line: u32,
    /// Character in the line, counted from 1.
    pub column: u32,
}

impl Position {
    /// The first character of a text.
    pub const START: Self = Self { line: 1, column: 1 };
}

/// The kinds of values.
#[derive(Clone, Debug, PartialEq)]
pub enum JsonData<'t> {
    /// `null`.
    Null,
    /// `true` or `false`.
    Bool(bool),
    /// As written: a JSON number, or `NaN` or `Infinity` in one of their spellings.
    Number(Cow<'t, str>),
    /// A string without its escapes.
    Text(Cow<'t, str>),
    /// A list.
    Array(Vec<JsonNode<'t>>),
    /// In the order of the text, equal keys included.
    Object(Vec<JsonMember<'t>>),
}

/// A key and its value.
pub type JsonMember<'t> = (Cow<'t, str>, JsonNode<'t>);

impl PartialEq for JsonNode<'_> {
    fn eq(&self, other: &Self) -> bool {
        self.data == other.data
    }
}

/// JSON on one line.
impl fmt::Display for JsonNode<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.to_value().fmt(f)
    }
}

impl<'t> JsonNode<'t> {
    /// A value in a text no longer than [`LONGEST`](super::LONGEST).
    pub(crate) fn new(position: Position, span: Range<usize>, data: JsonData<'t>) -> Self {
        Self { position, bytes: [span.start, span.end].map(|byte| byte as u32), data }
    }

    /// Returns which bytes of the text are this value; none if it is in no text.
    pub fn span(&self) -> Range<usize> {
        self.bytes[0] as usize..self.bytes[1] as usize
    }
}

impl JsonNode<'_> {
    /// Returns the last member of this name, which is the one that counts; `None` where there is none, or this is no object.
    pub fn get(&self, name: &str) -> Option<&Self> {
        match &self.data {
            JsonData::Object(members) => members.iter().rev().find(|(key, _)| key == name).map(|(_, value)| value),
            _ => None,
        }
    }

    /// Returns the elements of a list; none where this is no list.
    pub fn list(&self) -> &[Self] {
        match &self.data {
            JsonData::Array(elements) => elements,
            _ => &[],
        }
    }

    /// Returns the node of a value; all nodes in it have this position.
    pub fn from_value(value: Value, position: Position) -> Self {
        let node = |value| Self::from_value(value, position);
        let data = match value {
            Value::Null => JsonData::Null,
            Value::Bool(value) => JsonData::Bool(value),
            Value::Number(number) => JsonData::Number(number.to_string().into()),
            Value::String(text) => JsonData::Text(text.into()),
            Value::Array(elements) => JsonData::Array(elements.into_iter().map(node).collect()),
            Value::Object(members) => {
                JsonData::Object(members.into_iter().map(|(key, value)| (key.into(), node(value))).collect())
            }
        };
        Self { position, bytes: [0; 2], data }
    }

    /// Returns an element of a list by its index.
    pub fn element(&self, index: usize) -> Option<&Self> {
        self.list().get(index)
    }

    /// Returns the elements of a list, `None` where this is no list.
    pub fn as_array(&self) -> Option<&[Self]> {
        matches!(self.data, JsonData::Array(_)).then(|| self.list())
    }

    /// Returns a boolean.
    pub fn as_bool(&self) -> Option<bool> {
        if let JsonData::Bool(value) = self.data { Some(value) } else { None }
    }

    /// Returns a text.
    pub fn as_str(&self) -> Option<&str> {
        if let JsonData::Text(text) = &self.data { Some(text) } else { None }
    }

    /// Returns a number that is written as a whole number from 0.
    pub fn as_u64(&self) -> Option<u64> {
        if let JsonData::Number(text) = &self.data { text.parse().ok() } else { None }
    }

    /// Returns a finite number.
    pub fn as_f64(&self) -> Option<f64> {
        let JsonData::Number(text) = &self.data else { return None };
        text.parse().ok().filter(|number: &f64| number.is_finite())
    }

    /// Returns whether this is `null`.
    pub fn is_null(&self) -> bool {
        self.data == JsonData::Null
    }

    /// Returns whether this is an object.
    pub fn is_object(&self) -> bool {
        matches!(self.data, JsonData::Object(_))
    }

    /// Returns the value without positions. Numbers that are not finite become `null`; the last one of equal keys counts.
    pub fn to_value(&self) -> Value {
        match &self.data {
            JsonData::Null => Value::Null,
            JsonData::Bool(value) => Value::Bool(*value),
            JsonData::Number(text) => serde_json::from_str(text).unwrap_or_default(),
            JsonData::Text(text) => Value::String(text.to_string()),
            JsonData::Array(elements) => elements.iter().map(Self::to_value).collect(),
            JsonData::Object(members) => {
                members.iter().map(|(key, member)| (key.to_string(), member.to_value())).collect()
            }
        }
    }

    /// Returns the members of an object in the order of the text; none where this is no object.
    pub fn members(&self) -> &[JsonMember<'_>] {
        match &self.data {
            JsonData::Object(members) => members,
            _ => &[],
        }
    }

    /// Returns the byte at which another member can be inserted, and the text that has to precede it; `None` where this is no
    /// object.
    pub fn end_of_members(&self) -> Option<(usize, &'static str)> {
        match &self.data {
            JsonData::Object(members) => Some(match members.last() {
                Some((_, last)) => (last.span().end, ", "),
                None => (self.span().start + 1, ""),
            }),
            _ => None,
        }
    }
}
