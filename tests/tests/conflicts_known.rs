//! Conflicts of given motions whose answers are known.

use pcr_core::{Conflict, Encounter, Interval, MismatchError, Motion, first_conflict, first_overlap};
use pcr_fixed::Q16;
use pcr_planning::fleet::{HostScalar, build_ecm};
use pcr_tests::disc::{Course, Disc, Drive, Leg};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

fn line(radius: f64, start: [f64; 3], length: f64, start_time: f64) -> Course<f64> {
    let disc = Disc { radius, start, legs: vec![Leg::Line(length)] };
    Course::driven(&disc, &Drive::Unit, start_time).expect("a valid disc")
}

fn conflicts(ego: &Course<f64>, other: &Course<f64>) -> Vec<Conflict<f64>> {
    let (ego, other) = (ego.motion(), other.motion());
    let encounter = Encounter::new(&ego, &other);
    encounter.conflicts(encounter.time()).collect()
}

fn close(value: f64, exact: f64) -> bool {
    (value - exact).abs() < 1e-12
}

#[test]
fn discs_that_meet_head_on_are_in_contact_from_r_to_r() {
    let found = conflicts(&line(0.3, [-4.0, 0.0, 0.0], 8.0, 0.0), &line(0.2, [4.0, 0.3, PI], 8.0, 0.0));
    let [conflict] = found[..] else { panic!("{found:?}") };
    // Offset 0.3 of R = 0.5: contact while they are within 0.4 along the line, at a relative speed of 2.
    assert!(close(conflict.time.lo, 3.8) && close(conflict.time.hi, 4.2), "{conflict:?}");
    assert!(close(conflict.depth, 0.2) && close(conflict.deepest.time, 4.0) && !conflict.touching);
    assert!(close(conflict.length.lo, 3.8) && close(conflict.other_length.hi, 4.2));
}

#[test]
fn discs_that_just_touch_are_reported_as_touching() {
    let found = conflicts(&line(0.25, [-4.0, 0.0, 0.0], 8.0, 0.0), &line(0.25, [4.0, 0.5, PI], 8.0, 0.0));
    let [conflict] = found[..] else { panic!("{found:?}") };
    assert!(conflict.touching && conflict.depth < 1e-9 && conflict.time.contains(4.0), "{conflict:?}");
    assert!(conflict.time.length() < 1e-4);
    // Following at the distance of a contact, from departure to arrival.
    let found = conflicts(&line(0.25, [0.0, 0.0, 0.0], 8.0, 0.0), &line(0.25, [-0.5, 0.0, 0.0], 8.0, 0.0));
    let [conflict] = found[..] else { panic!("{found:?}") };
    assert!(conflict.touching && close(conflict.time.lo, 0.0) && close(conflict.time.hi, 8.0), "{conflict:?}");
}

#[test]
fn grazing_pairs_are_told_apart_down_to_1e_8() {
    let circle = |radius: f64, start: [f64; 3], turn: f64| {
        let disc = Disc { radius: 0.25, start, legs: vec![Leg::arc(radius, turn * TAU)] };
        Course::<f64>::driven(&disc, &Drive::Unit, 0.0).expect("a valid disc")
    };
    for exponent in 2..=8 {
        for sign in [-1.0, 1.0] {
            let gap = sign * 10_f64.powi(-exponent);
            let cases = [
                ("opposite lines", line(0.25, [-4.0, 0.0, 0.0], 8.0, 0.0), line(0.25, [4.0, 0.5 + gap, PI], 8.0, 0.0)),
                // Nearest at √½ of the delay.
                (
                    "crossing lines",
                    line(0.25, [-4.0, 0.0, 0.0], 8.0, 0.0),
                    line(0.25, [0.0, -4.0, FRAC_PI_2], 8.0, (0.5 + gap) * 2_f64.sqrt()),
                ),
                (
                    "concentric arcs",
                    circle(2.0, [0.0, -2.0, 0.0], 1.0),
                    circle(2.5 + gap, [0.0, -2.5 - gap, 0.0], -1.0),
                ),
                (
                    "a line tangent to an arc",
                    line(0.25, [-4.0, -2.5 - gap, 0.0], 8.0, 0.0),
                    circle(2.0, [0.0, 2.0, PI], 1.0),
                ),
            ];
            for (name, ego, other) in &cases[..3] {
                let found = conflicts(ego, other);
                assert_eq!(found.is_empty(), gap > 0.0, "{name} at {gap:e}: {found:?}");
                for conflict in found {
                    assert!((conflict.depth + gap).abs() < 1e-9, "{name} at {gap:e}: {conflict:?}");
                }
            }
            // The disc on the arc passes the lowest point after half a turn, when the other is there, too.
            let (_, ego, other) = &cases[3];
            let half_turn = 2.0 * PI;
            let ego = ego.motion().delayed(half_turn - 4.0).expect("a valid delay");
            let other = other.motion();
            let encounter = Encounter::new(&ego, &other);
            let found: Vec<_> = encounter.conflicts(encounter.time()).collect();
            assert_eq!(found.is_empty(), gap > 0.0, "line and arc at {gap:e}: {found:?}");
        }
    }
}

