//! Messages of VDA 5050 about one vehicle, vehicles of which it is not said where they face, and gaps that count.

use crate::import_vda5050::{options, read};
use pcr_formats::import::ImportOptions;
use serde_json::{Value, json};

/// Nodes n0, n1, … every 5 m along the x axis, those from `from` up to `to`, released up to `base`.
fn order(update: u64, from: usize, to: usize, base: usize) -> Value {
    let node = |k: usize| {
        json!({ "nodeId": format!("n{k}"), "sequenceId": 2 * k, "released": k <= base, "actions": [],
            "nodePosition": { "x": 5.0 * k as f64, "y": 0.0, "mapId": "m" } })
    };
    let edge =
        |k: usize| json!({ "edgeId": format!("e{k}"), "sequenceId": 2 * k + 1, "released": k < base, "actions": [] });
    json!({ "orderId": "o", "orderUpdateId": update, "manufacturer": "M", "serialNumber": "R",
        "nodes": (from..=to).map(node).collect::<Vec<_>>(), "edges": (from..to).map(edge).collect::<Vec<_>>() })
}

fn lengths(messages: &[&Value]) -> Result<Vec<f64>, String> {
    let text: Vec<String> = messages.iter().map(ToString::to_string).collect();
    Ok(read(&text.join("\n"), &options())?.0.agents.iter().map(|agent| agent.length()).collect())
}

/// Each message was a vehicle of its own that began at the time 0.
#[test]
fn an_order_and_its_updates_are_one_way_of_one_vehicle() {
    let [first, second, third] = [order(0, 0, 2, 1), order(1, 1, 3, 2), order(2, 2, 4, 4)];
    let mut other = order(0, 0, 1, 1);
    other["serialNumber"] = json!("Q");
    assert_eq!(lengths(&[&first]), Ok(vec![5.0]));
    assert_eq!(lengths(&[&first, &second]), Ok(vec![10.0]));
    for all in [[&first, &second, &third, &other], [&third, &second, &other, &first]] {
        assert_eq!(lengths(&all), Ok(vec![20.0, 5.0]));
    }
    // Without the second the order ends at n1.
    let name = "order o, update 2, ";
    let gap = "it begins at n2 (4), but the base ends at n1 (2) and cannot be changed";
    assert!(lengths(&[&first, &third]).unwrap_err().contains(&format!("{name}nodes[0]: {gap}")));
    // One that was sent again counts once, and one that says something else is no update.
    assert_eq!(lengths(&[&first, &first, &second, &second]), Ok(vec![10.0]));
    let refused = |messages: &[&Value], expected: &str| {
        let error = lengths(messages).unwrap_err();
        assert!(error.contains(&format!("order o, update 1, {expected}")), "{error}");
    };
    refused(&[&first, &second, &order(1, 1, 4, 4)], "orderUpdateId: 1 was taken already, with another content");
    let elsewhere =
        |is: &str| format!("nodes[0]: it begins at {is}, but the base ends at n1 (2) and cannot be changed");
    refused(&[&first, &order(1, 3, 4, 4)], &elsewhere("n3 (6)"));
    refused(&[&first, &order(1, 0, 4, 4)], &elsewhere("n0 (0)"));
    let mut renamed = second.clone();
    renamed["nodes"][0]["nodeId"] = json!("elsewhere");
    refused(&[&first, &renamed], &elsewhere("elsewhere (2)"));
    let mut unnumbered = second.clone();
    unnumbered["nodes"][0]["sequenceId"] = Value::Null;
    refused(&[&first, &unnumbered], "nodes[0]: missing field `sequenceId`");
    // Two orders, or an order and a state, would be two vehicles at one place.
    let several = "vehicle R: several messages are about it; one order with its updates, or one state is expected";
    let mut next = order(0, 1, 2, 2);
    next["orderId"] = json!("p");
    let state = json!({ "manufacturer": "M", "serialNumber": "R", "nodeStates": [],
        "mobileRobotPosition": { "x": 0.0, "y": 0.0, "theta": 0.0, "mapId": "m" } });
    for others in [[&first, &next], [&first, &state], [&state, &first], [&state, &state]] {
        assert_eq!(lengths(&others), Err(several.to_owned()));
    }
    // Of another manufacturer the same number is another vehicle; without a number nobody knows.
    let mut foreign = first.clone();
    foreign["manufacturer"] = json!("N");
    assert_eq!(lengths(&[&first, &foreign]), Ok(vec![5.0; 2]));
    let mut unnamed = first.clone();
    unnamed["serialNumber"] = Value::Null;
    assert_eq!(lengths(&[&unnamed, &unnamed]), Ok(vec![5.0; 2]));
    // Without a manufacturer it could be either.
    unnamed["serialNumber"] = json!("R");
    unnamed["manufacturer"] = Value::Null;
    assert_eq!(lengths(&[&unnamed, &first]), Err("vehicle R: its manufacturer is not in all messages".to_owned()));
}

