//! `pcr traffic`.

use super::printed::notes;
use super::scenario_sources::{layout, layout_source, text};
use super::{
    CONFLICTS, CliError, OutputArgs, OutputFormat, acknowledge, folder, map, parse_integer, say, whole_within, write_to,
};
use crate::progress::ProgressLine;
use clap::Args;
use pcr_drawing::LayoutLevelView;
use pcr_execution::lifelong::{self, CoordinationMethod, DelayModel, LifelongReport};
use pcr_execution::missions::MissionsReport;
use pcr_execution::report;
use pcr_execution::traffic::{TrafficOptions, TrafficReport, room};
use pcr_formats::import::{ImportOptions, ImportedLayout, SizeSource};
use pcr_formats::missions::{FleetMissions, MissionFileError, MissionSource, RecordKind, SiteChanges};
use pcr_formats::warning::WarningCode;
use pcr_planning::report::json;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

const EXAMPLES: &str = "\
Examples:
  pcr traffic map.geojson --agents 50 --radius 0.4   waits and throughput
  pcr traffic map.geojson --radius 0.4 -o traffic    and files and pictures
  pcr traffic map.geojson --missions day.jsonl       your own missions
  pcr traffic map.geojson --hours 1 --radius 0.4     mission after mission
  pcr traffic map.geojson --hours 1 --radius 0.4 --compare   also with locks";

const STATUSES: &str = "\
Exit status:
  0  done; no contact, proved
  1  a contact, or one that could not be ruled out, or nobody has a plan, or
     fewer agents have a mission and a plan than --agents asks for;
     with --missions also: a mission is impossible or was not done;
     with --hours also: a robot waits for ever or went beyond its hold, or
     missions waited while nobody reached a goal or moved for too long
  2  wrong arguments, or a layout that cannot be read or was refused
  3  the output could not be written";

/// Run missions on a layout, random ones or those of a file
#[derive(Args)]
#[command(after_help = format!("{EXAMPLES}\n\n{STATUSES}"))]
pub(super) struct TrafficArgs {
    /// The layout; standard input if left out or `-`
    layout: Option<PathBuf>,
    /// Agents; a mission each, or many with --hours [default: as many as there is room for, up to 50]
    #[arg(long, value_name = "N", value_parser = |text: &str| whole_within::<u16>(text, 1, u16::MAX.into()))]
    agents: Option<u16>,
    /// Missions, vehicles and closures (JSON Lines or CSV)
    #[arg(long, value_name = "FILE")]
    missions: Option<PathBuf>,
    /// Vehicles in a file of their own, for --missions
    #[arg(long, value_name = "FILE")]
    vehicles: Option<PathBuf>,
    /// Closures, for --missions or --hours
    #[arg(long, value_name = "FILE")]
    closures: Option<PathBuf>,
    /// Breakdowns; with --hours, robots are 1, 2, ...
    #[arg(long, value_name = "FILE")]
    breakdowns: Option<PathBuf>,
    /// The same seed gives the same missions
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = parse_integer::<u64>)]
    seed: u64,
    /// Run the fleet for H hours; prove no contact
    #[arg(long, value_name = "H", value_parser = hours)]
    hours: Option<f64>,
    /// Robots on the layout [default: as many as do most missions]
    #[arg(long, value_name = "N", hide_short_help = true, value_parser = |text: &str| whole_within::<u16>(text, 1, u16::MAX.into()))]
    active: Option<u16>,
    /// Run it again with locks, and with start delays
    #[arg(long)]
    compare: bool,
    /// Part of the time robots are stopped [default: 0.02]
    #[arg(long, value_name = "PART", value_parser = part)]
    stopped: Option<f64>,
    /// Largest fraction of their speed that robots lose [default: 0.05]
    #[arg(long, value_name = "PART", value_parser = part)]
    slip: Option<f64>,
    #[command(flatten)]
    printed: OutputArgs,
    /// Directory for scenarios and pictures
    #[arg(short, long, value_name = "DIR", value_parser = folder())]
    output: Option<PathBuf>,
    #[command(flatten)]
    import: ImportOptions,
}

/// Agents if no number is asked for, where there is room.
const AGENTS: usize = 50;

impl TrafficArgs {
    /// The number of agents that missions are drawn for: no more than the layout has room for, of which a warning tells at once.
    fn room(asked: Option<u16>, file: &Path, imported: &mut ImportedLayout) -> usize {
        let room = room(imported);
        let Some(asked) = asked.map(usize::from) else { return AGENTS.min(room) };
        if asked > room {
            let text = format!(
                "--agents {asked}: at most {room} fit on the nodes of this layout at one time; missions are drawn for {room}"
            );
            let mut warnings = vec![WarningCode::AgentsLimited.text(text)];
            acknowledge(&mut warnings);
            say(file, warnings.iter().cloned());
            imported.layout.warnings.append(&mut warnings);
        }
        asked.min(room)
    }

