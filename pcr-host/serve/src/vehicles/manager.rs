//! A fleet manager that gives every vehicle one mission after the other. No two vehicles have the same goal, and ways
//! keep clear of all other goals, so a vehicle at a goal is in no one's way, and every mission can be finished whatever
//! the others do. A vehicle that has lost its order, or whose order is refused, gets another one, for the rest of the way from where it
//! stands.

mod reorder;

use super::edge_reservations::{EdgeReservations, MissionEdge, VehicleCoordination, to_line};
use crate::owned_path::{OwnedPath, PathElement, StartPose};
use crate::page_layout::{PageLane, PageLayout, PageNode};
use crate::setup_error::SetupError;
use pcr_formats::import::{self, ElementId, Layout, RouteStep, cheapest};
use pcr_formats::splitmix64::SplitMix64;
use pcr_formats::vda5050::decode::{self, MessageLimits};
use pcr_formats::vda5050::header::MessageHeader;
use pcr_formats::vda5050::order::{NodePosition, Order, OrderEdge, OrderNode};
use pcr_formats::vda5050::state::{State, VehiclePosition};
use pcr_formats::vda5050::timestamp;
use pcr_formats::vda5050::topics::VehicleId;
use pcr_formats::vda5050::version::ProtocolVersion;
use serde_json::Map;
use std::collections::BTreeMap;

/// A vehicle, as the manager knows it.
#[derive(Clone, Debug)]
struct ManagedVehicle {
    /// Index of the vehicle.
    place: usize,
    version: ProtocolVersion,
    /// The node where its last order ends.
    at: usize,
    /// Its present order, or the one that it is to take.
    order: Option<IssuedOrder>,
    /// Orders of the same mission that were refused. A late copy of one may be taken.
    refused: Vec<Order>,
    orders: u64,
    done: u64,
    header: u64,
}

/// An order.
#[derive(Clone, Debug)]
struct IssuedOrder {
    order: Order,
    /// Whether the vehicle has confirmed it.
    had: bool,
    /// Number of successive states without the order, or in which it is refused, and the time of the first one \[s\].
    lost: Option<(u32, f64)>,
    /// The last update that was sent: its first node, its last released node, and its time \[s\].
    from: usize,
    released: usize,
    sent: f64,
}

/// A message for a vehicle.
#[derive(Clone, Debug)]
pub struct OutgoingMessage {
    /// The vehicle.
    pub key: VehicleId,
    /// Edition of the standard.
    pub version: ProtocolVersion,
    /// Content, as JSON.
    pub payload: Vec<u8>,
}

/// A fleet manager.
#[derive(Debug)]
pub struct FleetManager {
    layout: Layout,
    map_id: String,
    goals: Vec<usize>,
    /// Distance that ways keep from the goals of others \[m\].
    clearance: f64,
    clients: BTreeMap<VehicleId, ManagedVehicle>,
    random: SplitMix64,
    /// Number of the run, part of the order ids.
    run: u64,
    /// The locks, if there is no supervisor.
    locks: Option<EdgeReservations>,
    /// Whether no more missions are given.
    ends: bool,
    again: u64,
}

/// Time after which an order that was not taken is sent again \[s\].
const AGAIN: f64 = 2.0;

/// Number of successive states without its order, or in which it is refused, and time \[s\], after which the vehicle gets another one.
const LOST: (u32, f64) = (3, 3.0);

/// A vehicle within this distance of a node begins there \[m\].
const NEAR: f64 = 0.3;

/// With locks: how far ahead of the node that it has reached last a vehicle gets edges \[m\].
const FAR: f64 = 4.0;

