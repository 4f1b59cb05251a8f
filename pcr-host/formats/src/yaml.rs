//! YAML with the place of every value.
//!
//! ```text
//! json     as a value of JSON: aliases, merge keys
//! scalar   what a scalar stands for: numbers, words, text
//! ```
//!
//! Names are those of the text and unique, and there is one document. What a JSON value cannot say is refused: numbers that are not
//! finite, names that are null or lists. Limits protect from texts that are small and stand for very much.

mod json;
mod scalar;

use crate::json::LONGEST;
use granit_parser::{ErrorKind, Event, Parser, ScalarStyle, StrInput, StructureStyle};
use std::borrow::Cow;
use std::fmt;
use std::ops::Range;

/// Lists and mappings inside one another; a building needs 7. What reads them recurses, so this bounds the stack.
const DEEPEST: usize = 64;

/// Why a text is not read.
#[derive(Clone, Debug, PartialEq)]
pub struct YamlError {
    /// Counted from 1.
    pub line: usize,
    /// Character in the line, counted from 1.
    pub column: usize,
    /// What is wrong there.
    pub problem: String,
    /// Whether it may be YAML, and a limit is exceeded.
    pub is_limit: bool,
}

impl YamlError {
    /// What is wrong, without its place.
    pub fn cause(&self) -> String {
        let what = if self.is_limit { "too large or too deep" } else { "not YAML" };
        format!("{what}: {}", self.problem)
    }
}

impl fmt::Display for YamlError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "line {}, column {}: {}", self.line, self.column, self.cause())
    }
}

impl std::error::Error for YamlError {}

/// What a text says.
#[derive(Clone, Debug)]
pub struct YamlDocument<'t> {
    text: &'t str,
    /// All of it; null if there is nothing.
    pub root: YamlNode<'t>,
    /// Whether all spans are as told. They are not where comments are before the first element of a list, or where a name is no scalar.
    pub is_placed: bool,
}

/// A value with its span.
#[derive(Clone, Debug, PartialEq)]
pub struct YamlNode<'t> {
    /// The bytes of the value, without an anchor. The span of a block ends with its last value.
    pub span: Range<usize>,
    /// What it is.
    pub value: YamlValue<'t>,
    /// Whether it contains an anchor or an alias: then the same text is also the value of something else.
    pub shared: bool,
    /// The number of its anchor; 0 without one.
    anchor: usize,
    kind: ScalarTag,
}

/// A value.
#[derive(Clone, Debug, PartialEq)]
pub enum YamlValue<'t> {
    /// Names and values, in their order.
    Mapping(CollectionStyle, Vec<MappingMember<'t>>),
    /// A list.
    Sequence(CollectionStyle, Vec<YamlNode<'t>>),
    /// A text, number or word, without its quotes.
    Scalar(Cow<'t, str>),
    /// An alias for a value before it, with the number of the anchor.
    Alias(usize),
}

/// A member of a mapping.
#[derive(Clone, Debug, PartialEq)]
pub struct MappingMember<'t> {
    /// Its name, which should be a scalar.
    pub key: YamlNode<'t>,
    /// Its value.
    pub value: YamlNode<'t>,
}

/// In brackets, or on lines of their own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CollectionStyle {
    /// In brackets.
    Flow,
    /// On lines of their own.
    Block,
}

/// What the tag of a value, or its quotes, tell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum ScalarTag {
    /// Nothing.
    Any,
    /// The tag is that of an application: nothing, either, but that a merge key is none.
    Unknown,
    /// What is in quotes is a text, too.
    Text,
    Integer,
    Float,
    Flag,
    Null,
    Sequence,
    Mapping,
    Merge,
}

impl YamlNode<'_> {
    /// The value of a member.
    pub fn get(&self, name: &str) -> Option<&Self> {
        self.members().iter().find(|member| member.key.text() == Some(name)).map(|member| &member.value)
    }
}

impl<'t> YamlNode<'t> {
    /// The members of a mapping.
    pub fn members(&self) -> &[MappingMember<'t>] {
        match &self.value {
            YamlValue::Mapping(_, members) => members,
            _ => &[],
        }
    }

    /// The elements of a list.
    pub fn list(&self) -> &[Self] {
        match &self.value {
            YamlValue::Sequence(_, elements) => elements,
            _ => &[],
        }
    }

