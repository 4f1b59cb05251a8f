//! Instruction counts that are exact and repeatable: QEMU with `-icount shift=7`, 128 ns an instruction.
//!
//! On ARM the SysTick timer runs on that clock, with two ticks an instruction or more, so that rounding gives the
//! count; a loop of known length calibrates it. On RISC-V `minstret` is the count.

use core::cell::Cell;

#[cfg(target_arch = "arm")]
mod clock {
    const CONTROL: *mut u32 = 0xE000_E010 as *mut u32;
    const RELOAD: *mut u32 = 0xE000_E014 as *mut u32;
    const CURRENT: *mut u32 = 0xE000_E018 as *mut u32;

    pub(super) fn start() {
        // SAFETY: registers of the SysTick timer, which nothing else uses.
        unsafe {
            RELOAD.write_volatile(0x00FF_FFFF);
            CURRENT.write_volatile(0);
            CONTROL.write_volatile(5);
        }
    }

    #[inline(always)]
    pub(super) fn now() -> u32 {
        // SAFETY: as above.
        unsafe { CURRENT.read_volatile() }
    }

    /// Whether it has run out since this was asked last.
    #[inline(always)]
    pub(super) fn ran_out() -> bool {
        // SAFETY: as above. To read it clears it.
        unsafe { CONTROL.read_volatile() & (1 << 16) != 0 }
    }

    /// Sets it to its largest count.
    #[inline(always)]
    pub(super) fn wind() {
        // SAFETY: as above. Whatever is written makes it 0, and the next tick the largest.
        unsafe { CURRENT.write_volatile(0) }
    }

    /// It counts down, in 24 bits.
    #[inline(always)]
    pub(super) fn between(from: u32, to: u32) -> u32 {
        from.wrapping_sub(to) & 0x00FF_FFFF
    }

    #[inline(always)]
    pub(super) fn spin(rounds: u32) {
        // SAFETY: counts a register down.
        unsafe {
            core::arch::asm!("2: subs {n}, #1", "bne 2b", n = inout(reg) rounds => _, options(nomem, nostack));
        }
    }
}

#[cfg(target_arch = "riscv32")]
mod clock {
    pub(super) fn start() {}

    #[inline(always)]
    pub(super) fn now() -> u32 {
        let count: u32;
        // SAFETY: reads a counter.
        unsafe { core::arch::asm!("csrr {}, minstret", out(reg) count) }
        count
    }

    pub(super) fn ran_out() -> bool {
        false
    }

    pub(super) fn wind() {}

    #[inline(always)]
    pub(super) fn between(from: u32, to: u32) -> u32 {
        to.wrapping_sub(from)
    }

    #[inline(always)]
    pub(super) fn spin(rounds: u32) {
        // SAFETY: counts a register down.
        unsafe {
            core::arch::asm!("2: addi {n}, {n}, -1", "bnez {n}, 2b", n = inout(reg) rounds => _, options(nomem, nostack));
        }
    }
}

/// Instructions of the calibration. The STM32F405 has 21 ticks an instruction where the others have 3.
const KNOWN: u32 = if cfg!(feature = "stm32f405") { 1 << 19 } else { 1 << 20 };

/// The calibrated clock.
#[derive(Debug)]
pub struct Meter {
    /// Ticks of [`KNOWN`] instructions.
    known: u64,
    /// Ticks of nothing.
    nothing: u32,
}

impl Meter {
    /// Starts the clock and calibrates it.
    pub fn new() -> Self {
        clock::start();
        let (a, b) = (clock::now(), clock::now());
        let nothing = clock::between(a, b);
        let a = clock::now();
        clock::spin(KNOWN / 2);
        let b = clock::now();
        Self { known: u64::from(clock::between(a, b).wrapping_sub(nothing)), nothing }
    }

    /// Instructions of `work`; `u32::MAX` for more than the clock can count, about five million on ARM.
    #[inline(always)]
    pub fn count<R>(&self, work: impl FnOnce() -> R) -> (u32, R) {
        clock::wind();
        let _ = clock::ran_out();
        let from = clock::now();
        let result = work();
        let to = clock::now();
        let count = self.instructions(u64::from(clock::between(from, to).saturating_sub(self.nothing)));
        (if clock::ran_out() { u32::MAX } else { count }, result)
    }

    fn instructions(&self, ticks: u64) -> u32 {
        let scaled = ticks.wrapping_mul(u64::from(KNOWN)).wrapping_add(self.known / 2);
        scaled.checked_div(self.known).unwrap_or(0) as u32
    }

    /// Begins to count work in parts.
    pub fn laps(&self) -> Laps<'_> {
        clock::wind();
        let _ = clock::ran_out();
        let from = Cell::new(clock::now());
        Laps { meter: self, from, ticks: Cell::new(0), longest: Cell::new(0), lost: Cell::new(false) }
    }
}

/// Instructions of work that tells when a part of it is done; only a part must not be longer than the clock can count.
#[derive(Debug)]
pub struct Laps<'a> {
    meter: &'a Meter,
    from: Cell<u32>,
    ticks: Cell<u64>,
    longest: Cell<u32>,
    lost: Cell<bool>,
}

impl Laps<'_> {
    /// A part is done.
    #[inline(always)]
    pub fn lap(&self) {
        let ticks = clock::between(self.from.get(), clock::now());
        self.lost.set(self.lost.get() || clock::ran_out());
        self.ticks.set(self.ticks.get().wrapping_add(u64::from(ticks)));
        self.longest.set(self.longest.get().max(ticks));
        clock::wind();
        let _ = clock::ran_out();
        self.from.set(clock::now());
    }

    /// Instructions of all parts, and of the longest; `u32::MAX` where a part was too long to count.
    pub fn counts(&self) -> [u32; 2] {
        if self.lost.get() {
            return [u32::MAX; 2];
        }
        [self.ticks.get(), u64::from(self.longest.get())].map(|ticks| self.meter.instructions(ticks))
    }
}

impl Default for Meter {
    fn default() -> Self {
        Self::new()
    }
}
