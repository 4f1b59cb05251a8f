//! Where scenarios come from: files, several of them, standard input; and never anything that was not asked for.

use crate::fixture::{PAPER, crossing, directory, file, run, run_with, straight};
use serde_json::{Value, json};

fn free() -> Value {
    let mut scenario = crossing();
    scenario["agents"][1]["t_start"] = json!(9.0);
    scenario
}

#[test]
fn standard_input_is_read_where_no_file_is_named() {
    assert_eq!(run_with(&["check"], b"{\"agents\":[]}\n").ok(), "scenario: no conflicts, 0 agents\n");
    let pretty = serde_json::to_string_pretty(&crossing()).unwrap();
    for arguments in [&["check"][..], &["check", "-"]] {
        let found = run_with(arguments, pretty.as_bytes());
        assert_eq!(found.status, 1, "{}", found.err);
        assert!(found.out.starts_with("crossing: 1 conflict\n"), "{}", found.out);
    }
    for command in ["regions", "plan", "simulate"] {
        let answer = run_with(&[command, "--json"], pretty.as_bytes());
        assert_eq!(answer.status, 0, "{command}: {}", answer.err);
        assert!(answer.out.contains("\"name\":\"crossing\""), "{command}: {}", answer.out);
    }
}

#[test]
fn nothing_is_not_the_demo() {
    for command in ["regions", "check", "plan", "simulate", "compare", "map", "locks", "traffic", "nodes", "import"] {
        let format: &[&str] = if command == "import" { &["nav2"] } else { &[] };
        let output: &[&str] = if command == "map" { &["-o", "nowhere"] } else { &[] };
        // As `pcr check $EMPTY` and `pcr check "$EMPTY"` in a script.
        let message = run(&[&[command], format, output].concat()).failed(2);
        assert!(message.starts_with("pcr: standard input:") && message.contains("empty"), "{command}: {message}");
        let empty = run(&[&[command], format, &[""], output].concat());
        assert_eq!((empty.status, empty.out.as_str()), (2, ""), "{command}");
        assert!(empty.err.starts_with("error: a value is required for '["), "{command}: {}", empty.err);
    }
}

/// Without the end of a pipe a terminal would wait for somebody to type a scenario.
#[cfg(target_os = "linux")]
#[test]
fn a_terminal_is_not_waited_for() {
    let pcr = env!("CARGO_BIN_EXE_pcr");
    let command = format!("{pcr} check; echo \"status $?\"");
    let output = std::process::Command::new("script").args(["-qec", &command, "/dev/null"]).output();
    let Ok(output) = output else { panic!("script (util-linux) is needed for this test") };
    let text = String::from_utf8_lossy(&output.stdout);
    assert!(text.contains("pcr: no FILE, and nothing comes in by a pipe") && text.contains("status 2"), "{text}");
    assert!(text.contains("name a scenario"), "{text}");
    for command in ["locks", "nodes", "traffic", "import nav2"] {
        let command = format!("{pcr} {command}");
        let output = std::process::Command::new("script").args(["-qec", &command, "/dev/null"]).output().unwrap();
        let text = String::from_utf8_lossy(&output.stdout);
        assert!(text.contains("docs/reference/layouts.md") && !text.contains("scenario"), "{text}");
    }
}

#[test]
fn the_demo_is_asked_for_by_name() {
    let scenario = run(&["demo", "--scenario"]).ok();
    assert_eq!(scenario, std::fs::read_to_string(PAPER).unwrap());
    assert!(run_with(&["check"], scenario.as_bytes()).out.starts_with("paper12: 9 conflicts\n"));
    let folder = directory("demo").join("pictures");
    let tables = run(&["demo", "-o", folder.to_str().unwrap()]).ok();
    assert!(tables.starts_with("Table V: ") && tables.contains("Pictures: "), "{tables}");
    assert!(folder.join("index.html").exists());
}

