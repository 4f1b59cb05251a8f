//! Carries out random fleets that `pcr plan` solves, with the default noise and delays: `simulate FIRST_SEED COUNT [LARGEST]`.
//!
//! Fleets have 2 to LARGEST robots (50 if left out), one size after the other. Prints a line for each that is not carried out, and what
//! all of them took. No fleet is passed over but those without a plan.

use pcr_tests::closed_loop::{Tally, fleet};

fn main() {
    let numbers: Vec<u64> = std::env::args().skip(1).filter_map(|argument| argument.parse().ok()).collect();
    let number = |place: usize, usual: u64| numbers.get(place).copied().unwrap_or(usual);
    let (first, count, largest) = (number(0, 0), number(1, 500), number(2, 50) as usize);
    let mut tally = Tally::default();
    let mut seed = first;
    while tally.carried_out + tally.told + tally.failed < count as usize {
        if let Some(failure) = fleet(seed, largest, &mut tally) {
            println!("{failure}");
        }
        seed += 1;
    }
    println!("{tally}");
}
