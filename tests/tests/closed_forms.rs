//! The closed forms of `docs/theory/equations.md`, transcribed from there: what P1, P3 and the time map claim is true.
//!
//! That the library computes them is what the tests of regions show; here it is the derivation that is tested.

use pcr_core::{Ecm, EcmEntry, Limits, Motion, Path, Piece, Point, Pose, Profile, Radians};
use pcr_tests::paper::{Vec2, norm};
use proptest::prelude::*;
use std::f64::consts::{PI, TAU};

/// Distances \[m\] in configurations of at most 10 m, roots included.
const TOLERANCE: f64 = 1e-9;

/// An infinite line or a full circle: start, heading there, signed curvature.
#[derive(Clone, Copy, Debug)]
struct Carrier {
    start: Vec2,
    heading: f64,
    curvature: f64,
}

impl Carrier {
    /// p(u): half chord and half angle.
    fn point(&self, u: f64) -> Vec2 {
        let half = 0.5 * self.curvature * u;
        let chord = if half == 0.0 { u } else { u * half.sin() / half };
        let (sin, cos) = (self.heading + half).sin_cos();
        [self.start[0] + chord * cos, self.start[1] + chord * sin]
    }

    /// Coordinates of a point along and left of the start.
    fn local(&self, q: Vec2) -> Vec2 {
        let (sin, cos) = self.heading.sin_cos();
        let [x, y] = [q[0] - self.start[0], q[1] - self.start[1]];
        [x * cos + y * sin, y * cos - x * sin]
    }

    /// (P1.1) n, left positive, and d / ϱ (1 on a line).
    fn offset(&self, q: Vec2) -> (f64, f64) {
        let ([x, y], k) = (self.local(q), self.curvature);
        let w = norm([k * x, 1.0 - k * y]);
        ((2.0 * y - k * (x * x + y * y)) / (1.0 + w), w)
    }

    /// The signed distance of a point from the offset curve `c`, the circle of radius `|ϱ - c|`, which is on the other
    /// side of the centre where `c > ϱ`: `(|q - centre|² - (ϱ - c)²) / (sum of both)`, divided by ϱ.
    fn distance_from_offset(&self, q: Vec2, c: f64) -> f64 {
        let ([x, y], k) = (self.local(q), self.curvature);
        let (_, w) = self.offset(q);
        (k * (x * x + y * y - c * c) - 2.0 * (y - c)) / (w + (1.0 - k * c).abs())
    }

    /// (P1.2) The length at the foot.
    fn foot(&self, q: Vec2) -> f64 {
        let ([x, y], k) = (self.local(q), self.curvature);
        if k == 0.0 { x } else { (k * x).atan2(1.0 - k * y) / k }
    }

    /// (P1.3) The half-width: `None` nothing, infinite for the whole circle.
    fn half_width(&self, q: Vec2, r: f64) -> Option<f64> {
        let ((n, w), k) = (self.offset(q), self.curvature.abs());
        let near = ((r - n.abs()) * (r + n.abs())).sqrt();
        if n.abs() > r {
            None
        } else if k == 0.0 {
            Some(near)
        } else if 1.0 + w <= k * r {
            Some(f64::INFINITY)
        } else {
            Some(2.0 / k * (k * near).atan2(((1.0 + w - k * r) * (1.0 + w + k * r)).sqrt()))
        }
    }

    /// (P3) The lengths of `self` at the offset `c` from `other`.
    fn at_offset(&self, other: &Self, c: f64) -> Vec<f64> {
        let (foot, (n, _)) = (self.foot(other.start), self.offset(other.start));
        let (ki, kj) = (other.curvature, self.curvature);
        let (sin, cos) = (self.heading + kj * foot - other.heading).sin_cos();
        let g = 2.0 * (c + n * cos) + ki * (n * n - c * c);
        let a = 4.0 * ki - 4.0 * kj * (ki * n + cos) + kj * kj * g;
        let discriminant = 4.0 * sin * sin - a * g;
        if discriminant < 0.0 || (a == 0.0 && sin == 0.0) {
            return Vec::new();
        }
        let q = 2.0 * sin + discriminant.sqrt().copysign(sin);
        let length = |numerator: f64, denominator: f64| match kj {
            0.0 => 2.0 * numerator / denominator,
            _ => 2.0 / kj * (kj * numerator / denominator).atan(),
        };
        let roots = [(q, a), (g, q)].map(|(numerator, denominator)| foot + length(numerator, denominator));
        roots.into_iter().filter(|u| u.is_finite()).collect()
    }
}

fn carrier() -> impl Strategy<Value = Carrier> {
    let curvature = prop_oneof![2 => Just(0.0), 5 => 0.3..4.0_f64, 5 => -4.0..-0.3_f64, 1 => 1e-9..1e-3_f64];
    (-3.0..3.0_f64, -3.0..3.0_f64, -PI..PI, curvature).prop_map(|(x, y, heading, curvature)| Carrier {
        start: [x, y],
        heading,
        curvature,
    })
}

