//! Vehicles, their manager and a supervisor without a broker, in steps of simulated time: the same seed gives the same
//! run on any machine.

use super::edge_reservations::VehicleCoordination;
use super::lossy_channel::{ChannelFaults, LossyChannel};
use super::manager::{FleetManager, OutgoingMessage};
use super::record::{RecordVehicle, RecordWriter};
use super::release_audit::ReleaseAudit;
use super::simulated_site::SimulatedSite;
use super::vehicle::SimulatedVehicle;
use crate::event::SupervisorEvent;
use crate::request_error::RequestError;
use crate::supervisor::{JournalError, Supervisor};
use crate::vda5050::bridge::{self, MqttMessage, Vda5050Bridge};
use crate::vda5050::vehicle_adapter::VehicleConfig;
use pcr_formats::splitmix64::SplitMix64;
use pcr_formats::vda5050::decode::MessageLimits;
use pcr_formats::vda5050::topics::{TopicInterface, TopicKind};
use std::io::{self, Write};

/// Settings.
#[derive(Clone, Copy, Debug)]
pub struct OfflineConfig {
    /// Method that keeps vehicles apart.
    pub method: VehicleCoordination,
    /// Faults of the transport of messages.
    pub climate: ChannelFaults,
    /// Number of times that each vehicle loses its connection per second; each is back within half a minute.
    pub drops: f64,
    /// A step of time \[s\].
    pub step: f64,
    /// Seed: the same seed gives the same run.
    pub seed: u64,
}

/// The reason why a step failed.
#[derive(Debug)]
pub enum StepError {
    /// The journal could not be written. The results of the step were not sent; [`OfflineSimulation::revive`] continues.
    Journal(RequestError),
    /// The record could not be written.
    Record(io::Error),
}

impl From<RequestError> for StepError {
    fn from(fault: RequestError) -> Self {
        Self::Journal(fault)
    }
}

struct OfflineVehicle {
    vehicle: SimulatedVehicle,
    incoming: LossyChannel<(TopicKind, Vec<u8>)>,
    outgoing: LossyChannel<MqttMessage>,
    /// Times of its next position and state \[s\].
    next: [f64; 2],
    /// Time until which it is not connected \[s\].
    away: f64,
    /// Number of its orders taken, its length of the way \[m\], and the time since which these have not changed \[s\].
    still: (u64, f64, f64),
}

/// Vehicles, manager and supervisor.
pub struct OfflineSimulation<W: Write> {
    settings: OfflineConfig,
    interfaces: [TopicInterface; 2],
    members: Vec<OfflineVehicle>,
    manager: FleetManager,
    /// Messages from the manager, and to it.
    desks: [LossyChannel<MqttMessage>; 2],
    supervisor: Supervisor,
    bridge: Vda5050Bridge,
    profiles: Vec<VehicleConfig>,
    record: RecordWriter<W>,
    random: SplitMix64,
    audit: ReleaseAudit,
    time: f64,
    /// Number of lost connections, and the longest time that a vehicle with an order stood \[s\].
    drops: u64,
    longest: f64,
    log: Vec<String>,
}

/// Longest time without a connection \[s\].
const AWAY: f64 = 30.0;

/// Pause between two positions, and between two states without news, of a vehicle \[s\].
const PAUSES: [f64; 2] = [1.0, 5.0];

impl<W: Write> OfflineSimulation<W> {
    /// A yard with a new supervisor, and a record of the true positions.
    ///
    /// # Errors
    /// Those of the writer of the record, and invalid topics.
    pub fn new(
        world: SimulatedSite,
        interfaces: [TopicInterface; 2],
        settings: OfflineConfig,
        supervisor: Supervisor,
        record: W,
    ) -> io::Result<Self> {
        let SimulatedSite { profiles, vehicles, manager } = world;
        let names = vehicles.iter().map(RecordVehicle::of);
        let record = RecordWriter::new(record, &names.collect::<Vec<_>>())?;
        let bridge = bridge(&interfaces, &profiles, &supervisor).map_err(io::Error::other)?;
        let OfflineConfig { method, climate, seed, .. } = settings;
        let members = vehicles.into_iter().enumerate().map(|(k, vehicle)| {
            let own = 1_000 * seed + 2 * k as u64;
            let (incoming, outgoing) = (LossyChannel::new(climate, own), LossyChannel::new(climate, own + 1));
            let (next, still) = ([0.1 * k as f64; 2], (0, 0.0, 0.0));
            OfflineVehicle { vehicle, incoming, outgoing, next, away: 0.0, still }
        });
        let (members, random) = (members.collect(), SplitMix64(seed));
        let desks = [500, 501].map(|k| LossyChannel::new(climate, 1_000 * seed + k));
        let (manager, audit, log) = (manager.with_coordination(method), ReleaseAudit::default(), Vec::new());
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

    /// Simulates a step.
    ///
    /// # Errors
    /// [`StepError`].
    pub fn step(&mut self) -> Result<(), StepError> {
        let own = &mut *self;
        own.time += own.settings.step;
        let (now, step) = (own.time, own.settings.step);
        for (k, member) in own.members.iter_mut().enumerate() {
            member.vehicle.advance(step);
            let (place, heading) = (member.vehicle.true_position(), member.vehicle.heading());
            own.record.push(k, now, place, heading).map_err(StepError::Record)?;
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
                member.outgoing.send(MqttMessage { topic, payload, at_least_once: false, retain: false }, now);
            }
        }
        own.audit.observe(now, own.members.iter().map(|member| &member.vehicle));
        own.stand();
        let said = self.take_messages();
        let settled = match self.settings.method {
            VehicleCoordination::Supervisor => self.supervised(said),
            _ => {
                said.into_iter().for_each(|message| self.desks[1].send(message, now));
                Ok(())
            }
        };
        self.managed();
        for member in &mut self.members {
            for (kind, payload) in member.incoming.take_arrived(now) {
                if now >= member.away {
                    member.vehicle.receive(kind, &payload);
                }
            }
        }
        Ok(settled?)
    }

