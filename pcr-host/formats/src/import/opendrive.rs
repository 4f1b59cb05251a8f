//! OpenDRIVE: the reference lines of roads, whose lines and arcs are used unchanged. Spirals (`clothoid`) and cubic curves (`polynomial`)
//! become arcs within the tolerance, and how far these are from them counts as deviation.
//!
//! A road is an edge that may be travelled in both directions; its ends are nodes. Linked roads share a node if their
//! reference lines meet; the node then has the names of all these ends. If the lines of linked roads do not meet,
//! mostly because lanes shift them sideways, no path leads from one to the other, and there is a warning. Small gaps at
//! joints within a road, of the size of errors in maps, are closed: the rest of the road keeps its place, and the gap
//! counts as deviation of its path. So do those between the ends of roads that share a node. Lanes are not read.

use super::biarc::{self, BiarcFit};
use super::clothoid;
use super::keys::Keys;
use super::layout::{ElementId, Layout, LayoutEdge, LayoutNode};
use super::polynomial::{self, Cubic};
use super::route::turn_over;
use super::unique_names::{NameError, UniqueNames};
use super::xml::{child, children, lose_astray, number, only, optional, parse, warn_of_unknown};
use super::{ImportError, ImportOptions, WarningCode, Warnings};
use crate::plane_geometry::{distance, wrapped};
use crate::scenario::{LIMIT, PathSegment, PlacedSegment};
use std::collections::HashMap;
use std::f64::consts::TAU;
use std::fmt;

/// Gap \[m\] and angle \[rad\] of a joint that are rounding and nothing else.
const CLOSED: f64 = 1e-9;

/// Largest gap that is closed \[m\].
const GAP: f64 = 0.05;

/// Largest part of its length by which the geometry of a road may miss it, if that is more than [`GAP`]: lengths are rounded in maps.
const ROUNDED: f64 = 1e-4;

/// Largest part of its length by which a parametric curve may miss that of its record, if that is more than [`GAP`]: editors fit them.
const PARAMETRIC: f64 = 0.01;

/// Elements that may be in any other one, and say nothing of its shape.
const ADDED: [&str; 2] = ["userData", "dataQuality"];

/// What is read of a file, or known to have no reference line.
const KNOWN: [&str; 8] = ["header", "road", "controller", "junction", "junctionGroup", "station", ADDED[0], ADDED[1]];

/// Elements that are known in a road.
const OF_ROAD: [&str; 13] = [
    "link",
    "type",
    "planView",
    "elevationProfile",
    "lateralProfile",
    "lanes",
    "objects",
    "signals",
    "surface",
    "railroad",
    "include",
    ADDED[0],
    ADDED[1],
];
/// Those of its link.
const OF_LINK: [&str; 5] = ["predecessor", "successor", "neighbor", ADDED[0], ADDED[1]];
/// Those of a part of the road with a type and a speed.
const OF_TYPE: [&str; 3] = ["speed", ADDED[0], ADDED[1]];

/// Largest radius of an arc \[m\]; beyond it a line stands for it, and how far it leaves that counts as deviation.
const STRAIGHT: f64 = 1e9;

/// Most turns of an arc: more is a damaged file.
const WINDINGS: f64 = 100.0;

fn windings(shape: &PathSegment) -> f64 {
    match shape {
        PathSegment::Arc { sweep, .. } => sweep.abs() / TAU,
        _ => 0.0,
    }
}

const ROAD: Keys = Keys::new(&["id", "length"], &["name", "junction", "rule"]);
const SPEED: Keys = Keys::new(&["max", "unit"], &[]);
/// A part of a road with a type and a speed.
const TYPE: Keys = Keys::new(&["s", "type"], &["country"]).not(&["max", "unit"]);
const GEOMETRY: Keys = Keys::new(&["s", "x", "y", "hdg", "length"], &[]);
/// The road or junction that follows at an end of a road.
const LINKED: Keys = Keys::new(&["elementType", "elementId", "contactPoint"], &["elementS", "elementDir"]);

