//! Orders of VDA 5050: published ones, and what the specification allows.

use pcr_formats::import::{ImportOptions, InputFormat, Warnings, scenario};
use pcr_formats::scenario::{MotionSpec, Scenario};
use pcr_planning::fleet::Fleet;
use serde_json::{Value, json};

const FLYWEI: &str = include_str!("../data/real/vda5050/order_v2_flywei.json");
const NULLS: &str = include_str!("../data/real/vda5050/order_v2_nulls_opentcs.json");

pub(crate) fn options() -> ImportOptions {
    ImportOptions {
        radius: Some(0.4),
        speed: Some(2.0),
        acceleration: Some(0.5),
        rotation: Some(1.0),
        rotation_acceleration: Some(1.0),
        ..ImportOptions::default()
    }
}

pub(crate) fn read(text: &str, options: &ImportOptions) -> Result<(Scenario, Vec<String>), String> {
    let mut warnings = Warnings::default();
    let scenario =
        scenario(InputFormat::Vda5050, text, options, &mut warnings).map_err(|error| error.problem().to_owned())?;
    Ok((scenario, warnings.lines()))
}

/// An order of 3.0 along the nodes of a square, with everything optional left out or null.
pub(crate) fn square() -> Value {
    let corners = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]];
    let nodes = corners.iter().enumerate().map(|(k, [x, y])| {
        json!({ "nodeId": format!("n{k}"), "sequenceId": 2 * k, "released": k < 3, "actions": [],
            "nodePosition": { "x": x, "y": y, "theta": null, "mapId": "m" } })
    });
    let edges = (0..3).map(|k| {
        json!({ "edgeId": format!("e{k}"), "sequenceId": 2 * k + 1, "released": k < 2, "actions": [], "trajectory": null,
            "maximumSpeed": if k == 0 { json!(0.5) } else { json!(null) } })
    });
    // Lists in any order: the numbers count.
    let (nodes, edges): (Vec<_>, Vec<_>) = (nodes.rev().collect(), edges.rev().collect());
    json!({ "orderId": "square", "version": "3.0.0", "nodes": nodes, "edges": edges })
}

fn action(name: &str) -> Value {
    json!({ "actionType": name, "actionId": name, "blockingType": "NONE" })
}

#[test]
fn published_orders() {
    for name in ["order.json", "x"] {
        assert_eq!(InputFormat::detect(name.as_ref(), FLYWEI), Some(InputFormat::Vda5050));
    }
    let (scenario, warnings) = read(FLYWEI, &options()).unwrap();
    let agent = &scenario.agents[0];
    assert_eq!((scenario.name.as_str(), agent.path.len()), ("order-pick-A14-to-DOCK-7", 1));
    assert!((agent.length() - 36.8_f64.hypot(10.5)).abs() < 1e-12);
    // 1.5 m/s on the edge, though the vehicle can do 2.
    let MotionSpec::Profile { pieces, .. } = &agent.motion else { panic!() };
    assert!((pieces[0].duration - 3.0).abs() < 1e-9 && pieces.len() == 3);
    assert!(warnings[0].contains("its actions take no time here"));
    // A test of its sender: its version is none, and all its numbers are 0.
    let refused = |text: &str| read(text, &options()).unwrap_err().replace("order some-order-id, ", "");
    assert_eq!(refused(NULLS), "version: \"version\"; 2.0, 2.1 and 3.0 are read");
    let versioned = NULLS.replace("\"version\" : \"version\"", "\"version\" : \"2.0.0\"");
    assert_eq!(refused(&versioned), "edges[0].sequenceId: [0, 0, 0] do not follow one another");
    let unnumbered = versioned.replace("\"sequenceId\" : 0", "\"sequenceId\" : null");
    assert_eq!(refused(&unnumbered), "edges[0]: missing field `sequenceId`");
    let numbered = ["0", "2", "1"].into_iter().fold(versioned, |text, number| {
        text.replacen("\"sequenceId\" : 0,", &format!("\"sequenceId\" : {number} ,"), 1)
    });
    assert_eq!(refused(&numbered), "edges[0].startNodeId: by sequenceId it is node-with-node-position-and-action");
    let joined = numbered.replace("\"source-node\"", "null").replace("\"destination-node\"", "null");
    let expected = "order some-order-id, node node-without-node-position, nodePosition: missing";
    assert_eq!(read(&joined, &options()).unwrap_err(), expected);
}

