//! Vehicles that have to stand: they are told so at once, and nothing lets them go on or sends them further meanwhile.

use crate::pair::{CAN, key, order};
use crate::puppet::Puppet;
use crate::site::{interfaces, settings};
use pcr_formats::vda5050::decode::MessageLimits;
use pcr_formats::vda5050::topics::TopicKind;
use pcr_serve::journal_entry::NullStore;
use pcr_serve::owned_path::StartPose;
use pcr_serve::supervisor::Supervisor;
use pcr_serve::vda5050::bridge::{self, PendingPublish, Vda5050Bridge};
use pcr_serve::vda5050::vehicle_adapter::SendCondition;
use pcr_serve::vehicles::simulated_site::profile;
use serde_json::{Value, json};

const WAY: [[f64; 2]; 3] = [[0.0, 0.0], [5.0, 0.0], [10.0, 0.0]];

impl Puppet {
    /// Somebody is added on its way.
    fn stops(&mut self) {
        let abilities = self.robot().abilities.clone();
        self.supervisor.add("new", abilities, StartPose { x: 6.0, y: 0.0, heading: 0.0 }).unwrap();
    }

    /// What is to be sent with instant actions of a type.
    fn due(&mut self, kind: &str) -> Vec<PendingPublish> {
        self.supervisor.decide(self.time);
        self.bridge.settled(&mut self.supervisor, &[], self.time);
        let mut due = self.bridge.due();
        due.retain(|out| {
            let said: Value = serde_json::from_slice(&out.message.payload).unwrap();
            said["actions"].as_array().into_iter().flatten().any(|action| action["actionType"] == kind)
        });
        due
    }
}

fn driving() -> Puppet {
    let mut own = Puppet::new();
    own.manager(TopicKind::Order, order("a", 0, 0, &WAY, 3));
    own.is_at("a", 0, 0, &[2, 4], 0.0, false);
    own.is_at("a", 0, 0, &[2, 4], 1.0, true);
    own
}

/// What told it to stop waited for the journal behind all else, and was not sent if that failed.
#[test]
fn a_stop_waits_for_no_journal_and_nothing_lets_go_after_it() {
    let mut own = driving();
    own.stops();
    let stops = own.due("startPause");
    assert!(stops.len() == 1 && stops[0].due == SendCondition::AtOnce, "{stops:?}");
    own.state["paused"] = true.into();
    own.lasts(0.5);
    own.supervisor.remove("new").unwrap();
    let mut goes = own.due("stopPause");
    // One of the manager's lets it go, too.
    let action = json!({ "actionType": "stopPause", "actionId": "m", "blockingType": "NONE" });
    let message = own.signed(json!({ "actions": [action] }));
    let topic =
        interfaces()[0].topic(pcr_formats::vda5050::version::ProtocolVersion::V2_1, &key(), TopicKind::InstantActions);
    own.bridge.receive(&mut own.supervisor, &topic, message.to_string().as_bytes(), own.time);
    goes.extend(own.due("stopPause"));
    assert!(
        goes.len() == 2 && goes.iter().all(|out| out.due == SendCondition::Free && !own.bridge.withholds(out)),
        "{goes:?}"
    );
    // They wait for the journal as it has to stop again.
    own.stops();
    let stops = own.due("startPause");
    assert!(stops.len() == 1 && stops[0].due == SendCondition::AtOnce, "{stops:?}");
    assert!(goes.iter().all(|out| own.bridge.withholds(out)));
    assert!(!own.bridge.withholds(&stops[0]));
    // That of the manager is passed on when it may go; it was lost, and the vehicle stood for ever.
    own.lasts(0.5);
    assert_eq!(own.robot().notes["pauses"]["held"][0]["actionId"], "m");
    own.supervisor.remove("new").unwrap();
    own.lasts(0.5);
    assert!(own.asked("stopPause").iter().any(|id| id == "m"), "{:?}", own.got);
}

