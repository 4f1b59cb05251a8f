//! Checks "outward by construction" on any number of random pairs, in every number format, on all processors:
//!
//! ```text
//! cargo run --release -p pcr-tests --example outward -- --pairs 100000000 --seed 1 [--format f32]
//! ```
//!
//! Prints the seed of every violation; the exit status is 1 if there was one, 2 for wrong arguments.

use pcr_tests::outward::{FORMATS, Tally};
use std::process::ExitCode;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

/// Pairs that a thread takes at a time.
const BATCH: u64 = 10_000;

/// Violations that are printed of each format.
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
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let mut violated = false;
    for (name, run) in FORMATS.iter().filter(|(name, _)| format.as_ref().is_none_or(|format| format == name)) {
        let (next, total, start) = (AtomicU64::new(0), Mutex::new(Tally::default()), Instant::now());
        std::thread::scope(|scope| {
            for _ in 0..threads {
                scope.spawn(|| {
                    loop {
                        let first = next.fetch_add(BATCH, Ordering::Relaxed);
                        if first >= pairs {
                            break;
                        }
                        let batch = run(seed.wrapping_add(first), BATCH.min(pairs - first));
                        let mut total = total.lock().expect("no thread panics with it");
                        for violation in batch.violations.iter().take(PRINTED.saturating_sub(total.violations.len())) {
                            println!("{name} {violation}");
                        }
                        total.add(batch);
                        let done = total.seen.pairs + total.refused;
                        if done / 1_000_000 > (done - BATCH.min(done)) / 1_000_000 {
                            eprintln!("{name}: {done} of {pairs} pairs in {:.0} s", start.elapsed().as_secs_f64());
                        }
                    }
                });
            }
        });
        let total = total.into_inner().expect("no thread panics with it");
        println!("{name}: {total}");
        violated |= !total.violations.is_empty();
    }
    ExitCode::from(u8::from(violated))
}
