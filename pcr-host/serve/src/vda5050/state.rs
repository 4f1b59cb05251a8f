//! States of vehicles.

use super::header::message;
use serde::de::{DeserializeOwned, Error, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use serde_json::value::{RawValue, to_raw_value};
use serde_json::{Map, Value};
use std::fmt;
use std::ops::Deref;
use std::sync::Arc;

message! {
    /// What a vehicle says of itself.
    State {
        /// The order that it has, or had last.
        order_id: String,
        /// Which update of it.
        order_update_id: u64,
        /// The node that it has reached last.
        last_node_id: String,
        /// Which of that name.
        last_node_sequence_id: u64,
        /// Nodes that it has still to pass.
        node_states: Listed<NodeState>,
        /// Edges that it has still to travel.
        edge_states: Listed<EdgeState>,
        /// Whether it moves.
        driving: bool,
        /// Whether it asks for more base.
        #[serde(skip_serializing_if = "Option::is_none")]
        new_base_request: Option<bool>,
        /// 2.x
        #[serde(skip_serializing_if = "Option::is_none")]
        agv_position: Option<Pose>,
        /// 3.0
        #[serde(skip_serializing_if = "Option::is_none")]
        mobile_robot_position: Option<Pose>,
        /// How fast it is.
        #[serde(skip_serializing_if = "Option::is_none")]
        velocity: Option<Velocity>,
        /// What it does.
        action_states: Vec<ActionState>,
        /// What it does at once, since 3.0.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        instant_action_states: Option<Vec<ActionState>>,
        /// Who drives it.
        operating_mode: String,
        /// What is wrong with it.
        errors: Vec<StateError>,
    }
}

/// A list of which a few fields are read, and all is kept as it was written: it is long, and most of it is passed on or left out.
#[derive(Clone, Debug)]
pub struct Listed<T> {
    text: Arc<RawValue>,
    items: Vec<T>,
}

impl<T> Listed<T> {
    /// One to be written; nothing of it counts.
    pub fn written(all: &[impl Serialize]) -> Self {
        // Lists of numbers and texts: there is none that cannot be written.
        Self { text: to_raw_value(all).unwrap_or_default().into(), items: Vec::new() }
    }
}

impl<T> Deref for Listed<T> {
    type Target = [T];

    fn deref(&self) -> &[T] {
        &self.items
    }
}

impl<T> PartialEq for Listed<T> {
    fn eq(&self, other: &Self) -> bool {
        self.text.get() == other.text.get()
    }
}

impl<T> Serialize for Listed<T> {
    fn serialize<S: Serializer>(&self, writer: S) -> Result<S::Ok, S::Error> {
        self.text.serialize(writer)
    }
}

impl<'de, T: DeserializeOwned> Deserialize<'de> for Listed<T> {
    fn deserialize<D: Deserializer<'de>>(reader: D) -> Result<Self, D::Error> {
        let text = Box::<RawValue>::deserialize(reader)?;
        let items = serde_json::from_str(text.get()).or_else(|_| {
            // Where it is wrong.
            serde_path_to_error::deserialize(&mut serde_json::Deserializer::from_str(text.get()))
        });
        Ok(Self { items: items.map_err(Error::custom)?, text: text.into() })
    }
}

/// What counts of a node still to be passed.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct NodeState {
    /// It has a name.
    node_id: Text,
    /// Which of that name.
    pub sequence_id: u64,
    /// Part of the base.
    pub released: bool,
}

/// What counts of an edge still to be travelled.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct EdgeState {
    /// It has a name.
    edge_id: Text,
    /// Which of that name.
    pub sequence_id: u64,
    /// Part of the base.
    pub released: bool,
}

/// A text that is not kept.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Text;

impl<'de> Deserialize<'de> for Text {
    fn deserialize<D: Deserializer<'de>>(reader: D) -> Result<Self, D::Error> {
        struct Any;
        impl Visitor<'_> for Any {
            type Value = Text;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a string")
            }

            fn visit_str<E: Error>(self, _: &str) -> Result<Text, E> {
                Ok(Text)
            }
        }
        reader.deserialize_str(Any)
    }
}

