//! Points and angles of the plane.

use std::f64::consts::{PI, TAU};

/// Distance of two points.
pub fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// Distance of a point from the segment between two points.
pub fn from_segment(point: [f64; 2], [a, b]: [[f64; 2]; 2]) -> f64 {
    let [side, away] = [b, point].map(|end| [end[0] - a[0], end[1] - a[1]]);
    let square = side[0] * side[0] + side[1] * side[1];
    let share = if square > 0.0 { ((away[0] * side[0] + away[1] * side[1]) / square).clamp(0.0, 1.0) } else { 0.0 };
    distance(away, side.map(|x| x * share))
}

/// The same angle from -π to less than π.
pub fn wrapped(angle: f64) -> f64 {
    (angle + PI).rem_euclid(TAU) - PI
}

/// The same angle from more than -π to π: half a turn is to the left. Small angles above 0 keep their digits.
pub fn within_half_turn(angle: f64) -> f64 {
    let rest = angle.rem_euclid(TAU);
    if rest > PI { rest - TAU } else { rest }
}

/// Above 0 where the way from `a` over `b` to `c` turns left.
pub fn turn(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// The corners of the convex hull, counter-clockwise (Andrew's monotone chain).
pub fn hull(mut points: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    points.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    points.dedup();
    let half = |points: &mut dyn Iterator<Item = [f64; 2]>| {
        let mut chain: Vec<[f64; 2]> = Vec::new();
        for point in points {
            while let [.., a, b] = chain[..]
                && turn(a, b, point) <= 0.0
            {
                chain.pop();
            }
            chain.push(point);
        }
        // The last one is the first of the other half.
        chain.pop();
        chain
    };
    let mut whole = half(&mut points.iter().copied());
    whole.extend(half(&mut points.iter().rev().copied()));
    whole
}

/// Leaves out the corners of a convex polygon that are no farther than `near` \[m\] from the line between their neighbours, one after the
/// other, as long as there are more than three.
pub fn drop_needless(corners: &mut Vec<[f64; 2]>, near: f64) {
    while corners.len() > 3 {
        let count = corners.len();
        let off = |k: usize| from_segment(corners[k], [corners[(k + count - 1) % count], corners[(k + 1) % count]]);
        let least = (0..count).min_by(|&a, &b| off(a).total_cmp(&off(b))).filter(|&k| off(k) <= near);
        let Some(needless) = least else { break };
        corners.remove(needless);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_hull_has_the_outer_corners_counter_clockwise() {
        let points = vec![[0.0, 0.0], [2.0, 0.0], [1.0, 0.0], [1.0, 0.5], [2.0, 2.0], [0.0, 2.0], [0.0, 0.0]];
        assert_eq!(hull(points), [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]]);
    }
}
