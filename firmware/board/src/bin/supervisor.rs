//! The supervisor on a serial line: agents come in as frames, regions go out. `pcr-link serial` is the other end.
#![no_std]
#![no_main]

use pcr_board::uart::Uart;
use pcr_board::{AGENTS, Number, entry};
use pcr_supervisor::Session;
use pcr_supervisor::scenario::{self, PIECES, REGIONS, ROOM};
use static_cell::ConstStaticCell;

static SESSION: ConstStaticCell<Session<Number, { scenario::AGENTS }, ROOM, REGIONS, PIECES>> =
    ConstStaticCell::new(Session::new(&AGENTS));

#[entry]
fn main() -> ! {
    let mut uart = Uart::start();
    if let Some(session) = SESSION.try_take() {
        loop {
            let byte = uart.read();
            session.take(byte, |bytes| uart.write(bytes));
        }
    }
    // The cell is taken once, above.
    loop {}
}
