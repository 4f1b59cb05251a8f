//! The order of a vehicle: as given by the manager, and the part of it that the vehicle has.

use super::super::order_path::OrderPath;
use super::journal_notes::noted;
use crate::closed_area::SpeedLimit;
use crate::owned_path::StartPose;
use crate::robot::SupervisedRobot;
use crate::supervisor::JournalError;
use pcr_formats::vda5050::order::{NodePosition, OrderEdge, OrderNode};
use pcr_formats::vda5050::order_state::OrderState;
use pcr_formats::vda5050::state::State;
use pcr_formats::vda5050::version::ProtocolVersion;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

/// Largest distance between the vehicle and the first node of its order \[m\]; the vehicle goes there in a straight line.
pub(super) const BEGINS: f64 = 1.0;

/// Number of passed stops that are kept when an order is trimmed: late states name them. An order that is extended for hours stays short, because
/// each update writes all of it to the journal.
const KEPT: usize = 50;

/// A place where the base of the vehicle's order may end.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ReleasePoint {
    /// Sequence number of the node in the messages to the vehicle.
    pub sequence: u64,
    /// Length of the way up to the stop \[m\].
    pub length: f64,
    /// Index of the manager's node at the stop, or of the last one before it.
    pub node: usize,
    /// Whether the stop is in the middle of the edge after that node.
    pub between: bool,
    /// The limit of the speed with which the way up to it was released, because of areas \[m/s\].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub speed: Option<f64>,
}

/// An order update that was sent.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SentUpdate {
    /// Update id in the message to the vehicle.
    pub update: u64,
    /// Update id of the manager's order from which it was made.
    pub manager: u64,
    /// Index of its first stop.
    pub from: usize,
}

/// What a vehicle has said of its order.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct VehicleAcknowledgement {
    /// Whether it has named the order: it has it, or had it, and must not get it again as a new one.
    pub named: bool,
    /// Update ids of the update that the vehicle has: its own and the manager's.
    pub acknowledged: Option<(u64, u64)>,
}

/// A cancellation of an order.
#[derive(Clone, Debug, PartialEq)]
pub struct Cancellation {
    /// Id of the action.
    pub action: String,
    /// Times at which the order was cancelled first, and at which the action was sent last \[s\].
    pub(crate) first_at: f64,
    pub(crate) last_at: f64,
}

impl Cancellation {
    /// One of a time before the start.
    fn remembered(action: String) -> Self {
        Self { action, first_at: f64::NEG_INFINITY, last_at: f64::NEG_INFINITY }
    }
}

/// Key of the note about that.
pub(super) const RECEIVED: &str = "received";

/// An order.
#[derive(Clone, Debug)]
pub struct ActiveOrder {
    /// The order as the manager gave it.
    pub order: OrderState,
    /// Path of the order, from where the vehicle stood.
    pub path: OrderPath,
    /// Edition of VDA 5050 of the manager's order.
    pub version: String,
    /// Index of the node up to which the supervisor was asked for a way.
    pub requested_node: usize,
    /// Stops that the vehicle has been released, or may have been.
    pub stops: Vec<ReleasePoint>,
    /// The last update that was sent.
    pub sent: Option<SentUpdate>,
    /// Time at which it was sent \[s\].
    pub(crate) sent_at: f64,
    /// What the vehicle has said of it.
    pub received: VehicleAcknowledgement,
    /// Time since which the vehicle says, as the first thing about this order, that it has completed it \[s\].
    pub(crate) reported_complete_at: Option<f64>,
    /// Whether the nodes ahead differ from those that the vehicle knows.
    pub changed: bool,
    /// Its cancellation, once it is cancelled.
    pub cancel: Option<Cancellation>,
    /// Time since which the vehicle has lost the order \[s\].
    pub(crate) lost_at: Option<f64>,
    /// Time since which the vehicle refuses what was sent last \[s\].
    pub refused: Option<f64>,
    /// Where the speed is limited on the whole way.
    pub(crate) limits: Vec<SpeedLimit>,
    /// The revision of the closures, the manager's update and the length of the way of which these are.
    pub(crate) limits_at: Option<(u64, u64, u64)>,
}

