//! An agent as it is stored in constants and sent in frames.

use heapless::Vec;
use pcr_core::{Curve, Limits, Pose, Scalar};
use serde::{Deserialize, Serialize};

/// Largest number of lines and arcs in the path of one agent.
pub const MAX_STEPS: usize = 8;

/// A line or an arc of a path.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Step<S> {
    /// Shape.
    pub curve: Curve<S>,
    /// Length \[m\].
    pub length: S,
}

/// An agent that drives along its path from rest to rest. `P` holds the steps: a list in a message, a slice in a
/// constant.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(bound(
    serialize = "S: Serialize, S::Angle: Serialize, P: Serialize",
    deserialize = "S: Deserialize<'de>, S::Angle: Deserialize<'de>, P: Deserialize<'de>"
))]
pub struct Agent<S: Scalar, P = Vec<Step<S>, MAX_STEPS>> {
    /// Radius of the disc \[m\].
    pub radius: S,
    /// Time at which the agent sets off \[s\].
    pub start_time: S,
    /// Largest speed and acceleration.
    pub limits: Limits<S>,
    /// Pose in which the agent sets off.
    pub start: Pose<S>,
    /// Its path.
    pub path: P,
}
