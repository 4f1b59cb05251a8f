//! Vehicles on several maps: their coordinates have nothing to do with one another.

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
use serde_json::{Value, json};

fn key(name: &str) -> VehicleId {
    VehicleId::new("sim", name).unwrap()
}

fn bridge(supervisor: &Supervisor) -> Vda5050Bridge {
    let [manager, vehicles] = interfaces();
    let topics = bridge::BridgeConfig { manager, vehicles, limits: MessageLimits::default() };
    Vda5050Bridge::new(topics, ["a", "b"].map(|name| profile(key(name), &CAN)).into(), supervisor).unwrap()
}

/// Two vehicles that stand.
struct Pair {
    vehicles: [SimulatedVehicle; 2],
    supervisor: Supervisor,
    bridge: Vda5050Bridge,
    now: f64,
    /// What their managers were told last.
    states: [Value; 2],
    /// Orders that were sent to them.
    orders: [usize; 2],
    log: Vec<String>,
}

impl Pair {
    fn new(xs: [f64; 2]) -> Self {
        let vehicle = |(name, x)| {
            SimulatedVehicle::new(
                key(name),
                ProtocolVersion::V2_1,
                "map",
                CAN,
                StartPose { x, y: 0.0, heading: 0.0 },
                1,
            )
        };
        let vehicles = [("a", xs[0]), ("b", xs[1])].map(vehicle);
        let supervisor = Supervisor::new(settings(), Box::new(NullStore));
        let bridge = bridge(&supervisor);
        Self { vehicles, supervisor, bridge, now: 0.0, states: Default::default(), orders: [0; 2], log: Vec::new() }
    }

    /// The second one says for some seconds that it is on this map.
    fn lasts(&mut self, time: f64, map: &str) {
        let [to_manager, to_vehicles] = interfaces();
        let until = self.now + time;
        while self.now < until {
            self.now += 0.1;
            for (k, vehicle) in self.vehicles.iter_mut().enumerate() {
                vehicle.tell_state();
                for (kind, payload) in vehicle.out().into_iter().filter(|(kind, _)| *kind == TopicKind::State) {
                    let mut state: Value = serde_json::from_slice(&payload).unwrap();
                    state["agvPosition"]["mapId"] = json!(if k == 1 { map } else { "map" });
                    let topic = to_vehicles.topic(ProtocolVersion::V2_1, vehicle.key(), kind);
                    self.bridge.receive(&mut self.supervisor, &topic, state.to_string().as_bytes(), self.now);
                }
            }
            let events = self.supervisor.settle(self.now).unwrap();
            self.bridge.settled(&mut self.supervisor, &events, self.now);
            for message in self.bridge.out() {
                let is_of = |key: &VehicleId| usize::from(key.serial_number == "b");
                if let Some((_, key, TopicKind::State)) = to_manager.parse(&message.topic) {
                    self.states[is_of(&key)] = serde_json::from_slice(&message.payload).unwrap();
                } else if let Some((_, key, TopicKind::Order)) = to_vehicles.parse(&message.topic) {
                    self.orders[is_of(&key)] += 1;
                } else if let Some((_, key, kind)) = to_vehicles.parse(&message.topic) {
                    self.vehicles[is_of(&key)].receive(kind, &message.payload);
                }
            }
            self.log.extend(self.bridge.log());
        }
    }

    fn order(&mut self, name: &str, x: f64, map: &str) {
        let node = |k: usize| {
            json!({ "nodeId": format!("n{k}"), "sequenceId": 2 * k, "released": true, "actions": [],
                "nodePosition": { "x": x + 5.0 * k as f64, "y": 0.0, "mapId": map } })
        };
        let edge = json!({ "edgeId": "e", "sequenceId": 1, "released": true, "actions": [], "startNodeId": "n0", "endNodeId": "n1" });
        let order = json!({ "headerId": 1, "timestamp": "2030-01-01T00:00:00.000Z", "version": "2.1.0", "manufacturer": "sim",
            "serialNumber": name, "orderId": name, "orderUpdateId": 0, "nodes": [node(0), node(1)], "edges": [edge] });
        let topic = interfaces()[0].topic(ProtocolVersion::V2_1, &key(name), TopicKind::Order);
        self.bridge.receive(&mut self.supervisor, &topic, order.to_string().as_bytes(), self.now);
    }

    fn errors(&self, k: usize) -> String {
        self.states[k]["errors"].to_string()
    }
}

/// One stood in the way of the other for ever, and nobody was told.
#[test]
fn a_vehicle_on_another_map_is_named_and_not_taken() {
    let mut own = Pair::new([0.0, 0.2]);
    own.lasts(1.0, "upstairs");
    own.order("a", 0.0, "map");
    own.lasts(31.0, "upstairs");
    assert!(own.supervisor.robot("sim/b").is_err());
    let said = "position.mapId: \"upstairs\"; other vehicles are on \"map\"";
    assert!(own.errors(1).replace('\\', "").contains(said), "{}", own.errors(1));
    assert!(own.log.iter().any(|line| line.starts_with("sim/b stands nowhere that counts (position.mapId")));
    assert_eq!(own.orders, [0; 2]);
    assert!(own.errors(0).contains("sim/b stands nowhere that counts"), "{}", own.errors(0));
    // It comes down elsewhere.
    own.vehicles[1] = SimulatedVehicle::new(
        key("b"),
        ProtocolVersion::V2_1,
        "map",
        CAN,
        StartPose { x: 0.0, y: 9.0, heading: 0.0 },
        1,
    );
    own.lasts(70.0, "map");
    assert_eq!(own.errors(1), "[]");
    assert!(own.supervisor.robot("sim/b").is_ok() && own.orders[0] > 0, "{:?}", own.orders);
}

#[test]
fn a_vehicle_that_goes_to_another_map_stays_where_it_was() {
    let mut own = Pair::new([0.0, 9.0]);
    own.lasts(1.0, "map");
    let start = |own: &Pair| own.supervisor.robot("sim/b").unwrap().course.start();
    let before = start(&own);
    own.lasts(10.0, "upstairs");
    assert_eq!(start(&own), before);
    assert!(own.errors(1).contains("upstairs"), "{}", own.errors(1));
    // The other one still gets its orders.
    own.order("a", 0.0, "map");
    own.lasts(1.0, "upstairs");
    assert!(own.orders[0] > 0);
    own.lasts(1.0, "map");
    assert_eq!(own.errors(1), "[]");
}

/// A supervisor that had just been started took an order on any map.
#[test]
fn an_order_on_another_map_is_refused_before_the_vehicle_says_anything() {
    for (map, taken) in [("map", true), ("upstairs", false)] {
        let mut own = Pair::new([0.0, 9.0]);
        own.lasts(1.0, "map");
        own.bridge = bridge(&own.supervisor);
        own.order("a", 0.0, map);
        let lane = own.bridge.lanes().next().unwrap();
        assert_eq!(lane.job().is_some(), taken, "{map}");
    }
}
