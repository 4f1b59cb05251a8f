//! Which agents to leave out so that all others have delays: the fewest agents that hit all conflicts; conflicts are
//! found one after the other.
//!
//! A conflict is a set of agents that have no delays together; at least one agent of each conflict has to be left out.
//! A least set that hits all known conflicts is tried. If the remaining agents have no delays, they contain a conflict
//! that is not known yet. So the first set that suffices has the fewest agents.
//!
//! On the way there, one more agent of each new conflict is left out until the others have delays. These are an answer
//! too: if the search is stopped, the best of them is kept.

use super::branch_and_bound::{BranchAndBound, SearchLimits};
use super::feasibility::{Feasibility, MOST, feasible};
use super::problem::{DelayProblem, first};
use super::sequential;
use std::collections::BTreeMap;

/// Conflicts, and the delays of the agents that stay in spite of them.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct LeaveOutResult {
    /// Sets of agents that cannot all have delays: all pairs that always meet, and the sets found by search. With `fewest`, removing any
    /// one agent makes the rest of its set feasible, as far as short searches tell.
    pub(super) conflicts: Vec<Vec<usize>>,
    /// Delays of the agents that stay \[ticks\]; `None` for those left out.
    pub(super) delays: Vec<Option<i64>>,
    /// Whether it is proved that no larger set of agents can stay; `false` if a search was stopped before.
    pub(super) fewest: bool,
}

impl LeaveOutResult {
    /// All agents have delays.
    pub(super) fn nobody(delays: Vec<i64>) -> Self {
        Self { conflicts: Vec::new(), delays: delays.into_iter().map(Some).collect(), fewest: true }
    }

    fn count(delays: &[Option<i64>]) -> usize {
        delays.iter().filter(|delay| delay.is_none()).count()
    }
}

/// Node limit of all searches together, as a multiple of the limit of one search.
const SEARCHES: u64 = 10;
/// Node limit of a search that decides whether a conflict remains one without an agent.
const SHORT: u64 = 200;
/// A fleet with more agents begins no search once time or nodes are used up, because a search takes seconds before its first node.
/// From a conflict with more agents many are removed at once.
const LARGE: usize = 200;

/// The pairs that meet with all delays.
pub(super) fn impossible(problem: &DelayProblem) -> Vec<Vec<usize>> {
    let pairs = problem.pairs.iter().filter(|pair| pair.is_impossible());
    pairs.map(|pair| pair.agents.to_vec()).collect()
}

/// The agents to leave out. If a search is stopped, the answer is the best one found until then: all agents that stay have delays.
/// Without `ask_fewest` the answer is the first one found, with the conflicts that led to it.
///
/// `with` has for each agent the agents that have to be left out with it, itself included.
pub(super) fn agents_to_leave_out(
    problem: &DelayProblem,
    with: &[Vec<usize>],
    stop: SearchLimits<'_>,
    ask_fewest: bool,
) -> LeaveOutResult {
    let mut best =
        LeaveOutResult { conflicts: impossible(problem), delays: sequential::inserted(problem), fewest: true };
    close(&mut best.delays, with);
    let large = problem.len() > LARGE;
    let mut budget = NodeBudget { stop, left: stop.nodes.saturating_mul(SEARCHES), large };
    // Whoever asks for all agents has the answer, and more reasons take longer.
    if !ask_fewest && !best.conflicts.is_empty() && (stop.clock)() {
        return LeaveOutResult { fewest: false, ..best };
    }
    loop {
        let hit = hitting(&best.conflicts, with, stop, &mut best.fewest);
        let (least, before) = (hit.len(), best.conflicts.len());
        let mut out = vec![false; problem.len()];
        hit.into_iter().for_each(|agent| out[agent] = true);
        // One more agent of each new conflict is left out, until all agents that stay have delays.
        let found = loop {
            let staying: Vec<usize> = (0..problem.len()).filter(|&agent| !out[agent]).collect();
            let found = together(problem, &staying, &mut budget);
            best.fewest &= !found.stopped;
            if found.conflicts.is_empty() {
                let mut delays = found.delays;
                close(&mut delays, with);
                break delays;
            }
            best.conflicts.extend(found.conflicts.iter().cloned());
            let mut frequency = vec![0_usize; problem.len()];
            best.conflicts.iter().flatten().for_each(|&agent| frequency[agent] += 1);
            for conflict in &found.conflicts {
                let gone = conflict.iter().copied().max_by_key(|&agent| frequency[agent]);
                gone.into_iter().flat_map(|agent| &with[agent]).for_each(|&agent| out[agent] = true);
            }
        };
        if LeaveOutResult::count(&found) <= LeaveOutResult::count(&best.delays) {
            best.delays = found;
        }
        let few = LeaveOutResult::count(&best.delays) == least;
        if few || best.conflicts.len() == before || !ask_fewest || !best.fewest || budget.left == 0 || (stop.clock)() {
            best.fewest &= few;
            if !best.fewest {
                take_in(problem, &mut best.delays, &mut budget);
                close(&mut best.delays, with);
            }
            return best;
        }
    }
}

