//! Cubic curves of OpenDRIVE as Bézier curves.
//!
//! A `paramPoly3` has two polynomials u(p), v(p) in the frame of its record; p is from 0 to 1, or from 0 to the length of the record, and is
//! no arc length. A `poly3` is the graph v(u), and ends where its arc length is that of the record.

use super::ImportError;
use super::biarc::{CurvePart, parts};
use super::nurbs::RationalBezier;
use crate::scenario::PlacedSegment;

/// Coefficients of a polynomial, from the constant one.
pub(super) type Cubic = [f64; 4];

/// Abscissas and weights of Gauss and Legendre's quadrature of five points.
const NODES: [(f64, f64); 5] = [
    (-0.906_179_845_938_664, 0.236_926_885_056_189_1),
    (-0.538_469_310_105_683, 0.478_628_670_499_366_5),
    (0.0, 0.568_888_888_888_888_9),
    (0.538_469_310_105_683, 0.478_628_670_499_366_5),
    (0.906_179_845_938_664, 0.236_926_885_056_189_1),
];

/// Parts in which the length of a graph is integrated.
const PARTS: u32 = 64;

/// Halvings for the bounds of a length.
const HALVINGS: u32 = 14;

/// The curve (u, v) with p from 0 to `last`, in the frame of a pose.
pub(super) fn parametric([u, v]: [Cubic; 2], last: f64, at: [f64; 2], heading: f64) -> RationalBezier {
    // Control points of the coordinates over p / last.
    let control = |[a, b, c, d]: Cubic| {
        let [b, c, d] = [b * last, c * last * last, d * last * last * last];
        [a, a + b / 3.0, a + (2.0 * b + c) / 3.0, a + b + c + d]
    };
    let (sin, cos) = heading.sin_cos();
    let [u, v] = [control(u), control(v)];
    RationalBezier::new(&[0, 1, 2, 3].map(|k| [at[0] + cos * u[k] - sin * v[k], at[1] + sin * u[k] + cos * v[k]]))
}

/// The graph v(u) up to this arc length \[m\], in the frame of a pose; and a bound of how far its own length is from that.
///
/// # Errors
/// [`ImportError`] if its values are out of range.
pub(super) fn graph(
    v: Cubic,
    length: f64,
    PlacedSegment { start: at, heading, .. }: PlacedSegment,
    tolerance: f64,
) -> Result<(RationalBezier, f64), ImportError> {
    let out_of_range = || ImportError::new("its polynomial is out of range");
    let [_, b, c, d] = v;
    let way = |last: f64| -> f64 {
        let width = last / f64::from(PARTS);
        let speed = |u: f64| (b + u * (2.0 * c + u * 3.0 * d)).hypot(1.0);
        let part = |k: u32| {
            let middle = (f64::from(k) + 0.5) * width;
            NODES.iter().map(|(node, weight)| 0.5 * width * weight * speed(middle + 0.5 * width * node)).sum::<f64>()
        };
        (0..PARTS).map(part).sum()
    };
    // The graph is not shorter than its abscissa.
    let (mut lo, mut hi) = (0.0, length);
    for _ in 0..64 {
        let middle = 0.5 * (lo + hi);
        if way(middle) < length { lo = middle } else { hi = middle }
    }
    let curve = parametric([[0.0, 1.0, 0.0, 0.0], v], 0.5 * (lo + hi), at, heading);
    if curve.points().flatten().any(|x| !x.is_finite()) {
        return Err(out_of_range());
    }
    let [least, most] = length_of(&curve, tolerance);
    Ok((curve, (least - length).abs().max((most - length).abs())))
}

/// Bounds of the length of a curve \[m\].
pub(super) fn length_of(curve: &RationalBezier, tolerance: f64) -> [f64; 2] {
    let mut short: Vec<CurvePart> = Vec::new();
    parts(curve, tolerance / 4096.0, HALVINGS, &mut short);
    short.iter().fold([0.0; 2], |sum, part| [sum[0] + part.length[0], sum[1] + part.length[1]])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plane_geometry::distance;

    #[test]
    fn points_are_those_of_the_polynomials() {
        let (u, v) = ([0.1, 9.0, -1.0, 0.5], [0.0, 0.2, 3.0, -1.5]);
        let value = |[a, b, c, d]: Cubic, p: f64| a + p * (b + p * (c + p * d));
        for last in [1.0, 7.5] {
            let curve = parametric([u, v], last, [3.0, -2.0], 0.7);
            for k in 0..=20 {
                let t = f64::from(k) / 20.0;
                let [x, y] = [u, v].map(|cubic| value(cubic, t * last));
                let (sin, cos) = 0.7_f64.sin_cos();
                let expected = [3.0 + cos * x - sin * y, -2.0 + sin * x + cos * y];
                assert!(distance(curve.at(t), expected) < 1e-12 * (1.0 + last.powi(3)), "{last} {t}");
            }
        }
    }

    #[test]
    fn graphs_end_at_their_length() {
        let placed = PlacedSegment::line([0.0, 0.0], [1.0, 0.0]);
        // A line of slope 3/4, and parabolas, whose length has a closed form.
        let (line, unsure) = graph([0.0, 0.75, 0.0, 0.0], 10.0, placed, 1e-3).unwrap();
        assert!(distance(line.ends()[1], [8.0, 6.0]) < 1e-9 && unsure < 1e-9, "{:?} {unsure}", line.ends());
        let half = |u: f64| 0.5 * (u * (1.0 + u * u).sqrt() + u.asinh());
        for end in [0.3, 2.0] {
            let (parabola, unsure) = graph([0.0, 0.0, 0.5, 0.0], half(end), placed, 1e-3).unwrap();
            assert!(distance(parabola.ends()[1], [end, 0.5 * end * end]) < 1e-9, "{:?}", parabola.ends());
            assert!(unsure < 1e-5, "{unsure}");
        }
        assert!(graph([0.0, f64::NAN, 0.0, 0.0], 1.0, placed, 1e-3).is_err());
    }
}
