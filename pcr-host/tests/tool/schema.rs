//! The schemas in `docs/reference/schema` against what the tool reads and writes.

use crate::fixture::{PAPER, crossing, file, run, run_with, straight};
use serde_json::{Value, json};
use std::fs;
use std::path::{Path, PathBuf};

const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/..");

fn schema(format: &str) -> Value {
    let path = format!("{ROOT}/docs/reference/schema/{format}.schema.json");
    serde_json::from_str(&fs::read_to_string(path).unwrap()).unwrap()
}

/// The same schema for this version of the tool alone: a field that is not in it is a fault.
fn closed(mut schema: Value) -> Value {
    fn close(value: &mut Value) {
        match value {
            Value::Object(members) => {
                if members.contains_key("properties") {
                    members.entry("additionalProperties").or_insert(json!(false));
                }
                members.values_mut().for_each(close);
            }
            Value::Array(elements) => elements.iter_mut().for_each(close),
            _ => {}
        }
    }
    close(&mut schema);
    schema
}

fn faults(schema: &Value, document: &Value) -> Vec<String> {
    let validator = jsonschema::draft202012::new(schema).unwrap();
    validator.iter_errors(document).map(|error| format!("{}: {error}", error.instance_path())).collect()
}

#[track_caller]
fn fits(document: &str) -> String {
    let document: Value = serde_json::from_str(document).unwrap_or_else(|error| panic!("{error}: {document}"));
    let format = document["format"].as_str().unwrap();
    assert_eq!(faults(&closed(schema(format)), &document), Vec::<String>::new(), "{format}");
    format.to_owned()
}

fn real(name: &str) -> String {
    format!("{ROOT}/tests/data/real/{name}")
}

fn small(name: &str) -> String {
    format!("{ROOT}/tests/data/small/{name}")
}

