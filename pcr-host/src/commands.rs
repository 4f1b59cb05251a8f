//! The commands of the tool, a file each: their arguments, what they do with them, and how that may end.

mod certify;
mod check;
mod compare;
mod evaluate;
mod import;
mod locks;
mod map;
mod number;
mod overview;
mod plan;
mod regions;
mod simulate;
mod traffic;
mod work;

use clap::{Parser, Subcommand, ValueEnum};
use pcr_host::import::{Options, Warnings};
use pcr_host::input::{self, InputError};
use pcr_host::paper;
use pcr_host::regions::Failure;
use pcr_host::scenario::Scenario;
use std::io::{self, Write};
use std::path::Path;
use std::process::ExitCode;

/// Exit status: a plan that collides, or no plan.
const CONFLICTS: u8 = 1;
/// Exit status: wrong arguments, or something wrong with a scenario.
const WRONG_INPUT: u8 = 2;
/// Exit status: the output could not be written.
const NOT_WRITTEN: u8 = 3;

const STATUSES: &str = "\
Exit status:
  0  done
  2  wrong arguments, or a scenario that cannot be read or was refused (one line of JSON Lines is enough)
  3  the output could not be written";

const EXAMPLES: &str = "\
Examples:
  pcr                                      the paper's 12 agents: its tables beside ours, pictures in pcr-out/
  pcr regions fleet.json                   what every agent has to keep out of, as a table
  pcr regions fleet.json --format json     the same for programs
  pcr map fleet.json -o pictures           the same as pictures
  pcr check fleet.json                     whether the agents collide, moving as the file says
  pcr plan fleet.json -o plan.json         later starts, so that they do not
  pcr simulate -o replay.html              robots in closed loop, with noise and delays, and a page to watch them";

/// Exact collision regions of discs on line/arc paths.
///
/// Agents are discs that move on given paths of lines and arcs. pcr computes, for each of them, at what times it must
/// not be where on its path because of each other one: in closed form, without sampling. Without a command it shows
/// the paper's simulation of 12 agents and draws it to pcr-out/.
#[derive(Parser)]
#[command(name = "pcr", version, about, after_help = format!("{EXAMPLES}\n\n{STATUSES}"))]
pub(crate) struct Arguments {
    #[command(subcommand)]
    command: Option<Command>,
}

#[derive(Subcommand)]
enum Command {
    Regions(regions::Arguments),
    Certify(certify::Arguments),
    Check(check::Arguments),
    Plan(plan::Arguments),
    Simulate(Box<simulate::Arguments>),
    Compare(compare::Arguments),
    Evaluate(evaluate::Arguments),
    Map(map::Arguments),
    Locks(locks::Arguments),
    Traffic(traffic::Arguments),
    Import(import::Arguments),
}

impl Arguments {
    /// Does what is asked for.
    pub(crate) fn run(self) -> Result<ExitCode, Stop> {
        match self.command {
            None => overview::run(),
            Some(Command::Regions(arguments)) => arguments.run(),
            Some(Command::Certify(arguments)) => arguments.run(),
            Some(Command::Check(arguments)) => arguments.run(),
            Some(Command::Plan(arguments)) => arguments.run(),
            Some(Command::Simulate(arguments)) => arguments.run(),
            Some(Command::Compare(arguments)) => arguments.run(),
            Some(Command::Evaluate(arguments)) => arguments.run(),
            Some(Command::Map(arguments)) => arguments.run(),
            Some(Command::Locks(arguments)) => arguments.run(),
            Some(Command::Traffic(arguments)) => arguments.run(),
            Some(Command::Import(arguments)) => arguments.run(),
        }
    }
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum Form {
    /// For reading
    Table,
    /// One object a scenario
    Json,
    /// One line a region or conflict
    Csv,
}

/// Why the tool stops.
pub(crate) enum Stop {
    /// With a message and an exit status.
    Error(String, u8),
    /// The reader of the output has seen enough.
    Closed,
}

impl From<InputError> for Stop {
    fn from(error: InputError) -> Self {
        Self::Error(error.to_string(), WRONG_INPUT)
    }
}

impl From<Failure> for Stop {
    fn from(failure: Failure) -> Self {
        Self::Error(failure.to_string(), WRONG_INPUT)
    }
}

/// Errors of the output; those of the input are [`InputError`]s.
impl From<io::Error> for Stop {
    fn from(error: io::Error) -> Self {
        match error.kind() {
            io::ErrorKind::BrokenPipe => Self::Closed,
            _ => Self::Error(format!("standard output: cannot be written: {error}"), NOT_WRITTEN),
        }
    }
}

impl Stop {
    /// Something wrong with a file, or with the paper's scenario.
    fn wrong(file: Option<&Path>, problem: impl std::fmt::Display) -> Self {
        let message = match file {
            Some(file) => format!("{}: {problem}", file.display()),
            None => problem.to_string(),
        };
        Self::Error(message, WRONG_INPUT)
    }

    /// A file or directory that could not be written.
    fn not_written(output: &Path, error: &io::Error) -> Self {
        Self::Error(format!("{}: cannot be written: {error}", output.display()), NOT_WRITTEN)
    }
}

/// A message on standard error. Where that is closed, the exit status has to do.
pub(crate) fn complain(message: &str) {
    let _ = writeln!(io::stderr(), "pcr: {message}");
}

fn paper12() -> Result<Scenario, Stop> {
    Scenario::from_json(paper::SCENARIO).map_err(|error| Stop::Error(error.to_string(), WRONG_INPUT))
}

/// The scenario in a file, in whatever format, or the paper's; warnings about it are told.
fn scenario(file: Option<&Path>, import: &Options) -> Result<Scenario, Stop> {
    let mut scenario = match file {
        None => paper12()?,
        Some(file) => {
            let (scenario, warnings) = input::read(file, import)?;
            warn(file, &warnings);
            scenario
        }
    };
    scenario.give_margin(import.margin.unwrap_or(0.0));
    Ok(scenario)
}

fn warn(file: &Path, warnings: &Warnings) {
    for line in warnings.lines() {
        complain(&format!("warning: {}: {line}", file.display()));
    }
}

/// Writes a scenario file.
fn write_to(output: &Path, scenario: &Scenario) -> Result<(), Stop> {
    std::fs::write(output, scenario.to_json()).map_err(|error| Stop::not_written(output, &error))
}
