//! Vehicles that are away, and vehicles that have not said where they stand: who waits for them, and who is told.

use crate::pair::CAN;
use crate::site::{interfaces, settings};
use pcr_formats::vda5050::decode::MessageLimits;
use pcr_formats::vda5050::timestamp;
use pcr_formats::vda5050::topics::{TopicKind, VehicleId};
use pcr_formats::vda5050::version::ProtocolVersion;
use pcr_serve::closed_area::ClosedArea;
use pcr_serve::event::SupervisorEvent;
use pcr_serve::journal_entry::NullStore;
use pcr_serve::owned_path::StartPose;
use pcr_serve::robot::Alarm;
use pcr_serve::supervisor::{StandingPlace, Supervisor};
use pcr_serve::vda5050::bridge::{BridgeConfig, Vda5050Bridge};
use pcr_serve::vda5050::vehicle_adapter::VehicleConfig;
use pcr_serve::vehicles::simulated_site::profile;
use serde_json::{Value, json};
use std::collections::HashMap;

/// Vehicles that say what the test says, their manager, and the supervisor.
struct Absence {
    profiles: Vec<VehicleConfig>,
    supervisor: Supervisor,
    bridge: Vda5050Bridge,
    time: f64,
    number: u64,
    /// The last `stateRequest` that each vehicle got; it names it in its states.
    asked: HashMap<String, String>,
    /// How many orders and updates each vehicle got.
    orders: HashMap<String, usize>,
    /// What the manager was told last of each vehicle.
    told: HashMap<String, Value>,
    events: Vec<SupervisorEvent>,
}

fn key(serial: &str) -> VehicleId {
    VehicleId::new("sim", serial).unwrap()
}

fn bridge_of(profiles: &[VehicleConfig], supervisor: &mut Supervisor) -> Vda5050Bridge {
    let [manager, vehicles] = interfaces();
    let config = BridgeConfig { manager, vehicles, limits: MessageLimits::default() };
    let mut bridge = Vda5050Bridge::new(config, profiles.to_vec(), supervisor).unwrap();
    bridge.prepare(supervisor);
    bridge
}

impl Absence {
    /// Vehicles 1 and 2; 2 is away, or may stand at places.
    fn new(away: Option<bool>, places: &[[f64; 2]]) -> Self {
        let places = places.iter().map(|&[x, y]| StandingPlace { x, y, radius: 0.1 }).collect();
        let second = VehicleConfig { away, places, ..profile(key("2"), &CAN) };
        let profiles = vec![profile(key("1"), &CAN), second];
        let mut supervisor = Supervisor::new(settings(), Box::new(NullStore));
        let bridge = bridge_of(&profiles, &mut supervisor);
        let (asked, orders, told) = (HashMap::new(), HashMap::new(), HashMap::new());
        Self { profiles, supervisor, bridge, time: 0.0, number: 0, asked, orders, told, events: Vec::new() }
    }

    fn restart(&mut self) {
        let entries = self.supervisor.snapshot().unwrap();
        self.supervisor = Supervisor::restored(settings(), entries, Box::new(NullStore)).unwrap();
        self.bridge = bridge_of(&self.profiles, &mut self.supervisor);
        self.time = 0.0;
    }

    /// A vehicle without an order says that it is there, and what follows.
    fn says(&mut self, serial: &str, [x, y]: [f64; 2], driving: bool) {
        self.number += 1;
        let asked = self.asked.get(serial).map(|id| json!({ "actionId": id, "actionStatus": "FINISHED" }));
        let state = json!({ "headerId": self.number, "timestamp": timestamp::written(1.9e9 + self.number as f64),
            "version": "2.1.0", "manufacturer": "sim", "serialNumber": serial, "orderId": "", "orderUpdateId": 0,
            "lastNodeId": "", "lastNodeSequenceId": 0, "nodeStates": [], "edgeStates": [], "driving": driving,
            "actionStates": asked.into_iter().collect::<Vec<_>>(), "errors": [], "operatingMode": "AUTOMATIC",
            "agvPosition": { "x": x, "y": y, "theta": 0.0, "mapId": "map", "positionInitialized": true } });
        let topic = interfaces()[1].topic(ProtocolVersion::V2_1, &key(serial), TopicKind::State);
        self.bridge.receive(&mut self.supervisor, &topic, state.to_string().as_bytes(), self.time);
        self.turn();
    }

    /// The same until it is believed.
    fn stands(&mut self, serial: &str, place: [f64; 2]) {
        for _ in 0..4 {
            self.time += 0.1;
            self.says(serial, place, false);
        }
    }

