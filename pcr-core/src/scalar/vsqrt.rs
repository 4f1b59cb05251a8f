//! The square root of the FPU of a Cortex-M with hard-float ABI: the only `unsafe` of the workspace's libraries.
//!
//! `core` has no stable square root, and that of `libm` is a software routine of some 70 instructions there. The
//! operand goes through core registers because `asm!` takes no `sreg` operands on these targets. The program `sqrt` of
//! the firmware compares a million results with `libm::sqrtf` bit for bit in QEMU.
#![allow(unsafe_code)]

/// √x, correctly rounded: the same bits as `libm::sqrtf`, NaN below zero.
#[inline]
pub(super) fn sqrt(x: f32) -> f32 {
    let mut bits = x.to_bits();
    // SAFETY: targets with the ABI `eabihf` pass numbers in `s` registers, so the FPU exists and is enabled. The block
    // reads and writes only the registers that it declares, and exception flags of the FPU; it uses no memory and no stack.
    unsafe {
        core::arch::asm!(
            "vmov s0, {0}",
            "vsqrt.f32 s0, s0",
            "vmov {0}, s0",
            inout(reg) bits,
            out("s0") _,
            options(pure, nomem, nostack)
        );
    }
    f32::from_bits(bits)
}
