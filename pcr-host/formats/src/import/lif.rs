//! The Layout Interchange Format of the VDMA (LIF 0.11 to 1.x): layouts of nodes and edges with properties by vehicle type.
//!
//! An edge is the NURBS trajectory of the vehicle type, or the straight line between its nodes. If no type is chosen,
//! all edges are read, and an edge is repeated if types have trajectories of their own.

use super::layout::{Edge, Id, Layout, Node};
use super::names::Names;
use super::trajectory::Trajectory;
use super::value::Object;
use super::{ImportError, Options, WarningCode, Warnings, facing, route, trajectory, value};
use crate::footprint::Footprint;
use crate::plane::distance;
use crate::scenario::Placed;
use serde_json::Value;
use std::collections::BTreeSet;

/// Largest gap between the end of a trajectory and its node that goes without a warning \[m\].
const GAP: f64 = 1e-3;

/// Gap that is rounding and nothing else \[m\].
const CLOSED: f64 = 1e-9;

/// Whether a JSON value looks like a layout.
pub(super) fn is_layout(root: &Value) -> bool {
    root.get("layouts").is_some()
}

/// Reads all layouts of a file as one with several levels, for a vehicle that is a disc or has an outline.
pub(super) fn read(
    text: &str,
    options: &Options,
    outline: Option<&Footprint>,
    warnings: &mut Warnings,
) -> Result<Layout, ImportError> {
    let value = value::parse(text)?;
    let root = Object::new("LIF", &value)?;
    if root.get("layouts").is_none() {
        return Err(root.missing("layouts"));
    }
    let name = root.object("metaInformation").ok().flatten();
    let name = name.and_then(|meta| meta.text("projectIdentification").ok().flatten()).unwrap_or_default();
    let mut reader = Reader {
        levels: Vec::new(),
        nodes: Names::new(),
        edges: Names::new(),
        thetas: Vec::new(),
        types: BTreeSet::new(),
        options,
        outline,
        of_speeds: None,
        warnings,
    };
    let mut edges = Vec::new();
    let layouts = root.list("layouts")?;
    let maps = maps(layouts.iter().filter_map(|layout| layout.get("nodes")));
    for (k, value) in layouts.iter().enumerate() {
        let layout = Object::new(format!("layout {}", k + 1), value)?;
        let unnamed = reader.unnamed(&layout, layouts, &maps)?;
        for list in ["nodes", "edges"] {
            // Under a wrong name they would be none.
            if layout.get(list).is_none() {
                reader.warnings.lose(layout.missing(list));
            }
        }
        for (k, value) in layout.list("nodes")?.iter().enumerate() {
            reader.node(k, value, unnamed.as_deref());
        }
        edges.extend(layout.list("edges")?);
    }
    for (k, value) in edges.into_iter().enumerate() {
        if let Err(error) = reader.edge(k, value) {
            reader.warnings.lose(error);
        }
    }
    let (nodes, edges) = (reader.nodes.list(), reader.edges.list());
    facing::warn_of_nodes("node", "theta", &reader.thetas, nodes, edges, outline, reader.warnings);
    let Reader { levels, nodes, edges, mut types, of_speeds, .. } = reader;
    types.remove("");
    let vehicle_types = types.iter().cloned().collect();
    if nodes.list().is_empty() {
        return Err(ImportError::new("LIF, layouts: there is no node in them"));
    }
    match &options.vehicle {
        Some(asked) if !types.contains(asked) => {
            let there = types.into_iter().collect::<Vec<_>>().join(", ");
            return Err(ImportError::new(format!("vehicle {asked}: no edge is for it; there are {there}")));
        }
        None if types.len() > 1 => {
            let there = types.into_iter().collect::<Vec<_>>().join(", ");
            warnings.add(
                WarningCode::SeveralGraphs,
                there,
                "several vehicle types; the ways of all of them are taken (--vehicle TYPE)",
            );
        }
        _ => {}
    }
    Ok(Layout {
        name: name.to_owned(),
        vehicle_types,
        of_speeds,
        levels,
        nodes: nodes.into_list(),
        edges: edges.into_list(),
        ..Layout::default()
    })
}

struct Reader<'a> {
    levels: Vec<String>,
    nodes: Names<Node>,
    edges: Names<Edge>,
    /// At which nodes vehicles face which way \[rad\].
    thetas: Vec<(usize, f64)>,
    types: BTreeSet<String>,
    options: &'a Options,
    /// The outline of the vehicle, if its heading matters.
    outline: Option<&'a Footprint>,
    /// The first edge whose vehicle types have different speeds.
    of_speeds: Option<Id>,
    warnings: &'a mut Warnings,
}