impl FleetManager {
    /// The manager of vehicles that stand at nodes of a layout, with missions to some of its nodes.
    ///
    /// # Errors
    /// A goal that is no node, or without a way to another goal that keeps this distance from the rest \[m\].
    pub fn new(
        layout: Layout,
        map_id: &str,
        goals: Vec<usize>,
        clearance: f64,
        vehicles: Vec<(VehicleId, ProtocolVersion, usize)>,
        seed: u64,
    ) -> Result<Self, SetupError> {
        if let Some(goal) = goals.iter().find(|&&goal| goal >= layout.nodes.len()) {
            return Err(SetupError::NoNode(*goal));
        }
        let clients = vehicles.into_iter().enumerate().map(|(place, (key, version, at))| {
            (
                key,
                ManagedVehicle { place, version, at, order: None, refused: Vec::new(), orders: 0, done: 0, header: 0 },
            )
        });
        let mut random = SplitMix64(seed);
        let run = random.bits() & 0xffff_ffff;
        let clients = clients.collect();
        let (map_id, locks) = (map_id.into(), None);
        let own = Self { layout, map_id, goals, clearance, clients, random, run, locks, ends: false, again: 0 };
        for (&from, &to) in own.goals.iter().zip(own.goals.iter().cycle().skip(1)) {
            if own.way([from, to]).is_none() {
                let ends = [from, to].map(|node| own.layout.nodes[node].id.clone());
                return Err(SetupError::NoRoute { ends, clearance });
            }
        }
        Ok(own)
    }

    /// Chooses the method that keeps vehicles apart. To be called before any order is sent.
    pub(crate) fn with_coordination(mut self, method: VehicleCoordination) -> Self {
        let mut places: Vec<(usize, usize)> = self.clients.values().map(|client| (client.place, client.at)).collect();
        places.sort_unstable();
        let standing: Vec<usize> = places.into_iter().map(|(_, at)| at).collect();
        let locks = |is_whole| EdgeReservations::new(&self.layout, self.clearance, FAR, is_whole, &standing);
        self.locks = match method {
            VehicleCoordination::Supervisor => None,
            VehicleCoordination::RouteLocks => Some(locks(true)),
            VehicleCoordination::EdgeLocks => Some(locks(false)),
        };
        self
    }

    /// The ways that it sends vehicles on, and the nodes.
    pub fn drawn(&self, name: String) -> PageLayout {
        let zones = |is_in: &dyn Fn(&import::LayoutZone) -> bool| -> Vec<ElementId> {
            let found = self.layout.zones.iter().filter(|zone| is_in(zone));
            found.map(|zone| ElementId::Text(zone.id.clone())).collect()
        };
        let lane = |(place, edge): (usize, &import::LayoutEdge)| {
            let [[x, y], to] = edge.ends.map(|node| self.layout.position(node));
            let [dx, dy] = [to[0] - x, to[1] - y];
            let start = StartPose { x, y, heading: dy.atan2(dx) };
            let course = OwnedPath::new(start, vec![PathElement::Line { length: dx.hypot(dy) }]).ok()?;
            Some(PageLane { course, edge: Some(edge.id.clone()), zones: zones(&|zone| zone.edges.contains(&place)) })
        };
        let node = |(place, node): (usize, &import::LayoutNode)| {
            let [x, y] = node.point;
            PageNode { node: node.id.clone(), x, y, zones: zones(&|zone| zone.nodes.contains(&place)) }
        };
        PageLayout {
            name,
            lanes: self.layout.edges.iter().enumerate().filter_map(lane).collect(),
            nodes: self.layout.nodes.iter().enumerate().map(node).collect(),
        }
    }

    /// Number of goals at which no vehicle stands and to which none drives.
    pub fn free(&self) -> usize {
        self.goals.len().saturating_sub(self.clients.len())
    }

    /// Number of missions done by all vehicles.
    pub fn done(&self) -> u64 {
        self.clients.values().map(|client| client.done).sum()
    }

    /// Number of missions done by each vehicle.
    pub fn done_by(&self) -> BTreeMap<String, u64> {
        self.clients.iter().map(|(key, client)| (key.to_string(), client.done)).collect()
    }

    /// Number of orders that were planned again because vehicles had lost them.
    pub fn planned_anew(&self) -> u64 {
        self.again
    }

    /// Gives no more missions; those under way go on.
    pub fn end(&mut self) {
        self.ends = true;
    }

    /// The vehicles with an order that is not done.
    pub fn busy(&self) -> impl Iterator<Item = &VehicleId> {
        self.clients.iter().filter(|(_, client)| client.order.is_some()).map(|(key, _)| key)
    }

    /// For each vehicle its order, and the node where the order ends.
    pub fn orders(&self) -> impl Iterator<Item = (&VehicleId, Option<&str>, usize)> {
        self.clients
            .iter()
            .map(|(key, client)| (key, client.order.as_ref().map(|given| given.order.order_id.as_str()), client.at))
    }

