//! One vehicle, its supervisor, and a manager that sends what the test says: any single message may be lost, and work goes on.

use crate::pair::{CAN, FRO, Pair, TO, bridge_of, key, order};
use crate::site::{interfaces, settings};
use pcr_formats::vda5050::decode::MessageLimits;
use pcr_formats::vda5050::topics::TopicKind;
use pcr_formats::vda5050::version::ProtocolVersion;
use pcr_serve::event::SupervisorEvent;
use pcr_serve::journal_entry::NullStore;
use pcr_serve::owned_path::StartPose;
use pcr_serve::supervisor::{MissionRequest, PositionReport, Supervisor};
use pcr_serve::vda5050::bridge::{self, Vda5050Bridge};
use pcr_serve::vehicles::simulated_site::profile;
use pcr_serve::vehicles::vehicle::SimulatedVehicle;
use pcr_serve::vehicles::vehicle_motion::SimulatedTraits;
use serde_json::json;

/// An order was forgotten, and a pause of the manager was ended.
#[test]
fn notes_of_the_journal_that_cannot_be_read_are_an_error() {
    let mut own = Pair::new();
    own.order("1", &TO);
    own.lasts(1.0);
    let [manager, vehicles] = interfaces();
    let settings = bridge::BridgeConfig { manager, vehicles, limits: MessageLimits::default() };
    let bridge = |own: &Pair| Vda5050Bridge::new(settings.clone(), vec![profile(key(), &CAN)], &own.supervisor);
    assert!(bridge(&own).is_ok());
    for key in
        ["order", "stops", "sent", "orders", "cancels", "pauses", "needs", "received", "doubtful", "unsent", "zones"]
    {
        let entries = own.supervisor.snapshot().unwrap();
        let mut damaged = Supervisor::restored(self::settings(), entries, Box::new(NullStore)).unwrap();
        damaged.note("sim/001", key, json!({ "held": 5 })).unwrap();
        let own = Pair { supervisor: damaged, ..Pair::new() };
        let why = bridge(&own).err().map(|why| why.to_string()).unwrap_or_default();
        assert!(why.starts_with(&format!("sim/001, {key}: ")), "{key}: {why:?}");
    }
}

/// As Isaac Mission Dispatch writes its orders: of whom they are, only the topic says.
#[test]
fn orders_that_name_no_vehicle_are_of_that_of_their_topic() {
    let anonymous = |serial: &str| {
        let mut message = order("a", 0, 0, &TO, TO.len());
        for node in message["nodes"].as_array_mut().unwrap() {
            node["nodeDescription"] = json!("");
            let more =
                json!({ "mapDescription": "", "theta": 0.0, "allowedDeviationXY": 0.0, "allowedDeviationTheta": 0.0 });
            node["nodePosition"].as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
        }
        let header =
            json!({ "headerId": 0, "timestamp": "", "version": "2.0.0", "manufacturer": "", "serialNumber": serial });
        message.as_object_mut().unwrap().extend(header.as_object().unwrap().clone());
        message
    };
    let [manager, _] = interfaces();
    let topic = manager.topic(ProtocolVersion::V2_0, &key(), TopicKind::Order);
    for (serial, is_its) in [("", true), ("002", false)] {
        let mut own = Pair::new();
        own.bridge.receive(&mut own.supervisor, &topic, anonymous(serial).to_string().as_bytes(), own.time);
        own.lasts(60.0);
        assert_eq!(own.is_done("a"), is_its, "{serial:?}: {:?}", own.state);
        assert_eq!(own.errors().iter().any(|error| error.contains("serialNumber")), !is_its, "{:?}", own.errors());
    }
}

#[test]
fn an_order_that_is_lost_is_sent_again() {
    let mut own = Pair::new();
    own.loses = Some(|kind, _| kind == TopicKind::Order);
    own.order("a", &TO);
    own.lasts(60.0);
    assert!(own.is_done("a"), "{:?}", own.state);
}

