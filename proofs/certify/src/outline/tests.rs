//! Bounds, claims and motions against computations that share nothing with them: plain `f64`, densely sampled.

mod decisions;
mod delays;
mod tables;
mod wall;

use super::Body;
use super::cover::{Segments, Verdict};
use super::data::{
    RawBody, RawBodySegment, RawCourse, RawHeading, RawOutline, RawOutlinePair, RawOutlinePiece, RawOutlineTable,
};
use super::motion::{Driven, Encounter};
use super::separation::{Change, above, above_along, below, nearest, sketched};
use super::table::{Checker, Report};
use crate::ball::Ball;
use crate::dice::Dice;
use crate::double_double::DoubleDouble;
use crate::pair::TableProperty;
use crate::raw::{RawAngle, RawMotion, RawPhase, RawRegion};
use crate::table::CoverageMargin;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

fn outline(corners: &[[f64; 2]], radius: f64) -> RawOutline {
    RawOutline { corners: corners.to_vec(), radius }
}

/// A rectangle about a point.
fn rectangle(size: [f64; 2], [x, y]: [f64; 2], radius: f64) -> RawOutline {
    let [a, b] = size.map(|size| 0.5 * size);
    outline(&[[x - a, y - b], [x + a, y - b], [x + a, y + b], [x - a, y + b]], radius)
}

fn single(course: RawCourse, length: f64, heading: RawHeading) -> RawBodySegment {
    RawBodySegment { course, length, turns: Vec::new(), heading, from: 0.0, to: length }
}

fn ahead() -> RawHeading {
    RawHeading::Along(RawAngle::Radians(0.0))
}

fn body(id: u64, outline: RawOutline, start: [f64; 2], direction: f64, segments: Vec<RawBodySegment>) -> RawBody {
    let direction = RawAngle::Radians(direction);
    RawBody { id, outline, start, direction, segments, rounding: 1e-12, jump: 1e-9, step: 0.0, travel: None }
}

fn random(dice: &mut Dice, id: u64) -> RawBody {
    let offset = if dice.unit() < 0.3 { [dice.between(-2.0, 2.0), dice.between(-1.0, 1.0)] } else { [0.0; 2] };
    let count = dice.of(&[1, 2, 3, 4, 4, 4, 6, 16]);
    let size = [dice.between(0.1, 0.8), dice.between(0.1, 0.8)];
    let first = dice.between(0.0, TAU);
    let corners: Vec<_> = (0..count)
        .map(|k| {
            let angle = first + TAU * (f64::from(k) + 0.6 * dice.unit()) / f64::from(count);
            [offset[0] + size[0] * angle.cos(), offset[1] + size[1] * angle.sin()]
        })
        .collect();
    let radius = dice.of(&[0.0, 1e-3, 0.05, 0.3]);
    let turn = dice.between(0.2, TAU);
    let side = dice.of(&[-1.0, 1.0]);
    let heading = match dice.of(&[0, 1, 2, 3]) {
        0 => ahead(),
        1 => RawHeading::Along(RawAngle::Radians(PI)),
        2 => RawHeading::Along(RawAngle::Turns(dice.unit())),
        _ => RawHeading::Steady(RawAngle::Radians(dice.between(-4.0, 4.0))),
    };
    let (course, length, heading) = match dice.of(&[0, 1, 2]) {
        0 => (RawCourse::Line, dice.between(0.5, 3.0), heading),
        1 => {
            let radius = dice.between(0.05, 2.0);
            (RawCourse::Arc { radius: side * radius }, turn * radius, heading)
        }
        _ => {
            let lever = dice.of(&[0.05, 0.5, 1.0]);
            let heading = if let RawHeading::Steady(_) = heading { ahead() } else { heading };
            (RawCourse::Pivot { lever: side * lever }, turn * lever, heading)
        }
    };
    let start = [dice.between(-1.5, 1.5), dice.between(-1.5, 1.5)];
    body(id, outline(&corners, radius), start, dice.between(-4.0, 4.0), vec![single(course, length, heading)])
}