/// The part of the manager's order that is stored as a note.
#[derive(Serialize, Deserialize)]
pub(super) struct StoredOrder {
    held: OrderState,
    start: StartPose,
    version: String,
    cancel: Option<String>,
}

/// Id of the mission that leads to a node, in the supervisor.
pub(super) fn mission(held: &OrderState, node: usize) -> String {
    format!("{}#{}", held.order_id, held.nodes.get(node).map_or(0, |node| node.sequence_id))
}

impl ActiveOrder {
    /// A new order for a vehicle that stands at the start of the way.
    pub(super) fn new(held: OrderState, way: OrderPath, version: String) -> Self {
        let first =
            ReleasePoint { sequence: 0, length: way.node(0).unwrap_or(0.0), node: 0, between: false, speed: None };
        Self {
            order: held,
            path: way,
            version,
            requested_node: 0,
            stops: vec![first],
            sent: None,
            sent_at: f64::NEG_INFINITY,
            received: VehicleAcknowledgement::default(),
            reported_complete_at: None,
            changed: true,
            cancel: None,
            lost_at: None,
            refused: None,
            limits: Vec::new(),
            limits_at: None,
        }
    }

    /// Restores an order from the notes of a robot; `None` for a robot that has no order.
    ///
    /// # Errors
    /// [`JournalError`] if a note cannot be read.
    pub(super) fn remembered(robot: Option<&SupervisedRobot>) -> Result<Option<Self>, JournalError> {
        let Some(given) = noted::<StoredOrder>(robot, "order")? else { return Ok(None) };
        let StoredOrder { held, start, version, cancel } = given;
        let spread = robot.map_or(0.0, |robot| robot.abilities.spread());
        let way = OrderPath::new(start, &held, spread)
            .map_err(|fault| JournalError(format!("the order {}: {fault}", held.order_id)))?;
        let cancel = cancel.map(Cancellation::remembered);
        let mut job = Self { cancel, ..Self::new(held, way, version) };
        if let Some(stops) = noted(robot, "stops")? {
            (job.stops, job.sent) = (stops, noted(robot, "sent")?);
        }
        job.received = noted(robot, RECEIVED)?.unwrap_or_default();
        if let Some(robot) = robot {
            job.requested_node = job.planned(robot).max(job.waiting(robot).unwrap_or(0));
            // Older journals do not say whether the vehicle has named it. It is on its way only if it has.
            let begins = job.path.node(0).unwrap_or(0.0) + BEGINS;
            job.received.named |= job.offset(robot).is_some_and(|offset| robot.arc_length + offset > begins);
        }
        Ok(Some(job))
    }

    /// The manager's order as a note.
    pub(super) fn given(&self) -> StoredOrder {
        let Self { order: held, path: way, version, cancel, .. } = self;
        StoredOrder {
            held: held.clone(),
            start: way.start(),
            version: version.clone(),
            cancel: cancel.as_ref().map(|cancel| cancel.action.clone()),
        }
    }

    /// Index of the node to which a mission leads.
    fn node_of_mission(&self, mission: &str) -> Option<usize> {
        let (order, sequence) = mission.rsplit_once('#')?;
        if order == self.order.order_id { self.order.place_of(sequence.parse().ok()?) } else { None }
    }

    /// Whether a mission is one of this order.
    pub(super) fn is_mission(&self, mission: &str) -> bool {
        self.node_of_mission(mission).is_some()
    }

    /// Index of the node at which the supervisor's path ends; 0 while nothing is admitted.
    pub(super) fn planned(&self, robot: &SupervisedRobot) -> usize {
        robot.mission.as_deref().and_then(|mission| self.node_of_mission(mission)).unwrap_or(0)
    }

