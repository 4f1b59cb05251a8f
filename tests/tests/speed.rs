//! Speed plans: against a fine dynamic program and the definition, in every format, and known answers.

use pcr_core::{
    Constraint, Interval, InvalidInput, Limits, MismatchError, Motion, Profile, SearchNode, SpeedPlan, SpeedPlanError,
    SpeedPlanLimits as Speeds, plan_speed, plan_speeds, scalar::Micro,
};
use pcr_fixed::{Q12, Q16, Q20};
use pcr_planning::fleet::{HostScalar, build_ecm};
use pcr_tests::disc::{Course, Disc, Drive, Driven, Leg};
use pcr_tests::generators::{Dice, leg};
use pcr_tests::oracle::contact::Meeting;
use pcr_tests::velocity::Grid;
use std::f64::consts::{FRAC_PI_2, PI};

pub(crate) const CASES: u64 = if cfg!(optimized) { 400 } else { 40 };
pub(crate) const GRID: Grid = Grid { step: 0.05, acceleration: 1.0, speeds: 20, lengths: 3200 };

/// The plan of the first of the courses against the others.
fn planned<S: HostScalar>(courses: &[Course<S>], drive: Speeds<S>) -> Result<SpeedPlan<S, 48>, SpeedPlanError<S>> {
    constrained(courses, drive, &[])
}

/// The same under constraints.
fn constrained<S: HostScalar>(
    courses: &[Course<S>],
    drive: Speeds<S>,
    constraints: &[Constraint<S>],
) -> Result<SpeedPlan<S, 48>, SpeedPlanError<S>> {
    let fleet: Vec<Motion<'_, S>> = courses.iter().map(Course::motion).collect();
    let ecm = build_ecm(&fleet).expect("a small table");
    let mut stations = vec![SearchNode::EMPTY; 40];
    plan_speed(&fleet[0], drive, ecm.row(&fleet, 0).expect("the table of the fleet"), constraints, &mut stations)
}

fn limits<S: HostScalar>() -> Limits<S> {
    Limits { speed: S::from_f64(1.0), acceleration: S::from_f64(1.0) }
}

/// An ego of 4 m that drives at 1 m/s and 1 m/s² at most, and two to five others that cross its way.
pub(crate) fn scene(dice: &mut Dice) -> (Disc, Vec<Driven>) {
    let bent = dice.chance(0.5);
    let legs = if bent { vec![Leg::Line(1.5), Leg::arc(0.8, 1.25), Leg::Line(1.5)] } else { vec![Leg::Line(4.0)] };
    let ego = Disc { radius: dice.range(0.1, 0.3), start: [-2.0, 0.0, 0.0], legs };
    let other = |dice: &mut Dice| {
        let start = [dice.range(-2.5, 2.5), dice.range(-2.5, 2.5), dice.range(-PI, PI)];
        let legs = (0..1 + dice.below(3)).map(|_| leg(dice)).collect();
        let other = Disc { radius: dice.range(0.1, 0.3), start, legs };
        (other, Drive::Limits(dice.range(0.3, 1.5), dice.range(0.5, 2.0)), dice.range(0.0, 6.0))
    };
    let others = (0..2 + dice.below(4)).map(|_| other(dice)).collect();
    (ego, others)
}