#[test]
fn every_output_fits_its_schema() {
    let (layout, lif) = (real("nav2/aws_graph.geojson"), real("lif/example_07.lif.json"));
    let mut labelled = crossing();
    labelled["agents"][0]["label"] = json!("AGV-7");
    let labelled = file("schema", "labelled.json", labelled.to_string());
    let outlines = format!("{ROOT}/tests/data/small/outlines.json");
    let stuck = json!({ "agents": [straight(1, [0.0, 0.0, 0.0], 4.0), straight(2, [4.0, 0.0, 3.2], 4.0)] });
    let stuck = file("schema", "stuck.json", stuck.to_string());
    let (plant, blocks) = (real("opentcs/Demo-01.xml"), file("schema", "blocks.xml", String::new()));
    let mut formats: Vec<String> = Vec::new();
    let day = r#"{"kind": "vehicle", "id": 1, "start": 0, "radius": 0.3}
        {"kind": "vehicle", "id": 2, "start": 5, "radius": 0.3}
        {"id": 1, "to": 5, "via": [3], "due": 9}
        {"id": 2, "to": 0, "vehicle": 2}
        {"kind": "closure", "node": 7, "at": 3, "until": 9}
        {"kind": "closure", "edge": 100, "at": 3, "speed": 0.2}
        {"kind": "breakdown", "vehicle": 1, "at": 5}"#;
    let lines: Vec<Value> = day.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert_eq!(lines.iter().flat_map(|line| faults(&closed(schema("pcr-mission-lines")), line)).count(), 0);
    formats.push("pcr-mission-lines".into());
    let day = file("schema", "day.jsonl", day);
    let closed = file("schema", "closed.jsonl", r#"{"node": 7, "at": 3}"#);
    let broken = file("schema", "broken.jsonl", r#"{"vehicle": 1, "at": 50, "until": 90}"#);
    for arguments in [
        &["regions", PAPER, "--slices", "2", "--margin", "0.05"][..],
        &["regions", &labelled],
        &["regions", &outlines, "--scalar", "q16"],
        &["check", PAPER, "--closest"],
        &["check", &labelled],
        &["check", PAPER, "--certify"],
        &["check", &small("schedule.yaml"), "--radius", "0.35", "--closest"],
        &["check", &small("messages.log"), "--radius", "0.4", "--top-speed", "2"],
        &["check", &small("held.log"), "--radius", "0.4", "--top-speed", "2"],
        &["regions", PAPER, "--certificate"],
        &["regions", PAPER, "--certificate", "--agent", "3"],
        &["certify", PAPER, "--limit"],
        &["certify", &labelled],
        &["plan", PAPER],
        &["plan", &labelled, "--method", "speed"],
        &["plan", &stuck],
        &["simulate", &labelled],
        &["compare", &labelled, "--method", "polyline", "--rounds", "1"],
        &["locks", &layout, "--radius", "0.3", "--nodes"],
        &["locks", &lif, "--radius", "0.3"],
        &["locks", &layout, "--radius", "0.3", "--nodes", "--edge", "26"],
        &["locks", &layout, "--radius", "0.3", "--nodes", "--delays", "--speed", "1"],
        &["locks", &layout, "--radius", "0.3", "--delays", "--speed", "1", "--certify"],
        &["locks", &plant, "--radius", "0.9", "--write", "opentcs", "--split", "2", "-o", &blocks],
        &["locks", &plant, "--radius", "0.9", "--audit"],
        &["traffic", &layout, "--radius", "0.3", "--agents", "5"],
        &["traffic", &layout, "--radius", "0.3", "--agents", "3", "--hours", "0.01", "--compare"],
        &["traffic", &layout, "--missions", &day],
        &[
            &["traffic", &layout, "--radius", "0.3", "--agents", "3", "--active", "2", "--hours", "0.05"][..],
            &["--closures", &closed, "--breakdowns", &broken],
        ]
        .concat(),
        &["nodes", &layout],
        &["nodes", &lif],
        &["nodes", &real("opendrive/Town02.planview.xodr")],
        &["nodes", &real("rmf/office.building.yaml")],
    ] {
        let run = run(&[arguments, &["--json", "-q"]].concat());
        assert!(run.status < 2 || run.status == 4, "{arguments:?}: {}", run.err);
        formats.push(fits(&run.out));
    }
    for refused in [&["regions", "-"][..], &["check", "-"]] {
        fits(&run_with(&[refused, &["--json"]].concat(), b"{}\n").out);
    }
    formats.push(fits(&run(&["plan", &labelled, "-o", "-", "-q"]).out));
    formats.push(fits(&run(&["demo", "--scenario"]).out));
    let lock_file = ["locks", &layout, "--radius", "0.3", "--write", "pcr", "-o", "-", "-q"];
    formats.push(fits(&run(&lock_file).out));
    let factsheet = format!("{ROOT}/tests/data/small/factsheet.json");
    formats.push(fits(&run(&["import", "nav2", &layout, "--route", "0:1", "--fleet", &factsheet, "-q"]).out));
    let routes = ["import", "nav2", &layout, "--route", "0:1", "--radius", "0.3", "-q"];
    formats.push(fits(&run(&routes).out));
    let delays = ["locks", &layout, "--radius", "0.3", "--lines", "-q", "--delays", "--speed", "1"];
    formats.push(fits(run(&delays).out.lines().next().unwrap()));
    let lines = run(&["locks", &layout, "--radius", "0.3", "--lines", "-q"]).out;
    formats.push(fits(lines.lines().next().unwrap()));
    formats.extend(simulated());
    // There is no schema of which nothing was seen.
    let mut there: Vec<String> = fs::read_dir(format!("{ROOT}/docs/reference/schema"))
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    // Lines of `pcr serve`: pcr-host/serve/tests/lines.rs.
    there.retain(|name| name != "pcr-serve.schema.json");
    there.sort();
    formats.sort();
    formats.dedup();
    assert_eq!(there, formats.iter().map(|format| format!("{format}.schema.json")).collect::<Vec<_>>());
}

/// What `pcr fleet` writes.
fn simulated() -> Vec<String> {
    let layout = real("nav2/aws_graph.geojson");
    let (vehicles, record) = (file("schema", "vehicles.json", ""), file("schema", "record.txt", ""));
    let fleet = ["fleet", &layout, "--vehicles", "3", "--alone", "supervisor", "--time", "20"];
    run(&[&fleet[..], &["--profiles", &vehicles, "--record", &record, "-q"]].concat()).ok();
    let lines = fs::read_to_string(&record).unwrap();
    let [first, .., last] = lines.lines().collect::<Vec<_>>()[..] else { panic!("{lines}") };
    // The other lines are described beside the first one.
    let described = &schema("pcr-record")["$defs"];
    let line = lines.lines().nth(1).unwrap();
    for (name, line) in [("position", line), ("end", last)] {
        let line: Value = serde_json::from_str(line).unwrap();
        assert_eq!(faults(&closed(described[name].clone()), &line), Vec::<String>::new(), "{name}");
    }
    let certified = run(&["fleet", "--certify", &record]).ok();
    vec![fits(&fs::read_to_string(vehicles).unwrap()), fits(first), fits(&certified)]
}

fn json_files(folder: &Path, files: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|extension| extension == "json") {
            files.push(path);
        }
    }
}

