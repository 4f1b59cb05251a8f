//! Speed plans for a fleet: start delays, `plan_speeds` with several orders, priority-based search, and replanning of
//! each agent while all others move as planned.

mod branching;

use super::PriorityRule;
use super::plan_context::Planner;
use super::plan_progress::PlanStage;
use crate::fleet::HostEcm;
use pcr_core::{
    Motion, PlanError as Never, Profile, RegionRef, SearchNode, SpeedPlan, SpeedPlanLimits, earliest_start, plan_speed,
    plan_speed_below, plan_speeds,
};

/// Largest number of phases of a planned profile.
const PHASES: usize = 128;

/// A planned profile.
pub(super) type HostSpeedProfile = Profile<f64, PHASES>;

/// The regions that an agent avoids.
type AvoidedRegions<'r, 'a> = &'r [RegionRef<'a, f64>];

/// Number of stations on a path: 256 cells.
const STATIONS: usize = 257;
/// Largest number of profiles: for each agent in small fleets, for the whole fleet, and at least for each agent.
const PROFILES: usize = 64;
const MOST: usize = 8_192;
const LEAST: usize = 16;
/// Rounds in which the agent with the largest loss is moved to the front.
const ROUNDS: usize = 8;
/// Rounds in which each agent is planned again.
const AGAIN: usize = 4;
/// Smallest gain that counts \[s\].
const SOONER: f64 = 1e-6;

/// Storage for the profiles of all attempts.
pub(super) fn pool(agents: usize) -> Vec<HostSpeedProfile> {
    vec![Profile::standing(); (PROFILES * agents).min(MOST).max(LEAST * agents)]
}

/// Motions, and the agents by the priority with which they were planned; it counts only if an order was asked for.
pub(super) type PlanWithOrder<'m> = (Vec<Motion<'m, f64>>, Vec<usize>);

/// The best motions so far, or why the orders that were tried gave none.
type BestPlan<'m> = Result<PlanWithOrder<'m>, Option<Never>>;

type ProfileBuffers<'m> = std::slice::IterMut<'m, HostSpeedProfile>;

/// The best motions found in these orders, beginning with known ones, and their order.
pub(super) fn plan<'m>(
    planner: &Planner<'_, 'm>,
    ecm: &HostEcm<f64>,
    mut orders: Vec<Vec<usize>>,
    known: Option<PlanWithOrder<'m>>,
    pool: &'m mut [HostSpeedProfile],
) -> Result<PlanWithOrder<'m>, Never> {
    // A part of the storage is kept for the last step.
    let (kept_back, pool) = pool.split_at_mut(AGAIN * planner.motions.len());
    let (mut room, mut last) = (pool.iter_mut(), kept_back.iter_mut());
    let mut stations = vec![SearchNode::EMPTY; STATIONS];
    let by_start = |plan: &[Motion<'_, f64>]| {
        let mut order: Vec<usize> = (0..plan.len()).collect();
        order.sort_by(|&a, &b| plan[a].time().lo.total_cmp(&plan[b].time().lo));
        order
    };
    if planner.request.priority == PriorityRule::Best {
        orders.extend(known.as_ref().map(|(plan, _)| by_start(plan)));
    }
    // At most so many orders, nodes of the search and rounds of replanning.
    let (tried, all) = (orders.len(), orders.len() + ROUNDS + branching::NODES + AGAIN);
    let tell = |done: usize| (planner.told)(PlanStage::Speeds, done, all);
    // No reason as long as nothing has been tried.
    let mut best: BestPlan<'m> = known.ok_or(None);
    let mut kept = Vec::new();
    for (done, order) in orders.into_iter().enumerate() {
        tell(done);
        kept = attempt(planner, ecm, order, &mut best, &mut room, &mut stations);
    }
    if planner.request.priority == PriorityRule::Best {
        for round in 0..ROUNDS {
            tell(tried + round);
            let Ok((plan, _)) = &best else { break };
            let cost = planner.cost(plan);
            let latest = (0..plan.len()).max_by(|&a, &b| late(planner, plan, a).total_cmp(&late(planner, plan, b)));
            let Some(latest) = latest.filter(|latest| kept.first() != Some(latest)) else { break };
            let order = std::iter::once(latest).chain(kept.into_iter().filter(|&agent| agent != latest)).collect();
            kept = attempt(planner, ecm, order, &mut best, &mut room, &mut stations);
            if best.as_ref().is_ok_and(|(plan, _)| planner.cost(plan) >= cost) {
                break;
            }
        }
        let limit = best.as_ref().map_or(f64::INFINITY, |(plan, _)| planner.cost(plan));
        if let Some(plan) =
            branching::searched(planner, ecm, limit, &mut room, &mut stations, &|nodes| tell(tried + ROUNDS + nodes))
        {
            best = Ok((plan, Vec::new()));
        }
        if let Ok((plan, _)) = &mut best {
            tell(all - AGAIN);
            improve_each(planner, ecm, plan, &mut last, &mut stations);
        }
    }
    best.map_err(|never| never.expect("there is an order at least, which was tried"))
}