#[test]
fn any_update_that_is_lost_is_sent_again() {
    for lost in [1, 2] {
        let mut own = Pair::new();
        own.loses = match lost {
            1 => Some(|kind, said| kind == TopicKind::Order && said["orderUpdateId"] == 1),
            _ => Some(|kind, said| kind == TopicKind::Order && said["orderUpdateId"] == 2),
        };
        own.says(TopicKind::Order, order("a", 0, 0, &TO[..1], 1));
        own.lasts(2.0);
        own.says(TopicKind::Order, order("a", 1, 0, &TO[..2], 2));
        own.lasts(2.0);
        own.says(TopicKind::Order, order("a", 2, 2, &TO[1..], 2));
        own.lasts(60.0);
        assert!(own.is_done("a") && own.loses.is_none(), "{lost}: {:?}", own.state);
    }
}

/// An old order that came late, between two others, was taken, and never admitted: every order after it was refused.
#[test]
fn an_order_that_comes_late_keeps_nobody_from_work() {
    let mut own = Pair::new();
    own.order("a", &TO);
    own.lasts(60.0);
    own.order("b", &FRO);
    own.lasts(60.0);
    assert!(own.is_done("b"));
    own.order("a", &TO);
    own.lasts(1.0);
    assert!(own.errors()[0].contains("an order of this name before"), "{:?}", own.errors());
    own.order("c", &TO);
    own.lasts(60.0);
    assert!(own.is_done("c"), "{:?}", own.state);
}

/// It was sent once: lost, the vehicle went on to where its base ended, and stood there for ever.
#[test]
fn what_cancels_an_order_is_sent_until_it_is_there() {
    for moment in [0.5, 4.0, 60.0] {
        let mut own = Pair::new();
        own.loses =
            Some(|kind, said| kind == TopicKind::InstantActions && said["actions"][0]["actionType"] == "cancelOrder");
        // The end is not released: it waits there.
        own.says(TopicKind::Order, order("a", 0, 0, &TO, 2));
        own.lasts(moment);
        own.cancels("stop");
        own.lasts(30.0);
        assert!(own.loses.is_none());
        let state = own.state.clone().unwrap();
        assert_eq!(state.action("stop"), Some("FINISHED"), "{moment}: {state:?}");
        // From where it stands.
        let pose = state.position().unwrap();
        own.order("b", &[[pose.x, pose.y], [8.0, 0.0]]);
        own.lasts(60.0);
        assert!(own.is_done("b"), "{moment}: {:?}", own.state);
    }
}

/// A message that came again gave up the order that the vehicle had meanwhile: its state still said that the action is done. What had been
/// sent and was on its way went to others, too.
#[test]
fn what_cancelled_an_order_before_cancels_nothing_when_it_comes_again() {
    for is_restarted in [false, true] {
        let mut own = Pair::new();
        own.order("a", &TO);
        own.lasts(2.0);
        own.cancels("stop");
        own.lasts(10.0);
        let [x, y] = own.vehicle.true_position();
        let places = [[x, y], [x + 4.0, y], [x + 8.0, y]];
        own.says(TopicKind::Order, order("b", 0, 0, &places, 2));
        own.lasts(30.0);
        assert_eq!(own.state.as_ref().unwrap().action("stop"), Some("FINISHED"));
        if is_restarted {
            own.restart();
        }
        own.loses = Some(|kind, said| kind == TopicKind::Order && said["orderId"] == "b");
        own.says(TopicKind::Order, order("b", 1, 2, &places[1..], 2));
        own.cancels("stop");
        let log = own.bridge.log();
        assert_eq!(
            log,
            ["fleet/v2/sim/001/instantActions: actions[0].actionId: \"stop\" was there before: it cancels nothing"]
        );
        own.lasts(60.0);
        assert!(own.is_done("b") && own.loses.is_none(), "{is_restarted}: {:?}", own.state);
        // Another one does, from there.
        own.order("c", &[places[2], places[1], places[0]]);
        own.lasts(2.0);
        own.cancels("stop again");
        own.lasts(10.0);
        assert!(own.bridge.lanes().all(|lane| lane.job().is_none()), "{:?}", own.state);
    }
}

