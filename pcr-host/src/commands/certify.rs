//! `pcr certify`.

use super::help::STANDING;
use super::number::{ScalarArg, with_scalar};
use super::scenario_command::tell_rounding;
use super::scenario_sources::{layout_from, scenario_from, source, text};
use super::{CONFLICTS, CliError, OutputArgs, OutputFormat, UNDECIDED, WRONG_INPUT, acknowledge, say};
use crate::progress::ProgressLine;
use clap::Args;
use pcr_formats::import::{ImportOptions, InputKind};
use pcr_formats::input;
use pcr_formats::scenario::Labels;
use pcr_planning::certify::{CertificateTable, CertifyInput, CertifyReport};
use pcr_planning::failure::ComputationError;
use pcr_planning::regions::table_of;
use pcr_planning::{exclusion_table, report};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

const STATUSES: &str = "\
Exit status:
  0  proved
  1  refuted, with a place where the table is wrong
  2  wrong arguments, or a file that cannot be read or was refused
  3  the output could not be written
  4  undecided: too near to the bound for the rounding of the checker, as discs
     that just touch are";

const EXAMPLES: &str = "\
Examples:
  pcr certify fleet.json                   the collision regions of a fleet
  pcr certify fleet.json --scalar q16      the same in 16.16 fixed point
  pcr certify fleet.json --limit           and their margin, as a fraction of ε
  pcr certify site.lif.json --radius 0.6   the table of locks of a layout
  pcr regions fleet.json --json --certificate > table.json
  pcr certify --table table.json           this table, whoever wrote it
  pcr certify --table console.txt          what a microcontroller printed";

/// Prove that a table of regions or locks is right or show where not
///
/// The checker shares no geometry with the code that has computed the table, and does not sample. It proves that every contact of the discs
/// lies in a piece of a region, and that nothing in the table is farther from a contact than the stated bound.
#[derive(Args)]
#[command(after_help = format!("{EXAMPLES}\n\n{STATUSES}"))]
pub(super) struct CertifyArgs {
    /// Scenario, or layout, whose locks of edges and nodes are certified; standard input if left out or `-`
    file: Option<PathBuf>,
    /// A table, as `pcr regions --certificate` or the firmware prints it; `-` for standard input
    #[arg(long, value_name = "FILE")]
    table: Option<PathBuf>,
    #[command(flatten)]
    printed: OutputArgs,
    /// Add the margin: up to which δ, as a fraction of ε, contacts are proved to be covered (takes 12 times as long)
    #[arg(long)]
    limit: bool,
    /// Numbers: f64, f32, micro (f32 of microcontrollers), or fixed point: q20 (up to ±256 m and s), q16 (±4096), q12 (±65,536)
    #[arg(long, value_enum, value_name = "NUMBER", default_value_t = ScalarArg::F64, hide_possible_values = true)]
    scalar: ScalarArg,
    #[command(flatten)]
    import: ImportOptions,
}

impl CertifyArgs {
    pub(super) fn run(self) -> Result<ExitCode, CliError> {
        if self.limit && self.printed.form() == OutputFormat::Csv {
            return Err(CliError::arguments("--limit is for --format json and table"));
        }
        let certified = self.certified()?;
        let file = self.table.as_deref().or(self.file.as_deref()).unwrap_or(Path::new("-"));
        // Nothing would be proved.
        if certified.is_empty() {
            return Err(CliError::wrong(file, "there is no table to be certified"));
        }
        if certified.iter().all(|one| one.pairs == 0 && one.error.is_none()) {
            return Err(CliError::wrong(file, ComputationError::NoPair));
        }
        let mut out = self.printed.out(false);
        if self.printed.form() == OutputFormat::Csv {
            out.write_all(report::CERTIFIED_CSV_HEADER.as_bytes())?;
        }
        for one in &certified {
            match self.printed.form() {
                OutputFormat::Table => report::certified_table(one, &mut out)?,
                OutputFormat::Json => report::json(one, &mut out)?,
                OutputFormat::Csv => report::certified_csv(one, &mut out)?,
            }
        }
        out.flush()?;
        let any = |verdict: &str| certified.iter().any(|one| one.verdict == Some(verdict));
        Ok(match () {
            () if certified.iter().any(|one| one.error.is_some()) => ExitCode::from(WRONG_INPUT),
            () if any("refuted") => ExitCode::from(CONFLICTS),
            () if any("undecided") => ExitCode::from(UNDECIDED),
            () => ExitCode::SUCCESS,
        })
    }

    /// Proves a table, and shows how far that is.
    fn proved(&self, file: &Path, name: &str, table: &CertificateTable) -> CertifyReport {
        let progress = ProgressLine::new(format!("{}: checks of pairs", file.display()));
        CertifyReport::watched(name, table, self.limit, &|done, total| progress.set(done, total))
    }

    fn certified(&self) -> Result<Vec<CertifyReport>, CliError> {
        if let Some(file) = &self.table {
            if let Some(option) = self.import.given().first() {
                return Err(CliError::arguments(format!(
                    "{option} has no effect: the table already contains all values"
                )));
            }
            let text = input::read_text(file)?;
            let mut dump =
                CertifyInput::of(&text, &input::stem(file)).map_err(|problem| CliError::wrong(file, problem))?;
            acknowledge(&mut dump.warnings);
            let tables = dump.certificate.iter();
            let certified = tables.map(|table| self.proved(file, &dump.name, table));
            return Ok(certified.map(|one| one.with(&dump.labels, &dump.warnings)).collect());
        }
        let file = &source(self.file.clone())?;
        let mut warnings = Vec::new();
        let text = text(file)?;
        let scenarios = match input::kind_of(file, &text, &self.import) {
            InputKind::Layout(_) if self.import.one_of(&["routes"]).is_none() => {
                let imported = layout_from(file, &text, &self.import, STANDING, false)?;
                warnings.extend(imported.layout.warnings.iter().cloned());
                acknowledge(&mut warnings);
                exclusion_table::scenarios(&imported).map_err(|error| CliError::wrong(file, error))?
            }
            _ => vec![scenario_from(file, text, &self.import)?],
        };
        let certified = scenarios.into_iter().map(|mut scenario| {
            let lost = tell_rounding(self.scalar, &mut scenario).map_err(|refused| CliError::wrong(file, refused))?;
            say(file, lost);
            let scenario = &scenario;
            let tables = with_scalar!(self.scalar, S => table_of::<S>(scenario));
            let tables = tables.map_err(|failure| CliError::wrong(file, failure))?;
            let (labels, warnings) = (Labels::from_scenario(scenario), [&warnings[..], &scenario.warnings].concat());
            let certified = tables.iter().map(|table| self.proved(file, &scenario.name, table));
            Ok(certified.map(|one| one.with(&labels, &warnings)).collect::<Vec<_>>())
        });
        Ok(certified.collect::<Result<Vec<_>, CliError>>()?.into_iter().flatten().collect())
    }
}
