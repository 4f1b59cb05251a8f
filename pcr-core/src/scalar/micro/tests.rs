//! `Micro` compared with `f32`, and with the documented errors of its roots and angles.

use super::*;

#[test]
fn roots_are_right_to_one_and_a_half_last_digits() {
    let mut worst = 0.0_f64;
    for step in 0..200_003_u32 {
        let x = f32::from_bits(0x0080_0000 + step * 10_600);
        let exact = libm::sqrt(f64::from(x));
        worst = worst.max((f64::from(sqrt(x)) - exact).abs() / (exact * f64::from(f32::EPSILON)));
    }
    assert!(worst < 1.5, "{worst} last digits");
    assert_eq!((sqrt(0.0), sqrt(-1.0), sqrt(4.0)), (0.0, 0.0, 2.0));
}

#[test]
fn arctangents_are_right_to_a_few_last_digits() {
    let mut worst = 0.0_f64;
    for step in 0..200_003_u32 {
        let (sin, cos) = libm::sincos(f64::from(step) * 3.141_6e-5);
        let length = libm::exp10(f64::from(step % 61) - 30.0);
        let (y, x) = ((length * sin) as f32, (length * cos) as f32);
        let exact = libm::atan2(f64::from(y), f64::from(x));
        worst = worst.max(((f64::from(atan2(y, x)) - exact) / exact).abs() / (0.5 * f64::from(f32::EPSILON)));
    }
    assert!(worst < 7.0 && worst > 2.0, "largest error {worst} roundoffs of the angle");
    for (y, x, angle) in [(0.0, 0.0, 0.0), (0.0, 1.0, 0.0), (1e-30, 1e-30, core::f32::consts::FRAC_PI_4)] {
        assert!((atan2(y, x) - angle).abs() < 5e-7, "atan2({y}, {x})");
    }
    assert!((atan2(1e-9, 1.0) - 1e-9).abs() < 1e-15);
    for r in [1e-37, 1e-30, 1e-12, 1.0, 1e12, 1e30, 3e38] {
        let found = [(r, r), (r, -r), (-r, r), (-r, -r)]
            .map(|(y, x)| (atan2(y, x) / core::f32::consts::FRAC_PI_4 * 1e5).round());
        assert_eq!(found, [1e5, 3e5, -1e5, -3e5], "{r}");
        let found =
            [(r, 0.0), (0.0, -r), (-r, 0.0)].map(|(y, x)| (atan2(y, x) / core::f32::consts::FRAC_PI_2 * 1e5).round());
        assert_eq!(found, [1e5, 2e5, -1e5], "{r}");
    }
    // Not beyond half a turn, where the negated angle is a different one.
    for step in 0..100_000_u32 {
        let angle = atan2(step as f32 * 1e-11, -1.0);
        assert!(angle <= core::f32::consts::PI && atan2(-(step as f32) * 1e-11, -1.0) >= -core::f32::consts::PI);
    }
}

#[test]
fn the_seeds_alone_would_not_do() {
    assert!((F32Ext::sqrt(2.0_f32) / libm::sqrtf(2.0) - 1.0).abs() > 1e-2);
    assert!((F32Ext::atan2(0.5_f32, 1.0) - libm::atan2f(0.5, 1.0)).abs() > 1e-3);
}

/// Operations without a root or an angle give the result of `f32`; the others are close to it.
#[test]
fn all_else_is_that_of_f32() {
    let m = Micro;
    let near =
        |found: f32, exact: f32| assert!((found - exact).abs() < 4.0 * f32::EPSILON * exact.abs(), "{found} {exact}");
    assert_eq!([m(3.0) + m(2.0), m(3.0) - m(2.0), -m(3.0)], [m(5.0), m(1.0), m(-3.0)]);
    for (x, y) in [(3.0_f32, -4.0_f32), (-0.3, 0.7), (0.0, 2.0), (1e6, 1e-6)] {
        assert_eq!(
            (m(x).times(m(y)), m(x).scale(y), Scalar::half(m(x)), Wide::half(m(x))),
            (m(x * y), m(x * y), m(x / 2.0), m(x / 2.0))
        );
        assert_eq!((Scalar::abs(m(x)), m(x).digest(), m(x).millimetres()), (m(x.abs()), x.digest(), x.millimetres()));
        assert_eq!((m(x).quotient(m(y)), m(x).portion(m(1.0), m(y))), (m(x.quotient(y)), m(x.portion(1.0, y))));
        assert_eq!((m(x).quotient_unit(y), m(x).quotient_unit(0.0)), (x.quotient_unit(y).map(Micro), None));
        assert_eq!(Micro::unit_vector(m(x), m(y), m(5.0)), [x / 5.0, y / 5.0]);
        assert_eq!(Micro::difference(m(5.0), m(3.0), m(16.0)), m(2.0));
        let (sum, rest) = Scalar::sum(x, y);
        assert_eq!((Scalar::sum(m(x), m(y)), m(x).sum_up(m(y))), ((m(sum), m(rest)), m(x.sum_up(y))));
        assert_eq!((Micro::lag(m(x), m(y)), Micro::rounding(m(x))), (m(f32::lag(x, y)), m(f32::rounding(x))));
        assert_eq!(Micro::slack(m(2.0)), m(70.0 * f32::EPSILON));
        let ramp =
            AccelerationRamp { slow: m(0.5), fast: m(9.0), acceleration: m(0.25), duration: m(9.0), length: m(9.0) };
        assert_eq!(Micro::ramp_length(ramp, m(2.0)), m(1.5));
        near(Micro::ramp_time(ramp, m(1.5)).0, 2.0);
    }
    assert_eq!(
        [f32::INFINITY, f32::NAN, 1.0].map(|x| (Scalar::is_finite(m(x)), Radians(m(x)).is_finite())),
        [(false, false), (false, false), (true, true)]
    );
    assert_eq!([1024.0, -1024.0, 1024.1, -1024.1].map(|x| Radians(m(x)).is_in_range()), [true, true, false, false]);
}

