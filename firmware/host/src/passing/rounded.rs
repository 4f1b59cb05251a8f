//! Numbers of a format from decimals.

use pcr_supervisor::Number;

/// A number of the format, rounded.
pub(crate) trait Rounded: Number {
    /// From a decimal.
    fn from_f64(value: f64) -> Self;
    /// The exact value.
    fn to_f64(self) -> f64;
}

impl Rounded for f32 {
    fn from_f64(value: f64) -> Self {
        value as f32
    }
    fn to_f64(self) -> f64 {
        f64::from(self)
    }
}

impl Rounded for pcr_core::scalar::Micro {
    fn from_f64(value: f64) -> Self {
        Self(value as f32)
    }
    fn to_f64(self) -> f64 {
        f64::from(self.0)
    }
}

impl Rounded for pcr_fixed::Q16 {
    fn from_f64(value: f64) -> Self {
        Self::from_f64(value).expect("a small number")
    }
    fn to_f64(self) -> f64 {
        Self::to_f64(self)
    }
}
