//! Faults, one after the other: nobody touches anybody, and work goes on afterwards.

use crate::broker::{Mosquitto, folder};
use crate::runs::FAIR;
use crate::site::{Desk, SAFE, Scene, Site, nodes, settings, warehouse};
use pcr_serve::entry::Nowhere;
use pcr_serve::journal::Journal;
use pcr_serve::supervisor::Supervisor;
use pcr_serve::vda5050::bridge::Publish;
use pcr_serve::vda5050::mqtt::{Broker, Link};
use pcr_serve::vda5050::version::Version;
use pcr_serve::vehicles::weather::Climate;
use pcr_serve::vehicles::world::World;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

const SCENE: Scene<'_> = Scene { count: 6, versions: &Version::ALL, drops: 0.01, ..FAIR };

/// A supervisor in a process of its own, so that it can be killed.
struct Desks {
    port: u16,
    journal: String,
    session: u32,
    child: Child,
}

impl Desks {
    fn open(broker: &Broker, journal: &Path) -> Self {
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
    let world = World::new(layout, goals, SCENE.count, SCENE.versions, SCENE.abilities, 1).unwrap();
    let (journal, found) = Journal::open(Path::new(&journal)).unwrap();
    let supervisor = Supervisor::restored(settings(), found.entries, Box::new(journal)).unwrap();
    let desk = Desk::at(&Broker::new("127.0.0.1", port), world.profiles, &session, supervisor);
    while !desk.is_over() {
        std::thread::sleep(Duration::from_millis(20));
    }
    panic!("{:?}", desk.close());
}

/// Sends what nobody should.
fn nonsense(broker: &Broker) {
    let link = Link::open(broker, "intruder", None, Vec::new(), drop).unwrap();
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
                    while !link.publish(Publish {
                        topic: topic.clone(),
                        payload: payload.into(),
                        assured: false,
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

#[test]
#[ignore = "needs a broker: .ci/test.sh serve"]
fn faults_one_after_the_other() {
    // For hours: PCR_FAULTS=1000.
    let rounds: u64 = std::env::var("PCR_FAULTS").ok().map_or(1, |rounds| rounds.parse().unwrap());
    let mut broker = Mosquitto::start("faults");
    let (mut site, profiles) = Site::open(&broker, SCENE);
    let mut desks = Desks::open(&broker.address(), &folder("faults-journal"));
    site.until(3);
    for round in 0..rounds {
        let mut next = site.office.manager.done();
        let mut goes_on = |site: &mut Site, what: &str| {
            next = site.office.manager.done() + 4;
            site.until(next);
            eprintln!("round {round}: work goes on after {what}");
        };
        broker.restart();
        goes_on(&mut site, "the broker began anew");
        desks.kill();
        goes_on(&mut site, "the supervisor was killed");
        site.lasts(Duration::from_millis(300));
        desks.kill();
        broker.restart();
        goes_on(&mut site, "both at once");
        site.fleet.vehicles_mut().step_by(2).for_each(|vehicle| vehicle.freeze(30.0));
        goes_on(&mut site, "vehicles were frozen");
        site.fleet.vehicles_mut().step_by(2).for_each(|vehicle| vehicle.set_clock(60.0));
        site.fleet.vehicles_mut().skip(1).step_by(2).for_each(|vehicle| vehicle.set_clock(-60.0));
        goes_on(&mut site, "clocks were off by a minute");
        site.fleet.vehicles_mut().for_each(|vehicle| vehicle.set_clock(0.0));
        goes_on(&mut site, "clocks were right again");
        // 3 s of ours are 30 s of theirs.
        site.fleet.change(Climate { lost: 0.05, twice: 0.2, late: 0.2, delay: 3.0 });
        goes_on(&mut site, "messages came late, twice, or not at all");
        site.fleet.change(FAIR.climate);
        nonsense(&broker.address());
        goes_on(&mut site, "nonsense");
        if round == 0 {
            let second = Desk::open(&broker, profiles.clone(), "second", Box::new(Nowhere));
            while !second.is_over() {
                site.step();
            }
            let why = second.close().unwrap_err().0;
            assert!(why.contains("another supervisor"), "{why}");
            goes_on(&mut site, "a second supervisor was refused");
        }
    }
    let found = site.close();
    eprintln!("{found:?}");
}
