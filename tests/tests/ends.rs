//! Free delays, durations and waits are free, and forbidden intervals are not much longer than the exact ones, in every format.
//!
//! The long command is `cargo run --release -p pcr-tests --example ends -- --scenes 1000 --steps 1000 [--format q16]`.

use pcr_core::scalar::Micro;
use pcr_core::{
    Interval, InvalidInput, Motion, PathRef, Phase, Profile, ProfileRef, earliest_departure, least_duration,
};
use pcr_fixed::{Q12, Q16, Q20};
use pcr_planning::fleet::{HostScalar, build_ecm};
use pcr_tests::disc::{Course, Disc, Drive, Leg};
use pcr_tests::ends::{apart, judged, scene, scenes, searches};
use pcr_tests::generators::Dice;
use std::f64::consts::FRAC_PI_2;

/// As many as are done in seconds.
const fn count(release: u64, debug: u64) -> u64 {
    if cfg!(optimized) { release } else { debug }
}

fn free_is_apart<S: HostScalar>() {
    let found = scenes::<S>(0, count(1_000, 120));
    assert_eq!(found.lost, [""; 0], "{}", S::NAME);
    println!("{}: {} of {} ends too far out: {:?}", S::NAME, found.wide.len(), found.compared, found.wide);
    // Where another region of the pair lies beside a deep one, an end may be that of the other.
    assert!(found.wide.len() as u64 * 200 <= found.compared, "{}: {:?} of {}", S::NAME, found.wide, found.compared);
    assert!(found.ends > 200 && found.compared > 100, "{}: {} ends, {} compared", S::NAME, found.ends, found.compared);
}

#[test]
fn what_is_called_free_is_apart_in_floating_point() {
    free_is_apart::<f64>();
    free_is_apart::<f32>();
    free_is_apart::<Micro>();
}

#[test]
fn what_is_called_free_is_apart_in_fixed_point() {
    free_is_apart::<Q20>();
    free_is_apart::<Q16>();
    free_is_apart::<Q12>();
}

fn directed<S: HostScalar>() {
    let found = searches::<S>(0, count(16, 8), count(200, 10));
    println!("{}", found.row(S::NAME));
    assert_eq!(found.lost, [""; 0], "{}", S::NAME);
}

#[test]
fn directed_search_finds_no_free_value_that_is_not_apart() {
    directed::<f64>();
    directed::<f32>();
    directed::<Micro>();
    directed::<Q20>();
    directed::<Q16>();
    directed::<Q12>();
}

/// The other agent passes near the end of the ego's path, so long after the start that a stretched profile has speeds of few digits. The two
/// overlapped by up to 0.18 m in `Q12`.
fn long_times<S: HostScalar>(least: f64, most: f64) {
    let (mut found, mut longer) = (0, 0);
    let dice = &mut Dice::seeded(1);
    for draw in 0..400 {
        let (time, length, radius) = (dice.range(least, most), dice.range(2.0, 12.0), dice.range(0.1, 0.5));
        let line = |start, length| Disc { radius, start, legs: vec![Leg::Line(length)] };
        let discs = [line([0.0; 3], length), line([length - 0.5 * radius, -2.0, FRAC_PI_2], 4.0)];
        let steady = |length: f64| Drive::Pieces(1.0, vec![(length, 0.0)]);
        let own = Course::<S>::driven(&discs[0], &steady(length), 0.0).expect("in range");
        let their = Course::<S>::driven(&discs[1], &steady(4.0), time).expect("in range");
        let fleet = [own.motion(), their.motion()];
        let ecm = build_ecm(&fleet).expect("a small table");
        let row = ecm.row(&fleet, 0).expect("the table of the fleet");
        let duration = match least_duration::<S, 1>(row, fleet[0].profile().duration()) {
            Ok(duration) => duration,
            // All that the format has are too near to contact.
            Err(refused) => {
                assert_eq!(refused, InvalidInput::OutOfRange("duration"), "{}, {draw}", S::NAME);
                continue;
            }
        };
        let Some(duration) = duration else { continue };
        let profile = Profile::<S, 1>::stretched(fleet[0].profile(), duration).expect("a duration");
        let ego = fleet[0].with_profile(profile.as_profile(), S::ZERO).expect("a motion");
        let always = [f64::NEG_INFINITY, f64::INFINITY];
        assert!(apart([&ego, &fleet[1]], [0.0, FRAC_PI_2], always, 0.0), "{}, {draw}: met in {duration:?} s", S::NAME);
        found += 1;
        longer += u32::from(duration.to_f64() > time);
    }
    assert!(found > 100 && longer > 100, "{}: {found} found, {longer} of them longer", S::NAME);
}

