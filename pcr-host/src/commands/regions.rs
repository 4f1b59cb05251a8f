//! `pcr regions`.

use super::number::{Number, with_scalar};
use super::work::{Work, run};
use super::{Form, STATUSES, Stop, WRONG_INPUT};
use clap::Args;
use pcr_host::import::Options;
use pcr_host::regions::{Answer, Failure, Request};
use pcr_host::report;
use pcr_host::scenario::Scenario;
use std::io::{self, Write};
use std::path::PathBuf;
use std::process::ExitCode;

const EXAMPLES: &str = "\
Examples:
  pcr regions                                       the paper's 12 agents
  pcr regions fleet.json --agent 3                  what agent 3 has to keep out of
  pcr regions fleet.json --margin 0.05              with 5 cm to be kept around each, listed apart from contact
  pcr regions fleet.json --format csv > fleet.csv   a line a region
  pcr regions fleet.json --format json --slices 9   with the lengths covered at 9 times of each region
  pcr regions - --format json < fleets.jsonl        JSON Lines: a scenario a line in, a line a scenario out";

/// Slices that are given for a region: more than any picture or table can use, and not more than memory holds.
const MOST_SLICES: i64 = 10_000;

/// Print the collision regions of a scenario
#[derive(Args)]
#[command(after_help = format!("{EXAMPLES}\n\n{STATUSES}"))]
pub(super) struct Arguments {
    /// Scenario (JSON); `-` reads JSON Lines on standard input; the paper's 12 agents if left out
    file: Option<PathBuf>,
    /// Form of the output
    #[arg(long, value_enum, default_value_t = Form::Table)]
    format: Form,
    /// Only the regions that this agent has to keep out of
    #[arg(long, value_name = "ID")]
    agent: Option<u64>,
    /// Add the lengths covered at N evenly spaced inner times of each region (JSON only)
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(0..=MOST_SLICES))]
    slices: Option<u32>,
    /// Add the table as it is held, path by path and piece by piece, for `pcr certify --table` (JSON only)
    #[arg(long)]
    certificate: bool,
    /// Number format of the computation
    #[arg(long, value_enum, default_value_t = Number::F64)]
    scalar: Number,
    #[command(flatten)]
    import: Options,
}

impl Arguments {
    pub(super) fn run(self) -> Result<ExitCode, Stop> {
        if self.slices.is_some() && self.format != Form::Json {
            return Err(Stop::Error("--slices is for --format json".into(), WRONG_INPUT));
        }
        if self.certificate && self.format != Form::Json {
            return Err(Stop::Error("--certificate is for --format json".into(), WRONG_INPUT));
        }
        let slices = self.slices.map(|slices| slices as usize);
        let request = Request { agent: self.agent, slices, certificate: self.certificate };
        let work = Regions { scalar: self.scalar, request };
        run(&work, self.file.as_deref(), &self.import, self.format).map(|_| ExitCode::SUCCESS)
    }
}

/// `pcr regions`.
struct Regions {
    scalar: Number,
    request: Request,
}

impl Work for Regions {
    type Answer = Answer;
    const CSV_HEADER: &'static str = report::CSV_HEADER;

    fn answer(&self, scenario: &Scenario) -> Result<Answer, Failure> {
        with_scalar!(self.scalar, S => Answer::of::<S>(scenario, self.request))
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
