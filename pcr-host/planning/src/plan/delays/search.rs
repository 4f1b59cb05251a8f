//! Delays of least cost, by branch and bound over the sides of forbidden intervals.
//!
//! A node of the search tree has constraints for the sides that were chosen. The least delays that satisfy them have
//! the least cost for either objective, which is the lower bound of the node. If they violate no pair, they are its
//! best solution. Otherwise the search branches on a violated pair: its difference is below the interval, or above it.
//! No solution is lost by that, and every branch adds one of finitely many constraints. `docs/theory.md` has the
//! proofs.

use super::net::Net;
use super::problem::{Constraint, Objective, Problem};

/// Violated pairs of which both sides are tried before one is chosen, at most.
const TRIED: usize = 16;
/// Agents that have to wait, or let wait, up to which cliques of them are looked for: a bound that takes their square.
const MOST_WAITING: usize = 2_000;
/// Nodes after which the clock is looked at, where each of them looks at fewer pairs than this.
const TICK: u64 = 32;
const LONG: usize = 2_000;

/// When a search stops: what it found until then is what it answers.
#[derive(Clone, Copy)]
pub(crate) struct Stop<'a> {
    /// After so many nodes.
    pub(crate) nodes: u64,
    /// As soon as this says so.
    pub(crate) clock: &'a dyn Fn() -> bool,
}

/// What a search found.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Found {
    /// The best delays that cost less than the limit.
    pub(super) delays: Option<Vec<i64>>,
    /// No delays cost less than this or, if that is less, than the limit \[ticks\].
    pub(super) bound: i128,
    /// Whether it was not stopped: there is nothing better.
    pub(super) complete: bool,
    /// Nodes of the tree.
    pub(super) nodes: u64,
}

/// A pair of which the difference is in a forbidden interval.
struct Violated {
    agents: [usize; 2],
    /// The delay of one of them is larger by so much, at least.
    raises: [i64; 2],
    /// The two ways out.
    sides: [Constraint; 2],
}

impl Violated {
    fn least(&self) -> i64 {
        self.raises[0].min(self.raises[1])
    }
}

/// What a node does next.
pub(super) enum Step {
    /// Nothing is left.
    End,
    /// One side is possible only.
    Only(Constraint),
    /// Two sides, the cheaper first.
    Both([Constraint; 2]),
}

pub(super) struct Search<'a> {
    pub(super) problem: &'a Problem,
    /// Places of the pairs that may be violated.
    pairs: Vec<usize>,
    pub(super) net: Net,
    stop: Stop<'a>,
    best: Option<Vec<i64>>,
    /// Only what costs less is of interest.
    pub(super) limit: i128,
    /// The least bound of the nodes that were not looked at.
    open: i128,
    nodes: u64,
    stopped: bool,
}

impl<'a> Search<'a> {
    /// For all pairs.
    pub(super) fn new(problem: &'a Problem, stop: Stop<'a>) -> Self {
        Self::among(problem, (0..problem.pairs.len()).collect(), stop)
    }

    /// For some pairs; constraints have to see to the others.
    pub(super) fn among(problem: &'a Problem, pairs: Vec<usize>, stop: Stop<'a>) -> Self {
        Self {
            problem,
            pairs,
            net: Net::new(vec![0; problem.len()]),
            stop,
            best: None,
            limit: i128::MAX,
            open: i128::MAX,
            nodes: 0,
            stopped: false,
        }
    }

    /// The delays that cost least, and less than a limit, under constraints.
    pub(super) fn run(mut self, constraints: impl IntoIterator<Item = Constraint>, limit: i128) -> Found {
        self.limit = limit;
        if constraints.into_iter().all(|constraint| self.net.impose(constraint)) && self.force() {
            self.tree();
        }
        let open = self.open;
        self.found(open)
    }

    /// What was found, where nothing that is open costs less than this.
    pub(super) fn found(self, open: i128) -> Found {
        let Self { best, limit, stopped, nodes, .. } = self;
        Found { delays: best, bound: open.min(limit), complete: !stopped, nodes }
    }

    /// The least delays that keep to what is forced upon all plans, if there are any.
    pub(super) fn root(mut self) -> Option<Vec<i64>> {
        self.force().then_some(self.net.least)
    }

    pub(super) fn force(&mut self) -> bool {
        let (problem, net) = (self.problem, &mut self.net);
        let forced = self.pairs.iter().flat_map(|&pair| problem.pairs[pair].forced());
        forced.into_iter().all(|constraint| net.impose(constraint))
    }

    /// Node after node, depth first; without recursion, which would take a stack as deep as the tree.
    fn tree(&mut self) {
        // Where a node was branched, and the second of its sides.
        let mut later: Vec<(usize, Constraint)> = Vec::new();
        loop {
            let mut next = self.node();
            if let Some([first, second]) = next {
                later.push((self.net.mark(), second));
                next = self.takes(first).then_some([first, second]);
            }
            while next.is_none() {
                let Some((mark, second)) = later.pop() else { return };
                self.net.take_back(mark);
                next = self.takes(second).then_some([second; 2]);
            }
        }
    }

    /// Adds a constraint; whether what is left is of interest.
    pub(super) fn takes(&mut self, side: Constraint) -> bool {
        self.net.impose(side) && self.problem.cost(&self.net.least) < self.limit
    }

