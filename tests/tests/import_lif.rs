//! Layouts of the VDMA: the published examples, trajectories within their tolerance, vehicle types, levels.

use pcr_formats::import::{ElementId, Facing, ImportOptions, InputFormat, Layout, Warnings, layout, scenario};
use pcr_formats::scenario::PathSegment;
use serde_json::{Value, json};

const CURVES: &str = include_str!("../data/real/lif/example_17.lif.json");
const TYPES: &str = include_str!("../data/real/lif/example_10.lif.json");
const LEVELS: &str = include_str!("../data/real/lif/example_05.lif.json");

fn options() -> ImportOptions {
    ImportOptions {
        radius: Some(0.4),
        speed: Some(1.0),
        acceleration: Some(0.5),
        rotation: Some(1.0),
        rotation_acceleration: Some(1.0),
        ..ImportOptions::default()
    }
}

fn read(text: &str, options: &ImportOptions) -> (Layout, Vec<String>) {
    let mut warnings = Warnings::default();
    let imported = layout(InputFormat::Lif, text, options, &mut warnings).unwrap();
    (imported.layout, warnings.lines())
}

#[test]
fn every_example_is_read() {
    let directory = concat!(env!("CARGO_MANIFEST_DIR"), "/data/real/lif");
    let mut read_files = 0;
    for file in std::fs::read_dir(directory).unwrap() {
        let path = file.unwrap().path();
        let text = std::fs::read_to_string(&path).unwrap();
        let value: Value = serde_json::from_str(&text).unwrap();
        let count = |list: &str| {
            let lists = value["layouts"].as_array().unwrap().iter().filter_map(|layout| layout[list].as_array());
            lists.map(Vec::len).sum::<usize>()
        };
        assert_eq!(InputFormat::detect(&path, &text), Some(InputFormat::Lif));
        assert_eq!(InputFormat::detect("a.json".as_ref(), &text), Some(InputFormat::Lif));
        let (layout, _) = read(&text, &options());
        assert_eq!((layout.nodes.len(), layout.edges.len()), (count("nodes"), count("edges")), "{path:?}");
        read_files += 1;
    }
    assert_eq!(read_files, 11);
}

/// The quadratic spans of the first trajectory of example 17, written out: knots 0, 1/2, 1.
fn first_trajectory(u: f64) -> [f64; 2] {
    let controls: [[f64; 2]; 4] = [[0.0, 0.0], [0.0, 1.8], [3.6, 1.8], [3.6, 0.0]];
    let middle = [1.8, 1.8];
    let (a, b, c, t) = if u < 0.5 {
        (controls[0], controls[1], middle, 2.0 * u)
    } else {
        (middle, controls[2], controls[3], 2.0 * u - 1.0)
    };
    [0, 1].map(|k| a[k] * (1.0 - t) * (1.0 - t) + 2.0 * b[k] * t * (1.0 - t) + c[k] * t * t)
}

#[test]
fn trajectories_become_arcs_within_the_tolerance() {
    for tolerance in [1e-2, 1e-4, 1e-6] {
        let (layout, warnings) = read(CURVES, &ImportOptions { tolerance: Some(tolerance), ..options() });
        let edge = &layout.edges[0];
        assert!(edge.deviation > 0.0 && edge.deviation <= tolerance);
        let radii = edge.curve.iter().filter_map(|piece| match piece.shape {
            PathSegment::Arc { radius, .. } => Some(radius),
            _ => None,
        });
        let radii: Vec<f64> = radii.collect();
        assert_eq!(radii.len(), edge.curve.len());
        // The curve has radii of 1.27 m to 3.6 m, and those of its arcs lie between.
        let (least, most) = radii.iter().fold((f64::MAX, 0.0_f64), |(lo, hi), r| (lo.min(*r), hi.max(*r)));
        assert!(least > 1.27 && most < 3.6 && least < 1.45 && most > 2.5, "{least} {most}");
        let length: f64 = (0..20_000)
            .map(|k| {
                let [a, b] = [k, k + 1].map(|k| first_trajectory(f64::from(k) / 20_000.0));
                (a[0] - b[0]).hypot(a[1] - b[1])
            })
            .sum();
        assert!((edge.length() - length).abs() < tolerance, "{} {length}", edge.length());
        // The file draws them elsewhere than its nodes.
        assert!((4..=5).contains(&warnings.len()), "{warnings:?}");
        let off = edge.deviation > 1e-6;
        assert_eq!(warnings.iter().any(|line| line.contains("lines and arcs are up to")), off, "{warnings:?}");
        assert_eq!(
            warnings[0],
            "edge N1-N2: its trajectory begins 5.000 m from its node; no route passes there, and no lock covers what is between them"
        );
    }
}

