//! Messages other than orders and states. Fields that are not named here are kept unchanged in `rest`.

use super::decode::DecodeError;
use super::header::{MessageHeader, message};
use super::state::{VehiclePosition, Velocity};
use super::version::ProtocolVersion;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

message! {
    /// A connection message: whether a vehicle is connected to its broker.
    Connection {
        /// Connection state: `ONLINE`, `OFFLINE`, `CONNECTIONBROKEN` (3.0: `CONNECTION_BROKEN`, `HIBERNATING`).
        connection_state: String,
    }
}

message! {
    /// A visualization message: frequent positions of a vehicle.
    Visualization {
        /// Position, in 2.x.
        #[serde(skip_serializing_if = "Option::is_none")]
        agv_position: Option<VehiclePosition>,
        /// Position, in 3.0.
        #[serde(skip_serializing_if = "Option::is_none")]
        mobile_robot_position: Option<VehiclePosition>,
        /// Its velocity.
        #[serde(skip_serializing_if = "Option::is_none")]
        velocity: Option<Velocity>,
    }
}

impl Visualization {
    /// Position of the vehicle, in any edition.
    pub fn position(&self) -> Option<&VehiclePosition> {
        self.agv_position.as_ref().or(self.mobile_robot_position.as_ref())
    }
}

message! {
    /// An instant actions message.
    InstantActions {
        /// The actions.
        #[serde(skip_serializing_if = "Option::is_none")]
        actions: Option<Vec<Action>>,
        /// The same list under the name of edition 1, which some clients of 2.0 use.
        #[serde(skip_serializing_if = "Option::is_none")]
        instant_actions: Option<Vec<Action>>,
    }
}

/// An action.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase", try_from = "ActionWire")]
pub struct Action {
    /// Action type. For instant actions the schema of 2.0 says `actionName`, its text `actionType`; one of them is enough.
    pub action_type: String,
    /// Action id.
    pub action_id: String,
    /// Blocking type: `NONE`, `SOFT`, `HARD`, since 3.0 also `SINGLE`.
    pub blocking_type: String,
    /// All other fields, kept unchanged.
    #[serde(flatten)]
    pub rest: Map<String, Value>,
}

impl Action {
    /// The value of a parameter, if it has this one.
    pub fn parameter(&self, key: &str) -> Option<&Value> {
        let all = self.rest.get("actionParameters")?.as_array()?;
        all.iter().find(|parameter| parameter["key"] == key)?.get("value")
    }
}

/// An action as it is read: with one of the two names of its type, or both.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct ActionWire {
    action_type: Option<String>,
    action_name: Option<String>,
    action_id: String,
    blocking_type: String,
    #[serde(flatten)]
    rest: Map<String, Value>,
}

impl TryFrom<ActionWire> for Action {
    type Error = &'static str;

    fn try_from(read: ActionWire) -> Result<Self, Self::Error> {
        let ActionWire { action_type, action_name, action_id, blocking_type, mut rest } = read;
        if let Some(name) = &action_name {
            rest.insert("actionName".into(), name.clone().into());
        }
        let action_type = action_type.or(action_name).ok_or("missing field `actionType`")?;
        Ok(Self { action_type, action_id, blocking_type, rest })
    }
}

impl InstantActions {
    /// A message with these actions; in 2.0 the list is written under both names.
    pub fn new(header: MessageHeader, mut actions: Vec<Action>) -> Self {
        let is_first = ProtocolVersion::parse(&header.version) == Some(ProtocolVersion::V2_0);
        if is_first {
            for action in &mut actions {
                action.rest.insert("actionName".into(), action.action_type.clone().into());
            }
        }
        let instant_actions = is_first.then(|| actions.clone());
        Self { header, actions: Some(actions), instant_actions, rest: Map::new() }
    }

    /// A message with one action without parameters.
    pub fn one(header: MessageHeader, action_type: &str, action_id: String) -> Self {
        // In 3.0 instant actions block nothing.
        let (action_type, blocking_type) = (action_type.into(), "NONE".into());
        Self::new(header, vec![Action { action_type, action_id, blocking_type, rest: Map::new() }])
    }

    /// The actions of the message.
    ///
    /// # Errors
    /// [`DecodeError`] if there is no list of actions.
    pub fn list(&self) -> Result<&[Action], DecodeError> {
        let list = self.actions.as_deref().or(self.instant_actions.as_deref());
        list.ok_or_else(|| DecodeError::new("actions", "missing"))
    }
}

message! {
    /// A factsheet message, which describes a vehicle. `pcr_formats` reads the numbers that matter.
    Factsheet {
        /// Speeds, accelerations and size.
        physical_parameters: Value,
    }
}

message! {
    /// A responses message: answers of the manager to requests of a vehicle, since 3.0.
    Responses {
        /// One answer for each request.
        responses: Vec<ZoneResponse>,
    }
}

/// An answer to a request of a vehicle.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct ZoneResponse {
    /// Request id.
    pub request_id: String,
    /// Grant type: `GRANTED`, `QUEUED`, `REVOKED`, `REJECTED`.
    pub grant_type: String,
    /// All other fields, kept unchanged.
    #[serde(flatten)]
    pub rest: Map<String, Value>,
}

#[cfg(test)]
mod tests {
    use super::super::decode::{MessageLimits, read};
    use super::super::topics::VehicleId;
    use super::*;

    /// A foreign client of 2.0 refused every instant action of ours: it reads them under the other name only.
    #[test]
    fn instant_actions_of_2_0_have_both_names() {
        let header = |version| {
            MessageHeader::new(&VehicleId::new("KIT", "1").unwrap(), version, 1, "2030-01-01T00:00:00.000Z".into())
        };
        let message = InstantActions::one(header(ProtocolVersion::V2_0), "stateRequest", "1".into());
        let value = serde_json::to_value(&message).unwrap();
        assert_eq!(value["actions"], value["instantActions"]);
        assert_eq!(value["actions"][0]["actionName"], "stateRequest");
        for name in ["actions", "instantActions"] {
            let mut one = value.clone();
            one.as_object_mut().unwrap().remove(name);
            let read: InstantActions = read(one.to_string().as_bytes(), MessageLimits::default()).unwrap();
            assert_eq!(read.list(), message.list());
        }
        let none: InstantActions = read(br#"{"headerId": 1}"#, MessageLimits::default()).unwrap();
        assert_eq!(none.list().unwrap_err().field, "actions");
        let newer = InstantActions::one(header(ProtocolVersion::V2_1), "stateRequest", "1".into());
        assert!(serde_json::to_value(&newer).unwrap().get("instantActions").is_none());
    }
}
