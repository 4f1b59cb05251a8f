//! Parses JSON to a tree that keeps the place of every value, and everything else that error messages need.
//!
//! A general parser stops at `NaN` (which Python writes) and at `1e999`, and keeps the last of two equal keys. The
//! error for a scenario with such a fault should name agent, segment and field, which are known only when the tree is
//! traversed. So numbers keep their text, words for values that are not finite count as numbers, equal keys are kept,
//! and every value knows its place, where errors point and edits go. Otherwise this is RFC 8259; the tests compare it with `serde_json`.

mod node;

pub use node::{JsonData, JsonMember, JsonNode, Position};

use crate::byte_order_mark::unmarked;
use std::borrow::Cow;
use std::collections::HashSet;

/// Why a text is not JSON.
#[derive(Clone, Debug, PartialEq)]
pub struct SyntaxError {
    /// Where it is not.
    pub position: Position,
    /// What is wrong there.
    pub problem: String,
}

/// Arrays and objects inside one another; a scenario needs 6. The parser recurses, so this bounds the stack.
const DEEPEST: usize = 64;

/// Longest text \[bytes\].
pub(crate) const LONGEST: usize = u32::MAX as usize;

/// Characters of the text that a message quotes.
pub(crate) const QUOTED: usize = 40;

/// Parses the value in a text; a byte order mark at its start is skipped.
///
/// # Errors
/// [`SyntaxError`] where it is not JSON.
pub fn parse(text: &str) -> Result<JsonNode<'_>, SyntaxError> {
    JsonParser::new(text).whole()
}

/// Parses the value in a text of which all programs read the same: no key is twice in an object, and all numbers are finite.
///
/// # Errors
/// [`SyntaxError`] where it is not such JSON.
pub(crate) fn parse_strict(text: &str) -> Result<JsonNode<'_>, SyntaxError> {
    JsonParser { is_strict: true, ..JsonParser::new(text) }.whole()
}

/// Parses several values, one after the other, as [`parse_strict`] does one; nothing follows an error.
pub(crate) fn parse_sequence(text: &str) -> impl Iterator<Item = Result<JsonNode<'_>, SyntaxError>> {
    let mut parser = Some(JsonParser { is_strict: true, ..JsonParser::new(text) });
    std::iter::from_fn(move || {
        parser.as_mut()?.peek()?;
        let value = parser.as_mut()?.value(0);
        if value.is_err() {
            parser = None;
        }
        Some(value)
    })
}

/// Parses the value with which a text begins, whatever follows it.
pub(crate) fn parse_first(text: &str) -> Option<JsonNode<'_>> {
    JsonParser::new(text).value(0).ok()
}

/// The value in a text; the elements of the array that is its member `list` are handed to `take` one after the other and are not
/// in it, so that no tree of a long list is held.
pub(crate) fn parse_listing<'t>(
    text: &'t str,
    list: &str,
    take: &mut dyn FnMut(JsonNode<'t>),
) -> Result<JsonNode<'t>, SyntaxError> {
    JsonParser { listing: Some((list, take)), ..JsonParser::new(text) }.whole()
}

struct JsonParser<'t, 'l> {
    text: &'t str,
    /// Byte that is read next; always at the border of a character.
    at: usize,
    line: u32,
    /// First byte of the line.
    line_start: usize,
    /// Column of the byte `counted`, so that no character is counted twice.
    column: u32,
    counted: usize,
    /// A member of the outermost object, and what takes its elements.
    listing: Option<(&'l str, &'l mut dyn FnMut(JsonNode<'t>))>,
    /// Whether equal keys and numbers that are not finite are refused.
    is_strict: bool,
}

impl<'t> JsonParser<'t, '_> {
    fn new(text: &'t str) -> Self {
        let begin = text.len() - unmarked(text).len();
        Self { text, at: begin, line: 1, line_start: begin, column: 1, counted: begin, listing: None, is_strict: false }
    }

    fn whole(mut self) -> Result<JsonNode<'t>, SyntaxError> {
        let value = self.value(0)?;
        match self.peek() {
            None => Ok(value),
            Some(_) if self.is_strict => Err(self.error("more text after the end of the value")),
            Some(_) => Err(self.error("more text after the end of the scenario (pcr check and pcr regions read several on standard input, each on a line of its own)")),
        }
    }

