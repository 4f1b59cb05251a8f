//! The supervisor of a fleet on an ESP32-C3, in fixed point, with esp-hal: UART 0 at 115200 baud on GPIO20 and GPIO21.
//!
//! The line is polled: whoever plans asks one thing at a time, and what comes while a request is done fits into the 128 bytes of the
//! UART, or is asked again.
#![no_std]
#![no_main]

use esp_hal::Blocking;
use esp_hal::peripherals::TIMG0;
use esp_hal::time::Duration;
use esp_hal::timer::timg::{MwdtStage, TimerGroup, Wdt};
use esp_hal::uart::{Config, Uart};
use example_fleet::{Line, WATCHDOG_MS, supervisor};

// Without this description the boot loader does not start the program.
esp_bootloader_esp_idf::esp_app_desc!();

/// The way out.
struct Port {
    uart: Uart<'static, Blocking>,
    watchdog: Wdt<TIMG0<'static>>,
}

impl Line for Port {
    fn send(&mut self, frame: &[u8]) {
        let mut rest = frame;
        while let (false, Ok(written)) = (rest.is_empty(), self.uart.write(rest)) {
            rest = &rest[written..];
            self.watchdog.feed();
        }
    }

    fn pause(&mut self) {
        self.watchdog.feed();
    }
}

#[esp_hal::main]
fn main() -> ! {
    let board = esp_hal::init(esp_hal::Config::default());
    let uart = Uart::new(board.UART0, Config::default().with_baudrate(115_200));
    let uart = defmt::unwrap!(uart.ok()).with_rx(board.GPIO20).with_tx(board.GPIO21);
    let mut watchdog = TimerGroup::new(board.TIMG0).wdt;
    watchdog.set_timeout(MwdtStage::Stage0, Duration::from_millis(WATCHDOG_MS.into()));
    watchdog.enable();
    let (mut port, supervisor) = (Port { uart, watchdog }, supervisor());
    loop {
        port.pause();
        let mut bytes = [0; 128];
        // Bytes that were damaged are missing in their frame, which is then asked for again.
        let count = port.uart.read_buffered(&mut bytes).unwrap_or(0);
        bytes.iter().take(count).for_each(|&byte| supervisor.take(byte, &mut port));
    }
}
