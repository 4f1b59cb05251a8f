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
    /// A state message of a vehicle.
    State {
        /// Order id of its present or last order.
        order_id: String,
        /// Order update id.
        order_update_id: u64,
        /// Node id of the node that it reached last.
        last_node_id: String,
        /// Sequence number of that node.
        last_node_sequence_id: u64,
        /// Nodes that are still to be passed.
        node_states: PartialList<NodeState>,
        /// Edges that are still to be travelled.
        edge_states: PartialList<EdgeState>,
        /// Whether it drives.
        driving: bool,
        /// Whether it requests more base.
        #[serde(skip_serializing_if = "Option::is_none")]
        new_base_request: Option<bool>,
        /// Position, in 2.x.
        #[serde(skip_serializing_if = "Option::is_none")]
        agv_position: Option<VehiclePosition>,
        /// Position, in 3.0.
        #[serde(skip_serializing_if = "Option::is_none")]
        mobile_robot_position: Option<VehiclePosition>,
        /// Its velocity.
        #[serde(skip_serializing_if = "Option::is_none")]
        velocity: Option<Velocity>,
        /// States of its actions.
        action_states: Vec<ActionState>,
        /// States of its instant actions, since 3.0.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        instant_action_states: Option<Vec<ActionState>>,
        /// Operating mode.
        operating_mode: String,
        /// Errors that it reports.
        errors: Vec<ErrorEntry>,
    }
}

/// A list of which a few fields are read. The text is kept as it was written: it is long, and most of it is passed on or
/// dropped.
#[derive(Clone, Debug)]
pub struct PartialList<T> {
    text: Arc<RawValue>,
    items: Vec<T>,
}

impl<T> PartialList<T> {
    /// A list to be written; its items are not read.
    pub fn written(all: &[impl Serialize]) -> Self {
        // Lists of numbers and texts can always be written.
        Self { text: to_raw_value(all).unwrap_or_default().into(), items: Vec::new() }
    }
}

impl<T> Deref for PartialList<T> {
    type Target = [T];

    fn deref(&self) -> &[T] {
        &self.items
    }
}

impl<T> PartialEq for PartialList<T> {
    fn eq(&self, other: &Self) -> bool {
        self.text.get() == other.text.get()
    }
}

impl<T> Serialize for PartialList<T> {
    fn serialize<S: Serializer>(&self, writer: S) -> Result<S::Ok, S::Error> {
        self.text.serialize(writer)
    }
}

impl<'de, T: DeserializeOwned> Deserialize<'de> for PartialList<T> {
    fn deserialize<D: Deserializer<'de>>(reader: D) -> Result<Self, D::Error> {
        let text = Box::<RawValue>::deserialize(reader)?;
        let items = serde_json::from_str(text.get()).or_else(|_| {
            // Deserialized again, to find the field that is wrong.
            serde_path_to_error::deserialize(&mut serde_json::Deserializer::from_str(text.get()))
        });
        Ok(Self { items: items.map_err(Error::custom)?, text: text.into() })
    }
}

/// The fields that are read of a node still to be passed.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct NodeState {
    /// Node id, only checked to be a text.
    node_id: IgnoredText,
    /// Sequence number of the node.
    pub sequence_id: u64,
    /// Whether it belongs to the base.
    pub released: bool,
}

/// The fields that are read of an edge still to be travelled.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct EdgeState {
    /// Edge id, only checked to be a text.
    edge_id: IgnoredText,
    /// Sequence number of the edge.
    pub sequence_id: u64,
    /// Whether it belongs to the base.
    pub released: bool,
}

/// A text that is not stored.
#[derive(Clone, Copy, Debug, PartialEq)]
struct IgnoredText;

impl<'de> Deserialize<'de> for IgnoredText {
    fn deserialize<D: Deserializer<'de>>(reader: D) -> Result<Self, D::Error> {
        struct IgnoredTextVisitor;
        impl Visitor<'_> for IgnoredTextVisitor {
            type Value = IgnoredText;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a string")
            }

            fn visit_str<E: Error>(self, _: &str) -> Result<IgnoredText, E> {
                Ok(IgnoredText)
            }
        }
        reader.deserialize_str(IgnoredTextVisitor)
    }
}

