//! `pcr locks`: a table for people, CSV and JSON for programs, a page.

use crate::fixture::{directory, file, run, run_with};
use serde_json::json;

const WAREHOUSE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/data/real/nav2/warehouse_graph.geojson");

/// A cross of two edges of 4 m, one of them drawn by a point in its middle.
fn cross() -> String {
    let node = |id: u32, x: f64, y: f64| json!({ "type": "Feature", "properties": { "id": id }, "geometry": { "type": "Point", "coordinates": [x, y] } });
    let edge = |id: u32, from: u32, to: u32| {
        json!({ "type": "Feature", "properties": { "id": id, "startid": from, "endid": to },
            "geometry": { "type": "MultiLineString", "coordinates": [] } })
    };
    let features =
        [node(1, -2.0, 0.0), node(2, 2.0, 0.0), node(3, 0.0, -2.0), node(4, 0.0, 2.0), edge(20, 1, 2), edge(7, 3, 4)];
    json!({ "type": "FeatureCollection", "name": "cross", "features": features }).to_string()
}

#[test]
fn json_is_as_documented() {
    let name = file("locks", "cross.geojson", cross());
    let output = run(&["locks", &name, "--radius", "0.25", "--format", "json"]);
    let table: serde_json::Value = serde_json::from_str(&output.out).unwrap();
    assert_eq!(
        table.as_object().unwrap().keys().collect::<Vec<_>>(),
        ["format", "layout", "locks", "vehicle", "version", "warnings"]
    );
    assert_eq!((&table["layout"], &table["vehicle"]), (&json!("cross"), &json!({ "name": null, "radius": 0.25 })));
    let lock = &table["locks"][0];
    assert_eq!((&lock["a"], &lock["b"], table["locks"].as_array().unwrap().len()), (&json!(7), &json!(20), 1));
    for lengths in [&lock["a_length"], &lock["b_length"]] {
        for (length, expected) in [(0, 1.5), (1, 2.5)] {
            assert!((lengths[length].as_f64().unwrap() - expected).abs() < 1e-12, "{lock}");
        }
    }
}

#[test]
fn csv_and_table() {
    let cross = cross();
    let arguments = ["locks", "-", "--from", "nav2", "--radius", "0.25", "--nodes", "--format"];
    let csv = run_with(&[&arguments[..], &["csv"]].concat(), cross.as_bytes()).out;
    let lines: Vec<&str> = csv.lines().collect();
    assert_eq!((lines[0], lines.len()), ("a,b,a_from,a_to,b_from,b_to", 6));
    assert!(lines[1].starts_with("7,20,1.") && lines[2].starts_with("node 3,7,,,0,0.5"), "{csv}");
    let table = run_with(&[&arguments[..], &["table"]].concat(), cross.as_bytes()).out;
    let expected = "\
cross: 1 lock of 1 pair of edges, radius 0.25 m
  a  b   a from [m]     to  b from [m]     to
  7  20       1.500  2.500       1.500  2.500
4 locks of nodes
  node  edge  from [m]     to
  3     7        0.000  0.500
";
    assert!(table.starts_with(expected), "{table}");
}

#[test]
fn pictures_are_written() {
    let pictures = directory("locks").join("pictures");
    let _ = std::fs::remove_dir_all(&pictures);
    let output = run(&["locks", WAREHOUSE, "--radius", "0.4", "-o", pictures.to_str().unwrap()]);
    assert_eq!(output.status, 0, "{}", output.err);
    assert!(output.out.starts_with("warehouse_graph: 544 locks of 544 pairs of edges, radius 0.4 m\n"));
    let mut names: Vec<_> = std::fs::read_dir(&pictures).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    names.sort();
    let expected: &[&str] =
        if cfg!(feature = "png") { &["layout.png", "layout.svg", "locks.html"] } else { &["layout.svg", "locks.html"] };
    assert_eq!(names, expected);
}

#[test]
fn what_is_no_layout_is_refused() {
    let scenario = file("locks", "scenario.json", crate::fixture::crossing().to_string());
    let failed = run(&["locks", &scenario]).failed(2);
    assert!(
        failed.ends_with("scenario.json: this is a scenario, with paths of its own; a layout is expected\n"),
        "{failed}"
    );
}
