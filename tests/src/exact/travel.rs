//! Travelled length over time and its inverse, for the phases of a motion taken as exact numbers.
//!
//! A phase says more than it has to: times, lengths and speeds at both of its ends, which rounding keeps from agreeing
//! to the last digit. The motion is the one at constant acceleration that has the speed of the slow end there, and the
//! times and lengths at both: it has no gaps.

use super::DoubleDouble;
use pcr_core::Motion;
use pcr_planning::fleet::HostScalar;

/// A motion along a path.
#[derive(Clone, Debug)]
pub struct Travel {
    start: DoubleDouble,
    end: DoubleDouble,
    phases: Vec<Phase>,
}

#[derive(Clone, Copy, Debug)]
struct Phase {
    time: [DoubleDouble; 2],
    length: [DoubleDouble; 2],
    /// At the slow end.
    speed: DoubleDouble,
    /// Away from the slow end.
    acceleration: DoubleDouble,
    /// Index of the slow end.
    slow: usize,
}

impl Phase {
    fn length_at(&self, time: DoubleDouble) -> DoubleDouble {
        let elapsed = (time - self.time[self.slow]).abs();
        let way = (self.speed + (elapsed * self.acceleration).half()) * elapsed;
        let length = if self.slow == 0 { self.length[0] + way } else { self.length[1] - way };
        length.clamp(self.length[0], self.length[1])
    }

    fn time_at(&self, length: DoubleDouble) -> DoubleDouble {
        let way = (length - self.length[self.slow]).abs();
        let speeds = self.speed + (self.speed * self.speed + way * self.acceleration * 2.0).sqrt();
        let elapsed = if speeds > DoubleDouble::ZERO { way * 2.0 / speeds } else { DoubleDouble::ZERO };
        let time = if self.slow == 0 { self.time[0] + elapsed } else { self.time[1] - elapsed };
        time.clamp(self.time[0], self.time[1])
    }
}

impl Travel {
    /// The travel of a motion whose path has this exact length \[m\].
    pub fn new<S: HostScalar>(motion: &Motion<'_, S>, length: DoubleDouble) -> Self {
        let exact = |value: S| DoubleDouble::from(value.to_f64());
        let phases = motion.profile().phases().iter().map(|phase| {
            let time = [exact(phase.time().lo), exact(phase.time().hi)];
            let length = [exact(phase.length().lo), exact(phase.length().hi)];
            let speed = phase.speed().map(exact);
            let slow = usize::from(speed[1] < speed[0]);
            let (duration, way) = (time[1] - time[0], length[1] - length[0]);
            // L = v T + a T² / 2
            let acceleration = if duration > DoubleDouble::ZERO {
                (way - speed[slow] * duration) * 2.0 / (duration * duration)
            } else {
                DoubleDouble::ZERO
            };
            Phase { time, length, speed: speed[slow], acceleration, slow }
        });
        Self { start: exact(motion.time().lo), end: length, phases: phases.collect() }
    }

    /// Departure and arrival \[s\].
    pub fn time(&self) -> [DoubleDouble; 2] {
        [self.start, self.start + self.phases.last().map_or(DoubleDouble::ZERO, |last| last.time[1])]
    }

    /// Travelled length \[m\] at a time \[s\]; the whole path from the arrival on.
    pub fn length_at(&self, time: DoubleDouble) -> DoubleDouble {
        let elapsed = time - self.start;
        let next = self.phases.partition_point(|phase| phase.time[1] < elapsed);
        match self.phases.get(next) {
            _ if elapsed <= DoubleDouble::ZERO => DoubleDouble::ZERO,
            Some(phase) if elapsed < self.time()[1] - self.start => {
                phase.length_at(elapsed).clamp(DoubleDouble::ZERO, self.end)
            }
            _ => self.end,
        }
    }

    /// The first and the last time \[s\] at which the travelled length is `length` \[m\], within the travel.
    pub fn times_at(&self, length: DoubleDouble) -> [DoubleDouble; 2] {
        let first = self.phases.iter().find(|phase| phase.length[1] >= length);
        let last = self.phases.iter().rfind(|phase| phase.length[0] <= length);
        let [departure, arrival] = self.time();
        let first = match first {
            _ if length <= DoubleDouble::ZERO => departure,
            Some(phase) => self.start + phase.time_at(length.clamp(phase.length[0], phase.length[1])),
            None => arrival,
        };
        let last = match last {
            _ if length >= self.end => arrival,
            Some(phase) if phase.length[1] <= length => self.start + phase.time[1],
            Some(phase) => self.start + phase.time_at(length),
            None => departure,
        };
        [first, last]
    }
}