    fn value(&mut self, depth: usize) -> Result<JsonNode<'t>, SyntaxError> {
        if self.text.len() > LONGEST {
            return Err(self.error(format!("{} bytes of JSON; at most {LONGEST} are read", self.text.len())));
        }
        let next = self.peek();
        let (position, begin) = (self.position(), self.at);
        let data = match next {
            Some(b'{' | b'[') if depth == DEEPEST => {
                return Err(self.error(format!("arrays and objects nested more than {DEEPEST} deep")));
            }
            Some(b'{') => JsonData::Object(self.members(depth)?),
            Some(b'[') => {
                let mut elements = Vec::new();
                self.elements(depth, |_, element| elements.push(element))?;
                JsonData::Array(elements)
            }
            Some(b'"') => JsonData::Text(self.string()?),
            _ => self.word()?,
        };
        Ok(JsonNode::new(position, begin..self.at, data))
    }

    fn elements(&mut self, depth: usize, mut take: impl FnMut(&mut Self, JsonNode<'t>)) -> Result<(), SyntaxError> {
        self.at += 1;
        if self.accept(b']') {
            return Ok(());
        }
        loop {
            let element = self.value(depth + 1)?;
            take(self, element);
            if self.accept(b']') {
                return Ok(());
            }
            self.expect(b',', "`,` or `]`")?;
        }
    }

    /// A member of an object, or an empty array in place of the list whose elements are taken.
    fn member(&mut self, key: &str, depth: usize) -> Result<JsonNode<'t>, SyntaxError> {
        let is_listed = depth == 0 && self.listing.as_ref().is_some_and(|(list, _)| key == *list);
        if !is_listed || self.peek() != Some(b'[') {
            return self.value(depth + 1);
        }
        let (position, begin) = (self.position(), self.at);
        self.elements(depth + 1, |parser, element| {
            if let Some((_, take)) = &mut parser.listing {
                take(element);
            }
        })?;
        Ok(JsonNode::new(position, begin..self.at, JsonData::Array(Vec::new())))
    }

    fn members(&mut self, depth: usize) -> Result<Vec<JsonMember<'t>>, SyntaxError> {
        let mut members = Vec::new();
        let mut known = HashSet::new();
        self.at += 1;
        if self.accept(b'}') {
            return Ok(members);
        }
        loop {
            if self.peek() != Some(b'"') {
                return Err(self.expected("a key in quotes"));
            }
            let position = self.position();
            let key = self.string()?;
            if self.is_strict && !known.insert(key.clone()) {
                return Err(SyntaxError { position, problem: format!("{key:?} is there twice") });
            }
            self.expect(b':', "`:`")?;
            let value = self.member(&key, depth)?;
            members.push((key, value));
            if self.accept(b'}') {
                return Ok(members);
            }
            self.expect(b',', "`,` or `}`")?;
        }
    }

    fn string(&mut self) -> Result<Cow<'t, str>, SyntaxError> {
        let mut string = Cow::Borrowed("");
        self.at += 1;
        loop {
            let plain = self.taken(|byte| !matches!(byte, b'"' | b'\\' | 0..b' '));
            if string.is_empty() {
                string = plain.into()
            } else {
                string.to_mut().push_str(plain)
            }
            match self.next() {
                Some(b'"') => {
                    self.at += 1;
                    return Ok(string);
                }
                Some(b'\\') => string.to_mut().push(self.escape()?),
                Some(_) => return Err(self.error("a control character in a string; write it as \\u00XX")),
                None => return Err(self.error("the text ends within a string")),
            }
        }
    }

    fn escape(&mut self) -> Result<char, SyntaxError> {
        const SIMPLE: [(char, char); 8] = [
            ('"', '"'),
            ('\\', '\\'),
            ('/', '/'),
            ('b', '\u{8}'),
            ('f', '\u{c}'),
            ('n', '\n'),
            ('r', '\r'),
            ('t', '\t'),
        ];
        let letter = self.rest().chars().nth(1);
        if let Some((_, meant)) = SIMPLE.into_iter().find(|&(escaped, _)| Some(escaped) == letter) {
            self.at += 2;
            return Ok(meant);
        }
        let units = (self.unit(0), self.unit(6));
        let (meant, long) = match units {
            (Some(high @ 0xd800..0xdc00), Some(low @ 0xdc00..0xe000)) => {
                (char::from_u32(0x10000 + ((high - 0xd800) << 10) + (low - 0xdc00)), 12)
            }
            (Some(unit), _) => (char::from_u32(unit), 6),
            (None, _) => (None, 0),
        };
        let meant = meant.ok_or_else(|| self.error("an unknown escape in a string"))?;
        self.at += long;
        Ok(meant)
    }

    /// The UTF-16 unit of an escape `\uXXXX` that many bytes on.
    fn unit(&self, offset: usize) -> Option<u32> {
        let digits = self.rest().get(offset..offset + 6)?.strip_prefix("\\u")?;
        let hex = digits.bytes().all(|byte| byte.is_ascii_hexdigit());
        hex.then(|| u32::from_str_radix(digits, 16).ok())?
    }

    /// A number, or a value that is written as a word.
    fn word(&mut self) -> Result<JsonData<'t>, SyntaxError> {
        let begin = self.at;
        let word = self.taken(|byte| byte.is_ascii_alphanumeric() || matches!(byte, b'+' | b'-' | b'.' | b'_'));
        Ok(match word {
            "true" => JsonData::Bool(true),
            "false" => JsonData::Bool(false),
            "null" => JsonData::Null,
            number if is_number(number) || is_not_finite(number) => {
                if self.is_strict && !number.parse().is_ok_and(f64::is_finite) {
                    self.at = begin;
                    return Err(self.error(format!("{number} is not a finite number")));
                }
                JsonData::Number(number.into())
            }
            _ => {
                self.at = begin;
                return Err(self.expected("a value"));
            }
        })
    }

    fn rest(&self) -> &'t str {
        self.text.get(self.at..).unwrap_or_default()
    }

    fn next(&self) -> Option<u8> {
        self.text.as_bytes().get(self.at).copied()
    }

    /// Takes the bytes of a kind that come next, of which other characters than those of ASCII have all or none.
    fn taken(&mut self, kind: impl Fn(u8) -> bool) -> &'t str {
        let begin = self.at;
        while self.next().is_some_and(&kind) {
            self.at += 1;
        }
        self.text.get(begin..self.at).unwrap_or_default()
    }

    /// The next byte that is not white space.
    fn peek(&mut self) -> Option<u8> {
        loop {
            let next = self.next();
            match next {
                Some(b'\n') => {
                    self.at += 1;
                    self.line += 1;
                    self.line_start = self.at;
                    (self.column, self.counted) = (1, self.at);
                }
                Some(b' ' | b'\t' | b'\r') => self.at += 1,
                _ => return next,
            }
        }
    }

    /// The place of the byte that is read next.
    fn position(&mut self) -> Position {
        self.column += self.text.get(self.counted..self.at).unwrap_or_default().chars().count() as u32;
        self.counted = self.at;
        Position { line: self.line, column: self.column }
    }

    fn accept(&mut self, mark: u8) -> bool {
        let there = self.peek() == Some(mark);
        self.at += usize::from(there);
        there
    }

    fn expect(&mut self, mark: u8, name: &str) -> Result<(), SyntaxError> {
        if self.accept(mark) { Ok(()) } else { Err(self.expected(name)) }
    }

    fn expected(&self, what: &str) -> SyntaxError {
        let rest = self.rest();
        let length = rest.find(|c: char| c.is_whitespace() || ",:]}\"".contains(c)).unwrap_or(rest.len());
        let found: String = rest.chars().take(length.clamp(1, QUOTED)).collect();
        if found.is_empty() {
            self.error(format!("the text ends where {what} is expected"))
        } else {
            self.error(format!("{} where {what} is expected", found.escape_debug()))
        }
    }

    fn error(&self, problem: impl Into<String>) -> SyntaxError {
        let line = self.text.get(self.line_start..self.at).unwrap_or_default();
        let position = Position { line: self.line, column: line.chars().count() as u32 + 1 };
        SyntaxError { position, problem: problem.into() }
    }
}