    fn turn(&mut self) {
        let [manager, vehicles] = interfaces();
        let events = self.supervisor.settle(self.time).unwrap();
        self.bridge.settled(&mut self.supervisor, &events, self.time);
        self.events.extend(events);
        for message in self.bridge.out() {
            let said: Value = serde_json::from_slice(&message.payload).unwrap();
            if let Some((_, key, TopicKind::State)) = manager.parse(&message.topic) {
                self.told.insert(key.serial_number, said);
            } else if let Some((_, key, kind)) = vehicles.parse(&message.topic) {
                *self.orders.entry(key.serial_number.clone()).or_default() += usize::from(kind == TopicKind::Order);
                for action in said["actions"].as_array().into_iter().flatten() {
                    if action["actionType"] == "stateRequest" {
                        let id = action["actionId"].as_str().unwrap().to_owned();
                        self.asked.insert(key.serial_number.clone(), id);
                    }
                }
            }
        }
        let events = self.supervisor.settle(self.time).unwrap();
        self.events.extend(events);
    }

    /// Time passes, and nobody says anything.
    fn waits(&mut self, time: f64) {
        let until = self.time + time;
        while self.time < until {
            self.time += 0.1;
            self.turn();
        }
    }

    /// An order to go straight ahead.
    fn order(&mut self, serial: &str, id: &str, x: f64, length: f64) {
        let node = |k: u64, x: f64| {
            json!({ "nodeId": format!("n{k}"), "sequenceId": 2 * k, "released": true, "actions": [],
                "nodePosition": { "x": x, "y": 0.0, "mapId": "map" } })
        };
        let edge = json!({ "edgeId": "e", "sequenceId": 1, "released": true, "actions": [], "startNodeId": "n0", "endNodeId": "n1" });
        let order = json!({ "headerId": 1, "timestamp": "2030-01-01T00:00:00.000Z", "version": "2.1.0", "manufacturer": "sim",
            "serialNumber": serial, "orderId": id, "orderUpdateId": 0, "nodes": [node(0, x), node(1, x + length)], "edges": [edge] });
        let topic = interfaces()[0].topic(ProtocolVersion::V2_1, &key(serial), TopicKind::Order);
        self.bridge.receive(&mut self.supervisor, &topic, order.to_string().as_bytes(), self.time);
        self.turn();
    }

    fn orders(&self, serial: &str) -> usize {
        self.orders.get(serial).copied().unwrap_or(0)
    }

    fn granted(&self, name: &str) -> f64 {
        self.supervisor.robot(name).unwrap().granted
    }

    /// What the manager reads in the state of a vehicle about whom others wait for.
    fn notices(&self, serial: &str) -> Vec<String> {
        let errors = self.told.get(serial).and_then(|state| state["errors"].as_array()).into_iter().flatten();
        let waits = errors.filter(|error| error["errorType"] == "waitsForVehicle");
        waits.map(|error| error["errorDescription"].as_str().unwrap().to_owned()).collect()
    }

    fn unplaced(&self) -> Vec<String> {
        self.supervisor.unplaced().map(|(name, why)| format!("{name} {why}")).collect()
    }
}

/// A gate at x = 5 m, closed or with a limited speed.
fn gate(speed: Option<f64>) -> ClosedArea {
    let start = StartPose { x: 5.0, y: 0.0, heading: 0.0 };
    ClosedArea { name: "gate".into(), start, path: Vec::new(), more: Vec::new(), radius: 0.5, of: None, speed }
}

/// A person closes an area by a line, and the manager and its vehicle see what follows.
#[test]
fn the_manager_is_told_what_is_closed_and_no_vehicle_is_released_into_it() {
    let mut own = Absence::new(None, &[]);
    own.supervisor.set_away("sim/2", true).unwrap();
    own.stands("1", [0.0, 0.0]);
    own.supervisor.close(gate(None)).unwrap();
    own.order("1", "a", 0.0, 10.0);
    own.waits(3.0);
    let errors = own.told["1"]["errors"].as_array().unwrap();
    let closed: Vec<&Value> = errors.iter().filter(|error| error["errorType"] == "closed").collect();
    assert!(closed.len() == 1 && closed[0]["errorDescription"] == "gate is closed", "{errors:?}");
    assert!(own.granted("sim/1") < 5.0, "{}", own.granted("sim/1"));
    own.supervisor.open("gate").unwrap();
    own.waits(3.0);
    let errors = own.told["1"]["errors"].as_array().unwrap();
    assert!(errors.iter().all(|error| error["errorType"] != "closed"), "{errors:?}");
    assert!(own.granted("sim/1") > 9.0, "{}", own.granted("sim/1"));
}

