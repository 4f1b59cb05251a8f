//! What the journal remembers of a vehicle's order and pauses.

use crate::robot::Robot;
use crate::supervisor::Damaged;
use serde::Deserialize;
use serde::de::DeserializeOwned;

/// A note about a robot; `None` if there is none.
///
/// # Errors
/// [`Damaged`] where it cannot be read: without it, an order or a pause would be forgotten.
pub(super) fn noted<T: DeserializeOwned>(robot: Option<&Robot>, key: &str) -> Result<Option<T>, Damaged> {
    let Some((robot, note)) = robot.and_then(|robot| Some((robot, robot.notes.get(key)?))) else { return Ok(None) };
    // A note that was taken back is null.
    Option::<T>::deserialize(note).map_err(|why| Damaged(format!("{}, {key}: {why}", robot.name)))
}
