//! Delays of least cost, by branch and bound over the sides of forbidden intervals.
//!
//! A node of the search tree has constraints for the sides that were chosen. The least delays that satisfy them have
//! the least cost for either objective, which is the lower bound of the node. If they violate no pair, they are its
//! best solution. Otherwise the search branches on a violated pair: its difference is below the interval, or above it.
//! No solution is lost by that, and every branch adds one of finitely many constraints. `docs/theory/queries.md` has the
//! proofs.

use super::difference_network::DifferenceNetwork;
use super::problem::{DelayProblem, DifferenceConstraint, Objective};

/// Violated pairs of which both sides are tried before one is chosen, at most.
const TRIED: usize = 16;
/// Agents that have to wait, or let wait, up to which cliques of them are looked for: a bound that takes their square.
const MOST_WAITING: usize = 2_000;
/// Nodes after which the clock is looked at, where each of them looks at fewer pairs than this.
const TICK: u64 = 32;
const LONG: usize = 2_000;

/// Returns how often a search of this many nodes looks at the clock.
pub(super) fn steps(problem: &DelayProblem, nodes: u64) -> u64 {
    if problem.pairs.len() > LONG { nodes } else { nodes / TICK }
}

/// Limits of a search, which answers with the best result so far.
#[derive(Clone, Copy)]
pub(crate) struct SearchLimits<'a> {
    /// Largest number of nodes.
    pub(crate) nodes: u64,
    /// Stops the search when it returns true.
    pub(crate) clock: &'a dyn Fn() -> bool,
}

/// The result of a search.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct DelaySearchResult {
    /// The best delays that cost less than the limit.
    pub(super) delays: Option<Vec<i64>>,
    /// Lower bound of the cost of all delays, or the limit if that is less \[ticks\].
    pub(super) bound: i128,
    /// Whether the search was not stopped: then there is nothing better.
    pub(super) complete: bool,
    /// Nodes of the tree.
    pub(super) nodes: u64,
}

/// A pair whose difference of delays is in a forbidden interval.
struct ViolatedPair {
    agents: [usize; 2],
    /// Least increase of the delay of either agent that ends the violation.
    raises: [i64; 2],
    /// The two constraints that end the violation.
    sides: [DifferenceConstraint; 2],
}

impl ViolatedPair {
    fn least(&self) -> i64 {
        self.raises[0].min(self.raises[1])
    }
}

/// The next step at a node.
pub(super) enum BranchStep {
    /// Nothing is left.
    End,
    /// Only one side is possible.
    Only(DifferenceConstraint),
    /// Two sides, the cheaper first.
    Both([DifferenceConstraint; 2]),
}

pub(super) struct BranchAndBound<'a> {
    pub(super) problem: &'a DelayProblem,
    /// Places of the pairs that may be violated.
    pairs: Vec<usize>,
    pub(super) net: DifferenceNetwork,
    stop: SearchLimits<'a>,
    best: Option<Vec<i64>>,
    /// Only what costs less is of interest.
    pub(super) limit: i128,
    /// The least bound of the nodes that were not looked at.
    open: i128,
    nodes: u64,
    stopped: bool,
}

impl<'a> BranchAndBound<'a> {
    /// For all pairs.
    pub(super) fn new(problem: &'a DelayProblem, stop: SearchLimits<'a>) -> Self {
        Self::among(problem, (0..problem.pairs.len()).collect(), stop)
    }

    /// For some pairs; constraints have to see to the others.
    pub(super) fn among(problem: &'a DelayProblem, pairs: Vec<usize>, stop: SearchLimits<'a>) -> Self {
        Self {
            problem,
            pairs,
            net: DifferenceNetwork::new(vec![0; problem.len()]),
            stop,
            best: None,
            limit: i128::MAX,
            open: i128::MAX,
            nodes: 0,
            stopped: false,
        }
    }

    /// The delays that cost least, and less than a limit, under constraints.
    pub(super) fn run(
        mut self,
        constraints: impl IntoIterator<Item = DifferenceConstraint>,
        limit: i128,
    ) -> DelaySearchResult {
        self.limit = limit;
        if constraints.into_iter().all(|constraint| self.net.impose(constraint)) && self.force() {
            self.tree();
        }
        let open = self.open;
        self.found(open)
    }

    /// The result, if all open nodes cost at least `open`.
    pub(super) fn found(self, open: i128) -> DelaySearchResult {
        let Self { best, limit, stopped, nodes, .. } = self;
        DelaySearchResult { delays: best, bound: open.min(limit), complete: !stopped, nodes }
    }

    /// The least delays that satisfy all forced constraints, if there are any.
    pub(super) fn root(mut self) -> Option<Vec<i64>> {
        self.force().then_some(self.net.least)
    }

