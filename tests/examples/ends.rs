//! Directed search for delays and durations that are called free and are not, in every number format:
//!
//! ```text
//! cargo run --release -p pcr-tests --example ends -- --scenes 1000 --steps 1000 [--first 0] [--format q16]
//! ```
//!
//! Prints the row of each format in `docs/theory/errors.md`; the exit status is 1 if two motions are not apart, 2 for wrong arguments.

use pcr_tests::arguments::Arguments;
use pcr_tests::case_ranges::run_on_all_processors;
use pcr_tests::ends::{Ends, FORMATS};
use std::process::ExitCode;

fn main() -> ExitCode {
    let names = [("scenes", 100), ("steps", 100), ("first", 0)];
    let given = Arguments::of_process(&names, FORMATS.iter().map(|(name, _)| *name));
    let (scenes, steps, first) = (given.number("scenes"), given.number("steps"), given.number("first"));
    let mut lost = false;
    println!("{}", Ends::HEADINGS);
    for (name, search) in FORMATS.iter().filter(|(name, _)| given.wants(name)) {
        let one = |seed, count| search(seed, count, steps);
        let found = run_on_all_processors(one, first, scenes, |_: &Ends, _: &Ends| ());
        println!("{}", found.row(name));
        found.lost.iter().for_each(|value| eprintln!("{name}: not apart: {value}"));
        lost |= !found.lost.is_empty();
    }
    ExitCode::from(u8::from(lost))
}
