//! The first conflict of a row in fleets whose agents touch, as plans make them: a touch is told or stepped over, never the end of
//! the search.

use pcr_core::scalar::Micro;
use pcr_core::{Conflict, Encounter, Interval, Motion, earliest_start, first_conflict, first_overlap};
use pcr_fixed::{Q12, Q16, Q20};
use pcr_formats::scenario::Scenario;
use pcr_planning::fleet::{Fleet, HostScalar, build_ecm};
use pcr_tests::disc::{Course, Disc, Driven};
use pcr_tests::ends::{apart, scene};
use pcr_tests::generators::{Dice, drive, leg};
use std::f64::consts::PI;

/// The earliest of the conflicts with anybody that are deeper than so many tolerances.
fn earliest<S: HostScalar>(
    fleet: &[Motion<'_, S>],
    ego: &Motion<'_, S>,
    all: Interval<S>,
    tolerances: f64,
) -> Option<Conflict<S>> {
    let others = fleet.iter().skip(1);
    let deep = |other| {
        let pair = Encounter::new(ego, other);
        let least = tolerances * pair.tolerance().to_f64();
        pair.conflicts(all).find(|conflict| conflict.depth.to_f64() > least)
    };
    others.filter_map(deep).reduce(|a, b| if b.time.lo < a.time.lo { b } else { a })
}

/// The row of agent 0, which touches one of the others, against the least over all pairs.
fn rows<S: HostScalar>(cases: u64) {
    let (mut touching, mut hidden) = (0, 0);
    for seed in 0..cases {
        let dice = &mut Dice::seeded(seed);
        let driven: Vec<Driven> = (0..5)
            .map(|_| {
                let start = [dice.range(-3.0, 3.0), dice.range(-3.0, 3.0), dice.range(-PI, PI)];
                let legs = (0..1 + dice.below(3)).map(|_| leg(dice)).collect();
                let disc = Disc { radius: dice.range(0.05, 0.3), start, legs };
                let drive = drive(dice, disc.length());
                (disc, drive, dice.range(0.0, 5.0))
            })
            .collect();
        let Some(courses) = driven.iter().map(Course::<S>::rounded).collect::<Option<Vec<_>>>() else { continue };
        let fleet: Vec<Motion<'_, S>> = courses.iter().map(|(course, _)| course.motion()).collect();
        let ecm = build_ecm(&fleet).expect("a small table");
        let row = || ecm.row(&fleet, 0).expect("the table of the fleet");
        // Later by the least delay at which it gets by another one, as if there were no others, or a little less.
        for (partner, less) in (1..5).flat_map(|partner| [0.0, 1.0, 2.0, 4.0, 16.0, 64.0].map(|less| (partner, less))) {
            let with = ecm.pair(&fleet, 0, partner).expect("the table of the fleet");
            let Some(delay) = earliest_start(with, S::ZERO).filter(|&delay| delay > S::ZERO) else { continue };
            let resolution = S::tolerance(fleet[0].time().hi.max(fleet[partner].time().hi)).to_f64();
            let Ok(ego) = fleet[0].delayed(delay - S::from_f64(less * resolution)) else { continue };
            let all = fleet.iter().map(Motion::time).fold(ego.time(), Interval::hull);
            let (first, overlap) = (first_conflict(&ego, row(), all), first_overlap(&ego, row(), all));
            let (first, overlap) = (first.expect("its path"), overlap.expect("its path"));
            let (any, deep) = (earliest(&fleet, &ego, all, 0.0), earliest(&fleet, &ego, all, 2.0));
            touching += u32::from(any.is_some_and(|any| any.touching));
            hidden += u32::from(any.is_some_and(|any| any.touching) && deep.is_some());
            // A search within the ranges of a region begins where that does, one of a pair where the tolerance does.
            let slip = 1e-2 + 20.0 * Encounter::new(&ego, &fleet[partner]).tolerance().to_f64();
            let late =
                |conflict: &Conflict<S>, by: &Conflict<S>| conflict.time.lo.to_f64() > by.time.lo.to_f64() + slip;
            if let Some(deep) = deep {
                let first = first.unwrap_or_else(|| panic!("seed {seed}, {partner}: lost {deep:?}")).conflict;
                let overlap = overlap.unwrap_or_else(|| panic!("seed {seed}, {partner}: lost {deep:?}")).conflict;
                assert!(!late(&first, &deep) && !late(&overlap, &deep), "seed {seed}, {partner}: {deep:?}");
            }
            if let Some(overlap) = overlap {
                let pair = Encounter::new(&ego, &fleet[overlap.other]);
                // What is hardly deeper than the tolerance another search may call a touch.
                let hardly = overlap.conflict.depth.to_f64() < 2.0 * pair.tolerance().to_f64();
                let there = pair
                    .conflicts(all)
                    .any(|conflict| conflict.time.meets(overlap.conflict.time) && (hardly || !conflict.touching));
                assert!(there && !overlap.conflict.touching, "seed {seed}, {partner}: {overlap:?}");
            }
        }
    }
    assert!(touching > 10 && hidden > 0, "{touching} touch, {hidden} of them before a conflict");
}

#[test]
fn the_row_of_an_agent_that_touches_has_the_first_conflict_of_all_pairs() {
    let cases = if cfg!(optimized) { 1_000 } else { 300 };
    rows::<f64>(cases);
    rows::<f32>(cases);
    rows::<Micro>(cases);
    rows::<Q12>(cases);
    rows::<Q16>(cases);
    rows::<Q20>(cases);
}

/// Found by an audit: agent 0 touches agent 3 at 17.036 s and overlaps agent 2 by 0.118 m from 29.604 s on.
#[test]
fn a_touch_does_not_hide_a_collision() {
    let scenario =
        Scenario::from_json(include_str!("../data/cases/first_conflict-merge-5034.json")).expect("a scenario");
    let fleet = Fleet::<f64>::new(&scenario).expect("a fleet");
    let motions = fleet.motions();
    let ecm = build_ecm(&motions).expect("a small table");
    let row = || ecm.row(&motions, 0).expect("the table of the fleet");
    // Delayed until it gets by agent 3, which it touches then.
    let with = ecm.pair(&motions, 0, 3).expect("the table of the fleet");
    let delay = with.map(|region| region.forbidden_delays().hi).fold(0.0, f64::max);
    let all = motions.iter().map(Motion::time).fold(motions[0].time(), Interval::hull);
    let all = Interval::new(all.lo, all.hi + delay);
    // That delay has no contact, and one that is a little less has: at first a touch only.
    let touches = |ego: &Motion<'_, f64>| {
        let first = first_conflict(ego, row(), all).expect("its path").expect("a collision at least");
        first.other == 3 && first.conflict.touching && (first.conflict.time.lo - 17.036).abs() < 1e-2
    };
    let less = (0..1_000).map(|k| motions[0].delayed(delay - f64::from(k) * 1e-10).expect("a delay"));
    let ego = less.into_iter().find(touches).expect("a touch");
    let overlap = first_overlap(&ego, row(), all).expect("its path").expect("a collision");
    assert_eq!(overlap.other, 2);
    let conflict = overlap.conflict;
    assert!((conflict.depth - 0.118).abs() < 1e-3 && (conflict.time.lo - 29.604).abs() < 1e-3, "{conflict:?}");
    assert!((conflict.time.hi - 30.343).abs() < 1e-3, "to its end: {conflict:?}");
}

