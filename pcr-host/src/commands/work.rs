//! What commands share that answer scenario after scenario.

use super::{Form, Stop, WRONG_INPUT, complain, scenario};
use pcr_host::import::Options;
use pcr_host::input::Lines;
use pcr_host::progress::Progress;
use pcr_host::regions::Failure;
use pcr_host::scenario::Scenario;
use std::io::{self, BufReader, BufWriter, IsTerminal, Write};
use std::path::Path;

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

/// Whether an answer is what the exit status tells.
pub(super) fn run<W: Work>(work: &W, file: Option<&Path>, import: &Options, format: Form) -> Result<bool, Stop> {
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
            let named = |failure: Failure| Stop::wrong(Some(file), failure);
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
