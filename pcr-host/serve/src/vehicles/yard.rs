//! Vehicles, their manager and a supervisor without a broker, in steps of simulated time: the same seed gives the same
//! run on any machine.

use super::audit::Audit;
use super::locks::Method;
use super::manager::{Manager, Sent};
use super::random::Random;
use super::record::{Record, Recorded};
use super::vehicle::Vehicle;
use super::weather::{Climate, Weather};
use super::world::World;
use crate::event::Event;
use crate::fault::Fault;
use crate::supervisor::{Damaged, Supervisor};
use crate::vda5050::bridge::{self, Bridge, Publish};
use crate::vda5050::door::Limits;
use crate::vda5050::lane::Profile;
use crate::vda5050::topics::{Interface, Kind};
use std::io::{self, Write};

/// What can be set.
#[derive(Clone, Copy, Debug)]
pub struct Settings {
    /// Who keeps vehicles apart.
    pub method: Method,
    /// What becomes of messages.
    pub climate: Climate,
    /// Connections lost by each vehicle, a second; each is back within half a minute.
    pub drops: f64,
    /// A step of time \[s\].
    pub step: f64,
    /// Another number is another run.
    pub seed: u64,
}

/// Why a step could not be done.
#[derive(Debug)]
pub enum Failed {
    /// The journal could not be written. What followed from the step was told to nobody; [`Yard::revive`] goes on.
    Journal(Fault),
    /// The record could not be written.
    Record(io::Error),
}

impl From<Fault> for Failed {
    fn from(fault: Fault) -> Self {
        Self::Journal(fault)
    }
}

struct Member {
    vehicle: Vehicle,
    incoming: Weather<(Kind, Vec<u8>)>,
    outgoing: Weather<Publish>,
    /// When it says the next position and state \[s\].
    next: [f64; 2],
    /// Until when it is not connected \[s\].
    away: f64,
    /// Where it was last, along its way \[m\], and since when \[s\].
    still: (u64, f64, f64),
}

/// All of them.
pub struct Yard<W: Write> {
    settings: Settings,
    interfaces: [Interface; 2],
    members: Vec<Member>,
    manager: Manager,
    /// From the manager, and to it.
    desks: [Weather<Publish>; 2],
    supervisor: Supervisor,
    bridge: Bridge,
    profiles: Vec<Profile>,
    record: Record<W>,
    random: Random,
    audit: Audit,
    time: f64,
    /// Times that connections were lost, and the longest that a vehicle with an order stood \[s\].
    drops: u64,
    longest: f64,
    log: Vec<String>,
}

/// Longest that a vehicle is not connected \[s\].
const AWAY: f64 = 30.0;

/// Between two positions and two states of a vehicle without any news \[s\].
const PAUSES: [f64; 2] = [1.0, 5.0];

impl<W: Write> Yard<W> {
    /// With a supervisor that knows nothing yet; where vehicles are is recorded.
    ///
    /// # Errors
    /// As the writer of the record, and for topics that are none.
    pub fn new(
        world: World,
        interfaces: [Interface; 2],
        settings: Settings,
        supervisor: Supervisor,
        record: W,
    ) -> io::Result<Self> {
        let World { profiles, vehicles, manager } = world;
        let names = vehicles.iter().map(|it| Recorded { name: it.key().to_string(), radius: it.abilities().radius });
        let record = Record::new(record, &names.collect::<Vec<_>>())?;
        let bridge = bridge(&interfaces, &profiles, &supervisor).map_err(io::Error::other)?;
        let Settings { method, climate, seed, .. } = settings;
        let members = vehicles.into_iter().enumerate().map(|(k, vehicle)| {
            let own = 1_000 * seed + 2 * k as u64;
            let (incoming, outgoing) = (Weather::new(climate, own), Weather::new(climate, own + 1));
            let (next, still) = ([0.1 * k as f64; 2], (0, 0.0, 0.0));
            Member { vehicle, incoming, outgoing, next, away: 0.0, still }
        });
        let (members, random) = (members.collect(), Random::new(seed));
        let desks = [500, 501].map(|k| Weather::new(climate, 1_000 * seed + k));
        let (manager, audit, log) = (manager.by(method), Audit::default(), Vec::new());
        let (time, drops, longest) = (0.0, 0, 0.0);
        Ok(Self {
            settings,
            interfaces,
            members,
            manager,
            desks,
            supervisor,
            bridge,
            profiles,
            record,
            random,
            audit,
            time,
            drops,
            longest,
            log,
        })
    }

    /// Goes on for a step.
    ///
    /// # Errors
    /// [`Failed`].
    pub fn step(&mut self) -> Result<(), Failed> {
        let own = &mut *self;
        own.time += own.settings.step;
        let (now, step) = (own.time, own.settings.step);
        for (k, member) in own.members.iter_mut().enumerate() {
            member.vehicle.advance(step);
            own.record.push(k, now, member.vehicle.place()).map_err(Failed::Record)?;
            if now >= member.away && own.random.happens(own.settings.drops, step) {
                member.away = now + AWAY * own.random.unit();
                own.drops += 1;
            }
            if now >= member.next[0] {
                member.next[0] = now + PAUSES[0];
                member.vehicle.tell_position();
            }
            if now >= member.next[1] {
                member.next[1] = now + PAUSES[1];
                member.vehicle.tell_state();
            }
            for (kind, payload) in member.vehicle.out() {
                let topic = own.interfaces[1].topic(member.vehicle.version(), member.vehicle.key(), kind);
                member.outgoing.send(Publish { topic, payload, assured: false, retain: false }, now);
            }
        }
        own.audit.look(now, own.members.iter().map(|member| &member.vehicle));
        own.stand();
        let said = self.said();
        let settled = match self.settings.method {
            Method::Supervisor => self.supervised(said),
            _ => {
                said.into_iter().for_each(|message| self.desks[1].send(message, now));
                Ok(())
            }
        };
        self.managed();
        for member in &mut self.members {
            for (kind, payload) in member.incoming.come(now) {
                if now >= member.away {
                    member.vehicle.receive(kind, &payload);
                }
            }
        }
        Ok(settled?)
    }