#[test]
fn the_least_duration_is_free_far_above_the_own_one() {
    long_times::<f64>(5_000.0, 55_000.0);
    long_times::<f32>(5_000.0, 55_000.0);
    long_times::<Micro>(5_000.0, 55_000.0);
    long_times::<Q12>(5_000.0, 55_000.0);
    long_times::<Q16>(500.0, 4_000.0);
    long_times::<Q20>(30.0, 230.0);
}

/// The same scenes in every query.
fn long_intervals<S: HostScalar>() {
    let mut judged_scenes = 0;
    for seed in (0..count(2_000, 200)).step_by(5) {
        let Some(found) = judged::<S>(&scene::<S>(seed), true, seed) else { continue };
        judged_scenes += 1;
        assert_eq!(found.lost, [""; 0], "{}, {seed}", S::NAME);
    }
    assert!(judged_scenes > 10, "{}: {judged_scenes}", S::NAME);
}

#[test]
fn intervals_of_long_times_lose_nothing() {
    long_intervals::<f64>();
    long_intervals::<f32>();
    long_intervals::<Micro>();
    long_intervals::<Q20>();
    long_intervals::<Q16>();
    long_intervals::<Q12>();
}

/// Phases that stop on the way, and stand there for so long.
fn with_a_wait<S: HostScalar>(speed: f64, ramp: f64, cruise: f64, wait: S) -> Vec<Phase<S>> {
    let (q, mut phases) = (S::from_f64, Vec::<Phase<S>>::new());
    for _ in 0..2 {
        let mut next = |duration: S, after: f64| {
            let begin = Phase::starting_at(S::ZERO, S::ZERO, S::ZERO).expect("nothing");
            let last = phases.last().copied().unwrap_or(begin);
            phases.push(last.then_to(duration, q(after)).expect("in range"));
        };
        next(q(ramp), speed);
        next(q(cruise), speed);
        next(q(ramp), 0.0);
        if wait > S::ZERO {
            let last = *phases.last().expect("a phase");
            if phases.len() == 3 {
                phases.push(last.then(wait, S::ZERO).expect("in range"));
            }
        }
    }
    phases
}

fn waits<S: HostScalar>() {
    let (mut waited, mut none) = (0, 0);
    for seed in 0..count(2_000, 300) {
        let dice = &mut Dice::seeded(seed);
        let (speed, ramp, cruise) = (dice.range(0.3, 1.5), dice.range(0.5, 2.0), dice.range(0.2, 2.0));
        let limit = S::LIMIT.to_f64();
        let start = if dice.chance(0.5) { 0.0 } else { dice.magnitude(1.0, 0.7 * limit.min(1e5)) };
        let far = if dice.chance(0.5) { 0.0 } else { (0.8 * limit).min(5e6) };
        let phases = with_a_wait::<S>(speed, ramp, cruise, S::ZERO);
        let length = phases.last().expect("phases").length().hi.to_f64();
        let (stop, radius) = (phases[2].length().hi, dice.range(0.1, 0.4));
        let line = |start, length| Disc { radius, start, legs: vec![Leg::Line(length)] };
        let (angle, place) = (dice.range(0.5, 2.6), stop.to_f64() + 2.0 * radius + dice.range(0.0, 1.5));
        let before = dice.range(1.0, 4.0);
        let origin = [far + place - before * angle.cos(), far - before * angle.sin(), angle];
        let drive = Drive::Limits(dice.range(0.3, 1.5), dice.range(0.2, 2.0));
        let there = start + dice.range(0.0, 8.0);
        let other = Course::<S>::rounded(&(line(origin, before + 2.0), drive, there));
        let own = Course::<S>::rounded(&(line([far, far, 0.0], length), Drive::Unit, start));
        let (Some((own, _)), Some((other, (their, ..)))) = (own, other) else { continue };
        let path: PathRef<'_, S> = own.motion().path();
        let made = |phases| ProfileRef::new(phases).expect("a chain");
        let motion = |phases| Motion::new(path, made(phases), S::from_f64(radius), S::from_f64(start));
        let Ok(ego) = motion(&phases) else { continue };
        let fleet = [ego, other.motion()];
        let Ok(ecm) = build_ecm(&fleet) else { continue };
        let Some(wait) = earliest_departure(ecm.row(&fleet, 0).expect("its fleet"), stop, S::ZERO) else {
            none += 1;
            continue;
        };
        let phases = with_a_wait::<S>(speed, ramp, cruise, wait);
        let Ok(ego) = motion(&phases) else { continue };
        // What it meets before it stops is not the question.
        let stops = ego.time().lo.to_f64() + phases[2].time().hi.to_f64();
        let time = [stops, f64::INFINITY];
        assert!(apart([&ego, &fleet[1]], [0.0, their.start[2]], time, 0.0), "{}, {seed}: {wait:?}", S::NAME);
        waited += u32::from(wait > S::ZERO);
    }
    assert!(waited > 20, "{}: {waited} wait, {none} do not", S::NAME);
}

