//! `pcr locks --write` and `--audit`: files for fleets, what is told about them, and exit status.

use crate::fixture::{directory, file, run, run_with};
use serde_json::{Value, json};
use std::fs;

fn real(name: &str) -> String {
    format!("{}/../tests/data/real/{name}", env!("CARGO_MANIFEST_DIR"))
}

/// A place for a written file.
fn output(name: &str) -> String {
    directory("exclusions").join(name).to_str().unwrap().to_owned()
}

#[test]
fn what_is_written_passes_the_audit_that_its_layout_fails() {
    let cases = [
        ("nav2/warehouse_graph.geojson", "nav2", "guarded.geojson"),
        ("rmf/office.building.yaml", "rmf", "guarded.building.yaml"),
        ("nav2/sample_graph.geojson", "vda5050", "zones.json"),
        ("lif/example_07.lif.json", "pcr", "locks.json"),
    ];
    for (layout, target, name) in cases {
        let (layout, written) = (real(layout), output(name));
        let options = ["--radius", "0.4", "-q"];
        let write = ["locks", &layout, "--write", target, "-o", &written, "--json"];
        let report: Value = serde_json::from_str(&run(&[&write[..], &options].concat()).out).unwrap();
        assert_eq!(report["exclusions"], target);
        assert!(report["can_touch"].as_u64() > Some(2) && report["groups"].as_u64() > Some(1), "{report}");
        let beside = format!("--audit={written}");
        let audit = match target {
            "vda5050" | "pcr" => run(&[&["locks", &layout, &beside, "--json"][..], &options].concat()),
            _ => run(&[&["locks", &written, "--audit", "--json"][..], &options].concat()),
        };
        let found: Value = serde_json::from_str(&audit.out).unwrap();
        assert_eq!((audit.status, found["gaps"].as_array().unwrap().len()), (0, 0), "{layout}");
        assert_eq!(found["can_touch"], report["can_touch"]);
        if !matches!(target, "vda5050" | "pcr") {
            assert_eq!(run(&[&["locks", &layout, "--audit"][..], &options].concat()).status, 1, "{layout}");
        }
    }
}

#[test]
fn an_audit_names_places_and_depths_and_draws_them() {
    let pictures = directory("exclusions").join("pictures");
    let layout = real("rmf/office.building.yaml");
    let audit = run(&["locks", &layout, "--radius", "0.4", "--audit", "-o", pictures.to_str().unwrap()]);
    assert_eq!(audit.status, 1);
    let expected = "\
office: audit of 0 groups of rmf, radius 0.4 m
  pairs that can touch: 139, not excluded: 139 (30 of one edge, 104 with a common node, 5 apart)
";
    assert!(audit.out.starts_with(expected), "{}", audit.out);
    assert!(audit.out.contains("  L1/21       L1/22  apart         0.093  18.798  -10.726\n"), "{}", audit.out);
    let page = fs::read_to_string(pictures.join("audit.html")).unwrap();
    assert!(page.contains("\"gaps\":[") && page.contains("draw_layers"));
    let svg = fs::read_to_string(pictures.join("audit.svg")).unwrap();
    assert!(svg.contains("139 pairs that can touch") && !svg.contains("NaN"));
    let csv = run(&["locks", &layout, "--radius", "0.4", "--audit", "--format", "csv"]);
    let lines: Vec<&str> = csv.out.lines().collect();
    assert_eq!((lines[0], lines.len()), ("finding,a,b,relation,a_from,a_to,b_from,b_to,x,y,depth", 140));
    assert!(lines[1..].iter().all(|line| line.starts_with("open,") && line.matches(',').count() == 10));
}

