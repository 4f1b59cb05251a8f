//! Orders: nodes and edges to be travelled, of which the first ones are released.

use super::door::Refusal;
use super::header::message;
use super::messages::Action;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

message! {
    /// An order, or an update of one.
    Order {
        /// Which.
        order_id: String,
        /// Which update of it, from 0.
        order_update_id: u64,
        /// In the order of travel once [`Order::check`] has looked at it.
        nodes: Vec<Node>,
        /// One less than nodes.
        edges: Vec<Edge>,
    }
}

/// A place to be passed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct Node {
    /// Name.
    pub node_id: String,
    /// Even; edges have the odd numbers in between.
    pub sequence_id: u64,
    /// Part of the base.
    pub released: bool,
    /// Where it is.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub node_position: Option<NodePosition>,
    /// What is to be done there.
    #[serde(default)]
    pub actions: Vec<Action>,
    /// All else.
    #[serde(flatten)]
    pub rest: Map<String, Value>,
}

/// Where a node is.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct NodePosition {
    /// \[m\]
    pub x: f64,
    /// \[m\]
    pub y: f64,
    /// On which map.
    pub map_id: String,
    /// All else.
    #[serde(flatten)]
    pub rest: Map<String, Value>,
}

/// The names that editions give to how far off a vehicle may pass a node.
pub const DEVIATIONS: [&str; 2] = ["allowedDeviationXY", "allowedDeviationXy"];

impl NodePosition {
    /// How far off a vehicle may pass it \[m\], if that is said.
    ///
    /// # Errors
    /// What is no such value.
    pub fn deviation(&self) -> Result<Option<f64>, Refusal> {
        let Some((name, value)) = DEVIATIONS.iter().find_map(|name| self.rest.get_key_value(*name)) else {
            return Ok(None);
        };
        let number = |value: &Value| value.as_f64().filter(|number| *number >= 0.0);
        // Since 3.0 it is an ellipse.
        let axes = || Some(number(value.get("a")?)?.max(number(value.get("b")?)?));
        number(value).or_else(axes).map(Some).ok_or_else(|| Refusal::new(name, "no distance from 0"))
    }
}

/// A way from node to node.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct Edge {
    /// Name.
    pub edge_id: String,
    /// Odd.
    pub sequence_id: u64,
    /// Part of the base.
    pub released: bool,
    /// Where it begins; not in 3.0.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub start_node_id: Option<String>,
    /// Where it ends; not in 3.0.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub end_node_id: Option<String>,
    /// What is to be done on it.
    #[serde(default)]
    pub actions: Vec<Action>,
    /// The curve, where it is not straight.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub trajectory: Option<Value>,
    /// All else.
    #[serde(flatten)]
    pub rest: Map<String, Value>,
}

impl Order {
    /// Brings nodes and edges into the order of travel, and checks that they are one way whose beginning is released.
    ///
    /// # Errors
    /// [`Refusal`] with the field.
    pub fn check(&mut self) -> Result<(), Refusal> {
        let Self { nodes, edges, .. } = self;
        nodes.sort_by_key(|node| node.sequence_id);
        edges.sort_by_key(|edge| edge.sequence_id);
        if self.order_id.is_empty() {
            return Err(Refusal::new("orderId", "empty"));
        }
        if nodes.len() != edges.len() + 1 {
            return Err(Refusal::new("nodes", format!("{} nodes and {} edges are no way", nodes.len(), edges.len())));
        }
        if let Some(first) = nodes.first().filter(|first| !first.released) {
            return Err(Refusal::new("nodes[0].released", format!("node {} is where the base begins", first.node_id)));
        }
        let mut released = true;
        for (k, (edge, ends)) in edges.iter().zip(nodes.windows(2)).enumerate() {
            let [from, to] = ends else { continue };
            if from.sequence_id.checked_add(1) != Some(edge.sequence_id)
                || edge.sequence_id.checked_add(1) != Some(to.sequence_id)
            {
                let numbers = [from.sequence_id, edge.sequence_id, to.sequence_id];
                return Err(Refusal::new(
                    format!("edges[{k}].sequenceId"),
                    format!("{numbers:?} do not follow one another"),
                ));
            }
            for (field, said, node) in
                [("startNodeId", &edge.start_node_id, from), ("endNodeId", &edge.end_node_id, to)]
            {
                if said.as_ref().is_some_and(|said| *said != node.node_id) {
                    let node = &node.node_id;
                    return Err(Refusal::new(format!("edges[{k}].{field}"), format!("by sequenceId it is {node}")));
                }
            }
            if edge.released != to.released || (edge.released && !released) {
                return Err(Refusal::new(format!("edges[{k}].released"), "the base is one way up to a node"));
            }
            released = edge.released;
        }
        Ok(())
    }

    /// Place of the last node of the base.
    pub fn base(&self) -> usize {
        self.nodes.iter().take_while(|node| node.released).count().saturating_sub(1)
    }
}
