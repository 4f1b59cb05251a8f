//! Sources of scenarios: the files that are named, otherwise standard input.

use super::help::{DRIVING, STANDING, options_without_effect};
use super::{CliError, acknowledge, say, warn};
use pcr_formats::import::{ImportOptions, ImportedLayout, InputKind, Warnings, shortened};
use pcr_formats::input::InputError;
use pcr_formats::scenario::{Agent, Scenario, label, printable};
use pcr_formats::{input, output};
use pcr_planning::exclusion_table::ExclusionIndex;
use pcr_planning::memory_budget::MemoryDemand;
use std::io::{self, IsTerminal};
use std::path::{Path, PathBuf};

/// The files to be read; `-` for standard input where none is named and somebody writes to it.
pub(super) fn sources(files: Vec<PathBuf>) -> Result<Vec<PathBuf>, CliError> {
    named(files, "name a scenario, or see pcr demo")
}

/// The same of a command that reads other formats only.
pub(super) fn foreign_sources(files: Vec<PathBuf>) -> Result<Vec<PathBuf>, CliError> {
    named(files, "name a file of that format, as docs/reference/layouts.md lists them")
}

/// The files, or standard input, or what to do where nothing comes from there.
fn named(files: Vec<PathBuf>, hint: &str) -> Result<Vec<PathBuf>, CliError> {
    if files.iter().filter(|file| *file == Path::new("-")).count() > 1 {
        return Err(CliError::arguments("FILE: - is given twice; standard input can be read once"));
    }
    if !files.is_empty() {
        // All of them before the first is answered: an answer may be a file.
        files.iter().for_each(|file| output::keep(file));
        return Ok(files);
    }
    if io::stdin().is_terminal() {
        return Err(CliError::arguments(format!("no FILE, and nothing comes in by a pipe; {hint}")));
    }
    output::keep(Path::new("-"));
    Ok(vec![PathBuf::from("-")])
}

/// The one file to be read.
pub(super) fn source(file: Option<PathBuf>) -> Result<PathBuf, CliError> {
    let mut files = sources(file.into_iter().collect())?;
    // There is one.
    Ok(files.pop().unwrap_or_default())
}

/// The one layout to be read.
pub(super) fn layout_source(file: Option<PathBuf>) -> Result<PathBuf, CliError> {
    let hint = "name a layout, such as the route graph of a site; docs/reference/layouts.md lists the formats";
    let mut files = named(file.into_iter().collect(), hint)?;
    Ok(files.pop().unwrap_or_default())
}

/// What is read beside the files themselves is not written over, either.
fn keep(import: &ImportOptions) {
    import.fleet.iter().for_each(|fleet| output::keep(fleet));
}

/// The scenario in a file, in whatever format; warnings about it are told.
pub(super) fn scenario(file: &Path, import: &ImportOptions) -> Result<Scenario, CliError> {
    scenario_from(file, text(file)?, import)
}

/// The same in a text that is read already.
pub(super) fn scenario_from(file: &Path, text: String, import: &ImportOptions) -> Result<Scenario, CliError> {
    keep(import);
    ask_to_read(file, &text, import)?;
    let scenario = apply_margin_and_warn(file, input::read_from(file, text, import)?, import)?;
    refuse_margin(&scenario, import).map_err(|why| CliError::wrong(file, why))?;
    Ok(scenario)
}

/// The text of a file, which is not to be replaced by something else.
pub(super) fn text(file: &Path) -> Result<String, CliError> {
    ask_for(file)?;
    output::keep(file);
    Ok(input::read_text(file)?)
}

/// The text of poses with times, of which a tree is made.
pub(super) fn pose_text(file: &Path, import: &ImportOptions) -> Result<String, CliError> {
    keep(import);
    let text = text(file)?;
    ask_to_read(file, &text, import)?;
    Ok(text)
}

/// A bag is read piece by piece, and not to be replaced by something else.
pub(super) fn keep_bag(file: &Path, import: &ImportOptions) {
    keep(import);
    output::keep(file);
}

/// Asks for the memory that it takes to read a file. Refuses a table of locks, which is no text.
fn ask_for(file: &Path) -> Result<(), CliError> {
    if ExclusionIndex::is_one(file) {
        return Err(CliError::wrong(file, "this is a table of locks already; pcr locks reads it, with --edge"));
    }
    // What has no size, such as standard input, is not known before.
    let bytes = std::fs::metadata(file).map_or(0, |there| there.len());
    MemoryDemand::Text(bytes).ask().map_err(|large| CliError::wrong(file, large))
}

/// Asks for the memory of the tree that is made of a text. Scenarios are read agent by agent.
fn ask_to_read(file: &Path, text: &str, import: &ImportOptions) -> Result<(), CliError> {
    match input::kind_of(file, text, import) {
        InputKind::Scenario => Ok(()),
        _ => MemoryDemand::Tree(text.len() as u64).ask().map_err(|large| CliError::wrong(file, large)),
    }
}

