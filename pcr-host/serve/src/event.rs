//! Events: messages that the supervisor sends without a request.

use crate::closed_area::SpeedLimit;
use crate::robot::Alarm;
use serde::{Serialize, Serializer};
use std::fmt;

/// Why a waiting mission was given up.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum CancelCause {
    /// The robot has got another mission.
    Replaced,
    /// Its manager has cancelled it.
    Cancelled,
    /// The robot stands elsewhere, where a person or its own report has put it.
    Moved,
    /// It can no longer be admitted, for this reason.
    Impossible(String),
}

impl fmt::Display for CancelCause {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Replaced => "another mission takes its place",
            Self::Cancelled => "it was cancelled",
            Self::Moved => "the robot stands elsewhere",
            Self::Impossible(why) => why,
        })
    }
}

impl Serialize for CancelCause {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

/// A message to the programs that control robots, and to people. Its content is in the journal already.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "event", rename_all = "snake_case")]
pub enum SupervisorEvent {
    /// A robot may go this far. The hold never decreases while the robot keeps its path and the supervisor runs. After a restart it may
    /// at first be lower than before: the robot keeps the higher one.
    Hold {
        /// Name of the robot.
        robot: String,
        /// Number of its path.
        path: u64,
        /// Length of the path up to which the robot may go, and where it may stand \[m\].
        hold: f64,
        /// Robot for which it would have to wait at the hold; `None` at the end of its path, or if it is told a further hold on
        /// the way.
        #[serde(skip_serializing_if = "Option::is_none")]
        waits_for: Option<String>,
    },
    /// A robot has a new path.
    Admitted {
        /// Name of the robot.
        robot: String,
        /// Id of the mission.
        mission: String,
        /// Number of the path: position messages have to name it.
        path: u64,
        /// Where the path begins, as a length of the way since the robot was added \[m\]: the length `l` of a path that begins at `o` is
        /// the length `l + o - origin` of this one.
        origin: f64,
        /// Length of the new path \[m\].
        length: f64,
        /// Length of the new path up to which the robot had already been allowed to go \[m\].
        hold: f64,
    },
    /// On these parts of its path a robot may be no faster; they replace those that it was told before for this path. One that is faster there
    /// brakes.
    Limits {
        /// Name of the robot.
        robot: String,
        /// Number of its path.
        path: u64,
        /// The parts; none: no limit any more.
        limits: Vec<SpeedLimit>,
    },
    /// A mission cannot be admitted yet. It is tried again; this event comes again when the reason changes.
    Waiting {
        /// Name of the robot.
        robot: String,
        /// Id of the mission.
        mission: String,
        /// Robot that is in the way, if one is.
        #[serde(skip_serializing_if = "Option::is_none")]
        by: Option<String>,
        /// Reason, in words.
        why: String,
    },
    /// A mission that waited has been given up.
    Dropped {
        /// Name of the robot.
        robot: String,
        /// Id of the mission.
        mission: String,
        /// Reason; in words where it is written.
        why: CancelCause,
    },
    /// No message of a robot has come for a long time: it may be anywhere up to its hold.
    Silent {
        /// Name of the robot.
        robot: String,
        /// Time since its last message \[s\].
        since: f64,
    },
    /// A silent robot has sent a message again.
    Heard {
        /// Name of the robot.
        robot: String,
    },
    /// A person has said that a robot is away: nobody waits to hear from it.
    Away {
        /// Name of the robot.
        robot: String,
        /// Whether its place, its path and its hold stay reserved, until it is removed.
        keeps_place: bool,
    },
    /// A robot that was away is not any more.
    Back {
        /// Name of the robot.
        robot: String,
    },
    /// Others wait for a vehicle, because it has not said where it stands.
    Unplaced {
        /// Name of the vehicle.
        robot: String,
        /// Why they wait, and what to do, in words.
        why: String,
    },
    /// Nobody waits for it for that any more.
    Placed {
        /// Name of the vehicle.
        robot: String,
    },
    /// A robot with a task has not advanced for a long time, because of this robot.
    Standstill {
        /// Name of the robot that causes it.
        robot: String,
        /// Time for which it has not moved \[s\].
        since: f64,
        /// What it waits for, or that it does not use its hold.
        why: String,
    },
    /// A position of a robot is not where the robot may be.
    Alarm {
        /// Name of the robot.
        robot: String,
        /// The kind of alarm.
        #[serde(flatten)]
        alarm: Alarm,
    },
    /// An alarm has ended: the robot is where it may be.
    Clear {
        /// Name of the robot.
        robot: String,
    },
    /// The whole fleet is paused: all robots have to stop, and nobody is granted anything more.
    Paused {
        /// That, and who may not be able to, in words.
        why: String,
    },
    /// The fleet is not paused any more.
    Resumed {},
    /// A robot has to stop at once.
    Stop {
        /// Name of the robot.
        robot: String,
        /// Robot or closed area because of which it has to stop, or [`PAUSE`](crate::supervisor::PAUSE).
        by: String,
    },
    /// A stopped robot may go on, up to its hold.
    Go {
        /// Name of the robot.
        robot: String,
    },
}

impl SupervisorEvent {
    /// Whether another event, which was decided before this one, must not be told after it: it would let go a robot that has to stop.
    pub(crate) fn overtakes(&self, before: &Self) -> bool {
        match (self, before) {
            (Self::Stop { robot, .. }, Self::Go { robot: other }) => robot == other,
            _ => false,
        }
    }

    /// Name of the robot that the event is about; `None` if it is about all.
    pub fn robot(&self) -> Option<&str> {
        match self {
            Self::Paused { .. } | Self::Resumed {} => None,
            Self::Hold { robot, .. }
            | Self::Admitted { robot, .. }
            | Self::Limits { robot, .. }
            | Self::Waiting { robot, .. }
            | Self::Dropped { robot, .. }
            | Self::Silent { robot, .. }
            | Self::Heard { robot }
            | Self::Away { robot, .. }
            | Self::Back { robot }
            | Self::Unplaced { robot, .. }
            | Self::Placed { robot }
            | Self::Standstill { robot, .. }
            | Self::Alarm { robot, .. }
            | Self::Clear { robot }
            | Self::Stop { robot, .. }
            | Self::Go { robot } => Some(robot),
        }
    }
}