#[test]
fn a_route_keeps_the_deviation_of_its_curves_as_margin() {
    let mut value: Value = serde_json::from_str(CURVES).unwrap();
    value["layouts"][0]["nodes"][0]["nodePosition"] = json!({ "x": 0.0, "y": 0.0 });
    value["layouts"][0]["nodes"][1]["nodePosition"] = json!({ "x": 3.6, "y": 0.0 });
    let options = ImportOptions { routes: vec!["N1:N2".into()], margin: Some(0.05), ..options() };
    let mut warnings = Warnings::default();
    let scenario = scenario(InputFormat::Lif, &value.to_string(), &options, &mut warnings).unwrap();
    let [said] = &warnings.lines()[..] else { panic!("one warning") };
    assert!(said.contains("its lines and arcs are up to") && said.contains("by which the vehicle is larger"), "{said}");
    let (layout, _) = read(&value.to_string(), &options);
    let agent = &scenario.agents[0];
    assert!((agent.radius - 0.4 - layout.edges[0].deviation).abs() < 1e-9 && agent.radius > 0.4);
    assert_eq!(agent.margin, 0.05);
    assert_eq!(agent.path.iter().filter(|segment| segment.letter() == 'A').count(), layout.edges[0].curve.len());
}

#[test]
fn edges_are_those_of_the_vehicle_type() {
    let (all, warnings) = read(TYPES, &options());
    assert_eq!(all.edges.len(), 6);
    assert!(warnings[0].starts_with("Vehicle_Type_1, Vehicle_Type_2, Vehicle_Type_3: several vehicle types"));
    for (vehicle, edges) in [("Vehicle_Type_1", 4), ("Vehicle_Type_2", 2), ("Vehicle_Type_3", 2)] {
        let (layout, warnings) = read(TYPES, &ImportOptions { vehicle: Some(vehicle.into()), ..options() });
        assert_eq!((layout.edges.len(), warnings.len()), (edges, 0), "{vehicle}");
    }
    let unknown = ImportOptions { vehicle: Some("truck".into()), ..options() };
    let error = layout(InputFormat::Lif, TYPES, &unknown, &mut Warnings::default()).unwrap_err().problem().to_owned();
    assert_eq!(error, "vehicle truck: no edge is for it; there are Vehicle_Type_1, Vehicle_Type_2, Vehicle_Type_3");
}

#[test]
fn maps_are_levels() {
    let (layout, _) = read(LEVELS, &options());
    assert_eq!(layout.levels, ["Map_Z-Level_1", "Map_Z-Level_2"]);
    assert_eq!(layout.nodes.iter().map(|node| node.level).collect::<Vec<_>>(), [0, 0, 1, 1]);
}

/// Two ways that cross, in one layout or in one each, with what nodes and layouts say of maps and levels.
fn crossing(maps: [Option<&str>; 4], levels: Option<[Option<&str>; 2]>) -> Value {
    let node = |k: usize| {
        let (x, y) = [(0.0, 0.0), (10.0, 0.0), (5.0, -5.0), (5.0, 5.0)][k];
        let mut node = json!({ "nodeId": k.to_string(), "nodePosition": { "x": x, "y": y } });
        if let Some(map) = maps[k] {
            node["mapId"] = json!(map);
        }
        node
    };
    let edge = |k: usize| {
        json!({ "edgeId": k.to_string(), "startNodeId": (2 * k).to_string(), "endNodeId": (2 * k + 1).to_string(),
            "vehicleTypeEdgeProperties": [{ "vehicleTypeId": "A" }] })
    };
    let part = |edges: &[usize]| {
        let nodes: Vec<Value> = edges.iter().flat_map(|k| [node(2 * k), node(2 * k + 1)]).collect();
        let edges: Vec<Value> = edges.iter().map(|k| edge(*k)).collect();
        json!({ "layoutId": format!("L{}", edges.len()), "nodes": nodes, "edges": edges })
    };
    let layouts = match levels {
        None => vec![part(&[0, 1])],
        Some(levels) => (0..2)
            .map(|k| {
                let mut layout = part(&[k]);
                layout["layoutId"] = json!(format!("L{k}"));
                if let Some(level) = levels[k] {
                    layout["layoutLevelId"] = json!(level);
                }
                layout
            })
            .collect(),
    };
    json!({ "metaInformation": { "projectIdentification": "p", "lifVersion": "1.0.0" }, "layouts": layouts })
}

