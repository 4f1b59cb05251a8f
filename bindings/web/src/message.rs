//! Errors as sentences. Agents and legs are counted from 1.

use crate::limits::{AGENTS, CORNERS, LEGS};
use core::fmt;
use pcr_core::{AdmissionError, CapacityError, InvalidInput, MismatchError, PlanError};

/// Why there is no answer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Fault {
    /// The number of agents is too large, or one is incomplete.
    Agents(usize),
    /// The number of legs of this agent is invalid.
    Legs(usize),
    /// The number of corners of this agent is invalid.
    Corners(usize),
    /// This agent, or its leg, is invalid.
    Invalid(usize, Option<usize>, InvalidInput),
    /// No fleet was built, or the last one was refused.
    NotBuilt,
    /// The table is full.
    Full(CapacityError),
    /// The fleet has no such agent.
    Mismatch(MismatchError),
    /// There is no plan.
    Unsolved(PlanError),
    /// The motions collide, so they have no order.
    Refused(AdmissionError),
    /// The answer has more rows than the output can hold.
    Rows,
    /// An argument is not a time, or not a whole number.
    Question(&'static str),
}

impl Fault {
    pub(crate) fn of_agent(agent: usize) -> impl Fn(InvalidInput) -> Self + Copy {
        move |invalid| Self::Invalid(agent, None, invalid)
    }

    pub(crate) fn of_leg(agent: usize, leg: usize) -> impl Fn(InvalidInput) -> Self + Copy {
        move |invalid| Self::Invalid(agent, Some(leg), invalid)
    }
}

impl From<CapacityError> for Fault {
    fn from(full: CapacityError) -> Self {
        Self::Full(full)
    }
}

impl From<MismatchError> for Fault {
    fn from(mismatch: MismatchError) -> Self {
        Self::Mismatch(mismatch)
    }
}

impl From<PlanError> for Fault {
    fn from(unsolved: PlanError) -> Self {
        Self::Unsolved(unsolved)
    }
}

impl From<AdmissionError> for Fault {
    fn from(refused: AdmissionError) -> Self {
        Self::Refused(refused)
    }
}

/// Index of an agent, counted from 1; an index is never the largest `usize`.
fn number(agent: usize) -> usize {
    agent.saturating_add(1)
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Agents(count) => write!(f, "{count} agents: there is room for {}", AGENTS),
            Self::Legs(agent) => write!(f, "agent {}: 0 to {} legs", number(agent), LEGS),
            Self::Corners(agent) => write!(f, "agent {}: 0 to {} corners", number(agent), CORNERS),
            Self::Invalid(agent, None, why) => write!(f, "agent {}: {why}", number(agent)),
            Self::Invalid(agent, Some(leg), why) => write!(f, "agent {}, leg {}: {why}", number(agent), number(leg)),
            Self::NotBuilt => f.write_str("there is no fleet: none was built, or the last one was refused"),
            Self::Full(full) => full.fmt(f),
            Self::Mismatch(mismatch) => mismatch.fmt(f),
            Self::Unsolved(PlanError::Starts([a, b])) => {
                write!(f, "no plan: agents {} and {} overlap at their starts", number(a), number(b))
            }
            Self::Unsolved(PlanError::Ends([a, b])) => {
                write!(f, "no plan: agents {} and {} overlap at the ends of their paths", number(a), number(b))
            }
            Self::Unsolved(PlanError::Always([a, b])) => {
                write!(f, "no plan: agents {} and {} meet however they move", number(a), number(b))
            }
            Self::Unsolved(PlanError::Priorities([a, b])) => {
                write!(f, "no plan found: agent {} cannot go because of agent {}", number(a), number(b))
            }
            Self::Unsolved(PlanError::Invalid { agent, reason }) => {
                write!(f, "no plan of agent {}: {reason}", number(agent))
            }
            Self::Unsolved(unsolved) => write!(f, "no plan: {unsolved}"),
            Self::Refused(AdmissionError::Meeting([a, b])) => {
                write!(f, "agents {} and {} meet: there is no order in which they pass", number(a), number(b))
            }
            Self::Refused(refused) => refused.fmt(f),
            Self::Rows => f.write_str("the answer is too long"),
            Self::Question(what) => write!(f, "{what} is not a number in range"),
        }
    }
}
