//! Plant models of openTCS: points in millimetres, paths straight or as Bézier curves.
//!
//! Control points are in units of the visual layout, y down. The `length` of a path is what its author typed; where it
//! differs from the geometry, the geometry counts and there is a warning.

use super::biarc::{Fit, fit};
use super::layout::{Edge, Id, Layout, Node, Placed};
use super::nurbs::Bezier;
use super::xml::{child, children, number, parse};
use super::{ImportError, Options, Warnings};
use std::collections::{HashMap, HashSet};

/// Metres of a millimetre.
const MILLI: f64 = 1e-3;

/// Relative difference of a length from the geometry that goes without a warning.
const DIFFERENCE: f64 = 0.01;

/// Reads a model.
pub(super) fn read(text: &str, options: &Options, warnings: &mut Warnings) -> Result<Layout, ImportError> {
    let document = parse(text)?;
    let root = document.root_element();
    if !root.has_tag_name("model") {
        return Err(ImportError::new(format!("{}: not a plant model of openTCS", root.tag_name().name())));
    }
    let mut layout = Layout { levels: vec![String::new()], corner_radius: options.corner_radius, ..Layout::default() };
    layout.name = root.attribute("name").unwrap_or_default().to_owned();
    let vehicles = children(root, "vehicle").filter_map(|vehicle| vehicle.attribute("name"));
    layout.vehicles = vehicles.map(crate::scenario::label).filter(|name| !name.is_empty()).collect();
    let mut places = HashMap::new();
    for (k, point) in children(root, "point").enumerate() {
        let id = point.attribute("name").map_or_else(|| format!("at place {}", k + 1), str::to_owned);
        let name = format!("point {id}");
        let at = |attribute: &str| number(point, &name, attribute).map(|x| x * MILLI);
        match (at("positionX"), at("positionY")) {
            (Err(error), _) | (_, Err(error)) => warnings.add(error, "left out"),
            _ if places.contains_key(&id) => warnings.add(name, "given twice; the first is taken"),
            (Ok(x), Ok(y)) => {
                places.insert(id.clone(), layout.nodes.len());
                layout.nodes.push(Node { id: Id::Text(id), name: None, level: 0, at: [x, y] });
            }
        }
    }
    let visual = child(root, "visualLayout");
    let unit = |attribute: &str| {
        visual.and_then(|visual| number(visual, "", attribute).ok()).filter(|unit| *unit > 0.0).unwrap_or(50.0) * MILLI
    };
    let units = [unit("scaleX"), -unit("scaleY")];
    let mut known = HashSet::new();
    for (k, path) in children(root, "path").enumerate() {
        let id = path.attribute("name").map_or_else(|| format!("at place {}", k + 1), str::to_owned);
        let name = format!("path {id}");
        let end = |attribute: &str| path.attribute(attribute).and_then(|point| places.get(point).copied());
        let (Some(from), Some(to)) = (end("sourcePoint"), end("destinationPoint")) else {
            warnings.add(name, "left out: its source or its destination is no point");
            continue;
        };
        if !known.insert(id.clone()) {
            warnings.add(name, "given twice; the first is taken");
            continue;
        }
        let ends = [from, to].map(|node| layout.nodes.get(node).map_or([0.0; 2], |node| node.at));
        let fit = match curve(path, &name, ends, units, options.tolerance()) {
            Ok(fit) => fit,
            Err(error) => {
                warnings.add(error, "left out");
                continue;
            }
        };
        let limit = |attribute: &str| number(path, &name, attribute).ok().map(|speed| speed * MILLI);
        let edge = Edge {
            id: Id::Text(id),
            ends: [from, to],
            curve: fit.pieces,
            two_way: limit("maxReverseVelocity").is_some_and(|speed| speed > 0.0),
            speed: limit("maxVelocity").filter(|speed| *speed > 0.0),
            rotation: None,
            deviation: fit.deviation,
        };
        let (typed, drawn) = (limit("length"), edge.length());
        if typed.is_none_or(|typed| (typed - drawn).abs() > DIFFERENCE * drawn) {
            warnings.add(name, "its length is not that of its geometry, which counts");
        }
        layout.edges.push(edge);
    }
    if layout.nodes.is_empty() {
        return Err(ImportError::new("model: there is no point in it"));
    }
    Ok(layout)
}

/// The lines and arcs of a path.
fn curve(
    path: roxmltree::Node<'_, '_>,
    name: &str,
    [from, to]: [[f64; 2]; 2],
    units: [f64; 2],
    tolerance: f64,
) -> Result<Fit, ImportError> {
    let layout = child(path, "pathLayout");
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
        "DIRECT" | "POLYPATH" => {
            let lines = points.windows(2).map(|pair| Placed::line(pair[0], pair[1]));
            let pieces = lines.filter(|line| line.shape.length() > 0.0).collect();
            Ok(Fit { pieces, deviation: 0.0 })
        }
        other => Err(ImportError::new(format!("{name}: {other} with {} control points is not read", points.len() - 2))),
    }
}
