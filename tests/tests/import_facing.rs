//! Vehicles with outlines that are driven backward or sideways, and change between that on the way.

use pcr_formats::import::{Facing, ImportOptions, InputFormat, Warnings, layout, scenario};
use pcr_formats::scenario::{Agent, PathSegment, Scenario};
use pcr_planning::exclusion_table::EdgeTraversals;
use pcr_planning::fleet::Fleet;
use pcr_planning::regions::{RegionOptions, RegionsReport};
use serde_json::json;
use std::f64::consts::{PI, TAU};
use std::path::{Path, PathBuf};

/// A vehicle whose outline is a rectangle around its reference point.
struct Centred(PathBuf);

impl Centred {
    fn new(name: &str) -> Self {
        let file = std::env::temp_dir().join(format!("pcr-centred-{name}-{}.json", std::process::id()));
        let physical = r#"{ "speedMax": 1.5, "accelerationMax": 0.6, "width": 0.8, "length": 1.9 }"#;
        std::fs::write(&file, format!(r#"{{ "typeSpecification": {{}}, "physicalParameters": {physical} }}"#)).unwrap();
        Self(file)
    }
}

impl Drop for Centred {
    fn drop(&mut self) {
        std::fs::remove_file(&self.0).unwrap();
    }
}

/// Reads a layout for a vehicle whose reference point is not in its middle, or says why it is refused.
fn read(format: InputFormat, text: &str, centred: &Centred) -> Result<(), String> {
    let aside = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/data/small/factsheet.json"));
    let of = |fleet: Option<&Path>| {
        let radius = fleet.is_none().then_some(0.5);
        let options = ImportOptions { radius, fleet: fleet.map(Path::to_path_buf), ..ImportOptions::default() };
        let read = layout(format, text, &options, &mut Warnings::default());
        read.map(|it| assert_eq!(it.vehicle.footprint.is_some(), fleet.is_some()))
            .map_err(|error| error.problem().to_owned())
    };
    // What is said about backward drives matters to no disc, and to no outline that is the same then.
    if !text.contains("sideways") {
        assert_eq!(of(None), Ok(()));
        assert_eq!(of(Some(&centred.0)), Ok(()));
    }
    of(Some(aside))
}

#[test]
fn paths_of_opentcs_are_driven_backward_in_their_other_direction() {
    let centred = Centred::new("opentcs");
    let plant = |limit: &str| {
        format!(
            "<model version=\"7.0.0\" name=\"m\"><point name=\"a\" positionX=\"0\" positionY=\"0\"/><point name=\"b\" positionX=\"5000\" positionY=\"0\"/>\
            <path name=\"p\" sourcePoint=\"a\" destinationPoint=\"b\" length=\"5000\" maxVelocity=\"1000\" {limit}/></model>"
        )
    };
    for limit in ["", "maxReverseVelocity=\"0\"", "maxReverseVelocity=\"500\""] {
        assert_eq!(read(InputFormat::OpenTcs, &plant(limit), &centred), Ok(()));
    }
    let text = plant("maxReverseVelocity=\"500\"");
    // Also without an outline: vehicles of a file of missions may have one.
    for fleet in [Some(FORK.into()), None] {
        let radius = fleet.is_none().then_some(0.5);
        let options = ImportOptions { fleet, radius, ..ImportOptions::default() };
        let read = layout(InputFormat::OpenTcs, &text, &options, &mut Warnings::default()).unwrap().layout;
        assert_eq!((read.edges[0].is_two_way(), read.edges[0].facing), (true, [Facing::Ahead, Facing::Backward]));
    }
}

/// A vehicle whose reference point is not in its middle.
const FORK: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/data/small/factsheet.json");

fn agent(format: InputFormat, text: &str, routes: &[&str]) -> Agent {
    let one = Some(1.0);
    let options = ImportOptions {
        fleet: Some(FORK.into()),
        rotation: one,
        rotation_acceleration: one,
        routes: routes.iter().map(ToString::to_string).collect(),
        ..ImportOptions::default()
    };
    let mut read = scenario(format, text, &options, &mut Warnings::default()).unwrap();
    // What is written is read again.
    assert_eq!(Scenario::from_json(&read.to_json()), Ok(read.clone()));
    read.agents.remove(0)
}

/// Headings of the body at the middles of the segments of its motion, from the corner that is farthest ahead \[rad\].
fn headings(agent: &Agent) -> Vec<f64> {
    let scenario = Scenario::new("", vec![agent.clone()]);
    let fleet = Fleet::<f64>::new(&scenario).unwrap();
    let motion = &fleet.motions()[0];
    let mut facings = Vec::new();
    let mut facing = 0.0;
    for segment in &agent.path {
        // A disc stands while it turns.
        if segment.length() > 0.0 {
            facings.push(facing);
        }
        facing = segment.facing_after(facing);
    }
    assert_eq!(facings.len(), motion.path().segments().len());
    let along = motion.path().segments().iter().map(|segment| {
        let at = if segment.is_steady() { 0.0 } else { 0.5 * segment.length() };
        segment.heading_at(at).0
    });
    along.zip(facings).map(|(along, facing)| (along + facing).rem_euclid(TAU)).collect()
}

/// They were replaced by the disc around the outline.
#[test]
fn vehicles_change_their_gear_on_the_way() {
    // Ahead to a dead end, and backward out of it round a corner: it turns there by a quarter, and nowhere else.
    let node = |k: usize, x: f64, y: f64| {
        json!({ "nodeId": k.to_string(), "sequenceId": 2 * k, "released": true, "actions": [],
            "nodePosition": { "x": x, "y": y, "mapId": "m" } })
    };
    let edge = |k: usize, orientation: f64| json!({ "edgeId": format!("e{k}"), "sequenceId": 2 * k - 1, "released": true, "actions": [], "orientation": orientation });
    let nodes = [node(0, 0.0, 0.0), node(1, 5.0, 0.0), node(2, 2.0, 0.0), node(3, 2.0, 4.0)];
    let order = json!({ "orderId": "o", "nodes": nodes, "edges": [edge(1, 0.0), edge(2, PI), edge(3, PI)] });
    let ordered = agent(InputFormat::Vda5050, &order.to_string(), &[]);
    let plant = "<model version=\"7.0.0\" name=\"m\"><point name=\"a\" positionX=\"0\" positionY=\"0\"/>\
        <point name=\"b\" positionX=\"5000\" positionY=\"0\"/><point name=\"c\" positionX=\"2000\" positionY=\"0\"/>\
        <point name=\"d\" positionX=\"2000\" positionY=\"4000\"/>\
        <path name=\"p\" sourcePoint=\"a\" destinationPoint=\"b\" length=\"5000\" maxVelocity=\"1000\"/>\
        <path name=\"q\" sourcePoint=\"c\" destinationPoint=\"b\" length=\"3000\" maxVelocity=\"0\" maxReverseVelocity=\"500\"/>\
        <path name=\"r\" sourcePoint=\"d\" destinationPoint=\"c\" length=\"4000\" maxVelocity=\"0\" maxReverseVelocity=\"500\"/></model>";
    let routed = agent(InputFormat::OpenTcs, plant, &["a:d"]);
    for agent in [&ordered, &routed] {
        assert!(agent.footprint.is_some());
        assert_eq!(agent.structure(), "SCSTS", "{agent:?}");
        let expected = [0.0, 0.0, 1.5 * PI];
        for (heading, expected) in headings(agent).into_iter().zip(expected) {
            let off = (heading - expected + PI).rem_euclid(TAU) - PI;
            assert!(off.abs() < 1e-6, "{heading} {expected}");
        }
    }
    // 5 m at 1 m/s and 0.6 m/s²; 3 m and 4 m at half the speed; a quarter of a turn at 1 rad/s and 1 rad/s².
    let seconds = |length: f64, top: f64, rate: f64| length / top + top / rate;
    let turn = std::f64::consts::FRAC_PI_2 + 1.0;
    let expected = seconds(5.0, 1.0, 0.4) + seconds(3.0, 0.5, 0.4) + seconds(4.0, 0.5, 0.4) + turn;
    assert!((routed.duration() - expected).abs() < 1e-6, "{} {expected}", routed.duration());
    // Backward on all edges it has one gear, and its outline is turned.
    let order = json!({ "orderId": "o", "nodes": nodes[1..], "edges": [edge(2, PI), edge(3, PI)] });
    let backward = agent(InputFormat::Vda5050, &order.to_string(), &[]);
    assert_eq!((backward.structure().as_str(), backward.footprint.is_some()), ("STS", true));
    // Where an edge says nothing clear, it is the disc, or what may face either way.
    let mut rotates = edge(2, PI);
    rotates["rotationAllowed"] = json!(true);
    let order = json!({ "orderId": "o", "nodes": nodes, "edges": [edge(1, 0.0), rotates, edge(3, PI)] });
    assert!(agent(InputFormat::Vda5050, &order.to_string(), &[]).footprint.is_none());
    // A theta that is that of neither edge is refused, and what it is after the change of gear is taken.
    let mut nodes = nodes;
    nodes[2]["nodePosition"]["theta"] = json!(0.0);
    nodes[3]["nodePosition"]["theta"] = json!(-0.5 * PI);
    let order = |nodes: &[serde_json::Value]| {
        json!({ "orderId": "o", "nodes": nodes, "edges": [edge(1, 0.0), edge(2, PI), edge(3, PI)] }).to_string()
    };
    assert_eq!(agent(InputFormat::Vda5050, &order(&nodes), &[]), ordered);
    nodes[3]["nodePosition"]["theta"] = json!(0.5 * PI);
    let options = ImportOptions {
        fleet: Some(FORK.into()),
        rotation: Some(1.0),
        rotation_acceleration: Some(1.0),
        ..ImportOptions::default()
    };
    let error = scenario(InputFormat::Vda5050, &order(&nodes), &options, &mut Warnings::default()).unwrap_err();
    assert!(error.problem().contains("its theta"), "{error}");
}

/// They were replaced by the disc around the outline.
#[test]
fn vehicles_travel_sideways_where_their_edges_say_so() {
    let node = |k: usize, x: f64, y: f64| {
        json!({ "nodeId": k.to_string(), "sequenceId": 2 * k, "released": true, "actions": [],
            "nodePosition": { "x": x, "y": y, "mapId": "m" } })
    };
    let edge = |k: usize, kind: &str, orientation: f64| {
        json!({ "edgeId": format!("e{k}"), "sequenceId": 2 * k - 1, "released": true, "actions": [],
        "orientation": orientation, "orientationType": kind })
    };
    let nodes = [node(0, 0.0, 0.0), node(1, 5.0, 0.0), node(2, 5.0, 3.0), node(3, 9.0, 6.0)];
    let order = |edges: [serde_json::Value; 3]| json!({ "orderId": "o", "nodes": nodes, "edges": edges }).to_string();
    let ordered = |edges| agent(InputFormat::Vda5050, &order(edges), &[]);
    // Its heading stays on the map, round both corners: it stands there, and does not turn.
    let global = ordered([edge(1, "GLOBAL", 0.2), edge(2, "GLOBAL", 0.2), edge(3, "GLOBAL", 0.2)]);
    // Then it turns to where it looks to its left all along the last edge.
    let turning = ordered([edge(1, "TANGENTIAL", 0.0), edge(2, "GLOBAL", 0.0), edge(3, "TANGENTIAL", 0.5 * PI)]);
    let third = 3.0_f64.atan2(4.0);
    for (agent, structure, expected) in
        [(&global, "CSCSCS", [0.2; 3]), (&turning, "SCSTCS", [0.0, 0.0, third + 0.5 * PI])]
    {
        assert!(agent.footprint.is_some());
        assert_eq!(agent.structure(), structure, "{agent:?}");
        for (heading, expected) in headings(agent).into_iter().zip(expected) {
            let off = (heading - expected + PI).rem_euclid(TAU) - PI;
            assert!(off.abs() < 1e-9, "{heading} {expected}");
        }
    }
    // At one angle all along, its outline is turned by it, and the path has no more segments than that of a disc.
    let aslant = ordered([1, 2, 3].map(|k| edge(k, "TANGENTIAL", 0.3)));
    assert_eq!(aslant.structure(), "STSTS");
    let [ahead, left] = agent(InputFormat::Vda5050, &order([1, 2, 3].map(|k| edge(k, "TANGENTIAL", 0.0))), &[])
        .footprint
        .unwrap()
        .polygon()[0];
    let [x, y] = aslant.footprint.unwrap().polygon()[0];
    let (sin, cos) = 0.3_f64.sin_cos();
    assert!((x - (ahead * cos - left * sin)).hypot(y - (ahead * sin + left * cos)) < 1e-12);
    // On a curve it keeps its heading as well, and does not stop on it.
    let points =
        json!([{ "x": 0.0, "y": 0.0 }, { "x": 3.0, "y": 0.0 }, { "x": 5.0, "y": 0.5 }, { "x": 5.0, "y": 3.0 }]);
    let mut curved = edge(1, "GLOBAL", 0.0);
    curved["trajectory"] = json!({ "degree": 3, "knotVector": [0, 0, 0, 0, 1, 1, 1, 1], "controlPoints": points });
    let order = |curved: &serde_json::Value| {
        json!({ "orderId": "o", "nodes": [node(0, 0.0, 0.0), node(1, 5.0, 3.0)], "edges": [curved] }).to_string()
    };
    for orientation in [0.0, -2.5] {
        curved["orientation"] = json!(orientation);
        let kept = agent(InputFormat::Vda5050, &order(&curved), &[]);
        let arcs = kept.path.iter().filter(|segment| matches!(segment, PathSegment::Arc { steady: true, .. })).count();
        let changes = kept.path.iter().filter(|segment| matches!(segment, PathSegment::Facing { .. })).count();
        assert!(kept.footprint.is_some() && arcs > 2, "{kept:?}");
        assert_eq!([arcs, changes], [kept.path.len() - changes, usize::from(orientation != 0.0)], "{kept:?}");
        for heading in headings(&kept) {
            let off = (heading - orientation + PI).rem_euclid(TAU) - PI;
            assert!(off.abs() < 1e-9, "{heading} {orientation}");
        }
    }
    // Of layouts as well, alone and behind another edge, at the end of which it turns to the heading that it keeps.
    let lif = |k: usize| {
        let place = |k: usize, x: f64, y: f64| json!({ "nodeId": k.to_string(), "nodePosition": { "x": x, "y": y } });
        let property = |more: serde_json::Value| {
            let mut property = json!({ "vehicleTypeId": "v" });
            property.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
            json!([property])
        };
        let bend = property(json!({ "vehicleOrientation": 0.4, "orientationType": "GLOBAL",
            "trajectory": { "degree": 3, "knotVector": [0, 0, 0, 0, 1, 1, 1, 1], "controlPoints": points } }));
        let edges = json!([
            { "edgeId": "bend", "startNodeId": "0", "endNodeId": "1", "vehicleTypeEdgeProperties": bend },
            { "edgeId": "to", "startNodeId": "2", "endNodeId": "0", "vehicleTypeEdgeProperties": property(json!({})) },
            { "edgeId": "on", "startNodeId": "1", "endNodeId": "3", "vehicleTypeEdgeProperties": property(json!({})) }
        ]);
        let nodes = json!([place(0, 0.0, 0.0), place(1, 5.0, 3.0), place(2, -3.0, 0.0), place(3, 5.0, 9.0)]);
        let text = json!({ "metaInformation": { "lifVersion": "1.0.0" },
            "layouts": [{ "layoutId": "l", "nodes": nodes, "edges": edges }] });
        agent(InputFormat::Lif, &text.to_string(), &[["0:1", "2:3"][k]])
    };
    let alone = lif(0);
    assert!(alone.footprint.is_some() && headings(&alone).iter().all(|heading| (heading - 0.4).abs() < 1e-9));
    let between = lif(1);
    assert!(
        between.footprint.is_some() && between.structure().starts_with("STCA") && between.structure().ends_with("ATCS"),
        "{}",
        between.structure()
    );
    let own = headings(&between);
    assert!(own[0].abs() < 1e-9 && (own[own.len() - 1] - 0.5 * PI).abs() < 1e-9, "{own:?}");
    assert!(own[1..own.len() - 1].iter().all(|heading| (heading - 0.4).abs() < 1e-9), "{own:?}");
    curved["orientationType"] = json!("TANGENTIAL");
    curved["orientation"] = json!(0.5 * PI);
    assert!(agent(InputFormat::Vda5050, &order(&curved), &[]).footprint.is_some());
}

/// Two lanes, along one of which a vehicle of 1.9 m by 0.8 m faces ahead, and on the other one at an angle.
#[test]
fn traversals_of_edges_are_of_vehicles_as_they_face() {
    let centred = Centred::new("aslant");
    let node = |k: usize, x: f64, y: f64| json!({ "nodeId": k.to_string(), "nodePosition": { "x": x, "y": y } });
    let edge = |k: usize, ends: [usize; 2], orientation: f64| {
        let properties =
            json!({ "vehicleTypeId": "v", "vehicleOrientation": orientation, "orientationType": "TANGENTIAL" });
        json!({ "edgeId": format!("e{k}"), "startNodeId": ends[0].to_string(), "endNodeId": ends[1].to_string(),
            "vehicleTypeEdgeProperties": [properties] })
    };
    for orientation in [0.0, 0.3, 0.5 * PI, 0.55 * PI, -1.0, PI] {
        // Half the width of one, and half the extent of the other across its lane.
        let touching = 0.4 + 0.95 * f64::sin(orientation).abs() + 0.4 * f64::cos(orientation).abs();
        for (apart, meets) in [(touching + 0.01, false), (touching - 0.01, true)] {
            let nodes = [node(0, 0.0, 0.0), node(1, 9.0, 0.0), node(2, 0.0, apart), node(3, 9.0, apart)];
            let edges = [edge(0, [0, 1], 0.0), edge(1, [2, 3], orientation)];
            let layouts = json!([{ "layoutId": "l", "nodes": nodes, "edges": edges }]);
            let text = json!({ "metaInformation": { "lifVersion": "1.0.0" }, "layouts": layouts }).to_string();
            let options = ImportOptions { fleet: Some(centred.0.clone()), ..ImportOptions::default() };
            let read = layout(InputFormat::Lif, &text, &options, &mut Warnings::default()).unwrap();
            let traversals = EdgeTraversals::new(&read);
            let agents = [0, 1].map(|place| traversals.on_edge(&read.layout.edges[place]).swap_remove(0).agent);
            let agents = agents.into_iter().zip(1..).map(|(agent, id)| Agent { id, ..agent });
            let options = RegionOptions { agent: Some(1), slices: None, certificate: false };
            let regions = RegionsReport::compute::<f64>(&Scenario::new("", agents.collect()), options).unwrap().regions;
            assert_eq!(!regions.is_empty(), meets, "{orientation} {apart}");
        }
    }
}

#[test]
fn lanes_of_open_rmf_say_which_way_vehicles_face() {
    let centred = Centred::new("rmf");
    let building = |parameters: &str| {
        format!(
            "levels:\n  L1:\n    vertices: [[0, 0, 0, a], [200, 0, 0, b]]\n    measurements: [[0, 1, {{distance: [3, 20.0]}}]]\n    \
            lanes:\n      - [0, 1, {{{parameters}}}]\n"
        )
    };
    let graph = |parameters: &str| {
        format!(
            "building_name: b\nlevels:\n  L1:\n    vertices: [[0, 0, {{name: a}}], [20, 0, {{name: b}}]]\n    lanes:\n      - [0, 1, {{{parameters}}}]\n"
        )
    };
    use Facing::{Ahead, Backward, Either};
    for (text, facing) in [
        (building("orientation: [1, \"\"], bidirectional: [4, true]"), [Ahead, Ahead]),
        (building("orientation: [1, forward]"), [Ahead, Either]),
        (building("orientation: [1, forward], bidirectional: [4, true]"), [Ahead, Either]),
        (building("orientation: [1, backward]"), [Backward, Either]),
        (building("orientation: [1, backward], bidirectional: [4, true]"), [Backward, Either]),
        (graph("orientation_constraint: forward, is_bidirectional: false"), [Ahead, Either]),
        (graph("orientation_constraint: backward, is_bidirectional: false"), [Backward, Either]),
        // What a building says is not what a graph says.
        (graph("orientation: backward"), [Ahead, Ahead]),
    ] {
        assert_eq!(read(InputFormat::Rmf, &text, &centred), Ok(()), "{text}");
        let fleet = Some(concat!(env!("CARGO_MANIFEST_DIR"), "/data/small/factsheet.json").into());
        let options = ImportOptions { fleet, ..ImportOptions::default() };
        let read = layout(InputFormat::Rmf, &text, &options, &mut Warnings::default()).unwrap().layout;
        assert_eq!(read.edges[0].facing, facing, "{text}");
    }
    let error = read(InputFormat::Rmf, &building("orientation: [1, sideways]"), &centred).unwrap_err();
    assert!(error.starts_with("lane L1/0: orientation: sideways is not read"), "{error}");
}

/// The file had a turn to one side, which rounding had chosen, and a vehicle may turn to the other one.
#[test]
fn half_turns_of_outlines_are_told() {
    let centred = Centred::new("half");
    let aside = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/data/small/factsheet.json"));
    let node = |k: usize, x: f64, y: f64| json!({ "nodeId": k.to_string(), "sequenceId": 2 * k, "released": true, "nodePosition": { "x": x, "y": y, "mapId": "m" }, "actions": [] });
    let edge = |k: usize, edges: bool| match edges {
        true => json!({ "edgeId": format!("e{k}"), "startNodeId": (k - 1).to_string(), "endNodeId": k.to_string() }),
        false => json!({ "edgeId": format!("e{k}"), "sequenceId": 2 * k - 1, "released": true, "actions": [] }),
    };
    // To the last point, at which an edge of 5 m leads back on the same line, or off it by 0.05 rad.
    for (y, half) in [(0.0, true), (0.25, false)] {
        let nodes = [node(0, 0.0, 0.0), node(1, 5.0, 0.0), node(2, 0.0, y)];
        let order = json!({ "orderId": "o", "nodes": nodes, "edges": [edge(1, false), edge(2, false)] });
        let places = nodes.clone().map(|node| {
            let position = &node["nodePosition"];
            json!({ "nodeId": node["nodeId"], "nodePosition": { "x": position["x"], "y": position["y"] } })
        });
        let layout = json!({ "layoutId": "l", "nodes": places, "edges": [edge(1, true), edge(2, true)] });
        for (format, text, name) in [
            (InputFormat::Path, format!("0 0\n5 0\n0 {y}\n"), "path 1"),
            (InputFormat::Vda5050, order.to_string(), "order o"),
            (
                InputFormat::Lif,
                json!({ "metaInformation": { "lifVersion": "1.0.0" }, "layouts": [layout] }).to_string(),
                "route 0:2",
            ),
        ] {
            for (fleet, radius) in [(Some(aside), None), (Some(&centred.0), None), (None, Some(0.5))] {
                let one = Some(1.0);
                let options = ImportOptions {
                    radius,
                    fleet: fleet.map(Path::to_path_buf),
                    speed: one,
                    acceleration: one,
                    rotation: one,
                    rotation_acceleration: one,
                    routes: if format == InputFormat::Lif { vec!["0:2".to_owned()] } else { Vec::new() },
                    ..ImportOptions::default()
                };
                let mut warnings = Warnings::default();
                scenario(format, &text, &options, &mut warnings).unwrap();
                let told =
                    warnings.lines().iter().any(|line| line.starts_with(&format!("{name}: turns by half a turn")));
                assert_eq!(told, half && fleet == Some(aside), "{name} {y} {:?}", warnings.lines());
            }
        }
    }
}