impl Reader<'_> {
    /// The level of the nodes of a layout that name no map, if it can be told; `maps` are those that nodes of the file name. Two levels
    /// instead of one would leave out what can touch, so that it is one where nothing tells them apart.
    fn unnamed(
        &mut self,
        layout: &Object<'_>,
        layouts: &[Value],
        maps: &BTreeSet<&str>,
    ) -> Result<Option<String>, ImportError> {
        let nodes = layout.list("nodes")?;
        if nodes.iter().all(|node| node.get("mapId").is_some_and(|map| !map.is_null())) {
            return Ok(None);
        }
        let own = self::maps(layout.get("nodes").into_iter());
        let only = [&own, maps].into_iter().find(|maps| maps.len() == 1).and_then(|maps| maps.first());
        let level = match (only, maps.is_empty()) {
            (Some(map), _) => (*map).to_owned(),
            (None, false) => return Ok(None),
            (None, true) => match layout.text("layoutLevelId")? {
                Some(level) => return Ok(Some(level.to_owned())),
                None => {
                    let first = layouts.first().and_then(|first| first.get("layoutId")?.as_str());
                    first.unwrap_or_default().to_owned()
                }
            },
        };
        if !maps.is_empty() || layouts.len() > 1 {
            let what = format!("nodes without mapId, which are taken to be on level {level}");
            self.warnings.add(WarningCode::AssumedLevel, &layout.name, what);
        }
        Ok(Some(level))
    }

    fn node(&mut self, k: usize, value: &Value, unnamed: Option<&str>) {
        match read_node(k, value, unnamed) {
            Err(error) => self.warnings.lose(error),
            Ok(ReadNode { object, id, name, level, at }) => {
                let known = self.levels.iter().position(|other| *other == level);
                let level = known.unwrap_or_else(|| {
                    self.levels.push(level);
                    self.levels.len() - 1
                });
                let place = self.nodes.add(Node { id: Id::Text(id), name, level, at }, self.warnings);
                if let Err(error) = self.node_thetas(&object, place) {
                    self.warnings.lose(error);
                }
            }
        }
    }

    /// Which way an outline faces at a node.
    fn node_thetas(&mut self, node: &Object<'_>, place: usize) -> Result<(), ImportError> {
        if self.outline.is_none() {
            return Ok(());
        }
        for (k, value) in node.list("vehicleTypeNodeProperties")?.iter().enumerate() {
            let property = Object::new(format!("{}, properties {}", node.name, k + 1), value)?;
            if self.is_asked(property.text("vehicleTypeId")?.unwrap_or_default())
                && let Some(theta) = property.number("theta")?
            {
                self.thetas.push((place, theta));
            }
        }
        Ok(())
    }

    /// Whether something is for the vehicle type that was asked for. What names no type is for all.
    fn is_asked(&self, vehicle: &str) -> bool {
        self.options.vehicle.as_ref().is_none_or(|asked| vehicle.is_empty() || asked == vehicle)
    }

    fn edge(&mut self, k: usize, value: &Value) -> Result<(), ImportError> {
        let object = Object::new(format!("edge at place {}", k + 1), value)?;
        let id = object.text("edgeId")?.ok_or_else(|| object.missing("edgeId"))?.to_owned();
        let object = object.called(format!("edge {id}"));
        let place = |field: &str| {
            let node = object.text(field)?.ok_or_else(|| object.missing(field))?;
            let place = self.nodes.place(&Id::Text(node.to_owned()));
            place.map_err(|unclear| ImportError::new(format!("edge {id}, {field}: {unclear}")))
        };
        let ends = [place("startNodeId")?, place("endNodeId")?];
        let mut edges: Vec<Edge> = Vec::new();
        let properties = object.list("vehicleTypeEdgeProperties")?;
        for (k, value) in properties.iter().enumerate() {
            let property = Object::new(format!("edge {id}, properties {}", k + 1), value)?;
            let vehicle = property.text("vehicleTypeId")?.unwrap_or_default().to_owned();
            let asked = self.is_asked(&vehicle);
            self.types.insert(vehicle);
            if asked {
                let edge = self.along(&id, ends, Some(&property))?;
                // An equal edge at the speed of another type of vehicle is the same edge; only one of the speeds is kept.
                match edges.iter_mut().find(|known| known.curve == edge.curve) {
                    None => edges.push(edge),
                    Some(known) => {
                        // What stands for different curves is as far off as from the farthest of them.
                        known.deviation = known.deviation.max(edge.deviation);
                        known.longer = known.longer.max(edge.longer);
                        known.turned = known.turned.max(edge.turned);
                        if (known.speed, known.rotation) != (edge.speed, edge.rotation) {
                            self.of_speeds.get_or_insert(edge.id);
                        }
                    }
                }
            }
        }
        if properties.is_empty() {
            edges.push(self.along(&id, ends, None)?);
        }
        for edge in edges {
            self.edges.add(edge, self.warnings);
        }
        Ok(())
    }

    /// The edge with the properties of a vehicle type.
    fn along(&mut self, id: &str, ends: [usize; 2], property: Option<&Object<'_>>) -> Result<Edge, ImportError> {
        let at = ends.map(|node| self.nodes.list()[node].at);
        let straight = Placed::line(at[0], at[1]);
        let curve = if straight.shape.length() > 0.0 { vec![straight] } else { Vec::new() };
        let mut edge = Edge::new(Id::Text(id.to_owned()), ends, curve);
        if let Some(property) = property {
            edge.speed = [property.positive("maxSpeed")?; 2];
            edge.rotation = property.positive("maxRotationSpeed")?;
            for field in ["rotationAtStartNodeAllowed", "rotationAtEndNodeAllowed"] {
                if property.get(field).is_some_and(|allowed| allowed.as_str() != Some("BOTH")) {
                    let problem =
                        format!("its {field} is not read; a vehicle turns in place where its path has a corner");
                    self.warnings.add(WarningCode::UnreadField, format_args!("edge {id}"), problem);
                }
            }
            if let Some(outline) = self.outline {
                let is_line = straight.shape.length() > 0.0 && property.get("trajectory").is_none();
                let ahead = Some(straight.heading).filter(|_| is_line);
                let edge = property.clone().called(format!("edge {id}"));
                facing::along(&edge, "vehicleOrientation", 1_f64.to_radians(), ahead, outline, self.warnings)?;
                if property.flag("rotationAllowed")? == Some(true) {
                    self.warnings.add(WarningCode::Orientation, format_args!("edge {id}"), facing::ROTATION);
                }
            }
            if let Some(trajectory) = property.object("trajectory")? {
                let trajectory = trajectory.called(format!("edge {id}, trajectory"));
                let Trajectory { fit, ends } = trajectory::read(&trajectory, self.options.tolerance(), self.warnings)?;
                if let Some(outline) = self.outline {
                    facing::along_trajectory(&trajectory, &fit, outline, self.warnings)?;
                }
                let gap = if fit.pieces.is_empty() { point_gap(id, ends, at)? } else { self.gap(id, ends, at) };
                (edge.deviation, edge.longer, edge.turned) = (fit.deviation + gap, fit.longer, fit.turned);
                edge.curve = fit.pieces;
            }
        }
        if edge.curve.is_empty() {
            self.warnings.add(WarningCode::ZeroLength, format_args!("edge {id}"), "its length is 0");
        }
        Ok(edge)
    }

    /// The largest gap between the ends of a trajectory and their nodes that a route passes \[m\], with warnings.
    fn gap(&mut self, id: &str, ends: [[f64; 2]; 2], at: [[f64; 2]; 2]) -> f64 {
        let mut passed = 0.0_f64;
        for ((end, node), place) in ends.into_iter().zip(at).zip(["begins", "ends"]) {
            let gap = distance(end, node);
            let is_passed = gap <= route::GAP;
            if is_passed && gap > CLOSED {
                passed = passed.max(gap);
            }
            if gap > GAP {
                let told =
                    if is_passed { "" } else { "; no route passes there, and no lock covers what is between them" };
                self.warnings.add(
                    WarningCode::Gap,
                    format_args!("edge {id}"),
                    format!("its trajectory {place} {gap:.3} m from its node{told}"),
                );
            }
        }
        passed
    }
}

