//! Fixed point as a format of the tool.

use super::{HostScalar, in_angles};
use pcr_certify::raw::RawAngle;
use pcr_fixed::{Q12, Q16, Q20, Turns};

macro_rules! impl_format {
    ($t:ident, $name:literal) => {
        impl HostScalar for $t {
            const NAME: &'static str = $name;
            const HEADING_LIMIT: f64 = f64::INFINITY;
            const EPSILON: f64 = 0.0;
            const STEP: f64 = 1.0 / Self::ONE.to_bits() as f64;
            /// Saturates: what is beyond the format is above its limit, too, and refused by name.
            fn from_f64(value: f64) -> Self {
                let largest = if value < 0.0 { i32::MIN } else { i32::MAX };
                $t::from_f64(value).unwrap_or($t::from_bits(largest))
            }
            fn to_f64(self) -> f64 {
                $t::to_f64(self)
            }
            fn angle(radians: f64) -> Option<Turns> {
                in_angles(radians).and_then(|radians| Turns::from_radians(radians).ok())
            }
            fn radians(angle: Turns) -> f64 {
                angle.to_radians()
            }
            fn held_angle(angle: Turns) -> RawAngle {
                RawAngle::Turns(f64::from(angle.to_bits()) / 4_294_967_296.0)
            }
        }
    };
}

impl_format!(Q12, "q12");
impl_format!(Q16, "q16");
impl_format!(Q20, "q20");
