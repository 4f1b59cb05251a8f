//! The interface in `f32`: `include/pcr.h`.

macro_rules! name {
    ($name:literal) => {
        concat!("pcr_", $name)
    };
}

/// Conversion between numbers of C and numbers of the library.
mod number {
    use pcr_core::Radians;

    pub(crate) type S = f32;
    pub(crate) type Real = f32;
    pub(crate) type Heading = f32;

    pub(crate) const SEGMENT: usize = 33;
    pub(crate) const MOTION: usize = 18;
    pub(crate) const PIECE: usize = 7;

    pub(crate) const HALF_TURN: Heading = core::f32::consts::PI;

    pub(crate) const fn inner(real: Real) -> S {
        real
    }

    pub(crate) const fn plain(number: S) -> Real {
        number
    }

    pub(crate) const fn angle(heading: Heading) -> Radians<f32> {
        Radians(heading)
    }

    pub(crate) const ZERO: Real = 0.0;
}

#[path = "format/mod.rs"]
mod format;

pub use format::*;
