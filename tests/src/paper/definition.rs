//! Contact by its definition, without a formula of the paper or of the library: walk from the crossing until the disc
//! has lost the path, then bisect.
//!
//! On full carriers the slice of a region at one time is a single interval on every lap, and it moves continuously.
//! Hence the time range of the region at the crossing is the longest interval about `t = 0` in which the distance of
//! `p₁(t)` from the carrier of ρ₂ is at most r̂₁; the length range likewise with the roles exchanged.

use super::{Arc, EVERYWHERE, Pcr, Range, Vec2};
use std::f64::consts::TAU;

/// Steps of the walk for each radius \[1\]: a gap between two contacts must be longer than a step.
const STEPS_PER_RADIUS: f64 = 200.0;

/// The length of a walk along a straight line, in radii of the other circle and combined radii \[1\]: with `|sin θ|`
/// above 1/20 every contact lies within it.
const REACH: f64 = 25.0;

/// The point after `s` metres on a carrier through the origin with this heading there.
pub fn point(heading: f64, arc: Option<Arc>, s: f64) -> Vec2 {
    // Chord and half of the angle: no centre, unlike Eq. (20).
    let (chord, turned) = match arc {
        None => (s, 0.0),
        Some(arc) => {
            let half = 0.5 * s / arc.radius;
            (2.0 * arc.radius * half.sin(), arc.dir * half)
        }
    };
    let (sin, cos) = (heading + turned).sin_cos();
    [chord * cos, chord * sin]
}

/// The distance of a point from a carrier through the origin with this heading there.
pub fn distance([x, y]: Vec2, heading: f64, arc: Option<Arc>) -> f64 {
    let (sin, cos) = heading.sin_cos();
    let (along, left) = (x * cos + y * sin, y * cos - x * sin);
    match arc {
        None => left.abs(),
        Some(arc) => (along.hypot(left - arc.dir * arc.radius) - arc.radius).abs(),
    }
}

/// Time range \[s\] of the region at the crossing.
pub fn time_range(pcr: &Pcr) -> Range {
    let way = walk(pcr, pcr.other, |s| distance(point(pcr.theta, pcr.other, s), 0.0, pcr.own));
    way.map(|s| s / pcr.v)
}

/// Length range \[m\] of the region at the crossing.
pub fn length_range(pcr: &Pcr) -> Range {
    walk(pcr, pcr.own, |l| distance(point(0.0, pcr.own, l), pcr.theta, pcr.other))
}

/// The longest interval about 0 on a carrier in which `distance` is at most `pcr.r`.
fn walk(pcr: &Pcr, carrier: Option<Arc>, distance: impl Fn(f64) -> f64) -> Range {
    let radii = [pcr.own, pcr.other].map(|arc| arc.map_or(0.0, |arc| arc.radius));
    let end = carrier.map_or(REACH * (radii[0] + radii[1] + pcr.r), |arc| TAU * arc.radius);
    let step =
        [pcr.r, radii[0], radii[1]].into_iter().filter(|&radius| radius > 0.0).fold(end, f64::min) / STEPS_PER_RADIUS;
    let lost = |direction: f64| {
        let steps = (end / step).ceil() as usize;
        let beyond = (1..=steps).map(|k| direction * step * k as f64).find(|&s| distance(s) > pcr.r)?;
        let (mut inside, mut outside) = (beyond - direction * step, beyond);
        while inside != 0.5 * (inside + outside) && outside != 0.5 * (inside + outside) {
            let middle = 0.5 * (inside + outside);
            *(if distance(middle) > pcr.r { &mut outside } else { &mut inside }) = middle;
        }
        Some(inside)
    };
    match (lost(-1.0), lost(1.0)) {
        (Some(lo), Some(hi)) => [lo, hi],
        _ => EVERYWHERE,
    }
}
