//! Errors as sentences. Agents and legs are counted from 1.

use crate::limits::{AGENTS, LEGS};
use core::fmt;
use pcr_core::{Full, Invalid, Mismatch, Refused, Unsolved};

/// Why there is no answer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Fault {
    /// The number of agents is too large, or one is incomplete.
    Agents(usize),
    /// The number of legs of this agent is invalid.
    Legs(usize),
    /// This agent, or its leg, is invalid.
    Invalid(usize, Option<usize>, Invalid),
    /// No fleet was built, or the last one was refused.
    NotBuilt,
    /// The table is full.
    Full(Full),
    /// The fleet has no such agent.
    Mismatch(Mismatch),
    /// There is no plan.
    Unsolved(Unsolved),
    /// The motions collide, so they have no order.
    Refused(Refused),
    /// The answer has more rows than the output can hold.
    Rows,
    /// An argument is not a time, or not a whole number.
    Question(&'static str),
}

impl Fault {
    pub(crate) fn of_agent(agent: usize) -> impl Fn(Invalid) -> Self + Copy {
        move |invalid| Self::Invalid(agent, None, invalid)
    }

    pub(crate) fn of_leg(agent: usize, leg: usize) -> impl Fn(Invalid) -> Self + Copy {
        move |invalid| Self::Invalid(agent, Some(leg), invalid)
    }
}

impl From<Full> for Fault {
    fn from(full: Full) -> Self {
        Self::Full(full)
    }
}

impl From<Mismatch> for Fault {
    fn from(mismatch: Mismatch) -> Self {
        Self::Mismatch(mismatch)
    }
}

impl From<Unsolved> for Fault {
    fn from(unsolved: Unsolved) -> Self {
        Self::Unsolved(unsolved)
    }
}

impl From<Refused> for Fault {
    fn from(refused: Refused) -> Self {
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
            Self::Invalid(agent, None, why) => write!(f, "agent {}: {why}", number(agent)),
            Self::Invalid(agent, Some(leg), why) => write!(f, "agent {}, leg {}: {why}", number(agent), number(leg)),
            Self::NotBuilt => f.write_str("there is no fleet: none was built, or the last one was refused"),
            Self::Full(full) => full.fmt(f),
            Self::Mismatch(mismatch) => mismatch.fmt(f),
            Self::Unsolved(Unsolved::Starts([a, b])) => {
                write!(f, "no plan: agents {} and {} overlap at their starts", number(a), number(b))
            }
            Self::Unsolved(Unsolved::Ends([a, b])) => {
                write!(f, "no plan: agents {} and {} overlap at the ends of their paths", number(a), number(b))
            }
            Self::Unsolved(Unsolved::Always([a, b])) => {
                write!(f, "no plan: agents {} and {} meet however they move", number(a), number(b))
            }
            Self::Unsolved(Unsolved::Priorities([a, b])) => {
                write!(f, "no plan found: agent {} cannot go because of agent {}", number(a), number(b))
            }
            Self::Unsolved(Unsolved::Invalid { agent, reason }) => {
                write!(f, "no plan of agent {}: {reason}", number(agent))
            }
            Self::Unsolved(unsolved) => write!(f, "no plan: {unsolved}"),
            Self::Refused(Refused::Meeting([a, b])) => {
                write!(f, "agents {} and {} meet: there is no order in which they pass", number(a), number(b))
            }
            Self::Refused(refused) => refused.fmt(f),
            Self::Rows => f.write_str("the answer is too long"),
            Self::Question(what) => write!(f, "{what} is not a number in range"),
        }
    }
}
