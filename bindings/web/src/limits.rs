//! What there is room for.

/// Largest number of agents.
pub const AGENTS: usize = 24;
/// Largest number of legs of a path.
pub const LEGS: usize = 32;
/// Numbers of an agent: x, y, heading, radius, start, largest speed, largest acceleration, number of legs; then two for
/// each leg.
pub const STRIDE: usize = 8 + 2 * LEGS;
