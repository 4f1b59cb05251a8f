//! Vehicles with outlines: what they are released, what the log says where their heading is not known, and what they must not do.

use crate::pair::{CAN, order};
use crate::site::{interfaces, settings};
use pcr_formats::vda5050::decode::MessageLimits;
use pcr_formats::vda5050::state::State;
use pcr_formats::vda5050::topics::{TopicKind, VehicleId};
use pcr_formats::vda5050::version::ProtocolVersion;
use pcr_serve::journal_entry::NullStore;
use pcr_serve::owned_path::StartPose;
use pcr_serve::robot::{Alarm, SupervisedRobot};
use pcr_serve::supervisor::Supervisor;
use pcr_serve::vda5050::bridge::{self, Vda5050Bridge};
use pcr_serve::vda5050::vehicle_adapter::VehicleConfig;
use pcr_serve::vehicles::simulated_site::profile;
use pcr_serve::vehicles::vehicle::SimulatedVehicle;
use pcr_serve::vehicles::vehicle_motion::SimulatedTraits;
use serde_json::{Value, json};
use std::f64::consts::{FRAC_PI_2, PI};

const VERSION: ProtocolVersion = ProtocolVersion::V2_1;
const STEP: f64 = 0.1;

/// Trucks, their supervisor, and a manager that sends what the test says.
struct Trucks {
    vehicles: Vec<SimulatedVehicle>,
    profiles: Vec<VehicleConfig>,
    supervisor: Supervisor,
    bridge: Vda5050Bridge,
    states: Vec<Option<State>>,
    log: Vec<String>,
    time: f64,
    header: u64,
    /// By how much the reported headings are wrong \[rad\].
    lies: f64,
}

fn key(place: usize) -> VehicleId {
    VehicleId::new("sim", &place.to_string()).unwrap()
}

/// A truck 1.2 m long and 0.8 m wide.
const TRUCK: SimulatedTraits = SimulatedTraits { rectangle: Some([1.2, 0.8]), noise: 0.005, ..CAN };

fn truck(place: usize) -> VehicleConfig {
    profile(key(place), &TRUCK)
}

fn bridge_of(profiles: &[VehicleConfig], supervisor: &Supervisor) -> Vda5050Bridge {
    let [manager, vehicles] = interfaces();
    let settings = bridge::BridgeConfig { manager, vehicles, limits: MessageLimits::default() };
    Vda5050Bridge::new(settings, profiles.to_vec(), supervisor).unwrap()
}

/// A state with another heading.
fn turned(payload: &[u8], by: f64) -> Vec<u8> {
    let mut state: Value = serde_json::from_slice(payload).unwrap();
    state["agvPosition"]["theta"] = (state["agvPosition"]["theta"].as_f64().unwrap() + by).into();
    state.to_string().into_bytes()
}

impl Trucks {
    fn new(starts: &[[f64; 3]]) -> Self {
        let vehicle = |(place, &[x, y, heading]): (usize, &[f64; 3])| {
            SimulatedVehicle::new(key(place), VERSION, "map", TRUCK, StartPose { x, y, heading }, place as u64)
        };
        let vehicles: Vec<_> = starts.iter().enumerate().map(vehicle).collect();
        let supervisor = Supervisor::new(settings(), Box::new(NullStore));
        let profiles: Vec<_> = (0..starts.len()).map(truck).collect();
        let bridge = bridge_of(&profiles, &supervisor);
        let states = vec![None; starts.len()];
        let mut own =
            Self { vehicles, profiles, supervisor, bridge, states, log: Vec::new(), time: 0.0, header: 0, lies: 0.0 };
        own.lasts(1.0);
        assert_eq!(own.supervisor.robots().len(), starts.len(), "{:?}", own.log);
        own
    }

