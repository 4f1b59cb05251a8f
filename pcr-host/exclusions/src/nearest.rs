//! The least distance of two stretches of lines and arcs, in closed form.
//!
//! Where two pieces come nearest, one of the points is an end, or their connection is perpendicular to both, or they
//! cross. For these places there are few candidates.

use pcr_formats::scenario::{PathSegment, PlacedSegment};
use std::f64::consts::TAU;

/// Bound on the rounding error of a distance, relative to the sum of coordinates, lengths and radii.
const ROUNDING: f64 = 1e-12;

/// The points at which two stretches come nearest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NearestPoints {
    /// Distance of the two points \[m\].
    pub distance: f64,
    /// Lower bound of the distance of any two points \[m\].
    pub least: f64,
    /// Lengths along the two stretches, from their starts \[m\].
    pub lengths: [f64; 2],
    /// The two points \[m\].
    pub points: [[f64; 2]; 2],
}

/// The part of a curve between two lengths along it \[m\].
pub fn stretch(curve: &[PlacedSegment], [from, to]: [f64; 2]) -> Vec<PlacedSegment> {
    let mut before = 0.0;
    let mut parts = Vec::new();
    for piece in curve {
        let length = piece.shape.length();
        let (lo, hi) = ((from - before).clamp(0.0, length), (to - before).clamp(0.0, length));
        let last = parts.is_empty() && before + length >= from;
        if hi > lo || last {
            parts.push(piece.part(lo, hi));
        }
        before += length;
    }
    parts
}

pub(crate) fn point(piece: &PlacedSegment, length: f64) -> [f64; 2] {
    piece.part(0.0, length).end()
}

/// The points at which two curves come nearest; `None` if one of them has no piece.
pub fn nearest(a: &[PlacedSegment], b: &[PlacedSegment]) -> Option<NearestPoints> {
    let mut best: Option<NearestPoints> = None;
    let mut before_a = 0.0;
    for own in a {
        let mut before_b = 0.0;
        for other in b {
            let mut found = pieces(own, other);
            found.lengths = [found.lengths[0] + before_a, found.lengths[1] + before_b];
            best = Some(match best {
                Some(best) if best.distance <= found.distance => {
                    NearestPoints { least: best.least.min(found.least), ..best }
                }
                Some(best) => NearestPoints { least: best.least.min(found.least), ..found },
                None => found,
            });
            before_b += other.shape.length();
        }
        before_a += own.shape.length();
    }
    best
}

fn approach(a: &PlacedSegment, b: &PlacedSegment, lengths: [f64; 2]) -> NearestPoints {
    let points = [point(a, lengths[0]), point(b, lengths[1])];
    let distance = (points[0][0] - points[1][0]).hypot(points[0][1] - points[1][1]);
    NearestPoints { distance, least: distance, lengths, points }
}

/// The points at which two pieces come nearest.
fn pieces(a: &PlacedSegment, b: &PlacedSegment) -> NearestPoints {
    let mut places = vec![a.start, a.end(), b.start, b.end()];
    places.extend(between(&SupportCurve::of(a), &SupportCurve::of(b)));
    let all = places.into_iter().map(|at| approach(a, b, [a, b].map(|piece| length_near(piece, at))));
    let best = all.min_by(|x, y| x.distance.total_cmp(&y.distance)).expect("four candidates at least");
    let reach = |piece: &PlacedSegment| match piece.shape {
        PathSegment::Line { length } => length,
        PathSegment::Arc { radius, .. } => radius,
        _ => 0.0,
    };
    let far = [a, b].iter().map(|piece| piece.start[0].abs() + piece.start[1].abs() + reach(piece)).sum::<f64>();
    NearestPoints { least: (best.distance - ROUNDING * (1.0 + far)).max(0.0), ..best }
}

/// The line or the circle on which a piece lies.
enum SupportCurve {
    /// A point, and the direction.
    Line([f64; 2], [f64; 2]),
    /// Centre and radius \[m\].
    Circle([f64; 2], f64),
}

