//! Standard error, for what the tool says to people.

use std::fmt::Arguments;
use std::io::{self, IsTerminal, Write};

/// Standard error. Whoever has it keeps nobody else from it, such as the thread that shows the progress.
pub(crate) struct Stderr;

impl Stderr {
    pub(crate) fn is_terminal(&self) -> bool {
        io::stderr().is_terminal()
    }
}

impl Write for Stderr {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        io::stderr().write(bytes)
    }

    /// All of it in one piece.
    fn write_fmt(&mut self, what: Arguments<'_>) -> io::Result<()> {
        io::stderr().write_fmt(what)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}
