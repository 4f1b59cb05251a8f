//! Sources of scenarios, and errors that name the place of the fault.

mod lines;

use crate::answer_files;
use crate::byte_order_mark::unmarked;
use crate::import::{
    self, ImportError, ImportOptions, ImportedLayout, InputFormat, InputKind, PoseLog, PoseOptions, Warnings,
};
use crate::scenario::{self, Scenario, ScenarioError};
pub use lines::{InputScenario, ScenarioStream};
use std::fmt;
use std::fs;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

/// Why there is no scenario.
#[derive(Debug)]
#[non_exhaustive]
pub enum InputError {
    /// The file, or standard input (`None`), could not be read.
    Unreadable(Option<PathBuf>, io::Error),
    /// It is not text in UTF-8.
    NotText(Option<PathBuf>),
    /// It is a bag of ROS in a form that is not read here, and what to do with it.
    Bag(Option<PathBuf>, &'static str),
    /// It is not a scenario.
    Refused(Option<PathBuf>, ScenarioError),
    /// It is not of the format that it is read in.
    Foreign(Option<PathBuf>, InputFormat, ImportError),
    /// It is empty, and what is expected.
    Empty(Option<PathBuf>, &'static str),
    /// It is neither JSON, as scenarios are, nor a format that is known by its name or content.
    Unknown(Option<PathBuf>),
    /// It has to be a layout, and is none that is known.
    NoLayout(Option<PathBuf>),
    /// It has to be a layout, and is a scenario.
    IsScenario(Option<PathBuf>),
    /// It has to be a layout, and is an answer of this tool; the text says which.
    IsAnswer(Option<PathBuf>, String),
    /// It cannot be read together with others.
    Single(Option<PathBuf>),
    /// An option does nothing with such a file, and why.
    Useless(Option<PathBuf>, &'static str, &'static str),
}

impl fmt::Display for InputError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = |file: &Option<PathBuf>| {
            file.as_ref().map_or("standard input".to_owned(), |file| file.display().to_string())
        };
        match self {
            Self::Unreadable(file, error) => write!(f, "{}: cannot be read: {error}", name(file)),
            Self::NotText(file) => write!(f, "{}: not text in UTF-8", name(file)),
            Self::Bag(file, what) => write!(f, "{}: {what}", name(file)),
            Self::Refused(file, error) => {
                // As editors and terminals recognise it.
                let column = error.column().map_or_else(String::new, |column| format!(":{column}"));
                write!(f, "{}:{}{column}: {error}", name(file), error.line())
            }
            Self::Foreign(file, format, error) => write!(f, "{} (read as {format})", error.in_file(&name(file))),
            Self::Empty(file, what) => write!(f, "{}: empty; {what} is expected", name(file)),
            Self::Unknown(file) => write!(
                f,
                "{}: no scenario, which is a JSON object, nor another format that is known by its name or content; say what it is \
                 with --from",
                name(file)
            ),
            Self::NoLayout(file) => {
                write!(f, "{}: not known as a layout by its name or content; say what it is with --from", name(file))
            }
            Self::Single(file) => {
                write!(f, "{}: only orders and states of VDA 5050, or paths, may be several files", name(file))
            }
            Self::IsScenario(file) => {
                write!(f, "{}: this is a scenario, with paths of its own; a layout is expected", name(file))
            }
            Self::IsAnswer(file, answer) => write!(f, "{}: {answer}; a layout is expected", name(file)),
            Self::Useless(file, option, why) => write!(f, "{}: {option} has no effect: {why}", name(file)),
        }
    }
}

impl std::error::Error for InputError {}

/// The text of a file, or of standard input for `-`, for whoever reads another format.
///
/// # Errors
/// [`InputError`], naming the file.
pub fn read_text(file: &Path) -> Result<String, InputError> {
    text(file).map(|(_, text)| text)
}

/// The text of a file, or of standard input for `-`, and the name of the file for messages.
fn text(file: &Path) -> Result<(Option<PathBuf>, String), InputError> {
    let name = named(file);
    let bytes = match &name {
        Some(file) => fs::read(file),
        None => {
            let mut bytes = Vec::new();
            io::stdin().lock().read_to_end(&mut bytes).map(|_| bytes)
        }
    };
    let bytes = bytes.map_err(|error| InputError::Unreadable(name.clone(), error))?;
    if let Some((_, what)) = BAGS.iter().find(|(magic, _)| bytes.starts_with(magic)) {
        return Err(InputError::Bag(name, what));
    }
    match String::from_utf8(bytes) {
        Ok(text) => Ok((name, text)),
        Err(_) => Err(InputError::NotText(name)),
    }
}

