//! Speed plans that are nowhere faster than a motion: against a fine dynamic program and the definition, in every format, and
//! known answers.

use crate::speed::{CASES, GRID, line, scene};
use pcr_core::{InvalidInput, Motion, SearchNode, SpeedPlan, SpeedPlanError, earliest_start, plan_speed_below};
use pcr_fixed::Q16;
use pcr_planning::fleet::{HostScalar, build_ecm};
use pcr_tests::disc::{Course, Disc, Drive, Driven, Leg};
use pcr_tests::generators::Dice;
use pcr_tests::oracle::contact::Meeting;
use std::f64::consts::PI;

/// The fastest motion over 4 m at 1 m/s² with two speeds: down from the one to the other on the way, or a stop of some seconds between them.
fn two_speeds(dice: &mut Dice) -> Vec<(f64, f64)> {
    let steps = |dice: &mut Dice, most: usize| 0.05 * (4 + dice.below(most - 3)) as f64;
    let fast = steps(dice, 20);
    if dice.chance(0.5) {
        let slow = steps(dice, (fast / 0.05).round() as usize);
        let cruise = 0.05 * dice.below(30) as f64;
        let rest = 4.0 - (fast * fast + fast * cruise);
        vec![(fast, 1.0), (cruise, 0.0), (fast - slow, -1.0), (rest / slow, 0.0), (slow, -1.0)]
    } else {
        let other = steps(dice, 20);
        let stand = 0.05 * dice.below(60) as f64;
        let run = |speed: f64, length: f64| [(speed, 1.0), ((length - speed * speed) / speed, 0.0), (speed, -1.0)];
        [&run(fast, 1.5)[..], &[(stand, 0.0)], &run(other, 2.5)[..]].concat()
    }
}

/// The plan of the first of the courses that is nowhere faster than its motion.
fn planned_below<S: HostScalar>(courses: &[Course<S>]) -> Result<SpeedPlan<S, 96>, SpeedPlanError<S>> {
    let fleet: Vec<Motion<'_, S>> = courses.iter().map(Course::motion).collect();
    let ecm = build_ecm(&fleet).expect("a small table");
    let mut stations = vec![SearchNode::EMPTY; 80];
    plan_speed_below(&fleet[0], ecm.row(&fleet, 0).expect("the table of the fleet"), &[], &mut stations)
}

/// A plan is nowhere faster than the motion `own`, speeds up and slows down no more than by 1 m/s², stands where that stands at least as
/// long, and meets nobody; all within `slip` \[m\].
fn audited_below<S: HostScalar>(
    ego: &Disc,
    own: &Motion<'_, S>,
    others: &[Driven],
    plan: &SpeedPlan<S, 96>,
    slip: f64,
) {
    let (own, profile) = (own.profile(), plan.profile.as_profile());
    for phase in profile.phases() {
        assert!(phase.acceleration().to_f64().abs() <= 1.0 + slip, "{phase:?}");
        for part in 0..=8 {
            let [from, to] = [phase.time().lo.to_f64(), phase.time().hi.to_f64()];
            let time = S::from_f64(from + (to - from) * f64::from(part) / 8.0);
            let length = profile.length_at(time);
            // The speed before and after a stop grows with the square root of the length.
            let square = |speed: S| speed.to_f64().powi(2);
            let limit =
                square(own.speed_at(own.first_time_at(length))).max(square(own.speed_at(own.last_time_at(length))));
            let speed = square(phase.speed_at(time));
            assert!(speed <= limit + 4.0 * slip, "{} m/s at {} m of {own:?}", speed.sqrt(), length.to_f64());
        }
    }
    for stand in own.phases().iter().filter(|phase| phase.speed() == [S::ZERO; 2] && phase.time().length() > S::ZERO) {
        let at = stand.length().lo;
        let stands = profile.phases().iter().filter(|phase| phase.speed() == [S::ZERO; 2]);
        let near = stands.filter(|phase| (phase.length().lo - at).abs().to_f64() <= slip);
        let time: f64 = near.map(|phase| phase.time().length().to_f64()).sum();
        assert!(time >= stand.time().length().to_f64() - slip, "{time} s at {} m: {profile:?}", at.to_f64());
    }
    let phases = profile.phases().iter();
    let pieces = phases.map(|phase| (phase.time().length().to_f64(), phase.acceleration().to_f64())).collect();
    let last = plan.end().to_f64();
    let smaller = (ego.grown(-slip), Drive::Pieces(0.0, pieces), plan.start.to_f64());
    for other in others {
        let end = pcr_tests::oracle::Travel::new(&other.1, other.0.length(), 0.0).time().1 + other.2;
        let met = Meeting::new(&smaller, other).contacts([-1.0, last.max(end) + 1.0], 0.0).inner;
        assert!(met.is_empty(), "{met:?} with {other:?}");
    }
}

