//! The bridge at its broker; only one bridge is active at a time.
//!
//! The active bridge says so in a retained message, which its last will takes back. A second bridge sees the message
//! and stays passive. If two begin at the same time, the one whose message the broker receives first continues. The
//! retained message may be missing, or be that of another bridge, although a bridge is active. Therefore the active
//! bridge then repeats its message, and a claim counts only if no other bridge has objected for a while.

use super::bridge::{PendingPublish, Vda5050Bridge};
use super::inbox::{DroppedCounters, InboxReceiver, inbox};
use super::leader_election::{LeaderState, claim};
use super::mqtt::{BrokerAddress, LinkEvent, MqttLink, Publisher};
use super::vehicle_adapter::SendCondition;
use crate::bridge_status::BridgeStatus;
use crate::event::SupervisorEvent;
use crate::server::{AfterCommit, ServerHandle};
use crate::setup_error::SetupError;
use crate::supervisor::Supervisor;
use crate::telemetry::Telemetry;
use pcr_formats::vda5050::topics::{TopicInterface, TopicKind, VehicleId};
use pcr_formats::vda5050::version::ProtocolVersion;
use std::fmt;
use std::sync::mpsc::{Receiver, RecvTimeoutError, TryRecvError};
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

/// A message from the broker.
struct ReceivedMessage {
    topic: String,
    payload: Vec<u8>,
    /// Whether it is a retained message.
    retained: bool,
    /// When it came.
    received_at: Instant,
}

/// A bridge at its broker.
#[derive(Debug)]
pub struct BrokerSession {
    link: MqttLink,
    news: InboxReceiver,
    session: String,
    topic: String,
    claim: LeaderState,
    key: VehicleId,
    /// Whether the vehicles have to be asked for their states and factsheets.
    greets: bool,
    /// Why it is not connected, as was told last.
    down: String,
    log: Vec<String>,
}

/// The reason why a station stops.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SessionEnd {
    /// Another supervisor is at work, or may be.
    Rival(String),
    /// The supervisor that it works for has ended.
    Ended,
    /// Events of the supervisor were lost: too many waited.
    Deaf,
    /// The thread of the connection has ended.
    Cut,
}

impl fmt::Display for SessionEnd {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Rival(why) => f.write_str(why),
            Self::Ended => f.write_str("the supervisor has ended"),
            Self::Deaf => f.write_str("events of the supervisor were lost, because too many waited"),
            Self::Cut => f.write_str("the connection to the broker has ended"),
        }
    }
}

impl std::error::Error for SessionEnd {}

impl BrokerSession {
    /// Connects to a broker; `session` is a text that no other supervisor uses.
    ///
    /// # Errors
    /// The invalid setting.
    pub fn open(
        broker: &BrokerAddress,
        vehicles: &TopicInterface,
        bridge: &Vda5050Bridge,
        session: &str,
    ) -> Result<Self, SetupError> {
        let key = VehicleId::new("pcr", "supervisor").map_err(SetupError::Topic)?;
        let topic = vehicles.topic(ProtocolVersion::V2_1, &key, TopicKind::Connection);
        let mut filters = bridge.filters();
        filters.push(topic.clone());
        let will = claim(&key, &topic, session, ProtocolVersion::V2_1.broken(), false);
        let (feeder, news) = inbox();
        let name = format!("pcr-supervisor-{session}");
        let link = MqttLink::open(broker, &name, Some(will), filters, move |it| feeder.put(it))?;
        let now = Instant::now();
        let (session, claim) = (session.into(), LeaderState::Asking(now));
        Ok(Self {
            link,
            news,
            session,
            topic,
            claim,
            key,
            greets: false,
            down: "it has not been reached yet".into(),
            log: Vec::new(),
        })
    }

    /// Whether this bridge is active.
    pub fn is_ours(&self) -> bool {
        self.claim == LeaderState::Ours
    }

    /// Returns why no vehicle is released anything, if so: because of the connection, or else of the bridge.
    pub fn unready(&self, bridge: &Vda5050Bridge) -> Option<String> {
        if !self.link.is_up() {
            return Some(format!("no broker: {}", self.down));
        }
        match &self.claim {
            LeaderState::Ours => bridge.unready(),
            LeaderState::Theirs(_, session) => Some(format!("another supervisor, {session}, may be at work")),
            LeaderState::Asking(_) | LeaderState::Sent | LeaderState::Seen(_) => {
                Some("it is being asked whether another supervisor is at work at the broker".into())
            }
        }
    }

    /// Returns what the metrics say of the connection and of the bridge.
    pub fn status(&self, bridge: &Vda5050Bridge) -> BridgeStatus {
        BridgeStatus { connected: self.link.is_up(), active: self.works(), counts: bridge.counts() }
    }

