//! The lengths of a curve at which its points are near a polygon, or deep in it.
//!
//! Whether a point is near enough changes only at a given distance from a side or a corner. All such lengths are roots in
//! closed form. All points between two successive roots are near enough or none is, which the point in their middle tells. If
//! rounding misses a pair of roots, the contact between them is shallower than the rounding.

use crate::convex_outline::depth;
use crate::nearest::point;
use pcr_formats::scenario::{PathSegment, PlacedSegment};
use pcr_planning::exclusion_table::is_turn;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Roots that differ by at most this are equal \[m\].
const SAME: f64 = 1e-9;

/// Lengths of a curve at which its points are no farther than `reach` from a polygon of any shape; a negative `reach` means
/// that points are at least that deep inside \[m\]. In ascending order; ranges of successive pieces are joined.
pub(crate) fn lengths_near_polygon(curve: &[PlacedSegment], polygon: &[[f64; 2]], reach: f64) -> Vec<[f64; 2]> {
    let mut ranges: Vec<[f64; 2]> = Vec::new();
    let mut before = 0.0;
    for piece in curve {
        let length = piece.shape.length();
        let mut cuts = roots(piece, polygon, reach.abs());
        cuts.retain(|cut| *cut > SAME && *cut < length - SAME);
        cuts.sort_by(f64::total_cmp);
        cuts.dedup_by(|next, last| *next - *last < SAME);
        cuts.insert(0, 0.0);
        cuts.push(length);
        for pair in cuts.windows(2) {
            if -depth(polygon, point(piece, (pair[0] + pair[1]) / 2.0)) > reach {
                continue;
            }
            let [from, to] = [before + pair[0], before + pair[1]];
            match ranges.last_mut() {
                Some(last) if last[1] == from => last[1] = to,
                _ => ranges.push([from, to]),
            }
        }
        before += length;
    }
    ranges
}

/// Lengths of a path at which the placed outline of a vehicle that faces along it passes a test; in ascending order, ranges of successive
/// pieces are joined. `path` is where the reference point goes, and the corners of the outline are ahead and left of it. What is tested
/// may change only where a corner of the outline is at one of the distances `far` from a side or corner of the polygon, or a corner of the
/// polygon from one of the outline.
///
/// A turn in place has no length. It is within a range where the outline passes the test in all of it, ends a range where it does not pass in
/// all of it, and is a range where it passes in some of it. Of a path that is one turn the angles are returned at which it passes.
pub(crate) fn lengths_of_outline(
    path: &[PlacedSegment],
    outline: &[[f64; 2]],
    polygon: &[[f64; 2]],
    far: &[f64],
    passes: impl Fn(&[[f64; 2]]) -> bool,
) -> Vec<[f64; 2]> {
    if let [turn] = path
        && is_turn(turn)
    {
        return parts_of_outline(turn, outline, polygon, far, passes);
    }
    let mut ranges: Vec<[f64; 2]> = Vec::new();
    let (mut before, mut ends_here, mut facing) = (0.0, false, 0.0);
    for piece in path {
        // As the vehicle faces where the piece begins.
        let at_start = facing;
        facing = piece.shape.facing_after(at_start);
        let placed: Vec<[f64; 2]>;
        let outline = match at_start {
            0.0 => outline,
            angle => {
                placed = outline.iter().map(|&corner| turned(corner, angle)).collect();
                &placed
            }
        };
        let mut parts = parts_of_outline(piece, outline, polygon, far, &passes);
        let is_whole = matches!(parts[..], [[from, to]] if from == 0.0 && to == extent(piece));
        if is_turn(piece) {
            ends_here |= !is_whole;
            parts.truncate(1);
            parts.iter_mut().for_each(|part| *part = [0.0; 2]);
        }
        for [from, to] in parts.into_iter().map(|part| part.map(|at| before + at)) {
            match ranges.last_mut() {
                Some(last) if last[1] == from && (!ends_here || from == to) => last[1] = to,
                _ => ranges.push([from, to]),
            }
        }
        if !is_turn(piece) && extent(piece) > 0.0 {
            ends_here = false;
        }
        before += piece.shape.length();
    }
    ranges
}