#[test]
fn the_base_is_travelled_and_the_horizon_if_asked_for() {
    let text = square().to_string();
    let (scenario, warnings) = read(&text, &options()).unwrap();
    assert_eq!(scenario.agents[0].structure(), "STS");
    assert_eq!(warnings, ["order square: 1 of 3 edges are not released and left out (--horizon)"]);
    let (scenario, warnings) = read(&text, &ImportOptions { horizon: true, ..options() }).unwrap();
    assert_eq!((scenario.agents[0].structure().as_str(), warnings.len()), ("STSTS", 0));
    // The base ends at the first node or edge that is not released.
    let mut order = square();
    for list in ["nodes", "edges"] {
        for part in order[list].as_array_mut().unwrap() {
            part["released"] = json!(true);
        }
    }
    assert_eq!(read(&order.to_string(), &options()).unwrap().0.agents[0].structure(), "STSTS");
    let released = |order: &Value, list: &str, id: &str, is_released: Value| {
        let mut order = order.clone();
        let parts = order[list].as_array_mut().unwrap();
        let part = parts.iter_mut().find(|part| part["nodeId"] == *id || part["edgeId"] == *id).unwrap();
        part["released"] = is_released;
        order
    };
    for (k, structure) in [(1, "S"), (2, "STS")] {
        let [edge, node] = [format!("e{k}"), format!("n{}", k + 1)];
        let edge_only = released(&order, "edges", &edge, json!(false));
        let both = released(&edge_only, "nodes", &node, json!(false));
        // What is released after that is no part of the base.
        let refused = format!("order square, edges[{k}].released: the base is one way up to a node");
        for wrong in [&edge_only, &released(&order, "nodes", &node, json!(false))] {
            assert_eq!(read(&wrong.to_string(), &options()).unwrap_err(), refused);
        }
        match k {
            1 => {
                assert!(read(&both.to_string(), &options()).unwrap_err().starts_with("order square, edges[2].released"))
            }
            _ => assert_eq!(read(&both.to_string(), &options()).unwrap().0.agents[0].structure(), structure),
        }
        for (list, id) in [("nodes", &node), ("edges", &edge)] {
            let text = released(&order, list, id, json!("no"));
            let error = read(&text.to_string(), &options()).unwrap_err();
            assert!(
                error.starts_with(&format!("order square, {list}[")) && error.contains("expected a boolean"),
                "{error}"
            );
            let missing = released(&order, list, id, Value::Null);
            assert!(read(&missing.to_string(), &options()).unwrap_err().ends_with(": missing field `released`"));
        }
    }
    // 0.5 m/s on the first edge: 1 s up and down, and 7 s; then a quarter turn.
    let MotionSpec::Profile { pieces, .. } = &scenario.agents[0].motion else { panic!() };
    let durations: Vec<f64> = pieces.iter().take(3).map(|piece| piece.duration.round()).collect();
    assert_eq!(durations, [1.0, 7.0, 1.0]);
}

#[test]
fn several_messages_are_several_agents() {
    let (one, other) = (square().to_string(), FLYWEI);
    for text in [format!("{one}\n{other}"), format!("[{one},{other}]"), format!("\u{feff}{one} {other}\n\n")] {
        let (scenario, _) = read(&text, &options()).unwrap();
        assert_eq!(scenario.agents.iter().map(|agent| agent.id).collect::<Vec<_>>(), [1, 2]);
        assert!(Fleet::<f64>::new(&scenario).is_ok());
    }
}

/// A quarter of a circle of radius 2, as a rational curve.
pub(crate) fn quarter() -> Value {
    json!({ "degree": 2, "knotVector": [0, 0, 0, 1, 1, 1],
        "controlPoints": [{ "x": 4, "y": 0 }, { "x": 6, "y": 0, "weight": std::f64::consts::FRAC_1_SQRT_2 }, { "x": 6, "y": 2 }] })
}