/// As for the route server, the map of nodes is their frame; of nodes without one it is `map`.
#[test]
fn zone_sets_are_of_the_frame_of_the_nodes() {
    for (frame, map) in [(json!("floor7"), "floor7"), (Value::Null, "map"), (json!(""), "map")] {
        let mut graph: Value =
            serde_json::from_str(&fs::read_to_string(real("nav2/sample_graph.geojson")).unwrap()).unwrap();
        for feature in graph["features"].as_array_mut().unwrap() {
            feature["properties"]["frame"] = frame.clone();
        }
        let (layout, written) = (file("exclusions", "framed.geojson", graph.to_string()), output("framed-zones.json"));
        let options = ["locks", &layout, "--radius", "0.3", "-q"];
        run(&[&options[..], &["--write", "vda5050", "-o", &written]].concat()).ok();
        let zones: Value = serde_json::from_str(&fs::read_to_string(&written).unwrap()).unwrap();
        assert_eq!(zones["zoneSet"]["mapId"], map);
        run(&[&options[..], &[&format!("--audit={written}")]].concat()).ok();
        let other =
            file("exclusions", "other-zones.json", zones.to_string().replace(&format!("\"{map}\""), "\"hall\""));
        let message = run(&[&options[..], &[&format!("--audit={other}")]].concat()).failed(2);
        assert!(message.ends_with(&format!("mapId: the layout has no map hall; it has {map}\n")), "{message}");
        let nodes = run(&["nodes", &layout, "--json", "-q"]).json();
        assert_eq!((&nodes["levels"], &nodes["nodes"][0]["level"]), (&json!([map]), &json!(map)));
        assert!(run(&["certify", &layout, "--radius", "0.3", "-q", "--json"]).json()["name"] == "framed");
    }
}

#[test]
fn what_cannot_be_done_is_refused() {
    let (nav2, lif, written) = (real("nav2/sample_graph.geojson"), real("lif/example_07.lif.json"), output("none"));
    for (arguments, reason) in [
        (&["locks", &lif, "--radius", "0.4", "--audit", "-q"][..], "files of this format hold no exclusions"),
        (
            &["locks", &nav2, "--radius", "0.4", &format!("--audit={lif}"), "-q"],
            "neither a zone set of VDA 5050 nor a lock file",
        ),
        (
            &["locks", &nav2, "--radius", "0.4", &format!("--audit={nav2}"), "-q"],
            "is audited without another file: --audit",
        ),
        (&["locks", &nav2, "--radius", "0.4", "--write", "rmf", "-o", &written, "-q"], "written into files of rmf"),
        (&["locks", &nav2, "--radius", "0.4", "--write", "pcr", "--split", "1", "-o", &written, "-q"], "--split"),
        (
            &["locks", &nav2, "--radius", "0.4", "--write", "nav2", "--envelopes", "a", "-o", &written, "-q"],
            "--envelopes",
        ),
    ] {
        let message = run(arguments).failed(2);
        assert!(message.contains(reason), "{message}");
    }
    assert_eq!(run(&["locks", &nav2, "--radius", "0.4", "--write", "nav2"]).status, 2, "without a file");
    // The same of a layout that comes in by a pipe.
    let piped = |more: &[&str]| {
        let write = ["locks", "-", "--from", "nav2", "--write", "nav2", "-q"];
        run_with(&[&write[..], more].concat(), &fs::read(&nav2).unwrap()).failed(2)
    };
    let message = piped(&["--radius", "0.4", "--speed", "1", "-o", &written]);
    assert!(message.contains("--speed has no effect"), "{message}");
    let fleet = file("exclusions", "fleet.json", "{ \"physicalParameters\": { \"length\": 1, \"width\": 0.5 } }");
    let message = piped(&["--fleet", &fleet, "-o", &fleet]);
    assert!(message.contains(&fleet) && fs::read_to_string(&fleet).unwrap().contains("physical"), "{message}");
    assert!(!std::path::Path::new(&written).exists());
}

