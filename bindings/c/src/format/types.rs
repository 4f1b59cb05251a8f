//! The C types of a number format. SI units: metres, seconds, radians, or what the header says of its numbers; left turns and
//! counter-clockwise angles are positive.

use super::number::{Heading, MOTION, PIECE, Real, SEGMENT, ZERO};
use crate::status::PcrHoldKind;

/// A line or an arc of a path; it begins in the pose in which the one before it ends.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PcrLeg {
    /// PCR_LINE, PCR_LEFT or PCR_RIGHT.
    pub curve: u8,
    /// Length (m), of an arc at most one turn; 0 adds nothing.
    pub length: Real,
    /// Radius of an arc (m), above 0; of a line it is not looked at.
    pub radius: Real,
}

/// Motion at constant acceleration, part of a profile.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PcrStretch {
    /// In s.
    pub duration: Real,
    /// In m/s².
    pub acceleration: Real,
}

/// A disc, its path and its motion along it.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PcrAgent {
    /// Position at the start of the path (m).
    pub x: Real,
    /// In m.
    pub y: Real,
    /// Direction of travel there (rad).
    pub heading: Heading,
    /// Of the disc (m), above 0.
    pub radius: Real,
    /// When it sets off (s); it stands before, and after its arrival.
    pub start: Real,
    /// The path; none for an agent that stands.
    pub legs: *const PcrLeg,
    /// Number of legs.
    pub leg_count: usize,
    /// Largest speed of a motion from rest to rest (m/s); with a profile, the speed at its start.
    pub speed: Real,
    /// Largest acceleration of a motion from rest to rest (m/s²); with a profile it is not looked at.
    pub acceleration: Real,
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
    pub lo: Real,
    /// Upper end.
    pub hi: Real,
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
    pub depth: Real,
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

/// Room for a segment of a path: one a leg, or one for an agent that stands.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PcrSegment {
    opaque: [Real; SEGMENT],
}

/// Room for a phase of a profile: three an agent, or one a stretch.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PcrPhase {
    opaque: [Real; 7],
}

/// Room for the motion of an agent.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PcrMotion {
    pointers: [usize; 4],
    opaque: [Real; MOTION],
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
    opaque: [Real; PIECE],
}

/// What is known of where an agent is on its path.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PcrProgress {
    /// Where it is (m). The lower end may be old: it counts for what the agent has passed.
    pub at: PcrInterval,
    /// Where it can be at rest at the latest (m), the upper end of `at` or more. What it has promised not to go beyond
    /// counts, too.
    pub stop: Real,
}

/// How far an agent may go, and may stand there.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PcrHold {
    /// Whether there is a limit.
    pub kind: PcrHoldKind,
    /// The limit (m): of PCR_HOLD_KIND_AT the length along its path, of PCR_HOLD_KIND_FREE the end of it.
    pub length: Real,
}

/// A region of an agent, and who passes it first.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PcrPassing {
    /// The place of the region in the table, for `pcr_fleet_decide_at`.
    pub place: usize,
    /// The other agent.
    pub other: u16,
    /// PCR_UNDECIDED, PCR_FIRST, PCR_SECOND or PCR_OVER, of the agent that was asked for.
    pub pass: u8,
    /// Length range along the path of the agent (m).
    pub length: PcrInterval,
    /// Length range along the path of the other (m).
    pub other_length: PcrInterval,
}

/// What a check of orders takes into account.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PcrTolerances {
    /// So far the lower end of an agent's place may be behind it when it stands (m).
    pub width: Real,
    /// Less way than this (m) is no progress; above 0.
    pub gain: Real,
}

/// How an agent brakes.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PcrBrakes {
    /// Deceleration (m/s²), above 0.
    pub deceleration: Real,
    /// Reaction time (s) during which it may go on at its speed: what passes between two controls, and until one takes effect.
    pub reaction: Real,
}

/// Room for the order of a region.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PcrOrder {
    opaque: [Real; 5],
}

/// Room for what is known of an agent, and for a check.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PcrRobot {
    opaque: [Real; 7],
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
    /// For passing orders: as many as regions; as many more as an agent has that is admitted or replaced. Null where no orders
    /// are used.
    pub orders: *mut PcrOrder,
    /// Number of them; 0 where no orders are used.
    pub order_count: usize,
    /// For what is known of the agents, as many as `motions`; null where no orders are used.
    pub robots: *mut PcrRobot,
}

/// A fleet and the table of its regions.
#[repr(C)]
#[derive(Debug)]
pub struct PcrFleet {
    opaque: [usize; 32],
}

impl PcrFleet {
    /// A place for a fleet, not yet one.
    pub const EMPTY: Self = Self { opaque: [0; 32] };
}

impl PcrSegment {
    /// A free slot.
    pub const EMPTY: Self = Self { opaque: [ZERO; SEGMENT] };
}

impl PcrPhase {
    /// A free slot.
    pub const EMPTY: Self = Self { opaque: [ZERO; 7] };
}

impl PcrMotion {
    /// A free slot.
    pub const EMPTY: Self = Self { pointers: [0; 4], opaque: [ZERO; MOTION] };
}

impl PcrEntry {
    /// A free slot.
    pub const EMPTY: Self = Self { opaque: [0; 2] };
}

impl PcrPiece {
    /// A free slot.
    pub const EMPTY: Self = Self { opaque: [ZERO; PIECE] };
}

impl PcrOrder {
    /// A free slot.
    pub const EMPTY: Self = Self { opaque: [ZERO; 5] };
}

impl PcrRobot {
    /// A free slot.
    pub const EMPTY: Self = Self { opaque: [ZERO; 7] };
}
