//! Converts bytes to values. Messages that are too large, are not JSON, or contain numbers that cannot be computed with
//! are refused with a reason.

use super::validate::{self, VERBATIM};
use crate::unique_keys::UniqueKeysJson;
use serde::de::DeserializeOwned;
use serde_json::Value;
use std::fmt;

pub use super::validate::MessageLimits;

/// Why a message is refused.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DecodeError {
    /// Field of the message, such as `nodes[2].nodePosition.x`; empty for the whole message.
    pub field: String,
    /// What is wrong there, in words.
    pub why: String,
}

impl DecodeError {
    /// A refusal because of a field.
    pub fn new(field: impl Into<String>, why: impl fmt::Display) -> Self {
        Self { field: field.into(), why: why.to_string() }
    }
}

impl fmt::Display for DecodeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.field.as_str() {
            "" => f.write_str(&self.why),
            field => write!(f, "{field}: {}", self.why),
        }
    }
}

impl std::error::Error for DecodeError {}

/// Reads a message. `null` counts as a missing field, because some senders write it for unknown values.
///
/// # Errors
/// [`DecodeError`] with the name of the field.
pub fn read<T: DeserializeOwned>(bytes: &[u8], limits: MessageLimits) -> Result<T, DecodeError> {
    if bytes.len() > limits.bytes {
        return Err(DecodeError::new("", format!("{} bytes; at most {} are read", bytes.len(), limits.bytes)));
    }
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    validate::check(bytes, limits).map_err(|(field, why)| DecodeError::new(field, why))?;
    // The fast path: only a message with an error or with `null` is parsed into a tree first.
    let has_null = bytes.windows(4).any(|part| part == b"null");
    if let Some(message) = (!has_null).then(|| serde_json::from_slice(bytes).ok()).flatten() {
        return Ok(message);
    }
    let UniqueKeysJson(value) = serde_json::from_slice(bytes).map_err(|error| DecodeError::new("", error))?;
    decoded(value)
}

/// Reads a message from its tree, as [`read`] does, without limits of its size.
///
/// # Errors
/// [`DecodeError`] with the name of the field.
pub fn from_value<T: DeserializeOwned>(value: Value) -> Result<T, DecodeError> {
    validate::check_tree(&value, MessageLimits::NONE).map_err(|(field, why)| DecodeError::new(field, why))?;
    decoded(value)
}

fn decoded<T: DeserializeOwned>(mut value: Value) -> Result<T, DecodeError> {
    drop_null(&mut value);
    serde_path_to_error::deserialize(value).map_err(|error| {
        let path = error.path().to_string();
        DecodeError::new(if path == "." { String::new() } else { path }, error.into_inner())
    })
}

fn drop_null(value: &mut Value) {
    match value {
        Value::Array(list) => list.iter_mut().for_each(drop_null),
        Value::Object(members) => {
            members.retain(|name, value| name == VERBATIM || !value.is_null());
            members.iter_mut().filter(|(name, _)| *name != VERBATIM).for_each(|(_, value)| drop_null(value));
        }
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use super::super::order::Order;
    use super::super::state::State;
    use super::*;

    /// As bytes, and as a tree if it is one: with the same words.
    fn refused(text: &str) -> String {
        let refused = read::<Order>(text.as_bytes(), MessageLimits::default()).unwrap_err().to_string();
        if let Ok(UniqueKeysJson(tree)) = serde_json::from_str(text)
            && !refused.contains("at most")
        {
            assert_eq!(from_value::<Order>(tree).unwrap_err().to_string(), refused);
        }
        refused
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
        assert!(read::<Order>(order("1").as_bytes(), MessageLimits::default()).is_ok());
        assert!(
            refused(&order("\"1\"")).starts_with("nodes[0].nodePosition.x: invalid type"),
            "{}",
            refused(&order("\"1\""))
        );
        assert!(refused(&order("1e11")).starts_with("nodes[0].nodePosition.x: 100000000000.0 is out of range"));
        assert!(refused(&order("1e999")).contains("out of range"));
        assert!(refused(&order("null")).starts_with("nodes[0].nodePosition: missing field `x`"));
        assert_eq!(
            refused(&order("1").replace("\"headerId\":1", "\"headerId\":\"1\"")),
            "headerId: not a number of a message"
        );
        assert_eq!(refused(&order("1").replace("\"t\"", "5")), "timestamp: not a text");
        assert!(
            refused(&order("1").replace("\"t\"", "null").replace("2.1.0", &"2".repeat(5_000)))
                .starts_with("version: 5000 bytes")
        );
        assert!(refused("{").starts_with("EOF"));
        let twice = order("1").replace("\"orderId\":\"o\"", "\"orderId\":\"o\",\"orderId\":\"p\"");
        assert!(refused(&twice).starts_with("\"orderId\" is there twice"), "{}", refused(&twice));
        let twice = order("1").replace("\"y\":0", "\"y\":0,\"y\":1");
        assert!(refused(&twice).starts_with("\"y\" is there twice"), "{}", refused(&twice));
        assert!(refused(&"[".repeat(500)).contains("recursion"));
        assert!(refused(&format!("\"{}\"", "x".repeat(5_000))).contains("a text has at most"));
        assert!(refused(&format!("[{}0]", "0,".repeat(3_000))).contains("a list has at most 2000"));
        assert!(refused(&" ".repeat(300_000)).contains("at most 262144 are read"));
    }

    /// Lists of a state are kept as they were written, but for what is nothing.
    #[test]
    fn what_is_passed_on_is_read_all_the_same() {
        let state = |node: &str| {
            let text = format!(
                r#"{{"orderId":"","orderUpdateId":0,"lastNodeId":"","lastNodeSequenceId":0,"driving":false,"actionStates":[],"operatingMode":"AUTOMATIC",
                    "errors":[],"edgeStates":[],"nodeStates":[{{"nodeId":"A","sequenceId":2,"released":true,"own":[1]}},{node}]}}"#
            );
            read::<State>(text.as_bytes(), MessageLimits::default())
        };
        let read = state(r#"{"nodeId":"B","sequenceId":4,"released":false,"nodePosition":null}"#).unwrap();
        assert_eq!((read.base(), read.node_states.len()), (2, 2));
        let written = serde_json::to_string(&read).unwrap();
        assert!(written.contains(r#""own":[1]"#) && !written.contains("null"), "{written}");
        for wrong in
            [r#"{"nodeId":"B","sequenceId":"4","released":false}"#, r#"{"nodeId":5,"sequenceId":4,"released":false}"#]
        {
            let refusal = state(wrong).unwrap_err();
            assert!(refusal.field == "nodeStates" && refusal.why.starts_with("[1]."), "{refusal}");
        }
        assert_eq!(state(r#"{"sequenceId":1e11}"#).unwrap_err().field, "nodeStates[1].sequenceId");
    }
}
