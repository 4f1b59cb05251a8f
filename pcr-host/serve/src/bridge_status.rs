//! What the bridge between a manager and vehicles says of itself, for the metrics.

use serde::Serialize;

/// Numbers of messages since the start.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct BridgeCounters {
    /// Number of messages read.
    pub read: u64,
    /// Number of messages refused.
    pub refused: u64,
    /// Number of messages of vehicles that are not in the fleet, or on other topics.
    pub foreign: u64,
    /// Number of messages sent.
    pub sent: u64,
}

/// What a bridge and its connection say of themselves.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct BridgeStatus {
    /// Whether it is connected to the broker.
    pub connected: bool,
    /// Whether it is the active one at the broker.
    pub active: bool,
    /// Numbers of messages since the start.
    pub counts: BridgeCounters,
}