/// Whether the vehicle keeps its heading on an arc.
fn is_steady(piece: &PlacedSegment) -> bool {
    matches!(piece.shape, PathSegment::Arc { steady: true, .. })
}

/// Length of a piece \[m\], or the angle of a turn in place.
fn extent(piece: &PlacedSegment) -> f64 {
    if is_turn(piece) { piece.shape.sweep().abs() } else { piece.shape.length() }
}

/// The part of a piece up to a length, or of a turn in place up to an angle.
fn first_part(piece: &PlacedSegment, at: f64) -> PlacedSegment {
    if !is_turn(piece) {
        return piece.part(0.0, at);
    }
    PlacedSegment { shape: PathSegment::Turn { sweep: at.copysign(piece.shape.sweep()) }, ..*piece }
}

/// Lengths of one piece, or angles of a turn in place, at which the outline passes the test, in ascending order.
fn parts_of_outline(
    piece: &PlacedSegment,
    outline: &[[f64; 2]],
    polygon: &[[f64; 2]],
    far: &[f64],
    passes: impl Fn(&[[f64; 2]]) -> bool,
) -> Vec<[f64; 2]> {
    let mut ranges: Vec<[f64; 2]> = Vec::new();
    let length = extent(piece);
    let mut cuts = Vec::new();
    for &far in far {
        let mut add = |ways: &mut dyn Iterator<Item = PlacedSegment>, other: &[[f64; 2]]| {
            for way in ways {
                let share = length / way.shape.length();
                if share.is_finite() {
                    cuts.extend(roots(&way, other, far.abs()).into_iter().map(|at| at * share));
                }
            }
        };
        add(&mut outline.iter().map(|&corner| carried(piece, corner)), polygon);
        add(&mut polygon.iter().map(|&corner| seen(piece, corner)), outline);
    }
    let same = SAME.min(length / 1e6);
    cuts.retain(|cut| *cut > same && *cut < length - same);
    cuts.sort_by(f64::total_cmp);
    cuts.dedup_by(|next, last| *next - *last < same);
    cuts.insert(0, 0.0);
    cuts.push(length);
    for pair in cuts.windows(2) {
        let part = first_part(piece, (pair[0] + pair[1]) / 2.0);
        let (at, heading) = (part.end(), if is_steady(piece) { piece.heading } else { part.heading_at_end() });
        let placed: Vec<[f64; 2]> = outline.iter().map(|&corner| moved(at, turned(corner, heading))).collect();
        if !passes(&placed) {
            continue;
        }
        let [from, to] = [pair[0], pair[1]];
        match ranges.last_mut() {
            Some(last) if last[1] == from => last[1] = to,
            _ => ranges.push([from, to]),
        }
    }
    ranges
}

fn moved([x, y]: [f64; 2], by: [f64; 2]) -> [f64; 2] {
    [x + by[0], y + by[1]]
}

fn turned([x, y]: [f64; 2], angle: f64) -> [f64; 2] {
    let (sin, cos) = angle.sin_cos();
    [x * cos - y * sin, x * sin + y * cos]
}

/// The way of a corner of the outline where its reference point travels a piece.
fn carried(piece: &PlacedSegment, corner: [f64; 2]) -> PlacedSegment {
    let start = moved(piece.start, turned(corner, piece.heading));
    match piece.shape {
        PathSegment::Arc { sweep, steady: false, .. } => about(start, centre(piece), sweep),
        PathSegment::Turn { sweep } | PathSegment::Kink { sweep } => about(start, piece.start, sweep),
        // It does not turn.
        PathSegment::Line { .. } | PathSegment::Facing { .. } | PathSegment::Arc { .. } => {
            PlacedSegment { start, ..*piece }
        }
    }
}

