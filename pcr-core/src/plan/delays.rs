//! Fleet plans by start delays: agents in an order of priority, each as early as those before it allow.
//!
//! An agent that cannot start at any time because of one of higher priority (that parks on its way, or passes over its
//! start) is moved up before it in the order, and the search goes on from there; a bounded number of times.

use crate::ecm::{Ecm, Region};
use crate::motion::Motion;
use crate::pieces::Piece;
use crate::query::earliest_start;
use crate::region::RegionRef;
use crate::scalar::Scalar;

/// Two agents for which no plan was found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Unsolved {
    /// Whenever they start, they meet: head-on without a passing place, or starts or ends inside one another's disc.
    Always([usize; 2]),
    /// The first cannot start with the priorities that were tried, because of the second.
    Priorities([usize; 2]),
    /// There is no such agent, or not as many plans as motions.
    NoSuchAgent(usize),
}

impl core::fmt::Display for Unsolved {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Always([a, b]) => write!(f, "agents {a} and {b} of the fleet meet whenever they start"),
            Self::Priorities([a, b]) => write!(f, "agent {a} of the fleet cannot start because of agent {b}"),
            Self::NoSuchAgent(agent) => write!(f, "the fleet has no agent {agent}"),
        }
    }
}

impl core::error::Error for Unsolved {}

/// Delays the starts of the agents so that none collides, and puts the motions into `plan`, in the order of the
/// fleet.
///
/// `order` lists the agents by priority, the highest first; agents that are not in it are left out of the plan. It may
/// come back changed: agents that could not start otherwise are moved up, at most as often as there are agents in it.
/// Plan with radii that are larger by [`Encounter::tolerance`](crate::Encounter::tolerance), so that agents of the true
/// radii do not even touch.
///
/// Cost: for each agent that of [`earliest_start`] for its row, and again for those after one that is moved.
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
    if let Some(&missing) = order.iter().find(|&&agent| agent >= fleet.len() || agent >= plan.len()) {
        return Err(Unsolved::NoSuchAgent(missing));
    }
    let mut moves = order.len();
    let mut place = 0;
    while let Some(&agent) = order.get(place) {
        let before = order.get(..place).unwrap_or_default();
        match earliest(ecm, fleet, plan, before, agent) {
            Ok(motion) => {
                if let Some(planned) = plan.get_mut(agent) {
                    *planned = motion;
                }
                place = place.wrapping_add(1);
            }
            Err(Blocked { by, always: true }) => return Err(Unsolved::Always([agent, by])),
            Err(Blocked { by, always: false }) => {
                let to = before.iter().position(|&other| other == by);
                let (Some(to), Some(left)) = (to, moves.checked_sub(1)) else {
                    return Err(Unsolved::Priorities([agent, by]));
                };
                if let Some(moved) = order.get_mut(to..=place) {
                    moved.rotate_right(1);
                }
                (place, moves) = (to, left);
            }
        }
    }
    Ok(())
}

/// Why an agent cannot start: because of another one, with any delay of either or with late ones only.
struct Blocked {
    by: usize,
    always: bool,
}

/// The motion of an agent, as early as those before it allow; or the first of them that does not.
fn earliest<'m, S, R, P>(
    ecm: &Ecm<S, R, P>,
    fleet: &[Motion<'m, S>],
    plan: &mut [Motion<'m, S>],
    before: &[usize],
    agent: usize,
) -> Result<Motion<'m, S>, Blocked>
where
    S: Scalar,
    R: AsRef<[Region]>,
    P: AsRef<[Piece<S>]>,
{
    let (Some(&motion), Some(planned)) = (fleet.get(agent), plan.get_mut(agent)) else {
        return Err(Blocked { by: agent, always: true });
    };
    *planned = motion;
    let regions = ecm.row(plan, agent).filter(|region| before.contains(&region.other()));
    let delayed = earliest_start(regions.clone(), S::ZERO).and_then(|delay| motion.delayed(delay).ok());
    delayed.ok_or_else(|| {
        let forever = |region: &RegionRef<'_, S>| region.forbidden_delays().hi >= S::LIMIT;
        let always = |region: &RegionRef<'_, S>| region.forbidden_delays().lo <= -S::LIMIT;
        let place = |region: &RegionRef<'_, S>| before.iter().position(|&other| other == region.other());
        let blocking = regions.filter(forever);
        let worst = blocking.clone().find(always);
        let first = worst.clone().or_else(|| blocking.min_by_key(place));
        Blocked { by: first.map_or(agent, |region| region.other()), always: worst.is_some() }
    })
}
