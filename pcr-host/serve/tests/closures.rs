//! Closed areas: nobody gets authority into them, whoever has it is stopped where it still can, and whoever is inside drives on.

use crate::lines::{document, fits};
use crate::world::Disc;
use pcr_formats::splitmix64::SplitMix64;
use pcr_serve::closed_area::ClosedArea;
use pcr_serve::event::SupervisorEvent;
use pcr_serve::lines::handle;
use pcr_serve::owned_path::{PathElement, StartPose};
use pcr_serve::request_error::RequestError;
use pcr_serve::robot::RobotTraits;
use pcr_serve::supervisor::{AdmissionResult, MissionRequest, PositionReport, Supervisor, SupervisorConfig};
use serde_json::{Value, json};

const ABILITIES: RobotTraits =
    RobotTraits { radius: 0.25, footprint: None, margin: 0.0, speed: 1.0, acceleration: 0.5 };

fn straight(mission: &str, length: f64) -> MissionRequest {
    let path = vec![PathElement::Line { length }];
    let (robot, mission) = ("east".into(), mission.into());
    MissionRequest { robot, mission, after: None, expected_path: None, any_heading: false, start: None, path }
}

/// One that stands at x = -5 m and faces east.
fn one(disc: &Disc) -> Supervisor {
    let mut own = Supervisor::new(SupervisorConfig::default(), Box::new(disc.clone()));
    own.add("east", ABILITIES, StartPose { x: -5.0, y: 0.0, heading: 0.0 }).unwrap();
    own
}

/// A lane across the way of that robot.
fn area(x: f64, radius: f64) -> ClosedArea {
    let start = StartPose { x, y: -2.0, heading: std::f64::consts::FRAC_PI_2 };
    let path = vec![PathElement::Line { length: 4.0 }];
    ClosedArea { name: "aisle 3".into(), start, path, more: Vec::new(), radius, of: None, speed: None }
}

fn names(events: &[SupervisorEvent]) -> Vec<String> {
    let kind = |event| serde_json::to_value(event).unwrap()["event"].as_str().unwrap().to_owned();
    events.iter().map(kind).collect()
}

fn is_at(own: &mut Supervisor, at: f64, now: f64) -> Vec<SupervisorEvent> {
    let report = PositionReport { robot: "east".into(), path: own.robot("east").unwrap().path, at: [at; 2], age: 0.0 };
    own.position(&report, now).unwrap();
    own.settle(now).unwrap()
}

/// Goes where it may go, as far as it may go.
fn goes(own: &mut Supervisor, from: f64) -> f64 {
    let mut now = from;
    loop {
        let robot = own.robot("east").unwrap();
        let (at, hold) = (robot.arc_length, robot.granted);
        if hold - at < 1e-3 || robot.stopped.is_some() {
            return at;
        }
        now += 1.0;
        is_at(own, hold, now);
    }
}

