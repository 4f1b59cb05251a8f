//! Outlines and their courses by formulas of the tests, which share nothing with the core: what answers about outlines are compared with.

use pcr_formats::plane_geometry::distance;
use pcr_formats::scenario::Scenario;
use pcr_formats::splitmix64::SplitMix64;
use serde_json::{Value, json};
use std::f64::consts::PI;

pub(crate) type Point = [f64; 2];

pub(crate) const TRUCK: [Point; 4] = [[-0.6, -0.4], [0.6, -0.4], [0.6, 0.4], [-0.6, 0.4]];
/// Its reference point is outside of it.
pub(crate) const FORK: [Point; 4] = [[0.2, -0.3], [1.1, -0.3], [1.1, 0.25], [0.2, 0.25]];
pub(crate) const TRIANGLE: [Point; 3] = [[-0.4, -0.5], [0.9, 0.1], [-0.5, 0.4]];
pub(crate) const HEXAGON: [Point; 6] =
    [[0.5, 0.0], [0.25, 0.4], [-0.25, 0.4], [-0.5, 0.0], [-0.25, -0.4], [0.25, -0.4]];

/// An outline: the points within a radius of a convex polygon. A disc has one corner.
#[derive(Clone, Debug)]
pub(crate) struct Outline {
    pub(crate) corners: Vec<Point>,
    pub(crate) radius: f64,
}

impl Outline {
    pub(crate) fn polygon(corners: &[Point]) -> Self {
        Self { corners: corners.to_vec(), radius: 0.0 }
    }

    pub(crate) fn is_disc(&self) -> bool {
        self.corners.len() == 1
    }

    /// The same, smaller all around: towards a point in the middle, each side comes nearer by that at least.
    pub(crate) fn smaller(&self, by: f64) -> Self {
        if self.is_disc() {
            return Self { radius: self.radius - by, ..self.clone() };
        }
        let count = self.corners.len() as f64;
        let middle = [0, 1].map(|axis| self.corners.iter().map(|corner| corner[axis]).sum::<f64>() / count);
        let inner = sides(&self.corners).map(|ends| from_line(middle, ends)).fold(f64::INFINITY, f64::min);
        let share = 1.0 - by / inner;
        let corners = self.corners.iter().map(|corner| [0, 1].map(|k| middle[k] + share * (corner[k] - middle[k])));
        Self { corners: corners.collect(), ..self.clone() }
    }

    pub(crate) fn at(&self, [x, y, heading]: [f64; 3]) -> Self {
        let (sin, cos) = heading.sin_cos();
        let corners =
            self.corners.iter().map(|[ahead, left]| [x + ahead * cos - left * sin, y + ahead * sin + left * cos]);
        Self { corners: corners.collect(), ..self.clone() }
    }

    /// Distance of two outlines, not above 0 where they overlap.
    pub(crate) fn apart(&self, other: &Self) -> f64 {
        let crossing = sides(&self.corners).any(|own| sides(&other.corners).any(|their| cross(own, their)));
        let inside = holds(&self.corners, other.corners[0]) || holds(&other.corners, self.corners[0]);
        let from = |own: &Self, other: &Self| {
            let all = own.corners.iter().flat_map(|p| sides(&other.corners).map(|side| from_side(*p, side)));
            all.fold(f64::INFINITY, f64::min)
        };
        let between = if crossing || inside { 0.0 } else { from(self, other).min(from(other, self)) };
        between - self.radius - other.radius
    }
}

pub(crate) fn sides(corners: &[Point]) -> impl Iterator<Item = [Point; 2]> + '_ {
    corners.iter().zip(corners.iter().cycle().skip(1)).map(|(a, b)| [*a, *b])
}

pub(crate) fn area(a: Point, b: Point, c: Point) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

pub(crate) fn from_line(p: Point, [a, b]: [Point; 2]) -> f64 {
    area(a, b, p).abs() / distance(a, b)
}

pub(crate) fn from_side(p: Point, [a, b]: [Point; 2]) -> f64 {
    let along = |from: Point, to: Point| (p[0] - from[0]) * (to[0] - from[0]) + (p[1] - from[1]) * (to[1] - from[1]);
    if a == b || along(a, b) <= 0.0 || along(b, a) <= 0.0 {
        distance(p, a).min(distance(p, b))
    } else {
        from_line(p, [a, b])
    }
}

pub(crate) fn holds(corners: &[Point], p: Point) -> bool {
    corners.len() > 2
        && (sides(corners).all(|[a, b]| area(a, b, p) >= 0.0) || sides(corners).all(|[a, b]| area(a, b, p) <= 0.0))
}

