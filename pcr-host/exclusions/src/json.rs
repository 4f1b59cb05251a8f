//! JSON with the span of every value. The text must be valid JSON, which the caller has checked by parsing it.

use std::ops::Range;

/// A value with its span.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Spanned {
    pub(crate) span: Range<usize>,
    pub(crate) value: Value,
}

/// A value.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Value {
    Object(Vec<(String, Spanned)>),
    Array(Vec<Spanned>),
    Scalar,
}

impl Spanned {
    /// The value of a JSON text; `None` if it is invalid.
    pub(crate) fn of(text: &str) -> Option<Self> {
        let start = if text.starts_with('\u{feff}') { '\u{feff}'.len_utf8() } else { 0 };
        Reader { text, at: start }.value()
    }

    /// The last member of this name, which is the one that counts.
    pub(crate) fn get(&self, name: &str) -> Option<&Self> {
        match &self.value {
            Value::Object(members) => members.iter().rev().find(|(key, _)| key == name).map(|(_, value)| value),
            _ => None,
        }
    }

    /// The elements of a list.
    pub(crate) fn list(&self) -> &[Self] {
        match &self.value {
            Value::Array(elements) => elements,
            _ => &[],
        }
    }

    /// Offset at which another member can be inserted, and the text that has to precede it.
    pub(crate) fn end_of_members(&self) -> Option<(usize, &'static str)> {
        match &self.value {
            Value::Object(members) => Some(match members.last() {
                Some((_, last)) => (last.span.end, ", "),
                None => (self.span.start + 1, ""),
            }),
            _ => None,
        }
    }
}

struct Reader<'t> {
    text: &'t str,
    at: usize,
}

impl Reader<'_> {
    fn rest(&self) -> &[u8] {
        self.text.as_bytes().get(self.at..).unwrap_or_default()
    }

    /// The next byte that is not white space.
    fn next(&mut self) -> Option<u8> {
        let blanks = self.rest().iter().take_while(|byte| b" \t\r\n".contains(byte)).count();
        self.at += blanks;
        self.rest().first().copied()
    }

    fn string(&mut self) -> Option<String> {
        let start = self.at;
        self.at += 1;
        loop {
            match self.rest().first()? {
                b'"' => break,
                b'\\' => self.at += 2,
                _ => self.at += 1,
            }
        }
        self.at += 1;
        serde_json::from_str(self.text.get(start..self.at)?).ok()
    }

    fn value(&mut self) -> Option<Spanned> {
        let first = self.next()?;
        let start = self.at;
        let value = match first {
            b'{' => {
                let mut members = Vec::new();
                self.at += 1;
                while self.next()? != b'}' {
                    let key = self.string()?;
                    if self.next()? == b':' {
                        self.at += 1;
                    }
                    members.push((key, self.value()?));
                    if self.next()? == b',' {
                        self.at += 1;
                    }
                }
                self.at += 1;
                Value::Object(members)
            }
            b'[' => {
                let mut elements = Vec::new();
                self.at += 1;
                while self.next()? != b']' {
                    elements.push(self.value()?);
                    if self.next()? == b',' {
                        self.at += 1;
                    }
                }
                self.at += 1;
                Value::Array(elements)
            }
            b'"' => {
                self.string()?;
                Value::Scalar
            }
            _ => {
                self.at += self.rest().iter().take_while(|byte| !b" \t\r\n,]}".contains(byte)).count().max(1);
                Value::Scalar
            }
        };
        Some(Spanned { span: start..self.at, value })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spans_are_those_of_the_values() {
        let text = "\u{feff} {\"a\": [1, -2.5e3 , \"x\\\"]\\u00e9\"], \"b\" :{ } ,\"c\":null}\n";
        let whole = Spanned::of(text).unwrap();
        let at = |value: &Spanned| &text[value.span.clone()];
        assert!(at(&whole).starts_with('{') && at(&whole).ends_with('}'));
        let list: Vec<&str> = whole.get("a").unwrap().list().iter().map(at).collect();
        assert_eq!(list, ["1", "-2.5e3", "\"x\\\"]\\u00e9\""]);
        assert_eq!((at(whole.get("b").unwrap()), at(whole.get("c").unwrap())), ("{ }", "null"));
        assert_eq!(whole.get("b").unwrap().end_of_members().unwrap().1, "");
        assert_eq!(whole.get("d"), None);
        for cut in 0..text.len() {
            // No prefix of a text leads to a hang or a panic.
            if let Some(part) = text.get(..cut) {
                let _ = Spanned::of(part);
            }
        }
    }
}
