//! Fleet plans by speeds: each agent arrives as early as those before it in the order allow.

use crate::ecm::{Ecm, Region};
use crate::motion::Motion;
use crate::pieces::Piece;
use crate::plan::delays::earliest;
use crate::plan::lattice::Drive;
use crate::plan::order::{Blocked, Unsolved, complete, in_order, separated, verified};
use crate::plan::outcome::NoSpeedPlan;
use crate::plan::speed::plan_speed;
use crate::plan::station::Station;
use crate::profile::Profile;
use crate::region::RegionRef;
use crate::scalar::Scalar;

/// Plans how fast the agents go along their paths so that none collides, and puts the motions into `plan`, in the
/// order of the fleet. It begins with motions of the same agents: those of the fleet, or an earlier plan.
///
/// Each agent goes under the largest speed and acceleration of the motion that the fleet gives it, and begins and ends
/// at the same speeds ([`Drive::of`]): by [`plan_speed`], or as given but later, whichever arrives first. `order` is as in
/// [`plan_delays`](crate::plan_delays), and so are the radii. Every plan of an agent takes a profile of `profiles`, one
/// for each agent and one for each that is planned again, because another one was moved up; what is there is overwritten.
///
/// Cost: for each agent that of [`plan_speed`] and [`earliest_start`](crate::earliest_start), and again for those after
/// one that is moved.
///
/// The plan is checked as a whole before it is returned: no overlap is deeper than the tolerance.
///
/// # Errors
/// [`Unsolved`] with the agents that cannot be planned; `plan` then holds the agents before them in `order`.
pub fn plan_speeds<'m, S, R, P, const N: usize>(
    ecm: &Ecm<S, R, P>,
    fleet: &[Motion<'m, S>],
    plan: &mut [Motion<'m, S>],
    order: &mut [usize],
    profiles: impl IntoIterator<Item = &'m mut Profile<S, N>>,
    stations: &mut [Station<S>],
) -> Result<(), Unsolved>
where
    S: Scalar,
    R: AsRef<[Region]>,
    P: AsRef<[Piece<S>]>,
{
    let mut profiles = profiles.into_iter();
    complete(order, fleet.len())?;
    in_order(order, |before, agent| {
        let (Some(&motion), Some(planned)) = (fleet.get(agent), plan.get_mut(agent)) else {
            return Err(Blocked::Never(Unsolved::NoSuchAgent(agent)));
        };
        *planned = motion;
        let chosen = {
            let regions = ecm.row(plan, agent)?.filter(|region| before.contains(&region.other()));
            let later = earliest(motion, regions.clone());
            // What is but a rounding earlier is not worth another profile.
            let earlier = |end: S| later.is_none_or(|later| end < later.time().hi - S::tolerance(end.abs()));
            match plan_speed::<S, N>(&motion, Drive::of(&motion), regions.clone(), &[], stations) {
                Ok(speeds) if earlier(speeds.end()) => {
                    let full = || Blocked::Never(Unsolved::Full(agent));
                    let profile = profiles.next().ok_or_else(full)?;
                    *profile = speeds.profile;
                    motion.with_profile(profile.as_profile(), speeds.start).map_err(|_| full())
                }
                other => later.ok_or_else(|| blocking(agent, regions, other.err())),
            }
        }?;
        if let Some(planned) = plan.get_mut(agent) {
            *planned = chosen;
        }
        Ok(())
    })?;
    verified(ecm, plan, order)
}

/// What is to be done about a reason.
fn blocking<'a, S: Scalar>(
    agent: usize,
    mut regions: impl Iterator<Item = RegionRef<'a, S>>,
    reason: Option<NoSpeedPlan<S>>,
) -> Blocked {
    match reason {
        Some(NoSpeedPlan::AtStart(other) | NoSpeedPlan::AtGoal(other) | NoSpeedPlan::Beyond { other, .. }) => {
            // Another one than the first that was found may be without remedy.
            let never = regions.find_map(|region| separated(&region));
            never.map_or(Blocked::By(other), Blocked::Never)
        }
        _ => Blocked::Never(Unsolved::Full(agent)),
    }
}
