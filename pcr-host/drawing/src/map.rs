//! The extended collision map of an agent (paper Fig. 11): its regions in time and travelled length, and its
//! trajectory between them.

mod legend;
mod region_labels;

use super::axis::{PlotArea, ROOM_ABOVE, ROOM_BELOW, room_at_left};
use super::contour::is_thin;
use super::region_scene::{DrawnRegion, RegionScene};
use super::svg::{PathData, PixelCoordinate, SvgWriter};
pub(super) use legend::Legend;
use pcr_core::Interval;
pub(super) use region_labels::RegionLabels;

/// Part of the time span that is shown before the first start and after the last arrival, for strips.
const MARGIN: f64 = 0.045;

/// Outlines thinner than this would be lost \[px\].
pub(super) const THIN: f64 = 1.0;

/// Size of the labels of regions \[px\].
pub(super) const LABEL_SIZE: f64 = 9.5;

/// Distance of the lines of a hatching \[px\].
const HATCHING: f64 = 5.0;

/// What the map of an agent shows: times \[s\] and lengths \[m\].
pub(super) fn spans(scene: &RegionScene<'_>, ego: usize) -> [Interval<f64>; 2] {
    let widen = |values: Interval<f64>, part: f64| {
        // Of what has no extent something is to be seen all the same: a second, or a metre.
        let by = if values.length() > 0.0 { part * values.length() } else { 0.5 };
        Interval::new(values.lo - by, values.hi + by)
    };
    let length = scene.motions.get(ego).map_or(0.0, |motion| motion.path().length());
    [widen(scene.horizon(), MARGIN), widen(Interval::new(0.0, length), 0.02)]
}

/// The map as a picture of its own.
pub(super) fn picture(scene: &RegionScene<'_>, ego: usize) -> String {
    // A crowded map gets more room.
    let side = (300.0 + 8.0 * scene.count(ego) as f64).clamp(400.0, 800.0);
    let [time, length] = spans(scene, ego);
    let left = room_at_left(length, 0.8 * side);
    let edges = [left, ROOM_ABOVE, left + side, ROOM_ABOVE + 0.8 * side];
    let frame = PlotArea::new(time, length, edges);
    let shapes = scene.shapes(ego, [frame.x.units_per_pixel(), frame.y.units_per_pixel()]);
    let names = RegionLabels::new(scene, ego, &shapes, &frame, LABEL_SIZE);
    let legend = Legend::new(scene, ego, &shapes, names.left_out(), [8.0, edges[2]]);
    let (width, height) = (edges[2] + 12.0, edges[3] + ROOM_BELOW + legend.height() + 6.0);
    let mut svg = SvgWriter::new(width, height, &title(scene, ego, &shapes).concat());
    draw(&mut svg, scene, ego, &shapes, &names, &frame);
    legend.draw(&mut svg, edges[3] + ROOM_BELOW);
    svg.finish()
}

/// The name of the agent, with what stands before and after it.
fn title(scene: &RegionScene<'_>, ego: usize, shapes: &[DrawnRegion]) -> [String; 3] {
    let regions = match shapes.len() {
        1 => ": 1 region".to_owned(),
        count => format!(": {count} regions"),
    };
    ["Extended collision map of agent ".to_owned(), scene.display_name(ego), regions]
}

/// The map in a frame.
pub(super) fn draw(
    svg: &mut SvgWriter,
    scene: &RegionScene<'_>,
    ego: usize,
    shapes: &[DrawnRegion],
    names: &RegionLabels,
    frame: &PlotArea,
) {
    frame.draw_title(svg, title(scene, ego, shapes).each_ref().map(String::as_str));
    frame.draw(svg, ["time t [s]", "travelled length l [m]"]);
    hatchings(svg, scene, shapes.iter().filter(|shape| !shape.before.is_empty() || !shape.after.is_empty()));
    for shape in shapes {
        draw_strips(svg, scene, shape, frame);
    }
    for shape in shapes {
        draw_region(svg, scene, shape, frame);
    }
    draw_trajectory(svg, scene, ego, frame);
    let entries = scene.entries(ego, shapes).into_iter().map(|point| frame.at(point));
    entries.for_each(|place| entry_mark(svg, place));
    frame.draw_border(svg);
    names.draw(svg, scene, shapes);
}

