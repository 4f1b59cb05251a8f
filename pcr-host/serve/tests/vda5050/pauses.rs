//! The whole fleet is paused: vehicles of all editions get `startPause` and `stopPause`, pauses of others stay, and who cannot be paused is named.

use crate::pair::{Pair, TO, key, order};
use crate::puppet::Puppet;
use crate::schemas::schema;
use crate::site::{interfaces, settings};
use pcr_formats::vda5050::topics::TopicKind;
use pcr_formats::vda5050::version::ProtocolVersion;
use serde_json::{Value, json};

fn is_still(own: &mut Pair) -> bool {
    let pose = |own: &Pair| own.state.as_ref().unwrap().position().map(|pose| [pose.x, pose.y]).unwrap();
    own.lasts(1.0);
    let before = pose(own);
    own.lasts(5.0);
    let [x, y] = pose(own);
    // Its positions have noise.
    (x - before[0]).hypot(y - before[1]) < 0.1
}

/// Under way it brakes where it is, says so, and goes on to its end; a restart of the supervisor in between changes nothing.
#[test]
fn a_vehicle_under_way_stops_and_goes_on() {
    for is_restarted in [false, true] {
        let mut own = Pair::new();
        own.bridge.greet(own.time);
        own.order("a", &TO);
        own.lasts(4.0);
        assert!(own.supervisor.pause().unwrap() == Default::default(), "its factsheet says that it can");
        own.lasts(3.0);
        assert!(own.is_paused() && is_still(&mut own) && !own.is_done("a"), "{:?}", own.state);
        assert!(own.errors().iter().any(|error| error.contains("\"paused\"") && error.contains("the fleet is paused")));
        if is_restarted {
            own.restart();
            own.lasts(3.0);
            assert!(own.supervisor.is_paused() && own.is_paused() && is_still(&mut own), "{:?}", own.state);
        }
        assert!(own.supervisor.resume().unwrap());
        own.lasts(60.0);
        assert!(own.is_done("a") && !own.is_paused() && own.errors().is_empty(), "{:?}", own.state);
    }
}

#[test]
fn an_order_that_comes_meanwhile_is_taken_when_the_fleet_goes_on() {
    let mut own = Pair::new();
    own.supervisor.pause().unwrap();
    own.lasts(1.0);
    own.order("a", &TO);
    own.lasts(5.0);
    assert!(own.has_job() && own.state.as_ref().unwrap().order_id.is_empty(), "{:?}", own.state);
    own.supervisor.resume().unwrap();
    own.lasts(60.0);
    assert!(own.is_done("a"), "{:?}", own.state);
}

/// What the manager has paused only the manager lets go on, and not before the fleet goes on.
#[test]
fn a_pause_of_the_manager_is_its_own() {
    let mut own = Pair::new();
    own.order("a", &TO);
    own.lasts(3.0);
    own.acts("startPause", "m1");
    own.lasts(2.0);
    own.supervisor.pause().unwrap();
    own.lasts(2.0);
    own.supervisor.resume().unwrap();
    own.lasts(5.0);
    assert!(own.is_paused() && is_still(&mut own), "{:?}", own.state);
    own.supervisor.pause().unwrap();
    own.lasts(2.0);
    own.bridge.log();
    own.acts("stopPause", "m2");
    own.lasts(5.0);
    let log = own.bridge.log();
    assert!(log.iter().any(|line| line.contains("the fleet is paused; \"m2\" is passed on when it may go")), "{log:?}");
    assert!(own.is_paused() && is_still(&mut own), "{:?}", own.state);
    own.supervisor.resume().unwrap();
    own.lasts(60.0);
    assert!(own.is_done("a"), "{:?}", own.state);
}

#[test]
fn vehicles_of_all_editions_get_the_actions_of_their_schemas() {
    for version in ProtocolVersion::ALL {
        let mut own = Puppet::of(version, settings());
        let schema = schema(version.text(), TopicKind::InstantActions);
        let got = |own: &Puppet, kind: &str| -> Vec<Value> {
            let of = |said: &Value| said["actions"].as_array().into_iter().flatten().any(|it| it["actionType"] == kind);
            let all = own.got.iter().filter(|(topic, said)| *topic == TopicKind::InstantActions && of(said));
            all.map(|(_, said)| said.clone()).collect()
        };
        own.supervisor.pause().unwrap();
        own.lasts(0.5);
        let pauses = got(&own, "startPause");
        assert!(pauses.len() == 1 && schema.is_valid(&pauses[0]), "{pauses:?}");
        // It is asked again until it says that it has paused: a message may be lost.
        own.lasts(2.0);
        assert!(got(&own, "startPause").len() > 1);
        own.state["paused"] = true.into();
        own.lasts(1.0);
        let count = got(&own, "startPause").len();
        own.lasts(5.0);
        assert_eq!(got(&own, "startPause").len(), count, "{version:?}");
        assert!(got(&own, "stopPause").is_empty());
        own.supervisor.resume().unwrap();
        own.lasts(0.5);
        let goes = got(&own, "stopPause");
        assert!(goes.len() == 1 && schema.is_valid(&goes[0]), "{goes:?}");
    }
}

