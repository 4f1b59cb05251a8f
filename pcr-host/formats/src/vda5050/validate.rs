//! Checks the bounds of all values of a message, and the types in its header, in one pass that stores nothing.

use serde::Deserialize;
use serde::de::{DeserializeSeed, Deserializer, Error, IgnoredAny, MapAccess, SeqAccess, Visitor};
use serde_json::Value;
use std::borrow::Cow;
use std::fmt;

/// Largest magnitude of a number that is read \[m, s\].
const LARGEST: f64 = 1e10;

/// Parameters of actions are not checked, because they are passed on unread.
pub(super) const VERBATIM: &str = "actionParameters";

/// Text fields of headers.
const TEXTS: [&str; 4] = ["timestamp", "version", "manufacturer", "serialNumber"];

/// Limits of messages.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MessageLimits {
    /// Size of a message \[bytes\].
    pub bytes: usize,
    /// Number of elements of a list.
    pub list: usize,
    /// Size of a text \[bytes\].
    pub text: usize,
    /// Size of a message that is sent \[bytes\]: brokers end the connection at one that is too large for them.
    pub sent: usize,
}

impl Default for MessageLimits {
    fn default() -> Self {
        Self { bytes: 256 * 1024, list: 2_000, text: 4_096, sent: 16 << 20 }
    }
}

impl MessageLimits {
    /// No limits, for files.
    pub(super) const NONE: Self = Self { bytes: usize::MAX, list: usize::MAX, text: usize::MAX, sent: usize::MAX };
}

/// Checks a whole message.
///
/// # Errors
/// Field and reason for the first value beyond a limit; an empty field for invalid JSON.
pub(super) fn check(bytes: &[u8], limits: MessageLimits) -> Result<(), (String, String)> {
    let mut fault = ValidationError::default();
    let mut reader = serde_json::Deserializer::from_slice(bytes);
    let read = LimitsVisitor::new(limits, &mut fault).deserialize(&mut reader).and_then(|()| reader.end());
    read.map_err(|error| fault.or(&error))
}

/// Checks a message that is a tree already.
///
/// # Errors
/// As [`check`].
pub(super) fn check_tree(message: &Value, limits: MessageLimits) -> Result<(), (String, String)> {
    let mut fault = ValidationError::default();
    let read = LimitsVisitor::new(limits, &mut fault).deserialize(message);
    read.map_err(|error| fault.or(&error))
}

/// The reason for a refusal, and the path of the field, innermost name first.
#[derive(Default)]
struct ValidationError {
    why: Option<String>,
    path: Vec<String>,
}

impl ValidationError {
    /// The path of the field and the reason; those of the reader where nothing was refused here.
    fn or(mut self, error: &serde_json::Error) -> (String, String) {
        let Some(why) = self.why else { return (String::new(), error.to_string()) };
        self.path.reverse();
        (self.path.concat().trim_start_matches('.').into(), why)
    }
}

/// The expected type of a value.
#[derive(Clone, Copy, PartialEq)]
enum ExpectedType {
    Anything,
    Text,
    Count,
}

impl ExpectedType {
    fn of(depth: usize, name: &str) -> Self {
        match name {
            "headerId" if depth == 0 => Self::Count,
            _ if depth == 0 && TEXTS.contains(&name) => Self::Text,
            _ => Self::Anything,
        }
    }
}

struct LimitsVisitor<'f> {
    limits: MessageLimits,
    fault: &'f mut ValidationError,
    depth: usize,
    asked: ExpectedType,
}

impl<'f> LimitsVisitor<'f> {
    fn new(limits: MessageLimits, fault: &'f mut ValidationError) -> Self {
        Self { limits, fault, depth: 0, asked: ExpectedType::Anything }
    }
}

impl LimitsVisitor<'_> {
    fn refused<E: Error>(&mut self, why: impl fmt::Display) -> E {
        self.fault.why = Some(why.to_string());
        E::custom("")
    }

    /// The check of a value within this one.
    fn inner(&mut self, asked: ExpectedType) -> LimitsVisitor<'_> {
        LimitsVisitor { limits: self.limits, fault: &mut *self.fault, depth: self.depth + 1, asked }
    }

    /// Adds the name of a field to an error from within it.
    fn named<E>(&mut self, error: E, name: impl fmt::Display) -> E {
        if self.fault.why.is_some() {
            self.fault.path.push(name.to_string());
        }
        error
    }

    /// Refuses a value where a text is expected, and a value that is no count where a count is expected.
    fn other<E: Error>(&mut self, is_count: bool) -> Result<(), E> {
        match self.asked {
            ExpectedType::Text => Err(self.refused("not a text")),
            ExpectedType::Count if !is_count => Err(self.refused("not a number of a message")),
            _ => Ok(()),
        }
    }

    fn number<E: Error>(&mut self, number: impl fmt::Debug, magnitude: f64, is_count: bool) -> Result<(), E> {
        if magnitude.abs() <= LARGEST {
            return self.other(is_count);
        }
        Err(self.refused(format!("{number:?} is out of range; allowed is up to {LARGEST:e}")))
    }
}

impl<'de> DeserializeSeed<'de> for LimitsVisitor<'_> {
    type Value = ();

    fn deserialize<D: Deserializer<'de>>(self, reader: D) -> Result<(), D::Error> {
        reader.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for LimitsVisitor<'_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("JSON")
    }

    // `null` counts as a missing value.
    fn visit_unit<E: Error>(self) -> Result<(), E> {
        Ok(())
    }

    fn visit_bool<E: Error>(mut self, _: bool) -> Result<(), E> {
        self.other(false)
    }

    fn visit_u64<E: Error>(mut self, number: u64) -> Result<(), E> {
        self.number(number, number as f64, true)
    }

    fn visit_i64<E: Error>(mut self, number: i64) -> Result<(), E> {
        self.number(number, number as f64, false)
    }

    fn visit_f64<E: Error>(mut self, number: f64) -> Result<(), E> {
        self.number(number, number, false)
    }

    fn visit_str<E: Error>(mut self, text: &str) -> Result<(), E> {
        if self.asked == ExpectedType::Count {
            return self.other(false);
        }
        let most = self.limits.text;
        if text.len() > most {
            return Err(self.refused(format!("{} bytes; a text has at most {most}", text.len())));
        }
        Ok(())
    }

    fn visit_seq<A: SeqAccess<'de>>(mut self, mut list: A) -> Result<(), A::Error> {
        self.other(false)?;
        let most = self.limits.list;
        for k in 0.. {
            match list.next_element_seed(self.inner(ExpectedType::Anything)) {
                Ok(None) => break,
                Ok(Some(())) if k < most => {}
                Ok(Some(())) => return Err(self.refused(format!("too long; a list has at most {most} elements"))),
                Err(error) => return Err(self.named(error, format_args!("[{k}]"))),
            }
        }
        Ok(())
    }

    fn visit_map<A: MapAccess<'de>>(mut self, mut members: A) -> Result<(), A::Error> {
        self.other(false)?;
        while let Some(FieldName(name)) = members.next_key()? {
            if name == VERBATIM {
                members.next_value::<IgnoredAny>()?;
                continue;
            }
            let asked = ExpectedType::of(self.depth, &name);
            members.next_value_seed(self.inner(asked)).map_err(|error| self.named(error, format_args!(".{name}")))?;
        }
        Ok(())
    }
}

/// A field name, borrowed if nothing in it is escaped.
#[derive(Deserialize)]
struct FieldName<'a>(#[serde(borrow)] Cow<'a, str>);
