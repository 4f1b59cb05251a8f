//! What is the same in all number formats: C types, and the check for null pointers.

use pcr_core::{AdmissionError, CapacityError, EcmError, InvalidInput, MismatchError, PassingState, PlanError};

/// Result of a call. A call that fails leaves the fleet unchanged, except that a table which became full when it was
/// built is empty.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PcrStatus {
    /// The call succeeded.
    Ok = 0,
    /// A pointer is null.
    Null,
    /// A number is NaN or infinite.
    NonFinite,
    /// A number is below 0 but must not be.
    Negative,
    /// A number is not above 0 but must be.
    NonPositive,
    /// A number is beyond the range of the format, or a path or a motion leaves it; or the lower end of an interval is
    /// above the upper one; or none of the lengths is on the path.
    OutOfRange,
    /// An arc sweeps more than one turn. Split it.
    SweepOverOneTurn,
    /// The profile is longer or shorter than the path.
    LengthMismatch,
    /// The curve of a leg is neither PCR_LINE, PCR_LEFT nor PCR_RIGHT.
    NoSuchCurve,
    /// There is no agent with this number.
    NoSuchAgent,
    /// The memory has no room for another agent, or for its segments or phases.
    NoRoom,
    /// The table has no room for the entries, the pieces or the orders of all regions: it needs more memory.
    TableFull,
    /// The buffer is too small. It was filled, and the required count was written.
    BufferTooSmall,
    /// The table does not belong to the agents: it was not built since the last agent was added, or an agent was
    /// replaced or removed after `pcr_fleet_build_row`.
    NotBuilt,
    /// The order does not list every agent exactly once.
    BadOrder,
    /// There is no plan: an agent meets another one, however long it waits.
    NoPlan,
    /// A number is above 0, but too small for the format.
    TooSmall,
    /// The table holds the row of another agent only (`pcr_fleet_build_row`).
    OnlyRow,
    /// The agent has no region at this index of the table.
    NoSuchRegion,
    /// The fleet was given no memory for orders.
    NoOrders,
    /// The value is neither PCR_FIRST nor PCR_SECOND.
    NoSuchPass,
    /// Orders are refused; `why` names the agent in the way.
    Refused,
    /// Two agents have more than 32767 pieces with each other, or the fleet has more than 65536 agents. More memory does
    /// not help.
    TooLarge,
}

/// Checks that a pointer is not null.
pub(crate) fn given<T>(pointer: Option<T>) -> Result<T, PcrStatus> {
    pointer.ok_or(PcrStatus::Null)
}

impl From<InvalidInput> for PcrStatus {
    fn from(invalid: InvalidInput) -> Self {
        match invalid {
            InvalidInput::NonFinite(_) => Self::NonFinite,
            InvalidInput::Negative(_) => Self::Negative,
            InvalidInput::NonPositive(_) => Self::NonPositive,
            InvalidInput::TooSmall(_) => Self::TooSmall,
            InvalidInput::SweepOverOneTurn => Self::SweepOverOneTurn,
            InvalidInput::LengthMismatch { .. } => Self::LengthMismatch,
            InvalidInput::Full(_) => Self::NoRoom,
            _ => Self::OutOfRange,
        }
    }
}

impl From<CapacityError> for PcrStatus {
    fn from(full: CapacityError) -> Self {
        match full {
            CapacityError::Pair(_) | CapacityError::Agents => Self::TooLarge,
            _ => Self::TableFull,
        }
    }
}

impl From<MismatchError> for PcrStatus {
    fn from(mismatch: MismatchError) -> Self {
        match mismatch {
            MismatchError::NoSuchAgent(_) => Self::NoSuchAgent,
            MismatchError::OnlyRow(_) => Self::OnlyRow,
            MismatchError::NoSuchRegion(_) => Self::NoSuchRegion,
            _ => Self::NotBuilt,
        }
    }
}

impl From<EcmError> for PcrStatus {
    fn from(error: EcmError) -> Self {
        match error {
            EcmError::Full(full) => full.into(),
            EcmError::Mismatch(mismatch) => mismatch.into(),
        }
    }
}

impl From<AdmissionError> for PcrStatus {
    fn from(refused: AdmissionError) -> Self {
        match refused {
            AdmissionError::Mismatch(mismatch) => mismatch.into(),
            AdmissionError::Full(full) => full.into(),
            _ => Self::Refused,
        }
    }
}

