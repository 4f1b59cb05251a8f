//! The messages on the line. Within a version of the protocol, kinds of messages are only ever added, at the end of
//! each list.

use crate::agent::{Agent, MAX_STEPS, Step};
use crate::fleet::Rejected;
use crate::frame::Damage;
use crate::number::Number;
use heapless::Vec;
use pcr_core::{
    Encounter, Full, Interval, Invalid, Limits, Mismatch, Motion, Pass, PieceRef, Refused, RegionRef, Unchanged,
};
use serde::{Deserialize, Serialize};

/// A request to the supervisor. It is answered before the next one is read.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(bound = "")]
pub enum Request<S: Number> {
    /// Greeting: asks for format and capacities. [`Answer::Hello`]. It is answered whatever its sequence number is.
    Hello,
    /// Removes all agents. [`Answer::Done`].
    Clear,
    /// Adds an agent. [`Answer::Fleet`].
    Add(Agent<S>),
    /// Loads the built-in fleet; if one of its agents is refused, there are none. [`Answer::Fleet`].
    Load,
    /// Computes the table of the fleet. [`Answer::Computed`].
    Compute,
    /// Asks for all regions of an agent. The table must have been computed since the fleet last changed. Answers: for
    /// each region an [`Answer::Region`] and an [`Answer::Piece`] for each of its pieces; then [`Answer::End`].
    Row {
        /// The agent.
        ego: u16,
    },
    /// Asks for the first conflict of every pair of agents, on their present motions: an [`Answer::Conflict`] for each
    /// pair that has one, sorted by the lower index, and [`Answer::End`]. It is the first overlap, or the first touch
    /// if there is no overlap.
    Conflicts,
    /// Delays an agent's start by the least delay with which it meets none of the others on their present motions.
    /// Later answers are about its new motion. The table must be that of the fleet, and stays valid.
    /// [`Answer::Replanned`].
    Replan {
        /// The agent.
        agent: u16,
    },
    /// Replaces an agent; its regions are computed again, if there is a table. [`Answer::Fleet`].
    Replace {
        /// Index of the agent.
        agent: u16,
        /// The new agent.
        with: Agent<S>,
    },
    /// Removes an agent; the index of every agent behind it decreases by one. The table, if there is one, stays valid.
    /// [`Answer::Fleet`].
    Remove {
        /// The agent.
        agent: u16,
    },
    /// Starts all robots, in the order in which their motions pass one another. From now on until [`Request::Clear`]
    /// the fleet changes by [`Request::Admit`] only. All robots stand at the starts of their paths.
    /// [`Answer::Edition`].
    Order(Terms<S>),
    /// Reports the place of a robot. A robot may send it at any time; the more often it does, the less it waits.
    /// Answers: an [`Answer::Place`] for each robot that it has to wait for, and [`Answer::Go`].
    Report {
        /// The robot.
        agent: u16,
        /// Edition of the orders that the robot has.
        edition: Edition,
        /// Place of the robot on its path \[m\]: it is not further back than `lo`, nor further on than `hi`.
        at: Interval<S>,
    },
    /// Asks for the orders of a robot. Answers: an [`Answer::Member`] for itself and each robot with which it has
    /// regions, sorted by index; an [`Answer::Passing`] for each of these regions; and [`Answer::Orders`].
    Orders {
        /// The robot.
        agent: u16,
    },
    /// Gives a robot that is at the end of its path another path, which begins there, with orders with which all robots
    /// can finish. [`Answer::Edition`].
    Admit {
        /// The robot.
        agent: u16,
        /// Direction in which the robot sets off; it may turn in place first.
        heading: S::Angle,
        /// Largest speed and acceleration.
        limits: Limits<S>,
        /// The path.
        path: Vec<Step<S>, MAX_STEPS>,
    },
}

