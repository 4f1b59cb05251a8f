//! A layout as a picture: the corridors of a vehicle on the edges of a level.
//!
//! The corridor that a disc sweeps is the stroke of its path, as wide as the disc and with round ends; SVG draws this
//! exactly. That of an outline is drawn as the convex hulls of neighbouring poses.

use super::axis::{PlotArea, ROOM_ABOVE, ROOM_BELOW, at_least_visible, room_at_left};
use super::labels::{LabelPlacer, SPACING, around};
use super::svg::{PathData, PixelCoordinate, SvgWriter, text_width};
use pcr_core::Interval;
use pcr_exclusions::stretch;
use pcr_formats::import::{ImportedLayout, Layout, LayoutEdge, LayoutNode};
use pcr_formats::scenario::PathSegment;
use pcr_formats::scenario::PlacedSegment;
use pcr_planning::exclusion_table::{EdgeTraversals, SweptShape, corridor};
use serde_json::{Value, json};
use std::collections::HashSet;
use std::f64::consts::PI;
use std::fmt::Display;

/// Largest width and height of the plot \[px\].
const SIDE: f64 = 720.0;

/// Smallest ones \[px\].
const LEAST: f64 = 160.0;

/// Nodes up to which their names are written: of more only few have room.
const NAMED: usize = 1000;

/// Size of these names \[px\].
const NAME_SIZE: f64 = 9.0;

/// Radius of what names of nodes keep off \[px\].
const DOT: f64 = 2.5;

/// Shortest edge with an arrow \[px\].
const ARROW: f64 = 14.0;

/// Points of an edge at most that names keep off.
const MOST_OBSTACLES: f64 = 2000.0;

/// A level of a layout that a vehicle travels.
#[derive(Clone, Copy, Debug)]
pub struct LayoutLevelView<'a> {
    /// The layout and the vehicle.
    pub imported: &'a ImportedLayout,
    /// Place of the level in [`Layout::levels`].
    pub level: usize,
}

/// Arcs of a smaller radius than this are turns in place, of which nothing is to be seen \[m\].
const POINT: f64 = 1e-6;

/// Steps of a metre in pages: coordinates are written to a hundredth of a step.
pub(super) const STEPS: f64 = 1000.0;

/// Lines and true arcs one after the other, by a map from metres to the picture; `flipped` where its y-axis points down.
pub(super) fn path(curve: &[PlacedSegment], scale: f64, flipped: bool, at: impl Fn([f64; 2]) -> [f64; 2]) -> PathData {
    let mut data = PathData::default();
    for (k, piece) in curve.iter().enumerate() {
        if k == 0 {
            data.move_to(at(piece.start));
        }
        match piece.shape {
            PathSegment::Arc { radius, .. } if radius < POINT => data.line_to(at(piece.end())),
            PathSegment::Arc { radius, sweep, .. } => {
                // Below half a turn two points and a radius leave no doubt which arc is meant.
                let parts = (sweep.abs() / (0.75 * PI)).ceil().max(1.0) as usize;
                for part in 1..=parts {
                    let sweep = sweep * part as f64 / parts as f64;
                    let end = PlacedSegment { shape: PathSegment::arc(radius, sweep), ..*piece }.end();
                    data.arc_to(radius * scale, (sweep > 0.0) != flipped, at(end));
                }
            }
            _ => data.line_to(at(piece.end())),
        }
    }
    data
}

/// The same for a page, in [`STEPS`], y up.
pub(super) fn line(curve: &[PlacedSegment]) -> String {
    path(curve, STEPS, false, |point| point.map(|x| x * STEPS)).to_string()
}

/// A swept area for a page: its path, the width of its stroke, both in [`STEPS`], and whether it is filled.
pub(super) fn swept_area(shape: &SweptShape) -> Value {
    match shape {
        SweptShape::Stroke(curve, radius) => json!([line(curve), 2.0 * radius * STEPS, false]),
        SweptShape::Area(corners, radius) => {
            let mut data = PathData::default();
            data.polygon(corners.iter().map(|corner| corner.map(|x| (x * STEPS).round())));
            json!([data.to_string(), 2.0 * radius * STEPS, true])
        }
    }
}

