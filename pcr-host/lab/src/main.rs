//! The command `pcr-lab`: the evaluation, and comparisons with the methods of other libraries.

use clap::builder::PossibleValuesParser;
use clap::{Parser, Subcommand};
use pcr_comparing::compare::{Comparison, MeasurementBudget};
use pcr_comparing::report;
use pcr_formats::output;
use pcr_formats::scenario::Scenario;
use pcr_lab::evaluate::{self, Thoroughness};
use pcr_lab::methods::methods;
use std::error::Error;
use std::fmt::Display;
use std::io::{self, BufWriter, Write};
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Instant;

/// Measure pcr beside the methods of others
#[derive(Parser)]
#[command(name = "pcr-lab", version)]
struct LabCli {
    #[command(subcommand)]
    command: LabCommand,
}

#[derive(Subcommand)]
enum LabCommand {
    Evaluate(EvaluateArgs),
    Compare(LabCompareArgs),
}

/// Measure docs/maintain/evaluation.md anew on this machine (takes minutes)
#[derive(clap::Args)]
struct EvaluateArgs {
    /// Directory for the document and its pictures
    #[arg(short, long, value_name = "DIR", default_value = "docs/maintain")]
    output: PathBuf,
    /// Directory with the fleets of the paper's Table VI
    #[arg(long, value_name = "DIR", default_value = "tests/data")]
    data: PathBuf,
    /// Write only this part of the document anew; may be given several times
    #[arg(long, value_name = "PART", value_parser = PossibleValuesParser::new(evaluate::parts()))]
    only: Vec<String>,
    /// Small fleets only, without the slowest methods, to try it out
    #[arg(long)]
    quick: bool,
}

/// Compare all methods on scenarios: those of `pcr compare`, and those of other libraries
#[derive(clap::Args)]
struct LabCompareArgs {
    /// Scenarios (JSON)
    #[arg(value_name = "FILE", required = true)]
    files: Vec<PathBuf>,
    /// Only pcr f64 and methods whose names contain WORD
    #[arg(long = "method", value_name = "WORD")]
    methods: Vec<String>,
    /// Rounds, 1 to 1000; slow methods have fewer
    #[arg(long, value_name = "N", default_value_t = 51, value_parser = clap::value_parser!(u16).range(1..=1000))]
    rounds: u16,
}

/// Time that a method gets in all rounds \[s\].
const BUDGET: f64 = 0.5;

/// Slices of regions that are compared with the reference.
const SLICES: usize = 20_000;

fn main() -> ExitCode {
    let done = match LabCli::parse().command {
        LabCommand::Evaluate(arguments) => arguments.run(),
        LabCommand::Compare(arguments) => arguments.run(),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(problem) => {
            output::remove_empty_folders();
            eprintln!("pcr-lab: {problem}");
            ExitCode::from(2)
        }
    }
}

impl EvaluateArgs {
    fn run(self) -> Result<(), Box<dyn Error>> {
        let extent = if self.quick { Thoroughness::Quick } else { Thoroughness::Full };
        output::folder(&self.output).map_err(|error| not_written(self.output.display(), &error))?;
        let begin = Instant::now();
        let mut begins = |part: &str, done: usize, parts: usize| {
            eprintln!("part {} of {parts}: {part}, {} s after the begin", done + 1, begin.elapsed().as_secs());
        };
        let files = evaluate::write(&self.data, &self.output, extent, &self.only, &mut begins);
        for file in files? {
            println!("{}", file.display());
        }
        Ok(())
    }
}

impl LabCompareArgs {
    fn run(self) -> Result<(), Box<dyn Error>> {
        let effort = MeasurementBudget { rounds: self.rounds.into(), budget: BUDGET, slices: SLICES };
        let mut out = BufWriter::new(io::stdout().lock());
        for file in &self.files {
            let read = |problem: &dyn Display| format!("{}: {problem}", file.display());
            let text = std::fs::read_to_string(file).map_err(|error| read(&format!("cannot be read: {error}")))?;
            let scenario = Scenario::from_json(&text).map_err(|error| read(&error))?;
            let comparison = Comparison::new(&scenario, methods(), effort, &self.methods, &mut |_, _| {});
            let comparison = comparison.map_err(|refused| read(&refused))?;
            report::comparison_table(&comparison, false, &mut out)
                .and_then(|()| out.flush())
                .map_err(|error| not_written("standard output", &error))?;
        }
        Ok(())
    }
}

fn not_written(file: impl Display, error: &io::Error) -> String {
    format!("{file}: cannot be written: {error}")
}
