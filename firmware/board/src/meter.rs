//! Instruction counts that are exact and repeatable: QEMU with `-icount shift=7`, 128 ns an instruction.
//!
//! On ARM the SysTick timer runs on that clock, with two ticks an instruction or more, so that rounding gives the
//! count; a loop of known length calibrates it. It has 24 bits, some five million instructions, so an interrupt counts how often it has
//! run out ([`meter_interrupt`](crate::meter_interrupt)): the instructions of that, a dozen each time, belong to the count. On RISC-V
//! `minstret` is the count.

use core::cell::Cell;
#[cfg(target_arch = "arm")]
use portable_atomic::{AtomicU32, Ordering};

/// How often the timer has run out since it was wound.
#[cfg(target_arch = "arm")]
static TURNS: AtomicU32 = AtomicU32::new(0);

/// The timer has run out. [`meter_interrupt`](crate::meter_interrupt) calls it; there is no other interrupt, so that nothing is lost.
#[cfg(target_arch = "arm")]
#[inline(always)]
pub fn turn() {
    TURNS.store(TURNS.load(Ordering::Relaxed).wrapping_add(1), Ordering::Relaxed);
}

/// The interrupt of the timer, for every program that has a [`Meter`]. It is not in this library, because others use the timer themselves.
#[cfg(target_arch = "arm")]
#[macro_export]
macro_rules! meter_interrupt {
    () => {
        #[cortex_m_rt::exception]
        fn SysTick() {
            $crate::meter::turn();
        }
    };
}

/// The counter of this target does not run out.
#[cfg(not(target_arch = "arm"))]
#[macro_export]
macro_rules! meter_interrupt {
    () => {};
}

#[cfg(target_arch = "arm")]
mod clock {
    const CONTROL: *mut u32 = 0xE000_E010 as *mut u32;
    const RELOAD: *mut u32 = 0xE000_E014 as *mut u32;
    const CURRENT: *mut u32 = 0xE000_E018 as *mut u32;

    use super::{Ordering, TURNS};

    pub(super) fn start() {
        // SAFETY: registers of the SysTick timer, which nothing else uses.
        unsafe {
            RELOAD.write_volatile(0x00FF_FFFF);
            CURRENT.write_volatile(0);
            CONTROL.write_volatile(7);
        }
    }

    #[inline(always)]
    pub(super) fn now() -> u32 {
        // SAFETY: as above.
        unsafe { CURRENT.read_volatile() }
    }

    /// Sets it to its largest count: work of less than 2^24 ticks is not interrupted.
    #[inline(always)]
    pub(super) fn wind() {
        // SAFETY: as above. Whatever is written makes it 0, and the next tick the largest.
        unsafe { CURRENT.write_volatile(0) }
        TURNS.store(0, Ordering::Relaxed);
    }

    /// Ticks from one time to another since it was wound. It counts down, in 24 bits.
    // Not inlined: what is measured is compiled as if this were not there.
    #[inline(never)]
    pub(super) fn between(from: u32, to: u32) -> u64 {
        loop {
            let seen = TURNS.load(Ordering::Relaxed);
            let after = now();
            if TURNS.load(Ordering::Relaxed) == seen {
                // It may have run out once more after the work.
                let whole = seen.wrapping_sub(u32::from(after > to));
                return (u64::from(whole) << 24).wrapping_add(from.into()).wrapping_sub(to.into());
            }
        }
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

    pub(super) fn wind() {}

    #[inline(always)]
    pub(super) fn between(from: u32, to: u32) -> u64 {
        to.wrapping_sub(from).into()
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
        clock::wind();
        let (a, b) = (clock::now(), clock::now());
        let nothing = clock::between(a, b) as u32;
        clock::wind();
        let a = clock::now();
        clock::spin(KNOWN / 2);
        let b = clock::now();
        Self { known: clock::between(a, b).saturating_sub(nothing.into()), nothing }
    }

    /// Instructions of `work`.
    #[inline(always)]
    pub fn count<R>(&self, work: impl FnOnce() -> R) -> (u32, R) {
        clock::wind();
        let from = clock::now();
        let result = work();
        let to = clock::now();
        (self.instructions(clock::between(from, to).saturating_sub(self.nothing.into())), result)
    }

    fn instructions(&self, ticks: u64) -> u32 {
        let scaled = ticks.wrapping_mul(u64::from(KNOWN)).wrapping_add(self.known / 2);
        scaled.checked_div(self.known).unwrap_or(0) as u32
    }

    /// Begins to count work in parts.
    pub fn laps(&self) -> Laps<'_> {
        clock::wind();
        let from = Cell::new(clock::now());
        Laps { meter: self, from, ticks: Cell::new(0), longest: Cell::new(0) }
    }
}

/// Instructions of work that tells when a part of it is done.
#[derive(Debug)]
pub struct Laps<'a> {
    meter: &'a Meter,
    from: Cell<u32>,
    ticks: Cell<u64>,
    longest: Cell<u64>,
}

impl Laps<'_> {
    /// A part is done.
    #[inline(always)]
    pub fn lap(&self) {
        let to = clock::now();
        let ticks = clock::between(self.from.get(), to);
        self.ticks.set(self.ticks.get().wrapping_add(ticks));
        self.longest.set(self.longest.get().max(ticks));
        clock::wind();
        self.from.set(clock::now());
    }

    /// Instructions of all parts, and of the longest.
    pub fn counts(&self) -> [u32; 2] {
        [self.ticks.get(), self.longest.get()].map(|ticks| self.meter.instructions(ticks))
    }
}

impl Default for Meter {
    fn default() -> Self {
        Self::new()
    }
}
