//! Versions of LIF: each with its own names, and none with those of another one.

use pcr_formats::import::{Facing, ImportOptions, InputFormat, Layout, Warnings, layout};
use pcr_planning::exclusion_table::ExclusionTable;
use serde_json::{Value, json};

fn options() -> ImportOptions {
    ImportOptions { radius: Some(0.4), ..ImportOptions::default() }
}

fn outlined() -> ImportOptions {
    ImportOptions {
        fleet: Some(concat!(env!("CARGO_MANIFEST_DIR"), "/data/small/factsheet.json").into()),
        ..ImportOptions::default()
    }
}

fn read(value: &Value, options: &ImportOptions) -> Result<(Layout, Vec<String>), String> {
    let mut warnings = Warnings::default();
    let read = layout(InputFormat::Lif, &value.to_string(), options, &mut warnings)
        .map_err(|error| error.problem().to_owned())?;
    Ok((read.layout, warnings.lines()))
}

/// A half circle, more or less, from (5, 0) to (15, 0).
fn arc() -> Value {
    let points = [[5, 0], [5, 5], [15, 5], [15, 0]].map(|[x, y]| json!({ "x": x, "y": y }));
    json!({ "degree": 2, "knotVector": [0, 0, 0, 0.5, 1, 1, 1], "controlPoints": points })
}

fn node(id: &str, [x, y]: [f64; 2]) -> Value {
    json!({ "nodeId": id, "mapId": "m", "nodePosition": { "x": x, "y": y } })
}

/// A layout with an edge that is bent over another one, in the names of a version.
fn bent(version: u32, property: Value) -> Value {
    let list = if version == 1 { "vehicleTypeEdgeProperties" } else { "mobileRobotTypeEdgeProperties" };
    let mut edge = json!({ "edgeId": "over", "startNodeId": "a", "endNodeId": "b" });
    edge[list] = json!([property]);
    let other = json!({ "edgeId": "under", "startNodeId": "c", "endNodeId": "d" });
    let places = [("a", [5.0, 0.0]), ("b", [15.0, 0.0]), ("c", [10.0, 3.0]), ("d", [10.0, 6.0])];
    json!({ "layoutId": "l", "layoutVersion": "1", "nodes": places.map(|(id, at)| node(id, at)), "edges": [edge, other] })
}

fn robots() -> Value {
    json!([{ "manufacturer": "M", "seriesName": "S" }])
}

fn first(property: Value) -> Value {
    json!({ "metaInformation": { "lifVersion": "1.0.0" }, "layouts": [bent(1, property)] })
}

fn second(property: Value) -> Value {
    let origin = json!({ "originId": "o", "layouts": [bent(2, property)] });
    json!({ "metaInformation": { "lifVersion": "2.0.0", "lifId": "plant" }, "origins": [origin] })
}

/// The pairs of edges that exclude one another.
fn locks(value: &Value, options: &ImportOptions) -> usize {
    let imported = layout(InputFormat::Lif, &value.to_string(), options, &mut Warnings::default()).unwrap();
    ExclusionTable::compute(&imported, false).unwrap().locks.len()
}

