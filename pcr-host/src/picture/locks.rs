//! A layout and its locks: a picture of the corridors, and a page in which an edge shows what it blocks.
//!
//! The corridor that a disc sweeps on an edge is the stroke of the edge with round ends, as wide as the disc: SVG draws it exactly.

use super::axis::{AXIS_SIZE, Frame, ROOM_BELOW, at_least_visible, room_at_left};
use super::map::ROOM_ABOVE;
use super::svg::{Escaped, PathData, Pixels, Svg};
use crate::import::{Edge, Id, Imported, Layout, Node, Placed};
use crate::locks::Locks;
use crate::scenario::PathSegment;
use pcr_core::Interval;
use serde_json::{Value, json};
use std::collections::HashMap;
use std::f64::consts::PI;

const TEMPLATE: &str = include_str!("locks/locks.html");
const STYLE: &str = include_str!("locks/locks.css");
const SCRIPT: &str = include_str!("locks/locks.js");

/// Largest width and height of the plot \[px\].
const SIDE: f64 = 720.0;

/// Smallest ones \[px\].
const LEAST: f64 = 160.0;

/// Nodes up to which their names are written.
const NAMED: usize = 60;

/// Steps of a metre in the page: coordinates are written to a hundredth of a step.
const STEPS: f64 = 1000.0;

/// Lines and true arcs of an edge, by a map from metres to the picture; `flipped` where its y-axis points down.
fn path(edge: &Edge, scale: f64, flipped: bool, at: impl Fn([f64; 2]) -> [f64; 2]) -> PathData {
    let mut data = PathData::default();
    for (k, piece) in edge.curve.iter().enumerate() {
        if k == 0 {
            data.move_to(at(piece.at));
        }
        match piece.shape {
            PathSegment::Line { .. } => data.line_to(at(piece.end())),
            PathSegment::Arc { radius, sweep } => {
                // Below half a turn two points and a radius leave no doubt which arc is meant.
                let parts = (sweep.abs() / (0.75 * PI)).ceil().max(1.0) as usize;
                for part in 1..=parts {
                    let sweep = sweep * part as f64 / parts as f64;
                    let end = Placed { shape: PathSegment::Arc { radius, sweep }, ..*piece }.end();
                    data.arc_to(radius * scale, (sweep > 0.0) != flipped, at(end));
                }
            }
        }
    }
    data
}

/// Box around what is on a level, with room for discs of this radius \[m\].
fn bounds(layout: &Layout, level: Option<usize>, radius: f64) -> [Interval<f64>; 2] {
    let on = |other: usize| level.is_none_or(|level| level == other);
    let nodes = layout.nodes.iter().filter(|node| on(node.level)).map(|node| node.at);
    let pieces = layout.edges.iter().filter(|edge| on(layout.level(edge))).flat_map(|edge| &edge.curve);
    let points = pieces.flat_map(|piece| {
        // Arcs by points of which none is farther than an eighth of a turn from the next.
        (0..=8).map(|k| match piece.shape {
            PathSegment::Line { .. } if k < 8 => piece.at,
            PathSegment::Line { .. } => piece.end(),
            PathSegment::Arc { radius, sweep } => {
                let sweep = sweep * f64::from(k) / 8.0;
                Placed { shape: PathSegment::Arc { radius, sweep }, ..*piece }.end()
            }
        })
    });
    let mut range = [(f64::INFINITY, f64::NEG_INFINITY); 2];
    for point in nodes.chain(points) {
        for ((lo, hi), x) in range.iter_mut().zip(point) {
            (*lo, *hi) = (lo.min(x), hi.max(x));
        }
    }
    let room = |(lo, hi): (f64, f64)| if lo <= hi { (lo - 1.5 * radius, hi + 1.5 * radius) } else { (0.0, 1.0) };
    range.map(room).map(|(lo, hi)| at_least_visible(Interval::new(lo, hi)))
}

