//! What is in every message, and the messages that are not orders or states. What is not named here is kept as it came, in `rest`.

use super::door::Refusal;
use super::state::{Pose, Velocity};
use super::topics::Key;
use super::version::Version;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

/// A message: its header, then its fields, then all else.
macro_rules! message {
    ($(#[$meta:meta])* $name:ident { $($(#[$field_meta:meta])* $field:ident : $type:ty,)* }) => {
        $(#[$meta])*
        #[derive(Clone, Debug, PartialEq, ::serde::Serialize, ::serde::Deserialize)]
        #[serde(rename_all = "camelCase")]
        pub struct $name {
            /// What is in every message.
            #[serde(flatten)]
            pub header: $crate::vda5050::messages::Header,
            $($(#[$field_meta])* pub $field: $type,)*
            /// All else that was in the message.
            #[serde(flatten)]
            pub rest: ::serde_json::Map<String, ::serde_json::Value>,
        }
    };
}
pub(super) use message;

/// What every message begins with.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub struct Header {
    /// Counts the messages of a topic.
    pub header_id: u64,
    /// When it was written, by the clock of the sender.
    pub timestamp: String,
    /// Edition of the standard.
    pub version: String,
    /// Who has made the vehicle.
    pub manufacturer: String,
    /// Which of theirs.
    pub serial_number: String,
}

impl Header {
    /// That of a message of ours.
    pub fn new(key: &Key, version: Version, header_id: u64, timestamp: String) -> Self {
        let Key { manufacturer, serial_number } = key.clone();
        Self { header_id, timestamp, version: version.text().into(), manufacturer, serial_number }
    }

    /// The edition, if the message is about the vehicle of its topic and of the major version of its topic.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn check(&self, key: &Key, is_third: bool) -> Result<Version, Refusal> {
        for (field, said, topic) in [
            ("manufacturer", &self.manufacturer, &key.manufacturer),
            ("serialNumber", &self.serial_number, &key.serial_number),
        ] {
            if said != topic {
                return Err(Refusal::new(field, format!("{said:?}, but the topic is that of {topic:?}")));
            }
        }
        match Version::of(&self.version) {
            None => Err(Refusal::new("version", format!("{:?}; 2.0, 2.1 and 3.0 are read", self.version))),
            Some(version) if (version == Version::V3_0) != is_third => {
                Err(Refusal::new("version", format!("{version} in a topic of v{}", if is_third { 3 } else { 2 })))
            }
            Some(version) => Ok(version),
        }
    }
}

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
        #[serde(alias = "instantActions")]
        actions: Vec<Action>,
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
    /// One action, of no parameters.
    pub fn one(header: Header, action_type: &str, action_id: String) -> Self {
        let mut rest = Map::new();
        if Version::of(&header.version) == Some(Version::V2_0) {
            rest.insert("actionName".into(), action_type.into());
        }
        // In 3.0 instant actions block nothing.
        let blocking_type = "NONE".into();
        let action = Action { action_type: action_type.into(), action_id, blocking_type, rest };
        Self { header, actions: vec![action], rest: Map::new() }
    }
}

message! {
    /// What a vehicle is. Read by `pcr_formats` where its numbers matter.
    Factsheet {
        /// Speeds, accelerations and size.
        physical_parameters: Value,
    }
}
