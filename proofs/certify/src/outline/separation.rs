//! Bounds on the distance of two polygons: at one pair of lengths, over a box of lengths, and along a line through the lengths.
//!
//! *From below.* For any unit vector m, the distance is at least the least `m·(x - y)` for corners x of one polygon and y of the other one.
//! Which m is taken does not matter for the proof: the outward normals of all edges, and one direction between the corners that are
//! nearest to each other, which together attain the distance. m is kept in the frame of one body, the *owner*, and turns with it: there
//! all m·y are constant, and each x of the other body moves along a curve p. With its derivative and a bound on the second one, `bend`,
//! Taylor's theorem bounds `m·p` (the corners of the owner with their support as zero):
//!
//! ```text
//! m·p(h) >= m·p - |∂ m·p| h - ½ max |p''| h²
//! ```
//!
//! or, over large boxes, the distance in the middle less the ways that any point of the two bodies goes: lever times length, for each.
//!
//! *From above.* The distance is no more than that of any two points of the polygons. They have a point in common if a corner of one lies in a
//! triangle of corners of the other one, if two edges cross, or if no normal of an edge parts them and neither is flat. Then the distance counts as negative: minus the length of the least translation that
//! separates them, which is that along the normal of some edge. It changes no faster than the bodies go, as the distance does.
//!
//! *Second derivative.* A corner goes `x = z + Rot(θ) w` ([`super::body`]) or along a line. In a frame that turns by φ about c,
//!
//! ```text
//! p = Rot(-φ) (z - c) + Rot(θ - φ) w:   |p''| <= (φ'² + |φ''|) |z - c| + ((θ' - φ')² + |θ'' - φ''|) |w|
//! p = Rot(-φ) (x - c), x on a line:     |p''| <= (φ'² + |φ''|) |x - c| + 2 |φ'| |x'| + |x''|
//! ```
//!
//! and in one that only moves, the second derivatives of both add up.

use super::body::{Carried, Posture, Sweep};
use crate::ball::{Ball, BallReal, Ternary};
use crate::plane::BallVector;

/// How lengths change about the middle of what is looked at.
#[derive(Clone, Copy, Debug)]
pub enum Change<R> {
    /// Each of the two by no more than this, whatever the other one does \[m\].
    Box([Ball<R>; 2]),
    /// Both at once, each with a speed in the middle and an acceleration, for so long before and after.
    Line {
        /// First derivatives.
        speeds: [Ball<R>; 2],
        /// Second derivatives, constant.
        accelerations: [Ball<R>; 2],
        /// Half the duration.
        half: Ball<R>,
    },
    /// Each on a clock of its own, with a speed in the middle and an acceleration: the first clock by so much before and after, the second one
    /// by as much, and by a shift besides.
    Clocks {
        /// First derivatives.
        speeds: [Ball<R>; 2],
        /// Second derivatives, constant.
        accelerations: [Ball<R>; 2],
        /// Bound on the change of the first clock.
        half: Ball<R>,
        /// Bound on the shift.
        shift: Ball<R>,
    },
}

/// Bounds on first and second derivatives of two angles, of the own length and so on; of the own body o in the frame of the owner f.
struct Rates<R> {
    own: [Ball<R>; 2],
    frame: [Ball<R>; 2],
    apart: [Ball<R>; 2],
    /// Of the length of the own body.
    length: [Ball<R>; 2],
    half: Ball<R>,
}

