//! A fleet, its manager and its supervisor without a broker, in steps of time: the same seed is the same run, on any machine.

use crate::dump;
use crate::runs::FAIR;
use crate::site::{SAFE, Scene, interfaces, nodes, settings, warehouse};
use pcr_serve::entry::Nowhere;
use pcr_serve::supervisor::Supervisor;
use pcr_serve::vda5050::bridge::{self, Bridge, Publish};
use pcr_serve::vda5050::door::Limits;
use pcr_serve::vda5050::lane::Profile;
use pcr_serve::vda5050::topics::{Interface, Kind};
use pcr_serve::vda5050::version::Version;
use pcr_serve::vehicles::drive::Abilities;
use pcr_serve::vehicles::manager::Manager;
use pcr_serve::vehicles::random::Random;
use pcr_serve::vehicles::record::{Record, Recorded, certify};
use pcr_serve::vehicles::vehicle::Vehicle;
use pcr_serve::vehicles::weather::{Climate, Weather};
use pcr_serve::vehicles::world::World;

/// Of the vehicles \[s\].
const STEP: f64 = 0.05;

/// Nobody needs longer for a mission, whoever is waited for \[s\].
const LONGEST: f64 = 1_800.0;

struct Member {
    vehicle: Vehicle,
    incoming: Weather<(Kind, Vec<u8>)>,
    outgoing: Weather<Publish>,
    /// When it says the next position and state \[s\].
    next: [f64; 2],
    /// Until when it is not connected \[s\].
    away: f64,
}

pub(crate) struct Yard {
    members: Vec<Member>,
    manager: Manager,
    /// Between the manager and the supervisor.
    desks: [Weather<Publish>; 2],
    supervisor: Supervisor,
    bridge: Bridge,
    profiles: Vec<Profile>,
    record: Record<Vec<u8>>,
    random: Random,
    drops: f64,
    time: f64,
    log: Vec<String>,
}

fn bridge(profiles: &[Profile], supervisor: &Supervisor) -> Bridge {
    let [manager, vehicles] = interfaces();
    Bridge::new(bridge::Settings { manager, vehicles, limits: Limits::default() }, profiles.to_vec(), supervisor)
}

impl Yard {
    pub(crate) fn open(scene: Scene<'_>, seed: u64) -> Self {
        let layout = warehouse();
        let goals = nodes(&layout, &SAFE);
        let World { profiles, vehicles, manager } =
            World::new(layout, goals, scene.count, scene.versions, scene.abilities, seed).unwrap();
        let names = vehicles.iter().map(|it| Recorded { name: it.key().to_string(), radius: it.abilities().radius });
        let record = Record::new(Vec::new(), &names.collect::<Vec<_>>()).unwrap();
        let supervisor = Supervisor::new(settings(), Box::new(Nowhere));
        let bridge = bridge(&profiles, &supervisor);
        let members = vehicles.into_iter().enumerate().map(|(k, vehicle)| {
            let own = 1_000 * seed + 2 * k as u64;
            let (incoming, outgoing) = (Weather::new(scene.climate, own), Weather::new(scene.climate, own + 1));
            Member { vehicle, incoming, outgoing, next: [0.1 * k as f64; 2], away: 0.0 }
        });
        let desks = [500, 501].map(|k| Weather::new(scene.climate, 1_000 * seed + k));
        let (members, random) = (members.collect(), Random::new(seed));
        let (drops, log) = (scene.drops, Vec::new());
        Self { members, manager, desks, supervisor, bridge, profiles, record, random, drops, time: 0.0, log }
    }

    fn step(&mut self) {
        let [manager, vehicles] = interfaces();
        self.time += STEP;
        let now = self.time;
        for (k, member) in self.members.iter_mut().enumerate() {
            member.vehicle.advance(STEP);
            self.record.push(k, now, member.vehicle.place()).unwrap();
            if now >= member.away && self.random.happens(self.drops, STEP) {
                member.away = now + 30.0 * self.random.unit();
            }
            if now >= member.next[0] {
                member.next[0] = now + 1.0;
                member.vehicle.tell_position();
            }
            if now >= member.next[1] {
                member.next[1] = now + 5.0;
                member.vehicle.tell_state();
            }
            for (kind, payload) in member.vehicle.out() {
                let topic = vehicles.topic(member.vehicle.version(), member.vehicle.key(), kind);
                member.outgoing.send(Publish { topic, payload, assured: false, retain: false }, now);
            }
            for message in member.outgoing.come(now) {
                if now >= member.away {
                    self.bridge.receive(&mut self.supervisor, &message.topic, &message.payload, now);
                }
            }
        }
        for message in self.desks[0].come(now) {
            self.bridge.receive(&mut self.supervisor, &message.topic, &message.payload, now);
        }
        let mut events = self.supervisor.settle(now).unwrap();
        self.bridge.settled(&mut self.supervisor, &events, now);
        let more = self.supervisor.settle(now).unwrap();
        self.bridge.told(&more);
        events.extend(more);
        self.log.extend(events.iter().map(|event| format!("{now:.2} {event:?}")));
        self.log.extend(self.bridge.log());
        for message in self.bridge.out() {
            self.deliver(message, [&manager, &vehicles]);
        }
        for message in self.desks[1].come(now) {
            let Some((_, key, Kind::State)) = manager.parse(&message.topic) else { continue };
            if let Some((version, payload)) = self.manager.receive(&key, &message.payload, now) {
                let topic = manager.topic(version, &key, Kind::Order);
                self.desks[0].send(Publish { topic, payload, assured: false, retain: false }, now);
            }
        }
        for member in &mut self.members {
            for (kind, payload) in member.incoming.come(now) {
                if now >= member.away {
                    member.vehicle.receive(kind, &payload);
                }
            }
        }
    }

