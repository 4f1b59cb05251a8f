//! Numbers beside a number.

use pcr_planning::fleet::HostScalar;

/// Next number of the format above `x`, or below it.
pub fn neighbour<S: HostScalar>(x: S, above: bool) -> S {
    let value = x.to_f64();
    let mut step = (value.abs() * f64::EPSILON).max(f64::MIN_POSITIVE.sqrt());
    loop {
        let next = S::from_f64(if above { value + step } else { value - step });
        if next != x {
            return next;
        }
        step *= 2.0;
    }
}
