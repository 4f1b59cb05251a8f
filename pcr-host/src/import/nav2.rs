//! Route graphs of the nav2 route server: GeoJSON with a point a node and a line an edge.
//!
//! As there, an edge is the straight line between its nodes, whatever its own coordinates are; `speed_limit` in its metadata
//! is a fraction of the full speed up to 1 and a percentage above it. Zero-length edges are kept.

use super::layout::{Edge, Id, Layout, Node, Placed};
use super::value::Object;
use super::vehicle::CORNER_RADIUS;
use super::{ImportError, Options, Warnings, value};
use serde_json::Value;
use std::collections::{HashMap, HashSet};

/// Largest distance between the drawn end of an edge and its node that goes without a warning \[m\].
const DRAWN: f64 = 1e-3;

/// Whether a JSON value looks like a graph.
pub(super) fn is_graph(root: &Value) -> bool {
    root.get("type").and_then(Value::as_str) == Some("FeatureCollection")
}

/// Reads a graph. `full_speed` is what fractions in `speed_limit` refer to \[m/s\].
pub(super) fn read(
    text: &str,
    options: &Options,
    full_speed: f64,
    warnings: &mut Warnings,
) -> Result<Layout, ImportError> {
    let value = value::parse(text)?;
    let root = Object::new("graph", &value)?;
    if root.get("features").is_none() {
        return Err(root.missing("features"));
    }
    let mut layout = Layout {
        name: root.text("name").ok().flatten().unwrap_or_default().to_owned(),
        levels: vec![String::new()],
        corner_radius: Some(options.corner_radius.unwrap_or(CORNER_RADIUS)),
        ..Layout::default()
    };
    let mut graph = Graph { layout: &mut layout, places: HashMap::new(), edges: HashSet::new(), warnings };
    let features = root.list("features")?;
    let mut lines = Vec::new();
    for (k, feature) in features.iter().enumerate() {
        match Feature::read(k, feature) {
            Ok(Feature { id, properties, geometry: Geometry::Point(at) }) => graph.node(id, &properties, at),
            Ok(line) => lines.push(line),
            Err(error) => graph.warnings.add(format_args!("feature {}", k + 1), format!("left out: {error}")),
        }
    }
    for Feature { id, properties, geometry } in lines {
        if let Err(problem) = graph.edge(&id, &properties, &geometry, full_speed) {
            graph.warnings.add(format_args!("edge {id}"), problem);
        }
    }
    if layout.nodes.is_empty() {
        return Err(ImportError::new("graph, features: no node (a Point with an id in its properties) among them"));
    }
    Ok(layout)
}

struct Graph<'a> {
    layout: &'a mut Layout,
    places: HashMap<u64, usize>,
    edges: HashSet<u64>,
    warnings: &'a mut Warnings,
}

enum Geometry {
    Point([f64; 2]),
    /// Ends of a line, where it has any.
    Line(Option<[[f64; 2]; 2]>),
}

struct Feature<'j> {
    id: u64,
    properties: Object<'j>,
    geometry: Geometry,
}

fn whole(object: &Object<'_>, field: &str) -> Result<u64, ImportError> {
    let value = object.get(field).ok_or_else(|| object.missing(field))?;
    let number = value.as_u64().or_else(|| value.as_str().and_then(|text| text.parse().ok()));
    // Some tools write every number with a decimal point.
    let whole = || value.as_f64().filter(|x| x.fract() == 0.0 && (0.0..9e15).contains(x)).map(|x| x as u64);
    number
        .or_else(whole)
        .ok_or_else(|| ImportError::new(format!("{}, {field}: not a whole number from 0", object.name)))
}

fn point(value: &Value) -> Option<[f64; 2]> {
    let pair = value.as_array()?;
    let number = |k: usize| pair.get(k)?.as_f64().filter(|x| x.abs() <= crate::scenario::LIMIT);
    Some([number(0)?, number(1)?])
}

