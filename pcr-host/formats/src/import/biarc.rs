//! Approximates curves by lines and arcs, with a certified distance.
//!
//! Two arcs with a common tangent (a biarc) join the ends of a piece of the curve in the directions of the curve there;
//! a piece that is further from its biarc than the tolerance is bisected. The distance is bounded and not sampled: in
//! the frame of an arc with signed curvature k, the point (x, y) is off by d with
//!
//! ```text
//! g = k (x² + y²) / 2 - y,    (1 - k d)² = 1 + 2 k g    to the left of which d is counted
//! ```
//!
//! and on a rational Bézier curve w² g is a polynomial, which the largest of its Bernstein coefficients bounds. The
//! hull of the control points shows that every point lies between the ends of the arc.
//!
//! A vehicle on the curve is not where it would be on the arcs after the same length. [`FitDeviation`] bounds how far these two
//! places are apart: the curve is cut into parts whose lengths are between those of their chords and their control
//! polygons.

use super::bernstein::{circle, framed};
use super::heading_error;
use super::nurbs::RationalBezier;
use super::{ImportError, UNSAID};
use crate::plane_geometry::{distance as apart_by, wrapped};
use crate::scenario::PathSegment;
use crate::scenario::PlacedSegment;
use std::f64::consts::{FRAC_PI_2, PI};

/// Lines and arcs at most that a curve may need.
pub(super) const MOST: usize = 5_000;

/// How often a piece may be halved.
const HALVINGS: u32 = 40;

/// Parts of all curves together by which their lengths are bounded, as a power of two.
const PARTS: u32 = 20;

/// How often the curve that a piece stands for is halved for that at most.
const FINEST: u32 = 14;

/// Sweep of an arc up to which the bound holds, with some room for rounding \[rad\].
const SWEEP: f64 = FRAC_PI_2 + 1e-6;

/// Roundings of the largest coordinate that evaluating the bound may cost, far more than it does.
pub(super) const ROUNDINGS: f64 = 64.0 * f64::EPSILON;

/// A curve as lines and arcs.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct BiarcFit {
    pub(super) pieces: Vec<PlacedSegment>,
    /// Bound of the distance of every point of the curve from the point of the lines and arcs at the same length \[m\].
    pub(super) deviation: f64,
    /// Bound of the difference of both lengths \[m\].
    pub(super) length_error: f64,
    /// Bound of the difference of both headings at the same length \[rad\].
    pub(super) heading_error: f64,
    /// Whether it is more than a line, or than lines with corners between them.
    pub(super) bends: bool,
}

impl BiarcFit {
    /// Lines and arcs that are the curve itself.
    pub(super) fn exact(pieces: Vec<PlacedSegment>) -> Self {
        Self { pieces, ..Self::default() }
    }
}

/// A part of a curve.
#[derive(Clone, Copy, Debug)]
pub(super) struct CurvePart {
    /// End \[m\].
    pub(super) end: [f64; 2],
    /// Its least and its largest length \[m\].
    pub(super) length: [f64; 2],
    /// How far it may be from the line through its ends \[m\].
    pub(super) lateral_deviation: f64,
}

/// How far a curve is from its lines and arcs at the same length, followed piece by piece.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct FitDeviation {
    /// Difference between the length of the curve and that of its pieces up to here: least and largest \[m\].
    longer: [f64; 2],
    /// Largest distance so far \[m\].
    pub(super) deviation: f64,
}

impl FitDeviation {
    /// Largest difference of the lengths up to here \[m\].
    pub(super) fn longer(&self) -> f64 {
        self.longer[0].abs().max(self.longer[1].abs())
    }

    /// Follows lines and arcs, and the parts of the curve that these replace.
    ///
    /// A part of length l and chord c deviates sideways from its chord by at most [`CurvePart::lateral_deviation`], and along its chord by at most
    /// l − c from the point at the same fraction. The same holds for lines and arcs of the replacement. For a given length, a
    /// chord is shortest, and the sideways deviation largest, if the curvature is largest everywhere.
    pub(super) fn follow(&mut self, begin: [f64; 2], pieces: &[PlacedSegment], parts: &[CurvePart]) {
        let mut from = begin;
        let whole: f64 = pieces.iter().map(|piece| piece.shape.length()).sum();
        let radius = pieces.iter().filter_map(PlacedSegment::radius).fold(f64::INFINITY, f64::min);
        let (mut travelled, mut apart, mut off) = ([0.0; 2], 0.0_f64, 0.0);
        for part in parts {
            let [least, most] = part.length;
            travelled = [travelled[0] + least, travelled[1] + most];
            let middle = 0.5 * (travelled[0] + travelled[1]);
            let unsure = 0.5 * (travelled[1] - travelled[0]) + (middle - whole).max(0.0);
            let before = std::mem::replace(&mut off, apart_by(part.end, point_at(begin, pieces, middle)) + unsure);
            let own = part.lateral_deviation + (most - apart_by(from, part.end)).max(0.0);
            apart = apart.max(before.max(off) + own + bend(most, radius));
            from = part.end;
        }
        self.deviation = self.deviation.max(self.longer() + apart);
        self.longer = [0, 1].map(|k| self.longer[k] + travelled[k] - whole);
    }
}