/// The attributes of a shape; `None` for one that is not read.
fn shape_keys(shape: &str) -> Option<Keys> {
    Some(match shape {
        "line" => Keys::new(&[], &[]),
        "arc" => Keys::new(&["curvature"], &[]),
        "spiral" => Keys::new(&["curvStart", "curvEnd"], &[]),
        "paramPoly3" => Keys::new(&["aU", "bU", "cU", "dU", "aV", "bV", "cV", "dV", "pRange"], &[]),
        "poly3" => Keys::new(&["a", "b", "c", "d"], &[]),
        _ => return None,
    })
}

/// The reference line of a road.
struct ReferenceLine {
    pieces: Vec<PlacedSegment>,
    /// Distance of `pieces` from it at the same length \[m\].
    deviation: f64,
    /// Difference of the headings \[rad\].
    turned: f64,
    /// Difference of both lengths \[m\].
    longer: f64,
    /// Gap \[m\] and angle \[rad\] of its widest joint.
    joint: [f64; 2],
    /// Whether it has curves for which arcs stand.
    is_fitted: bool,
}

/// Reads the roads.
pub(super) fn read(text: &str, options: &ImportOptions, warnings: &mut Warnings) -> Result<Layout, ImportError> {
    let document = parse(text)?;
    let root = document.root_element();
    if !root.has_tag_name("OpenDRIVE") {
        return Err(ImportError::new(format!("{}: not an OpenDRIVE file", root.tag_name().name())));
    }
    let header = child(root, "header").and_then(|header| header.attribute("name")).unwrap_or_default();
    lose_astray(root, &["road"], warnings);
    warn_of_unknown(root, &KNOWN, warnings);
    // What another file has instead may be anything.
    for include in root.descendants().filter(|element| element.has_tag_name("include")) {
        let parent = include.parent().map_or("", |parent| parent.tag_name().name());
        warnings.lose(format_args!("include of {}, in {parent}", include.attribute("file").unwrap_or("a file")));
    }
    let mut names = UniqueNames::new();
    // The first road of each edge: a copy adds no links.
    let mut links = Vec::new();
    let (mut widest, mut open) = ([0.0_f64; 2], Vec::new());
    for (k, road) in children(root, "road").enumerate() {
        let Some(id) = road.attribute("id").filter(|id| !id.trim().is_empty()).map(str::to_owned) else {
            // No link leads to it.
            warnings.lose(format_args!("road at place {}: it has no id", k + 1));
            continue;
        };
        let name = format!("road {id}");
        let read = |warnings: &mut Warnings| -> Result<_, ImportError> {
            ROAD.check_attributes(road, &name, warnings)?;
            warn_of_unknown(road, &OF_ROAD, warnings);
            Ok((curve(road, &name, options.tolerance(), warnings)?, speed(road, &name, warnings)?, only(road, "link")?))
        };
        match read(warnings) {
            Err(error) => warnings.lose(error),
            Ok((ReferenceLine { pieces, .. }, ..)) if pieces.is_empty() => {
                warnings.lose(format_args!("{name}: it has no geometry"))
            }
            Ok((ReferenceLine { pieces, deviation, longer, turned, joint, is_fitted }, speed, link)) => {
                if is_fitted {
                    warnings.use_option("tolerance");
                }
                if joint.iter().any(|gap| *gap > CLOSED) {
                    widest = [widest[0].max(joint[0]), widest[1].max(joint[1])];
                    open.push(name);
                }
                // The nodes follow when all roads are known.
                let edge = LayoutEdge::new(named(&id), [0; 2], pieces);
                let edge = LayoutEdge { ways: [true; 2], speed: [speed; 2], deviation, longer, turned, ..edge };
                if names.add(edge, warnings) == links.len() {
                    links.push(link);
                }
            }
        }
    }
    if names.list().is_empty() {
        return Err(ImportError::new("OpenDRIVE: there is no road in it that can be read"));
    }
    for road in open {
        let [gap, angle] = widest;
        let problem = format!(
            "joints are open, by {gap:.1e} m and {angle:.1e} rad at most; they are closed and count as deviation"
        );
        warnings.add(WarningCode::Gap, road, problem);
    }
    let (group, RoadLinks { count, apart, widest }) = groups(&names, &links, warnings);
    if apart > 0 {
        let problem = format!(
            "{apart} of {count} are between reference lines up to {widest:.3} m apart; no route passes there from road to road"
        );
        warnings.add(WarningCode::Gap, "links of roads", problem);
    }
    let mut layout =
        Layout { name: header.to_owned(), levels: vec![String::new()], edges: names.into_list(), ..Layout::default() };
    join(&mut layout, &group);
    Ok(layout)
}

