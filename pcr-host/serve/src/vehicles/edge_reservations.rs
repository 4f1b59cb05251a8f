//! Locks, which fleet managers use without a supervisor, for comparison. A vehicle holds the edges that it is on, and
//! gets more of its way if no other vehicle holds an edge on which they would touch: either all of it at once, or one
//! edge after the other if all vehicles could still finish one after the other then (the banker's check, Dijkstra
//! 1965). No vehicle's end is on the way of another one, so the order in which vehicles finish does not matter.

use pcr_formats::import::Layout;
use serde::Serialize;

/// How vehicles are kept apart.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum VehicleCoordination {
    /// The manager releases all of an order, and a supervisor decides how far each vehicle may go.
    #[default]
    Supervisor,
    /// The manager releases a whole order when no other vehicle has a lock on its way.
    RouteLocks,
    /// The manager releases one edge after the other, each only if all vehicles can still finish.
    EdgeLocks,
}

impl VehicleCoordination {
    /// All methods.
    pub const ALL: [Self; 3] = [Self::Supervisor, Self::RouteLocks, Self::EdgeLocks];

    /// Its name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Supervisor => "supervisor",
            Self::RouteLocks => "route-locks",
            Self::EdgeLocks => "edge-locks",
        }
    }
}

/// An edge of a way.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MissionEdge {
    /// Index of the edge.
    pub edge: usize,
    /// \[m\]
    pub length: f64,
    /// The node where it ends.
    pub to: usize,
}

/// The edges that a vehicle wants and has.
#[derive(Clone, Debug, Default)]
struct EdgeReservation {
    /// Edges of its way.
    edges: Vec<MissionEdge>,
    /// Nodes at which it stands before and after.
    ends: [usize; 2],
    /// Number of edges that it has passed, and number that it was given.
    passed: usize,
    given: usize,
    /// Time since which it has been at the end of what it was given \[s\].
    since: f64,
}

/// The locks of all vehicles. The pieces of a layout are its nodes, at which vehicles stand, and then its edges.
#[derive(Debug)]
pub(crate) struct EdgeReservations {
    is_whole: bool,
    nodes: usize,
    /// For each piece the pieces on which discs would touch.
    touch: Vec<Vec<usize>>,
    claims: Vec<EdgeReservation>,
    /// How far ahead of the node that it has reached last a vehicle gets edges \[m\].
    far: f64,
    /// Whether something has changed since edges were last given.
    changed: bool,
}

/// Two end points.
type EdgeEnds = [[f64; 2]; 2];

impl EdgeReservations {
    /// The locks of vehicles that stand at these nodes, with discs that do not touch at this distance \[m\].
    pub(crate) fn new(layout: &Layout, clearance: f64, far: f64, is_whole: bool, standing: &[usize]) -> Self {
        let nodes = layout.nodes.iter().map(|node| [node.point; 2]);
        let edges = layout.edges.iter().map(|edge| edge.ends.map(|node| layout.position(node)));
        let pieces: Vec<EdgeEnds> = nodes.chain(edges).collect();
        let near = |a: &EdgeEnds| -> Vec<usize> {
            let touches = |b: &EdgeEnds| distance(*a, *b) < clearance;
            pieces.iter().enumerate().filter(|(_, b)| touches(b)).map(|(place, _)| place).collect()
        };
        let touch = pieces.iter().map(near).collect();
        let claims =
            standing.iter().map(|&node| EdgeReservation { ends: [node; 2], ..EdgeReservation::default() }).collect();
        Self { is_whole, nodes: layout.nodes.len(), touch, claims, far, changed: true }
    }

    /// Requests these edges for a vehicle that stands.
    pub(crate) fn want(&mut self, vehicle: usize, edges: Vec<MissionEdge>, now: f64) {
        if let Some(claim) = self.claims.get_mut(vehicle) {
            let from = claim.ends[1];
            let to = edges.last().map_or(from, |last| last.to);
            *claim = EdgeReservation { edges, ends: [from, to], passed: 0, given: 0, since: now };
            self.changed = true;
        }
    }

    /// Notes that a vehicle has passed this number of edges.
    pub(crate) fn passed(&mut self, vehicle: usize, edges: usize, now: f64) {
        if let Some(claim) = self.claims.get_mut(vehicle)
            && edges > claim.passed
        {
            (claim.passed, claim.since) = (edges.min(claim.given), now);
            self.changed = true;
        }
    }

    /// Number of edges that a vehicle was given.
    pub(crate) fn given(&self, vehicle: usize) -> usize {
        self.claims.get(vehicle).map_or(0, |claim| claim.given)
    }

    /// Gives edges to all vehicles that can get some, the one that has waited longest first.
    pub(crate) fn give(&mut self) {
        if !std::mem::take(&mut self.changed) {
            return;
        }
        let mut order: Vec<usize> = (0..self.claims.len()).collect();
        order.sort_by(|&a, &b| self.claims[a].since.total_cmp(&self.claims[b].since));
        let mut held = vec![0_usize; self.touch.len()];
        for claim in &self.claims {
            claim.held_pieces(self.nodes).for_each(|piece| self.count(&mut held, piece, 1));
        }
        for vehicle in order {
            while self.claims[vehicle].wants(self.is_whole, self.far) {
                let before = self.claims[vehicle].clone();
                let all = before.edges.len();
                let given = if self.is_whole { all } else { before.given + 1 };
                let mut next = held.clone();
                before.held_pieces(self.nodes).for_each(|piece| self.count(&mut next, piece, -1));
                let own = EdgeReservation { given, ..before.clone() };
                let end = (given == all).then_some(own.ends[1]);
                let is_free = own.held_pieces(self.nodes).chain(end).all(|piece| next[piece] == 0);
                own.held_pieces(self.nodes).for_each(|piece| self.count(&mut next, piece, 1));
                self.claims[vehicle] = own;
                if !is_free || !(self.is_whole || self.can_finish(next.clone())) {
                    self.claims[vehicle] = before;
                    break;
                }
                held = next;
            }
        }
    }