impl<R: BallReal> Change<R> {
    fn rates(&self, bodies: [&Carried<R>; 2], frame: usize) -> Rates<R> {
        let own = 1 - frame;
        match self {
            Self::Box(halves) => {
                let zero = Ball::from(0.0);
                let [o, f] = [own, frame].map(|k| bodies[k].rate().abs() * halves[k]);
                Rates {
                    own: [o, zero],
                    frame: [f, zero],
                    apart: [o + f, zero],
                    length: [halves[own], zero],
                    half: Ball::from(1.0),
                }
            }
            Self::Line { speeds, accelerations, half } => {
                let first = [own, frame].map(|k| bodies[k].rate() * speeds[k]);
                let second = [own, frame].map(|k| bodies[k].rate() * accelerations[k]);
                let bound = |first: Ball<R>, second: Ball<R>| [first.abs() + second.abs() * *half, second.abs()];
                Rates {
                    own: bound(first[0], second[0]),
                    frame: bound(first[1], second[1]),
                    apart: bound(first[0] - first[1], second[0] - second[1]),
                    length: bound(speeds[own], accelerations[own]),
                    half: *half,
                }
            }
            // Along the line from the middle to any two clock times, each length has these bounds on its derivatives.
            Self::Clocks { speeds, accelerations, half, shift } => {
                let spans = [*half, *half + *shift];
                let squares = squares(*half, *shift);
                let turns = [0, 1].map(|k| [bodies[k].rate() * speeds[k], bodies[k].rate() * accelerations[k]]);
                let bound = |k: usize, [first, second]: [Ball<R>; 2]| {
                    let second = second.abs() * spans[k] * spans[k];
                    [first.abs() * spans[k] + second, second]
                };
                let second = (turns[0][1] - turns[1][1]).abs() * squares[0] + turns[1][1].abs() * squares[1];
                let first = (turns[0][0] - turns[1][0]).abs() * *half + turns[1][0].abs() * *shift;
                Rates {
                    own: bound(own, turns[own]),
                    frame: bound(frame, turns[frame]),
                    apart: [first + second, second],
                    length: bound(own, [speeds[own], accelerations[own]]),
                    half: Ball::from(1.0),
                }
            }
        }
    }
}

/// Bounds on the square of the change of the first clock, and on what that of the second one is more or less.
fn squares<R: BallReal>(half: Ball<R>, shift: Ball<R>) -> [Ball<R>; 2] {
    [half * half, (Ball::from(2.0) * half + shift) * shift]
}

/// Bound on the second derivative of the way of a corner of one body, seen from the other one, which is the `frame`.
fn bend<R: BallReal>(
    change: &Change<R>,
    bodies: [&Carried<R>; 2],
    frame: usize,
    rates: &Rates<R>,
    corner: usize,
    at: BallVector<R>,
) -> Ball<R> {
    let (own, owner) = (bodies[1 - frame], bodies[frame]);
    let turns = |[first, second]: [Ball<R>; 2]| first * first + second;
    let by_itself = || match own.sweep {
        Sweep::Line { .. } => own.lever * rates.length[1],
        _ => turns(rates.own) * own.arms[corner],
    };
    match (owner.sweep, own.sweep) {
        (Sweep::Turn { centre, .. }, Sweep::Line { .. }) => {
            let [speed, acceleration] = rates.length.map(|length| own.lever * length);
            let farthest = (at - centre).norm() + speed * rates.half;
            turns(rates.frame) * farthest + Ball::from(2.0) * rates.frame[0] * speed + acceleration
        }
        (Sweep::Turn { centre, .. }, _) => {
            turns(rates.frame) * (own.hub(corner) - centre).norm() + turns(rates.apart) * own.arms[corner]
        }
        (Sweep::Line { along }, Sweep::Line { along: own_along }) => match change {
            Change::Box(_) => Ball::from(0.0),
            Change::Line { accelerations, .. } => {
                (own_along.times(accelerations[1 - frame]) - along.times(accelerations[frame])).norm()
            }
            Change::Clocks { accelerations, half, shift, .. } => {
                let squares = squares(*half, *shift);
                let both = (own_along.times(accelerations[1 - frame]) - along.times(accelerations[frame])).norm();
                both * squares[0] + bodies[1].lever * accelerations[1].abs() * squares[1]
            }
        },
        (Sweep::Line { .. }, _) => match change {
            Change::Box(_) => by_itself(),
            Change::Line { accelerations, .. } => by_itself() + owner.lever * accelerations[frame].abs(),
            Change::Clocks { accelerations, half, shift, .. } => {
                let span = if frame == 0 { *half } else { *half + *shift };
                by_itself() + owner.lever * accelerations[frame].abs() * span * span
            }
        },
        (Sweep::Circle { arm, .. }, _) => by_itself() + turns(rates.frame) * arm.norm(),
    }
}

