//! Nodes and edges of an order that are still ahead, as listed in states.

use pcr_formats::vda5050::order::{Edge, Node, NodePosition};
use serde::Serialize;
use serde_json::Value;

/// A node still to be passed, to be written.
#[derive(Debug, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct NodeAhead<'a> {
    node_id: &'a str,
    sequence_id: u64,
    /// Part of the base.
    pub released: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    node_position: Option<Place<'a>>,
}

#[derive(Debug, Serialize)]
#[serde(rename_all = "camelCase")]
struct Place<'a> {
    x: f64,
    y: f64,
    /// Schema 2.0 asks for one.
    theta: f64,
    map_id: &'a str,
}

impl<'a> From<&'a Node> for NodeAhead<'a> {
    fn from(node: &'a Node) -> Self {
        let place = |position: &'a NodePosition| Place {
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
pub struct EdgeAhead<'a> {
    edge_id: &'a str,
    sequence_id: u64,
    released: bool,
}

impl<'a> From<&'a Edge> for EdgeAhead<'a> {
    fn from(edge: &'a Edge) -> Self {
        Self { edge_id: &edge.edge_id, sequence_id: edge.sequence_id, released: edge.released }
    }
}
