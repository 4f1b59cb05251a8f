//! Nobody waits for ever while others come before it, again and again.

use pcr_serve::course::{Shape, Start};
use pcr_serve::entry::Nowhere;
use pcr_serve::robot::Abilities;
use pcr_serve::supervisor::{Proposal, Report, Settings, Supervisor};
use std::f64::consts::{FRAC_PI_2, PI};

const STEP: f64 = 0.5;

/// Two fast robots go to and fro through a passage, each asked for its next way before it has done the one before; a slow one would pass
/// it, too. Whoever passes sooner goes first: that was never the slow one, which stood for ever.
#[test]
fn a_slow_robot_gets_its_turn_among_fast_ones() {
    let mut own = Supervisor::new(Settings::default(), Box::new(Nowhere));
    let abilities = |speed| Abilities { radius: 0.4, margin: 0.0, speed, acceleration: 5.0 };
    let names = [("north", 3.0), ("south", 3.0), ("slow", 0.3)];
    own.add("north", abilities(3.0), Start { x: 0.0, y: 4.0, heading: FRAC_PI_2 }).unwrap();
    own.add("south", abilities(3.0), Start { x: 0.0, y: -4.0, heading: -FRAC_PI_2 }).unwrap();
    own.add("slow", abilities(0.3), Start { x: -4.0, y: 0.0, heading: 0.0 }).unwrap();
    // Turns round, 4 m to the passage, 12 m through it and 4 m out of it.
    let trip = |side: f64, trips: u32| {
        let sweep = if trips.is_multiple_of(2) { side * FRAC_PI_2 } else { -side * FRAC_PI_2 };
        let (bend, line) = (Shape::Turn { sweep }, |length| Shape::Line { length });
        vec![Shape::Turn { sweep: PI }, line(4.0), bend, line(12.0), bend, line(4.0)]
    };
    let ask = |own: &mut Supervisor, robot: &str, mission: String, path: Vec<Shape>, now: f64| {
        own.mission(&Proposal { robot: robot.into(), mission, after: None, start: None, path }, now).unwrap();
    };
    let (mut trips, mut arrived) = ([0_u32; 2], None);
    for step in 0..3_600 {
        let now = f64::from(step) * STEP;
        for (name, speed) in names {
            let robot = own.robot(name).unwrap();
            let at = (robot.at + speed * STEP).min(robot.granted);
            let report = Report { robot: name.into(), path: robot.path, at: [at; 2], age: 0.0 };
            own.position(&report, now).unwrap();
        }
        for (k, (name, side)) in [("north", 1.0), ("south", -1.0)].into_iter().enumerate() {
            let robot = own.robot(name).unwrap();
            if robot.waiting.is_none() && robot.course.length() - robot.at < 9.0 {
                ask(&mut own, name, trips[k].to_string(), trip(side, trips[k]), now);
                trips[k] += 1;
            }
        }
        if step == 10 {
            ask(&mut own, "slow", "through".into(), vec![Shape::Line { length: 20.0 }], now);
        }
        own.settle(now).unwrap();
        let slow = own.robot("slow").unwrap();
        if arrived.is_none() && step > 10 && slow.has_arrived(0.1) {
            arrived = Some((now, trips));
        }
    }
    // A minute of patience, and 67 s for its way.
    let (time, before) = arrived.expect("the slow one never arrives");
    assert!(time < 300.0, "it arrives after {time} s");
    // There were always others.
    assert!(before.iter().all(|&trips| trips > 3) && trips.iter().all(|&trips| trips > 50), "{before:?}, {trips:?}");
}
