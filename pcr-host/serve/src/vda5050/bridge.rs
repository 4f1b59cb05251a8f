//! Connects all vehicles of a fleet with their manager and the supervisor. It only converts messages, and does no input
//! or output itself.

use super::vehicle_adapter::{NoticeKind, OutboundMessage, Recipient, SendCondition, VehicleAdapter, VehicleConfig};
use crate::bridge_status::BridgeCounters;
use crate::event::SupervisorEvent;
use crate::robot::SupervisedRobot;
use crate::supervisor::{JournalError, Supervisor, UnplacedVehicle};
use pcr_formats::vda5050::decode::MessageLimits;
use pcr_formats::vda5050::topics::{TopicInterface, TopicKind, VehicleId};
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// Settings of a bridge.
#[derive(Clone, Debug)]
pub struct BridgeConfig {
    /// Topics of the fleet manager.
    pub manager: TopicInterface,
    /// Topics of the vehicles.
    pub vehicles: TopicInterface,
    /// Limits of the messages that are read.
    pub limits: MessageLimits,
}

/// A message to the broker.
#[derive(Clone, Debug, PartialEq)]
pub struct MqttMessage {
    /// Topic.
    pub topic: String,
    /// Content, as JSON.
    pub payload: Vec<u8>,
    /// Whether it is sent with quality of service 1.
    pub at_least_once: bool,
    /// Whether the broker keeps it.
    pub retain: bool,
}

/// A message to the broker, and when it may be sent.
#[derive(Clone, Debug, PartialEq)]
pub struct PendingPublish {
    /// The message.
    pub message: MqttMessage,
    /// When it may be sent.
    pub due: SendCondition,
    /// The vehicle that it is to or about.
    vehicle: VehicleId,
}

/// The state of a robot on which the messages to its vehicle depend: number of its path, hold, whether it is stopped.
type RobotAuthority = (u64, f64, bool);

/// The state of the supervisor when it was last compared.
#[derive(Debug, Default)]
struct SupervisorSnapshot {
    fleet_revision: Option<u64>,
    /// For each robot its lane and its rights.
    authorities: Vec<(Option<usize>, RobotAuthority)>,
    /// Lanes whose vehicles are not in the supervisor yet.
    unknown: Vec<usize>,
}

/// The fleet.
#[derive(Debug)]
pub struct Vda5050Bridge {
    settings: BridgeConfig,
    lanes: Vec<VehicleAdapter>,
    places: HashMap<VehicleId, usize>,
    /// Lanes for which something has come since they were last handled.
    touched: BTreeSet<usize>,
    seen: SupervisorSnapshot,
    out: Vec<PendingPublish>,
    /// Lanes whose last message to the manager was too large.
    large: BTreeSet<usize>,
    counts: BridgeCounters,
    log: Vec<String>,
    /// Time of the last reminder of missing vehicles \[s\].
    said: f64,
    /// Time at which all lanes were last handled \[s\].
    looked: f64,
    /// Why no vehicle is released anything.
    unready: Option<String>,
    /// Names of the vehicles that others wait for, with the time since which they do \[s\].
    unplaced: BTreeMap<String, f64>,
    /// What the manager was told of them, and the lanes that have to tell it.
    notices: Vec<(NoticeKind, [String; 2])>,
    noticed: BTreeSet<usize>,
    /// When that was last other than before \[s\].
    noticed_at: f64,
    /// Which vehicles are away, or not, by their configuration, until the supervisor knows.
    declarations: Option<Vec<(String, bool)>>,
    /// Whether there are factsheets, or vehicles, of which the supervisor does not know.
    has_factsheets: bool,
}

/// Time that a vehicle has to say where it stands, before that is told \[s\].
const GRACE: f64 = 0.5;

/// Number of vehicles of which the state of each vehicle tells the manager that others wait for them, and least time between two changes of that
/// \[s\]: a fleet of 1,000 that starts does not send 1,000 states for each of its vehicles.
const NOTICES: usize = 10;
const PAUSE: f64 = 0.3;

/// Time between two reminders of missing vehicles \[s\].
const REMINDER: f64 = 30.0;

/// Time between two rounds over all lanes, in which lost messages are sent again \[s\].
const LOOK: f64 = 0.1;

