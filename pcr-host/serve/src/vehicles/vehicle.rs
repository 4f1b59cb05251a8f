//! A simulated vehicle that follows the standard: it drives on the released base only, stitches updates, and reports
//! its state.

use super::vehicle_motion::{DriveState, SimulatedTraits};
use crate::owned_path::StartPose;
use crate::vda5050::order_path::OrderPath;
use pcr_formats::splitmix64::SplitMix64;
use pcr_formats::vda5050::decode::{self, MessageLimits};
use pcr_formats::vda5050::header::MessageHeader;
use pcr_formats::vda5050::messages::{Action, InstantActions};
use pcr_formats::vda5050::order::Order;
use pcr_formats::vda5050::order_state::{OrderState, RejectedOrder, UpdateResult};
use pcr_formats::vda5050::state::{ActionState, ErrorEntry};
use pcr_formats::vda5050::timestamp;
use pcr_formats::vda5050::topics::{TopicKind, VehicleId};
use pcr_formats::vda5050::version::{OrderRejection, ProtocolVersion};
use serde_json::{Map, Value};
use std::collections::BTreeMap;

/// Largest distance between a vehicle and the first node of a new order \[m\].
const BEGINS: f64 = 0.5;

/// Duration of an action at a node \[s\].
const ACTION: f64 = 2.0;

/// An order and its progress.
#[derive(Clone, Debug)]
pub(super) struct OrderExecution {
    pub(super) held: OrderState,
    pub(super) way: OrderPath,
    pub(super) drive: DriveState,
    /// The last node that was reached.
    pub(super) done: usize,
    pub(super) cancelled: bool,
}

/// A vehicle.
#[derive(Debug)]
pub struct SimulatedVehicle {
    pub(super) key: VehicleId,
    pub(super) version: ProtocolVersion,
    pub(super) map_id: String,
    pub(super) abilities: SimulatedTraits,
    pub(super) random: SplitMix64,
    pub(super) start: StartPose,
    pub(super) task: Option<OrderExecution>,
    /// Ids of earlier orders, oldest first: a message with one of them is late.
    past: Vec<String>,
    /// Sideways error of its path \[m\], and its rate of change.
    pub(super) lateral_deviation: f64,
    pub(super) actions: Vec<ActionState>,
    pub(super) instant: Vec<ActionState>,
    /// Remaining time of the action at the node \[s\].
    acting: f64,
    cancel: Option<String>,
    pub(super) paused: bool,
    frozen: f64,
    pub(super) errors: Vec<ErrorEntry>,
    pub(super) headers: BTreeMap<TopicKind, u64>,
    /// Time since 1970 \[s\], and the error of its clock.
    pub(super) time: f64,
    pub(super) clock: f64,
    pub(super) out: Vec<(TopicKind, Vec<u8>)>,
    news: bool,
    /// Number of orders and updates that it has taken.
    taken: u64,
}

impl SimulatedVehicle {
    /// A vehicle that stands at `start`.
    pub fn new(
        key: VehicleId,
        version: ProtocolVersion,
        map_id: &str,
        abilities: SimulatedTraits,
        start: StartPose,
        seed: u64,
    ) -> Self {
        Self {
            key,
            version,
            map_id: map_id.into(),
            abilities,
            random: SplitMix64(seed),
            start,
            task: None,
            past: Vec::new(),
            lateral_deviation: 0.0,
            actions: Vec::new(),
            instant: Vec::new(),
            acting: 0.0,
            cancel: None,
            paused: false,
            frozen: 0.0,
            errors: Vec::new(),
            headers: BTreeMap::new(),
            time: timestamp::seconds(),
            clock: 0.0,
            out: Vec::new(),
            news: true,
            taken: 0,
        }
    }

    /// Manufacturer and serial number.
    pub fn key(&self) -> &VehicleId {
        &self.key
    }

    /// Edition of its messages.
    pub fn version(&self) -> ProtocolVersion {
        self.version
    }

    /// Its abilities and errors.
    pub fn abilities(&self) -> &SimulatedTraits {
        &self.abilities
    }

