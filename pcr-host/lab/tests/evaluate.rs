//! The binary `pcr-lab`: the document with its pictures, from small fleets, and a comparison.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// What a run has printed, and its exit status.
struct Run {
    out: String,
    err: String,
    status: i32,
}

impl Run {
    /// The message of a run that has failed with this status.
    fn failed(self, status: i32) -> String {
        assert_eq!((self.status, self.out.as_str()), (status, ""), "{}", self.err);
        self.err
    }
}

fn run(arguments: &[&str]) -> Run {
    let output = Command::new(env!("CARGO_BIN_EXE_pcr-lab")).args(arguments).output().unwrap();
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    Run { out: text(output.stdout), err: text(output.stderr), status: output.status.code().unwrap() }
}

/// A folder for the files of one test.
fn directory(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    fs::create_dir_all(&folder).unwrap();
    folder
}

#[test]
fn the_document_and_all_its_pictures_are_written() {
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/data");
    let output = directory("evaluate");
    // Of a run that has failed.
    let _ = fs::remove_file(output.join("evaluation.md"));
    let result = run(&["evaluate", "--quick", "--data", data.to_str().unwrap(), "-o", output.to_str().unwrap()]);
    // A line a part on standard error, as it begins: the whole takes minutes.
    let parts: Vec<&str> = result.err.lines().collect();
    assert!(parts[0].starts_with("part 1 of 13: fleets, 0 s"), "{parts:?}");
    assert_eq!((result.status, parts.len()), (0, 13), "{parts:?}");
    let files = result.out.clone();
    let text = fs::read_to_string(output.join("evaluation.md")).unwrap();
    for heading in
        ["# Evaluation", "## Table VI", "## All methods, 12 agents", "## Fig. 12", "## Fig. 13", "## Fig. 14"]
    {
        assert!(text.contains(&format!("\n{heading}")) || text.starts_with(heading), "{heading}");
    }
    for heading in ["## Grazing pairs", "## Memory, and bytes on the wire", "## Scale"] {
        assert!(text.contains(&format!("\n{heading}\n")), "{heading}");
    }
    assert!(!text.contains("NaN") && !text.contains("inf "), "{text}");
    let pictures: Vec<&str> =
        text.split("](pictures/").skip(1).filter_map(|rest| rest.split_once(')')).map(|(name, _)| name).collect();
    assert_eq!(pictures.len() + 1, files.lines().count(), "{files}");
    for name in pictures {
        let svg = fs::read_to_string(output.join("pictures").join(name)).unwrap();
        let document = roxmltree::Document::parse(&svg).unwrap();
        assert!(document.root_element().has_tag_name("svg") && !svg.contains("NaN"), "{name}");
    }
    // One part anew: nothing else changes, and that part as little as memory does.
    let target = output.to_str().unwrap();
    let only = ["evaluate", "--quick", "--data", data.to_str().unwrap(), "-o", target, "--only", "memory"];
    let written = run(&only).out;
    assert_eq!(written, format!("{}\n", output.join("evaluation.md").display()));
    assert_eq!(fs::read_to_string(output.join("evaluation.md")).unwrap(), text);
    let full: Vec<&str> = only.iter().copied().filter(|word| *word != "--quick").collect();
    let message = run(&full).failed(2);
    assert!(message.contains("was written with --quick"), "{message}");
    let without = text.replace("## Memory, and bytes on the wire", "## Something else");
    fs::write(output.join("evaluation.md"), &without).unwrap();
    let message = run(&only).failed(2);
    assert!(message.contains("has no section \"## Memory, and bytes on the wire\""), "{message}");
    assert_eq!(fs::read_to_string(output.join("evaluation.md")).unwrap(), without);
    // Somebody else's is not lost, also if it is no text.
    fs::write(output.join("evaluation.md"), b"# Evaluation\n\nmine \xff\n").unwrap();
    let message = run(&only[..6]).failed(2);
    assert!(message.contains("is there and not of this command"), "{message}");
    // Rows of the grazing table: double precision is never wrong, lines at 10 mm are wrong about all near misses.
    let row = |name: &str| text.lines().find(|line| line.starts_with(name) && line.contains('·')).unwrap();
    assert!(row("| pcr f64 ").ends_with("| 4 · 0 | 0 | – |"));
    assert!(row("| polyline 10 mm ").contains("| 4 · 4 | 24 | everywhere |"));
}

#[test]
fn data_that_is_not_there_is_named() {
    let message = run(&["evaluate", "--quick", "--data", "nowhere"]).failed(2);
    assert!(message.starts_with("pcr-lab: nowhere/paper12.json: cannot be read: "), "{message}");
}

#[test]
fn a_comparison_has_the_methods_of_others() {
    let fleet = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/crossing.json");
    let compared = run(&["compare", fleet.to_str().unwrap(), "--method", "parry", "--rounds", "1"]);
    assert_eq!(compared.status, 0, "{}", compared.err);
    assert!(compared.out.contains("parry2d casts") && compared.out.contains("parry3d meshes"), "{}", compared.out);
}