const NOBODY: &str =
    "sim/2 has not said where it stands, so no vehicle is released anything: switch it on, or say that it is away";
const SOME: &str = "sim/2 has not said where it stands, so others keep away from the places where it may stand: switch it on, or say that it is \
     away";

/// It was said after 30 s, in the log only, and nobody went on.
#[test]
fn who_is_missing_is_said_everywhere_within_a_second_and_one_that_is_away_blocks_nobody() {
    let mut own = Absence::new(None, &[]);
    own.stands("1", [0.0, 0.0]);
    own.order("1", "a", 0.0, 10.0);
    own.waits(0.5);
    assert!(own.time < 1.1 && own.orders("1") == 0, "{}", own.time);
    let event = SupervisorEvent::Unplaced { robot: "sim/2".into(), why: NOBODY["sim/2 ".len()..].into() };
    assert!(own.events.contains(&event), "{:?}", own.events);
    assert_eq!((own.unplaced(), own.notices("1")), (vec![NOBODY.to_owned()], vec![NOBODY.to_owned()]));
    assert_eq!(own.bridge.unready().as_deref(), Some(NOBODY));
    // A line says that it is away, and a restart keeps that.
    own.supervisor.set_away("sim/2", true).unwrap();
    own.waits(0.2);
    assert!(own.orders("1") > 0 && own.granted("sim/1") > 9.0);
    assert!(own.unplaced().is_empty() && own.notices("1").is_empty() && own.bridge.unready().is_none());
    assert!(own.events.contains(&SupervisorEvent::Placed { robot: "sim/2".into() }));
    own.restart();
    own.stands("1", [0.0, 0.0]);
    assert!(own.bridge.unready().is_none() && own.supervisor.is_away("sim/2"));
    // It gets no orders, and is waited for again when it is said not to be away.
    own.order("2", "b", 0.0, 1.0);
    assert!(own.supervisor.robot("sim/2").is_err());
    own.supervisor.set_away("sim/2", false).unwrap();
    own.waits(0.7);
    assert_eq!(own.unplaced(), [NOBODY]);
    own.stands("2", [0.0, 30.0]);
    own.turn();
    assert!(own.unplaced().is_empty() && own.bridge.unready().is_none());
}

/// What the file says of places counts as long as the vehicle has not said anything.
#[test]
fn only_who_could_come_to_the_places_of_a_vehicle_waits_for_it() {
    for (place, limit) in [([6.0, 0.0], Some(5.1)), ([6.0, 9.0], None)] {
        let mut own = Absence::new(None, &[[0.0, 40.0], place]);
        own.stands("1", [0.0, 0.0]);
        own.order("1", "a", 0.0, 10.0);
        own.waits(0.7);
        assert_eq!(own.unplaced(), [SOME]);
        assert!(own.bridge.unready().is_none() && own.orders("1") > 0, "it goes as far as it may");
        let granted = own.granted("sim/1");
        assert!(limit.map_or(granted > 9.9, |most| granted > 3.0 && granted < most), "{granted}");
        // It stands at the other place.
        own.stands("2", [0.0, 40.0]);
        own.waits(0.2);
        assert!(own.granted("sim/1") > 9.9 && own.unplaced().is_empty());
    }
    // One that drives may be anywhere.
    let mut own = Absence::new(None, &[[6.0, 9.0]]);
    own.stands("1", [0.0, 0.0]);
    own.says("2", [6.0, 9.0], true);
    own.waits(0.7);
    assert_eq!(own.unplaced(), [NOBODY]);
}

/// Who may already go to the places of a vehicle that is back, and has not said anything, stops.
#[test]
fn one_that_is_not_away_any_more_has_its_places() {
    let mut own = Absence::new(Some(true), &[[6.0, 0.0]]);
    own.stands("1", [0.0, 0.0]);
    own.order("1", "a", 0.0, 10.0);
    own.waits(0.2);
    assert!(own.granted("sim/1") > 9.9);
    own.supervisor.set_away("sim/2", false).unwrap();
    own.waits(0.2);
    let stop = SupervisorEvent::Stop { robot: "sim/1".into(), by: "sim/2".into() };
    assert!(own.events.contains(&stop), "{:?}", own.events);
    own.supervisor.set_away("sim/2", true).unwrap();
    own.waits(0.2);
    assert!(own.events.contains(&SupervisorEvent::Go { robot: "sim/1".into() }));
}