impl Vda5050Bridge {
    /// The bridge of these vehicles, with the notes that the supervisor has stored about them.
    ///
    /// # Errors
    /// [`JournalError`] if a note cannot be read.
    pub fn new(
        settings: BridgeConfig,
        profiles: Vec<VehicleConfig>,
        supervisor: &Supervisor,
    ) -> Result<Self, JournalError> {
        let lanes = profiles.into_iter().map(|profile| VehicleAdapter::new(profile, supervisor));
        let lanes: Vec<VehicleAdapter> = lanes.collect::<Result<_, _>>()?;
        let declared = |lane: &VehicleAdapter| Some((lane.name().to_owned(), lane.profile().away?));
        let declarations = lanes.iter().filter_map(declared).collect();
        let places = lanes.iter().enumerate().map(|(place, lane)| (lane.profile().key.clone(), place)).collect();
        Ok(Self {
            settings,
            touched: (0..lanes.len()).collect(),
            lanes,
            places,
            seen: SupervisorSnapshot::default(),
            out: Vec::new(),
            large: BTreeSet::new(),
            counts: BridgeCounters::default(),
            log: Vec::new(),
            said: 0.0,
            unready: Some("the broker has not been reached, or another supervisor is at work".into()),
            unplaced: BTreeMap::new(),
            notices: Vec::new(),
            noticed: BTreeSet::new(),
            noticed_at: f64::NEG_INFINITY,
            declarations: Some(declarations),
            has_factsheets: true,
            looked: f64::NEG_INFINITY,
        })
    }

    /// The topics to which to subscribe.
    pub fn filters(&self) -> Vec<String> {
        let BridgeConfig { manager, vehicles, .. } = &self.settings;
        let of = |interface: &TopicInterface, kinds: &[TopicKind]| {
            kinds.iter().flat_map(|kind| interface.filters(*kind)).collect::<Vec<_>>()
        };
        [of(vehicles, &TopicKind::OF_VEHICLES), of(manager, &TopicKind::TO_VEHICLES)].concat()
    }

    /// Numbers of messages since the start.
    pub fn counts(&self) -> BridgeCounters {
        self.counts
    }

    /// The vehicles.
    pub fn lanes(&self) -> impl Iterator<Item = &VehicleAdapter> {
        self.lanes.iter()
    }

    /// Takes the reasons why messages were refused since the last call.
    pub fn log(&mut self) -> Vec<String> {
        std::mem::take(&mut self.log)
    }

    /// Asks all vehicles for their states and factsheets: the supervisor was away.
    pub fn greet(&mut self, now: f64) {
        for lane in &mut self.lanes {
            lane.ask_when(now);
            lane.ask_for("factsheetRequest");
        }
        self.collect(&(0..self.lanes.len()).collect());
    }

    /// Takes a message that the broker had kept. It may be old, so most kinds are ignored.
    pub fn receive_kept(&mut self, supervisor: &mut Supervisor, topic: &str, payload: &[u8], came: f64) {
        let BridgeConfig { manager, vehicles, .. } = &self.settings;
        let kind = vehicles.parse(topic).or_else(|| manager.parse(topic)).map(|(.., kind)| kind);
        if kind.is_none_or(TopicKind::is_lasting) {
            return self.receive(supervisor, topic, payload, came);
        }
        self.counts.refused += 1;
        self.log.push(format!("{topic}: kept by the broker, from another time"));
    }

    /// Takes a message. Its requests take effect when the supervisor has settled.
    pub fn receive(&mut self, supervisor: &mut Supervisor, topic: &str, payload: &[u8], now: f64) {
        self.receive_late(supervisor, topic, payload, [now; 2]);
    }

