//! Start delays with a proof of their quality: the best ones for an objective, a lower bound of the cost of all delays,
//! or a proof that there are none.
//!
//! ```text
//! problem   forbidden delays of pairs, in ticks          Problem
//! net       difference constraints, longest paths        (internal)
//! search    branch and bound over sides                  (internal)
//! improve   large neighbourhood search                   (internal)
//! groups    a bound from groups of agents                (internal)
//! precedence  which agents have to start before others   (internal)
//! insert    one agent after the other                    (internal)
//! leave     the fewest agents to leave out               (internal)
//! ```

mod groups;
mod improve;
mod insert;
mod leave;
mod net;
mod precedence;
mod problem;
mod search;
#[cfg(test)]
mod tests;

pub(crate) use precedence::respecting;
pub use problem::Objective;
pub(crate) use problem::{NEVER, Pair, Problem, Ticks, earliest, slack};
use search::{Search, Stop};
use std::time::{Duration, Instant};

/// How long to search.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Effort {
    /// Until it is proved that nothing is better; else for a number of nodes and rounds, which finds the same every time.
    pub prove: bool,
    /// At most this long. What is found then depends on the machine.
    pub time: Option<Duration>,
}

/// Nodes and rounds of the first attempt. Each later one has more by a factor.
const NODES: u64 = 2_000;
const ROUNDS: usize = 200;
const FACTOR: u32 = 8;
/// Attempts if nothing has to be proved.
const ATTEMPTS: u32 = 2;
/// Rounds where some delays are enough.
const SOME: usize = 20;
/// Nodes of a search in which it matters whether there are delays at all, for few agents and for many: less for more of them, as each
/// node takes longer.
const DECIDING: u64 = 200_000;
/// Pairs of agents that forbid one another something up to which a part is searched, unless a search is asked for: of a larger one
/// the best of the orders of priority that were tried stands, with a bound.
const SEARCHED: usize = 20_000;
const FEW: u64 = 20;

/// What was found.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Outcome {
    /// The delays of all agents but those that are left out \[ticks\]; none if the search was stopped before it found any.
    pub(crate) delays: Option<Vec<Option<i64>>>,
    /// Nothing costs less, for the agents that are not left out \[ticks\]; without rounding.
    pub(crate) bound: i128,
    /// Whether the delays are the best but for rounding.
    pub(crate) proved: bool,
    /// Sets of agents that have no delays together. It is proved.
    pub(crate) conflicts: Vec<Vec<usize>>,
    /// Whether nobody more can have delays; else some are left out because none were found for them before a search was stopped.
    pub(crate) fewest: bool,
}

/// The best delays, or who cannot have any together and the best delays of all others. `known` delays are the worst that
/// come out, in each part in which all have one.
pub(crate) fn best(problem: &Problem, known: &[Vec<Option<i64>>], effort: Effort) -> Outcome {
    let begin = Instant::now();
    let clock = || effort.time.is_some_and(|time| begin.elapsed() >= time);
    let of_all = solved(problem, known, effort, &clock);
    if let Some(delays) = of_all.delays {
        let delays = Some(delays.into_iter().map(Some).collect());
        return Outcome { delays, bound: of_all.bound, proved: of_all.proved, conflicts: Vec::new(), fewest: true };
    }
    let nodes = DECIDING * FEW / FEW.max(problem.len() as u64);
    let left = leave::left(problem, Stop { nodes, clock: &clock });
    let staying: Vec<usize> = (0..problem.len()).filter(|&agent| left.delays[agent].is_some()).collect();
    let part = problem.of(&staying);
    let known: Vec<Option<i64>> = left.delays.iter().filter(|delay| delay.is_some()).copied().collect();
    let rest = solved(&part, &[known], effort, &clock);
    let delays = rest.delays.map(|found| {
        let mut delays = vec![None; problem.len()];
        staying.iter().zip(found).for_each(|(&agent, delay)| delays[agent] = Some(delay));
        delays
    });
    Outcome { delays, bound: rest.bound, proved: rest.proved, conflicts: left.conflicts, fewest: left.fewest }
}

