//! What vehicles, managers and brokers say that cannot be relied on: nobody is let go on for it.

use crate::pair::{CAN, key};
use crate::site::{interfaces, settings};
use pcr_formats::splitmix64::SplitMix64;
use pcr_formats::vda5050::decode::MessageLimits;
use pcr_formats::vda5050::timestamp::written;
use pcr_formats::vda5050::topics::TopicKind;
use pcr_formats::vda5050::version::ProtocolVersion;
use pcr_serve::journal_entry::NullStore;
use pcr_serve::owned_path::StartPose;
use pcr_serve::supervisor::Supervisor;
use pcr_serve::vda5050::bridge::{self, Vda5050Bridge};
use pcr_serve::vehicles::simulated_site::profile;
use pcr_serve::vehicles::vehicle::SimulatedVehicle;
use serde_json::{Value, json};

/// The time at which a message was written \[s\].
fn seconds(message: &Value) -> f64 {
    pcr_formats::import::seconds(message["timestamp"].as_str().unwrap()).unwrap()
}

/// A vehicle with all of a way of 10 m along the x axis, in two edges.
struct Lone {
    vehicle: SimulatedVehicle,
    supervisor: Supervisor,
    bridge: Vda5050Bridge,
    time: f64,
}

impl Lone {
    fn standing() -> Self {
        let [manager, vehicles] = interfaces();
        let topics = bridge::BridgeConfig { manager, vehicles, limits: MessageLimits::default() };
        let supervisor = Supervisor::new(settings(), Box::new(NullStore));
        let bridge = Vda5050Bridge::new(topics, vec![profile(key(), &CAN)], &supervisor).unwrap();
        let start = StartPose { x: 0.0, y: 0.0, heading: 0.0 };
        let vehicle = SimulatedVehicle::new(key(), ProtocolVersion::V2_1, "map", CAN, start, 1);
        let mut own = Self { vehicle, supervisor, bridge, time: 0.0 };
        own.lasts(1.0);
        own
    }

    fn driving() -> Self {
        Self::driving_for(5.5)
    }

    fn driving_for(time: f64) -> Self {
        let mut own = Self::standing();
        own.order("a", 0.0, 1);
        own.lasts(time);
        let at = own.robot_at();
        assert!((2.0..5.0).contains(&at) && own.vehicle.taken() >= 1, "{at}");
        own
    }

    fn robot_at(&self) -> f64 {
        self.supervisor.robot("sim/001").unwrap().arc_length
    }

    fn has_alarm(&self) -> bool {
        self.supervisor.robot("sim/001").unwrap().alarm.is_some()
    }

    /// Of nodes 5 m apart, of which so many edges are released.
    fn order(&mut self, id: &str, x: f64, released: usize) {
        let node = |k: usize| {
            json!({ "nodeId": format!("n{k}"), "sequenceId": 2 * k, "released": k <= released, "actions": [],
                "nodePosition": { "x": x + 5.0 * k as f64, "y": 0.0, "mapId": "map" } })
        };
        let edge = |k: usize| {
            json!({ "edgeId": "e", "sequenceId": 2 * k + 1, "released": k < released, "actions": [],
                "startNodeId": format!("n{k}"), "endNodeId": format!("n{}", k + 1) })
        };
        let order = json!({ "headerId": 1, "timestamp": "2030-01-01T00:00:00.000Z", "version": "2.1.0", "manufacturer": "sim",
            "serialNumber": "001", "orderId": id, "orderUpdateId": 0, "nodes": [node(0), node(1), node(2)], "edges": [edge(0), edge(1)] });
        self.manager(TopicKind::Order, &order);
    }

    fn manager(&mut self, kind: TopicKind, message: &Value) {
        let topic = interfaces()[0].topic(ProtocolVersion::V2_1, &key(), kind);
        self.bridge.receive(&mut self.supervisor, &topic, message.to_string().as_bytes(), self.time);
    }

    /// What the vehicle says now.
    fn state(&mut self) -> Value {
        self.vehicle.tell_state();
        let said = self.vehicle.out().into_iter().rev().find(|(kind, _)| *kind == TopicKind::State).unwrap();
        serde_json::from_slice(&said.1).unwrap()
    }

