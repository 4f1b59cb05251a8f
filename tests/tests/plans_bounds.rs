//! No plan costs less than its lower bound.

use pcr_formats::scenario::{Agent, MotionSpec, PathSegment, Scenario};
use pcr_planning::plan::{PlanMethod, PlanOptions, PlanReport};
use pcr_tests::generators::Dice;

const OPEN: &str = include_str!("../data/cases/lower-bound-open-2.json");

const FLEETS: u64 = if cfg!(optimized) { 250 } else { 60 };

/// The cost and the bound of a plan, where there is one.
#[track_caller]
fn planned(scenario: &Scenario, method: PlanMethod) -> Option<[f64; 2]> {
    let (plan, solved) = PlanReport::compute(scenario, &PlanOptions::new(method)).unwrap();
    assert_eq!(solved.is_some(), plan.costs.is_some());
    plan.costs.map(|costs| [costs.sum_of_costs, costs.lower_bound])
}

#[test]
fn a_wait_in_the_file_is_not_in_the_bound_of_speeds() {
    let scenario = Scenario::from_json(OPEN).unwrap();
    let [cost, bound] = planned(&scenario, PlanMethod::Speed).unwrap();
    assert!(bound <= cost && bound > 0.95 * cost, "{cost} {bound}");
    let [cost, bound] = planned(&scenario, PlanMethod::Delay).unwrap();
    assert!((cost - bound).abs() < 1e-9, "{cost} {bound}");
}

/// An agent somewhere in a square of 6 m, which may begin and end in motion, and wait on its way.
fn agent(id: u64, dice: &mut Dice) -> Agent {
    let segment = |dice: &mut Dice| match dice.below(2) {
        0 => PathSegment::Line { length: dice.range(0.2, 2.0) },
        _ => PathSegment::arc(dice.range(0.2, 1.0), dice.range(-2.5, 2.5)),
    };
    let path: Vec<PathSegment> = (0..1 + dice.below(4)).map(|_| segment(dice)).collect();
    let start = [dice.range(0.0, 6.0), dice.range(0.0, 6.0), dice.range(-3.0, 3.0)];
    let motion = match dice.below(3) {
        0 => MotionSpec::RestToRest { v_max: dice.range(0.3, 1.2), a_max: dice.range(0.2, 1.5) },
        kind => {
            // Up to a speed, on at it, down to another; a wait in the middle. What it travels is the path's length by one factor.
            let (v0, peak) = (if kind == 1 { 0.0 } else { dice.range(0.1, 0.5) }, dice.range(0.5, 1.5));
            let goal = if kind == 1 { 0.0 } else { dice.range(0.0, 0.5) };
            let [up, stop, wait, down] = [0; 4].map(|_| dice.range(0.3, 1.5));
            let mut pieces = vec![(up, (peak - v0) / up), (stop, -peak / stop), (wait, 0.0)];
            pieces.extend([(up, peak / up), (stop, 0.0), (down, (goal - peak) / down)]);
            let (mut speed, mut travelled) = (v0, 0.0);
            for (duration, accel) in &pieces {
                travelled += speed * duration + accel * duration * duration / 2.0;
                speed += accel * duration;
            }
            let factor = path.iter().map(PathSegment::length).sum::<f64>() / travelled;
            MotionSpec::profile(v0 * factor, pieces.iter().map(|(duration, accel)| (*duration, accel * factor)))
        }
    };
    Agent { t_start: dice.range(0.0, 3.0), ..Agent::disc(id, dice.range(0.05, 0.2), start, path, motion) }
}

#[test]
fn plans_of_random_fleets_cost_at_least_their_bound() {
    let (mut solved, mut near, mut alone) = ([0; 2], 0, 0);
    for seed in 0..FLEETS {
        let mut dice = Dice::seeded(seed);
        let agents = (1..2 + seed % 5).map(|id| agent(id, &mut dice)).collect::<Vec<_>>();
        let Ok(scenario) = Scenario::from_json(&Scenario::new("", agents).to_json()) else { panic!("seed {seed}") };
        for (way, method) in [PlanMethod::Delay, PlanMethod::Speed].into_iter().enumerate() {
            let Some([cost, bound]) = planned(&scenario, method) else { continue };
            assert!(bound > 0.0 && cost >= bound - 1e-9 * bound, "seed {seed}, {method:?}: {cost} {bound}");
            solved[way] += 1;
            // A bound of 0 would be one as well: alone, an agent is nearly as fast as that.
            if scenario.agents.len() == 1 {
                alone += 1;
                near += u64::from(cost <= 1.1 * bound);
            }
        }
    }
    // One in ten is slower by more than a tenth: a short way between the borders of cells.
    assert!(
        solved.iter().all(|&solved| solved * 3 > FLEETS) && alone * 3 > FLEETS && near * 10 > alone * 9,
        "{solved:?} {near} of {alone}"
    );
}
