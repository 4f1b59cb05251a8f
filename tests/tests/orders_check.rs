//! Whether everybody can finish under given orders: against monotone ways through coordination space that know the distances
//! alone, and by agents that go on one at a time.

use pcr_core::{
    AdmissionError, CapacityError, CheckState, CheckTolerances, EcmEntry, Encounter, MovementAuthority, PassingState,
    Piece, PrecedenceTable, Progress, RegionPrecedence, plan_delays,
};
use pcr_planning::fleet::build_ecm;
use pcr_tests::disc::{Course, Disc, Drive, Leg};
use pcr_tests::execution::Table;
use pcr_tests::generators::{Dice, pair};
use pcr_tests::oracle::{Pair, Route};
use pcr_tests::plans::fleet;
use std::f64::consts::{FRAC_PI_2, TAU};

const EXACT: CheckTolerances<f64> = CheckTolerances { width: 0.0, gain: 1e-4 };

fn table(motions: &[pcr_core::Motion<'_, f64>]) -> Table<f64> {
    let (regions, pieces) = (vec![EcmEntry::EMPTY; 400], vec![Piece::EMPTY; 2000]);
    PrecedenceTable::build(regions, pieces, vec![RegionPrecedence::EMPTY; 800], motions).expect("room")
}

/// Whether there is a way of both from their starts to their ends that never goes back and keeps this clearance \[m\], over
/// the points of a grid.
fn monotone_way(pair: &Pair, ends: [f64; 2], clearance: f64) -> bool {
    const STEPS: usize = 400;
    let points = |route: &Route, end: f64| -> Vec<(f64, f64)> {
        (0..=STEPS).map(|k| route.at(end * k as f64 / STEPS as f64)).collect()
    };
    let (own, their) = (points(&pair.ego, ends[0]), points(&pair.other, ends[1]));
    // Of the row before this one; before the first one there is the start alone.
    let mut reached = vec![false; STEPS + 1];
    reached[0] = true;
    for (k, at) in own.iter().enumerate() {
        let (mut left, mut diagonal) = (false, false);
        for (place, other) in reached.iter_mut().zip(&their) {
            let below = *place;
            let free = (at.0 - other.0).hypot(at.1 - other.1) - pair.radius >= clearance;
            *place = free && (below || left || diagonal);
            (left, diagonal) = (*place, below && k > 0);
        }
    }
    reached[STEPS]
}

#[test]
fn orders_can_be_kept_if_and_only_if_there_is_a_way() {
    let (mut possible, mut impossible, mut chosen) = (0, 0, 0);
    for seed in 0..if cfg!(optimized) { 2000 } else { 300 } {
        let (a, b) = pair(&mut Dice::seeded(seed));
        let courses = [&a, &b].map(Course::<f64>::new);
        let [Ok(first), Ok(second)] = &courses else { continue };
        let motions = [first.motion(), second.motion()];
        let mut orders = table(&motions);
        let count = orders.ecm().len();
        if count == 0 || count > 5 {
            continue;
        }
        let progress = [Progress::at_rest(0.0); 2];
        let mut reaches = [CheckState::EMPTY; 2];
        let mut passes = 0_u32;
        for choice in 0..1_u32 << count {
            for place in 0..count {
                let pass = if choice >> place & 1 == 1 { PassingState::First } else { PassingState::Second };
                orders.decide_at(&motions, place, 0, pass, 0.0).expect("the table of the fleet");
            }
            passes += u32::from(orders.check(&motions, &progress, EXACT, &mut reaches).is_ok());
        }
        let ends = motions.each_ref().map(|motion| motion.path().length());
        let oracle = Pair::new(&a, &b);
        let step = (ends[0] + ends[1]) / 400.0 + 1e-6;
        if monotone_way(&oracle, ends, step) {
            possible += 1;
            assert!(passes > 0, "seed {seed}: there is a way, but no order");
        } else if !monotone_way(&oracle, ends, -step) {
            impossible += 1;
            assert_eq!(passes, 0, "seed {seed}: orders without a way");
        }
        chosen += u32::from(0 < passes && passes < 1 << count);
    }
    assert!(possible > 20 && impossible > 20 && chosen > 20, "{possible} {impossible} {chosen}");
}

#[test]
fn agents_that_go_on_one_at_a_time_get_as_far_as_the_check_says() {
    let (mut finished, mut stuck) = (0, 0);
    for seed in 0..if cfg!(optimized) { 1500 } else { 300 } {
        let mut dice = Dice::seeded(seed);
        let discs = fleet(&mut dice);
        let courses: Vec<_> = discs.iter().filter_map(|(disc, ..)| Course::<f64>::new(disc).ok()).collect();
        let motions: Vec<_> = courses.iter().map(Course::motion).collect();
        let mut orders = table(&motions);
        for place in 0..orders.ecm().len() {
            let ego = (0..motions.len()).find(|&agent| {
                orders.row(&motions, agent).expect("the table of the fleet").any(|(at, ..)| at == place)
            });
            let pass = if dice.chance(0.5) { PassingState::First } else { PassingState::Second };
            orders.decide_at(&motions, place, ego.expect("its agent"), pass, 0.0).expect("the table of the fleet");
        }
        let start = vec![Progress::at_rest(0.0); motions.len()];
        let mut reaches = vec![CheckState::EMPTY; motions.len()];
        let found = orders.check(&motions, &start, EXACT, &mut reaches);
        let mut progress = start.clone();
        let gain = |progress: &mut Vec<Progress<f64>>, agent: usize| {
            let end = motions[agent].path().length();
            let to = orders.hold(&motions, agent, progress).expect("the table of the fleet").length(end).unwrap_or(0.0);
            let gains = to > progress[agent].at.lo + 1e-4 || (to == end && progress[agent].at.lo < end);
            if gains {
                progress[agent] = Progress::at_rest(to);
            }
            gains
        };
        // In another order than the check goes.
        while (0..motions.len()).rev().any(|agent| gain(&mut progress, agent)) {}
        let unfinished: Vec<usize> =
            (0..motions.len()).filter(|&k| progress[k].at.lo < motions[k].path().length()).collect();
        match found {
            Ok(()) => {
                finished += 1;
                assert!(unfinished.is_empty(), "seed {seed}: {unfinished:?} stuck");
            }
            Err(AdmissionError::Stuck { agent, by, place }) => {
                stuck += 1;
                assert!(unfinished.contains(&agent), "seed {seed}: {agent} is not stuck");
                let row = orders.row(&motions, agent).expect("the table of the fleet").find(|(at, ..)| *at == place);
                assert_eq!(
                    row.map(|(_, region, pass)| (region.other(), pass)),
                    Some((by, PassingState::Second)),
                    "seed {seed}"
                );
                let again = orders.check(&motions, &progress, EXACT, &mut reaches);
                assert!(again.is_err(), "seed {seed}: stuck and yet not");
            }
            // Such that overlap at their starts.
            Err(AdmissionError::Late { .. }) => {}
            Err(refused) => panic!("seed {seed}: {refused}"),
        }
    }
    assert!(finished > 100 && stuck > 15, "{finished} {stuck}");
}

#[test]
fn the_orders_of_a_plan_are_kept_by_the_plan() {
    let mut planned = 0;
    for seed in 0..if cfg!(optimized) { 1000 } else { 200 } {
        let discs = fleet(&mut Dice::seeded(seed));
        // Planned with discs that are a little larger than those that the orders are about.
        let course = |growth: f64| {
            let driven = discs
                .iter()
                .filter_map(move |(disc, drive, start)| Course::<f64>::driven(&disc.grown(growth), drive, *start).ok());
            driven.collect::<Vec<_>>()
        };
        let (courses, small) = (course(1e-6), course(0.0));
        let motions: Vec<_> = courses.iter().map(Course::motion).collect();
        let ecm = build_ecm(&motions).expect("a small table");
        let (mut plan, mut order) = (motions.clone(), (0..motions.len()).collect::<Vec<_>>());
        if plan_delays(&ecm, &motions, &mut plan, &mut order).is_err() || ecm.is_empty() {
            continue;
        }
        let timed: Vec<_> = small
            .iter()
            .zip(&plan)
            .map(|(course, plan)| course.motion().with_profile(plan.profile(), plan.time().lo).expect("the same path"))
            .collect();
        let mut orders = table(&timed);
        orders.as_planned(&timed).unwrap_or_else(|refused| panic!("seed {seed}: {refused}"));
        let mut reaches = vec![CheckState::EMPTY; timed.len()];
        let start = vec![Progress::at_rest(0.0); timed.len()];
        assert_eq!(orders.check(&timed, &start, EXACT, &mut reaches), Ok(()), "seed {seed}");
        let [begin, end] = [f64::min, f64::max]
            .map(|of| timed.iter().flat_map(|motion| [motion.time().lo, motion.time().hi]).fold(f64::NAN, of));
        for k in 0..=60 {
            let time = begin + (end - begin) * f64::from(k) / 60.0;
            let progress: Vec<_> = timed.iter().map(|motion| Progress::at_rest(motion.length_at(time))).collect();
            for (agent, place) in progress.iter().enumerate() {
                let hold = orders.hold(&timed, agent, &progress).expect("the table of the fleet");
                assert!(hold.allows(place.at.lo), "seed {seed}: {agent} at {place:?}, {time} s, {hold:?}");
            }
        }
        planned += 1;
    }
    assert!(planned > 40, "{planned}");
}

#[test]
fn motions_that_collide_have_no_orders() {
    let (mut collide, mut apart) = (0, 0);
    for seed in 0..if cfg!(optimized) { 1000 } else { 200 } {
        let driven = fleet(&mut Dice::seeded(seed));
        let courses: Vec<_> =
            driven.iter().filter_map(|(disc, drive, start)| Course::driven(disc, drive, *start).ok()).collect();
        let motions: Vec<_> = courses.iter().map(Course::motion).collect();
        let pairs = (0..motions.len()).flat_map(|a| (0..a).map(move |b| [b, a]));
        let deep = |[a, b]: [usize; 2]| {
            let pair = Encounter::new(&motions[a], &motions[b]);
            pair.conflicts(pair.time()).any(|conflict| !conflict.touching)
        };
        match table(&motions).as_planned(&motions) {
            Err(AdmissionError::Meeting(agents)) => {
                collide += 1;
                assert!(deep(agents), "seed {seed}: {agents:?} do not meet");
            }
            found => {
                assert_eq!(found, Ok(()), "seed {seed}");
                assert_eq!(pairs.into_iter().find(|&pair| deep(pair)), None, "seed {seed}");
                apart += 1;
            }
        }
    }
    assert!(collide > 40 && apart > 20, "{collide} {apart}");
}

fn course(start: [f64; 3], legs: &[Leg]) -> Course<f64> {
    let disc = Disc { radius: 0.3, start, legs: legs.to_vec() };
    Course::driven(&disc, &Drive::Unit, 0.0).expect("a valid disc")
}

#[test]
fn all_that_wait_for_the_next_one_around_a_square_are_stuck_and_one_that_goes_first_frees_them() {
    // Four one-way streets around a block, each crossing the next one.
    let lane = |k: u32| {
        let heading = FRAC_PI_2 * f64::from(k);
        let (sin, cos) = heading.sin_cos();
        course([cos * -3.0 + sin, sin * -3.0 - cos, heading], &[Leg::Line(6.0)])
    };
    let lanes = [0, 1, 2, 3].map(lane);
    let motions = lanes.each_ref().map(Course::motion);
    let mut orders = table(&motions);
    assert_eq!(orders.ecm().len(), 4);
    let progress = [Progress::at_rest(0.0); 4];
    let mut reaches = [CheckState::EMPTY; 4];
    let undecided = orders.check(&motions, &progress, EXACT, &mut reaches);
    assert!(matches!(undecided, Err(AdmissionError::Stuck { .. })), "{undecided:?}");
    // Everybody is held before where it could meet anybody.
    assert!(
        matches!(orders.hold(&motions, 0, &progress).expect("the table of the fleet"), MovementAuthority::At(hold) if (hold - 1.4).abs() < 1e-9)
    );
    // On each lane the first crossing is with the one before it, who has come that far already.
    for k in 0..4 {
        orders.decide(&motions, k, (k + 3) % 4, PassingState::Second, 0.0).expect("the table of the fleet");
    }
    let all_wait = orders.check(&motions, &progress, EXACT, &mut reaches);
    match all_wait {
        Err(AdmissionError::Stuck { agent, by, .. }) => assert_eq!(by, (agent + 3) % 4),
        other => panic!("{other:?}"),
    }
    let place = orders
        .row(&motions, 0)
        .expect("the table of the fleet")
        .find(|(_, region, _)| region.other() == 3)
        .expect("a crossing")
        .0;
    orders.decide_at(&motions, place, 0, PassingState::First, 0.0).expect("the table of the fleet");
    assert_eq!(orders.check(&motions, &progress, EXACT, &mut reaches), Ok(()));
    let full = CapacityError::Reaches { needed: motions.len(), capacity: 0 };
    assert_eq!(orders.check(&motions, &progress, EXACT, &mut []), Err(AdmissionError::Full(full)));
}

#[test]
fn priorities_may_go_round_in_a_circle_where_all_follow_one_another() {
    // Four robots a quarter of a circle apart, each going round three quarters: each follows the next one.
    let courses = [0, 1, 2, 3].map(|k: u32| {
        let angle = FRAC_PI_2 * f64::from(k);
        let (sin, cos) = angle.sin_cos();
        course([2.0 * cos, 2.0 * sin, angle + FRAC_PI_2], &[Leg::arc(2.0, 0.7 * TAU)])
    });
    let motions = courses.each_ref().map(Course::motion);
    let mut orders = table(&motions);
    let progress = [Progress::at_rest(0.0); 4];
    // Everybody is second to the one ahead of it, to whom it is nearer than that one is to it.
    for k in 0..4 {
        let ahead = orders
            .row(&motions, k)
            .expect("the table of the fleet")
            .filter(|(_, region, _)| region.hold(0.0, 0.0) != MovementAuthority::Inside);
        for place in ahead.map(|(place, ..)| place).collect::<Vec<_>>() {
            orders.decide_at(&motions, place, k, PassingState::Second, 0.0).expect("the table of the fleet");
        }
    }
    let mut reaches = [CheckState::EMPTY; 4];
    assert_eq!(orders.check(&motions, &progress, EXACT, &mut reaches), Ok(()));
}

#[test]
fn who_stands_at_the_end_of_its_path_is_not_past_it_by_the_rounding_of_its_place() {
    let east = course([-3.0, 0.0, 0.0], &[Leg::Line(6.0)]);
    let parks = course([0.0, -3.0, FRAC_PI_2], &[Leg::Line(3.0)]);
    let mut fleet = [east.motion(), parks.motion()];
    let end = fleet[1].path().length();
    let mut progress = [Progress::at_rest(0.0), Progress::at_rest(end + 1e-12)];
    let mut orders = table(&fleet);
    orders.decide(&fleet, 0, 1, PassingState::Second, 0.0).expect("the table of the fleet");
    let region = orders.row(&fleet, 0).expect("the table of the fleet").next().expect("a region").1;
    assert!(!region.hold(0.0, end + 1e-12).allows(3.0));
    assert_eq!(region.clone().swapped().hold(end + 1e-12, 0.0), MovementAuthority::Inside);
    orders.passed(&progress);
    assert!(!orders.hold(&fleet, 0, &progress).expect("the table of the fleet").allows(3.0), "it is driven into");
    let mut reaches = [CheckState::EMPTY; 2];
    assert!(orders.check(&fleet, &progress, EXACT, &mut reaches).is_err());
    let mission = pcr_core::PathProposal { agent: 0, motion: fleet[0], progress: progress[0] };
    let refused = orders.admit(&mut fleet, &mut progress, mission, EXACT, &mut reaches, |_| PassingState::First);
    assert_eq!(refused, Err(AdmissionError::Blocked { agent: 0, by: 1 }));
}
