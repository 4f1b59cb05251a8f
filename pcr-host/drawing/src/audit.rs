//! An audit as a picture, and as layers of the page of locks: groups as written, contacts that they do not exclude, and
//! pairs that they exclude in vain.

use super::axis::PlotArea;
use super::layout::{LayoutLevelView, STEPS, path};
use super::svg::{PixelCoordinate, SvgWriter};
use pcr_exclusions::{ExclusionAudit, ExclusionRules, LayoutElementId, MissingExclusion, stretch};
use pcr_formats::import::{ImportedLayout, LayoutNode};
use serde_json::{Value, json};
use std::collections::HashMap;
use std::fmt::Display;

/// Colours of groups, in turn.
const COLOURS: [&str; 6] = ["#2f8f4e", "#8a5bb5", "#c08a1e", "#2aa1a6", "#b5527f", "#6c7a1f"];

/// What can touch.
const OPEN: &str = "#d01c1c";

/// What is excluded in vain.
const NEEDLESS: &str = "#e07b00";

/// Needless pairs that are drawn at most: more than that is a net.
const MOST: usize = 400;

/// Height of a line of the legend \[px\].
const LINE: f64 = 15.0;

/// Places of edges by their names.
fn places(imported: &ImportedLayout) -> HashMap<String, usize> {
    imported.layout.edges.iter().enumerate().map(|(k, edge)| (edge.id.to_string(), k)).collect()
}

/// The middle of an edge \[m\].
fn middle(imported: &ImportedLayout, edge: usize) -> Option<[f64; 2]> {
    let edge = imported.layout.edges.get(edge)?;
    let half = edge.length() / 2.0;
    Some(stretch(&edge.curve, [half, half]).first()?.start)
}

fn edge_of(spot: &LayoutElementId, places: &HashMap<String, usize>) -> Option<usize> {
    match spot {
        LayoutElementId::Edge(id) => places.get(&id.to_string()).copied(),
        LayoutElementId::Node(_) => None,
    }
}

fn name(spot: &LayoutElementId) -> String {
    match spot {
        LayoutElementId::Edge(id) => format!("edge {id}"),
        LayoutElementId::Node(id) => format!("node {id}"),
    }
}

/// The layers of the page: coordinates in steps of a millimetre, y up.
pub(super) fn layers(imported: &ImportedLayout, rules: &ExclusionRules, audit: &ExclusionAudit) -> Value {
    let places = places(imported);
    let groups = rules.groups.iter().map(|group| {
        let edges: Vec<&usize> = group.edges.iter().filter_map(|edge| places.get(edge)).collect();
        let outline: Vec<[f64; 2]> = group.outline.iter().map(|corner| corner.map(|x| (x * STEPS).round())).collect();
        json!([group.name, edges, group.nodes, outline, group.level])
    });
    let gaps = audit.gaps.iter().map(|gap| {
        let [x, y] = gap.at.map(|x| x * STEPS);
        let edges = [edge_of(&gap.a, &places), edge_of(&gap.b, &places)];
        json!({ "x": x, "y": y, "depth": gap.depth, "a": name(&gap.a), "b": name(&gap.b), "relation": gap.relation,
            "edges": edges, "level": gap.level })
    });
    let needless = audit.needless.iter().filter_map(|pair| {
        let [a, b] = [&pair.a, &pair.b].map(|id| places.get(&id.to_string()).copied());
        let ends = [middle(imported, a?)?, middle(imported, b?)?].map(|point| point.map(|x| x * STEPS));
        Some(json!([a, b, ends]))
    });
    json!({
        "groups": groups.collect::<Vec<_>>(),
        "gaps": gaps.collect::<Vec<_>>(),
        "needless": needless.collect::<Vec<_>>(),
    })
}

/// A zone as it is in the file.
fn zone(svg: &mut SvgWriter, frame: &PlotArea, outline: &[[f64; 2]], colour: &str) {
    let corners: Vec<String> =
        outline.iter().map(|corner| frame.at(*corner)).map(|[x, y]| format!("{x:.1},{y:.1}")).collect();
    let width = PixelCoordinate(1.0);
    let fill: [(&str, &dyn Display); 3] = [("fill", &colour), ("fill-opacity", &"0.12"), ("stroke-opacity", &"0.7")];
    let points = corners.join(" ");
    svg.empty("polygon", &[&fill[..], &[("stroke", &colour), ("stroke-width", &width), ("points", &points)]].concat());
}

