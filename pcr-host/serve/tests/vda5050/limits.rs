//! Areas in which the speed is limited, and orders of vehicles.

use crate::pair::{CAN, key};
use crate::puppet::Puppet;
use crate::site::at_broker;
use pcr_formats::vda5050::topics::TopicKind;
use pcr_formats::vda5050::version::ProtocolVersion;
use pcr_serve::closed_area::ClosedArea;
use pcr_serve::owned_path::StartPose;
use pcr_serve::vehicles::vehicle::SimulatedVehicle;
use pcr_serve::vehicles::vehicle_motion::SimulatedTraits;
use serde_json::{Value, json};

/// A disc about a point of the way.
fn slow(name: &str, x: f64, speed: f64) -> ClosedArea {
    let start = StartPose { x, y: 0.0, heading: 0.0 };
    ClosedArea {
        name: name.into(),
        start,
        path: Vec::new(),
        more: Vec::new(),
        radius: 0.5,
        of: None,
        speed: Some(speed),
    }
}

/// An order along nodes at 0, 40, 80 and 120 m; the third edge has a speed of its own.
fn order() -> Value {
    let node = |k: u64| {
        json!({ "nodeId": format!("n{}", 2 * k), "sequenceId": 2 * k, "released": true, "actions": [],
            "nodePosition": { "x": 40.0 * k as f64, "y": 0.0, "mapId": "map" } })
    };
    let edge = |k: u64| {
        let mut edge = json!({ "edgeId": format!("e{k}"), "sequenceId": 2 * k + 1, "released": true, "actions": [],
            "startNodeId": format!("n{}", 2 * k), "endNodeId": format!("n{}", 2 * k + 2) });
        if k == 2 {
            edge["maxSpeed"] = json!(0.3);
        }
        edge
    };
    let (nodes, edges): (Vec<Value>, Vec<Value>) = ((0..4).map(node).collect(), (0..3).map(edge).collect());
    json!({ "orderId": "a", "orderUpdateId": 0, "nodes": nodes, "edges": edges })
}

/// The speeds of the edges in the last order that the vehicle got, by id.
fn speeds(own: &Puppet) -> Vec<(String, Option<f64>)> {
    let (_, last) = own.got.iter().rev().find(|(kind, _)| *kind == TopicKind::Order).expect("an order");
    let edges = last["edges"].as_array().expect("edges").iter();
    edges.map(|edge| (edge["edgeId"].as_str().expect("an id").to_owned(), edge["maxSpeed"].as_f64())).collect()
}

fn speed_of(own: &Puppet, edge: &str) -> Option<f64> {
    speeds(own).iter().rev().find(|it| it.0 == edge).expect("the edge").1
}

fn errors(own: &Puppet, kind: &str) -> Vec<String> {
    let errors = own.told["errors"].as_array().into_iter().flatten();
    let found = errors.filter(|error| error["errorType"] == kind);
    found.map(|error| error["errorDescription"].as_str().expect("a text").to_owned()).collect()
}

#[test]
fn edges_that_are_not_released_get_the_limit_and_of_others_the_manager_is_told() {
    // It is not granted all of its way at once.
    let mut own = Puppet::of(ProtocolVersion::V2_1, at_broker());
    // Before the order: all of it is sent with the limit, also where the edge is slow already.
    own.supervisor.close(slow("gate", 60.0, 0.5)).unwrap();
    own.supervisor.close(slow("door", 100.0, 0.4)).unwrap();
    own.manager(TopicKind::Order, order());
    own.lasts(1.0);
    assert_eq!([speed_of(&own, "e0"), speed_of(&own, "e1"), speed_of(&own, "e2")], [None, Some(0.5), Some(0.3)]);
    assert_eq!(errors(&own, "limited"), ["door limits the speed to 0.4 m/s", "gate limits the speed to 0.5 m/s"]);
    assert_eq!(errors(&own, "speedLimit"), Vec::<String>::new());
    // It has the first edge, or a part of it: a limit there comes too late, and one on the others does not.
    own.is_at("a", 0, 0, &[2], 0.0, true);
    let orders = own.orders();
    own.supervisor.close(slow("aisle", 3.0, 0.2)).unwrap();
    own.supervisor.open("gate").unwrap();
    own.supervisor.close(slow("gate", 60.0, 0.1)).unwrap();
    own.lasts(2.0);
    let told = "edge e0 was released before aisle limited the speed there to 0.2 m/s; the vehicle may be faster on it";
    assert_eq!(errors(&own, "speedLimit"), [told], "{}", own.told);
    assert!(own.orders() > orders, "{}", own.orders());
    assert_eq!(speed_of(&own, "e1"), Some(0.1), "{:?}", speeds(&own));
    // A restart keeps what the vehicle has.
    own.restart();
    own.lasts(2.0);
    assert_eq!(errors(&own, "speedLimit"), [told], "{}", own.told);
    // When it ends, nothing is left of it.
    for name in ["aisle", "gate", "door"] {
        own.supervisor.open(name).unwrap();
    }
    own.lasts(3.0);
    assert!(errors(&own, "speedLimit").is_empty() && errors(&own, "limited").is_empty(), "{}", own.told);
}

