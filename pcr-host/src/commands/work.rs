//! What commands share that answer scenario after scenario.

use super::sources::{Source, gathered};
use super::{Form, Printed, Stop, WRONG_INPUT, complain};
use crate::progress::Progress;
use pcr_formats::import::Options;
use pcr_formats::input::Lines;
use pcr_formats::scenario::Scenario;
use pcr_planning::regions::Failure;
use std::io::{self, BufReader, IsTerminal, Write};
use std::path::PathBuf;

/// What a command makes of each scenario that comes in.
pub(super) trait Work {
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

/// What came of some scenarios.
#[derive(Default)]
struct Tally {
    read: usize,
    refused: usize,
    /// Whether any answer is what the exit status tells.
    found: bool,
}

/// Whether an answer is what the exit status tells.
pub(super) fn run<W: Work>(work: &W, files: Vec<PathBuf>, import: &Options, printed: &Printed) -> Result<bool, Stop> {
    let sources = gathered(files, import)?;
    let form = printed.form();
    let mut out = printed.out(false);
    if form == Form::Csv {
        out.write_all(W::CSV_HEADER.as_bytes())?;
    }
    let mut tally = Tally::default();
    for (place, source) in sources.iter().enumerate() {
        if form == Form::Table && place > 0 {
            writeln!(out)?;
        }
        if source.is_lines(import) {
            lines(work, form, import.margin, &mut out, &mut tally)?;
            continue;
        }
        tally.read += 1;
        match one(work, source, import) {
            Ok(answer) => {
                tally.found |= work.found(&answer);
                work.print(&answer, form, &mut out)?;
            }
            Err(Stop::Error(message, WRONG_INPUT)) if sources.len() > 1 => {
                tally.refused += 1;
                if form == Form::Json {
                    work.print(&work.refused(&source.stem(), message.clone()), form, &mut out)?;
                }
                complain(&message);
            }
            Err(stop) => return Err(stop),
        }
        out.flush()?;
    }
    let Tally { read, refused, found } = tally;
    let place = if sources.len() == 1 { "standard input: " } else { "" };
    match refused {
        0 => Ok(found),
        _ => Err(Stop::Error(format!("{place}{refused} of {read} scenarios refused"), WRONG_INPUT)),
    }
}

fn one<W: Work>(work: &W, source: &Source, import: &Options) -> Result<W::Answer, Stop> {
    let scenario = source.scenario(import)?;
    let _progress = Progress::new(format!("{}: {} agents", source.file().display(), scenario.agents.len()));
    work.answer(&scenario).map_err(|failure| Stop::wrong(source.file(), failure))
}

/// Scenarios from standard input, each answered before the next one is read.
fn lines<W: Work>(
    work: &W,
    form: Form,
    margin: Option<f64>,
    out: &mut impl Write,
    tally: &mut Tally,
) -> Result<(), Stop> {
    // On a terminal the answers themselves show how far it is.
    let progress = (!io::stdout().is_terminal()).then(|| Progress::new("scenarios"));
    let before = tally.read;
    for line in Lines::new(BufReader::new(io::stdin().lock())) {
        let line = line?;
        let outcome = line.scenario.and_then(|mut scenario| {
            scenario.give_margin(margin.unwrap_or(0.0));
            let failed = |failure| (scenario.name.clone(), format!("line {}: {failure}", line.number));
            work.answer(&scenario).map_err(failed)
        });
        match outcome {
            Ok(answer) => {
                tally.found |= work.found(&answer);
                work.print(&answer, form, out)?;
            }
            Err((name, error)) => {
                tally.refused += 1;
                match form {
                    Form::Json => work.print(&work.refused(&name, error), form, out)?,
                    Form::Table | Form::Csv => complain(&format!("standard input: {error}")),
                }
            }
        }
        out.flush()?;
        tally.read += 1;
        if let Some(progress) = &progress {
            progress.set(tally.read, 0);
        }
    }
    drop(progress);
    // Whoever should have written it has failed: that nothing collides is not known.
    if tally.read == before {
        return Err(Stop::Error("standard input: empty; no scenario came in".into(), WRONG_INPUT));
    }
    Ok(())
}
