//! Roots of a quadratic in the tangent of half the angle: where an arc runs at an offset from a line or circle.

use crate::scaled::Scaled;
use crate::sine::Sine;
use crate::trigonometry::atan2;
use crate::turns::Turns;
use pcr_core::scalar::AngleSector;

/// The angles `φ + 2 atan τ` with `a τ² + 2 b τ + g = 0`, for equations `[a, b, g, doubt]`; φ is the angle from which
/// the sector counts. Roots that would be real with an error of up to `doubt` in `a` and `g` are included.
///
/// The coefficients are products of 64 bits. If the two circles differ in size, they have three different magnitudes.
/// Each one keeps 31 bits of its own, which is a relative error of 2⁻³⁰ in each, and no product has more than 64 bits.
/// The angles are right to 2⁻³⁰ of a turn for coefficients with these errors. Cost: one root for each equation, and a
/// division for each angle.
pub(crate) fn half_tangent(
    equations: impl Iterator<Item = [i64; 4]>,
    sector: AngleSector<Sine>,
    mut found: impl FnMut(Turns),
) {
    let mut from = None;
    for equation in equations {
        for [n, m] in half_tangents(equation).into_iter().flatten() {
            // Both must not be below 0, because the sum of their squares would not fit.
            let (n, m) = if m.is_negative() { (n.minus(), m.minus()) } else { (n, m) };
            let [n, m] = n.aligned(m);
            if may_lie_in(sector, n, m) {
                let [cos, sin] = sector.from.map(Sine::to_bits);
                let half = Turns::from_bits(atan2(n, m));
                found(*from.get_or_insert_with(|| Turns::from_bits(atan2(sin, cos))) + half + half);
            }
        }
    }
}

/// The real `τ` with `a τ² + 2 b τ + g = 0`, as fractions; a = 0 gives half a turn.
fn half_tangents(equation: [i64; 4]) -> [Option<[Scaled; 2]>; 2] {
    let [a, b, g, doubt] = equation.map(|coefficient| Scaled::new(coefficient, 0));
    let discriminant = b.times(b).plus(a.times(g).minus());
    if discriminant.is_negative() {
        let within_doubt = !discriminant.plus(doubt.times(a.plus(g).magnitude())).is_negative();
        // τ = -b/a = -g/b, computed with the larger of the two uncertain coefficients.
        let larger = !a.magnitude().plus(g.magnitude().minus()).is_negative();
        return [within_doubt.then_some(if larger { [b.minus(), a] } else { [g, b.minus()] }), None];
    }
    // τ = q/a and τ = g/q, with the sign that adds magnitudes.
    let root = discriminant.sqrt();
    let q = if b.is_negative() { root.plus(b.minus()) } else { root.plus(b).minus() };
    [Some([q, a]), Some([g, q])]
}

/// Whether the angle may lie in the sector. Uses so few bits that no product has more than 32; cosines are off by less
/// than 2⁻⁹.
fn may_lie_in(sector: AngleSector<Sine>, n: i32, m: i32) -> bool {
    let [n, m] = [n, m].map(|term| term >> 16);
    let unit = |sine: Sine| sine.to_bits() >> (Sine::FRACTION_BITS - 14);
    // The cosine and sine of 2 atan(n / m), and their common denominator.
    let [cos, sin, norm] = [m * m - n * n, 2 * (m * n), m * m + n * n].map(|square| square >> 15);
    let ([base_cos, base_sin], [middle_cos, middle_sin]) = (sector.from.map(unit), sector.middle.map(unit));
    let [x, y] = [cos * base_cos - sin * base_sin, sin * base_cos + cos * base_sin].map(|product| product >> 14);
    x * middle_cos + y * middle_sin >= norm * unit(sector.least)
}

#[cfg(test)]
mod tests {
    extern crate std;

    use super::*;
    use pcr_core::scalar::Unit;
    use std::vec::Vec;

    /// Two different roots would have a gap between them that does not exist.
    #[test]
    fn roots_that_are_real_by_doubt_alone_are_one() {
        let (unit, off) = (1_i64 << 30, 1_i64 << 12);
        for (a, b, g) in [(unit, unit, unit + off), (unit + off, -unit, unit), (-unit - off, unit, -unit)] {
            let roots = |doubt| {
                let mut roots = Vec::new();
                half_tangent([[a, b, g, doubt]].into_iter(), AngleSector::all([Sine::ONE, Sine::ZERO]), |root| {
                    roots.push(root)
                });
                roots
            };
            let [root] = roots(2 * off)[..] else { panic!("not one root: {a} {b} {g}") };
            // τ = ±1, within the effect of the doubt of a coefficient.
            let quarter = if (a < 0) == (b < 0) { -Turns::QUARTER } else { Turns::QUARTER };
            assert!((root - quarter).to_bits().abs() <= 1 << 14, "{root:?}");
            assert_eq!(roots(off / 4), []);
        }
    }

