//! The paper's evaluation and more, as a document with pictures. All its figures are measured or computed when it is
//! written.
//!
//! ```text
//! machine      the machine
//! fleets       Table VI, and all methods on the same fleets
//! time_shares  Fig. 12: time to find pairs, and to compute regions
//! figures      Fig. 13 and 14
//! near_misses  contacts and near misses down to a ten-millionth of a metre
//! memory       memory for a collision, and bytes to transmit it
//! traffic      random missions in a real warehouse
//! plans        costs of start delays, and proved bounds
//! lifelong     fleets that run in the warehouse for an hour
//! layouts      fleets that run on other layouts
//! tasks        lifelong tasks on roadmaps, beside published figures
//! execution    execution of plans on grids while robots are late
//! roadmaps     tables of locks and of unsafe delays
//! scale        fleets of up to 100,000 agents
//! ```

mod execution;
mod figures;
mod fleets;
mod layouts;
mod lifelong;
mod machine;
mod memory;
mod near_misses;
mod plans;
mod roadmaps;
mod scale;
mod tasks;
mod time_shares;
mod traffic;

use pcr_comparing::compare::MeasurementBudget;
use pcr_formats::import::{self, ImportOptions, ImportedLayout, InputFormat, Warnings};
use pcr_formats::output;
use pcr_formats::scenario::Scenario;
use pcr_planning::failure::ComputationError;
use std::path::{Path, PathBuf};
use std::{fmt, fs, io};

/// How thoroughly to measure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Thoroughness {
    /// Everything.
    Full,
    /// Small fleets only, without the slowest methods: to see that it works.
    Quick,
}

impl Thoroughness {
    /// Words of which the names of methods hold one; none for all methods.
    fn filters(self) -> &'static [&'static str] {
        match self {
            Self::Full => &[],
            Self::Quick => &["pcr", "polyline", "parry2d", "map 0.1 s"],
        }
    }

    fn effort(self) -> MeasurementBudget {
        match self {
            Self::Full => MeasurementBudget { rounds: 31, budget: 0.4, slices: 20_000 },
            Self::Quick => MeasurementBudget { rounds: 2, budget: 0.01, slices: 500 },
        }
    }
}

/// Why there is no document.
#[derive(Debug)]
pub enum EvaluationError {
    /// Of a file or directory.
    File(PathBuf, String),
    /// Of the document of which parts were to be written anew.
    Document(PathBuf, String),
    /// Of a fleet.
    Fleet(ComputationError),
    /// Of a method that has no answer, by its name.
    Method(String, String),
}

impl fmt::Display for EvaluationError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File(path, problem) | Self::Document(path, problem) => write!(f, "{}: {problem}", path.display()),
            Self::Fleet(failure) => failure.fmt(f),
            Self::Method(name, reason) => write!(f, "{name}: {reason}"),
        }
    }
}

impl std::error::Error for EvaluationError {}

impl<F: Into<ComputationError>> From<F> for EvaluationError {
    fn from(failure: F) -> Self {
        Self::Fleet(failure.into())
    }
}

/// A part of the document: Markdown, and SVG pictures with their names.
struct DocumentSection {
    text: String,
    pictures: Vec<(&'static str, String)>,
}

/// Directory of the pictures, below that of the document.
const PICTURES: &str = "pictures/evaluation";

/// A picture in the text.
fn picture(name: &str, what: &str) -> String {
    format!("![{what}]({PICTURES}/{name}.svg)\n")
}

/// One after the other: they take the time of one another otherwise.
type SectionWriter = fn(&PaperFleets, Thoroughness) -> Result<DocumentSection, EvaluationError>;

/// The parts of the document, by their names.
const PARTS: [(&str, SectionWriter); 13] = [
    ("fleets", fleets::section),
    ("shares", time_shares::section),
    ("figures", figures::section),
    ("grazing", near_misses::section),
    ("memory", memory::section),
    ("traffic", traffic::section),
    ("plans", plans::section),
    ("lifelong", lifelong::section),
    ("layouts", layouts::section),
    ("tasks", tasks::section),
    ("execution", execution::section),
    ("roadmaps", roadmaps::section),
    ("scale", scale::section),
];

/// The names of the parts of the document.
pub fn parts() -> impl Iterator<Item = &'static str> {
    PARTS.iter().map(|(name, _)| *name)
}