/// A unit vector that moves with one of two bodies, and points away from it.
#[derive(Clone, Copy, Debug)]
struct Direction<R> {
    outward: BallVector<R>,
    owner: usize,
    /// The corner of the owner that is farthest in this direction, about.
    support: usize,
    /// How far the bodies are apart in this direction, about \[m\].
    apart: f64,
}

/// What is known of a distance about the middle of what is looked at.
#[derive(Clone, Copy, Debug)]
pub struct Below<R> {
    /// A lower bound in the middle; a negative one says nothing \[m\].
    pub middle: Ball<R>,
    /// A lower bound wherever the lengths may be \[m\].
    pub anywhere: Ball<R>,
    /// How much of the distance each of two lengths may take, about: which one to cut.
    pub weights: [f64; 2],
    /// How the bound changes with each of two lengths, about.
    pub slopes: [f64; 2],
}

/// Directions that are looked at closely.
const CLOSELY: usize = 4;

/// A lower bound on the distance of two polygons about these postures.
pub fn below<R: BallReal>(bodies: [&Carried<R>; 2], postures: [&Posture<R>; 2], change: &Change<R>) -> Below<R> {
    let mut directions = directions(postures);
    directions.sort_by(|a, b| b.apart.total_cmp(&a.apart));
    let mut found: Option<Below<R>> = None;
    for direction in directions.into_iter().take(CLOSELY) {
        let other = along(bodies, postures, change, direction);
        found = Some(found.map_or(other, |best| {
            // The direction in which they are farthest apart in the middle: cutting what it loses makes it show the claim, while another one
            // may lose nothing and be of no use.
            let better = if surely(other.middle) > surely(best.middle) { other } else { best };
            let (middle, anywhere) = (greater(best.middle, other.middle), greater(best.anywhere, other.anywhere));
            Below { middle, anywhere, ..better }
        }));
    }
    let nothing = Ball::from(f64::NEG_INFINITY);
    let mut found = found.unwrap_or(Below { middle: nothing, anywhere: nothing, weights: [1.0; 2], slopes: [0.0; 2] });
    let ways = match change {
        Change::Box(halves) => bodies[0].lever * halves[0] + bodies[1].lever * halves[1],
        Change::Line { speeds, accelerations, half } => {
            let way = |k: usize| bodies[k].lever * (speeds[k].abs() + accelerations[k].abs() * *half) * *half;
            way(0) + way(1)
        }
        Change::Clocks { speeds, accelerations, half, shift } => {
            let way =
                |k: usize, span: Ball<R>| bodies[k].lever * (speeds[k].abs() + accelerations[k].abs() * span) * span;
            way(0, *half) + way(1, *half + *shift)
        }
    };
    found.anywhere = greater(found.anywhere, found.middle - ways);
    found
}

/// What a lower bound says for sure.
fn surely<R: BallReal>(bound: Ball<R>) -> f64 {
    bound.to_f64() - bound.err
}

/// The better one of two lower bounds.
fn greater<R: BallReal>(a: Ball<R>, b: Ball<R>) -> Ball<R> {
    // What is no number is no bound.
    if surely(b) > surely(a) || surely(a).is_nan() { b } else { a }
}

/// All directions in which the bodies may be apart: the normals of the edges, and that between the nearest corners.
fn directions<R: BallReal>(postures: [&Posture<R>; 2]) -> Vec<Direction<R>> {
    let points = postures.map(|posture| posture.corners.iter().map(rough).collect::<Vec<_>>());
    let mut all = Vec::with_capacity(2 + postures[0].normals.len() + postures[1].normals.len());
    let mut add = |outward: BallVector<R>, owner: usize| {
        let [x, y] = rough(&outward);
        let along = |[a, b]: [f64; 2]| x * a + y * b;
        let farthest = points[owner].iter().enumerate().map(|(k, &corner)| (along(corner), k));
        let (most, support) = farthest.fold((f64::NEG_INFINITY, 0), |a, b| if b.0 > a.0 { b } else { a });
        let least = points[1 - owner].iter().map(|&corner| along(corner)).fold(f64::INFINITY, f64::min);
        all.push(Direction { outward, owner, support, apart: least - most });
    };
    for (owner, posture) in postures.iter().enumerate() {
        posture.normals.iter().for_each(|&normal| add(normal, owner));
    }
    let mut nearest = (f64::INFINITY, [0.0; 2]);
    for a in &points[0] {
        for b in &points[1] {
            let between = [b[0] - a[0], b[1] - a[1]];
            let square = between[0] * between[0] + between[1] * between[1];
            if square < nearest.0 {
                nearest = (square, between);
            }
        }
    }
    let (square, [x, y]) = nearest;
    if square > 0.0 && square.is_finite() {
        let size = square.sqrt();
        let guess = BallVector { x: Ball::from(x / size), y: Ball::from(y / size) };
        let length = guess.norm();
        let unit = BallVector { x: guess.x / length, y: guess.y / length };
        add(unit, 0);
        add(unit.times(Ball::from(-1.0)), 1);
    }
    all
}

