//! Clothoids (Euler spirals) as arcs, with a proven distance.
//!
//! The curvature κ of a clothoid changes at a constant rate κ' along its length s. Arcs of the same lengths have a piecewise constant
//! curvature. Let δ be the heading of the clothoid less that of the arcs at the same s, and D the integral of δ. With a first and a last arc
//! of the length h/√2 and arcs of the length h between them, of the curvatures
//!
//! ```text
//! first  κ + κ' h/(3 √2) at its start    between  κ at its middle    last  κ - κ' h/(3 √2) at its end
//! ```
//!
//! δ is κ' h²/12 where arcs join and 0 at both ends, and D is 0 at all these places. In between, with x from the start of an arc,
//!
//! ```text
//! between      δ = κ' (h²/12 - x (h - x)/2)       D = κ' x (h - x) (h - 2 x)/12    |δ| ≤ κ' h²/12, |D| < 0.0081 κ' h³
//! first, last  δ = κ' (x²/2 - x h/(3 √2))         D = -κ' x² (h/√2 - x)/6          |δ| ≤ κ' h²/12, |D| < 0.0088 κ' h³
//! ```
//!
//! The two positions at the same length differ by ∫ exp(iθ) (1 - exp(-iδ)) ds, where |1 - exp(-iδ) - iδ| ≤ δ²/2. Integrated by parts, the
//! part in iδ is iD exp(iθ) + ∫ D κ exp(iθ) ds. So the distance is at most max|D| (1 + Θ) + s max δ²/2, where Θ is the integral of |κ|. Both
//! curves have the same length, and the same heading at the end.

use super::biarc::{BiarcFit, MOST, most_turned};
use super::{ImportError, UNSAID};
use crate::scenario::{PathSegment, PlacedSegment};
use std::f64::consts::SQRT_2;

/// Bound of |D| over κ' h³: (4/162)/(2 √2), rounded up.
const OFFSET: f64 = 0.0088;

/// Curvature below which a line stands for an arc \[1/m\]: with a larger radius its centre is too far away to compute with.
const STRAIGHT: f64 = 1e-9;

/// The arcs for the clothoid that begins here, with its curvatures at both ends \[1/m\], within `tolerance` \[m\] of it.
///
/// # Errors
/// [`ImportError`] if its values are out of range, or if it takes too many arcs.
pub(super) fn fit(
    [x, y]: [f64; 2],
    heading: f64,
    length: f64,
    [begin, end]: [f64; 2],
    tolerance: f64,
) -> Result<BiarcFit, ImportError> {
    let rate = (end - begin) / length;
    let winding = if begin * end >= 0.0 {
        0.5 * length * (begin + end).abs()
    } else {
        0.5 * (begin * begin + end * end) / rate.abs()
    };
    let extent = x.abs() + y.abs() + length;
    if !(extent + heading + rate + winding).is_finite() || length <= 0.0 {
        return Err(ImportError::new("its length, heading or curvature is out of range"));
    }
    let mut between = 0;
    loop {
        let step = length / (SQRT_2 + between as f64);
        let turned = rate.abs() * step * step / 12.0;
        // Roundings of the places and headings of the arcs one after the other.
        let rounding = 8.0 * f64::EPSILON * ((between + 2) as f64 * extent + length * (heading.abs() + winding));
        let deviation =
            OFFSET * rate.abs() * step.powi(3) * (1.0 + winding) + 0.5 * length * turned * turned + rounding;
        if 2.0 * rounding >= tolerance || between > MOST {
            return Err(ImportError::new(format!(
                "it takes more than {MOST} arcs within {tolerance:e} m, or coordinates up to {extent:e} m do not have as many digits"
            )));
        }
        if deviation <= tolerance && turned <= most_turned(tolerance) {
            let (pieces, straight) = arcs([x, y], heading, [begin, end], rate, step, between);
            // Lines in place of arcs that are nearly straight.
            let (deviation, turned) = (deviation + straight * length, turned + straight);
            let bends = deviation > UNSAID || pieces.iter().any(|piece| piece.radius().is_some());
            return Ok(BiarcFit { pieces, deviation, length_error: rounding, heading_error: turned, bends });
        }
        between += 1 + between / 8;
    }
}

