//! `pcr demo`, and `pcr` alone: the paper's simulation.

use super::map::draw;
use super::printed::quiet;
use super::{Stop, WRONG_INPUT, folder, statuses};
use clap::Args;
use pcr_formats::scenario::Scenario;
use pcr_formats::{output, paper};
use pcr_planning::failure::Failure;
use pcr_planning::fleet::Fleet;
use pcr_planning::regions::{self, Answer, Request};
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
pub(super) struct Arguments {
    /// Directory for the pictures (pcr-out if left out, with --quiet none)
    #[arg(short, long, value_name = "DIR", value_parser = folder())]
    output: Option<PathBuf>,
    /// Print the scenario instead, as a file
    #[arg(long)]
    scenario: bool,
}

impl Arguments {
    pub(super) fn run(self) -> Result<ExitCode, Stop> {
        let mut out: Box<dyn Write> = Box::new(io::stdout().lock());
        if self.scenario {
            out.write_all(paper::SCENARIO.as_bytes())?;
            out.flush()?;
            return Ok(ExitCode::SUCCESS);
        }
        if quiet() {
            out = Box::new(io::sink());
        }
        if let Some(output) = &self.output {
            output::folder(output).map_err(|error| Stop::not_written(output, &error))?;
        }
        let scenario =
            Scenario::from_json(paper::SCENARIO).map_err(|error| Stop::Error(error.to_string(), WRONG_INPUT))?;
        let fleet = Fleet::<f64>::new(&scenario).map_err(Failure::from)?;
        let motions = fleet.motions();
        let begin = Instant::now();
        regions::table(&scenario, &motions)?;
        let took = begin.elapsed();
        let answer = Answer::of::<f64>(&scenario, Request::default())?;
        report::overview(&scenario, &answer, took, &mut out)?;
        // Pictures that nobody asked for are for people, as the tables are.
        if let Some(output) = self.output.or_else(|| (!quiet()).then(|| DIRECTORY.into())) {
            draw(&scenario, None, None, &output, &mut out)?;
        }
        Ok(ExitCode::SUCCESS)
    }
}
