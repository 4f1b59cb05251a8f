//! The Layout Interchange Format of the VDMA (LIF 0.11 to 1.x): layouts of nodes and edges with properties by vehicle type.
//!
//! An edge is the NURBS trajectory of the vehicle type, or the straight line between its nodes. Without a type asked for,
//! every edge is there, with the properties of the first type that it names.

use super::layout::{Edge, Id, Layout, Node, Placed};
use super::value::Object;
use super::{ImportError, Options, Warnings, trajectory, value};
use serde_json::Value;
use std::collections::{BTreeSet, HashMap, HashSet};

/// Largest gap between the end of a trajectory and its node that goes without a warning \[m\].
const GAP: f64 = 1e-3;

/// Whether a JSON value looks like a layout.
pub(super) fn is_layout(root: &Value) -> bool {
    root.get("layouts").is_some()
}

/// Reads all layouts of a file as one with several levels.
pub(super) fn read(text: &str, options: &Options, warnings: &mut Warnings) -> Result<Layout, ImportError> {
    let value = value::parse(text)?;
    let root = Object::new("LIF", &value)?;
    if root.get("layouts").is_none() {
        return Err(root.missing("layouts"));
    }
    let name = root.object("metaInformation").ok().flatten();
    let name = name.and_then(|meta| meta.text("projectIdentification").ok().flatten()).unwrap_or_default();
    let mut reader = Reader {
        layout: Layout { name: name.to_owned(), corner_radius: options.corner_radius, ..Layout::default() },
        nodes: HashMap::new(),
        edges: HashSet::new(),
        types: BTreeSet::new(),
        options,
        warnings,
    };
    let mut edges = Vec::new();
    for (k, value) in root.list("layouts")?.iter().enumerate() {
        let layout = Object::new(format!("layout {}", k + 1), value)?;
        let id = layout.text("layoutId")?.unwrap_or("").to_owned();
        for (k, value) in layout.list("nodes")?.iter().enumerate() {
            reader.node(k, value, &id);
        }
        edges.extend(layout.list("edges")?);
    }
    for (k, value) in edges.into_iter().enumerate() {
        reader.edge(k, value);
    }
    let Reader { mut layout, types, .. } = reader;
    layout.vehicle_types = types.iter().filter(|name| !name.is_empty()).cloned().collect();
    if layout.nodes.is_empty() {
        return Err(ImportError::new("LIF, layouts: there is no node in them"));
    }
    match &options.vehicle {
        Some(asked) if !types.contains(asked) => {
            let there = types.into_iter().collect::<Vec<_>>().join(", ");
            return Err(ImportError::new(format!("vehicle {asked}: no edge is for it; there are {there}")));
        }
        None if types.len() > 1 => {
            let there = types.into_iter().collect::<Vec<_>>().join(", ");
            warnings
                .add(there, "several vehicle types; each edge is taken as for the first one it names (--vehicle TYPE)");
        }
        _ => {}
    }
    Ok(layout)
}

struct Reader<'a> {
    layout: Layout,
    nodes: HashMap<String, usize>,
    edges: HashSet<String>,
    types: BTreeSet<String>,
    options: &'a Options,
    warnings: &'a mut Warnings,
}

