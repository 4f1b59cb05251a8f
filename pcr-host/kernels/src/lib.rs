//! The functions of `pcr-core` that a desktop spends its time in.
//!
//! A generic function is compiled in the crate that calls it. These are called here, so that they are compiled once for each number
//! format, and for speed. The crates that call these are compiled for their size, and take little longer.

#[cfg(feature = "micromath")]
use pcr_core::scalar::Micro;
use pcr_core::{
    Approach, Conflict, Ecm, Encounter, Full, Interval, Motion, Order, Orders, Piece, Region, RegionRef, Scalar,
    TableError,
};
use pcr_fixed::{Q12, Q16, Q20};

/// A table on the heap.
pub type HostEcm<S> = Ecm<S, Vec<Region>, Vec<Piece<S>>>;

/// A table of passing orders on the heap.
pub type HostOrders<S> = Orders<S, Vec<Region>, Vec<Piece<S>>, Vec<Order<S>>>;

/// The functions of a number format.
pub trait Kernels: Scalar {
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

    /// Passes on [`Encounter::conflicts`].
    fn conflicts(encounter: &Encounter<'_, Self>, during: Interval<Self>, each: &mut dyn FnMut(Conflict<Self>));

    /// [`Encounter::closest`].
    fn closest(encounter: &Encounter<'_, Self>, during: Interval<Self>) -> Approach<Self>;

    /// [`RegionRef::forbidden_delays`].
    fn forbidden_delays(region: &RegionRef<'_, Self>) -> Interval<Self>;

    /// [`RegionRef::passing_delays`].
    fn passing_delays(region: &RegionRef<'_, Self>) -> Interval<Self>;
}

macro_rules! kernels {
    ($($(#[$attribute:meta])* $format:ty),+) => {
        $($(#[$attribute])*
        impl Kernels for $format {
            fn table(fleet: &[Motion<'_, Self>]) -> Result<HostEcm<Self>, Full> {
                Ecm::grown(fleet)
            }
            fn orders(fleet: &[Motion<'_, Self>]) -> Result<HostOrders<Self>, Full> {
                Orders::grown(fleet)
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
            fn forbidden_delays(region: &RegionRef<'_, Self>) -> Interval<Self> {
                region.forbidden_delays()
            }
            fn passing_delays(region: &RegionRef<'_, Self>) -> Interval<Self> {
                region.passing_delays()
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
