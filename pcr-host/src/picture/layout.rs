//! A layout as a picture: the corridors of a disc on the edges of a level.
//!
//! The corridor that a disc sweeps on an edge is the stroke of the edge with round ends, as wide as the disc: SVG draws it exactly.

use super::axis::{AXIS_SIZE, Frame, ROOM_BELOW, at_least_visible, room_at_left};
use super::map::ROOM_ABOVE;
use super::svg::{PathData, Pixels, Svg};
use crate::import::{Edge, Layout, Node, Placed};
use crate::scenario::PathSegment;
use pcr_core::Interval;
use std::f64::consts::PI;
use std::fmt::Display;

/// Largest width and height of the plot \[px\].
const SIDE: f64 = 720.0;

/// Smallest ones \[px\].
const LEAST: f64 = 160.0;

/// Nodes up to which their names are written.
const NAMED: usize = 60;

/// A level of a layout that discs of a radius travel.
#[derive(Clone, Copy, Debug)]
pub struct Ground<'a> {
    /// The layout.
    pub layout: &'a Layout,
    /// Place of the level in [`Layout::levels`].
    pub level: usize,
    /// Of the discs, without the deviation of edges \[m\].
    pub radius: f64,
}

/// Lines and true arcs of an edge, by a map from metres to the picture; `flipped` where its y-axis points down.
pub(super) fn path(edge: &Edge, scale: f64, flipped: bool, at: impl Fn([f64; 2]) -> [f64; 2]) -> PathData {
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
pub(super) fn bounds(layout: &Layout, level: Option<usize>, radius: f64) -> [Interval<f64>; 2] {
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

impl Ground<'_> {
    /// Box around what is on the level \[m\].
    pub(super) fn bounds(&self) -> [Interval<f64>; 2] {
        bounds(self.layout, Some(self.level), self.radius)
    }

    /// The corridors, the edges and the nodes, these with their names if they are few.
    pub(super) fn draw(&self, svg: &mut Svg, frame: &Frame, names: bool) {
        let metre = 1.0 / frame.x.units_per_pixel();
        let edges: Vec<&Edge> = self.layout.edges.iter().filter(|edge| self.layout.level(edge) == self.level).collect();
        let round: [(&str, &dyn Display); 3] =
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
        strokes(svg, "#2078bf", "0.1", &|edge| 2.0 * (self.radius + edge.deviation) * metre);
        strokes(svg, "#1d2125", "1", &|_| 1.1);
        let nodes: Vec<&Node> = self.layout.nodes.iter().filter(|node| node.level == self.level).collect();
        let radius = Pixels(if names { 2.0 } else { 1.2 });
        svg.start("g", &[("fill", &"#a94022"), ("font-size", &Pixels(9.0))]);
        for node in &nodes {
            let [x, y] = frame.at(node.at);
            svg.empty("circle", &[("cx", &Pixels(x)), ("cy", &Pixels(y)), ("r", &radius)]);
            if names && nodes.len() <= NAMED {
                svg.label([x + 3.5, y - 3.5], "start", &[], &node.id.to_string());
            }
        }
        svg.end();
    }

    /// The level as a picture of its own.
    pub(super) fn picture(&self) -> String {
        let [x, y] = self.bounds();
        let metre = SIDE / x.length().max(y.length());
        let fit = |values: Interval<f64>| {
            let pixels = (values.length() * metre).max(LEAST);
            let half = pixels / metre / 2.0;
            (pixels, Interval::new(values.middle() - half, values.middle() + half))
        };
        let ((width, x), (height, y)) = (fit(x), fit(y));
        let left = room_at_left(y, height);
        let frame = Frame::new(x, y, [left, ROOM_ABOVE, left + width, ROOM_ABOVE + height]);
        let title = self.title();
        let [_, _, right, bottom] = frame.edges;
        let mut svg = Svg::new(right + 12.0, bottom + ROOM_BELOW, &title);
        let size = Pixels(AXIS_SIZE + 0.5);
        svg.label([(left + right) / 2.0, ROOM_ABOVE - 9.0], "middle", &[("font-size", &size)], &title);
        frame.draw(&mut svg, ["x [m]", "y [m]"]);
        self.draw(&mut svg, &frame, true);
        frame.draw_border(&mut svg);
        svg.finish()
    }

    fn title(&self) -> String {
        let layout = self.layout;
        let name = if layout.name.is_empty() { "Layout" } else { &layout.name };
        let level = match layout.levels.get(self.level).filter(|_| layout.levels.len() > 1) {
            Some(level) => format!(", {level}"),
            None => String::new(),
        };
        format!("{name}{level}: corridors of a disc of {} m", self.radius)
    }
}
