//! Bounds the angle between a curve and a line or an arc that stands for it.
//!
//! An outline faces along its path. So it is turned from where it is on the curve by the angle between both directions, and that counts
//! multiplied by the distance of its farthest point. In the frame of an arc with signed curvature k, `g` of [`biarc`](super::biarc) is
//! a function on the plane that is constant along all circles around the arc's centre, so its derivative along the curve is the speed times
//! the sine of the angle δ to the circle there:
//!
//! ```text
//! sin δ = |dg/dt| / ((1 - k d) |dr/dt|)
//! ```
//!
//! On a rational Bézier curve numerator and denominator are polynomials over the same power of the weight, and the ratio of their Bernstein
//! coefficients bounds them. Where that fails, as where the speed is 0, the directions of the control polygon do: those of the curve
//! lie between them.

use super::bernstein::{circle, derivative, framed, product, sum};
use super::nurbs::RationalBezier;
use crate::plane_geometry::wrapped;
use crate::scenario::{PathSegment, PlacedSegment};
use std::f64::consts::{FRAC_PI_2, PI};

/// How often a curve is halved for the bound.
const HALVINGS: u32 = 4;

/// Angle below which halving would win nothing \[rad\].
const ENOUGH: f64 = 1e-8;

/// Bound of the angle between a curve and the circle or line of a piece at the point beside it \[rad\], at most π.
pub(super) fn between(curve: &RationalBezier, piece: &PlacedSegment) -> f64 {
    halved(curve, piece, HALVINGS)
}

fn halved(curve: &RationalBezier, piece: &PlacedSegment, halvings: u32) -> f64 {
    let points = framed(curve, piece.start, piece.heading);
    let curvature = match piece.shape {
        PathSegment::Arc { radius, sweep, .. } => 1.0_f64.copysign(sweep) / radius,
        _ => 0.0,
    };
    let hull = by_polygon(&points, curvature);
    let bound = if hull < FRAC_PI_2 { hull.min(by_speed(&points, curvature).unwrap_or(PI)) } else { hull };
    if halvings == 0 || bound <= ENOUGH {
        return bound;
    }
    curve.split(0.5).iter().map(|half| halved(half, piece, halvings - 1)).fold(0.0, f64::max)
}

/// The same bound by the directions of the control polygon, and of the circles through its points.
fn by_polygon([x, y, w]: &[Vec<f64>; 3], curvature: f64) -> f64 {
    let places: Vec<[f64; 2]> = x.iter().zip(y).zip(w).map(|((x, y), w)| [x / w, y / w]).collect();
    let legs = places.windows(2).map(|leg| [leg[1][0] - leg[0][0], leg[1][1] - leg[0][1]]);
    let ways: Vec<f64> = legs.filter(|leg| *leg != [0.0; 2]).map(|[x, y]| y.atan2(x)).collect();
    let circles: Vec<f64> = places.iter().map(|[x, y]| (curvature * x).atan2(1.0 - curvature * y)).collect();
    let (Some(first), Some(middle)) = (ways.first(), circles.first()) else { return 0.0 };
    // Both ranges, counted from one direction of each.
    let range = |angles: &[f64], from: f64| {
        let off = angles.iter().map(|angle| wrapped(angle - from));
        off.fold([0.0_f64; 2], |[lo, hi], off| [lo.min(off), hi.max(off)])
    };
    let ([own, their], apart) = ([range(&ways, *first), range(&circles, *middle)], wrapped(first - middle));
    if own[1] - own[0] >= PI || their[1] - their[0] >= PI {
        return PI;
    }
    (apart + own[1] - their[0]).abs().max((apart + own[0] - their[1]).abs()).min(PI)
}

