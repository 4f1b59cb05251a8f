//! `pcr plan`.

use super::map::{are_few, ask_for_regions, draw};
use super::printed::notes;
use super::scenario_sources::{ScenarioSource, gathered};
use super::{
    CONFLICTS, CliError, OutputArgs, OutputFormat, WRONG_INPUT, acknowledge, complain, folder, is_standard, say,
    write_over, write_to,
};
use crate::progress::ProgressLine;
use clap::{Args, ValueEnum};
use pcr_formats::import::ImportOptions;
use pcr_formats::output;
use pcr_formats::scenario::{Agent, Scenario};
use pcr_formats::warning::WarningCode;
use pcr_planning::failure::ComputationError;
use pcr_planning::plan::{DelaySearchOptions, Objective, PlanMethod, PlanOptions, PlanReport, PlanStage, PriorityRule};
use pcr_planning::regions::find;
use pcr_planning::report;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Duration;

const STATUSES: &str = "\
Exit status:
  0  a plan, checked as by pcr check
  1  no plan for all agents, even if --leave-out found a plan for some
  2  wrong arguments, or one of the scenarios cannot be read or was refused
  3  the output could not be written";

const EXAMPLES: &str = "\
Examples:
  pcr plan fleet.json -o plan.json                  the file with start delays
  pcr plan fleet.json -o - | pcr check              the table: standard error
  pcr plan fleet.json --pictures maps               maps before and after
  pcr plan fleet.json --method speed -o plan.json   also waits and other speeds
  pcr plan fleet.json --priority 7,3 --json         agents 7 and 3 first
  pcr plan fleet.json --leave-out -o plan.json      leave out the fewest
  pcr plan fleet.json --prove --time-limit 60       search for at most 60 s";

/// Plan later starts or other speeds, so that nobody collides
#[derive(Args)]
#[command(after_help = format!("{EXAMPLES}\n\n{STATUSES}"))]
pub(super) struct PlanArgs {
    /// Scenarios (JSON); standard input if left out or `-`
    #[arg(value_name = "FILE")]
    files: Vec<PathBuf>,
    /// The scenario with the plan; `-` for standard output
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Draw the maps without and with the plan: DIR/before, DIR/after
    #[arg(long, value_name = "DIR", value_parser = folder())]
    pictures: Option<PathBuf>,
    /// delay: later starts; speed: also waits on the way and other speeds
    #[arg(long, value_enum, default_value_t = PlanMethodArg::Delay, hide_possible_values = true)]
    method: PlanMethodArg,
    /// Who goes first: agents by number or label with commas between them (`\,` for one in a label), or `longest`, `crowded`, `best` [default: best]
    #[arg(long, value_name = "ORDER", value_parser = asked)]
    priority: Option<PriorityArg>,
    /// Minimize the sum of times to arrival, or makespan, the last arrival
    #[arg(long, value_enum, value_name = "WHAT", default_value_t = ObjectiveArg::Sum, hide_possible_values = true)]
    objective: ObjectiveArg,
    /// Leave agents out if need be; with delays, the fewest
    #[arg(long)]
    leave_out: bool,
    /// Search until it is proved that no plan is better
    #[arg(long)]
    prove: bool,
    /// End the search after S seconds; plans may vary by run
    #[arg(long, value_name = "S", value_parser = seconds)]
    time_limit: Option<Duration>,
    #[command(flatten)]
    printed: OutputArgs,
    #[command(flatten)]
    import: ImportOptions,
}

/// Folders of the maps without and with the plan.
const PICTURES: [&str; 2] = ["before", "after"];

#[derive(Clone, Copy, ValueEnum)]
enum PlanMethodArg {
    Delay,
    Speed,
}

impl From<PlanMethodArg> for PlanMethod {
    fn from(means: PlanMethodArg) -> Self {
        match means {
            PlanMethodArg::Delay => Self::Delay,
            PlanMethodArg::Speed => Self::Speed,
        }
    }
}

#[derive(Clone, Copy, ValueEnum)]
enum ObjectiveArg {
    Sum,
    Makespan,
}

impl From<ObjectiveArg> for Objective {
    fn from(least: ObjectiveArg) -> Self {
        match least {
            ObjectiveArg::Sum => Self::Sum,
            ObjectiveArg::Makespan => Self::Makespan,
        }
    }
}

