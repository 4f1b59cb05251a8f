//! A manager whose orders are refused.

use crate::pair::key;
use crate::site::{SAFE, nodes, warehouse};
use pcr_formats::vda5050::version::ProtocolVersion;
use pcr_serve::vehicles::manager::FleetManager;
use serde_json::{Value, json};

struct Desk {
    manager: FleetManager,
    /// Where the vehicle stands.
    place: [f64; 2],
    time: f64,
}

impl Desk {
    fn new() -> Self {
        let layout = warehouse();
        let goals = nodes(&layout, &SAFE);
        let (at, place) = (goals[0], layout.position(goals[0]));
        let manager =
            FleetManager::new(layout, "map", goals, 0.9, vec![(key(), ProtocolVersion::V2_1, at)], 1).unwrap();
        Self { manager, place, time: 0.0 }
    }

    /// The vehicle says that it has this order, with nodes ahead or none, and that another one is refused; the orders that it then gets.
    fn hears(&mut self, order: &str, is_idle: bool, last: u64, refused: &str) -> Vec<Value> {
        self.time += 1.0;
        let [x, y] = self.place;
        let pose = json!({ "x": x, "y": y, "theta": 0.0, "mapId": "map", "positionInitialized": true });
        let references = json!([{ "referenceKey": "orderId", "referenceValue": refused }]);
        let errors = json!([{ "errorType": "orderError", "errorLevel": "WARNING", "errorReferences": references }]);
        let ahead = json!([{ "nodeId": "n", "sequenceId": last + 2, "released": true }]);
        let state = json!({ "headerId": self.time as u64, "timestamp": "2030-01-01T00:00:00.000Z", "version": "2.1.0",
            "manufacturer": "sim", "serialNumber": "001", "orderId": order, "orderUpdateId": 0, "lastNodeId": "",
            "lastNodeSequenceId": last, "nodeStates": if is_idle { json!([]) } else { ahead }, "edgeStates": [],
            "driving": false, "actionStates": [], "operatingMode": "AUTOMATIC", "agvPosition": pose,
            "errors": if refused.is_empty() { json!([]) } else { errors } });
        let due = self.manager.receive(&key(), state.to_string().as_bytes(), self.time);
        due.iter().map(|sent| serde_json::from_slice(&sent.payload).unwrap()).collect()
    }

    fn order(&self) -> String {
        self.manager.orders().next().unwrap().1.unwrap().into()
    }
}

/// It was sent for ever: the vehicle had had it, and had lost it before the manager saw that.
#[test]
fn an_order_that_is_refused_is_replaced() {
    let mut own = Desk::new();
    let first = own.hears("", true, 0, "").remove(0);
    let id = own.order();
    let mut sent = Vec::new();
    while sent.iter().all(|order: &Value| order["orderId"] == *id) {
        assert!(own.time < 10.0);
        sent.extend(own.hears("", true, 0, &id));
    }
    assert!(sent.len() > 1, "the refusal may have been for a moment");
    let second = sent.pop().unwrap();
    assert_eq!((&second["nodes"], &second["edges"]), (&first["nodes"], &first["edges"]));
    assert_eq!((second["orderId"].as_str(), own.manager.planned_anew()), (Some(&*own.order()), 1));
    // A late copy of the first one was taken.
    for _ in 0..5 {
        assert!(own.hears(&id, false, 0, "").is_empty());
        assert_eq!(own.order(), id);
    }
    let end = first["nodes"].as_array().unwrap().last().unwrap()["sequenceId"].as_u64().unwrap();
    own.hears(&id, true, end, "");
    assert_eq!(own.manager.done(), 1);
}

/// What is refused while the vehicle has something to do is sent again.
#[test]
fn an_order_that_is_refused_for_the_one_before_is_not_replaced() {
    let mut own = Desk::new();
    own.hears("", true, 0, "");
    let id = own.order();
    for _ in 0..10 {
        let sent = own.hears("before", false, 2, &id);
        assert!(sent.iter().all(|order| order["orderId"] == *id));
    }
    assert_eq!((own.order(), own.manager.planned_anew()), (id, 0));
}
