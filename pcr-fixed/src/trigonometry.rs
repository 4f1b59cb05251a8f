//! Sine, cosine and arctangent of binary angles, with 64-bit products.
//!
//! Angles are reduced to an eighth of a turn, where polynomials in the square are used. They interpolate at the
//! Chebyshev nodes, which is within a few per cent of the best polynomials. At the axes, where the reduced angle is 0,
//! results are exact.

use crate::integer::divide;

/// Fraction bits of the small coefficients, after the first two or three.
const INNER: u32 = 36;

/// `sin(π/4 u) / u = S₀ + S₁ z + …`, `z = u²`; the first two in units of 2⁻³¹.
pub(crate) const SINE: [i32; 5] = [1_686_629_713, -173_399_667, 171_138_518, -2_513_236, 21_234];
/// `(cos(π/4 u) - 1) / z = C₀ + C₁ z + …`; the first one in units of 2⁻³¹.
pub(crate) const COSINE: [i32; 4] = [-662_337_939, 1_089_501_821, -22_399_895, 243_401];
/// `atan(t) / 2πt = A₀ + A₁ z + …`, `z = t²`, in units of 2⁻³³.
pub(crate) const ARCTANGENT: [i32; 6] =
    [1_367_130_550, -455_709_819, 273_401_098, -194_669_824, 144_479_685, -82_326_426];

/// `a z / 2^SHIFT`, rounded to nearest.
fn scaled<const SHIFT: u32>(a: i32, z: u32) -> i32 {
    ((i64::from(a) * i64::from(z) + (1 << (SHIFT - 1))) >> SHIFT) as i32
}

/// Sine and cosine, times 2³⁰, of an angle in units of 2⁻³² of a turn. Right to 1.18 · 2⁻³⁰, and to 1.51 · 2⁻³⁰ as a
/// vector (all angles: docs/theory/errors.md).
///
/// Cost: ten products.
pub(crate) fn sin_cos(angle: i32) -> (i32, i32) {
    // The nearest quarter turn, and the rest: u = ±1 is an eighth of a turn.
    let quarter = angle.wrapping_add(1 << 29) >> 30;
    let u = angle << 2;
    let z = ((i64::from(u) * i64::from(u)) >> 31) as u32;

    let inner = SINE[2] + scaled::<31>(SINE[3] + scaled::<31>(SINE[4], z), z);
    let outer = SINE[0] + scaled::<31>(SINE[1] + scaled::<{ INNER }>(inner, z), z);
    let sin = ((i64::from(u) * i64::from(outer) + (1 << 31)) >> 32) as i32;

    let inner = COSINE[1] + scaled::<31>(COSINE[2] + scaled::<31>(COSINE[3], z), z);
    let cos = (1 << 30) + scaled::<32>(COSINE[0] + scaled::<{ INNER }>(inner, z), z);

    match quarter & 3 {
        0 => (sin, cos),
        1 => (cos, -sin),
        2 => (-sin, -cos),
        _ => (-cos, sin),
    }
}

/// Angle of the vector `(x, y)` in units of 2⁻³² of a turn, right to 0.93 units. Half a turn is -2³¹; the zero vector
/// gives 0.
///
/// The polynomial is off by 0.21 units, its rounding by 0.13, the tangent and its square by 0.09, and the result is
/// rounded. A component of -2³¹ loses its last bit.
///
/// Cost: eight products and a division, for the tangent.
pub(crate) fn atan2(y: i32, x: i32) -> i32 {
    /// In units of 2⁻⁷: a little less than tan(π/8). Above it, the angle is counted from an eighth of a turn.
    const SPLIT: u32 = 53;
    let (ax, ay) = (x.unsigned_abs(), y.unsigned_abs());
    let (small, large) = if ay > ax { (ax, ay) } else { (ay, ax) };
    if large == 0 {
        return 0;
    }
    // Shifted to be as large as possible below 2³¹, so that their sum fits.
    let zeros = large.leading_zeros();
    let (small, large) =
        if zeros == 0 { (small >> 1, large >> 1) } else { (small << (zeros - 1), large << (zeros - 1)) };
    let from_eighth = small > (large >> 7) * SPLIT;
    let (n, m) = if from_eighth { (large - small, large + small) } else { (small, large) };

    // t in units of 2⁻³², below 0.4145; z in units of 2⁻³⁴, below 0.1719.
    let t = divide((u64::from(n) << 32) + u64::from(m >> 1), m);
    let z = ((u64::from(t) * u64::from(t)) >> 30) as u32;
    let mut sum = 0;
    for coefficient in ARCTANGENT.into_iter().rev() {
        sum = coefficient + scaled::<34>(sum, z);
    }
    let angle = scaled::<33>(sum, t);

    let octant = if from_eighth { (1 << 29) - angle } else { angle };
    let quadrant = if ay > ax { (1 << 30) - octant } else { octant };
    let half = if x < 0 { i32::MIN.wrapping_sub(quadrant) } else { quadrant };
    if y < 0 { half.wrapping_neg() } else { half }
}