/// Two levels instead of one would leave out what can touch.
#[test]
fn nodes_without_a_map_are_on_one_level_unless_the_file_tells_them_apart() {
    const NONE: [Option<&str>; 4] = [None; 4];
    let half = [Some("M"), Some("M"), None, None];
    for (maps, levels, expected, warned) in [
        (NONE, None, &["L2"][..], false),
        (half, None, &["M"], true),
        (half, Some([None, None]), &["M"], true),
        (NONE, Some([None, None]), &["L0"], true),
        (NONE, Some([Some("floor"), Some("floor")]), &["floor"], false),
        (NONE, Some([Some("floor"), Some("roof")]), &["floor", "roof"], false),
        ([Some("M"), None, Some("N"), Some("N")], Some([None, None]), &["M", "N"], true),
    ] {
        let (layout, warnings) = read(&crossing(maps, levels).to_string(), &options());
        assert_eq!(layout.levels, expected, "{maps:?} {levels:?}");
        let lines = warnings.iter().filter(|line| line.contains("nodes without mapId, which are taken to be on level"));
        assert_eq!(lines.count() == 1, warned, "{warnings:?}");
    }
    let unclear = crossing([Some("M"), Some("N"), None, None], None).to_string();
    assert!(layout_error(&unclear).contains("node 2, mapId: missing"), "{}", layout_error(&unclear));
}

/// What the reader refuses, and what it reads and warns about if that is left out.
fn partly(value: &Value) -> (String, Layout, Vec<String>) {
    let text = value.to_string();
    let error = layout(InputFormat::Lif, &text, &options(), &mut Warnings::default()).unwrap_err().problem().to_owned();
    let (layout, warnings) = read(&text, &ImportOptions { partial: true, ..options() });
    (error, layout, warnings)
}

#[test]
fn what_is_wrong_is_refused_by_name_and_left_out_if_asked_for() {
    let mut value: Value = serde_json::from_str(CURVES).unwrap();
    value["layouts"][0]["edges"][0]["vehicleTypeEdgeProperties"][0]["trajectory"]["degree"] = json!(3);
    value["layouts"][0]["edges"][1]["vehicleTypeEdgeProperties"][0]["trajectory"]["knotVector"][2] = json!("0");
    let (error, layout, warnings) = partly(&value);
    assert_eq!(error, "edge N2-N1, trajectory: a knot that is not a number; --partial leaves that out");
    // Seven knots say that degree 3 is meant as the order.
    assert_eq!(layout.edges.iter().map(|edge| edge.id.clone()).collect::<Vec<_>>(), [ElementId::Text("N1-N2".into())]);
    assert!(
        warnings.contains(
            &"edge N1-N2, trajectory: its degree is one more than its knots say; it is taken as the order of the curve"
                .into()
        )
    );
    assert!(warnings.contains(&"edge N2-N1, trajectory: a knot that is not a number: left out".into()), "{warnings:?}");
    value["layouts"][0]["edges"][0]["endNodeId"] = json!("N9");
    value["layouts"][0]["nodes"][1]["nodePosition"]["x"] = json!(null);
    let (error, layout, warnings) = partly(&value);
    assert_eq!((layout.nodes.len(), layout.edges.len()), (1, 0));
    for expected in [
        "node N2, nodePosition, x: missing",
        "edge N1-N2, endNodeId: there is no node N9",
        "edge N2-N1, startNodeId: there is no node N2",
    ] {
        assert!(error.contains(expected), "{expected} in {error}");
        assert!(warnings.join("\n").contains(expected), "{expected} in {warnings:?}");
    }
    assert!(warnings.iter().any(|line| line.ends_with(": left out")), "{warnings:?}");
}

