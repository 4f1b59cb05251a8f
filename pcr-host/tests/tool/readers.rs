//! Files of other programs as they come: cut, large, with names that are none, and with what may be left out.

use crate::fixture::{crossing, file, run, run_with};
use serde_json::{Value, json};

const VEHICLE: [&str; 10] =
    ["--radius", "0.3", "--speed", "1", "--acceleration", "0.5", "--rotation", "1", "--rotation-acceleration", "1"];
const LIF: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/data/real/lif/example_10.lif.json");

/// A model with two points and a path between them.
fn plant(path: &str, vehicle: &str) -> String {
    format!(
        "<model name=\"p\"><point name=\"A\" positionX=\"0\" positionY=\"0\"/>\
         <point name=\"B\" positionX=\"4000\" positionY=\"0\"/>\
         <path name=\"A-B\" sourcePoint=\"A\" destinationPoint=\"B\" {path}/>{vehicle}</model>"
    )
}

#[test]
fn plans_and_paths_that_may_be_cut_are_told() {
    let cut = file("readers", "cut.plan", "2\nAgent 0: (0,0)->(1,0)->(2,0)->\nAgent 1: (2,2)->(2,1)->");
    let refused = run(&["check", &cut]).failed(2);
    assert!(refused.contains("the last line does not end: the file may have been cut there"), "{refused}");
    let told = |name: &str, text: &str, more: &[&str]| {
        let read = run(&[&["check", &file("readers", name, text)], more].concat());
        (read.status, read.err.contains("last line: it does not end; if the file was cut there"))
    };
    let radius = &VEHICLE[..2];
    assert_eq!(told("whole.plan", "Agent 0: (0,0)->(1,0)->\n", radius), (0, false));
    assert_eq!(told("open.plan", "Agent 0: (0,0)->(1,0)\nAgent 1: (2,2)->(2,1)", radius), (0, true));
    assert_eq!(told("whole.path", "0 0\n12.5 0\n", &VEHICLE), (0, false));
    assert_eq!(told("open.path", "0 0\n12.5 0", &VEHICLE), (0, true));
}

#[test]
fn a_name_that_is_no_label_is_read_with_a_warning() {
    let node = |id: u32, x: f64| json!({ "type": "Feature", "properties": { "id": id }, "geometry": { "type": "Point", "coordinates": [x, 0] } });
    let edge = json!({ "type": "Feature", "properties": { "id": 3, "startid": 1, "endid": 2 },
        "geometry": { "type": "MultiLineString", "coordinates": [] } });
    let graph = |name: &str| {
        let graph =
            json!({ "type": "FeatureCollection", "name": name, "features": [node(1, 0.0), node(2, 4.0), edge] });
        file("readers", "named.geojson", graph.to_string())
    };
    for (name, called) in [("a\tb", "ab"), (&"x".repeat(300), &*"x".repeat(200))] {
        let read = run(&[&["check", &graph(name), "--route", "1:2", "--json"], &VEHICLE[..]].concat());
        let answer: Value = serde_json::from_str(&read.out).unwrap();
        assert_eq!((read.status, &answer["name"]), (0, &json!(called)), "{}", read.err);
        let told = format!("name: it becomes {called}: names are printable text of up to 200 characters [renamed]");
        assert!(answer["warnings"].as_array().unwrap().contains(&json!(told)), "{answer}");
    }
    let plain = run(&["nodes", &graph("plain"), "--json"]).json();
    assert_eq!(plain["warnings"], json!([]));
}

#[test]
fn a_map_that_is_null_is_left_out() {
    let mut layout: Value = serde_json::from_str(&std::fs::read_to_string(LIF).unwrap()).unwrap();
    for list in layout["layouts"].as_array_mut().unwrap() {
        for node in list["nodes"].as_array_mut().unwrap() {
            node["mapId"] = Value::Null;
        }
    }
    let null = run(&["nodes", &file("readers", "null.lif.json", layout.to_string()), "--json", "-q"]).json();
    for list in layout["layouts"].as_array_mut().unwrap() {
        for node in list["nodes"].as_array_mut().unwrap() {
            node.as_object_mut().unwrap().remove("mapId");
        }
    }
    let none = run(&["nodes", &file("readers", "none.lif.json", layout.to_string()), "--json", "-q"]).json();
    assert_eq!((&null["nodes"], &null["levels"]), (&none["nodes"], &none["levels"]));
}

