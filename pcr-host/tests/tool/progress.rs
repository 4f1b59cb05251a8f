//! What the line on the terminal says of the time to go. The tool is no library, so its file is read in.

#[allow(dead_code)]
#[path = "../../src/progress.rs"]
mod source;

use crate::stderr::Stderr;
use source::remaining;
use std::io::Write;
use std::sync::mpsc;
use std::thread;
use std::time::Duration;

#[test]
fn what_is_left_takes_as_long_as_what_is_done() {
    let after = |done| remaining(done, 1000, Duration::from_secs(10));
    assert_eq!([after(9), after(10), after(250), after(1000)], [None, Some(990), Some(30), Some(0)]);
}

/// The pictures of a plan that took more than a second were never done where standard error was a terminal.
#[test]
fn who_tells_what_was_written_keeps_nobody_from_showing_the_progress() {
    let mut notes = Stderr;
    notes.write_all(b"").unwrap();
    let (done, shown) = mpsc::channel();
    thread::spawn(move || done.send(Stderr.write(b"").is_ok()));
    assert_eq!(shown.recv_timeout(Duration::from_secs(10)), Ok(true));
    notes.write_all(b"").unwrap();
}
