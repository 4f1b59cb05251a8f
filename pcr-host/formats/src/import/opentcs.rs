//! Plant models of openTCS: points in millimetres, paths straight or as Bézier curves.
//!
//! Control points are in units of the visual layout, y down. The `length` of a path was typed by its author; if it
//! differs from the geometry, the geometry is used and there is a warning.

use super::biarc::{Fit, fit};
use super::layout::{Edge, Id, Layout, Node};
use super::names::Names;
use super::nurbs::Bezier;
use super::vehicle::Given;
use super::xml::{children, number, only, optional, parse};
use super::{ImportError, Options, Warnings, facing};
use crate::footprint::Footprint;
use crate::scenario::Placed;

/// Metres of a millimetre.
const MILLI: f64 = 1e-3;

/// Unit of the visual layout of a model that names none \[mm\].
const UNIT: f64 = 50.0;

/// Relative difference of a length from the geometry that goes without a warning.
const DIFFERENCE: f64 = 0.01;

/// What a model says about its vehicles, where nothing else does: the rectangle that covers the bounding boxes of all, and
/// the least of their speeds.
///
/// The reference point of a box may be off its middle; the rectangle is as large to the other side.
pub(super) fn vehicles(
    text: &str,
    options: &Options,
    given: &mut Given,
    warnings: &mut Warnings,
) -> Result<(), ImportError> {
    let document = parse(text)?;
    let (mut half, mut speeds) = ([0.0_f64; 2], Vec::new());
    for vehicle in children(document.root_element(), "vehicle") {
        let name = format!("vehicle {}", vehicle.attribute("name").unwrap_or_default());
        let metres = |node, attribute: &str| Ok(optional(node, &name, attribute)?.map(|value| value * MILLI));
        speeds.extend(metres(vehicle, "maxVelocity")?.filter(|speed| *speed > 0.0));
        let Some(outline) = only(vehicle, "boundingBox")? else { continue };
        for (half, [size, offset]) in
            half.iter_mut().zip([["length", "referenceOffsetX"], ["width", "referenceOffsetY"]])
        {
            let size = metres(outline, size)?.unwrap_or(0.0);
            *half = half.max(0.5 * size + metres(outline, offset)?.unwrap_or(0.0).abs());
        }
    }
    if let Some(least) = speeds.iter().copied().reduce(f64::min).filter(|_| given.speed.is_none()) {
        if options.speed.is_none() && speeds.iter().any(|speed| *speed != least) {
            warnings.add("vehicles", format!("their maxVelocity differs; the least of {least} m/s is taken"));
        }
        given.speed = Some(least);
    }
    let [ahead, left] = half;
    if ahead > 0.0 && left > 0.0 && given.radius.is_none() && given.footprint.is_none() {
        let corners = vec![[ahead, left], [-ahead, left], [-ahead, -left], [ahead, -left]];
        let outline = Footprint::new(corners, None);
        let outline = outline.map_err(|problem| ImportError::new(format!("vehicle, boundingBox: {problem}")))?;
        if let Some(radius) = options.radius.filter(|radius| *radius < ahead.hypot(left)) {
            let reach = ahead.hypot(left);
            warnings.add("radius", format!("{radius} m; the bounding boxes of the vehicles reach {reach:.3} m"));
        }
        given.footprint = Some(outline);
    }
    Ok(())
}

/// Reads a model.
pub(super) fn read(
    text: &str,
    options: &Options,
    outline: Option<&Footprint>,
    warnings: &mut Warnings,
) -> Result<Layout, ImportError> {
    let document = parse(text)?;
    let root = document.root_element();
    if !root.has_tag_name("model") {
        return Err(ImportError::new(format!("{}: not a plant model of openTCS", root.tag_name().name())));
    }
    let mut nodes = Names::new();
    for (k, point) in children(root, "point").enumerate() {
        let id = point.attribute("name").map_or_else(|| format!("at place {}", k + 1), str::to_owned);
        let name = format!("point {id}");
        // Models before version 7 have other names.
        let at = |[attribute, old]: [&str; 2]| {
            let attribute = if point.has_attribute(attribute) || !point.has_attribute(old) { attribute } else { old };
            number(point, &name, attribute).map(|x| x * MILLI)
        };
        match (at(["positionX", "xPosition"]), at(["positionY", "yPosition"])) {
            (Err(error), _) | (_, Err(error)) => warnings.lose(error),
            (Ok(x), Ok(y)) => {
                nodes.add(Node { id: Id::Text(id), name: None, level: 0, at: [x, y] }, warnings);
            }
        }
    }
    if nodes.list().is_empty() {
        return Err(ImportError::new("model: there is no point in it"));
    }
    let visual = only(root, "visualLayout")?;
    let unit = |attribute: &str| match visual.map(|visual| optional(visual, "visualLayout", attribute)).transpose()? {
        None | Some(None) => Ok(UNIT * MILLI),
        Some(Some(unit)) if unit > 0.0 => Ok(unit * MILLI),
        Some(Some(unit)) => {
            Err(ImportError::new(format!("visualLayout, {attribute}: {unit} where a number above 0 is expected")))
        }
    };
    let units = [unit("scaleX")?, -unit("scaleY")?];
    let mut edges = Names::new();
    for (k, path) in children(root, "path").enumerate() {
        let id = path.attribute("name").map_or_else(|| format!("at place {}", k + 1), str::to_owned);
        match edge(path, id, &nodes, units, options.tolerance(), warnings) {
            Ok(mut edge) => {
                // In the other direction a vehicle drives backward: it does not turn round.
                if edge.ways[1] && facing::is_other_backward(outline) {
                    edge.ways[1] = false;
                    edge.closed |= !edge.ways[0];
                    warnings.lose(format_args!("path {}, maxReverseVelocity: {}", edge.id, facing::BACKWARD));
                }
                edges.add(edge, warnings);
            }
            Err(error) => warnings.lose(error),
        }
    }
    let is_outline = |node: roxmltree::Node<'_, '_>| {
        node.has_tag_name("vehicleEnvelope") && node.children().any(|vertex| vertex.is_element())
    };
    for element in root.children().filter(|element| element.children().any(is_outline)) {
        let name = element.attribute("name").unwrap_or_default();
        let name = format!("{} {name}", element.tag_name().name());
        warnings.add(name, "its vehicleEnvelope is not read; the vehicle has its own outline everywhere");
    }
    let vehicles = children(root, "vehicle").filter_map(|vehicle| vehicle.attribute("name"));
    Ok(Layout {
        vehicles: vehicles.map(crate::scenario::label).filter(|name| !name.is_empty()).collect(),
        name: root.attribute("name").unwrap_or_default().to_owned(),
        levels: vec![String::new()],
        nodes: nodes.into_list(),
        edges: edges.into_list(),
        corner_radius: options.corner_radius,
        ..Layout::default()
    })
}

