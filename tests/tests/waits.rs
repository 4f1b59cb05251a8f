//! Waits on the way, stretched profiles and agents that may be late: against the definition, and known answers.

use pcr_core::{
    Interval, Limits, Motion, Profile, RegionRef, SearchNode, SpeedPlanLimits as Speeds, earliest_departure,
    earliest_start, least_duration, plan_speed, safe_intervals,
};
use pcr_fixed::Q16;
use pcr_planning::fleet::{HostScalar, build_ecm};
use pcr_tests::disc::{Course, Disc, Drive, Driven, Leg};
use pcr_tests::generators::{Dice, drive, leg};
use pcr_tests::oracle::contact::Meeting;
use pcr_tests::oracle::line::{Intervals, below};
use pcr_tests::oracle::{Pair, Travel};
use std::f64::consts::PI;

const CASES: u64 = if cfg!(optimized) { 400 } else { 40 };
/// Phases of a profile, at most.
const PHASES: usize = 16;

/// Two discs whose paths lead about the same place, and their courses.
fn scene<S: HostScalar>(seed: u64) -> Option<([Driven; 2], [Course<S>; 2])> {
    let dice = &mut Dice::seeded(seed);
    let mut driven = || {
        let start = [dice.range(-2.0, 2.0), dice.range(-2.0, 2.0), dice.range(-PI, PI)];
        let legs = (0..1 + dice.below(3)).map(|_| leg(dice)).collect();
        let disc = Disc { radius: dice.range(0.05, 0.3), start, legs };
        let drive = drive(dice, disc.rounded::<S>().length());
        let start = if dice.chance(0.5) { 0.0 } else { dice.range(0.0, 5.0) };
        Course::<S>::rounded(&(disc, drive, start))
    };
    let [(ego, own), (other, their)] = [driven()?, driven()?];
    Some(([own, their], [ego, other]))
}

/// What the format may be off, as a distance \[m\].
fn slip<S: HostScalar>() -> f64 {
    S::tolerance(S::from_f64(20.0)).to_f64().max(1e-7) * 8.0
}

/// When the ego, which is at a length that a function of time gives, is within `margin` of contact with the other.
fn met(pair: &[Driven; 2], ego: impl Fn(f64) -> f64, during: [f64; 2], margin: f64) -> Intervals {
    let [own, their] = pair;
    let there = Pair::new(&own.0, &their.0);
    let other = Travel::new(&their.1, their.0.length(), their.2);
    // A stretched ego is faster.
    let speed = 4.0 * own.1.top_speed() + their.1.top_speed() + 1e-3;
    let clearance = |x: f64| there.clearance(other.length_at(x / speed), ego(x / speed));
    below(clearance, during[0] * speed, during[1] * speed, margin, 1e-7)
}

fn span(pair: &[Driven; 2], more: f64) -> [f64; 2] {
    let times = pair.each_ref().map(|(disc, drive, start)| Travel::new(drive, disc.length(), *start).time());
    [times[0].0.min(times[1].0) - 1.0, times[0].1.max(times[1].1) + more + 1.0]
}

fn waits<S: HostScalar>() {
    let (mut found, mut waited, mut never) = (0_u32, 0_u32, 0_u32);
    for seed in 0..CASES {
        let Some((pair, courses)) = scene::<S>(seed) else { continue };
        let fleet = courses.each_ref().map(Course::motion);
        let ecm = build_ecm(&fleet).expect("a small table");
        let travel = Travel::new(&pair[0].1, pair[0].0.length(), pair[0].2);
        let at = fleet[0].length_at(S::from_f64(travel.time().0 + 0.4 * (travel.time().1 - travel.time().0)));
        // A wait there is over then; rounded, its length may not be the one of the definition.
        let leaves = (fleet[0].time().lo + fleet[0].profile().last_time_at(at)).to_f64();
        if at <= S::ZERO {
            // A start delay.
            continue;
        }
        let moves = |wait: f64| {
            let travel = &travel;
            move |time: f64| {
                if time < leaves { travel.length_at(time) } else { travel.length_at((time - wait).max(leaves)) }
            }
        };
        match earliest_departure(ecm.row(&fleet, 0).expect("the table of the fleet"), at, S::ZERO) {
            Some(wait) => {
                found += 1;
                waited += u32::from(wait > S::ZERO);
                // Only what comes after the length counts: before, the agent may be in the way as it is.
                let during = [leaves, span(&pair, wait.to_f64())[1]];
                let contact = met(&pair, moves(wait.to_f64()), during, -slip::<S>()).inner;
                assert!(contact.is_empty(), "seed {seed}: waits {wait:?} at {at:?} and is met at {contact:?}");
                // Less is not enough.
                if wait > S::from_f64(0.01) {
                    let less = met(&pair, moves(wait.to_f64() - 0.01), during, slip::<S>()).outer;
                    assert!(!less.is_empty(), "seed {seed}: waits {wait:?} at {at:?}, and less is enough");
                }
            }
            None => {
                never += 1;
                let during = [leaves, span(&pair, 0.0)[1]];
                let contact = met(&pair, moves(0.0), during, slip::<S>()).outer;
                assert!(!contact.is_empty(), "seed {seed}: goes on at once from {at:?}");
            }
        }
    }
    assert!(u64::from(found) > CASES / 2 && u64::from(waited) * 100 > CASES && never > 0, "{found}, {waited}, {never}");
}

