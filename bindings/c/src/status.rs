//! What is the same in all number formats: C types, and the check for null pointers.

use core::ffi::{CStr, c_char, c_int};
use pcr_core::{AdmissionError, CapacityError, EcmError, InvalidInput, MismatchError, PassingState, PlanError};

/// Result of a call. A call that fails leaves the fleet unchanged, except that a table which became full when it was
/// built is empty.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PcrStatus {
    /// The call succeeded.
    Ok = 0,
    /// A pointer is null.
    Null = 1,
    /// A number is NaN or infinite.
    NonFinite = 2,
    /// A number is below 0 but must not be.
    Negative = 3,
    /// A number is not above 0 but must be.
    NonPositive = 4,
    /// A number is beyond the range of the format, or a path or a motion leaves it; or the lower end of an interval is
    /// above the upper one; or none of the lengths is on the path.
    OutOfRange = 5,
    /// An arc sweeps more than one turn. Split it.
    SweepOverOneTurn = 6,
    /// The profile is longer or shorter than the path.
    LengthMismatch = 7,
    /// The curve of a leg is none of PCR_LINE, PCR_LEFT, PCR_RIGHT, PCR_PIVOT_LEFT, PCR_PIVOT_RIGHT and PCR_REVERSE.
    NoSuchCurve = 8,
    /// There is no agent with this number.
    NoSuchAgent = 9,
    /// The memory has no room for another agent, or for its segments, phases or corners.
    NoRoom = 10,
    /// The table has no room for the entries, the pieces or the orders of all regions: it needs more memory.
    TableFull = 11,
    /// The buffer is too small. It was filled, and the required count was written.
    BufferTooSmall = 12,
    /// The table does not belong to the agents: it was not built since the last agent was added, or an agent was
    /// replaced or removed after `pcr_fleet_build_row`.
    NotBuilt = 13,
    /// The order does not list every agent exactly once.
    BadOrder = 14,
    /// There is no plan: an agent meets another one, however long it waits.
    NoPlan = 15,
    /// A number is above 0, but too small for the format.
    TooSmall = 16,
    /// The table holds the row of another agent only (`pcr_fleet_build_row`).
    OnlyRow = 17,
    /// The agent has no region at this index of the table.
    NoSuchRegion = 18,
    /// The fleet was given no memory for orders.
    NoOrders = 19,
    /// The value is neither PCR_FIRST nor PCR_SECOND.
    NoSuchPass = 20,
    /// Orders are refused; `why` names the agent in the way.
    Refused = 21,
    /// Two agents have more than 32767 pieces with each other, or touch at more lengths of two segments than are counted,
    /// or the fleet has more than 65536 agents, a path more than 65535 segments or an outline more than 16 corners. More
    /// memory does not help.
    TooLarge = 22,
    /// The corners of an outline are not those of a convex polygon, counter-clockwise.
    NotConvex = 23,
    /// The heading of an outline jumps between two legs. A turn in place needs PCR_PIVOT_LEFT or PCR_PIVOT_RIGHT.
    HeadingJumps = 24,
    /// An arc is so tight, or the lever of a turn in place so short, that rounding a length would move the corners too far.
    Lever = 25,
    /// The library was built for discs only.
    NeedsOutlines = 26,
}

impl PcrStatus {
    const ALL: [Self; 27] = [
        Self::Ok,
        Self::Null,
        Self::NonFinite,
        Self::Negative,
        Self::NonPositive,
        Self::OutOfRange,
        Self::SweepOverOneTurn,
        Self::LengthMismatch,
        Self::NoSuchCurve,
        Self::NoSuchAgent,
        Self::NoRoom,
        Self::TableFull,
        Self::BufferTooSmall,
        Self::NotBuilt,
        Self::BadOrder,
        Self::NoPlan,
        Self::TooSmall,
        Self::OnlyRow,
        Self::NoSuchRegion,
        Self::NoOrders,
        Self::NoSuchPass,
        Self::Refused,
        Self::TooLarge,
        Self::NotConvex,
        Self::HeadingJumps,
        Self::Lever,
        Self::NeedsOutlines,
    ];

