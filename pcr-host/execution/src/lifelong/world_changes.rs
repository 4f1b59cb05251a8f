//! Changes of the site during a run: what is closed, which robots are stranded, and what each change did.

use super::robot_mission::RobotMission;
use super::route_graph::RouteGraph;
use pcr_formats::import::{Layout, LayoutZone};
use pcr_formats::missions::{ClosedElement, SiteChanges};

/// What a change did to a vehicle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ChangeEffect {
    /// It was on the closed element, or too near to stop before it.
    Through,
    /// It could stop before it, or before another closed element behind it, and got another route.
    Rerouted,
    /// It could stop before it, and went elsewhere or stopped, and waits.
    Waits,
    /// It goes on over what is limited, slower than before.
    Slowed,
}

/// Tasks that could not be done because of a change.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct UnreachableTask {
    /// The vehicle that had them.
    pub(super) robot: usize,
    /// Their goal, as a node of the layout.
    pub(super) node: usize,
    /// Time at which the first of them was found to be unreachable \[s\].
    pub(super) at: f64,
    /// Number of tasks.
    pub(super) tasks: usize,
    /// Whether they were given up, because the change is for ever; otherwise they waited for its end.
    pub(super) is_given_up: bool,
}

/// What a change has done so far.
#[derive(Clone, Debug, Default)]
pub(super) struct ChangeRecord {
    pub(super) is_begun: bool,
    pub(super) is_over: bool,
    /// Vehicles on whose routes it is, and what became of them.
    pub(super) effects: Vec<(usize, ChangeEffect)>,
    /// Where a vehicle that broke down stands: its edge, `None` at a node, and the point \[m\].
    pub(super) place: Option<(Option<usize>, [f64; 2])>,
    pub(super) unreachable: Vec<UnreachableTask>,
}

impl ChangeRecord {
    /// Notes a task that cannot be done.
    fn lose(&mut self, lost: UnreachableTask) {
        let same = |it: &&mut UnreachableTask| {
            (it.robot, it.node, it.is_given_up) == (lost.robot, lost.node, lost.is_given_up)
        };
        match self.unreachable.iter_mut().find(same) {
            Some(known) => known.tasks += lost.tasks,
            None => self.unreachable.push(lost),
        }
    }
}

/// A change, by its index among those of its kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ChangeId {
    Closure(usize),
    Breakdown(usize),
}

/// The changes of a run.
#[derive(Clone, Debug)]
pub(super) struct WorldChanges {
    pub(super) changes: SiteChanges,
    pub(super) closures: Vec<ChangeRecord>,
    pub(super) breakdowns: Vec<ChangeRecord>,
    /// The changes that have begun and are not over, in the order in which they began.
    pub(super) present: Vec<ChangeId>,
    /// For each atom by how many closures it is closed.
    pub(super) closed: Vec<u16>,
    /// For each edge in its directions the largest speed on it without limits of closures \[m/s\].
    pub(super) usual_speeds: Vec<f64>,
    /// For each robot the time until which it is broken down \[s\].
    pub(super) stranded: Vec<f64>,
    /// For each robot the mission that it cannot do while the present changes last.
    pub(super) suspended: Vec<Option<RobotMission>>,
    /// Time of the next look at robots that could go on, and at missions that cannot be done \[s\].
    pub(super) next_review: f64,
    /// Names of the nodes and edges of the layout. Pieces of an edge have the name of the whole.
    pub(super) nodes: Vec<String>,
    pub(super) edges: Vec<String>,
    /// The zones of the layout.
    pub(super) zones: Vec<LayoutZone>,
}

impl WorldChanges {
    pub(super) fn new(changes: &SiteChanges, layout: &Layout, robots: usize, site: &RouteGraph) -> Self {
        let records = |count: usize| vec![ChangeRecord::default(); count];
        Self {
            closures: records(changes.closures.len()),
            breakdowns: records(changes.breakdowns.len()),
            changes: changes.clone(),
            present: Vec::new(),
            closed: vec![0; site.atoms.len()],
            usual_speeds: site.atoms[..site.edges].iter().map(|atom| atom.speed).collect(),
            stranded: vec![0.0; robots],
            suspended: vec![None; robots],
            next_review: 0.0,
            nodes: layout.nodes.iter().map(|node| node.id.to_string()).collect(),
            edges: layout.edges.iter().map(|edge| edge.id.to_string()).collect(),
            zones: layout.zones.clone(),
        }
    }