/// Where a vehicle is.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct Pose {
    /// \[m\]
    pub x: f64,
    /// \[m\]
    pub y: f64,
    /// \[rad\]
    pub theta: f64,
    /// On which map.
    pub map_id: String,
    /// Whether it knows, 2.x.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub position_initialized: Option<bool>,
    /// Whether it knows, 3.0.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub localized: Option<bool>,
    /// How far off it may be \[m\].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub deviation_range: Option<f64>,
    /// How sure it is, 0 to 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub localization_score: Option<f64>,
    /// All else.
    #[serde(flatten)]
    pub rest: Map<String, Value>,
}

impl Pose {
    /// Whether the vehicle says that it knows where it is.
    pub fn is_known(&self) -> bool {
        self.position_initialized.or(self.localized).unwrap_or(false)
            && self.localization_score.is_none_or(|it| it > 0.0)
            && self.deviation_range.is_none_or(|it| it >= 0.0)
    }
}

/// How fast a vehicle is, in its own directions.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Velocity {
    /// Ahead \[m/s\].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub vx: Option<f64>,
    /// To the left \[m/s\].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub vy: Option<f64>,
    /// \[rad/s\]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub omega: Option<f64>,
}

/// How far an action is.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct ActionState {
    /// Which.
    pub action_id: String,
    /// `WAITING`, `INITIALIZING`, `RUNNING`, `PAUSED`, `FINISHED`, `FAILED`, `RETRIABLE`.
    pub action_status: String,
    /// All else.
    #[serde(flatten)]
    pub rest: Map<String, Value>,
}

/// Something that is wrong.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct StateError {
    /// What.
    pub error_type: String,
    /// How bad.
    pub error_level: String,
    /// All else.
    #[serde(flatten)]
    pub rest: Map<String, Value>,
}

impl State {
    /// Where it is.
    pub fn position(&self) -> Option<&Pose> {
        self.agv_position.as_ref().or(self.mobile_robot_position.as_ref())
    }

    /// Number of the last node of the base that it has.
    pub fn base(&self) -> u64 {
        let released = self.node_states.iter().filter(|node| node.released).map(|node| node.sequence_id);
        released.max().unwrap_or(self.last_node_sequence_id)
    }

    /// How far an action is, instant or not.
    pub fn action(&self, action_id: &str) -> Option<&str> {
        let mut all = self.action_states.iter().chain(self.instant_action_states.iter().flatten());
        all.find(|state| state.action_id == action_id).map(|state| state.action_status.as_str())
    }

    /// Whether it says anything of an action: how far that is, or what is wrong with it.
    pub fn names(&self, action_id: &str) -> bool {
        let mut references =
            self.errors.iter().filter_map(|error| error.rest.get("errorReferences")?.as_array()).flatten();
        self.action(action_id).is_some() || references.any(|reference| reference["referenceValue"] == action_id)
    }

    /// Whether it has nothing more to do of its order.
    pub fn is_idle(&self) -> bool {
        let is_done = |state: &ActionState| matches!(state.action_status.as_str(), "FINISHED" | "FAILED");
        self.node_states.is_empty() && !self.driving && self.action_states.iter().all(is_done)
    }
}

impl StateError {
    /// A warning about one thing.
    pub fn warning(kind: &str, why: String, references: &[(&str, &str)]) -> Self {
        let references: Vec<Value> = references
            .iter()
            .map(|(key, value)| serde_json::json!({ "referenceKey": key, "referenceValue": value }))
            .collect();
        let rest = Map::from_iter([
            ("errorDescription".to_owned(), Value::from(why)),
            ("errorReferences".to_owned(), Value::from(references)),
        ]);
        Self { error_type: kind.into(), error_level: "WARNING".into(), rest }
    }
}
