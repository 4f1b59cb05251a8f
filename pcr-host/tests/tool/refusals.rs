//! Bad arguments and bad files: one message that says where and what, the exit status, and nothing else.

use crate::fixture::{PAPER, column, crossing, directory, file, run, run_with};
use serde_json::{Value, json};

/// The message about a file, without its name.
#[track_caller]
fn message(content: impl AsRef<[u8]>, arguments: &[&str]) -> String {
    let name = file("refused", &format!("{}.json", std::thread::current().name().unwrap().replace("::", "-")), content);
    let failed = run(&[&["regions", &name], arguments].concat()).failed(2);
    let rest = failed.strip_prefix(&format!("pcr: {name}:")).unwrap_or_else(|| panic!("{failed} does not name {name}"));
    rest.trim().to_owned()
}

#[track_caller]
fn refused(pointer: &str, value: Value, expected: &str) {
    let mut scenario = crossing();
    *scenario.pointer_mut(pointer).unwrap() = value;
    let expected = format!("1:{}: {expected}", column(&scenario, pointer));
    assert_eq!(message(scenario.to_string(), &["--format", "json"]), expected);
}

#[test]
fn values_out_of_range() {
    let positive = "is out of range; allowed is above 0, up to 1e10";
    refused("/agents/1/radius", json!(0), &format!("agent 2, radius: 0 {positive}"));
    refused("/agents/1/radius", json!(-0.25), &format!("agent 2, radius: -0.25 {positive}"));
    refused("/agents/0/v_max", json!(0), &format!("agent 1, v_max: 0 {positive}"));
    refused("/agents/0/a_max", json!(1e300), &format!("agent 1, a_max: 1e+300 {positive}"));
    refused(
        "/agents/0/path/0/length",
        json!(-1e-9),
        "agent 1, segment 1, length: -1e-9 is out of range; allowed is 0 to 1e10",
    );
}

#[test]
fn values_of_the_wrong_kind() {
    refused("/agents/1/id", json!(1), "agent 1, id: 1 is given to two agents");
    refused("/agents/1/id", json!(2.5), "agent at place 2, id: 2.5 where a whole number from 0 or a name is expected");
    let digits =
        "agent at place 2, id: \"12\" could be taken for the number; write it without quotation marks, or give a name";
    refused("/agents/1/id", json!("12"), digits);
    let long = "agent at place 2, id: has 201 characters; allowed are up to 200";
    refused("/agents/1/id", json!("x".repeat(201)), long);
    let escape = "agent at place 2, id: has the control character \\u{1b}; allowed is printable text";
    refused("/agents/1/id", json!("a\u{1b}b"), escape);
    refused("/agents/1/start/x", json!("0"), "agent 2, start.x: \"0\" where a number is expected");
    refused(
        "/agents/1/path/0/kind",
        json!("spiral"),
        "agent 2, segment 1, kind: \"spiral\"; allowed is \"line\", \"arc\", \"turn\" or \"kink\"",
    );
    refused("/agents/1/path", json!(null), "agent 2, path: null where an array is expected");
    refused("/agents", json!("all"), "agents: \"all\" where an array is expected");
}

#[test]
fn numbers_that_are_not_numbers() {
    for word in ["NaN", "Infinity", "-inf", "1e999"] {
        let text = crossing().to_string().replacen("0.25", word, 1);
        assert!(text.contains(word));
        let column = text.find(word).unwrap() + 1;
        let expected = format!("1:{column}: agent 1, radius: {word} is out of range; allowed is above 0, up to 1e10");
        assert_eq!(message(text, &[]), expected);
    }
}

#[test]
fn lines_of_the_file_are_named() {
    let text = serde_json::to_string_pretty(&crossing()).unwrap().replacen("\"heading\": 0.0", "\"heading\": true", 1);
    let line = 1 + text.lines().position(|line| line.contains("true")).unwrap();
    assert!(line > 5);
    let column = 1 + text.lines().nth(line - 1).unwrap().find("true").unwrap();
    let expected = format!("{line}:{column}: agent 1, start.heading: true where a number is expected");
    assert_eq!(message(&text, &[]), expected);
    assert_eq!(message(text.replace('\n', "\r\n"), &[]), expected);
    let broken = text.replacen("true", "true false", 1);
    let column = 2 + broken.lines().nth(line - 1).unwrap().find(" false").unwrap();
    assert_eq!(message(broken, &[]), format!("{line}:{column}: false where `,` or `}}` is expected"));
}

