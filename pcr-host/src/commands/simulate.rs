//! `pcr simulate`.

use super::{CONFLICTS, Form, Stop, scenario};
use clap::{Args, ValueEnum};
use pcr_host::import::Options;
use pcr_host::progress::Progress;
use pcr_host::regions::Failure;
use pcr_host::report;
use pcr_host::simulate::{self, Controller, Disturbance, Settings, Simulation, Task, forage};
use std::io::{self, BufWriter, Write};
use std::path::PathBuf;
use std::process::ExitCode;

const STATUSES: &str = "\
Exit status:
  0  done; under pcr, if it was asked for, all missions were done without a collision
  1  under pcr there was a collision, or a mission was not done
  2  wrong arguments, or a scenario that cannot be read or was refused
  3  the output could not be written";

const EXAMPLES: &str = "\
Examples:
  pcr simulate                                 four robots foraging, under each of the three controllers
  pcr simulate --seed 7 -o replay.html         the same with other disturbances, and a page on which to watch it
  pcr simulate fleet.json --controller pcr     any other scenario: each agent with a path is a robot
  pcr simulate --noise 0.005 --delay 0         with a better camera, and nobody is held up";

/// Simulate robots in closed loop, with noise, slip and delays: planned with collision regions, and two other ways
#[derive(Args)]
#[command(after_help = format!("{EXAMPLES}\n\n{STATUSES}"))]
pub(super) struct Arguments {
    /// Scenario (JSON); `-` reads it from standard input; four robots foraging if left out
    file: Option<PathBuf>,
    /// Only this controller
    #[arg(long, value_enum)]
    controller: Option<Choice>,
    /// The same seed gives the same run
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Seconds from one plan to the next, 0.05 to 3600
    #[arg(long, value_name = "S", default_value_t = 2.0, value_parser = |text: &str| within(text, 0.05, 3600.0))]
    replan: f64,
    /// Largest error of an observed position in metres, 0 to 10
    #[arg(long, value_name = "M", default_value_t = 0.015, value_parser = |text: &str| within(text, 0.0, 10.0))]
    noise: f64,
    /// How far a robot may be off its path in metres, 0 to 10
    #[arg(long, value_name = "M", default_value_t = 0.005, value_parser = |text: &str| within(text, 0.0, 10.0))]
    drift: f64,
    /// Largest part of its way that a robot loses to slip, 0 to 0.9
    #[arg(long, value_name = "PART", default_value_t = 0.05, value_parser = |text: &str| within(text, 0.0, 0.9))]
    slip: f64,
    /// Longest time for which a robot is held up, on average every 10 s, in seconds, 0 to 3600
    #[arg(long, value_name = "S", default_value_t = 1.0, value_parser = |text: &str| within(text, 0.0, 3600.0))]
    delay: f64,
    /// How often each foraging robot goes to its resource and back
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = clap::value_parser!(u32).range(1..=1000))]
    trips: u32,
    /// A page on which to watch the runs, one HTML file
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Form of the output
    #[arg(long, value_enum, default_value_t = Form::Table)]
    format: Form,
    #[command(flatten)]
    import: Options,
}

#[derive(Clone, Copy, ValueEnum)]
enum Choice {
    /// A supervisor with collision regions
    Pcr,
    /// An artificial potential field
    Potential,
    /// Optimal reciprocal collision avoidance
    Orca,
}

impl From<Choice> for Controller {
    fn from(choice: Choice) -> Self {
        match choice {
            Choice::Pcr => Self::Pcr,
            Choice::Potential => Self::Potential,
            Choice::Orca => Self::Orca,
        }
    }
}

fn within(text: &str, lo: f64, hi: f64) -> Result<f64, String> {
    let number: f64 = text.parse().map_err(|_| "it is no number".to_owned())?;
    if (lo..=hi).contains(&number) { Ok(number) } else { Err(format!("allowed is {lo} to {hi}")) }
}

impl Arguments {
    pub(super) fn run(self) -> Result<ExitCode, Stop> {
        let file = self.file.as_deref();
        let named = |failure: Failure| Stop::wrong(file, failure);
        let task = match file {
            None => forage::task(self.seed, self.trips),
            Some(_) => Task::of(&scenario(file, &self.import)?).map_err(named)?,
        };
        let Self { noise, slip, delay, drift, .. } = self;
        let disturbance = Disturbance { noise, slip, delay, drift };
        let settings = Settings { seed: self.seed, replan: self.replan, disturbance };
        let controllers = self.controller.map_or(Controller::ALL.to_vec(), |choice| vec![choice.into()]);
        let progress = Progress::new("runs");
        let mut outcomes = Vec::new();
        for (done, &controller) in controllers.iter().enumerate() {
            progress.set(done, controllers.len());
            outcomes.push(simulate::run(&task, controller, settings).map_err(named)?);
        }
        drop(progress);
        if let Some(output) = &self.output {
            let page = simulate::page(&task, &outcomes);
            std::fs::write(output, page).map_err(|error| Stop::not_written(output, &error))?;
        }
        let simulation = Simulation::of(&task, settings, &outcomes);
        let mut out = BufWriter::new(io::stdout().lock());
        match self.format {
            Form::Table => report::simulation_table(&simulation, &mut out)?,
            Form::Json => report::json(&simulation, &mut out)?,
            Form::Csv => report::simulation_csv(&simulation, &mut out)?,
        }
        out.flush()?;
        Ok(if simulation.is_as_promised() { ExitCode::SUCCESS } else { ExitCode::from(CONFLICTS) })
    }
}