    fn hears(&mut self, kind: TopicKind, message: &Value) {
        let topic = interfaces()[1].topic(ProtocolVersion::V2_1, &key(), kind);
        self.bridge.receive(&mut self.supervisor, &topic, message.to_string().as_bytes(), self.time);
    }

    /// What follows; how many orders were sent.
    fn turn(&mut self) -> usize {
        let events = self.supervisor.settle(self.time).unwrap();
        self.bridge.settled(&mut self.supervisor, &events, self.time);
        let out = self.bridge.out();
        let mut orders = 0;
        for message in out {
            if let Some((_, _, kind)) = interfaces()[1].parse(&message.topic) {
                orders += usize::from(kind == TopicKind::Order);
                self.vehicle.receive(kind, &message.payload);
            }
        }
        orders
    }

    fn lasts(&mut self, time: f64) -> usize {
        let (until, mut orders) = (self.time + time, 0);
        while self.time < until {
            self.time += 0.1;
            self.vehicle.advance(0.1);
            let state = self.state();
            self.hears(TopicKind::State, &state);
            orders += self.turn();
        }
        orders
    }
}

#[test]
fn a_late_state_ends_no_alarm() {
    let mut own = Lone::driving();
    let before = own.state();
    let mut off = own.state();
    off["agvPosition"]["y"] = json!(2.0);
    own.hears(TopicKind::State, &off);
    assert!(own.has_alarm());
    own.time += 1.0;
    own.hears(TopicKind::State, &before);
    own.turn();
    assert!(own.has_alarm());
    own.lasts(0.2);
    assert!(!own.has_alarm());
}

/// Late states are all as old as the newest one but a little: the first one made the alarm as old as that, and the next one ended it.
#[test]
fn late_states_end_no_alarm_one_after_the_other() {
    let mut own = Lone::driving();
    let before = own.state();
    let mut beyond = own.state();
    beyond["agvPosition"]["x"] = json!(4.9);
    let mut off = own.state();
    off["agvPosition"]["y"] = json!(2.0);
    own.hears(TopicKind::State, &off);
    assert!(own.has_alarm());
    own.time += 1.0;
    own.hears(TopicKind::State, &beyond);
    own.time += 0.1;
    own.hears(TopicKind::State, &before);
    own.turn();
    assert!(own.has_alarm());
    own.lasts(0.2);
    assert!(!own.has_alarm());
}

/// It was back where it may be as soon as it said between two states that it was not.
#[test]
fn a_position_between_states_that_is_back_ends_no_alarm() {
    let mut own = Lone::driving();
    let mut state = own.state();
    state["agvPosition"]["x"] = json!(own.robot_at() - 1.5);
    own.hears(TopicKind::State, &state);
    assert!(own.has_alarm());
    let (mut header, said) = (0, state.clone());
    let mut between = |own: &Lone, x: f64, stamp: &str| {
        let mut message = said.clone();
        header += 1;
        (message["headerId"], message["agvPosition"]["x"]) = (json!(header), json!(x));
        message["timestamp"] = json!(stamp);
        (message.to_string(), interfaces()[1].topic(ProtocolVersion::V2_1, &key(), TopicKind::Visualization), own.time)
    };
    // One of the same time may have been written before the state: it ends no alarm either.
    let [same, later] = [0.0, 0.1].map(|later| written(seconds(&state) + later));
    for (x, stamp, alarm) in
        [(own.robot_at() - 1.4, &later, true), (own.robot_at(), &same, true), (own.robot_at(), &later, false)]
    {
        let (text, topic, time) = between(&own, x, stamp);
        own.bridge.receive(&mut own.supervisor, &topic, text.as_bytes(), time);
        assert_eq!(own.has_alarm(), alarm, "{x}: {:?}", own.bridge.log());
    }
}

/// A message of the vehicle, written so long after its last state \[s\]; `x` is counted from the place that is known of it \[m\].
fn says(own: &Lone, state: &Value, kind: TopicKind, after: f64, [x, y]: [f64; 2]) -> Value {
    let mut message = state.clone();
    // Each kind has numbers of its own.
    let number = state["headerId"].as_u64().unwrap() * u64::from(kind == TopicKind::State);
    message["headerId"] = json!(number + 1 + (after.max(0.0) * 1e3) as u64);
    message["timestamp"] = json!(written(seconds(state) + after));
    message["agvPosition"]["x"] = json!(own.robot_at() + x);
    message["agvPosition"]["y"] = json!(y);
    message
}

