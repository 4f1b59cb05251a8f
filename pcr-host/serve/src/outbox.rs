//! Lines on their way to a client. So many bytes of them wait at most; a client that reads none is disconnected and told
//! why in the last line.

use crate::lines;
use crate::request_error::RequestError;
use crate::unanswered_lines::UnansweredLine;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, RecvError, RecvTimeoutError, Sender, TryRecvError, channel};
use std::time::Duration;

/// Bytes that may wait for a client: what a fleet of 1,000 robots is told in some seconds.
pub const BACKLOG: usize = 8 << 20;

/// Lines are written together up to this length \[bytes\].
const BATCH: usize = 1 << 16;

/// The end into which lines are written.
#[derive(Debug)]
pub struct OutboxSender {
    sender: Sender<(String, Option<UnansweredLine>)>,
    shared: Arc<OutboxState>,
}

/// The end from which lines are read.
#[derive(Debug)]
pub struct OutboxReceiver {
    receiver: Receiver<(String, Option<UnansweredLine>)>,
    shared: Arc<OutboxState>,
}

#[derive(Debug, Default)]
struct OutboxState {
    /// Number of bytes that wait.
    bytes: AtomicUsize,
    /// No more lines will come.
    is_closed: AtomicBool,
}

/// The reason why a client gets no more lines.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DisconnectReason {
    /// The client has disconnected.
    Gone,
    /// The client does not read the lines sent to it.
    Slow,
}

/// Creates both ends.
pub fn outbox() -> (OutboxSender, OutboxReceiver) {
    let (sender, receiver) = channel();
    let shared = Arc::<OutboxState>::default();
    (OutboxSender { sender, shared: shared.clone() }, OutboxReceiver { receiver, shared })
}

impl OutboxSender {
    /// Sends a line. A line that is longer than the backlog is sent if nothing else waits.
    ///
    /// # Errors
    /// [`DisconnectReason`]: nothing more may be sent to this client.
    pub fn send(&self, line: String) -> Result<(), DisconnectReason> {
        self.send_answer(line, None)
    }

    /// The same for the answer to a line of the client, which counts as one without an answer until the answer is taken.
    ///
    /// # Errors
    /// As [`OutboxSender::send`].
    pub(crate) fn send_answer(&self, line: String, unanswered: Option<UnansweredLine>) -> Result<(), DisconnectReason> {
        let waiting = self.shared.bytes.load(Ordering::Relaxed);
        if waiting > 0 && waiting.saturating_add(line.len()) > BACKLOG {
            // This may fail if the client has disconnected as well.
            let _ = self.put(format!("{}\n", lines::refusal(&RequestError::Slow { bytes: waiting })), None);
            return Err(DisconnectReason::Slow);
        }
        self.put(line, unanswered).map_err(|()| DisconnectReason::Gone)
    }

    fn put(&self, line: String, unanswered: Option<UnansweredLine>) -> Result<(), ()> {
        let length = line.len();
        self.shared.bytes.fetch_add(length, Ordering::Relaxed);
        self.sender.send((line, unanswered)).map_err(drop)
    }
}

impl Drop for OutboxSender {
    fn drop(&mut self) {
        self.shared.is_closed.store(true, Ordering::Relaxed);
    }
}

impl OutboxReceiver {
    /// The next line; waits for it.
    ///
    /// # Errors
    /// No more lines will come.
    pub fn recv(&self) -> Result<String, RecvError> {
        self.receiver.recv().map(|(line, _)| self.taken(line))
    }

    /// The next line, if it comes within a time.
    ///
    /// # Errors
    /// No line has come.
    pub fn recv_timeout(&self, time: Duration) -> Result<String, RecvTimeoutError> {
        self.receiver.recv_timeout(time).map(|(line, _)| self.taken(line))
    }

    /// The next line, if it is there.
    ///
    /// # Errors
    /// There is no line.
    pub fn try_recv(&self) -> Result<String, TryRecvError> {
        self.receiver.try_recv().map(|(line, _)| self.taken(line))
    }

    /// The next lines, to be written together; waits for the first. `None`: no more will come.
    pub fn batch(&self) -> Option<String> {
        let mut text = self.recv().ok()?;
        while text.len() < BATCH
            && let Ok(line) = self.try_recv()
        {
            text.push_str(&line);
        }
        Some(text)
    }

    /// Whether no lines will come beyond those that wait.
    pub fn is_closed(&self) -> bool {
        self.shared.is_closed.load(Ordering::Relaxed)
    }

    fn taken(&self, line: String) -> String {
        self.shared.bytes.fetch_sub(line.len(), Ordering::Relaxed);
        line
    }
}
