//! Robots with outlines: what is granted is what their outlines need.

use super::*;
use crate::journal_entry::NullStore;
use crate::lines;
use crate::owned_path::PathElement;
use crate::robot::Alarm;
use pcr_formats::footprint::Footprint;
use serde_json::{Value, json};
use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::{Arc, Mutex};

/// A rectangle with these distances from its reference point to its sides: ahead, behind and to either side \[m\].
fn rectangle([ahead, behind, side]: [f64; 3]) -> RobotTraits {
    let footprint = Footprint::new(vec![[-behind, -side], [ahead, -side], [ahead, side], [-behind, side]]).unwrap();
    RobotTraits {
        radius: footprint.circumscribed_radius(),
        footprint: Some(footprint),
        margin: 0.0,
        speed: 1.0,
        acceleration: 0.5,
    }
}

/// A pallet truck, 1.2 m long and 0.8 m wide.
const TRUCK: [f64; 3] = [0.6, 0.6, 0.4];

fn line(length: f64) -> PathElement {
    PathElement::Line { length }
}

fn request(robot: &str, path: Vec<PathElement>) -> MissionRequest {
    let (robot, mission) = (robot.into(), format!("{}", path.len()));
    MissionRequest { robot, mission, after: None, expected_path: None, start: None, path, any_heading: false }
}

fn supervisor() -> Supervisor {
    Supervisor::new(SupervisorConfig { lookahead: 30.0, ..SupervisorConfig::default() }, Box::new(NullStore))
}

/// The authorities of two robots that are to pass each other on lanes at this distance, at once.
fn passing(own: &mut Supervisor, traits: &RobotTraits, apart: f64) -> [f64; 2] {
    own.add("east", traits.clone(), StartPose { x: 0.0, y: 0.0, heading: 0.0 }).unwrap();
    own.add("west", traits.clone(), StartPose { x: 10.0, y: apart, heading: PI }).unwrap();
    for robot in ["east", "west"] {
        own.mission(&request(robot, vec![line(10.0)]), 0.0).unwrap();
    }
    own.settle(0.0).unwrap();
    ["east", "west"].map(|robot| own.robot(robot).unwrap().granted)
}

#[test]
fn trucks_in_opposite_lanes_pass_each_other() {
    for apart in [0.9, 0.801] {
        assert_eq!(passing(&mut supervisor(), &rectangle(TRUCK), apart), [10.0; 2], "{apart}");
    }
    // Neither comes out of the other's way: the second one's mission waits.
    let mut own = supervisor();
    let [east, west] = passing(&mut own, &rectangle(TRUCK), 0.799);
    assert!(east.min(west) == 0.0 && own.robot("west").unwrap().waiting.is_some(), "{east} {west}");
    // As discs around them they do not pass even in lanes that are 1.44 m apart.
    let disc = RobotTraits { footprint: None, ..rectangle(TRUCK) };
    let [_, west] = passing(&mut supervisor(), &disc, 1.44);
    assert_eq!(west, 0.0);
    // Margins are kept free on both sides.
    let wide = |margin| RobotTraits { margin, ..rectangle(TRUCK) };
    assert_eq!(passing(&mut supervisor(), &wide(0.049), 0.9), [10.0; 2]);
    assert_eq!(passing(&mut supervisor(), &wide(0.051), 0.9)[1], 0.0);
}

