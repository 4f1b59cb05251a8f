//! Common code of the examples: capacities of a supervisor, its storage, and the panic handler.
//!
//! `docs/guide/firmware.md` tells how to choose the capacities; these are for the paper's 12 agents, which the request `Load` takes.
#![no_std]

use defmt_rtt as _;
use pcr_supervisor::scenario::{AGENTS, ORDERS, PIECES, REGIONS, ROOM};
use pcr_supervisor::{Service, Session, Traffic};
use static_cell::ConstStaticCell;

#[cfg(feature = "f32")]
use pcr_supervisor::scenario::float::{AGENTS as BUILT_IN, Number};
#[cfg(feature = "q16")]
use pcr_supervisor::scenario::q16::{AGENTS as BUILT_IN, Number};

pub use pcr_supervisor::Line;

/// Table and orders.
pub type Table = Traffic<Number, AGENTS, REGIONS, PIECES, ORDERS>;
/// The supervisor behind the line.
pub type Supervisor = Session<Number, AGENTS, ROOM, REGIONS, PIECES, Table>;

static SUPERVISOR: ConstStaticCell<Supervisor> = ConstStaticCell::new(Session::of(Service::with(Traffic::new(), &[])));

/// The watchdog's time \[ms\]: more than any board here takes from one feeding to the next (`docs/guide/firmware.md`, "The watchdog").
pub const WATCHDOG_MS: u32 = 500;

/// The supervisor, once.
pub fn supervisor() -> &'static mut Supervisor {
    defmt::info!("{} bytes for {} agents, {} regions, {} pieces", size_of::<Supervisor>(), AGENTS, REGIONS, PIECES);
    let supervisor = SUPERVISOR.take();
    supervisor.build_in(&BUILT_IN);
    supervisor
}

/// Only crates of the board can panic. The watchdog is then no longer fed, and restarts the board.
#[panic_handler]
fn panic(info: &core::panic::PanicInfo<'_>) -> ! {
    defmt::error!("{}", defmt::Display2Format(info));
    loop {
        core::hint::spin_loop();
    }
}
