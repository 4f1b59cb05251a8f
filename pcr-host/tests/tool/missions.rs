//! `pcr traffic --missions`, and closures and breakdowns, also with `--hours`.

use crate::fixture::{directory, file, run};
use serde_json::Value;

/// The route graph of nav2's warehouse.
const WAREHOUSE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/data/real/nav2/warehouse_graph.geojson");

const VEHICLES: &str = r#"{"kind": "vehicle", "id": "truck", "start": 10, "length": 1.2, "width": 0.8, "speed": 0.8}
{"kind": "vehicle", "id": "robot", "start": 37, "radius": 0.3}
"#;

fn missions(name: &str, text: &str) -> String {
    file("missions", name, text)
}

#[test]
fn missions_of_a_file_are_run_and_the_run_is_a_scenario() {
    let text = format!(
        "{VEHICLES}{{\"id\": \"a\", \"to\": 60, \"due\": 10}}\n{{\"id\": \"b\", \"from\": 20, \"via\": [30], \"to\": 5, \"priority\": 2}}\n"
    );
    let (day, folder) = (missions("day.jsonl", &text), directory("missions/run"));
    let folder = folder.to_str().unwrap();
    let ask = ["traffic", WAREHOUSE, "--missions", &day, "--allow", "assumed-vehicle", "-o", folder, "--json", "-q"];
    let report: Value = run(&ask).json();
    assert_eq!(
        (&report["done"], &report["late"], &report["certificate"]["verdict"]),
        (&2.into(), &1.into(), &"proved".into())
    );
    assert_eq!(report["missions"][1]["stops"].as_array().map(Vec::len), Some(3));
    let scenario = format!("{folder}/run.json");
    for command in [&["check", &scenario][..], &["check", "--certify", &scenario], &["certify", &scenario]] {
        run(&[command, &["-q"]].concat()).ok();
    }
    // The same as CSV, with the vehicles in a file of their own.
    let vehicles =
        missions("vehicles.csv", "id,start,length,width,speed,radius\ntruck,10,1.2,0.8,0.8,\nrobot,37,,,,0.3\n");
    let csv = missions("day.csv", "id,from,via,to,due,priority\na,,,60,10,\nb,20,\"30\",5,,2\n");
    let ask = ["traffic", WAREHOUSE, "--missions", &csv, "--vehicles", &vehicles, "--allow", "assumed-vehicle"];
    assert_eq!(run(&[&ask[..], &["--json", "-q"]].concat()).json(), report);
    let lines = run(&[&ask[..], &["--format", "csv", "-q"]].concat()).ok();
    assert!(lines.starts_with("mission,vehicle,start,finish,lateness,reason\n\"a\",\"") && lines.lines().count() == 3);
}

#[test]
fn closures_are_told_and_missions_that_are_impossible_end_with_status_1() {
    let (day, closed) = (
        missions("closed.jsonl", &format!("{VEHICLES}{{\"id\": \"a\", \"vehicle\": \"robot\", \"to\": 60}}\n")),
        missions("closures.csv", "node,at,until\n60,1,\n"),
    );
    let ask = ["traffic", WAREHOUSE, "--missions", &day, "--closures", &closed, "--allow", "assumed-vehicle", "-q"];
    let report = run(&[&ask[..], &["--json"]].concat()).json_of(1);
    assert_eq!((&report["refused"], &report["closures"][0]["node"]), (&1.into(), &"60".into()));
    let why = report["missions"][0]["reason"].as_str().unwrap();
    assert!(why.starts_with("vehicle robot: no route leads from where it is to node 60"), "{why}");
    let table = run(&ask[..8]);
    assert!(
        table.status == 1 && table.out.contains("\nmission a is not done: vehicle robot: no route"),
        "{}",
        table.out
    );
    assert!(table.out.contains("\nnode 60 closed from 1 s for ever: "), "{}", table.out);
}

