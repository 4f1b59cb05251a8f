//! Number formats of the supervisor.

use pcr_core::Scalar;
use serde::Serialize;
use serde::de::DeserializeOwned;

/// A number format of the supervisor.
pub trait Number: Scalar<Angle: Serialize + DeserializeOwned> + Serialize + DeserializeOwned {
    /// Name in commands and in files of expected output.
    const NAME: &'static str;
    /// One metre, one second.
    const ONE: Self;
    /// The bits of the number, for comparisons between machines.
    fn bits(self) -> u32;
    /// The number with these bits, which may be none that a constructor accepts.
    fn of_bits(bits: u32) -> Self;
    /// The bits of an angle.
    fn angle_bits(angle: Self::Angle) -> u32;
    /// The number in thousandths, rounded to nearest, for output.
    fn thousandths(self) -> i32;
}

#[cfg(feature = "float")]
impl Number for f32 {
    const NAME: &'static str = "f32";
    const ONE: Self = 1.0;
    fn bits(self) -> u32 {
        self.to_bits()
    }
    fn of_bits(bits: u32) -> Self {
        Self::from_bits(bits)
    }
    fn angle_bits(angle: Self::Angle) -> u32 {
        angle.0.bits()
    }
    fn thousandths(self) -> i32 {
        (self * 1000.0 + if self < 0.0 { -0.5 } else { 0.5 }) as i32
    }
}

#[cfg(feature = "micromath")]
impl Number for pcr_core::scalar::Micro {
    const NAME: &'static str = "micro";
    const ONE: Self = Self(1.0);
    fn bits(self) -> u32 {
        self.0.to_bits()
    }
    fn of_bits(bits: u32) -> Self {
        Self(f32::from_bits(bits))
    }
    fn angle_bits(angle: Self::Angle) -> u32 {
        angle.0.bits()
    }
    fn thousandths(self) -> i32 {
        self.0.thousandths()
    }
}

#[cfg(feature = "fixed")]
macro_rules! fixed {
    ($($format:ident, $name:literal, $fraction_bits:literal;)*) => {
        $(impl Number for pcr_fixed::$format {
            const NAME: &'static str = $name;
            const ONE: Self = Self::ONE;
            fn bits(self) -> u32 {
                self.to_bits().cast_unsigned()
            }
            fn of_bits(bits: u32) -> Self {
                Self::from_bits(bits.cast_signed())
            }
            fn angle_bits(angle: Self::Angle) -> u32 {
                angle.to_bits().cast_unsigned()
            }
            fn thousandths(self) -> i32 {
                // Values in a table are far below the millions at which this would wrap.
                let scaled = i64::from(self.to_bits()).wrapping_mul(1000);
                (scaled.wrapping_add(1 << ($fraction_bits - 1)) >> $fraction_bits) as i32
            }
        })*
    };
}

#[cfg(feature = "fixed")]
fixed! {
    Q12, "q12", 12;
    Q16, "q16", 16;
    Q20, "q20", 20;
}
