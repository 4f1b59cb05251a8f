//! Agents that may be late, one of two or both: each query counts each lateness on its own side.

use pcr_core::{Encounter, Interval, Motion, earliest_departure, earliest_start, safe_intervals, safe_lengths};
use pcr_planning::fleet::build_ecm;
use pcr_tests::disc::{Course, Disc, Drive, Leg};
use std::f64::consts::FRAC_PI_2;

/// Two ways of 4 m at 1 m/s that cross in their middles, the second one from 1.5 s on; discs of 0.25 m: the first one is in contact with
/// what the other has passed for 0.5 √2 s before and after it.
fn crossing() -> [Course<f64>; 2] {
    [([-2.0, 0.0, 0.0], 0.0), ([0.0, -2.0, FRAC_PI_2], 1.5)].map(|(start, at)| {
        let disc = Disc { radius: 0.25, start, legs: vec![Leg::Line(4.0)] };
        Course::driven(&disc, &Drive::Unit, at).expect("a valid disc")
    })
}

const LATE: [[f64; 2]; 4] = [[0.0, 0.0], [0.25, 0.0], [0.0, 0.5], [0.25, 0.5]];

fn late(courses: &[Course<f64>; 2], late: [f64; 2]) -> [Motion<'_, f64>; 2] {
    let motion = |agent: usize| courses[agent].motion().with_lateness(late[agent]).expect("a lateness");
    [motion(0), motion(1)]
}

fn close(found: f64, expected: f64) -> bool {
    (found - expected).abs() < 1e-6
}

#[test]
fn starts_are_those_outside_of_what_is_forbidden() {
    let courses = crossing();
    for [own, their] in LATE {
        let fleet = late(&courses, [own, their]);
        let ecm = build_ecm(&fleet).expect("a small table");
        let region = ecm.row(&fleet, 0).expect("its fleet").next().expect("a crossing");
        let forbidden = region.forbidden_delays();
        let half = 0.5 * 2.0_f64.sqrt();
        let [lo, hi] = [1.5 - half - own, 1.5 + half + their];
        assert!(close(forbidden.lo, lo) && close(forbidden.hi, hi), "{own} {their}: {forbidden:?}");
        for from in [lo - 0.1, lo + 0.01, 1.5 - half + 0.1, 1.5, 1.5 + half + 0.01, hi - 0.01, hi + 0.1] {
            let expected = if from < lo || from > hi { from } else { hi };
            let found = earliest_start(ecm.row(&fleet, 0).expect("its fleet"), from).expect("a start");
            assert!(close(found, expected), "{own} {their}, from {from}: {found}");
            // A wait on the way, half a metre before the contact begins.
            let found = earliest_departure(ecm.row(&fleet, 0).expect("its fleet"), 1.0, from.max(0.0));
            let found = found.expect("a wait");
            // What the ranges allow counts where somebody may be late, without a look for contacts.
            let ranges = if own + their > 0.0 { [0.5 - own, 2.5 + their] } else { [lo, hi] };
            let at_most = if from < ranges[0] || from > ranges[1] { from.max(0.0) } else { ranges[1] };
            let least = if from < lo || from > hi { from.max(0.0) } else { hi };
            assert!(least - 1e-6 <= found && found <= at_most + 1e-6, "{own} {their}, from {from}: {found}");
        }
    }
}

#[test]
fn windows_begin_and_end_with_what_is_still_to_come() {
    let courses = crossing();
    let place = Interval::new(2.0, 2.0);
    for [own, their] in LATE {
        let fleet = late(&courses, [own, their]);
        // It passes the middle from 1.5 m to 2.5 m of its path.
        let [lo, hi] = [3.0 - own, 4.0 + their];
        for (from, to) in [(0.0, 9.0), (2.9, 3.5), (3.5, 9.0), (4.1, 9.0), (4.3, 4.45), (0.0, 2.8), (0.0, 2.9)] {
            let safe = safe_intervals(&fleet, 0, place, Interval::new(from, to)).expect("an agent");
            let found: f64 = safe.map(|safe| safe.length()).sum();
            let blocked = (hi.min(to) - lo.max(from)).max(0.0);
            assert!(close(found, to - from - blocked), "{own} {their}, {from} to {to}: {found}");
        }
    }
}

#[test]
fn lengths_are_blocked_by_all_places_in_which_the_other_may_be() {
    let courses = crossing();
    let exact = late(&courses, [0.0; 2]);
    let blocked = |fleet: &[Motion<'_, f64>; 2], lo: f64, hi: f64| -> Vec<Interval<f64>> {
        Encounter::new(&fleet[0], &fleet[1]).blocked_lengths(Interval::new(lo, hi)).collect()
    };
    for [own, their] in LATE {
        let fleet = late(&courses, [own, their]);
        for at in [2.8, 3.0, 3.2, 3.5, 3.8, 4.1, 4.4, 4.6] {
            let [found, expected] = [blocked(&fleet, at, at), blocked(&exact, at - their, at + own)];
            assert_eq!(found.len(), expected.len(), "{own} {their} at {at}: {found:?} {expected:?}");
            for (found, expected) in found.iter().zip(&expected) {
                assert!(close(found.lo, expected.lo) && close(found.hi, expected.hi), "{own} {their} at {at}");
            }
            let safe: f64 =
                safe_lengths(&fleet, 0, Interval::new(at, at)).expect("an agent").map(Interval::length).sum();
            let kept: f64 = expected.iter().map(|blocked| blocked.length()).sum();
            assert!(close(safe, 4.0 - kept), "{own} {their} at {at}: {safe}");
        }
    }
    // At 3.5 s it is on the way of the first one: half a metre to each side.
    let at = blocked(&exact, 3.5, 3.5);
    assert!(close(at[0].lo, 1.5) && close(at[0].hi, 2.5), "{at:?}");
}
