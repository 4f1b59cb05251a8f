//! The number formats that a command can compute in.

use clap::ValueEnum;

#[derive(Clone, Copy, ValueEnum)]
pub(super) enum Number {
    F64,
    F32,
    #[cfg(feature = "micromath")]
    Micro,
    Q16,
    Q20,
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
            #[cfg(feature = "micromath")]
            Number::Micro => {
                type $scalar = pcr_core::scalar::Micro;
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