#[test]
fn trajectories_are_followed_from_node_to_node() {
    let mut order = square();
    // The lists are reversed: the second edge and the third node.
    order["edges"][1]["trajectory"] = quarter();
    order["nodes"][1]["nodePosition"] = json!({ "x": 6.0, "y": 2.0 });
    let (scenario, _) = read(&order.to_string(), &options()).unwrap();
    let agent = &scenario.agents[0];
    assert_eq!(agent.structure(), "SAA");
    assert!((agent.length() - 4.0 - std::f64::consts::PI).abs() < 1e-9);
    assert!((0.4..0.4 + 1e-6).contains(&agent.radius));
    order["nodes"][1]["nodePosition"]["y"] = json!(2.5);
    let error = read(&order.to_string(), &options()).unwrap_err();
    assert_eq!(error, "order square, edge e1: its trajectory ends 0.500 m from its node");
}

/// A vehicle that drives backward was read as if its outline faced along its path.
#[test]
fn outlines_face_as_orders_say() {
    let outlined = outlined();
    let order = |edge: Value, theta: [Value; 2]| {
        let node = |k: usize, y: f64| {
            json!({ "nodeId": format!("n{k}"), "sequenceId": 2 * k, "released": true, "actions": [],
                "nodePosition": { "x": 0.0, "y": y, "theta": theta[k], "mapId": "m" } })
        };
        let mut way = json!({ "edgeId": "e", "sequenceId": 1, "released": true, "actions": [] });
        way.as_object_mut().unwrap().extend(edge.as_object().unwrap().clone());
        json!({ "orderId": "o", "nodes": [node(0, 0.0), node(1, 5.0)], "edges": [way] }).to_string()
    };
    let none = [Value::Null, Value::Null];
    let ahead = std::f64::consts::FRAC_PI_2;
    for edge in [
        json!({}),
        json!({ "orientation": 0.0 }),
        json!({ "orientation": std::f64::consts::TAU, "orientationType": "TANGENTIAL" }),
        json!({ "orientation": ahead, "orientationType": "GLOBAL" }),
    ] {
        assert!(read(&order(edge.clone(), none.clone()), &outlined).is_ok(), "{edge}");
        assert!(read(&order(edge.clone(), [json!(1.571), json!(ahead)]), &outlined).is_ok(), "{edge}");
    }
    let backward = std::f64::consts::PI;
    let outline = |edge: Value, thetas: [Value; 2]| {
        let agent = read(&order(edge, thetas), &outlined).unwrap().0.agents.remove(0);
        (agent.footprint.map(|footprint| footprint.polygon().to_vec()), (agent.radius * 1e9).round())
    };
    let (Some(forward), reach) = outline(json!({}), none.clone()) else { panic!("no outline") };
    let turned: Vec<_> = forward.iter().map(|corner| corner.map(|x| -x)).collect();
    for thetas in [none.clone(), [json!(-ahead), json!(-ahead)]] {
        assert_eq!(outline(json!({ "orientation": backward }), thetas.clone()), (Some(turned.clone()), reach));
        let global = json!({ "orientation": -ahead, "orientationType": "GLOBAL" });
        assert_eq!(outline(global, thetas), (Some(turned.clone()), reach));
    }
    // Sideways: turned.
    for (edge, angle) in
        [(json!({ "orientation": 0.0, "orientationType": "GLOBAL" }), -ahead), (json!({ "orientation": 1.0 }), 1.0)]
    {
        let (Some(turned), own) = outline(edge.clone(), none.clone()) else { panic!("no outline") };
        assert_eq!(own, reach, "{edge}");
        let (sin, cos) = f64::sin_cos(angle);
        for ([x, y], [u, v]) in forward.iter().zip(turned) {
            assert!((x * cos - y * sin - u).hypot(x * sin + y * cos - v) < 1e-12, "{edge}");
        }
    }
    // Any way, or one of which nothing is said in version 3: the disc around it.
    for edge in
        [json!({ "orientation": 0.0, "rotationAllowed": true }), json!({ "reachOrientationBeforeEntering": false })]
    {
        assert_eq!(outline(edge.clone(), none.clone()), (None, reach), "{edge}");
        assert!(read(&order(edge, none.clone()), &options()).is_ok());
    }
    let third = |edge: Value| {
        let mut order: Value = serde_json::from_str(&order(edge, none.clone())).unwrap();
        order["version"] = json!("3.0.0");
        read(&order.to_string(), &outlined).unwrap().0.agents.remove(0).footprint.is_some()
    };
    assert!(third(json!({ "orientation": 0.0 })) && !third(json!({})));
    let degrees = read(&order(json!({ "orientation": 180.0 }), none.clone()), &outlined).unwrap_err();
    assert!(degrees.contains("orientation: 180 is more than one turn; the format has radians"), "{degrees}");
    for theta in [[json!(-ahead), Value::Null], [Value::Null, json!(backward)]] {
        let error = read(&order(json!({}), theta), &outlined).unwrap_err();
        assert!(error.contains(": its theta ") && error.contains("outlines face along their paths"), "{error}");
    }
    // Who stands faces as it says.
    let standing = json!({ "orderId": "o", "edges": [],
        "nodes": [{ "nodeId": "a", "sequenceId": 0, "released": true, "nodePosition": { "x": 1.0, "y": 2.0, "theta": 0.5 } }] });
    assert_eq!(read(&standing.to_string(), &outlined).unwrap().0.agents[0].start, [1.0, 2.0, 0.5]);
    // Degrees are refused where a heading counts, never turned fourteen times.
    let mut degrees = standing;
    degrees["nodes"][0]["nodePosition"]["theta"] = json!(90);
    let error = read(&degrees.to_string(), &outlined).unwrap_err();
    assert!(error.contains("nodePosition, theta: 90 is more than one turn; the format has radians"), "{error}");
    let error = read(&order(json!({}), [json!(180), Value::Null]), &outlined).unwrap_err();
    assert!(error.contains("theta: 180 is more than one turn; the format has radians"), "{error}");
}

