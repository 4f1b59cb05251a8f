//! Sources of scenarios: the files that are named, otherwise standard input.

use super::help::{DRIVING, STANDING, useless};
use super::{Stop, say, warn};
use pcr_formats::import::{Imported, Kind, Options, shortened};
use pcr_formats::scenario::Scenario;
use pcr_formats::{input, output};
use pcr_planning::locks::rounded;
use std::io::{self, IsTerminal};
use std::path::{Path, PathBuf};

/// The files to be read; `-` for standard input where none is named and somebody writes to it.
pub(super) fn sources(files: Vec<PathBuf>) -> Result<Vec<PathBuf>, Stop> {
    named(files, "name a scenario, or see pcr demo")
}

/// The same of a command that reads other formats only.
pub(super) fn foreign_sources(files: Vec<PathBuf>) -> Result<Vec<PathBuf>, Stop> {
    named(files, "name a file of that format, as docs/layouts.md lists them")
}

/// The files, or standard input, or what to do where nothing comes from there.
fn named(files: Vec<PathBuf>, hint: &str) -> Result<Vec<PathBuf>, Stop> {
    if files.iter().filter(|file| *file == Path::new("-")).count() > 1 {
        return Err(Stop::arguments("FILE: - is given twice; standard input can be read once"));
    }
    if !files.is_empty() {
        // All of them before the first is answered: an answer may be a file.
        files.iter().for_each(|file| output::keep(file));
        return Ok(files);
    }
    if io::stdin().is_terminal() {
        return Err(Stop::arguments(format!("no FILE, and nothing comes in by a pipe; {hint}")));
    }
    output::keep(Path::new("-"));
    Ok(vec![PathBuf::from("-")])
}

/// The one file to be read.
pub(super) fn source(file: Option<PathBuf>) -> Result<PathBuf, Stop> {
    let mut files = sources(file.into_iter().collect())?;
    // There is one.
    Ok(files.pop().unwrap_or_default())
}

/// The one layout to be read.
pub(super) fn layout_source(file: Option<PathBuf>) -> Result<PathBuf, Stop> {
    let hint = "name a layout, such as the route graph of a site; docs/layouts.md lists the formats";
    let mut files = named(file.into_iter().collect(), hint)?;
    Ok(files.pop().unwrap_or_default())
}

/// What is read beside the files themselves is not written over, either.
fn keep(import: &Options) {
    import.fleet.iter().for_each(|fleet| output::keep(fleet));
}

/// The scenario in a file, in whatever format; warnings about it are told.
pub(super) fn scenario(file: &Path, import: &Options) -> Result<Scenario, Stop> {
    keep(import);
    let (mut scenario, warnings) = input::read(file, import)?;
    warn(file, &warnings);
    if warnings.is_empty() {
        // Those of whoever has written it: what is left out of a file is left out of all that is made of it.
        say(file, scenario.warnings.iter().map(|line| shortened(line)));
    }
    scenario.give_margin(import.margin.unwrap_or(0.0));
    Ok(scenario)
}

/// Refuses a margin for a command that looks at the discs themselves.
pub(super) fn without_margin(import: &Options) -> Result<(), Stop> {
    match import.margin {
        Some(_) => Err(Stop::arguments(
            "--margin is of no use: this is about contacts of the discs themselves; pcr regions and pcr plan keep margins",
        )),
        None => Ok(()),
    }
}

/// What one answer is about.
pub(super) enum Source {
    File(PathBuf),
    /// One of several files of the same name in other folders; answers are named by the path.
    Twin(PathBuf),
    /// Orders and states, or paths, of one fleet.
    Together(Vec<PathBuf>),
}

/// The scenarios that some files hold. Files of orders, states or paths, which have an agent each, are of one fleet.
pub(super) fn gathered(files: Vec<PathBuf>, import: &Options) -> Result<Vec<Source>, Stop> {
    let files = sources(files)?;
    if files.len() > 1 && input::are_of_one_fleet(&files, import) {
        return Ok(vec![Source::Together(files)]);
    }
    Ok(apart(files))
}

/// Files that are answered one after the other, so that their answers can be told apart.
pub(super) fn apart(files: Vec<PathBuf>) -> Vec<Source> {
    let stems: Vec<String> = files.iter().map(|file| input::stem(file)).collect();
    let is_twin = |stem: &String| !stem.is_empty() && stems.iter().filter(|other| *other == stem).count() > 1;
    let twins: Vec<bool> = stems.iter().map(is_twin).collect();
    let source = |(file, twin): (PathBuf, bool)| if twin { Source::Twin(file) } else { Source::File(file) };
    files.into_iter().zip(twins).map(source).collect()
}

impl Source {
    /// The file, or the first of them, for messages.
    pub(super) fn file(&self) -> &Path {
        match self {
            Self::File(file) | Self::Twin(file) => file,
            Self::Together(files) => files.first().map_or(Path::new("-"), |first| first),
        }
    }

    /// What an answer is called where the scenario has no name.
    pub(super) fn name(&self) -> String {
        match self {
            Self::Twin(file) => file.to_string_lossy().into_owned(),
            Self::File(_) | Self::Together(_) => input::stem(self.file()),
        }
    }

    /// Whether it is scenarios one after the other on standard input.
    pub(super) fn is_lines(&self, import: &Options) -> bool {
        matches!(self, Self::File(file) if file == Path::new("-")) && import.from.is_none()
    }

    /// Whether it is a scenario file, which a plan may replace.
    pub(super) fn is_scenario(&self, import: &Options) -> Result<bool, Stop> {
        match self {
            Self::File(file) | Self::Twin(file) => Ok(input::kind(file, import)? == Kind::Scenario),
            Self::Together(_) => Ok(false),
        }
    }

    pub(super) fn scenario(&self, import: &Options) -> Result<Scenario, Stop> {
        match self {
            Self::File(file) => scenario(file, import),
            Self::Twin(file) => {
                let mut scenario = scenario(file, import)?;
                if scenario.name == input::stem(file) {
                    scenario.name = self.name();
                }
                Ok(scenario)
            }
            Self::Together(files) => together(files, import),
        }
    }
}

/// The scenario in several files of orders, states or paths.
pub(super) fn together(files: &[PathBuf], import: &Options) -> Result<Scenario, Stop> {
    keep(import);
    let (mut scenario, warnings) = input::read_all(files, import)?;
    warnings.iter().for_each(|(file, warnings)| warn(file, warnings));
    scenario.give_margin(import.margin.unwrap_or(0.0));
    Ok(scenario)
}

/// The layout in a file for a command, whose vehicles move or do not.
pub(super) fn layout(file: &Path, import: &Options, command: &str, moves: bool) -> Result<Imported, Stop> {
    let why = match command {
        "traffic" => "traffic has random routes; pcr plan takes given ones",
        DRIVING => "delays are of all edges as they are",
        STANDING => "locks are of all ways of a vehicle, at any speed",
        _ => "this command lists what is in the file",
    };
    if let Some(option) = import.one_of(useless(command)) {
        return Err(Stop::arguments(format!("{option} is of no use: {why}")));
    }
    // Where nothing depends on the size of the vehicle, none is assumed and warned about.
    let import = &match command {
        "nodes" => Options { radius: Some(1.0), ..import.clone() },
        _ => import.clone(),
    };
    keep(import);
    let (imported, warnings) = input::read_layout(file, import, moves)?;
    warn(file, &warnings);
    if matches!(command, "locks" | DRIVING | STANDING) {
        say(file, rounded(&imported.layout));
    }
    Ok(imported)
}
