//! Zone sets and corridors that a manager sends: what the vehicle uses counts, what is not supported is refused with a reason.

use crate::pair::order;
use crate::puppet::Puppet;
use crate::schemas::schema;
use crate::site::settings;
use pcr_formats::vda5050::topics::TopicKind;
use pcr_formats::vda5050::version::ProtocolVersion;
use serde_json::{Value, json};

const WAY: [[f64; 2]; 3] = [[0.0, 0.0], [10.0, 0.0], [20.0, 0.0]];

fn zone(id: &str, kind: &str, [x0, x1]: [f64; 2], more: &Value) -> Value {
    let vertices = [[x0, -1.0], [x1, -1.0], [x1, 1.0], [x0, 1.0]].map(|[x, y]| json!({ "x": x, "y": y }));
    let mut zone = json!({ "zoneId": id, "zoneType": kind, "vertices": vertices });
    zone.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
    zone
}

fn set(id: &str, map: &str, zones: Vec<Value>) -> Value {
    json!({ "zoneSet": { "mapId": map, "zoneSetId": id, "zones": zones } })
}

struct Own(Puppet);

impl Own {
    fn new() -> Self {
        Self(Puppet::of(ProtocolVersion::V3_0, settings()))
    }

    fn sends(&mut self, set: &Value) {
        let message = self.0.signed(set.clone());
        assert!(schema("3.0.0", TopicKind::ZoneSet).is_valid(&message), "{message}");
        self.0.manager(TopicKind::ZoneSet, set.clone());
    }

    /// The vehicle uses these sets from now on.
    fn uses(&mut self, sets: &[&str]) {
        let sets: Vec<Value> =
            sets.iter().map(|id| json!({ "zoneSetId": id, "mapId": "map", "zoneSetStatus": "ENABLED" })).collect();
        self.0.state["zoneSets"] = sets.into();
        self.0.lasts(1.0);
    }

    fn got(&self, kind: TopicKind) -> usize {
        self.0.got.iter().filter(|(own, _)| *own == kind).count()
    }

    fn error(&self, kind: &str) -> Option<String> {
        let errors = self.0.told["errors"].as_array().unwrap();
        let found = errors.iter().find(|error| error["errorType"] == kind)?;
        Some(format!("{} {}", found["errorDescription"].as_str().unwrap(), found["errorReferences"]))
    }

    /// It has an update of the order, and is at the first node; it drives on if it may.
    fn has(&mut self, update: u64, drives: bool) {
        let ahead = [2, 4].map(|k| json!({ "nodeId": format!("n{k}"), "sequenceId": k, "released": drives }));
        (self.0.state["orderId"], self.0.state["orderUpdateId"]) = ("a".into(), update.into());
        (self.0.state["lastNodeId"], self.0.state["nodeStates"]) = ("n0".into(), json!(ahead));
        self.0.state["driving"] = drives.into();
        self.0.lasts(1.0);
    }

    /// The released nodes of the last order or update.
    fn released(&self) -> Vec<String> {
        let (_, last) = self.0.got.iter().rfind(|(kind, _)| *kind == TopicKind::Order).unwrap();
        let nodes = last["nodes"].as_array().unwrap().iter().filter(|node| node["released"] == true);
        nodes.map(|node| node["nodeId"].as_str().unwrap().to_owned()).collect()
    }

    fn speeds(&self) -> Vec<Option<f64>> {
        let (_, last) = self.0.got.iter().rfind(|(kind, _)| *kind == TopicKind::Order).unwrap();
        last["edges"].as_array().unwrap().iter().map(|edge| edge["maximumSpeed"].as_f64()).collect()
    }
}