#[test]
fn what_is_wrong_is_named() {
    let broken = |pointer: &str, value: Value| {
        let mut order = square();
        *order.pointer_mut(pointer).unwrap() = value;
        read(&order.to_string(), &ImportOptions { horizon: true, ..options() }).unwrap_err()
    };
    assert_eq!(broken("/edges", json!([])), "order square, nodes: 4 nodes and 0 edges are no way");
    assert_eq!(
        broken("/nodes/0/nodeId", json!(3)),
        "order square, nodes[0].nodeId: invalid type: integer `3`, expected a string"
    );
    assert_eq!(
        broken("/edges/2/maximumSpeed", json!(-1)),
        "order square, edge e0, maximumSpeed: -1 where a number above 0 is expected"
    );
    assert_eq!(
        broken("/edges/2/maximumSpeed", json!(0)),
        "order square, edge e0, maximumSpeed: 0 where a number above 0 is expected"
    );
    for degree in [json!(0), json!(1.5), json!(65)] {
        let error = broken("/edges/1/trajectory", json!({ "degree": degree, "controlPoints": [] }));
        assert_eq!(error, format!("order square, edge e1, trajectory: degree {degree}, which is no degree"));
    }
    assert_eq!(
        broken("/nodes/0/nodePosition/x", json!(1e300)),
        "order square, nodes[0].nodePosition.x: 1e300 is out of range; allowed is up to 1e10"
    );
    assert_eq!(
        broken("/nodes/0/nodePosition/x", json!(-1e300)),
        "order square, nodes[0].nodePosition.x: -1e300 is out of range; allowed is up to 1e10"
    );
    assert_eq!(broken("/nodes", json!(null)), "order square, missing field `nodes`");
}

/// A curve that no two arcs are, from (4, 0) to (8, 2).
fn curve() -> Value {
    json!({ "degree": 3, "controlPoints": [{ "x": 4, "y": 0 }, { "x": 7, "y": 0 }, { "x": 5, "y": 2 }, { "x": 8, "y": 2 }] })
}