#[test]
fn regions_of_another_agent_or_of_a_smaller_disc_are_refused() {
    let dice = &mut Dice::seeded(1);
    let (ego, others) = scene(dice);
    let larger = Disc { radius: ego.radius + 0.1, ..ego.clone() };
    let courses: Vec<Course<f64>> = core::iter::once((ego, Drive::Limits(1.0, 1.0), 0.0))
        .chain(others)
        .map(|(disc, drive, start)| Course::driven(&disc, &drive, start).expect("small"))
        .collect();
    let fleet: Vec<_> = courses.iter().map(Course::motion).collect();
    let ecm = build_ecm(&fleet).expect("a small table");
    let larger = Course::driven(&larger, &Drive::Limits(1.0, 1.0), 0.0).expect("small");
    let mut stations = vec![SearchNode::EMPTY; 40];
    let mut plan = |ego: &Motion<'_, f64>, agent| {
        let drive = Speeds::rest_to_rest(limits());
        let regions = ecm.row(&fleet, agent).expect("the table of the fleet");
        plan_speed::<_, 48>(ego, drive, regions, &[], &mut stations).err()
    };
    let agent = (1..fleet.len()).find(|&agent| ecm.row(&fleet, agent).expect("the table").next().is_some());
    let refused = Some(SpeedPlanError::Mismatch(MismatchError::OtherFleet));
    assert_eq!(plan(&fleet[0], agent.expect("regions")), refused);
    assert!(ecm.row(&fleet, 0).expect("the table").next().is_some());
    assert_eq!(plan(&larger.motion(), 0), refused);
    assert_ne!(plan(&fleet[0], 0), refused);
}

/// The motion of a plan as the oracle takes it.
fn driven<S: HostScalar>(ego: &Disc, plan: &SpeedPlan<S, 48>) -> Driven {
    let phases = plan.profile.as_profile().phases();
    let pieces = phases.iter().map(|phase| (phase.time().length().to_f64(), phase.acceleration().to_f64()));
    let speed = phases.first().map_or(0.0, |first| first.speed()[0].to_f64());
    (ego.clone(), Drive::Pieces(speed, pieces.collect()), plan.start.to_f64())
}

/// Limits are kept and nobody is met, by the definition; all within `slip` \[m\].
fn audited<S: HostScalar>(ego: &Disc, others: &[Driven], plan: &SpeedPlan<S, 48>, slip: f64) {
    let ego = driven(ego, plan);
    let Drive::Pieces(mut speed, pieces) = ego.1.clone() else { unreachable!("pieces") };
    for (duration, acceleration) in &pieces {
        speed += duration * acceleration;
        assert!(acceleration.abs() <= 1.0 && -slip <= speed && speed <= 1.0 + slip, "{pieces:?}");
    }
    assert!(speed.abs() <= slip, "comes to rest: {pieces:?}");
    let end = plan.start.to_f64() + plan.profile.as_profile().duration().to_f64();
    for other in others {
        let last = (other.2 + pcr_tests::oracle::Travel::new(&other.1, other.0.length(), 0.0).time().1).max(end) + 1.0;
        let smaller = (ego.0.grown(-slip), ego.1.clone(), ego.2);
        let met = Meeting::new(&smaller, other).contacts([-1.0, last], 0.0).inner;
        assert!(met.is_empty(), "{met:?} with {other:?}");
    }
}

#[test]
fn plans_arrive_when_a_fine_dynamic_program_does_and_meet_nobody() {
    let (mut both, mut lost, mut neither, mut late) = (0_u32, 0_u32, 0_u32, Vec::new());
    for seed in 0..CASES {
        let (ego, others) = scene(&mut Dice::seeded(seed));
        let course = |driven: &Driven| Course::<f64>::driven(&driven.0, &driven.1, driven.2).expect("a valid disc");
        let mut courses = vec![course(&(ego.clone(), Drive::Limits(1.0, 1.0), 0.0))];
        courses.extend(others.iter().map(course));
        let plan = planned(&courses, Speeds::rest_to_rest(limits()));
        let latest = courses.iter().map(|course| course.motion().time().hi).fold(0.0, f64::max) + 12.0;
        if let Ok(plan) = &plan {
            audited(&ego, &others, plan, 1e-8);
        }
        match (plan, GRID.earliest(&ego, &others, latest)) {
            (Ok(plan), Some(grid)) => {
                both += 1;
                late.extend(Some(plan.start + plan.profile.as_profile().duration() - grid).filter(|by| *by > 0.06));
            }
            (Ok(_), None) => panic!("seed {seed}: the grid has none"),
            (Err(_), Some(_)) => lost += 1,
            (Err(_), None) => neither += 1,
        }
    }
    println!("{both} planned by both, of them late by {late:.1?} s; {lost} by the program only, {neither} by neither");
    assert!(both > 2 * neither && neither > 0, "{both} planned");
    // docs/theory/queries.md states both shares.
    assert!(
        late.len() as u64 * 200 <= CASES && u64::from(lost) * 200 <= CASES,
        "{late:?} late, {lost} lost of {CASES}"
    );
}

