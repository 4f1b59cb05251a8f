//! What every program here has: the start-up code, the vectors, the way to stop. `pipeline` less this is the library.
#![no_std]
#![no_main]

use pcr_board::entry;

#[entry]
fn main() -> ! {
    semihosting::process::exit(0)
}
