//! Start delays: every region forbids the interval that the definition forbids, and known answers.

use pcr_core::{Encounter, Interval, RegionRef, earliest_start, union};
use pcr_fixed::{Q12, Q16, Q20};
use pcr_planning::fleet::{HostScalar, build_ecm};
use pcr_tests::disc::{Course, Disc, Drive, Leg};
use pcr_tests::generators::{Dice, drive, driven_pairs, leg};
use pcr_tests::oracle::Pair;
use pcr_tests::settings::settings;
use proptest::prelude::*;
use std::f64::consts::{FRAC_PI_2, PI};

/// Delays between which the forbidden set is sampled, in both directions.
const SAMPLES: u32 = 60;

/// Contacts as `tests/conflicts.rs` certifies them, at delays inside and outside of what the regions forbid.
fn audited<S: HostScalar>(discs: [&Disc; 2], drives: &[(Drive, f64); 2]) -> Result<(), TestCaseError> {
    let course = |k: usize| {
        let (drive, start) = &drives[k];
        Course::<S>::driven(&discs[k].rounded::<S>(), &drive.rounded::<S>(), S::from_f64(*start).to_f64())
    };
    let (Ok(ego), Ok(other)) = (course(0), course(1)) else {
        return Err(TestCaseError::reject("does not fit"));
    };
    let fleet = [ego.motion(), other.motion()];
    let ecm = build_ecm(&fleet).expect("a small table");
    let regions: Vec<RegionRef<'_, S>> = ecm.pair(&fleet, 0, 1).expect("the table of the fleet").collect();
    // A region that is all slack forbids what its ranges allow.
    let pair = Pair::new(&discs[0].rounded::<S>(), &discs[1].rounded::<S>());
    let tolerance = Encounter::new(&fleet[0], &fleet[1]).tolerance().to_f64();
    let deep = |region: &RegionRef<'_, S>| {
        let (time, from) = (region.other_length(), region.other_motion());
        (0..=SAMPLES).any(|k| {
            let s = time.lo.to_f64() + time.length().to_f64() * f64::from(k) / f64::from(SAMPLES);
            let at = from.time_in(Interval::new(S::from_f64(s), S::from_f64(s))).lo;
            let s = from.length_at(at);
            region.slice_at(at).any(|slice| pair.clearance(s.to_f64(), slice.middle().to_f64()) < -2.0 * tolerance)
        })
    };
    if !regions.iter().all(deep) {
        return Err(TestCaseError::reject("discs that only touch"));
    }
    let forbidden: Vec<Interval<S>> = union(regions.iter().map(RegionRef::forbidden_delays)).collect();

    let [own, their] = [fleet[0].time(), fleet[1].time()];
    let (lo, hi) = ((their.lo - own.hi).to_f64() - 1.0, (their.hi - own.lo).to_f64() + 1.0);
    let ends = forbidden.iter().flat_map(|interval| [interval.lo, interval.hi]).filter(|end| end.abs() < S::LIMIT);
    let even = (0..=SAMPLES).map(|k| S::from_f64(lo + (hi - lo) * f64::from(k) / f64::from(SAMPLES)));
    for delay in even.clone().chain(ends) {
        let Ok(delayed) = fleet[0].delayed(delay) else { continue };
        let encounter = Encounter::new(&delayed, &fleet[1]);
        // Long before and after: both stand.
        let one = S::from_f64(1.0);
        let during = Interval::new(encounter.time().lo - one, encounter.time().hi + one);
        compared(&encounter, [&fleet[0], &fleet[1]], &forbidden, delay, [Some(during); 2])?;
    }

    // The same while both are under way. Just inside of an end they may be so for no time.
    let passing: Vec<Interval<S>> = union(regions.iter().map(RegionRef::passing_delays)).collect();
    let ends = passing.iter().flat_map(|interval| [interval.lo, interval.hi]);
    for delay in even.chain(ends) {
        let Ok(delayed) = fleet[0].delayed(delay) else { continue };
        let encounter = Encounter::new(&delayed, &fleet[1]);
        let (own, other) = (delayed.time(), fleet[1].time());
        let (lo, hi) = (own.lo.max(other.lo), own.hi.min(other.hi));
        let slack = bracket(&fleet[0], &fleet[1]).double();
        let during = (lo <= hi).then(|| Interval::new(lo, hi));
        let about = (lo - slack <= hi + slack).then(|| Interval::new(lo - slack, hi + slack));
        compared(&encounter, [&fleet[0], &fleet[1]], &passing, delay, [about, during])?;
    }

    // The earliest start is free, and no later than the end of what is forbidden; discs that just touch all the time may
    // count as forbidden or free.
    for from in [S::from_f64(lo), S::ZERO] {
        let clearance_at = |delay: S| {
            let delayed = fleet[0].delayed(delay).expect("a valid delay");
            let encounter = Encounter::new(&delayed, &fleet[1]);
            let clearance = (encounter.closest(encounter.time()).separation - encounter.radius()).to_f64();
            (clearance, slip(&encounter, &fleet[0], &fleet[1]), encounter.tolerance().to_f64())
        };
        let end = forbidden.iter().find(|interval| interval.lo <= from && from < interval.hi);
        let end = end.map_or(from, |interval| interval.hi);
        match earliest_start(regions.iter().cloned(), from) {
            Some(found) => {
                let (clearance, slip, tolerance) = clearance_at(found);
                // An ego that hardly moves is hardly nearer a little earlier.
                let late = (found - end).to_f64() > slip && clearance_at(end).0 > slip;
                prop_assert!(from <= found && !late, "{found:?} for {end:?}");
                prop_assert!(clearance >= -tolerance, "{clearance} at {found:?}");
            }
            None if end >= S::LIMIT => {}
            None => {
                let (clearance, slip, _) = clearance_at(end);
                prop_assert!(clearance <= slip, "free by {clearance} at {end:?}: {forbidden:?}");
            }
        }
    }
    Ok(())
}

