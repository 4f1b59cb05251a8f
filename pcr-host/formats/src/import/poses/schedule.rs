//! Plans of libMultiRobotPlanning: `schedule`, with a list of `x`, `y`, `t` for each agent.
//!
//! A step to a neighbouring cell takes 1 s and goes straight; agents begin at their first cell and stay in their last one.

use super::super::json_access::JsonObject;
use super::super::keys::Keys;
use super::super::{ImportError, Warnings};
use super::pose_log::{PoseLogBuilder, PoseTime, RawPose};
use crate::json::JsonNode;
use crate::plane_geometry::distance;

const STATE: Keys = Keys::new(&["x", "y", "t"], &[]);

/// Reads the plan in a document.
pub(super) fn read(
    root: &JsonNode<'_>,
    log: &mut PoseLogBuilder<'_>,
    warnings: &mut Warnings,
) -> Result<(), ImportError> {
    let plan = JsonObject::new("plan", root)?;
    let schedule = plan.object("schedule")?.ok_or_else(|| plan.missing("schedule"))?.called("schedule");
    (log.stands_at_ends, log.is_straight) = (true, true);
    for (name, states) in schedule.members() {
        let agent = log.agent(name);
        let name = log.name(agent);
        let list = states.as_array().filter(|states| !states.is_empty());
        let list = list
            .ok_or_else(|| ImportError::in_json(states.position, format!("{name}: a list of x, y, t is expected")))?;
        for state in list {
            let place = (state.position.line as usize, Some(state.position.column as usize));
            let state = JsonObject::new(&name, state)?;
            STATE.check(&state, warnings)?;
            let (point, t) = (state.point()?, state.required("t")?);
            let time = PoseTime::seconds(t);
            if let Some(last) = log.last(agent) {
                // What is no step of 1 s to a neighbour may be a wait and a step, or a slow one.
                let moved = distance(last.point, point);
                log.is_straight &= moved == 0.0 || (moved <= 1.0 && time.since(&last.time) == 1.0);
            }
            let map = log.map("");
            log.add(agent, RawPose { time, point, heading: None, error: 0.0, map, is_joined: true, place })?;
        }
    }
    Ok(())
}
