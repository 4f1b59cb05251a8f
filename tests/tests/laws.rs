//! What every number type has to keep: the contract of [`pcr_core::Scalar`] and of the types that belong to it, for each format that is
//! offered. Numbers are compared with `f64` on the same numbers; a length may be off by [`pcr_core::Scalar::slack`] of what it was made
//! from, which is what regions allow for.

use pcr_core::scalar::{AccelerationRamp, Angle, AngleSector, Micro, Unit, Wide};
use pcr_fixed::{Q12, Q16, Q20};
use pcr_planning::fleet::HostScalar;
use pcr_tests::generators::Dice;
use std::f64::consts::{PI, TAU};

/// Samples of each law.
const SAMPLES: u64 = if cfg!(optimized) { 20_000 } else { 400 };

fn samples() -> impl Iterator<Item = Dice> {
    (0..SAMPLES).map(Dice::seeded)
}

/// A number of either sign whose magnitude is up to `most`, and what it is exactly.
fn any<S: HostScalar>(dice: &mut Dice, most: f64) -> (S, f64) {
    let number = S::from_f64(dice.sign() * dice.magnitude(0.02, most));
    (number, number.to_f64())
}

fn slack<S: HostScalar>(extent: f64) -> f64 {
    S::slack(S::from_f64(extent)).to_f64()
}

/// A sine or cosine.
fn unit<S: HostScalar>(unit: S::Unit) -> f64 {
    S::from_f64(64.0).scale(unit).to_f64() / 64.0
}

/// `found` is a length made from numbers up to `extent`.
#[track_caller]
fn near<S: HostScalar>(found: f64, exact: f64, extent: f64) {
    assert!((found - exact).abs() <= slack::<S>(extent), "{}: {found} for {exact}", S::NAME);
}

fn sums_and_order<S: HostScalar>() {
    for mut dice in samples() {
        let ((a, x), (b, y)) = (any::<S>(&mut dice, 50.0), any::<S>(&mut dice, 50.0));
        near::<S>((a + b).to_f64(), x + y, x.abs() + y.abs());
        near::<S>((a - b).to_f64(), x - y, x.abs() + y.abs());
        assert!(a + b == b + a && -(-a) == a && a + -a == S::ZERO && a.double().half() == a);
        assert_eq!((a < b, a == b), (x < y, x == y));
        assert_eq!([a.min(b), a.max(b), a.abs()].map(S::to_f64), [x.min(y), x.max(y), x.abs()]);
        assert_eq!(a.clamp(-b.abs(), b.abs()).to_f64(), x.clamp(-y.abs(), y.abs()));
        let (sum, rest) = a.sum(b);
        assert_eq!(sum.to_f64() + rest.to_f64(), x + y, "{}: what a sum is rounded by", S::NAME);
        assert!(a.sum_up(b).to_f64() >= x + y);
        assert!(a.is_finite() && a.abs() < S::LIMIT);
    }
}

fn products_and_roots<S: HostScalar>() {
    for mut dice in samples() {
        let ((a, x), (b, y)) = (any::<S>(&mut dice, 14.0), any::<S>(&mut dice, 14.0));
        near::<S>(a.times(b).narrow().to_f64(), x * y, x.abs().max(y.abs()).max((x * y).abs()));
        assert_eq!(a.times(a) < b.times(b), x.abs() < y.abs());
        assert_eq!(a.times(a) - b.times(b) < S::Wide::ZERO, x.abs() < y.abs());
        near::<S>((a.times(a) + b.times(b)).sqrt().to_f64(), x.hypot(y), x.hypot(y));
        near::<S>(a.times(a).sqrt().to_f64(), x.abs(), x.abs());
        assert_eq!((-a.times(a)).sqrt(), S::ZERO);
        let (quotient, most) = (a.quotient(b).to_f64(), S::LIMIT.to_f64());
        if (x / y).abs() < most {
            near::<S>(quotient, x / y, (x / y).abs().max(1.0));
        } else {
            assert!(quotient.abs() >= most, "{}: {quotient} for {}", S::NAME, x / y);
        }
        let (part, whole) = (a.abs().min(b.abs()), a.abs().max(b.abs()));
        let portion = S::from_f64(5.0).portion(part, whole).to_f64();
        near::<S>(portion, 5.0 * part.to_f64() / whole.to_f64(), 5.0);
        let (larger, smaller) = (x.hypot(y), x.abs());
        let [c, d] = [(a.times(a) + b.times(b)).sqrt(), a.abs()];
        near::<S>(S::difference(c, d, b.times(b)).to_f64(), y * y / (larger + smaller), larger);
    }
    assert_eq!(S::ZERO.quotient(S::ZERO), S::ZERO);
    assert!(S::LIMIT.quotient(S::slack(S::ZERO).max(S::from_f64(1e-4))) > S::LIMIT, "{}: saturates", S::NAME);
    assert!(S::from_f64(1.0).quotient_unit(S::Unit::ZERO).is_none());
}

