//! `pcr plan`: a plan is a scenario that the check finds free.

use crate::fixture::{PAPER, crossing, directory, file, run, straight};
use serde_json::{Value, json};
use std::fs;
use std::path::Path;

/// The report of a plan, and the scenario it wrote.
fn plan(name: &str, scenario: &Value, arguments: &[&str]) -> (i32, Value, Option<String>) {
    let input = file("plan", &format!("{name}.json"), scenario.to_string());
    let output = directory("plan").join(format!("{name}-plan.json"));
    let _ = fs::remove_file(&output);
    let output = output.to_str().unwrap().to_owned();
    let run = run(&[&["plan", &input, "-o", &output, "--format", "json"], arguments].concat());
    assert_eq!(run.err, "");
    let written = Path::new(&output).exists().then_some(output);
    (run.status, serde_json::from_str(&run.out).unwrap(), written)
}

#[test]
fn a_crossing_is_resolved_by_the_delay_of_the_second() {
    let (status, report, written) = plan("crossing", &crossing(), &["--priority", "2"]);
    assert_eq!((status, &report["order"], &report["method"]), (0, &json!([2, 1]), &json!("delay")));
    let delays = [0, 1].map(|k| report["agents"][k]["delay"].as_f64().unwrap());
    // Both pass the crossing at 1 m/s, but the first begins to slow down a second after: a little more than R √2.
    assert!(delays[1] == 0.0 && (0.7..0.72).contains(&delays[0]), "{delays:?}");
    assert_eq!((&report["lower_bound"], &report["unsolved"]), (&json!(10.0), &json!([])));
    assert!((report["makespan"].as_f64().unwrap() - 5.0 - delays[0]).abs() < 1e-12);
    assert!((report["sum_of_costs"].as_f64().unwrap() - 10.0 - delays[0]).abs() < 1e-12);
    let free = run(&["check", &written.unwrap(), "--format", "json"]);
    assert_eq!(free.json()["conflicts"], json!([]));
}

#[test]
fn the_papers_agents_are_resolved_and_the_plan_is_free() {
    let output = directory("plan").join("paper12-plan.json").to_str().unwrap().to_owned();
    let table = run(&["plan", PAPER, "-o", &output]).ok();
    assert!(table.starts_with("paper12: a plan without conflicts, by start delays"), "{table}");
    assert!(table.lines().count() == 15 && table.contains("makespan"), "{table}");
    let check = run(&["check", &output]).ok();
    assert_eq!(check, "paper12: no conflicts\n");
    let csv = run(&["plan", PAPER, "--format", "csv"]).ok();
    assert!(csv.starts_with("name,id,delay,t_end,label\npaper12,1,") && csv.lines().count() == 13, "{csv}");
}

#[test]
fn speeds_are_planned_and_written_as_profiles() {
    // Behind the second at the crossing, in front of a third that passes its start.
    let agents = json!({ "agents": [
        straight(1, [0.0, 0.0, 0.0], 8.0),
        straight(2, [0.0, -1.2, std::f64::consts::FRAC_PI_2], 12.0),
        straight(3, [5.0, -5.0, std::f64::consts::FRAC_PI_2], 10.0)
    ] });
    let (status, report, written) = plan("speeds", &agents, &["--method", "speed", "--priority", "2,3,1"]);
    assert_eq!((status, &report["order"], &report["method"]), (0, &json!([2, 3, 1]), &json!("speed")));
    let written = written.unwrap();
    let scenario: Value = serde_json::from_str(&fs::read_to_string(&written).unwrap()).unwrap();
    assert!(scenario["agents"][0]["profile"]["pieces"].as_array().unwrap().len() > 3, "{scenario}");
    assert!(scenario["agents"][1]["v_max"].is_number(), "{scenario}");
    assert_eq!(run(&["check", &written, "--format", "json"]).json()["conflicts"], json!([]));
}