#[test]
fn one_name_for_several_things_loses_none_of_them() {
    let mut value: Value = serde_json::from_str(LEVELS).unwrap();
    let list = |value: &Value, list: &str| value["layouts"][0][list].as_array().unwrap().clone();
    let (mut nodes, mut edges) = (list(&value, "nodes"), list(&value, "edges"));
    let (count, ways) = read(LEVELS, &options()).0.edges.iter().fold((0, 0), |(k, n), _| (k + 1, n + 1));
    // A copy of a node and one of an edge, and an edge of the same name the other way round.
    nodes.push(nodes[0].clone());
    edges.push(edges[0].clone());
    let mut back = edges[0].clone();
    (back["startNodeId"], back["endNodeId"]) = (edges[0]["endNodeId"].clone(), edges[0]["startNodeId"].clone());
    edges.push(back);
    (value["layouts"][0]["nodes"], value["layouts"][0]["edges"]) = (json!(nodes), json!(edges));
    let (layout, warnings) = read(&value.to_string(), &options());
    assert_eq!((layout.nodes.len(), layout.edges.len()), (4, count.max(ways) + 1));
    let name = edges[0]["edgeId"].as_str().unwrap();
    assert!(layout.edges.iter().any(|edge| edge.id.to_string() == format!("{name}#2")), "{:?}", layout.edges);
    assert!(warnings.iter().any(|line| line.contains("several have this name")), "{warnings:?}");
    assert!(warnings.iter().any(|line| line.contains("given twice, the same each time")), "{warnings:?}");
    // Another place for a node that edges join: which one they mean cannot be told.
    let last = nodes.len() - 1;
    nodes[last]["nodePosition"]["x"] = json!(77.0);
    value["layouts"][0]["nodes"] = json!(nodes);
    let error = layout_error(&value.to_string());
    assert!(error.contains(": there are several different nodes "), "{error}");
}

fn layout_error(text: &str) -> String {
    layout(InputFormat::Lif, text, &options(), &mut Warnings::default()).unwrap_err().problem().to_owned()
}

#[test]
fn every_type_keeps_its_own_way() {
    let mut value: Value = serde_json::from_str(CURVES).unwrap();
    let properties = value["layouts"][0]["edges"][0]["vehicleTypeEdgeProperties"].as_array_mut().unwrap();
    let mut other = properties[0].clone();
    other["vehicleTypeId"] = json!("straight");
    other.as_object_mut().unwrap().remove("trajectory");
    properties.push(other);
    let text = value.to_string();
    let (all, _) = read(&text, &options());
    assert_eq!(all.edges.iter().map(|edge| edge.id.to_string()).collect::<Vec<_>>(), ["N1-N2", "N1-N2#2", "N2-N1"]);
    assert_ne!(all.edges[0].curve, all.edges[1].curve);
    let (one, _) = read(&text, &ImportOptions { vehicle: Some("straight".into()), ..options() });
    assert_eq!((one.edges.len(), &one.edges[0].curve), (1, &all.edges[1].curve));
}

#[test]
fn edges_have_the_limits_and_the_gaps_of_the_file() {
    let node = |id: &str, x: f64, y: f64| json!({ "nodeId": id, "nodePosition": { "x": x, "y": y } });
    let line = |from: [f64; 2], to: [f64; 2]| {
        let points = [from, to].map(|[x, y]| json!({ "x": x, "y": y }));
        json!({ "degree": 1, "knotVector": [0, 0, 1, 1], "controlPoints": points })
    };
    let edge = |id: &str, to: &str, properties: Value| json!({ "edgeId": id, "startNodeId": "a", "endNodeId": to, "vehicleTypeEdgeProperties": properties });
    let lif = json!({ "metaInformation": { "lifVersion": "1.0.0" }, "layouts": [{ "layoutId": "l", "nodes": [node("a", 1.0, 2.0), node("b", 4.0, 6.0), node("c", 1.0, 2.0)], "edges": [
        edge("plain", "b", json!([])),
        edge("slow", "b", json!([{ "vehicleTypeId": "t", "maxSpeed": 0.7, "maxRotationSpeed": 0.3 }])),
        edge("near", "b", json!([{ "vehicleTypeId": "t", "trajectory": line([1.0, 2.0], [4.0, 6.0]) }])),
        edge("off", "b", json!([{ "vehicleTypeId": "t", "trajectory": line([1.0, 2.0], [4.0, 6.5]) }])),
        edge("none", "c", json!([])),
    ] }] });
    let (layout, warnings) = read(&lif.to_string(), &options());
    let limits: Vec<_> = layout.edges.iter().map(|edge| (edge.id.to_string(), edge.speed[0], edge.rotation)).collect();
    let expected = [
        ("plain", None, None),
        ("slow", Some(0.7), Some(0.3)),
        ("near", None, None),
        ("off", None, None),
        ("none", None, None),
    ];
    assert_eq!(limits, expected.map(|(id, speed, rotation)| (id.to_owned(), speed, rotation)));
    assert!(layout.edges.iter().all(|edge| !edge.is_two_way()));
    assert!((layout.edges[0].length() - 5.0).abs() < 1e-12 && layout.edges[4].curve.is_empty());
    assert_eq!(
        warnings,
        [
            "edge off: its trajectory ends 0.500 m from its node; no route passes there, and no lock covers what is between them",
            "edge none: its length is 0"
        ]
    );
}