/// Closures by the names of blocks, and limits of the speed; as lines and as a table of CSV.
#[test]
fn zones_of_the_layout_are_closed_and_speeds_limited() {
    let plant = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/data/real/opentcs/Demo-01.xml");
    let text = std::fs::read_to_string(plant).unwrap();
    let block = text.split("<block name=\"").nth(1).expect("a block");
    let name = block.split('"').next().unwrap();
    let closed = missions("zones.csv", &format!("zone,at,until,speed\n{name},10,100,\n{name},120,,0.1\n"));
    let ask = ["traffic", plant, "--hours", "0.1", "--radius", "0.4", "--agents", "2", "--active", "2", "--closures"];
    let ask = [&ask[..], &[&closed, "-q"]].concat();
    let report = run(&[&ask[..], &["--json"]].concat());
    let report: Value = serde_json::from_str(&report.out).unwrap_or_else(|_| panic!("{}", report.err));
    assert_eq!(report["runs"][0]["certificate"]["verdict"], "proved");
    let closures = report["closures"].as_array().unwrap();
    assert!(
        closures.iter().all(|it| it["zone"] == name && it["edge"].is_null() && it["begun"] == true),
        "{closures:?}"
    );
    assert_eq!([&closures[0]["speed"], &closures[1]["speed"]], [&Value::Null, &0.1.into()]);
    let table = run(&ask[..ask.len() - 1]).out;
    for told in [
        format!("\nzone {name} closed from 10 s until 100 s: "),
        format!("\nzone {name} limited to 0.1 m/s from 120 s for ever: "),
    ] {
        assert!(table.contains(&told), "{told}: {table}");
    }
    for (file, line, why) in [
        ("no.jsonl", "{\"zone\": \"nowhere\", \"at\": 0}", ":1:10: there is no zone nowhere in the layout; zones are"),
        (
            "two.jsonl",
            "{\"zone\": \"z\", \"edge\": 1, \"at\": 0}",
            ":1:1: a closure is of an edge, of a node or of a zone",
        ),
    ] {
        let wrong = missions(file, line);
        let error = run(&["traffic", plant, "--hours", "0.1", "--radius", "0.4", "--closures", &wrong, "-q"]).failed(2);
        assert!(error.starts_with(&format!("pcr: {wrong}{why}")), "{error}");
    }
    let node = missions("node.jsonl", "{\"node\": 60, \"at\": 0, \"speed\": 1}");
    let error = run(&["traffic", WAREHOUSE, "--hours", "0.1", "--radius", "0.4", "--closures", &node, "-q"]).failed(2);
    assert!(
        error.starts_with(&format!("pcr: {node}:1:32: speed: a limit is of an edge, or of a zone with edges")),
        "{error}"
    );
}