/// The edge was straight, and its lock was gone.
#[test]
fn a_curve_is_read_in_the_names_of_its_version_and_of_no_other() {
    let own = [
        first(json!({ "vehicleTypeId": "t", "trajectory": arc() })),
        second(json!({ "mobileRobotTypes": robots(), "trajectory": arc() })),
    ];
    for value in &own {
        let (read, warnings) = read(value, &options()).unwrap();
        assert!(read.edges[0].length() > 14.0 && read.edges[0].curve.len() > 1, "{read:?}");
        let known = ["its lines and arcs are up to", "several vehicle types"];
        assert!(warnings.iter().all(|line| known.iter().any(|known| line.contains(known))), "{warnings:?}");
        assert_eq!(locks(value, &options()), 1);
    }
    // Names of one version in a file of the other one, or of both.
    let swapped = |value: &Value, version: Value| {
        let mut value = value.clone();
        value["metaInformation"]["lifVersion"] = version;
        read(&value, &options())
    };
    let error = swapped(&own[0], json!("2.0.0")).unwrap_err();
    let expected = "LIF, lifVersion: the file says 2.0.0, but vehicleTypeEdgeProperties is a name of LIF 1, where this version has \
                    mobileRobotTypeEdgeProperties";
    assert_eq!(error, expected);
    let error = swapped(&own[1], json!("0.11.0")).unwrap_err();
    assert!(error.starts_with("LIF, lifVersion: the file says 0.11.0, but "), "{error}");
    let mut both = own[0].clone();
    both["layouts"][0]["edges"][1]["mobileRobotTypeEdgeProperties"] = json!([]);
    let error = swapped(&both, Value::Null).unwrap_err();
    assert!(
        error.starts_with("LIF, lifVersion: missing; vehicleTypeEdgeProperties is a name of LIF 1, and"),
        "{error}"
    );
    // Without a version the names tell.
    for value in &own {
        let (read, warnings) = swapped(value, Value::Null).unwrap();
        assert!(read.edges[0].curve.len() > 1);
        assert!(
            warnings[0].starts_with("LIF: it does not say its lifVersion; by its names it is read as"),
            "{warnings:?}"
        );
    }
    for unknown in ["3.0.0", "new", "", "2.x"] {
        let error = swapped(&own[1], json!(unknown)).unwrap_err();
        assert_eq!(error, format!("LIF, lifVersion: {unknown} is not known; versions 0.11 to 2.0 are read"));
    }
    let (_, warnings) = swapped(&own[1], json!("2.1.0")).unwrap();
    assert_eq!(warnings[0], "LIF: its lifVersion 2.1.0 is not known; it is read as 2.0.0");
}

/// A misspelt name was passed over.
#[test]
fn a_name_with_an_error_in_it_is_refused() {
    let curve = json!({ "vehicleTypeId": "t", "trajectory": arc() });
    let of = |change: &dyn Fn(&mut Value)| {
        let mut value = first(curve.clone());
        change(&mut value["layouts"][0]);
        read(&value, &options())
    };
    let rename = |object: &mut Value, from: &str, to: &str| {
        let members = object.as_object_mut().unwrap();
        let value = members.remove(from).unwrap();
        members.insert(to.to_owned(), value);
    };
    let property = |layout: &mut Value, from: &str, to: &str| {
        rename(&mut layout["edges"][0]["vehicleTypeEdgeProperties"][0], from, to);
    };
    let errors = [
        of(&|layout| rename(&mut layout["edges"][0], "vehicleTypeEdgeProperties", "vehicleTypeEdgeProperty")),
        of(&|layout| property(layout, "trajectory", "trajektory")),
        of(&|layout| rename(&mut layout["edges"][0]["vehicleTypeEdgeProperties"][0]["trajectory"], "degree", "degre")),
        of(&|layout| layout["edges"][0]["trajectory"] = arc()),
        of(&|layout| layout["nodes"][0]["theta"] = json!(1.0)),
    ];
    let expected = [
        "edge over: its key vehicleTypeEdgeProperty is not known here; it may be meant for vehicleTypeEdgeProperties",
        "edge over, properties 1: its key trajektory is not known here; it may be meant for trajectory",
        "edge over, trajectory: its key degre is not known here; it may be meant for degree",
        "edge over: its key trajectory is read in other objects of the format and not in this one",
        "node a: its key theta is read in other objects of the format and not in this one",
    ];
    for (read, expected) in errors.into_iter().zip(expected) {
        let error = read.unwrap_err();
        assert!(error.starts_with(expected), "{error}");
    }
    // In LIF 2 it is one of the other version as well.
    let mut typed = second(json!({ "mobileRobotTypes": robots() }));
    typed["origins"][0]["layouts"][0]["edges"][0]["vehicleTypeEdgeProperty"] = json!([curve]);
    let error = read(&typed, &options()).unwrap_err();
    assert!(error.contains("vehicleTypeEdgeProperty (for vehicleTypeEdgeProperties) is a name of LIF 1"), "{error}");
    // What is unknown and near nothing is told.
    let (_, warnings) = of(&|layout| layout["edges"][0]["colour"] = json!("red")).unwrap();
    assert!(warnings.contains(&"edge over: its key colour is not known, and not read".to_owned()), "{warnings:?}");
}

