//! A pause of the whole fleet, which a person begins and ends. Everybody has to stop where he is, and keeps the authority that he has, so whatever
//! that reserves stays free for him; nobody is granted anything more, and no mission is admitted. Who is added, or comes back, is paused, too.

use super::Supervisor;
use super::waiting_missions::AdmissionRetry;
use crate::event::SupervisorEvent;
use crate::journal_entry::JournalEntry;
use crate::request_error::RequestError;
use serde::Serialize;
use std::collections::BTreeMap;

/// The name for which robots are stopped as long as the fleet is paused. No robot and no closed area has it.
pub const PAUSE: &str = "pause";

/// Largest number of vehicles that are named in the reason.
const NAMED: usize = 10;

/// Why it is not certain that a vehicle can be paused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PauseAbility {
    /// Its factsheet does not name `startPause` and `stopPause` as instant actions.
    Unable,
    /// It has sent no factsheet that lists its actions.
    Unknown,
}

/// The answer to a pause: vehicles that may not stop before the ends of their authority.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct PauseImpact {
    /// Vehicles that say that they cannot be paused.
    pub unable: Vec<String>,
    /// Vehicles that have not said whether they can.
    pub unknown: Vec<String>,
}

impl Supervisor {
    /// Pauses the whole fleet until it is [resumed](Supervisor::resume), also after a restart. Pausing it again changes nothing.
    ///
    /// # Errors
    /// [`RequestError::Broken`].
    pub fn pause(&mut self) -> Result<PauseImpact, RequestError> {
        self.works()?;
        if !std::mem::replace(&mut self.paused, true) {
            self.entries.push(JournalEntry::Paused { paused: true });
            self.note_pause();
        }
        let names = |ability| self.unpausable(ability).map(str::to_owned).collect();
        Ok(PauseImpact { unable: names(PauseAbility::Unable), unknown: names(PauseAbility::Unknown) })
    }

    /// Lets the fleet go on. Returns `false` if it was not paused.
    ///
    /// # Errors
    /// [`RequestError::Broken`].
    pub fn resume(&mut self) -> Result<bool, RequestError> {
        self.works()?;
        if !std::mem::take(&mut self.paused) {
            return Ok(false);
        }
        self.entries.push(JournalEntry::Paused { paused: false });
        self.events.push(SupervisorEvent::Resumed {});
        self.hazards = true;
        // Nobody could advance meanwhile: that is no standstill.
        self.robots.iter_mut().for_each(|robot| robot.moved = None);
        self.tries.values_mut().for_each(AdmissionRetry::hurry);
        Ok(true)
    }

    /// Whether the whole fleet is paused.
    pub fn is_paused(&self) -> bool {
        self.paused
    }

    /// That the fleet is paused, and who cannot be, in words; `None` if it is not.
    pub fn pause_reason(&self) -> Option<String> {
        Some(format!("the fleet {}", self.pause_state()?))
    }

    /// The same of the fleet, without its name.
    pub(crate) fn pause_state(&self) -> Option<String> {
        self.paused.then(|| {
            let unable: Vec<&str> = self.unpausable(PauseAbility::Unable).collect();
            if unable.is_empty() {
                return "is paused".to_owned();
            }
            let more = match unable.len().saturating_sub(NAMED) {
                0 => String::new(),
                more => format!(" and {more} others"),
            };
            let named = unable[..unable.len().min(NAMED)].join(", ");
            format!("is paused; {named}{more} cannot be paused, and may go on to the end of what was released")
        })
    }

    /// Tells that the fleet is paused.
    pub(super) fn note_pause(&mut self) {
        if let Some(why) = self.pause_reason() {
            self.events.push(SupervisorEvent::Paused { why });
            self.hazards = true;
        }
    }

    /// Takes the vehicles of which it is not certain that they can be paused, in place of those before.
    pub fn set_pause_abilities(&mut self, abilities: BTreeMap<String, PauseAbility>) {
        self.pause_abilities = abilities;
    }

    /// The vehicles that cannot be paused for this reason, by name.
    pub fn unpausable(&self, reason: PauseAbility) -> impl Iterator<Item = &str> {
        self.pause_abilities.iter().filter(move |(_, ability)| **ability == reason).map(|(name, _)| name.as_str())
    }
}
