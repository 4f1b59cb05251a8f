//! When two driven discs are in contact, by the definition.

use super::line::{Intervals, below};
use super::{Pair, Travel};
use crate::disc::{Disc, Drive};

/// A disc, how it is driven, and when it sets off.
pub type Driven = (Disc, Drive, f64);

/// What is known of the times at which two discs are in contact, or within `margin` of it, if they set off at `starts`.
pub fn contacts(a: &Driven, b: &Driven, starts: [f64; 2], during: [f64; 2], margin: f64) -> Intervals {
    let pair = Pair::new(&a.0, &b.0);
    let travels =
        [(a, starts[0]), (b, starts[1])].map(|(driven, start)| Travel::new(&driven.1, driven.0.length(), start));
    let speed = a.1.top_speed() + b.1.top_speed() + 1e-3;
    let clearance = |x: f64| pair.clearance(travels[1].length_at(x / speed), travels[0].length_at(x / speed));
    below(clearance, during[0] * speed, during[1] * speed, margin, 1e-9)
}