/// Vehicles that round corners leave the edges there: by R (1 - cos(a/2)) in a turn by a, if there is room for the arc.
#[test]
fn locks_include_rounded_corners_if_that_is_asked_for() {
    // Two edges of 5 m at a right angle, both ways, and two edges beside them; no way leads from one to the other.
    let (edge, node) = (
        |id: u32, from: u32, to: u32| {
            json!({ "type": "Feature", "properties": { "id": id, "startid": from, "endid": to },
            "geometry": { "type": "LineString", "coordinates": [] } })
        },
        |id: u32, x: f64, y: f64| {
            json!({ "type": "Feature", "properties": { "id": id },
            "geometry": { "type": "Point", "coordinates": [x, y] } })
        },
    );
    let features = [
        node(0, 0.0, 0.0),
        node(1, 5.0, 0.0),
        node(2, 5.0, 5.0),
        node(3, 0.0, 0.7),
        node(4, 4.0, 0.7),
        edge(10, 0, 1),
        edge(11, 1, 2),
        edge(12, 2, 1),
        edge(13, 1, 0),
        edge(14, 3, 4),
    ];
    let name =
        file("exclusions", "corner.geojson", json!({ "type": "FeatureCollection", "features": features }).to_string());
    let locks = |more: &[&str]| {
        let run = run(&[&["locks", &name, "--radius", "0.3", "--json"], more].concat());
        assert_eq!((run.status, run.err.as_str()), (0, ""), "{more:?}");
        serde_json::from_str::<Value>(&run.out).unwrap()
    };
    let pairs = |table: &Value| -> Vec<[u64; 2]> {
        let all = table["locks"].as_array().unwrap().iter();
        all.map(|lock| ["a", "b"].map(|end| lock[end].as_u64().unwrap())).collect()
    };
    // nav2 does not round corners by default, and nothing is said.
    let none = locks(&[]);
    assert!(!pairs(&none).contains(&[10, 14]) && none["vehicle"]["corner_margin"].is_null());
    for radius in ["0", "5.1"] {
        assert_eq!(locks(&["--corner-radius", radius]), none, "{radius}");
    }
    let rounded = locks(&["--corner-radius", "1"]);
    let margin = 1.0 - 0.5_f64.sqrt();
    assert!((rounded["vehicle"]["corner_margin"].as_f64().unwrap() - margin).abs() < 1e-9, "{rounded}");
    // The edge beside it is 0.7 m away, and 0.6 m are two radii.
    assert!(pairs(&rounded).contains(&[10, 14]) && pairs(&rounded).contains(&[13, 14]), "{rounded}");
    // As with a margin of as much, which all edges of the corner have.
    let wider = locks(&["--margin", &margin.to_string()]);
    let of = |table: &Value| -> Vec<Value> {
        let all = table["locks"].as_array().unwrap().iter();
        all.filter(|lock| lock["b"] != json!(14)).cloned().collect()
    };
    let (own, with_margin) = (of(&rounded), of(&wider));
    assert_eq!(own.len(), with_margin.len());
    for (own, wider) in own.iter().zip(&with_margin) {
        for side in ["a_length", "b_length"] {
            for end in 0..2 {
                let [own, wider] = [own, wider].map(|lock| lock[side][end].as_f64().unwrap());
                assert!((own - wider).abs() < 1e-6, "{own} {wider}");
            }
        }
    }
    // Everything that is about locks takes it, and says it.
    let (guarded, index) = (output("corners.geojson"), output("corners.locks"));
    let text = "up to 0.293 m more for rounded corners";
    let rounding = ["--radius", "0.3", "--corner-radius", "1"];
    let printed = |arguments: &[&str]| {
        let run = run(&[arguments, &rounding].concat());
        assert_eq!(run.status, 0, "{arguments:?}: {}{}", run.out, run.err);
        format!("{}{}", run.out, run.err)
    };
    assert!(printed(&["locks", &name]).contains(text));
    assert!(printed(&["locks", &name, "--write", "nav2", "-o", &guarded]).contains(text));
    assert!(printed(&["locks", &guarded, "--audit"]).contains(text));
    printed(&["certify", &name]);
    // A file for vehicles that keep to their edges does not suffice for those that round corners; a table of locks is of one of both.
    let keep = run(&["locks", &name, "--radius", "0.3", "--write", "nav2", "-o", &guarded]);
    assert_eq!(keep.status, 0, "{}", keep.err);
    assert_eq!(run(&[&["locks", &guarded, "--audit"], &rounding[..]].concat()).status, 1);
    printed(&["locks", &name, "--index", &index]);
    printed(&["locks", &name, "--index", &index, "--edge", "10"]);
    let other = run(&["locks", &name, "--radius", "0.3", "--index", &index, "--edge", "10"]).failed(2);
    assert!(other.contains("another layout or vehicle"), "{other}");
}

