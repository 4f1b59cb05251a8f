//! Nobody waits for long while others come before it, again and again, and no mission because others wait.

use pcr_serve::journal_entry::NullStore;
use pcr_serve::owned_path::{PathElement, StartPose};
use pcr_serve::robot::RobotTraits;
use pcr_serve::supervisor::{AdmissionResult, MissionRequest, PositionReport, Supervisor, SupervisorConfig};
use std::f64::consts::{FRAC_PI_2, PI};

const STEP: f64 = 0.5;
/// \[m/s\]
const FAST: f64 = 3.0;
const SLOW: f64 = 0.1;

/// A fast robot goes to and fro through a passage, asked for its next way before it has begun the one before; a slow one would pass it,
/// too. Whoever passes sooner goes first: the fast one passed 48 times before the slow one, which arrived after 438 s.
#[test]
fn a_slow_robot_gets_its_turn() {
    let mut own = Supervisor::new(SupervisorConfig::default(), Box::new(NullStore));
    let abilities = |speed| RobotTraits { radius: 0.4, footprint: None, margin: 0.0, speed, acceleration: 5.0 };
    own.add("fast", abilities(FAST), StartPose { x: 0.0, y: 4.0, heading: FRAC_PI_2 }).unwrap();
    own.add("slow", abilities(SLOW), StartPose { x: -4.0, y: 0.0, heading: 0.0 }).unwrap();
    // Turns round, 4 m to the passage, 12 m through it and 4 m out of it. It turns by a little more than half a turn, because the lines of
    // both lie on one another: the side on which one is off by rounding would decide who goes first.
    const HALF: f64 = PI + 1e-12;
    let trip = |trips: u32| {
        let sweep = if trips.is_multiple_of(2) { FRAC_PI_2 } else { -FRAC_PI_2 };
        let (bend, line) = (PathElement::Turn { sweep, lever: None }, |length| PathElement::Line { length });
        vec![PathElement::Turn { sweep: HALF, lever: None }, line(4.0), bend, line(12.0), bend, line(4.0)]
    };
    let ask = |own: &mut Supervisor, robot: &str, mission: String, path: Vec<PathElement>, now: f64| {
        own.mission(
            &MissionRequest {
                robot: robot.into(),
                mission,
                after: None,
                expected_path: None,
                any_heading: false,
                start: None,
                path,
            },
            now,
        )
        .unwrap();
    };
    let mut trips = 0;
    for step in 0..1_200 {
        let now = f64::from(step) * STEP;
        for (name, speed) in [("fast", FAST), ("slow", SLOW)] {
            let robot = own.robot(name).unwrap();
            let at = (robot.arc_length + speed * STEP).min(robot.granted);
            own.position(&PositionReport { robot: name.into(), path: robot.path, at: [at; 2], age: 0.0 }, now).unwrap();
        }
        let fast = own.robot("fast").unwrap();
        if fast.waiting.is_none() && fast.course.length() - fast.arc_length < 30.0 {
            ask(&mut own, "fast", trips.to_string(), trip(trips), now);
            trips += 1;
        }
        if step == 41 {
            ask(&mut own, "slow", "through".into(), vec![PathElement::Line { length: 20.0 }], now);
        }
        own.settle(now).unwrap();
        if step > 41 && own.robot("slow").unwrap().has_arrived(0.1) {
            // It needs 200 s for its way, and has a minute of patience.
            assert!(now < 300.0, "it arrives after {now} s");
            assert!(trips > 20, "{trips}");
            return;
        }
    }
    panic!("it does not arrive");
}

