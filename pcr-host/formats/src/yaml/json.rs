//! A document as a value of JSON.

use super::scalar::{self, integer, is_null};
use super::{ScalarTag, YamlDocument, YamlError, YamlNode, YamlValue, deeper, error_at};
use crate::json::{JsonData, JsonNode, Position};
use serde_json::Number;
use std::borrow::Cow;
use std::collections::{HashMap, HashSet};

/// How many times the length of the text, in values and bytes of texts, a document may stand for. Without aliases it is less than 3.
const REPETITION: usize = 10;

/// Bytes of the text between those whose characters are counted beforehand.
const BLOCK: usize = 1024;

impl<'t> YamlDocument<'t> {
    /// All of it, with what aliases and merge keys stand for.
    ///
    /// # Errors
    /// [`YamlError`] where a value or a name cannot be one of JSON, a name is there twice, or aliases repeat too much.
    pub fn value(&self) -> Result<JsonNode<'_>, YamlError> {
        AliasResolver::of(self).value(&self.root, 0)
    }

    /// The same tree with every scalar as its text, without its quotes: for names, which may be any scalar. What stands for nothing and is
    /// no empty text is `null`.
    ///
    /// # Errors
    /// As [`YamlDocument::value`].
    pub fn texts(&self) -> Result<JsonNode<'_>, YamlError> {
        AliasResolver { as_texts: true, ..AliasResolver::of(self) }.value(&self.root, 0)
    }
}

/// A member of a mapping, or of what is merged into it.
struct ResolvedMember<'d, 't> {
    name: &'d str,
    /// What its name stands for if it is an integer or nothing, as long as there are no quotes: `0x1` and `1` are one name.
    meaning: Option<Option<Number>>,
    value: &'d YamlNode<'t>,
}

/// The names of a mapping.
#[derive(Default)]
struct MappingKeys<'d> {
    names: HashSet<&'d str>,
    meanings: HashSet<Option<Number>>,
}

impl<'d> MappingKeys<'d> {
    /// Adds a name, unless it is known.
    fn add(&mut self, member: &ResolvedMember<'d, '_>) -> bool {
        let is_new = !self.names.contains(member.name)
            && member.meaning.as_ref().is_none_or(|meaning| !self.meanings.contains(meaning));
        if is_new {
            self.names.insert(member.name);
            self.meanings.extend(member.meaning.clone());
        }
        is_new
    }
}

struct AliasResolver<'d, 't> {
    text: &'t str,
    anchors: HashMap<usize, &'d YamlNode<'t>>,
    /// The first bytes of its lines.
    line_starts: Vec<usize>,
    /// Numbers of characters before every [`BLOCK`] bytes, so that no long line is counted once for each of its values.
    characters: Vec<usize>,
    /// Values and bytes that may still be read.
    left: usize,
    /// Whether scalars are read as their texts.
    as_texts: bool,
}

impl<'d, 't> AliasResolver<'d, 't> {
    fn of(document: &'d YamlDocument<'t>) -> Self {
        let mut anchors = HashMap::new();
        collect(&document.root, &mut anchors);
        let left = document.text.len().saturating_mul(REPETITION).saturating_add(1024);
        let newlines = document.text.match_indices('\n').map(|(byte, _)| byte + 1);
        let line_starts = std::iter::once(0).chain(newlines).collect();
        let blocks = document.text.as_bytes().chunks(BLOCK).chain([&[][..]]).scan(0, |before, block| {
            let here = *before;
            *before += characters_of(block);
            Some(here)
        });
        let characters = blocks.collect();
        Self { text: document.text, anchors, line_starts, characters, left, as_texts: false }
    }

    fn error(&self, node: &YamlNode<'_>, problem: impl Into<String>) -> YamlError {
        error_at(self.text, node.span.start, problem, false)
    }

    /// Counts a value, and the bytes of a text.
    fn count(&mut self, node: &YamlNode<'_>, bytes: usize) -> Result<(), YamlError> {
        let too_much = || {
            let problem = format!("its aliases make it more than {REPETITION} times as long");
            error_at(self.text, node.span.start, problem, true)
        };
        self.left = self.left.checked_sub(1 + bytes).ok_or_else(too_much)?;
        Ok(())
    }

    /// What a value stands for.
    fn target(&self, node: &'d YamlNode<'t>) -> Result<&'d YamlNode<'t>, YamlError> {
        let YamlValue::Alias(anchor) = node.value else { return Ok(node) };
        let target = self.anchors.get(&anchor).ok_or_else(|| self.error(node, "there is no anchor for this alias"))?;
        if target.span.start <= node.span.start && node.span.end <= target.span.end {
            return Err(self.error(node, "an alias for what it is in"));
        }
        Ok(target)
    }

