//! Messages in CDR, as ROS 2 sends them and bags hold them: version 1 of the encoding (DDS-XTypes 1.3, 7.4.1), in either order of bytes.

use super::message_schema::{FieldCount, FieldKind, MessageField, MessageSchema, NumberKind};

/// Deepest nesting of messages: definitions that contain themselves have no end.
const DEEPEST: usize = 32;

/// Bytes after the last field: writers fill messages up to a multiple of 4.
const PADDING: usize = 3;

/// A field of a message.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum RosValue {
    Whole(i128),
    Number(f64),
    Text(String),
    List(Vec<RosValue>),
    /// Numbers that were passed over: no pose has such an array.
    Numbers,
    Message(Vec<(String, RosValue)>),
}

impl RosValue {
    /// Reads a message.
    ///
    /// # Errors
    /// What is wrong, and after how many bytes.
    pub(super) fn read(schema: &MessageSchema, bytes: &[u8]) -> Result<Self, String> {
        let Some(([0, encoding, _, _], body)) = bytes.split_at_checked(4) else {
            return Err("no message in CDR: its first four bytes are missing or of another encoding".into());
        };
        let is_little = match encoding {
            0 => false,
            1 => true,
            other => return Err(format!("encoding {other} of CDR, and 0 and 1 are read")),
        };
        let mut reader = CdrReader { schema, body, at: 0, is_little };
        let value = reader.message(0, 0).map_err(|why| format!("{why} (after {} bytes)", reader.at + 4))?;
        match body.len() - reader.at {
            0..=PADDING => Ok(value),
            more => Err(format!("{more} bytes follow its last field: its definition is another one")),
        }
    }

    /// A field of a message, or of messages in it: `header/frame_id`.
    pub(super) fn get(&self, path: &str) -> Result<&Self, String> {
        path.split('/').try_fold(self, |value, name| match value {
            Self::Message(fields) => {
                let field = fields.iter().find(|(field, _)| field == name);
                field.map(|(_, value)| value).ok_or_else(|| format!("no field {path}"))
            }
            _ => Err(format!("no field {path}")),
        })
    }

    /// The number in a field.
    pub(super) fn number(&self, path: &str) -> Result<f64, String> {
        match self.get(path)? {
            Self::Number(number) if number.is_finite() => Ok(*number),
            Self::Number(number) => Err(format!("{path}: {number}, which is no number")),
            Self::Whole(number) => Ok(*number as f64),
            _ => Err(format!("{path}: no number")),
        }
    }

    /// The whole number in a field.
    pub(super) fn whole(&self, path: &str) -> Result<i64, String> {
        match self.get(path)? {
            Self::Whole(number) => i64::try_from(*number).map_err(|_| format!("{path}: {number} is too large")),
            _ => Err(format!("{path}: no whole number")),
        }
    }

    /// The text in a field.
    pub(super) fn text(&self, path: &str) -> Result<&str, String> {
        match self.get(path)? {
            Self::Text(text) => Ok(text),
            _ => Err(format!("{path}: no text")),
        }
    }

    /// The elements of a field.
    pub(super) fn list(&self, path: &str) -> Result<&[Self], String> {
        match self.get(path)? {
            Self::List(list) => Ok(list),
            _ => Err(format!("{path}: no list")),
        }
    }
}

struct CdrReader<'a> {
    schema: &'a MessageSchema,
    body: &'a [u8],
    at: usize,
    is_little: bool,
}

impl<'a> CdrReader<'a> {
    fn message(&mut self, index: usize, depth: usize) -> Result<RosValue, String> {
        if depth > DEEPEST {
            return Err("its definition contains itself".into());
        }
        let fields = self.schema.messages.get(index).map(Vec::as_slice).unwrap_or_default();
        if fields.is_empty() {
            // As generators of code do, because C has no empty structures.
            self.take(1)?;
        }
        let mut values = Vec::with_capacity(fields.len());
        for field in fields {
            values.push((field.name.clone(), self.field(field, depth).map_err(|why| within(&field.name, why))?));
        }
        Ok(RosValue::Message(values))
    }

    fn field(&mut self, field: &MessageField, depth: usize) -> Result<RosValue, String> {
        let count = match field.count {
            FieldCount::One => return self.one(&field.kind, depth),
            FieldCount::Fixed(count) => count,
            FieldCount::Sequence => self.length()?,
        };
        if let FieldKind::Number(_, size) = field.kind {
            if count > 0 {
                self.align(size);
                self.take(count.checked_mul(size).ok_or("more elements than it has bytes")?)?;
            }
            return Ok(RosValue::Numbers);
        }
        let mut list = Vec::new();
        for _ in 0..count {
            list.push(self.one(&field.kind, depth)?);
        }
        Ok(RosValue::List(list))
    }

    fn one(&mut self, kind: &FieldKind, depth: usize) -> Result<RosValue, String> {
        match *kind {
            FieldKind::Number(kind, size) => self.number(kind, size),
            FieldKind::Text => self.text(),
            FieldKind::Message(index) => self.message(index, depth + 1),
        }
    }

