//! Robots that are not where they may be, or not heard: everybody who could touch them stops, and nobody gets their right.

use crate::world::Disc;
use pcr_serve::event::SupervisorEvent;
use pcr_serve::owned_path::{PathElement, StartPose};
use pcr_serve::request_error::RequestError;
use pcr_serve::robot::{Alarm, RobotTraits};
use pcr_serve::supervisor::{AdmissionResult, MissionRequest, PositionReport, Supervisor, SupervisorConfig};
use std::f64::consts::FRAC_PI_2;

const ABILITIES: RobotTraits =
    RobotTraits { radius: 0.25, footprint: None, margin: 0.0, speed: 1.0, acceleration: 0.5 };

fn place(x: f64, y: f64, heading: f64) -> StartPose {
    StartPose { x, y, heading }
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

fn report(robot: &str, path: u64, lo: f64, hi: f64) -> PositionReport {
    PositionReport { robot: robot.into(), path, at: [lo, hi], age: 0.0 }
}

/// One that goes east through the origin, and one that goes north there second.
fn crossing(disc: &Disc) -> Supervisor {
    let mut own = Supervisor::new(SupervisorConfig::default(), Box::new(disc.clone()));
    own.add("east", ABILITIES, place(-3.0, 0.0, 0.0)).unwrap();
    own.add("north", ABILITIES, place(0.0, -4.0, FRAC_PI_2)).unwrap();
    for (robot, length) in [("east", 6.0), ("north", 8.0)] {
        let verdict = own.mission(&mission(robot, "1", length), 0.0).unwrap();
        assert!(matches!(verdict, AdmissionResult::Admitted { path: 2, .. }), "{verdict:?}");
    }
    own.settle(0.0).unwrap();
    own
}

fn names(events: &[SupervisorEvent]) -> Vec<String> {
    let kind = |event| serde_json::to_value(event).unwrap()["event"].as_str().unwrap().to_owned();
    events.iter().map(|event| format!("{} {}", kind(event), event.robot().unwrap_or_default())).collect()
}

#[test]
fn beyond_its_hold() {
    let disc = Disc::new();
    let mut own = crossing(&disc);
    own.position(&report("north", 2, 2.0, 2.1), 1.0).unwrap();
    own.settle(1.0).unwrap();
    let hold = own.robot("north").unwrap().granted;
    assert!((hold - 3.5).abs() < 1e-5, "{hold}");
    // It does not stop before the crossing; the other one, which has the right to go there, is stopped at once.
    own.position(&report("north", 2, 3.9, 4.0), 3.0).unwrap();
    let events = own.settle(3.0).unwrap();
    assert_eq!(names(&events), ["alarm north", "stop east"]);
    assert!(matches!(own.robot("north").unwrap().alarm, Some(Alarm::Beyond { .. })));
    // What it says does not let anybody go on, and it gets no mission.
    own.position(&report("east", 2, 0.2, 0.3), 3.1).unwrap();
    assert_eq!(own.settle(3.1).unwrap(), []);
    let verdict = own.mission(&mission("north", "2", 1.0), 3.1).unwrap();
    assert!(matches!(verdict, AdmissionResult::Waiting { .. }), "{verdict:?}");
    own.settle(3.1).unwrap();
    // It is so after a restart, wherever it is now.
    let mut own = Supervisor::restored(SupervisorConfig::default(), disc.entries(), Box::new(disc.clone())).unwrap();
    let events = own.settle(0.0).unwrap();
    assert!(names(&events).contains(&"stop east".into()), "{events:?}");
    // Back where it may be: all go on.
    own.position(&report("north", 2, 3.3, 3.4), 1.0).unwrap();
    let events = names(&own.settle(1.0).unwrap());
    assert!(events.contains(&"clear north".into()) && events.contains(&"go east".into()), "{events:?}");
    assert!(own.robot("east").unwrap().stopped.is_none());
}

#[test]
fn off_its_path_further_than_any_path_can_be() {
    let disc = Disc::new();
    let mut own = crossing(&disc);
    // Nobody knows where it is.
    own.report_off_path("north", [5e7, 0.0], 0.0, 1.0).unwrap();
    let events = own.settle(1.0).unwrap();
    assert_eq!(names(&events), ["alarm north", "stop east"]);
    // So it is after a restart.
    let mut own = Supervisor::restored(SupervisorConfig::default(), disc.entries(), Box::new(disc.clone())).unwrap();
    let events = own.settle(0.0).unwrap();
    assert!(names(&events).contains(&"stop east".into()), "{events:?}");
    assert!(matches!(own.report_off_path("north", [f64::NAN, 0.0], 0.0, 1.0), Err(RequestError::Invalid { .. })));
}

#[test]
fn off_its_path() {
    let disc = Disc::new();
    let mut own = crossing(&disc);
    // Far from where anybody has been allowed to go: nobody stops yet, but nobody may come near.
    own.report_off_path("north", [3.5, -1.0], 0.0, 1.0).unwrap();
    let events = own.settle(1.0).unwrap();
    assert_eq!(names(&events), ["alarm north"]);
    own.position(&report("east", 2, 2.5, 2.6), 1.1).unwrap();
    own.settle(1.1).unwrap();
    let near = own.robot("east").unwrap().granted;
    assert!(near < 5.7, "{near}");
    // Not heard of since: it can have come nearer.
    let mut stopped = None;
    for tick in 12..40 {
        let now = f64::from(tick) * 0.1;
        if names(&own.settle(now).unwrap()).contains(&"stop east".into()) {
            stopped = Some(now);
            break;
        }
    }
    assert!(stopped.is_some_and(|now| now < 2.5), "{stopped:?}");
    own.report_off_path("north", [9.0, -9.0], 0.0, 5.0).unwrap();
    assert_eq!(names(&own.settle(5.0).unwrap())[0], "go east");
}

#[test]
fn added_where_others_may_go() {
    let disc = Disc::new();
    let mut own = crossing(&disc);
    own.add("new", ABILITIES, place(-1.0, 0.3, 0.0)).unwrap();
    let events = own.settle(1.0).unwrap();
    assert_eq!(names(&events), ["stop east"]);
    // It goes away, and so does what was wrong.
    assert!(own.remove("new").unwrap());
    assert_eq!(names(&own.settle(1.1).unwrap())[0], "go east");
    // Where nobody may go yet, nobody is stopped: they wait.
    own.add("new", ABILITIES, place(1.6, 0.0, 0.0)).unwrap();
    assert_eq!(names(&own.settle(1.2).unwrap()), Vec::<String>::new());
    own.position(&report("east", 2, 2.9, 3.0), 3.0).unwrap();
    let events = own.settle(3.0).unwrap();
    let told = |event: &SupervisorEvent| matches!(event, SupervisorEvent::Hold { robot, hold, waits_for, .. } if robot == "east" && (hold - 4.1).abs() < 1e-4 && waits_for.as_deref() == Some("new"));
    assert!(events.iter().any(told), "{events:?}");
}

/// It stopped the one that had been there for good, and nobody got a mission any more.
#[test]
fn added_where_another_one_has_been() {
    let mut own = Supervisor::new(SupervisorConfig::default(), Box::new(Disc::new()));
    own.add("x", ABILITIES, place(0.0, 0.0, 0.0)).unwrap();
    own.add("far", ABILITIES, place(0.0, 50.0, 0.0)).unwrap();
    own.mission(&mission("x", "1", 20.0), 0.0).unwrap();
    own.settle(0.0).unwrap();
    for tick in 1..=8 {
        let at = f64::from(tick);
        own.position(&report("x", 2, at, at), at).unwrap();
        own.settle(at).unwrap();
    }
    own.add("new", ABILITIES, place(4.0, 0.0, 0.0)).unwrap();
    assert_eq!(names(&own.settle(9.0).unwrap()), [""; 0]);
    own.position(&report("x", 2, 9.0, 9.0), 10.0).unwrap();
    own.settle(10.0).unwrap();
    assert!(own.robot("x").unwrap().granted > 10.0, "{:?}", own.robot("x"));
    // Ahead of it, the one that was added is in its way for ever; others are asked to wait for neither.
    own.add("ahead", ABILITIES, place(19.5, 0.0, 0.0)).unwrap();
    own.settle(10.1).unwrap();
    let verdict = own.mission(&mission("far", "1", 1.0), 10.2).unwrap();
    assert!(matches!(verdict, AdmissionResult::Admitted { .. }), "{verdict:?}");
    own.settle(10.2).unwrap();
    for tick in 10..=30 {
        let (now, hold) = (f64::from(tick) + 0.5, own.robot("x").unwrap().granted);
        assert!(hold < 19.0 + 1e-6, "{hold}");
        own.position(&report("x", 2, hold.min(now), hold.min(now)), now).unwrap();
        own.settle(now).unwrap();
    }
}

#[test]
fn silent_robots_keep_their_right() {
    let disc = Disc::new();
    let mut own = crossing(&disc);
    own.position(&report("east", 2, 1.0, 1.1), 1.0).unwrap();
    own.position(&report("north", 2, 2.9, 3.0), 1.0).unwrap();
    own.settle(1.0).unwrap();
    let hold = own.robot("north").unwrap().granted;
    let mut heard = Vec::new();
    for tick in 11..200 {
        let now = f64::from(tick) * 0.1;
        own.position(&report("north", 2, 3.4, 3.49), now).unwrap();
        heard.extend(names(&own.settle(now).unwrap()));
    }
    assert_eq!(heard, ["silent east"]);
    assert_eq!(own.robot("north").unwrap().granted, hold);
    // It may be anywhere up to where it was allowed to go.
    let east = own.robot("east").unwrap();
    let extent = east.possible_positions(20.0);
    assert_eq!([extent.lo, extent.hi], [1.0, east.notified_limit]);
    // Old messages, and those of older paths, change nothing.
    own.position(&PositionReport { age: 19.5, ..report("east", 2, 0.1, 0.2) }, 20.0).unwrap();
    own.position(&report("east", 1, 5.0, 5.9), 20.0).unwrap();
    assert_eq!(names(&own.settle(20.0).unwrap()), ["heard east"]);
    assert_eq!(own.robot("east").unwrap().arc_length, 1.0);
    assert_eq!(own.robot("north").unwrap().granted, hold);
}

#[test]
fn missions_that_are_asked_for_again() {
    let disc = Disc::new();
    let mut own = crossing(&disc);
    // On the way of the other one, which stands there for good: it waits until another mission takes its place.
    own.remove("north").unwrap();
    own.add("stands", ABILITIES, place(5.0, 0.0, 0.0)).unwrap();
    let verdict = own.mission(&mission("east", "2", 4.0), 1.0).unwrap();
    assert!(matches!(&verdict, AdmissionResult::Waiting { by: Some(by), .. } if by == "stands"), "{verdict:?}");
    assert_eq!(own.mission(&mission("east", "2", 4.0), 1.1).unwrap(), verdict);
    let admitted = own.mission(&mission("east", "3", 0.5), 1.2).unwrap();
    assert!(matches!(admitted, AdmissionResult::Admitted { path: 3, .. }));
    let events = names(&own.settle(1.2).unwrap());
    assert!(events.contains(&"dropped east".into()) && events.contains(&"admitted east".into()), "{events:?}");
    for _ in 0..2 {
        // Late and repeated: nothing twice, also after a restart.
        assert_eq!(own.mission(&mission("east", "1", 6.0), 2.0).unwrap(), AdmissionResult::Past);
        assert_eq!(own.mission(&mission("east", "2", 4.0), 2.0).unwrap(), AdmissionResult::Past);
        assert!(matches!(
            own.mission(&mission("east", "3", 0.5), 2.0).unwrap(),
            AdmissionResult::Admitted { path: 3, .. }
        ));
        assert!(own.robot("east").unwrap().waiting.is_none());
        own.settle(2.0).unwrap();
        own = Supervisor::restored(SupervisorConfig::default(), disc.entries(), Box::new(disc.clone())).unwrap();
    }
}

/// A message from before it was beyond, that came late, ended the alarm: others were let go on.
#[test]
fn late_messages_end_no_alarm() {
    let mut own = crossing(&Disc::new());
    own.position(&report("north", 2, 3.9, 4.0), 3.0).unwrap();
    assert_eq!(names(&own.settle(3.0).unwrap()), ["alarm north", "stop east"]);
    own.position(&PositionReport { age: 2.0, ..report("north", 2, 2.0, 2.1) }, 3.1).unwrap();
    assert_eq!(own.settle(3.1).unwrap(), []);
    own.position(&PositionReport { age: 0.05, ..report("north", 2, 2.5, 2.6) }, 3.2).unwrap();
    let events = names(&own.settle(3.2).unwrap());
    assert!(events.contains(&"clear north".into()) && events.contains(&"go east".into()), "{events:?}");
}

/// A late message that a robot was beyond made the alarm as old as itself, and the next late one ended it.
#[test]
fn late_messages_make_no_alarm_older() {
    for is_off in [true, false] {
        let mut own = crossing(&Disc::new());
        match is_off {
            true => own.report_off_path("north", [0.0, -0.1], 0.0, 3.0).unwrap(),
            false => own.position(&report("north", 2, 3.9, 4.0), 3.0).unwrap(),
        }
        assert_eq!(names(&own.settle(3.0).unwrap()), ["alarm north", "stop east"]);
        let alarm = own.robot("north").unwrap().alarm.clone();
        own.position(&PositionReport { age: 1.5, ..report("north", 2, 5.0, 5.5) }, 3.1).unwrap();
        own.position(&PositionReport { age: 1.2, ..report("north", 2, 0.0, 0.1) }, 3.2).unwrap();
        assert_eq!(own.settle(3.2).unwrap(), []);
        let robot = own.robot("north").unwrap();
        assert_eq!((&robot.alarm, robot.heard), (&alarm, Some(3.0)));
        own.position(&report("north", 2, 0.2, 0.3), 3.3).unwrap();
        let events = names(&own.settle(3.3).unwrap());
        assert!(events.contains(&"clear north".into()) && events.contains(&"go east".into()), "{events:?}");
    }
    // One from before a newer one, which says that it is where it may be, is none at all.
    let mut own = crossing(&Disc::new());
    own.position(&report("north", 2, 2.0, 2.1), 3.0).unwrap();
    own.position(&PositionReport { age: 0.5, ..report("north", 2, 5.0, 5.5) }, 3.1).unwrap();
    assert!(!names(&own.settle(3.1).unwrap()).contains(&"alarm north".into()));
}

/// What was said before the start, and came after it, ended an alarm: others were let go on.
#[test]
fn after_a_restart_only_what_was_said_since_then_ends_an_alarm() {
    for is_off in [true, false] {
        let disc = Disc::new();
        let mut own = crossing(&disc);
        match is_off {
            true => own.report_off_path("north", [0.0, -0.1], 0.0, 3.0).unwrap(),
            false => own.position(&report("north", 2, 3.9, 4.0), 3.0).unwrap(),
        }
        own.settle(3.0).unwrap();
        let mut own =
            Supervisor::restored(SupervisorConfig::default(), disc.entries(), Box::new(disc.clone())).unwrap();
        assert!(names(&own.settle(10.0).unwrap()).contains(&"stop east".into()));
        // They bound no place either: what was known of it may be newer.
        own.report_off_path("north", [50.0, 50.0], 4.0, 10.1).unwrap();
        own.position(&PositionReport { age: 3.0, ..report("north", 2, 3.9, 4.0) }, 10.15).unwrap();
        own.position(&PositionReport { age: 0.5, ..report("north", 2, 2.0, 2.1) }, 10.2).unwrap();
        own.position(&PositionReport { age: 0.4, ..report("north", 2, 2.0, 2.1) }, 10.3).unwrap();
        assert_eq!(own.settle(10.3).unwrap(), []);
        let robot = own.robot("north").unwrap();
        assert!(robot.alarm.is_some() && robot.heard.is_none() && robot.arc_length == 0.0, "{robot:?}");
        own.position(&PositionReport { age: 0.3, ..report("north", 2, 2.0, 2.1) }, 10.4).unwrap();
        let events = names(&own.settle(10.4).unwrap());
        assert!(events.contains(&"clear north".into()) && events.contains(&"go east".into()), "{events:?}");
    }
}

/// The first message that it is off its path came once more: the other one was let go to where it was by then.
#[test]
fn a_place_off_the_path_is_as_old_as_it_says() {
    let mut own = crossing(&Disc::new());
    own.report_off_path("north", [-40.0, 0.0], 0.0, 1.0).unwrap();
    assert_eq!(names(&own.settle(1.0).unwrap()), ["alarm north"]);
    own.report_off_path("north", [-1.0, 0.0], 0.1, 1.2).unwrap();
    assert_eq!(names(&own.settle(1.2).unwrap()), ["stop east"]);
    own.report_off_path("north", [-40.0, 0.0], 0.3, 1.3).unwrap();
    assert_eq!(own.settle(1.3).unwrap(), []);
    // Nor is it one that is older than a place on the path.
    own.position(&report("north", 2, 0.0, 0.1), 1.4).unwrap();
    assert_eq!(names(&own.settle(1.4).unwrap())[0], "clear north");
    own.report_off_path("north", [-1.0, 0.0], 0.2, 1.5).unwrap();
    assert!(own.robot("north").unwrap().alarm.is_none());
    // It can have come nearer since it was there.
    own.report_off_path("north", [-3.0, -2.5], 2.0, 4.0).unwrap();
    assert_eq!(names(&own.settle(4.0).unwrap()), ["alarm north", "stop east"]);
    for age in [-1.0, f64::NAN, 1e7] {
        assert!(own.report_off_path("north", [0.0, 0.0], age, 4.0).is_err());
    }
}

/// It was taken for a late message: the other one drove through where it was.
#[test]
fn a_robot_that_goes_back() {
    let disc = Disc::new();
    let mut own = crossing(&disc);
    own.position(&report("east", 2, 2.0, 2.1), 1.0).unwrap();
    own.position(&report("north", 2, 1.9, 2.0), 1.0).unwrap();
    own.settle(1.0).unwrap();
    own.position(&report("east", 2, 3.6, 3.7), 2.0).unwrap();
    let events = names(&own.settle(2.0).unwrap());
    assert!(events.contains(&"hold north".into()), "{events:?}");
    let hold = own.robot("north").unwrap().granted;
    // Within what it may be off, and before it was further on, that is no news.
    own.position(&report("east", 2, 3.5, 3.56), 2.1).unwrap();
    own.position(&PositionReport { age: 0.5, ..report("east", 2, 2.9, 3.0) }, 2.2).unwrap();
    assert_eq!(own.settle(2.2).unwrap(), []);
    own.position(&report("east", 2, 2.9, 3.0), 2.3).unwrap();
    assert_eq!(names(&own.settle(2.3).unwrap()), ["alarm east", "stop north"]);
    let back = Alarm::Back { passed: 3.6, between: [2.9, 3.0] };
    assert_eq!(own.robot("east").unwrap().alarm, Some(back));
    // It is so after a restart, until it has come as far again, and nobody goes on until then.
    let mut own = Supervisor::restored(SupervisorConfig::default(), disc.entries(), Box::new(disc.clone())).unwrap();
    own.settle(0.0).unwrap();
    own.position(&report("north", 2, 2.0, 2.1), 0.1).unwrap();
    own.position(&report("east", 2, 3.2, 3.3), 0.2).unwrap();
    own.settle(0.2).unwrap();
    assert!(own.robot("east").unwrap().alarm.is_some() && own.robot("north").unwrap().stopped.is_some());
    assert!(own.robot("north").unwrap().granted <= hold);
    own.position(&report("east", 2, 3.5, 3.6), 0.3).unwrap();
    let events = names(&own.settle(0.3).unwrap());
    assert!(events.contains(&"clear east".into()) && events.contains(&"go north".into()), "{events:?}");
}

/// One that comes late, from before a robot went back, counted: what it had gone back to was free for others.
#[test]
fn a_late_message_does_not_count_if_a_newer_one_says_that_it_is_not_so_far() {
    let mut own = crossing(&Disc::new());
    own.position(&report("east", 2, 2.0, 2.1), 2.0).unwrap();
    own.position(&PositionReport { age: 1.0, ..report("east", 2, 2.9, 3.0) }, 2.1).unwrap();
    assert_eq!(own.robot("east").unwrap().arc_length, 2.0);
    own.position(&PositionReport { age: 1.0, ..report("east", 2, 2.05, 3.0) }, 2.1).unwrap();
    assert_eq!(own.robot("east").unwrap().arc_length, 2.05);
}

/// It was answered as the first one: whoever sent it took the path that it had sent for the robot's.
#[test]
fn a_name_of_a_mission_stands_for_one_path() {
    let disc = Disc::new();
    let mut own = crossing(&disc);
    let line = |length: f64| vec![PathElement::Line { length }];
    let ends_alike = MissionRequest { path: [line(1.0), line(6.0)].concat(), ..mission("east", "1", 0.0) };
    let replaced = MissionRequest { after: Some(5.0), ..mission("east", "2", 2.0) };
    for _ in 0..2 {
        for other in [mission("east", "1", 1.0), mission("east", "1", 0.0), ends_alike.clone()] {
            assert_eq!(own.mission(&other, 1.0), Err(RequestError::MissionExists), "{other:?}");
        }
        let none = MissionRequest { path: Vec::new(), ..mission("east", "1", 0.0) };
        assert_eq!(own.mission(&none, 1.0), Err(RequestError::MissionExists));
        assert!(matches!(
            own.mission(&mission("east", "1", 6.0), 1.0).unwrap(),
            AdmissionResult::Admitted { path: 2, .. }
        ));
        own.settle(1.0).unwrap();
        own = Supervisor::restored(SupervisorConfig::default(), disc.entries(), Box::new(disc.clone())).unwrap();
    }
    let mut own = crossing(&disc);
    assert!(matches!(own.mission(&replaced, 1.0).unwrap(), AdmissionResult::Admitted { path: 3, .. }));
    assert!(matches!(own.mission(&replaced, 1.0).unwrap(), AdmissionResult::Admitted { path: 3, .. }));
    let elsewhere = MissionRequest { after: Some(5.5), ..replaced };
    assert_eq!(own.mission(&elsewhere, 1.0), Err(RequestError::MissionExists));
    // One that waits.
    own.add("stands", ABILITIES, place(6.0, 0.0, 0.0)).unwrap();
    let waiting = own.mission(&mission("east", "3", 4.0), 1.0).unwrap();
    assert!(matches!(waiting, AdmissionResult::Waiting { .. }), "{waiting:?}");
    assert_eq!(own.mission(&mission("east", "3", 3.0), 1.0), Err(RequestError::MissionExists));
    assert_eq!(own.mission(&mission("east", "3", 4.0), 1.0).unwrap(), waiting);
}

/// A robot that is added again counted its paths from 1 again: a late message of the time before was taken for a place on its new path, which it
/// had not left, and the other one was let through.
#[test]
fn late_messages_of_a_robot_that_was_removed_are_about_another_path() {
    let disc = Disc::new();
    let mut own = crossing(&disc);
    own.position(&report("east", 2, 2.0, 2.0), 1.0).unwrap();
    own.settle(1.0).unwrap();
    for restarted in [false, true] {
        let before = own.robot("east").unwrap().path;
        own.remove("east").unwrap();
        own.settle(2.0).unwrap();
        if restarted {
            let entries = own.snapshot().unwrap();
            own = Supervisor::restored(SupervisorConfig::default(), entries, Box::new(disc.clone())).unwrap();
        }
        own.add("east", ABILITIES, place(-3.0, 0.0, 0.0)).unwrap();
        let path = own.robot("east").unwrap().path;
        assert!(path > before, "{path}");
        own.mission(&mission("east", "again", 6.0), 2.0).unwrap();
        own.settle(2.0).unwrap();
        own.position(&report("east", before, 5.0, 5.0), 3.0).unwrap();
        assert_eq!(own.robot("east").unwrap().arc_length, 0.0);
        // To add the same one twice is no error, but for one that has had a mission.
        own.add("new", ABILITIES, place(50.0, 0.0, 0.0)).unwrap();
        own.add("new", ABILITIES, place(50.0, 0.0, 0.0)).unwrap();
        own.remove("new").unwrap();
    }
}

/// A vehicle off its path was no news where coordinates are those of a map of the earth, and headings grew with each lap.
#[test]
fn far_off_and_many_laps() {
    let mut own = Supervisor::new(SupervisorConfig::default(), Box::new(Disc::new()));
    own.add("east", ABILITIES, place(500_000.0, 5_600_000.0, 0.0)).unwrap();
    own.report_off_path("east", [500_003.0, 5_600_000.0], 0.0, 0.0).unwrap();
    assert_eq!(names(&own.settle(0.0).unwrap()), ["alarm east"]);
    own.position(&report("east", 1, 0.0, 0.0), 1.0).unwrap();
    assert!(own.add("far", ABILITIES, place(3e7, 0.0, 0.0)).is_err());
    for lap in 0..100 {
        let path = vec![PathElement::Arc { radius: 2.0, sweep: 6.0 }];
        let proposal = MissionRequest { path, ..mission("east", &lap.to_string(), 0.0) };
        let now = 2.0 + 20.0 * f64::from(lap);
        own.mission(&proposal, now).unwrap();
        for step in 1..=16 {
            own.settle(now).unwrap();
            let robot = own.robot("east").unwrap();
            let (number, at) = (robot.path, robot.granted);
            own.position(&report("east", number, at, at), now + f64::from(step)).unwrap();
        }
        let robot = own.robot("east").unwrap();
        assert!(robot.arc_length > 11.9 && robot.course.start().heading.abs() < 3.2, "{lap}: {robot:?}");
    }
    assert!(own.mission(&mission("east", "long", 3e7), 9e9).is_err());
}

/// A robot that could not stand where it was seen was gone, also from the journal, and others drove through its place.
#[test]
fn a_robot_that_cannot_be_moved_keeps_its_place() {
    let disc = Disc::new();
    let mut own = crossing(&disc);
    own.position(&report("east", 2, 1.0, 1.0), 1.0).unwrap();
    own.settle(1.0).unwrap();
    // So often past one place that no table has the regions of who stands there.
    let shuttle = PathElement::Turn { sweep: std::f64::consts::PI, lever: None };
    own.add("shuttle", ABILITIES, place(99.0, 99.0, 0.0)).unwrap();
    let path = (0..40_000).flat_map(|_| [PathElement::Line { length: 0.25 }, shuttle]).collect();
    let verdict = own.mission(&MissionRequest { path, ..mission("shuttle", "1", 0.0) }, 1.0).unwrap();
    assert!(matches!(verdict, AdmissionResult::Admitted { .. }), "{verdict:?}");
    own.settle(1.0).unwrap();
    let known = |own: &Supervisor| {
        let robots =
            own.robots().iter().map(|robot| (robot.name.clone(), robot.path, robot.arc_length, robot.notified_limit));
        (robots.collect::<Vec<_>>(), own.orders().decisions().count())
    };
    let before = known(&own);
    let refused = own.reseat("east", place(99.1, 99.0, 0.0)).unwrap_err();
    assert!(refused.to_string().contains("32767 pieces"), "{refused}");
    assert_eq!(known(&own), before);
    own.settle(1.0).unwrap();
    let restored = Supervisor::restored(SupervisorConfig::default(), disc.entries(), Box::new(disc.clone())).unwrap();
    assert!(restored.robot("east").is_ok_and(|robot| robot.path == 2 && robot.course.length() == 6.0));
    // Where it can stand its rights are void, now and after a restart.
    own.reseat("east", place(9.0, 0.0, 0.0)).unwrap();
    own.settle(2.0).unwrap();
    let restored = Supervisor::restored(SupervisorConfig::default(), disc.entries(), Box::new(disc)).unwrap();
    for own in [&own, &restored] {
        let robot = own.robot("east").unwrap();
        assert_eq!(
            (robot.path, robot.course.length(), robot.notified_limit, robot.mission.as_deref()),
            (3, 0.0, 0.0, None)
        );
        assert_eq!(robot.past, ["1"]);
    }
}
