//! JSON Lines: a scenario a line in, a line a scenario out, whatever is wrong with one of them.

use crate::fixture::{column, crossing, pcr, run_with};
use serde_json::{Value, json};
use std::io::{BufRead, BufReader, Write};
use std::process::Stdio;

fn answers(text: &str) -> Vec<Value> {
    text.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

fn named(name: &str) -> String {
    let mut scenario = crossing();
    scenario["name"] = json!(name);
    scenario.to_string()
}

#[test]
fn a_bad_line_is_answered_in_its_place_and_the_run_goes_on() {
    let mut bad = crossing();
    bad["name"] = json!("bad");
    bad["agents"][1]["path"][0]["length"] = json!(-4);
    // The byte order mark, the carriage returns, the blank lines and the missing end of the last line do no harm.
    let input = format!("\u{feff}{}\r\n\r\n{bad}\n  \n{{]\n{}", named("first"), named("last"));
    let run = run_with(&["regions", "-", "--format", "json"], input.as_bytes());
    assert_eq!((run.status, run.err.as_str()), (2, "pcr: standard input: 2 of 4 scenarios refused\n"));
    let answers = answers(&run.out);
    let names: Vec<&str> = answers.iter().map(|answer| answer["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["first", "bad", "", "last"]);
    for good in [&answers[0], &answers[3]] {
        assert_eq!((good["regions"].as_array().unwrap().len(), &good["error"]), (2, &Value::Null));
    }
    let column = column(&bad, "/agents/1/path/0/length");
    let message =
        format!("line 3, column {column}: agent 2, segment 1, length: -4 is out of range; allowed is 0 to 1e10");
    assert_eq!(
        answers[1],
        json!({ "format": "pcr-regions", "version": 2, "name": "bad", "scalar": "f64", "regions": [], "error": message, "warnings": [] })
    );
    assert_eq!(answers[2]["error"], json!("line 5, column 2: ] where a key in quotes is expected"));
}

#[test]
fn good_lines_leave_no_error() {
    let input = format!("{}\n{}\n", named("a"), named("b"));
    let run = run_with(&["regions", "-", "--format", "json", "--slices", "3", "--scalar", "f32"], input.as_bytes());
    let answers = answers(&run.ok());
    assert_eq!(answers.len(), 2);
    assert_eq!(answers[1]["regions"][0]["slices"].as_array().unwrap().len(), 3);
    // Nothing at all is an answer to nothing, but no sign that nobody collides: whoever should have written has failed.
    let empty = run_with(&["check", "-"], b"\n").failed(2);
    assert_eq!(empty, "pcr: standard input: empty; a scenario is expected\n");
}

#[test]
fn every_answer_is_there_before_the_next_line_is_read() {
    let mut child =
        pcr().args(["regions", "-", "--format", "json"]).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap();
    let mut input = child.stdin.take().unwrap();
    let mut output = BufReader::new(child.stdout.take().unwrap());
    for name in ["one", "two", "three"] {
        writeln!(input, "{}", named(name)).unwrap();
        input.flush().unwrap();
        let mut line = String::new();
        output.read_line(&mut line).unwrap();
        assert!(
            line.starts_with(&format!("{{\"format\":\"pcr-regions\",\"version\":2,\"name\":\"{name}\",")),
            "{line}"
        );
    }
    drop(input);
    assert!(child.wait().unwrap().success());
}

#[test]
fn lines_that_are_not_text_are_refused_alone() {
    let mut input = named("first").into_bytes();
    input.extend(b"\n{\"name\": \"\xff\xfe\"}\n");
    input.extend(named("last").into_bytes());
    let run = run_with(&["regions", "-", "--format", "json"], &input);
    assert_eq!(run.status, 2);
    let answers = answers(&run.out);
    assert_eq!(answers.len(), 3);
    assert_eq!(answers[1]["error"], json!("line 2: not text in UTF-8"));
}

#[test]
fn what_a_number_format_or_a_request_refuses_is_an_error_of_its_line() {
    let mut far = crossing();
    far["name"] = json!("far");
    far["agents"][0]["start"]["x"] = json!(5e6);
    let input = format!("{far}\n{}", named("near"));
    let run = run_with(&["regions", "-", "--format", "json", "--scalar", "f32", "--agent", "1"], input.as_bytes());
    let answers = answers(&run.out);
    let message = "line 1: agent 1, start.x: 5e6 is out of range; allowed is up to 1e6 in magnitude (f32)";
    assert_eq!(
        answers[0],
        json!({ "format": "pcr-regions", "version": 2, "name": "far", "scalar": "f32", "regions": [], "error": message, "warnings": [] })
    );
    assert_eq!((run.status, answers[1]["regions"].as_array().unwrap().len()), (2, 1));
    let run = run_with(&["regions", "-", "--format", "json", "--agent", "3"], named("near").as_bytes());
    assert!(run.out.contains("\"error\":\"line 1: no agent 3; there are 1, 2\""), "{}", run.out);
}

#[test]
fn tables_and_csv_of_lines_have_their_errors_on_standard_error() {
    let input = format!("{}\nnonsense\n{}", named("first"), named("last"));
    let csv = run_with(&["regions", "-", "--format", "csv"], input.as_bytes());
    let names: Vec<&str> = csv.out.lines().map(|line| line.split(',').next().unwrap()).collect();
    assert_eq!(names, ["name", "first", "first", "last", "last"]);
    let message = "pcr: standard input: line 2, column 1: nonsense where a value is expected\n\
                   pcr: standard input: 1 of 3 scenarios refused\n";
    assert_eq!((csv.status, csv.err.as_str()), (2, message));
    let table = run_with(&["regions", "-"], input.as_bytes());
    assert_eq!((table.status, table.err.as_str()), (2, message));
    assert!(table.out.contains("first: 2 collision regions") && table.out.contains("last: 2 collision regions"));
}

/// As for a file, a format that is known by its content need not be named.
#[test]
fn another_format_is_read_as_one_file() {
    let data = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/data");
    let plan = std::fs::read(format!("{data}/real/ccbs/example_grid_task_log.xml")).unwrap();
    for command in ["check", "plan"] {
        let run = run_with(&[command, "--radius", "0.353553", "--json", "-q"], &plan);
        assert_eq!(run.status, 0, "{command}: {}", run.err);
    }
    // JSON over several lines, with warnings.
    let state = std::fs::read_to_string(format!("{data}/small/state.json")).unwrap();
    let pretty = serde_json::to_string_pretty(&serde_json::from_str::<Value>(&state).unwrap()).unwrap();
    let vehicle = ["--speed", "1", "--acceleration", "1", "--rotation", "1", "--rotation-acceleration", "1"];
    let regions = ["regions", "--json", "--radius", "0.4"];
    let run = run_with(&[&regions[..], &vehicle].concat(), pretty.as_bytes());
    assert_eq!((run.status, answers(&run.out).len()), (0, 1), "{}", run.err);
    let unknown = run_with(&["check"], b"<html>\n<body>\n").failed(2);
    assert!(unknown.starts_with("pcr: standard input: no scenario, which is a JSON object, nor another"), "{unknown}");
    // An option that does nothing with scenarios is refused as with a file.
    let vain = run_with(&["check", "--radius", "1"], named("a").as_bytes()).failed(2);
    assert!(vain.contains("standard input: --radius has no effect: a scenario has its own vehicles"), "{vain}");
    let mut wide = crossing();
    (0..2).for_each(|agent| wide["agents"][agent]["margin"] = json!(0.05));
    let run = run_with(&["regions", "--margin", "0.1", "-q"], wide.to_string().as_bytes());
    assert!(run.err.contains("line 1: --margin has no effect: every agent has a margin of its own"), "{}", run.err);
}

#[test]
fn a_text_without_any_scenario_ends_soon() {
    let run = run_with(&["check"], "nonsense\n".repeat(1000).as_bytes());
    assert_eq!((run.status, run.err.lines().count()), (2, 9), "{}", run.err);
    assert!(run.err.lines().last().unwrap().contains("say what it is with --from"), "{}", run.err);
    // Whatever comes between scenarios is refused line by line.
    let input = format!("{}\n{}{}\n", named("first"), "nonsense\n".repeat(20), named("last"));
    let run = run_with(&["regions", "--json"], input.as_bytes());
    assert_eq!((run.status, answers(&run.out).len()), (2, 22), "{}", run.err);
}