impl SupportCurve {
    fn of(piece: &PlacedSegment) -> Self {
        let (sin, cos) = piece.heading.sin_cos();
        match piece.shape {
            PathSegment::Arc { radius, sweep, .. } => Self::Circle(centre(piece, radius, sweep), radius),
            _ => Self::Line(piece.start, [cos, sin]),
        }
    }
}

fn centre(piece: &PlacedSegment, radius: f64, sweep: f64) -> [f64; 2] {
    let (sin, cos) = piece.heading.sin_cos();
    let left = radius.copysign(sweep);
    [piece.start[0] - left * sin, piece.start[1] + left * cos]
}

/// Points of one of two carriers from which the way to the other is perpendicular to both, and those in which they cross.
fn between(a: &SupportCurve, b: &SupportCurve) -> Vec<[f64; 2]> {
    match (a, b) {
        (SupportCurve::Line(p, u), SupportCurve::Line(q, v)) => {
            let turn = u[0] * v[1] - u[1] * v[0];
            let along = ((q[0] - p[0]) * v[1] - (q[1] - p[1]) * v[0]) / turn;
            if turn == 0.0 { Vec::new() } else { vec![point_at(*p, *u, along)] }
        }
        (SupportCurve::Line(p, u), SupportCurve::Circle(c, r))
        | (SupportCurve::Circle(c, r), SupportCurve::Line(p, u)) => {
            let foot = point_at(*p, *u, (c[0] - p[0]) * u[0] + (c[1] - p[1]) * u[1]);
            across(foot, *u, r * r - (foot[0] - c[0]).powi(2) - (foot[1] - c[1]).powi(2))
        }
        (SupportCurve::Circle(c, r), SupportCurve::Circle(d, s)) => {
            // From the smaller one, whose numbers have more digits.
            let [(c, r), (d, s)] = if r <= s { [(c, r), (d, s)] } else { [(d, s), (c, r)] };
            let [x, y] = [d[0] - c[0], d[1] - c[1]];
            let apart = x.hypot(y);
            if apart <= 0.0 {
                return Vec::new();
            }
            let u = [x / apart, y / apart];
            // Of the chord in which they cross, if they do.
            let foot = ((apart - s) * (apart + s) + r * r) / (2.0 * apart);
            let mut places = across(point_at(*c, u, foot), [-u[1], u[0]], (r - foot) * (r + foot));
            places.extend([point_at(*c, u, *r), point_at(*c, u, -*r)]);
            places
        }
    }
}

fn point_at(at: [f64; 2], u: [f64; 2], length: f64) -> [f64; 2] {
    [at[0] + length * u[0], at[1] + length * u[1]]
}

/// A point, and those at this squared distance along a direction, if it is not negative.
fn across(at: [f64; 2], u: [f64; 2], squared: f64) -> Vec<[f64; 2]> {
    let half = squared.max(0.0).sqrt();
    vec![at, point_at(at, u, half), point_at(at, u, -half)]
}

