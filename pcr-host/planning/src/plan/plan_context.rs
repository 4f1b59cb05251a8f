//! Data that all attempts at a plan share: the fleet, the options, orders to try, and the cost of a plan.

use super::circular_wait;
use super::delays::Objective;
use super::plan_progress::{PlanProgressFn, PlanStage};
use super::{PlanOptions, PriorityRule};
use crate::agent_regions;
use crate::failure::ComputationError;
use crate::fleet::HostEcm;
use crate::regions;
use pcr_core::Motion;
use pcr_formats::scenario::Scenario;
use std::time::Instant;

/// Largest number of agents for which the table of all pairs is computed repeatedly.
const MOST: usize = 2_000;

/// The data shared by all attempts.
pub(super) struct Planner<'a, 'm> {
    pub(super) scenario: &'a Scenario,
    pub(super) request: &'a PlanOptions,
    /// Motions with their margins.
    pub(super) motions: &'a [Motion<'m, f64>],
    /// When planning began.
    pub(super) begin: Instant,
    /// Who waits for the plan.
    pub(super) told: PlanProgressFn<'a>,
}

impl Planner<'_, '_> {
    /// Whether the time that planning may take is over.
    pub(super) fn is_late(&self) -> bool {
        self.request.effort.time.is_some_and(|time| self.begin.elapsed() >= time)
    }

    /// Tells how much of the checks of a plan is done: the check of the discs, that of margins, and the proof count alike.
    pub(super) fn tell_check(&self, pass: usize, done: usize, all: usize) {
        (self.told)(PlanStage::Check, pass * all + done, 3 * all);
    }

    pub(super) fn id(&self, agent: usize) -> u64 {
        self.scenario.agents[agent].id
    }

    /// The table of all pairs, for speed plans.
    pub(super) fn ecm(&self) -> Result<HostEcm<f64>, ComputationError> {
        match self.motions.len() {
            ..=MOST => regions::table(self.scenario, self.motions),
            agents => Err(ComputationError::TooMany { what: "speeds are planned", agents, most: MOST }),
        }
    }

    /// A circle of agents in which each has to let the next one pass first; not searched in large fleets.
    pub(super) fn circle(&self) -> Option<Vec<usize>> {
        circular_wait::circle(&self.ecm().ok()?, self.motions)
    }

    /// The number of regions of each agent.
    fn counts(&self) -> Result<Vec<usize>, ComputationError> {
        let pairs = agent_regions::gathered(self.motions, "regions", &|_, _| {}, |row| {
            let regions = row.table().row(row.motions(), row.agent_index()).expect("the table of the row");
            regions.map(|region| [row.agents()[row.agent_index()], row.agents()[region.other()]]).collect()
        })?;
        let mut counts = vec![0; self.motions.len()];
        pairs.into_iter().flatten().for_each(|agent| counts[agent as usize] += 1);
        Ok(counts)
    }

    /// The orders of priority to try.
    pub(super) fn orders(&self) -> Result<Vec<Vec<usize>>, ComputationError> {
        let ids: Vec<u64> = self.scenario.agents.iter().map(|agent| agent.id).collect();
        let file: Vec<usize> = (0..ids.len()).collect();
        let place = |id: &u64| {
            ids.iter().position(|there| there == id).ok_or_else(|| ComputationError::NoSuchAgent(*id, ids.clone()))
        };
        let sorted = |key: &dyn Fn(usize) -> f64| {
            let mut order = file.clone();
            order.sort_by(|&a, &b| key(b).total_cmp(&key(a)));
            order
        };
        let longest = || sorted(&|agent| self.motions[agent].time().length());
        let crowded = || self.counts().map(|counts| sorted(&|agent| counts[agent] as f64));
        Ok(match &self.request.priority {
            PriorityRule::Given(given) => {
                let mut order = given.iter().map(place).collect::<Result<Vec<usize>, ComputationError>>()?;
                let rest: Vec<usize> = file.iter().copied().filter(|agent| !order.contains(agent)).collect();
                order.extend(rest);
                vec![order]
            }
            PriorityRule::Longest => vec![longest()],
            PriorityRule::Crowded => vec![crowded()?],
            PriorityRule::Best => vec![file.clone(), longest(), crowded()?],
        })
    }

    /// The objective for these motions \[s\].
    pub(super) fn cost(&self, planned: &[Motion<'_, f64>]) -> f64 {
        match self.request.objective {
            Objective::Sum => {
                self.motions.iter().zip(planned).map(|(given, planned)| planned.time().hi - given.time().lo).sum()
            }
            Objective::Makespan => {
                let begin = self.begin();
                planned.iter().map(|planned| planned.time().hi).fold(begin, f64::max) - begin
            }
        }
    }

    /// The earliest start in the file, of the agents that are not left out \[s\].
    pub(super) fn begin(&self) -> f64 {
        self.motions.iter().map(|motion| motion.time().lo).reduce(f64::min).unwrap_or(0.0)
    }
}