/// Orders, updates and a vehicle that stands, as files gave them; the nodes of `order` with names and places of their own.
fn way(update: u64, first: usize, nodes: &[(&str, [f64; 2])]) -> Value {
    let node = |(k, (name, [x, y])): (usize, &(&str, [f64; 2]))| {
        json!({ "nodeId": name, "sequenceId": 2 * (first + k), "released": true, "actions": [],
            "nodePosition": { "x": x, "y": y, "mapId": "m" } })
    };
    let edge = |k: usize| {
        json!({ "edgeId": format!("e{k}"), "sequenceId": 2 * (first + k) - 1, "released": true, "actions": [],
            "startNodeId": nodes[k - 1].0, "endNodeId": nodes[k].0 })
    };
    json!({ "version": "2.0.0", "orderId": "o", "orderUpdateId": update, "manufacturer": "M", "serialNumber": "R",
        "nodes": nodes.iter().enumerate().map(node).collect::<Vec<_>>(),
        "edges": (1..nodes.len()).map(edge).collect::<Vec<_>>() })
}

/// It was taken at any node, so that the vehicle left its base, and did not meet the one that stood there.
#[test]
fn an_update_that_a_vehicle_refuses_is_refused_and_the_base_stays() {
    let base = way(0, 0, &[("A", [0.0, 0.0]), ("B", [10.0, 0.0]), ("C", [10.0, 10.0])]);
    let mut other = way(0, 0, &[("B2", [10.0, 0.5])]);
    (other["serialNumber"], other["orderId"]) = (json!("R2"), json!("o2"));
    let leaves = way(1, 0, &[("A", [0.0, 0.0]), ("D", [0.0, 10.0])]);
    let moved = way(1, 2, &[("C", [20.0, 0.0]), ("D", [30.0, 0.0])]);
    let mut horizon = base.clone();
    for part in [&["nodes", "2"], &["edges", "1"]] {
        horizon[part[0]][part[1].parse::<usize>().unwrap()]["released"] = json!(false);
    }
    let ahead = way(1, 2, &[("C", [10.0, 10.0]), ("D", [0.0, 10.0])]);
    let partial = ImportOptions { partial: true, ..options() };
    for (first, update, length, problem) in [
        (&base, &leaves, 20.0, "nodes[0]: it begins at A (0), but the base ends at C (4) and cannot be changed"),
        (&base, &moved, 20.0, "nodes[0].nodePosition: node C is 14.142 m from where it was"),
        (&horizon, &ahead, 10.0, "nodes[0]: it begins at C (4), but the base ends at B (2) and cannot be changed"),
    ] {
        let problem = format!("order o, update 1, {problem}");
        let text = [first, update, &other].map(Value::to_string).join("\n");
        let error = read(&text, &options()).unwrap_err();
        assert!(error.contains(&problem), "{error}");
        let (scenario, warnings) = read(&text, &partial).unwrap();
        assert!(warnings.contains(&format!("{problem}: left out")), "{warnings:?}");
        assert!((scenario.agents[0].length() - length).abs() < 1e-6);
    }
    // Alone, it is not known where the vehicle was before.
    let (_, warnings) = read(&ahead.to_string(), &options()).unwrap();
    let alone =
        "order o, update 1: the order before it is not there; it is read as if the vehicle began at its first node";
    assert!(warnings.contains(&alone.to_owned()), "{warnings:?}");
}

