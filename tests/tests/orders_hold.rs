//! How far the second may go past a region, against the definition in coordination space: nothing below the hold touches the
//! rest of the region, and at the hold something of it is within reach.

use pcr_core::scalar::Micro;
use pcr_core::{Interval, MovementAuthority, RegionRef};
use pcr_fixed::{Q12, Q16, Q20};
use pcr_planning::fleet::{HostScalar, build_ecm};
use pcr_tests::disc::{Course, Disc, Leg};
use pcr_tests::generators::pairs;
use pcr_tests::oracle::Pair;
use pcr_tests::oracle::line::{below, reaches};
use pcr_tests::settings::settings;
use proptest::prelude::*;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Lengths below a hold that are tried: evenly spaced, and nearer and nearer to it.
fn lengths_below(from: f64, hold: f64) -> impl Iterator<Item = f64> {
    let even = (0..16).map(move |k| from + (hold - from) * f64::from(k) / 16.0);
    even.chain((5..40).step_by(5).map(move |k| hold - (hold - from) * 0.5_f64.powi(k)))
}

fn audited<S: HostScalar>(discs: [Disc; 2], [at, other_at]: [f64; 2]) -> Result<(), TestCaseError> {
    let discs = discs.map(|disc| disc.rounded::<S>());
    let (Ok(ego), Ok(other)) = (Course::<S>::new(&discs[0]), Course::<S>::new(&discs[1])) else {
        return Err(TestCaseError::reject("does not fit"));
    };
    let pair = Pair::new(&discs[0], &discs[1]);
    let fleet = [ego.motion(), other.motion()];
    let ecm = build_ecm(&fleet).expect("two agents");
    let [end, other_end] = fleet.each_ref().map(|motion| motion.path().length());
    let [from, other_from] =
        [(at, end), (other_at, other_end)].map(|(part, end)| S::from_f64(part * end.to_f64()).min(end));
    for region in ecm.pair(&fleet, 0, 1).expect("the table of the fleet") {
        for from in [S::ZERO, from] {
            for other_from in [S::ZERO, other_from, region.other_length().lo, region.other_length().middle()] {
                hold_is_that_of_the_definition(&pair, &region, from, other_from)?;
            }
        }
        let left = region.other_length().hi < other_end;
        prop_assert!(!left || region.hold(from, other_end) == MovementAuthority::Free, "it has left {region:?}");
    }
    Ok(())
}

fn hold_is_that_of_the_definition<S: HostScalar>(
    pair: &Pair,
    region: &RegionRef<'_, S>,
    from: S,
    other_from: S,
) -> Result<(), TestCaseError> {
    let hold = region.hold(from, other_from);
    let all = region.ego_motion().path().length().to_f64();
    let [lo, hi] = [other_from.to_f64(), region.other_motion().path().length().to_f64()];
    let context = || format!("{hold:?} from {from:?}, other from {other_from:?}, {region:?}");
    // Nothing is hidden below it. Of several regions of a pair the table tells which one it is.
    let until = match hold {
        MovementAuthority::Free => Some(all),
        MovementAuthority::At(hold) => Some(hold.to_f64()),
        MovementAuthority::Inside => None,
    };
    for l in until.into_iter().flat_map(|until| lengths_below(from.to_f64(), until)) {
        let deep = below(|s| pair.clearance(s, l) + 1e-12, lo, hi, 0.0, 1e-9).inner;
        for (begin, end) in deep {
            let s = S::from_f64(0.5 * (begin + end));
            let inside = region.contains(s, S::from_f64(l)) && pair.clearance(s.to_f64(), l) < -1e-9;
            prop_assert!(!inside, "contact at {s:?}, {l}: {}", context());
        }
    }
    // What it is held by is there.
    let at = match hold {
        MovementAuthority::Free => return Ok(()),
        MovementAuthority::At(hold) => {
            prop_assert!(from <= hold && hold.to_f64() <= all, "{}", context());
            hold
        }
        MovementAuthority::Inside => from,
    };
    let near = 2.0 * region.excess().to_f64() + 1e-12;
    let touches = region.pieces().any(|piece| {
        let [first, last] = [lo.max(piece.other_length.lo.to_f64()), hi.min(piece.other_length.hi.to_f64())];
        let holds = piece.length.contains(at) && first <= last;
        holds && reaches(|s| pair.clearance(s, at.to_f64()), first, last, near, 1e-10)
    });
    prop_assert!(touches, "nothing there: {}", context());
    Ok(())
}

macro_rules! formats {
    ($($name:ident: $format:ty),*) => { proptest! {
        #![proptest_config(settings(500, 5, 71))]
        $(#[test]
        fn $name((a, b) in pairs(), at in 0.0..1.0_f64, other_at in 0.0..1.0_f64) {
            audited::<$format>([a, b], [at, other_at])?;
        })*
    } };
}

