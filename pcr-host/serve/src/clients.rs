//! Clients of the line protocol: standard input and output, and TCP.

use crate::lines::LONGEST;
use crate::server::{BACKLOG, Handle, Input};
use std::io::{self, BufRead, BufReader, Read, Write};
use std::net::{Shutdown, TcpListener};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, sync_channel};
use std::thread;

/// Numbers of clients.
static NEXT: AtomicU64 = AtomicU64::new(1);

/// Clients over TCP at a time.
const MOST: usize = 256;

/// Reads lines from here and writes answers there, until one of them ends. Returns when all that came in is answered.
pub fn serve(handle: &Handle, input: impl Read, output: impl Write + Send + 'static) {
    let number = NEXT.fetch_add(1, Ordering::Relaxed);
    let (sender, receiver) = sync_channel(BACKLOG);
    if !handle.send(Input::Opened(number, sender)) {
        return;
    }
    let writer = thread::spawn(move || write(&receiver, output));
    // What cannot be read has ended.
    let _ = read(handle, number, BufReader::new(input));
    handle.send(Input::Closed(number));
    let _ = writer.join();
}

fn write(lines: &Receiver<String>, mut output: impl Write) {
    while let Ok(line) = lines.recv() {
        let mut text = line;
        text.extend(lines.try_iter().take(1000));
        if output.write_all(text.as_bytes()).and_then(|()| output.flush()).is_err() {
            return;
        }
    }
}

fn read(handle: &Handle, number: u64, mut input: impl BufRead) -> io::Result<()> {
    loop {
        let mut line = Vec::new();
        let read = input.by_ref().take(LONGEST as u64 + 1).read_until(b'\n', &mut line)?;
        if read == 0 {
            return Ok(());
        }
        if line.last() != Some(&b'\n') && line.len() > LONGEST {
            skip(&mut input)?;
            handle.send(Input::TooLong(number));
            continue;
        }
        let text = line.trim_ascii();
        if !text.is_empty() && !handle.send(Input::Line(number, text.to_vec())) {
            return Ok(());
        }
    }
}

/// The rest of a line that is too long.
fn skip(input: &mut impl BufRead) -> io::Result<()> {
    loop {
        let bytes = input.fill_buf()?;
        let (used, ends) = match bytes.iter().position(|byte| *byte == b'\n') {
            Some(place) => (place + 1, true),
            None => (bytes.len(), bytes.is_empty()),
        };
        input.consume(used);
        if ends {
            return Ok(());
        }
    }
}

/// Takes clients over TCP, for ever.
pub fn listen(handle: &Handle, listener: &TcpListener) {
    let open = Arc::new(AtomicUsize::new(0));
    for stream in listener.incoming().flatten() {
        if open.load(Ordering::Relaxed) >= MOST {
            continue;
        }
        let (handle, open) = (handle.clone(), open.clone());
        open.fetch_add(1, Ordering::Relaxed);
        thread::spawn(move || {
            // Answers are short, and wanted at once.
            if stream.set_nodelay(true).is_ok()
                && let (Ok(input), Ok(output)) = (stream.try_clone(), stream.try_clone())
            {
                serve(&handle, input, Closing(output));
            }
            open.fetch_sub(1, Ordering::Relaxed);
        });
    }
}

/// Ends both ways of a connection when nothing more is written to it: a client that is let go.
struct Closing(std::net::TcpStream);

impl Write for Closing {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.0.flush()
    }
}

impl Drop for Closing {
    fn drop(&mut self) {
        // It may be closed already.
        let _ = self.0.shutdown(Shutdown::Both);
    }
}
