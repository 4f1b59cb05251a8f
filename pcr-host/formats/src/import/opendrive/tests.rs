//! Roads with spirals and cubic curves, against dense integration of their definitions.

use super::*;
use crate::import::{InputFormat, layout};
use crate::scenario::PlacedSegment;

fn read(records: &str, options: &ImportOptions) -> Result<(LayoutEdge, Warnings), String> {
    let text = format!("<OpenDRIVE><header/><road id=\"1\"><planView>{records}</planView></road></OpenDRIVE>");
    let mut warnings = Warnings::default();
    let options = ImportOptions { radius: Some(1.0), ..options.clone() };
    let imported = layout(InputFormat::OpenDrive, &text, &options, &mut warnings).map_err(|error| error.to_string())?;
    Ok((imported.layout.edges[0].clone(), warnings))
}

#[track_caller]
fn refused(records: &str) -> String {
    read(records, &ImportOptions::default()).unwrap_err()
}

fn record(s: f64, [x, y]: [f64; 2], heading: f64, length: f64, shape: &str) -> String {
    format!(
        "<geometry s=\"{s}\" x=\"{x:.12}\" y=\"{y:.12}\" hdg=\"{heading:.12}\" length=\"{length}\">{shape}</geometry>"
    )
}

/// The point of lines and arcs at a length.
fn at(pieces: &[PlacedSegment], length: f64) -> [f64; 2] {
    let mut rest = length;
    for piece in pieces {
        if rest <= piece.shape.length() {
            return piece.part(0.0, rest).end();
        }
        rest -= piece.shape.length();
    }
    pieces.last().unwrap().end()
}

/// A road of records whose curvature changes linearly, from the left to the right and to a line, by the midpoint rule in steps of a tenth of
/// a millimetre.
#[test]
fn a_road_of_spirals_is_where_its_curvature_leads() {
    const STEP: f64 = 1e-4;
    let parts = [
        (20.0, [0.0, 0.0]),
        (30.0, [0.0, 0.05]),
        (20.0, [0.05, 0.05]),
        (60.0, [0.05, -0.05]),
        (0.0, [-0.05, -0.05]),
        (25.0, [-0.05, 0.0]),
        (10.0, [0.0, 0.0]),
    ];
    for origin in [[0.0, 0.0], [350_000.0, -5_400_000.0]] {
        let (mut point, mut heading, mut s) = (origin, 1.0, 0.0);
        let (mut records, mut exact) = (String::new(), Vec::new());
        for (length, [begin, end]) in parts {
            let shape = match (begin, end) {
                (0.0, 0.0) => "<line/>".to_owned(),
                (begin, end) if begin == end => format!("<arc curvature=\"{begin}\"/>"),
                _ => format!("<spiral curvStart=\"{begin}\" curvEnd=\"{end}\"/>"),
            };
            records += &record(s, point, heading, length, &shape);
            // From the origin of the map, so that no digits are lost.
            let mut offset = [0.0; 2];
            let steps = (length / STEP).round() as usize;
            for k in 0..steps {
                let middle = (k as f64 + 0.5) * STEP;
                let direction = heading + begin * middle + 0.5 * (end - begin) / length * middle * middle;
                offset = [offset[0] + STEP * direction.cos(), offset[1] + STEP * direction.sin()];
                if k % 1000 == 999 {
                    exact.push((s + (k + 1) as f64 * STEP, [point[0] + offset[0], point[1] + offset[1]]));
                }
            }
            point = [point[0] + offset[0], point[1] + offset[1]];
            heading += 0.5 * length * (begin + end);
            s += length;
        }
        for tolerance in [None, Some(0.05), Some(1e-4)] {
            let (edge, warnings) = read(&records, &ImportOptions { tolerance, ..ImportOptions::default() }).unwrap();
            let lines = warnings.lines();
            assert!(lines.iter().all(|line| !line.contains("joints are open")), "{lines:?}");
            assert!(warnings.has_used("tolerance"));
            let most = tolerance.unwrap_or(1e-3);
            // Joints that are closed count as well.
            assert!(edge.deviation <= 4.0 * most, "{} {most}", edge.deviation);
            assert!((edge.length() - s).abs() <= edge.longer + 1e-6, "{} {s}", edge.length());
            let worst = exact.iter().map(|(s, point)| distance(at(&edge.curve, *s), *point)).fold(0.0, f64::max);
            assert!(worst <= edge.deviation && worst < most, "{worst} {}", edge.deviation);
            assert!(edge.curve.len() < 200, "{}", edge.curve.len());
        }
    }
}

