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

/// What a message says about the claim of a bridge.
#[derive(Clone, Debug, PartialEq)]
enum Said {
    /// The retained message was removed.
    Nothing,
    /// A bridge has a claim.
    Online {
        session: String,
        /// It objects to other claims.
        insists: bool,
    },
    /// A bridge has ended.
    Offline { session: String },
}

impl Said {
    /// # Errors
    /// Why the message cannot be read. It says nothing then about whether another bridge is active.
    fn read(payload: &[u8]) -> Result<Self, String> {
        if payload.is_empty() {
            return Ok(Self::Nothing);
        }
        let message: Connection = serde_json::from_slice(payload).map_err(|error| error.to_string())?;
        let session = message.rest.get("session").and_then(Value::as_str).ok_or("session: missing")?.to_owned();
        let insists = message.rest.get("insists") == Some(&Value::Bool(true));
        match message.connection_state.as_str() {
            "ONLINE" => Ok(Self::Online { session, insists }),
            "OFFLINE" => Ok(Self::Offline { session }),
            broken if Version::ALL.iter().any(|version| version.broken() == broken) => Ok(Self::Offline { session }),
            other => Err(format!("connectionState: {other:?}")),
        }
    }
}

impl Claim {
    /// Takes what the broker says of claims. Returns a line for the log if our claim has to be sent again.
    ///
    /// # Errors
    /// [`Stopped`] if another bridge is active, or may be.
    fn heard(&mut self, said: Result<Said, String>, own: &str) -> Result<Option<String>, Stopped> {
        let said = match (said, &self) {
            (Ok(said), _) => said,
            (Err(why), Self::Ours) => return Ok(Some(format!("a claim that cannot be read: {why}"))),
            (Err(why), _) => {
                let why = format!("a claim cannot be read ({why}), so another supervisor may be at work");
                return Err(Stopped(why));
            }
        };
        let is_own = match &said {
            Said::Nothing => false,
            Said::Online { session, .. } | Said::Offline { session } => session == own,
        };
        match (&self, said) {
            (Self::Sent, Said::Online { .. }) if is_own => *self = Self::Seen(Instant::now()),
            // That bridge may be gone: the broker will tell.
            (Self::Asking(_), Said::Online { session, .. }) if !is_own => *self = Self::Theirs(Instant::now(), session),
            (Self::Theirs(..), Said::Nothing | Said::Offline { .. }) => *self = Self::Asking(Instant::now()),
            _ if is_own => {}
            // It claimed before us; a bridge that claims after us sees our claim.
            (Self::Sent, Said::Online { session, .. }) => {
                return Err(Stopped(format!("another supervisor, {session}, was first")));
            }
            // If both believed to be active, the one with the larger session ends.
            (Self::Seen(_) | Self::Ours, Said::Online { session, insists: true })
                if *self != Self::Ours || session.as_str() < own =>
            {
                return Err(Stopped(format!("another supervisor, {session}, is at work")));
            }
            (Self::Seen(_) | Self::Ours, Said::Online { session, .. } | Said::Offline { session }) => {
                return Ok(Some(format!("another supervisor, {session}, comes or goes")));
            }
            (Self::Seen(_) | Self::Ours, Said::Nothing) => return Ok(Some("our claim was removed".into())),
            _ => {}
        }
        Ok(None)
    }
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
        if let Some(line) = self.claim.heard(Said::read(payload), &self.session)? {
            self.log.push(line);
            let _ = self.link.publish(claim(&self.key, &self.topic, &self.session, "ONLINE", true));
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
    // An empty message would withdraw the claim.
    let payload = serde_json::to_vec(&message).expect("texts and numbers can always be written");
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
        bridge.greet(now);
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

#[cfg(test)]
mod tests {
    use super::*;

    fn message(session: &str, state: &str, insists: bool) -> Vec<u8> {
        claim(&Key::new("pcr", "supervisor").unwrap(), "t", session, state, insists).payload
    }

    /// What could not be read counted as the word of a supervisor that had ended.
    #[test]
    fn a_claim_that_cannot_be_read_is_no_permission() {
        let now = Instant::now();
        let damaged = [&b"{"[..], b"null", b"{}", br#"{"connectionState":"ONLINE"}"#, &message("a", "online", false)];
        for payload in damaged {
            for mut claim in [Claim::Asking(now), Claim::Theirs(now, "a".into()), Claim::Sent, Claim::Seen(now)] {
                let before = claim.clone();
                let stopped = claim.heard(Said::read(payload), "b").unwrap_err();
                assert!(stopped.0.contains("cannot be read"), "{stopped:?}");
                assert_eq!(claim, before);
            }
            let mut ours = Claim::Ours;
            assert!(ours.heard(Said::read(payload), "b").unwrap().is_some_and(|line| line.contains("cannot be read")));
            assert_eq!(ours, Claim::Ours);
        }
    }

    #[test]
    fn who_has_the_claim() {
        let now = Instant::now();
        let heard = |claim: &Claim, payload: &[u8]| {
            let mut claim = claim.clone();
            claim.heard(Said::read(payload), "b").map(|line| (claim, line.is_some()))
        };
        let stays = |claim: &Claim, again: bool| Ok((claim.clone(), again));
        let theirs = Claim::Theirs(now, "a".into());
        for over in [vec![], message("a", "OFFLINE", false), message("a", "CONNECTIONBROKEN", false)] {
            assert!(matches!(heard(&theirs, &over), Ok((Claim::Asking(_), false))));
            assert_eq!(heard(&Claim::Asking(now), &over), stays(&Claim::Asking(now), false));
            assert_eq!(heard(&Claim::Sent, &over), stays(&Claim::Sent, false));
            assert_eq!(heard(&Claim::Ours, &over), stays(&Claim::Ours, true));
        }
        let online = |session, insists| message(session, "ONLINE", insists);
        assert!(matches!(heard(&Claim::Asking(now), &online("a", false)), Ok((Claim::Theirs(..), false))));
        assert!(matches!(heard(&Claim::Sent, &online("b", false)), Ok((Claim::Seen(_), false))));
        assert!(heard(&Claim::Sent, &online("a", false)).is_err());
        assert!(heard(&Claim::Seen(now), &online("c", true)).is_err());
        assert_eq!(heard(&Claim::Seen(now), &online("c", false)), stays(&Claim::Seen(now), true));
        assert!(heard(&Claim::Ours, &online("a", true)).is_err());
        assert_eq!(heard(&Claim::Ours, &online("c", true)), stays(&Claim::Ours, true));
        assert_eq!(heard(&Claim::Ours, &online("b", true)), stays(&Claim::Ours, false));
    }
}