fn seconds(text: &str) -> Result<Duration, String> {
    let seconds = text.parse().ok().and_then(|seconds| Duration::try_from_secs_f64(seconds).ok());
    seconds.ok_or_else(|| "a number of seconds from 0 is expected".to_owned())
}

/// An order of priority from the command line.
#[derive(Clone)]
enum PriorityArg {
    Known(&'static str, PriorityRule),
    /// Agents by number or label.
    Agents(Vec<String>),
}

fn asked(text: &str) -> Result<PriorityArg, String> {
    match text {
        "longest" => return Ok(PriorityArg::Known("longest", PriorityRule::Longest)),
        "crowded" => return Ok(PriorityArg::Known("crowded", PriorityRule::Crowded)),
        "best" => return Ok(PriorityArg::Known("best", PriorityRule::Best)),
        _ => {}
    }
    // A comma of a label is written with a backslash before it.
    const COMMA: &str = "\u{0}";
    let unescaped = |agent: &str| agent.trim().replace(COMMA, ",");
    let agents: Vec<String> = text.replace("\\,", COMMA).split(',').map(unescaped).collect();
    for (place, agent) in agents.iter().enumerate() {
        if agent.is_empty() {
            return Err("an agent without a name".into());
        }
        if agents.iter().take(place).any(|before| before == agent) {
            return Err(format!("agent {agent} is there twice"));
        }
    }
    Ok(PriorityArg::Agents(agents))
}

impl PriorityArg {
    fn of(&self, scenario: &Scenario) -> Result<PriorityRule, String> {
        match self {
            Self::Known(word, priority) => match scenario.agents.iter().find(|agent| agent.label == *word) {
                Some(Agent { id, .. }) => Err(format!(
                    "--priority {word} is an order, and the label of agent {id}; name that by its number, or give it another label"
                )),
                None => Ok(priority.clone()),
            },
            Self::Agents(agents) => {
                let mut ids = Vec::new();
                for agent in agents {
                    let id = find(scenario, agent).map_err(|failure| failure.to_string())?;
                    if !ids.contains(&id) {
                        ids.push(id);
                    }
                }
                Ok(PriorityRule::Given(ids))
            }
        }
    }
}

impl PlanArgs {
    pub(super) fn run(self) -> Result<ExitCode, CliError> {
        if matches!(self.method, PlanMethodArg::Speed) && (self.prove || self.time_limit.is_some()) {
            let option = if self.prove { "--prove" } else { "--time-limit" };
            return Err(CliError::arguments(format!(
                "{option} has no effect: only start delays are searched for that long"
            )));
        }
        if !matches!(self.priority, None | Some(PriorityArg::Known(_, PriorityRule::Best)))
            && (self.prove || self.time_limit.is_some())
        {
            let option = if self.prove { "--prove" } else { "--time-limit" };
            return Err(CliError::arguments(format!(
                "{option} has no effect: --priority gives the order, and no better one is searched for"
            )));
        }
        let sources = gathered(self.files.clone(), &self.import)?;
        if sources.len() > 1 {
            if self.output.as_ref().is_some_and(|output| !is_standard(Some(output))) {
                return Err(CliError::arguments("--output: one file for the plans of several; - takes them all"));
            }
            if self.pictures.is_some() {
                return Err(CliError::arguments("--pictures: one folder for the plans of several"));
            }
        }
        if let (Some(output), Some(directory)) = (&self.output, &self.pictures)
            && !is_standard(Some(output))
            && PICTURES.iter().any(|folder| output::are_at_odds(output, &directory.join(folder)))
        {
            return Err(CliError::arguments("--output: pictures are written there; give another name"));
        }
        let mut out = self.printed.out(is_standard(self.output.as_ref()));
        if self.printed.form() == OutputFormat::Csv {
            out.write_all(report::PLAN_CSV_HEADER.as_bytes())?;
        }
        let (mut refused, mut unsolved) = (0, false);
        for (place, source) in sources.iter().enumerate() {
            if self.printed.form() == OutputFormat::Table && place > 0 {
                writeln!(out)?;
            }
            match self.plan(source, sources.len() > 1, &mut out) {
                Ok(solved) => unsolved |= !solved,
                Err(CliError::Error(message, WRONG_INPUT)) if sources.len() > 1 => {
                    refused += 1;
                    // Nobody would miss it in a stream of plans.
                    if is_standard(self.output.as_ref()) {
                        write_to(Path::new("-"), &Scenario::missing(&source.name(), &message))?;
                    }
                    if self.printed.form() == OutputFormat::Json {
                        let (method, objective) = (self.method.into(), self.objective.into());
                        report::json(
                            &PlanReport::refused(&source.name(), method, objective, message.clone()),
                            &mut out,
                        )?;
                        out.flush()?;
                    }
                    complain(&message);
                }
                Err(stop) => return Err(stop),
            }
        }
        match refused {
            0 => Ok(if unsolved { ExitCode::from(CONFLICTS) } else { ExitCode::SUCCESS }),
            _ => Err(CliError::Error(format!("{refused} of {} scenarios refused", sources.len()), WRONG_INPUT)),
        }
    }

