//! Connects all vehicles of a fleet with their manager and the supervisor. It only converts messages, and does no input
//! or output itself.

use super::door::Limits;
use super::lane::{Lane, Post, Profile, To};
use super::topics::{Interface, Key, Kind};
use crate::event::Event;
use crate::robot::Robot;
use crate::supervisor::{Damaged, Supervisor};
use serde::Serialize;
use std::collections::{BTreeSet, HashMap};

/// What can be set.
#[derive(Clone, Debug)]
pub struct Settings {
    /// Topics of the fleet manager.
    pub manager: Interface,
    /// Topics of the vehicles.
    pub vehicles: Interface,
    /// What is read.
    pub limits: Limits,
}

/// A message for the broker.
#[derive(Clone, Debug, PartialEq)]
pub struct Publish {
    /// Where to.
    pub topic: String,
    /// JSON.
    pub payload: Vec<u8>,
    /// At least once.
    pub assured: bool,
    /// The broker keeps it.
    pub retain: bool,
}

/// What has happened since the start.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Counts {
    /// Messages read.
    pub read: u64,
    /// Messages that were refused.
    pub refused: u64,
    /// Messages of vehicles that are not of this fleet, or in other topics.
    pub foreign: u64,
    /// Messages sent.
    pub sent: u64,
}

/// What of a robot decides what its vehicle may be told: its path, how far it may go, whether it is stopped.
type Rights = (u64, f64, bool);

/// What was seen of the supervisor last.
#[derive(Debug, Default)]
struct Seen {
    census: Option<u64>,
    /// Of each robot, with the place of its lane.
    rights: Vec<(Option<usize>, Rights)>,
    /// Places of vehicles that it does not know.
    unknown: Vec<usize>,
}

/// The fleet.
#[derive(Debug)]
pub struct Bridge {
    settings: Settings,
    lanes: Vec<Lane>,
    places: HashMap<Key, usize>,
    /// Places of those for which something has come since they were looked at last.
    touched: BTreeSet<usize>,
    seen: Seen,
    out: Vec<Publish>,
    counts: Counts,
    log: Vec<String>,
    /// When it was said last for whom everybody waits \[s\].
    said: f64,
    /// When all lanes were looked at last \[s\].
    looked: f64,
}

/// Between two reminders of who is missing \[s\].
const REMINDER: f64 = 30.0;

/// Between two looks at lanes for which nothing has come: what was lost is sent again \[s\].
const LOOK: f64 = 0.1;