/// How far an arc of this length and radius is from the point of its chord at the same fraction.
fn bend(length: f64, radius: f64) -> f64 {
    if radius.is_infinite() {
        return 0.0;
    }
    let quarter = (0.25 * length / radius).min(0.5 * FRAC_PI_2);
    let sagitta = 2.0 * radius * quarter.sin().powi(2);
    sagitta + (length - 2.0 * radius * (2.0 * quarter).sin()).max(0.0)
}

/// The point of lines and arcs at a length, the end of them beyond that; where they begin if there are none.
fn point_at(begin: [f64; 2], pieces: &[PlacedSegment], length: f64) -> [f64; 2] {
    let mut rest = length;
    for piece in pieces {
        let own = piece.shape.length();
        if rest < own {
            let shape = match piece.shape {
                PathSegment::Arc { radius, sweep, .. } => PathSegment::arc(radius, sweep * rest.max(0.0) / own),
                _ => PathSegment::Line { length: rest.max(0.0) },
            };
            return PlacedSegment { shape, ..*piece }.end();
        }
        rest -= own;
    }
    pieces.last().map_or(begin, PlacedSegment::end)
}

/// Cuts a curve into parts that are nearly straight.
pub(super) fn parts(curve: &RationalBezier, most: f64, halvings: u32, into: &mut Vec<CurvePart>) {
    let [from, end] = curve.ends();
    let (chord, polygon) = (apart_by(from, end), curve.polygon());
    let side =
        |[x, y]: [f64; 2]| ((x - from[0]) * (end[1] - from[1]) - (y - from[1]) * (end[0] - from[0])).abs() / chord;
    let aside = curve.points().map(side).fold(0.0, f64::max);
    // If both ends are one point, there is no line through them.
    let aside = if chord > 0.0 { aside } else { polygon };
    if halvings == 0 || aside + polygon - chord <= most {
        into.push(CurvePart { end, length: [chord, polygon.max(chord)], lateral_deviation: aside });
        return;
    }
    for half in curve.split(0.5) {
        parts(&half, most, halvings - 1, into);
    }
}

/// The lines and arcs for a chain of curves, within `tolerance` \[m\] of it.
pub(super) fn fit(curves: &[RationalBezier], tolerance: f64) -> Result<BiarcFit, ImportError> {
    // Whatever is no number is overlooked by every bound below.
    if curves.iter().flat_map(RationalBezier::points).flatten().any(|x| !x.is_finite()) {
        return Err(ImportError::new("its points are out of range"));
    }
    let extent = curves.iter().flat_map(RationalBezier::points).flatten().fold(0.0, |most: f64, x| most.max(x.abs()));
    let rounding = ROUNDINGS * extent;
    if tolerance <= 2.0 * rounding {
        return Err(ImportError::new(format!(
            "coordinates up to {extent:e} m cannot be fitted within {tolerance:e} m"
        )));
    }
    let (mut fit, mut fitted) = (BiarcFit::default(), Vec::new());
    let mut rest: Vec<(RationalBezier, u32)> = curves.iter().rev().map(|curve| (curve.clone(), HALVINGS)).collect();
    while let Some((curve, halvings)) = rest.pop() {
        match best(&curve, tolerance - rounding, rounding) {
            Some(FitCandidate { pieces, deviation, turned }) => {
                fit.deviation = fit.deviation.max(deviation + rounding);
                let before = fit.pieces.len();
                fit.pieces.extend(pieces.into_iter().filter(|piece| piece.shape.length() > 0.0));
                fitted.push((curve, before..fit.pieces.len(), [deviation, turned]));
            }
            None if halvings == 0 || fit.pieces.len() + rest.len() > MOST => {
                return Err(ImportError::new(format!(
                    "it takes more than {MOST} lines and arcs within {tolerance:e} m"
                )));
            }
            None => {
                let [before, after] = curve.split(0.5);
                rest.extend([(after, halvings - 1), (before, halvings - 1)]);
            }
        }
    }
    let (mut along, mut short) = (FitDeviation::default(), Vec::new());
    let halvings = (PARTS - fitted.len().max(1).ilog2()).min(FINEST);
    for (curve, pieces, [deviation, turned]) in fitted {
        short.clear();
        parts(&curve, tolerance / 4096.0, halvings, &mut short);
        let before = along.longer();
        along.follow(curve.ends()[0], &fit.pieces[pieces.clone()], &short);
        let ahead = before.max(along.longer()) + ahead(&fit.pieces[pieces.clone()], deviation, turned) + rounding;
        fit.heading_error = fit.heading_error.max(turned + turn_within(&fit.pieces, pieces, ahead));
    }
    fit.deviation = fit.deviation.max(along.deviation + rounding);
    fit.length_error = along.longer() + rounding;
    // A straight curve is a line within any tolerance.
    fit.bends = fit.deviation > UNSAID || fit.pieces.iter().any(|piece| piece.radius().is_some());
    Ok(fit)
}

