//! Lengths at which a shape of a path ends, but for rounding, and turns in place there.

use pcr_formats::splitmix64::SplitMix64;
use pcr_serve::event::SupervisorEvent;
use pcr_serve::journal_entry::{JournalEntry, NullStore};
use pcr_serve::owned_path::{OwnedPath, PathElement, PathRounding, StartPose, WORN};
use pcr_serve::query::{Query, answer};
use pcr_serve::request_error::RequestError;
use pcr_serve::robot::RobotTraits;
use pcr_serve::supervisor::{AdmissionResult, MissionRequest, PositionReport, Supervisor, SupervisorConfig};
use std::f64::consts::{FRAC_PI_2, PI};

const CAN: RobotTraits = RobotTraits { radius: 0.25, footprint: None, margin: 0.0, speed: 1.0, acceleration: 0.5 };
const ORIGIN: StartPose = StartPose { x: 0.0, y: 0.0, heading: 0.0 };
const CORNER: PathElement = PathElement::Turn { sweep: FRAC_PI_2, lever: None };

fn line(length: f64) -> PathElement {
    PathElement::Line { length }
}

/// Hundredths of a metre, whose sums are rounded.
fn hundredths(dice: &mut SplitMix64, from: u32, to: u32) -> f64 {
    f64::from(from + dice.below((to - from) as usize) as u32) / 100.0
}

fn proposal(mission: &str, path: &[PathElement]) -> MissionRequest {
    let (robot, mission, path) = ("a".into(), mission.into(), path.to_vec());
    MissionRequest { robot, mission, after: None, expected_path: None, any_heading: false, start: None, path }
}

fn supervisor(start: StartPose) -> Supervisor {
    let mut supervisor = Supervisor::new(SupervisorConfig::default(), Box::new(NullStore));
    supervisor.add("a", CAN, start).unwrap();
    supervisor
}

fn is_admitted(supervisor: &mut Supervisor, proposal: &MissionRequest) -> bool {
    matches!(supervisor.mission(proposal, 0.0).unwrap(), AdmissionResult::Admitted { .. })
}

/// As far as rounding may put two poses apart.
fn is_same(a: StartPose, b: StartPose) -> bool {
    let turned = (a.heading - b.heading + PI).rem_euclid(2.0 * PI) - PI;
    (a.x - b.x).hypot(a.y - b.y) < 1e-6 && turned.abs() < 1e-6
}

#[test]
fn the_turn_at_the_end_of_a_path_is_done() {
    let mut dice = SplitMix64(1);
    for k in 0..2_000 {
        let mut path: Vec<PathElement> = (0..1 + dice.below(4)).map(|_| line(hundredths(&mut dice, 10, 500))).collect();
        if k == 0 {
            path = vec![line(3.58), line(1.39), line(0.89)];
        }
        let x = 100.0 + path.iter().map(|shape| shape.length()).sum::<f64>();
        path.push(PathElement::Turn { sweep: 1.5, lever: None });
        let mut own = supervisor(StartPose { x: 100.0, ..ORIGIN });
        assert!(is_admitted(&mut own, &proposal("m", &path)));
        let next = |heading| {
            let start = Some(StartPose { x, y: 0.0, heading });
            MissionRequest { start, ..proposal("n", &[line(3.0)]) }
        };
        assert!(matches!(own.mission(&next(0.0), 0.0), Err(RequestError::Apart { .. })), "{path:?}");
        assert!(is_admitted(&mut own, &next(1.5)), "{path:?}");
        let course = &own.robot("a").unwrap().course;
        let end = StartPose { x: x + 3.0 * 1.5_f64.cos(), y: 3.0 * 1.5_f64.sin(), heading: 1.5 };
        assert!(is_same(course.pose(course.length()), end), "{path:?}");
    }
}