/// Writes `evaluation.md` and its pictures into a directory; `data` is the directory with the fleets of the paper's Table VI and
/// the layouts. With the names of some parts in `only`, these are written anew in the document that is there.
/// `begins` is told the name of each part before it is measured, how many are done, and of how many. Returns the files.
///
/// # Errors
/// [`EvaluationError`] where a fleet cannot be read, or a file cannot be read or written.
pub fn write(
    data: &Path,
    directory: &Path,
    extent: Thoroughness,
    only: &[String],
    begins: &mut dyn FnMut(&str, usize, usize),
) -> Result<Vec<PathBuf>, EvaluationError> {
    let document = directory.join("evaluation.md");
    // Also one that is no text.
    let there = fs::read(&document).map(|bytes| String::from_utf8_lossy(&bytes).into_owned()).ok();
    if there.as_ref().is_some_and(|there| !there.contains(machine::OWN)) {
        let why = "is there and not of this command: give another folder, or another name to it";
        return Err(EvaluationError::Document(document, why.to_owned()));
    }
    let mut text = match only {
        [] => machine::preamble(extent, there.as_deref().map_or("", machine::summary)),
        _ => fs::read_to_string(&document)
            .map_err(|error| EvaluationError::Document(document.clone(), format!("cannot be read: {error}")))?,
    };
    if text.contains(machine::QUICK) != (extent == Thoroughness::Quick) {
        return Err(EvaluationError::Document(
            document,
            "was written with --quick, or this is and it was not".to_owned(),
        ));
    }
    let fleets = PaperFleets::read(data, extent)?;
    let wanted = PARTS.iter().filter(|(name, _)| only.is_empty() || only.iter().any(|it| it == name));
    let wanted: Vec<_> = wanted.collect();
    let mut files = Vec::new();
    for (done, (name, part)) in wanted.iter().enumerate() {
        begins(name, done, wanted.len());
        let section = part(&fleets, extent)?;
        if only.is_empty() {
            text.push('\n');
            text.push_str(&section.text);
        } else {
            text = replaced(&text, &section.text).ok_or_else(|| {
                let first = section.text.lines().next().unwrap_or_default();
                EvaluationError::Document(document.clone(), format!("has no section \"{first}\": write all of it"))
            })?;
        }
        let pictures = section.pictures.into_iter();
        files.extend(pictures.map(|(name, svg)| (directory.join(PICTURES).join(name).with_extension("svg"), svg)));
    }
    files.insert(0, (document, text));
    let written = files.into_iter().map(|(path, content)| {
        let write = || {
            output::folder(path.parent().unwrap_or(directory))?;
            output::write(&path, content)
        };
        write()
            .map_err(|error: io::Error| EvaluationError::File(path.clone(), format!("cannot be written: {error}")))?;
        Ok(path)
    });
    written.collect()
}

/// A document with other text in place of its sections that have the same headings; none where it does not have the first of them.
fn replaced(document: &str, section: &str) -> Option<String> {
    let is_heading = |line: &&str| line.starts_with("## ");
    let headings: Vec<&str> = section.lines().filter(is_heading).collect();
    let lines: Vec<&str> = document.lines().collect();
    let begin = lines.iter().position(|line| Some(line) == headings.first())?;
    let after = lines.iter().skip(begin).position(|line| is_heading(line) && !headings.contains(line));
    let mut text: String = lines[..begin].iter().map(|line| format!("{line}\n")).collect();
    text.push_str(section);
    for line in after.map_or(&[][..], |after| &lines[begin + after..]).iter() {
        if is_heading(line) && !text.ends_with("\n\n") {
            text.push('\n');
        }
        text.push_str(line);
        text.push('\n');
    }
    Some(text)
}

/// A row of the paper's Table VI, and our fleet for it.
struct PaperFleet {
    scenario: Scenario,
    /// Agents and collision regions.
    size: [usize; 2],
    /// Of the analytic method, the computational one and PQP, as printed \[ms\].
    paper: [f64; 3],
    /// Memory of the first two, as printed.
    memory: &'static str,
}

/// All of them.
struct PaperFleets {
    all: Vec<PaperFleet>,
    /// The directory with the data.
    data: PathBuf,
}

/// File; agents and regions, times \[ms\], and memory as the paper prints them.
const TABLE_VI: [(&str, [usize; 2], [f64; 3], &str); 6] = [
    ("table6-5.json", [5, 16], [1.4, 7_750.0, 97.0], "1 KB / 3 MB"),
    ("table6-12.json", [12, 16], [1.5, 48_125.0, 1_220.0], "1 KB / 3 MB"),
    ("paper12.json", [12, 126], [14.3, 51_110.0, 1_220.0], "4 KB / 10 MB"),
    ("table6-30.json", [30, 218], [18.6, 193_763.0, 3_791.0], "14 KB / 17 MB"),
    ("table6-50.json", [50, 718], [66.3, 553_279.0, 10_755.0], "46 KB / 54 MB"),
    ("table6-100.json", [100, 2_478], [255.7, 2_032_841.0, 53_619.0], "159 KB / 202 MB"),
];

/// Radius with which the missions on layouts round corners \[m\]: that of nav2, if it does.
const CORNER_RADIUS: f64 = 1.0;

impl PaperFleets {
    fn read(data: &Path, extent: Thoroughness) -> Result<Self, EvaluationError> {
        let rows = match extent {
            Thoroughness::Full => &TABLE_VI[..],
            Thoroughness::Quick => &TABLE_VI[2..3],
        };
        let fleet = |&(name, size, paper, memory): &(&str, _, _, _)| {
            let path = data.join(name);
            let text = fs::read_to_string(&path)
                .map_err(|error| EvaluationError::File(path.clone(), format!("cannot be read: {error}")))?;
            let scenario =
                Scenario::from_json(&text).map_err(|error| EvaluationError::File(path, error.to_string()))?;
            Ok(PaperFleet { scenario, size, paper, memory })
        };
        Ok(Self { all: rows.iter().map(fleet).collect::<Result<_, EvaluationError>>()?, data: data.to_owned() })
    }

    /// The route graph of nav2's warehouse, with discs of this radius \[m\].
    fn warehouse(&self, radius: f64) -> Result<ImportedLayout, EvaluationError> {
        let path = self.data.join("real/nav2/warehouse_graph.geojson");
        let problem = |problem: String| EvaluationError::File(path.clone(), problem);
        let text = fs::read_to_string(&path).map_err(|error| problem(format!("cannot be read: {error}")))?;
        let options =
            ImportOptions { radius: Some(radius), corner_radius: Some(CORNER_RADIUS), ..ImportOptions::default() };
        // What it assumes about speeds goes for all agents alike.
        let imported = import::roads(InputFormat::Nav2, &text, &options, &mut Warnings::default());
        imported.map_err(|error| problem(error.to_string()))
    }

    /// The paper's 12 agents.
    fn paper12(&self) -> Option<&PaperFleet> {
        self.all.iter().find(|fleet| fleet.size == [12, 126])
    }
}