/// Parameters of a run.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct Terms<S: Number> {
    /// Number of the run: not 0, and different from that of any run whose robots may still be moving.
    pub run: u16,
    /// How far beyond its last place a robot may be sent \[m\]: more than the distance that it goes until its next
    /// report, plus a stopping distance. Parts of its path that are further ahead can still be given to others.
    pub horizon: S,
    /// When a robot stands, the known lower end of its place may be behind it by up to this \[m\]. A report may be as
    /// far behind what the robot has reported before; one that is further behind is refused.
    pub width: S,
}

/// Edition of orders.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Edition {
    /// Number of the run; 0 means no run.
    pub run: u16,
    /// How often orders have changed in the run.
    pub number: u16,
}

impl<S: Number> Request<S> {
    /// Whether the request may change the fleet or its table; it then has one answer.
    pub fn changes(&self) -> bool {
        !matches!(self, Self::Hello | Self::Row { .. } | Self::Conflicts) && !self.is_of_robots()
    }

    /// The robot that the request is about, if it is one that robots send about themselves.
    pub(crate) fn robot(&self) -> Option<u16> {
        match *self {
            Self::Report { agent, .. } | Self::Orders { agent } => Some(agent),
            _ => None,
        }
    }

    /// Whether a robot may send the request, with sequence numbers of its own: executing it twice, late or in another
    /// order does no harm.
    pub fn is_of_robots(&self) -> bool {
        *self == Self::Hello || self.robot().is_some()
    }
}

/// An answer of the supervisor. Any request may be answered by a single [`Answer::Refused`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(bound = "")]
pub enum Answer<S: Number> {
    /// Number format and capacities of the supervisor.
    Hello {
        /// [`Number::NAME`].
        format: Vec<u8, 8>,
        /// Largest number of agents.
        agents: u16,
        /// Largest number of lines and arcs of all agents.
        segments: u16,
        /// Largest number of regions, each for both directions of a pair.
        regions: u16,
        /// Largest number of pieces of regions.
        pieces: u16,
        /// The sequence number of the next request.
        next: u16,
    },
    /// The request was executed.
    Done,
    /// The number of agents has changed. After a [`Request::Replace`] or [`Request::Remove`] there is a table if there
    /// was one before and the regions fit.
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
    /// A piece of the region that was sent last.
    Piece(PieceRecord<S>),
    /// The end of a list.
    End {
        /// Number of regions or conflicts sent.
        count: u16,
    },
    /// The request was not executed, and nothing has changed.
    Refused(Refusal),
    /// The first conflict of two agents.
    Conflict(ConflictRecord<S>),
    /// The new motion of an agent.
    Replanned {
        /// The agent.
        agent: u16,
        /// The interval from start to arrival \[s\].
        time: Interval<S>,
    },
    /// The edition that is valid from now on.
    Edition(Edition),
    /// A robot has reached at least this length.
    Place {
        /// The robot.
        agent: u16,
        /// Edition of the orders of that robot.
        edition: Edition,
        /// Length along its path \[m\].
        at: S,
    },
    /// A robot may go this far if its hold allows it. It never goes beyond the furthest length that it was given.
    Go {
        /// The robot.
        agent: u16,
        /// Edition of its orders.
        edition: Edition,
        /// Length along its path \[m\].
        to: S,
    },
    /// A robot that has regions with the one that asks, or that one itself.
    Member {
        /// The robot.
        agent: u16,
        /// Edition of these orders.
        edition: Edition,
        /// Its disc and path, and the limits that it was planned with.
        with: Agent<S>,
    },
    /// The next region of the robot, sorted by the other robot as in a row, and the order in which it passes the
    /// region.
    Passing {
        /// The other robot.
        other: u16,
        /// Edition of these orders.
        edition: Edition,
        /// The order seen by the robot that asks.
        pass: Pass,
        /// Length on its path at which the region begins \[m\]; both ends of the line compute the same value.
        from: S,
    },
    /// All orders of a robot have been sent.
    Orders {
        /// The robot.
        agent: u16,
        /// Edition of the orders.
        edition: Edition,
        /// [`Edition::number`] in which the robot got its path.
        path: u16,
        /// What is known of its place on this path \[m\]: the length that it has reported, and the length that it was
        /// given. It stands at the start if that is 0.
        at: Interval<S>,
    },
}