#[test]
fn several_files_are_answered_one_after_the_other() {
    let [a, b] = [("one", crossing()), ("two", free())].map(|(name, mut scenario)| {
        scenario["name"] = json!(name);
        file("several-files", &format!("{name}.json"), scenario.to_string())
    });
    let both = run(&["check", &a, &b, "--json"]);
    assert_eq!((both.status, both.err.as_str()), (1, ""));
    let names: Vec<Value> =
        both.out.lines().map(|line| serde_json::from_str::<Value>(line).unwrap()["name"].clone()).collect();
    assert_eq!(names, ["one", "two"]);
    let table = run(&["regions", &a, &b]).ok();
    assert!(table.contains("one: 2 collision regions") && table.contains("\n\ntwo: 2 collision regions"), "{table}");
    let plans = run(&["plan", &a, &b, "--format", "csv"]).ok();
    assert_eq!(plans.matches("\none,").count() + plans.matches("\ntwo,").count(), 4, "{plans}");
    let piped = run_with(&["check", &b, "-"], crossing().to_string().as_bytes());
    assert_eq!(
        (piped.status, piped.out.contains("two: no conflicts"), piped.out.contains("crossing: 1")),
        (1, true, true)
    );
    // One that is refused costs no other one.
    let bad = file("several-files", "bad.json", "{}");
    let run = run(&["check", &bad, &b, "--json"]);
    assert_eq!(run.status, 2);
    let answers: Vec<Value> = run.out.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert!(answers[0]["error"].as_str().unwrap().contains("bad.json:1:1: agents: missing"), "{}", run.out);
    assert_eq!(
        (&answers[0]["name"], &answers[1]["name"], &answers[1]["error"]),
        (&json!("bad"), &json!("two"), &Value::Null)
    );
    assert!(run.err.ends_with("pcr: 1 of 2 scenarios refused\n"), "{}", run.err);
}

#[test]
fn answers_of_one_name_are_told_apart_by_their_files() {
    let [a, b] = ["a", "b"].map(|folder| file(&format!("same-name/{folder}"), "f.json", crossing().to_string()));
    let other = file("same-name", "other.json", free().to_string().replace("crossing", "other"));
    let names = |command: &str| -> Vec<Value> {
        let answers = run(&[command, &a, &other, &b, "--json"]).out;
        answers.lines().map(|line| serde_json::from_str::<Value>(line).unwrap()["name"].clone()).collect()
    };
    for command in ["check", "regions", "plan"] {
        assert_eq!(names(command), [json!(a), json!("other"), json!(b)], "{command}");
    }
    let written = run(&["plan", &a, &b, "-q", "-o", "-"]).ok();
    assert_eq!(written.matches("\"name\": \"crossing\"").count(), 2, "{written}");
}

/// What is looked at before it is read would be gone.
#[cfg(target_os = "linux")]
#[test]
fn pipes_are_read_once() {
    let scenario = file("pipes", "crossing.json", crossing().to_string());
    let layout = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/data/real/nav2/warehouse_graph.geojson");
    for command in [
        format!("check -q <(cat {scenario}) {scenario}"),
        format!("locks --json -q --radius 0.4 <(cat {layout}) | grep -q pcr-locks; exit $((1 - $?))"),
        format!("certify --json -q --radius 0.4 <(cat {layout}) | grep -q proved; exit $((1 - $?))"),
        format!("certify --json -q --radius 0.4 < {layout} | grep -q proved; exit $((1 - $?))"),
        format!("certify --json -q <(cat {scenario}) | grep -q proved; exit $((1 - $?))"),
        format!("locks -q --radius 0.4 --write nav2 <(cat {layout}) -o - | grep -q Feature; exit $((1 - $?))"),
        format!("locks -q --radius 0.4 --audit <(cat {layout})"),
        format!("locks -q --radius 0.4 --audit - < {layout}"),
    ] {
        let line = format!("{} {command}", env!("CARGO_BIN_EXE_pcr"));
        let output = std::process::Command::new("bash").args(["-c", &line]).output().unwrap();
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!((output.status.code(), &*said), (Some(1), ""), "{command}");
    }
}

#[test]
fn plans_go_through_a_pipe() {
    let input = file("pipe", "crossing.json", crossing().to_string());
    let plan = run(&["plan", &input, "-o", "-"]);
    assert_eq!(plan.status, 0);
    assert!(plan.err.starts_with("crossing: a plan without conflicts"), "the table is on standard error: {}", plan.err);
    for arguments in [&["check", "-"][..], &["check"]] {
        assert_eq!(run_with(arguments, plan.out.as_bytes()).ok(), "crossing: no conflicts, 2 agents\n");
    }
    let quiet = run(&["plan", &input, "-o", "-", "-q"]);
    assert_eq!((quiet.err.as_str(), quiet.out), ("", plan.out));
    let page = run(&["simulate", &input, "--controller", "pcr", "-o", "-"]);
    assert!(page.out.starts_with("<!DOCTYPE html>") && page.err.starts_with("crossing: seed 1"));
    let two = run(&["plan", &input, &input, "-o", "somewhere.json"]).failed(2);
    assert_eq!(two, "pcr: --output: one file for the plans of several; - takes them all\n");
    // Without a plan nothing goes through, and nothing is no scenario.
    let stuck = json!({ "agents": [straight(1, [0.0, 0.0, 0.0], 4.0), straight(2, [0.1, 0.0, 0.0], 4.0)] });
    let stuck = run_with(&["plan", "-o", "-"], stuck.to_string().as_bytes());
    assert_eq!((stuck.status, stuck.out.as_str()), (1, ""));
    assert_eq!(run_with(&["check"], stuck.out.as_bytes()).status, 2);
}

