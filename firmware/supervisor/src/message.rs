//! What the two ends of the line say to each other. Within a version of the protocol, kinds are only ever added, at the
//! end of each list.

use crate::agent::Agent;
use crate::fleet::Rejected;
use crate::frame::Damage;
use crate::number::Number;
use heapless::Vec;
use pcr_core::{Encounter, Full, Interval, Invalid, Mismatch, Motion, PieceRef, RegionRef};
use serde::{Deserialize, Serialize};

/// A request to the supervisor. Each is answered before the next is read.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(bound = "")]
pub enum Request<S: Number> {
    /// Who are you? [`Answer::Hello`]. Answered whatever its sequence number is.
    Hello,
    /// Forget the fleet. [`Answer::Done`].
    Clear,
    /// Add an agent. [`Answer::Fleet`].
    Add(Agent<S>),
    /// Take the fleet that is built in; where one of its agents is refused, there are none. [`Answer::Fleet`].
    Load,
    /// Compute the table of the fleet. [`Answer::Computed`].
    Compute,
    /// All regions of an agent, of a table that was computed since the fleet last changed: an [`Answer::Region`] each, an
    /// [`Answer::Piece`] for each of its pieces, and [`Answer::End`].
    Row {
        /// The agent.
        ego: u16,
    },
    /// The first conflict of every two agents that have one, moving as they were given: an [`Answer::Conflict`] each,
    /// by the lower index, and [`Answer::End`]. The first overlap; where there is none, the first touch.
    Conflicts,
    /// Let an agent set off as late as it must to meet none of the others, moving as they do, and no later; what is
    /// answered from then on is about its new motion. The table, which must be that of the fleet, serves on.
    /// [`Answer::Replanned`].
    Replan {
        /// The agent.
        agent: u16,
    },
    /// Put another agent in the place of one. [`Answer::Fleet`].
    Replace {
        /// Its place.
        agent: u16,
        /// The other agent.
        with: Agent<S>,
    },
    /// Remove an agent; those behind it move up by one place. [`Answer::Fleet`].
    Remove {
        /// The agent.
        agent: u16,
    },
}

impl<S: Number> Request<S> {
    /// Whether it may change the fleet or its table; it has one answer then.
    pub fn changes(&self) -> bool {
        !matches!(self, Self::Hello | Self::Row { .. } | Self::Conflicts)
    }
}

/// An answer of the supervisor. Any request may be answered by [`Answer::Refused`] alone.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(bound = "")]
pub enum Answer<S: Number> {
    /// Its number format and capacities.
    Hello {
        /// [`Number::NAME`].
        format: Vec<u8, 8>,
        /// Most agents.
        agents: u16,
        /// Most lines and arcs of all agents.
        segments: u16,
        /// Most regions, each for both directions of a pair.
        regions: u16,
        /// Most pieces of regions.
        pieces: u16,
        /// The sequence number of the next request.
        next: u16,
    },
    /// It is done.
    Done,
    /// There are so many agents now, and no table of them.
    Fleet {
        /// Number of agents.
        agents: u16,
    },
    /// The table is complete.
    Computed {
        /// Number of regions, each for both directions of a pair.
        regions: u16,
        /// Number of pieces.
        pieces: u16,
    },
    /// A region of the agent that was asked for.
    Region(RegionRecord<S>),
    /// A piece of the region before.
    Piece(PieceRecord<S>),
    /// There are no more.
    End {
        /// Number of regions or conflicts sent.
        count: u16,
    },
    /// It was not done, and nothing has changed.
    Refused(Refusal),
    /// The first conflict of two agents.
    Conflict(ConflictRecord<S>),
    /// The motion of an agent now.
    Replanned {
        /// The agent.
        agent: u16,
        /// From setting off to arrival \[s\].
        time: Interval<S>,
    },
}

impl<S: Number> Answer<S> {
    /// Whether more answers to the same request follow.
    pub fn goes_on(&self) -> bool {
        matches!(self, Self::Region(_) | Self::Piece(_) | Self::Conflict(_))
    }
}

/// A region as it is sent.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct RegionRecord<S: Number> {
    /// Index of the agent whose region it is.
    pub ego: u16,
    /// Index of the agent it must keep clear of.
    pub other: u16,
    /// Time range \[s\].
    pub time: Interval<S>,
    /// Length range along the ego's path \[m\].
    pub length: Interval<S>,
    /// Length range along the other's path \[m\].
    pub other_length: Interval<S>,
    /// Whether it reaches back to before the other agent sets off.
    pub open_at_start: bool,
    /// Whether it goes on after the other agent's arrival.
    pub open_at_end: bool,
    /// Number of its pieces, which follow.
    pub pieces: u16,
}

/// A piece of a region as it is sent.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct PieceRecord<S: Number> {
    /// Places of the segments in the paths of the ego and of the other agent.
    pub segments: [u16; 2],
    /// Length range along the ego's path \[m\].
    pub length: Interval<S>,
    /// Length range along the other's path \[m\].
    pub other_length: Interval<S>,
}

/// The first conflict of two agents as it is sent.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct ConflictRecord<S: Number> {
    /// The two agents, the lower index first.
    pub agents: [u16; 2],
    /// From when to when their discs overlap \[s\].
    pub time: Interval<S>,
    /// Lengths along the path of each meanwhile \[m\].
    pub lengths: [Interval<S>; 2],
    /// Largest overlap \[m\].
    pub depth: S,
    /// Whether the two only touch.
    pub touching: bool,
}