/// A vehicle on its way was off it, by a state that came after a visualization but was written before.
#[test]
fn a_state_that_a_visualization_has_overtaken_neither_begins_nor_ends_an_alarm() {
    // Also where both have the same time: many vehicles know whole seconds only.
    for written_before in [0.3, 0.6] {
        let mut own = Lone::driving_for(4.5);
        let state = own.state();
        own.hears(TopicKind::State, &state);
        let [ahead, behind, back] = [[0.9, 0.0], [0.1, 0.0], [-0.9, 0.0]];
        let [late, first, second] = [(0.1, behind), (0.6, ahead), (written_before, behind)]
            .map(|(after, place)| says(&own, &state, TopicKind::State, after, place));
        let between = says(&own, &state, TopicKind::Visualization, 0.6, ahead);
        let at = own.robot_at();
        own.hears(TopicKind::Visualization, &between);
        assert!((own.robot_at() - at - 0.9).abs() < 0.5, "it counts: {at} {}", own.robot_at());
        for message in [&second, &late, &second] {
            own.time += 0.01;
            own.hears(TopicKind::State, message);
            own.turn();
            assert!(!own.has_alarm(), "{written_before}: {:?}", own.bridge.log());
        }
        let mut lost = second.clone();
        (lost["headerId"], lost["lastNodeSequenceId"]) = (json!(1 << 20), json!(1));
        own.hears(TopicKind::State, &lost);
        assert!(!own.has_alarm(), "on its way, behind where it was said to be");
        // It is off its way by a newer visualization as far as that tells, and then by a state: the older one does not end that.
        let off = says(&own, &first, TopicKind::State, 0.1, [0.0, 2.0]);
        own.hears(TopicKind::State, &off);
        assert!(own.has_alarm());
        own.hears(TopicKind::State, &second);
        own.turn();
        assert!(own.has_alarm());
        // What is written after the visualization counts at once, also where it is back.
        let mut own = Lone::driving_for(4.5);
        let state = own.state();
        let between = says(&own, &state, TopicKind::Visualization, 0.6, ahead);
        let later = says(&own, &state, TopicKind::State, 0.7, back);
        own.hears(TopicKind::Visualization, &between);
        own.hears(TopicKind::State, &later);
        assert!(own.has_alarm());
    }
}

/// States and visualizations of a vehicle that is always where it may be, in any order, with time stamps as exact as vehicles write them.
#[test]
fn a_vehicle_on_its_way_has_no_alarm_in_whatever_order_its_messages_come() {
    let (mut counted, mut overtaken) = (0, 0);
    for seed in 0..60 {
        let (mut dice, mut own) = (SplitMix64(seed), Lone::standing());
        own.order("a", 0.0, 1);
        own.lasts(1.0);
        let mut waiting: Vec<(f64, TopicKind, Value)> = Vec::new();
        let (mut number, mut newest) = (0, [0.0_f64; 2]);
        for _ in 0..80 {
            own.time += 0.1;
            own.vehicle.advance(0.1);
            let mut state = own.state();
            if seed % 2 == 1 {
                // Whole seconds, as many vehicles have them.
                state["timestamp"] = json!(written(seconds(&state).floor()));
            }
            let kind = if dice.below(3) == 0 { TopicKind::State } else { TopicKind::Visualization };
            if kind == TopicKind::Visualization {
                number += 1;
                state["headerId"] = json!(number);
            }
            waiting.push((own.time + 2.0 * dice.unit().powi(3), kind, state));
            let (come, later): (Vec<_>, Vec<_>) = waiting.into_iter().partition(|(at, ..)| *at <= own.time);
            waiting = later;
            for (_, kind, message) in come {
                let (at, stamp) = (own.robot_at(), seconds(&message));
                own.hears(kind, &message);
                assert!(!own.has_alarm(), "seed {seed}, at {} s: {message}", own.time);
                counted += usize::from(kind == TopicKind::Visualization && own.robot_at() > at);
                let [states, others] = &mut newest;
                overtaken += usize::from(kind == TopicKind::State && stamp > *states && stamp < *others);
                *(if kind == TopicKind::State { states } else { others }) =
                    stamp.max(if kind == TopicKind::State { *states } else { *others });
            }
            own.turn();
        }
        assert!(own.robot_at() > 4.0, "seed {seed}: {}", own.robot_at());
    }
    assert!(counted > 500 && overtaken > 50, "{counted} {overtaken}");
}

