//! The format of printed answers, and where they are printed.

use clap::{ArgAction, ArgMatches, Args, ValueEnum};
use pcr_formats::scenario::printable;
use pcr_formats::warning::WarningCode;
use std::collections::BTreeSet;
use std::io::{self, BufWriter, Write};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, OnceLock, PoisonError};

static QUIET: AtomicBool = AtomicBool::new(false);
static TO_THE_END: AtomicBool = AtomicBool::new(false);
static GONE: AtomicBool = AtomicBool::new(false);

static SHARED: OnceLock<SharedOptions> = OnceLock::new();
static DENIED: Mutex<BTreeSet<WarningCode>> = Mutex::new(BTreeSet::new());

/// Lines of warnings about one file that people read; the others are counted.
const FEW: usize = 4;

/// The options that may stand before and after the name of a command: of warnings, and of progress.
#[derive(Args, Debug, Default)]
pub(super) struct SharedOptions {
    /// Show progress also if standard error is no terminal
    #[arg(long, overrides_with = "progress", hide_short_help = true)]
    progress: bool,
    /// Leave warnings of these codes out of all answers
    #[arg(long, value_name = "CODE", action = ArgAction::Append, value_delimiter = ',', hide_short_help = true, value_parser = code)]
    allow: Vec<WarningCode>,
    /// Status 2 if there are such warnings; `warnings`: any
    #[arg(long, value_name = "CODE", action = ArgAction::Append, value_delimiter = ',', hide_short_help = true, value_parser = denied)]
    deny: Vec<Denied>,
    /// Print `all` warnings, or a `few` a file [default: few]
    #[arg(
        long,
        value_name = "MANY",
        value_enum,
        overrides_with = "warnings",
        hide_short_help = true,
        hide_possible_values = true
    )]
    warnings: Option<Many>,
}

/// How many warnings are printed.
#[derive(Clone, Copy, Debug, PartialEq, ValueEnum)]
enum Many {
    Few,
    All,
}

/// Warnings that end the program with an error.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Denied {
    All,
    Code(WarningCode),
}

fn code(name: &str) -> Result<WarningCode, String> {
    name.parse().map_err(|()| {
        let names: Vec<&str> = WarningCode::ALL.iter().map(|code| code.name()).collect();
        format!("no warning has this code; the codes are {}", names.join(", "))
    })
}

fn denied(name: &str) -> Result<Denied, String> {
    if name == "warnings" { Ok(Denied::All) } else { code(name).map(Denied::Code) }
}

impl SharedOptions {
    /// Their names. Codes count in both places. (Of options that are `global` for `clap`, those after the name replace those before it.)
    pub(super) const NAMES: [&'static str; 4] = ["progress", "allow", "deny", "warnings"];

    /// Adds those that stand after the name of a command.
    pub(super) fn extend(&mut self, after: &ArgMatches) {
        let [progress, allow, deny, warnings] = Self::NAMES;
        self.progress |= after.get_flag(progress);
        self.allow.extend(after.get_many::<WarningCode>(allow).into_iter().flatten());
        self.deny.extend(after.get_many::<Denied>(deny).into_iter().flatten());
        self.warnings = after.get_one::<Many>(warnings).copied().or(self.warnings);
    }

    /// Applies those of warnings to all that is printed from now on. Returns whether progress is to be shown.
    pub(super) fn apply(self) -> bool {
        let progress = self.progress;
        // Once for each run of the program.
        let _ = SHARED.set(self);
        progress
    }

    fn denies(&self, code: WarningCode) -> bool {
        self.deny.iter().any(|denied| matches!(denied, Denied::All) || *denied == Denied::Code(code))
    }
}

/// Removes the warnings that are acknowledged, and notes those that are denied.
pub(super) fn acknowledge(warnings: &mut Vec<String>) {
    let Some(shared) = SHARED.get() else { return };
    warnings.retain(|warning| !shared.allow.contains(&WarningCode::of(warning)));
    let denied = warnings.iter().map(|warning| WarningCode::of(warning)).filter(|code| shared.denies(*code));
    DENIED.lock().unwrap_or_else(PoisonError::into_inner).extend(denied);
}

/// The same of warnings of which the first ones are about a layout; their number is changed as well.
pub(super) fn acknowledge_parts(warnings: &mut Vec<String>, of_layout: &mut usize) {
    let mut rest = warnings.split_off((*of_layout).min(warnings.len()));
    acknowledge(warnings);
    acknowledge(&mut rest);
    *of_layout = warnings.len();
    warnings.append(&mut rest);
}

/// Prints a warning that is about no file.
pub(super) fn caution(code: WarningCode, text: &str) {
    let mut warnings = vec![code.text(text)];
    acknowledge(&mut warnings);
    if !quiet() {
        warnings.iter().for_each(|warning| complain(&format!("warning: {warning}")));
    }
}

/// Refuses what was answered with warnings that are denied.
pub(super) fn refuse_denied() -> Result<(), String> {
    let denied = DENIED.lock().unwrap_or_else(PoisonError::into_inner);
    if denied.is_empty() {
        return Ok(());
    }
    let names: Vec<&str> = denied.iter().map(|code| code.name()).collect();
    Err(format!("--deny: there are warnings of {}; see docs/reference/warnings.md", names.join(", ")))
}

/// The lines that are printed of some warnings: one for each code, and of no more than a few codes, unless all are asked for.
pub(super) fn few(warnings: Vec<String>) -> Vec<String> {
    if SHARED.get().is_some_and(|shared| shared.warnings == Some(Many::All)) {
        return warnings;
    }
    let mut codes: Vec<(WarningCode, String, usize)> = Vec::new();
    for warning in warnings {
        let code = WarningCode::of(&warning);
        // Those without a code have nothing in common.
        match codes.iter_mut().find(|(other, ..)| *other == code && code != WarningCode::Uncoded) {
            Some((_, _, more)) => *more += 1,
            None => codes.push((code, warning, 0)),
        }
    }
    let rest = if codes.len() > FEW { codes.split_off(FEW - 1) } else { Vec::new() };
    let mut lines: Vec<String> = codes
        .into_iter()
        .map(|(_, first, more)| if more > 0 { format!("{first} and {more} more; --warnings all") } else { first })
        .collect();
    if !rest.is_empty() {
        let count: usize = rest.iter().map(|(.., more)| 1 + more).sum();
        let names: Vec<&str> = rest.iter().map(|(code, ..)| code.name()).collect();
        lines.push(format!("{count} more, of {}; --warnings all", names.join(", ")));
    }
    lines
}

/// From now on nothing is said to people but errors.
pub(super) fn be_quiet() {
    QUIET.store(true, Ordering::Relaxed);
}

pub(super) fn quiet() -> bool {
    QUIET.load(Ordering::Relaxed)
}

/// From now on the work goes on where nobody reads its output any more: its exit status is an answer, too.
pub(super) fn go_to_the_end() {
    TO_THE_END.store(true, Ordering::Relaxed);
}

/// Whether the end of the output is not the end of the work.
pub(super) fn goes_to_the_end() -> bool {
    TO_THE_END.load(Ordering::Relaxed)
}

/// Whether somebody who read the output has gone before its end.
pub(super) fn is_alone() -> bool {
    GONE.load(Ordering::Relaxed)
}

/// An output whose reader may go; what comes after that is dropped where the work goes to its end.
struct ClosablePipe<W> {
    out: W,
    gone: bool,
}

impl<W: Write> ClosablePipe<W> {
    fn of(out: W) -> Self {
        Self { out, gone: false }
    }

