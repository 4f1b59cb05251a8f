//! `pcr locks`.

use super::exclusions::Asked;
use super::sources::{layout, source};
use super::{Form, Printed, Stop};
use clap::Args;
use pcr_drawing as picture;
use pcr_formats::import::Options;
use pcr_planning::locks::Locks;
use pcr_planning::report;
use std::io::Write;
use std::path::PathBuf;
use std::process::ExitCode;

const STATUSES: &str = "\
Exit status:
  0  done; with --audit nothing can touch
  1  with --audit: something can touch
  2  wrong arguments, or a layout that cannot be read or was refused
  3  the output could not be written";

const EXAMPLES: &str = "\
Examples:
  pcr locks warehouse.geojson --radius 0.4                      the table of locks of a nav2 route graph
  pcr locks warehouse.geojson --radius 0.4 -o locks             and a page in which an edge shows what it blocks
  pcr locks site.lif.json --vehicle AMR --radius 0.6 --margin 0.1 --format csv > locks.csv
  pcr locks warehouse.geojson --radius 0.4 --write nav2 -o guarded.geojson     and edges to be closed, into the file
  pcr locks plant.xml --radius 0.5 --audit -o audit             what the blocks of the file do not keep apart";

/// Print which edges of a layout may not be used at the same time, and on which lengths
#[derive(Args)]
#[command(after_help = format!("{EXAMPLES}\n\n{STATUSES}"))]
pub(super) struct Arguments {
    /// The layout; standard input if left out or `-`
    layout: Option<PathBuf>,
    #[command(flatten)]
    printed: Printed,
    /// Add what a vehicle blocks that stands at a node
    #[arg(long)]
    nodes: bool,
    /// Draw the layout with its locks to this directory as well; with --write the file to be written
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    #[command(flatten)]
    asked: Asked,
    #[command(flatten)]
    import: Options,
}

impl Arguments {
    pub(super) fn run(self) -> Result<ExitCode, Stop> {
        let file = &source(self.layout)?;
        if let Some(done) = self.asked.run(file, &self.import, &self.printed, self.output.as_ref()) {
            return done;
        }
        let imported = layout(file, &self.import, "locks", false)?;
        let locks = Locks::of(&imported, self.nodes).map_err(|error| Stop::wrong(file, error))?;
        if let Some(directory) = &self.output {
            picture::write_locks(&imported, &locks, directory).map_err(|error| Stop::not_written(directory, &error))?;
        }
        let mut out = self.printed.out(false);
        match self.printed.form() {
            Form::Table => report::locks_table(&locks, &mut out)?,
            Form::Json => report::json(&locks, &mut out)?,
            Form::Csv => report::locks_csv(&locks, &mut out)?,
        }
        out.flush()?;
        Ok(ExitCode::SUCCESS)
    }
}
