//! Start delays of a scenario, for all of its agents or for as many as possible, with their quality.

use super::circular_wait::CIRCULAR_WAIT;
use super::delays::{self, DelayResult, Objective};
use super::forbidden_delays::{AgentWithoutDelay, DelaySchedule, ForbiddenDelays};
use super::plan_context::Planner;
use super::plan_progress::PlanStage;
use super::{PriorityRule, UnplannedAgents, failure_reason};
use crate::failure::ComputationError;
use crate::parallel;
use pcr_core::Motion;
use pcr_formats::scenario::Agent;
use std::collections::HashSet;

/// Delays of some agents of a fleet, in the order of the fleet.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct PartialDelayPlan {
    /// \[s\]
    pub(super) delays: Vec<f64>,
    /// The agents by priority, or by their starts if no order was requested.
    pub(super) order: Vec<usize>,
    /// Lower bound of the cost \[s\]; minus infinity if there is none.
    pub(super) bound: f64,
    /// Whether the cost equals the bound, except for rounding.
    pub(super) proved: bool,
}

/// Start delays of motions \[s\]; as few as possible are left out, with `None`. `with` has for each motion those that have to
/// be left out with it, itself included. `None` if no delays are found quickly.
pub fn some(motions: &[Motion<'_, f64>], with: &[Vec<usize>]) -> Option<Vec<Option<f64>>> {
    let forbidden = ForbiddenDelays::of_motions(motions).ok()?;
    let ticks = forbidden.ticks();
    let found = delays::some(&forbidden.problem(Objective::Sum), with);
    Some(found.into_iter().map(|delay| delay.map(|delay| ticks.seconds(delay.into()))).collect())
}

pub(super) struct StartDelayResult {
    /// Delays by the index of the agent \[s\]; `None` if the search was stopped before it found any.
    delays: Option<Vec<Option<f64>>>,
    order: Vec<usize>,
    bound: f64,
    proved: bool,
    /// Sets of agents that have no delays together.
    conflicts: Vec<Vec<usize>>,
    /// Whether it is proved that no larger set of agents has delays.
    fewest: bool,
    /// Agents that cannot start in the requested order.
    out: Vec<AgentWithoutDelay>,
    /// Whether agents were planned as several bodies, of which speed plans take the convex hull.
    pub(super) has_parts: bool,
}

impl StartDelayResult {
    pub(super) fn of(planner: &Planner<'_, '_>) -> Result<Self, ComputationError> {
        let (scenario, request) = (planner.scenario, planner.request);
        let told = planner.told;
        let forbidden = ForbiddenDelays::watched(scenario, &|done, all| told(PlanStage::Regions, done, all))?;
        let ticks = forbidden.ticks();
        let problem = forbidden.problem(request.objective);
        let schedules =
            planner.orders()?.into_iter().map(|order| forbidden.plan_in_order(forbidden.respecting(&order)));
        let schedules: Vec<DelaySchedule> = schedules.collect();
        let is_best = request.priority == PriorityRule::Best;
        let in_ticks = |schedule: &DelaySchedule| {
            schedule.delays.iter().map(|delay| delay.map(|delay| ticks.nearest(delay))).collect::<Vec<Option<i64>>>()
        };
        let known: Vec<Vec<Option<i64>>> = schedules.iter().map(in_ticks).collect();
        let DelayResult { delays, bound, proved, conflicts, fewest } =
            delays::best(&problem, &known, request.effort, request.leave_out, told);
        let seconds = |delay: &Option<i64>| delay.map(|delay| ticks.seconds(i128::from(delay)));
        let has_parts = scenario.agents.iter().any(Agent::has_parts);
        let found = Self {
            delays: delays.map(|delays| delays.iter().map(seconds).collect()),
            order: Vec::new(),
            bound: ticks.seconds(bound),
            proved,
            conflicts,
            fewest,
            out: Vec::new(),
            has_parts,
        };
        if is_best {
            return Ok(found);
        }
        let Some(DelaySchedule { delays, out, order }) = schedules.into_iter().next() else { return Ok(found) };
        let whole = delays.iter().all(Option::is_some);
        let first: Option<Vec<i64>> = known.first().and_then(|known| known.iter().copied().collect());
        let reached = first.is_some_and(|known| problem.cost(&known) <= bound + delays::rounding_cost(&problem));
        // A bound for a different set of agents does not apply.
        let bound = if whole { found.bound } else { f64::NEG_INFINITY };
        Ok(Self { delays: Some(delays), order, out, bound, proved: found.proved && whole && reached, ..found })
    }

    /// The delays of all agents, if all have one.
    pub(super) fn of_all(&self) -> Option<PartialDelayPlan> {
        let delays = self.delays.as_ref()?;
        delays.iter().all(Option::is_some).then(|| self.known(&(0..delays.len()).collect::<Vec<_>>()))
    }

    /// The agents with a delay.
    pub(super) fn staying(&self) -> Vec<usize> {
        let delays = self.delays.as_deref().unwrap_or_default();
        (0..delays.len()).filter(|&agent| delays[agent].is_some()).collect()
    }

    /// The delays of the agents that have one.
    pub(super) fn known(&self, staying: &[usize]) -> PartialDelayPlan {
        let delays = self.delays.as_deref().unwrap_or_default();
        let mut places = vec![None; delays.len()];
        staying.iter().enumerate().for_each(|(place, &agent)| places[agent] = Some(place));
        PartialDelayPlan {
            delays: staying.iter().filter_map(|&agent| delays[agent]).collect(),
            order: self.order.iter().filter_map(|&agent| places[agent]).collect(),
            bound: self.bound,
            proved: self.proved,
        }
    }

    /// Adds reasons why no speed plan was found. A reason about convex hulls is dropped if there are start delays for
    /// the outlines themselves; with `leave_out` the reasons are for all agents that are left out.
    pub(super) fn added(&self, planner: &Planner<'_, '_>, found: Vec<UnplannedAgents>) -> Vec<UnplannedAgents> {
        if self.of_all().is_some() || !(self.has_parts || planner.request.leave_out) {
            return found;
        }
        let mut all = if self.has_parts { Vec::new() } else { found };
        let sorted = |unsolved: &UnplannedAgents| {
            let mut ids = unsolved.ids.clone();
            ids.sort_unstable();
            ids
        };
        let known: HashSet<Vec<u64>> = all.iter().map(sorted).collect();
        let more = self.unsolved(planner).into_iter().filter(|unsolved| !known.contains(&sorted(unsolved)));
        all.extend(
            more.map(|unsolved| UnplannedAgents { why: format!("by start delays: {}", unsolved.why), ..unsolved }),
        );
        all
    }

    /// The reasons why not all agents have delays.
    pub(super) fn unsolved(&self, planner: &Planner<'_, '_>) -> Vec<UnplannedAgents> {
        let ids = |agents: &[usize]| agents.iter().map(|&agent| planner.id(agent)).collect::<Vec<_>>();
        let mut unsolved: Vec<UnplannedAgents> = Vec::new();
        // For convex hulls it would not be a proof: they may have to wait where the outlines need not.
        let circle = if self.has_parts { None } else { planner.circle() };
        if let Some(circle) = &circle {
            unsolved.push(UnplannedAgents::nowhere(ids(circle), CIRCULAR_WAIT));
        }
        let of_conflict = |conflict: &Vec<usize>| {
            let is_circle = circle.as_ref().is_some_and(|circle| {
                circle.len() == conflict.len() && circle.iter().all(|agent| conflict.contains(agent))
            });
            match conflict.as_slice() {
                _ if is_circle => None,
                &[i, j] if planner.is_late() => {
                    Some(UnplannedAgents::nowhere(vec![planner.id(j), planner.id(i)], failure_reason::ALWAYS))
                }
                &[i, j] => Some(UnplannedAgents::of(planner.scenario, [planner.id(j), planner.id(i)], true)),
                agents => Some(UnplannedAgents::nowhere(
                    ids(agents),
                    "no start delays keep all of them apart: whatever the delays are, two of them meet",
                )),
            }
        };
        // Large fleets have thousands of conflicts.
        let told = parallel::map_parallel(0..self.conflicts.len(), &|conflict| of_conflict(&self.conflicts[conflict]));
        unsolved.extend(told.into_iter().flatten());
        if !self.fewest && planner.request.leave_out {
            let delays = self.delays.as_deref().unwrap_or_default();
            let explained = |agent: &usize| self.conflicts.iter().any(|conflict| conflict.contains(agent));
            let out: Vec<usize> =
                (0..delays.len()).filter(|agent| delays[*agent].is_none() && !explained(agent)).collect();
            if !out.is_empty() {
                let why = "no start delays were found for them beside all others before the search was stopped; nor was it \
                           proved that there are none";
                unsolved.push(UnplannedAgents::nowhere(ids(&out), why));
            }
        }
        let mut blocked = self.out.iter().filter(|out| !out.always);
        if unsolved.is_empty()
            && let Some(out) = blocked.next()
        {
            unsolved.push(UnplannedAgents::of(
                planner.scenario,
                [planner.id(out.agent), planner.id(out.blocked_by)],
                false,
            ));
        }
        if unsolved.is_empty() {
            let why = "no start delays were found before the search was stopped; nor was it proved that there are none";
            unsolved.push(UnplannedAgents::nowhere(Vec::new(), why));
        }
        unsolved
    }
}