    /// Sets the error of its clock \[s\].
    pub fn set_clock(&mut self, off: f64) {
        self.clock = off;
    }

    /// Switches it off and on again: it stands where it was, and has lost its order.
    pub fn forget(&mut self) {
        let [x, y] = self.true_position();
        self.start = StartPose { x, y, heading: self.heading() };
        (self.task, self.lateral_deviation, self.acting, self.cancel, self.paused) = (None, 0.0, 0.0, None, false);
        (self.past, self.actions, self.instant, self.errors) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        // Its message numbers restart.
        self.headers.clear();
        self.news = true;
    }

    /// Number of orders and updates that it has taken.
    pub fn taken(&self) -> u64 {
        self.taken
    }

    /// Length of the way of its order that it has travelled \[m\].
    pub(crate) fn way_done(&self) -> f64 {
        self.task.as_ref().map_or(0.0, |task| task.drive.at)
    }

    /// Corners of its released way ahead: from its place to the end of its base.
    pub fn released(&self) -> Vec<[f64; 2]> {
        let Some(task) = self.task.as_ref().filter(|task| !task.cancelled) else { return vec![self.true_position()] };
        let end = task.way.node(task.held.base).unwrap_or(task.drive.at).max(task.drive.at);
        let nodes = (0..=task.held.base).filter_map(|node| task.way.node(node));
        let between = nodes.filter(|length| (task.drive.at..end).contains(length));
        let lengths = [task.drive.at].into_iter().chain(between).chain([end]);
        lengths.map(|length| task.way.pose(length)).map(|pose| [pose.x, pose.y]).collect()
    }

    /// Does and sends nothing for a time \[s\].
    pub fn freeze(&mut self, time: f64) {
        self.frozen = time;
        if let Some(task) = &mut self.task {
            task.drive.speed = 0.0;
        }
    }

    /// The messages to be sent.
    pub fn out(&mut self) -> Vec<(TopicKind, Vec<u8>)> {
        if std::mem::take(&mut self.news) && self.frozen <= 0.0 {
            self.tell_state();
        }
        std::mem::take(&mut self.out)
    }

    /// Its true position.
    pub fn true_position(&self) -> [f64; 2] {
        let Some(task) = &self.task else { return [self.start.x, self.start.y] };
        let pose = task.way.pose(task.drive.at);
        // The sideways error grows with the length travelled, so that there is no jump at the start.
        let off = self.lateral_deviation * (task.drive.at / self.abilities.drift.max(1e-9)).min(1.0);
        let end = task.way.length() - task.drive.at;
        let off = off * (end / self.abilities.drift.max(1e-9)).min(1.0);
        [pose.x - off * pose.heading.sin(), pose.y + off * pose.heading.cos()]
    }

    /// Its heading \[rad\].
    pub(super) fn heading(&self) -> f64 {
        let heading = |task: &OrderExecution| task.drive.heading(&task.way, &self.abilities);
        self.task.as_ref().map_or(self.start.heading, heading)
    }

    /// Takes a message.
    pub fn receive(&mut self, kind: TopicKind, payload: &[u8]) {
        if self.frozen > 0.0 {
            return;
        }
        match kind {
            TopicKind::Order => {
                let mut named = (String::new(), 0);
                let order = decode::read::<Order>(payload, MessageLimits::default()).map_err(RejectedOrder::from);
                let taken = order.and_then(|order| {
                    named = (order.order_id.clone(), order.order_update_id);
                    self.take(order)
                });
                match taken {
                    Ok(true) => {
                        self.errors.clear();
                        (self.news, self.taken) = (true, self.taken + 1);
                    }
                    Ok(false) => {}
                    Err(rejected) => self.reject(&rejected, &named),
                }
            }
            TopicKind::InstantActions => {
                if let Ok(message) = decode::read::<InstantActions>(payload, MessageLimits::default())
                    && self.is_ours(&message.header)
                    && let Ok(actions) = message.list()
                {
                    actions.iter().for_each(|action| self.act(action));
                }
            }
            _ => {}
        }
    }

    fn is_ours(&self, header: &MessageHeader) -> bool {
        header.check(&self.key, self.version == ProtocolVersion::V3_0).is_ok()
    }