    pub(super) fn record(&mut self, change: ChangeId) -> &mut ChangeRecord {
        match change {
            ChangeId::Closure(k) => &mut self.closures[k],
            ChangeId::Breakdown(k) => &mut self.breakdowns[k],
        }
    }

    /// When a change begins, and when it ends; infinite: never \[s\].
    pub(super) fn times(&self, change: ChangeId) -> [f64; 2] {
        let (at, until) = match change {
            ChangeId::Closure(k) => (self.changes.closures[k].at, self.changes.closures[k].until),
            ChangeId::Breakdown(k) => (self.changes.breakdowns[k].at, self.changes.breakdowns[k].until),
        };
        [at, until.unwrap_or(f64::INFINITY)]
    }

    fn all(&self) -> impl Iterator<Item = ChangeId> + use<> {
        let closures = (0..self.closures.len()).map(ChangeId::Closure);
        closures.chain((0..self.breakdowns.len()).map(ChangeId::Breakdown))
    }

    /// Takes the changes that begin at or before a time, and those that end.
    pub(super) fn due(&mut self, now: f64) -> [Vec<ChangeId>; 2] {
        let (mut begun, mut over) = (Vec::new(), Vec::new());
        for change in self.all() {
            let [at, until] = self.times(change);
            let record = self.record(change);
            if !record.is_begun && at <= now {
                record.is_begun = true;
                begun.push(change);
            } else if record.is_begun && !record.is_over && until <= now {
                record.is_over = true;
                over.push(change);
            }
        }
        self.present.extend(&begun);
        self.present.retain(|change| !over.contains(change));
        [begun, over]
    }

    /// Whether changes begin or end after this time.
    pub(super) fn is_to_come(&self, now: f64) -> bool {
        let is_later = |change| {
            let [at, until] = self.times(change);
            at > now || (now < until && until < f64::INFINITY)
        };
        self.all().any(is_later)
    }

    /// The changes that are never over, of those that have begun.
    pub(super) fn lasting(&self) -> Vec<ChangeId> {
        self.present.iter().copied().filter(|&change| self.times(change)[1] == f64::INFINITY).collect()
    }

    /// Notes that a task of a robot cannot be done because of a change.
    pub(super) fn lose(&mut self, change: ChangeId, robot: usize, node: usize, at: f64) {
        let is_given_up = self.times(change)[1] == f64::INFINITY;
        self.record(change).lose(UnreachableTask { robot, node, at, tasks: 1, is_given_up });
    }

    /// Whether an edge of the layout is what a closure names, or a piece of it, or is in it.
    pub(super) fn has_edge(&self, element: ClosedElement, edge: usize) -> bool {
        let is_piece = |&whole: &usize| self.edges[whole] == self.edges[edge];
        match element {
            ClosedElement::Edge(closed) => is_piece(&closed),
            ClosedElement::Node(_) => false,
            ClosedElement::Zone(zone) => self.zones[zone].edges.iter().any(is_piece),
        }
    }

    /// Whether a node of the layout is what a closure names, or is in it.
    pub(super) fn has_node(&self, element: ClosedElement, node: usize) -> bool {
        match element {
            ClosedElement::Edge(_) => false,
            ClosedElement::Node(closed) => closed == node,
            ClosedElement::Zone(zone) => self.zones[zone].nodes.contains(&node),
        }
    }

    /// The element and the speed of a change that limits the speed and closes nothing.
    pub(super) fn limit(&self, change: ChangeId) -> Option<(ClosedElement, f64)> {
        match change {
            ChangeId::Closure(k) => {
                let closure = self.changes.closures[k];
                Some((closure.element, closure.speed?))
            }
            ChangeId::Breakdown(_) => None,
        }
    }

    /// Returns whether a robot is broken down.
    pub(super) fn is_stranded(&self, robot: usize, now: f64) -> bool {
        self.stranded[robot] > now
    }
}
