//! Certifies the tables of any number of random pairs, in every number format, on all processors:
//!
//! ```text
//! cargo run --release -p pcr-tests --example certify -- --pairs 10000000 --seed 1 [--format f32]
//! ```
//!
//! Prints the seed of every table that is not proved; the exit status is 1 if one is refuted, 2 for wrong arguments.

use pcr_tests::certified::{FORMATS, Proofs};
use pcr_tests::outward::run_on_all_processors;
use std::process::ExitCode;
use std::time::Instant;

/// Pairs between two lines that tell how far it is.
const PROGRESS: u64 = 100_000;

struct Arguments {
    pairs: u64,
    seed: u64,
    format: Option<String>,
}

fn arguments() -> Result<Arguments, String> {
    let mut found = Arguments { pairs: 100_000, seed: 1, format: None };
    let mut rest = std::env::args().skip(1);
    while let Some(name) = rest.next() {
        let value = rest.next().ok_or(format!("{name} needs a value"))?;
        let number = || value.parse().map_err(|_| format!("{name} {value}: not a number"));
        match name.as_str() {
            "--pairs" => found.pairs = number()?,
            "--seed" => found.seed = number()?,
            "--format" => found.format = Some(value),
            _ => return Err(format!("{name}: allowed are --pairs, --seed and --format")),
        }
    }
    match &found.format {
        Some(format) if !FORMATS.iter().any(|(name, _)| name == format) => {
            let known: Vec<_> = FORMATS.iter().map(|(name, _)| *name).collect();
            Err(format!("--format {format}: known are {known:?}"))
        }
        _ => Ok(found),
    }
}

fn main() -> ExitCode {
    let Arguments { pairs, seed, format } = match arguments() {
        Ok(arguments) => arguments,
        Err(why) => {
            eprintln!("{why}");
            return ExitCode::from(2);
        }
    };
    let mut refuted = false;
    for (name, run) in FORMATS.iter().filter(|(name, _)| format.as_ref().is_none_or(|format| format == name)) {
        let start = Instant::now();
        let total = run_on_all_processors(*run, seed, pairs, |batch: &Proofs, total: &Proofs| {
            batch.refuted.iter().for_each(|one| println!("{name} refuted {one}"));
            batch.undecided.iter().for_each(|one| println!("{name} undecided {one}"));
            if total.cases() / PROGRESS > (total.cases() - batch.cases()) / PROGRESS {
                eprintln!("{name}: {} of {pairs} pairs in {:.0} s", total.cases(), start.elapsed().as_secs_f64());
            }
        });
        println!("{name}: {total}; {:.1} s", start.elapsed().as_secs_f64());
        refuted |= !total.refuted.is_empty();
    }
    ExitCode::from(u8::from(refuted))
}