#[test]
fn discs_that_follow_each_other_in_contact_on_a_circle_cost_the_stated_steps() {
    let circle = |heading: f64| {
        let (sin, cos) = heading.sin_cos();
        let disc = Disc { radius: 0.25, start: [2.0 * sin, -2.0 * cos, heading], legs: vec![Leg::arc(2.0, TAU)] };
        Course::<f64>::driven(&disc, &Drive::Unit, 0.0).expect("a valid disc")
    };
    // A chord of 2 · 2 sin(φ/2) = 0.5.
    let ahead = 2.0 * 0.125_f64.asin();
    let (ego, other) = (circle(0.0), circle(ahead));
    let (ego, other) = (ego.motion(), other.motion());
    let encounter = Encounter::new(&ego, &other);
    let mut contacts = encounter.contacts(encounter.time());
    let all: Vec<_> = contacts.by_ref().collect();
    assert_eq!(all, [encounter.time()]);
    // c = 2 v²/ϱ = 1.
    let smallest = (2.0 * encounter.tolerance()).sqrt();
    let bound = 4.0 * encounter.time().length() / smallest + 1.0;
    assert!(contacts.steps() > 0 && f64::from(contacts.steps()) < bound, "{} of {bound}", contacts.steps());
}

/// Side by side at the distance of a contact, nothing of the geometry decides; that they go alike does.
#[test]
fn discs_that_go_alike_cost_a_few_steps() {
    fn steps<S: HostScalar>(legs: &[Leg]) -> u32 {
        let beside = |y: f64| {
            let disc = Disc { radius: 0.25, start: [0.0, y, 0.0], legs: legs.to_vec() };
            Course::<S>::driven(&disc, &Drive::Limits(1.0, 0.5), 0.0).expect("a valid disc")
        };
        let (ego, other) = (beside(0.0), beside(0.5));
        let (ego, other) = (ego.motion(), other.motion());
        let encounter = Encounter::new(&ego, &other);
        let mut contacts = encounter.contacts(encounter.time());
        let all: Vec<_> = contacts.by_ref().collect();
        assert_eq!(all, [encounter.time()], "{}", S::NAME);
        contacts.steps()
    }
    let legs = [Leg::Line(8.0), Leg::arc(2.0, 1.0), Leg::Line(2.0)];
    for legs in [&legs[..1], &legs] {
        let steps = [steps::<f64>(legs), steps::<f32>(legs), steps::<Q16>(legs)];
        assert!(steps.iter().all(|&steps| steps < 40), "{steps:?}");
    }
}

#[test]
fn agents_that_stand_are_in_conflict_all_the_time_or_never() {
    let standing = |x: f64| {
        let disc = Disc { radius: 0.5, start: [x, 0.0, 0.0], legs: Vec::new() };
        Course::<f64>::driven(&disc, &Drive::Unit, 2.0).expect("a valid disc")
    };
    let (a, b, c) = (standing(0.0), standing(0.9), standing(1.1));
    let (a, b, c) = (a.motion(), b.motion(), c.motion());
    for during in [Interval::new(0.0, 7.0), Interval::new(2.0, 2.0)] {
        let found: Vec<_> = Encounter::new(&a, &b).conflicts(during).collect();
        assert!(found.len() == 1 && found[0].time == during && close(found[0].depth, 0.1), "{found:?}");
        assert_eq!(Encounter::new(&a, &c).conflicts(during).next(), None);
        assert!(close(Encounter::new(&a, &c).closest(during).separation, 1.1));
    }
}

