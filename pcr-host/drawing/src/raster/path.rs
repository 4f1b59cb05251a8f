//! Outlines of elements: path data and shapes as the writer of SVG writes them. What it does not write is `None`.

use super::style::{number, numbers, size};
use roxmltree::Node;
use std::f64::consts::{FRAC_PI_2, TAU};
use tiny_skia::{PathBuilder, Rect};

/// Distance of a cubic from the arc that it stands for \[px\].
const STRAY: f64 = 0.002;

/// The same for a radius of 1 and an angle of 1 rad; it grows with the sixth power of the angle.
const UNIT_STRAY: f64 = 1.81e-5;

/// Adds the outline of a shape in a picture of this width and height \[px\].
pub(super) fn shape(node: Node<'_, '_>, [width, height]: [f32; 2], to: &mut PathBuilder) -> Option<()> {
    // What has no such attribute is at 0.
    let text = |name| node.attribute(name).unwrap_or("0");
    let at = |name| number(text(name));
    match node.tag_name().name() {
        "circle" => circle(to, [at("cx")?, at("cy")?], size(text("r"))?),
        "line" => {
            to.move_to(at("x1")?, at("y1")?);
            to.line_to(at("x2")?, at("y2")?);
        }
        "path" => data(node.attribute("d")?, to)?,
        "polygon" => polygon(node.attribute("points")?, to)?,
        "rect" => {
            let side = |name, whole: f32| match text(name).strip_suffix('%') {
                Some(part) => Some(whole * size(part)? / 100.0),
                None => size(text(name)),
            };
            let [width, height] = [side("width", width)?, side("height", height)?];
            // One without extent is not drawn, not even its border.
            if width > 0.0 && height > 0.0 {
                to.push_rect(Rect::from_xywh(at("x")?, at("y")?, width, height)?);
            }
        }
        _ => return None,
    }
    Some(())
}

/// Path data: absolute commands, a letter for each, and a subpath begins with `M`.
fn data(text: &str, to: &mut PathBuilder) -> Option<()> {
    let mut at = None;
    let mut rest = text;
    while !rest.is_empty() {
        let (letter, behind) = rest.split_at_checked(1)?;
        let (values, next) = behind.split_at(behind.find(|c: char| c.is_ascii_alphabetic()).unwrap_or(behind.len()));
        at = match letter {
            "M" => {
                let [x, y] = numbers(values)?;
                to.move_to(x, y);
                Some([x, y])
            }
            "L" => {
                let [x, y] = at.and(numbers(values))?;
                to.line_to(x, y);
                Some([x, y])
            }
            "Q" => {
                let [cx, cy, x, y] = at.and(numbers(values))?;
                to.quad_to(cx, cy, x, y);
                Some([x, y])
            }
            "A" => {
                let [rx, ry, turned, long, clockwise, x, y] = numbers(values)?;
                // Circles, and at most half of one; the last flag is 0 or 1.
                if rx != ry || turned != 0.0 || long != 0.0 || clockwise * (clockwise - 1.0) != 0.0 {
                    return None;
                }
                arc(to, at?, rx, clockwise > 0.0, [x, y]);
                Some([x, y])
            }
            "Z" => {
                let [] = at.and(numbers(values))?;
                to.close();
                None
            }
            _ => return None,
        };
        rest = next;
    }
    Some(())
}

fn polygon(points: &str, to: &mut PathBuilder) -> Option<()> {
    for (k, point) in points.split_ascii_whitespace().enumerate() {
        let (x, y) = point.split_once(',')?;
        let (x, y) = (number(x)?, number(y)?);
        if k == 0 { to.move_to(x, y) } else { to.line_to(x, y) }
    }
    to.close();
    Some(())
}

fn circle(to: &mut PathBuilder, [x, y]: [f32; 2], radius: f32) {
    if radius > 0.0 {
        to.move_to(x + radius, y);
        around(to, [x, y].map(f64::from), [f64::from(radius), 0.0], TAU);
        to.close();
    }
}

/// An arc of at most half a turn.
fn arc(to: &mut PathBuilder, from: [f32; 2], radius: f32, clockwise: bool, end: [f32; 2]) {
    let ([x, y], end) = (from.map(f64::from), end.map(f64::from));
    let chord = [end[0] - x, end[1] - y];
    let half = chord[0].hypot(chord[1]) / 2.0;
    if radius <= 0.0 || half <= 0.0 {
        to.line_to(end[0] as f32, end[1] as f32);
        return;
    }
    // Rounding may leave a radius that does not reach.
    let radius = f64::from(radius).max(half);
    let side = if clockwise { 1.0 } else { -1.0 };
    let away = side * (radius * radius - half * half).sqrt() / (2.0 * half);
    let centre = [x + chord[0] / 2.0 - away * chord[1], y + chord[1] / 2.0 + away * chord[0]];
    around(to, centre, [x - centre[0], y - centre[1]], side * 2.0 * (half / radius).asin());
}

