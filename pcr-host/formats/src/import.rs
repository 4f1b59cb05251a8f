//! Reads layouts, orders and plans in the formats that fleets use, leniently.
//!
//! ```text
//! nav2                route graphs of the nav2 route server (GeoJSON)
//! lif                 layouts of the VDMA (JSON)
//! vda5050             orders and states (JSON)
//! order_updates       orders and their updates
//! vehicle_loads       the load that a vehicle of VDA 5050 carries
//! vehicle_heading     which way vehicles face on their paths
//! heading_error       the rotation beside the path of an outline that faces along it
//! corridor            room beside an edge that a vehicle may use
//! factsheet           contours and limits of vehicles of VDA 5050 (JSON)
//! rmf                 buildings and fleets of Open-RMF (YAML)
//! levels              where the levels of such a building are
//! projection          longitudes and latitudes to metres
//! opendrive           reference lines of roads (XML)
//! opentcs             plant models (XML)
//! ccbs                roadmaps and plans of Continuous-CBS (XML)
//! grid                plans on grids (text)                                   GridPlan
//! trajectory          NURBS as in VDA 5050 and LIF
//! nurbs, bernstein    NURBS to Bézier curves
//! biarc               curves to lines and arcs, with a certified distance
//! clothoid            clothoids to arcs, with a proven distance
//! polynomial          parametric cubic curves of OpenDRIVE to Bézier curves
//! sampled_paths       paths by their points (text)
//! poses               records of what ran, and plans, as poses at times         PoseLog
//! timed_paths         plans of points and times
//! timestamp           time stamps
//! layout              the common form: nodes, and edges of lines and arcs     Layout
//! path_builder        lines and arcs anywhere in the plane to one path
//! speed               the fastest motion under changing limits
//! route               the shortest way between nodes, corners rounded
//! vehicle             radius, speeds, and the options of the command line     VehicleTraits, ImportOptions
//! unique_names        unique names for nodes and edges with the same name
//! json_access, xml    members and attributes, with errors that say where they are
//! keys                the keys that objects of a format may have
//! applicable_options  which options have an effect on which files             InputKind
//! warnings            faults that were read nevertheless                      Warnings
//! ```
//!
//! A reader either reads everything in a file, or refuses it with an [`ImportError`] that names all parts that would be
//! left out; with [`ImportOptions::partial`] these are left out. Parts that are not read exactly as written cause warnings,
//! which are also in the answers. No input causes a panic.

mod applicable_options;
mod bernstein;
mod biarc;
mod ccbs;
mod clothoid;
mod corridor;
mod factsheet;
mod grid;
mod heading_error;
mod json_access;
mod keys;
mod layout;
mod levels;
mod lif;
mod nav2;
mod nurbs;
mod opendrive;
mod opentcs;
mod order_updates;
mod path_builder;
mod polynomial;
mod poses;
mod projection;
mod rmf;
mod route;
mod sampled_paths;
mod speed;
mod timed_paths;
mod timestamp;
mod trajectory;
mod unique_names;
mod vda5050;
mod vehicle;
mod vehicle_heading;
mod vehicle_loads;
mod warnings;
mod xml;

pub use applicable_options::InputKind;
pub use grid::GridPlan;
pub use json_access::parse as parse_json;
pub use layout::{ElementId, Layout, LayoutEdge, LayoutNode, LayoutZone};
pub use nav2::graph_id;
#[cfg(feature = "bags")]
pub(crate) use poses::BAG;
#[cfg(feature = "bags")]
pub use poses::poses_in_bag;
pub use poses::{BetweenPoses, HeldTime, PoseLog, PoseOptions, PoseTrack, TimedPose, poses};
pub use rmf::is_navigation_graph;
pub use route::{RouteStep, cheapest, ride, turn};
pub use timed_paths::sectioned;
pub use timestamp::seconds;
pub use vehicle::{Facing, FacingAngle, HEADING, ImportOptions, SizeSource, TOLERANCE, VehicleTraits};
pub use warnings::{Warnings, shortened};

