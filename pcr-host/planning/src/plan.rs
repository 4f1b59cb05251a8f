//! Plans without collisions: the answer and the file of `pcr plan`.
//!
//! Start delays: the best ones by branch and bound, or one agent after the other in an order of priority. Speeds: each
//! agent arrives as early as the agents before it in an order allow, and the start delays are also tried. Start delays
//! use the discs of footprints and loads, speeds use one disc around them, because a disc beside the reference point does not
//! have the same speed. Every plan is checked like `pcr check` does, and proved by the independent checker, before it
//! is returned.

mod circular_wait;
mod delays;
mod failure_reason;
mod forbidden_delays;
mod lower_bound;
#[cfg(test)]
mod outline_tests;
mod plan_context;
mod plan_progress;
mod planner;
mod speeds;
mod starts;
#[cfg(test)]
mod tests;

use crate::certify::MotionCertificate;
use crate::failure::ComputationError;
use crate::fleet::Fleet;
use crate::memory_budget::MemoryDemand;
pub use circular_wait::sides;
pub(crate) use circular_wait::sides_of;
pub use delays::{DelaySearchOptions, Objective};
pub use forbidden_delays::{AgentWithoutDelay, DelaySchedule, ForbiddenDelays};
use pcr_core::{Encounter, Motion};
use pcr_formats::scenario::{Labels, Scenario};
use pcr_formats::warning::WarningCode;

pub use failure_reason::BlockingLocation;
use plan_context::Planner;
pub use plan_progress::{PlanProgressFn, PlanStage};
use serde::ser::SerializeStruct;
use serde::{Serialize, Serializer};
pub use starts::some as start_delays;
use starts::{PartialDelayPlan, StartDelayResult};
use std::time::Instant;

/// How conflicts are avoided.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PlanMethod {
    /// Agents start later and then move as the scenario says.
    #[default]
    Delay,
    /// Agents wait and change their speed on the way, under the largest speed and acceleration of their own motions. Those
    /// that turn in place, or are slower on the way than these limits for another reason, are nowhere faster than their
    /// own motions.
    Speed,
}

impl PlanMethod {
    /// Its name in the output.
    pub fn name(self) -> &'static str {
        match self {
            Self::Delay => "delay",
            Self::Speed => "speed",
        }
    }
}

/// How the agents are put in order.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum PriorityRule {
    /// By their numbers in this order; those that are left out come last, as in the file.
    Given(Vec<u64>),
    /// The one that travels longest first; else as in the file.
    Longest,
    /// The one with most regions first; else as in the file.
    Crowded,
    /// Whatever costs least: of delays the best of all orders, of speeds the best of those that are tried.
    #[default]
    Best,
}

/// The options of a plan.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PlanOptions {
    /// How conflicts are avoided.
    pub method: PlanMethod,
    /// How the agents are put in order.
    pub priority: PriorityRule,
    /// The objective to be minimized.
    pub objective: Objective,
    /// Whether agents may be left out, as few as possible, if not all can have a plan.
    pub leave_out: bool,
    /// How long to search.
    pub effort: DelaySearchOptions,
}

impl PlanOptions {
    /// The best plan by a method.
    pub fn new(method: PlanMethod) -> Self {
        Self { method, ..Self::default() }
    }

    /// The same for some of the agents.
    fn among(&self, rest: &Scenario) -> Self {
        let mut request = self.clone();
        if let PriorityRule::Given(given) = &mut request.priority {
            given.retain(|id| rest.agents.iter().any(|agent| agent.id == *id));
        }
        request
    }
}

/// A plan, or why there is none. The JSON output, field for field in this order.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PlanReport {
    /// Name of the scenario.
    pub name: String,
    /// Labels of the agents, by their numbers.
    #[serde(skip_serializing_if = "Labels::is_empty")]
    pub labels: Labels,
    /// How conflicts are avoided.
    pub method: &'static str,
    /// The agents by priority, or by their starts if no priority was requested.
    pub order: Vec<u64>,
    /// Agents in the order of the file; empty if there is no plan.
    pub agents: Vec<PlanEntry>,
    /// Agents that were left out; the plan is made as if they were not there.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub left_out: Vec<u64>,
    /// Objective: `sum_of_costs` or `makespan`.
    pub objective: &'static str,
    /// What the plan costs; in JSON its fields are those of the plan, and `null` (`proved`: false) if there is no plan.
    #[serde(flatten, serialize_with = "costs")]
    pub costs: Option<PlanCosts>,
    /// Sets of agents that cannot be planned; at least one agent of each set has to be left out.
    pub unsolved: Vec<UnplannedAgents>,
    /// Why the scenario was refused.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error: Option<String>,
    /// Warnings about input that was changed or left out when it was read.
    pub warnings: Vec<String>,
    /// Result of the independent checker for the plan.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub certificate: Option<MotionCertificate>,
}

