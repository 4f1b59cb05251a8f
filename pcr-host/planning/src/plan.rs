//! Plans without collisions: what `pcr plan` prints and writes.
//!
//! The agents are planned one after the other in an order of priority, each to arrive as early as those before it allow: by
//! a later start, or by its speed along the path. Starts are planned with the discs of footprints, speeds with the one disc
//! around them: another speed along the path is none of a disc beside it. Every plan is checked as `pcr check` does before it is returned.

mod bound;
mod circle;
mod forbidden;
mod reason;

use crate::certify::Proof;
use crate::check::Verdict;
use crate::fleet::Fleet;
use crate::fleet::HostEcm;
use crate::regions::{self, Failure};
pub(crate) use circle::sides;
pub(crate) use forbidden::Forbidden;
pub use forbidden::{Out, Schedule};
use pcr_core::{Drive, Encounter, Motion, Profile, Station, Unsolved as Never, plan_delays, plan_speeds};
use pcr_formats::scenario::{Labels, MotionSpec, Scenario};
pub use reason::Spot;
use serde::Serialize;

/// How conflicts are avoided.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// Agents start later and then move as the scenario says.
    Delay,
    /// Agents wait and change their speed on the way, under the largest speed and acceleration of their own motions.
    Speed,
}

impl Method {
    /// Its name in the output.
    pub fn name(self) -> &'static str {
        match self {
            Self::Delay => "delay",
            Self::Speed => "speed",
        }
    }
}

/// How the agents are put in order.
#[derive(Clone, Debug, PartialEq)]
pub enum Priority {
    /// By their numbers in this order; those that are left out come last, as in the file.
    Given(Vec<u64>),
    /// The one that travels longest first; else as in the file.
    Longest,
    /// The one with most regions first; else as in the file.
    Crowded,
    /// The least sum of costs of the order of the file, the other two, and what comes of moving the agent that loses most
    /// to the front, again and again while that is better.
    Best,
}

/// A plan, or why there is none. The JSON output, field for field in this order.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Plan {
    /// Name of the scenario.
    pub name: String,
    /// What the agents are called, by their numbers.
    #[serde(skip_serializing_if = "Labels::is_empty")]
    pub labels: Labels,
    /// How conflicts are avoided.
    pub method: &'static str,
    /// The agents by priority.
    pub order: Vec<u64>,
    /// In the order of the file; none where there is no plan.
    pub agents: Vec<Planned>,
    /// From the earliest start in the file to the last arrival \[s\].
    pub makespan: f64,
    /// Sum over the agents from their start in the file to their arrival \[s\].
    pub sum_of_costs: f64,
    /// No plan by this method costs less \[s\]: the sum of costs if nobody else were there.
    pub lower_bound: f64,
    /// Who cannot be planned.
    pub unsolved: Vec<Unsolved>,
    /// What was read otherwise than it was written.
    pub warnings: Vec<String>,
    /// What an independent checker has proved of the plan.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub certificate: Option<Proof>,
}

/// An agent of a plan.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Planned {
    /// Number.
    pub id: u64,
    /// How much later it starts than the file says \[s\].
    pub delay: f64,
    /// When it arrives \[s\].
    pub t_end: f64,
}

/// Agents for which there is no plan.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Unsolved {
    /// Their numbers.
    pub ids: Vec<u64>,
    /// Why.
    pub why: String,
    /// Where, if it is about two agents and a place.
    #[serde(flatten, skip_serializing_if = "Option::is_none")]
    pub spot: Option<Spot>,
}

impl Unsolved {
    /// The first agent cannot start because of the second, `always` or after it.
    pub(crate) fn of(scenario: &Scenario, ids: [u64; 2], always: bool) -> Self {
        let (why, spot) = reason::reason(scenario, ids, always);
        Self { ids: ids.to_vec(), why, spot }
    }

    /// Without a place.
    fn nowhere(ids: Vec<u64>, why: impl Into<String>) -> Self {
        Self { ids, why: why.into(), spot: None }
    }
}