#[test]
fn after_a_wait_nobody_is_met() {
    waits::<f64>();
    waits::<f32>();
    waits::<Micro>();
    waits::<Q20>();
    waits::<Q16>();
    waits::<Q12>();
}

/// 54 ends of unsafe delays with acceleration, of which many were contacts: around the origin, at 1 km and at coordinates of UTM.
#[test]
fn ends_of_passing_delays_are_free_far_from_the_origin() {
    let mut ends = 0;
    let lines: [[[f64; 2]; 4]; 3] = [
        [[0.0, 0.0], [3.0, 0.0], [1.0, -2.0], [1.0, 2.0]],
        [[0.0, 0.0], [3.0, 0.0], [2.5, -1.0], [0.5, 1.5]],
        [[0.0, 0.0], [4.0, 0.0], [3.0, -3.0], [3.0, 1.0]],
    ];
    for [x, y] in [[0.0, 0.0], [1000.0, 1000.0], [500_000.0, 5_400_000.0]] {
        for acceleration in [0.5, 1.0, 0.3] {
            for [a, b, c, d] in lines {
                let line = |[x0, y0]: [f64; 2], [x1, y1]: [f64; 2]| {
                    let (dx, dy): (f64, f64) = (x1 - x0, y1 - y0);
                    Disc { radius: 0.5, start: [x + x0, y + y0, dy.atan2(dx)], legs: vec![Leg::Line(dx.hypot(dy))] }
                };
                let discs = [line(a, b), line(c, d)];
                let driven = |disc: &Disc, start| Course::<f64>::driven(disc, &Drive::Limits(1.0, acceleration), start);
                let courses = discs.each_ref().map(|disc| driven(disc, 0.0).expect("in range"));
                let fleet = courses.each_ref().map(Course::motion);
                let ecm = build_ecm(&fleet).expect("a small table");
                for region in ecm.row(&fleet, 0).expect("the table of the fleet") {
                    let Interval { lo, hi } = region.passing_delays();
                    for delay in [lo, hi] {
                        // As files say it: the one that sets off first does so at the time 0.
                        let starts = if delay < 0.0 { [0.0, -delay] } else { [delay, 0.0] };
                        let courses = [0, 1].map(|k| driven(&discs[k], starts[k]).expect("in range"));
                        let [own, their] = courses.each_ref().map(Course::motion);
                        let headings = discs.each_ref().map(|disc| disc.start[2]);
                        // Some touch one that stands at an end of its line, at exactly R; who stands does not count here.
                        let time = [starts[0].max(starts[1]), own.time().hi.min(their.time().hi)];
                        let is_apart = time[0] > time[1] || apart([&own, &their], headings, time, 0.0);
                        assert!(is_apart, "{x} {acceleration} {a:?}: {delay}");
                        ends += 1;
                    }
                }
            }
        }
    }
    assert_eq!(ends, 54);
}
