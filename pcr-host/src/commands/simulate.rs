//! `pcr simulate`.

use super::scenario_sources::source;
use super::{
    CONFLICTS, CliError, OutputArgs, OutputFormat, acknowledge, is_standard, parse_integer, say, scenario,
    whole_within, within, write_to,
};
use crate::progress::ProgressLine;
use clap::{Args, ValueEnum};
use pcr_drawing::replay;
use pcr_execution::report;
use pcr_execution::simulate::{
    self, ClosedLoopOptions, ControllerKind, Disturbance, SimulationReport, SimulationTask, forage,
};
use pcr_formats::import::ImportOptions;
use pcr_planning::failure::ComputationError;
use pcr_planning::report::json;
use std::io::Write;
use std::path::PathBuf;
use std::process::ExitCode;

const STATUSES: &str = "\
Exit status:
  0  done; with the controller pcr: without a collision, and all missions done
  1  with the controller pcr there was a collision, or a mission was not done
  2  wrong arguments, or a scenario that cannot be read or was refused
  3  the output could not be written";

const EXAMPLES: &str = "\
Examples:
  pcr simulate --foraging                    four robots, under each controller
  pcr simulate --foraging -o replay.html     and a page on which to watch them
  pcr simulate fleet.json --controller pcr   each agent with a path is a robot
  pcr simulate fleet.json --seed 7           the same with other disturbances
  pcr simulate fleet.json --noise 0.005      with a better camera";

/// From one plan to the next \[s\].
const REPLAN: f64 = 2.0;

/// How often a foraging robot goes to its resource and back.
const TRIPS: u32 = 3;

/// Simulate robots in closed loop, with noise, slip and delays
#[derive(Args)]
#[command(after_help = format!("{EXAMPLES}\n\n{STATUSES}"))]
pub(super) struct SimulateArgs {
    /// Scenario (JSON); standard input if left out or `-`
    file: Option<PathBuf>,
    /// Four robots that forage, instead of a scenario
    #[arg(long)]
    foraging: bool,
    /// Only this controller: pcr, potential or orca
    #[arg(long, value_enum, value_name = "NAME", hide_possible_values = true)]
    controller: Option<ControllerArg>,
    /// The same seed gives the same run
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = parse_integer::<u64>)]
    seed: u64,
    /// Time between plans under pcr, 0.05 to 3600 s [default: 2]
    #[arg(long, value_name = "S", value_parser = |text: &str| within(text, 0.05, 3600.0))]
    replan: Option<f64>,
    /// Largest camera error, to 10 m
    #[arg(long, value_name = "M", default_value_t = 0.015, value_parser = |text: &str| within(text, 0.0, 10.0))]
    noise: f64,
    /// Largest distance from paths, to 10 m
    #[arg(long, value_name = "M", default_value_t = 0.005, value_parser = |text: &str| within(text, 0.0, 10.0))]
    drift: f64,
    /// Largest fraction of its way that a robot loses to slip, 0 to 0.9
    #[arg(long, value_name = "PART", default_value_t = 0.05, value_parser = |text: &str| within(text, 0.0, 0.9))]
    slip: f64,
    /// Longest stop, to 3600 s; each robot stops about every 10 s
    #[arg(long, value_name = "S", default_value_t = 1.0, value_parser = |text: &str| within(text, 0.0, 3600.0))]
    delay: f64,
    /// Trips of each foraging robot (3 if left out)
    #[arg(long, value_name = "N", value_parser = |text: &str| whole_within::<u32>(text, 1, 1000))]
    trips: Option<u32>,
    /// A page to watch the runs; `-` for standard output
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    #[command(flatten)]
    printed: OutputArgs,
    #[command(flatten)]
    import: ImportOptions,
}

#[derive(Clone, Copy, ValueEnum)]
enum ControllerArg {
    Pcr,
    Potential,
    Orca,
}

impl ControllerArg {
    fn controller(self) -> ControllerKind {
        match self {
            Self::Pcr => ControllerKind::Pcr,
            Self::Potential => ControllerKind::Potential,
            Self::Orca => ControllerKind::Orca,
        }
    }
}

impl SimulateArgs {
    pub(super) fn run(self) -> Result<ExitCode, CliError> {
        if self.foraging
            && let Some(option) = self.import.given().first()
        {
            return Err(CliError::arguments(format!("{option} has no effect: the foraging robots are as they are")));
        }
        if !self.foraging && self.trips.is_some() {
            return Err(CliError::arguments("--trips has no effect: only foraging robots go to and fro"));
        }
        if matches!(self.controller, Some(ControllerArg::Potential | ControllerArg::Orca)) {
            let margin = self.import.margin.map(|_| "--margin");
            if let Some(option) = self.replan.map(|_| "--replan").or(margin) {
                return Err(CliError::arguments(format!("{option} has no effect: only pcr plans, and keeps margins")));
            }
        }
        let file = if self.foraging { PathBuf::from("--foraging") } else { source(self.file)? };
        let named = |failure: ComputationError| CliError::wrong(&file, failure);
        let task = match self.foraging {
            true => forage::task(self.seed, self.trips.unwrap_or(TRIPS)),
            false => {
                let scenario = scenario(&file, &self.import)?;
                let mut task = SimulationTask::from_scenario(&scenario).map_err(named)?;
                acknowledge(&mut task.warnings);
                // Those of the scenario are said already.
                say(&file, task.warnings.iter().skip(scenario.warnings.len()).cloned());
                task
            }
        };
        let Self { noise, slip, delay, drift, .. } = self;
        let disturbance = Disturbance { noise, slip, delay, drift };
        let settings = ClosedLoopOptions { seed: self.seed, replan: self.replan.unwrap_or(REPLAN), disturbance };
        let controllers = match self.controller {
            Some(choice) => vec![choice.controller()],
            None => ControllerKind::ALL.to_vec(),
        };
        let progress = ProgressLine::new("hundredths of runs");
        let mut outcomes = Vec::new();
        for (done, &controller) in controllers.iter().enumerate() {
            let told = |share: f64| progress.set(100 * done + (100.0 * share) as usize, 100 * controllers.len());
            outcomes.push(simulate::watched(&task, controller, settings, &told).map_err(named)?);
        }
        drop(progress);
        if let Some(output) = &self.output {
            write_to(output, &replay::page(&task, &outcomes).map_err(named)?)?;
        }
        let mut simulation = SimulationReport::from_runs(&task, settings, &outcomes);
        acknowledge(&mut simulation.warnings);
        say(&file, simulation.warnings.iter().skip(task.warnings.len()).cloned());
        let mut out = self.printed.out(is_standard(self.output.as_ref()));
        match self.printed.form() {
            OutputFormat::Table => report::simulation_table(&simulation, &mut out)?,
            OutputFormat::Json => json(&simulation, &mut out)?,
            OutputFormat::Csv => report::simulation_csv(&simulation, &mut out)?,
        }
        out.flush()?;
        Ok(if simulation.is_as_promised() { ExitCode::SUCCESS } else { ExitCode::from(CONFLICTS) })
    }
}
