//! Zones of one robot, which its manager has sent it: it gets no authority into some, and is slower in others. Whoever sets them keeps them.

use super::Supervisor;
use super::areas::Area;
use super::waiting_missions::AdmissionRetry;
use crate::request_error::RequestError;

/// A zone.
#[derive(Clone, Debug, PartialEq)]
pub struct ZoneArea {
    /// Its name in messages.
    pub name: String,
    /// Its corners \[m\], in either direction of rotation.
    pub corners: Vec<[f64; 2]>,
    /// Largest speed in it \[m/s\]; `None`: the robot may not enter it.
    pub speed: Option<f64>,
}

impl ZoneArea {
    /// # Errors
    /// [`RequestError::Invalid`] for corners that are no simple polygon, or out of range.
    fn area(&self) -> Result<Area, RequestError> {
        Area::within(self.name.clone(), self.speed, &self.corners)
    }

    /// Checks that paths can be compared with it.
    ///
    /// # Errors
    /// What is wrong with its corners.
    pub fn check(&self) -> Result<(), RequestError> {
        self.area().map(drop)
    }
}

impl Supervisor {
    /// Whether a robot has zones.
    pub(crate) fn has_zones(&self, robot: &str) -> bool {
        self.zones.contains_key(robot)
    }

    /// Takes the zones of a robot in place of those before, whether it is here or not. They are not in the journal.
    ///
    /// # Errors
    /// [`RequestError::Invalid`] for a zone that is no polygon; nothing has changed then.
    pub fn set_zones(&mut self, robot: &str, zones: &[ZoneArea]) -> Result<(), RequestError> {
        let areas = zones.iter().map(ZoneArea::area).collect::<Result<Vec<Area>, RequestError>>()?;
        if areas.is_empty() {
            self.zones.remove(robot);
        } else {
            self.zones.insert(robot.into(), areas);
        }
        self.areas_changed();
        // Missions that have waited for it are tried now.
        self.tries.values_mut().for_each(AdmissionRetry::hurry);
        Ok(())
    }
}
