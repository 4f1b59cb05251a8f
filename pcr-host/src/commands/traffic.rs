//! `pcr traffic`.

use super::printed::notes;
use super::sources::{layout, source};
use super::{Form, Printed, STATUSES, Stop, map, write_to};
use clap::Args;
use pcr_drawing::Ground;
use pcr_formats::import::Options;
use pcr_planning::report;
use pcr_planning::traffic::{Request, Traffic};
use std::io::Write;
use std::path::PathBuf;
use std::process::ExitCode;

const EXAMPLES: &str = "\
Examples:
  pcr traffic warehouse.geojson --agents 50 --seed 1 --radius 0.4              who waits how long, and the throughput
  pcr traffic warehouse.geojson --agents 50 --seed 1 --radius 0.4 -o traffic   and scenarios and pictures in traffic/";

/// Plan random missions on a layout: who waits, how many missions an hour
#[derive(Args)]
#[command(after_help = format!("{EXAMPLES}\n\n{STATUSES}"))]
pub(super) struct Arguments {
    /// The layout; standard input if left out or `-`
    layout: Option<PathBuf>,
    /// Agents, a mission each
    #[arg(long, value_name = "N", default_value_t = 50, value_parser = clap::value_parser!(u16).range(1..))]
    agents: u16,
    /// Another number gives other missions
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    #[command(flatten)]
    printed: Printed,
    /// Write the missions (missions.json), the plan (plan.json) and pictures of it to this directory as well
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    #[command(flatten)]
    import: Options,
}

impl Arguments {
    pub(super) fn run(self) -> Result<ExitCode, Stop> {
        let file = &source(self.layout)?;
        let imported = layout(file, &self.import, "traffic", true)?;
        let request = Request { agents: self.agents.into(), seed: self.seed };
        let (traffic, [missions, plan]) =
            Traffic::of(&imported, request).map_err(|failure| Stop::wrong(file, failure))?;
        let mut out = self.printed.out(false);
        match self.printed.form() {
            Form::Table => report::traffic_table(&traffic, &mut out)?,
            Form::Json => report::json(&traffic, &mut out)?,
            Form::Csv => report::traffic_csv(&traffic, &mut out)?,
        }
        out.flush()?;
        if let Some(directory) = &self.output {
            let ground = Ground { imported: &imported, level: imported.layout.largest_level() };
            map::draw(&plan, Some(ground), directory, &mut notes())?;
            write_to(&directory.join("missions.json"), &missions.to_json())?;
            write_to(&directory.join("plan.json"), &plan.to_json())?;
        }
        Ok(ExitCode::SUCCESS)
    }
}