use crate::answer_files;
use crate::byte_order_mark::unmarked;
use crate::footprint::Footprint;
use crate::json::{self, JsonNode, Position, SyntaxError};
use crate::scenario::{Agent, Scenario};
use crate::warning::WarningCode;
use crate::yaml::{self, YamlDocument};
use std::path::Path;
use std::{fmt, fs};
use unique_names::name_printably;
use vehicle::FileVehicleTraits;
use warnings::listed;

/// Formats of files that are not scenarios.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
pub enum InputFormat {
    /// Route graph of the nav2 route server (.geojson, or by its content)
    Nav2,
    /// Layout Interchange Format of the VDMA (.lif.json, or by its content)
    Lif,
    /// Building of Open-RMF (.building.yaml)
    Rmf,
    /// Reference lines of the roads of an OpenDRIVE file (.xodr)
    #[cfg_attr(feature = "clap", value(name = "opendrive"))]
    OpenDrive,
    /// Plant model of openTCS (.xml, by its content)
    #[cfg_attr(feature = "clap", value(name = "opentcs"))]
    OpenTcs,
    /// Roadmap or plan of Continuous-CBS (.xml, by its content)
    Ccbs,
    /// Plan on a grid, `Agent 0: (1,2)->(1,3)->` a line (by its content)
    Grid,
    /// Points of paths, `x y` a line, an empty line between agents (.path, .csv)
    Path,
    /// Orders and states of VDA 5050 (JSON, by their content)
    Vda5050,
    /// Records of what ran and plans, as poses with times; pcr check reads them (by their content)
    Poses,
}

impl InputFormat {
    /// All of them.
    pub const ALL: [Self; 10] = [
        Self::Nav2,
        Self::Lif,
        Self::Rmf,
        Self::OpenDrive,
        Self::OpenTcs,
        Self::Ccbs,
        Self::Grid,
        Self::Path,
        Self::Vda5050,
        Self::Poses,
    ];
}

impl fmt::Display for InputFormat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Nav2 => "nav2",
            Self::Lif => "lif",
            Self::Rmf => "rmf",
            Self::OpenDrive => "opendrive",
            Self::OpenTcs => "opentcs",
            Self::Ccbs => "ccbs",
            Self::Grid => "grid",
            Self::Path => "path",
            Self::Vda5050 => "vda5050",
            Self::Poses => "poses",
        })
    }
}

/// Why a file was refused.
#[derive(Clone, Debug, PartialEq)]
pub struct ImportError {
    problem: String,
    /// Line and character of the text, counted from 1, as far as they are known.
    line: Option<usize>,
    column: Option<usize>,
}

impl ImportError {
    /// For this reason.
    pub fn new(problem: impl Into<String>) -> Self {
        Self { problem: problem.into(), line: None, column: None }
    }

    /// For something at this line and character, both counted from 1.
    pub fn at(line: usize, column: Option<usize>, problem: impl Into<String>) -> Self {
        Self { line: Some(line), column, ..Self::new(problem) }
    }

    /// For the value at a place of a JSON text.
    pub fn in_json(at: Position, problem: impl Into<String>) -> Self {
        Self::at(at.line as usize, Some(at.column as usize), problem)
    }

    /// Returns the error with this place, unless it has one.
    pub(crate) fn or_in_json(self, at: Position) -> Self {
        if self.line.is_some() { self } else { Self::in_json(at, self.problem) }
    }

    /// Returns what is wrong, without its place.
    pub fn problem(&self) -> &str {
        &self.problem
    }

    /// For what is no JSON.
    pub fn of_json(error: SyntaxError) -> Self {
        Self::in_json(error.position, format!("not JSON: {}", error.problem))
    }

    /// For what is wrong in YAML. (With `From`, the compiler could no longer infer errors of many closures.)
    pub fn of_yaml(error: yaml::YamlError) -> Self {
        Self::at(error.line, Some(error.column), error.cause())
    }

    /// For what is wrong in the XML of a text.
    pub fn of_xml(text: &str, error: &roxmltree::Error) -> Self {
        use roxmltree::Error;
        let (whole, place) = (error.to_string(), error.pos());
        // Where the parser knows no place, its message has none.
        match (whole.strip_suffix(&format!(" at {place}")), error) {
            (Some(problem), _) => Self::at(place.row as usize, Some(place.col as usize), format!("not XML: {problem}")),
            (None, Error::UnexpectedEndOfStream | Error::UnclosedRootNode | Error::NoRootNode) => {
                let last = text.rsplit('\n').next().unwrap_or_default();
                let line = text.matches('\n').count() + 1;
                Self::at(line, Some(last.chars().count() + 1), format!("not XML: {whole}"))
            }
            _ => Self::new(format!("not XML: {whole}")),
        }
    }