#[test]
fn texts_that_are_no_scenario() {
    assert_eq!(message("", &[]), "empty; a scenario is expected");
    assert_eq!(message("\u{feff}", &[]), "empty; a scenario is expected");
    assert_eq!(message("[]", &[]), "1:1: an array where an object is expected");
    assert_eq!(message("{}", &[]), "1:1: agents: missing");
    assert_eq!(message("{\"agents\": [", &[]), "1:13: the text ends where a value is expected");
    assert_eq!(message("{\"agents\": [], \"agents\": []}", &[]), "1:26: agents: given twice");
    assert_eq!(message("[".repeat(1_000_000), &[]), "1:65: arrays and objects nested more than 64 deep");
    assert_eq!(message(b"{\"agents\": \xff}", &[]), "not text in UTF-8");
    let unknown = "no scenario, which is a JSON object, nor another format that is known by its name or content; say what it is with --from";
    assert_eq!(message("\0\u{1}\u{2}", &[]), unknown);
    assert_eq!(message("# A title", &[]), unknown);
    let lines = format!("{}\n{}\n", crossing(), crossing());
    let expected = "2:1: more text after the end of the scenario (pcr check and pcr regions read several on standard input, each on a line of its own)";
    assert_eq!(message(lines, &[]), expected);
}

#[test]
fn profiles_that_do_not_fit() {
    let refused = |accel: f64, pointer: &str, expected: &str| {
        let mut scenario = crossing();
        let pieces = json!([{ "duration": 3.0, "accel": accel }]);
        scenario["agents"][1]["profile"] = json!({ "v0": 1.0, "pieces": pieces });
        let expected = format!("1:{}: agent 2, {expected}", column(&scenario, pointer));
        assert_eq!(message(scenario.to_string(), &[]), expected);
    };
    refused(
        0.0,
        "/agents/1/profile",
        "profile: travels 3 m on a path of 4 m; allowed is a relative difference of 9.54e-7",
    );
    refused(
        -1.0,
        "/agents/1/profile/pieces/0/accel",
        "profile piece 1, accel: -1 brings the speed to -2 m/s; allowed is 0 and above",
    );
}

#[test]
fn values_that_f32_cannot_hold() {
    let in_f32 = |pointer: &str, value: f64| {
        let mut scenario = crossing();
        *scenario.pointer_mut(pointer).unwrap() = json!(value);
        message(scenario.to_string(), &["--scalar", "f32"])
    };
    let message = in_f32("/agents/0/start/y", 1e9);
    assert_eq!(message, "agent 1, start.y: 1e9 is out of range; allowed is up to 1e6 in magnitude (f32)");
    let message = in_f32("/agents/1/radius", 1e-60);
    assert_eq!(message, "agent 2, radius: 1e-60 is out of range; it is so small that it becomes 0 (f32)");
    let message = in_f32("/agents/1/v_max", 1e-7);
    assert!(message.starts_with("agent 2, the motion takes 4"), "{message}");
}

#[test]
fn the_least_radius_of_f64_is_not_0() {
    let mut scenario = crossing();
    scenario["agents"][1]["radius"] = json!(1e-320);
    assert!(message(scenario.to_string(), &[]).ends_with("radius is out of range; the least is 1e-75 (f64)"));
}

#[test]
fn files_that_cannot_be_read() {
    let directory = directory("unreadable").to_str().unwrap().to_owned();
    let missing = format!("{directory}/missing.json");
    let failed = run(&["regions", &missing]).failed(2);
    assert!(failed.starts_with(&format!("pcr: {missing}: cannot be read: ")), "{failed}");
    let failed = run(&["regions", &directory]).failed(2);
    assert!(failed.starts_with(&format!("pcr: {directory}: cannot be read: ")), "{failed}");
    let failed = run(&["map", &missing, "-o", &directory]).failed(2);
    assert!(failed.starts_with(&format!("pcr: {missing}: cannot be read: ")), "{failed}");
}

