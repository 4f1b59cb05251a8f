//! One vehicle, its supervisor, and a manager that sends what the test says.

use crate::site::{interfaces, settings};
use pcr_formats::vda5050::decode::MessageLimits;
use pcr_formats::vda5050::state::State;
use pcr_formats::vda5050::topics::{TopicKind, VehicleId};
use pcr_formats::vda5050::version::ProtocolVersion;
use pcr_serve::journal_entry::NullStore;
use pcr_serve::owned_path::StartPose;
use pcr_serve::supervisor::{Supervisor, SupervisorConfig};
use pcr_serve::vda5050::bridge::{self, Vda5050Bridge};
use pcr_serve::vehicles::simulated_site::profile;
use pcr_serve::vehicles::vehicle::SimulatedVehicle;
use pcr_serve::vehicles::vehicle_motion::SimulatedTraits;
use serde_json::{Value, json};

pub(crate) const CAN: SimulatedTraits = SimulatedTraits {
    radius: 0.4,
    rectangle: None,
    speed: 1.0,
    acceleration: 0.5,
    rotation: 1.0,
    slip: 0.0,
    drift: 0.0,
    noise: 0.01,
    delay: 0.0,
};

const STEP: f64 = 0.1;

pub(crate) struct Pair {
    pub(crate) vehicle: SimulatedVehicle,
    pub(crate) supervisor: Supervisor,
    pub(crate) bridge: Vda5050Bridge,
    pub(crate) time: f64,
    /// The newest state that the manager has.
    pub(crate) state: Option<State>,
    /// What is lost on the way to the vehicle: the next message that this is true of.
    pub(crate) loses: Option<fn(TopicKind, &Value) -> bool>,
    pub(crate) header: u64,
    /// What was sent to the vehicle.
    pub(crate) got: Vec<(TopicKind, Value)>,
}

pub(crate) fn key() -> VehicleId {
    VehicleId::new("sim", "001").unwrap()
}

/// The bridge of the one vehicle.
pub(crate) fn bridge_of(supervisor: &Supervisor) -> Vda5050Bridge {
    let [manager, vehicles] = interfaces();
    let settings = bridge::BridgeConfig { manager, vehicles, limits: MessageLimits::default() };
    Vda5050Bridge::new(settings, vec![profile(key(), &CAN)], supervisor).unwrap()
}

/// A supervisor that goes on with the journal of a killed one, and its bridge.
pub(crate) fn restarted(killed: &mut Supervisor) -> (Supervisor, Vda5050Bridge) {
    let supervisor = Supervisor::restored(*killed.settings(), killed.snapshot().unwrap(), Box::new(NullStore)).unwrap();
    let bridge = bridge_of(&supervisor);
    (supervisor, bridge)
}

impl Pair {
    pub(crate) fn new() -> Self {
        Self::of(settings())
    }

    /// The same with a supervisor that has these settings.
    pub(crate) fn of(settings: SupervisorConfig) -> Self {
        let start = StartPose { x: 0.0, y: 0.0, heading: 0.0 };
        let vehicle = SimulatedVehicle::new(key(), ProtocolVersion::V2_1, "map", CAN, start, 1);
        let supervisor = Supervisor::new(settings, Box::new(NullStore));
        let bridge = bridge_of(&supervisor);
        let (state, loses, got) = (None, None, Vec::new());
        let mut own = Self { vehicle, supervisor, bridge, time: 0.0, state, loses, header: 0, got };
        own.lasts(1.0);
        assert!(own.supervisor.robot("sim/001").is_ok());
        own
    }

    /// Killed, and another one in its place.
    pub(crate) fn restart(&mut self) {
        (self.supervisor, self.bridge) = restarted(&mut self.supervisor);
    }

