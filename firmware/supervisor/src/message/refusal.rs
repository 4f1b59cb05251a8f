//! Reasons why a request was not executed.

use super::{Edition, short};
use crate::frame::Damage;
use heapless::Vec;
use pcr_core::FleetStorageError;
use pcr_core::{AdmissionError, CapacityError, EcmError, InvalidInput, MismatchError};
use serde::{Deserialize, Serialize};

/// Why a request was not executed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Refusal {
    /// A frame was damaged. Its sender is unknown, so the sequence number is 0.
    Frame(Damage),
    /// The sequence number is neither the next one nor that of the last request: the request is too late, or the
    /// supervisor was restarted and has no fleet.
    Sequence {
        /// The sequence number of the next request.
        next: u16,
    },
    /// A value of an agent was refused.
    Agent {
        /// The index that the agent has or was to have.
        agent: u16,
        /// Name of the quantity; empty if it has none.
        what: Vec<u8, 24>,
        /// Reason.
        why: Reason,
    },
    /// The table has no room for two agents, or for their orders; there is no table now.
    TableFull(Room),
    /// There is no such agent.
    NoSuchAgent {
        /// The index in the request.
        agent: u16,
    },
    /// There is no table of the present fleet; send [`Request::Compute`] first.
    NotComputed,
    /// The agent meets another one, however late it starts.
    NoPlan,
    /// This supervisor has no memory for orders.
    NoOrders,
    /// Robots are under way; the fleet can only be changed by [`Request::Admit`].
    Running,
    /// No robots are under way.
    NotRunning,
    /// A term is out of range, or the number of the run is 0 or that of the last run. Or all 65,535 numbers of editions of this run are
    /// used: another run begins with `Order`.
    Terms,
    /// Orders have changed; ask for them with [`Request::Orders`].
    Edition(Edition),
    /// The place of a robot is not on its path, or is beyond the length that it was given.
    Beyond {
        /// The robot.
        agent: u16,
    },
    /// The robot is not known to be at the end of its path.
    NotThere {
        /// The robot.
        agent: u16,
    },
    /// According to their motions two agents meet, or pass so close that it cannot be decided which one is first.
    Meeting([u16; 2]),
    /// The first agent would wait for the second for ever.
    Stuck([u16; 2]),
    /// The second agent is in the way of the first, whichever of them goes first.
    Blocked([u16; 2]),
    /// A robot sent a request that only the planner may send, or one about another robot; robots may greet, report, and
    /// ask for their orders.
    Robot,
    /// The table has no room for all regions of the fleet. These numbers are needed (65535 means at least as many);
    /// there is no table now.
    Needs {
        /// Number of regions, each for both directions of a pair; the same number of orders, if there are any.
        regions: u16,
        /// Number of pieces.
        pieces: u16,
    },
    /// The place of a robot is behind what it has reported: the report is late, the robot has lost its place, or two
    /// robots have one index.
    Behind {
        /// The robot.
        agent: u16,
    },
}

/// The part of a table that is full.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Room {
    /// The regions.
    Regions,
    /// The pieces.
    Pieces,
    /// These two agents have too many pieces for any table.
    Pair([u16; 2]),
    /// Another part.
    Other,
}

/// [`InvalidInput`] without its text.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Reason {
    /// The quantity is NaN or infinite.
    NonFinite,
    /// The quantity is below zero.
    Negative,
    /// The quantity is not above zero.
    NonPositive,
    /// The magnitude of the quantity is too large.
    OutOfRange,
    /// The arc sweeps more than one turn.
    SweepOverOneTurn,
    /// There is no room for another item.
    Full,
    /// The agent is invalid for another reason.
    Other,
}

impl Refusal {
    /// The refusal of an agent.
    pub fn agent(agent: usize, invalid: InvalidInput) -> Self {
        let (why, what) = match invalid {
            InvalidInput::NonFinite(what) => (Reason::NonFinite, what),
            InvalidInput::Negative(what) => (Reason::Negative, what),
            InvalidInput::NonPositive(what) => (Reason::NonPositive, what),
            InvalidInput::OutOfRange(what) | InvalidInput::TooSmall(what) => (Reason::OutOfRange, what),
            InvalidInput::SweepOverOneTurn => (Reason::SweepOverOneTurn, ""),
            InvalidInput::Full(what) => (Reason::Full, what),
            _ => (Reason::Other, ""),
        };
        Self::Agent { agent: short(agent), what: text(what), why }
    }

    /// The refusal of a change of an agent.
    pub fn change(agent: usize, rejected: FleetStorageError) -> Self {
        match rejected {
            FleetStorageError::NoSuchAgent(agent) => Self::NoSuchAgent { agent: short(agent) },
            FleetStorageError::Invalid(invalid) => Self::agent(agent, invalid),
        }
    }
}

impl From<AdmissionError> for Refusal {
    fn from(refused: AdmissionError) -> Self {
        match refused {
            AdmissionError::Meeting(agents) => Self::Meeting(agents.map(short)),
            AdmissionError::Stuck { agent, by, .. } | AdmissionError::Late { agent, by, .. } => {
                Self::Stuck([agent, by].map(short))
            }
            AdmissionError::Blocked { agent, by } => Self::Blocked([agent, by].map(short)),
            AdmissionError::Full(full) => full.into(),
            AdmissionError::Mismatch(mismatch) => mismatch.into(),
            _ => Self::TableFull(Room::Other),
        }
    }
}

impl From<CapacityError> for Refusal {
    fn from(full: CapacityError) -> Self {
        Self::TableFull(match full {
            CapacityError::Regions { .. } => Room::Regions,
            CapacityError::Pieces { .. } => Room::Pieces,
            CapacityError::Pair(agents) => Room::Pair(agents.map(short)),
            _ => Room::Other,
        })
    }
}

impl From<EcmError> for Refusal {
    fn from(error: EcmError) -> Self {
        match error {
            EcmError::Full(full) => full.into(),
            EcmError::Mismatch(mismatch) => mismatch.into(),
        }
    }
}

impl From<MismatchError> for Refusal {
    fn from(mismatch: MismatchError) -> Self {
        match mismatch {
            MismatchError::NoSuchAgent(agent) => Self::NoSuchAgent { agent: short(agent) },
            _ => Self::NotComputed,
        }
    }
}

/// The bytes of a text, as many as fit.
pub fn text<const N: usize>(text: &str) -> Vec<u8, N> {
    let mut bytes = Vec::new();
    for byte in text.bytes() {
        if bytes.push(byte).is_err() {
            break;
        }
    }
    bytes
}
