//! The command `pcr`: its arguments, its exit statuses, and nothing else.

use clap::{Parser, Subcommand, ValueEnum};
use pcr_host::fleet::Fleet;
use pcr_host::input::{self, InputError, Lines};
use pcr_host::paper;
use pcr_host::picture;
use pcr_host::progress::Progress;
use pcr_host::regions::{self, Answer, Failure, Request};
use pcr_host::report;
use pcr_host::scenario::Scenario;
use std::io::{self, BufReader, BufWriter, IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

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
  pcr map fleet.json -o pictures           the same as pictures";

const REGIONS_EXAMPLES: &str = "\
Examples:
  pcr regions                                       the paper's 12 agents
  pcr regions fleet.json --agent 3                  what agent 3 has to keep out of
  pcr regions fleet.json --format csv > fleet.csv   a line a region
  pcr regions fleet.json --format json --slices 9   with the lengths covered at 9 times of each region
  pcr regions - --format json < fleets.jsonl        JSON Lines: a scenario a line in, a line a scenario out";

const MAP_EXAMPLES: &str = "\
Examples:
  pcr map -o pcr-out                  the paper's 12 agents
  pcr map fleet.json -o pictures      any other scenario";

/// Directory for the pictures of `pcr` alone.
const DIRECTORY: &str = "pcr-out";

/// Exact collision regions of discs on line/arc paths.
///
/// Agents are discs that move on given paths of lines and arcs. pcr computes, for each of them, at what times it must
/// not be where on its path because of each other one: in closed form, without sampling. Without a command it shows
/// the paper's simulation of 12 agents and draws it to pcr-out/.
#[derive(Parser)]
#[command(name = "pcr", version, about, after_help = format!("{EXAMPLES}\n\n{STATUSES}"))]
struct Arguments {
    #[command(subcommand)]
    command: Option<Command>,
}

#[derive(Subcommand)]
enum Command {
    /// Print the collision regions of a scenario
    #[command(after_help = format!("{REGIONS_EXAMPLES}\n\n{STATUSES}"))]
    Regions {
        /// Scenario (JSON); `-` reads JSON Lines on standard input; the paper's 12 agents if left out
        file: Option<PathBuf>,
        /// Form of the output
        #[arg(long, value_enum, default_value_t = Form::Table)]
        format: Form,
        /// Only the regions that this agent has to keep out of
        #[arg(long, value_name = "ID")]
        agent: Option<u64>,
        /// Add the lengths covered at N evenly spaced inner times of each region (JSON only)
        #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(0..=MOST_SLICES))]
        slices: Option<u32>,
        /// Number format of the computation
        #[arg(long, value_enum, default_value_t = Number::F64)]
        scalar: Number,
    },
    /// Draw a scenario: its paths, and the extended collision map of each agent, as SVG and PNG
    #[command(after_help = format!("{MAP_EXAMPLES}\n\n{STATUSES}"))]
    Map {
        /// Scenario (JSON); `-` reads it from standard input; the paper's 12 agents if left out
        file: Option<PathBuf>,
        /// Directory for the pictures; created where it does not exist, files in it are overwritten
        #[arg(short, long, value_name = "DIR")]
        output: PathBuf,
    },
}

/// Slices that are given for a region: more than any picture or table can use, and not more than memory holds.
const MOST_SLICES: i64 = 10_000;

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum Form {
    /// For reading, in the form of the paper's Table VII
    Table,
    /// One object a scenario
    Json,
    /// One line a region
    Csv,
}

#[derive(Clone, Copy, ValueEnum)]
enum Number {
    /// 64-bit floating point
    F64,
    /// 32-bit floating point, as on a small machine
    F32,
}

/// Why the tool stops.
enum Stop {
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

fn main() -> ExitCode {
    let done = match Arguments::parse().command {
        None => overview(),
        Some(Command::Regions { slices: Some(_), format: Form::Table | Form::Csv, .. }) => {
            Err(Stop::Error("--slices is for --format json".into(), WRONG_INPUT))
        }
        Some(Command::Regions { file, format, agent, slices, scalar }) => {
            let request = Request { agent, slices: slices.map(|slices| slices as usize) };
            regions(file.as_deref(), format, scalar, request)
        }
        Some(Command::Map { file, output }) => map(file.as_deref(), &output),
    };
    match done {
        Ok(()) | Err(Stop::Closed) => ExitCode::SUCCESS,
        Err(Stop::Error(message, status)) => {
            complain(&message);
            ExitCode::from(status)
        }
    }
}

/// A message on standard error. Where that is closed, the exit status has to do.
fn complain(message: &str) {
    let _ = writeln!(io::stderr(), "pcr: {message}");
}

fn paper12() -> Result<Scenario, Stop> {
    Scenario::from_json(paper::SCENARIO).map_err(|error| Stop::Error(error.to_string(), WRONG_INPUT))
}

fn overview() -> Result<(), Stop> {
    let scenario = paper12()?;
    let fleet = Fleet::<f64>::new(&scenario).map_err(Failure::from)?;
    let motions = fleet.motions();
    let begin = Instant::now();
    regions::table(&scenario, &motions)?;
    let took = begin.elapsed();
    let answer = Answer::of::<f64>(&scenario, Request::default())?;
    let mut out = io::stdout().lock();
    report::overview(&scenario, &answer, took, &mut out)?;
    draw(&scenario, Path::new(DIRECTORY), &mut out)
}

fn map(file: Option<&Path>, directory: &Path) -> Result<(), Stop> {
    let scenario = file.map_or_else(paper12, |file| Ok(input::read(file)?))?;
    // What is wrong with the scenario is said before anything is written.
    let named = |failure: Failure| match file {
        Some(file) => Stop::Error(format!("{}: {failure}", file.display()), WRONG_INPUT),
        None => failure.into(),
    };
    let fleet = Fleet::<f64>::new(&scenario).map_err(|refused| named(refused.into()))?;
    regions::table(&scenario, &fleet.motions()).map_err(named)?;
    draw(&scenario, directory, &mut io::stdout().lock())
}

fn draw(scenario: &Scenario, directory: &Path, out: &mut impl Write) -> Result<(), Stop> {
    let progress = Progress::new("pictures");
    let files = picture::write(scenario, directory, &mut |done, total| progress.set(done, total));
    drop(progress);
    let files = files
        .map_err(|error| Stop::Error(format!("{}: cannot be written: {error}", directory.display()), NOT_WRITTEN))?;
    let page = files.iter().find(|file| file.extension().is_some_and(|extension| extension == "html"));
    if let Some(first) = page.or(files.first()) {
        writeln!(out, "Pictures: {} files in {}; begin with {}", files.len(), directory.display(), first.display())?;
    }
    Ok(())
}

fn regions(file: Option<&Path>, format: Form, scalar: Number, request: Request) -> Result<(), Stop> {
    let mut out = BufWriter::new(io::stdout().lock());
    if format == Form::Csv {
        out.write_all(report::CSV_HEADER.as_bytes())?;
    }
    match file {
        Some(file) if file == Path::new("-") => return lines(format, scalar, request, &mut out),
        Some(file) => {
            let scenario = input::read(file)?;
            let _progress = Progress::new(format!("{}: {} agents", file.display(), scenario.agents.len()));
            let answer = answer(&scenario, scalar, request);
            let named = |failure| Stop::Error(format!("{}: {failure}", file.display()), WRONG_INPUT);
            print(&answer.map_err(named)?, format, &mut out)?;
        }
        None => print(&answer(&paper12()?, scalar, request)?, format, &mut out)?,
    }
    out.flush()?;
    Ok(())
}

/// JSON Lines from standard input, each answered before the next one is read.
fn lines(format: Form, scalar: Number, request: Request, out: &mut impl Write) -> Result<(), Stop> {
    // On a terminal the answers themselves show how far it is.
    let progress = (!io::stdout().is_terminal()).then(|| Progress::new("scenarios"));
    let (mut read, mut refused) = (0, 0);
    for line in Lines::new(BufReader::new(io::stdin().lock())) {
        let line = line?;
        let outcome = line.scenario.and_then(|scenario| {
            let failed = |failure| (scenario.name.clone(), format!("line {}: {failure}", line.number));
            answer(&scenario, scalar, request).map_err(failed)
        });
        match outcome {
            Ok(answer) => print(&answer, format, out)?,
            Err((name, error)) => {
                refused += 1;
                match format {
                    Form::Json => print(&refusal(&name, error, scalar), format, out)?,
                    Form::Table | Form::Csv => complain(&format!("standard input: {error}")),
                }
            }
        }
        out.flush()?;
        read += 1;
        if let Some(progress) = &progress {
            progress.set(read, 0);
        }
    }
    drop(progress);
    match refused {
        0 => Ok(()),
        _ => Err(Stop::Error(format!("standard input: {refused} of {read} scenarios refused"), WRONG_INPUT)),
    }
}

fn answer(scenario: &Scenario, scalar: Number, request: Request) -> Result<Answer, Failure> {
    match scalar {
        Number::F64 => Answer::of::<f64>(scenario, request),
        Number::F32 => Answer::of::<f32>(scenario, request),
    }
}

fn refusal(name: &str, error: String, scalar: Number) -> Answer {
    match scalar {
        Number::F64 => Answer::refused::<f64>(name, error),
        Number::F32 => Answer::refused::<f32>(name, error),
    }
}

fn print(answer: &Answer, format: Form, out: &mut impl Write) -> io::Result<()> {
    match format {
        Form::Table => report::table(answer, out),
        Form::Json => report::json(answer, out),
        Form::Csv => report::csv(answer, out),
    }
}
