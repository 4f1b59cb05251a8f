//! Whether agents have delays at all: a search over sides that knows what differences of delays are left between any two agents.
//!
//! What all constraints together ask of two agents is the longest path between them. An interval with one side that these paths
//! exclude leaves the other one, which makes further paths longer, and so on: most fleets without delays are found out so, before
//! anything is tried. Where something has to be tried it is the interval that led to most dead ends before (Boussemart et al. 2004).

use super::problem::{Constraint, NEVER, Problem};
use super::search::{Search, Stop};

/// No path between two agents.
const UNKNOWN: i64 = -(1 << 60);

/// Dead ends until a search begins anew with what it has learnt of where they are, and by how much more each time.
const FIRST: u64 = 50;
const GROWTH: u64 = 2;

/// What was found.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Feasible {
    /// Delays of all agents \[ticks\].
    Delays(Vec<i64>),
    /// There are none: it is proved.
    Never,
    /// The search was stopped.
    Stopped,
}

/// Agents up to which the paths between any two are known: that takes their square.
pub(super) const MOST: usize = 2_000;

/// Delays of all agents, any; and how many nodes that took.
pub(super) fn feasible(problem: &Problem, stop: Stop<'_>) -> (Feasible, u64) {
    if problem.len() > MOST {
        let root = Search::new(problem, stop).root();
        return (if root.is_none() { Feasible::Never } else { Feasible::Stopped }, 1);
    }
    let mut paths = Paths::new(problem);
    if !paths.settle(stop) {
        return (Feasible::Never, 1);
    }
    let (mut nodes, mut dead_ends) = (0, FIRST);
    loop {
        match paths.dive(stop, &mut nodes, dead_ends) {
            Feasible::Stopped if nodes <= stop.nodes && !(stop.clock)() => dead_ends *= GROWTH,
            found => return (found, nodes),
        }
    }
}

struct Paths<'a> {
    problem: &'a Problem,
    count: usize,
    /// By how much the delay of the column is larger than that of the row, at least \[ticks\].
    least: Vec<i64>,
    /// What was there before.
    changes: Vec<(usize, i64)>,
    /// How often each pair was at a dead end.
    weights: Vec<u64>,
    /// Where a constraint makes the paths of its beginning longer, and how long they are then.
    row: Vec<(usize, i64)>,
}

impl<'a> Paths<'a> {
    fn new(problem: &'a Problem) -> Self {
        let count = problem.len();
        let mut least = vec![UNKNOWN; count * count];
        (0..count).for_each(|agent| least[agent * count + agent] = 0);
        Self { problem, count, least, changes: Vec::new(), weights: vec![0; problem.pairs.len()], row: Vec::new() }
    }

    fn at(&self, from: usize, to: usize) -> i64 {
        self.least[from * self.count + to]
    }

    /// Adds a constraint; false if it makes a circle that adds up to more than 0.
    fn impose(&mut self, Constraint { from, to, least }: Constraint) -> bool {
        if least >= NEVER || self.at(to, from) + least > 0 {
            return false;
        }
        if self.at(from, to) >= least {
            return true;
        }
        let count = self.count;
        let mut row = std::mem::take(&mut self.row);
        row.clear();
        // Paths that do not get longer as far as the end of the constraint do not get longer beyond it.
        let beyond = (0..count).map(|place| (place, self.at(to, place))).filter(|(_, after)| *after > UNKNOWN);
        let beyond = beyond.map(|(place, after)| (place, least + after));
        row.extend(beyond.filter(|&(place, whole)| whole > self.at(from, place)));
        for first in 0..count {
            let before = self.at(first, from);
            if before <= UNKNOWN || before + least <= self.at(first, to) {
                continue;
            }
            let own = &mut self.least[first * count..(first + 1) * count];
            for &(place, after) in &row {
                if before + after > own[place] {
                    self.changes.push((first * count + place, own[place]));
                    own[place] = before + after;
                }
            }
        }
        self.row = row;
        true
    }

    fn take_back(&mut self, mark: usize) {
        while self.changes.len() > mark {
            if let Some((place, before)) = self.changes.pop() {
                self.least[place] = before;
            }
        }
    }

    /// Takes all sides that are the only ones left, until there is no more time; false if an interval has none.
    fn settle(&mut self, stop: Stop<'_>) -> bool {
        loop {
            let mark = self.changes.len();
            for (place, pair) in self.problem.pairs.iter().enumerate() {
                let [first, second] = pair.agents;
                for &[lo, hi] in pair.intervals() {
                    let (least, most) = (self.at(first, second), -self.at(second, first));
                    if least >= hi || most <= lo {
                        continue;
                    }
                    let [below, above] = pair.beside([lo, hi]);
                    let only = match (lo > -NEVER && least <= lo, hi < NEVER && most >= hi) {
                        (true, true) => continue,
                        (true, false) => below,
                        (false, true) => above,
                        (false, false) => {
                            self.weights[place] += 1;
                            return false;
                        }
                    };
                    if !self.impose(only) {
                        return false;
                    }
                    if (stop.clock)() {
                        return true;
                    }
                }
            }
            if self.changes.len() == mark {
                return true;
            }
        }
    }

    /// The least delays that keep all constraints.
    fn delays(&self) -> Vec<i64> {
        let of = |to: usize| (0..self.count).map(|from| self.at(from, to)).fold(0, i64::max);
        (0..self.count).map(of).collect()
    }

    /// Depth first, until so many dead ends.
    fn dive(&mut self, stop: Stop<'_>, nodes: &mut u64, mut dead_ends: u64) -> Feasible {
        let begin = self.changes.len();
        let mut later: Vec<(usize, Constraint)> = Vec::new();
        loop {
            *nodes += 1;
            let delays = self.delays();
            let Some([first, second]) = self.chosen(&delays) else { return Feasible::Delays(delays) };
            if *nodes > stop.nodes || dead_ends == 0 || (stop.clock)() {
                self.take_back(begin);
                return Feasible::Stopped;
            }
            later.push((self.changes.len(), second));
            let mut next = first;
            while !(self.impose(next) && self.settle(stop)) {
                dead_ends = dead_ends.saturating_sub(1);
                let Some((mark, other)) = later.pop() else {
                    self.take_back(begin);
                    return Feasible::Never;
                };
                self.take_back(mark);
                next = other;
            }
        }
    }

    /// The sides of an interval that holds the difference of two delays, the cheaper one first.
    fn chosen(&self, delays: &[i64]) -> Option<[Constraint; 2]> {
        let violated = self.problem.pairs.iter().zip(&self.weights).filter_map(|(pair, &weight)| {
            let ends = pair.violated(delays)?;
            let difference = pair.difference(delays);
            let raises = [difference - ends[0], ends[1] - difference];
            Some(((weight, raises[0].min(raises[1])), raises, pair.beside(ends)))
        });
        let (_, raises, [below, above]) = violated.max_by_key(|(key, ..)| *key)?;
        Some(if raises[0] <= raises[1] { [below, above] } else { [above, below] })
    }
}