/// Vehicles got authority into zones that they do not enter: others waited for them.
#[test]
fn nobody_gets_authority_into_a_blocked_zone_that_it_uses() {
    for is_restarted in [false, true] {
        let mut own = Own::new();
        own.sends(&set("s", "map", vec![zone("wet", "BLOCKED", [13.0, 15.0], &json!({}))]));
        own.sends(&set("up", "upstairs", vec![zone("other", "BLOCKED", [3.0, 5.0], &json!({}))]));
        assert_eq!(own.got(TopicKind::ZoneSet), 2);
        own.uses(&["s", "up"]);
        if is_restarted {
            own.0.restart();
            own.0.lasts(1.0);
        }
        own.0.manager(TopicKind::Order, order("a", 0, 0, &WAY, 3));
        own.0.lasts(1.0);
        own.has(0, false);
        own.0.lasts(3.0);
        assert_eq!(own.released(), ["n0"], "{is_restarted}");
        let why = "order a waits: zone wet of s is closed";
        assert!(own.0.told["information"].to_string().contains(why), "{is_restarted}: {}", own.0.told);
        assert!(schema("3.0.0", TopicKind::State).is_valid(&without_own_gaps(&own.0.told)), "{}", own.0.told);
        // It uses another set.
        own.uses(&["up"]);
        own.0.lasts(2.0);
        assert_eq!(own.released(), ["n0", "n2", "n4"], "{is_restarted}");
        assert!(!own.0.told["information"].to_string().contains(why));
        // It is under way, and uses the first one again: it stops.
        own.has(1, true);
        own.uses(&["s"]);
        assert_eq!(own.0.robot().stopped.as_deref(), Some("zone wet of s"));
        assert_eq!(own.0.asked("startPause").len(), 1);
    }
}

/// The puppet leaves out what the supervisor does not read.
fn without_own_gaps(told: &Value) -> Value {
    let mut told = told.clone();
    let more = json!({ "powerSupply": { "stateOfCharge": 80.0, "charging": false },
        "safetyState": { "activeEmergencyStop": "NONE", "fieldViolation": false }, "instantActionStates": [] });
    told.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
    told["mobileRobotPosition"]["localized"] = true.into();
    told
}

#[test]
fn speeds_of_zones_become_speeds_of_edges() {
    let mut own = Own::new();
    let slow = |x: [f64; 2], speed: f64| zone(&speed.to_string(), "SPEED_LIMIT", x, &json!({ "maximumSpeed": speed }));
    own.sends(&set("s", "map", vec![slow([13.0, 15.0], 0.4), slow([14.0, 30.0], 0.3)]));
    own.0.manager(TopicKind::Order, order("a", 0, 0, &WAY, 3));
    own.0.lasts(1.0);
    assert_eq!(own.speeds(), [None, None], "the vehicle does not use it");
    own.0.cancels("stop");
    own.0.ends("stop", "FAILED");
    own.0.lasts(70.0);
    for id in own.0.asked("cancelOrder") {
        own.0.ends(&id, "FAILED");
    }
    own.0.lasts(2.0);
    assert!(!own.0.has_job());
    own.uses(&["s"]);
    own.0.manager(TopicKind::Order, order("b", 0, 0, &WAY, 3));
    own.0.lasts(1.0);
    assert_eq!(own.speeds(), [None, Some(0.3)]);
}

#[test]
fn an_order_against_a_one_way_zone_is_refused() {
    let way = |direction: f64| json!({ "direction": direction, "limitation": "RESTRICTED" });
    for (direction, is_taken) in [(0.0, true), (std::f64::consts::PI, false)] {
        let mut own = Own::new();
        own.sends(&set("s", "map", vec![zone("aisle", "DIRECTED", [13.0, 15.0], &way(direction))]));
        own.uses(&["s"]);
        own.0.manager(TopicKind::Order, order("a", 0, 0, &WAY, 3));
        own.0.lasts(1.0);
        assert_eq!(own.got(TopicKind::Order) > 0, is_taken, "{direction}");
        let refused = own.error("INVALID_ORDER").unwrap_or_default();
        assert_eq!(
            refused.contains("edges[1]: edge e leads against zone aisle of s, which is one way"),
            !is_taken,
            "{refused}"
        );
        // A trajectory counts more.
        let mut order = order("b", 0, 0, &WAY, 3);
        order["edges"][1]["trajectory"] =
            json!({ "degree": 1, "controlPoints": [{ "x": 10, "y": 0 }, { "x": 20, "y": 0 }] });
        if !is_taken {
            own.0.manager(TopicKind::Order, order);
            own.0.lasts(1.0);
            assert!(own.got(TopicKind::Order) > 0);
        }
    }
}

