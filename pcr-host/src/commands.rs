//! The commands of the tool, one file each: their arguments, their work, and their exit statuses.

mod argument_rules;
mod brokers;
mod certify;
mod check;
mod compare;
mod completions;
mod demo;
mod error_hints;
mod exclusion_args;
mod fleet;
mod help;
mod import;
mod locks;
mod map;
mod nodes;
mod number;
mod plan;
mod printed;
mod regions;
mod scenario_command;
mod scenario_sources;
mod serve;
mod simulate;
mod traffic;

use crate::{abort, progress};
use clap::builder::{PathBufValueParser, TypedValueParser};
use clap::{Parser, Subcommand};
use pcr_formats::import::{ImportError, Warnings};
use pcr_formats::input::InputError;
use pcr_formats::output::{self, OverwriteError};
use pcr_formats::warning::WarningCode;
use pcr_planning::failure::ComputationError;
use pcr_planning::memory_budget;
pub(crate) use printed::complain;
use printed::{OutputArgs, OutputFormat, acknowledge, caution, quiet};
use scenario_sources::scenario;
use std::ffi::OsString;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::str::FromStr;
use std::sync::{Arc, Mutex};

/// Exit status: a plan that collides, or no plan.
const CONFLICTS: u8 = 1;
/// Exit status: wrong arguments, or something wrong with a scenario.
const WRONG_INPUT: u8 = 2;
/// Exit status: the output could not be written.
const NOT_WRITTEN: u8 = 3;
/// Exit status: the checker's own rounding does not tell.
const UNDECIDED: u8 = 4;

const STATUSES: &str = "\
Exit status:
  0  done; no contact, a plan for all, or a correct table
  1  a contact, no plan for all, or a wrong table
  2  wrong arguments, or a file that cannot be read or was refused
  3  the output could not be written
  4  undecided: rounding, or what is not on record, leaves it open
  134  a fault of pcr, which aborted; please report it
For those of one command: pcr COMMAND --help";

/// The exit statuses of a command that answers no question, with the reasons for [`WRONG_INPUT`].
fn statuses(wrong: &str) -> String {
    format!("Exit status:\n  0  done\n  2  {wrong}\n  3  the output could not be written")
}

/// The reasons for [`WRONG_INPUT`] of commands that read scenarios.
const SCENARIOS: &str = "wrong arguments, or one of the scenarios cannot be read or was refused";

/// The units of scenarios, for the help of commands that read them.
const UNITS: &str = "Units: metres, seconds, radians (heading_deg, sweep_deg: degrees)";

const EXAMPLES: &str = "\
Examples:
  pcr                                   the paper's 12 agents, with pictures
  pcr regions fleet.json                where and when each must not be
  pcr regions fleet.json --json         the same for programs
  pcr map fleet.json -o pictures        the same as pictures
  pcr check fleet.json                  whether they collide, moving as it says
  pcr plan fleet.json -o plan.json      later starts, so that they do not collide
  pcr plan fleet.json -o - | pcr check  of standard input, without a FILE";

/// Exact collision regions of discs on paths of lines and arcs.
///
/// Agents are discs that move on given paths. For each agent, pcr computes which parts of its path are blocked by another agent, and
/// when. It computes this in closed form and does not sample. Without a command it shows the paper's 12 agents and draws them to pcr-out/.
#[derive(Parser)]
#[command(name = "pcr", version, after_help = format!("{EXAMPLES}\n\n{UNITS}\n\n{STATUSES}"))]
pub(crate) struct Cli {
    /// Only errors, JSON and CSV; no tables or warnings
    #[arg(short, long, global = true, overrides_with = "quiet")]
    quiet: bool,
    #[command(flatten)]
    shared: printed::SharedOptions,
    #[command(subcommand)]
    command: Option<Command>,
}