    /// For what is wrong in the JSON of a text, which ought to be `what`.
    pub fn of_serde(text: &str, error: &serde_json::Error, what: &str) -> Self {
        let whole = error.to_string();
        let (line, byte) = (error.line(), error.column());
        let problem = whole.strip_suffix(&format!(" at line {line} column {byte}"));
        let Some(problem) = problem.filter(|_| line > 0) else { return Self::new(format!("not {what}: {whole}")) };
        // Its columns are bytes.
        let before = text.lines().nth(line - 1).unwrap_or_default().as_bytes();
        let before = before.get(..byte.saturating_sub(1)).unwrap_or(before);
        Self::at(line, Some(String::from_utf8_lossy(before).chars().count() + 1), format!("not {what}: {problem}"))
    }

    /// The message about a file of this name: `file:line:column: problem`, as editors and terminals recognise it.
    pub fn in_file(&self, name: &str) -> String {
        let place = [self.line, self.column].into_iter().flatten().map(|number| format!(":{number}"));
        format!("{name}{}: {}", place.collect::<String>(), self.problem)
    }
}

impl fmt::Display for ImportError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (self.line, self.column) {
            (None, _) => f.write_str(&self.problem),
            (Some(line), None) => write!(f, "line {line}: {}", self.problem),
            (Some(line), Some(column)) => write!(f, "line {line}, column {column}: {}", self.problem),
        }
    }
}

impl std::error::Error for ImportError {}

/// A layout and the vehicle that travels it.
#[derive(Clone, Debug, PartialEq)]
pub struct ImportedLayout {
    /// Nodes and edges.
    pub layout: Layout,
    /// Who travels them.
    pub vehicle: VehicleTraits,
}

impl InputFormat {
    /// The format of a file with this name and content, `None` for a scenario.
    pub fn detect(file: &Path, text: &str) -> Option<Self> {
        let name = file.file_name().and_then(|name| name.to_str()).unwrap_or_default().to_ascii_lowercase();
        if name.ends_with(".geojson") {
            return Some(Self::Nav2);
        }
        if name.ends_with(".lif.json") || name.ends_with(".lif") {
            return Some(Self::Lif);
        }
        if poses::are_in(text) {
            return Some(Self::Poses);
        }
        if name.ends_with(".yaml") || name.ends_with(".yml") {
            return Some(Self::Rmf);
        }
        if grid::is_plan(text) {
            return Some(Self::Grid);
        }
        if name.ends_with(".path") || name.ends_with(".csv") {
            return Some(Self::Path);
        }
        if name.ends_with(".xodr") {
            return Some(Self::OpenDrive);
        }
        match xml::root_of(text) {
            Some("OpenDRIVE") => return Some(Self::OpenDrive),
            Some("model") => return Some(Self::OpenTcs),
            Some("root" | "graphml") => return Some(Self::Ccbs),
            _ => {}
        }
        // What has agents is a scenario, and said to be wrong as one.
        if answer_files::has_agents(text) {
            return None;
        }
        let root = json::parse_first(text)?;
        if root.get("format").and_then(|format| format.as_str()).and_then(answer_files::described).is_some() {
            return None;
        }
        match () {
            () if lif::is_layout(&root) => Some(Self::Lif),
            () if nav2::is_graph(&root) => Some(Self::Nav2),
            () => vda5050::is_message(&root).then_some(Self::Vda5050),
        }
    }
}

/// Whether there is nothing in a text but blanks.
pub(crate) fn is_empty(text: &str) -> bool {
    unmarked(text).trim().is_empty()
}

/// Reads a layout.
///
/// # Errors
/// [`ImportError`] where the file is not of the format, or holds no layout.
pub fn layout(
    format: InputFormat,
    text: &str,
    options: &ImportOptions,
    warnings: &mut Warnings,
) -> Result<ImportedLayout, ImportError> {
    imported(format, text, options, false, warnings)
}