/// Leaves out all agents that have to be left out with those that have no delays.
fn close(delays: &mut [Option<i64>], with: &[Vec<usize>]) {
    let out: Vec<usize> = (0..delays.len()).filter(|&agent| delays[agent].is_none()).collect();
    out.iter().flat_map(|&agent| &with[agent]).for_each(|&agent| delays[agent] = None);
}

/// The nodes that all further searches together may still take.
struct NodeBudget<'a> {
    stop: SearchLimits<'a>,
    left: u64,
    /// Whether the fleet has more than `LARGE` agents.
    large: bool,
}

impl NodeBudget<'_> {
    /// Whether no further search may begin.
    fn is_over(&self) -> bool {
        self.large && (self.left == 0 || (self.stop.clock)())
    }

    fn feasible(&mut self, problem: &DelayProblem, nodes: u64) -> Feasibility {
        if self.is_over() {
            return Feasibility::Stopped;
        }
        let (found, taken) = feasible(problem, SearchLimits { nodes: nodes.min(self.left), ..self.stop });
        self.left = self.left.saturating_sub(taken);
        found
    }
}

/// The result of a search for delays of all agents of a set.
struct JointDelayResult {
    /// Delays of all agents; in a part whose search was stopped, of as many as can be inserted.
    delays: Vec<Option<i64>>,
    /// A conflict of each part that has no delays.
    conflicts: Vec<Vec<usize>>,
    stopped: bool,
}

fn together(problem: &DelayProblem, staying: &[usize], budget: &mut NodeBudget<'_>) -> JointDelayResult {
    let mut found = JointDelayResult { delays: vec![None; problem.len()], conflicts: Vec::new(), stopped: false };
    // Independent parts have conflicts of their own.
    for (part, own) in problem.of(staying).independent_problems() {
        let part: Vec<usize> = part.into_iter().map(|place| staying[place]).collect();
        let mut delays = sequential::inserted(&own);
        if delays.contains(&None) {
            match budget.feasible(&own, budget.stop.nodes) {
                Feasibility::Delays(all) => delays = all.into_iter().map(Some).collect(),
                Feasibility::Never => {
                    found.conflicts.push(least_conflict(problem, part, budget));
                    continue;
                }
                Feasibility::Stopped => found.stopped = true,
            }
        }
        part.iter().zip(delays).for_each(|(&agent, delay)| found.delays[agent] = delay);
    }
    found
}

/// A conflict without the agents that it does not need to be one, as far as short searches tell.
fn least_conflict(problem: &DelayProblem, mut conflict: Vec<usize>, budget: &mut NodeBudget<'_>) -> Vec<usize> {
    let is_forced = |agents: &[usize], budget: &NodeBudget<'_>| {
        BranchAndBound::new(&problem.of(agents), SearchLimits { nodes: 0, ..budget.stop }).root().is_none()
    };
    // For a large conflict only the root node is tried, because that is fast.
    let forced = conflict.len() > LARGE && is_forced(&conflict, budget);
    let mut chunk = if conflict.len() > LARGE { conflict.len() / 2 } else { 1 };
    loop {
        let mut begin = 0;
        while begin < conflict.len() {
            if budget.is_over() {
                return conflict;
            }
            let end = conflict.len().min(begin + chunk);
            let others = [&conflict[..begin], &conflict[end..]].concat();
            let is_one = match forced {
                true => {
                    budget.left = budget.left.saturating_sub(1);
                    is_forced(&others, budget)
                }
                false => budget.feasible(&problem.of(&others), SHORT) == Feasibility::Never,
            };
            match is_one {
                true => conflict = others,
                false => begin = end,
            }
        }
        if chunk == 1 {
            return conflict;
        }
        chunk = (chunk / 2).min(conflict.len() / 2).max(1);
    }
}

/// Gives delays to agents without any, if a short search finds delays for them together with all agents that have some.
fn take_in(problem: &DelayProblem, delays: &mut [Option<i64>], budget: &mut NodeBudget<'_>) {
    for agent in 0..delays.len() {
        if budget.is_over() {
            return;
        }
        let impossible = |pair: &super::ForbiddenPairDelays| {
            let other = pair.agents[usize::from(pair.agents[0] == agent)];
            pair.agents.contains(&agent) && pair.is_impossible() && delays[other].is_some()
        };
        if delays[agent].is_some() || problem.pairs.iter().any(impossible) || (budget.stop.clock)() {
            continue;
        }
        let together: Vec<usize> = (0..delays.len()).filter(|&it| it == agent || delays[it].is_some()).collect();
        // With more agents `feasible` does not search.
        if together.len() > MOST {
            return;
        }
        if let Feasibility::Delays(found) = budget.feasible(&problem.of(&together), SHORT) {
            together.iter().zip(found).for_each(|(&agent, delay)| delays[agent] = Some(delay));
        }
    }
}

