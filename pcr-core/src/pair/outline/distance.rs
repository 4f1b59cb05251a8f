//! The distance of two placed convex polygons.
//!
//! If the polygons are apart, it is the least distance of a corner of one from an edge or a corner of the other. If they
//! are not, that value means nothing. They are apart if all of one lies beyond the line of an edge of the other, or if the line between the two
//! nearest corners separates them. Normals of edges alone would not do for capsules, which are flat. The line alone would not do either: if it is
//! short, rounding turns it, and a long edge beside it seems to be crossed.

use super::contacts::{between, direction_of};
use crate::geometry::{Direction, Vector};
use crate::outline::{Corner, opposite};
use crate::scalar::{Scalar, Wide};

/// The way from a corner of one polygon to the nearest point of the edges of another one.
struct Nearest<S: Scalar> {
    square: S::Wide,
    way: Vector<S>,
    /// The distance from the line of an edge, positive outside \[m\], and the outward normal of the edge; `None` if the nearest point is a corner.
    beside: Option<(S, Direction<S>)>,
}

/// Returns the signed distance of two polygons \[m\], if they overlap minus the length of the least translation that
/// separates them; the direction from the first to the second along which they are as far apart; and whether it is the normal of an
/// edge of the first one, or else of the second or of none.
///
/// Cost: twice the product of the numbers of corners, and a root.
pub(crate) fn separation_along<S: Scalar>(a: &[Corner<S>], b: &[Corner<S>]) -> (S, Direction<S>, bool) {
    match outside(a, b) {
        Some(apart) => apart,
        None => {
            let (depth, normal, is_of_first) = overlap(a, b);
            (depth.min(S::ZERO), normal, is_of_first)
        }
    }
}

/// Returns how much farther than `radius` two polygons are apart \[m\]. If it is more than `slack` above or below, only the sign counts: edges
/// tell it, which is less work than a distance.
pub(crate) fn clearance<S: Scalar>(a: &[Corner<S>], b: &[Corner<S>], radius: S, slack: S) -> S {
    let mut most: Option<S> = None;
    for (own, their) in [(a, b), (b, a)] {
        for edge in own.iter().filter(|edge| edge.length > S::ZERO) {
            let gap = beyond(edge, their);
            if gap - radius > slack {
                return gap - radius;
            }
            most = Some(most.map_or(gap, |most| most.max(gap)));
        }
    }
    // If no edge of them separates two polygons, they overlap, unless both are flat.
    let overlap = most.filter(|gap| *gap < -slack && (a.len() > 2 || b.len() > 2));
    overlap.unwrap_or_else(|| outside(a, b).map_or(S::ZERO, |(distance, ..)| distance)) - radius
}

/// The least distance of corners from edges, and its direction; `None` if the polygons overlap.
fn outside<S: Scalar>(a: &[Corner<S>], b: &[Corner<S>]) -> Option<(S, Direction<S>, bool)> {
    let ((there, beyond_b), (back, beyond_a)) = (nearest(a, b), nearest(b, a));
    let is_of_first = back.square < there.square;
    let found = if is_of_first { back } else { there };
    // If rounding makes a gap of an overlap, the overlap and the distance found are rounding errors.
    let is_apart = [beyond_a, beyond_b].into_iter().flatten().any(|(gap, _)| gap > S::ZERO);
    if let Some((out, outward)) = found.beside {
        // The normal of the edge, which is exact however short the way is.
        let direction = if (out < S::ZERO) == is_of_first { opposite(outward) } else { outward };
        return (is_apart && out != S::ZERO).then(|| (out.abs(), direction, is_of_first));
    }
    let length = found.square.sqrt();
    if length <= S::ZERO {
        return None;
    }
    let direction = direction_of(found.way, length);
    let direction = if is_of_first { opposite(direction) } else { direction };
    let along = gap(a, b, direction);
    // Rounding may take the end of an edge for nearer than a place just beside that end. Then the normal of the edge shows a wider gap.
    let edges = [(beyond_a, false), (beyond_b, true)].into_iter();
    let edges = edges.filter_map(|(beyond, back)| beyond.map(|(gap, outward)| (gap, outward, back)));
    match edges.reduce(|one, other| if other.0 > one.0 { other } else { one }) {
        Some((gap, outward, back)) if gap > along && is_apart => {
            Some((length, if back { opposite(outward) } else { outward }, !back))
        }
        _ => (is_apart || along.double() > length).then_some((length, direction, is_of_first)),
    }
}

