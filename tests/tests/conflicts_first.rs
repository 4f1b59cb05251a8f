//! The first conflict of an agent with its row of the table against the definition.

use pcr_core::{Encounter, Interval, Motion, first_conflict};
use pcr_fixed::Q16;
use pcr_planning::fleet::{HostScalar, build_ecm};
use pcr_tests::disc::{Course, Disc, Driven};
use pcr_tests::generators::{Dice, drive, leg};
use pcr_tests::oracle::contact::Meeting;
use std::f64::consts::PI;

/// The earliest conflict of the first agent of random fleets with its row of the table is that of the definition.
fn first_of_rows<S: HostScalar>(cases: u64) {
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
        let Some(courses) = driven.iter().map(Course::<S>::rounded).collect::<Option<Vec<_>>>() else { continue };
        let fleet: Vec<Motion<'_, S>> = courses.iter().map(|(course, _)| course.motion()).collect();
        let ecm = build_ecm(&fleet).expect("a small table");
        // Another motion than the table was made for: a later start.
        let ego = fleet[0].delayed(S::from_f64(1.0)).expect("a valid delay");
        let all = fleet.iter().map(Motion::time).fold(ego.time(), Interval::hull);
        let during = [all.lo.to_f64(), all.hi.to_f64()];
        let first = first_conflict(&ego, ecm.row(&fleet, 0).expect("the table of the fleet"), all).expect("its path");
        let tolerance = (1..5).map(|k| Encounter::new(&ego, &fleet[k]).tolerance().to_f64()).fold(0.0, f64::max);
        let own = (courses[0].1.0.clone(), courses[0].1.1.clone(), ego.time().lo.to_f64());
        match first {
            None => {
                free += 1;
                let missed = (1..5).find(|&other| deep(&own, &courses[other].1, during, tolerance));
                assert_eq!(missed, None, "seed {seed}");
            }
            Some(first) => {
                met += 1;
                let truth = Meeting::new(&own, &courses[first.other].1);
                let time = first.conflict.time.lo.to_f64();
                let possible = truth.contacts(during, 2.0 * tolerance).outer;
                let begin = possible.first().map_or(f64::INFINITY, |first| first.0);
                assert!(begin <= time + 1e-6, "seed {seed}: {first:?}, not before {begin}");
                let earlier = (1..5).find(|&other| {
                    let before = [during[0], time - 1e-3];
                    before[0] < before[1] && deep(&own, &courses[other].1, before, tolerance)
                });
                assert_eq!(earlier, None, "seed {seed}: before {first:?}");
                let depth = first.conflict.depth.to_f64();
                let clearance = truth.clearance(first.conflict.deepest.time.to_f64());
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
    !Meeting::new(&smaller, b).contacts(during, 0.0).inner.is_empty()
}

#[test]
fn the_first_conflict_with_a_row_is_that_of_the_definition() {
    let cases = if cfg!(optimized) { 2_000 } else { 100 };
    first_of_rows::<f64>(cases);
    first_of_rows::<f32>(cases);
    first_of_rows::<Q16>(cases);
}