/// Asks for the memory that it takes to answer about a scenario, beside the answer.
fn ask_to_answer(file: &Path, scenario: &Scenario) -> Result<(), CliError> {
    let agents = scenario.agents.len();
    let segments: usize = scenario.agents.iter().map(|agent| agent.path.len()).sum();
    MemoryDemand::Answer { agents, segments }.ask().map_err(|large| CliError::wrong(file, large))
}

/// A scenario that was read, with the margin that is asked for; warnings about it are told.
fn apply_margin_and_warn(
    file: &Path,
    (mut scenario, warnings): (Scenario, Warnings),
    import: &ImportOptions,
) -> Result<Scenario, CliError> {
    ask_to_answer(file, &scenario)?;
    warn(file, &warnings);
    if warnings.is_empty() {
        // Those of whoever has written it: what is left out of a file is left out of all that is made of it.
        say(file, scenario.warnings.iter().map(|line| shortened(line)));
    }
    acknowledge(&mut scenario.warnings);
    give_margin(&mut scenario, import);
    Ok(scenario)
}

/// Gives the margin that is asked for to all agents that have none.
pub(super) fn give_margin(scenario: &mut Scenario, import: &ImportOptions) {
    if let Some(margin) = import.margin {
        scenario.give_margin(margin);
    }
}

/// Why no agent takes a margin.
const OWN_MARGINS: &str = "every agent has a margin of its own";

/// Whether any agent takes the margin that is asked for, or has it already.
fn takes_margin(scenario: &Scenario, margin: f64) -> bool {
    let takes = |agent: &Agent| agent.margin == 0.0 || agent.margin == margin;
    scenario.agents.is_empty() || scenario.agents.iter().any(takes)
}

/// Refuses a margin that no agent of the only scenario takes.
pub(super) fn refuse_margin(scenario: &Scenario, import: &ImportOptions) -> Result<(), String> {
    match import.margin {
        Some(margin) if !takes_margin(scenario, margin) => Err(format!("--margin has no effect: {OWN_MARGINS}")),
        _ => Ok(()),
    }
}

/// Refuses a margin for a command that looks at the discs themselves.
pub(super) fn without_margin(import: &ImportOptions) -> Result<(), CliError> {
    match import.margin {
        Some(_) => Err(CliError::arguments(
            "--margin has no effect: this is about contacts of the discs themselves; pcr regions and pcr plan keep margins",
        )),
        None => Ok(()),
    }
}

/// What one answer is about.
pub(super) enum ScenarioSource {
    /// The only file.
    File(PathBuf),
    /// One of several.
    OneOf(PathBuf),
    /// One of several whose answers would have the same name; they are named by the path.
    Twin(PathBuf),
    /// Orders and states, or paths, of one fleet.
    Together(Vec<PathBuf>),
}

/// The scenarios that some files hold. Files of orders, states or paths, which have an agent each, are of one fleet.
pub(super) fn gathered(files: Vec<PathBuf>, import: &ImportOptions) -> Result<Vec<ScenarioSource>, CliError> {
    let files = sources(files)?;
    if files.len() > 1 && input::are_of_one_fleet(&files, import) {
        return Ok(vec![ScenarioSource::Together(files)]);
    }
    match <[PathBuf; 1]>::try_from(files) {
        Ok([only]) => Ok(vec![ScenarioSource::File(only)]),
        Err(several) => separate_sources(several, import),
    }
}

/// Several files that are answered one after the other, so that their answers can be told apart. They are read once more for that: the
/// first answer is printed before the last file is read. Refuses options that have no effect on any of them.
fn separate_sources(files: Vec<PathBuf>, import: &ImportOptions) -> Result<Vec<ScenarioSource>, CliError> {
    let read = |file: &PathBuf| {
        // What is no file can be read once only.
        std::fs::metadata(file).ok().filter(|there| there.is_file())?;
        let (scenario, warnings) = input::read_one_of(file, input::read_text(file).ok()?, import).ok()?;
        let takes_margin = import.margin.is_none_or(|margin| takes_margin(&scenario, margin));
        Some((scenario.name, takes_margin, warnings))
    };
    let read: Vec<Option<(String, bool, Warnings)>> = files.iter().map(read).collect();
    let warnings: Vec<&Warnings> = read.iter().flatten().map(|(.., warnings)| warnings).collect();
    let margin = || (!read.iter().flatten().any(|read| read.1)).then_some(("--margin", OWN_MARGINS));
    if warnings.len() == files.len()
        && let Some((option, why)) = import.unused(&warnings).or_else(margin)
    {
        return Err(CliError::arguments(format!("{option} has no effect on any of these files: {why}")));
    }
    let named = files.iter().zip(read);
    let names: Vec<String> = named.map(|(file, read)| read.map_or_else(|| input::stem(file), |read| read.0)).collect();
    let is_twin = |name: &String| !name.is_empty() && names.iter().filter(|other| *other == name).count() > 1;
    let twins: Vec<bool> = names.iter().map(is_twin).collect();
    let source =
        |(file, twin): (PathBuf, bool)| if twin { ScenarioSource::Twin(file) } else { ScenarioSource::OneOf(file) };
    Ok(files.into_iter().zip(twins).map(source).collect())
}

