//! The number formats that a command can compute in.

use clap::ValueEnum;

#[derive(Clone, Copy, ValueEnum)]
pub(super) enum Number {
    /// 64-bit floating point
    F64,
    /// 32-bit floating point, as on a small machine
    F32,
    /// Fixed point in 2⁻¹⁶ (15 µm), ±4096 m and 4096 s
    Q16,
    /// Fixed point in 2⁻²⁰ (1 µm), ±256 m and 256 s
    Q20,
    /// Fixed point in 2⁻¹² (0.24 mm), ±65 km and 18 h
    Q12,
}

/// Evaluates an expression with the type `$scalar` of a [`Number`].
macro_rules! with_scalar {
    ($number:expr, $scalar:ident => $body:expr) => {
        match $number {
            Number::F64 => {
                type $scalar = f64;
                $body
            }
            Number::F32 => {
                type $scalar = f32;
                $body
            }
            Number::Q16 => {
                type $scalar = pcr_fixed::Q16;
                $body
            }
            Number::Q20 => {
                type $scalar = pcr_fixed::Q20;
                $body
            }
            Number::Q12 => {
                type $scalar = pcr_fixed::Q12;
                $body
            }
        }
    };
}

pub(super) use with_scalar;