impl Bridge {
    /// Of these vehicles, with what the supervisor remembers of them.
    ///
    /// # Errors
    /// [`Damaged`] where that cannot be read.
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
            counts: Counts::default(),
            log: Vec::new(),
            said: 0.0,
            looked: f64::NEG_INFINITY,
        })
    }

    /// What to subscribe to.
    pub fn filters(&self) -> Vec<String> {
        let Settings { manager, vehicles, .. } = &self.settings;
        let of = |interface: &Interface, kinds: &[Kind]| {
            kinds.iter().flat_map(|kind| interface.filters(*kind)).collect::<Vec<_>>()
        };
        [of(vehicles, &Kind::OF_VEHICLES), of(manager, &Kind::TO_VEHICLES)].concat()
    }

    /// What has happened.
    pub fn counts(&self) -> Counts {
        self.counts
    }

    /// The vehicles.
    pub fn lanes(&self) -> impl Iterator<Item = &Lane> {
        self.lanes.iter()
    }

    /// Why messages were refused, since this was asked last.
    pub fn log(&mut self) -> Vec<String> {
        std::mem::take(&mut self.log)
    }

    /// Asks all vehicles for their states and factsheets: the supervisor was away.
    pub fn greet(&mut self) {
        for lane in &mut self.lanes {
            lane.ask_for("stateRequest");
            lane.ask_for("factsheetRequest");
        }
        self.collect(&(0..self.lanes.len()).collect());
    }

    /// Takes a message that the broker had kept, from any time before: of most kinds that is none.
    pub fn receive_kept(&mut self, supervisor: &mut Supervisor, topic: &str, payload: &[u8], now: f64) {
        let Settings { manager, vehicles, .. } = &self.settings;
        let kind = vehicles.parse(topic).or_else(|| manager.parse(topic)).map(|(.., kind)| kind);
        if kind.is_none_or(Kind::is_lasting) {
            return self.receive(supervisor, topic, payload, now);
        }
        self.counts.refused += 1;
        self.log.push(format!("{topic}: kept by the broker, from another time"));
    }

    /// Takes a message. What it asks for takes effect when the supervisor has settled.
    pub fn receive(&mut self, supervisor: &mut Supervisor, topic: &str, payload: &[u8], now: f64) {
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
            Kind::State => lane.state(supervisor, payload, limits, is_third, now),
            Kind::Visualization => lane
                .visualization(supervisor, payload, limits, is_third, now)
                .inspect(|()| lane.pass_on(kind, is_third, payload)),
            Kind::Connection => {
                lane.connection(payload, limits, is_third, now).inspect(|()| lane.pass_on(kind, is_third, payload))
            }
            Kind::Factsheet => {
                lane.factsheet(payload, limits, is_third).inspect(|()| lane.pass_on(kind, is_third, payload))
            }
            Kind::InstantActions => lane.instant_actions(supervisor, payload, limits, is_third, now),
            Kind::Order => {
                lane.order(supervisor, payload, limits, is_third, now);
                Ok(())
            }
            Kind::Responses => lane.responses(payload, limits, is_third),
            // Zones are the manager's.
            Kind::ZoneSet => lane.untouched(kind, payload, limits, is_third),
        };
        if let Err(refusal) = result {
            self.counts.refused += 1;
            self.log.push(format!("{topic}: {refusal}"));
        }
    }

    /// Takes what the supervisor has decided, and what it has told since this was called last; what follows for vehicles may be sent once
    /// that is settled.
    pub fn settled(&mut self, supervisor: &mut Supervisor, events: &[Event], now: f64) {
        self.told(events);
        self.look(supervisor);
        if now >= self.looked + LOOK {
            self.looked = now;
            self.touched.extend(0..self.lanes.len());
        }
        let touched = std::mem::take(&mut self.touched);
        // A vehicle that has never said where it stands may stand anywhere, and one that is larger than its disc may be in anybody's way.
        let is_known = self.seen.unknown.is_empty() && self.lanes.iter().all(|lane| lane.misfit().is_none());
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
            let names: Vec<&str> = self.seen.unknown.iter().map(|&place| self.lanes[place].name()).collect();
            if !names.is_empty() {
                let names = names.join(", ");
                self.log.push(format!("nobody is released anything until these have said where they stand: {names}"));
            }
            let unknown = self.seen.unknown.iter().map(|&place| &self.lanes[place]);
            let elsewhere = unknown.filter_map(|lane| Some((lane.name(), lane.elsewhere()?)));
            let misfits = self.lanes.iter().filter_map(|lane| Some((lane.name(), lane.misfit()?)));
            for (name, why) in elsewhere.chain(misfits) {
                self.log.push(format!("nobody is released anything: {name}: {why}"));
            }
        }
    }

    /// Whose rights have changed, and who is not known.
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

    /// Takes what the supervisor has settled, and sends nobody anything for it yet.
    pub fn told(&mut self, events: &[Event]) {
        for event in events {
            if let Some(&place) = key(event.robot()).and_then(|key| self.places.get(&key)) {
                self.touched.insert(place);
                self.lanes[place].told(event);
            }
        }
    }

    fn collect(&mut self, places: &BTreeSet<usize>) {
        let Self { settings, lanes, out, .. } = self;
        for Post { to, key, version, kind, payload } in places.iter().flat_map(|&place| lanes[place].posts()) {
            let interface = if to == To::Vehicle { &settings.vehicles } else { &settings.manager };
            let (assured, retain) = (kind.is_assured(), kind.is_retained());
            out.push(Publish { topic: interface.topic(version, &key, kind), payload, assured, retain });
        }
    }

    /// The messages to be sent: once what they follow from is in the journal.
    pub fn out(&mut self) -> Vec<Publish> {
        self.counts.sent += self.out.len() as u64;
        std::mem::take(&mut self.out)
    }
}

/// The vehicle that is called so.
fn key(name: &str) -> Option<Key> {
    let (manufacturer, serial_number) = name.split_once('/')?;
    Some(Key { manufacturer: manufacturer.into(), serial_number: serial_number.into() })
}