#[test]
fn a_text_that_names_agents_somewhere_is_no_scenario() {
    let mut layout: Value = serde_json::from_str(&std::fs::read_to_string(LIF).unwrap()).unwrap();
    layout["metaInformation"]["projectIdentification"] = json!("agents");
    let read = run_with(&["nodes", "-", "--json", "-q"], layout.to_string().as_bytes()).json();
    assert_eq!(read["layout"], "agents");
    // A line within a scenario that looks like one by a value.
    let mut scenario = crossing();
    scenario["agents"][0]["label"] = json!("agents");
    let agents = scenario["agents"].as_array().unwrap().iter().map(Value::to_string).collect::<Vec<_>>().join("\n,\n");
    let checked = run_with(&["check", "-q"], format!("{{\"agents\": [\n{agents}\n]}}").as_bytes());
    assert_eq!((checked.status, checked.err.as_str()), (1, ""));
}

/// The parser has limits for configurations, which are small.
#[test]
fn a_large_navigation_graph_is_read() {
    let count = 40_000;
    let mut text = String::from("building_name: big\nlevels:\n  L1:\n    lanes:\n");
    (1..count).for_each(|k| text += &format!("    - [{}, {k}, {{speed_limit: 0.5}}]\n", k - 1));
    text += "    vertices:\n";
    (0..count).for_each(|k| text += &format!("    - [{k}, 0, {{name: ''}}]\n"));
    let listed = run(&["nodes", &file("readers", "big.yaml", text), "--json", "-q"]).json();
    assert_eq!(listed["nodes"].as_array().unwrap().len(), count);
    let deep = format!("{}{}", "[".repeat(200), "]".repeat(200));
    let refused = run(&["nodes", &file("readers", "deep.yaml", deep)]).failed(2);
    assert!(refused.contains("too large or too deep"), "{refused}");
}

#[test]
fn what_a_path_of_a_plant_does_not_say_is_told() {
    let warnings = |path: &str, vehicle: &str, command: &str| {
        let name = file("readers", "plant.xml", plant(path, vehicle));
        let options: &[&str] = if command == "nodes" { &[] } else { &VEHICLE[..2] };
        run(&[&[command, &name, "--json"], options].concat()).err
    };
    let silent = warnings("length=\"4000\" maxVelocity=\"1000\"", "", "locks");
    assert_eq!(silent, "");
    let told = warnings("", "", "locks");
    assert!(told.contains("path A-B: it has no length; that of its geometry counts"), "{told}");
    assert!(told.contains("path A-B: it has no maxVelocity; it is taken to be open"), "{told}");
    assert!(!told.contains("its length is not that"), "{told}");
    // Of a radius that nobody gave nothing is said.
    let vehicle = "<vehicle name=\"V\"><boundingBox length=\"4000\" width=\"2000\" height=\"1000\" referenceOffsetX=\"0\" \
                   referenceOffsetY=\"0\"/></vehicle>";
    let listed = warnings("length=\"4000\" maxVelocity=\"1000\"", vehicle, "nodes");
    assert_eq!(listed, "");
}

/// Nodes n0, n1, … every 5 m along the x axis, those from `from` up to `to`, released up to `base`.
fn order(update: u32, from: usize, to: usize, base: usize) -> String {
    let node = |k: usize| {
        json!({ "nodeId": format!("n{k}"), "sequenceId": 2 * k, "released": k <= base, "actions": [],
            "nodePosition": { "x": 5 * k, "y": 0, "mapId": "m" } })
    };
    let edge =
        |k: usize| json!({ "edgeId": format!("e{k}"), "sequenceId": 2 * k + 1, "released": k < base, "actions": [] });
    json!({ "serialNumber": "S", "orderId": "o", "orderUpdateId": update,
        "nodes": (from..=to).map(node).collect::<Vec<_>>(), "edges": (from..to).map(edge).collect::<Vec<_>>() })
    .to_string()
}