    /// Takes a state; returns the messages to be sent to vehicles.
    pub fn receive(&mut self, key: &VehicleId, payload: &[u8], now: f64) -> Vec<OutgoingMessage> {
        let Ok(state) = decode::read::<State>(payload, MessageLimits::default()) else { return Vec::new() };
        let Some(client) = self.clients.get_mut(key) else { return Vec::new() };
        let mut due = Vec::new();
        client.takes_back(&state, now);
        match &mut client.order {
            Some(given) if state.order_id == given.order.order_id => {
                (given.had, given.lost) = (true, None);
                let Some(last) = given.order.nodes.last() else { return Vec::new() };
                if state.last_node_sequence_id == last.sequence_id && state.is_idle() {
                    let edges = given.order.edges.len();
                    let place = client.place;
                    (client.order, client.done) = (None, client.done + 1);
                    client.refused.clear();
                    self.locks.iter_mut().for_each(|locks| locks.passed(place, edges, now));
                    due.extend(self.order(key, now));
                } else if let Some(locks) = &mut self.locks {
                    locks.passed(client.place, state.last_node_sequence_id as usize / 2, now);
                    if state.order_update_id < given.order.order_update_id && now - given.sent >= AGAIN {
                        due.extend(client.send(key, now));
                    }
                }
            }
            Some(given) if given.had || given.is_refused(&state) => {
                let (count, since) = given.lost.unwrap_or((0, now));
                given.lost = Some((count + 1, since));
                let is_due = !given.had && now - given.sent >= AGAIN;
                let is_lost = count + 1 >= LOST.0 && now - since >= LOST.1 && state.is_idle() && self.locks.is_none();
                let anew = if is_lost { self.plan_anew(key, &state, now) } else { None };
                if anew.is_none() && is_due {
                    due.extend(self.clients.get_mut(key).and_then(|client| client.send(key, now)));
                }
                due.extend(anew);
            }
            // With locks, an order is first sent when it has got some edges.
            Some(given) => {
                given.lost = None;
                if given.sent > f64::NEG_INFINITY && now - given.sent >= AGAIN {
                    due.extend(client.send(key, now));
                }
            }
            None => due.extend(self.order(key, now)),
        }
        due.extend(self.give(key, &state, now));
        due
    }

    /// With locks: releases more edges to all vehicles that can get some.
    fn give(&mut self, from: &VehicleId, state: &State, now: f64) -> Vec<OutgoingMessage> {
        let Some(locks) = &mut self.locks else { return Vec::new() };
        locks.give();
        let mut due = Vec::new();
        for (key, client) in &mut self.clients {
            let Some(given) = &mut client.order else { continue };
            let node = locks.given(client.place);
            let is_first = given.sent == f64::NEG_INFINITY;
            // One update at a time; the vehicle's own state confirms the one before.
            let has_it = key == from
                && state.order_id == given.order.order_id
                && state.order_update_id == given.order.order_update_id;
            if node > given.released && (is_first || has_it) {
                given.order.order_update_id += u64::from(!is_first);
                (given.from, given.released) = (given.released, node);
                due.extend(client.send(key, now));
            }
        }
        due
    }

    /// The next mission of a vehicle.
    fn order(&mut self, key: &VehicleId, now: f64) -> Option<OutgoingMessage> {
        if self.ends {
            return None;
        }
        let taken: Vec<usize> = self.clients.values().map(|client| client.at).collect();
        let free: Vec<usize> = self.goals.iter().copied().filter(|goal| !taken.contains(goal)).collect();
        let goal = *free.get(self.random.below(free.len()))?;
        let client = self.clients.get(key)?;
        let (place, steps) = (client.place, self.way([client.at, goal])?);
        let legs = steps.iter().map(|step| {
            let edge = self.layout.edges.iter().position(|edge| std::ptr::eq(edge, step.edge));
            MissionEdge { edge: edge.unwrap_or_default(), length: step.edge.length(), to: step.target() }
        });
        let legs: Vec<MissionEdge> = legs.collect();
        let mut places = vec![client.at];
        places.extend(steps.iter().map(|step| step.target()));
        let nodes: Option<Vec<OrderNode>> = places.iter().enumerate().map(|(k, &place)| self.node(k, place)).collect();
        let names = steps.iter().map(|step| step.edge.id.to_string());
        let edges = names.enumerate().map(|(k, id)| self.edge(k, &id, [places[k], places[k + 1]])).collect();
        let nodes = nodes?;
        if let Some(locks) = &mut self.locks {
            locks.want(place, legs, now);
        }
        self.clients.get_mut(key)?.at = goal;
        self.begin(key, nodes, edges, now)
    }