fn radians(angle: RawAngle) -> f64 {
    match angle {
        RawAngle::Radians(angle) => angle,
        RawAngle::Turns(turns) => TAU * turns,
    }
}

/// The corners after a length along the first segment, in plain numbers.
fn corners(raw: &RawBody, length: f64) -> Vec<[f64; 2]> {
    let segment = &raw.segments[0];
    let mut direction = radians(raw.direction);
    let [mut x, mut y] = raw.start;
    match segment.course {
        RawCourse::Line => {
            x += length * direction.cos();
            y += length * direction.sin();
        }
        RawCourse::Arc { radius } => {
            let after = direction + length / radius;
            x += radius * (after.sin() - direction.sin());
            y -= radius * (after.cos() - direction.cos());
            direction = after;
        }
        RawCourse::Pivot { lever } => direction += length / lever,
    }
    let heading = match segment.heading {
        RawHeading::Along(angle) => direction + radians(angle),
        RawHeading::Steady(angle) => radians(angle),
    };
    let (sin, cos) = heading.sin_cos();
    raw.outline.corners.iter().map(|[a, b]| [x + a * cos - b * sin, y + a * sin + b * cos]).collect()
}

fn inside(polygon: &[[f64; 2]], [x, y]: [f64; 2]) -> bool {
    let left = |k: usize| {
        let ([ax, ay], [bx, by]) = (polygon[k], polygon[(k + 1) % polygon.len()]);
        (bx - ax) * (y - ay) - (by - ay) * (x - ax) >= 0.0
    };
    polygon.len() > 2 && (0..polygon.len()).all(left)
}

/// Distance of two segments of lines that may cross, in plain numbers.
fn of_edges(a: [[f64; 2]; 2], b: [[f64; 2]; 2]) -> f64 {
    let cross = |o: [f64; 2], p: [f64; 2], q: [f64; 2]| (p[0] - o[0]) * (q[1] - o[1]) - (p[1] - o[1]) * (q[0] - o[0]);
    let sides = [cross(a[0], a[1], b[0]), cross(a[0], a[1], b[1]), cross(b[0], b[1], a[0]), cross(b[0], b[1], a[1])];
    if sides[0] * sides[1] < 0.0 && sides[2] * sides[3] < 0.0 {
        return 0.0;
    }
    let from = |[x, y]: [f64; 2], [[ax, ay], [bx, by]]: [[f64; 2]; 2]| {
        let square = (bx - ax).powi(2) + (by - ay).powi(2);
        let foot = if square > 0.0 { ((x - ax) * (bx - ax) + (y - ay) * (by - ay)) / square } else { 0.0 };
        let foot = foot.clamp(0.0, 1.0);
        (x - ax - foot * (bx - ax)).hypot(y - ay - foot * (by - ay))
    };
    from(a[0], b).min(from(a[1], b)).min(from(b[0], a)).min(from(b[1], a))
}

/// Distance of two convex polygons in plain numbers.
fn distance(a: &[[f64; 2]], b: &[[f64; 2]]) -> f64 {
    if inside(a, b[0]) || inside(b, a[0]) {
        return 0.0;
    }
    let edges = |polygon: &[[f64; 2]]| -> Vec<[[f64; 2]; 2]> {
        (0..polygon.len()).map(|k| [polygon[k], polygon[(k + 1) % polygon.len()]]).collect()
    };
    let (a, b) = (edges(a), edges(b));
    a.iter().flat_map(|&one| b.iter().map(move |&other| of_edges(one, other))).fold(f64::INFINITY, f64::min)
}

/// Distance of two bodies at lengths along their first segments, in plain numbers.
fn plain(raw: [&RawBody; 2], at: [f64; 2]) -> f64 {
    distance(&corners(raw[0], at[0]), &corners(raw[1], at[1]))
}

fn number(value: f64) -> Ball<f64> {
    Ball::from(value)
}

fn sure(bound: Ball<f64>) -> f64 {
    bound.mid - bound.err
}