proptest! {
    #[test]
    fn p1_the_disc_covers_the_lengths_within_the_half_width_of_the_foot(
        carrier in carrier(), x in -3.0..3.0_f64, y in -3.0..3.0_f64, r in 0.05..3.0_f64,
    ) {
        let distance = |u: f64| { let [px, py] = carrier.point(u); norm([px - x, py - y]) };
        let foot = carrier.foot([x, y]);
        let (n, _) = carrier.offset([x, y]);
        prop_assert!((distance(foot) - n.abs()).abs() < TOLERANCE);
        let lap = if carrier.curvature == 0.0 { 20.0 } else { (TAU / carrier.curvature.abs()).min(20.0) };
        let half = carrier.half_width([x, y], r);
        if let Some(half) = half.filter(|half| half.is_finite()) {
            prop_assert!((distance(foot + half) - r).abs() < TOLERANCE && (distance(foot - half) - r).abs() < TOLERANCE);
            // Laps meet only where the whole circle is covered.
            prop_assert!(carrier.curvature == 0.0 || half < PI / carrier.curvature.abs() + TOLERANCE);
        }
        for step in -50..=50 {
            let u = 0.01 * f64::from(step) * lap;
            let covered = half.is_some_and(|half| u.abs() <= half);
            prop_assert!((distance(foot + u) - r).abs() < TOLERANCE || covered == (distance(foot + u) < r), "{}", u);
        }
    }

    #[test]
    fn p3_the_roots_have_the_offset_and_there_are_no_others(i in carrier(), j in carrier(), c in -2.0..2.0_f64) {
        let residual = |u: f64| i.distance_from_offset(j.point(u), c);
        let roots = j.at_offset(&i, c);
        for &u in &roots {
            let near = u.abs() < 50.0;
            prop_assert!(!near || residual(u).abs() < TOLERANCE, "{} {}", u, residual(u));
        }
        if j.curvature.abs() > 0.1 {
            let lap = TAU / j.curvature.abs();
            let values: Vec<f64> = (0..=400).map(|k| residual(lap * f64::from(k) / 400.0)).collect();
            let changes = values.windows(2).filter(|pair| pair[0] * pair[1] < 0.0).count();
            prop_assert!(changes <= roots.len(), "{} sign changes, {:?}", changes, roots);
        }
    }

    #[test]
    fn time_map_inverts_the_length_to_the_end_of_a_stop(
        length in 0.5..20.0_f64, speed in 0.2..3.0_f64, acceleration in 0.1..3.0_f64, exponent in -12.0..0.0_f64,
    ) {
        let profile = Profile::rest_to_rest(length, Limits { speed, acceleration }).unwrap();
        let profile = profile.as_profile();
        let peak = speed.min((length * acceleration).sqrt());
        // A way of a 10^-12 th of the ramp before the stop takes √(2 way / a).
        let way = 0.5 * peak * peak / acceleration * 10.0_f64.powf(exponent);
        let left = profile.duration() - profile.first_time_at(profile.length() - way);
        // The way itself is known to a rounding of the length.
        let exact = [way - 4.0 * f64::EPSILON * length, way + 4.0 * f64::EPSILON * length];
        let [lo, hi] = exact.map(|way| (2.0 * way.max(0.0) / acceleration).sqrt());
        let rounding = 8.0 * f64::EPSILON * profile.duration();
        prop_assert!(lo - rounding <= left && left <= hi + rounding, "{} {} {}", lo, left, hi);
    }
}

#[test]
fn p1_offset_does_not_cancel_for_large_radii() {
    // n = y - κ x² / 2 + O(κ² x² y): ϱ - √(x² + (ϱ - y)²) itself would lose six digits here.
    for curvature in [1e-6, 1e-7, 1e-8] {
        let carrier = Carrier { start: [0.0, 0.0], heading: 0.0, curvature };
        let ([x, y], expected) = ([3.0, 1e-3], 1e-3 - 4.5 * curvature);
        assert!((carrier.offset([x, y]).0 - expected).abs() < 10.0 * curvature * curvature + 1e-18);
    }
}

#[test]
fn coordination_space_does_not_know_the_motion() {
    let start = |x, y, heading| Pose { position: Point::new(x, y), heading: Radians(heading) };
    let east = Path::<f64, 1>::starting_at(start(-3.0, 0.0, 0.0)).and_then(|path| path.line(6.0)).unwrap();
    let north = Path::<f64, 1>::starting_at(start(0.1, -2.0, 1.4)).and_then(|path| path.line(5.0)).unwrap();
    let ranges = |limits| {
        let profiles = [6.0, 5.0].map(|length| Profile::rest_to_rest(length, limits).unwrap());
        let motion = |path: &'static Path<f64, 1>, profile: &'static Profile<f64, 3>| {
            Motion::new(path.as_path(), profile.as_profile(), 0.2, 0.0).unwrap()
        };
        let [p, q] = profiles.map(|profile| &*Box::leak(Box::new(profile)));
        let [a, b] = [&east, &north].map(|path| &*Box::leak(Box::new(path.clone())));
        let fleet = [motion(a, p), motion(b, q)];
        let ecm = Ecm::build([EcmEntry::EMPTY; 2], [Piece::EMPTY; 4], &fleet).unwrap();
        let region = ecm.pair(&fleet, 0, 1).expect("the table of the fleet").next().unwrap();
        let transposed = ecm.pair(&fleet, 1, 0).expect("the table of the fleet").next().unwrap();
        assert_eq!((region.length(), region.other_length()), (transposed.other_length(), transposed.length()));
        // The time range is the image of the length range under the other's motion, whatever the phase it is in.
        let expected = fleet[1].time_in(region.other_length());
        assert_eq!(region.time(), expected);
        ([region.length(), region.other_length()], region.time(), region.excess())
    };
    let slow = ranges(Limits { speed: 0.3, acceleration: 5.0 });
    let never_cruising = ranges(Limits { speed: 9.0, acceleration: 0.4 });
    // But for the rounding of times, which is part of the bound.
    for (a, b) in slow.0.into_iter().zip(never_cruising.0) {
        let apart = (a.lo - b.lo).abs().max((a.hi - b.hi).abs());
        assert!(apart <= slow.2.max(never_cruising.2), "{a:?} and {b:?}");
    }
    assert_ne!(slow.1, never_cruising.1);
}
