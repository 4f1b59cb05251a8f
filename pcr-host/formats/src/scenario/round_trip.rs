//! Profiles as they are after they have been written and read.

/// Speed below zero that a profile may reach by the rounding of its numbers, relative to its largest speed (or to
/// 1 m/s if that is more): nine digits, which is what files carry.
const SPEED_TOLERANCE: f64 = 1e-9;

/// A profile whose stops are stops, as they are after it has been written and read.
pub(super) struct RoundTripProfile {
    pub(super) v0: f64,
    pub(super) pieces: Vec<(f64, f64)>,
    pub(super) fastest: f64,
    pub(super) travelled: f64,
    /// Bound on the difference to the length for which the numbers were written.
    pub(super) rounding: f64,
}

impl RoundTripProfile {
    /// From durations and accelerations. Refuses the first that brings the speed below zero: its index, that speed, its acceleration.
    pub(super) fn new(v0: f64, mut pieces: Vec<(f64, f64)>) -> Result<Self, (usize, f64, f64)> {
        let (mut speed, mut fastest, mut travelled) = (v0, v0, 0.0);
        // Each number is off by a rounding when it is written, and each sum and product by one more; at a stop no speed is off.
        let (mut off, mut rounding) = (0.0, 0.0);
        for (index, (duration, accel)) in pieces.iter_mut().enumerate() {
            let reached = speed + *accel * *duration;
            if reached < -SPEED_TOLERANCE * f64::max(1.0, fastest) {
                return Err((index, reached, *accel));
            }
            let after = speed_after(reached, fastest);
            let part = 0.5 * (speed + after) * *duration;
            travelled += part;
            let then = if after == 0.0 { 0.0 } else { off + 4.0 * f64::EPSILON * fastest.max(after) };
            rounding += (off + then) * *duration + 4.0 * f64::EPSILON * (part + travelled);
            off = then;
            // Neither sign of zero is of use.
            *accel += 0.0;
            if *duration == 0.0 {
                *accel = 0.0;
            } else if after != reached {
                *accel = (after - speed) / *duration;
            }
            (speed, fastest) = (after, fastest.max(after));
        }
        Ok(Self { v0, pieces, fastest, travelled, rounding })
    }

    /// Scales it onto a way. A difference that is rounding is kept, so that a written profile is read unchanged.
    pub(super) fn scale_onto(&mut self, way: f64) {
        if self.travelled > 0.0 && (self.travelled - way).abs() > self.rounding {
            let scale = way / self.travelled;
            let pieces = self.pieces.iter().map(|&(duration, accel)| (duration, accel * scale)).collect();
            if let Ok(scaled) = Self::new(self.v0 * scale, pieces) {
                *self = scaled;
            }
        }
    }
}

/// The speed after a piece of a profile: what rounding leaves of a stop is no speed.
pub fn speed_after(speed: f64, fastest: f64) -> f64 {
    /// Some hundred roundings of the largest speed, far below any speed that matters.
    const STOP: f64 = 1e-12;
    if speed < STOP * fastest { 0.0 } else { speed }
}