/// Plans in another format, for what is left of the numbers in it.
fn audited_in<S: HostScalar>(slip: f64) {
    let mut solved = 0;
    for seed in 0..CASES / 4 {
        let (ego, others) = scene(&mut Dice::seeded(seed));
        let all = [(ego, Drive::Limits(1.0, 1.0), 0.0)].into_iter().chain(others);
        let rounded = all.map(|driven| Course::<S>::rounded(&driven).expect("a valid disc"));
        let (courses, driven): (Vec<_>, Vec<_>) = rounded.unzip();
        if let Ok(plan) = planned(&courses, Speeds::rest_to_rest(limits::<S>())) {
            audited(&driven[0].0, &driven[1..], &plan, slip);
            solved += 1;
        }
    }
    assert!(solved * 2 > CASES / 4, "{solved}");
}

#[test]
fn plans_meet_nobody_in_f32_and_q16() {
    audited_in::<f32>(5e-4);
    audited_in::<Q16>(5e-3);
}

pub(crate) fn line(start: [f64; 3], length: f64, drive: Drive, at: f64) -> Course<f64> {
    let disc = Disc { radius: 0.25, start, legs: vec![Leg::Line(length)] };
    Course::driven(&disc, &drive, at).expect("a valid disc")
}

fn ego() -> Course<f64> {
    line([-2.0, 0.0, 0.0], 4.0, Drive::Limits(1.0, 1.0), 0.0)
}

fn arrival(courses: &[Course<f64>]) -> Result<f64, SpeedPlanError<f64>> {
    let plan = planned(courses, Speeds::rest_to_rest(limits()))?;
    Ok(plan.start + plan.profile.as_profile().duration())
}

#[test]
fn a_free_way_takes_the_trapezoid() {
    let far = line([0.0, 9.0, 0.0], 1.0, Drive::Unit, 0.0);
    assert!((arrival(&[ego(), far]).unwrap() - 5.0).abs() < 1e-12);
}

#[test]
fn at_a_crossing_the_later_one_passes_behind() {
    // Both would be there at 2.5 s; at the same speed the one has to pass R √2 behind the other.
    let other = line([0.0, -2.0, PI / 2.0], 4.0, Drive::Limits(1.0, 1.0), 0.0);
    assert!((arrival(&[ego(), other]).unwrap() - 5.0 - 0.5 * 2.0_f64.sqrt()).abs() < 1e-6);
}

#[test]
fn a_leader_is_followed_at_the_distance_of_the_radii() {
    // It goes ahead at half the speed and leaves the end of the ego's way behind by R after 3.9 m.
    let leader = line([-1.4, 0.0, 0.0], 8.0, Drive::Pieces(0.5, vec![(16.0, 0.0)]), 0.0);
    // The ego arrives as it is left: at rest, 7.8 s.
    let found = arrival(&[ego(), leader]).unwrap();
    assert!((7.8..7.8 + 1.0).contains(&found), "{found}");
}

