//! The thread that owns the supervisor. Other threads read input and write output; bounded queues connect them, so that
//! a client that sends too fast has to wait, and one that reads too slowly is disconnected.

use crate::event::SupervisorEvent;
use crate::journal_writer::WriteProgress;
use crate::lines::{self, LineReply, RequestLine};
use crate::log::{LogLevel, LogWriter};
use crate::outbox::{DisconnectReason, OutboxSender};
use crate::request_error::RequestError;
use crate::supervisor::Supervisor;
use crate::telemetry::Telemetry;
use crate::unanswered_lines::UnansweredLine;
use serde_json::Value;
use std::collections::{BTreeSet, HashMap, VecDeque};
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, TrySendError, sync_channel};
use std::time::{Duration, Instant};

/// Largest number of requests that wait.
const QUEUE: usize = 4096;

/// Largest number of requests that are decided together.
const BATCH: usize = 256;

/// Time after which the supervisor settles, even without a request \[ms\].
const TICK: u64 = 50;

/// Largest size of what waits for the journal \[bytes\]. While a disk hangs for longer, no requests are taken.
const HEAVY: usize = 64 << 20;

/// Usual size of an answer or an event, with what holds it \[bytes\].
const USUAL: usize = 512;

/// An action for when all earlier decisions are in the journal.
pub struct AfterCommit {
    bytes: usize,
    /// When the messages came from which it follows: their latency ends with it.
    times: Vec<Instant>,
    act: Box<dyn FnOnce() + Send>,
}

impl AfterCommit {
    /// An action that holds so many bytes until then.
    pub fn new(bytes: usize, act: impl FnOnce() + Send + 'static) -> Self {
        Self { bytes, times: Vec::new(), act: Box::new(act) }
    }

    /// Returns the same action, as what follows from messages that came at these times.
    pub(crate) fn for_messages(self, times: Vec<Instant>) -> Self {
        Self { times, ..self }
    }
}

/// A call with the supervisor; it returns the action that sends its results to others.
pub type SupervisorCall = Box<dyn FnOnce(&mut Supervisor, &Telemetry, f64) -> Option<AfterCommit> + Send>;

/// Input of the thread that owns the supervisor.
pub enum ServerInput {
    /// A client has connected; its lines go to this outbox.
    Opened(u64, OutboxSender),
    /// A line of a client.
    Line(u64, RequestLine),
    /// An answer to a line of a client that was not read as a request.
    Answer(u64, Value),
    /// A client has disconnected.
    Closed(u64),
    /// A call with the supervisor, such as a query of the page or a message of a vehicle.
    Call(SupervisorCall),
    /// A subscriber of all events. If its queue is full it is dropped, and sees the end of the queue.
    Tell(SyncSender<SupervisorEvent>),
    /// The journal has written more to the disk.
    Kept,
    /// The server ends.
    Stop,
}

/// A sender to the thread that owns the supervisor.
#[derive(Clone, Debug)]
pub struct ServerHandle {
    sender: SyncSender<(Instant, ServerInput)>,
}

impl ServerHandle {
    /// Sends an input; waits while the queue is full. `false`: the server has ended.
    pub fn send(&self, input: ServerInput) -> bool {
        self.sender.send((Instant::now(), input)).is_ok()
    }

    /// Notes that the journal has written more to the disk. If the queue is full, the server looks at it anyway.
    pub fn wake(&self) {
        let _ = self.sender.try_send((Instant::now(), ServerInput::Kept));
    }

    /// Makes a call and waits for its answer; `None`: the server has ended.
    pub fn ask<T: Send + 'static>(
        &self,
        question: impl FnOnce(&mut Supervisor, &Telemetry, f64) -> T + Send + 'static,
    ) -> Option<T> {
        self.ask_then(move |supervisor, board, now| (question(supervisor, board, now), None))
    }

    /// The same, with an action for when all decisions of the call are in the journal. Does not wait for the action.
    pub fn ask_then<T: Send + 'static>(
        &self,
        question: impl FnOnce(&mut Supervisor, &Telemetry, f64) -> (T, Option<AfterCommit>) + Send + 'static,
    ) -> Option<T> {
        let (sender, receiver) = sync_channel(1);
        let call: SupervisorCall = Box::new(move |supervisor, board, now| {
            let (answer, then) = question(supervisor, board, now);
            // The caller may have ended.
            let _ = sender.send(answer);
            then
        });
        self.send(ServerInput::Call(call)).then(|| receiver.recv().ok()).flatten()
    }
}

/// The queue of a server that has not been started yet.
pub fn queue() -> (ServerHandle, Receiver<(Instant, ServerInput)>) {
    let (sender, receiver) = sync_channel(QUEUE);
    (ServerHandle { sender }, receiver)
}

struct LineClient {
    out: OutboxSender,
    watches: bool,
}