#[test]
fn nobody_gets_authority_into_a_closed_area_until_it_is_opened() {
    let disc = Disc::new();
    let mut own = one(&disc);
    own.mission(&straight("1", 10.0), 0.0).unwrap();
    let impact = own.close(area(0.0, 0.5)).unwrap();
    assert_eq!((impact.before, impact.stopped.len(), impact.through.len()), (vec!["east".to_owned()], 0, 0));
    own.settle(0.0).unwrap();
    // The lane begins at x = -0.5 m, for a robot of 0.25 m.
    let at = goes(&mut own, 0.0);
    assert!((4.25 - 0.01..=4.25).contains(&at), "{at}");
    let told = handle(&mut own, br#"{"verb": "query", "what": "robots"}"#, 20.0, 20.0).answer;
    assert_eq!(told["ok"]["robots"][0]["closure"], "aisle 3");
    // After a minute it is said why it stands.
    let events: Vec<SupervisorEvent> = (20..90).flat_map(|now| is_at(&mut own, at, f64::from(now))).collect();
    let why = "east waits before aisle 3, which is closed";
    assert!(
        events.iter().any(|event| matches!(event, SupervisorEvent::Standstill { why: told, .. } if told == why)),
        "{events:?}"
    );
    // A restart keeps it closed.
    drop(own);
    let mut own = Supervisor::restored(SupervisorConfig::default(), disc.entries(), Box::new(disc.clone())).unwrap();
    own.settle(121.0).unwrap();
    assert_eq!(own.closures().map(|area| area.name.as_str()).collect::<Vec<_>>(), ["aisle 3"]);
    assert!(goes(&mut own, 130.0) <= 4.25);
    assert!(own.open("aisle 3").unwrap() && !own.open("aisle 3").unwrap());
    own.settle(150.0).unwrap();
    assert!(goes(&mut own, 150.0) > 9.99);
    drop(own);
    let own = Supervisor::restored(SupervisorConfig::default(), disc.entries(), Box::new(disc)).unwrap();
    assert_eq!(own.closures().count(), 0);
}

#[test]
fn whoever_holds_authority_into_it_is_stopped_and_drives_on_once_it_is_inside() {
    let [stands, enters] = [3.9, 4.6];
    for at in [stands, enters] {
        let mut own = one(&Disc::new());
        own.mission(&straight("1", 10.0), 0.0).unwrap();
        own.settle(0.0).unwrap();
        is_at(&mut own, 3.0, 3.0);
        let hold = own.robot("east").unwrap().granted;
        assert!(hold > 4.5, "{hold}");
        assert_eq!(own.close(area(0.0, 0.5)).unwrap().stopped, ["east"]);
        assert_eq!(names(&own.settle(3.1).unwrap()), ["stop"]);
        assert_eq!(own.robot("east").unwrap().stopped.as_deref(), Some("aisle 3"));
        // It keeps what it has, and gets no more.
        assert_eq!(own.robot("east").unwrap().granted, hold);
        let events = names(&is_at(&mut own, at, 4.0));
        if at == stands {
            assert_eq!((events.len(), own.robot("east").unwrap().granted), (0, hold));
            own.open("aisle 3").unwrap();
            let events = names(&own.settle(5.0).unwrap());
            assert!(events.contains(&"go".to_owned()), "{events:?}");
        } else {
            assert!(events.contains(&"go".to_owned()), "{events:?}");
            let again = own.close(area(0.0, 0.5)).unwrap();
            assert_eq!((again.through, again.stopped.len()), (vec!["east".to_owned()], 0));
        }
        assert!(goes(&mut own, 10.0) > 9.99, "{at}");
    }
}

#[test]
fn a_mission_through_a_closed_area_waits_until_it_is_open() {
    let mut own = one(&Disc::new());
    own.close(area(0.0, 0.5)).unwrap();
    let verdict = own.mission(&straight("1", 10.0), 0.0).unwrap();
    assert_eq!(verdict, AdmissionResult::Waiting { by: None, why: "aisle 3 is closed".into() });
    // One that ends before it is admitted.
    let verdict = own.mission(&straight("2", 4.0), 0.0).unwrap();
    assert!(matches!(verdict, AdmissionResult::Admitted { .. }), "{verdict:?}");
    own.settle(0.0).unwrap();
    let verdict = own.mission(&straight("3", 6.0), 1.0).unwrap();
    assert!(matches!(verdict, AdmissionResult::Waiting { by: None, .. }), "{verdict:?}");
    for tick in 0..40 {
        own.settle(1.0 + 0.1 * f64::from(tick)).unwrap();
    }
    assert_eq!(own.robot("east").unwrap().mission.as_deref(), Some("2"));
    own.open("aisle 3").unwrap();
    own.settle(5.01).unwrap();
    assert_eq!(own.robot("east").unwrap().mission.as_deref(), Some("3"));
}

/// Wherever and whenever an area is closed: the authority of who is not in it does not grow into it.
#[test]
fn authority_does_not_grow_into_areas_at_random() {
    let (mut stopped, mut through) = (0, 0);
    for seed in 0..200 {
        let mut dice = SplitMix64(seed);
        let mut own = one(&Disc::new());
        own.mission(&straight("1", 10.0), 0.0).unwrap();
        own.settle(0.0).unwrap();
        let (x, radius, from) = (-4.0 + 8.0 * dice.unit(), 0.1 + dice.unit(), 20.0 * dice.unit());
        // The robot touches the lane from here on.
        let lo = x + 5.0 - radius - 0.25;
        let (mut at, mut before) = (0.0, None);
        for tick in 1..60 {
            let now = 0.5 * f64::from(tick);
            if before.is_none() && now >= from {
                let impact = own.close(area(x, radius)).unwrap();
                (stopped, through) = (stopped + impact.stopped.len(), through + impact.through.len());
                before = Some((own.robot("east").unwrap().granted, at));
                own.settle(now).unwrap();
            }
            let robot = own.robot("east").unwrap();
            if robot.stopped.is_none() {
                at += (0.4 * dice.unit()).min(robot.granted - at).max(0.0);
            }
            is_at(&mut own, at, now);
            let granted = own.robot("east").unwrap().granted;
            if let Some((held, _)) = before.filter(|_| at < lo - 1e-3) {
                assert!(granted <= f64::max(held, lo), "{seed}: {granted} at {at}, from {lo} m on it is closed");
            }
        }
        let was_inside = before.is_some_and(|(_, at)| at > lo + 1e-3);
        if was_inside {
            assert!(at > 9.0, "{seed}: {at}, although it was inside");
        } else if before.is_some() {
            assert!(at <= lo, "{seed}: {at}");
        }
    }
    assert!(stopped > 5 && through > 5, "{stopped}, {through}");
}

#[test]
fn the_verbs_fit_the_schema_and_what_is_wrong_is_refused() {
    let schema: Value = serde_json::from_str(&document("reference/schema/pcr-serve.schema.json")).unwrap();
    let mut own = one(&Disc::new());
    let mut ask = |request: Value, is_right: bool| {
        if is_right {
            fits(&schema, &request);
        }
        let answer = handle(&mut own, request.to_string().as_bytes(), 0.0, 0.0).answer;
        fits(&schema, &answer);
        answer
    };
    let start = json!({ "x": 1, "y": 0, "heading_deg": 90 });
    let close = json!({ "verb": "close", "closure": "bay", "start": start, "radius": 0.3 });
    let answer = ask(close.clone(), true);
    assert_eq!(answer["ok"], json!({ "through": [], "stopped": [], "before": [] }));
    assert_eq!(ask(close.clone(), true), answer, "repeated");
    let told = ask(json!({ "verb": "query", "what": "closures" }), true);
    let [found] = &told["ok"]["closures"].as_array().unwrap()[..] else { panic!("{told}") };
    assert_eq!((&found["closure"], &found["radius"]), (&json!("bay"), &json!(0.3)));
    let with = |key: &str, value: Value| {
        let mut other = close.clone();
        other[key] = value;
        other
    };
    for (key, value, why) in [
        ("radius", json!(0), "radius: above 0"),
        ("radius", json!(0.4), "closure: another area of this name is closed"),
        ("closure", json!("east"), "closure: a robot has this name"),
        ("closure", json!(""), "closure: the name of an area"),
    ] {
        let answer = ask(with(key, value), false);
        assert!(answer["error"]["message"].as_str().unwrap().starts_with(why), "{answer}");
    }
    assert_eq!(ask(json!({ "verb": "open", "closure": "bay" }), true)["ok"]["opened"], true);
    assert_eq!(ask(json!({ "verb": "open", "closure": "bay" }), true)["ok"]["opened"], false);
    own.close(area(0.0, 0.5)).unwrap();
    let pose = StartPose { x: 9.0, y: 0.0, heading: 0.0 };
    assert!(matches!(own.add("aisle 3", ABILITIES, pose), Err(RequestError::Invalid { .. })));
}

/// A lane across its path, in which it may drive at 0.2 m/s.
fn slow(x: f64) -> ClosedArea {
    ClosedArea { speed: Some(0.2), ..area(x, 0.5) }
}

/// The limits of the last event about them, as lengths and speeds.
fn limits(events: &[SupervisorEvent]) -> Option<Vec<([f64; 2], f64)>> {
    let last = events.iter().rev().find_map(|event| match event {
        SupervisorEvent::Limits { limits, .. } => Some(limits),
        _ => None,
    })?;
    Some(last.iter().map(|limit| (limit.length, limit.speed)).collect())
}

#[test]
fn robots_are_told_where_their_speed_is_limited_before_they_may_go_there() {
    let disc = Disc::new();
    let mut own = one(&disc);
    own.close(slow(0.0)).unwrap();
    // It is admitted, and told where before its first authority.
    let verdict = own.mission(&straight("1", 10.0), 0.0).unwrap();
    assert!(matches!(verdict, AdmissionResult::Admitted { .. }), "{verdict:?}");
    let events = own.settle(0.0).unwrap();
    assert_eq!(names(&events), ["admitted", "limits", "hold"]);
    let told = limits(&events).unwrap();
    let [([lo, hi], speed)] = told[..] else { panic!("{told:?}") };
    assert!((lo - 4.25).abs() < 1e-3 && (hi - 5.75).abs() < 1e-3 && speed == 0.2, "{told:?}");
    let answer = handle(&mut own, br#"{"verb": "query", "what": "robots"}"#, 0.0, 0.0).answer;
    fits(&serde_json::from_str(&document("reference/schema/pcr-serve.schema.json")).unwrap(), &answer);
    assert_eq!(answer["ok"]["robots"][0]["limits"][0]["closure"], "aisle 3");
    // Nothing is told again, and it gets through.
    assert!(!names(&is_at(&mut own, 1.0, 1.0)).contains(&"limits".to_owned()));
    // After a restart it is told again, because it may not have been told.
    drop(own);
    let mut own = Supervisor::restored(SupervisorConfig::default(), disc.entries(), Box::new(disc.clone())).unwrap();
    assert_eq!(limits(&own.settle(2.0).unwrap()), Some(told));
    assert!(goes(&mut own, 3.0) > 9.99);
    // One that is in it is told as well, and when the limit ends.
    let mut own = one(&Disc::new());
    own.mission(&straight("1", 10.0), 0.0).unwrap();
    own.settle(0.0).unwrap();
    is_at(&mut own, 3.0, 3.0);
    let impact = own.close(slow(-2.0)).unwrap();
    assert_eq!((impact.through, impact.stopped.len()), (vec!["east".to_owned()], 0));
    let events = own.settle(3.1).unwrap();
    assert!(
        limits(&events).is_some_and(|all| all.len() == 1) && !names(&events).contains(&"stop".to_owned()),
        "{events:?}"
    );
    own.open("aisle 3").unwrap();
    assert_eq!(limits(&own.settle(3.2).unwrap()), Some(Vec::new()));
}

#[test]
fn areas_are_closed_by_the_ids_of_the_layout() {
    let schema: Value = serde_json::from_str(&document("reference/schema/pcr-serve.schema.json")).unwrap();
    let disc = Disc::new();
    let mut own = one(&disc);
    let ask = |own: &mut Supervisor, request: Value| {
        fits(&schema, &request);
        let answer = handle(own, request.to_string().as_bytes(), 0.0, 0.0).answer;
        fits(&schema, &answer);
        answer
    };
    let edge = json!({ "verb": "close", "closure": "A", "edge": "e1", "radius": 0.3 });
    let why = ask(&mut own, edge.clone())["error"]["message"].clone();
    assert_eq!(why, "edge: the layout that was sent has no edge e1");
    let lane = |x: f64, edge: Value, zones: Value| json!({ "start": { "x": x, "y": -2, "heading_deg": 90 }, "path": [{ "kind": "line", "length": 4 }], "edge": edge, "zones": zones });
    let lanes =
        [lane(0.0, json!("e1"), json!([])), lane(2.0, json!(7), json!(["bay"])), lane(3.0, json!(8), json!(["bay"]))];
    let nodes = json!([{ "node": 4, "x": -1.0, "y": 0.0, "zones": ["bay"] }, { "node": "n5", "x": 1.0, "y": 0.0 }]);
    assert!(
        ask(&mut own, json!({ "verb": "layout", "name": "hall", "lanes": lanes, "nodes": nodes }))["ok"].is_object()
    );
    own.mission(&straight("1", 10.0), 0.0).unwrap();
    own.settle(0.0).unwrap();
    let stops_before = |own: &mut Supervisor, request: Value, at: f64| {
        let answer = ask(own, request.clone());
        assert_eq!(answer["ok"]["before"], json!(["east"]), "{answer}");
        assert_eq!(ask(own, request), answer, "repeated");
        let mut other = one(&Disc::new());
        other.close(own.closures().next().unwrap().clone()).unwrap();
        let verdict = other.mission(&straight("1", at - 0.01), 0.0).unwrap();
        assert!(matches!(verdict, AdmissionResult::Admitted { .. }), "{verdict:?}");
        let verdict = other.mission(&straight("2", 0.5), 0.0).unwrap();
        assert!(matches!(verdict, AdmissionResult::Waiting { .. }), "{verdict:?}");
        own.open("A").unwrap();
    };
    // The robot has a radius of 0.25 m and begins at x = -5 m.
    stops_before(&mut own, edge, 5.0 - 0.55);
    stops_before(&mut own, json!({ "verb": "close", "closure": "A", "edge": "7", "radius": 0.3 }), 7.0 - 0.55);
    stops_before(&mut own, json!({ "verb": "close", "closure": "A", "node": "n5", "radius": 0.3 }), 6.0 - 0.55);
    let zone = json!({ "verb": "close", "closure": "A", "zone": "bay", "radius": 0.3 });
    stops_before(&mut own, zone.clone(), 4.0 - 0.55);
    // A restart keeps it, whatever the layout is by then.
    ask(&mut own, zone);
    own.settle(1.0).unwrap();
    let before = own.closures().next().unwrap().clone();
    assert_eq!((before.more.len(), json!(before.of)), (2, json!({ "zone": "bay" })));
    drop(own);
    let mut own = Supervisor::restored(SupervisorConfig::default(), disc.entries(), Box::new(disc)).unwrap();
    assert_eq!(own.closures().next(), Some(&before));
    let told = ask(&mut own, json!({ "verb": "query", "what": "closures" }));
    assert_eq!(told["ok"]["closures"][0]["of"]["zone"], "bay");
    let both = json!({ "verb": "close", "closure": "B", "edge": "e1", "node": 4, "radius": 0.3 });
    let answer = handle(&mut own, both.to_string().as_bytes(), 0.0, 0.0).answer;
    assert!(answer["error"]["message"].as_str().unwrap().starts_with("a closure is of one place"), "{answer}");
}

/// Each hold was a write of its own as long as any area was closed. The journal has a hold before it is told, and none beyond the area.
#[test]
fn the_journal_is_not_written_for_each_hold_while_an_area_is_closed() {
    let writes = |closed: &[ClosedArea]| {
        let disc = Disc::new();
        let mut own = one(&disc);
        own.mission(&straight("1", 200.0), 0.0).unwrap();
        own.settle(0.0).unwrap();
        for area in closed {
            own.close(area.clone()).unwrap();
        }
        own.settle(0.0).unwrap();
        let (begin, holds) = (own.counts().writes, own.counts().holds);
        for step in 1..=300_u32 {
            let hold = own.robot("east").unwrap().granted;
            is_at(&mut own, (0.25 * f64::from(step)).min(hold), f64::from(step));
            let robot = own.robot("east").unwrap();
            // What a restart would count as told.
            let state =
                Supervisor::restored(SupervisorConfig::default(), disc.entries(), Box::new(Disc::new())).unwrap();
            let kept = state.robot("east").unwrap().notified_limit;
            assert!(kept >= robot.granted, "{kept} {}", robot.granted);
            assert!(closed.is_empty() || kept <= 104.26, "{kept}");
        }
        (own.counts().writes - begin, own.counts().holds - holds)
    };
    let (open, closed) = (writes(&[]), writes(&[area(100.0, 0.5)]));
    assert!(open.1 > 100 && open.0 < open.1 / 3, "{open:?}");
    assert!(closed.0 <= open.0 + 3, "{closed:?} {open:?}");
}