#[test]
fn corners_are_where_plain_numbers_have_them() {
    let mut dice = Dice(1);
    for _ in 0..2000 {
        let raw = random(&mut dice, 1);
        let body = Body::new(&raw).unwrap();
        let placed = &body.segments[0];
        let length = dice.between(0.0, raw.segments[0].length);
        let expected = corners(&raw, length);
        let (near, exact) = (placed.near.posture(number(length)), placed.exact.posture(Ball::from(length)));
        for (k, plain) in expected.iter().enumerate() {
            let off = |a: f64, b: f64| (a - b).abs();
            for (ball, fine, plain) in
                [(near.corners[k].x, exact.corners[k].x, plain[0]), (near.corners[k].y, exact.corners[k].y, plain[1])]
            {
                assert!(off(ball.mid, plain) < 1e-12, "{raw:?} {length}: {ball:?} {plain}");
                assert!((fine - Ball::from(ball.mid)).to_f64().abs() <= ball.err + fine.err, "{ball:?} {fine:?}");
                assert!(ball.err < 1e-11 && fine.err < 1e-25, "{ball:?} {fine:?}");
            }
            // Speeds, by differences.
            let by = 1e-6;
            let [before, after] = [length - by, length + by].map(|length| corners(&raw, length)[k]);
            let velocity = near.velocities[k];
            let own = near.velocity(near.corners[k]);
            for (speed, own, axis) in [(velocity.x, own.x, 0), (velocity.y, own.y, 1)] {
                let slope = (after[axis] - before[axis]) / (2.0 * by);
                assert!(off(speed.mid, slope) < 1e-6 && off(own.mid, slope) < 1e-6, "{raw:?}: {speed:?} {slope}");
            }
            let speed = velocity.norm();
            assert!(sure(speed) <= placed.lever, "{speed:?} {}", placed.lever);
        }
    }
}

#[test]
fn bounds_hold_over_boxes_and_are_of_second_order() {
    let mut dice = Dice(2);
    let (mut apart, mut tight) = (0, 0.0_f64);
    for round in 0..4000 {
        let raw = [random(&mut dice, 1), random(&mut dice, 2)];
        let bodies = [Body::new(&raw[0]).unwrap(), Body::new(&raw[1]).unwrap()];
        let size = dice.of(&[1.0, 0.1, 0.01, 1e-4]);
        let lengths = [0, 1].map(|k| raw[k].segments[0].length);
        let halves = lengths.map(|length| 0.5 * length * size * if dice.unit() < 0.2 { 0.0 } else { dice.unit() });
        let middle = [0, 1].map(|k| dice.between(halves[k], lengths[k] - halves[k]));
        let near = [0, 1].map(|k| &bodies[k].segments[0].near);
        let [a, b] = [0, 1].map(|k| near[k].posture(number(middle[k])));
        let seen = below(near, [&a, &b], &Change::Box(halves.map(number)));
        let there = plain([&raw[0], &raw[1]], middle);
        // Where the polygons meet, every direction says less than nothing.
        assert!(sure(seen.middle) <= there + 1e-12 && above([&a, &b]).mid.max(0.0) >= there - 1e-12, "{round} {raw:?}");
        assert!(there == 0.0 || (seen.middle.mid - there).abs() < 1e-11, "{round}: {} {there}", seen.middle.mid);
        let most = above([&a, &b]);
        assert!((most.mid.max(0.0) - there).abs() < 1e-11, "{round}: {most:?} {there}");
        let sketch = [near[0].sketch(middle[0]), near[1].sketch(middle[1])];
        let signed = sketched([&sketch[0], &sketch[1]]);
        assert!((signed - most.mid).abs() < 1e-9, "{round}: {most:?} {signed}");
        for k in 0..60 {
            // Corners of the box, too.
            let part = |dice: &mut Dice| if k < 16 { dice.of(&[-1.0, 1.0, 0.0]) } else { dice.between(-1.0, 1.0) };
            let at = [0, 1].map(|k| middle[k] + halves[k] * part(&mut dice));
            let found = plain([&raw[0], &raw[1]], at);
            let most = seen.anywhere.to_f64();
            assert!(
                sure(seen.anywhere) <= found + 1e-12,
                "{round} {raw:?} {middle:?} {halves:?} {at:?}: {found} {most}"
            );
        }
        // What a small box loses beyond the true change is of second order.
        if there > 0.05 && size < 0.02 {
            let slope = |k: usize| {
                let by = 1e-7;
                let moved = [-by, by].map(|by| {
                    let mut at = middle;
                    at[k] += by;
                    plain([&raw[0], &raw[1]], at)
                });
                // The steeper side, where there is a kink.
                let slopes = [there - moved[0], moved[1] - there].map(|change| (change / by).abs());
                slopes[0].max(slopes[1])
            };
            let lever = [0, 1].map(|k| near[k].lever.mid);
            let ways = lever[0] * halves[0] + lever[1] * halves[1];
            let lost = there - slope(0) * halves[0] - slope(1) * halves[1] - seen.anywhere.mid;
            if ways > 1e-6 {
                (apart, tight) = (apart + 1, tight.max((lost - 1e-7) / ways));
            }
        }
    }
    // A tenth of the ways at most, with ways of up to a hundredth of the segments.
    assert!(apart > 200 && tight < 0.5, "{apart} {tight}");
}

