//! The C types. SI units: metres, seconds, radians; left turns and counter-clockwise angles are positive.

use pcr_core::{Full, Invalid, Mismatch, Unsolved};

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
    /// A number is beyond a million in magnitude, or a path or a motion gets there.
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
    /// The table has no room for the entries or the pieces of all regions.
    TableFull,
    /// The buffer is too small; the count that is needed is told.
    BufferTooSmall,
    /// The table is not that of the agents: `pcr_fleet_build` was not called since the last was added.
    NotBuilt,
    /// The order does not list each agent once.
    BadOrder,
    /// There is no such plan: whoever waits, for however long, meets another one.
    NoPlan,
}

impl From<Invalid> for PcrStatus {
    fn from(invalid: Invalid) -> Self {
        match invalid {
            Invalid::NonFinite(_) => Self::NonFinite,
            Invalid::Negative(_) => Self::Negative,
            Invalid::NonPositive(_) => Self::NonPositive,
            Invalid::SweepOverOneTurn => Self::SweepOverOneTurn,
            Invalid::LengthMismatch => Self::LengthMismatch,
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
            _ => Self::NotBuilt,
        }
    }
}

/// `PcrLeg.curve` of a straight line.
pub const PCR_LINE: u8 = 0;
/// `PcrLeg.curve` of an arc that turns left, counter-clockwise.
pub const PCR_LEFT: u8 = 1;
/// `PcrLeg.curve` of an arc that turns right, clockwise.
pub const PCR_RIGHT: u8 = 2;

/// A line or an arc of a path; it begins in the pose in which the one before it ends.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PcrLeg {
    /// PCR_LINE, PCR_LEFT or PCR_RIGHT.
    pub curve: u8,
    /// Length (m), of an arc at most one turn; 0 adds nothing.
    pub length: f32,
    /// Radius of an arc (m), above 0; of a line it is not looked at.
    pub radius: f32,
}

/// Motion at constant acceleration, part of a profile.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PcrStretch {
    /// In s.
    pub duration: f32,
    /// In m/s².
    pub acceleration: f32,
}

/// A disc, its path and its motion along it.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PcrAgent {
    /// Position at the start of the path (m).
    pub x: f32,
    /// In m.
    pub y: f32,
    /// Direction of travel there (rad).
    pub heading: f32,
    /// Of the disc (m), above 0.
    pub radius: f32,
    /// When it sets off (s); it stands before, and after its arrival.
    pub start: f32,
    /// The path; none for an agent that stands.
    pub legs: *const PcrLeg,
    /// Number of legs.
    pub leg_count: usize,
    /// Largest speed of a motion from rest to rest (m/s); with a profile, the speed at its start.
    pub speed: f32,
    /// Largest acceleration of a motion from rest to rest (m/s²); with a profile it is not looked at.
    pub acceleration: f32,
    /// Profile that travels the length of the path; none for a motion from rest to rest in the least time.
    pub stretches: *const PcrStretch,
    /// Number of stretches.
    pub stretch_count: usize,
}

/// A closed interval of times or of lengths.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PcrInterval {
    /// Lower end.
    pub lo: f32,
    /// Upper end.
    pub hi: f32,
}

/// A collision region: a connected set of times and lengths that an agent has to keep out of.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PcrRegion {
    /// The agent that keeps out.
    pub ego: u16,
    /// The agent that is in the way.
    pub other: u16,
    /// Time range (s).
    pub time: PcrInterval,
    /// Length range along the path of the ego (m).
    pub length: PcrInterval,
    /// Whether it reaches back to before the other sets off, as a strip.
    pub open_start: bool,
    /// Whether it goes on after the other's arrival, as a strip.
    pub open_end: bool,
}

/// A contact of two agents on their given motions.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PcrConflict {
    /// From when to when (s).
    pub time: PcrInterval,
    /// Lengths along the path of the ego meanwhile (m).
    pub length: PcrInterval,
    /// Lengths along the path of the other meanwhile (m).
    pub other_length: PcrInterval,
    /// Largest overlap of the discs (m).
    pub depth: f32,
    /// Whether they do no more than touch.
    pub touching: bool,
}

/// A conflict, and with whom.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PcrMet {
    /// The other agent.
    pub other: usize,
    /// The conflict.
    pub conflict: PcrConflict,
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

/// Room for a segment of a path: one a leg, or one for an agent that stands.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PcrSegment {
    opaque: [f32; 30],
}

/// Room for a phase of a profile: three an agent, or one a stretch.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PcrPhase {
    opaque: [f32; 7],
}

/// Room for the motion of an agent.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PcrMotion {
    pointers: [usize; 4],
    opaque: [f32; 14],
}

/// Room for a region in the table; each serves both agents of its pair.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PcrEntry {
    opaque: [u32; 2],
}

/// Room for a piece of a region: what one segment of either path has to do with it.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PcrPiece {
    opaque: [u32; 7],
}

/// Memory for a fleet. It belongs to the fleet from `pcr_fleet_init` on.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PcrMemory {
    /// For the paths.
    pub segments: *mut PcrSegment,
    /// Number of them.
    pub segment_count: usize,
    /// For the profiles.
    pub phases: *mut PcrPhase,
    /// Number of them.
    pub phase_count: usize,
    /// For the agents.
    pub motions: *mut PcrMotion,
    /// Number of them: the most agents.
    pub motion_count: usize,
    /// For the regions.
    pub entries: *mut PcrEntry,
    /// Number of them.
    pub entry_count: usize,
    /// For the pieces of the regions.
    pub pieces: *mut PcrPiece,
    /// Number of them.
    pub piece_count: usize,
}

/// A fleet and the table of its regions.
#[repr(C)]
#[derive(Debug)]
pub struct PcrFleet {
    opaque: [usize; 24],
}

impl PcrFleet {
    /// A place for a fleet, not yet one.
    pub const EMPTY: Self = Self { opaque: [0; 24] };
}

impl PcrSegment {
    /// A free slot.
    pub const EMPTY: Self = Self { opaque: [0.0; 30] };
}

impl PcrPhase {
    /// A free slot.
    pub const EMPTY: Self = Self { opaque: [0.0; 7] };
}

impl PcrMotion {
    /// A free slot.
    pub const EMPTY: Self = Self { pointers: [0; 4], opaque: [0.0; 14] };
}

impl PcrEntry {
    /// A free slot.
    pub const EMPTY: Self = Self { opaque: [0; 2] };
}

impl PcrPiece {
    /// A free slot.
    pub const EMPTY: Self = Self { opaque: [0; 7] };
}