/// After 32 updates of the order after it nobody remembered an order: it was driven again.
#[test]
fn an_order_is_an_old_one_however_many_updates_came_since() {
    let mut own = Pair::new();
    own.order("a", &[[0.0, 0.0], [1.0, 0.0]]);
    own.lasts(20.0);
    assert!(own.is_done("a"));
    let places: Vec<[f64; 2]> = (0..40).map(|k| [1.0 + 0.2 * f64::from(k), 0.0]).collect();
    own.says(TopicKind::Order, order("b", 0, 0, &places[..1], 1));
    for update in 1..40 {
        own.lasts(1.5);
        own.says(TopicKind::Order, order("b", update as u64, 2 * (update - 1) as u64, &places[update - 1..=update], 2));
        own.lasts(0.1);
        assert_eq!(own.errors(), [""; 0], "{update}");
    }
    own.lasts(20.0);
    assert!(own.is_done("b"), "{:?}", own.state);
    for _ in 0..2 {
        own.order("a", &[[8.8, 0.0], [1.0, 0.0]]);
        own.lasts(1.0);
        assert!(own.errors()[0].contains("an order of this name before"), "{:?}", own.errors());
        own.restart();
        own.lasts(1.0);
    }
    assert!(own.is_done("b"));
}

/// The vehicle said that there was nothing to cancel, as the order was lost: neither was sent again.
#[test]
fn an_order_that_is_cancelled_before_it_is_there_is_over() {
    let mut own = Pair::new();
    own.loses = Some(|kind, _| kind == TopicKind::Order);
    own.order("a", &TO);
    own.lasts(0.3);
    assert!(own.loses.is_none());
    own.cancels("stop");
    own.lasts(30.0);
    assert!(own.has_job(), "it may still come");
    own.lasts(40.0);
    own.order("b", &[[0.0, 0.0], [0.0, 4.0]]);
    own.lasts(60.0);
    assert!(own.is_done("b"), "{:?}", own.state);
}

/// Its order was lost while the supervisor was away: the new one sent an update that no vehicle could take, for ever.
#[test]
fn a_vehicle_that_has_lost_its_order_meanwhile_stands_where_it_says() {
    let mut own = Pair::new();
    own.says(TopicKind::Order, order("a", 0, 0, &TO[..2], 2));
    own.lasts(20.0);
    own.says(TopicKind::Order, order("a", 1, 2, &TO[1..], 2));
    own.lasts(5.0);
    own.restart();
    let [x, y] = own.vehicle.true_position();
    let time = own.time;
    own.vehicle = SimulatedVehicle::new(key(), ProtocolVersion::V2_1, "map", CAN, StartPose { x, y, heading: 0.0 }, 2);
    own.vehicle.set_clock(100.0);
    own.lasts(10.0);
    assert!(own.time > time);
    own.order("b", &[[x, y], [8.0, 0.0]]);
    own.lasts(60.0);
    assert!(own.is_done("b"), "{:?}", own.state);
}

/// It stood for ever, with all of its way released.
#[test]
fn a_vehicle_that_was_paused_by_a_late_message_or_before_a_restart_goes_on() {
    let mut own = Pair::new();
    own.order("a", &TO);
    own.lasts(3.0);
    let pause = json!({ "actionType": "startPause", "actionId": "pcr-startPause-1", "blockingType": "NONE" });
    let mut message = json!({ "actions": [pause], "headerId": 1, "timestamp": "2030-01-01T00:00:00.000Z" });
    let header = json!({ "version": "2.1.0", "manufacturer": "sim", "serialNumber": "001" });
    message.as_object_mut().unwrap().extend(header.as_object().unwrap().clone());
    own.vehicle.receive(TopicKind::InstantActions, message.to_string().as_bytes());
    own.restart();
    own.lasts(60.0);
    assert!(own.is_done("a"), "{:?}", own.state);
    // One that somebody else has paused is theirs.
    own.order("b", &FRO);
    own.lasts(3.0);
    message["actions"][0]["actionId"] = "by hand".into();
    own.vehicle.receive(TopicKind::InstantActions, message.to_string().as_bytes());
    own.lasts(60.0);
    assert!(!own.is_done("b"));
}

