//! Plant models of openTCS: points in millimetres, paths straight or as Bézier curves.
//!
//! Control points are in units of the visual layout, y down; in models up to version 0.0.3 they are in the visual layout itself. The `length` of a path was typed by its author; if it
//! differs from the geometry, the geometry is used and there is a warning.

mod drawn;
mod vehicles;

use super::biarc::{BiarcFit, fit};
use super::layout::{ElementId, Layout, LayoutEdge, LayoutNode};
use super::nurbs::RationalBezier;
use super::unique_names::UniqueNames;
use super::warnings::{DIFFERENCE, LENGTH};
use super::xml::{children, lose_astray, number, only, optional, parse, warn_of_unknown, warn_of_unknown_attributes};
use super::{Facing, ImportError, ImportOptions, WarningCode, Warnings, vehicle_heading};
use crate::footprint::Footprint;
use crate::plane_geometry::distance;
use crate::scenario::PlacedSegment;
use drawn::{Bend, VisualProperties};
use std::collections::{HashMap, HashSet};
use std::f64::consts::FRAC_PI_2;

pub(super) use vehicles::vehicles;

/// What is read of a model, or known not to matter to ways. Groups, of versions up to 0.0.3, only list members.
const KNOWN: [&str; 9] =
    ["point", "path", "vehicle", "locationType", "location", "block", "group", "visualLayout", "property"];

/// The same of a point: the box is that of vehicles that fit there.
const OF_POINT: [&str; 5] = ["outgoingPath", "maxVehicleBoundingBox", "vehicleEnvelope", "property", "pointLayout"];

/// The same of a path. A layout of another name would be none, and the path straight.
const OF_PATH: [&str; 4] = ["peripheralOperation", "vehicleEnvelope", "property", "pathLayout"];

/// The same of a vehicle.
const OF_VEHICLE: [&str; 3] = ["boundingBox", "property", "vehicleLayout"];

/// The elements of a block.
const OF_BLOCK: [&str; 3] = ["member", "property", "blockLayout"];

/// The same of the visual layout, and of what it says of a point or path.
const OF_VISUAL_LAYOUT: [&str; 7] =
    ["modelLayoutElement", "property", "layer", "layerGroup", "color", "shapeLayoutElement", "viewBookmark"];

/// Attributes of all versions, of the elements of which something is read.
const ATTRIBUTES: [(&str, &[&str]); 12] = [
    ("model", &["name", "version"]),
    ("block", &["id", "name", "type"]),
    ("member", &["id", "name"]),
    (
        "point",
        &[
            "id",
            "name",
            "positionX",
            "positionY",
            "positionZ",
            "xPosition",
            "yPosition",
            "zPosition",
            "type",
            "vehicleOrientationAngle",
        ],
    ),
    (
        "path",
        &[
            "id",
            "name",
            "sourcePoint",
            "destinationPoint",
            "length",
            "locked",
            "maxVelocity",
            "maxReverseVelocity",
            "routingCost",
        ],
    ),
    ("visualLayout", &["id", "name", "scaleX", "scaleY"]),
    ("modelLayoutElement", &["visualizedObjectName", "layer"]),
    ("property", &["name", "value"]),
    (
        "pointLayout",
        &[
            "positionX",
            "positionY",
            "xPosition",
            "yPosition",
            "labelOffsetX",
            "labelOffsetY",
            "xLabelOffset",
            "yLabelOffset",
            "layerId",
        ],
    ),
    ("pathLayout", &["connectionType", "layerId"]),
    ("controlPoint", &["x", "y"]),
    (
        "vehicle",
        &[
            "id",
            "name",
            "type",
            "length",
            "maxVelocity",
            "maxReverseVelocity",
            "energyLevelCritical",
            "energyLevelGood",
            "energyLevelFullyRecharged",
            "energyLevelSufficientlyRecharged",
            "envelopeKey",
        ],
    ),
];

/// Versions whose names and elements are known.
const VERSIONS: [&str; 7] = ["0.0.1", "0.0.2", "0.0.3", "0.0.4", "0.0.5", "6.0.0", "7.0.0"];

/// How far the place of a point in the visual layout may be from its own \[m\].
const SHIFT: f64 = 0.05;

/// Metres of a millimetre.
const MILLI: f64 = 1e-3;

/// The attribute of points for the direction of vehicles there \[°\].
const ANGLE: &str = "vehicleOrientationAngle";

/// Unit of the visual layout of a model that has none, as in openTCS \[mm\].
const UNIT: f64 = 50.0;