/// How far apart two polygons are along a direction from the first to the second \[m\].
pub(crate) fn gap<S: Scalar>(a: &[Corner<S>], b: &[Corner<S>], direction: Direction<S>) -> S {
    let most = a.iter().map(|corner| corner.at.along(direction)).reduce(S::max);
    let least = b.iter().map(|corner| corner.at.along(direction)).reduce(S::min);
    least.unwrap_or(S::ZERO) - most.unwrap_or(S::ZERO)
}

/// The largest gap along a normal of an edge \[m\], minus the depth if the polygons overlap, and the direction from the first to the second.
fn overlap<S: Scalar>(a: &[Corner<S>], b: &[Corner<S>]) -> (S, Direction<S>, bool) {
    let mut most: Option<(S, Direction<S>, bool)> = None;
    for (own, their, back) in [(a, b, false), (b, a, true)] {
        for edge in own.iter().filter(|edge| edge.length > S::ZERO) {
            let gap = beyond(edge, their);
            if most.is_none_or(|(most, ..)| gap > most) {
                most = Some((gap, if back { opposite(edge.outward) } else { edge.outward }, !back));
            }
        }
    }
    most.unwrap_or((S::ZERO, Direction::X, false))
}

/// The least signed distance of the corners of a polygon from the line of an edge, positive outside \[m\].
pub(crate) fn beyond<S: Scalar>(edge: &Corner<S>, corners: &[Corner<S>]) -> S {
    let apart = |corner: &Corner<S>| between(edge.at, corner.at).along(edge.outward);
    corners.iter().map(apart).reduce(S::min).unwrap_or(S::ZERO)
}

/// The corner of `a` that is nearest to an edge or a corner of `b`, and the largest distance from the line of an edge of `b` beyond which
/// all of `a` lies \[m\], with the normal of that edge; `None` if `b` has no edges.
fn nearest<S: Scalar>(a: &[Corner<S>], b: &[Corner<S>]) -> (Nearest<S>, Option<(S, Direction<S>)>) {
    let mut found: Option<Nearest<S>> = None;
    let mut beyond: Option<(S, Direction<S>)> = None;
    for edge in b {
        let mut least: Option<S> = None;
        for corner in a {
            let way = between(corner.at, edge.at);
            // `across` a normal is along the edge. Beyond its end the next corner is nearer.
            let (out, along) = (-way.along(edge.outward), -way.across(edge.outward));
            least = Some(least.map_or(out, |least| least.min(out)));
            let (square, beside) = if along <= S::ZERO {
                (way.norm_squared(), None)
            } else if along <= edge.length {
                (out.times(out), Some((out, edge.outward)))
            } else {
                continue;
            };
            if found.as_ref().is_none_or(|found| square < found.square) {
                found = Some(Nearest { square, way, beside });
            }
        }
        let least = least.filter(|least| edge.length > S::ZERO && beyond.is_none_or(|(most, _)| *least > most));
        beyond = least.map(|least| (least, edge.outward)).or(beyond);
    }
    // A corner is beyond the ends of all edges only by rounding, and is then near a corner.
    (found.unwrap_or_else(|| corners_apart(a, b)), beyond)
}

/// The least distance of two corners.
fn corners_apart<S: Scalar>(a: &[Corner<S>], b: &[Corner<S>]) -> Nearest<S> {
    let pairs = a.iter().flat_map(|a| b.iter().map(|b| between(a.at, b.at)));
    let all = pairs.map(|way| Nearest { square: way.norm_squared(), way, beside: None });
    let none = || Nearest { square: S::Wide::ZERO, way: Vector { x: S::ZERO, y: S::ZERO }, beside: None };
    all.reduce(|one, other| if other.square < one.square { other } else { one }).unwrap_or_else(none)
}

