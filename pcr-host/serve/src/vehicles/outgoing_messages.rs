//! Messages of a vehicle.

use super::vehicle::SimulatedVehicle;
use crate::vda5050::remaining_elements::{EdgeStateOut, NodeStateOut};
use pcr_formats::plane_geometry::wrapped;
use pcr_formats::vda5050::header::MessageHeader;
use pcr_formats::vda5050::messages::{Connection, Visualization};
use pcr_formats::vda5050::state::{PartialList, State, VehiclePosition, Velocity};
use pcr_formats::vda5050::timestamp;
use pcr_formats::vda5050::topics::TopicKind;
use pcr_formats::vda5050::version::ProtocolVersion;
use serde::Serialize;
use serde_json::{Map, Value, json};
use std::f64::consts::TAU;

impl SimulatedVehicle {
    fn header(&mut self, kind: TopicKind) -> MessageHeader {
        let number = self.headers.entry(kind).or_insert(0);
        *number += 1;
        MessageHeader::new(&self.key, self.version, *number, timestamp::written(self.time + self.clock))
    }

    fn say(&mut self, kind: TopicKind, message: &impl Serialize) {
        self.out.push((kind, serde_json::to_vec(message).unwrap_or_default()));
    }

    /// The pose that it reports.
    fn pose(&mut self) -> VehiclePosition {
        let [x, y] = self.true_position();
        let (noise, angle) = (self.abilities.noise * self.random.unit(), self.random.unit() * TAU);
        let theta = wrapped(self.heading());
        let is_third = self.version == ProtocolVersion::V3_0;
        VehiclePosition {
            x: x + noise * angle.cos(),
            y: y + noise * angle.sin(),
            // The schemas have fewer digits of π.
            theta: theta * (1.0 - 1e-9),
            map_id: self.map_id.clone(),
            position_initialized: (!is_third).then_some(true),
            localized: is_third.then_some(true),
            deviation_range: Some(self.abilities.noise),
            localization_score: Some(0.9),
            rest: Map::new(),
        }
    }

    fn velocity(&self) -> Velocity {
        let speed = self.task.as_ref().map_or(0.0, |task| task.drive.speed);
        Velocity { vx: Some(speed), vy: Some(0.0), omega: Some(0.0) }
    }

    /// Sends its position.
    pub(crate) fn tell_position(&mut self) {
        let (header, pose, velocity) = (self.header(TopicKind::Visualization), self.pose(), Some(self.velocity()));
        let mut rest = Map::new();
        let (agv, robot) = if self.version == ProtocolVersion::V3_0 {
            let state = self.headers.get(&TopicKind::State).copied().unwrap_or(0);
            rest.insert("referenceStateHeaderId".into(), state.into());
            (None, Some(pose))
        } else {
            (Some(pose), None)
        };
        let message = Visualization { header, agv_position: agv, mobile_robot_position: robot, velocity, rest };
        self.say(TopicKind::Visualization, &message);
    }

    /// Sends its state.
    pub fn tell_state(&mut self) {
        let (header, pose, velocity) = (self.header(TopicKind::State), self.pose(), Some(self.velocity()));
        let is_third = self.version == ProtocolVersion::V3_0;
        let (agv, robot) = if is_third { (None, Some(pose)) } else { (Some(pose), None) };
        let rest = match if is_third { third() } else { second() } {
            Value::Object(rest) => rest,
            _ => Map::new(),
        };
        let task = self.task.as_ref();
        let open = task.filter(|task| !task.cancelled);
        let last = task.and_then(|task| task.held.nodes.get(task.done));
        let mut actions = self.actions.clone();
        if !is_third {
            actions.extend(self.instant.iter().cloned());
        }
        let nodes = open.iter().flat_map(|task| task.held.nodes.iter().skip(task.done + 1));
        let edges = open.iter().flat_map(|task| task.held.edges.iter().skip(task.done));
        let nodes: Vec<NodeStateOut<'_>> = nodes.map(NodeStateOut::from).collect();
        let edges: Vec<EdgeStateOut<'_>> = edges.map(EdgeStateOut::from).collect();
        let mut state = State {
            header,
            order_id: task.map_or_else(String::new, |task| task.held.order_id.clone()),
            order_update_id: task.map_or(0, |task| task.held.update_id),
            last_node_id: last.map_or_else(String::new, |node| node.node_id.clone()),
            last_node_sequence_id: last.map_or(0, |node| node.sequence_id),
            node_states: PartialList::written(&nodes),
            edge_states: PartialList::written(&edges),
            driving: task.is_some_and(|task| task.drive.is_driving()),
            new_base_request: Some(false),
            agv_position: agv,
            mobile_robot_position: robot,
            velocity,
            action_states: actions,
            instant_action_states: is_third.then(|| self.instant.clone()),
            operating_mode: "AUTOMATIC".into(),
            errors: self.errors.clone(),
            rest,
        };
        state.rest.insert("paused".into(), self.paused.into());
        self.say(TopicKind::State, &state);
    }

