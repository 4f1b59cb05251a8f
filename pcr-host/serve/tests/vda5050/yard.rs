//! A fleet, its manager and its supervisor without a broker, in steps of time: the same seed is the same run, on any machine.

use crate::dump;
use crate::runs::FAIR;
use crate::site::{SAFE, Scene, at_broker, interfaces, nodes, warehouse};
use pcr_formats::vda5050::version::ProtocolVersion;
use pcr_serve::journal_entry::{JournalEntry, JournalStore, NullStore};
use pcr_serve::supervisor::Supervisor;
use pcr_serve::vehicles::edge_reservations::VehicleCoordination;
use pcr_serve::vehicles::lossy_channel::ChannelFaults;
use pcr_serve::vehicles::offline_simulation::{self, OfflineSimulation};
use pcr_serve::vehicles::record::certify;
use pcr_serve::vehicles::simulated_site::SimulatedSite;
use pcr_serve::vehicles::vehicle_motion::SimulatedTraits;
use std::io;
use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};
use std::sync::{Arc, Mutex};

/// Nobody needs longer for a mission, whoever is waited for \[s\].
const LONGEST: f64 = 1_800.0;

fn open(
    scene: Scene<'_>,
    seed: u64,
    method: VehicleCoordination,
    keeper: Box<dyn JournalStore>,
) -> OfflineSimulation<Vec<u8>> {
    let layout = warehouse();
    let goals = nodes(&layout, &SAFE);
    let world = SimulatedSite::new(layout, goals, scene.count, scene.versions, scene.abilities, seed).unwrap();
    let own =
        offline_simulation::OfflineConfig { method, climate: scene.climate, drops: scene.drops, step: 0.05, seed };
    OfflineSimulation::new(world, interfaces(), own, Supervisor::new(at_broker(), keeper), Vec::new()).unwrap()
}

/// Goes on until so many missions are done; `fails` is what happens where the journal does.
fn until(yard: &mut OfflineSimulation<Vec<u8>>, missions: u64, mut fails: impl FnMut(&mut OfflineSimulation<Vec<u8>>)) {
    let (mut done, mut since) = (yard.manager().done(), yard.time());
    while done < missions {
        if yard.step().is_err() {
            fails(yard);
        }
        if yard.manager().done() > done {
            (done, since) = (yard.manager().done(), yard.time());
        }
        if yard.time() > since + LONGEST {
            let events: Vec<String> = yard.log().iter().rev().take(40).rev().cloned().collect();
            let (supervisor, bridge) = yard.supervised_by();
            let mut lines = [events, dump::supervised(supervisor, bridge)].concat();
            let orders = dump::ordered(yard.manager());
            lines.extend(yard.vehicles_mut().map(dump::driven));
            panic!("{done} of {missions} missions, and then nothing:\n{}", [lines, orders].concat().join("\n"));
        }
    }
}

/// The supervisor is killed, and another one goes on with what is in the journal.
fn restart(yard: &mut OfflineSimulation<Vec<u8>>) {
    let entries = yard.supervised_by().0.snapshot().unwrap();
    yard.revive(Supervisor::restored(at_broker(), entries, Box::new(NullStore)).unwrap()).unwrap();
}

/// Proves that nobody has touched anybody, and that nobody ever had the right to.
fn close(yard: OfflineSimulation<Vec<u8>>) {
    assert!(yard.audit().looks > 10 && yard.audit().twice == 0, "{:?}", yard.audit());
    let found = certify(yard.close().unwrap().as_slice()).unwrap();
    assert_eq!(found.verdict, "proved", "{found:?}");
}

pub(crate) const SMALL: SimulatedTraits =
    SimulatedTraits { radius: 0.3, speed: 1.5, acceleration: 1.0, ..FAIR.abilities[0] };
pub(crate) const SLOW: SimulatedTraits = SimulatedTraits { delay: 3.0, slip: 0.2, speed: 0.7, ..FAIR.abilities[0] };

/// Eight vehicles, of all editions and three kinds, whose messages are lost, late and repeated.
pub(crate) const MIXED: Scene<'_> = Scene {
    count: 8,
    versions: &ProtocolVersion::ALL,
    abilities: &[FAIR.abilities[0], SMALL, SLOW],
    climate: ChannelFaults { loss_rate: 0.05, duplicate_rate: 0.1, reorder_rate: 0.1, delay: 10.0 },
    drops: 0.002,
    ..FAIR
};

/// These seeds. Others, or more: PCR_SEEDS=0..100.
fn seeds(usual: &str) -> Range<u64> {
    let asked = std::env::var("PCR_SEEDS").unwrap_or_else(|_| usual.into());
    let (from, to) = asked.split_once("..").unwrap();
    from.parse().unwrap()..to.parse().unwrap()
}

/// With the first of these seeds everybody stood still after two missions, as the manager sent vehicles past one another's goals: each had
/// to wait until another one had left, for ever.
#[test]
fn work_goes_on_whatever_is_lost() {
    for seed in seeds("0..2") {
        // From bad weather to very bad.
        let ChannelFaults { loss_rate: lost, duplicate_rate: twice, reorder_rate: late, delay } = MIXED.climate;
        let times = (1 + 3 * (seed % 2)) as f64;
        let climate = ChannelFaults {
            loss_rate: times * lost,
            duplicate_rate: times * twice,
            reorder_rate: times * late,
            delay: times * delay,
        };
        let mut yard = open(Scene { climate, ..MIXED }, seed, VehicleCoordination::Supervisor, Box::new(NullStore));
        for k in 1..=6 {
            until(&mut yard, 8 * k, |_| unreachable!());
            if seed % 2 == 1 {
                restart(&mut yard);
            }
        }
        eprintln!("seed {seed}: {} missions in {:.0} s", yard.manager().done(), yard.time());
        close(yard);
    }
}

