//! When two driven discs are in contact, by the definition.

use super::line::{Intervals, below, reaches};
use super::{Pair, Travel};
use crate::disc::Driven;

/// Ends of a contact are known within the time in which the discs go this way \[m\].
const TOLERANCE: f64 = 1e-9;

/// Two driven discs over time.
#[derive(Clone, Debug)]
pub struct Meeting {
    /// Their paths.
    pub pair: Pair,
    /// The way of each.
    pub travels: [Travel; 2],
    /// The clearance changes no faster than this \[m/s\].
    pub speed: f64,
}

impl Meeting {
    /// The ego and the other.
    pub fn new(ego: &Driven, other: &Driven) -> Self {
        let travels = [ego, other].map(|(disc, drive, start)| Travel::new(drive, disc.length(), *start));
        let speed = ego.1.top_speed() + other.1.top_speed() + 1e-3;
        Self { pair: Pair::new(&ego.0, &other.0), travels, speed }
    }

    /// How far the discs are from contact at a time \[s\], \[m\]: negative where they overlap.
    pub fn clearance(&self, time: f64) -> f64 {
        self.pair.clearance(self.travels[1].length_at(time), self.travels[0].length_at(time))
    }

    /// Whether they come within `margin` \[m\] of contact at any time of `during` \[s\]: `false` is certain.
    pub fn comes_within(&self, margin: f64, during: [f64; 2]) -> bool {
        let [lo, hi] = during.map(|time| time * self.speed);
        reaches(|way| self.clearance(way / self.speed), lo, hi, margin, TOLERANCE)
    }

    /// When they are in contact for sure, and within `margin` \[m\] of it perhaps \[s\].
    pub fn contacts(&self, during: [f64; 2], margin: f64) -> Intervals {
        let [lo, hi] = during.map(|time| time * self.speed);
        let found = below(|way| self.clearance(way / self.speed), lo, hi, margin, TOLERANCE);
        let in_time = |ways: Vec<(f64, f64)>| {
            ways.into_iter().map(|(begin, end)| (begin / self.speed, end / self.speed)).collect()
        };
        Intervals { inner: in_time(found.inner), outer: in_time(found.outer) }
    }
}