fn rough<R: BallReal>(vector: &BallVector<R>) -> [f64; 2] {
    [vector.x.to_f64(), vector.y.to_f64()]
}

fn along<R: BallReal>(
    bodies: [&Carried<R>; 2],
    postures: [&Posture<R>; 2],
    change: &Change<R>,
    direction: Direction<R>,
) -> Below<R> {
    let Direction { outward, owner, support, .. } = direction;
    let own = 1 - owner;
    let rates = change.rates(bodies, owner);
    let from = postures[owner].corners[support];
    let zero = Ball::from(0.0);
    // The support is one of them, so that 0 is among these.
    let reach = postures[owner]
        .corners
        .iter()
        .enumerate()
        .filter(|(place, _)| *place != support)
        .fold(zero, |most, (_, &corner)| most.max(outward.dot(corner - from)));
    let mut found: Option<Below<R>> = None;
    for (corner, &at) in postures[own].corners.iter().enumerate() {
        let middle = outward.dot(at - from) - reach;
        let [by_own, by_owner] =
            [outward.dot(postures[own].velocities[corner]), -outward.dot(postures[owner].velocity(at))];
        let second = bend(change, bodies, owner, &rates, corner, at);
        let (lost, weights) = match change {
            Change::Box(halves) => {
                let ways = [by_own.abs() * halves[own], by_owner.abs() * halves[owner]];
                let parts = [rates.own[0] * rates.own[0] * bodies[own].arms[corner], second];
                let [a, b] = ways.map(|way| way.to_f64());
                let of_own = 0.5 * parts[0].to_f64();
                let of_owner = (0.5 * (parts[1].to_f64() - parts[0].to_f64())).max(0.0);
                let mut weights = [0.0; 2];
                (weights[own], weights[owner]) = (a + of_own, b + of_owner);
                (ways[0] + ways[1] + second.half(), weights)
            }
            Change::Line { speeds, half, .. } => {
                let slope = by_own * speeds[own] + by_owner * speeds[owner];
                (slope.abs() * *half + (second * *half * *half).half(), [1.0; 2])
            }
            Change::Clocks { speeds, half, shift, .. } => {
                let [first, second_clock] = if own == 0 { [by_own, by_owner] } else { [by_owner, by_own] };
                let by_shift = second_clock * speeds[1];
                let ways = [(first * speeds[0] + by_shift).abs() * *half, by_shift.abs() * *shift];
                let [time, delay] = [half, shift].map(|span| span.to_f64());
                let share = if time + delay > 0.0 { time / (time + delay) } else { 0.5 };
                let bent = 0.5 * second.to_f64();
                let weights = [ways[0].to_f64() + bent * share, ways[1].to_f64() + bent * (1.0 - share)];
                (ways[0] + ways[1] + second.half(), weights)
            }
        };
        let mut slopes = [0.0; 2];
        (slopes[own], slopes[owner]) = (by_own.to_f64(), by_owner.to_f64());
        let this = Below { middle, anywhere: middle - lost, weights, slopes };
        found = Some(found.map_or(this, |least| Below {
            middle: least.middle.min(this.middle),
            anywhere: least.anywhere.min(this.anywhere),
            ..if surely(this.anywhere) < surely(least.anywhere) { this } else { least }
        }));
    }
    let nothing = Ball::from(f64::NEG_INFINITY);
    found.unwrap_or(Below { middle: nothing, anywhere: nothing, weights: [1.0; 2], slopes: [0.0; 2] })
}

