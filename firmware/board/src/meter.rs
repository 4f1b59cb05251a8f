//! Instruction counts that are exact and repeatable: QEMU with `-icount shift=7`, 128 ns an instruction.
//!
//! On ARM the SysTick timer runs on that clock, with two ticks an instruction or more, so that rounding gives the
//! count; a loop of known length calibrates it. On RISC-V `minstret` is the count.

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

/// Instructions of the calibration.
const KNOWN: u32 = 1 << 20;

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
        let ticks = u64::from(clock::between(from, to).saturating_sub(self.nothing));
        let scaled = ticks.wrapping_mul(u64::from(KNOWN)).wrapping_add(self.known / 2);
        let count = scaled.checked_div(self.known).unwrap_or(0) as u32;
        (if clock::ran_out() { u32::MAX } else { count }, result)
    }
}

impl Default for Meter {
    fn default() -> Self {
        Self::new()
    }
}
