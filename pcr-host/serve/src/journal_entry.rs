//! The entries of the journal: everything that must be the same after a restart.

use crate::closed_area::ClosedArea;
use crate::owned_path::{OwnedPath, PathRounding};
use crate::page_layout::PageLayout;
use crate::robot::{Alarm, MissionFingerprint, PendingMission, RobotNotes, RobotTraits};
use pcr_core::PassingState;
use serde::{Deserialize, Serialize};
use serde_json::Value;

/// How a robot passes a region: a `PassingState` in the form that the journal stores.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum StoredPassingState {
    /// Both robots stay before the region.
    Undecided,
    /// The robot goes first.
    First,
    /// The robot goes second.
    Second,
    /// The order no longer holds anyone.
    Over,
}

impl From<PassingState> for StoredPassingState {
    fn from(pass: PassingState) -> Self {
        match pass {
            PassingState::Undecided => Self::Undecided,
            PassingState::First => Self::First,
            PassingState::Second => Self::Second,
            PassingState::Over => Self::Over,
        }
    }
}

impl From<StoredPassingState> for PassingState {
    fn from(side: StoredPassingState) -> Self {
        match side {
            StoredPassingState::Undecided => Self::Undecided,
            StoredPassingState::First => Self::First,
            StoredPassingState::Second => Self::Second,
            StoredPassingState::Over => Self::Over,
        }
    }
}

/// A passing order of a robot with another one. The orders of a pair are in the sequence of their regions.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StoredPrecedence {
    /// Name of the other robot.
    pub with: String,
    /// How the robot passes the region.
    pub pass: StoredPassingState,
    /// Length of the second robot from which on the order counts \[m\].
    #[serde(rename = "since")]
    pub active_from: f64,
    /// Lengths of the region on the paths of the robot and of the other one \[m\]: a library that computes other regions is
    /// detected by these.
    pub lengths: [[f64; 2]; 2],
}

/// A robot with all its orders.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct StoredRobot {
    /// Name of the robot.
    pub name: String,
    /// Its abilities.
    pub abilities: RobotTraits,
    /// Whether it may have any heading on its present path.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub any_heading: bool,
    /// Its present path.
    pub course: OwnedPath,
    /// What is missing from the start of the path.
    #[serde(default, skip_serializing_if = "PathRounding::is_nothing")]
    pub rest: PathRounding,
    /// Number of the path.
    pub path: u64,
    /// Where the path begins, as a length of the way since the robot was added \[m\].
    pub origin: f64,
    /// Id of the mission that it got last.
    pub mission: Option<String>,
    /// Request of that mission.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub asked: Option<MissionFingerprint>,
    /// Ids of earlier missions.
    pub past: Vec<String>,
    /// Length that it has certainly reached \[m\].
    #[serde(rename = "at")]
    pub arc_length: f64,
    /// Length up to which it may have been allowed to go \[m\].
    pub ceiling: f64,
    /// Its alarm, if there is one.
    pub alarm: Option<Alarm>,
    /// Its waiting mission, if there is one.
    pub waiting: Option<PendingMission>,
    /// Its orders with all other robots; they replace all that it had before.
    pub orders: Vec<StoredPrecedence>,
    /// Notes that other modules have stored about it.
    #[serde(default, skip_serializing_if = "RobotNotes::is_empty")]
    pub notes: RobotNotes,
}

/// A change of the state.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(tag = "entry", rename_all = "snake_case")]
pub enum JournalEntry {
    /// A new layout.
    Layout(PageLayout),
    /// A new robot, or a robot with a new path.
    Robot(Box<StoredRobot>),
    /// A robot was removed.
    Removed {
        /// Name of the robot.
        robot: String,
    },
    /// Path numbers up to this one may have been used by robots that were removed.
    Spent {
        /// The highest such number.
        path: u64,
    },
    /// A robot may be allowed to go up to this length, and has not been allowed to go further: the last such entry counts.
    Ceiling {
        /// Name of the robot.
        robot: String,
        /// Number of its path.
        path: u64,
        /// Length of the path \[m\].
        #[serde(rename = "ceiling")]
        persisted_limit: f64,
    },
    /// Lengths that robots have certainly reached.
    Places {
        /// Name of the robot, number of its path, and length \[m\].
        places: Vec<(String, u64, f64)>,
    },
    /// A mission waits, or no longer waits.
    Waiting {
        /// Name of the robot.
        robot: String,
        /// The waiting mission; `None` if there is none any more.
        waiting: Option<PendingMission>,
    },
    /// A note about a robot.
    Note {
        /// Name of the robot.
        robot: String,
        /// Key of the note.
        key: String,
        /// The new value of the note.
        note: Value,
    },
    /// More elements for a note that is a list.
    More {
        /// Name of the robot.
        robot: String,
        /// Key of the note.
        key: String,
        /// Elements to be appended.
        more: Vec<Value>,
    },
    /// A robot, or a vehicle that is not there yet, is away, or no longer. (Not in journals of version 3.)
    Away {
        /// Name of the robot.
        robot: String,
        /// Whether it is away.
        away: bool,
    },
    /// An area is closed, or the speed in it is limited. (Not in journals of version 3.)
    Closed(ClosedArea),
    /// An area is open again. (Not in journals of version 3.)
    Opened {
        /// Name of the area.
        closure: String,
    },
    /// The whole fleet is paused, or goes on. (Not in journals of version 3.)
    Paused {
        /// Whether it is paused.
        paused: bool,
    },
    /// The alarm of a robot has begun, changed or ended.
    Alarm {
        /// Name of the robot.
        robot: String,
        /// The alarm; `None` if it has ended.
        alarm: Option<Alarm>,
    },
}

/// Storage of changes. Changes are stored before they are sent to robots or clients.
pub trait JournalStore: Send {
    /// Stores these changes permanently, all or none.
    ///
    /// # Errors
    /// The changes may not be stored. Nothing may be told then, now or later.
    fn keep(&mut self, entries: &[JournalEntry]) -> std::io::Result<()>;

    /// Whether a new journal with the present state alone would be shorter.
    fn is_long(&self) -> bool {
        false
    }

    /// Begins a new journal with these entries.
    ///
    /// # Errors
    /// As [`JournalStore::keep`].
    fn restart(&mut self, _entries: &[JournalEntry]) -> std::io::Result<()> {
        Ok(())
    }
}

/// Stores nothing: for tests, and where nothing has to outlive the process.
#[derive(Clone, Copy, Debug)]
pub struct NullStore;

impl JournalStore for NullStore {
    fn keep(&mut self, _entries: &[JournalEntry]) -> std::io::Result<()> {
        Ok(())
    }
}
