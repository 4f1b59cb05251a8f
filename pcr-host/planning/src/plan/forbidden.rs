//! Start delays by what every pair of agents forbids.
//!
//! What a region forbids depends on the difference of two delays only: T_other(s) + τ_other = T_ego(l) + τ_ego. The intervals
//! are computed once for all pairs; then a schedule for any order of priority is a comparison of numbers. The discs of a
//! footprint are delayed together, so that what two agents forbid is what any two of their discs do. With loads, which are there on some
//! segments only, the disc around all outlines is taken.
//!
//! An interval without a lower end says that the other one goes first, one without an upper end that it goes last. Where no circle of
//! agents has to go before one another, an order that keeps to this has a schedule for all of them: each waits until those
//! before it are out of its way, at the latest until they have arrived.
//!
//! `plan_delays` of pcr-core needs no heap: it finds delays by contacts, anew for every order, each motion with its own. It serves
//! neither discs that are delayed together nor searches over thousands of orders. What a region forbids is the core's in both
//! (`RegionRef::forbidden_delays`).

use super::delays::{NEVER, Objective, Pair, Problem, Ticks, earliest};
use super::grown;
use crate::bodies::Bodies;
use crate::fleet::{HostEcm, build_ecm};
use crate::regions::{self, Failure};
use pcr_core::{Motion, Scalar};
use pcr_formats::scenario::{Agent, Scenario};

/// For each agent and each other one the differences of their delays, own less other, at which they meet.
#[derive(Clone, Debug)]
pub struct Forbidden {
    /// \[ticks\], outward.
    intervals: Vec<Vec<Vec<[i64; 2]>>>,
    ticks: Ticks,
    /// When each agent arrives without a delay \[s\].
    ends: Vec<f64>,
    /// For each agent those that have to start before it.
    first: Vec<Vec<usize>>,
}

/// Why an agent cannot start: because of another one, with any delay of either or with late ones only.
struct Blocked {
    by: usize,
    always: bool,
}

/// An agent without a delay, and because of whom.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Out {
    /// Place of the agent.
    pub agent: usize,
    /// Place of the other one.
    pub by: usize,
    /// Whether they meet whenever they start.
    pub always: bool,
}

/// Delays of some agents, and why the others have none.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Schedule {
    /// By the place of the agent \[s\].
    pub delays: Vec<Option<f64>>,
    /// Those without one.
    pub out: Vec<Out>,
    /// The order of priority.
    pub order: Vec<usize>,
}

impl Forbidden {
    /// What the agents of a scenario forbid one another.
    ///
    /// # Errors
    /// [`Failure`] where a value does not fit, or the table cannot hold the fleet.
    pub fn of(scenario: &Scenario) -> Result<Self, Failure> {
        let bodies = Bodies::<f64>::new(&without_loads(scenario))?;
        let motions = grown(&bodies.fleet);
        let ecm = regions::table(&bodies.scenario, &motions)?;
        let owners: Vec<usize> = bodies.discs.iter().map(|disc| disc.agent).collect();
        Ok(Self::between(&motions, &ecm, &owners, scenario.agents.len()))
    }

