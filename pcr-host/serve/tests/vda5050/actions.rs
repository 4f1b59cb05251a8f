//! Actions of orders, and instant actions: each comes to the vehicle once, in its place, and what becomes of it comes back to the manager.

use crate::pair::{Pair, order};
use crate::puppet::Puppet;
use crate::site::{at_broker, settings};
use pcr_formats::vda5050::topics::TopicKind;
use pcr_formats::vda5050::version::ProtocolVersion;
use pcr_serve::owned_path::StartPose;
use pcr_serve::vehicles::simulated_site::profile;
use serde_json::{Value, json};

/// Long edges, which are released in pieces.
const WAY: [[f64; 2]; 4] = [[0.0, 0.0], [40.0, 0.0], [80.0, 0.0], [80.0, 40.0]];

fn action(kind: &str, id: &str, blocking: &str) -> Value {
    json!({ "actionType": kind, "actionId": id, "blockingType": blocking,
        "actionParameters": [{ "key": "stationType", "value": "floor" }] })
}

/// An order along [`WAY`] with actions at its nodes and on an edge.
fn loaded(released: usize) -> Value {
    let mut order = order("a", 0, 0, &WAY, released);
    order["nodes"][0]["actions"] = json!([action("lights", "first", "NONE")]);
    order["nodes"][1]["actions"] = json!([action("pick", "pick", "HARD"), action("beep", "beep", "SOFT")]);
    order["edges"][1]["actions"] = json!([action("lights", "edge", "NONE")]);
    order["nodes"][3]["actions"] = json!([action("drop", "drop", "HARD")]);
    order
}

/// Where the vehicle was released each action: at a node by its id, or on an edge by its number. The first node of an update is one that it has.
fn released_actions(own: &Pair) -> Vec<(String, String)> {
    let mut found = Vec::new();
    let mut last_update = None;
    for (_, said) in own.got.iter().filter(|(kind, _)| *kind == TopicKind::Order) {
        let update = said["orderUpdateId"].as_u64();
        if last_update == Some(update) {
            continue;
        }
        last_update = Some(update);
        let is_first = update == Some(0);
        let nodes = said["nodes"].as_array().unwrap().iter().skip(usize::from(!is_first));
        for element in nodes.chain(said["edges"].as_array().unwrap()).filter(|element| element["released"] == true) {
            let name = element["nodeId"].as_str().map_or_else(|| "edge".to_owned(), str::to_owned);
            for action in element["actions"].as_array().unwrap() {
                assert_eq!(action["actionParameters"][0]["value"], "floor", "as it came: {action}");
                found.push((action["actionId"].as_str().unwrap().to_owned(), name.clone()));
            }
        }
    }
    found
}

fn status<'a>(own: &'a Pair, id: &str) -> Option<&'a str> {
    own.state.as_ref().unwrap().action(id)
}

#[test]
fn actions_of_an_order_that_is_released_in_pieces_come_once_and_in_their_places() {
    for is_restarted in [false, true] {
        let mut own = Pair::of(at_broker());
        own.says(TopicKind::Order, loaded(4));
        own.lasts(2.0);
        assert_eq!(["first", "pick", "beep", "edge", "drop"].map(|id| status(&own, id).is_some()), [true; 5]);
        // The edge before it was split; that with an action is not.
        let mut is_split = false;
        for _ in 0..30 {
            own.lasts(10.0);
            if is_restarted && own.time > 40.0 && own.time < 60.0 {
                own.restart();
            }
            is_split |= own.got.iter().any(|(_, said)| said.to_string().contains("n0+"));
            // The place where it picks is not left before that is done.
            let [x, _] = own.vehicle.true_position();
            assert!(x <= 40.001 || status(&own, "beep") == Some("FINISHED"), "{x}");
        }
        assert!(own.is_done("a"), "{is_restarted}: {:?}", own.state);
        assert!(is_split && !own.got.iter().any(|(_, said)| said.to_string().contains("n2+")));
        assert_eq!(["first", "pick", "beep", "edge", "drop"].map(|id| status(&own, id)), [Some("FINISHED"); 5]);
        let expected = [("first", "n0"), ("pick", "n2"), ("beep", "n2"), ("edge", "edge"), ("drop", "n6")];
        let mut found = released_actions(&own);
        found.sort();
        let mut expected = expected.map(|(id, place)| (id.to_owned(), place.to_owned()));
        expected.sort();
        assert_eq!(found, expected, "{is_restarted}");
    }
}

