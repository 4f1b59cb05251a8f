//! The Layout Interchange Format of the VDMA (LIF 0.11 to 2.0): layouts of nodes and edges with properties by vehicle type.
//!
//! ```text
//! version     the version of a file, and what its names are
//! ```
//!
//! An edge is the NURBS trajectory of the vehicle type, or the straight line between its nodes. If no type is chosen,
//! all edges are read, and an edge is repeated if types have trajectories of their own.

mod version;

use super::json_access::JsonObject;
use super::layout::{ElementId, Layout, LayoutEdge, LayoutNode};
use super::trajectory::FittedTrajectory;
use super::unique_names::UniqueNames;
use super::vehicle::{Facing, VehicleTraits};
use super::warnings::DIFFERENCE;
use super::{
    ImportError, ImportOptions, WarningCode, Warnings, corridor, json_access, route, trajectory, vehicle_heading,
};
use crate::footprint::Footprint;
use crate::json::JsonNode;
use crate::plane_geometry::distance;
use crate::scenario::PlacedSegment;
use std::collections::BTreeSet;
use version::LifVersion;

/// Largest gap between the end of a trajectory and its node that goes without a warning \[m\].
const GAP: f64 = 1e-3;

/// Gap that is rounding and nothing else \[m\].
const CLOSED: f64 = 1e-9;

/// Whether a JSON value looks like a layout.
pub(super) fn is_layout(root: &JsonNode<'_>) -> bool {
    let of_origins = || root.get("origins").and_then(JsonNode::as_array);
    root.get("layouts").is_some() || of_origins().is_some_and(|all| all.iter().any(|one| one.get("layouts").is_some()))
}

/// Reads all layouts of a file as one with several levels, for a vehicle that is a disc or has an outline.
pub(super) fn read(
    text: &str,
    options: &ImportOptions,
    vehicle: &VehicleTraits,
    warnings: &mut Warnings,
) -> Result<Layout, ImportError> {
    let value = json_access::parse(text)?;
    let root = JsonObject::new("LIF", &value)?;
    let version = LifVersion::of(&root, &value, warnings)?;
    let meta = root.object("metaInformation")?;
    let name = meta.map_or(Ok(None), |meta| match version {
        LifVersion::First => meta.label("projectIdentification"),
        LifVersion::Second => meta.label("lifId"),
    });
    let mut reader = LifReader {
        version,
        names: version.names(),
        levels: Vec::new(),
        nodes: UniqueNames::new(),
        edges: UniqueNames::new(),
        origins: Vec::new(),
        thetas: Vec::new(),
        types: BTreeSet::new(),
        options,
        vehicle,
        outline: vehicle.footprint.as_ref(),
        of_speeds: None,
        warnings,
    };
    let mut edges = Vec::new();
    let origins = origins(&root, version, reader.warnings)?;
    for Origin { id, layouts } in &origins {
        let maps = maps(layouts.iter().filter_map(|layout| layout.get("nodes")));
        for (k, value) in layouts.iter().enumerate() {
            let layout = JsonObject::new(format!("layout {}", k + 1), value)?;
            if let Err(error) = version::LAYOUT.check(&layout, reader.warnings) {
                reader.warnings.lose(error);
            }
            let unnamed = reader.unnamed(&layout, layouts, &maps)?;
            for list in ["nodes", "edges"] {
                // Under a wrong name they would be none.
                if layout.get(list).is_none() {
                    reader.warnings.lose(layout.missing(list));
                }
            }
            for (k, value) in layout.list("nodes")?.iter().enumerate() {
                reader.node(k, value, unnamed.as_deref(), id.filter(|_| origins.len() > 1));
            }
            edges.extend(layout.list("edges")?);
        }
    }
    if origins.len() > 1 {
        let there = origins.iter().filter_map(|origin| origin.id).collect::<Vec<_>>().join(", ");
        let problem = "how their layouts lie to one another is not in the file; each is taken as levels of its own";
        reader.warnings.add(WarningCode::AssumedLevel, format_args!("origins {there}"), problem);
    }
    for (k, value) in edges.into_iter().enumerate() {
        if let Err(error) = reader.edge(k, value) {
            reader.warnings.lose(error.or_in_json(value.position));
        }
    }
    let LifReader { levels, nodes, edges, types, thetas, outline, of_speeds, .. } = reader;
    let mut edges = edges.into_list();
    vehicle_heading::turn_at_nodes(&thetas, &mut edges, outline);
    let vehicle_types = types.iter().cloned().collect();
    if nodes.list().is_empty() {
        return Err(root.field_error("layouts", "there is no node in them"));
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
        name: name?.unwrap_or_default(),
        vehicle_types,
        of_speeds,
        levels,
        nodes: nodes.into_list(),
        edges,
        ..Layout::default()
    })
}

