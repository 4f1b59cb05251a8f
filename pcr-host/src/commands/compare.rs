//! `pcr compare`.

use super::scenario_sources::{gathered, without_margin};
use super::{CliError, SCENARIOS, folder, quiet, statuses, whole_within};
use crate::progress::ProgressLine;
use clap::{Args, ValueEnum};
use pcr_comparing::compare::{self, Comparison, MeasurementBudget, MethodQuestion};
use pcr_comparing::report;
use pcr_formats::import::ImportOptions;
use pcr_formats::output;
use pcr_formats::scenario::Agent;
use pcr_planning::failure::ComputationError;
use pcr_planning::memory_budget::MemoryDemand;
use pcr_planning::report::{counted, heading, json};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

const EXAMPLES: &str = "\
Examples:
  pcr compare fleet.json                           every method
  pcr compare fleet.json --method polyline         only pcr and polyline
  pcr compare small.json large.json --format csv   a line a method and scenario
  pcr compare fleet.json -o charts                 and time against error drawn";

/// Run this and other methods side by side: time, memory, errors
#[derive(Args)]
#[command(after_help = format!("{EXAMPLES}\n\n{}", statuses(SCENARIOS)))]
pub(super) struct CompareArgs {
    /// Scenarios (JSON); standard input if left out
    #[arg(value_name = "FILE")]
    files: Vec<PathBuf>,
    /// Only pcr f64 and methods whose names contain WORD
    #[arg(long = "method", value_name = "WORD")]
    methods: Vec<String>,
    /// Rounds, 1 to 1000; slow methods have fewer
    #[arg(long, value_name = "N", default_value_t = 51, value_parser = |text: &str| whole_within::<u16>(text, 1, 1000))]
    rounds: u16,
    /// table, markdown, json or csv
    #[arg(long, value_enum, default_value_t = CompareFormat::Table, hide_possible_values = true)]
    format: CompareFormat,
    /// The same as --format json
    #[arg(long)]
    json: bool,
    /// Draw time against error: DIR/regions-1.svg, conflicts-1.svg
    #[arg(short, long, value_name = "DIR", value_parser = folder())]
    output: Option<PathBuf>,
    #[command(flatten)]
    import: ImportOptions,
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum CompareFormat {
    Table,
    Markdown,
    Json,
    Csv,
}

/// Time that a method gets in all rounds \[s\].
const BUDGET: f64 = 0.5;

/// Slices of regions that are compared with the reference.
const SLICES: usize = 20_000;

impl CompareArgs {
    pub(super) fn run(self) -> Result<ExitCode, CliError> {
        without_margin(&self.import)?;
        let names = compare::names(&compare::methods());
        if let Some(word) = self.methods.iter().find(|word| !names.iter().any(|name| name.contains(word.as_str()))) {
            let names = names.join(", ");
            return Err(CliError::arguments(format!(
                "--method {word}: no method has a name with that; there are {names}"
            )));
        }
        let sources = gathered(self.files, &self.import)?;
        if let Some(directory) = &self.output {
            // Before minutes of measurements.
            output::folder(directory).map_err(|error| CliError::not_written(directory, &error))?;
        }
        let format = if self.json { CompareFormat::Json } else { self.format };
        let mut out: Box<dyn Write> = match format {
            CompareFormat::Table if quiet() => Box::new(io::sink()),
            _ => Box::new(BufWriter::new(io::stdout().lock())),
        };
        if format == CompareFormat::Csv {
            out.write_all(report::COMPARISON_CSV_HEADER.as_bytes())?;
        }
        let effort = MeasurementBudget { rounds: self.rounds.into(), budget: BUDGET, slices: SLICES };
        for (place, source) in sources.iter().enumerate() {
            let mut scenario = source.scenario(&self.import)?;
            scenario.name = source.display_name(&scenario.name);
            let agents = scenario.agents.len();
            let outlined = |agent: &&Agent| agent.footprint.is_some() || !agent.loads.is_empty();
            if let Some(agent) = scenario.agents.iter().find(outlined) {
                let problem =
                    "it has a footprint or loads, and the methods beside pcr are compared on discs; give it a radius";
                return Err(CliError::wrong(source.file(), format!("agent {}: {problem}", agent.display_name())));
            }
            MemoryDemand::Comparison(agents).ask().map_err(|large| CliError::wrong(source.file(), large))?;
            let progress = ProgressLine::new("methods");
            let refused = |refused| CliError::wrong(source.file(), ComputationError::Refused(refused));
            let comparison =
                Comparison::new(&scenario, compare::methods(), effort, &self.methods, &mut |done, total| {
                    progress.set(done, total)
                })
                .map_err(refused)?;
            drop(progress);
            match format {
                CompareFormat::Table | CompareFormat::Markdown if place > 0 => writeln!(out)?,
                _ => {}
            }
            if format == CompareFormat::Markdown && sources.len() > 1 {
                // A table of Markdown has no title of its own.
                writeln!(out, "{}: {}\n", heading(&comparison.name), counted(agents, "agent"))?;
            }
            match format {
                CompareFormat::Table => report::comparison_table(&comparison, false, &mut out)?,
                CompareFormat::Markdown => report::comparison_table(&comparison, true, &mut out)?,
                CompareFormat::Json => json(&comparison, &mut out)?,
                CompareFormat::Csv => report::comparison_csv(&comparison, &mut out)?,
            }
            out.flush()?;
            if let Some(directory) = &self.output {
                draw(&comparison, directory, place + 1)?;
            }
        }
        Ok(ExitCode::SUCCESS)
    }
}

fn draw(comparison: &Comparison, directory: &Path, number: usize) -> Result<(), CliError> {
    for (question, name) in [(MethodQuestion::Regions, "regions"), (MethodQuestion::Conflicts, "conflicts")] {
        let file = directory.join(format!("{name}-{number}.svg"));
        output::write(&file, comparison.chart(question)).map_err(|error| CliError::not_written(&file, &error))?;
    }
    Ok(())
}
