//! Conflicts of given motions: against an oracle that halves time until the way travelled decides, and known answers.

use pcr_core::{Approach, Conflict, Encounter, Interval, Motion, first_conflict};
use pcr_fixed::Q16;
use pcr_host::fleet::{Format, build_ecm};
use pcr_tests::disc::{Course, Disc, Drive, Leg};
use pcr_tests::generators::{Dice, drive, driven_pairs, leg};
use pcr_tests::oracle::contact::contacts;
use pcr_tests::oracle::line::{below, nearest};
use pcr_tests::oracle::{Pair, Travel};
use pcr_tests::settings::settings;
use proptest::prelude::*;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// A disc, how it is driven, and when it sets off.
type Driven = (Disc, Drive, f64);

/// Two driven discs, by the definition: separation less radii over time.
struct Truth {
    pair: Pair,
    travels: [Travel; 2],
    /// The clearance changes no faster than this \[m/s\].
    speed: f64,
}

impl Truth {
    fn new(driven: &[Driven; 2]) -> Self {
        let pair = Pair::new(&driven[0].0, &driven[1].0);
        let travels = [0, 1].map(|k| Travel::new(&driven[k].1, driven[k].0.length(), driven[k].2));
        let speed = driven.iter().map(|(_, drive, _)| drive.top_speed()).sum::<f64>() + 1e-3;
        Self { pair, travels, speed }
    }

    fn clearance(&self, time: f64) -> f64 {
        self.pair.clearance(self.travels[1].length_at(time), self.travels[0].length_at(time))
    }

    /// Where the clearance is at most 0 for sure, and at most `margin` perhaps \[s\].
    fn contacts(&self, during: [f64; 2], margin: f64) -> [Vec<[f64; 2]>; 2] {
        const TOLERANCE: f64 = 1e-9;
        let [lo, hi] = during.map(|time| time * self.speed);
        let found = below(|x| self.clearance(x / self.speed), lo, hi, margin, TOLERANCE);
        [found.inner, found.outer].map(|all| all.into_iter().map(|(a, b)| [a / self.speed, b / self.speed]).collect())
    }
}

fn within(inner: [f64; 2], outer: &[[f64; 2]], slip: f64) -> bool {
    outer.iter().any(|outer| outer[0] - slip <= inner[0] && inner[1] <= outer[1] + slip)
}

/// The course of a driven disc in a format, and the numbers that are left of it.
fn course<S: Format>((disc, drive, start): &Driven) -> Option<(Course<S>, Driven)> {
    let (disc, drive, start) = (disc.rounded::<S>(), drive.rounded::<S>(), S::from_f64(*start).to_f64());
    Some((Course::driven(&disc, &drive, start).ok()?, (disc, drive, start)))
}

fn audited<S: Format>(driven: &[Driven; 2]) -> Result<(), TestCaseError> {
    let [Some((ego, own)), Some((other, their))] = [0, 1].map(|k| course::<S>(&driven[k])) else {
        return Err(TestCaseError::reject("does not fit"));
    };
    let truth = Truth::new(&[own, their]);
    let (ego, other) = (ego.motion(), other.motion());
    let encounter = Encounter::new(&ego, &other);
    // Both stand for a while before and after.
    let one = S::from_f64(1.0);
    let time = Interval::new(encounter.time().lo - one, encounter.time().hi + one);
    let during = [time.lo.to_f64(), time.hi.to_f64()];
    let tolerance = encounter.tolerance().to_f64();
    // The last digit of a time.
    let slip = 4.0 * S::slack(time.lo.abs().max(time.hi.abs())).to_f64();

    let mut contacts = encounter.contacts(time);
    let reported: Vec<[f64; 2]> = contacts.by_ref().map(|contact| [contact.lo.to_f64(), contact.hi.to_f64()]).collect();
    let bound = steps_bound(&truth, during, tolerance);
    prop_assert!(f64::from(contacts.steps()) <= bound, "{} steps of {bound}", contacts.steps());

    // Nothing is missed, nothing is invented.
    let [sure, possible] = truth.contacts(during, tolerance);
    for &contact in &sure {
        prop_assert!(within(contact, &reported, slip), "{contact:?} is missing in {reported:?}");
    }
    for (k, &contact) in reported.iter().enumerate() {
        prop_assert!(within(contact, &possible, slip + 2e-9 / truth.speed), "{contact:?} is not in {possible:?}");
        prop_assert!(during[0] <= contact[0] && contact[0] <= contact[1] && contact[1] <= during[1]);
        prop_assert!(k == 0 || reported[k - 1][1] <= contact[0], "in order");
    }
    // Where, and how deep.
    let conflicts: Vec<Conflict<S>> = encounter.conflicts(time).collect();
    prop_assert_eq!(conflicts.len(), reported.len());
    for (conflict, contact) in conflicts.iter().zip(&reported) {
        prop_assert_eq!([conflict.time.lo.to_f64(), conflict.time.hi.to_f64()], *contact);
        let depth = audited_approach(&truth, &conflict.deepest, *contact, tolerance)?;
        prop_assert!((conflict.depth.to_f64() - depth.max(0.0)).abs() <= tolerance);
        prop_assert_eq!(conflict.touching, conflict.depth <= encounter.tolerance());
        for (length, travel) in [(conflict.length, &truth.travels[0]), (conflict.other_length, &truth.travels[1])] {
            for (end, time) in [(length.lo, contact[0]), (length.hi, contact[1])] {
                prop_assert!((end.to_f64() - travel.length_at(time)).abs() <= tolerance);
            }
        }
    }
    audited_approach(&truth, &encounter.closest(time), during, tolerance)?;
    Ok(())
}