/// Goes around a centre by an angle, clockwise on the screen if it is positive, from a point at this place beside the centre.
fn around(to: &mut PathBuilder, centre: [f64; 2], [x, y]: [f64; 2], angle: f64) {
    let most = (STRAY / (UNIT_STRAY * x.hypot(y))).powf(1.0 / 6.0).min(FRAC_PI_2);
    let parts = (angle.abs() / most).ceil().max(1.0);
    let step = angle / parts;
    // Control points lie on the tangents.
    let reach = 4.0 / 3.0 * (step / 4.0).tan();
    let at = |x: f64, y: f64| [(centre[0] + x) as f32, (centre[1] + y) as f32];
    let mut a = [x, y];
    for part in 1..=parts as usize {
        let (sin, cos) = (step * part as f64).sin_cos();
        let b = [x * cos - y * sin, x * sin + y * cos];
        let [[x1, y1], [x2, y2], [x3, y3]] = [
            at(a[0] - reach * a[1], a[1] + reach * a[0]),
            at(b[0] + reach * b[1], b[1] - reach * b[0]),
            at(b[0], b[1]),
        ];
        to.cubic_to(x1, y1, x2, y2, x3, y3);
        a = b;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tiny_skia::PathSegment;

    fn path(text: &str) -> Option<tiny_skia::Path> {
        let mut to = PathBuilder::new();
        data(text, &mut to)?;
        to.finish()
    }

    /// Points of all cubics.
    fn points(path: &tiny_skia::Path) -> Vec<[f64; 2]> {
        let (mut at, mut points) = ([0.0; 2], Vec::new());
        for segment in path.segments() {
            match segment {
                PathSegment::MoveTo(p) => at = [p.x, p.y].map(f64::from),
                PathSegment::CubicTo(p1, p2, p3) => {
                    let [p1, p2, p3] = [p1, p2, p3].map(|p| [p.x, p.y].map(f64::from));
                    for k in 1..=32 {
                        let t = f64::from(k) / 32.0;
                        let s = 1.0 - t;
                        let [a, b, c, d] = [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t];
                        points.push([0, 1].map(|i| a * at[i] + b * p1[i] + c * p2[i] + d * p3[i]));
                    }
                    at = p3;
                }
                other => panic!("{other:?}"),
            }
        }
        points
    }

    #[test]
    fn arcs_are_round() {
        for radius in [0.5, 3.0, 40.0, 900.0, 20_000.0] {
            for angle in [0.01_f64, 0.5, 1.5, 3.0] {
                let (sin, cos) = angle.sin_cos();
                let end = [radius * cos, radius * sin];
                let drawn = path(&format!("M{radius} 0A{radius} {radius} 0 0 1 {} {}", end[0], end[1])).unwrap();
                let points = points(&drawn);
                for [x, y] in &points {
                    // In `f32`, 20000 has steps of 0.002.
                    let slack = STRAY * 1.1 + 3e-7 * radius;
                    assert!((x.hypot(*y) - radius).abs() < slack, "radius {radius} angle {angle}: {x} {y}");
                    assert!((-1e-3..angle + 1e-3).contains(&y.atan2(*x)), "radius {radius} angle {angle}: {x} {y}");
                }
                let last = points.last().unwrap();
                assert!((last[0] - end[0]).hypot(last[1] - end[1]) < 1e-3 + 3e-7 * radius, "{last:?} {end:?}");
            }
        }
    }

    #[test]
    fn arcs_turn_to_their_side_and_reach() {
        let middle = |text: &str| points(&path(text).unwrap())[15];
        // Half a circle, even where the radius is too small by rounding; y is down.
        for radius in ["1", "0.99"] {
            let [x, y] = middle(&format!("M-1 0A{radius} {radius} 0 0 1 1 0"));
            assert!(x < 0.0 && y < -0.5, "{x} {y}");
            let [x, y] = middle(&format!("M-1 0A{radius} {radius} 0 0 0 1 0"));
            assert!(x < 0.0 && y > 0.5, "{x} {y}");
        }
    }

    #[test]
    fn data_that_is_not_written_is_not_read() {
        for text in ["M1 2L3 4", "M0 0L1 1ZM2 2L3 3", "M1 2Q3 4 5 6", "M1 2A3 3 0 0 1 4 5", "M1 2L-0.5 100"] {
            assert!(path(text).is_some(), "{text}");
        }
        for text in [
            "L1 2",
            "M1",
            "M1 2 3 4",
            "m1 2",
            "M1 2h3",
            "M1 2C1 2 3 4 5 6",
            "M1 2L3 NaN",
            "M1 2L3 1e2",
            "M0 0L1 1ZL2 2",
            "M0 0A1 2 0 0 1 1 1",
            "M0 0A1 1 9 0 1 1 1",
            "M0 0A1 1 0 1 1 1 1",
            "M0 0A1 1 0 0 2 1 1",
            " M1 2",
            "M1 2 L3 4é",
            "M1 2Z3",
            "1 2",
        ] {
            assert!(data(text, &mut PathBuilder::new()).is_none(), "{text}");
        }
    }
}