/// Somebody stands in the way of an order, is taken away, and it is told what its manager wants meanwhile; whether it stands then, and
/// whether it has come to its end 60 s later.
fn paused_and_stopped(before: &[&str], while_stopped: &[&str], restarts: bool) -> (Pair, [bool; 2]) {
    let mut own = Pair::new();
    own.order("a", &TO);
    own.lasts(3.0);
    for (k, kind) in before.iter().enumerate() {
        own.acts(kind, &format!("before-{k}"));
        own.lasts(2.0);
    }
    own.supervisor.add("new", profile(key(), &CAN).abilities, StartPose { x: 5.0, y: 2.0, heading: 0.0 }).unwrap();
    own.lasts(6.0);
    assert!(own.supervisor.robot("sim/001").unwrap().stopped.is_some() && own.is_paused());
    let place = own.vehicle.true_position();
    for (k, kind) in while_stopped.iter().enumerate() {
        own.acts(kind, &format!("stopped-{k}"));
        own.lasts(2.0);
        if restarts {
            own.restart();
            own.lasts(2.0);
        }
        // Not even for a moment.
        assert!(own.is_paused() && own.vehicle.true_position() == place, "{kind}");
    }
    own.supervisor.remove("new").unwrap();
    own.lasts(5.0);
    let is_paused = own.is_paused();
    own.lasts(60.0);
    let is_done = own.is_done("a");
    (own, [is_paused, is_done])
}

/// Who was paused by its manager, or by hand, and then stopped, was let go; and the manager let go who had to stand.
#[test]
fn pauses_of_others_are_theirs_to_end_and_ours_are_ours() {
    for restarts in [false, true] {
        for (before, while_stopped, found) in [
            (&[][..], &[][..], [false, true]),
            (&["startPause"], &[], [true, false]),
            (&["startPause", "stopPause"], &[], [false, true]),
            (&[], &["startPause"], [true, false]),
            (&[], &["stopPause"], [false, true]),
            (&["startPause"], &["stopPause"], [false, true]),
            (&["startPause"], &["stopPause", "startPause"], [true, false]),
            (&[], &["startPause", "stopPause"], [false, true]),
        ] {
            let context = format!("{before:?} {while_stopped:?} {restarts}");
            let (mut own, is) = paused_and_stopped(before, while_stopped, restarts);
            assert_eq!(is, found, "{context}: {:?}", own.state);
            let log = own.bridge.log();
            if while_stopped == ["stopPause"] {
                let state = own.state.clone().unwrap();
                assert_eq!(state.action("stopped-0"), Some("FINISHED"), "{context}");
                let why = "actions[0]: it stands for new; \"stopped-0\" is passed on when it may go";
                assert!(restarts || log.iter().any(|line| line.contains(why)), "{context}: {log:?}");
            }
            own.acts("stopPause", "in the end");
            own.lasts(60.0);
            assert!(own.is_done("a"), "{context}: {:?}", own.state);
        }
    }
}

/// The manager pauses it as it is let go: that was ended by what let it go, said again.
#[test]
fn who_is_paused_as_it_is_let_go_is_paused() {
    for wait in [0.0, 0.1, 0.3, 1.5] {
        let mut own = Pair::new();
        own.order("a", &TO);
        own.lasts(3.0);
        own.supervisor.add("new", profile(key(), &CAN).abilities, StartPose { x: 5.0, y: 2.0, heading: 0.0 }).unwrap();
        own.lasts(6.0);
        own.supervisor.remove("new").unwrap();
        own.lasts(wait);
        own.acts("startPause", "manager");
        own.lasts(30.0);
        assert!(own.is_paused() && !own.is_done("a"), "{wait}");
        own.acts("stopPause", "manager too");
        own.lasts(60.0);
        assert!(own.is_done("a"), "{wait}: {:?}", own.state);
    }
}

