//! The supervisor on a serial line: agents come in as frames, regions go out. `pcr-link serial` is the other end.
#![no_std]
#![no_main]

use pcr_board::uart::Uart;
use pcr_board::{AGENTS, Number, entry};
#[cfg(armv6m)]
use pcr_core::{Ecm, EcmEntry, Piece};
#[cfg(not(armv6m))]
use pcr_supervisor::Traffic;
#[cfg(not(armv6m))]
use pcr_supervisor::scenario::ORDERS;
use pcr_supervisor::scenario::{self, PIECES, REGIONS, ROOM};
#[cfg(armv6m)]
use pcr_supervisor::table::Regions;
use pcr_supervisor::{Service, Session};
use static_cell::ConstStaticCell;

/// With orders; a Cortex-M0 with 16 KiB of RAM has no room for those of 12 agents.
#[cfg(not(armv6m))]
type Table = Traffic<Number, { scenario::AGENTS }, REGIONS, PIECES, ORDERS>;
#[cfg(not(armv6m))]
const TABLE: Table = Traffic::new();
#[cfg(armv6m)]
type Table = Regions<Number, REGIONS, PIECES>;
#[cfg(armv6m)]
const TABLE: Table = Ecm::new([EcmEntry::EMPTY; REGIONS], [Piece::EMPTY; PIECES]);

static SESSION: ConstStaticCell<Session<Number, { scenario::AGENTS }, ROOM, REGIONS, PIECES, Table>> =
    ConstStaticCell::new(Session::of(Service::with(TABLE, &[])));

#[entry]
fn main() -> ! {
    let mut uart = Uart::start();
    if let Some(session) = SESSION.try_take() {
        session.build_in(&AGENTS);
        loop {
            let byte = uart.read();
            session.take(byte, &mut |bytes: &[u8]| uart.write(bytes));
        }
    }
    // The cell is taken once, above.
    loop {}
}