#[test]
fn plans_below_a_motion_arrive_when_a_fine_dynamic_program_does() {
    let (mut both, mut lost, mut late, mut stops) = (0_u32, 0_u32, Vec::new(), 0);
    for seed in 0..CASES {
        let dice = &mut Dice::seeded(seed);
        let (mut ego, others) = scene(dice);
        ego.legs = vec![Leg::Line(4.0)];
        let own = Drive::Pieces(0.0, two_speeds(dice));
        let course = |driven: &Driven| Course::<f64>::driven(&driven.0, &driven.1, driven.2).expect("a valid disc");
        let mut courses = vec![course(&(ego.clone(), own.clone(), 0.0))];
        courses.extend(others.iter().map(course));
        let plan = planned_below(&courses);
        let motion = courses[0].motion();
        if let Ok(plan) = &plan {
            audited_below(&ego, &motion, &others, plan, 1e-8);
        }
        // The program knows of no time to stand.
        if motion.profile().phases().len() > 5 {
            stops += u32::from(plan.is_ok());
            continue;
        }
        let profile = motion.profile();
        let limit = |length: f64| profile.speed_at(profile.first_time_at(length));
        let latest = courses.iter().map(|course| course.motion().time().hi).fold(0.0, f64::max) + 12.0;
        match (plan, GRID.earliest_below(&ego, limit, &others, latest)) {
            (Ok(plan), Some(grid)) => {
                both += 1;
                late.extend(Some(plan.end() - grid).filter(|by| *by > 0.06));
            }
            (Err(_), Some(_)) => lost += 1,
            (_, None) => {}
        }
    }
    println!("{both} planned by both, of them late by {late:.2?} s; {lost} by the program only; {stops} with a stop");
    assert!(u64::from(both) * 3 > CASES && u64::from(stops) * 3 > CASES, "{both} and {stops} planned");
    // docs/theory/queries.md states both.
    assert!(late.iter().all(|&by| by < 0.25) && lost == 0, "{late:?} late, {lost} lost of {CASES}");
}

/// Plans below a motion in another format, for what is left of the numbers in it.
fn audited_below_in<S: HostScalar>(slip: f64) {
    let mut solved = 0;
    for seed in 0..CASES / 2 {
        let dice = &mut Dice::seeded(seed);
        let (mut ego, others) = scene(dice);
        ego.legs = vec![Leg::Line(4.0)];
        let all = [(ego, Drive::Pieces(0.0, two_speeds(dice)), 0.0)].into_iter().chain(others);
        let Some(rounded) = all.map(|driven| Course::<S>::rounded(&driven)).collect::<Option<Vec<_>>>() else {
            continue;
        };
        let (courses, driven): (Vec<_>, Vec<_>) = rounded.into_iter().unzip();
        if let Ok(plan) = planned_below(&courses) {
            audited_below(&driven[0].0, &courses[0].motion(), &driven[1..], &plan, slip);
            solved += 1;
        }
    }
    assert!(solved * 4 > CASES / 2, "{solved}");
}

#[test]
fn plans_below_a_motion_are_so_in_f32_and_q16() {
    audited_below_in::<f32>(1e-3);
    audited_below_in::<Q16>(1e-2);
}

