//! How much room is missing beside one in whose way a robot stands, and with what smaller drift there would be enough.
//!
//! Passing orders keep a margin for how far robots may be off their paths. A plan without errors may lead closer past a robot that stands than two
//! such margins; then nobody sets off.

use super::replan::{Blocker, ClearanceEntry, ReplanProblem, RobotState};
use super::robot_estimate::RobotEstimate;
use pcr_planning::fleet::ConvexBody;

/// Returns the room between the way of a robot that has not set off and what stands beside it; `None` if that is in the way also where nobody is
/// off the path. `problem` has the missions that wait, with the bodies that plans use, and `drift` is the drift of the run \[m\].
pub(super) fn missing_clearance(
    agents: &[RobotEstimate],
    problem: &ReplanProblem<'_>,
    (robot, by): (usize, Blocker),
    drift: f64,
) -> Option<ClearanceEntry> {
    /// Number of bisections: from decimetres down to less than a nanometre.
    const STEPS: usize = 30;
    let off = |place: usize| agents.get(place).map_or(0.0, |agent| agent.off);
    let (needed, drifting) = match by {
        Blocker::Robot(other) => (off(robot) + off(other), 2.0),
        Blocker::Obstacle(_) => (off(robot), 1.0),
    };
    // Whether it could pass if all were off their paths by this share of what they may be.
    let passes = |share: f64| -> Option<bool> {
        let bodies = agents.iter().map(|agent| agent.body.inflated(share * agent.off).ok());
        let bodies: Vec<ConvexBody> = bodies.collect::<Option<_>>()?;
        let states = problem.robots.iter().zip(bodies).map(|(state, body)| RobotState { body, ..state.clone() });
        let states: Vec<RobotState> = states.collect();
        let smaller = ReplanProblem { robots: &states, ..*problem };
        Some(smaller.in_the_way(robot, |other| by == Blocker::Robot(other)).is_none())
    };
    if !passes(0.0)? {
        return None;
    }
    let (mut lo, mut hi) = (0.0, 1.0);
    for _ in 0..STEPS {
        let middle = 0.5 * (lo + hi);
        if passes(middle)? { lo = middle } else { hi = middle }
    }
    let free = lo * needed;
    let enough = drift - (needed - free) / drifting;
    Some(ClearanceEntry { free, needed, drift: (enough >= 0.0).then_some(enough) })
}