/// What stands for one piece of a curve.
struct FitCandidate {
    pieces: Vec<PlacedSegment>,
    /// Bound of its distance \[m\].
    deviation: f64,
    /// Bound of the difference of the headings at points beside one another \[rad\].
    turned: f64,
}

/// Largest difference of headings that is accepted at a tolerance \[rad\]: 5 mrad at 1 mm. The distance of a biarc from its curve falls with
/// the cube of its length and the angle with the square, so this falls as the angle does, and the number of arcs grows alike for both. A bend
/// with a radius of some metres takes about twice as many arcs as for the distance alone.
pub(super) fn most_turned(tolerance: f64) -> f64 {
    (0.5 * tolerance.cbrt().powi(2)).min(0.05)
}

/// A line or a biarc for one piece, if it is within the tolerance.
fn best(curve: &RationalBezier, tolerance: f64, rounding: f64) -> Option<FitCandidate> {
    let [from, to] = curve.ends();
    let line = PlacedSegment::line(from, to);
    // A straight or negligibly small curve becomes a line.
    let spread = curve.points().map(|[x, y]| (x - from[0]).hypot(y - from[1])).fold(0.0, f64::max);
    let straight = if spread <= tolerance / 4.0 { spread } else { distance(curve, &line) };
    if straight <= tolerance / 1024.0 || spread <= tolerance / 4.0 {
        // On a curve that is nothing but a point, as at a cusp, the vehicle turns in place.
        let is_point = spread <= 64.0 * rounding;
        let turned = if is_point { 0.0 } else { heading_error::between(curve, &line) };
        if turned <= most_turned(tolerance) {
            return Some(FitCandidate { pieces: vec![line], deviation: straight, turned });
        }
    }
    let [leaving, arriving] = curve.headings()?;
    let arcs = biarc([from, to], [leaving, arriving])?;
    let [before, after] = curve.split(parameter(curve, &arcs[1]));
    let deviation = distance(&before, &arcs[0]).max(distance(&after, &arcs[1]));
    if deviation > tolerance {
        return None;
    }
    let turned = heading_error::between(&before, &arcs[0]).max(heading_error::between(&after, &arcs[1]));
    (turned <= most_turned(tolerance)).then(|| FitCandidate { pieces: arcs.to_vec(), deviation, turned })
}

/// Bound of the way between two points of lines and arcs \[m\]: the one beside a point of the curve, and the one at the same length. On a
/// curve at a distance d and an angle δ from an arc of curvature k, the point beside moves by cos δ / (1 - k d) times the way on it.
fn ahead(pieces: &[PlacedSegment], deviation: f64, turned: f64) -> f64 {
    let whole: f64 = pieces.iter().map(|piece| piece.shape.length()).sum();
    let bend = deviation
        * pieces.iter().filter_map(PlacedSegment::radius).fold(0.0, |most: f64, radius| most.max(radius.recip()));
    whole * (bend + 0.5 * turned * turned) / (1.0 - bend).max(0.5)
}

