//! What the journal remembers of a vehicle's order and pauses.

use crate::robot::SupervisedRobot;
use crate::supervisor::JournalError;
use serde::Deserialize;
use serde::de::DeserializeOwned;

/// A note about a robot; `None` if there is none.
///
/// # Errors
/// [`JournalError`] where it cannot be read: without it, an order or a pause would be forgotten.
pub(super) fn noted<T: DeserializeOwned>(
    robot: Option<&SupervisedRobot>,
    key: &str,
) -> Result<Option<T>, JournalError> {
    let Some((robot, note)) = robot.and_then(|robot| Some((robot, robot.notes.get(key)?))) else { return Ok(None) };
    // A note that was taken back is null.
    Option::<T>::deserialize(note).map_err(|why| JournalError(format!("{}, {key}: {why}", robot.name)))
}