    fn number(&mut self, kind: NumberKind, size: usize) -> Result<RosValue, String> {
        self.align(size);
        let bytes = self.take(size)?;
        let mut bits = [0; 8];
        for (k, byte) in bytes.iter().enumerate() {
            bits[if self.is_little { k } else { size - 1 - k }] = *byte;
        }
        let bits = u64::from_le_bytes(bits);
        Ok(match (kind, size) {
            (NumberKind::Float, 4) => RosValue::Number(f64::from(f32::from_bits(bits as u32))),
            (NumberKind::Float, _) => RosValue::Number(f64::from_bits(bits)),
            (NumberKind::Unsigned, _) => RosValue::Whole(i128::from(bits)),
            (NumberKind::Signed, size) => {
                let unused = 64 - 8 * size as u32;
                RosValue::Whole(i128::from((bits << unused) as i64 >> unused))
            }
        })
    }

    fn text(&mut self) -> Result<RosValue, String> {
        let length = self.length()?;
        // The length counts the zero at its end.
        let bytes = self.take(length)?;
        let bytes = bytes.strip_suffix(&[0]).unwrap_or(bytes);
        let text = std::str::from_utf8(bytes).map_err(|_| "a text that is not UTF-8")?;
        Ok(RosValue::Text(text.to_owned()))
    }

    fn length(&mut self) -> Result<usize, String> {
        match self.number(NumberKind::Unsigned, 4)? {
            RosValue::Whole(length) => usize::try_from(length).map_err(|_| "a length that is no number".into()),
            _ => Err("no length".into()),
        }
    }

    fn align(&mut self, size: usize) {
        self.at = self.at.next_multiple_of(size);
    }

    fn take(&mut self, count: usize) -> Result<&'a [u8], String> {
        let end = self.at.checked_add(count);
        let bytes = end.and_then(|end| self.body.get(self.at..end)).ok_or("it ends within its fields")?;
        self.at += count;
        Ok(bytes)
    }
}

/// What is wrong in a field.
fn within(name: &str, why: String) -> String {
    if why.contains(": ") { format!("{name}/{why}") } else { format!("{name}: {why}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "uint8 a\nfloat64 b\nstring c\nint16[] d\nT[] e\n===\nMSG: p/T\nint32 sec\nuint32 nanosec\n";

    fn schema() -> MessageSchema {
        MessageSchema::read("p/msg/M", TEXT).unwrap()
    }

    fn message(is_little: bool) -> Vec<u8> {
        let order = |mut bytes: Vec<u8>| {
            if !is_little {
                bytes.reverse();
            }
            bytes
        };
        let mut bytes = vec![0, u8::from(is_little), 0, 0, 7, 0, 0, 0, 0, 0, 0, 0];
        bytes.extend(order(2.5_f64.to_le_bytes().to_vec()));
        bytes.extend(order(3_u32.to_le_bytes().to_vec()));
        bytes.extend(*b"ab\0\0");
        bytes.extend(order(3_u32.to_le_bytes().to_vec()));
        bytes.extend([0; 8]);
        bytes.extend(order(1_u32.to_le_bytes().to_vec()));
        bytes.extend(order((-5_i32).to_le_bytes().to_vec()));
        bytes.extend(order(6_u32.to_le_bytes().to_vec()));
        bytes
    }

    #[test]
    fn fields_are_read_in_either_order_of_bytes() {
        for is_little in [true, false] {
            let value = RosValue::read(&schema(), &message(is_little)).unwrap();
            assert_eq!((value.whole("a"), value.number("b"), value.text("c")), (Ok(7), Ok(2.5), Ok("ab")));
            assert_eq!(value.get("d"), Ok(&RosValue::Numbers));
            let times = value.list("e").unwrap();
            assert_eq!((times.len(), times[0].whole("sec"), times[0].whole("nanosec")), (1, Ok(-5), Ok(6)));
            assert_eq!(value.number("f").unwrap_err(), "no field f");
        }
    }

    #[test]
    fn a_message_cut_anywhere_is_an_error() {
        let whole = message(true);
        for length in 0..whole.len() {
            assert!(RosValue::read(&schema(), &whole[..length]).is_err(), "{length}");
        }
        let longer = [whole.clone(), vec![0; 4]].concat();
        assert!(RosValue::read(&schema(), &longer).unwrap_err().starts_with("4 bytes follow"));
        let mut other = whole;
        other[1] = 7;
        assert_eq!(RosValue::read(&schema(), &other).unwrap_err(), "encoding 7 of CDR, and 0 and 1 are read");
    }

    #[test]
    fn a_definition_that_contains_itself_ends() {
        let schema = MessageSchema::read("p/msg/M", "M m\n").unwrap();
        assert!(RosValue::read(&schema, &[0, 1, 0, 0, 0]).unwrap_err().contains("contains itself"));
    }
}
