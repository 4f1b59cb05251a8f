//! Scenarios in [`Micro`], for the tests of that number type.

use super::HostScalar;
use pcr_core::Radians;
use pcr_core::scalar::Micro;

impl HostScalar for Micro {
    const NAME: &'static str = "micro";
    const HEADING_LIMIT: f64 = f32::HEADING_LIMIT;
    const EPSILON: f64 = f32::EPSILON as f64;
    fn from_f64(value: f64) -> Self {
        Self(f32::from_f64(value))
    }
    fn to_f64(self) -> f64 {
        self.0.to_f64()
    }
    fn angle(radians: f64) -> Option<Radians<Self>> {
        f32::angle(radians).map(|angle| Radians(Self(angle.0)))
    }
    fn radians(angle: Radians<Self>) -> f64 {
        angle.0.to_f64()
    }
}
