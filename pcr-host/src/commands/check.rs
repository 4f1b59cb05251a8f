//! `pcr check`.

use super::number::{ScalarArg, with_scalar};
use super::scenario_command::{ScenarioCommand, run};
use super::scenario_sources::{keep_bag, pose_text, sources, without_margin};
use super::{CONFLICTS, CliError, OutputArgs, OutputFormat, UNDECIDED, acknowledge, is_standard, warn, write_to};
use crate::progress::ProgressLine;
use clap::Args;
use pcr_drawing::record_page;
use pcr_formats::import::{ImportOptions, PoseOptions};
use pcr_formats::input;
use pcr_formats::scenario::{Scenario, label};
use pcr_planning::approaches::ApproachReport;
use pcr_planning::check::CheckReport;
use pcr_planning::failure::ComputationError;
use pcr_planning::fleet::HostScalar;
use pcr_planning::memory_budget::MemoryDemand;
use pcr_planning::regions::ProgressFn;
use pcr_planning::report::{self, OutputError};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

const STATUSES: &str = "\
Exit status:
  0  no conflicts; with --certify this is also proved
  1  conflicts; with --certify also if it is not proved that there are none
  2  wrong arguments, or one of the scenarios cannot be read or was refused;
     with --certify also if it has fewer than two agents: nothing to prove
  3  the output could not be written
  4  poses with times: no contact is proved, and some cannot be excluded";

const EXAMPLES: &str = "\
Examples:
  pcr check plan.json                       who collides when, where, how deep
  pcr check plan.json --closest --certify   how near they come, and a proof
  pcr check -q plan.json && echo free       for scripts: by the exit status
  pcr check run.mcap --radius 0.4 --top-speed 2 -o run.html   what ran, drawn
  pcr check - --format json < plans.jsonl   JSON Lines: a scenario on each line";

/// Tell whether the agents collide, moving as the scenario says
#[derive(Args)]
#[command(after_help = format!("{EXAMPLES}\n\n{STATUSES}"))]
pub(super) struct CheckArgs {
    /// Scenarios (JSON); standard input if left out or `-`, also one after the other
    #[arg(value_name = "FILE")]
    files: Vec<PathBuf>,
    #[command(flatten)]
    printed: OutputArgs,
    /// Also how near every two agents come (not in CSV)
    #[arg(long)]
    closest: bool,
    /// Prove the answer by an independent checker (not in CSV)
    #[arg(long)]
    certify: bool,
    /// A page about poses with times; `-` for standard output
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Numbers: f64, f32, micro (f32 of microcontrollers), or fixed point: q20 (up to ±256 m and s), q16 (±4096), q12 (±65,536)
    #[arg(long, value_enum, value_name = "NUMBER", default_value_t = ScalarArg::F64, hide_possible_values = true)]
    scalar: ScalarArg,
    #[command(flatten)]
    import: ImportOptions,
    #[command(flatten)]
    poses: PoseOptions,
}

impl CheckArgs {
    pub(super) fn run(self) -> Result<ExitCode, CliError> {
        if self.closest && self.printed.form() == OutputFormat::Csv {
            return Err(CliError::arguments("--closest is for --format json and table"));
        }
        if self.certify && self.printed.form() == OutputFormat::Csv {
            return Err(CliError::arguments("--certify is for --format json and table"));
        }
        without_margin(&self.import)?;
        let files = sources(self.files.clone())?;
        let is_of_poses = |file: &PathBuf| input::holds_poses(file, &self.import);
        if files.iter().any(is_of_poses) {
            let [file] = files.as_slice() else {
                return Err(CliError::arguments("poses with times are checked a file at a time"));
            };
            return self.check_poses(file);
        }
        files.iter().try_for_each(|file| input::refuse_bag(file))?;
        let output = self.output.as_ref().map(|_| "--output");
        if let Some(option) = self.poses.given().first().copied().or(output) {
            let problem = format!("{option} has no effect: it is for poses with times, and the file holds none");
            return Err(CliError::arguments(problem));
        }
        let (form, silent) = (self.printed.form(), self.printed.is_silent());
        let closest = self.closest && !silent;
        let work = CheckCommand { form, scalar: self.scalar, closest, certify: self.certify, silent };
        let found = run(&work, files, &self.import, &self.printed)?;
        Ok(if found { ExitCode::from(CONFLICTS) } else { ExitCode::SUCCESS })
    }

