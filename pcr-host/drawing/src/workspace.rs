//! The workspace (paper Fig. 10): all paths with the discs at their starts and ends, in metres.

use super::axis::{AXIS_SIZE, Frame, ROOM_ABOVE, ROOM_BELOW, at_least_visible, room_at_left};
use super::labels::{Labels, SPACING};
use super::scene::Scene;
use super::svg::{PathData, Pixels, Svg, text_width};
use pcr_core::{Bounds, Curve, Interval, Motion, Pose, Segment, Turn};
use std::f64::consts::PI;

/// Size of the numbers of agents \[px\].
const LABEL_SIZE: f64 = 9.5;

/// Distance of the arrows on a path \[px\].
const ARROWS: f64 = 110.0;

/// Smallest width and height of the plot \[px\].
const LEAST: [f64; 2] = [240.0, 110.0];

/// Points of a path at most that labels keep off.
const MOST_OBSTACLES: f64 = 2000.0;

/// Weight of covering a path.
const CROSSED: f64 = 2.0;

/// The frame of a workspace that is at most `side` pixels wide and high, at this left top corner; equal scales.
pub(super) fn frame(scene: &Scene<'_>, side: f64, [left, top]: [f64; 2]) -> Frame {
    let Bounds { x, y } = scene.bounds();
    let [x, y] = [x, y].map(|values| {
        let margin = 0.03 * x.length().max(y.length());
        at_least_visible(Interval::new(values.lo - margin, values.hi + margin))
    });
    let metre = side / x.length().max(y.length());
    let fit = |values: Interval<f64>, least: f64| {
        let pixels = (values.length() * metre).max(least);
        let half = pixels / metre / 2.0;
        (pixels, Interval::new(values.middle() - half, values.middle() + half))
    };
    let ((width, x), (height, y)) = (fit(x, LEAST[0]), fit(y, LEAST[1]));
    let left = left + room_at_left(y, height);
    Frame::new(x, y, [left, top + ROOM_ABOVE, left + width, top + ROOM_ABOVE + height])
}

/// The workspace as a picture of its own.
pub(super) fn picture(scene: &Scene<'_>) -> String {
    let side = (340.0 + 5.0 * scene.motions.len() as f64).clamp(400.0, 800.0);
    let frame = frame(scene, side, [0.0, 0.0]);
    let [_, _, right, bottom] = frame.edges;
    let mut svg = Svg::new(right + 12.0, bottom + ROOM_BELOW, &title(scene));
    draw(&mut svg, scene, &frame);
    svg.finish()
}

fn title(scene: &Scene<'_>) -> String {
    let agents = match scene.motions.len() {
        1 => "1 agent".to_owned(),
        count => format!("{count} agents"),
    };
    match scene.scenario.name.as_str() {
        "" => format!("Workspace of {agents}"),
        name => format!("{name}: workspace of {agents}"),
    }
}

/// The workspace in a frame.
pub(super) fn draw(svg: &mut Svg, scene: &Scene<'_>, frame: &Frame) {
    let [left, top, right, _] = frame.edges;
    let size = Pixels(AXIS_SIZE + 0.5);
    svg.label([(left + right) / 2.0, top - 9.0], "middle", &[("font-size", &size)], &title(scene));
    frame.draw(svg, ["x [m]", "y [m]"]);
    if let Some(ground) = &scene.ground {
        ground.draw(svg, frame, false);
    }
    for (place, motion) in scene.motions.iter().enumerate() {
        let colour = scene.colour(place);
        svg.start("g", &[("fill", &"none"), ("stroke", &colour), ("stroke-width", &"1.2")]);
        svg.empty("path", &[("d", &path(motion, frame)), ("stroke-linejoin", &"round")]);
        let arrows = arrows(motion, frame);
        if !arrows.is_empty() {
            svg.empty("path", &[("d", &arrows), ("fill", &colour), ("stroke", &"none")]);
        }
        let length = motion.path().length();
        if length > 0.0 {
            let dashed: Style<'_> = &[("stroke-dasharray", &"2.5 2"), ("stroke-width", &"0.9")];
            body(svg, scene, place, motion.path().pose_at(length), frame, dashed);
        }
        body(svg, scene, place, motion.path().pose_at(0.0), frame, &[("fill", &colour), ("fill-opacity", &"0.35")]);
        svg.end();
    }
    draw_numbers(svg, scene, frame);
    frame.draw_border(svg);
}

/// Attributes.
type Style<'a> = &'a [(&'a str, &'a dyn std::fmt::Display)];

/// The disc or the outline of an agent in a pose.
fn body(svg: &mut Svg, scene: &Scene<'_>, place: usize, pose: Pose<f64>, frame: &Frame, style: Style<'_>) {
    let at = |ahead: f64, left: f64| {
        let (sin, cos) = pose.heading.0.sin_cos();
        frame.at([pose.position.x + ahead * cos - left * sin, pose.position.y + ahead * sin + left * cos])
    };
    if let Some(footprint) = scene.footprint(place) {
        let mut data = PathData::default();
        data.polygon(footprint.polygon().iter().map(|[ahead, left]| at(*ahead, *left)));
        svg.empty("path", &[&[("d", &data as &dyn std::fmt::Display)], style].concat());
    } else if let Some(motion) = scene.motions.get(place) {
        let [x, y] = at(0.0, 0.0);
        let (x, y, radius) = (Pixels(x), Pixels(y), Pixels(radius(motion, frame)));
        let circle: Style<'_> = &[("cx", &x), ("cy", &y), ("r", &radius)];
        svg.empty("circle", &[circle, style].concat());
    }
}

