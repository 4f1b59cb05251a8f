//! Directed search for pairs whose regions lose or invent something, from many starts:
//!
//! ```text
//! cargo run --release -p pcr-tests --example search -- --starts 1000 --steps 20000 [--first 0] [--format q16]
//! ```
//!
//! Prints the worst pair of each format; the exit status is 1 if one is beyond its bounds, 2 for wrong arguments.

use pcr_fixed::{Q12, Q16, Q20};
use pcr_planning::fleet::Format;
use pcr_tests::search::{Worst, search};
use std::ops::Range;
use std::process::ExitCode;

type Search = fn(u64, u64) -> Option<Worst>;

const FORMATS: [(&str, Search); 5] = [
    (f64::NAME, search::<f64>),
    (f32::NAME, search::<f32>),
    (Q20::NAME, search::<Q20>),
    (Q16::NAME, search::<Q16>),
    (Q12::NAME, search::<Q12>),
];

struct Arguments {
    starts: Range<u64>,
    steps: u64,
    format: Option<String>,
}

fn arguments() -> Result<Arguments, String> {
    let (mut starts, mut first, mut steps, mut format) = (100, 0, 10_000, None);
    let mut rest = std::env::args().skip(1);
    while let Some(name) = rest.next() {
        let value = rest.next().ok_or(format!("{name} needs a value"))?;
        let number = || value.parse::<u64>().map_err(|_| format!("{name} {value}: not a number"));
        match name.as_str() {
            "--starts" => starts = number()?,
            "--first" => first = number()?,
            "--steps" => steps = number()?,
            "--format" if FORMATS.iter().any(|(known, _)| *known == value) => format = Some(value),
            _ => return Err(format!("{name} {value}: allowed are --starts, --first, --steps and --format")),
        }
    }
    Ok(Arguments { starts: first..first.saturating_add(starts), steps, format })
}

fn main() -> ExitCode {
    let Arguments { starts, steps, format } = match arguments() {
        Ok(arguments) => arguments,
        Err(why) => {
            eprintln!("{why}");
            return ExitCode::from(2);
        }
    };
    let mut violated = false;
    for (name, search) in FORMATS.iter().filter(|(name, _)| format.as_ref().is_none_or(|format| format == name)) {
        let found = starts.clone().filter_map(|seed| Some((seed, search(seed, steps)?)));
        if let Some((seed, worst)) = found.min_by(|a, b| a.1.margin().total_cmp(&b.1.margin())) {
            println!(
                "{name}: {:.3} to {:.3} of the excess, start {seed}: {:?}",
                worst.ends[0], worst.ends[1], worst.pair
            );
            violated |= worst.margin() < 0.0;
        }
    }
    ExitCode::from(u8::from(violated))
}
