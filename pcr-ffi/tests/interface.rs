//! The C functions, called as C does: the numbers are those of the core, and what is wrong is told.

use pcr_ffi::*;
use std::ptr::{null, null_mut};

/// Memory for a small fleet. It is leaked, as the fleet keeps it for good.
fn memory(agents: usize, entries: usize, pieces: usize) -> PcrMemory {
    fn slots<T: Copy>(empty: T, count: usize) -> *mut T {
        Box::leak(vec![empty; count].into_boxed_slice()).as_mut_ptr()
    }
    PcrMemory {
        segments: slots(PcrSegment::EMPTY, 2 * agents),
        segment_count: 2 * agents,
        phases: slots(PcrPhase::EMPTY, 3 * agents),
        phase_count: 3 * agents,
        motions: slots(PcrMotion::EMPTY, agents),
        motion_count: agents,
        entries: slots(PcrEntry::EMPTY, entries),
        entry_count: entries,
        pieces: slots(PcrPiece::EMPTY, pieces),
        piece_count: pieces,
    }
}

const LEGS: [PcrLeg; 1] = [PcrLeg { curve: PCR_LINE, length: 4.0, radius: 0.0 }];

/// On a line of 4 m through the origin in its middle.
fn agent(heading: f32) -> PcrAgent {
    PcrAgent {
        x: -2.0 * heading.cos(),
        y: -2.0 * heading.sin(),
        heading,
        radius: 0.25,
        start: 0.0,
        legs: LEGS.as_ptr(),
        leg_count: LEGS.len(),
        speed: 1.0,
        acceleration: 1.0,
        stretches: null(),
        stretch_count: 0,
    }
}

fn fleet(memory: &PcrMemory, agents: &[PcrAgent]) -> PcrFleet {
    let mut fleet = PcrFleet::EMPTY;
    assert_eq!(pcr_fleet_init(Some(&mut fleet), Some(memory)), PcrStatus::Ok);
    for agent in agents {
        assert_eq!(pcr_fleet_add(Some(&mut fleet), Some(agent)), PcrStatus::Ok);
    }
    fleet
}

fn regions(fleet: &PcrFleet, ego: usize) -> Vec<PcrRegion> {
    let (mut out, mut count) = ([PcrRegion::default(); 8], 0);
    assert_eq!(pcr_fleet_regions(Some(fleet), ego, out.as_mut_ptr(), out.len(), Some(&mut count)), PcrStatus::Ok);
    out[..count].to_vec()
}

/// Within the rounding of `f32` at some metres and seconds, and the tolerance of the search for conflicts.
fn near(interval: PcrInterval, lo: f32, hi: f32) -> bool {
    (interval.lo - lo).abs() < 1e-4 && (interval.hi - hi).abs() < 1e-4
}

#[test]
fn a_crossing_at_right_angles_has_the_numbers_of_the_hand_calculation() {
    let mut fleet = fleet(&memory(2, 4, 4), &[agent(0.0), agent(std::f32::consts::FRAC_PI_2)]);
    assert_eq!(regions(&fleet, 0), [], "not yet");
    assert_eq!(pcr_fleet_build(Some(&mut fleet)), PcrStatus::Ok);
    // 1 s and 0.5 m to speed up, then 1.5 m at 1 m/s to the crossing; the discs reach 0.5 m.
    let [region] = regions(&fleet, 0)[..] else { panic!("one region") };
    assert!(near(region.time, 2.0, 3.0) && near(region.length, 1.5, 2.5), "{region:?}");
    assert_eq!((region.ego, region.other, region.open_start, region.open_end), (0, 1, false, false));

    let (mut slices, mut count) = ([PcrInterval::default(); 2], 0);
    let asked = pcr_fleet_slices(Some(&fleet), 0, 1, 2.5, slices.as_mut_ptr(), 2, Some(&mut count));
    assert!(asked == PcrStatus::Ok && count == 1 && near(slices[0], 1.5, 2.5), "{slices:?}");

    let (mut conflicts, mut count) = ([PcrConflict::default(); 2], 0);
    let asked = pcr_fleet_conflicts(Some(&fleet), 0, 1, conflicts.as_mut_ptr(), 2, Some(&mut count));
    assert!(asked == PcrStatus::Ok && count == 1, "{conflicts:?}");
    // At 1 m/s each, at right angles: within 0.5 m of each other while |t - 2.5| < 0.5 / √2.
    let half = 0.5_f32.sqrt() / 2.0;
    let [conflict, _] = conflicts;
    assert!(near(conflict.time, 2.5 - half, 2.5 + half) && (conflict.depth - 0.5).abs() < 3e-5, "{conflict:?}");

    // Two seconds later the other is out of the way; its region comes later, at the same lengths.
    assert_eq!(pcr_fleet_delay(Some(&mut fleet), 1, 2.0), PcrStatus::Ok);
    let [later] = regions(&fleet, 0)[..] else { panic!("one region") };
    assert!(near(later.time, 4.0, 5.0) && later.length == region.length);
    let asked = pcr_fleet_conflicts(Some(&fleet), 0, 1, conflicts.as_mut_ptr(), 2, Some(&mut count));
    assert_eq!((asked, count), (PcrStatus::Ok, 0));
}

