//! YAML with the span of every value.

use granit_parser::{Event, Parser, StructureStyle};
use std::ops::Range;

/// A value with its span.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Spanned {
    /// The text of the value, without an anchor. The span of a block ends with its last value.
    pub(crate) span: Range<usize>,
    pub(crate) value: Value,
    /// Whether it contains an anchor or an alias: then the same text is also the value of something else.
    pub(crate) shared: bool,
}

/// A value.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Value {
    Mapping(Style, Vec<Member>),
    Sequence(Style, Vec<Spanned>),
    Scalar(String),
    /// An alias for a value elsewhere.
    Alias,
}

/// A member of a mapping.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Member {
    /// Offset of its name.
    pub(crate) at: usize,
    pub(crate) name: String,
    pub(crate) value: Spanned,
}

/// In brackets, or on lines of their own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Style {
    Flow,
    Block,
}

impl Spanned {
    /// The value of the first document; `None` if it is invalid or nested too deep.
    pub(crate) fn of(text: &str) -> Option<Self> {
        let mut parser = Parser::new_from_str(text);
        loop {
            let (event, span) = parser.next()?.ok()?;
            if let Event::MappingStart(..) | Event::SequenceStart(..) | Event::Scalar(..) = event {
                return node(text, &event, span.byte_range()?, &mut parser, 0);
            }
        }
    }

    /// The value of a member.
    pub(crate) fn get(&self, name: &str) -> Option<&Self> {
        self.members().iter().find(|member| member.name == name).map(|member| &member.value)
    }

    /// The members of a mapping.
    pub(crate) fn members(&self) -> &[Member] {
        match &self.value {
            Value::Mapping(_, members) => members,
            _ => &[],
        }
    }

    /// The elements of a list.
    pub(crate) fn list(&self) -> &[Self] {
        match &self.value {
            Value::Sequence(_, elements) => elements,
            _ => &[],
        }
    }

    /// The text for a one-line value in its place. A list may begin in the column of its name; a one-line value may not, and is
    /// indented.
    pub(crate) fn instead(&self, value: &str) -> String {
        let is_block = matches!(self.value, Value::Sequence(Style::Block, _) | Value::Mapping(Style::Block, _));
        format!("{}{value}", if is_block { "  " } else { "" })
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

fn style(given: StructureStyle) -> Style {
    match given {
        StructureStyle::Flow => Style::Flow,
        StructureStyle::Block => Style::Block,
    }
}

/// Offset of a list with an element on each line: the dash of its first element, which the parser does not always report.
fn dash(text: &str, first: usize) -> Option<usize> {
    let at = text[..first].rfind('-')?;
    // An anchor and a tag may precede it.
    text[at + 1..first].split_whitespace().all(|word| word.starts_with(['&', '!'])).then_some(at)
}

fn node<'t, I>(text: &str, event: &Event<'t>, span: Range<usize>, parser: &mut I, depth: usize) -> Option<Spanned>
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
    // The parser reports the end of a block where the next value begins, after comments that do not belong to the block.
    let whole = |style: Style, start: Range<usize>, last: Option<usize>, end: Range<usize>| match style {
        Style::Flow => start.start..end.end,
        Style::Block => start.start..last.unwrap_or(start.end),
    };
    Some(match event {
        Event::Scalar(scalar, _, anchor, _) => {
            Spanned { span, value: Value::Scalar(scalar.to_string()), shared: *anchor != 0 }
        }
        Event::Alias(_) => Spanned { span, value: Value::Alias, shared: true },
        Event::SequenceStart(given, anchor, _) => {
            let mut elements: Vec<Spanned> = Vec::new();
            let end = loop {
                let (event, span) = following(parser)?;
                if matches!(event, Event::SequenceEnd) {
                    break span;
                }
                elements.push(node(text, &event, span, parser, depth + 1)?);
            };
            let style = style(*given);
            let shared = *anchor != 0 || elements.iter().any(|element| element.shared);
            let mut span = whole(style, span, elements.last().map(|last| last.span.end), end);
            if let (Style::Block, Some(first)) = (style, elements.first()) {
                span.start = dash(text, first.span.start)?;
            }
            Spanned { span, value: Value::Sequence(style, elements), shared }
        }
        Event::MappingStart(given, anchor, _) => {
            let mut members: Vec<Member> = Vec::new();
            let mut shared = *anchor != 0;
            let end = loop {
                let (event, span) = following(parser)?;
                if matches!(event, Event::MappingEnd) {
                    break span;
                }
                let key = node(text, &event, span, parser, depth + 1)?;
                let (event, span) = following(parser)?;
                let value = node(text, &event, span, parser, depth + 1)?;
                shared |= key.shared || value.shared;
                members.push(Member { at: key.span.start, name: key.text()?.to_owned(), value });
            };
            let style = style(*given);
            let span = whole(style, span, members.last().map(|last| last.value.span.end), end);
            Spanned { span, value: Value::Mapping(style, members), shared }
        }
        _ => return None,
    })
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

    #[test]
    fn blocks_end_with_their_last_value() {
        let text = "\u{feff}lanes:\r\n- - 0 # from\r\n  - 1\r\n  - speed_limit: 0.5\r\n    mutex: é # group\r\n# next\r\n- - 1\r\n  - 2\r\n  - {}\r\n# the end\r\nmore: [1, ]\r\n";
        let whole = Spanned::of(text).unwrap();
        let at = |value: &Spanned| &text[value.span.clone()];
        let lanes = whole.get("lanes").unwrap();
        assert_eq!(
            lanes.list().iter().map(at).collect::<Vec<_>>(),
            ["- 0 # from\r\n  - 1\r\n  - speed_limit: 0.5\r\n    mutex: é", "- 1\r\n  - 2\r\n  - {}"]
        );
        let parameters = &lanes.list()[0].list()[2];
        assert_eq!(at(parameters), "speed_limit: 0.5\r\n    mutex: é");
        let names: Vec<&str> = parameters.members().iter().map(|member| &text[member.at..][..5]).collect();
        assert_eq!(names, ["speed", "mutex"]);
        assert!(matches!(parameters.value, Value::Mapping(Style::Block, _)));
        assert!(matches!(lanes.list()[1].list()[2].value, Value::Mapping(Style::Flow, _)));
        assert_eq!(at(whole.get("more").unwrap()), "[1, ]");
        assert!(at(lanes).starts_with("- - 0") && at(lanes).ends_with("- {}"));
        let text = "a:\n  b:\n  - 1\n  -  -2\n  c: 3\n";
        let whole = Spanned::of(text).unwrap();
        assert_eq!(&text[whole.get("a").unwrap().get("b").unwrap().span.clone()], "- 1\n  -  -2");
        assert!(!whole.shared);
    }

    #[test]
    fn what_is_the_value_of_something_else_too_is_told() {
        let list = Spanned::of("- &l [1]\n- !!str &m 2\n").unwrap();
        assert!(list.shared && list.span.start == 0);
        let text = "a: &x {k: &y 1}\nb: *x\nc: [1, *y]\nd: &z [2]\ne: 3\n";
        let whole = Spanned::of(text).unwrap();
        let shared: Vec<bool> = whole.members().iter().map(|member| member.value.shared).collect();
        assert_eq!(shared, [true, true, true, true, false]);
        assert_eq!(&text[whole.get("d").unwrap().span.clone()], "[2]");
    }
}
