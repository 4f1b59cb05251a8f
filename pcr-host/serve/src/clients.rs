//! Clients of the line protocol: standard input and output, and sockets.

use crate::connection_limit::{self, ConnectionPermit};
use crate::hello::{self, ConnectionRefusal};
use crate::lines::{self, LONGEST, RequestLine};
use crate::log::LogWriter;
use crate::outbox::{OutboxReceiver, outbox};
use crate::refusals::Refusals;
use crate::request_error::RequestError;
use crate::server::{ServerHandle, ServerInput};
use crate::sockets::{Listener, Stream};
use crate::token::Token;
use crate::unanswered_lines::UnansweredLines;
use socket2::{SockRef, TcpKeepalive};
use std::collections::VecDeque;
use std::io::{self, BufRead, BufReader, ErrorKind, Read, Write};
use std::net::{Shutdown, TcpStream};
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

/// Number of the next client.
static NEXT: AtomicU64 = AtomicU64::new(1);

/// Time that a disconnected client of a socket has to read some of its lines, before the connection ends.
const PATIENCE: Duration = Duration::from_secs(30);

/// Time without any message after which the system asks whether a client is still there, and time between two such questions.
const PROBE: Duration = Duration::from_secs(15);

/// Who may be a client of a socket, and how many at a time.
#[derive(Clone, Debug)]
pub struct Access {
    /// The token that a client has to send; `None`: whoever can connect is a client, as the permissions of a file say.
    pub token: Option<Token>,
    /// Time in which the first line has to come.
    pub within: Duration,
    /// Largest number of clients.
    pub clients: usize,
    /// Largest number of connections whose first line has not come yet. One more ends the oldest of them.
    pub strangers: usize,
}

impl Access {
    /// The usual numbers.
    pub fn new(token: Option<Token>) -> Self {
        Self { token, within: Duration::from_secs(5), clients: 256, strangers: 64 }
    }
}

/// Reads lines from `input` and writes answers to `output`. Returns when the input has ended and all lines that were read are
/// answered. If the output cannot be written, `lost` is called at once, with the reason; what is read after
/// that is carried out, but not answered.
///
/// # Errors
/// The thread for the answers cannot be started; nothing is read then.
pub fn serve(
    handle: &ServerHandle,
    input: impl Read,
    output: impl Write + Send + 'static,
    lost: impl FnOnce(io::Error) + Send + 'static,
) -> io::Result<()> {
    converse(handle, output, lost, |number| {
        let unanswered = UnansweredLines::default();
        // An error of reading counts as the end.
        let _ = read(&mut BufReader::new(input), |_, _, request| {
            handle.send(match request {
                Some(request) => ServerInput::Line(number, request.counted(unanswered.add())),
                None => ServerInput::Answer(number, lines::too_long()),
            })
        });
    })
}

/// Writes answers to `output` while `reads` reads the lines of a client with a number.
fn converse(
    handle: &ServerHandle,
    output: impl Write + Send + 'static,
    lost: impl FnOnce(io::Error) + Send + 'static,
    reads: impl FnOnce(u64),
) -> io::Result<()> {
    let number = NEXT.fetch_add(1, Ordering::Relaxed);
    let (sender, lines) = outbox();
    let work = move || write(&lines, output).unwrap_or_else(lost);
    let writer = thread::Builder::new().name("answers".into()).spawn(work)?;
    if !handle.send(ServerInput::Opened(number, sender)) {
        return Ok(());
    }
    reads(number);
    handle.send(ServerInput::Closed(number));
    let _ = writer.join();
    Ok(())
}

fn write(lines: &OutboxReceiver, mut output: impl Write) -> io::Result<()> {
    while let Some(text) = lines.batch() {
        put(lines, &mut output, text.as_bytes()).and_then(|()| output.flush())?;
    }
    Ok(())
}

