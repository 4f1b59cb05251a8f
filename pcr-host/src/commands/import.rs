//! `pcr import`.

use super::scenario_sources::{foreign_sources, together};
use super::{CliError, scenario, statuses, write_to};
use clap::Args;
use pcr_formats::import::{ImportOptions, InputFormat};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

const EXAMPLES: &str = "\
Examples:
  pcr import nav2 warehouse.geojson --route 0:50 --route 90:7@5 -o fleet.json
  pcr import vda5050 robot1.json robot2.json --radius 0.4 -o fleet.json
  pcr regions warehouse.geojson --route 0:50 --radius 0.4   they read it as well";

/// Write routes, an order or a plan of other formats as a scenario
#[derive(Args)]
#[command(after_help = format!("{EXAMPLES}\n\n{}", statuses("wrong arguments, or a file that cannot be read or was refused")))]
pub(super) struct ImportArgs {
    /// Format of the file
    #[arg(value_enum)]
    format: InputFormat,
    /// The file; standard input if left out or `-`. Several orders or states (VDA 5050), or paths, become agents of one scenario
    #[arg(value_name = "FILE")]
    files: Vec<PathBuf>,
    /// The scenario file; standard output if left out or `-`
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    #[command(flatten)]
    import: ImportOptions,
}

impl ImportArgs {
    pub(super) fn run(self) -> Result<ExitCode, CliError> {
        if self.import.from.is_some() {
            return Err(CliError::arguments("--from: the format is named already, as the first argument"));
        }
        let import = ImportOptions { from: Some(self.format), ..self.import };
        let scenario = match foreign_sources(self.files)?.as_slice() {
            [file] => scenario(file, &import)?,
            files => together(files, &import)?,
        };
        match &self.output {
            Some(output) => write_to(output, &scenario.to_json())?,
            None => write_to(Path::new("-"), &scenario.to_json())?,
        }
        Ok(ExitCode::SUCCESS)
    }
}
