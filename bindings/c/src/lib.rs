//! C interface of [`pcr_core`]: plain C types, memory of the caller, error codes; in three number formats that are
//! built from one source.
//!
//! | header | numbers | names | |
//! |---|---|---|---|
//! | `pcr.h` | `float` | `PcrFleet`, `pcr_fleet_...` | [`single`] |
//! | `pcr_f64.h` | `double` | `PcrF64Fleet`, `pcr_f64_fleet_...` | [`double`] |
//! | `pcr_q16.h` | `int32_t`, 1/65536 m, s, m/s, m/s² | `PcrQ16Fleet`, `pcr_q16_fleet_...` | [`fixed`] |
//!
//! The headers are generated from this crate; `c/crossing.c` is an example to begin with. In short:
//!
//! ```c
//! static PcrSegmentStorage segments[16]; static PcrPhaseStorage phases[12]; static PcrMotionStorage motions[4];
//! static PcrRegionStorage entries[16]; static PcrPieceStorage pieces[32]; static PcrFleet fleet;
//!
//! PcrMemory memory = { segments, 16, phases, 12, motions, 4, entries, 16, pieces, 32, NULL, 0, NULL }; /* no orders */
//! pcr_fleet_init(&fleet, &memory);
//! pcr_fleet_add(&fleet, &agent);              /* as often as there are agents */
//! pcr_fleet_build(&fleet);                    /* all regions of all pairs */
//! pcr_fleet_regions(&fleet, 0, regions, 8, &count);
//! ```
//!
//! An agent is a disc, or a convex polygon of up to 16 corners, rounded by its radius; it may turn in place and change gear:
//! see `c/trucks.c`. `pcr_status_name` and `pcr_status_text` say what a status means, `pcr_fleet_input_error` which number
//! of an agent was wrong. A fleet that has become too large for its memory goes on in a larger one (`pcr_fleet_move`).
//!
//! `c/resolve.c` shows the functions that resolve conflicts: `pcr_fleet_first_conflict`, `pcr_fleet_earliest_start`,
//! `pcr_fleet_safe_intervals`, `pcr_fleet_plan_delays`, `pcr_fleet_replace`, `pcr_fleet_remove`. `c/passing.c` shows
//! passing orders, which robots keep whatever their delays: `pcr_fleet_orders_as_planned`, `pcr_fleet_admit`,
//! `pcr_fleet_report`, `pcr_fleet_hold`, `pcr_fleet_check`. After an agent was added, functions that read the table
//! return `PCR_STATUS_NOT_BUILT` until `pcr_fleet_build` is called.
//!
//! The library does not allocate and does not panic (on a microcontroller a program fails to link if it could). A call
//! that fails leaves the fleet unchanged, except that a table which became full when it was built is empty.
//!
//! # What the caller promises
//! A pointer is null, which is reported as an error, or points to as many values as the function says. The memory in
//! [`PcrMemory`](single::PcrMemory) belongs to the fleet from `pcr_fleet_init` on, as long as the fleet is used. All
//! other pointers are used during the call only. A fleet is used by one thread at a time, only after `pcr_fleet_init`
//! has succeeded on it, and is not moved or copied.
#![cfg_attr(target_os = "none", no_std)]
// One source for all number formats.
#![allow(clippy::duplicate_mod)]

mod memory;
mod status;

pub mod double;
pub mod fixed;
pub mod single;

pub use status::*;

/// A panic calls an undefined symbol, so a program links only if no panic can be reached.
#[cfg(target_os = "none")]
#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    unsafe extern "C" {
        #[link_name = "pcr: a panic can be reached"]
        fn a_panic_can_be_reached() -> !;
    }
    // SAFETY: the function does not exist, so a program that calls it does not link and never runs.
    unsafe { a_panic_can_be_reached() }
}