#[test]
fn sets_that_are_not_supported_are_refused_with_a_reason() {
    let crossed =
        json!({ "vertices": [{ "x": 0, "y": 0 }, { "x": 1, "y": 1 }, { "x": 1, "y": 0 }, { "x": 0, "y": 1 }] });
    let fine = zone("fine", "LINE_GUIDED", [0.0, 1.0], &json!({}));
    for (bad, why) in [
        (zone("bad", "COORDINATED_REPLANNING", [0.0, 1.0], &json!({})), "COORDINATED_REPLANNING is not supported"),
        (zone("bad", "BLOCKED", [0.0, 1.0], &crossed), "zoneSet.zones[1].vertices: the side from corner"),
        (zone("bad", "SPEED_LIMIT", [0.0, 1.0], &json!({ "maximumSpeed": -1.0 })), "-1 is out of range"),
    ] {
        let mut own = Own::new();
        own.sends(&set("s", "map", vec![fine.clone(), bad]));
        own.0.lasts(0.5);
        assert_eq!(own.got(TopicKind::ZoneSet), 0, "{why}");
        let error = own.error("VALIDATION_FAILURE").unwrap();
        assert!(error.contains(why) && error.contains(r#""referenceValue":"s""#), "{error}");
        assert!(error.contains(r#""referenceValue":"bad""#) && own.0.bridge.log().concat().contains(why), "{error}");
    }
    // The same again is passed on, the vehicle answers that; another content is not.
    let mut own = Own::new();
    own.sends(&set("s", "map", vec![fine.clone()]));
    own.sends(&set("s", "map", vec![fine]));
    assert_eq!((own.got(TopicKind::ZoneSet), own.error("DUPLICATE_ZONE_SET")), (2, None));
    own.sends(&set("s", "map", vec![]));
    own.0.lasts(0.5);
    assert!(own.got(TopicKind::ZoneSet) == 2 && own.error("DUPLICATE_ZONE_SET").is_some());
    // Of what the vehicle has from elsewhere nothing is known here.
    own.uses(&["s", "downloaded"]);
    let error = own.error("zoneSetUnknown").unwrap();
    assert!(error.contains("the zone set downloaded, which was not sent on its topic"), "{error}");
}

/// The order was refused; with the corridor the vehicle would leave its way, where nobody keeps clear of it.
#[test]
fn corridors_are_not_passed_on_and_the_manager_is_told() {
    for version in ProtocolVersion::ALL {
        let mut own = Puppet::of(version, settings());
        let mut order = order("a", 0, 0, &WAY, 3);
        for (k, name) in ["first", "second"].into_iter().enumerate() {
            order["edges"][k]["edgeId"] = name.into();
        }
        order["edges"][1]["corridor"] = json!({ "leftWidth": 1.0, "rightWidth": 0.5 });
        order["edges"][1]["trajectory"] =
            json!({ "degree": 1, "controlPoints": [{ "x": 10, "y": 0 }, { "x": 20, "y": 0 }] });
        own.manager(TopicKind::Order, order.clone());
        own.lasts(1.0);
        let (_, sent) = own.got.iter().rfind(|(kind, _)| *kind == TopicKind::Order).unwrap();
        assert!(!sent.to_string().contains("corridor"), "{version:?}: {sent}");
        own.state["orderId"] = "a".into();
        own.state["lastNodeId"] = "n0".into();
        let ahead = [2, 4].map(|k| json!({ "nodeId": format!("n{k}"), "sequenceId": k, "released": true }));
        own.state["nodeStates"] = json!(ahead);
        own.lasts(1.0);
        let errors = own.told["errors"].as_array().unwrap();
        let error = errors.iter().find(|error| error["errorType"] == "corridorRemoved").expect("it is told");
        assert_eq!(error["errorReferences"], json!([{ "referenceKey": "edgeId", "referenceValue": "second" }]));
        // The same order again is no other one.
        own.manager(TopicKind::Order, order);
        own.lasts(0.5);
        assert!(!own.told["errors"].to_string().contains("orderId"), "{version:?}: {}", own.told);
    }
}