/// Writes all bytes. Waits for a slow client; if the client is being disconnected, only for [`PATIENCE`].
fn put(lines: &OutboxReceiver, output: &mut impl Write, mut bytes: &[u8]) -> io::Result<()> {
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

/// Gives each line to `take`, with what has come behind it, and the request in it; `None`: the line is too long, and is skipped. Ends when
/// `take` returns `false`.
fn read<R: Read>(
    input: &mut BufReader<R>,
    mut take: impl FnMut(&[u8], &[u8], Option<RequestLine>) -> bool,
) -> io::Result<()> {
    loop {
        let mut line = Vec::new();
        let read = input.by_ref().take(LONGEST as u64 + 1).read_until(b'\n', &mut line)?;
        if read == 0 {
            return Ok(());
        }
        let goes_on = if line.last() != Some(&b'\n') && line.len() > LONGEST {
            let goes_on = take(&line, input.buffer(), None);
            if goes_on {
                skip(input)?;
            }
            goes_on
        } else {
            let text = line.trim_ascii();
            text.is_empty() || take(text, input.buffer(), Some(RequestLine::read(text)))
        };
        if !goes_on {
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

/// Takes clients at a socket, for ever. The first line of each has to be a hello, and a connection ends at the first line that is no JSON
/// object.
pub fn listen(handle: &ServerHandle, listener: &Listener, access: Access, log: LogWriter) {
    let (handle, most) = (handle.clone(), access.clients + 2 * access.strangers);
    let (strangers, clients) = (Strangers::new(access.strangers, Refusals::new(log)), Arc::new(AtomicUsize::new(0)));
    connection_limit::each(listener, "client", most, log, move |stream, who| {
        // An error means that the connection has ended.
        let _ = welcome(&handle, &access, &strangers, &clients, stream, who);
    });
}

/// Serves a connection until it ends.
fn welcome(
    handle: &ServerHandle,
    access: &Access,
    strangers: &Strangers,
    clients: &Arc<AtomicUsize>,
    mut stream: Stream,
    who: &str,
) -> io::Result<()> {
    stream.set_write_timeout(Some(PATIENCE))?;
    if let Stream::Tcp(stream) = &stream {
        // Answers are short, and wanted at once.
        stream.set_nodelay(true)?;
        probed(stream)?;
    }
    let stranger = strangers.enter(&stream, who)?;
    let mut input = BufReader::new(stream.try_clone()?);
    let first = match hello::read(&mut input, access.token.as_ref(), access.within) {
        Ok(None) => return Ok(()),
        Ok(Some(first)) => first,
        Err(refusal) => return refuse(&mut stream, &strangers.refusals, who, &refusal),
    };
    let Some(_permit) = ConnectionPermit::acquire(clients, access.clients) else {
        let fault = RequestError::Full { places: access.clients };
        let refusal = ConnectionRefusal::Hello(fault.clone(), first.refused(fault));
        return refuse(&mut stream, &strangers.refusals, who, &refusal);
    };
    if !stranger.leaves() {
        // It was ended just now.
        return Ok(());
    }
    stream.set_read_timeout(None)?;
    // A connection that cannot be written to has ended: then its input ends, too.
    converse(handle, Shut(stream.try_clone()?), drop, |number| {
        let unanswered = UnansweredLines::default();
        if !handle.send(ServerInput::Line(number, first.counted(unanswered.add()))) {
            return;
        }
        let _ = read(&mut input, |line, behind, request| {
            let refusal = match request {
                Some(request) if request.is_object() => {
                    return handle.send(ServerInput::Line(number, request.counted(unanswered.add())));
                }
                Some(request) => hello::no_object(line, behind, &request),
                None => ConnectionRefusal::TooLong(LONGEST),
            };
            strangers.refusals.note(who, &refusal);
            handle.send(ServerInput::Answer(number, refusal.answer()));
            false
        });
    })
}

/// Writes a last line to a connection and ends it.
fn refuse(stream: &mut Stream, refusals: &Refusals, who: &str, refusal: &ConnectionRefusal) -> io::Result<()> {
    /// Largest size and longest time of what is read after it: an end with bytes that are not read may take the line away from the client.
    const REST: (u64, Duration) = (1 << 16, Duration::from_secs(1));
    refusals.note(who, refusal);
    stream.set_write_timeout(Some(REST.1))?;
    stream.write_all(format!("{}\n", refusal.answer()).as_bytes())?;
    stream.shutdown(Shutdown::Write)?;
    let (until, mut left, mut part) = (Instant::now() + REST.1, REST.0, [0; 4096]);
    while left > 0 && Instant::now() < until {
        stream.set_read_timeout(Some(REST.1))?;
        match stream.read(&mut part)? {
            0 => break,
            count => left = left.saturating_sub(count as u64),
        }
    }
    Ok(())
}

/// Has the system ask from time to time whether the other end is still there. Without this, a client whose machine has gone keeps its
/// place for ever, as it sends no end.
fn probed(stream: &TcpStream) -> io::Result<()> {
    let probes = TcpKeepalive::new().with_time(PROBE).with_interval(PROBE);
    SockRef::from(stream).set_tcp_keepalive(&probes)
}

/// Ends both ways of a connection when nothing more is written to it: a client that is let go.
struct Shut(Stream);

impl Write for Shut {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.0.flush()
    }
}

impl Drop for Shut {
    fn drop(&mut self) {
        // It may be closed already.
        let _ = self.0.shutdown(Shutdown::Both);
    }
}

/// Connections whose first line has not come yet, oldest first.
#[derive(Clone)]
struct Strangers {
    most: usize,
    open: Arc<Mutex<VecDeque<(u64, Stream, String)>>>,
    refusals: Refusals,
}

impl Strangers {
    fn new(most: usize, refusals: Refusals) -> Self {
        Self { most, open: Arc::default(), refusals }
    }

    /// Notes a connection. If there are too many, the oldest ones end: a client sends its first line at once.
    fn enter(&self, stream: &Stream, who: &str) -> io::Result<Stranger> {
        let number = NEXT.fetch_add(1, Ordering::Relaxed);
        let mut open = self.open.lock().unwrap_or_else(PoisonError::into_inner);
        open.push_back((number, stream.try_clone()?, who.into()));
        while open.len() > self.most
            && let Some((_, oldest, who)) = open.pop_front()
        {
            // Its thread sees the end.
            let _ = oldest.shutdown(Shutdown::Both);
            self.refusals.note(&who, &ConnectionRefusal::Crowded);
        }
        Ok(Stranger { number, open: self.open.clone() })
    }
}

/// One of these connections; it is none any more when this is dropped.
struct Stranger {
    number: u64,
    open: Arc<Mutex<VecDeque<(u64, Stream, String)>>>,
}

impl Stranger {
    /// Takes it from the list; returns whether it was still there.
    fn leaves(&self) -> bool {
        let mut open = self.open.lock().unwrap_or_else(PoisonError::into_inner);
        let place = open.iter().position(|(number, ..)| *number == self.number);
        place.and_then(|place| open.remove(place)).is_some()
    }
}

impl Drop for Stranger {
    fn drop(&mut self) {
        self.leaves();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::net::TcpListener;

    /// Lines as they are taken, by their lengths, with whether there is a request in them; ends after so many.
    fn taken(text: &str, most: usize) -> Vec<(usize, bool)> {
        let mut taken = Vec::new();
        // Parts smaller than a line.
        let mut input = BufReader::with_capacity(1 << 16, text.as_bytes());
        read(&mut input, |line, _, request| {
            assert_eq!(request.as_ref().is_some_and(RequestLine::is_object), line.len() < 10);
            taken.push((line.len(), request.is_some()));
            taken.len() < most
        })
        .unwrap();
        taken
    }

    #[test]
    fn lines_are_read_up_to_their_longest_and_longer_ones_are_skipped() {
        let line = |length| "x".repeat(length);
        for (length, is_read) in [(LONGEST - 1, true), (LONGEST, true), (LONGEST + 1, false), (3 * LONGEST, false)] {
            // Of one that is too long, a byte more than the longest is read.
            let long = (length.min(LONGEST + 1), is_read);
            let lines = format!("{{}}\n{}\n\n  \n{{}}\n", line(length));
            assert_eq!(taken(&lines, 9), [(2, true), long, (2, true)], "{length}");
            assert_eq!(taken(&lines, 2), [(2, true), long], "{length}");
            // The last line needs no end.
            assert_eq!(taken(&format!("{{}}\n{}", line(length)), 9), [(2, true), long], "{length}");
        }
        assert_eq!(taken("", 9), []);
        assert_eq!(taken("\r\n{}\r\n{}", 9), [(2, true); 2]);
    }

    /// Takes a byte from time to time.
    struct SlowOutput {
        turns: usize,
        text: Vec<u8>,
        ends: Option<ErrorKind>,
    }

    impl Write for SlowOutput {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            self.turns += 1;
            match self.turns % 4 {
                0 => {
                    self.text.push(bytes[0]);
                    Ok(1)
                }
                1 => Err(ErrorKind::Interrupted.into()),
                2 => Err(ErrorKind::WouldBlock.into()),
                _ => match self.ends {
                    Some(kind) => Err(kind.into()),
                    None => Err(ErrorKind::TimedOut.into()),
                },
            }
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    #[test]
    fn a_slow_output_is_waited_for_unless_it_is_let_go() {
        let written = |is_closed: bool, ends| {
            let (sender, lines) = outbox();
            let _sender = (!is_closed).then_some(sender);
            let mut output = SlowOutput { turns: 0, text: Vec::new(), ends };
            let end = put(&lines, &mut output, b"answer").map_err(|error| error.kind());
            (String::from_utf8(output.text).unwrap(), end)
        };
        assert_eq!(written(false, None), ("answer".into(), Ok(())));
        assert_eq!(written(true, None), (String::new(), Err(ErrorKind::WouldBlock)));
        assert_eq!(written(false, Some(ErrorKind::BrokenPipe)), (String::new(), Err(ErrorKind::BrokenPipe)));
    }

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