/// A cubic curve by its points, at the same length of travel.
#[test]
fn cubic_curves_are_where_their_polynomials_are() {
    let (u, v) = ([0.0, 30.0, -4.0, 2.0], [0.0, 0.0, 20.0, -11.0]);
    let value = |[a, b, c, d]: [f64; 4], p: f64| a + p * (b + p * (c + p * d));
    let steps = 400_000;
    let (heading, begin) = (0.4_f64, [5.0, 6.0]);
    let point = |p: f64| {
        let [x, y] = [value(u, p), value(v, p)];
        let (sin, cos) = heading.sin_cos();
        [begin[0] + cos * x - sin * y, begin[1] + sin * x + cos * y]
    };
    let (mut length, mut all) = (0.0, Vec::new());
    for k in 0..steps {
        let [from, to] = [k, k + 1].map(|k| point(f64::from(k) / f64::from(steps)));
        length += distance(from, to);
        if k % 400 == 399 {
            all.push((length, to));
        }
    }
    let shape = |range: &str, scale: f64| {
        let [u, v] = [u, v].map(|[a, b, c, d]| [a, b / scale, c / scale.powi(2), d / scale.powi(3)]);
        format!(
            "<paramPoly3 aU=\"{:e}\" bU=\"{:e}\" cU=\"{:e}\" dU=\"{:e}\" aV=\"{:e}\" bV=\"{:e}\" cV=\"{:e}\" dV=\"{:e}\"{range}/>",
            u[0], u[1], u[2], u[3], v[0], v[1], v[2], v[3]
        )
    };
    let [normalized, arc_length] = [" pRange=\"normalized\"", " pRange=\"arcLength\""];
    let line = record(length, point(1.0), heading, 5.0, "<line/>");
    let whole = |shape: &str| record(0.0, begin, heading, length, shape);
    for shape in [shape(normalized, 1.0), shape("", 1.0), shape(arc_length, length)] {
        let (edge, _) = read(&whole(&shape), &ImportOptions::default()).unwrap();
        let worst = all.iter().map(|(s, point)| distance(at(&edge.curve, *s), *point)).fold(0.0, f64::max);
        assert!(worst <= edge.deviation && edge.deviation < 4e-3, "{worst} {}", edge.deviation);
        assert!((edge.length() - length).abs() <= edge.longer + 1e-6, "{} {length}", edge.longer);
        // What comes later is reached a little earlier or later.
        let (longer, _) = read(&format!("{}{line}", whole(&shape)), &ImportOptions::default()).unwrap();
        assert!(longer.deviation >= edge.longer && longer.longer >= edge.longer);
    }
    // The range of the other kind makes another curve, which has another length.
    for wrong in [shape(normalized, length), shape(arc_length, 1.0), shape("", length)] {
        assert!(refused(&whole(&wrong)).contains("m long, and its length is"), "{}", refused(&whole(&wrong)));
    }
    assert!(refused(&whole(&shape(" pRange=\"metres\"", 1.0))).contains("pRange: metres is not known"));
    assert!(refused(&whole("<paramPoly3 aU=\"0\"/>")).contains("bU"));
    // A graph that is a line, and one that is a parabola of a known length.
    let (straight, _) = read(
        &record(0.0, [0.0, 0.0], 0.0, 10.0, "<poly3 a=\"0\" b=\"0.75\" c=\"0\" d=\"0\"/>"),
        &ImportOptions::default(),
    )
    .unwrap();
    assert!(distance(straight.curve.last().unwrap().end(), [8.0, 6.0]) < 1e-6);
    let half = 0.5 * (2.0 * 5.0_f64.sqrt() + 2.0_f64.asinh());
    let parabola = record(0.0, [0.0, 0.0], 0.0, half, "<poly3 a=\"0\" b=\"0\" c=\"0.5\" d=\"0\"/>");
    let (edge, _) = read(&parabola, &ImportOptions::default()).unwrap();
    assert!(distance(edge.curve.last().unwrap().end(), [2.0, 2.0]) <= edge.deviation && edge.deviation < 4e-3);
}

#[test]
fn what_cannot_be_read_is_refused() {
    let spiral = |length: f64, begin: f64, end: f64| {
        record(0.0, [0.0, 0.0], 0.0, length, &format!("<spiral curvStart=\"{begin}\" curvEnd=\"{end}\"/>"))
    };
    for (records, expected) in [
        (spiral(1000.0, 0.0, 1.0), "road 1, geometry 1: its length, heading or sweep is out of range"),
        (spiral(10.0, 1e9, 0.0), "out of range"),
        (spiral(-1.0, 0.0, 0.1), "out of range"),
        (record(0.0, [0.0, 0.0], 0.0, 10.0, "<spiral curvStart=\"0\"/>"), "curvEnd"),
        (record(0.0, [0.0, 0.0], 0.0, 10.0, "<bezier/>"), "road 1, geometry 1: bezier is not read"),
        (record(0.0, [0.0, 0.0], 0.0, 10.0, ""), "it has no shape"),
        (
            format!("{}{}", spiral(10.0, 0.0, 0.1), record(10.0, [20.0, 0.0], 0.0, 5.0, "<line/>")),
            "geometry 2: it begins 10.",
        ),
    ] {
        let problem = refused(&records);
        assert!(problem.contains(expected), "{expected} in {problem}");
    }
}
