//! Roadmaps with tasks that come over time, as Adcombrink/CPLP-LifelongMAPFR (Combrink, Roselli, Fabian, arXiv 2503.13175) writes them
//! (JSON of networkx).

use crate::error::LabError;
use pcr_execution::lifelong::TaskStream;
use pcr_formats::import::{ElementId, ImportedLayout, Layout, LayoutEdge, LayoutNode, SizeSource, VehicleTraits};
use pcr_formats::scenario::PlacedSegment;
use serde_json::Value;
use std::collections::HashMap;

/// Large enough for robots that start, stop and turn at once \[m/s², rad/s, rad/s²\].
const AT_ONCE: f64 = 1e4;

/// The roadmap for robots of radius 1 and speed 1, and what they have to do.
///
/// # Errors
/// Where the text is none.
pub fn read(text: &str) -> Result<(ImportedLayout, TaskStream), LabError> {
    let value: Value = serde_json::from_str(text)?;
    let list = |value: &Value, name: &'static str| value[name].as_array().cloned().ok_or(LabError::NoList(name));
    let graph = &value["graph"];
    let (mut nodes, mut places) = (Vec::new(), HashMap::new());
    for (place, node) in list(graph, "nodes")?.iter().enumerate() {
        let id = text_of(&node["id"])?;
        let [Some(x), Some(y)] = [0, 1].map(|axis| node["pos"][axis].as_f64()) else {
            return Err(LabError::NoPosition(id));
        };
        places.insert(id.clone(), place);
        nodes.push(LayoutNode { id: ElementId::Text(id), name: None, level: 0, point: [x, y] });
    }
    let place = |value: &Value| {
        let id = text_of(value)?;
        places.get(&id).copied().ok_or(LabError::NoSuchNode(id))
    };
    let mut edges = Vec::new();
    for (number, link) in list(graph, "links")?.iter().enumerate() {
        let ends = [place(&link["source"])?, place(&link["target"])?];
        let [from, to] = ends.map(|node: usize| nodes[node].point);
        edges.push(LayoutEdge::new(ElementId::Number(number as u64), ends, vec![PlacedSegment::line(from, to)]));
    }
    let layout = Layout { levels: vec![String::new()], nodes, edges, ..Layout::default() };
    let vehicle = VehicleTraits {
        name: None,
        radius: 1.0,
        footprint: None,
        size: SizeSource::Option,
        margin: 0.0,
        speed: 1.0,
        acceleration: AT_ONCE,
        rotation: AT_ONCE,
        rotation_acceleration: AT_ONCE,
    };
    let starts = value["agent_start"].as_object().ok_or(LabError::NoStarts)?;
    let starts = starts.values().map(place).collect::<Result<_, LabError>>()?;
    let task = |task: &Value| Ok((place(&task[0])?, task[1].as_f64().ok_or(LabError::NoTaskTime)?));
    let tasks = list(&value, "tasks")?.iter().map(task).collect::<Result<_, LabError>>()?;
    Ok((ImportedLayout { layout, vehicle }, TaskStream { starts, tasks }))
}

fn text_of(value: &Value) -> Result<String, LabError> {
    value.as_str().map(str::to_owned).ok_or(LabError::NoNodeName)
}
