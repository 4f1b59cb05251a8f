//! The thread that owns the supervisor. Other threads read input and write output; bounded queues connect them, so that
//! a client that sends too fast has to wait, and one that reads too slowly is disconnected.

use crate::board::Board;
use crate::event::Event;
use crate::fault::Fault;
use crate::lines;
use crate::log::{Level, Log};
use crate::outbox::{Lost, Outbox};
use crate::supervisor::Supervisor;
use crate::writer::Kept;
use serde_json::Value;
use std::collections::{HashMap, VecDeque};
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, TrySendError, sync_channel};
use std::time::{Duration, Instant};

/// Requests that may wait.
const QUEUE: usize = 4096;

/// Requests that are decided together.
const BATCH: usize = 256;

/// Even if nothing is asked, so often \[ms\].
const TICK: u64 = 50;

/// What is done once all that was decided before is in the journal.
pub type Then = Box<dyn FnOnce() + Send>;

/// A call of something that is done with the supervisor, and of what tells others of that.
pub type Call = Box<dyn FnOnce(&mut Supervisor, &Board, f64) -> Option<Then> + Send>;

/// Something for the thread that owns the supervisor.
pub enum Input {
    /// A client is there, and gets its lines here.
    Opened(u64, Outbox),
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
    /// More of the journal is on the disc.
    Kept,
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

    /// More of the journal is on the disc. Where the queue is full it is seen anyway.
    pub fn wake(&self) {
        let _ = self.sender.try_send((Instant::now(), Input::Kept));
    }

    /// Asks something and waits for the answer; none: it has ended.
    pub fn ask<T: Send + 'static>(
        &self,
        question: impl FnOnce(&mut Supervisor, &Board, f64) -> T + Send + 'static,
    ) -> Option<T> {
        self.ask_then(move |supervisor, board, now| (question(supervisor, board, now), None))
    }

    /// The same, and what is done once all that was decided then is in the journal, which is not waited for.
    pub fn ask_then<T: Send + 'static>(
        &self,
        question: impl FnOnce(&mut Supervisor, &Board, f64) -> (T, Option<Then>) + Send + 'static,
    ) -> Option<T> {
        let (sender, receiver) = sync_channel(1);
        let call: Call = Box::new(move |supervisor, board, now| {
            let (answer, then) = question(supervisor, board, now);
            // Whoever has asked may have gone.
            let _ = sender.send(answer);
            then
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
    out: Outbox,
    watches: bool,
}

/// What may be told once so many batches of the journal are on the disc.
#[derive(Default)]
struct Told {
    batches: u64,
    now: f64,
    answers: Vec<(u64, Value)>,
    events: Vec<Event>,
    thens: Vec<Then>,
    closed: Vec<u64>,
    times: Vec<Instant>,
}

/// The others, and what they are shown.
struct Desk {
    clients: HashMap<u64, Client>,
    listeners: Vec<SyncSender<Event>>,
    board: Board,
    log: Log,
}

/// Serves until it is told to stop, or the journal cannot be written. `kept` is that of the supervisor's journal.
///
/// # Errors
/// [`Fault::Broken`].
pub fn serve(
    supervisor: &mut Supervisor,
    inputs: &Receiver<(Instant, Input)>,
    kept: &Kept,
    log: Log,
) -> Result<(), Fault> {
    let begin = Instant::now();
    let mut desk = Desk { clients: HashMap::new(), listeners: Vec::new(), board: Board::default(), log };
    let mut waiting: VecDeque<Told> = VecDeque::new();
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
        let (mut told, stops) = desk.take(supervisor, batch, begin, now);
        // What is said from here on is in the journal, or on its way there.
        let settled = supervisor.settle(now).map(|events| told.events = events);
        told.batches = kept.asked();
        waiting.push_back(told);
        let done = settled.and_then(|()| if stops { kept.wait() } else { Ok(()) }).and_then(|()| kept.done());
        let done = match done {
            Ok(done) => done,
            Err(fault) => {
                waiting.into_iter().for_each(|told| desk.withdraw(told, &fault));
                log.write(Level::Error, "stopped", &[("why", &fault)]);
                return Err(fault);
            }
        };
        while waiting.front().is_some_and(|told| told.batches <= done)
            && let Some(told) = waiting.pop_front()
        {
            desk.tell(told);
        }
        if stops {
            return Ok(());
        }
    }
}

impl Desk {
    /// Does what is asked; what is to be said of it, and whether it is the end.
    fn take(
        &mut self,
        supervisor: &mut Supervisor,
        batch: Vec<(Instant, Input)>,
        begin: Instant,
        now: f64,
    ) -> (Told, bool) {
        let (mut told, mut stops) = (Told { now, ..Told::default() }, false);
        for (came, input) in batch {
            let time = came.saturating_duration_since(begin).as_secs_f64().min(now);
            match input {
                Input::Opened(client, out) => drop(self.clients.insert(client, Client { out, watches: false })),
                // What it has asked before is answered.
                Input::Closed(client) => told.closed.push(client),
                Input::TooLong(client) => told.answers.push((client, lines::too_long())),
                Input::Line(client, line) => {
                    let reply = lines::handle(supervisor, &line, time, now);
                    if let (Some(watches), Some(client)) = (reply.watches, self.clients.get_mut(&client)) {
                        client.watches = watches;
                    }
                    told.answers.push((client, reply.answer));
                    told.times.push(came);
                }
                Input::Call(call) => told.thens.extend(call(supervisor, &self.board, now)),
                Input::Tell(listener) => self.listeners.push(listener),
                Input::Kept => {}
                Input::Stop => stops = true,
            }
        }
        (told, stops)
    }

    fn tell(&mut self, told: Told) {
        let Self { clients, listeners, board, log } = self;
        for (client, answer) in told.answers {
            send(clients, client, &answer, *log);
        }
        for event in &told.events {
            log.event(event);
            board.note(told.now, event);
            let watching: Vec<u64> =
                clients.iter().filter(|(_, client)| client.watches).map(|(number, _)| *number).collect();
            let news = if watching.is_empty() { Value::Null } else { lines::news(event) };
            for client in watching {
                send(clients, client, &news, *log);
            }
            listeners.retain(|listener| {
                let sent = listener.try_send(event.clone());
                if let Err(TrySendError::Full(_)) = sent {
                    log.write(Level::Error, "a listener reads too slowly and is let go", &[]);
                }
                sent.is_ok()
            });
        }
        told.thens.into_iter().for_each(|then| then());
        for client in told.closed {
            clients.remove(&client);
        }
        told.times.into_iter().for_each(|came| board.latency.add(came.elapsed()));
    }

    /// The journal could not be written: nothing of it is so.
    fn withdraw(&mut self, told: Told, fault: &Fault) {
        for (client, answer) in told.answers {
            send(&mut self.clients, client, &lines::withdrawn(&answer, fault), self.log);
        }
    }
}

fn send(clients: &mut HashMap<u64, Client>, number: u64, line: &Value, log: Log) {
    let Some(client) = clients.get(&number) else { return };
    match client.out.send(format!("{line}\n")) {
        Ok(()) => {}
        Err(Lost::Gone) => drop(clients.remove(&number)),
        Err(Lost::Slow) => {
            // It would miss something without knowing.
            log.write(Level::Warn, "a client reads too slowly and is let go", &[("client", &number)]);
            clients.remove(&number);
        }
    }
}
