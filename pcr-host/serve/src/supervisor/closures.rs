//! Areas that a person has closed: nobody gets authority into them, and no mission through them is admitted. Where only the speed is limited,
//! robots are told on which lengths of their paths.
//!
//! An area is all that is within a distance of a path, so it can be an edge, a node, or a lane of any width. Whoever is in it for certain
//! drives on. Whoever holds authority into it keeps that, and is stopped: if it comes to rest before the area it waits there, and if it cannot,
//! it drives through as soon as it is in it.

use super::alarms::{AlarmLimit, LimitCause};
use super::{PAUSE, Supervisor};
use crate::closed_area::{ClosedArea, SpeedLimit};
use crate::event::SupervisorEvent;
use crate::journal_entry::JournalEntry;
use crate::owned_path::{FAR, OwnedPath};
use crate::request_error::RequestError;
use crate::robot::{ROOM, SupervisedRobot};
use pcr_core::{Ecm, Interval};
use pcr_formats::scenario::label;
use pcr_planning::fleet::ConvexBody;
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
    courses: Vec<OwnedPath>,
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
        for course in &courses {
            course.motion(&ConvexBody::Disc(area.radius)).map_err(RequestError::invalid)?;
        }
        Ok(Self { area, courses })
    }

    /// The lengths of a path on which a body touches the area; `None` if they cannot be computed.
    pub(super) fn lengths(&self, course: &OwnedPath, body: &ConvexBody) -> Option<Vec<Interval<f64>>> {
        let disc = ConvexBody::Disc(self.area.radius);
        let mut lengths = Vec::new();
        for own in &self.courses {
            let fleet = [course.motion(body).ok()?, own.motion(&disc).ok()?];
            let ecm = Ecm::grown(&fleet).ok()?;
            lengths.extend(ecm.pair(&fleet, 0, 1).ok()?.map(|region| region.length()));
        }
        Some(lengths)
    }

    /// Whether nobody may enter.
    fn is_shut(&self) -> bool {
        self.area.speed.is_none()
    }

    /// The length of a robot's path at which it would come into the area, from where it is; `None` if it never does, or if it is in it.
    /// Whatever cannot be computed is as near as the robot.
    fn entry(&self, robot: &SupervisedRobot) -> Option<f64> {
        let Some(lengths) = self.lengths(&robot.course, &robot.body) else { return Some(robot.arc_length) };
        let ahead = lengths.iter().filter(|length| length.lo > robot.arc_length);
        ahead.map(|length| length.lo).reduce(f64::min)
    }

    /// Whether a robot is in the area, as far as it has certainly come.
    fn contains(&self, robot: &SupervisedRobot) -> bool {
        let lengths = self.lengths(&robot.course, &robot.body).unwrap_or_default();
        lengths.iter().any(|length| length.lo <= robot.arc_length && robot.arc_length <= length.hi)
    }
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
                self.closure_revision += 1;
                self.hazards = true;
            }
        }
        let mut impact = ClosureImpact::default();
        for robot in &self.robots {
            let list = match closed.entry(robot) {
                _ if closed.contains(robot) => &mut impact.through,
                Some(entry) if closed.is_shut() && entry < robot.notified_limit => &mut impact.stopped,
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
        self.closure_revision += 1;
        self.hazards = true;
        // Missions that have waited for it are tried now.
        self.tries.values_mut().for_each(super::waiting_missions::AdmissionRetry::hurry);
        Ok(true)
    }

    /// The closed areas, by name.
    pub fn closures(&self) -> impl Iterator<Item = &ClosedArea> {
        self.closures.values().map(|closed| &closed.area)
    }

    /// The first closed area into which a path leads beyond what a robot has been allowed already, except where the robot is in it.
    pub(super) fn closed_on(&self, course: &OwnedPath, body: &ConvexBody, at: f64, told: f64) -> Option<&str> {
        let leads_into = |closed: &&ClosedPath| match closed.lengths(course, body) {
            Some(lengths) => lengths.iter().any(|length| length.lo > at && length.lo >= told - ROOM),
            None => true,
        };
        self.closures
            .values()
            .filter(|closed| closed.is_shut())
            .find(leads_into)
            .map(|closed| closed.area.name.as_str())
    }

    /// Limits because of closed areas.
    pub(super) fn closed_areas(&self, limits: &mut [AlarmLimit]) {
        for (index, closed) in self.closures.values().enumerate().filter(|(_, closed)| closed.is_shut()) {
            for (robot, limit) in self.robots.iter().zip(limits.iter_mut()) {
                if let Some(entry) = closed.entry(robot) {
                    limit.lower(entry - ROOM, LimitCause::Closed(index));
                }
            }
        }
    }

    /// The limits of the speed on a path, by name and length. Where it cannot be computed, all of the path is limited.
    pub(crate) fn speed_limits(&self, course: &OwnedPath, body: &ConvexBody) -> Vec<SpeedLimit> {
        let limits = self.closures.values().filter_map(|closed| Some((closed, closed.area.speed?)));
        let limits = limits.flat_map(|(closed, speed)| {
            let all = || vec![Interval::new(0.0, course.length())];
            let lengths = closed.lengths(course, body).unwrap_or_else(all);
            let limit = move |length: Interval<f64>| SpeedLimit {
                closure: closed.area.name.clone(),
                length: [length.lo.max(0.0), length.hi.min(course.length())],
                speed,
            };
            lengths.into_iter().map(limit)
        });
        limits.collect()
    }

    /// A number that changes whenever an area is closed or opened.
    pub(crate) fn closure_revision(&self) -> u64 {
        self.closure_revision
    }

    /// Whether the speed is limited anywhere.
    pub(crate) fn limits_speed(&self) -> bool {
        self.closures.values().any(|closed| !closed.is_shut())
    }

    /// Tells robots where their speed is limited, before they get any authority there: on a new path, and when a limit begins or ends.
    pub(super) fn tell_speed_limits(&mut self) {
        let limits_any = self.limits_speed();
        for place in 0..self.robots.len() {
            let robot = &self.robots[place];
            let known = (robot.path, self.closure_revision);
            if robot.limits_at == Some(known) || !limits_any && robot.speed_limits.is_empty() {
                continue;
            }
            let limits = self.speed_limits(&robot.course, &robot.body);
            let is_new_path = robot.limits_at.is_none_or(|(path, _)| path != robot.path);
            let is_news = if is_new_path { !limits.is_empty() } else { limits != robot.speed_limits };
            if is_news {
                let (robot, path, limits) = (robot.name.clone(), robot.path, limits.clone());
                self.events.push(SupervisorEvent::Limits { robot, path, limits });
            }
            let robot = &mut self.robots[place];
            (robot.speed_limits, robot.limits_at) = (limits, Some(known));
        }
    }
}