    fn reject(&mut self, rejected: &RejectedOrder, (order, update): &(String, u64)) {
        let error = rejected.report(self.version, order, *update);
        if !self.errors.contains(&error) {
            self.errors.push(error);
        }
        self.news = true;
    }

    fn take(&mut self, order: Order) -> Result<bool, RejectedOrder> {
        order.header.check(&self.key, self.version == ProtocolVersion::V3_0)?;
        let actions = |order: &Order| -> Vec<ActionState> {
            let nodes = order.nodes.iter().flat_map(|node| &node.actions);
            nodes.chain(order.edges.iter().flat_map(|edge| &edge.actions)).map(waiting).collect()
        };
        let (new, heading) = (actions(&order), self.heading());
        match &mut self.task {
            Some(task) if task.held.order_id == order.order_id && !task.cancelled => {
                let mut held = task.held.clone();
                let UpdateResult::After(after) = held.update(order)? else { return Ok(false) };
                task.way
                    .extend(&held, after)
                    .map_err(|refusal| RejectedOrder { error: OrderRejection::Order, refusal })?;
                task.held = held;
                let known: Vec<String> = self.actions.iter().map(|action| action.action_id.clone()).collect();
                self.actions.extend(new.into_iter().filter(|action| !known.contains(&action.action_id)));
            }
            Some(task) if task.held.order_id == order.order_id => {
                return Err(RejectedOrder::new(OrderRejection::Cancelled, "orderId", "it was cancelled"));
            }
            task => {
                if task.as_ref().is_some_and(|task| !task.cancelled && task.done + 1 < task.held.nodes.len())
                    || self.acting > 0.0
                {
                    return Err(RejectedOrder::new(OrderRejection::Order, "orderId", "another order is not finished"));
                }
                if self.past.contains(&order.order_id) {
                    return Err(RejectedOrder::new(OrderRejection::Order, "orderId", "it was there before"));
                }
                let start = task.as_ref().map_or(self.start, |task| task.way.pose(task.drive.at));
                let start = StartPose { heading, ..start };
                let held = OrderState::new(order)?;
                let way = OrderPath::new(start, &held, 0.0)
                    .map_err(|refusal| RejectedOrder { error: OrderRejection::Order, refusal })?;
                let begins = way.node(0).unwrap_or(0.0);
                if begins > BEGINS {
                    let why = format!("{begins:.3} m from the vehicle");
                    return Err(RejectedOrder::new(OrderRejection::Order, "nodes[0].nodePosition", why));
                }
                self.start = start;
                /// Number of ids that are kept.
                const MOST: usize = 32;
                self.past.extend(task.take().map(|task| task.held.order_id));
                self.past.drain(..self.past.len().saturating_sub(MOST));
                *task = Some(OrderExecution { held, way, drive: DriveState::new(), done: 0, cancelled: false });
                self.actions = new;
            }
        }
        Ok(true)
    }

    fn act(&mut self, action: &Action) {
        // A repeated action id means a repeated message.
        if self.instant.iter().any(|known| known.action_id == action.action_id) {
            return;
        }
        let mut state = waiting(action);
        let has_order = self
            .task
            .as_ref()
            .is_some_and(|task| !task.cancelled && (task.done + 1 < task.held.nodes.len() || task.drive.is_driving()));
        let status = match action.action_type.as_str() {
            "cancelOrder" if has_order => {
                self.cancel = Some(action.action_id.clone());
                "RUNNING"
            }
            "cancelOrder" => {
                let kind = self.version.error(OrderRejection::NothingToCancel);
                let references = [("actionId", action.action_id.as_str())];
                self.errors.push(ErrorEntry::warning(kind, "there is no order".into(), &references));
                "FAILED"
            }
            "startPause" => (self.paused = true, "FINISHED").1,
            "stopPause" => (self.paused = false, "FINISHED").1,
            "stateRequest" => "FINISHED",
            "factsheetRequest" => (self.tell_factsheet(), "FINISHED").1,
            _ => "FAILED",
        };
        state.action_status = status.into();
        self.instant.push(state);
        /// Number of states of instant actions that are kept.
        const MOST: usize = 8;
        if self.instant.len() > MOST {
            self.instant.remove(0);
        }
        self.news = true;
    }

