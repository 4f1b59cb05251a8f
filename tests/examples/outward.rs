//! Checks "outward by construction" on any number of random pairs, in every number format, on all processors:
//!
//! ```text
//! cargo run --release -p pcr-tests --example outward -- --pairs 100000000 --seed 1 [--format f32]
//! ```
//!
//! Prints the seed of every violation; the exit status is 1 if there was one, 2 for wrong arguments.

use pcr_tests::outward::{FORMATS, Tally, run_on_all_processors};
use std::process::ExitCode;
use std::time::Instant;

/// Pairs between two lines that tell how far it is.
const PROGRESS: u64 = 1_000_000;
/// Violations that are printed of each format, but for those of its last batch.
const PRINTED: usize = 50;

struct Arguments {
    pairs: u64,
    seed: u64,
    format: Option<String>,
}

fn arguments() -> Result<Arguments, String> {
    let mut found = Arguments { pairs: 1_000_000, seed: 1, format: None };
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
    if let Some(format) = &found.format
        && !FORMATS.iter().any(|(name, _)| name == format)
    {
        let known: Vec<_> = FORMATS.iter().map(|(name, _)| *name).collect();
        return Err(format!("--format {format}: known are {known:?}"));
    }
    Ok(found)
}

fn main() -> ExitCode {
    let Arguments { pairs, seed, format } = match arguments() {
        Ok(arguments) => arguments,
        Err(why) => {
            eprintln!("{why}");
            return ExitCode::from(2);
        }
    };
    let mut violated = false;
    for (name, run) in FORMATS.iter().filter(|(name, _)| format.as_ref().is_none_or(|format| format == name)) {
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
