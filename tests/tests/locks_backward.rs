//! Locks of vehicles that drive backward, or that leave the middle of their edges: against poses that they can have.

use pcr_formats::import::{ImportOptions, ImportedLayout, InputFormat, Warnings, layout};
use pcr_formats::scenario::PlacedSegment;
use pcr_planning::exclusion_table::ExclusionTable;
use pcr_tests::polygons::{Point, apart, placed};
use serde_json::{Value, json};
use std::f64::consts::PI;
use std::path::PathBuf;

/// The outline of a vehicle that reaches farther ahead than behind.
const LONG: [Point; 4] = [[3.0, 0.4], [-0.5, 0.4], [-0.5, -0.4], [3.0, -0.4]];

/// Its factsheet.
struct Fleet(PathBuf);

impl Fleet {
    fn new(name: &str) -> Self {
        let points = LONG.map(|[x, y]| json!({ "x": x, "y": y }));
        let sheet = json!({ "typeSpecification": { "seriesName": "Long" }, "physicalParameters": { "speedMax": 1.5, "accelerationMax": 0.5 },
            "agvGeometry": { "envelopes2d": [{ "set": "driving", "polygonPoints": points }] } });
        let file = std::env::temp_dir().join(format!("pcr-long-{name}-{}.json", std::process::id()));
        std::fs::write(&file, sheet.to_string()).unwrap();
        Self(file)
    }

    fn read(&self, format: InputFormat, text: &str) -> ImportedLayout {
        let options = ImportOptions { fleet: Some(self.0.clone()), ..ImportOptions::default() };
        layout(format, text, &options, &mut Warnings::default()).unwrap()
    }
}

impl Drop for Fleet {
    fn drop(&mut self) {
        std::fs::remove_file(&self.0).unwrap();
    }
}

/// Places along lines and arcs: lengths, points and headings.
fn poses(curve: &[PlacedSegment]) -> Vec<(f64, Point, f64)> {
    let mut poses = Vec::new();
    let mut before = 0.0;
    for piece in curve {
        let length = piece.shape.length();
        let count = (length / 0.05).ceil().max(1.0);
        for k in 0..=count as usize {
            let along = length * k as f64 / count;
            let part = piece.part(0.0, along);
            poses.push((before + along, part.end(), part.heading_at_end()));
        }
        before += length;
    }
    poses
}

/// Checks that two edges are locked wherever the outline overlaps, turned by these angles from its way; returns the number of overlaps.
fn overlaps(imported: &ImportedLayout, turned: [&[f64]; 2]) -> usize {
    let locks = ExclusionTable::compute(imported, false).unwrap().locks;
    let [a, b] = [0, 1].map(|place| {
        let edge = &imported.layout.edges[place];
        let own = poses(&edge.curve).into_iter().flat_map(|(length, at, heading)| {
            turned[place].iter().map(move |turned| (length, placed(&LONG, at, heading + turned)))
        });
        own.collect::<Vec<_>>()
    });
    let mut count = 0;
    for (length, outline) in &a {
        for (other, other_outline) in &b {
            if apart(outline, other_outline) <= 0.0 {
                let within = |[lo, hi]: [f64; 2], x: f64| lo - 1e-9 <= x && x <= hi + 1e-9;
                let is_locked =
                    locks.iter().any(|lock| within(lock.a_length, *length) && within(lock.b_length, *other));
                assert!(is_locked, "at {length} and {other}: no lock");
                count += 1;
            }
        }
    }
    count
}

fn lif(property: Value, ends: [Point; 4]) -> String {
    let node = |k: usize| {
        let [x, y] = ends[k];
        json!({ "nodeId": format!("n{k}"), "mapId": "m", "nodePosition": { "x": x, "y": y } })
    };
    let edge = |id: &str, from: usize, property: Value| json!({ "edgeId": id, "startNodeId": format!("n{from}"), "endNodeId": format!("n{}", from + 1), "vehicleTypeEdgeProperties": [property] });
    let nodes = [node(0), node(1), node(2), node(3)];
    let edges = [edge("e", 0, property), edge("s", 2, json!({ "vehicleTypeId": "f", "vehicleOrientation": 0.0 }))];
    json!({ "metaInformation": { "lifVersion": "1.0.0" }, "layouts": [{ "layoutId": "l", "nodes": nodes, "edges": edges }] })
        .to_string()
}

