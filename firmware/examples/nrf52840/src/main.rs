//! The supervisor of a fleet on an nRF52840 (nRF52840-DK), with Embassy: UART 0 at 115200 baud on P0.08 and P0.06.
//!
//! The driver receives and sends by interrupt and DMA. Requests are done in the main task; what else the robot has to do while one
//! takes long belongs into an interrupt executor.
#![no_std]
#![no_main]

use cortex_m as _;
use embassy_executor::Spawner;
use embassy_nrf::buffered_uarte::{BufferedUarte, BufferedUarteTx, InterruptHandler};
use embassy_nrf::uarte::{Baudrate, Config};
use embassy_nrf::wdt::{self, Watchdog, WatchdogHandle};
use embassy_nrf::{bind_interrupts, peripherals};
use example_fleet::{Line, WATCHDOG_MS, supervisor};
use static_cell::ConstStaticCell;

bind_interrupts!(struct Interrupts {
    UARTE0 => InterruptHandler<peripherals::UARTE0>;
});

static RECEIVED: ConstStaticCell<[u8; 512]> = ConstStaticCell::new([0; 512]);
static SENT: ConstStaticCell<[u8; 256]> = ConstStaticCell::new([0; 256]);

/// The way out.
struct Port {
    tx: BufferedUarteTx<'static>,
    watchdog: WatchdogHandle,
}

impl Line for Port {
    fn send(&mut self, frame: &[u8]) {
        let mut rest = frame;
        while !rest.is_empty() {
            // The interrupt makes room.
            let written = defmt::unwrap!(self.tx.try_write(rest).ok());
            rest = &rest[written..];
            self.watchdog.pet();
        }
    }

    fn pause(&mut self) {
        self.watchdog.pet();
    }
}

#[embassy_executor::main]
async fn main(_spawner: Spawner) {
    let board = embassy_nrf::init(Default::default());
    let mut config = Config::default();
    config.baudrate = Baudrate::Baud115200;
    let uart = BufferedUarte::new(
        board.UARTE0,
        board.TIMER0,
        board.PPI_CH0,
        board.PPI_CH1,
        board.PPI_GROUP0,
        board.P0_08,
        board.P0_06,
        Interrupts,
        config,
        RECEIVED.take(),
        SENT.take(),
    );
    let (mut rx, tx) = uart.split();
    let mut config = wdt::Config::default();
    config.timeout_ticks = WATCHDOG_MS * 32_768 / 1000;
    // It stands still while the processor sleeps: waiting for bytes is no fault.
    config.action_during_sleep = wdt::SleepConfig::Pause;
    let (_, [watchdog]) = defmt::unwrap!(Watchdog::try_new(board.WDT, config).ok());
    let (mut port, supervisor) = (Port { tx, watchdog }, supervisor());
    loop {
        port.pause();
        let bytes = defmt::unwrap!(rx.fill_buf().await.ok());
        let count = bytes.len();
        bytes.iter().for_each(|&byte| supervisor.take(byte, &mut port));
        rx.consume(count);
    }
}
