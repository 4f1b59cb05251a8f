//! Nobody waits for long while others come before it, again and again.

use pcr_serve::course::{Shape, Start};
use pcr_serve::entry::Nowhere;
use pcr_serve::robot::Abilities;
use pcr_serve::supervisor::{Proposal, Report, Settings, Supervisor};
use std::f64::consts::{FRAC_PI_2, PI};

const STEP: f64 = 0.5;
/// \[m/s\]
const FAST: f64 = 3.0;
const SLOW: f64 = 0.1;

/// A fast robot goes to and fro through a passage, asked for its next way before it has begun the one before; a slow one would pass it,
/// too. Whoever passes sooner goes first: the fast one passed 48 times before the slow one, which arrived after 438 s.
#[test]
fn a_slow_robot_gets_its_turn() {
    let mut own = Supervisor::new(Settings::default(), Box::new(Nowhere));
    let abilities = |speed| Abilities { radius: 0.4, margin: 0.0, speed, acceleration: 5.0 };
    own.add("fast", abilities(FAST), Start { x: 0.0, y: 4.0, heading: FRAC_PI_2 }).unwrap();
    own.add("slow", abilities(SLOW), Start { x: -4.0, y: 0.0, heading: 0.0 }).unwrap();
    // Turns round, 4 m to the passage, 12 m through it and 4 m out of it.
    let trip = |trips: u32| {
        let sweep = if trips.is_multiple_of(2) { FRAC_PI_2 } else { -FRAC_PI_2 };
        let (bend, line) = (Shape::Turn { sweep }, |length| Shape::Line { length });
        vec![Shape::Turn { sweep: PI }, line(4.0), bend, line(12.0), bend, line(4.0)]
    };
    let ask = |own: &mut Supervisor, robot: &str, mission: String, path: Vec<Shape>, now: f64| {
        own.mission(&Proposal { robot: robot.into(), mission, after: None, start: None, path }, now).unwrap();
    };
    let mut trips = 0;
    for step in 0..1_200 {
        let now = f64::from(step) * STEP;
        for (name, speed) in [("fast", FAST), ("slow", SLOW)] {
            let robot = own.robot(name).unwrap();
            let at = (robot.at + speed * STEP).min(robot.granted);
            own.position(&Report { robot: name.into(), path: robot.path, at: [at; 2], age: 0.0 }, now).unwrap();
        }
        let fast = own.robot("fast").unwrap();
        if fast.waiting.is_none() && fast.course.length() - fast.at < 30.0 {
            ask(&mut own, "fast", trips.to_string(), trip(trips), now);
            trips += 1;
        }
        if step == 41 {
            ask(&mut own, "slow", "through".into(), vec![Shape::Line { length: 20.0 }], now);
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
