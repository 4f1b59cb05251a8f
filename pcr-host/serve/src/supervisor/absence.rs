//! Robots that are away: a person has said that they are switched off, or out of the area of the fleet. Nobody waits to hear from such a robot.
//! What it had stays reserved until it is removed, and as soon as it is heard again it is not away any more.

use super::Supervisor;
use crate::event::SupervisorEvent;
use crate::journal_entry::JournalEntry;
use crate::request_error::RequestError;
use std::collections::BTreeSet;

impl Supervisor {
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
