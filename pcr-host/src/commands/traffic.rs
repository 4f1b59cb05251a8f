//! `pcr traffic`.

use super::{Form, STATUSES, Stop, WRONG_INPUT, map, warn, write_to};
use clap::Args;
use pcr_host::import::Options;
use pcr_host::picture::Ground;
use pcr_host::traffic::{Request, Traffic};
use pcr_host::{input, report};
use std::io::{self, BufWriter, Write};
use std::path::PathBuf;
use std::process::ExitCode;

const EXAMPLES: &str = "\
Examples:
  pcr traffic warehouse.geojson --agents 50 --seed 1 --radius 0.4              who waits how long, and the throughput
  pcr traffic warehouse.geojson --agents 50 --seed 1 --radius 0.4 -o traffic   and scenarios and pictures in traffic/";

/// Plan random missions on a layout: who waits, what collides without a plan, how many missions an hour
#[derive(Args)]
#[command(after_help = format!("{EXAMPLES}\n\n{STATUSES}"))]
pub(super) struct Arguments {
    /// The layout; `-` reads standard input
    layout: PathBuf,
    /// Agents, a mission each
    #[arg(long, value_name = "N", default_value_t = 50, value_parser = clap::value_parser!(u16).range(1..))]
    agents: u16,
    /// Another number gives other missions
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Form of the output; CSV has a line a mission
    #[arg(long, value_enum, default_value_t = Form::Table)]
    format: Form,
    /// Write the missions (missions.json), the plan (plan.json) and pictures of it to this directory as well
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    #[command(flatten)]
    import: Options,
}

impl Arguments {
    pub(super) fn run(self) -> Result<ExitCode, Stop> {
        if !self.import.routes.is_empty() {
            return Err(Stop::Error(
                "--route: traffic has random routes; pcr plan takes given ones".into(),
                WRONG_INPUT,
            ));
        }
        let (imported, warnings) = input::read_layout(&self.layout, &self.import, true)?;
        warn(&self.layout, &warnings);
        let request = Request { agents: self.agents.into(), seed: self.seed };
        let (traffic, [missions, plan]) =
            Traffic::of(&imported, request).map_err(|failure| Stop::wrong(Some(&self.layout), failure))?;
        let mut out = BufWriter::new(io::stdout().lock());
        match self.format {
            Form::Table => report::traffic_table(&traffic, &mut out)?,
            Form::Json => report::json(&traffic, &mut out)?,
            Form::Csv => report::traffic_csv(&traffic, &mut out)?,
        }
        out.flush()?;
        if let Some(directory) = &self.output {
            let ground = Ground { imported: &imported, level: imported.layout.largest_level() };
            map::draw(&plan, Some(ground), directory, &mut io::stderr())?;
            write_to(&directory.join("missions.json"), &missions)?;
            write_to(&directory.join("plan.json"), &plan)?;
        }
        Ok(ExitCode::SUCCESS)
    }
}
