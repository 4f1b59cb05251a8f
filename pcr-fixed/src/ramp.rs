//! Time and length of a motion at constant acceleration, counted from its slow end.
//!
//! The maps go through both ends of the ramp, with 31 significant bits. With the acceleration instead, rounded to the
//! format, they would miss the far end by half a last digit times half the square of the duration; with the speed at
//! the fast end, by half a last digit times half the duration.

use crate::q::Q;
use crate::scaled::Scaled;
use pcr_core::scalar::AccelerationRamp;

fn scaled<const F: u32>(number: Q<F>) -> Scaled {
    Scaled::new(i64::from(number.to_bits()), -(F as i32))
}

/// Converts a number whose unit is the last digit of the format.
fn rounded<const F: u32>(number: Scaled) -> Q<F> {
    Q::from_bits(number.times(Scaled::new(1, F as i32)).round())
}

/// Mean speed of the ramp minus the speed at its slow end.
fn gain<const F: u32>(ramp: AccelerationRamp<Q<F>>) -> Scaled {
    scaled(ramp.length).over(scaled(ramp.duration)).plus(scaled(ramp.slow).minus())
}

/// L - v T, exact, in squares of the last digit: how far the ramp is from a uniform motion at its slow end. It has 63 bits, as both
/// products have 62 at most; no check of that is left in the code.
fn rest<const F: u32>(ramp: AccelerationRamp<Q<F>>) -> i64 {
    let [length, slow, duration] = [ramp.length, ramp.slow, ramp.duration].map(|number| i64::from(number.to_bits()));
    (length << F).wrapping_sub(slow.wrapping_mul(duration))
}

/// Whether the map is off a line by half a last digit at most: a uniform motion, but for rounding.
fn is_uniform<const F: u32>(ramp: AccelerationRamp<Q<F>>) -> bool {
    rest(ramp).unsigned_abs() <= 2 << F
}

/// `|L - v T| (h/T)² / 4`, to nearest. Cost: a division.
pub(crate) fn bulge<const F: u32>(ramp: AccelerationRamp<Q<F>>, duration: Q<F>) -> Q<F> {
    if is_uniform(ramp) {
        return Q::from_bits(0);
    }
    let part = scaled(duration).over(scaled(ramp.duration));
    let rest = Scaled::new(rest(ramp), -2 * F as i32 - 2).magnitude();
    rounded(rest.times(part).times(part))
}

/// Whether lengths on both differ by a linear function of the time: on the same ramp, or on two that are uniform.
pub(crate) fn alike<const F: u32>(one: AccelerationRamp<Q<F>>, other: AccelerationRamp<Q<F>>) -> bool {
    let ends = |ramp: AccelerationRamp<Q<F>>| (ramp.slow, ramp.duration, ramp.length);
    ends(one) == ends(other) || is_uniform(one) && is_uniform(other)
}

/// `(v + (L/T - v) t/T) t`. Cost: two divisions.
pub(crate) fn length<const F: u32>(ramp: AccelerationRamp<Q<F>>, elapsed: Q<F>) -> Q<F> {
    if elapsed.to_bits() <= 0 {
        return Q::from_bits(0);
    }
    let time = scaled(elapsed);
    let mean = scaled(ramp.slow).plus(gain(ramp).times(time.over(scaled(ramp.duration))));
    rounded(mean.times(time))
}