#[test]
fn the_first_conflict_with_a_row_has_known_answers() {
    let first = |courses: &[Course<f64>]| {
        let fleet: Vec<Motion<'_, f64>> = courses.iter().map(Course::motion).collect();
        let ecm = build_ecm(&fleet).expect("a small table");
        first_conflict(&fleet[0], ecm.row(&fleet, 0).expect("the table of the fleet"), Interval::new(-1.0, 20.0))
            .expect("its own row")
            .map(|met| (met.other, met.conflict))
    };
    let ego = || line(0.25, [-4.0, 0.0, 0.0], 8.0, 0.0);
    // Two cross at right angles, the later one listed first: √2 v |t - 4 ∓ ...| <= R around 4 s and 2 s.
    let crossing = |x: f64, start: f64| line(0.25, [x, -2.0, FRAC_PI_2], 4.0, start);
    let (other, conflict) = first(&[ego(), crossing(0.0, 2.0), crossing(-2.0, 0.0)]).expect("a conflict");
    assert_eq!(other, 2);
    let half = 0.5 / 2_f64.sqrt();
    assert!(close(conflict.time.lo, 2.0 - half) && close(conflict.time.hi, 2.0 + half) && close(conflict.depth, 0.5));
    // Head-on on one line: they meet at a relative speed of 2 m/s, R before the middle; and stay in contact until they part.
    let (other, conflict) = first(&[ego(), line(0.25, [4.0, 0.0, PI], 8.0, 0.0)]).expect("a conflict");
    assert!(other == 1 && close(conflict.time.lo, 3.75) && close(conflict.time.hi, 4.25), "{conflict:?}");
    // Following by 0.6 m keeps 0.1 m of clearance, by 0.4 m it overlaps by 0.1 m all the way.
    assert_eq!(first(&[ego(), line(0.25, [-3.4, 0.0, 0.0], 8.0, 0.0)]), None);
    let (_, conflict) = first(&[ego(), line(0.25, [-3.6, 0.0, 0.0], 8.0, 0.0)]).expect("a conflict");
    assert!(close(conflict.depth, 0.1) && !conflict.touching, "{conflict:?}");
    // Passing at the distance of a contact.
    let (_, conflict) = first(&[ego(), line(0.25, [4.0, 0.5, PI], 8.0, 0.0)]).expect("touching");
    assert!(conflict.touching, "{conflict:?}");
}

/// The regions say nothing about a larger disc or another path.
#[test]
fn a_row_answers_for_its_own_path_and_no_larger_disc() {
    let near = [line(0.25, [-4.0, 0.0, 0.0], 8.0, 0.0), line(0.25, [4.0, 0.4, PI], 8.0, 0.0)];
    let near = near.each_ref().map(Course::motion);
    let ecm = build_ecm(&near).expect("a small table");
    let during = Interval::new(0.0, 8.0);
    let ask = |ego: &Motion<'_, f64>| {
        let row = || ecm.row(&near, 0).expect("the table of the fleet");
        let answers = [first_conflict(ego, row(), during), first_overlap(ego, row(), during)];
        assert_eq!(answers[0].map(|met| met.is_some()), answers[1].map(|met| met.is_some()));
        answers[0].map(|met| met.is_some())
    };
    let [smaller, larger] = [0.2, 0.3].map(|radius| line(radius, [-4.0, 0.0, 0.0], 8.0, 0.0));
    let elsewhere = line(0.25, [-4.0, -0.05, 0.0], 8.0, 0.0);
    assert_eq!(ask(&near[0]), Ok(true));
    assert_eq!(ask(&near[0].delayed(1.0).expect("a delay")), Ok(true));
    assert_eq!(ask(&smaller.motion()), Ok(true));
    assert_eq!(ask(&larger.motion()), Err(MismatchError::OtherFleet));
    assert_eq!(ask(&elsewhere.motion()), Err(MismatchError::OtherFleet));
}