    /// The text for a one-line value in its place. A list may begin in the column of its name; a one-line value may not, and is
    /// indented.
    pub fn instead(&self, value: &str) -> String {
        let is_block = matches!(
            self.value,
            YamlValue::Sequence(CollectionStyle::Block, _) | YamlValue::Mapping(CollectionStyle::Block, _)
        );
        format!("{}{value}", if is_block { "  " } else { "" })
    }

    /// The text of a scalar.
    pub fn text(&self) -> Option<&str> {
        match &self.value {
            YamlValue::Scalar(text) => Some(text),
            _ => None,
        }
    }
}

impl<'t> YamlDocument<'t> {
    /// Reads a text.
    ///
    /// # Errors
    /// [`YamlError`] where it is not YAML, has several documents or is nested too deep.
    pub fn read(text: &'t str) -> Result<Self, YamlError> {
        if text.len() > LONGEST {
            return Err(error_at(text, 0, format!("{} bytes; at most {LONGEST} are read", text.len()), true));
        }
        let options = granit_parser::options! { emit_comments: false };
        let parser = Parser::new_from_str_with_options(text, options);
        let mut reader = YamlReader { text, parser, is_placed: true };
        let mut root = None;
        while let Some((event, span)) = reader.next()? {
            match event {
                Event::StreamStart | Event::StreamEnd | Event::DocumentEnd => {}
                Event::DocumentStart(..) if root.is_none() => {}
                Event::DocumentStart(..) => return Err(reader.error(span.start, "a second document begins")),
                event => root = Some(reader.node(event, span, 0)?),
            }
        }
        let nothing = YamlNode {
            span: 0..0,
            value: YamlValue::Scalar("".into()),
            shared: false,
            anchor: 0,
            kind: ScalarTag::Null,
        };
        Ok(Self { text, root: root.unwrap_or(nothing), is_placed: reader.is_placed })
    }
}

/// The error of what begins at a byte.
fn error_at(text: &str, at: usize, problem: impl Into<String>, is_limit: bool) -> YamlError {
    let before = text.get(..at).unwrap_or(text);
    let line_start = before.rfind('\n').map_or(0, |end| end + 1);
    let line = before.matches('\n').count() + 1;
    let column = before.get(line_start..).unwrap_or_default().chars().count() + 1;
    YamlError { line, column, problem: problem.into(), is_limit }
}

/// The depth of what is in a list or a mapping that begins at a byte.
fn deeper(text: &str, at: usize, depth: usize) -> Result<usize, YamlError> {
    if depth < DEEPEST {
        return Ok(depth + 1);
    }
    Err(error_at(text, at, format!("lists and mappings nested more than {DEEPEST} deep"), true))
}

struct YamlReader<'t> {
    text: &'t str,
    parser: Parser<'t, StrInput<'t>>,
    is_placed: bool,
}

impl<'t> YamlReader<'t> {
    fn error(&self, at: usize, problem: &str) -> YamlError {
        error_at(self.text, at, problem, false)
    }

    /// The next event, and its bytes.
    fn next(&mut self) -> Result<Option<(Event<'t>, Range<usize>)>, YamlError> {
        let Some(next) = self.parser.next() else { return Ok(None) };
        let (event, span) = next.map_err(|error| YamlError {
            line: error.marker().line(),
            column: error.marker().col() + 1,
            problem: error.info(),
            is_limit: matches!(error.kind(), ErrorKind::RecursionLimitExceeded),
        })?;
        let bytes = span.byte_range();
        self.is_placed &= bytes.is_some();
        Ok(Some((event, bytes.unwrap_or_default())))
    }

    fn following(&mut self) -> Result<(Event<'t>, Range<usize>), YamlError> {
        self.next()?.ok_or_else(|| self.error(self.text.len(), "the text ends within a value"))
    }

