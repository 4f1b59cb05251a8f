//! Certifies the tables of any number of random pairs, in every number format, on all processors:
//!
//! ```text
//! cargo run --release -p pcr-tests --example certify -- --pairs 10000000 --seed 1 [--format f32]
//! ```
//!
//! Prints the seed of every table that is not proved, and the row of each format in `docs/theory/errors.md`; the exit status is 1 if one is
//! refuted, 2 for wrong arguments.

use pcr_tests::arguments::Arguments;
use pcr_tests::case_ranges::run_on_all_processors;
use pcr_tests::certified::{FORMATS, Proofs};
use std::process::ExitCode;
use std::time::Instant;

/// Pairs between two lines that tell how far it is.
const PROGRESS: u64 = 100_000;

fn main() -> ExitCode {
    let given = Arguments::of_process(&[("pairs", 100_000), ("seed", 1)], FORMATS.iter().map(|(name, _)| *name));
    let (pairs, seed) = (given.number("pairs"), given.number("seed"));
    let mut refuted = false;
    println!("{}", Proofs::HEADINGS);
    for (name, run) in FORMATS.iter().filter(|(name, _)| given.wants(name)) {
        let start = Instant::now();
        let total = run_on_all_processors(*run, seed, pairs, |batch: &Proofs, total: &Proofs| {
            batch.refuted.iter().for_each(|one| eprintln!("{name} refuted {one}"));
            batch.undecided.iter().for_each(|one| eprintln!("{name} undecided {one}"));
            if total.cases() / PROGRESS > (total.cases() - batch.cases()) / PROGRESS {
                eprintln!("{name}: {} of {pairs} pairs in {:.0} s", total.cases(), start.elapsed().as_secs_f64());
            }
        });
        println!("{}", total.row(name));
        eprintln!("{name}: {total}; {:.1} s", start.elapsed().as_secs_f64());
        refuted |= !total.refuted.is_empty();
    }
    ExitCode::from(u8::from(refuted))
}
