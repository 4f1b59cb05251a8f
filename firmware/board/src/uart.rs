//! The serial line of each machine, polled.

#[cfg(all(target_arch = "arm", armv6m))]
mod nrf51 {
    //! UART of the nRF51 (micro:bit): reference manual 3.0, chapter 29.
    const BASE: usize = 0x4000_2000;
    const START_RX: usize = 0x000;
    const START_TX: usize = 0x008;
    const RX_READY: usize = 0x108;
    const TX_READY: usize = 0x11C;
    const ENABLE: usize = 0x500;
    const RXD: usize = 0x518;
    const TXD: usize = 0x51C;
    const BAUD: usize = 0x524;

    pub(super) fn start() {
        super::write(BASE + BAUD, 0x01D7_E000); // 115200
        super::write(BASE + ENABLE, 4);
        super::write(BASE + START_TX, 1);
        super::write(BASE + START_RX, 1);
    }

    pub(super) fn read() -> u8 {
        while super::read(BASE + RX_READY) == 0 {}
        super::write(BASE + RX_READY, 0);
        super::read(BASE + RXD) as u8
    }

    pub(super) fn write(byte: u8) {
        super::write(BASE + TX_READY, 0);
        super::write(BASE + TXD, u32::from(byte));
        while super::read(BASE + TX_READY) == 0 {}
    }
}

#[cfg(all(target_arch = "arm", armv6m))]
use nrf51 as line;

#[cfg(feature = "stm32f405")]
mod stm32 {
    //! USART 1 of the STM32F405: reference manual RM0090, section 30.6. Clocks are as QEMU has them: on a board the USART and its pins
    //! are switched on first, and the divider follows from their clock (`firmware/examples/stm32f4`).
    const BASE: usize = 0x4001_1000;
    const STATUS: usize = 0x0;
    const DATA: usize = 0x4;
    const DIVIDER: usize = 0x8;
    const CONTROL: usize = 0xC;

    pub(super) fn start() {
        super::write(BASE + DIVIDER, 0x2D9); // 115200 at 84 MHz
        super::write(BASE + CONTROL, 1 << 13 | 1 << 3 | 1 << 2);
    }

    pub(super) fn read() -> u8 {
        while super::read(BASE + STATUS) & 1 << 5 == 0 {}
        super::read(BASE + DATA) as u8
    }

    pub(super) fn write(byte: u8) {
        while super::read(BASE + STATUS) & 1 << 7 == 0 {}
        super::write(BASE + DATA, u32::from(byte));
    }
}
#[cfg(feature = "stm32f405")]
use stm32 as line;

#[cfg(all(target_arch = "arm", not(armv6m), not(feature = "stm32f405")))]
mod cmsdk {
    //! UART 0 of ARM's MPS2 boards: Cortex-M System Design Kit, DDI 0479, section 4.3. On the AN505 it is a secure peripheral.
    const BASE: usize = if cfg!(armv8m) { 0x5020_0000 } else { 0x4000_4000 };
    const DATA: usize = 0x0;
    const STATE: usize = 0x4;
    const CONTROL: usize = 0x8;
    const DIVIDER: usize = 0x10;

    pub(super) fn start() {
        super::write(BASE + DIVIDER, 217); // 115200 at 25 MHz
        super::write(BASE + CONTROL, 3);
    }

    pub(super) fn read() -> u8 {
        while super::read(BASE + STATE) & 2 == 0 {}
        super::read(BASE + DATA) as u8
    }

    pub(super) fn write(byte: u8) {
        while super::read(BASE + STATE) & 1 != 0 {}
        super::write(BASE + DATA, u32::from(byte));
    }
}
#[cfg(all(target_arch = "arm", not(armv6m), not(feature = "stm32f405")))]
use cmsdk as line;

#[cfg(target_arch = "riscv32")]
mod ns16550 {
    //! The 16550 of QEMU's machine `virt`.
    const BASE: usize = 0x1000_0000;
    const DATA: usize = 0;
    const STATUS: usize = 5;

    fn at(register: usize) -> *mut u8 {
        (BASE + register) as *mut u8
    }

    pub(super) fn start() {}

    pub(super) fn read() -> u8 {
        // SAFETY: registers of the UART, which nothing else uses.
        unsafe {
            while at(STATUS).read_volatile() & 0x01 == 0 {}
            at(DATA).read_volatile()
        }
    }

    pub(super) fn write(byte: u8) {
        // SAFETY: as above.
        unsafe {
            while at(STATUS).read_volatile() & 0x20 == 0 {}
            at(DATA).write_volatile(byte);
        }
    }
}
#[cfg(target_arch = "riscv32")]
use ns16550 as line;

#[cfg(target_arch = "arm")]
fn read(register: usize) -> u32 {
    // SAFETY: addresses of this file: registers of the UART, which nothing else uses.
    unsafe { (register as *mut u32).read_volatile() }
}

#[cfg(target_arch = "arm")]
fn write(register: usize, value: u32) {
    // SAFETY: as above.
    unsafe { (register as *mut u32).write_volatile(value) }
}

/// The serial line, 115200 baud, 8N1.
#[derive(Debug)]
pub struct Uart(());

impl Uart {
    /// Switches it on.
    pub fn start() -> Self {
        line::start();
        Self(())
    }

    /// Waits for a byte.
    pub fn read(&mut self) -> u8 {
        line::read()
    }

    /// Sends bytes.
    pub fn write(&mut self, bytes: &[u8]) {
        bytes.iter().for_each(|&byte| line::write(byte));
    }
}