/// The name of a road, a number where it is one as numbers are written: `01` is another road than `1`.
fn named(id: &str) -> ElementId {
    let number = id.parse().ok().filter(|number: &u64| number.to_string() == id);
    number.map_or_else(|| ElementId::Text(id.to_owned()), ElementId::Number)
}

/// A record of the geometry of a road.
struct GeometryRecord<'r> {
    /// For messages.
    name: &'r str,
    at: [f64; 2],
    heading: f64,
    length: f64,
}

impl GeometryRecord<'_> {
    /// The lines and arcs of its shape.
    fn fit(&self, shape: roxmltree::Node<'_, '_>, tolerance: f64) -> Result<BiarcFit, ImportError> {
        let Self { name, at, heading, length } = *self;
        let field = |attribute: &str| number(shape, name, attribute);
        let named = |error: ImportError| ImportError::new(format!("{name}: {error}"));
        let placed = |shape| vec![PlacedSegment { start: at, heading, shape }];
        let cubic = |names: [&str; 4]| -> Result<Cubic, ImportError> {
            Ok([field(names[0])?, field(names[1])?, field(names[2])?, field(names[3])?])
        };
        match shape.tag_name().name() {
            "line" => Ok(BiarcFit::exact(placed(PathSegment::Line { length }))),
            "arc" => {
                let curvature = field("curvature")?;
                let sweep = length * curvature;
                Ok(match curvature.abs().recip() {
                    radius if radius < STRAIGHT => BiarcFit::exact(placed(PathSegment::arc(radius, sweep))),
                    _ => BiarcFit {
                        // How far the arc leaves its tangent.
                        deviation: 0.5 * length * sweep.abs(),
                        heading_error: sweep.abs(),
                        ..BiarcFit::exact(placed(PathSegment::Line { length }))
                    },
                })
            }
            "spiral" => {
                let curvatures = [field("curvStart")?, field("curvEnd")?];
                if length * curvatures.iter().fold(0.0, |most: f64, k| most.max(k.abs())) > WINDINGS * TAU {
                    return Err(ImportError::new(format!("{name}: its length, heading or sweep is out of range")));
                }
                clothoid::fit(at, heading, length, curvatures, tolerance).map_err(named)
            }
            "paramPoly3" => {
                let [u, v] = [cubic(["aU", "bU", "cU", "dU"])?, cubic(["aV", "bV", "cV", "dV"])?];
                let last = match shape.attribute("pRange") {
                    None | Some("normalized") => 1.0,
                    Some("arcLength") => length,
                    Some(other) => {
                        return Err(ImportError::new(format!("{name}, paramPoly3, pRange: {other} is not known")));
                    }
                };
                let curve = polynomial::parametric([u, v], last, at, heading);
                let fit = biarc::fit(std::slice::from_ref(&curve), tolerance).map_err(named)?;
                // A curve that has another length than its record is another curve: its parameter has another range, or it is damaged.
                let [least, most] = polynomial::length_of(&curve, tolerance);
                let apart = (least - length).max(length - most);
                if apart > GAP.max(PARAMETRIC * length) {
                    let problem = format!("its curve is {most:.3} m long, and its length is {length}");
                    return Err(ImportError::new(format!("{name}: {problem}")));
                }
                Ok(fit)
            }
            "poly3" => {
                let v = cubic(["a", "b", "c", "d"])?;
                let placed = PlacedSegment { start: at, heading, shape: PathSegment::Line { length } };
                let (curve, unsure) = polynomial::graph(v, length, placed, tolerance).map_err(named)?;
                if unsure > tolerance {
                    return Err(ImportError::new(format!("{name}: its length is known to {unsure:.1e} m only")));
                }
                let fit = biarc::fit(std::slice::from_ref(&curve), tolerance).map_err(named)?;
                Ok(BiarcFit { deviation: fit.deviation + unsure, length_error: fit.length_error + unsure, ..fit })
            }
            other => Err(ImportError::new(format!("{name}: {other} is not read"))),
        }
    }
}

