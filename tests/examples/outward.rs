//! Checks "outward by construction" on any number of random pairs, in every number format, on all processors:
//!
//! ```text
//! cargo run --release -p pcr-tests --example outward -- --pairs 100000000 --seed 1 [--format f32]
//! ```
//!
//! Prints the seed of every violation; the exit status is 1 if there was one, 2 for wrong arguments.

use pcr_tests::arguments::Arguments;
use pcr_tests::case_ranges::run_on_all_processors;
use pcr_tests::outward::{FORMATS, Tally};
use std::process::ExitCode;
use std::time::Instant;

/// Pairs between two lines that tell how far it is.
const PROGRESS: u64 = 1_000_000;
/// Violations that are printed of each format, but for those of its last batch.
const PRINTED: usize = 50;

fn main() -> ExitCode {
    let given = Arguments::of_process(&[("pairs", 1_000_000), ("seed", 1)], FORMATS.iter().map(|(name, _)| *name));
    let (pairs, seed) = (given.number("pairs"), given.number("seed"));
    let mut violated = false;
    for (name, run) in FORMATS.iter().filter(|(name, _)| given.wants(name)) {
        let start = Instant::now();
        let total = run_on_all_processors(*run, seed, pairs, |batch: &Tally, total: &Tally| {
            if total.violations.len() <= PRINTED + batch.violations.len() {
                batch.violations.iter().for_each(|violation| println!("{name} {violation}"));
            }
            if total.cases() / PROGRESS > (total.cases() - batch.cases()) / PROGRESS {
                eprintln!("{name}: {} of {pairs} pairs in {:.0} s", total.cases(), start.elapsed().as_secs_f64());
            }
        });
        println!("{name}: {total}");
        violated |= !total.violations.is_empty();
    }
    ExitCode::from(u8::from(violated))
}