/// openTCS reads models by these schemas. Of 0.0.2 there were several: the first one wants numbers, and knows no types of blocks.
#[test]
#[ignore = "needs xmllint (Debian's package libxml2-utils)"]
fn plant_models_of_every_version_are_valid() {
    let small =
        |version: &str| format!("{}/../tests/data/small/opentcs/plant-{version}.xml", env!("CARGO_MANIFEST_DIR"));
    let versions = ["0.0.1", "0.0.2", "0.0.3", "0.0.4", "0.0.5", "6.0.0", "7.0.0"];
    let mut models: Vec<(String, Vec<String>)> =
        versions.iter().map(|version| (small(version), vec![format!("model-{version}.xsd")])).collect();
    models[1].1.push("model-0.0.2-first.xsd".to_owned());
    models.push((real("opentcs/Demo-01.xml"), vec!["model-7.0.0.xsd".to_owned()]));
    let cut = ["--split", "2", "--envelopes", "pcr"];
    for (layout, schemas) in &models {
        for (name, more) in
            [("blocks.xml", &[][..]), ("envelopes.xml", &cut[2..]), ("cut.xml", &cut[..2]), ("cut-envelopes.xml", &cut)]
        {
            let written = output(name);
            let write = ["locks", layout, "--radius", "0.9", "--write", "opentcs", "-o", &written, "-q"];
            let run = run(&[&write[..], more].concat());
            if run.status == 2 && more.contains(&"--envelopes") {
                assert!(run.err.contains("have none") && layout.contains("plant-0.0."), "{}", run.err);
                continue;
            }
            assert_eq!(run.status, 0, "{}", run.err);
            assert_ne!(fs::read_to_string(&written).unwrap(), fs::read_to_string(layout).unwrap());
            for schema in schemas {
                let mut xmllint = std::process::Command::new("xmllint");
                xmllint.args(["--noout", "--schema", &real(&format!("opentcs/{schema}")), &written]);
                let Ok(output) = xmllint.output() else { panic!("xmllint (libxml2-utils) is needed for this test") };
                assert!(output.status.success(), "{layout}: {}", String::from_utf8_lossy(&output.stderr));
            }
        }
    }
}

/// Two lanes 1.1 m apart, of which a radius of 0.6 m makes one group.
fn lanes() -> String {
    let node = |id: u32, x: f64, y: f64| json!({ "type": "Feature", "properties": { "id": id }, "geometry": { "type": "Point", "coordinates": [x, y] } });
    let edge = |id: u32, from: u32, to: u32| {
        json!({ "type": "Feature", "properties": { "id": id, "startid": from, "endid": to },
            "geometry": { "type": "MultiLineString", "coordinates": [] } })
    };
    let features =
        [node(0, 0.0, 0.0), node(1, 10.0, 0.0), node(2, 0.0, 1.1), node(3, 10.0, 1.1), edge(10, 0, 1), edge(11, 2, 3)];
    json!({ "type": "FeatureCollection", "features": features }).to_string()
}