#[test]
fn an_agent_that_stands_and_a_profile_are_taken() {
    let standing = PcrAgent { x: 0.0, y: 0.3, legs: null(), leg_count: 0, ..agent(0.0) };
    let stretches = [PcrStretch { duration: 1.0, acceleration: 0.0 }, PcrStretch { duration: 2.0, acceleration: 0.0 }];
    let steady =
        PcrAgent { speed: 4.0 / 3.0, stretches: stretches.as_ptr(), stretch_count: stretches.len(), ..agent(0.0) };
    let mut fleet = fleet(&memory(2, 4, 4), &[steady, standing]);
    assert_eq!(pcr_fleet_build(Some(&mut fleet)), PcrStatus::Ok);
    let [region] = regions(&fleet, 0)[..] else { panic!("one region") };
    assert!(near(region.length, 1.6, 2.4) && region.open_start && region.open_end, "3-4-5: {region:?}");
    let [region] = regions(&fleet, 1)[..] else { panic!("one region") };
    assert!(near(region.time, 1.2, 1.8), "1.6 m and 2.4 m at 4/3 m/s: {region:?}");
}

#[test]
fn what_is_wrong_is_told_and_changes_nothing() {
    let good = agent(0.0);
    let mut fleet = fleet(&memory(2, 4, 4), &[good]);
    let legs = |curve, length, radius| [PcrLeg { curve, length, radius }];
    let cases = [
        (legs(3, 4.0, 0.0), PcrStatus::NoSuchCurve),
        (legs(PCR_LINE, -1.0, 0.0), PcrStatus::Negative),
        (legs(PCR_LINE, f32::NAN, 0.0), PcrStatus::NonFinite),
        (legs(PCR_LINE, 1e7, 0.0), PcrStatus::OutOfRange),
        (legs(PCR_LEFT, 1.0, 0.0), PcrStatus::NonPositive),
        (legs(PCR_RIGHT, 7.0, 1.0), PcrStatus::SweepOverOneTurn),
    ];
    for (legs, expected) in &cases {
        let bad = PcrAgent { legs: legs.as_ptr(), ..good };
        assert_eq!(pcr_fleet_add(Some(&mut fleet), Some(&bad)), *expected);
    }
    let long = [LEGS[0]; 5];
    let stretch = [PcrStretch { duration: 1.0, acceleration: 0.0 }];
    let cases = [
        (PcrAgent { radius: 0.0, ..good }, PcrStatus::NonPositive),
        (PcrAgent { x: f32::INFINITY, ..good }, PcrStatus::NonFinite),
        (PcrAgent { legs: null(), ..good }, PcrStatus::Null),
        (PcrAgent { legs: long.as_ptr(), leg_count: long.len(), ..good }, PcrStatus::NoRoom),
        (PcrAgent { stretches: stretch.as_ptr(), stretch_count: 1, ..good }, PcrStatus::LengthMismatch),
    ];
    for (bad, expected) in &cases {
        assert_eq!(pcr_fleet_add(Some(&mut fleet), Some(bad)), *expected, "{bad:?}");
    }
    // There is as much room as before.
    assert_eq!(pcr_fleet_agents(Some(&fleet)), 1);
    assert_eq!(pcr_fleet_add(Some(&mut fleet), Some(&agent(1.0))), PcrStatus::Ok);
    assert_eq!(pcr_fleet_add(Some(&mut fleet), Some(&agent(2.0))), PcrStatus::NoRoom);
    assert_eq!(pcr_fleet_build(Some(&mut fleet)), PcrStatus::Ok);
    let mut count = 7;
    let none = pcr_fleet_regions(Some(&fleet), 0, null_mut(), 0, Some(&mut count));
    assert_eq!((none, count), (PcrStatus::BufferTooSmall, 1));
    let stranger = pcr_fleet_regions(Some(&fleet), 2, null_mut(), 0, Some(&mut count));
    assert_eq!(stranger, PcrStatus::NoSuchAgent);
    assert_eq!(pcr_fleet_regions(Some(&fleet), 0, null_mut(), 1, Some(&mut count)), PcrStatus::Null);
    assert_eq!(pcr_fleet_delay(Some(&mut fleet), 0, f32::NAN), PcrStatus::NonFinite);
    assert_eq!(pcr_fleet_delay(Some(&mut fleet), 9, 1.0), PcrStatus::NoSuchAgent);
    let slices = pcr_fleet_slices(Some(&fleet), 0, 1, f32::NAN, null_mut(), 0, Some(&mut count));
    assert_eq!(slices, PcrStatus::NonFinite);
}

#[test]
fn null_pointers_are_told() {
    let mut fleet = PcrFleet::EMPTY;
    assert_eq!(pcr_fleet_init(None, Some(&memory(1, 1, 1))), PcrStatus::Null);
    assert_eq!(pcr_fleet_init(Some(&mut fleet), None), PcrStatus::Null);
    let without = PcrMemory { motions: null_mut(), ..memory(1, 1, 1) };
    assert_eq!(pcr_fleet_init(Some(&mut fleet), Some(&without)), PcrStatus::Null);
    assert_eq!(pcr_fleet_add(None, Some(&agent(0.0))), PcrStatus::Null);
    assert_eq!(pcr_fleet_build(None), PcrStatus::Null);
    assert_eq!(pcr_fleet_agents(None), 0);
}

#[test]
fn a_full_table_is_told_and_empty() {
    let agents = [agent(0.0), agent(0.5), agent(1.0)];
    for (entries, pieces) in [(2, 8), (8, 2)] {
        let mut fleet = fleet(&memory(3, entries, pieces), &agents);
        assert_eq!(pcr_fleet_build(Some(&mut fleet)), PcrStatus::TableFull);
        assert_eq!(regions(&fleet, 0), []);
    }
    let mut fleet = fleet(&memory(3, 3, 3), &agents);
    for _ in 0..3 {
        assert_eq!(pcr_fleet_build(Some(&mut fleet)), PcrStatus::Ok, "as often as one likes");
        assert_eq!(regions(&fleet, 0).len(), 2);
    }
}
