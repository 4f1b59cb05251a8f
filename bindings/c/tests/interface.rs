//! The C functions, called as C does: the numbers are those of the core, and what is wrong is told.

use pcr_ffi::single::*;
use pcr_ffi::*;
use std::ptr::{null, null_mut};

/// Memory for a small fleet. It is leaked, as the fleet keeps it for good.
fn memory(agents: usize, entries: usize, pieces: usize) -> PcrMemory {
    fn slots<T: Copy>(empty: T, count: usize) -> *mut T {
        Box::leak(vec![empty; count].into_boxed_slice()).as_mut_ptr()
    }
    PcrMemory {
        segments: slots(PcrSegmentStorage::EMPTY, 2 * agents),
        segment_count: 2 * agents,
        phases: slots(PcrPhaseStorage::EMPTY, 3 * agents),
        phase_count: 3 * agents,
        motions: slots(PcrMotionStorage::EMPTY, agents),
        motion_count: agents,
        entries: slots(PcrRegionStorage::EMPTY, entries),
        entry_count: entries,
        pieces: slots(PcrPieceStorage::EMPTY, pieces),
        piece_count: pieces,
        orders: null_mut(),
        order_count: 0,
        robots: null_mut(),
        corners: slots(PcrCornerStorage::EMPTY, 4 * agents),
        corner_count: 4 * agents,
    }
}

const LEGS: [PcrPathSegment; 1] = [PcrPathSegment { curve: PCR_LINE, length: 4.0, radius: 0.0 }];

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
        corners: null(),
        corner_count: 0,
        facing: Default::default(),
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

/// What is said of agent 0 without its table.
fn not_built(fleet: &PcrFleet) -> [PcrStatus; 4] {
    let (mut count, mut delay, mut met, mut found) = (7, 7.0, PcrAgentConflict::default(), true);
    let seen = [
        pcr_fleet_regions(Some(fleet), 0, null_mut(), 0, Some(&mut count)),
        pcr_fleet_slices(Some(fleet), 0, 0, 1.0, null_mut(), 0, Some(&mut count)),
        pcr_fleet_first_conflict(Some(fleet), 0, true, Some(&mut met), Some(&mut found)),
        pcr_fleet_earliest_start(Some(fleet), 0, 0.0, Some(&mut delay)),
    ];
    assert_eq!((count, delay, met, found), (7, 7.0, PcrAgentConflict::default(), true), "nothing is told");
    seen
}

/// Within the rounding of `f32` at some metres and seconds, and the tolerance of the search for conflicts.
fn near(interval: PcrInterval, lo: f32, hi: f32) -> bool {
    (interval.lo - lo).abs() < 1e-4 && (interval.hi - hi).abs() < 1e-4
}