    /// The connection message in this state.
    pub fn connection(&mut self, connection_state: &str) -> Vec<u8> {
        let header = self.header(TopicKind::Connection);
        let message = Connection { header, connection_state: connection_state.into(), rest: Map::new() };
        serde_json::to_vec(&message).unwrap_or_default()
    }

    /// Says that it is connected.
    pub(crate) fn tell_online(&mut self) {
        let payload = self.connection("ONLINE");
        self.out.push((TopicKind::Connection, payload));
    }

    /// Sends its factsheet.
    pub fn tell_factsheet(&mut self) {
        let header = self.header(TopicKind::Factsheet);
        let mut sheet = if self.version == ProtocolVersion::V3_0 { self.sheet_third() } else { self.sheet_second() };
        if let (Value::Object(sheet), Ok(Value::Object(header))) = (&mut sheet, serde_json::to_value(header)) {
            sheet.extend(header);
        }
        self.say(TopicKind::Factsheet, &sheet);
    }

    fn contour(&self) -> Vec<Value> {
        let half = self.sides().map(|side| 0.5 * side);
        [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]]
            .map(|[x, y]| json!({ "x": x * half[0], "y": y * half[1] }))
            .into()
    }

    /// Length and width of its rectangle, or of the square inside its disc \[m\].
    fn sides(&self) -> [f64; 2] {
        self.abilities.rectangle.unwrap_or([self.abilities.radius * 2.0_f64.sqrt(); 2])
    }

    fn sheet_second(&self) -> Value {
        let can = self.abilities;
        let [length, width] = self.sides();
        json!({
            "typeSpecification": { "seriesName": "pcr fleet", "agvKinematic": "DIFF", "agvClass": "CARRIER", "maxLoadMass": 100,
                "localizationTypes": ["NATURAL"], "navigationTypes": ["VIRTUAL_LINE_GUIDED"] },
            "physicalParameters": { "speedMin": 0.0, "speedMax": can.speed, "accelerationMax": can.acceleration,
                "decelerationMax": can.acceleration, "heightMax": 1.0, "width": width, "length": length },
            "protocolLimits": { "maxStringLens": {}, "maxArrayLens": {}, "timing": { "minOrderInterval": 0.0, "minStateInterval": 0.0 } },
            "protocolFeatures": { "optionalParameters": [], "agvActions": instant_actions(&json!({})) },
            "agvGeometry": { "envelopes2d": [ { "set": "contour", "polygonPoints": self.contour() } ] },
            "loadSpecification": {},
        })
    }

    fn sheet_third(&self) -> Value {
        let can = self.abilities;
        let [length, width] = self.sides();
        json!({
            // Both names: the schema of 3.0.0 requires one and describes the other.
            "typeSpecification": { "seriesName": "pcr fleet", "mobileRobotKinematic": "DIFFERENTIAL", "mobileRobotKinematics": "DIFFERENTIAL",
                "mobileRobotClass": "CARRIER", "maximumLoadMass": 100, "localizationTypes": ["NATURAL"],
                "navigationTypes": ["VIRTUAL_LINE_GUIDED"] },
            "physicalParameters": { "minimumSpeed": 0.0, "maximumSpeed": can.speed, "maximumAcceleration": can.acceleration,
                "maximumDeceleration": can.acceleration, "minimumHeight": 1.0, "maximumHeight": 1.0, "width": width, "length": length },
            "protocolLimits": { "maximumStringLengths": {}, "maximumArrayLengths": {},
                "timing": { "minimumOrderInterval": 0.0, "minimumStateInterval": 0.0 } },
            "protocolFeatures": { "optionalParameters": [], "mobileRobotActions": instant_actions(&json!({ "pauseAllowed": "False", "cancelAllowed": "False" })) },
            "mobileRobotGeometry": { "envelopes2d": [ { "envelope2dId": "contour", "vertices": self.contour() } ] },
            "loadSpecification": {},
        })
    }
}

/// The instant actions that it knows, as a factsheet lists them, each with these fields. The published schema of 3.0 has texts where others would have
/// truth values.
fn instant_actions(more: &Value) -> Vec<Value> {
    let action = |kind: &str| {
        let mut action = json!({ "actionType": kind, "actionScopes": ["INSTANT"] });
        if let (Value::Object(action), Value::Object(more)) = (&mut action, more) {
            action.extend(more.clone());
        }
        action
    };
    ["startPause", "stopPause", "stateRequest", "factsheetRequest", "cancelOrder"].map(action).into()
}

fn second() -> Value {
    json!({
        "batteryState": { "batteryCharge": 80.0, "charging": false },
        "safetyState": { "eStop": "NONE", "fieldViolation": false },
    })
}

fn third() -> Value {
    json!({
        "powerSupply": { "stateOfCharge": 80.0, "charging": false },
        "safetyState": { "activeEmergencyStop": "NONE", "fieldViolation": false },
    })
}