    fn value(&mut self, node: &'d YamlNode<'t>, depth: usize) -> Result<JsonNode<'d>, YamlError> {
        let node = self.target(node)?;
        let data = match &node.value {
            YamlValue::Scalar(text) => {
                self.count(node, text.len())?;
                if self.as_texts {
                    JsonData::Text(if is_nothing(node, text) { NULL } else { &**text }.into())
                } else {
                    let value =
                        scalar::value(node.kind, text).map_err(|problem| self.error(node, problem.to_string()))?;
                    JsonNode::from_value(value, Position::START).data
                }
            }
            YamlValue::Sequence(_, elements) => {
                self.count(node, 0)?;
                let depth = deeper(self.text, node.span.start, depth)?;
                let elements = elements.iter().map(|element| self.value(element, depth));
                JsonData::Array(elements.collect::<Result<_, _>>()?)
            }
            YamlValue::Mapping(..) => {
                self.count(node, 0)?;
                let below = deeper(self.text, node.span.start, depth)?;
                let members = self.members(node, depth)?.into_iter();
                let members = members.map(|member| Ok((Cow::Borrowed(member.name), self.value(member.value, below)?)));
                JsonData::Object(members.collect::<Result<_, _>>()?)
            }
            YamlValue::Alias(_) => return Err(self.error(node, "an alias for an alias")),
        };
        Ok(JsonNode::new(self.position(node.span.start), node.span.clone(), data))
    }

    /// The position of a byte of the text.
    fn position(&self, byte: usize) -> Position {
        let line = self.line_starts.partition_point(|start| *start <= byte);
        let start = line.checked_sub(1).and_then(|line| self.line_starts.get(line)).copied().unwrap_or(0);
        let column = self.characters_before(byte).saturating_sub(self.characters_before(start)) + 1;
        Position { line: line as u32, column: column as u32 }
    }

    /// The number of characters before a byte of the text.
    fn characters_before(&self, byte: usize) -> usize {
        let block = byte / BLOCK;
        let within = self.text.as_bytes().get(block * BLOCK..byte).unwrap_or_default();
        self.characters.get(block).copied().unwrap_or_default() + characters_of(within)
    }

    /// The members of a mapping, then those that are merged into it and have other names; none of anything else.
    fn members(&mut self, node: &'d YamlNode<'t>, depth: usize) -> Result<Vec<ResolvedMember<'d, 't>>, YamlError> {
        let node = self.target(node)?;
        let depth = deeper(self.text, node.span.start, depth)?;
        let mut members = Vec::with_capacity(node.members().len());
        let mut known = MappingKeys::default();
        let mut merged = None;
        for member in node.members() {
            let key = self.target(&member.key)?;
            if is_merge(key) {
                if merged.replace(&member.value).is_some() {
                    return Err(self.error(&member.key, "<< is there twice"));
                }
                continue;
            }
            let name = self.named(key, &member.value)?;
            if !known.add(&name) {
                return Err(self.error(&member.key, format!("{:?} is there twice", name.name)));
            }
            members.push(name);
        }
        if let Some(merged) = merged {
            members.extend(self.merged(merged, depth)?.into_iter().filter(|member| known.add(member)));
        }
        Ok(members)
    }

    /// What is merged: the members of a mapping, or of each in a list.
    fn merged(&mut self, node: &'d YamlNode<'t>, depth: usize) -> Result<Vec<ResolvedMember<'d, 't>>, YamlError> {
        let node = self.target(node)?;
        self.count(node, 0)?;
        match &node.value {
            YamlValue::Mapping(..) => self.members(node, depth),
            YamlValue::Sequence(_, elements) => {
                let depth = deeper(self.text, node.span.start, depth)?;
                let mut all = Vec::new();
                for element in elements {
                    all.extend(self.merged(element, depth)?);
                }
                Ok(all)
            }
            YamlValue::Scalar(text) if is_nothing(node, text) => Ok(Vec::new()),
            _ => Err(self.error(node, "what is merged (<<) is no mapping")),
        }
    }

    fn named(&mut self, key: &'d YamlNode<'t>, value: &'d YamlNode<'t>) -> Result<ResolvedMember<'d, 't>, YamlError> {
        let YamlValue::Scalar(name) = &key.value else { return Err(self.error(key, "a name is expected")) };
        self.count(key, name.len())?;
        if key.span.is_empty() {
            return Err(self.error(key, "a name is expected"));
        }
        let is_null = is_nothing(key, name);
        let number = integer(name).filter(|_| matches!(key.kind, ScalarTag::Any | ScalarTag::Integer));
        let meaning = if is_null { Some(None) } else { number.map(Some) };
        Ok(ResolvedMember { name: if is_null { NULL } else { name }, meaning, value })
    }
}