/// A vehicle that drives sideways was read as if its outline faced along the edge, and radians were taken for degrees.
#[test]
fn outlines_face_as_edges_say() {
    let node = |id: &str, y: f64| json!({ "nodeId": id, "nodePosition": { "x": 0.0, "y": y } });
    let lif = |orientation: f64, kind: Value| {
        let property = json!([{ "vehicleTypeId": "t", "vehicleOrientation": orientation, "orientationType": kind }]);
        let edge =
            json!({ "edgeId": "e", "startNodeId": "a", "endNodeId": "b", "vehicleTypeEdgeProperties": property });
        json!({ "metaInformation": { "lifVersion": "1.0.0" }, "layouts": [{ "layoutId": "l", "nodes": [node("a", 0.0), node("b", 5.0)], "edges": [edge] }] })
            .to_string()
    };
    let fleet = concat!(env!("CARGO_MANIFEST_DIR"), "/data/small/factsheet.json");
    let outlined = ImportOptions { fleet: Some(fleet.into()), radius: None, ..options() };
    let (quarter, half) = (std::f64::consts::FRAC_PI_2, std::f64::consts::PI);
    for (orientation, kind, facing) in [
        (0.0, Value::Null, Facing::Ahead),
        (2.0 * half, json!("TANGENTIAL"), Facing::Ahead),
        (quarter, json!("GLOBAL"), Facing::Ahead),
        (half, Value::Null, Facing::Backward),
        (-quarter, json!("GLOBAL"), Facing::Backward),
        (quarter, Value::Null, Facing::sideways(quarter)),
        // Not 0.05 degrees.
        (0.05, Value::Null, Facing::sideways(0.05)),
        (0.0, json!("GLOBAL"), Facing::sideways(-quarter)),
    ] {
        let text = lif(orientation, kind);
        assert_eq!(read(&text, &outlined).0.edges[0].facing[0], facing, "{orientation}");
        assert_eq!(read(&text, &options()).0.edges[0].facing[0], Facing::Ahead, "it does not matter how a disc faces");
    }
    let error = |text: &str| {
        layout(InputFormat::Lif, text, &outlined, &mut Warnings::default()).unwrap_err().problem().to_owned()
    };
    let degrees = error(&lif(180.0, Value::Null));
    assert!(degrees.contains("vehicleOrientation: 180 is more than one turn; the format has radians"), "{degrees}");
    let odd = error(&lif(0.0, json!("SIDEWAYS")));
    assert!(odd.contains("orientationType: SIDEWAYS is neither TANGENTIAL nor GLOBAL"), "{odd}");
}

