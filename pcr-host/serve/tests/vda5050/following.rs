//! One vehicle behind another: what the one in front says lets the other one go on in the same turn.

use crate::pair::CAN;
use crate::site::{interfaces, settings};
use pcr_formats::vda5050::decode::MessageLimits;
use pcr_formats::vda5050::topics::{TopicKind, VehicleId};
use pcr_formats::vda5050::version::ProtocolVersion;
use pcr_serve::journal_entry::NullStore;
use pcr_serve::owned_path::StartPose;
use pcr_serve::supervisor::Supervisor;
use pcr_serve::vda5050::bridge::{self, Vda5050Bridge};
use pcr_serve::vehicles::simulated_site::profile;
use pcr_serve::vehicles::vehicle::SimulatedVehicle;
use serde_json::json;

struct Row {
    vehicles: [SimulatedVehicle; 2],
    supervisor: Supervisor,
    bridge: Vda5050Bridge,
    released: [usize; 2],
}

impl Row {
    fn new() -> Self {
        let keys = ["front", "behind"].map(|name| VehicleId::new("sim", name).unwrap());
        let vehicle = |(key, x): (&VehicleId, f64)| {
            SimulatedVehicle::new(
                key.clone(),
                ProtocolVersion::V2_1,
                "map",
                CAN,
                StartPose { x, y: 0.0, heading: 0.0 },
                1,
            )
        };
        let vehicles = [vehicle((&keys[0], 2.0)), vehicle((&keys[1], 0.0))];
        let [manager, vehicle] = interfaces();
        let topics = bridge::BridgeConfig { manager, vehicles: vehicle, limits: MessageLimits::default() };
        let supervisor = Supervisor::new(settings(), Box::new(NullStore));
        let bridge =
            Vda5050Bridge::new(topics, keys.iter().map(|key| profile(key.clone(), &CAN)).collect(), &supervisor)
                .unwrap();
        Self { vehicles, supervisor, bridge, released: [0; 2] }
    }

    /// Twenty meters ahead, a node each.
    fn order(&mut self, k: usize, now: f64) {
        let [manager, _] = interfaces();
        let [x, y] = self.vehicles[k].true_position();
        let node = |n: usize| {
            json!({ "nodeId": format!("{k}-{n}"), "sequenceId": 2 * n, "released": true, "actions": [],
            "nodePosition": { "x": x + n as f64, "y": y, "mapId": "map" } })
        };
        let edge = |n: usize| {
            json!({ "edgeId": format!("{k}-{n}e"), "sequenceId": 2 * n + 1, "released": true, "actions": [],
            "startNodeId": format!("{k}-{n}"), "endNodeId": format!("{k}-{}", n + 1) })
        };
        let key = self.vehicles[k].key().clone();
        let order = json!({ "headerId": 1, "timestamp": "2030-01-01T00:00:00.000Z", "version": "2.1.0", "manufacturer": key.manufacturer,
            "serialNumber": key.serial_number, "orderId": format!("{k}"), "orderUpdateId": 0,
            "nodes": (0..=20).map(node).collect::<Vec<_>>(), "edges": (0..20).map(edge).collect::<Vec<_>>() });
        let topic = manager.topic(ProtocolVersion::V2_1, &key, TopicKind::Order);
        self.bridge.receive(&mut self.supervisor, &topic, order.to_string().as_bytes(), now);
    }

    /// Some say where they are, and all hear what follows, nothing of what was told before.
    fn turn(&mut self, who: &[usize], now: f64) {
        let [_, topics] = interfaces();
        for &k in who {
            self.vehicles[k].tell_state();
            for (kind, payload) in self.vehicles[k].out() {
                let topic = topics.topic(ProtocolVersion::V2_1, self.vehicles[k].key(), kind);
                self.bridge.receive(&mut self.supervisor, &topic, &payload, now);
            }
        }
        self.supervisor.decide(now);
        self.bridge.settled(&mut self.supervisor, &[], now);
        let _ = self.supervisor.settle(now).unwrap();
        self.released = [0; 2];
        for message in self.bridge.out() {
            let Some((_, key, kind)) = topics.parse(&message.topic) else { continue };
            let k = usize::from(key != *self.vehicles[0].key());
            self.released[k] += usize::from(kind == TopicKind::Order);
            self.vehicles[k].receive(kind, &message.payload);
        }
    }
}

#[test]
fn who_is_behind_is_released_in_the_turn_of_the_one_in_front() {
    let mut own = Row::new();
    own.turn(&[0, 1], 0.0);
    own.turn(&[0, 1], 0.2);
    own.order(0, 0.3);
    own.order(1, 0.3);
    let (mut now, mut at_once) = (0.4, 0);
    for _ in 0..400 {
        // All lanes are looked at, and both vehicles have what they were released.
        own.turn(&[0, 1], now);
        own.turn(&[0, 1], now + 0.11);
        // Sooner than lanes are looked at without a message.
        own.vehicles.iter_mut().for_each(|vehicle| vehicle.advance(0.15));
        own.turn(&[0], now + 0.15);
        at_once += own.released[1];
        now += 0.3;
    }
    let [x, _] = own.vehicles[1].true_position();
    assert!(x > 19.0, "it has come to {x} m");
    assert!(at_once >= 5, "{at_once} releases in the turn of the one in front");
}
