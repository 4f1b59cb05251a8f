//! The state of the vehicle for the manager, in the manager's numbers.

use super::super::remaining_elements::{EdgeStateOut, NodeStateOut};
use super::action_states::ActionsAhead;
use super::recency::Recency;
use super::{ActiveOrder, NEEDS, OutboundMessage, Recipient, SendCondition, VehicleAdapter};
use crate::supervisor::{PauseAbility, Supervisor};
use pcr_formats::import::{self, ImportOptions, Warnings};
use pcr_formats::vda5050::decode::{self, DecodeError, MessageLimits};
use pcr_formats::vda5050::messages::{Connection, Factsheet, Responses};
use pcr_formats::vda5050::state::{EdgeState, ErrorEntry, NodeState, PartialList, State};
use pcr_formats::vda5050::topics::TopicKind;
use pcr_formats::vda5050::version::ProtocolVersion;
use pcr_planning::fleet::ConvexBody;
use serde_json::Value;

/// The nodes and edges ahead, as JSON. It is kept because most states of a vehicle are between the same two nodes.
#[derive(Clone, Debug)]
pub(super) struct CachedRemaining {
    order: String,
    update: u64,
    node: usize,
    has_base: bool,
    nodes: PartialList<NodeState>,
    edges: PartialList<EdgeState>,
    pub(super) actions: ActionsAhead,
    pub(super) corridors: Option<ErrorEntry>,
}

impl CachedRemaining {
    fn of(job: &ActiveOrder, node: usize) -> Self {
        let nodes: Vec<NodeStateOut<'_>> = job.order.nodes.iter().skip(node + 1).map(NodeStateOut::from).collect();
        let edges: Vec<EdgeStateOut<'_>> = job.order.edges.iter().skip(node).map(EdgeStateOut::from).collect();
        let has_base = nodes.iter().any(|node| node.released);
        let (order, update) = (job.order.order_id.clone(), job.order.update_id);
        let (nodes, edges) = (PartialList::written(&nodes), PartialList::written(&edges));
        let (actions, corridors) = (job.actions_ahead(node), job.corridors_ahead(node));
        Self { order, update, node, has_base, nodes, edges, actions, corridors }
    }

    fn is_of(&self, job: &ActiveOrder, node: usize) -> bool {
        self.node == node && self.update == job.order.update_id && self.order == job.order.order_id
    }
}

impl VehicleAdapter {
    /// Sends the newest state to the manager.
    pub(super) fn mirror(&mut self) {
        let (Some(version), Some(state)) = (self.version, &self.state) else { return };
        let state = self.translated(State::clone(state));
        self.post(Recipient::Manager, TopicKind::State, version, &state);
    }

    /// Passes a message on to the manager unchanged.
    pub(crate) fn pass_on(&mut self, kind: TopicKind, is_third: bool, payload: &[u8]) {
        self.forward(Recipient::Manager, kind, is_third, payload);
    }

    pub(super) fn forward(&mut self, to: Recipient, kind: TopicKind, is_third: bool, payload: &[u8]) {
        let version = if is_third { ProtocolVersion::V3_0 } else { ProtocolVersion::V2_1 };
        let key = self.profile.key.clone();
        self.posts.push(OutboundMessage {
            to,
            key,
            version,
            kind,
            payload: payload.to_vec(),
            due: SendCondition::Kept,
        });
    }

    /// Passes on the manager's answers to requests of the vehicle. A request to enter a zone is answered as the manager says,
    /// because the vehicle goes no further than its base there either. A request to leave the way, in a zone or a corridor, is
    /// rejected, because the place of the vehicle would not be known.
    ///
    /// # Errors
    /// [`DecodeError`] for an invalid message, and for rejected requests.
    pub fn responses(&mut self, payload: &[u8], limits: MessageLimits, is_third: bool) -> Result<(), DecodeError> {
        let mut message: Responses = decode::read(payload, limits)?;
        let version = message.header.check(&self.profile.key, is_third)?;
        let mut rejected = None;
        for (k, response) in message.responses.iter_mut().enumerate() {
            if response.grant_type == "GRANTED" && !self.asks_to_enter(&response.request_id) {
                response.grant_type = "REJECTED".into();
                response.rest.remove("leaseExpiry");
                let why = format!("{}: no request to enter a zone", response.request_id);
                rejected.get_or_insert(DecodeError::new(format!("responses[{k}].grantType"), why));
            }
        }
        self.post(Recipient::Vehicle, TopicKind::Responses, version, &message);
        rejected.map_or(Ok(()), Err)
    }

    /// Whether the vehicle has made a request with this id to enter a zone, and no other request with it.
    fn asks_to_enter(&self, id: &str) -> bool {
        let requests = |list: &str| {
            let list = self.state.as_ref().and_then(|state| state.rest.get(list)?.as_array());
            list.into_iter().flatten().filter(|request| request["requestId"] == id)
        };
        let mut zones = requests("zoneRequests").peekable();
        zones.peek().is_some()
            && zones.all(|request| request["requestType"] == "ACCESS")
            && requests("edgeRequests").next().is_none()
    }

    /// Takes a connection message. The rights of the vehicle do not depend on it. A vehicle that has just connected may restart
    /// its count, so it is asked for its state.
    ///
    /// # Errors
    /// [`DecodeError`] for an invalid message.
    pub fn connection(
        &mut self,
        payload: &[u8],
        limits: MessageLimits,
        is_third: bool,
        now: f64,
    ) -> Result<(), DecodeError> {
        let message: Connection = decode::read(payload, limits)?;
        let version = message.header.check(&self.profile.key, is_third)?;
        self.version.get_or_insert(version);
        if message.connection_state == "ONLINE" && self.state.is_some() {
            self.ask_when(now);
        }
        Ok(())
    }