/// Bound of the turn over a way that begins or ends on these pieces and is not longer than `way` \[rad\].
fn turn_within(all: &[PlacedSegment], on: std::ops::Range<usize>, way: f64) -> f64 {
    let reached = |pieces: &mut dyn Iterator<Item = &PlacedSegment>| {
        let mut left = way;
        let mut most = 0.0_f64;
        for piece in pieces {
            most = most.max(piece.radius().map_or(0.0, f64::recip));
            left -= piece.shape.length();
            if left <= 0.0 {
                break;
            }
        }
        most
    };
    let own = all[on.clone()]
        .iter()
        .filter_map(PlacedSegment::radius)
        .fold(0.0, |most: f64, radius| most.max(radius.recip()));
    let [before, after] = [reached(&mut all[..on.start].iter().rev()), reached(&mut all[on.end..].iter())];
    (own.max(before).max(after) * way).min(PI)
}

/// The arcs from a point to another in given directions, with equally long tangents.
pub(super) fn biarc([from, to]: [[f64; 2]; 2], [leaving, arriving]: [f64; 2]) -> Option<[PlacedSegment; 2]> {
    let (t0, t1) = ([leaving.cos(), leaving.sin()], [arriving.cos(), arriving.sin()]);
    let v = [to[0] - from[0], to[1] - from[1]];
    let dot = |a: [f64; 2], b: [f64; 2]| a[0] * b[0] + a[1] * b[1];
    // |v - d (t0 + t1)| = 2 d, by the form of the solution that does not cancel.
    let (along, open) = (dot(v, [t0[0] + t1[0], t0[1] + t1[1]]), 2.0 * (1.0 - dot(t0, t1)));
    let tangent = dot(v, v) / (along + (along * along + open * dot(v, v)).sqrt());
    if !(tangent > 0.0 && tangent.is_finite()) {
        return None;
    }
    let middle = |k: usize| from[k] + (v[k] + tangent * (t0[k] - t1[k])) / 2.0;
    let joint = [middle(0), middle(1)];
    let first = arc(from, leaving, joint)?;
    let second = arc(joint, first.heading_at_end(), to)?;
    Some([first, second])
}

/// The arc from a point in a direction to another point; a line where there is no difference.
fn arc(at: [f64; 2], heading: f64, to: [f64; 2]) -> Option<PlacedSegment> {
    let chord = PlacedSegment::line(at, to);
    let PathSegment::Line { length } = chord.shape else { return None };
    let half = wrapped(chord.heading - heading);
    // Sagitta of the arc over its chord.
    if length * half.abs() < ROUNDINGS * (at[0].abs() + at[1].abs() + length) {
        return Some(PlacedSegment { heading, ..chord });
    }
    let (sweep, radius) = (2.0 * half, length / (2.0 * half.abs().sin()));
    (sweep.abs() <= SWEEP && radius.is_finite()).then_some(PlacedSegment {
        start: at,
        heading,
        shape: PathSegment::arc(radius, sweep),
    })
}

/// Whether a point lies beyond the beginning of a piece.
pub(super) fn is_beyond([x, y]: [f64; 2], piece: &PlacedSegment) -> bool {
    let (sin, cos) = piece.heading.sin_cos();
    (x - piece.start[0]) * cos + (y - piece.start[1]) * sin > 0.0
}

/// Parameter of the curve at the start of the second arc of its biarc.
fn parameter(curve: &RationalBezier, second: &PlacedSegment) -> f64 {
    let (mut lo, mut hi) = (0.0, 1.0);
    for _ in 0..f64::MANTISSA_DIGITS {
        let middle = 0.5 * (lo + hi);
        if is_beyond(curve.at(middle), second) { hi = middle } else { lo = middle }
    }
    0.5 * (lo + hi)
}

/// Bound of the distance of all points of a curve from a line or an arc of at most a quarter turn \[m\]; infinite where
/// the curve is too far from it to tell.
pub(super) fn distance(curve: &RationalBezier, piece: &PlacedSegment) -> f64 {
    let curvature = match piece.shape {
        PathSegment::Arc { sweep, .. } if sweep.abs() > SWEEP => return f64::INFINITY,
        PathSegment::Arc { radius, sweep, .. } => 1.0_f64.copysign(sweep) / radius,
        _ => 0.0,
    };
    let start = framed(curve, piece.start, piece.heading);
    let end = framed(curve, piece.end(), piece.heading_at_end());
    // How far it reaches over the ends.
    let along = |[x, _, w]: &[Vec<f64>; 3], sign: f64| x.iter().zip(w).map(|(x, w)| sign * x / w).fold(0.0, f64::max);
    let over = along(&start, -1.0).max(along(&end, 1.0));
    // Offset to the side of the tangents: the far half of the circle is out of reach.
    let aside = |[_, y, w]: &[Vec<f64>; 3]| y.iter().zip(w).map(|(y, w)| (y / w * curvature).abs()).fold(0.0, f64::max);
    let side = aside(&start).max(aside(&end));
    let bend = curvature.abs() * offset(&start, curvature);
    if over * curvature.abs() > 0.5 || side > 1.25 || bend > 0.25 {
        return f64::INFINITY;
    }
    let aside = offset(&start, curvature) * 2.0 / (1.0 + (1.0 - 2.0 * bend).sqrt());
    aside + 2.0 * over
}

