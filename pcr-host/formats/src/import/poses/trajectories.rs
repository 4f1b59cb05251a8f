//! Results of db-CBS: `result`, with `states` for each robot, of which the first two numbers are x and y. The time between two states is
//! not in the file.

use super::super::json_access::JsonObject;
use super::super::keys::Keys;
use super::super::{ImportError, PoseOptions, Warnings};
use super::pose_log::{PoseLogBuilder, PoseTime, RawPose};
use crate::json::JsonNode;
use crate::scenario::LIMIT;

const ROBOT: Keys = Keys::new(&["states", "num_states"], &["actions", "num_actions"]);

/// Reads the trajectories in a document.
pub(super) fn read(
    root: &JsonNode<'_>,
    options: &PoseOptions,
    log: &mut PoseLogBuilder<'_>,
    warnings: &mut Warnings,
) -> Result<(), ImportError> {
    let file = JsonObject::new("file", root)?;
    let Some(step) = options.step else {
        return Err(file.field_error("result", "the time between two states is not in the file; give --step"));
    };
    log.stands_at_ends = true;
    for (k, robot) in file.list("result")?.iter().enumerate() {
        let agent = log.agent(&k.to_string());
        let robot = JsonObject::new(log.name(agent), robot)?;
        ROBOT.check(&robot, warnings)?;
        let states = robot.list("states")?;
        if states.is_empty() {
            return Err(robot.field_error("states", "no state"));
        }
        if let Some(count) = robot.number("num_states")?
            && count != states.len() as f64
        {
            return Err(robot.field_error("num_states", format_args!("{count}, and there are {}", states.len())));
        }
        for (index, state) in states.iter().enumerate() {
            let number =
                |index: usize| state.element(index).and_then(JsonNode::as_f64).filter(|it: &f64| it.abs() <= LIMIT);
            let (Some(x), Some(y)) = (number(0), number(1)) else {
                let problem = format!("{}, state {index}: a list that begins with x and y is expected", robot.name);
                return Err(ImportError::in_json(state.position, problem));
            };
            let place = (state.position.line as usize, Some(state.position.column as usize));
            let (time, map) = (PoseTime::seconds(index as f64 * step), log.map(""));
            log.add(agent, RawPose { time, point: [x, y], heading: None, error: 0.0, map, is_joined: true, place })?;
        }
    }
    Ok(())
}