/// `PcrPathSegment.curve` of a straight line.
pub const PCR_LINE: u8 = 0;
/// `PcrPathSegment.curve` of an arc that turns left, counter-clockwise.
pub const PCR_LEFT: u8 = 1;
/// `PcrPathSegment.curve` of an arc that turns right, clockwise.
pub const PCR_RIGHT: u8 = 2;

/// `PcrRegionPrecedence.pass` of a region that is undecided: neither agent may enter it.
pub const PCR_UNDECIDED: u8 = 0;
/// The agent passes the region first.
pub const PCR_FIRST: u8 = 1;
/// The agent waits until the other one has left the region.
pub const PCR_SECOND: u8 = 2;
/// One of the two agents has left the region.
pub const PCR_OVER: u8 = 3;

/// Converts a pass to C.
pub(crate) fn pass(pass: PassingState) -> u8 {
    match pass {
        PassingState::Undecided => PCR_UNDECIDED,
        PassingState::First => PCR_FIRST,
        PassingState::Second => PCR_SECOND,
        PassingState::Over => PCR_OVER,
    }
}

/// Converts a decision from C.
pub(crate) fn decision(pass: u8) -> Result<PassingState, PcrStatus> {
    match pass {
        PCR_FIRST => Ok(PassingState::First),
        PCR_SECOND => Ok(PassingState::Second),
        _ => Err(PcrStatus::NoSuchPass),
    }
}

/// Kind of a limit on how far an agent may go.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PcrAuthorityKind {
    /// The agent stands where the other agent will pass. It can only go first.
    #[default]
    Inside,
    /// The agent may go up to a length of its path, and may stand there.
    At,
    /// The agent may go to the end of its path.
    Free,
}

/// Why there is no plan.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PcrPlanErrorKind {
    /// The two agents overlap at the starts of their paths.
    Starts,
    /// The two agents overlap at the ends of their paths.
    Ends,
    /// The two agents meet however late either of them starts.
    Always,
    /// The first agent cannot go because of the second, with the priorities that were tried.
    Order,
    /// The check of the plan found that the two agents overlap.
    Overlap,
    /// The times of the first agent are out of range.
    Times,
}

/// Why there is no plan, and the agents concerned.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PcrPlanError {
    /// The reason.
    pub reason: PcrPlanErrorKind,
    /// The agents; twice the same number if only one is concerned.
    pub agents: [usize; 2],
}

impl From<PlanError> for PcrPlanError {
    fn from(unsolved: PlanError) -> Self {
        let (reason, agents) = match unsolved {
            PlanError::Starts(agents) => (PcrPlanErrorKind::Starts, agents),
            PlanError::Ends(agents) => (PcrPlanErrorKind::Ends, agents),
            PlanError::Always(agents) => (PcrPlanErrorKind::Always, agents),
            PlanError::Priorities(agents) => (PcrPlanErrorKind::Order, agents),
            PlanError::Overlap(agents) => (PcrPlanErrorKind::Overlap, agents),
            PlanError::Invalid { agent, .. } => (PcrPlanErrorKind::Times, [agent; 2]),
            _ => (PcrPlanErrorKind::Times, [usize::MAX; 2]),
        };
        Self { reason, agents }
    }
}

/// Why orders are refused.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PcrAdmissionErrorKind {
    /// The first agent would wait for the second for ever.
    Stuck,
    /// The first agent is where it should have waited for the second.
    Late,
    /// The second agent is in the way of the first, whichever of them goes first.
    Blocked,
    /// According to their motions the two agents meet, or pass so close that it cannot be decided which one is first.
    Meeting,
}

/// Why orders are refused, and the agents concerned.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PcrAdmissionError {
    /// The reason.
    pub reason: PcrAdmissionErrorKind,
    /// The agents.
    pub agents: [usize; 2],
}

impl PcrAdmissionError {
    /// The reason for C; `None` if the status alone says it.
    pub(crate) fn of(refused: AdmissionError) -> Option<Self> {
        let (reason, agents) = match refused {
            AdmissionError::Stuck { agent, by, .. } => (PcrAdmissionErrorKind::Stuck, [agent, by]),
            AdmissionError::Late { agent, by, .. } => (PcrAdmissionErrorKind::Late, [agent, by]),
            AdmissionError::Blocked { agent, by } => (PcrAdmissionErrorKind::Blocked, [agent, by]),
            AdmissionError::Meeting(agents) => (PcrAdmissionErrorKind::Meeting, agents),
            _ => return None,
        };
        Some(Self { reason, agents })
    }
}
