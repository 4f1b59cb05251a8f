//! Two agents in a time in which each is on one leg: their relative motion is straight and steady, but for what they deviate.
//!
//! The least distance of a straight relative motion d(t) is bounded from below by a separating line: for any unit vector q,
//! |d(t)| ≥ q · d(t), which is linear in t and so least at an end of the time. With q towards the nearest point the bound is the distance
//! itself, and it holds whatever rounding has done to q.

use super::bounded_leg::BoundedLeg;
use super::open_spans::{BoundedDistance, DistanceBounds, LeastDistance, OpenSpan};

/// Distances that differ by less are not told apart \[m\].
const TOLERANCE: f64 = 1e-9;

/// How far the bounds of a least distance may be apart for a search that can bring them nearer \[m\].
const CLOSE: f64 = 1e-6;

/// Relative rounding of a length.
const FEW: f64 = 8.0 * f64::EPSILON;

/// Two agents on one leg each.
pub(super) struct LegPair<'a> {
    legs: [&'a BoundedLeg; 2],
    /// Rounding error of a distance \[m\].
    rounding: f64,
    /// Sum of the radii, as it is, from below and from above \[m\].
    radii: f64,
    limit: [f64; 2],
}

impl<'a> LegPair<'a> {
    pub(super) fn new(legs: [&'a BoundedLeg; 2], radii: f64) -> Self {
        // Both positions on both axes, and their difference.
        let rounding = 2.0 * (legs[0].rounding() + legs[1].rounding());
        Self { legs, rounding, radii, limit: [radii * (1.0 - f64::EPSILON), radii * (1.0 + f64::EPSILON)] }
    }

    /// The time in which both are on their legs, if there is one.
    pub(super) fn common(legs: [&BoundedLeg; 2]) -> Option<[f64; 2]> {
        let common = [legs[0].t[0].max(legs[1].t[0]), legs[0].t[1].min(legs[1].t[1])];
        // The ends of legs are ends of the next ones: alone they are of interest where a leg is no longer than that.
        let is_instant = || legs.iter().any(|leg| leg.t[0] == leg.t[1]);
        (common[0] < common[1] || (common[0] == common[1] && is_instant())).then_some(common)
    }

    fn offset(&self, t: f64) -> [f64; 2] {
        let [a, b] = self.legs.map(|leg| leg.position_at(t));
        [a[0] - b[0], a[1] - b[1]]
    }

    /// The distance of the straight motions at a time \[m\], from above.
    fn distance_at(&self, t: f64) -> f64 {
        length(self.offset(t)) * (1.0 + FEW) + self.rounding
    }

    fn deviation_at(&self, t: f64) -> f64 {
        self.legs.iter().map(|leg| leg.deviation_at(t)).sum::<f64>() * (1.0 + FEW)
    }

    /// Brings what is known of the least distance up to date.
    pub(super) fn update(&self, time: [f64; 2], least: &mut LeastDistance) {
        let bounds = self.bounds(time);
        self.sample(bounds.t, least);
        let lower = bounds.lower().max(0.0);
        let is_enough = |least: &LeastDistance| lower >= least.attained - CLOSE - 4.0 * self.rounding;
        let lower = if is_enough(least) { lower } else { lower.max(self.least_gap(time, least)) };
        least.lower = least.lower.min(lower);
    }

    /// Takes into account what is known at a time.
    fn sample(&self, t: f64, least: &mut LeastDistance) {
        let (distance, [lower, _]) = (self.distance_at(t), self.gap_at(t));
        least.upper = least.upper.min((distance + self.deviation_at(t)) * (1.0 + FEW));
        least.attained = least.attained.min(lower.max(0.0));
        if distance < least.straight.1 {
            (least.straight, least.map) = ((t, distance), self.legs[0].map);
        }
    }

    /// Bounds of the distance of the straight motions less what both deviate, at a time \[m\].
    fn gap_at(&self, t: f64) -> [f64; 2] {
        let (distance, deviation) = (length(self.offset(t)), self.deviation_at(t));
        let rounding = self.rounding + FEW * (distance + 4.0 * deviation);
        [distance - deviation - rounding, distance - deviation + rounding]
    }

    /// The least of that in a time, from below \[m\].
    ///
    /// The distance of straight motions is convex, and deviations are concave, so their difference is convex. A line through two of its
    /// points is below it everywhere outside of them: with three points around the least one, four such lines are below all of it.
    fn least_gap(&self, [s, e]: [f64; 2], least: &mut LeastDistance) -> f64 {
        /// Part of the time between the three points, and of a section in the search for the middle one.
        const STEP: f64 = 1e-5;
        const GOLDEN: f64 = 0.618;
        let step = STEP * (e - s);
        let (mut from, mut to) = (s, e);
        while to - from > step {
            let [a, b] = [to - GOLDEN * (to - from), from + GOLDEN * (to - from)];
            if a <= from || b >= to {
                break;
            }
            if self.gap_at(a)[0] < self.gap_at(b)[0] { to = b } else { from = a }
        }
        let middle = (0.5 * (from + to)).clamp(s + step, e - step);
        let [before, after] = [(middle - step).max(s), (middle + step).min(e)];
        self.sample(middle, least);
        if !(before < middle && middle < after) {
            return f64::NEG_INFINITY;
        }
        // Below what is beyond `near`, seen from `far`, up to `end`.
        let beyond = |near: f64, far: f64, end: f64| {
            let ([lower, _], [_, upper]) = (self.gap_at(near), self.gap_at(far));
            let slope = (lower - upper) / (near - far).abs();
            lower.min(lower + slope * (end - near).abs() * (1.0 + if slope < 0.0 { FEW } else { -FEW }))
        };
        let lines = [
            beyond(before, middle, s),
            beyond(middle, after, before),
            beyond(middle, before, after),
            beyond(after, middle, e),
        ];
        lines.into_iter().fold(f64::INFINITY, f64::min)
    }
}

impl BoundedDistance for LegPair<'_> {
    fn bounds(&self, [s, e]: [f64; 2]) -> DistanceBounds {
        let [from, to] = [s, e].map(|t| self.offset(t));
        let way = [to[0] - from[0], to[1] - from[1]];
        let square = dot(way, way);
        let part = if square > 0.0 { (-dot(from, way) / square).clamp(0.0, 1.0) } else { 0.0 };
        let nearest = [from[0] + part * way[0], from[1] + part * way[1]];
        let norm = length(nearest);
        let lengths = length(from) + length(to);
        let near = if norm > 0.0 {
            let line = nearest.map(|value| value / norm);
            let least = dot(line, from).min(dot(line, to));
            (least - FEW * lengths - self.rounding).max(0.0)
        } else {
            0.0
        };
        let far = length(from).max(length(to)) * (1.0 + FEW) + self.rounding;
        let [a, b] = self.legs.map(|leg| BoundedLeg::deviations([s, e], leg));
        let deviations = [(a[0] + b[0]) * (1.0 + FEW), a[1] + b[1]];
        DistanceBounds { near, far, t: (s + part * (e - s)).clamp(s, e), deviations }
    }

    fn limit(&self) -> [f64; 2] {
        self.limit
    }

    fn tolerance(&self) -> f64 {
        TOLERANCE + 4.0 * self.rounding
    }

    fn span(&self, time: [f64; 2], bounds: &DistanceBounds, is_contact: bool) -> OpenSpan {
        let upper = self.distance_at(bounds.t) + self.deviation_at(bounds.t);
        let separation = [bounds.lower().max(0.0), upper];
        OpenSpan { t: time, is_contact, separation, clearance: apart(separation, self.radii) }
    }
}

/// Bounds of the distance of discs with this sum of radii, by those of their centres \[m\].
pub(super) fn apart([lower, upper]: [f64; 2], radii: f64) -> [f64; 2] {
    [(lower - radii).next_down(), (upper - radii).next_up()]
}

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

fn length(a: [f64; 2]) -> f64 {
    a[0].hypot(a[1])
}
