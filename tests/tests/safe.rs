//! Safe intervals against the definition: a window is blocked where some point of the part is within reach of the other
//! agent, wherever that stands.

use pcr_core::{Encounter, Interval, MismatchError, Motion, gaps, safe_intervals, safe_lengths, union};
use pcr_fixed::Q16;
use pcr_planning::fleet::{HostScalar, build_ecm};
use pcr_planning::safe_windows;
use pcr_tests::disc::{Course, Disc, Drive, Leg};
use pcr_tests::generators::{Dice, driven_pairs};
use pcr_tests::oracle::line::{below, reaches};
use pcr_tests::oracle::{Pair, Travel};
use pcr_tests::plans;
use pcr_tests::settings::settings;
use proptest::prelude::*;
use std::f64::consts::FRAC_PI_2;

/// Samples of each set of windows, and in each window.
const SAMPLES: u32 = 16;

fn samples([lo, hi]: [f64; 2]) -> impl Iterator<Item = f64> {
    (0..=SAMPLES).map(move |k| lo + (hi - lo) * f64::from(k) / f64::from(SAMPLES))
}

fn audited<S: HostScalar>(
    discs: [Disc; 2],
    drives: [(Drive, f64); 2],
    [from, to]: [f64; 2],
) -> Result<(), TestCaseError> {
    let discs = discs.map(|disc| disc.rounded::<S>());
    let [ego, other] = [0, 1].map(|k| (&discs[k], drives[k].0.rounded::<S>(), S::from_f64(drives[k].1)));
    let course = |(disc, drive, start): &(&Disc, Drive, S)| Course::<S>::driven(disc, drive, start.to_f64());
    let (Ok(a), Ok(b)) = (course(&ego), course(&other)) else {
        return Err(TestCaseError::reject("does not fit"));
    };
    let pair = Pair::new(&discs[0], &discs[1]);
    let travel = Travel::new(&other.1, discs[1].length(), other.2.to_f64());
    let (a, b) = (a.motion(), b.motion());
    let encounter = Encounter::new(&a, &b);
    let tolerance = encounter.tolerance().to_f64();
    let slip = 8.0 * S::slack(b.time().lo.abs().max(b.time().hi.abs())).to_f64();

    // When a part of the ego's path is blocked. Both ends of the part are numbers of the format.
    let length = |part: f64| S::from_f64(part * discs[0].length()).min(a.path().length());
    let part = Interval::new(length(from.min(to)), length(from.max(to)));
    let one = S::from_f64(1.0);
    let during = Interval::new(b.time().lo - one, b.time().hi + one);
    let motions = [a, b];
    let ecm = build_ecm(&motions).expect("two agents");
    let by_regions =
        ecm.pair(&motions, 0, 1).expect("the table of the fleet").flat_map(|region| region.blocked(part, during));
    for windows in [encounter.blocked(part, during).collect(), by_regions.collect::<Vec<_>>()] {
        let [lo, hi] = [part.lo.to_f64(), part.hi.to_f64()];
        let reaches_at = |time: f64, margin: f64| {
            let s = travel.length_at(time);
            reaches(|l| pair.clearance(s, l), lo, hi, margin, 1e-10)
        };
        let deep_at = |time: f64| {
            let s = travel.length_at(time);
            !below(|l| pair.clearance(s, l) + tolerance, lo, hi, 0.0, 1e-10).inner.is_empty()
        };
        for window in &windows {
            prop_assert!(during.lo <= window.lo && window.lo <= window.hi && window.hi <= during.hi);
            for time in samples([window.lo.to_f64(), window.hi.to_f64()]) {
                let near = [time, time - slip, time + slip].into_iter().any(|time| reaches_at(time, tolerance));
                prop_assert!(near, "not blocked at {time}: {window:?}");
            }
        }
        for free in gaps(union(windows.iter().copied()), during) {
            let inside = [free.lo.to_f64() + slip, free.hi.to_f64() - slip];
            for time in samples(inside).filter(|_| inside[0] < inside[1]) {
                prop_assert!(!deep_at(time), "not free at {time}: {free:?}");
            }
        }
    }

    // Which lengths are blocked in a window of time.
    let time = |part: f64| S::from_f64(during.lo.to_f64() + part * (during.hi - during.lo).to_f64());
    let window = Interval::new(time(from.min(to)), time(from.max(to)));
    let way = [window.lo, window.hi].map(|time| travel.length_at(time.to_f64()));
    let all = Interval::new(S::ZERO, a.path().length());
    let blocked: Vec<_> = encounter.blocked_lengths(window).collect();
    for part in &blocked {
        prop_assert!(all.lo <= part.lo && part.lo <= part.hi && part.hi <= all.hi);
        for l in samples([part.lo.to_f64(), part.hi.to_f64()]) {
            let near = reaches(|s| pair.clearance(s, l), way[0], way[1], tolerance, 1e-10);
            prop_assert!(near, "not blocked at {l}: {part:?}");
        }
    }
    for free in gaps(blocked.iter().copied(), all) {
        for l in samples([free.lo.to_f64(), free.hi.to_f64()]) {
            let inner = below(|s| pair.clearance(s, l) + tolerance, way[0], way[1], 0.0, 1e-10).inner;
            prop_assert!(inner.is_empty(), "not free at {l}: {free:?}");
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(settings(400, 10, 42))]
    #[test]
    fn blocked_parts_are_those_of_the_definition_f64(
        (pair, drives) in driven_pairs(), from in 0.0..1.0_f64, to in 0.0..1.0_f64,
    ) {
        audited::<f64>([pair.0, pair.1], drives, [from, to])?;
    }

    #[test]
    fn blocked_points_are_those_of_the_definition_f64((pair, drives) in driven_pairs(), at in 0.0..1.0_f64) {
        audited::<f64>([pair.0, pair.1], drives, [at, at])?;
    }

    #[test]
    fn blocked_parts_are_those_of_the_definition_f32(
        (pair, drives) in driven_pairs(), from in 0.0..1.0_f64, to in 0.0..1.0_f64,
    ) {
        audited::<f32>([pair.0, pair.1], drives, [from, to])?;
    }

    #[test]
    fn blocked_parts_are_those_of_the_definition_q16(
        (pair, drives) in driven_pairs(), from in 0.0..1.0_f64, to in 0.0..1.0_f64,
    ) {
        audited::<Q16>([pair.0, pair.1], drives, [from, to])?;
    }
}

/// The motion of an agent that may be late by so much \[s\].
fn late<S: HostScalar>(course: &Course<S>, late: f64) -> Motion<'_, S> {
    course.motion().with_lateness(S::from_f64(late)).expect("a lateness")
}