/// It could have said by one wrong time stamp that it is never off its way again.
#[test]
fn a_visualization_from_a_clock_that_is_wrong_hides_no_alarm() {
    for answers in [true, false] {
        let mut own = Lone::driving();
        let state = own.state();
        let between = says(&own, &state, TopicKind::Visualization, 3600.0, [0.1, 0.0]);
        own.hears(TopicKind::Visualization, &between);
        let mut said = 0;
        while !own.has_alarm() {
            said += 1;
            assert!(said < 100, "it is never off its way");
            own.time += 1.0;
            own.vehicle.advance(1.0);
            own.turn();
            let mut off = own.state();
            off["agvPosition"]["y"] = json!(2.0);
            if !answers {
                off["actionStates"] = json!([]);
            }
            own.hears(TopicKind::State, &off);
        }
        // With the answer to the request; without one, after the time by which any message comes.
        assert_eq!(said, if answers { 2 } else { 61 }, "{answers}");
    }
}

/// A state from before the vehicle was switched off and on had a higher number than all since then: it counted as the newest.
#[test]
fn a_state_from_before_a_vehicle_counts_anew_ends_no_alarm() {
    let mut own = Lone::driving();
    let mut old = own.state();
    old["headerId"] = json!(1000);
    own.hears(TopicKind::State, &old);
    own.vehicle.advance(0.1);
    let mut off = own.state();
    (off["headerId"], off["agvPosition"]["y"]) = (json!(1), json!(2.0));
    own.hears(TopicKind::State, &off);
    assert!(own.has_alarm());
    own.time += 1.0;
    own.hears(TopicKind::State, &old);
    own.turn();
    assert!(own.has_alarm());
}

/// None of its states counted until it had been on for as long as before.
#[test]
fn a_vehicle_whose_clock_begins_anew_is_heard() {
    for (is_online, is_deaf, has_clock) in
        [(false, false, true), (true, false, true), (false, true, true), (false, false, false), (true, true, false)]
    {
        let mut own = Lone::driving();
        own.lasts(10.0);
        let old = own.state();
        let before = own.robot_at();
        own.vehicle.forget();
        own.vehicle.set_clock(-1e6);
        if is_online {
            let online: Value = serde_json::from_slice(&own.vehicle.connection("ONLINE")).unwrap();
            own.hears(TopicKind::Connection, &online);
        }
        // It has rolled away.
        let mut said = 0;
        while !own.has_alarm() {
            said += 1;
            assert!(said < 100, "it is not heard");
            own.time += 1.0;
            own.vehicle.advance(1.0);
            let mut off = own.state();
            off["agvPosition"]["y"] = json!(3.0);
            if !has_clock {
                off["timestamp"] = json!("0000-00-00T00:00:00Z");
            }
            if !is_deaf {
                own.turn();
                let state = own.state();
                off["actionStates"] = state["actionStates"].clone();
            }
            own.hears(TopicKind::State, &off);
        }
        let expected = if is_deaf {
            62
        } else if is_online {
            1
        } else {
            4
        };
        assert_eq!(said, expected, "{is_online} {is_deaf} {has_clock}");
        // Those of before are older, whatever their clock said, and so is what it said between them.
        own.time += 0.1;
        own.hears(TopicKind::State, &old);
        own.hears(TopicKind::Visualization, &old);
        assert!(own.has_alarm() && own.robot_at() == before);
    }
}