/// Reads a model.
pub(super) fn read(
    text: &str,
    options: &ImportOptions,
    outline: Option<&Footprint>,
    warnings: &mut Warnings,
) -> Result<Layout, ImportError> {
    let document = parse(text)?;
    let root = document.root_element();
    if !root.has_tag_name("model") {
        return Err(ImportError::new(format!("{}: not a plant model of openTCS", root.tag_name().name())));
    }
    if let Some(version) = root.attribute("version").filter(|version| !VERSIONS.contains(&version.trim())) {
        warnings.add(
            WarningCode::UnknownVersion,
            "model",
            format!("version {version} is not known; what is called as up to 7.0.0 is read"),
        );
    }
    let visual = only(root, "visualLayout")?;
    let drawn = VisualProperties::of(visual)?;
    lose_astray(root, &["point", "path", "vehicle"], warnings);
    warn_of_unknown(root, &KNOWN, warnings);
    warn_of_unknown_attributes(root, &ATTRIBUTES, warnings);
    for layout in children(root, "visualLayout") {
        warn_of_unknown(layout, &OF_VISUAL_LAYOUT, warnings);
        children(layout, "modelLayoutElement").for_each(|element| warn_of_unknown(element, &["property"], warnings));
    }
    let mut nodes = UniqueNames::new();
    // How far each point is from its place in the visual layout.
    let mut shifts: Vec<Option<f64>> = Vec::new();
    // Which way vehicles face at which nodes, where that is said [rad].
    let mut angles: Vec<(usize, f64)> = Vec::new();
    for (k, point) in children(root, "point").enumerate() {
        warn_of_unknown(point, &OF_POINT, warnings);
        let read =
            name(point, k).and_then(|id| point_coordinates(point, &id, &drawn).map(|(at, drawn)| (id, at, drawn)));
        match read {
            Err(error) => warnings.lose(error),
            Ok((id, at, drawn)) => {
                let place = nodes
                    .add(LayoutNode { id: ElementId::Text(id.clone()), name: None, level: 0, point: at }, warnings);
                shifts.resize(shifts.len().max(place + 1), None);
                let shift = drawn.map(|drawn| distance(at, drawn));
                shifts[place] = shifts[place].into_iter().chain(shift).reduce(f64::max);
                // To a disc it does not matter.
                match outline.map_or(Ok(None), |_| angle(point, &format!("point {id}"))) {
                    Ok(angle) => angles.extend(angle.map(|angle| (place, angle))),
                    Err(error) => warnings.lose(error),
                }
            }
        }
    }
    if nodes.list().is_empty() {
        return Err(ImportError::new("model: there is no point in it"));
    }
    let unit = |attribute: &str| match visual.map(|visual| optional(visual, "visualLayout", attribute)).transpose()? {
        None => Ok(Some(UNIT * MILLI)),
        Some(None) => Ok(None),
        Some(Some(unit)) if unit > 0.0 => Ok(Some(unit * MILLI)),
        Some(Some(unit)) => {
            Err(ImportError::new(format!("visualLayout, {attribute}: {unit} where a number above 0 is expected")))
        }
    };
    let units = [unit("scaleX")?, unit("scaleY")?.map(|unit| -unit)];
    let mut edges = UniqueNames::new();
    for (k, path) in children(root, "path").enumerate() {
        warn_of_unknown(path, &OF_PATH, warnings);
        let frame = ModelFrame { nodes: &nodes, shifts: &shifts, units, drawn: &drawn };
        match name(path, k).and_then(|id| edge(path, id, &frame, options.tolerance(), warnings)) {
            Ok(mut edge) => {
                // In the other direction a vehicle drives backward: it does not turn round.
                edge.facing[1] = Facing::Backward;
                edges.add(edge, warnings);
            }
            Err(error) => warnings.lose(error),
        }
    }
    vehicle_heading::warn_of_nodes("point", ANGLE, &angles, nodes.list(), edges.list(), outline, warnings);
    let is_outline = |node: roxmltree::Node<'_, '_>| {
        node.has_tag_name("vehicleEnvelope") && node.children().any(|vertex| vertex.is_element())
    };
    for element in root.children().filter(|element| element.children().any(is_outline)) {
        let name = element.attribute("name").unwrap_or_default();
        let name = format!("{} {name}", element.tag_name().name());
        warnings.add(
            WarningCode::UnreadField,
            name,
            "its vehicleEnvelope is not read; the vehicle has its own outline everywhere",
        );
    }
    children(root, "vehicle").for_each(|vehicle| warn_of_unknown(vehicle, &OF_VEHICLE, warnings));
    let mut edges = edges.into_list();
    // With options or a fleet it is another vehicle that drives.
    if options.speed.is_none() && options.fleet.is_none() {
        vehicles::limit_backward(root, &mut edges, warnings)?;
    }
    let vehicles = children(root, "vehicle").filter_map(|vehicle| vehicle.attribute("name"));
    let mut layout = Layout {
        vehicles: vehicles.map(crate::scenario::label).filter(|name| !name.is_empty()).collect(),
        name: root.attribute("name").unwrap_or_default().to_owned(),
        levels: vec![String::new()],
        nodes: nodes.into_list(),
        edges,
        ..Layout::default()
    };
    read_blocks(root, &mut layout, warnings);
    Ok(layout)
}