#[test]
fn deviations_make_agents_larger_and_are_told() {
    let mut order = square();
    order["edges"][1]["trajectory"] = curve();
    order["edges"][1]["corridor"] = json!({ "leftWidth": 1.0, "rightWidth": 1.0 });
    order["nodes"][1]["nodePosition"] = json!({ "x": 8.0, "y": 2.0 });
    let (scenario, _) = read(&order.to_string(), &options()).unwrap();
    let wide = scenario.agents[0].radius;
    order["edges"][1].as_object_mut().unwrap().remove("corridor");
    let (scenario, warnings) = read(&order.to_string(), &options()).unwrap();
    let radius = scenario.agents[0].radius;
    assert!(radius > 0.4 + 1e-5 && radius < 0.4 + 1.1e-3, "{radius}");
    assert!((wide - radius - 1.0).abs() < 1e-9, "{wide} {radius}");
    assert!(warnings.iter().any(|line| line.starts_with("agent 1: its lines and arcs are up to")), "{warnings:?}");
    let state = |y: f64| {
        json!({ "serialNumber": "r", "nodeStates": [], "plannedPath": { "trajectory": curve() },
            "mobileRobotPosition": { "x": 4.0, "y": y } })
        .to_string()
    };
    let (scenario, warnings) = read(&state(0.0), &options()).unwrap();
    assert!((scenario.agents[0].radius - radius).abs() < 1e-6);
    assert_eq!(warnings.len(), 1, "{warnings:?}");
    assert!(warnings[0].starts_with("agent 1: its lines and arcs are up to"), "{warnings:?}");
    let beside = json!({ "serialNumber": "r", "nodeStates": [], "mobileRobotPosition": { "x": 0.0, "y": 2.5 },
        "plannedPath": { "trajectory": { "controlPoints": [{ "x": 0, "y": 3 }, { "x": 5, "y": 3 }] } } });
    assert!(read(&beside.to_string(), &options()).unwrap_err().contains("it begins 0.500 m from where"));
    // What is not refused makes it larger.
    let (scenario, _) = read(&state(-0.04), &options()).unwrap();
    assert!((scenario.agents[0].radius - radius - 0.04).abs() < 1e-6);
}

#[test]
fn orders_stay_on_a_map_and_stand_where_they_have_no_edges() {
    let node = |id: &str, x: f64, map: &str| {
        json!({ "nodeId": id, "sequenceId": if x == 3.0 { 2 } else { 0 }, "released": true,
            "nodePosition": { "x": x, "y": 1.0, "mapId": map } })
    };
    let order = |nodes: Value, edges: usize| {
        let released = nodes.as_array().unwrap().last().unwrap()["released"].clone();
        let edge = |k: usize| json!({ "edgeId": format!("e{k}"), "sequenceId": 2 * k + 1, "released": released });
        let edges: Vec<Value> = (0..edges).map(edge).collect();
        json!({ "orderId": "o", "nodes": nodes, "edges": edges }).to_string()
    };
    let (scenario, warnings) = read(&order(json!([node("a", 0.0, "m"), node("b", 3.0, "m")]), 1), &options()).unwrap();
    assert_eq!((scenario.agents[0].structure().as_str(), warnings.len()), ("S", 0));
    let (scenario, _) = read(&order(json!([node("a", 2.0, "m")]), 0), &options()).unwrap();
    assert_eq!((scenario.agents[0].path.len(), scenario.agents[0].start), (0, [2.0, 1.0, 0.0]));
    let nowhere = json!([{ "nodeId": "a", "sequenceId": 0, "released": true }]);
    let nowhere = read(&order(nowhere, 0), &options()).unwrap_err();
    assert_eq!(nowhere, "order o, node a, nodePosition: missing");
    let across = order(json!([node("a", 0.0, "m"), node("b", 3.0, "n")]), 1);
    assert_eq!(read(&across, &options()).unwrap_err(), "order o: it leads from map m to map n");
    let two = format!("{} {}", order(json!([node("a", 0.0, "m")]), 0), order(json!([node("a", 0.0, "n")]), 0));
    let (_, warnings) = read(&two, &options()).unwrap();
    assert_eq!(warnings, ["maps m, n: the agents are on several, which a scenario does not tell apart"]);
    let mut count = 0;
    let mut state = |map: &str| {
        count += 1;
        let pose = json!({ "x": 1.0, "y": 2.0, "theta": 0.5, "mapId": map });
        json!({ "serialNumber": format!("{count}"), "nodeStates": [], "mobileRobotPosition": pose }).to_string()
    };
    assert!(read(&format!("{} {}", state("m"), state("m")), &options()).unwrap().1.is_empty());
    let (_, warnings) = read(&format!("{} {}", state("m"), state("n")), &options()).unwrap();
    assert_eq!(warnings, ["maps m, n: the agents are on several, which a scenario does not tell apart"]);
    // What is beyond the base is not travelled: neither its map nor its actions count.
    let mut beyond = node("b", 3.0, "n");
    (beyond["released"], beyond["actions"]) = (json!(false), json!([action("pick")]));
    let (scenario, warnings) = read(&order(json!([node("a", 0.0, "m"), beyond]), 1), &options()).unwrap();
    assert_eq!(scenario.agents[0].path.len(), 0);
    assert_eq!(warnings, ["order o: 1 of 1 edges are not released and left out (--horizon)"]);
}

