//! The table of locks for fleet control: which edges of a layout must not be used at the same time, and on which
//! lengths.
//!
//! Let two vehicles be anywhere on two edges. The lengths (l₁, l₂) at which they overlap are the collision
//! regions of the two edges in coordination space, which the kernels of the library compute, whatever the motions. The
//! ranges of a connected region are the lengths on which one edge is blocked while the other is used. They contain the
//! exact ones, including the deviation of arcs from the curves of the file. An outline sweeps what it is in
//! every pose that the vehicle has on an edge, including its turns at both ends. Ranges that overlap are joined, so the
//! locks of two edges are disjoint. A vehicle that stops or turns at a node is at the end of an edge, so nodes are part
//! of their edges; locks of nodes alone can be requested, too.

mod area_pair_search;
mod contact;
mod edge_traversals;
mod incremental;
mod index;
mod layout_change;
mod origin;
mod straight_edges;
mod swept_areas;
mod unsafe_delays;

use crate::memory_budget;
pub use area_pair_search::{SyncProgressFn, TouchingAreas};
pub use contact::can_touch;
pub use edge_traversals::EdgeTraversal;
pub use edge_traversals::{EdgeTraversals, SweptShape, corridor, is_turn, placed_pieces, swept};
pub use incremental::{ExclusionChange, IncrementalExclusions};
pub use index::{ExclusionIndex, ExclusionIndexError, ExclusionPartner, IndexDamage, write_index};
pub use origin::origin;
use pcr_formats::footprint::Footprint;
use pcr_formats::import::{self, ElementId, ImportError, ImportedLayout, Layout, LayoutEdge};
use pcr_formats::scenario::{Agent, Scenario};
use serde::Serialize;
pub use straight_edges::StraightEdge;
pub use swept_areas::SweptLayout;
pub(crate) use unsafe_delays::ForbiddenDelays;
pub use unsafe_delays::{DelayApproach, DelayProof, DirectedEdge, EdgeDriving, UnsafeDelayModel, UnsafeRelation};

/// The locks of a layout for a vehicle.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ExclusionTable {
    /// Name of the layout.
    pub layout: String,
    /// The vehicle.
    pub vehicle: ExclusionVehicle,
    /// Sorted by `a`, then `b`, then the lengths.
    pub locks: Vec<EdgeExclusion>,
    /// Lengths of edges that a vehicle standing at a node blocks, if requested.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub nodes: Option<Vec<NodeExclusion>>,
    /// Nodes at which vehicles cannot stand at the same time, if requested.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub node_pairs: Option<Vec<[ElementId; 2]>>,
    /// Warnings about input that was changed or left out when it was read.
    pub warnings: Vec<String>,
}

/// The vehicle of a table of locks.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ExclusionVehicle {
    /// Its type, if the layout has several.
    pub name: Option<String>,
    /// Radius of its disc \[m\], with margin; for a footprint that of the disc around all of it.
    pub radius: f64,
    /// By how much it is larger on edges at rounded corners, if these are included \[m\].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub corner_margin: Option<f64>,
    /// Its outline, with margin, if it is no disc.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub footprint: Option<Footprint>,
}

/// Two edges, and the lengths of each within which a vehicle may touch one on the other.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct EdgeExclusion {
    /// Id of the first edge.
    pub a: ElementId,
    /// Id of the second edge, which comes after `a`.
    pub b: ElementId,
    /// Range of lengths from the start of `a` \[m\].
    pub a_length: [f64; 2],
    /// Range of lengths from the start of `b` \[m\].
    pub b_length: [f64; 2],
}

/// A node, and the lengths of an edge within which a vehicle may touch one that stands at the node.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct NodeExclusion {
    /// Id of the node.
    pub node: ElementId,
    /// Id of the edge.
    pub edge: ElementId,
    /// Range of lengths from the start of the edge \[m\].
    pub edge_length: [f64; 2],
}

/// Lengths of two edges at which vehicles may touch \[m\].
pub type LengthRanges = [[f64; 2]; 2];

impl ExclusionTable {
    /// The locks of a layout for its vehicle; with `nodes` also what a vehicle standing at a node blocks, in any heading.
    ///
    /// Cost: less than a microsecond for each pair of straight segments whose boxes meet, on each core.
    ///
    /// # Errors
    /// [`ImportError`] for coordinates that are too large, and for a table that does not fit in memory.
    pub fn compute(imported: &ImportedLayout, nodes: bool) -> Result<Self, ImportError> {
        Self::watched(imported, nodes, &|_, _| {})
    }