/// A corner of one body and a point of an edge of the other one, which is the frame.
#[derive(Clone, Copy, Debug)]
pub struct Nearest {
    frame: usize,
    corner: usize,
    edge: usize,
    /// Where on the edge, from 0 to 1.
    part: f64,
    /// Their distance, about \[m\].
    pub distance: f64,
}

/// The nearest points of two polygons that do not meet, about.
pub fn nearest<R: BallReal>(postures: [&Posture<R>; 2]) -> Nearest {
    let points = postures.map(|posture| posture.corners.iter().map(rough).collect::<Vec<_>>());
    nearest_of([&points[0], &points[1]])
}

fn nearest_of(points: [&[[f64; 2]]; 2]) -> Nearest {
    let mut best = Nearest { frame: 0, corner: 0, edge: 0, part: 0.0, distance: f64::INFINITY };
    for frame in [0, 1] {
        let (edges, corners) = (points[frame], points[1 - frame]);
        for (edge, &[ax, ay]) in edges.iter().enumerate() {
            let [bx, by] = edges[(edge + 1) % edges.len()];
            let [ex, ey] = [bx - ax, by - ay];
            let square = ex * ex + ey * ey;
            for (corner, &[x, y]) in corners.iter().enumerate() {
                let foot = if square > 0.0 { ((x - ax) * ex + (y - ay) * ey) / square } else { 0.0 };
                let part = foot.clamp(0.0, 1.0);
                let [x, y] = [x - ax - part * ex, y - ay - part * ey];
                let distance = (x * x + y * y).sqrt();
                if distance < best.distance {
                    best = Nearest { frame, corner, edge, part, distance };
                }
            }
        }
    }
    best
}

/// The signed distance of two polygons, about \[m\]. For searches, on which nothing rests.
pub(crate) fn sketched(points: [&[[f64; 2]]; 2]) -> f64 {
    let side = |[ax, ay]: [f64; 2], [bx, by]: [f64; 2], [x, y]: [f64; 2]| (bx - ax) * (y - ay) - (by - ay) * (x - ax);
    let edges = |polygon: &[[f64; 2]]| -> Vec<[[f64; 2]; 2]> {
        (0..polygon.len()).map(|k| [polygon[k], polygon[(k + 1) % polygon.len()]]).collect()
    };
    let [a, b] = points.map(edges);
    let is_inside = |polygon: &[[[f64; 2]; 2]], point: [f64; 2]| {
        polygon.len() > 2 && polygon.iter().all(|edge| side(edge[0], edge[1], point) >= 0.0)
    };
    let cross = |one: &[[f64; 2]; 2], other: &[[f64; 2]; 2]| {
        side(one[0], one[1], other[0]) * side(one[0], one[1], other[1]) < 0.0
            && side(other[0], other[1], one[0]) * side(other[0], other[1], one[1]) < 0.0
    };
    let meet = is_inside(&a, points[1][0])
        || is_inside(&b, points[0][0])
        || a.iter().any(|one| b.iter().any(|other| cross(one, other)));
    if !meet {
        return nearest_of(points).distance;
    }
    let mut most: f64 = f64::NEG_INFINITY;
    for [own, other] in [[0, 1], [1, 0]] {
        for (k, &[ax, ay]) in points[own].iter().enumerate() {
            let [bx, by] = points[own][(k + 1) % points[own].len()];
            let length = (bx - ax).hypot(by - ay);
            if length > 0.0 {
                let beyond = |[x, y]: &[f64; 2]| ((x - ax) * (by - ay) - (y - ay) * (bx - ax)) / length;
                most = most.max(points[other].iter().map(beyond).fold(f64::INFINITY, f64::min));
            }
        }
    }
    most.min(0.0)
}

impl Nearest {
    /// The point of the edge at these postures.
    fn point<R: BallReal>(&self, posture: &Posture<R>) -> BallVector<R> {
        let (from, to) = (posture.corners[self.edge], posture.corners[(self.edge + 1) % posture.corners.len()]);
        from + (to - from).times(Ball::from(self.part))
    }