    fn lasts(&mut self, time: f64) {
        let [manager, vehicles] = interfaces();
        let until = self.time + time;
        while self.time < until {
            self.time += STEP;
            for vehicle in &mut self.vehicles {
                vehicle.advance(STEP);
                vehicle.tell_state();
                for (kind, payload) in vehicle.out() {
                    let payload = if kind == TopicKind::State { turned(&payload, self.lies) } else { payload };
                    let topic = vehicles.topic(VERSION, vehicle.key(), kind);
                    self.bridge.receive(&mut self.supervisor, &topic, &payload, self.time);
                }
            }
            let events = self.supervisor.settle(self.time).unwrap();
            self.bridge.settled(&mut self.supervisor, &events, self.time);
            self.log.extend(self.bridge.log());
            for message in self.bridge.out() {
                if let Some((_, key, kind)) = vehicles.parse(&message.topic) {
                    let to = self.vehicles.iter_mut().find(|vehicle| *vehicle.key() == key);
                    to.unwrap().receive(kind, &message.payload);
                } else if let Some((_, key, TopicKind::State)) = manager.parse(&message.topic) {
                    let place: usize = key.serial_number.parse().unwrap();
                    self.states[place] = Some(serde_json::from_slice(&message.payload).unwrap());
                }
            }
        }
    }

    fn says(&mut self, place: usize, mut message: Value) {
        self.header += 1;
        let header = json!({ "headerId": self.header, "timestamp": "2030-01-01T00:00:00.000Z", "version": "2.1.0",
            "manufacturer": "sim", "serialNumber": place.to_string() });
        message.as_object_mut().unwrap().extend(header.as_object().unwrap().clone());
        let topic = interfaces()[0].topic(VERSION, &key(place), TopicKind::Order);
        self.bridge.receive(&mut self.supervisor, &topic, message.to_string().as_bytes(), self.time);
    }

    fn order(&mut self, place: usize, id: &str, places: &[[f64; 2]]) {
        self.says(place, order(id, 0, 0, places, places.len()));
    }

    fn robot(&self, place: usize) -> &SupervisedRobot {
        self.supervisor.robot(&key(place).to_string()).unwrap()
    }

    /// Whether a vehicle may go to the end of its order.
    fn may_go(&self, place: usize) -> bool {
        let robot = self.robot(place);
        robot.course.length() > 0.0 && robot.granted == robot.course.length()
    }

    fn is_done(&self, place: usize, id: &str) -> bool {
        self.states[place].as_ref().is_some_and(|state| state.order_id == id && state.is_idle())
    }

    fn no_alarms(&self) {
        let alarmed: Vec<_> = self.supervisor.robots().iter().filter(|robot| robot.alarm.is_some()).collect();
        assert!(alarmed.is_empty(), "{alarmed:?}");
    }
}

#[test]
fn trucks_in_opposite_lanes_pass_each_other() {
    let mut own = Trucks::new(&[[0.0, 0.0, 0.0], [20.0, 0.9, PI]]);
    own.order(0, "a", &[[0.0, 0.0], [10.0, 0.0], [20.0, 0.0]]);
    own.order(1, "b", &[[20.0, 0.9], [10.0, 0.9], [0.0, 0.9]]);
    own.lasts(0.3);
    assert!(own.may_go(0) && own.may_go(1), "{:?}", own.log);
    own.lasts(40.0);
    own.no_alarms();
    assert!(own.is_done(0, "a") && own.is_done(1, "b"));
}

/// The second truck waits until the first one has turned and gone on; both come to their ends.
#[test]
fn trucks_turn_at_nodes_and_come_to_their_ends() {
    let mut own = Trucks::new(&[[0.0, 0.0, 0.0], [20.0, 0.9, PI]]);
    own.order(0, "a", &[[0.0, 0.0], [10.0, 0.0], [10.0, -6.0]]);
    own.order(1, "b", &[[20.0, 0.9], [10.0, 0.9], [0.0, 0.9]]);
    own.lasts(0.3);
    // A truck that turns at (10, 0) reaches into the other lane.
    assert!(own.may_go(0) != own.may_go(1), "{:?}", own.log);
    own.lasts(60.0);
    own.no_alarms();
    assert!(own.is_done(0, "a") && own.is_done(1, "b"), "{:?}", own.states);
    // The next order begins where the last one has led, with its heading.
    own.order(0, "c", &[[10.0, -6.0], [10.0, -12.0], [4.0, -12.0]]);
    own.lasts(40.0);
    own.no_alarms();
    assert!(own.is_done(0, "c"), "{:?}", own.states[0]);
}

