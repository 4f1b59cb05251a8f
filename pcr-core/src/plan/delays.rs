//! Fleet plans by start delays: each agent as early as those before it in the order allow.

use crate::ecm::{Ecm, Region};
use crate::motion::Motion;
use crate::pieces::Piece;
use crate::plan::order::{Blocked, Unsolved, complete, in_order, separated, verified};
use crate::query::earliest_start;
use crate::region::RegionRef;
use crate::scalar::Scalar;

/// Delays the starts of the agents so that none collides, and puts the motions into `plan`, in the order of the
/// fleet. It begins with motions of the same agents: those of the fleet, or an earlier plan.
///
/// `order` lists each agent of the fleet once, by priority, the highest first. It may come back changed: agents that could not
/// start otherwise are moved up, at most as often as there are agents.
/// Plan with radii that are larger by [`Encounter::tolerance`](crate::Encounter::tolerance), so that agents of the true
/// radii do not even touch.
///
/// Cost: a comparison a pair of agents, and for each agent that of [`earliest_start`] for its row, and again for those after one that is moved.
///
/// The plan is checked as a whole before it is returned: no overlap is deeper than the tolerance.
///
/// # Errors
/// [`Unsolved`] with the agents that cannot be planned; `plan` then holds the agents before them in `order`.
pub fn plan_delays<'m, S, R, P>(
    ecm: &Ecm<S, R, P>,
    fleet: &[Motion<'m, S>],
    plan: &mut [Motion<'m, S>],
    order: &mut [usize],
) -> Result<(), Unsolved>
where
    S: Scalar,
    R: AsRef<[Region]>,
    P: AsRef<[Piece<S>]>,
{
    complete(order, fleet.len())?;
    in_order(order, |before, agent| {
        let (Some(&motion), Some(planned)) = (fleet.get(agent), plan.get_mut(agent)) else {
            return Err(Blocked::Never(Unsolved::NoSuchAgent(agent)));
        };
        *planned = motion;
        let regions = ecm.row(plan, agent)?.filter(|region| before.contains(&region.other()));
        let delayed = earliest(motion, regions.clone()).ok_or_else(|| blocking(agent, regions, before))?;
        if let Some(planned) = plan.get_mut(agent) {
            *planned = delayed;
        }
        Ok(())
    })?;
    verified(ecm, plan, order)
}

/// The motion as early as the regions allow.
pub(super) fn earliest<'a, 'm, S: Scalar>(
    motion: Motion<'m, S>,
    regions: impl Iterator<Item = RegionRef<'a, S>> + Clone,
) -> Option<Motion<'m, S>> {
    earliest_start(regions, S::ZERO).and_then(|delay| motion.delayed(delay).ok())
}

/// Who forbids all late starts.
fn blocking<'a, S: Scalar>(
    agent: usize,
    regions: impl Iterator<Item = RegionRef<'a, S>> + Clone,
    before: &[usize],
) -> Blocked {
    let forever = |region: &RegionRef<'_, S>| region.forbidden_delays().hi >= S::LIMIT;
    let place = |region: &RegionRef<'_, S>| before.iter().position(|&other| other == region.other());
    let blocking = regions.filter(forever);
    // A region that forbids the early ones as well.
    let always = |region: &RegionRef<'_, S>| region.forbidden_delays().lo <= -S::LIMIT;
    if let Some(unsolved) = blocking.clone().filter(always).find_map(|region| separated(&region)) {
        return Blocked::Never(unsolved);
    }
    Blocked::By(blocking.min_by_key(place).map_or(agent, |region| region.other()))
}
