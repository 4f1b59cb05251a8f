//! `pcr map`.

use super::sources::source;
use super::{STATUSES, Stop, quiet, scenario};
use crate::progress::Progress;
use clap::Args;
use pcr_drawing::{self as picture, Ground};
use pcr_formats::import::Options;
use pcr_formats::scenario::Scenario;
use pcr_planning::fleet::Fleet;
use pcr_planning::regions::{self, Failure};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

const EXAMPLES: &str = "\
Examples:
  pcr map fleet.json -o pictures                 begin with pictures/index.html
  pcr demo --scenario | pcr map -o pictures      the paper's 12 agents";

/// Draw a scenario: its paths, and the collision map of each agent
#[derive(Args)]
#[command(after_help = format!("{EXAMPLES}\n\n{STATUSES}"))]
pub(super) struct Arguments {
    /// Scenario (JSON); standard input if left out or `-`
    file: Option<PathBuf>,
    /// Directory for the pictures; created where it does not exist, files in it are overwritten
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    #[command(flatten)]
    import: Options,
}

impl Arguments {
    pub(super) fn run(self) -> Result<ExitCode, Stop> {
        let file = &source(self.file)?;
        let scenario = scenario(file, &self.import)?;
        // What is wrong with the scenario is said before anything is written.
        let named = |failure: Failure| Stop::wrong(file, failure);
        let fleet = Fleet::<f64>::new(&scenario).map_err(|refused| named(refused.into()))?;
        regions::table(&scenario, &fleet.motions()).map_err(named)?;
        let mut out: Box<dyn Write> = if quiet() { Box::new(io::sink()) } else { Box::new(io::stdout().lock()) };
        draw(&scenario, None, &self.output, &mut out)?;
        Ok(ExitCode::SUCCESS)
    }
}

/// Draws a scenario, on a layout if there is one, to a directory.
pub(super) fn draw(
    scenario: &Scenario,
    ground: Option<Ground<'_>>,
    directory: &Path,
    out: &mut impl Write,
) -> Result<(), Stop> {
    let progress = Progress::new("pictures");
    let files = picture::write(scenario, ground, directory, &mut |done, total| progress.set(done, total));
    drop(progress);
    let files = files.map_err(|error| Stop::not_written(directory, &error))?;
    let page = files.iter().find(|file| file.extension().is_some_and(|extension| extension == "html"));
    if let Some(first) = page.or(files.first()) {
        writeln!(out, "Pictures: {} files in {}; begin with {}", files.len(), directory.display(), first.display())?;
    }
    Ok(())
}
