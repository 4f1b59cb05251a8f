//! The command `pcr`: its arguments, its exit statuses, and nothing else.

use clap::{Parser, Subcommand, ValueEnum};
use pcr_fixed::{Q12, Q16, Q20};
use pcr_host::check::Verdict;
use pcr_host::fleet::Fleet;
use pcr_host::import::{self, Format};
use pcr_host::input::{self, InputError, Lines};
use pcr_host::locks::Locks;
use pcr_host::paper;
use pcr_host::picture;
use pcr_host::plan::{Plan, Priority};
use pcr_host::progress::Progress;
use pcr_host::regions::{self, Answer, Failure, Request};
use pcr_host::report;
use pcr_host::scenario::Scenario;
use std::io::{self, BufReader, BufWriter, IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

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

const CHECK_STATUSES: &str = "\
Exit status:
  0  no conflicts
  1  conflicts
  2  wrong arguments, or a scenario that cannot be read or was refused (one line of JSON Lines is enough)
  3  the output could not be written";

const EXAMPLES: &str = "\
Examples:
  pcr                                      the paper's 12 agents: its tables beside ours, pictures in pcr-out/
  pcr regions fleet.json                   what every agent has to keep out of, as a table
  pcr regions fleet.json --format json     the same for programs
  pcr map fleet.json -o pictures           the same as pictures
  pcr check fleet.json                     whether the agents collide, moving as the file says
  pcr plan fleet.json -o plan.json         later starts, so that they do not";

const REGIONS_EXAMPLES: &str = "\
Examples:
  pcr regions                                       the paper's 12 agents
  pcr regions fleet.json --agent 3                  what agent 3 has to keep out of
  pcr regions fleet.json --margin 0.05              with 5 cm to be kept around each, listed apart from contact
  pcr regions fleet.json --format csv > fleet.csv   a line a region
  pcr regions fleet.json --format json --slices 9   with the lengths covered at 9 times of each region
  pcr regions - --format json < fleets.jsonl        JSON Lines: a scenario a line in, a line a scenario out";

const MAP_EXAMPLES: &str = "\
Examples:
  pcr map -o pcr-out                  the paper's 12 agents
  pcr map fleet.json -o pictures      any other scenario";

const PLAN_STATUSES: &str = "\
Exit status:
  0  a plan, checked as by pcr check
  1  no plan
  2  wrong arguments, or a scenario that cannot be read or was refused
  3  the output could not be written";

const PLAN_EXAMPLES: &str = "\
Examples:
  pcr plan fleet.json -o plan.json                    the scenario with start delays, without conflicts
  pcr plan fleet.json --priority 7,3 --format json    agents 7 and 3 first, then the others as in the file";

const CHECK_EXAMPLES: &str = "\
Examples:
  pcr check plan.json                                who collides when, where and how deep
  pcr check plan.json --closest                      and how near every two agents come
  pcr check plan.json > /dev/null && echo free       for scripts: the exit status says it
  pcr check - --format json < plans.jsonl            JSON Lines: a scenario a line in, a line a scenario out";

const IMPORT_EXAMPLES: &str = "\
Examples:
  pcr import nav2 warehouse.geojson --route 0:50 --route 90:7@5 -o fleet.json   two routes on a nav2 route graph
  pcr regions warehouse.geojson --route 0:50 --route 90:7@5 --radius 0.4        other commands read the format as well";

const LOCKS_EXAMPLES: &str = "\
Examples:
  pcr locks warehouse.geojson --radius 0.4                      the table of locks of a nav2 route graph
  pcr locks warehouse.geojson --radius 0.4 -o locks             and a page in which an edge shows what it blocks
  pcr locks site.lif.json --vehicle AMR --radius 0.6 --margin 0.1 --format csv > locks.csv";

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
        #[command(flatten)]
        import: import::Options,
    },
    /// Tell whether the agents collide, moving as the scenario says: who, when, where, how deep
    #[command(after_help = format!("{CHECK_EXAMPLES}\n\n{CHECK_STATUSES}"))]
    Check {
        /// Scenario (JSON); `-` reads JSON Lines on standard input; the paper's 12 agents if left out
        file: Option<PathBuf>,
        /// Form of the output
        #[arg(long, value_enum, default_value_t = Form::Table)]
        format: Form,
        /// Add how near every two agents come, and when (not in CSV)
        #[arg(long)]
        closest: bool,
        /// Number format of the computation
        #[arg(long, value_enum, default_value_t = Number::F64)]
        scalar: Number,
        #[command(flatten)]
        import: import::Options,
    },
    /// Resolve the conflicts of a scenario: later starts, by priorities
    #[command(after_help = format!("{PLAN_EXAMPLES}\n\n{PLAN_STATUSES}"))]
    Plan {
        /// Scenario (JSON); `-` reads it from standard input; the paper's 12 agents if left out
        file: Option<PathBuf>,
        /// The scenario with the plan; none is written where there is no plan
        #[arg(short, long, value_name = "FILE")]
        output: Option<PathBuf>,
        /// How conflicts are avoided
        #[arg(long, value_enum, default_value_t = Method::Delay)]
        method: Method,
        /// Who goes first: agent numbers with commas between them, `longest`, `crowded` or `best`
        #[arg(long, value_name = "ORDER", default_value = "best", value_parser = priority)]
        priority: Priority,
        /// Form of the output
        #[arg(long, value_enum, default_value_t = Form::Table)]
        format: Form,
        #[command(flatten)]
        import: import::Options,
    },
    /// Draw a scenario: its paths, and the extended collision map of each agent, as SVG and PNG
    #[command(after_help = format!("{MAP_EXAMPLES}\n\n{STATUSES}"))]
    Map {
        /// Scenario (JSON); `-` reads it from standard input; the paper's 12 agents if left out
        file: Option<PathBuf>,
        /// Directory for the pictures; created where it does not exist, files in it are overwritten
        #[arg(short, long, value_name = "DIR")]
        output: PathBuf,
        #[command(flatten)]
        import: import::Options,
    },
    /// Print which edges of a layout may not be used at the same time, and on which lengths
    #[command(after_help = format!("{LOCKS_EXAMPLES}\n\n{STATUSES}"))]
    Locks {
        /// The layout; `-` reads standard input
        layout: PathBuf,
        /// Form of the output
        #[arg(long, value_enum, default_value_t = Form::Table)]
        format: Form,
        /// Add what a vehicle blocks that stands at a node
        #[arg(long)]
        nodes: bool,
        /// Draw the layout with its locks to this directory as well
        #[arg(short, long, value_name = "DIR")]
        output: Option<PathBuf>,
        #[command(flatten)]
        import: import::Options,
    },
    /// Write a layout with routes, an order or a plan in another format as a scenario file
    #[command(after_help = format!("{IMPORT_EXAMPLES}\n\n{STATUSES}"))]
    Import {
        /// Format of the file
        #[arg(value_enum)]
        format: Format,
        /// The file; `-` reads standard input
        file: PathBuf,
        /// The scenario file; standard output if left out
        #[arg(short, long, value_name = "FILE")]
        output: Option<PathBuf>,
        #[command(flatten)]
        import: import::Options,
    },
}