#[test]
fn bounds_hold_along_lines_with_accelerations() {
    let mut dice = Dice(3);
    let [mut used, mut overlapping, mut slid] = [0; 3];
    for round in 0..6000 {
        let raw = [random(&mut dice, 1), random(&mut dice, 2)];
        let bodies = [Body::new(&raw[0]).unwrap(), Body::new(&raw[1]).unwrap()];
        let near = [0, 1].map(|k| &bodies[k].segments[0].near);
        let middle = [0, 1].map(|k| dice.unit() * raw[k].segments[0].length);
        let [a, b] = [0, 1].map(|k| near[k].posture(number(middle[k])));
        let speeds = [0; 2].map(|_| dice.of(&[0.0, 1.0, -0.7]));
        let accelerations = [0; 2].map(|_| dice.of(&[0.0, 0.0, 0.5, -1.0]));
        let half = dice.of(&[0.3, 0.05, 1e-3]);
        let change =
            Change::Line { speeds: speeds.map(number), accelerations: accelerations.map(number), half: number(half) };
        let seen = below(near, [&a, &b], &change);
        let pair = nearest([&a, &b]);
        let most = pair.above(near, [&a, &b], speeds.map(number), number(half));
        let sliding = pair.above_sliding(near, [&a, &b], speeds.map(number), number(half));
        let overlap = above_along(near, [&a, &b], speeds.map(number), number(half));
        for _ in 0..30 {
            let t = half * dice.of(&[-1.0, 1.0, dice.0 as f64 / u64::MAX as f64, 0.3, -0.5]);
            let at = |accelerated: f64| {
                [0, 1].map(|k| middle[k] + speeds[k] * t + 0.5 * accelerated * accelerations[k] * t * t)
            };
            let found = plain([&raw[0], &raw[1]], at(1.0));
            assert!(sure(seen.anywhere) <= found + 1e-12, "{round} {raw:?} {middle:?} {change:?}: {seen:?} {found}");
            let steady = plain([&raw[0], &raw[1]], at(0.0));
            assert!(most.mid + most.err >= steady - 1e-12, "{round} {raw:?} {middle:?} {change:?}: {most:?} {steady}");
            assert!(
                sliding.is_none_or(|most| most.mid + most.err >= steady - 1e-12),
                "{round} {raw:?} {middle:?} {change:?}: {sliding:?} {steady}"
            );
            slid += usize::from(sliding.is_some());
            let is_in = overlap.is_some_and(|most| most.mid + most.err < 0.0);
            let sketches = [0, 1].map(|k| near[k].sketch(at(0.0)[k]));
            let depth = -sketched([&sketches[0], &sketches[1]]);
            assert!(!is_in || depth >= -overlap.unwrap().mid - 1e-12, "{round} {raw:?} {middle:?} {change:?}: {depth}");
            overlapping += usize::from(is_in);
            used += usize::from(seen.anywhere.mid > 0.0);
        }
    }
    assert!(used > 10_000 && overlapping > 300 && slid > 300, "{used} {overlapping} {slid}");
}