/// Reads a layout for a vehicle that moves: what is assumed about its speeds is warned about as well.
///
/// # Errors
/// As [`layout`].
pub fn roads(
    format: InputFormat,
    text: &str,
    options: &ImportOptions,
    warnings: &mut Warnings,
) -> Result<ImportedLayout, ImportError> {
    imported(format, text, options, true, warnings)
}

/// The agent that travels the shortest way between two nodes (places in [`Layout::nodes`]), from the time 0; `None` where there
/// is no way.
///
/// # Errors
/// [`ImportError`] where the way is not a path: a curve that does not reach its node.
pub fn mission(imported: &ImportedLayout, id: u64, ends: [usize; 2]) -> Result<Option<Agent>, ImportError> {
    route::mission(&imported.layout, &imported.vehicle, id, ends)
}

/// Names that a program writes into every file: the editors of nav2 and Open-RMF, and networkx. Such a layout has the name of its file.
const NO_NAMES: [&str; 3] = ["graph", "building", "G"];

/// The layout for a vehicle that stands or `moves`.
fn imported(
    format: InputFormat,
    text: &str,
    options: &ImportOptions,
    moves: bool,
    warnings: &mut Warnings,
) -> Result<ImportedLayout, ImportError> {
    if is_empty(text) {
        return Err(ImportError::new("empty"));
    }
    let mut given = given(options, warnings)?;
    if format == InputFormat::OpenTcs {
        read_complete(options, warnings, |warnings| opentcs::vehicles(text, options, &mut given, warnings))?;
    }
    let vehicle = options.vehicle(&given, moves, warnings);
    let outline = vehicle.footprint.as_ref();
    let mut layout = read_complete(options, warnings, |warnings| match format {
        InputFormat::Nav2 => nav2::read(text, vehicle.speed, warnings),
        InputFormat::Lif => lif::read(text, options, &vehicle, warnings),
        InputFormat::Rmf => rmf::read(text, options, outline, warnings),
        InputFormat::OpenDrive => opendrive::read(text, options, warnings),
        InputFormat::OpenTcs => opentcs::read(text, options, outline, warnings),
        InputFormat::Ccbs => ccbs::roadmap(text, warnings),
        InputFormat::Grid => Err(ImportError::new("a plan on a grid is not a layout")),
        InputFormat::Path => Err(ImportError::new("paths of agents are not a layout")),
        InputFormat::Vda5050 => Err(ImportError::new("an order or a state is not a layout")),
        InputFormat::Poses => Err(ImportError::new("poses with times are not a layout; pcr check FILE reads them")),
    })?;
    // Of what was left out on request it is said.
    if layout.edges.is_empty() && !options.partial {
        return Err(ImportError::new("there is no edge in it, on which anything could drive"));
    }
    if moves {
        layout.one_speed()?;
    }
    layout.corner_radius = options.corner_radius;
    let off = layout.edges.iter().map(|edge| (format!("edge {}", edge.id), edge.position_error(&vehicle) - edge.room));
    let off: Vec<_> = off.collect();
    report(&off, warnings);
    if NO_NAMES.contains(&layout.name.as_str()) {
        layout.name.clear();
    }
    name_printably(&mut layout.name, warnings);
    layout.warnings = warnings.all();
    Ok(ImportedLayout { layout, vehicle })
}

/// What a reader reads, if it leaves out nothing or that is asked for.
fn read_complete<T>(
    options: &ImportOptions,
    warnings: &mut Warnings,
    read: impl FnOnce(&mut Warnings) -> Result<T, ImportError>,
) -> Result<T, ImportError> {
    let before = warnings.lost().len();
    let outcome = read(warnings);
    match &warnings.lost()[before..] {
        // What would be left out says more than what is missing without it.
        lost if !lost.is_empty() && !options.partial => {
            let problems: Vec<String> = lost.iter().map(|error| error.problem.clone()).collect();
            let problem = format!("{}; --partial leaves that out", listed(&problems, "; "));
            Err(ImportError { problem, ..lost.first().cloned().unwrap_or_else(|| ImportError::new("")) })
        }
        _ => outcome,
    }
}

/// Deviation that goes without saying \[m\].
const UNSAID: f64 = 1e-6;

