//! `pcr regions`.

use super::number::{Number, with_scalar};
use super::work::{Work, run};
use super::{Form, Printed, STATUSES, Stop};
use clap::Args;
use pcr_formats::import::Options;
use pcr_formats::scenario::Scenario;
use pcr_planning::regions::{Answer, Failure, Request, find};
use pcr_planning::report;
use std::io::{self, Write};
use std::path::PathBuf;
use std::process::ExitCode;

const EXAMPLES: &str = "\
Examples:
  pcr regions fleet.json                            who has to keep out of what, and when
  pcr regions fleet.json --agent 3                  what agent 3 has to keep out of
  pcr regions fleet.json --margin 0.05              with 5 cm to be kept around each, listed apart from contact
  pcr regions fleet.json --format csv > fleet.csv   a line a region
  pcr regions fleet.json --json --slices 9          with the lengths covered at 9 times of each region
  pcr regions - --format json < fleets.jsonl        JSON Lines: a scenario a line in, a line a scenario out";

/// Slices that are given for a region: more than any picture or table can use, and not more than memory holds.
const MOST_SLICES: i64 = 10_000;

/// Print the collision regions of a scenario
#[derive(Args)]
#[command(after_help = format!("{EXAMPLES}\n\n{STATUSES}"))]
pub(super) struct Arguments {
    /// Scenarios (JSON); standard input if left out or `-`, also one after the other
    #[arg(value_name = "FILE")]
    files: Vec<PathBuf>,
    #[command(flatten)]
    printed: Printed,
    /// Only the regions that the agent of this number or label has to keep out of
    #[arg(long, value_name = "ID")]
    agent: Option<String>,
    /// Add the lengths covered at N evenly spaced inner times of each region (JSON only)
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(0..=MOST_SLICES))]
    slices: Option<u32>,
    /// Add the table as it is held, path by path and piece by piece, for `pcr certify --table` (JSON only)
    #[arg(long)]
    certificate: bool,
    /// Number format: floating point, or steps of 2⁻¹⁶ (±4096 m, s), 2⁻²⁰ (±256), 2⁻¹² (±65 km)
    #[arg(long, value_enum, default_value_t = Number::F64)]
    scalar: Number,
    #[command(flatten)]
    import: Options,
}

impl Arguments {
    pub(super) fn run(self) -> Result<ExitCode, Stop> {
        if self.slices.is_some() && self.printed.form() != Form::Json {
            return Err(Stop::arguments("--slices is for --format json"));
        }
        if self.certificate && self.printed.form() != Form::Json {
            return Err(Stop::arguments("--certificate is for --format json"));
        }
        let slices = self.slices.map(|slices| slices as usize);
        let work = Regions { scalar: self.scalar, agent: self.agent, slices, certificate: self.certificate };
        run(&work, self.files, &self.import, &self.printed).map(|_| ExitCode::SUCCESS)
    }
}

/// `pcr regions`.
struct Regions {
    scalar: Number,
    agent: Option<String>,
    slices: Option<usize>,
    certificate: bool,
}

impl Work for Regions {
    type Answer = Answer;
    const CSV_HEADER: &'static str = report::CSV_HEADER;

    fn answer(&self, scenario: &Scenario) -> Result<Answer, Failure> {
        let agent = self.agent.as_deref().map(|asked| find(scenario, asked)).transpose()?;
        let request = Request { agent, slices: self.slices, certificate: self.certificate };
        with_scalar!(self.scalar, S => Answer::of::<S>(scenario, request))
    }

    fn refused(&self, name: &str, error: String) -> Answer {
        with_scalar!(self.scalar, S => Answer::refused::<S>(name, error))
    }

    fn found(&self, _: &Answer) -> bool {
        false
    }

    fn print(&self, answer: &Answer, format: Form, out: &mut impl Write) -> io::Result<()> {
        match format {
            Form::Table => report::table(answer, out),
            Form::Json => report::json(answer, out),
            Form::Csv => report::csv(answer, out),
        }
    }
}
