//! The C types of a number format. Units are metres, seconds and radians, or those that the header gives; left turns
//! and counter-clockwise angles are positive.

use super::number::{Heading, MOTION, PIECE, Real, SEGMENT, ZERO};
use crate::status::PcrAuthorityKind;

/// A line, an arc or a turn in place of a path. It begins where the one before it ends, in the same direction of travel.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PcrPathSegment {
    /// PCR_LINE, PCR_LEFT, PCR_RIGHT, PCR_PIVOT_LEFT, PCR_PIVOT_RIGHT or PCR_REVERSE.
    pub curve: u8,
    /// Length (m); of an arc at most one turn. For a turn in place, its angle times the radius. A leg of length 0 adds
    /// nothing. Ignored for PCR_REVERSE.
    pub length: Real,
    /// Radius of an arc (m), above 0. For a turn in place, the lever: the distance from the reference point at which a point
    /// of the agent moves at the speed of the profile. Ignored for a line and for PCR_REVERSE.
    pub radius: Real,
}

/// A corner of an outline, in the frame of the agent: the reference point, which follows the path, is the origin.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PcrCorner {
    /// Distance ahead of the reference point (m).
    pub x: Real,
    /// Distance to the left of the reference point (m).
    pub y: Real,
}

/// A part of a profile with constant acceleration.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PcrProfilePhase {
    /// Duration (s).
    pub duration: Real,
    /// Acceleration (m/s²).
    pub acceleration: Real,
}

/// A disc or a convex outline, its path and its motion along the path.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PcrAgent {
    /// x-coordinate of the start of the path (m).
    pub x: Real,
    /// y-coordinate of the start of the path (m).
    pub y: Real,
    /// Direction of travel at the start (rad, or in the unit of headings that is given above).
    pub heading: Heading,
    /// Radius of the disc (m), above 0. With corners, the radius by which the polygon is rounded, 0 or more.
    pub radius: Real,
    /// Time at which the agent sets off (s). It stands before that, and after its arrival.
    pub start: Real,
    /// Legs of the path; none for an agent that stands.
    pub legs: *const PcrPathSegment,
    /// Number of legs.
    pub leg_count: usize,
    /// Largest speed of a motion from rest to rest (m/s). With a profile, the speed at its start.
    pub speed: Real,
    /// Largest acceleration of a motion from rest to rest (m/s²); ignored with a profile.
    pub acceleration: Real,
    /// Profile, which must have the length of the path; none for the fastest motion from rest to rest.
    pub stretches: *const PcrProfilePhase,
    /// Number of stretches.
    pub stretch_count: usize,
    /// Corners of a convex polygon, counter-clockwise, at most 16; none for a disc about the reference point. Two make a
    /// capsule.
    pub corners: *const PcrCorner,
    /// Number of corners.
    pub corner_count: usize,
    /// Angle from the direction of travel to the heading of the outline at the start, counter-clockwise (rad, or in the unit
    /// of headings): 0 for an agent that looks ahead, half a turn in reverse gear. Ignored for a disc.
    pub facing: Heading,
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
    /// The agent that has to keep out of the region.
    pub ego: u16,
    /// The agent that is in the way.
    pub other: u16,
    /// Range of times (s).
    pub time: PcrInterval,
    /// Range of lengths along the path of the ego (m).
    pub length: PcrInterval,
    /// Whether the region begins while the other agent stands at its start; the lengths that are covered then are so at
    /// all earlier times.
    pub open_start: bool,
    /// Whether the region ends while the other agent stands at its end; the lengths that are covered then are so at all
    /// later times.
    pub open_end: bool,
}

/// A contact of two agents that move by their motions.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PcrConflict {
    /// Interval of time (s).
    pub time: PcrInterval,
    /// Lengths along the path of the ego during the contact (m).
    pub length: PcrInterval,
    /// Lengths along the path of the other agent during the contact (m).
    pub other_length: PcrInterval,
    /// Largest overlap of the discs (m).
    pub depth: Real,
    /// Whether it is so slight that it may be no contact; it is then no deeper than the tolerance.
    pub touching: bool,
}

/// A conflict with another agent.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PcrAgentConflict {
    /// The other agent.
    pub other: usize,
    /// The conflict.
    pub conflict: PcrConflict,
}

/// Memory for a segment of a path: one for each leg, or one for an agent that stands.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PcrSegmentStorage {
    opaque: [Real; SEGMENT],
}

/// Memory for a corner of an outline.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PcrCornerStorage {
    opaque: [Real; 5],
}

/// Memory for a phase of a profile: three for each agent, or one for each stretch.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PcrPhaseStorage {
    opaque: [Real; 7],
}

/// Memory for the motion of an agent.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PcrMotionStorage {
    pointers: [usize; 6],
    opaque: [Real; MOTION],
}

/// Memory for a region in the table; each one serves both agents of its pair.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PcrRegionStorage {
    opaque: [u32; 2],
}

