//! The format of printed answers, and where they are printed.

use clap::{Args, ValueEnum};
use pcr_formats::scenario::printable;
use std::io::{self, BufWriter, Write};
use std::sync::atomic::{AtomicBool, Ordering};

static QUIET: AtomicBool = AtomicBool::new(false);
static TO_THE_END: AtomicBool = AtomicBool::new(false);
static GONE: AtomicBool = AtomicBool::new(false);

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
struct Read<W> {
    out: W,
    gone: bool,
}

impl<W: Write> Read<W> {
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

impl<W: Write> Write for Read<W> {
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
    Read::of(io::stdout().lock())
}

/// Not locked: the thread that shows the progress writes to it, too.
fn stderr() -> impl Write {
    Read::of(io::stderr())
}

/// A message on standard error, a line whatever is in it. Where that is closed, the exit status has to do.
pub(crate) fn complain(message: &str) {
    let _ = writeln!(io::stderr(), "pcr: {}", printable(message));
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
pub(super) enum Form {
    Table,
    Json,
    Csv,
}

#[derive(Args)]
pub(super) struct Printed {
    /// table, json or csv
    #[arg(long, value_enum, default_value_t = Form::Table, hide_possible_values = true)]
    format: Form,
    /// The same as --format json
    #[arg(long)]
    json: bool,
}

impl Printed {
    pub(super) fn form(&self) -> Form {
        if self.json { Form::Json } else { self.format }
    }

    /// Whether nothing is printed: what is for people only, where they asked for nothing.
    pub(super) fn is_silent(&self) -> bool {
        quiet() && self.form() == Form::Table
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
