//! The ledger of claims, `proofs/ledger.toml`, and the tables of docs/reference/bounds.md and docs/theory/errors.md say the same. What holds the claims is what
//! `proofs/check.sh` runs.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("a workspace")
}

fn text(path: &str) -> String {
    fs::read_to_string(root().join(path)).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// The claims: what is on the lines `key = "value"` of each.
fn claims() -> Vec<BTreeMap<String, String>> {
    let ledger = text("proofs/ledger.toml");
    let claims = ledger.split("[[claim]]").skip(1).map(|claim| {
        let values = claim.lines().filter_map(|line| line.split_once(" = "));
        values.map(|(key, value)| (key.to_owned(), value.trim_matches(['"', '\'']).to_owned())).collect()
    });
    claims.collect()
}

/// The rows of the tables of a document: their anchor, if they have one, and their second cell.
fn rows(document: &str) -> Vec<(Option<String>, String)> {
    let lines: Vec<_> = document.lines().collect();
    let is_head = |at: usize| lines.get(at + 1).is_some_and(|next| next.starts_with("|---"));
    let rows = (0..lines.len()).filter(|&at| lines[at].starts_with("| ") && !is_head(at)).map(|at| {
        let line = lines[at].replace("\\|", "\\\0");
        let mut cells = line.split('|').skip(1).map(|cell| cell.trim().replace('\0', "|"));
        let [first, second] = [cells.next(), cells.next()].map(|cell| cell.expect("two cells a row"));
        let anchor = first.strip_prefix("<a id=\"").and_then(|rest| rest.split_once('"'));
        (anchor.map(|(id, _)| id.to_owned()), second)
    });
    rows.collect()
}

#[test]
fn every_row_is_a_claim_of_the_ledger_with_the_same_bound() {
    let claims = claims();
    let documents = ["docs/reference/bounds.md", "docs/theory/errors.md"];
    let rows: Vec<_> = documents.iter().flat_map(|document| rows(&text(document))).collect();
    assert!(rows.len() > 40, "{}", rows.len());
    for (id, bound) in &rows {
        let id = id.as_ref().unwrap_or_else(|| panic!("a row without an id: {bound}"));
        let claim =
            claims.iter().find(|claim| claim["id"] == *id).unwrap_or_else(|| panic!("{id} is not in the ledger"));
        assert_eq!(claim["bound"], *bound, "{id}");
    }
}

#[test]
fn every_claim_has_its_place_and_its_files() {
    let mut seen = Vec::new();
    for claim in claims() {
        let id = &claim["id"];
        assert!(!seen.contains(id), "{id} is there twice");
        seen.push(id.clone());
        let document = text(&claim["file"]);
        let anchored = document.contains(&format!("<a id=\"{id}\"></a>"));
        assert!(
            anchored || !["docs/reference/bounds.md", "docs/theory/errors.md"].contains(&claim["file"].as_str()),
            "{id} is nowhere in {}",
            claim["file"]
        );
        for source in claim
            .get("source")
            .into_iter()
            .cloned()
            .chain(claim.get("script").map(|script| format!("proofs/gappa/{script}.g")))
        {
            assert!(root().join(&source).is_file(), "{id}: {source}");
        }
    }
    // What is recorded of kernels is what scripts are about.
    let scripts: Vec<_> =
        fs::read_dir(root().join("proofs/gappa")).expect("scripts").map(|file| file.expect("a file").path()).collect();
    for recorded in fs::read_dir(root().join("proofs/recorded")).expect("kernels") {
        let path = recorded.expect("a file").path();
        let name = format!("@recorded {}", path.file_stem().expect("a name").display());
        let used =
            scripts.iter().any(|script| fs::read_to_string(script).expect("a script").lines().any(|line| line == name));
        assert!(used, "{name}");
    }
}