/// The costs of a plan, for its agents.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlanCosts {
    /// Time from the earliest start in the file to the last arrival \[s\].
    pub makespan: f64,
    /// Sum over the agents from their start in the file to their arrival \[s\].
    pub sum_of_costs: f64,
    /// Lower bound of the objective of all plans by this method for the same agents \[s\].
    pub lower_bound: f64,
    /// Difference between objective and lower bound, relative to the objective.
    pub gap: f64,
    /// Whether the plan is proved to be the best, except for rounding.
    pub proved: bool,
}

fn costs<W: Serializer>(costs: &Option<PlanCosts>, to: W) -> Result<W::Ok, W::Error> {
    let mut fields = to.serialize_struct("Costs", 5)?;
    fields.serialize_field("makespan", &costs.map(|costs| costs.makespan))?;
    fields.serialize_field("sum_of_costs", &costs.map(|costs| costs.sum_of_costs))?;
    fields.serialize_field("lower_bound", &costs.map(|costs| costs.lower_bound))?;
    fields.serialize_field("gap", &costs.map(|costs| costs.gap))?;
    fields.serialize_field("proved", &costs.is_some_and(|costs| costs.proved))?;
    fields.end()
}

/// An agent of a plan.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct PlanEntry {
    /// Number.
    pub id: u64,
    /// Delay of its start against the file \[s\].
    pub delay: f64,
    /// Time of arrival \[s\].
    pub t_end: f64,
}

/// Agents for which there is no plan.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct UnplannedAgents {
    /// Their numbers.
    pub ids: Vec<u64>,
    /// Reason, in words.
    pub why: String,
    /// Place, if the reason is about two agents and a place.
    #[serde(flatten, skip_serializing_if = "Option::is_none")]
    pub spot: Option<BlockingLocation>,
}

impl UnplannedAgents {
    /// The reason why the first agent cannot start because of the second; `always`: with all delays.
    pub fn of(scenario: &Scenario, ids: [u64; 2], always: bool) -> Self {
        let (why, spot) = failure_reason::reason(scenario, ids, always);
        Self { ids: ids.to_vec(), why, spot }
    }

    /// Without a place.
    fn nowhere(ids: Vec<u64>, why: impl Into<String>) -> Self {
        Self { ids, why: why.into(), spot: None }
    }
}

/// Largest number of agents that are tried to be put back into a plan by speeds; each takes a plan of all others.
const PUT_BACK: usize = 16;

/// A plan, and the scenario that it makes, where there is one.
type PlanAnswer = (PlanReport, Option<Scenario>);

impl PlanReport {
    /// One without agents.
    fn none(name: &str, method: PlanMethod, objective: Objective) -> Self {
        Self {
            name: name.to_owned(),
            labels: Labels::default(),
            method: method.name(),
            order: Vec::new(),
            agents: Vec::new(),
            left_out: Vec::new(),
            objective: objective.name(),
            costs: None,
            unsolved: Vec::new(),
            error: None,
            warnings: Vec::new(),
            certificate: None,
        }
    }

    /// No plan, as there is no scenario, and why.
    pub fn refused(name: &str, method: PlanMethod, objective: Objective, error: String) -> Self {
        Self { error: Some(error), ..Self::none(name, method, objective) }
    }

    /// Starts or speeds for the agents of a scenario, and the scenario with them where there are.
    ///
    /// # Errors
    /// [`ComputationError`] where a value does not fit, the table cannot hold the fleet, or an agent of the order is not there.
    pub fn compute(scenario: &Scenario, request: &PlanOptions) -> Result<PlanAnswer, ComputationError> {
        Self::watched(scenario, request, &|_, _, _| {})
    }

