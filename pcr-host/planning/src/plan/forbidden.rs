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
//! `plan_delays` of pcr-core, which `pcr plan` uses where there are no footprints, needs no heap: it finds delays by contacts, anew for
//! every order, each motion with its own. It serves neither discs that are delayed together nor `pcr traffic`, which tries thousands of
//! orders. What a region forbids is the core's in both (`RegionRef::forbidden_delays`).

use super::grown;
use crate::bodies::Bodies;
use crate::regions::{self, Failure};
use pcr_core::Scalar;
use pcr_formats::scenario::{Agent, Scenario};

/// An end of an interval of delays that stands for infinity \[s\].
const NEVER: f64 = <f64 as Scalar>::LIMIT;

/// For each agent and each other one the differences of their delays, own less other, at which they meet \[s\].
pub(crate) struct Forbidden {
    intervals: Vec<Vec<Vec<[f64; 2]>>>,
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
    pub(crate) fn of(scenario: &Scenario) -> Result<Self, Failure> {
        let bodies = Bodies::<f64>::new(&without_loads(scenario))?;
        let motions = grown(&bodies.fleet);
        let ecm = regions::table(&bodies.scenario, &motions)?;
        let owner = |disc: usize| bodies.discs.get(disc).map(|disc| disc.agent);
        let count = scenario.agents.len();
        let mut intervals = vec![vec![Vec::new(); count]; count];
        let regions = (0..motions.len()).flat_map(|disc| {
            ecm.row(&motions, disc).expect("the table of the fleet").map(move |region| (disc, region))
        });
        // The other direction of a pair is the same, with the sign turned round.
        for (disc, region) in regions.filter(|(disc, region)| region.other() > *disc) {
            let (Some(agent), Some(other)) = (owner(disc), owner(region.other())) else { continue };
            if agent != other {
                let delays = region.forbidden_delays();
                intervals[agent][other].push([delays.lo, delays.hi]);
                intervals[other][agent].push([-delays.hi, -delays.lo]);
            }
        }
        let goes_first = |agent: usize, other: usize| {
            let mut intervals = intervals[agent][other].iter();
            intervals.any(|&[lo, hi]: &[f64; 2]| lo <= -NEVER && hi < NEVER)
        };
        let first = (0..count).map(|agent| (0..count).filter(|&other| goes_first(agent, other)).collect()).collect();
        Ok(Self { intervals, first })
    }

    /// Number of agents.
    pub(crate) fn len(&self) -> usize {
        self.intervals.len()
    }

    /// The order, but for agents that have to start before others.
    pub(crate) fn respecting(&self, mut order: Vec<usize>) -> Vec<usize> {
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
    pub(crate) fn in_order(&self, order: Vec<usize>) -> Schedule {
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
            self.intervals[agent][other]
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