    /// Whether there is a plan for all; `several` if this one is not the only one.
    fn plan(&self, source: &ScenarioSource, several: bool, out: &mut impl Write) -> Result<bool, CliError> {
        let scenario = source.scenario(&self.import)?;
        let wrong = |failure: ComputationError| CliError::wrong(source.file(), failure);
        let priority = match &self.priority {
            Some(asked) => asked.of(&scenario).map_err(|problem| CliError::wrong(source.file(), problem))?,
            None => PriorityRule::Best,
        };
        let request = PlanOptions {
            method: self.method.into(),
            priority,
            objective: self.objective.into(),
            leave_out: self.leave_out,
            effort: DelaySearchOptions { prove: self.prove, time: self.time_limit },
        };
        let agents = scenario.agents.len();
        if self.pictures.is_some() {
            are_few(agents, "maps are drawn").and_then(|()| ask_for_regions(&scenario)).map_err(wrong)?;
        }
        let what = format!("{}: planning {agents} agents", source.file().display());
        let progress = match self.time_limit {
            Some(limit) => ProgressLine::until(what, limit),
            None => ProgressLine::new(what),
        };
        // A limit tells more about the remaining time than the parts of the work.
        let told = |part: PlanStage, done: usize, total: usize| {
            if self.time_limit.is_none() {
                progress.set_part(part.name(), done, total);
            }
        };
        let planned = PlanReport::watched(&scenario, &request, &told);
        drop(progress);
        let (mut plan, mut solved) = planned.map_err(wrong)?;
        acknowledge(&mut plan.warnings);
        solved.iter_mut().for_each(|solved| acknowledge(&mut solved.warnings));
        plan.name = source.display_name(&plan.name);
        // Those of the scenario are said already.
        say(source.file(), plan.warnings.iter().skip(scenario.warnings.len()).cloned());
        if let Some(directory) = &self.pictures {
            // Where there can be none, there is no file of the plan, either.
            output::folder(directory).map_err(|error| CliError::not_written(directory, &error))?;
        }
        match (&self.output, &solved) {
            (Some(output), Some(solved)) => {
                write_over(output, &solved.to_json(), source.file(), || source.is_scenario(&self.import))?;
            }
            // Nobody would miss it in a stream of plans: what reads them refuses this, as it refuses a stream of none.
            (Some(output), None) if several && is_standard(Some(output)) => {
                let why = report::reasons(&plan).next().unwrap_or_default();
                let missing = Scenario::missing(&scenario.name, &format!("no plan: {why}"));
                write_over(output, &missing, source.file(), || Ok(false))?;
            }
            _ => {}
        }
        match self.printed.form() {
            OutputFormat::Table => report::plan_table(&plan, out)?,
            OutputFormat::Json => report::json(&plan, out)?,
            OutputFormat::Csv => {
                report::plan_csv(&plan, out)?;
                // Its lines are agents.
                let (file, open) = (source.file().display(), report::left_open(&plan));
                open.into_iter().chain(report::reasons(&plan)).for_each(|line| complain(&format!("{file}: {line}")));
            }
        }
        out.flush()?;
        if let Some(directory) = &self.pictures {
            // Beside the report, which may be for a machine.
            let ([before, after], told) = (PICTURES.map(|folder| directory.join(folder)), &mut notes());
            draw(&scenario, None, None, &before, told)?;
            match &solved {
                Some(solved) => draw(solved, None, None, &after, told)?,
                None if after.join("index.html").exists() => {
                    let text = "of an earlier plan, and there is none now";
                    say(&after, [WarningCode::EarlierPictures.text(text)]);
                }
                None => {}
            }
        }
        Ok(solved.is_some() && plan.left_out.is_empty())
    }
}