/// The depth at an approach, which has to be the greatest.
fn audited_approach<S: Format>(
    truth: &Truth,
    approach: &Approach<S>,
    during: [f64; 2],
    tolerance: f64,
) -> Result<f64, TestCaseError> {
    const SAMPLES: u32 = 500;
    let (time, separation) = (approach.time.to_f64(), approach.separation.to_f64());
    let clearance = separation - truth.pair.radius;
    prop_assert!(during[0] <= time && time <= during[1]);
    prop_assert!((truth.clearance(time) - clearance).abs() <= tolerance, "{} at {time}", truth.clearance(time));
    let step = (during[1] - during[0]) / f64::from(SAMPLES);
    for k in 0..=SAMPLES {
        let time = during[0] + step * f64::from(k);
        prop_assert!(truth.clearance(time) >= clearance - tolerance, "nearer at {time}");
    }
    Ok(-clearance)
}

/// The documented worst case: discs that hover at the distance of a contact all the time.
fn steps_bound(truth: &Truth, during: [f64; 2], tolerance: f64) -> f64 {
    let acceleration = truth.speed * truth.speed / 1e-3 + 100.0;
    let smallest = (2.0 * tolerance / acceleration).sqrt();
    100.0 + 4.0 * (during[1] - during[0]) / smallest
}

proptest! {
    #![proptest_config(settings(4_000, 20, 41))]
    #[test]
    fn conflicts_are_those_of_the_definition_f64((pair, drives) in driven_pairs()) {
        let [(a, s), (b, t)] = drives;
        audited::<f64>(&[(pair.0, a, s), (pair.1, b, t)])?;
    }

    #[test]
    fn conflicts_are_those_of_the_definition_f32((pair, drives) in driven_pairs()) {
        let [(a, s), (b, t)] = drives;
        audited::<f32>(&[(pair.0, a, s), (pair.1, b, t)])?;
    }

    #[test]
    fn conflicts_are_those_of_the_definition_q16((pair, drives) in driven_pairs()) {
        let [(a, s), (b, t)] = drives;
        audited::<Q16>(&[(pair.0, a, s), (pair.1, b, t)])?;
    }

    #[test]
    fn conflicts_at_the_same_time_are_those_of_the_definition((pair, drives) in driven_pairs()) {
        let [(a, _), (b, _)] = drives;
        audited::<f64>(&[(pair.0, a, 0.0), (pair.1, b, 0.0)])?;
    }
}

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
    assert!(f64::from(contacts.steps()) < bound, "{} of {bound}", contacts.steps());
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
fn the_closest_approach_of_many_pairs_is_that_of_dense_sampling() {
    // The oracle's sampled minimum is 1e5 samples: good to the square of their distance.
    let ego: Driven = (
        Disc { radius: 0.2, start: [0.0, 0.0, 0.3], legs: vec![Leg::arc(1.5, 5.0), Leg::Line(2.0)] },
        Drive::Limits(1.0, 0.4),
        0.0,
    );
    for k in 0..20 {
        let start = [0.3 * f64::from(k) - 3.0, 1.0, -0.4];
        let other: Driven = (
            Disc { radius: 0.3, start, legs: vec![Leg::Line(3.0), Leg::arc(0.7, -3.0)] },
            Drive::Limits(0.8, 0.9),
            1.0,
        );
        let truth = Truth::new(&[ego.clone(), other.clone()]);
        let [(a, _), (b, _)] = [&ego, &other].map(|driven| course::<f64>(driven).expect("a valid disc"));
        let (a, b) = (a.motion(), b.motion());
        let encounter = Encounter::new(&a, &b);
        let time = encounter.time();
        let sampled = nearest(|t| truth.clearance(t), time.lo, time.hi) + truth.pair.radius;
        let closest = encounter.closest(time);
        assert!(
            (closest.separation - sampled).abs() < 1e-6 && closest.separation <= sampled + 1e-9,
            "{k}: {closest:?}"
        );
    }
}