/// One hatching for each colour in use.
fn hatchings<'s>(svg: &mut SvgWriter, scene: &RegionScene<'_>, shapes: impl Iterator<Item = &'s DrawnRegion>) {
    let mut others: Vec<usize> = shapes.map(|shape| shape.other).collect();
    others.sort_unstable();
    others.dedup();
    if others.is_empty() {
        return;
    }
    svg.start("defs", &[]);
    for other in others {
        let colour = scene.colour(other);
        let side = PixelCoordinate(HATCHING);
        svg.start(
            "pattern",
            &[
                ("id", &format_args!("stands-{other}")),
                ("width", &side),
                ("height", &side),
                ("patternUnits", &"userSpaceOnUse"),
                ("patternTransform", &"rotate(45)"),
            ],
        );
        svg.empty("rect", &[("width", &side), ("height", &side), ("fill", &colour), ("fill-opacity", &"0.1")]);
        svg.empty("rect", &[("width", &"1"), ("height", &side), ("fill", &colour), ("fill-opacity", &"0.55")]);
        svg.end();
    }
    svg.end();
}

/// What is taken for ever by another agent that stands at its start or end.
fn draw_strips(svg: &mut SvgWriter, scene: &RegionScene<'_>, shape: &DrawnRegion, frame: &PlotArea) {
    let Some(motion) = scene.motions.get(shape.other) else {
        return;
    };
    let [left, _, right, _] = frame.edges;
    let travel = motion.time();
    let colour = scene.colour(shape.other);
    for (strip, from, to) in
        [(&shape.before, left, frame.x.at(travel.lo)), (&shape.after, frame.x.at(travel.hi), right)]
    {
        for slice in strip {
            let (bottom, top) = (frame.y.at(slice.lo), frame.y.at(slice.hi));
            let (middle, height) = ((bottom + top) / 2.0, f64::max(bottom - top, THIN));
            svg.empty(
                "rect",
                &[
                    ("x", &PixelCoordinate(from)),
                    ("y", &PixelCoordinate(middle - height / 2.0)),
                    ("width", &PixelCoordinate((to - from).max(0.0))),
                    ("height", &PixelCoordinate(height)),
                    ("fill", &format_args!("url(#stands-{})", shape.other)),
                    ("stroke", &colour),
                    ("stroke-width", &"0.5"),
                    ("stroke-opacity", &"0.7"),
                ],
            );
        }
    }
}

fn draw_region(svg: &mut SvgWriter, scene: &RegionScene<'_>, shape: &DrawnRegion, frame: &PlotArea) {
    let colour = scene.colour(shape.other);
    let (mut areas, mut lines) = (PathData::default(), PathData::default());
    for contour in &shape.outline {
        let points: Vec<[f64; 2]> = contour.iter().map(|point| frame.at(*point)).collect();
        let thin = is_thin(&points, THIN);
        if thin { &mut lines } else { &mut areas }.polygon(points);
    }
    svg.start("g", &[("fill", &colour), ("stroke", &colour), ("stroke-linejoin", &"round")]);
    if !areas.is_empty() {
        svg.empty("path", &[("d", &areas), ("fill-opacity", &"0.3"), ("stroke-width", &"0.9")]);
    }
    if !lines.is_empty() {
        svg.empty("path", &[("d", &lines), ("stroke-width", &"3.6"), ("stroke-linecap", &"round")]);
    }
    svg.end();
}

/// Where the ego's motion enters a region \[px\].
fn entry_mark(svg: &mut SvgWriter, [x, y]: [f64; 2]) {
    svg.empty(
        "circle",
        &[
            ("cx", &PixelCoordinate(x)),
            ("cy", &PixelCoordinate(y)),
            ("r", &"3"),
            ("fill", &"#fff"),
            ("stroke", &"#c01722"),
            ("stroke-width", &"1.6"),
        ],
    );
}

/// The ego's own motion: parabolas, and lines where it stands.
fn draw_trajectory(svg: &mut SvgWriter, scene: &RegionScene<'_>, ego: usize, frame: &PlotArea) {
    let Some(motion) = scene.motions.get(ego) else {
        return;
    };
    let [left, _, right, _] = frame.edges;
    let travel = motion.time();
    let (start, end) = (frame.at([travel.lo, 0.0]), frame.at([travel.hi, motion.path().length()]));
    let mut moving = PathData::default();
    moving.move_to(start);
    for phase in motion.profile().phases() {
        let (time, length) = (phase.time(), phase.length());
        let half = time.length() / 2.0;
        // Constant acceleration is a parabola; its tangents meet at half time.
        let control = [travel.lo + time.lo + half, length.lo + phase.speed_at(time.lo) * half];
        moving.parabola_to(frame.at(control), frame.at([travel.lo + time.hi, length.hi]));
    }
    let mut standing = PathData::default();
    standing.move_to([left, start[1]]);
    standing.line_to(start);
    standing.move_to(end);
    standing.line_to([right, end[1]]);
    svg.start("g", &[("fill", &"none"), ("stroke", &"#111"), ("stroke-width", &"1.7")]);
    svg.empty("path", &[("d", &moving)]);
    svg.empty("path", &[("d", &standing), ("stroke-dasharray", &"4 3")]);
    svg.end();
}