    pub(super) fn run(self) -> Result<ExitCode, CliError> {
        let runs = [(self.hours.is_some(), "--hours"), (self.missions.is_some(), "--missions")];
        if let Some((_, option)) = runs.iter().find(|run| run.0 && self.import.corner_radius.is_some()) {
            return Err(CliError::arguments(format!(
                "--corner-radius has no effect: with {option} robots turn in place at corners"
            )));
        }
        let file = &layout_source(self.layout.clone())?;
        let mut imported = layout(file, &self.import, "traffic", true)?;
        if self.missions.is_some() {
            return self.run_missions(file, &imported);
        }
        pcr_exclusions::sized(&imported).map_err(|error| CliError::wrong(file, error))?;
        let agents = Self::room(self.agents, file, &mut imported);
        let asked = self.agents.map_or(agents, usize::from);
        if let Some(hours) = self.hours {
            let changes = self.changes(&imported, agents)?;
            let usual = DelayModel::default();
            let request = lifelong::LifelongOptions {
                agents,
                duration: 3600.0 * hours,
                delays: DelayModel {
                    stopped: self.stopped.unwrap_or(usual.stopped),
                    slip: self.slip.unwrap_or(usual.slip),
                    ..usual
                },
                seed: self.seed,
                method: CoordinationMethod::Orders,
            };
            let methods: &[CoordinationMethod] =
                if self.compare { &CoordinationMethod::ALL } else { &[CoordinationMethod::Orders] };
            let progress = ProgressLine::new(format!("{}: simulated seconds", file.display()));
            let told = |now: f64, all: f64| progress.set(now as usize, all.ceil() as usize);
            let answer = match self.active.map(usize::from) {
                Some(active) if active > agents => {
                    return Err(CliError::arguments(format!("--active {active}: there are only {agents} robots")));
                }
                Some(active) => {
                    let all = request.duration * methods.len() as f64;
                    let request = lifelong::LifelongOptions { agents: active, ..request };
                    LifelongReport::watched(&imported, request, &changes, methods, &|now| told(now, all))
                }
                None => LifelongReport::limited(&imported, request, &changes, methods, &told),
            };
            drop(progress);
            let mut answer = answer.map_err(|problem| CliError::wrong(file, problem))?;
            answer.asked = asked;
            let has_room = agents == asked && answer.runs.iter().all(|run| run.outcome.robots == answer.active);
            let is_complete = self.agents.is_none() || has_room;
            return print(&self.printed, &answer, is_complete);
        }
        let wrong = |failure| CliError::wrong(file, failure);
        if self.output.is_some() {
            map::are_few(asked, "maps are drawn").map_err(wrong)?;
        }
        let request = TrafficOptions { agents, seed: self.seed };
        let (mut traffic, [mut missions, mut plan]) = TrafficReport::plan(&imported, request).map_err(wrong)?;
        traffic.asked = asked;
        [&mut traffic.warnings, &mut missions.warnings, &mut plan.warnings].into_iter().for_each(acknowledge);
        if self.output.is_some() {
            map::ask_for_regions(&plan).map_err(wrong)?;
        }
        let mut out = self.printed.out(false);
        match self.printed.form() {
            OutputFormat::Table => report::traffic_table(&traffic, &mut out)?,
            OutputFormat::Json => json(&traffic, &mut out)?,
            OutputFormat::Csv => report::traffic_csv(&traffic, &mut out)?,
        }
        out.flush()?;
        if let Some(directory) = &self.output {
            let ground = LayoutLevelView { imported: &imported, level: imported.layout.largest_level() };
            map::draw(&plan, None, Some(ground), directory, &mut notes())?;
            write_to(&directory.join("missions.json"), &missions.to_json())?;
            write_to(&directory.join("plan.json"), &plan.to_json())?;
        }
        let is_complete = self.agents.is_none() || traffic.is_complete();
        Ok(status(traffic.is_sound() && is_complete))
    }
}

/// Files of records, read with what their records are if they do not say it.
struct RecordFiles<'a> {
    files: Vec<(&'a Path, RecordKind)>,
    texts: Vec<String>,
}