/// The same bound by the derivatives; `None` where the curve may stop or turn back.
fn by_speed(points: &[Vec<f64>; 3], curvature: f64) -> Option<f64> {
    let [g, squares] = circle(points, curvature);
    let [x, y, w] = points;
    // The derivative of g, times w³.
    let rise = sum(&product(&derivative(&g), w), &product(&g, &derivative(w)), -2.0);
    // Along the chord.
    let [from, to] = [0, x.len().checked_sub(1)?].map(|k| [x[k] / w[k], y[k] / w[k]]);
    let chord = [to[0] - from[0], to[1] - from[1]];
    let length = chord[0].hypot(chord[1]);
    let along: Vec<f64> = x.iter().zip(y).map(|(x, y)| (x * chord[0] + y * chord[1]) / length).collect();
    let speed = sum(&product(&derivative(&along), w), &product(&along, &derivative(w)), -1.0);
    let speed = product(&speed, w);
    let mut ratio = 0.0_f64;
    for (rise, speed) in rise.iter().zip(&speed) {
        match *speed {
            speed if speed > 0.0 => ratio = ratio.max((rise / speed).abs()),
            0.0 if *rise == 0.0 => {}
            _ => return None,
        }
    }
    // (1 - k d)² = 1 + 2 k g.
    let outside = g.iter().zip(squares).map(|(g, w)| 1.0 - 2.0 * (curvature * g / w).abs()).fold(1.0, f64::min);
    let sine = ratio / outside.max(0.0).sqrt();
    (sine <= 1.0).then(|| sine.asin())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against directions of the curve, beside which the circle is: at least as much, and not much more.
    #[test]
    fn the_bound_is_that_of_the_directions() {
        let arc = |radius: f64, sweep: f64| PlacedSegment {
            start: [0.0; 2],
            heading: 0.1,
            shape: PathSegment::arc(radius, sweep),
        };
        let line = PlacedSegment { start: [0.0; 2], heading: 0.1, shape: PathSegment::Line { length: 1.0 } };
        let curves: [&[[f64; 3]]; 4] = [
            &[[0.0, 0.0, 1.0], [0.3, 0.03, 1.0], [0.6, 0.1, 1.0], [0.9, 0.25, 1.0]],
            &[[0.0, 0.0, 1.0], [0.6, 0.06, 2.0], [0.3, 0.05, 0.5], [0.9, 0.25, 1.0]],
            // Two points in one: the speed is 0 where it begins.
            &[[0.0, 0.0, 1.0], [0.0, 0.0, 1.0], [0.6, 0.1, 1.0], [0.9, 0.25, 1.0]],
            &[[0.0, 0.0, 1.0], [0.9, 0.25, 1.0]],
        ];
        for points in curves {
            let curve = RationalBezier(points.to_vec());
            for piece in [line, arc(2.0, 0.5), arc(20.0, 0.05), arc(2.0, -0.5)] {
                let bound = between(&curve, &piece);
                let curvature = match piece.shape {
                    PathSegment::Arc { radius, sweep, .. } => 1.0_f64.copysign(sweep) / radius,
                    _ => 0.0,
                };
                let mut most = 0.0_f64;
                for k in 1..1000 {
                    let t = f64::from(k) / 1000.0;
                    let ([a, b], [x, y]) = ([curve.at(t - 1e-4), curve.at(t + 1e-4)], curve.at(t));
                    let way = (b[1] - a[1]).atan2(b[0] - a[0]);
                    let (sin, cos) = piece.heading.sin_cos();
                    let [x, y] = [x * cos + y * sin, y * cos - x * sin];
                    let circle = piece.heading + (curvature * x).atan2(1.0 - curvature * y);
                    most = most.max(wrapped(way - circle).abs());
                }
                assert!(most <= bound + 1e-6, "{most} {bound}");
                assert!(bound <= 1.1 * most + 0.02, "{most} {bound}");
            }
        }
    }

    #[test]
    fn what_turns_back_has_any_direction() {
        let there_and_back = RationalBezier::new(&[[0.0, 0.0], [1.0, 0.0], [0.0, 0.1], [1.0, 0.0]]);
        let hook = RationalBezier::new(&[[0.0, 0.0], [1.0, 0.0], [1.0, 0.1], [0.0, 0.1]]);
        let line = PlacedSegment::line([0.0, 0.0], [1.0, 0.0]);
        assert!(between(&hook, &line) > PI - 0.2);
        assert!(between(&there_and_back, &line) > 0.1);
    }
}
