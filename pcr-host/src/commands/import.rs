//! `pcr import`.

use super::{STATUSES, Stop, scenario, warn, write_to};
use clap::Args;
use pcr_host::import::{Format, Options};
use pcr_host::input;
use std::io::{self, Write};
use std::path::PathBuf;
use std::process::ExitCode;

const EXAMPLES: &str = "\
Examples:
  pcr import nav2 warehouse.geojson --route 0:50 --route 90:7@5 -o fleet.json   two routes on a nav2 route graph
  pcr import vda5050 robot1.json robot2.json --radius 0.4 -o fleet.json         an agent for each order or state
  pcr regions warehouse.geojson --route 0:50 --route 90:7@5 --radius 0.4        other commands read the format as well";

/// Write a layout with routes, an order or a plan in another format as a scenario file
#[derive(Args)]
#[command(after_help = format!("{EXAMPLES}\n\n{STATUSES}"))]
pub(super) struct Arguments {
    /// Format of the file
    #[arg(value_enum)]
    format: Format,
    /// The file; `-` reads standard input. Several orders or states (VDA 5050), or paths, become agents of one scenario
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
    /// The scenario file; standard output if left out
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    #[command(flatten)]
    import: Options,
}

impl Arguments {
    pub(super) fn run(self) -> Result<ExitCode, Stop> {
        let import = Options { from: Some(self.format), ..self.import };
        let scenario = match self.files.as_slice() {
            [file] => scenario(Some(file), &import)?,
            files => {
                let (mut scenario, warnings) = input::read_all(files, &import)?;
                warnings.iter().for_each(|(file, warnings)| warn(file, warnings));
                scenario.give_margin(import.margin.unwrap_or(0.0));
                scenario
            }
        };
        match &self.output {
            Some(output) => write_to(output, &scenario)?,
            None => io::stdout().lock().write_all(scenario.to_json().as_bytes())?,
        }
        Ok(ExitCode::SUCCESS)
    }
}