#[test]
fn who_is_missing_is_said() {
    let supervisor = Supervisor::new(settings(), Box::new(NullStore));
    let mut own = Pair::new();
    own.supervisor = supervisor;
    own.bridge = bridge_of(&own.supervisor);
    own.bridge.settled(&mut own.supervisor, &[], 31.0);
    own.bridge.settled(&mut own.supervisor, &[], 62.0);
    let why = "sim/001 has not said where it stands, so no vehicle is released anything: switch it on, or say that it is away";
    assert_eq!(own.bridge.log(), [why]);
}

fn standstills(events: Vec<SupervisorEvent>) -> Vec<String> {
    let why = |event| if let SupervisorEvent::Standstill { why, .. } = event { Some(why) } else { None };
    events.into_iter().filter_map(why).collect()
}

#[test]
fn who_gets_nowhere_is_said_and_why() {
    use pcr_serve::owned_path::PathElement;
    use pcr_serve::supervisor::MissionRequest;
    let abilities = profile(key(), &CAN).abilities;
    let line = |robot: &str, length| MissionRequest {
        robot: robot.into(),
        mission: "1".into(),
        after: None,
        expected_path: None,
        any_heading: false,
        start: None,
        path: vec![PathElement::Line { length }],
    };
    let at = |x, heading| StartPose { x, y: 0.0, heading };
    let mut own = Supervisor::new(settings(), Box::new(NullStore));
    own.add("a", abilities.clone(), at(0.0, 0.0)).unwrap();
    own.add("b", abilities.clone(), at(6.0, std::f64::consts::PI)).unwrap();
    let all = |own: &mut Supervisor, times: std::ops::Range<u32>| -> Vec<String> {
        let mut said = Vec::new();
        for time in times {
            for robot in ["a", "b"] {
                let known = own.robot(robot).unwrap();
                let report =
                    PositionReport { robot: robot.into(), path: known.path, at: [known.arc_length; 2], age: 0.0 };
                own.position(&report, time.into()).unwrap();
            }
            said.extend(standstills(own.settle(time.into()).unwrap()));
        }
        said
    };
    // Nobody wants anything.
    assert_eq!(all(&mut own, 0..100), [""; 0]);
    own.mission(&line("a", 10.0), 100.0).unwrap();
    assert_eq!(all(&mut own, 100..300), ["b has nothing to do, and is in the way of a"]);
    own.mission(&line("b", 10.0), 300.0).unwrap();
    assert_eq!(all(&mut own, 300..500), ["a, b wait for one another"]);
    own.remove("b").unwrap();
    own.add("b", abilities, StartPose { x: 0.0, y: 50.0, heading: 0.0 }).unwrap();
    assert_eq!(all(&mut own, 500..700), ["a is at 0.00 m, and may go to 10.00 m"]);
}

/// What waited was given up for a mission without a way, and the vehicle, which was still on its order, counted as at the end of it.
#[test]
fn the_way_of_a_cancelled_order_is_its_own_until_it_stands() {
    let mut own = Pair::new();
    own.says(TopicKind::Order, order("a", 0, 0, &[[0.0, 0.0], [4.0, 0.0]], 2));
    // Somebody stands where its order is to go on to.
    let start = StartPose { x: 8.0, y: 0.0, heading: 0.0 };
    let name = own.bridge.lanes().next().unwrap().name().to_owned();
    own.lasts(1.5);
    let abilities = own.supervisor.robot(&name).unwrap().abilities.clone();
    own.supervisor.add("other", abilities, start).unwrap();
    own.says(TopicKind::Order, order("a", 1, 2, &[[4.0, 0.0], [8.0, 0.0]], 2));
    own.lasts(0.1);
    assert!(own.supervisor.robot(&name).unwrap().waiting.is_some());
    own.loses = Some(|kind, _| kind == TopicKind::InstantActions);
    own.cancels("stop");
    for _ in 0..20 {
        own.lasts(0.1);
        let robot = own.supervisor.robot(&name).unwrap();
        let [x, _] = own.vehicle.true_position();
        assert!(robot.waiting.is_none() && robot.arc_length <= x + 0.5, "{} at {x}", robot.arc_length);
    }
    own.lasts(30.0);
    assert!(own.bridge.lanes().all(|lane| lane.job().is_none()), "{:?}", own.state);
    // Neither did a way that somebody else gave it.
    own.supervisor.remove("other").unwrap();
    let [x, y] = own.vehicle.true_position();
    own.order("b", &[[x, y], [x + 4.0, y]]);
    own.lasts(2.0);
    let path = vec![pcr_serve::owned_path::PathElement::Line { length: 0.5 }];
    let proposal = MissionRequest {
        robot: name.clone(),
        mission: "mine".into(),
        after: None,
        expected_path: None,
        any_heading: false,
        start: None,
        path,
    };
    own.supervisor.mission(&proposal, own.time).unwrap();
    let (before, [from, _]) = (own.supervisor.robot(&name).unwrap().arc_length, own.vehicle.true_position());
    own.lasts(0.5);
    assert!(own.vehicle.true_position()[0] > from + 0.2, "it drives");
    let robot = own.supervisor.robot(&name).unwrap();
    assert!(robot.arc_length == before && robot.alarm.is_none(), "{robot:?}");
}

