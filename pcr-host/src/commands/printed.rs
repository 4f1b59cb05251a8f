//! The format of printed answers, and where they are printed.

use clap::{Args, ValueEnum};
use std::io::{self, BufWriter, Write};
use std::sync::atomic::{AtomicBool, Ordering};

static QUIET: AtomicBool = AtomicBool::new(false);

/// From now on nothing is said to people but errors.
pub(super) fn be_quiet() {
    QUIET.store(true, Ordering::Relaxed);
}

pub(super) fn quiet() -> bool {
    QUIET.load(Ordering::Relaxed)
}

/// A message on standard error. Where that is closed, the exit status has to do.
pub(crate) fn complain(message: &str) {
    let _ = writeln!(io::stderr(), "pcr: {message}");
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
pub(super) enum Form {
    Table,
    Json,
    Csv,
}

#[derive(Args)]
pub(super) struct Printed {
    /// For reading, an object a scenario, or a line a row
    #[arg(long, value_enum, default_value_t = Form::Table)]
    format: Form,
    /// The same as --format json
    #[arg(long, conflicts_with = "format")]
    json: bool,
}

impl Printed {
    pub(super) fn form(&self) -> Form {
        if self.json { Form::Json } else { self.format }
    }

    /// Where the answer goes: standard output, or standard error if that is `taken` by the scenario itself.
    pub(super) fn out(&self, taken: bool) -> Box<dyn Write> {
        match () {
            () if quiet() && self.form() == Form::Table => Box::new(io::sink()),
            () if taken => Box::new(BufWriter::new(io::stderr().lock())),
            () => Box::new(BufWriter::new(io::stdout().lock())),
        }
    }
}

/// Where tables go that have no other form: those of `pcr fleet`.
#[cfg(feature = "serve")]
pub(super) fn tables() -> Box<dyn Write> {
    if quiet() { Box::new(io::sink()) } else { Box::new(io::stdout().lock()) }
}

/// Where notes go that are for people only.
pub(super) fn notes() -> Box<dyn Write> {
    if quiet() { Box::new(io::sink()) } else { Box::new(io::stderr().lock()) }
}
