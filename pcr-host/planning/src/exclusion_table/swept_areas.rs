//! The areas that vehicles sweep on the edges and nodes of a layout.
//!
//! Two edges that are the same line in opposite directions form a *track*: lengths that are blocked on one are blocked
//! on the other, and they are computed once.

use super::edge_traversals::{EdgeTraversal, EdgeTraversals, LengthMapping, reversed};
use super::{edges_by_id, nodes_by_id};
use crate::agent_regions::area;
use crate::bodies::{Body, BodyFleet};
use crate::fleet::Fleet;
use crate::parallel;
use pcr_formats::import::{self, ElementId, ImportError, ImportedLayout, Layout, LayoutEdge};
use pcr_formats::scenario::{Agent, PathSegment, Scenario, label};
use std::collections::HashMap;
use std::ops::Range;

/// Number of tracks, pairs of bodies or locks that are computed on all cores before they are passed on.
pub(super) const STRETCH: usize = 1 << 16;

/// The swept areas of vehicles on a layout.
pub struct SweptLayout {
    /// Ids of the edges in their order, then of the nodes.
    pub(super) ids: Vec<ElementId>,
    /// Number of edges among them.
    pub(super) edges: usize,
    pub(super) tracks: Vec<SharedCurve>,
    /// For each ride the meaning of lengths on its path, and its track.
    pub(super) rides: Vec<(LengthMapping, u32)>,
    pub(super) fleet: Fleet<f64>,
    pub(super) bodies: Vec<Body>,
    /// For each body the box of its swept area.
    pub(super) areas: Vec<[f64; 4]>,
}

/// An edge or a node, or several edges with the same curve.
pub(super) struct SharedCurve {
    /// By their places in the names, and whether it leads the other way.
    pub(super) members: Vec<(usize, bool)>,
    /// \[m\]
    pub(super) length: f64,
    levels: [usize; 2],
    pub(super) bodies: Range<usize>,
}

impl SharedCurve {
    /// An edge that leads from level to level is on both.
    pub(super) fn shares_a_level(&self, other: &Self) -> bool {
        self.levels.iter().any(|level| other.levels.contains(level))
    }

    /// Lengths on a member of lengths on the track.
    pub(super) fn on_member(&self, lengths: [f64; 2], turned: bool) -> [f64; 2] {
        if turned { reversed(self.length, lengths) } else { lengths }
    }
}

/// A track before its bodies are made.
pub(super) struct CurveTraversals {
    pub(super) members: Vec<(usize, bool)>,
    pub(super) length: f64,
    pub(super) levels: [usize; 2],
    pub(super) rides: Vec<EdgeTraversal>,
}

impl SweptLayout {
    /// The edges of a layout, and its nodes if asked for.
    ///
    /// # Errors
    /// [`ImportError`] for coordinates beyond what can be computed with.
    pub fn new(imported: &ImportedLayout, nodes: bool) -> Result<Self, ImportError> {
        let (layout, rides) = (&imported.layout, EdgeTraversals::new(imported));
        let order = edges_by_id(layout);
        let mut ids: Vec<ElementId> = order.iter().map(|edge| edge.id.clone()).collect();
        let mut plans: Vec<Box<dyn Fn() -> CurveTraversals + Sync + '_>> = Vec::new();
        for members in tracks(layout, &order, rides.vehicle().footprint.is_none()) {
            let (edge, rides) = (order[members[0].0], &rides);
            plans.push(Box::new(move || CurveTraversals {
                members: members.clone(),
                length: edge.length(),
                levels: edge.ends.map(|node| layout.level_of(node)),
                rides: rides.on_edge(edge),
            }));
        }
        if nodes {
            for node in nodes_by_id(layout) {
                let (place, rides, level) = (ids.len(), &rides, layout.nodes[node].level);
                ids.push(layout.nodes[node].id.clone());
                let members = vec![(place, false)];
                let plan = move || CurveTraversals {
                    members: members.clone(),
                    length: 0.0,
                    levels: [level; 2],
                    rides: vec![rides.at_node(node)],
                };
                plans.push(Box::new(plan));
            }
        }
        let edges = order.len();
        let mut sweep = Self {
            ids,
            edges,
            tracks: Vec::with_capacity(plans.len()),
            rides: Vec::new(),
            fleet: Fleet::new(&Scenario::default()).map_err(|refused| ImportError::new(refused.to_string()))?,
            bodies: Vec::new(),
            areas: Vec::new(),
        };
        for stretch in plans.chunks(STRETCH) {
            let made = parallel::map_parallel(0..stretch.len(), &|place| {
                let plan = stretch[place]();
                let bodies = bodies(&plan, &sweep.ids);
                bodies.map(|bodies| (plan, bodies))
            });
            for made in made {
                let (plan, bodies) = made?;
                sweep.add(plan, bodies);
            }
        }
        Ok(sweep)
    }

