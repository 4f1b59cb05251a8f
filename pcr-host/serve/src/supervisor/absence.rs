//! Robots that are away: a person has said that they are switched off, or out of the area of the fleet. Nobody waits to hear from such a robot.
//! What it had stays reserved until it is removed, and as soon as it is heard again it is not away any more.
//!
//! And vehicles that are not away, and have not said where they stand: from the places where they may stand others keep away.

use super::Supervisor;
use crate::event::SupervisorEvent;
use crate::journal_entry::JournalEntry;
use crate::request_error::RequestError;
use std::collections::{BTreeMap, BTreeSet};

/// A disc in which a vehicle may stand, all of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StandingPlace {
    /// Centre \[m\].
    pub x: f64,
    /// \[m\]
    pub y: f64,
    /// Radius \[m\].
    pub radius: f64,
}

/// A vehicle that has not said where it stands.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct UnplacedVehicle {
    /// Why others wait for it, and what to do; `None` as long as it is too early to say so.
    pub why: Option<String>,
    /// Where it may stand, if that is known: others get no hold up to there, and stop if they have one. Where it is not known, this supervisor does
    /// not know whom it may block.
    pub places: Vec<StandingPlace>,
}

impl Supervisor {
    /// Takes the vehicles that have not said where they stand, by name, in place of those before. Returns whether they are others.
    pub(crate) fn set_unplaced(&mut self, unplaced: BTreeMap<String, UnplacedVehicle>) -> bool {
        if unplaced == self.unplaced {
            return false;
        }
        for (name, vehicle) in &unplaced {
            let before = self.unplaced.get(name).and_then(|before| before.why.as_ref());
            if let Some(why) = vehicle.why.as_ref().filter(|why| Some(*why) != before) {
                self.events.push(SupervisorEvent::Unplaced { robot: name.clone(), why: why.clone() });
            }
        }
        for (name, _) in self.unplaced.iter().filter(|(_, before)| before.why.is_some()) {
            if unplaced.get(name).is_none_or(|vehicle| vehicle.why.is_none()) {
                self.events.push(SupervisorEvent::Placed { robot: name.clone() });
            }
        }
        self.unplaced = unplaced;
        self.hazards = true;
        true
    }

    /// The vehicles that others wait for because they have not said where they stand, with the reason in words.
    pub fn unplaced(&self) -> impl Iterator<Item = (&str, &str)> {
        self.unplaced.iter().filter_map(|(name, vehicle)| Some((name.as_str(), vehicle.why.as_deref()?)))
    }

    /// Whether a robot, or a vehicle that is not in the supervisor yet, is away.
    pub fn is_away(&self, name: &str) -> bool {
        self.away.contains(name)
    }

    /// Names of the robots and vehicles that are away.
    pub fn away(&self) -> &BTreeSet<String> {
        &self.away
    }

    /// Takes the names of the vehicles that may be away although they are not in the supervisor. Of others that are not in it, it is forgotten
    /// that they were.
    ///
    /// # Errors
    /// [`RequestError::Broken`].
    pub fn expect(&mut self, names: BTreeSet<String>) -> Result<(), RequestError> {
        self.works()?;
        self.expected = names;
        let is_known = |name: &String| self.expected.contains(name) || self.names.contains_key(name);
        let unknown: Vec<String> = self.away.iter().filter(|name| !is_known(name)).cloned().collect();
        for name in unknown {
            self.away.remove(&name);
            self.entries.push(JournalEntry::Away { robot: name, away: false });
        }
        Ok(())
    }

    /// Notes that a robot is away, or no longer. While it is, it gets no holds and no missions, and its waiting mission is given up. Its place,
    /// its path and its holds stay reserved until it is [removed](Supervisor::remove). Returns whether it has a place.
    ///
    /// # Errors
    /// [`RequestError::NoSuchRobot`] for a name that is not [expected](Supervisor::expect) either; [`RequestError::Broken`].
    pub fn set_away(&mut self, name: &str, away: bool) -> Result<bool, RequestError> {
        self.works()?;
        let place = self.robot_index(name).ok();
        if place.is_none() && !self.expected.contains(name) {
            return Err(RequestError::NoSuchRobot);
        }
        let keeps_place = place.is_some();
        if self.is_away(name) == away {
            return Ok(keeps_place);
        }
        if away {
            if keeps_place {
                self.give_up(name)?;
            }
            self.away.insert(name.into());
        } else {
            self.away.remove(name);
        }
        if let Some(place) = place {
            let robot = &mut self.robots[place];
            (robot.away, robot.returned) = (away, false);
            (robot.silent, robot.alive) = (false, None);
        }
        self.entries.push(JournalEntry::Away { robot: name.into(), away });
        self.events.push(match away {
            true => SupervisorEvent::Away { robot: name.into(), keeps_place },
            false => SupervisorEvent::Back { robot: name.into() },
        });
        Ok(keeps_place)
    }

    /// A robot that was away is there again, as it has said itself.
    pub(super) fn comes_back(&mut self, name: &str) {
        if self.is_away(name) {
            // It is known, and the journal works.
            let _ = self.set_away(name, false);
        }
    }
}