    /// Goes on for a time \[s\].
    pub fn advance(&mut self, time: f64) {
        self.time += time;
        self.frozen = (self.frozen - time).max(0.0);
        if self.frozen > 0.0 {
            return;
        }
        let can = self.abilities;
        // Slow enough that its sideways speed is at most a tenth of its speed.
        self.lateral_deviation =
            (self.lateral_deviation + self.random.uniform(-1.0, 1.0) * can.drift * time).clamp(-can.drift, can.drift);
        let Some(task) = &mut self.task else { return };
        let was = (task.drive.is_driving(), task.done);
        let base = task.way.node(task.held.base).unwrap_or(0.0);
        if self.cancel.is_some() || self.paused {
            task.drive.brake(base, &can, time);
            if let Some(id) = self.cancel.take_if(|_| !task.drive.is_driving()) {
                task.cancelled = true;
                self.acting = 0.0;
                for action in &mut self.actions {
                    if action.action_status != "FINISHED" {
                        action.action_status = "FAILED".into();
                    }
                }
                if let Some(state) = self.instant.iter_mut().find(|state| state.action_id == id) {
                    state.action_status = "FINISHED".into();
                }
                self.news = true;
            }
        } else if self.acting > 0.0 {
            self.acting = (self.acting - time).max(0.0);
        } else if !task.cancelled {
            let end = stop(task, &self.actions).map_or(base, |stop| stop.min(base));
            task.drive.advance(&task.way, &task.held, end, &can, &mut self.random, time);
        }
        let reached =
            |task: &OrderExecution| task.way.node(task.done + 1).is_some_and(|next| next <= task.drive.at + 1e-9);
        while !task.cancelled && task.done < task.held.base && reached(task) {
            task.done += 1;
        }
        if was != (task.drive.is_driving(), task.done) {
            self.news = true;
        }
        self.work();
    }

    /// Carries out the actions of the node where it stands, one after the other. Actions of edges end with the edge.
    fn work(&mut self) {
        let Some(task) = self.task.as_ref().filter(|task| !task.cancelled && self.acting <= 0.0) else { return };
        let passed = task.held.edges.iter().take(task.done).flat_map(|edge| &edge.actions);
        let before = task.held.nodes.iter().take(task.done).flat_map(|node| &node.actions);
        let done: Vec<&str> = passed.chain(before).map(|action| action.action_id.as_str()).collect();
        for state in self.actions.iter_mut().filter(|state| state.action_status != "FINISHED") {
            if done.contains(&state.action_id.as_str()) || state.action_status == "RUNNING" {
                state.action_status = "FINISHED".into();
                self.news = true;
            }
        }
        let here = task.held.nodes.get(task.done).filter(|_| task.drive.speed == 0.0);
        let next = here.and_then(|node| {
            let is_next = |state: &&mut ActionState| {
                state.action_status == "WAITING" && node.actions.iter().any(|own| own.action_id == state.action_id)
            };
            self.actions.iter_mut().find(is_next)
        });
        if let Some(state) = next {
            state.action_status = "RUNNING".into();
            (self.acting, self.news) = (ACTION, true);
        }
    }
}

/// Length at which it has to stop for an action \[m\].
fn stop(task: &OrderExecution, actions: &[ActionState]) -> Option<f64> {
    let is_open = |action: &Action| {
        actions.iter().any(|state| state.action_id == action.action_id && state.action_status != "FINISHED")
    };
    let nodes = task.held.nodes.iter().enumerate().skip(task.done);
    nodes.filter(|(_, node)| node.actions.iter().any(is_open)).find_map(|(place, _)| task.way.node(place))
}

fn waiting(action: &Action) -> ActionState {
    let rest = Map::from_iter([("actionType".to_owned(), Value::from(action.action_type.clone()))]);
    ActionState { action_id: action.action_id.clone(), action_status: "WAITING".into(), rest }
}
