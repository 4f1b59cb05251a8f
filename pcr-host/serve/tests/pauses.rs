//! The whole fleet is paused: everybody stops, nobody is granted anything, and whoever looks sees why.

use crate::away::{self, ABILITIES, mission, place, restarted};
use crate::lines::{document, fits};
use crate::world::Disc;
use pcr_serve::closed_area::ClosedArea;
use pcr_serve::event::SupervisorEvent;
use pcr_serve::http::{self, HttpContent};
use pcr_serve::journal_writer::WriteProgress;
use pcr_serve::lines::{handle, news};
use pcr_serve::log::{LogLevel, LogWriter};
use pcr_serve::request_error::RequestError;
use pcr_serve::server::{ServerInput, queue, serve};
use pcr_serve::supervisor::{AdmissionResult, PositionReport, Supervisor, SupervisorConfig};
use serde_json::{Value, json};

/// One that goes east through the origin, one that goes north there second, and one that stands far away.
fn crossing(disc: &Disc) -> Supervisor {
    let mut own = away::crossing(disc);
    own.add("far", ABILITIES, place(50.0, 50.0, 0.0)).unwrap();
    own.settle(0.0).unwrap();
    own
}

fn is_at(own: &mut Supervisor, robot: &str, at: f64, now: f64) -> Vec<String> {
    let path = own.robot(robot).unwrap().path;
    own.position(&PositionReport { robot: robot.into(), path, at: [at; 2], age: 0.0 }, now).unwrap();
    names(&own.settle(now).unwrap())
}

fn names(events: &[SupervisorEvent]) -> Vec<String> {
    let name = |event: &SupervisorEvent| {
        let kind = serde_json::to_value(event).unwrap()["event"].as_str().unwrap().to_owned();
        format!("{kind} {}", event.robot().unwrap_or_default()).trim_end().to_owned()
    };
    events.iter().map(name).collect()
}

fn holds(own: &Supervisor) -> Vec<f64> {
    own.robots().iter().map(|robot| robot.granted).collect()
}

#[test]
fn everybody_stops_and_nobody_is_granted_anything_until_it_is_resumed() {
    let disc = Disc::new();
    let mut own = crossing(&disc);
    let told = holds(&own);
    assert!(own.pause().unwrap() == Default::default() && own.is_paused());
    // One that stands stops, too: it must not set off.
    assert_eq!(names(&own.settle(0.1).unwrap()), ["paused", "stop east", "stop north", "stop far"]);
    assert!(own.robots().iter().all(|robot| robot.stopped.as_deref() == Some("pause")));
    // On the way to a stand they are still heard; nobody gets what would be due now.
    for (robot, at) in [("east", 2.9), ("north", 2.0)] {
        assert!(is_at(&mut own, robot, at, 1.0).is_empty());
    }
    assert_eq!(holds(&own), told);
    let waits = own.mission(&mission("far", "1", 5.0), 1.0).unwrap();
    let why = || "the fleet is paused".to_owned();
    assert_eq!(waits, AdmissionResult::Waiting { by: None, why: why() });
    // Who joins is paused, too.
    own.add("new", ABILITIES, place(80.0, 0.0, 0.0)).unwrap();
    assert_eq!(names(&own.settle(1.1).unwrap()), ["stop new"]);
    // Again, nothing changes.
    own.pause().unwrap();
    assert_eq!(names(&own.settle(1.2).unwrap()), [""; 0]);
    // After a restart, from the entries and from the whole state.
    drop(own);
    let mut own = restarted(&disc);
    for _ in 0..2 {
        let entries = own.snapshot().unwrap();
        own = Supervisor::restored(SupervisorConfig::default(), entries, Box::new(disc.clone())).unwrap();
        let events = own.settle(0.0).unwrap();
        assert_eq!(events[0], SupervisorEvent::Paused { why: why() });
        let stops = ["waiting far", "stop east", "stop north", "stop far", "stop new"];
        assert_eq!(names(&events[1..]), stops, "its mission waits still");
    }
    assert!(is_at(&mut own, "east", 3.0, 2.0).is_empty());
    assert!(own.resume().unwrap() && !own.resume().unwrap() && !own.is_paused());
    let events = names(&own.settle(3.0).unwrap());
    let goes = ["go east", "go north", "go far", "go new", "hold east", "admitted far", "hold far"];
    assert!(
        goes.iter().all(|event| events.iter().any(|told| told == event)) && events.iter().any(|told| told == "resumed"),
        "{events:?}"
    );
    drop(own);
    assert!(!restarted(&disc).is_paused());
}

#[test]
fn a_pause_is_no_standstill() {
    let mut own = crossing(&Disc::new());
    is_at(&mut own, "east", 1.0, 1.0);
    own.pause().unwrap();
    let is_told = |own: &mut Supervisor, times: std::ops::Range<u32>| -> bool {
        let mut events = Vec::new();
        for now in times {
            events.extend(is_at(own, "east", 1.0, f64::from(now)));
            events.extend(is_at(own, "north", 0.0, f64::from(now)));
        }
        events.iter().any(|event| event.starts_with("standstill"))
    };
    assert!(!is_told(&mut own, 2..200));
    own.resume().unwrap();
    assert!(!is_told(&mut own, 200..258), "it begins to count when they may go");
    assert!(is_told(&mut own, 258..270));
}