/// The corridors of a level as a picture of its own.
pub(super) fn picture(imported: &Imported, locks: &Locks, level: usize) -> String {
    let (layout, vehicle) = (&imported.layout, &locks.vehicle);
    let [x, y] = bounds(layout, Some(level), vehicle.radius);
    let metre = SIDE / x.length().max(y.length());
    let fit = |values: Interval<f64>| {
        let pixels = (values.length() * metre).max(LEAST);
        let half = pixels / metre / 2.0;
        (pixels, Interval::new(values.middle() - half, values.middle() + half))
    };
    let ((width, x), (height, y)) = (fit(x), fit(y));
    let left = room_at_left(y, height);
    let frame = Frame::new(x, y, [left, ROOM_ABOVE, left + width, ROOM_ABOVE + height]);
    let title = title(layout, locks, level);
    let [_, _, right, bottom] = frame.edges;
    let mut svg = Svg::new(right + 12.0, bottom + ROOM_BELOW, &title);
    let size = Pixels(AXIS_SIZE + 0.5);
    svg.label([(left + right) / 2.0, ROOM_ABOVE - 9.0], "middle", &[("font-size", &size)], &title);
    frame.draw(&mut svg, ["x [m]", "y [m]"]);
    let edges: Vec<&Edge> = layout.edges.iter().filter(|edge| layout.level(edge) == level).collect();
    let round: [(&str, &dyn std::fmt::Display); 3] =
        [("fill", &"none"), ("stroke-linecap", &"round"), ("stroke-linejoin", &"round")];
    let strokes = |svg: &mut Svg, colour: &str, opacity: &str, width: &dyn Fn(&Edge) -> f64| {
        svg.start("g", &[&round[..], &[("stroke", &colour), ("stroke-opacity", &opacity)]].concat());
        for edge in &edges {
            let data = path(edge, metre, true, |point| frame.at(point));
            if !data.is_empty() {
                svg.empty("path", &[("d", &data), ("stroke-width", &Pixels(width(edge)))]);
            }
        }
        svg.end();
    };
    strokes(&mut svg, "#2078bf", "0.1", &|edge| 2.0 * (vehicle.radius + edge.deviation) * metre);
    strokes(&mut svg, "#1d2125", "1", &|_| 1.1);
    let nodes: Vec<&Node> = layout.nodes.iter().filter(|node| node.level == level).collect();
    svg.start("g", &[("fill", &"#a94022"), ("font-size", &Pixels(9.0))]);
    for node in &nodes {
        let [x, y] = frame.at(node.at);
        svg.empty("circle", &[("cx", &Pixels(x)), ("cy", &Pixels(y)), ("r", &Pixels(2.0))]);
        if nodes.len() <= NAMED {
            svg.label([x + 3.5, y - 3.5], "start", &[], &node.id.to_string());
        }
    }
    svg.end();
    frame.draw_border(&mut svg);
    svg.finish()
}

fn title(layout: &Layout, locks: &Locks, level: usize) -> String {
    let name = if layout.name.is_empty() { "Layout" } else { &layout.name };
    let level = match layout.levels.get(level).filter(|_| layout.levels.len() > 1) {
        Some(level) => format!(", {level}"),
        None => String::new(),
    };
    format!("{name}{level}: corridors of a disc of {} m", locks.vehicle.radius)
}

/// The page.
pub(super) fn page(imported: &Imported, locks: &Locks) -> String {
    let name = if imported.layout.name.is_empty() { "Layout" } else { &imported.layout.name };
    let data = data(imported, locks).to_string();
    let mut page = String::new();
    for part in TEMPLATE.split("{{") {
        let (key, text) = part.split_once("}}").unwrap_or(("", part));
        match key {
            "title" => page.push_str(&Escaped(name).to_string()),
            "style" => page.push_str(STYLE),
            "script" => page.push_str(SCRIPT),
            // A text in the data cannot end the element that holds it.
            "data" => page.push_str(&data.replace('<', "\\u003c")),
            _ => {}
        }
        page.push_str(text);
    }
    page
}

