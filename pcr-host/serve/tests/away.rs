//! Robots that are away: nobody waits to hear from them, and what they had is given to nobody before they are removed.

use crate::world::Disc;
use pcr_serve::event::SupervisorEvent;
use pcr_serve::lines::{handle, news};
use pcr_serve::owned_path::{PathElement, StartPose};
use pcr_serve::request_error::RequestError;
use pcr_serve::robot::{Alarm, RobotTraits};
use pcr_serve::supervisor::{AdmissionResult, MissionRequest, PositionReport, Supervisor, SupervisorConfig};
use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::f64::consts::FRAC_PI_2;

pub(crate) const ABILITIES: RobotTraits =
    RobotTraits { radius: 0.25, footprint: None, margin: 0.0, speed: 1.0, acceleration: 0.5 };

pub(crate) fn mission(robot: &str, name: &str, length: f64) -> MissionRequest {
    let path = vec![PathElement::Line { length }];
    let (robot, mission) = (robot.into(), name.into());
    MissionRequest { robot, mission, after: None, expected_path: None, any_heading: false, start: None, path }
}

fn at(robot: &str, path: u64, at: f64) -> PositionReport {
    PositionReport { robot: robot.into(), path, at: [at; 2], age: 0.0 }
}

pub(crate) fn place(x: f64, y: f64, heading: f64) -> StartPose {
    StartPose { x, y, heading }
}