/// Position of a vehicle.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct VehiclePosition {
    /// \[m\]
    pub x: f64,
    /// \[m\]
    pub y: f64,
    /// \[rad\]
    pub theta: f64,
    /// Map id.
    pub map_id: String,
    /// Whether the vehicle is localized, in 2.x.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub position_initialized: Option<bool>,
    /// Whether the vehicle is localized, in 3.0.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub localized: Option<bool>,
    /// Largest deviation of the position \[m\].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub deviation_range: Option<f64>,
    /// Quality of the localization, 0 to 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub localization_score: Option<f64>,
    /// All other fields, kept unchanged.
    #[serde(flatten)]
    pub rest: Map<String, Value>,
}

impl VehiclePosition {
    /// Whether the vehicle says that it is localized.
    pub fn is_known(&self) -> bool {
        self.position_initialized.or(self.localized).unwrap_or(false)
            && self.localization_score.is_none_or(|it| it > 0.0)
            && self.deviation_range.is_none_or(|it| it >= 0.0)
    }
}

/// Velocity of a vehicle in its own coordinates.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Velocity {
    /// Forward \[m/s\].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub vx: Option<f64>,
    /// To the left \[m/s\].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub vy: Option<f64>,
    /// \[rad/s\]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub omega: Option<f64>,
}

/// State of an action.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct ActionState {
    /// Action id.
    pub action_id: String,
    /// `WAITING`, `INITIALIZING`, `RUNNING`, `PAUSED`, `FINISHED`, `FAILED`, `RETRIABLE`.
    pub action_status: String,
    /// All other fields, kept unchanged.
    #[serde(flatten)]
    pub rest: Map<String, Value>,
}

/// An error that a vehicle reports.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct ErrorEntry {
    /// Error type.
    pub error_type: String,
    /// Error level.
    pub error_level: String,
    /// All other fields, kept unchanged.
    #[serde(flatten)]
    pub rest: Map<String, Value>,
}

impl State {
    /// Position of the vehicle, in any edition.
    pub fn position(&self) -> Option<&VehiclePosition> {
        self.agv_position.as_ref().or(self.mobile_robot_position.as_ref())
    }

    /// Sequence number of the last node of its base.
    pub fn base(&self) -> u64 {
        let released = self.node_states.iter().filter(|node| node.released).map(|node| node.sequence_id);
        released.max().unwrap_or(self.last_node_sequence_id)
    }

    /// Status of an action, instant or not.
    pub fn action(&self, action_id: &str) -> Option<&str> {
        let mut all = self.action_states.iter().chain(self.instant_action_states.iter().flatten());
        all.find(|state| state.action_id == action_id).map(|state| state.action_status.as_str())
    }

    /// Whether the state mentions an action, in its action states or its errors.
    pub fn names(&self, action_id: &str) -> bool {
        let mut references =
            self.errors.iter().filter_map(|error| error.rest.get("errorReferences")?.as_array()).flatten();
        self.action(action_id).is_some() || references.any(|reference| reference["referenceValue"] == action_id)
    }

    /// Whether the vehicle has completed its order.
    pub fn is_idle(&self) -> bool {
        let is_done = |state: &ActionState| matches!(state.action_status.as_str(), "FINISHED" | "FAILED");
        self.node_states.is_empty() && !self.driving && self.action_states.iter().all(is_done)
    }
}

impl ErrorEntry {
    /// A warning with references.
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

    /// What the error refers to under this key.
    pub fn reference(&self, key: &str) -> Option<String> {
        let all = self.rest.get("errorReferences")?.as_array()?;
        all.iter().find(|said| said["referenceKey"] == key).and_then(|said| text(&said["referenceValue"]))
    }

    /// Whether the error says that this order, or an update of it, is not taken: `orderError`, `orderUpdateError`, `validationError`,
    /// `noRouteError` in 2.x, `INVALID_ORDER`, `OUTDATED_ORDER_UPDATE`, `VALIDATION_FAILURE`, `NO_ROUTE_TO_TARGET` and others in 3.0.
    pub fn refuses(&self, order_id: &str) -> bool {
        let name = self.error_type.to_ascii_lowercase();
        ["order", "validation", "route"].iter().any(|word| name.contains(word))
            && self.reference(ORDER).as_deref() == Some(order_id)
    }
}

/// Key of references to orders.
pub const ORDER: &str = "orderId";

/// A text, or a number that should be one.
pub fn text(value: &Value) -> Option<String> {
    value.as_str().map(str::to_owned).or_else(|| value.as_u64().map(|number| number.to_string()))
}