/// `-? (0 | [1-9][0-9]*) (\. [0-9]+)? ([eE] [+-]? [0-9]+)?`
fn is_number(word: &str) -> bool {
    let word = word.strip_prefix('-').unwrap_or(word);
    let (mantissa, exponent) = word.split_once(['e', 'E']).map_or((word, None), |(m, e)| (m, Some(e)));
    let (whole, fraction) = mantissa.split_once('.').map_or((mantissa, None), |(w, f)| (w, Some(f)));
    let digits = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    digits(whole)
        && (whole == "0" || !whole.starts_with('0'))
        && fraction.is_none_or(digits)
        && exponent.is_none_or(|exponent| digits(exponent.strip_prefix(['+', '-']).unwrap_or(exponent)))
}

/// Spellings of numbers that are not finite, in Python, JavaScript and C.
fn is_not_finite(word: &str) -> bool {
    let word = word.strip_prefix(['+', '-']).unwrap_or(word);
    ["nan", "inf", "infinity"].iter().any(|name| word.eq_ignore_ascii_case(name))
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::Value;

    const SEEDS: [&str; 4] = [
        include_str!("../scenarios/paper12.json"),
        r#"{"a": [1, -0.5, 2e3, 1E-7, true, false, null, [], {}], "b\n\"\\\/\u00e9\ud83d\ude00": "é😀 \b\f\r\t", "": {"c": [[[0]]]}}"#,
        "\t[ 0 , -0 , 0.0e+0 ]\r\n",
        r#""plain""#,
    ];

    #[test]
    fn trees_are_those_of_serde_json() {
        for seed in SEEDS {
            assert_eq!(parse(seed).unwrap().to_value(), serde_json::from_str::<Value>(seed).unwrap());
        }
    }

    /// Texts with one character changed: both parsers accept and refuse the same ones, but for what this one is for.
    #[test]
    fn damaged_texts_are_refused_like_by_serde_json() {
        let marks: Vec<char> = "{}[]\",:\\/0123456789+-.eEtrufalsn \n\t\u{1}é😀x".chars().collect();
        let mut random = 88_172_645_463_325_252_u64;
        let mut next = |bound: usize| {
            random ^= random << 13;
            random ^= random >> 7;
            random ^= random << 17;
            (random % bound as u64) as usize
        };
        let (mut accepted, mut refused) = (0, 0);
        for _ in 0..40_000 {
            let seed: Vec<char> = SEEDS[1 + next(3)].chars().collect();
            let (place, mark) = (next(seed.len()), marks[next(marks.len())]);
            let skip = next(2);
            let head = seed[..place].iter();
            let text: String = head.chain([&mark]).chain(&seed[(place + skip).min(seed.len())..]).collect();
            match (parse(&text), serde_json::from_str::<Value>(&text)) {
                (Ok(json), Ok(expected)) => {
                    assert_eq!(json.to_value(), expected, "{text}");
                    accepted += 1;
                }
                (Err(_), Err(_)) => refused += 1,
                (mine, theirs) => panic!("{text}\n{mine:?}\n{theirs:?}"),
            }
        }
        assert!(accepted > 1000 && refused > 1000, "{accepted} accepted, {refused} refused");
    }

    #[test]
    fn numbers_that_are_not_finite_are_kept_as_written() {
        for word in ["NaN", "nan", "Infinity", "-Infinity", "inf", "-inf", "1e999", "-1e99999"] {
            assert_eq!(parse(word).unwrap().data, JsonData::Number(word.into()));
        }
    }

    #[test]
    fn equal_keys_are_kept() {
        let JsonData::Object(members) = parse(r#"{"a": 1, "a": 2}"#).unwrap().data else { panic!() };
        assert_eq!(members.len(), 2);
    }

    #[test]
    fn what_programs_read_differently_is_refused_by_the_strict_parser() {
        let text = r#"{"a": [1, 0.5, null], "b": {"a": "x"}}"#;
        assert_eq!(parse_strict(text), parse(text));
        assert_eq!(parse_strict(&format!("\u{feff}{text}")), parse(text));
        for (text, column, problem) in [
            (r#"{"é": 1, "é": 1}"#, 10, "\"é\" is there twice"),
            (r#"[{"b":{"a":1,"\u0061":2}}]"#, 14, "\"a\" is there twice"),
            ("[1, NaN]", 5, "NaN is not a finite number"),
            ("[1e999]", 2, "1e999 is not a finite number"),
            ("{} x", 4, "more text after the end of the value"),
        ] {
            let position = Position { line: 1, column };
            assert_eq!(parse_strict(text), Err(SyntaxError { position, problem: problem.into() }));
        }
    }

    #[test]
    fn values_follow_one_another() {
        let all = |text| parse_sequence(text).map(|value| value.map(|value| value.to_string())).collect::<Vec<_>>();
        assert_eq!(all(" "), []);
        assert_eq!(all("{\"a\": 1}[2.50]\n3 "), ["{\"a\":1}", "[2.5]", "3"].map(|text| Ok(text.to_owned())));
        let after_error = all("1\n x 2");
        assert_eq!(after_error.len(), 2);
        assert_eq!(after_error[1].as_ref().unwrap_err().position, Position { line: 2, column: 2 });
    }

    #[test]
    fn values_know_their_lines_and_errors_their_columns() {
        let json = parse("[\n 1,\n\n {\"a\":\n2}]").unwrap();
        let JsonData::Array(elements) = &json.data else { panic!() };
        let JsonData::Object(members) = &elements[1].data else { panic!() };
        let places = [&json, &elements[0], &elements[1], &members[0].1].map(|json| json.position);
        assert_eq!(places.map(|at| [at.line, at.column]), [[1, 1], [2, 2], [4, 2], [5, 1]]);
        let error = parse("{\n  \"é\": nonsense}").unwrap_err();
        assert_eq!(error.position, Position { line: 2, column: 8 });
        assert_eq!(error.problem, "nonsense where a value is expected");
    }

    #[test]
    fn spans_are_those_of_the_values() {
        let text = "\u{feff} {\"a\": [1, -2.5e3 , \"x\\\"]\\u00e9é\"], \"b\" :{ } ,\"c\":null}\n";
        let whole = parse(text).unwrap();
        let at = |value: &JsonNode<'_>| &text[value.span()];
        assert!(at(&whole).starts_with('{') && at(&whole).ends_with('}'));
        let list: Vec<&str> = whole.get("a").unwrap().list().iter().map(at).collect();
        assert_eq!(list, ["1", "-2.5e3", "\"x\\\"]\\u00e9é\""]);
        assert_eq!((at(whole.get("b").unwrap()), at(whole.get("c").unwrap())), ("{ }", "null"));
        assert_eq!(whole.get("b").unwrap().end_of_members().unwrap().1, "");
        assert_eq!(whole.get("d"), None);
        // Columns are characters, and the mark is none.
        let columns = ["a", "b", "c"].map(|key| whole.get(key).unwrap().position.column);
        assert_eq!(columns, [8, 42, 51]);
    }

    #[test]
    fn nesting_is_bounded() {
        let nested = |depth: usize| "[".repeat(depth) + &"]".repeat(depth);
        assert!(parse(&nested(DEEPEST)).is_ok());
        let error = parse(&nested(1_000_000)).unwrap_err();
        assert_eq!(error.problem, "arrays and objects nested more than 64 deep");
    }

    #[test]
    fn texts_that_end_early_say_so() {
        for text in ["", " ", "[1", "{\"a\"", "{\"a\":", "[1,"] {
            let problem = parse(text).unwrap_err().problem;
            assert!(problem.starts_with("the text ends where "), "{text:?}: {problem}");
        }
        assert_eq!(parse("\"ab").unwrap_err().problem, "the text ends within a string");
    }
}
