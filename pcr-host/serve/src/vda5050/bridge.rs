//! Connects all vehicles of a fleet with their manager and the supervisor. It only converts messages, and does no input
//! or output itself.

use super::lane::{Due, Lane, Post, Profile, To};
use crate::event::Event;
use crate::robot::Robot;
use crate::supervisor::{Damaged, Supervisor};
use pcr_formats::vda5050::decode::Limits;
use pcr_formats::vda5050::topics::{Interface, Key, Kind};
use serde::Serialize;
use std::collections::{BTreeSet, HashMap};

/// Settings of a bridge.
#[derive(Clone, Debug)]
pub struct Settings {
    /// Topics of the fleet manager.
    pub manager: Interface,
    /// Topics of the vehicles.
    pub vehicles: Interface,
    /// Limits of the messages that are read.
    pub limits: Limits,
}

/// A message to the broker.
#[derive(Clone, Debug, PartialEq)]
pub struct Publish {
    /// Topic.
    pub topic: String,
    /// Content, as JSON.
    pub payload: Vec<u8>,
    /// Whether it is sent with quality of service 1.
    pub assured: bool,
    /// Whether the broker keeps it.
    pub retain: bool,
}

/// A message to the broker, and when it may be sent.
#[derive(Clone, Debug, PartialEq)]
pub struct Out {
    /// The message.
    pub message: Publish,
    /// When it may be sent.
    pub due: Due,
    /// Index of its lane.
    place: usize,
}

/// Numbers of messages since the start.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Counts {
    /// Number of messages read.
    pub read: u64,
    /// Number of messages refused.
    pub refused: u64,
    /// Number of messages of vehicles that are not in the fleet, or on other topics.
    pub foreign: u64,
    /// Number of messages sent.
    pub sent: u64,
}

/// The state of a robot on which the messages to its vehicle depend: number of its path, hold, whether it is stopped.
type Rights = (u64, f64, bool);

/// The state of the supervisor when it was last compared.
#[derive(Debug, Default)]
struct Seen {
    census: Option<u64>,
    /// For each robot its lane and its rights.
    rights: Vec<(Option<usize>, Rights)>,
    /// Lanes whose vehicles are not in the supervisor yet.
    unknown: Vec<usize>,
}

/// The fleet.
#[derive(Debug)]
pub struct Bridge {
    settings: Settings,
    lanes: Vec<Lane>,
    places: HashMap<Key, usize>,
    /// Lanes for which something has come since they were last handled.
    touched: BTreeSet<usize>,
    seen: Seen,
    out: Vec<Out>,
    /// Lanes whose last message to the manager was too large.
    large: BTreeSet<usize>,
    counts: Counts,
    log: Vec<String>,
    /// Time of the last reminder of missing vehicles \[s\].
    said: f64,
    /// Time at which all lanes were last handled \[s\].
    looked: f64,
}

/// Time between two reminders of missing vehicles \[s\].
const REMINDER: f64 = 30.0;

/// Time between two rounds over all lanes, in which lost messages are sent again \[s\].
const LOOK: f64 = 0.1;

impl Bridge {
    /// The bridge of these vehicles, with the notes that the supervisor has stored about them.
    ///
    /// # Errors
    /// [`Damaged`] if a note cannot be read.
    pub fn new(settings: Settings, profiles: Vec<Profile>, supervisor: &Supervisor) -> Result<Self, Damaged> {
        let lanes = profiles.into_iter().map(|profile| Lane::new(profile, supervisor));
        let lanes: Vec<Lane> = lanes.collect::<Result<_, _>>()?;
        let places = lanes.iter().enumerate().map(|(place, lane)| (lane.profile().key.clone(), place)).collect();
        Ok(Self {
            settings,
            touched: (0..lanes.len()).collect(),
            lanes,
            places,
            seen: Seen::default(),
            out: Vec::new(),
            large: BTreeSet::new(),
            counts: Counts::default(),
            log: Vec::new(),
            said: 0.0,
            looked: f64::NEG_INFINITY,
        })
    }

