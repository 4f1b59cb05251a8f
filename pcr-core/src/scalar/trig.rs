//! Sine, cosine and arctangent of `f32` and `f64`, each in its own arithmetic, with one division at most.
//!
//! libm computes the sine and cosine of `f32` in `f64`, which a single-precision FPU does not support, and its
//! arctangents divide twice. The polynomials are those of Cephes (Moshier 1989) for `f32` and of fdlibm (Sun 1993) for
//! `f64`.

use core::hint::select_unpredictable as select;

/// Floating-point numbers with their own implementation of these functions.
///
/// If a processor has SIMD lanes and the compiler sees both, two arctangents at once take the time of one. Only
/// desktops have such lanes, hence only `f64` uses this.
pub(super) trait Trig: Copy {
    /// Sine and cosine.
    fn sin_cos(self) -> (Self, Self);
    /// Angle of the vector `(x, y)`.
    fn atan2(y: Self, x: Self) -> Self;
    /// Angles of two vectors.
    fn atan2_each([y, v]: [Self; 2], [x, u]: [Self; 2]) -> [Self; 2] {
        [Self::atan2(y, x), Self::atan2(v, u)]
    }
    /// Calls `found` with the angles of vectors `[y, x]`.
    fn angles(vectors: &[[Self; 2]], found: impl FnMut(Self)) {
        vectors.iter().map(|&[y, x]| Self::atan2(y, x)).for_each(found);
    }
}

impl Trig for f32 {
    fn sin_cos(self) -> (f32, f32) {
        sin_cos_f32(self)
    }
    fn atan2(y: f32, x: f32) -> f32 {
        atan2_f32(y, x)
    }
}

impl Trig for f64 {
    fn sin_cos(self) -> (f64, f64) {
        sin_cos_f64(self)
    }
    fn atan2(y: f64, x: f64) -> f64 {
        atan2_f64(y, x)
    }
    #[inline(never)]
    fn atan2_each([y, v]: [f64; 2], [x, u]: [f64; 2]) -> [f64; 2] {
        [atan2_f64(y, x), atan2_f64(v, u)]
    }
    fn angles(vectors: &[[f64; 2]], mut found: impl FnMut(f64)) {
        for vectors in vectors.chunks(2) {
            match *vectors {
                [[y, x], [v, u]] => Self::atan2_each([y, v], [x, u]).into_iter().for_each(&mut found),
                [[y, x]] => found(atan2_f64(y, x)),
                _ => {}
            }
        }
    }
}