#[test]
fn quadratics_have_both_roots_or_one_in_doubt() {
    let roots = |b: f32, g: f32, doubt: f32| {
        Micro::quadratic_roots(Micro(b), Micro(g), Micro(doubt))
            .map(|roots| roots.map(|root| (256.0 * root.0).round() / 256.0))
    };
    assert_eq!(
        [roots(-3.0, 8.0, 0.0), roots(3.0, 8.0, 0.0), roots(2.0, 4.0, 0.0)],
        [Some([4.0, 2.0]), Some([-4.0, -2.0]), Some([-2.0; 2])]
    );
    assert_eq!(
        [roots(1.0, 1.5, 0.5), roots(1.0, 1.5, 0.25), roots(0.0, 0.0, 0.0)],
        [Some([-1.0; 2]), None, Some([0.0; 2])]
    );
}

#[test]
fn half_tangents_are_found_in_their_sector() {
    let roots = |equation: [f32; 4], from: [f32; 2], sector: Option<([f32; 2], f32)>| {
        let all = AngleSector::all(from);
        let sector = sector.map_or(all, |(middle, least)| AngleSector { middle, least, ..all });
        let mut found = [9.0; 2];
        let mut count = 0;
        Micro::half_tangent_roots([equation.map(Micro)].into_iter(), sector, |angle| {
            // In 10⁻⁴ rad.
            found[count] = (1e4 * angle.0.0).round();
            count += 1;
        });
        found
    };
    // (τ - 1)(τ + 2), counted from 0 and from a quarter turn, and in sectors.
    let equation = [1.0, 0.5, -2.0, 0.0];
    assert_eq!(roots(equation, [1.0, 0.0], None), [-22_143.0, 15_708.0]);
    assert_eq!(roots(equation, [0.0, 1.0], None), [-6_435.0, 31_416.0]);
    assert_eq!(roots(equation, [1.0, 0.0], Some(([0.6, 0.8], 0.79))), [15_708.0, 9.0]);
    assert_eq!(roots(equation, [1.0, 0.0], Some(([-0.6, -0.8], 0.99))), [-22_143.0, 9.0]);
    assert_eq!(roots(equation, [1.0, 0.0], Some(([-0.96, -0.28], 0.79))), [-22_143.0, 9.0]);
    assert_eq!(roots(equation, [1.0, 0.0], Some(([-0.96, -0.28], 0.81))), [9.0; 2]);
    assert_eq!(roots(equation, [1.0, 0.0], Some(([1.0, 0.0], 0.01))), [9.0; 2]);
    // At the very ends of half a circle.
    assert_eq!(roots([1.0, 0.0, -1.0, 0.0], [1.0, 0.0], Some(([1.0, 0.0], 0.0))), [-15_708.0, 15_708.0]);
    // Real only because of `doubt`: one root, computed with the larger of two coefficients.
    assert_eq!(roots([1.0, 1.0, 3.0, 0.5], [1.0, 0.0], None), [-24_981.0, 9.0]);
    assert_eq!(roots([-3.0, 1.0, -1.0, 0.5], [1.0, 0.0], None), [6_435.0, 9.0]);
    assert_eq!(roots([-1.0, 1.0, -3.0, 0.5], [1.0, 0.0], None), [24_981.0, 9.0]);
    assert_eq!(roots([3.0, 1.0, 1.0, 0.5], [1.0, 0.0], None), [-6_435.0, 9.0]);
    assert_eq!(roots([1.0, 0.5, 1.0, 0.375], [1.0, 0.0], None), [-22_143.0, 9.0]);
    // The small root does not cancel.
    assert_eq!(roots([1.0, -1e4, 1.0, 0.0], [1.0, 0.0], None), [31_415.0, 1.0]);
    assert_eq!(roots([1.0, 1.0, 3.0, 0.4], [1.0, 0.0], None), [9.0; 2]);
    assert_eq!(roots([1.0, 1.0, 1.0, 0.0], [1.0, 0.0], None), [-15_708.0; 2]);
}

#[test]
fn angles_are_numbers_in_radians() {
    let [a, b] = [0.75, 0.5].map(|x| Radians(Micro(x)));
    assert_eq!(
        (a.arc_length(Micro(4.0)), Radians::circumference(Micro(4.0))),
        (Micro(3.0), Micro(4.0 * core::f32::consts::TAU))
    );
    assert_eq!(Angle::sum(a, b), (Radians(Micro(1.25)), Radians(Micro(0.0))));
    for (length, radius) in [(1.0_f32, 3.0_f32), (0.7, 0.3), (1e5, 7.0)] {
        let (angle, half) =
            (Radians::subtended(Micro(length), Micro(radius)), Radians::half_subtended(Micro(length), Micro(radius)));
        assert_eq!((angle, half), (Radians(Micro(length / radius)), Radians(Micro(0.5 * (length / radius)))));
        let rest: Radians<f32> = Radians(length / radius).subtended_rest(length, radius);
        assert_eq!(angle.subtended_rest(Micro(length), Micro(radius)), Radians(Micro(rest.0)));
    }
    assert_eq!(
        (a.sin_cos(), Radians::atan2(Micro(0.0), Micro(2.0))),
        (Radians(0.75_f32).sin_cos(), Radians(Micro(0.0)))
    );
    assert_eq!([4.0, 0.0, -4.0].map(|x| Wide::sqrt(Micro(x))), [2.0, 0.0, 0.0].map(Micro));
}
