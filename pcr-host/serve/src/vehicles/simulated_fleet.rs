//! Simulated vehicles at a broker, each with a connection of its own.

use super::lossy_channel::{ChannelFaults, LossyChannel};
use super::record::{RecordVehicle, RecordWriter};
use super::release_audit::ReleaseAudit;
use super::vehicle::SimulatedVehicle;
use crate::setup_error::SetupError;
use crate::vda5050::bridge::MqttMessage;
use crate::vda5050::mqtt::{BrokerAddress, LinkEvent, MqttLink};
use pcr_formats::splitmix64::SplitMix64;
use pcr_formats::vda5050::topics::{TopicInterface, TopicKind};
use std::io::{self, Write};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::time::Instant;

/// Settings. Times are those of the vehicles, which may be faster than real time.
#[derive(Clone, Debug)]
pub struct SimulatedFleetConfig {
    /// The broker.
    pub broker: BrokerAddress,
    /// Topics of the vehicles.
    pub interface: TopicInterface,
    /// Seconds of the vehicles per second of real time.
    pub pace: f64,
    /// Positions that each vehicle sends per second of real time.
    pub positions: f64,
    /// States that each vehicle sends per second of real time without any news.
    pub states: f64,
    /// Number of times that each vehicle loses its connection per second of real time.
    pub drops: f64,
    /// Faults of the transport of messages.
    pub climate: ChannelFaults,
    /// Seed. The same seed makes the same vehicles, but not the same run.
    pub seed: u64,
}

struct FleetMember {
    vehicle: SimulatedVehicle,
    link: Option<MqttLink>,
    /// Time at which it connects again \[s\].
    again: f64,
    incoming: LossyChannel<(TopicKind, Vec<u8>)>,
    outgoing: LossyChannel<MqttMessage>,
    last_message_at: [f64; 2],
}

/// Vehicles at a broker.
pub struct SimulatedFleet<W: Write> {
    settings: SimulatedFleetConfig,
    members: Vec<FleetMember>,
    news: Receiver<(usize, LinkEvent)>,
    sender: Sender<(usize, LinkEvent)>,
    record: RecordWriter<W>,
    random: SplitMix64,
    begin: Instant,
    /// Time of the last step \[s\].
    last: f64,
    /// Time of the vehicles \[s\].
    time: f64,
    /// Number of lost connections.
    drops: u64,
    /// Whether the broker has ever been reached, and why not the last time.
    met: bool,
    why: Option<String>,
    audit: ReleaseAudit,
}

/// Largest step of the vehicles \[s\].
const STEP: f64 = 0.05;

/// Largest time of the vehicles between two looks at messages, also on a busy machine \[s\].
const LEAP: f64 = 1.0;

/// Longest time without a connection \[s\].
const AWAY: f64 = 3.0;

impl<W: Write> SimulatedFleet<W> {
    /// Connects the vehicles, and records their true positions.
    ///
    /// # Errors
    /// Those of the writer of the record, or invalid settings of the broker.
    pub fn new(settings: SimulatedFleetConfig, vehicles: Vec<SimulatedVehicle>, record: W) -> io::Result<Self> {
        let names = vehicles.iter().map(RecordVehicle::of);
        let record = RecordWriter::new(record, &names.collect::<Vec<_>>())?;
        let (sender, news) = channel();
        let random = SplitMix64(settings.seed);
        let members = vehicles.into_iter().enumerate().map(|(k, vehicle)| {
            let seed = settings.seed.wrapping_add(k as u64);
            let (incoming, outgoing) =
                (LossyChannel::new(settings.climate, seed), LossyChannel::new(settings.climate, !seed));
            let told = [k as f64 * 0.001; 2];
            FleetMember { vehicle, link: None, again: 0.0, incoming, outgoing, last_message_at: told }
        });
        let members = members.collect();
        Ok(Self {
            settings,
            members,
            news,
            sender,
            record,
            random,
            begin: Instant::now(),
            last: 0.0,
            time: 0.0,
            drops: 0,
            met: false,
            why: None,
            audit: ReleaseAudit::default(),
        })
    }

    /// Time of the vehicles \[s\].
    pub fn time(&self) -> f64 {
        self.time
    }

    /// Number of connections that were broken on purpose.
    pub fn drops(&self) -> u64 {
        self.drops
    }

    /// Why the broker was not reached the last time, if no vehicle has ever reached it.
    pub fn unreached(&self) -> Option<&str> {
        self.why.as_deref().filter(|_| !self.met)
    }

    /// The audit whether two vehicles had the right to one place.
    pub fn audit(&self) -> &ReleaseAudit {
        &self.audit
    }

    /// The vehicles.
    pub fn vehicles_mut(&mut self) -> impl Iterator<Item = &mut SimulatedVehicle> {
        self.members.iter_mut().map(|member| &mut member.vehicle)
    }

