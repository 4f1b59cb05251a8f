//! `pcr map`.

use super::scenario_sources::{source, without_margin};
use super::{CliError, SCENARIOS, folder, quiet, say, scenario, statuses, warn_of_boxes};
use crate::progress::ProgressLine;
use clap::Args;
use clap::builder::NonEmptyStringValueParser;
use pcr_core::Motion;
use pcr_drawing::{self as picture, LayoutLevelView};
use pcr_formats::import::ImportOptions;
use pcr_formats::scenario::Scenario;
use pcr_formats::warning::WarningCode;
use pcr_planning::failure::ComputationError;
use pcr_planning::fleet::Fleet;
use pcr_planning::regions;
use pcr_planning::report::counted;
use pcr_planning::{agent_regions, memory_budget};
use std::collections::HashSet;
use std::ffi::OsStr;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

const EXAMPLES: &str = "\
Examples:
  pcr map fleet.json -o pictures                 begin with pictures/index.html
  pcr map site.json --agent 7 -o pictures        agent 7 and those that come near it
  pcr demo --scenario | pcr map -o pictures      the paper's 12 agents";

/// Agents of which all are drawn: some 20 ms of a core each, a picture of each in two formats, and 50 kB of the page.
const MOST: usize = 2000;

/// What a drawn region takes \[bytes\].
const SHAPE_BYTES: u64 = 4096;

/// Draw a scenario: its paths, and the collision map of each agent
#[derive(Args)]
#[command(after_help = format!("{EXAMPLES}\n\n{}", statuses(SCENARIOS)))]
pub(super) struct MapArgs {
    /// Scenario (JSON); standard input if left out or `-`
    file: Option<PathBuf>,
    /// Directory for the pictures; created if it does not exist; its files are overwritten
    #[arg(short, long, value_name = "DIR", value_parser = folder())]
    output: PathBuf,
    /// Only the map of this agent, by number or label, with all agents that come near it; may be given several times
    #[arg(long = "agent", value_name = "AGENT", value_parser = NonEmptyStringValueParser::new())]
    agents: Vec<String>,
    #[command(flatten)]
    import: ImportOptions,
}

impl MapArgs {
    pub(super) fn run(self) -> Result<ExitCode, CliError> {
        without_margin(&self.import)?;
        let file = &source(self.file.clone())?;
        let scenario = scenario(file, &self.import)?;
        // What is wrong with the scenario is said before anything is written.
        let named = |failure: ComputationError| CliError::wrong(file, failure);
        let fleet = Fleet::<f64>::of_bodies(&scenario).map_err(|refused| named(refused.into()))?;
        let (scenario, egos) = self.asked(scenario, fleet.motions()).map_err(named)?;
        ask_for_regions(&scenario).map_err(named)?;
        let mut out: Box<dyn Write> = if quiet() { Box::new(io::sink()) } else { Box::new(io::stdout().lock()) };
        draw(&scenario, egos.as_deref(), None, &self.output, &mut out)?;
        Ok(ExitCode::SUCCESS)
    }

    /// Those who are asked for and all that come near them, and the places of the former among them; all agents where nobody is asked for.
    fn asked(
        &self,
        mut scenario: Scenario,
        motions: Vec<Motion<'_, f64>>,
    ) -> Result<(Scenario, Option<Vec<usize>>), ComputationError> {
        if self.agents.is_empty() {
            return are_few(motions.len(), "without --agent, maps are drawn").map(|()| (scenario, None));
        }
        let ids = self.agents.iter().map(|asked| regions::find(&scenario, asked)).collect::<Result<HashSet<_>, _>>()?;
        let (grid, mut near, mut some) = (agent_regions::grid(&motions), Vec::new(), HashSet::new());
        for (place, _) in scenario.agents.iter().enumerate().filter(|(_, agent)| ids.contains(&agent.id)) {
            grid.around(place, &mut near);
            some.extend(near.iter().map(|&other| other as usize).chain([place]));
        }
        let mut place = 0..;
        scenario.agents.retain(|_| place.next().is_some_and(|place| some.contains(&place)));
        let egos = scenario.agents.iter().enumerate().filter(|(_, agent)| ids.contains(&agent.id));
        let egos = egos.map(|(place, _)| place).collect();
        Ok((scenario, Some(egos)))
    }
}

/// Refuses more agents than maps are drawn of.
pub(super) fn are_few(agents: usize, what: &'static str) -> Result<(), ComputationError> {
    if agents <= MOST { Ok(()) } else { Err(ComputationError::TooMany { what, agents, most: MOST }) }
}

/// Asks for what the pictures of all regions take.
pub(super) fn ask_for_regions(scenario: &Scenario) -> Result<(), ComputationError> {
    let fleet = Fleet::<f64>::of_bodies(scenario)?;
    // Each region is drawn for both of its agents, in the page and in a picture.
    let shapes = 2 * regions::table(scenario, &fleet.motions())?.len() as u64;
    Ok(memory_budget::ask(shapes * SHAPE_BYTES, || format!("pictures of {shapes} regions"))?)
}

/// Draws a scenario, on a layout if there is one, to a directory; with the maps of the agents at the places `egos`, or of all.
pub(super) fn draw(
    scenario: &Scenario,
    egos: Option<&[usize]>,
    ground: Option<LayoutLevelView<'_>>,
    directory: &Path,
    out: &mut impl Write,
) -> Result<(), CliError> {
    let progress = ProgressLine::new("pictures");
    let written = picture::write(scenario, egos, ground, directory, &mut |done, total| progress.set(done, total));
    drop(progress);
    let written = written.map_err(|error| CliError::not_written(directory, &error))?;
    warn_of_boxes(directory, &written);
    let files = written.files;
    warn_of_earlier(directory, &files);
    let page = files.iter().find(|file| file.extension().is_some_and(|extension| extension == "html"));
    if let Some(first) = page.or(files.first()) {
        writeln!(out, "Pictures: {} files in {}; begin with {}", files.len(), directory.display(), first.display())?;
    }
    Ok(())
}

/// Tells of maps in a folder that are of an earlier run: the page does not have their agents.
fn warn_of_earlier(directory: &Path, written: &[PathBuf]) {
    let written: HashSet<Option<&OsStr>> = written.iter().map(|file| file.file_name()).collect();
    let there = fs::read_dir(directory).into_iter().flatten().flatten().map(|entry| entry.file_name());
    let is_map = |name: &str| name.starts_with("ecm-") && (name.ends_with(".svg") || name.ends_with(".png"));
    let earlier: Vec<_> =
        there.filter(|name| is_map(&name.to_string_lossy()) && !written.contains(&Some(name.as_os_str()))).collect();
    if let Some(first) = earlier.iter().min() {
        let (count, first) = (counted(earlier.len(), "picture"), first.display());
        let text = format!("of an earlier run, with other agents: {count}, such as {first}");
        say(directory, [WarningCode::EarlierPictures.text(text)]);
    }
}
