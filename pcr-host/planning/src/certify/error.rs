//! Why a file with a table is refused.

use pcr_certify::error::CertifyError;
use serde_json::Value;
use std::fmt;

/// Why a file with a table cannot be proved: an answer of `pcr regions --certificate`, or what a microcontroller prints.
#[derive(Debug)]
pub enum CertifyInputError {
    /// The table of a microcontroller.
    Dump(CertifyError),
    /// The text is no JSON, or has other fields.
    Json(serde_json::Error),
    /// The file is a scenario.
    Scenario,
    /// The file has another format.
    Format(Value),
    /// The file has another version.
    Version(Value),
    /// The answer says why it has no regions.
    NotComputed(String),
    /// The answer has no certificate.
    NoCertificate,
    /// The certificate has so many tables.
    TableCount(usize),
    /// The answer has a list of this name, of which the certificate has no table.
    ListWithoutTable(&'static str),
    /// The certificate has a table, and the answer has no list of this name.
    TableWithoutList(&'static str),
    /// The certificate has several bodies of an agent, and the answer says nothing of them.
    UntoldBodies {
        /// Number of the agent.
        id: u64,
        /// How many bodies.
        count: usize,
    },
    /// The certificate has more or fewer bodies of an agent than the answer.
    BodyCount {
        /// Number of the agent.
        id: u64,
        /// How many the certificate has.
        count: usize,
        /// How many the answer has.
        told: usize,
    },
    /// The answer has bodies of an agent that the certificate does not have.
    BodiesOfNobody(u64),
    /// The answer is about an agent that the certificate does not have.
    NoSuchAgent(u64),
    /// The two tables have so many discs.
    DiscCounts([usize; 2]),
    /// The agents in this place of the two tables differ, in this.
    AgentsDiffer(usize, &'static str),
    /// The outlines in this place of the two tables differ.
    OutlinesDiffer(usize),
    /// A pair is of an agent that is not there.
    NoPair([usize; 2]),
    /// The answer has more or fewer regions of two agents than the certificate.
    RegionCount {
        /// Name of the list.
        list: &'static str,
        /// Numbers of the agents.
        agents: [u64; 2],
        /// How many the answer has.
        told: usize,
        /// How many the certificate has.
        held: usize,
    },
    /// No region of two agents in the answer holds these times of the certificate.
    NotHeld {
        /// Name of the list.
        list: &'static str,
        /// Numbers of the agents.
        agents: [u64; 2],
        /// From when to when \[s\].
        times: [f64; 2],
    },
    /// A region of the answer is none of the certificate.
    Region {
        /// Name of the list.
        list: &'static str,
        /// Place in the list.
        place: usize,
        /// Numbers of the agents.
        agents: [u64; 2],
        /// What is wrong.
        problem: RegionDifference,
    },
}

/// How a region of an answer differs from those of the certificate.
#[derive(Clone, Debug, PartialEq)]
pub enum RegionDifference {
    /// A field has another value in the certificate.
    Field {
        /// Name of the field.
        name: &'static str,
        /// As in the answer.
        told: String,
        /// As in the certificate.
        held: String,
    },
    /// So many pieces in the answer, and so many in the certificate.
    PieceCount([usize; 2]),
    /// A range whose ends are no ends in the certificate.
    Unmade {
        /// Name of its field.
        name: &'static str,
        /// As in the answer.
        told: [f64; 2],
        /// What it is a range of.
        of: &'static str,
    },
    /// The region is there twice.
    Twice,
}

impl fmt::Display for RegionDifference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Field { name, told, held } => write!(f, "{name} is {told}, and {held} in the certificate"),
            Self::PieceCount([told, held]) => write!(f, "it has {told} pieces, and {held} in the certificate"),
            Self::Unmade { name, told, of } => write!(f, "{name} is {told:?}, which no {of} in the certificate make"),
            Self::Twice => f.write_str("it is there twice"),
        }
    }
}

impl fmt::Display for CertifyInputError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Dump(problem) => problem.fmt(f),
            Self::Json(problem) => problem.fmt(f),
            Self::Scenario => {
                f.write_str("this is a scenario; without --table, the table that is computed for it is proved")
            }
            Self::Format(other) => write!(f, "format: {other} where \"{}\" is expected", super::ANSWERS),
            Self::Version(other) => {
                write!(f, "version: {other} where {} or an earlier one is expected", super::VERSION)
            }
            Self::NotComputed(reason) => write!(f, "its regions were not computed: {reason}"),
            Self::NoCertificate => {
                f.write_str("there is no certificate in it; pcr regions --json --certificate prints one")
            }
            Self::TableCount(count) => {
                write!(f, "certificate: {count} tables; there are at most two, the second with margins")
            }
            Self::ListWithoutTable(list) => write!(f, "{list}: the certificate has no table of them"),
            Self::TableWithoutList(list) => write!(f, "{list}: missing, and the certificate has a table of them"),
            Self::UntoldBodies { id, count } => {
                write!(f, "{count} bodies have the number {id}, and bodies tell of no agent of this number")
            }
            Self::BodyCount { id, count, told } => {
                write!(f, "{count} bodies have the number {id}, and bodies tell of {told}")
            }
            Self::BodiesOfNobody(id) => write!(f, "bodies: the certificate has no agent {id}"),
            Self::NoSuchAgent(id) => write!(f, "agent: {id} is none of the certificate"),
            Self::DiscCounts([first, second]) => {
                write!(f, "certificate: {first} discs in the first table, and {second} in the second")
            }
            Self::AgentsDiffer(place, what) => {
                write!(f, "certificate: agents[{place}] of the two tables differ: {what}")
            }
            Self::OutlinesDiffer(place) => {
                write!(f, "certificate: bodies[{place}] of the two tables differ: outline")
            }
            Self::NoPair([a, b]) => write!(f, "the pair of places {a} and {b} is none"),
            Self::RegionCount { list, agents: [i, j], told, held } => {
                write!(f, "{list}: {told} of agents {i} and {j}, and {held} in the certificate")
            }
            Self::NotHeld { list, agents: [i, j], times } => {
                write!(f, "{list}: none of agents {i} and {j} holds the times {times:?} in the certificate")
            }
            Self::Region { list, place, agents: [i, j], problem } => {
                write!(f, "{list}[{place}], of agents {i} and {j}: {problem}")
            }
        }
    }
}

impl std::error::Error for CertifyInputError {}

impl From<CertifyError> for CertifyInputError {
    fn from(problem: CertifyError) -> Self {
        Self::Dump(problem)
    }
}

impl From<serde_json::Error> for CertifyInputError {
    fn from(problem: serde_json::Error) -> Self {
        Self::Json(problem)
    }
}
