//! Which edges of a layout may not be used at the same time, and on which lengths: the table of locks of a fleet control.
//!
//! Two vehicles are anywhere on two edges. The lengths (l₁, l₂) at which their discs overlap are the collision regions of the two
//! edges in coordination space: the kernels of the library find them, whatever the motions. The extents of a connected region
//! are the lengths within which one edge is blocked while the other is used. They contain the true ones, the deviation of arcs from the
//! curves of the file included. A footprint is the union of its discs in every pose that the vehicle has on an edge, its turns at both ends included; extents that
//! overlap are joined, so that the locks of two edges are apart. A vehicle that stops or turns at a node is at the end of an edge, so
//! that nodes are part of their edges; on their own they can be asked for.

mod rides;

use crate::bodies::Bodies;
use crate::fleet::build_ecm;
use pcr_formats::footprint::Disc;
use pcr_formats::import::{self, Edge, Id, ImportError, Imported, Layout, Node};
use pcr_formats::scenario::{Agent, Scenario};
use rides::Ride;
pub use rides::{Rides, corridor};
use serde::Serialize;
use std::collections::BTreeMap;

/// The locks of a layout for a vehicle.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Locks {
    /// Name of the layout.
    pub layout: String,
    /// The vehicle.
    pub vehicle: LockVehicle,
    /// By `a`, then `b`, then the lengths.
    pub locks: Vec<Lock>,
    /// What a vehicle that stands at a node blocks, if asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub nodes: Option<Vec<NodeLock>>,
    /// Nodes at which vehicles cannot stand at the same time, if asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub node_pairs: Option<Vec<[Id; 2]>>,
    /// What was read otherwise than it was written.
    pub warnings: Vec<String>,
}

/// The vehicle of a table of locks.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LockVehicle {
    /// Its type, where the layout has several.
    pub name: Option<String>,
    /// Radius of its disc \[m\], margin included; with a footprint that of the disc around all of it.
    pub radius: f64,
    /// With a footprint: no point of a disc is farther than this from the outline \[m\].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub overhang: Option<f64>,
    /// With a footprint: the discs that are computed with, margin included.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub discs: Vec<Disc>,
}

/// Two edges, and the lengths of each within which a vehicle may touch one on the other.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Lock {
    /// Edge, as in the layout.
    pub a: Id,
    /// Edge, after `a` in order.
    pub b: Id,
    /// From and to, from the start of `a` \[m\].
    pub a_length: [f64; 2],
    /// From and to, from the start of `b` \[m\].
    pub b_length: [f64; 2],
}

/// A node, and the lengths of an edge within which a vehicle may touch one that stands at the node.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct NodeLock {
    /// Node, as in the layout.
    pub node: Id,
    /// Edge.
    pub edge: Id,
    /// From and to, from the start of the edge \[m\].
    pub edge_length: [f64; 2],
}

/// An edge or a node, with what a vehicle sweeps there.
struct Place<'a> {
    at: At<'a>,
    rides: Vec<Ride>,
}

#[derive(Clone, Copy)]
enum At<'a> {
    Edge(&'a Edge),
    Node(&'a Node),
}

impl At<'_> {
    fn id(&self) -> &Id {
        match self {
            Self::Edge(edge) => &edge.id,
            Self::Node(node) => &node.id,
        }
    }
}

/// Lengths of two edges at which vehicles may touch.
type Extents = [[f64; 2]; 2];

impl Locks {
    /// The locks of a layout for its vehicle; with `nodes`, what standing at a node blocks as well, in any heading.
    ///
    /// Cost: a box test a pair of discs on the edges of one level, and a microsecond for each pair of segments that meet.
    ///
    /// # Errors
    /// [`ImportError`] for more than 65535 discs on the edges (and nodes) of one level, or coordinates beyond what can be computed with.
    pub fn of(imported: &Imported, nodes: bool) -> Result<Self, ImportError> {
        let layout = &imported.layout;
        let rides = Rides::new(imported);
        let vehicle = rides.vehicle();
        let footprint = vehicle.footprint.as_ref();
        let mut locks = Self {
            layout: layout.name.clone(),
            vehicle: LockVehicle {
                name: vehicle.name.clone(),
                radius: vehicle.radius,
                overhang: footprint.map(|footprint| footprint.overhang()),
                discs: footprint.map_or_else(Vec::new, |footprint| footprint.discs().to_vec()),
            },
            locks: Vec::new(),
            nodes: nodes.then(Vec::new),
            node_pairs: nodes.then(Vec::new),
            warnings: layout.warnings.iter().cloned().chain(rounded(layout)).collect(),
        };
        for level in 0..layout.levels.len() {
            locks.add(&places(layout, &rides, level, nodes))?;
        }
        locks.locks.sort_by(|a, b| {
            let lengths = |lock: &Lock| [lock.a_length[0], lock.b_length[0]];
            let ids = (&a.a, &a.b).cmp(&(&b.a, &b.b));
            ids.then(lengths(a)[0].total_cmp(&lengths(b)[0])).then(lengths(a)[1].total_cmp(&lengths(b)[1]))
        });
        // Two that are both on two levels.
        locks.locks.dedup();
        Ok(locks)
    }

