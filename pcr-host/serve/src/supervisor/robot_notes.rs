//! Notes that other modules store about robots.

use super::Supervisor;
use crate::journal_entry::JournalEntry;
use crate::request_error::RequestError;
use crate::robot::remember;
use serde::Serialize;
use serde_json::Value;

impl Supervisor {
    /// Stores a note about a robot, also in the journal, until the robot is removed.
    ///
    /// # Errors
    /// [`RequestError::NoSuchRobot`]; [`RequestError::Broken`], also for a note that is no JSON: it would be forgotten, so nothing may be
    /// told any more.
    pub fn note(&mut self, name: &str, key: &str, note: impl Serialize) -> Result<(), RequestError> {
        self.works()?;
        let place = self.robot_index(name)?;
        let note = self.json(key, note)?;
        self.robots[place].notes.insert(key.into(), note.clone());
        self.entries.push(JournalEntry::Note { robot: name.into(), key: key.into(), note });
        Ok(())
    }

    /// Appends to a note that is a list; a missing note is an empty list. The journal grows by the new elements only.
    ///
    /// # Errors
    /// As [`Supervisor::note`], and [`RequestError::Invalid`] if the note is not a list.
    pub fn note_more(&mut self, name: &str, key: &str, more: &[impl Serialize]) -> Result<(), RequestError> {
        self.works()?;
        let place = self.robot_index(name)?;
        let more = more.iter().map(|it| self.json(key, it)).collect::<Result<Vec<_>, _>>()?;
        if !remember(&mut self.robots[place].notes, key, &more) {
            return Err(RequestError::invalid(format!("{key}: what is remembered is no list")));
        }
        self.entries.push(JournalEntry::More { robot: name.into(), key: key.into(), more });
        Ok(())
    }

    fn json(&mut self, key: &str, note: impl Serialize) -> Result<Value, RequestError> {
        serde_json::to_value(note).map_err(|error| self.breaks(format!("{key}: {error}")))
    }
}
