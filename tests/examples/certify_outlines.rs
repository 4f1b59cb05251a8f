//! Certifies the tables and contacts of any number of random pairs of outlines, in every number format, on all processors:
//!
//! ```text
//! cargo run --release -p pcr-tests --example certify_outlines -- --pairs 10000000 --seed 1 [--format f32]
//! ```
//!
//! Prints the seed of every pair that is not proved; the exit status is 1 if one is refuted, 2 for wrong arguments.

use pcr_tests::arguments::Arguments;
use pcr_tests::case_ranges::run_on_all_processors;
use pcr_tests::certified_outlines::{FORMATS, OutlineProofs};
use std::process::ExitCode;
use std::time::Instant;

fn main() -> ExitCode {
    let given = Arguments::of_process(&[("pairs", 10_000), ("seed", 1)], FORMATS.iter().map(|(name, _)| *name));
    let (pairs, seed) = (given.number("pairs"), given.number("seed"));
    let mut refuted = false;
    for (name, run) in FORMATS.iter().filter(|(name, _)| given.wants(name)) {
        let start = Instant::now();
        let total = run_on_all_processors(*run, seed, pairs, |batch: &OutlineProofs, _| {
            batch.refuted.iter().for_each(|one| eprintln!("{name} refuted {one}"));
            batch.undecided.iter().for_each(|one| eprintln!("{name} undecided {one}"));
        });
        println!("{name}: {total}; {:.1} s", start.elapsed().as_secs_f64());
        refuted |= !total.refuted.is_empty();
    }
    ExitCode::from(u8::from(refuted))
}