    /// How long vehicles with something to do have stood.
    fn stand(&mut self) {
        let busy: Vec<bool> = {
            let busy: Vec<_> = self.manager.busy().collect();
            self.members.iter().map(|member| busy.contains(&member.vehicle.key())).collect()
        };
        for (member, busy) in self.members.iter_mut().zip(busy) {
            let (taken, at) = (member.vehicle.taken(), member.vehicle.way_done());
            if !busy || member.still.0 != taken || member.still.1 != at {
                member.still = (taken, at, self.time);
            }
            self.longest = self.longest.max(self.time - member.still.2);
        }
    }

    /// What vehicles say.
    fn said(&mut self) -> Vec<Publish> {
        let now = self.time;
        let come = self.members.iter_mut().flat_map(|member| {
            let away = now < member.away;
            member.outgoing.come(now).into_iter().filter(move |_| !away)
        });
        come.collect()
    }

    /// What the supervisor makes of it, and of what the manager says.
    fn supervised(&mut self, said: Vec<Publish>) -> Result<(), Fault> {
        let now = self.time;
        let orders = self.desks[0].come(now);
        for message in said.into_iter().chain(orders) {
            self.bridge.receive(&mut self.supervisor, &message.topic, &message.payload, now);
        }
        let events = self.supervisor.settle(now)?;
        self.bridge.settled(&mut self.supervisor, &events, now);
        let more = self.supervisor.settle(now)?;
        self.bridge.told(&more);
        self.note(events.iter().chain(&more));
        self.log.extend(self.bridge.log());
        for message in self.bridge.out() {
            self.deliver(message);
        }
        Ok(())
    }

    fn note<'a>(&mut self, events: impl Iterator<Item = &'a Event>) {
        let now = self.time;
        self.log.extend(events.map(|event| format!("{now:.2} {event:?}")));
    }

    /// What the manager makes of it.
    fn managed(&mut self) {
        let now = self.time;
        let is_alone = self.settings.method != Method::Supervisor;
        let from = self.interfaces[usize::from(is_alone)].clone();
        let mut due = Vec::new();
        for message in self.desks[1].come(now) {
            let Some((_, key, Kind::State)) = from.parse(&message.topic) else { continue };
            due.extend(self.manager.receive(&key, &message.payload, now));
        }
        for Sent { key, version, payload } in due {
            let topic = from.topic(version, &key, Kind::Order);
            let message = Publish { topic, payload, assured: false, retain: false };
            match is_alone {
                true => self.deliver(message),
                false => self.desks[0].send(message, now),
            }
        }
    }

    fn deliver(&mut self, message: Publish) {
        let now = self.time;
        let Some((_, key, kind)) = self.interfaces[1].parse(&message.topic) else {
            return self.desks[1].send(message, now);
        };
        if let Some(member) = self.members.iter_mut().find(|member| *member.vehicle.key() == key) {
            member.incoming.send((kind, message.payload), now);
        }
    }

    /// The supervisor is killed, and another one goes on in its place.
    ///
    /// # Errors
    /// As [`Bridge::new`].
    pub fn revive(&mut self, supervisor: Supervisor) -> Result<(), Damaged> {
        self.bridge = bridge(&self.interfaces, &self.profiles, &supervisor)?;
        self.supervisor = supervisor;
        self.bridge.greet();
        Ok(())
    }

    /// Goes on until everybody has done what it had to do, and no more; how many have not within a time \[s\].
    ///
    /// # Errors
    /// As [`Yard::step`].
    pub fn drain(&mut self, time: f64) -> Result<usize, Failed> {
        self.manager.end();
        let until = self.time + time;
        while self.time < until && self.manager.busy().next().is_some() {
            self.step()?;
        }
        Ok(self.manager.busy().count())
    }

    /// Time of the vehicles \[s\].
    pub fn time(&self) -> f64 {
        self.time
    }

    /// Times that connections were lost.
    pub fn drops(&self) -> u64 {
        self.drops
    }

    /// The longest that a vehicle with something to do has stood \[s\].
    pub fn longest(&self) -> f64 {
        self.longest
    }

    /// Whether two had the right to one place.
    pub fn audit(&self) -> &Audit {
        &self.audit
    }

    /// Who gives missions.
    pub fn manager(&self) -> &Manager {
        &self.manager
    }

    /// Who keeps vehicles apart, and how it talks to them.
    pub fn supervised_by(&self) -> (&Supervisor, &Bridge) {
        (&self.supervisor, &self.bridge)
    }

    /// The vehicles.
    pub fn vehicles_mut(&mut self) -> impl Iterator<Item = &mut Vehicle> {
        self.members.iter_mut().map(|member| &mut member.vehicle)
    }

    /// What was said by the supervisor, and why messages were refused.
    pub fn log(&self) -> &[String] {
        &self.log
    }

    /// The record is whole.
    ///
    /// # Errors
    /// As its writer.
    pub fn close(self) -> io::Result<W> {
        self.record.finish()
    }
}

fn bridge(
    [manager, vehicles]: &[Interface; 2],
    profiles: &[Profile],
    supervisor: &Supervisor,
) -> Result<Bridge, Damaged> {
    let settings = bridge::Settings { manager: manager.clone(), vehicles: vehicles.clone(), limits: Limits::default() };
    Bridge::new(settings, profiles.to_vec(), supervisor)
}