/// Two squares of 1 m that overlap by 0.25 m along one axis and by 0.5 m along the other: the shorter translation separates them.
#[test]
fn an_overlap_is_as_deep_as_the_least_translation_that_ends_it() {
    let square = |x: f64, y: f64| [[x, y], [x + 1.0, y], [x + 1.0, y + 1.0], [x, y + 1.0]];
    assert_eq!(sketched([&square(0.0, 0.0), &square(0.75, 0.5)]), -0.25);
    // A flat outline within a square, 0.125 m from its lower side.
    assert_eq!(sketched([&square(0.0, 0.0), &[[0.25, 0.125], [0.75, 0.125]]]), -0.125);
    // Two flat ones that cross: either one gets free along its own normal.
    assert_eq!(sketched([&[[-1.0, 0.0], [1.0, 0.0]], &[[0.0, -0.5], [0.0, 0.25]]]), -0.25);
}

#[test]
fn polygons_that_overlap_are_parted_by_their_depth_and_by_nothing_less() {
    const DIRECTIONS: u32 = 90;
    let (mut dice, mut overlaps) = (Dice(7), 0);
    for round in 0..6000 {
        let raw = [random(&mut dice, 1), random(&mut dice, 2)];
        let bodies = [Body::new(&raw[0]).unwrap(), Body::new(&raw[1]).unwrap()];
        let at = [0, 1].map(|k| dice.unit() * raw[k].segments[0].length);
        let [a, b] = [0, 1].map(|k| bodies[k].segments[0].near.posture(number(at[k])));
        let depth = -above([&a, &b]).mid;
        if depth < 1e-6 {
            continue;
        }
        overlaps += 1;
        let [own, other] = [0, 1].map(|k| corners(&raw[k], at[k]));
        let moved = |[x, y]: [f64; 2], by: f64| {
            let other: Vec<[f64; 2]> = other.iter().map(|corner| [corner[0] + by * x, corner[1] + by * y]).collect();
            distance(&own, &other)
        };
        let any = (0..DIRECTIONS).map(|k| f64::from(k) * std::f64::consts::TAU / f64::from(DIRECTIONS));
        let mut directions: Vec<[f64; 2]> = any.map(|angle| [angle.cos(), angle.sin()]).collect();
        for posture in [&a, &b] {
            directions.extend(posture.normals.iter().flat_map(|normal| {
                let [x, y] = [normal.x.mid, normal.y.mid];
                [[x, y], [-x, -y]]
            }));
        }
        assert!(directions.iter().all(|&one| moved(one, depth - 1e-9) == 0.0), "{round} {raw:?} {at:?}: {depth}");
        assert!(directions.iter().any(|&one| moved(one, depth + 1e-9) > 0.0), "{round} {raw:?} {at:?}: {depth}");
        let sketches = [0, 1].map(|k| bodies[k].segments[0].near.sketch(at[k]));
        assert!((sketched([&sketches[0], &sketches[1]]) + depth).abs() < 1e-11, "{round} {raw:?} {at:?}");
    }
    assert!(overlaps > 300, "{overlaps}");
}

#[test]
fn searches_see_the_distance_that_there_is() {
    let (mut dice, mut crossing) = (Dice(6), 0);
    for round in 0..20_000 {
        let raw = [random(&mut dice, 1), random(&mut dice, 2)];
        let bodies = [Body::new(&raw[0]).unwrap(), Body::new(&raw[1]).unwrap()];
        let at = [0, 1].map(|k| dice.unit() * raw[k].segments[0].length);
        let [a, b] = [0, 1].map(|k| bodies[k].segments[0].near.sketch(at[k]));
        let (found, there) = (sketched([&a, &b]), plain([&raw[0], &raw[1]], at));
        assert!((found.max(0.0) - there).abs() < 1e-12, "{round} {raw:?} {at:?}: {found} {there}");
        crossing += usize::from(there == 0.0 && raw.iter().any(|body| body.outline.corners.len() == 2));
    }
    assert!(crossing > 100, "{crossing}");
}