/// Rounds of [`Priority::Best`] in which the agent that loses most is moved to the front.
const ROUNDS: usize = 8;
/// Phases of a speed profile, at most.
const PHASES: usize = 64;
/// Stations along a path: 256 cells.
const STATIONS: usize = 257;

/// A plan with the scenario that it makes, where there is one.
type Answer = (Plan, Option<Scenario>);

impl Plan {
    /// Starts or speeds for the agents of a scenario, and the scenario with them where there are.
    ///
    /// # Errors
    /// [`Failure`] where a value does not fit, the table cannot hold the fleet, or an agent of the order is not there.
    pub fn of(scenario: &Scenario, method: Method, priority: &Priority) -> Result<Answer, Failure> {
        let fleet = Fleet::<f64>::new(scenario)?;
        let motions = grown(&fleet);
        let ecm = regions::table(scenario, &motions)?;
        let outlined = method == Method::Delay && scenario.agents.iter().any(|agent| agent.footprint.is_some());
        let forbidden = outlined.then(|| Forbidden::of(scenario)).transpose()?;
        let planner = Planner { scenario, method, motions: &motions, ecm: &ecm, forbidden };
        let mut orders = planner.orders(priority)?.into_iter();
        // There is at least one order.
        let mut best = planner.plan(orders.next().unwrap_or_default())?;
        for order in orders {
            best = better(best, planner.plan(order)?);
        }
        for _ in 0..if *priority == Priority::Best { ROUNDS } else { 0 } {
            let Some(order) = planner.with_the_latest_first(&best.0) else { break };
            let cost = best.0.sum_of_costs;
            best = better(best, planner.plan(order)?);
            if best.0.sum_of_costs >= cost {
                break;
            }
        }
        // Of footprints it would be no proof: the discs around them may have to wait where they do not.
        if best.1.is_none()
            && planner.forbidden.is_none()
            && let Some(circle) = circle::circle(&ecm, &motions)
        {
            let ids = circle.into_iter().map(|agent| planner.id(agent)).collect();
            let why = "each has to let the next one pass first, the last one the first, however they move";
            best.0.unsolved.insert(0, Unsolved::nowhere(ids, why));
        }
        if let Some(solved) = &best.1 {
            let proof = Proof::of::<f64>(solved)?;
            if let Some(contact) = proof.contacts.first() {
                let why = format!("the plan has a contact at {} s", contact.t);
                best.0.unsolved.push(Unsolved::nowhere(vec![contact.i, contact.j], why));
                best.1 = None;
            }
            best.0.certificate = Some(proof);
        }
        Ok(best)
    }
}

/// The second answer if it costs less than the first, or is the only one with a plan.
fn better(first: Answer, second: Answer) -> Answer {
    let is_better = match (&first.1, &second.1) {
        (Some(_), Some(_)) => second.0.sum_of_costs < first.0.sum_of_costs,
        (first, second) => first.is_none() && second.is_some(),
    };
    if is_better { second } else { first }
}

/// What all attempts have in common.
struct Planner<'a> {
    scenario: &'a Scenario,
    method: Method,
    motions: &'a [Motion<'a, f64>],
    ecm: &'a HostEcm<f64>,
    /// Where there are footprints and starts are asked for.
    forbidden: Option<Forbidden>,
}