/// The truck may turn to where a corner would reach into the lane, and no further; when the other one has passed it turns to the end.
#[test]
fn a_truck_turns_beside_a_passing_one() {
    for (apart, beside) in [(1.13, true), (1.11, false)] {
        let mut own = supervisor();
        own.add("turns", rectangle(TRUCK), StartPose { x: 0.0, y: 0.0, heading: 0.0 }).unwrap();
        own.add("passes", rectangle(TRUCK), StartPose { x: -8.0, y: apart, heading: 0.0 }).unwrap();
        own.mission(&request("passes", vec![line(16.0)]), 0.0).unwrap();
        own.settle(0.0).unwrap();
        let turn = PathElement::Turn { sweep: FRAC_PI_2, lever: Some(1.0) };
        own.mission(&request("turns", vec![turn]), 0.0).unwrap();
        own.settle(0.0).unwrap();
        let granted = |own: &Supervisor, name: &str| own.robot(name).unwrap().granted;
        assert_eq!(granted(&own, "passes"), 16.0);
        if beside {
            // The outermost corner reaches 0.7211 m to the side, and the other one's side is 0.4 m from its path.
            assert_eq!(granted(&own, "turns"), FRAC_PI_2, "{apart}");
            continue;
        }
        // A corner is 0.71 m to the side when the truck has turned by asin(0.71 / 0.7211) less its own angle.
        let reached = ((apart - 0.4) / 0.6_f64.hypot(0.4)).asin() - 0.4_f64.atan2(0.6);
        assert!((granted(&own, "turns") - reached).abs() < 1e-4, "{} {reached}", granted(&own, "turns"));
        assert_eq!(own.waits_for(own.robot("turns").unwrap()), Some("passes"));
        let passed = PositionReport { robot: "passes".into(), path: 2, at: [10.0, 10.1], age: 0.0 };
        own.position(&passed, 1.0).unwrap();
        own.settle(1.0).unwrap();
        assert_eq!(granted(&own, "turns"), FRAC_PI_2);
    }
}

#[test]
fn turns_of_outlines_need_a_length() {
    let mut own = supervisor();
    own.add("a", rectangle(TRUCK), StartPose { x: 0.0, y: 0.0, heading: 0.0 }).unwrap();
    let turn = |lever| vec![PathElement::Turn { sweep: FRAC_PI_2, lever }, line(2.0)];
    let refused = own.mission(&request("a", turn(None)), 0.0).unwrap_err().to_string();
    assert!(refused.contains("give each turn its `lever`"), "{refused}");
    let lever = 0.5;
    own.mission(&request("a", turn(Some(lever))), 0.0).unwrap();
    let robot = own.robot("a").unwrap();
    assert_eq!(robot.course.length(), lever * FRAC_PI_2 + 2.0);
    // Also at the start, where the heading would only be another one than that of the robot.
    own.mission(&MissionRequest { mission: "n".into(), ..request("a", turn(None)) }, 0.0).unwrap_err();
    // With any heading it is a disc, which turns in no time.
    let free = MissionRequest { any_heading: true, mission: "f".into(), ..request("a", turn(None)) };
    own.mission(&free, 0.0).unwrap();
    assert!(own.robot("a").unwrap().body.is_disc());
}

/// On a path of any heading the disc counts; where the robot stands at the end, its next path has its heading again.
#[test]
fn with_any_heading_a_truck_is_its_disc() {
    let mut own = supervisor();
    let [east, west] = {
        own.add("east", rectangle(TRUCK), StartPose { x: 0.0, y: 0.0, heading: 0.0 }).unwrap();
        own.add("west", rectangle(TRUCK), StartPose { x: 10.0, y: 0.9, heading: PI }).unwrap();
        own.mission(&MissionRequest { any_heading: true, ..request("east", vec![line(10.0)]) }, 0.0).unwrap();
        own.mission(&request("west", vec![line(10.0)]), 0.0).unwrap();
        own.settle(0.0).unwrap();
        ["east", "west"].map(|robot| own.robot(robot).unwrap().granted)
    };
    assert!(east == 0.0 && west == 10.0 || east == 10.0 && west == 0.0, "{east} {west}");
    let mut own = supervisor();
    own.add("east", rectangle(TRUCK), StartPose { x: 0.0, y: 0.0, heading: 0.0 }).unwrap();
    own.mission(&MissionRequest { any_heading: true, ..request("east", vec![line(10.0)]) }, 0.0).unwrap();
    own.settle(0.0).unwrap();
    own.position(&PositionReport { robot: "east".into(), path: 2, at: [10.0, 10.0], age: 0.0 }, 1.0).unwrap();
    own.settle(1.0).unwrap();
    own.mission(&request("east", vec![line(1.0), line(1.0)]), 1.0).unwrap();
    assert_eq!(own.robot("east").unwrap().path, 3);
    assert!(!own.robot("east").unwrap().any_heading && !own.robot("east").unwrap().body.is_disc());
}

