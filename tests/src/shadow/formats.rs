//! The formats that have a shadow: all.

use super::{Enclosure, Shadowed};
use pcr_certify::raw::RawAngle;
use pcr_core::Scalar;
use pcr_core::scalar::Micro;
use pcr_fixed::{Q12, Q16, Q20};
use pcr_planning::fleet::HostScalar;

macro_rules! impl_shadowed {
    ($t:ty) => {
        impl Shadowed for $t {
            type S = $t;
            fn number(value: $t) -> f64 {
                HostScalar::to_f64(value)
            }
            fn angle(value: <$t as Scalar>::Angle) -> Enclosure {
                match <$t as HostScalar>::held_angle(value) {
                    RawAngle::Radians(angle) => Enclosure::at(angle),
                    RawAngle::Turns(turns) => Enclosure::TURN * Enclosure::at(turns),
                }
            }
        }
    };
}

impl_shadowed!(f64);
impl_shadowed!(f32);
impl_shadowed!(Micro);
impl_shadowed!(Q20);
impl_shadowed!(Q16);
impl_shadowed!(Q12);
