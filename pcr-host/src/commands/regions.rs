//! `pcr regions`.

use super::number::{ScalarArg, with_scalar};
use super::scenario_command::{ScenarioCommand, run};
use super::{CliError, OutputArgs, OutputFormat, SCENARIOS, statuses, whole_within};
use clap::Args;
use clap::builder::NonEmptyStringValueParser;
use pcr_formats::import::ImportOptions;
use pcr_formats::scenario::Scenario;
use pcr_planning::fleet::HostScalar;
use pcr_planning::memory_budget::MemoryDemand;
use pcr_planning::regions::{ProgressFn, RegionJob, RegionOptions, RegionsReport, find};
use pcr_planning::report::{self, OutputError};
use std::io::{self, Write};
use std::path::PathBuf;
use std::process::ExitCode;

const EXAMPLES: &str = "\
Examples:
  pcr regions fleet.json                       where and when each must not be
  pcr regions fleet.json --agent 3             the regions of agent 3
  pcr regions fleet.json --margin 0.05         also for discs 5 cm larger
  pcr regions fleet.json --format csv          one line for each region
  pcr regions fleet.json --json --slices 9     the lengths inside at 9 times
  pcr regions - --format json < fleets.jsonl   JSON Lines: a scenario a line";

/// Slices that are given for a region: more than any picture or table can use, and not more than memory holds.
const MOST_SLICES: u64 = 10_000;

/// Print the collision regions of a scenario
#[derive(Args)]
#[command(after_help = format!("{EXAMPLES}\n\n{}", statuses(SCENARIOS)))]
pub(super) struct RegionsArgs {
    /// Scenarios (JSON); standard input if left out or `-`, also one after the other
    #[arg(value_name = "FILE")]
    files: Vec<PathBuf>,
    #[command(flatten)]
    printed: OutputArgs,
    /// Only the regions of this agent, by number or label
    #[arg(long, value_name = "ID", value_parser = NonEmptyStringValueParser::new())]
    agent: Option<String>,
    /// Add the lengths inside each region at N times (JSON only)
    #[arg(long, value_name = "N", value_parser = |text: &str| whole_within::<u32>(text, 0, MOST_SLICES))]
    slices: Option<u32>,
    /// Add the table itself for `pcr certify --table` (JSON only)
    #[arg(long)]
    certificate: bool,
    /// Numbers: f64, f32, micro (f32 of microcontrollers), or fixed point: q20 (up to ±256 m and s), q16 (±4096), q12 (±65,536)
    #[arg(long, value_enum, value_name = "NUMBER", default_value_t = ScalarArg::F64, hide_possible_values = true)]
    scalar: ScalarArg,
    #[command(flatten)]
    import: ImportOptions,
}

impl RegionsArgs {
    pub(super) fn run(self) -> Result<ExitCode, CliError> {
        if self.slices.is_some() && self.printed.form() != OutputFormat::Json {
            return Err(CliError::arguments("--slices is for --format json"));
        }
        if self.certificate && self.printed.form() != OutputFormat::Json {
            return Err(CliError::arguments("--certificate is for --format json"));
        }
        let slices = self.slices.map(|slices| slices as usize);
        let (form, certificate) = (self.printed.form(), self.certificate);
        let work = RegionsCommand { form, scalar: self.scalar, agent: self.agent, slices, certificate };
        run(&work, self.files, &self.import, &self.printed).map(|_| ExitCode::SUCCESS)
    }
}

/// Pairs of discs near one another up to which an answer is held before it is printed: one that there is not is then not begun.
const HELD: usize = 100_000;

/// `pcr regions`.
struct RegionsCommand {
    form: OutputFormat,
    scalar: ScalarArg,
    agent: Option<String>,
    slices: Option<usize>,
    certificate: bool,
}

impl RegionsCommand {
    fn print_in<S: HostScalar>(
        &self,
        scenario: &Scenario,
        told: ProgressFn<'_>,
        out: &mut impl Write,
    ) -> Result<(), OutputError> {
        let agent = self.agent.as_deref().map(|asked| find(scenario, asked)).transpose()?;
        let request = RegionOptions { agent, slices: self.slices, certificate: self.certificate };
        let sheet = RegionJob::<S>::new(scenario, request)?;
        let large = sheet.near() > HELD;
        match self.form {
            OutputFormat::Csv if large => report::sheet_csv(&sheet, told, out),
            OutputFormat::Json if large => report::sheet_json(&sheet, told, out),
            OutputFormat::Csv => Ok(report::csv(&sheet.answer(told)?, out)?),
            OutputFormat::Json => Ok(report::json(&sheet.answer(told)?, out)?),
            OutputFormat::Table => {
                let answer = sheet.answer(told)?;
                let count = answer.regions.len() + answer.margin_regions.as_ref().map_or(0, Vec::len);
                MemoryDemand::Rows { count, what: "regions" }.ask()?;
                Ok(report::table(&answer, out)?)
            }
        }
    }
}

impl ScenarioCommand for RegionsCommand {
    const CSV_HEADER: &'static str = report::CSV_HEADER;

    fn scalar(&self) -> ScalarArg {
        self.scalar
    }

    fn print(&self, scenario: &Scenario, told: ProgressFn<'_>, out: &mut impl Write) -> Result<bool, OutputError> {
        with_scalar!(self.scalar, S => self.print_in::<S>(scenario, told, out))?;
        Ok(false)
    }

    fn refuse(&self, name: &str, error: String, out: &mut impl Write) -> io::Result<()> {
        report::json(&with_scalar!(self.scalar, S => RegionsReport::refused::<S>(name, error)), out)
    }
}