impl<'a> RecordFiles<'a> {
    fn of(files: &[(&'a Option<PathBuf>, RecordKind)]) -> Result<Self, CliError> {
        let given = files.iter().filter_map(|&(file, kind)| Some((file.as_deref()?, kind)));
        let files: Vec<(&Path, RecordKind)> = given.collect();
        let texts = files.iter().map(|(file, _)| text(file)).collect::<Result<Vec<String>, CliError>>()?;
        Ok(Self { files, texts })
    }

    fn sources(&self) -> Vec<MissionSource<'_>> {
        self.files.iter().zip(&self.texts).map(|(&(_, kind), text)| MissionSource { text, kind }).collect()
    }

    /// The error of one of the files.
    fn wrong(&self, (place, error): (usize, MissionFileError)) -> CliError {
        CliError::at(self.files[place].0, &error)
    }
}

impl TrafficArgs {
    /// The closures and breakdowns of a run of some robots.
    fn changes(&self, imported: &ImportedLayout, robots: usize) -> Result<SiteChanges, CliError> {
        let files =
            RecordFiles::of(&[(&self.closures, RecordKind::Closure), (&self.breakdowns, RecordKind::Breakdown)])?;
        let names: Vec<String> = (1..=robots).map(|number| number.to_string()).collect();
        SiteChanges::read(&files.sources(), &imported.layout, &names).map_err(|error| files.wrong(error))
    }

    /// Runs the missions of a file.
    fn run_missions(&self, layout: &Path, imported: &ImportedLayout) -> Result<ExitCode, CliError> {
        let files = RecordFiles::of(&[
            (&self.vehicles, RecordKind::Vehicle),
            (&self.missions, RecordKind::Mission),
            (&self.closures, RecordKind::Closure),
            (&self.breakdowns, RecordKind::Breakdown),
        ])?;
        let missions_file = self.missions.as_deref().unwrap_or(Path::new("-"));
        let fleet = FleetMissions::read(&files.sources(), &imported.layout, &imported.vehicle)
            .map_err(|error| files.wrong(error))?;
        if fleet.vehicles.is_empty() {
            let problem = "there is no vehicle; add lines of the kind vehicle, or --vehicles FILE";
            return Err(CliError::wrong(missions_file, problem));
        }
        if fleet.vehicles.iter().any(|vehicle| vehicle.traits.size == SizeSource::Assumed) {
            pcr_exclusions::sized(imported).map_err(|error| CliError::wrong(layout, error))?;
        }
        if fleet.missions.is_empty() {
            return Err(CliError::wrong(missions_file, "there is no mission"));
        }
        let progress = ProgressLine::new(format!("{}: missions", missions_file.display()));
        let told = |_: f64, over: usize| progress.set(over, fleet.missions.len());
        let answer = MissionsReport::run(imported, &fleet, &told);
        drop(progress);
        let (mut answer, mut scenario) = answer.map_err(|problem| CliError::wrong(missions_file, problem))?;
        acknowledge(&mut answer.warnings);
        if let Some(scenario) = &mut scenario {
            acknowledge(&mut scenario.warnings);
        }
        let mut out = self.printed.out(false);
        match self.printed.form() {
            OutputFormat::Table => report::missions_table(&answer, &mut out)?,
            OutputFormat::Json => json(&answer, &mut out)?,
            OutputFormat::Csv => report::missions_csv(&answer, &mut out)?,
        }
        out.flush()?;
        if let Some(directory) = &self.output {
            // Its readers would take it for what happened.
            let Some(scenario) = scenario else {
                let problem = "run.json is not written: in a scenario of this run, rounding moves turns in place";
                return Err(CliError::wrong(directory, problem));
            };
            // Without the collision maps of all vehicles: in hours they have too much for a picture.
            let ground = LayoutLevelView { imported, level: imported.layout.largest_level() };
            map::draw(&scenario, Some(&[]), Some(ground), directory, &mut notes())?;
            write_to(&directory.join("run.json"), &scenario.to_json())?;
        }
        Ok(status(answer.is_sound()))
    }
}

fn status(sound: bool) -> ExitCode {
    if sound { ExitCode::SUCCESS } else { ExitCode::from(CONFLICTS) }
}

fn print(printed: &OutputArgs, answer: &LifelongReport, is_complete: bool) -> Result<ExitCode, CliError> {
    let mut out = printed.out(false);
    match printed.form() {
        OutputFormat::Table => report::lifelong_table(answer, &mut out)?,
        OutputFormat::Json => json(answer, &mut out)?,
        OutputFormat::Csv => report::lifelong_csv(answer, &mut out)?,
    }
    out.flush()?;
    Ok(status(answer.is_sound() && is_complete))
}

/// Above 0, up to a week.
fn hours(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(hours) if hours > 0.0 && hours <= 168.0 => Ok(hours),
        _ => Err("a number above 0 and up to 168 is expected".into()),
    }
}

/// Of a whole, less than nine tenths.
fn part(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(part) if (0.0..0.9).contains(&part) => Ok(part),
        _ => Err("a number from 0 to less than 0.9 is expected".into()),
    }
}