fn angles<S: HostScalar>() {
    for (quarters, sin, cos) in [(0.0, 0.0, 1.0), (1.0, 1.0, 0.0), (-1.0, -1.0, 0.0), (2.0, 0.0, -1.0)] {
        let found = S::angle(quarters * PI / 2.0).expect("an angle").sin_cos();
        near::<S>(unit::<S>(found.0), sin, 1.0);
        near::<S>(unit::<S>(found.1), cos, 1.0);
    }
    for mut dice in samples() {
        let ((a, x), (b, y)) = (any::<S>(&mut dice, 50.0), any::<S>(&mut dice, 50.0));
        let norm = (a.times(a) + b.times(b)).sqrt();
        let angle = S::Angle::atan2(b, a);
        near::<S>(x.hypot(y) * (S::radians(angle) - y.atan2(x)), 0.0, x.hypot(y));
        let (sin, cos) = angle.sin_cos();
        near::<S>(norm.scale(cos).to_f64(), x, x.hypot(y));
        near::<S>(norm.scale(sin).to_f64(), y, x.hypot(y));
        for (found, exact) in S::unit_vector(a, b, norm).into_iter().zip([x, y]) {
            near::<S>(unit::<S>(found), exact / x.hypot(y), 1.0);
        }
        near::<S>(S::combine(a, cos, b, sin).to_f64(), x.hypot(y), x.hypot(y));
        near::<S>(unit::<S>(S::Unit::combine(cos, cos, sin, sin)), 1.0, 1.0);
        // Arcs, up to a full turn.
        let radius = a.abs();
        let length = S::from_f64(dice.range(0.0, TAU) * x.abs() * 0.999);
        let half = S::Angle::half_subtended(length, radius);
        near::<S>(half.arc_length(radius.double()).to_f64(), length.to_f64(), TAU * x.abs());
        near::<S>(S::Angle::circumference(radius).to_f64(), TAU * x.abs(), TAU * x.abs());
        // The chord is what the arc spans.
        let heading = S::angle(dice.range(-3.0, 3.0)).expect("an angle");
        let (sin, cos) = heading.sin_cos();
        let right = dice.chance(0.5);
        let chord = S::chord(radius, half, right, [cos, sin]).map(S::to_f64);
        let half = length.to_f64() / (2.0 * x.abs()) * if right { -1.0 } else { 1.0 };
        let (direction, span) = (S::radians(heading) + half, 2.0 * x.abs() * half.abs().sin());
        near::<S>(chord[0], span * direction.cos(), TAU * x.abs());
        near::<S>(chord[1], span * direction.sin(), TAU * x.abs());
    }
    assert_eq!(S::radians(S::Angle::atan2(S::ZERO, S::ZERO)), 0.0);
}

fn quadratics<S: HostScalar>() {
    let mut seen = 0;
    for mut dice in samples() {
        // Even numbers of last digits: the mean of two is a number of the format.
        let mut root = || any::<S>(&mut dice, 5.0).0.double();
        let (r, s) = (root(), root());
        let [x, y] = [r, s].map(S::to_f64);
        if (x - y).abs() < 1.0 {
            continue;
        }
        seen += 1;
        let [mut found, mut exact] =
            [S::quadratic_roots(-(r + s).half(), r.times(s), S::Wide::ZERO).expect("real").map(S::to_f64), [x, y]];
        found.sort_by(f64::total_cmp);
        exact.sort_by(f64::total_cmp);
        // The error of the discriminant, made of squares up to 10², over the distance of the roots.
        found.into_iter().zip(exact).for_each(|(found, exact)| near::<S>(found, exact, 10.0 * 10.0 / (x - y).abs()));
        // u² + 2 r u + r² + s² = 0 has none.
        assert!(S::quadratic_roots(r, r.times(r) + s.times(s), S::Wide::ZERO).is_none());
        half_tangents::<S>(&mut dice);
    }
    assert!(seen > SAMPLES / 4);
}

