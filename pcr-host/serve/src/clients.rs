//! Clients of the line protocol: standard input and output, and TCP.

use crate::accept;
use crate::lines::LONGEST;
use crate::log::Log;
use crate::outbox::{Lines, outbox};
use crate::server::{Handle, Input};
use socket2::{SockRef, TcpKeepalive};
use std::io::{self, BufRead, BufReader, ErrorKind, Read, Write};
use std::net::{Shutdown, TcpListener, TcpStream};
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread;
use std::time::Duration;

/// Number of the next client.
static NEXT: AtomicU64 = AtomicU64::new(1);

/// Time that a disconnected TCP client has to read some of its lines, before the connection ends.
const PATIENCE: Duration = Duration::from_secs(30);

/// Time without any message after which the system asks whether a client is still there, and time between two such questions.
const PROBE: Duration = Duration::from_secs(15);

/// Largest number of TCP clients at a time.
const MOST: usize = 256;

/// Reads lines from `input` and writes answers to `output`. Returns when the input has ended and all lines that were read are
/// answered. If the output cannot be written, `lost` is called at once, with the reason; what is read after that is carried out,
/// but not answered.
///
/// # Errors
/// The thread for the answers cannot be started; nothing is read then.
pub fn serve(
    handle: &Handle,
    input: impl Read,
    output: impl Write + Send + 'static,
    lost: impl FnOnce(io::Error) + Send + 'static,
) -> io::Result<()> {
    let number = NEXT.fetch_add(1, Ordering::Relaxed);
    let (sender, lines) = outbox();
    let work = move || write(&lines, output).unwrap_or_else(lost);
    let writer = thread::Builder::new().name("answers".into()).spawn(work)?;
    if !handle.send(Input::Opened(number, sender)) {
        return Ok(());
    }
    // An error of reading counts as the end.
    let _ = read(handle, number, BufReader::new(input));
    handle.send(Input::Closed(number));
    let _ = writer.join();
    Ok(())
}

fn write(lines: &Lines, mut output: impl Write) -> io::Result<()> {
    while let Some(text) = lines.batch() {
        put(lines, &mut output, text.as_bytes()).and_then(|()| output.flush())?;
    }
    Ok(())
}

/// Writes all bytes. Waits for a slow client; if the client is being disconnected, only for [`PATIENCE`].
fn put(lines: &Lines, output: &mut impl Write, mut bytes: &[u8]) -> io::Result<()> {
    while !bytes.is_empty() {
        match output.write(bytes) {
            Ok(0) => return Err(ErrorKind::WriteZero.into()),
            Ok(written) => bytes = bytes.get(written..).unwrap_or_default(),
            Err(error) if error.kind() == ErrorKind::Interrupted => {}
            Err(error) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) && !lines.is_closed() => {
                // A non-blocking output.
                thread::sleep(Duration::from_millis(1));
            }
            Err(error) => return Err(error),
        }
    }
    Ok(())
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

/// Skips the rest of a line that is too long.
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
pub fn listen(handle: &Handle, listener: &TcpListener, log: Log) {
    let handle = handle.clone();
    accept::each(listener, "client", MOST, log, move |stream| {
        // Answers are short, and wanted at once.
        if stream.set_nodelay(true).and_then(|()| stream.set_write_timeout(Some(PATIENCE))).is_ok()
            && probed(&stream).is_ok()
            && let (Ok(input), Ok(output)) = (stream.try_clone(), stream.try_clone())
        {
            // A connection that cannot be written to has ended: then its input ends, too.
            let _ = serve(&handle, input, Closing(output), drop);
        }
    });
}

/// Has the system ask from time to time whether the other end is still there. Without this, a client whose machine has gone keeps its
/// place for ever, as it sends no end.
fn probed(stream: &TcpStream) -> io::Result<()> {
    let probes = TcpKeepalive::new().with_time(PROBE).with_interval(PROBE);
    SockRef::from(stream).set_tcp_keepalive(&probes)
}

/// Ends both ways of a connection when nothing more is written to it: a client that is let go.
struct Closing(TcpStream);

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

#[cfg(test)]
mod tests {
    use super::*;

    /// A client whose machine had gone kept its place until the program ended.
    #[test]
    fn clients_are_asked_whether_they_are_still_there() {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let _client = TcpStream::connect(listener.local_addr().unwrap()).unwrap();
        let (stream, _) = listener.accept().unwrap();
        assert!(!SockRef::from(&stream).keepalive().unwrap());
        probed(&stream).unwrap();
        assert!(SockRef::from(&stream).keepalive().unwrap());
    }
}
