//! What plans and orders need, in `f64`: a desktop plans in no other format.
//!
//! Regions are given as a slice, where the core takes any iterator: so there is one search for speeds, not one for each way to choose
//! regions.

use crate::HostEcm;
use pcr_core::{
    Drive, Full, Interval, Met, Mismatch, Motion, NoSpeedPlan, Order, Orders, Piece, Profile, Region, RegionRef,
    SpeedPlan, Station, Unsolved,
};
use std::slice::IterMut;

/// A table of passing orders on the heap.
pub type HostOrders = Orders<f64, Vec<Region>, Vec<Piece<f64>>, Vec<Order<f64>>>;

/// Largest number of phases of a planned profile.
pub const PHASES: usize = 128;

/// A planned profile.
pub type Speeds = Profile<f64, PHASES>;

/// The regions that an agent avoids.
pub type Regions<'r, 'a> = &'r [RegionRef<'a, f64>];

/// [`Orders::grown`].
///
/// # Errors
/// Its errors.
pub fn orders(fleet: &[Motion<'_, f64>]) -> Result<HostOrders, Full> {
    Orders::grown(fleet)
}

/// [`RegionRef::forbidden_delays`].
pub fn forbidden_delays(region: &RegionRef<'_, f64>) -> Interval<f64> {
    region.forbidden_delays()
}

/// [`RegionRef::passing_delays`].
pub fn passing_delays(region: &RegionRef<'_, f64>) -> Interval<f64> {
    region.passing_delays()
}

/// [`pcr_core::earliest_start`].
pub fn earliest_start(regions: Regions<'_, '_>, from: f64) -> Option<f64> {
    pcr_core::earliest_start(regions.iter().cloned(), from)
}

/// [`pcr_core::first_overlap`].
///
/// # Errors
/// Its errors.
pub fn first_overlap(
    ego: &Motion<'_, f64>,
    regions: Regions<'_, '_>,
    during: Interval<f64>,
) -> Result<Option<Met<f64>>, Mismatch> {
    pcr_core::first_overlap(ego, regions.iter().cloned(), during)
}

/// [`pcr_core::plan_speed`].
///
/// # Errors
/// Its errors.
pub fn plan_speed(
    ego: &Motion<'_, f64>,
    drive: Drive<f64>,
    regions: Regions<'_, '_>,
    stations: &mut [Station<f64>],
) -> Result<SpeedPlan<f64, PHASES>, NoSpeedPlan<f64>> {
    pcr_core::plan_speed(ego, drive, regions.iter().cloned(), &[], stations)
}

/// [`pcr_core::plan_speed_below`].
///
/// # Errors
/// Its errors.
pub fn plan_speed_below(
    ego: &Motion<'_, f64>,
    regions: Regions<'_, '_>,
    stations: &mut [Station<f64>],
) -> Result<SpeedPlan<f64, PHASES>, NoSpeedPlan<f64>> {
    pcr_core::plan_speed_below(ego, regions.iter().cloned(), &[], stations)
}

/// [`pcr_core::plan_speeds`].
///
/// # Errors
/// Its errors.
pub fn plan_speeds<'m>(
    ecm: &HostEcm<f64>,
    fleet: &[Motion<'m, f64>],
    plan: &mut [Motion<'m, f64>],
    order: &mut [usize],
    profiles: &mut IterMut<'m, Speeds>,
    stations: &mut [Station<f64>],
) -> Result<(), Unsolved> {
    pcr_core::plan_speeds(ecm, fleet, plan, order, profiles, stations)
}
