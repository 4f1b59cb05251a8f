//! Where an arc runs at an offset from a line or circle: a quadratic in the tangent of half the angle.

use crate::scaled::Scaled;
use crate::sine::Sine;
use crate::trigonometry::atan2;
use crate::turns::Turns;
use pcr_core::scalar::Sector;

/// Both angles `2 atan τ` with `a τ² + 2 b τ + g = 0`, `None` if they are not real even for an `a` and a `g` that are
/// off by `doubt`.
///
/// The coefficients are products of 64 bits, of three different sizes if the two circles are: each keeps 31 bits of its
/// own, which is a relative error of 2⁻³⁰ in each, and no product of more than 64 bits is formed. The angles are right to
/// 2⁻³⁰ of a turn for the coefficients so perturbed. One root, and a division an angle.
pub(crate) fn half_tangent(a: i64, b: i64, g: i64, doubt: i64, sector: Sector<Sine>) -> Option<[Option<Turns>; 2]> {
    let [a, b, g, doubt] = [a, b, g, doubt].map(|coefficient| Scaled::new(coefficient, 0));
    let discriminant = b.times(b).plus(a.times(g).minus());
    if discriminant.is_negative() {
        let within_doubt = !discriminant.plus(doubt.times(a.plus(g).magnitude())).is_negative();
        // τ = -b/a = -g/b, by the larger one of the coefficients that are in doubt.
        let larger = !a.magnitude().plus(g.magnitude().minus()).is_negative();
        let double = || if larger { angle(b.minus(), a, sector) } else { angle(g, b.minus(), sector) };
        return within_doubt.then(|| [double(), None]);
    }
    // τ = q/a and τ = g/q with the sign that adds magnitudes, left as fractions: a = 0 is half a turn.
    let root = discriminant.sqrt();
    let q = if b.is_negative() { root.plus(b.minus()) } else { root.plus(b).minus() };
    Some([angle(q, a, sector), angle(g, q, sector)])
}

/// `2 atan(n / m)` if it lies in the sector.
fn angle(n: Scaled, m: Scaled, sector: Sector<Sine>) -> Option<Turns> {
    let (n, m) = if m.is_negative() { (n.minus(), m.minus()) } else { (n, m) };
    let [n, m] = n.aligned(m);
    may_lie_in(sector, n, m).then(|| {
        let half = Turns::from_bits(atan2(n, m));
        half + half
    })
}

/// Whether `2 atan(n / m)` may lie in the sector. In so few bits that no product has more than 32: the cosine is off by 2⁻¹⁰
/// at most.
fn may_lie_in(sector: Sector<Sine>, n: i32, m: i32) -> bool {
    let [n, m] = [n, m].map(|term| term >> 16);
    // The cosine and sine of the angle, and their common denominator.
    let [cos, sin, norm] = [m * m - n * n, 2 * (m * n), m * m + n * n].map(|square| square >> 16);
    let unit = |sine: Sine| sine.to_bits() >> (Sine::FRACTION_BITS - 14);
    cos * unit(sector.cos) + sin * unit(sector.sin) >= norm * unit(sector.least)
}

#[cfg(test)]
mod tests {
    use super::*;
    use pcr_core::scalar::Unit;

    /// Between two different ones there would be a gap that is none.
    #[test]
    fn roots_that_are_real_by_doubt_alone_are_one() {
        let (unit, off) = (1_i64 << 30, 1_i64 << 12);
        for (a, b, g) in [(unit, unit, unit + off), (unit + off, -unit, unit), (-unit - off, unit, -unit)] {
            let [Some(root), None] = half_tangent(a, b, g, 2 * off, Sector::all()).expect("real by doubt") else {
                panic!("two roots: {a} {b} {g}");
            };
            // τ = ±1, right to what the doubt of a coefficient is worth.
            let quarter = if (a < 0) == (b < 0) { -Turns::QUARTER } else { Turns::QUARTER };
            assert!((root - quarter).to_bits().abs() <= 1 << 14, "{root:?}");
            assert_eq!(half_tangent(a, b, g, off / 4, Sector::all()), None);
        }
    }

    /// Whatever is left out lies outside: an angle a little inside of the sector never is.
    #[test]
    fn sectors_leave_out_what_lies_outside_and_nothing_else() {
        let sine = |x: f64| Sine::from_bits((x * f64::from(1 << 30)) as i32);
        let (mut kept, mut left_out) = (0, 0);
        for k in 0..720 {
            let angle = f64::from(k - 360).to_radians() / 2.0;
            let (n, m) = ((angle / 2.0).sin(), (angle / 2.0).cos());
            let [n, m] = [n, m].map(|x| (x * 2_147_483_000.0) as i32);
            for middle in (0..360).step_by(7).map(|degree| f64::from(degree).to_radians()) {
                for half in (0..180).step_by(5).map(|degree| f64::from(degree).to_radians()) {
                    let sector = Sector {
                        cos: sine(middle.cos()),
                        sin: sine(middle.sin()),
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