/// A smallest set that has an agent of each conflict. If the search is stopped, `fewest` becomes false, and a smaller set may exist.
fn hitting(conflicts: &[Vec<usize>], with: &[Vec<usize>], stop: SearchLimits<'_>, fewest: &mut bool) -> Vec<usize> {
    let agents = with.len();
    let mut hit = Vec::new();
    for conflicts in independent_groups(conflicts, with) {
        let mut search = HittingSetSearch {
            conflicts: &conflicts,
            with,
            out: vec![false; agents],
            kept: vec![false; agents],
            best: None,
            nodes: 0,
            cut: false,
            stop,
        };
        search.node(0);
        *fewest &= !search.cut;
        // The first descent is never stopped, so it ends with a set.
        hit.extend(search.best.unwrap_or_else(|| (0..agents).collect()));
    }
    hit
}

/// The conflicts in independent groups: no agent that can be left out because of one group is affected by another one.
fn independent_groups<'a>(conflicts: &'a [Vec<usize>], with: &[Vec<usize>]) -> Vec<Vec<&'a Vec<usize>>> {
    // Each agent leads to another one of its group, and one to itself, which stands for all.
    let mut above: Vec<usize> = (0..with.len()).collect();
    for conflict in conflicts {
        let mut agents = conflict.iter().flat_map(|&agent| &with[agent]);
        let Some(&one) = agents.next() else { continue };
        for &other in agents {
            let [a, b] = [one, other].map(|agent| first(&mut above, agent));
            above[a] = b;
        }
    }
    let mut groups: BTreeMap<usize, Vec<&Vec<usize>>> = BTreeMap::new();
    for conflict in conflicts {
        let group =
            conflict.first().map_or(0, |&agent| first(&mut above, with[agent].first().copied().unwrap_or(agent)));
        groups.entry(group).or_default().push(conflict);
    }
    groups.into_values().collect()
}

/// Branch and bound: for a conflict, which of its agents is left out.
struct HittingSetSearch<'a> {
    conflicts: &'a [&'a Vec<usize>],
    with: &'a [Vec<usize>],
    out: Vec<bool>,
    kept: Vec<bool>,
    best: Option<Vec<usize>>,
    nodes: u64,
    /// Whether the search was stopped; the best set so far may not be smallest.
    cut: bool,
    stop: SearchLimits<'a>,
}

impl HittingSetSearch<'_> {
    fn node(&mut self, count: usize) {
        self.nodes += 1;
        let stopped = self.nodes > self.stop.nodes || (self.stop.clock)();
        self.cut |= stopped && self.best.is_some();
        if self.cut {
            return;
        }
        let is_open = |conflict: &&Vec<usize>| !conflict.iter().any(|&agent| self.out[agent]);
        let open: Vec<&Vec<usize>> = self.conflicts.iter().copied().filter(is_open).collect();
        // Conflicts without a common agent need one agent each.
        let mut used = vec![false; self.out.len()];
        let mut needed = 0;
        for conflict in &open {
            if !conflict.iter().any(|&agent| used[agent]) {
                conflict.iter().for_each(|&agent| used[agent] = true);
                needed += 1;
            }
        }
        let most = self.best.as_ref().map_or(usize::MAX, Vec::len);
        if count + needed >= most {
            return;
        }
        let frequency = |agent: usize| open.iter().filter(|conflict| conflict.contains(&agent)).count();
        let Some(conflict) = open.iter().min_by_key(|conflict| conflict.len()) else {
            self.best = Some((0..self.out.len()).filter(|&agent| self.out[agent]).collect());
            return;
        };
        let mut choices: Vec<usize> = conflict.iter().copied().filter(|&agent| !self.kept[agent]).collect();
        choices.sort_by_key(|&agent| std::cmp::Reverse(frequency(agent)));
        for &agent in &choices {
            let more: Vec<usize> = self.with[agent].iter().copied().filter(|&other| !self.out[other]).collect();
            more.iter().for_each(|&other| self.out[other] = true);
            self.node(count + more.len());
            more.iter().for_each(|&other| self.out[other] = false);
            // The branch in which it is left out has been searched.
            self.kept[agent] = true;
        }
        choices.iter().for_each(|&agent| self.kept[agent] = false);
    }
}