#[test]
fn alone_the_plan_below_a_motion_is_that_motion() {
    let far = || line([0.0, 9.0, 0.0], 1.0, Drive::Unit, 0.0);
    for pieces in [
        // From rest, with a stop, a wait before the start and one after the end.
        vec![
            (2.0, 0.0),
            (1.0, 1.0),
            (1.0, -1.0),
            (3.0, 0.0),
            (1.0, 1.0),
            (1.0, 0.0),
            (1.0, -1.0),
            (0.5, 0.0),
            (0.0, 1.0),
        ],
        // Phases that last no time.
        vec![(0.0, -1.0), (1.0, 1.0), (0.0, 2.0), (3.0, 0.0), (1.0, -1.0), (0.0, 0.0)],
    ] {
        let length = if pieces.len() == 9 { 3.0 } else { 4.0 };
        let ego = line([-2.0, 0.0, 0.0], length, Drive::Pieces(0.0, pieces.clone()), 1.0);
        let own = ego.motion().time();
        let plan = planned_below(&[ego, far()]).expect("a free way");
        assert!(plan.start == 1.0 && (plan.end() - own.hi).abs() < 1e-9, "{pieces:?}: {plan:?}");
    }
    // Who is moving keeps its speeds at both ends, and cannot wait.
    let moving =
        line([-2.0, 0.0, 0.0], 4.0, Drive::Pieces(0.5, vec![(0.5, 1.0), (2.0, 0.0), (0.5, -1.0), (2.5, 0.0)]), 0.0);
    let own = moving.motion().time();
    let plan = planned_below(&[moving, far()]).expect("a free way");
    assert!(plan.start == 0.0 && (plan.end() - own.hi).abs() < 1e-9, "{plan:?}");
    // One speed without any acceleration cannot be changed.
    let steady = || line([-2.0, 0.0, 0.0], 4.0, Drive::Pieces(0.5, vec![(8.0, 0.0)]), 0.0);
    let crosses = line([0.0, -2.0, PI / 2.0], 4.0, Drive::Pieces(0.5, vec![(8.0, 0.0)]), 0.0);
    assert!(matches!(planned_below(&[steady(), crosses]), Err(SpeedPlanError::Beyond { other: 1, .. })));
    // More phases than cells.
    let many: Vec<_> = (0..100).flat_map(|_| [(0.1, 1.0), (0.3, 0.0), (0.1, -1.0)]).collect();
    let many = line([-2.0, 0.0, 0.0], 4.0, Drive::Pieces(0.0, many), 0.0);
    assert_eq!(planned_below(&[many]).err(), Some(SpeedPlanError::Invalid(InvalidInput::Full("station"))));
}

/// An agent with a lower limit on a part of its path, which has to leave its start early and to let somebody pass on the way, for which no
/// start delay helps.
#[test]
fn who_is_slow_on_a_part_waits_on_the_way() {
    let pieces = vec![(1.0, 1.0), (3.02, 0.0), (0.8, -1.0), (19.9, 0.0), (0.2, -1.0)];
    let ego = line([-2.0, 0.0, 0.0], 8.0, Drive::Pieces(0.0, pieces), 0.0);
    let crosses = line([1.0, -0.55, PI / 2.0], 3.0, Drive::Limits(0.05, 1.0), 0.0);
    let passes_start = line([-2.0, -4.0, PI / 2.0], 9.0, Drive::Limits(1.0, 1.0), 0.0);
    let courses = [ego, crosses, passes_start];
    let fleet: Vec<Motion<'_, f64>> = courses.iter().map(Course::motion).collect();
    let ecm = build_ecm(&fleet).expect("a small table");
    assert_eq!(earliest_start(ecm.row(&fleet, 0).expect("the table of the fleet"), 0.0), None);
    let plan = planned_below(&courses).expect("a plan");
    let profile = plan.profile.as_profile();
    assert!(plan.start < 4.0 && plan.end() < 24.92 + 22.0, "{plan:?}");
    let slow = profile.phases().iter().filter(|phase| phase.length().lo >= 4.0 - 1e-9);
    assert!(slow.flat_map(|phase| phase.speed()).all(|speed| speed <= 0.2 + 1e-9), "{plan:?}");
}

#[test]
fn a_last_phase_beyond_the_path_is_refused() {
    // The path ends 3 µm before the profile, which is within its tolerance; the last phase begins 1 µm before its own end.
    let pieces = vec![(1.0, 1.0), (3.000_002, 0.0), (0.999, -1.0), (0.001, -1.0)];
    let ego = line([-2.0, 0.0, 0.0], 4.0 - 1e-6, Drive::Pieces(0.0, pieces), 0.0);
    assert_eq!(
        planned_below(&[ego]).err(),
        Some(SpeedPlanError::Invalid(InvalidInput::OutOfRange("length of a phase")))
    );
}

/// It had one cell, a quarter of which is the least that can be blocked.
#[test]
fn a_steady_motion_passes_behind_one_that_is_gone() {
    let ego = || line([0.0, 0.0, 0.0], 20.0, Drive::Pieces(1.0, vec![(20.0, 0.0)]), 0.0);
    for start in [2.0, 4.0] {
        // Through (10, 0), 2 s after its start.
        let other = line([10.0, -2.0, PI / 2.0], 4.0, Drive::Pieces(1.0, vec![(4.0, 0.0)]), start);
        let plan = planned_below(&[ego(), other]).expect("its own motion");
        assert!(plan.start == 0.0 && (plan.end() - 20.0).abs() < 1e-9, "{plan:?}");
    }
}