    /// Whether the supervisor's path is a part of this way.
    pub(super) fn is_admitted(&self, robot: &SupervisedRobot) -> bool {
        robot.mission.as_deref().is_some_and(|mission| self.is_mission(mission))
    }

    /// Index of the node at which the mission ends that waits to be admitted.
    fn waiting(&self, robot: &SupervisedRobot) -> Option<usize> {
        robot.waiting.as_ref().and_then(|waiting| self.node_of_mission(&waiting.mission))
    }

    /// Offset from a length on the supervisor's path to a length on the order's way \[m\]; both end at the same node. It is computed from
    /// the supervisor's present path, because a mission can be admitted at any time. `None` if that path is no part of this way:
    /// somebody has given the vehicle another mission, and nothing is known of how far it is on that.
    pub(super) fn offset(&self, robot: &SupervisedRobot) -> Option<f64> {
        /// Differences of places that are rounding \[m\].
        const SAME: f64 = 1e-3;
        let length = robot.course.length();
        if self.is_admitted(robot) {
            return Some(self.path.node(self.planned(robot)).unwrap_or(0.0) - length);
        }
        // Before the admission the vehicle is at the end of its former path, which is the start of the way.
        let (end, start) = (robot.course.pose(length), self.path.start());
        let is_before = self.stops.len() == 1 && (end.x - start.x).hypot(end.y - start.y) <= SAME;
        is_before.then_some(-length)
    }

    /// The stop that a vehicle has passed last, as it says. Before its first node it may name any. What is neither that, nor a node of
    /// this order that it does not list as ahead any more, is none. Nor is any before the order is confirmed: the node may be that of the
    /// order before, with the same name and number.
    pub(super) fn passed(&self, state: &State) -> Option<usize> {
        let sequence = state.last_node_sequence_id;
        let place = self.stop(sequence)?;
        let is_so = place == 0
            || self.is_confirmed()
                && self.stops.get(place).is_some_and(|stop| self.id(*stop) == state.last_node_id)
                && state.node_states.iter().all(|node| node.sequence_id > sequence);
        is_so.then_some(place)
    }

    /// Whether the vehicle has received the order.
    pub(super) fn was_there(&self) -> bool {
        self.received.named || self.is_confirmed()
    }

    /// Whether the vehicle has confirmed the order, or an update of it. An update is only sent after the one before it was confirmed,
    /// perhaps while an earlier supervisor ran.
    pub(super) fn is_confirmed(&self) -> bool {
        self.received.acknowledged.is_some() || self.sent.is_some_and(|sent| sent.update > 0)
    }

    /// Whether the vehicle may still take what was sent last: it has not shown that it has it.
    pub(super) fn is_due(&self, state: &State) -> bool {
        let has = |sent: SentUpdate| state.order_id == self.order.order_id && state.order_update_id >= sent.update;
        !self.is_acknowledged() && !self.sent.is_some_and(has)
    }

    /// Whether the vehicle has dropped the order although it names it: it has nothing ahead, and has not reached the end of the last
    /// update that it has confirmed.
    pub(super) fn is_dropped(&self, state: &State) -> bool {
        let last = self.stops.len().saturating_sub(1);
        let end = if self.is_acknowledged() { last } else { self.sent.map_or(0, |sent| sent.from) };
        self.is_confirmed() && state.node_states.is_empty() && self.passed(state).is_none_or(|place| place < end)
    }

    /// The order is being cancelled by this action, sent now.
    pub(super) fn is_cancelled(&mut self, action: String, now: f64) {
        self.cancel = Some(Cancellation { action, first_at: now, last_at: now });
    }