fn number_of(ends: [f64; 2]) -> [DoubleDouble; 2] {
    ends.map(DoubleDouble::from)
}

/// The least distance over a grid, refined about its least points, in plain numbers.
fn least(raw: [&RawBody; 2], ranges: [[f64; 2]; 2]) -> f64 {
    const PARTS: usize = 60;
    let mut points = Vec::new();
    let at = |k: usize, part: f64| ranges[k][0] + (ranges[k][1] - ranges[k][0]) * part;
    for i in 0..=PARTS {
        for j in 0..=PARTS {
            let part = [i, j].map(|k| k as f64 / PARTS as f64);
            points.push((plain(raw, [at(0, part[0]), at(1, part[1])]), part));
        }
    }
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut best = f64::INFINITY;
    for &(mut found, mut part) in points.iter().take(8) {
        let mut step = 1.0 / PARTS as f64;
        while step > 1e-9 && found > 0.0 {
            let moves =
                [[-1.0, 0.0], [1.0, 0.0], [0.0, -1.0], [0.0, 1.0], [1.0, 1.0], [-1.0, -1.0], [1.0, -1.0], [-1.0, 1.0]];
            let tried = moves.map(|by| {
                let part = [0, 1].map(|k| (part[k] + step * by[k]).clamp(0.0, 1.0));
                (plain(raw, [at(0, part[0]), at(1, part[1])]), part)
            });
            let better = tried.into_iter().fold((found, part), |a, b| if b.0 < a.0 { b } else { a });
            if better.0 < found { (found, part) = better } else { step *= 0.5 }
        }
        best = best.min(found);
    }
    best
}

#[test]
fn boxes_are_farther_than_a_bit_less_than_their_least_distance_and_not_than_a_bit_more() {
    let mut dice = Dice(4);
    let (mut proved, mut steps) = (0, 0);
    for round in 0..150 {
        let raw = [random(&mut dice, 1), random(&mut dice, 2)];
        let bodies = [Body::new(&raw[0]).unwrap(), Body::new(&raw[1]).unwrap()];
        let segments = Segments([&bodies[0].segments[0], &bodies[1].segments[0]]);
        let ranges = [0, 1].map(|k| {
            let length = raw[k].segments[0].length;
            let from = dice.between(0.0, length);
            [from, (from + dice.between(0.0, length)).min(length)]
        });
        let found = least([&raw[0], &raw[1]], ranges);
        let boxes = ranges.map(number_of);
        if found > 2e-6 {
            proved += 1;
            let outcome = segments.farther(boxes, Ball::from(found - 1e-6), &mut steps);
            assert_eq!(outcome, Verdict::Proved, "{round} {raw:?} {ranges:?} {found}");
        }
        let outcome = segments.farther(boxes, Ball::from(found + 1e-6), &mut steps);
        let Verdict::Refuted(at) = outcome else { panic!("{round} {raw:?} {ranges:?} {found}: {outcome:?}") };
        assert!(plain([&raw[0], &raw[1]], at.map(DoubleDouble::to_f64)) < found + 1e-6);
    }
    assert!(proved > 60 && steps < 150 * 20_000, "{proved} {steps}");
}

/// A rectangle of 1.2 by 0.8 m that turns about its centre, and a wall of 4 by 0.2 m that comes down upon it.
fn turning_beside_a_wall() -> [RawBody; 2] {
    let turning = body(
        1,
        rectangle([1.2, 0.8], [0.0; 2], 0.0),
        [0.0; 2],
        0.0,
        vec![single(RawCourse::Pivot { lever: 1.0 }, TAU, ahead())],
    );
    let across = RawHeading::Steady(RawAngle::Radians(0.0));
    let wall = body(
        2,
        rectangle([4.0, 0.2], [0.0; 2], 0.05),
        [0.0, 1.5],
        -FRAC_PI_2,
        vec![single(RawCourse::Line, 1.2, across)],
    );
    [turning, wall]
}

