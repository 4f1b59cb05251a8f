//! Takes connections, up to a number at a time.

use crate::log::{LogLevel, LogWriter};
use crate::sockets::{Listener, Stream};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;
use std::time::Duration;

/// Pause after a connection that could not be taken: without a free file descriptor the next one fails at once, too.
const PAUSE: Duration = Duration::from_millis(100);

/// Takes connections for ever. Each goes to `serve`, with a name of the other end, in a thread of this name, and has one of `most` places
/// until that returns.
pub(crate) fn each(
    listener: &Listener,
    name: &'static str,
    most: usize,
    log: LogWriter,
    serve: impl Fn(Stream, &str) + Clone + Send + 'static,
) {
    let (open, mut fails, mut refuses) = (Arc::new(AtomicUsize::new(0)), false, false);
    loop {
        let (stream, who) = match listener.accept() {
            Ok(taken) => taken,
            Err(error) => {
                if !std::mem::replace(&mut fails, true) {
                    log.write(LogLevel::Error, "connections cannot be taken", &[("for", &name), ("why", &error)]);
                }
                thread::sleep(PAUSE);
                continue;
            }
        };
        fails = false;
        let Some(permit) = ConnectionPermit::acquire(&open, most) else {
            if !std::mem::replace(&mut refuses, true) {
                log.write(
                    LogLevel::Warn,
                    "connections are refused: all places are taken",
                    &[("for", &name), ("first", &who), ("places", &most)],
                );
            }
            continue;
        };
        refuses = false;
        let serve = serve.clone();
        let work = move || {
            let _permit = permit;
            serve(stream, &who);
        };
        if let Err(error) = thread::Builder::new().name(name.into()).spawn(work) {
            log.write(LogLevel::Error, "no thread for a connection", &[("for", &name), ("why", &error)]);
        }
    }
}

/// One of a number of places for connections; free again when it is dropped.
pub(crate) struct ConnectionPermit(Arc<AtomicUsize>);

impl ConnectionPermit {
    /// Takes one of `most` places, of which so many are taken; `None` if all are.
    pub(crate) fn acquire(taken: &Arc<AtomicUsize>, most: usize) -> Option<Self> {
        let next = |count: usize| (count < most).then_some(count + 1);
        taken.fetch_update(Ordering::Relaxed, Ordering::Relaxed, next).ok().map(|_| Self(taken.clone()))
    }
}

impl Drop for ConnectionPermit {
    fn drop(&mut self) {
        self.0.fetch_sub(1, Ordering::Relaxed);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::{Read, Write};
    use std::net::{TcpListener, TcpStream};

    #[test]
    fn one_beyond_all_places_is_refused_until_a_place_is_free() {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let at = listener.local_addr().unwrap();
        let serve = |mut stream: Stream, _: &str| {
            stream.write_all(b"here").unwrap();
            // Until the client ends.
            let _ = stream.read_to_end(&mut Vec::new());
        };
        thread::spawn(move || each(&listener.into(), "test", 1, LogWriter::new(LogLevel::Error), serve));
        let connected = || {
            let (mut client, mut said) = (TcpStream::connect(at).unwrap(), [0; 4]);
            client.read_exact(&mut said).map(|()| client)
        };
        let first = connected().unwrap();
        assert!(connected().is_err());
        drop(first);
        // Its thread ends some time after that.
        while connected().is_err() {
            thread::yield_now();
        }
    }
}
