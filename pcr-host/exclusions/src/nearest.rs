//! The least distance of two stretches of lines and arcs: exact for lines; for arcs by subdivision until a bound
//! decides.

use pcr_formats::scenario::PathSegment;
use pcr_formats::scenario::Placed;
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// Bound on how far the distance that is found may be above the true one \[m\].
const CLOSE: f64 = 1e-5;

/// Largest number of cells for a pair of pieces; for the remaining cells their lower bound counts as the distance.
const MOST: usize = 20_000;

/// The points at which two stretches come nearest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Approach {
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
pub fn stretch(curve: &[Placed], [from, to]: [f64; 2]) -> Vec<Placed> {
    let mut before = 0.0;
    let mut parts = Vec::new();
    for piece in curve {
        let length = piece.shape.length();
        let (lo, hi) = ((from - before).clamp(0.0, length), (to - before).clamp(0.0, length));
        let last = parts.is_empty() && before + length >= from;
        if hi > lo || last {
            parts.push(part(piece, lo, hi));
        }
        before += length;
    }
    parts
}

fn part(piece: &Placed, from: f64, to: f64) -> Placed {
    let share = |length: f64| if piece.shape.length() > 0.0 { length / piece.shape.length() } else { 0.0 };
    let begin = Placed { shape: scaled(piece.shape, share(from)), ..*piece };
    Placed { at: begin.end(), heading: begin.heading_at_end(), shape: scaled(piece.shape, share(to - from)) }
}

fn scaled(shape: PathSegment, share: f64) -> PathSegment {
    match shape {
        PathSegment::Line { length } => PathSegment::Line { length: length * share },
        PathSegment::Arc { radius, sweep } => PathSegment::Arc { radius, sweep: sweep * share },
    }
}

pub(crate) fn point(piece: &Placed, length: f64) -> [f64; 2] {
    part(piece, 0.0, length).end()
}

/// The points at which two curves come nearest; `None` if one of them has no piece.
pub fn nearest(a: &[Placed], b: &[Placed]) -> Option<Approach> {
    let mut best: Option<Approach> = None;
    let mut before_a = 0.0;
    for own in a {
        let mut before_b = 0.0;
        for other in b {
            let mut found = pieces(own, other, best.map_or(f64::INFINITY, |best| best.distance));
            found.lengths = [found.lengths[0] + before_a, found.lengths[1] + before_b];
            best = Some(match best {
                Some(best) if best.distance <= found.distance => {
                    Approach { least: best.least.min(found.least), ..best }
                }
                Some(best) => Approach { least: best.least.min(found.least), ..found },
                None => found,
            });
            before_b += other.shape.length();
        }
        before_a += own.shape.length();
    }
    best
}

/// A rectangle of lengths; the one with the least bound is examined first.
struct Cell {
    bound: f64,
    middle: [f64; 2],
    half: [f64; 2],
}