/// One that goes east through the origin, and one that goes north there second.
pub(crate) fn crossing(disc: &Disc) -> Supervisor {
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

pub(crate) fn restarted(disc: &Disc) -> Supervisor {
    Supervisor::restored(SupervisorConfig::default(), disc.entries(), Box::new(disc.clone())).unwrap()
}

fn names(events: &[SupervisorEvent]) -> Vec<String> {
    let kind = |event| serde_json::to_value(event).unwrap()["event"].as_str().unwrap().to_owned();
    events.iter().map(|event| format!("{} {}", kind(event), event.robot().unwrap_or_default())).collect()
}

#[test]
fn one_that_is_away_keeps_what_it_had_until_it_is_removed() {
    let disc = Disc::new();
    let mut own = crossing(&disc);
    let hold = own.robot("east").unwrap().granted;
    assert!(own.set_away("east", true).unwrap(), "it has a place");
    assert_eq!(names(&own.settle(0.1).unwrap()), ["away east"]);
    // Not even what it is near to getting, and no mission.
    own.position(&at("north", 2, 3.0), 2.0).unwrap();
    own.settle(2.0).unwrap();
    assert_eq!(own.robot("east").unwrap().granted, hold);
    assert_eq!(own.mission(&mission("east", "2", 1.0), 2.0), Err(RequestError::Away));
    assert!((own.robot("north").unwrap().granted - 3.5).abs() < 1e-5, "it goes second");
    // A restart between, and nobody is told that it is not heard; who waits for it is told after a minute.
    let mut own = restarted(&disc);
    assert!(own.is_away("east") && own.robot("east").unwrap().notified_limit >= hold);
    let mut told = Vec::new();
    for second in 0..100 {
        own.position(&at("north", 2, 3.49), f64::from(second)).unwrap();
        told.extend(own.settle(f64::from(second)).unwrap());
    }
    assert!(!names(&told).iter().any(|name| name == "silent east" || name == "hold east"), "{told:?}");
    let stands = told.iter().find_map(|event| match event {
        SupervisorEvent::Standstill { robot, why, .. } if robot == "east" => Some(why.clone()),
        _ => None,
    });
    let why = "east is away, and keeps its place until it is removed: north waits for it";
    assert_eq!(stands.as_deref(), Some(why));
    // A person has carried it out.
    assert!(own.remove("east").unwrap());
    assert!(names(&own.settle(101.0).unwrap()).contains(&"hold north".into()));
    assert!(own.robot("north").unwrap().granted > 4.5);
}

#[test]
fn one_that_is_heard_again_is_not_away_and_has_what_it_had() {
    for restarts in [false, true] {
        let disc = Disc::new();
        let mut own = crossing(&disc);
        let hold = own.robot("east").unwrap().granted;
        own.set_away("east", true).unwrap();
        own.settle(0.1).unwrap();
        if restarts {
            own = restarted(&disc);
        }
        // In the route that it was allowed.
        own.position(&at("east", 2, 2.0), 9.0).unwrap();
        let told = names(&own.settle(9.0).unwrap());
        assert_eq!((told[0].as_str(), own.is_away("east")), ("back east", false));
        assert!(own.robot("east").unwrap().granted > hold && own.robot("east").unwrap().alarm.is_none());
        assert!(!restarted(&disc).is_away("east"));
        // Elsewhere: an alarm at once, and the other one stops if it can come there.
        own.set_away("east", true).unwrap();
        own.settle(9.1).unwrap();
        own.position(&at("north", 2, 2.0), 9.2).unwrap();
        own.report_off_path("east", [0.0, -1.2], 0.0, 9.2).unwrap();
        let told = names(&own.settle(9.2).unwrap());
        let of_east: Vec<&String> = told.iter().filter(|name| name.ends_with(" east")).collect();
        assert_eq!(of_east[..2], ["back east", "alarm east"]);
        assert!(told.contains(&"stop north".into()), "{told:?}");
        assert_eq!(own.robot("east").unwrap().alarm, Some(Alarm::Off { x: 0.0, y: -1.2 }));
    }
}

#[test]
fn the_mission_that_waits_is_given_up() {
    let disc = Disc::new();
    let mut own = Supervisor::new(SupervisorConfig::default(), Box::new(disc.clone()));
    own.add("a", ABILITIES, place(0.0, 0.0, 0.0)).unwrap();
    own.add("b", ABILITIES, place(4.0, 0.0, 0.0)).unwrap();
    assert!(matches!(own.mission(&mission("a", "1", 4.0), 0.0), Ok(AdmissionResult::Waiting { .. })));
    own.settle(0.0).unwrap();
    own.set_away("a", true).unwrap();
    assert_eq!(names(&own.settle(0.1).unwrap()), ["dropped a", "away a"]);
    own.remove("b").unwrap();
    own.settle(9.0).unwrap();
    assert_eq!(own.robot("a").unwrap().course.length(), 0.0);
    assert!(restarted(&disc).robot("a").unwrap().waiting.is_none());
}

/// Where a vehicle that was away says that it stands, others may have been let go.
#[test]
fn one_that_comes_back_where_another_may_go_is_an_alarm_and_stops_that_one() {
    for (x, is_in_the_way) in [(-1.0, true), (3.5, false), (20.0, false)] {
        for restarts in [false, true] {
            let disc = Disc::new();
            let mut own = Supervisor::new(SupervisorConfig::default(), Box::new(disc.clone()));
            let expected = BTreeSet::from(["back".to_owned()]);
            own.expect(expected.clone()).unwrap();
            own.add("east", ABILITIES, place(-3.0, 0.0, 0.0)).unwrap();
            own.mission(&mission("east", "1", 8.0), 0.0).unwrap();
            assert!(!own.set_away("back", true).unwrap(), "it is not there");
            own.settle(0.0).unwrap();
            assert!((own.robot("east").unwrap().granted - 3.0).abs() < 1e-6, "it blocks nobody");
            if restarts {
                own = restarted(&disc);
                own.expect(expected).unwrap();
            }
            assert!(own.is_away("back"));
            own.add("back", ABILITIES, place(x, 0.0, 0.0)).unwrap();
            let events = own.settle(0.5).unwrap();
            let told = names(&events);
            assert!(told.contains(&"back back".into()) && !own.is_away("back"), "{told:?}");
            let says = |what: &str| told.iter().any(|name| name == what);
            assert_eq!([says("alarm back"), says("stop east")], [is_in_the_way; 2], "{x} {restarts}: {told:?}");
            // It stands there: it is where it may be now, and the other one must not go on.
            let path = own.robot("back").unwrap().path;
            own.position(&at("back", path, 0.0), 0.6).unwrap();
            let told = names(&own.settle(0.6).unwrap());
            assert_eq!(told.contains(&"clear back".into()), is_in_the_way, "{told:?}");
            assert_eq!(own.robot("east").unwrap().stopped.is_some(), is_in_the_way);
            own.remove("back").unwrap();
            own.settle(0.7).unwrap();
            assert!(own.robot("east").unwrap().stopped.is_none());
        }
    }
}

#[test]
fn who_is_away_is_known_as_long_as_it_is_expected() {
    let disc = Disc::new();
    let mut own = Supervisor::new(SupervisorConfig::default(), Box::new(disc.clone()));
    assert_eq!(own.set_away("a", true), Err(RequestError::NoSuchRobot));
    own.expect(BTreeSet::from(["a".to_owned(), "b".to_owned()])).unwrap();
    own.add("b", ABILITIES, place(0.0, 0.0, 0.0)).unwrap();
    for name in ["a", "b"] {
        own.set_away(name, true).unwrap();
    }
    own.remove("b").unwrap();
    own.settle(0.0).unwrap();
    let mut own = restarted(&disc);
    assert_eq!(own.away().iter().collect::<Vec<_>>(), ["a", "b"], "removed, and still away");
    // A journal that is begun anew has it, too.
    let again = Supervisor::restored(SupervisorConfig::default(), own.snapshot().unwrap(), Box::new(disc.clone()));
    assert_eq!(again.unwrap().away(), own.away());
    own.expect(BTreeSet::from(["a".to_owned()])).unwrap();
    own.settle(0.1).unwrap();
    assert_eq!(restarted(&disc).away().iter().collect::<Vec<_>>(), ["a"]);
}

#[test]
fn lines_say_that_a_robot_is_away() {
    let document =
        std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/reference/schema/pcr-serve.schema.json");
    let schema: Value = serde_json::from_str(&std::fs::read_to_string(document).unwrap()).unwrap();
    let schema = jsonschema::validator_for(&schema).unwrap();
    let mut own = Supervisor::new(SupervisorConfig::default(), Box::new(Disc::new()));
    let mut events = Vec::new();
    let mut ask = |request: Value| {
        assert!(schema.is_valid(&request), "{request}");
        let answer = handle(&mut own, request.to_string().as_bytes(), 0.0, 0.0).answer;
        events.extend(own.settle(0.0).unwrap());
        assert!(schema.is_valid(&answer), "{answer}");
        answer.get("ok").or(answer.get("error")).unwrap().clone()
    };
    let abilities = json!({ "radius": 0.25, "speed": 1, "acceleration": 0.5 });
    ask(json!({ "verb": "add", "robot": "a", "start": { "x": 0, "y": 0, "heading": 0 }, "abilities": abilities }));
    assert_eq!(ask(json!({ "verb": "away", "robot": "b" }))["code"], "no_such_robot");
    assert_eq!(ask(json!({ "verb": "away", "robot": "a" })), json!({ "away": true, "keeps_place": true }));
    let found = ask(json!({ "verb": "query", "what": "robots" }));
    assert_eq!((&found["robots"][0]["away"], &found["away"]), (&json!(true), &json!(["a"])));
    assert_eq!(ask(json!({ "verb": "mission", "robot": "a", "mission": "1", "path": [] }))["code"], "away");
    assert_eq!(ask(json!({ "verb": "away", "robot": "a", "away": false }))["away"], json!(false));
    assert_eq!(ask(json!({ "verb": "query", "what": "robots" }))["away"], json!([]));
    assert_eq!(names(&events), ["away a", "back a"]);
    for event in &events {
        assert!(schema.is_valid(&news(event)), "{event:?}");
    }
}
