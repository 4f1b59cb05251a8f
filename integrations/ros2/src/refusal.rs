//! Why a message was not used.

use pcr_core::InvalidInput;
use std::fmt;

/// Why a path was not used. What is said about its robot is then "unknown".
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Refusal {
    /// None has come yet.
    NoPath,
    /// It has no poses.
    Empty,
    /// It is in another frame than the one that is configured, or on another level.
    Frame {
        /// Its frame.
        given: String,
        /// The configured one.
        expected: String,
    },
    /// A number is not finite.
    NotFinite {
        /// The pose.
        pose: usize,
    },
    /// The rotation of a pose is not one about `z`, or its quaternion has not length 1.
    Rotation {
        /// The pose.
        pose: usize,
    },
    /// A pose is not later than the one before it.
    Time {
        /// The pose.
        pose: usize,
    },
    /// The nanoseconds of a time are not below 1e9.
    Nanoseconds,
    /// A robot with an outline is turned by half a turn on the way to a pose, and it is not told to which side.
    HalfTurn {
        /// The pose.
        pose: usize,
    },
    /// It was published longer ago than a path may be old.
    Old {
        /// The largest age \[s\].
        most: f64,
    },
    /// It was published later than now by more than a path may be old.
    Future {
        /// The largest age \[s\].
        most: f64,
    },
    /// A number is out of range.
    Range(InvalidInput),
    /// Its poses do not make a motion.
    Motion(pcr_rmf_mapf::Error),
    /// The message is not one of its type.
    Unreadable(String),
    /// A fleet has a robot that is not configured.
    UnknownRobot {
        /// The fleet.
        fleet: String,
        /// Its name.
        name: String,
    },
    /// A fleet's state does not have its robot any more.
    Missing,
    /// A fleet's state has its robot more than once.
    Repeated,
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoPath => f.write_str("no path has come yet"),
            Self::Empty => f.write_str("the path has no poses"),
            Self::Frame { given, expected } => write!(f, "the path is in frame \"{given}\", not \"{expected}\""),
            Self::NotFinite { pose } => write!(f, "pose {pose}: a number is not finite"),
            Self::Rotation { pose } => write!(f, "pose {pose}: its orientation is not a rotation about z"),
            Self::Time { pose } => {
                write!(f, "pose {pose}: it is not later than the one before")
            }
            Self::Nanoseconds => f.write_str("a time has nanoseconds that are not below 1e9"),
            Self::HalfTurn { pose } => {
                write!(f, "pose {pose}: it is not told to which side the robot makes half a turn")
            }
            Self::Old { most } => write!(f, "the path is more than {most} s old"),
            Self::Future { most } => write!(f, "the path is of a time more than {most} s from now"),
            Self::Range(problem) => problem.fmt(f),
            Self::Motion(problem) => problem.fmt(f),
            Self::Unreadable(problem) => write!(f, "the message cannot be read: {problem}"),
            Self::UnknownRobot { fleet, name } => write!(f, "robot \"{name}\" of fleet \"{fleet}\" is not configured"),
            Self::Missing => f.write_str("the state of its fleet does not have the robot"),
            Self::Repeated => f.write_str("the state of its fleet has the robot more than once"),
        }
    }
}

impl std::error::Error for Refusal {}
