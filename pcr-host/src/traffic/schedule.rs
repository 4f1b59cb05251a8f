//! Start delays for as many agents as can have one.
//!
//! What a region forbids depends on the difference of two delays only: T_other(s) + τ_other = T_ego(l) + τ_ego. The intervals
//! are computed once for all pairs; then a schedule for any order of priority is a comparison of numbers, so that many
//! orders can be tried.
//!
//! Agents that cannot start because of others go first in the next order that is tried.

use crate::fleet::HostEcm;
use crate::random::Random;
use pcr_core::{Motion, Scalar};

/// Orders from which the search sets out at random, beside that of the fleet and the longest motion first.
const RANDOM: usize = 8;

/// Orders that follow from each of them.
const ROUNDS: usize = 200;

/// An end of an interval of delays that stands for infinity \[s\].
const NEVER: f64 = <f64 as Scalar>::LIMIT;

/// For each agent and each other one the differences of their delays, own less other, at which they meet \[s\].
pub(super) struct Forbidden(Vec<Vec<Vec<[f64; 2]>>>);

/// Why an agent cannot start: because of another one, with any delay of either or with late ones only.
struct Blocked {
    by: usize,
    always: bool,
}

/// An agent without a delay, and because of whom.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Out {
    pub(super) agent: usize,
    pub(super) by: usize,
    /// Whether they meet whenever they start.
    pub(super) always: bool,
}

/// Delays of some agents, and why the others have none.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Schedule {
    /// By the place of the agent \[s\].
    pub(super) delays: Vec<Option<f64>>,
    pub(super) out: Vec<Out>,
    /// The order of priority.
    order: Vec<usize>,
}

impl Forbidden {
    pub(super) fn of(ecm: &HostEcm<f64>, motions: &[Motion<'_, f64>]) -> Self {
        let mut forbidden = vec![vec![Vec::new(); motions.len()]; motions.len()];
        let regions = (0..motions.len()).flat_map(|agent| ecm.row(motions, agent).map(move |region| (agent, region)));
        // The other direction of a pair is the same, with the sign turned round.
        for (agent, region) in regions.filter(|(agent, region)| region.other() > *agent) {
            let delays = region.forbidden_delays();
            forbidden[agent][region.other()].push([delays.lo, delays.hi]);
            forbidden[region.other()][agent].push([-delays.hi, -delays.lo]);
        }
        Self(forbidden)
    }

    /// The schedule of the most agents, and of those the one with the least sum of delays, of all orders that are tried.
    pub(super) fn schedule(&self, longest_first: Vec<usize>, seed: u64) -> Schedule {
        let file: Vec<usize> = (0..self.0.len()).collect();
        let mut orders = Random(seed);
        let random: Vec<_> = (0..RANDOM).map(|_| orders.shuffled(&file)).collect();
        let tried = [file, longest_first].into_iter().chain(random).flat_map(|order| {
            let first = self.in_order(order);
            std::iter::successors(Some(first), |before| self.again(before)).take(ROUNDS)
        });
        let waits = |schedule: &Schedule| schedule.delays.iter().flatten().sum::<f64>();
        let better = |a: &Schedule, b: &Schedule| a.out.len().cmp(&b.out.len()).then(waits(a).total_cmp(&waits(b)));
        tried.min_by(better).unwrap_or_default()
    }

    /// The schedule of the order in which those come first that had no delay.
    fn again(&self, before: &Schedule) -> Option<Schedule> {
        let (mut order, mut late): (Vec<usize>, Vec<usize>) =
            before.order.iter().partition(|&&agent| before.delays[agent].is_none());
        order.append(&mut late);
        (!before.out.is_empty()).then(|| self.in_order(order))
    }

    /// One agent after the other, each as early as those before it allow; one that cannot start is left out.
    fn in_order(&self, order: Vec<usize>) -> Schedule {
        let mut schedule = Schedule { delays: vec![None; order.len()], out: Vec::new(), order: Vec::new() };
        let mut before = Vec::new();
        for &agent in &order {
            match self.earliest(&schedule.delays, &before, agent) {
                Ok(delay) => {
                    schedule.delays[agent] = Some(delay);
                    before.push(agent);
                }
                Err(Blocked { by, always }) => schedule.out.push(Out { agent, by, always }),
            }
        }
        Schedule { order, ..schedule }
    }

    /// The least delay of an agent that those before it allow.
    fn earliest(&self, delays: &[Option<f64>], before: &[usize], agent: usize) -> Result<f64, Blocked> {
        let intervals = before.iter().flat_map(|&other| {
            let delay = delays[other].unwrap_or(0.0);
            self.0[agent][other]
                .iter()
                .map(move |&ends| ends.map(|end| if end.abs() < NEVER { end + delay } else { end }))
        });
        let mut intervals: Vec<[f64; 2]> = intervals.collect();
        intervals.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let mut delay = 0.0;
        for [lo, hi] in intervals {
            if lo <= delay && delay < hi {
                delay = hi;
            }
        }
        if delay < NEVER {
            return Ok(delay);
        }
        let always = |other: usize| self.0[agent][other].iter().any(|&[lo, hi]| lo <= -NEVER && hi >= NEVER);
        let worst = before.iter().copied().find(|&other| always(other));
        let first = before.iter().copied().find(|&other| self.0[agent][other].iter().any(|&[_, hi]| hi >= NEVER));
        Err(Blocked { by: worst.or(first).unwrap_or(agent), always: worst.is_some() })
    }
}