#[test]
fn closures_and_breakdowns_are_told_of_fleets_that_run() {
    let closed = missions(
        "hours.jsonl",
        "{\"edge\": 10120, \"at\": 60, \"until\": 300}\n{\"kind\": \"closure\", \"node\": 60, \"at\": 5}\n{\"node\": 0, \"at\": 9000}\n",
    );
    let broken = missions("hours.csv", "vehicle,at,until\n2,100,200\n6,100,\n");
    let ask = [
        &["traffic", WAREHOUSE, "--hours", "0.25", "--radius", "0.4", "--agents", "8", "--active", "5"][..],
        &["--closures", &closed, "--breakdowns", &broken, "--allow", "assumed-vehicle", "--allow", "gap", "-q"],
    ]
    .concat();
    let report: Value = run(&[&ask[..], &["--json"]].concat()).json();
    assert_eq!(report["runs"][0]["certificate"]["verdict"], "proved");
    assert_eq!(report["runs"][0]["breaches"], 0);
    let closures = report["closures"].as_array().unwrap();
    assert_eq!(closures.iter().map(|it| it["begun"] == true).collect::<Vec<_>>(), [true, true, false]);
    assert_eq!((&closures[0]["edge"], &closures[0]["until"]), (&"10120".into(), &300.0.into()));
    // Node 60 is a bay of its own: all tasks there are given up, and by nobody else's fault.
    let lost = closures[1]["unreachable"].as_array().unwrap();
    assert!(!lost.is_empty() && lost.iter().all(|it| it["given_up"] == true), "{lost:?}");
    assert!(lost.iter().any(|it| it["node"] == "60"), "{lost:?}");
    let breakdowns = report["breakdowns"].as_array().unwrap();
    assert!(breakdowns[0]["x"].is_f64() && breakdowns[0]["vehicle"] == "2", "{breakdowns:?}");
    // Robot 6 is not active.
    assert!(breakdowns[1]["x"].is_null() && breakdowns[1]["begun"] == true, "{breakdowns:?}");
    let table = run(&ask[..ask.len() - 1]).ok();
    for told in [
        "\nedge 10120 closed from 60 s until 300 s: ",
        "\nnode 60 closed from 5 s for ever: ",
        "\n  no way to 60",
        "\nnode 0 would have been closed from 9000 s, after the end\n",
        "\n2 stands still from 100 s until 200 s ",
        "\n6 is not on the layout and cannot break down at 100 s\n",
    ] {
        assert!(table.contains(told), "{told}: {table}");
    }
    // Without them another fleet.
    let without = run(&[&ask[..10], &["--allow", "assumed-vehicle", "--allow", "gap", "-q", "--json"]].concat()).json();
    assert!(without["runs"] != report["runs"] && without["closures"] == Value::Array(Vec::new()));
    for (name, text, told) in [
        ("far.jsonl", "{\"kind\": \"breakdown\", \"vehicle\": 9, \"at\": 0}", ":1:34: there is no vehicle 9\n"),
        ("task.jsonl", "{\"kind\": \"mission\", \"id\": 1, \"to\": 9}", ":1:1: a mission; only closures and"),
    ] {
        let wrong = missions(name, text);
        let error = run(&[&ask[..10], &["--closures", &wrong, "-q"]].concat()).failed(2);
        assert!(error.starts_with(&format!("pcr: {wrong}{told}")), "{name}: {error}");
    }
}

#[test]
fn a_mission_to_where_somebody_parks_for_good_is_told() {
    let site = missions(
        "sink.geojson",
        r#"{"type": "FeatureCollection", "name": "sink", "features": [
        {"type": "Feature", "properties": {"id": 0}, "geometry": {"type": "Point", "coordinates": [0, 0]}},
        {"type": "Feature", "properties": {"id": 1}, "geometry": {"type": "Point", "coordinates": [5, 0]}},
        {"type": "Feature", "properties": {"id": 2}, "geometry": {"type": "Point", "coordinates": [10, 0]}},
        {"type": "Feature", "properties": {"id": 10, "startid": 0, "endid": 1}, "geometry": {"type": "LineString", "coordinates": [[0, 0], [5, 0]]}},
        {"type": "Feature", "properties": {"id": 11, "startid": 1, "endid": 0}, "geometry": {"type": "LineString", "coordinates": [[5, 0], [0, 0]]}},
        {"type": "Feature", "properties": {"id": 12, "startid": 1, "endid": 2}, "geometry": {"type": "LineString", "coordinates": [[5, 0], [10, 0]]}}]}"#,
    );
    let day = missions(
        "sink.jsonl",
        "{\"kind\": \"vehicle\", \"id\": \"a\", \"start\": 2, \"radius\": 0.4}\n{\"kind\": \"vehicle\", \"id\": \"b\", \"start\": 0, \"radius\": 0.4}\n{\"id\": 1, \"to\": 2, \"vehicle\": \"b\"}\n",
    );
    let report = run(&["traffic", &site, "--missions", &day, "--allow", "assumed-vehicle", "-q", "--json"]).json_of(1);
    let why = "vehicle b: no route leads from where it is to node 2 past a, which can never leave";
    assert_eq!(report["missions"][0]["reason"], why);
}

