//! What the line on the terminal says of the time to go. The tool is no library, so its file is read in.

#[allow(dead_code)]
#[path = "../../src/progress.rs"]
mod source;

use source::{ProgressCounters, line, remaining};
use std::time::Duration;

#[test]
fn what_is_left_takes_as_long_as_what_is_done() {
    let after = |done| remaining(done, 1000, Duration::from_secs(10));
    assert_eq!([after(9), after(10), after(250), after(1000)], [None, Some(990), Some(30), Some(0)]);
}

#[test]
fn the_line_has_a_percentage_and_the_remaining_time() {
    let line = |done: usize, total: usize, limit: u64| {
        let counts =
            ProgressCounters { done: done.into(), total: total.into(), limit: limit.into(), part: None.into() };
        line("planning", &counts, Duration::from_secs(10))
    };
    assert_eq!(line(250, 1000, 0), "planning: 250 of 1000 (25 %, 25 a second, 10 s, 30 s to go)");
    assert_eq!(line(0, 0, 40_000), "planning (25 % of the time limit, 10 s, 30 s to go)");
    assert_eq!(line(0, 0, 0), "planning (10 s)");
    assert_eq!(line(7, 0, 0), "planning: 7 (10 s)");
}

#[test]
fn a_part_of_the_work_has_its_own_time() {
    let counts = ProgressCounters {
        done: 250.into(),
        total: 1000.into(),
        limit: 0.into(),
        part: Some(("checks of the plan", 6_000)).into(),
    };
    let line = line("planning", &counts, Duration::from_secs(10));
    assert_eq!(line, "planning, checks of the plan: 250 of 1000 (25 %, 62 a second, 4 s, 12 s to go)");
}

/// Pictures that took more than a second, after which the progress is shown, were never done where standard error was a terminal.
#[cfg(target_os = "linux")]
#[test]
fn pictures_are_done_while_a_terminal_shows_the_progress() {
    use crate::fixture::{directory, file, pcr, straight};
    use std::process::{Command, Stdio};
    let pair = |k: u64| {
        let y = 8.0 * k as f64;
        [
            straight(2 * k + 1, [-2.0, y, 0.0], 4.0),
            straight(2 * k + 2, [0.0, y - 2.0, std::f64::consts::FRAC_PI_2], 4.0),
        ]
    };
    let agents: Vec<_> = (0..30).flat_map(pair).collect();
    let scenario = file("terminal", "pairs.json", serde_json::json!({ "agents": agents }).to_string());
    let pictures = directory("terminal").join("pictures");
    let _ = std::fs::remove_dir_all(&pictures);
    // `script` gives it a terminal, and `timeout` ends a run that hangs.
    let command = format!(
        "timeout 120 '{}' plan '{scenario}' --pictures '{}'",
        pcr().get_program().to_string_lossy(),
        pictures.display()
    );
    let status = Command::new("script")
        .args(["-qec", &command, "/dev/null"])
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .status()
        .expect("script, of Debian's bsdutils");
    assert_eq!(status.code(), Some(0), "124 is that of timeout");
    assert!(pictures.join("after").join("index.html").exists());
}
