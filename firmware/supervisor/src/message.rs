//! The messages on the line. Within a version of the protocol, kinds of messages are only ever added, at the end of
//! each list.

mod record;
mod refusal;

use crate::agent::{Agent, MAX_STEPS, Step};
use crate::number::Number;
use heapless::Vec;
use pcr_core::{Interval, Limits, PassingState};
pub use record::{ConflictRecord, PieceRecord, RegionRecord};
pub use refusal::{Reason, Refusal, Room, text};
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
        /// Place of the robot on its path \[m\]: it is not further back than `lo`, nor further on than `hi`. Neither is more than the robot
        /// was told, 0 at first: one that obeys limits what it measures to that. It has arrived when `lo` is the length of its path.
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
        pass: PassingState,
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

/// Converts a count or index, which is below 65536 in the supervisor.
pub(crate) fn short(count: usize) -> u16 {
    u16::try_from(count).unwrap_or(u16::MAX)
}
