//! Files of other formats: by their extension or `--from`, with warnings on standard error.

use crate::fixture::{file, run, run_with};
use serde_json::{Value, json};

const WAREHOUSE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/data/real/nav2/warehouse_graph.geojson");
const VEHICLE: [&str; 10] =
    ["--radius", "0.4", "--speed", "1", "--acceleration", "0.5", "--rotation", "1", "--rotation-acceleration", "1"];

#[test]
fn every_command_reads_a_layout_with_routes() {
    let routes = ["--route", "0:50", "--route", "50:0"];
    let regions = run(&[&["regions", WAREHOUSE, "--format", "json"], &routes[..], &VEHICLE].concat());
    assert_eq!(regions.status, 0, "{}", regions.err);
    // The drawing of the graph does not match its nodes.
    let told: Vec<&str> = regions.err.lines().collect();
    assert!(told.len() == 1 && told[0].contains("edge 10118"), "{}", regions.err);
    let imported = run(&[&["import", "nav2", WAREHOUSE], &routes[..], &VEHICLE].concat());
    assert_eq!(imported.status, 0, "{}", imported.err);
    let scenario = file("import", "scenario.json", &imported.out);
    let again: Value = run(&["regions", &scenario, "--format", "json", "-q"]).json();
    let direct: Value = serde_json::from_str(&regions.out).unwrap();
    let (direct, again) = (direct["regions"].as_array().unwrap(), again["regions"].as_array().unwrap());
    assert!(direct.len() == again.len() && !direct.is_empty(), "they meet");
    for (direct, again) in direct.iter().zip(again) {
        assert_eq!((&direct["i"], &direct["j"], &direct["l"]), (&again["i"], &again["j"], &again["l"]));
        let time = |region: &Value, k: usize| region["t"][k].as_f64().unwrap();
        // A profile is scaled by its last digit whenever it is read.
        assert!((0..2).all(|k| (time(direct, k) - time(again, k)).abs() < 1e-9));
    }
}

#[test]
fn a_format_may_be_named_and_come_through_a_pipe() {
    let graph = std::fs::read(WAREHOUSE).unwrap();
    let piped = run_with(&[&["regions", "-", "--from", "nav2", "--route", "0:50"], &VEHICLE[..]].concat(), &graph);
    assert_eq!(piped.status, 0, "{}", piped.err);
    let name = file("import", "graph.txt", &graph);
    let written = std::path::Path::new(&name).with_file_name("written.json");
    let arguments = ["import", "nav2", &name, "--route", "3:4", "-o", written.to_str().unwrap()];
    let run = run(&[&arguments, &VEHICLE[..]].concat());
    assert_eq!((run.status, run.out.as_str()), (0, ""));
    assert!(std::fs::read_to_string(written).unwrap().contains("\"name\": \"warehouse_graph\""));
}

#[test]
fn what_is_wrong_is_named() {
    let failed = run(&["regions", WAREHOUSE, "--route", "0:1000"]).failed(2);
    assert!(failed.ends_with("route 0:1000: there is no node 1000 (read as nav2)\n"), "{failed}");
    let scenario = file("import", "plain.json", crate::fixture::crossing().to_string());
    let failed = run(&["regions", &scenario, "--radius", "1"]).failed(2);
    assert!(failed.ends_with(": --radius has no effect: a scenario has its own vehicles and paths\n"), "{failed}");
    let failed = run(&["regions", &scenario, "--from", "nav2"]).failed(2);
    assert!(failed.ends_with("graph, features: missing (read as nav2)\n"), "{failed}");
    let refused = run(&["regions", WAREHOUSE, "--radius=-1"]);
    assert_eq!(refused.status, 2);
    assert!(refused.err.contains("a number from 1e-6 to 1e6 is expected"), "{}", refused.err);
}

#[test]
fn several_orders_or_paths_are_agents_of_one_scenario() {
    let order = |id: &str, y: f64| {
        let nodes = [0.0, 5.0].map(|x| {
            json!({ "nodeId": format!("{id}{x}"), "sequenceId": if x > 0.0 { 2 } else { 0 },
            "released": true, "actions": [], "nodePosition": { "x": x, "y": y, "mapId": "m" } })
        });
        let edge = json!({ "edgeId": "e", "sequenceId": 1, "released": true, "actions": [] });
        file("several", &format!("{id}.json"), json!({ "orderId": id, "nodes": nodes, "edges": [edge] }).to_string())
    };
    let (a, b) = (order("a", 0.0), order("b", 0.5));
    let read = |arguments: &[&str]| -> Value {
        let run = run(arguments);
        assert_eq!(run.status, 0, "{}", run.err);
        serde_json::from_str(&run.out).unwrap()
    };
    let both = read(&["import", "vda5050", &a, &b, "--radius", "0.3"]);
    let place = |k: usize| both["agents"][k]["start"]["y"].as_f64().unwrap();
    assert_eq!((both["agents"].as_array().unwrap().len(), place(0), place(1)), (2, 0.0, 0.5));
    let [one, two] = ["one.path", "two.path"].map(|name| file("several", name, "0 0\n3 0"));
    assert_eq!(read(&["import", "path", &one, &two, "--radius", "0.3"])["agents"].as_array().unwrap().len(), 2);
    let damaged = file("several", "c.json", "{ \"orderId\": \"c\", \"nodes\": [] }");
    let failed = run(&["import", "vda5050", &a, &damaged, "--radius", "0.3"]).failed(2);
    assert!(failed.contains("c.json:1:1: order c, missing field `edges`"), "{failed}");
    let layouts = run(&["import", "nav2", &a, &b, "--radius", "0.3"]).failed(2);
    assert!(layouts.contains("a.json: only orders and states"), "{layouts}");
}

