//! Why there are no dependencies.

use pcr_core::{CapacityError, InvalidInput};
use std::fmt;

/// Why there are no dependencies.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Error {
    /// A trajectory has no waypoint.
    Empty {
        /// The agent.
        agent: usize,
    },
    /// A trajectory has no footprint: [`Trajectory::with_footprint`](crate::Trajectory::with_footprint) gives it one.
    NoFootprint {
        /// The agent.
        agent: usize,
    },
    /// A waypoint is not later than the one before it.
    Time {
        /// The agent.
        agent: usize,
        /// The waypoint.
        waypoint: usize,
    },
    /// On the way to a waypoint an outline moves and turns at the same time, which is neither a line nor a turn in place.
    TurnsOnTheWay {
        /// The agent.
        agent: usize,
        /// The waypoint.
        waypoint: usize,
    },
    /// On the way to a waypoint an outline turns by half a turn, and the waypoints do not say to which side: one in between does.
    HalfTurn {
        /// The agent.
        agent: usize,
        /// The waypoint.
        waypoint: usize,
    },
    /// A number is not finite, or out of range.
    Invalid {
        /// The agent.
        agent: usize,
        /// What is wrong.
        problem: InvalidInput,
    },
    /// By their times two agents collide, or pass so close that it cannot be decided which one is first.
    Meeting {
        /// The agents.
        agents: [usize; 2],
    },
    /// In steps of these waypoints agents would wait for one another in a circle. With waypoints in between
    /// ([`Trajectory::divided`](crate::Trajectory::divided)) there may be an order.
    Circle {
        /// Each agent and the waypoint that it could not head for.
        waits: Vec<(usize, usize)>,
    },
    /// The regions of two agents do not fit into memory.
    Memory(CapacityError),
    /// There are not as many waypoints reached as agents.
    Agents {
        /// How many there are.
        given: usize,
        /// How many are expected.
        expected: usize,
    },
    /// There is no agent of this index.
    NoSuchAgent {
        /// The index.
        agent: usize,
    },
    /// A trajectory has no waypoint of this index.
    NoSuchWaypoint {
        /// The agent.
        agent: usize,
        /// The index.
        waypoint: usize,
    },
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Empty { agent } => write!(f, "agent {agent}: its trajectory has no waypoint"),
            Self::NoFootprint { agent } => write!(f, "agent {agent}: its footprint is missing"),
            Self::Time { agent, waypoint } => {
                write!(f, "agent {agent}: waypoint {waypoint} is not later than the one before it")
            }
            Self::TurnsOnTheWay { agent, waypoint } => {
                write!(f, "agent {agent}: it moves and turns at the same time on the way to waypoint {waypoint}")
            }
            Self::HalfTurn { agent, waypoint } => {
                write!(
                    f,
                    "agent {agent}: it is not said to which side it makes half a turn on the way to waypoint {waypoint}"
                )
            }
            Self::Invalid { agent, problem } => write!(f, "agent {agent}: {problem}"),
            Self::Meeting { agents: [a, b] } => write!(f, "agents {a} and {b} collide at the times of the plan"),
            Self::Circle { waits } => {
                f.write_str("agents would wait for one another in a circle:")?;
                waits.iter().enumerate().try_for_each(|(k, (agent, waypoint))| {
                    let comma = if k == 0 { "" } else { "," };
                    write!(f, "{comma} agent {agent} before waypoint {waypoint}")
                })
            }
            Self::Memory(full) => full.fmt(f),
            Self::Agents { given, expected } => write!(f, "{given} agents, and the plan has {expected}"),
            Self::NoSuchAgent { agent } => write!(f, "there is no agent {agent}"),
            Self::NoSuchWaypoint { agent, waypoint } => write!(f, "agent {agent}: there is no waypoint {waypoint}"),
        }
    }
}

impl std::error::Error for Error {}