    /// Adds to the count of holders on all pieces that touch a piece.
    fn count(&self, held: &mut [usize], piece: usize, by: isize) {
        for &near in self.touch.get(piece).into_iter().flatten() {
            held[near] = held[near].saturating_add_signed(by);
        }
    }

    /// Whether all vehicles can finish one after the other.
    fn can_finish(&self, mut held: Vec<usize>) -> bool {
        let mut left: Vec<&EdgeReservation> = self.claims.iter().collect();
        loop {
            let before = left.len();
            left.retain(|claim| {
                claim.held_pieces(self.nodes).for_each(|piece| self.count(&mut held, piece, -1));
                let finishes = claim.edges.iter().skip(claim.given).all(|leg| held[self.nodes + leg.edge] == 0)
                    && held[claim.ends[1]] == 0;
                match finishes {
                    true => self.count(&mut held, claim.ends[1], 1),
                    false => claim.held_pieces(self.nodes).for_each(|piece| self.count(&mut held, piece, 1)),
                }
                !finishes
            });
            if left.is_empty() || left.len() == before {
                return left.is_empty();
            }
        }
    }
}

impl EdgeReservation {
    /// The pieces that the vehicle holds: edges, or the node where it stands.
    fn held_pieces(&self, nodes: usize) -> impl Iterator<Item = usize> {
        let edges = self.edges.iter().take(self.given).skip(self.passed).map(move |leg| nodes + leg.edge);
        let stands =
            self.passed.checked_sub(1).and_then(|last| self.edges.get(last)).map_or(self.ends[0], |leg| leg.to);
        edges.chain((self.passed == self.given).then_some(stands))
    }

    fn wants(&self, is_whole: bool, far: f64) -> bool {
        // Length given beyond the edge where it is.
        let has: f64 = self.edges.iter().take(self.given).skip(self.passed + 1).map(|leg| leg.length).sum();
        self.given < self.edges.len() && (is_whole || has < far)
    }
}

/// Distance between two line segments.
pub fn distance([a, b]: EdgeEnds, [c, d]: EdgeEnds) -> f64 {
    let cross = |o: [f64; 2], p: [f64; 2], q: [f64; 2]| (p[0] - o[0]) * (q[1] - o[1]) - (p[1] - o[1]) * (q[0] - o[0]);
    let opposite = |o: [f64; 2], p: [f64; 2], q: [f64; 2], r: [f64; 2]| cross(o, p, q) * cross(o, p, r) < 0.0;
    if opposite(a, b, c, d) && opposite(c, d, a, b) {
        return 0.0;
    }
    let ends = [to_line(a, c, d), to_line(b, c, d), to_line(c, a, b), to_line(d, a, b)];
    ends.into_iter().fold(f64::INFINITY, f64::min)
}

/// Distance from a point to the segment between two others.
pub(crate) fn to_line(point: [f64; 2], from: [f64; 2], to: [f64; 2]) -> f64 {
    let [x, y] = [point[0] - from[0], point[1] - from[1]];
    let [dx, dy] = [to[0] - from[0], to[1] - from[1]];
    let square = dx * dx + dy * dy;
    let part = if square > 0.0 { ((x * dx + y * dy) / square).clamp(0.0, 1.0) } else { 0.0 };
    (x - part * dx).hypot(y - part * dy)
}

#[cfg(test)]
mod tests {
    use super::*;
    use pcr_formats::import::{ElementId, LayoutEdge, LayoutNode};

    /// An edge to a node that is not there was locked with none.
    #[test]
    #[should_panic(expected = "index out of bounds")]
    fn an_edge_without_an_end_has_no_locks() {
        let node = |id: u64| LayoutNode { id: ElementId::Number(id), name: None, level: 0, point: [id as f64, 0.0] };
        let edges = vec![LayoutEdge::new(ElementId::Number(0), [0, 2], Vec::new())];
        let layout = Layout { nodes: vec![node(0), node(1)], edges, ..Layout::default() };
        EdgeReservations::new(&layout, 0.5, 1.0, true, &[0]);
    }

    #[test]
    fn distances_of_straight_ways() {
        let way = |a, b| [a, b];
        assert_eq!(distance(way([0.0, 0.0], [2.0, 0.0]), way([1.0, -1.0], [1.0, 1.0])), 0.0);
        assert_eq!(distance(way([0.0, 0.0], [2.0, 0.0]), way([3.0, 1.0], [3.0, 4.0])), 2.0_f64.sqrt());
        assert_eq!(distance(way([0.0, 0.0], [2.0, 0.0]), way([1.0, 3.0], [1.0, 3.0])), 3.0);
        assert_eq!(distance(way([0.0, 0.0], [2.0, 0.0]), way([0.5, 0.25], [9.0, 0.25])), 0.25);
    }
}
