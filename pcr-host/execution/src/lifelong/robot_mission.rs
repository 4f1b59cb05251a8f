//! What a robot has to do.

use std::time::Duration;

/// The mission of a robot.
#[derive(Clone, Copy, Debug)]
pub(super) struct RobotMission {
    pub(super) goal: usize,
    pub(super) assigned_at: f64,
    /// The mission of the least rank decides first: by age, or by priority and age.
    pub(super) rank: f64,
    /// Time that a robot alone would take \[s\].
    pub(super) unimpeded_time: f64,
    /// Whether it has a way.
    pub(super) admitted: bool,
    /// Number of newer missions that were admitted while it waited.
    pub(super) passed: usize,
    pub(super) next_try: f64,
    /// Computing time of the quickest way before the first decision.
    pub(super) prepared: Duration,
}