#[cfg(all(test, feature = "libm"))]
pub(crate) mod tests {
    use super::*;
    use crate::outline::{Outline, supports};
    use heapless::Vec;

    /// A generator of numbers, for tests of outlines.
    pub(crate) struct Random(pub(crate) u64);

    impl Random {
        /// The numbers of a seed; seeds that follow one another have nothing in common.
        pub(crate) fn of(seed: u64) -> Self {
            let mut random = Self(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1);
            (0..4).for_each(|_| {
                random.unit();
            });
            random
        }

        pub(crate) fn unit(&mut self) -> f64 {
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (self.0 >> 11) as f64 / (1_u64 << 53) as f64
        }

        pub(crate) fn within(&mut self, lo: f64, hi: f64) -> f64 {
            lo + (hi - lo) * self.unit()
        }

        pub(crate) fn below(&mut self, count: usize) -> usize {
            (self.unit() * count as f64) as usize
        }

        /// A convex polygon of up to 6 corners on a circle that was stretched and moved, or on a grid.
        pub(crate) fn outline(&mut self, radius: f64) -> Outline<f64, 16> {
            loop {
                let grid = self.below(3) == 0;
                let count = [1, 2, 3, 4, 4, 4, 6][self.below(7)];
                let (a, b) = (self.within(0.05, 1.2), self.within(0.05, 1.2));
                let move_by = [self.within(-1.0, 1.0), self.within(-1.0, 1.0)]
                    .map(|x| if grid { (4.0 * x).round() / 8.0 } else { x });
                let corners: Vec<Vector<f64>, 16> = if grid && count == 4 {
                    let (a, b) = (0.2 + (4.0 * a).round() / 8.0, 0.2 + (4.0 * b).round() / 8.0);
                    [(-a, -b), (a, -b), (a, b), (-a, b)]
                        .map(|(x, y)| Vector { x: x + move_by[0], y: y + move_by[1] })
                        .into_iter()
                        .collect()
                } else {
                    let mut angles: Vec<f64, 16> =
                        (0..count).map(|_| self.within(0.0, core::f64::consts::TAU)).collect();
                    angles.sort_unstable_by(f64::total_cmp);
                    angles
                        .iter()
                        .map(|angle| Vector { x: a * angle.cos() + move_by[0], y: b * angle.sin() + move_by[1] })
                        .collect()
                };
                if let Ok(outline) = Outline::polygon(corners, if count == 1 { radius.max(0.05) } else { radius }) {
                    return outline;
                }
            }
        }
    }

    /// An independent oracle: the distance of two polygons by all segments of both, crossings and inclusion; 0 if they overlap.
    pub(crate) fn oracle(a: &[[f64; 2]], b: &[[f64; 2]]) -> f64 {
        let cross = |u: [f64; 2], v: [f64; 2]| u[0] * v[1] - u[1] * v[0];
        let minus = |u: [f64; 2], v: [f64; 2]| [u[0] - v[0], u[1] - v[1]];
        let inside = |p: [f64; 2], poly: &[[f64; 2]]| {
            poly.len() > 2
                && (0..poly.len()).all(|k| cross(minus(poly[(k + 1) % poly.len()], poly[k]), minus(p, poly[k])) >= 0.0)
        };
        if inside(a[0], b) || inside(b[0], a) {
            return 0.0;
        }
        let to_segment = |p: [f64; 2], s: [f64; 2], e: [f64; 2]| {
            let (d, w) = (minus(e, s), minus(p, s));
            let square = d[0] * d[0] + d[1] * d[1];
            let t = if square > 0.0 { ((w[0] * d[0] + w[1] * d[1]) / square).clamp(0.0, 1.0) } else { 0.0 };
            (w[0] - t * d[0]).hypot(w[1] - t * d[1])
        };
        let mut least = f64::MAX;
        for i in 0..a.len() {
            for j in 0..b.len() {
                let (p, q, r, s) = (a[i], a[(i + 1) % a.len()], b[j], b[(j + 1) % b.len()]);
                let (u, v) = (minus(q, p), minus(s, r));
                let sides =
                    [cross(u, minus(r, p)), cross(u, minus(s, p)), cross(v, minus(p, r)), cross(v, minus(q, r))];
                if sides[0] * sides[1] < 0.0 && sides[2] * sides[3] < 0.0 {
                    return 0.0;
                }
                for (point, from, to) in [(p, r, s), (q, r, s), (r, p, q), (s, p, q)] {
                    least = least.min(to_segment(point, from, to));
                }
            }
        }
        least
    }

