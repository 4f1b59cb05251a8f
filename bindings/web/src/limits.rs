//! What there is room for.

/// Largest number of agents.
pub const AGENTS: usize = 24;
/// Largest number of legs of a path.
pub const LEGS: usize = 32;
/// Largest number of corners of an outline.
pub const CORNERS: usize = 16;
/// Numbers of an agent: x, y, heading, radius, start, largest speed, largest acceleration, number of legs; then room for two
/// for each leg; then the number of corners, and room for two for each corner.
pub const STRIDE: usize = 9 + 2 * LEGS + 2 * CORNERS;