    fn deliver(&mut self, message: Publish, [manager, vehicles]: [&Interface; 2]) {
        if manager.parse(&message.topic).is_some() {
            return self.desks[1].send(message, self.time);
        }
        let (_, key, kind) = vehicles.parse(&message.topic).unwrap();
        let member = self.members.iter_mut().find(|member| *member.vehicle.key() == key).unwrap();
        member.incoming.send((kind, message.payload), self.time);
    }

    /// Goes on until so many missions are done.
    pub(crate) fn until(&mut self, missions: u64) {
        let (mut done, mut since) = (self.manager.done(), self.time);
        while done < missions {
            self.step();
            if self.manager.done() > done {
                (done, since) = (self.manager.done(), self.time);
            }
            if self.time > since + LONGEST {
                let events = self.log.iter().rev().take(40).rev();
                let all = dump::supervised(&self.supervisor, &self.bridge);
                let driven = dump::driven(self.members.iter_mut().map(|member| &mut member.vehicle), &self.manager);
                let lines: Vec<&str> = events.chain(&all).chain(&driven).map(String::as_str).collect();
                panic!("{done} of {missions} missions, and then nothing:\n{}", lines.join("\n"));
            }
        }
    }

    /// The supervisor is killed, and another one goes on with what is in the journal.
    pub(crate) fn restart(&mut self) {
        let entries = self.supervisor.snapshot();
        self.supervisor = Supervisor::restored(settings(), entries, Box::new(Nowhere)).unwrap();
        self.bridge = bridge(&self.profiles, &self.supervisor);
        self.bridge.greet();
    }

    /// Proves that nobody has touched anybody.
    pub(crate) fn close(self) {
        let found = certify(self.record.finish().unwrap().as_slice()).unwrap();
        assert_eq!(found.verdict, "proved", "{found:?}");
    }
}

pub(crate) const SMALL: Abilities = Abilities { radius: 0.3, speed: 1.5, acceleration: 1.0, ..FAIR.abilities[0] };
pub(crate) const SLOW: Abilities = Abilities { delay: 3.0, slip: 0.2, speed: 0.7, ..FAIR.abilities[0] };

/// Eight vehicles, of all editions and three kinds, whose messages are lost, late and repeated.
pub(crate) const MIXED: Scene<'_> = Scene {
    count: 8,
    versions: &Version::ALL,
    abilities: &[FAIR.abilities[0], SMALL, SLOW],
    climate: Climate { lost: 0.05, twice: 0.1, late: 0.1, delay: 10.0 },
    drops: 0.002,
    ..FAIR
};

/// With the first of these seeds everybody stood still after two missions, as the manager sent vehicles past one another's goals: each had
/// to wait until another one had left, for ever.
#[test]
fn work_goes_on_whatever_is_lost() {
    // Others, or more: PCR_SEEDS=0..100.
    let asked = std::env::var("PCR_SEEDS").unwrap_or_else(|_| "0..2".into());
    let (from, to) = asked.split_once("..").unwrap();
    for seed in from.parse::<u64>().unwrap()..to.parse().unwrap() {
        // From bad weather to very bad.
        let Climate { lost, twice, late, delay } = MIXED.climate;
        let times = (1 + 3 * (seed % 2)) as f64;
        let climate = Climate { lost: times * lost, twice: times * twice, late: times * late, delay: times * delay };
        let mut yard = Yard::open(Scene { climate, ..MIXED }, seed);
        for k in 1..=6 {
            yard.until(8 * k);
            if seed % 2 == 1 {
                yard.restart();
            }
        }
        eprintln!("seed {seed}: {} missions in {:.0} s", yard.manager.done(), yard.time);
        yard.close();
    }
}

#[test]
fn goals_on_the_ways_of_others_are_refused() {
    let layout = warehouse();
    // The only way from 77 leads over 76.
    let goals = nodes(&layout, &[77, 76, 0]);
    let refused = World::new(layout, goals, 2, &Version::ALL, FAIR.abilities, 1).unwrap_err();
    assert_eq!(refused, "no way from 0 to 77 keeps 0.944 m from all other goals");
}