    /// Updates how long vehicles with an order have stood.
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

    /// Takes the messages of the vehicles.
    fn take_messages(&mut self) -> Vec<MqttMessage> {
        let now = self.time;
        let come = self.members.iter_mut().flat_map(|member| {
            let away = now < member.away;
            member.outgoing.take_arrived(now).into_iter().filter(move |_| !away)
        });
        come.collect()
    }

    /// Lets the supervisor handle messages of the vehicles and of the manager.
    fn supervised(&mut self, said: Vec<MqttMessage>) -> Result<(), RequestError> {
        let now = self.time;
        let orders = self.desks[0].take_arrived(now);
        for message in said.into_iter().chain(orders) {
            self.bridge.receive(&mut self.supervisor, &message.topic, &message.payload, now);
        }
        let events = self.supervisor.settle(now)?;
        self.bridge.settled(&mut self.supervisor, &events, now);
        let more = self.supervisor.settle(now)?;
        self.bridge.on_events(&more);
        self.note(events.iter().chain(&more));
        self.log.extend(self.bridge.log());
        for message in self.bridge.out() {
            self.deliver(message);
        }
        Ok(())
    }

    fn note<'a>(&mut self, events: impl Iterator<Item = &'a SupervisorEvent>) {
        let now = self.time;
        self.log.extend(events.map(|event| format!("{now:.2} {event:?}")));
    }

    /// Lets the manager handle its messages.
    fn managed(&mut self) {
        let now = self.time;
        let is_alone = self.settings.method != VehicleCoordination::Supervisor;
        let from = self.interfaces[usize::from(is_alone)].clone();
        let mut due = Vec::new();
        for message in self.desks[1].take_arrived(now) {
            let Some((_, key, TopicKind::State)) = from.parse(&message.topic) else { continue };
            due.extend(self.manager.receive(&key, &message.payload, now));
        }
        for OutgoingMessage { key, version, payload } in due {
            let topic = from.topic(version, &key, TopicKind::Order);
            let message = MqttMessage { topic, payload, at_least_once: false, retain: false };
            match is_alone {
                true => self.deliver(message),
                false => self.desks[0].send(message, now),
            }
        }
    }

    fn deliver(&mut self, message: MqttMessage) {
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
    /// As [`Vda5050Bridge::new`].
    pub fn revive(&mut self, supervisor: Supervisor) -> Result<(), JournalError> {
        self.bridge = bridge(&self.interfaces, &self.profiles, &supervisor)?;
        self.supervisor = supervisor;
        self.bridge.greet(self.time);
        Ok(())
    }

    /// Simulates without new missions until all are done; returns how many vehicles have not finished after a time \[s\].
    ///
    /// # Errors
    /// As [`OfflineSimulation::step`].
    pub fn drain(&mut self, time: f64) -> Result<usize, StepError> {
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

    /// Number of lost connections.
    pub fn drops(&self) -> u64 {
        self.drops
    }

    /// Longest time that a vehicle with an order has stood \[s\].
    pub fn longest(&self) -> f64 {
        self.longest
    }

    /// The audit whether two vehicles had the right to one place.
    pub fn audit(&self) -> &ReleaseAudit {
        &self.audit
    }

    /// The manager that gives missions.
    pub fn manager(&self) -> &FleetManager {
        &self.manager
    }

    /// The supervisor, and the bridge that connects it.
    pub fn supervised_by(&self) -> (&Supervisor, &Vda5050Bridge) {
        (&self.supervisor, &self.bridge)
    }

    /// The vehicles.
    pub fn vehicles_mut(&mut self) -> impl Iterator<Item = &mut SimulatedVehicle> {
        self.members.iter_mut().map(|member| &mut member.vehicle)
    }

    /// Events of the supervisor, and reasons why messages were refused.
    pub fn log(&self) -> &[String] {
        &self.log
    }

    /// Completes the record.
    ///
    /// # Errors
    /// As its writer.
    pub fn close(self) -> io::Result<W> {
        self.record.finish()
    }
}

fn bridge(
    [manager, vehicles]: &[TopicInterface; 2],
    profiles: &[VehicleConfig],
    supervisor: &Supervisor,
) -> Result<Vda5050Bridge, JournalError> {
    let settings =
        bridge::BridgeConfig { manager: manager.clone(), vehicles: vehicles.clone(), limits: MessageLimits::default() };
    Vda5050Bridge::new(settings, profiles.to_vec(), supervisor)
}
