//! Orders of managers that release piece by piece. A base that goes on may end where the vehicle must not stand, because others could not pass
//! it there. It is used up to the last node where the vehicle may stand, and the manager is told why, and which node to release next.

use super::VehicleAdapter;
use super::job::{ActiveOrder, mission};
use crate::robot::{MissionEnd, SupervisedRobot};
use crate::supervisor::Supervisor;
use pcr_formats::vda5050::state::{ErrorEntry, ORDER, State};
use serde_json::{Value, json};

/// Most nodes of the base at which the vehicle may wait for the rest, the last ones, and most nodes of the horizon that are tried.
const NODES: usize = 16;

/// Time after which the nodes of the horizon are tried again \[s\].
const AGAIN: f64 = 5.0;

/// Why an order waits, and what the manager can do.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct OrderWait {
    /// The robot because of which it waits.
    by: Option<String>,
    why: String,
    /// Index of the node up to which the vehicle may go, and of the last one of the base.
    nodes: [usize; 2],
    /// Id and sequence number of the node of the horizon up to which the vehicle could go on if it was released.
    next: Option<(String, u64)>,
    /// Whether there is a horizon.
    goes_on: bool,
    /// Time at which the horizon was tried \[s\].
    tried_at: f64,
}

impl OrderWait {
    /// Whether another end of the base would help: somebody is in the way, and it is not that the fleet is paused, or an area closed.
    fn is_of_base_end(&self) -> bool {
        self.goes_on && self.by.is_some()
    }
}

impl ActiveOrder {
    /// Whether it goes on beyond its base.
    fn goes_on(&self) -> bool {
        self.order.nodes.len() > self.order.base + 1
    }

    /// Where a mission from a node, or from where the vehicle stands, to the end of the base may end for now. An order without a horizon is for
    /// its end, and its vehicle waits where it is.
    pub(super) fn mission_ends(&self, from: Option<usize>) -> Vec<MissionEnd> {
        if !self.goes_on() {
            return Vec::new();
        }
        let first = from.map_or(0, |from| from + 1).max(self.order.base.saturating_sub(NODES));
        let end = |node| MissionEnd { mission: mission(&self.order, node), shapes: self.path.shapes(from, node).len() };
        (first..self.order.base).map(end).collect()
    }

    /// The first node of the horizon up to which it would be admitted as things are, from where its admitted path ends.
    fn next_end(&self, supervisor: &mut Supervisor, name: &str, now: f64) -> Option<(String, u64)> {
        let robot = supervisor.robot(name).ok()?;
        let from = self.is_admitted(robot).then(|| self.planned(robot));
        let any_heading = self.path.unknown_heading(from).is_some();
        let horizon = self.order.base + 1..self.order.nodes.len().min(self.order.base + 1 + NODES);
        let paths = horizon.clone().map(|node| self.path.shapes(from, node));
        let found = supervisor.first_admissible(name, paths, any_heading, now)?;
        let node = self.order.nodes.get(horizon.start + found)?;
        Some((node.node_id.clone(), node.sequence_id))
    }
}

impl VehicleAdapter {
    /// Finds out why the order waits, if it does, and tells the manager when that is news.
    pub(crate) fn follow_wait(&mut self, supervisor: &mut Supervisor, now: f64) {
        let wait = self.why_it_waits(supervisor, now);
        let is_news = match (&wait, &self.wait) {
            (Some(new), Some(old)) => OrderWait { tried_at: old.tried_at, ..new.clone() } != *old,
            (new, old) => new.is_some() != old.is_some(),
        };
        self.wait = wait;
        if is_news {
            self.mirror();
        }
    }

    fn why_it_waits(&self, supervisor: &mut Supervisor, now: f64) -> Option<OrderWait> {
        let job = self.job.as_ref().filter(|job| job.cancel.is_none() && job.lost_at.is_none())?;
        let robot = supervisor.robot(&self.name).ok()?;
        let waits_for_it =
            |robot: &SupervisedRobot| robot.waiting.as_ref().is_some_and(|own| job.is_mission(&own.mission));
        let (by, why) = supervisor.why_waiting(robot).filter(|_| waits_for_it(robot))?;
        let wait = OrderWait {
            by: by.map(str::to_owned),
            why: why.to_owned(),
            nodes: [job.planned(robot), job.order.base],
            next: None,
            goes_on: job.goes_on(),
            tried_at: now,
        };
        let is_same = |old: &&OrderWait| {
            now - old.tried_at < AGAIN && (old.nodes, &old.by, old.goes_on) == (wait.nodes, &wait.by, wait.goes_on)
        };
        if let Some(old) = self.wait.as_ref().filter(is_same) {
            return Some(OrderWait { next: old.next.clone(), tried_at: old.tried_at, ..wait });
        }
        let next = if wait.is_of_base_end() && robot.alarm.is_none() {
            job.next_end(supervisor, &self.name, now)
        } else {
            None
        };
        Some(OrderWait { next, ..wait })
    }

    /// Tells the manager in a state why the order waits. Where another base would help this is an error with a hint, otherwise an information.
    pub(super) fn tell_wait(&self, state: &mut State) {
        let (Some(wait), Some(job)) = (&self.wait, &self.job) else { return };
        let name = |node: usize| job.order.nodes.get(node).map_or("", |node| node.node_id.as_str());
        let order = &job.order.order_id;
        let [here, base] = wait.nodes.map(name);
        let mut references = vec![(ORDER, order.as_str()), ("nodeId", base)];
        references.extend(wait.by.as_deref().map(|by| ("vehicle", by)));
        if !wait.is_of_base_end() {
            let why = format!("order {order} waits: {}", wait.why);
            let references: Vec<Value> =
                references.iter().map(|(key, value)| json!({ "referenceKey": key, "referenceValue": value })).collect();
            let described = if state.mobile_robot_position.is_some() { "infoDescriptor" } else { "infoDescription" };
            let entry =
                json!({ "infoType": "waiting", "infoLevel": "INFO", "infoReferences": references, described: why });
            if let Value::Array(list) = state.rest.entry("information").or_insert_with(|| json!([])) {
                list.push(entry);
            }
            return;
        }
        let why = format!(
            "the vehicle cannot go to node {base} now, where the base of order {order} ends: {}; it may go up to node {here}",
            wait.why
        );
        let mut error = ErrorEntry::warning("baseEnd", why, &references);
        let hint = match &wait.next {
            Some((node, sequence)) => format!("release it up to node {node} (sequenceId {sequence})"),
            None => format!("none of the next {NODES} nodes of its horizon lets it go on now"),
        };
        error.rest.insert("errorHint".into(), hint.into());
        state.errors.push(error);
        // By the standard the vehicle says so when its base is running short: here it is.
        state.new_base_request = Some(true);
    }
}