/// Rectangles with all contacts of these two, in closed form: four while only corners can touch, two from when a narrow side can, one from
/// when a long side can.
fn rectangles_beside_a_wall(radius: f64, by: f64) -> Vec<[[f64; 2]; 2]> {
    let reach = 0.6_f64.hypot(0.4);
    let first = 0.4_f64.atan2(0.6);
    let tops = [FRAC_PI_2 - first, FRAC_PI_2 + first, 3.0 * FRAC_PI_2 - first, 3.0 * FRAC_PI_2 + first];
    let [births, narrow, long] = [reach, 0.6, 0.4].map(|height| 1.4 - radius - height);
    let wide = (0.6 / reach).acos();
    let mut all: Vec<_> = tops.iter().map(|top| [[top - wide - by, top + wide + by], [births - by, narrow]]).collect();
    all.push([[0.0, PI + by], [narrow, long]]);
    all.push([[PI - by, TAU], [narrow, long]]);
    all.push([[0.0, TAU], [long, 1.2]]);
    all
}

fn placed(rectangles: &[[[f64; 2]; 2]]) -> Vec<[[DoubleDouble; 2]; 2]> {
    rectangles.iter().map(|rectangle| rectangle.map(number_of)).collect()
}

/// From rest to rest, with the top speed in the middle.
fn travel(start: f64, length: f64, top: f64) -> RawMotion {
    let half = length / top;
    let phases = vec![
        RawPhase { time: [0.0, half], length: [0.0, 0.5 * length], speed: [0.0, top] },
        RawPhase { time: [half, 2.0 * half], length: [0.5 * length, length], speed: [top, 0.0] },
    ];
    RawMotion { start, phases, lag: 0.0, time_excess: 0.0 }
}

/// The travelled length, in plain numbers.
fn travelled(raw: &RawBody, time: f64) -> f64 {
    let (travel, length) = (raw.travel.as_ref().unwrap(), raw.segments[0].length);
    let half = travel.phases[0].time[1];
    let since = (time - travel.start).clamp(0.0, 2.0 * half);
    let top = travel.phases[0].speed[1];
    if since < half {
        0.5 * top / half * since * since
    } else {
        length - 0.5 * top / half * (2.0 * half - since).powi(2)
    }
}