/// Whether the library finds the same without storage, where it looks for each interval in the windows of all agents, as
/// where all windows are stored, sorted and merged.
fn same<S: HostScalar>() {
    let (mut several, mut free) = (0, 0);
    for seed in 0..400 {
        let dice = &mut Dice::seeded(seed);
        let courses: Vec<_> =
            plans::fleet(dice).iter().filter_map(Course::<S>::rounded).map(|(course, _)| course).collect();
        let fleet: Vec<_> = courses.iter().map(|course| late(course, (dice.range(-2.0, 2.0)).max(0.0))).collect();
        for (ego, own) in fleet.iter().enumerate() {
            let [a, b] = [0, 1].map(|_| S::from_f64(dice.range(0.0, own.path().length().to_f64())));
            let [from, to] = [0, 1].map(|_| S::from_f64(dice.range(-5.0, 30.0)));
            let parts = [(a, a), (a.min(b), a.max(b)), (S::ZERO, own.path().length())];
            for (lo, hi) in parts {
                for (from, to) in [(from, from), (from, to), (S::from_f64(-100.0), S::from_f64(500.0))] {
                    let [part, during] = [Interval::new(lo, hi), Interval::new(from, to)];
                    let one_by_one = safe_intervals(&fleet, ego, part, during).expect("an agent of the fleet");
                    let stored =
                        safe_windows::safe_intervals(&fleet, ego, part, during).expect("an agent of the fleet");
                    several += u32::from(stored.len() > 1);
                    free += u32::from(from == to && stored == [during]);
                    assert!(one_by_one.eq(stored), "fleet {seed}, agent {ego}: {part:?} {during:?}");
                }
            }
        }
    }
    assert!(several > 500 && free > 500, "{several} {free}");
}

