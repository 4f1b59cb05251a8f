//! Whom to leave out so that all others have delays: the fewest agents that hit all conflicts, which are found one after the other.
//!
//! A conflict is a set of agents that have no delays together. Whoever has to be left out, at least one of each conflict is. A
//! least set that hits all known conflicts is tried; where the others have no delays yet, they hold a conflict that is not
//! known. So the first set that suffices is one of the fewest.

use super::problem::Problem;
use super::search::{Search, Stop};

/// Conflicts, and whom to leave out because of them.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Left {
    /// Sets of agents of which none has delays for all of its agents, and each has if any of them is left out: all pairs, and what else was found.
    pub(super) conflicts: Vec<Vec<usize>>,
    /// Places of the agents that are left out.
    pub(super) out: Vec<usize>,
}

/// The pairs that meet whatever their delays are.
pub(super) fn impossible(problem: &Problem) -> Vec<Vec<usize>> {
    let pairs = problem.pairs.iter().filter(|pair| pair.is_impossible());
    pairs.map(|pair| pair.agents.to_vec()).collect()
}

/// Whom to leave out; `None` if the search was stopped before that was known.
pub(super) fn left(problem: &Problem, stop: Stop<'_>) -> Option<Left> {
    let mut left = Left { conflicts: impossible(problem), out: Vec::new() };
    loop {
        left.out = hitting(&left.conflicts, problem.len(), stop)?;
        let staying: Vec<usize> = (0..problem.len()).filter(|agent| !left.out.contains(agent)).collect();
        // Parts that forbid one another nothing have conflicts of their own.
        let parts = problem.of(&staying).parts().into_iter();
        let parts = parts.map(|part| part.into_iter().map(|place| staying[place]).collect::<Vec<_>>());
        let before = left.conflicts.len();
        for part in parts {
            if !has_delays(problem, &part, stop)? {
                left.conflicts.push(least_conflict(problem, part, stop)?);
            }
        }
        if left.conflicts.len() == before {
            return Some(left);
        }
    }
}

/// Whether there are delays for these agents; `None` if that is not known.
fn has_delays(problem: &Problem, agents: &[usize], stop: Stop<'_>) -> Option<bool> {
    let part = problem.of(agents);
    // Any will do: the first one that is found ends the search.
    let found = Search::new(&part, stop).first();
    if found.delays.is_some() { Some(true) } else { found.complete.then_some(false) }
}

/// Those of a conflict that are left if everybody is taken out without whom it is one.
fn least_conflict(problem: &Problem, mut conflict: Vec<usize>, stop: Stop<'_>) -> Option<Vec<usize>> {
    for agent in conflict.clone() {
        let others: Vec<usize> = conflict.iter().copied().filter(|&other| other != agent).collect();
        if !has_delays(problem, &others, stop)? {
            conflict = others;
        }
    }
    Some(conflict)
}

/// The fewest agents of which each conflict has one; `None` if the search for them was stopped.
fn hitting(conflicts: &[Vec<usize>], agents: usize, stop: Stop<'_>) -> Option<Vec<usize>> {
    let mut search =
        Hitting { conflicts, out: vec![false; agents], kept: vec![false; agents], best: None, nodes: 0, stop };
    search.node(0);
    search.best.filter(|_| search.nodes <= stop.nodes)
}

/// Branch and bound over which agent of a conflict is left out.
struct Hitting<'a> {
    conflicts: &'a [Vec<usize>],
    out: Vec<bool>,
    kept: Vec<bool>,
    best: Option<Vec<usize>>,
    nodes: u64,
    stop: Stop<'a>,
}

impl Hitting<'_> {
    fn node(&mut self, count: usize) {
        self.nodes += 1;
        let open: Vec<&Vec<usize>> =
            self.conflicts.iter().filter(|conflict| !conflict.iter().any(|&agent| self.out[agent])).collect();
        // Conflicts that have no agent in common need one each.
        let mut used = vec![false; self.out.len()];
        let mut needed = 0;
        for conflict in &open {
            if !conflict.iter().any(|&agent| used[agent]) {
                conflict.iter().for_each(|&agent| used[agent] = true);
                needed += 1;
            }
        }
        let most = self.best.as_ref().map_or(usize::MAX, Vec::len);
        if count + needed >= most || self.nodes > self.stop.nodes {
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
            self.out[agent] = true;
            self.node(count + 1);
            self.out[agent] = false;
            // With it the search has been done.
            self.kept[agent] = true;
        }
        choices.iter().for_each(|&agent| self.kept[agent] = false);
    }
}