/// Says how far lines and arcs are from what they stand for; for an outline, with what their headings differ.
fn report(deviations: &[(String, f64)], warnings: &mut Warnings) {
    let most = deviations.iter().map(|(_, deviation)| *deviation).fold(0.0, f64::max);
    for (name, _) in deviations.iter().filter(|(_, deviation)| *deviation > UNSAID) {
        let problem =
            format!("its lines and arcs are up to {most:.1e} m from its curve, by which the vehicle is larger there");
        warnings.add(WarningCode::CurveDeviation, name, problem);
    }
}

/// The same for agents, and the radii that their vehicles have.
fn report_agents(scenario: &Scenario, radii: &[f64], vehicle: &VehicleTraits, warnings: &mut Warnings) {
    let agents = scenario.agents.iter().zip(radii);
    let off = agents.map(|(agent, radius)| (format!("agent {}", agent.id), grown(agent, *radius, vehicle)));
    report(&off.collect::<Vec<_>>(), warnings);
}

/// The same for routes that are further off than their edges, which are told already: gaps and differences of lengths are theirs.
fn report_routes(layout: &Layout, scenario: &Scenario, vehicle: &VehicleTraits, warnings: &mut Warnings) {
    let told = layout.edges.iter().map(|edge| edge.deviation).fold(0.0, f64::max);
    let agents = scenario.agents.iter();
    let off = agents.map(|agent| (format!("agent {}", agent.id), grown(agent, vehicle.radius, vehicle)));
    report(&off.filter(|(_, deviation)| *deviation > told + UNSAID).collect::<Vec<_>>(), warnings);
}

/// By how much an agent is larger than its vehicle, which has this radius \[m\]. The outline of one that drives backward is another one.
fn grown(agent: &Agent, radius: f64, vehicle: &VehicleTraits) -> f64 {
    let before = vehicle.footprint.as_ref().map_or(0.0, Footprint::growth);
    agent.footprint.as_ref().map_or(agent.radius - radius, |outline| outline.growth() - before)
}

/// What the configuration of a fleet or a factsheet says.
fn of_fleet(text: &str, warnings: &mut Warnings) -> Result<FileVehicleTraits, ImportError> {
    // JSON is YAML, too, but says better what is wrong with it.
    let mut read = |value: &JsonNode<'_>, texts: &JsonNode<'_>| {
        if factsheet::is_factsheet(value) {
            factsheet::read(value, warnings)
        } else {
            rmf::fleet(value, texts, warnings)
        }
    };
    if unmarked(text).trim_start().starts_with('{') {
        let value = json_access::parse(text)?;
        return read(&value, &value);
    }
    let document = YamlDocument::read(text).map_err(ImportError::of_yaml)?;
    let [value, texts] = [document.value(), document.texts()].map(|read| read.map_err(ImportError::of_yaml));
    read(&value?, &texts?)
}

/// Reads the vehicle of a fleet: the configuration of Open-RMF, or a factsheet of VDA 5050.
///
/// # Errors
/// [`ImportError`] where the text is neither.
pub fn vehicle(text: &str, options: &ImportOptions, warnings: &mut Warnings) -> Result<VehicleTraits, ImportError> {
    let given = FileVehicleTraits { is_of_fleet: true, ..of_fleet(text, warnings)? };
    Ok(options.vehicle(&given, true, warnings))
}

/// What the fleet says about the vehicle, if one is given.
fn given(options: &ImportOptions, warnings: &mut Warnings) -> Result<FileVehicleTraits, ImportError> {
    let mut given = FileVehicleTraits::default();
    if let Some(file) = &options.fleet {
        let failed = |problem: &dyn fmt::Display| ImportError::new(format!("{}: {problem}", file.display()));
        let text = fs::read_to_string(file).map_err(|error| failed(&format_args!("cannot be read: {error}")))?;
        let name = file.display().to_string();
        given = of_fleet(&text, warnings).map_err(|error| ImportError::new(error.in_file(&name)))?;
        given.is_of_fleet = given.radius.is_some() || given.footprint.is_some();
        if options.leave_some_of(&given) {
            warnings.use_option("fleet");
        }
    }
    if options.vehicle.is_some() {
        given.name.clone_from(&options.vehicle);
    }
    Ok(given)
}

