//! Start delays as difference constraints on whole numbers of ticks.
//!
//! The constraint of a pair depends on the difference of its two delays. Ends of intervals are rounded outward to
//! ticks, which are a power of two of a second, and moved outward by one more tick for the rounding of a start time in
//! a file. Then sums are exact, and delays that satisfy all constraints in ticks satisfy them in the numbers that are
//! written.

/// An end of an interval that stands for infinity \[ticks\].
pub(crate) const NEVER: i64 = i64::MAX / 4;

/// Largest number of binary digits of a tick after the point.
const FINEST: i32 = 30;
/// Largest number of binary digits of a time in ticks: one less than `f64` holds.
const DIGITS: i32 = 52;
/// Bound on the outward rounding of each end \[ticks\].
const OUTWARD: i128 = 2;

/// The length of a tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct TickScale {
    per_second: f64,
}

impl TickScale {
    /// The finest ticks for times up to a latest one \[s\].
    pub(crate) fn up_to(latest: f64) -> Self {
        let digits = latest.max(1.0).log2().ceil() as i32 + 1;
        Self { per_second: f64::exp2(f64::from(FINEST.min(DIGITS - digits))) }
    }

    /// A forbidden interval in ticks, rounded outward; values of `limit` or more stand for infinity \[s\].
    pub(crate) fn outward(self, [lo, hi]: [f64; 2], limit: f64) -> [i64; 2] {
        let below = if lo <= -limit { -NEVER } else { (lo * self.per_second).floor() as i64 - 1 };
        [below, if hi >= limit { NEVER } else { (hi * self.per_second).ceil() as i64 + 1 }]
    }

    /// The nearest whole number of ticks.
    pub(crate) fn nearest(self, seconds: f64) -> i64 {
        (seconds * self.per_second).round() as i64
    }

    /// A time in seconds; exact if it has no more digits than `f64` holds.
    pub(crate) fn seconds(self, ticks: i128) -> f64 {
        ticks as f64 / self.per_second
    }
}

/// How much less a plan for intervals that are not rounded can cost, for a fleet \[ticks\]: no chain of constraints is
/// longer than the fleet, and each is longer by the rounding of one end.
pub(crate) fn rounding_cost(problem: &DelayProblem) -> i128 {
    let agents = problem.len() as i128;
    let chain = OUTWARD * agents;
    match problem.objective {
        Objective::Sum => chain * agents,
        Objective::Makespan => chain + 1,
    }
}

/// Forbidden differences of the delays of two agents: the second delay minus the first.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ForbiddenPairDelays {
    pub(crate) agents: [usize; 2],
    /// Open intervals, disjoint and in order \[ticks\].
    forbidden: Vec<[i64; 2]>,
}

impl ForbiddenPairDelays {
    /// A pair with intervals that may overlap.
    pub(crate) fn new(agents: [usize; 2], mut forbidden: Vec<[i64; 2]>) -> Self {
        forbidden.sort_unstable();
        let mut disjoint: Vec<[i64; 2]> = Vec::with_capacity(forbidden.len());
        for [lo, hi] in forbidden {
            match disjoint.last_mut() {
                Some(last) if lo < last[1] => last[1] = last[1].max(hi),
                _ => disjoint.push([lo, hi]),
            }
        }
        Self { agents, forbidden: disjoint }
    }

    /// The forbidden intervals: open, disjoint and in order \[ticks\].
    pub(super) fn intervals(&self) -> &[[i64; 2]] {
        &self.forbidden
    }

    /// The interval that holds the difference of two delays, if one does.
    pub(super) fn violated(&self, delays: &[i64]) -> Option<[i64; 2]> {
        let difference = self.difference(delays);
        self.forbidden.iter().copied().find(|&[lo, hi]| lo < difference && difference < hi)
    }

    pub(super) fn difference(&self, delays: &[i64]) -> i64 {
        let [first, second] = self.agents;
        delays[second] - delays[first]
    }

    /// Forbidden delays of one of the two while the other has this delay \[ticks\].
    pub(super) fn forbidden_to(&self, agent: usize, other: i64) -> impl Iterator<Item = [i64; 2]> {
        let shifted = move |end: i64| if end.abs() < NEVER { end + other } else { end };
        let second = self.agents[1] == agent;
        self.forbidden.iter().map(move |&[lo, hi]| if second { [lo, hi] } else { [-hi, -lo] }.map(shifted))
    }

    /// Whether no difference is allowed.
    pub(crate) fn is_impossible(&self) -> bool {
        self.forbidden.iter().any(|&[lo, hi]| lo <= -NEVER && hi >= NEVER)
    }

    /// The constraints on either side of an interval: the difference is below it, or above it.
    pub(super) fn constraints_around(&self, [lo, hi]: [i64; 2]) -> [DifferenceConstraint; 2] {
        let [first, second] = self.agents;
        [
            DifferenceConstraint { from: second, to: first, least: if lo <= -NEVER { NEVER } else { -lo } },
            DifferenceConstraint { from: first, to: second, least: hi },
        ]
    }

    /// Constraints that hold for all allowed differences: an unbounded interval leaves one side.
    pub(super) fn forced(&self) -> impl Iterator<Item = DifferenceConstraint> {
        let sided = |&ends: &[i64; 2]| {
            let [below, above] = self.constraints_around(ends);
            (ends[0] <= -NEVER).then_some(above).into_iter().chain((ends[1] >= NEVER).then_some(below))
        };
        self.forbidden.iter().flat_map(sided)
    }

