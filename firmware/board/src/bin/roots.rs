//! The square root of this target's `f32` against `libm::sqrtf`, bit by bit: exit status 0 if all agree.
#![no_std]
#![no_main]

use core::hint::black_box;
use pcr_board::{entry, out};
use pcr_core::scalar::Wide;
use pcr_supervisor::dump::Line;
use semihosting::process;

/// Between two bit patterns of the sweep; odd, so that all last bits occur.
const STRIDE: usize = 2_001;

#[entry]
fn main() -> ! {
    let ends = [0, 1, 0x007f_ffff, 0x0080_0000, 0x3f7f_ffff, 0x3f80_0000, 0x3f80_0001, 0x7f7f_ffff, 0x7f80_0000];
    let sweep = (0..0x7f80_0000_u32).step_by(STRIDE);
    let (mut tested, mut different) = (0_u32, 0_u32);
    for bits in ends.into_iter().chain(sweep) {
        let x = black_box(f32::from_bits(bits));
        tested = tested.saturating_add(1);
        if Wide::<f32>::sqrt(x).to_bits() != libm::sqrtf(x).to_bits() {
            different = different.saturating_add(1);
        }
    }
    let line = Line::default().integer(tested, 0).text(b" square roots, ").integer(different, 0);
    out::print(line.text(b" differ from libm\n").as_bytes());
    process::exit(if different == 0 && tested > 1_000_000 { 0 } else { 1 })
}
