//! More way for a robot, and what is left of a sequence of such moves.

use std::collections::VecDeque;

/// More way for a robot.
#[derive(Clone, Debug)]
pub(super) struct Stretch {
    pub(super) robot: usize,
    pub(super) atoms: Vec<usize>,
}

/// Moves of vehicles one after the other.
#[derive(Clone, Debug, Default)]
pub(super) struct StretchSequence {
    /// The moves that are left.
    pub(super) moves: VecDeque<Stretch>,
    /// The number of changes of the site that were present when they were found.
    pub(super) present: usize,
    /// Time before which no other sequence is searched \[s\].
    pub(super) next_try: f64,
    /// Time since which missions wait and nobody has a goal on its way \[s\].
    pub(super) idle_since: Option<f64>,
}