    /// The value that begins with an event, at a depth.
    fn node(&mut self, event: Event<'t>, span: Range<usize>, depth: usize) -> Result<YamlNode<'t>, YamlError> {
        let begin = span.start;
        // The parser reports the end of a block where the next value begins, after comments that do not belong to the block.
        let whole = |style: CollectionStyle, last: Option<usize>, end: usize| match style {
            CollectionStyle::Flow => begin..end,
            CollectionStyle::Block => begin..last.unwrap_or(span.end),
        };
        match event {
            Event::Scalar(text, style, anchor, tag) => {
                let fits = |kind| !matches!(kind, ScalarTag::Sequence | ScalarTag::Mapping);
                let kind = match self.kind(tag.as_deref(), begin, fits)? {
                    ScalarTag::Any | ScalarTag::Unknown if style != ScalarStyle::Plain => ScalarTag::Text,
                    kind => kind,
                };
                Ok(YamlNode { span, value: YamlValue::Scalar(text), shared: anchor != 0, anchor, kind })
            }
            Event::Alias(anchor) => {
                Ok(YamlNode { span, value: YamlValue::Alias(anchor), shared: true, anchor: 0, kind: ScalarTag::Any })
            }
            Event::SequenceStart(given, anchor, tag) => {
                let depth = deeper(self.text, begin, depth)?;
                let kind = self.kind(tag.as_deref(), begin, |kind| kind == ScalarTag::Sequence)?;
                let mut elements: Vec<YamlNode<'t>> = Vec::new();
                let end = loop {
                    let (event, span) = self.following()?;
                    if matches!(event, Event::SequenceEnd) {
                        break span.end;
                    }
                    elements.push(self.node(event, span, depth)?);
                };
                elements.shrink_to_fit();
                let style = CollectionStyle::from(given);
                let mut span = whole(style, elements.last().map(|last| last.span.end), end);
                if let (CollectionStyle::Block, Some(first)) = (style, elements.first()) {
                    let found = dash(self.text, first.span.start);
                    self.is_placed &= found.is_some();
                    span.start = found.unwrap_or(begin);
                }
                let shared = anchor != 0 || elements.iter().any(|element| element.shared);
                Ok(YamlNode { span, value: YamlValue::Sequence(style, elements), shared, anchor, kind })
            }
            Event::MappingStart(given, anchor, tag) => {
                let depth = deeper(self.text, begin, depth)?;
                let kind = self.kind(tag.as_deref(), begin, |kind| kind == ScalarTag::Mapping)?;
                let mut members: Vec<MappingMember<'t>> = Vec::new();
                let mut shared = anchor != 0;
                let end = loop {
                    let (event, span) = self.following()?;
                    if matches!(event, Event::MappingEnd) {
                        break span.end;
                    }
                    let key = self.node(event, span, depth)?;
                    let (event, span) = self.following()?;
                    let value = self.node(event, span, depth)?;
                    shared |= key.shared || value.shared;
                    self.is_placed &= key.text().is_some();
                    members.push(MappingMember { key, value });
                };
                members.shrink_to_fit();
                let style = CollectionStyle::from(given);
                let span = whole(style, members.last().map(|last| last.value.span.end), end);
                Ok(YamlNode { span, value: YamlValue::Mapping(style, members), shared, anchor, kind })
            }
            _ => Err(self.error(begin, "a value is expected")),
        }
    }

    /// What a tag tells.
    fn kind(
        &self,
        tag: Option<&granit_parser::Tag>,
        at: usize,
        fits: impl Fn(ScalarTag) -> bool,
    ) -> Result<ScalarTag, YamlError> {
        let Some(tag) = tag else { return Ok(ScalarTag::Any) };
        let whole = tag.to_string();
        // Some write `!int` for `!!int`.
        let name = whole.strip_prefix("tag:yaml.org,2002:").or_else(|| whole.strip_prefix('!'));
        let kind = match name {
            // Without a name, it tells that the value is not to be interpreted.
            Some("") if !fits(ScalarTag::Text) => return Ok(ScalarTag::Any),
            Some("" | "str") => ScalarTag::Text,
            Some("int") => ScalarTag::Integer,
            Some("float") => ScalarTag::Float,
            Some("bool") => ScalarTag::Flag,
            Some("null") => ScalarTag::Null,
            Some("seq") => ScalarTag::Sequence,
            Some("map") => ScalarTag::Mapping,
            Some("merge") if !whole.starts_with('!') => ScalarTag::Merge,
            // What stands for something else must not be taken as it is.
            Some("binary" | "timestamp" | "time" | "include" | "degrees" | "radians") => {
                return Err(self.error(at, &format!("what has the tag {} is not read", tag.original())));
            }
            _ => return Ok(ScalarTag::Unknown),
        };
        if fits(kind) { Ok(kind) } else { Err(self.error(at, &format!("the tag {} does not fit", tag.original()))) }
    }
}

impl From<StructureStyle> for CollectionStyle {
    fn from(given: StructureStyle) -> Self {
        match given {
            StructureStyle::Flow => Self::Flow,
            StructureStyle::Block => Self::Block,
        }
    }
}

/// Offset of a list with an element on each line: the dash of its first element, which the parser does not always report.
fn dash(text: &str, first: usize) -> Option<usize> {
    let at = text.get(..first)?.rfind('-')?;
    // An anchor and a tag may precede it.
    text.get(at + 1..first)?.split_whitespace().all(|word| word.starts_with(['&', '!'])).then_some(at)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spans_are_those_of_the_values() {
        let text = "# ä\nlevels:\n  L1:\n    lanes:\n      - [0, 1, {bidirectional: [4, true], mutex: [1, \"\"]}]\n      - [1, 2]\n    name: é\n";
        let whole = YamlDocument::read(text).unwrap().root;
        let lanes = whole.get("levels").unwrap().get("L1").unwrap().get("lanes").unwrap();
        let at = |value: &YamlNode| &text[value.span.clone()];
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
        let whole = YamlDocument::read(text).unwrap().root;
        let at = |value: &YamlNode| &text[value.span.clone()];
        let lanes = whole.get("lanes").unwrap();
        assert_eq!(
            lanes.list().iter().map(at).collect::<Vec<_>>(),
            ["- 0 # from\r\n  - 1\r\n  - speed_limit: 0.5\r\n    mutex: é", "- 1\r\n  - 2\r\n  - {}"]
        );
        let parameters = &lanes.list()[0].list()[2];
        assert_eq!(at(parameters), "speed_limit: 0.5\r\n    mutex: é");
        let names: Vec<&str> = parameters.members().iter().map(|member| &text[member.key.span.start..][..5]).collect();
        assert_eq!(names, ["speed", "mutex"]);
        assert!(matches!(parameters.value, YamlValue::Mapping(CollectionStyle::Block, _)));
        assert!(matches!(lanes.list()[1].list()[2].value, YamlValue::Mapping(CollectionStyle::Flow, _)));
        assert_eq!(at(whole.get("more").unwrap()), "[1, ]");
        assert!(at(lanes).starts_with("- - 0") && at(lanes).ends_with("- {}"));
        let text = "a:\n  b:\n  - 1\n  -  -2\n  c: 3\n";
        let whole = YamlDocument::read(text).unwrap().root;
        assert_eq!(&text[whole.get("a").unwrap().get("b").unwrap().span.clone()], "- 1\n  -  -2");
        assert!(!whole.shared);
    }

    #[test]
    fn what_is_the_value_of_something_else_too_is_told() {
        let list = YamlDocument::read("- &l [1]\n- !!str &m 2\n").unwrap().root;
        assert!(list.shared && list.span.start == 0);
        let text = "a: &x {k: &y 1}\nb: *x\nc: [1, *y]\nd: &z [2]\ne: 3\n";
        let whole = YamlDocument::read(text).unwrap().root;
        let shared: Vec<bool> = whole.members().iter().map(|member| member.value.shared).collect();
        assert_eq!(shared, [true, true, true, true, false]);
        assert_eq!(&text[whole.get("d").unwrap().span.clone()], "[2]");
    }

    #[test]
    fn errors_tell_their_places() {
        for (text, expected) in [
            ("a: 1\nb: [é, 'x\n", "line 2, column 8: not YAML: unclosed quote"),
            ("a: 1\nb: {x: [1,\n", "line 2, column 8: not YAML: unclosed bracket '['"),
            ("é: 1\né: 2", "line 2, column 1: not YAML: \"é\" is there twice"),
            ("[é, .nan]", "line 1, column 5: not YAML: .nan is not a finite number"),
            ("--- 1\n--- 2", "line 2, column 1: not YAML: a second document begins"),
            ("a: !include b.yaml", "line 1, column 13: not YAML: what has the tag !include is not read"),
            ("a: !!map [1]", "line 1, column 10: not YAML: the tag !!map does not fit"),
            ("1\n...\n@", "line 3, column 1: not YAML: unexpected character: `@'"),
        ] {
            let error = YamlDocument::read(text).and_then(|document| document.value().map(|_| ())).unwrap_err();
            assert_eq!(error.to_string(), expected);
        }
        for text in ["", "# nothing\n", "---\n", "...\n", "\u{feff}", "%YAML 1.2\n---\n"] {
            assert!(YamlDocument::read(text).unwrap().value().unwrap().is_null());
        }
    }

    #[test]
    fn what_is_not_in_its_place_is_told() {
        for (text, is_placed) in [
            ("- # from - to\n  1\n", false),
            ("a: &x b\n*x : 2\n", false),
            ("? [a]\n: 2\n", false),
            ("- # from\n  1\n", false),
            ("# from - to\n- 1 # one\n# more\n- 2\n", true),
        ] {
            assert_eq!(YamlDocument::read(text).unwrap().is_placed, is_placed, "{text}");
        }
    }
}
