//! The reasons why a request is refused.

use serde::Serialize;
use std::fmt;

/// Why a request is refused; nothing has changed then.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "code", rename_all = "snake_case")]
pub enum Fault {
    /// There is no robot of this name.
    NoSuchRobot,
    /// There is one of this name already, another one, or one that has had a mission since.
    RobotExists,
    /// The robot has a mission of this name with another path.
    MissionExists,
    /// The robot has no path of this number.
    NoSuchPath {
        /// The path that it has.
        path: u64,
    },
    /// It has been allowed to go further than where it should turn off.
    Released {
        /// How far \[m\].
        hold: f64,
    },
    /// A path that does not begin where the one before it ends.
    Apart {
        /// How far off \[m\].
        distance: f64,
        /// How far turned \[rad\].
        angle: f64,
    },
    /// A value that is out of range, or a path that is none.
    Invalid {
        /// What is wrong.
        why: String,
    },
    /// What was sent is no request.
    Malformed {
        /// What is wrong.
        why: String,
    },
    /// The client does not read what is sent to it.
    Slow {
        /// Bytes that wait for it.
        #[serde(skip)]
        bytes: usize,
    },
    /// The journal cannot be written: no right is given any more.
    Broken {
        /// Why.
        why: String,
    },
}

impl Fault {
    /// Something out of range, in words.
    pub fn invalid(why: impl fmt::Display) -> Self {
        Self::Invalid { why: why.to_string() }
    }
}

impl fmt::Display for Fault {
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
            Self::Invalid { why } | Self::Malformed { why } => f.write_str(why),
            Self::Slow { bytes } => {
                write!(f, "{bytes} bytes wait for this client, which does not read them: this is the last line")
            }
            Self::Broken { why } => write!(f, "the journal cannot be written, so no right is given any more: {why}"),
        }
    }
}

impl std::error::Error for Fault {}
