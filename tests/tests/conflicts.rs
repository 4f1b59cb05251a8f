//! Conflicts of two given motions against an oracle that halves time until the way travelled decides.

use pcr_core::{Aabb, BroadPhase, ClosestApproach, Conflict, Encounter, Interval};
use pcr_fixed::Q16;
use pcr_planning::fleet::HostScalar;
use pcr_tests::disc::{Course, Disc, Drive, Driven, Leg};
use pcr_tests::generators::driven_pairs;
use pcr_tests::oracle::contact::Meeting;
use pcr_tests::oracle::line::{Intervals, nearest};
use pcr_tests::settings::settings;
use proptest::prelude::*;

fn within(inner: [f64; 2], outer: &[[f64; 2]], slip: f64) -> bool {
    outer.iter().any(|outer| outer[0] - slip <= inner[0] && inner[1] <= outer[1] + slip)
}

fn audited<S: HostScalar>(driven: &[Driven; 2]) -> Result<(), TestCaseError> {
    let [Some((ego, own)), Some((other, their))] = driven.each_ref().map(Course::<S>::rounded) else {
        return Err(TestCaseError::reject("does not fit"));
    };
    let truth = Meeting::new(&own, &their);
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

    let contacts = truth.contacts(during, tolerance);
    audited_contacts(&truth, &contacts, &reported, during, slip)?;
    // In parts of the time, and with room for boxes to spare.
    let fleet = [ego, other];
    for (room, parts) in [(2 * 2, 1), (2 * 6, 4), (2 * 17 + 1, 16), (99, 32)] {
        let broad_phase = BroadPhase::new(vec![Aabb::default(); room], &fleet, time).unwrap();
        prop_assert_eq!(broad_phase.parts(), parts);
        let found: Vec<_> = broad_phase.contacts().collect();
        prop_assert!(found.iter().all(|&(agents, _)| agents == [0, 1]));
        let found: Vec<[f64; 2]> =
            found.iter().map(|(_, contact)| [contact.lo.to_f64(), contact.hi.to_f64()]).collect();
        audited_contacts(&truth, &contacts, &found, during, slip)?;
    }
    // Where, and how deep.
    let conflicts: Vec<Conflict<S>> = encounter.conflicts(time).collect();
    prop_assert_eq!(conflicts.len(), reported.len());
    for (conflict, contact) in conflicts.iter().zip(&reported) {
        prop_assert_eq!([conflict.time.lo.to_f64(), conflict.time.hi.to_f64()], *contact);
        let depth = audited_approach(&truth, &conflict.deepest, *contact, tolerance)?;
        prop_assert!((conflict.depth.to_f64() - depth.max(0.0)).abs() <= tolerance);
        prop_assert_eq!(conflict.touching, conflict.depth <= encounter.tolerance().half());
        for (length, travel) in [(conflict.length, &truth.travels[0]), (conflict.other_length, &truth.travels[1])] {
            for (end, time) in [(length.lo, contact[0]), (length.hi, contact[1])] {
                prop_assert!((end.to_f64() - travel.length_at(time)).abs() <= tolerance);
            }
        }
    }
    audited_approach(&truth, &encounter.closest(time), during, tolerance)?;
    Ok(())
}

/// Nothing is missed, nothing is invented.
fn audited_contacts(
    truth: &Meeting,
    contacts: &Intervals,
    reported: &[[f64; 2]],
    during: [f64; 2],
    slip: f64,
) -> Result<(), TestCaseError> {
    for contact in contacts.inner.iter().map(|&(begin, end)| [begin, end]) {
        prop_assert!(within(contact, reported, slip), "{contact:?} is missing in {reported:?}");
    }
    let possible: Vec<[f64; 2]> = contacts.outer.iter().map(|&(begin, end)| [begin, end]).collect();
    for (k, &contact) in reported.iter().enumerate() {
        prop_assert!(within(contact, &possible, slip + 2e-9 / truth.speed), "{contact:?} is not in {possible:?}");
        prop_assert!(during[0] <= contact[0] && contact[0] <= contact[1] && contact[1] <= during[1]);
        prop_assert!(k == 0 || reported[k - 1][1] <= contact[0], "in order");
    }
    Ok(())
}

/// The depth at an approach, which has to be the greatest.
fn audited_approach<S: HostScalar>(
    truth: &Meeting,
    approach: &ClosestApproach<S>,
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
fn steps_bound(truth: &Meeting, during: [f64; 2], tolerance: f64) -> f64 {
    let acceleration = truth.speed * truth.speed / 1e-3 + 100.0;
    let smallest = (2.0 * tolerance / acceleration).sqrt();
    100.0 + 4.0 * (during[1] - during[0]) / smallest
}

proptest! {
    #![proptest_config(settings(1_000, 10, 41))]
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
        let truth = Meeting::new(&ego, &other);
        let [(a, _), (b, _)] = [&ego, &other].map(|driven| Course::<f64>::rounded(driven).expect("a valid disc"));
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