/// Slices that are given for a region: more than any picture or table can use, and not more than memory holds.
const MOST_SLICES: i64 = 10_000;

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum Form {
    /// For reading
    Table,
    /// One object a scenario
    Json,
    /// One line a region or conflict
    Csv,
}

#[derive(Clone, Copy, ValueEnum)]
enum Method {
    /// Agents start later and then move as the scenario says
    Delay,
}

/// An order of priority from the command line.
fn priority(text: &str) -> Result<Priority, String> {
    match text {
        "longest" => return Ok(Priority::Longest),
        "crowded" => return Ok(Priority::Crowded),
        "best" => return Ok(Priority::Best),
        _ => {}
    }
    let mut ids: Vec<u64> = Vec::new();
    for part in text.split(',') {
        let id = part.trim().parse().map_err(|_| format!("{part:?} is no number of an agent"))?;
        if ids.contains(&id) {
            return Err(format!("agent {id} is there twice"));
        }
        ids.push(id);
    }
    Ok(Priority::Given(ids))
}

#[derive(Clone, Copy, ValueEnum)]
enum Number {
    /// 64-bit floating point
    F64,
    /// 32-bit floating point, as on a small machine
    F32,
    /// Fixed point in 2⁻¹⁶ (15 µm), ±4096 m and 4096 s
    Q16,
    /// Fixed point in 2⁻²⁰ (1 µm), ±256 m and 256 s
    Q20,
    /// Fixed point in 2⁻¹² (0.24 mm), ±65 km and 18 h
    Q12,
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
        None => overview().map(|()| ExitCode::SUCCESS),
        Some(Command::Regions { slices: Some(_), format: Form::Table | Form::Csv, .. }) => {
            Err(Stop::Error("--slices is for --format json".into(), WRONG_INPUT))
        }
        Some(Command::Regions { file, format, agent, slices, scalar, import }) => {
            let request = Request { agent, slices: slices.map(|slices| slices as usize) };
            run(&Regions { scalar, request }, file.as_deref(), &import, format).map(|_| ExitCode::SUCCESS)
        }
        Some(Command::Check { closest: true, format: Form::Csv, .. }) => {
            Err(Stop::Error("--closest is for --format json and table".into(), WRONG_INPUT))
        }
        Some(Command::Check { file, format, closest, scalar, import }) => {
            let found = run(&Check { scalar, closest }, file.as_deref(), &import, format);
            found.map(|found| if found { ExitCode::from(CONFLICTS) } else { ExitCode::SUCCESS })
        }
        Some(Command::Plan { file, output, method: Method::Delay, priority, format, import }) => {
            let solved = plan(file.as_deref(), &import, &priority, output.as_deref(), format);
            solved.map(|solved| if solved { ExitCode::SUCCESS } else { ExitCode::from(CONFLICTS) })
        }
        Some(Command::Map { file, output, import }) => {
            map(file.as_deref(), &import, &output).map(|()| ExitCode::SUCCESS)
        }
        Some(Command::Locks { layout, format, nodes, output, import }) => {
            locks(&layout, &import, format, nodes, output.as_deref()).map(|()| ExitCode::SUCCESS)
        }
        Some(Command::Import { format, file, output, import }) => {
            let import = import::Options { from: Some(format), ..import };
            write_scenario(&file, &import, output.as_deref()).map(|()| ExitCode::SUCCESS)
        }
    };
    match done {
        Ok(status) => status,
        Err(Stop::Closed) => ExitCode::SUCCESS,
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

/// The scenario in a file, in whatever format, or the paper's; warnings about it are told.
fn scenario(file: Option<&Path>, import: &import::Options) -> Result<Scenario, Stop> {
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

fn warn(file: &Path, warnings: &import::Warnings) {
    for line in warnings.lines() {
        complain(&format!("warning: {}: {line}", file.display()));
    }
}

/// Whether there is a plan.
fn plan(
    file: Option<&Path>,
    import: &import::Options,
    priority: &Priority,
    output: Option<&Path>,
    format: Form,
) -> Result<bool, Stop> {
    let scenario = scenario(file, import)?;
    let named = |failure: Failure| match file {
        Some(file) => Stop::Error(format!("{}: {failure}", file.display()), WRONG_INPUT),
        None => failure.into(),
    };
    let (plan, solved) = Plan::of(&scenario, priority).map_err(named)?;
    if let (Some(output), Some(solved)) = (output, &solved) {
        write_to(output, solved)?;
    }
    let mut out = BufWriter::new(io::stdout().lock());
    match format {
        Form::Table => report::plan_table(&plan, &mut out)?,
        Form::Json => report::json(&plan, &mut out)?,
        Form::Csv => {
            out.write_all(report::PLAN_CSV_HEADER.as_bytes())?;
            report::plan_csv(&plan, &mut out)?;
        }
    }
    out.flush()?;
    Ok(solved.is_some())
}

fn write_to(output: &Path, scenario: &Scenario) -> Result<(), Stop> {
    let failed = |error| Stop::Error(format!("{}: cannot be written: {error}", output.display()), NOT_WRITTEN);
    std::fs::write(output, scenario.to_json()).map_err(failed)
}

fn write_scenario(file: &Path, import: &import::Options, output: Option<&Path>) -> Result<(), Stop> {
    let scenario = scenario(Some(file), import)?;
    match output {
        Some(output) => write_to(output, &scenario),
        None => Ok(io::stdout().lock().write_all(scenario.to_json().as_bytes())?),
    }
}

fn locks(
    file: &Path,
    import: &import::Options,
    format: Form,
    nodes: bool,
    directory: Option<&Path>,
) -> Result<(), Stop> {
    let (imported, warnings) = input::read_layout(file, import)?;
    warn(file, &warnings);
    let locks = Locks::of(&imported, nodes)
        .map_err(|error| Stop::Error(format!("{}: {error}", file.display()), WRONG_INPUT))?;
    if let Some(directory) = directory {
        picture::write_locks(&imported, &locks, directory).map_err(|error| {
            Stop::Error(format!("{}: cannot be written: {error}", directory.display()), NOT_WRITTEN)
        })?;
    }
    let mut out = BufWriter::new(io::stdout().lock());
    match format {
        Form::Table => report::locks_table(&locks, &mut out)?,
        Form::Json => report::locks_json(&locks, &mut out)?,
        Form::Csv => report::locks_csv(&locks, &mut out)?,
    }
    Ok(out.flush()?)
}

fn map(file: Option<&Path>, import: &import::Options, directory: &Path) -> Result<(), Stop> {
    let scenario = scenario(file, import)?;
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

/// What a command makes of each scenario that comes in.
trait Work {
    type Answer;
    /// The first line of the output as CSV.
    const CSV_HEADER: &'static str;
    fn answer(&self, scenario: &Scenario) -> Result<Self::Answer, Failure>;
    /// The answer to what is no scenario.
    fn refused(&self, name: &str, error: String) -> Self::Answer;
    /// Whether it is what the exit status tells.
    fn found(&self, answer: &Self::Answer) -> bool;
    fn print(&self, answer: &Self::Answer, format: Form, out: &mut impl Write) -> io::Result<()>;
}

/// `pcr regions`.
struct Regions {
    scalar: Number,
    request: Request,
}

impl Work for Regions {
    type Answer = Answer;
    const CSV_HEADER: &'static str = report::CSV_HEADER;

    fn answer(&self, scenario: &Scenario) -> Result<Answer, Failure> {
        match self.scalar {
            Number::F64 => Answer::of::<f64>(scenario, self.request),
            Number::F32 => Answer::of::<f32>(scenario, self.request),
            Number::Q16 => Answer::of::<Q16>(scenario, self.request),
            Number::Q20 => Answer::of::<Q20>(scenario, self.request),
            Number::Q12 => Answer::of::<Q12>(scenario, self.request),
        }
    }

    fn refused(&self, name: &str, error: String) -> Answer {
        match self.scalar {
            Number::F64 => Answer::refused::<f64>(name, error),
            Number::F32 => Answer::refused::<f32>(name, error),
            Number::Q16 => Answer::refused::<Q16>(name, error),
            Number::Q20 => Answer::refused::<Q20>(name, error),
            Number::Q12 => Answer::refused::<Q12>(name, error),
        }
    }

    fn found(&self, _: &Answer) -> bool {
        false
    }

    fn print(&self, answer: &Answer, format: Form, out: &mut impl Write) -> io::Result<()> {
        match format {
            Form::Table => report::table(answer, out),
            Form::Json => report::json(answer, out),
            Form::Csv => report::csv(answer, out),
        }
    }
}

/// `pcr check`.
struct Check {
    scalar: Number,
    closest: bool,
}

impl Work for Check {
    type Answer = Verdict;
    const CSV_HEADER: &'static str = report::CONFLICTS_CSV_HEADER;

    fn answer(&self, scenario: &Scenario) -> Result<Verdict, Failure> {
        Ok(match self.scalar {
            Number::F64 => Verdict::of::<f64>(scenario, self.closest),
            Number::F32 => Verdict::of::<f32>(scenario, self.closest),
            Number::Q16 => Verdict::of::<Q16>(scenario, self.closest),
            Number::Q20 => Verdict::of::<Q20>(scenario, self.closest),
            Number::Q12 => Verdict::of::<Q12>(scenario, self.closest),
        }?)
    }

    fn refused(&self, name: &str, error: String) -> Verdict {
        Verdict::refused(name, error)
    }

    fn found(&self, verdict: &Verdict) -> bool {
        !verdict.conflicts.is_empty()
    }

    fn print(&self, verdict: &Verdict, format: Form, out: &mut impl Write) -> io::Result<()> {
        match format {
            Form::Table => report::conflicts_table(verdict, out),
            Form::Json => report::json(verdict, out),
            Form::Csv => report::conflicts_csv(verdict, out),
        }
    }
}

/// Whether an answer is what the exit status tells.
fn run<W: Work>(work: &W, file: Option<&Path>, import: &import::Options, format: Form) -> Result<bool, Stop> {
    let mut out = BufWriter::new(io::stdout().lock());
    if format == Form::Csv {
        out.write_all(W::CSV_HEADER.as_bytes())?;
    }
    let answer = match file {
        Some(file) if file == Path::new("-") && import.from.is_none() => {
            return lines(work, format, import.margin, &mut out);
        }
        Some(file) => {
            let scenario = scenario(Some(file), import)?;
            let _progress = Progress::new(format!("{}: {} agents", file.display(), scenario.agents.len()));
            let named = |failure| Stop::Error(format!("{}: {failure}", file.display()), WRONG_INPUT);
            work.answer(&scenario).map_err(named)?
        }
        None => work.answer(&scenario(None, import)?)?,
    };
    work.print(&answer, format, &mut out)?;
    out.flush()?;
    Ok(work.found(&answer))
}

/// JSON Lines from standard input, each answered before the next one is read.
fn lines<W: Work>(work: &W, format: Form, margin: Option<f64>, out: &mut impl Write) -> Result<bool, Stop> {
    // On a terminal the answers themselves show how far it is.
    let progress = (!io::stdout().is_terminal()).then(|| Progress::new("scenarios"));
    let (mut read, mut refused, mut found) = (0, 0, false);
    for line in Lines::new(BufReader::new(io::stdin().lock())) {
        let line = line?;
        let outcome = line.scenario.and_then(|mut scenario| {
            scenario.give_margin(margin.unwrap_or(0.0));
            let failed = |failure| (scenario.name.clone(), format!("line {}: {failure}", line.number));
            work.answer(&scenario).map_err(failed)
        });
        match outcome {
            Ok(answer) => {
                found |= work.found(&answer);
                work.print(&answer, format, out)?;
            }
            Err((name, error)) => {
                refused += 1;
                match format {
                    Form::Json => work.print(&work.refused(&name, error), format, out)?,
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
        0 => Ok(found),
        _ => Err(Stop::Error(format!("standard input: {refused} of {read} scenarios refused"), WRONG_INPUT)),
    }
}