/// What is left of a path leads where the path leads, and what is joined to it where it would from there.
#[test]
fn courses_that_are_cut_at_a_joint_lead_where_they_did() {
    let mut dice = SplitMix64(2);
    let mut cuts = 0;
    for _ in 0..3_000 {
        let shapes: Vec<PathElement> = (0..2 + dice.below(6))
            .map(|_| match dice.below(3) {
                0 => PathElement::Turn { sweep: dice.uniform(-PI, PI), lever: None },
                1 => PathElement::Arc { radius: hundredths(&mut dice, 30, 100), sweep: dice.uniform(-PI, PI) },
                _ => line(hundredths(&mut dice, 1, 200)),
            })
            .collect();
        let course = OwnedPath::new(StartPose { x: 100.0, ..ORIGIN }, shapes.clone()).unwrap();
        let end = course.pose(course.length());
        let count = dice.below(shapes.len() + 1);
        let plain: f64 = shapes[..count].iter().map(|shape| shape.length()).sum();
        let joints = [plain, plain.next_up(), plain.next_down(), plain + 1e-7, plain - 1e-7].map(|at| at.max(0.0));
        for at in joints {
            cuts += 1;
            let rest = course.part(at, course.length()).unwrap();
            assert!(is_same(rest.pose(rest.length()), end), "{shapes:?} from {at}");
            assert!((rest.length() + at - course.length()).abs() < 1e-6, "{shapes:?} from {at}");
            let (whole, dropped, _) =
                course.rejoined(at, course.length() - 1e-9, &[CORNER], PathRounding::default()).unwrap();
            assert!(is_same(whole.pose(whole.length()), StartPose { heading: end.heading + FRAC_PI_2, ..end }));
            assert!((whole.length() + dropped - course.length()).abs() < 1e-6, "{shapes:?} from {at}");
            // Where it is left, the turns there are not done, but at its end.
            let is_end = at > course.length() - 1e-6;
            let mut first = shapes[..count].to_vec();
            let turns = |shape: &PathElement| shape.length() == 0.0;
            while !is_end && first.last().is_some_and(turns) {
                first.pop();
            }
            let first = if is_end { shapes.clone() } else { first };
            let left = OwnedPath::new(StartPose { x: 100.0, ..ORIGIN }, first).unwrap();
            let left = left.pose(left.length());
            assert!(is_same(course.arrival(at).unwrap(), left), "{shapes:?} to {at}");
            for from in [0.0, 0.5 * at, at, joints[2]] {
                let (joined, ..) = course.rejoined(from, at, &[], PathRounding::default()).unwrap();
                assert!(is_same(joined.pose(joined.length()), left), "{shapes:?} from {from} to {at}");
            }
        }
    }
    assert_eq!(cuts, 15_000);
}

#[test]
fn who_is_at_a_turn_goes_on_after_it() {
    let mut own = supervisor(ORIGIN);
    assert!(is_admitted(&mut own, &proposal("m", &[line(0.11), line(0.69), line(0.27), CORNER, line(5.0)])));
    own.add("c", CAN, StartPose { x: 1.07, y: 3.0, heading: 0.0 }).unwrap();
    own.settle(0.0).unwrap();
    for at in [1.06, 1.07_f64.next_down(), 1.07, 1.07_f64.next_up()] {
        own.position(&PositionReport { robot: "a".into(), path: 2, at: [at, at], age: 0.0 }, 0.0).unwrap();
        let ask = |question: Query| answer(&own, &question, 0.0).unwrap();
        let conflicts = ask(Query::Conflicts { robot: "a".into() });
        assert_eq!(conflicts["conflicts"].as_array().unwrap().len(), 1, "{at}");
        let safe = ask(Query::Safe { robot: "a".into(), length: [at + 2.5, at + 3.4], until: 60.0 });
        assert_eq!(safe["safe"].as_array().unwrap().len(), 0, "{at}: {safe}");
    }
    // The whole way, in lengths that a sum has rounded.
    for length in [[1.07, 6.07_f64.next_up()], [1.07_f64.next_down(), 6.07]] {
        answer(&own, &Query::Safe { robot: "a".into(), length, until: 60.0 }, 0.0).unwrap();
    }
}