/// The picture of a level.
pub(super) fn picture(ground: LayoutLevelView<'_>, rules: &ExclusionRules, audit: &ExclusionAudit) -> String {
    let (imported, places) = (ground.imported, places(ground.imported));
    let layout = &imported.layout;
    let nodes: HashMap<String, &LayoutNode> =
        layout.nodes.iter().rev().map(|node| (node.id.to_string(), node)).collect();
    let on_level = |edge: usize| layout.edges.get(edge).is_some_and(|edge| layout.is_on(edge, ground.level));
    let level = layout.levels.get(ground.level).map_or("", String::as_str);
    let [before, name, after] = ground.title();
    let title = [before, name, format!("{after}, audit of {}", audit.exclusions)];
    ground.picture_with(&title, 18.0 + 2.0 * LINE, |svg, frame| {
        let metre = 1.0 / frame.x.units_per_pixel();
        let wide = PixelCoordinate((0.5 * audit.vehicle.radius * metre).max(2.0));
        let line: [(&str, &dyn Display); 3] =
            [("fill", &"none"), ("stroke-linecap", &"round"), ("stroke-opacity", &"0.45")];
        for (k, group) in rules.groups.iter().enumerate() {
            let colour = COLOURS[k % COLOURS.len()];
            if !group.outline.is_empty() {
                if group.level == ground.level {
                    zone(svg, frame, &group.outline, colour);
                }
                continue;
            }
            svg.start("g", &[&line[..], &[("stroke", &colour), ("stroke-width", &wide)]].concat());
            for edge in group.edges.iter().filter_map(|edge| places.get(edge)).filter(|edge| on_level(**edge)) {
                let data = path(&layout.edges[*edge].curve, metre, true, |point| frame.at(point));
                if !data.is_empty() {
                    svg.empty("path", &[("d", &data)]);
                }
            }
            for node in group.nodes.iter().filter_map(|name| nodes.get(name)).filter(|node| node.level == ground.level)
            {
                let [x, y] = frame.at(node.point);
                svg.empty(
                    "circle",
                    &[("cx", &PixelCoordinate(x)), ("cy", &PixelCoordinate(y)), ("r", &PixelCoordinate(3.0))],
                );
            }
            svg.end();
        }
        svg.start("g", &[("stroke", &NEEDLESS), ("stroke-dasharray", &"3 3"), ("stroke-opacity", &"0.6")]);
        for pair in audit.needless.iter().take(MOST) {
            let ends = [&pair.a, &pair.b].map(|id| places.get(&id.to_string()).copied().filter(|edge| on_level(*edge)));
            let [Some(a), Some(b)] = ends.map(|edge| middle(imported, edge?)) else { continue };
            let [[x1, y1], [x2, y2]] = [frame.at(a), frame.at(b)].map(|point| point.map(PixelCoordinate));
            svg.empty("line", &[("x1", &x1), ("y1", &y1), ("x2", &x2), ("y2", &y2)]);
        }
        svg.end();
        svg.start("g", &[("stroke", &OPEN), ("fill", &OPEN), ("fill-opacity", &"0.25")]);
        // What is apart is what nobody sees in the graph: it comes last, over the rest.
        let (apart, near): (Vec<&MissingExclusion>, Vec<&MissingExclusion>) =
            audit.gaps.iter().partition(|gap| gap.relation == "apart");
        for gap in near.into_iter().chain(apart).filter(|gap| gap.level == level) {
            let [x, y] = frame.at(gap.at);
            let size =
                if gap.relation == "apart" { audit.vehicle.radius * metre } else { 0.4 * audit.vehicle.radius * metre };
            svg.empty(
                "circle",
                &[("cx", &PixelCoordinate(x)), ("cy", &PixelCoordinate(y)), ("r", &PixelCoordinate(size.max(2.0)))],
            );
        }
        svg.end();
        let [left, _, _, bottom] = frame.edges;
        let legend = [
            format!("colours: {} groups of the file", rules.groups.len()),
            format!("red: {} pairs that can touch; large ones share no node", audit.gaps.len()),
            format!(
                "orange: {} pairs excluded in vain{}",
                audit.needless.len(),
                if audit.needless.len() > MOST { format!(", {MOST} of them drawn") } else { String::new() }
            ),
        ];
        for (k, line) in legend.iter().enumerate() {
            let below = super::axis::ROOM_BELOW + 8.0 + LINE * k as f64;
            svg.label([left, bottom + below], "start", &[], line);
        }
    })
}