    pub(super) fn add(&mut self, plan: CurveTraversals, bodies: BodyFleet<f64>) {
        let (first, before, track) = (self.rides.len(), self.bodies.len(), self.tracks.len() as u32);
        self.rides.extend(plan.rides.into_iter().map(|ride| (ride.lengths, track)));
        self.areas.extend(bodies.fleet.motions().iter().map(area));
        self.fleet.append(bodies.fleet);
        self.bodies.extend(bodies.bodies.into_iter().map(|body| body.moved(first)));
        let CurveTraversals { members, length, levels, .. } = plan;
        self.tracks.push(SharedCurve { members, length, levels, bodies: before..self.bodies.len() });
    }

    /// Names of the edges in their order, then of the nodes in theirs.
    pub fn ids(&self) -> &[ElementId] {
        &self.ids
    }

    /// Whether a place in [`SweptLayout::ids`] is that of an edge.
    pub(crate) fn is_edge(&self, place: usize) -> bool {
        place < self.edges
    }
}

/// The bodies of a track.
pub(super) fn bodies(plan: &CurveTraversals, ids: &[ElementId]) -> Result<BodyFleet<f64>, ImportError> {
    let name = plan.members.first().and_then(|&(place, _)| ids.get(place)).map(|id| label(&id.to_string()));
    let agents = plan.rides.iter().enumerate().map(|(k, ride)| Agent {
        id: k as u64,
        label: name.clone().unwrap_or_default(),
        ..ride.agent.clone()
    });
    let scenario = import::checked(&Scenario::new("", agents.collect()))?;
    BodyFleet::new(&scenario).map_err(|refused| ImportError::new(refused.to_string()))
}

/// The ends of an edge, if it is the straight line between its nodes.
pub(super) fn straight_ends(layout: &Layout, edge: &LayoutEdge) -> Option<[[f64; 2]; 2]> {
    let [[x, y], [to_x, to_y]] = edge.ends.map(|node| layout.position(node));
    let [line] = &edge.curve[..] else { return None };
    let length = (to_x - x).hypot(to_y - y);
    let same = line.start == [x, y] && line.shape == PathSegment::Line { length } && edge.deviation == 0.0;
    (same && line.heading == (to_y - y).atan2(to_x - x)).then_some([[x, y], [to_x, to_y]])
}

/// The edges in their order, those together that are one line between the same nodes if turned over, as a disc is.
fn tracks(layout: &Layout, order: &[&LayoutEdge], disc: bool) -> Vec<Vec<(usize, bool)>> {
    let mut tracks: Vec<Vec<(usize, bool)>> = Vec::new();
    let mut known: HashMap<[usize; 2], (usize, [usize; 2])> = HashMap::new();
    for (place, edge) in order.iter().enumerate() {
        if !disc || straight_ends(layout, edge).is_none() {
            tracks.push(vec![(place, false)]);
            continue;
        }
        let ends = edge.ends;
        let key = [ends[0].min(ends[1]), ends[0].max(ends[1])];
        let &mut (track, first) = known.entry(key).or_insert((tracks.len(), ends));
        match tracks.get_mut(track) {
            Some(members) => members.push((place, ends != first)),
            None => tracks.push(vec![(place, false)]),
        }
    }
    tracks
}
