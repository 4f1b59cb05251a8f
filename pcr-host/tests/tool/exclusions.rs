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

/// Routes of nav2 leave the edges at corners, and locks are of the edges.
#[test]
fn that_routes_round_corners_is_said_by_whoever_looks_at_edges() {
    let (nav2, lif, written) =
        (real("nav2/sample_graph.geojson"), real("lif/example_07.lif.json"), output("said.geojson"));
    let corners = "corners: routes round them with 1 m, off their edges by up to";
    let count = |arguments: &[&str]| run(&[arguments, &["--radius", "0.3"]].concat()).err.matches(corners).count();
    let write = ["locks", &nav2, "--write", "nav2", "-o", &written];
    for arguments in [
        &["locks", &nav2][..],
        &["locks", &nav2, "--format", "csv"],
        &["locks", &nav2, "--json"],
        &["locks", &nav2, "--lines"],
        &write,
        &["locks", &written, "--audit"],
        &["certify", &nav2],
    ] {
        assert_eq!(count(arguments), 1, "{arguments:?}");
        assert_eq!(count(&[arguments, &["-q"]].concat()), 0, "{arguments:?}");
    }
    assert_eq!(count(&["locks", &lif]), 0);
    // A layout that comes in by a pipe.
    let layout = fs::read_to_string(&nav2).unwrap();
    let piped = run_with(
        &["locks", "-", "--radius", "0.3", "--from", "nav2", "--write", "nav2", "-o", &written],
        layout.as_bytes(),
    );
    assert_eq!((piped.status, piped.err.matches(corners).count()), (0, 1), "{}", piped.err);
    for asked in [&["locks", &written, "--audit", "--json"][..], &[&write[..], &["--json"]].concat()] {
        let report: Value = serde_json::from_str(&run(&[asked, &["--radius", "0.3"]].concat()).out).unwrap();
        let warnings = report["warnings"].as_array().unwrap();
        assert!(warnings.iter().any(|said| said.as_str().unwrap().contains(corners)), "{report}");
    }
}

/// openTCS reads models by this schema.
#[test]
#[ignore = "needs xmllint (Debian's package libxml2-utils)"]
fn plant_models_are_valid() {
    let layout = real("opentcs/Demo-01.xml");
    let cut = ["--split", "2", "--envelopes", "pcr"];
    for (name, more) in
        [("blocks.xml", &[][..]), ("envelopes.xml", &cut[2..]), ("cut.xml", &cut[..2]), ("cut-envelopes.xml", &cut)]
    {
        let written = output(name);
        let write = ["locks", &layout, "--radius", "0.9", "--write", "opentcs", "-o", &written, "-q"];
        assert_eq!(run(&[&write[..], more].concat()).status, 0);
        assert_ne!(fs::read_to_string(&written).unwrap(), fs::read_to_string(&layout).unwrap());
        let mut xmllint = std::process::Command::new("xmllint");
        xmllint.args(["--noout", "--schema", &real("opentcs/model-7.0.0.xsd"), &written]);
        let Ok(output) = xmllint.output() else { panic!("xmllint (libxml2-utils) is needed for this test") };
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    }
}
