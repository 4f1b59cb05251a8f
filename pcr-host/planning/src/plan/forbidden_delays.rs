//! Start delays from the forbidden delays of every pair of agents.
//!
//! The forbidden delays of a region depend only on the difference of two delays: T_other(s) + τ_other = T_ego(l) +
//! τ_ego. The intervals are computed once for all pairs; a schedule for any order of priority then only compares
//! numbers. The bodies of an agent are delayed together, so the forbidden delays of two agents are the union of those
//! of any two of their bodies. A body of a load is there on some segments only: before its first and after its last it meets nobody.
//!
//! An interval without a lower end means that the other agent goes first, one without an upper end that it goes last.
//! If no cycle of agents have to go before one another, an order that respects this has a schedule for all of them:
//! each agent waits until those before it are out of its way, at the latest until they have arrived.
//!
//! `plan_delays` of pcr-core needs no heap: it finds delays from contacts, again for every order, and delays each
//! motion by itself. So it supports neither bodies that are delayed together nor searches over thousands of orders. Both
//! take the forbidden delays of a region from the core (`RegionRef::forbidden_delays`).

use super::delays::{self, DelayProblem, ForbiddenPairDelays, NEVER, Objective, TickScale, earliest};
use super::{motions_with_margins, sides_of as sides};
use crate::agent_regions;
use crate::agent_regions::ProgressFn;
use crate::bodies::{Body, BodyFleet};
use crate::failure::ComputationError;
use crate::memory_budget::MemoryDemand;
use pcr_core::{Interval, Motion, RegionRef, Scalar};
use pcr_formats::scenario::Scenario;

/// Differences of two delays (own minus other) at which the two agents meet \[ticks\], rounded outward.
#[derive(Clone, Copy, Debug)]
struct ForbiddenInterval {
    other: usize,
    ends: [i64; 2],
}

/// The forbidden differences of delays of all pairs of agents that can meet.
#[derive(Clone, Debug)]
pub struct ForbiddenDelays {
    /// For each agent, sorted by the other agent.
    met: Vec<Vec<ForbiddenInterval>>,
    ticks: TickScale,
    /// Arrival of each agent without a delay \[s\].
    ends: Vec<f64>,
    /// For each agent the agents that have to start before it.
    first: Vec<Vec<usize>>,
}

/// The agent of a body, and whether the body is present before the start of that agent and after its arrival.
#[derive(Clone, Copy, Debug)]
struct BodyOwner {
    agent: usize,
    stands: [bool; 2],
}

impl BodyOwner {
    fn of(body: &Body) -> Self {
        Self { agent: body.agent, stands: body.stands() }
    }
}

/// The delays with which two bodies meet. `own` and `other` tell whether a body is there before its start and after its end.
fn met_with(region: &RegionRef<'_, f64>, own: [bool; 2], other: [bool; 2]) -> Interval<f64> {
    let delays = region.forbidden_delays();
    let [after, before] = sides(region, own, other);
    let (early, late) = (delays.lo <= -<f64 as Scalar>::LIMIT, delays.hi >= <f64 as Scalar>::LIMIT);
    if (after || !early) && (before || !late) {
        return delays;
    }
    // Forbidden delays are unbounded on a side where a body stands before its start or after its end. If the body is not there at that
    // time, that side ends where the delays end with which the two meet under way.
    let passing = region.passing_delays();
    Interval {
        lo: if early && !after { passing.lo } else { delays.lo },
        hi: if late && !before { passing.hi } else { delays.hi },
    }
}

/// Why an agent has no delay: the other agent, and whether they meet with every delay of either.
struct DelayBlocker {
    by: usize,
    always: bool,
}

/// An agent without a delay, and the other agent that prevents one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AgentWithoutDelay {
    /// Index of the agent.
    pub agent: usize,
    /// Index of the other agent.
    pub blocked_by: usize,
    /// Whether the two meet with all delays.
    pub always: bool,
}

/// Delays of some agents, and why the others have none.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DelaySchedule {
    /// Delays by the index of the agent \[s\].
    pub delays: Vec<Option<f64>>,
    /// The agents without a delay.
    pub out: Vec<AgentWithoutDelay>,
    /// The order of priority.
    pub order: Vec<usize>,
}