/// Where a path bends, corners go further than the reference point: less of the margin is left for being beyond the authority.
#[test]
fn margins_cover_corners_where_paths_bend() {
    let told = |path: Vec<PathElement>, beyond: f64| {
        let mut own = supervisor();
        let traits = RobotTraits { margin: 0.1, ..rectangle([1.0, 0.2, 0.4]) };
        own.add("a", traits, StartPose { x: 0.0, y: 0.0, heading: 0.0 }).unwrap();
        own.mission(&request("a", path), 0.0).unwrap();
        own.settle(0.0).unwrap();
        let hi = own.robot("a").unwrap().granted + beyond;
        own.position(&PositionReport { robot: "a".into(), path: 2, at: [0.0, hi], age: 0.0 }, 0.5).unwrap();
        matches!(own.robot("a").unwrap().alarm, Some(Alarm::Beyond { .. }))
    };
    let bend = |lever| vec![line(1.0), PathElement::Turn { sweep: FRAC_PI_2, lever: Some(lever) }];
    assert!(!told(vec![line(3.0)], 0.099));
    assert!(told(vec![line(3.0)], 0.101));
    // Its corner is 1.08 m off, so with 0.2 m of path for each radian it goes more than five times as far.
    assert!(!told(bend(0.2), 0.1 / 6.0));
    assert!(told(bend(0.2), 0.1 / 5.0));
}

/// A journal in memory, read again as from the disk.
#[derive(Clone, Default)]
struct SharedJournal(Arc<Mutex<Vec<String>>>);

impl JournalStore for SharedJournal {
    fn keep(&mut self, entries: &[JournalEntry]) -> std::io::Result<()> {
        let lines = entries.iter().map(|entry| serde_json::to_string(entry).unwrap());
        self.0.lock().unwrap().extend(lines);
        Ok(())
    }
}

impl SharedJournal {
    fn restored(&self) -> Supervisor {
        let lines = self.0.lock().unwrap();
        let entries = lines.iter().map(|line| serde_json::from_str(line).unwrap()).collect();
        Supervisor::restored(SupervisorConfig::default(), entries, Box::new(NullStore)).unwrap()
    }
}

fn ask(own: &mut Supervisor, line: Value) -> Value {
    let reply = lines::handle(own, line.to_string().as_bytes(), 0.0, 0.0).answer;
    assert!(reply.get("error").is_none(), "{reply}");
    own.settle(0.0).unwrap();
    reply["ok"].clone()
}

/// Two trucks in lanes 0.9 m apart, one of which turns at the end, and a third one that crosses; by lines.
fn by_lines(own: &mut Supervisor) {
    let corner = |[ahead, left]: [f64; 2]| json!({ "ahead": ahead, "left": left });
    let corners = [[-0.6, -0.4], [0.6, -0.4], [0.6, 0.4], [-0.6, 0.4]].map(corner);
    let abilities = json!({ "footprint": { "polygon": corners }, "speed": 1, "acceleration": 0.5, "margin": 0.01 });
    for (robot, x, y, heading) in [("a", 0, 0.0, 0), ("b", 10, 0.9, 180), ("c", 5, -3.0, 90)] {
        let start = json!({ "x": x, "y": y, "heading_deg": heading });
        ask(own, json!({ "verb": "add", "robot": robot, "start": start, "abilities": abilities }));
    }
    let turn = json!({ "kind": "turn", "sweep_deg": -90, "lever": 0.8 });
    let line = |length: i32| json!({ "kind": "line", "length": length });
    for (robot, path) in
        [("b", json!([line(10)])), ("a", json!([line(10), turn, line(3)])), ("c", json!([line(3), line(4)]))]
    {
        ask(own, json!({ "verb": "mission", "robot": robot, "mission": "1", "path": path }));
    }
    ask(own, json!({ "verb": "position", "robot": "b", "path": 2, "at": [1.0, 1.1] }));
}