/// An answer to a client.
struct PendingAnswer {
    client: u64,
    answer: Value,
    unanswered: Option<UnansweredLine>,
}

/// Messages that may be sent once this number of batches is on the disk.
#[derive(Default)]
struct PendingBatch {
    batches: u64,
    /// Size of all of it \[bytes\].
    bytes: usize,
    now: f64,
    answers: Vec<PendingAnswer>,
    events: Vec<SupervisorEvent>,
    thens: Vec<AfterCommit>,
    closed: Vec<u64>,
    times: Vec<Instant>,
}

impl PendingBatch {
    fn size(&self) -> usize {
        let acts: usize = self.thens.iter().map(|then| then.bytes + size_of_val(&*then.times)).sum();
        acts + USUAL * (1 + self.answers.len() + self.events.len() + self.thens.len())
    }
}

/// The clients, the subscribers and the published data.
struct ClientHub {
    clients: HashMap<u64, LineClient>,
    listeners: Vec<SyncSender<SupervisorEvent>>,
    telemetry: Telemetry,
    /// Number and names of the robots, as they were last logged.
    census: u64,
    names: BTreeSet<String>,
    log: LogWriter,
}

/// Serves until `Stop`, or until the journal cannot be written. `kept` is the progress of the supervisor's journal.
///
/// # Errors
/// [`RequestError::Broken`].
pub fn serve(
    supervisor: &mut Supervisor,
    inputs: &Receiver<(Instant, ServerInput)>,
    kept: &WriteProgress,
    log: LogWriter,
) -> Result<(), RequestError> {
    let begin = Instant::now();
    let mut desk = ClientHub {
        clients: HashMap::new(),
        listeners: Vec::new(),
        telemetry: Telemetry::new(begin),
        census: supervisor.census(),
        names: names(supervisor),
        log,
    };
    let (mut waiting, mut heavy, mut is_full): (VecDeque<PendingBatch>, usize, bool) = Default::default();
    loop {
        if heavy > HEAVY {
            if !std::mem::replace(&mut is_full, true) {
                log.write(LogLevel::Error, "the journal is too slow: nothing is read until it has written", &[]);
            }
            kept.wait_for(Duration::from_millis(TICK));
            // Who has to stop, because a robot may have come nearer meanwhile, is told all the same.
            let now = begin.elapsed().as_secs_f64();
            supervisor.decide(now);
            desk.stop(supervisor.stops(), &mut waiting, now);
            heavy -= desk.tell_kept(&mut waiting, kept)?;
            continue;
        }
        is_full = false;
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
        let (mut told, ends) = desk.take(supervisor, batch, now);
        supervisor.decide(now);
        // They do not wait for the journal, which may be slow, or fail now.
        desk.stop(supervisor.stops(), &mut waiting, now);
        // All else that is sent from here on is in the journal, or on its way there.
        let settled = if ends { supervisor.finish(now) } else { supervisor.keep() };
        let settled = settled.map(|events| told.events = events);
        told.batches = kept.asked();
        told.bytes = told.size();
        heavy += told.bytes;
        waiting.push_back(told);
        if let Err(fault) = settled.and_then(|()| if ends { kept.wait() } else { Ok(()) }) {
            return Err(desk.withdraw(waiting, fault));
        }
        heavy -= desk.tell_kept(&mut waiting, kept)?;
        if ends {
            return Ok(());
        }
    }
}

fn names(supervisor: &Supervisor) -> BTreeSet<String> {
    supervisor.robots().iter().map(|robot| robot.name.clone()).collect()
}

impl ClientHub {
    /// Handles a batch of inputs; returns what to send, and whether the server ends.
    fn take(
        &mut self,
        supervisor: &mut Supervisor,
        batch: Vec<(Instant, ServerInput)>,
        now: f64,
    ) -> (PendingBatch, bool) {
        let (mut told, mut ends) = (PendingBatch { now, ..PendingBatch::default() }, false);
        for (came, input) in batch {
            let time = self.telemetry.time(came).min(now);
            match input {
                ServerInput::Opened(client, out) => {
                    drop(self.clients.insert(client, LineClient { out, watches: false }))
                }
                // Its earlier requests are answered.
                ServerInput::Closed(client) => told.closed.push(client),
                ServerInput::Answer(client, answer) => {
                    told.answers.push(PendingAnswer { client, answer, unanswered: None });
                }
                ServerInput::Line(number, request) => {
                    // One that was let go does not learn what becomes of its requests: those that still wait are not carried out.
                    if let Some(client) = self.clients.get_mut(&number) {
                        let reply = lines::carry_out(supervisor, request, time, now);
                        client.watches = reply.watches.unwrap_or(client.watches);
                        let LineReply { answer, unanswered, .. } = reply;
                        told.answers.push(PendingAnswer { client: number, answer, unanswered });
                        told.times.push(came);
                    }
                }
                ServerInput::Call(call) => told.thens.extend(call(supervisor, &self.telemetry, now)),
                ServerInput::Tell(listener) => self.listeners.push(listener),
                ServerInput::Kept => {}
                ServerInput::Stop => ends = true,
            }
            self.count(supervisor);
        }
        (told, ends)
    }

