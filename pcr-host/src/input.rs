//! Where scenarios come from, and errors that say where the fault is.

use crate::import::{self, Format, ImportError, Imported, Options, Warnings};
use crate::scenario::{Scenario, ScenarioError};
use std::fmt;
use std::fs;
use std::io::{self, BufRead, Read};
use std::path::{Path, PathBuf};

/// Why there is no scenario.
#[derive(Debug)]
#[non_exhaustive]
pub enum InputError {
    /// The file, or standard input (`None`), could not be read.
    Unreadable(Option<PathBuf>, io::Error),
    /// It is not text in UTF-8.
    NotText(Option<PathBuf>),
    /// It is not a scenario.
    Refused(Option<PathBuf>, ScenarioError),
    /// It is not of the format that it is read in.
    Foreign(Option<PathBuf>, Format, ImportError),
    /// It has to be a layout, and is none that is known, or (`true`) empty.
    NoLayout(Option<PathBuf>, bool),
    /// It cannot be read together with others.
    Single(Option<PathBuf>),
    /// It is a scenario, which has routes and vehicles of its own.
    HasAgents(Option<PathBuf>),
}

impl fmt::Display for InputError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = |file: &Option<PathBuf>| {
            file.as_ref().map_or("standard input".to_owned(), |file| file.display().to_string())
        };
        match self {
            Self::Unreadable(file, error) => write!(f, "{}: cannot be read: {error}", name(file)),
            Self::NotText(file) => write!(f, "{}: not text in UTF-8", name(file)),
            Self::Refused(file, error) => write!(f, "{}:{}: {error}", name(file), error.line()),
            Self::Foreign(file, format, error) => write!(f, "{}: {error} (read as {format})", name(file)),
            Self::NoLayout(file, true) => write!(f, "{}: empty; a layout is expected", name(file)),
            Self::NoLayout(file, false) => {
                write!(f, "{}: not known as a layout by its name or content; say what it is with --from", name(file))
            }
            Self::Single(file) => {
                write!(f, "{}: only orders and states of VDA 5050, or paths, may be several files", name(file))
            }
            Self::HasAgents(file) => {
                write!(
                    f,
                    "{}: a scenario has its own vehicles and paths; options for layouts are of no use",
                    name(file)
                )
            }
        }
    }
}

impl std::error::Error for InputError {}

/// The text of a file, or of standard input for `-`.
fn text(file: &Path) -> Result<(Option<PathBuf>, String), InputError> {
    let name = (file != Path::new("-")).then(|| file.to_owned());
    let bytes = match &name {
        Some(file) => fs::read(file),
        None => {
            let mut bytes = Vec::new();
            io::stdin().lock().read_to_end(&mut bytes).map(|_| bytes)
        }
    };
    let bytes = bytes.map_err(|error| InputError::Unreadable(name.clone(), error))?;
    match String::from_utf8(bytes) {
        Ok(text) => Ok((name, text)),
        Err(_) => Err(InputError::NotText(name)),
    }
}

/// The scenario in a file, or on standard input for `-`: a scenario file, or another format by its name or
/// as the options say; with the warnings of the reader.
///
/// # Errors
/// [`InputError`], naming the file and, for a refused scenario, the line.
pub fn read(file: &Path, options: &Options) -> Result<(Scenario, Warnings), InputError> {
    let (name, text) = text(file)?;
    let mut warnings = Warnings::default();
    match options.from.or_else(|| Format::of(file, &text)) {
        Some(format) => match import::scenario(format, &text, options, &mut warnings) {
            Ok(scenario) => Ok((scenario, warnings)),
            Err(error) => Err(InputError::Foreign(name, format, error)),
        },
        None => match Scenario::from_json(&text) {
            Ok(_) if options.any() => Err(InputError::HasAgents(name)),
            Ok(scenario) => Ok((scenario, warnings)),
            Err(error) => Err(InputError::Refused(name, error)),
        },
    }
}

