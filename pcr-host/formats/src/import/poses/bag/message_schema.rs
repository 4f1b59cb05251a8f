//! Definitions of messages of ROS 2, as bags have them: `ros2msg`, the text of the message and of all that it contains.

use super::super::super::ImportError;
use std::collections::HashMap;

/// A number of a message.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum NumberKind {
    Unsigned,
    Signed,
    Float,
}

/// What a field holds, or each element of it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum FieldKind {
    /// A number of so many bytes.
    Number(NumberKind, usize),
    Text,
    /// The fields of the message of this index.
    Message(usize),
}

/// How many a field holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum FieldCount {
    One,
    Fixed(usize),
    /// The number of elements is in the message.
    Sequence,
}

/// A field of a message.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct MessageField {
    pub(super) name: String,
    pub(super) kind: FieldKind,
    pub(super) count: FieldCount,
}

/// The fields of a message and of all that it contains; those of itself are the first.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct MessageSchema {
    pub(super) messages: Vec<Vec<MessageField>>,
}

impl MessageSchema {
    /// Reads the definition of a message of this name, such as `nav_msgs/msg/Odometry`.
    pub(super) fn read(name: &str, text: &str) -> Result<Self, ImportError> {
        let mut parts = vec![(short_name(name), Vec::new())];
        let mut is_rule = false;
        for line in text.lines() {
            let line = line.split('#').next().unwrap_or_default().trim();
            if line.len() > 1 && line.bytes().all(|byte| byte == b'=') {
                is_rule = true;
            } else if let Some(part) = line.strip_prefix("MSG:").filter(|_| is_rule) {
                parts.push((short_name(part.trim()), Vec::new()));
                is_rule = false;
            } else if let Some((_, lines)) = parts.last_mut().filter(|_| !line.is_empty()) {
                lines.push(line);
            }
        }
        let indices: HashMap<String, usize> =
            parts.iter().enumerate().rev().map(|(index, (name, _))| (name.clone(), index)).collect();
        let mut messages = Vec::with_capacity(parts.len());
        for (part, lines) in &parts {
            let mut fields = Vec::new();
            for line in lines {
                let wrong = |why: String| ImportError::new(format!("definition of {name}: {part}: {why}"));
                fields.extend(field(line, part, &indices).map_err(wrong)?);
            }
            messages.push(fields);
        }
        Ok(Self { messages })
    }
}

/// A name of a message without `msg`, which definitions leave out.
pub(super) fn short_name(name: &str) -> String {
    name.replace("/msg/", "/")
}

/// The field on a line; nothing for a constant.
fn field(line: &str, message: &str, indices: &HashMap<String, usize>) -> Result<Option<MessageField>, String> {
    let unknown = || format!("`{line}` is no field");
    let (kind, rest) = line.split_once(char::is_whitespace).ok_or_else(unknown)?;
    let rest = rest.trim();
    let name = rest.split([' ', '\t', '=']).next().unwrap_or_default();
    if name.is_empty() {
        return Err(unknown());
    }
    if rest.get(name.len()..).is_some_and(|value| value.trim_start().starts_with('=')) {
        return Ok(None);
    }
    let (kind, count) = match kind.split_once('[') {
        None => (kind, FieldCount::One),
        Some((kind, size)) => match size.strip_suffix(']').ok_or_else(unknown)? {
            size if size.is_empty() || size.starts_with("<=") => (kind, FieldCount::Sequence),
            size => (kind, FieldCount::Fixed(size.parse().map_err(|_| unknown())?)),
        },
    };
    let bounded = kind.split("<=").next().unwrap_or_default();
    use NumberKind::{Float, Signed, Unsigned};
    let kind = match bounded {
        "bool" | "byte" | "char" | "uint8" => FieldKind::Number(Unsigned, 1),
        "int8" => FieldKind::Number(Signed, 1),
        "uint16" => FieldKind::Number(Unsigned, 2),
        "int16" => FieldKind::Number(Signed, 2),
        "uint32" => FieldKind::Number(Unsigned, 4),
        "int32" => FieldKind::Number(Signed, 4),
        "uint64" => FieldKind::Number(Unsigned, 8),
        "int64" => FieldKind::Number(Signed, 8),
        "float32" => FieldKind::Number(Float, 4),
        "float64" => FieldKind::Number(Float, 8),
        "string" => FieldKind::Text,
        other => {
            // Without its package it is of the same one.
            let package = message.split('/').next().unwrap_or_default();
            let whole = if other.contains('/') { short_name(other) } else { format!("{package}/{other}") };
            let index = indices.get(&whole).ok_or_else(|| format!("{other} is not defined"))?;
            FieldKind::Message(*index)
        }
    };
    Ok(Some(MessageField { name: name.to_owned(), kind, count }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_constants_and_contained_messages_are_read() {
        let text = "# a fleet\nstring name\nuint8 MODE_IDLE=0\nint32 X = 3\nRobotState[] robots\nfloat64[36] covariance\n\
                    uint8[<=4] few\nstring<=7 word \"none\"\n===\nMSG: rmf_fleet_msgs/RobotState\nstring name\nbuiltin_interfaces/Time t\n\
                    ===\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n";
        let schema = MessageSchema::read("rmf_fleet_msgs/msg/FleetState", text).unwrap();
        let names: Vec<&str> = schema.messages[0].iter().map(|field| field.name.as_str()).collect();
        assert_eq!(names, ["name", "robots", "covariance", "few", "word"]);
        let counts: Vec<FieldCount> = schema.messages[0].iter().map(|field| field.count).collect();
        let (one, sequence) = (FieldCount::One, FieldCount::Sequence);
        assert_eq!(counts, [one, sequence, FieldCount::Fixed(36), sequence, one]);
        assert_eq!(schema.messages[0][1].kind, FieldKind::Message(1));
        assert_eq!(schema.messages[1][1].kind, FieldKind::Message(2));
        assert_eq!(schema.messages[2][0].kind, FieldKind::Number(NumberKind::Signed, 4));
    }

    #[test]
    fn what_is_not_defined_is_an_error() {
        for (text, why) in [
            ("Pose pose\n", "Pose is not defined"),
            ("wstring name\n", "wstring is not defined"),
            ("float64\n", "`float64` is no field"),
            ("float64[x] a\n", "`float64[x] a` is no field"),
        ] {
            let error = MessageSchema::read("p/msg/M", text).unwrap_err().to_string();
            assert_eq!(error, format!("definition of p/msg/M: p/M: {why}"));
        }
    }
}