#[test]
fn who_is_in_the_way_is_named() {
    let met = |other| arrival(&[ego(), other]);
    let head_on = line([2.0, 0.0, PI], 4.0, Drive::Limits(1.0, 1.0), 0.0);
    assert!(matches!(met(head_on), Err(SpeedPlanError::AtStart(1) | SpeedPlanError::Beyond { other: 1, .. })));
    let on_the_goal = line([2.0, -3.0, PI / 2.0], 3.0, Drive::Limits(1.0, 1.0), 0.0);
    assert_eq!(met(on_the_goal), Err(SpeedPlanError::AtGoal(1)));
    let at_the_start = line([-2.0, 0.3, PI / 2.0], 3.0, Drive::Limits(1.0, 1.0), 1.0);
    assert_eq!(met(at_the_start), Err(SpeedPlanError::AtStart(1)));
    let on_the_way = line([0.0, -3.0, PI / 2.0], 3.0, Drive::Limits(1.0, 1.0), -9.0);
    assert!(
        matches!(met(on_the_way), Err(SpeedPlanError::Beyond { other: 1, length }) if (1.2..=1.5).contains(&length))
    );
}

#[test]
fn speeds_at_the_ends_are_kept() {
    let far = line([0.0, 9.0, 0.0], 1.0, Drive::Unit, 0.0);
    let drive = Speeds { limits: limits(), start: 0.6, goal: 0.3 };
    let plan = planned(&[ego(), far], drive).unwrap();
    let phases = plan.profile.as_profile();
    assert!((phases.speed_at(0.0) - 0.6).abs() < 1e-12 && (phases.speed_at(phases.duration()) - 0.3).abs() < 1e-9);
    // Up to 1 m/s and down, at 1 m/s over the rest.
    let ramps = (1.0 - 0.36 + 1.0 - 0.09) / 2.0;
    assert!((phases.duration() - (0.4 + 0.7 + (4.0 - ramps))).abs() < 0.1, "{}", phases.duration());
}

#[test]
fn limits_and_speeds_out_of_range_are_refused() {
    let with = |speed, acceleration, start, goal| {
        planned(&[ego()], Speeds { limits: Limits { speed, acceleration }, start, goal }).map(drop)
    };
    let refused = |invalid| Err(SpeedPlanError::Invalid(invalid));
    assert_eq!(with(1.0, 1.0, 1.0, 1.0), Ok(()));
    assert_eq!(with(1.0, 1.0, 1.5, 0.0), refused(InvalidInput::OutOfRange("speed at the start")));
    assert_eq!(with(1.0, 1.0, 0.0, 1.5), refused(InvalidInput::OutOfRange("speed at the goal")));
    assert_eq!(with(1.0, 1.0, -0.1, 0.0), refused(InvalidInput::Negative("speed at the start")));
    assert_eq!(with(0.0, 1.0, 0.0, 0.0), refused(InvalidInput::NonPositive("largest speed")));
    assert_eq!(with(1.0, 0.0, 0.0, 0.0), refused(InvalidInput::NonPositive("largest acceleration")));
}

#[test]
fn who_stands_all_the_time_is_in_the_way_at_any_time() {
    let stands = || {
        let disc = Disc { radius: 0.25, start: [0.0, 0.0, 0.0], legs: vec![] };
        Course::<f64>::driven(&disc, &Drive::Unit, 0.0).expect("a valid disc")
    };
    // It passes 9 s before, or after.
    for at in [-9.0, 9.0] {
        let passes = line([0.0, -2.0, PI / 2.0], 4.0, Drive::Limits(1.0, 1.0), at);
        assert_eq!(arrival(&[stands(), passes]), Err(SpeedPlanError::AtStart(1)));
    }
    let elsewhere = line([2.0, -2.0, PI / 2.0], 4.0, Drive::Limits(1.0, 1.0), 0.0);
    assert_eq!(arrival(&[stands(), elsewhere]), Ok(0.0));
}

#[test]
fn a_plan_ends_its_duration_after_its_start() {
    let other = line([0.0, -2.0, PI / 2.0], 4.0, Drive::Limits(1.0, 1.0), 0.0);
    let plan = planned(&[ego(), other], Speeds::rest_to_rest(limits())).expect("a plan");
    assert!(plan.start > 0.1);
    assert_eq!(plan.end(), plan.start + plan.profile.as_profile().duration());
}