    pub(crate) fn lasts(&mut self, time: f64) {
        let [manager, vehicles] = interfaces();
        let until = self.time + time;
        while self.time < until {
            self.time += STEP;
            self.vehicle.advance(STEP);
            self.vehicle.tell_state();
            for (kind, payload) in self.vehicle.out() {
                let topic = vehicles.topic(ProtocolVersion::V2_1, &key(), kind);
                self.bridge.receive(&mut self.supervisor, &topic, &payload, self.time);
            }
            let events = self.supervisor.settle(self.time).unwrap();
            self.bridge.settled(&mut self.supervisor, &events, self.time);
            for message in self.bridge.out() {
                if let Some((_, _, kind)) = vehicles.parse(&message.topic) {
                    let said = serde_json::from_slice(&message.payload).unwrap();
                    if self.loses.is_some_and(|loses| loses(kind, &said)) {
                        self.loses = None;
                        continue;
                    }
                    self.vehicle.receive(kind, &message.payload);
                    self.got.push((kind, said));
                } else if let Some((_, _, TopicKind::State)) = manager.parse(&message.topic) {
                    self.state = Some(serde_json::from_slice(&message.payload).unwrap());
                }
            }
        }
    }

    /// A message with a header.
    pub(crate) fn signed(&mut self, mut message: Value) -> String {
        self.header += 1;
        let header = json!({ "headerId": self.header, "timestamp": "2030-01-01T00:00:00.000Z", "version": "2.1.0",
            "manufacturer": "sim", "serialNumber": "001" });
        message.as_object_mut().unwrap().extend(header.as_object().unwrap().clone());
        message.to_string()
    }

    /// What the manager says.
    pub(crate) fn says(&mut self, kind: TopicKind, message: Value) {
        let (message, [manager, _]) = (self.signed(message), interfaces());
        let topic = manager.topic(ProtocolVersion::V2_1, &key(), kind);
        self.bridge.receive(&mut self.supervisor, &topic, message.as_bytes(), self.time);
    }

    /// An order over these places.
    pub(crate) fn order(&mut self, id: &str, places: &[[f64; 2]]) {
        self.says(TopicKind::Order, order(id, 0, 0, places, places.len()));
    }

    pub(crate) fn cancels(&mut self, id: &str) {
        self.acts("cancelOrder", id);
    }

    /// The manager wants something at once.
    pub(crate) fn acts(&mut self, kind: &str, id: &str) {
        let action = json!({ "actionType": kind, "actionId": id, "blockingType": "NONE" });
        self.says(TopicKind::InstantActions, json!({ "actions": [action] }));
    }

    /// Whether the manager is told that it is paused.
    pub(crate) fn is_paused(&self) -> bool {
        self.state.as_ref().is_some_and(|state| state.rest["paused"] == true)
    }

    pub(crate) fn is_done(&self, id: &str) -> bool {
        self.state.as_ref().is_some_and(|state| state.order_id == id && state.is_idle())
    }

    pub(crate) fn errors(&self) -> Vec<String> {
        let state = self.state.as_ref().unwrap();
        state.errors.iter().map(|error| serde_json::to_string(error).unwrap()).collect()
    }
}

pub(crate) fn order(id: &str, update: u64, first: u64, places: &[[f64; 2]], released: usize) -> Value {
    let number = |k: usize| first + 2 * k as u64;
    let nodes: Vec<_> = (places.iter().enumerate())
        .map(|(k, [x, y])| {
            json!({ "nodeId": format!("n{}", number(k)), "sequenceId": number(k), "released": k < released, "actions": [],
                "nodePosition": { "x": x, "y": y, "mapId": "map" } })
        })
        .collect();
    let edges: Vec<_> = (1..places.len())
        .map(|k| {
            json!({ "edgeId": "e", "sequenceId": number(k) - 1, "released": k < released, "actions": [],
                "startNodeId": format!("n{}", number(k - 1)), "endNodeId": format!("n{}", number(k)) })
        })
        .collect();
    json!({ "orderId": id, "orderUpdateId": update, "nodes": nodes, "edges": edges })
}

pub(crate) const TO: [[f64; 2]; 3] = [[0.0, 0.0], [5.0, 0.0], [5.0, 5.0]];
pub(crate) const FRO: [[f64; 2]; 3] = [[5.0, 5.0], [5.0, 0.0], [0.0, 0.0]];

impl Pair {
    /// Somebody else tells the vehicle something.
    pub(crate) fn whispers(&mut self, kind: TopicKind, message: Value) {
        let message = self.signed(message);
        self.vehicle.receive(kind, message.as_bytes());
    }

    pub(crate) fn has_job(&self) -> bool {
        self.bridge.lanes().any(|lane| lane.job().is_some())
    }
}