impl ScenarioSource {
    /// The file, or the first of them, for messages.
    pub(super) fn file(&self) -> &Path {
        match self {
            Self::File(file) | Self::OneOf(file) | Self::Twin(file) => file,
            Self::Together(files) => files.first().map_or(Path::new("-"), |first| first),
        }
    }

    /// What an answer is called where there is no scenario.
    pub(super) fn name(&self) -> String {
        self.display_name(&label(&input::stem(self.file())))
    }

    /// What the answer about a scenario of this name is called.
    pub(super) fn display_name(&self, name: &str) -> String {
        match self {
            Self::Twin(file) => printable(&file.to_string_lossy()),
            Self::File(_) | Self::OneOf(_) | Self::Together(_) => name.to_owned(),
        }
    }

    /// Whether it is scenarios one after the other on standard input.
    pub(super) fn is_lines(&self, import: &ImportOptions) -> bool {
        matches!(self, Self::File(file) | Self::OneOf(file) if file == Path::new("-")) && import.from.is_none()
    }

    /// Whether it is a scenario file, which a plan may replace.
    pub(super) fn is_scenario(&self, import: &ImportOptions) -> Result<bool, CliError> {
        match self {
            Self::File(file) | Self::OneOf(file) | Self::Twin(file) => {
                Ok(input::kind(file, import)? == InputKind::Scenario)
            }
            Self::Together(_) => Ok(false),
        }
    }

    pub(super) fn scenario(&self, import: &ImportOptions) -> Result<Scenario, CliError> {
        match self {
            Self::File(file) | Self::OneOf(file) | Self::Twin(file) => self.scenario_from(text(file)?, import),
            Self::Together(files) => together(files, import),
        }
    }

    /// The same in a text that is read already.
    pub(super) fn scenario_from(&self, text: String, import: &ImportOptions) -> Result<Scenario, CliError> {
        let file = self.file();
        if let Self::File(_) = self {
            return scenario_from(file, text, import);
        }
        keep(import);
        ask_to_read(file, &text, import)?;
        apply_margin_and_warn(file, input::read_one_of(file, text, import)?, import)
    }
}

/// The scenario in several files of orders, states or paths.
pub(super) fn together(files: &[PathBuf], import: &ImportOptions) -> Result<Scenario, CliError> {
    keep(import);
    files.iter().try_for_each(|file| ask_for(file))?;
    let (mut scenario, warnings) = input::read_all(files, import)?;
    warnings.iter().for_each(|(file, warnings)| warn(file, warnings));
    acknowledge(&mut scenario.warnings);
    let first = files.first().map_or(Path::new("-"), |first| first);
    ask_to_answer(first, &scenario)?;
    give_margin(&mut scenario, import);
    refuse_margin(&scenario, import).map_err(|why| CliError::wrong(first, why))?;
    Ok(scenario)
}

/// The vehicles of `pcr fleet` and of `pcr serve --demo`, which are as they are.
pub(super) const FLEET: &str = "fleet";

/// The layout in a file for a command, whose vehicles move or do not.
pub(super) fn layout(
    file: &Path,
    import: &ImportOptions,
    command: &str,
    moves: bool,
) -> Result<ImportedLayout, CliError> {
    refuse_useless(import, command)?;
    layout_from(file, &text(file)?, import, command, moves)
}

/// Refuses options that do nothing in a command that reads layouts.
fn refuse_useless(import: &ImportOptions, command: &str) -> Result<(), CliError> {
    let why = match command {
        "traffic" => "traffic has random routes; pcr plan takes given ones",
        DRIVING => "delays are of all edges as they are",
        STANDING => "locks are of all ways of a vehicle, at any speed",
        _ => "this command lists what is in the file",
    };
    match import.one_of(options_without_effect(command)) {
        Some(option) => Err(CliError::arguments(format!("{option} has no effect: {why}"))),
        None => Ok(()),
    }
}

/// The layout in a text that is read already, for a command.
pub(super) fn layout_from(
    file: &Path,
    text: &str,
    import: &ImportOptions,
    command: &str,
    moves: bool,
) -> Result<ImportedLayout, CliError> {
    refuse_useless(import, command)?;
    // Where nothing depends on the size of the vehicle, none is assumed and warned about, nor is one smaller than an outline.
    let import = &match command {
        "nodes" => ImportOptions { radius: Some(f64::INFINITY), ..import.clone() },
        _ => import.clone(),
    };
    keep(import);
    ask_to_read(file, text, import)?;
    let (mut imported, warnings) = input::read_layout_from(file, text, import, moves).map_err(|error| match error {
        // There is no --from to say it with.
        InputError::NoLayout(_) if command == FLEET => {
            CliError::wrong(file, "not known as a layout by its name or content")
        }
        error => error.into(),
    })?;
    warn(file, &warnings);
    acknowledge(&mut imported.layout.warnings);
    if command == STANDING {
        imported.layout.include_corners();
    }
    Ok(imported)
}