/// What a name that stands for nothing is called, as programs in C++ read it.
const NULL: &str = "null";

fn is_merge(key: &YamlNode<'_>) -> bool {
    matches!(key.kind, ScalarTag::Any | ScalarTag::Merge) && key.text() == Some("<<")
}

fn is_nothing(node: &YamlNode<'_>, text: &str) -> bool {
    node.kind == ScalarTag::Null
        || matches!(node.kind, ScalarTag::Any | ScalarTag::Unknown | ScalarTag::Merge) && is_null(text)
}

/// The number of characters that begin in some bytes of a text.
fn characters_of(bytes: &[u8]) -> usize {
    bytes.iter().filter(|byte| **byte & 0b1100_0000 != 0b1000_0000).count()
}

/// What has an anchor.
fn collect<'d, 't>(node: &'d YamlNode<'t>, anchors: &mut HashMap<usize, &'d YamlNode<'t>>) {
    if !node.shared {
        return;
    }
    if node.anchor != 0 {
        anchors.insert(node.anchor, node);
    }
    node.list().iter().for_each(|element| collect(element, anchors));
    for member in node.members() {
        collect(&member.key, anchors);
        collect(&member.value, anchors);
    }
}

#[cfg(test)]
mod tests {
    use super::super::DEEPEST;
    use super::*;
    use serde_json::{Value, json};

    fn value(text: &str) -> Result<Value, String> {
        let value = YamlDocument::read(text).and_then(|document| Ok(document.value()?.to_value()));
        value.map_err(|error| error.to_string())
    }

    #[test]
    fn values_know_their_positions() {
        let document = YamlDocument::read("é: [ä, {b: *x}]\n".replace("ä", "&x ä").leak()).unwrap();
        let value = document.value().unwrap();
        let list = value.get("é").unwrap();
        let alias = list.element(1).unwrap().get("b").unwrap();
        let positions = [list, &list.list()[0], &list.list()[1], alias].map(|node| node.position);
        assert_eq!(positions.map(|at| [at.line, at.column]), [[1, 4], [1, 8], [1, 11], [1, 8]]);
        // Behind lines and lists that are longer than a block.
        let text = format!("# {}\n[{}x]", "ü".repeat(3 * BLOCK), "é, ".repeat(2 * BLOCK));
        let document = YamlDocument::read(&text).unwrap();
        let value = document.value().unwrap();
        let places: Vec<_> = value.list().iter().map(|node| [node.position.line, node.position.column]).collect();
        let expected: Vec<_> = (0..=2 * BLOCK as u32).map(|element| [2, 2 + 3 * element]).collect();
        assert_eq!(places, expected);
    }

    #[test]
    fn aliases_stand_for_what_has_the_anchor() {
        assert_eq!(
            value("a: &x {k: &y 1}\nb: *x\nc: [*y, *x]\n*y : 2"),
            Ok(json!({
                "a": {"k": 1}, "b": {"k": 1}, "c": [1, {"k": 1}], "1": 2
            }))
        );
        assert_eq!(value("[&x 1, *x, &x 2, *x]"), Ok(json!([1, 1, 2, 2])));
        assert_eq!(value("[*x]"), Err("line 1, column 2: not YAML: while parsing node, found unknown anchor".into()));
        for text in ["a: &x [1, *x]", "&x {a: {b: *x}}", "a: &x\n  b: *x\n", "&x {<<: *x}", "&x {? [*x] : 1}"] {
            let error = value(text).unwrap_err();
            assert!(error.contains("an alias for what it is in") || error.contains("a name is expected"), "{error}");
        }
    }

    #[test]
    fn what_is_merged_gives_way() {
        for (text, expected) in [
            ("{<<: {x: 1, y: 2}, y: 3}", json!({"x": 1, "y": 3})),
            ("b: &b {x: 1}\nc: {y: 2, <<: *b, x: 4}", json!({"b": {"x": 1}, "c": {"x": 4, "y": 2}})),
            ("{<<: [{x: 1}, {x: 2, z: 3}, [{z: 4, u: 5}]]}", json!({"x": 1, "z": 3, "u": 5})),
            ("{<<: {<<: {x: 1, z: 1}, x: 2}}", json!({"x": 2, "z": 1})),
            ("{<<: , a: {<<: [~]}}", json!({"a": {}})),
            ("{<<: {0x1: a}, 1: b}", json!({"1": "b"})),
            ("{<<: {x: .inf}, x: 1}", json!({"x": 1})),
            ("{!!merge '<<': {x: 1}}", json!({"x": 1})),
            ("{'<<': {x: 1}}", json!({"<<": {"x": 1}})),
            ("{!!str <<: {x: 1}, k: <<}", json!({"<<": {"x": 1}, "k": "<<"})),
            ("{!mine <<: {x: 1}}", json!({"<<": {"x": 1}})),
        ] {
            assert_eq!(value(text), Ok(expected), "{text}");
        }
        for text in ["{<<: 5}", "{<<: [1]}", "{<<: ''}", "{<<: {}, <<: {}}", "{<<: {x: 1, x: 2}}"] {
            assert!(value(text).is_err(), "{text}");
        }
    }