#[test]
fn fleets_are_safe_at_the_same_times_with_and_without_storage() {
    same::<f64>();
    same::<f32>();
    same::<Q16>();
    let found = safe_windows::safe_intervals::<f64>(&[], 0, Interval::new(0.0, 0.0), Interval::new(0.0, 1.0));
    assert_eq!(found, Err(MismatchError::NoSuchAgent(0)));
}

fn line(start: [f64; 3], length: f64, at: f64) -> Course<f64> {
    let disc = Disc { radius: 0.25, start, legs: vec![Leg::Line(length)] };
    Course::driven(&disc, &Drive::Unit, at).expect("a valid disc")
}

fn close(found: &[Interval<f64>], exact: &[(f64, f64)]) -> bool {
    let near = |(found, exact): (&Interval<f64>, &(f64, f64))| {
        (found.lo - exact.0).abs() < 1e-12 && (found.hi - exact.1).abs() < 1e-12
    };
    found.len() == exact.len() && found.iter().zip(exact).all(near)
}

#[test]
fn the_others_of_a_fleet_block_together_and_parked_ones_for_good() {
    let north = |x: f64, length: f64, at: f64| line([x, -2.0, FRAC_PI_2], length, at);
    // Two pass, one after the other; the third arrives on the path and stays; the fourth stands on it until it leaves.
    let courses = [
        line([-4.0, 0.0, 0.0], 8.0, 0.0),
        north(0.0, 4.0, 0.0),
        north(0.0, 4.0, 0.5),
        north(2.0, 2.0, 1.0),
        line([-2.0, 0.0, FRAC_PI_2], 3.0, 5.0),
    ];
    let fleet = courses.each_ref().map(Course::motion);
    let time = Interval::new(-1.0, 20.0);
    let at = |l: f64| {
        safe_intervals(&fleet, 0, Interval::new(l, l), time).expect("an agent of the fleet").collect::<Vec<_>>()
    };
    assert!(close(&at(4.0), &[(-1.0, 1.5), (3.0, 20.0)]), "{:?}", at(4.0));
    assert!(close(&at(6.0), &[(-1.0, 2.5)]), "{:?}", at(6.0));
    assert!(close(&at(2.0), &[(5.5, 20.0)]), "{:?}", at(2.0));
    assert!(close(&at(0.0), &[(-1.0, 20.0)]), "{:?}", at(0.0));
    let lengths = |lo: f64, hi: f64| {
        safe_lengths(&fleet, 0, Interval::new(lo, hi)).expect("an agent of the fleet").collect::<Vec<_>>()
    };
    assert!(close(&lengths(10.0, 20.0), &[(0.0, 5.5), (6.5, 8.0)]), "{:?}", lengths(10.0, 20.0));
    assert!(close(&lengths(-1.0, 2.0), &[(0.0, 1.5), (2.5, 3.5), (4.5, 8.0)]), "{:?}", lengths(-1.0, 2.0));
}

#[test]
fn the_end_of_a_path_is_blocked_though_its_length_is_rounded() {
    let mut beyond = 0;
    for k in 1..200 {
        let parts = [f64::from(k) * 0.1, f64::from(k) * 0.07, 0.3];
        let disc =
            |start, legs: &[f64]| Disc { radius: 0.25, start, legs: legs.iter().map(|&l| Leg::Line(l)).collect() };
        let course = |disc| Course::<f64>::new(&disc).expect("a valid disc");
        let ego = course(disc([0.0, 0.0, 0.0], &parts));
        let other = course(disc([parts.iter().sum(), -2.0, FRAC_PI_2], &[4.0]));
        let fleet = [ego.motion(), other.motion()];
        let path = fleet[0].path();
        let (end, last) = (path.length(), path.segments()[2]);
        beyond += u32::from(end > last.from() + last.length());
        let (at, time) = (Interval::new(end, end), Interval::new(0.0, 4.0));
        assert_eq!(Encounter::new(&fleet[0], &fleet[1]).blocked(at, time).count(), 1, "{k}");
        let ecm = build_ecm(&fleet).expect("two agents");
        let region = ecm.pair(&fleet, 1, 0).expect("the table of the fleet").next().expect("a crossing");
        assert_eq!(region.swapped().blocked(at, time).count(), 1, "{k}");
        let region = ecm.pair(&fleet, 1, 0).expect("the table of the fleet").next().expect("a crossing");
        assert!(!region.hold(0.0, end).allows(2.0), "{k}");
    }
    assert!(beyond > 10, "{beyond}");
}