    /// Takes a factsheet. As long as a vehicle is larger than its configured disc, no vehicle is released anything.
    ///
    /// # Errors
    /// [`DecodeError`] for an invalid factsheet, or one of another vehicle.
    pub fn factsheet(
        &mut self,
        supervisor: &mut Supervisor,
        payload: &[u8],
        limits: MessageLimits,
        is_third: bool,
        now: f64,
    ) -> Result<(), DecodeError> {
        let message: Factsheet = decode::read(payload, limits)?;
        let version = message.header.check(&self.profile.key, is_third)?;
        self.version.get_or_insert(version);
        if self.newest.entry(TopicKind::Factsheet).or_default().take(&message.header, now, |_| false) == Recency::Late {
            return Ok(());
        }
        self.pause_ability = pause_ability(&message);
        let text = String::from_utf8_lossy(payload);
        let vehicle = import::vehicle(&text, &ImportOptions::default(), &mut Warnings::default());
        let vehicle = vehicle.map_err(|error| DecodeError::new("", error))?;
        // The contour is compared with what is kept free. Speeds do not matter for safety.
        let own = self.profile.abilities.footprint.as_ref();
        let hull = own.and_then(|own| ConvexBody::of_vehicle(Some(own), 0.0).ok()).map(|hull| hull.corners());
        let needs = vehicle.footprint.as_ref().map(|contour| match &hull {
            None => vehicle.radius,
            Some((corners, radius)) => contour.beyond(corners) + contour.growth() - radius,
        });
        if needs != self.needs {
            self.needs = needs;
            self.note(supervisor, NEEDS, needs);
        }
        self.misfit().map_or(Ok(()), |why| Err(DecodeError::new("physicalParameters", why)))
    }

    fn translated(&mut self, mut state: State) -> State {
        self.look_ahead(&state);
        self.job.iter().for_each(|job| job.name_updates(&mut state.errors));
        let limits = self.limit_errors(&state);
        let own = self.errors.iter().cloned().chain(self.elsewhere_error()).chain(self.pause_error());
        let corridors = self.ahead.as_ref().and_then(|ahead| ahead.corridors.clone());
        let own = own.chain(self.notice_errors()).chain(corridors).chain(self.zones.errors());
        let own: Vec<ErrorEntry> = own.chain(limits).collect();
        state.errors.extend(own);
        self.add_action_states(&mut state);
        self.in_manager_numbers(&mut state);
        self.tell_wait(&mut state);
        state
    }

    /// Finds what is ahead of the vehicle of its order.
    fn look_ahead(&mut self, state: &State) {
        let job = self.job.as_ref().filter(|job| job.order.order_id == state.order_id);
        let Some(job) = job else {
            self.ahead = None;
            return;
        };
        let node = job.passed(state).and_then(|place| job.stops.get(place)).map_or(0, |stop| stop.node);
        if self.ahead.as_ref().is_none_or(|ahead| !ahead.is_of(job, node)) {
            self.ahead = Some(CachedRemaining::of(job, node));
        }
    }

    /// Gives a state the manager's numbers of nodes and updates, and all nodes that are ahead.
    fn in_manager_numbers(&mut self, state: &mut State) {
        let Some(job) = self.job.as_ref().filter(|job| job.order.order_id == state.order_id) else { return };
        let sent = job.sent.filter(|sent| sent.update == state.order_update_id).map(|sent| sent.manager);
        if let Some(manager) = job.received.acknowledged.map(|(_, manager)| manager).or(sent) {
            state.order_update_id = manager;
        }
        // A vehicle that has just taken the order may still be at the end of the one before.
        let place = if job.is_confirmed() { job.passed(state) } else { Some(0) };
        let Some(stop) = place.and_then(|place| job.stops.get(place)) else { return };
        let Some(last) = job.order.nodes.get(stop.node) else { return };
        state.last_node_id.clone_from(&last.node_id);
        state.last_node_sequence_id = last.sequence_id;
        if stop.between
            && let Some(since) = state.rest.get("distanceSinceLastNode").and_then(Value::as_f64)
        {
            let since = since + stop.length - job.path.departure(stop.node).unwrap_or(stop.length);
            state.rest.insert("distanceSinceLastNode".into(), since.into());
        }
        // A vehicle without nodes has completed the cancellation, or has dropped the order.
        if state.node_states.is_empty() && (job.cancel.is_some() || job.lost_at.is_some()) {
            return;
        }
        let waits = state.node_states.iter().any(|node| node.released);
        let Some(ahead) = &self.ahead else { return };
        (state.node_states, state.edge_states) = (ahead.nodes.clone(), ahead.edges.clone());
        // Whether more base is needed depends on the base of the manager, not on the part that the vehicle has.
        if let Some(request) = &mut state.new_base_request {
            *request &= waits || !ahead.has_base;
        }
    }
}

/// Why it is not certain from a factsheet that a vehicle can be paused; `None`: it can.
fn pause_ability(message: &Factsheet) -> Option<PauseAbility> {
    let features = message.rest.get("protocolFeatures");
    let list = features.and_then(|features| features.get("agvActions").or_else(|| features.get("mobileRobotActions")));
    // A vehicle that knew none could not even cancel an order: its list was not filled in.
    let Some(list) = list.and_then(Value::as_array).filter(|list| !list.is_empty()) else {
        return Some(PauseAbility::Unknown);
    };
    let knows = |kind: &str| {
        list.iter().any(|action| {
            let scopes = action.get("actionScopes").and_then(Value::as_array);
            action["actionType"] == kind && scopes.is_none_or(|scopes| scopes.iter().any(|scope| scope == "INSTANT"))
        })
    };
    (!(knows("startPause") && knows("stopPause"))).then_some(PauseAbility::Unable)
}