    #[test]
    fn names_are_unique_and_texts() {
        assert_eq!(
            value("1: a\n1.0: b\nyes: c\ntrue: d\n0x10: e\n!!str ~: f"),
            Ok(json!({"1": "a", "1.0": "b", "yes": "c", "true": "d", "0x10": "e", "~": "f"}))
        );
        assert_eq!(value("~: 1\n!!int '1': a\n1.5: b\n'': c"), Ok(json!({"null": 1, "1": "a", "1.5": "b", "": "c"})));
        for text in [
            "null: 1\n~: 2",
            "a: 1\na: 2",
            "a: 1\n'a': 2",
            "1: a\n'1': b",
            "1: a\n0x1: b",
            "{a: 1, a: 1}",
            "&x a: 1\n*x : 2",
        ] {
            assert!(value(text).unwrap_err().ends_with(" is there twice"), "{text}");
        }
        for text in [": 1", "? [1]\n: 2", "{{}: 1}"] {
            assert!(value(text).unwrap_err().contains("a name is expected"), "{text}");
        }
    }

    #[test]
    fn texts_are_those_of_the_scalars() {
        let texts = |text: &str| YamlDocument::read(text).unwrap().texts().map(|texts| texts.to_value());
        let all = json!({"a": ["007", "1.0", "true", "null", "null", "", "x y", "0x10"], "b": {"c": "1"}});
        assert_eq!(texts("a: [007, 1.0, true, ~, null, '', \"x y\", &n 0x10]\nb: {c: 1}"), Ok(all));
        assert_eq!(texts("a: &x 1.50\nb: *x\n<<: {c: .nan}"), Ok(json!({"a": "1.50", "b": "1.50", "c": ".nan"})));
    }

    #[test]
    fn members_have_the_order_of_the_text() {
        let document = YamlDocument::read("{b: 1, a: 2, <<: {c: 3, a: 4}}").unwrap();
        let names: Vec<String> = document.value().unwrap().members().iter().map(|(name, _)| name.to_string()).collect();
        assert_eq!(names, ["b", "a", "c"]);
    }

    #[test]
    fn small_texts_do_not_stand_for_much() {
        let mut laughs = String::from("a0: &a0 [x, x, x, x, x, x, x, x, x]\n");
        for k in 1..9 {
            laughs += &format!("a{k}: &a{k} [{}]\n", format!("*a{}, ", k - 1).repeat(9));
        }
        let merged = |k: usize| format!("a{k}: &a{k} {{<<: [{}]}}\n", format!("*a{}, ", k - 1).repeat(9));
        let merges = "a0: &a0 {}\n".to_owned() + &(1..40).map(merged).collect::<String>();
        let long = format!("a: &a {}\nb: [{}]", "x".repeat(4000), "*a, ".repeat(100));
        for text in [laughs, merges, long] {
            let error = value(&text).unwrap_err();
            assert!(error.contains(": too large or too deep: "), "{error}");
        }
        // Parameters that many lanes have in common.
        let lanes = "    - [0, 1, *p]\n".repeat(5000);
        let all = value(&format!(
            "p: &p {{bidirectional: [4, true], graph_idx: [2, 0], speed_limit: [3, 0.5]}}\nlanes:\n{lanes}"
        ));
        assert_eq!(all.unwrap()["lanes"][4999][2]["graph_idx"], json!([2, 0]));
    }

    #[test]
    fn nesting_is_bounded() {
        let nested = |depth: usize| "[".repeat(depth) + &"]".repeat(depth);
        assert!(value(&nested(DEEPEST)).is_ok());
        let through = |depth: usize| format!("a: &a {}\nb: {}*a{}", nested(40), "[".repeat(depth), "]".repeat(depth));
        assert!(value(&through(DEEPEST - 41)).is_ok());
        let blocks: String = (0..300).map(|k| format!("{}a:\n", " ".repeat(k))).collect();
        for text in [
            nested(DEEPEST + 1),
            nested(100_000),
            "[".repeat(100_000),
            "{a: ".repeat(100_000),
            "- ".repeat(100_000),
            "? ".repeat(100_000),
            through(DEEPEST - 40),
            blocks,
        ] {
            let error = value(&text).unwrap_err();
            assert!(error.contains(": too large or too deep: "), "{error}");
        }
    }
}