formats! {
    holds_are_those_of_the_definition_f64: f64,
    holds_are_those_of_the_definition_f32: f32,
    holds_are_those_of_the_definition_micro: Micro,
    holds_are_those_of_the_definition_q20: Q20,
    holds_are_those_of_the_definition_q16: Q16,
    holds_are_those_of_the_definition_q12: Q12
}

fn course(start: [f64; 3], legs: &[Leg]) -> Course<f64> {
    Course::new(&Disc { radius: 0.5, start, legs: legs.to_vec() }).expect("a valid disc")
}

fn holds(ego: &Course<f64>, other: &Course<f64>, at: &[(f64, f64)]) -> Vec<Vec<MovementAuthority<f64>>> {
    let fleet = [ego.motion(), other.motion()];
    let ecm = build_ecm(&fleet).expect("two agents");
    let regions: Vec<_> = ecm.pair(&fleet, 0, 1).expect("the table of the fleet").collect();
    regions.iter().map(|region| at.iter().map(|&(from, other)| region.hold(from, other)).collect()).collect()
}

fn close(found: MovementAuthority<f64>, length: f64) -> bool {
    matches!(found, MovementAuthority::At(hold) if (hold - length).abs() < 1e-12)
}

#[test]
fn a_crossing_opens_when_the_first_is_through() {
    let east = course([-5.0, 0.0, 0.0], &[Leg::Line(10.0)]);
    let north = course([0.0, -5.0, FRAC_PI_2], &[Leg::Line(10.0)]);
    let found = holds(&east, &north, &[(0.0, 0.0), (0.0, 5.0), (0.0, 5.6), (0.0, 6.1), (4.5, 5.6)]);
    let found = &found[..];
    let [row] = found else { panic!("{found:?}") };
    assert!(close(row[0], 4.0) && close(row[1], 4.0), "{row:?}");
    assert!(close(row[2], 5.0 - 0.8), "{row:?}");
    // 4.5 m is inside what the other one has still to pass: 0.8 m before the crossing begins the contact.
    assert_eq!(row[3..], [MovementAuthority::Free, MovementAuthority::Inside]);
}

#[test]
fn what_holds_the_end_of_the_first_is_never_left_and_a_start_is_no_boundary() {
    let east = course([-5.0, 0.0, 0.0], &[Leg::Line(10.0)]);
    let parks = course([0.0, -5.0, FRAC_PI_2], &[Leg::Line(5.0)]);
    let found = &holds(&east, &parks, &[(0.0, 5.0), (0.0, 9.0)])[0];
    assert!(close(found[0], 4.0) && close(found[1], 4.0), "nobody is beyond its end: {found:?}");
    let leaves = course([-4.5, 0.0, FRAC_PI_2], &[Leg::Line(5.0)]);
    let found = &holds(&east, &leaves, &[(0.0, 0.0), (0.0, 0.8), (0.0, 1.1)])[0];
    assert_eq!(found[..], [MovementAuthority::Inside, MovementAuthority::Inside, MovementAuthority::Free]);
    let found = &holds(&leaves, &east, &[(0.0, 0.0)])[0];
    assert_eq!(found[..], [MovementAuthority::Inside], "neither can be second: they overlap at their starts");
}

#[test]
fn both_passes_of_the_seam_of_a_circle_are_regions_of_their_own() {
    let round = course([0.0, 0.0, 0.0], &[Leg::arc(3.0, TAU)]);
    let south = course([0.0, 4.0, -FRAC_PI_2], &[Leg::Line(7.0)]);
    let found = holds(&south, &round, &[(0.0, 0.0), (0.0, 2.0), (0.0, TAU * 3.0 - 2.0), (0.0, TAU * 3.0)]);
    assert_eq!(found.len(), 2, "{found:?}");
    // Seen from the one that crosses: at the start of the circle, and at its end where the other one stays.
    assert!(found.iter().any(|row| close(row[0], 3.0) && row[1] == MovementAuthority::Free), "{found:?}");
    assert!(found.iter().any(|row| close(row[3], 3.0)), "{found:?}");
}

#[test]
fn a_follower_in_a_bend_keeps_a_chord_of_the_combined_radius() {
    let legs = [Leg::arc(2.0, PI)];
    let (ego, other) = (course([0.0, 0.0, 0.0], &legs), course([2.0, 2.0, FRAC_PI_2], &[Leg::arc(2.0, FRAC_PI_2)]));
    // A chord of 1 m on a circle of radius 2 m.
    let back = 4.0 * 0.25_f64.asin();
    let found = &holds(&ego, &other, &[(0.0, 0.0), (0.0, 1.0), (0.0, 3.0)])[0];
    for (hold, at) in found.iter().zip([0.0, 1.0, 3.0]) {
        assert!(close(*hold, PI + at - back), "{hold:?} {at}");
    }
    let interval = Interval::new(0.0, PI);
    assert!(interval.contains(back));
}
