//! All vehicles of a fleet between their manager and the supervisor: messages in, messages out, no input or output of its own.

use super::door::Limits;
use super::lane::{Lane, Post, Profile, To};
use super::topics::{Interface, Key, Kind};
use crate::event::Event;
use crate::supervisor::Supervisor;
use serde::Serialize;
use std::collections::BTreeMap;

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

/// The fleet.
#[derive(Debug)]
pub struct Bridge {
    settings: Settings,
    lanes: BTreeMap<Key, Lane>,
    out: Vec<Publish>,
    counts: Counts,
    log: Vec<String>,
    /// When it was said last for whom everybody waits \[s\].
    said: f64,
}

/// Between two reminders of who is missing \[s\].
const REMINDER: f64 = 30.0;

impl Bridge {
    /// Of these vehicles, with what the supervisor remembers of them.
    pub fn new(settings: Settings, profiles: Vec<Profile>, supervisor: &Supervisor) -> Self {
        let lanes = profiles.into_iter().map(|profile| (profile.key.clone(), Lane::new(profile, supervisor)));
        Self {
            settings,
            lanes: lanes.collect(),
            out: Vec::new(),
            counts: Counts::default(),
            log: Vec::new(),
            said: 0.0,
        }
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
        self.lanes.values()
    }

    /// Why messages were refused, since this was asked last.
    pub fn log(&mut self) -> Vec<String> {
        std::mem::take(&mut self.log)
    }

    /// Asks all vehicles for their states and factsheets: the supervisor was away.
    pub fn greet(&mut self) {
        for lane in self.lanes.values_mut() {
            lane.ask_for("stateRequest");
            lane.ask_for("factsheetRequest");
        }
        self.collect();
    }

    /// Takes a message. What it asks for takes effect when the supervisor has settled.
    pub fn receive(&mut self, supervisor: &mut Supervisor, topic: &str, payload: &[u8], now: f64) {
        let Self { settings, lanes, .. } = self;
        let from_vehicle = settings.vehicles.parse(topic).filter(|(.., kind)| Kind::OF_VEHICLES.contains(kind));
        let from_manager = settings.manager.parse(topic).filter(|(.., kind)| Kind::TO_VEHICLES.contains(kind));
        let Some((is_third, key, kind)) = from_vehicle.or(from_manager) else {
            self.counts.foreign += 1;
            return;
        };
        let Some(lane) = lanes.get_mut(&key) else {
            self.counts.foreign += 1;
            return;
        };
        self.counts.read += 1;
        let limits = settings.limits;
        let result = match kind {
            Kind::State => lane.state(supervisor, payload, limits, is_third, now),
            Kind::Visualization => lane
                .visualization(supervisor, payload, limits, is_third, now)
                .inspect(|()| lane.pass_on(kind, is_third, payload)),
            Kind::Connection => {
                lane.connection(payload, limits, is_third).inspect(|()| lane.pass_on(kind, is_third, payload))
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

    /// Takes what the supervisor has settled, and sends vehicles what they may do.
    pub fn settled(&mut self, supervisor: &mut Supervisor, events: &[Event], now: f64) {
        self.told(events);
        self.lanes.values_mut().for_each(|lane| lane.pause(supervisor, now));
        // A vehicle that has never said where it stands may stand anywhere.
        let is_unknown = |lane: &&Lane| supervisor.robot(lane.name()).is_err();
        let unknown: Vec<&str> = self.lanes.values().filter(is_unknown).map(Lane::name).collect();
        if unknown.is_empty() {
            self.lanes.values_mut().for_each(|lane| lane.release(supervisor, now));
        } else if now >= self.said + REMINDER {
            self.said = now;
            let names = unknown.join(", ");
            self.log.push(format!("nobody is released anything until these have said where they stand: {names}"));
        }
        self.collect();
    }

    /// Takes what the supervisor has settled, and sends nobody anything for it yet.
    pub fn told(&mut self, events: &[Event]) {
        for event in events {
            if let Some(lane) = self.lanes.values_mut().find(|lane| lane.name() == event.robot()) {
                lane.told(event);
            }
        }
    }

    fn collect(&mut self) {
        let Self { settings, lanes, out, .. } = self;
        for Post { to, key, version, kind, payload } in lanes.values_mut().flat_map(Lane::posts) {
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
