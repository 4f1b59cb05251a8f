//! Where an arc runs at an offset from a line or circle: a quadratic in the tangent of half the angle.

use crate::scaled::Scaled;
use crate::trigonometry::atan2;
use crate::turns::Turns;

/// Both angles `2 atan τ` with `a τ² + 2 b τ + g = 0`, `None` if they are not real even for an `a` and a `g` that are
/// off by `doubt`.
///
/// The coefficients are products of 64 bits, of three different sizes if the two circles are: each keeps 31 bits of its
/// own, which is a relative error of 2⁻³⁰ in each, and no product of more than 64 bits is formed. The angles are right to
/// 2⁻³⁰ of a turn for the coefficients so perturbed. One root, and a division an angle.
pub(crate) fn half_tangent(a: i64, b: i64, g: i64, doubt: i64) -> Option<[Turns; 2]> {
    let [a, b, g, doubt] = [a, b, g, doubt].map(|coefficient| Scaled::new(coefficient, 0));
    let discriminant = b.times(b).plus(a.times(g).minus());
    if discriminant.is_negative() {
        let within_doubt = !discriminant.plus(doubt.times(a.plus(g).magnitude())).is_negative();
        // τ = -b/a = -g/b, by the larger one of the coefficients that are in doubt.
        let larger = !a.magnitude().plus(g.magnitude().minus()).is_negative();
        let double = || if larger { angle(b.minus(), a) } else { angle(g, b.minus()) };
        return within_doubt.then(|| [double(); 2]);
    }
    // τ = q/a and τ = g/q with the sign that adds magnitudes, left as fractions: a = 0 is half a turn.
    let root = discriminant.sqrt();
    let q = if b.is_negative() { root.plus(b.minus()) } else { root.plus(b).minus() };
    Some([angle(q, a), angle(g, q)])
}

/// `2 atan(n / m)`
fn angle(n: Scaled, m: Scaled) -> Turns {
    let (n, m) = if m.is_negative() { (n.minus(), m.minus()) } else { (n, m) };
    let [n, m] = n.aligned(m);
    let half = Turns::from_bits(atan2(n, m));
    half + half
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Both of them where the curves touch: between two different ones there would be a gap that is none.
    #[test]
    fn roots_that_are_real_by_doubt_alone_are_one() {
        let (unit, off) = (1_i64 << 30, 1_i64 << 12);
        for (a, b, g) in [(unit, unit, unit + off), (unit + off, -unit, unit), (-unit - off, unit, -unit)] {
            let [low, high] = half_tangent(a, b, g, 2 * off).expect("real by doubt");
            assert_eq!(low, high, "{a} {b} {g}");
            // τ = ±1, right to what the doubt of a coefficient is worth.
            let quarter = if (a < 0) == (b < 0) { -Turns::QUARTER } else { Turns::QUARTER };
            assert!((low - quarter).to_bits().abs() <= 1 << 14, "{low:?}");
            assert_eq!(half_tangent(a, b, g, off / 4), None);
        }
    }
}
