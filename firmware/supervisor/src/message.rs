//! What the two ends of the line say to each other. Within a version of the protocol, kinds are only ever added, at the
//! end of each list.

use crate::agent::{Agent, MAX_STEPS, Step};
use crate::fleet::Rejected;
use crate::frame::Damage;
use crate::number::Number;
use heapless::Vec;
use pcr_core::{
    Encounter, Full, Interval, Invalid, Limits, Mismatch, Motion, Pass, PieceRef, Refused, RegionRef, Unchanged,
};
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
    /// Put another agent in the place of one; its regions are computed anew, if there is a table. [`Answer::Fleet`].
    Replace {
        /// Its place.
        agent: u16,
        /// The other agent.
        with: Agent<S>,
    },
    /// Remove an agent; those behind it move up by one place, and the table, if there is one, serves on. [`Answer::Fleet`].
    Remove {
        /// The agent.
        agent: u16,
    },
    /// Let all set off, in the order in which their motions pass one another: from now on until [`Request::Clear`] the fleet
    /// changes by [`Request::Admit`] only. All stand at the starts of their paths. [`Answer::Edition`].
    Order(Terms<S>),
    /// Where a robot is; sent as often as it likes, the more often the less it waits. An [`Answer::Place`] for each robot that
    /// it has to wait for, and [`Answer::Go`].
    Report {
        /// The robot.
        agent: u16,
        /// That of the orders which it has.
        edition: Edition,
        /// Where it is on its path \[m\].
        at: Interval<S>,
    },
    /// The orders of a robot: an [`Answer::Member`] for itself and each robot with which it has regions, by index, an
    /// [`Answer::Passing`] for each of these regions, and [`Answer::Orders`].
    Orders {
        /// The robot.
        agent: u16,
    },
    /// Give a robot that is at the end of its path another one, which begins there, with orders so that everybody can finish.
    /// [`Answer::Edition`].
    Admit {
        /// The robot.
        agent: u16,
        /// Direction in which it sets off: it may turn round where it stands.
        heading: S::Angle,
        /// Largest speed and acceleration.
        limits: Limits<S>,
        /// The path.
        path: Vec<Step<S>, MAX_STEPS>,
    },
}

/// What holds while robots are under way.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct Terms<S: Number> {
    /// Number of the run, not 0, and another one than that of any run whose robots may still be about.
    pub run: u16,
    /// How far beyond its last place a robot may be sent \[m\]: more than it goes until it is heard again, and a stopping way.
    /// What is far ahead can still be given to others.
    pub horizon: S,
    /// So far the lower end of a robot's place may be behind it when it stands \[m\].
    pub width: S,
}

/// Which orders these are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Edition {
    /// Number of the run; 0 is none.
    pub run: u16,
    /// How often orders have changed in it.
    pub number: u16,
}

impl<S: Number> Request<S> {
    /// Whether it may change the fleet or its table; it has one answer then.
    pub fn changes(&self) -> bool {
        !matches!(self, Self::Hello | Self::Row { .. } | Self::Conflicts) && !self.is_of_robots()
    }

    /// Whether a robot may ask it, with numbers of its own: to do it twice, late or in another order does no harm.
    pub fn is_of_robots(&self) -> bool {
        matches!(self, Self::Hello | Self::Report { .. } | Self::Orders { .. })
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
    /// There are so many agents now. Their table is there if it was before a [`Request::Replace`] or [`Request::Remove`] and has
    /// room.
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
    /// The orders that count from now on.
    Edition(Edition),
    /// A robot has got so far at least.
    Place {
        /// The robot.
        agent: u16,
        /// That of the orders by which it goes.
        edition: Edition,
        /// Length along its path \[m\].
        at: S,
    },
    /// A robot may go so far if its hold allows it: it never goes beyond the furthest that it was given.
    Go {
        /// The robot.
        agent: u16,
        /// That of its orders.
        edition: Edition,
        /// Length along its path \[m\].
        to: S,
    },
    /// A robot whose way crosses that of the one that asks, or that one itself.
    Member {
        /// The robot.
        agent: u16,
        /// That of these orders.
        edition: Edition,
        /// Its disc and path, and the limits that it was planned with.
        with: Agent<S>,
    },
    /// The next region of the robot, by the other one as in a row, and whether it passes it first.
    Passing {
        /// The other robot.
        other: u16,
        /// That of these orders.
        edition: Edition,
        /// As the robot sees it that asks.
        pass: Pass,
        /// Where the region begins on its path \[m\]: both ends compute the same.
        from: S,
    },
    /// All orders of a robot were sent.
    Orders {
        /// The robot.
        agent: u16,
        /// Which they are.
        edition: Edition,
        /// [`Edition::number`] with which it got its path.
        path: u16,
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

/// A piece of a region as it is sent: a rectangle of lengths that holds all of its contacts. Which of two laps of an arc it stands
/// for is not told, so that slices cannot be had from it, which may be less than the rectangle; `dump::table` prints all.
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
    /// The table has no room for two agents, or for what they need to be under way; there is no table now.
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
    /// This supervisor has no memory for orders.
    NoOrders,
    /// Robots are under way, and the fleet does not change but by [`Request::Admit`].
    Running,
    /// No robots are under way.
    NotRunning,
    /// Terms are out of range, or the number of the run is that of the last one.
    Terms,
    /// Orders have changed: [`Request::Orders`] tells which they are.
    Edition(Edition),
    /// The place of a robot is none on its path, or beyond what it was given.
    Beyond {
        /// The robot.
        agent: u16,
    },
    /// The robot is not known to be at the end of its path.
    NotThere {
        /// The robot.
        agent: u16,
    },
    /// By their motions two agents meet, or pass so near that it cannot be told who is first.
    Meeting([u16; 2]),
    /// The first would wait for the second for ever.
    Stuck([u16; 2]),
    /// The second is in the way of the first, whoever of them goes first.
    Blocked([u16; 2]),
    /// A robot may greet, report, and ask for its orders.
    Robot,
    /// The table has no room for all regions of the fleet, which needs as many as this, or more where it is 65535; there is no table now.
    Needs {
        /// Regions, each for both directions of a pair; as many orders, where there are any.
        regions: u16,
        /// Pieces of these.
        pieces: u16,
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
