//! The nodes and edges of a layout: the answer of `pcr nodes`. The types match the JSON output, field by field in this
//! order.

use pcr_formats::import::{ElementId, Layout, LayoutEdge, LayoutNode, RouteStep};
use serde::Serialize;

/// The nodes and edges of a layout.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LayoutReport<'a> {
    /// Name of the layout.
    pub layout: &'a str,
    /// Floors or maps.
    pub levels: &'a [String],
    /// Types of vehicles in the file (`--vehicle`).
    pub vehicle_types: &'a [String],
    /// Vehicles in the file.
    pub vehicles: &'a [String],
    /// Nodes at which routes may begin and end.
    pub nodes: Vec<NodeEntry<'a>>,
    /// The edges between them.
    pub edges: Vec<EdgeEntry<'a>>,
    /// Warnings about input that was changed or left out when it was read.
    pub warnings: &'a [String],
}

/// A node.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct NodeEntry<'a> {
    /// Id in the file, also for `--route`.
    pub id: &'a ElementId,
    /// Other names for `--route`: a name, or other ids of the same node.
    pub names: Vec<&'a str>,
    /// Its floor or map.
    pub level: &'a str,
    /// \[m\]
    pub at: [f64; 2],
}

/// An edge.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct EdgeEntry<'a> {
    /// Id in the file.
    pub id: &'a ElementId,
    /// Id of the node where it begins.
    pub from: &'a ElementId,
    /// Id of the node where it ends.
    pub to: &'a ElementId,
    /// \[m\]
    pub length: f64,
    /// Whether it may be travelled backward as well.
    pub two_way: bool,
    /// Whether it may be travelled backward only: from the node where it ends.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub backward: bool,
    /// Speed limit \[m/s\], if there is one: backward, if it may be travelled so only.
    pub speed: Option<f64>,
    /// Speed limit backward, if it is another one \[m/s\].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub speed_back: Option<f64>,
    /// Whether the file closes it for all vehicles.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub closed: bool,
}

impl<'a> LayoutReport<'a> {
    /// The nodes and edges of a layout, in the order of the file.
    pub fn new(layout: &'a Layout) -> Self {
        let mut nodes: Vec<NodeEntry<'a>> = layout.nodes.iter().map(|node| NodeEntry::of(node, layout)).collect();
        for (alias, place) in &layout.aliases {
            if let Some(node) = nodes.get_mut(*place) {
                node.names.push(alias);
            }
        }
        Self {
            layout: &layout.name,
            levels: &layout.levels,
            vehicle_types: &layout.vehicle_types,
            vehicles: &layout.vehicles,
            nodes,
            edges: layout.edges.iter().filter_map(|edge| EdgeEntry::of(edge, layout)).collect(),
            warnings: &layout.warnings,
        }
    }
}

impl<'a> NodeEntry<'a> {
    fn of(node: &'a LayoutNode, layout: &'a Layout) -> Self {
        let level = layout.levels.get(node.level).map_or("", String::as_str);
        Self { id: &node.id, names: node.name.as_deref().into_iter().collect(), level, at: node.point }
    }
}

impl<'a> EdgeEntry<'a> {
    fn of(edge: &'a LayoutEdge, layout: &'a Layout) -> Option<Self> {
        let id = |place: usize| layout.nodes.get(place).map(|node| &node.id);
        let [from, to] = [id(edge.ends[0])?, id(edge.ends[1])?];
        let backward = edge.ways == [false, true];
        let [there, back] = [backward, true].map(|backward| RouteStep { edge, backward });
        let (two_way, speed, closed) = (edge.is_two_way(), there.speed(), edge.closed);
        let speed_back = back.speed().filter(|_| two_way && back.speed() != speed);
        Some(Self { id: &edge.id, from, to, length: edge.length(), two_way, backward, speed, speed_back, closed })
    }
}