    /// The same of a message that came at the first of two times and is read at the second. What a vehicle says is about the first one; what
    /// follows from requests begins now.
    pub(crate) fn receive_late(
        &mut self,
        supervisor: &mut Supervisor,
        topic: &str,
        payload: &[u8],
        [came, now]: [f64; 2],
    ) {
        let settings = &self.settings;
        let from_vehicle = settings.vehicles.parse(topic).filter(|(.., kind)| TopicKind::OF_VEHICLES.contains(kind));
        let from_manager = settings.manager.parse(topic).filter(|(.., kind)| TopicKind::TO_VEHICLES.contains(kind));
        let Some((is_third, key, kind)) = from_vehicle.or(from_manager) else {
            self.counts.foreign += 1;
            return;
        };
        let limits = settings.limits;
        let Some(&place) = self.places.get(&key) else {
            self.counts.foreign += 1;
            return;
        };
        self.counts.read += 1;
        self.touched.insert(place);
        let lane = &mut self.lanes[place];
        let result = match kind {
            TopicKind::State => lane.state(supervisor, payload, limits, is_third, came),
            TopicKind::Visualization => lane
                .visualization(supervisor, payload, limits, is_third, came)
                .inspect(|()| lane.pass_on(kind, is_third, payload)),
            TopicKind::Connection => {
                lane.connection(payload, limits, is_third, came).inspect(|()| lane.pass_on(kind, is_third, payload))
            }
            TopicKind::Factsheet => {
                self.has_factsheets = true;
                lane.factsheet(supervisor, payload, limits, is_third, came)
                    .inspect(|()| lane.pass_on(kind, is_third, payload))
            }
            TopicKind::InstantActions => lane.instant_actions(supervisor, payload, limits, is_third, now),
            TopicKind::Order => {
                lane.order(supervisor, payload, limits, is_third, now);
                Ok(())
            }
            TopicKind::Responses => lane.responses(payload, limits, is_third),
            TopicKind::ZoneSet => lane.zone_set(supervisor, payload, limits, is_third),
        };
        if let Err(refusal) = result {
            self.counts.refused += 1;
            self.log.push(format!("{topic}: {refusal}"));
        }
    }

    /// Handles what the supervisor has decided, and the events since the last call. The resulting messages to vehicles may be
    /// sent once the supervisor has settled.
    pub fn settled(&mut self, supervisor: &mut Supervisor, events: &[SupervisorEvent], now: f64) {
        self.declare(supervisor);
        self.on_events(events);
        self.compare_supervisor(supervisor);
        if now >= self.looked + LOOK {
            self.looked = now;
            self.touched.extend(0..self.lanes.len());
        }
        let touched = std::mem::take(&mut self.touched);
        let is_known = self.note_unplaced(supervisor, now);
        for &place in &touched {
            let lane = &mut self.lanes[place];
            lane.follow_limits(supervisor);
            lane.pause(supervisor, now);
            lane.follow_wait(supervisor, now);
            if is_known {
                lane.release(supervisor, now);
            }
        }
        self.collect(&touched);
        if now >= self.said + REMINDER {
            self.said = now;
            self.log.extend(supervisor.unplaced().map(|(name, why)| format!("{name} {why}")));
        }
    }

    /// Finds the vehicles that others wait for, and tells the supervisor and the manager of them. Returns whether anything may be released: as long
    /// as it is not known where one may stand, it may be in the way of any other.
    fn note_unplaced(&mut self, supervisor: &mut Supervisor, now: f64) -> bool {
        let (mut unplaced, mut reasons) = (BTreeMap::new(), Vec::new());
        for (place, lane) in self.lanes.iter().enumerate() {
            let is_unknown = self.seen.unknown.contains(&place);
            let Some(reason) = lane.waited_for(supervisor, is_unknown) else { continue };
            if reason.places.is_empty() {
                reasons.push(format!("{} {}", lane.name(), reason.why));
            }
            let since = self.unplaced.get(lane.name()).map_or(now, |since| since.min(now));
            let why = (now - since >= GRACE).then_some(reason.why);
            unplaced.insert(lane.name().to_owned(), (since, UnplacedVehicle { why, places: reason.places }));
        }
        self.unplaced = unplaced.iter().map(|(name, (since, _))| (name.clone(), *since)).collect();
        let vehicles = unplaced.into_iter().map(|(name, (_, vehicle))| (name, vehicle)).collect();
        if supervisor.set_unplaced(vehicles) && now.is_finite() {
            // Nothing is released by what was decided before.
            supervisor.decide(now);
        }
        let unplaced = supervisor.unplaced().take(NOTICES);
        let unplaced = unplaced.map(|it| (NoticeKind::Unplaced, [it.0.to_owned(), it.1.to_owned()]));
        let closed = supervisor.closures().take(NOTICES);
        let closed = closed.map(|area| match area.speed {
            None => (NoticeKind::Closed, [area.name.clone(), "is closed".to_owned()]),
            Some(speed) => (NoticeKind::Limited, [area.name.clone(), format!("limits the speed to {speed} m/s")]),
        });
        let paused = supervisor.pause_state().map(|state| (NoticeKind::Paused, ["the fleet".to_owned(), state]));
        let notices: Vec<(NoticeKind, [String; 2])> = paused.into_iter().chain(unplaced).chain(closed).collect();
        if notices != self.notices && now.is_finite() && now >= self.noticed_at + PAUSE {
            self.noticed_at = now;
            for (place, lane) in self.lanes.iter_mut().enumerate() {
                lane.notice(notices.clone());
                self.noticed.insert(place);
            }
            self.notices = notices;
        }
        let noticed = std::mem::take(&mut self.noticed);
        self.collect(&noticed);
        self.unready = (!reasons.is_empty()).then(|| reasons.join("; "));
        reasons.is_empty()
    }

