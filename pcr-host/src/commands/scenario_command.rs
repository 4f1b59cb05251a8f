//! Shared code of commands that process one scenario after the other.

use super::number::{ScalarArg, with_scalar};
use super::printed::is_alone;
use super::scenario_sources::{ScenarioSource, gathered, give_margin, refuse_margin};
use super::{CliError, NOT_WRITTEN, OutputArgs, OutputFormat, WRONG_INPUT, acknowledge, complain, say};
use crate::progress::ProgressLine;
use pcr_formats::import::{ImportOptions, shortened};
use pcr_formats::input::{self, InputError, ScenarioStream};
use pcr_formats::scenario::Scenario;
use pcr_planning::fleet::{FormatRangeError, rounded};
use pcr_planning::regions::ProgressFn;
use pcr_planning::report::OutputError;
use std::io::{self, BufRead, BufReader, IsTerminal, Write};
use std::path::{Path, PathBuf};

/// What a command makes of each scenario that comes in.
pub(super) trait ScenarioCommand {
    /// The first line of the output as CSV.
    const CSV_HEADER: &'static str;
    /// The number format that it computes in.
    fn scalar(&self) -> ScalarArg;
    /// Prints the answer, and tells whether it is what the exit status tells.
    fn print(&self, scenario: &Scenario, told: ProgressFn<'_>, out: &mut impl Write) -> Result<bool, OutputError>;
    /// Prints the answer to what is no scenario, as JSON.
    fn refuse(&self, name: &str, error: String, out: &mut impl Write) -> io::Result<()>;
}

/// What came of some scenarios.
#[derive(Default)]
struct ScenarioTally {
    read: usize,
    refused: usize,
    /// Whether any answer is what the exit status tells.
    found: bool,
}

/// Whether an answer is what the exit status tells.
pub(super) fn run<W: ScenarioCommand>(
    work: &W,
    files: Vec<PathBuf>,
    import: &ImportOptions,
    printed: &OutputArgs,
) -> Result<bool, CliError> {
    let sources = gathered(files, import)?;
    let form = printed.form();
    let mut out = printed.out(false);
    if form == OutputFormat::Csv {
        out.write_all(W::CSV_HEADER.as_bytes())?;
    }
    let (mut tally, mut foreign) = (ScenarioTally::default(), None);
    for (place, source) in sources.iter().enumerate() {
        if form == OutputFormat::Table && place > 0 {
            writeln!(out)?;
        }
        if source.is_lines(import) {
            let mut lines = ScenarioStream::new(BufReader::new(io::stdin().lock()));
            let Some(text) = lines.foreign()? else {
                answer_lines(work, lines, form, import, &mut out, &mut tally)?;
                continue;
            };
            foreign = Some(text);
        }
        tally.read += 1;
        match one(work, source, foreign.take(), import, &mut out) {
            Ok(found) => tally.found |= found,
            Err(CliError::Error(message, WRONG_INPUT)) if sources.len() > 1 => {
                tally.refused += 1;
                if form == OutputFormat::Json {
                    work.refuse(&source.name(), message.clone(), &mut out)?;
                }
                complain(&message);
            }
            Err(stop) => return Err(stop),
        }
        out.flush()?;
    }
    let ScenarioTally { read, refused, found } = tally;
    let place = if sources.len() == 1 { "standard input: " } else { "" };
    match refused {
        0 => Ok(found),
        _ => Err(CliError::Error(format!("{place}{refused} of {read} scenarios refused"), WRONG_INPUT)),
    }
}

/// A warning about what the number format makes of the motions, which the scenario has from now on.
pub(super) fn tell_rounding(scalar: ScalarArg, scenario: &mut Scenario) -> Result<Option<String>, FormatRangeError> {
    let mut warnings = Vec::from_iter(with_scalar!(scalar, S => rounded::<S>(scenario))?);
    acknowledge(&mut warnings);
    scenario.warnings.extend(warnings.iter().cloned());
    Ok(warnings.pop())
}

/// Answers one source; of standard input the text may be there already.
fn one<W: ScenarioCommand>(
    work: &W,
    source: &ScenarioSource,
    text: Option<String>,
    import: &ImportOptions,
    out: &mut impl Write,
) -> Result<bool, CliError> {
    let mut scenario = match text {
        Some(text) => source.scenario_from(text, import)?,
        None => source.scenario(import)?,
    };
    scenario.name = source.display_name(&scenario.name);
    let lost =
        tell_rounding(work.scalar(), &mut scenario).map_err(|refused| CliError::wrong(source.file(), refused))?;
    say(source.file(), lost);
    let progress = ProgressLine::new(format!("{}: {} agents", source.file().display(), scenario.agents.len()));
    work.print(&scenario, &|done, total| progress.set(done, total), out).map_err(|unprinted| match unprinted {
        OutputError::Failure(failure) => CliError::wrong(source.file(), failure),
        OutputError::Output(error) => error.into(),
    })
}

/// Lines after which there is no scenario in a text of which none begins as one.
const STRANGE: usize = 8;

/// Answers scenarios from standard input, each before the next one is read.
fn answer_lines<W: ScenarioCommand>(
    work: &W,
    lines: ScenarioStream<impl BufRead>,
    form: OutputFormat,
    import: &ImportOptions,
    out: &mut impl Write,
    tally: &mut ScenarioTally,
) -> Result<(), CliError> {
    // On a terminal the answers themselves show how far it is.
    let progress = (!io::stdout().is_terminal()).then(|| ProgressLine::new("scenarios"));
    let before = tally.read;
    input::useful_with_lines(import)?;
    let mut strange = 0;
    for line in lines {
        let line = line?;
        if is_alone() {
            // Nobody waits for the answers, and whoever writes the scenarios may never end. What is not looked at is not free.
            if !tally.found && tally.refused == 0 {
                let rest = format!("standard output: closed; nothing is said of line {} and what follows", line.number);
                return Err(CliError::Error(rest, NOT_WRITTEN));
            }
            break;
        }
        let outcome = match line.scenario {
            Ok(mut scenario) => {
                let number = line.number;
                acknowledge(&mut scenario.warnings);
                let warnings = scenario.warnings.iter().map(|warning| format!("line {number}: {}", shortened(warning)));
                say(Path::new("-"), warnings);
                give_margin(&mut scenario, import);
                let lost = refuse_margin(&scenario, import)
                    .and_then(|()| tell_rounding(work.scalar(), &mut scenario).map_err(|refused| refused.to_string()));
                let answered = match lost {
                    Ok(lost) => {
                        say(Path::new("-"), lost.map(|warning| format!("line {number}: {warning}")));
                        match work.print(&scenario, &|_, _| {}, out) {
                            Ok(found) => Ok(found),
                            Err(OutputError::Failure(failure)) => Err(failure.to_string()),
                            Err(OutputError::Output(error)) => return Err(error.into()),
                        }
                    }
                    Err(why) => Err(why),
                };
                answered.map_err(|why| (scenario.name, format!("line {number}: {why}")))
            }
            Err(refused) => Err(refused),
        };
        match outcome {
            Ok(found) => tally.found |= found,
            Err((name, error)) => {
                tally.refused += 1;
                match form {
                    OutputFormat::Json => work.refuse(&name, error, out)?,
                    OutputFormat::Table | OutputFormat::Csv => complain(&format!("standard input: {error}")),
                }
            }
        }
        out.flush()?;
        tally.read += 1;
        strange += usize::from(!line.is_json);
        if strange == STRANGE && tally.read - before == STRANGE {
            return Err(InputError::Unknown(None).into());
        }
        if let Some(progress) = &progress {
            progress.set(tally.read, 0);
        }
    }
    drop(progress);
    // Whoever should have written it has failed: that nothing collides is not known.
    if tally.read == before {
        return Err(CliError::Error("standard input: empty; a scenario is expected".into(), WRONG_INPUT));
    }
    Ok(())
}
