//! Plans far more fleets than the tests do and checks each plan by the oracle: `fleets FIRST_SEED COUNT [delay|speed]`.
//!
//! Stops at the first violation, with its seed.

use pcr_tests::plans::{Method, Tally, audit};

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let numbers: Vec<u64> = arguments.iter().filter_map(|argument| argument.parse().ok()).collect();
    let (first, count) = (numbers.first().copied().unwrap_or(0), numbers.get(1).copied().unwrap_or(1_000));
    std::thread::scope(|scope| {
        for (name, method) in [("delay", Method::Delay), ("speed", Method::Speed)] {
            if arguments.len() > 2 && arguments[2] != name {
                continue;
            }
            scope.spawn(move || {
                let mut tally = Tally::default();
                (first..first + count).for_each(|seed| audit(seed, method, &mut tally));
                println!("{name}, {count} fleets from seed {first}: {tally:?}");
            });
        }
    });
}
