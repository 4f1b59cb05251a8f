//! A vehicle that says what the test says, and its supervisor.

use crate::pair::{bridge_of, key, restarted};
use crate::site::{interfaces, settings};
use pcr_formats::vda5050::timestamp;
use pcr_formats::vda5050::topics::TopicKind;
use pcr_formats::vda5050::version::ProtocolVersion;
use pcr_serve::journal_entry::NullStore;
use pcr_serve::robot::SupervisedRobot;
use pcr_serve::supervisor::{Supervisor, SupervisorConfig};
use pcr_serve::vda5050::bridge::Vda5050Bridge;
use serde_json::{Value, json};

pub(crate) struct Puppet {
    pub(crate) supervisor: Supervisor,
    pub(crate) bridge: Vda5050Bridge,
    pub(crate) time: f64,
    /// What it says next; number and time are filled in.
    pub(crate) state: Value,
    /// Whether it lists the actions that it was asked for.
    pub(crate) lists: bool,
    /// What it was sent.
    pub(crate) got: Vec<(TopicKind, Value)>,
    /// What the manager was told last.
    pub(crate) told: Value,
    version: ProtocolVersion,
    number: u64,
}

impl Puppet {
    /// At (0, 0), without an order.
    pub(crate) fn new() -> Self {
        Self::of(ProtocolVersion::V2_1, settings())
    }

    /// The same of an edition, with a supervisor that has these settings.
    pub(crate) fn of(version: ProtocolVersion, settings: SupervisorConfig) -> Self {
        let supervisor = Supervisor::new(settings, Box::new(NullStore));
        let bridge = bridge_of(&supervisor);
        let pose = json!({ "x": 0.0, "y": 0.0, "theta": 0.0, "mapId": "map", "positionInitialized": true });
        let place = if version == ProtocolVersion::V3_0 { "mobileRobotPosition" } else { "agvPosition" };
        let state = json!({ "version": version.text(), "manufacturer": "sim", "serialNumber": "001", "orderId": "",
            "orderUpdateId": 0, "lastNodeId": "", "lastNodeSequenceId": 0, "nodeStates": [], "edgeStates": [],
            "driving": false, "paused": false, "actionStates": [], "errors": [], "operatingMode": "AUTOMATIC",
            place: pose });
        let (got, told) = (Vec::new(), Value::Null);
        let mut own = Self { supervisor, bridge, time: 0.0, state, lists: true, got, told, version, number: 0 };
        own.lasts(1.0);
        own
    }

    /// The supervisor is killed, and another one goes on with its journal.
    pub(crate) fn restart(&mut self) {
        (self.supervisor, self.bridge) = restarted(&mut self.supervisor);
        self.time = 0.0;
        self.bridge.greet(self.time);
    }

    pub(crate) fn robot(&self) -> &SupervisedRobot {
        self.supervisor.robot("sim/001").unwrap()
    }

    pub(crate) fn has_job(&self) -> bool {
        self.bridge.lanes().any(|lane| lane.job().is_some())
    }

    /// What it would say now.
    pub(crate) fn written(&mut self) -> Value {
        self.number += 1;
        let mut state = self.state.clone();
        state["headerId"] = self.number.into();
        state["timestamp"] = timestamp::written(1.9e9 + self.number as f64).into();
        state
    }

    pub(crate) fn hears(&mut self, state: &Value) {
        let topic = interfaces()[1].topic(self.version, &key(), TopicKind::State);
        self.bridge.receive(&mut self.supervisor, &topic, state.to_string().as_bytes(), self.time);
        self.turn();
    }

    /// What follows.
    pub(crate) fn turn(&mut self) {
        let [manager, vehicles] = interfaces();
        let events = self.supervisor.settle(self.time).unwrap();
        self.bridge.settled(&mut self.supervisor, &events, self.time);
        for message in self.bridge.out() {
            let said: Value = serde_json::from_slice(&message.payload).unwrap();
            if let Some((.., TopicKind::State)) = manager.parse(&message.topic) {
                self.told = said;
            } else if let Some((.., kind)) = vehicles.parse(&message.topic) {
                for action in said["actions"].as_array().into_iter().flatten() {
                    if self.lists && action["actionType"] == "stateRequest" {
                        self.ends(action["actionId"].as_str().unwrap(), "FINISHED");
                    }
                }
                self.got.push((kind, said));
            }
        }
    }

    /// It says its state every half second.
    pub(crate) fn lasts(&mut self, time: f64) {
        let until = self.time + time;
        while self.time < until {
            self.time += 0.5;
            let state = self.written();
            self.hears(&state);
        }
    }

    /// An action has this status now.
    pub(crate) fn ends(&mut self, id: &str, status: &str) {
        let all = self.state["actionStates"].as_array_mut().unwrap();
        all.retain(|action| action["actionId"] != id);
        all.push(json!({ "actionId": id, "actionStatus": status }));
    }

    /// The ids of all actions of a type that it was sent.
    pub(crate) fn asked(&self, kind: &str) -> Vec<String> {
        let mut ids: Vec<String> = Vec::new();
        for action in self.got.iter().flat_map(|(_, said)| said["actions"].as_array().into_iter().flatten()) {
            let id = action["actionId"].as_str().unwrap();
            if action["actionType"] == kind && !ids.iter().any(|known| known == id) {
                ids.push(id.into());
            }
        }
        ids
    }

    /// The number of orders and updates that it was sent.
    pub(crate) fn orders(&self) -> usize {
        self.got.iter().filter(|(kind, _)| *kind == TopicKind::Order).count()
    }

    /// What the manager says.
    pub(crate) fn manager(&mut self, kind: TopicKind, message: Value) {
        let message = self.signed(message);
        let topic = interfaces()[0].topic(self.version, &key(), kind);
        self.bridge.receive(&mut self.supervisor, &topic, message.to_string().as_bytes(), self.time);
        self.turn();
    }

    /// A message of the manager with its header.
    pub(crate) fn signed(&self, mut message: Value) -> Value {
        let header = json!({ "headerId": 1, "timestamp": "2030-01-01T00:00:00.000Z", "version": self.version.text(),
            "manufacturer": "sim", "serialNumber": "001" });
        message.as_object_mut().unwrap().extend(header.as_object().unwrap().clone());
        message
    }

    pub(crate) fn cancels(&mut self, id: &str) {
        let action = json!({ "actionType": "cancelOrder", "actionId": id, "blockingType": "NONE" });
        self.manager(TopicKind::InstantActions, json!({ "actions": [action] }));
    }

    /// It is at a node of its order, with these ahead, all released, and says so.
    pub(crate) fn is_at(&mut self, order: &str, update: u64, last: u64, ahead: &[u64], x: f64, driving: bool) {
        let nodes: Vec<Value> = ahead
            .iter()
            .map(|number| json!({ "nodeId": format!("n{number}"), "sequenceId": number, "released": true }))
            .collect();
        self.state["orderId"] = order.into();
        self.state["orderUpdateId"] = update.into();
        (self.state["lastNodeId"], self.state["lastNodeSequenceId"]) = (format!("n{last}").into(), last.into());
        (self.state["nodeStates"], self.state["driving"]) = (nodes.into(), driving.into());
        self.state["agvPosition"]["x"] = x.into();
        self.lasts(0.5);
    }

    /// Without an order.
    pub(crate) fn forgets(&mut self) {
        (self.state["orderId"], self.state["orderUpdateId"], self.state["lastNodeId"]) =
            ("".into(), 0.into(), "".into());
        (self.state["lastNodeSequenceId"], self.state["nodeStates"]) = (0.into(), json!([]));
        self.state["driving"] = false.into();
    }
}
