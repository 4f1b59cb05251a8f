//! Capacities for a robot among 29 others, to measure its size, its stack, and the time of a hold.

/// Number of robots; the last one is the robot whose hold is computed.
pub const ROBOTS: usize = 30;
/// Index of the robot itself.
pub const OWN: u16 = 29;
/// Number of lines and arcs of all robots.
pub const SEGMENTS: usize = 32;
/// Number of regions of the robot with the others.
pub const REGIONS: usize = 32;
/// Number of pieces of these regions.
pub const PIECES: usize = 40;
