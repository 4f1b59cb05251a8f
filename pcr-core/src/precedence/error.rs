//! Why orders are refused.

use crate::error::{CapacityError, EcmError, MismatchError};

/// Why orders are refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum AdmissionError {
    /// An agent would wait for ever.
    Stuck {
        /// The agent that waits.
        agent: usize,
        /// The agent for which it waits.
        by: usize,
        /// Index of their region in the table.
        place: usize,
    },
    /// An agent is already where it should have waited for another one: the order cannot be kept any more.
    Late {
        /// The agent that has gone too far.
        agent: usize,
        /// The agent that was to go first.
        by: usize,
        /// Index of their region in the table.
        place: usize,
    },
    /// Neither order of a region is possible: an agent that would go second cannot stop before it any more, is in it,
    /// or an agent that would go first never leaves it.
    Blocked {
        /// The agent that was to be admitted.
        agent: usize,
        /// The agent that is in its way.
        by: usize,
    },
    /// Two new paths were given for this agent.
    Repeated(usize),
    /// According to their motions these two agents meet, or pass so close that it cannot be decided which one is first.
    Meeting([usize; 2]),
    /// The fleet is not that of the table, or has no such agent.
    Mismatch(MismatchError),
    /// There is not enough room.
    Full(CapacityError),
}

impl core::fmt::Display for AdmissionError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Stuck { agent, by, .. } => write!(f, "agent {agent} would wait for agent {by} for ever"),
            Self::Late { agent, by, .. } => write!(f, "agent {agent} is where agent {by} was to go first"),
            Self::Blocked { agent, by } => write!(f, "agent {by} is in the way of agent {agent}, whoever goes first"),
            Self::Repeated(agent) => write!(f, "two new paths were given for agent {agent}"),
            Self::Meeting([a, b]) => write!(f, "agents {a} and {b} meet"),
            Self::Mismatch(mismatch) => mismatch.fmt(f),
            Self::Full(full) => full.fmt(f),
        }
    }
}

impl core::error::Error for AdmissionError {}

impl From<CapacityError> for AdmissionError {
    fn from(full: CapacityError) -> Self {
        Self::Full(full)
    }
}

impl From<MismatchError> for AdmissionError {
    fn from(mismatch: MismatchError) -> Self {
        Self::Mismatch(mismatch)
    }
}

impl From<EcmError> for AdmissionError {
    fn from(error: EcmError) -> Self {
        match error {
            EcmError::Full(full) => Self::Full(full),
            EcmError::Mismatch(mismatch) => Self::Mismatch(mismatch),
        }
    }
}