/// Rectangles of two sizes among discs turn at nodes, with bad messages and restarts: their outlines never touch, which the record proves.
#[test]
fn rectangles_do_their_missions_and_never_touch() {
    let long = SimulatedTraits { rectangle: Some([0.7, 0.36]), ..FAIR.abilities[0] };
    let small = SimulatedTraits { rectangle: Some([0.5, 0.4]), ..SLOW };
    let scene = Scene { abilities: &[long, FAIR.abilities[0], small], ..MIXED };
    for seed in seeds("0..2") {
        let mut yard = open(scene, seed, VehicleCoordination::Supervisor, Box::new(NullStore));
        for k in 1..=4 {
            until(&mut yard, 8 * k, |_| unreachable!());
            restart(&mut yard);
        }
        eprintln!("seed {seed}: {} missions in {:.0} s", yard.manager().done(), yard.time());
        let (supervisor, _) = yard.supervised_by();
        assert!(supervisor.robots().iter().all(|robot| !robot.any_heading));
        assert_eq!(supervisor.robots().iter().filter(|robot| robot.abilities.footprint.is_some()).count(), 5);
        close(yard);
    }
}

#[test]
fn goals_on_the_ways_of_others_are_refused() {
    let layout = warehouse();
    // The only way from 77 leads over 76.
    let goals = nodes(&layout, &[77, 76, 0]);
    let refused = SimulatedSite::new(layout, goals, 2, &ProtocolVersion::ALL, FAIR.abilities, 1).unwrap_err();
    assert_eq!(refused.to_string(), "no way from 0 to 77 keeps 0.944 m from all other goals");
}

/// Vehicles are switched off and on again, wherever they are, and have lost their orders: their manager sends them on. With the first of
/// these seeds the manager never saw that one of them had had its order, and sent that for ever.
#[test]
fn vehicles_that_lose_their_orders_get_others() {
    for seed in seeds("3..5") {
        let climate = ChannelFaults { loss_rate: 0.02, duplicate_rate: 0.02, reorder_rate: 0.0, delay: 0.0 };
        let mut yard = open(Scene { climate, ..MIXED }, seed, VehicleCoordination::Supervisor, Box::new(NullStore));
        for round in 1..=10 {
            until(&mut yard, 3 * round, |_| unreachable!());
            yard.vehicles_mut().skip(round as usize % 3).step_by(3).for_each(|vehicle| vehicle.forget());
        }
        until(&mut yard, 40, |_| unreachable!());
        assert!(yard.manager().planned_anew() >= 10, "{seed}: {}", yard.manager().planned_anew());
        assert_eq!(yard.drain(LONGEST).unwrap(), 0, "{seed}");
        close(yard);
    }
}

/// A journal of which every other write is the last one of its supervisor: what it was to hold is there, or not.
#[derive(Clone, Default)]
struct Mortal {
    entries: Arc<Mutex<Vec<JournalEntry>>>,
    writes: Arc<AtomicUsize>,
}

impl JournalStore for Mortal {
    fn keep(&mut self, entries: &[JournalEntry]) -> io::Result<()> {
        let write = self.writes.fetch_add(1, Relaxed);
        if write % 4 != 1 {
            self.entries.lock().unwrap().extend_from_slice(entries);
        }
        if write.is_multiple_of(2) { Ok(()) } else { Err(io::Error::other("killed")) }
    }
}

#[test]
fn a_supervisor_that_is_killed_at_every_other_write() {
    let disc = Mortal::default();
    let mut yard = open(
        Scene { climate: ChannelFaults::default(), ..MIXED },
        4,
        VehicleCoordination::Supervisor,
        Box::new(disc.clone()),
    );
    let mut kills = 0;
    until(&mut yard, 6, |yard| {
        let entries = disc.entries.lock().unwrap().clone();
        yard.revive(Supervisor::restored(at_broker(), entries, Box::new(disc.clone())).unwrap()).unwrap();
        kills += 1;
    });
    eprintln!("killed {kills} times in {:.0} s", yard.time());
    assert!(kills > 100, "{kills}");
    close(yard);
}

/// What the supervisor is compared with: locks keep vehicles apart, too, and let everybody come to its end.
#[test]
fn locks_keep_apart_and_let_everybody_finish() {
    let mut done = Vec::new();
    for method in VehicleCoordination::ALL {
        let mut yard = open(MIXED, 5, method, Box::new(NullStore));
        while yard.time() < 900.0 {
            yard.step().unwrap();
        }
        done.push(yard.manager().done());
        assert_eq!(yard.drain(LONGEST).unwrap(), 0, "{method:?}");
        eprintln!("{method:?}: {done:?}, nobody stood longer than {:.0} s", yard.longest());
        close(yard);
    }
    assert!(done[0] > done[1] && done.iter().all(|done| *done > 10), "{done:?}");
}
