//! Fleet plans by start delays: each agent starts as early as the agents before it in the order allow.

use crate::ecm::{Ecm, EcmEntry};
use crate::error::InvalidInput;
use crate::motion::Motion;
use crate::piece_store::Piece;
use crate::plan::prioritized::{AgentPlanError, PlanError, complete, in_order, separated, verified};
use crate::query::earliest_start;
use crate::region::RegionRef;
use crate::scalar::Scalar;

/// Delays the starts of the agents so that none collide, and puts the motions into `plan`, in the order of the fleet.
/// On entry `plan` holds motions of the same agents: those of the fleet, or an earlier plan.
///
/// `order` lists each agent of the fleet once, the highest priority first. It may come back changed: an agent that
/// could not start otherwise is moved up. The number of such moves is at most the number of agents. Plan with radii
/// that are larger by [`Encounter::tolerance`](crate::Encounter::tolerance), so that agents of the true radii do not
/// even touch.
///
/// Cost: a comparison for each pair of agents, and for each agent that of [`earliest_start`] for its row; agents behind
/// one that is moved up are planned again.
///
/// The whole plan is checked before the function returns: no overlap is deeper than the tolerance.
///
/// # Errors
/// [`PlanError`], with the agents that cannot be planned; `plan` then holds the agents before them in `order`.
pub fn plan_delays<'m, S, R, P>(
    ecm: &Ecm<S, R, P>,
    fleet: &[Motion<'m, S>],
    plan: &mut [Motion<'m, S>],
    order: &mut [usize],
) -> Result<(), PlanError>
where
    S: Scalar,
    R: AsRef<[EcmEntry]>,
    P: AsRef<[Piece<S>]>,
{
    complete(order, fleet.len())?;
    in_order(order, |before, agent| {
        let (Some(&motion), Some(planned)) = (fleet.get(agent), plan.get_mut(agent)) else {
            return Err(AgentPlanError::Never(PlanError::NoSuchAgent(agent)));
        };
        *planned = motion;
        let regions = ecm.row_of_plan(fleet, plan, agent)?.filter(|region| before.contains(&region.other()));
        let delayed = match earliest(motion, regions.clone()) {
            Ok(delayed) => delayed.ok_or_else(|| blocking(agent, regions, before))?,
            Err(reason) => return Err(AgentPlanError::Never(PlanError::Invalid { agent, reason })),
        };
        if let Some(planned) = plan.get_mut(agent) {
            *planned = delayed;
        }
        Ok(())
    })?;
    verified(ecm, fleet, plan, order)
}

/// The motion with the earliest start that the regions allow, if they allow any.
///
/// # Errors
/// The start, or the end of the motion, is out of range.
pub(super) fn earliest<'a, 'm, S: Scalar>(
    motion: Motion<'m, S>,
    regions: impl Iterator<Item = RegionRef<'a, S>> + Clone,
) -> Result<Option<Motion<'m, S>>, InvalidInput> {
    earliest_start(regions, S::ZERO).map(|delay| motion.delayed(delay)).transpose()
}

/// The agent that forbids all late starts.
pub(super) fn blocking<'a, S: Scalar>(
    agent: usize,
    regions: impl Iterator<Item = RegionRef<'a, S>> + Clone,
    before: &[usize],
) -> AgentPlanError {
    let forever = |region: &RegionRef<'_, S>| region.forbidden_delays().hi >= S::LIMIT;
    let place = |region: &RegionRef<'_, S>| before.iter().position(|&other| other == region.other());
    let blocking = regions.filter(forever);
    // Whether a region forbids all early starts as well.
    let always = |region: &RegionRef<'_, S>| region.forbidden_delays().lo <= -S::LIMIT;
    if let Some(unsolved) = blocking.clone().filter(always).find_map(|region| separated(&region)) {
        return AgentPlanError::Never(unsolved);
    }
    // None is forbidden for good, so that what is free is out of range.
    let invalid = AgentPlanError::Never(PlanError::Invalid { agent, reason: InvalidInput::OutOfRange("delay") });
    blocking.min_by_key(place).map_or(invalid, |region| AgentPlanError::By(region.other()))
}
