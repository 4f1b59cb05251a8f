//! The collision map of an agent over the sampled collision map (paper Fig. 13).

use super::axis::{PlotArea, ROOM_ABOVE, ROOM_BELOW, room_at_left};
use super::map::spans;
use super::region_scene::RegionScene;
use super::svg::{PathData, PixelCoordinate, SvgWriter};
use pcr_core::Interval;

/// A part of the ego's path that is blocked for a step around a time.
#[derive(Clone, Copy, Debug)]
pub struct BlockedBar {
    /// Place of the other agent.
    pub other: usize,
    /// \[s\]
    pub time: f64,
    /// \[m\]
    pub part: [f64; 2],
}

/// Size of the plot \[px\].
const SIZE: [f64; 2] = [560.0, 400.0];

/// Part of a bar's width that is drawn, and least width \[px\].
const WIDTH: [f64; 2] = [0.8, 0.2];

/// What is drawn: bars of a width \[s\] under the outlines, of the whole map or of a part of it (times and lengths).
#[derive(Clone, Copy, Debug)]
pub struct Overlay<'a> {
    /// The bars.
    pub bars: &'a [BlockedBar],
    /// Width of a bar \[s\].
    pub step: f64,
    /// The part of the map that is drawn: times and lengths; all of it if there is none.
    pub part: Option<[Interval<f64>; 2]>,
    /// What is written above it.
    pub title: &'a str,
}

/// Outlines over bars.
pub(super) fn picture(scene: &RegionScene<'_>, ego: usize, overlay: &Overlay<'_>) -> String {
    let Overlay { bars, step, part, title } = *overlay;
    let [time, length] = part.unwrap_or_else(|| spans(scene, ego));
    let left = room_at_left(length, SIZE[1]);
    let edges = [left, ROOM_ABOVE, left + SIZE[0], ROOM_ABOVE + SIZE[1]];
    let frame = PlotArea::new(time, length, edges);
    let mut svg = SvgWriter::new(edges[2] + 12.0, edges[3] + ROOM_BELOW, title);
    frame.draw_title(&mut svg, ["", title, ""]);
    frame.draw(&mut svg, ["time t [s]", "travelled length l [m]"]);
    clip(&mut svg, edges);
    let width = PixelCoordinate((WIDTH[0] * step / frame.x.units_per_pixel()).max(WIDTH[1]));
    for other in 0..scene.motions.len() {
        let mut path = PathData::default();
        let within = |bar: &&BlockedBar| bar.other == other && frame.x.values().contains(bar.time);
        for bar in bars.iter().filter(within) {
            path.move_to(frame.at([bar.time, bar.part[0]]));
            path.line_to(frame.at([bar.time, bar.part[1]]));
        }
        if !path.is_empty() {
            let colour = scene.colour(other);
            svg.empty(
                "path",
                &[("d", &path), ("stroke", &colour), ("stroke-width", &width), ("stroke-opacity", &"0.55")],
            );
        }
    }
    let mut outlines = PathData::default();
    for shape in scene.shapes(ego, [frame.x.units_per_pixel(), frame.y.units_per_pixel()]) {
        for contour in &shape.outline {
            outlines.polygon(contour.iter().map(|point| frame.at(*point)));
        }
    }
    svg.empty("path", &[("d", &outlines), ("fill", &"none"), ("stroke", &"#111"), ("stroke-width", &"0.8")]);
    svg.end();
    frame.draw_border(&mut svg);
    svg.finish()
}

/// Opens a group of which only what is within these edges is seen.
fn clip(svg: &mut SvgWriter, [left, top, right, bottom]: [f64; 4]) {
    let (x, y, width, height) =
        (PixelCoordinate(left), PixelCoordinate(top), PixelCoordinate(right - left), PixelCoordinate(bottom - top));
    svg.start("clipPath", &[("id", &"plot")]);
    svg.empty("rect", &[("x", &x), ("y", &y), ("width", &width), ("height", &height)]);
    svg.end();
    svg.start("g", &[("clip-path", &"url(#plot)")]);
}