/// The arcs, and the sum of the angles that are left out of lines.
fn arcs(
    mut at: [f64; 2],
    heading: f64,
    [begin, end]: [f64; 2],
    rate: f64,
    step: f64,
    between: usize,
) -> (Vec<PlacedSegment>, f64) {
    let outer = step / SQRT_2;
    let (mut pieces, mut straight) = (Vec::with_capacity(between + 2), 0.0);
    let mut add = |from: f64, length: f64, curvature: f64, heading: f64| {
        let shape = if curvature.abs() < STRAIGHT {
            straight += curvature.abs() * length;
            PathSegment::Line { length }
        } else {
            PathSegment::arc(curvature.abs().recip(), curvature * length)
        };
        let piece = PlacedSegment { start: at, heading, shape };
        at = piece.end();
        pieces.push(piece);
        from + length
    };
    // Headings are those of the closed form and not sums, so that their rounding does not add up.
    let turned = |s: f64| begin * s + 0.5 * rate * s * s;
    let mut s = add(0.0, outer, begin + rate * outer / 3.0, heading);
    for _ in 0..between {
        s = add(s, step, begin + rate * (s + 0.5 * step), heading + turned(s) - rate * step * step / 12.0);
    }
    add(s, outer, end - rate * outer / 3.0, heading + turned(s) - rate * step * step / 12.0);
    (pieces, straight)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plane_geometry::{distance, wrapped};

    /// Points and headings of a clothoid at so many equally long steps, by Gauss and Legendre's quadrature of four points in parts that are
    /// turned by little.
    fn exact(at: [f64; 2], heading: f64, length: f64, [begin, end]: [f64; 2], steps: usize) -> Vec<([f64; 2], f64)> {
        const NODES: [(f64, f64); 4] = [
            (-0.861_136_311_594_052_6, 0.347_854_845_137_453_85),
            (-0.339_981_043_584_856_26, 0.652_145_154_862_546_1),
            (0.339_981_043_584_856_26, 0.652_145_154_862_546_1),
            (0.861_136_311_594_052_6, 0.347_854_845_137_453_85),
        ];
        let theta = |s: f64| heading + begin * s + 0.5 * (end - begin) / length * s * s;
        let parts = 64;
        let width = length / (steps * parts) as f64;
        let (mut point, mut all) = (at, vec![(at, heading)]);
        for k in 0..steps * parts {
            let middle = (k as f64 + 0.5) * width;
            for (node, weight) in NODES {
                let (sin, cos) = theta(middle + 0.5 * width * node).sin_cos();
                point = [point[0] + 0.5 * width * weight * cos, point[1] + 0.5 * width * weight * sin];
            }
            if (k + 1) % parts == 0 {
                all.push((point, theta((k + 1) as f64 * width)));
            }
        }
        all
    }

    fn at(pieces: &[PlacedSegment], length: f64) -> PlacedSegment {
        let mut rest = length;
        for piece in pieces {
            if rest <= piece.shape.length() {
                return piece.part(0.0, rest);
            }
            rest -= piece.shape.length();
        }
        *pieces.last().unwrap()
    }

    #[test]
    fn the_bound_holds_and_is_not_far_from_the_truth() {
        let mut ratios = Vec::new();
        for (length, curvatures) in [
            (30.0, [0.0, 0.1]),
            (30.0, [0.1, 0.0]),
            (100.0, [0.0, -0.02]),
            (60.0, [-0.05, 0.05]),
            (40.0, [0.02, -0.3]),
            (12.0, [0.5, 1.5]),
            (0.5, [0.0, 4.0]),
            (400.0, [1e-4, 2e-3]),
            (50.0, [0.05, 0.050_001]),
            (20.0, [0.25, 0.25]),
            (10.0, [0.0, 0.0]),
            (80.0, [-1e-12, 0.03]),
            (3.0, [-20.0, 25.0]),
        ] {
            for tolerance in [1e-1, 1e-3, 1e-5] {
                let (begin, heading) = ([4.0, -7.0], 2.5);
                let fit = fit(begin, heading, length, curvatures, tolerance).unwrap();
                let steps = 500;
                let all = exact(begin, heading, length, curvatures, steps);
                let (mut worst, mut turned) = (0.0_f64, 0.0_f64);
                for (k, (point, heading)) in all.iter().enumerate() {
                    let there = at(&fit.pieces, length * k as f64 / steps as f64);
                    worst = worst.max(distance(there.end(), *point));
                    turned = turned.max(wrapped(there.heading_at_end() - heading).abs());
                }
                let case = format!("{length} {curvatures:?} {tolerance}: {worst:e} of {:e}", fit.deviation);
                // The quadrature rounds as well.
                assert!(worst <= fit.deviation + 1e-10 && fit.deviation <= tolerance, "{case}");
                assert!(
                    turned <= fit.heading_error + 1e-12 && fit.heading_error <= most_turned(tolerance),
                    "{case}: {turned}"
                );
                let sum: f64 = fit.pieces.iter().map(|piece| piece.shape.length()).sum();
                assert!((sum - length).abs() <= 1e-12 * length, "{case}");
                let last = fit.pieces.last().unwrap();
                assert!(wrapped(last.heading_at_end() - all[steps].1).abs() < 1e-9, "{case}");
                for pair in fit.pieces.windows(2) {
                    assert!(distance(pair[0].end(), pair[1].start) < 1e-12, "{case}");
                    assert!(wrapped(pair[0].heading_at_end() - pair[1].heading).abs() < 1e-9, "{case}");
                }
                if fit.pieces.len() > 4 && worst > 1e-8 {
                    ratios.push(fit.deviation / worst);
                }
            }
        }
        assert!(ratios.len() > 20 && ratios.iter().all(|ratio| *ratio < 40.0), "{ratios:?}");
    }

    /// The closed form of the clothoid that begins straight: Fresnel's integrals by their power series.
    #[test]
    fn the_end_is_that_of_fresnels_integrals() {
        let (length, end) = (30.0_f64, 0.1_f64);
        // x = ∫ cos(a s²), y = ∫ sin(a s²) with a = κ'/2.
        let a = end / length / 2.0;
        let (mut x, mut y, mut term) = (0.0, 0.0, 1.0);
        for k in 0..60 {
            let power = length.powi(2 * k + 1) * term / f64::from(2 * k + 1);
            match k % 4 {
                0 => x += power,
                1 => y += power,
                2 => x -= power,
                _ => y -= power,
            }
            term *= a / f64::from(k + 1);
        }
        let fit = fit([0.0, 0.0], 0.0, length, [0.0, end], 1e-6).unwrap();
        assert!(distance(fit.pieces.last().unwrap().end(), [x, y]) <= fit.deviation, "{x} {y}");
    }

    #[test]
    fn what_is_out_of_range_is_refused() {
        let refused = |length: f64, curvatures: [f64; 2], tolerance: f64| {
            fit([1e3, 0.0], 0.0, length, curvatures, tolerance).unwrap_err().to_string()
        };
        for (length, curvatures) in
            [(f64::NAN, [0.0, 1.0]), (1.0, [f64::INFINITY, 0.0]), (0.0, [0.0, 1.0]), (-1.0, [0.0, 1.0])]
        {
            assert!(refused(length, curvatures, 1e-3).contains("out of range"), "{length} {curvatures:?}");
        }
        assert!(refused(1e4, [0.0, 1e3], 1e-3).contains("more than 5000 arcs"));
        assert!(refused(10.0, [0.0, 0.1], 1e-13).contains("do not have as many digits"));
    }
}