/// The scenario in several files that have agents of their own, with the warnings about each: messages of VDA 5050, or paths by
/// their points.
///
/// # Errors
/// [`InputError`], naming the file.
pub fn read_all(files: &[PathBuf], options: &Options) -> Result<(Scenario, Vec<(PathBuf, Warnings)>), InputError> {
    let (mut texts, mut warnings, mut read_as) = (Vec::new(), Vec::new(), None);
    for file in files {
        // Each by itself, so that what is wrong is said of the file in which it is.
        let (name, text) = text(file)?;
        let format = options.from.or_else(|| Format::of(file, &text));
        let Some(format @ (Format::Vda5050 | Format::Path)) = format else {
            return Err(InputError::Single(name));
        };
        let mut own = Warnings::default();
        import::scenario(format, &text, options, &mut own)
            .map_err(|error| InputError::Foreign(name.clone(), format, error))?;
        if read_as.is_some_and(|before| before != format) {
            return Err(InputError::Single(name));
        }
        read_as = Some(format);
        texts.push(text.trim_start_matches('\u{feff}').to_owned());
        warnings.push((file.clone(), own));
    }
    let name = files.first().cloned();
    let Some(format) = read_as else { return Err(InputError::Single(name)) };
    // An empty line parts paths, and means nothing between messages.
    let mut all = Warnings::default();
    match import::scenario(format, &texts.join("\n\n"), options, &mut all) {
        Ok(mut scenario) => {
            // What is said of all of them together is said with the last one.
            if let Some((_, last)) = warnings.last_mut() {
                last.add_of_all(&all);
            }
            scenario.warnings = warnings
                .iter()
                .flat_map(|(file, own)| own.all().into_iter().map(move |line| format!("{}: {line}", file.display())))
                .collect();
            Ok((scenario, warnings))
        }
        Err(error) => Err(InputError::Foreign(name, format, error)),
    }
}

/// The layout in a file, or on standard input for `-`, with the warnings of the reader; for vehicles of which only the
/// disc matters, or that move.
///
/// # Errors
/// [`InputError`], naming the file.
pub fn read_layout(file: &Path, options: &Options, moves: bool) -> Result<(Imported, Warnings), InputError> {
    let (name, text) = text(file)?;
    let mut warnings = Warnings::default();
    let Some(format) = options.from.or_else(|| Format::of(file, &text)) else {
        return Err(InputError::NoLayout(name, import::is_empty(&text)));
    };
    let read = if moves { import::roads } else { import::layout };
    match read(format, &text, options, &mut warnings) {
        Ok(imported) => Ok((imported, warnings)),
        Err(error) => Err(InputError::Foreign(name, format, error)),
    }
}

/// A line of JSON Lines that is not blank.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    /// Counted from 1, blank lines included.
    pub number: usize,
    /// The scenario, or the name as far as it could be read and what is wrong.
    pub scenario: Result<Scenario, (String, String)>,
}

/// The scenarios in JSON Lines, one at a time as they come in.
#[derive(Debug)]
pub struct Lines<R> {
    reader: R,
    number: usize,
}

impl<R: BufRead> Lines<R> {
    /// The lines that `reader` gives.
    pub fn new(reader: R) -> Self {
        Self { reader, number: 0 }
    }
}

impl<R: BufRead> Iterator for Lines<R> {
    type Item = Result<Line, InputError>;

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            let mut bytes = Vec::new();
            match self.reader.read_until(b'\n', &mut bytes) {
                Ok(0) => return None,
                Ok(_) => self.number += 1,
                Err(error) => return Some(Err(InputError::Unreadable(None, error))),
            }
            let scenario = match String::from_utf8(bytes) {
                Ok(text) if text.trim_start_matches('\u{feff}').trim().is_empty() => continue,
                Ok(text) => {
                    Scenario::from_json(&text).map_err(|error| (error.scenario().to_owned(), error.to_string()))
                }
                Err(_) => Err((String::new(), "not text in UTF-8".to_owned())),
            };
            let number = self.number;
            let scenario = scenario.map_err(|(name, problem)| (name, format!("line {number}: {problem}")));
            return Some(Ok(Line { number, scenario }));
        }
    }
}
