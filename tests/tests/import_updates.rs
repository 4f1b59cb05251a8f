//! Messages of VDA 5050 about one vehicle, vehicles of which it is not said where they face, and gaps that count.

use crate::import_vda5050::{options, read};
use pcr_formats::import::Options;
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
    // Without the second the way from n1 to n2 is not released.
    assert_eq!(lengths(&[&first, &third]), Ok(vec![5.0]));
    // One that was sent again counts once, and one that says something else is no update.
    assert_eq!(lengths(&[&first, &first, &second, &second]), Ok(vec![10.0]));
    let name = "order o, update 1: ";
    assert_eq!(
        lengths(&[&first, &second, &order(1, 1, 4, 4)]),
        Err(format!("{name}it is there twice, and not the same"))
    );
    let gap = "the order before it does not have its first node";
    assert_eq!(lengths(&[&first, &order(1, 3, 4, 4)]), Err(format!("{name}{gap}")));
    let mut renamed = second.clone();
    renamed["nodes"][0]["nodeId"] = json!("elsewhere");
    assert_eq!(lengths(&[&first, &renamed]), Err(format!("{name}{gap}")));
    let mut unnumbered = second.clone();
    unnumbered["nodes"][0]["sequenceId"] = Value::Null;
    assert_eq!(lengths(&[&first, &unnumbered]), Err(format!("{name}it has no nodes with a sequenceId")));
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

/// It faced east.
#[test]
fn an_outline_that_faces_nobody_knows_where_to_is_the_disc_around_it() {
    let outlined = Options {
        fleet: Some(concat!(env!("CARGO_MANIFEST_DIR"), "/data/small/factsheet.json").into()),
        rotation: Some(1.0),
        rotation_acceleration: Some(1.0),
        ..Options::default()
    };
    let place = |theta: Value| json!({ "x": 1.0, "y": 2.0, "theta": theta, "mapId": "m" });
    let stands = |theta: Value| json!({ "orderId": "o", "nodes": [{ "nodeId": "a", "nodePosition": place(theta) }], "edges": [] });
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
        let (scenario, _) = read(&order.to_string(), &Options { tolerance: Some(tolerance), ..options() }).unwrap();
        (scenario.agents[0].radius - 0.4, scenario.agents[0].length())
    };
    let (fine, whole) = radius(1e-6);
    for tolerance in [0.5, 0.1, 1e-2, 1e-3] {
        let (off, length) = radius(tolerance);
        assert!(off >= (whole - length).abs() - fine, "{off} {length} {whole}");
    }
    assert!(radius(0.5).0 > 0.01 && fine < 1e-4, "{fine}");
}