/// Adds the blocks as zones. A location is no place of a vehicle; any other member that is not there is told, because a closure of the block
/// does not close it.
fn read_blocks(root: roxmltree::Node<'_, '_>, layout: &mut Layout, warnings: &mut Warnings) {
    let places = |ids: Vec<String>| -> HashMap<String, usize> {
        ids.into_iter().enumerate().map(|(place, id)| (id, place)).collect()
    };
    let points = places(layout.nodes.iter().map(|node| node.id.to_string()).collect());
    let paths = places(layout.edges.iter().map(|edge| edge.id.to_string()).collect());
    let locations: HashSet<&str> =
        children(root, "location").filter_map(|location| location.attribute("name")).collect();
    for block in children(root, "block") {
        warn_of_unknown(block, &OF_BLOCK, warnings);
        let Some(name) = block.attribute("name").filter(|name| !name.is_empty()) else { continue };
        let zone = layout.zone_called(name);
        for member in children(block, "member") {
            let member = member.attribute("name").unwrap_or_default();
            zone.edges.extend(paths.get(member));
            zone.nodes.extend(points.get(member));
            if !paths.contains_key(member) && !points.contains_key(member) && !locations.contains(member) {
                let problem = format!("its member {member} is not there; a closure of the block does not close it");
                warnings.add(WarningCode::NotInGraph, format_args!("block {name}"), problem);
            }
        }
    }
}

/// The name of a point or path, without which blocks, vehicles and routes cannot name it.
fn name(element: roxmltree::Node<'_, '_>, place: usize) -> Result<String, ImportError> {
    let name = element.attribute("name").filter(|name| !name.trim().is_empty()).map(str::to_owned);
    name.ok_or_else(|| {
        ImportError::new(format!("{} at place {}: it has no name", element.tag_name().name(), place + 1))
    })
}

/// Where points and control points are.
struct ModelFrame<'a> {
    nodes: &'a UniqueNames<LayoutNode>,
    /// How far each node is from its place in the visual layout, where control points are, if that is said \[m\].
    shifts: &'a [Option<f64>],
    /// Metres of a unit of the visual layout, if it says that.
    units: [Option<f64>; 2],
    /// How the visual layout draws paths, up to version 0.0.3.
    drawn: &'a VisualProperties<'a>,
}

/// Where a point is, and where it is drawn, if that is said \[m\].
fn point_coordinates(
    point: roxmltree::Node<'_, '_>,
    id: &str,
    elsewhere: &VisualProperties<'_>,
) -> Result<([f64; 2], Option<[f64; 2]>), ImportError> {
    let name = &format!("point {id}");
    // Models before version 6 have other names.
    let at = |node: roxmltree::Node<'_, '_>, [attribute, old]: [&str; 2]| {
        let both = node.has_attribute(attribute) && node.has_attribute(old);
        if both {
            return Err(ImportError::new(format!("{name}: {attribute} and {old}, of which a version has one")));
        }
        let attribute = if node.has_attribute(old) { old } else { attribute };
        number(node, name, attribute).map(|x| x * MILLI)
    };
    let [x, y] = [["positionX", "xPosition"], ["positionY", "yPosition"]];
    let own = [at(point, x)?, at(point, y)?];
    let layout = only(point, "pointLayout")?;
    let says = |layout: &roxmltree::Node<'_, '_>| [x, y].into_iter().flatten().any(|name| layout.has_attribute(name));
    let drawn = match layout.filter(says) {
        Some(layout) => {
            let said = |names: [&str; 2]| {
                let is_there = names.iter().any(|name| layout.has_attribute(*name));
                is_there.then(|| at(layout, names)).transpose()
            };
            match (said(x)?, said(y)?) {
                (Some(x), Some(y)) => Some([x, y]),
                // One coordinate tells where it is not, and not where it is.
                (x, y) => Some([x.unwrap_or(own[0]), y.unwrap_or(own[1])]).filter(|at| distance(*at, own) > SHIFT),
            }
        }
        // Version 7 draws points where they are.
        None if layout.is_some() => Some(own),
        None => elsewhere.point(id)?,
    };
    Ok((own, drawn))
}

