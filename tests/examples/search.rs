//! Directed search for pairs whose tables are wrong, from many starts, in every number format:
//!
//! ```text
//! cargo run --release -p pcr-tests --example search -- --starts 1000 --steps 20000 [--first 0] [--format q16]
//! ```
//!
//! Prints the row of each format in `docs/theory/errors.md` and the pair with the smallest margin; the exit status is 1 if a table is refuted,
//! 2 for wrong arguments.

use pcr_core::scalar::Micro;
use pcr_fixed::{Q12, Q16, Q20};
use pcr_planning::fleet::HostScalar;
use pcr_tests::arguments::Arguments;
use pcr_tests::case_ranges::run_on_all_processors;
use pcr_tests::search::{Searches, searches};
use std::process::ExitCode;

type Search = fn(u64, u64, u64) -> Searches;

const FORMATS: [(&str, Search); 6] = [
    (f64::NAME, searches::<f64>),
    (f32::NAME, searches::<f32>),
    (Micro::NAME, searches::<Micro>),
    (Q20::NAME, searches::<Q20>),
    (Q16::NAME, searches::<Q16>),
    (Q12::NAME, searches::<Q12>),
];

fn main() -> ExitCode {
    let names = [("starts", 100), ("steps", 10_000), ("first", 0)];
    let given = Arguments::of_process(&names, FORMATS.iter().map(|(name, _)| *name));
    let (starts, steps, first) = (given.number("starts"), given.number("steps"), given.number("first"));
    let mut refuted = false;
    println!("{}", Searches::HEADINGS);
    for (name, search) in FORMATS.iter().filter(|(name, _)| given.wants(name)) {
        let one = |seed, count| search(seed, count, steps);
        let found = run_on_all_processors(one, first, starts, |_: &Searches, _: &Searches| ());
        println!("{}", found.row(name));
        found.refuted.iter().for_each(|worst| eprintln!("{name} refuted: {worst:?}"));
        found.worst.iter().for_each(|worst| eprintln!("{name}: {worst:?}"));
        refuted |= !found.refuted.is_empty();
    }
    ExitCode::from(u8::from(refuted))
}
