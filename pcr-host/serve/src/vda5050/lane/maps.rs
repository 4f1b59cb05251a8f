//! The one map of all vehicles.

use super::super::door::Refusal;
use super::super::state::StateError;
use super::super::version::Error;
use super::Lane;
use crate::robot::Robot;
use crate::supervisor::Supervisor;

/// The note of the map on which a vehicle is.
pub(super) const MAP: &str = "map";

/// The map on which a vehicle is known to be.
pub(super) fn map_of(robot: &Robot) -> Option<&str> {
    robot.notes.get(MAP)?.as_str()
}

impl Lane {
    /// Whether the vehicle can stand on a map.
    ///
    /// # Errors
    /// [`Refusal`] if the others are on another one: vehicles that never meet would be in the way of one another. The manager is told.
    pub(super) fn shares(&mut self, supervisor: &Supervisor, map: &str) -> Result<(), Refusal> {
        let others = supervisor.robots().iter().filter(|robot| robot.name != self.name);
        let Some(other) = others.filter_map(map_of).find(|other| *other != map) else {
            self.elsewhere = None;
            return Ok(());
        };
        let why = format!("{map:?}; other vehicles are on {other:?}, and one supervisor is for one map");
        let refusal = Refusal::new("position.mapId", why);
        self.elsewhere = Some(refusal.to_string());
        Err(refusal)
    }

    /// Why it does not stand where it says.
    pub fn elsewhere(&self) -> Option<&str> {
        self.elsewhere.as_deref()
    }

    /// The same, for its manager.
    pub(super) fn elsewhere_error(&self) -> Option<StateError> {
        Some(StateError::warning(self.version?.error(Error::Order), self.elsewhere.clone()?, &[]))
    }
}
