//! Whether everybody can finish under given orders: against monotone ways through coordination space that know the distances
//! alone, and by agents that go on one at a time.

use pcr_core::{
    Full, Hold, Limits, Order, Orders, Pass, Piece, Progress, Reach, Refused, Region, Tolerances, plan_delays,
};
use pcr_host::fleet::build_ecm;
use pcr_tests::disc::{Course, Disc, Drive, Leg};
use pcr_tests::execution::Table;
use pcr_tests::generators::{Dice, pair};
use pcr_tests::oracle::{Pair, Route};
use pcr_tests::plans::fleet;
use std::f64::consts::{FRAC_PI_2, TAU};

const EXACT: Tolerances<f64> = Tolerances { width: 0.0, gain: 1e-4 };

fn table(motions: &[pcr_core::Motion<'_, f64>]) -> Table<f64> {
    let (regions, pieces) = (vec![Region::EMPTY; 400], vec![Piece::EMPTY; 2000]);
    Orders::build(regions, pieces, vec![Order::EMPTY; 800], motions).expect("room")
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
    for k in 0..=STEPS {
        let (mut left, mut diagonal) = (false, false);
        for (j, place) in reached.iter_mut().enumerate() {
            let below = *place;
            let free = (own[k].0 - their[j].0).hypot(own[k].1 - their[j].1) - pair.radius >= clearance;
            *place = free && (below || left || diagonal);
            (left, diagonal) = (*place, below && k > 0);
        }
    }
    reached[STEPS]
}

#[test]
fn orders_can_be_kept_if_and_only_if_there_is_a_way() {
    let (mut possible, mut impossible, mut chosen) = (0, 0, 0);
    for seed in 0..if cfg!(optimized) { 4000 } else { 300 } {
        let (a, b) = pair(&mut Dice::seeded(seed));
        let courses = [&a, &b].map(|disc| Course::<f64>::new(disc));
        let [Ok(first), Ok(second)] = &courses else { continue };
        let motions = [first.motion(), second.motion()];
        let mut orders = table(&motions);
        let count = orders.ecm().len();
        if count == 0 || count > 5 {
            continue;
        }
        let progress = [Progress::at_rest(0.0); 2];
        let mut reaches = [Reach::EMPTY; 2];
        let mut passes = 0_u32;
        for choice in 0..1_u32 << count {
            for place in 0..count {
                let pass = if choice >> place & 1 == 1 { Pass::First } else { Pass::Second };
                orders.decide_at(&motions, place, 0, pass, 0.0);
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
    for seed in 0..if cfg!(optimized) { 3000 } else { 300 } {
        let mut dice = Dice::seeded(seed);
        let discs = fleet(&mut dice);
        let courses: Vec<_> = discs.iter().filter_map(|(disc, ..)| Course::<f64>::new(disc).ok()).collect();
        let motions: Vec<_> = courses.iter().map(Course::motion).collect();
        let mut orders = table(&motions);
        for place in 0..orders.ecm().len() {
            let ego = (0..motions.len()).find(|&agent| orders.row(&motions, agent).any(|(at, ..)| at == place));
            let pass = if dice.chance(0.5) { Pass::First } else { Pass::Second };
            orders.decide_at(&motions, place, ego.expect("its agent"), pass, 0.0);
        }
        let start = vec![Progress::at_rest(0.0); motions.len()];
        let mut reaches = vec![Reach::EMPTY; motions.len()];
        let found = orders.check(&motions, &start, EXACT, &mut reaches);
        let mut progress = start.clone();
        let gain = |progress: &mut Vec<Progress<f64>>, agent: usize| {
            let end = motions[agent].path().length();
            let to = orders.hold(&motions, agent, progress).length(end).unwrap_or(0.0);
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
            Err(Refused::Stuck { agent, by, place }) => {
                stuck += 1;
                assert!(unfinished.contains(&agent), "seed {seed}: {agent} is not stuck");
                match all_wait {
        Err(Refused::Stuck { agent, by, .. }) => assert_eq!(by, (agent + 3) % 4),
        other => panic!("{other:?}"),
    }
    let place = orders.row(&motions, 0).find(|(_, region, _)| region.other() == 3).expect("a crossing").0;
    orders.decide_at(&motions, place, 0, Pass::First, 0.0);
    assert_eq!(orders.check(&motions, &progress, EXACT, &mut reaches), Ok(()));
    assert_eq!(orders.check(&motions, &progress, EXACT, &mut []), Err(Refused::Full(Full::Reaches)));
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
        let ahead = orders.row(&motions, k).filter(|(_, region, _)| region.hold(0.0, 0.0) != Hold::Inside);
        for place in ahead.map(|(place, ..)| place).collect::<Vec<_>>() {
            orders.decide_at(&motions, place, k, Pass::Second, 0.0);
        }
    }
    let mut reaches = [Reach::EMPTY; 4];
    assert_eq!(orders.check(&motions, &progress, EXACT, &mut reaches), Ok(()));
}

#[test]
fn brakes_are_enough() {
    let limits = Limits { speed: 2.0, acceleration: 0.7 };
    let brakes = pcr_core::Brakes::new(limits.acceleration, 0.2).expect("brakes");
    for k in 0..2000 {
        let way = f64::from(k) * 1e-3;
        let speed = brakes.speed(way);
        assert!(brakes.distance(speed) <= way + 1e-12 && brakes.distance(speed + 1e-6) >= way, "{way} {speed}");
    }
    assert_eq!((brakes.speed(0.0), brakes.speed(-1.0), brakes.distance(0.0)), (0.0, 0.0, 0.0));
}
