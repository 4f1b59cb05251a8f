//! The interface in Q16.16: `include/pcr_q16.h`.

macro_rules! name {
    ($name:literal) => {
        concat!("pcr_q16_", $name)
    };
}

/// Conversion between numbers of C and numbers of the library.
mod number {
    use pcr_fixed::{Q16, Turns};

    pub(crate) type S = Q16;
    pub(crate) type Real = i32;
    pub(crate) type Heading = i32;

    pub(crate) const SEGMENT: usize = 33;
    pub(crate) const MOTION: usize = 18;
    pub(crate) const PIECE: usize = 7;

    pub(crate) const HALF_TURN: Heading = i32::MIN;

    pub(crate) const fn inner(real: Real) -> S {
        Q16::from_bits(real)
    }

    pub(crate) const fn plain(number: S) -> Real {
        number.to_bits()
    }

    pub(crate) const fn angle(heading: Heading) -> Turns {
        Turns::from_bits(heading)
    }

    pub(crate) const ZERO: Real = 0;
}

#[path = "format/mod.rs"]
mod format;

pub use format::*;
