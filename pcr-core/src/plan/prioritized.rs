//! Plans agents one after the other by priority, and changes the order if an agent cannot be planned.
//!
//! If an agent has no plan because of one of higher priority (which parks on its path, or passes over its start), it is
//! moved up before that one, and planning continues from there. The number of such moves is limited.

use crate::ecm::{Ecm, EcmEntry};
use crate::error::{InvalidInput, MismatchError};
use crate::geometry::Interval;
use crate::motion::Motion;
use crate::piece_store::Piece;
use crate::region::RegionRef;
use crate::scalar::Scalar;

/// Agents for which no plan was found, and the reason.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum PlanError {
    /// Their discs overlap at the starts of their paths.
    Starts([usize; 2]),
    /// Their discs overlap at the ends of their paths.
    Ends([usize; 2]),
    /// They meet however they move: head-on without a passing place, or each stands on the path of the other.
    Always([usize; 2]),
    /// There is no plan for the first agent, because of the second one, with the priorities that were tried.
    Priorities([usize; 2]),
    /// The check of the finished plan found that these two overlap.
    Overlap([usize; 2]),
    /// There is not enough room for the plan of this agent (profiles, phases or stations).
    Full(usize),
    /// The plan of this agent cannot be a motion: its times are out of range, for example.
    Invalid {
        /// Index of the agent in the fleet.
        agent: usize,
        /// What is wrong with it.
        reason: InvalidInput,
    },
    /// The fleet has no such agent, or the numbers of plans and motions differ.
    NoSuchAgent(usize),
    /// The order does not list this agent exactly once. An agent that is left out would be ignored by all others.
    NotOnce(usize),
    /// The table does not belong to the fleet, or `plan` does not begin with motions of the same agents.
    Table(MismatchError),
}

impl From<MismatchError> for PlanError {
    fn from(mismatch: MismatchError) -> Self {
        Self::Table(mismatch)
    }
}

impl core::fmt::Display for PlanError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Starts([a, b]) => write!(f, "agents {a} and {b} of the fleet overlap at their starts"),
            Self::Ends([a, b]) => write!(f, "agents {a} and {b} of the fleet overlap at the ends of their paths"),
            Self::Always([a, b]) => write!(f, "agents {a} and {b} of the fleet meet however they move"),
            Self::Priorities([a, b]) => write!(f, "agent {a} of the fleet cannot go because of agent {b}"),
            Self::Overlap([a, b]) => write!(f, "agents {a} and {b} of the fleet overlap by the plan"),
            Self::Full(agent) => write!(f, "there is no room for a plan of agent {agent} of the fleet"),
            Self::Invalid { agent, reason } => write!(f, "there is no plan of agent {agent} of the fleet: {reason}"),
            Self::NoSuchAgent(agent) => write!(f, "the fleet has no agent {agent}"),
            Self::NotOnce(agent) => write!(f, "the order of priorities does not list agent {agent} of the fleet once"),
            Self::Table(mismatch) => mismatch.fmt(f),
        }
    }
}

impl core::error::Error for PlanError {}

/// Why an agent cannot be planned.
pub(super) enum AgentPlanError {
    /// Because of another agent, with the present priorities.
    By(usize),
    /// With any priorities.
    Never(PlanError),
}

impl From<MismatchError> for AgentPlanError {
    fn from(mismatch: MismatchError) -> Self {
        Self::Never(mismatch.into())
    }
}

/// Refuses an order that does not list every agent once: an agent that is left out would not be planned, and the others
/// would not avoid it.
pub(super) fn complete(order: &[usize], agents: usize) -> Result<(), PlanError> {
    if let Some(&agent) = order.iter().find(|&&agent| agent >= agents) {
        return Err(PlanError::NoSuchAgent(agent));
    }
    let listed = |agent: usize| {
        let mut places = order.iter().filter(move |&&other| other == agent);
        places.next().is_some() && places.next().is_none()
    };
    (0..agents).find(|&agent| !listed(agent)).map_or(Ok(()), |agent| Err(PlanError::NotOnce(agent)))
}

/// Plans the agents in order, each one after those before it; the order may change.
pub(super) fn in_order(
    order: &mut [usize],
    mut plan: impl FnMut(&[usize], usize) -> Result<(), AgentPlanError>,
) -> Result<(), PlanError> {
    let mut moves = order.len();
    let mut place = 0_usize;
    while let Some(&agent) = order.get(place) {
        let before = order.get(..place).unwrap_or_default();
        match plan(before, agent) {
            Ok(()) => place = place.wrapping_add(1),
            Err(AgentPlanError::Never(unsolved)) => return Err(unsolved),
            Err(AgentPlanError::By(by)) => {
                let to = before.iter().position(|&other| other == by);
                let (Some(to), Some(left)) = (to, moves.checked_sub(1)) else {
                    return Err(PlanError::Priorities([agent, by]));
                };
                let mut moved = agent;
                order
                    .iter_mut()
                    .take(place.wrapping_add(1))
                    .skip(to)
                    .for_each(|place| core::mem::swap(place, &mut moved));
                (place, moves) = (to, left);
            }
        }
    }
    Ok(())
}

/// Refuses a plan in which an agent overlaps with one before it in the order, by more than a rounding.
pub(super) fn verified<S, R, P>(
    ecm: &Ecm<S, R, P>,
    fleet: &[Motion<'_, S>],
    plan: &[Motion<'_, S>],
    order: &[usize],
) -> Result<(), PlanError>
where
    S: Scalar,
    R: AsRef<[EcmEntry]>,
    P: AsRef<[Piece<S>]>,
{
    let time = order.iter().filter_map(|&agent| plan.get(agent)).map(Motion::time).reduce(Interval::hull);
    let time = time.unwrap_or_default();
    // `enumerate` would check its counter for overflow.
    for (place, &agent) in (0..order.len()).zip(order) {
        let motion = plan.get(agent).ok_or(PlanError::NoSuchAgent(agent))?;
        let before = order.get(..place).unwrap_or_default();
        let regions = ecm.row_of_plan(fleet, plan, agent)?.filter(|region| before.contains(&region.other()));
        if let Some(region) = regions.into_iter().find(|region| region.overlap(motion, time).is_some()) {
            return Err(PlanError::Overlap([agent, region.other()]));
        }
    }
    Ok(())
}

/// Whether two agents meet in this region however they move, and why.
///
/// The region is connected. The ego cannot pass before the other agent if the region reaches the ego's end or the
/// other's start, and not after it if the region reaches the ego's start or the other's end. If both hold, the region
/// separates the starts of both from the ends of both.
pub(super) fn separated<S: Scalar>(region: &RegionRef<'_, S>) -> Option<PlanError> {
    let agents = [region.ego(), region.other()];
    let (ego, other) = (region.ego_motion().path().length(), region.other_motion().path().length());
    (region.lets_pass() == [false; 2]).then(|| {
        if region.covers(S::ZERO, S::ZERO) {
            PlanError::Starts(agents)
        } else if region.covers(ego, other) {
            PlanError::Ends(agents)
        } else {
            PlanError::Always(agents)
        }
    })
}
