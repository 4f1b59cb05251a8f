//! `pcr evaluate`.

use super::printed::notes;
use super::{NOT_WRITTEN, Stop, WRONG_INPUT, folder, quiet, statuses};
use clap::Args;
use pcr_comparing::evaluate::{self, Extent, Problem};
use pcr_formats::output;
use std::io::{self, Write};
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Instant;

/// Measure docs/evaluation.md anew on this machine (takes minutes)
#[derive(Args)]
#[command(after_help = statuses("wrong arguments, or fleets or a document that cannot be read"))]
pub(super) struct Arguments {
    /// Directory for the document and its pictures
    #[arg(short, long, value_name = "DIR", value_parser = folder(), default_value = "docs")]
    output: PathBuf,
    /// Directory with the fleets of the paper's Table VI
    #[arg(long, value_name = "DIR", default_value = "tests/data")]
    data: PathBuf,
    /// Write only this part of the document anew; may be given several times
    #[arg(long, value_name = "PART", value_parser = clap::builder::PossibleValuesParser::new(evaluate::parts()))]
    only: Vec<String>,
    /// Small fleets only, without the slowest methods, to try it out
    #[arg(long)]
    quick: bool,
}

impl Arguments {
    pub(super) fn run(self) -> Result<ExitCode, Stop> {
        let extent = if self.quick { Extent::Quick } else { Extent::Full };
        let written = |error| Stop::not_written(&self.output, &error);
        output::folder(&self.output).map_err(written)?;
        let Self { data, output, only, .. } = &self;
        let begin = Instant::now();
        let mut begins = |part: &str, done: usize, parts: usize| {
            let (place, seconds) = (done + 1, begin.elapsed().as_secs());
            // Where standard error is closed, the document is all there is.
            let _ = writeln!(notes(), "part {place} of {parts}: {part}, {seconds} s after the begin");
        };
        let files = evaluate::write(data, output, extent, only, &mut begins);
        let files = files.map_err(|problem| match &problem {
            Problem::File(path, _) if path.starts_with(&self.output) => Stop::Error(problem.to_string(), NOT_WRITTEN),
            _ => Stop::Error(problem.to_string(), WRONG_INPUT),
        })?;
        let mut out: Box<dyn Write> = if quiet() { Box::new(io::sink()) } else { Box::new(io::stdout().lock()) };
        for file in files {
            writeln!(out, "{}", file.display())?;
        }
        Ok(ExitCode::SUCCESS)
    }
}