/// Bound of |k (x² + y²) / 2 - y| on a curve.
fn offset(points: &[Vec<f64>; 3], curvature: f64) -> f64 {
    let [g, squares] = circle(points, curvature);
    g.iter().zip(squares).map(|(g, square)| (g / square).abs()).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::super::nurbs::Nurbs;
    use super::*;

    fn curve(points: &[[f64; 2]], weights: &[f64]) -> Vec<RationalBezier> {
        let points: Vec<_> =
            points.iter().copied().zip(weights.iter().copied().chain(std::iter::repeat(1.0))).collect();
        Nurbs { degree: points.len().min(4) - 1, knots: Vec::new(), points }.beziers().unwrap()
    }

    /// Distance of a point from lines and arcs, by their definition.
    fn from_pieces(pieces: &[PlacedSegment], [x, y]: [f64; 2]) -> f64 {
        let distance = |piece: &PlacedSegment| {
            let ends = [piece.start, piece.end()].map(|end| (x - end[0]).hypot(y - end[1]));
            let (sin, cos) = piece.heading.sin_cos();
            let inner = match piece.shape {
                PathSegment::Line { length } => {
                    let along = (x - piece.start[0]) * cos + (y - piece.start[1]) * sin;
                    let across = (y - piece.start[1]) * cos - (x - piece.start[0]) * sin;
                    (0.0..=length).contains(&along).then_some(across.abs())
                }
                PathSegment::Arc { radius, sweep, .. } => {
                    let side = radius.copysign(sweep);
                    let from = [x - piece.start[0] + side * sin, y - piece.start[1] - side * cos];
                    let angle = (from[1].atan2(from[0]) - piece.heading) * sweep.signum() + FRAC_PI_2;
                    (angle.rem_euclid(2.0 * PI) <= sweep.abs()).then_some((from[0].hypot(from[1]) - radius).abs())
                }
                _ => None,
            };
            inner.into_iter().chain(ends).fold(f64::INFINITY, f64::min)
        };
        pieces.iter().map(distance).fold(f64::INFINITY, f64::min)
    }

    /// The heading at a length.
    fn heading_at(pieces: &[PlacedSegment], length: f64) -> f64 {
        let mut rest = length;
        let piece = pieces.iter().find(|piece| {
            let is_there = rest < piece.shape.length();
            rest -= if is_there { 0.0 } else { piece.shape.length() };
            is_there
        });
        piece.map_or_else(|| pieces.last().unwrap().heading_at_end(), |piece| piece.part(0.0, rest).heading_at_end())
    }

    #[test]
    fn the_bound_holds_and_is_not_far_from_the_truth() {
        let curves = [
            curve(&[[0.0, 0.0], [0.0, 1.8], [3.6, 1.8], [3.6, 0.0]], &[]),
            curve(&[[0.0, 0.0], [3.0, 4.0], [-1.0, 4.0], [2.0, 0.0]], &[1.0, 2.0, 0.5, 1.0]),
            curve(&[[0.0, 0.0], [1.0, 0.0], [2.0, 1.0], [1.0, 3.0], [5.0, 2.0], [5.5, -1.0], [9.0, 0.0]], &[1.0, 3.0]),
            curve(&[[100.0, 50.0], [101.0, 50.0], [104.0, 50.0], [109.0, 50.1]], &[]),
            // A loop, and a cusp.
            curve(&[[0.0, 0.0], [4.0, 3.0], [-3.0, 3.0], [1.0, 0.0]], &[]),
            curve(&[[0.0, 0.0], [2.0, 2.0], [0.0, 2.0], [2.0, 0.0]], &[]),
        ];
        for curve in &curves {
            for tolerance in [1e-1, 1e-2, 1e-3, 1e-5, 1e-7] {
                let fit = fit(curve, tolerance).unwrap();
                let points = curve.iter().flat_map(|bezier| (0..=400).map(|k| bezier.at(f64::from(k) / 400.0)));
                let aside = points.map(|point| from_pieces(&fit.pieces, point)).fold(0.0, f64::max);
                assert!(aside <= fit.deviation.min(tolerance), "{aside} {}", fit.deviation);
                // At the same length, which a fine polygon measures.
                let fine: Vec<_> =
                    curve.iter().flat_map(|bezier| (0..=2000).map(|k| bezier.at(f64::from(k) / 2e3))).collect();
                let (mut length, mut worst, mut turned) = (0.0, 0.0_f64, 0.0_f64);
                for pair in fine.windows(2) {
                    let chord = apart_by(pair[0], pair[1]);
                    // At a cusp a vehicle turns in place.
                    if chord > 1e-4 {
                        let way = (pair[1][1] - pair[0][1]).atan2(pair[1][0] - pair[0][0]);
                        let off = wrapped(way - heading_at(&fit.pieces, length + 0.5 * chord)).abs();
                        turned = turned.max(off);
                    }
                    length += chord;
                    worst = worst.max(apart_by(point_at(pair[0], &fit.pieces, length), pair[1]));
                }
                // Of the chord of a fine polygon.
                assert!(turned <= fit.heading_error + 2e-3, "{turned} {}", fit.heading_error);
                assert!(fit.heading_error <= 0.1 + 3.0 * turned, "{turned} {}", fit.heading_error);
                let whole: f64 = fit.pieces.iter().map(|piece| piece.shape.length()).sum();
                // The polygon is off by less than this itself.
                let slack = 1e-5;
                assert!(worst <= fit.deviation + slack, "{worst} {}", fit.deviation);
                assert!((length - whole).abs() <= fit.length_error + slack, "{length} {whole} {}", fit.length_error);
                assert!(fit.deviation <= 12.0 * worst + tolerance / 16.0, "{worst} {}", fit.deviation);
                assert!(
                    fit.length_error <= 4.0 * (length - whole).abs() + tolerance / 16.0,
                    "{} {whole}",
                    fit.length_error
                );
                for pair in fit.pieces.windows(2) {
                    let (end, next) = (pair[0].end(), pair[1].start);
                    assert!((end[0] - next[0]).hypot(end[1] - next[1]) < 1e-12);
                }
                // Halving the tolerance a thousand times takes ten times the arcs: the order of biarcs is 3.
                assert!(fit.pieces.len() as f64 <= 12.0 + 12.0 * tolerance.powf(-1.0 / 3.0), "{}", fit.pieces.len());
            }
        }
    }

    #[test]
    fn a_quarter_of_a_circle_is_an_arc() {
        let weight = std::f64::consts::FRAC_1_SQRT_2;
        let points = vec![([2.0, 0.0], 1.0), ([2.0, 2.0], weight), ([0.0, 2.0], 1.0)];
        let fit = fit(&Nurbs { degree: 2, knots: Vec::new(), points }.beziers().unwrap(), 1e-9).unwrap();
        assert_eq!(fit.pieces.len(), 2);
        for piece in &fit.pieces {
            assert!(matches!(piece.shape, PathSegment::Arc { radius, .. } if (radius - 2.0).abs() < 1e-12));
        }
        assert!(fit.deviation < 1e-8 && fit.length_error < 1e-8, "{} {}", fit.deviation, fit.length_error);
    }

    #[test]
    fn a_straight_curve_is_a_line() {
        let fit = fit(&curve(&[[1.0, 1.0], [2.0, 2.0], [2.5, 2.5], [4.0, 4.0]], &[]), 1e-3).unwrap();
        assert_eq!(fit.pieces, [PlacedSegment::line([1.0, 1.0], [4.0, 4.0])]);
        assert!(fit.deviation < 1e-12);
    }

    #[test]
    fn what_cannot_be_fitted_is_refused_in_time() {
        let huge = [[0.0, 0.0], [1e9, 1e9], [-1e9, 1e9], [1e6, 0.0]];
        assert!(fit(&curve(&huge, &[]), 1e-6).unwrap_err().to_string().contains("cannot be fitted within"));
        assert!(fit(&curve(&huge, &[]), 1e-3).unwrap_err().to_string().contains("more than 5000 lines and arcs"));
        assert!(fit(&curve(&[[1.0, 2.0]; 4], &[]), 1e-3).unwrap().pieces.is_empty());
    }
}