    /// Returns the name in C, and what it means in a sentence.
    const fn told(self) -> (&'static CStr, &'static CStr) {
        match self {
            Self::Ok => (c"PCR_STATUS_OK", c"the call succeeded"),
            Self::Null => (c"PCR_STATUS_NULL", c"a pointer is null"),
            Self::NonFinite => (c"PCR_STATUS_NON_FINITE", c"a number is NaN or infinite"),
            Self::Negative => (c"PCR_STATUS_NEGATIVE", c"a number is below 0 but must not be"),
            Self::NonPositive => (c"PCR_STATUS_NON_POSITIVE", c"a number is not above 0 but must be"),
            Self::OutOfRange => (c"PCR_STATUS_OUT_OF_RANGE", c"a number, a path or a motion is out of range"),
            Self::SweepOverOneTurn => (c"PCR_STATUS_SWEEP_OVER_ONE_TURN", c"an arc sweeps more than one turn"),
            Self::LengthMismatch => (c"PCR_STATUS_LENGTH_MISMATCH", c"the profile and the path differ in length"),
            Self::NoSuchCurve => (c"PCR_STATUS_NO_SUCH_CURVE", c"the curve of a leg is none of those that exist"),
            Self::NoSuchAgent => (c"PCR_STATUS_NO_SUCH_AGENT", c"there is no agent with this number"),
            Self::NoRoom => {
                (c"PCR_STATUS_NO_ROOM", c"there is no memory for another agent, or for its segments, phases or corners")
            }
            Self::TableFull => (c"PCR_STATUS_TABLE_FULL", c"the table has no room for all entries, pieces or orders"),
            Self::BufferTooSmall => (c"PCR_STATUS_BUFFER_TOO_SMALL", c"the buffer is smaller than the results"),
            Self::NotBuilt => (c"PCR_STATUS_NOT_BUILT", c"the table was not built for these agents"),
            Self::BadOrder => (c"PCR_STATUS_BAD_ORDER", c"the order does not list every agent exactly once"),
            Self::NoPlan => (c"PCR_STATUS_NO_PLAN", c"there is no plan, however long the agents wait"),
            Self::TooSmall => (c"PCR_STATUS_TOO_SMALL", c"a number is too small for the number format"),
            Self::OnlyRow => (c"PCR_STATUS_ONLY_ROW", c"the table holds the row of another agent only"),
            Self::NoSuchRegion => (c"PCR_STATUS_NO_SUCH_REGION", c"the agent has no region at this index of the table"),
            Self::NoOrders => (c"PCR_STATUS_NO_ORDERS", c"the fleet was given no memory for orders"),
            Self::NoSuchPass => (c"PCR_STATUS_NO_SUCH_PASS", c"the value is neither PCR_FIRST nor PCR_SECOND"),
            Self::Refused => (c"PCR_STATUS_REFUSED", c"orders are refused because of another agent"),
            Self::TooLarge => (c"PCR_STATUS_TOO_LARGE", c"two agents or the fleet are too large, whatever the memory"),
            Self::NotConvex => {
                (c"PCR_STATUS_NOT_CONVEX", c"the corners are not those of a convex polygon, counter-clockwise")
            }
            Self::HeadingJumps => (c"PCR_STATUS_HEADING_JUMPS", c"the heading of an outline jumps between two legs"),
            Self::Lever => (c"PCR_STATUS_LEVER", c"an arc is too tight, or a lever too short, for the outline"),
            Self::NeedsOutlines => (c"PCR_STATUS_NEEDS_OUTLINES", c"the library was built for discs only"),
        }
    }
}

fn told(status: c_int) -> Option<(&'static CStr, &'static CStr)> {
    PcrStatus::ALL.iter().find(|known| **known as c_int == status).map(|known| known.told())
}

/// Returns the name of a status, such as "PCR_STATUS_NO_ROOM"; "PCR_STATUS_?" for a number that is none.
#[unsafe(no_mangle)]
pub extern "C" fn pcr_status_name(status: c_int) -> *const c_char {
    told(status).map_or(c"PCR_STATUS_?", |(name, _)| name).as_ptr()
}

