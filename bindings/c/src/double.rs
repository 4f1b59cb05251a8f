//! The interface in `f64`: `include/pcr_f64.h`.

macro_rules! name {
    ($name:literal) => {
        concat!("pcr_f64_", $name)
    };
}

/// Conversion between numbers of C and numbers of the library.
mod number {
    use pcr_core::Radians;

    pub(crate) type S = f64;
    pub(crate) type Real = f64;
    pub(crate) type Heading = f64;

    pub(crate) const SEGMENT: usize = 33;
    pub(crate) const MOTION: usize = 17;
    pub(crate) const PIECE: usize = 6;

    pub(crate) const HALF_TURN: Heading = core::f64::consts::PI;

    pub(crate) const fn inner(real: Real) -> S {
        real
    }

    pub(crate) const fn plain(number: S) -> Real {
        number
    }

    pub(crate) const fn angle(heading: Heading) -> Radians<f64> {
        Radians(heading)
    }

    pub(crate) const ZERO: Real = 0.0;
}

#[path = "format/mod.rs"]
mod format;

pub use format::*;