#[test]
fn an_agent_in_motion_slows_down_for_one_that_crosses() {
    let other = || line([0.0, -2.0, PI / 2.0], 4.0, Drive::Pieces(1.0, vec![(4.0, 0.0)]), 0.0);
    let drive = Speeds { limits: limits(), start: 1.0, goal: 0.0 };
    let plan = planned(&[ego(), other()], drive).unwrap();
    assert_eq!(plan.start, 0.0);
    // Without the other it takes 4.5 s, and passing behind takes at least R √2 more.
    let least = 4.5 + 0.5 * 2.0_f64.sqrt();
    let found = plan.profile.as_profile().duration();
    assert!((least - 1e-6..least + 0.5).contains(&found), "{found}");
}

/// Random constraints on the ego: they are kept by the profile, at times of its own phases, and cost time only.
fn constrained_in<S: HostScalar>(slip: f64) {
    let (mut kept, mut later) = (0, 0);
    for seed in 0..CASES / 4 {
        let dice = &mut Dice::seeded(seed);
        let (ego, others) = scene(dice);
        let all = [(ego, Drive::Limits(1.0, 1.0), 0.0)].into_iter().chain(others);
        let rounded = all.map(|driven| Course::<S>::rounded(&driven).expect("a valid disc"));
        let (courses, driven): (Vec<_>, Vec<_>) = rounded.unzip();
        let mut part = |most: f64, longest: f64| {
            let lo = dice.range(0.0, most);
            Interval::new(S::from_f64(lo), S::from_f64(lo + dice.range(0.0, longest)))
        };
        let constraints: Vec<_> = (0..3).map(|_| Constraint { length: part(4.0, 0.6), time: part(8.0, 3.0) }).collect();
        let speeds = Speeds::rest_to_rest(limits::<S>());
        let Ok(plan) = constrained(&courses, speeds, &constraints) else { continue };
        audited(&driven[0].0, &driven[1..], &plan, slip);
        let motion = courses[0].motion().with_profile(plan.profile.as_profile(), plan.start).expect("it fits");
        for tick in 0..4000 {
            let time = 0.01 * f64::from(tick);
            let length = motion.length_at(S::from_f64(time)).to_f64();
            let [from, to] = [motion.time().lo.to_f64(), f64::INFINITY];
            let inside = |all: Interval<S>, at: f64| all.lo.to_f64() + slip < at && at < all.hi.to_f64() - slip;
            let is_broken = |it: &&Constraint<S>| inside(it.time, time) && inside(it.length, length);
            let broken = constraints.iter().find(is_broken);
            assert!(!(from..to).contains(&time) || broken.is_none(), "{seed}: at {time} s, {length} m: {broken:?}");
        }
        kept += 1;
        let free = planned(&courses, speeds).expect("with less in the way");
        later += u64::from(plan.end() > free.end() + S::from_f64(0.01));
    }
    assert!(kept * 2 > CASES / 4 && later * 4 > kept, "{kept} kept, {later} later");
}

#[test]
fn constraints_are_kept_in_every_format() {
    constrained_in::<f64>(1e-8);
    constrained_in::<f32>(5e-4);
    constrained_in::<Q16>(5e-3);
}