/// All that had been on its way from a vehicle that is not heard any more, in the order in which it was written.
#[test]
fn late_states_in_a_row_end_no_alarm() {
    let mut own = Lone::driving();
    let mut late: Vec<Value> = Vec::new();
    for _ in 0..20 {
        own.vehicle.advance(0.1);
        late.push(own.state());
    }
    let mut off = own.state();
    off["agvPosition"]["y"] = json!(2.0);
    own.hears(TopicKind::State, &off);
    let online: Value = serde_json::from_slice(&own.vehicle.connection("ONLINE")).unwrap();
    own.hears(TopicKind::Connection, &online);
    for state in late {
        own.time += 1.0;
        own.turn();
        own.hears(TopicKind::State, &state);
        assert!(own.has_alarm());
    }
}

/// It rolled back to where others may have been let through.
#[test]
fn a_vehicle_that_goes_back_is_not_where_it_may_be() {
    let mut own = Lone::driving();
    let at = own.robot_at();
    for (back, alarm) in [(0.05, false), (1.5, true), (0.0, false)] {
        let mut state = own.state();
        state["agvPosition"]["x"] = json!(at - back);
        own.hears(TopicKind::State, &state);
        assert_eq!(own.has_alarm(), alarm, "{back}");
    }
    assert_eq!(own.robot_at().max(at), own.robot_at());
}

/// It was taken for one that has said nothing.
#[test]
fn a_vehicle_that_has_passed_its_base_is_not_where_it_may_be() {
    let mut own = Lone::driving();
    let mut state = own.state();
    let ahead = state["nodeStates"].as_array().unwrap().last().unwrap()["sequenceId"].clone();
    (state["lastNodeId"], state["lastNodeSequenceId"], state["agvPosition"]["x"]) = (json!("n2"), ahead, json!(10.0));
    state["nodeStates"] = json!([]);
    // A client of others says the number of an order before until it has passed the first node of this one.
    let mut early = state.clone();
    early["agvPosition"]["x"] = json!(own.robot_at());
    own.hears(TopicKind::State, &early);
    assert!(!own.has_alarm());
    state["headerId"] = json!(1 << 20);
    own.hears(TopicKind::State, &state);
    assert!(own.has_alarm());
}

/// It was taken for one that has said nothing, wherever it was.
#[test]
fn a_vehicle_that_names_no_node_of_its_order_has_to_be_on_its_way() {
    let mut own = Lone::driving();
    for (y, alarm) in [(0.0, false), (2.0, true)] {
        let mut state = own.state();
        (state["lastNodeSequenceId"], state["agvPosition"]["y"]) = (json!(1), json!(y));
        own.hears(TopicKind::State, &state);
        assert_eq!(own.has_alarm(), alarm, "{y}");
    }
}

/// Its place there was taken for one on its way.
#[test]
fn a_place_on_another_map_counts_for_nothing() {
    let mut own = Lone::driving();
    let at = own.robot_at();
    let mut state = own.state();
    (state["agvPosition"]["mapId"], state["agvPosition"]["x"]) = (json!("upstairs"), json!(4.9));
    own.hears(TopicKind::State, &state);
    assert_eq!(own.robot_at(), at);
    assert!(own.bridge.log()[0].contains("position.mapId: \"upstairs\""));
    // One without an order was taken there.
    let mut own = Lone::standing();
    for _ in 0..30 {
        own.time += 0.1;
        let mut state = own.state();
        (state["agvPosition"]["mapId"], state["agvPosition"]["x"]) = (json!("upstairs"), json!(40.0));
        own.hears(TopicKind::State, &state);
        own.turn();
    }
    assert_eq!(own.supervisor.robot("sim/001").unwrap().course.start().x, 40.0);
}

/// It was neither believed nor was there an alarm.
#[test]
fn a_vehicle_further_away_than_any_path_can_be_is_not_where_it_may_be() {
    let mut own = Lone::driving();
    let mut state = own.state();
    state["agvPosition"]["x"] = json!(5e7);
    own.hears(TopicKind::State, &state);
    assert!(own.has_alarm());
}

/// A vehicle was believed to be on its way within its margin and as much more as it said less than nothing.
#[test]
fn a_deviation_below_zero_is_none() {
    let mut own = Lone::driving();
    let at = own.robot_at();
    let mut state = own.state();
    (state["agvPosition"]["deviationRange"], state["agvPosition"]["y"]) = (json!(-1.0), json!(0.9));
    state["agvPosition"]["x"] = json!(4.9);
    own.hears(TopicKind::State, &state);
    assert_eq!(own.robot_at(), at);
}

