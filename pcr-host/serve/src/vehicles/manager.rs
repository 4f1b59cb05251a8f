//! A fleet manager that gives every vehicle one mission after the other, to goals that nobody else is at or goes to, on ways that
//! keep clear of all other goals: whoever stands at one is in nobody's way, so that every mission can be done whatever the others do.

use super::random::Random;
use crate::vda5050::door::{self, Limits};
use crate::vda5050::header::Header;
use crate::vda5050::order::{Edge, Node, NodePosition, Order};
use crate::vda5050::stamp;
use crate::vda5050::state::State;
use crate::vda5050::topics::Key;
use crate::vda5050::version::Version;
use pcr_formats::import::{Layout, Step, cheapest};
use serde_json::Map;
use std::collections::BTreeMap;

/// What it knows of a vehicle.
#[derive(Clone, Debug)]
struct Client {
    version: Version,
    /// The node where its last order ends.
    at: usize,
    /// Of the last order, and how often it was sent.
    order: Option<(String, Order)>,
    orders: u64,
    done: u64,
    header: u64,
    sent: f64,
}

/// A fleet manager.
#[derive(Debug)]
pub struct Manager {
    layout: Layout,
    map_id: String,
    goals: Vec<usize>,
    /// Ways keep so far from goals that are not theirs \[m\].
    clearance: f64,
    clients: BTreeMap<Key, Client>,
    random: Random,
    /// Tells its orders from those of another run.
    run: u64,
}

/// An order that was not taken is sent again after so long \[s\].
const AGAIN: f64 = 2.0;

impl Manager {
    /// Of vehicles that stand at nodes of a layout, for missions to some of its nodes.
    ///
    /// # Errors
    /// A goal from which there is no way to another one that keeps so far from the rest \[m\].
    pub fn new(
        layout: Layout,
        map_id: &str,
        goals: Vec<usize>,
        clearance: f64,
        vehicles: Vec<(Key, Version, usize)>,
        seed: u64,
    ) -> Result<Self, String> {
        let clients = vehicles.into_iter().map(|(key, version, at)| {
            let sent = f64::NEG_INFINITY;
            (key, Client { version, at, order: None, orders: 0, done: 0, header: 0, sent })
        });
        let mut random = Random::new(seed);
        let run = random.bits() & 0xffff_ffff;
        let clients = clients.collect();
        let own = Self { layout, map_id: map_id.into(), goals, clearance, clients, random, run };
        for (&from, &to) in own.goals.iter().zip(own.goals.iter().cycle().skip(1)) {
            if own.way([from, to]).is_none() {
                let [from, to] = [from, to].map(|node| own.layout.nodes.get(node).map(|node| node.id.to_string()));
                let (from, to) = (from.unwrap_or_default(), to.unwrap_or_default());
                return Err(format!("no way from {from} to {to} keeps {clearance:.3} m from all other goals"));
            }
        }
        Ok(own)
    }

    /// Missions done by all vehicles.
    pub fn done(&self) -> u64 {
        self.clients.values().map(|client| client.done).sum()
    }

    /// Missions done by each vehicle.
    pub fn done_by(&self) -> BTreeMap<String, u64> {
        self.clients.iter().map(|(key, client)| (key.to_string(), client.done)).collect()
    }

    /// The order that each vehicle has or is to take, and the node where it ends.
    pub fn orders(&self) -> impl Iterator<Item = (&Key, Option<&str>, usize)> {
        self.clients.iter().map(|(key, client)| (key, client.order.as_ref().map(|(id, _)| id.as_str()), client.at))
    }

    /// Takes a state; returns an order that the vehicle is to get now.
    pub fn receive(&mut self, key: &Key, payload: &[u8], now: f64) -> Option<(Version, Vec<u8>)> {
        let state: State = door::read(payload, Limits::default()).ok()?;
        let client = self.clients.get_mut(key)?;
        match &client.order {
            Some((id, order)) if state.order_id == *id => {
                let last = order.nodes.last()?;
                if state.last_node_sequence_id != last.sequence_id || !state.is_idle() {
                    return None;
                }
                client.order = None;
                client.done += 1;
                self.order(key, now)
            }
            Some(_) if now - client.sent >= AGAIN => self.send(key, now),
            Some(_) => None,
            None if now - client.sent >= AGAIN => self.order(key, now),
            None => None,
        }
    }