/// First bytes of bags, which are no text, and what to do with them.
const BAGS: [(&[u8], &str); 3] = [
    (b"\x89MCAP0\r\n", "a bag of ROS 2 (MCAP); only pcr check FILE reads it"),
    (
        b"SQLite format 3\0",
        "a SQLite database, as rosbag2 writes it; convert the bag to MCAP: rosbags-convert --src FOLDER --dst NEW --dst-storage mcap \
         (pip install rosbags), or ros2 bag convert",
    ),
    (
        b"#ROSBAG V2.0",
        "a bag of ROS 1; convert it to MCAP: rosbags-convert --src FILE --dst NEW --dst-storage mcap --dst-typestore latest \
         (pip install rosbags)",
    ),
];

/// A file for messages; nothing for standard input.
fn named(file: &Path) -> Option<PathBuf> {
    (file != Path::new("-")).then(|| file.to_owned())
}

/// The name of a file as far as answers carry it that have no other: without its folder and its extensions. Empty for `-`.
pub fn stem(file: &Path) -> String {
    let stem = file.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    let known = [".lif", ".building", ".planview"];
    let stem = known.iter().find_map(|extension| stem.strip_suffix(extension)).unwrap_or(&stem);
    if stem == "-" { String::new() } else { stem.to_owned() }
}

/// A name, else the stem of the file, without characters that may not be printed.
fn or_stem(name: &mut String, file: &Path) {
    *name = scenario::label(name);
    if name.is_empty() {
        *name = scenario::label(&stem(file));
    }
}

/// The scenario in a file, or on standard input for `-`: a scenario file, or another format by its name or
/// as the options say; with the warnings of the reader. One without a name has that of the file.
///
/// # Errors
/// [`InputError`], naming the file and, for a refused scenario, the line.
pub fn read(file: &Path, options: &ImportOptions) -> Result<(Scenario, Warnings), InputError> {
    read_from(file, text(file)?.1, options)
}

/// Reads the scenario in the text of a file.
///
/// # Errors
/// As [`read`].
pub fn read_from(file: &Path, text: String, options: &ImportOptions) -> Result<(Scenario, Warnings), InputError> {
    let read = read_one_of(file, text, options)?;
    used(&named(file), options, &read.1)?;
    Ok(read)
}

/// Reads the scenario in the text of one of several files: an option without effect on it is no error, as it may have one on another file.
///
/// # Errors
/// As [`read`].
pub fn read_one_of(file: &Path, text: String, options: &ImportOptions) -> Result<(Scenario, Warnings), InputError> {
    let name = named(file);
    let mut warnings = Warnings::default();
    match options.from.or_else(|| InputFormat::detect(file, &text)) {
        Some(format) => {
            useful(&name, &text, Some(format), options)?;
            match import::scenario(format, &text, options, &mut warnings) {
                Ok(mut scenario) => {
                    or_stem(&mut scenario.name, file);
                    Ok((scenario, warnings))
                }
                Err(error) => Err(InputError::Foreign(name, format, error)),
            }
        }
        None if import::is_empty(&text) => Err(InputError::Empty(name, "a scenario")),
        None if !is_json(&text) => Err(InputError::Unknown(name)),
        None => match Scenario::from_json(&text) {
            Ok(mut scenario) => {
                useful(&name, &text, None, options)?;
                or_stem(&mut scenario.name, file);
                Ok((scenario, warnings))
            }
            Err(error) => Err(InputError::Refused(name, error)),
        },
    }
}

/// Whether a text begins as JSON with something in it does.
fn is_json(text: &str) -> bool {
    unmarked(text).trim_start().starts_with(['{', '['])
}

/// Refuses options that do nothing with scenarios on standard input.
///
/// # Errors
/// [`InputError::Useless`].
pub fn useful_with_lines(options: &ImportOptions) -> Result<(), InputError> {
    useful(&None, "", None, options)
}

/// Refuses options that do nothing with a file.
fn useful(
    file: &Option<PathBuf>,
    text: &str,
    format: Option<InputFormat>,
    options: &ImportOptions,
) -> Result<(), InputError> {
    match options.without_effect(InputKind::detect(format, text)) {
        Some((option, why)) => Err(InputError::Useless(file.clone(), option, why)),
        None => Ok(()),
    }
}

