//! Fixed-point number types for [`pcr_core`], for microcontrollers without a floating-point unit.
//!
//! Nothing yet: the types come with their error bounds in a later version. The crate is here so that the dependency
//! on `pcr-core` without its float features keeps building.
#![no_std]

/// The contract that every number type of this crate is to fulfil.
pub use pcr_core::Scalar;
