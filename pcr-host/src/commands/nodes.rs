//! `pcr nodes`.

use super::scenario_sources::{layout, layout_source};
use super::{CliError, OutputArgs, OutputFormat, statuses};
use clap::Args;
use pcr_formats::import::ImportOptions;
use pcr_planning::nodes::LayoutReport;
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
pub(super) struct NodesArgs {
    /// The layout; standard input if left out or `-`
    layout: Option<PathBuf>,
    #[command(flatten)]
    printed: OutputArgs,
    #[command(flatten)]
    import: ImportOptions,
}

impl NodesArgs {
    pub(super) fn run(self) -> Result<ExitCode, CliError> {
        let imported = layout(&layout_source(self.layout)?, &self.import, "nodes", false)?;
        let listing = LayoutReport::new(&imported.layout);
        let mut out = self.printed.out(false);
        match self.printed.form() {
            OutputFormat::Table => report::nodes_table(&listing, &mut out)?,
            OutputFormat::Json => report::json(&listing, &mut out)?,
            OutputFormat::Csv => report::nodes_csv(&listing, &mut out)?,
        }
        out.flush()?;
        Ok(ExitCode::SUCCESS)
    }
}