/// Of the speeds of two types one was taken, and the table of delays was wrong for the other.
#[test]
fn times_are_of_one_speed() {
    let with = |speeds: [Value; 2]| {
        let mut value: Value = serde_json::from_str(TYPES).unwrap();
        let [a, b] = speeds.map(|speed| json!({ "vehicleTypeId": speed["of"], "maxSpeed": speed["is"] }));
        value["layouts"][0]["edges"][0]["vehicleTypeEdgeProperties"] = json!([a, b]);
        value.to_string()
    };
    let of = |kind: &str, speed: f64| json!({ "of": kind, "is": speed });
    let driving = pcr_planning::exclusion_table::EdgeDriving { speed: 2.0, acceleration: None };
    let asked = |text: &str, vehicle: Option<&str>| {
        let options = ImportOptions { vehicle: vehicle.map(str::to_owned), ..options() };
        let imported = layout(InputFormat::Lif, text, &options, &mut Warnings::default()).unwrap();
        let delays = pcr_planning::exclusion_table::UnsafeDelayModel::new(&imported, driving, false);
        let roads = pcr_formats::import::roads(InputFormat::Lif, text, &options, &mut Warnings::default());
        assert_eq!(delays.is_ok(), roads.is_ok());
        assert!(pcr_planning::exclusion_table::ExclusionTable::compute(&imported, false).is_ok());
        roads.map(drop).map_err(|error| error.problem().to_owned())
    };
    let (same, other) = (
        with([of("Vehicle_Type_1", 1.0), of("Vehicle_Type_2", 1.0)]),
        with([of("Vehicle_Type_1", 1.0), of("Vehicle_Type_2", 0.5)]),
    );
    assert_eq!(asked(&same, None), Ok(()));
    assert_eq!(asked(&other, Some("Vehicle_Type_2")), Ok(()));
    let error = asked(&other, None).unwrap_err();
    assert!(
        error.ends_with("its vehicle types have different speeds; say which one drives, --vehicle TYPE"),
        "{error}"
    );
}

/// With a vehicle they disappeared.
#[test]
fn edges_that_name_no_type_are_for_all() {
    let mut value: Value = serde_json::from_str(TYPES).unwrap();
    value["layouts"][0]["edges"][0]["vehicleTypeEdgeProperties"] = json!([]);
    let count = |vehicle: Option<&str>| {
        read(&value.to_string(), &ImportOptions { vehicle: vehicle.map(str::to_owned), ..options() }).0.edges.len()
    };
    let id = value["layouts"][0]["edges"][0]["edgeId"].as_str().unwrap().to_owned();
    assert!(count(None) > 0);
    for vehicle in ["Vehicle_Type_1", "Vehicle_Type_2", "Vehicle_Type_3"] {
        let (layout, _) = read(&value.to_string(), &ImportOptions { vehicle: Some(vehicle.into()), ..options() });
        assert!(layout.edges.iter().any(|edge| edge.id.to_string() == id), "{vehicle}");
    }
}

/// Nodes a to d at the corners of a cross, and edges of this kind.
fn cross(edges: Value, theta: Value) -> Value {
    let node = |id: &str, x: f64, y: f64| {
        let properties =
            json!([{ "vehicleTypeId": "t", "theta": if id == "b" { theta.clone() } else { Value::Null } }]);
        json!({ "nodeId": id, "nodePosition": { "x": x, "y": y }, "vehicleTypeNodeProperties": properties })
    };
    let nodes = [node("a", 0.0, 0.0), node("b", 10.0, 0.0), node("c", 5.0, -5.0), node("d", 5.0, 5.0)];
    json!({ "metaInformation": { "lifVersion": "1.0.0" }, "layouts": [{ "layoutId": "l", "nodes": nodes, "edges": edges }] })
}

fn edge(id: &str, from: &str, to: &str, property: Value) -> Value {
    json!({ "edgeId": id, "startNodeId": from, "endNodeId": to, "vehicleTypeEdgeProperties": [property] })
}

/// With a vehicle they disappeared where a property was there that named no type.
#[test]
fn properties_that_name_no_type_are_for_all() {
    let options = ImportOptions { vehicle: Some("t".into()), ..options() };
    for unnamed in [json!({}), json!({ "vehicleTypeId": "" }), json!({ "vehicleTypeId": null })] {
        let edges = json!([edge("ab", "a", "b", json!({ "vehicleTypeId": "t" })), edge("cd", "c", "d", unnamed)]);
        let mut warnings = Warnings::default();
        let imported =
            layout(InputFormat::Lif, &cross(edges, Value::Null).to_string(), &options, &mut warnings).unwrap();
        let locks = pcr_planning::exclusion_table::ExclusionTable::compute(&imported, false).unwrap().locks;
        assert_eq!((locks.len(), &imported.layout.vehicle_types), (1, &vec!["t".to_owned()]));
    }
}

