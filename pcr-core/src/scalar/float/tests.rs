//! Tests with exact results, and at the limits of the documented ranges, in both formats.

use super::*;
use crate::array_vec::ArrayVec;
use core::f64::consts::{FRAC_PI_2, PI, TAU};
extern crate std;
use std::vec::Vec;

#[test]
fn quadratics_keep_the_small_root() {
    // u² - 2e4 u + 1 = 0: the naive small root of f32 is 0.
    let [large, small] = f32::quadratic_roots(-1e4, 1.0, 0.0).unwrap();
    assert_eq!((large, small), (2e4, 5e-5));
    assert_eq!(f64::quadratic_roots(0.0, 1.0, 0.0), None);
    assert_eq!(f64::quadratic_roots(0.0, 0.0, 0.0), Some([-0.0, 0.0]));
}

#[test]
fn half_tangent_roots_reach_the_far_end_of_the_diameter() {
    // τ² - 1 = 0: ± a quarter turn; a = 0: τ = ∞ is half a turn.
    let half_tangents = |a, b, g| {
        let mut angles = ArrayVec::<f64, 2>::new(0.0);
        let sector = AngleSector::all([1.0, 0.0]);
        f64::half_tangent_roots([[a, b, g, 0.0]].into_iter(), sector, |angle| angles.add(angle.0, true));
        <[f64; 2]>::try_from(angles.as_slice()).unwrap()
    };
    let quarter = core::f64::consts::FRAC_PI_2;
    let [r, s] = half_tangents(1.0, 0.0, -1.0);
    assert!((r.abs() - quarter).abs() < 1e-15 && (r + s).abs() < 1e-15);
    let [r, s] = half_tangents(0.0, 1.0, 0.0);
    assert!((r.abs() - 2.0 * quarter).abs() < 1e-15 && s == 0.0);
}

#[test]
fn differences_of_close_numbers_do_not_cancel() {
    // √(1e8 + 1) - 1e4 = 5e-5 - 1.25e-13
    let a = (1e8_f64 + 1.0).sqrt();
    assert!((f64::difference(a, 1e4, 1.0) - 4.999_999_987_5e-5).abs() < 1e-19);
    assert_eq!(f32::difference(0.0, 0.0, 0.0), 0.0);
}

/// Calls the format's function and returns the angles as `f64`.
fn roots<S>(equations: &[[S; 4]], sector: AngleSector<S>) -> Vec<f64>
where
    S: Scalar<Wide = S, Unit = S, Angle = Radians<S>> + Into<f64>,
{
    let mut found = Vec::new();
    S::half_tangent_roots(equations.iter().copied(), sector, |angle| found.push(angle.0.into()));
    found
}

