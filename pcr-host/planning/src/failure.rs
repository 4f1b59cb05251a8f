//! Why there is no answer for a scenario.

use crate::checker_input::RoundTripError;
use crate::fleet::FormatRangeError;
use crate::memory_budget::MemoryError;
use pcr_core::CapacityError;
use pcr_formats::scenario::Scenario;
use std::fmt;

/// The reason why there is no answer.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum ComputationError {
    /// A value does not fit the number format.
    Refused(FormatRangeError),
    /// The numbers to be certified are not those of the scenario.
    Misread(RoundTripError),
    /// The fleet is beyond a limit of the table.
    Full(CapacityError),
    /// These two agents have more pieces of regions than the table can number.
    Overfull([u64; 2]),
    /// There is no agent of the number asked for; these are there.
    NoSuchAgent(u64, Vec<u64>),
    /// The path of this robot, or its disc with the margins of a simulation, is out of range.
    Robot(u64),
    /// This robot of a simulation sets off later than at this time \[s\].
    Late(u64, f64),
    /// This robot of a simulation takes longer than this alone \[s\].
    Long(u64, f64),
    /// An obstacle of a simulation, by its centre \[m\], is out of range.
    Obstacle([f64; 2]),
    /// There is no agent of the label asked for; these are there.
    NoSuchLabel(String, Vec<String>),
    /// Several agents have the label asked for.
    Ambiguous(String, Vec<u64>),
    /// A number that is that of an agent and the label of others.
    Twofold(u64, String, Vec<u64>),
    /// A proof was requested, but there are no two agents.
    NoPair,
    /// The answer does not fit in memory.
    TooLarge(MemoryError),
    /// The task is limited to fewer agents, because it would take too long.
    TooMany {
        /// The task, in words.
        what: &'static str,
        /// Number of agents.
        agents: usize,
        /// Largest number of agents for which it is done.
        most: usize,
    },
}

impl fmt::Display for ComputationError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        /// Numbers that a message lists.
        const LISTED: usize = 16;
        match self {
            Self::Refused(refused) => refused.fmt(f),
            Self::Misread(misread) => misread.fmt(f),
            Self::Full(full) => full.fmt(f),
            Self::TooLarge(too_large) => too_large.fmt(f),
            Self::NoPair => f.write_str("there are no two agents of which contacts could be certified"),
            Self::TooMany { what, agents, most } => write!(f, "{what} for {most} agents at most; there are {agents}"),
            Self::Overfull([i, j]) => write!(
                f,
                "agents {i} and {j}: more than 32767 pieces (pairs of segments within reach of one another), each turn of an arc counted; \
                 join short segments, or leave out turns"
            ),
            Self::Robot(id) => write!(f, "agent {id}: its path or its disc with all margins is out of range"),
            Self::Late(id, latest) => {
                write!(f, "agent {id}, t_start: a simulation is of {latest} s at most until the last one sets off")
            }
            Self::Long(id, longest) => {
                write!(
                    f,
                    "agent {id}: alone and from rest to rest it takes longer than {longest} s, the most for a simulation"
                )
            }
            Self::Obstacle([x, y]) => write!(f, "obstacle at {x}, {y}: it is out of range"),
            Self::NoSuchAgent(asked, there) => {
                let there = there.iter().map(u64::to_string).collect();
                Self::NoSuchLabel(asked.to_string(), there).fmt(f)
            }
            Self::NoSuchLabel(asked, there) => {
                write!(f, "no agent {asked}; ")?;
                let listed = there.iter().take(LISTED).cloned().collect::<Vec<_>>().join(", ");
                match there.len() {
                    0 => f.write_str("there are none"),
                    1..=LISTED => write!(f, "there are {listed}"),
                    all => write!(f, "there are {all}: {listed}, ..."),
                }
            }
            Self::Twofold(number, asked, ids) => {
                let ids = ids.iter().take(LISTED).map(u64::to_string).collect::<Vec<_>>().join(", ");
                write!(
                    f,
                    "{asked} is the number of agent {number}, and the label of another one, {ids}; give that another label"
                )
            }
            Self::Ambiguous(asked, ids) => {
                let ids = ids.iter().take(LISTED).map(u64::to_string).collect::<Vec<_>>().join(", ");
                write!(f, "several agents are called {asked}; say which by its number: {ids}")
            }
        }
    }
}

impl std::error::Error for ComputationError {}

impl ComputationError {
    /// With the numbers of the agents that it is about, where it has their places in a scenario.
    pub(crate) fn named(self, scenario: &Scenario) -> Self {
        let id = |agent: usize| scenario.agents.get(agent).map(|agent| agent.id);
        match self {
            Self::Full(CapacityError::Pair(agents)) => match agents.map(id) {
                [Some(i), Some(j)] => Self::Overfull([i, j]),
                _ => self,
            },
            other => other,
        }
    }
}

impl From<FormatRangeError> for ComputationError {
    fn from(refused: FormatRangeError) -> Self {
        Self::Refused(refused)
    }
}

impl From<MemoryError> for ComputationError {
    fn from(too_large: MemoryError) -> Self {
        Self::TooLarge(too_large)
    }
}

impl From<CapacityError> for ComputationError {
    fn from(full: CapacityError) -> Self {
        Self::Full(full)
    }
}
