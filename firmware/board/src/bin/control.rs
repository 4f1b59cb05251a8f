//! Can panic, where the divisor is 0: it must not link, or the link of `proof` would prove nothing.
#![no_std]
#![no_main]

use core::hint::black_box as any;
use pcr_board::entry;

#[entry]
fn main() -> ! {
    any(any(1) / any(1));
    semihosting::process::exit(0)
}