    /// Waits for messages and handles them. Another thread owns the supervisor, whose events come by a queue. Returns messages for the log:
    /// refused messages, missing vehicles, problems with the broker.
    ///
    /// # Errors
    /// [`SessionEnd`].
    pub fn turn(
        &mut self,
        handle: &ServerHandle,
        bridge: &Arc<Mutex<Vda5050Bridge>>,
        events: &Receiver<SupervisorEvent>,
    ) -> Result<Vec<String>, SessionEnd> {
        let messages = self.messages()?;
        let (own, flags) = (bridge.clone(), [std::mem::take(&mut self.greets), self.works()]);
        let (told, is_deaf) = drained(events);
        let mouth = self.link.mouth();
        let answer = move |supervisor: &mut Supervisor, board: &Telemetry, now: f64| {
            let messages = timed(&messages, board, now);
            let out = answered(supervisor, &mut locked(&own), &messages, flags, &told, now);
            let times = messages.iter().map(|(message, _)| message.received_at).collect();
            ((), Some(sent(out, own, mouth).for_messages(times)))
        };
        handle.ask_then(answer).ok_or(SessionEnd::Ended)?;
        if is_deaf {
            return Err(SessionEnd::Deaf);
        }
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
    fn messages(&mut self) -> Result<Vec<ReceivedMessage>, SessionEnd> {
        let (mut messages, mut patience) = (Vec::new(), TICK);
        while messages.len() < MOST {
            match self.news.next(patience) {
                Ok(LinkEvent::Up) => self.claim = LeaderState::Asking(Instant::now()),
                Ok(LinkEvent::Down(why)) => {
                    self.log.push(format!("no broker: {why}"));
                    self.down = why;
                }
                Ok(LinkEvent::Message { topic, payload, .. }) if topic == self.topic => self.heard(&payload)?,
                Ok(LinkEvent::Message { topic, payload, kept, came }) => {
                    messages.push(ReceivedMessage { topic, payload, retained: kept, received_at: came });
                }
                Err(RecvTimeoutError::Timeout) => break,
                Err(RecvTimeoutError::Disconnected) => return Err(SessionEnd::Cut),
            }
            patience = Duration::ZERO;
        }
        let DroppedCounters { old, dropped } = self.news.lost();
        if old > 0 {
            self.log.push(format!("messages come faster than they are read: {old} positions gave way to newer ones"));
        }
        if dropped > 0 {
            self.log.push(format!("messages come faster than they are read: {dropped} were dropped"));
        }
        self.ask()?;
        Ok(messages)
    }

    /// Handles the claim of a bridge, or its end.
    fn heard(&mut self, payload: &[u8]) -> Result<(), SessionEnd> {
        if let Some(line) = self.claim.heard(payload, &self.session).map_err(SessionEnd::Rival)? {
            self.log.push(line);
            let _ = self.link.publish(claim(&self.key, &self.topic, &self.session, "ONLINE", true));
        }
        Ok(())
    }

    /// Sends our claim, if there is no other one.
    fn ask(&mut self) -> Result<(), SessionEnd> {
        /// Retained messages come immediately after subscribing.
        const RETAINED: Duration = Duration::from_millis(200);
        if let LeaderState::Theirs(since, session) = &self.claim
            && since.elapsed() > PATIENCE
        {
            return Err(SessionEnd::Rival(format!("another supervisor, {session}, is at work")));
        }
        if let LeaderState::Seen(since) = self.claim
            && since.elapsed() > OBJECTIONS
        {
            self.claim = LeaderState::Ours;
            self.greets = true;
        }
        if let LeaderState::Asking(since) = self.claim
            && self.link.is_up()
            && since.elapsed() >= RETAINED
            && self.link.publish(claim(&self.key, &self.topic, &self.session, "ONLINE", false))
        {
            self.claim = LeaderState::Sent;
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

/// Messages with the times at which they came \[s\].
fn timed<'a>(messages: &'a [ReceivedMessage], board: &Telemetry, now: f64) -> Vec<(&'a ReceivedMessage, f64)> {
    messages.iter().map(|heard| (heard, board.time(heard.received_at).min(now))).collect()
}

/// Takes the messages to be sent: those that follow from these messages, each with the time at which it came, and from the events since. (A
/// message that has waited is about where a vehicle was then; by now it may be elsewhere.)
fn answered(
    supervisor: &mut Supervisor,
    bridge: &mut Vda5050Bridge,
    messages: &[(&ReceivedMessage, f64)],
    [greets, works]: [bool; 2],
    told: &[SupervisorEvent],
    now: f64,
) -> Vec<PendingPublish> {
    if greets {
        bridge.greet(now);
    }
    for &(ReceivedMessage { topic, payload, retained: kept, .. }, came) in messages {
        match kept {
            true => bridge.receive_kept(supervisor, topic, payload, came),
            false => bridge.receive_late(supervisor, topic, payload, [came, now]),
        }
    }
    if !works {
        bridge.on_events(told);
        bridge.prepare(supervisor);
        return Vec::new();
    }
    supervisor.decide(now);
    bridge.settled(supervisor, told, now);
    bridge.due()
}

/// The events that have come, and whether none will come any more.
fn drained(events: &Receiver<SupervisorEvent>) -> (Vec<SupervisorEvent>, bool) {
    let mut told = Vec::new();
    loop {
        match events.try_recv() {
            Ok(event) => told.push(event),
            Err(TryRecvError::Empty) => return (told, false),
            Err(TryRecvError::Disconnected) => return (told, true),
        }
    }
}

/// Sends what may be sent at once; the rest is sent by the action for when all of it is in the journal. An unsent message is sent again
/// later.
fn sent(out: Vec<PendingPublish>, bridge: Arc<Mutex<Vda5050Bridge>>, mouth: Publisher) -> AfterCommit {
    let (now, later): (Vec<PendingPublish>, Vec<PendingPublish>) =
        out.into_iter().partition(|out| out.due == SendCondition::AtOnce);
    now.into_iter().for_each(|out| _ = mouth.publish(out.message));
    let bytes = later.iter().map(|out| out.message.payload.len()).sum();
    let send = move || {
        let mut bridge = locked(&bridge);
        later.into_iter().filter(|out| !bridge.withholds(out)).for_each(|out| _ = mouth.publish(out.message));
    };
    AfterCommit::new(bytes, send)
}

/// Locks the bridge. A thread that panicked leaves it at worst between two messages.
fn locked(bridge: &Mutex<Vda5050Bridge>) -> MutexGuard<'_, Vda5050Bridge> {
    bridge.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::Value;

    /// Messages that had waited counted as of the time at which they were read: where a vehicle could be by then was too small, and silence
    /// was told late.
    #[test]
    fn a_message_is_as_old_as_it_has_waited() {
        let [manager, vehicles] = ["fleet", "uagv"].map(|prefix| TopicInterface::new(prefix).unwrap());
        let key = VehicleId::new("m", "1").unwrap();
        let topic = vehicles.topic(ProtocolVersion::V2_1, &key, TopicKind::State);
        let mut supervisor = Supervisor::new(Default::default(), Box::new(crate::journal_entry::NullStore));
        let abilities =
            crate::robot::RobotTraits { radius: 0.4, footprint: None, margin: 0.1, speed: 1.0, acceleration: 0.5 };
        let settings = super::super::bridge::BridgeConfig { manager, vehicles, limits: Default::default() };
        let profile = super::super::vehicle_adapter::VehicleConfig {
            key,
            abilities,
            split: true,
            away: None,
            places: Vec::new(),
        };
        let mut bridge = Vda5050Bridge::new(settings, vec![profile], &supervisor).unwrap();
        let begin = Instant::now();
        let board = Telemetry::new(begin);
        let heard = |number: u64, actions: &Value| {
            let state = serde_json::json!({ "headerId": number, "timestamp": format!("2030-01-01T00:00:0{number}Z"),
                "version": "2.1.0", "manufacturer": "m", "serialNumber": "1", "orderId": "", "orderUpdateId": 0,
                "lastNodeId": "", "lastNodeSequenceId": 0, "nodeStates": [], "edgeStates": [], "driving": false,
                "actionStates": actions, "errors": [], "operatingMode": "AUTOMATIC",
                "agvPosition": { "x": 0.0, "y": 0.0, "theta": 0.0, "mapId": "map", "positionInitialized": true } });
            let came = begin + Duration::from_secs(number);
            ReceivedMessage {
                topic: topic.clone(),
                payload: state.to_string().into_bytes(),
                retained: false,
                received_at: came,
            }
        };
        let first = [heard(1, &serde_json::json!([]))];
        let out = answered(&mut supervisor, &mut bridge, &timed(&first, &board, 1.5), [true, true], &[], 1.5);
        // It answers the request for a state, so its states are certainly new.
        let said =
            |out: &PendingPublish| serde_json::from_slice::<Value>(&out.message.payload).unwrap()["actions"][0].clone();
        let asked = out.iter().map(said).find(|action| action["actionType"] == "stateRequest").unwrap();
        let actions = serde_json::json!([{ "actionId": asked["actionId"], "actionStatus": "FINISHED" }]);
        let later = [2, 3].map(|number| heard(number, &actions));
        assert_eq!(board.time(begin - Duration::from_secs(1)), 0.0);
        answered(&mut supervisor, &mut bridge, &timed(&later, &board, 9.0), [false, true], &[], 9.0);
        let robot = supervisor.robot("m/1").unwrap();
        assert_eq!((robot.alive, robot.heard), (Some(3.0), Some(3.0)));
        let events = supervisor.settle(9.0).unwrap();
        assert!(matches!(events[..], [SupervisorEvent::Silent { since: 6.0, .. }]), "{events:?}");
    }

    #[test]
    fn lost_events_are_noticed() {
        let (sender, events) = std::sync::mpsc::sync_channel(9);
        let go = || SupervisorEvent::Go { robot: "a".into() };
        sender.send(go()).unwrap();
        assert_eq!(drained(&events), (vec![go()], false));
        sender.send(go()).unwrap();
        drop(sender);
        assert_eq!(drained(&events), (vec![go()], true));
    }
}
