//! `pcr demo`, and `pcr` alone: the paper's simulation.

use super::map::draw;
use super::printed::quiet;
use super::{CliError, WRONG_INPUT, folder, statuses};
use clap::Args;
use pcr_formats::scenario::Scenario;
use pcr_formats::{output, paper_example};
use pcr_planning::failure::ComputationError;
use pcr_planning::fleet::Fleet;
use pcr_planning::regions::{self, RegionOptions, RegionsReport};
use pcr_planning::report;
use std::io::{self, Write};
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Instant;

/// Directory for the pictures.
const DIRECTORY: &str = "pcr-out";

const EXAMPLES: &str = "\
Examples:
  pcr demo                                the paper's tables beside ours, and pictures in pcr-out/
  pcr demo --scenario > paper12.json      the scenario, to try the other commands on
  pcr demo --scenario | pcr check         who of them collides, moving as the paper says";

/// Show the paper's simulation of 12 agents, with its tables
#[derive(Args, Default)]
#[command(after_help = format!("{EXAMPLES}\n\n{}", statuses("wrong arguments")))]
pub(super) struct DemoArgs {
    /// Directory for the pictures (pcr-out if left out, with --quiet none)
    #[arg(short, long, value_name = "DIR", value_parser = folder())]
    output: Option<PathBuf>,
    /// Print the scenario instead, as a file
    #[arg(long)]
    scenario: bool,
}

impl DemoArgs {
    pub(super) fn run(self) -> Result<ExitCode, CliError> {
        let mut out: Box<dyn Write> = Box::new(io::stdout().lock());
        if self.scenario {
            out.write_all(paper_example::SCENARIO.as_bytes())?;
            out.flush()?;
            return Ok(ExitCode::SUCCESS);
        }
        if quiet() {
            out = Box::new(io::sink());
        }
        if let Some(output) = &self.output {
            output::folder(output).map_err(|error| CliError::not_written(output, &error))?;
        }
        let scenario = Scenario::from_json(paper_example::SCENARIO)
            .map_err(|error| CliError::Error(error.to_string(), WRONG_INPUT))?;
        let fleet = Fleet::<f64>::new(&scenario).map_err(ComputationError::from)?;
        let motions = fleet.motions();
        let begin = Instant::now();
        regions::table(&scenario, &motions)?;
        let took = begin.elapsed();
        let answer = RegionsReport::compute::<f64>(&scenario, RegionOptions::default())?;
        report::overview(&scenario, &answer, took, &mut out)?;
        // Pictures that nobody asked for are for people, as the tables are.
        if let Some(output) = self.output.or_else(|| (!quiet()).then(|| DIRECTORY.into())) {
            draw(&scenario, None, None, &output, &mut out)?;
        }
        Ok(ExitCode::SUCCESS)
    }
}
