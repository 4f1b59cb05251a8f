//! Route graphs of the nav2 route server: GeoJSON with a point for each node and a line for each edge.
//!
//! As in nav2, an edge is the straight line between its nodes, whatever its own coordinates are; `speed_limit` in its
//! metadata is a fraction of the full speed if it is at most 1, and a percentage above that. Edges of length 0 are
//! kept, and so are several edges with the same id.

use super::json_access::JsonObject;
use super::keys::Keys;
use super::layout::{ElementId, Layout, LayoutEdge, LayoutNode};
use super::unique_names::UniqueNames;
use super::{ImportError, WarningCode, Warnings, json_access};
use crate::json::JsonNode;
use crate::scenario::PlacedSegment;
use serde_json::Value;
use std::collections::BTreeSet;

/// Largest distance between the drawn end of an edge and its node that goes without a warning \[m\].
const DRAWN: f64 = 1e-3;

/// Frame of nodes that name none.
const FRAME: &str = "map";

/// GeoJSON and the route server leave all other keys to their users.
const ROOT: Keys = Keys::new(&["type", "features", "name"], &[]).free();
const FEATURE: Keys =
    Keys::new(&["type", "geometry", "properties"], &["id"]).not(&["coordinates", "startid", "endid"]).free();
const GEOMETRY: Keys = Keys::new(&["type", "coordinates"], &[]).free();
const NODE: Keys = Keys::new(&["id", "frame", "name", "metadata"], &[]).free();
const EDGE: Keys = Keys::new(&["id", "startid", "endid", "metadata"], &[]).free();
const METADATA: Keys = Keys::new(&["speed_limit"], &[]).free();

/// Whether a JSON value looks like a graph.
pub(super) fn is_graph(root: &JsonNode<'_>) -> bool {
    root.get("type").and_then(JsonNode::as_str) == Some("FeatureCollection")
}

/// Reads a graph. `full_speed` is what fractions in `speed_limit` refer to \[m/s\].
pub(super) fn read(text: &str, full_speed: f64, warnings: &mut Warnings) -> Result<Layout, ImportError> {
    let value = json_access::parse(text)?;
    let root = JsonObject::new("graph", &value)?;
    ROOT.check(&root, warnings)?;
    refuse_degrees(&root)?;
    if root.get("features").is_none() {
        return Err(root.missing("features"));
    }
    let mut graph =
        Nav2Graph { nodes: UniqueNames::new(), edges: UniqueNames::new(), frames: BTreeSet::new(), warnings };
    let mut lines = Vec::new();
    for (k, feature) in root.list("features")?.iter().enumerate() {
        match GeoJsonFeature::read(k, feature, graph.warnings) {
            Ok(Some(GeoJsonFeature { id, properties, geometry: GeoJsonGeometry::Point(at) })) => {
                if let Err(problem) = graph.node(id, &properties, at) {
                    graph.warnings.lose(problem);
                }
            }
            Ok(Some(line)) => lines.push(line),
            Ok(None) => graph.warnings.add(
                WarningCode::NotInGraph,
                format_args!("feature {}", k + 1),
                "it is no point and no line, hence no part of the graph",
            ),
            Err(error) => graph.warnings.lose(error),
        }
    }
    for GeoJsonFeature { id, properties, geometry } in lines {
        if let Err(problem) = graph.edge(id, &properties, &geometry, full_speed) {
            graph.warnings.lose(problem);
        }
    }
    let Nav2Graph { nodes, edges, frames, .. } = graph;
    if nodes.list().is_empty() {
        return Err(root.field_error("features", "no node (a Point with an id in its properties) among them"));
    }
    if frames.len() > 1 {
        let frames = frames.into_iter().collect::<Vec<_>>().join(", ");
        return Err(ImportError::new(format!(
            "graph: its nodes are in several frames ({frames}); one has to be given"
        )));
    }
    Ok(Layout {
        name: root.label("name")?.unwrap_or_default(),
        levels: frames.into_iter().collect(),
        nodes: nodes.into_list(),
        edges: edges.into_list(),
        ..Layout::default()
    })
}

/// Refuses coordinates that a file says are longitudes and latitudes: nav2 takes all of them for metres, so that a route of a kilometre
/// would have the length of a hand.
fn refuse_degrees(root: &JsonObject<'_>) -> Result<(), ImportError> {
    let system = root.get("crs");
    let name = system.and_then(|system| system.as_str().or_else(|| system.get("properties")?.get("name")?.as_str()));
    let of_degrees = ["CRS84", "EPSG::4326", "EPSG:4326", "WGS84", "WGS 84"];
    match name.filter(|name| of_degrees.iter().any(|system| name.to_ascii_uppercase().contains(system))) {
        Some(name) => Err(ImportError::new(format!(
            "graph, crs: {name} has degrees, and nav2 takes all coordinates for metres; project them to metres before"
        ))),
        None => Ok(()),
    }
}

struct Nav2Graph<'a> {
    nodes: UniqueNames<LayoutNode>,
    edges: UniqueNames<LayoutEdge>,
    /// Of the nodes.
    frames: BTreeSet<String>,
    warnings: &'a mut Warnings,
}

enum GeoJsonGeometry {
    Point([f64; 2]),
    /// Ends of a line, where it has any.
    Line(Option<[[f64; 2]; 2]>),
}

struct GeoJsonFeature<'j> {
    id: u64,
    properties: JsonObject<'j>,
    geometry: GeoJsonGeometry,
}

/// The id of a node or an edge in a graph: a whole number from 0, also as a text.
pub fn graph_id(value: &Value) -> Option<u64> {
    let number = value.as_u64().or_else(|| value.as_str().and_then(|text| text.parse().ok()));
    // Some tools write every number with a decimal point.
    let whole = || value.as_f64().filter(|x| x.fract() == 0.0 && (0.0..9e15).contains(x)).map(|x| x as u64);
    number.or_else(whole)
}

