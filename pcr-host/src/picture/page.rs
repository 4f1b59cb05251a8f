//! The page to explore a scenario: one HTML file with everything in it, no request to anywhere.
//!
//! It holds the paths and profiles as numbers, and evaluates the closed forms of the library itself, so that the discs
//! are exactly where they are at every time of the slider. Outlines of regions are traced here and drawn there.

use super::contour::Outline;
use super::map::spans;
use super::scene::{Scene, Shape};
use super::svg::Escaped;
use pcr_core::{Bounds, Crossing, Curve, Interval, Motion, Turn};
use serde_json::{Value, json};
use std::fmt::Write as _;

const TEMPLATE: &str = include_str!("page/page.html");
const STYLE: &str = include_str!("page/page.css");
const SCRIPT: &str = include_str!("page/page.js");

/// Steps of the coordinates of outlines along each axis of a map: a twentieth of a pixel on a large screen.
const GRID: f64 = 20_000.0;

/// Pixels along each axis of a map for which outlines are traced.
const PIXELS: f64 = 800.0;

/// The page.
pub(super) fn page(scene: &Scene<'_>) -> String {
    let data = data(scene).to_string();
    let name = if scene.scenario.name.is_empty() { "Collision regions" } else { &scene.scenario.name };
    let mut page = String::with_capacity(TEMPLATE.len() + STYLE.len() + SCRIPT.len() + data.len());
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

fn data(scene: &Scene<'_>) -> Value {
    let Bounds { x, y } = scene.bounds();
    let agents = scene.motions.iter().enumerate().map(|(place, motion)| agent(scene, place, motion));
    let maps = (0..scene.motions.len()).map(|ego| map(scene, ego));
    json!({
        "name": scene.scenario.name,
        "grid": GRID,
        "horizon": interval(scene.horizon()),
        "bounds": [x.lo, x.hi, y.lo, y.hi],
        "agents": agents.collect::<Vec<_>>(),
        "maps": maps.collect::<Vec<_>>(),
    })
}

fn interval(interval: Interval<f64>) -> Value {
    json!([interval.lo, interval.hi])
}

/// The closed forms of a motion: segments as \[from, length, x, y, heading, bend\] with the radius of an arc as bend,
/// positive to the left, 0 on a line; phases as \[time, duration, length, speed before, speed after, acceleration\].
fn agent(scene: &Scene<'_>, place: usize, motion: &Motion<'_, f64>) -> Value {
    let segments = motion.path().segments().iter().map(|segment| {
        let start = segment.point_at(0.0);
        let bend = match segment.curve() {
            Curve::Line => 0.0,
            Curve::Arc { radius, turn: Turn::Left } => radius,
            Curve::Arc { radius, turn: Turn::Right } => -radius,
        };
        json!([segment.from(), segment.length(), start.x, start.y, segment.heading_at(0.0).0, bend])
    });
    let phases = motion.profile().phases().iter().map(|phase| {
        let (time, length) = (phase.time(), phase.length());
        let speeds = [time.lo, time.hi].map(|time| phase.speed_at(time));
        let acceleration = if time.length() > 0.0 { (speeds[1] - speeds[0]) / time.length() } else { 0.0 };
        json!([time.lo, time.length(), length.lo, speeds[0], speeds[1], acceleration])
    });
    json!({
        // Beyond 2⁵³ a number would lose its last digits in the browser.
        "id": scene.id(place).to_string(),
        "radius": motion.radius(),
        "colour": scene.colour(place).to_string(),
        "time": interval(motion.time()),
        "length": motion.path().length(),
        "segments": segments.collect::<Vec<_>>(),
        "phases": phases.collect::<Vec<_>>(),
    })
}

fn map(scene: &Scene<'_>, ego: usize) -> Value {
    let spans = spans(scene, ego);
    let shapes = scene.shapes(ego, spans.map(|span| span.length() / PIXELS));
    json!({
        "time": interval(spans[0]),
        "length": interval(spans[1]),
        "regions": shapes.iter().map(|shape| region(shape, spans)).collect::<Vec<_>>(),
    })
}

fn region(shape: &Shape, spans: [Interval<f64>; 2]) -> Value {
    let strips = |strips: &[Interval<f64>]| strips.iter().copied().map(interval).collect::<Vec<_>>();
    let largest = shape.slices.iter().max_by(|a, b| a.1.length().total_cmp(&b.1.length()));
    json!({
        "other": shape.other,
        "time": interval(shape.time),
        "length": interval(shape.length),
        "outline": path(&shape.outline, spans),
        "before": strips(&shape.before),
        "after": strips(&shape.after),
        "label": largest.map(|(time, slice)| [*time, slice.middle()]),
        "types": shape.types.iter().map(ToString::to_string).collect::<Vec<_>>(),
        "pieces": shape.pieces,
        "crossings": shape.crossings.iter().map(crossing).collect::<Vec<_>>(),
    })
}

/// The descriptor of the paper's Tables III and IV; radii are null on lines, positive to the left.
fn crossing(crossing: &Crossing<f64>) -> Value {
    let bend = |curve: Curve<f64>| match curve {
        Curve::Line => None,
        Curve::Arc { radius, turn: Turn::Left } => Some(radius),
        Curve::Arc { radius, turn: Turn::Right } => Some(-radius),
    };
    json!({
        "type": crossing.piece_type.to_string(),
        "T": crossing.time,
        "L": crossing.length,
        "r": crossing.combined_radius,
        "v": crossing.speed,
        "theta": crossing.theta.0,
        "own": bend(crossing.ego_curve),
        "other": bend(crossing.other_curve),
    })
}

/// SVG path data of an outline on the grid: steps from point to point, which are short numbers.
fn path(outline: &Outline, spans: [Interval<f64>; 2]) -> String {
    let on_grid = |value: f64, span: Interval<f64>| ((value - span.lo) / span.length() * GRID).round() as i64;
    let mut data = String::new();
    for contour in outline {
        let mut before: Option<[i64; 2]> = None;
        for point in contour {
            let at = [on_grid(point[0], spans[0]), on_grid(point[1], spans[1])];
            // Writing to a string does not fail.
            let _ = match before {
                None => write!(data, "M{} {}l", at[0], at[1]),
                Some(before) => write!(data, "{} {} ", at[0] - before[0], at[1] - before[1]),
            };
            before = Some(at);
        }
        // A point is a line of no length, which round caps make a dot.
        data.push_str("0 0z");
    }
    data
}
