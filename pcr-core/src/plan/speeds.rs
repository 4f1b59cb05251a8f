//! Fleet plans by speeds: each agent arrives as early as the agents before it in the order allow.

use crate::ecm::{Ecm, EcmEntry};
use crate::error::InvalidInput;
use crate::geometry::Interval;
use crate::motion::Motion;
use crate::piece_store::Piece;
use crate::plan::delays::{self, earliest};
use crate::plan::limits::SpeedPlanLimits;
use crate::plan::prioritized::{AgentPlanError, PlanError, complete, in_order, separated, verified};
use crate::plan::result::{SpeedPlan, SpeedPlanError};
use crate::plan::search_node::SearchNode;
use crate::plan::speed::{plan_speed, plan_speed_below};
use crate::profile::Profile;
use crate::region::RegionRef;
use crate::scalar::Scalar;

/// Plans how fast the agents move along their paths so that none collide, and puts the motions into `plan`, in the
/// order of the fleet. On entry `plan` holds motions of the same agents: those of the fleet, or an earlier plan.
///
/// Each agent keeps the largest speed and acceleration of its motion in the fleet, and begins and ends at the same
/// speeds ([`SpeedPlanLimits::of`]). It gets the plan of [`plan_speed`] or its own profile with a later start, whichever arrives
/// first. If its own motion is slower on its way than these limits allow, for example because it turns in place, it gets
/// the plan of [`plan_speed_below`], and is nowhere faster than that motion. `order` and the radii are as in
/// [`plan_delays`](crate::plan_delays). Every plan of an agent takes one of the `profiles`: one for each agent, and one
/// more each time that an agent is planned again because another one was moved up. Their contents are overwritten.
///
/// Cost: for each agent that of [`plan_speed`] and [`earliest_start`](crate::earliest_start); agents behind one that is
/// moved up are planned again.
///
/// The whole plan is checked before the function returns: no overlap is deeper than the tolerance.
///
/// # Errors
/// [`PlanError`], with the agents that cannot be planned; `plan` then holds the agents before them in `order`.
pub fn plan_speeds<'m, S, R, P, const N: usize>(
    ecm: &Ecm<S, R, P>,
    fleet: &[Motion<'m, S>],
    plan: &mut [Motion<'m, S>],
    order: &mut [usize],
    profiles: impl IntoIterator<Item = &'m mut Profile<S, N>>,
    stations: &mut [SearchNode<S>],
) -> Result<(), PlanError>
where
    S: Scalar,
    R: AsRef<[EcmEntry]>,
    P: AsRef<[Piece<S>]>,
{
    let mut profiles = profiles.into_iter();
    complete(order, fleet.len())?;
    in_order(order, |before, agent| {
        let (Some(&motion), Some(planned)) = (fleet.get(agent), plan.get_mut(agent)) else {
            return Err(AgentPlanError::Never(PlanError::NoSuchAgent(agent)));
        };
        *planned = motion;
        let chosen = {
            let regions = ecm.row_of_plan(fleet, plan, agent)?.filter(|region| before.contains(&region.other()));
            let invalid = |reason| AgentPlanError::Never(PlanError::Invalid { agent, reason });
            let (later, late) = match earliest(motion, regions.clone()) {
                Ok(later) => (later, None),
                Err(reason) => (None, Some(reason)),
            };
            // An arrival that is earlier only by a rounding does not justify another profile.
            let earlier = |end: S| {
                later.is_none_or(|later| end < later.time().hi - Interval::new(motion.time().lo, end).resolution())
            };
            let drive = SpeedPlanLimits::of(&motion);
            let speeds: Result<SpeedPlan<S, N>, _> = match drive {
                Some(drive) => plan_speed(&motion, drive, regions.clone(), &[], stations),
                None => plan_speed_below(&motion, regions.clone(), &[], stations),
            };
            match speeds {
                Ok(speeds) if earlier(speeds.end()) => {
                    let profile = profiles.next().ok_or(AgentPlanError::Never(PlanError::Full(agent)))?;
                    *profile = speeds.profile;
                    motion.with_profile(profile.as_profile(), speeds.start).map_err(invalid)
                }
                // There is no room for other speeds, or there are none, as without acceleration: what is left are start delays.
                Err(SpeedPlanError::Invalid(reason)) if drive.is_none() || !matches!(reason, InvalidInput::Full(_)) => {
                    later.ok_or_else(|| late.map_or_else(|| delays::blocking(agent, regions, before), invalid))
                }
                speeds => later.ok_or_else(|| late.map_or_else(|| blocking(agent, regions, speeds.err()), invalid)),
            }
        }?;
        if let Some(planned) = plan.get_mut(agent) {
            *planned = chosen;
        }
        Ok(())
    })?;
    verified(ecm, fleet, plan, order)
}

/// How to react to this reason.
fn blocking<'a, S: Scalar>(
    agent: usize,
    mut regions: impl Iterator<Item = RegionRef<'a, S>>,
    reason: Option<SpeedPlanError<S>>,
) -> AgentPlanError {
    match reason {
        Some(SpeedPlanError::AtStart(other) | SpeedPlanError::AtGoal(other) | SpeedPlanError::Beyond { other, .. }) => {
            // Another region than the first that was found may have no remedy.
            let never = regions.find_map(|region| separated(&region));
            never.map_or(AgentPlanError::By(other), AgentPlanError::Never)
        }
        _ => AgentPlanError::Never(PlanError::Full(agent)),
    }
}