#[test]
fn what_an_update_in_another_file_releases_is_not_said_to_be_left_out() {
    let [first, all, some] = [("first", 0, 0, 4, 2), ("all", 1, 2, 4, 4), ("some", 1, 2, 4, 3)]
        .map(|(name, update, from, to, base)| file("updates", &format!("{name}.json"), order(update, from, to, base)));
    let warnings = |files: &[&str]| {
        let read = run(&[&["import", "vda5050"], files, &VEHICLE[..]].concat());
        let scenario: Value = serde_json::from_str(&read.out).unwrap();
        let length = scenario["agents"][0]["path"][0]["length"].clone();
        (length, read.err.lines().map(str::to_owned).collect::<Vec<_>>())
    };
    assert_eq!(warnings(&[&first, &all]), (json!(20.0), vec![]));
    let told =
        format!("pcr: warning: {some}: order o: 1 of 4 edges are not released and left out (--horizon) [not-released]");
    assert_eq!(warnings(&[&first, &some]), (json!(15.0), vec![told]));
    let told = format!(
        "pcr: warning: {first}: order o: 2 of 4 edges are not released and left out (--horizon) [not-released]"
    );
    assert_eq!(warnings(&[&first]), (json!(10.0), vec![told]));
    // What counts is what they amount to together.
    run(&[&["import", "vda5050", &first, &some, "--horizon"], &VEHICLE[..]].concat()).ok();
    let vain = run(&[&["import", "vda5050", &first, &all, "--horizon"], &VEHICLE[..]].concat()).failed(2);
    assert_eq!(
        vain,
        format!(
            "pcr: {first}: --horizon has no effect: it is for orders that end in edges that are not released, and there is none\n"
        )
    );
}

/// An update was taken at any node: the vehicle left its way, and what stood on that was not met.
#[test]
fn an_update_that_leaves_the_base_is_refused_and_the_base_collides() {
    let node = |(k, (name, x, y)): (usize, &(&str, f64, f64))| {
        json!({ "nodeId": name, "sequenceId": 2 * k, "released": true, "actions": [],
            "nodePosition": { "x": x, "y": y, "mapId": "m" } })
    };
    let message = |serial: &str, update: u32, nodes: &[(&str, f64, f64)]| {
        let edge =
            |k: usize| json!({ "edgeId": format!("e{k}"), "sequenceId": 2 * k + 1, "released": true, "actions": [] });
        let order = json!({ "manufacturer": "M", "serialNumber": serial, "orderId": format!("o{serial}"),
            "orderUpdateId": update, "nodes": nodes.iter().enumerate().map(node).collect::<Vec<_>>(),
            "edges": (1..nodes.len()).map(|k| edge(k - 1)).collect::<Vec<_>>() });
        file("leaves", &format!("{serial}{update}.json"), order.to_string())
    };
    let base = message("1", 0, &[("A", 0.0, 0.0), ("B", 10.0, 0.0), ("C", 10.0, 10.0)]);
    let update = message("1", 1, &[("A", 0.0, 0.0), ("D", 0.0, 10.0)]);
    let other = message("2", 0, &[("B2", 10.0, 0.5)]);
    let import = |more: &[&str]| {
        run(&[&["import", "vda5050", &base, &update, &other, "--radius", "0.4", "-o", "-"], more].concat())
    };
    let problem = "order o1, update 1, nodes[0]: it begins at A (0), but the base ends at C (4) and cannot be changed";
    let refused = import(&[]).failed(2);
    assert!(refused.contains(problem), "{refused}");
    let read = import(&["--partial"]);
    assert!(read.status == 0 && read.err.contains(&format!("{problem}: left out")), "{}", read.err);
    let scenario: Value = serde_json::from_str(&read.out).unwrap();
    let warnings = scenario["warnings"].to_string();
    assert!(warnings.contains("update 1, nodes[0]") && !warnings.contains("is not there"), "{warnings}");
    assert_eq!(run_with(&["check"], read.out.as_bytes()).status, 1);
}

#[test]
fn an_outline_with_parts_without_width_is_refused_by_its_file() {
    let point = |[x, y]: [f64; 2]| json!({ "x": x, "y": y });
    let fork = [[-0.5, -0.3], [0.5, -0.3], [0.5, 0.2], [1.5, 0.2], [0.5, 0.2], [0.5, 0.3], [-0.5, 0.3]];
    let sheet = json!({ "physicalParameters": { "speedMax": 1 },
        "agvGeometry": { "envelopes2d": [{ "set": "a", "polygonPoints": fork.map(point) }] } });
    let fleet = file("readers", "fork.json", sheet.to_string());
    let refused = run(&["locks", LIF, "--vehicle", "Vehicle_Type_1", "--fleet", &fleet]).failed(2);
    assert!(
        refused.contains("fork.json:1:1: factsheet, envelopes2d: the side from corner 2 to 3 touches"),
        "{refused}"
    );
    let mut scenario = crossing();
    let corner = |[ahead, left]: [f64; 2]| json!({ "ahead": ahead, "left": left });
    scenario["agents"][0].as_object_mut().unwrap().remove("radius");
    scenario["agents"][0]["footprint"] = json!({ "polygon": fork.map(corner) });
    let refused = run_with(&["check"], scenario.to_string().as_bytes());
    assert!(refused.err.contains("agent 1, footprint: the side from corner 2 to 3 touches"), "{}", refused.err);
}
