//! Requests of vehicles of 3.0, and what the manager says to them.

use crate::pair::{CAN, key};
use crate::schemas::schema;
use crate::site::{interfaces, settings};
use pcr_formats::vda5050::decode::MessageLimits;
use pcr_formats::vda5050::topics::TopicKind;
use pcr_formats::vda5050::version::ProtocolVersion;
use pcr_serve::journal_entry::NullStore;
use pcr_serve::owned_path::StartPose;
use pcr_serve::supervisor::Supervisor;
use pcr_serve::vda5050::bridge::{self, Vda5050Bridge};
use pcr_serve::vehicles::simulated_site::profile;
use pcr_serve::vehicles::vehicle::SimulatedVehicle;
use serde_json::{Value, json};

/// A manager could let a vehicle leave its way, where nobody keeps clear of it.
#[test]
fn zones_may_be_entered_and_no_way_may_be_left() {
    let [manager, vehicles] = interfaces();
    let topics =
        bridge::BridgeConfig { manager: manager.clone(), vehicles: vehicles.clone(), limits: MessageLimits::default() };
    let mut supervisor = Supervisor::new(settings(), Box::new(NullStore));
    let mut bridge = Vda5050Bridge::new(topics, vec![profile(key(), &CAN)], &supervisor).unwrap();
    let topic = |kind| vehicles.topic(ProtocolVersion::V3_0, &key(), kind);
    let mut vehicle =
        SimulatedVehicle::new(key(), ProtocolVersion::V3_0, "map", CAN, StartPose { x: 0.0, y: 0.0, heading: 0.0 }, 1);
    let (_, state) = vehicle.out().into_iter().find(|(kind, _)| *kind == TopicKind::State).unwrap();
    let mut state: Value = serde_json::from_slice(&state).unwrap();
    let zone = |id: &str, asks: &str| json!({ "requestId": id, "requestType": asks, "zoneId": "z", "zoneSetId": "s", "requestStatus": "REQUESTED" });
    state["zoneRequests"] = json!([zone("enters", "ACCESS"), zone("plans", "REPLANNING"), zone("both", "ACCESS")]);
    let edge = |id: &str| json!({ "requestId": id, "requestType": "CORRIDOR", "edgeId": "e", "sequenceId": 1, "requestStatus": "REQUESTED" });
    state["edgeRequests"] = json!([edge("swerves"), edge("both")]);
    assert!(schema("3.0.0", TopicKind::State).is_valid(&state), "{state}");
    bridge.receive(&mut supervisor, &topic(TopicKind::State), state.to_string().as_bytes(), 1.0);
    let names = ["enters", "plans", "swerves", "both", "unknown"];
    let granted =
        |id: &&str| json!({ "requestId": id, "grantType": "GRANTED", "leaseExpiry": "2030-01-01T00:00:00.000Z" });
    let mut responses: Vec<Value> = names.iter().map(granted).collect();
    responses.push(json!({ "requestId": "plans", "grantType": "QUEUED" }));
    let message = json!({ "headerId": 1, "timestamp": "2030-01-01T00:00:00.000Z", "version": "3.0.0", "manufacturer": "sim",
        "serialNumber": "001", "responses": responses });
    assert!(schema("3.0.0", TopicKind::Responses).is_valid(&message), "{message}");
    let from = manager.topic(ProtocolVersion::V3_0, &key(), TopicKind::Responses);
    bridge.receive(&mut supervisor, &from, message.to_string().as_bytes(), 1.0);
    bridge.settled(&mut supervisor, &[], 1.0);
    let out = bridge.out();
    let told = out.iter().find(|message| message.topic == topic(TopicKind::Responses)).unwrap();
    let told: Value = serde_json::from_slice(&told.payload).unwrap();
    assert!(schema("3.0.0", TopicKind::Responses).is_valid(&told), "{told}");
    let kinds: Vec<_> =
        told["responses"].as_array().unwrap().iter().map(|it| it["grantType"].as_str().unwrap()).collect();
    assert_eq!(kinds, ["GRANTED", "REJECTED", "REJECTED", "REJECTED", "REJECTED", "QUEUED"]);
    assert_eq!(told["responses"][0], granted(&names[0]));
    let log = bridge.log();
    assert!(log[0].contains("responses[1].grantType: plans"), "{log:?}");
}
