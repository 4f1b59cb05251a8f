//! Why a roadmap, a plan or a layout of others is not read or not carried out.

use pcr_core::{AdmissionError, CapacityError, MismatchError};
use pcr_formats::import::ImportError;
use pcr_planning::fleet::FormatRangeError;
use std::{fmt, io};

/// Why a file of others is not read, or a plan not carried out.
#[derive(Debug)]
#[non_exhaustive]
pub enum LabError {
    /// A file cannot be read.
    Read(io::Error),
    /// A text is no JSON, or has other fields.
    Json(serde_json::Error),
    /// A file is no layout.
    NoLayout,
    /// A layout or a plan is refused.
    Import(ImportError),
    /// A roadmap has no list of this name.
    NoList(&'static str),
    /// A roadmap has a node without the name of one.
    NoNodeName,
    /// A node of a roadmap, of this name, has no position.
    NoPosition(String),
    /// A roadmap has no node of this name.
    NoSuchNode(String),
    /// A roadmap has no starts of agents.
    NoStarts,
    /// A task of a roadmap has no time.
    NoTaskTime,
    /// A situation is of so many robots, and the plan of so many.
    RobotCount([usize; 2]),
    /// A value is out of range.
    Range(FormatRangeError),
    /// The table of a plan is too large.
    Full(CapacityError),
    /// The table of a plan is that of other motions.
    Mismatch(MismatchError),
    /// The robots of a plan cannot finish, or touch.
    Precedence(AdmissionError),
}

impl fmt::Display for LabError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Read(error) => write!(f, "cannot be read: {error}"),
            Self::Json(error) => error.fmt(f),
            Self::NoLayout => f.write_str("no layout"),
            Self::Import(error) => error.fmt(f),
            Self::NoList(name) => write!(f, "{name}: a list is expected"),
            Self::NoNodeName => f.write_str("the name of a node is expected"),
            Self::NoPosition(id) => write!(f, "{id}: pos: two numbers are expected"),
            Self::NoSuchNode(id) => write!(f, "{id}: no such node"),
            Self::NoStarts => f.write_str("agent_start: missing"),
            Self::NoTaskTime => f.write_str("tasks: a time is missing"),
            Self::RobotCount([situation, plan]) => {
                write!(f, "the situation is of {situation} robots, the plan of {plan}")
            }
            Self::Range(refused) => refused.fmt(f),
            Self::Full(full) => full.fmt(f),
            Self::Mismatch(mismatch) => mismatch.fmt(f),
            Self::Precedence(refused) => refused.fmt(f),
        }
    }
}

impl std::error::Error for LabError {}

macro_rules! from {
    ($($error:ty => $variant:ident),* $(,)?) => {
        $(impl From<$error> for LabError {
            fn from(error: $error) -> Self {
                Self::$variant(error)
            }
        })*
    };
}

from! {
    io::Error => Read,
    serde_json::Error => Json,
    ImportError => Import,
    FormatRangeError => Range,
    CapacityError => Full,
    MismatchError => Mismatch,
    AdmissionError => Precedence,
}
