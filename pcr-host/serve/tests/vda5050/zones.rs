//! Requests of vehicles of 3.0, and what the manager says to them.

use crate::pair::{CAN, key};
use crate::schemas::schema;
use crate::site::{interfaces, settings};
use pcr_formats::vda5050::decode::Limits;
use pcr_formats::vda5050::topics::Kind;
use pcr_formats::vda5050::version::Version;
use pcr_serve::course::Start;
use pcr_serve::entry::Nowhere;
use pcr_serve::supervisor::Supervisor;
use pcr_serve::vda5050::bridge::{self, Bridge};
use pcr_serve::vehicles::vehicle::Vehicle;
use pcr_serve::vehicles::world::profile;
use serde_json::{Value, json};

/// A manager could let a vehicle leave its way, where nobody keeps clear of it.
#[test]
fn zones_may_be_entered_and_no_way_may_be_left() {
    let [manager, vehicles] = interfaces();
    let topics = bridge::Settings { manager: manager.clone(), vehicles: vehicles.clone(), limits: Limits::default() };
    let mut supervisor = Supervisor::new(settings(), Box::new(Nowhere));
    let mut bridge = Bridge::new(topics, vec![profile(key(), &CAN)], &supervisor).unwrap();
    let topic = |kind| vehicles.topic(Version::V3_0, &key(), kind);
    let mut vehicle = Vehicle::new(key(), Version::V3_0, "map", CAN, Start { x: 0.0, y: 0.0, heading: 0.0 }, 1);
    let (_, state) = vehicle.out().into_iter().find(|(kind, _)| *kind == Kind::State).unwrap();
    let mut state: Value = serde_json::from_slice(&state).unwrap();
    let zone = |id: &str, asks: &str| json!({ "requestId": id, "requestType": asks, "zoneId": "z", "zoneSetId": "s", "requestStatus": "REQUESTED" });
    state["zoneRequests"] = json!([zone("enters", "ACCESS"), zone("plans", "REPLANNING"), zone("both", "ACCESS")]);
    let edge = |id: &str| json!({ "requestId": id, "requestType": "CORRIDOR", "edgeId": "e", "sequenceId": 1, "requestStatus": "REQUESTED" });
    state["edgeRequests"] = json!([edge("swerves"), edge("both")]);
    assert!(schema("3.0.0", Kind::State).is_valid(&state), "{state}");
    bridge.receive(&mut supervisor, &topic(Kind::State), state.to_string().as_bytes(), 1.0);
    let names = ["enters", "plans", "swerves", "both", "unknown"];
    let granted =
        |id: &&str| json!({ "requestId": id, "grantType": "GRANTED", "leaseExpiry": "2030-01-01T00:00:00.000Z" });
    let mut responses: Vec<Value> = names.iter().map(granted).collect();
    responses.push(json!({ "requestId": "plans", "grantType": "QUEUED" }));
    let message = json!({ "headerId": 1, "timestamp": "2030-01-01T00:00:00.000Z", "version": "3.0.0", "manufacturer": "sim",
        "serialNumber": "001", "responses": responses });
    assert!(schema("3.0.0", Kind::Responses).is_valid(&message), "{message}");
    let from = manager.topic(Version::V3_0, &key(), Kind::Responses);
    bridge.receive(&mut supervisor, &from, message.to_string().as_bytes(), 1.0);
    bridge.settled(&mut supervisor, &[], 1.0);
    let out = bridge.out();
    let told = out.iter().find(|message| message.topic == topic(Kind::Responses)).unwrap();
    let told: Value = serde_json::from_slice(&told.payload).unwrap();
    assert!(schema("3.0.0", Kind::Responses).is_valid(&told), "{told}");
    let kinds: Vec<_> =
        told["responses"].as_array().unwrap().iter().map(|it| it["grantType"].as_str().unwrap()).collect();
    assert_eq!(kinds, ["GRANTED", "REJECTED", "REJECTED", "REJECTED", "REJECTED", "QUEUED"]);
    assert_eq!(told["responses"][0], granted(&names[0]));
    let log = bridge.log();
    assert!(log[0].contains("responses[1].grantType: plans"), "{log:?}");
}