/// The edge that a path is.
fn edge(
    path: roxmltree::Node<'_, '_>,
    id: String,
    nodes: &Names<Node>,
    units: [f64; 2],
    tolerance: f64,
    warnings: &mut Warnings,
) -> Result<Edge, ImportError> {
    let name = format!("path {id}");
    let end = |attribute: &str| {
        let problem = |problem: &dyn std::fmt::Display| ImportError::new(format!("{name}, {attribute}: {problem}"));
        let point = path.attribute(attribute).ok_or_else(|| problem(&"missing"))?;
        nodes.place(&Id::Text(point.to_owned())).map_err(|unclear| problem(&unclear))
    };
    let ends = [end("sourcePoint")?, end("destinationPoint")?];
    let fit = curve(path, &name, ends.map(|node| nodes.list()[node].at), units, tolerance)?;
    let limit = |attribute: &str| Ok(optional(path, &name, attribute)?.map(|speed| speed * MILLI));
    // openTCS takes a speed of 0 for "not in this direction", and uses no path that is locked.
    let speed = [limit("maxVelocity")?, limit("maxReverseVelocity")?];
    let ways = [speed[0].is_none_or(|speed| speed > 0.0), speed[1].is_some_and(|speed| speed > 0.0)];
    let locked = path.attribute("locked").is_some_and(|locked| matches!(locked.trim(), "true" | "1"));
    let closed = locked || ways == [false; 2];
    if closed {
        let why = if locked { "it is locked" } else { "its speeds are 0 in both directions" };
        warnings.add(name.as_str(), format!("{why}: no routes lead over it, and locks count it all the same"));
    }
    let edge = Edge {
        ways: [ways[0] || closed && !ways[1], ways[1]],
        closed,
        speed: speed.map(|speed| speed.filter(|speed| *speed > 0.0)),
        deviation: fit.deviation,
        longer: fit.longer,
        ..Edge::new(Id::Text(id), ends, fit.pieces)
    };
    let (typed, drawn) = (limit("length")?, edge.length());
    if typed.is_none_or(|typed| (typed - drawn).abs() > DIFFERENCE * drawn) {
        warnings.add(name, "its length is not that of its geometry, which counts");
    }
    Ok(edge)
}

/// The lines and arcs of a path.
fn curve(
    path: roxmltree::Node<'_, '_>,
    name: &str,
    [from, to]: [[f64; 2]; 2],
    units: [f64; 2],
    tolerance: f64,
) -> Result<Fit, ImportError> {
    let layout = only(path, "pathLayout")?;
    let mut points = vec![from];
    for point in layout.into_iter().flat_map(|layout| children(layout, "controlPoint")) {
        points.push([number(point, name, "x")? * units[0], number(point, name, "y")? * units[1]]);
    }
    points.push(to);
    let named = |error: ImportError| ImportError::new(format!("{name}: {error}"));
    match layout.and_then(|layout| layout.attribute("connectionType")).unwrap_or("DIRECT") {
        // Cubic curves, one after the other.
        "BEZIER" | "BEZIER_3" if points.len() > 3 && points.len() % 3 == 1 => {
            let curves: Vec<Bezier> = (0..points.len() / 3).map(|k| Bezier::new(&points[3 * k..3 * k + 4])).collect();
            fit(&curves, tolerance).map_err(named)
        }
        // A straight path with control points could be either.
        kind @ ("DIRECT" | "POLYPATH") if kind == "POLYPATH" || points.len() == 2 => {
            let lines = points.windows(2).map(|pair| Placed::line(pair[0], pair[1]));
            let pieces = lines.filter(|line| line.shape.length() > 0.0).collect();
            Ok(Fit::exact(pieces))
        }
        other => Err(ImportError::new(format!("{name}: {other} with {} control points is not read", points.len() - 2))),
    }
}
