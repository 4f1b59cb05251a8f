//! Tables of `pcr-core` on the heap.
//!
//! A generic function is compiled in the crate that calls it. These are called here, so that they are compiled once for each number
//! format, and for speed: a desktop spends most of its time in them. What is compiled for its size calls them.

#[cfg(feature = "micromath")]
use pcr_core::scalar::Micro;
use pcr_core::{Ecm, Full, Motion, Order, Orders, Piece, Region, Scalar, TableError};
use pcr_fixed::{Q12, Q16, Q20};

/// A table on the heap.
pub type HostEcm<S> = Ecm<S, Vec<Region>, Vec<Piece<S>>>;

/// A table of passing orders on the heap.
pub type HostOrders<S> = Orders<S, Vec<Region>, Vec<Piece<S>>, Vec<Order<S>>>;

/// The number formats that have tables.
pub trait Tables: Scalar {
    /// [`Ecm::grown`].
    ///
    /// # Errors
    /// Its errors.
    fn table(fleet: &[Motion<'_, Self>]) -> Result<HostEcm<Self>, Full>;

    /// [`Orders::grown`].
    ///
    /// # Errors
    /// Its errors.
    fn orders(fleet: &[Motion<'_, Self>]) -> Result<HostOrders<Self>, Full>;

    /// [`Ecm::fill_row`].
    ///
    /// # Errors
    /// Its errors.
    fn row(table: &mut HostEcm<Self>, fleet: &[Motion<'_, Self>], ego: usize) -> Result<(), TableError>;
}

macro_rules! tables {
    ($($(#[$attribute:meta])* $format:ty),+) => {
        $($(#[$attribute])*
        impl Tables for $format {
            fn table(fleet: &[Motion<'_, Self>]) -> Result<HostEcm<Self>, Full> {
                Ecm::grown(fleet)
            }
            fn orders(fleet: &[Motion<'_, Self>]) -> Result<HostOrders<Self>, Full> {
                Orders::grown(fleet)
            }
            fn row(table: &mut HostEcm<Self>, fleet: &[Motion<'_, Self>], ego: usize) -> Result<(), TableError> {
                table.fill_row(fleet, ego)
            }
        })+
    };
}

tables!(
    f64,
    f32,
    #[cfg(feature = "micromath")]
    Micro,
    Q12,
    Q16,
    Q20
);