#[derive(Subcommand)]
enum Command {
    Regions(regions::RegionsArgs),
    Certify(certify::CertifyArgs),
    Check(check::CheckArgs),
    Plan(plan::PlanArgs),
    Map(map::MapArgs),
    Simulate(Box<simulate::SimulateArgs>),
    Locks(locks::LocksArgs),
    Traffic(traffic::TrafficArgs),
    Nodes(nodes::NodesArgs),
    Import(import::ImportArgs),
    Serve(serve::ServeArgs),
    Compare(compare::CompareArgs),
    Fleet(fleet::FleetArgs),
    Demo(demo::DemoArgs),
    Completions(completions::CompletionsArgs),
    Man(completions::ManArgs),
}

impl Command {
    /// Whether the exit status answers what is asked, so that it has to be right even if nobody reads the rest.
    fn is_answered_by_status(&self) -> bool {
        match self {
            Self::Certify(_) | Self::Check(_) | Self::Plan(_) => true,
            Self::Simulate(_) | Self::Traffic(_) | Self::Fleet(_) => true,
            Self::Locks(arguments) => arguments.is_answered_by_status(),
            _ => false,
        }
    }
}

/// Does what the words of the command line ask for.
pub(crate) fn run(words: Vec<OsString>) -> Result<ExitCode, CliError> {
    survive_limits();
    let Some(arguments) = help::parse(words)? else { return Ok(ExitCode::SUCCESS) };
    let left = memory_budget::available_bytes();
    abort::watch(left);
    if arguments.shared.apply() {
        progress::request();
    }
    if arguments.quiet {
        printed::be_quiet();
        progress::silence();
    }
    if left == Some(0) {
        caution(
            WarningCode::Memory,
            "hardly any memory is left to this process; if it runs out, the answer is \"memory allocation of N bytes failed\", and \
             the exit status is 2",
        );
    }
    spread();
    if arguments.command.as_ref().is_some_and(Command::is_answered_by_status) {
        printed::go_to_the_end();
    }
    let status = run_command(arguments.command)?;
    printed::refuse_denied().map_err(CliError::arguments)?;
    Ok(status)
}

fn run_command(command: Option<Command>) -> Result<ExitCode, CliError> {
    match command {
        None => demo::DemoArgs::default().run(),
        Some(Command::Regions(arguments)) => arguments.run(),
        Some(Command::Certify(arguments)) => arguments.run(),
        Some(Command::Check(arguments)) => arguments.run(),
        Some(Command::Plan(arguments)) => arguments.run(),
        Some(Command::Map(arguments)) => arguments.run(),
        Some(Command::Simulate(arguments)) => arguments.run(),
        Some(Command::Locks(arguments)) => arguments.run(),
        Some(Command::Traffic(arguments)) => arguments.run(),
        Some(Command::Nodes(arguments)) => arguments.run(),
        Some(Command::Import(arguments)) => arguments.run(),
        Some(Command::Serve(arguments)) => arguments.run(),
        Some(Command::Compare(arguments)) => arguments.run(),
        Some(Command::Fleet(arguments)) => arguments.run(),
        Some(Command::Demo(arguments)) => arguments.run(),
        Some(Command::Completions(arguments)) => arguments.run(),
        Some(Command::Man(arguments)) => arguments.run(),
    }
}

/// A limit on the size of files is an error of a write, with its message, and no signal that ends the program.
fn survive_limits() {
    #[cfg(unix)]
    {
        use signal_hook::consts::SIGXFSZ;
        // Where a signal cannot be caught, it ends the program as it does others; no file is damaged by that.
        let _ = signal_hook::flag::register(SIGXFSZ, Arc::default());
    }
}

