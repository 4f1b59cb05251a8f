//! Decides whether delays exist: a search over sides that maintains the remaining differences of delays between any two agents.
//!
//! The constraint that all constraints together impose on two agents is the longest path between them. If these paths exclude
//! one side of an interval, the other side is forced, which makes further paths longer, and so on. For most fleets without
//! delays this alone leads to a contradiction. Otherwise the search branches on the interval that led to most dead ends before
//! (Boussemart et al. 2004).

use super::branch_and_bound::{BranchAndBound, SearchLimits};
use super::problem::{DelayProblem, DifferenceConstraint, NEVER};

/// Marks two agents without a path between them.
const UNKNOWN: i64 = -(1 << 60);

/// Number of dead ends after which a search restarts with its weights, and the factor by which it grows each time.
const FIRST: u64 = 50;
const GROWTH: u64 = 2;

/// The result of the search.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Feasibility {
    /// Delays of all agents \[ticks\].
    Delays(Vec<i64>),
    /// It is proved that there are none.
    Never,
    /// The search was stopped.
    Stopped,
}

/// Largest number of agents for which the paths between any two are stored: the memory grows with its square.
pub(super) const MOST: usize = 2_000;

/// Searches any delays of all agents; also returns the number of nodes.
pub(super) fn feasible(problem: &DelayProblem, stop: SearchLimits<'_>) -> (Feasibility, u64) {
    if problem.len() > MOST {
        let root = BranchAndBound::new(problem, stop).root();
        return (if root.is_none() { Feasibility::Never } else { Feasibility::Stopped }, 1);
    }
    let mut paths = DifferenceBounds::new(problem);
    if !paths.propagate(stop) {
        return (Feasibility::Never, 1);
    }
    let (mut nodes, mut dead_ends) = (0, FIRST);
    loop {
        match paths.dive(stop, &mut nodes, dead_ends) {
            Feasibility::Stopped if nodes <= stop.nodes && !(stop.clock)() => dead_ends *= GROWTH,
            found => return (found, nodes),
        }
    }
}

struct DifferenceBounds<'a> {
    problem: &'a DelayProblem,
    count: usize,
    /// Least difference of two delays: that of the column minus that of the row \[ticks\].
    least: Vec<i64>,
    /// Former values of the entries that were changed.
    changes: Vec<(usize, i64)>,
    /// For each pair the number of dead ends at it.
    weights: Vec<u64>,
    /// Scratch: rows whose paths to the start of a constraint got longer, with their lengths.
    row: Vec<(usize, i64)>,
}

impl<'a> DifferenceBounds<'a> {
    fn new(problem: &'a DelayProblem) -> Self {
        let count = problem.len();
        let mut least = vec![UNKNOWN; count * count];
        (0..count).for_each(|agent| least[agent * count + agent] = 0);
        Self { problem, count, least, changes: Vec::new(), weights: vec![0; problem.pairs.len()], row: Vec::new() }
    }

    fn at(&self, from: usize, to: usize) -> i64 {
        self.least[from * self.count + to]
    }

    /// Adds a constraint; `false` if it makes a cycle whose sum is above 0.
    fn impose(&mut self, DifferenceConstraint { from, to, least }: DifferenceConstraint) -> bool {
        if least >= NEVER || self.at(to, from) + least > 0 {
            return false;
        }
        if self.at(from, to) >= least {
            return true;
        }
        let count = self.count;
        let mut row = std::mem::take(&mut self.row);
        row.clear();
        // A path that does not get longer up to the end of the constraint does not get longer beyond it.
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

    fn undo_to(&mut self, mark: usize) {
        while self.changes.len() > mark {
            if let Some((place, before)) = self.changes.pop() {
                self.least[place] = before;
            }
        }
    }

    /// Adds all forced sides, until the time is over; `false` if an interval has no side left.
    fn propagate(&mut self, stop: SearchLimits<'_>) -> bool {
        loop {
            let mark = self.changes.len();
            for (place, pair) in self.problem.pairs.iter().enumerate() {
                let [first, second] = pair.agents;
                for &[lo, hi] in pair.intervals() {
                    let (least, most) = (self.at(first, second), -self.at(second, first));
                    if least >= hi || most <= lo {
                        continue;
                    }
                    let [below, above] = pair.constraints_around([lo, hi]);
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

    /// Depth-first search, until this number of dead ends.
    fn dive(&mut self, stop: SearchLimits<'_>, nodes: &mut u64, mut dead_ends: u64) -> Feasibility {
        let begin = self.changes.len();
        let mut later: Vec<(usize, DifferenceConstraint)> = Vec::new();
        loop {
            *nodes += 1;
            let delays = self.delays();
            let Some([first, second]) = self.chosen(&delays) else { return Feasibility::Delays(delays) };
            if *nodes > stop.nodes || dead_ends == 0 || (stop.clock)() {
                self.undo_to(begin);
                return Feasibility::Stopped;
            }
            later.push((self.changes.len(), second));
            let mut next = first;
            while !(self.impose(next) && self.propagate(stop)) {
                dead_ends = dead_ends.saturating_sub(1);
                let Some((mark, other)) = later.pop() else {
                    self.undo_to(begin);
                    return Feasibility::Never;
                };
                self.undo_to(mark);
                next = other;
            }
        }
    }

    /// The sides of an interval that contains the difference of two delays, the cheaper one first.
    fn chosen(&self, delays: &[i64]) -> Option<[DifferenceConstraint; 2]> {
        let violated = self.problem.pairs.iter().zip(&self.weights).filter_map(|(pair, &weight)| {
            let ends = pair.violated(delays)?;
            let difference = pair.difference(delays);
            let raises = [difference - ends[0], ends[1] - difference];
            Some(((weight, raises[0].min(raises[1])), raises, pair.constraints_around(ends)))
        });
        let (_, raises, [below, above]) = violated.max_by_key(|(key, ..)| *key)?;
        Some(if raises[0] <= raises[1] { [below, above] } else { [above, below] })
    }
}