/// The way of a point as it is seen from a vehicle that travels a piece.
fn seen(piece: &PlacedSegment, point: [f64; 2]) -> PlacedSegment {
    let from = |at: [f64; 2]| turned([at[0] - piece.start[0], at[1] - piece.start[1]], -piece.heading);
    match piece.shape {
        PathSegment::Arc { sweep, steady: false, .. } => about(from(point), from(centre(piece)), -sweep),
        PathSegment::Line { .. } | PathSegment::Facing { .. } | PathSegment::Arc { .. } => {
            PlacedSegment { start: from(point), heading: PI, shape: piece.shape }
        }
        PathSegment::Turn { sweep } | PathSegment::Kink { sweep } => about(from(point), [0.0; 2], -sweep),
    }
}

/// The arc of a point that is turned about another one.
fn about(start: [f64; 2], centre: [f64; 2], sweep: f64) -> PlacedSegment {
    let away = [start[0] - centre[0], start[1] - centre[1]];
    let heading = away[1].atan2(away[0]) + FRAC_PI_2.copysign(sweep);
    PlacedSegment { start, heading, shape: PathSegment::arc(away[0].hypot(away[1]), sweep) }
}

/// Lengths of a piece at which its distance from the line of a side, beside the side, or from a corner is `far`.
fn roots(piece: &PlacedSegment, polygon: &[[f64; 2]], far: f64) -> Vec<f64> {
    let mut roots = Vec::new();
    let count = polygon.len();
    for (k, &b) in polygon.iter().enumerate() {
        let (a, c) = (polygon[(k + count - 1) % count], polygon[(k + 1) % count]);
        let side = [b[0] - a[0], b[1] - a[1]];
        let long = side[0].hypot(side[1]);
        if long > 0.0 {
            let normal = [-side[1] / long, side[0] / long];
            for off in [far, -far] {
                let from = [a[0] + off * normal[0], a[1] + off * normal[1]];
                roots.extend(on_line(piece, from, normal).into_iter().filter(|&at| {
                    let [x, y] = point(piece, at);
                    let along = ((x - a[0]) * side[0] + (y - a[1]) * side[1]) / long;
                    (-SAME..=long + SAME).contains(&along)
                }));
            }
        }
        // Beside a side, the line of the side is nearer than its ends.
        let beyond = |[x, y]: [f64; 2], other: [f64; 2]| {
            (x - b[0]) * (other[0] - b[0]) + (y - b[1]) * (other[1] - b[1]) <= SAME * (1.0 + far)
        };
        roots.extend(on_circle(piece, b, far).into_iter().filter(|&at| {
            let at = point(piece, at);
            beyond(at, a) && beyond(at, c)
        }));
    }
    roots
}

/// Lengths at which a piece meets the line through a point with this unit normal.
fn on_line(piece: &PlacedSegment, through: [f64; 2], normal: [f64; 2]) -> Vec<f64> {
    let off = |[x, y]: [f64; 2]| normal[0] * (x - through[0]) + normal[1] * (y - through[1]);
    match piece.shape {
        PathSegment::Line { length } => {
            let slope = normal[0] * piece.heading.cos() + normal[1] * piece.heading.sin();
            let at = -off(piece.start) / slope;
            // A parallel line does not change sides.
            if (0.0..=length).contains(&at) { vec![at] } else { Vec::new() }
        }
        PathSegment::Arc { radius, .. } => {
            let cosine = -off(centre(piece)) / radius;
            if cosine.abs() > 1.0 {
                return Vec::new();
            }
            let (middle, half) = (normal[1].atan2(normal[0]), cosine.acos());
            on_arc(piece, [middle - half, middle + half])
        }
        _ => Vec::new(),
    }
}

