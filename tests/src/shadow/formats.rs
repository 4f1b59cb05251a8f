//! The formats that have a shadow.

use super::Shadowed;
use pcr_core::Scalar;
use pcr_fixed::{Q12, Q16, Q20};
use pcr_planning::fleet::Format;

macro_rules! impl_shadowed {
    ($t:ty) => {
        impl Shadowed for $t {
            type S = $t;
            fn number(value: $t) -> f64 {
                Format::to_f64(value)
            }
            fn angle(value: <$t as Scalar>::Angle) -> f64 {
                <$t as Format>::radians(value)
            }
        }
    };
}

impl_shadowed!(f32);
impl_shadowed!(Q20);
impl_shadowed!(Q16);
impl_shadowed!(Q12);