/// A touch is no deeper than the tolerance: discs that are smaller by it are apart. In `Q12` it was deeper by a fifth.
fn touches_are_slight<S: HostScalar>(cases: u64) {
    let mut touches = 0;
    for seed in 0..cases {
        let [own, their] = scene::<S>(seed).each_ref().map(Course::<S>::rounded);
        let (Some((own, (disc, ..))), Some((their, (other, ..)))) = (own, their) else { continue };
        let fleet = [own.motion(), their.motion()];
        let Ok(ecm) = build_ecm(&fleet) else { continue };
        let tolerance = Encounter::new(&fleet[0], &fleet[1]).tolerance().to_f64();
        let speed = fleet.iter().map(|motion| motion.profile().top_speed().to_f64()).fold(0.1, f64::max);
        for region in ecm.row(&fleet, 0).expect("the table of the fleet") {
            let Interval { lo, hi } = region.forbidden_delays();
            let ends = [(lo, 1.0), (hi, -1.0)].into_iter().filter(|(end, _)| end.abs() < S::LIMIT);
            // Contacts get deeper by up to the top speed times the way inward.
            let inside = ends.flat_map(|(end, inward)| {
                (1..12).map(move |k| end + S::from_f64(inward * f64::from(k) * 0.2 * tolerance / speed))
            });
            for ego in inside.filter_map(|delay| fleet[0].delayed(delay).ok()) {
                let pair = Encounter::new(&ego, &fleet[1]);
                for conflict in pair.conflicts(pair.time()).filter(|conflict| conflict.touching) {
                    touches += 1;
                    let radii = ego.radius().to_f64() + fleet[1].radius().to_f64();
                    if pair.tolerance().to_f64() >= radii {
                        // Far from the origin: no discs overlap by more than the sum of their radii.
                        continue;
                    }
                    let time = [conflict.time.lo.to_f64(), conflict.time.hi.to_f64()];
                    let headings = [disc.start[2], other.start[2]];
                    let less = -pair.tolerance().to_f64();
                    assert!(apart([&ego, &fleet[1]], headings, time, less), "{}, {seed}: {conflict:?}", S::NAME);
                }
            }
        }
    }
    assert!(touches > 20, "{}: {touches}", S::NAME);
}

#[test]
fn a_touch_is_no_deeper_than_the_tolerance() {
    let cases = if cfg!(optimized) { 1_000 } else { 150 };
    touches_are_slight::<f64>(cases);
    touches_are_slight::<f32>(cases);
    touches_are_slight::<Micro>(cases);
    touches_are_slight::<Q12>(cases);
    touches_are_slight::<Q16>(cases);
    touches_are_slight::<Q20>(cases);
}

/// Two motions to plan with that an adversary found: they were said to touch, and the true discs overlapped by 1.6e-9 m.
#[test]
fn discs_do_not_touch_where_those_to_plan_with_do() {
    let scenario = Scenario::from_json(include_str!("../data/cases/touch-for-plan.json")).expect("a scenario");
    let fleet = Fleet::<f64>::new(&scenario).expect("a fleet");
    let motions = fleet.motions();
    let planned: Vec<_> = motions.iter().map(|motion| motion.for_plan().expect("in range")).collect();
    let pair = Encounter::new(&planned[0], &planned[1]);
    let headings = [0, 1].map(|k| scenario.agents[k].start[2]);
    let is_apart = apart([&motions[0], &motions[1]], headings, [f64::NEG_INFINITY, f64::INFINITY], 0.0);
    let all_touch = pair.conflicts(pair.time()).all(|conflict| conflict.touching);
    assert!(is_apart || !all_touch, "{:?}", pair.conflicts(pair.time()).collect::<Vec<_>>());
    assert!(!is_apart, "the case is one of an overlap");
}