    /// Takes other vehicles in place of those that it has, all or nothing, while it works. Added ones have to say where they stand, if they are not
    /// away. Returns the names of those that were added, and of those that were left out.
    ///
    /// # Errors
    /// What cannot be changed now, in words: a vehicle that has a place can neither be left out nor have other abilities. Nothing has changed then.
    pub fn reload(
        &mut self,
        supervisor: &mut Supervisor,
        profiles: Vec<VehicleConfig>,
    ) -> Result<[Vec<String>; 2], String> {
        let has_place = |lane: &&VehicleAdapter| supervisor.robot(lane.name()).is_ok();
        let is_left_out = |lane: &&VehicleAdapter| profiles.iter().all(|profile| profile.key != lane.profile().key);
        if let Some(lane) = self.lanes.iter().find(|lane| is_left_out(lane) && has_place(lane)) {
            return Err(format!(
                "{}: it has a place, so it cannot be left out: say that it was removed (verb `remove`) before",
                lane.name()
            ));
        }
        let left_out: Vec<String> = self.lanes.iter().filter(is_left_out).map(|lane| lane.name().to_owned()).collect();
        let (mut added, mut anew, mut declarations) = (Vec::new(), Vec::new(), Vec::new());
        for profile in &profiles {
            let name = profile.key.to_string();
            if supervisor.robot(&name).is_ok_and(|robot| robot.abilities != profile.abilities) {
                return Err(format!(
                    "{name}: it has a place, so radius, footprint, margin, speed and acceleration stay as they are: say that it was removed (verb \
                     `remove`) before"
                ));
            }
            profile.abilities.body(false).map_err(|why| format!("{name}: {why}"))?;
            let before = self.places.get(&profile.key).map(|&place| self.lanes[place].profile().away);
            if before.is_none() {
                let lane = VehicleAdapter::new(profile.clone(), supervisor).map_err(|why| format!("{name}: {why}"))?;
                anew.push(lane);
                added.push(name.clone());
            }
            // What the file said before may have been overtaken since.
            if before != Some(profile.away) && (profile.away.is_some() || before.is_some()) {
                declarations.push((name, profile.away.unwrap_or(false)));
            }
        }
        // From here on nothing fails.
        self.lanes.retain(|lane| !is_left_out(&lane));
        for lane in &mut self.lanes {
            let profile = profiles.iter().find(|profile| profile.key == lane.profile().key);
            profile.into_iter().for_each(|profile| lane.reconfigure(profile.clone()));
        }
        for mut lane in anew {
            lane.ask_for("stateRequest");
            lane.notice(self.notices.clone());
            self.lanes.push(lane);
        }
        self.places = self.lanes.iter().enumerate().map(|(place, lane)| (lane.profile().key.clone(), place)).collect();
        self.touched = (0..self.lanes.len()).collect();
        self.noticed.clone_from(&self.touched);
        self.has_factsheets = true;
        (self.seen, self.large) = (SupervisorSnapshot::default(), BTreeSet::new());
        // A declaration that was not made yet is in the new list, too, or was for one that was left out.
        let mut all = self.declarations.take().unwrap_or_default();
        all.retain(|(name, _)| !left_out.contains(name) && declarations.iter().all(|(other, _)| other != name));
        all.extend(declarations);
        self.declarations = Some(all);
        self.prepare(supervisor);
        Ok([added, left_out])
    }

    /// Tells the supervisor which vehicles there are, which of them are away, and which have not said where they stand: before it decides, and while
    /// nothing may be sent.
    pub fn prepare(&mut self, supervisor: &mut Supervisor) {
        self.declare(supervisor);
        self.compare_supervisor(supervisor);
        // How long they have not said it counts from when the bridge works.
        self.note_unplaced(supervisor, f64::INFINITY);
    }