/// A length \[m\] or a speed \[m/s\], which is not below 0.
fn metres(node: roxmltree::Node<'_, '_>, name: &str, attribute: &str) -> Result<Option<f64>, ImportError> {
    match optional(node, name, attribute)? {
        Some(below) if below < 0.0 => {
            Err(ImportError::new(format!("{name}, {attribute}: {below} where a number from 0 is expected")))
        }
        given => Ok(given.map(|given| given * MILLI)),
    }
}

/// Which way a vehicle faces at a point \[rad\]; `None` where it may face any way, which is `NaN` in the file, or no attribute.
fn angle(point: roxmltree::Node<'_, '_>, name: &str) -> Result<Option<f64>, ImportError> {
    match point.attribute(ANGLE).map(str::trim) {
        None | Some("NaN") => Ok(None),
        Some(_) => number(point, name, ANGLE).map(|degrees| Some(degrees.to_radians())),
    }
}

/// The edge that a path is.
fn edge(
    path: roxmltree::Node<'_, '_>,
    id: String,
    frame: &ModelFrame<'_>,
    tolerance: f64,
    warnings: &mut Warnings,
) -> Result<LayoutEdge, ImportError> {
    let name = format!("path {id}");
    let nodes = frame.nodes;
    let end = |attribute: &str| {
        let problem = |problem: &dyn std::fmt::Display| ImportError::new(format!("{name}, {attribute}: {problem}"));
        let point = path.attribute(attribute).ok_or_else(|| problem(&"missing"))?;
        nodes.index_of(&ElementId::Text(point.to_owned())).map_err(|unclear| problem(&unclear))
    };
    let ends = [end("sourcePoint")?, end("destinationPoint")?];
    let bend = bend(path, &id, &name, frame)?;
    let is_curved = !bend.points.is_empty();
    if is_curved && ends.iter().any(|node| matches!(frame.shifts.get(*node), None | Some(None))) {
        let problem =
            "where its points are drawn is not said; its control points are taken to be in the frame of the model";
        warnings.add(WarningCode::AssumedFrame, &name, problem);
    }
    let fit = curve(bend, &name, ends, frame, tolerance)?;
    if fit.bends {
        warnings.use_option("tolerance");
    }
    let limit = |attribute: &str| metres(path, &name, attribute);
    // openTCS takes a speed of 0 for "not in this direction", and uses no path that is locked.
    let speed = [limit("maxVelocity")?, limit("maxReverseVelocity")?];
    let ways = [speed[0].is_none_or(|speed| speed > 0.0), speed[1].is_some_and(|speed| speed > 0.0)];
    let locked = match path.attribute("locked").map(str::trim) {
        Some("true" | "1") => true,
        None | Some("false" | "0") => false,
        Some(other) => {
            return Err(ImportError::new(format!("{name}, locked: {other} where true or false is expected")));
        }
    };
    let closed = locked || ways == [false; 2];
    if closed {
        let why = if locked { "it is locked" } else { "its speeds are 0 in both directions" };
        warnings.add(
            WarningCode::ClosedEdge,
            name.as_str(),
            format!("{why}: no routes lead over it, and locks count it all the same"),
        );
    }
    let edge = LayoutEdge {
        ways: [ways[0] || closed && !ways[1], ways[1]],
        closed,
        speed: speed.map(|speed| speed.filter(|speed| *speed > 0.0)),
        deviation: fit.deviation,
        longer: fit.length_error,
        turned: fit.heading_error,
        ..LayoutEdge::new(ElementId::Text(id), ends, fit.pieces)
    };
    if speed[0].is_none() {
        warnings.add(
            WarningCode::SpeedLimit,
            &name,
            "it has no maxVelocity; it is taken to be open, without a limit of its own",
        );
    }
    let drawn = edge.length();
    match limit("length")? {
        None => warnings.add(WarningCode::WrittenLength, name, "it has no length; that of its geometry counts"),
        Some(typed) if (typed - drawn).abs() > DIFFERENCE * drawn => {
            warnings.add(WarningCode::WrittenLength, name, LENGTH)
        }
        Some(_) => {}
    }
    Ok(edge)
}

