//! Start delays with a proof of their quality: the best ones for an objective, a lower bound of the cost of all delays,
//! or a proof that there are none.
//!
//! ```text
//! problem   forbidden delays of pairs, in ticks          Problem
//! net       difference constraints, longest paths        (internal)
//! search    branch and bound over sides, depth first     (internal)
//! lowest    the same, the lowest bound first             (internal)
//! feasible  whether there are delays at all              (internal)
//! improve   large neighbourhood search                   (internal)
//! precedence  which agents have to start before others   (internal)
//! insert    one agent after the other                    (internal)
//! leave     the fewest agents to leave out               (internal)
//! meter     how far the searches are                     (internal)
//! ```

mod best_first;
mod branch_and_bound;
mod difference_network;
mod feasibility;
mod large_neighbourhood;
mod leave_out;
mod priority_order;
mod problem;
mod search_meter;
mod sequential;
#[cfg(test)]
mod tests;

use super::plan_progress::{PlanProgressFn, PlanStage};
use crate::agent_regions::ProgressFn;
use branch_and_bound::{BranchAndBound, SearchLimits};
use leave_out::LeaveOutResult;
pub(crate) use priority_order::respecting;
pub use problem::Objective;
pub(crate) use problem::{DelayProblem, ForbiddenPairDelays, NEVER, TickScale, earliest, rounding_cost};
use search_meter::SearchMeter;
use std::cell::Cell;
use std::time::{Duration, Instant};

/// How long to search.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct DelaySearchOptions {
    /// Whether to search until the delays are proved to be the best. Otherwise the numbers of nodes and rounds are fixed, so the
    /// result is the same in every run.
    pub prove: bool,
    /// Time limit. With it the result depends on the machine.
    pub time: Option<Duration>,
}

/// Node limit of the first search; multiplied by `FACTOR` for each later one, so that easy fleets take little time.
const NODES: u64 = 2_000;
/// Rounds of the improvement after the first search; multiplied by `FACTOR` as well.
const ROUNDS: usize = 200;
const FACTOR: u32 = 5;
/// Number of searches if nothing has to be proved.
const SEARCHES: u32 = 3;
/// Number of pairs of agents from which on node limits and rounds shrink in proportion, because each node takes longer.
const WIDE: usize = 1_200;
/// Rounds of the improvement if any delays will do.
const SOME: usize = 20;
/// Node limit of a search that decides whether delays exist, for up to `FEW` agents. With more agents the limit shrinks in
/// proportion, because each node takes longer.
const DECIDING: u64 = 200_000;
/// Largest number of pairs with forbidden delays for which a part of the fleet is searched, unless a search was asked for. A larger
/// part keeps the best delays known before, with a lower bound.
const SEARCHED: usize = 20_000;
/// Number of agents up to which `DECIDING` is not reduced.
const FEW: u64 = 20;

/// The result of a search.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct DelayResult {
    /// Delays of the agents that are not left out \[ticks\]; `None` if the search was stopped before it found any.
    pub(crate) delays: Option<Vec<Option<i64>>>,
    /// Lower bound of the cost of the agents that are not left out \[ticks\], with an allowance for rounding.
    pub(crate) bound: i128,
    /// Whether the delays are proved to be the best, except for rounding.
    pub(crate) proved: bool,
    /// Sets of agents that are proved to have no delays together.
    pub(crate) conflicts: Vec<Vec<usize>>,
    /// Whether it is proved that no larger set of agents has delays. Otherwise a search was stopped, and agents may be left out needlessly.
    pub(crate) fewest: bool,
}

/// The best delays. If not all agents can have delays: the conflicts, and with `leave_out` the best delays of the agents that stay.
/// Where `known` has delays for all agents of a part, the result is at least as good.
pub(crate) fn best(
    problem: &DelayProblem,
    known: &[Vec<Option<i64>>],
    effort: DelaySearchOptions,
    leave_out: bool,
    told: PlanProgressFn<'_>,
) -> DelayResult {
    let begin = Instant::now();
    let after = |time: Duration| effort.time.is_some() && begin.elapsed() >= time;
    let time = effort.time.unwrap_or_default();
    let mut of_all = known.iter().filter_map(|delays| delays.iter().copied().collect::<Option<Vec<i64>>>());
    let left = match of_all.find(|delays| problem.allows(delays)) {
        Some(delays) => LeaveOutResult::nobody(delays),
        None => {
            let nodes = DECIDING * FEW / FEW.max(problem.len() as u64);
            // The other half of the time is for the delays of the agents that stay.
            let looks = Cell::new(0);
            let clock = || {
                looks.set(looks.get() + 1);
                told(PlanStage::LeftOut, looks.get(), 0);
                after(time / 2)
            };
            leave_out::agents_to_leave_out(problem, &alone(problem), SearchLimits { nodes, clock: &clock }, leave_out)
        }
    };
    let staying: Vec<usize> = (0..problem.len()).filter(|&agent| left.delays[agent].is_some()).collect();
    if !leave_out && staying.len() < problem.len() {
        return DelayResult { delays: None, bound: 0, proved: false, conflicts: left.conflicts, fewest: left.fewest };
    }
    let part = problem.of(&staying);
    let of_part = |delays: &Vec<Option<i64>>| staying.iter().map(|&agent| delays[agent]).collect::<Vec<_>>();
    let known: Vec<Vec<Option<i64>>> = known.iter().chain([&left.delays]).map(of_part).collect();
    let told = |done, all| told(PlanStage::Delays, done, all);
    let rest = solved(&part, &known, effort, &|| after(time), &told);
    let mut delays = vec![None; problem.len()];
    staying.iter().zip(rest.delays).for_each(|(&agent, delay)| delays[agent] = Some(delay));
    DelayResult {
        delays: Some(delays),
        bound: rest.bound,
        proved: rest.proved,
        conflicts: left.conflicts,
        fewest: left.fewest,
    }
}