#[test]
fn a_restored_supervisor_grants_outlines_the_same() {
    let journal = SharedJournal::default();
    let mut own = Supervisor::new(SupervisorConfig::default(), Box::new(journal.clone()));
    by_lines(&mut own);
    let mut again = journal.restored();
    let regions = |own: &mut Supervisor, robot| ask(own, json!({ "verb": "query", "what": "regions", "robot": robot }));
    for robot in ["a", "b", "c"] {
        let found = regions(&mut own, robot);
        assert_eq!(found, regions(&mut again, robot));
        assert!(!found["regions"].as_array().unwrap().is_empty() || robot == "b", "{found}");
        let [before, after] = [&own, &again].map(|own| own.robot(robot).unwrap().clone());
        assert_eq!(before.abilities, after.abilities);
        assert_eq!(before.course.shapes(), after.course.shapes());
        assert!(before.notified_limit <= after.notified_limit);
    }
    // From the same positions on, both grant the same, until all have come to their ends.
    for _ in 0..40 {
        for robot in ["a", "b", "c"] {
            let at = [&own, &again].map(|own| own.robot(robot).unwrap().granted);
            let at = at[0].min(at[1]);
            for own in [&mut own, &mut again] {
                ask(own, json!({ "verb": "position", "robot": robot, "path": 2, "at": [at, at] }));
            }
        }
    }
    for robot in ["a", "b", "c"] {
        let both = [&own, &again].map(|own| own.robot(robot).unwrap());
        assert!(both.iter().all(|robot| robot.alarm.is_none() && robot.granted == robot.course.length()), "{both:?}");
    }
}

/// Journals from before outlines have neither footprints nor levers nor headings.
#[test]
fn a_journal_without_outlines_is_read() {
    let journal = SharedJournal::default();
    let mut own = Supervisor::new(SupervisorConfig::default(), Box::new(journal.clone()));
    let abilities = json!({ "radius": 0.4, "speed": 1, "acceleration": 0.5 });
    ask(
        &mut own,
        json!({ "verb": "add", "robot": "a", "start": { "x": 0, "y": 0, "heading": 0 }, "abilities": abilities }),
    );
    let path =
        json!([{ "kind": "line", "length": 2 }, { "kind": "turn", "sweep": 1.5 }, { "kind": "line", "length": 2 }]);
    ask(&mut own, json!({ "verb": "mission", "robot": "a", "mission": "1", "path": path }));
    let text = journal.0.lock().unwrap().join("\n");
    assert!(["footprint", "lever", "any_heading"].iter().all(|field| !text.contains(field)), "{text}");
    let again = journal.restored();
    assert_eq!(again.robot("a").unwrap().course.shapes(), own.robot("a").unwrap().course.shapes());
    assert_eq!(again.robot("a").unwrap().course.length(), 4.0);
}

#[test]
fn a_concave_outline_is_its_hull_and_the_answer_says_so() {
    let mut own = supervisor();
    let corners = [[0.0, -0.5], [1.5, -0.5], [1.5, -0.3], [0.3, -0.3], [0.3, 0.3], [1.5, 0.3], [1.5, 0.5], [0.0, 0.5]];
    let polygon: Vec<Value> = corners.map(|[ahead, left]| json!({ "ahead": ahead, "left": left })).into();
    let start = json!({ "x": 0, "y": 0, "heading": 0 });
    let abilities = |outline: Value| json!({ "footprint": outline, "speed": 1, "acceleration": 0.5 });
    let fork = abilities(json!({ "polygon": polygon }));
    let added = ask(&mut own, json!({ "verb": "add", "robot": "fork", "start": start, "abilities": fork }));
    assert!((added["hull_excess"].as_f64().unwrap() - 0.3).abs() < 0.05, "{added}");
    assert!(!own.robot("fork").unwrap().body.is_disc());
    let truck = json!({ "polygon": [{ "ahead": 9.0, "left": 0.0 }, { "ahead": 10.0, "left": 0.0 }, { "ahead": 9.0, "left": 1.0 }] });
    let added =
        ask(&mut own, json!({ "verb": "add", "robot": "truck", "start": start, "abilities": abilities(truck) }));
    assert_eq!(added, json!({ "path": 1 }));
    for (wrong, why) in [
        (json!({ "polygon": [] }), "0 corners"),
        (json!({ "polygon": polygon, "growth": -1.0 }), "growth"),
        (json!({ "polygon": polygon, "radius": 1.0 }), "radius"),
    ] {
        let line = json!({ "verb": "add", "robot": "x", "start": start, "abilities": abilities(wrong) });
        let refused = lines::handle(&mut own, line.to_string().as_bytes(), 0.0, 0.0).answer;
        assert!(refused["error"]["message"].as_str().is_some_and(|text| text.contains(why)), "{refused}");
    }
    let both = json!({ "radius": 1, "footprint": { "polygon": polygon }, "speed": 1, "acceleration": 1 });
    let line = json!({ "verb": "add", "robot": "x", "start": start, "abilities": both });
    let refused = lines::handle(&mut own, line.to_string().as_bytes(), 0.0, 0.0).answer;
    assert!(refused["error"]["message"].as_str().is_some_and(|text| text.contains("not both")), "{refused}");
}

