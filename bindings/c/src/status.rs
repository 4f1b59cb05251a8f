//! The C types that all number formats share.

use pcr_core::{Full, Invalid, Mismatch, Pass, Refused, Unchanged, Unsolved};

/// What a call comes to. Whatever fails leaves the fleet as it was; a table that became full is empty.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PcrStatus {
    /// Done.
    Ok = 0,
    /// A pointer is null.
    Null,
    /// A number is NaN or infinite.
    NonFinite,
    /// A number is below 0 that must not be.
    Negative,
    /// A number must be above 0.
    NonPositive,
    /// A number is beyond the range of the format, or a path or a motion gets there; the lower end of an interval is above the
    /// upper one.
    OutOfRange,
    /// An arc sweeps more than one turn: split it.
    SweepOverOneTurn,
    /// The profile does not travel the length of the path.
    LengthMismatch,
    /// A leg is neither a line nor an arc.
    NoSuchCurve,
    /// There is no agent of that number.
    NoSuchAgent,
    /// The memory has no room for another agent, or for its segments or phases.
    NoRoom,
    /// The table has no room for the entries, the pieces or the orders of all regions.
    TableFull,
    /// The buffer is too small; the count that is needed is told.
    BufferTooSmall,
    /// The table is not that of the agents: `pcr_fleet_build` was not called since the last was added.
    NotBuilt,
    /// The order does not list each agent once.
    BadOrder,
    /// There is no such plan: whoever waits, for however long, meets another one.
    NoPlan,
    /// A number is above 0, but less than the format can work with.
    TooSmall,
    /// The table is that of the row of another agent only (`pcr_fleet_build_row`).
    OnlyRow,
    /// There is no region of the agent in that place of the table.
    NoSuchRegion,
    /// The fleet was given no memory for orders.
    NoOrders,
    /// It is neither PCR_FIRST nor PCR_SECOND.
    NoSuchPass,
    /// Orders are refused; `why` tells who is in the way.
    Refused,
}

impl From<Invalid> for PcrStatus {
    fn from(invalid: Invalid) -> Self {
        match invalid {
            Invalid::NonFinite(_) => Self::NonFinite,
            Invalid::Negative(_) => Self::Negative,
            Invalid::NonPositive(_) => Self::NonPositive,
            Invalid::TooSmall(_) => Self::TooSmall,
            Invalid::SweepOverOneTurn => Self::SweepOverOneTurn,
            Invalid::LengthMismatch { .. } => Self::LengthMismatch,
            Invalid::Full(_) => Self::NoRoom,
            _ => Self::OutOfRange,
        }
    }
}

impl From<Full> for PcrStatus {
    fn from(_: Full) -> Self {
        Self::TableFull
    }
}

impl From<Mismatch> for PcrStatus {
    fn from(mismatch: Mismatch) -> Self {
        match mismatch {
            Mismatch::NoSuchAgent(_) => Self::NoSuchAgent,
            Mismatch::OnlyRow(_) => Self::OnlyRow,
            Mismatch::NoSuchRegion(_) => Self::NoSuchRegion,
            _ => Self::NotBuilt,
        }
    }
}

impl From<Unchanged> for PcrStatus {
    fn from(unchanged: Unchanged) -> Self {
        match unchanged {
            Unchanged::Full(full) => full.into(),
            Unchanged::Mismatch(mismatch) => mismatch.into(),
        }
    }
}

impl From<Refused> for PcrStatus {
    fn from(refused: Refused) -> Self {
        match refused {
            Refused::Mismatch(mismatch) => mismatch.into(),
            Refused::Full(full) => full.into(),
            _ => Self::Refused,
        }
    }
}

/// `PcrLeg.curve` of a straight line.
pub const PCR_LINE: u8 = 0;
/// `PcrLeg.curve` of an arc that turns left, counter-clockwise.
pub const PCR_LEFT: u8 = 1;
/// `PcrLeg.curve` of an arc that turns right, clockwise.
pub const PCR_RIGHT: u8 = 2;

