//! `pcr locks`.

use super::{Form, STATUSES, Stop, warn};
use clap::Args;
use pcr_host::import::Options;
use pcr_host::locks::Locks;
use pcr_host::{input, picture, report};
use std::io::{self, BufWriter, Write};
use std::path::PathBuf;
use std::process::ExitCode;

const EXAMPLES: &str = "\
Examples:
  pcr locks warehouse.geojson --radius 0.4                      the table of locks of a nav2 route graph
  pcr locks warehouse.geojson --radius 0.4 -o locks             and a page in which an edge shows what it blocks
  pcr locks site.lif.json --vehicle AMR --radius 0.6 --margin 0.1 --format csv > locks.csv";

/// Print which edges of a layout may not be used at the same time, and on which lengths
#[derive(Args)]
#[command(after_help = format!("{EXAMPLES}\n\n{STATUSES}"))]
pub(super) struct Arguments {
    /// The layout; `-` reads standard input
    layout: PathBuf,
    /// Form of the output
    #[arg(long, value_enum, default_value_t = Form::Table)]
    format: Form,
    /// Add what a vehicle blocks that stands at a node
    #[arg(long)]
    nodes: bool,
    /// Draw the layout with its locks to this directory as well
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    #[command(flatten)]
    import: Options,
}

impl Arguments {
    pub(super) fn run(self) -> Result<ExitCode, Stop> {
        let (imported, warnings) = input::read_layout(&self.layout, &self.import, false)?;
        warn(&self.layout, &warnings);
        let locks = Locks::of(&imported, self.nodes).map_err(|error| Stop::wrong(Some(&self.layout), error))?;
        if let Some(directory) = &self.output {
            picture::write_locks(&imported, &locks, directory).map_err(|error| Stop::not_written(directory, &error))?;
        }
        let mut out = BufWriter::new(io::stdout().lock());
        match self.format {
            Form::Table => report::locks_table(&locks, &mut out)?,
            Form::Json => report::locks_json(&locks, &mut out)?,
            Form::Csv => report::locks_csv(&locks, &mut out)?,
        }
        out.flush()?;
        Ok(ExitCode::SUCCESS)
    }
}