/// How a path is drawn: by its own layout, or by the visual layout.
fn bend(path: roxmltree::Node<'_, '_>, id: &str, name: &str, frame: &ModelFrame<'_>) -> Result<Bend, ImportError> {
    let elsewhere = frame.drawn.path(id)?;
    let Some(layout) = only(path, "pathLayout")? else {
        return Ok(elsewhere.unwrap_or(Bend { kind: "DIRECT".to_owned(), points: Vec::new() }));
    };
    if elsewhere.is_some() {
        let problem = "pathLayout, and a modelLayoutElement of the visual layout: a version has one of them";
        return Err(ImportError::new(format!("{name}: {problem}")));
    }
    let mut inner = layout.children().filter(roxmltree::Node::is_element);
    if let Some(other) = inner.find(|inner| !inner.has_tag_name("controlPoint")) {
        return Err(ImportError::new(format!("{name}, pathLayout: {} is not read", other.tag_name().name())));
    }
    let point = |point: roxmltree::Node<'_, '_>| Ok([number(point, name, "x")?, number(point, name, "y")?]);
    let points = children(layout, "controlPoint").map(point).collect::<Result<_, ImportError>>()?;
    // A path with control points that says nothing is none that is read.
    Ok(Bend { kind: layout.attribute("connectionType").unwrap_or("DIRECT").to_owned(), points })
}

/// The lines and arcs of a path.
fn curve(
    bend: Bend,
    name: &str,
    ends: [usize; 2],
    frame: &ModelFrame<'_>,
    tolerance: f64,
) -> Result<BiarcFit, ImportError> {
    let [from, to] = ends.map(|node| frame.nodes.list()[node].point);
    let mut points = vec![from];
    if !bend.points.is_empty() {
        let missing = || {
            ImportError::new(format!(
                "{name}: visualLayout, scaleX, scaleY: missing; its control points are in these units"
            ))
        };
        let [Some(unit_x), Some(unit_y)] = frame.units else { return Err(missing()) };
        points.extend(bend.points.iter().map(|[x, y]| [x * unit_x, y * unit_y]));
    }
    let shift = if points.len() > 1 { shift(name, ends, frame)? } else { 0.0 };
    // The control points are off together: only the legs from the first point and to the last one have other lengths.
    let legs = 2.0 * shift;
    let first = points.first().zip(points.get(1)).map_or(f64::INFINITY, |(from, to)| distance(*from, *to));
    let last = points.last().map_or(f64::INFINITY, |from| distance(*from, to));
    let askew = if shift > 0.0 { (shift / first.min(last)).min(1.0) * FRAC_PI_2 } else { 0.0 };
    let fit = shape(&bend.kind, name, points, to, tolerance)?;
    Ok(BiarcFit {
        deviation: fit.deviation + shift + legs,
        length_error: fit.length_error + legs,
        heading_error: fit.heading_error + askew,
        ..fit
    })
}

/// How far the control points of a path may be from where they are meant to be \[m\].
fn shift(name: &str, ends: [usize; 2], frame: &ModelFrame<'_>) -> Result<f64, ImportError> {
    let shift = ends.iter().filter_map(|node| *frame.shifts.get(*node)?).fold(0.0, f64::max);
    if shift > SHIFT {
        let problem = "its control points are in the frame of the visual layout, where its end points are";
        return Err(ImportError::new(format!(
            "{name}: {problem} {shift:.3} m away from their places in the model (pointLayout)"
        )));
    }
    Ok(shift)
}

/// The lines and arcs through points, or for their curve.
fn shape(
    kind: &str,
    name: &str,
    mut points: Vec<[f64; 2]>,
    to: [f64; 2],
    tolerance: f64,
) -> Result<BiarcFit, ImportError> {
    points.push(to);
    let named = |error: ImportError| ImportError::new(format!("{name}: {error}"));
    match kind {
        // Cubic curves, one after the other.
        "BEZIER" | "BEZIER_3" if points.len() > 3 && points.len() % 3 == 1 => {
            let curves: Vec<RationalBezier> =
                (0..points.len() / 3).map(|k| RationalBezier::new(&points[3 * k..3 * k + 4])).collect();
            fit(&curves, tolerance).map_err(named)
        }
        // A straight path with control points could be either.
        kind @ ("DIRECT" | "POLYPATH") if kind == "POLYPATH" || points.len() == 2 => {
            let lines = points.windows(2).map(|pair| PlacedSegment::line(pair[0], pair[1]));
            let pieces = lines.filter(|line| line.shape.length() > 0.0).collect();
            Ok(BiarcFit::exact(pieces))
        }
        other => Err(ImportError::new(format!("{name}: {other} with {} control points is not read", points.len() - 2))),
    }
}
