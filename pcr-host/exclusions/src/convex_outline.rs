//! Convex polygons that contain corridors.

use pcr_formats::plane_geometry::{hull, turn};
use pcr_formats::scenario::PathSegment;
use pcr_formats::scenario::PlacedSegment;
use pcr_planning::exclusion_table::SweptShape;
use std::f64::consts::{PI, TAU};

/// Corners of the polygon around a disc.
const CORNERS: usize = 16;

/// Discs of a smaller radius have squares around them \[m\].
const SMALL: f64 = 2e-3;

/// Arcs are cut into parts that turn by no more than this \[rad\].
const TURN: f64 = PI / 12.0;

/// The convex polygon around discs of this radius \[m\] everywhere on a curve, counter-clockwise. It contains them all, and reaches no
/// farther than 2 % of the radius beyond the hull of a straight corridor.
pub(crate) fn around(curve: &[PlacedSegment], radius: f64) -> Vec<[f64; 2]> {
    hull(curve.iter().flat_map(corners).flat_map(|at| disc(at, radius, CORNERS)).collect())
}

/// The corners of a regular polygon around a disc.
fn disc([x, y]: [f64; 2], radius: f64, corners: usize) -> impl Iterator<Item = [f64; 2]> {
    let reach = radius / (PI / corners as f64).cos();
    (0..corners).map(move |k| {
        let angle = TAU * (k as f64 + 0.5) / corners as f64;
        [x + reach * angle.cos(), y + reach * angle.sin()]
    })
}

/// The convex polygon around some swept shapes and all within a distance of them \[m\], counter-clockwise. It reaches beyond their hull by
/// no more than 2 % of the distance and of their growth, or by half of both where these are less than 2 mm.
pub(crate) fn around_swept(shapes: &[SweptShape], distance: f64) -> Vec<[f64; 2]> {
    let mut points = Vec::new();
    for shape in shapes {
        let (corners, radius): (Vec<[f64; 2]>, f64) = match shape {
            SweptShape::Stroke(curve, radius) => (curve.iter().flat_map(corners).collect(), *radius),
            SweptShape::Area(polygon, growth) => (polygon.clone(), *growth),
        };
        let far = radius + distance;
        // What is hardly larger than its corners needs no round ones.
        let count = if far < SMALL { 4 } else { CORNERS };
        points.extend(corners.into_iter().flat_map(|at| disc(at, far, count)));
    }
    hull(points)
}

/// Points whose convex hull contains a piece.
fn corners(piece: &PlacedSegment) -> Vec<[f64; 2]> {
    let PathSegment::Arc { radius, sweep, .. } = piece.shape else { return vec![piece.start, piece.end()] };
    let parts = (sweep.abs() / TURN).ceil().max(1.0);
    let mut corners = vec![piece.start];
    for k in 0..parts as usize {
        let to = |share: f64| PlacedSegment { shape: PathSegment::arc(radius, sweep * share), ..*piece };
        let begin = to(k as f64 / parts);
        // An arc lies in the triangle of its ends and the point in which its tangents meet.
        let tangent = radius * (sweep.abs() / parts / 2.0).tan();
        let ([x, y], heading) = (begin.end(), begin.heading_at_end());
        corners.push([x + tangent * heading.cos(), y + tangent * heading.sin()]);
        corners.push(to((k + 1) as f64 / parts).end());
    }
    corners
}

/// Distance of a point from a polygon, of any shape; 0 inside \[m\].
pub(crate) fn distance(polygon: &[[f64; 2]], at: [f64; 2]) -> f64 {
    (-depth(polygon, at)).max(0.0)
}

/// Distance of a point in a polygon, of any shape, from its sides; below 0 outside \[m\]. Where sides cross, what is inside twice is
/// outside.
pub(crate) fn depth(polygon: &[[f64; 2]], [x, y]: [f64; 2]) -> f64 {
    let mut inside = false;
    let mut least = f64::INFINITY;
    for (k, &b) in polygon.iter().enumerate() {
        let a = polygon[(k + polygon.len() - 1) % polygon.len()];
        let [dx, dy] = [b[0] - a[0], b[1] - a[1]];
        if (a[1] > y) != (b[1] > y) && x < a[0] + dx * (y - a[1]) / dy {
            inside = !inside;
        }
        let square = dx * dx + dy * dy;
        let share = if square > 0.0 { (((x - a[0]) * dx + (y - a[1]) * dy) / square).clamp(0.0, 1.0) } else { 0.0 };
        least = least.min((a[0] + dx * share - x).hypot(a[1] + dy * share - y));
    }
    if inside { least } else { -least }
}

/// Whether two polygons of any shape have a point in common.
pub(crate) fn intersect(a: &[[f64; 2]], b: &[[f64; 2]]) -> bool {
    let (Some(&first_a), Some(&first_b)) = (a.first(), b.first()) else { return false };
    distance(a, first_b) <= 0.0 || distance(b, first_a) <= 0.0 || sides_meet(a, b)
}

/// Whether sides of two polygons of any shape have a point in common.
pub(crate) fn sides_meet(a: &[[f64; 2]], b: &[[f64; 2]]) -> bool {
    if a.is_empty() || b.is_empty() {
        return false;
    }
    let sides = |polygon: &'_ [[f64; 2]]| {
        let last = polygon.len() - 1;
        (0..polygon.len()).map(|k| [polygon[if k == 0 { last } else { k - 1 }], polygon[k]]).collect::<Vec<_>>()
    };
    let crosses = |[a, b]: [[f64; 2]; 2], [c, d]: [[f64; 2]; 2]| {
        // A side that begins on another one counts as well.
        turn(a, b, c) * turn(a, b, d) <= 0.0
            && turn(c, d, a) * turn(c, d, b) <= 0.0
            && (0..2).all(|k| a[k].min(b[k]) <= c[k].max(d[k]) && c[k].min(d[k]) <= a[k].max(b[k]))
    };
    let others = sides(b);
    sides(a).into_iter().any(|own| others.iter().any(|&other| crosses(own, other)))
}