    /// Tells the supervisor which vehicles there are, and which of them are away by their configuration: once.
    fn declare(&mut self, supervisor: &mut Supervisor) {
        if let Some(away) = self.declarations.take() {
            let names = self.lanes.iter().map(|lane| lane.name().to_owned()).collect();
            // The names are expected, and after a broken journal nothing is told.
            let _ = supervisor.expect(names);
            for (name, away) in away {
                let _ = supervisor.set_away(&name, away);
            }
        }
        for lane in &mut self.lanes {
            lane.follow_absence(supervisor);
            lane.follow_zones(supervisor);
        }
        if std::mem::take(&mut self.has_factsheets) {
            let ability = |lane: &VehicleAdapter| Some((lane.name().to_owned(), lane.pause_ability()?));
            supervisor.set_pause_abilities(self.lanes.iter().filter_map(ability).collect());
        }
    }

    /// Returns why no vehicle is released anything, if so.
    pub fn unready(&self) -> Option<String> {
        self.unready.clone()
    }

    /// Compares the rights of all robots with those seen before, and finds the vehicles that are not in the supervisor.
    fn compare_supervisor(&mut self, supervisor: &Supervisor) {
        let Self { places, seen, touched, lanes, .. } = self;
        let robots = supervisor.robots();
        if seen.fleet_revision != Some(supervisor.census()) {
            seen.fleet_revision = Some(supervisor.census());
            let place = |robot: &SupervisedRobot| places.get(&key(&robot.name)?).copied();
            seen.authorities = robots.iter().map(|robot| (place(robot), (0, 0.0, false))).collect();
            seen.unknown = (0..lanes.len()).filter(|&k| supervisor.robot(lanes[k].name()).is_err()).collect();
        }
        for ((place, rights), robot) in seen.authorities.iter_mut().zip(robots) {
            let own = (robot.path, robot.granted, robot.stopped.is_some());
            if std::mem::replace(rights, own) != own {
                touched.extend(*place);
            }
        }
    }

    /// Takes events of the supervisor, without any messages to vehicles yet.
    pub(crate) fn on_events(&mut self, events: &[SupervisorEvent]) {
        for event in events {
            if let Some(&place) = event.robot().and_then(key).and_then(|key| self.places.get(&key)) {
                self.touched.insert(place);
                self.lanes[place].on_event(event);
            }
        }
    }

    fn collect(&mut self, places: &BTreeSet<usize>) {
        let Self { settings, lanes, out, large, log, .. } = self;
        for &place in places {
            let lane = &mut lanes[place];
            log.extend(lane.remarks().iter().map(|remark| format!("{}: {remark}", lane.name())));
        }
        let posts = places.iter().flat_map(|&place| lanes[place].posts().into_iter().map(move |post| (place, post)));
        for (place, OutboundMessage { to, key, version, kind, payload, due }) in posts {
            let interface = if to == Recipient::Vehicle { &settings.vehicles } else { &settings.manager };
            let topic = interface.topic(version, &key, kind);
            let (size, most) = (payload.len(), settings.limits.sent);
            if size > most {
                // States come many times a second.
                if large.insert(place) {
                    log.push(format!("{topic}: not sent: {size} bytes; at most {most} are sent"));
                }
                continue;
            }
            if kind == TopicKind::State {
                large.remove(&place);
            }
            let (assured, retain) = (kind.is_assured(), kind.is_retained());
            out.push(PendingPublish {
                message: MqttMessage { topic, payload, at_least_once: assured, retain },
                due,
                vehicle: key,
            });
        }
    }

    /// Takes the messages to be sent: after the changes from which they follow are in the journal.
    pub fn out(&mut self) -> Vec<MqttMessage> {
        self.due().into_iter().map(|out| out.message).collect()
    }

    /// Takes the messages to be sent, each with the time at which it may be.
    pub fn due(&mut self) -> Vec<PendingPublish> {
        self.counts.sent += self.out.len() as u64;
        std::mem::take(&mut self.out)
    }

    /// Withholds a message that would let a vehicle go on that was told to stop since, and returns whether it does. What the manager has
    /// asked for in it is sent when the vehicle may go.
    pub fn withholds(&mut self, out: &PendingPublish) -> bool {
        // One that was left out of the file since has no order.
        let Some(&place) = self.places.get(&out.vehicle) else { return true };
        let lane = &mut self.lanes[place];
        let withheld = out.due == SendCondition::Free && lane.has_to_stop();
        if withheld {
            lane.withhold_stop_pause(&out.message.payload);
        }
        withheld
    }
}

/// The vehicle with this name in the supervisor.
fn key(name: &str) -> Option<VehicleId> {
    let (manufacturer, serial_number) = name.split_once('/')?;
    Some(VehicleId { manufacturer: manufacturer.into(), serial_number: serial_number.into() })
}
