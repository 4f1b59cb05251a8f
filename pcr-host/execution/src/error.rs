//! Why a fleet does not run on a layout.

use pcr_core::InvalidInput;
use pcr_planning::fleet::FormatRangeError;
use std::fmt;

/// Why a fleet does not run on a layout.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum ExecutionError {
    /// The outline of a vehicle is not one, or is out of range with its margins.
    Outline(InvalidInput),
    /// An edge, by its id, is not a path.
    Edge(String, InvalidInput),
    /// Standing or turning at a node is out of range.
    Node(InvalidInput),
    /// A motion along an edge is out of range.
    Motion(InvalidInput),
    /// The layout has no two nodes that can be reached from one another.
    NoRoom,
    /// The site changes, and this kind of methods, by its name, is compared on sites that do not change.
    Changes(&'static str),
    /// Tasks name a node by its index, and the layout has so many nodes.
    NoSuchNode {
        /// The index of the node.
        node: usize,
        /// Number of nodes.
        count: usize,
    },
    /// These vehicles touch where they start.
    Touching([String; 2]),
    /// The run had no missions.
    NoMissions,
    /// What this vehicle did is no motion along its path.
    Driven(String, DrivenError),
    /// The motions of a run are out of the range of the certificate.
    Certificate(FormatRangeError),
}

/// Why what a vehicle did is no motion along its path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum DrivenError {
    /// It turned in place without standing there.
    TurnWithoutStop,
    /// It is further along its path, and did not move.
    PathWithoutMotion,
}

impl fmt::Display for ExecutionError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Outline(invalid) => write!(f, "the outline of the vehicle: {invalid}"),
            Self::Edge(id, invalid) => write!(f, "edge {id}: {invalid}"),
            Self::Node(invalid) => write!(f, "a node: {invalid}"),
            Self::Motion(invalid) => write!(f, "a motion along an edge: {invalid}"),
            Self::NoRoom => f.write_str("the layout has no two nodes that can be reached from one another"),
            Self::Changes(method) => write!(f, "{method} are compared on sites that do not change"),
            Self::NoSuchNode { node, count } => write!(f, "node {node} is none of the {count} of the layout"),
            Self::Touching([one, other]) => write!(f, "vehicles {one} and {other} touch where they start"),
            Self::NoMissions => f.write_str("there are no missions"),
            Self::Driven(vehicle, problem) => write!(f, "vehicle {vehicle}: {problem}"),
            Self::Certificate(refused) => refused.fmt(f),
        }
    }
}

impl fmt::Display for DrivenError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::TurnWithoutStop => "a turn in place without a stop",
            Self::PathWithoutMotion => "a path without a motion",
        })
    }
}

impl std::error::Error for ExecutionError {}
impl std::error::Error for DrivenError {}