    /// The constraints of the gap between intervals where the difference of these delays is.
    pub(super) fn gap(&self, delays: &[i64]) -> impl Iterator<Item = DifferenceConstraint> + use<> {
        let difference = self.difference(delays);
        let last =
            self.forbidden.iter().rfind(|ends| ends[1] <= difference).map(|&ends| self.constraints_around(ends)[1]);
        let next =
            self.forbidden.iter().find(|ends| difference <= ends[0]).map(|&ends| self.constraints_around(ends)[0]);
        last.into_iter().chain(next)
    }
}

/// The least delay from 0 on that is inside none of some open intervals; none if there is no end to them \[ticks\].
pub(crate) fn earliest(mut forbidden: Vec<[i64; 2]>) -> Option<i64> {
    forbidden.sort_unstable();
    let mut delay = 0;
    for [lo, hi] in forbidden {
        if lo < delay && delay < hi {
            delay = hi;
        }
    }
    (delay < NEVER).then_some(delay)
}

/// The delay of `to` is at least that of `from` plus `least` \[ticks\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct DifferenceConstraint {
    pub(super) from: usize,
    pub(super) to: usize,
    pub(super) least: i64,
}

/// The objective to be minimized.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Objective {
    /// The sum over the agents from their start in the file to their arrival.
    #[default]
    Sum,
    /// The last arrival.
    Makespan,
}

impl Objective {
    /// Its name in the output.
    pub fn name(self) -> &'static str {
        match self {
            Self::Sum => "sum_of_costs",
            Self::Makespan => "makespan",
        }
    }
}

/// Delays to be found.
#[derive(Clone, Debug)]
pub(crate) struct DelayProblem {
    pub(crate) objective: Objective,
    /// When each agent arrives without a delay \[ticks\].
    pub(crate) ends: Vec<i64>,
    pub(crate) pairs: Vec<ForbiddenPairDelays>,
}

impl DelayProblem {
    /// Number of agents.
    pub(crate) fn len(&self) -> usize {
        self.ends.len()
    }

    /// Sum of the delays, or the last arrival \[ticks\].
    pub(crate) fn cost(&self, delays: &[i64]) -> i128 {
        match self.objective {
            Objective::Sum => delays.iter().map(|&delay| i128::from(delay)).sum(),
            Objective::Makespan => {
                let ends = delays.iter().zip(&self.ends).map(|(delay, end)| i128::from(*delay) + i128::from(*end));
                ends.max().unwrap_or(0)
            }
        }
    }

    /// Whether delays keep all that is forbidden.
    pub(crate) fn allows(&self, delays: &[i64]) -> bool {
        delays.iter().all(|&delay| delay >= 0) && self.pairs.iter().all(|pair| pair.violated(delays).is_none())
    }

    /// The same for some of the agents, in this order.
    pub(crate) fn of(&self, agents: &[usize]) -> Self {
        let mut places = vec![None; self.len()];
        agents.iter().enumerate().for_each(|(place, &agent)| places[agent] = Some(place));
        let pair = |pair: &ForbiddenPairDelays| {
            let [Some(first), Some(second)] = pair.agents.map(|agent| places[agent]) else { return None };
            Some(ForbiddenPairDelays { agents: [first, second], forbidden: pair.forbidden.clone() })
        };
        let pairs = self.pairs.iter().filter_map(pair).collect();
        Self { objective: self.objective, ends: agents.iter().map(|&agent| self.ends[agent]).collect(), pairs }
    }

    /// The agents in groups that forbid one another nothing, each group in order. O(agents + pairs), nearly.
    pub(crate) fn parts(&self) -> Vec<Vec<usize>> {
        let mut above: Vec<usize> = (0..self.len()).collect();
        for pair in &self.pairs {
            let [a, b] = pair.agents.map(|agent| first(&mut above, agent));
            above[a.max(b)] = a.min(b);
        }
        let mut parts = vec![Vec::new(); self.len()];
        (0..self.len()).for_each(|agent| parts[first(&mut above, agent)].push(agent));
        parts.retain(|part| !part.is_empty());
        parts
    }

    /// These groups, each with its own problem. O(agents + pairs), nearly.
    pub(super) fn independent_problems(&self) -> Vec<(Vec<usize>, Self)> {
        let parts = self.parts();
        let mut places = vec![[0; 2]; self.len()];
        for (name, agents) in parts.iter().enumerate() {
            agents.iter().enumerate().for_each(|(place, &agent)| places[agent] = [name, place]);
        }
        let part = |agents: Vec<usize>| {
            let ends = agents.iter().map(|&agent| self.ends[agent]).collect();
            (agents, Self { objective: self.objective, ends, pairs: Vec::new() })
        };
        let mut apart: Vec<(Vec<usize>, Self)> = parts.into_iter().map(part).collect();
        for pair in &self.pairs {
            let [[name, first], [_, second]] = pair.agents.map(|agent| places[agent]);
            apart[name]
                .1
                .pairs
                .push(ForbiddenPairDelays { agents: [first, second], forbidden: pair.forbidden.clone() });
        }
        apart
    }
}

/// The first of a group of agents, each of which is below another one of its group or itself.
pub(super) fn first(above: &mut [usize], mut agent: usize) -> usize {
    while above[agent] != agent {
        above[agent] = above[above[agent]];
        agent = above[agent];
    }
    agent
}
