//! Which edges of a layout may not be used at the same time, and on which lengths: the table of locks of a fleet control.
//!
//! Two vehicles are anywhere on two edges. The lengths (l₁, l₂) at which their discs overlap are the collision regions of the two
//! edges in coordination space: the kernels of the library find them, no motion takes part. Each connected region is a
//! lock; its extents are the lengths within which one edge is blocked while the other is used. They contain the true ones, the
//! deviation of arcs from the curves of the file included. A vehicle that stops or turns at a node is at the end of an edge, so that
//! nodes are part of their edges; on their own they can be asked for.

use crate::fleet::{Fleet, build_ecm};
use crate::import::{self, Edge, Id, ImportError, Imported, Layout, Node};
use crate::scenario::{Agent, MotionSpec, PathSegment, Scenario};
use serde::Serialize;

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
}

/// The vehicle of a table of locks.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LockVehicle {
    /// Its type, where the layout has several.
    pub name: Option<String>,
    /// Radius of its disc \[m\], margin included.
    pub radius: f64,
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

/// A disc on the path of an edge, or at a node.
#[derive(Clone, Copy)]
enum Place<'a> {
    Edge(&'a Edge),
    Node(&'a Node),
}

impl Place<'_> {
    fn id(&self) -> &Id {
        match self {
            Self::Edge(edge) => &edge.id,
            Self::Node(node) => &node.id,
        }
    }

    fn agent(&self, number: usize, layout: &Layout, radius: f64) -> Agent {
        let (start, path, deviation) = match self {
            Self::Edge(edge) => layout.path_of(edge),
            Self::Node(Node { at: [x, y], .. }) => ([*x, *y, 0.0], Vec::<PathSegment>::new(), 0.0),
        };
        // Any motion does: lengths do not depend on it.
        let motion = MotionSpec::RestToRest { v_max: 1.0, a_max: 1.0 };
        Agent {
            id: number as u64,
            radius: radius + deviation,
            footprint: None,
            loads: Vec::new(),
            margin: 0.0,
            t_start: 0.0,
            start,
            path,
            motion,
        }
    }
}

impl Locks {
    /// The locks of a layout for its vehicle; with `nodes`, what standing at a node blocks as well.
    ///
    /// Cost: a box test a pair of edges of one level, and a microsecond for each pair of segments that meet.
    ///
    /// # Errors
    /// [`ImportError`] for more than 65535 edges (and nodes) of one level, or coordinates beyond what can be computed with.
    pub fn of(imported: &Imported, nodes: bool) -> Result<Self, ImportError> {
        let Imported { layout, vehicle } = imported;
        let mut locks = Self {
            layout: layout.name.clone(),
            vehicle: LockVehicle { name: vehicle.name.clone(), radius: vehicle.radius + vehicle.margin },
            locks: Vec::new(),
            nodes: nodes.then(Vec::new),
            node_pairs: nodes.then(Vec::new),
        };
        for level in 0..layout.levels.len() {
            let edges = layout.edges.iter().filter(|edge| layout.level(edge) == level);
            let mut edges: Vec<&Edge> = edges.collect();
            edges.sort_by(|a, b| a.id.cmp(&b.id));
            let mut places: Vec<Place<'_>> = edges.into_iter().map(Place::Edge).collect();
            if nodes {
                let mut there: Vec<&Node> = layout.nodes.iter().filter(|node| node.level == level).collect();
                there.sort_by(|a, b| a.id.cmp(&b.id));
                places.extend(there.into_iter().map(Place::Node));
            }
            locks.add(layout, &places)?;
        }
        locks.locks.sort_by(|a, b| {
            let lengths = |lock: &Lock| [lock.a_length[0], lock.b_length[0]];
            let ids = (&a.a, &a.b).cmp(&(&b.a, &b.b));
            ids.then(lengths(a)[0].total_cmp(&lengths(b)[0])).then(lengths(a)[1].total_cmp(&lengths(b)[1]))
        });
        Ok(locks)
    }

    fn add(&mut self, layout: &Layout, places: &[Place<'_>]) -> Result<(), ImportError> {
        let radius = self.vehicle.radius;
        let agents = places.iter().enumerate().map(|(k, place)| place.agent(k, layout, radius)).collect();
        let scenario = import::checked(&Scenario { name: String::new(), agents })?;
        let fleet = Fleet::<f64>::new(&scenario).map_err(|refused| ImportError::new(refused.to_string()))?;
        let motions = fleet.motions();
        let ecm = build_ecm(&motions).map_err(|full| ImportError::new(full.to_string()))?;
        for (k, a) in places.iter().enumerate() {
            for region in ecm.row(&motions, k).filter(|region| region.other() > k) {
                let Some(b) = places.get(region.other()) else { continue };
                let range = |interval: pcr_core::Interval<f64>| [interval.lo, interval.hi];
                let (own, other) = (range(region.length()), range(region.other_length()));
                let (a_id, b_id) = (a.id().clone(), b.id().clone());
                match (a, b) {
                    (Place::Edge(_), Place::Edge(_)) => {
                        self.locks.push(Lock { a: a_id, b: b_id, a_length: own, b_length: other });
                    }
                    (Place::Edge(_), Place::Node(_)) => {
                        let lock = NodeLock { node: b_id, edge: a_id, edge_length: own };
                        self.nodes.get_or_insert_default().push(lock);
                    }
                    // Edges come before nodes.
                    (Place::Node(_), _) => self.node_pairs.get_or_insert_default().push([a_id, b_id]),
                }
            }
        }
        Ok(())
    }
}