/// Motions from rest to rest have a drive in every format; with a slower edge, a stop or a gentler brake they have none, and no plan makes
/// them faster.
fn driven_in<S: HostScalar>() {
    let dice = &mut Dice::seeded(7);
    for _ in 0..400 {
        let (speed, acceleration) = (dice.range(0.05, 4.0), dice.range(0.05, 4.0));
        let disc = Disc { radius: 0.2, start: [0.0; 3], legs: vec![Leg::Line(dice.range(0.05, 40.0))] };
        let course = Course::<S>::driven(&disc, &Drive::Limits(speed, acceleration), 0.0).expect("a valid disc");
        let drive =
            Speeds::of(&course.motion()).unwrap_or_else(|| panic!("{speed} m/s, {acceleration} m/s², {disc:?}"));
        assert!(
            drive.start == S::ZERO
                && drive.goal == S::ZERO
                && drive.limits.acceleration.to_f64() <= 1.01 * acceleration
        );
    }
    let disc = Disc { radius: 0.2, start: [0.0; 3], legs: vec![Leg::Line(8.0)] };
    let course = |pieces: &[(f64, f64)]| {
        Course::<S>::driven(&disc, &Drive::Pieces(0.0, pieces.to_vec()), 0.0).expect("a valid disc")
    };
    for pieces in [
        // 0.2 m/s on the second half; a stop; 0.5 m/s² to a stop, 1 m/s² from rest.
        &[(1.0, 1.0), (3.02, 0.0), (0.8, -1.0), (19.9, 0.0), (0.2, -1.0)][..],
        &[(1.0, 1.0), (3.0, 0.0), (1.0, -1.0), (2.0, 0.0), (1.0, 1.0), (3.0, 0.0), (1.0, -1.0)],
        &[(1.0, 1.0), (6.5, 0.0), (2.0, -0.5)],
    ] {
        let slow = course(pieces);
        assert_eq!(Speeds::of(&slow.motion()), None, "{pieces:?}");
        let fleet = [slow.motion()];
        let (ecm, mut plan) = (build_ecm(&fleet).expect("a small table"), fleet.to_vec());
        let mut profiles = [Profile::<S, 16>::standing()];
        plan_speeds(&ecm, &fleet, &mut plan, &mut [0], &mut profiles, &mut [SearchNode::EMPTY; 100]).expect("a plan");
        assert_eq!(plan[0].time(), fleet[0].time(), "{pieces:?}");
    }
    assert!(Speeds::of(&course(&[(1.0, 1.0), (7.0, 0.0), (1.0, -1.0)]).motion()).is_some());
}

#[test]
fn who_is_slow_for_a_reason_has_no_drive() {
    driven_in::<f64>();
    driven_in::<f32>();
    driven_in::<Micro>();
    driven_in::<Q12>();
    driven_in::<Q16>();
    driven_in::<Q20>();
}

/// One agent that drives 4 m at 1 m/s and 1 m/s² at most, and is not to be on \[2 m, 3 m\] for some time.
#[test]
fn a_constraint_is_passed_behind_or_before() {
    let ego = Disc { radius: 0.2, start: [0.0; 3], legs: vec![Leg::Line(4.0)] };
    let course = [Course::<f64>::driven(&ego, &Drive::Limits(1.0, 1.0), 0.0).expect("a valid disc")];
    let speeds = Speeds::rest_to_rest(limits());
    let plan = |length: [f64; 2], time: [f64; 2]| {
        let [length, time] = [length, time].map(|[lo, hi]| Interval::new(lo, hi));
        constrained(&course, speeds, &[Constraint { length, time }])
    };
    let end = |length, time| plan(length, time).expect("a plan").end();
    // Alone it takes 5 s and is on [2, 3] from 2.5 s to 3.5 s.
    assert!((end([2.0, 3.0], [3.5, 9.0]) - 5.0).abs() < 1e-9);
    assert!((end([2.0, 3.0], [-9.0, 2.5]) - 5.0).abs() < 1e-9);
    // At full speed at 2 m after 6 s.
    assert!((end([2.0, 3.0], [1.0, 6.0]) - 8.5).abs() < 1e-6);
    // However short the lengths are: one place, in the middle and at the goal, on both borders of a cell and between.
    for at in [0.5, 1.0, 1.7, 2.0, 3.0] {
        let (passes, late) = (end([at; 2], [-9.0, 9.0]), end([0.0; 2], [-9.0, -8.0]));
        assert!(passes > late + 1.0, "at {at} m: {passes} s");
    }
    assert!((end([2.0; 2], [1.0, 6.0]) - 8.5).abs() < 1e-6);
    assert!((end([4.0; 2], [1.0, 7.0]) - 7.0).abs() < 1e-6);
    // What is over when it sets off does not count, at its start neither.
    assert!((end([0.0, 1.0], [-9.0, 0.0]) - 5.0).abs() < 1e-9);
    assert!((end([0.0, 0.0], [0.5, 0.6]) - 5.0).abs() < 1e-9);
    assert_eq!(plan([0.0, 1.0], [-1.0, 0.5]).err(), Some(SpeedPlanError::Constrained { length: 0.0 }));
    assert_eq!(plan([3.5, 5.0], [0.0, f64::MAX]).err(), Some(SpeedPlanError::Constrained { length: 4.0 }));
    assert!(matches!(plan([1.0, 2.0], [0.0, f64::MAX]), Err(SpeedPlanError::Constrained { length }) if length <= 1.0));
    for wrong in [[2.0, 1.0], [f64::NAN, 1.0], [0.0, f64::NAN]] {
        assert!(matches!(plan(wrong, [0.0, 1.0]), Err(SpeedPlanError::Invalid(_))));
        assert!(matches!(plan([0.0, 1.0], wrong), Err(SpeedPlanError::Invalid(_))));
    }
}

