//! Documents name the code as it is: functions and tests that docs/theory/equations.md and docs/theory/errors.md speak of are there.

use std::fs;
use std::path::{Path, PathBuf};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("a workspace")
}

/// All source files of some folders, and what they hold.
fn sources(folders: &[&str]) -> Vec<(PathBuf, String)> {
    let (mut found, mut left) = (Vec::new(), folders.iter().map(|folder| root().join(folder)).collect::<Vec<_>>());
    while let Some(folder) = left.pop() {
        for entry in fs::read_dir(folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                left.push(path);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                let text = fs::read_to_string(&path).expect("text");
                found.push((path, text));
            }
        }
    }
    found
}

/// What a document has in backticks, line by line, and whether an arrow comes before it with nothing but names between.
fn quoted(document: &str) -> Vec<(String, bool)> {
    let mut all = Vec::new();
    for line in document.lines() {
        let mut after_arrow = false;
        for (place, part) in line.split('`').enumerate() {
            if place % 2 == 1 {
                all.push((part.to_owned(), after_arrow));
            } else {
                // A list of names goes on over commas and remarks in brackets.
                after_arrow = part.contains('→') || after_arrow && !part.contains([';', '.', '|']);
            }
        }
    }
    all
}

fn is_name(name: &str) -> bool {
    name.starts_with(|c: char| c.is_ascii_alphabetic())
        && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == ':')
}

/// Whether a text declares this name.
fn declares(text: &str, name: &str) -> bool {
    ["fn ", "struct ", "enum ", "trait ", "const ", "let ", "macro_rules! "].iter().any(|keyword| {
        let declaration = format!("{keyword}{name}");
        text.match_indices(&declaration).any(|(at, _)| {
            let next = text[at + declaration.len()..].chars().next();
            !next.is_some_and(|next| next.is_ascii_alphanumeric() || next == '_')
        })
    })
}

/// Whether a text has this method or field of a type, or this function of a module.
fn has_member(text: &str, of: &str, name: &str) -> bool {
    let method = text.contains(&format!("fn {name}(")) || text.contains(&format!("fn {name}<"));
    (method || text.contains(&format!("pub {name}: "))) && text.contains(of)
}

/// Names of functions in a document that are in no source file, and how many names it has.
fn missing(document: &str) -> (Vec<String>, usize) {
    let library =
        sources(&["pcr-core/src", "pcr-fixed/src", "proofs/certify/src", "pcr-host/planning/src/exclusion_table"]);
    let tests = sources(&["tests/tests", "pcr-core/src", "tests/src", "pcr-fixed/src", "proofs/certify/src"]);
    let (mut missing, mut names) = (Vec::new(), 0);
    let mut file = None;
    for (quote, after_arrow) in quoted(document) {
        if let Some((place, test)) =
            quote.split_once("::").filter(|(place, _)| place.ends_with(".rs") || place.is_empty())
        {
            names += 1;
            let (begin, whole) = test.strip_suffix('…').map_or((test, true), |begin| (begin, false));
            let there = tests
                .iter()
                .filter(|(path, _)| place.is_empty() || path.ends_with(place))
                .any(|(_, text)| if whole { declares(text, begin) } else { text.contains(&format!("fn {begin}")) });
            if !there {
                missing.push(quote);
            }
        } else if quote.ends_with(".rs") && !quote.contains(' ') {
            file = Some(quote);
        } else if let Some((of, name)) = quote.split_once("::").filter(|_| is_name(&quote) && quote != "file::test") {
            names += 1;
            if !library.iter().chain(&tests).any(|(_, text)| has_member(text, of, name)) {
                missing.push(quote);
            }
        } else if after_arrow && is_name(&quote) && !["f32", "f64"].contains(&quote.as_str()) {
            names += 1;
            let in_file = |path: &Path| file.as_ref().is_none_or(|file| path.ends_with(file));
            if !library.iter().any(|(path, text)| in_file(path) && declares(text, &quote)) {
                missing.push(quote);
            }
        }
    }
    (missing, names)
}

#[test]
fn functions_and_tests_that_documents_name_are_there() {
    for (path, least) in [("docs/theory/equations.md", 120), ("docs/theory/errors.md", 10)] {
        let document = fs::read_to_string(root().join(path)).expect("a document");
        let (missing, names) = missing(&document);
        assert!(missing.is_empty(), "{path} names what is not there: {missing:?}");
        assert!(names >= least, "{path}: only {names} names are seen");
    }
}

#[test]
fn names_of_earlier_days_are_noticed() {
    let document = "**Code:** `pair/events.rs` → `turning_lengths`, `add_events`; `pair/lateral_offset.rs` → `Relative::roots`. \
                    **Tests:** `golden.rs::not_there`, `::nor_there`.";
    let (missing, names) = missing(document);
    assert_eq!(missing, ["turning_lengths", "Relative::roots", "golden.rs::not_there", "::nor_there"]);
    assert_eq!(names, 5);
}