    /// An upper bound on the distance of the polygons at these postures \[m\].
    pub fn distance<R: BallReal>(&self, postures: [&Posture<R>; 2]) -> Ball<R> {
        (postures[1 - self.frame].corners[self.corner] - self.point(postures[self.frame])).norm()
    }

    /// The speed of the other body at which the two points move as little as possible relative to each other while the body `of` has the
    /// speed 1, about.
    pub fn match_speed<R: BallReal>(&self, postures: [&Posture<R>; 2], of: usize) -> f64 {
        let own = 1 - self.frame;
        let at = postures[own].corners[self.corner];
        let speed = |body: usize| {
            rough(&if body == own { postures[own].velocities[self.corner] } else { postures[body].velocity(at) })
        };
        let ([ax, ay], [bx, by]) = (speed(of), speed(1 - of));
        let square = bx * bx + by * by;
        if square > 0.0 { (ax * bx + ay * by) / square } else { 0.0 }
    }

    /// An upper bound on the distance of the polygons wherever the lengths may be \[m\]: the distance of these two points of the bodies.
    pub fn above<R: BallReal>(
        &self,
        bodies: [&Carried<R>; 2],
        postures: [&Posture<R>; 2],
        speeds: [Ball<R>; 2],
        half: Ball<R>,
    ) -> Ball<R> {
        let (frame, own) = (self.frame, 1 - self.frame);
        let zero = Ball::from(0.0);
        let change = Change::Line { speeds, accelerations: [zero; 2], half };
        let rates = change.rates(bodies, frame);
        let at = postures[own].corners[self.corner];
        let between = at - self.point(postures[frame]);
        let slope = postures[own].velocities[self.corner].times(speeds[own])
            - postures[frame].velocity(at).times(speeds[frame]);
        let second = bend(&change, bodies, frame, &rates, self.corner, at);
        // The distance from a point is convex along a line: its most is at an end.
        let by = slope.times(half);
        let ends = (between + by).norm().max((between - by).norm());
        ends + (second * half * half).half()
    }
}

impl Nearest {
    /// The same as [`Nearest::above`], of the corner and its foot on the edge, wherever it slides to; none if it may leave the edge. Near
    /// contact of polygons that are not rounded, two points that slide along one another say nothing.
    pub fn above_sliding<R: BallReal>(
        &self,
        bodies: [&Carried<R>; 2],
        postures: [&Posture<R>; 2],
        speeds: [Ball<R>; 2],
        half: Ball<R>,
    ) -> Option<Ball<R>> {
        let (frame, own) = (self.frame, 1 - self.frame);
        let edge = postures[frame];
        let (&normal, from) = (edge.normals.get(self.edge)?, edge.corners[self.edge]);
        let length = (edge.corners[(self.edge + 1) % edge.corners.len()] - from).norm();
        let change = Change::Line { speeds, accelerations: [Ball::from(0.0); 2], half };
        let rates = change.rates(bodies, frame);
        let at = postures[own].corners[self.corner];
        let slope = postures[own].velocities[self.corner].times(speeds[own]) - edge.velocity(at).times(speeds[frame]);
        let bent = (bend(&change, bodies, frame, &rates, self.corner, at) * half * half).half();
        let along = normal.left();
        let foot = along.dot(at - from);
        let slides = along.dot(slope).abs() * half + bent;
        let stays = (foot - slides).is_positive().is_certain() && length.above(foot + slides).is_certain();
        stays.then(|| normal.dot(at - from).abs() + normal.dot(slope).abs() * half + bent)
    }
}