macro_rules! exact {
    ($name:ident, $t:ident, digits: $digits:literal) => {
        mod $name {
            use super::*;

            const E: $t = $t::EPSILON;
            const LIMIT: $t = <$t as Scalar>::LIMIT;

            /// Whole numbers with all digits in use, and these times up to 2^40, of either sign.
            fn whole_numbers() -> Vec<$t> {
                let number =
                    |k: u64| ((1 << ($digits - 1)) + (k.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> (65 - $digits))) as $t;
                let shifts = [1.0, 2.0, 3.0, 4096.0, 1_099_511_627_776.0];
                let numbers = (1..12).map(|k: u64| number(k));
                numbers.flat_map(|x| shifts.into_iter().flat_map(move |shift: $t| [x * shift, -x * shift])).collect()
            }

            #[test]
            fn what_a_sum_is_rounded_by_is_told() {
                let exact = |x: $t| x as i128;
                for a in whole_numbers() {
                    for b in whole_numbers() {
                        let (sum, rest) = Scalar::sum(a, b);
                        assert_eq!((sum, exact(sum) + exact(rest)), (a + b, exact(a) + exact(b)), "{a} {b}");
                        let angles = Angle::<$t>::sum(Radians(a), Radians(b));
                        assert_eq!(angles, (Radians(sum), Radians(rest)));
                        let up = if exact(sum) < exact(a) + exact(b) { sum.next_up() } else { sum };
                        assert_eq!(a.sum_up(b), up, "{a} {b}");
                    }
                }
                assert_eq!([E / 4.0, -E / 8.0, E].map(|rest| (1.0 as $t).sum_up(rest)), [1.0 + E, 1.0, 1.0 + E]);
            }

            #[test]
            fn the_rest_of_an_angle_is_exact() {
                for length in whole_numbers() {
                    for radius in whole_numbers() {
                        let angle: Radians<$t> = Angle::<$t>::subtended(length, radius);
                        assert_eq!(angle, Radians(length / radius));
                        let rest = angle.subtended_rest(length, radius).0;
                        // The rest of the length can be represented in the format.
                        let left = libm::fma(-f64::from(angle.0), f64::from(radius), f64::from(length));
                        assert_eq!(f64::from(rest), f64::from((left as $t) / radius), "{length} {radius}");
                        assert_eq!(<Radians<$t> as Angle<$t>>::half_subtended(length, radius), Radians(0.5 * angle.0));
                    }
                }
            }

            #[test]
            fn quotients_saturate() {
                let most = 2.0 * LIMIT;
                let found = [(6.0, -4.0), (0.0, 0.0), (0.0, 2.0), (1.0, 0.0), (-1.0, 0.0), (3.0 * LIMIT, 1.0)];
                let expected = [-1.5, 0.0, 0.0, most, -most, most];
                assert_eq!(found.map(|(a, b): ($t, $t)| a.quotient(b)), expected);
                assert_eq!((6.0 as $t).quotient_unit(-0.5), Some(-12.0));
                let least = LIMIT.next_down();
                assert_eq!(
                    [LIMIT, -LIMIT, least, -least].map(|x| x.quotient_unit(1.0)),
                    [None, None, Some(least), Some(-least)]
                );
                assert_eq!([1.0, 0.0].map(|x: $t| x.quotient_unit(0.0)), [None; 2]);
                assert_eq!((6.0 as $t).portion(3.0, 4.0), 4.5);
                assert_eq!(<$t as Scalar>::unit_vector(3.0, -4.0, 8.0), [0.375, -0.5]);
                let difference = <$t as Scalar>::difference;
                assert_eq!(
                    [difference(5.0, 3.0, 16.0), difference(3.0, 5.0, -16.0), difference(0.0, 0.0, 0.0)],
                    [2.0, -2.0, 0.0]
                );
            }

            #[test]
            fn numbers_are_told_by_their_bits_and_millimetres() {
                let millimetres = [1.5, 0.000_9, -2.0, 1e12, $t::NAN].map(|x: $t| x.millimetres());
                assert_eq!(millimetres, [1500, 0, 0, u32::MAX, 0]);
                assert_eq!((1.0 as $t).advance(0.5, 3.0, 0.25), (2.25, 0.0));
                assert_eq!((1.0 as $t).advance(E / 8.0, E / 2.0, 0.25), (1.0, E / 4.0));
                assert_eq!([1.0, 3.0, 9.0].map(|x: $t| Scalar::clamp(x, 2.0, 4.0)), [2.0, 3.0, 4.0]);
                for x in [0.0, 2.5, -2.5] as [$t; 3] {
                    assert_eq!(
                        [x.negate_if(false), x.negate_if(true), Scalar::half(x), Scalar::abs(x)],
                        [x, -x, x / 2.0, x.max(-x)]
                    );
                    assert_eq!((Unit::abs(x), Wide::<$t>::half(x), Wide::<$t>::narrow(x)), (x.max(-x), x / 2.0, x));
                    assert_eq!(
                        (Scalar::times(x, 3.0), x.scale(5.0), Unit::times(x, -7.0)),
                        (3.0 * x, 5.0 * x, -7.0 * x)
                    );
                }
                assert_eq!([4.0, 0.0, -4.0].map(|x: $t| Wide::<$t>::sqrt(x)), [2.0, 0.0, 0.0]);
                assert!(Wide::<$t>::sqrt(-0.0 as $t).is_sign_positive());
                // Of two equal numbers, the first one is returned.
                assert!(
                    Scalar::min(0.0 as $t, -0.0).is_sign_positive() && Scalar::max(-0.0 as $t, 0.0).is_sign_negative()
                );
                let finite =
                    [1.0, $t::INFINITY, $t::NAN].map(|x| (Scalar::is_finite(x), Angle::<$t>::is_finite(Radians(x))));
                assert_eq!(finite, [(true, true), (false, false), (false, false)]);
            }

            #[test]
            fn bounds_are_as_documented() {
                assert_eq!(
                    [<$t as Scalar>::slack(2.0), <$t as Scalar>::rounding(3.0), <$t as Scalar>::lag(3.0, 5.0)],
                    [64.0 * E, 6.0 * E, 60.0 * E]
                );
                assert_eq!(<$t as Scalar>::drift(7, 3.0), 0.0);
                let sector = AngleSector::<$t>::all([0.0, 1.0]);
                assert!(sector.least < -1.0 && sector.from == [0.0, 1.0]);
            }

            #[test]
            fn quadratics_have_both_roots_or_one_in_doubt() {
                let roots = |b: $t, g: $t, doubt: $t| <$t as Scalar>::quadratic_roots(b, g, doubt);
                assert_eq!(
                    [roots(-3.0, 8.0, 0.0), roots(3.0, 8.0, 0.0), roots(2.0, 4.0, 0.0)],
                    [Some([4.0, 2.0]), Some([-4.0, -2.0]), Some([-2.0; 2])]
                );
                assert_eq!(
                    [roots(1.0, 1.5, 0.5), roots(1.0, 1.5, 0.25), roots(-1.0, 1.5, 1.0)],
                    [Some([-1.0; 2]), None, Some([1.0; 2])]
                );
            }

            #[test]
            fn half_tangents_are_found_in_their_sector() {
                let near = |found: Vec<f64>, exact: &[f64]| {
                    let close = |(found, exact): (&f64, &f64)| (found - exact).abs() < 8.0 * f64::from(E);
                    assert!(found.len() == exact.len() && found.iter().zip(exact).all(close), "{found:?} {exact:?}");
                };
                // (τ - 1)(τ + 2), counted from 0 and from a quarter turn.
                let equation = [1.0, 0.5, -2.0, 0.0];
                let steep = 2.0 * 2.0_f64.atan();
                near(roots(&[equation], AngleSector::<$t>::all([1.0, 0.0])), &[-steep, FRAC_PI_2]);
                near(roots(&[equation], AngleSector::<$t>::all([0.0, 1.0])), &[FRAC_PI_2 - steep, PI]);
                // Real only because of `doubt`: one root, computed with the larger of two coefficients.
                let all = AngleSector::<$t>::all([1.0, 0.0]);
                near(roots(&[[1.0, 1.0, 3.0, 0.5]], all), &[-2.0 * 3.0_f64.atan()]);
                near(roots(&[[-3.0, 1.0, -1.0, 0.5]], all), &[2.0 * (1.0_f64 / 3.0).atan()]);
                near(roots(&[[-1.0, 1.0, -3.0, 0.5]], all), &[2.0 * 3.0_f64.atan()]);
                near(roots(&[[1.0, 0.5, 1.0, 0.375]], all), &[-steep]);
                near(roots(&[[1.0, 1.0, 3.0, 0.4], [3.0, 1.0, 1.0, 0.4]], all), &[]);
                near(roots(&[[1.0, 1.0, 1.0, 0.0]], all), &[-FRAC_PI_2; 2]);
                // At the very ends of half a circle.
                near(roots(&[[1.0, 0.0, -1.0, 0.0]], AngleSector { least: 0.0, ..all }), &[-FRAC_PI_2, FRAC_PI_2]);
                // The small root does not cancel.
                let small = 2.0 * (1.0 / (1e4 + 99_999_999.0_f64.sqrt())).atan();
                near(roots(&[[1.0, -1e4, 1.0, 0.0]], all), &[PI - small, small]);
                near(roots(&[[1.0, 1e4, 1.0, 0.0]], all), &[small - PI, -small]);
            }

            #[test]
            fn sectors_leave_out_what_lies_outside_and_nothing_else() {
                let mut seen = [0; 2];
                let unit = |angle: f64| [angle.cos() as $t, angle.sin() as $t];
                for k in 0..4000 {
                    let part = |prime: f64| (f64::from(k) * prime).fract();
                    let [s, t] = [4.0 * part(0.618_034) - 2.0, 4.0 * part(0.414_214) - 2.0];
                    let (from, middle, half) = (TAU * part(0.732_051), TAU * part(0.236_068), PI * part(0.316_625));
                    let sector = AngleSector { from: unit(from), middle: unit(middle), least: half.cos() as $t };
                    // (τ - s)(2 τ - 2 t)
                    let found = roots(&[[2.0, -(s + t) as $t, (2.0 * s * t) as $t, 0.0]], sector);
                    for root in [s, t].into_iter().filter(|_| (s - t).abs() > 0.1) {
                        let angle = from + 2.0 * root.atan();
                        let inside = (angle - middle).cos() - half.cos();
                        let told = found.iter().any(|found| (found - angle).cos() > 1.0 - 1e-6);
                        if inside.abs() > 1e-4 {
                            assert_eq!(told, inside > 0.0, "{root} from {from} in {middle} ± {half}: {found:?}");
                            seen[usize::from(told)] += 1;
                        }
                    }
                }
                assert!(seen.into_iter().all(|seen| seen > 1000), "{seen:?}");
            }

            #[test]
            fn ramps_there_and_back() {
                let ramp = |slow: $t, acceleration: $t| AccelerationRamp {
                    slow,
                    fast: 9.0,
                    acceleration,
                    duration: 9.0,
                    length: 9.0,
                };
                assert_eq!(
                    [(0.5, 0.25), (0.0, 0.5), (0.5, 0.0)].map(|(v, a)| <$t as Scalar>::ramp_length(ramp(v, a), 2.0)),
                    [1.5, 1.0, 1.0]
                );
                assert_eq!(
                    [(0.5, 0.25, 1.5), (0.0, 0.5, 1.0), (0.5, 0.0, 1.0)]
                        .map(|(v, a, l)| <$t as Scalar>::ramp_time(ramp(v, a), l)),
                    [2.0; 3]
                );
                // Where roots are not exact, as accurate as a quotient.
                assert_eq!(<$t as Scalar>::ramp_time(ramp(0.1, 0.0), 0.3), (0.3 as $t) / 0.1);
                assert_eq!(<$t as Scalar>::ramp_time(ramp(0.0, 0.0), 0.0), 0.0);
            }

            #[test]
            fn angles_are_numbers_in_radians() {
                let [a, b]: [Radians<$t>; 2] = [Radians(0.75), Radians(0.5)];
                assert_eq!([a + b, a - b, -a], [Radians(1.25), Radians(0.25), Radians(-0.75)]);
                assert_eq!(
                    (a.arc_length(4.0), <Radians<$t> as Angle<$t>>::circumference(4.0)),
                    (3.0, 4.0 * core::$t::consts::TAU)
                );
                let quarter = Radians(core::$t::consts::FRAC_PI_2);
                assert_eq!(<Radians<$t> as Angle<$t>>::atan2_each([2.0, 0.0], [0.0, 3.0]), [quarter, Radians(0.0)]);
                let most = if $digits > 24 { 16_777_216.0 } else { 1024.0 } as $t;
                let in_range = [most, -most, most.next_up(), -most.next_up()]
                    .map(|angle| Angle::<$t>::is_in_range(Radians(angle)));
                assert_eq!(in_range, [true, true, false, false]);
            }
        }
    };
}

exact!(in_f64, f64, digits: 53);
exact!(in_f32, f32, digits: 24);

#[test]
fn digests_have_all_bits() {
    assert_eq!([1.0_f64.digest(), 0.1_f64.digest(), 1.0_f32.digest()], [0x3ff0_0000, 0xa620_0003, 0x3f80_0000]);
}

#[test]
fn tolerances_are_a_choice() {
    assert_eq!(f64::tolerance(2.0), 2.0_f64.powi(-31));
    assert_eq!(f32::tolerance(2.0), 2.0_f32.powi(-15));
}