/// Maps that nodes name.
fn maps<'v>(nodes: impl Iterator<Item = &'v Value>) -> BTreeSet<&'v str> {
    nodes.filter_map(Value::as_array).flatten().filter_map(|node| node.get("mapId")?.as_str()).collect()
}

/// How far a vehicle may be from either node of a trajectory that is a point \[m\]: it counts as a way from node to node only if both nodes
/// are near.
fn point_gap(id: &str, ends: [[f64; 2]; 2], at: [[f64; 2]; 2]) -> Result<f64, ImportError> {
    let gap = ends.into_iter().zip(at).map(|(end, node)| distance(end, node)).fold(0.0, f64::max);
    if gap > route::GAP {
        return Err(ImportError::new(format!(
            "edge {id}, trajectory: it has no length, and is {gap:.3} m from a node"
        )));
    }
    // From one node over the point to the other.
    Ok(gap.max(distance(at[0], at[1])))
}

/// A node of a file.
struct ReadNode<'j> {
    object: Object<'j>,
    id: String,
    name: Option<String>,
    level: String,
    at: [f64; 2],
}

/// Reads a node; `unnamed` is the level if it names no map.
fn read_node<'j>(k: usize, value: &'j Value, unnamed: Option<&str>) -> Result<ReadNode<'j>, ImportError> {
    let object = Object::new(format!("node at place {}", k + 1), value)?;
    let id = object.text("nodeId")?.ok_or_else(|| object.missing("nodeId"))?.to_owned();
    let object = object.called(format!("node {id}"));
    let position = object.object("nodePosition")?.ok_or_else(|| object.missing("nodePosition"))?;
    let level = object.text("mapId")?.or(unnamed).ok_or_else(|| object.missing("mapId"))?.to_owned();
    let name = object.text("nodeName").ok().flatten().map(str::to_owned);
    Ok(ReadNode { object, id, name, level, at: position.point()? })
}