/// Work on all cores; where the system has not as many threads, on this one.
///
/// A pool whose threads do not all start cannot be made a second time, so they are tried before.
fn spread() {
    /// What a pool takes beside its threads, and more \[bytes\].
    const SPARE: usize = 1 << 20;
    // A thread that finds no memory as it starts ends the program. With a stack trace, which takes memory as well, it would never end.
    let usual = std::panic::take_hook();
    std::panic::set_hook(Box::new(|_| complain("there is no memory for another thread")));
    let mut spare = Vec::<u8>::new();
    let has_spare = spare.try_reserve_exact(SPARE).is_ok();
    std::hint::black_box(&mut spare);
    let gate = Arc::new(Mutex::new(()));
    let closed = gate.lock();
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let start = || {
        let gate = Arc::clone(&gate);
        std::thread::Builder::new().spawn(move || drop(gate.lock())).ok()
    };
    let threads: Vec<_> = (0..cores).map_while(|_| start()).collect();
    drop(closed);
    let all = has_spare && threads.len() == cores;
    // Their memory is taken again.
    threads.into_iter().for_each(|thread| drop(thread.join()));
    drop(spare);
    let pool = rayon::ThreadPoolBuilder::new();
    // A pool that is there already will do.
    let _ = if all { pool.build_global() } else { pool.num_threads(1).use_current_thread().build_global() };
    std::panic::set_hook(usual);
}

/// Why the tool stops.
pub(crate) enum CliError {
    /// With a message and an exit status.
    Error(String, u8),
    /// The arguments are wrong.
    Usage(Box<clap::Error>),
    /// The reader of the output has seen enough, and the exit status tells nothing.
    Closed,
}

impl From<InputError> for CliError {
    fn from(error: InputError) -> Self {
        Self::Error(error.to_string(), WRONG_INPUT)
    }
}

impl From<ComputationError> for CliError {
    fn from(failure: ComputationError) -> Self {
        Self::Error(failure.to_string(), WRONG_INPUT)
    }
}

/// Errors of the output; those of the input are [`InputError`]s.
impl From<io::Error> for CliError {
    fn from(error: io::Error) -> Self {
        match error.kind() {
            // Where the status is an answer, a reader of the output who goes is no error: this is of something else.
            io::ErrorKind::BrokenPipe if !printed::goes_to_the_end() => Self::Closed,
            _ => Self::Error(format!("standard output: cannot be written: {error}"), NOT_WRITTEN),
        }
    }
}

impl CliError {
    /// Wrong arguments that only the command itself can tell.
    fn arguments(problem: impl Into<String>) -> Self {
        Self::Error(problem.into(), WRONG_INPUT)
    }

    /// Something wrong with a file.
    fn wrong(file: &Path, problem: impl std::fmt::Display) -> Self {
        let name = if file == Path::new("-") { "standard input".into() } else { file.to_string_lossy() };
        Self::Error(format!("{name}: {problem}"), WRONG_INPUT)
    }

    /// Something wrong with the content of a file, at its line and column if they are known.
    fn refused(file: &Path, error: &ImportError) -> Self {
        let name = if file == Path::new("-") { "standard input".into() } else { file.to_string_lossy() };
        Self::Error(error.in_file(&name), WRONG_INPUT)
    }

    /// Something wrong in a file of missions, at its line and column.
    fn at(file: &Path, error: &pcr_formats::missions::MissionFileError) -> Self {
        let name = if file == Path::new("-") { "standard input".into() } else { file.to_string_lossy() };
        Self::Error(format!("{name}:{error}"), WRONG_INPUT)
    }

    /// A file or directory that could not be written.
    fn not_written(output: &Path, error: &io::Error) -> Self {
        if let Some(kept) = OverwriteError::from_io_error(error) {
            return Self::Error(kept.to_string(), WRONG_INPUT);
        }
        Self::Error(format!("{}: cannot be written: {error}", output.display()), NOT_WRITTEN)
    }
}

fn warn(file: &Path, warnings: &Warnings) {
    say(file, warnings.coded_lines());
}

