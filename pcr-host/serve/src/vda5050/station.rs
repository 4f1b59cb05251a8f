//! The bridge at its broker; only one bridge is active at a time.
//!
//! The active bridge says so in a retained message, which its last will takes back. A second bridge sees the message
//! and stays passive. If two begin at the same time, the one whose message the broker receives first continues. The
//! retained message may be missing, or be that of another bridge, although a bridge is active. Therefore the active
//! bridge then repeats its message, and a claim counts only if no other bridge has objected for a while.

use super::bridge::{Bridge, Publish};
use super::header::Header;
use super::messages::Connection;
use super::mqtt::{Broker, Link, News};
use super::stamp;
use super::topics::{Interface, Key, Kind};
use super::version::Version;
use crate::board::Board;
use crate::event::Event;
use crate::fault::Fault;
use crate::server::{Handle, Then};
use crate::supervisor::Supervisor;
use serde_json::{Map, Value};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// How long it is waited for the last will of one that may be gone: a little more than the broker does.
const PATIENCE: Duration = Duration::from_secs(9);

/// How long it is waited for somebody who insists.
const OBJECTIONS: Duration = Duration::from_secs(1);

/// So many messages are answered together at most.
const MOST: usize = 1_000;

/// Nothing happens for so long at most without a look at what waits.
const TICK: Duration = Duration::from_millis(100);

/// Who supervises.
#[derive(Clone, Debug, PartialEq)]
enum Claim {
    /// Not known yet; since when.
    Asking(Instant),
    /// That of another one, of this session, which may be gone; since when.
    Theirs(Instant, String),
    /// Ours was sent.
    Sent,
    /// Ours has come back from the broker; since when nobody has insisted.
    Seen(Instant),
    /// Ours.
    Ours,
}

/// A message.
struct Heard {
    topic: String,
    payload: Vec<u8>,
    /// Whether the broker had kept it.
    kept: bool,
}

/// A bridge at its broker.
#[derive(Debug)]
pub struct Station {
    link: Link,
    news: Receiver<News>,
    session: String,
    topic: String,
    claim: Claim,
    begin: Instant,
    key: Key,
    /// The vehicles are to be asked how things are.
    greets: bool,
    log: Vec<String>,
}

/// Why a station stops.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Stopped(pub String);

impl Station {
    /// Connects to a broker; the session is a text that no other supervisor has.
    ///
    /// # Errors
    /// What is wrong with the settings.
    pub fn open(broker: &Broker, vehicles: &Interface, bridge: &Bridge, session: &str) -> Result<Self, String> {
        let key = Key::new("pcr", "supervisor")?;
        let topic = vehicles.topic(Version::V2_1, &key, Kind::Connection);
        let mut filters = bridge.filters();
        filters.push(topic.clone());
        let will = claim(&key, &topic, session, Version::V2_1.broken(), false);
        let (sender, news) = channel();
        let link = Link::open(broker, &format!("pcr-supervisor-{session}"), Some(will), filters, move |it| {
            // A station that is gone needs no news.
            let _ = sender.send(it);
        })?;
        let now = Instant::now();
        let (session, claim) = (session.into(), Claim::Asking(now));
        Ok(Self { link, news, session, topic, claim, begin: now, key, greets: false, log: Vec::new() })
    }

    /// Seconds since it was opened.
    pub fn now(&self) -> f64 {
        self.begin.elapsed().as_secs_f64()
    }

    /// Whether it supervises.
    pub fn is_ours(&self) -> bool {
        self.claim == Claim::Ours
    }

    /// Waits for messages, and answers them. Returns what the supervisor says.
    ///
    /// # Errors
    /// [`Stopped`]: another one supervises, or the journal is broken.
    pub fn turn(&mut self, supervisor: &mut Supervisor, bridge: &mut Bridge) -> Result<Vec<Event>, Stopped> {
        let messages = self.messages()?;
        let (now, works) = (self.now(), self.works());
        let greets = std::mem::take(&mut self.greets);
        let out = answered(supervisor, bridge, &messages, [greets, works], &[], now);
        let events = supervisor.settle(now).map_err(|fault: Fault| Stopped(fault.to_string()))?;
        // What lanes have to remember is in the journal before anybody is told.
        for message in out {
            // What is not sent now is sent again.
            let _ = self.link.publish(message);
        }
        bridge.told(&events);
        // Where nobody reads it.
        self.log.clear();
        Ok(events)
    }

    /// The same for a supervisor that another thread owns, which tells its events here. Returns what somebody should look at: why messages
    /// were refused, who is missing, why there is no broker.
    ///
    /// # Errors
    /// [`Stopped`].
    pub fn turn_at(
        &mut self,
        handle: &Handle,
        bridge: &Arc<Mutex<Bridge>>,
        events: &Receiver<Event>,
    ) -> Result<Vec<String>, Stopped> {
        let messages = self.messages()?;
        let (own, flags) = (bridge.clone(), [std::mem::take(&mut self.greets), self.works()]);
        let told: Vec<Event> = events.try_iter().collect();
        let mouth = self.link.mouth();
        let answer = move |supervisor: &mut Supervisor, _: &Board, now: f64| {
            let out = answered(supervisor, &mut locked(&own), &messages, flags, &told, now);
            // What is not sent then is sent again.
            let send = move || out.into_iter().for_each(|message| _ = mouth.publish(message));
            ((), Some(Box::new(send) as Then))
        };
        handle.ask_then(answer).ok_or_else(|| Stopped("the supervisor has ended".into()))?;
        let mut log = std::mem::take(&mut self.log);
        log.extend(locked(bridge).log());
        Ok(log)
    }