    /// Begins an order over these nodes; without locks all of it is released at once.
    fn begin(
        &mut self,
        key: &VehicleId,
        nodes: Vec<OrderNode>,
        edges: Vec<OrderEdge>,
        now: f64,
    ) -> Option<OutgoingMessage> {
        let client = self.clients.get_mut(key)?;
        let order_id = format!("{:08x}-{}-{}", self.run, key.serial_number, client.orders);
        client.orders += 1;
        let released = if self.locks.is_some() { 0 } else { edges.len() };
        let order =
            Order { header: MessageHeader::default(), order_id, order_update_id: 0, nodes, edges, rest: Map::new() };
        let sent = f64::NEG_INFINITY;
        client.order = Some(IssuedOrder { order, had: false, lost: None, from: 0, released, sent });
        if self.locks.is_some() { None } else { client.send(key, now) }
    }

    /// The shortest way that keeps clear of all other goals.
    fn way(&self, ends: [usize; 2]) -> Option<Vec<RouteStep<'_>>> {
        let place = |node: usize| self.layout.position(node);
        let others = self.goals.iter().filter(|goal| !ends.contains(goal));
        let others: Vec<[f64; 2]> = others.map(|&goal| place(goal)).collect();
        let cost = |step: RouteStep<'_>| {
            let (from, to) = (place(step.origin()), place(step.target()));
            let is_clear = others.iter().all(|&goal| to_line(goal, from, to) >= self.clearance);
            if is_clear { step.edge.length() } else { f64::INFINITY }
        };
        cheapest(&self.layout, ends, cost)
    }

    fn position(&self, pose: &VehiclePosition) -> NodePosition {
        NodePosition { x: pose.x, y: pose.y, map_id: self.map_id.clone(), rest: Map::new() }
    }

    fn node(&self, k: usize, place: usize) -> Option<OrderNode> {
        let node = self.layout.nodes.get(place)?;
        let [x, y] = node.point;
        let position = NodePosition { x, y, map_id: self.map_id.clone(), rest: Map::new() };
        let (node_id, sequence_id) = (node.id.to_string(), 2 * k as u64);
        let (actions, rest) = (Vec::new(), Map::new());
        Some(OrderNode { node_id, sequence_id, released: true, node_position: Some(position), actions, extra: rest })
    }

    fn edge(&self, k: usize, id: &str, ends: [usize; 2]) -> OrderEdge {
        let name = |place: usize| self.layout.nodes.get(place).map(|node| node.id.to_string());
        OrderEdge {
            edge_id: id.into(),
            sequence_id: 2 * k as u64 + 1,
            released: true,
            start_node_id: name(ends[0]),
            end_node_id: name(ends[1]),
            actions: Vec::new(),
            trajectory: None,
            rest: Map::new(),
        }
    }
}

impl ManagedVehicle {
    /// Sends the present update of its order.
    fn send(&mut self, key: &VehicleId, now: f64) -> Option<OutgoingMessage> {
        let version = self.version;
        self.header += 1;
        let given = self.order.as_mut()?;
        given.sent = now;
        let Order { order_id, order_update_id, nodes, edges, .. } = &given.order;
        let mut order = Order {
            header: MessageHeader::new(key, version, self.header, timestamp::now()),
            order_id: order_id.clone(),
            order_update_id: *order_update_id,
            nodes: nodes.iter().skip(given.from).cloned().collect(),
            edges: edges.iter().skip(given.from).cloned().collect(),
            rest: Map::new(),
        };
        for (k, node) in order.nodes.iter_mut().enumerate() {
            node.released = given.from + k <= given.released;
        }
        for (k, edge) in order.edges.iter_mut().enumerate() {
            edge.released = given.from + k < given.released;
            if version == ProtocolVersion::V3_0 {
                (edge.start_node_id, edge.end_node_id) = (None, None);
            }
        }
        Some(OutgoingMessage { key: key.clone(), version, payload: serde_json::to_vec(&order).ok()? })
    }
}
