//! Events: messages that the supervisor sends without a request.

use crate::robot::Alarm;
use serde::{Deserialize, Serialize};

/// News for whoever talks to robots, and for people. What is told here is in the journal already.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "event", rename_all = "snake_case")]
pub enum Event {
    /// A robot may go so far. It never gets less, but with another path.
    Hold {
        /// Which.
        robot: String,
        /// Number of its path.
        path: u64,
        /// Length of the path up to which it may go, and stand there \[m\].
        hold: f64,
        /// For whom it would have to wait there; none at the end of its path or where it is told more as it goes on.
        #[serde(skip_serializing_if = "Option::is_none")]
        waits_for: Option<String>,
    },
    /// A robot has a new path.
    Admitted {
        /// Which.
        robot: String,
        /// Which mission.
        mission: String,
        /// Number of the path: positions have to name it.
        path: u64,
        /// Where the path begins, as a length of the way since the robot was added \[m\]: the length `l` of a path that begins at `o` is
        /// the length `l + o - origin` of this one.
        origin: f64,
        /// Length of the new path \[m\].
        length: f64,
        /// How far the robot had been allowed to go, on the new path \[m\].
        hold: f64,
    },
    /// A mission cannot be admitted yet. It is tried again; this comes when the reason has changed.
    Waiting {
        /// Whose.
        robot: String,
        /// Which mission.
        mission: String,
        /// Who is in the way, if one is.
        #[serde(skip_serializing_if = "Option::is_none")]
        by: Option<String>,
        /// Why.
        why: String,
    },
    /// A mission that waited is given up.
    Dropped {
        /// Whose.
        robot: String,
        /// Which mission.
        mission: String,
        /// Why.
        why: String,
    },
    /// Nothing has been heard of a robot for long: it may be anywhere up to its hold.
    Silent {
        /// Which.
        robot: String,
        /// For how long \[s\].
        since: f64,
    },
    /// It is heard again.
    Heard {
        /// Which.
        robot: String,
    },
    /// Somebody has something to do and gets nowhere for long, because of this robot.
    Standstill {
        /// Which.
        robot: String,
        /// For how long it has not moved \[s\].
        since: f64,
        /// What it waits for, or that it does not go where it may.
        why: String,
    },
    /// Something is wrong with a robot.
    Alarm {
        /// With which.
        robot: String,
        /// What.
        #[serde(flatten)]
        alarm: Alarm,
    },
    /// It is where it may be again.
    Clear {
        /// Which.
        robot: String,
    },
    /// A robot has to stop at once.
    Stop {
        /// Which.
        robot: String,
        /// For whom.
        by: String,
    },
    /// It may go on, as its hold says.
    Go {
        /// Which.
        robot: String,
    },
}

impl Event {
    /// Whom it is about.
    pub fn robot(&self) -> &str {
        match self {
            Self::Hold { robot, .. }
            | Self::Admitted { robot, .. }
            | Self::Waiting { robot, .. }
            | Self::Dropped { robot, .. }
            | Self::Silent { robot, .. }
            | Self::Heard { robot }
            | Self::Standstill { robot, .. }
            | Self::Alarm { robot, .. }
            | Self::Clear { robot }
            | Self::Stop { robot, .. }
            | Self::Go { robot } => robot,
        }
    }
}