/// A restart within an order with turns: lengths of its path are the same as before.
#[test]
fn orders_with_turns_go_on_after_a_restart() {
    for stop in [3.0, 11.0, 12.5, 14.0] {
        let mut own = Trucks::new(&[[0.0, 0.0, FRAC_PI_2], [20.0, 0.9, PI]]);
        own.order(0, "a", &[[0.0, 0.0], [5.0, 0.0], [5.0, -5.0]]);
        own.lasts(stop);
        let entries = own.supervisor.snapshot().unwrap();
        own.supervisor = Supervisor::restored(settings(), entries, Box::new(NullStore)).unwrap();
        own.bridge = bridge_of(&own.profiles, &own.supervisor);
        own.lasts(60.0);
        own.no_alarms();
        assert!(own.is_done(0, "a"), "{stop}: {:?}", own.states[0]);
    }
}

#[test]
fn a_truck_of_unknown_heading_is_its_disc_and_the_log_says_why() {
    let mut own = Trucks::new(&[[0.0, 0.0, 0.0], [20.0, 0.9, PI]]);
    let mut free = order("a", 0, 0, &[[0.0, 0.0], [20.0, 0.0]], 2);
    free["edges"][0]["rotationAllowed"] = true.into();
    own.says(0, free);
    own.order(1, "b", &[[20.0, 0.9], [0.0, 0.9]]);
    own.lasts(0.3);
    assert!(!own.may_go(0) || !own.may_go(1));
    let said = own.log.iter().find(|line| line.contains("disc around its outline")).expect("a line of the log");
    assert!(said.starts_with("sim/0: order \"a\"") && said.contains("it may rotate on edges[0]"), "{said}");
    // A type that is not known is refused, and said to the manager.
    let mut odd = order("c", 0, 0, &[[20.0, 0.9], [0.0, 0.9]], 2);
    odd["edges"][0]["orientationType"] = "LOCAL".into();
    let mut own = Trucks::new(&[[20.0, 0.9, PI]]);
    own.says(0, odd);
    own.lasts(0.3);
    let errors = serde_json::to_string(&own.states[0].as_ref().unwrap().errors).unwrap();
    assert!(errors.contains("neither TANGENTIAL nor GLOBAL"), "{errors}");
}

/// The position is right and the heading is not: the truck is across its lane.
#[test]
fn a_truck_across_its_lane_is_off_its_path() {
    let mut own = Trucks::new(&[[0.0, 0.0, 0.0], [20.0, 0.9, PI]]);
    own.order(0, "a", &[[0.0, 0.0], [20.0, 0.0]]);
    own.order(1, "b", &[[20.0, 0.9], [0.0, 0.9]]);
    own.lasts(5.0);
    own.no_alarms();
    own.vehicles[0].tell_state();
    let (_, payload) = own.vehicles[0].out().pop().unwrap();
    let mut state: Value = serde_json::from_slice(&payload).unwrap();
    state["agvPosition"]["theta"] = 0.5.into();
    let topic = interfaces()[1].topic(VERSION, &key(0), TopicKind::State);
    own.bridge.receive(&mut own.supervisor, &topic, state.to_string().as_bytes(), own.time);
    own.supervisor.settle(own.time).unwrap();
    assert!(matches!(own.robot(0).alarm, Some(Alarm::Off { .. })), "{:?}", own.robot(0).alarm);
    assert_eq!(own.robot(1).stopped.as_deref(), Some("sim/0"));
}