#[cfg(test)]
mod tests {
    extern crate std;

    use super::*;
    use std::f64::consts::TAU;

    const TURN: f64 = 4_294_967_296.0;
    const EIGHTH: i32 = 1 << 29;

    /// The step is odd, so that the low bits differ, too.
    fn angles() -> impl Iterator<Item = i32> {
        (0..200_000_u32).map(|k| k.wrapping_mul(2_654_435_761) as i32)
    }

    #[test]
    fn sines_stay_within_their_bound() {
        let mut worst = 0.0_f64;
        for angle in angles() {
            let ((sin, cos), exact) = (sin_cos(angle), (f64::from(angle) * (TAU / TURN)).sin_cos());
            let off = |found: i32, exact: f64| (f64::from(found) - exact * f64::from(1 << 30)).abs();
            worst = worst.max(off(sin, exact.0)).max(off(cos, exact.1));
            // The quarters follow from one another by swaps and signs.
            assert_eq!(sin_cos(angle.wrapping_add(2 * EIGHTH)), (cos, -sin));
            assert_eq!(sin_cos(angle.wrapping_sub(2 * EIGHTH)), (-cos, sin));
            assert_eq!(sin_cos(angle ^ i32::MIN), (-sin, -cos));
        }
        assert!(worst < 1.18 && worst > 1.1, "largest error {worst} of 2^-30");
        assert_eq!([sin_cos(0), sin_cos(2 * EIGHTH), sin_cos(i32::MIN)], [(0, 1 << 30), (1 << 30, 0), (0, -1 << 30)]);
    }

    #[test]
    fn arctangents_stay_within_their_bound() {
        let mut worst = 0.0_f64;
        for (k, angle) in (0_u32..).zip(angles()) {
            let (sin, cos) = (f64::from(angle) * (TAU / TURN)).sin_cos();
            // Down to a few digits, and also in the last one of 32 bits.
            let length = TURN / 2.0 * 0.75_f64.powi((k % 60) as i32);
            let [y, x] = [sin, cos].map(|part| (length * part) as i32);
            let exact = f64::from(y).atan2(f64::from(x)) * (TURN / TAU);
            worst =
                worst.max((f64::from(atan2(y, x)) - exact).abs().min((f64::from(atan2(y, x)) + TURN - exact).abs()));
        }
        assert!(worst < 0.93 && worst > 0.8, "largest error {worst} of 2^-32");
    }

    #[test]
    fn arctangents_are_exact_on_axes_and_diagonals() {
        for r in [1, 2, 53, 1 << 16, (1 << 30) + 3, i32::MAX] {
            let eighths =
                [(0, r), (r, r), (r, 0), (r, -r), (0, -r), (-r, -r), (-r, 0), (-r, r)].map(|(y, x)| atan2(y, x));
            assert_eq!(eighths, [0, 1, 2, 3, -4, -3, -2, -1].map(|k| k * EIGHTH), "{r}");
        }
        let least = i32::MIN;
        let found = [(least, least), (least, 0), (0, least), (least, 1), (1, least)].map(|(y, x)| atan2(y, x));
        assert_eq!(found, [-3 * EIGHTH, -2 * EIGHTH, least, -2 * EIGHTH, least]);
        assert_eq!(atan2(0, 0), 0);
    }

    /// Results have the same bits on every machine, which is stronger than being within their bounds.
    #[test]
    fn results_have_the_same_bits_everywhere() {
        let sum = |sum: u64, value: i32| sum.wrapping_mul(0x0000_0100_0000_01b3) ^ u64::from(value as u32);
        let (mut sines, mut arctangents) = (0, 0);
        let mut before = 1;
        for angle in angles().take(20_000) {
            let (sin, cos) = sin_cos(angle);
            sines = sum(sum(sines, sin), cos);
            arctangents = sum(arctangents, atan2(angle, before));
            before = angle;
        }
        assert_eq!((sines, arctangents), (18_042_411_487_546_137_758, 16_459_734_619_735_061_230));
    }
}