/// The order that it had lost was sent again, for ever.
#[test]
fn a_vehicle_that_loses_its_order_while_that_is_cancelled_does_not_get_it_again() {
    let mut own = Pair::new();
    own.order("a", &TO);
    own.lasts(2.0);
    let [x, y] = own.vehicle.true_position();
    own.vehicle = SimulatedVehicle::new(key(), ProtocolVersion::V2_1, "map", CAN, StartPose { x, y, heading: 0.0 }, 2);
    own.vehicle.set_clock(100.0);
    own.cancels("stop");
    own.lasts(20.0);
    assert!(own.bridge.lanes().all(|lane| lane.job().is_none()), "{:?}", own.state);
    let place = own.vehicle.true_position();
    assert!((place[0] - x).hypot(place[1] - y) < 0.1, "it stands: {place:?}");
}

/// The error of its position counted twice: where it stands, and in its margin.
#[test]
fn a_cancelled_vehicle_stands_on_its_way() {
    let mut own = Pair::new();
    own.order("a", &[[0.0, 0.0], [8.0, 0.0]]);
    own.lasts(4.0);
    own.cancels("stop");
    own.lasts(20.0);
    assert!(own.bridge.lanes().all(|lane| lane.job().is_none()));
    let said = own.state.as_ref().unwrap().position().unwrap().y;
    let stands = own.supervisor.robots()[0].course.start();
    assert!(
        said.abs() > 1e-6 && stands.y.abs() < 1e-9 && (stands.x - own.vehicle.true_position()[0]).abs() < 0.1,
        "{said} {stands:?}"
    );
}

/// By the number alone it had passed the whole of its order where it had all of it ahead.
#[test]
fn a_last_node_of_another_order_is_none() {
    let mut own = Pair::new();
    let name = own.bridge.lanes().next().unwrap().name().to_owned();
    // Out and back: the end is where it begins.
    own.order("a", &[[0.0, 0.0], [2.0, 0.0], [0.0, 0.0]]);
    own.lasts(0.4);
    let state = own.bridge.lanes().next().unwrap().state_of().unwrap().clone();
    assert_eq!((state.order_id.as_str(), own.bridge.lanes().next().unwrap().job().unwrap().stops.len()), ("a", 3));
    let [_, vehicles] = interfaces();
    let topic = vehicles.topic(ProtocolVersion::V2_1, &key(), TopicKind::State);
    for (id, sequence) in [("", 4), ("old", 4), ("n4", 4)] {
        let mut state = state.clone();
        (state.last_node_id, state.last_node_sequence_id) = (id.into(), sequence);
        state.header.header_id += 1_000 + sequence;
        state.header.timestamp = "2031-01-01T00:00:00.000Z".into();
        let text = serde_json::to_vec(&state).unwrap();
        own.bridge.receive(&mut own.supervisor, &topic, &text, own.time);
        let robot = own.supervisor.robot(&name).unwrap();
        assert!(robot.arc_length < 1.0, "{id:?}: {}", robot.arc_length);
    }
}

