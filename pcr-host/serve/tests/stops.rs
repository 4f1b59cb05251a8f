//! Stops: they wait for no journal, and robots that stand anyway get none.

use crate::office::{Door, Office};
use crate::world::Disc;
use pcr_serve::event::{CancelCause, SupervisorEvent};
use pcr_serve::owned_path::{PathElement, StartPose};
use pcr_serve::robot::RobotTraits;
use pcr_serve::server::{AfterCommit, ServerInput};
use pcr_serve::supervisor::{AdmissionResult, MissionRequest, PositionReport, Supervisor, SupervisorConfig};
use serde_json::{Value, json};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

const CAN: RobotTraits = RobotTraits { radius: 0.25, footprint: None, margin: 0.0, speed: 1.0, acceleration: 0.5 };

/// A robot under way, and a disk that no longer writes.
fn driving() -> Office {
    let own = Office::open();
    own.mission(1, "a");
    (0..3).for_each(|_| drop(own.next()));
    own.slow.set(Door::Shut);
    own
}

fn beside(own: &Office, id: u64, x: f64) {
    own.ask(&json!({ "id": id, "verb": "off", "robot": "b", "x": x, "y": 0.0 }));
}

/// A stop was told when the journal had written what was decided before it, or not at all.
#[test]
fn a_stop_is_told_at_once_also_as_the_disc_fails() {
    for door in [Door::Open, Door::Broken] {
        let own = driving();
        beside(&own, 2, 2.0);
        let stop = own.next();
        assert_eq!([&stop["event"], &stop["robot"], &stop["by"]], ["stop", "a", "b"], "{stop}");
        own.at("a");
        assert!(own.lines.try_recv().is_err(), "all else waits");
        own.slow.set(door);
        let next = own.next();
        assert_eq!((next["id"].as_u64(), next["error"]["code"] == "broken"), (Some(2), door == Door::Broken), "{next}");
        if door == Door::Open {
            // Once more in its place, for clients that did not know the robot yet or had asked for its state before.
            let mut told = [own.next(), own.next()].map(|next| next["event"].as_str().unwrap_or_default().to_owned());
            told.sort();
            assert_eq!(told, ["alarm", "stop"]);
            own.handle.send(ServerInput::Stop);
        }
        assert_eq!(own.server.join().unwrap().is_ok(), door == Door::Open);
    }
}

/// What lets a robot go on was decided before it has to stop again: it comes never, and not after the stop.
#[test]
fn nothing_that_was_decided_before_a_stop_lets_go_after_it() {
    let own = driving();
    for (id, x) in [(2, 2.0), (3, 200.0), (4, 2.0), (5, 200.0)] {
        beside(&own, id, x);
        // Each is a batch of its own.
        own.at("a");
    }
    own.slow.set(Door::Open);
    own.handle.send(ServerInput::Stop);
    let told: Vec<Value> = own.rest();
    let of_a = told.iter().filter(|line| line["robot"] == "a").map(|line| line["event"].as_str().unwrap());
    let of_a: Vec<&str> = of_a.filter(|event| ["stop", "go"].contains(event)).collect();
    // Both stops at once, and again in their places.
    assert_eq!(of_a, ["stop", "stop", "stop", "stop", "go"], "{told:?}");
}

/// What waited for a disk that hangs grew until there was no memory.
#[test]
fn while_too_much_waits_for_the_journal_nothing_is_read() {
    let own = driving();
    own.mission(2, "b");
    own.handle.ask_then(|_, _, _| ((), Some(AfterCommit::new(65 << 20, || ())))).unwrap();
    let is_read = Arc::new(AtomicBool::new(false));
    let flag = is_read.clone();
    own.handle.send(ServerInput::Call(Box::new(move |_, _, _| {
        flag.store(true, Ordering::Relaxed);
        None
    })));
    std::thread::sleep(Duration::from_millis(200));
    assert!(!is_read.load(Ordering::Relaxed));
    own.slow.set(Door::Open);
    own.at("a");
    assert!(is_read.load(Ordering::Relaxed));
    own.handle.send(ServerInput::Stop);
    assert_eq!(own.server.join().unwrap(), Ok(()));
}

