//! Who stands at the end of a path is in the way of whoever would end there.

use crate::site::settings;
use pcr_serve::journal_entry::NullStore;
use pcr_serve::owned_path::{PathElement, StartPose};
use pcr_serve::robot::RobotTraits;
use pcr_serve::supervisor::{AdmissionResult, MissionRequest, PositionReport, Supervisor};

#[test]
fn a_place_that_is_taken_is_nobodys_end() {
    let abilities = |radius| RobotTraits { radius, footprint: None, margin: 0.072, speed: 1.0, acceleration: 0.5 };
    for k in 0..200 {
        let mut supervisor = Supervisor::new(settings(), Box::new(NullStore));
        let off = 0.001 * f64::from(k);
        let lengths = [20.35 + off, 3.65, 4.5 + off, 5.5, 7.5, 4.0];
        supervisor.add("a", abilities(0.3), StartPose { x: 0.1 * off, y: 30.0, heading: 0.3 * off }).unwrap();
        let path: Vec<_> = lengths
            .iter()
            .flat_map(|&length| [PathElement::Turn { sweep: 0.7, lever: None }, PathElement::Line { length }])
            .collect();
        let mission = |robot: &str, name: &str, path| MissionRequest {
            robot: robot.into(),
            mission: name.into(),
            after: None,
            expected_path: None,
            any_heading: false,
            start: None,
            path,
        };
        supervisor.mission(&mission("a", "one", path), 0.0).unwrap();
        supervisor.settle(0.0).unwrap();
        let a = supervisor.robot("a").unwrap();
        let (path, end) = (a.path, a.course.length());
        assert_eq!(a.notified_limit, end);
        let there = a.course.pose(end);
        supervisor.position(&PositionReport { robot: "a".into(), path, at: [end; 2], age: 0.0 }, 1.0).unwrap();
        supervisor.settle(1.0).unwrap();
        // Another one comes from afar, and would end there.
        let start = StartPose { x: there.x - 12.0, y: there.y, heading: 0.0 };
        supervisor.add("b", abilities(0.4), start).unwrap();
        supervisor.settle(1.5).unwrap();
        let verdict = supervisor.mission(&mission("b", "two", vec![PathElement::Line { length: 12.0 }]), 2.0).unwrap();
        assert!(matches!(verdict, AdmissionResult::Waiting { .. }), "{k}: {verdict:?}");
    }
}

#[test]
fn a_path_that_goes_on_goes_on_where_it_was() {
    for at in [0.0, 1.0, 4.999_999_999, 5.0, 5.000_000_001, 7.0, 9.9, 10.0, 10.000_000_001, 14.0, 15.0] {
        let mut supervisor = Supervisor::new(settings(), Box::new(NullStore));
        let abilities = RobotTraits { radius: 0.3, footprint: None, margin: 0.1, speed: 1.0, acceleration: 0.5 };
        supervisor.add("a", abilities, StartPose { x: 0.0, y: 0.0, heading: 0.0 }).unwrap();
        let (line, turn) =
            (PathElement::Line { length: 5.0 }, PathElement::Turn { sweep: std::f64::consts::FRAC_PI_2, lever: None });
        let path = vec![turn, line, turn, line, turn, line];
        let mission = |name: &str, path| MissionRequest {
            robot: "a".into(),
            mission: name.into(),
            after: None,
            expected_path: None,
            any_heading: false,
            start: None,
            path,
        };
        supervisor.mission(&mission("one", path), 0.0).unwrap();
        supervisor.settle(0.0).unwrap();
        let robot = supervisor.robot("a").unwrap();
        let (path, end) = (robot.path, robot.course.pose(robot.course.length()));
        assert!((end.x + 5.0).hypot(end.y) < 1e-9, "{end:?}");
        supervisor.position(&PositionReport { robot: "a".into(), path, at: [at; 2], age: 0.0 }, 1.0).unwrap();
        supervisor.mission(&mission("two", vec![line]), 1.0).unwrap();
        let robot = supervisor.robot("a").unwrap();
        let end = robot.course.pose(robot.course.length());
        assert!((end.x + 5.0).hypot(end.y + 5.0) < 1e-9, "at {at}: {end:?} {:?}", robot.course);
    }
}

/// Where a robot is after some more shapes, computed with nothing of the library.
fn after(mut end: StartPose, shapes: &[PathElement]) -> StartPose {
    for shape in shapes {
        match *shape {
            PathElement::Turn { sweep, .. } => end.heading += sweep,
            PathElement::Line { length } => {
                end.x += length * end.heading.cos();
                end.y += length * end.heading.sin();
            }
            PathElement::Arc { .. } | PathElement::Shift { .. } => unreachable!("there are none here"),
        }
    }
    end
}

/// Paths were cut before a turn where rounding put their beginning there: robots were believed to be elsewhere.
#[test]
fn missions_begin_where_the_one_before_ends_wherever_the_robot_is() {
    use pcr_formats::splitmix64::SplitMix64;
    use std::f64::consts::{FRAC_PI_2, PI};
    let mut random = SplitMix64(5);
    for run in 0..100 {
        let mut supervisor = Supervisor::new(settings(), Box::new(NullStore));
        let abilities = RobotTraits { radius: 0.3, footprint: None, margin: 0.1, speed: 1.0, acceleration: 0.5 };
        let mut end = StartPose { x: 0.0, y: 0.0, heading: 0.0 };
        supervisor.add("a", abilities, end).unwrap();
        for mission in 0..20 {
            let mut one = |of: &[f64]| of[random.below(of.len())];
            let count = one(&[1.0, 2.0, 3.0, 4.0]) as usize;
            let lengths: Vec<f64> = (0..count).map(|_| one(&[5.25, 1.75, 0.02, 3.85, 20.35])).collect();
            let mut path = Vec::new();
            for &length in &lengths {
                path.push(PathElement::Turn { sweep: one(&[0.0, FRAC_PI_2, -FRAC_PI_2, PI, -PI]), lever: None });
                path.push(PathElement::Line { length });
            }
            end = after(end, &path);
            let name = mission.to_string();
            let proposal = MissionRequest {
                robot: "a".into(),
                mission: name,
                after: None,
                expected_path: None,
                any_heading: false,
                start: None,
                path,
            };
            supervisor.mission(&proposal, 0.0).unwrap();
            supervisor.settle(0.0).unwrap();
            let robot = supervisor.robot("a").unwrap();
            let (number, whole, passed) = (robot.path, robot.course.length(), robot.arc_length);
            let there = robot.course.pose(whole);
            assert!(
                (there.x - end.x).hypot(there.y - end.y) < 1e-6,
                "{run} {mission}: {there:?} {end:?} {:?}",
                robot.course.shapes()
            );
            // At one of the stops, exactly or nearly, or somewhere.
            let stop = whole - lengths.iter().skip(random.below(lengths.len() + 1)).sum::<f64>();
            let at = match random.below(3) {
                0 => stop.max(0.0),
                1 => (stop - 1e-3 * random.unit()).max(0.0),
                _ => whole * random.unit(),
            };
            let at = at.max(passed);
            supervisor
                .position(&PositionReport { robot: "a".into(), path: number, at: [at; 2], age: 0.0 }, 1.0)
                .unwrap();
            supervisor.settle(1.0).unwrap();
        }
    }
}