/// Not every vehicle reports whether it is paused: it got another action each second, for hours.
#[test]
fn a_vehicle_that_only_says_that_the_action_is_done_is_believed() {
    let mut own = Puppet::new();
    own.state.as_object_mut().unwrap().remove("paused");
    own.supervisor.pause().unwrap();
    own.lasts(0.5);
    let first = own.asked("startPause").pop().unwrap();
    own.ends(&first, "FINISHED");
    own.lasts(10.0);
    assert_eq!(own.asked("startPause"), [first]);
    own.supervisor.resume().unwrap();
    own.lasts(0.5);
    assert_eq!(own.asked("stopPause").len(), 1);
}

#[test]
fn who_cannot_be_paused_is_named_and_gets_nothing_more_released() {
    let sheet = |version: ProtocolVersion, actions: Option<&[(&str, &str)]>| {
        let list = |all: &[(&str, &str)]| -> Vec<Value> {
            all.iter().map(|(kind, scope)| json!({ "actionType": kind, "actionScopes": [scope] })).collect()
        };
        let name = if version == ProtocolVersion::V3_0 { "mobileRobotActions" } else { "agvActions" };
        let features = actions.map_or(json!({}), |actions| json!({ name: list(actions) }));
        json!({ "physicalParameters": { "speedMax": 1.0, "accelerationMax": 0.5, "decelerationMax": 0.5, "width": 0.4, "length": 0.4 },
            "protocolFeatures": features })
    };
    let can = [("startPause", "INSTANT"), ("stopPause", "INSTANT"), ("cancelOrder", "INSTANT")];
    // Actions of nodes do not stop it on its way.
    let of_nodes = [("startPause", "NODE"), ("stopPause", "NODE")];
    for version in ProtocolVersion::ALL {
        for (actions, [unable, unknown]) in [
            (Some(&can[..]), [0, 0]),
            (Some(&can[1..]), [1, 0]),
            (Some(&of_nodes[..]), [1, 0]),
            (Some(&[][..]), [0, 1]),
            (None, [0, 1]),
        ] {
            let mut own = Puppet::of(version, settings());
            assert_eq!(own.supervisor.pause().unwrap().unknown, ["sim/001"], "it has sent none");
            own.supervisor.resume().unwrap();
            let message = own.signed(sheet(version, actions)).to_string();
            let topic = interfaces()[1].topic(version, &key(), TopicKind::Factsheet);
            own.bridge.receive(&mut own.supervisor, &topic, message.as_bytes(), own.time);
            own.lasts(0.5);
            let impact = own.supervisor.pause().unwrap();
            assert_eq!([impact.unable.len(), impact.unknown.len()], [unable, unknown], "{version:?} {actions:?}");
            let why = "the fleet is paused; sim/001 cannot be paused, and may go on to the end of what was released";
            let is_named = own.supervisor.pause_reason().unwrap() == why;
            assert_eq!(is_named, unable == 1);
            own.lasts(1.0);
            let told = |error: &Value| error["errorType"] == "paused" && (error["errorDescription"] == why) == is_named;
            assert!(own.told["errors"].as_array().unwrap().iter().any(told), "{}", own.told);
        }
    }
    // One on its way goes on to the end of what it has, and no further.
    let mut own = Puppet::new();
    let way: Vec<[f64; 2]> = (0..6).map(|k| [5.0 * f64::from(k), 0.0]).collect();
    own.manager(TopicKind::Order, order("a", 0, 0, &way, way.len()));
    own.lasts(1.0);
    own.is_at("a", 0, 0, &[2, 4], 0.0, true);
    let (orders, hold) = (own.orders(), own.robot().granted);
    own.supervisor.pause().unwrap();
    for x in 1..=5 {
        own.is_at("a", 0, 0, &[2, 4], f64::from(x), true);
    }
    assert_eq!((own.orders(), own.robot().granted), (orders, hold));
}