/// Whether two polygons are certain to have a point in common.
pub fn meet<R: BallReal>(postures: [&Posture<R>; 2]) -> Ternary {
    let left = |a: BallVector<R>, b: BallVector<R>, x: BallVector<R>| (b - a).cross(x - a).is_positive();
    for [own, other] in [[0, 1], [1, 0]] {
        let polygon = &postures[other].corners;
        for &x in &postures[own].corners {
            for k in 1..polygon.len().saturating_sub(1) {
                let [a, b, c] = [polygon[0], polygon[k], polygon[k + 1]];
                if left(a, b, x).is_certain() && left(b, c, x).is_certain() && left(c, a, x).is_certain() {
                    return Ternary::Yes;
                }
            }
        }
    }
    let edges = |polygon: &[BallVector<R>]| -> Vec<[BallVector<R>; 2]> {
        let count = polygon.len();
        (0..if count == 2 { 1 } else { count }).map(|k| [polygon[k], polygon[(k + 1) % count]]).collect()
    };
    let apart = |one: Ternary, other: Ternary| {
        (one.is_certain() && other == Ternary::No) || (one == Ternary::No && other.is_certain())
    };
    for [a, b] in edges(&postures[0].corners) {
        for &[c, d] in &edges(&postures[1].corners) {
            if apart(left(a, b, c), left(a, b, d)) && apart(left(c, d, a), left(c, d, b)) {
                return Ternary::Yes;
            }
        }
    }
    // Corners and edges that lie on one another say nothing. But two polygons without a common point are parted by the line of an edge of
    // one of them; a flat one has ends besides.
    let has_area = postures.iter().all(|posture| posture.normals.len() > 2);
    if has_area && gaps(postures).all(|gap| (-gap).is_positive().is_certain()) {
        return Ternary::Yes;
    }
    Ternary::Doubt
}

/// How far two polygons are apart along the normals of the edges of both; negative where a normal does not part them \[m\].
fn gaps<R: BallReal>(postures: [&Posture<R>; 2]) -> impl Iterator<Item = Ball<R>> {
    [[0, 1], [1, 0]].into_iter().flat_map(move |[own, other]| {
        postures[own].normals.iter().filter_map(move |&normal| {
            let [own, other] = [own, other].map(|k| postures[k].corners.iter().map(move |&corner| normal.dot(corner)));
            let (far, near) = (own.reduce(Ball::max)?, other.reduce(Ball::min)?);
            Some(near - far)
        })
    })
}

/// An upper bound on the signed distance of the polygons \[m\].
pub fn above<R: BallReal>(postures: [&Posture<R>; 2]) -> Ball<R> {
    if meet(postures).is_certain() { overlap(postures) } else { nearest(postures).distance(postures) }
}

/// An upper bound on the signed distance of two polygons that have a point in common \[m\]; at most 0.
pub fn overlap<R: BallReal>(postures: [&Posture<R>; 2]) -> Ball<R> {
    let most = gaps(postures).reduce(Ball::max);
    let zero = Ball::from(0.0);
    most.map_or(zero, |most| most.min(zero))
}

/// An upper bound on the gap in the direction of every normal while both lengths change at constant speeds: where it is negative, the polygons
/// overlap all the while, by that at least \[m\]. None for a point beside a point.
pub fn above_along<R: BallReal>(
    bodies: [&Carried<R>; 2],
    postures: [&Posture<R>; 2],
    speeds: [Ball<R>; 2],
    half: Ball<R>,
) -> Option<Ball<R>> {
    let change = Change::Line { speeds, accelerations: [Ball::from(0.0); 2], half };
    let mut greatest: Option<Ball<R>> = None;
    for owner in [0, 1] {
        let own = 1 - owner;
        let rates = change.rates(bodies, owner);
        for (&normal, &from) in postures[owner].normals.iter().zip(&postures[owner].corners) {
            // Any corner bounds the least gap; that which is the nearest in the middle does so best.
            let gaps = postures[own].corners.iter().map(|&at| normal.dot(at - from)).enumerate();
            let (corner, gap) = gaps.reduce(|a, b| if b.1.to_f64() < a.1.to_f64() { b } else { a })?;
            let at = postures[own].corners[corner];
            let slope = normal.dot(postures[own].velocities[corner]) * speeds[own]
                - normal.dot(postures[owner].velocity(at)) * speeds[owner];
            let second = bend(&change, bodies, owner, &rates, corner, at);
            let bound = gap + slope.abs() * half + (second * half * half).half();
            greatest = Some(greatest.map_or(bound, |most| most.max(bound)));
        }
    }
    greatest
}