/// Box around what is on a level, with room for discs of this radius \[m\].
pub(super) fn bounds(layout: &Layout, level: Option<usize>, radius: f64) -> [Interval<f64>; 2] {
    let on = |other: usize| level.is_none_or(|level| level == other);
    let nodes = layout.nodes.iter().filter(|node| on(node.level)).map(|node| node.point);
    let pieces = layout.edges.iter().filter(|edge| on(layout.level(edge))).flat_map(|edge| &edge.curve);
    let points = pieces.flat_map(|piece| {
        // Arcs by points of which none is farther than an eighth of a turn from the next.
        (0..=8).map(|k| match piece.shape {
            PathSegment::Line { .. } if k < 8 => piece.start,
            PathSegment::Arc { radius, sweep, .. } => {
                let sweep = sweep * f64::from(k) / 8.0;
                PlacedSegment { shape: PathSegment::arc(radius, sweep), ..*piece }.end()
            }
            _ => piece.end(),
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

/// The names of nodes beside them, each where it covers least of the edges; none where it would cover another name or a node.
fn draw_names(svg: &mut SvgWriter, frame: &PlotArea, edges: &[&LayoutEdge], nodes: &[&LayoutNode]) {
    let mut placer = LabelPlacer::default();
    let metres = SPACING * frame.x.units_per_pixel();
    for edge in edges {
        let length = edge.length();
        let count = (length / metres).ceil().min(MOST_OBSTACLES);
        let points = (0..=count as usize).filter_map(|k| {
            let at = length * k as f64 / count.max(1.0);
            stretch(&edge.curve, [at; 2]).first().map(|piece| frame.at(piece.start))
        });
        placer.avoid(1.0, points);
    }
    for node in nodes {
        placer.block(around(frame.at(node.point), [2.0 * DOT; 2]));
    }
    for node in nodes {
        let ([x, y], name) = (frame.at(node.point), node.id.to_string());
        let size = [text_width(&name, NAME_SIZE), NAME_SIZE];
        let [right, up] = [DOT + size[0] / 2.0 + 1.0, DOT + size[1] / 2.0 + 1.0];
        let beside = [
            [right, -up],
            [-right, -up],
            [right, up],
            [-right, up],
            [right, 0.0],
            [-right, 0.0],
            [0.0, -up],
            [0.0, up],
        ];
        let candidates = beside.map(|[dx, dy]| (0.0, [x + dx, y + dy]));
        if let Some([x, y]) = placer.best_position(size, candidates, frame.edges) {
            svg.label([x, y + 0.36 * NAME_SIZE], "middle", &[], &name);
        }
    }
}

impl LayoutLevelView<'_> {
    /// Box around what is on the level \[m\].
    pub(super) fn bounds(&self) -> [Interval<f64>; 2] {
        bounds(&self.imported.layout, Some(self.level), self.radius_with_margin())
    }

    /// Radius of the disc around the vehicle with its margin \[m\].
    fn radius_with_margin(&self) -> f64 {
        self.imported.vehicle.radius + self.imported.vehicle.margin
    }

    /// Corridors and edges of the level, y up: what a page draws below the agents.
    pub(super) fn lines(&self) -> Value {
        let layout = &self.imported.layout;
        let rides = EdgeTraversals::new(self.imported);
        let edges = || layout.edges.iter().filter(|edge| layout.level(edge) == self.level);
        let corridors = edges().flat_map(|edge| corridor(&rides.on_edge(edge)));
        json!({
            "steps": STEPS,
            "corridors": corridors.map(|shape| swept_area(&shape)).collect::<Vec<_>>(),
            "edges": edges().map(|edge| line(&edge.curve)).filter(|line| !line.is_empty()).collect::<Vec<_>>(),
        })
    }

    /// The corridors, the edges and the nodes, these with their names if they are few.
    pub(super) fn draw(&self, svg: &mut SvgWriter, frame: &PlotArea, names: bool) {
        let metre = 1.0 / frame.x.units_per_pixel();
        let layout = &self.imported.layout;
        let edges: Vec<&LayoutEdge> = layout.edges.iter().filter(|edge| layout.level(edge) == self.level).collect();
        let round: [(&str, &dyn Display); 3] =
            [("fill", &"none"), ("stroke-linecap", &"round"), ("stroke-linejoin", &"round")];
        let stroke = |svg: &mut SvgWriter, curve: &[PlacedSegment], width: f64| {
            let data = path(curve, metre, true, |point| frame.at(point));
            if !data.is_empty() {
                svg.empty("path", &[("d", &data), ("stroke-width", &PixelCoordinate(width))]);
            }
        };
        let rides = EdgeTraversals::new(self.imported);
        // One colour for all of them, however many lie on one another.
        svg.start("g", &[&round[..], &[("stroke", &"#2078bf"), ("opacity", &"0.18")]].concat());
        for shape in edges.iter().flat_map(|edge| corridor(&rides.on_edge(edge))) {
            match shape {
                SweptShape::Stroke(curve, radius) => stroke(svg, &curve, 2.0 * radius * metre),
                SweptShape::Area(corners, radius) => {
                    let mut data = PathData::default();
                    data.polygon(corners.iter().map(|corner| frame.at(*corner)));
                    let width = PixelCoordinate(2.0 * radius * metre);
                    svg.empty("path", &[("d", &data), ("fill", &"#2078bf"), ("stroke-width", &width)]);
                }
            }
        }
        svg.end();
        svg.start("g", &[&round[..], &[("stroke", &"#1d2125")]].concat());
        edges.iter().for_each(|edge| stroke(svg, &edge.curve, 1.1));
        // No arrows between nodes with ways in both directions, which may be two edges.
        let steps = || edges.iter().flat_map(|edge| edge.steps());
        let ways: HashSet<[usize; 2]> = steps().map(|step| [step.origin(), step.target()]).collect();
        let one_way = steps().filter(|step| !ways.contains(&[step.target(), step.origin()]));
        let arrows = one_way.fold(PathData::default(), |mut arrows, step| {
            let length = step.edge.length();
            if length * metre >= ARROW
                && let Some(middle) = stretch(&step.edge.curve, [length / 2.0; 2]).first()
            {
                arrows.arrow(frame.at(middle.start), middle.heading + if step.backward { PI } else { 0.0 });
            }
            arrows
        });
        if !arrows.is_empty() {
            svg.empty("path", &[("d", &arrows), ("fill", &"#1d2125"), ("stroke", &"none")]);
        }
        svg.end();
        let nodes: Vec<&LayoutNode> = layout.nodes.iter().filter(|node| node.level == self.level).collect();
        let radius = PixelCoordinate(if names { 2.0 } else { 1.2 });
        svg.start("g", &[("fill", &"#a94022"), ("font-size", &PixelCoordinate(NAME_SIZE))]);
        for node in &nodes {
            let [x, y] = frame.at(node.point);
            svg.empty("circle", &[("cx", &PixelCoordinate(x)), ("cy", &PixelCoordinate(y)), ("r", &radius)]);
        }
        if names && nodes.len() <= NAMED {
            draw_names(svg, frame, &edges, &nodes);
        }
        svg.end();
    }

    /// The level as a picture of its own.
    pub(super) fn picture(&self) -> String {
        self.picture_with(&self.title(), 0.0, |_, _| {})
    }

    /// The same under another title, with more on it and room below, in pixels.
    pub(super) fn picture_with(
        &self,
        title: &[String; 3],
        room: f64,
        more: impl FnOnce(&mut SvgWriter, &PlotArea),
    ) -> String {
        let [x, y] = self.bounds();
        let metre = SIDE / x.length().max(y.length());
        let fit = |values: Interval<f64>| {
            let pixels = (values.length() * metre).max(LEAST);
            let half = pixels / metre / 2.0;
            (pixels, Interval::new(values.middle() - half, values.middle() + half))
        };
        let ((width, x), (height, y)) = (fit(x), fit(y));
        let left = room_at_left(y, height);
        let frame = PlotArea::new(x, y, [left, ROOM_ABOVE, left + width, ROOM_ABOVE + height]);
        let [_, _, right, bottom] = frame.edges;
        let mut svg = SvgWriter::new(right + 12.0, bottom + ROOM_BELOW + room, &title.concat());
        frame.draw_title(&mut svg, title.each_ref().map(String::as_str));
        frame.draw(&mut svg, ["x [m]", "y [m]"]);
        self.draw(&mut svg, &frame, true);
        more(&mut svg, &frame);
        frame.draw_border(&mut svg);
        svg.finish()
    }

    /// The name, with what stands before and after it.
    pub(super) fn title(&self) -> [String; 3] {
        let ImportedLayout { layout, vehicle } = self.imported;
        let name = if layout.name.is_empty() { "Layout" } else { &layout.name };
        let level = match layout.levels.get(self.level).filter(|_| layout.levels.len() > 1) {
            Some(level) => format!(", {level}"),
            None => String::new(),
        };
        let of = match &vehicle.footprint {
            Some(footprint) => format!("a footprint of {} corners", footprint.polygon().len()),
            None => format!("a disc of {} m", self.radius_with_margin()),
        };
        [String::new(), format!("{name}{level}"), format!(": corridors of {of}")]
    }
}
