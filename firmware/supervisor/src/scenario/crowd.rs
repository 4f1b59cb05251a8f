//! Capacities of a robot among 29 others: for its size, its stack, and what a hold takes.

/// Robots, the last of which is the one whose agent this is.
pub const ROBOTS: usize = 30;
/// The robot itself.
pub const OWN: u16 = 29;
/// Lines and arcs of all.
pub const SEGMENTS: usize = 32;
/// Regions of the robot with the others.
pub const REGIONS: usize = 32;
/// Pieces of these.
pub const PIECES: usize = 40;
