//! The functions of `pcr-core` that a desktop spends its time in.
//!
//! A generic function is compiled in the crate that calls it. These are called here, so that they are compiled once for each number
//! format, and for speed. What only plans need is in [`planning`], for `f64`. The crates that call these are compiled for size, which
//! makes the tool little slower.

pub mod planning;

#[cfg(feature = "micromath")]
use pcr_core::scalar::Micro;
use pcr_core::{Approach, Conflict, Ecm, Encounter, Full, Interval, Motion, Piece, Region, Scalar, TableError};
use pcr_fixed::{Q12, Q16, Q20};

/// A table on the heap.
pub type HostEcm<S> = Ecm<S, Vec<Region>, Vec<Piece<S>>>;

/// The functions of a number format.
pub trait Kernels: Scalar {
    /// [`Ecm::grown`].
    ///
    /// # Errors
    /// Its errors.
    fn table(fleet: &[Motion<'_, Self>]) -> Result<HostEcm<Self>, Full>;

    /// [`Ecm::fill_row`].
    ///
    /// # Errors
    /// Its errors.
    fn row(table: &mut HostEcm<Self>, fleet: &[Motion<'_, Self>], ego: usize) -> Result<(), TableError>;

    /// Passes on [`Encounter::conflicts`].
    fn conflicts(encounter: &Encounter<'_, Self>, during: Interval<Self>, each: &mut dyn FnMut(Conflict<Self>));

    /// [`Encounter::closest`].
    fn closest(encounter: &Encounter<'_, Self>, during: Interval<Self>) -> Approach<Self>;
}

macro_rules! kernels {
    ($($(#[$attribute:meta])* $format:ty),+) => {
        $($(#[$attribute])*
        impl Kernels for $format {
            fn table(fleet: &[Motion<'_, Self>]) -> Result<HostEcm<Self>, Full> {
                Ecm::grown(fleet)
            }
            fn row(table: &mut HostEcm<Self>, fleet: &[Motion<'_, Self>], ego: usize) -> Result<(), TableError> {
                table.fill_row(fleet, ego)
            }
            fn conflicts(
                encounter: &Encounter<'_, Self>,
                during: Interval<Self>,
                each: &mut dyn FnMut(Conflict<Self>),
            ) {
                encounter.conflicts(during).for_each(each);
            }
            fn closest(encounter: &Encounter<'_, Self>, during: Interval<Self>) -> Approach<Self> {
                encounter.closest(during)
            }
        })+
    };
}

kernels!(
    f64,
    f32,
    #[cfg(feature = "micromath")]
    Micro,
    Q12,
    Q16,
    Q20
);
