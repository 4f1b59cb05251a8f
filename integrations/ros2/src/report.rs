//! Messages of the package `pcr_msgs`, which is beside this crate: what the node publishes.

use crate::messages::{Header, SpatialPose, Time};
use serde::{Deserialize, Serialize};

/// `pcr_msgs/msg/Pair`: what is known of two robots.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[allow(missing_docs)]
pub struct PairReport {
    pub robot_a: String,
    pub robot_b: String,
    /// [`PairReport::UNKNOWN`], [`PairReport::CLEAR`] or [`PairReport::CONFLICT`].
    pub state: u8,
    pub reason: String,
}

#[allow(missing_docs)]
impl PairReport {
    pub const UNKNOWN: u8 = 0;
    pub const CLEAR: u8 = 1;
    pub const CONFLICT: u8 = 2;
}

/// `pcr_msgs/msg/Conflict`: a time in which two robots touch.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[allow(missing_docs)]
pub struct ConflictReport {
    pub robot_a: String,
    pub robot_b: String,
    pub begin: Time,
    pub end: Time,
    /// They stay in contact after the end.
    pub lasting: bool,
    /// Travelled lengths of the paths \[m\].
    pub begin_length_a: f64,
    pub end_length_a: f64,
    pub begin_length_b: f64,
    pub end_length_b: f64,
    /// When they overlap most.
    pub deepest: Time,
    pub pose_a: SpatialPose,
    pub pose_b: SpatialPose,
    /// Largest overlap \[m\].
    pub depth: f64,
    /// It may be no contact.
    pub touching: bool,
}

/// `pcr_msgs/msg/Refusal`: a message, or a robot in one, that was not used.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[allow(missing_docs)]
pub struct RefusalReport {
    pub topic: String,
    pub robot: String,
    pub reason: String,
}

/// `pcr_msgs/msg/Conflicts`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[allow(missing_docs)]
pub struct ConflictsReport {
    pub header: Header,
    pub pairs: Vec<PairReport>,
    pub conflicts: Vec<ConflictReport>,
    pub refusals: Vec<RefusalReport>,
}

/// `pcr_msgs/msg/Authority`: how far a robot may drive.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[allow(missing_docs)]
pub struct AuthorityReport {
    pub robot: String,
    /// [`AuthorityReport::UNKNOWN`], [`AuthorityReport::FREE`], [`AuthorityReport::LIMITED`] or [`AuthorityReport::NONE`].
    pub state: u8,
    /// Travelled length of the path \[m\].
    pub length: f64,
    pub time: Time,
    pub pose: SpatialPose,
    pub waits_for: String,
    pub reason: String,
}

#[allow(missing_docs)]
impl AuthorityReport {
    pub const UNKNOWN: u8 = 0;
    pub const FREE: u8 = 1;
    pub const LIMITED: u8 = 2;
    pub const NONE: u8 = 3;
}

/// `pcr_msgs/msg/Authorities`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[allow(missing_docs)]
pub struct AuthoritiesReport {
    pub header: Header,
    pub robots: Vec<AuthorityReport>,
    pub stuck: String,
}