pub(crate) fn cross([a, b]: [Point; 2], [c, d]: [Point; 2]) -> bool {
    area(a, b, c) * area(a, b, d) < 0.0 && area(c, d, a) * area(c, d, b) < 0.0
}

pub(crate) fn line(length: f64) -> Value {
    json!({ "kind": "line", "length": length })
}

pub(crate) fn agent(id: u64, outline: &Outline, start: [f64; 3], path: &[Value]) -> Value {
    let mut agent = json!({ "id": id, "v_max": 1.0, "a_max": 0.5, "path": path,
        "start": { "x": start[0], "y": start[1], "heading": start[2] } });
    if outline.is_disc() {
        agent["radius"] = json!(outline.radius);
    } else {
        let corners = outline.corners.iter().map(|[ahead, left]| json!({ "ahead": ahead, "left": left }));
        agent["footprint"] = json!({ "polygon": corners.collect::<Vec<_>>() });
    }
    agent
}

pub(crate) fn read(agents: &[Value]) -> Scenario {
    Scenario::from_value(&json!({ "agents": agents })).unwrap()
}

/// Where an agent is after a length, and its length after a time, by formulas of this test.
pub(crate) struct Course {
    pub(crate) start: [f64; 3],
    /// Length, and curvature.
    pub(crate) legs: Vec<[f64; 2]>,
}

impl Course {
    pub(crate) fn length(&self) -> f64 {
        self.legs.iter().map(|leg| leg[0]).sum()
    }

    pub(crate) fn at(&self, length: f64) -> [f64; 3] {
        let ([mut x, mut y, mut heading], mut left) = (self.start, length);
        for &[leg, curvature] in &self.legs {
            let own = left.clamp(0.0, leg);
            let turned = heading + curvature * own;
            if curvature == 0.0 {
                (x, y) = (x + own * heading.cos(), y + own * heading.sin());
            } else {
                x += (turned.sin() - heading.sin()) / curvature;
                y -= (turned.cos() - heading.cos()) / curvature;
            }
            (heading, left) = (turned, left - own);
        }
        [x, y, heading]
    }

    /// From rest to rest at up to 1 m/s and 0.5 m/s².
    pub(crate) fn duration(&self) -> f64 {
        let length = self.length();
        if length >= 2.0 { length + 2.0 } else { 2.0 * (2.0 * length).sqrt() }
    }

    pub(crate) fn after(&self, time: f64) -> f64 {
        let (length, end) = (self.length(), self.duration());
        let ramp = |elapsed: f64| 0.25 * elapsed * elapsed;
        let up = (0.5 * end).min(2.0);
        match time.clamp(0.0, end) {
            t if t < up => ramp(t),
            t if t < end - up => ramp(up) + (t - up),
            t => length - ramp(end - t),
        }
    }
}

pub(crate) fn within([lo, hi]: [f64; 2], x: f64) -> bool {
    lo <= x && x <= hi
}

impl Outline {
    /// One of some outlines, of which four in five are no discs.
    pub(crate) fn random(dice: &mut SplitMix64) -> Self {
        match dice.below(5) {
            0 => Self::polygon(&TRUCK),
            1 => Self::polygon(&FORK),
            2 => Self::polygon(&TRIANGLE),
            3 => Self::polygon(&HEXAGON),
            _ => Self { corners: vec![[0.0; 2]], radius: 0.3 },
        }
    }
}

impl Course {
    /// One to three lines and arcs that begin in a square of this half side \[m\].
    pub(crate) fn random(dice: &mut SplitMix64, half: f64) -> Self {
        let count = 1 + dice.below(3);
        let legs = (0..count).map(|_| match dice.below(2) {
            0 => [dice.uniform(0.5, 3.0), 0.0],
            _ => {
                let radius = dice.uniform(0.3, 2.0);
                [radius * dice.uniform(0.3, 2.5), if dice.below(2) == 0 { 1.0 / radius } else { -1.0 / radius }]
            }
        });
        let legs = legs.collect();
        Self { start: [dice.uniform(-half, half), dice.uniform(-half, half), dice.uniform(-PI, PI)], legs }
    }

    /// The agent of this number with an outline.
    pub(crate) fn agent(&self, id: u64, outline: &Outline) -> Value {
        let path = self.legs.iter().map(|&[length, curvature]| match curvature {
            0.0 => line(length),
            _ => json!({ "kind": "arc", "radius": 1.0 / curvature.abs(), "sweep": length * curvature }),
        });
        agent(id, outline, self.start, &path.collect::<Vec<_>>())
    }
}
