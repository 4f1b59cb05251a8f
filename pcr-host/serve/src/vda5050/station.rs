//! The bridge at its broker: one at a time.
//!
//! Whoever supervises says so in a retained message that its last will takes back. A second one sees it and does nothing. Of two that
//! begin at once, the one whose message the broker takes first goes on.

use super::bridge::{Bridge, Publish};
use super::header::Header;
use super::messages::Connection;
use super::mqtt::{Broker, Link, News};
use super::stamp;
use super::topics::{Interface, Key, Kind};
use super::version::Version;
use crate::event::Event;
use crate::fault::Fault;
use crate::server::{Handle, Input};
use crate::supervisor::Supervisor;
use serde_json::{Map, Value};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// How long it is waited for the last will of one that may be gone: a little more than the broker does.
const PATIENCE: Duration = Duration::from_secs(9);

/// How long messages are collected before they are answered together, at most.
const GATHER: Duration = Duration::from_micros(500);

/// So many of them at most.
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
    /// Ours.
    Ours,
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
        let will = claim(&key, &topic, session, Version::V2_1.broken());
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
        let now = self.now();
        self.take(supervisor, bridge, &messages, now);
        let broken = |fault: Fault| Stopped(fault.to_string());
        let mut events = supervisor.settle(now).map_err(broken)?;
        if self.works() {
            bridge.settled(supervisor, &events, now);
            // What lanes have to remember is in the journal before anybody is told.
            let more = supervisor.settle(now).map_err(broken)?;
            bridge.told(&more);
            events.extend(more);
            self.send(bridge);
        } else {
            bridge.told(&events);
        }
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
        let (own, greets) = (bridge.clone(), std::mem::take(&mut self.greets));
        let ended = || Stopped("the supervisor has ended".into());
        let taken = handle.ask(move |supervisor, _, now| {
            let mut bridge = locked(&own);
            if greets {
                bridge.greet();
            }
            for (topic, payload) in &messages {
                bridge.receive(supervisor, topic, payload, now);
            }
        });
        taken.ok_or_else(ended)?;
        // The next question is taken after what came before it is settled.
        let (own, works) = (bridge.clone(), self.works());
        let told: Vec<Event> = events.try_iter().collect();
        let released = handle.ask(move |supervisor, _, now| {
            let mut bridge = locked(&own);
            if works {
                bridge.settled(supervisor, &told, now);
                bridge.out()
            } else {
                bridge.told(&told);
                Vec::new()
            }
        });
        let (messages, mouth) = (released.ok_or_else(ended)?, self.link.mouth());
        if !messages.is_empty() {
            // What is not sent then is sent again.
            let send = move || messages.into_iter().for_each(|message| _ = mouth.publish(message));
            handle.send(Input::Then(Box::new(send)));
        }
        let mut log = std::mem::take(&mut self.log);
        log.extend(locked(bridge).log());
        Ok(log)
    }

    /// Whether vehicles may be told something now.
    fn works(&self) -> bool {
        self.is_ours() && self.link.is_up()
    }

    fn send(&self, bridge: &mut Bridge) {
        for message in bridge.out() {
            // What is not sent now is sent again.
            let _ = self.link.publish(message);
        }
    }

    fn take(&mut self, supervisor: &mut Supervisor, bridge: &mut Bridge, messages: &[(String, Vec<u8>)], now: f64) {
        if std::mem::take(&mut self.greets) {
            bridge.greet();
        }
        for (topic, payload) in messages {
            bridge.receive(supervisor, topic, payload, now);
        }
    }

    /// What has come, after waiting for a little while.
    fn messages(&mut self) -> Result<Vec<(String, Vec<u8>)>, Stopped> {
        let mut messages = Vec::new();
        let mut first = self.news.recv_timeout(TICK);
        let until = Instant::now() + GATHER;
        while let Ok(news) = first {
            match news {
                News::Up => self.claim = Claim::Asking(Instant::now()),
                News::Down(why) => self.log.push(format!("no broker: {why}")),
                News::Message { topic, payload } if topic == self.topic => self.heard(&payload)?,
                News::Message { topic, payload } => messages.push((topic, payload)),
            }
            // What is there already is taken however late it is: on a busy machine it would become more and more.
            first = match messages.len() < MOST {
                true => self.news.recv_timeout(until.saturating_duration_since(Instant::now())),
                false => Err(RecvTimeoutError::Timeout),
            };
        }
        if first == Err(RecvTimeoutError::Disconnected) {
            return Err(Stopped("the connection has ended".into()));
        }
        self.ask()?;
        Ok(messages)
    }

    /// Somebody supervises, or does no longer.
    fn heard(&mut self, payload: &[u8]) -> Result<(), Stopped> {
        let said: Value = serde_json::from_slice(payload).unwrap_or_default();
        let text = |field: &str| said.get(field).and_then(Value::as_str).unwrap_or_default();
        let is_online = text("connectionState") == "ONLINE";
        match (&self.claim, text("session") == self.session) {
            (Claim::Sent, true) if is_online => {
                self.claim = Claim::Ours;
                self.greets = true;
            }
            // It may be gone: the broker will say so.
            (Claim::Asking(_), false) if is_online => {
                self.claim = Claim::Theirs(Instant::now(), text("session").into())
            }
            (Claim::Theirs(..), _) if !is_online => self.claim = Claim::Asking(Instant::now()),
            (Claim::Sent, false) if is_online => {
                return Err(Stopped(format!("another supervisor, {}, was first", text("session"))));
            }
            // Whoever comes later than we sees ours.
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
        if let Claim::Asking(since) = self.claim
            && self.link.is_up()
            && since.elapsed() >= RETAINED
            && self.link.publish(claim(&self.key, &self.topic, &self.session, "ONLINE"))
        {
            self.claim = Claim::Sent;
        }
        Ok(())
    }

    /// Ends in order: another one may supervise at once.
    pub fn close(self) {
        if self.is_ours() {
            let _ = self.link.publish(claim(&self.key, &self.topic, &self.session, "OFFLINE"));
        }
        self.link.close();
    }
}

fn claim(key: &Key, topic: &str, session: &str, state: &str) -> Publish {
    let header = Header::new(key, Version::V2_1, 1, stamp::now());
    let rest = Map::from_iter([("session".to_owned(), Value::from(session))]);
    let message = Connection { header, connection_state: state.into(), rest };
    let payload = serde_json::to_vec(&message).unwrap_or_default();
    Publish { topic: topic.into(), payload, assured: true, retain: true }
}

/// The bridge; a thread that has panicked has left it as it was between two messages at worst.
fn locked(bridge: &Mutex<Bridge>) -> MutexGuard<'_, Bridge> {
    bridge.lock().unwrap_or_else(PoisonError::into_inner)
}
