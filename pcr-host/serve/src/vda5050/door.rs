//! From bytes to values: what is too large, no JSON, or holds numbers that nobody computes with is refused by name.

use serde::de::DeserializeOwned;
use serde_json::Value;
use std::fmt;

/// Largest magnitude of a number that is read \[m, s\].
const LARGEST: f64 = 1e10;

/// What is read of parameters of actions is passed on as it is, `null` included.
const VERBATIM: &str = "actionParameters";

/// How large messages may be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// \[bytes\]
    pub bytes: usize,
    /// Elements of one list.
    pub list: usize,
    /// \[bytes\] of one text.
    pub text: usize,
}

impl Default for Limits {
    fn default() -> Self {
        Self { bytes: 256 * 1024, list: 2_000, text: 4_096 }
    }
}

/// Why a message is refused.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Refusal {
    /// Where in the message, as `nodes[2].nodePosition.x`; empty if it is all of it.
    pub field: String,
    /// What is wrong there.
    pub why: String,
}

impl Refusal {
    /// Something wrong with a field.
    pub fn new(field: impl Into<String>, why: impl fmt::Display) -> Self {
        Self { field: field.into(), why: why.to_string() }
    }
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.field.as_str() {
            "" => f.write_str(&self.why),
            field => write!(f, "{field}: {}", self.why),
        }
    }
}

impl std::error::Error for Refusal {}

/// Reads a message. `null` is as good as nothing: some senders write it for what they do not know.
///
/// # Errors
/// [`Refusal`] with the field.
pub fn read<T: DeserializeOwned>(bytes: &[u8], limits: Limits) -> Result<T, Refusal> {
    if bytes.len() > limits.bytes {
        return Err(Refusal::new("", format!("{} bytes; at most {} are read", bytes.len(), limits.bytes)));
    }
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let mut value: Value = serde_json::from_slice(bytes).map_err(|error| Refusal::new("", error))?;
    bounded(&mut value, limits, &mut Place::default())?;
    header(&value)?;
    serde_path_to_error::deserialize(value).map_err(|error| {
        let path = error.path().to_string();
        Refusal::new(if path == "." { String::new() } else { path }, error.into_inner())
    })
}

/// The fields of headers, which have their types in every message.
fn header(value: &Value) -> Result<(), Refusal> {
    for field in ["timestamp", "version", "manufacturer", "serialNumber"] {
        if value.get(field).is_some_and(|value| !value.is_string()) {
            return Err(Refusal::new(field, "not a text"));
        }
    }
    if value.get("headerId").is_some_and(|value| !value.is_u64()) {
        return Err(Refusal::new("headerId", "not a number of a message"));
    }
    Ok(())
}

/// Where in a message.
#[derive(Default)]
struct Place(Vec<String>);

impl Place {
    fn refused(&self, why: impl fmt::Display) -> Refusal {
        Refusal::new(self.0.concat().trim_start_matches('.'), why)
    }
}

/// Checks all of a value, and drops `null`.
fn bounded(value: &mut Value, limits: Limits, place: &mut Place) -> Result<(), Refusal> {
    match value {
        Value::Null | Value::Bool(_) => {}
        Value::Number(number) => {
            if !number.as_f64().is_some_and(|number| number.abs() <= LARGEST) {
                return Err(place.refused(format!("{number} is out of range; allowed is up to {LARGEST:e}")));
            }
        }
        Value::String(text) => {
            if text.len() > limits.text {
                return Err(place.refused(format!("{} bytes; a text has at most {}", text.len(), limits.text)));
            }
        }
        Value::Array(list) => {
            if list.len() > limits.list {
                return Err(place.refused(format!("{} elements; a list has at most {}", list.len(), limits.list)));
            }
            for (k, element) in list.iter_mut().enumerate() {
                place.0.push(format!("[{k}]"));
                bounded(element, limits, place)?;
                place.0.pop();
            }
        }
        Value::Object(members) => {
            members.retain(|name, value| name == VERBATIM || !value.is_null());
            for (name, value) in members.iter_mut().filter(|(name, _)| *name != VERBATIM) {
                place.0.push(format!(".{name}"));
                bounded(value, limits, place)?;
                place.0.pop();
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vda5050::order::Order;

    fn refused(text: &str) -> String {
        read::<Order>(text.as_bytes(), Limits::default()).unwrap_err().to_string()
    }

    #[test]
    fn refusals_name_the_field() {
        let node =
            r#"{"nodeId":"A","sequenceId":0,"released":true,"actions":[],"nodePosition":{"x":XX,"y":0,"mapId":"m"}}"#;
        let order = |x: &str| {
            format!(
                r#"{{"headerId":1,"timestamp":"t","version":"2.1.0","manufacturer":"m","serialNumber":"s","orderId":"o","orderUpdateId":0,"nodes":[{}],"edges":[]}}"#,
                node.replace("XX", x)
            )
        };
        assert!(read::<Order>(order("1").as_bytes(), Limits::default()).is_ok());
        assert!(
            refused(&order("\"1\"")).starts_with("nodes[0].nodePosition.x: invalid type"),
            "{}",
            refused(&order("\"1\""))
        );
        assert!(refused(&order("1e11")).starts_with("nodes[0].nodePosition.x: 100000000000.0 is out of range"));
        assert!(refused(&order("1e999")).contains("out of range"));
        assert!(refused(&order("null")).starts_with("nodes[0].nodePosition: missing field `x`"));
        assert!(refused("{").starts_with("EOF"));
        assert!(refused(&"[".repeat(500)).contains("recursion"));
        assert!(refused(&format!("\"{}\"", "x".repeat(5_000))).contains("a text has at most"));
        assert!(refused(&format!("[{}0]", "0,".repeat(3_000))).contains("a list has at most"));
        assert!(refused(&" ".repeat(300_000)).contains("at most 262144 are read"));
    }
}
