//! Sine, cosine and arctangent of binary angles, in 64-bit products.
//!
//! Angles are taken to an eighth of a turn, where polynomials in the square hold: those that interpolate at the
//! Chebyshev nodes, which is within a few per cent of the best. At the axes, where the remaining angle is 0, they leave
//! the exact value.

use crate::integer::divide;

/// Fraction bits of the coefficients after the first two or three: they are small.
const INNER: u32 = 36;

/// `sin(π/4 u) / u = S₀ + S₁ z + …`, `z = u²`, the first two in 2⁻³¹.
pub(crate) const SINE: [i32; 5] = [1_686_629_713, -173_399_667, 171_138_518, -2_513_236, 21_234];
/// `(cos(π/4 u) - 1) / z = C₀ + C₁ z + …`, the first one in 2⁻³¹.
pub(crate) const COSINE: [i32; 4] = [-662_337_939, 1_089_501_821, -22_399_895, 243_401];
/// `atan(t) / 2πt = A₀ + A₁ z + …`, `z = t²`, in 2⁻³³.
pub(crate) const ARCTANGENT: [i32; 6] =
    [1_367_130_550, -455_709_819, 273_401_098, -194_669_824, 144_479_685, -82_326_426];

/// `a z / 2^SHIFT`, rounded to nearest.
fn scaled<const SHIFT: u32>(a: i32, z: u32) -> i32 {
    ((i64::from(a) * i64::from(z) + (1 << (SHIFT - 1))) >> SHIFT) as i32
}

/// Sine and cosine of an angle in 2⁻³² of a turn, times 2³⁰: right to 1.18 · 2⁻³⁰, and to 1.51 · 2⁻³⁰ as a vector (all angles: docs/errors.md).
///
/// Ten products.
pub(crate) fn sin_cos(angle: i32) -> (i32, i32) {
    // The nearest quarter turn, and what is left: u = ±1 is an eighth of a turn.
    let quarter = angle.wrapping_add(1 << 29) >> 30;
    let u = angle.wrapping_sub(quarter << 30) << 2;
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

/// Angle of the vector `(x, y)` in 2⁻³² of a turn, right to 0.8 of that; half a turn is -2³¹, and 0 for the zero vector.
///
/// Eight products and a division: a tangent is a quotient.
pub(crate) fn atan2(y: i32, x: i32) -> i32 {
    /// In 2⁻⁷: a little less than tan(π/8). Above, the angle is counted from an eighth of a turn.
    const SPLIT: u32 = 53;
    let (ax, ay) = (x.unsigned_abs(), y.unsigned_abs());
    let (small, large) = if ay > ax { (ax, ay) } else { (ay, ax) };
    if large == 0 {
        return 0;
    }
    // Below 2³¹, so that their sum fits, and as large as that allows.
    let zeros = large.leading_zeros();
    let (small, large) =
        if zeros == 0 { (small >> 1, large >> 1) } else { (small << (zeros - 1), large << (zeros - 1)) };
    let from_eighth = small > (large >> 7) * SPLIT;
    let (n, m) = if from_eighth { (large - small, large + small) } else { (small, large) };

    // t in 2⁻³², below 0.4145, and z in 2⁻³⁴, below 0.1719
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