impl<S: Number> ConflictRecord<S> {
    /// The first overlap of two agents of a fleet; the first touch where they do no more; `None` where they do neither.
    ///
    /// # Errors
    /// [`Refusal::NoSuchAgent`].
    pub fn first(fleet: &[Motion<'_, S>], agents: [usize; 2]) -> Result<Option<Self>, Refusal> {
        let motion = |agent| fleet.get(agent).ok_or(Refusal::NoSuchAgent { agent: short(agent) });
        let encounter = Encounter::new(motion(agents[0])?, motion(agents[1])?);
        let mut conflicts = encounter.conflicts(encounter.time());
        let Some(first) = conflicts.next() else { return Ok(None) };
        let overlap = if first.touching { conflicts.find(|conflict| !conflict.touching) } else { None };
        let conflict = overlap.unwrap_or(first);
        Ok(Some(Self {
            agents: agents.map(short),
            time: conflict.time,
            lengths: [conflict.length, conflict.other_length],
            depth: conflict.depth,
            touching: conflict.touching,
        }))
    }
}

/// Why a request was not done.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Refusal {
    /// A frame was damaged. Whose it was cannot be told: the sequence number is 0.
    Frame(Damage),
    /// The request is not the next one, nor the last one again: it comes too late, or the supervisor has started anew and
    /// knows of no fleet.
    Sequence {
        /// The sequence number of the next request.
        next: u16,
    },
    /// A value of an agent was refused: which, and why.
    Agent {
        /// The index that the agent has or was to have.
        agent: u16,
        /// The quantity, empty where there is no name for it.
        what: Vec<u8, 24>,
        /// What is wrong with it.
        why: Reason,
    },
    /// The table has no room for all regions; there is no table now.
    TableFull(Room),
    /// There is no such agent.
    NoSuchAgent {
        /// The one that was named.
        agent: u16,
    },
    /// There is no table of the fleet as it is: [`Request::Compute`] comes first.
    NotComputed,
    /// However late the agent sets off, it meets another one.
    NoPlan,
}

/// What of a table is full.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Room {
    /// More regions are needed.
    Regions,
    /// More pieces are needed.
    Pieces,
    /// No table holds these two agents: they have too many pieces.
    Pair([u16; 2]),
    /// Something else.
    Other,
}

/// [`Invalid`] without its words.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Reason {
    /// It is NaN or infinite.
    NonFinite,
    /// It is below zero.
    Negative,
    /// It is not above zero.
    NonPositive,
    /// Its magnitude is too large.
    OutOfRange,
    /// The arc sweeps more than one turn.
    SweepOverOneTurn,
    /// There is no room for another.
    Full,
    /// The agent is impossible in another way.
    Other,
}

impl<S: Number> RegionRecord<S> {
    /// A region of the table.
    pub fn of(region: &RegionRef<'_, S>) -> Self {
        Self {
            ego: short(region.ego()),
            other: short(region.other()),
            time: region.time(),
            length: region.length(),
            other_length: region.other_length(),
            open_at_start: region.is_open_at_start(),
            open_at_end: region.is_open_at_end(),
            pieces: region.pieces().fold(0, |count: u16, _| count.saturating_add(1)),
        }
    }
}

impl<S: Number> PieceRecord<S> {
    /// A piece of a region.
    pub fn of(piece: &PieceRef<'_, S>) -> Self {
        Self { segments: piece.segments.map(short), length: piece.length, other_length: piece.other_length }
    }
}

impl Refusal {
    /// An agent is refused.
    pub fn agent(agent: usize, invalid: Invalid) -> Self {
        let (why, what) = match invalid {
            Invalid::NonFinite(what) => (Reason::NonFinite, what),
            Invalid::Negative(what) => (Reason::Negative, what),
            Invalid::NonPositive(what) => (Reason::NonPositive, what),
            Invalid::OutOfRange(what) | Invalid::TooSmall(what) => (Reason::OutOfRange, what),
            Invalid::SweepOverOneTurn => (Reason::SweepOverOneTurn, ""),
            Invalid::Full(what) => (Reason::Full, what),
            _ => (Reason::Other, ""),
        };
        Self::Agent { agent: short(agent), what: text(what), why }
    }

    /// A change of an agent is refused.
    pub fn change(agent: usize, rejected: Rejected) -> Self {
        match rejected {
            Rejected::NoSuchAgent(agent) => Self::NoSuchAgent { agent: short(agent) },
            Rejected::Invalid(invalid) => Self::agent(agent, invalid),
        }
    }
}

impl From<Full> for Refusal {
    fn from(full: Full) -> Self {
        Self::TableFull(match full {
            Full::Regions => Room::Regions,
            Full::Pieces => Room::Pieces,
            Full::Pair(agents) => Room::Pair(agents.map(short)),
            _ => Room::Other,
        })
    }
}

impl From<Mismatch> for Refusal {
    fn from(mismatch: Mismatch) -> Self {
        match mismatch {
            Mismatch::NoSuchAgent(agent) => Self::NoSuchAgent { agent: short(agent) },
            _ => Self::NotComputed,
        }
    }
}

/// Counts and indices of the supervisor are below 65536.
pub(crate) fn short(count: usize) -> u16 {
    u16::try_from(count).unwrap_or(u16::MAX)
}

/// Text as it is sent: its bytes, as many as there is room for.
pub fn text<const N: usize>(text: &str) -> Vec<u8, N> {
    let mut bytes = Vec::new();
    for byte in text.bytes() {
        if bytes.push(byte).is_err() {
            break;
        }
    }
    bytes
}
