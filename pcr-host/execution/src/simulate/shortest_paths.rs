//! Shortest paths around discs: taut strings, which consist of lines that touch the discs, and arcs along them.
//!
//! A line from a disc that it passes on the side σ (+1: the disc is to the left) to one that it passes on the side τ
//! has the direction u with D · n = τ r' - σ r, where D leads from centre to centre and n is u turned left. Points are
//! discs of radius 0. Lines that cross a disc are left out. Dijkstra's algorithm finds the shortest path; its nodes are
//! lines, because the arc between two lines depends on both.

use super::vector::{PlaneVector, add, dot, norm, scale, sub};
use pcr_core::{Point, Pose, Radians};
use pcr_formats::scenario::PathSegment;
use std::f64::consts::TAU;

/// Something round to be passed.
#[derive(Clone, Copy, Debug)]
pub(super) struct RoundObstacle {
    pub(super) centre: PlaneVector,
    pub(super) radius: f64,
}

/// Lines may touch the discs that they lead along; rounding may make such a line seem to cross one by this \[m\].
const TOUCHING: f64 = 1e-9;

/// A disc and the side it is on.
#[derive(Clone, Copy, Debug, PartialEq)]
struct TangentEnd {
    place: usize,
    side: f64,
}

/// A line between two ends.
#[derive(Clone, Copy, Debug)]
struct TangentLine {
    from: TangentEnd,
    to: TangentEnd,
    length: f64,
    direction: f64,
}

/// The shortest path from one point to another around discs that do not overlap; `None` where one of the points is inside
/// a disc.
pub(super) fn taut(
    start: PlaneVector,
    goal: PlaneVector,
    discs: &[RoundObstacle],
) -> Option<(Pose<f64>, Vec<PathSegment>)> {
    let points = [start, goal].map(|centre| RoundObstacle { centre, radius: 0.0 });
    let all: Vec<RoundObstacle> = points.into_iter().chain(discs.iter().copied()).collect();
    let lines = lines(&all);
    let chain = shortest(&lines, &all)?;
    let first = chain.first()?;
    let mut path = vec![PathSegment::Line { length: first.length }];
    for pair in chain.windows(2) {
        let end = pair[0].to;
        let sweep = end.side * turn(&pair[0], &pair[1]);
        path.push(PathSegment::arc(all.get(end.place)?.radius, sweep));
        path.push(PathSegment::Line { length: pair[1].length });
    }
    Some((Pose { position: Point::new(start[0], start[1]), heading: Radians(first.direction) }, path))
}

/// All lines that cross no disc; the first two places are start and goal.
fn lines(all: &[RoundObstacle]) -> Vec<TangentLine> {
    let sides = |place: usize| if place < 2 { &[1.0][..] } else { &[1.0, -1.0][..] };
    let ends: Vec<TangentEnd> =
        (0..all.len()).flat_map(|place| sides(place).iter().map(move |&side| TangentEnd { place, side })).collect();
    let pairs = ends.iter().flat_map(|&from| ends.iter().map(move |&to| (from, to)));
    pairs
        .filter(|(from, to)| from.place != to.place && from.place != 1 && to.place != 0)
        .filter_map(|(from, to)| line(from, to, all))
        .collect()
}

fn line(from: TangentEnd, to: TangentEnd, all: &[RoundObstacle]) -> Option<TangentLine> {
    let (a, b) = (all.get(from.place)?, all.get(to.place)?);
    let apart = sub(b.centre, a.centre);
    let offset = to.side * b.radius - from.side * a.radius;
    let squared = dot(apart, apart);
    let length = (squared - offset * offset).max(0.0).sqrt();
    if length <= 0.0 {
        return None;
    }
    let along = scale(apart, length / squared);
    let unit = add(along, scale([apart[1], -apart[0]], offset / squared));
    let normal = [-unit[1], unit[0]];
    let foot = sub(a.centre, scale(normal, from.side * a.radius));
    let free = |disc: &RoundObstacle| {
        let centre = sub(disc.centre, foot);
        let nearest = scale(unit, dot(centre, unit).clamp(0.0, length));
        norm(sub(centre, nearest)) >= disc.radius - TOUCHING
    };
    all.iter().all(free).then(|| TangentLine { from, to, length, direction: unit[1].atan2(unit[0]) })
}

