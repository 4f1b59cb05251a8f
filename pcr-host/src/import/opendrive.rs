//! OpenDRIVE: the reference lines of roads, whose lines and arcs are taken as they are.
//!
//! A road is an edge that may be travelled both ways; its ends are nodes, which linked roads share where their reference lines meet: then
//! the node has the names of all ends. Where lines of linked roads are apart, mostly sideways by lanes, no path leads from one onto the
//! other, and there is a warning. Joints within a road that are open by what maps are off by are closed: the rest of the road
//! keeps its place, and the gap counts as deviation of its path. Lanes are not read.

use super::layout::{Edge, Id, Layout, Node, Placed};
use super::xml::{child, children, number, parse};
use super::{ImportError, Options, Warnings};
use crate::scenario::PathSegment;
use std::collections::HashMap;

/// Gap \[m\] and angle \[rad\] of a joint that are rounding and nothing else.
const CLOSED: f64 = 1e-9;

/// Largest gap that is closed \[m\].
const GAP: f64 = 0.05;

/// Largest radius of an arc \[m\]; beyond it, it is a line to the last digit of any coordinate.
const STRAIGHT: f64 = 1e9;

/// Most turns of an arc: more is a damaged file.
const WINDINGS: f64 = 100.0;

fn windings(shape: &PathSegment) -> f64 {
    match shape {
        PathSegment::Line { .. } => 0.0,
        PathSegment::Arc { sweep, .. } => sweep.abs() / std::f64::consts::TAU,
    }
}

/// Gap and angle of the widest joint of a road.
type Joint = [f64; 2];

/// Reads the roads.
pub(super) fn read(text: &str, options: &Options, warnings: &mut Warnings) -> Result<Layout, ImportError> {
    let document = parse(text)?;
    let root = document.root_element();
    if !root.has_tag_name("OpenDRIVE") {
        return Err(ImportError::new(format!("{}: not an OpenDRIVE file", root.tag_name().name())));
    }
    let header = child(root, "header").and_then(|header| header.attribute("name")).unwrap_or_default();
    let mut layout = Layout {
        name: header.to_owned(),
        levels: vec![String::new()],
        corner_radius: options.corner_radius,
        ..Layout::default()
    };
    let mut roads = HashMap::new();
    let (mut widest, mut open) = ([0.0_f64; 2], Vec::new());
    for (k, road) in children(root, "road").enumerate() {
        let id = road.attribute("id").map_or_else(|| format!("at place {}", k + 1), str::to_owned);
        let name = format!("road {id}");
        if roads.contains_key(&id) {
            warnings.add(name, "given twice; the first is taken");
            continue;
        }
        match curve(road, &name) {
            Err(error) => warnings.add(error, "road left out"),
            Ok((curve, _)) if curve.is_empty() => warnings.add(name, "left out: it has no geometry"),
            Ok((curve, joint)) => {
                if joint.iter().any(|gap| *gap > CLOSED) {
                    widest = [widest[0].max(joint[0]), widest[1].max(joint[1])];
                    open.push(name);
                }
                roads.insert(id.clone(), layout.edges.len());
                let id = id.parse().map_or(Id::Text(id), Id::Number);
                let speed = speed(road);
                // The nodes follow when all roads are known.
                layout.edges.push(Edge {
                    id,
                    ends: [0; 2],
                    curve,
                    two_way: true,
                    speed,
                    rotation: None,
                    deviation: 0.0,
                });
            }
        }
    }
    if layout.edges.is_empty() {
        return Err(ImportError::new("OpenDRIVE: there is no road of lines and arcs in it"));
    }
    for road in open {
        let [gap, angle] = widest;
        let problem = format!(
            "joints are open, by {gap:.1e} m and {angle:.1e} rad at most; they are closed and count as deviation"
        );
        warnings.add(road, problem);
    }
    let Links { count, apart, widest } = join(&mut layout, root, &roads);
    if apart > 0 {
        let problem = format!(
            "{apart} of {count} are between reference lines up to {widest:.3} m apart; no route passes there from road to road"
        );
        warnings.add("links of roads", problem);
    }
    Ok(layout)
}