    /// For a vehicle that has lost this order: the new order `held` from where the vehicle is now, if it follows the rest of the admitted
    /// way, and the index of the node up to which it does. `None` if the new order leads elsewhere.
    pub(super) fn rejoined(
        &self,
        robot: &SupervisedRobot,
        mut held: OrderState,
        length: f64,
        version: String,
    ) -> Option<(Self, usize)> {
        // An outline may turn where the new order begins, over other lengths than before.
        if self.path.spread() > 0.0 {
            return None;
        }
        /// Largest distance of equal nodes \[m\].
        const SAME: f64 = 1e-6;
        let place = |node: &OrderNode| node.node_position.as_ref().map(|at| [at.x, at.y]);
        let end = self.planned(robot);
        let next = (0..=end).find(|&node| self.path.node(node).is_some_and(|it| it > length + SAME))?;
        let rest = &self.order.nodes[next..=end];
        let is_straight = |edges: &[OrderEdge]| edges.iter().all(|edge| edge.trajectory.is_none());
        let same = |(a, b): (&OrderNode, &OrderNode)| {
            place(a).zip(place(b)).is_some_and(|(a, b)| (a[0] - b[0]).hypot(a[1] - b[1]) <= SAME)
        };
        // The new order begins at the next node of the way, or with a node before it that lies on the way; the reported
        // position may be beside the way.
        let skip = usize::from(!same((held.nodes.first()?, rest.first()?)));
        let joins = rest.len() - 1 + skip;
        let follows = self.is_admitted(robot)
            && held.base >= joins
            && held.nodes.get(skip..=joins)?.iter().zip(rest).all(same)
            && is_straight(held.edges.get(..joins)?)
            && is_straight(self.order.edges.get(next.checked_sub(1)?..end)?);
        let start = self.path.pose(length);
        if skip == 1 {
            let first = held.nodes.first_mut()?.node_position.as_mut()?;
            (first.x, first.y) = (start.x, start.y);
        }
        let way = OrderPath::new(start, &held, 0.0)
            .ok()
            .filter(|way| follows && way.node(0).is_some_and(|begins| begins <= BEGINS))?;
        Some((Self::new(held, way, version), joins))
    }

    /// The order from a node on that the vehicle has passed long ago; `None` if that is not worth it.
    pub(super) fn trimmed(&self, state: &State) -> Option<Self> {
        let sent = self.sent.filter(|_| self.is_confirmed() && state.order_id == self.order.order_id)?;
        let first = self.passed(state)?.checked_sub(KEPT)?.min(sent.from);
        let first = (0..=first).rev().find(|&place| self.stops.get(place).is_some_and(|stop| !stop.between))?;
        let node = self.stops.get(first)?.node.min(self.order.base);
        if node < KEPT {
            return None;
        }
        let (from, start) = (self.path.node(node)?, self.path.arrival(node)?);
        let mut job = self.clone();
        job.order.forget(node);
        job.path = OrderPath::new(start, &job.order, self.path.spread()).ok()?;
        job.requested_node = job.requested_node.checked_sub(node)?;
        job.sent = Some(SentUpdate { from: sent.from.checked_sub(first)?, ..sent });
        let moved = |stop: &ReleasePoint| {
            Some(ReleasePoint { length: stop.length - from, node: stop.node.checked_sub(node)?, ..*stop })
        };
        job.stops = self.stops.iter().skip(first).map(moved).collect::<Option<_>>()?;
        // The vehicle knows stops by their names, which contain lengths: by rounding another one may have come out.
        let names = |job: &Self| job.stops.iter().rev().map(|stop| job.id(*stop)).collect::<Vec<_>>();
        let (own, before) = (names(&job), names(self));
        before.starts_with(&own).then_some(job)
    }

    /// The last stop that the vehicle has, or may have.
    pub(super) fn last(&self) -> ReleasePoint {
        let none = ReleasePoint { sequence: 0, length: 0.0, node: 0, between: false, speed: None };
        self.stops.last().copied().unwrap_or(none)
    }

    /// Index of the stop with this sequence number.
    pub(super) fn stop(&self, sequence: u64) -> Option<usize> {
        self.stops.binary_search_by_key(&sequence, |stop| stop.sequence).ok()
    }