    fn or_gone<T>(&mut self, done: io::Result<T>, otherwise: T) -> io::Result<T> {
        match done {
            Err(error) if error.kind() == io::ErrorKind::BrokenPipe && goes_to_the_end() => {
                self.gone = true;
                GONE.store(true, Ordering::Relaxed);
                Ok(otherwise)
            }
            done => done,
        }
    }
}

impl<W: Write> Write for ClosablePipe<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if self.gone {
            return Ok(bytes.len());
        }
        let written = self.out.write(bytes);
        self.or_gone(written, bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        if self.gone {
            return Ok(());
        }
        let flushed = self.out.flush();
        self.or_gone(flushed, ())
    }
}

/// Standard output.
pub(super) fn stdout() -> impl Write {
    ClosablePipe::of(io::stdout().lock())
}

/// Not locked: the thread that shows the progress writes to it, too.
fn stderr() -> impl Write {
    ClosablePipe::of(io::stderr())
}

/// A message on standard error, a line whatever is in it. Where that is closed, the exit status has to do.
pub(crate) fn complain(message: &str) {
    let _ = writeln!(io::stderr(), "pcr: {}", printable(message));
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
pub(super) enum OutputFormat {
    Table,
    Json,
    Csv,
}

#[derive(Args)]
pub(super) struct OutputArgs {
    /// table, json or csv
    #[arg(long, value_enum, default_value_t = OutputFormat::Table, hide_possible_values = true)]
    format: OutputFormat,
    /// The same as --format json
    #[arg(long)]
    json: bool,
}

impl OutputArgs {
    pub(super) fn form(&self) -> OutputFormat {
        if self.json { OutputFormat::Json } else { self.format }
    }

    /// Whether nothing is printed: what is for people only, where they asked for nothing.
    pub(super) fn is_silent(&self) -> bool {
        quiet() && self.form() == OutputFormat::Table
    }

    /// Where the answer goes: standard output, or standard error if that is `taken` by the scenario itself.
    pub(super) fn out(&self, taken: bool) -> Box<dyn Write> {
        match () {
            () if self.is_silent() => Box::new(io::sink()),
            () if taken => Box::new(BufWriter::new(stderr())),
            () => Box::new(BufWriter::new(stdout())),
        }
    }
}

/// Where tables go that have no other form: those of `pcr fleet`. Standard output may be `taken` by what is asked for.
pub(super) fn tables(taken: bool) -> Box<dyn Write> {
    match () {
        () if quiet() => Box::new(io::sink()),
        () if taken => Box::new(stderr()),
        () => Box::new(stdout()),
    }
}

/// Where notes go that are for people only.
pub(super) fn notes() -> Box<dyn Write> {
    if quiet() { Box::new(io::sink()) } else { Box::new(stderr()) }
}
