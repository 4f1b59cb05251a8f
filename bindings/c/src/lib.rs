//! C interface of [`pcr_core`]: plain C types, the caller's memory, error codes. In three number formats, made of one source.
//!
//! | header | numbers | names | |
//! |---|---|---|---|
//! | `pcr.h` | `float` | `PcrFleet`, `pcr_fleet_...` | [`single`] |
//! | `pcr_f64.h` | `double` | `PcrF64Fleet`, `pcr_f64_fleet_...` | [`double`] |
//! | `pcr_q16.h` | `int32_t`, 1/65536 m, s, m/s, m/s² | `PcrQ16Fleet`, `pcr_q16_fleet_...` | [`fixed`] |
//!
//! The headers are made from this crate; `c/crossing.c` is a program to begin with. In short:
//!
//! ```c
//! static PcrSegment segments[16]; static PcrPhase phases[12]; static PcrMotion motions[4];
//! static PcrEntry entries[16]; static PcrPiece pieces[32]; static PcrFleet fleet;
//!
//! PcrMemory memory = { segments, 16, phases, 12, motions, 4, entries, 16, pieces, 32, NULL, 0, NULL }; /* no orders */
//! pcr_fleet_init(&fleet, &memory);
//! pcr_fleet_add(&fleet, &agent);              /* as often as there are agents */
//! pcr_fleet_build(&fleet);                    /* all regions of all pairs */
//! pcr_fleet_regions(&fleet, 0, regions, 8, &count);
//! ```
//!
//! What resolves conflicts is in `c/resolve.c`: `pcr_fleet_first_conflict`, `pcr_fleet_earliest_start`,
//! `pcr_fleet_safe_intervals`, `pcr_fleet_plan_delays`, `pcr_fleet_replace`, `pcr_fleet_remove`. Passing orders, kept whatever the
//! delays, are in `c/passing.c`: `pcr_fleet_orders_as_planned`, `pcr_fleet_admit`, `pcr_fleet_report`, `pcr_fleet_hold`,
//! `pcr_fleet_check`. After an agent was added, what asks the table is refused until `pcr_fleet_build`
//! (`PCR_STATUS_NOT_BUILT`).
//!
//! Nothing is allocated, nothing panics (on a microcontroller the link fails if anything could), and a call that fails
//! leaves the fleet as it was.
//!
//! # What the caller promises
//! Pointers are null, which is an error that is told, or point to as many values as is said; the memory of
//! [`PcrMemory`](single::PcrMemory) belongs to the fleet from `pcr_fleet_init` on, for as long as it is used; all other pointers
//! are used during the call only. A fleet is used by one thread at a time, only after `pcr_fleet_init` has succeeded on it,
//! and is not moved or copied.
#![cfg_attr(target_os = "none", no_std)]

mod memory;
mod status;

pub mod double;
pub mod fixed;
pub mod single;

pub use status::*;

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
