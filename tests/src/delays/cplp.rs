//! Roadmaps of the benchmark of CPLP (Combrink, arXiv 2503.13175): node-link JSON, straight edges, discs of radius 1 at speed 1.

use pcr_formats::import::{Edge, Id, Imported, Layout, Node, Vehicle};
use pcr_formats::scenario::{PathSegment, Placed};
use serde_json::Value;
use std::collections::HashMap;

/// Radius of the discs \[m\].
pub const RADIUS: f64 = 1.0;
/// \[m/s\]
pub const SPEED: f64 = 1.0;

/// A roadmap.
#[derive(Clone, Debug)]
pub struct Roadmap {
    /// Ids and places.
    pub nodes: Vec<(String, [f64; 2])>,
    /// Places in `nodes`.
    pub edges: Vec<[usize; 2]>,
}

impl Roadmap {
    /// Reads one.
    ///
    /// # Panics
    /// On anything else.
    pub fn read(text: &str) -> Self {
        let file: Value = serde_json::from_str(text).expect("JSON");
        let list = |name: &str| file["graph"][name].as_array().expect("a graph").clone();
        let text = |value: &Value| value.as_str().expect("a name").to_owned();
        let node = |node: &Value| (text(&node["id"]), [0, 1].map(|axis| node["pos"][axis].as_f64().expect("a place")));
        let nodes: Vec<_> = list("nodes").iter().map(node).collect();
        let places: HashMap<&str, usize> =
            nodes.iter().enumerate().map(|(place, (id, _))| (id.as_str(), place)).collect();
        let ends = |edge: &Value| [places[&*text(&edge["source"])], places[&*text(&edge["target"])]];
        Self { edges: list("links").iter().map(ends).collect(), nodes }
    }

    /// Where an edge begins and ends.
    pub fn ends(&self, edge: usize) -> [[f64; 2]; 2] {
        self.edges[edge].map(|node| self.nodes[node].1)
    }

    /// The same as a layout, with edges numbered as here.
    pub fn imported(&self) -> Imported {
        let nodes = self.nodes.iter().map(|(id, at)| Node { id: Id::Text(id.clone()), name: None, level: 0, at: *at });
        let edges = (0..self.edges.len()).map(|edge| {
            let [[x, y], [u, v]] = self.ends(edge);
            let shape = PathSegment::Line { length: (u - x).hypot(v - y) };
            Edge {
                id: Id::Number(edge as u64),
                ends: self.edges[edge],
                curve: vec![Placed { at: [x, y], heading: (v - y).atan2(u - x), shape }],
                two_way: false,
                speed: None,
                rotation: None,
                deviation: 0.0,
            }
        });
        let layout =
            Layout { levels: vec![String::new()], nodes: nodes.collect(), edges: edges.collect(), ..Layout::default() };
        let vehicle = Vehicle {
            name: None,
            radius: RADIUS,
            footprint: None,
            margin: 0.0,
            speed: SPEED,
            acceleration: 1.0,
            rotation: 1.0,
            rotation_acceleration: 1.0,
        };
        Imported { layout, vehicle }
    }
}