    /// Logs robots that were added or removed.
    fn count(&mut self, supervisor: &Supervisor) {
        if self.census == supervisor.census() {
            return;
        }
        let before = std::mem::replace(&mut self.names, names(supervisor));
        self.census = supervisor.census();
        let log = |what: &str, robot: &String| self.log.write(LogLevel::Info, what, &[("robot", robot)]);
        before.difference(&self.names).for_each(|robot| log("a robot was removed", robot));
        self.names.difference(&before).for_each(|robot| log("a robot was added", robot));
    }

    /// Tells robots to stop, at once. What waits and would let them go on is not told any more.
    fn stop(&mut self, stops: Vec<SupervisorEvent>, waiting: &mut VecDeque<PendingBatch>, now: f64) {
        for stop in stops {
            waiting.iter_mut().for_each(|told| told.events.retain(|event| !stop.overtakes(event)));
            self.announce(now, &stop);
        }
    }

    /// Tells what is in the journal by now; returns its size \[bytes\].
    ///
    /// # Errors
    /// [`RequestError::Broken`]: what waits is withdrawn.
    fn tell_kept(&mut self, waiting: &mut VecDeque<PendingBatch>, kept: &WriteProgress) -> Result<usize, RequestError> {
        let done = kept.done().map_err(|fault| self.withdraw(std::mem::take(waiting), fault))?;
        let mut bytes = 0;
        while waiting.front().is_some_and(|told| told.batches <= done)
            && let Some(told) = waiting.pop_front()
        {
            bytes += told.bytes;
            self.deliver(told);
        }
        Ok(bytes)
    }

    fn deliver(&mut self, told: PendingBatch) {
        for PendingAnswer { client, answer, unanswered } in told.answers {
            send(&mut self.clients, client, &answer, unanswered, self.log);
        }
        for event in &told.events {
            match event {
                // It was told at once, but clients may have ignored it for what they had not been told before.
                SupervisorEvent::Stop { .. } => self.send_news(event),
                event => self.announce(told.now, event),
            }
        }
        for then in told.thens {
            (then.act)();
            then.times.into_iter().for_each(|came| self.telemetry.latency.add(came.elapsed()));
        }
        for client in told.closed {
            self.clients.remove(&client);
        }
        told.times.into_iter().for_each(|came| self.telemetry.latency.add(came.elapsed()));
    }

    fn announce(&mut self, now: f64, event: &SupervisorEvent) {
        self.log.event(event);
        self.telemetry.note(now, event);
        self.send_news(event);
        let Self { listeners, log, .. } = self;
        listeners.retain(|listener| {
            let sent = listener.try_send(event.clone());
            if let Err(TrySendError::Full(_)) = sent {
                log.write(LogLevel::Error, "a listener reads too slowly and is let go", &[]);
            }
            sent.is_ok()
        });
    }

    /// Sends an event to the clients that watch.
    fn send_news(&mut self, event: &SupervisorEvent) {
        let Self { clients, log, .. } = self;
        let watching: Vec<u64> =
            clients.iter().filter(|(_, client)| client.watches).map(|(number, _)| *number).collect();
        let news = if watching.is_empty() { Value::Null } else { lines::news(event) };
        for client in watching {
            send(clients, client, &news, None, *log);
        }
    }

    /// After a failed write of the journal: answers errors in place of the results.
    fn withdraw(&mut self, waiting: VecDeque<PendingBatch>, fault: RequestError) -> RequestError {
        for PendingAnswer { client, answer, unanswered } in waiting.into_iter().flat_map(|told| told.answers) {
            send(&mut self.clients, client, &lines::withdrawn(&answer, &fault), unanswered, self.log);
        }
        self.log.write(LogLevel::Error, "stopped", &[("why", &fault)]);
        fault
    }
}

fn send(
    clients: &mut HashMap<u64, LineClient>,
    number: u64,
    line: &Value,
    unanswered: Option<UnansweredLine>,
    log: LogWriter,
) {
    let Some(client) = clients.get(&number) else { return };
    match client.out.send_answer(format!("{line}\n"), unanswered) {
        // One that has gone may have left requests, which are carried out: it is removed when its input has ended.
        Ok(()) | Err(DisconnectReason::Gone) => {}
        Err(DisconnectReason::Slow) => {
            // A client that misses lines would not notice it.
            log.write(LogLevel::Warn, "a client reads too slowly and is let go", &[("client", &number)]);
            clients.remove(&number);
        }
    }
}