impl<S: Number> Answer<S> {
    /// Whether more answers to the same request follow.
    pub fn goes_on(&self) -> bool {
        matches!(
            self,
            Self::Region(_)
                | Self::Piece(_)
                | Self::Conflict(_)
                | Self::Place { .. }
                | Self::Member { .. }
                | Self::Passing { .. }
        )
    }
}

/// A region in an answer.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct RegionRecord<S: Number> {
    /// Index of the agent whose region it is.
    pub ego: u16,
    /// Index of the agent it must keep clear of.
    pub other: u16,
    /// Time range \[s\].
    pub time: Interval<S>,
    /// Range of lengths along the ego's path \[m\].
    pub length: Interval<S>,
    /// Range of lengths along the other's path \[m\].
    pub other_length: Interval<S>,
    /// Whether the region begins while the other agent stands at its start.
    pub open_at_start: bool,
    /// Whether the region ends while the other agent stands at its end.
    pub open_at_end: bool,
    /// Number of its pieces; they follow.
    pub pieces: u16,
}

/// A piece of a region in an answer: a rectangle of lengths that contains all of its contacts. It does not say which of
/// two laps of an arc the piece belongs to, so slices, which may be less than the rectangle, cannot be computed from
/// it; `dump::table` prints everything.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct PieceRecord<S: Number> {
    /// Indices of the segments in the paths of the ego and of the other agent.
    pub segments: [u16; 2],
    /// Range of lengths along the ego's path \[m\].
    pub length: Interval<S>,
    /// Range of lengths along the other's path \[m\].
    pub other_length: Interval<S>,
}

/// The first conflict of two agents in an answer.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct ConflictRecord<S: Number> {
    /// The two agents, the lower index first.
    pub agents: [u16; 2],
    /// Interval of time in which their discs overlap \[s\].
    pub time: Interval<S>,
    /// Lengths along the path of each agent during the conflict \[m\].
    pub lengths: [Interval<S>; 2],
    /// Largest overlap \[m\].
    pub depth: S,
    /// Whether the two only touch.
    pub touching: bool,
}

impl<S: Number> ConflictRecord<S> {
    /// The first overlap of two agents of a fleet; the first touch if they do not overlap; `None` if they do not touch
    /// either.
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
    /// A term is out of range, or the number of the run is 0 or that of the last run.
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

impl From<Refused> for Refusal {
    fn from(refused: Refused) -> Self {
        match refused {
            Refused::Meeting(agents) => Self::Meeting(agents.map(short)),
            Refused::Stuck { agent, by, .. } | Refused::Late { agent, by, .. } => Self::Stuck([agent, by].map(short)),
            Refused::Blocked { agent, by } => Self::Blocked([agent, by].map(short)),
            Refused::Full(full) => full.into(),
            Refused::Mismatch(mismatch) => mismatch.into(),
            _ => Self::TableFull(Room::Other),
        }
    }
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

/// [`Invalid`] without its text.
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

impl<S: Number> RegionRecord<S> {
    /// Makes a record of a region.
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
    /// Makes a record of a piece of a region.
    pub fn of(piece: &PieceRef<'_, S>) -> Self {
        Self { segments: piece.segments.map(short), length: piece.length, other_length: piece.other_length }
    }
}

impl Refusal {
    /// The refusal of an agent.
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

    /// The refusal of a change of an agent.
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

impl From<Unchanged> for Refusal {
    fn from(unchanged: Unchanged) -> Self {
        match unchanged {
            Unchanged::Full(full) => full.into(),
            Unchanged::Mismatch(mismatch) => mismatch.into(),
        }
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

/// Converts a count or index, which is below 65536 in the supervisor.
pub(crate) fn short(count: usize) -> u16 {
    u16::try_from(count).unwrap_or(u16::MAX)
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