    /// Whether vehicles may be told something now.
    fn works(&self) -> bool {
        self.is_ours() && self.link.is_up()
    }

    /// What has come; waits for a little while if nothing has. While it is answered more comes, which is answered together then.
    fn messages(&mut self) -> Result<Vec<Heard>, Stopped> {
        let (mut messages, mut patience) = (Vec::new(), TICK);
        while messages.len() < MOST {
            match self.news.recv_timeout(patience) {
                Ok(News::Up) => self.claim = Claim::Asking(Instant::now()),
                Ok(News::Down(why)) => self.log.push(format!("no broker: {why}")),
                Ok(News::Message { topic, payload, .. }) if topic == self.topic => self.heard(&payload)?,
                Ok(News::Message { topic, payload, kept }) => messages.push(Heard { topic, payload, kept }),
                Err(RecvTimeoutError::Timeout) => break,
                Err(RecvTimeoutError::Disconnected) => return Err(Stopped("the connection has ended".into())),
            }
            patience = Duration::ZERO;
        }
        self.ask()?;
        Ok(messages)
    }

    /// Somebody supervises, or does no longer.
    fn heard(&mut self, payload: &[u8]) -> Result<(), Stopped> {
        let said: Value = serde_json::from_slice(payload).unwrap_or_default();
        let text = |field: &str| said.get(field).and_then(Value::as_str).unwrap_or_default();
        let is_online = text("connectionState") == "ONLINE";
        let insists = said.get("insists") == Some(&Value::Bool(true));
        match (&self.claim, text("session") == self.session) {
            (Claim::Sent, true) if is_online => self.claim = Claim::Seen(Instant::now()),
            // It may be gone: the broker will say so.
            (Claim::Asking(_), false) if is_online => {
                self.claim = Claim::Theirs(Instant::now(), text("session").into())
            }
            (Claim::Theirs(..), _) if !is_online => self.claim = Claim::Asking(Instant::now()),
            // Before ours; one that comes after ours sees that.
            (Claim::Sent, false) if is_online => {
                return Err(Stopped(format!("another supervisor, {}, was first", text("session"))));
            }
            (Claim::Seen(_), false) if is_online && insists => {
                return Err(Stopped(format!("another supervisor, {}, is at work", text("session"))));
            }
            // Two that were both sure that it is theirs: one of them ends.
            (Claim::Ours, false) if is_online && insists && text("session") < self.session.as_str() => {
                return Err(Stopped(format!("another supervisor, {}, is at work", text("session"))));
            }
            (Claim::Seen(_) | Claim::Ours, false) => {
                self.log.push(format!("another supervisor, {}, comes or goes", text("session")));
                let _ = self.link.publish(claim(&self.key, &self.topic, &self.session, "ONLINE", true));
            }
            _ => {}
        }
        Ok(())
    }

    /// Says that it supervises, if nobody else does.
    fn ask(&mut self) -> Result<(), Stopped> {
        /// Retained messages come at once after subscribing.
        const RETAINED: Duration = Duration::from_millis(200);
        if let Claim::Theirs(since, session) = &self.claim
            && since.elapsed() > PATIENCE
        {
            return Err(Stopped(format!("another supervisor, {session}, is at work")));
        }
        if let Claim::Seen(since) = self.claim
            && since.elapsed() > OBJECTIONS
        {
            self.claim = Claim::Ours;
            self.greets = true;
        }
        if let Claim::Asking(since) = self.claim
            && self.link.is_up()
            && since.elapsed() >= RETAINED
            && self.link.publish(claim(&self.key, &self.topic, &self.session, "ONLINE", false))
        {
            self.claim = Claim::Sent;
        }
        Ok(())
    }

    /// Ends in order: another one may supervise at once.
    pub fn close(self) {
        if self.is_ours() {
            let _ = self.link.publish(claim(&self.key, &self.topic, &self.session, "OFFLINE", false));
        }
        self.link.close();
    }
}

fn claim(key: &Key, topic: &str, session: &str, state: &str, insists: bool) -> Publish {
    let header = Header::new(key, Version::V2_1, 1, stamp::now());
    let rest = [("session".to_owned(), Value::from(session)), ("insists".to_owned(), insists.into())];
    let rest = Map::from_iter(rest);
    let message = Connection { header, connection_state: state.into(), rest };
    let payload = serde_json::to_vec(&message).unwrap_or_default();
    Publish { topic: topic.into(), payload, assured: true, retain: true }
}

/// What is to be sent, once all of it is in the journal: for these messages, and for what the supervisor has told since.
fn answered(
    supervisor: &mut Supervisor,
    bridge: &mut Bridge,
    messages: &[Heard],
    [greets, works]: [bool; 2],
    told: &[Event],
    now: f64,
) -> Vec<Publish> {
    if greets {
        bridge.greet();
    }
    for Heard { topic, payload, kept } in messages {
        match kept {
            true => bridge.receive_kept(supervisor, topic, payload, now),
            false => bridge.receive(supervisor, topic, payload, now),
        }
    }
    if !works {
        bridge.told(told);
        return Vec::new();
    }
    supervisor.decide(now);
    bridge.settled(supervisor, told, now);
    bridge.out()
}

/// The bridge; a thread that has panicked has left it as it was between two messages at worst.
fn locked(bridge: &Mutex<Bridge>) -> MutexGuard<'_, Bridge> {
    bridge.lock().unwrap_or_else(PoisonError::into_inner)
}