/// A vehicle that is lost may have any heading: others keep away from its disc.
#[test]
fn a_lost_truck_is_kept_away_from_with_any_heading() {
    let mut own = supervisor();
    assert_eq!(passing(&mut own, &rectangle(TRUCK), 0.9), [10.0; 2]);
    own.report_off_path("west", [5.0, 0.9], 0.0, 1.0).unwrap();
    own.settle(1.0).unwrap();
    assert_eq!(own.robot("east").unwrap().stopped.as_deref(), Some("west"));
}

/// What the orders prevent, and when a part of a path is free, are asked with outlines, too.
#[test]
fn queries_know_outlines() {
    for (apart, meets) in [(0.801, false), (0.799, true)] {
        let mut own = supervisor();
        own.add("east", rectangle(TRUCK), StartPose { x: 0.0, y: 0.0, heading: 0.0 }).unwrap();
        own.add("west", rectangle(TRUCK), StartPose { x: 10.0, y: apart, heading: PI }).unwrap();
        own.mission(&request("east", vec![line(4.0)]), 0.0).unwrap();
        own.mission(&request("west", vec![line(4.0)]), 0.0).unwrap();
        let conflicts = ask(&mut own, json!({ "verb": "query", "what": "conflicts", "robot": "east" }));
        assert_eq!(conflicts["conflicts"], json!([]), "{conflicts}");
        own.remove("west").unwrap();
        own.add("west", rectangle(TRUCK), StartPose { x: 3.0, y: apart, heading: PI }).unwrap();
        let conflicts = ask(&mut own, json!({ "verb": "query", "what": "conflicts", "robot": "east" }));
        assert_eq!(conflicts["conflicts"] == json!([]), !meets, "{conflicts}");
        let safe = json!({ "verb": "query", "what": "safe", "robot": "east", "length": [2.0, 4.0], "until": 60.0 });
        assert_eq!(ask(&mut own, safe)["safe"] == json!([[0.0, 60.0]]), !meets);
        let robots = ask(&mut own, json!({ "verb": "query", "what": "robots", "robot": "east" }));
        assert_eq!(robots["robots"][0]["footprint"]["polygon"][1], json!({ "ahead": 0.6, "left": -0.4 }));
    }
}

/// A truck backs out of where it stands between two others, which it could not turn in.
#[test]
fn a_truck_backs_out_of_a_gap() {
    let mut own = supervisor();
    for (robot, y) in [("left", 0.9), ("own", 0.0), ("right", -0.9)] {
        own.add(robot, rectangle(TRUCK), StartPose { x: 0.0, y, heading: 0.0 }).unwrap();
    }
    let turn = PathElement::Turn { sweep: FRAC_PI_2, lever: Some(1.0) };
    own.mission(&request("own", vec![PathElement::Shift { ahead: -3.0, left: 0.0 }, turn, line(2.0)]), 0.0).unwrap();
    own.settle(0.0).unwrap();
    let robot = own.robot("own").unwrap();
    assert_eq!(robot.granted, robot.course.length());
    let end = robot.course.pose(robot.course.length());
    assert!((end.x + 3.0).abs() < 1e-12 && (end.y - 2.0).abs() < 1e-12, "{end:?}");
    own.mission(&MissionRequest { after: Some(robot.course.length()), ..request("own", vec![turn]) }, 0.0).unwrap();
    // Where they stand it cannot turn.
    let mut own = supervisor();
    for (robot, y) in [("left", 0.9), ("own", 0.0), ("right", -0.9)] {
        own.add(robot, rectangle(TRUCK), StartPose { x: 0.0, y, heading: 0.0 }).unwrap();
    }
    let refused = own.mission(&request("own", vec![turn, line(2.0)]), 0.0).unwrap();
    assert!(matches!(&refused, AdmissionResult::Waiting { by: Some(_), .. }), "{refused:?}");
}