/// Returns what a status means, without a full stop; "no status of pcr" for a number that is none.
#[unsafe(no_mangle)]
pub extern "C" fn pcr_status_text(status: c_int) -> *const c_char {
    told(status).map_or(c"no status of pcr", |(_, text)| text).as_ptr()
}

/// The list of an agent in which a fault is.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PcrInputList {
    /// A number of the agent itself.
    #[default]
    Agent = 0,
    /// Its legs.
    Legs = 1,
    /// Its stretches.
    Stretches = 2,
    /// Its corners.
    Corners = 3,
}

/// Why an agent was refused, and which of its numbers is wrong.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PcrInputError {
    /// The status of the call that refused the agent; PCR_STATUS_OK if the last one succeeded.
    pub status: PcrStatus,
    /// The list in which the fault is.
    pub list: PcrInputList,
    /// Index in that list; 0 for a number of the agent itself.
    pub index: usize,
    /// The number that is wrong, such as "radius"; empty if the status says all. Never null.
    pub field: *const c_char,
}

/// Returns the field of the C types that the library calls so; empty if it is none of them.
pub(crate) fn field(invalid: InvalidInput) -> &'static CStr {
    match invalid {
        InvalidInput::NonFinite(what)
        | InvalidInput::Negative(what)
        | InvalidInput::NonPositive(what)
        | InvalidInput::OutOfRange(what)
        | InvalidInput::TooSmall(what) => match what {
            "x" | "x of a corner" => c"x",
            "y" | "y of a corner" => c"y",
            "heading" => c"heading",
            "angle of the body" => c"facing",
            "radius" | "radius of the outline" | "radius with its margin" | "diameter of the arc" | "lever" => {
                c"radius"
            }
            "start time" => c"start",
            "length" => c"length",
            "speed" | "initial speed" | "largest speed" => c"speed",
            "acceleration" | "largest acceleration" => c"acceleration",
            "duration" => c"duration",
            _ => c"",
        },
        _ => c"",
    }
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
            InvalidInput::Full(_) => Self::TooLarge,
            InvalidInput::NotConvex => Self::NotConvex,
            InvalidInput::TurnInPlace => Self::HeadingJumps,
            InvalidInput::Lever => Self::Lever,
            InvalidInput::NeedsOutlines => Self::NeedsOutlines,
            _ => Self::OutOfRange,
        }
    }
}

impl From<CapacityError> for PcrStatus {
    fn from(full: CapacityError) -> Self {
        match full {
            CapacityError::Pair(_) | CapacityError::Agents | CapacityError::Contacts => Self::TooLarge,
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
/// `PcrPathSegment.curve` of a turn in place to the left.
pub const PCR_PIVOT_LEFT: u8 = 3;
/// `PcrPathSegment.curve` of a turn in place to the right.
pub const PCR_PIVOT_RIGHT: u8 = 4;
/// `PcrPathSegment.curve` of a change of gear, which has no length: the direction of travel turns by half a turn, and the
/// heading of the agent stays.
pub const PCR_REVERSE: u8 = 5;

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
    Inside = 0,
    /// The agent may go up to a length of its path, and may stand there.
    At = 1,
    /// The agent may go to the end of its path.
    Free = 2,
}

/// Why there is no plan.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PcrPlanErrorKind {
    /// The two agents overlap at the starts of their paths.
    Starts = 0,
    /// The two agents overlap at the ends of their paths.
    Ends = 1,
    /// The two agents meet however late either of them starts.
    Always = 2,
    /// The first agent cannot go because of the second, with the priorities that were tried.
    Order = 3,
    /// The check of the plan found that the two agents overlap.
    Overlap = 4,
    /// The times of the first agent are out of range.
    Times = 5,
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
    Stuck = 0,
    /// The first agent is where it should have waited for the second.
    Late = 1,
    /// The second agent is in the way of the first, whichever of them goes first.
    Blocked = 2,
    /// According to their motions the two agents meet, or pass so close that it cannot be decided which one is first.
    Meeting = 3,
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