#[test]
fn orders_of_a_fleet_are_checked_against_one_another() {
    let order = |id: &str, y: f64| {
        let node = |x: f64| {
            json!({ "nodeId": format!("{id}{x}"), "sequenceId": (x / 2.0) as u32, "released": true, "actions": [],
            "nodePosition": { "x": x, "y": y, "mapId": "m" } })
        };
        let edge = json!({ "edgeId": "e", "sequenceId": 1, "released": true, "actions": [] });
        let order = json!({ "orderId": id, "nodes": [node(0.0), node(4.0)], "edges": [edge] });
        file("fleet", &format!("{id}.json"), order.to_string())
    };
    let (a, b) = (order("a", 0.0), order("b", 0.1));
    let check = run(&["check", &a, &b, "--radius", "0.3", "--json", "-q"]);
    assert_eq!((check.status, check.out.lines().count(), check.err.as_str()), (1, 1, ""), "{}", check.out);
}

#[test]
fn plans_of_several_files_have_an_answer_each() {
    let good = file("several-plans", "good.json", crossing().to_string());
    let run = run(&["plan", "nowhere.json", &good, "--json"]);
    assert_eq!(run.status, 2);
    let answers: Vec<Value> = run.out.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert_eq!((&answers[0]["format"], &answers[0]["name"]), (&json!("pcr-plan"), &json!("nowhere")));
    assert!(answers[0]["error"].as_str().unwrap().contains("nowhere.json: cannot be read"), "{}", run.out);
    assert_eq!((&answers[1]["name"], &answers[1]["error"]), (&json!("crossing"), &Value::Null));
}

/// A file without a plan was not in the stream, and the others were free.
#[test]
fn a_file_that_is_refused_is_not_missing_in_a_stream_of_plans() {
    let good = file("refused-plans", "good.json", crossing().to_string());
    let broken = file("refused-plans", "broken.json", "{");
    let plans = run(&["plan", &good, &broken, "nowhere.json", "-q", "-o", "-"]);
    assert_eq!(plans.status, 2);
    let checked = run_with(&["check", "--json", "-q"], plans.out.as_bytes());
    assert_eq!(checked.status, 2);
    let answers: Vec<Value> = checked.out.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let said: Vec<_> =
        answers.iter().map(|answer| (answer["name"].as_str().unwrap(), answer["error"].as_str())).collect();
    assert_eq!((said.len(), said[0]), (3, ("crossing", None)));
    assert!(said[1].0 == "broken" && said[1].1.unwrap().contains("broken.json:1:2: "), "{said:?}");
    assert!(said[2].0 == "nowhere" && said[2].1.unwrap().contains("nowhere.json: cannot be read"), "{said:?}");
}

#[test]
fn what_was_left_out_is_told_by_all_that_is_made_of_it() {
    let mut scenario = free();
    let many = format!("{}: left out", vec!["edge"; 1000].join(", "));
    scenario["warnings"] = json!(["edge 7 was dropped", many]);
    let name = file("told-again", "imported.json", scenario.to_string());
    let pictures = directory("told-again").join("pictures");
    let pictures = pictures.to_str().unwrap();
    for (arguments, status) in [
        (&["check", &name][..], 0),
        (&["regions", &name], 0),
        (&["plan", &name], 0),
        (&["map", &name, "-o", pictures], 0),
        (&["simulate", &name, "--controller", "pcr"], 0),
        (&["certify", &name], 0),
    ] {
        let told = run(arguments);
        assert_eq!(told.status, status, "{arguments:?}: {}", told.err);
        let lines: Vec<&str> = told.err.lines().collect();
        assert_eq!(lines[0], format!("pcr: warning: {name}: edge 7 was dropped [uncoded]"), "{arguments:?}");
        assert!(
            lines[1].len() < 500 && lines[1].ends_with(", edge: left out [uncoded]"),
            "{arguments:?}: {}",
            lines[1]
        );
        assert_eq!(lines.len(), 2, "{arguments:?}: {}", told.err);
        assert_eq!(run(&[arguments, &["-q"]].concat()).err, "", "{arguments:?}");
    }
    let piped = run_with(&["check"], scenario.to_string().as_bytes());
    assert_eq!(piped.err.lines().next(), Some("pcr: warning: standard input: line 1: edge 7 was dropped [uncoded]"));
}
