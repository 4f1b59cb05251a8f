//! What the programs for the boards share: the number format of the build, the panic handler that cannot be linked,
//! the clock that counts instructions, and the paths of searches for the worst case.
#![no_std]

pub mod courses;
pub mod meter;
pub mod out;
pub mod uart;

// They bring the critical sections that compare-and-swap stands on where the core has none.
#[cfg(target_arch = "arm")]
use cortex_m as _;
#[cfg(target_arch = "riscv32")]
use riscv as _;

#[cfg(target_arch = "arm")]
pub use cortex_m_rt::entry;
#[cfg(target_arch = "riscv32")]
pub use riscv_rt::entry;

/// The number format of this build, and the fleet in it.
#[cfg(feature = "f32")]
pub use pcr_supervisor::scenario::float::{AGENTS, Number};
#[cfg(feature = "micro")]
pub use pcr_supervisor::scenario::micro::{AGENTS, Number};
#[cfg(feature = "q12")]
pub use pcr_supervisor::scenario::q12::{AGENTS, Number};
#[cfg(feature = "q16")]
pub use pcr_supervisor::scenario::q16::{AGENTS, Number};
#[cfg(feature = "q20")]
pub use pcr_supervisor::scenario::q20::{AGENTS, Number};

#[cfg(not(feature = "who-panics"))]
unsafe extern "C" {
    #[link_name = "ERROR: the program can panic"]
    fn can_panic() -> !;
}

/// The function that a panic calls is not defined: a program that can panic is not linked.
#[cfg(not(feature = "who-panics"))]
#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    // SAFETY: no linked program has this call.
    unsafe { can_panic() }
}

/// With this one it is linked, and `who-panics.sh` finds where.
#[cfg(feature = "who-panics")]
#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    semihosting::process::exit(101)
}