/// `2 s / (v + √(v² + 4 (L/T - v) s/T))` for a length `s` of `L`. Cost: a root and three divisions.
pub(crate) fn time<const F: u32>(ramp: AccelerationRamp<Q<F>>, length: Q<F>) -> Q<F> {
    if length.to_bits() <= 0 {
        return Q::from_bits(0);
    }
    let (way, slow) = (scaled(length), scaled(ramp.slow));
    let square = slow.times(slow).plus(gain(ramp).times(way.over(scaled(ramp.duration))).times(Scaled::new(4, 0)));
    let twice_mean = if square.is_negative() { slow } else { slow.plus(square.sqrt()) };
    rounded(way.plus(way).over(twice_mean))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Q16;

    fn q(metres: f64) -> Q16 {
        Q16::from_f64(metres).expect("a number")
    }

    fn ramp(slow: f64, fast: f64, duration: f64) -> AccelerationRamp<Q16> {
        // The acceleration is not used.
        let length = q((slow + fast) / 2.0 * duration);
        AccelerationRamp { slow: q(slow), fast: q(fast), acceleration: q(0.0), duration: q(duration), length }
    }

    #[test]
    fn lengths_and_times_are_the_nearest_numbers() {
        for (slow, fast, duration) in [(0.0, 1.5, 3.0), (0.25, 2.0, 7.0), (1.0, 1.0, 5.0), (0.1, 5.0, 40.0)] {
            let ramp = ramp(slow, fast, duration);
            let [v, l, t] = [ramp.slow, ramp.length, ramp.duration].map(Q16::to_f64);
            for eighths in 1..=64 {
                let elapsed = q(duration * f64::from(eighths) / 64.0);
                let e = elapsed.to_f64();
                let exact = (v + (l / t - v) * e / t) * e;
                let off = |found: Q16, exact: f64| (found.to_f64() - exact).abs() * 65_536.0;
                assert!(off(super::length(ramp, elapsed), exact) < 0.51, "{elapsed} of {ramp:?}");
                let way = q(exact);
                let w = way.to_f64();
                let exact = 2.0 * w / (v + (v * v + 4.0 * (l / t - v) * w / t).max(0.0).sqrt());
                assert!(off(time(ramp, way), exact) < 0.52, "{way} of {ramp:?}");
            }
        }
    }

    /// By the acceleration, rounded to the format, it was too small, and contacts were missed.
    #[test]
    fn a_bulge_is_that_of_the_map() {
        for (slow, fast, duration) in [(0.0, 1.5, 3.0), (0.25, 2.0, 7.0), (0.0, 0.004, 800.0), (0.1, 5.0, 40.0)] {
            let ramp = ramp(slow, fast, duration);
            for parts in [1.0, 2.0, 7.0] {
                let part = q(duration / parts);
                let [a, b] = [0.0, part.to_f64()].map(|time| super::length(ramp, q(time)).to_f64());
                let middle = super::length(ramp, q(0.5 * part.to_f64())).to_f64();
                let off = (0.5 * (a + b) - middle).abs();
                assert!((bulge(ramp, part).to_f64() - off).abs() * 65_536.0 < 1.6, "{ramp:?} {parts}");
            }
            assert!(alike(ramp, ramp));
        }
        let [even, fast] = [ramp(1.0, 1.0, 5.0), ramp(3.0, 3.0, 7.0)];
        assert!(bulge(even, even.duration) == q(0.0) && alike(even, fast) && !alike(even, ramp(1.0, 1.001, 5.0)));
    }

    #[test]
    fn nothing_is_before_a_ramp() {
        for slow in [0.0, 0.5] {
            let ramp = ramp(slow, 2.0, 4.0);
            for metres in [0.0, -1.0] {
                assert_eq!([super::length(ramp, q(metres)), time(ramp, q(metres))], [q(0.0); 2]);
            }
        }
    }

    /// The length is rounded down, so that the mean speed is below that of the slow end.
    #[test]
    fn a_ramp_that_falls_by_rounding_has_an_end() {
        let digit = Q16::LAST_DIGIT.to_f64();
        let falling = AccelerationRamp { length: q(1.0 - digit), ..ramp(1.0, 1.0, 1.0) };
        assert_eq!(time(falling, falling.length), falling.duration);
        let stopping = AccelerationRamp { length: Q16::LAST_DIGIT, ..ramp(1.0, 1.0, 1.0) };
        // v² + 4 (L/T - v) s/T is below 0 and counts as 0; the result is that of a constant speed of v/2.
        assert_eq!(time(stopping, q(0.5)), q(1.0));
    }
}
