//! The one map of all vehicles.

use super::VehicleAdapter;
use crate::robot::SupervisedRobot;
use crate::supervisor::Supervisor;
use pcr_formats::vda5050::decode::DecodeError;
use pcr_formats::vda5050::state::ErrorEntry;
use pcr_formats::vda5050::version::OrderRejection;

/// Key of the note with the map of the vehicle.
pub(super) const MAP: &str = "map";

/// The map of a vehicle, if it is known.
pub(super) fn map_of(robot: &SupervisedRobot) -> Option<&str> {
    robot.notes.get(MAP)?.as_str()
}

impl VehicleAdapter {
    /// Checks that the vehicle is on the same map as the others.
    ///
    /// # Errors
    /// [`DecodeError`] if the others are on another map: vehicles that can never meet would block one another. The manager is told.
    pub(super) fn shares(&mut self, supervisor: &Supervisor, map: &str) -> Result<(), DecodeError> {
        let others = supervisor.robots().iter().filter(|robot| robot.name != self.name);
        let Some(other) = others.filter_map(map_of).find(|other| *other != map) else {
            self.elsewhere = None;
            return Ok(());
        };
        let why = format!("{map:?}; other vehicles are on {other:?}, and one supervisor is for one map");
        let refusal = DecodeError::new("position.mapId", why);
        self.elsewhere = Some(refusal.to_string());
        Err(refusal)
    }

    /// Why the reported position is ignored.
    pub fn elsewhere(&self) -> Option<&str> {
        self.elsewhere.as_deref()
    }

    /// The same as an error in states to the manager.
    pub(super) fn elsewhere_error(&self) -> Option<ErrorEntry> {
        Some(ErrorEntry::warning(self.version?.error(OrderRejection::Order), self.elsewhere.clone()?, &[]))
    }
}