/// Memory for a piece of a region: the part that belongs to one segment of each path.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PcrPieceStorage {
    opaque: [Real; PIECE],
}

/// What is known about the progress of an agent.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PcrProgress {
    /// Place of the agent (m). The lower end may be out of date; it decides which regions the agent has left.
    pub at: PcrInterval,
    /// The furthest length at which the agent can come to rest (m), at least the upper end of `at`. If it has promised
    /// not to go beyond a length, it is that length.
    pub stop: Real,
}

/// How far an agent may go; it may stand there.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PcrMovementAuthority {
    /// Kind of the limit.
    pub kind: PcrAuthorityKind,
    /// The limit (m): for PCR_AUTHORITY_KIND_AT a length along the path, for PCR_AUTHORITY_KIND_FREE the end of the path.
    pub length: Real,
}

/// A region of an agent, and the order in which the agent passes it.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PcrRegionPrecedence {
    /// Index of the region in the table, for `pcr_fleet_decide_at`.
    pub place: usize,
    /// The other agent.
    pub other: u16,
    /// PCR_UNDECIDED, PCR_FIRST, PCR_SECOND or PCR_OVER, for the agent of the query.
    pub pass: u8,
    /// Range of lengths along the path of the agent (m).
    pub length: PcrInterval,
    /// Range of lengths along the path of the other agent (m).
    pub other_length: PcrInterval,
}

/// Parameters of a check of orders.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PcrCheckTolerances {
    /// When an agent stands, the known lower end of its place may be behind it by up to this (m).
    pub width: Real,
    /// A gain below this (m) does not count as progress; above 0.
    pub gain: Real,
}

/// How an agent brakes.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PcrBrakingModel {
    /// Deceleration (m/s²), above 0.
    pub deceleration: Real,
    /// Reaction time (s) during which the agent may continue at its speed: the time between two control steps plus the
    /// delay until a command takes effect.
    pub reaction: Real,
}

/// Memory for the order of a region.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PcrPrecedenceStorage {
    opaque: [Real; 5],
}

/// Memory for the progress of an agent, and for a check.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PcrCheckStorage {
    opaque: [Real; 7],
}

/// Memory for a fleet. It belongs to the fleet from `pcr_fleet_init` on.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PcrMemory {
    /// Memory for the paths.
    pub segments: *mut PcrSegmentStorage,
    /// Number of segments.
    pub segment_count: usize,
    /// Memory for the profiles.
    pub phases: *mut PcrPhaseStorage,
    /// Number of phases.
    pub phase_count: usize,
    /// Memory for the agents.
    pub motions: *mut PcrMotionStorage,
    /// Number of motions, which limits the number of agents.
    pub motion_count: usize,
    /// Memory for the regions.
    pub entries: *mut PcrRegionStorage,
    /// Number of entries.
    pub entry_count: usize,
    /// Memory for the pieces of the regions.
    pub pieces: *mut PcrPieceStorage,
    /// Number of pieces.
    pub piece_count: usize,
    /// Memory for passing orders: one for each region, and as many more as an agent has that is admitted or replaced.
    /// Null if no orders are used.
    pub orders: *mut PcrPrecedenceStorage,
    /// Number of orders; 0 if no orders are used.
    pub order_count: usize,
    /// Memory for the progress of the agents, as many as `motions`; null if no orders are used.
    pub robots: *mut PcrCheckStorage,
    /// Memory for the corners of outlines; null if all agents are discs.
    pub corners: *mut PcrCornerStorage,
    /// Number of corners.
    pub corner_count: usize,
}

/// A fleet and the table of its regions.
#[repr(C)]
#[derive(Debug)]
pub struct PcrFleet {
    opaque: [usize; 40],
}

impl PcrFleet {
    /// Memory for a fleet, not initialized.
    pub const EMPTY: Self = Self { opaque: [0; 40] };
}

impl PcrSegmentStorage {
    /// An unused slot.
    pub const EMPTY: Self = Self { opaque: [ZERO; SEGMENT] };
}

impl PcrCornerStorage {
    /// An unused slot.
    pub const EMPTY: Self = Self { opaque: [ZERO; 5] };
}

impl PcrPhaseStorage {
    /// An unused slot.
    pub const EMPTY: Self = Self { opaque: [ZERO; 7] };
}

impl PcrMotionStorage {
    /// An unused slot.
    pub const EMPTY: Self = Self { pointers: [0; 6], opaque: [ZERO; MOTION] };
}

impl PcrRegionStorage {
    /// An unused slot.
    pub const EMPTY: Self = Self { opaque: [0; 2] };
}

impl PcrPieceStorage {
    /// An unused slot.
    pub const EMPTY: Self = Self { opaque: [ZERO; PIECE] };
}

impl PcrPrecedenceStorage {
    /// An unused slot.
    pub const EMPTY: Self = Self { opaque: [ZERO; 5] };
}

impl PcrCheckStorage {
    /// An unused slot.
    pub const EMPTY: Self = Self { opaque: [ZERO; 7] };
}