    /// Whether the vehicle has the last update that was sent.
    pub(super) fn is_acknowledged(&self) -> bool {
        match (self.sent, self.received.acknowledged) {
            (None, _) => true,
            (Some(sent), Some((update, _))) => update >= sent.update,
            _ => false,
        }
    }

    /// The node of a stop, as it is sent to the vehicle.
    pub(super) fn node(&self, stop: ReleasePoint, deviation: f64, released: bool) -> Option<OrderNode> {
        let near = self.order.nodes.get(stop.node)?;
        let mut node = if stop.between { self.between(near, stop) } else { near.clone() };
        (node.sequence_id, node.released) = (stop.sequence, released);
        if let Some(position) = &mut node.node_position {
            limit(position, deviation, &self.version);
        }
        Some(node)
    }

    /// A node in the middle of the edge after another one.
    fn between(&self, near: &OrderNode, stop: ReleasePoint) -> OrderNode {
        let there = self.path.pose(stop.length);
        let map_id = near.node_position.as_ref().map_or_else(String::new, |position| position.map_id.clone());
        let position = NodePosition { x: there.x, y: there.y, map_id, rest: Map::new() };
        let node_id = self.id(stop);
        OrderNode {
            node_id,
            sequence_id: 0,
            released: false,
            node_position: Some(position),
            actions: Vec::new(),
            extra: Map::new(),
        }
    }

    /// The node id of a stop.
    pub(super) fn id(&self, stop: ReleasePoint) -> String {
        let node = self.order.nodes.get(stop.node).map_or("", |node| node.node_id.as_str());
        if stop.between {
            format!("{node}+{:.3}", stop.length - self.path.departure(stop.node).unwrap_or(0.0))
        } else {
            node.into()
        }
    }

    /// The edge, or part of an edge, between two stops, as it is sent to the vehicle. Released parts have the limit of the speed with which they were
    /// released.
    pub(super) fn edge(&self, [from, to]: [ReleasePoint; 2], released: bool) -> Option<OrderEdge> {
        let mut edge = self.order.edges.get(from.node)?.clone();
        (edge.sequence_id, edge.released) = (from.sequence + 1, released);
        for (id, stop) in [(&mut edge.start_node_id, from), (&mut edge.end_node_id, to)] {
            if id.is_some() {
                *id = Some(self.id(stop));
            }
        }
        edge.remove_corridor();
        if from.between || to.between {
            edge.rest.remove("length");
        }
        let limit = if released { to.speed } else { self.limit_between(from.length, to.length) };
        lower_speed(&mut edge, limit, &self.version);
        Some(edge)
    }

    /// Whether vehicles can stop in the middle of an edge.
    pub(super) fn can_split(&self, edge: usize) -> bool {
        self.order.edges.get(edge).is_some_and(|edge| edge.trajectory.is_none() && edge.actions.is_empty())
    }
}

/// Limits the allowed deviation at a node to what the margin covers.
fn limit(position: &mut NodePosition, deviation: f64, version: &str) {
    let allowed = position.deviation().ok().flatten().unwrap_or(deviation).min(deviation);
    let (name, value) = match ProtocolVersion::parse(version) {
        Some(ProtocolVersion::V2_0) => ("allowedDeviationXy", Value::from(allowed)),
        Some(ProtocolVersion::V3_0) => {
            ("allowedDeviationXY", serde_json::json!({ "a": allowed, "b": allowed, "theta": 0.0 }))
        }
        _ => ("allowedDeviationXY", Value::from(allowed)),
    };
    for old in pcr_formats::vda5050::order::DEVIATIONS {
        position.rest.remove(old);
    }
    position.rest.insert(name.into(), value);
}

/// Lowers the speed of an edge \[m/s\], for a vehicle of this edition.
fn lower_speed(edge: &mut OrderEdge, speed: Option<f64>, version: &str) {
    if let Some(speed) = speed.filter(|speed| edge.max_speed().is_none_or(|own| *speed < own)) {
        edge.set_max_speed(speed, ProtocolVersion::parse(version));
    }
}
