//! The layout as a client has sent it: what the page draws, and what it is called.

use crate::owned_path::{OwnedPath, PathElement, StartPose};
use pcr_core::InvalidInput;
use pcr_formats::import::ElementId;
use serde::{Deserialize, Serialize};

/// The lanes that the page draws, and what they are called. They influence no decision but where areas are that are closed by their ids.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PageLayout {
    /// Name of the layout.
    pub name: String,
    /// Lanes.
    pub lanes: Vec<PageLane>,
    /// Nodes, which are not drawn.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub nodes: Vec<PageNode>,
}

/// A lane, in one direction or in both.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(try_from = "LaneRecord", into = "LaneRecord")]
pub struct PageLane {
    /// Its course.
    pub course: OwnedPath,
    /// Id of its edge.
    pub edge: Option<ElementId>,
    /// Zones in which it is.
    pub zones: Vec<ElementId>,
}

/// A node of the layout.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PageNode {
    /// Its id.
    pub node: ElementId,
    /// \[m\]
    pub x: f64,
    /// \[m\]
    pub y: f64,
    /// Zones in which it is.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub zones: Vec<ElementId>,
}

/// A lane in files and messages.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct LaneRecord {
    start: StartPose,
    path: Vec<PathElement>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    edge: Option<ElementId>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    zones: Vec<ElementId>,
}

impl TryFrom<LaneRecord> for PageLane {
    type Error = InvalidInput;

    fn try_from(LaneRecord { start, path, edge, zones }: LaneRecord) -> Result<Self, InvalidInput> {
        Ok(Self { course: OwnedPath::new(start, path)?, edge, zones })
    }
}

impl From<PageLane> for LaneRecord {
    fn from(PageLane { course, edge, zones }: PageLane) -> Self {
        Self { start: course.start(), path: course.shapes().to_vec(), edge, zones }
    }
}