/// An interval of time may be as long as the format allows, and longer than the times of motions.
fn forbidden_for_ever_in<S: HostScalar>(least: S, most: S) {
    let ego = Disc { radius: 0.2, start: [0.0; 3], legs: vec![Leg::Line(4.0)] };
    let course = [Course::<S>::driven(&ego, &Drive::Limits(1.0, 1.0), 0.0).expect("a valid disc")];
    let plan = |lo: S, hi: S| {
        let constraint =
            Constraint { length: Interval::new(S::from_f64(2.0), S::from_f64(3.0)), time: Interval::new(lo, hi) };
        constrained(&course, Speeds::rest_to_rest(limits()), &[constraint])
    };
    let (free, late) = (S::from_f64(5.0), S::from_f64(6.0));
    for lo in [least, -S::LIMIT, -S::from_f64(9.0)] {
        for hi in [most, S::LIMIT] {
            assert!(matches!(plan(lo, hi), Err(SpeedPlanError::Constrained { .. })), "{}: {lo:?} to {hi:?}", S::NAME);
        }
        let slow = plan(lo, late).expect("a plan").end();
        assert!(slow > late + S::from_f64(1.0), "{}: {lo:?} to 6 s: {slow:?}", S::NAME);
    }
    for [lo, hi] in [[least, least], [most, most], [least, -S::LIMIT], [S::LIMIT, most]] {
        let end = plan(lo, hi).expect("a plan").end();
        assert!((end - free).abs() < S::from_f64(0.01), "{}: {lo:?} to {hi:?}: {end:?}", S::NAME);
    }
}

#[test]
fn constraints_hold_up_to_the_ends_of_every_format() {
    forbidden_for_ever_in::<f64>(f64::NEG_INFINITY, f64::INFINITY);
    forbidden_for_ever_in::<f32>(f32::MIN, f32::MAX);
    forbidden_for_ever_in::<Q16>(Q16::from_bits(i32::MIN), Q16::from_bits(i32::MAX));
    forbidden_for_ever_in::<Q20>(Q20::from_bits(i32::MIN), Q20::from_bits(i32::MAX));
}

