//! An area that a person has closed, or in which robots have to be slower, as lines and the journal have it.

use crate::owned_path::{OwnedPath, PathElement, StartPose};
use crate::page_layout::PageLayout;
use pcr_core::Interval;
use pcr_formats::import::ElementId;
use serde::{Deserialize, Serialize};

/// A closed area: all that is nearer to one of its paths than its radius.
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
    /// Further paths.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub more: Vec<AreaPath>,
    /// \[m\]
    pub radius: f64,
    /// What it is in the layout, if it was closed by its id.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub of: Option<LayoutElement>,
    /// Largest speed in it \[m/s\]; `None`: nobody may enter.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub speed: Option<f64>,
}

/// A path of an area.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AreaPath {
    /// Where it begins.
    pub start: StartPose,
    /// Its lines and arcs; none for the disc around the start.
    pub path: Vec<PathElement>,
}

/// An element of the layout, by its id there.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LayoutElement {
    /// The lanes of an edge.
    Edge(ElementId),
    /// A node.
    Node(ElementId),
    /// The lanes and nodes of a zone.
    Zone(ElementId),
}

/// A part of a robot's path on which its speed is limited.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SpeedLimit {
    /// Name of the closure.
    pub closure: String,
    /// Lengths of the path between which it holds \[m\].
    pub length: [f64; 2],
    /// Largest speed there \[m/s\].
    pub speed: f64,
}

/// The lengths of a path on which a closed area is; `None`: unknown, so it counts as where the robot is.
pub(crate) type AreaLengths = Option<Vec<Interval<f64>>>;

/// The closed areas on a robot's path.
#[derive(Clone, Debug)]
pub(crate) struct AreasOnPath {
    /// Number of the path, and revision of the areas.
    pub(crate) of: (u64, u64),
    /// Names and lengths of the areas that are on the path.
    pub(crate) shut: Vec<(String, AreaLengths)>,
    /// Where the first one ahead begins, when it was last looked \[m\].
    pub(crate) limit: Option<f64>,
}

impl AreasOnPath {
    /// The name of an area, by its index here.
    pub(crate) fn name(&self, index: usize) -> Option<&str> {
        self.shut.get(index).map(|(name, _)| name.as_str())
    }
}

/// A request to close an area: a path, or what has an id in the layout.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ClosureRequest {
    closure: String,
    #[serde(default)]
    start: Option<StartPose>,
    #[serde(default)]
    path: Option<Vec<PathElement>>,
    #[serde(default)]
    edge: Option<ElementId>,
    #[serde(default)]
    node: Option<ElementId>,
    #[serde(default)]
    zone: Option<ElementId>,
    radius: f64,
    #[serde(default)]
    speed: Option<f64>,
}

impl ClosureRequest {
    /// The area that is meant, in a layout.
    ///
    /// # Errors
    /// What is wrong, in words: neither a place nor an id or several of them, or an id that the layout does not have.
    pub fn area(self, layout: &PageLayout) -> Result<ClosedArea, String> {
        let Self { closure: name, start, path, edge, node, zone, radius, speed } = self;
        let ids = [edge.map(LayoutElement::Edge), node.map(LayoutElement::Node), zone.map(LayoutElement::Zone)];
        let mut ids = ids.into_iter().flatten();
        Ok(match (start, ids.next(), ids.next()) {
            (Some(start), None, _) => {
                let path = path.unwrap_or_default();
                ClosedArea { name, start, path, more: Vec::new(), radius, of: None, speed }
            }
            (None, Some(of), None) if path.is_none() => {
                let mut paths = layout.paths(&of).into_iter();
                let Some(AreaPath { start, path }) = paths.next() else {
                    let (kind, id) = of.named();
                    return Err(format!("{kind}: the layout that was sent has no {kind} {id}"));
                };
                ClosedArea { name, start, path, more: paths.collect(), radius, of: Some(of), speed }
            }
            _ => return Err("a closure is of one place: start and path, or an edge, a node or a zone".into()),
        })
    }
}

impl LayoutElement {
    /// Its kind and its id.
    fn named(&self) -> (&'static str, &ElementId) {
        match self {
            Self::Edge(id) => ("edge", id),
            Self::Node(id) => ("node", id),
            Self::Zone(id) => ("zone", id),
        }
    }
}

impl PageLayout {
    /// The paths of an element; none if there is none of its id. Ids may be numbers or texts of the same digits.
    fn paths(&self, element: &LayoutElement) -> Vec<AreaPath> {
        let same = |a: &ElementId, b: &ElementId| a.to_string() == b.to_string();
        let of_lane = |edge: Option<&ElementId>, zones: &[ElementId]| match element {
            LayoutElement::Edge(id) => edge.is_some_and(|edge| same(edge, id)),
            LayoutElement::Node(_) => false,
            LayoutElement::Zone(id) => zones.iter().any(|zone| same(zone, id)),
        };
        let of_node = |node: &ElementId, zones: &[ElementId]| match element {
            LayoutElement::Edge(_) => false,
            LayoutElement::Node(id) => same(node, id),
            LayoutElement::Zone(id) => zones.iter().any(|zone| same(zone, id)),
        };
        let lanes = self.lanes.iter().filter(|lane| of_lane(lane.edge.as_ref(), &lane.zones));
        let lanes = lanes.map(|lane| AreaPath { start: lane.course.start(), path: lane.course.shapes().to_vec() });
        let nodes = self.nodes.iter().filter(|node| of_node(&node.node, &node.zones));
        let nodes =
            nodes.map(|node| AreaPath { start: StartPose { x: node.x, y: node.y, heading: 0.0 }, path: Vec::new() });
        lanes.chain(nodes).collect()
    }
}

impl ClosedArea {
    /// All its paths.
    ///
    /// # Errors
    /// [`InvalidInput`](pcr_core::InvalidInput) for a path that is out of range.
    pub(crate) fn courses(&self) -> Result<Vec<OwnedPath>, pcr_core::InvalidInput> {
        let first = AreaPath { start: self.start, path: self.path.clone() };
        let all = std::iter::once(first).chain(self.more.iter().cloned());
        all.map(|AreaPath { start, path }| OwnedPath::new(start, path)).collect()
    }
}