/// A robot stands for a minute before the way of one that hardly moves. Far away from them, a robot with a short way goes before one that
/// comes much later. It did not: while anybody stood, new missions went last everywhere, and of a hundred vehicles somebody always stands.
#[test]
fn one_that_stands_does_not_put_others_last() {
    let mut own = Supervisor::new(SupervisorConfig::default(), Box::new(NullStore));
    let abilities = |speed| RobotTraits { radius: 0.4, footprint: None, margin: 0.0, speed, acceleration: 1.0 };
    let starts = [
        ("slow", 0.01, [-1.2, 0.0], 0.0),
        ("held", 1.0, [0.0, -4.0], FRAC_PI_2),
        ("far", 0.3, [60.0, 0.0], 0.0),
        ("near", 1.0, [90.0, -3.0], FRAC_PI_2),
    ];
    for (name, speed, [x, y], heading) in starts {
        // What it can do, not what it does.
        let speed = if name == "slow" { 1.0 } else { speed };
        own.add(name, abilities(speed), StartPose { x, y, heading }).unwrap();
    }
    let ask = |own: &mut Supervisor, robot: &str, length: f64, now: f64| {
        let path = vec![PathElement::Line { length }];
        let mission = MissionRequest {
            robot: robot.into(),
            mission: "1".into(),
            after: None,
            expected_path: None,
            any_heading: false,
            start: None,
            path,
        };
        let verdict = own.mission(&mission, now).unwrap();
        assert!(matches!(verdict, AdmissionResult::Admitted { .. }), "{robot}: {verdict:?}");
    };
    ask(&mut own, "slow", 3.0, 0.0);
    let drive = |own: &mut Supervisor, time: std::ops::Range<u32>| {
        for step in time {
            let now = f64::from(step) * STEP;
            for (name, speed, ..) in starts {
                let robot = own.robot(name).unwrap();
                let at = (robot.arc_length + speed * STEP).min(robot.granted);
                own.position(&PositionReport { robot: name.into(), path: robot.path, at: [at; 2], age: 0.0 }, now)
                    .unwrap();
            }
            own.settle(now).unwrap();
        }
    };
    // It is where the other one would pass from 0.4 m to 2 m; from 1.2 m on it begins to leave.
    drive(&mut own, 0..90);
    ask(&mut own, "held", 8.0, 45.0);
    drive(&mut own, 90..234);
    let [held, slow] = ["held", "slow"].map(|name| own.robot(name).unwrap());
    assert!(
        held.granted < 4.0 && held.arc_length >= held.granted - 1e-6 && slow.arc_length < 1.2,
        "{} {} {}",
        held.granted,
        held.arc_length,
        slow.arc_length
    );
    ask(&mut own, "far", 60.0, 117.0);
    drive(&mut own, 234..236);
    ask(&mut own, "near", 6.0, 118.0);
    drive(&mut own, 236..254);
    assert!(own.robot("near").unwrap().has_arrived(0.1), "it waits for the one that comes in 100 s");
}

/// Robots in a row, each of which is to go to the place of the next one. The last one to ask is the one in front, which can go as soon as
/// somebody has left. Of the missions whose time had come the oldest one was always tried, one at a time: with so many that wait nobody
/// ever looked at the last one.
#[test]
fn a_mission_is_tried_however_many_others_wait() {
    const ROW: u32 = 60;
    let mut own = Supervisor::new(SupervisorConfig::default(), Box::new(NullStore));
    let abilities = RobotTraits { radius: 0.4, footprint: None, margin: 0.0, speed: 1.0, acceleration: 0.5 };
    let ask = |own: &mut Supervisor, robot: &str| {
        let path = vec![PathElement::Line { length: 5.0 }];
        let proposal = MissionRequest {
            robot: robot.into(),
            mission: "1".into(),
            after: None,
            expected_path: None,
            any_heading: false,
            start: None,
            path,
        };
        own.mission(&proposal, 0.0).unwrap()
    };
    for k in 0..ROW {
        own.add(&k.to_string(), abilities.clone(), StartPose { x: 5.0 * f64::from(k), y: 0.0, heading: 0.0 }).unwrap();
    }
    own.add("in the way", abilities, StartPose { x: 5.0 * f64::from(ROW), y: 0.0, heading: 0.0 }).unwrap();
    for k in 0..ROW {
        let verdict = ask(&mut own, &k.to_string());
        assert!(matches!(verdict, AdmissionResult::Waiting { .. }), "{k}: {verdict:?}");
    }
    let waiting = |own: &Supervisor| own.robots().iter().filter(|robot| robot.waiting.is_some()).count();
    // All of them have waited for long.
    let mut now = 0.0;
    let mut goes_on = |own: &mut Supervisor, time: f64| {
        for _ in 0..(time / 0.05) as u32 {
            now += 0.05;
            own.settle(now).unwrap();
        }
    };
    goes_on(&mut own, 30.0);
    assert_eq!(waiting(&own), ROW as usize);
    own.remove("in the way").unwrap();
    // Each is tried once in 3 s, and each that is admitted makes way for the next one.
    goes_on(&mut own, 4.0);
    assert!(own.robot(&(ROW - 1).to_string()).unwrap().waiting.is_none());
    goes_on(&mut own, 4.0 * f64::from(ROW));
    assert_eq!(waiting(&own), 0);
}
