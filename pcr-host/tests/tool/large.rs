//! Fleets beyond what a table numbers, and beyond what memory holds.

use crate::fixture::{file, run};
use serde_json::json;
use std::process::Command;

/// Discs that stand, so many metres apart.
fn discs(count: usize, apart: f64) -> String {
    let side = (count as f64).sqrt().ceil() as usize;
    let agent = |k: usize| {
        let (x, y) = ((k % side) as f64 * apart, (k / side) as f64 * apart);
        json!({ "id": k + 1, "radius": 0.3, "v_max": 1, "a_max": 1, "start": { "x": x, "y": y, "heading": 0 }, "path": [] })
    };
    json!({ "agents": (0..count).map(agent).collect::<Vec<_>>() }).to_string()
}

#[test]
fn more_agents_than_a_table_numbers_are_answered() {
    let name = file("large", "discs.json", discs(70_000, 3.0));
    assert_eq!(run(&["regions", &name, "--format", "csv"]).ok().lines().count(), 1);
    assert_eq!(run(&["check", &name]).ok(), "discs: no conflicts\n");
}

/// Runs with so much address space \[kB\].
#[cfg(target_os = "linux")]
fn limited(kilobytes: u32, arguments: &[&str]) -> (Option<i32>, String) {
    let script = format!("ulimit -v {kilobytes}; exec \"$0\" \"$@\" > /dev/null");
    let output =
        Command::new("bash").args(["-c", &script, env!("CARGO_BIN_EXE_pcr")]).args(arguments).output().unwrap();
    (output.status.code(), String::from_utf8(output.stderr).unwrap())
}

#[cfg(target_os = "linux")]
#[test]
fn what_memory_does_not_hold_is_refused_with_a_number() {
    let heap = file("large", "heap.json", discs(600, 0.001));
    for (limit, arguments) in [(400_000, &["regions", &heap][..]), (300_000, &["check", &heap])] {
        let (status, message) = limited(limit, arguments);
        assert_eq!(status, Some(2), "{arguments:?}: {message}");
        let number = message.contains(" MB ") && message.starts_with("pcr: ");
        assert!(number, "{arguments:?}: {message}");
    }
    // Row by row it fits.
    let (status, message) = limited(400_000, &["regions", &heap, "--format", "csv"]);
    assert_eq!((status, message.as_str()), (Some(0), ""));
}