/// Reads a scenario: what the file says of agents and motions, or the routes that the options ask for on its layout.
///
/// # Errors
/// [`ImportError`] where the file is not of the format, or a route is not possible.
pub fn scenario(
    format: InputFormat,
    text: &str,
    options: &ImportOptions,
    warnings: &mut Warnings,
) -> Result<Scenario, ImportError> {
    if is_empty(text) {
        return Err(ImportError::new("empty"));
    }
    let mut scenario = match format {
        InputFormat::Ccbs if xml::root_of(text) != Some("graphml") => {
            let vehicle = of_plan(options, ccbs::DEFAULT, warnings)?;
            with_margin(ccbs::log(text, &vehicle)?, &vehicle)
        }
        InputFormat::Grid => {
            let default = (grid::RADIUS, "with which no valid plan has a contact");
            let vehicle = of_plan(options, default, warnings)?;
            if json_access::is_open(text) {
                warnings.add(
                    WarningCode::MayBeCut,
                    "last line",
                    "it does not end; if the file was cut there, cells may be missing",
                );
            }
            with_margin(GridPlan::read(text)?.scenario(vehicle.radius)?, &vehicle)
        }
        InputFormat::Nav2
        | InputFormat::Lif
        | InputFormat::Rmf
        | InputFormat::OpenDrive
        | InputFormat::OpenTcs
        | InputFormat::Ccbs => {
            let ImportedLayout { layout, vehicle } = imported(format, text, options, true, warnings)?;
            let scenario = route::scenario(&layout, &vehicle, options, warnings)?;
            report_routes(&layout, &scenario, &vehicle, warnings);
            scenario
        }
        InputFormat::Poses => {
            let problem = "poses with times, between which nothing is exact; only pcr check FILE reads them";
            return Err(ImportError::new(problem));
        }
        InputFormat::Path | InputFormat::Vda5050 => {
            let vehicle = options.vehicle(&given(options, warnings)?, true, warnings);
            let (scenario, radii) = if format == InputFormat::Path {
                if json_access::is_open(text) {
                    warnings.add(
                        WarningCode::MayBeCut,
                        "last line",
                        "it does not end; if the file was cut there, digits may be missing",
                    );
                }
                let scenario = sampled_paths::read(text, options, &vehicle, warnings)?;
                let names = scenario.agents.iter().map(|agent| format!("path {}", agent.id)).collect::<Vec<_>>();
                vehicle_heading::warn_of_half_turns(names.iter().map(String::as_str).zip(&scenario.agents), warnings);
                let radii = vec![vehicle.radius; scenario.agents.len()];
                (scenario, radii)
            } else {
                read_complete(options, warnings, |warnings| vda5050::read(text, options, &vehicle, warnings))?
            };
            report_agents(&scenario, &radii, &vehicle, warnings);
            scenario
        }
    };
    name_printably(&mut scenario.name, warnings);
    scenario.warnings = warnings.all();
    checked(&scenario)
}

/// A plan whose agents have the margin of a vehicle.
fn with_margin(mut scenario: Scenario, vehicle: &VehicleTraits) -> Scenario {
    scenario.agents.iter_mut().for_each(|agent| agent.margin = vehicle.margin);
    scenario
}

/// The vehicle of a plan, which gives no radius: a default \[m\], and why it is that.
fn of_plan(
    options: &ImportOptions,
    default: (f64, &str),
    warnings: &mut Warnings,
) -> Result<VehicleTraits, ImportError> {
    let mut given = given(options, warnings)?;
    if options.radius.is_none() && given.radius.is_none() && given.footprint.is_none() {
        let (radius, why) = default;
        warnings.add(
            WarningCode::AssumedVehicle,
            "radius",
            format!("not in the file and not given, hence taken as {radius} m, {why}"),
        );
        given.radius = Some(radius);
    }
    Ok(options.vehicle(&given, false, warnings))
}

/// The scenario as its file would be read: what a scenario file may not hold is refused here as well.
///
/// # Errors
/// The reason why it would be refused.
pub fn checked(scenario: &Scenario) -> Result<Scenario, ImportError> {
    Scenario::from_json(&scenario.to_json()).map_err(|error| ImportError::new(error.to_string()))
}