#[test]
fn what_cannot_work_is_named_and_nothing_is_written() {
    let head_on =
        json!({ "agents": [straight(4, [0.0, 0.0, 0.0], 4.0), straight(9, [4.0, 0.0, std::f64::consts::PI], 4.0)] });
    let (status, report, written) = plan("head-on", &head_on, &[]);
    assert_eq!((status, &report["agents"], written), (1, &json!([]), None));
    let unsolved = &report["unsolved"][0];
    assert_eq!(unsolved["ids"], json!([9, 4]));
    assert!(unsolved["why"].as_str().unwrap().contains("head-on without a passing place"), "{unsolved}");
}

#[test]
fn margins_are_kept() {
    let mut wide = crossing();
    wide["agents"][0]["margin"] = json!(0.1);
    let (_, near, _) = plan("near", &crossing(), &["--priority", "1,2"]);
    let (_, far, _) = plan("far", &wide, &["--priority", "1,2"]);
    let delay = |report: &Value| report["agents"][1]["delay"].as_f64().unwrap();
    assert!(delay(&far) > delay(&near) + 0.1, "{far} {near}");
}

#[test]
fn what_is_refused() {
    let input = file("plan", "refused.json", crossing().to_string());
    let message = run(&["plan", &input, "--priority", "3"]).failed(2);
    assert_eq!(message, format!("pcr: {input}: no agent 3; there are 1, 2\n"));
    for wrong in ["fast", "1,1", "1,,2", "-1"] {
        let run = run(&["plan", &input, &format!("--priority={wrong}")]);
        assert_eq!((run.status, run.out.as_str()), (2, ""), "{wrong}");
    }
    let blocked = format!("{}/plan.json", file("plan", "blocked", ""));
    let message = run(&["plan", &input, "-o", &blocked]).failed(3);
    assert!(message.starts_with(&format!("pcr: {blocked}: cannot be written: ")), "{message}");
    assert!(run(&["plan", "--help"]).ok().contains("  1  no plan\n"));
}

#[test]
fn agents_that_wait_for_one_another_in_a_circle_are_named() {
    // Each goes to the start of the next one, around a triangle of 0.5 m that is too small to go round in.
    let side = |id: u64, turn: f64| {
        let heading = std::f64::consts::TAU / 3.0 * turn;
        let (sin, cos) = (heading - std::f64::consts::FRAC_PI_2 - std::f64::consts::FRAC_PI_3).sin_cos();
        let radius = 0.5 / 3.0_f64.sqrt();
        json!({ "id": id, "radius": 0.2, "v_max": 1.0, "a_max": 1.0,
            "start": { "x": radius * cos, "y": radius * sin, "heading": heading },
            "path": [{ "kind": "line", "length": 0.5 }] })
    };
    let agents = json!({ "agents": [side(1, 0.0), side(2, 1.0), side(3, 2.0)] });
    for method in ["delay", "speed"] {
        let (status, report, written) = plan(&format!("circle-{method}"), &agents, &["--method", method]);
        assert_eq!((status, written, &report["unsolved"][0]["ids"]), (1, None, &json!([1, 2, 3])), "{report}");
        assert!(report["unsolved"][0]["why"].as_str().unwrap().contains("the last one the first"), "{report}");
    }
    // Two of them are no circle.
    let agents = json!({ "agents": [side(1, 0.0), side(2, 1.0)] });
    assert_eq!(plan("no-circle", &agents, &[]).0, 0);
}

#[test]
fn the_maps_before_and_after_are_drawn_beside_the_report() {
    let input = file("plan", "drawn.json", crossing().to_string());
    let pictures = directory("plan").join("maps");
    let drawn = run(&["plan", &input, "--pictures", pictures.to_str().unwrap(), "--format", "json"]);
    assert_eq!((drawn.status, drawn.err.matches("Pictures: ").count()), (0, 2), "{}", drawn.err);
    assert_eq!(serde_json::from_str::<Value>(&drawn.out).unwrap()["unsolved"], json!([]));
    let read = |part: &str| fs::read_to_string(pictures.join(part)).unwrap();
    assert_ne!(read("before/ecm-1.svg"), read("after/ecm-1.svg"));
    assert!(read("before/index.html").len() > 1000 && read("after/index.html").len() > 1000);
}
