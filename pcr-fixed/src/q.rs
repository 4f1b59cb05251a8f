//! The fixed-point number type, and its addition and subtraction.

use core::ops::{Add, Neg, Sub};

/// Fixed-point number of 32 bits, `F` of them after the binary point: a length \[m\], time \[s\], speed \[m/s\] or
/// acceleration \[m/s²\]. `F` is 8 to 24.
///
/// Addition and subtraction overflow like those of integers; the constructors of `pcr-core` prevent that.
///
/// ```compile_fail
/// let _ = pcr_fixed::Q::<32>::from_bits(1) + pcr_fixed::Q::<32>::from_bits(1); // no room for a metre
/// ```
/// ```compile_fail,E0308
/// let _ = pcr_fixed::Q16::from_bits(1) + pcr_fixed::Q20::from_bits(1); // formats do not mix
/// ```
#[derive(Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(transparent))]
pub struct Q<const F: u32>(pub(crate) i32);

/// Last digit 15 µm, arena ±4096 m, times up to 68 min.
pub type Q16 = Q<16>;
/// Last digit 0.95 µm, arena ±256 m, times up to 256 s.
pub type Q20 = Q<20>;
/// Last digit 0.24 mm, arena ±65 km, times up to 18 h.
pub type Q12 = Q<12>;

impl<const F: u32> Q<F> {
    const CHECKED: () = assert!(8 <= F && F <= 24, "8 to 24 fraction bits");

    /// One.
    pub const ONE: Self = Self::from_bits(1 << F);
    /// Smallest positive number.
    pub const LAST_DIGIT: Self = Self::from_bits(1);

    /// The number `bits / 2^F`.
    pub const fn from_bits(bits: i32) -> Self {
        let () = Self::CHECKED;
        Self(bits)
    }

    /// The number times `2^F`.
    pub const fn to_bits(self) -> i32 {
        self.0
    }
}

impl<const F: u32> Add for Q<F> {
    type Output = Self;
    fn add(self, rhs: Self) -> Self {
        Self(self.0 + rhs.0)
    }
}

impl<const F: u32> Sub for Q<F> {
    type Output = Self;
    fn sub(self, rhs: Self) -> Self {
        Self(self.0 - rhs.0)
    }
}

impl<const F: u32> Neg for Q<F> {
    type Output = Self;
    fn neg(self) -> Self {
        Self(-self.0)
    }
}