/// What else a fleet manager says changes the way, and was refused as no message at all, or made two vehicles of one.
#[test]
fn what_halts_a_vehicle_or_gives_it_zones_is_refused_by_name() {
    let first = order(0, 0, 2, 2);
    let message = |field: &str, content: Value| json!({ "manufacturer": "M", "serialNumber": "R", field: content });
    let action = |name: &str| json!([{ "actionType": name, "actionId": "a", "blockingType": "NONE" }]);
    for (message, problem) in [
        (
            message("actions", action("cancelOrder")),
            "cancelOrder is sent to it; where it stops then is not in the file",
        ),
        (message("instantActions", action("startPause")), "startPause is sent to it; where it stops then"),
        (message("actions", action("enableZoneSet")), "enableZoneSet is sent to it; zones are not read"),
        (message("zoneSet", json!({ "zoneSetId": "z", "zones": [] })), "a zone set is sent to it, which is not read"),
    ] {
        for both in [[&first, &message], [&message, &first]] {
            let error = lengths(&both).unwrap_err();
            assert!(error.starts_with(&format!("vehicle R: {problem}")), "{error}");
        }
    }
}

/// They were refused for the number of their points.
#[test]
fn a_trajectory_without_points_is_refused_by_what_is_missing() {
    for trajectory in [json!({}), json!({ "type": "Straight" }), json!({ "degree": 1, "controlPoints": [] })] {
        let mut order = order(0, 0, 1, 1);
        order["edges"][0]["trajectory"] = trajectory;
        let error = read(&order.to_string(), &options()).unwrap_err();
        assert!(error.starts_with("order o, edge e0, trajectory") && error.contains("controlPoints"), "{error}");
        order["edges"][0]["trajectory"] = Value::Null;
        assert!(read(&order.to_string(), &options()).is_ok());
    }
}

/// It faced east.
#[test]
fn an_outline_that_faces_nobody_knows_where_to_is_the_disc_around_it() {
    let outlined = ImportOptions {
        fleet: Some(concat!(env!("CARGO_MANIFEST_DIR"), "/data/small/factsheet.json").into()),
        rotation: Some(1.0),
        rotation_acceleration: Some(1.0),
        ..ImportOptions::default()
    };
    let place = |theta: Value| json!({ "x": 1.0, "y": 2.0, "theta": theta, "mapId": "m" });
    let stands = |theta: Value| {
        let node = json!({ "nodeId": "a", "sequenceId": 0, "released": true, "nodePosition": place(theta) });
        json!({ "orderId": "o", "nodes": [node], "edges": [] })
    };
    let is = |theta: Value| json!({ "serialNumber": "R", "nodeStates": [], "mobileRobotPosition": place(theta) });
    let mut unreleased = order(0, 0, 1, 0);
    for node in 0..2 {
        unreleased["nodes"][node]["nodePosition"]["theta"] = Value::Null;
    }
    let reach = read(&stands(json!(0.5)).to_string(), &outlined).unwrap().0.agents[0].radius;
    for message in [stands(Value::Null), is(Value::Null), unreleased] {
        let agent = &read(&message.to_string(), &outlined).unwrap().0.agents[0];
        assert!(agent.footprint.is_none() && agent.radius >= reach, "{message}");
    }
    for message in [stands(json!(0.5)), is(json!(0.5)), order(0, 0, 1, 1)] {
        assert!(read(&message.to_string(), &outlined).unwrap().0.agents[0].footprint.is_some(), "{message}");
    }
}

/// Gaps up to 5 cm were left aside.
#[test]
fn gaps_to_nodes_make_a_vehicle_larger() {
    let curve =
        |from: f64, to: f64| json!({ "degree": 1, "controlPoints": [{ "x": from, "y": 0.0 }, { "x": to, "y": 0.0 }] });
    for ([from, to], gap) in [([0.0, 5.0], 0.0), ([0.049, 5.0], 0.049), ([0.0, 5.03], 0.03), ([0.02, 4.96], 0.04)] {
        let mut order = order(0, 0, 2, 2);
        order["edges"][0]["trajectory"] = curve(from, to);
        let (scenario, warnings) = read(&order.to_string(), &options()).unwrap();
        let radius = scenario.agents[0].radius;
        assert!((radius - 0.4 - gap).abs() < 1e-6, "{radius} {gap}");
        assert_eq!(warnings.len(), usize::from(gap > 0.0), "{warnings:?}");
    }
}

#[test]
fn allowed_deviations_are_told() {
    for (allowed, told) in [
        (json!(0.0), 0),
        (json!(3.0), 1),
        (json!({ "a": 0.5, "b": 0.0, "theta": 0.0 }), 1),
        (json!({ "a": 0.0, "b": 0.0 }), 0),
    ] {
        let mut order = order(0, 0, 1, 1);
        order["nodes"][1]["nodePosition"]["allowedDeviationXY"] = allowed;
        let (_, warnings) = read(&order.to_string(), &options()).unwrap();
        assert_eq!(warnings.iter().filter(|line| line.contains("allowedDeviationXY is not read")).count(), told);
    }
}