/// After the cusp the nose of a vehicle that drives backward had no lock.
#[test]
fn a_vehicle_may_reverse_where_its_edge_turns_back() {
    let fleet = Fleet::new("cusp");
    let points = [[0, 0], [10, 0], [10, 5], [10, 0], [20, 0]].map(|[x, y]| json!({ "x": x, "y": y }));
    let curve = json!({ "degree": 2, "knotVector": [0, 0, 0, 0.5, 0.5, 1, 1, 1], "controlPoints": points });
    let ends = [[0.0, 0.0], [20.0, 0.0], [10.0, 8.0], [14.0, 8.0]];
    let text = lif(json!({ "vehicleTypeId": "f", "rotationAllowed": false, "trajectory": curve }), ends);
    let imported = fleet.read(InputFormat::Lif, &text);
    let [forward, either] = [&[0.0][..], &[0.0, PI]].map(|turned| overlaps(&imported, [turned, &[0.0]]));
    assert!(either > forward && forward > 100, "{either} {forward}");
}

/// It was refused, or read as if it drove ahead.
#[test]
fn a_vehicle_that_drives_backward_has_its_nose_behind_it() {
    let fleet = Fleet::new("backward");
    let ends = [[0.0, 0.0], [5.0, 0.0], [-2.5, -4.0], [-2.5, 4.0]];
    let lif = lif(json!({ "vehicleTypeId": "f", "vehicleOrientation": PI }), ends);
    // In the pixels of a building, y down, and in metres.
    let vertices = ends.map(|[x, y]| json!([x * 10.0, -y * 10.0, 0, ""]));
    let lanes = json!([[0, 1, { "orientation": [1, "backward"] }], [2, 3, { "orientation": [1, "forward"] }]]);
    let level = json!({ "vertices": vertices, "lanes": lanes, "measurements": [[0, 1, { "distance": [3, 5.0] }]] });
    let building = json!({ "name": "b", "levels": { "L1": level } }).to_string();
    for (format, text) in [(InputFormat::Lif, lif), (InputFormat::Rmf, building)] {
        let imported = fleet.read(format, &text);
        assert_eq!(overlaps(&imported, [&[0.0], &[0.0]]), 0, "its back does not reach the other edge");
        assert!(overlaps(&imported, [&[PI], &[0.0]]) > 100, "{format}");
    }
}

/// Any heading was told of, and not covered.
#[test]
fn a_vehicle_that_rotates_on_its_edge_has_any_heading() {
    let fleet = Fleet::new("rotates");
    let turned: Vec<f64> = (0..24).map(|k| f64::from(k) * PI / 12.0).collect();
    // One that faces aslant has that heading all along.
    for (property, turned, y) in [
        (json!({ "rotationAllowed": true, "vehicleOrientation": 0.0 }), &turned[..], 3.3),
        (json!({ "vehicleOrientation": 1.0 }), &[1.0][..], 3.0),
    ] {
        let ends = [[0.0, 0.0], [5.0, 0.0], [2.0, y], [3.0, y]];
        let imported = fleet.read(InputFormat::Lif, &lif(property, ends));
        assert!(overlaps(&imported, [turned, &[0.0]]) > 20);
    }
}

/// Its corridor was told of, and not covered.
#[test]
fn a_vehicle_leaves_the_middle_of_its_corridor_in_any_heading() {
    let fleet = Fleet::new("corridor");
    let ends = [[0.0, 0.0], [5.0, 0.0], [1.0, 4.5], [4.0, 4.5]];
    let turned: Vec<f64> = (0..24).map(|k| f64::from(k) * PI / 12.0).collect();
    let imported =
        fleet.read(InputFormat::Lif, &lif(json!({ "corridor": { "leftWidth": 1.5, "rightWidth": 0.2 } }), ends));
    let locks = ExclusionTable::compute(&imported, false).unwrap().locks;
    let other = poses(&imported.layout.edges[1].curve);
    let mut count = 0;
    for (length, [x, y], heading) in poses(&imported.layout.edges[0].curve) {
        for (turned, aside) in turned.iter().flat_map(|turned| [-0.2, 0.7, 1.5].map(|aside| (turned, aside))) {
            let outline = placed(&LONG, [x, y + aside], heading + turned);
            for (there, at, heading) in &other {
                if apart(&outline, &placed(&LONG, *at, *heading)) <= 0.0 {
                    let within = |[lo, hi]: [f64; 2], x: f64| lo - 1e-9 <= x && x <= hi + 1e-9;
                    assert!(locks.iter().any(|lock| within(lock.a_length, length) && within(lock.b_length, *there)));
                    count += 1;
                }
            }
        }
    }
    assert!(count > 100, "{count}");
}