/// All of them were kept, and the journal got all of them with each one that came.
#[test]
fn so_many_actions_are_held_back_and_no_more() {
    let mut own = driving();
    own.stops();
    own.lasts(0.5);
    for k in 0..40 {
        let action = json!({ "actionType": "stopPause", "actionId": format!("m{k}"), "blockingType": "NONE" });
        own.manager(TopicKind::InstantActions, json!({ "actions": [action] }));
    }
    assert_eq!(own.robot().notes["pauses"]["held"].as_array().unwrap().len(), 16);
    let log = own.bridge.log();
    assert!(log[0].contains("\"m0\" is passed on when it may go"), "{log:?}");
    assert!(log[39].contains("\"m39\" is not passed on: 16 of them wait already"), "{log:?}");
    own.supervisor.remove("new").unwrap();
    own.lasts(0.5);
    let passed = own.asked("stopPause").into_iter().filter(|id| id.starts_with('m'));
    assert_eq!(passed.collect::<Vec<_>>(), (0..16).map(|k| format!("m{k}")).collect::<Vec<_>>());
}

/// It was sent on as soon as it had confirmed what it had.
#[test]
fn a_vehicle_with_an_alarm_is_not_sent_further() {
    for is_off in [true, false] {
        let mut own = Puppet::new();
        own.stops();
        own.lasts(0.5);
        own.manager(TopicKind::Order, order("a", 0, 0, &WAY, 3));
        own.supervisor.remove("new").unwrap();
        own.lasts(0.5);
        assert!(own.robot().granted > 9.9 && own.orders() == 1, "{:?}", own.got);
        // It confirms the part that it was sent, and is beside it.
        let ahead: Vec<Value> = own.got.iter().find(|(kind, _)| *kind == TopicKind::Order).unwrap().1["nodes"]
            .as_array()
            .unwrap()
            .iter()
            .filter(|node| node["released"] == true && node["sequenceId"] != 0)
            .map(|node| json!({ "nodeId": node["nodeId"], "sequenceId": node["sequenceId"], "released": true }))
            .collect();
        own.state["agvPosition"]["y"] = if is_off { 3.0 } else { 0.0 }.into();
        let numbers: Vec<u64> = ahead.iter().map(|node| node["sequenceId"].as_u64().unwrap()).collect();
        own.is_at("a", 0, 0, &numbers, 0.0, false);
        own.lasts(3.0);
        assert_eq!(own.robot().alarm.is_some(), is_off);
        assert_eq!(own.orders() == 1, is_off, "{:?}", own.got);
        if is_off {
            own.state["agvPosition"]["y"] = 0.0.into();
            own.lasts(3.0);
            assert!(own.robot().alarm.is_none() && own.orders() > 1);
        }
    }
}

/// It was never sent, so that the vehicle could not come to its way.
#[test]
fn the_first_order_is_sent_to_a_vehicle_with_an_alarm() {
    let mut own = Puppet::new();
    own.lasts(0.5);
    // It is pushed aside before its order comes.
    own.state["agvPosition"]["y"] = 3.0.into();
    own.lasts(0.5);
    assert!(own.robot().alarm.is_some() && own.orders() == 0, "{:?}", own.got);
    own.manager(TopicKind::Order, order("a", 0, 0, &WAY, 3));
    own.lasts(1.0);
    assert!(own.robot().alarm.is_some() && own.orders() > 0, "{:?}", own.got);
}

/// Its connection, and so that of the whole fleet, ended at a state that was too large.
#[test]
fn what_is_too_large_is_not_sent_and_the_log_says_so_once() {
    let [manager, vehicles] = interfaces();
    let limits = MessageLimits { sent: 1100, ..MessageLimits::default() };
    let mut own = driving();
    own.supervisor = Supervisor::new(settings(), Box::new(NullStore));
    let topics = bridge::BridgeConfig { manager, vehicles, limits };
    own.bridge = Vda5050Bridge::new(topics, vec![profile(key(), &CAN)], &own.supervisor).unwrap();
    let states = |own: &mut Puppet| {
        own.told = Value::Null;
        own.lasts(2.0);
        let log: Vec<String> = own.bridge.log().into_iter().filter(|line| line.contains("not sent")).collect();
        (!own.told.is_null(), log)
    };
    assert_eq!(states(&mut own), (true, Vec::new()));
    own.state["information"] = json!([{ "infoType": "x".repeat(1100), "infoLevel": "INFO" }]);
    let (is_told, log) = states(&mut own);
    assert!(!is_told && log.len() == 1 && log[0].contains("bytes; at most 1100 are sent"), "{log:?}");
    own.state["information"] = json!([]);
    assert_eq!(states(&mut own), (true, Vec::new()));
}