/// With each order of passing the ego is on the right side of the region, and one of the two is the plan without orders.
#[test]
fn an_order_of_passing_is_kept() {
    let mut both = 0;
    for seed in 0..200 {
        let (ego, others) = scene(&mut Dice::seeded(seed));
        let course = |driven: &Driven| Course::<f64>::driven(&driven.0, &driven.1, driven.2).expect("a valid disc");
        let courses: Vec<_> = [(ego, Drive::Limits(1.0, 1.0), 0.0)].iter().chain(others.first()).map(course).collect();
        let fleet: Vec<Motion<'_, f64>> = courses.iter().map(Course::motion).collect();
        let ecm = build_ecm(&fleet).expect("a small table");
        let regions: Vec<_> = ecm.row(&fleet, 0).expect("the table of the fleet").collect();
        let [region] = &regions[..] else { continue };
        let speeds = Speeds::rest_to_rest(limits());
        let plans =
            [Constraint::before(region), Constraint::after(region)].map(|it| constrained(&courses, speeds, &[it]));
        for (plan, is_before) in plans.iter().zip([true, false]) {
            let Ok(plan) = plan else { continue };
            let motion = fleet[0].with_profile(plan.profile.as_profile(), plan.start).expect("it fits");
            let own = motion.time_in(region.length());
            let theirs = region.time();
            assert!(
                if is_before { own.hi < theirs.lo + 1e-6 } else { theirs.hi < own.lo + 1e-6 },
                "{seed}: {own:?} {theirs:?}"
            );
        }
        if let [Ok(before), Ok(after)] = &plans {
            both += 1;
            assert!(before.end() <= after.end(), "{seed}: who goes first is there first");
        }
    }
    assert!(both > 10, "{both}");
}

/// What had passed before the start took all room for blocked windows, and what was behind was blocked as a whole.
#[test]
fn many_that_pass_before_and_after_leave_the_time_between() {
    let passes = |at: f64| line([0.0, -2.5, PI / 2.0], 5.0, Drive::Pieces(1.0, vec![(5.0, 0.0)]), at - 2.5);
    let ego = || line([-2.0, 0.0, 0.0], 4.0, Drive::Limits(1.0, 1.0), 94.5);
    let parks = line([0.0, -2.5, PI / 2.0], 2.5, Drive::Limits(1.0, 1.0), 300.0);
    let all: Vec<Course<f64>> = std::iter::once(ego()).chain((1..=12).map(|k| passes(10.0 * f64::from(k)))).collect();
    let with: Vec<Course<f64>> = all.into_iter().chain([parks]).collect();
    // It crosses at 97 s: nobody is there from 91 s to 99 s.
    assert!((arrival(&with).unwrap() - 99.5).abs() < 1e-9);
}

/// Who starts within the region is there already: nobody passes before him. The order let the ego through him.
#[test]
fn nobody_passes_before_who_starts_there() {
    let disc = |start, length| Disc { radius: 0.3, start, legs: vec![Leg::Line(length)] };
    let discs = [disc([-3.0, 0.0, 0.0], 6.0), disc([0.0, 0.0, FRAC_PI_2], 4.0)];
    let courses = discs.map(|disc| Course::<f64>::new(&disc).expect("a valid disc"));
    let fleet = [courses[0].motion(), courses[1].motion().delayed(100.0).expect("small")];
    let ecm = build_ecm(&fleet).expect("a small table");
    let region = ecm.row(&fleet, 0).expect("the table of the fleet").next().expect("they meet");
    let (before, after) = (Constraint::before(&region), Constraint::after(&region));
    assert_eq!(before.time, Interval::new(-<f64 as pcr_core::Scalar>::LIMIT, <f64 as pcr_core::Scalar>::LIMIT));
    assert!(after.time.hi > 100.0 && after.time.hi < 110.0, "{after:?}");
    // Both may be late.
    let late = [fleet[0].with_lateness(2.0).expect("small"), fleet[1].with_lateness(3.0).expect("small")];
    let region = ecm.row(&late, 0).expect("the table of the fleet").next().expect("they meet");
    assert_eq!(Constraint::after(&region).time.hi, after.time.hi + 3.0);
}