/// Options of a vehicle of 1 m by 0.8 m, of which the back is nearer than the front.
pub(crate) fn outlined() -> ImportOptions {
    let fleet = concat!(env!("CARGO_MANIFEST_DIR"), "/data/small/factsheet.json");
    ImportOptions {
        fleet: Some(fleet.into()),
        rotation: Some(1.0),
        rotation_acceleration: Some(1.0),
        ..ImportOptions::default()
    }
}

/// What it did after the first node was left aside, and it stood as there.
#[test]
fn who_turns_in_place_is_the_disc_around_the_outline() {
    let order = |thetas: [Value; 3]| {
        let node = |k: usize| {
            json!({ "nodeId": format!("n{k}"), "sequenceId": 2 * k, "released": true,
                "nodePosition": { "x": 1.0, "y": 2.0, "theta": thetas[k], "mapId": "m" } })
        };
        let edges = [1, 3].map(|number| json!({ "edgeId": "e", "sequenceId": number, "released": true }));
        json!({ "orderId": "o", "nodes": [node(0), node(1), node(2)], "edges": edges }).to_string()
    };
    let read = |thetas| read(&order(thetas), &outlined()).unwrap().0.agents.remove(0);
    for same in [[json!(0.5), json!(0.5), json!(0.5)], [json!(0.5), Value::Null, json!(0.5)]] {
        let agent = read(same);
        assert_eq!((agent.footprint.is_some(), agent.start), (true, [1.0, 2.0, 0.5]));
    }
    for turned in [[json!(0.5), Value::Null, json!(0.6)], [Value::Null, json!(0.5), json!(0.5)]] {
        let agent = read(turned);
        assert!(agent.footprint.is_none() && agent.path.is_empty(), "{agent:?}");
    }
}

/// The last one counted.
#[test]
fn what_is_there_twice_is_refused() {
    let text = square().to_string();
    let twice = text.replacen("\"orderId\":", "\"nodes\":[],\"orderId\":", 1);
    assert_eq!(twice.matches("\"nodes\"").count(), 2);
    let error = read(&twice, &options()).unwrap_err();
    assert!(error.contains("not JSON: \"nodes\" is there twice"), "{error}");
    let error = read(&text.replacen("\"released\":", "\"released\":true,\"released\":", 1), &options()).unwrap_err();
    assert!(error.contains("not JSON: \"released\" is there twice"), "{error}");
}

/// They were left aside with a contour.
#[test]
fn control_points_say_how_an_outline_faces() {
    let order = |orientations: [Value; 3], middle: f64| {
        let point = |k: usize, x: f64, y: f64| json!({ "x": x, "y": y, "orientation": orientations[k] });
        let curve =
            json!({ "degree": 2, "controlPoints": [point(0, 0.0, 0.0), point(1, 3.0, middle), point(2, 6.0, 0.0)] });
        let node = |id: &str, x: f64| {
            json!({ "nodeId": id, "sequenceId": if x == 0.0 { 0 } else { 2 }, "released": true,
                "nodePosition": { "x": x, "y": 0.0 } })
        };
        let edge = json!({ "edgeId": "e", "sequenceId": 1, "released": true, "trajectory": curve });
        json!({ "orderId": "o", "nodes": [node("a", 0.0), node("b", 6.0)], "edges": [edge] }).to_string()
    };
    let none = Value::Null;
    // World coordinates: 0 is along the line, and aside of a curve.
    assert!(read(&order([json!(0.0), json!(0.0), json!(0.0)], 0.0), &outlined()).is_ok());
    // Somewhere in the middle of the curve it is along it.
    assert!(read(&order([none.clone(), json!(0.0), none.clone()], 3.0), &outlined()).is_ok());
    let slope = 1.0_f64.atan2(1.0);
    assert!(read(&order([json!(slope), none.clone(), json!(-slope)], 3.0), &outlined()).is_ok());
    for (orientations, middle, place) in [
        ([json!(1.57), none.clone(), none.clone()], 0.0, 1),
        ([none.clone(), json!(1.57), none.clone()], 0.0, 2),
        ([none.clone(), none.clone(), json!(-1.57)], 0.0, 3),
        ([json!(0.0), none.clone(), none.clone()], 3.0, 1),
        ([none.clone(), json!(1.57), none.clone()], 3.0, 2),
    ] {
        let text = order(orientations, middle);
        let error = read(&text, &outlined()).unwrap_err();
        assert!(error.contains(&format!("control point {place}: its orientation ")), "{error}");
        assert!(read(&text, &options()).is_ok(), "it does not matter how a disc faces");
    }
}

