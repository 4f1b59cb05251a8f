//! The abilities of a robot.

use pcr_formats::import::VehicleTraits;

/// The abilities of a robot.
#[derive(Clone, Copy, Debug)]
pub(super) struct KinematicLimits {
    pub(super) speed: f64,
    pub(super) acceleration: f64,
    rotation: f64,
    rotation_acceleration: f64,
}

impl KinematicLimits {
    /// For robots that only stand.
    pub(super) const NONE: Self = Self { speed: 1.0, acceleration: 1.0, rotation: 1.0, rotation_acceleration: 1.0 };

    pub(super) fn of(vehicle: &VehicleTraits) -> Self {
        let VehicleTraits { speed, acceleration, rotation, rotation_acceleration, .. } = *vehicle;
        Self { speed, acceleration, rotation, rotation_acceleration }
    }

    /// Time of a turn in place from rest to rest \[s\].
    pub(super) fn turn(&self, angle: f64) -> f64 {
        let (angle, ramp) = (angle.abs(), self.rotation / self.rotation_acceleration);
        if angle > self.rotation * ramp {
            angle / self.rotation + ramp
        } else {
            2.0 * (angle / self.rotation_acceleration).sqrt()
        }
    }

    /// Time lost by a stop \[s\].
    pub(super) fn stop(&self) -> f64 {
        self.speed / self.acceleration
    }

    /// Stopping distance from a speed \[m\].
    pub(super) fn braking(&self, speed: f64) -> f64 {
        speed * speed / (2.0 * self.acceleration)
    }
}