/// It had no locks, and a lock file without it was certified, while routes went from node to node.
#[test]
fn a_trajectory_that_is_a_point_is_no_way_to_a_node_elsewhere() {
    let edges = |[x, y]: [f64; 2]| {
        let curve = json!({ "degree": 1, "controlPoints": [{ "x": x, "y": y }, { "x": x, "y": y }] });
        let point = json!({ "vehicleTypeId": "t", "trajectory": curve });
        cross(
            json!([edge("ab", "a", "b", json!({})), edge("cd", "c", "d", point.clone()), edge("cc", "c", "c", point)]),
            Value::Null,
        )
    };
    let error = layout_error(&edges([5.0, -5.0]).to_string());
    assert_eq!(error, "edge cd, trajectory: it has no length, and is 10.000 m from a node; --partial leaves that out");
    let error = layout_error(&edges([5.0, -1.0]).to_string());
    assert!(error.contains("edge cc, trajectory: it has no length, and is 4.000 m from a node"), "{error}");
    let mut near = edges([5.0, -5.03]);
    near["layouts"][0]["edges"].as_array_mut().unwrap().remove(1);
    let (layout, warnings) = read(&near.to_string(), &options());
    let edge = &layout.edges[1];
    assert!(edge.curve.is_empty() && (edge.deviation - 0.03).abs() < 1e-12, "{edge:?}");
    assert!(warnings.iter().any(|line| line.starts_with("edge cc: its length is 0")), "{warnings:?}");
}

/// They were not read, and a vehicle that turned on its way or came backward to a node had too few locks.
#[test]
fn thetas_and_turns_of_an_outline_are_covered() {
    let fleet = concat!(env!("CARGO_MANIFEST_DIR"), "/data/small/factsheet.json");
    let outlined = ImportOptions { fleet: Some(fleet.into()), radius: None, ..options() };
    let facing = |theta: Value, options: &ImportOptions| {
        let turns = json!({ "vehicleTypeId": "t", "rotationAllowed": true });
        let edges = json!([edge("ab", "a", "b", json!({ "vehicleTypeId": "t" })), edge("cd", "c", "d", turns)]);
        let (layout, _) = read(&cross(edges, theta).to_string(), options);
        [0, 1].map(|place| layout.edges[place].facing[0])
    };
    assert_eq!(facing(json!(0.0), &outlined), [Facing::Ahead, Facing::Any]);
    assert_eq!(facing(json!(1.57), &outlined), [Facing::Either, Facing::Any]);
    assert_eq!(facing(json!(1.57), &options()), [Facing::Ahead, Facing::Ahead]);
    let other = ImportOptions { vehicle: Some("other".into()), ..outlined.clone() };
    let edges = json!([edge("ab", "a", "b", json!({ "vehicleTypeId": "other" }))]);
    let (layout_of_other, _) = read(&cross(edges, json!(1.57)).to_string(), &other);
    assert_eq!(layout_of_other.edges[0].facing[0], Facing::Ahead, "it is the theta of another type");
    let curve = json!({ "controlPoints": [{ "x": 0, "y": 0, "orientation": 1.57 }, { "x": 10, "y": 0 }] });
    let sideways = json!([edge("ab", "a", "b", json!({ "vehicleTypeId": "t", "trajectory": curve }))]);
    let text = cross(sideways, Value::Null).to_string();
    let error = layout(InputFormat::Lif, &text, &outlined, &mut Warnings::default()).unwrap_err().problem().to_owned();
    assert!(error.starts_with("edge ab, trajectory, control point 1: its orientation 1.57, as outlines"), "{error}");
}

/// Of a layout whose edges had another name there were none.
#[test]
fn a_layout_has_nodes_and_edges() {
    let edges = json!([edge("ab", "a", "b", json!({}))]);
    for list in ["nodes", "edges"] {
        let mut value = cross(edges.clone(), Value::Null);
        let mut other = value["layouts"][0].clone();
        let hidden = other.as_object_mut().unwrap().remove(list).unwrap();
        other[format!("{list}s")] = hidden;
        value["layouts"].as_array_mut().unwrap().push(other);
        let error = layout_error(&value.to_string());
        assert!(
            error.contains(&format!("layout 2: its key {list}s is not known here; it may be meant for {list}")),
            "{error}"
        );
        assert!(error.contains(&format!("layout 2, {list}: missing")), "{error}");
        value["layouts"][1][list] = json!([]);
        value["layouts"][1]["edges"] = json!([]);
        assert_eq!(read(&value.to_string(), &options()).0.edges.len(), 1);
    }
}