/// Nothing was said, and of two limits the first one counted.
#[test]
fn lengths_are_compared_and_the_lower_of_two_limits_counts() {
    for (length, told) in [(Value::Null, 0), (json!(0), 0), (json!(5.0), 0), (json!(5.09), 0), (json!(9.5), 1)] {
        let mut straight = order(0, 0, 1, 1);
        straight["edges"][0]["length"] = length;
        let mut curved = straight.clone();
        let points = json!([{ "x": 0, "y": 0 }, { "x": 5, "y": 0 }]);
        curved["edges"][0]["trajectory"] = json!({ "degree": 1, "controlPoints": points });
        for order in [straight, curved] {
            let (_, warnings) = read(&order.to_string(), &options()).unwrap();
            assert_eq!(warnings.iter().filter(|line| line.contains("its length is not that")).count(), told, "{order}");
        }
    }
    let lasts = |limits: [f64; 2]| {
        let mut order = order(0, 0, 1, 1);
        (order["edges"][0]["maxSpeed"], order["edges"][0]["maximumSpeed"]) = (json!(limits[0]), json!(limits[1]));
        let (scenario, _) = read(&order.to_string(), &options()).unwrap();
        pcr_planning::fleet::Fleet::<f64>::new(&scenario).unwrap().motions()[0].time().hi
    };
    // 5 m at 0.1 m/s, with 0.1 s to speed up and as much to brake.
    assert!((lasts([1.0, 0.1]) - 50.2).abs() < 1e-6 && (lasts([0.1, 1.0]) - 50.2).abs() < 1e-6);
}

/// Differences of knots were infinite, and the curve was nowhere: nothing met anything.
#[test]
fn knots_out_of_range_are_refused() {
    let curve = |most: f64, middle: f64| {
        let mut order = order(0, 0, 1, 1);
        let points = [[0.0, 0.0], [1.0, 2.0], [4.0, 2.0], [5.0, 0.0]].map(|[x, y]| json!({ "x": x, "y": y }));
        let knots = [-most, -most, -most, middle, most, most, most];
        order["edges"][0]["trajectory"] = json!({ "degree": 2, "controlPoints": points, "knotVector": knots });
        read(&order.to_string(), &options())
    };
    let [small, large] = [1.0, 1e10].map(|most| curve(most, 0.0).unwrap().0.agents[0].length());
    assert!((small - large).abs() < 1e-6 && small > 6.0, "{small} {large}");
    for (most, middle) in [(1e308, 1e-300), (1e11, 0.0)] {
        let error = curve(most, middle).unwrap_err();
        assert!(error.contains("is out of range; allowed is up to 1e10"), "{error}");
    }
}

/// The place of a vehicle on curves was that of the arcs, whose lengths differ.
#[test]
fn vehicles_that_meet_on_long_curves_are_told() {
    // Waves that a loose fit straightens: their length is half as much again.
    let wave: Vec<Value> = (0..=10).map(|k| json!({ "x": 2 * k, "y": if k % 2 == 0 { 0.0 } else { 1.0 } })).collect();
    let mut order = order(0, 0, 4, 4);
    order["nodes"] = json!([order["nodes"][0], order["nodes"][4]]);
    order["nodes"][1]["sequenceId"] = json!(2);
    order["edges"] = json!([{ "edgeId": "e", "sequenceId": 1, "released": true, "actions": [],
        "trajectory": { "degree": 3, "controlPoints": wave } }]);
    let radius = |tolerance: f64| {
        let (scenario, _) =
            read(&order.to_string(), &ImportOptions { tolerance: Some(tolerance), ..options() }).unwrap();
        (scenario.agents[0].radius - 0.4, scenario.agents[0].length())
    };
    let (fine, whole) = radius(1e-6);
    for tolerance in [0.5, 0.1, 1e-2, 1e-3] {
        let (off, length) = radius(tolerance);
        assert!(off >= (whole - length).abs() - fine, "{off} {length} {whole}");
    }
    assert!(radius(0.5).0 > 0.01 && fine < 1e-4, "{fine}");
}