/// `PcrPassing.pass` of a region that nothing is decided about: neither agent may enter it.
pub const PCR_UNDECIDED: u8 = 0;
/// The agent passes the region first.
pub const PCR_FIRST: u8 = 1;
/// The agent waits until the other one is through.
pub const PCR_SECOND: u8 = 2;
/// One of the two has left the region behind.
pub const PCR_OVER: u8 = 3;

/// A pass as C has it.
pub(crate) fn pass(pass: Pass) -> u8 {
    match pass {
        Pass::Undecided => PCR_UNDECIDED,
        Pass::First => PCR_FIRST,
        Pass::Second => PCR_SECOND,
        Pass::Over => PCR_OVER,
    }
}

/// A decision.
pub(crate) fn decision(pass: u8) -> Result<Pass, PcrStatus> {
    match pass {
        PCR_FIRST => Ok(Pass::First),
        PCR_SECOND => Ok(Pass::Second),
        _ => Err(PcrStatus::NoSuchPass),
    }
}

/// How far an agent may go.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PcrHoldKind {
    /// Nowhere: where it is the other one will pass. It can only be first.
    #[default]
    Inside,
    /// Up to a length of its path, where it may stand.
    At,
    /// To the end of its path.
    Free,
}

/// Why there is no plan.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PcrReason {
    /// The two overlap at the starts of their paths.
    Starts,
    /// The two overlap at the ends of their paths.
    Ends,
    /// The two meet however late either sets off.
    Always,
    /// The first cannot go because of the second, with the orders that were tried.
    Order,
    /// The check of the plan found that the two overlap.
    Overlap,
    /// The times of the first are out of range.
    Times,
}

/// Why there is no plan, and of whom.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PcrUnsolved {
    /// The reason.
    pub reason: PcrReason,
    /// The agents; twice the same where it is one.
    pub agents: [usize; 2],
}

impl From<Unsolved> for PcrUnsolved {
    fn from(unsolved: Unsolved) -> Self {
        let (reason, agents) = match unsolved {
            Unsolved::Starts(agents) => (PcrReason::Starts, agents),
            Unsolved::Ends(agents) => (PcrReason::Ends, agents),
            Unsolved::Always(agents) => (PcrReason::Always, agents),
            Unsolved::Priorities(agents) => (PcrReason::Order, agents),
            Unsolved::Overlap(agents) => (PcrReason::Overlap, agents),
            Unsolved::Full(agent) => (PcrReason::Times, [agent; 2]),
            _ => (PcrReason::Times, [usize::MAX; 2]),
        };
        Self { reason, agents }
    }
}

/// Why orders are refused.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PcrRefusal {
    /// The first agent would wait for the second for ever.
    Stuck,
    /// The first agent is where it should have waited for the second.
    Late,
    /// The second agent is in the way of the first, whoever of them goes first.
    Blocked,
    /// By their motions the two meet, or pass so near that it cannot be told who is first.
    Meeting,
}

/// Why orders are refused, and who is in the way.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PcrRefused {
    /// The reason.
    pub reason: PcrRefusal,
    /// The agents.
    pub agents: [usize; 2],
}

impl PcrRefused {
    /// What there is to tell; nothing of what the status says by itself.
    pub(crate) fn of(refused: Refused) -> Option<Self> {
        let (reason, agents) = match refused {
            Refused::Stuck { agent, by, .. } => (PcrRefusal::Stuck, [agent, by]),
            Refused::Late { agent, by, .. } => (PcrRefusal::Late, [agent, by]),
            Refused::Blocked { agent, by } => (PcrRefusal::Blocked, [agent, by]),
            Refused::Meeting(agents) => (PcrRefusal::Meeting, agents),
            _ => return None,
        };
        Some(Self { reason, agents })
    }
}