#[test]
fn agents_that_are_not_there() {
    let message = run(&["regions", PAPER, "--agent", "13"]).failed(2);
    assert_eq!(message, format!("pcr: {PAPER}: no agent 13; there are 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12\n"));
    let file = file("refused", "nobody.json", "{\"agents\": []}");
    assert_eq!(
        run(&["regions", &file, "--agent", "1"]).failed(2),
        format!("pcr: {file}: no agent 1; there are none\n")
    );
}

#[test]
fn wrong_arguments() {
    for arguments in [
        &["areas"][..],
        &["regions", "--format", "xml"],
        &["regions", "--slices", "-1", "--format", "json"],
        &["regions", "--slices", "10001", "--format", "json"],
        &["regions", "--scalar", "f16"],
        &["map"],
        &["--scalar", "f32"],
    ] {
        let run = run(arguments);
        assert_eq!((run.status, run.out.as_str()), (2, ""), "{arguments:?}");
        assert!(run.err.starts_with("error: ") && run.err.contains("--help"), "{arguments:?}: {}", run.err);
    }
    let negative = run(&["check", PAPER, "--radius", "-1"]).err;
    let range = "invalid value '-1' for '--radius <M>': a number from 1e-6 to 1e6 is expected";
    assert!(negative.contains(range), "{negative}");
    for arguments in [&["regions", PAPER, "--agent", ""][..], &["map", PAPER, "--agent", "", "-o", "nowhere"]] {
        let empty = run(arguments);
        assert!(empty.status == 2 && empty.err.contains("a value is required for '--agent <"), "{}", empty.err);
    }
    let message = run(&["regions", PAPER, "--slices", "3"]).failed(2);
    assert_eq!(message, "pcr: --slices is for --format json\n");
}

#[test]
fn directories_that_cannot_be_written() {
    let blocked = format!("{}/pictures", file("unwritable", "file", ""));
    let scenario = file("unwritable", "none.json", "{\"agents\": []}");
    let failed = run(&["map", &scenario, "-o", &blocked]).failed(3);
    assert!(failed.starts_with(&format!("pcr: {blocked}: cannot be written: ")), "{failed}");
}

#[test]
fn standard_output_is_no_folder() {
    let layout = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/data/real/nav2/aws_graph.geojson");
    for arguments in [
        &["map", PAPER, "-o", "-"][..],
        &["locks", layout, "-o", "-"],
        &["locks", layout, "--audit", "-o", "-"],
        &["locks", layout, "--index", "-"],
        &["traffic", layout, "-o", "-"],
        &["compare", PAPER, "-o", "-"],
        &["demo", "-o", "-"],
        &["plan", PAPER, "--pictures", "-"],
    ] {
        let run = run(arguments);
        assert_eq!((run.status, run.out.as_str()), (2, ""), "{arguments:?}");
        assert!(run.err.contains("standard output") && run.err.contains("is ./-"), "{arguments:?}: {}", run.err);
    }
}

#[test]
fn help_has_examples_and_exit_statuses() {
    for (arguments, example) in [
        (&["regions", "--help"][..], "pcr regions - --format json < fleets.jsonl"),
        (&["map", "--help"], "pcr map fleet.json -o pictures"),
    ] {
        let help = run(arguments).ok();
        assert!(help.contains("Examples:\n") && help.contains(example), "{help}");
        assert!(help.contains("Exit status:\n  0  done\n  2  ") && help.contains("\n  3  "), "{help}");
    }
    let all = run(&["--help"]).ok();
    let statuses = all.split_once("Exit status:\n").unwrap().1;
    assert!((0..5).all(|status| statuses.contains(&format!("  {status}  "))), "{all}");
    for (command, wrong) in [
        ("nodes", "wrong arguments, or a layout that"),
        ("import", "wrong arguments, or a file that"),
        ("demo", "wrong arguments\n"),
        ("completions", "wrong arguments\n"),
        ("man", "wrong arguments\n"),
    ] {
        let help = run(&[command, "--help"]).ok();
        assert!(help.contains(&format!("Exit status:\n  0  done\n  2  {wrong}")), "{help}");
    }
    assert_eq!(run(&["--version"]).ok(), format!("pcr {}\n", env!("CARGO_PKG_VERSION")));
}