    /// What some motions forbid one another, each with its own delay.
    ///
    /// # Errors
    /// [`Failure`] where the table cannot hold them.
    pub fn of_motions(motions: &[Motion<'_, f64>]) -> Result<Self, Failure> {
        let ecm = build_ecm(motions).map_err(Failure::Full)?;
        let owners: Vec<usize> = (0..motions.len()).collect();
        Ok(Self::between(motions, &ecm, &owners, motions.len()))
    }

    /// The discs of so many agents, and whose they are.
    fn between(motions: &[Motion<'_, f64>], ecm: &HostEcm<f64>, owners: &[usize], count: usize) -> Self {
        let mut found = Vec::new();
        let regions = (0..motions.len())
            .flat_map(|disc| ecm.row(motions, disc).expect("the table of the fleet").map(move |region| (disc, region)));
        // The other direction of a pair is the same, with the sign turned round.
        for (disc, region) in regions.filter(|(disc, region)| region.other() > *disc) {
            let (Some(&agent), Some(&other)) = (owners.get(disc), owners.get(region.other())) else { continue };
            if agent != other {
                let delays = region.forbidden_delays();
                found.push(([agent, other], [delays.lo, delays.hi]));
            }
        }
        let limit = <f64 as Scalar>::LIMIT;
        let mut ends = vec![f64::NEG_INFINITY; count];
        for (disc, motion) in motions.iter().enumerate() {
            if let Some(end) = owners.get(disc).and_then(|&agent| ends.get_mut(agent)) {
                *end = end.max(motion.time().hi);
            }
        }
        // No chain of waits is longer than all agents and the longest wait.
        let waits = found.iter().flat_map(|(_, delays)| delays).map(|end| end.abs()).filter(|end| *end < limit);
        let times = motions.iter().flat_map(|motion| [motion.time().lo, motion.time().hi]).map(f64::abs);
        let ticks = Ticks::up_to(times.fold(0.0, f64::max) + count as f64 * waits.fold(0.0, f64::max));
        let mut intervals = vec![vec![Vec::new(); count]; count];
        for ([agent, other], delays) in found {
            let [lo, hi] = ticks.outward(delays, limit);
            intervals[agent][other].push([lo, hi]);
            intervals[other][agent].push([-hi, -lo]);
        }
        let goes_first = |agent: usize, other: usize| {
            let mut intervals = intervals[agent][other].iter();
            intervals.any(|&[lo, hi]: &[i64; 2]| lo <= -NEVER && hi < NEVER)
        };
        let first = (0..count).map(|agent| (0..count).filter(|&other| goes_first(agent, other)).collect()).collect();
        Self { intervals, ticks, ends, first }
    }

    /// What the delay of an agent less that of another one must not be, by their places: open intervals in no order, which may overlap
    /// \[s\]; without an end on a side where it is infinite. None for agents that are not there.
    pub fn intervals(&self, agent: usize, other: usize) -> impl Iterator<Item = [f64; 2]> {
        let intervals = self.intervals.get(agent).and_then(|row| row.get(other)).into_iter().flatten();
        let seconds = |end: i64| match end {
            end if end <= -NEVER => f64::NEG_INFINITY,
            end if end >= NEVER => f64::INFINITY,
            end => self.ticks.seconds(end.into()),
        };
        intervals.map(move |ends| ends.map(seconds))
    }

    /// The delays to be found for all agents.
    pub(crate) fn problem(&self, objective: Objective) -> Problem {
        let pair = |i: usize, j: usize| {
            let intervals = &self.intervals[j][i];
            (!intervals.is_empty()).then(|| Pair::new([i, j], intervals.clone()))
        };
        let pairs = (0..self.len()).flat_map(|i| (i + 1..self.len()).filter_map(move |j| pair(i, j))).collect();
        Problem { objective, ends: self.ends.iter().map(|&end| self.ticks.nearest(end)).collect(), pairs }
    }

    /// What its times are measured in.
    pub(crate) fn ticks(&self) -> Ticks {
        self.ticks
    }

    /// Number of agents.
    pub fn len(&self) -> usize {
        self.intervals.len()
    }

    /// Whether there are no agents.
    pub fn is_empty(&self) -> bool {
        self.intervals.is_empty()
    }

    /// The order, but for agents that have to start before others.
    pub fn respecting(&self, mut order: Vec<usize>) -> Vec<usize> {
        let mut placed = vec![false; self.len()];
        let mut respecting = Vec::with_capacity(order.len());
        while !order.is_empty() {
            let is_next = |agent: &usize| self.first[*agent].iter().all(|&other| placed[other]);
            // In a circle any of them is as good.
            let agent = order.remove(order.iter().position(is_next).unwrap_or(0));
            placed[agent] = true;
            respecting.push(agent);
        }
        respecting
    }

    /// One agent after the other, each as early as those before it allow; one that cannot start is left out.
    pub fn in_order(&self, order: Vec<usize>) -> Schedule {
        let mut delays = vec![None; self.len()];
        let mut out = Vec::new();
        let mut before = Vec::new();
        for &agent in &order {
            match self.earliest(&delays, &before, agent) {
                Ok(delay) => {
                    delays[agent] = Some(delay);
                    before.push(agent);
                }
                Err(Blocked { by, always }) => out.push(Out { agent, by, always }),
            }
        }
        let seconds = |delay: Option<i64>| delay.map(|delay| self.ticks.seconds(i128::from(delay)));
        Schedule { delays: delays.into_iter().map(seconds).collect(), out, order }
    }

    /// The least delay of an agent that those before it allow.
    fn earliest(&self, delays: &[Option<i64>], before: &[usize], agent: usize) -> Result<i64, Blocked> {
        let intervals = before.iter().flat_map(|&other| {
            let delay = delays[other].unwrap_or(0);
            self.intervals[agent][other]
                .iter()
                .map(move |&ends| ends.map(|end| if end.abs() < NEVER { end + delay } else { end }))
        });
        if let Some(delay) = earliest(intervals.collect()) {
            return Ok(delay);
        }
        let intervals = |other: usize| self.intervals[agent][other].iter();
        let always = |other: usize| intervals(other).any(|&[lo, hi]| lo <= -NEVER && hi >= NEVER);
        let worst = before.iter().copied().find(|&other| always(other));
        let first = before.iter().copied().find(|&other| intervals(other).any(|&[_, hi]| hi >= NEVER));
        Err(Blocked { by: worst.or(first).unwrap_or(agent), always: worst.is_some() })
    }
}

/// The scenario, each agent that has loads as the disc around all its outlines.
fn without_loads(scenario: &Scenario) -> Scenario {
    let agents = scenario.agents.iter().map(|agent| match agent.loads.is_empty() {
        true => agent.clone(),
        false => Agent { radius: agent.reach(), footprint: None, loads: Vec::new(), ..agent.clone() },
    });
    Scenario::new(scenario.name.clone(), agents.collect())
}
