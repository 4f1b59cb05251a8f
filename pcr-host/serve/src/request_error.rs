//! The reasons why a request is refused.

use serde::Serialize;
use std::fmt;

/// The reason why a request is refused. A refused request changes nothing.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "code", rename_all = "snake_case")]
pub enum RequestError {
    /// There is no robot of this name.
    NoSuchRobot,
    /// There is a different robot of this name, or one that has had a mission since it was added.
    RobotExists,
    /// The robot has a mission of this id with another path.
    MissionExists,
    /// The robot has no path of this number.
    NoSuchPath {
        /// Number of its present path.
        path: u64,
    },
    /// The robot has been allowed to go beyond the length at which the new path leaves.
    Released {
        /// Its hold \[m\].
        hold: f64,
    },
    /// A path that does not begin where the one before it ends.
    Apart {
        /// Distance between the end and the start \[m\].
        distance: f64,
        /// Angle between the end and the start \[rad\].
        angle: f64,
    },
    /// The robot is away.
    Away,
    /// A value is out of range, or a path is invalid.
    Invalid {
        /// What is wrong, in words.
        why: String,
    },
    /// The line is not a request.
    Malformed {
        /// What is wrong, in words.
        why: String,
    },
    /// The version of the lines is another one, or is missing where it has to be.
    Version {
        /// What is wrong, in words.
        why: String,
    },
    /// The first line of a connection is no hello.
    NoHello,
    /// The token of a hello is missing or wrong.
    Unauthorized {
        /// What is wrong, in words.
        why: &'static str,
    },
    /// All places for clients are taken.
    Full {
        /// Number of places.
        #[serde(skip)]
        places: usize,
    },
    /// The client does not read the messages sent to it.
    Slow {
        /// Number of bytes that wait for it.
        #[serde(skip)]
        bytes: usize,
    },
    /// The journal cannot be written: no further holds are told.
    Broken {
        /// Reason, in words.
        why: String,
    },
}

impl RequestError {
    /// A value out of range, described in words.
    pub fn invalid(why: impl fmt::Display) -> Self {
        Self::Invalid { why: why.to_string() }
    }
}

impl fmt::Display for RequestError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoSuchRobot => f.write_str("there is no robot of this name"),
            Self::RobotExists => f.write_str(
                "there is a robot of this name, which is another one, stands elsewhere, or has had a mission",
            ),
            Self::MissionExists => f.write_str("there is another mission of this name, with another path"),
            Self::NoSuchPath { path } => write!(f, "the path of the robot has the number {path}"),
            Self::Released { hold } => write!(f, "the robot has been allowed to go up to {hold} m already"),
            Self::Apart { distance, angle } => {
                write!(f, "the path begins {distance} m and {angle} rad off the end of the one before it")
            }
            Self::Away => f.write_str("the robot is away: say that it is not, or let it send its position"),
            Self::Invalid { why } | Self::Malformed { why } | Self::Version { why } => f.write_str(why),
            Self::NoHello => f.write_str(
                "the first line of a connection has to be {\"pcr\": 1, \"verb\": \"hello\", \"token\": \"...\"}, with the token from the file that \
                 the log of the supervisor names at its start; nothing was carried out",
            ),
            Self::Unauthorized { why } => {
                write!(f, "{why}: send the token from the file that the log of the supervisor names at its start")
            }
            Self::Full { places } => write!(f, "all {places} places for clients are taken: end another one, or try again later"),
            Self::Slow { bytes } => {
                write!(f, "{bytes} bytes wait for this client, which does not read them: this is the last line")
            }
            Self::Broken { why } => {
                write!(f, "the journal cannot be written, so no robot gets the right of way any more: {why}")
            }
        }
    }
}

impl std::error::Error for RequestError {}