const ONE_ID: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/data/cases/one-id-two-edges.geojson");

#[test]
fn warnings_are_in_every_answer() {
    let routes = ["--route", "0:1", "--route", "4:5"];
    let of = |command: &[&str], routes: &[&str]| {
        // Locks do not depend on speeds.
        let vehicle = if command == ["locks"] { &VEHICLE[..2] } else { &VEHICLE[..] };
        let run = run(&[command, &[ONE_ID, "--format", "json"], routes, vehicle].concat());
        assert!(run.err.lines().any(|line| line.contains("edge 101: several have this name")), "{}", run.err);
        serde_json::from_str::<Value>(&run.out).unwrap()
    };
    let warned = |answer: &Value| {
        let warnings = answer["warnings"].as_array().unwrap();
        warnings.iter().any(|line| {
            line.as_str().unwrap() == "edge 101: several have this name; one of them is called 101#2 here [renamed]"
        })
    };
    for command in
        [&["regions"][..], &["check"], &["plan"], &["simulate", "--controller", "pcr"], &["compare", "--rounds", "1"]]
    {
        assert!(warned(&of(command, &routes)), "{command:?}");
    }
    let locks = of(&["locks"], &[]);
    assert_eq!((warned(&locks), locks["locks"].as_array().unwrap().len()), (true, 1));
    assert!(warned(&of(&["traffic", "--agents", "2"], &[])));
    // Also those of a file that was imported before, which says so itself.
    let imported = run(&[&["import", "nav2", ONE_ID], &routes[..], &VEHICLE].concat());
    let scenario = file("import", "one-id.json", &imported.out);
    assert!(warned(&run(&["check", &scenario, "--format", "json", "-q"]).json_of(1)));
    // And nothing where there is nothing to warn about.
    let plain = run(&["regions", crate::fixture::PAPER, "--format", "json"]).json();
    assert_eq!(plain["warnings"], json!([]));
}

#[test]
fn what_would_be_left_out_is_refused_unless_it_is_asked_for() {
    let mut graph: Value = serde_json::from_str(&std::fs::read_to_string(ONE_ID).unwrap()).unwrap();
    graph["features"][7]["properties"]["endid"] = json!(44);
    let name = file("import", "lost.geojson", graph.to_string());
    let expected =
        format!("pcr: {name}:1:862: edge 100, endid: there is no node 44; --partial leaves that out (read as nav2)\n");
    assert_eq!(run(&["locks", &name, "--radius", "0.4"]).failed(2), expected);
    let partly = run(&["locks", &name, "--radius", "0.4", "--partial", "--format", "json"]);
    assert_eq!(partly.status, 0, "{}", partly.err);
    let answer: Value = serde_json::from_str(&partly.out).unwrap();
    assert!(answer["warnings"].to_string().contains("edge 100, endid: there is no node 44: left out"), "{answer}");
    // A scenario has nothing to leave out.
    let scenario = file("import", "plain.json", crate::fixture::crossing().to_string());
    assert!(run(&["check", &scenario, "--partial"]).failed(2).contains("--partial has no effect"));
}

#[test]
fn agents_on_different_maps_are_told_also_if_they_are_from_different_files() {
    let state = |robot: &str, map: &str| {
        let pose = json!({ "x": 0.0, "y": 0.0, "theta": 0.0, "mapId": map });
        json!({ "serialNumber": robot, "nodeStates": [], "mobileRobotPosition": pose }).to_string()
    };
    let files = [("a", "ground"), ("b", "first")]
        .map(|(robot, map)| file("import", &format!("{robot}.json"), state(robot, map)));
    let two = run(&[&["import", "vda5050", &files[0], &files[1]], &VEHICLE[..]].concat());
    let told = "maps first, ground: the agents are on several, which a scenario does not tell apart";
    assert!(two.status == 0 && two.err.contains(told), "{}", two.err);
    assert!(two.out.contains(told), "{}", two.out);
    let one = run(&[&["import", "vda5050", &files[0]], &VEHICLE[..]].concat());
    assert!(!one.err.contains("maps"), "{}", one.err);
}

#[test]
fn names_that_are_no_labels_are_read_with_a_warning() {
    let node = |k: u32| {
        json!({ "nodeId": format!("n{k}"), "sequenceId": 2 * k, "released": true, "actions": [],
        "nodePosition": { "x": 4 * k, "y": 0, "mapId": "m" } })
    };
    let edge = json!({ "edgeId": "e", "sequenceId": 1, "released": true, "actions": [] });
    let order = json!({ "serialNumber": "S\n\u{202e}X", "orderId": "o", "nodes": [node(0), node(1)], "edges": [edge] });
    let order = file("import-names", "order.json", order.to_string());
    let read = run(&["import", "vda5050", &order, "--radius", "0.3", "-o", "-"]);
    assert!(read.status == 0 && read.out.contains("\"label\": \"SX o\""), "{}{}", read.out, read.err);
    assert!(
        read.err
            .contains("agent 1: its label becomes SX o: labels are printable text of up to 200 characters [renamed]\n"),
        "{}",
        read.err
    );
}
