//! The supervisor of a fleet on an RP2040 (Raspberry Pi Pico), in fixed point: UART 0 at 115200 baud on GP0 and GP1, a 12 MHz crystal.
//!
//! The line is polled: whoever plans asks one thing at a time, and what comes while a request is done fits into the 32 bytes of the
//! UART, or is asked again. The second core is free, for a controller of motors.
#![no_std]
#![no_main]

use example_fleet::{Line, WATCHDOG_MS, supervisor};
use rp2040_hal::clocks::{Clock, init_clocks_and_plls};
use rp2040_hal::fugit::{MicrosDurationU32, RateExtU32};
use rp2040_hal::gpio::bank0::{Gpio0, Gpio1};
use rp2040_hal::gpio::{FunctionUart, Pin, Pins, PullDown};
use rp2040_hal::uart::{DataBits, Enabled, StopBits, UartConfig, UartPeripheral};
use rp2040_hal::{Sio, Watchdog, pac};

/// Starts the flash memory of a Pico.
#[unsafe(link_section = ".boot2")]
#[used]
static BOOT: [u8; 256] = rp2040_boot2::BOOT_LOADER_W25Q080;

const CRYSTAL_HZ: u32 = 12_000_000;

type Uart =
    UartPeripheral<Enabled, pac::UART0, (Pin<Gpio0, FunctionUart, PullDown>, Pin<Gpio1, FunctionUart, PullDown>)>;

/// The way out.
struct Port {
    uart: Uart,
    watchdog: Watchdog,
}

impl Line for Port {
    fn send(&mut self, frame: &[u8]) {
        self.uart.write_full_blocking(frame);
        self.watchdog.feed();
    }

    fn pause(&mut self) {
        self.watchdog.feed();
    }
}

#[rp2040_hal::entry]
fn main() -> ! {
    let mut board = defmt::unwrap!(pac::Peripherals::take());
    let mut watchdog = Watchdog::new(board.WATCHDOG);
    let clocks = init_clocks_and_plls(
        CRYSTAL_HZ,
        board.XOSC,
        board.CLOCKS,
        board.PLL_SYS,
        board.PLL_USB,
        &mut board.RESETS,
        &mut watchdog,
    );
    let clocks = defmt::unwrap!(clocks.ok());
    let bank = Sio::new(board.SIO).gpio_bank0;
    let pins = Pins::new(board.IO_BANK0, board.PADS_BANK0, bank, &mut board.RESETS);
    let pins = (pins.gpio0.into_function(), pins.gpio1.into_function());
    let config = UartConfig::new(115_200.Hz(), DataBits::Eight, None, StopBits::One);
    let uart = UartPeripheral::new(board.UART0, pins, &mut board.RESETS);
    let uart = defmt::unwrap!(uart.enable(config, clocks.peripheral_clock.freq()).map_err(drop).ok());
    watchdog.start(MicrosDurationU32::millis(WATCHDOG_MS));
    let (mut port, supervisor) = (Port { uart, watchdog }, supervisor());
    loop {
        port.pause();
        let mut bytes = [0; 32];
        // Bytes that were damaged are missing in their frame, which is then asked for again.
        let count = port.uart.read_raw(&mut bytes).unwrap_or(0);
        bytes.iter().take(count).for_each(|&byte| supervisor.take(byte, &mut port));
    }
}
