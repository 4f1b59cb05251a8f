//! What all attempts at a plan have in common: the fleet, what is asked for, orders to be tried, and what a plan costs.

use super::delays::Objective;
use super::{Priority, Request};
use crate::fleet::HostEcm;
use crate::regions::Failure;
use pcr_core::Motion;
use pcr_formats::scenario::Scenario;

/// What all attempts have in common.
pub(super) struct Planner<'a, 'm> {
    pub(super) scenario: &'a Scenario,
    pub(super) request: &'a Request,
    /// Grown.
    pub(super) motions: &'a [Motion<'m, f64>],
    pub(super) ecm: &'a HostEcm<f64>,
}

impl Planner<'_, '_> {
    pub(super) fn id(&self, agent: usize) -> u64 {
        self.scenario.agents.get(agent).map_or(0, |agent| agent.id)
    }

    /// The orders to be tried.
    pub(super) fn orders(&self) -> Result<Vec<Vec<usize>>, Failure> {
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
        Ok(match &self.request.priority {
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

    /// What the objective is of these motions \[s\].
    pub(super) fn cost(&self, planned: &[Motion<'_, f64>]) -> f64 {
        match self.request.objective {
            Objective::Sum => {
                self.motions.iter().zip(planned).map(|(given, planned)| planned.time().hi - given.time().lo).sum()
            }
            Objective::Makespan => {
                planned.iter().map(|planned| planned.time().hi).fold(0.0, f64::max).max(self.begin()) - self.begin()
            }
        }
    }

    /// The earliest start in the file \[s\].
    pub(super) fn begin(&self) -> f64 {
        self.motions.iter().map(|motion| motion.time().lo).reduce(f64::min).unwrap_or(0.0)
    }
}
