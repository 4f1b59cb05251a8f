//! Messages other than orders and states. Fields that are not named here are kept unchanged in `rest`.

use super::door::Refusal;
use super::header::{Header, message};
use super::state::{Pose, Velocity};
use super::version::Version;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

message! {
    /// Whether a vehicle is connected to its broker.
    Connection {
        /// `ONLINE`, `OFFLINE`, `CONNECTIONBROKEN` (3.0: `CONNECTION_BROKEN`, `HIBERNATING`).
        connection_state: String,
    }
}

message! {
    /// Where a vehicle is, often.
    Visualization {
        /// 2.x
        #[serde(skip_serializing_if = "Option::is_none")]
        agv_position: Option<Pose>,
        /// 3.0
        #[serde(skip_serializing_if = "Option::is_none")]
        mobile_robot_position: Option<Pose>,
        /// How fast it is.
        #[serde(skip_serializing_if = "Option::is_none")]
        velocity: Option<Velocity>,
    }
}

impl Visualization {
    /// Where it is.
    pub fn position(&self) -> Option<&Pose> {
        self.agv_position.as_ref().or(self.mobile_robot_position.as_ref())
    }
}

message! {
    /// What a vehicle is to do at once.
    InstantActions {
        /// What.
        #[serde(skip_serializing_if = "Option::is_none")]
        actions: Option<Vec<Action>>,
        /// The same, as edition 1 and some clients of 2.0 call it.
        #[serde(skip_serializing_if = "Option::is_none")]
        instant_actions: Option<Vec<Action>>,
    }
}

/// Something to be done.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase", try_from = "Named")]
pub struct Action {
    /// What; in schema 2.0 of instant actions `actionName`, in its text `actionType`: one is enough.
    pub action_type: String,
    /// Which.
    pub action_id: String,
    /// What else may be done meanwhile: `NONE`, `SOFT`, `HARD`, since 3.0 also `SINGLE`.
    pub blocking_type: String,
    /// All else.
    #[serde(flatten)]
    pub rest: Map<String, Value>,
}

/// An action as it is read: under one name or both.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Named {
    action_type: Option<String>,
    action_name: Option<String>,
    action_id: String,
    blocking_type: String,
    #[serde(flatten)]
    rest: Map<String, Value>,
}

impl TryFrom<Named> for Action {
    type Error = &'static str;

    fn try_from(read: Named) -> Result<Self, Self::Error> {
        let Named { action_type, action_name, action_id, blocking_type, mut rest } = read;
        if let Some(name) = &action_name {
            rest.insert("actionName".into(), name.clone().into());
        }
        let action_type = action_type.or(action_name).ok_or("missing field `actionType`")?;
        Ok(Self { action_type, action_id, blocking_type, rest })
    }
}

impl InstantActions {
    /// These actions; in 2.0 with all names that its readers ask for.
    pub fn new(header: Header, mut actions: Vec<Action>) -> Self {
        let is_first = Version::of(&header.version) == Some(Version::V2_0);
        if is_first {
            for action in &mut actions {
                action.rest.insert("actionName".into(), action.action_type.clone().into());
            }
        }
        let instant_actions = is_first.then(|| actions.clone());
        Self { header, actions: Some(actions), instant_actions, rest: Map::new() }
    }

    /// One action, of no parameters.
    pub fn one(header: Header, action_type: &str, action_id: String) -> Self {
        // In 3.0 instant actions block nothing.
        let (action_type, blocking_type) = (action_type.into(), "NONE".into());
        Self::new(header, vec![Action { action_type, action_id, blocking_type, rest: Map::new() }])
    }

    /// What is to be done.
    ///
    /// # Errors
    /// [`Refusal`] where nothing is said of that.
    pub fn list(&self) -> Result<&[Action], Refusal> {
        let list = self.actions.as_deref().or(self.instant_actions.as_deref());
        list.ok_or_else(|| Refusal::new("actions", "missing"))
    }
}

message! {
    /// What a vehicle is. Read by `pcr_formats` where its numbers matter.
    Factsheet {
        /// Speeds, accelerations and size.
        physical_parameters: Value,
    }
}

message! {
    /// What the manager says to what a vehicle has asked for, since 3.0.
    Responses {
        /// One for each request.
        responses: Vec<Response>,
    }
}

/// An answer to a request of a vehicle.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct Response {
    /// Which request.
    pub request_id: String,
    /// `GRANTED`, `QUEUED`, `REVOKED`, `REJECTED`.
    pub grant_type: String,
    /// All else.
    #[serde(flatten)]
    pub rest: Map<String, Value>,
}

#[cfg(test)]
mod tests {
    use super::super::door::{Limits, read};
    use super::super::topics::Key;
    use super::*;

    /// A client of 2.0 that others wrote refused every instant action of ours: it reads them under the other name only.
    #[test]
    fn instant_actions_of_2_0_have_both_names() {
        let header =
            |version| Header::new(&Key::new("KIT", "1").unwrap(), version, 1, "2030-01-01T00:00:00.000Z".into());
        let message = InstantActions::one(header(Version::V2_0), "stateRequest", "1".into());
        let value = serde_json::to_value(&message).unwrap();
        assert_eq!(value["actions"], value["instantActions"]);
        assert_eq!(value["actions"][0]["actionName"], "stateRequest");
        for name in ["actions", "instantActions"] {
            let mut one = value.clone();
            one.as_object_mut().unwrap().remove(name);
            let read: InstantActions = read(one.to_string().as_bytes(), Limits::default()).unwrap();
            assert_eq!(read.list(), message.list());
        }
        let none: InstantActions = read(br#"{"headerId": 1}"#, Limits::default()).unwrap();
        assert_eq!(none.list().unwrap_err().field, "actions");
        let newer = InstantActions::one(header(Version::V2_1), "stateRequest", "1".into());
        assert!(serde_json::to_value(&newer).unwrap().get("instantActions").is_none());
    }
}
