//! `pcr nodes`.

use super::sources::{layout, layout_source};
use super::{Form, Printed, Stop, statuses};
use clap::Args;
use pcr_formats::import::Options;
use pcr_planning::nodes::Listing;
use pcr_planning::report;
use std::io::Write;
use std::path::PathBuf;
use std::process::ExitCode;

const EXAMPLES: &str = "\
Examples:
  pcr nodes warehouse.geojson                the nodes that --route takes, and the edges
  pcr nodes site.lif.json --vehicle AMR      the edges of one type of vehicle
  pcr nodes town.xodr --json                 for programs";

/// List the nodes, edges, levels and vehicle types of a layout
#[derive(Args)]
#[command(after_help = format!("{EXAMPLES}\n\n{}", statuses("wrong arguments, or a layout that cannot be read or was refused")))]
pub(super) struct Arguments {
    /// The layout; standard input if left out or `-`
    layout: Option<PathBuf>,
    #[command(flatten)]
    printed: Printed,
    #[command(flatten)]
    import: Options,
}

impl Arguments {
    pub(super) fn run(self) -> Result<ExitCode, Stop> {
        let imported = layout(&layout_source(self.layout)?, &self.import, "nodes", false)?;
        let listing = Listing::of(&imported.layout);
        let mut out = self.printed.out(false);
        match self.printed.form() {
            Form::Table => report::nodes_table(&listing, &mut out)?,
            Form::Json => report::json(&listing, &mut out)?,
            Form::Csv => report::nodes_csv(&listing, &mut out)?,
        }
        out.flush()?;
        Ok(ExitCode::SUCCESS)
    }
}