#[test]
fn more_scenarios_than_one_say_who_reads_them() {
    let expected = "more text after the end of the scenario (pcr check and pcr regions read several on standard input, each on a line";
    for command in ["check", "plan"] {
        let message = run_with(&[command], b"{\"agents\":[]} {\"agents\":[]}");
        assert!(message.status == 2 && message.err.contains(expected), "{command}: {}", message.err);
    }
}

#[test]
fn times_that_are_none_are_refused_in_plain_words() {
    for time in ["nan", "-1", "soon"] {
        let refused = run(&["plan", PAPER, "--prove", "--time-limit", time]);
        assert!(
            refused.status == 2 && refused.err.contains("a number of seconds from 0 is expected"),
            "{}",
            refused.err
        );
    }
}

/// Every option that takes a number or a choice says which.
#[test]
fn numbers_and_choices_of_options_say_what_is_expected() {
    let layout = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/data/real/nav2/sample_graph.geojson");
    for (arguments, expected) in [
        (&["traffic", layout, "--agents", "ten"][..], "a whole number from 1 to 65535 is expected"),
        (&["traffic", layout, "--agents", "65536"], "a whole number from 1 to 65535 is expected"),
        (&["traffic", layout, "--agents", "0"], "a whole number from 1 to 65535 is expected"),
        (&["traffic", layout, "--seed", "x"], "a whole number from 0 is expected"),
        (&["traffic", layout, "--hours", "all"], "a number above 0 and up to 168 is expected"),
        (&["regions", PAPER, "--slices", "2.5"], "a whole number from 0 to 10000 is expected"),
        (&["simulate", PAPER, "--trips", "many"], "a whole number from 1 to 1000 is expected"),
        (&["simulate", PAPER, "--noise", "much"], "a number from 0 to 10 is expected"),
        (&["compare", PAPER, "--rounds", "1001"], "a whole number from 1 to 1000 is expected"),
        (&["locks", layout, "--radius", "wide"], "a number from 1e-6 to 1e6 is expected"),
        (&["locks", layout, "--corner-radius", "-1"], "a number from 0 to 1e6 is expected"),
        (&["locks", layout, "--graph", "first"], "a whole number from 0 is expected"),
        (&["locks", layout, "--split", "0"], "a number above 0, up to 1e6, is expected"),
        (&["plan", PAPER, "--time-limit", "soon"], "a number of seconds from 0 is expected"),
        (&["fleet", "--streets", "1"], "a whole number from 2 to 100 is expected"),
        (&["fleet", "--pace", "fast"], "a number from 0.1 to 100 is expected"),
        (&["fleet", "--vehicles", "-2"], "a whole number from 0 is expected"),
        (&["serve", "--silence", "long"], "a number from 0.1 to 86400 is expected"),
        (&["check", PAPER, "--scalar", "f16"], "[possible values: f64, f32"),
        (&["plan", PAPER, "--method", "luck"], "[possible values: delay, speed]"),
        (&["plan", PAPER, "--objective", "fun"], "[possible values: sum, makespan]"),
        (&["check", PAPER, "--format", "xml"], "[possible values: "),
        (&["import", "dxf", layout], "[possible values: nav2, lif"),
        (&["check", PAPER, "--from", "dxf"], "[possible values: nav2, lif"),
        (&["locks", layout, "--write", "dxf", "-o", "-"], "[possible values: nav2"),
        (&["simulate", PAPER, "--controller", "none"], "pcr, potential"),
    ] {
        let refused = run(arguments);
        assert_eq!((refused.status, refused.out.as_str()), (2, ""), "{arguments:?}");
        assert!(refused.err.contains(expected), "{arguments:?}: {}", refused.err);
        assert!(!refused.err.contains("invalid digit") && !refused.err.contains("invalid float"), "{}", refused.err);
    }
}