/// What it had to say was in the log, and it drove on.
#[test]
fn a_vehicle_that_is_larger_than_its_disc_is_released_nothing_nor_is_anybody_else() {
    let mut own = Lone::standing();
    own.vehicle.tell_factsheet();
    let sheet = own.vehicle.out().into_iter().find(|(kind, _)| *kind == TopicKind::Factsheet).unwrap().1;
    let sheet: Value = serde_json::from_slice(&sheet).unwrap();
    let mut larger = sheet.clone();
    larger["agvGeometry"]["envelopes2d"][0]["polygonPoints"][0]["x"] = json!(0.9);
    own.hears(TopicKind::Factsheet, &larger);
    own.order("a", 0.0, 2);
    assert_eq!(own.lasts(5.0), 0);
    own.time += 31.0;
    own.turn();
    let log = own.bridge.log().join("\n");
    assert!(
        log.contains(
            "sim/001 is not as the file says, so no vehicle is released anything: the vehicle needs a disc of 0.9"
        ),
        "{log}"
    );
    // What was written before is older.
    let mut older = sheet.clone();
    older["timestamp"] = json!("2020-01-01T00:00:00.000Z");
    own.hears(TopicKind::Factsheet, &older);
    assert_eq!(own.lasts(5.0), 0);
    let mut newer = sheet.clone();
    newer["headerId"] = json!(1 << 20);
    own.hears(TopicKind::Factsheet, &newer);
    assert!(own.lasts(5.0) > 0);
}

/// A vehicle was put where an old state says that it stands, and an old order was taken.
#[test]
fn what_the_broker_has_kept_is_of_another_time() {
    let mut own = Lone::standing();
    let [manager, vehicles] = interfaces();
    let state = own.state().to_string();
    own.supervisor.remove("sim/001").unwrap();
    let kept = |own: &mut Lone, topic: String, text: &str| {
        own.bridge.receive_kept(&mut own.supervisor, &topic, text.as_bytes(), own.time);
    };
    kept(&mut own, vehicles.topic(ProtocolVersion::V2_1, &key(), TopicKind::State), &state);
    assert!(own.supervisor.robot("sim/001").is_err());
    let online = String::from_utf8(own.vehicle.connection("ONLINE")).unwrap();
    kept(&mut own, vehicles.topic(ProtocolVersion::V2_1, &key(), TopicKind::Connection), &online);
    kept(&mut own, manager.topic(ProtocolVersion::V2_1, &key(), TopicKind::Order), "{}");
    assert_eq!((own.bridge.counts().refused, own.bridge.log().len()), (2, 2));
}

/// After its order was cancelled the vehicle was another one to the supervisor: the order that came once more, late, was taken as new, the
/// vehicle refused it, and the manager's next ones were refused for ever.
#[test]
fn an_order_that_comes_again_after_it_was_cancelled_is_an_old_one() {
    let mut own = Lone::driving();
    let action = json!({ "actionType": "cancelOrder", "actionId": "c", "blockingType": "NONE" });
    let message = json!({ "headerId": 2, "timestamp": "2030-01-01T00:00:00.000Z", "version": "2.1.0", "manufacturer": "sim",
        "serialNumber": "001", "actions": [action] });
    own.manager(TopicKind::InstantActions, &message);
    own.lasts(10.0);
    let [x, _] = own.vehicle.true_position();
    own.order("a", x, 1);
    own.lasts(2.0);
    let taken = own.vehicle.taken();
    own.order("b", x, 1);
    own.lasts(5.0);
    assert!(own.vehicle.taken() > taken);
    assert_eq!(own.state()["orderId"], "b");
}

/// It waited for an order to be done that nobody had any more.
#[test]
fn a_vehicle_that_was_removed_by_hand_and_comes_back_takes_orders() {
    let mut own = Lone::driving();
    own.lasts(10.0);
    own.supervisor.remove("sim/001").unwrap();
    own.lasts(1.0);
    let [x, _] = own.vehicle.true_position();
    own.vehicle.forget();
    own.lasts(1.0);
    own.order("b", x, 1);
    own.lasts(5.0);
    assert_eq!(own.state()["orderId"], "b");
}