#[test]
fn every_scenario_of_ours_fits_its_schema() {
    let schema = schema("pcr-scenario");
    let mut files = vec![PathBuf::from(PAPER)];
    json_files(Path::new(&format!("{ROOT}/tests/data")), &mut files);
    json_files(Path::new(&format!("{ROOT}/tests/data/small")), &mut files);
    let mut scenarios = 0;
    for file in files {
        let value: Value = serde_json::from_str(&fs::read_to_string(&file).unwrap()).unwrap();
        if value["agents"].is_array() {
            assert_eq!(faults(&schema, &value), Vec::<String>::new(), "{}", file.display());
            scenarios += 1;
        }
    }
    assert!(scenarios > 6, "{scenarios}");
}

/// One change at a time to a scenario: the tool and the schema are of one mind about it.
#[test]
fn schema_and_tool_refuse_the_same_scenarios() {
    let schema = schema("pcr-scenario");
    let profile = json!({ "v0": 1, "pieces": [{ "duration": 4, "accel": 0 }] });
    let polygon = json!([{ "ahead": 1, "left": 0 }, { "ahead": 0, "left": 1 }, { "ahead": 0, "left": -1 }]);
    let changes = [
        ("/name", json!(5)),
        ("/name", json!("other")),
        ("/format", json!("pcr-scenario")),
        ("/format", json!("pcr-plan")),
        ("/version", json!(1)),
        ("/version", json!(1.0)),
        ("/version", json!(2)),
        ("/version", json!(3)),
        ("/version", json!(4)),
        ("/version", json!(5)),
        ("/version", json!(6)),
        ("/agents/0/path", json!([{ "kind": "line", "length": 1, "steady": true }])),
        ("/agents/0/path", json!([{ "kind": "line", "length": 1, "facing": 1 }])),
        ("/agents/0/path", json!([{ "kind": "line", "length": 1, "gear": "reverse" }])),
        ("/agents/0/path", json!([{ "kind": "arc", "radius": 1, "sweep": 1, "gear": "forward" }])),
        ("/units", json!("m")),
        ("/agents", json!([])),
        ("/agents", json!({})),
        ("/agents", Value::Null),
        ("/agents/0/id", json!(-1)),
        ("/agents/0/id", json!(1.5)),
        ("/agents/0/id", json!(1.0)),
        ("/agents/0/id", json!("7")),
        ("/agents/0/id", Value::Null),
        ("/agents/0/label", json!("AGV-7")),
        ("/agents/0/label", json!("a\u{1b}b")),
        ("/agents/0/label", json!("a\u{202e}b")),
        ("/agents/0/label", json!("a\u{2028}b")),
        ("/agents/0/label", json!("x".repeat(201))),
        ("/agents/0/label", json!(7)),
        ("/agents/0/radius", json!(0)),
        ("/agents/0/radius", json!("1")),
        ("/agents/0/radius", json!(1e11)),
        ("/agents/0/radius", Value::Null),
        ("/agents/0/footprint", json!({ "polygon": polygon })),
        ("/agents/0/margin", json!(0)),
        ("/agents/0/margin", json!(-0.1)),
        ("/agents/0/v_max", Value::Null),
        ("/agents/0/a_max", json!(-1)),
        ("/agents/0/t_start", json!(-5)),
        ("/agents/0/t_start", json!("now")),
        ("/agents/0/start/z", json!(1)),
        ("/agents/0/start/x", Value::Null),
        ("/agents/0/start", json!([0, 0, 0])),
        ("/agents/0/start", json!({ "x": 0, "y": 0, "heading_deg": 90 })),
        ("/agents/0/start", json!({ "x": 0, "y": 0 })),
        ("/agents/0/start/heading_deg", json!(90)),
        ("/angles", json!("radians")),
        ("/angles", json!("degrees")),
        ("/agents/0/turn_v_max_deg", json!(45)),
        ("/agents/0/turn_v_max_deg", json!(0)),
        ("/agents/0/path", json!([{ "kind": "arc", "radius": 1, "sweep_deg": -90 }])),
        ("/agents/0/path", json!([{ "kind": "arc", "radius": 1, "sweep": 1, "sweep_deg": 1 }])),
        ("/agents/0/path", json!([{ "kind": "line", "length": 1, "sweep_deg": 1 }])),
        ("/agents/0/path", json!([])),
        ("/agents/0/path", json!([{ "kind": "line" }])),
        ("/agents/0/path", json!([{ "kind": "line", "length": 0 }])),
        ("/agents/0/path", json!([{ "kind": "line", "length": 1, "sweep": 1 }])),
        ("/agents/0/path", json!([{ "kind": "arc", "radius": 0, "sweep": 1 }])),
        ("/agents/0/path", json!([{ "kind": "arc", "radius": 1, "sweep": -9 }])),
        ("/agents/0/path", json!([{ "kind": "spiral", "length": 1 }])),
        ("/agents/0/profile", profile.clone()),
        ("/agents/0/profile", json!({ "v0": -1, "pieces": [] })),
        ("/agents/0/profile", json!({ "pieces": [] })),
        ("/agents/0/loads", json!([{ "segments": [1, 1], "radius": 0.6 }])),
        ("/agents/0/loads", json!([{ "segments": [1.0, 1], "radius": 0.6 }])),
        ("/agents/0/loads", json!([{ "segments": [0, 1], "radius": 0.6 }])),
        ("/agents/0/loads", json!([{ "segments": [1, 1] }])),
        ("/agents/0/colour", json!("red")),
    ];
    let (mut accepted, mut refused) = (0, 0);
    for (pointer, value) in changes {
        let mut scenario = crossing();
        let (parent, key) = pointer.rsplit_once('/').unwrap();
        let parent = scenario.pointer_mut(parent).unwrap().as_object_mut().unwrap();
        if value.is_null() {
            parent.remove(key)
        } else {
            parent.insert(key.into(), value.clone())
        };
        let run = run_with(&["regions", "-q"], scenario.to_string().as_bytes());
        let faults = faults(&schema, &scenario);
        assert_eq!(run.status == 0, faults.is_empty(), "{pointer} {value}: {} {faults:?}", run.err);
        if faults.is_empty() { accepted += 1 } else { refused += 1 }
    }
    assert!(accepted > 8 && refused > 25, "{accepted} accepted, {refused} refused");
    for (gear, is_one) in [("reverse", true), ("forward", true), ("neutral", false)] {
        let mut scenario = crossing();
        scenario["version"] = json!(2);
        scenario["agents"][0]["path"] = json!([{ "kind": "arc", "radius": 1, "sweep": 1, "gear": gear }]);
        let run = run_with(&["regions", "-q"], scenario.to_string().as_bytes());
        assert_eq!([run.status == 0, faults(&schema, &scenario).is_empty()], [is_one; 2], "{gear}: {}", run.err);
    }
    for (keys, is_one) in [
        (json!({ "facing": 1 }), true),
        (json!({ "facing_deg": -90 }), true),
        (json!({ "facing": 1, "facing_deg": 1 }), false),
        (json!({ "facing": 1, "gear": "reverse" }), false),
        (json!({ "facing_deg": 1, "gear": "forward" }), false),
        (json!({ "facing": "1" }), false),
        (json!({ "facing": 1e11 }), false),
    ] {
        let mut scenario = crossing();
        scenario["version"] = json!(4);
        let mut segment = json!({ "kind": "line", "length": 1 });
        segment.as_object_mut().unwrap().extend(keys.as_object().unwrap().clone());
        scenario["agents"][0]["path"] = json!([segment]);
        let run = run_with(&["regions", "-q"], scenario.to_string().as_bytes());
        assert_eq!([run.status == 0, faults(&schema, &scenario).is_empty()], [is_one; 2], "{keys}: {}", run.err);
    }
    for (version, keys, is_one) in [
        (5, json!({ "steady": true }), true),
        (5, json!({ "steady": false, "facing_deg": -90 }), true),
        (5, json!({ "steady": true, "gear": "reverse" }), true),
        (5, json!({ "steady": 1 }), false),
        (4, json!({ "steady": true }), false),
        (4, json!({ "steady": false, "facing": 1 }), false),
    ] {
        for mut segment in [json!({ "kind": "line", "length": 1 }), json!({ "kind": "arc", "radius": 1, "sweep": 1 })] {
            let mut scenario = crossing();
            scenario["version"] = json!(version);
            segment.as_object_mut().unwrap().extend(keys.as_object().unwrap().clone());
            scenario["agents"][0]["path"] = json!([segment]);
            let run = run_with(&["regions", "-q"], scenario.to_string().as_bytes());
            assert_eq!([run.status == 0, faults(&schema, &scenario).is_empty()], [is_one; 2], "{keys}: {}", run.err);
        }
    }
    let line = json!({ "kind": "line", "length": 1 });
    let kink = json!([line, { "kind": "kink", "sweep": 0.5 }, line]);
    let turn = json!([{ "kind": "turn", "sweep": 1 }]);
    let turning = |key: &str| {
        let piece = |duration: f64, acceleration: f64| json!({ "duration": duration, key: acceleration });
        json!({ "v0": 0, "pieces": [piece(1.0, 1.0), piece(1.0, -1.0)] })
    };
    let cases = [(kink, None), (turn.clone(), Some(turning("turn_accel"))), (turn, Some(turning("turn_axel")))];
    for (case, (path, profile)) in cases.into_iter().enumerate() {
        for version in 1..=3 {
            let mut scenario = crossing();
            scenario["version"] = json!(version);
            scenario["agents"][0]["path"] = path.clone();
            if let Some(profile) = &profile {
                let agent = scenario["agents"][0].as_object_mut().unwrap();
                agent.retain(|key, _| !key.ends_with("_max"));
                agent.insert("profile".into(), profile.clone());
            }
            let is_one = version == 3 && case < 2;
            let run = run_with(&["regions", "-q"], scenario.to_string().as_bytes());
            let is_of_schema = faults(&schema, &scenario).is_empty();
            assert_eq!([run.status == 0, is_of_schema], [is_one; 2], "{case} {version}: {}", run.err);
        }
    }
}

#[test]
fn a_field_that_no_schema_has_is_noticed() {
    let mut verdict = run(&["check", PAPER, "--json"]).out;
    assert_eq!(fits(&verdict), "pcr-conflicts");
    verdict = verdict.replacen("\"depth\"", "\"deepness\"", 1);
    let document: Value = serde_json::from_str(&verdict).unwrap();
    assert_eq!(faults(&closed(schema("pcr-conflicts")), &document).len(), 2);
}
