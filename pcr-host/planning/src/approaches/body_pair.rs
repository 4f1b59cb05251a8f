//! Two agents of which one at least has an outline, in a time in which each is on one leg.
//!
//! In a time of length 2 h around m, no point of a body that goes straight at a relative speed u and turns at a rate w is farther than
//! (u + w R) h from where it is at m, with R the distance of the point from the reference point. So the signed distance changes by no more
//! than the sum of that of both bodies, and by what both deviate.

use super::bounded_leg::BoundedLeg;
use super::convex_parts::ConvexParts;
use super::leg_pair::LegPair;
use super::open_spans::{BoundedDistance, DistanceBounds, LeastDistance, OpenSpan};

/// Distances that differ by less are not told apart \[m\].
const TOLERANCE: f64 = 1e-5;

/// How far the bounds of a least distance may be apart for a search that can bring them nearer \[m\].
const CLOSE: f64 = 1e-4;

/// Halves of halves of a time, after which it is not divided any more.
const DEEPEST: u32 = 40;

/// Relative rounding of a length.
const FEW: f64 = 64.0 * f64::EPSILON;

/// Two agents on one leg each, with their bodies.
pub(super) struct BodyPair<'a> {
    legs: [&'a BoundedLeg; 2],
    bodies: &'a [ConvexParts; 2],
    centres: &'a LegPair<'a>,
    /// How fast the signed distance of the straight motions changes at most \[m/s\].
    rate: f64,
    /// Rounding error of a signed distance \[m\].
    rounding: f64,
}

impl<'a> BodyPair<'a> {
    pub(super) fn new(legs: [&'a BoundedLeg; 2], bodies: &'a [ConvexParts; 2], centres: &'a LegPair<'a>) -> Self {
        let velocity = |leg: &BoundedLeg| {
            let duration = leg.t[1] - leg.t[0];
            [0, 1].map(|axis| if duration > 0.0 { (leg.ends[1][axis] - leg.ends[0][axis]) / duration } else { 0.0 })
        };
        let [a, b] = legs.map(velocity);
        let speeds = a[0].hypot(a[1]) + b[0].hypot(b[1]);
        let turns = legs.iter().zip(bodies).map(|(leg, body)| leg.turning_rate() * body.reach).sum::<f64>();
        let rate = (a[0] - b[0]).hypot(a[1] - b[1]) + turns + FEW * (speeds + turns);
        let rounding = 4.0 * (legs[0].rounding() + legs[1].rounding()) + FEW * (bodies[0].reach + bodies[1].reach);
        Self { legs, bodies, centres, rate, rounding }
    }

    /// The signed distance of the straight and steady motions \[m\].
    fn gap(&self, t: f64) -> f64 {
        let [a, b] = [0, 1].map(|k| self.bodies[k].at(self.legs[k].position_at(t), self.legs[k].heading_at(t)));
        a.signed_distance(&b)
    }

    /// How far points of both are from these motions, from above: the most and the least in a time \[m\].
    fn deviations(&self, time: [f64; 2]) -> [f64; 2] {
        let mut sum = [0.0; 2];
        for (leg, body) in self.legs.iter().zip(self.bodies) {
            let ([most, least], [turned, unturned]) = (BoundedLeg::deviations(time, leg), leg.turns(time));
            // A chord is no longer than its arc, nor than the diameter.
            let by_turning = |angle: f64| 2.0 * body.reach * (0.5 * angle).sin();
            sum[0] += (most + by_turning(turned)) * (1.0 + FEW);
            sum[1] += least + by_turning(unturned);
        }
        sum
    }

    /// Brings what is known of the least distance of the bodies up to date.
    pub(super) fn update(&self, time: [f64; 2], least: &mut LeastDistance) {
        self.search(time, 0, least);
    }

    fn search(&self, time: [f64; 2], depth: u32, least: &mut LeastDistance) {
        let bounds = self.bounds(time);
        let (middle, gap) = (bounds.t, self.gap(bounds.t));
        let [deviation, _] = self.deviations([middle; 2]);
        least.upper = least.upper.min(gap + deviation + self.rounding);
        least.attained = least.attained.min(gap - deviation);
        if gap < least.straight.1 {
            (least.straight, least.map) = ((middle, gap), self.legs[0].map);
        }
        let lower = bounds.lower();
        let is_short = depth >= DEEPEST || middle <= time[0] || middle >= time[1];
        if lower >= least.attained - CLOSE || is_short {
            least.lower = least.lower.min(lower);
            return;
        }
        self.search([time[0], middle], depth + 1, least);
        self.search([middle, time[1]], depth + 1, least);
    }
}

impl BoundedDistance for BodyPair<'_> {
    fn bounds(&self, time: [f64; 2]) -> DistanceBounds {
        let t = time[0] + 0.5 * (time[1] - time[0]);
        let (gap, change) = (self.gap(t), self.rate * (t - time[0]).max(time[1] - t) + self.rounding);
        DistanceBounds { near: gap - change, far: gap + change, t, deviations: self.deviations(time) }
    }

    fn limit(&self) -> [f64; 2] {
        [0.0; 2]
    }

    fn tolerance(&self) -> f64 {
        TOLERANCE + 4.0 * self.rounding
    }

    fn span(&self, time: [f64; 2], bounds: &DistanceBounds, is_contact: bool) -> OpenSpan {
        let upper = self.gap(bounds.t) + self.deviations([bounds.t; 2])[0] + self.rounding;
        let centres = self.centres.bounds(time);
        let separation = self.centres.span(time, &centres, is_contact).separation;
        OpenSpan { t: time, is_contact, separation, clearance: [bounds.lower(), upper] }
    }
}
