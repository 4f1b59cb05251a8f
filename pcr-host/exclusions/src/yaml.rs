//! YAML with the span of every value.

use granit_parser::{Event, Parser};
use std::ops::Range;

/// A value and where it is.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Spanned {
    pub(crate) span: Range<usize>,
    pub(crate) value: Value,
}

/// What it is.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Value {
    Mapping(Vec<(String, Spanned)>),
    Sequence(Vec<Spanned>),
    Scalar(String),
    /// It stands for a value elsewhere.
    Alias,
}

impl Spanned {
    /// The value of the first document; nothing where it is none, or nested too deep.
    pub(crate) fn of(text: &str) -> Option<Self> {
        let mut parser = Parser::new_from_str(text);
        loop {
            let (event, span) = parser.next()?.ok()?;
            if let Event::MappingStart(..) | Event::SequenceStart(..) | Event::Scalar(..) = event {
                return node(&event, span.byte_range()?, &mut parser, 0);
            }
        }
    }

    /// A member.
    pub(crate) fn get(&self, name: &str) -> Option<&Self> {
        match &self.value {
            Value::Mapping(members) => members.iter().find(|(key, _)| key == name).map(|(_, value)| value),
            _ => None,
        }
    }

    /// The members of a mapping.
    pub(crate) fn members(&self) -> &[(String, Self)] {
        match &self.value {
            Value::Mapping(members) => members,
            _ => &[],
        }
    }

    /// The elements of a list.
    pub(crate) fn list(&self) -> &[Self] {
        match &self.value {
            Value::Sequence(elements) => elements,
            _ => &[],
        }
    }

    /// The text of a scalar.
    pub(crate) fn text(&self) -> Option<&str> {
        match &self.value {
            Value::Scalar(text) => Some(text),
            _ => None,
        }
    }
}

/// Deepest nesting that is read.
const DEPTH: usize = 100;

fn node<'t, I>(event: &Event<'t>, span: Range<usize>, parser: &mut I, depth: usize) -> Option<Spanned>
where
    I: Iterator<Item = Result<(Event<'t>, granit_parser::Span), granit_parser::ScanError>>,
{
    if depth > DEPTH {
        return None;
    }
    let following = |parser: &mut I| {
        let (event, span) = parser.next()?.ok()?;
        Some((event, span.byte_range()?))
    };
    let mut whole = span;
    let value = match event {
        Event::Scalar(text, ..) => Value::Scalar(text.to_string()),
        Event::Alias(_) => Value::Alias,
        Event::SequenceStart(..) => {
            let mut elements = Vec::new();
            loop {
                let (event, span) = following(parser)?;
                if matches!(event, Event::SequenceEnd) {
                    whole.end = span.end;
                    break Value::Sequence(elements);
                }
                elements.push(node(&event, span, parser, depth + 1)?);
            }
        }
        Event::MappingStart(..) => {
            let mut members = Vec::new();
            loop {
                let (event, span) = following(parser)?;
                if matches!(event, Event::MappingEnd) {
                    whole.end = span.end;
                    break Value::Mapping(members);
                }
                let key = node(&event, span, parser, depth + 1)?;
                let (event, span) = following(parser)?;
                let value = node(&event, span, parser, depth + 1)?;
                members.push((key.text()?.to_owned(), value));
            }
        }
        _ => return None,
    };
    Some(Spanned { span: whole, value })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spans_are_those_of_the_values() {
        let text = "# ä\nlevels:\n  L1:\n    lanes:\n      - [0, 1, {bidirectional: [4, true], mutex: [1, \"\"]}]\n      - [1, 2]\n    name: é\n";
        let whole = Spanned::of(text).unwrap();
        let lanes = whole.get("levels").unwrap().get("L1").unwrap().get("lanes").unwrap();
        let at = |value: &Spanned| &text[value.span.clone()];
        assert_eq!(
            lanes.list().iter().map(at).collect::<Vec<_>>(),
            ["[0, 1, {bidirectional: [4, true], mutex: [1, \"\"]}]", "[1, 2]"]
        );
        let parameters = &lanes.list()[0].list()[2];
        assert_eq!(at(parameters.get("mutex").unwrap()), "[1, \"\"]");
        assert_eq!(at(&parameters.get("mutex").unwrap().list()[1]), "\"\"");
        assert_eq!(whole.get("levels").unwrap().get("L1").unwrap().get("name").unwrap().text(), Some("é"));
    }
}