/// Refuses options that had no effect on what was read.
fn used(file: &Option<PathBuf>, options: &ImportOptions, warnings: &Warnings) -> Result<(), InputError> {
    match options.unused(&[warnings]) {
        Some((option, why)) => Err(InputError::Useless(file.clone(), option, why)),
        None => Ok(()),
    }
}

/// What a file is, by its name and content or as the options say; a scenario on standard input for `-`, which is not read.
///
/// # Errors
/// [`InputError`], naming the file.
pub fn kind(file: &Path, options: &ImportOptions) -> Result<InputKind, InputError> {
    if file == Path::new("-") {
        return Ok(InputKind::detect(options.from, ""));
    }
    Ok(kind_of(file, &text(file)?.1, options))
}

/// The same of a text that is read already.
pub fn kind_of(file: &Path, text: &str, options: &ImportOptions) -> InputKind {
    InputKind::detect(options.from.or_else(|| InputFormat::detect(file, text)), text)
}

/// Whether a file, or standard input where the options say so, holds poses with times. A pipe is not read for that.
pub fn holds_poses(file: &Path, options: &ImportOptions) -> bool {
    /// Bytes that tell whether a text may hold poses at all.
    const HEAD: u64 = 4096;
    #[cfg(feature = "bags")]
    if options.from.is_none() && is_bag(file) {
        return true;
    }
    match options.from {
        Some(format) => format == InputFormat::Poses,
        None if !fs::metadata(file).is_ok_and(|there| there.is_file()) => false,
        None => {
            let mut head = Vec::new();
            let read = fs::File::open(file).and_then(|opened| opened.take(HEAD).read_to_end(&mut head));
            // Scenarios are long, and begin like this.
            let may_be = read.is_ok() && !head.trim_ascii_start().starts_with(b"{");
            may_be
                && fs::read_to_string(file)
                    .is_ok_and(|text| InputFormat::detect(file, &text) == Some(InputFormat::Poses))
        }
    }
}

/// The first bytes of a file, at most so many; none of standard input, which is not read for that.
fn head(file: &Path, most: usize) -> Vec<u8> {
    let mut head = Vec::new();
    if fs::metadata(file).is_ok_and(|there| there.is_file())
        && let Ok(opened) = fs::File::open(file)
        && opened.take(most as u64).read_to_end(&mut head).is_err()
    {
        head.clear();
    }
    head
}

/// Whether a file is a bag of ROS 2 (MCAP). Standard input is not read for that.
#[cfg(feature = "bags")]
pub fn is_bag(file: &Path) -> bool {
    head(file, import::BAG.len()) == import::BAG
}

/// Refuses a bag that is not read here, with what to do. Standard input is not read for that.
///
/// # Errors
/// [`InputError::Bag`].
pub fn refuse_bag(file: &Path) -> Result<(), InputError> {
    let longest = BAGS.iter().map(|(magic, _)| magic.len()).max().unwrap_or_default();
    let head = head(file, longest);
    match BAGS.iter().find(|(magic, _)| head.starts_with(magic)) {
        Some((_, what)) => Err(InputError::Bag(named(file), what)),
        None => Ok(()),
    }
}

/// Reads the poses in a bag of ROS 2, and warnings about them.
///
/// # Errors
/// [`InputError`], naming the file.
#[cfg(feature = "bags")]
pub fn read_bag(
    file: &Path,
    options: &ImportOptions,
    pose_options: &PoseOptions,
) -> Result<(PoseLog, Warnings), InputError> {
    let name = named(file);
    useful(&name, "", Some(InputFormat::Poses), options)?;
    let mut warnings = Warnings::default();
    let mut opened = fs::File::open(file).map_err(|error| InputError::Unreadable(name.clone(), error))?;
    match import::poses_in_bag(&mut opened, options, pose_options, &mut warnings) {
        Ok(log) => Ok((log, warnings)),
        Err(error) => Err(InputError::Foreign(name, InputFormat::Poses, error)),
    }
}

/// Reads the poses in a text, and warnings about them.
///
/// # Errors
/// [`InputError`], naming the file.
pub fn read_poses(
    file: &Path,
    text: &str,
    options: &ImportOptions,
    pose_options: &PoseOptions,
) -> Result<(PoseLog, Warnings), InputError> {
    let name = named(file);
    useful(&name, text, Some(InputFormat::Poses), options)?;
    let mut warnings = Warnings::default();
    match import::poses(text, options, pose_options, &mut warnings) {
        Ok(log) => Ok((log, warnings)),
        Err(error) => Err(InputError::Foreign(name, InputFormat::Poses, error)),
    }
}