    /// The topics to which to subscribe.
    pub fn filters(&self) -> Vec<String> {
        let Settings { manager, vehicles, .. } = &self.settings;
        let of = |interface: &Interface, kinds: &[Kind]| {
            kinds.iter().flat_map(|kind| interface.filters(*kind)).collect::<Vec<_>>()
        };
        [of(vehicles, &Kind::OF_VEHICLES), of(manager, &Kind::TO_VEHICLES)].concat()
    }

    /// Numbers of messages since the start.
    pub fn counts(&self) -> Counts {
        self.counts
    }

    /// The vehicles.
    pub fn lanes(&self) -> impl Iterator<Item = &Lane> {
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
        let Settings { manager, vehicles, .. } = &self.settings;
        let kind = vehicles.parse(topic).or_else(|| manager.parse(topic)).map(|(.., kind)| kind);
        if kind.is_none_or(Kind::is_lasting) {
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
    pub fn receive_late(&mut self, supervisor: &mut Supervisor, topic: &str, payload: &[u8], [came, now]: [f64; 2]) {
        let settings = &self.settings;
        let from_vehicle = settings.vehicles.parse(topic).filter(|(.., kind)| Kind::OF_VEHICLES.contains(kind));
        let from_manager = settings.manager.parse(topic).filter(|(.., kind)| Kind::TO_VEHICLES.contains(kind));
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
            Kind::State => lane.state(supervisor, payload, limits, is_third, came),
            Kind::Visualization => lane
                .visualization(supervisor, payload, limits, is_third, came)
                .inspect(|()| lane.pass_on(kind, is_third, payload)),
            Kind::Connection => {
                lane.connection(payload, limits, is_third, came).inspect(|()| lane.pass_on(kind, is_third, payload))
            }
            Kind::Factsheet => lane
                .factsheet(supervisor, payload, limits, is_third, came)
                .inspect(|()| lane.pass_on(kind, is_third, payload)),
            Kind::InstantActions => lane.instant_actions(supervisor, payload, limits, is_third, now),
            Kind::Order => {
                lane.order(supervisor, payload, limits, is_third, now);
                Ok(())
            }
            Kind::Responses => lane.responses(payload, limits, is_third),
            // Zones are up to the manager.
            Kind::ZoneSet => lane.untouched(kind, payload, limits, is_third),
        };
        if let Err(refusal) = result {
            self.counts.refused += 1;
            self.log.push(format!("{topic}: {refusal}"));
        }
    }

    /// Handles what the supervisor has decided, and the events since the last call. The resulting messages to vehicles may be
    /// sent once the supervisor has settled.
    pub fn settled(&mut self, supervisor: &mut Supervisor, events: &[Event], now: f64) {
        self.told(events);
        self.look(supervisor);
        if now >= self.looked + LOOK {
            self.looked = now;
            self.touched.extend(0..self.lanes.len());
        }
        let touched = std::mem::take(&mut self.touched);
        // A vehicle without a position may stand anywhere, and one that is larger than its disc may be in the way of any other.
        let is_sure = |lane: &Lane| lane.misfit().is_none() && !lane.is_doubtful();
        let is_known = self.seen.unknown.is_empty() && self.lanes.iter().all(is_sure);
        for &place in &touched {
            let lane = &mut self.lanes[place];
            lane.pause(supervisor, now);
            if is_known {
                lane.release(supervisor, now);
            }
        }
        self.collect(&touched);
        if !is_known && now >= self.said + REMINDER {
            self.said = now;
            let doubtful = self.lanes.iter().filter(|lane| lane.is_doubtful());
            let unknown = self.seen.unknown.iter().map(|&place| &self.lanes[place]);
            let names: Vec<&str> = unknown.chain(doubtful).map(Lane::name).collect();
            if !names.is_empty() {
                let names = names.join(", ");
                self.log.push(format!("nobody is released anything until these have said where they stand: {names}"));
            }
            let unknown = self.seen.unknown.iter().map(|&place| &self.lanes[place]);
            let elsewhere = unknown.filter_map(|lane| Some((lane.name(), lane.elsewhere()?.to_owned())));
            let misfits = self.lanes.iter().filter_map(|lane| Some((lane.name(), lane.misfit()?)));
            for (name, why) in elsewhere.chain(misfits) {
                self.log.push(format!("nobody is released anything: {name}: {why}"));
            }
        }
    }

    /// Compares the rights of all robots with those seen before, and finds the vehicles that are not in the supervisor.
    fn look(&mut self, supervisor: &Supervisor) {
        let Self { places, seen, touched, lanes, .. } = self;
        let robots = supervisor.robots();
        if seen.census != Some(supervisor.census()) {
            seen.census = Some(supervisor.census());
            let place = |robot: &Robot| places.get(&key(&robot.name)?).copied();
            seen.rights = robots.iter().map(|robot| (place(robot), (0, 0.0, false))).collect();
            seen.unknown = (0..lanes.len()).filter(|&k| supervisor.robot(lanes[k].name()).is_err()).collect();
        }
        for ((place, rights), robot) in seen.rights.iter_mut().zip(robots) {
            let own = (robot.path, robot.granted, robot.stopped.is_some());
            if std::mem::replace(rights, own) != own {
                touched.extend(*place);
            }
        }
    }

    /// Takes events of the supervisor, without any messages to vehicles yet.
    pub fn told(&mut self, events: &[Event]) {
        for event in events {
            if let Some(&place) = key(event.robot()).and_then(|key| self.places.get(&key)) {
                self.touched.insert(place);
                self.lanes[place].told(event);
            }
        }
    }

    fn collect(&mut self, places: &BTreeSet<usize>) {
        let Self { settings, lanes, out, large, log, .. } = self;
        let posts = places.iter().flat_map(|&place| lanes[place].posts().into_iter().map(move |post| (place, post)));
        for (place, Post { to, key, version, kind, payload, due }) in posts {
            let interface = if to == To::Vehicle { &settings.vehicles } else { &settings.manager };
            let topic = interface.topic(version, &key, kind);
            let (size, most) = (payload.len(), settings.limits.sent);
            if size > most {
                // States come many times a second.
                if large.insert(place) {
                    log.push(format!("{topic}: not sent: {size} bytes; at most {most} are sent"));
                }
                continue;
            }
            if kind == Kind::State {
                large.remove(&place);
            }
            let (assured, retain) = (kind.is_assured(), kind.is_retained());
            out.push(Out { message: Publish { topic, payload, assured, retain }, due, place });
        }
    }

    /// Takes the messages to be sent: after the changes from which they follow are in the journal.
    pub fn out(&mut self) -> Vec<Publish> {
        self.due().into_iter().map(|out| out.message).collect()
    }

    /// Takes the messages to be sent, each with the time at which it may be.
    pub fn due(&mut self) -> Vec<Out> {
        self.counts.sent += self.out.len() as u64;
        std::mem::take(&mut self.out)
    }

    /// Withholds a message that would let a vehicle go on that was told to stop since, and returns whether it does. What the manager has
    /// asked for in it is sent when the vehicle may go.
    pub fn withholds(&mut self, out: &Out) -> bool {
        let lane = &mut self.lanes[out.place];
        let withheld = out.due == Due::Free && lane.has_to_stop();
        if withheld {
            lane.take_back(&out.message.payload);
        }
        withheld
    }
}

/// The vehicle with this name in the supervisor.
fn key(name: &str) -> Option<Key> {
    let (manufacturer, serial_number) = name.split_once('/')?;
    Some(Key { manufacturer: manufacturer.into(), serial_number: serial_number.into() })
}
