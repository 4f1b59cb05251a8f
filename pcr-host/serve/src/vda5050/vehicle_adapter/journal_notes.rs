//! What the journal remembers of a vehicle: notes about its order and pauses, and the ids of orders and actions that were used before. A message
//! with one of them is a late repetition.

use crate::robot::SupervisedRobot;
use crate::supervisor::JournalError;
use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::Value;

/// A note about a robot; `None` if there is none.
///
/// # Errors
/// [`JournalError`] where it cannot be read: without it, an order or a pause would be forgotten.
pub(super) fn noted<T: DeserializeOwned>(
    robot: Option<&SupervisedRobot>,
    key: &str,
) -> Result<Option<T>, JournalError> {
    let Some((robot, note)) = robot.and_then(|robot| Some((robot, robot.notes.get(key)?))) else { return Ok(None) };
    // A note that was taken back is null.
    Option::<T>::deserialize(note).map_err(|why| JournalError(format!("{}, {key}: {why}", robot.name)))
}

/// Number of ids that are kept at least: the last ones.
const MOST: usize = 64;

/// The used ids of one kind.
#[derive(Debug)]
pub(super) struct UsedIds {
    /// Key of the note in the journal.
    pub(super) key: &'static str,
    names: Vec<String>,
}

/// The change of the note for a new id.
pub(super) enum NoteChange {
    /// Elements to be appended.
    More(Vec<Value>),
    /// A new value of the note.
    All(Value),
}

impl UsedIds {
    /// Those that the journal has.
    ///
    /// # Errors
    /// [`JournalError`] where they are no list of names.
    pub(super) fn remembered(key: &'static str, robot: Option<&SupervisedRobot>) -> Result<Self, JournalError> {
        Ok(Self { key, names: noted(robot, key)?.unwrap_or_default() })
    }

    pub(super) fn contains(&self, name: &str) -> bool {
        self.names.iter().any(|known| known == name)
    }

    /// Adds an id. The list in the journal is shortened only sometimes, so that it is not written with every id.
    pub(super) fn push(&mut self, name: &str) -> NoteChange {
        self.names.push(name.to_owned());
        if self.names.len() <= 2 * MOST {
            return NoteChange::More(vec![name.into()]);
        }
        self.names.drain(..self.names.len() - MOST);
        NoteChange::All(self.all())
    }

    /// All ids, for the journal.
    pub(super) fn all(&self) -> Value {
        self.names.clone().into()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_names_are_known_and_the_journal_has_those() {
        let mut past = UsedIds { key: "orders", names: Vec::new() };
        let mut journal: Vec<Value> = Vec::new();
        for k in 0..500 {
            match past.push(&k.to_string()) {
                NoteChange::More(more) => journal.extend(more),
                NoteChange::All(all) => journal = all.as_array().unwrap().clone(),
            }
            assert_eq!(Value::from(journal.clone()), past.all());
            assert!((k.max(MOST - 1) + 1 - MOST..=k).all(|known| past.contains(&known.to_string())), "{k}");
            assert!(journal.len() <= 2 * MOST);
        }
        assert!(!past.contains("0"));
    }
}
