//! Carries out random fleets that `pcr plan` solves, with the default noise and delays: `simulate FIRST_SEED COUNT [LARGEST [LATEST [TRIPS]]]`.
//!
//! Fleets have 2 to LARGEST robots (50 if left out), one size after the other. Robots set off at random times until LATEST [s] (0), and
//! travel there and back TRIPS times after that (0), which nobody knows before. Prints a line for each fleet that is not carried out, and
//! what all of them took. No fleet is passed over but those without a plan.

use pcr_tests::closed_loop::{Missions, Tally, fleet};

fn main() {
    let numbers: Vec<u64> = std::env::args().skip(1).filter_map(|argument| argument.parse().ok()).collect();
    let number = |place: usize, usual: u64| numbers.get(place).copied().unwrap_or(usual);
    let (first, count, largest) = (number(0, 0), number(1, 500), number(2, 50) as usize);
    let missions = Missions { latest: number(3, 0) as f64, trips: number(4, 0) as usize };
    let mut tally = Tally::default();
    let mut seed = first;
    while tally.carried_out + tally.told + tally.failed < count as usize {
        if let Some(failure) = fleet(seed, largest, missions, &mut tally) {
            println!("{failure}");
        }
        seed += 1;
    }
    println!("{tally}");
}
