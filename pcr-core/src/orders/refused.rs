//! Why orders are refused.

use crate::error::{Full, Mismatch, Unchanged};

/// Why orders are refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Refused {
    /// An agent would wait for ever.
    Stuck {
        /// Who waits.
        agent: usize,
        /// For whom.
        by: usize,
        /// The place of their region in the table.
        place: usize,
    },
    /// An agent is where it should have waited for another one: the order cannot be kept any more.
    Late {
        /// Who is there.
        agent: usize,
        /// Who was to go first.
        by: usize,
        /// The place of their region in the table.
        place: usize,
    },
    /// Neither agent can be second at a region any more, or none would ever leave it: one cannot stop before it, is in
    /// it, or ends in it.
    Blocked {
        /// The agent that was to be admitted.
        agent: usize,
        /// Who is in its way.
        by: usize,
    },
    /// By their motions two agents meet, or pass so near that it cannot be told who is first.
    Meeting([usize; 2]),
    /// The fleet is not that of the table, or there is no such agent.
    Mismatch(Mismatch),
    /// There is no room.
    Full(Full),
}

impl core::fmt::Display for Refused {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Stuck { agent, by, .. } => write!(f, "agent {agent} would wait for agent {by} for ever"),
            Self::Late { agent, by, .. } => write!(f, "agent {agent} is where agent {by} was to go first"),
            Self::Blocked { agent, by } => write!(f, "agent {by} is in the way of agent {agent}, whoever goes first"),
            Self::Meeting([a, b]) => write!(f, "agents {a} and {b} meet"),
            Self::Mismatch(mismatch) => mismatch.fmt(f),
            Self::Full(full) => full.fmt(f),
        }
    }
}

impl core::error::Error for Refused {}

impl From<Full> for Refused {
    fn from(full: Full) -> Self {
        Self::Full(full)
    }
}

impl From<Mismatch> for Refused {
    fn from(mismatch: Mismatch) -> Self {
        Self::Mismatch(mismatch)
    }
}

impl From<Unchanged> for Refused {
    fn from(unchanged: Unchanged) -> Self {
        match unchanged {
            Unchanged::Full(full) => Self::Full(full),
            Unchanged::Mismatch(mismatch) => Self::Mismatch(mismatch),
        }
    }
}