#[test]
fn after_the_least_wait_nobody_is_met_and_after_less_somebody_is_f64() {
    waits::<f64>();
}

#[test]
fn after_the_least_wait_nobody_is_met_and_after_less_somebody_is_f32() {
    waits::<f32>();
}

#[test]
fn after_the_least_wait_nobody_is_met_and_after_less_somebody_is_q16() {
    waits::<Q16>();
}

fn durations<S: HostScalar>() {
    const SAMPLES: i32 = 24;
    let (mut inside, mut outside, mut coarse) = (0, 0, 0);
    for seed in 0..CASES {
        let Some((pair, courses)) = scene::<S>(seed) else { continue };
        let fleet = courses.each_ref().map(Course::motion);
        let ecm = build_ecm(&fleet).expect("a small table");
        let forbidden: Vec<Interval<S>> = ecm
            .row(&fleet, 0)
            .expect("the table of the fleet")
            .filter_map(|region: RegionRef<'_, S>| region.forbidden_durations::<PHASES>().expect("room"))
            .collect();
        let travel = Travel::new(&pair[0].1, pair[0].0.length(), pair[0].2);
        let (start, own) = (pair[0].2, travel.time().1 - pair[0].2);
        let met_in = |duration: f64, margin: f64| {
            let ego = |time: f64| travel.length_at(start + (time - start) * own / duration);
            met(&pair, ego, span(&pair, duration), margin)
        };
        let is_forbidden = |duration: f64| {
            let inside = |interval: &Interval<S>| {
                interval.lo.to_f64() < duration && (interval.hi >= S::LIMIT || duration < interval.hi.to_f64())
            };
            forbidden.iter().any(inside)
        };
        // Scale factors from 1/3 to 3, not beyond what the oracle takes for the fastest.
        for k in -SAMPLES..=SAMPLES {
            let duration = own * 3_f64.powf(f64::from(k) / f64::from(SAMPLES));
            if is_forbidden(duration) {
                inside += 1;
                coarse += u32::from(met_in(duration, slip::<S>()).outer.is_empty());
            } else {
                outside += 1;
                let met = met_in(duration, -slip::<S>()).inner;
                assert!(met.is_empty(), "seed {seed}: met in {duration} s at {met:?}: {forbidden:?}");
            }
        }
        let least = least_duration::<S, PHASES>(ecm.row(&fleet, 0).expect("the table of the fleet"), S::from_f64(own))
            .expect("room");
        if let Some(least) = least {
            // The interval has room for the rounding of all durations beyond its end, this one was tried itself (`ends.rs`).
            let met = met_in(least.to_f64(), -slip::<S>()).inner;
            assert!(met.is_empty() && least.to_f64() >= own - 1e-3, "seed {seed}: met in {least:?} s at {met:?}");
            let stretched = Profile::<S, PHASES>::stretched(fleet[0].profile(), least).expect("a duration");
            let ego = fleet[0].with_profile(stretched.as_profile(), fleet[0].time().lo).expect("a motion");
            assert!((ego.time().hi - fleet[0].time().lo - least).abs().to_f64() < 1e-3);
        }
    }
    assert!(inside > CASES && outside > CASES, "{inside} forbidden, {outside} free");
    // Regions in which the discs only touch, or of which the start leaves next to nothing, forbid all that their ranges allow.
    assert!(u64::from(coarse) * 1000 <= inside, "{coarse} of {inside} forbidden ones are free");
}

#[test]
fn regions_forbid_the_durations_at_which_the_stretched_motion_meets_them_f64() {
    durations::<f64>();
}

#[test]
fn regions_forbid_the_durations_at_which_the_stretched_motion_meets_them_f32() {
    durations::<f32>();
}

#[test]
fn regions_forbid_the_durations_at_which_the_stretched_motion_meets_them_q16() {
    durations::<Q16>();
}

fn line(start: [f64; 3], length: f64, speed: f64) -> Course<f64> {
    let disc = Disc { radius: 0.25, start, legs: vec![Leg::Line(length)] };
    Course::driven(&disc, &Drive::Pieces(speed, vec![(length / speed, 0.0)]), 0.0).expect("a valid disc")
}

#[test]
fn a_crossing_forbids_the_scale_factors_of_the_closed_form() {
    // At v and 1 m/s they pass |2 v - 2| / √(1 + v²) from each other: 0.5 for 15 v² - 32 v + 15 = 0.
    let courses = [line([-2.0, 0.0, 0.0], 4.0, 1.0), line([0.0, -2.0, PI / 2.0], 4.0, 1.0)];
    let fleet = courses.each_ref().map(Course::motion);
    let ecm = build_ecm(&fleet).expect("a small table");
    let region = ecm.row(&fleet, 0).expect("the table of the fleet").next().expect("a crossing");
    let found = region.forbidden_durations::<1>().expect("room").expect("a conflict");
    for (end, root) in [(found.lo, 16.0 + 31.0_f64.sqrt()), (found.hi, 16.0 - 31.0_f64.sqrt())] {
        assert!((4.0 / end - root / 15.0).abs() < 1e-8, "{found:?}");
    }
    let head_on = [line([0.0, 0.0, 0.0], 4.0, 1.0), line([4.0, 0.0, PI], 4.0, 1.0)];
    let fleet = head_on.each_ref().map(Course::motion);
    let ecm = build_ecm(&fleet).expect("a small table");
    assert_eq!(least_duration::<f64, 1>(ecm.row(&fleet, 0).expect("the table of the fleet"), 4.0), Ok(None));
}

/// Fleets in which everybody may be late, as planned, met by nobody however late they are.
#[test]
fn plans_with_lateness_hold_for_all_delays_in_it() {
    const DRAWS: u32 = 6;
    let mut planned = [0_u32; 2];
    for seed in 0..CASES {
        let Some((pair, courses)) = scene::<f64>(seed) else { continue };
        let dice = &mut Dice::seeded(seed + 1_000_000);
        let late = [dice.range(0.0, 2.0), dice.range(0.0, 2.0)];
        let pair = pair.map(|(disc, drive, start)| (disc.grown(1e-6), drive, start));
        let fleet: Vec<Motion<'_, f64>> = courses
            .iter()
            .zip(late)
            .map(|(course, late)| course.motion().with_lateness(late).expect("valid"))
            .collect();
        let ecm = build_ecm(&fleet).expect("a small table");
        let mut stations = vec![SearchNode::EMPTY; 80];
        let by_delay = earliest_start(ecm.row(&fleet, 0).expect("the table of the fleet"), 0.0)
            .map(|delay| (pair[0].1.clone(), pair[0].2 + delay));
        // One that is slower for a reason as well: only whom it meets counts here.
        let limits = Limits { speed: fleet[0].profile().top_speed(), acceleration: 1.0 };
        let drive = Speeds::of(&fleet[0]).unwrap_or(Speeds::rest_to_rest(limits));
        let row = ecm.row(&fleet, 0).expect("the table of the fleet");
        let speeds = plan_speed::<f64, 48>(&fleet[0], drive, row, &[], &mut stations);
        let by_speed = speeds.ok().map(|plan| {
            let phases = plan.profile.as_profile().phases();
            let speed = phases.first().map_or(0.0, |first| first.speed()[0]);
            let pieces = phases.iter().map(|phase| (phase.time().length(), phase.acceleration()));
            (Drive::Pieces(speed, pieces.collect()), plan.start)
        });
        for (way, plan) in [by_delay, by_speed].into_iter().enumerate() {
            let Some((drive, start)) = plan else { continue };
            planned[way] += 1;
            for draw in 0..DRAWS {
                // The ends of both intervals first.
                let share =
                    |k: u32, dice: &mut Dice| if draw < 4 { f64::from(draw >> k & 1) } else { dice.range(0.0, 1.0) };
                let starts = [start + late[0] * share(0, dice), pair[1].2 + late[1] * share(1, dice)];
                let ego = (pair[0].0.grown(-1e-6), drive.clone(), starts[0]);
                let other = (pair[1].0.grown(-1e-6), pair[1].1.clone(), starts[1]);
                let last = span(&[ego.clone(), other.clone()], 0.0);
                // Before it is meant to move the ego is where it is.
                let during = [if way == 0 { last[0] } else { starts[0] }, last[1]];
                let met = Meeting::new(&ego, &other).contacts(during, 0.0).inner;
                assert!(met.is_empty(), "seed {seed}, way {way}: {starts:?} {met:?}");
            }
        }
    }
    assert!(planned.iter().all(|&planned| u64::from(planned) * 2 > CASES), "{planned:?} of {CASES}");
}

#[test]
fn lateness_makes_windows_and_delays_longer_by_itself() {
    let courses = [line([-2.0, 0.0, 0.0], 4.0, 1.0), line([0.0, -2.0, PI / 2.0], 4.0, 1.0)];
    let fleet = courses.each_ref().map(Course::motion);
    let late = [fleet[0].with_lateness(0.25).expect("valid"), fleet[1].with_lateness(0.5).expect("valid")];
    let blocked = |fleet: &[Motion<'_, f64>]| -> Vec<f64> {
        let middle = Interval::new(2.0, 2.0);
        safe_intervals(fleet, 0, middle, Interval::new(0.0, 10.0))
            .expect("an agent of the fleet")
            .flat_map(|safe| [safe.lo, safe.hi])
            .collect()
    };
    assert_eq!(blocked(&late), [0.0, blocked(&fleet)[1] - 0.25, blocked(&fleet)[2] + 0.5, 10.0]);
    let forbidden = |fleet: &[Motion<'_, f64>; 2]| {
        let ecm = build_ecm(fleet).expect("a small table");
        ecm.row(fleet, 0)
            .expect("the table of the fleet")
            .map(|region| region.forbidden_delays())
            .next()
            .expect("a crossing")
    };
    let (exact, wide) = (forbidden(&fleet), forbidden(&late));
    assert!((wide.lo - exact.lo + 0.25).abs() < 1e-12 && (wide.hi - exact.hi - 0.5).abs() < 1e-12);
}

/// All that is asked of a pair of agents is the same if both come 8 s later.
#[test]
fn the_origin_of_time_does_not_matter() {
    let (mut waited, mut stretched) = (0, 0);
    for seed in 0..CASES {
        let Some((pair, _)) = scene::<f64>(seed) else { continue };
        let answers = |later: f64| {
            let courses = pair
                .each_ref()
                .map(|(disc, drive, start)| Course::<f64>::driven(disc, drive, start + later).expect("a valid disc"));
            let fleet = courses.each_ref().map(Course::motion);
            let ecm = build_ecm(&fleet).expect("a small table");
            let row = || ecm.row(&fleet, 0).expect("the table of the fleet");
            let at = 0.4 * fleet[0].path().length();
            let own = fleet[0].profile().duration();
            let least = least_duration::<f64, PHASES>(row(), own).expect("room");
            [earliest_start(row(), 0.0), earliest_departure(row(), at, 0.0), least.map(|least| least - own)]
        };
        let [now, then] = [answers(0.0), answers(8.0)];
        let alike = |(a, b): (&Option<f64>, &Option<f64>)| match (a, b) {
            (Some(a), Some(b)) => (a - b).abs() < 1e-6,
            (a, b) => a.is_none() && b.is_none(),
        };
        assert!(now.iter().zip(&then).all(alike), "seed {seed}: {now:?}, 8 s later {then:?}");
        waited += u32::from(now[1].is_some_and(|wait| wait > 0.0));
        stretched += u32::from(now[2].is_some_and(|more| more > 1e-3));
    }
    assert!(waited > 0 && stretched > 0, "{waited}, {stretched}");
}