/// Lengths at which a piece meets a circle.
fn on_circle(piece: &PlacedSegment, [x, y]: [f64; 2], far: f64) -> Vec<f64> {
    match piece.shape {
        PathSegment::Line { length } => {
            let (gap, along) = ([x - piece.start[0], y - piece.start[1]], [piece.heading.cos(), piece.heading.sin()]);
            let middle = gap[0] * along[0] + gap[1] * along[1];
            let beside = gap[0] * along[1] - gap[1] * along[0];
            if beside.abs() > far {
                return Vec::new();
            }
            let half = ((far - beside) * (far + beside)).sqrt();
            [middle - half, middle + half].into_iter().filter(|at| (0.0..=length).contains(at)).collect()
        }
        PathSegment::Arc { radius, .. } => {
            let from = centre(piece);
            let gap = [x - from[0], y - from[1]];
            let apart = gap[0].hypot(gap[1]);
            let cosine = (apart + (radius - far) * (radius + far) / apart) / (2.0 * radius);
            // Concentric circles do not cross.
            if cosine.is_nan() || cosine.abs() > 1.0 {
                return Vec::new();
            }
            let (middle, half) = (gap[1].atan2(gap[0]), cosine.acos());
            on_arc(piece, [middle - half, middle + half])
        }
        _ => Vec::new(),
    }
}

/// Centre of an arc, or start of a line.
fn centre(piece: &PlacedSegment) -> [f64; 2] {
    let PathSegment::Arc { radius, sweep, .. } = piece.shape else { return piece.start };
    let to = piece.heading + FRAC_PI_2.copysign(sweep);
    [piece.start[0] + radius * to.cos(), piece.start[1] + radius * to.sin()]
}

/// Lengths of an arc at these directions from its centre.
fn on_arc(piece: &PlacedSegment, directions: [f64; 2]) -> Vec<f64> {
    let PathSegment::Arc { radius, sweep, .. } = piece.shape else { return Vec::new() };
    let first = piece.heading - FRAC_PI_2.copysign(sweep);
    let mut lengths = Vec::new();
    for direction in directions {
        let mut turned = ((direction - first) * sweep.signum()).rem_euclid(TAU);
        while turned <= sweep.abs() {
            lengths.push(radius * turned);
            turned += TAU;
        }
    }
    lengths
}

#[cfg(test)]
mod tests {
    use super::*;
    use pcr_formats::splitmix64::SplitMix64;

    /// A star, mostly not convex, around a point.
    fn star(random: &mut SplitMix64, corners: usize) -> Vec<[f64; 2]> {
        let corner = |k: usize| {
            let (angle, far) = (TAU * k as f64 / corners as f64, random.uniform(0.3, 3.0));
            [far * angle.cos(), far * angle.sin()]
        };
        (0..corners).map(corner).collect()
    }

    #[test]
    fn lengths_are_those_of_samples() {
        let mut random = SplitMix64(3);
        let (mut inside, mut outside) = (0, 0);
        for case in 0..400 {
            let polygon = star(&mut random, 3 + case % 6);
            let at = [random.uniform(-3.0, 3.0), random.uniform(-3.0, 3.0)];
            let heading = random.uniform(-3.0, 3.0);
            let (radius, sweep) = (random.uniform(0.2, 4.0), random.uniform(-7.0, 7.0));
            let line =
                PlacedSegment { start: at, heading, shape: PathSegment::Line { length: random.uniform(0.0, 6.0) } };
            let arc = PlacedSegment { start: line.end(), heading, shape: PathSegment::arc(radius, sweep) };
            let curve = [line, arc];
            for reach in [-0.4, -1e-3, 0.0, 0.05, 0.7] {
                let ranges = lengths_near_polygon(&curve, &polygon, reach);
                assert!(ranges.windows(2).all(|pair| pair[0][1] < pair[1][0]), "{ranges:?}");
                let lengths = curve.map(|piece| piece.shape.length());
                let total = lengths[0] + lengths[1];
                for k in 0..=500 {
                    let length = (total * f64::from(k) / 500.0).min(total);
                    let at = if length <= lengths[0] { point(&line, length) } else { point(&arc, length - lengths[0]) };
                    let off = -depth(&polygon, at);
                    if (off - reach).abs() < 1e-7 {
                        continue;
                    }
                    let found = ranges.iter().any(|[from, to]| (*from..=*to).contains(&length));
                    assert_eq!(found, off < reach, "{curve:?} {polygon:?} {reach} {length}");
                    if found { inside += 1 } else { outside += 1 }
                }
            }
        }
        assert!(inside > 50_000 && outside > 50_000, "{inside} {outside}");
    }