/// The missions of a robot, each of which it drives to its end.
fn done(own: &mut Supervisor, from: usize, missions: usize, path: &[PathElement]) {
    for k in from..from + missions {
        assert!(is_admitted(own, &proposal(&k.to_string(), path)));
        own.settle(0.0).unwrap();
        let robot = own.robot("a").unwrap();
        let (path, end) = (robot.path, robot.course.length());
        for _ in 0..9 {
            let hold = own.robot("a").unwrap().granted;
            own.position(&PositionReport { robot: "a".into(), path, at: [hold; 2], age: 0.0 }, 0.0).unwrap();
            own.settle(0.0).unwrap();
        }
        assert!(own.robot("a").unwrap().granted == end, "{k}");
    }
}

/// The rounding of each mission was there in the next one: 6 µm after these.
#[test]
fn rounding_does_not_add_up_from_mission_to_mission() {
    // Numbers of 2^-56 m.
    let exact = |value: f64| (value * 2_f64.powi(56)) as i128;
    for (x, missions) in [(1.9e7, 4000_usize), (5.4e6, 2000)] {
        let mut own = supervisor(StartPose { x, ..ORIGIN });
        done(&mut own, 0, missions / 2, &[line(0.1)]);
        // A restart changes nothing.
        let entries = own.snapshot().unwrap();
        let mut own = Supervisor::restored(SupervisorConfig::default(), entries, Box::new(NullStore)).unwrap();
        done(&mut own, missions / 2, missions / 2, &[line(0.1)]);
        let robot = own.robot("a").unwrap();
        let there = exact(robot.course.start().x) + exact(robot.course.length());
        let off = (there - exact(x) - missions as i128 * exact(0.1)) as f64 / 2_f64.powi(56);
        assert!(off.abs() < 4e-9, "{x}: {off}");
        let bound = robot.rest.worn(robot.course.length());
        assert!(bound > 0.0 && bound < 1e-11, "{bound}");
    }
}

/// Turns that are sums of many have no more rounding than one, and neither have the places to which they lead.
#[test]
fn headings_do_not_add_up_rounding() {
    let mut own = supervisor(ORIGIN);
    let turns = 3000;
    done(&mut own, 0, turns, &[line(0.5), PathElement::Turn { sweep: PI, lever: None }]);
    // So much is missing from `PI` to half a turn.
    let missing = 1.224_646_799_147_353_2e-16;
    let robot = own.robot("a").unwrap();
    let end = robot.course.length();
    let (course, _, rest) = robot.course.rejoined(end, end, &[], robot.rest).unwrap();
    let heading = course.start().heading + (rest.heading + turns as f64 * missing);
    assert!(heading.abs() < 1e-25, "{heading}");
    // It goes half a metre forth and back, turned by a little more each time.
    let y: f64 = (0..turns).map(|k| -0.5 * (k as f64 * missing) * if k % 2 == 0 { 1.0 } else { -1.0 }).sum();
    let off = course.start().y + rest.y - y;
    assert!(off.abs() < 1e-18 && rest.distance_bound < 1e-11, "{off} {}", rest.distance_bound);
}

/// Who has driven so far that the rounding may be more than the discs have room for is to be added anew.
#[test]
fn a_robot_whose_rounding_has_added_up_gets_no_mission() {
    let mut own = supervisor(ORIGIN);
    done(&mut own, 0, 2, &[line(1.0)]);
    let restored = |rest: PathRounding| {
        let mut entries = own.snapshot().unwrap();
        for entry in &mut entries {
            if let JournalEntry::Robot(known) = entry {
                known.rest = rest;
            }
        }
        Supervisor::restored(SupervisorConfig::default(), entries, Box::new(NullStore))
    };
    let most = PathRounding { distance_bound: WORN, ..PathRounding::default() };
    // All that was driven counts, and along the path also how far it may be turned.
    for (rest, is_taken) in [
        (PathRounding { distance_bound: 0.99 * WORN, ..most }, true),
        (most, false),
        (PathRounding { distance_bound: 0.0, angle_bound: 0.02 * WORN, ..most }, true),
        (PathRounding { distance_bound: 0.0, angle_bound: 0.2 * WORN, ..most }, false),
    ] {
        let mut own = restored(rest).unwrap();
        match own.mission(&proposal("next", &[line(10.0)]), 0.0) {
            Ok(verdict) => {
                assert!(is_taken && matches!(verdict, AdmissionResult::Admitted { .. }), "{rest:?} {verdict:?}")
            }
            Err(fault) => assert!(!is_taken && fault.to_string().contains("add it anew"), "{rest:?} {fault}"),
        }
    }
    for rest in [
        PathRounding { x: 1.0, ..most },
        PathRounding { distance_bound: -1.0, ..most },
        PathRounding { angle_bound: -1.0, ..most },
    ] {
        assert!(restored(rest).is_err(), "{rest:?}");
    }
}

