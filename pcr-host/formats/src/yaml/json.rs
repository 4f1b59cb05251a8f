//! A document as a value of JSON.

use super::scalar::{self, integer, is_null};
use super::{ScalarTag, YamlDocument, YamlError, YamlNode, YamlValue, deeper, error_at};
use serde_json::{Map, Number, Value as Json};
use std::collections::{HashMap, HashSet};

/// How many times the length of the text, in values and bytes of texts, a document may stand for. Without aliases it is less than 3.
const REPETITION: usize = 10;

impl<'t> YamlDocument<'t> {
    /// All of it, with what aliases and merge keys stand for.
    ///
    /// # Errors
    /// [`YamlError`] where a value or a name cannot be one of JSON, a name is there twice, or aliases repeat too much.
    pub fn value(&self) -> Result<Json, YamlError> {
        AliasResolver::of(self).value(&self.root, 0)
    }

    /// The same tree with every scalar as its text, without its quotes: for names, which may be any scalar. What stands for nothing and is
    /// no empty text is `null`.
    ///
    /// # Errors
    /// As [`YamlDocument::value`].
    pub fn texts(&self) -> Result<Json, YamlError> {
        AliasResolver { as_texts: true, ..AliasResolver::of(self) }.value(&self.root, 0)
    }

    /// The names of the members of a member, in the order of the text; what is merged comes last.
    ///
    /// # Errors
    /// As [`YamlDocument::value`].
    pub fn names(&self, name: &str) -> Result<Vec<String>, YamlError> {
        let mut resolver = AliasResolver::of(self);
        let all = resolver.members(&self.root, 0)?;
        let Some(member) = all.into_iter().find(|member| member.name == name) else { return Ok(Vec::new()) };
        Ok(resolver.members(member.value, 1)?.into_iter().map(|member| member.name.to_owned()).collect())
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
        Self { text: document.text, anchors, left, as_texts: false }
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

    fn value(&mut self, node: &'d YamlNode<'t>, depth: usize) -> Result<Json, YamlError> {
        let node = self.target(node)?;
        match &node.value {
            YamlValue::Scalar(text) => {
                self.count(node, text.len())?;
                if self.as_texts {
                    let text = if is_nothing(node, text) { NULL } else { &**text };
                    return Ok(Json::String(text.to_owned()));
                }
                scalar::value(node.kind, text).map_err(|problem| self.error(node, problem))
            }
            YamlValue::Sequence(_, elements) => {
                self.count(node, 0)?;
                let depth = deeper(self.text, node.span.start, depth)?;
                elements.iter().map(|element| self.value(element, depth)).collect()
            }
            YamlValue::Mapping(..) => {
                self.count(node, 0)?;
                let below = deeper(self.text, node.span.start, depth)?;
                let mut object = Map::new();
                for member in self.members(node, depth)? {
                    let value = self.value(member.value, below)?;
                    object.insert(member.name.to_owned(), value);
                }
                Ok(Json::Object(object))
            }
            YamlValue::Alias(_) => Err(self.error(node, "an alias for an alias")),
        }
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
    use serde_json::json;

    fn value(text: &str) -> Result<Json, String> {
        YamlDocument::read(text).and_then(|document| document.value()).map_err(|error| error.to_string())
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
        let texts = |text: &str| YamlDocument::read(text).unwrap().texts();
        let all = json!({"a": ["007", "1.0", "true", "null", "null", "", "x y", "0x10"], "b": {"c": "1"}});
        assert_eq!(texts("a: [007, 1.0, true, ~, null, '', \"x y\", &n 0x10]\nb: {c: 1}"), Ok(all));
        assert_eq!(texts("a: &x 1.50\nb: *x\n<<: {c: .nan}"), Ok(json!({"a": "1.50", "b": "1.50", "c": ".nan"})));
    }

    #[test]
    fn names_have_the_order_of_the_text() {
        let names = |text: &str| YamlDocument::read(text).unwrap().names("levels");
        assert_eq!(names("levels: {b: 1, a: 2, <<: {c: 3, a: 4}}"), Ok(["b", "a", "c"].map(str::to_owned).to_vec()));
        assert_eq!(names("more: &l {z: 1, a: 2}\nlevels: *l"), Ok(["z", "a"].map(str::to_owned).to_vec()));
        assert_eq!(names("<<: {levels: {z: 1, a: 2}}"), Ok(["z", "a"].map(str::to_owned).to_vec()));
        assert_eq!((names("levels:"), names("[1]"), names("")), (Ok(vec![]), Ok(vec![]), Ok(vec![])));
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
