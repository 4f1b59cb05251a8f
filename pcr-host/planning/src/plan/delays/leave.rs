//! Which agents to leave out so that all others have delays: the fewest agents that hit all conflicts; conflicts are
//! found one after the other.
//!
//! A conflict is a set of agents that have no delays together; at least one agent of each conflict has to be left out.
//! A least set that hits all known conflicts is tried. If the remaining agents have no delays, they contain a conflict
//! that is not known yet. So the first set that suffices has the fewest agents.
//!
//! If that takes too long, agents are inserted one after the other, and those that do not fit are left out.

use super::insert;
use super::problem::Problem;
use super::search::{Search, Stop};

/// Conflicts, and whom to leave out because of them.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Left {
    /// Sets of agents of which none has delays for all of its agents: all pairs, and what else was found. If `fewest`, each has if any of
    /// them is left out.
    pub(super) conflicts: Vec<Vec<usize>>,
    /// Delays of those that stay \[ticks\].
    pub(super) delays: Vec<Option<i64>>,
    /// Whether it is proved that nobody more can stay; else a search was stopped before that was known.
    pub(super) fewest: bool,
}

/// Once a search was stopped, further ones have their nodes divided by this.
const HASTE: u64 = 50;

/// The pairs that meet whatever their delays are.
pub(super) fn impossible(problem: &Problem) -> Vec<Vec<usize>> {
    let pairs = problem.pairs.iter().filter(|pair| pair.is_impossible());
    pairs.map(|pair| pair.agents.to_vec()).collect()
}

/// Whom to leave out. Where a search is stopped the answer is one that is found without: all that stay have delays.
pub(super) fn left(problem: &Problem, mut stop: Stop<'_>) -> Left {
    let mut left = Left { conflicts: impossible(problem), delays: Vec::new(), fewest: true };
    loop {
        let out = hitting(&left.conflicts, problem.len(), stop, &mut left.fewest);
        left.delays = vec![None; problem.len()];
        let staying: Vec<usize> = (0..problem.len()).filter(|agent| !out.contains(agent)).collect();
        // Parts that forbid one another nothing have conflicts of their own.
        let parts = problem.of(&staying).parts().into_iter();
        let parts = parts.map(|part| part.into_iter().map(|place| staying[place]).collect::<Vec<_>>());
        let before = left.conflicts.len();
        for part in parts {
            match delays(problem, &part, stop) {
                Delays::All(found) => {
                    part.iter().zip(found).for_each(|(&agent, delay)| left.delays[agent] = Some(delay));
                }
                Delays::Never => left.conflicts.push(least_conflict(problem, part, stop)),
                Delays::Some(found) => {
                    part.iter().zip(found).for_each(|(&agent, delay)| left.delays[agent] = delay);
                    left.fewest = false;
                }
            }
        }
        if left.conflicts.len() == before {
            if !left.fewest {
                take_in(problem, &mut left.delays, stop);
            }
            return left;
        }
        if !left.fewest {
            stop.nodes = stop.nodes.min(super::DECIDING / HASTE);
        }
    }
}

/// Delays of some agents.
enum Delays {
    /// Of all of them.
    All(Vec<i64>),
    /// There are none for all of them: it is proved.
    Never,
    /// A search was stopped before either was known. Of as many as could be inserted.
    Some(Vec<Option<i64>>),
}

fn delays(problem: &Problem, agents: &[usize], stop: Stop<'_>) -> Delays {
    let part = problem.of(agents);
    let inserted = insert::inserted(&part);
    if let Some(all) = inserted.iter().copied().collect::<Option<Vec<i64>>>() {
        return Delays::All(all);
    }
    // Any will do: the first ones that are found end the search.
    let found = Search::new(&part, stop).first();
    match found.delays {
        Some(all) => Delays::All(all),
        None if found.complete => Delays::Never,
        None => Delays::Some(inserted),
    }
}

/// Those of a conflict that are left if everybody is taken out without whom it is one, as far as searches tell.
fn least_conflict(problem: &Problem, mut conflict: Vec<usize>, stop: Stop<'_>) -> Vec<usize> {
    for agent in conflict.clone() {
        let others: Vec<usize> = conflict.iter().copied().filter(|&other| other != agent).collect();
        if matches!(delays(problem, &others, stop), Delays::Never) {
            conflict = others;
        }
    }
    conflict
}

/// Gives delays to those that have none where a short search finds some for them and all that have.
fn take_in(problem: &Problem, delays: &mut [Option<i64>], stop: Stop<'_>) {
    let stop = Stop { nodes: stop.nodes.min(super::DECIDING / HASTE / HASTE), ..stop };
    for agent in 0..delays.len() {
        let impossible = |pair: &super::Pair| {
            let other = pair.agents[usize::from(pair.agents[0] == agent)];
            pair.agents.contains(&agent) && pair.is_impossible() && delays[other].is_some()
        };
        if delays[agent].is_some() || problem.pairs.iter().any(impossible) || (stop.clock)() {
            continue;
        }
        let together: Vec<usize> = (0..delays.len()).filter(|&it| it == agent || delays[it].is_some()).collect();
        let part = problem.of(&together);
        if let Some(found) = Search::new(&part, stop).first().delays {
            together.iter().zip(found).for_each(|(&agent, delay)| delays[agent] = Some(delay));
        }
    }
}

/// The fewest agents of which each conflict has one. If the search for them is stopped `fewest` becomes false, and they are few.
fn hitting(conflicts: &[Vec<usize>], agents: usize, stop: Stop<'_>, fewest: &mut bool) -> Vec<usize> {
    let mut search = Hitting {
        conflicts,
        out: vec![false; agents],
        kept: vec![false; agents],
        best: None,
        nodes: 0,
        cut: false,
        stop,
    };
    search.node(0);
    *fewest &= !search.cut;
    // The first dive ends with some, however many nodes it takes.
    search.best.unwrap_or_else(|| (0..agents).collect())
}

/// Branch and bound over which agent of a conflict is left out.
struct Hitting<'a> {
    conflicts: &'a [Vec<usize>],
    out: Vec<bool>,
    kept: Vec<bool>,
    best: Option<Vec<usize>>,
    nodes: u64,
    /// Whether it was stopped with some that are few.
    cut: bool,
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
        let stopped = self.nodes > self.stop.nodes || (self.stop.clock)();
        self.cut |= stopped && self.best.is_some();
        if count + needed >= most || self.cut {
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