impl Planner<'_> {
    fn id(&self, agent: usize) -> u64 {
        self.scenario.agents.get(agent).map_or(0, |agent| agent.id)
    }

    /// The orders to be tried.
    fn orders(&self, priority: &Priority) -> Result<Vec<Vec<usize>>, Failure> {
        let ids: Vec<u64> = self.scenario.agents.iter().map(|agent| agent.id).collect();
        let file: Vec<usize> = (0..ids.len()).collect();
        let place =
            |id: &u64| ids.iter().position(|there| there == id).ok_or_else(|| Failure::NoSuchAgent(*id, ids.clone()));
        let sorted = |key: &dyn Fn(usize) -> f64| {
            let mut order = file.clone();
            order.sort_by(|&a, &b| key(b).total_cmp(&key(a)));
            order
        };
        let longest = || sorted(&|agent| self.motions[agent].time().length());
        let crowded =
            || sorted(&|agent| self.ecm.row(self.motions, agent).expect("the table of the fleet").count() as f64);
        Ok(match priority {
            Priority::Given(given) => {
                let mut order = given.iter().map(place).collect::<Result<Vec<usize>, Failure>>()?;
                let rest: Vec<usize> = file.iter().copied().filter(|agent| !order.contains(agent)).collect();
                order.extend(rest);
                vec![order]
            }
            Priority::Longest => vec![longest()],
            Priority::Crowded => vec![crowded()],
            Priority::Best => vec![file.clone(), longest(), crowded()],
        })
    }

    /// The order of a plan with the agent first that arrives later than it could by most; nothing if it is first.
    fn with_the_latest_first(&self, plan: &Plan) -> Option<Vec<usize>> {
        let late = |agent: &usize| {
            plan.agents.get(*agent).map_or(0.0, |planned| planned.t_end) - self.motions[*agent].time().hi
        };
        let latest = (0..self.motions.len()).max_by(|a, b| late(a).total_cmp(&late(b)))?;
        let place = |id: &u64| self.scenario.agents.iter().position(|agent| agent.id == *id);
        let order: Vec<usize> = plan.order.iter().filter_map(place).collect();
        if plan.agents.is_empty() || order.first() == Some(&latest) {
            return None;
        }
        Some(core::iter::once(latest).chain(order.into_iter().filter(|&agent| agent != latest)).collect())
    }

    /// The least time in which an agent can travel its path by this method \[s\].
    fn least(&self, motion: &Motion<'_, f64>) -> f64 {
        match self.method {
            Method::Delay => motion.time().length(),
            Method::Speed => bound::fastest(Drive::of(motion), motion.path().length()),
        }
    }

    /// A plan by this order, or one that it leads to.
    fn plan(&self, mut order: Vec<usize>) -> Result<Answer, Failure> {
        let agents = self.motions.len();
        let slots = if self.method == Method::Speed { 4 * agents } else { 0 };
        let mut profiles = vec![Profile::<f64, PHASES>::standing(); slots];
        let mut stations = vec![Station::EMPTY; if slots > 0 { STATIONS } else { 0 }];
        let mut planned = self.motions.to_vec();
        let outcome = match self.method {
            Method::Delay if self.forbidden.is_some() => self.delays(&mut planned, &mut order),
            Method::Delay => plan_delays(self.ecm, self.motions, &mut planned, &mut order),
            Method::Speed => {
                plan_speeds(self.ecm, self.motions, &mut planned, &mut order, &mut profiles, &mut stations)
            }
        };
        let mut plan = Plan {
            name: self.scenario.name.clone(),
            labels: Labels::of(self.scenario),
            method: self.method.name(),
            order: order.iter().map(|&agent| self.id(agent)).collect(),
            agents: Vec::new(),
            makespan: 0.0,
            sum_of_costs: 0.0,
            lower_bound: self.motions.iter().map(|motion| self.least(motion)).sum(),
            unsolved: Vec::new(),
            warnings: self.scenario.warnings.clone(),
            certificate: None,
        };
        if let Err(never) = outcome {
            plan.unsolved.push(self.unsolved(never));
            return Ok((plan, None));
        }
        plan.sum_up(self, &planned);
        // Nothing is returned that the check would refuse.
        let solved = self.solved(&planned);
        let verdict = Verdict::of::<f64>(&solved, false)?;
        if let Some(conflict) = verdict.conflicts.first() {
            let why = format!("the plan has a conflict at {} s", conflict.t[0]);
            plan.unsolved.push(Unsolved::nowhere(vec![conflict.i, conflict.j], why));
            (plan.agents, plan.makespan, plan.sum_of_costs) = (Vec::new(), 0.0, 0.0);
            return Ok((plan, None));
        }
        Ok((plan, Some(solved)))
    }

    /// Starts by what the discs of footprints forbid.
    fn delays(&self, planned: &mut [Motion<'_, f64>], order: &mut Vec<usize>) -> Result<(), Never> {
        let Some(forbidden) = &self.forbidden else { return Ok(()) };
        let Schedule { delays, out, order: kept } = forbidden.in_order(forbidden.respecting(std::mem::take(order)));
        *order = kept;
        if let Some(out) = out.first() {
            let agents = [out.agent, out.by];
            return Err(if out.always { Never::Always(agents) } else { Never::Priorities(agents) });
        }
        for (agent, (motion, delay)) in planned.iter_mut().zip(delays).enumerate() {
            *motion = motion.delayed(delay.unwrap_or_default()).map_err(|_| Never::Full(agent))?;
        }
        Ok(())
    }

    fn unsolved(&self, never: Never) -> Unsolved {
        let pair = |agents: [usize; 2], why: &str, ends: bool| {
            let ids = agents.map(|agent| self.id(agent)).to_vec();
            let [Some(a), Some(b)] = agents.map(|agent| self.motions.get(agent)) else {
                return Unsolved::nowhere(ids, why);
            };
            let spot = Spot::standing([a, b], ends);
            Unsolved { ids, why: format!("{why}, {}", spot.words()), spot: Some(spot) }
        };
        match never {
            Never::Starts(agents) => pair(agents, "they overlap at their starts", false),
            Never::Ends(agents) => pair(agents, "they overlap at the ends of their paths", true),
            Never::Always([a, b]) => Unsolved::of(self.scenario, [self.id(a), self.id(b)], true),
            Never::Priorities([a, b]) => Unsolved::of(self.scenario, [self.id(a), self.id(b)], false),
            Never::Full(agent) => {
                let why = "its plan takes too many profiles or phases, or too long";
                Unsolved::nowhere(vec![self.id(agent)], why)
            }
            other => Unsolved::nowhere(Vec::new(), other.to_string()),
        }
    }

    /// The scenario with the motions of a plan.
    fn solved(&self, planned: &[Motion<'_, f64>]) -> Scenario {
        let mut solved = self.scenario.clone();
        for ((agent, given), motion) in solved.agents.iter_mut().zip(self.motions).zip(planned) {
            agent.t_start = motion.time().lo;
            let phases = motion.profile().phases();
            if phases != given.profile().phases() {
                let v0 = phases.first().map_or(0.0, |first| first.speed()[0]);
                let pieces = phases.iter().map(|phase| (phase.time().length(), phase.acceleration()));
                agent.motion = MotionSpec::Profile { v0, pieces: pieces.collect() };
            }
        }
        solved
    }
}

impl Plan {
    fn sum_up(&mut self, planner: &Planner<'_>, planned: &[Motion<'_, f64>]) {
        let earliest = planner.motions.iter().map(|motion| motion.time().lo).fold(f64::INFINITY, f64::min);
        for ((agent, motion), planned) in planner.scenario.agents.iter().zip(planner.motions).zip(planned) {
            let [start, end] = [planned.time().lo, planned.time().hi];
            self.agents.push(Planned { id: agent.id, delay: start - motion.time().lo, t_end: end });
            self.makespan = self.makespan.max(end - earliest);
            self.sum_of_costs += end - motion.time().lo;
        }
    }
}

/// The motions with their margins, and with what the check may take for a contact. A radius at the limit of the format
/// stays as it is, and the check has the last word.
pub(crate) fn grown(fleet: &Fleet<f64>) -> Vec<Motion<'_, f64>> {
    let motions = fleet.motions();
    let tolerance = motions.iter().map(|motion| Encounter::new(motion, motion).tolerance()).fold(0.0, f64::max);
    // The growths of two agents add up: what planning and what the check may be off.
    let grown = motions.iter().map(|&motion| motion.with_margin(motion.margin() + tolerance).unwrap_or(motion));
    grown.map(|motion| motion.inflated()).collect()
}
