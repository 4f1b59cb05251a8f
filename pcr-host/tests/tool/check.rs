//! `pcr check`: verdicts, exit statuses, refusals.

use crate::fixture::{PAPER, Run, column, crossing, file, run, run_with, straight};
use serde_json::{Value, json};
use std::sync::atomic::{AtomicUsize, Ordering};

/// Agent 2 crosses long after agent 1.
fn free() -> Value {
    let mut scenario = crossing();
    scenario["agents"][1]["t_start"] = json!(3.0);
    scenario
}

fn check(scenario: &Value, arguments: &[&str]) -> Run {
    // Tests run side by side.
    static FILES: AtomicUsize = AtomicUsize::new(0);
    let name = format!("{}.json", FILES.fetch_add(1, Ordering::Relaxed));
    let file = file("check", &name, scenario.to_string());
    run(&[&["check", &file], arguments].concat())
}

#[test]
fn a_crossing_at_the_same_time_is_a_conflict() {
    // Symmetric: both are in the middle at 2.5 s, and x before it at a separation of x √2.
    let run = check(&crossing(), &["--format", "json", "--closest"]);
    assert_eq!((run.status, run.err.as_str()), (1, ""));
    let verdict: Value = serde_json::from_str(&run.out).unwrap();
    assert!(
        run.out
            .starts_with(r#"{"format":"pcr-conflicts","version":2,"name":"crossing","conflicts":[{"i":1,"j":2,"t":["#),
        "{}",
        run.out
    );
    let [conflict] = &verdict["conflicts"].as_array().unwrap()[..] else { panic!("{verdict}") };
    let near = |value: &Value, exact: f64| (value.as_f64().unwrap() - exact).abs() < 1e-9;
    let half = 0.125_f64.sqrt();
    assert!(near(&conflict["depth"], 0.5) && conflict["touching"] == json!(false), "{conflict}");
    for (end, sign) in [(0, -1.0), (1, 1.0)] {
        assert!(near(&conflict["t"][end], 2.5 + sign * half), "{conflict}");
        assert!(near(&conflict["l_i"][end], 2.0 + sign * half) && near(&conflict["l_j"][end], 2.0 + sign * half));
    }
    let [closest] = &verdict["closest"].as_array().unwrap()[..] else { panic!("{verdict}") };
    assert!(near(&closest["t"], 2.5) && near(&closest["separation"], 0.0) && near(&closest["clearance"], -0.5));
    assert_eq!(verdict["error"], Value::Null);
}

#[test]
fn nobody_is_near_an_agent_alone() {
    let alone = json!({ "name": "alone", "agents": [crossing()["agents"][0]] });
    assert_eq!(check(&alone, &["--closest"]).out, "alone: no conflicts, 1 agent\n");
}

#[test]
fn a_plan_without_conflicts_is_free() {
    let run = check(&free(), &["--format", "json"]);
    assert_eq!(
        run.json(),
        json!({ "format": "pcr-conflicts", "version": 2, "name": "crossing", "conflicts": [], "error": null, "warnings": [] })
    );
    assert_eq!(check(&free(), &[]).ok(), "crossing: no conflicts, 2 agents\n");
    assert_eq!(check(&free(), &["--format", "csv"]).ok().lines().count(), 1);
}

#[test]
fn agents_stand_where_others_come_by() {
    // Agent 9 stands in the way of agent 3, which sets off long before it "arrives".
    let stands = json!({ "id": 9, "radius": 0.25, "v_max": 1.0, "a_max": 1.0, "t_start": 50.0,
                         "start": { "x": 0.0, "y": 0.2, "heading": 0.0 }, "path": [] });
    let scenario = json!({ "agents": [stands, straight(3, [-2.0, 0.0, 0.0], 4.0)] });
    let run = check(&scenario, &["--format", "json"]);
    assert_eq!(run.status, 1);
    let verdict: Value = serde_json::from_str(&run.out).unwrap();
    let conflict = &verdict["conflicts"][0];
    assert_eq!((&conflict["i"], &conflict["j"], &conflict["l_j"]), (&json!(3), &json!(9), &json!([0.0, 0.0])));
    assert!((conflict["depth"].as_f64().unwrap() - 0.3).abs() < 1e-9);
}

#[test]
fn tables_and_csv_say_the_same() {
    let table = check(&crossing(), &["--closest"]);
    assert_eq!(table.status, 1);
    assert!(table.out.starts_with("crossing: 1 conflict\n") && table.out.contains("  2.146    2.854      0.500"));
    assert!(table.out.contains("\nNearest to one another:\n"), "{}", table.out);
    let csv = check(&crossing(), &["--format", "csv", "--scalar", "f32"]);
    let lines: Vec<&str> = csv.out.lines().collect();
    assert_eq!((csv.status, lines.len()), (1, 2));
    assert_eq!(lines[0], "name,i,j,t_a,t_b,depth,l_i_a,l_i_b,l_j_a,l_j_b,touching,i_label,j_label");
    assert!(lines[1].starts_with("crossing,1,2,2.14") && lines[1].ends_with(",0,,"), "{}", lines[1]);
}

/// A format holds the radius and the length of an arc, not its sweep: a radius of one last digit of `q12` gives another sweep.
#[test]
fn how_far_rounding_to_a_format_moves_agents_is_told() {
    let path = json!([{ "kind": "arc", "radius": 0.0002, "sweep": 4.34 }, { "kind": "line", "length": 6 }]);
    let heading = 4.34_f64;
    let moving = json!({ "id": 1, "radius": 0.1, "v_max": 1, "a_max": 1, "start": { "x": 0, "y": 0, "heading": 0 }, "path": path });
    let [x, y] = [6.0 * heading.cos(), 6.0 * heading.sin()];
    let standing = json!({ "id": 2, "radius": 0.1, "v_max": 1, "a_max": 1, "start": { "x": x, "y": y, "heading": 0 }, "path": [] });
    let scenario = json!({ "agents": [moving, standing] });
    let exact = check(&scenario, &["--format", "json"]).json_of(1);
    assert_eq!(exact["warnings"], json!([]));
    let rounded = check(&scenario, &["--format", "json", "--scalar", "q12"]);
    assert_eq!(rounded.status, 0);
    let warning = "rounding to q12 moves 1 of 2 agents by more than 1 mm; agent 1 is up to ";
    assert!(rounded.err.contains(warning), "{}", rounded.err);
    let answer: Value = serde_json::from_str(&rounded.out).unwrap();
    let told =
        answer["warnings"][0].as_str().and_then(|told| told.strip_prefix(warning)).unwrap().split(' ').next().unwrap();
    assert!((2.0..4.0).contains(&told.parse::<f64>().unwrap()), "{told}");
}

#[test]
fn the_papers_agents_collide_without_a_plan() {
    let run = run(&["check", PAPER, "--format", "json"]);
    assert_eq!(run.status, 1);
    let verdict: Value = serde_json::from_str(&run.out).unwrap();
    let conflicts = verdict["conflicts"].as_array().unwrap();
    let begins: Vec<f64> = conflicts.iter().map(|conflict| conflict["t"][0].as_f64().unwrap()).collect();
    assert!(conflicts.len() == 9 && begins.is_sorted(), "{begins:?}");
    assert!(conflicts.iter().all(|conflict| conflict["i"].as_u64() < conflict["j"].as_u64()));
}

#[test]
fn lines_are_answered_in_their_place() {
    let mut bad = crossing();
    bad["agents"][0]["radius"] = json!(-1);
    let input = format!("{}\n{bad}\n{}\n", crossing(), free());
    let run = run_with(&["check", "-", "--format", "json"], input.as_bytes());
    assert_eq!((run.status, run.err.as_str()), (2, "pcr: standard input: 1 of 3 scenarios refused\n"));
    let answers: Vec<Value> = run.out.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let counts: Vec<usize> = answers.iter().map(|answer| answer["conflicts"].as_array().unwrap().len()).collect();
    assert_eq!(counts, [1, 0, 0]);
    let expected = format!("line 2, column {}: agent 1, radius: -1 is out of range", column(&bad, "/agents/0/radius"));
    assert!(answers[1]["error"].as_str().unwrap().starts_with(&expected));
    let run = run_with(&["check", "-", "--format", "json"], format!("{}\n{}", free(), crossing()).as_bytes());
    assert_eq!(run.status, 1);
}

#[test]
fn what_is_refused() {
    let message = run(&["check", PAPER, "--closest", "--format", "csv"]).failed(2);
    assert_eq!(message, "pcr: --closest is for --format json and table\n");
    assert!(check(&json!({ "agents": 3 }), &[]).failed(2).contains("agents"));
    let help = run(&["check", "--help"]).ok();
    assert!(help.contains("pcr check - --format json < plans.jsonl") && help.contains("  1  conflicts;"), "{help}");
    let empty = check(&json!({ "agents": [] }), &["--format", "json", "--closest"]);
    let empty = empty.json();
    // A file without a name in it answers by its own.
    assert!(empty["name"].as_str().is_some_and(|name| !name.is_empty()));
    assert_eq!(
        empty,
        json!({ "format": "pcr-conflicts", "version": 2, "name": empty["name"], "conflicts": [], "closest": [], "error": null, "warnings": [] })
    );
}

#[test]
fn a_contact_that_was_proved_is_told_as_in_the_table() {
    let mut scenario = crossing();
    scenario["agents"][0]["label"] = json!("AGV-7");
    let name = file("check", "certified.json", scenario.to_string());
    let table = run(&["check", &name, "--certify"]).out;
    let line = table.lines().last().unwrap();
    let numbers =
        line.strip_prefix("certificate: contact, agents 1 AGV-7 and 2 at ").unwrap_or_else(|| panic!("{table}"));
    let [time, _, _, clearance, _] = numbers.split(' ').collect::<Vec<_>>()[..] else { panic!("{table}") };
    let decimals = |number: &str| number.split_once('.').map(|(_, behind)| behind.len());
    assert_eq!((decimals(time), decimals(clearance)), (Some(3), Some(3)), "{line}");
}

#[test]
fn nothing_is_proved_of_an_agent_alone() {
    let nothing = "there are no two agents of which contacts could be certified\n";
    for (name, agents) in [("one.json", json!([straight(1, [0.0; 3], 4.0)])), ("none.json", json!([]))] {
        let name = file("check", name, json!({ "agents": agents }).to_string());
        assert!(run(&["check", &name]).ok().contains("no conflicts"));
        assert!(run(&["check", &name, "--certify"]).failed(2).ends_with(nothing));
        assert!(run(&["certify", &name]).failed(2).ends_with(nothing));
    }
}