    /// Checks poses with times.
    fn check_poses(&self, file: &Path) -> Result<ExitCode, CliError> {
        let Self { import, poses: options, printed, .. } = self;
        let refusals = [
            (self.certify, "--certify is for scenarios; bounds of what poses tell are certain already"),
            (
                !matches!(self.scalar, ScalarArg::F64),
                "--scalar is for scenarios; poses are computed with bounds of the rounding of f64",
            ),
            (printed.form() == OutputFormat::Csv, "--format csv is for scenarios; of poses there is a table or JSON"),
        ];
        if let Some((_, why)) = refusals.iter().find(|(is_given, _)| *is_given) {
            return Err(CliError::arguments(*why));
        }
        let (log, warnings) = if input::is_bag(file) {
            keep_bag(file, import);
            input::read_bag(file, import, options)?
        } else {
            input::read_poses(file, &pose_text(file, import)?, import, options)?
        };
        warn(file, &warnings);
        let mut lines = warnings.all();
        acknowledge(&mut lines);
        let progress = ProgressLine::new(format!("{}: {} agents", file.display(), log.tracks.len()));
        let name = label(&input::stem(file));
        let told = |done, total| progress.set(done, total);
        let closest = (self.closest && !printed.is_silent()) || self.output.is_some();
        let mut report = ApproachReport::compute(&name, &log, closest, lines, &told)
            .map_err(|large| CliError::wrong(file, large))?;
        drop(progress);
        if let Some(output) = &self.output {
            write_to(output, &record_page::page(&report, &log))?;
        }
        if !self.closest {
            report.closest = None;
        }
        let mut out = printed.out(is_standard(self.output.as_ref()));
        match printed.form() {
            OutputFormat::Json => report::json(&report, &mut out)?,
            _ => report::approaches_table(&report, &mut out)?,
        }
        out.flush()?;
        Ok(match () {
            () if report.has_contact() => ExitCode::from(CONFLICTS),
            () if report.is_free() => ExitCode::SUCCESS,
            () => ExitCode::from(UNDECIDED),
        })
    }
}

/// `pcr check`.
struct CheckCommand {
    form: OutputFormat,
    scalar: ScalarArg,
    closest: bool,
    certify: bool,
    /// Only the exit status tells the answer.
    silent: bool,
}

impl CheckCommand {
    fn verdict<S: HostScalar>(
        &self,
        scenario: &Scenario,
        told: ProgressFn<'_>,
    ) -> Result<CheckReport, ComputationError> {
        match self.certify {
            true => CheckReport::certified::<S>(scenario, self.closest, told),
            false => CheckReport::watched::<S>(scenario, self.closest, told),
        }
    }
}

impl ScenarioCommand for CheckCommand {
    const CSV_HEADER: &'static str = report::CONFLICTS_CSV_HEADER;

    fn scalar(&self) -> ScalarArg {
        self.scalar
    }

    fn print(&self, scenario: &Scenario, told: ProgressFn<'_>, out: &mut impl Write) -> Result<bool, OutputError> {
        if self.silent && with_scalar!(self.scalar, S => CheckReport::any::<S>(scenario, told))? {
            return Ok(true);
        }
        if self.silent && !self.certify {
            return Ok(false);
        }
        let rows = |count: usize| MemoryDemand::Rows { count, what: "rows" }.ask();
        if self.closest && self.form == OutputFormat::Table {
            // All pairs, which is known before they are computed.
            let count = scenario.agents.len();
            rows(count.saturating_mul(count.saturating_sub(1)) / 2)?;
        }
        let verdict = with_scalar!(self.scalar, S => self.verdict::<S>(scenario, told))?;
        match self.form {
            OutputFormat::Table => {
                rows(verdict.conflicts.len() + verdict.closest.as_ref().map_or(0, Vec::len))?;
                report::conflicts_table(&verdict, out)?;
            }
            OutputFormat::Json => report::json(&verdict, out)?,
            OutputFormat::Csv => report::conflicts_csv(&verdict, out)?,
        }
        Ok(!verdict.conflicts.is_empty() || verdict.certificate.is_some_and(|proof| proof.verdict != "proved"))
    }

    fn refuse(&self, name: &str, error: String, out: &mut impl Write) -> io::Result<()> {
        report::json(&CheckReport::refused(name, error), out)
    }
}