    /// Changes the faults of the transport.
    pub fn change(&mut self, climate: ChannelFaults) {
        for member in &mut self.members {
            member.incoming.change(climate);
            member.outgoing.change(climate);
        }
    }

    /// Simulates up to the present time: messages, motions, messages.
    ///
    /// # Errors
    /// Those of the writer of the record, or a thread for a connection that cannot be started.
    pub fn step(&mut self) -> io::Result<()> {
        let now = self.begin.elapsed().as_secs_f64();
        while let Ok((k, news)) = self.news.try_recv() {
            let Some(member) = self.members.get_mut(k) else { continue };
            match news {
                LinkEvent::Up => {
                    self.met = true;
                    member.vehicle.tell_online();
                    member.vehicle.tell_factsheet();
                    member.vehicle.tell_state();
                }
                LinkEvent::Down(why) => self.why = Some(why),
                LinkEvent::Message { topic, payload, .. } => {
                    if let Some((_, key, kind)) = self.settings.interface.parse(&topic)
                        && key == *member.vehicle.key()
                    {
                        member.incoming.send((kind, payload), now);
                    }
                }
            }
        }
        let time = ((now - self.last) * self.settings.pace).clamp(0.0, LEAP);
        self.last = now;
        let steps = (time / STEP).ceil().max(1.0);
        let step = time / steps;
        for _ in 0..steps as u64 {
            self.time += step;
            for (k, member) in self.members.iter_mut().enumerate() {
                member.vehicle.advance(step);
                self.record.push(k, self.time, member.vehicle.true_position(), member.vehicle.heading())?;
            }
        }
        for k in 0..self.members.len() {
            self.talk(k, now)?;
        }
        self.audit.observe(self.time, self.members.iter().map(|member| &member.vehicle));
        Ok(())
    }

    fn talk(&mut self, k: usize, now: f64) -> io::Result<()> {
        let Self { settings, members, sender, random, drops, .. } = self;
        let Some(member) = members.get_mut(k) else { return Ok(()) };
        if member.link.is_some() && settings.drops > 0.0 && random.happens(settings.drops, 0.01) {
            member.link = None;
            member.again = now + AWAY * random.unit();
            *drops += 1;
        }
        if member.link.is_none() && now >= member.again {
            member.link = Some(connected(settings, &mut member.vehicle, k, sender.clone()).map_err(io::Error::other)?);
        }
        for (kind, payload) in member.incoming.take_arrived(now) {
            member.vehicle.receive(kind, &payload);
        }
        if now >= member.last_message_at[0] && settings.positions > 0.0 {
            member.last_message_at[0] = now + 1.0 / settings.positions;
            member.vehicle.tell_position();
        }
        if now >= member.last_message_at[1] && settings.states > 0.0 {
            member.last_message_at[1] = now + 1.0 / settings.states;
            member.vehicle.tell_state();
        }
        let version = member.vehicle.version();
        for (kind, payload) in member.vehicle.out() {
            let topic = settings.interface.topic(version, member.vehicle.key(), kind);
            let message = MqttMessage { topic, payload, at_least_once: kind.is_assured(), retain: kind.is_retained() };
            member.outgoing.send(message, now);
        }
        for message in member.outgoing.take_arrived(now) {
            if let Some(link) = &member.link {
                let _ = link.publish(message);
            }
        }
        Ok(())
    }

    /// Ends all connections properly, and completes the record.
    ///
    /// # Errors
    /// As the writer of the record.
    pub fn close(mut self) -> io::Result<W> {
        for member in &mut self.members {
            if let Some(link) = member.link.take() {
                let payload = member.vehicle.connection("OFFLINE");
                let topic = self.settings.interface.topic(
                    member.vehicle.version(),
                    member.vehicle.key(),
                    TopicKind::Connection,
                );
                let _ = link.publish(MqttMessage { topic, payload, at_least_once: true, retain: true });
                link.close();
            }
        }
        self.record.finish()
    }
}

fn connected(
    settings: &SimulatedFleetConfig,
    vehicle: &mut SimulatedVehicle,
    k: usize,
    sender: Sender<(usize, LinkEvent)>,
) -> Result<MqttLink, SetupError> {
    let (key, version) = (vehicle.key().clone(), vehicle.version());
    let topic = |kind: TopicKind| settings.interface.topic(version, &key, kind);
    let filters = [TopicKind::Order, TopicKind::InstantActions].map(topic).to_vec();
    let payload = vehicle.connection(version.broken());
    let will = MqttMessage { topic: topic(TopicKind::Connection), payload, at_least_once: true, retain: true };
    let id = format!("pcr-vehicle-{}-{}", key.manufacturer, key.serial_number);
    MqttLink::open(&settings.broker, &id, Some(will), filters, move |news| {
        // A fleet that has been dropped needs no news.
        let _ = sender.send((k, news));
    })
}