#[test]
fn a_crossing_at_right_angles_has_the_numbers_of_the_hand_calculation() {
    let mut fleet = fleet(&memory(2, 4, 4), &[agent(0.0), agent(std::f32::consts::FRAC_PI_2)]);
    assert_eq!(not_built(&fleet), [PcrStatus::NotBuilt; 4], "not yet");
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
    let stretches =
        [PcrProfilePhase { duration: 1.0, acceleration: 0.0 }, PcrProfilePhase { duration: 2.0, acceleration: 0.0 }];
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
    let legs = |curve, length, radius| [PcrPathSegment { curve, length, radius }];
    let cases = [
        (legs(6, 4.0, 0.0), PcrStatus::NoSuchCurve),
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
    let stretch = [PcrProfilePhase { duration: 1.0, acceleration: 0.0 }];
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
    // Nobody is in conflict with itself.
    for (ego, other) in [(0, 0), (1, 1), (0, 9), (9, 0)] {
        let none = pcr_fleet_conflicts(Some(&fleet), ego, other, null_mut(), 0, Some(&mut count));
        let slices = pcr_fleet_slices(Some(&fleet), ego, other, 2.0, null_mut(), 0, Some(&mut count));
        assert_eq!([none, slices], [PcrStatus::NoSuchAgent; 2]);
    }
}

#[test]
fn null_pointers_are_told() {
    let mut fleet = PcrFleet::EMPTY;
    assert_eq!(pcr_fleet_init(None, Some(&memory(1, 1, 1))), PcrStatus::Null);
    assert_eq!(pcr_fleet_init(Some(&mut fleet), None), PcrStatus::Null);
    let without = PcrMemory { motions: null_mut(), ..memory(1, 1, 1) };
    assert_eq!(pcr_fleet_init(Some(&mut fleet), Some(&without)), PcrStatus::Null);
    // Where there is none of something its pointer may be null, as that of an empty vector is.
    let nothing = PcrMemory {
        segments: null_mut(),
        segment_count: 0,
        phases: null_mut(),
        phase_count: 0,
        motions: null_mut(),
        motion_count: 0,
        entries: null_mut(),
        entry_count: 0,
        pieces: null_mut(),
        piece_count: 0,
        ..memory(1, 1, 1)
    };
    assert_eq!(pcr_fleet_init(Some(&mut fleet), Some(&nothing)), PcrStatus::Ok);
    assert_eq!(pcr_fleet_add(Some(&mut fleet), Some(&agent(0.0))), PcrStatus::NoRoom);
    assert_eq!(pcr_fleet_build(Some(&mut fleet)), PcrStatus::Ok);
    assert_eq!(pcr_fleet_add(None, Some(&agent(0.0))), PcrStatus::Null);
    assert_eq!(pcr_fleet_build(None), PcrStatus::Null);
    assert_eq!(pcr_fleet_agents(None), 0);
}

#[test]
fn a_full_table_is_told_and_is_none() {
    let agents = [agent(0.0), agent(0.5), agent(1.0)];
    for (entries, pieces) in [(2, 8), (8, 2)] {
        let mut fleet = fleet(&memory(3, entries, pieces), &agents);
        assert_eq!(pcr_fleet_build(Some(&mut fleet)), PcrStatus::TableFull);
        assert_eq!(not_built(&fleet), [PcrStatus::NotBuilt; 4]);
    }
    let mut fleet = fleet(&memory(3, 3, 3), &agents);
    for _ in 0..3 {
        assert_eq!(pcr_fleet_build(Some(&mut fleet)), PcrStatus::Ok, "as often as one likes");
        assert_eq!(regions(&fleet, 0).len(), 2);
    }
}

#[test]
fn a_table_without_an_agent_that_was_added_answers_nothing() {
    let crossing = agent(std::f32::consts::FRAC_PI_2);
    let mut fleet = fleet(&memory(3, 4, 4), &[agent(0.0)]);
    assert_eq!(not_built(&fleet), [PcrStatus::NotBuilt; 4], "never built");
    assert_eq!(pcr_fleet_build(Some(&mut fleet)), PcrStatus::Ok);
    assert_eq!(regions(&fleet, 0), [], "there is nobody else");
    assert_eq!(pcr_fleet_add(Some(&mut fleet), Some(&crossing)), PcrStatus::Ok);
    assert_eq!(not_built(&fleet), [PcrStatus::NotBuilt; 4], "added since");
    assert_eq!(pcr_fleet_build(Some(&mut fleet)), PcrStatus::Ok);
    assert_eq!(regions(&fleet, 0).len(), 1);
}

/// What is said of the regions of each agent.
fn told(fleet: &PcrFleet) -> Vec<PcrStatus> {
    let mut count = 0;
    let agents = 0..pcr_fleet_agents(Some(fleet));
    agents.map(|ego| pcr_fleet_regions(Some(fleet), ego, null_mut(), 0, Some(&mut count))).collect()
}

#[test]
fn a_row_is_kept_only_if_its_own_agent_is_replaced() {
    let agents = [agent(0.0), agent(0.7), agent(1.4)];
    let row = || {
        let mut fleet = fleet(&memory(4, 16, 32), &agents);
        assert_eq!(pcr_fleet_build_row(Some(&mut fleet), 1), PcrStatus::Ok);
        fleet
    };
    // The buffer has no room: the row is there.
    let kept = [PcrStatus::OnlyRow, PcrStatus::BufferTooSmall, PcrStatus::OnlyRow];
    assert_eq!(told(&row()), kept);
    for (index, after) in [(1, kept), (0, [PcrStatus::NotBuilt; 3]), (2, [PcrStatus::NotBuilt; 3])] {
        let mut fleet = row();
        assert_eq!(pcr_fleet_replace(Some(&mut fleet), index, Some(&agent(2.1))), PcrStatus::Ok);
        assert_eq!(told(&fleet), after, "{index} replaced");
        let mut fleet = row();
        assert_eq!(pcr_fleet_remove(Some(&mut fleet), index), PcrStatus::Ok);
        assert_eq!(told(&fleet), [PcrStatus::NotBuilt; 2], "{index} removed");
    }
}

/// A fleet of agents through the origin at these angles, built.
fn star(agents: &[PcrAgent]) -> PcrFleet {
    let mut fleet = fleet(&memory(agents.len() + 1, 16, 32), agents);
    assert_eq!(pcr_fleet_build(Some(&mut fleet)), PcrStatus::Ok);
    fleet
}

fn table(fleet: &PcrFleet) -> Vec<PcrRegion> {
    (0..pcr_fleet_agents(Some(fleet))).flat_map(|ego| regions(fleet, ego)).collect()
}

#[test]
fn replaced_agents_have_the_table_of_a_fleet_that_was_added_so() {
    let legs = [LEGS[0], PcrPathSegment { curve: PCR_LEFT, length: 1.0, radius: 1.0 }];
    let bent = |heading| PcrAgent { legs: legs.as_ptr(), leg_count: 2, ..agent(heading) };
    let mut agents = [agent(0.0), agent(0.7), agent(1.4), agent(2.1)];
    let mut fleet = star(&agents);
    // More often than there is memory for without giving any back.
    for round in 0..40 {
        let (index, heading) = (round * 7 % 4, round as f32 * 0.3);
        let by = if round % 3 == 0 { bent(heading) } else { agent(heading) };
        assert_eq!(pcr_fleet_replace(Some(&mut fleet), index, Some(&by)), PcrStatus::Ok, "round {round}");
        agents[index] = by;
        assert_eq!(table(&fleet), table(&star(&agents)), "round {round}");
    }
    let before = table(&fleet);
    let flat = PcrAgent { radius: 0.0, ..agent(0.0) };
    assert_eq!(pcr_fleet_replace(Some(&mut fleet), 0, Some(&flat)), PcrStatus::NonPositive);
    assert_eq!(pcr_fleet_replace(Some(&mut fleet), 4, Some(&agent(0.0))), PcrStatus::NoSuchAgent);
    assert_eq!(pcr_fleet_replace(Some(&mut fleet), 0, None), PcrStatus::Null);
    let long = [LEGS[0]; 11];
    let long = PcrAgent { legs: long.as_ptr(), leg_count: long.len(), ..agent(0.0) };
    assert_eq!(pcr_fleet_replace(Some(&mut fleet), 0, Some(&long)), PcrStatus::NoRoom);
    assert_eq!(table(&fleet), before);
}

#[test]
fn a_replaced_agent_that_fills_the_table_changes_nothing() {
    let apart = PcrAgent { y: 50.0, ..agent(0.0) };
    let mut fleet = fleet(&memory(4, 1, 1), &[agent(0.0), agent(0.7), apart]);
    assert_eq!(pcr_fleet_build(Some(&mut fleet)), PcrStatus::Ok);
    let before = table(&fleet);
    assert_eq!(pcr_fleet_replace(Some(&mut fleet), 2, Some(&agent(1.4))), PcrStatus::TableFull);
    assert_eq!(table(&fleet), before);
}

#[test]
fn an_agent_gets_out_of_the_way_by_the_least_delay() {
    let mut fleet = star(&[agent(0.0), agent(std::f32::consts::FRAC_PI_2)]);
    let first = |fleet: &PcrFleet, touches| {
        let (mut met, mut found) = (PcrAgentConflict::default(), false);
        let asked = pcr_fleet_first_conflict(Some(fleet), 1, touches, Some(&mut met), Some(&mut found));
        assert_eq!(asked, PcrStatus::Ok);
        found.then_some(met)
    };
    let met = first(&fleet, false).expect("a conflict");
    assert!(met.other == 0 && (met.conflict.depth - 0.5).abs() < 3e-5 && !met.conflict.touching, "{met:?}");
    let mut delay = 0.0;
    assert_eq!(pcr_fleet_earliest_start(Some(&fleet), 1, 0.0, Some(&mut delay)), PcrStatus::Ok);
    // The discs pass at half a metre: 1 / sqrt(2) s at 1 m/s.
    assert!((delay - 0.5_f32.sqrt()).abs() < 1e-3, "{delay}");
    assert_eq!(pcr_fleet_delay(Some(&mut fleet), 1, delay), PcrStatus::Ok);
    assert_eq!(first(&fleet, false), None, "at most a touch");
    // Whoever asks for touches is told of them, not of nothing.
    assert!(first(&fleet, true).is_none_or(|met| met.conflict.touching));
    for (from, expected) in [(f32::NAN, PcrStatus::NonFinite), (1e7, PcrStatus::OutOfRange)] {
        assert_eq!(pcr_fleet_earliest_start(Some(&fleet), 1, from, Some(&mut delay)), expected);
    }
    // One that stands in the way for good.
    let standing = PcrAgent { x: 0.0, y: 0.0, legs: null(), leg_count: 0, ..agent(0.0) };
    let blocked = star(&[agent(0.0), standing]);
    assert_eq!(pcr_fleet_earliest_start(Some(&blocked), 0, 0.0, Some(&mut delay)), PcrStatus::NoPlan);
    assert_eq!(pcr_fleet_earliest_start(Some(&blocked), 2, 0.0, Some(&mut delay)), PcrStatus::NoSuchAgent);
}

#[test]
fn the_times_that_are_safe_leave_out_those_of_the_other() {
    let fleet = star(&[agent(0.0), agent(std::f32::consts::FRAC_PI_2)]);
    let (middle, all) = (PcrInterval { lo: 2.0, hi: 2.0 }, PcrInterval { lo: 0.0, hi: 9.0 });
    let (mut safe, mut count) = ([PcrInterval::default(); 4], 0);
    let mut ask = |ego, length, during, capacity| {
        pcr_fleet_safe_intervals(Some(&fleet), ego, length, during, safe.as_mut_ptr(), capacity, Some(&mut count))
    };
    assert_eq!(ask(0, middle, all, 1), PcrStatus::BufferTooSmall);
    assert_eq!(ask(2, middle, all, 4), PcrStatus::NoSuchAgent);
    assert_eq!(ask(0, middle, PcrInterval { lo: 1.0, hi: 0.0 }, 4), PcrStatus::OutOfRange);
    assert_eq!(ask(0, PcrInterval { lo: f32::NAN, hi: 0.0 }, all, 4), PcrStatus::NonFinite);
    // Nobody passes there, for it is not on the path; the ends, and what goes beyond them, are.
    for (lo, hi) in [(-2.0, -1.0), (-0.01, -0.01), (4.01, 4.01), (9.0, 12.0)] {
        assert_eq!(ask(0, PcrInterval { lo, hi }, all, 4), PcrStatus::OutOfRange, "{lo} to {hi}");
    }
    for (lo, hi) in [(-1.0, 0.0), (0.0, 0.0), (4.0, 4.0), (4.0_f32.next_up(), 4.0_f32.next_up()), (4.0, 9.0)] {
        assert_eq!(ask(0, PcrInterval { lo, hi }, all, 4), PcrStatus::Ok, "{lo} to {hi}");
    }
    assert_eq!(ask(0, middle, all, 4), PcrStatus::Ok);
    assert!(count == 2 && near(safe[0], 0.0, 2.0) && near(safe[1], 3.0, 9.0), "{safe:?}");
}

#[test]
fn a_plan_delays_the_fleet_and_none_leaves_it() {
    let mut fleet = star(&[agent(0.0), agent(0.7), agent(1.4)]);
    let mut room = [PcrMotionStorage::EMPTY; 3];
    let mut plan = |fleet: &mut PcrFleet, order: &mut [usize], rooms, why: &mut PcrPlanError| {
        pcr_fleet_plan_delays(Some(fleet), order.as_mut_ptr(), order.len(), room.as_mut_ptr(), rooms, Some(why))
    };
    let conflicts = |fleet: &PcrFleet| {
        let mut found = [false; 3];
        for (ego, found) in found.iter_mut().enumerate() {
            let asked =
                pcr_fleet_first_conflict(Some(fleet), ego, false, Some(&mut PcrAgentConflict::default()), Some(found));
            assert_eq!(asked, PcrStatus::Ok);
        }
        found
    };
    let mut why = PcrPlanError { reason: PcrPlanErrorKind::Times, agents: [7; 2] };
    assert_eq!(conflicts(&fleet), [true; 3]);
    for order in [&mut [0, 1][..], &mut [0, 1, 1], &mut [0, 1, 3], &mut [0, 1, 2, 2]] {
        assert_eq!(plan(&mut fleet, order, 3, &mut why), PcrStatus::BadOrder, "{order:?}");
    }
    assert_eq!(plan(&mut fleet, &mut [2, 0, 1], 2, &mut why), PcrStatus::NoRoom);
    assert_eq!((conflicts(&fleet), why.agents), ([true; 3], [7; 2]));
    assert_eq!(plan(&mut fleet, &mut [2, 0, 1], 3, &mut why), PcrStatus::Ok);
    assert_eq!((conflicts(&fleet), why.agents), ([false; 3], [7; 2]));

    let standing = PcrAgent { x: 0.0, y: 0.0, legs: null(), leg_count: 0, ..agent(0.0) };
    let mut blocked = star(&[agent(0.0), standing]);
    let before = table(&blocked);
    assert_eq!(plan(&mut blocked, &mut [0, 1], 2, &mut why), PcrStatus::NoPlan);
    assert_eq!(why, PcrPlanError { reason: PcrPlanErrorKind::Always, agents: [1, 0] });
    assert_eq!(table(&blocked), before);
    // The second would have to end later than the format can tell.
    let mut late = star(&[agent(0.0), agent(0.7)]);
    assert_eq!([0, 1].map(|place| pcr_fleet_delay(Some(&mut late), place, 999_994.5)), [PcrStatus::Ok; 2]);
    assert_eq!(plan(&mut late, &mut [0, 1], 2, &mut why), PcrStatus::NoPlan);
    assert_eq!(why, PcrPlanError { reason: PcrPlanErrorKind::Times, agents: [1; 2] });
    let mut unbuilt = star(&[agent(0.0)]);
    assert_eq!(pcr_fleet_add(Some(&mut unbuilt), Some(&agent(0.7))), PcrStatus::Ok);
    assert_eq!(plan(&mut unbuilt, &mut [0, 1], 2, &mut why), PcrStatus::NotBuilt);
}

/// A truck, 1.2 m long and 0.8 m wide, that drives 6 m.
const TRUCK: [PcrCorner; 4] = [
    PcrCorner { x: -0.6, y: -0.4 },
    PcrCorner { x: 0.6, y: -0.4 },
    PcrCorner { x: 0.6, y: 0.4 },
    PcrCorner { x: -0.6, y: 0.4 },
];

fn truck(x: f32, y: f32, heading: f32, legs: &[PcrPathSegment]) -> PcrAgent {
    let corners = (TRUCK.as_ptr(), TRUCK.len());
    let (legs, leg_count) = (legs.as_ptr(), legs.len());
    PcrAgent { x, y, radius: 0.0, legs, leg_count, corners: corners.0, corner_count: corners.1, ..agent(heading) }
}

fn line(length: f32) -> PcrPathSegment {
    PcrPathSegment { curve: PCR_LINE, length, radius: 0.0 }
}

#[test]
fn trucks_pass_each_other_a_millimetre_apart_and_not_closer() {
    let ahead = [line(6.0)];
    for (apart, expected) in [(0.801, 0), (0.799, 1)] {
        let agents = [truck(0.0, 0.0, 0.0, &ahead), truck(6.0, apart, std::f32::consts::PI, &ahead)];
        let mut fleet = fleet(&memory(2, 4, 8), &agents);
        assert_eq!(pcr_fleet_build(Some(&mut fleet)), PcrStatus::Ok);
        assert_eq!(regions(&fleet, 0).len(), expected, "{apart} m apart");
    }
}

#[test]
fn turns_in_place_gears_and_gaps_in_the_memory() {
    use std::f32::consts::{FRAC_PI_2, PI};
    // It turns by a quarter on the spot: its corners are 0.7211 m away from its centre, and 0.7 m is in their way.
    let pivot = [PcrPathSegment { curve: PCR_PIVOT_LEFT, length: 0.5 * FRAC_PI_2, radius: 0.5 }];
    let post = |y| PcrAgent { x: 0.0, y, radius: 0.05, legs: null(), leg_count: 0, ..agent(0.0) };
    // Reverse gear: from 2 m on it goes back, and its front stays behind the post beside its rear.
    let gears = [line(2.0), PcrPathSegment { curve: PCR_REVERSE, length: 0.0, radius: 0.0 }, line(3.0)];
    for (distance, expected) in [(0.7712, 0), (0.771, 1)] {
        let agents = [truck(9.0, 9.0, 0.0, &gears), truck(0.0, 0.0, 0.0, &pivot), post(distance)];
        let mut fleet = fleet(&memory(3, 8, 16), &agents);
        assert_eq!(pcr_fleet_build(Some(&mut fleet)), PcrStatus::Ok);
        assert_eq!(regions(&fleet, 1).len(), expected, "{distance} m away");
        // What is behind the removed truck moves down, with its corners, and the room is free again.
        assert_eq!(pcr_fleet_remove(Some(&mut fleet), 0), PcrStatus::Ok);
        assert_eq!(regions(&fleet, 0).len(), expected, "{distance} m away");
        assert_eq!(pcr_fleet_replace(Some(&mut fleet), 0, Some(&agents[1])), PcrStatus::Ok);
        assert_eq!(pcr_fleet_add(Some(&mut fleet), Some(&truck(0.0, 5.0, 0.0, &gears))), PcrStatus::Ok);
        assert_eq!(pcr_fleet_build(Some(&mut fleet)), PcrStatus::Ok);
        assert_eq!(regions(&fleet, 0).len(), expected, "{distance} m away");
    }
    // A change of gear moves nothing: at the end of a path, or twice, it is as if it were not there.
    let change = PcrPathSegment { curve: PCR_REVERSE, length: 0.0, radius: 0.0 };
    let path = |legs: &[PcrPathSegment]| {
        let mut fleet = fleet(&memory(2, 8, 16), &[truck(-2.0, 0.0, 0.0, legs), PcrAgent { x: 0.3, ..post(0.4) }]);
        assert_eq!(pcr_fleet_build(Some(&mut fleet)), PcrStatus::Ok);
        regions(&fleet, 0)
    };
    let plain = path(&[line(2.0), line(1.0)]);
    assert!(!plain.is_empty());
    assert_eq!(path(&[line(2.0), line(1.0), change]), plain);
    assert_eq!(path(&[line(2.0), change, change, line(1.0)]), plain);
    assert_ne!(path(&[line(2.0), change, line(1.0)]), plain);
    // It drives on in reverse with its fork, 2 m long, ahead of its rear all the time: at its end, its fork is in front of it.
    let fork = [
        PcrCorner { x: 0.0, y: -0.1 },
        PcrCorner { x: 2.0, y: -0.1 },
        PcrCorner { x: 2.0, y: 0.1 },
        PcrCorner { x: 0.0, y: 0.1 },
    ];
    for (facing, expected) in [(0.0, 1), (PI, 0)] {
        let forklift = PcrAgent { corners: fork.as_ptr(), facing, ..truck(-4.0, 0.0, 0.0, &gears[..1]) };
        let mut post = post(0.0);
        post.x = -0.5;
        let mut fleet = fleet(&memory(2, 8, 16), &[forklift, post]);
        assert_eq!(pcr_fleet_build(Some(&mut fleet)), PcrStatus::Ok);
        assert_eq!(regions(&fleet, 0).len(), expected, "facing {facing}");
    }
}

#[test]
fn a_refused_agent_is_told_with_the_entry_and_the_field() {
    let mut fleet = fleet(&memory(2, 4, 4), &[]);
    let mut told = PcrInputError { status: PcrStatus::Null, list: PcrInputList::Corners, index: 9, field: null() };
    let mut refused = |agent: PcrAgent| {
        let status = pcr_fleet_add(Some(&mut fleet), Some(&agent));
        assert_eq!(pcr_fleet_input_error(Some(&fleet), Some(&mut told)), PcrStatus::Ok);
        assert_eq!(told.status, status);
        // SAFETY: the field is never null, and ended by a zero.
        let field = unsafe { std::ffi::CStr::from_ptr(told.field) };
        (status, told.list, told.index, field.to_str().expect("ASCII"))
    };
    let legs = [line(4.0)];
    let far = [TRUCK[0], PcrCorner { x: f32::NAN, y: 0.0 }];
    let mut clockwise = TRUCK;
    clockwise.reverse();
    let sharp = [line(1.0), PcrPathSegment { curve: PCR_LEFT, length: 1.0, radius: 0.0 }];
    let stretches = [PcrProfilePhase { duration: -1.0, acceleration: 0.0 }];
    let good = truck(0.0, 0.0, 0.0, &legs);
    let outlined = |corners: &[PcrCorner]| PcrAgent { corners: corners.as_ptr(), corner_count: corners.len(), ..good };
    assert_eq!(refused(outlined(&far)), (PcrStatus::NonFinite, PcrInputList::Corners, 1, "x"));
    assert_eq!(refused(outlined(&clockwise)), (PcrStatus::NotConvex, PcrInputList::Agent, 0, ""));
    assert_eq!(refused(PcrAgent { radius: -1.0, ..good }), (PcrStatus::Negative, PcrInputList::Agent, 0, "radius"));
    assert_eq!(refused(truck(0.0, 0.0, 0.0, &sharp)), (PcrStatus::NonPositive, PcrInputList::Legs, 1, "radius"));
    let late = PcrAgent { stretches: stretches.as_ptr(), stretch_count: 1, ..good };
    assert_eq!(refused(late), (PcrStatus::Negative, PcrInputList::Stretches, 0, "duration"));
    assert_eq!(refused(good), (PcrStatus::Ok, PcrInputList::Agent, 0, ""));
}

#[test]
fn every_status_has_its_name_and_a_sentence() {
    let header =
        std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/include/pcr_common.h")).expect("a header");
    // SAFETY: both functions return strings that end with a zero.
    let text = |status| unsafe { std::ffi::CStr::from_ptr(pcr_status_text(status)) }.to_str().expect("ASCII");
    // SAFETY: as above.
    let name = |status| unsafe { std::ffi::CStr::from_ptr(pcr_status_name(status)) }.to_str().expect("ASCII");
    let declared: Vec<_> = header
        .lines()
        .filter_map(|line| line.trim().strip_suffix(',').unwrap_or(line.trim()).split_once(" = "))
        .filter(|(name, _)| name.starts_with("PCR_STATUS_"))
        .collect();
    assert_eq!(declared.len(), 27);
    for (declared, number) in declared {
        let status = number.parse().expect("a number");
        assert_eq!(name(status), declared);
        assert!(text(status).len() > 10 && text(status) != text(-1));
    }
    assert_eq!((name(27), name(-1)), ("PCR_STATUS_?", "PCR_STATUS_?"));
}

#[test]
fn a_fleet_moves_to_larger_memory_with_its_table() {
    let ahead = [line(6.0)];
    let agents = [truck(0.0, 0.0, 0.0, &ahead), truck(6.0, 0.3, std::f32::consts::PI, &ahead)];
    let small = memory(2, 1, 4);
    let mut fleet = fleet(&small, &agents);
    assert_eq!(pcr_fleet_build(Some(&mut fleet)), PcrStatus::Ok);
    let before = regions(&fleet, 0);
    assert_eq!(pcr_fleet_add(Some(&mut fleet), Some(&agents[0])), PcrStatus::NoRoom);
    for (less, expected) in [(memory(1, 1, 4), PcrStatus::NoRoom), (memory(2, 0, 4), PcrStatus::TableFull)] {
        assert_eq!(pcr_fleet_move(Some(&mut fleet), Some(&less)), expected);
        assert_eq!(regions(&fleet, 0), before);
    }
    assert_eq!(pcr_fleet_move(Some(&mut fleet), Some(&memory(4, 8, 16))), PcrStatus::Ok);
    assert_eq!(regions(&fleet, 0), before);
    assert_eq!(pcr_fleet_add(Some(&mut fleet), Some(&truck(0.0, -0.5, 0.0, &ahead))), PcrStatus::Ok);
    assert_eq!(pcr_fleet_build(Some(&mut fleet)), PcrStatus::Ok);
    assert_eq!(regions(&fleet, 1).len(), 2);
}

#[test]
fn two_edges_have_their_unsafe_intervals() {
    // At 1 m/s on both: the crossing is 2 m from both starts, and discs of 0.25 m are in contact up to sqrt(2) * 0.5 m apart in time.
    let steady = [PcrProfilePhase { duration: 4.0, acceleration: 0.0 }];
    let edge = |heading| PcrAgent { stretches: steady.as_ptr(), stretch_count: 1, ..agent(heading) };
    let mut fleet = fleet(&memory(2, 4, 4), &[edge(0.0), edge(std::f32::consts::FRAC_PI_2)]);
    let mut found = [PcrInterval::default(); 4];
    let mut count = 0;
    let mut ask = |fleet: &PcrFleet, passing| {
        let status =
            pcr_fleet_forbidden_delays(Some(fleet), 0, 1, passing, found.as_mut_ptr(), found.len(), Some(&mut count));
        (status, found[..count].to_vec())
    };
    assert_eq!(ask(&fleet, true).0, PcrStatus::NotBuilt);
    assert_eq!(pcr_fleet_build(Some(&mut fleet)), PcrStatus::Ok);
    for passing in [false, true] {
        let (status, delays) = ask(&fleet, passing);
        assert_eq!(status, PcrStatus::Ok);
        let [delays] = delays[..] else { panic!("one interval") };
        let exact = 0.5 * 2.0_f32.sqrt();
        assert!(
            (exact..exact + 1e-3).contains(&-delays.lo) && (exact..exact + 1e-3).contains(&delays.hi),
            "{delays:?}"
        );
    }
    // Another edge, which begins where the first one ends: who stands there is in its way at all times, but not in passing.
    let mut next = edge(0.0);
    next.x = 2.0;
    assert_eq!(pcr_fleet_replace(Some(&mut fleet), 1, Some(&next)), PcrStatus::Ok);
    let (_, delays) = ask(&fleet, false);
    assert!(delays.iter().any(|delays| delays.lo.abs() > 1e5 || delays.hi.abs() > 1e5), "{delays:?}");
    let (_, delays) = ask(&fleet, true);
    assert!(delays.iter().all(|delays| delays.lo.abs() < 10.0 && delays.hi.abs() < 10.0), "{delays:?}");
}
