//! Managers that release piece by piece: what they release is used as far as the vehicle may stand, and they are told what to release next.

use crate::pair::{CAN, Pair, key, order};
use crate::schemas::schema;
use crate::site::at_broker;
use pcr_formats::vda5050::topics::TopicKind;
use pcr_serve::owned_path::{PathElement, StartPose};
use pcr_serve::supervisor::MissionRequest;
use pcr_serve::vehicles::simulated_site::profile;
use serde_json::Value;
use std::f64::consts::FRAC_PI_2;

/// Along the x-axis; the third node is where another robot is to come to its end.
const WAY: [[f64; 2]; 4] = [[0.0, 0.0], [4.0, 0.0], [8.0, 0.0], [12.0, 0.0]];

/// A vehicle and a robot that comes from afar, and stays where it is.
fn crossed() -> Pair {
    let mut own = Pair::of(at_broker());
    let abilities = profile(key(), &CAN).abilities;
    own.supervisor.add("other", abilities, StartPose { x: 8.0, y: -30.0, heading: FRAC_PI_2 }).unwrap();
    let path = vec![PathElement::Line { length: 30.0 }];
    let (robot, mission) = ("other".into(), "to the end".into());
    let mission =
        MissionRequest { robot, mission, after: None, expected_path: None, any_heading: false, start: None, path };
    own.supervisor.mission(&mission, own.time).unwrap();
    own
}

fn told(own: &Pair) -> Value {
    let told = serde_json::to_value(own.state.as_ref().unwrap()).unwrap();
    assert!(schema("2.1.0", TopicKind::State).is_valid(&told), "{told}");
    told
}

fn base_end(own: &Pair) -> Option<Value> {
    told(own)["errors"].as_array().unwrap().iter().find(|error| error["errorType"] == "baseEnd").cloned()
}

/// It stood where it was for ever, and nobody said why.
#[test]
fn a_base_is_used_up_to_where_the_vehicle_may_stand_and_the_manager_reads_what_to_release() {
    for is_restarted in [false, true] {
        let mut own = crossed();
        own.says(TopicKind::Order, order("a", 0, 0, &WAY, 3));
        own.lasts(1.0);
        let error = base_end(&own).expect("why it waits");
        assert_eq!(
            error["errorDescription"],
            "the vehicle cannot go to node n4 now, where the base of order a ends: other is in the way, whoever goes first; it may go up to node n2"
        );
        assert_eq!(error["errorHint"], "release it up to node n6 (sequenceId 6)");
        let references = error["errorReferences"].as_array().unwrap();
        let reference =
            |key: &str| references.iter().find(|it| it["referenceKey"] == key).unwrap()["referenceValue"].clone();
        assert_eq!([reference("orderId"), reference("nodeId"), reference("vehicle")], ["a", "n4", "other"]);
        assert_eq!(told(&own)["newBaseRequest"], true);
        own.lasts(15.0);
        if is_restarted {
            own.restart();
            own.lasts(8.0);
        }
        let [x, _] = own.vehicle.true_position();
        assert!((x - 4.0).abs() < 0.01, "{is_restarted}: {x}");
        assert!(base_end(&own).is_some(), "{}", told(&own));
        // As it is told.
        own.says(TopicKind::Order, order("a", 1, 4, &WAY[2..], 2));
        own.lasts(1.0);
        assert!(base_end(&own).is_none() && told(&own)["newBaseRequest"] != true, "{}", told(&own));
        own.lasts(30.0);
        assert!(own.is_done("a"), "{is_restarted}: {:?}", own.state);
    }
}

/// A pause is no matter of the base.
#[test]
fn a_base_that_waits_for_a_pause_is_no_error() {
    let mut own = Pair::new();
    own.supervisor.pause().unwrap();
    own.says(TopicKind::Order, order("a", 0, 0, &WAY, 3));
    own.lasts(2.0);
    let told = told(&own);
    assert!(told["information"].to_string().contains("order a waits: the fleet is paused"), "{told}");
    assert!(base_end(&own).is_none() && told["newBaseRequest"] != true, "{told}");
    own.supervisor.resume().unwrap();
    own.lasts(20.0);
    let [x, _] = own.vehicle.true_position();
    assert!((x - 8.0).abs() < 0.01, "{x}");
}

/// What waits goes on by itself when there is room.
#[test]
fn the_rest_of_a_base_is_released_when_the_vehicle_may_stand_at_its_end() {
    let mut own = crossed();
    own.says(TopicKind::Order, order("a", 0, 0, &WAY, 3));
    own.lasts(15.0);
    assert!(own.vehicle.true_position()[0] < 4.1);
    own.supervisor.remove("other").unwrap();
    own.lasts(15.0);
    let [x, _] = own.vehicle.true_position();
    assert!((x - 8.0).abs() < 0.01 && base_end(&own).is_none(), "{x}: {}", told(&own));
    // The manager cancels what is left.
    own.cancels("stop");
    own.lasts(5.0);
    assert!(!own.has_job());
}

/// With what the vehicle has not reached of its base cancelled, nothing of it is left.
#[test]
fn an_order_that_waits_for_the_rest_of_its_base_can_be_cancelled() {
    let mut own = crossed();
    own.says(TopicKind::Order, order("a", 0, 0, &WAY, 3));
    own.lasts(2.0);
    own.cancels("stop");
    own.lasts(10.0);
    assert!(!own.has_job() && base_end(&own).is_none(), "{}", told(&own));
    let robot = own.supervisor.robot("sim/001").unwrap();
    assert!(robot.waiting.is_none() && robot.course.length() == 0.0);
}

/// An order that leads to its end is not for a part of it: the vehicle is in nobody's way where it is. The manager reads why it waits.
#[test]
fn an_order_without_a_horizon_waits_where_the_vehicle_is() {
    let mut own = crossed();
    own.says(TopicKind::Order, order("a", 0, 0, &WAY[..3], 3));
    own.lasts(10.0);
    assert!(own.got.iter().all(|(kind, _)| *kind != TopicKind::Order));
    let told = told(&own);
    let entry = told["information"].as_array().unwrap().iter().find(|entry| entry["infoType"] == "waiting").unwrap();
    assert_eq!(entry["infoDescription"], "order a waits: other is in the way, whoever goes first");
    assert!(told["errors"].as_array().unwrap().is_empty(), "{told}");
}