/// A further node at the same place, as the standard says: the vehicle does not move for it.
#[test]
fn actions_are_released_where_the_vehicle_stands() {
    let mut own = Pair::new();
    own.says(TopicKind::Order, order("a", 0, 0, &WAY[..1], 1));
    own.lasts(3.0);
    let mut update = order("a", 1, 0, &[WAY[0], WAY[0]], 2);
    update["nodes"][1]["actions"] = json!([action("pick", "pick", "HARD")]);
    own.says(TopicKind::Order, update);
    own.lasts(1.5);
    assert_eq!(status(&own, "pick"), Some("RUNNING"), "{:?}", own.state);
    own.lasts(10.0);
    assert_eq!(status(&own, "pick"), Some("FINISHED"));
    // A node that was released cannot get another one.
    let mut update = order("a", 2, 2, &[WAY[0], WAY[1]], 2);
    update["nodes"][0]["actions"] = json!([action("pick", "pick", "HARD"), action("drop", "late", "HARD")]);
    own.says(TopicKind::Order, update.clone());
    own.lasts(1.0);
    let errors = own.errors().concat();
    assert!(errors.contains("was released without action late") && errors.contains("orderUpdateError"), "{errors}");
    update["nodes"][0]["actions"] = json!([action("pick", "pick", "HARD")]);
    own.says(TopicKind::Order, update);
    own.lasts(60.0);
    assert!(own.is_done("a") && own.errors().is_empty(), "{:?}", own.state);
}

/// The vehicle gets 60 nodes ahead: to the manager, what comes later was not there.
#[test]
fn actions_that_the_vehicle_does_not_have_yet_wait_and_fail_with_the_order() {
    for is_restarted in [false, true] {
        let mut own = Pair::new();
        let places: Vec<[f64; 2]> = (0..100).map(|k| [f64::from(k), 0.0]).collect();
        let mut order = order("a", 0, 0, &places, 3);
        for k in [2, 40, 99] {
            order["nodes"][k]["actions"] = json!([action("pick", &k.to_string(), "HARD")]);
        }
        order["edges"][98]["actions"] = json!([action("beep", "edge", "NONE")]);
        own.says(TopicKind::Order, order);
        own.lasts(1.0);
        let sent = own.got.iter().rfind(|(kind, _)| *kind == TopicKind::Order).unwrap().1.to_string();
        assert!(sent.contains("\"40\"") && !sent.contains("\"99\""));
        let ids = |own: &Pair| -> Vec<(String, String)> {
            let all = own.state.as_ref().unwrap().action_states.iter();
            all.map(|own| (own.action_id.clone(), own.action_status.clone())).filter(|own| own.0 != "stop").collect()
        };
        let all = |statuses: [&str; 4]| -> Vec<(String, String)> {
            ["2", "40", "edge", "99"].into_iter().zip(statuses).map(|(id, it)| (id.into(), it.into())).collect()
        };
        let strip = |list: Vec<(String, String)>| -> Vec<(String, String)> {
            list.into_iter().filter(|own| !own.0.starts_with("pcr-")).collect()
        };
        assert_eq!(strip(ids(&own)), all(["WAITING"; 4]));
        own.lasts(20.0);
        assert_eq!(strip(ids(&own)), all(["FINISHED", "WAITING", "WAITING", "WAITING"]));
        own.cancels("stop");
        own.lasts(5.0);
        if is_restarted {
            own.restart();
            own.lasts(5.0);
        }
        assert!(!own.has_job());
        assert_eq!(strip(ids(&own)), all(["FINISHED", "FAILED", "FAILED", "FAILED"]), "{is_restarted}");
        own.order("b", &[[2.0, 0.0], [0.0, 0.0]]);
        own.lasts(20.0);
        assert!(own.is_done("b") && strip(ids(&own)).is_empty(), "{:?}", own.state);
    }
}

