//! Output that cannot be written, or that nobody reads to its end.

use crate::fixture::{PAPER, crossing, file, pcr, straight};
use serde_json::json;
use std::io::{Read, Write};
use std::process::Stdio;

#[test]
fn a_reader_that_has_seen_enough_is_no_error() {
    let mut child = pcr()
        .args(["regions", PAPER, "--format", "json", "--slices", "300"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    // The output is far longer than a pipe holds, so the tool is still writing when its reader goes.
    let mut first = [0; 35];
    child.stdout.take().unwrap().read_exact(&mut first).unwrap();
    let output = child.wait_with_output().unwrap();
    assert_eq!(&first, b"{\"format\":\"pcr-regions\",\"version\":2");
    assert_eq!((output.status.code(), String::from_utf8(output.stderr).unwrap().as_str()), (Some(0), ""));
}

/// The status and message of a run whose output nobody reads, from before its input is there.
fn unread(arguments: &[&str], input: &str) -> (Option<i32>, String) {
    let mut child =
        pcr().args(arguments).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    drop(child.stdout.take());
    let mut stdin = child.stdin.take().unwrap();
    stdin.write_all(input.as_bytes()).unwrap();
    drop(stdin);
    let output = child.wait_with_output().unwrap();
    (output.status.code(), String::from_utf8(output.stderr).unwrap())
}

#[test]
fn a_status_that_is_an_answer_is_right_where_nobody_reads_the_rest() {
    let mut free = crossing();
    let crossing = free.to_string();
    free["agents"][1]["t_start"] = json!(9.0);
    let free = free.to_string();
    let stuck = json!({ "agents": [
        straight(1, [0.0, 0.0, 0.0], 4.0), straight(2, [0.1, 0.0, 0.0], 4.0)] });
    let layout = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/data/real/nav2/warehouse_graph.geojson");
    let table = file("streams", "no-table.json", "{}");
    for (arguments, input, status) in [
        (&["check", "--json"][..], &*crossing, 1),
        (&["check"], &crossing, 1),
        (&["check", "--format", "csv"], &crossing, 1),
        (&["check", "--json"], &free, 0),
        (&["check", "--json"], "{}", 2),
        (&["check", "--json", "-", "-"], &free, 2),
        (&["plan", "--json"], &stuck.to_string(), 1),
        (&["plan", "-o", "-", "-q"], &crossing, 0),
        (&["certify", "--table", &table], "", 2),
        (&["certify", "--json"], &crossing, 0),
        (&["locks", layout, "--radius", "0.4", "--audit"], "", 1),
        (&["traffic", layout, "--radius", "0.4", "--agents", "3"], "", 0),
        (&["simulate", "--controller", "pcr", "-o", "-", "-q"], &crossing, 0),
        // What only prints has no more to say.
        (&["regions", "--json"], &crossing, 0),
        (&["nodes", layout], "", 0),
    ] {
        let (found, message) = unread(arguments, input);
        assert_eq!(found, Some(status), "{arguments:?}: {message}");
    }
    // Scenarios may come in for ever: those that are not looked at any more are not free.
    let line = |scenario: &str| format!("{scenario}\n");
    let (status, message) = unread(&["check", "--json"], &[line(&free), line(&crossing)].concat());
    let expected = "pcr: standard output: closed; nothing is said of line 2 and what follows\n";
    assert_eq!((status, message.as_str()), (Some(3), expected));
    assert_eq!(unread(&["check", "--json"], &[line(&crossing), line(&free)].concat()).0, Some(1));
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_an_error_of_its_own() {
    for arguments in [
        &["regions", PAPER][..],
        &["regions", PAPER, "--format", "json"],
        &["regions", PAPER, "--format", "csv"],
        &["demo", "--scenario"],
        &["help"],
        &["--help"],
        &["plan", "-h"],
        &["--version"],
        &["completions", "zsh"],
        &["man"],
        &["plan", PAPER, "-o", "-", "-q"],
        &[],
    ] {
        let full = std::fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
        let output = pcr().args(arguments).stdout(full).output().unwrap();
        let message = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(3), "{arguments:?}: {message}");
        assert!(message.starts_with("pcr: standard output: cannot be written: "), "{message}");
    }
}