    pub(super) fn force(&mut self) -> bool {
        let (problem, net) = (self.problem, &mut self.net);
        let forced = self.pairs.iter().flat_map(|&pair| problem.pairs[pair].forced());
        forced.into_iter().all(|constraint| net.impose(constraint))
    }

    /// Visits nodes depth first; without recursion, because the stack would be as deep as the tree.
    fn tree(&mut self) {
        // Marks of the nodes with a second side to try, and that side.
        let mut later: Vec<(usize, DifferenceConstraint)> = Vec::new();
        loop {
            let mut next = self.node();
            if let Some([first, second]) = next {
                later.push((self.net.mark(), second));
                next = self.takes(first).then_some([first, second]);
            }
            while next.is_none() {
                let Some((mark, second)) = later.pop() else { return };
                self.net.undo_to(mark);
                next = self.takes(second).then_some([second; 2]);
            }
        }
    }

    /// Adds a constraint; returns whether the remaining problem can have a better result.
    pub(super) fn takes(&mut self, side: DifferenceConstraint) -> bool {
        self.net.impose(side) && self.problem.cost(&self.net.least) < self.limit
    }

    /// Counts a node; returns whether the search ends here.
    pub(super) fn is_over(&mut self) -> bool {
        self.nodes += 1;
        let look = self.nodes.is_multiple_of(TICK) || self.pairs.len() > LONG;
        self.stopped |= self.nodes > self.stop.nodes || (look && (self.stop.clock)());
        self.stopped
    }

    /// Lower bound of the cost of all plans that keep the constraints.
    pub(super) fn bound(&self) -> i128 {
        self.problem.cost(&self.net.least) + self.surplus(&self.violated())
    }

    /// Visits a node; returns the sides to branch on, the more promising one first.
    fn node(&mut self) -> Option<[DifferenceConstraint; 2]> {
        if self.is_over() {
            self.open = self.open.min(self.bound());
            return None;
        }
        loop {
            match self.step() {
                BranchStep::End => return None,
                BranchStep::Only(side) if !self.takes(side) => return None,
                BranchStep::Only(_) => {}
                BranchStep::Both(sides) => return Some(sides),
            }
        }
    }

    pub(super) fn step(&mut self) -> BranchStep {
        let cost = self.problem.cost(&self.net.least);
        if cost >= self.limit {
            return BranchStep::End;
        }
        let violated = self.violated();
        if violated.is_empty() {
            self.limit = cost;
            self.best = Some(self.net.least.clone());
            return BranchStep::End;
        }
        if self.limit < i128::MAX && cost + self.surplus(&violated) >= self.limit {
            return BranchStep::End;
        }
        // The pair whose cheaper side costs most: its bounds are of most use.
        let mut chosen = None;
        for pair in violated.iter().take(TRIED) {
            let [below, above] = pair.sides;
            match (self.tried(below), self.tried(above)) {
                (None, None) => return BranchStep::End,
                (None, Some(_)) => return BranchStep::Only(above),
                (Some(_), None) => return BranchStep::Only(below),
                (Some(low), Some(high)) => {
                    let key = (low.min(high), low.max(high));
                    if chosen.as_ref().is_none_or(|(best, _)| key > *best) {
                        chosen = Some((key, if low <= high { [below, above] } else { [above, below] }));
                    }
                }
            }
        }
        chosen.map_or(BranchStep::End, |(_, sides)| BranchStep::Both(sides))
    }

    /// The bound with one more constraint, if that is below the limit.
    fn tried(&mut self, side: DifferenceConstraint) -> Option<i128> {
        let mark = self.net.mark();
        let cost = self.net.impose(side).then(|| self.problem.cost(&self.net.least));
        self.net.undo_to(mark);
        cost.filter(|&cost| cost < self.limit)
    }

    /// The violated pairs, those first that cost most.
    fn violated(&self) -> Vec<ViolatedPair> {
        let pair = |&place: &usize| {
            let pair = &self.problem.pairs[place];
            let ends = pair.violated(&self.net.least)?;
            let difference = pair.difference(&self.net.least);
            let raises = [difference - ends[0], ends[1] - difference];
            Some(ViolatedPair { agents: pair.agents, raises, sides: pair.constraints_around(ends) })
        };
        let mut violated: Vec<ViolatedPair> = self.pairs.iter().filter_map(pair).collect();
        violated.sort_by_key(|pair| std::cmp::Reverse(pair.least()));
        violated
    }

    /// Lower bound of the increase of the sum of costs due to violated pairs: from cliques of them without common agents.
    fn surplus(&self, violated: &[ViolatedPair]) -> i128 {
        if self.problem.objective != Objective::Sum {
            return 0;
        }
        // The agents in violated pairs, sorted; other agents are in no clique.
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