/// The reason that outlives the pause is the one that is shown.
#[test]
fn who_is_stopped_for_another_reason_stands_after_the_pause_too() {
    let mut own = crossing(&Disc::new());
    own.pause().unwrap();
    own.settle(0.1).unwrap();
    let area = ClosedArea {
        name: "gate".into(),
        start: place(-1.0, 0.0, 0.0),
        path: Vec::new(),
        more: Vec::new(),
        radius: 0.2,
        of: None,
        speed: None,
    };
    assert_eq!(own.close(area).unwrap().stopped, ["east"]);
    // It stands already.
    assert!(own.settle(0.2).unwrap().is_empty());
    assert_eq!(own.robot("east").unwrap().stopped.as_deref(), Some("gate"));
    own.resume().unwrap();
    let events = names(&own.settle(0.3).unwrap());
    assert!(events.contains(&"go north".into()) && !events.contains(&"go east".into()), "{events:?}");
    own.open("gate").unwrap();
    assert!(names(&own.settle(0.4).unwrap()).contains(&"go east".into()));
}

#[test]
fn who_is_away_is_told_nothing_and_stops_when_he_is_back() {
    let mut own = crossing(&Disc::new());
    own.set_away("east", true).unwrap();
    own.settle(0.1).unwrap();
    own.pause().unwrap();
    assert_eq!(names(&own.settle(0.2).unwrap()), ["paused", "stop north", "stop far"]);
    own.set_away("east", false).unwrap();
    assert_eq!(names(&own.settle(0.3).unwrap()), ["back east", "stop east"]);
}

#[test]
fn nobody_else_has_its_name() {
    let mut own = crossing(&Disc::new());
    assert!(matches!(own.add("pause", ABILITIES, place(9.0, 9.0, 0.0)), Err(RequestError::Invalid { .. })));
    let (start, path, more) = (place(9.0, 9.0, 0.0), Vec::new(), Vec::new());
    let area = ClosedArea { name: "pause".into(), start, path, more, radius: 0.2, of: None, speed: None };
    assert!(matches!(own.close(area), Err(RequestError::Invalid { .. })));
}

/// On the lines, on the page, in the metrics and at `/readyz` it is said in the same words.
#[test]
fn whoever_looks_sees_that_it_is_paused() {
    let schema: Value = serde_json::from_str(&document("reference/schema/pcr-serve.schema.json")).unwrap();
    let mut own = crossing(&Disc::new());
    let mut says = |line: Value| {
        fits(&schema, &line);
        let answer = handle(&mut own, line.to_string().as_bytes(), 0.0, 0.0).answer;
        fits(&schema, &answer);
        own.settle(0.0).unwrap().iter().for_each(|event| fits(&schema, &news(event)));
        answer["ok"].clone()
    };
    assert_eq!(says(json!({ "verb": "query", "what": "robots" }))["paused"], Value::Null);
    assert_eq!(says(json!({ "verb": "pause" })), json!({ "unable": [], "unknown": [] }));
    assert_eq!(says(json!({ "verb": "query", "what": "robots" }))["paused"], "the fleet is paused");
    assert_eq!(says(json!({ "verb": "query", "what": "holds" }))["holds"][0]["stopped_for"], "pause");
    assert_eq!(says(json!({ "verb": "resume" })), json!({ "resumed": true }));
    assert_eq!(says(json!({ "verb": "resume" })), json!({ "resumed": false }));
    says(json!({ "verb": "pause" }));
    let (handle, inputs) = queue();
    let server = std::thread::spawn(move || {
        serve(&mut own, &inputs, &WriteProgress::default(), LogWriter::new(LogLevel::Error)).unwrap();
    });
    let site =
        HttpContent { page: String::new(), draw: None, hosts: vec!["here".into()], addresses: false, unready: None };
    let get =
        |path: &str| http::answer(&handle, &site, format!("GET {path} HTTP/1.1\r\nHost: here\r\n\r\n").as_bytes());
    let (status, _, text) = get("/readyz");
    assert_eq!((status, text.as_str()), ("503 Service Unavailable", "the fleet is paused\n"));
    assert_eq!(get("/healthz").0, "200 OK");
    let state: Value = serde_json::from_str(&get("/state").2).unwrap();
    assert_eq!(
        (&state["paused"], &state["robots"][0]["stopped_for"]),
        (&"the fleet is paused".into(), &"pause".into())
    );
    let metrics = get("/metrics").2;
    assert!(metrics.contains("\npcr_fleet_paused 1\n") && metrics.contains("\npcr_robots_stopped 3\n"), "{metrics}");
    handle.ask(|supervisor, _, _| supervisor.resume().unwrap()).unwrap();
    assert_eq!(get("/readyz").0, "200 OK");
    assert!(get("/metrics").2.contains("\npcr_fleet_paused 0\n"));
    handle.send(ServerInput::Stop);
    server.join().unwrap();
}