/// Radius of a disc \[px\]; one that would not be seen is shown as a dot.
fn radius(motion: &Motion<'_, f64>, frame: &Frame) -> f64 {
    (motion.radius() / frame.x.units_per_pixel()).max(1.2)
}

/// A path by lines and true arcs.
fn path(motion: &Motion<'_, f64>, frame: &Frame) -> PathData {
    let at = |segment: &Segment<f64>, u: f64| {
        let point = segment.point_at(u);
        frame.at([point.x, point.y])
    };
    let mut data = PathData::default();
    for (k, segment) in motion.path().segments().iter().enumerate() {
        if k == 0 {
            data.move_to(at(segment, 0.0));
        }
        match segment.curve() {
            Curve::Line => data.line_to(at(segment, segment.length())),
            Curve::Arc { radius, turn } => {
                // Below half a turn two points and a radius leave no doubt which arc is meant.
                let parts = (segment.length() / radius / (0.75 * PI)).ceil().max(1.0) as usize;
                for part in 1..=parts {
                    let end = at(segment, segment.length() * part as f64 / parts as f64);
                    data.arc_to(radius / frame.x.units_per_pixel(), turn == Turn::Right, end);
                }
            }
        }
    }
    data
}

/// Arrow heads in the direction of travel.
fn arrows(motion: &Motion<'_, f64>, frame: &Frame) -> PathData {
    let length = motion.path().length();
    let mut data = PathData::default();
    let pixels = length / frame.x.units_per_pixel();
    if pixels < 2.0 * radius(motion, frame) + 8.0 {
        return data;
    }
    let count = (pixels / ARROWS).round().clamp(1.0, 12.0) as usize;
    for k in 0..count {
        let pose = motion.path().pose_at(length * (k as f64 + 0.5) / count as f64);
        let [x, y] = frame.at([pose.position.x, pose.position.y]);
        let (sin, cos) = pose.heading.0.sin_cos();
        let point = |along: f64, across: f64| [x + along * cos - across * sin, y - along * sin - across * cos];
        data.polygon([point(4.2, 0.0), point(-3.0, 2.7), point(-1.8, 0.0), point(-3.0, -2.7)]);
    }
    data
}

/// The number of each agent in its disc at the start, or beside it.
fn draw_numbers(svg: &mut Svg, scene: &Scene<'_>, frame: &Frame) {
    let mut labels = Labels::default();
    let start = |motion: &Motion<'_, f64>| {
        let point = motion.path().point_at(0.0);
        frame.at([point.x, point.y])
    };
    for (place, motion) in scene.motions.iter().enumerate() {
        let ([x, y], r) = (start(motion), radius(motion, frame));
        if !fits(&scene.called(place), motion, frame) {
            labels.block([x - r, y - r, x + r, y + r]);
        }
        let length = motion.path().length();
        let count = (length / frame.x.units_per_pixel() / SPACING).clamp(1.0, MOST_OBSTACLES) as usize;
        labels.avoid(
            CROSSED,
            (0..=count).map(|k| {
                let point = motion.path().point_at(length * k as f64 / count as f64);
                frame.at([point.x, point.y])
            }),
        );
    }
    svg.start(
        "g",
        &[("font-size", &Pixels(LABEL_SIZE)), ("stroke", &"#fff"), ("stroke-width", &"2"), ("paint-order", &"stroke")],
    );
    for place in 0..scene.motions.len() {
        let text = scene.called(place);
        // Where a label finds no room, the number has to do.
        for text in [text, scene.id(place).to_string()] {
            if draw_number(svg, scene, frame, &mut labels, place, &text) {
                break;
            }
        }
    }
    svg.end();
}

/// Whether a text fits into the disc.
fn fits(text: &str, motion: &Motion<'_, f64>, frame: &Frame) -> bool {
    text_width(text, LABEL_SIZE) / 2.0 <= radius(motion, frame)
}

/// Draws the text of an agent, if there is room for it.
fn draw_number(svg: &mut Svg, scene: &Scene<'_>, frame: &Frame, labels: &mut Labels, place: usize, text: &str) -> bool {
    let Some(motion) = scene.motions.get(place) else { return true };
    let point = motion.path().point_at(0.0);
    let [x, y] = frame.at([point.x, point.y]);
    let size = [text_width(text, LABEL_SIZE) + 1.0, LABEL_SIZE - 1.0];
    // Behind the start, where the path does not pass.
    let behind = (radius(motion, frame) - text_width(text, LABEL_SIZE).hypot(LABEL_SIZE) / 2.0).max(0.0);
    let (sin, cos) = motion.path().pose_at(0.0).heading.0.sin_cos();
    let inside = fits(text, motion, frame).then_some([x - behind * cos, y + behind * sin]);
    let around = (0..3).flat_map(|ring| {
        (0..16).map(move |k| {
            let (sin, cos) = (f64::from(k) * PI / 8.0).sin_cos();
            let gap = radius(motion, frame) + 2.0 + 6.0 * f64::from(ring);
            [x + (gap + size[0] / 2.0) * cos, y - (gap + size[1] / 2.0) * sin]
        })
    });
    let Some([x, y]) = labels.place(size, inside.into_iter().chain(around).map(|place| (0.0, place)), frame.edges)
    else {
        return false;
    };
    let ink = scene.colour(place).ink();
    svg.label([x, y + 0.36 * LABEL_SIZE], "middle", &[("fill", &ink), ("stroke-linejoin", &"round")], text);
    true
}