/// Numbers of the page: lengths in metres, coordinates and path data in steps of a millimetre, y up.
fn data(imported: &Imported, locks: &Locks) -> Value {
    let (layout, vehicle) = (&imported.layout, &locks.vehicle);
    let steps = |point: [f64; 2]| point.map(|x| x * STEPS);
    let edges = layout.edges.iter().map(|edge| {
        let ends = edge.ends.map(|node| layout.nodes.get(node).map(|node| node.id.to_string()).unwrap_or_default());
        json!({
            "id": edge.id.to_string(),
            "ends": ends,
            "level": layout.level(edge),
            "length": edge.length(),
            "radius": vehicle.radius + edge.deviation,
            "path": path(edge, STEPS, false, steps).to_string(),
        })
    });
    let nodes = layout.nodes.iter().map(|node| {
        let [x, y] = steps(node.at);
        json!({ "id": node.id.to_string(), "level": node.level, "x": x, "y": y })
    });
    let places: HashMap<&Id, usize> = layout.edges.iter().enumerate().map(|(k, edge)| (&edge.id, k)).collect();
    let locks = locks
        .locks
        .iter()
        .filter_map(|lock| Some(json!([places.get(&lock.a)?, places.get(&lock.b)?, lock.a_length, lock.b_length])));
    let [x, y] = bounds(layout, None, vehicle.radius);
    let bounds = [x.lo, -y.hi, x.length(), y.length()].map(|length| length * STEPS);
    json!({
        "radius": vehicle.radius,
        "levels": layout.levels,
        "bounds": bounds,
        "edges": edges.collect::<Vec<_>>(),
        "nodes": nodes.collect::<Vec<_>>(),
        "locks": locks.collect::<Vec<_>>(),
    })
}

#[cfg(test)]
mod tests {
    use super::super::write_locks;
    use super::*;
    use crate::import::{Format, Options, Warnings, layout};

    const CURVES: &str = include_str!("../../../tests/data/real/lif/example_17.lif.json");

    fn imported(format: Format, text: &str) -> Imported {
        let options = Options { radius: Some(0.4), ..Options::default() };
        layout(format, text, &options, &mut Warnings::default()).unwrap()
    }

    #[test]
    fn the_page_holds_every_edge_and_lock_and_asks_for_nothing() {
        let text = include_str!("../../../tests/data/real/nav2/warehouse_graph.geojson");
        let imported = imported(Format::Nav2, &text.replace("warehouse_graph", "</script><script>alert(1)"));
        let locks = Locks::of(&imported, false).unwrap();
        let page = page(&imported, &locks);
        assert_eq!((page.matches("</script>").count(), page.matches("<script>alert").count()), (2, 0));
        for request in ["src=", "href=", "@import", "url(", "fetch(", "import("] {
            assert!(!page.contains(request), "{request}");
        }
        let (_, rest) = page.split_once(r#"<script type="application/json" id="data">"#).unwrap();
        let data: Value = serde_json::from_str(rest.split_once("</script>").unwrap().0).unwrap();
        assert_eq!(data["edges"].as_array().unwrap().len(), 172);
        assert_eq!(data["locks"].as_array().unwrap().len(), locks.locks.len());
        assert!(!locks.locks.is_empty());
    }

    #[test]
    fn curves_are_drawn_with_true_arcs() {
        let imported = imported(Format::Lif, CURVES);
        let locks = Locks::of(&imported, false).unwrap();
        let svg = picture(&imported, &locks, 0);
        let document = roxmltree::Document::parse(&svg).unwrap();
        let arcs = document.descendants().filter_map(|node| node.attribute("d")).map(|data| data.matches('A').count());
        // Corridor and line of each edge.
        let pieces: usize = imported.layout.edges.iter().map(|edge| edge.curve.len()).sum();
        assert_eq!(arcs.sum::<usize>(), 2 * pieces);
        assert!(!svg.contains("NaN"));
    }

    #[test]
    fn files_are_written_for_every_level() {
        let text = include_str!("../../../tests/data/real/lif/example_05.lif.json");
        let imported = imported(Format::Lif, text);
        let locks = Locks::of(&imported, false).unwrap();
        let directory = std::env::temp_dir().join(format!("pcr-locks-{}", std::process::id()));
        let files = write_locks(&imported, &locks, &directory).unwrap();
        let names: Vec<_> = files.iter().map(|file| file.file_name().unwrap().to_str().unwrap()).collect();
        assert_eq!(names, ["locks.html", "layout.svg", "layout.png", "layout-2.svg", "layout-2.png"]);
        std::fs::remove_dir_all(directory).unwrap();
    }
}
