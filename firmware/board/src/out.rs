//! Text to the debugger's console.

use semihosting::io::Write;

/// Prints bytes; a console that does not take them has no one to complain to.
pub fn print(bytes: &[u8]) {
    if let Ok(out) = semihosting::io::stdout() {
        write(out, bytes);
    }
}

/// Output beside the printed table.
pub fn tell(bytes: &[u8]) {
    if let Ok(out) = semihosting::io::stderr() {
        write(out, bytes);
    }
}

fn write(mut out: impl Write, bytes: &[u8]) {
    let mut rest = bytes;
    while let Ok(written @ 1..) = out.write(rest) {
        rest = rest.get(written..).unwrap_or_default();
    }
}
