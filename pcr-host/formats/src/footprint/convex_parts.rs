//! Cuts a simple polygon into convex parts: its ears are clipped, and triangles are joined where the part stays convex (Hertel and
//! Mehlhorn 1983). There are at most four times as many parts as necessary.
//!
//! All cuts are between corners of the polygon, and on which side of a line a corner lies is decided exactly, so the parts are
//! together exactly the polygon.

use robust::{Coord, orient2d};

/// Corners of a part at most, as many as an outline of the core has.
const CORNERS: usize = 16;

/// Above 0 where the way from `a` over `b` to `c` turns left, 0 where it is straight; the sign is exact.
fn turn([a, b, c]: [[f64; 2]; 3]) -> f64 {
    let [a, b, c] = [a, b, c].map(|[x, y]| Coord { x, y });
    orient2d(a, b, c)
}

/// The convex parts of a simple polygon, counter-clockwise; `None` if it is not simple.
pub(super) fn convex_parts(polygon: &[[f64; 2]]) -> Option<Vec<Vec<[f64; 2]>>> {
    let mut corners = polygon.to_vec();
    corners.dedup();
    while corners.len() > 1 && corners.first() == corners.last() {
        corners.pop();
    }
    if lowest_turn(&corners)? < 0.0 {
        corners.reverse();
    }
    let whole: Vec<usize> = (0..corners.len()).collect();
    let mut parts = if is_convex(&corners, &whole) { vec![whole] } else { triangles(&corners)? };
    while let Some((first, second, whole)) = joint(&corners, &parts) {
        parts.swap_remove(second.max(first));
        parts[second.min(first)] = whole;
    }
    let places = parts.into_iter().flat_map(|part| cut(&bent(&corners, &part)));
    Some(places.map(|part| part.into_iter().map(|place| corners[place]).collect()).collect())
}

/// The turn at the lowest of the leftmost corners, which is that of the whole polygon.
fn lowest_turn(corners: &[[f64; 2]]) -> Option<f64> {
    let count = corners.len();
    let order = |a: &usize, b: &usize| {
        let [a, b] = [corners[*a], corners[*b]];
        a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1]))
    };
    let first = (0..count).min_by(order)?;
    Some(turn([corners[(first + count - 1) % count], corners[first], corners[(first + 1) % count]]))
}

/// Three corners by their places in the polygon.
fn triangles(corners: &[[f64; 2]]) -> Option<Vec<Vec<usize>>> {
    let mut left: Vec<usize> = (0..corners.len()).collect();
    let mut triangles = Vec::new();
    while left.len() > 3 {
        let count = left.len();
        let ear = (0..count).find(|&k| is_ear(corners, &left, k))?;
        let [before, after] = [left[(ear + count - 1) % count], left[(ear + 1) % count]];
        // A corner on the straight line between its neighbours has no triangle.
        if turn([before, left[ear], after].map(|place| corners[place])) > 0.0 {
            triangles.push(vec![before, left[ear], after]);
        }
        left.remove(ear);
    }
    if turn([left[0], left[1], left[2]].map(|place| corners[place])) > 0.0 {
        triangles.push(left);
    }
    Some(triangles)
}

/// Whether the triangle at a corner is within the rest of the polygon.
fn is_ear(corners: &[[f64; 2]], left: &[usize], k: usize) -> bool {
    let count = left.len();
    let [a, b, c] = [left[(k + count - 1) % count], left[k], left[(k + 1) % count]].map(|place| corners[place]);
    let own = turn([a, b, c]);
    if own < 0.0 {
        return false;
    }
    let others = left.iter().map(|&place| corners[place]).filter(|corner| ![a, b, c].contains(corner));
    let within = |at: [f64; 2]| turn([a, b, at]) >= 0.0 && turn([b, c, at]) >= 0.0 && turn([c, a, at]) >= 0.0;
    if own > 0.0 { !others.into_iter().any(within) } else { is_between(a, b, c) }
}

/// Whether a point on the line through two others is between them.
fn is_between(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> bool {
    (0..2).all(|axis| (a[axis].min(c[axis])..=a[axis].max(c[axis])).contains(&b[axis]))
}

/// Two parts with a common side whose union is convex, and the union.
fn joint(corners: &[[f64; 2]], parts: &[Vec<usize>]) -> Option<(usize, usize, Vec<usize>)> {
    for (first, part) in parts.iter().enumerate() {
        for (k, &from) in part.iter().enumerate() {
            let to = part[(k + 1) % part.len()];
            let opposite = |(second, other): (usize, &Vec<usize>)| {
                let place = (0..other.len()).find(|&j| other[j] == to && other[(j + 1) % other.len()] == from)?;
                // From the end of the common side round this part to its start, and on round the other one.
                let own = part.iter().cycle().skip(k + 1).take(part.len());
                let theirs = other.iter().cycle().skip(place + 2).take(other.len() - 2);
                let whole: Vec<usize> = own.chain(theirs).copied().collect();
                is_convex(corners, &whole).then_some((first, second, whole))
            };
            if let Some(found) = parts.iter().enumerate().filter(|(second, _)| *second != first).find_map(opposite) {
                return Some(found);
            }
        }
    }
    None
}

fn is_convex(corners: &[[f64; 2]], part: &[usize]) -> bool {
    let count = part.len();
    (0..count).all(|k| turn([part[k], part[(k + 1) % count], part[(k + 2) % count]].map(|place| corners[place])) >= 0.0)
}

/// A convex part without corners at which it goes straight on.
fn bent(corners: &[[f64; 2]], part: &[usize]) -> Vec<usize> {
    let around = |k: usize| [part[(k + part.len() - 1) % part.len()], part[k], part[(k + 1) % part.len()]];
    let turns = (0..part.len()).filter(|&k| turn(around(k).map(|place| corners[place])) > 0.0);
    turns.map(|k| part[k]).collect()
}

/// A convex part cut into such of at most [`CORNERS`] corners.
fn cut(part: &[usize]) -> Vec<Vec<usize>> {
    let mut parts = Vec::new();
    let mut next = 1;
    while let (Some(first), true) = (part.first(), next + 1 < part.len()) {
        let last = (next + CORNERS - 2).min(part.len() - 1);
        parts.push(std::iter::once(first).chain(&part[next..=last]).copied().collect());
        next = last;
    }
    parts
}
