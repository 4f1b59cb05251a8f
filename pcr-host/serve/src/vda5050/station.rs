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

/// Time to wait for the last will of a bridge that may be gone: a little longer than the broker waits.
const PATIENCE: Duration = Duration::from_secs(9);

/// Time to wait for objections of another bridge.
const OBJECTIONS: Duration = Duration::from_secs(1);

/// Largest number of messages that are handled together.
const MOST: usize = 1_000;

/// Longest time between two looks at waiting messages.
const TICK: Duration = Duration::from_millis(100);

/// The claim to be the active bridge.
#[derive(Clone, Debug, PartialEq)]
enum Claim {
    /// Not known yet; since when.
    Asking(Instant),
    /// Another bridge, of this session, has a claim but may be gone; since when.
    Theirs(Instant, String),
    /// Our claim was sent.
    Sent,
    /// The broker has returned our claim; since when no other bridge has objected.
    Seen(Instant),
    /// This bridge is active.
    Ours,
}

/// A message from the broker.
struct Heard {
    topic: String,
    payload: Vec<u8>,
    /// Whether it is a retained message.
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
    /// Whether the vehicles have to be asked for their states and factsheets.
    greets: bool,
    log: Vec<String>,
}

/// The reason why a station stops.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Stopped(pub String);

impl Station {
    /// Connects to a broker; `session` is a text that no other supervisor uses.
    ///
    /// # Errors
    /// The invalid setting.
    pub fn open(broker: &Broker, vehicles: &Interface, bridge: &Bridge, session: &str) -> Result<Self, String> {
        let key = Key::new("pcr", "supervisor")?;
        let topic = vehicles.topic(Version::V2_1, &key, Kind::Connection);
        let mut filters = bridge.filters();
        filters.push(topic.clone());
        let will = claim(&key, &topic, session, Version::V2_1.broken(), false);
        let (sender, news) = channel();
        let link = Link::open(broker, &format!("pcr-supervisor-{session}"), Some(will), filters, move |it| {
            // A station that has been dropped needs no news.
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

    /// Whether this bridge is active.
    pub fn is_ours(&self) -> bool {
        self.claim == Claim::Ours
    }

    /// Waits for messages and handles them. Returns the events of the supervisor.
    ///
    /// # Errors
    /// [`Stopped`]: another bridge is active, or the journal is broken.
    pub fn turn(&mut self, supervisor: &mut Supervisor, bridge: &mut Bridge) -> Result<Vec<Event>, Stopped> {
        let messages = self.messages()?;
        let (now, works) = (self.now(), self.works());
        let greets = std::mem::take(&mut self.greets);
        let out = answered(supervisor, bridge, &messages, [greets, works], &[], now);
        let events = supervisor.settle(now).map_err(|fault: Fault| Stopped(fault.to_string()))?;
        // The notes of lanes are in the journal before messages are sent.
        for message in out {
            // An unsent message is sent again later.
            let _ = self.link.publish(message);
        }
        bridge.told(&events);
        // Here the log is not read.
        self.log.clear();
        Ok(events)
    }

    /// The same for a supervisor that another thread owns, and whose events come by a queue. Returns messages for the log:
    /// refused messages, missing vehicles, problems with the broker.
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
            // An unsent message is sent again later.
            let send = move || out.into_iter().for_each(|message| _ = mouth.publish(message));
            ((), Some(Box::new(send) as Then))
        };
        handle.ask_then(answer).ok_or_else(|| Stopped("the supervisor has ended".into()))?;
        let mut log = std::mem::take(&mut self.log);
        log.extend(locked(bridge).log());
        Ok(log)
    }

    /// Whether messages may be sent to vehicles now.
    fn works(&self) -> bool {
        self.is_ours() && self.link.is_up()
    }

    /// Messages that have come; waits a little if there are none. Messages that come while these are handled form the next
    /// group.
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

    /// Handles the claim of a bridge, or its end.
    fn heard(&mut self, payload: &[u8]) -> Result<(), Stopped> {
        let said: Value = serde_json::from_slice(payload).unwrap_or_default();
        let text = |field: &str| said.get(field).and_then(Value::as_str).unwrap_or_default();
        let is_online = text("connectionState") == "ONLINE";
        let insists = said.get("insists") == Some(&Value::Bool(true));
        match (&self.claim, text("session") == self.session) {
            (Claim::Sent, true) if is_online => self.claim = Claim::Seen(Instant::now()),
            // That bridge may be gone: the broker will tell.
            (Claim::Asking(_), false) if is_online => {
                self.claim = Claim::Theirs(Instant::now(), text("session").into())
            }
            (Claim::Theirs(..), _) if !is_online => self.claim = Claim::Asking(Instant::now()),
            // It claimed before us; a bridge that claims after us sees our claim.
            (Claim::Sent, false) if is_online => {
                return Err(Stopped(format!("another supervisor, {}, was first", text("session"))));
            }
            (Claim::Seen(_), false) if is_online && insists => {
                return Err(Stopped(format!("another supervisor, {}, is at work", text("session"))));
            }
            // Both bridges believed to be active: the one with the larger session ends.
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

    /// Sends our claim, if there is no other one.
    fn ask(&mut self) -> Result<(), Stopped> {
        /// Retained messages come immediately after subscribing.
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

    /// Ends properly: another bridge may become active at once.
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

/// Takes the messages to be sent once all of it is in the journal: those that follow from these messages and from the events
/// since.
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

/// Locks the bridge. A thread that panicked leaves it at worst between two messages.
fn locked(bridge: &Mutex<Bridge>) -> MutexGuard<'_, Bridge> {
    bridge.lock().unwrap_or_else(PoisonError::into_inner)
}