/// The lines and arcs of a road, and its widest joint.
fn curve(road: roxmltree::Node<'_, '_>, name: &str) -> Result<(Vec<Placed>, Joint), ImportError> {
    let mut curve: Vec<Placed> = Vec::new();
    let mut joint = [0.0_f64; 2];
    let view = child(road, "planView").ok_or_else(|| ImportError::new(format!("{name}, planView: missing")))?;
    for (k, record) in children(view, "geometry").enumerate() {
        let name = format!("{name}, geometry {}", k + 1);
        let field = |attribute: &str| number(record, &name, attribute);
        let (at, heading, length) = ([field("x")?, field("y")?], field("hdg")?, field("length")?);
        let element = record.children().find(roxmltree::Node::is_element);
        let shape = match element.map(|element| (element.tag_name().name(), element)) {
            Some(("line", _)) => PathSegment::Line { length },
            Some(("arc", arc)) => {
                let curvature = number(arc, &name, "curvature")?;
                let sweep = length * curvature;
                match curvature.abs().recip() {
                    radius if radius < STRAIGHT => PathSegment::Arc { radius, sweep },
                    _ => PathSegment::Line { length },
                }
            }
            Some((other, _)) => return Err(ImportError::new(format!("{name}: {other} is not a line and not an arc"))),
            None => return Err(ImportError::new(format!("{name}: it has no shape"))),
        };
        if length < 0.0
            || length.is_nan()
            || heading.abs() > 1e6
            || shape.length() > crate::scenario::LIMIT
            || windings(&shape) > WINDINGS
        {
            return Err(ImportError::new(format!("{name}: its length, heading or sweep is out of range")));
        }
        if length == 0.0 {
            continue;
        }
        let placed = Placed { at, heading, shape };
        if let Some(before) = curve.last() {
            let end = before.end();
            let turn = (heading - before.heading_at_end()).rem_euclid(std::f64::consts::TAU);
            let gap = (end[0] - at[0]).hypot(end[1] - at[1]);
            if gap > GAP {
                return Err(ImportError::new(format!("{name}: it begins {gap:.3} m from the end of the one before")));
            }
            joint = [joint[0].max(gap), joint[1].max(turn.min(std::f64::consts::TAU - turn))];
        }
        curve.push(placed);
    }
    Ok((curve, joint))
}

/// The first speed limit of a road \[m/s\].
fn speed(road: roxmltree::Node<'_, '_>) -> Option<f64> {
    let limit = children(road, "type").find_map(|road_type| child(road_type, "speed"))?;
    let unit = match limit.attribute("unit") {
        Some("mph") => 0.447_04,
        Some("km/h") => 1.0 / 3.6,
        _ => 1.0,
    };
    let speed = limit.attribute("max")?.parse::<f64>().ok()? * unit;
    Some(speed).filter(|speed| *speed > 0.0 && *speed < 1e6)
}

/// Links between the ends of roads.
#[derive(Default)]
struct Links {
    count: usize,
    /// Between ends that are apart.
    apart: usize,
    /// The largest distance of linked ends \[m\].
    widest: f64,
}

/// Gives the roads their nodes: linked ends that meet are one node, which has the names of all of them.
fn join(layout: &mut Layout, root: roxmltree::Node<'_, '_>, roads: &HashMap<String, usize>) -> Links {
    let mut links = HashMap::new();
    // Ends by 2 × road, and one more for its end.
    let mut group: Vec<usize> = (0..2 * layout.edges.len()).collect();
    fn find(group: &mut [usize], mut end: usize) -> usize {
        while group[end] != end {
            group[end] = group[group[end]];
            end = group[end];
        }
        end
    }
    for road in children(root, "road") {
        let (Some(place), Some(link)) = (road.attribute("id").and_then(|id| roads.get(id)), child(road, "link")) else {
            continue;
        };
        for (side, name) in ["predecessor", "successor"].into_iter().enumerate() {
            let linked = child(link, name).filter(|link| link.attribute("elementType") == Some("road"));
            let other = linked.and_then(|link| {
                let road = roads.get(link.attribute("elementId")?)?;
                Some(2 * road + usize::from(link.attribute("contactPoint")? == "end"))
            });
            if let Some(other) = other {
                let end = 2 * place + side;
                let gap = gap(layout, [end, other]);
                // A link is mostly told by both of its roads.
                links.insert([end.min(other), end.max(other)], gap);
                if gap <= GAP {
                    let (a, b) = (find(&mut group, end), find(&mut group, other));
                    group[a.max(b)] = a.min(b);
                }
            }
        }
    }
    let mut nodes = HashMap::new();
    for place in 0..layout.edges.len() {
        for side in 0..2 {
            let root = find(&mut group, 2 * place + side);
            let at = end_of(layout, 2 * place + side);
            let next = layout.nodes.len();
            let node = *nodes.entry(root).or_insert(next);
            let id = format!("{}/{}", layout.edges[place].id, ["start", "end"][side]);
            if node == next {
                layout.nodes.push(Node { id: Id::Text(id), name: None, level: 0, at });
            } else {
                layout.aliases.push((id, node));
            }
            layout.edges[place].ends[side] = node;
        }
    }
    Links {
        count: links.len(),
        apart: links.values().filter(|gap| **gap > GAP).count(),
        widest: links.values().fold(0.0, |widest, gap| f64::max(widest, *gap)),
    }
}

/// Where an end of a road is \[m\].
fn end_of(layout: &Layout, end: usize) -> [f64; 2] {
    let curve = layout.edges.get(end / 2).map_or(&[][..], |edge| &edge.curve);
    let at = if end.is_multiple_of(2) { curve.first().map(|first| first.at) } else { curve.last().map(Placed::end) };
    at.unwrap_or_default()
}

/// Distance of two ends of roads \[m\].
fn gap(layout: &Layout, ends: [usize; 2]) -> f64 {
    let [a, b] = ends.map(|end| end_of(layout, end));
    (a[0] - b[0]).hypot(a[1] - b[1])
}
