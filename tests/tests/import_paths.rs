//! Paths by their points: an agent each, whose speed in bends is what it may turn by.

use pcr_formats::import::{ImportOptions, InputFormat, Warnings, scenario};
use pcr_formats::scenario::{MotionSpec, Scenario};
use std::f64::consts::{FRAC_PI_2, PI};
use std::fmt::Write;

fn read(text: &str, rotation: f64) -> Scenario {
    let rotation = Some(rotation);
    let options = ImportOptions {
        radius: Some(0.3),
        speed: Some(1.0),
        acceleration: Some(1.0),
        rotation,
        ..ImportOptions::default()
    };
    scenario(InputFormat::Path, text, &options, &mut Warnings::default()).expect("paths")
}

/// 2 m to the east, a quarter of a circle of 2 m to the left, 2 m to the north.
fn bend() -> String {
    let mut text = String::from("0 0\n");
    for k in 0..=45 {
        let (sin, cos) = (FRAC_PI_2 * f64::from(k) / 45.0).sin_cos();
        writeln!(text, "{} {}", 2.0 + 2.0 * sin, 2.0 - 2.0 * cos).expect("text");
    }
    text + "4 4\n"
}

/// Length and speed at the end of each piece of the motion of an agent.
fn course(scenario: &Scenario, agent: usize) -> Vec<[f64; 2]> {
    let agent = &scenario.agents[agent];
    assert!(matches!(agent.motion, MotionSpec::Profile { .. }), "{:?}", agent.motion);
    let (v0, pieces) = agent.motion.pieces(agent.length());
    let mut at = [0.0, v0];
    let mut add = |(duration, acceleration): (f64, f64)| {
        let speed = at[1] + acceleration * duration;
        at = [at[0] + (at[1] + speed) / 2.0 * duration, speed];
        at
    };
    pieces.into_iter().map(&mut add).collect()
}

#[test]
fn every_path_of_a_file_is_an_agent() {
    let found = read("0 0\n3 0\n\n# another one\n1,1\n1,2\n1,4\n", 1.0);
    let lengths: Vec<f64> =
        found.agents.iter().map(|agent| agent.path.iter().map(|segment| segment.length()).sum()).collect();
    assert_eq!(lengths, [3.0, 3.0]);
    for nothing in ["# nothing\n", "\n\n"] {
        assert!(scenario(InputFormat::Path, nothing, &ImportOptions::default(), &mut Warnings::default()).is_err());
    }
}

#[test]
fn bends_are_driven_as_fast_as_the_vehicle_may_turn() {
    for (rotation, expected) in [(0.25, 0.5), (0.1, 0.2)] {
        let scenario = read(&bend(), rotation);
        let course = course(&scenario, 0);
        let inside = |length: f64| (2.1..2.0 + PI - 0.1).contains(&length);
        let most = |bent: bool| {
            let speeds = course.iter().filter(|[length, _]| inside(*length) == bent).map(|[_, speed]| *speed);
            speeds.fold(0.0, f64::max)
        };
        assert!((most(false) - 1.0).abs() < 1e-9, "{course:?}");
        // As fast in the middle of the bend, and nowhere faster.
        let middle = course.iter().find(|[length, _]| *length > 2.0 + FRAC_PI_2).expect("a bend")[1];
        assert!((middle / expected - 1.0).abs() < 0.02 && most(true) < 1.02 * expected, "{course:?}");
    }
    // One that turns fast enough drives as if it were straight.
    let middle = course(&read(&bend(), 2.0), 0).into_iter().find(|[length, _]| *length > 2.0 + FRAC_PI_2);
    assert!((middle.expect("a bend")[1] - 1.0).abs() < 1e-9, "{middle:?}");
}
