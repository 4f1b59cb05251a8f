//! Holds that were never told, although nothing was in the way.

use pcr_serve::journal_entry::NullStore;
use pcr_serve::owned_path::{PathElement, StartPose};
use pcr_serve::robot::RobotTraits;
use pcr_serve::supervisor::{MissionRequest, PositionReport, Supervisor, SupervisorConfig};
use std::f64::consts::FRAC_PI_2;

fn lone(settings: SupervisorConfig, speed: f64, length: f64) -> Supervisor {
    let mut own = Supervisor::new(settings, Box::new(NullStore));
    let abilities = RobotTraits { radius: 0.4, footprint: None, margin: 0.0, speed, acceleration: 1.0 };
    own.add("a", abilities, StartPose { x: 0.0, y: 0.0, heading: 0.0 }).unwrap();
    let path = vec![PathElement::Line { length }];
    let proposal = MissionRequest {
        robot: "a".into(),
        mission: "m".into(),
        after: None,
        expected_path: None,
        any_heading: false,
        start: None,
        path,
    };
    own.mission(&proposal, 0.0).unwrap();
    own.settle(0.0).unwrap();
    own
}

fn at(own: &mut Supervisor, [lo, hi]: [f64; 2], now: f64) {
    let path = own.robot("a").unwrap().path;
    own.position(&PositionReport { robot: "a".into(), path, at: [lo, hi], age: 0.0 }, now).unwrap();
    own.settle(now).unwrap();
}

/// A hold was told only if it was 5 cm further on, which these robots never need.
#[test]
fn slow_robots_come_to_their_ends() {
    let usual = SupervisorConfig::default();
    let near = SupervisorConfig { lookahead: 0.1, ..usual };
    for (settings, speed) in [(usual, 1e-4), (usual, 0.02), (usual, 0.05), (near, 0.2)] {
        let mut own = lone(settings, speed, 1.0);
        // Each time it stops a little before its hold, as it may.
        for step in 1..200 {
            let robot = own.robot("a").unwrap();
            if robot.has_arrived(settings.position_uncertainty) {
                break;
            }
            let reached = (robot.granted - 0.9 * settings.position_uncertainty).max(robot.arc_length);
            at(&mut own, [reached; 2], f64::from(step));
        }
        let robot = own.robot("a").unwrap();
        assert!(robot.has_arrived(settings.position_uncertainty), "{speed} m/s: {} of 1 m", robot.arc_length);
    }
}

/// Somebody was added beside a place that it had passed but not reported yet. The hold before that place was kept when it had.
#[test]
fn who_has_passed_what_kept_it_goes_on() {
    let mut own = lone(SupervisorConfig::default(), 1.0, 20.0);
    at(&mut own, [2.0, 2.05], 1.0);
    let abilities = own.robot("a").unwrap().abilities.clone();
    own.add("b", abilities, StartPose { x: 3.5, y: 0.0, heading: FRAC_PI_2 }).unwrap();
    own.settle(1.5).unwrap();
    let told = own.robot("a").unwrap().notified_limit;
    assert!(told > 4.5 && told < 6.0, "{told}");
    at(&mut own, [4.4, 4.5], 2.0);
    for step in 0..40 {
        let robot = own.robot("a").unwrap();
        let reached = robot.granted.max(robot.arc_length);
        at(&mut own, [reached; 2], 3.0 + f64::from(step));
    }
    let robot = own.robot("a").unwrap();
    assert!(robot.has_arrived(0.1), "{} of 20 m, {:?}", robot.arc_length, robot.authority);
}
