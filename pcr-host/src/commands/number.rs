//! The number formats that a command can compute in.

use clap::ValueEnum;

#[derive(Clone, Copy, ValueEnum)]
pub(super) enum ScalarArg {
    F64,
    F32,
    #[cfg(feature = "micromath")]
    Micro,
    Q16,
    Q20,
    Q12,
}

/// Evaluates an expression with the type `$scalar` of a [`ScalarArg`].
macro_rules! with_scalar {
    ($number:expr, $scalar:ident => $body:expr) => {
        match $number {
            ScalarArg::F64 => {
                type $scalar = f64;
                $body
            }
            ScalarArg::F32 => {
                type $scalar = f32;
                $body
            }
            #[cfg(feature = "micromath")]
            ScalarArg::Micro => {
                type $scalar = pcr_core::scalar::Micro;
                $body
            }
            ScalarArg::Q16 => {
                type $scalar = pcr_fixed::Q16;
                $body
            }
            ScalarArg::Q20 => {
                type $scalar = pcr_fixed::Q20;
                $body
            }
            ScalarArg::Q12 => {
                type $scalar = pcr_fixed::Q12;
                $body
            }
        }
    };
}

pub(super) use with_scalar;