/// The lines and arcs of a road, and its widest joint.
fn curve(
    road: roxmltree::Node<'_, '_>,
    name: &str,
    tolerance: f64,
    warnings: &mut Warnings,
) -> Result<ReferenceLine, ImportError> {
    let mut curve: Vec<PlacedSegment> = Vec::new();
    let (mut joint, mut deviation, mut turned) = ([0.0_f64; 2], 0.0_f64, 0.0_f64);
    let mut along = 0.0_f64;
    // By how much curves and their arcs differ in length up to here, and how far the end of the last one may be from that of its arcs.
    let (mut longer, mut off, mut is_fitted) = (0.0_f64, [0.0_f64; 2], false);
    let view = only(road, "planView")?.ok_or_else(|| ImportError::new(format!("{name}, planView: missing")))?;
    let records = view.children().filter(|child| child.is_element() && !ADDED.contains(&child.tag_name().name()));
    for (k, record) in records.enumerate() {
        if !record.has_tag_name("geometry") {
            return Err(ImportError::new(format!("{name}, planView: {} is not read", record.tag_name().name())));
        }
        let name = format!("{name}, geometry {}", k + 1);
        GEOMETRY.check_attributes(record, &name, warnings)?;
        let field = |attribute: &str| number(record, &name, attribute);
        let (at, heading, length) = ([field("x")?, field("y")?], field("hdg")?, field("length")?);
        // A gap between two records, or at the end, would leave the geometry unknown.
        if let Some(s) = optional(record, &name, "s")?
            && (s - along).abs() > GAP.max(ROUNDED * along)
        {
            return Err(ImportError::new(format!("{name}: its s is {s}, after {along:.3} m of records")));
        }
        along += length;
        let mut elements =
            record.children().filter(|child| child.is_element() && !ADDED.contains(&child.tag_name().name()));
        let element = elements.next();
        if let Some(second) = elements.next() {
            return Err(ImportError::new(format!("{name}: a second shape, {}", second.tag_name().name())));
        }
        let element = element.ok_or_else(|| ImportError::new(format!("{name}: it has no shape")))?;
        let shape = element.tag_name().name();
        // One that is not read is refused below.
        if let Some(keys) = shape_keys(shape) {
            keys.check_attributes(element, &format!("{name}, {shape}"), warnings)?;
        }
        if !(0.0..=LIMIT).contains(&length) || heading.abs() > 1e6 {
            return Err(ImportError::new(format!("{name}: its length, heading or sweep is out of range")));
        }
        if length == 0.0 {
            continue;
        }
        let fit = GeometryRecord { name: &name, at, heading, length }.fit(element, tolerance)?;
        if fit.pieces.iter().any(|piece| piece.shape.length() > LIMIT || windings(&piece.shape) > WINDINGS) {
            return Err(ImportError::new(format!("{name}: its length, heading or sweep is out of range")));
        }
        if let (Some(before), Some(first)) = (curve.last(), fit.pieces.first()) {
            let gap = (distance(before.end(), first.start) - off[0]).max(0.0);
            if gap > GAP {
                return Err(ImportError::new(format!("{name}: it begins {gap:.3} m from the end of the one before")));
            }
            let turn = wrapped(first.heading - before.heading_at_end()).abs();
            joint = [joint[0].max(gap), joint[1].max(turn - off[1])];
        }
        is_fitted |= fit.bends;
        off = [fit.deviation, fit.heading_error];
        // A vehicle on the curve is ahead of one on the arcs, or behind it, by the difference of their lengths.
        deviation = deviation.max(fit.deviation + longer);
        turned = turned.max(fit.heading_error + turn_over(&fit.pieces, longer));
        longer += fit.length_error;
        curve.extend(fit.pieces);
    }
    if let Some(length) = optional(road, name, "length")?
        && (length - along).abs() > GAP.max(ROUNDED * length)
    {
        return Err(ImportError::new(format!("{name}: its length is {length}, and its records have {along:.3} m")));
    }
    let [closed, closing, askew] = close(&mut curve);
    let turned = turned + askew + turn_over(&curve, closing);
    Ok(ReferenceLine {
        pieces: curve,
        deviation: deviation + closed,
        longer: longer + closing,
        turned,
        joint,
        is_fitted,
    })
}

