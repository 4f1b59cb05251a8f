//! Plans without collisions: what `pcr plan` prints and writes.
//!
//! The agents start one after the other in an order of priority, each as early as those before it allow. Every plan is
//! checked as `pcr check` does before it is returned.

use crate::check::Verdict;
use crate::fleet::Fleet;
use crate::regions::{self, Failure};
use crate::scenario::Scenario;
use pcr_core::{Encounter, Motion, Unsolved as Never, plan_delays};
use serde::Serialize;

/// How the agents are put in order.
#[derive(Clone, Debug, PartialEq)]
pub enum Priority {
    /// By their numbers in this order; those that are left out come last, as in the file.
    Given(Vec<u64>),
    /// The one that travels longest first; else as in the file.
    Longest,
    /// The one with most regions first; else as in the file.
    Crowded,
    /// The best of the order of the file and the other two: the least sum of costs.
    Best,
}

/// A plan, or why there is none. The JSON output, field for field in this order.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Plan {
    /// Name of the scenario.
    pub name: String,
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
    /// The sum of costs if nobody had to wait \[s\].
    pub lower_bound: f64,
    /// Who cannot be planned.
    pub unsolved: Vec<Unsolved>,
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
}

impl Unsolved {
    /// The first agent cannot start because of the second, `always` or after it.
    pub(crate) fn of(ids: [u64; 2], always: bool) -> Self {
        let why = match always {
            true => "they meet whenever they start: head-on without a passing place, or starts or ends that overlap",
            false => "the first cannot start because of the second in any order that was tried",
        };
        Self { ids: ids.to_vec(), why: why.to_owned() }
    }
}

impl Plan {
    /// Delays for the agents of a scenario, and the scenario with them where there are.
    ///
    /// # Errors
    /// [`Failure`] where a value does not fit, the table cannot hold the fleet, or an agent of the order is not there.
    pub fn of(scenario: &Scenario, priority: &Priority) -> Result<(Self, Option<Scenario>), Failure> {
        let ids: Vec<u64> = scenario.agents.iter().map(|agent| agent.id).collect();
        let fleet = Fleet::<f64>::new(scenario)?;
        let motions = grown(&fleet);
        let ecm = regions::table(scenario, &motions)?;
        let place =
            |id: &u64| ids.iter().position(|there| there == id).ok_or_else(|| Failure::NoSuchAgent(*id, ids.clone()));
        let file: Vec<usize> = (0..ids.len()).collect();
        let sorted = |key: &dyn Fn(usize) -> f64| {
            let mut order = file.clone();
            order.sort_by(|&a, &b| key(b).total_cmp(&key(a)));
            order
        };
        let longest = || sorted(&|agent| motions[agent].time().length());
        let crowded = || sorted(&|agent| ecm.row(&motions, agent).count() as f64);
        let orders = match priority {
            Priority::Given(given) => {
                let mut order = given.iter().map(place).collect::<Result<Vec<usize>, Failure>>()?;
                let rest: Vec<usize> = file.iter().copied().filter(|agent| !order.contains(agent)).collect();
                order.extend(rest);
                vec![order]
            }
            Priority::Longest => vec![longest()],
            Priority::Crowded => vec![crowded()],
            Priority::Best => vec![file.clone(), longest(), crowded()],
        };
        let mut best: Option<(Self, Option<Scenario>)> = None;
        for mut order in orders {
            let mut planned = motions.clone();
            let outcome = plan_delays(&ecm, &motions, &mut planned, &mut order);
            let answer = Self::assemble(scenario, &motions, &planned, &order, outcome)?;
            let better = best.as_ref().is_none_or(|(plan, solved)| match (&answer.1, solved) {
                (Some(_), None) => true,
                (Some(_), Some(_)) => answer.0.sum_of_costs < plan.sum_of_costs,
                (None, _) => false,
            });
            if better {
                best = Some(answer);
            }
        }
        // There is at least one order.
        best.ok_or(Failure::NoSuchAgent(0, ids))
    }

    fn assemble(
        scenario: &Scenario,
        motions: &[Motion<'_, f64>],
        planned: &[Motion<'_, f64>],
        order: &[usize],
        outcome: Result<(), Never>,
    ) -> Result<(Self, Option<Scenario>), Failure> {
        let id = |agent: usize| scenario.agents.get(agent).map_or(0, |agent| agent.id);
        let mut plan = Self {
            name: scenario.name.clone(),
            method: "delay",
            order: order.iter().map(|&agent| id(agent)).collect(),
            agents: Vec::new(),
            makespan: 0.0,
            sum_of_costs: 0.0,
            lower_bound: motions.iter().map(|motion| motion.time().length()).sum(),
            unsolved: Vec::new(),
        };
        if let Err(never) = outcome {
            plan.unsolved.push(match never {
                Never::Always([a, b]) => Unsolved::of([id(a), id(b)], true),
                Never::Priorities([a, b]) => Unsolved::of([id(a), id(b)], false),
                other => Unsolved { ids: Vec::new(), why: other.to_string() },
            });
            return Ok((plan, None));
        }
        let mut solved = scenario.clone();
        for (agent, motion) in solved.agents.iter_mut().zip(planned) {
            agent.t_start = motion.time().lo;
        }
        let earliest = motions.iter().map(|motion| motion.time().lo).fold(f64::INFINITY, f64::min);
        for ((agent, motion), planned) in scenario.agents.iter().zip(motions).zip(planned) {
            let [start, end] = [planned.time().lo, planned.time().hi];
            plan.agents.push(Planned { id: agent.id, delay: start - motion.time().lo, t_end: end });
            plan.makespan = plan.makespan.max(end - earliest);
            plan.sum_of_costs += end - motion.time().lo;
        }
        // Nothing is returned that the check would refuse.
        let verdict = Verdict::of::<f64>(&solved, false)?;
        if let Some(conflict) = verdict.conflicts.first() {
            let why = format!("the plan has a conflict at {} s", conflict.t[0]);
            plan.unsolved.push(Unsolved { ids: vec![conflict.i, conflict.j], why });
            return Ok((plan, None));
        }
        Ok((plan, Some(solved)))
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