/// Delays of all agents, or of most of them, in milliseconds where a fleet has dozens of agents: not the best ones.
pub(crate) fn some(problem: &Problem) -> Vec<Option<i64>> {
    let clock = || false;
    let found = insert::inserted(problem);
    match found.iter().copied().collect::<Option<Vec<i64>>>() {
        Some(all) => improve::improved(problem, all, SOME, &clock).into_iter().map(Some).collect(),
        None => leave::left(problem, Stop { nodes: NODES, clock: &clock }).delays,
    }
}

struct Solved {
    delays: Option<Vec<i64>>,
    bound: i128,
    proved: bool,
    /// False if it is proved that there are no delays.
    possible: bool,
}

/// The parts that forbid one another nothing, each for itself.
fn solved(problem: &Problem, known: &[Vec<Option<i64>>], effort: Effort, clock: &dyn Fn() -> bool) -> Solved {
    let mut delays = Some(vec![0; problem.len()]);
    let (mut bound, mut proved) = (0_i128, true);
    for (agents, part) in problem.apart() {
        let known = known.iter().filter_map(|known| agents.iter().map(|&agent| known[agent]).collect());
        let found = connected(&part, known, effort, clock);
        if !found.possible {
            return found;
        }
        match (&mut delays, found.delays) {
            (Some(delays), Some(found)) => {
                agents.iter().zip(found).for_each(|(&agent, delay)| delays[agent] = delay);
            }
            (delays, _) => *delays = None,
        }
        bound = match problem.objective {
            Objective::Sum => bound + found.bound,
            Objective::Makespan => bound.max(found.bound),
        };
        proved &= found.proved;
    }
    let bound = bound - slack(problem);
    // A part that is not proved does not matter if the last arrival is in another one.
    let proved = match (&delays, problem.objective) {
        (Some(delays), Objective::Makespan) => problem.cost(delays) <= bound + slack(problem),
        _ => proved,
    };
    Solved { proved: proved && delays.is_some(), delays, bound, possible: true }
}

/// Search, improvement and bounds in turn, with more and more effort.
fn connected(
    problem: &Problem,
    known: impl Iterator<Item = Vec<i64>>,
    effort: Effort,
    clock: &dyn Fn() -> bool,
) -> Solved {
    let inserted = insert::inserted(problem).into_iter().collect::<Option<Vec<i64>>>();
    let known = known.filter(|delays| problem.allows(delays)).chain(inserted);
    let mut delays = known.min_by_key(|delays| problem.cost(delays));
    let limit = |delays: &Option<Vec<i64>>| delays.as_ref().map_or(i128::MAX, |delays| problem.cost(delays));
    let mut bound = problem.cost(&vec![0; problem.len()]);
    if problem.pairs.len() > SEARCHED && effort == Effort::default() {
        // What all plans have in common: none of it, and there is no plan.
        let root = Search::new(problem, Stop { nodes: 0, clock }).root();
        bound = root.as_ref().map_or(bound, |root| bound.max(problem.cost(root))).min(limit(&delays));
        return Solved { proved: bound >= limit(&delays), delays, bound, possible: root.is_some() };
    }
    let (mut nodes, mut rounds, mut attempt) = (NODES, ROUNDS, 0);
    loop {
        let found = Search::new(problem, Stop { nodes, clock }).run([], limit(&delays));
        bound = bound.max(found.bound.min(limit(&delays)));
        delays = found.delays.or(delays);
        if found.complete {
            let possible = delays.is_some();
            return Solved { bound: limit(&delays), delays, proved: possible, possible };
        }
        attempt += 1;
        bound = bound.max(groups::bound(problem, Stop { nodes: NODES, clock }).min(limit(&delays)));
        delays = delays.map(|delays| improve::improved(problem, delays, rounds, clock));
        if bound >= limit(&delays) || clock() || (!effort.prove && attempt == ATTEMPTS) {
            let proved = bound >= limit(&delays);
            return Solved { delays, bound, proved, possible: true };
        }
        nodes = nodes.saturating_mul(FACTOR.into());
        rounds = rounds.saturating_mul(FACTOR as usize);
    }
}