#[test]
fn what_is_wrong_in_a_file_is_told_with_its_place() {
    for (name, text, told) in [
        ("a.jsonl", "{\"id\": 1, \"to\": 999}", ":3:17: there is no node 999 in the layout\n"),
        ("b.jsonl", "{\"id\": 1, \"to\": 9, \"too\": 3}", ":3:27: unknown key too; a mission has kind, id, from"),
        ("c.jsonl", "{\"id\": 1, \"to\": 9}\n{\"id\": \"1\", \"to\": 8}", ":4:8: id: there is a mission 1 already\n"),
        ("d.jsonl", "{\"id\": 1, \"to\": 9, \"vehicle\": \"x\"}", ":3:31: there is no vehicle x\n"),
        ("e.jsonl", "{\"id\": 1}", ":3:1: to is missing\n"),
        ("f.jsonl", "{\"id\": 1, \"to\": 9", ":4:1: the text ends where "),
        (
            "g.jsonl",
            "{\"id\": 1, \"to\": 9, \"release\": 9, \"due\": 5}",
            ":3:41: due: it is due before it is released\n",
        ),
        ("h.jsonl", "{\"kind\": \"closure\", \"edge\": 1, \"at\": 0}", ":3:29: there is no edge 1 in the layout\n"),
        ("i.jsonl", "{\"kind\": \"walk\", \"id\": 1}", ":3:10: the kind walk is none of vehicle, mission"),
        ("j.jsonl", "{\"id\": 1, \"to\": 9, \"to\": 8}", ":3:"),
        ("k.jsonl", "{\"id\": 1, \"to\": 9, \"priority\": 1.5}", ":3:32: priority: a whole number"),
    ] {
        let day = missions(name, &format!("{VEHICLES}{text}\n"));
        let error = run(&["traffic", WAREHOUSE, "--missions", &day, "-q"]).failed(2);
        assert!(error.starts_with(&format!("pcr: {day}{told}")), "{name}: {error}");
    }
    for (name, text, told) in [
        (
            "a.csv",
            "kind,id,start,radius\nvehicle,v,10,0.4\nvehicle,v,11,0.4\n",
            ":3:9: id: there is a vehicle v already\n",
        ),
        ("b.csv", "kind,id,start,radius\nvehicle,v,10,ten\n", ":2:14: radius: a number from"),
        ("c.csv", "kind,id,start,radius\nvehicle,v,10,0.4,7\n", ":2:18: 5 cells, and 4 columns\n"),
        ("d.csv", "id,to\n1,9\n", ": there is no vehicle; add lines of the kind vehicle, or --vehicles FILE\n"),
        ("e.csv", "kind,id,start,radius\nvehicle,v,10,0.4\n", ": there is no mission\n"),
    ] {
        let day = missions(name, text);
        let error = run(&["traffic", WAREHOUSE, "--missions", &day, "-q"]).failed(2);
        assert!(error.starts_with(&format!("pcr: {day}{told}")), "{name}: {error}");
    }
    // A size is not guessed, and two vehicles do not stand at one place.
    let no_size = missions("size.jsonl", "{\"kind\": \"vehicle\", \"id\": 1, \"start\": 10}\n{\"id\": 1, \"to\": 9}\n");
    let error = run(&["traffic", WAREHOUSE, "--missions", &no_size, "-q"]).failed(2);
    assert!(error.contains("the size of the vehicle is not in the file"), "{error}");
    let near = missions(
        "near.jsonl",
        &format!(
            "{VEHICLES}{{\"kind\": \"vehicle\", \"id\": 3, \"start\": 37, \"radius\": 0.2}}\n{{\"id\": 1, \"to\": 9}}\n"
        ),
    );
    let error = run(&["traffic", WAREHOUSE, "--missions", &near, "-q"]).failed(2);
    assert!(error.contains("vehicles robot and 3 touch where they start"), "{error}");
}