    fn add(&mut self, places: &[Place<'_>]) -> Result<(), ImportError> {
        for ([a, b], extents) in extents(places)? {
            let [Some(a), Some(b)] = [places.get(a), places.get(b)] else { continue };
            let (a_id, b_id) = (a.at.id(), b.at.id());
            for [a_length, b_length] in joined(extents) {
                let (a_id, b_id) = (a_id.clone(), b_id.clone());
                match (a.at, b.at) {
                    (At::Edge(_), At::Edge(_)) => self.locks.push(Lock { a: a_id, b: b_id, a_length, b_length }),
                    (At::Edge(_), At::Node(_)) => {
                        let lock = NodeLock { node: b_id, edge: a_id, edge_length: a_length };
                        self.nodes.get_or_insert_default().push(lock);
                    }
                    // Edges come before nodes.
                    (At::Node(_), _) => self.node_pairs.get_or_insert_default().push([a_id, b_id]),
                }
            }
        }
        Ok(())
    }
}

/// What has to be said of layouts of which routes round the corners.
fn rounded(layout: &Layout) -> Option<String> {
    let radius = layout.corner_radius.filter(|radius| *radius > 0.0)?;
    Some(format!(
        "corners: routes round them with {radius} m, off their edges by up to {radius} m (1 - cos(a/2)) in a turn by a; locks are those of \
         vehicles that keep to the edges: give that as --margin"
    ))
}

/// The edges of a level, one that leads from level to level on both, and its nodes if asked for.
fn places<'a>(layout: &'a Layout, rides: &Rides<'_>, level: usize, nodes: bool) -> Vec<Place<'a>> {
    let edges = layout.edges.iter().filter(|edge| layout.is_on(edge, level));
    let mut places: Vec<Place<'_>> = edges.map(|edge| Place { at: At::Edge(edge), rides: rides.on(edge) }).collect();
    places.sort_by(|a, b| a.at.id().cmp(b.at.id()));
    if nodes {
        let there = layout.nodes.iter().enumerate().filter(|(_, node)| node.level == level);
        let mut there: Vec<Place<'_>> =
            there.map(|(k, node)| Place { at: At::Node(node), rides: vec![rides.at(k)] }).collect();
        there.sort_by(|a, b| a.at.id().cmp(b.at.id()));
        places.extend(there);
    }
    places
}

/// What vehicles sweep on all edges and nodes of each level, as the agents whose regions the locks are made of: what has to be certified
/// of a table of locks.
///
/// # Errors
/// As [`Locks::of`].
pub fn scenarios(imported: &Imported) -> Result<Vec<Scenario>, ImportError> {
    let (layout, rides) = (&imported.layout, Rides::new(imported));
    let levels = layout.levels.iter().enumerate();
    levels
        .map(|(level, name)| {
            let places = places(layout, &rides, level, true);
            let rides: Vec<&Ride> = places.iter().flat_map(|place| &place.rides).collect();
            Ok(Scenario { name: format!("{} {name}", layout.name).trim().to_owned(), ..scenario(&rides)? })
        })
        .collect()
}

/// The rides as agents.
fn scenario(rides: &[&Ride]) -> Result<Scenario, ImportError> {
    let agents = rides.iter().enumerate().map(|(k, ride)| Agent { id: k as u64, ..ride.agent.clone() });
    import::checked(&Scenario::new("", agents.collect()))
}

/// Of every two places, the first one before the second, the extents of the regions of their discs.
fn extents(places: &[Place<'_>]) -> Result<BTreeMap<[usize; 2], Vec<Extents>>, ImportError> {
    let refused = |problem: &dyn ToString| ImportError::new(problem.to_string());
    let rides: Vec<(usize, &Ride)> =
        places.iter().enumerate().flat_map(|(k, place)| place.rides.iter().map(move |ride| (k, ride))).collect();
    let scenario = scenario(&rides.iter().map(|&(_, ride)| ride).collect::<Vec<_>>())?;
    let Bodies { fleet, discs, .. } = Bodies::<f64>::new(&scenario).map_err(|problem| refused(&problem))?;
    let motions = fleet.motions();
    let ecm = build_ecm(&motions).map_err(|full| refused(&full))?;
    let mut extents: BTreeMap<[usize; 2], Vec<Extents>> = BTreeMap::new();
    for (k, disc) in discs.iter().enumerate() {
        for region in ecm.row(&motions, k).expect("the table of the fleet").filter(|region| region.other() > k) {
            let Some(other) = discs.get(region.other()) else { continue };
            let [Some((a, own)), Some((b, their))] = [rides.get(disc.agent), rides.get(other.agent)] else { continue };
            if a != b {
                let range = |interval: pcr_core::Interval<f64>| [interval.lo, interval.hi];
                let lengths = own.on_edge(disc.on_agent(range(region.length())));
                let other_lengths = their.on_edge(other.on_agent(range(region.other_length())));
                extents.entry([*a, *b]).or_default().push([lengths, other_lengths]);
            }
        }
    }
    Ok(extents)
}

/// The hulls of those that overlap, again and again until all are apart.
fn joined(extents: Vec<Extents>) -> Vec<Extents> {
    let mut apart: Vec<Extents> = Vec::new();
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
