//! Travelled length over time, summed up phase by phase; its inverse by bisection.

use crate::disc::Drive;

/// A motion along a route of known length.
#[derive(Clone, Debug)]
pub struct Travel {
    start: f64,
    speed: f64,
    /// Duration and acceleration.
    phases: Vec<(f64, f64)>,
    length: f64,
}

impl Travel {
    /// The drive over `length` \[m\] from the time `start` \[s\] on.
    pub fn new(drive: &Drive, length: f64, start: f64) -> Self {
        let (speed, phases) = match drive {
            _ if length == 0.0 => (0.0, Vec::new()),
            Drive::Unit => (1.0, vec![(length, 0.0)]),
            Drive::Limits(v, a) if length * a >= v * v => {
                let ramp = v / a;
                (0.0, vec![(ramp, *a), (length / v - ramp, 0.0), (ramp, -a)])
            }
            Drive::Limits(_, a) => {
                let ramp = (length / a).sqrt();
                (0.0, vec![(ramp, *a), (ramp, -a)])
            }
            Drive::Pieces(speed, pieces) => (*speed, pieces.clone()),
        };
        Self { start, speed, phases, length }
    }

    /// Departure and arrival \[s\].
    pub fn time(&self) -> (f64, f64) {
        (self.start, self.start + self.phases.iter().map(|phase| phase.0).sum::<f64>())
    }

    /// Travelled length \[m\] at a time \[s\].
    pub fn length_at(&self, time: f64) -> f64 {
        let (mut rest, mut speed, mut way) = (time - self.start, self.speed, 0.0);
        for &(duration, acceleration) in &self.phases {
            let dt = rest.clamp(0.0, duration);
            way += speed * dt + 0.5 * acceleration * dt * dt;
            speed += acceleration * dt;
            rest -= duration;
        }
        way.clamp(0.0, self.length)
    }

    /// First time \[s\] at which `length` \[m\] is reached.
    pub fn first_time_at(&self, length: f64) -> f64 {
        self.bisect(|way| way >= length)
    }

    /// Last time \[s\] at which `length` \[m\] is not exceeded.
    pub fn last_time_at(&self, length: f64) -> f64 {
        self.bisect(|way| way > length)
    }

    fn bisect(&self, after: impl Fn(f64) -> bool) -> f64 {
        let (mut lo, mut hi) = self.time();
        if after(self.length_at(lo)) {
            return lo;
        }
        if !after(self.length_at(hi)) {
            return hi;
        }
        // Until the two are neighbours.
        while lo < 0.5 * (lo + hi) && 0.5 * (lo + hi) < hi {
            let middle = 0.5 * (lo + hi);
            if after(self.length_at(middle)) { hi = middle } else { lo = middle }
        }
        hi
    }
}
