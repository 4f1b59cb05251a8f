//! Every format by its file, through the commands.

use crate::fixture::{file, run};
use serde_json::Value;

fn real(name: &str) -> String {
    format!("{}/../tests/data/real/{name}", env!("CARGO_MANIFEST_DIR"))
}

/// The table of locks of a layout.
#[track_caller]
fn locks(name: &str) -> Value {
    let run = run(&["locks", &real(name), "--radius", "0.4", "--format", "json"]);
    assert_eq!(run.status, 0, "{}", run.err);
    serde_json::from_str(&run.out).unwrap()
}

#[test]
fn layouts_are_known_by_name_and_content() {
    for name in [
        "nav2/aws_graph.geojson",
        "lif/example_07.lif.json",
        "rmf/office.building.yaml",
        "opendrive/Town02.planview.xodr",
        "ccbs/sparse_map.xml",
        "opentcs/Demo-01.xml",
    ] {
        assert!(!locks(name)["locks"].as_array().unwrap().is_empty(), "{name}");
    }
}

#[test]
fn plans_are_checked_as_they_are() {
    let check = |name: &str, radius: &str| run(&["check", &real(name), "--radius", radius, "--format", "json"]);
    let free = check("ccbs/example_grid_task_log.xml", "0.353553");
    assert_eq!((free.status, free.err.as_str()), (0, ""));
    let collides = check("ccbs/example_roadmap_task_log.xml", "0.353553");
    assert_eq!(collides.status, 1, "{}", collides.err);
    let verdict: Value = serde_json::from_str(&collides.out).unwrap();
    let deep =
        verdict["conflicts"].as_array().unwrap().iter().filter(|conflict| conflict["depth"].as_f64() > Some(1e-5));
    assert_eq!(
        deep.map(|conflict| (conflict["i"].as_u64(), conflict["j"].as_u64())).collect::<Vec<_>>(),
        [(Some(0), Some(3))]
    );
}

#[test]
fn points_of_paths_are_agents() {
    let circle: String = (0..=60).map(|k| (f64::from(k) * 0.05).sin_cos()).map(|(y, x)| format!("{x} {y}\n")).collect();
    let name = file("formats", "two.path", format!("{circle}\n-2 0.5\n2 0.5\n"));
    let out = run(&["import", "path", &name, "--radius", "0.3"]).out;
    let scenario: Value = serde_json::from_str(&out).unwrap();
    let kinds = |agent: usize| -> Vec<&str> {
        scenario["agents"][agent]["path"]
            .as_array()
            .unwrap()
            .iter()
            .map(|segment| segment["kind"].as_str().unwrap())
            .collect()
    };
    assert!(kinds(0).len() < 12 && kinds(0).iter().all(|kind| *kind == "arc"), "{scenario}");
    assert_eq!(kinds(1), ["line"]);
    let radius = scenario["agents"][0]["radius"].as_f64().unwrap();
    assert!(radius > 0.3003 && radius < 0.301, "the sagitta of the steps is margin: {radius}");
}

#[test]
fn what_is_something_else_is_said_to_be() {
    let message = |command: &str, name: &str| run(&[command, &real(name), "--radius", "0.4"]).failed(2);
    for (command, name, expected) in [
        ("regions", "opentcs/Demo-01.xml", "a layout has no agents; ask for routes with --route FROM:TO"),
        ("regions", "ccbs/example_grid_map.xml", "root: there is no log in it, hence no plan (read as ccbs)"),
        ("locks", "ccbs/example_grid_task_log.xml", "root: there is no graph in it, which a roadmap is (read as ccbs)"),
        ("locks", "vda5050/order_v2_flywei.json", "an order or a state is not a layout (read as vda5050)"),
        ("regions", "vda5050/order_v2_nulls_opentcs.json", "startNodeId: source-node, but by sequenceId it is"),
        ("locks", "rmf/config/office_tinyRobot_config.yaml", "it is the configuration of a fleet"),
    ] {
        // Warnings about the vehicle come first.
        let run = run(&[command, &real(name), "--radius", "0.4"]);
        assert_eq!(run.status, 2, "{name}");
        assert!(run.err.lines().last().unwrap().contains(expected), "{}", run.err);
    }
    assert!(message("regions", "README.md").contains("README.md:1: column 1: "));
}
