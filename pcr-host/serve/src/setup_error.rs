//! Why a connection to a broker, or simulated vehicles, cannot be set up.

use pcr_formats::import::ElementId;
use pcr_formats::vda5050::topics::TopicError;
use std::path::PathBuf;
use std::{fmt, io};

/// The setting that is wrong, or what the system refuses.
#[derive(Debug)]
pub enum SetupError {
    /// A name that cannot be part of a topic.
    Topic(TopicError),
    /// TLS is asked for, and this build has none.
    NoTls,
    /// The certificates by which a broker is known cannot be used.
    Authority {
        /// Their file.
        file: PathBuf,
        /// What is wrong with it.
        why: String,
    },
    /// The system gives no thread.
    Thread(io::Error),
    /// There are fewer goals than vehicles and one more.
    FewGoals {
        /// Number of vehicles.
        vehicles: usize,
        /// Number of goals.
        goals: usize,
    },
    /// A goal that is no node of the layout, by its index.
    NoNode(usize),
    /// There is no route between two goals that keeps clear of the others.
    NoRoute {
        /// Goals at its ends.
        ends: [ElementId; 2],
        /// Distance to all other goals that is kept \[m\].
        clearance: f64,
    },
}

impl fmt::Display for SetupError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Topic(error) => error.fmt(f),
            Self::NoTls => f.write_str("this build has no TLS: build it with the feature `tls`"),
            Self::Authority { file, why } => write!(f, "{}: {why}", file.display()),
            Self::Thread(error) => error.fmt(f),
            Self::FewGoals { vehicles, goals } => {
                write!(f, "{vehicles} vehicles need {} places to stand at; there are {goals}", vehicles + 1)
            }
            Self::NoNode(goal) => write!(f, "a goal that is no node: {goal}"),
            Self::NoRoute { ends: [from, to], clearance } => {
                write!(f, "no way from {from} to {to} keeps {clearance:.3} m from all other goals")
            }
        }
    }
}

impl std::error::Error for SetupError {}