impl PartialEq for Cell {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Cell {}

impl Ord for Cell {
    fn cmp(&self, other: &Self) -> Ordering {
        other.bound.total_cmp(&self.bound)
    }
}

impl PartialOrd for Cell {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

fn approach(a: &Placed, b: &Placed, lengths: [f64; 2]) -> Approach {
    let points = [point(a, lengths[0]), point(b, lengths[1])];
    let distance = (points[0][0] - points[1][0]).hypot(points[0][1] - points[1][1]);
    Approach { distance, least: distance, lengths, points }
}

/// The points at which two pieces come nearest. They may be others if the distance is not below `beat`.
fn pieces(a: &Placed, b: &Placed, beat: f64) -> Approach {
    if let (PathSegment::Line { .. }, PathSegment::Line { .. }) = (a.shape, b.shape) {
        return lines(a, b);
    }
    let cell = |middle: [f64; 2], half: [f64; 2]| {
        let at = approach(a, b, middle);
        // The distance of two points is at most the length of the curve between them.
        (at, Cell { bound: at.distance - half[0] - half[1], middle, half })
    };
    let halves = [a, b].map(|piece| piece.shape.length() / 2.0);
    let (mut best, first) = cell(halves, halves);
    let mut heap = BinaryHeap::from([first]);
    for _ in 0..MOST {
        let Some(next) = heap.pop() else { break };
        best.least = next.bound.max(0.0);
        if next.bound >= best.distance.min(beat) - CLOSE {
            return best;
        }
        let cut = usize::from(next.half[1] > next.half[0]);
        let mut half = next.half;
        half[cut] /= 2.0;
        for side in [-1.0, 1.0] {
            let mut middle = next.middle;
            middle[cut] += side * half[cut];
            let (at, cell) = cell(middle, half);
            if at.distance < best.distance {
                best = Approach { least: best.least, ..at };
            }
            heap.push(cell);
        }
    }
    best
}

/// Two segments cross, or are nearest at an end of one of them.
fn lines(a: &Placed, b: &Placed) -> Approach {
    let [la, lb] = [a, b].map(|piece| piece.shape.length());
    let [ua, ub] = [a, b].map(|piece| [piece.heading.cos(), piece.heading.sin()]);
    let gap = [b.at[0] - a.at[0], b.at[1] - a.at[1]];
    let cross = |u: [f64; 2], v: [f64; 2]| u[0] * v[1] - u[1] * v[0];
    let dot = |u: [f64; 2], v: [f64; 2]| u[0] * v[0] + u[1] * v[1];
    let mut candidates = Vec::new();
    let turn = cross(ua, ub);
    if turn.abs() > 1e-9 {
        let [s, t] = [cross(gap, ub) / turn, cross(gap, ua) / turn];
        if (0.0..=la).contains(&s) && (0.0..=lb).contains(&t) {
            candidates.push([s, t]);
        }
    }
    for s in [0.0, la] {
        let from = [a.at[0] + ua[0] * s - b.at[0], a.at[1] + ua[1] * s - b.at[1]];
        candidates.push([s, dot(from, ub).clamp(0.0, lb)]);
    }
    for t in [0.0, lb] {
        let from = [gap[0] + ub[0] * t, gap[1] + ub[1] * t];
        candidates.push([dot(from, ua).clamp(0.0, la), t]);
    }
    let all = candidates.into_iter().map(|lengths| approach(a, b, lengths));
    let best = all.min_by(|x, y| x.distance.total_cmp(&y.distance)).expect("four candidates at least");
    Approach { least: (best.distance - 1e-9).max(0.0), ..best }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_points_are_those_of_samples() {
        let line = Placed::line([0.0, 0.0], [4.0, 1.0]);
        let arc = Placed { at: [3.0, 2.0], heading: 0.5, shape: PathSegment::Arc { radius: 1.5, sweep: -2.5 } };
        for other in [arc, Placed::line([1.0, 3.0], [2.0, 1.0]), Placed::line([2.0, -1.0], [2.0, 2.0])] {
            let found = nearest(&[line], &[other]).unwrap();
            let mut least = f64::INFINITY;
            for i in 0..=1000 {
                for j in 0..=1000 {
                    let share = |k: i32, piece: &Placed| point(piece, piece.shape.length() * f64::from(k) / 1000.0);
                    let (p, q) = (share(i, &line), share(j, &other));
                    least = least.min((p[0] - q[0]).hypot(p[1] - q[1]));
                }
            }
            assert!(found.distance <= least + 2e-5 && found.least <= least, "{found:?} {least}");
            assert!(found.distance - found.least <= 2e-5, "{found:?}");
            let [p, q] = found.points;
            assert!(((p[0] - q[0]).hypot(p[1] - q[1]) - found.distance).abs() < 1e-12);
        }
    }

    #[test]
    fn a_stretch_is_the_part_between_two_lengths() {
        let arc = Placed { at: [2.0, 0.0], heading: 0.0, shape: PathSegment::Arc { radius: 1.0, sweep: 2.0 } };
        let curve = [Placed::line([0.0, 0.0], [2.0, 0.0]), arc];
        let part = stretch(&curve, [1.5, 3.0]);
        assert_eq!(part.len(), 2);
        assert!((part[0].at[0] - 1.5).abs() < 1e-12 && (part[0].shape.length() - 0.5).abs() < 1e-12);
        assert!((part[1].shape.length() - 1.0).abs() < 1e-12);
        assert_eq!(stretch(&curve, [4.0, 4.0]).len(), 1);
        assert_eq!(stretch(&curve, [0.0, 0.0]).len(), 1);
    }
}
