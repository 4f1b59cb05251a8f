//! C interface of [`pcr_core`] in `f32`: plain C types, the caller's memory, error codes.
//!
//! The header `include/pcr.h` is made from this crate; `c/crossing.c` is a program that uses it. In short:
//!
//! ```c
//! static PcrSegment segments[16]; static PcrPhase phases[12]; static PcrMotion motions[4];
//! static PcrEntry entries[16]; static PcrPiece pieces[32]; static PcrFleet fleet;
//!
//! PcrMemory memory = { segments, 16, phases, 12, motions, 4, entries, 16, pieces, 32 };
//! pcr_fleet_init(&fleet, &memory);
//! pcr_fleet_add(&fleet, &agent);              /* as often as there are agents */
//! pcr_fleet_build(&fleet);                    /* all regions of all pairs */
//! pcr_fleet_regions(&fleet, 0, regions, 8, &count);
//! ```
//!
//! What resolves conflicts is in `c/resolve.c`: `pcr_fleet_first_conflict`, `pcr_fleet_earliest_start`,
//! `pcr_fleet_safe_intervals`, `pcr_fleet_plan_delays`, `pcr_fleet_replace`. After an agent was added, what asks the table is
//! refused until `pcr_fleet_build` (`PCR_STATUS_NOT_BUILT`).
//!
//! Nothing is allocated, nothing panics (on a microcontroller the link fails if anything could), and a call that fails
//! leaves the fleet as it was.
//!
//! # What the caller promises
//! Pointers are null, which is an error that is told, or point to as many values as is said; the memory of
//! [`PcrMemory`] belongs to the fleet for good from `pcr_fleet_init` on; a fleet is used by one thread at a time, only
//! after `pcr_fleet_init` has succeeded on it, and is not moved or copied.
#![cfg_attr(target_os = "none", no_std)]

mod api;
mod fleet;
mod memory;
mod types;

pub use api::*;
pub use types::*;

/// A panic is an undefined symbol: a program links only if none can be reached.
#[cfg(target_os = "none")]
#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    unsafe extern "C" {
        #[link_name = "pcr: a panic can be reached"]
        fn a_panic_can_be_reached() -> !;
    }
    // SAFETY: it does not exist, so that nothing that calls it is ever run.
    unsafe { a_panic_can_be_reached() }
}
