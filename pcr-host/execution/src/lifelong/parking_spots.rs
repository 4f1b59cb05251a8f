//! Places to stand one behind the other on dead ends, for fleets that have no safe end left. They are between
//! nodes, where no robot has a goal and none passes.

use super::route_graph::RouteGraph;
use pcr_formats::import::{ElementId, ImportedLayout, Layout, LayoutEdge, LayoutNode};
use pcr_formats::scenario::{PathSegment, PlacedSegment};

/// Additional distance between two robots, for rounding \[m\].
const ROOM: f64 = 1e-3;

/// The layout with additional nodes on straight edges to dead ends, as many as there is room for; they come last. Also returns
/// these queues, each with its dead end first.
pub(super) fn queued(imported: &ImportedLayout, site: &RouteGraph) -> (ImportedLayout, Vec<Vec<usize>>) {
    let mut queued = imported.clone();
    let mut lanes = Vec::new();
    for (node, leaving) in site.leaving.iter().enumerate() {
        if let &[atom] = &leaving[..]
            && let Some(back) = site.back[atom]
            && site.coming[node] == [back]
        {
            let mut edges: Vec<usize> = [atom, back].iter().filter_map(|&atom| site.atoms[atom].edge).collect();
            edges.dedup();
            lanes.extend(cut(&mut queued.layout, &edges, node, site.width() + ROOM));
        }
    }
    (queued, lanes)
}

/// Adds nodes on straight edges between a dead end and its neighbour, at the distance `pitch` from each other and from the dead
/// end, and at least as far from the neighbour. Returns the dead end and the new nodes; `None` if an edge is not straight.
fn cut(layout: &mut Layout, edges: &[usize], dead: usize, pitch: f64) -> Option<Vec<usize>> {
    let line = |&edge: &usize| match layout.edges[edge].curve[..] {
        [PlacedSegment { start: at, heading, shape: PathSegment::Line { length } }] => {
            Some((edge, at, heading, length))
        }
        _ => None,
    };
    let lines = edges.iter().map(line).collect::<Option<Vec<_>>>()?;
    let count = (lines.iter().map(|line| line.3).fold(f64::INFINITY, f64::min) / pitch) as usize;
    let first = layout.nodes.len();
    let mut lane = vec![dead];
    for (edge, at, heading, length) in lines {
        let whole = layout.edges[edge].clone();
        let leaves = whole.ends[0] == dead;
        let point = |along: f64| [at[0] + along * heading.cos(), at[1] + along * heading.sin()];
        let mut stops: Vec<(usize, f64)> = (1..count).map(|k| (first + k - 1, k as f64 * pitch)).collect();
        if !leaves {
            stops = stops.into_iter().rev().map(|(node, along)| (node, length - along)).collect();
        }
        if lane.len() == 1 {
            for k in 1..count {
                let along = k as f64 * pitch;
                let at = point(if leaves { along } else { length - along });
                let id = ElementId::Number(layout.nodes.len() as u64);
                lane.push(layout.nodes.len());
                layout.nodes.push(LayoutNode { id, name: None, level: layout.nodes[dead].level, point: at });
            }
        }
        let piece = |ends: [usize; 2], from: f64, to: f64| {
            let shape = PathSegment::Line { length: to - from };
            LayoutEdge { ends, curve: vec![PlacedSegment { start: point(from), heading, shape }], ..whole.clone() }
        };
        let (mut from, mut node) = (0.0, whole.ends[0]);
        for (next, along) in stops {
            layout.edges.push(piece([node, next], from, along));
            (from, node) = (along, next);
        }
        layout.edges[edge] = piece([node, whole.ends[1]], from, length);
    }
    Some(lane)
}