/// How deep two convex polygons overlap, each enlarged so that both together grow by `room`, and a point of both \[m\]: the length of the
/// least translation across a side of either; `None` if they are apart.
pub(crate) fn overlap([a, b]: [&[[f64; 2]]; 2], room: f64) -> Option<(f64, [f64; 2])> {
    let beyond = |own: &[[f64; 2]], other: &[[f64; 2]]| {
        let sides = own.iter().zip(own.iter().cycle().skip(1));
        let gaps = sides.filter_map(|(from, to)| {
            let [dx, dy] = [to[0] - from[0], to[1] - from[1]];
            let length = dx.hypot(dy);
            // Counter-clockwise, so outward is to the right.
            let out = |point: &[f64; 2]| ((point[0] - from[0]) * dy - (point[1] - from[1]) * dx) / length;
            (length > 0.0).then(|| other.iter().map(out).fold(f64::INFINITY, f64::min))
        });
        gaps.fold(f64::NEG_INFINITY, f64::max)
    };
    let depth = room - beyond(a, b).max(beyond(b, a));
    let nearer = |polygon: &[[f64; 2]], other: &[[f64; 2]]| {
        polygon.iter().copied().min_by(|p, q| distance(other, *p).total_cmp(&distance(other, *q)))
    };
    let inside = |polygon: &[[f64; 2]], other: &[[f64; 2]]| {
        let own = polygon.iter().filter(|corner| self::depth(other, **corner) >= 0.0).copied();
        own.collect::<Vec<_>>()
    };
    let mut common = inside(a, b);
    common.extend(inside(b, a));
    if common.is_empty() {
        common.extend([nearer(a, b)?, nearer(b, a)?]);
    }
    let count = common.len() as f64;
    let at = [0, 1].map(|axis| common.iter().map(|point| point[axis]).sum::<f64>() / count);
    (depth >= 0.0).then_some((depth, at))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stretch;

    #[test]
    fn the_polygon_contains_all_discs() {
        let arc = PlacedSegment { start: [1.0, 2.0], heading: 0.3, shape: PathSegment::arc(2.0, -1.9) };
        for curve in [
            vec![PlacedSegment::line([0.0, 0.0], [3.0, 1.0])],
            vec![arc],
            vec![PlacedSegment::line([1.0, 1.0], [1.0, 1.0])],
        ] {
            let polygon = around(&curve, 0.5);
            let length: f64 = curve.iter().map(|piece| piece.shape.length()).sum();
            for k in 0..=50 {
                let [x, y] = stretch(&curve, [length * f64::from(k) / 50.0; 2])[0].start;
                for step in 0..100 {
                    let angle = TAU * f64::from(step) / 100.0;
                    let rim = [x + 0.5 * angle.cos(), y + 0.5 * angle.sin()];
                    assert!(distance(&polygon, rim) < 1e-9, "{curve:?} {rim:?}");
                }
            }
            let sides = polygon.iter().enumerate();
            assert!(sides.clone().all(|(k, &b)| {
                let n = polygon.len();
                turn(polygon[(k + n - 1) % n], b, polygon[(k + 1) % n]) > 0.0
            }));
        }
    }

    #[test]
    fn overlaps_are_those_of_squares() {
        let square = |x: f64, y: f64| [[x, y], [x + 1.0, y], [x + 1.0, y + 1.0], [x, y + 1.0]];
        let (depth, at) = overlap([&square(0.0, 0.0), &square(0.75, 0.5)], 0.0).unwrap();
        assert_eq!((depth, at), (0.25, [0.875, 0.75]));
        assert_eq!(overlap([&square(0.0, 0.0), &square(1.5, 0.0)], 0.0), None);
        let (depth, at) = overlap([&square(0.0, 0.0), &square(1.5, 0.0)], 0.75).unwrap();
        assert!((depth - 0.25).abs() < 1e-15 && (0.9..=1.6).contains(&at[0]), "{depth} {at:?}");
    }

    #[test]
    fn distances_and_common_points_are_those_of_squares() {
        let square = |x: f64| vec![[x, 0.0], [x + 1.0, 0.0], [x + 1.0, 1.0], [x, 1.0]];
        assert_eq!(distance(&square(0.0), [2.0, 0.5]), 1.0);
        assert_eq!(distance(&square(0.0), [0.5, 0.5]), 0.0);
        assert!(intersect(&square(0.0), &square(0.5)) && intersect(&square(0.0), &square(1.0)));
        assert!(!intersect(&square(0.0), &square(1.01)));
        assert!(intersect(&square(0.0), &[[-1.0, 0.4], [3.0, 0.4], [3.0, 0.6]]));
        assert!(intersect(&square(0.0), &[[-1.0, -1.0], [3.0, -1.0], [3.0, 3.0], [-1.0, 3.0]]));
        // Nothing in common but a corner, which is not the first one.
        let corner = [[2.0, 0.0], [2.0, 1.0], [1.0, 0.5]];
        assert!(intersect(&square(0.0), &corner) && intersect(&corner, &square(0.0)));
    }
}