    #[test]
    fn a_turn_in_place_reaches_what_is_beside_it() {
        // A beam turns by half a turn beside a wall, which its ends reach in between only.
        let beam = [[-1.0, -0.1], [1.0, -0.1], [1.0, 0.1], [-1.0, 0.1]];
        let wall = |y: f64| [[-5.0, y], [5.0, y], [5.0, y + 1.0], [-5.0, y + 1.0]];
        let line = |from: f64| PlacedSegment::line([from, 0.0], [from + 2.0, 0.0]);
        let turn = PlacedSegment { shape: PathSegment::Turn { sweep: PI }, ..line(2.0) };
        let away = PlacedSegment { heading: PI, ..line(2.0) };
        let lengths = |path: &[PlacedSegment], y: f64| {
            let wall = wall(y);
            let meets = |placed: &[[f64; 2]]| placed.iter().any(|&corner| depth(&wall, corner) >= 0.0);
            lengths_of_outline(path, &beam, &wall, &[0.0], meets)
        };
        // The corner at (1, 0.1) is at 0.9 m and comes back there.
        let angles = lengths(&[turn], 0.9);
        let [from, to] = [angles[0][0], angles[angles.len() - 1][1]];
        let reached = (0.9 / 1.01_f64.sqrt()).asin() - 0.1_f64.atan2(1.0);
        assert!((from - reached).abs() < 1e-9 && (to - (PI - reached)).abs() < 1e-9, "{angles:?} {reached}");
        assert_eq!(lengths(&[line(0.0), turn, away], 0.9), [[2.0; 2]]);
        assert_eq!(lengths(&[line(0.0), turn, away], 1.01), [] as [[f64; 2]; 0]);
        // All the way, and a turn that is not wholly within parts it.
        assert_eq!(lengths(&[line(0.0), turn, away], 0.05), [[0.0, 4.0]]);
        let inside = |placed: &[[f64; 2]]| placed.iter().all(|&corner| depth(&wall(-0.5), corner) >= 0.0);
        let parted = lengths_of_outline(&[line(0.0), turn, away], &beam, &wall(-0.5), &[0.0], inside);
        assert_eq!(parted, [[0.0, 2.0], [2.0, 4.0]]);
    }

    #[test]
    fn a_curve_along_the_border_is_within_as_a_whole() {
        let square = [[-1.0, -0.5], [3.0, -0.5], [3.0, 0.5], [-1.0, 0.5]];
        let there =
            |y: f64, reach: f64| lengths_near_polygon(&[PlacedSegment::line([0.0, y], [2.0, y])], &square, reach);
        assert_eq!(there(0.0, -0.5), [[0.0, 2.0]]);
        assert_eq!(there(0.0, -0.5 - 1e-9), [] as [[f64; 2]; 0]);
        assert_eq!(there(0.9, 0.4 + 1e-9), [[0.0, 2.0]]);
        assert_eq!(there(0.9, 0.4 - 1e-9), [] as [[f64; 2]; 0]);
        // A point.
        assert_eq!(lengths_near_polygon(&[PlacedSegment::line([0.0, 0.0], [0.0, 0.0])], &square, 0.0), [[0.0, 0.0]]);
        assert_eq!(
            lengths_near_polygon(&[PlacedSegment::line([0.0, 2.0], [0.0, 2.0])], &square, 1.0),
            [] as [[f64; 2]; 0]
        );
    }
}
