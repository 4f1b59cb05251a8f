//! Why an agent of a scenario does not fit a number format.

use super::HostScalar;
use pcr_core::InvalidInput;
use pcr_formats::footprint::FootprintError;
use pcr_formats::scenario::figure;
use std::fmt;

/// The reason why an agent of a scenario does not fit a number format: agent, segment, field, value, and the allowed range.
#[derive(Clone, Debug, PartialEq)]
pub struct FormatRangeError {
    /// Name of the agent.
    pub agent: String,
    /// The kind and the place of the part of the agent that does not fit, if it is one.
    pub part: Option<(&'static str, usize)>,
    /// Name of the format.
    pub format: &'static str,
    /// What does not fit.
    pub problem: RangeProblem,
}

/// What does not fit a number format.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum RangeProblem {
    /// A field is too large in magnitude.
    TooLarge {
        /// Its name.
        field: &'static str,
        /// Its value.
        value: f64,
        /// The largest one allowed.
        limit: f64,
    },
    /// An angle is too large in magnitude.
    Angle {
        /// Name of its field.
        field: &'static str,
        /// Its value \[rad\].
        radians: f64,
        /// The largest one allowed \[rad\].
        limit: f64,
    },
    /// A field is not 0, and becomes 0.
    BecomesZero {
        /// Its name.
        field: &'static str,
        /// Its value.
        value: f64,
    },
    /// The motion takes too long.
    Duration {
        /// How long it takes \[s\].
        duration: f64,
        /// It has to take less than this \[s\].
        limit: f64,
    },
    /// What follows from several fields is refused by the core.
    Derived {
        /// The reason.
        reason: InvalidInput,
        /// The largest magnitude that is allowed of it, or the least where the reason is that it is too small.
        allowed: f64,
    },
    /// The end of a segment does not fit.
    AtItsEnd(Box<Self>),
    /// The outline does not fit.
    Footprint(Box<Self>),
    /// The outline is not convex.
    NotConvex,
    /// The outline has a size out of range.
    FootprintSize,
    /// The outlines of an agent have no convex hull in the format.
    Hull(InvalidInput),
    /// The convex hull of the outlines of an agent is no footprint.
    HullFootprint(FootprintError),
}

/// Part of an agent, if the fault is in one; and the problem.
#[derive(Debug)]
pub(super) struct FieldFault {
    pub(super) part: Option<(&'static str, usize)>,
    pub(super) problem: RangeProblem,
}

/// A fault of the agent as a whole.
impl From<RangeProblem> for FieldFault {
    fn from(problem: RangeProblem) -> Self {
        Self { part: None, problem }
    }
}

impl FieldFault {
    /// Returns the error, for this agent.
    pub(super) fn of<S: HostScalar>(self, agent: String) -> FormatRangeError {
        FormatRangeError { agent, part: self.part, format: S::NAME, problem: self.problem }
    }
}

/// Returns the problem of a value that is refused by the core, and follows from several fields.
pub(super) fn derived<S: HostScalar>(reason: InvalidInput) -> RangeProblem {
    let allowed = match reason {
        InvalidInput::OutOfRange("heading") => S::HEADING_LIMIT,
        InvalidInput::TooSmall(_) => S::LEAST.to_f64(),
        _ => S::LIMIT.to_f64(),
    };
    RangeProblem::Derived { reason, allowed }
}

impl fmt::Display for RangeProblem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooLarge { field, value, limit } => {
                write!(f, "{field}: {} is out of range; allowed is up to {limit:e} in magnitude", figure(*value))
            }
            Self::Angle { field, radians, limit } => {
                let [radians, limit] = [radians, limit].map(|angle| figure(*angle));
                write!(f, "{field}: {radians} is out of range; allowed is up to {limit} in magnitude")
            }
            Self::BecomesZero { field, value } => {
                write!(f, "{field}: {} is out of range; it is so small that it becomes 0", figure(*value))
            }
            Self::Duration { duration, limit } => {
                write!(f, "the motion takes {} s; allowed is below {limit:e} s", figure(*duration))
            }
            Self::Derived { reason, allowed } => match reason {
                InvalidInput::OutOfRange(what @ "heading") => {
                    let limit = figure(*allowed);
                    write!(
                        f,
                        "{what} is out of range; allowed is up to {limit} in magnitude, with all turns of the path"
                    )
                }
                InvalidInput::OutOfRange(what) => {
                    write!(f, "{what} is out of range; allowed is up to {allowed:e} in magnitude")
                }
                InvalidInput::TooSmall(what) => {
                    // Printed with the digits of `f32` if `f32` can hold it, because most formats have that limit.
                    let least = *allowed as f32;
                    let least = if least > 0.0 { format!("{least:e}") } else { format!("{allowed:e}") };
                    write!(f, "{what} is out of range; the least is {least}")
                }
                reason => reason.fmt(f),
            },
            Self::AtItsEnd(problem) => write!(f, "at its end: {problem}"),
            Self::Footprint(problem) => write!(f, "footprint: {problem}"),
            Self::NotConvex => f.write_str("footprint: it is not convex"),
            Self::FootprintSize => f.write_str("footprint: its size is out of range"),
            Self::Hull(reason) => write!(f, "convex hull of its outlines: {reason}"),
            Self::HullFootprint(reason) => write!(f, "convex hull of its outlines: {reason}"),
        }
    }
}

impl fmt::Display for FormatRangeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "agent {}", self.agent)?;
        if let Some((part, index)) = self.part {
            write!(f, ", {part} {}", index + 1)?;
        }
        write!(f, ", {} ({})", self.problem, self.format)
    }
}

impl std::error::Error for FormatRangeError {}
