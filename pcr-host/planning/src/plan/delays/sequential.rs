//! Delays for one agent after the other, each one as early as those before it allow. This is fast, and plans all agents
//! or most of them.
//!
//! An agent that cannot start goes first in the next attempt, again and again (squeaky wheels, Joslin and Clements
//! 1999), but after the agents that have to go before it.

use super::priority_order::respecting;
use super::problem::{DelayProblem, DifferenceConstraint, earliest};
use std::cmp::Reverse;

/// Number of orders that are tried; in each, the agents that did not fit into the one before come first.
const ROUNDS: usize = 12;

/// The delays of the first order in which all agents have one; otherwise of the order with the fewest agents left out.
pub(super) fn inserted(problem: &DelayProblem) -> Vec<Option<i64>> {
    let table = DelayProblemIndex::of(problem);
    let natural: Vec<usize> = (0..problem.len()).collect();
    let mut crowded = natural.clone();
    crowded.sort_by_key(|&agent| Reverse(table.near[agent].len()));
    let mut soonest = natural.clone();
    soonest.sort_by_key(|&agent| problem.ends[agent]);
    let mut best: Option<(usize, Vec<Option<i64>>)> = None;
    for start in [natural, soonest, crowded] {
        let mut order = start;
        for _ in 0..ROUNDS {
            let delays = table.in_order(respecting(&order, &table.first));
            let out = delays.iter().filter(|delay| delay.is_none()).count();
            // Agents without a delay come first; otherwise the order is kept.
            order.sort_by_key(|&agent| delays[agent].is_some());
            if best.as_ref().is_none_or(|(fewest, _)| out < *fewest) {
                best = Some((out, delays));
            }
            if out == 0 {
                break;
            }
        }
        if best.as_ref().is_some_and(|(out, _)| *out == 0) {
            break;
        }
    }
    best.map_or_else(Vec::new, |(_, delays)| delays)
}

/// A problem, indexed by agent.
struct DelayProblemIndex<'a> {
    problem: &'a DelayProblem,
    /// For each agent its pairs: the other agent, and the index of the pair.
    near: Vec<Vec<(usize, usize)>>,
    /// For each agent the agents that have to start before it.
    first: Vec<Vec<usize>>,
}

impl<'a> DelayProblemIndex<'a> {
    fn of(problem: &'a DelayProblem) -> Self {
        let (mut near, mut first) = (vec![Vec::new(); problem.len()], vec![Vec::new(); problem.len()]);
        for (place, pair) in problem.pairs.iter().enumerate() {
            let [i, j] = pair.agents;
            near[i].push((j, place));
            near[j].push((i, place));
            if !pair.is_impossible() {
                pair.forced().for_each(|DifferenceConstraint { from, to, .. }| first[to].push(from));
            }
        }
        Self { problem, near, first }
    }

    fn in_order(&self, order: Vec<usize>) -> Vec<Option<i64>> {
        let mut delays: Vec<Option<i64>> = vec![None; self.problem.len()];
        for agent in order {
            let placed = self.near[agent].iter().filter_map(|&(other, place)| Some((delays[other]?, place)));
            let forbidden = placed.flat_map(|(delay, place)| self.problem.pairs[place].forbidden_to(agent, delay));
            delays[agent] = earliest(forbidden.collect());
        }
        delays
    }
}