/// `(m τ - n) (k τ - l) = 0`, and the angles `2 atan τ`.
fn half_tangents<S: HostScalar>(dice: &mut Dice) {
    let mut number = || any::<S>(dice, 8.0);
    let [(n, nx), (m, mx), (l, lx), (k, kx)] = [number(), number(), number(), number()];
    let (apart, size) = ((nx * kx - lx * mx).abs(), (nx * kx).abs() + (lx * mx).abs());
    if apart < 0.3 * size {
        return;
    }
    let [a, b, g] = [m.times(k), -(n.times(k) + l.times(m)).half(), n.times(l)];
    // Counted from any direction.
    let angle = dice.range(-PI, PI);
    let from = S::Angle::atan2(S::from_f64(8.0 * angle.sin()), S::from_f64(8.0 * angle.cos()));
    let ((sin, cos), from) = (from.sin_cos(), S::radians(from));
    let mut found = Vec::new();
    let equation = [a, b, g, S::Wide::ZERO];
    S::half_tangent_roots([equation].into_iter(), AngleSector::all([cos, sin]), |angle| found.push(S::radians(angle)));
    assert_eq!(found.len(), 2, "in the sector of all angles");
    for exact in [from + 2.0 * nx.atan2(mx), from + 2.0 * lx.atan2(kx)] {
        let off = |angle: f64| (angle - exact - TAU * ((angle - exact) / TAU).round()).abs();
        assert!(found.iter().any(|&angle| off(angle) < slack::<S>(4.0)), "{}: {exact} in {found:?}", S::NAME);
    }
}

fn ramps<S: HostScalar>() {
    for mut dice in samples() {
        let [slow, acceleration, duration] =
            [dice.range(0.1, 1.5), dice.range(0.05, 2.0), dice.range(0.1, 6.0)].map(S::from_f64);
        let [v, a, t] = [slow, acceleration, duration].map(S::to_f64);
        let [fast, length] = [v + a * t, v * t + 0.5 * a * t * t].map(S::from_f64);
        let ramp = AccelerationRamp { slow, fast, acceleration, duration, length };
        let elapsed = S::from_f64(t * dice.range(0.0, 1.0));
        let (at, e) = (S::ramp_length(ramp, elapsed), elapsed.to_f64());
        // Its phases say what a profile is; that of these limits is within a slack of it (docs/theory/errors.md, e-profiles).
        let tolerance = slack::<S>(length.to_f64() + t);
        assert!((at.to_f64() - (v * e + 0.5 * a * e * e)).abs() <= tolerance, "{}: {at:?} at {e}", S::NAME);
        let back = S::ramp_time(ramp, at).to_f64();
        assert!((back - e).abs() * v <= tolerance, "{}: {back} for {e}", S::NAME);
        let later = S::ramp_length(ramp, elapsed + (duration - elapsed).half());
        assert!(at <= later && later <= length + S::slack(length), "{}: not monotone", S::NAME);
    }
}

fn bounds<S: HostScalar>() {
    let at = |extent: f64| S::slack(S::from_f64(extent));
    assert!(S::ZERO <= at(0.0) && at(0.0) <= at(1.0) && at(1.0) <= at(200.0) && S::ZERO < at(1.0));
    for extent in [0.0, 1.0, 200.0].map(S::from_f64) {
        assert!(S::tolerance(extent) >= S::slack(extent).double());
        assert!(S::ZERO <= S::drift(1, extent) && S::drift(1, extent) <= S::drift(9, extent));
    }
    let lag = |time: f64| S::lag(S::from_f64(1.5), S::from_f64(time));
    assert!(S::ZERO <= lag(0.0) && lag(1.0) <= lag(100.0));
}

fn laws<S: HostScalar>() {
    sums_and_order::<S>();
    products_and_roots::<S>();
    angles::<S>();
    quadratics::<S>();
    ramps::<S>();
    bounds::<S>();
}

#[test]
fn f64_keeps_the_laws() {
    laws::<f64>();
}

#[test]
fn f32_keeps_the_laws() {
    laws::<f32>();
}

#[test]
fn micro_keeps_the_laws() {
    laws::<Micro>();
}

#[test]
fn q20_keeps_the_laws() {
    laws::<Q20>();
}

#[test]
fn q16_keeps_the_laws() {
    laws::<Q16>();
}

#[test]
fn q12_keeps_the_laws() {
    laws::<Q12>();
}