/// Closes the joints that are open: a line goes from where the piece before ends to its own end, an arc is displaced as a whole.
/// Returns how far a place may then be from that at the same length of the records, by how much the lengths differ \[m\], and by how much
/// a line is turned \[rad\].
fn close(curve: &mut Vec<PlacedSegment>) -> [f64; 3] {
    let Some(mut at) = curve.first().map(|first| first.start) else { return [0.0; 3] };
    let (mut longer, mut deviation, mut turned) = (0.0_f64, 0.0_f64, 0.0_f64);
    for piece in curve.iter_mut() {
        let asked = *piece;
        if distance(at, asked.start) > CLOSED {
            *piece = match asked.shape {
                PathSegment::Arc { .. } => PlacedSegment { start: at, ..asked },
                _ => PlacedSegment::line(at, asked.end()),
            };
        }
        turned = turned.max(wrapped(piece.heading - asked.heading).abs());
        let before = longer;
        longer += piece.shape.length() - asked.shape.length();
        let apart = distance(at, asked.start).max(distance(piece.end(), asked.end()));
        if apart > CLOSED || longer.abs() > CLOSED {
            deviation = deviation.max(apart + before.abs().max(longer.abs()));
        }
        at = piece.end();
    }
    curve.retain(|piece| piece.shape.length() > 0.0);
    [deviation, if longer.abs() > CLOSED { longer.abs() } else { 0.0 }, turned]
}

/// The speed limit of a road, the least one where it changes on the way \[m/s\].
fn speed(road: roxmltree::Node<'_, '_>, name: &str, warnings: &mut Warnings) -> Result<Option<f64>, ImportError> {
    let mut limits = Vec::new();
    for part in children(road, "type") {
        TYPE.check_attributes(part, &format!("{name}, type"), warnings)?;
        warn_of_unknown(part, &OF_TYPE, warnings);
    }
    for limit in children(road, "type").flat_map(|part| children(part, "speed")) {
        SPEED.check_attributes(limit, &format!("{name}, speed"), warnings)?;
        let unit = match limit.attribute("unit") {
            Some("mph") => 0.447_04,
            Some("km/h") => 1.0 / 3.6,
            None | Some("m/s") => 1.0,
            Some(other) => return Err(ImportError::new(format!("{name}, speed, unit: {other} is not known"))),
        };
        if !matches!(limit.attribute("max"), Some("no limit" | "undefined")) {
            let most = number(limit, &format!("{name}, speed"), "max")?;
            if most < 0.0 {
                return Err(ImportError::new(format!("{name}, speed, max: {most} where a number from 0 is expected")));
            }
            // 0 is what maps say that have no limits.
            limits.extend(Some(most * unit).filter(|limit| *limit > 0.0 && *limit < 1e6));
        }
    }
    let least = limits.iter().copied().reduce(f64::min);
    if limits.iter().any(|limit| Some(*limit) != least) {
        warnings.add(
            WarningCode::SpeedLimit,
            name,
            "its speed limit changes on the way; the least one is taken for all of it",
        );
    }
    Ok(least)
}

/// Links between the ends of roads.
struct RoadLinks {
    count: usize,
    /// Between ends that are apart.
    apart: usize,
    /// The largest distance of linked ends \[m\].
    widest: f64,
}

/// Why a link of a road is broken.
enum LinkError {
    /// The road that it leads to is not there, or there twice.
    Road(NameError),
    /// Its elementType is none that is known.
    ElementType,
    /// It does not say which end of the road.
    NoContactPoint,
    /// One of its attributes may be meant for another one.
    Attribute(ImportError),
}

impl fmt::Display for LinkError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Road(error) => error.fmt(f),
            Self::ElementType => f.write_str("its elementType is not road and not junction"),
            Self::NoContactPoint => f.write_str("it has no contactPoint"),
            Self::Attribute(error) => error.fmt(f),
        }
    }
}