/// The earliest arrival of one agent while the others keep their motions: with other speeds, or, if its own motion is slower
/// than its limits for a reason, also with that motion and a later start.
enum AgentReplan<'m> {
    Speeds(Box<SpeedPlan<f64, PHASES>>),
    Later(Motion<'m, f64>),
}

impl<'m> AgentReplan<'m> {
    /// Uses the row of the agent in this motion: a delay counts from the motion of the row.
    fn of(motion: &Motion<'m, f64>, regions: AvoidedRegions<'_, '_>, stations: &mut [SearchNode<f64>]) -> Option<Self> {
        let Some(drive) = SpeedPlanLimits::of(motion) else {
            let later = earliest_start(regions.iter().cloned(), 0.0).and_then(|delay| motion.delayed(delay).ok());
            let plan = plan_speed_below(motion, regions.iter().cloned(), &[], stations).ok();
            let sooner = |end: f64| later.is_none_or(|later| end < later.time().hi - SOONER);
            return match plan.filter(|plan| sooner(plan.end())) {
                Some(plan) => Some(Self::Speeds(Box::new(plan))),
                None => later.map(Self::Later),
            };
        };
        plan_speed(motion, drive, regions.iter().cloned(), &[], stations).ok().map(|plan| Self::Speeds(Box::new(plan)))
    }

    /// Time of arrival \[s\].
    fn end(&self) -> f64 {
        match self {
            Self::Speeds(plan) => plan.end(),
            Self::Later(motion) => motion.time().hi,
        }
    }

    /// The motion, with its profile in `room`; `None` if there is no room.
    fn motion(self, motion: Motion<'m, f64>, room: &mut ProfileBuffers<'m>) -> Option<Motion<'m, f64>> {
        match self {
            Self::Speeds(plan) => {
                let profile = room.next()?;
                *profile = plan.profile;
                motion.with_profile(profile.as_profile(), plan.start).ok()
            }
            Self::Later(motion) => Some(motion),
        }
    }
}

/// Time by which an agent arrives later than it would alone \[s\].
fn late(planner: &Planner<'_, '_>, plan: &[Motion<'_, f64>], agent: usize) -> f64 {
    plan[agent].time().hi - planner.motions[agent].time().hi
}

/// Plans one agent after the other; returns the order to which this led.
fn attempt<'m>(
    planner: &Planner<'_, 'm>,
    ecm: &HostEcm<f64>,
    mut order: Vec<usize>,
    best: &mut BestPlan<'m>,
    room: &mut ProfileBuffers<'m>,
    stations: &mut [SearchNode<f64>],
) -> Vec<usize> {
    let mut plan = planner.motions.to_vec();
    let done = plan_speeds(ecm, planner.motions, &mut plan, &mut order, room, stations);
    match (done, &best) {
        (Ok(()), Ok((before, _))) if planner.cost(&plan) >= planner.cost(before) => {}
        (Ok(()), _) => *best = Ok((plan, order.clone())),
        (Err(never), Err(before)) => *best = Err(Some(more_general_reason(*before, never))),
        (Err(_), Ok(_)) => {}
    }
    order
}

/// The reason to tell after one more order without a plan: what holds for any order tells more than why the first one failed.
fn more_general_reason(before: Option<Never>, now: Never) -> Never {
    match (before, now) {
        (_, Never::Starts(_) | Never::Ends(_) | Never::Always(_)) | (None, _) => now,
        (Some(before), _) => before,
    }
}

/// Plans each agent again while the others keep their motions, the agent with the largest loss first.
fn improve_each<'m>(
    planner: &Planner<'_, 'm>,
    ecm: &HostEcm<f64>,
    plan: &mut [Motion<'m, f64>],
    room: &mut ProfileBuffers<'m>,
    stations: &mut [SearchNode<f64>],
) {
    for _ in 0..AGAIN {
        let mut order: Vec<usize> = (0..plan.len()).collect();
        order.sort_by(|&a, &b| late(planner, plan, b).total_cmp(&late(planner, plan, a)));
        let mut sooner = false;
        for agent in order {
            let motion = planner.motions[agent];
            // Delays count from the motion of the row, which is that of the file.
            let before = std::mem::replace(&mut plan[agent], motion);
            // The table does not hold for plans that take longer than `LONGEST`.
            let row = ecm.row(plan, agent).map(|row| row.collect::<Vec<RegionRef<'_, f64>>>());
            let found = row.ok().and_then(|regions| AgentReplan::of(&motion, &regions, stations));
            let found = found.filter(|found| found.end() < before.time().hi - SOONER);
            let better = found.and_then(|found| found.motion(motion, room));
            sooner |= better.is_some();
            plan[agent] = better.unwrap_or(before);
        }
        if !sooner {
            return;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_reason_stays_unless_another_one_holds_for_any_order() {
        let (full, later) = (Never::Full(0), Never::Priorities([1, 2]));
        assert_eq!(more_general_reason(None, full), full);
        assert_eq!(more_general_reason(Some(full), later), full, "that there was no room is not forgotten");
        assert_eq!(more_general_reason(Some(later), full), later);
        assert_eq!(more_general_reason(Some(full), Never::Always([1, 2])), Never::Always([1, 2]));
    }
}