/// The earliest conflict of the first agent of random fleets with its row of the table is that of the definition.
fn first_of_rows<S: Format>(cases: u64) {
    let (mut met, mut free) = (0, 0);
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
        let Some(courses) = driven.iter().map(course::<S>).collect::<Option<Vec<_>>>() else { continue };
        let fleet: Vec<Motion<'_, S>> = courses.iter().map(|(course, _)| course.motion()).collect();
        let ecm = build_ecm(&fleet).expect("a small table");
        // Another motion than the table was made for: a later start.
        let ego = fleet[0].delayed(S::from_f64(1.0)).expect("a valid delay");
        let all = fleet.iter().map(Motion::time).fold(ego.time(), Interval::hull);
        let during = [all.lo.to_f64(), all.hi.to_f64()];
        let first = first_conflict(&ego, ecm.row(&fleet, 0), all);
        let tolerance = (1..5).map(|k| Encounter::new(&ego, &fleet[k]).tolerance().to_f64()).fold(0.0, f64::max);
        let own = (courses[0].1.0.clone(), courses[0].1.1.clone(), ego.time().lo.to_f64());
        let truth = |other: usize, margin: f64| {
            let their = &courses[other].1;
            contacts(&own, their, [own.2, their.2], during, margin)
        };
        let speed = |other: usize| own.1.top_speed() + courses[other].1.1.top_speed() + 1e-3;
        match first {
            None => {
                free += 1;
                let missed = (1..5).find(|&other| deep(&own, &courses[other].1, during, tolerance));
                assert_eq!(missed, None, "seed {seed}");
            }
            Some(first) => {
                met += 1;
                let first_other = first.other;
                let time = first.conflict.time.lo.to_f64();
                let possible = truth(first.other, 2.0 * tolerance).outer;
                let begin = possible.first().map_or(f64::INFINITY, |first| first.0 / speed(first_other));
                assert!(begin <= time + 1e-6, "seed {seed}: {first:?}, not before {begin}");
                let earlier = (1..5).find(|&other| {
                    let before = [during[0], time - 1e-3];
                    before[0] < before[1] && deep(&own, &courses[other].1, before, tolerance)
                });
                assert_eq!(earlier, None, "seed {seed}: before {first:?}");
                let depth = first.conflict.depth.to_f64();
                let clearance = Truth::new(&[own.clone(), courses[first.other].1.clone()])
                    .clearance(first.conflict.deepest.time.to_f64());
                assert!(
                    (clearance + depth).abs() <= 2.0 * tolerance || first.conflict.touching,
                    "seed {seed}: {first:?}"
                );
            }
        }
    }
    assert!(met * 20 > cases && free * 20 > cases, "{met} met, {free} free");
}

/// Whether two discs overlap for sure, by more than the tolerance.
fn deep(a: &Driven, b: &Driven, during: [f64; 2], tolerance: f64) -> bool {
    let smaller = (a.0.grown(-2.0 * tolerance), a.1.clone(), a.2);
    !contacts(&smaller, b, [a.2, b.2], during, 0.0).inner.is_empty()
}

#[test]
fn the_first_conflict_with_a_row_is_that_of_the_definition() {
    let cases = if cfg!(debug_assertions) { 100 } else { 2_000 };
    first_of_rows::<f64>(cases);
    first_of_rows::<f32>(cases);
    first_of_rows::<Q16>(cases);
}

#[test]
fn the_first_conflict_with_a_row_has_known_answers() {
    let first = |courses: &[Course<f64>]| {
        let fleet: Vec<Motion<'_, f64>> = courses.iter().map(Course::motion).collect();
        let ecm = build_ecm(&fleet).expect("a small table");
        first_conflict(&fleet[0], ecm.row(&fleet, 0), Interval::new(-1.0, 20.0)).map(|met| (met.other, met.conflict))
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
