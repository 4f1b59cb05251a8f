//! `pcr certify`.

use super::number::{Number, with_scalar};
use super::{CONFLICTS, Form, Stop, WRONG_INPUT, scenario, warn};
use clap::Args;
use pcr_host::certify::{Certified, Dump, table_of};
use pcr_host::import::Options;
use pcr_host::{input, locks, report};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Exit status: the checker's own rounding does not tell.
const UNDECIDED: u8 = 4;

const STATUSES: &str = "\
Exit status:
  0  proved
  1  refuted, with a place where the table is wrong
  2  wrong arguments, or a file that cannot be read or was refused
  3  the output could not be written
  4  not proved: within the checker's own rounding of what is promised, as contacts are that just touch";

const EXAMPLES: &str = "\
Examples:
  pcr certify                                           the regions of the paper's 12 agents
  pcr certify fleet.json --scalar q16                   those of a fleet in a format of a small machine
  pcr certify fleet.json --limit                        and how much farther than needed contacts are covered
  pcr certify --locks site.lif.json --radius 0.6        the table of locks of a layout
  pcr regions fleet.json --format json --certificate > table.json   a table as it is held, by whatever has made it
  pcr certify --table table.json                        proved from its numbers alone";

/// Prove of a table of regions, by covering and not by sampling, that no contact is missing, or show one that is
///
/// The checker shares no geometry with what has computed the table. What is proved: every contact of the discs lies in a piece of a
/// region, a piece shows it, and nothing is told that is farther than the stated bound from a contact.
#[derive(Args)]
#[command(after_help = format!("{EXAMPLES}\n\n{STATUSES}"))]
pub(super) struct Arguments {
    /// Scenario (JSON); `-` reads it from standard input; the paper's 12 agents if left out
    #[arg(conflicts_with_all = ["locks", "table"])]
    file: Option<PathBuf>,
    /// A layout, whose table of locks is certified; edges and nodes, every level for itself
    #[arg(long, value_name = "LAYOUT", conflicts_with = "table")]
    locks: Option<PathBuf>,
    /// A table as `pcr regions --certificate` prints it
    #[arg(long, value_name = "FILE", conflicts_with = "scalar")]
    table: Option<PathBuf>,
    /// Form of the output
    #[arg(long, value_enum, default_value_t = Form::Table)]
    format: Form,
    /// Add how far beyond contact everything is covered, in parts of the bound (takes a dozen times as long)
    #[arg(long)]
    limit: bool,
    /// Number format of the table
    #[arg(long, value_enum, default_value_t = Number::F64)]
    scalar: Number,
    #[command(flatten)]
    import: Options,
}

impl Arguments {
    pub(super) fn run(self) -> Result<ExitCode, Stop> {
        let certified = self.certified()?;
        let mut out = BufWriter::new(io::stdout().lock());
        if self.format == Form::Csv {
            out.write_all(report::CERTIFIED_CSV_HEADER.as_bytes())?;
        }
        for one in &certified {
            match self.format {
                Form::Table => report::certified_table(one, &mut out)?,
                Form::Json => report::json(one, &mut out)?,
                Form::Csv => report::certified_csv(one, &mut out)?,
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

    fn certified(&self) -> Result<Vec<Certified>, Stop> {
        if let Some(file) = &self.table {
            let dump = Dump::read(file).map_err(|problem| Stop::wrong(Some(file), problem))?;
            let tables = dump.certificate.iter();
            return Ok(tables.map(|table| Certified::of(&dump.name, table, self.limit)).collect());
        }
        let (file, scenarios): (Option<&Path>, _) = match &self.locks {
            Some(file) => {
                let (imported, warnings) = input::read_layout(file, &self.import, false)?;
                warn(file, &warnings);
                (Some(file), locks::scenarios(&imported).map_err(|error| Stop::wrong(Some(file), error))?)
            }
            None => (self.file.as_deref(), vec![scenario(self.file.as_deref(), &self.import)?]),
        };
        let certified = scenarios.iter().map(|scenario| {
            let tables = with_scalar!(self.scalar, S => table_of::<S>(scenario));
            let tables = tables.map_err(|failure| Stop::wrong(file, failure))?;
            Ok(tables.iter().map(|table| Certified::of(&scenario.name, table, self.limit)).collect::<Vec<_>>())
        });
        Ok(certified.collect::<Result<Vec<_>, Stop>>()?.into_iter().flatten().collect())
    }
}
