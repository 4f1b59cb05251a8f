//! Improves delays by large neighbourhood search (Shaw 1998): some agents are freed, all others keep their sides among
//! one another, and the remaining problem is solved exactly.

use super::branch_and_bound::{BranchAndBound, SearchLimits};
use super::problem::DelayProblem;
use pcr_formats::splitmix64::SplitMix64;

/// Node limit of one neighbourhood.
const NODES: u64 = 200;
/// Number of agents that are freed at first.
const FIRST: f64 = 6.0;
/// Smallest number of agents that are freed.
const FEWEST: f64 = 3.0;
/// Factor by which the number grows after a complete search without success, and shrinks after an incomplete one.
const GROWTH: f64 = 1.02;
const SHRINKAGE: f64 = 0.9;
/// Neighbours that are drawn for each agent to be freed.
const DRAWS: usize = 20;

/// Improves delays for a number of rounds.
pub(super) fn improved(
    problem: &DelayProblem,
    mut delays: Vec<i64>,
    rounds: usize,
    clock: &dyn Fn() -> bool,
) -> Vec<i64> {
    let mut near = vec![Vec::new(); problem.len()];
    for [i, j] in problem.pairs.iter().map(|pair| pair.agents) {
        near[i].push(j);
        near[j].push(i);
    }
    let mut random = SplitMix64(0);
    let mut size = FIRST;
    for _ in 0..rounds {
        if clock() {
            break;
        }
        let Some(freed) = neighbourhood(&near, &delays, size as usize, &mut random) else { break };
        let is_freed = |place: &usize| problem.pairs[*place].agents.iter().any(|&agent| freed[agent]);
        let (pairs, kept): (Vec<usize>, Vec<usize>) = (0..problem.pairs.len()).partition(is_freed);
        let sides = kept.iter().flat_map(|&place| problem.pairs[place].gap(&delays));
        let found = BranchAndBound::among(problem, pairs, SearchLimits { nodes: NODES, clock })
            .run(sides, problem.cost(&delays));
        match found.delays {
            Some(better) => delays = better,
            None if found.complete => size = (size * GROWTH).min(problem.len() as f64),
            None => size = (size * SHRINKAGE).max(FEWEST),
        }
    }
    delays
}

/// The agents to free: a delayed one, and others that share forbidden delays with a chosen one. `None` if no agent is delayed.
fn neighbourhood(near: &[Vec<usize>], delays: &[i64], size: usize, random: &mut SplitMix64) -> Option<Vec<bool>> {
    let delayed: Vec<usize> = (0..delays.len()).filter(|&agent| delays[agent] > 0).collect();
    let mut chosen = vec![*delayed.get(random.below(delayed.len()))?];
    let mut freed = vec![false; delays.len()];
    freed[chosen[0]] = true;
    for _ in 0..DRAWS * size {
        let beside = &near[chosen[random.below(chosen.len())]];
        let Some(&agent) = beside.get(random.below(beside.len())) else { continue };
        if chosen.len() < size && !freed[agent] {
            freed[agent] = true;
            chosen.push(agent);
        }
    }
    Some(freed)
}