/// The contour of the factsheet is compared with the outline of the file.
#[test]
fn a_truck_that_reaches_beyond_its_outline_keeps_all_from_moving() {
    let mut own = Trucks::new(&[[0.0, 0.0, 0.0], [20.0, 0.9, PI]]);
    let sheet = |own: &mut Trucks| {
        own.vehicles[0].tell_factsheet();
        let (_, payload) = own.vehicles[0].out().pop().unwrap();
        serde_json::from_slice::<Value>(&payload).unwrap()
    };
    let tell = |own: &mut Trucks, sheet: Value| {
        let topic = interfaces()[1].topic(VERSION, &key(0), TopicKind::Factsheet);
        own.bridge.receive(&mut own.supervisor, &topic, sheet.to_string().as_bytes(), own.time);
    };
    let right = sheet(&mut own);
    tell(&mut own, right);
    own.order(0, "a", &[[0.0, 0.0], [3.0, 0.0]]);
    own.lasts(8.0);
    assert!(own.is_done(0, "a"), "{:?}", own.log);
    // It is within the disc around the outline, and 5 cm wider than the outline.
    let mut wide = sheet(&mut own);
    for corner in wide["agvGeometry"]["envelopes2d"][0]["polygonPoints"].as_array_mut().unwrap() {
        corner["x"] = (corner["x"].as_f64().unwrap() * 0.5).into();
        corner["y"] = (corner["y"].as_f64().unwrap() * 1.125).into();
    }
    tell(&mut own, wide);
    own.order(1, "b", &[[20.0, 0.9], [15.0, 0.9]]);
    own.lasts(35.0);
    assert!(!own.is_done(1, "b"));
    assert!(
        own.log.iter().any(|line| line.contains("sim/0 is not as the file says")
            && line.contains("reaches 0.050 m beyond its outline")),
        "{:?}",
        own.log
    );
}

/// While its heading is not known, it raises no alarm; the next order has an outline again only if the truck stands as its path has led it.
#[test]
fn a_truck_is_an_outline_again_when_it_says_how_it_stands() {
    for (turned, is_disc) in [(0.0, false), (1.0, true)] {
        let mut own = Trucks::new(&[[0.0, 0.0, 0.0]]);
        let mut free = order("a", 0, 0, &[[0.0, 0.0], [4.0, 0.0]], 2);
        free["edges"][0]["rotationAllowed"] = true.into();
        own.says(0, free);
        own.lasts(2.0);
        assert!(own.robot(0).any_heading);
        own.lies = turned;
        own.lasts(10.0);
        own.no_alarms();
        assert!(own.is_done(0, "a") && own.robot(0).any_heading, "{:?}", own.states);
        own.order(0, "b", &[[4.0, 0.0], [8.0, 0.0]]);
        own.lasts(0.2);
        let is_said = own.log.iter().any(|line| line.contains("it does not stand as its path has led it"));
        assert_eq!(is_said, is_disc, "{:?}", own.log);
        assert!(own.robot(0).any_heading || !is_disc);
        own.lasts(12.0);
        own.no_alarms();
        assert!(own.is_done(0, "b"));
    }
}

/// It had an alarm for ever, and so no other order.
#[test]
fn a_truck_that_turns_at_the_end_of_its_order_stands_as_it_says() {
    let mut own = Trucks::new(&[[0.0, 0.0, 0.0], [4.0, 0.9, PI]]);
    own.order(0, "a", &[[0.0, 0.0], [4.0, 0.0]]);
    own.lasts(8.0);
    assert!(own.is_done(0, "a"));
    own.lies = 0.3;
    own.lasts(1.0);
    assert!(matches!(own.robot(0).alarm, Some(Alarm::Off { .. })), "{:?}", own.robot(0).alarm);
    own.lasts(3.0);
    own.no_alarms();
    assert!((own.robot(0).course.start().heading - 0.3).abs() < 1e-9, "{:?}", own.robot(0).course);
    own.lies = 0.0;
    own.lasts(5.0);
    own.no_alarms();
    own.order(0, "b", &[[4.0, 0.0], [8.0, 0.0]]);
    own.lasts(10.0);
    assert!(own.is_done(0, "b"), "{:?}", own.log);
}
