//! Faults, one after the other: nobody touches anybody, and work goes on afterwards.

use crate::broker::{Mosquitto, folder};
use crate::runs::FAIR;
use crate::site::{Desk, SAFE, Scene, Site, at_broker, nodes, warehouse};
use pcr_formats::splitmix64::SplitMix64;
use pcr_formats::vda5050::version::ProtocolVersion;
use pcr_serve::journal::Journal;
use pcr_serve::journal_entry::NullStore;
use pcr_serve::supervisor::Supervisor;
use pcr_serve::vda5050::bridge::MqttMessage;
use pcr_serve::vda5050::mqtt::{BrokerAddress, MqttLink};
use pcr_serve::vehicles::lossy_channel::ChannelFaults;
use pcr_serve::vehicles::simulated_site::SimulatedSite;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

const SCENE: Scene<'_> = Scene { count: 6, versions: &ProtocolVersion::ALL, drops: 0.01, ..FAIR };

/// A supervisor in a process of its own, so that it can be killed.
struct Desks {
    port: u16,
    journal: String,
    session: u32,
    child: Child,
}

impl Desks {
    fn open(broker: &BrokerAddress, journal: &Path) -> Self {
        let (port, journal) = (broker.port, journal.to_string_lossy().into_owned());
        let child = Self::spawn(port, &journal, 0);
        Self { port, journal, session: 0, child }
    }

    fn spawn(port: u16, journal: &str, session: u32) -> Child {
        let mut command = Command::new(std::env::current_exe().unwrap());
        command.args(["--ignored", "--exact", "faults::a_supervisor_of_its_own", "--nocapture"]);
        command.env("PCR_DESK", format!("{port} {session} {journal}"));
        command.stdout(Stdio::null()).spawn().unwrap()
    }

    /// Kills it, and starts another one with its journal.
    fn kill(&mut self) {
        assert!(self.child.try_wait().unwrap().is_none(), "it has ended by itself");
        self.child.kill().unwrap();
        self.child.wait().unwrap();
        self.session += 1;
        self.child = Self::spawn(self.port, &self.journal, self.session);
    }
}

