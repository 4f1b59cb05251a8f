//! `pcr check`.

use super::number::{Number, with_scalar};
use super::work::{Work, run};
use super::{CONFLICTS, Form, Printed, Stop};
use clap::Args;
use pcr_host::check::Verdict;
use pcr_host::import::Options;
use pcr_host::regions::Failure;
use pcr_host::report;
use pcr_host::scenario::Scenario;
use std::io::{self, Write};
use std::path::PathBuf;
use std::process::ExitCode;

const STATUSES: &str = "\
Exit status:
  0  no conflicts
  1  conflicts
  2  wrong arguments, or a scenario that cannot be read or was refused (one of several is enough)
  3  the output could not be written";

const EXAMPLES: &str = "\
Examples:
  pcr check plan.json                                who collides when, where and how deep
  pcr check plan.json --closest                      and how near every two agents come
  pcr check -q plan.json && echo free                for scripts: the exit status says it
  pcr check - --format json < plans.jsonl            JSON Lines: a scenario a line in, a line a scenario out";

/// Tell whether the agents collide, moving as the scenario says
#[derive(Args)]
#[command(after_help = format!("{EXAMPLES}\n\n{STATUSES}"))]
pub(super) struct Arguments {
    /// Scenarios (JSON); standard input if left out or `-`, also one after the other
    #[arg(value_name = "FILE")]
    files: Vec<PathBuf>,
    #[command(flatten)]
    printed: Printed,
    /// Add how near every two agents come, and when (not in CSV)
    #[arg(long)]
    closest: bool,
    /// Number format: floating point, or steps of 2⁻¹⁶ (±4096 m, s), 2⁻²⁰ (±256), 2⁻¹² (±65 km)
    #[arg(long, value_enum, default_value_t = Number::F64)]
    scalar: Number,
    #[command(flatten)]
    import: Options,
}

impl Arguments {
    pub(super) fn run(self) -> Result<ExitCode, Stop> {
        if self.closest && self.printed.form() == Form::Csv {
            return Err(Stop::arguments("--closest is for --format json and table"));
        }
        let work = Check { scalar: self.scalar, closest: self.closest };
        let found = run(&work, self.files, &self.import, &self.printed)?;
        Ok(if found { ExitCode::from(CONFLICTS) } else { ExitCode::SUCCESS })
    }
}

/// `pcr check`.
struct Check {
    scalar: Number,
    closest: bool,
}

impl Work for Check {
    type Answer = Verdict;
    const CSV_HEADER: &'static str = report::CONFLICTS_CSV_HEADER;

    fn answer(&self, scenario: &Scenario) -> Result<Verdict, Failure> {
        Ok(with_scalar!(self.scalar, S => Verdict::of::<S>(scenario, self.closest))?)
    }

    fn refused(&self, name: &str, error: String) -> Verdict {
        Verdict::refused(name, error)
    }

    fn found(&self, verdict: &Verdict) -> bool {
        !verdict.conflicts.is_empty()
    }

    fn print(&self, verdict: &Verdict, format: Form, out: &mut impl Write) -> io::Result<()> {
        match format {
            Form::Table => report::conflicts_table(verdict, out),
            Form::Json => report::json(verdict, out),
            Form::Csv => report::conflicts_csv(verdict, out),
        }
    }
}
