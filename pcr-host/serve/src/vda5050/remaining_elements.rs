//! Nodes and edges of an order that are still ahead, as listed in states.

use pcr_formats::vda5050::order::{NodePosition, OrderEdge, OrderNode};
use serde::Serialize;
use serde_json::Value;

/// A node still to be passed, to be written.
#[derive(Debug, Serialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct NodeStateOut<'a> {
    node_id: &'a str,
    sequence_id: u64,
    /// Part of the base.
    pub released: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    node_position: Option<NodePositionOut<'a>>,
}

#[derive(Debug, Serialize)]
#[serde(rename_all = "camelCase")]
struct NodePositionOut<'a> {
    x: f64,
    y: f64,
    /// Schema 2.0 asks for one.
    theta: f64,
    map_id: &'a str,
}

impl<'a> From<&'a OrderNode> for NodeStateOut<'a> {
    fn from(node: &'a OrderNode) -> Self {
        let place = |position: &'a NodePosition| NodePositionOut {
            x: position.x,
            y: position.y,
            theta: position.rest.get("theta").and_then(Value::as_f64).unwrap_or(0.0),
            map_id: &position.map_id,
        };
        let node_position = node.node_position.as_ref().map(place);
        Self { node_id: &node.node_id, sequence_id: node.sequence_id, released: node.released, node_position }
    }
}

/// An edge still to be travelled, to be written.
#[derive(Debug, Serialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct EdgeStateOut<'a> {
    edge_id: &'a str,
    sequence_id: u64,
    released: bool,
}

impl<'a> From<&'a OrderEdge> for EdgeStateOut<'a> {
    fn from(edge: &'a OrderEdge) -> Self {
        Self { edge_id: &edge.edge_id, sequence_id: edge.sequence_id, released: edge.released }
    }
}