#[test]
fn origins_have_coordinates_of_their_own() {
    let plain = json!({ "mobileRobotTypes": robots(), "mobileRobotOrientations": [0.0] });
    let mut value = second(plain.clone());
    let mut other = value["origins"][0].clone();
    let (read_one, _) = read(&value, &options()).unwrap();
    assert_eq!((read_one.levels.len(), read_one.name.as_str()), (1, "plant"));
    assert_eq!(read_one.vehicle_types, ["M.S"]);
    // The same origin again adds to it, another one has levels of its own.
    for layout in other["layouts"].as_array_mut().unwrap() {
        for (list, id) in [("nodes", "nodeId"), ("edges", "edgeId"), ("edges", "startNodeId"), ("edges", "endNodeId")] {
            for part in layout[list].as_array_mut().unwrap() {
                part[id] = json!(format!("{}2", part[id].as_str().unwrap()));
            }
        }
    }
    value["origins"].as_array_mut().unwrap().push(other.clone());
    let (same, warnings) = read(&value, &options()).unwrap();
    assert_eq!((same.levels.len(), warnings.len(), same.edges.len()), (1, 0, 4), "{warnings:?}");
    value["origins"][1]["originId"] = json!("p");
    let (apart, warnings) = read(&value, &options()).unwrap();
    assert_eq!(apart.levels, ["o m", "p m"]);
    assert!(
        warnings[0].starts_with("origins o, p: how their layouts lie to one another is not in the file"),
        "{warnings:?}"
    );
    value["origins"][1]["layouts"][0]["edges"][0]["startNodeId"] = json!("a");
    let error = read(&value, &options()).unwrap_err();
    assert!(error.starts_with("edge over2: its nodes have different origins of coordinates"), "{error}");
    // Layouts that are in no origin have a common one, with a warning.
    let bare = json!({ "metaInformation": { "lifVersion": "2.0.0" }, "layouts": [bent(2, plain.clone())] });
    let (bare, warnings) = read(&bare, &options()).unwrap();
    assert_eq!(bare.edges.len(), 2);
    assert!(warnings[0].starts_with("LIF: its layouts are not in origins"), "{warnings:?}");
    let mut both = second(plain.clone());
    both["layouts"] = json!([bent(2, plain)]);
    assert!(read(&both, &options()).unwrap_err().contains("in origins and besides them"));
}

#[test]
fn a_property_of_several_types_is_for_each_of_them() {
    let both = json!([{ "manufacturer": "M", "seriesName": "S" }, { "manufacturer": "M", "seriesName": "T" }]);
    let value = second(json!({ "mobileRobotTypes": both, "trajectory": arc(), "maximumSpeed": 0.7 }));
    for (vehicle, known) in [("M.S", true), ("M.T", true), ("M.U", false)] {
        let read = read(&value, &ImportOptions { vehicle: Some(vehicle.into()), ..options() });
        assert_eq!(read.is_ok(), known, "{vehicle}");
        assert!(read.is_err() || read.unwrap().0.edges[0].speed[0] == Some(0.7));
    }
    let nobody = second(json!({ "mobileRobotTypes": [{ "seriesName": "S" }] }));
    assert!(read(&nobody, &options()).unwrap_err().contains("mobileRobotTypes 1, manufacturer: missing"));
}

#[test]
fn orientations_are_those_that_the_vehicle_may_have() {
    let half = std::f64::consts::PI;
    let robots = robots();
    for (property, facing) in [
        (json!({ "mobileRobotOrientations": [0.0] }), Facing::Ahead),
        (json!({ "mobileRobotOrientations": [half] }), Facing::Backward),
        (json!({ "mobileRobotOrientations": [0.0, half] }), Facing::Either),
        (json!({ "mobileRobotOrientations": [0.0, -half / 2.0] }), Facing::Any),
        // Nothing said: any.
        (json!({}), Facing::Any),
        (json!({ "mobileRobotOrientations": [] }), Facing::Any),
        (json!({ "mobileRobotOrientations": [0.0], "reachOrientationBeforeEntering": true }), Facing::Ahead),
        (json!({ "mobileRobotOrientations": [0.0], "reachOrientationBeforeEntering": false }), Facing::Any),
        (json!({ "mobileRobotOrientations": [0.0], "corridor": corridor(0.1, None) }), Facing::Any),
    ] {
        let mut property = property;
        property["mobileRobotTypes"] = robots.clone();
        let (read, _) = read(&second(property.clone()), &outlined()).unwrap();
        assert_eq!(read.edges[0].facing[0], facing, "{property}");
    }
}

