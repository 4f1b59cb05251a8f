//! The messages that are not orders or states. What is not named here is kept as it came, in `rest`.

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
#[serde(rename_all = "camelCase")]
pub struct Action {
    /// What; in schema 2.0 of instant actions `actionName`, in its text `actionType`: one is enough.
    #[serde(alias = "actionName")]
    pub action_type: String,
    /// Which.
    pub action_id: String,
    /// What else may be done meanwhile: `NONE`, `SOFT`, `HARD`, since 3.0 also `SINGLE`.
    pub blocking_type: String,
    /// All else.
    #[serde(flatten)]
    pub rest: Map<String, Value>,
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
