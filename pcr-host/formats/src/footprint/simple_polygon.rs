//! Whether a polygon is simple: no two of its sides touch or cross, except neighbours at their common corner.
//!
//! A part without width, such as a fork drawn as a line there and back, has no area.

use super::FootprintError;
use crate::plane_geometry::{distance, from_segment, turn};

/// Share of the largest coordinate within which points are one: far above rounding, far below what matters of a vehicle.
const NEAR: f64 = 1e-9;

/// What is wrong with a polygon that is not simple, or has no area.
pub(super) fn fault(polygon: &[[f64; 2]]) -> Option<FootprintError> {
    let near = NEAR * polygon.iter().flatten().fold(0.0, |most: f64, x| most.max(x.abs()));
    let corners = distinct_corners(polygon, near);
    if corners.len() < 3 {
        return Some(FootprintError::NoArea);
    }
    let count = corners.len();
    let side = |k: usize| [corners[k % count], corners[(k + 1) % count]];
    for k in 0..count {
        for other in k + 1..count {
            let meet = match () {
                () if other == k + 1 => folds([side(k)[0].1, side(k)[1].1, side(other)[1].1], near),
                () if k == 0 && other + 1 == count => folds([side(other)[0].1, side(0)[0].1, side(0)[1].1], near),
                () => touch([side(k), side(other)].map(|ends| ends.map(|end| end.1)), near),
            };
            if meet {
                let sides = [side(k), side(other)].map(|ends| ends.map(|end| end.0 + 1));
                return Some(FootprintError::SidesMeet(sides));
            }
        }
    }
    None
}

/// The corners with their places in the polygon, those at the place of the one before left out.
fn distinct_corners(polygon: &[[f64; 2]], near: f64) -> Vec<(usize, [f64; 2])> {
    let mut corners: Vec<(usize, [f64; 2])> = Vec::new();
    for (place, &corner) in polygon.iter().enumerate() {
        if corners.last().is_none_or(|last| distance(last.1, corner) > near) {
            corners.push((place, corner));
        }
    }
    // Many files give the first corner again at the end.
    while let [first, .., last] = corners[..]
        && distance(first.1, last.1) <= near
    {
        corners.pop();
    }
    corners
}

/// Whether the second of two sides, from a corner to a corner to a corner, lies on the first one.
fn folds([a, b, c]: [[f64; 2]; 3], near: f64) -> bool {
    let back = (a[0] - b[0]) * (c[0] - b[0]) + (a[1] - b[1]) * (c[1] - b[1]) > 0.0;
    back && from_segment(a, [b, c]).min(from_segment(c, [a, b])) <= near
}

/// Whether two sides without a common corner have a common point.
fn touch([first, second]: [[[f64; 2]; 2]; 2], near: f64) -> bool {
    let parted = |[a, b]: [[f64; 2]; 2], ends: [[f64; 2]; 2]| {
        let [c, d] = ends.map(|end| turn(a, b, end));
        (c > 0.0) != (d > 0.0)
    };
    let ends =
        first.iter().map(|end| from_segment(*end, second)).chain(second.iter().map(|end| from_segment(*end, first)));
    ends.fold(f64::INFINITY, f64::min) <= near || (parted(first, second) && parted(second, first))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sides_that_touch_or_cross_are_named() {
        let sides = |first, second| Some(FootprintError::SidesMeet([first, second]));
        // A fork drawn as a line there and back.
        let fork = [[-0.5, -0.3], [0.5, -0.3], [0.5, 0.2], [1.5, 0.2], [0.5, 0.2], [0.5, 0.3], [-0.5, 0.3]];
        assert_eq!(fault(&fork), sides([2, 3], [4, 5]));
        // Two lines from one corner; a line; a bow tie; a square whose corner touches a side; a square with a spike at its last corner.
        assert_eq!(fault(&[[0.0, 0.0], [1.0, 0.0], [0.0, 0.0], [0.0, 1.0]]), sides([1, 2], [2, 3]));
        assert_eq!(fault(&[[0.0, 0.0], [1.0, 1.0], [2.0, 2.0]]), sides([1, 2], [3, 1]));
        assert_eq!(fault(&[[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]]), sides([1, 2], [3, 4]));
        let pinched = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [1.0, 0.0], [0.0, 2.0]];
        assert_eq!(fault(&pinched), sides([1, 2], [3, 4]));
        let spiked = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.0, 0.0], [0.0, -1.0]];
        assert_eq!(fault(&spiked), sides([1, 2], [4, 5]));
        assert_eq!(fault(&[[1.0, 2.0], [1.0, 2.0], [3.0, 4.0], [1.0, 2.0]]), Some(FootprintError::NoArea));
        // Nine million kilometres away, at two places of the number format.
        let far = [9e9, 9e9 + 4e-6];
        assert_eq!(fault(&[[far[0], far[0]], [far[1], far[0]], [far[1], far[1]]]), Some(FootprintError::NoArea));
    }

    #[test]
    fn corners_that_are_repeated_or_on_a_side_are_none_of_that() {
        let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 0.0], [1.0, 0.5], [1.0, 1.0], [0.3, 1.0], [0.0, 1.0], [0.0, 0.0]];
        assert_eq!(fault(&square), None);
        let rounded = [[0.0, 0.0], [1.0, 0.0], [1.0 + 1e-13, 1e-13], [1.0 - 1e-14, 0.5], [1.0, 1.0], [0.0, 1.0]];
        assert_eq!(fault(&rounded), None);
        // A needle, a comb and a spiral are simple.
        assert_eq!(fault(&[[0.0, 0.0], [1.0, 0.0], [0.0, 1e-3]]), None);
        let comb = [[0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [2.0, 1.0], [2.0, 0.1], [1.0, 0.1], [1.0, 1.0], [0.0, 1.0]];
        assert_eq!(fault(&comb), None);
    }
}