/// Whether all files hold orders or states of VDA 5050, or all paths by their points: an agent each, of one fleet.
pub fn are_of_one_fleet(files: &[PathBuf], options: &ImportOptions) -> bool {
    let format = |file: &PathBuf| {
        // A pipe would have nothing left for who reads it.
        let is_file = fs::metadata(file).is_ok_and(|file| file.is_file());
        let text = if is_file { fs::read_to_string(file).unwrap_or_default() } else { String::new() };
        options.from.or_else(|| InputFormat::detect(file, &text))
    };
    let mut formats = files.iter().map(format);
    let first = formats.next().flatten();
    matches!(first, Some(InputFormat::Vda5050 | InputFormat::Path)) && formats.all(|format| format == first)
}

/// The scenario in several files that have agents of their own, with the warnings about each: messages of VDA 5050, or paths by
/// their points.
///
/// # Errors
/// [`InputError`], naming the file.
pub fn read_all(
    files: &[PathBuf],
    options: &ImportOptions,
) -> Result<(Scenario, Vec<(PathBuf, Warnings)>), InputError> {
    let (mut texts, mut warnings, mut read_as) = (Vec::new(), Vec::new(), None);
    for file in files {
        // Each by itself, so that what is wrong is said of the file in which it is.
        let (name, text) = text(file)?;
        let format = options.from.or_else(|| InputFormat::detect(file, &text));
        let Some(format @ (InputFormat::Vda5050 | InputFormat::Path)) = format else {
            return Err(InputError::Single(name));
        };
        useful(&name, &text, Some(format), options)?;
        let mut own = Warnings::default();
        import::scenario(format, &text, options, &mut own)
            .map_err(|error| InputError::Foreign(name.clone(), format, error))?;
        if read_as.is_some_and(|before| before != format) {
            return Err(InputError::Single(name));
        }
        read_as = Some(format);
        texts.push(unmarked(&text).to_owned());
        warnings.push((file.clone(), own));
    }
    let name = files.first().cloned();
    let Some(format) = read_as else { return Err(InputError::Single(name)) };
    // An empty line parts paths, and means nothing between messages.
    let mut all = Warnings::default();
    match import::scenario(format, &texts.join("\n\n"), options, &mut all) {
        Ok(mut scenario) => {
            used(&name, options, &all)?;
            Warnings::merge(&mut warnings.iter_mut().map(|(_, own)| own).collect::<Vec<_>>(), &all);
            scenario.warnings = warnings
                .iter()
                .flat_map(|(file, own)| own.all().into_iter().map(move |line| format!("{}: {line}", file.display())))
                .collect();
            files.iter().take(1).for_each(|file| or_stem(&mut scenario.name, file));
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
pub fn read_layout(
    file: &Path,
    options: &ImportOptions,
    moves: bool,
) -> Result<(ImportedLayout, Warnings), InputError> {
    read_layout_from(file, &text(file)?.1, options, moves)
}

/// Reads the scenario in the text of a file.
///
/// # Errors
/// As [`read_layout`].
pub fn read_layout_from(
    file: &Path,
    text: &str,
    options: &ImportOptions,
    moves: bool,
) -> Result<(ImportedLayout, Warnings), InputError> {
    let name = named(file);
    let mut warnings = Warnings::default();
    let Some(format) = options.from.or_else(|| InputFormat::detect(file, text)) else {
        return Err(match answer_files::answer(text) {
            _ if import::is_empty(text) => InputError::Empty(name, "a layout"),
            Some(answer) => InputError::IsAnswer(name, answer),
            None if answer_files::has_agents(text) => InputError::IsScenario(name),
            None => InputError::NoLayout(name),
        });
    };
    useful(&name, text, Some(format), options)?;
    let read = if moves { import::roads } else { import::layout };
    match read(format, text, options, &mut warnings) {
        Ok(mut imported) => {
            // Which ways there are, and what is rounded on them, is up to who reads the layout.
            warnings.use_option("corner_radius");
            used(&name, options, &warnings)?;
            or_stem(&mut imported.layout.name, file);
            Ok((imported, warnings))
        }
        Err(error) => Err(InputError::Foreign(name, format, error)),
    }
}