/// Layouts with the same origin of coordinates.
struct Origin<'j> {
    /// None in LIF 1, where all layouts have the same.
    id: Option<&'j str>,
    layouts: Vec<&'j JsonNode<'j>>,
}

/// The layouts of a file by their origins.
fn origins<'j>(
    root: &JsonObject<'j>,
    version: LifVersion,
    warnings: &mut Warnings,
) -> Result<Vec<Origin<'j>>, ImportError> {
    let mut all: Vec<Origin<'j>> = Vec::new();
    let own: Vec<&'j JsonNode<'j>> = root.list("layouts")?.iter().collect();
    if version == LifVersion::First {
        return if root.get("layouts").is_some() {
            Ok(vec![Origin { id: None, layouts: own }])
        } else {
            Err(root.missing("layouts"))
        };
    }
    if root.get("origins").is_none() && root.get("layouts").is_some() {
        warnings.add(
            WarningCode::AssumedLevel,
            "LIF",
            "its layouts are not in origins, as those of LIF 2 are; they are taken to have the same origin",
        );
        return Ok(vec![Origin { id: None, layouts: own }]);
    }
    if !own.is_empty() {
        return Err(root.error("it has layouts in origins and besides them; which origin those have is not said"));
    }
    if root.get("origins").is_none() {
        return Err(root.missing("origins"));
    }
    for (k, value) in root.list("origins")?.iter().enumerate() {
        let origin = JsonObject::new(format!("origin {}", k + 1), value)?;
        version::ORIGIN.check(&origin, warnings)?;
        let id = origin.text("originId")?.ok_or_else(|| origin.missing("originId"))?;
        if origin.get("layouts").is_none() {
            warnings.lose(origin.missing("layouts"));
        }
        let layouts = origin.list("layouts")?.iter();
        match all.iter_mut().find(|known| known.id == Some(id)) {
            Some(known) => known.layouts.extend(layouts),
            None => all.push(Origin { id: Some(id), layouts: layouts.collect() }),
        }
    }
    Ok(all)
}

struct LifReader<'a> {
    version: LifVersion,
    names: &'static version::VersionNames,
    levels: Vec<String>,
    nodes: UniqueNames<LayoutNode>,
    edges: UniqueNames<LayoutEdge>,
    /// For each node the origin of its coordinates, where there are several.
    origins: Vec<Option<String>>,
    /// At which nodes vehicles face which way \[rad\].
    thetas: Vec<(usize, f64)>,
    types: BTreeSet<String>,
    options: &'a ImportOptions,
    vehicle: &'a VehicleTraits,
    /// The outline of the vehicle, if its heading matters.
    outline: Option<&'a Footprint>,
    /// The first edge whose vehicle types have different speeds.
    of_speeds: Option<ElementId>,
    warnings: &'a mut Warnings,
}

