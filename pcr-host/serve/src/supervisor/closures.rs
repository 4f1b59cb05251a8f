//! Areas that a person has closed: nobody gets authority into them, and no mission through them is admitted. Where only the speed is limited,
//! robots are told on which lengths of their paths.
//!
//! An area is all that is within a distance of a path, so it can be an edge, a node, or a lane of any width. Whoever is in it for certain
//! drives on. Whoever holds authority into it keeps that, and is stopped: if it comes to rest before the area it waits there, and if it cannot,
//! it drives through as soon as it is in it.

use super::areas::{Area, entry};
use super::waiting_missions::AdmissionRetry;
use super::{PAUSE, Supervisor};
use crate::closed_area::{AreaLengths, ClosedArea};
use crate::journal_entry::JournalEntry;
use crate::owned_path::FAR;
use crate::request_error::RequestError;
use crate::robot::SupervisedRobot;
use pcr_formats::scenario::label;
use serde::Serialize;

/// Least and largest speed to which an area may be limited \[m/s\].
const SLOWEST: f64 = 1e-3;
const FASTEST: f64 = 1e4;

/// What an area that is being closed means to the robots there.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct ClosureImpact {
    /// Robots that are in it, and drive on: with a limited speed as slow as that as soon as they have braked.
    pub through: Vec<String>,
    /// Robots that hold authority into it, and are stopped if they move.
    pub stopped: Vec<String>,
    /// Robots whose paths lead into it; they get authority up to it.
    pub before: Vec<String>,
}

/// A closed area with its path.
#[derive(Clone, Debug)]
pub(super) struct ClosedPath {
    pub(super) area: ClosedArea,
    pub(super) is: Area,
}

impl ClosedPath {
    pub(super) fn new(area: ClosedArea) -> Result<Self, RequestError> {
        if area.name.is_empty() || label(&area.name) != area.name {
            return Err(RequestError::invalid("closure: the name of an area is 1 to 200 printable characters"));
        }
        if area.name == PAUSE {
            return Err(RequestError::invalid("closure: the pause of the fleet has this name"));
        }
        if !(area.radius > 0.0 && area.radius <= FAR) {
            return Err(RequestError::invalid(format!("radius: above 0, up to {FAR} m is allowed")));
        }
        if let Some(speed) = area.speed.filter(|speed| !(SLOWEST..=FASTEST).contains(speed)) {
            return Err(RequestError::invalid(format!(
                "speed: {speed} is out of range; allowed is {SLOWEST} to {FASTEST}"
            )));
        }
        let courses = area.courses().map_err(RequestError::invalid)?;
        let is = Area::along(area.name.clone(), area.speed, courses, area.radius)?;
        Ok(Self { area, is })
    }
}

/// Whether a robot is in an area, as far as it has certainly come.
fn contains(lengths: &AreaLengths, robot: &SupervisedRobot) -> bool {
    let mut lengths = lengths.iter().flatten();
    lengths.any(|length| length.lo <= robot.arc_length && robot.arc_length <= length.hi)
}

impl Supervisor {
    /// Closes an area until it is [opened](Supervisor::open). Closing it again changes nothing.
    ///
    /// # Errors
    /// [`RequestError::Invalid`] for a name that a robot or another area has, and for a path or radius out of range; [`RequestError::Broken`].
    pub fn close(&mut self, area: ClosedArea) -> Result<ClosureImpact, RequestError> {
        self.works()?;
        if self.names.contains_key(&area.name) {
            return Err(RequestError::invalid("closure: a robot has this name"));
        }
        let closed = ClosedPath::new(area)?;
        match self.closures.get(&closed.area.name) {
            Some(known) if known.area == closed.area => {}
            Some(_) => {
                return Err(RequestError::invalid("closure: another area of this name is closed; open it first"));
            }
            None => {
                self.entries.push(JournalEntry::Closed(closed.area.clone()));
                self.closures.insert(closed.area.name.clone(), closed.clone());
                self.areas_changed();
            }
        }
        let mut impact = ClosureImpact::default();
        for robot in &self.robots {
            let lengths = closed.is.lengths(&robot.course, &robot.body);
            let list = match entry(&lengths, robot) {
                _ if contains(&lengths, robot) => &mut impact.through,
                Some(entry) if closed.is.is_shut() && entry < robot.notified_limit => &mut impact.stopped,
                Some(_) => &mut impact.before,
                None => continue,
            };
            list.push(robot.name.clone());
        }
        Ok(impact)
    }

    /// Opens an area again. Returns `false` if there is none of this name.
    ///
    /// # Errors
    /// [`RequestError::Broken`].
    pub fn open(&mut self, name: &str) -> Result<bool, RequestError> {
        self.works()?;
        if self.closures.remove(name).is_none() {
            return Ok(false);
        }
        self.entries.push(JournalEntry::Opened { closure: name.into() });
        self.areas_changed();
        // Missions that have waited for it are tried now.
        self.tries.values_mut().for_each(AdmissionRetry::hurry);
        Ok(true)
    }

    /// The closed areas, by name.
    pub fn closures(&self) -> impl Iterator<Item = &ClosedArea> {
        self.closures.values().map(|closed| &closed.area)
    }
}