impl Reader<'_> {
    fn node(&mut self, k: usize, value: &Value, layout: &str) {
        match read_node(k, value, layout) {
            Err(error) => self.warnings.add(error, "left out"),
            Ok((id, ..)) if self.nodes.contains_key(&id) => {
                self.warnings.add(format_args!("node {id}"), "given twice; the first is taken");
            }
            Ok((id, name, level, at)) => {
                let known = self.layout.levels.iter().position(|other| *other == level);
                let level = known.unwrap_or_else(|| {
                    self.layout.levels.push(level);
                    self.layout.levels.len() - 1
                });
                self.nodes.insert(id.clone(), self.layout.nodes.len());
                self.layout.nodes.push(Node { id: Id::Text(id), name, level, at });
            }
        }
    }

    fn edge(&mut self, k: usize, value: &Value) {
        if let Err(error) = self.try_edge(k, value) {
            self.warnings.add(error, "left out");
        }
    }

    fn try_edge(&mut self, k: usize, value: &Value) -> Result<(), ImportError> {
        let object = Object::new(format!("edge at place {}", k + 1), value)?;
        let id = object.text("edgeId")?.ok_or_else(|| object.missing("edgeId"))?.to_owned();
        let object = Object::new(format!("edge {id}"), value)?;
        if self.edges.contains(&id) {
            return Err(ImportError::new(format!("edge {id}, given twice")));
        }
        let place = |field: &str| {
            let node = object.text(field)?.ok_or_else(|| object.missing(field))?;
            let place = self.nodes.get(node).copied();
            place.ok_or_else(|| ImportError::new(format!("edge {id}, {field}: there is no node {node}")))
        };
        let ends = [place("startNodeId")?, place("endNodeId")?];
        let mut chosen = None;
        let properties = object.list("vehicleTypeEdgeProperties")?;
        for (k, value) in properties.iter().enumerate() {
            let property = Object::new(format!("edge {id}, properties {}", k + 1), value)?;
            let vehicle = property.text("vehicleTypeId")?.unwrap_or_default().to_owned();
            if chosen.is_none() && self.options.vehicle.as_ref().is_none_or(|asked| *asked == vehicle) {
                chosen = Some(property);
            }
            self.types.insert(vehicle);
        }
        if chosen.is_none() && self.options.vehicle.is_some() {
            // Not for this vehicle.
            return Ok(());
        }
        let at = ends.map(|node| self.layout.nodes.get(node).map_or([0.0; 2], |node| node.at));
        let straight = Placed::line(at[0], at[1]);
        let mut edge = Edge {
            id: Id::Text(id.clone()),
            ends,
            curve: if straight.shape.length() > 0.0 { vec![straight] } else { Vec::new() },
            two_way: false,
            speed: None,
            rotation: None,
            deviation: 0.0,
        };
        if let Some(property) = chosen {
            edge.speed = property.positive("maxSpeed")?;
            edge.rotation = property.positive("maxRotationSpeed")?;
            if let Some(trajectory) = property.object("trajectory")? {
                let trajectory = trajectory.called(format!("edge {id}, trajectory"));
                let fit = trajectory::read(&trajectory, self.options.tolerance(), self.warnings)?;
                self.gaps(&id, &fit.pieces, at);
                (edge.curve, edge.deviation) = (fit.pieces, fit.deviation);
            }
        }
        if edge.curve.is_empty() {
            self.warnings.add(format_args!("edge {id}"), "its length is 0");
        }
        self.edges.insert(id);
        self.layout.edges.push(edge);
        Ok(())
    }

    /// Warns where a trajectory does not begin and end at its nodes.
    fn gaps(&mut self, id: &str, pieces: &[Placed], at: [[f64; 2]; 2]) {
        let ends = pieces.first().zip(pieces.last()).map(|(first, last)| [first.at, last.end()]);
        for ((end, node), place) in ends.into_iter().flatten().zip(at).zip(["begins", "ends"]) {
            let gap = (end[0] - node[0]).hypot(end[1] - node[1]);
            if gap > GAP {
                self.warnings
                    .add(format_args!("edge {id}"), format!("its trajectory {place} {gap:.3} m from its node"));
            }
        }
    }
}

/// Number, name, level and position of a node.
fn read_node(k: usize, value: &Value, layout: &str) -> Result<(String, Option<String>, String, [f64; 2]), ImportError> {
    let object = Object::new(format!("node at place {}", k + 1), value)?;
    let id = object.text("nodeId")?.ok_or_else(|| object.missing("nodeId"))?.to_owned();
    let object = Object::new(format!("node {id}"), value)?;
    let position = object.object("nodePosition")?.ok_or_else(|| object.missing("nodePosition"))?;
    let level = object.text("mapId")?.unwrap_or(layout).to_owned();
    let name = object.text("nodeName").ok().flatten().map(str::to_owned);
    Ok((id, name, level, position.point()?))
}