    /// The same, with reports of progress: examined pairs, and all pairs.
    ///
    /// # Errors
    /// As [`ExclusionTable::compute`].
    pub fn watched(imported: &ImportedLayout, nodes: bool, told: SyncProgressFn<'_>) -> Result<Self, ImportError> {
        let sweep = SweptLayout::new(imported, nodes)?;
        let mut locks = Self::head(imported, nodes);
        let mut held = 0;
        sweep.each(told, &<[TouchingAreas]>::to_vec, |found| {
            // A lock has two ids.
            held += found.len() as u64 * (size_of::<EdgeExclusion>() + 64) as u64;
            if held > memory_budget::STEP {
                let count = locks.locks.len();
                memory_budget::ask(held + 2 * (count * size_of::<EdgeExclusion>()) as u64, || {
                    format!("a table of over {count} locks")
                })
                .map_err(|large| ImportError::new(large.to_string()))?;
                held = 0;
            }
            found.iter().for_each(|found| locks.add(&sweep, found));
            Ok::<(), ImportError>(())
        })?;
        Ok(locks)
    }

    /// The table without its locks.
    pub fn head(imported: &ImportedLayout, nodes: bool) -> Self {
        let (layout, rides) = (&imported.layout, EdgeTraversals::new(imported));
        let vehicle = rides.vehicle();
        Self {
            layout: layout.name.clone(),
            vehicle: ExclusionVehicle {
                name: vehicle.name.clone(),
                radius: vehicle.radius,
                corner_margin: Some(layout.corner_margin).filter(|margin| *margin > 0.0),
                footprint: vehicle.footprint.clone(),
            },
            locks: Vec::new(),
            nodes: nodes.then(Vec::new),
            node_pairs: nodes.then(Vec::new),
            warnings: layout.warnings.clone(),
        }
    }

    fn add(
        &mut self,
        sweep: &SweptLayout,
        &TouchingAreas { places: [a, b], lengths: [a_length, b_length] }: &TouchingAreas,
    ) {
        let [(Some(a_id), a_edge), (Some(b_id), b_edge)] =
            [a, b].map(|place| (sweep.ids().get(place).cloned(), sweep.is_edge(place)))
        else {
            return;
        };
        match (a_edge, b_edge) {
            (true, true) => self.locks.push(EdgeExclusion { a: a_id, b: b_id, a_length, b_length }),
            (true, false) => {
                let lock = NodeExclusion { node: b_id, edge: a_id, edge_length: a_length };
                self.nodes.get_or_insert_default().push(lock);
            }
            // Edges come before nodes.
            (false, _) => self.node_pairs.get_or_insert_default().push([a_id, b_id]),
        }
    }
}

/// The swept areas of vehicles on all edges and nodes of each level, as the agents from whose regions the locks are computed. A
/// certificate of the locks is about these.
///
/// # Errors
/// As [`ExclusionTable::compute`].
pub fn scenarios(imported: &ImportedLayout) -> Result<Vec<Scenario>, ImportError> {
    let (layout, rides) = (&imported.layout, EdgeTraversals::new(imported));
    let (edges, nodes) = (edges_by_id(layout), nodes_by_id(layout));
    let levels = layout.levels.iter().enumerate();
    levels
        .map(|(level, name)| {
            let edges = edges.iter().filter(|edge| layout.is_on(edge, level));
            let nodes = nodes.iter().filter(|&&node| layout.nodes[node].level == level);
            let rides: Vec<EdgeTraversal> =
                edges.flat_map(|edge| rides.on_edge(edge)).chain(nodes.map(|&node| rides.at_node(node))).collect();
            let name = if layout.levels.len() > 1 { format!("{} {name}", layout.name) } else { layout.name.clone() };
            Ok(Scenario { name: name.trim().to_owned(), ..scenario(&rides)? })
        })
        .collect()
}

/// The edges of a layout in the order of their ids.
fn edges_by_id(layout: &Layout) -> Vec<&LayoutEdge> {
    let mut edges: Vec<&LayoutEdge> = layout.edges.iter().collect();
    edges.sort_by(|a, b| a.id.cmp(&b.id));
    edges
}

/// The places of the nodes of a layout in the order of their ids.
fn nodes_by_id(layout: &Layout) -> Vec<usize> {
    let mut nodes: Vec<usize> = (0..layout.nodes.len()).collect();
    nodes.sort_by(|&a, &b| layout.nodes[a].id.cmp(&layout.nodes[b].id));
    nodes
}

/// The rides as agents.
fn scenario(rides: &[EdgeTraversal]) -> Result<Scenario, ImportError> {
    let agents = rides.iter().enumerate().map(|(k, ride)| Agent { id: k as u64, ..ride.agent.clone() });
    import::checked(&Scenario::new("", agents.collect()))
}

/// The hulls of overlapping extents, joined until all are disjoint.
fn joined(extents: Vec<LengthRanges>) -> Vec<LengthRanges> {
    let mut apart: Vec<LengthRanges> = Vec::new();
    for mut next in extents {
        let overlap = |[a, b]: [f64; 2], [c, d]: [f64; 2]| a <= d && c <= b;
        while let Some(place) = apart.iter().position(|other| (0..2).all(|k| overlap(next[k], other[k]))) {
            let other = apart.swap_remove(place);
            for (a, b) in next.iter_mut().zip(other) {
                *a = [a[0].min(b[0]), a[1].max(b[1])];
            }
        }
        apart.push(next);
    }
    apart
}