fn corridor(left: f64, of: Option<&str>) -> Value {
    json!({ "maximumLeftWidth": left, "maximumRightWidth": 0.05, "corridorReferencePoint": of })
}

/// Its vehicles were taken to keep to the middle.
#[test]
fn a_corridor_is_room_that_a_vehicle_uses() {
    let room = |of: Option<&str>, options: &ImportOptions| {
        let property = json!({ "mobileRobotTypes": robots(), "corridor": corridor(1.0, of) });
        let (read, _) = read(&second(property), options).unwrap();
        assert_eq!(read.edges[0].deviation, read.edges[0].room);
        read.edges[0].room
    };
    assert_eq!([room(None, &options()), room(Some("KINEMATIC_CENTER"), &options())], [1.0, 1.0]);
    // That of the contour is narrower for the reference point, which an outline has 0.4 m from its sides.
    assert!((room(Some("CONTOUR"), &options()) - 0.6).abs() < 1e-12);
    assert!((room(Some("CONTOUR"), &outlined()) - 0.6).abs() < 1e-12);
    // A straight edge that passes another one at 1.3 m, which touches it only with its corridor.
    let beside = |corridor: Value| {
        let mut value = second(json!({ "mobileRobotTypes": robots(), "corridor": corridor }));
        let nodes = value["origins"][0]["layouts"][0]["nodes"].as_array_mut().unwrap();
        nodes[2]["nodePosition"] = json!({ "x": 8, "y": 1.3 });
        nodes[3]["nodePosition"] = json!({ "x": 12, "y": 1.3 });
        locks(&value, &options())
    };
    assert_eq!([beside(Value::Null), beside(corridor(0.4, None)), beside(corridor(0.6, None))], [0, 0, 1]);
    let refused = |corridor: Value| {
        read(&second(json!({ "mobileRobotTypes": robots(), "corridor": corridor })), &options()).unwrap_err()
    };
    assert!(refused(json!({ "maximumLeftWidth": 1.0 })).contains("corridor, rightWidth: missing"));
    assert!(refused(corridor(-1.0, None)).contains("a width of -1 m"));
    assert!(refused(corridor(1.0, Some("WHEEL"))).contains("corridorReferencePoint: WHEEL is not read"));
    assert!(refused(json!({ "maximumLeftWidt": 1.0, "maximumRightWidth": 1.0 })).contains("maximumLeftWidth"));
}

#[test]
fn where_a_physical_line_leads_is_told_or_refused() {
    let guided = |length: Value| {
        let line = json!({ "direction": "left", "length": length });
        read(&second(json!({ "mobileRobotTypes": robots(), "physicalLineGuidedProperty": line })), &options())
    };
    for length in [json!(10.0), Value::Null] {
        let (_, warnings) = guided(length).unwrap();
        assert!(
            warnings[0].starts_with("edge over: it follows a physical line, which is not in the file"),
            "{warnings:?}"
        );
    }
    let error = guided(json!(12.0)).unwrap_err();
    assert!(
        error.starts_with("edge over: it follows a physical line of 12 m, and its nodes are 10.000 m apart"),
        "{error}"
    );
}

#[test]
fn files_of_both_versions_are_known_by_what_they_have() {
    let detect = |value: &Value| InputFormat::detect("layout.json".as_ref(), &value.to_string());
    for value in [first(json!({ "vehicleTypeId": "t" })), second(json!({ "mobileRobotTypes": robots() }))] {
        assert_eq!(detect(&value), Some(InputFormat::Lif), "{value}");
    }
    // One origin with layouts is enough; what has none is no LIF.
    let layouts = json!({ "originId": "o", "layouts": [] });
    assert_eq!(detect(&json!({ "origins": [{ "originId": "p" }, layouts] })), Some(InputFormat::Lif));
    for other in [json!({ "origins": [] }), json!({ "origins": [{ "originId": "p" }] }), json!({ "origins": layouts })]
    {
        assert_eq!(detect(&other), None, "{other}");
    }
}