/// What is forbidden is met in the first interval of time, what is not is free in the second.
fn compared<S: HostScalar>(
    encounter: &Encounter<'_, S>,
    fleet: [&pcr_core::Motion<'_, S>; 2],
    forbidden: &[Interval<S>],
    delay: S,
    during: [Option<Interval<S>>; 2],
) -> Result<(), TestCaseError> {
    let clearance = |during: Option<Interval<S>>| {
        during.map_or(f64::INFINITY, |during| (encounter.closest(during).separation - encounter.radius()).to_f64())
    };
    // Inside the closed interval, but not at its ends, where the search stopped outside.
    if forbidden.iter().any(|interval| interval.lo < delay && delay < interval.hi) {
        let clearance = clearance(during[0]);
        let slip = slip(encounter, fleet[0], fleet[1]);
        prop_assert!(clearance <= slip, "free at {delay:?} by {clearance}: {forbidden:?}");
    } else {
        let (clearance, tolerance) = (clearance(during[1]), encounter.tolerance().to_f64());
        prop_assert!(clearance >= -tolerance, "met at {delay:?} by {clearance}: {forbidden:?}");
    }
    Ok(())
}

/// What the bracket of a delay may be off as a time.
fn bracket<S: HostScalar>(ego: &pcr_core::Motion<'_, S>, other: &pcr_core::Motion<'_, S>) -> S {
    let latest = |time: Interval<S>| time.lo.abs().max(time.hi.abs());
    S::tolerance(latest(ego.time()).max(latest(other.time())))
}

/// What the bracket of a delay may be off, as a distance at top speed and as a time.
fn slip<S: HostScalar>(
    encounter: &Encounter<'_, S>,
    ego: &pcr_core::Motion<'_, S>,
    other: &pcr_core::Motion<'_, S>,
) -> f64 {
    let bracket = bracket(ego, other).to_f64();
    let speed = ego.profile().top_speed().to_f64() + other.profile().top_speed().to_f64();
    encounter.tolerance().to_f64() + 2.0 * bracket * speed.max(1.0)
}

proptest! {
    #![proptest_config(settings(250, 12, 43))]
    #[test]
    fn regions_forbid_what_the_definition_forbids_f64((pair, drives) in driven_pairs()) {
        audited::<f64>([&pair.0, &pair.1], &drives)?;
    }

    #[test]
    fn regions_forbid_what_the_definition_forbids_f32((pair, drives) in driven_pairs()) {
        audited::<f32>([&pair.0, &pair.1], &drives)?;
    }
}

proptest! {
    #![proptest_config(settings(250, 12, 43))]
    #[test]
    fn regions_forbid_what_the_definition_forbids_q16((pair, drives) in driven_pairs()) {
        audited::<Q16>([&pair.0, &pair.1], &drives)?;
    }
}

/// A contact counts for the region that covers its middle or its deepest point. One that none covers is a touch: what is
/// in contact for sure belongs to a region (docs/theory/errors.md).
fn contacts_have_a_region<S: HostScalar>(cases: u64) {
    let (mut contacts, mut touches) = (0_u32, 0_u32);
    for seed in 0..cases {
        let dice = &mut Dice::seeded(seed);
        let mut driven = || {
            let start = [dice.range(-3.0, 3.0), dice.range(-3.0, 3.0), dice.range(-PI, PI)];
            let legs = (0..1 + dice.below(3)).map(|_| leg(dice)).collect();
            let disc = Disc { radius: dice.range(0.05, 0.5), start, legs };
            let drive = drive(dice, disc.length());
            (disc, drive, dice.range(0.0, 5.0))
        };
        let pair = [driven(), driven()];
        let Some(courses) = pair.iter().map(Course::<S>::rounded).collect::<Option<Vec<_>>>() else { continue };
        let fleet: Vec<_> = courses.iter().map(|(course, _)| course.motion()).collect();
        let ecm = build_ecm(&fleet).expect("a small table");
        let regions = || ecm.pair(&fleet, 0, 1).expect("the table of the fleet");
        let resolution = S::tolerance(fleet[0].time().hi.max(fleet[1].time().hi)).to_f64();
        // Where they only just meet, and a little before.
        let ends = regions().flat_map(|region| [region.forbidden_delays().lo, region.forbidden_delays().hi]);
        let slips = [-1e3, -30.0, -8.0, -4.0, -2.0, -1.0, 0.0, 1.0, 2.0, 4.0, 8.0, 30.0, 1e3];
        for delay in ends.flat_map(|end| slips.map(|slip| end + S::from_f64(slip * resolution))) {
            let Ok(ego) = fleet[0].delayed(delay) else { continue };
            let encounter = Encounter::new(&ego, &fleet[1]);
            for conflict in encounter.conflicts(encounter.time()) {
                let covered = |time| regions().any(|region| region.contains(time, ego.length_at(time)));
                contacts += 1;
                if !covered(conflict.time.middle()) && !covered(conflict.deepest.time) {
                    touches += 1;
                    // A quarter of the tolerance is what a distance may be off.
                    let error = encounter.tolerance().to_f64() / 4.0;
                    assert!(conflict.touching && conflict.depth.to_f64() <= error, "seed {seed}: {conflict:?}");
                }
            }
        }
    }
    println!("{}: {contacts} contacts, {touches} of no region", S::NAME);
    assert!(contacts > 100, "{contacts}");
}

#[test]
fn a_contact_of_no_region_is_a_touch() {
    let cases = if cfg!(optimized) { 1_500 } else { 100 };
    contacts_have_a_region::<f64>(cases);
    contacts_have_a_region::<f32>(cases);
    contacts_have_a_region::<Q12>(cases);
    contacts_have_a_region::<Q16>(cases);
    contacts_have_a_region::<Q20>(cases);
}

fn line(start: [f64; 3], length: f64, speed: f64) -> Course<f64> {
    let disc = Disc { radius: 0.25, start, legs: vec![Leg::Line(length)] };
    Course::driven(&disc, &Drive::Pieces(speed, vec![(length / speed, 0.0)]), 0.0).expect("a valid disc")
}

fn forbidden(courses: [&Course<f64>; 2]) -> Vec<Interval<f64>> {
    let fleet = courses.map(Course::motion);
    let ecm = build_ecm(&fleet).expect("a small table");
    ecm.pair(&fleet, 0, 1).expect("the table of the fleet").map(|region| region.forbidden_delays()).collect()
}

#[test]
fn a_crossing_at_constant_speeds_forbids_the_interval_of_the_closed_form() {
    for (angle, v, w) in [(FRAC_PI_2, 1.0, 1.0), (FRAC_PI_2, 0.5, 2.0), (1.0, 1.2, 0.7), (2.5, 0.4, 0.9)] {
        let (sin, cos) = angle.sin_cos();
        let found = forbidden([&line([-4.0, 0.0, 0.0], 8.0, v), &line([-4.0 * cos, -4.0 * sin, angle], 8.0, w)]);
        // They pass the crossing at 4 / v and 4 / w; R = 0.5.
        let middle = 4.0 / w - 4.0 / v;
        let half = 0.5 * (v * v + w * w - 2.0 * v * w * cos).sqrt() / (v * w * sin);
        let [interval] = found[..] else { panic!("{found:?}") };
        let off = (interval.lo - (middle - half)).abs().max((interval.hi - (middle + half)).abs());
        assert!(off < 1e-8, "{interval:?} for {} to {}", middle - half, middle + half);
        assert!(interval.lo <= middle - half && middle + half <= interval.hi, "outward");
    }
}

#[test]
fn where_the_format_ends_before_the_region_the_last_delay_under_way_is_told() {
    // One crosses the line of the other and then stands for 3000 s; the other stops there for 500 s. Times up to 4096 s can be represented,
    // so that no delay beyond 1096 s can be tried, and at that there is a contact.
    let motion = |start: [f64; 3], from: f64, speed: f64, pieces: &[(f64, f64)]| {
        let disc = Disc { start, legs: vec![Leg::Line(4.0)], radius: 0.25 };
        Course::<Q16>::driven(&disc, &Drive::Pieces(speed, pieces.to_vec()), from).expect("a motion")
    };
    let brief = |from| motion([-2.0, 0.0, 0.0], from, 1.0, &[(3.5, 0.0), (1.0, -1.0), (2990.0, 0.0)]);
    let late = |from| motion([-2.0, 0.0, 0.0], from, 0.0, &[(1000.0, 0.0), (1.0, 1.0), (3.0, 0.0), (1.0, -1.0)]);
    let stops = [(1.5, 0.0), (1.0, -1.0), (500.0, 0.0), (1.0, 1.0), (1.5, 0.0)];
    let long = |from| motion([0.0, -2.0, FRAC_PI_2], from, 1.0, &stops);
    let near = |value: Q16, expected: f64| (value.to_f64() - expected).abs() < 0.01;
    let fleet = [brief(0.0), long(1000.0)];
    let fleet = [fleet[0].motion(), fleet[1].motion()];
    let ecm = build_ecm(&fleet).expect("a small table");
    let [delays] = ecm.row(&fleet, 0).expect("its row").map(|region| region.forbidden_delays()).collect::<Vec<_>>()[..]
    else {
        panic!("one region")
    };
    assert!(near(delays.hi, 1505.0), "until the other has arrived: {delays:?}");
    assert!(delays.lo.to_f64() > 990.0 && delays.lo.to_f64() < 1001.0, "{delays:?}");
    // One that first stands for 1000 s would have to start before the times of the format.
    let fleet = [long(-3400.0), late(-3000.0)];
    let fleet = [fleet[0].motion(), fleet[1].motion()];
    let ecm = build_ecm(&fleet).expect("a small table");
    let region = ecm.row(&fleet, 1).expect("its row").next().expect("a region");
    let delays = region.forbidden_delays();
    assert!(near(delays.lo, -1405.0), "before the other has started: {delays:?}");
}

#[test]
fn agents_head_on_on_one_line_are_never_free() {
    let found = forbidden([&line([0.0, 0.0, 0.0], 4.0, 1.0), &line([4.0, 0.0, PI], 4.0, 1.0)]);
    // Late, the ego is met at its start; early, the other is.
    assert_eq!(found, [Interval::new(-1e12, 1e12)]);
}

#[test]
fn following_needs_the_headway_of_the_slower_one() {
    // The other sets off 0.6 m ahead and goes on beyond the end of the ego's path. As fast as it: 0.1 s to spare.
    let found = forbidden([&line([0.0, 0.0, 0.0], 4.0, 1.0), &line([0.6, 0.0, 0.0], 8.0, 1.0)]);
    let [interval] = found[..] else { panic!("{found:?}") };
    assert!(interval.lo == -1e12 && (interval.hi + 0.1).abs() < 1e-8, "{interval:?}");
    // At half the speed it leaves the ego's goal behind by R after 3.9 m or 7.8 s; the ego may arrive then, after its 4 s.
    let found = forbidden([&line([0.0, 0.0, 0.0], 4.0, 1.0), &line([0.6, 0.0, 0.0], 8.0, 0.5)]);
    let [interval] = found[..] else { panic!("{found:?}") };
    assert!(interval.lo == -1e12 && (interval.hi - 3.8).abs() < 1e-8, "{interval:?}");
}

#[test]
fn an_agent_that_parks_on_the_way_has_to_be_passed_before() {
    // The other arrives at the ego's path at x = 0, from the south, after 4 s. The ego gets by if it is through by then.
    let found = forbidden([&line([-2.0, 0.0, 0.0], 4.0, 1.0), &line([0.0, -4.0, FRAC_PI_2], 4.0, 1.0)]);
    let [interval] = found[..] else { panic!("{found:?}") };
    assert!(interval.hi == 1e12 && (interval.lo - (2.0 - 0.5 * 2.0_f64.sqrt())).abs() < 1e-8, "{interval:?}");
    assert_eq!(
        earliest_start_of([&line([-2.0, 0.0, 0.0], 4.0, 1.0), &line([0.0, -4.0, FRAC_PI_2], 4.0, 1.0)], 0.0),
        Some(0.0)
    );
    assert_eq!(
        earliest_start_of([&line([-2.0, 0.0, 0.0], 4.0, 1.0), &line([0.0, -4.0, FRAC_PI_2], 4.0, 1.0)], 2.0),
        None
    );
}

fn earliest_start_of(courses: [&Course<f64>; 2], from: f64) -> Option<f64> {
    let fleet = courses.map(Course::motion);
    let ecm = build_ecm(&fleet).expect("a small table");
    earliest_start(ecm.row(&fleet, 0).expect("the table of the fleet"), from)
}
