//! Fleet plans: no two discs come nearer than their radii, by the oracle; and nobody waits longer than for all others.

use pcr_core::{Encounter, Interval, Motion, Unsolved, plan_delays};
use pcr_host::fleet::build_ecm;
use pcr_tests::disc::{Course, Disc, Drive, Leg};
use pcr_tests::generators::{Dice, drive, leg};
use pcr_tests::oracle::contact::{Driven, contacts};
use std::f64::consts::PI;

const FLEETS: u64 = if cfg!(debug_assertions) { 150 } else { 5_000 };

/// Two to six agents in a square of 6 m, or on one another's paths.
fn fleet(dice: &mut Dice) -> Vec<Driven> {
    let agents = 2 + dice.below(5);
    let agent = |dice: &mut Dice| {
        let start = [dice.range(-3.0, 3.0), dice.range(-3.0, 3.0), dice.range(-PI, PI)];
        let legs = (0..1 + dice.below(3)).map(|_| leg(dice)).collect();
        let disc = Disc { radius: dice.range(0.05, 0.3), start, legs };
        let drive = drive(dice, disc.length());
        (disc, drive, if dice.chance(0.5) { 0.0 } else { dice.range(0.0, 5.0) })
    };
    (0..agents).map(|_| agent(dice)).collect()
}

#[test]
fn random_fleets_are_planned_without_collisions_and_without_idle_waits() {
    let (mut solved, mut always, mut priorities, mut moved) = (0, 0, 0, 0);
    for seed in 0..FLEETS {
        let driven = fleet(&mut Dice::seeded(seed));
        // Discs that are a little larger, so that the true ones do not even touch.
        const GROWTH: f64 = 1e-7;
        let courses: Vec<_> = driven
            .iter()
            .map(|(disc, drive, start)| Course::<f64>::driven(&disc.grown(GROWTH), drive, *start))
            .collect();
        let Ok(courses) = courses.into_iter().collect::<Result<Vec<_>, _>>() else { continue };
        let motions: Vec<Motion<'_, f64>> = courses.iter().map(Course::motion).collect();
        let ecm = build_ecm(&motions).expect("a small table");
        let (mut plan, mut order) = (motions.clone(), (0..motions.len()).collect::<Vec<_>>());
        let given = order.clone();
        let outcome = plan_delays(&ecm, &motions, &mut plan, &mut order);
        let mut sorted = order.clone();
        sorted.sort_unstable();
        assert_eq!(sorted, given, "seed {seed}");
        let starts: Vec<f64> = plan.iter().map(|motion| motion.time().lo).collect();
        let first = starts.iter().copied().fold(f64::INFINITY, f64::min);
        let last = plan.iter().map(|motion| motion.time().hi).fold(0.0, f64::max);
        match outcome {
            Ok(()) => {
                solved += 1;
                moved += u32::from(order != given);
                for (place, &agent) in order.iter().enumerate() {
                    let earliest = motions[agent].time().lo;
                    let others = order[..place].iter().map(|&other| plan[other].time().hi);
                    // The others have arrived; what is added is the rounding of the delay.
                    let all_there = others.fold(earliest, f64::max);
                    assert!(
                        earliest <= starts[agent] && starts[agent] <= all_there + 1e-6,
                        "seed {seed}, agent {agent}"
                    );
                    for &other in &order[..place] {
                        let pair = [&driven[agent], &driven[other]];
                        assert!(
                            contacts(pair[0], pair[1], [starts[agent], starts[other]], [first, last], 0.0)
                                .inner
                                .is_empty(),
                            "seed {seed}: {agent} and {other}"
                        );
                        let encounter = Encounter::new(&plan[agent], &plan[other]);
                        let clearance = encounter.closest(Interval::new(first, last)).separation - encounter.radius();
                        assert!(clearance > -1e-8, "seed {seed}: {agent} and {other} by {clearance}");
                    }
                }
            }
            Err(Unsolved::Always([a, b])) => {
                always += 1;
                // With no delay at all do they get by.
                for k in -40..=40 {
                    let starts = [motions[a].time().lo + f64::from(k), motions[b].time().lo];
                    let ends = [starts[0] + motions[a].time().length(), motions[b].time().hi];
                    let during = [starts[0].min(starts[1]) - 1.0, ends[0].max(ends[1]) + 1.0];
                    let possible = contacts(&driven[a], &driven[b], starts, during, 1e-6).outer;
                    assert!(!possible.is_empty(), "seed {seed}: {a} and {b} at {k}");
                }
            }
            Err(_) => priorities += 1,
        }
    }
    println!("{solved} solved, {moved} of them in another order; {always} never, {priorities} not found");
    assert!(
        solved * 3 > FLEETS && moved > 0 && always > 0,
        "{solved} of {FLEETS} solved, {moved} in another order, {always} never"
    );
}

fn line(start: [f64; 3], length: f64) -> Course<f64> {
    let disc = Disc { radius: 0.25, start, legs: vec![Leg::Line(length)] };
    Course::driven(&disc, &Drive::Unit, 0.0).expect("a valid disc")
}

fn delays(courses: &[Course<f64>], order: &mut [usize]) -> Result<Vec<f64>, Unsolved> {
    let fleet: Vec<_> = courses.iter().map(Course::motion).collect();
    let ecm = build_ecm(&fleet).expect("a small table");
    let mut plan = fleet.clone();
    plan_delays(&ecm, &fleet, &mut plan, order)?;
    Ok(plan.iter().zip(&fleet).map(|(planned, motion)| planned.time().lo - motion.time().lo).collect())
}

#[test]
fn the_lower_priority_waits_at_a_crossing() {
    let crossing = [line([-2.0, 0.0, 0.0], 4.0), line([0.0, -2.0, PI / 2.0], 4.0)];
    for (mut order, waits) in [([0, 1], 1), ([1, 0], 0)] {
        let found = delays(&crossing, &mut order).expect("a plan");
        assert!((found[waits] - 0.5 * 2.0_f64.sqrt()).abs() < 1e-8 && found[1 - waits] == 0.0, "{found:?}");
    }
}

#[test]
fn head_on_agents_are_named() {
    let found = delays(&[line([0.0, 0.0, 0.0], 4.0), line([4.0, 0.0, PI], 4.0)], &mut [0, 1]);
    assert_eq!(found, Err(Unsolved::Always([1, 0])));
    assert_eq!(delays(&[line([0.0, 0.0, 0.0], 4.0)], &mut [3]), Err(Unsolved::NoSuchAgent(3)));
}

#[test]
fn an_agent_in_the_way_of_another_goes_first() {
    // Agent 0 passes over the start of agent 1, which leaves to the side.
    let mut order = [0, 1];
    let found = delays(&[line([-2.0, 0.0, 0.0], 4.0), line([0.0, 0.0, PI / 2.0], 2.0)], &mut order).expect("a plan");
    assert!(order == [0, 1] && found == [0.0, 0.0], "it is gone in time: {order:?} {found:?}");
    // It leaves too late unless agent 0 waits for it.
    let mut late = [line([-0.6, 0.0, 0.0], 4.0), line([0.0, 0.0, PI / 2.0], 2.0)];
    late.reverse();
    let found = delays(&late, &mut [1, 0]).expect("a plan");
    assert!(found[1] > 0.0 && found[0] == 0.0, "{found:?}");
}
