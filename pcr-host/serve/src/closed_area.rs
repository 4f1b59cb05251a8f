//! An area that a person has closed, as lines and the journal have it.

use crate::owned_path::{PathElement, StartPose};
use serde::{Deserialize, Serialize};

/// A closed area: all that is nearer to a path than its radius.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ClosedArea {
    /// Its name, which no robot has.
    #[serde(rename = "closure")]
    pub name: String,
    /// Where the path begins.
    pub start: StartPose,
    /// Its lines and arcs; none for the disc around the start.
    #[serde(default)]
    pub path: Vec<PathElement>,
    /// \[m\]
    pub radius: f64,
}