impl LifReader<'_> {
    /// The level of the nodes of a layout that name no map, if it can be told; `maps` are those that nodes of the file name. Two levels
    /// instead of one would leave out what can touch, so that it is one where nothing tells them apart.
    fn unnamed(
        &mut self,
        layout: &JsonObject<'_>,
        layouts: &[&JsonNode<'_>],
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

    /// Reads a node; with several origins levels are named by them as well.
    fn node(&mut self, k: usize, value: &JsonNode<'_>, unnamed: Option<&str>, origin: Option<&str>) {
        match self.read_node(k, value, unnamed) {
            Err(error) => self.warnings.lose(error),
            Ok(LifNode { object, id, name, level, at }) => {
                let level = origin.map_or(level.clone(), |origin| format!("{origin} {level}"));
                let known = self.levels.iter().position(|other| *other == level);
                let level = known.unwrap_or_else(|| {
                    self.levels.push(level);
                    self.levels.len() - 1
                });
                let place =
                    self.nodes.add(LayoutNode { id: ElementId::Text(id), name, level, point: at }, self.warnings);
                self.origins.resize(self.nodes.list().len(), origin.map(str::to_owned));
                if let Err(error) = self.node_properties(&object, place) {
                    self.warnings.lose(error);
                }
            }
        }
    }

    /// Reads what is said of vehicles at a node: which way an outline faces there.
    fn node_properties(&mut self, node: &JsonObject<'_>, place: usize) -> Result<(), ImportError> {
        for (k, value) in node.list(self.names.node_properties)?.iter().enumerate() {
            let property = JsonObject::new(format!("{}, properties {}", node.name, k + 1), value)?;
            self.names.node_property.check(&property, self.warnings)?;
            let types = self.types_of(&property)?;
            if !self.is_asked(&types) {
                continue;
            }
            if let Some(theta) = vehicle_heading::theta(&property)?.filter(|_| self.outline.is_some()) {
                self.thetas.push((place, theta));
            }
            if property.get("allowedDeviationXY").is_some_and(allows) {
                let problem = "its allowedDeviationXY is not read; the vehicle is taken to pass the node itself";
                self.warnings.add(WarningCode::AllowedDeviation, &node.name, problem);
            }
        }
        Ok(())
    }

    /// The vehicle types that a property is for; none if it is for all of them.
    fn types_of(&mut self, property: &JsonObject<'_>) -> Result<Vec<String>, ImportError> {
        if self.version == LifVersion::First {
            let own = property.text("vehicleTypeId")?.filter(|own| !own.is_empty());
            return Ok(own.map(str::to_owned).into_iter().collect());
        }
        let mut types = Vec::new();
        for (k, value) in property.list("mobileRobotTypes")?.iter().enumerate() {
            let robot = JsonObject::new(format!("{}, mobileRobotTypes {}", property.name, k + 1), value)?;
            version::ROBOT_TYPE.check(&robot, self.warnings)?;
            let part = |field: &str| robot.text(field)?.ok_or_else(|| robot.missing(field));
            types.push(format!("{}.{}", part("manufacturer")?, part("seriesName")?));
        }
        Ok(types)
    }

    /// Whether something is for the vehicle type that was asked for. What names no type is for all.
    fn is_asked(&self, types: &[String]) -> bool {
        self.options.vehicle.as_ref().is_none_or(|asked| types.is_empty() || types.contains(asked))
    }

    fn edge(&mut self, k: usize, value: &JsonNode<'_>) -> Result<(), ImportError> {
        let object = JsonObject::new(format!("edge at place {}", k + 1), value)?;
        let id = object.text("edgeId")?.ok_or_else(|| object.missing("edgeId"))?.to_owned();
        let object = object.called(format!("edge {id}"));
        self.names.edge.check(&object, self.warnings)?;
        let place = |field: &str| {
            let node = object.text(field)?.ok_or_else(|| object.missing(field))?;
            let place = self.nodes.index_of(&ElementId::Text(node.to_owned()));
            place.map_err(|unclear| object.field_error(field, unclear))
        };
        let ends = [place("startNodeId")?, place("endNodeId")?];
        if self.origins.get(ends[0]) != self.origins.get(ends[1]) {
            let problem = "its nodes have different origins of coordinates, and where it leads is not in the file";
            return Err(object.error(problem));
        }
        let mut edges: Vec<LayoutEdge> = Vec::new();
        let properties = object.list(self.names.edge_properties)?;
        for (k, value) in properties.iter().enumerate() {
            let property = JsonObject::new(format!("edge {id}, properties {}", k + 1), value)?;
            self.names.edge_property.check(&property, self.warnings)?;
            let types = self.types_of(&property)?;
            let asked = self.is_asked(&types);
            self.types.extend(types);
            if asked {
                let edge = self.along(&id, ends, Some(&property))?;
                // An equal edge at the speed of another type of vehicle is the same edge; only one of the speeds is kept.
                match edges.iter_mut().find(|known| known.curve == edge.curve) {
                    None => edges.push(edge),
                    Some(known) => {
                        // What stands for different curves is as far off as from the farthest of them.
                        known.deviation = known.deviation.max(edge.deviation);
                        known.room = known.room.max(edge.room);
                        known.longer = known.longer.max(edge.longer);
                        known.turned = known.turned.max(edge.turned);
                        known.facing = [0, 1].map(|way| known.facing[way].or(edge.facing[way]));
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
    fn along(
        &mut self,
        id: &str,
        ends: [usize; 2],
        property: Option<&JsonObject<'_>>,
    ) -> Result<LayoutEdge, ImportError> {
        let at = ends.map(|node| self.nodes.list()[node].point);
        let straight = PlacedSegment::line(at[0], at[1]);
        let curve = if straight.shape.length() > 0.0 { vec![straight] } else { Vec::new() };
        let mut edge = LayoutEdge::new(ElementId::Text(id.to_owned()), ends, curve);
        if let Some(property) = property {
            edge.speed = [property.positive(self.names.speed)?; 2];
            edge.rotation = property.positive(self.names.rotation_speed)?;
            for field in ["rotationAtStartNodeAllowed", "rotationAtEndNodeAllowed"] {
                if property.get(field).is_some_and(|allowed| allowed.as_str() != Some("BOTH")) {
                    let problem =
                        format!("its {field} is not read; a vehicle turns in place where its path has a corner");
                    self.warnings.add(WarningCode::UnreadField, format_args!("edge {id}"), problem);
                }
            }
            if let Some(trajectory) = property.object("trajectory")? {
                let trajectory = trajectory.called(format!("edge {id}, trajectory"));
                let FittedTrajectory { fit, ends } =
                    trajectory::read(&trajectory, self.options.tolerance(), self.warnings)?;
                if let Some(outline) = self.outline {
                    vehicle_heading::along_trajectory(&trajectory, &fit, outline, self.warnings)?;
                }
                let gap = if fit.pieces.is_empty() { point_gap(id, ends, at)? } else { self.gap(id, ends, at) };
                (edge.deviation, edge.longer, edge.turned) = (fit.deviation + gap, fit.length_error, fit.heading_error);
                edge.curve = fit.pieces;
            } else if let Some(line) = property.object("physicalLineGuidedProperty")? {
                self.guided(id, &line, straight.shape.length())?;
            }
            if self.outline.is_some() {
                let is_line = straight.shape.length() > 0.0 && property.get("trajectory").is_none();
                let ahead = Some(straight.heading).filter(|_| is_line);
                edge.facing = [self.facing(property, &edge.curve, ahead)?; 2];
            }
            if let Some(room) = corridor::read(property, self.vehicle, self.warnings)? {
                edge.widen(room);
            }
        }
        if edge.curve.is_empty() {
            self.warnings.add(WarningCode::ZeroLength, format_args!("edge {id}"), "its length is 0");
        }
        Ok(edge)
    }

    /// Which way an outline faces on an edge with these properties, which has a heading if it is straight.
    fn facing(
        &self,
        property: &JsonObject<'_>,
        curve: &[PlacedSegment],
        heading: Option<f64>,
    ) -> Result<Facing, ImportError> {
        let is_first = self.version == LifVersion::First;
        let field = if is_first { "vehicleOrientation" } else { "mobileRobotOrientations" };
        let mut orientations = Vec::new();
        if is_first {
            orientations.extend(property.number(field)?);
        } else {
            for value in property.list(field)? {
                let problem = || property.field_error(field, format_args!("{value} where a number is expected"));
                orientations.push(value.as_f64().ok_or_else(problem)?);
            }
        }
        let said = vehicle_heading::of_edge(property, field, &orientations, heading)?;
        // A vehicle that rotates on the edge has any heading there, and in LIF 2 so has one of which no orientation is said.
        let rotates = match is_first {
            true => property.flag("rotationAllowed")? == Some(true),
            false => property.flag("reachOrientationBeforeEntering")? == Some(false) || said.is_none(),
        };
        Ok(if rotates { Facing::Any } else { said.unwrap_or_else(|| vehicle_heading::of_curve(curve)) })
    }

    /// An edge that follows a line on the ground is as long as the line between its nodes, or leads elsewhere.
    fn guided(&mut self, id: &str, line: &JsonObject<'_>, straight: f64) -> Result<(), ImportError> {
        version::LINE.check(line, self.warnings)?;
        let length = line.positive("length")?;
        if let Some(length) = length.filter(|length| (length - straight).abs() > DIFFERENCE * straight + route::GAP) {
            let problem = format!("it follows a physical line of {length} m, and its nodes are {straight:.3} m apart");
            return Err(ImportError::new(format!("edge {id}: {problem}; where the line leads is not in the file")));
        }
        let problem =
            "it follows a physical line, which is not in the file; the straight line between its nodes is taken";
        self.warnings.add(WarningCode::PhysicalLine, format_args!("edge {id}"), problem);
        Ok(())
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
fn maps<'v>(nodes: impl Iterator<Item = &'v JsonNode<'v>>) -> BTreeSet<&'v str> {
    nodes.filter_map(JsonNode::as_array).flatten().filter_map(|node| node.get("mapId")?.as_str()).collect()
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
struct LifNode<'j> {
    object: JsonObject<'j>,
    id: String,
    name: Option<String>,
    level: String,
    at: [f64; 2],
}

impl LifReader<'_> {
    /// Reads a node; `unnamed` is the level if it names no map.
    fn read_node<'j>(
        &mut self,
        k: usize,
        value: &'j JsonNode<'j>,
        unnamed: Option<&str>,
    ) -> Result<LifNode<'j>, ImportError> {
        let object = JsonObject::new(format!("node at place {}", k + 1), value)?;
        let id = object.text("nodeId")?.ok_or_else(|| object.missing("nodeId"))?.to_owned();
        let object = object.called(format!("node {id}"));
        self.names.node.check(&object, self.warnings)?;
        let position = object.object("nodePosition")?.ok_or_else(|| object.missing("nodePosition"))?;
        version::POSITION.check(&position, self.warnings)?;
        let level = object.text("mapId")?.or(unnamed).ok_or_else(|| object.missing("mapId"))?.to_owned();
        let name = object.label("nodeName")?;
        Ok(LifNode { object, id, name, level, at: position.point()? })
    }
}

/// Whether an allowed deviation, the half axes of an ellipse, allows any.
fn allows(deviation: &JsonNode<'_>) -> bool {
    let above = |axis: &&str| deviation.get(axis).and_then(JsonNode::as_f64).is_some_and(|allowed| allowed > 0.0);
    ["aMaximum", "bMaximum", "aMinimum", "bMinimum", "a", "b"].iter().any(above)
}
