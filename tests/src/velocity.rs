//! The earliest arrival along a path by a fine dynamic program over time, length and speed.
//!
//! Time goes in steps of h, the acceleration of a step is -a, 0 or a. Speeds are then multiples of a h, lengths
//! of a h² / 2, and every state is exact. A set of lengths for each speed is a row of bits.

use crate::disc::{Disc, Drive};
use crate::oracle::{Pair, Travel};

/// Speeds and lengths of the program.
#[derive(Clone, Copy, Debug)]
pub struct Grid {
    /// Time of a step \[s\].
    pub step: f64,
    /// Largest acceleration \[m/s²\].
    pub acceleration: f64,
    /// Largest speed, in steps of acceleration.
    pub speeds: usize,
    /// Length of the path, in half squares of the step.
    pub lengths: usize,
}

impl Grid {
    fn unit(&self) -> f64 {
        0.5 * self.acceleration * self.step * self.step
    }

    /// Length of the path \[m\].
    pub fn length(&self) -> f64 {
        self.unit() * self.lengths as f64
    }

    /// Largest speed \[m/s\].
    pub fn top_speed(&self) -> f64 {
        self.acceleration * self.step * self.speeds as f64
    }

    /// The earliest arrival at rest from rest at the time 0, free for good, before the time `latest` \[s\].
    pub fn earliest(&self, ego: &Disc, others: &[(Disc, Drive, f64)], latest: f64) -> Option<f64> {
        self.earliest_below(ego, |_| self.top_speed(), others, latest)
    }

    /// The same with a largest speed \[m/s\] for each length \[m\].
    pub fn earliest_below(
        &self,
        ego: &Disc,
        limit: impl Fn(f64) -> f64,
        others: &[(Disc, Drive, f64)],
        latest: f64,
    ) -> Option<f64> {
        let limits: Vec<f64> = (0..=self.lengths).map(|at| limit(at as f64 * self.unit()) + 1e-9).collect();
        let allowed: Vec<Bits> = (0..=self.speeds)
            .map(|speed| {
                let speed = speed as f64 * self.acceleration * self.step;
                let mut allowed = Bits::none(self.lengths);
                limits.iter().enumerate().filter(|(_, limit)| speed <= **limit).for_each(|(at, _)| allowed.set(at));
                allowed
            })
            .collect();
        let pairs: Vec<(Pair, Travel)> = others
            .iter()
            .map(|(disc, drive, start)| (Pair::new(ego, disc), Travel::new(drive, disc.length(), *start)))
            .collect();
        let steps = (latest / self.step) as usize;
        let free: Vec<Bits> = (0..=steps).map(|k| self.free(&pairs, k as f64 * self.step)).collect();
        // From when on the goal is free for good.
        let parked = free.iter().rposition(|free| !free.has(self.lengths)).map_or(0, |last| last + 1);
        let mut reached = vec![Bits::none(self.lengths); self.speeds + 1];
        reached[0].set(0);
        if !free[0].has(0) {
            return None;
        }
        for k in 0..=steps {
            if k >= parked && reached[0].has(self.lengths) {
                return Some(k as f64 * self.step);
            }
            let mut next = vec![Bits::none(self.lengths); self.speeds + 1];
            for (from, lengths) in reached.iter().enumerate() {
                let around = next.iter_mut().enumerate().take(from + 2).skip(from.saturating_sub(1));
                around.for_each(|(to, next)| next.add_shifted(lengths, from + to));
            }
            if let Some(free) = free.get(k + 1) {
                next.iter_mut().for_each(|lengths| lengths.keep(free));
            }
            next.iter_mut().zip(&allowed).for_each(|(lengths, allowed)| lengths.keep(allowed));
            reached = next;
        }
        None
    }

    /// The lengths at which nobody is met at a time.
    fn free(&self, pairs: &[(Pair, Travel)], time: f64) -> Bits {
        let mut free = Bits::all(self.lengths);
        for (pair, travel) in pairs {
            let s = travel.length_at(time);
            let mut at = 0;
            while at <= self.lengths {
                // The clearance changes no faster than the length.
                let clearance = pair.clearance(s, at as f64 * self.unit());
                if clearance <= 0.0 {
                    free.unset(at);
                }
                at += ((clearance.abs() / self.unit()) as usize).max(1) * usize::from(clearance > 0.0)
                    + usize::from(clearance <= 0.0);
            }
        }
        free
    }
}

/// A set of the numbers from 0 to a largest one.
#[derive(Clone)]
struct Bits {
    words: Vec<u64>,
    most: usize,
}

impl Bits {
    fn none(most: usize) -> Self {
        Self { words: vec![0; most / 64 + 1], most }
    }

    fn all(most: usize) -> Self {
        Self { words: vec![!0; most / 64 + 1], most }
    }

    fn has(&self, bit: usize) -> bool {
        self.words[bit / 64] >> (bit % 64) & 1 == 1
    }

    fn set(&mut self, bit: usize) {
        self.words[bit / 64] |= 1 << (bit % 64);
    }

    fn unset(&mut self, bit: usize) {
        self.words[bit / 64] &= !(1 << (bit % 64));
    }

    fn keep(&mut self, other: &Self) {
        self.words.iter_mut().zip(&other.words).for_each(|(word, other)| *word &= other);
    }

    fn add_shifted(&mut self, other: &Self, by: usize) {
        let (words, bits) = (by / 64, by % 64);
        for (k, word) in self.words.iter_mut().enumerate().skip(words) {
            let low = other.words[k - words] << bits;
            let high = if bits > 0 && k > words { other.words[k - words - 1] >> (64 - bits) } else { 0 };
            *word |= low | high;
        }
        // What is beyond the path.
        let last = self.most % 64;
        if last < 63
            && let Some(word) = self.words.last_mut()
        {
            *word &= (1 << (last + 1)) - 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::disc::Leg;

    #[test]
    fn alone_it_takes_the_time_of_the_trapezoid() {
        let grid = Grid { step: 0.05, acceleration: 1.0, speeds: 20, lengths: 3200 };
        let disc = |y| Disc { radius: 0.2, start: [0.0, y, 0.0], legs: vec![Leg::Line(4.0)] };
        let stands = (disc(1.0), Drive::Limits(1.0, 1.0), 0.0);
        assert!((grid.length() - 4.0).abs() < 1e-9 && (grid.top_speed() - 1.0).abs() < 1e-9);
        assert!((grid.earliest(&disc(0.0), &[stands], 9.0).unwrap() - 5.0).abs() < 1e-9);
        // One that comes to rest on the goal.
        assert_eq!(grid.earliest(&disc(0.0), &[(disc(0.1), Drive::Limits(1.0, 1.0), 2.0)], 20.0), None);
    }
}