#[test]
fn motions_agree_with_samples() {
    let mut dice = Dice(5);
    let (mut met, mut passed, mut steps) = (0, 0, 0);
    for round in 0..300 {
        let mut raw = [random(&mut dice, 1), random(&mut dice, 2)];
        for one in &mut raw {
            let top = dice.between(0.3, 2.0);
            one.travel = Some(travel(dice.between(0.0, 2.0), one.segments[0].length, top));
        }
        let distance = |t: f64| plain([&raw[0], &raw[1]], [travelled(&raw[0], t), travelled(&raw[1], t)]);
        let (span, parts) = (20.0, 10_000);
        let times = || (0..=parts).map(|k| span * f64::from(k) / f64::from(parts));
        let mut samples: Vec<_> = times().map(|t| (distance(t), t)).collect();
        samples.sort_by(|a, b| a.0.total_cmp(&b.0));
        let refined = samples.iter().take(20).map(|&(mut found, mut at)| {
            let mut step = span / f64::from(parts);
            while step > 1e-10 {
                let tried = [at - step, at + step].map(|t| (distance(t.clamp(0.0, span)), t.clamp(0.0, span)));
                match tried.into_iter().find(|(less, _)| *less < found) {
                    Some(better) => (found, at) = better,
                    None => step *= 0.5,
                }
            }
            found
        });
        let least = refined.fold(f64::INFINITY, f64::min);
        let radius = raw[0].outline.radius + raw[1].outline.radius;
        let driven = |raw: &[RawBody; 2], check: &mut dyn FnMut(&Encounter<'_>)| {
            let bodies = [Body::new(&raw[0]).unwrap(), Body::new(&raw[1]).unwrap()];
            let driven = [0, 1].map(|k| Driven::new(&bodies[k], [0.0, 1e6]).unwrap());
            check(&Encounter::new(&driven[0], &driven[1]));
        };
        // With the radius at what samples find, a bit less or more.
        for by in [-1e-4, 1e-4] {
            let mut close = raw.clone();
            close[0].outline.radius = least + by;
            close[1].outline.radius = 0.0;
            if close[0].outline.radius < 0.0 || least == 0.0 {
                continue;
            }
            driven(&close, &mut |pair| {
                let answer = pair.is_clear([0.0, span], &mut steps);
                assert_eq!((answer.is_proved(), answer.is_refuted()), (by < 0.0, by > 0.0), "{round} {by}: {answer:?}");
            });
        }
        // The first contact, and all intervals of contact, as samples have them and bisection refines them.
        let mut ends = Vec::new();
        let is_in = |t: f64| distance(t) <= radius;
        let mut before = is_in(0.0);
        if before {
            ends.push(0.0);
        }
        for t in times().skip(1) {
            if is_in(t) != before {
                let (mut lo, mut hi) = (t - span / f64::from(parts), t);
                for _ in 0..50 {
                    let middle = 0.5 * (lo + hi);
                    if is_in(middle) == before { lo = middle } else { hi = middle }
                }
                // Outward, so that the intervals hold all contacts.
                ends.push(if before { hi + 1e-7 } else { lo - 1e-7 });
                before = !before;
            }
        }
        if before {
            ends.push(span);
        }
        let told: Vec<[f64; 2]> = ends.chunks(2).map(|pair| [pair[0], pair[1]]).collect();
        if (least - radius).abs() < 1e-6 || told.iter().any(|[begin, end]| end - begin < 2e-2) {
            continue;
        }
        driven(&raw, &mut |pair| {
            let all = [0.0, span];
            assert_eq!(pair.is_clear(all, &mut steps).is_refuted(), least < radius, "{round}");
            let answer = pair.are_conflicts(all, &told, 1e-5, &mut steps);
            assert!(answer.is_proved(), "{round} {told:?}: {answer:?}");
            let first = told.first().map(|interval| interval[0]);
            let answer = pair.is_first_conflict(all, first, 1e-5, &mut steps);
            assert!(answer.is_proved(), "{round} {first:?}: {answer:?}");
            let Some(&[begin, end]) = told.first() else {
                passed += 1;
                return;
            };
            met += 1;
            assert!(pair.is_first_conflict(all, None, 1e-5, &mut steps).is_refuted());
            assert!(pair.are_conflicts(all, &told[1..], 1e-5, &mut steps).is_refuted());
            // An interval that begins too late, or ends too early, by 5 ms: where the bodies do not just graze there.
            let deep = |t: f64| distance(t) < radius - 1e-6;
            for (altered, time) in [([begin + 5e-3, end], begin + 2.5e-3), ([begin, end - 5e-3], end - 2.5e-3)] {
                if deep(time) && distance(altered[0]) < radius && altered[1] < span {
                    let mut all_told = told.clone();
                    all_told[0] = altered;
                    let answer = pair.are_conflicts(all, &all_told, 1e-5, &mut steps);
                    assert!(answer.is_refuted(), "{round} {altered:?}: {answer:?}");
                    if altered[0] > begin {
                        let answer = pair.is_first_conflict(all, Some(altered[0]), 1e-5, &mut steps);
                        assert!(answer.is_refuted(), "{round} {altered:?}: {answer:?}");
                    }
                }
            }
            // One that begins too early, where the bodies are not near.
            let early = begin - 5e-3;
            if early > 0.0 && distance(early) > radius + 1e-4 {
                assert!(pair.is_first_conflict(all, Some(early), 1e-5, &mut steps).is_refuted());
                assert!(pair.is_contact(early, 1e-5).is_refuted());
            }
        });
    }
    assert!(met > 60 && passed > 60 && steps < 2_000_000, "{met} {passed} {steps}");
}
