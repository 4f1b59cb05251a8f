//! The evaluation, with the methods of other libraries.

use super::Arguments;
use crate::commands::printed::notes;
use crate::commands::{NOT_WRITTEN, Stop, WRONG_INPUT, quiet};
use clap::builder::PossibleValuesParser;
use pcr_comparing::evaluate::{self, Extent, Problem};
use pcr_formats::output;
use std::io::{self, Write};
use std::process::ExitCode;
use std::time::Instant;

/// The names of the parts of the document.
pub(super) fn parts() -> PossibleValuesParser {
    PossibleValuesParser::new(evaluate::parts())
}

pub(super) fn run(arguments: Arguments) -> Result<ExitCode, Stop> {
    let extent = if arguments.quick { Extent::Quick } else { Extent::Full };
    let written = |error| Stop::not_written(&arguments.output, &error);
    output::folder(&arguments.output).map_err(written)?;
    let Arguments { data, output, only, .. } = &arguments;
    let begin = Instant::now();
    let mut begins = |part: &str, done: usize, parts: usize| {
        let (place, seconds) = (done + 1, begin.elapsed().as_secs());
        // Where standard error is closed, the document is all there is.
        let _ = writeln!(notes(), "part {place} of {parts}: {part}, {seconds} s after the begin");
    };
    let files = evaluate::write(data, output, extent, only, &mut begins);
    let files = files.map_err(|problem| match &problem {
        Problem::File(path, _) if path.starts_with(&arguments.output) => Stop::Error(problem.to_string(), NOT_WRITTEN),
        _ => Stop::Error(problem.to_string(), WRONG_INPUT),
    })?;
    let mut out: Box<dyn Write> = if quiet() { Box::new(io::sink()) } else { Box::new(io::stdout().lock()) };
    for file in files {
        writeln!(out, "{}", file.display())?;
    }
    Ok(ExitCode::SUCCESS)
}