    /// Whether the search ends here, at one node more.
    pub(super) fn is_over(&mut self) -> bool {
        self.nodes += 1;
        let look = self.nodes.is_multiple_of(TICK) || self.pairs.len() > LONG;
        self.stopped |= self.nodes > self.stop.nodes || (look && (self.stop.clock)());
        self.stopped
    }

    /// What all plans cost at least that keep the constraints.
    pub(super) fn bound(&self) -> i128 {
        self.problem.cost(&self.net.least) + self.surplus(&self.violated())
    }

    /// Looks at a node: the sides to branch upon, the more promising one first.
    fn node(&mut self) -> Option<[Constraint; 2]> {
        if self.is_over() {
            self.open = self.open.min(self.bound());
            return None;
        }
        loop {
            match self.step() {
                Step::End => return None,
                Step::Only(side) if !self.takes(side) => return None,
                Step::Only(_) => {}
                Step::Both(sides) => return Some(sides),
            }
        }
    }

    pub(super) fn step(&mut self) -> Step {
        let cost = self.problem.cost(&self.net.least);
        if cost >= self.limit {
            return Step::End;
        }
        let violated = self.violated();
        if violated.is_empty() {
            self.limit = cost;
            self.best = Some(self.net.least.clone());
            return Step::End;
        }
        if self.limit < i128::MAX && cost + self.surplus(&violated) >= self.limit {
            return Step::End;
        }
        // The pair whose cheaper side costs most: its bounds are of most use.
        let mut chosen = None;
        for pair in violated.iter().take(TRIED) {
            let [below, above] = pair.sides;
            match (self.tried(below), self.tried(above)) {
                (None, None) => return Step::End,
                (None, Some(_)) => return Step::Only(above),
                (Some(_), None) => return Step::Only(below),
                (Some(low), Some(high)) => {
                    let key = (low.min(high), low.max(high));
                    if chosen.as_ref().is_none_or(|(best, _)| key > *best) {
                        chosen = Some((key, if low <= high { [below, above] } else { [above, below] }));
                    }
                }
            }
        }
        chosen.map_or(Step::End, |(_, sides)| Step::Both(sides))
    }

    /// The bound with one more constraint, if that is below the limit.
    fn tried(&mut self, side: Constraint) -> Option<i128> {
        let mark = self.net.mark();
        let cost = self.net.impose(side).then(|| self.problem.cost(&self.net.least));
        self.net.take_back(mark);
        cost.filter(|&cost| cost < self.limit)
    }

    /// The violated pairs, those first that cost most.
    fn violated(&self) -> Vec<Violated> {
        let pair = |&place: &usize| {
            let pair = &self.problem.pairs[place];
            let ends = pair.violated(&self.net.least)?;
            let difference = pair.difference(&self.net.least);
            let raises = [difference - ends[0], ends[1] - difference];
            Some(Violated { agents: pair.agents, raises, sides: pair.beside(ends) })
        };
        let mut violated: Vec<Violated> = self.pairs.iter().filter_map(pair).collect();
        violated.sort_by_key(|pair| std::cmp::Reverse(pair.least()));
        violated
    }

    /// What violated pairs add to the sum at least: cliques of them that have no agent in common.
    fn surplus(&self, violated: &[Violated]) -> i128 {
        if self.problem.objective != Objective::Sum {
            return 0;
        }
        // Those of whom one has to wait, in order: others are in no clique.
        let mut waiting: Vec<usize> = violated.iter().flat_map(|pair| pair.agents).collect();
        waiting.sort_unstable();
        waiting.dedup();
        let count = waiting.len();
        if count > MOST_WAITING {
            return 0;
        }
        let place = |agent: usize| waiting.partition_point(|&other| other < agent);
        let places: Vec<[usize; 2]> = violated.iter().map(|pair| pair.agents.map(place)).collect();
        // By how much more the column is delayed if it comes after the row.
        let mut raises = vec![None; count * count];
        for (&[i, j], pair) in places.iter().zip(violated) {
            (raises[j * count + i], raises[i * count + j]) = (Some(pair.raises[0]), Some(pair.raises[1]));
        }
        let mut used = vec![false; count];
        let mut sum = 0;
        for agents in &places {
            if agents.iter().any(|&agent| used[agent]) {
                continue;
            }
            let mut clique = agents.to_vec();
            let meets =
                |agent: usize, clique: &[usize]| clique.iter().all(|&other| raises[agent * count + other].is_some());
            for (agent, used) in used.iter().enumerate() {
                if !used && meets(agent, &clique) {
                    clique.push(agent);
                }
            }
            clique.iter().for_each(|&agent| used[agent] = true);
            sum += in_sequence(&clique, |after, agent| raises[after * count + agent].unwrap_or(0));
        }
        sum
    }
}

/// Lower bound of the sum of delays of agents that go one after the other, in any order. Each starts later than the one before it by at
/// least its least gap to any other agent. The sum is least if the gaps are in increasing order and the first agent, without a gap, has
/// delay 0.
fn in_sequence(clique: &[usize], raise: impl Fn(usize, usize) -> i64) -> i128 {
    let least = |&agent: &usize| {
        let others = clique.iter().filter(|&&other| other != agent);
        others.map(|&other| raise(other, agent)).min().unwrap_or(0)
    };
    let mut least: Vec<i64> = clique.iter().map(least).collect();
    least.sort_unstable();
    // The first agent has no gap before it. Which agent is first is not known, so the largest gap is left out.
    least.pop();
    (1..).zip(least.iter().rev()).map(|(later, &raise)| later * i128::from(raise)).sum()
}
