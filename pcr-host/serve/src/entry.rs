//! The entries of the journal: everything that must be the same after a restart.

use crate::course::Course;
use crate::robot::{Abilities, Alarm, Asked, Notes, Waiting};
use pcr_core::Pass;
use serde::{Deserialize, Serialize};
use serde_json::Value;

/// What is drawn on the page, and nothing else: it decides nothing.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Layout {
    /// What it is called.
    pub name: String,
    /// Ways of robots.
    pub lanes: Vec<Course>,
}

/// How a robot passes a region: `Pass`, written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Side {
    /// Both stay before it.
    Undecided,
    /// The robot goes first.
    First,
    /// It waits.
    Second,
    /// It is nothing to anybody any more.
    Over,
}

impl From<Pass> for Side {
    fn from(pass: Pass) -> Self {
        match pass {
            Pass::Undecided => Self::Undecided,
            Pass::First => Self::First,
            Pass::Second => Self::Second,
            Pass::Over => Self::Over,
        }
    }
}

impl From<Side> for Pass {
    fn from(side: Side) -> Self {
        match side {
            Side::Undecided => Self::Undecided,
            Side::First => Self::First,
            Side::Second => Self::Second,
            Side::Over => Self::Over,
        }
    }
}

/// An order of a robot with another one. Those of a pair are in the order of their regions.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Kept {
    /// The other one.
    pub with: String,
    /// How the robot passes the region.
    pub pass: Side,
    /// From which length of the second on it counts \[m\].
    pub since: f64,
    /// Lengths of the robot and of the other one in the region \[m\]: another library that finds others is noticed.
    pub lengths: [[f64; 2]; 2],
}

/// A robot with all its orders.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Known {
    /// What it is called.
    pub name: String,
    /// What it can do.
    pub abilities: Abilities,
    /// The path that it has.
    pub course: Course,
    /// Number of the path.
    pub path: u64,
    /// Where the path begins, on the way since the robot was added \[m\].
    pub origin: f64,
    /// The mission that it has got last.
    pub mission: Option<String>,
    /// How it was asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub asked: Option<Asked>,
    /// Missions before.
    pub past: Vec<String>,
    /// Where it was at least \[m\].
    pub at: f64,
    /// How far it may have been allowed to go \[m\].
    pub ceiling: f64,
    /// What is wrong with it.
    pub alarm: Option<Alarm>,
    /// A mission that waits.
    pub waiting: Option<Waiting>,
    /// Its orders with all others, in place of those that it had.
    pub orders: Vec<Kept>,
    /// What others have to remember of it.
    #[serde(default, skip_serializing_if = "Notes::is_empty")]
    pub notes: Notes,
}

/// A change.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(tag = "entry", rename_all = "snake_case")]
pub enum Entry {
    /// Another layout.
    Layout(Layout),
    /// A new robot, or a robot with a new path.
    Robot(Box<Known>),
    /// A robot is no more.
    Removed {
        /// Which.
        robot: String,
    },
    /// Robots that were removed had paths of numbers up to this one.
    Spent {
        /// It.
        path: u64,
    },
    /// A robot may be allowed to go so far.
    Ceiling {
        /// Which.
        robot: String,
        /// Number of its path.
        path: u64,
        /// \[m\]
        ceiling: f64,
    },
    /// Robots were here or further on.
    Places {
        /// Which, on which path, and where \[m\].
        places: Vec<(String, u64, f64)>,
    },
    /// A mission waits, or does no more.
    Waiting {
        /// Whose.
        robot: String,
        /// Which.
        waiting: Option<Waiting>,
    },
    /// What others have to remember of a robot.
    Note {
        /// Of which.
        robot: String,
        /// What it is about.
        key: String,
        /// It, in place of that before.
        note: Value,
    },
    /// More of a list that others have to remember of a robot.
    More {
        /// Of which.
        robot: String,
        /// What it is about.
        key: String,
        /// After what is in it.
        more: Vec<Value>,
    },
    /// Something is wrong with a robot, or no longer.
    Alarm {
        /// With which.
        robot: String,
        /// What.
        alarm: Option<Alarm>,
    },
}

/// Where changes are kept before anybody is told of them.
pub trait Keep: Send {
    /// Keeps these changes, all or none, for good.
    ///
    /// # Errors
    /// Nothing may be told then, now or later.
    fn keep(&mut self, entries: &[Entry]) -> std::io::Result<()>;

    /// Whether a fresh start with everything that is so now would be shorter.
    fn is_long(&self) -> bool {
        false
    }

    /// Begins again with these.
    ///
    /// # Errors
    /// As [`Keep::keep`].
    fn restart(&mut self, _entries: &[Entry]) -> std::io::Result<()> {
        Ok(())
    }
}

/// Keeps nothing: for tests, and where nothing has to outlive the process.
#[derive(Clone, Copy, Debug)]
pub struct Nowhere;

impl Keep for Nowhere {
    fn keep(&mut self, _entries: &[Entry]) -> std::io::Result<()> {
        Ok(())
    }
}