    /// The next mission of a vehicle.
    fn order(&mut self, key: &Key, now: f64) -> Option<(Version, Vec<u8>)> {
        let taken: Vec<usize> = self.clients.values().map(|client| client.at).collect();
        let free: Vec<usize> = self.goals.iter().copied().filter(|goal| !taken.contains(goal)).collect();
        let goal = *free.get(self.random.below(free.len()))?;
        let client = self.clients.get(key)?;
        let steps = self.way([client.at, goal])?;
        let mut places = vec![client.at];
        places.extend(steps.iter().map(|step| step.target()));
        let nodes: Option<Vec<Node>> = places.iter().enumerate().map(|(k, &place)| self.node(k, place)).collect();
        let edges = steps
            .iter()
            .enumerate()
            .map(|(k, step)| self.edge(k, &step.edge.id.to_string(), [places[k], places[k + 1]]));
        let edges = edges.collect();
        let order_id = format!("{:08x}-{}-{}", self.run, key.serial_number, client.orders);
        let order = Order {
            header: Header::default(),
            order_id: order_id.clone(),
            order_update_id: 0,
            nodes: nodes?,
            edges,
            rest: Map::new(),
        };
        let client = self.clients.get_mut(key)?;
        client.orders += 1;
        (client.at, client.order) = (goal, Some((order_id, order)));
        self.send(key, now)
    }

    /// The shortest way that keeps clear of all other goals.
    fn way(&self, ends: [usize; 2]) -> Option<Vec<Step<'_>>> {
        let place = |node: usize| self.layout.nodes.get(node).map(|node| node.at);
        let others = self.goals.iter().filter(|goal| !ends.contains(goal));
        let others: Vec<[f64; 2]> = others.filter_map(|&goal| place(goal)).collect();
        let cost = |step: Step<'_>| {
            let Some((from, to)) = place(step.origin()).zip(place(step.target())) else { return f64::INFINITY };
            let is_clear = others.iter().all(|&goal| distance(goal, from, to) >= self.clearance);
            if is_clear { step.edge.length() } else { f64::INFINITY }
        };
        cheapest(&self.layout, ends, cost)
    }

    fn send(&mut self, key: &Key, now: f64) -> Option<(Version, Vec<u8>)> {
        let client = self.clients.get_mut(key)?;
        client.header += 1;
        client.sent = now;
        let (_, order) = client.order.as_mut()?;
        order.header = Header::new(key, client.version, client.header, stamp::now());
        if client.version == Version::V3_0 {
            for edge in &mut order.edges {
                (edge.start_node_id, edge.end_node_id) = (None, None);
            }
        }
        Some((client.version, serde_json::to_vec(order).ok()?))
    }

    fn node(&self, k: usize, place: usize) -> Option<Node> {
        let node = self.layout.nodes.get(place)?;
        let [x, y] = node.at;
        let position = NodePosition { x, y, map_id: self.map_id.clone(), rest: Map::new() };
        let (node_id, sequence_id) = (node.id.to_string(), 2 * k as u64);
        let (actions, rest) = (Vec::new(), Map::new());
        Some(Node { node_id, sequence_id, released: true, node_position: Some(position), actions, rest })
    }

    fn edge(&self, k: usize, id: &str, ends: [usize; 2]) -> Edge {
        let name = |place: usize| self.layout.nodes.get(place).map(|node| node.id.to_string());
        Edge {
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

/// From a point to the line between two others.
fn distance(point: [f64; 2], from: [f64; 2], to: [f64; 2]) -> f64 {
    let [x, y] = [point[0] - from[0], point[1] - from[1]];
    let [dx, dy] = [to[0] - from[0], to[1] - from[1]];
    let square = dx * dx + dy * dy;
    let part = if square > 0.0 { ((x * dx + y * dy) / square).clamp(0.0, 1.0) } else { 0.0 };
    (x - part * dx).hypot(y - part * dy)
}
