//! YAML against another reader of it: the same values, and the same texts refused.

use pcr_formats::splitmix64::SplitMix64;
use pcr_formats::yaml::YamlDocument;
use serde_json::Value;
use std::fs;
use std::path::PathBuf;

fn value(text: &str) -> Result<Value, String> {
    YamlDocument::read(text).and_then(|document| Ok(document.value()?.to_value())).map_err(|error| error.to_string())
}

/// What the other reader says, as text: then the kinds of numbers count, too.
fn both(text: &str) -> [Option<String>; 2] {
    let other: Option<Value> = serde_saphyr::from_str(text).ok();
    [value(text).ok(), other].map(|value| value.map(|value| value.to_string()))
}

/// Whether the readers are known to differ: the other one keeps the last of `1` and `'1'` and the first of two merge keys, takes a name
/// that is not there for an empty text, and refuses names that stand for nothing or have a tag of another kind than a text.
fn is_known(text: &str, own: Option<&str>, other: Option<&str>) -> bool {
    match (own, other) {
        (None, Some(_)) => {
            value(text).is_err_and(|error| error.ends_with("is there twice") || error.ends_with("a name is expected"))
        }
        (Some(own), None) => {
            own.contains("\"null\":") || text.contains("!!int") || text.contains("!!null") || text.contains("!!float")
        }
        _ => false,
    }
}

fn files() -> Vec<(PathBuf, String)> {
    let mut folders = vec![PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/data"))];
    let mut files = Vec::new();
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|end| end == "yaml") {
                let text = fs::read_to_string(&path).unwrap();
                files.push((path, text));
            }
        }
    }
    files.sort();
    files
}

#[test]
fn files_say_the_same_to_both_readers() {
    let files = files();
    assert!(files.len() > 6);
    for (path, text) in files {
        let [own, other] = both(&text);
        assert!(own.is_some() && own == other, "{}", path.display());
        // Cut, and with a line less.
        let lines: Vec<&str> = text.split_inclusive('\n').take(120).collect();
        for k in 0..lines.len() {
            let begin = lines[..k].concat();
            let half: String = lines[k].chars().take(lines[k].chars().count() / 2).collect();
            for text in [begin.clone() + &half, begin + &lines[k + 1..].concat()] {
                let [own, other] = both(&text);
                assert_eq!(own, other, "{}: {text}", path.display());
            }
        }
    }
}

/// Texts with the forms that files seldom have, each between the lines with =====.
const TEXTS: &str = include_str!("../data/yaml.txt");

#[test]
fn all_forms_say_the_same_to_both_readers() {
    let (mut read, mut refused) = (0, 0);
    for text in TEXTS.split("=====\n") {
        for text in
            [text.to_owned(), text.replace('\n', "\r\n"), format!("\u{feff}{text}"), format!("---\n{text}...\n")]
        {
            let [own, other] = both(&text);
            let known = is_known(&text, own.as_deref(), other.as_deref());
            assert!(own == other || known, "{text:?}: {own:?} {other:?}");
            if own.is_some() { read += 1 } else { refused += 1 }
        }
    }
    assert!(read > 200 && refused > 100, "{read} read, {refused} refused");
}

/// Scalars and names from parts, in lists, mappings and blocks.
#[test]
fn texts_from_parts_say_the_same_to_both_readers() {
    let parts = [
        "1", "-", "+", ".", "0x", "e3", "_", "~", "null", "no", "'", "\"", " ", ": ", "#", " #", "[", "]", "{", "}",
        ", ", "\n", "\n  ", "- ", "? ", "&a ", "*a", "!!str ", "!!int ", "|\n  x", "<<", "\t", "é", "\\",
    ];
    let mut random = SplitMix64(1);
    let mut next = |count: usize| random.below(count);
    let (mut read, mut refused) = (0, 0);
    for _ in 0..20_000 {
        let begin = ["", "a: ", "- ", "a: &a 1\nb: ", "[&a x, "][next(5)];
        let text = begin.to_owned() + &(0..1 + next(5)).map(|_| parts[next(parts.len())]).collect::<String>();
        let [own, other] = both(&text);
        let known = is_known(&text, own.as_deref(), other.as_deref());
        assert!(own == other || known, "{text:?}: {own:?} {other:?}");
        if own.is_some() { read += 1 } else { refused += 1 }
    }
    assert!(read > 1000 && refused > 1000, "{read} read, {refused} refused");
}