impl ForbiddenDelays {
    /// The forbidden delays of the agents of a scenario.
    ///
    /// # Errors
    /// [`ComputationError`] if a value does not fit, or the table cannot hold the fleet.
    pub fn compute(scenario: &Scenario) -> Result<Self, ComputationError> {
        Self::watched(scenario, &|_, _| {})
    }

    /// The same; tells of how many bodies the regions are known, and of how many there are.
    pub(super) fn watched(scenario: &Scenario, told: ProgressFn<'_>) -> Result<Self, ComputationError> {
        let bodies = BodyFleet::<f64>::new(scenario)?;
        let motions = motions_with_margins(&bodies.fleet);
        let owners: Vec<BodyOwner> = bodies.bodies.iter().map(BodyOwner::of).collect();
        Self::between(&motions, &owners, scenario.agents.len(), told).map_err(|failure| failure.named(&bodies.scenario))
    }

    /// The forbidden delays of some motions, each with its own delay.
    ///
    /// # Errors
    /// [`ComputationError`] if the table cannot hold them.
    pub(crate) fn of_motions(motions: &[Motion<'_, f64>]) -> Result<Self, ComputationError> {
        let owners: Vec<BodyOwner> = (0..motions.len()).map(|agent| BodyOwner { agent, stands: [true; 2] }).collect();
        Self::between(motions, &owners, motions.len(), &|_, _| {})
    }

    /// The forbidden delays of `count` agents with these bodies and owners.
    fn between(
        motions: &[Motion<'_, f64>],
        owners: &[BodyOwner],
        count: usize,
        told: ProgressFn<'_>,
    ) -> Result<Self, ComputationError> {
        // A row has the pairs of its body with later ones; the other direction of a pair has the opposite sign.
        let found = agent_regions::gathered(motions, "start delays that regions forbid", told, |row| {
            let bodies = row.agents();
            let owner = |place: usize| bodies.get(place).and_then(|&body| owners.get(body as usize)).copied();
            let regions = row.table().row(row.motions(), row.agent_index()).expect("the table of the row");
            let forbidden = regions.filter_map(|region| {
                let (own, other) = (owner(row.agent_index())?, owner(region.other())?);
                if own.agent == other.agent {
                    return None;
                }
                let delays = met_with(&region, own.stands, other.stands);
                Some(([own.agent, other.agent], [delays.lo, delays.hi]))
            });
            forbidden.collect()
        })?;
        MemoryDemand::ForbiddenDelays(found.len()).ask()?;
        let limit = <f64 as Scalar>::LIMIT;
        let mut ends = vec![f64::NEG_INFINITY; count];
        for (body, motion) in motions.iter().enumerate() {
            if let Some(end) = owners.get(body).and_then(|owner| ends.get_mut(owner.agent)) {
                *end = end.max(motion.time().hi);
            }
        }
        // A chain of waits is at most as long as the number of agents times the longest wait.
        let waits = found.iter().flat_map(|(_, delays)| delays).map(|end| end.abs()).filter(|end| *end < limit);
        let times = motions.iter().flat_map(|motion| [motion.time().lo, motion.time().hi]).map(f64::abs);
        let ticks = TickScale::up_to(times.fold(0.0, f64::max) + count as f64 * waits.fold(0.0, f64::max));
        let mut met = vec![Vec::new(); count];
        for ([agent, other], delays) in found {
            let [lo, hi] = ticks.outward(delays, limit);
            met[agent].push(ForbiddenInterval { other, ends: [lo, hi] });
            met[other].push(ForbiddenInterval { other: agent, ends: [-hi, -lo] });
        }
        met.iter_mut().for_each(|own| own.sort_by_key(|met| met.other));
        let goes_first = |own: &Vec<ForbiddenInterval>| {
            let sided = own.iter().filter(|met| met.ends[0] <= -NEVER && met.ends[1] < NEVER);
            let mut first: Vec<usize> = sided.map(|met| met.other).collect();
            first.dedup();
            first
        };
        let first = met.iter().map(goes_first).collect();
        Ok(Self { met, ticks, ends, first })
    }

    /// Forbidden values of the delay of an agent minus that of another one: open intervals in no order, which may overlap
    /// \[s\]; infinite ends are unbounded. Empty for agents that do not exist.
    pub fn intervals(&self, agent: usize, other: usize) -> impl Iterator<Item = [f64; 2]> {
        let own = self.met.get(agent).map_or(&[][..], Vec::as_slice);
        let begin = own.partition_point(|met| met.other < other);
        let those = own.iter().skip(begin).take_while(move |met| met.other == other);
        let seconds = |end: i64| match end {
            end if end <= -NEVER => f64::NEG_INFINITY,
            end if end >= NEVER => f64::INFINITY,
            end => self.ticks.seconds(end.into()),
        };
        those.map(move |met| met.ends.map(seconds))
    }

    /// The problem of finding delays for all agents.
    pub(crate) fn problem(&self, objective: Objective) -> DelayProblem {
        // Each pair once, seen from the second agent.
        let pairs = self.met.iter().enumerate().flat_map(|(i, own)| {
            let those = own.chunk_by(|a, b| a.other == b.other).filter_map(move |same| same.first().zip(Some(same)));
            those.filter(move |(met, _)| met.other > i).map(move |(met, same)| {
                ForbiddenPairDelays::new(
                    [i, met.other],
                    same.iter().map(|met| met.ends.map(|end| -end)).map(|[hi, lo]| [lo, hi]).collect(),
                )
            })
        });
        let pairs = pairs.collect();
        DelayProblem { objective, ends: self.ends.iter().map(|&end| self.ticks.nearest(end)).collect(), pairs }
    }

    /// Unit of its times.
    pub(crate) fn ticks(&self) -> TickScale {
        self.ticks
    }

    /// Number of agents.
    pub fn len(&self) -> usize {
        self.met.len()
    }

    /// Whether there are no agents.
    pub fn is_empty(&self) -> bool {
        self.met.is_empty()
    }

    /// The order, changed so that agents that have to start before others come before them.
    pub fn respecting(&self, order: &[usize]) -> Vec<usize> {
        delays::respecting(order, &self.first)
    }

    /// Plans one agent after the other, each as early as those before it allow; an agent that cannot start is left out.
    pub fn plan_in_order(&self, order: Vec<usize>) -> DelaySchedule {
        let mut delays = vec![None; self.len()];
        let mut out = Vec::new();
        let mut ranks = vec![0; self.len()];
        for (rank, &agent) in order.iter().enumerate() {
            ranks[agent] = rank;
            match self.earliest(&delays, &ranks, agent) {
                Ok(delay) => delays[agent] = Some(delay),
                Err(DelayBlocker { by, always }) => out.push(AgentWithoutDelay { agent, blocked_by: by, always }),
            }
        }
        let seconds = |delay: Option<i64>| delay.map(|delay| self.ticks.seconds(i128::from(delay)));
        DelaySchedule { delays: delays.into_iter().map(seconds).collect(), out, order }
    }

    /// The least delay of an agent that the agents with delays allow.
    fn earliest(&self, delays: &[Option<i64>], ranks: &[usize], agent: usize) -> Result<i64, DelayBlocker> {
        let before = || self.met[agent].iter().filter_map(|met| Some((met, delays[met.other]?)));
        let intervals: Vec<[i64; 2]> = before()
            .map(|(met, delay)| met.ends.map(|end| if end.abs() < NEVER { end + delay } else { end }))
            .collect();
        if let Some(delay) = earliest(intervals) {
            return Ok(delay);
        }
        // The first agent in the order of priority for which it holds.
        let first_of = |holds: &dyn Fn([i64; 2]) -> bool| {
            before().filter(|(met, _)| holds(met.ends)).map(|(met, _)| met.other).min_by_key(|&other| ranks[other])
        };
        let worst = first_of(&|[lo, hi]| lo <= -NEVER && hi >= NEVER);
        let first = first_of(&|[_, hi]| hi >= NEVER);
        Err(DelayBlocker { by: worst.or(first).unwrap_or(agent), always: worst.is_some() })
    }
}