fn id(object: &JsonObject<'_>, field: &str) -> Result<u64, ImportError> {
    let value = object.get(field).ok_or_else(|| object.missing(field))?;
    graph_id(&value.to_value()).ok_or_else(|| object.field_error(field, "not a whole number from 0"))
}

fn point(value: &JsonNode<'_>) -> Option<[f64; 2]> {
    let pair = value.as_array()?;
    let number = |k: usize| pair.get(k)?.as_f64().filter(|x| x.abs() <= crate::scenario::LIMIT);
    Some([number(0)?, number(1)?])
}

/// First and last point of a LineString or a MultiLineString.
fn ends(value: &JsonNode<'_>) -> Option<[[f64; 2]; 2]> {
    let first = value.as_array()?.first()?;
    let last = value.as_array()?.last()?;
    match (point(first), point(last)) {
        (Some(first), Some(last)) => Some([first, last]),
        _ => Some([point(first.as_array()?.first()?)?, point(last.as_array()?.last()?)?]),
    }
}

impl<'j> GeoJsonFeature<'j> {
    /// A node or an edge; nothing of another geometry, which the route server passes over as well.
    fn read(k: usize, value: &'j JsonNode<'j>, warnings: &mut Warnings) -> Result<Option<Self>, ImportError> {
        let feature = JsonObject::new(format!("feature {}", k + 1), value)?;
        FEATURE.check(&feature, warnings)?;
        let geometry = feature.object("geometry")?.ok_or_else(|| feature.missing("geometry"))?;
        GEOMETRY.check(&geometry, warnings)?;
        let kind = geometry.text("type")?.ok_or_else(|| geometry.missing("type"))?;
        if !["Point", "LineString", "MultiLineString"].contains(&kind) {
            return Ok(None);
        }
        let properties = feature.object("properties")?.ok_or_else(|| feature.missing("properties"))?;
        if kind == "Point" { NODE } else { EDGE }.check(&properties, warnings)?;
        let id = id(&properties, "id")?;
        let coordinates = geometry.get("coordinates").ok_or_else(|| geometry.missing("coordinates"))?;
        let geometry = match kind {
            "Point" => {
                let problem = || geometry.field_error("coordinates", "two numbers are expected");
                GeoJsonGeometry::Point(point(coordinates).ok_or_else(problem)?)
            }
            _ => GeoJsonGeometry::Line(ends(coordinates)),
        };
        Ok(Some(Self { id, properties, geometry }))
    }
}

impl Nav2Graph<'_> {
    /// Adds a node; one that names no frame is in that of the map, as for the route server.
    fn node(&mut self, id: u64, properties: &JsonObject<'_>, at: [f64; 2]) -> Result<(), ImportError> {
        let name = properties.label("name")?;
        let properties = properties.clone().called(format!("node {id}"));
        self.frames.insert(properties.text("frame")?.filter(|frame| !frame.is_empty()).unwrap_or(FRAME).to_owned());
        self.nodes.add(LayoutNode { id: ElementId::Number(id), name, level: 0, point: at }, self.warnings);
        Ok(())
    }

    /// Adds an edge. Of nodes of one name it joins the last one, as the route server does.
    fn edge(
        &mut self,
        id: u64,
        properties: &JsonObject<'_>,
        drawn: &GeoJsonGeometry,
        speed: f64,
    ) -> Result<(), ImportError> {
        let named = format!("edge {id}");
        let place = |field: &str| {
            let node = ElementId::Number(self::id(properties, field)?);
            let properties = properties.clone().called(named.clone());
            self.nodes.last_place(&node).map_err(|unclear| properties.field_error(field, unclear))
        };
        let ends = [place("startid")?, place("endid")?];
        let at = ends.map(|node| self.nodes.list()[node].point);
        let line = PlacedSegment::line(at[0], at[1]);
        if let GeoJsonGeometry::Line(Some(drawn)) = drawn {
            let off = |k: usize| (drawn[k][0] - at[k][0]).hypot(drawn[k][1] - at[k][1]) > DRAWN;
            if off(0) || off(1) {
                self.warnings.add(
                    WarningCode::Gap,
                    &named,
                    "its drawn line does not join its nodes; the straight line between them is taken",
                );
            }
        }
        let straight = line.shape.length() > 0.0;
        if !straight {
            self.warnings.add(WarningCode::ZeroLength, &named, "its length is 0");
        }
        let speed = self.speed_limit(&named, properties, speed)?;
        let curve = if straight { vec![line] } else { Vec::new() };
        let edge = LayoutEdge { speed: [speed; 2], ..LayoutEdge::new(ElementId::Number(id), ends, curve) };
        self.edges.add(edge, self.warnings);
        Ok(())
    }

    fn speed_limit(&mut self, edge: &str, properties: &JsonObject<'_>, full: f64) -> Result<Option<f64>, ImportError> {
        let Some(metadata) = properties.object("metadata")? else { return Ok(None) };
        METADATA.check(&metadata.clone().called(format!("{edge}, metadata")), self.warnings)?;
        let Some(limit) = metadata.get("speed_limit") else { return Ok(None) };
        Ok(match limit.as_f64() {
            Some(fraction) if fraction > 0.0 && fraction <= 1.0 => Some(fraction * full),
            Some(percent) if percent > 1.0 && percent <= 100.0 => Some(percent / 100.0 * full),
            _ => {
                self.warnings.add(
                    WarningCode::SpeedLimit,
                    edge,
                    "its speed_limit is not above 0 and up to 100 (percent); it is not used",
                );
                None
            }
        })
    }
}