/// l + old origin − new origin is the length on the new path.
#[test]
fn lengths_are_converted_from_path_to_path() {
    let mut dice = SplitMix64(3);
    let mut moved = 0;
    for k in 0..1_500 {
        let mut lengths = [0; 3].map(|_| hundredths(&mut dice, 10, 200));
        if k == 0 {
            lengths = [0.22, 1.75, 1.28];
        }
        let mut own = supervisor(ORIGIN);
        let shapes: Vec<PathElement> = lengths.map(line).into_iter().chain([CORNER]).collect();
        assert!(is_admitted(&mut own, &proposal("m", &shapes)));
        own.settle(0.0).unwrap();
        let (old, at) = (own.robot("a").unwrap().course.length(), lengths[0] + 0.01);
        own.position(&PositionReport { robot: "a".into(), path: 2, at: [at, at], age: 0.0 }, 0.0).unwrap();
        own.settle(0.0).unwrap();
        // What is joined is nothing, and what was passed is left out.
        assert!(is_admitted(&mut own, &proposal("n", &[])));
        let events = own.settle(0.0).unwrap();
        let origin = events.iter().find_map(|event| match event {
            SupervisorEvent::Admitted { origin, .. } => Some(*origin),
            _ => None,
        });
        let after = old - origin.unwrap();
        moved += u32::from(after != own.robot("a").unwrap().course.length());
        let replace = MissionRequest {
            after: Some(after),
            expected_path: Some(3),
            any_heading: false,
            ..proposal("o", &[line(4.0)])
        };
        assert!(is_admitted(&mut own, &replace), "{lengths:?}");
        // Whoever asks again may have added up in another order.
        let again = MissionRequest { after: Some(after.next_up()), ..replace };
        assert!(is_admitted(&mut own, &again), "{lengths:?}");
        let course = &own.robot("a").unwrap().course;
        assert!(course.shapes().contains(&CORNER), "{lengths:?}");
        let end = StartPose { x: lengths.iter().sum(), y: 4.0, heading: FRAC_PI_2 };
        assert!(is_same(course.pose(course.length()), end), "{lengths:?}");
    }
    assert!(moved > 100, "{moved} lengths were rounded");
}

#[test]
fn what_was_told_is_kept_where_a_path_turns_off_there() {
    let mut own = supervisor(ORIGIN);
    assert!(is_admitted(&mut own, &proposal("m", &[line(9.0)])));
    own.settle(0.0).unwrap();
    let told = own.robot("a").unwrap().notified_limit;
    assert!(told > 1.0 && told < 9.0);
    let turns_off = |mission, after| MissionRequest { after: Some(after), ..proposal(mission, &[CORNER, line(1.0)]) };
    let refused = own.mission(&turns_off("n", told - 1e-6), 0.0);
    assert!(matches!(refused, Err(RequestError::Released { .. })), "{refused:?}");
    let beyond = own.mission(&turns_off("n", 9.0 + 1e-6), 0.0);
    assert!(matches!(beyond, Err(RequestError::Invalid { .. })), "{beyond:?}");
    assert!(is_admitted(&mut own, &turns_off("n", told.next_down())));
    let robot = own.robot("a").unwrap();
    assert_eq!((robot.notified_limit, robot.course.length()), (told, told + 1.0));
}