    /// (τ - 1)(τ + 2); and equations that are real only because of the doubt, whose root is computed with the larger
    /// coefficient.
    #[test]
    fn roots_are_those_of_the_equation() {
        let one = f64::from(1 << 30);
        let roots = |equation: [f64; 4], from: [Sine; 2]| {
            let mut roots = Vec::new();
            half_tangent([equation.map(|x| (x * one) as i64)].into_iter(), AngleSector::all(from), |root| {
                roots.push(root)
            });
            roots
        };
        let (east, north) = ([Sine::ONE, Sine::ZERO], [Sine::ZERO, Sine::ONE]);
        let near = |found: Vec<Turns>, tangents: &[f64]| {
            let exact = tangents.iter().map(|tangent| Turns::from_radians(2.0 * tangent.atan()).expect("an angle"));
            let close = |(found, exact): (&Turns, Turns)| (*found - exact).to_bits().abs() <= 4;
            assert!(found.len() == tangents.len() && found.iter().zip(exact).all(close), "{found:?} {tangents:?}");
        };
        for scale in [1.0, -1.0, 1.0 / 1024.0] {
            let equation = |[a, b, g, doubt]: [f64; 4]| [scale * a, scale * b, scale * g, scale.abs() * doubt];
            near(roots(equation([1.0, 0.5, -2.0, 0.0]), east), &[-2.0, 1.0]);
            near(roots(equation([1.0, -0.5, -2.0, 0.0]), east), &[2.0, -1.0]);
            near(roots(equation([0.0, 1.0, 2.0, 0.0]), east), &[f64::NEG_INFINITY, -1.0]);
            near(roots(equation([1.0, 1.0, 3.0, 0.51]), east), &[-3.0]);
            near(roots(equation([1.0, -1.0, 3.0, 0.51]), east), &[3.0]);
            near(roots(equation([3.0, 1.0, 1.0, 0.51]), east), &[-1.0 / 3.0]);
            near(roots(equation([1.0, 0.5, 1.0, 0.376]), east), &[-0.5]);
            near(roots(equation([1.0, 1.0, 3.0, 0.49]), east), &[]);
        }
        let turned = roots([1.0, 0.5, -2.0, 0.0], north).into_iter().map(|root| root - Turns::QUARTER).collect();
        near(turned, &[-2.0, 1.0]);
    }

    /// Both terms have 15 leading ones: if they stayed negative, their squares would be 2³⁰ each, and the sum would
    /// overflow.
    #[test]
    fn a_denominator_is_positive_so_that_squares_fit() {
        let (a, b) = ((1 << 31) - 2, 1 - (1 << 30));
        let mut roots = Vec::new();
        half_tangent([[a, b, 0, 0]].into_iter(), AngleSector::all([Sine::ONE, Sine::ZERO]), |root| roots.push(root));
        assert_eq!(roots, [Turns::QUARTER, Turns::ZERO]);
    }

    #[test]
    fn the_ends_of_a_sector_are_in_it() {
        let east = [Sine::ONE, Sine::ZERO];
        let half_circle = AngleSector { least: Sine::ZERO, ..AngleSector::all(east) };
        assert!(may_lie_in(half_circle, 1 << 30, 1 << 30) && may_lie_in(half_circle, -1 << 30, 1 << 30));
        assert!(!may_lie_in(half_circle, (1 << 30) + (1 << 22), 1 << 30));
    }

    /// Angles that are left out lie outside; an angle a little inside of the sector is never left out.
    #[test]
    fn sectors_leave_out_what_lies_outside_and_nothing_else() {
        let sine = |x: f64| Sine::from_bits((x * f64::from(1 << 30)) as i32);
        let (mut kept, mut left_out) = (0, 0);
        for k in 0..720 {
            let (angle, from) = (f64::from(k - 360).to_radians() / 2.0, f64::from(k * 7).to_radians());
            let (n, m) = ((angle / 2.0).sin(), (angle / 2.0).cos());
            let [n, m] = [n, m].map(|x| (x * 2_147_483_000.0) as i32);
            for middle in (0..360).step_by(7).map(|degree| f64::from(degree).to_radians()) {
                for half in (0..180).step_by(5).map(|degree| f64::from(degree).to_radians()) {
                    let sector = AngleSector {
                        from: [sine(from.cos()), sine(from.sin())],
                        middle: [sine((from + middle).cos()), sine((from + middle).sin())],
                        least: sine(half.cos()) - Sine::COARSE,
                    };
                    let above = (angle - middle).cos() - half.cos();
                    if may_lie_in(sector, n, m) {
                        kept += 1;
                        assert!(above > -0.004, "{angle} is {above} outside of {middle} ± {half}");
                    } else {
                        left_out += 1;
                        assert!(above < 0.0, "{angle} is {above} inside of {middle} ± {half}");
                    }
                }
            }
        }
        assert!(kept > 10_000 && left_out > 10_000);
    }
}