/// Prints the warnings about a file, each with its code; not those that are acknowledged, and not more than people read.
fn say(file: &Path, lines: impl IntoIterator<Item = String>) {
    let mut lines = lines.into_iter().collect();
    acknowledge(&mut lines);
    if quiet() {
        return;
    }
    let name = if file == Path::new("-") { "standard input".into() } else { file.to_string_lossy() };
    for line in printed::few(lines) {
        complain(&format!("warning: {name}: {line}"));
    }
}

/// Tells which letters are boxes in the pictures of a folder.
fn warn_of_boxes(folder: &Path, written: &pcr_drawing::WrittenFiles) {
    /// Letters that are named; who writes in a script knows the others.
    const NAMED: usize = 8;
    let letters = &written.boxes;
    if letters.is_empty() {
        return;
    }
    let named: Vec<String> = letters.iter().take(NAMED).map(char::to_string).collect();
    let more = if letters.len() > NAMED { format!(" and {} more", letters.len() - NAMED) } else { String::new() };
    let text = format!(
        "PNG has boxes for letters that the font of the program lacks: {}{more}; SVG has them",
        named.join(" ")
    );
    say(folder, [WarningCode::MissingLetters.text(text)]);
}

/// A whole number from 0, such as a seed.
fn parse_integer<T: FromStr>(text: &str) -> Result<T, String> {
    text.parse().map_err(|_| "a whole number from 0 is expected".to_owned())
}

/// A number whose range the command checks, after the rules about its arguments; `expected` is told if it is none.
fn number<T: FromStr>(text: &str, expected: &str) -> Result<T, String> {
    text.parse().map_err(|_| format!("{expected} is expected"))
}

/// A whole number of a range.
fn whole_within<T: TryFrom<u64>>(text: &str, lo: u64, hi: u64) -> Result<T, String> {
    let number = text.parse::<u64>().ok().filter(|number| (lo..=hi).contains(number));
    let number = number.and_then(|number| T::try_from(number).ok());
    number.ok_or_else(|| format!("a whole number from {lo} to {hi} is expected"))
}

/// A number of a range.
fn within(text: &str, lo: f64, hi: f64) -> Result<f64, String> {
    let number = text.parse::<f64>().ok().filter(|number| (lo..=hi).contains(number));
    number.ok_or_else(|| format!("a number from {lo} to {hi} is expected"))
}

/// Whether an output is standard output.
fn is_standard(output: Option<&PathBuf>) -> bool {
    output.is_some_and(|output| is_stdout(output))
}

/// Whether a name is that of standard output.
fn is_stdout(output: &Path) -> bool {
    output == Path::new("-") || output::descriptor(output) == Some(1)
}

/// The name of a folder to be written.
fn folder() -> impl TypedValueParser<Value = PathBuf> {
    // An empty name, as of a variable that is not set, is refused by it.
    PathBufValueParser::new().try_map(|name| if name == Path::new("-") { Err(NO_FOLDER) } else { Ok(name) })
}

/// Why `-` is refused where a folder is written.
const NO_FOLDER: &str = "a folder is written, which standard output is not; one of this name is ./-";

/// Why `-` is refused where a file is written that is not for standard output.
const NO_STREAM: &str = "this is written to a file, not to standard output; one of this name is ./-";

/// The same where what is written may replace the file that it is made of, if that is of the same kind; no other that was read.
fn write_over(
    output: &Path,
    content: &str,
    input: &Path,
    is_alike: impl FnOnce() -> Result<bool, CliError>,
) -> Result<(), CliError> {
    if !is_stdout(output) && output::is_same(output, input) && is_alike()? {
        return output::write_over(output, content).map_err(|error| CliError::not_written(output, &error));
    }
    write_to(output, content)
}

/// Writes a file, or standard output for `-`; none that was read.
fn write_to(output: &Path, content: &str) -> Result<(), CliError> {
    if is_stdout(output) {
        let mut out = printed::stdout();
        out.write_all(content.as_bytes())?;
        return Ok(out.flush()?);
    }
    output::write(output, content).map_err(|error| CliError::not_written(output, &error))
}