/// It says that it stands, or drives, in a route that another one was allowed; or elsewhere.
#[test]
fn one_that_is_away_and_says_something_is_where_it_says() {
    for (driving, restarts) in [(false, false), (false, true), (true, false), (true, true)] {
        for (place, is_in_the_way) in [([6.0, 0.0], true), ([6.0, 20.0], false)] {
            let mut own = Absence::new(Some(true), &[]);
            own.stands("1", [0.0, 0.0]);
            own.order("1", "a", 0.0, 10.0);
            own.waits(0.2);
            assert!(own.granted("sim/1") > 9.9 && own.orders("1") > 0);
            if restarts {
                own.profiles[1].away = None;
                own.restart();
                own.stands("1", [0.0, 0.0]);
                own.waits(0.2);
            }
            own.events.clear();
            own.says("2", place, driving);
            own.turn();
            let context = format!("{driving} {restarts} {place:?}: {:?}", own.events);
            assert!(
                !own.supervisor.is_away("sim/2")
                    && own.events.contains(&SupervisorEvent::Back { robot: "sim/2".into() }),
                "{context}"
            );
            let is_alarm = own.events.iter().any(
                |event| matches!(event, SupervisorEvent::Alarm { robot, alarm: Alarm::Off { .. } } if robot == "sim/2"),
            );
            let stop = SupervisorEvent::Stop { robot: "sim/1".into(), by: "sim/2".into() };
            assert_eq!(is_alarm, driving || is_in_the_way, "{context}");
            assert_eq!(own.events.contains(&stop), is_in_the_way, "{context}");
            if !driving {
                // It stands there, as it says again: no alarm, but the other one must not go on.
                own.stands("2", place);
                assert!(own.supervisor.robot("sim/2").unwrap().alarm.is_none());
                assert_eq!(own.supervisor.robot("sim/1").unwrap().stopped.is_some(), is_in_the_way);
            }
        }
    }
}

/// It knows nothing of where it is: that does not contradict whoever said that it is away.
#[test]
fn one_that_is_away_and_knows_no_place_stays_away() {
    let mut own = Absence::new(Some(true), &[]);
    own.stands("1", [0.0, 0.0]);
    let topic = interfaces()[1].topic(ProtocolVersion::V2_1, &key("2"), TopicKind::State);
    let state = json!({ "headerId": 1, "timestamp": "2030-01-01T00:00:00Z", "version": "2.1.0", "manufacturer": "sim",
        "serialNumber": "2", "orderId": "", "orderUpdateId": 0, "lastNodeId": "", "lastNodeSequenceId": 0, "nodeStates": [],
        "edgeStates": [], "driving": false, "actionStates": [], "errors": [], "operatingMode": "MANUAL",
        "agvPosition": { "x": 0.0, "y": 0.0, "theta": 0.0, "mapId": "map", "positionInitialized": false } });
    own.bridge.receive(&mut own.supervisor, &topic, state.to_string().as_bytes(), own.time);
    own.turn();
    assert!(own.supervisor.is_away("sim/2") && own.supervisor.robot("sim/2").is_err());
}

/// Its place is known: it stays reserved until a person says that it was removed.
#[test]
fn one_that_is_away_keeps_its_place_until_it_is_removed() {
    let mut own = Absence::new(None, &[]);
    own.stands("1", [0.0, 0.0]);
    own.stands("2", [6.0, 0.0]);
    own.supervisor.set_away("sim/2", true).unwrap();
    own.turn();
    own.order("1", "a", 0.0, 10.0);
    own.waits(0.5);
    assert!(own.supervisor.robot("sim/1").unwrap().waiting.is_some(), "it stands there");
    own.restart();
    own.stands("1", [0.0, 0.0]);
    assert!(own.supervisor.is_away("sim/2") && own.bridge.unready().is_none());
    own.supervisor.remove("sim/2").unwrap();
    own.waits(3.0);
    assert!(own.granted("sim/1") > 9.9 && own.unplaced().is_empty());
}

impl Absence {
    /// The file of vehicles is read again.
    fn reload(&mut self, profiles: &[VehicleConfig]) -> Result<[Vec<String>; 2], String> {
        let taken = self.bridge.reload(&mut self.supervisor, profiles.to_vec());
        if taken.is_ok() {
            self.profiles = profiles.to_vec();
        }
        self.waits(0.2);
        taken
    }
}