/// A radius of 0.5 m was guessed, in silence.
#[test]
fn what_others_rely_on_has_no_assumed_size() {
    let (layout, written) = (file("exclusions", "lanes.geojson", lanes()), output("sized.geojson"));
    // Of an earlier run.
    let _ = fs::remove_file(&written);
    for arguments in [
        &["locks", &layout, "--write", "nav2", "-o", &written][..],
        &["locks", &layout, "--write", "vda5050", "-o", &written],
        &["locks", &layout, "--write", "pcr", "-o", &written],
        &["locks", &layout, "--audit"],
        &["locks", &layout, "--delays", "--speed", "1"],
        &["traffic", &layout, "--agents", "1"],
        &["traffic", &layout, "--agents", "1", "--hours", "0.01"],
    ] {
        for quiet in [&[][..], &["-q"]] {
            let refused = run(&[arguments, quiet].concat());
            assert_eq!(refused.status, 2, "{arguments:?}");
            let message = refused.err;
            assert!(
                message.contains("the size of the vehicle is not in the file") && message.contains("give --radius M"),
                "{message}"
            );
            assert!(!std::path::Path::new(&written).exists(), "{arguments:?}");
        }
    }
    // It is in the file of the vehicle, or an option.
    let fleet = file("exclusions", "sized.json", "{ \"physicalParameters\": { \"length\": 1, \"width\": 0.5 } }");
    run(&["locks", &layout, "--fleet", &fleet, "--write", "nav2", "-o", &written, "-q"]).ok();
    let text = fs::read_to_string(&written).unwrap();
    assert!(text.contains("\"source\": \"fleet\", \"outline\": [["), "{text}");
    // A list of locks for a person to look at still says what it assumes.
    assert!(run(&["locks", &layout]).err.contains("radius [m] 0.5"));
}

#[test]
fn a_written_file_says_for_which_vehicle_it_is_and_an_audit_compares_it() {
    let lanes = file("exclusions", "stamped.geojson", lanes());
    let plant =
        |version: &str| format!("{}/../tests/data/small/opentcs/plant-{version}.xml", env!("CARGO_MANIFEST_DIR"));
    let by = format!(
        "\"by\": \"pcr {}\", \"radius\": 0.6, \"margin\": 0.05, \"source\": \"option\"}}",
        env!("CARGO_PKG_VERSION")
    );
    let quoted = by.replace('"', "&quot;");
    let descriptor = format!("\"zoneSetDescriptor\": \"{{{}\"", by.replace('"', "\\\""));
    for (layout, target, name, place) in [
        (lanes.clone(), "nav2", "stamped.out.geojson", format!("\"pcr_vehicle\": {{{by}")),
        (real("rmf/office.building.yaml"), "rmf", "stamped.building.yaml", format!("pcr_vehicle: {{{by}")),
        (plant("0.0.2"), "opentcs", "stamped-2.xml", format!("<!-- pcr:vehicle {{{by} -->")),
        (plant("0.0.3"), "opentcs", "stamped-3.xml", format!("<property name=\"pcr:vehicle\" value=\"{{{quoted}\"/>")),
        (plant("7.0.0"), "opentcs", "stamped-7.xml", format!("<property name=\"pcr:vehicle\" value=\"{{{quoted}\"/>")),
        (lanes.clone(), "vda5050", "stamped.zones.json", descriptor),
        (lanes, "pcr", "stamped.locks.json", format!("\"written\": {{{by}")),
    ] {
        let written = output(name);
        let vehicle = ["--radius", "0.6", "--margin", "0.05", "-q"];
        run(&[&["locks", &layout, "--write", target, "-o", &written][..], &vehicle].concat()).ok();
        let text = fs::read_to_string(&written).unwrap();
        assert_eq!(text.matches(&place).count(), 1, "{target}: {place}\n{text}");
        let beside = format!("--audit={written}");
        let audit = match target {
            "vda5050" | "pcr" => ["locks", &layout, &beside, "--json"],
            _ => ["locks", &written, "--audit", "--json"],
        };
        let told = |vehicle: &[&str]| {
            let answer = run(&[&audit[..], vehicle].concat()).out;
            let answer: Value = serde_json::from_str(&answer).unwrap();
            assert_eq!(answer["written_for"]["radius"], 0.6, "{target}");
            let lines = answer["warnings"].as_array().unwrap().clone();
            // The stamp is a key that is known.
            let is_about_it = |line: &str| line.contains("were written for") || line.contains("pcr_vehicle");
            lines.iter().filter(|line| is_about_it(line.as_str().unwrap())).cloned().collect::<Vec<_>>()
        };
        assert_eq!(told(&vehicle), Vec::<Value>::new(), "{target}");
        for other in [&["--radius", "0.7", "--margin", "0.05", "-q"][..], &["--radius", "0.6", "-q"]] {
            let lines = told(other);
            assert_eq!(lines.len(), 1, "{target}: {lines:?}");
            let line = lines[0].as_str().unwrap();
            assert!(
                line.starts_with("the exclusions were written for radius 0.6 m and margin 0.05 m, by pcr "),
                "{line}"
            );
        }
        if target == "nav2" || target == "opentcs" || target == "rmf" {
            // Written again it is replaced.
            run(&[&["locks", &written, "--write", target, "-o", &written][..], &vehicle].concat()).ok();
            assert_eq!(fs::read_to_string(&written).unwrap(), text, "{target}");
        }
    }
    // What cannot be read is told.
    let text =
        fs::read_to_string(output("stamped.out.geojson")).unwrap().replace("\"radius\": 0.6", "\"radius\": \"0.6\"");
    let audit = run(&["locks", &file("exclusions", "damaged.geojson", text), "--audit", "--radius", "0.6"]);
    assert!(audit.out.contains("for which vehicle the exclusions were written cannot be read: {"), "{}", audit.out);
}

