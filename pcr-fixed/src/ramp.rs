//! Time and length of a motion at constant acceleration, from its slow end.
//!
//! Through both ends of the ramp, with 31 significant bits: the acceleration itself, with the digits of the format, would
//! miss the far end by half its last digit times half the square of the duration, and the speed at the fast end by half
//! its last digit times half the duration.

use crate::q::Q;
use crate::scaled::Scaled;
use pcr_core::scalar::Ramp;

fn scaled<const F: u32>(number: Q<F>) -> Scaled {
    Scaled::new(i64::from(number.to_bits()), -(F as i32))
}

/// A number whose integer part counts last digits.
fn rounded<const F: u32>(number: Scaled) -> Q<F> {
    Q::from_bits(number.times(Scaled::new(1, F as i32)).round())
}

/// By how much the mean speed of the ramp is above that of its slow end.
fn gain<const F: u32>(ramp: Ramp<Q<F>>) -> Scaled {
    scaled(ramp.length).over(scaled(ramp.duration)).plus(scaled(ramp.slow).minus())
}

/// `(v + (L/T - v) t/T) t`. Two divisions.
pub(crate) fn length<const F: u32>(ramp: Ramp<Q<F>>, elapsed: Q<F>) -> Q<F> {
    if elapsed.to_bits() <= 0 {
        return Q::from_bits(0);
    }
    let time = scaled(elapsed);
    let mean = scaled(ramp.slow).plus(gain(ramp).times(time.over(scaled(ramp.duration))));
    rounded(mean.times(time))
}

/// `2 s / (v + √(v² + 4 (L/T - v) s/T))` for a length `s` of `L`. A root, and three divisions.
pub(crate) fn time<const F: u32>(ramp: Ramp<Q<F>>, length: Q<F>) -> Q<F> {
    if length.to_bits() <= 0 {
        return Q::from_bits(0);
    }
    let (way, slow) = (scaled(length), scaled(ramp.slow));
    let square = slow.times(slow).plus(gain(ramp).times(way.over(scaled(ramp.duration))).times(Scaled::new(4, 0)));
    let twice_mean = if square.is_negative() { slow } else { slow.plus(square.sqrt()) };
    rounded(way.plus(way).over(twice_mean))
}