/// The length along a piece at which it is nearest to a point \[m\].
fn length_near(piece: &PlacedSegment, at: [f64; 2]) -> f64 {
    match piece.shape {
        PathSegment::Line { length } => {
            let (sin, cos) = piece.heading.sin_cos();
            ((at[0] - piece.start[0]) * cos + (at[1] - piece.start[1]) * sin).clamp(0.0, length)
        }
        PathSegment::Arc { radius, sweep, .. } => {
            let centre = centre(piece, radius, sweep);
            let angle = |[x, y]: [f64; 2]| (y - centre[1]).atan2(x - centre[0]);
            let turned = ((angle(at) - angle(piece.start)) * sweep.signum()).rem_euclid(TAU);
            let beyond = turned - sweep.abs();
            // Beyond its end the nearer of both ends.
            let turned = if beyond <= 0.0 {
                turned
            } else if beyond < TAU - turned {
                sweep.abs()
            } else {
                0.0
            };
            radius * turned
        }
        _ => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pcr_formats::splitmix64::SplitMix64;

    #[test]
    fn the_nearest_points_are_those_of_samples() {
        let line = PlacedSegment::line([0.0, 0.0], [4.0, 1.0]);
        let arc = PlacedSegment { start: [3.0, 2.0], heading: 0.5, shape: PathSegment::arc(1.5, -2.5) };
        for other in [arc, PlacedSegment::line([1.0, 3.0], [2.0, 1.0]), PlacedSegment::line([2.0, -1.0], [2.0, 2.0])] {
            let found = nearest(&[line], &[other]).unwrap();
            let mut least = f64::INFINITY;
            for i in 0..=1000 {
                for j in 0..=1000 {
                    let share =
                        |k: i32, piece: &PlacedSegment| point(piece, piece.shape.length() * f64::from(k) / 1000.0);
                    let (p, q) = (share(i, &line), share(j, &other));
                    least = least.min((p[0] - q[0]).hypot(p[1] - q[1]));
                }
            }
            assert!(found.distance <= least + 1e-9 && found.least <= least, "{found:?} {least}");
            assert!(found.distance - found.least <= 1e-8, "{found:?}");
            let [p, q] = found.points;
            assert!(((p[0] - q[0]).hypot(p[1] - q[1]) - found.distance).abs() < 1e-12);
        }
    }

    #[test]
    fn lines_and_arcs_anywhere_are_nearest_where_samples_are() {
        let arc = |at: [f64; 2], heading: f64, radius: f64, sweep: f64| PlacedSegment {
            start: at,
            heading,
            shape: PathSegment::arc(radius, sweep),
        };
        let mut random = SplitMix64(1);
        let mut any = || random.unit();
        let mut piece = |k: usize| match k % 4 {
            0 => PlacedSegment::line([8.0 * any(), 8.0 * any()], [8.0 * any(), 8.0 * any()]),
            1 => arc([8.0 * any(), 8.0 * any()], 7.0 * any(), 0.2 + 3.0 * any(), 7.0 * any() - 3.5),
            // More than a turn; and on circles around one centre, which also touch.
            2 => arc([8.0 * any(), 8.0 * any()], 7.0 * any(), 0.2 + any(), 12.0 * any() - 6.0),
            _ => {
                let radius = (1.0 + 3.0 * any()).round();
                let (sin, cos) = (7.0 * any()).sin_cos();
                let turn = sin.atan2(cos) + std::f64::consts::FRAC_PI_2;
                arc([4.0 + radius * cos, 4.0 + radius * sin], turn, radius, 4.0 * any())
            }
        };
        const SAMPLES: usize = 200;
        for k in 0..160 {
            let [a, b] = [piece(k), piece(k / 4)];
            let found = nearest(&[a], &[b]).unwrap();
            let [own, other] = [a, b].map(|piece| {
                (0..=SAMPLES)
                    .map(|n| point(&piece, piece.shape.length() * n as f64 / SAMPLES as f64))
                    .collect::<Vec<_>>()
            });
            let apart = own.iter().flat_map(|p| other.iter().map(move |q| (p[0] - q[0]).hypot(p[1] - q[1])));
            let sampled = apart.fold(f64::INFINITY, f64::min);
            let step = (a.shape.length() + b.shape.length()) / SAMPLES as f64 / 2.0;
            assert!((sampled - step..=sampled + 1e-9).contains(&found.distance), "{a:?} {b:?}: {found:?}, {sampled}");
            assert!(found.least <= found.distance && found.distance - found.least < 1e-8, "{found:?}");
        }
    }

    #[test]
    fn a_stretch_is_the_part_between_two_lengths() {
        let arc = PlacedSegment { start: [2.0, 0.0], heading: 0.0, shape: PathSegment::arc(1.0, 2.0) };
        let curve = [PlacedSegment::line([0.0, 0.0], [2.0, 0.0]), arc];
        let part = stretch(&curve, [1.5, 3.0]);
        assert_eq!(part.len(), 2);
        assert!((part[0].start[0] - 1.5).abs() < 1e-12 && (part[0].shape.length() - 0.5).abs() < 1e-12);
        assert!((part[1].shape.length() - 1.0).abs() < 1e-12);
        assert_eq!(stretch(&curve, [4.0, 4.0]).len(), 1);
        assert_eq!(stretch(&curve, [0.0, 0.0]).len(), 1);
    }
}
