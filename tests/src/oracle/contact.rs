//! When two driven discs are in contact, by the definition.

use super::line::{Intervals, below, reaches};
use super::{Pair, Travel};
use crate::disc::{Disc, Drive};

/// A disc, how it is driven, and when it sets off.
pub type Driven = (Disc, Drive, f64);

/// Whether two discs come within `margin` \[m\] of contact at any time, if they set off at `starts`: `false` is certain.
pub fn meet(a: &Driven, b: &Driven, starts: [f64; 2], during: [f64; 2], margin: f64) -> bool {
    let (clearance, speed) = clearance(a, b, starts);
    reaches(clearance, during[0] * speed, during[1] * speed, margin, 1e-9)
}

/// What is known of the times at which two discs are in contact, or within `margin` of it, if they set off at `starts`.
pub fn contacts(a: &Driven, b: &Driven, starts: [f64; 2], during: [f64; 2], margin: f64) -> Intervals {
    let (clearance, speed) = clearance(a, b, starts);
    below(clearance, during[0] * speed, during[1] * speed, margin, 1e-9)
}

/// The clearance of two discs over the time multiplied by a speed, than which it does not change faster, and the speed.
fn clearance(a: &Driven, b: &Driven, starts: [f64; 2]) -> (impl Fn(f64) -> f64 + use<>, f64) {
    let pair = Pair::new(&a.0, &b.0);
    let travels =
        [(a, starts[0]), (b, starts[1])].map(|(driven, start)| Travel::new(&driven.1, driven.0.length(), start));
    let speed = a.1.top_speed() + b.1.top_speed() + 1e-3;
    (move |x: f64| pair.clearance(travels[1].length_at(x / speed), travels[0].length_at(x / speed)), speed)
}