/// The disc around a robot off its path grows with time, also while nothing is read.
#[test]
fn robots_are_stopped_while_nothing_is_read() {
    let own = driving();
    beside(&own, 2, 6.0);
    own.handle.ask_then(|_, _, _| ((), Some(AfterCommit::new(65 << 20, || ())))).unwrap();
    assert!(own.lines.try_recv().is_err(), "it is too far away yet");
    let stop = own.next();
    assert_eq!([&stop["event"], &stop["robot"], &stop["by"]], ["stop", "a", "b"], "{stop}");
    own.slow.set(Door::Open);
    own.at("a");
    own.handle.send(ServerInput::Stop);
    assert_eq!(own.server.join().unwrap(), Ok(()));
}

fn supervisor() -> Supervisor {
    let mut own = Supervisor::new(SupervisorConfig::default(), Box::new(Disc::new()));
    own.add("a", CAN, StartPose { x: 0.0, y: 0.0, heading: 0.0 }).unwrap();
    own.add("b", CAN, StartPose { x: 0.0, y: 9.0, heading: 0.0 }).unwrap();
    own
}

fn mission(robot: &str, name: &str, length: f64) -> MissionRequest {
    let path = vec![PathElement::Line { length }];
    MissionRequest {
        robot: robot.into(),
        mission: name.into(),
        after: None,
        expected_path: None,
        any_heading: false,
        start: None,
        path,
    }
}

/// Its length stays a little before the end of its path, so it counted as one that drives.
#[test]
fn a_robot_at_the_end_of_its_path_stands() {
    let mut own = supervisor();
    own.mission(&mission("a", "1", 2.0), 0.0).unwrap();
    own.settle(0.0).unwrap();
    own.position(&PositionReport { robot: "a".into(), path: 2, at: [2.0, 2.0], age: 0.0 }, 1.0).unwrap();
    own.settle(1.0).unwrap();
    own.report_off_path("b", [2.0, 0.1], 0.0, 2.0).unwrap();
    let events = own.settle(2.0).unwrap();
    assert!(matches!(events[..], [SupervisorEvent::Alarm { .. }]), "{events:?}");
    assert!(own.robot("a").unwrap().stopped.is_none());
}

/// Who watched believed for ever that it had an alarm, had to stand and had a mission that waited.
#[test]
fn a_robot_that_is_moved_tells_what_ends_by_it() {
    let mut own = supervisor();
    own.mission(&mission("a", "1", 5.0), 0.0).unwrap();
    own.settle(0.0).unwrap();
    for (robot, at) in [("b", [1.0, 0.1]), ("a", [0.5, 0.9])] {
        own.report_off_path(robot, at, 0.0, 1.0).unwrap();
    }
    let waits = own.mission(&mission("a", "2", 5.0), 1.0).unwrap();
    assert!(matches!(waits, AdmissionResult::Waiting { .. }), "{waits:?}");
    own.settle(1.0).unwrap();
    assert!(own.robot("a").unwrap().stopped.is_some());
    own.reseat("a", StartPose { x: 50.0, y: 50.0, heading: 0.0 }).unwrap();
    let robot = || String::from("a");
    let dropped = SupervisorEvent::Dropped { robot: robot(), mission: "2".into(), why: CancelCause::Moved };
    let events = own.settle(2.0).unwrap();
    assert_eq!(events, [dropped, SupervisorEvent::Clear { robot: robot() }, SupervisorEvent::Go { robot: robot() }]);
}

/// So did a mission that another one of the same path took the place of.
#[test]
fn a_mission_that_waits_is_given_up_for_one_that_is_adopted() {
    let mut own = supervisor();
    own.add("c", CAN, StartPose { x: 5.0, y: 0.0, heading: 0.0 }).unwrap();
    let waits = own.mission(&mission("a", "1", 9.0), 0.0).unwrap();
    assert!(matches!(waits, AdmissionResult::Waiting { .. }), "{waits:?}");
    own.settle(0.0).unwrap();
    own.adopt("a", "2".into()).unwrap();
    let dropped = SupervisorEvent::Dropped { robot: "a".into(), mission: "1".into(), why: CancelCause::Replaced };
    assert_eq!(own.settle(1.0).unwrap(), [dropped]);
}