#[test]
fn vehicles_of_every_edition_are_told_in_its_name() {
    for version in ProtocolVersion::ALL {
        let mut own = Puppet::of(version, at_broker());
        own.supervisor.close(slow("gate", 60.0, 0.5)).unwrap();
        own.manager(TopicKind::Order, order());
        own.lasts(1.0);
        let (_, sent) = own.got.iter().rev().find(|(kind, _)| *kind == TopicKind::Order).expect("an order");
        let edge = sent["edges"].as_array().unwrap().iter().find(|edge| edge["edgeId"] == "e1").expect("the edge");
        let [own_name, other] = match version {
            ProtocolVersion::V3_0 => ["maximumSpeed", "maxSpeed"],
            _ => ["maxSpeed", "maximumSpeed"],
        };
        assert_eq!((edge[own_name].as_f64(), edge.get(other)), (Some(0.5), None), "{version:?}: {sent}");
    }
}

/// An update replaces the horizon by a way of the same length, on which there is a limit.
#[test]
fn a_horizon_of_the_same_length_has_limits_of_its_own() {
    let mut own = Puppet::of(ProtocolVersion::V2_1, at_broker());
    let gate = ClosedArea { start: StartPose { x: 40.0, y: 20.0, heading: 0.0 }, ..slow("gate", 0.0, 0.5) };
    own.supervisor.close(gate).unwrap();
    let node = |name: &str, sequence: u64, [x, y]: [f64; 2], released: bool| {
        json!({ "nodeId": name, "sequenceId": sequence, "released": released, "actions": [],
            "nodePosition": { "x": x, "y": y, "mapId": "map" } })
    };
    let edge = |name: &str, sequence: u64, [from, to]: [&str; 2], released: bool| {
        json!({ "edgeId": name, "sequenceId": sequence, "released": released, "actions": [],
            "startNodeId": from, "endNodeId": to })
    };
    let ahead = node("n2", 2, [40.0, 0.0], true);
    own.manager(
        TopicKind::Order,
        json!({ "orderId": "a", "orderUpdateId": 0,
            "nodes": [node("n0", 0, [0.0, 0.0], true), ahead, node("n4", 4, [80.0, 0.0], false)],
            "edges": [edge("e0", 1, ["n0", "n2"], true), edge("e1", 3, ["n2", "n4"], false)] }),
    );
    own.lasts(1.0);
    assert_eq!(speed_of(&own, "e1"), None);
    own.is_at("a", 0, 0, &[2], 0.0, true);
    own.manager(
        TopicKind::Order,
        json!({ "orderId": "a", "orderUpdateId": 1, "nodes": [ahead, node("left", 4, [40.0, 40.0], false)],
            "edges": [edge("e2", 3, ["n2", "left"], false)] }),
    );
    own.lasts(2.0);
    assert_eq!(speed_of(&own, "e2"), Some(0.5), "{:?}", speeds(&own));
}

/// It brakes before the edge, and speeds up behind it.
#[test]
fn simulated_vehicles_keep_to_the_speed_of_an_edge() {
    for (version, name) in [(ProtocolVersion::V2_1, "maxSpeed"), (ProtocolVersion::V3_0, "maximumSpeed")] {
        let can = SimulatedTraits { slip: 0.0, drift: 0.0, delay: 0.0, ..CAN };
        let start = StartPose { x: 0.0, y: 0.0, heading: 0.0 };
        let mut vehicle = SimulatedVehicle::new(key(), version, "map", can, start, 1);
        let mut order = order();
        order["edges"][2].as_object_mut().unwrap().remove("maxSpeed");
        order["edges"][1][name] = json!(0.25);
        let header = json!({ "headerId": 1, "timestamp": "2030-01-01T00:00:00.000Z", "version": version.text(),
            "manufacturer": key().manufacturer, "serialNumber": key().serial_number });
        order.as_object_mut().unwrap().extend(header.as_object().unwrap().clone());
        vehicle.receive(TopicKind::Order, order.to_string().as_bytes());
        assert_eq!(vehicle.taken(), 1, "{version:?}");
        let (mut fastest, mut before) = ([0.0_f64; 3], 0.0);
        for _ in 0..40_000 {
            vehicle.advance(0.02);
            let [x, _] = vehicle.true_position();
            let edge = ((before / 40.0) as usize).min(2);
            fastest[edge] = fastest[edge].max((x - before) / 0.02);
            before = x;
        }
        assert!((before - 120.0).abs() < 1e-3, "{version:?}: at {before} m");
        let [first, slow, last] = fastest;
        assert!(slow < 0.26 && slow > 0.24 && first > 0.9 * can.speed && last > 0.9 * can.speed, "{fastest:?}");
    }
}