/// The vehicle said that there was nothing to cancel, and of the order nobody said anything.
#[test]
fn an_order_that_is_cancelled_before_it_is_sent_is_refused() {
    let mut own = Pair::new();
    // Somebody stands where it would end.
    let abilities = own.supervisor.robot("sim/001").unwrap().abilities.clone();
    own.supervisor.add("other", abilities, StartPose { x: 8.0, y: 0.0, heading: 0.0 }).unwrap();
    own.order("a", &[[0.0, 0.0], [8.0, 0.0]]);
    own.lasts(2.0);
    assert!(own.has_job() && own.got.iter().all(|(kind, _)| *kind != TopicKind::Order));
    own.cancels("stop");
    own.lasts(5.0);
    assert!(!own.has_job());
    assert_eq!(status(&own, "stop"), Some("FAILED"));
    let errors = own.errors().concat();
    let why = "it was cancelled before the vehicle got it: nothing of it is carried out";
    assert!(errors.contains(why) && errors.contains(r#""referenceKey":"orderId","referenceValue":"a""#), "{errors}");
}

/// `stopPause` was sent before all others: who was paused and let go in one message stayed paused.
#[test]
fn instant_actions_pass_in_their_order() {
    let kinds = ["startPause", "stateRequest", "stopPause", "factsheetRequest", "beep", "startPause", "stopPause"];
    let mut own = Pair::new();
    own.order("a", &[[0.0, 0.0], [8.0, 0.0]]);
    own.lasts(2.0);
    let before = own.got.len();
    let actions: Vec<Value> =
        kinds.iter().enumerate().map(|(k, kind)| action(kind, &format!("m{k}"), "NONE")).collect();
    own.says(TopicKind::InstantActions, json!({ "actions": actions }));
    own.lasts(1.0);
    let sent = own.got[before..].iter().filter(|(kind, _)| *kind == TopicKind::InstantActions);
    let sent: Vec<Value> = sent.flat_map(|(_, said)| said["actions"].as_array().unwrap().clone()).collect();
    assert_eq!(sent, actions);
    assert!(!own.is_paused());
    let found: Vec<_> = (0..kinds.len()).map(|k| status(&own, &format!("m{k}")).unwrap()).collect();
    let failed = "FAILED";
    assert_eq!(found, ["FINISHED", "FINISHED", "FINISHED", "FINISHED", failed, "FINISHED", "FINISHED"]);
    own.lasts(30.0);
    assert!(own.is_done("a"), "{:?}", own.state);
}

/// It was asked each second, and the list of its actions grew.
#[test]
fn a_vehicle_that_refuses_to_pause_is_told_of_once() {
    for version in ProtocolVersion::ALL {
        let mut own = Puppet::of(version, settings());
        own.manager(TopicKind::Order, order("a", 0, 0, &[[0.0, 0.0], [5.0, 0.0], [10.0, 0.0]], 3));
        let at = |own: &mut Puppet| {
            let ahead = [2, 4].map(|k| json!({ "nodeId": format!("n{k}"), "sequenceId": k, "released": true }));
            (own.state["orderId"], own.state["lastNodeId"]) = ("a".into(), "n0".into());
            (own.state["nodeStates"], own.state["driving"]) = (json!(ahead), true.into());
            own.lasts(0.5);
        };
        at(&mut own);
        own.bridge.log();
        let abilities = profile(crate::pair::key(), &crate::pair::CAN).abilities;
        own.supervisor.add("new", abilities, StartPose { x: 7.0, y: 0.0, heading: 0.0 }).unwrap();
        own.lasts(0.5);
        let why = "it has to stop, and refuses to pause";
        let (mut told, mut log) = (0, Vec::new());
        for _ in 0..50 {
            for id in own.asked("startPause") {
                own.ends(&id, "FAILED");
            }
            own.lasts(1.0);
            told += usize::from(own.told["errors"].to_string().contains(why));
            log.extend(own.bridge.log());
        }
        assert_eq!(own.asked("startPause").len(), 2, "{version:?}: again after 30 s");
        assert!(told >= 49, "{version:?}: {told} {}", own.told);
        assert_eq!(log.iter().filter(|line| line.contains(why)).count(), 1, "{version:?}: {log:?}");
        // It does what it was asked for in the end.
        own.state["paused"] = true.into();
        own.lasts(1.0);
        assert!(!own.told["errors"].to_string().contains(why), "{version:?}: {}", own.told);
        own.supervisor.remove("new").unwrap();
        own.lasts(1.0);
        assert_eq!(own.asked("stopPause").len(), 1, "{version:?}");
    }
}

/// It was said to have authority that it does not use, as if something was wrong with it.
#[test]
fn a_vehicle_that_carries_out_an_action_for_long_stands_for_that() {
    let mut own = Puppet::new();
    own.manager(TopicKind::Order, loaded(4));
    own.lasts(1.0);
    let nodes: Vec<Value> =
        [4, 6].iter().map(|k| json!({ "nodeId": format!("n{k}"), "sequenceId": k, "released": true })).collect();
    (own.state["orderId"], own.state["lastNodeId"], own.state["lastNodeSequenceId"]) =
        ("a".into(), "n2".into(), 2.into());
    own.state["nodeStates"] = nodes.into();
    own.state["agvPosition"]["x"] = 40.0.into();
    own.ends("pick", "RUNNING");
    let mut all = own.state["actionStates"].as_array_mut().unwrap().iter_mut();
    all.find(|action| action["actionId"] == "pick").unwrap()["actionType"] = "pick".into();
    let mut found = Vec::new();
    for _ in 0..160 {
        own.time += 0.5;
        let state = own.written();
        let topic = crate::site::interfaces()[1].topic(ProtocolVersion::V2_1, &crate::pair::key(), TopicKind::State);
        own.bridge.receive(&mut own.supervisor, &topic, state.to_string().as_bytes(), own.time);
        let events = own.supervisor.settle(own.time).unwrap();
        found.extend(events.into_iter().filter_map(|event| match event {
            pcr_serve::event::SupervisorEvent::Standstill { why, .. } => Some(why),
            _ => None,
        }));
    }
    assert_eq!(found, ["sim/001 stands at 40.00 m, and carries out pick (pick, RUNNING)"]);
}