/// One mutex was asked about, and 28 lines were the answer.
#[test]
fn an_audit_is_of_the_edges_and_nodes_that_are_asked_about() {
    let dock = "building_name: dock\nlevels:\n  L1:\n    lanes:\n    - [0, 1, {mutex: dock}]\n    - [1, 0, {mutex: dock}]\n    - [2, 0, {}]\n    \
                - [0, 2, {}]\n    - [3, 0, {}]\n    - [0, 3, {}]\n    vertices:\n    - [0, 0, {name: pre_dock}]\n    \
                - [0, 3, {name: dock, mutex: dock}]\n    - [-4, 0, {name: west}]\n    - [4, 0, {name: east}]\n";
    let dock = file("exclusions", "dock.yaml", dock);
    let audit = |more: &[&str]| {
        let run = run(&[&["locks", &dock, "--radius", "0.3", "--audit", "--json", "-q"], more].concat());
        let answer: Value = serde_json::from_str(&run.out).unwrap();
        let gaps = answer["gaps"].as_array().unwrap().clone();
        assert_eq!(run.status, i32::from(!gaps.is_empty()));
        (answer, gaps)
    };
    let (all, every) = audit(&[]);
    assert!(every.len() > 20 && all.get("selected").is_none(), "{all}");
    let has = |gap: &Value, kind: &str, id: &str| gap["a"][kind] == id || gap["b"][kind] == id;
    for (more, kept) in [
        (&["--edge", "L1/0"][..], &[("edge", "L1/0")][..]),
        (&["--edge", "L1/0", "--edge", "L1/1"], &[("edge", "L1/0"), ("edge", "L1/1")]),
        (&["--node", "L1/1"], &[("node", "L1/1")]),
        (&["--node", "west", "--edge", "L1/4"], &[("node", "L1/2"), ("edge", "L1/4")]),
    ] {
        let (answer, gaps) = audit(more);
        let expected: Vec<Value> =
            every.iter().filter(|gap| kept.iter().any(|(kind, id)| has(gap, kind, id))).cloned().collect();
        assert_eq!(gaps, expected, "{more:?}");
        assert_eq!(answer["selected"].as_array().unwrap().len(), kept.len());
        assert!(answer["can_touch"].as_u64() < all["can_touch"].as_u64());
    }
    // The mutex keeps its node and its two lanes apart.
    assert_eq!(audit(&["--node", "dock"]).1.len(), 0);
    for (more, reason) in [
        (&["--audit", "--edge", "L1/9"][..], "--edge L1/9: there is no such edge"),
        (&["--audit", "--node", "south"], "--node south: there is no such node"),
        (&["--node", "dock"], "an audit is of some nodes"),
        (&["--edge", "L1/0", "--edge", "L1/1"], "--edge: locks are listed of one edge"),
    ] {
        let refused = run(&[&["locks", &dock, "--radius", "0.3", "-q"], more].concat());
        assert!(refused.status == 2 && refused.err.contains(reason), "{} {}", refused.status, refused.err);
    }
}