/// The angle of the arc between two lines \[rad\], in the direction in which the disc is passed.
fn turn(before: &TangentLine, after: &TangentLine) -> f64 {
    let angle = (before.to.side * (after.direction - before.direction)).rem_euclid(TAU);
    // A whole turn is none that rounding has made negative.
    if angle > TAU - TOUCHING { 0.0 } else { angle }
}

/// Dijkstra's algorithm: the lines of the shortest chain from the start (place 0) to the goal (place 1).
fn shortest(lines: &[TangentLine], all: &[RoundObstacle]) -> Option<Vec<TangentLine>> {
    let mut cost: Vec<f64> =
        lines.iter().map(|line| if line.from.place == 0 { line.length } else { f64::INFINITY }).collect();
    let mut before: Vec<Option<usize>> = vec![None; lines.len()];
    let mut open: Vec<usize> = (0..lines.len()).collect();
    loop {
        let next = (0..open.len()).min_by(|&a, &b| cost[open[a]].total_cmp(&cost[open[b]]))?;
        let here = open.swap_remove(next);
        if cost[here].is_infinite() {
            return None;
        }
        if lines[here].to.place == 1 {
            let mut chain = vec![lines[here]];
            let mut at = here;
            while let Some(earlier) = before[at] {
                chain.insert(0, lines[earlier]);
                at = earlier;
            }
            return Some(chain);
        }
        for &there in &open {
            if lines[there].from == lines[here].to {
                let radius = all[lines[here].to.place].radius;
                let total = cost[here] + radius * turn(&lines[here], &lines[there]) + lines[there].length;
                if total < cost[there] {
                    cost[there] = total;
                    before[there] = Some(here);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{FRAC_PI_2, PI};

    fn length(path: &[PathSegment]) -> f64 {
        path.iter().map(PathSegment::length).sum()
    }

    #[test]
    fn a_free_way_is_straight() {
        let (pose, path) =
            taut([0.0, 0.0], [3.0, 4.0], &[RoundObstacle { centre: [3.0, 0.0], radius: 1.0 }]).expect("a path");
        assert_eq!(path, [PathSegment::Line { length: 5.0 }]);
        assert!((pose.heading.0 - 4.0_f64.atan2(3.0)).abs() < 1e-15);
    }

    #[test]
    fn a_disc_in_the_middle_is_passed_along_its_rim() {
        let (_, path) =
            taut([-2.0, 0.0], [2.0, 0.0], &[RoundObstacle { centre: [0.0, 0.0], radius: 1.0 }]).expect("a path");
        // Two tangents of length √3, and what is left of half a turn.
        let expected = 2.0 * 3.0_f64.sqrt() + PI - 2.0 * (PI / 3.0);
        assert_eq!(path.len(), 3);
        assert!((length(&path) - expected).abs() < 1e-12);
    }

    #[test]
    fn two_discs_are_passed_on_both_sides() {
        let discs =
            [RoundObstacle { centre: [0.0, 0.9], radius: 1.0 }, RoundObstacle { centre: [3.0, -0.9], radius: 1.0 }];
        let (_, path) = taut([-2.0, 0.0], [5.0, 0.0], &discs).expect("a path");
        let sweeps: Vec<f64> = path
            .iter()
            .filter_map(|segment| match segment {
                PathSegment::Arc { sweep, .. } => Some(sweep.signum()),
                _ => None,
            })
            .collect();
        // Under the first one, which is then on the left, and over the second.
        assert_eq!(sweeps, [1.0, -1.0]);
        assert!(length(&path) < 7.0 + 2.0 * FRAC_PI_2);
    }

    #[test]
    fn there_is_no_way_out_of_a_disc() {
        assert!(taut([0.0, 0.0], [5.0, 0.0], &[RoundObstacle { centre: [0.1, 0.0], radius: 1.0 }]).is_none());
    }
}