/// A restart was needed, and everybody stood.
#[test]
fn vehicles_are_added_left_out_and_away_without_a_restart() {
    let mut own = Absence::new(Some(true), &[]);
    own.stands("1", [0.0, 0.0]);
    own.order("1", "a", 0.0, 10.0);
    own.waits(0.2);
    assert!(own.bridge.unready().is_none() && own.granted("sim/1") > 9.9);
    let orders = own.orders("1");
    assert!(orders > 0);
    // A third one is waited for until it says where it stands; then it has orders, too.
    let [first, second] = [own.profiles[0].clone(), own.profiles[1].clone()];
    let third = VehicleConfig { away: None, ..profile(key("3"), &CAN) };
    assert_eq!(own.reload(&[third.clone(), first.clone(), second.clone()]), Ok([vec!["sim/3".into()], Vec::new()]));
    assert!(own.bridge.unready().unwrap().contains("sim/3") && own.supervisor.is_away("sim/2"));
    own.stands("3", [0.0, 20.0]);
    own.waits(0.2);
    assert!(own.bridge.unready().is_none());
    // What was under way goes on.
    assert!(own.bridge.lanes().any(|lane| lane.name() == "sim/1" && lane.job().is_some()));
    // The second one is not away, and the file does not say so again after it came back by itself.
    let back = VehicleConfig { away: None, ..second.clone() };
    own.reload(&[first.clone(), third.clone(), back.clone()]).unwrap();
    assert!(!own.supervisor.is_away("sim/2") && own.bridge.unready().unwrap().contains("sim/2"));
    own.reload(&[first.clone(), third.clone(), second.clone()]).unwrap();
    assert!(own.supervisor.is_away("sim/2") && own.bridge.unready().is_none());
    own.stands("2", [0.0, 30.0]);
    own.reload(&[first.clone(), third, second]).unwrap();
    assert!(!own.supervisor.is_away("sim/2"), "the file says what it said before");
    // Whoever was removed can be left out, and is not there after a restart.
    own.supervisor.remove("sim/2").unwrap();
    own.supervisor.remove("sim/3").unwrap();
    assert_eq!(own.reload(&[first]), Ok([Vec::new(), vec!["sim/2".into(), "sim/3".into()]]));
    assert!(own.bridge.unready().is_none() && own.unplaced().is_empty());
    own.restart();
    own.stands("1", [0.0, 0.0]);
    assert!(own.bridge.unready().is_none() && own.supervisor.robots().len() == 1);
}

#[test]
fn what_cannot_be_changed_while_it_works_is_named_and_nothing_changes() {
    let mut own = Absence::new(None, &[]);
    own.stands("1", [0.0, 0.0]);
    own.stands("2", [0.0, 20.0]);
    let before = own.profiles.clone();
    let mut larger = before.clone();
    larger[1].abilities.radius = 0.9;
    larger.push(profile(key("3"), &CAN));
    let why = own.reload(&larger).unwrap_err();
    assert!(why.starts_with("sim/2: it has a place, so radius, "), "{why}");
    let why = own.reload(&[before[0].clone(), profile(key("3"), &CAN)]).unwrap_err();
    assert!(why.starts_with("sim/2: it has a place, so it cannot be left out: "), "{why}");
    let names: Vec<&str> = own.bridge.lanes().map(|lane| lane.name()).collect();
    assert_eq!((names, own.bridge.unready()), (vec!["sim/1", "sim/2"], None));
    // Once it was carried out, it may come back as another one.
    own.supervisor.remove("sim/2").unwrap();
    larger.truncate(2);
    own.reload(&larger).unwrap();
    own.stands("2", [0.0, 20.0]);
    assert_eq!(own.supervisor.robot("sim/2").unwrap().abilities.radius, 0.9);
}

/// A state told of each vehicle of the fleet that it had not said where it stands.
#[test]
fn the_manager_is_told_of_ten_vehicles_at_most_and_not_of_each_one_at_once() {
    let mut own = Absence::new(None, &[]);
    let all: Vec<VehicleConfig> = (1..40).map(|k| profile(key(&k.to_string()), &CAN)).collect();
    own.reload(&all).unwrap();
    own.stands("1", [0.0, 0.0]);
    own.waits(1.0);
    assert_eq!((own.unplaced().len(), own.notices("1").len()), (38, 10));
    let mut changes = 0;
    for k in 2..40 {
        let before = own.notices("1");
        own.time += 0.01;
        own.says(&k.to_string(), [0.0, 2.0 * f64::from(k)], false);
        own.says(&k.to_string(), [0.0, 2.0 * f64::from(k)], false);
        changes += u32::from(own.notices("1") != before);
    }
    assert!(changes <= 2, "{changes}");
    own.waits(0.5);
    assert!(own.unplaced().is_empty() && own.notices("1").is_empty());
}