impl Drop for Desks {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// What [`Desks`] starts.
#[test]
#[ignore = "a part of the others"]
fn a_supervisor_of_its_own() {
    let Ok(asked) = std::env::var("PCR_DESK") else { return };
    let mut words = asked.splitn(3, ' ');
    let mut word = || words.next().unwrap();
    let (port, session, journal) = (word().parse().unwrap(), word().to_owned(), word().to_owned());
    let layout = warehouse();
    let goals = nodes(&layout, &SAFE);
    let world = SimulatedSite::new(layout, goals, SCENE.count, SCENE.versions, SCENE.abilities, 1).unwrap();
    let (journal, found) = Journal::open(Path::new(&journal)).unwrap();
    let supervisor = Supervisor::restored(at_broker(), found.entries, Box::new(journal)).unwrap();
    let desk = Desk::at(&BrokerAddress::new("127.0.0.1", port), world.profiles, &session, supervisor);
    while !desk.is_over() {
        std::thread::sleep(Duration::from_millis(20));
    }
    panic!("{:?}", desk.close());
}

/// Sends what nobody should.
fn nonsense(broker: &BrokerAddress) {
    let link = MqttLink::open(broker, "intruder", None, Vec::new(), drop).unwrap();
    while !link.is_up() {
        std::thread::sleep(Duration::from_millis(10));
    }
    let state = r#"{"headerId":1,"timestamp":"2030-01-01T00:00:00Z","version":"9.9.9","manufacturer":"sim","serialNumber":"001"}"#;
    let payloads: [&[u8]; 8] = [
        b"",
        b"{",
        b"\xff\xfe\x00",
        b"[[[[1e999]]]]",
        b"null",
        b"{\"orderId\":null}",
        state.as_bytes(),
        &[b' '; 400_000],
    ];
    for serial in ["001", "002", "003", "unknown"] {
        for version in ["v2", "v3", "v4"] {
            for (prefix, kinds) in [
                ("uagv", &["state", "visualization", "connection", "factsheet", "other"]),
                ("fleet", &["order", "instantActions", "responses", "zoneSet", "order/x"]),
            ] {
                for (kind, payload) in kinds.iter().flat_map(|kind| payloads.map(|payload| (kind, payload))) {
                    let topic = format!("{prefix}/{version}/sim/{serial}/{kind}");
                    while !link.publish(MqttMessage {
                        topic: topic.clone(),
                        payload: payload.into(),
                        at_least_once: false,
                        retain: false,
                    }) {
                        std::thread::sleep(Duration::from_millis(5));
                    }
                }
            }
        }
    }
    link.close();
}

/// How often a fault was, and how long it took at most from its end until a vehicle had an order or an update that it had not had \[s\].
#[derive(Default)]
struct Tally(Vec<(&'static str, u64, f64)>);

impl Tally {
    /// The fault is over: work goes on.
    fn over(&mut self, site: &mut Site, what: &'static str) {
        let taken = |site: &mut Site| site.fleet.vehicles_mut().map(|vehicle| vehicle.taken()).sum::<u64>();
        let (before, since) = (taken(site), Instant::now());
        while taken(site) == before {
            site.step();
            assert!(since.elapsed().as_secs() < 600, "nothing goes on after {what}");
        }
        let time = since.elapsed().as_secs_f64();
        match self.0.iter_mut().find(|(known, ..)| *known == what) {
            Some((_, count, longest)) => (*count, *longest) = (*count + 1, longest.max(time)),
            None => self.0.push((what, 1, time)),
        }
        site.until(site.office.manager.done() + 2);
    }
}

#[test]
#[ignore = "needs a broker: .ci/test.sh serve"]
fn faults_one_after_the_other() {
    /// Messages are as late as this at most \[s\], of ours; ten of the vehicles go by in one.
    const LATE: f64 = 30.0;
    // The numbers of docs/maintain/serve.md: PCR_FAULTS=20, half an hour and more.
    let rounds: u64 = std::env::var("PCR_FAULTS").ok().map_or(1, |rounds| rounds.parse().unwrap());
    let mut broker = Mosquitto::start("faults");
    let (mut site, profiles) = Site::open(&broker, SCENE);
    let mut desks = Desks::open(&broker.address(), &folder("faults-journal"));
    let (mut tally, mut random) = (Tally::default(), SplitMix64(rounds));
    site.until(3);
    for round in 0..rounds {
        broker.restart();
        tally.over(&mut site, "the broker began anew");
        for _ in 0..5 {
            site.lasts(Duration::from_secs_f64(2.0 * random.unit()));
            desks.kill();
            tally.over(&mut site, "the supervisor was killed");
        }
        site.lasts(Duration::from_secs_f64(0.3 * random.unit()));
        desks.kill();
        broker.restart();
        tally.over(&mut site, "both at once");
        site.fleet.vehicles_mut().step_by(2).for_each(|vehicle| vehicle.freeze(30.0));
        site.lasts(Duration::from_secs(3));
        tally.over(&mut site, "half of the vehicles were frozen");
        site.fleet.vehicles_mut().skip(round as usize % 2).step_by(2).for_each(|vehicle| vehicle.forget());
        tally.over(&mut site, "half of the vehicles were switched off and on, and had lost their orders");
        site.fleet.vehicles_mut().step_by(2).for_each(|vehicle| vehicle.set_clock(60.0));
        site.fleet.vehicles_mut().skip(1).step_by(2).for_each(|vehicle| vehicle.set_clock(-60.0));
        tally.over(&mut site, "clocks were set off by a minute");
        site.fleet.vehicles_mut().for_each(|vehicle| vehicle.set_clock(0.0));
        tally.over(&mut site, "clocks were set right");
        nonsense(&broker.address());
        tally.over(&mut site, "nonsense");
        if round % 10 == 0 {
            let second = Desk::open(&broker, profiles.clone(), "second", Box::new(NullStore));
            while !second.is_over() {
                site.step();
            }
            let why = second.close().unwrap_err().to_string();
            assert!(why.contains("another supervisor"), "{why}");
            tally.over(&mut site, "a second supervisor was refused");
        }
        // As bad as that it does not go on in peace; what is late has come before it is over.
        site.fleet.change(ChannelFaults { loss_rate: 0.05, duplicate_rate: 0.2, reorder_rate: 0.2, delay: LATE });
        site.lasts(Duration::from_secs(20));
        site.fleet.change(FAIR.climate);
        site.lasts(Duration::from_secs_f64(LATE));
        tally.over(&mut site, "messages came 30 s late, twice, in any order, or not at all");
        eprintln!("round {round}: {} missions done", site.office.manager.done());
        for (what, count, longest) in &tally.0 {
            eprintln!("{count} times {what}: on after {longest:.2} s at most");
        }
    }
    let worst = tally.0.iter().max_by(|a, b| a.2.total_cmp(&b.2));
    let (what, _, longest) = worst.expect("some faults");
    let count: u64 = tally.0.iter().map(|(_, count, _)| count).sum();
    eprintln!("worst of {count} faults in {rounds} rounds: on after {longest:.2} s ({what})");
    let anew = site.office.manager.planned_anew();
    assert!(anew > 0);
    eprintln!("{anew} orders were planned anew");
    let audit = site.fleet.audit().clone();
    assert!(audit.looks > 0 && audit.twice == 0, "{audit:?}");
    eprintln!("{audit:?}\n{:?}", site.close());
}

/// Of supervisors that begin at one time, whichever they are, one goes on.
#[test]
#[ignore = "needs a broker: .ci/test.sh serve"]
fn of_supervisors_that_begin_at_once_one_goes_on() {
    let broker = Mosquitto::start("at-once");
    for round in 0..5 {
        let names = ["a", "b", "c"].map(|name| format!("{name}{round}"));
        let mut all: Vec<Desk> =
            names.iter().map(|name| Desk::open(&broker, Vec::new(), name, Box::new(NullStore))).collect();
        while all.iter().filter(|desk| !desk.is_over()).count() > 1 {
            std::thread::sleep(Duration::from_millis(20));
        }
        let (ended, mut on): (Vec<Desk>, Vec<Desk>) = all.drain(..).partition(Desk::is_over);
        for desk in ended {
            let why = desk.close().unwrap_err().to_string();
            assert!(why.contains("another supervisor"), "{why}");
        }
        let on = on.pop().expect("one of them");
        while !on.tell().contains("ours: true") {
            std::thread::sleep(Duration::from_millis(20));
        }
        // The message of those who have ended is that they have; whoever comes now is told all the same.
        let late = Desk::open(&broker, Vec::new(), "late", Box::new(NullStore));
        while !late.is_over() {
            std::thread::sleep(Duration::from_millis(20));
        }
        assert!(late.close().unwrap_err().to_string().contains("another supervisor") && !on.is_over());
        on.close().unwrap();
    }
}
