//! Agents at their holds in all formats, seed by seed: `adversary FIRST_SEED COUNT`. A seed that fails panics with its number.

use pcr_core::scalar::Micro;
use pcr_fixed::{Q12, Q16, Q20};
use pcr_planning::fleet::HostScalar;
use pcr_tests::adversary::{Tally, Way, run};

fn campaign<S: HostScalar>(first: u64, count: u64) {
    let mut tally = Tally::default();
    let mut failed = 0;
    for seed in first..first + count {
        for way in [Way::Decided, Way::Admitted] {
            let mut of_seed = tally;
            let done = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| run::<S>(seed, way, &mut of_seed)));
            match done {
                Ok(()) => tally = of_seed,
                Err(_) => failed += 1,
            }
        }
    }
    println!("{}: {failed} failed; {tally:?}", S::NAME);
}

fn main() {
    let numbers: Vec<u64> = std::env::args().skip(1).filter_map(|argument| argument.parse().ok()).collect();
    let [first, count] = [0, 1].map(|place| numbers.get(place).copied().unwrap_or([0, 10_000][place]));
    campaign::<f64>(first, count);
    campaign::<f32>(first, count);
    campaign::<Micro>(first, count);
    campaign::<Q20>(first, count);
    campaign::<Q16>(first, count);
    campaign::<Q12>(first, count);
}