/// For each end of a road, by 2 × road and one more for its end, the end that stands for all that are linked to it and meet it.
fn groups(
    roads: &UniqueNames<LayoutEdge>,
    links: &[Option<roxmltree::Node<'_, '_>>],
    warnings: &mut Warnings,
) -> (Vec<usize>, RoadLinks) {
    let mut gaps = HashMap::new();
    let mut group: Vec<usize> = (0..2 * links.len()).collect();
    fn find(group: &mut [usize], mut end: usize) -> usize {
        while group[end] != end {
            group[end] = group[group[end]];
            end = group[end];
        }
        end
    }
    for (place, link) in links.iter().enumerate() {
        let Some(link) = link else { continue };
        warn_of_unknown(*link, &OF_LINK, warnings);
        for (side, name) in ["predecessor", "successor"].into_iter().enumerate() {
            let Some(linked) = child(*link, name) else { continue };
            let end = format!("road {}, {name}", roads.list()[place].id);
            let other = LINKED.check_attributes(linked, &end, warnings).map_err(LinkError::Attribute);
            let other = match (other, linked.attribute("elementType")) {
                (Err(error), _) => Err(error),
                // Junctions are roads that are linked to the roads that they join.
                (_, Some("junction")) => continue,
                (_, Some("road")) => {
                    let other = roads.index_of(&named(linked.attribute("elementId").unwrap_or_default()));
                    other.map_err(LinkError::Road)
                }
                _ => Err(LinkError::ElementType),
            };
            match (other, linked.attribute("contactPoint")) {
                (Ok(road), Some(point @ ("start" | "end"))) => {
                    let (end, other) = (2 * place + side, 2 * road + usize::from(point == "end"));
                    let [a, b] = [end, other].map(|end| end_of(roads.list(), end));
                    let gap = distance(a, b);
                    // A link is mostly told by both of its roads.
                    gaps.insert([end.min(other), end.max(other)], gap);
                    if gap <= GAP {
                        let (a, b) = (find(&mut group, end), find(&mut group, other));
                        group[a.max(b)] = a.min(b);
                    }
                }
                (other, _) => {
                    let problem = other.err().unwrap_or(LinkError::NoContactPoint);
                    let road = roads.list()[place].id.clone();
                    warnings.add(
                        WarningCode::BrokenLink,
                        format_args!("road {road}, {name}"),
                        format!("{problem}; no route leads over it"),
                    );
                }
            }
        }
    }
    let links = RoadLinks {
        count: gaps.len(),
        apart: gaps.values().filter(|gap| **gap > GAP).count(),
        widest: gaps.values().fold(0.0, |widest, gap| f64::max(widest, *gap)),
    };
    ((0..group.len()).map(|end| find(&mut group, end)).collect(), links)
}

/// Gives the roads their nodes: linked ends that meet are one node, which has the names of all of them. The way between an end and
/// its node belongs to the road, as deviation.
fn join(layout: &mut Layout, group: &[usize]) {
    let mut nodes = HashMap::new();
    for place in 0..layout.edges.len() {
        let mut farthest = 0.0_f64;
        for side in 0..2 {
            let at = end_of(&layout.edges, 2 * place + side);
            let next = layout.nodes.len();
            let node = *nodes.entry(group[2 * place + side]).or_insert(next);
            let id = format!("{}/{}", layout.edges[place].id, ["start", "end"][side]);
            if node == next {
                layout.nodes.push(LayoutNode { id: ElementId::Text(id), name: None, level: 0, point: at });
            } else {
                layout.aliases.push((id, node));
            }
            layout.edges[place].ends[side] = node;
            // Ends that are linked one to the next can be farther apart than [`GAP`]. No route passes there, but locks have to hold.
            farthest = farthest.max(distance(at, layout.nodes[node].point));
        }
        if farthest > CLOSED {
            layout.edges[place].deviation += farthest;
        }
    }
}

/// Position of an end of a road \[m\].
fn end_of(edges: &[LayoutEdge], end: usize) -> [f64; 2] {
    let curve = edges.get(end / 2).map_or(&[][..], |edge| &edge.curve);
    let at = if end.is_multiple_of(2) {
        curve.first().map(|first| first.start)
    } else {
        curve.last().map(PlacedSegment::end)
    };
    at.unwrap_or_default()
}

#[cfg(test)]
mod tests;