/// It was sent every second for ever, and nothing ended it.
#[test]
fn a_first_order_that_the_vehicle_refuses_is_over() {
    for is_cancelled in [false, true] {
        let mut own = Pair::new();
        // It was there before, as only the vehicle knows.
        for id in ["a", "own"] {
            own.whispers(TopicKind::Order, order(id, 0, 0, &TO[..1], 1));
        }
        own.lasts(1.0);
        own.says(TopicKind::Order, order("a", 7, 0, &TO, 3));
        own.lasts(3.0);
        let errors = own.errors().concat();
        assert!(errors.contains(r#""orderUpdateId","referenceValue":"7""#), "by the manager's number: {errors}");
        assert!(own.has_job());
        if is_cancelled {
            own.cancels("stop");
            own.lasts(10.0);
            assert!(own.has_job(), "another copy may still come");
            own.lasts(20.0);
        } else {
            own.lasts(50.0);
        }
        assert!(!own.has_job(), "{is_cancelled}: {:?}", own.state);
        own.order("b", &TO);
        own.lasts(60.0);
        assert!(own.is_done("b"), "{is_cancelled}: {:?}", own.state);
    }
}

/// Somebody at the vehicle had ended its order: the rest of it was sent for ever, and `cancelOrder` did not end that.
#[test]
fn an_update_that_the_vehicle_refuses_is_over_when_it_is_cancelled() {
    for is_restarted in [false, true] {
        let mut own = Pair::new();
        own.says(TopicKind::Order, order("a", 0, 0, &TO, 2));
        own.lasts(20.0);
        let by_hand = json!({ "actionType": "cancelOrder", "actionId": "by hand", "blockingType": "NONE" });
        own.whispers(TopicKind::InstantActions, json!({ "actions": [by_hand] }));
        own.lasts(2.0);
        own.says(TopicKind::Order, order("a", 1, 2, &TO[1..], 2));
        own.lasts(30.0);
        assert!(own.has_job() && own.errors().concat().contains("it was cancelled"), "{:?}", own.errors());
        if is_restarted {
            own.restart();
            own.lasts(5.0);
        }
        own.cancels("stop");
        own.lasts(70.0);
        assert!(!own.has_job(), "{is_restarted}: {:?}", own.state);
        let [x, y] = own.vehicle.true_position();
        own.order("b", &[[x, y], [x, y + 3.0]]);
        own.lasts(60.0);
        assert!(own.is_done("b"), "{is_restarted}: {:?}", own.state);
    }
}

/// They were dropped: the vehicle did not know of which zones the manager spoke.
#[test]
fn other_fields_of_an_order_are_passed_on() {
    let mut own = Pair::new();
    own.loses = Some(|kind, said| {
        kind == TopicKind::Order && said["zoneSetId"] == "z" && said["orderDescription"] == "to the dock"
    });
    let mut message = order("a", 0, 0, &TO, 3);
    message["zoneSetId"] = "z".into();
    message["orderDescription"] = "to the dock".into();
    own.says(TopicKind::Order, message);
    own.lasts(1.0);
    assert!(own.loses.is_none(), "as it came");
}

/// After a restart it was forgotten until the vehicle said it again.
#[test]
fn a_vehicle_that_is_too_large_is_remembered() {
    let mut own = Pair::new();
    let start = StartPose { x: 0.0, y: 0.0, heading: 0.0 };
    own.vehicle =
        SimulatedVehicle::new(key(), ProtocolVersion::V2_1, "map", SimulatedTraits { radius: 0.6, ..CAN }, start, 1);
    own.vehicle.set_clock(100.0);
    own.acts("factsheetRequest", "how large");
    own.lasts(2.0);
    own.order("a", &TO);
    for _ in 0..2 {
        own.lasts(5.0);
        assert!(own.bridge.lanes().all(|lane| lane.misfit().is_some()));
        assert_eq!(own.vehicle.taken(), 0, "nothing is released");
        own.restart();
    }
}