/// Sine and cosine. The argument is reduced by quarter turns, in parts (Cody and Waite), to `[-π/4, π/4]`. The
/// polynomials are `(sin r / r - 1) / r²` and `(cos r - 1 + r²/2) / r⁴` in `r²`.
macro_rules! sin_cos {
    ($(#[$doc:meta])* $name:ident($t:ident), quarter: $quarter:expr, polynomials: $polynomials:expr) => {
        $(#[$doc])*
        fn $name(x: $t) -> ($t, $t) {
            // A sum with this number has no fraction bits: it is rounded to an integer, whose lowest bits are the last
            // bits of the sum.
            const ROUND: $t = 1.5 / $t::EPSILON;
            const SIGN: u32 = 8 * size_of::<$t>() as u32 - 1;
            let shifted = x * core::$t::consts::FRAC_2_PI + ROUND;
            let (quarters, k) = (shifted.to_bits(), shifted - ROUND);
            let r = $quarter.into_iter().fold(x, |r, part: $t| r - k * part);
            let z = r * r;
            let [sin, cos] = $polynomials(z);
            let (sin, cos) = (r + r * (z * sin), (1.0 - 0.5 * z) + z * (z * cos));
            // Selected with bit operations, because the quarter is unpredictable.
            let (sin, cos) = (sin.to_bits(), cos.to_bits());
            let exchanged = (sin ^ cos) & (quarters & 1).wrapping_neg();
            let signed = |value, quarters| $t::from_bits(value ^ ((quarters & 2) << (SIGN - 1)));
            (signed(sin ^ exchanged, quarters), signed(cos ^ exchanged, quarters.wrapping_add(1)))
        }
    };
}

/// Arctangent. The angle is that of the smaller to the larger component; if it is nearer to an eighth of a turn, that
/// is subtracted. The rest is `atan(t)` with `|t| <= tan(π/8)`. The polynomial is `(1 - atan t / t) / t²` in `t²`.
macro_rules! atan2 {
    ($(#[$doc:meta])* $name:ident($t:ident), polynomial: $polynomial:expr) => {
        $(#[$doc])*
        fn $name(y: $t, x: $t) -> $t {
            use core::$t::consts::{FRAC_PI_2, FRAC_PI_4, PI};
            const TAN_PI_8: $t = 0.414_213_562_373_095_03_f64 as $t;
            let steep = y.abs() > x.abs();
            let (small, large) = (select(steep, x.abs(), y.abs()), select(steep, y.abs(), x.abs()));
            // Without branches, because the octant is unpredictable.
            let beyond = select(small > TAN_PI_8 * large, 1.0, 0.0);
            let (n, m) = (small - beyond * large, large + beyond * small);
            let t = if m > 0.0 { n / m } else { 0.0 };
            let z = t * t;
            let octant = beyond * FRAC_PI_4 + (t - t * (z * $polynomial(z)));
            let quadrant = select(steep, FRAC_PI_2 - octant, octant);
            let backward = (x.to_bits() >> (8 * size_of::<$t>() - 1)).wrapping_neg();
            let half = $t::from_bits(PI.to_bits() & backward) + quadrant.copysign(x);
            half.copysign(y)
        }
    };
}

/// Evaluates a polynomial given by its coefficients, the constant first.
macro_rules! horner {
    ($name:ident, $t:ident) => {
        fn $name<const N: usize>(x: $t, coefficients: [$t; N]) -> $t {
            coefficients.into_iter().rev().reduce(|sum, coefficient| sum * x + coefficient).unwrap_or(0.0)
        }
    };
}
horner!(horner_f32, f32);
horner!(horner_f64, f64);

/// Evaluates two polynomials side by side, which a processor with SIMD lanes does at once.
fn horner_each<const N: usize>(x: f64, coefficients: [[f64; 2]; N]) -> [f64; 2] {
    let sums = coefficients.into_iter().rev().reduce(|[a, b], [c, d]| [a * x + c, b * x + d]);
    sums.unwrap_or_default()
}

sin_cos!(
    /// Absolute error below 1.57 unit roundoffs for `|x| <= 1024`: 160 turns.
    sin_cos_f32(f32),
    quarter: [1.570_312_5, 4.837_513e-4, 7.549_79e-8],
    polynomials: |z| {
        let sin = horner_f32(z, [-1.666_665_5e-1, 8.332_161e-3, -1.951_529_6e-4]);
        [sin, horner_f32(z, [4.166_664_6e-2, -1.388_731_6e-3, 2.443_315_7e-5])]
    }
);

sin_cos!(
    /// Absolute error below 1.8 unit roundoffs, 2e-16, for `|x|` up to a million; beyond that, libm reduces the
    /// argument.
    near_sin_cos_f64(f64),
    quarter: [1.570_796_326_734_125_6, 6.077_100_506_506_192e-11],
    polynomials: |z: f64| {
        let w = z * z;
        let even = horner_each(
            w,
            [
                [-1.666_666_666_666_663_2e-1, 4.166_666_666_666_66e-2],
                [-1.984_126_982_985_795e-4, 2.480_158_728_947_673e-5],
                [-2.505_076_025_340_686_3e-8, 2.087_572_321_298_175e-9],
            ],
        );
        let odd = horner_each(
            w,
            [
                [8.333_333_333_322_49e-3, -1.388_888_888_887_411e-3],
                [2.755_731_370_707_007e-6, -2.755_731_435_139_066_3e-7],
                [1.589_690_995_211_55e-10, -1.135_964_755_778_819_5e-11],
            ],
        );
        [even[0] + z * odd[0], even[1] + z * odd[1]]
    }
);

/// Sine and cosine, absolute error below 2e-16.
fn sin_cos_f64(x: f64) -> (f64, f64) {
    if x.abs() < 1e6 { near_sin_cos_f64(x) } else { far_sin_cos_f64(x) }
}

/// A separate function, because the stack frame of its reduction would otherwise also be needed for small arguments.
#[cold]
#[inline(never)]
fn far_sin_cos_f64(x: f64) -> (f64, f64) {
    libm::sincos(x)
}

atan2!(
    /// Angle of the vector `(x, y)`, right to 6 unit roundoffs of itself (docs/theory/errors.md); signed zeros as in C.
    atan2_f32(f32),
    polynomial: |z| horner_f32(z, [3.333_295e-1, -1.997_771_1e-1, 1.387_768_6e-1, -8.053_745e-2])
);

atan2!(
    /// Angle of the vector `(x, y)`, right to 6 unit roundoffs of itself (docs/theory/errors.md); signed zeros as in C.
    atan2_f64(f64),
    polynomial: |z: f64| {
        let w = z * z;
        let even = horner_f64(
            w,
            [
                3.333_333_333_333_293e-1,
                1.428_571_427_250_346_6e-1,
                9.090_887_133_436_507e-2,
                6.661_073_137_387_531e-2,
                4.976_877_994_615_932e-2,
                1.628_582_011_536_578_2e-2,
            ],
        );
        let odd = horner_f64(
            w,
            [
                -1.999_999_999_987_648_3e-1,
                -1.111_111_040_546_235_6e-1,
                -7.691_876_205_044_83e-2,
                -5.833_570_133_790_573_5e-2,
                -3.653_157_274_421_691_6e-2,
            ],
        );
        even + z * odd
    }
);

#[cfg(test)]
mod tests {
    extern crate std;

    use super::*;

    /// Asserts that the largest error of `pairs`, found and exact, is below `bound`, but not far below it.
    fn assert_bound(bound: f64, pairs: impl Iterator<Item = (f64, f64)>) {
        let worst = pairs.map(|(found, exact)| (found - exact).abs()).fold(0.0, f64::max);
        assert!(worst < bound, "largest error {worst:e}");
        assert!(worst > 0.2 * bound, "the stated bound is idle: largest error {worst:e}");
    }

    #[test]
    fn sin_cos_f32_stays_within_its_bound() {
        let arguments = (-2_000_003_i32..=2_000_003).map(|step| step as f32 * 5.119e-4);
        assert_bound(
            1.57 * 0.5 * f64::from(f32::EPSILON),
            arguments.flat_map(|x| {
                let ((sin, cos), exact) = (sin_cos_f32(x), libm::sincos(f64::from(x)));
                [(f64::from(sin), exact.0), (f64::from(cos), exact.1)]
            }),
        );
    }

    #[test]
    fn sin_cos_f64_stays_within_its_bound() {
        // The reference adds the error of libm, half a unit in the last place.
        let near = (-2_000_003_i32..=2_000_003).map(|step| f64::from(step) * 4.0e-6);
        let far = (-500_003_i32..=500_003).map(|step| f64::from(step) * 1.999_9);
        assert_bound(
            2e-16,
            near.chain(far).flat_map(|x| {
                let ((sin, cos), exact) = (sin_cos_f64(x), libm::sincos(x));
                [(sin, exact.0), (cos, exact.1)]
            }),
        );
    }

    #[test]
    fn sines_and_cosines_are_exact_at_zero() {
        assert_eq!((sin_cos_f32(0.0), sin_cos_f64(0.0)), ((0.0, 1.0), (0.0, 1.0)));
        assert_eq!(sin_cos_f64(1e-300), (1e-300, 1.0));
    }

    /// Every direction, at lengths from 1e-8 to 1e8.
    fn vectors() -> impl Iterator<Item = (f64, f64)> {
        (1..2_000_003_u32).map(|step| {
            let (sin, cos) = libm::sincos(f64::from(step) * 3.141_6e-6);
            let length = libm::exp10(f64::from(step % 17) - 8.0);
            (length * sin, length * cos)
        })
    }

    #[test]
    fn arctangents_stay_within_their_bounds() {
        // Relative, because an angle is multiplied by radii of any size. The reference adds the error of libm, a unit
        // in the last place.
        let near = |found: f64, exact: f64| (found / exact, 1.0);
        assert_bound(6.0 * 0.5 * f64::EPSILON, vectors().map(|(y, x)| near(atan2_f64(y, x), libm::atan2(y, x))));
        let vectors = vectors().map(|(y, x)| (y as f32, x as f32));
        let near = vectors.map(|(y, x)| near(f64::from(atan2_f32(y, x)), libm::atan2(f64::from(y), f64::from(x))));
        assert_bound(6.0 * 0.5 * f64::from(f32::EPSILON), near);
    }

    #[test]
    fn arctangents_are_exact_on_axes_and_diagonals() {
        for (y, x) in
            [(0.0, 0.0), (0.0, 1.0), (0.0, -1.0), (-0.0, 1.0), (-0.0, -1.0), (1.0, 0.0), (-1.0, 0.0), (1.0, 1.0)]
        {
            assert_eq!(atan2_f64(y, x).to_bits(), libm::atan2(y, x).to_bits(), "atan2({y}, {x})");
            let (y, x) = (y as f32, x as f32);
            assert_eq!(atan2_f32(y, x).to_bits(), libm::atan2f(y, x).to_bits(), "atan2({y}, {x})");
        }
        for tiny in [1e-300, 1e-20] {
            assert_eq!(atan2_f64(tiny, 1.0), tiny);
        }
    }

    /// Results have the same bits on every machine, which is stronger than being within their bounds.
    #[test]
    fn results_have_the_same_bits_everywhere() {
        let add = |sum: u64, bits: u64| sum.wrapping_mul(0x0000_0100_0000_01b3) ^ bits;
        let mut sums = [0; 4];
        for (y, x) in vectors().step_by(97) {
            let ((sin, cos), angle) = (sin_cos_f64(y), atan2_f64(y, x));
            sums[0] = add(add(sums[0], sin.to_bits()), cos.to_bits());
            sums[1] = add(sums[1], angle.to_bits());
            let (y, x) = (y as f32, x as f32);
            let ((sin, cos), angle) = (sin_cos_f32(y.clamp(-1024.0, 1024.0)), atan2_f32(y, x));
            sums[2] = add(add(sums[2], sin.to_bits().into()), cos.to_bits().into());
            sums[3] = add(sums[3], angle.to_bits().into());
        }
        assert_eq!(
            sums,
            [
                13_792_369_514_597_387_430,
                12_193_820_165_543_421_553,
                12_791_667_522_432_000_330,
                12_340_913_809_746_776_790
            ]
        );
    }

    #[test]
    fn angles_of_any_number_of_vectors_are_told_in_order() {
        let vectors = [[1.0, 1.0], [1.0, 0.0], [0.0, -1.0], [-1.0, 0.0]];
        let angles = [0.25, 0.5, 1.0, -0.5].map(|half: f64| half * core::f64::consts::PI);
        for count in 0..=4 {
            let mut told = std::vec::Vec::new();
            Trig::angles(&vectors[..count], |angle: f64| told.push(angle));
            assert_eq!(told, angles[..count]);
            let mut told = std::vec::Vec::new();
            Trig::angles(
                &vectors[..count].iter().map(|v| v.map(|x| x as f32)).collect::<std::vec::Vec<_>>(),
                |angle: f32| told.push(angle),
            );
            assert_eq!(told, angles[..count].iter().map(|&x| x as f32).collect::<std::vec::Vec<_>>());
        }
    }
}
