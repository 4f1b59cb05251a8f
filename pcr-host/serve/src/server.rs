//! One thread owns the supervisor. Others read what comes in and write what goes out; between them are queues with an end, so that
//! whoever sends too fast has to wait, and whoever reads too slowly is let go.

use crate::board::Board;
use crate::event::Event;
use crate::fault::Fault;
use crate::lines;
use crate::log::{Level, Log};
use crate::supervisor::Supervisor;
use serde_json::Value;
use std::collections::HashMap;
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, TrySendError, sync_channel};
use std::time::{Duration, Instant};

/// Requests that may wait.
const QUEUE: usize = 4096;

/// Lines that may wait for a client.
pub const BACKLOG: usize = 65_536;

/// Requests that are decided together.
const BATCH: usize = 256;

/// Even if nothing is asked, so often \[ms\].
const TICK: u64 = 50;

/// A call of something that is done with the supervisor.
pub type Call = Box<dyn FnOnce(&mut Supervisor, &Board, f64) + Send>;

/// Something for the thread that owns the supervisor.
pub enum Input {
    /// A client is there, and gets its lines here.
    Opened(u64, SyncSender<String>),
    /// A line of a client.
    Line(u64, Vec<u8>),
    /// A line of a client was too long.
    TooLong(u64),
    /// A client is gone.
    Closed(u64),
    /// Something else: a page that wants to know what is so, a bridge to robots.
    Call(Call),
    /// Everything that is told goes here, too. Who reads too slowly is let go, which it sees by the end of its queue.
    Tell(SyncSender<Event>),
    /// No more is to come.
    Stop,
}

/// A way to the thread that owns the supervisor.
#[derive(Clone, Debug)]
pub struct Handle {
    sender: SyncSender<(Instant, Input)>,
}

impl Handle {
    /// Sends something; waits while there is too much. False: it has ended.
    pub fn send(&self, input: Input) -> bool {
        self.sender.send((Instant::now(), input)).is_ok()
    }

    /// Asks something and waits for the answer; none: it has ended.
    pub fn ask<T: Send + 'static>(
        &self,
        question: impl FnOnce(&mut Supervisor, &Board, f64) -> T + Send + 'static,
    ) -> Option<T> {
        let (sender, receiver) = sync_channel(1);
        let call: Call = Box::new(move |supervisor, board, now| {
            // Whoever has asked may have gone.
            let _ = sender.send(question(supervisor, board, now));
        });
        self.send(Input::Call(call)).then(|| receiver.recv().ok()).flatten()
    }
}

/// The queue to a server that is not running yet.
pub fn queue() -> (Handle, Receiver<(Instant, Input)>) {
    let (sender, receiver) = sync_channel(QUEUE);
    (Handle { sender }, receiver)
}

struct Client {
    out: SyncSender<String>,
    watches: bool,
}

/// Serves until it is told to stop, or the journal cannot be written.
///
/// # Errors
/// [`Fault::Broken`].
pub fn serve(supervisor: &mut Supervisor, inputs: &Receiver<(Instant, Input)>, log: Log) -> Result<(), Fault> {
    let begin = Instant::now();
    let mut clients: HashMap<u64, Client> = HashMap::new();
    let mut listeners: Vec<SyncSender<Event>> = Vec::new();
    let mut board = Board::default();
    loop {
        let mut batch = Vec::new();
        match inputs.recv_timeout(Duration::from_millis(TICK)) {
            Ok(input) => batch.push(input),
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => return Ok(()),
        }
        while batch.len() < BATCH
            && let Ok(input) = inputs.try_recv()
        {
            batch.push(input);
        }
        let now = begin.elapsed().as_secs_f64();
        let (mut answers, mut times, mut closed, mut stops) = (Vec::new(), Vec::new(), Vec::new(), false);
        for (came, input) in batch {
            match input {
                Input::Opened(client, out) => drop(clients.insert(client, Client { out, watches: false })),
                // What it has asked before is answered.
                Input::Closed(client) => closed.push(client),
                Input::TooLong(client) => answers.push((client, lines::too_long())),
                Input::Line(client, line) => {
                    let reply = lines::handle(supervisor, &line, now);
                    if let (Some(watches), Some(client)) = (reply.watches, clients.get_mut(&client)) {
                        client.watches = watches;
                    }
                    answers.push((client, reply.answer));
                    times.push(came);
                }
                Input::Call(call) => call(supervisor, &board, now),
                Input::Tell(listener) => listeners.push(listener),
                Input::Stop => stops = true,
            }
        }
        // What is said from here on is in the journal.
        let settled = supervisor.settle(now);
        for (client, answer) in answers {
            let answer = settled.as_ref().map_or_else(|fault| lines::withdrawn(&answer, fault), |_| answer.clone());
            send(&mut clients, client, &answer, log);
        }
        let events = settled.inspect_err(|fault| log.write(Level::Error, "stopped", &[("why", fault)]))?;
        for event in &events {
            log.event(event);
            board.note(now, event);
            let watching: Vec<u64> =
                clients.iter().filter(|(_, client)| client.watches).map(|(number, _)| *number).collect();
            let news = if watching.is_empty() { Value::Null } else { lines::news(event) };
            for client in watching {
                send(&mut clients, client, &news, log);
            }
            listeners.retain(|listener| {
                let sent = listener.try_send(event.clone());
                if let Err(TrySendError::Full(_)) = sent {
                    log.write(Level::Error, "a listener reads too slowly and is let go", &[]);
                }
                sent.is_ok()
            });
        }
        for client in closed {
            clients.remove(&client);
        }
        times.into_iter().for_each(|came| board.latency.add(came.elapsed()));
        if stops {
            return Ok(());
        }
    }
}

fn send(clients: &mut HashMap<u64, Client>, number: u64, line: &Value, log: Log) {
    let Some(client) = clients.get(&number) else { return };
    match client.out.try_send(format!("{line}\n")) {
        Ok(()) => {}
        Err(TrySendError::Disconnected(_)) => drop(clients.remove(&number)),
        Err(TrySendError::Full(_)) => {
            // It would miss something without knowing.
            log.write(Level::Warn, "a client reads too slowly and is let go", &[("client", &number)]);
            clients.remove(&number);
        }
    }
}