/// Delays of all agents, or of as many as possible. They are not the best ones, but for dozens of agents they take only milliseconds.
/// `with` has for each agent the agents that have to be left out with it, itself included.
pub(crate) fn some(problem: &DelayProblem, with: &[Vec<usize>]) -> Vec<Option<i64>> {
    let clock = || false;
    let found = sequential::inserted(problem);
    match found.iter().copied().collect::<Option<Vec<i64>>>() {
        Some(all) => large_neighbourhood::improved(problem, all, SOME, &clock).into_iter().map(Some).collect(),
        None => {
            leave_out::agents_to_leave_out(problem, with, SearchLimits { nodes: NODES, clock: &clock }, true).delays
        }
    }
}

/// Nodes or rounds of a part of a fleet: fewer of a wide one, unless something has to be proved.
fn share(problem: &DelayProblem, effort: DelaySearchOptions, of_all: u64) -> u64 {
    if effort.prove { of_all } else { of_all * WIDE as u64 / problem.pairs.len().max(WIDE) as u64 }
}

/// The value of `with` if each agent can be left out alone.
fn alone(problem: &DelayProblem) -> Vec<Vec<usize>> {
    (0..problem.len()).map(|agent| vec![agent]).collect()
}

struct DelaySolution {
    delays: Vec<i64>,
    bound: i128,
    proved: bool,
}

/// Solves the independent parts of the fleet, which forbid one another no delays, one by one, beginning with known delays.
fn solved(
    problem: &DelayProblem,
    known: &[Vec<Option<i64>>],
    effort: DelaySearchOptions,
    clock: &dyn Fn() -> bool,
    told: ProgressFn<'_>,
) -> DelaySolution {
    let mut delays = vec![0; problem.len()];
    // The last arrival may be before 0.
    let (mut bound, mut proved): (Option<i128>, _) = (None, true);
    let parts = problem.independent_problems();
    let meter = SearchMeter::new(parts.iter().map(|(_, part)| part), effort, told);
    for (agents, part) in parts {
        let end = meter.end_of(&part);
        let clock = || {
            meter.step(end);
            clock()
        };
        let known = known.iter().filter_map(|known| agents.iter().map(|&agent| known[agent]).collect());
        let found = connected(&part, known, effort, &clock);
        meter.skip_to(end);
        agents.iter().zip(found.delays).for_each(|(&agent, delay)| delays[agent] = delay);
        bound = Some(bound.map_or(found.bound, |bound| match problem.objective {
            Objective::Sum => bound + found.bound,
            Objective::Makespan => bound.max(found.bound),
        }));
        proved &= found.proved;
    }
    let bound = bound.unwrap_or(0);
    // A part that is not proved does not matter if the last arrival is in another one.
    proved |= problem.objective == Objective::Makespan && problem.cost(&delays) <= bound;
    DelaySolution { delays, bound: bound - rounding_cost(problem), proved }
}

/// Search and improvement in turn, with more and more effort.
fn connected(
    problem: &DelayProblem,
    known: impl Iterator<Item = Vec<i64>>,
    effort: DelaySearchOptions,
    clock: &dyn Fn() -> bool,
) -> DelaySolution {
    let inserted = sequential::inserted(problem).into_iter().collect::<Option<Vec<i64>>>();
    let known = known.filter(|delays| problem.allows(delays)).chain(inserted);
    let mut delays = known.min_by_key(|delays| problem.cost(delays)).expect("delays that were found before");
    let mut bound = problem.cost(&vec![0; problem.len()]);
    if problem.pairs.len() > SEARCHED && effort == DelaySearchOptions::default() {
        // The bound of the root node, without a search.
        let root = BranchAndBound::new(problem, SearchLimits { nodes: 0, clock }).root();
        bound = root.map_or(bound, |root| bound.max(problem.cost(&root)));
        return DelaySolution { proved: bound >= problem.cost(&delays), delays, bound };
    }
    let share = |of_all: u64| share(problem, effort, of_all);
    let (mut search, mut nodes, mut rounds) = (1, NODES, ROUNDS as u64);
    loop {
        let next = BranchAndBound::new(problem, SearchLimits { nodes: share(nodes), clock });
        let limit = problem.cost(&delays);
        // Depth first at first, to find delays; then the least bound first, to raise the bound, unless that takes too much memory.
        let found = if search == 1 || nodes > best_first::MOST { next.run([], limit) } else { next.lowest(limit) };
        bound = bound.max(found.bound);
        delays = found.delays.unwrap_or(delays);
        let proved = found.complete || bound >= problem.cost(&delays);
        if proved || clock() || (!effort.prove && search == SEARCHES) {
            return DelaySolution { bound: if proved { problem.cost(&delays) } else { bound }, delays, proved };
        }
        delays = large_neighbourhood::improved(problem, delays, share(rounds) as usize, clock);
        nodes = nodes.saturating_mul(FACTOR.into());
        rounds = rounds.saturating_mul(FACTOR.into());
        search += 1;
    }
}