    pub(crate) fn points(corners: &[Corner<f64>]) -> Vec<[f64; 2], 16> {
        corners.iter().map(|corner| [corner.at.x, corner.at.y]).collect()
    }

    #[test]
    fn distances_are_those_of_all_segments_crossings_and_inclusions() {
        let mut random = Random(1);
        let mut overlaps = 0;
        for _ in 0..20_000 {
            let outlines = [random.outline(0.1), random.outline(0.1)];
            let grid = random.below(3) == 0;
            let placed = outlines.each_ref().map(|outline| {
                let quarter = core::f64::consts::FRAC_PI_2 * random.below(4) as f64;
                let angle = if grid { quarter } else { random.within(0.0, 6.3) };
                let turn: Direction<f64> = if grid {
                    [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)].map(|(cos, sin)| Direction { cos, sin })
                        [random.below(4)]
                } else {
                    Direction { cos: angle.cos(), sin: angle.sin() }
                };
                let (x, y) = (random.within(-1.5, 1.5), random.within(-1.5, 1.5));
                let (x, y) = if grid { ((8.0 * x).round() / 8.0, (8.0 * y).round() / 8.0) } else { (x, y) };
                let mut own: Vec<Corner<f64>, 16> = outline.as_outline().corners().iter().copied().collect();
                if own.is_empty() {
                    own.push(Corner::CENTRE).unwrap();
                }
                for corner in &mut own {
                    let at = turn.vector(corner.at.x, corner.at.y);
                    *corner = Corner {
                        at: Vector { x: at.x + x, y: at.y + y },
                        outward: turn.plus(corner.outward),
                        ..*corner
                    };
                }
                own
            });
            let exact = oracle(&points(&placed[0]), &points(&placed[1]));
            let (signed, normal, _) = separation_along(&placed[0], &placed[1]);
            assert!((gap(&placed[0], &placed[1], normal) - signed).abs() < 1e-14, "{placed:?}");
            let (radius, slack) = (0.5 * random.below(3) as f64, 1e-9);
            let [clear, known] = [clearance(&placed[0], &placed[1], radius, slack), exact - radius];
            assert!(
                (clear - known).abs() < 1e-14
                    || clear * known > 0.0 && clear.abs() > slack
                    || exact == 0.0 && clear < -slack,
                "{placed:?}"
            );
            assert!((signed.max(0.0) - exact).abs() < 1e-14, "{placed:?}");
            if signed < -1e-9 {
                overlaps += 1;
                // Moved by the depth along the normal of some edge they are apart, and by less along none.
                let all = placed.iter().flatten().filter(|corner| corner.length > 0.0);
                let gaps = all
                    .flat_map(|edge| [edge.outward, crate::outline::opposite(edge.outward)])
                    .map(|direction| gap(&placed[0], &placed[1], direction));
                let most = gaps.fold(f64::MIN, f64::max);
                assert!((most - signed).abs() < 1e-14, "{most} {signed}");
            }
            let turn = random.within(0.0, 6.3);
            let direction = Direction { cos: turn.cos(), sin: turn.sin() };
            assert!((0..placed[0].len()).any(|k| supports(&placed[0], k, direction, 1e-15)));
        }
        assert!(overlaps > 1_000, "{overlaps}");
    }
}