/// One of another type made two vehicles of one, and parts that were missing were no fault.
#[test]
fn names_are_texts_and_numbers_go_on() {
    for field in ["serialNumber", "orderId", "manufacturer"] {
        let mut order = square();
        order["serialNumber"] = json!("r");
        order[field] = json!(5);
        let error = read(&order.to_string(), &options()).unwrap_err();
        let said = ["a number where a text is expected", "invalid type: integer `5`, expected a string", "not a text"];
        assert!(said.iter().any(|said| error.ends_with(&format!("{field}: {said}"))), "{error}");
    }
    let numbered = |pointer: &str, number: Value| {
        let mut order = square();
        *order.pointer_mut(pointer).unwrap() = number;
        read(&order.to_string(), &options()).map_err(|error| error.replace("order square, ", ""))
    };
    // The lists are reversed: n3 is the first one, and e2.
    for (pointer, number, numbers) in [("/nodes/0/sequenceId", 8, "[4, 5, 8]"), ("/edges/0/sequenceId", 7, "[4, 7, 6]")]
    {
        let error = numbered(pointer, json!(number)).unwrap_err();
        assert_eq!(error, format!("edges[2].sequenceId: {numbers} do not follow one another"));
    }
    assert!(numbered("/nodes/0/sequenceId", json!(4)).is_err(), "which of two comes first is not said");
    assert_eq!(numbered("/nodes/0/sequenceId", Value::Null).unwrap_err(), "nodes[0]: missing field `sequenceId`");
    for wrong in [json!(-1), json!(2.5), json!("6")] {
        let error = numbered("/nodes/0/sequenceId", wrong).unwrap_err();
        assert!(error.starts_with("nodes[0].sequenceId: invalid "), "{error}");
    }
    // What begins elsewhere than at 0 is an update, of which the order is missing.
    let mut later = square();
    for part in ["nodes", "edges"] {
        for part in later[part].as_array_mut().unwrap() {
            part["sequenceId"] = json!(part["sequenceId"].as_u64().unwrap() + 4);
        }
    }
    let (scenario, warnings) = read(&later.to_string(), &options()).unwrap();
    assert_eq!(scenario.agents[0].structure(), "STS");
    let alone = "order square: the order before it is not there; it is read as if the vehicle began at its first node";
    assert!(warnings.iter().any(|line| line == alone), "{warnings:?}");
}

/// They were only looked for at nodes, and what was no list was none.
#[test]
fn actions_of_edges_are_told_and_have_to_be_lists() {
    let mut order = square();
    order["edges"][2]["actions"] = json!([action("beep")]);
    let (_, warnings) = read(&order.to_string(), &options()).unwrap();
    assert!(warnings.iter().any(|line| line.starts_with("order square: its actions take no time")), "{warnings:?}");
    for (pointer, name) in [("/nodes/3/actions", "nodes[3]"), ("/edges/2/actions", "edges[2]")] {
        let mut order = square();
        *order.pointer_mut(pointer).unwrap() = json!(5);
        let error = read(&order.to_string(), &options()).unwrap_err();
        assert_eq!(error, format!("order square, {name}.actions: invalid type: integer `5`, expected a sequence"));
    }
}

/// Who may leave the way, or turn on it, was told of places only.
#[test]
fn what_an_outline_may_do_is_told() {
    let mut order = square();
    order["nodes"][3]["nodePosition"]["allowedDeviationXy"] = json!(0.5);
    order["nodes"][3]["nodePosition"]["allowedDeviationTheta"] = json!(3.0);
    order["edges"][2]["rotationAllowed"] = json!(true);
    let told = |options: &ImportOptions| {
        let (_, warnings) = read(&order.to_string(), options).unwrap();
        let said = ["allowedDeviationXy is not", "allowedDeviationTheta is not"];
        said.map(|said| warnings.iter().any(|line| line.contains(said)))
    };
    assert_eq!(told(&outlined()), [true; 2]);
    assert_eq!(told(&options()), [true, false]);
    // One that rotates on its way covers the disc around it.
    assert!(read(&order.to_string(), &outlined()).unwrap().0.agents[0].footprint.is_none());
}
