//! The published schemas, against everything that is said.

use pcr_formats::vda5050::topics::{TopicInterface, TopicKind};
use serde_json::Value;
use std::collections::BTreeMap;

/// The schema of a kind of messages.
pub(crate) fn schema(version: &str, kind: TopicKind) -> jsonschema::Validator {
    let name = match (version, kind) {
        ("2.0.0", TopicKind::Factsheet) => "factsheet.json".to_owned(),
        _ => format!("{}.schema", kind.text()),
    };
    let file = format!("{}/../../tests/data/real/vda5050/schemas/{version}/{name}", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(&file).unwrap_or_else(|error| panic!("{file}: {error}"));
    let schema: Value =
        serde_json::from_str(&without_trailing_commas(&text)).unwrap_or_else(|error| panic!("{file}: {error}"));
    jsonschema::validator_for(&schema).unwrap_or_else(|error| panic!("{file}: {error}"))
}

/// Three of the schemas of 3.0.0 are published with commas before closing brackets, which is no JSON.
fn without_trailing_commas(text: &str) -> String {
    let mut kept = String::new();
    for (place, sign) in text.char_indices() {
        let next = text[place + sign.len_utf8()..].trim_start().chars().next();
        if !(sign == ',' && matches!(next, Some('}' | ']'))) {
            kept.push(sign);
        }
    }
    kept
}

/// Checks messages by their topics; returns how many there were of each kind and edition.
pub(crate) fn check(messages: &[(String, Vec<u8>)], interfaces: &[TopicInterface]) -> BTreeMap<String, usize> {
    let (mut schemas, mut seen) = (BTreeMap::new(), BTreeMap::new());
    for (topic, payload) in messages {
        let Some((_, key, kind)) = interfaces.iter().find_map(|interface| interface.parse(topic)) else {
            panic!("a message in {topic}")
        };
        if key.manufacturer == "pcr" {
            continue;
        }
        let message: Value = serde_json::from_slice(payload).unwrap();
        let version = message["version"].as_str().unwrap().to_owned();
        let id = format!("{version} {}", kind.text());
        let schema = schemas.entry(id.clone()).or_insert_with(|| schema(&version, kind));
        let faults: Vec<String> =
            schema.iter_errors(&message).map(|error| format!("{}: {error}", error.instance_path())).collect();
        assert_eq!(faults, Vec::<String>::new(), "{topic}: {message}");
        *seen.entry(id).or_insert(0) += 1;
    }
    seen
}

#[test]
fn schemas_refuse_what_is_wrong() {
    for version in ["2.0.0", "2.1.0", "3.0.0"] {
        for kind in [TopicKind::Order, TopicKind::State, TopicKind::Connection, TopicKind::Factsheet] {
            assert!(!schema(version, kind).is_valid(&serde_json::json!({ "headerId": "one" })), "{version} {kind:?}");
        }
    }
}
