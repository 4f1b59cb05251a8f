//! Orders: nodes and edges to be travelled, of which the first ones are released.

use super::decode::DecodeError;
use super::header::message;
use super::messages::Action;
use super::version::ProtocolVersion;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

message! {
    /// An order, or an update of one.
    Order {
        /// Order id.
        order_id: String,
        /// Order update id, from 0.
        order_update_id: u64,
        /// The nodes, in the order of travel after [`Order::check`].
        nodes: Vec<OrderNode>,
        /// The edges: one less than nodes.
        edges: Vec<OrderEdge>,
    }
}

/// A node of an order.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct OrderNode {
    /// Node id.
    pub node_id: String,
    /// Sequence number; even, because edges have the odd numbers in between.
    pub sequence_id: u64,
    /// Whether it belongs to the base.
    pub released: bool,
    /// Position of the node.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub node_position: Option<NodePosition>,
    /// Actions at the node.
    #[serde(default)]
    pub actions: Vec<Action>,
    /// All other fields of the message, kept unchanged.
    #[serde(flatten)]
    pub extra: Map<String, Value>,
}

/// Position of a node.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct NodePosition {
    /// \[m\]
    pub x: f64,
    /// \[m\]
    pub y: f64,
    /// Map id.
    pub map_id: String,
    /// All other fields, kept unchanged.
    #[serde(flatten)]
    pub rest: Map<String, Value>,
}

/// Field names of the allowed deviation at a node, in different editions.
pub const DEVIATIONS: [&str; 2] = ["allowedDeviationXY", "allowedDeviationXy"];

impl NodePosition {
    /// Allowed deviation of the vehicle at the node \[m\], if it is given.
    ///
    /// # Errors
    /// A value that is not such a deviation.
    pub fn deviation(&self) -> Result<Option<f64>, DecodeError> {
        let Some((name, value)) = DEVIATIONS.iter().find_map(|name| self.rest.get_key_value(*name)) else {
            return Ok(None);
        };
        let number = |value: &Value| value.as_f64().filter(|number| *number >= 0.0);
        // Since 3.0 the deviation is an ellipse.
        let axes = || Some(number(value.get("a")?)?.max(number(value.get("b")?)?));
        number(value).or_else(axes).map(Some).ok_or_else(|| DecodeError::new(name, "no distance from 0"))
    }
}

/// An edge of an order.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct OrderEdge {
    /// Edge id.
    pub edge_id: String,
    /// Sequence number; odd.
    pub sequence_id: u64,
    /// Whether it belongs to the base.
    pub released: bool,
    /// Id of the node where it begins; absent in 3.0.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub start_node_id: Option<String>,
    /// Id of the node where it ends; absent in 3.0.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub end_node_id: Option<String>,
    /// Actions on the edge.
    #[serde(default)]
    pub actions: Vec<Action>,
    /// Trajectory, if the edge is not straight.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub trajectory: Option<Value>,
    /// All other fields, kept unchanged.
    #[serde(flatten)]
    pub rest: Map<String, Value>,
}

/// The field with the room beside an edge in which a vehicle may leave its way, since 2.1.
const CORRIDOR: &str = "corridor";

/// The fields with the largest speed on an edge: up to 2.1, and in 3.0.
const MAX_SPEED: [&str; 2] = ["maxSpeed", "maximumSpeed"];

impl OrderEdge {
    /// Whether a vehicle may leave its way on it.
    pub fn has_corridor(&self) -> bool {
        self.rest.get(CORRIDOR).is_some_and(|corridor| !corridor.is_null())
    }

    /// Makes it one on which a vehicle keeps to its way.
    pub fn remove_corridor(&mut self) {
        self.rest.remove(CORRIDOR);
    }

    /// The largest speed on it \[m/s\], if it says one in the name of any edition.
    pub fn max_speed(&self) -> Option<f64> {
        MAX_SPEED.iter().filter_map(|name| self.rest.get(*name)?.as_f64()).reduce(f64::min)
    }

    /// Sets the largest speed on it \[m/s\], for a vehicle of this edition; what is not known counts as 2.1.
    pub fn set_max_speed(&mut self, speed: f64, version: Option<ProtocolVersion>) {
        for name in MAX_SPEED {
            self.rest.remove(name);
        }
        let [before, after] = MAX_SPEED;
        let name = if version == Some(ProtocolVersion::V3_0) { after } else { before };
        self.rest.insert(name.into(), speed.into());
    }
}

impl Order {
    /// Sorts nodes and edges into the order of travel, and checks that they form one way whose first part is released.
    ///
    /// # Errors
    /// [`DecodeError`] with the name of the field.
    pub fn check(&mut self) -> Result<(), DecodeError> {
        let Self { nodes, edges, .. } = self;
        nodes.sort_by_key(|node| node.sequence_id);
        edges.sort_by_key(|edge| edge.sequence_id);
        if self.order_id.is_empty() {
            return Err(DecodeError::new("orderId", "empty"));
        }
        if nodes.len() != edges.len() + 1 {
            return Err(DecodeError::new(
                "nodes",
                format!("{} nodes and {} edges are no way", nodes.len(), edges.len()),
            ));
        }
        if let Some(first) = nodes.first().filter(|first| !first.released) {
            return Err(DecodeError::new(
                "nodes[0].released",
                format!("node {} is where the base begins", first.node_id),
            ));
        }
        let mut released = true;
        for (k, (edge, ends)) in edges.iter().zip(nodes.windows(2)).enumerate() {
            let [from, to] = ends else { continue };
            if from.sequence_id.checked_add(1) != Some(edge.sequence_id)
                || edge.sequence_id.checked_add(1) != Some(to.sequence_id)
            {
                let numbers = [from.sequence_id, edge.sequence_id, to.sequence_id];
                return Err(DecodeError::new(
                    format!("edges[{k}].sequenceId"),
                    format!("{numbers:?} do not follow one another"),
                ));
            }
            for (field, said, node) in
                [("startNodeId", &edge.start_node_id, from), ("endNodeId", &edge.end_node_id, to)]
            {
                if said.as_ref().is_some_and(|said| *said != node.node_id) {
                    let node = &node.node_id;
                    return Err(DecodeError::new(format!("edges[{k}].{field}"), format!("by sequenceId it is {node}")));
                }
            }
            if edge.released != to.released || (edge.released && !released) {
                return Err(DecodeError::new(format!("edges[{k}].released"), "the base is one way up to a node"));
            }
            released = edge.released;
        }
        Ok(())
    }

    /// Index of the last node of the base.
    pub fn base(&self) -> usize {
        self.nodes.iter().take_while(|node| node.released).count().saturating_sub(1)
    }
}