    /// The same; tells meanwhile how far it is.
    ///
    /// # Errors
    /// As [`PlanReport::compute`].
    pub fn watched(
        scenario: &Scenario,
        request: &PlanOptions,
        told: PlanProgressFn<'_>,
    ) -> Result<PlanAnswer, ComputationError> {
        MemoryDemand::Plan(scenario.agents.len()).ask()?;
        let begin = Instant::now();
        let fleet = Fleet::<f64>::of_bodies(scenario)?;
        let motions = prepared(&fleet, request.method);
        let planner = Planner { scenario, request, motions: &motions, begin, told };
        let starts = StartDelayResult::of(&planner)?;
        let everybody = starts.of_all();
        let (mut plan, solved) = match request.method {
            PlanMethod::Delay if everybody.is_none() => {
                (Self { unsolved: starts.unsolved(&planner), ..planner.none() }, None)
            }
            _ => planner.plan(everybody)?,
        };
        if request.method == PlanMethod::Speed && solved.is_none() {
            plan.unsolved = starts.added(&planner, plan.unsolved);
        }
        let mut staying = if request.leave_out && solved.is_none() { starts.staying() } else { Vec::new() };
        if staying.is_empty() {
            return Ok((plan, solved));
        }
        let of_rest = |staying: &[usize], known: Option<PartialDelayPlan>| {
            let agents = staying.iter().map(|&agent| scenario.agents[agent].clone()).collect();
            let rest = Scenario { agents, ..scenario.clone() };
            let fleet = Fleet::<f64>::of_bodies(&rest)?;
            let motions = prepared(&fleet, request.method);
            // An order may name those that are left out.
            let request = &request.among(&rest);
            Planner { scenario: &rest, request, motions: &motions, begin, told }.plan(known)
        };
        let (mut partial, mut solved) = of_rest(&staying, Some(starts.known(&staying)))?;
        // Other speeds may have a plan for agents that start delays leave out.
        let out = |staying: &[usize]| -> Vec<usize> {
            (0..scenario.agents.len()).filter(|agent| staying.binary_search(agent).is_err()).collect()
        };
        let more = if request.method == PlanMethod::Speed { PUT_BACK } else { 0 };
        for agent in out(&staying).into_iter().take(more) {
            let mut with = staying.clone();
            with.insert(with.partition_point(|&other| other < agent), agent);
            if let (plan, Some(found)) = of_rest(&with, None)? {
                (staying, partial, solved) = (with, plan, Some(found));
            }
        }
        partial.labels = plan.labels;
        let out = out(&staying);
        partial.left_out = out.iter().map(|&agent| planner.id(agent)).collect();
        partial.unsolved.splice(0..0, plan.unsolved);
        if let Some(solved) = &mut solved {
            // Agents that are in the plan have one together, whatever was said of them before.
            let is_open = |ids: &[u64]| ids.is_empty() || ids.iter().any(|id| partial.left_out.contains(id));
            partial.unsolved.retain(|unsolved| !out.is_empty() && is_open(&unsolved.ids));
            let called: Vec<String> = out.iter().map(|&agent| scenario.agents[agent].display_name()).collect();
            if !called.is_empty() {
                let (count, all) = (called.len(), scenario.agents.len());
                let who = called.join(", ");
                let text = format_args!("left out of the plan: {count} of {all} agents: {who}");
                solved.warnings.push(WarningCode::AgentsLeftOut.text(text));
            }
        }
        Ok((partial, solved))
    }
}

/// Longest motion of a speed plan, over a day \[s\]: the regions hold for it.
const LONGEST: f64 = 1e5;

/// The motions to plan with. Start delays change no profile.
fn prepared(fleet: &Fleet<f64>, method: PlanMethod) -> Vec<Motion<'_, f64>> {
    let motions = motions_with_margins(fleet);
    match method {
        PlanMethod::Delay => motions,
        PlanMethod::Speed => motions.into_iter().map(|motion| motion.with_longest(LONGEST).unwrap_or(motion)).collect(),
    }
}

/// The motions with their margins, and with what the check may take for a contact. A radius at the limit of the format
/// stays as it is, and the check has the last word.
pub(crate) fn motions_with_margins(fleet: &Fleet<f64>) -> Vec<Motion<'_, f64>> {
    let motions = fleet.motions();
    let tolerance = motions.iter().map(|motion| Encounter::new(motion, motion).tolerance()).fold(0.0, f64::max);
    // The growths of two agents add up: what planning and what the check may be off.
    let grown = motions.iter().map(|&motion| motion.with_margin(motion.margin() + tolerance).unwrap_or(motion));
    grown.map(|motion| motion.inflated()).collect()
}