/// First and last point of a LineString or a MultiLineString.
fn ends(value: &Value) -> Option<[[f64; 2]; 2]> {
    let first = value.as_array()?.first()?;
    let last = value.as_array()?.last()?;
    match (point(first), point(last)) {
        (Some(first), Some(last)) => Some([first, last]),
        _ => Some([point(first.as_array()?.first()?)?, point(last.as_array()?.last()?)?]),
    }
}

impl<'j> Feature<'j> {
    fn read(k: usize, value: &'j Value) -> Result<Self, ImportError> {
        let feature = Object::new(format!("feature {}", k + 1), value)?;
        let properties = feature.object("properties")?.ok_or_else(|| feature.missing("properties"))?;
        let id = whole(&properties, "id")?;
        let geometry = feature.object("geometry")?.ok_or_else(|| feature.missing("geometry"))?;
        let coordinates = geometry.get("coordinates").ok_or_else(|| geometry.missing("coordinates"))?;
        let geometry = match geometry.text("type")? {
            Some("Point") => Geometry::Point(point(coordinates).ok_or_else(|| {
                ImportError::new(format!("{}, coordinates: two numbers are expected", geometry.name))
            })?),
            Some("LineString" | "MultiLineString") => Geometry::Line(ends(coordinates)),
            other => {
                let other = other.unwrap_or("nothing");
                return Err(ImportError::new(format!("{}, type: {other} is no node and no edge", geometry.name)));
            }
        };
        Ok(Self { id, properties, geometry })
    }
}

impl Graph<'_> {
    fn node(&mut self, id: u64, properties: &Object<'_>, at: [f64; 2]) {
        if self.places.contains_key(&id) {
            self.warnings.add(format_args!("node {id}"), "given twice; the first is taken");
            return;
        }
        self.places.insert(id, self.layout.nodes.len());
        let name = properties.text("name").ok().flatten().map(str::to_owned);
        self.layout.nodes.push(Node { id: Id::Number(id), name, level: 0, at });
    }

    /// Adds an edge, or says why it is left out.
    fn edge(&mut self, id: &u64, properties: &Object<'_>, drawn: &Geometry, full_speed: f64) -> Result<(), String> {
        if self.edges.contains(id) {
            return Err("given twice; the first is taken".into());
        }
        let place = |field: &str| {
            let node = whole(properties, field).map_err(|error| format!("left out: {error}"))?;
            self.places.get(&node).copied().ok_or_else(|| format!("left out: there is no node {node}"))
        };
        let ends = [place("startid")?, place("endid")?];
        let at = ends.map(|node| self.layout.nodes.get(node).map_or([0.0; 2], |node| node.at));
        let line = Placed::line(at[0], at[1]);
        let named = format!("edge {id}");
        if let Geometry::Line(Some(drawn)) = drawn {
            let off = |k: usize| (drawn[k][0] - at[k][0]).hypot(drawn[k][1] - at[k][1]) > DRAWN;
            if off(0) || off(1) {
                self.warnings
                    .add(&named, "its drawn line does not join its nodes; the straight line between them is taken");
            }
        }
        let straight = line.shape.length() > 0.0;
        if !straight {
            self.warnings.add(&named, "its length is 0");
        }
        let speed = self.speed_limit(&named, properties, full_speed);
        let curve = if straight { vec![line] } else { Vec::new() };
        let edge = Edge { id: Id::Number(*id), ends, curve, two_way: false, speed, rotation: None, deviation: 0.0 };
        self.edges.insert(*id);
        self.layout.edges.push(edge);
        Ok(())
    }

    fn speed_limit(&mut self, edge: &str, properties: &Object<'_>, full_speed: f64) -> Option<f64> {
        let limit = properties.object("metadata").ok()??.get("speed_limit")?.as_f64();
        match limit {
            Some(fraction) if fraction > 0.0 && fraction <= 1.0 => Some(fraction * full_speed),
            Some(percent) if percent > 1.0 && percent <= 100.0 => Some(percent / 100.0 * full_speed),
            _ => {
                self.warnings.add(edge, "its speed_limit is not above 0 and up to 100 (percent); it is not used");
                None
            }
        }
    }
}
