//! A fleet, its manager and its supervisor at a broker, in one process.

use crate::broker::Mosquitto;
use crate::dump;
use pcr_formats::import::{ImportOptions, ImportedLayout, InputFormat, Layout, Warnings, layout};
use pcr_formats::vda5050::decode::MessageLimits;
use pcr_formats::vda5050::topics::TopicInterface;
use pcr_formats::vda5050::version::ProtocolVersion;
use pcr_serve::journal_entry::JournalStore;
use pcr_serve::journal_writer::WriteProgress;
use pcr_serve::log::{LogLevel, LogWriter};
use pcr_serve::server::{ServerInput, queue, serve};
use pcr_serve::supervisor::{Supervisor, SupervisorConfig};
use pcr_serve::vda5050::bridge::{self, Vda5050Bridge};
use pcr_serve::vda5050::broker_session::{BrokerSession, SessionEnd};
use pcr_serve::vda5050::mqtt::BrokerAddress;
use pcr_serve::vda5050::vehicle_adapter::VehicleConfig;
use pcr_serve::vehicles::lossy_channel::ChannelFaults;
use pcr_serve::vehicles::manager_client::ManagerClient;
use pcr_serve::vehicles::record::{RecordCertificate, certify};
use pcr_serve::vehicles::simulated_fleet::{self, SimulatedFleet};
use pcr_serve::vehicles::simulated_site::SimulatedSite;
use pcr_serve::vehicles::vehicle_motion::SimulatedTraits;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::sync_channel;
use std::sync::{Arc, Mutex};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// Safe ends of the warehouse for discs of 0.5 m: `pcr traffic warehouse_graph.geojson --radius 0.5 --agents 3 --hours 0.01 --json`.
pub(crate) const SAFE: [u64; 13] = [0, 60, 65, 66, 67, 75, 77, 79, 81, 83, 85, 87, 95];

pub(crate) const WAREHOUSE: &str = include_str!("../../../../tests/data/real/nav2/warehouse_graph.geojson");

pub(crate) fn warehouse() -> Layout {
    let options = ImportOptions { radius: Some(0.4), ..ImportOptions::default() };
    let ImportedLayout { layout, .. } =
        layout(InputFormat::Nav2, WAREHOUSE, &options, &mut Warnings::default()).unwrap();
    layout
}

/// Nodes of a layout with these names.
pub(crate) fn nodes(layout: &Layout, names: &[u64]) -> Vec<usize> {
    names.iter().map(|name| layout.nodes_called(&name.to_string())[0]).collect()
}

/// The part of the topics that is the manager's, and that of the vehicles.
pub(crate) fn interfaces() -> [TopicInterface; 2] {
    ["fleet", "uagv"].map(|prefix| TopicInterface::new(prefix).unwrap())
}

pub(crate) fn settings() -> SupervisorConfig {
    // Holds as far as the way is free.
    SupervisorConfig { lookahead: 1e3, ..at_broker() }
}

/// As `pcr serve` has them.
pub(crate) fn at_broker() -> SupervisorConfig {
    SupervisorConfig { lookahead: 8.0, position_uncertainty: 0.3, ..SupervisorConfig::default() }
}

/// A supervisor at work.
pub(crate) struct Desk {
    stop: Arc<AtomicBool>,
    asked: Arc<AtomicBool>,
    thread: JoinHandle<Result<(), SessionEnd>>,
    log: Arc<Mutex<Vec<String>>>,
}

impl Desk {
    pub(crate) fn open(
        broker: &Mosquitto,
        profiles: Vec<VehicleConfig>,
        session: &str,
        keep: Box<dyn JournalStore>,
    ) -> Self {
        Self::at(&broker.address(), profiles, session, Supervisor::new(at_broker(), keep))
    }

    pub(crate) fn at(
        broker: &BrokerAddress,
        profiles: Vec<VehicleConfig>,
        session: &str,
        mut supervisor: Supervisor,
    ) -> Self {
        let [manager, vehicles] = interfaces();
        let stop = Arc::new(AtomicBool::new(false));
        let settings = bridge::BridgeConfig { manager, vehicles: vehicles.clone(), limits: MessageLimits::default() };
        let bridge = Vda5050Bridge::new(settings, profiles, &supervisor).unwrap();
        let mut station = BrokerSession::open(broker, &vehicles, &bridge, session).unwrap();
        let bridge = Arc::new(Mutex::new(bridge));
        let (handle, inputs) = queue();
        let [(sender, events), (copies, news)] = [(); 2].map(|()| sync_channel(1 << 16));
        let server = std::thread::spawn(move || {
            let _ = serve(&mut supervisor, &inputs, &WriteProgress::default(), LogWriter::new(LogLevel::Error));
        });
        for listener in [sender, copies] {
            assert!(handle.send(ServerInput::Tell(listener)));
        }
        let (log, asked) = (Arc::new(Mutex::new(Vec::new())), Arc::new(AtomicBool::new(false)));
        let (ended, lines, tells) = (stop.clone(), log.clone(), asked.clone());
        let begin = Instant::now();
        let thread = std::thread::spawn(move || {
            let done = loop {
                if ended.load(Ordering::Relaxed) {
                    station.close();
                    break Ok(());
                }
                let log = match station.turn(&handle, &bridge, &events) {
                    Ok(log) => log,
                    Err(stopped) => break Err(stopped),
                };
                let mut lines = lines.lock().unwrap();
                lines.extend(news.try_iter().map(|event| format!("{:.2} {event:?}", begin.elapsed().as_secs_f64())));
                lines.extend(log);
                if tells.swap(false, Ordering::Relaxed) {
                    lines.push(format!("ours: {}", station.is_ours()));
                    let own = bridge.clone();
                    let dumped = handle.ask(move |supervisor, _, _| dump::supervised(supervisor, &own.lock().unwrap()));
                    lines.extend(dumped.into_iter().flatten());
                }
            };
            handle.send(ServerInput::Stop);
            server.join().unwrap();
            done
        });
        Self { stop, asked, thread, log }
    }

    /// The last events, and what the supervisor believes.
    pub(crate) fn tell(&self) -> String {
        self.asked.store(true, Ordering::Relaxed);
        while self.asked.load(Ordering::Relaxed) && !self.is_over() {
            std::thread::sleep(Duration::from_millis(10));
        }
        // The thread holds the lock while it writes.
        let log = self.log.lock().unwrap();
        log.iter().skip(log.len().saturating_sub(100)).cloned().collect::<Vec<_>>().join("\n")
    }

    pub(crate) fn is_over(&self) -> bool {
        self.thread.is_finished()
    }

    pub(crate) fn close(self) -> Result<(), SessionEnd> {
        self.stop.store(true, Ordering::Relaxed);
        self.thread.join().unwrap()
    }
}

/// Vehicles and their manager.
pub(crate) struct Site {
    pub(crate) fleet: SimulatedFleet<Vec<u8>>,
    pub(crate) office: ManagerClient,
}

#[derive(Clone, Copy)]
pub(crate) struct Scene<'a> {
    pub(crate) count: usize,
    pub(crate) versions: &'a [ProtocolVersion],
    pub(crate) abilities: &'a [SimulatedTraits],
    pub(crate) climate: ChannelFaults,
    pub(crate) drops: f64,
    pub(crate) pace: f64,
}

impl Site {
    /// At the safe ends of the warehouse.
    pub(crate) fn open(broker: &Mosquitto, scene: Scene<'_>) -> (Self, Vec<VehicleConfig>) {
        Self::at([&broker.address(), &broker.address()], scene)
    }

    /// The same with logins of the vehicles and of the manager.
    pub(crate) fn at([of_vehicles, of_manager]: [&BrokerAddress; 2], scene: Scene<'_>) -> (Self, Vec<VehicleConfig>) {
        let layout = warehouse();
        let goals = nodes(&layout, &SAFE);
        let world = SimulatedSite::new(layout, goals, scene.count, scene.versions, scene.abilities, 1).unwrap();
        let [manager, interface] = interfaces();
        let settings = simulated_fleet::SimulatedFleetConfig {
            broker: of_vehicles.clone(),
            interface,
            pace: scene.pace,
            positions: 10.0,
            states: 2.0,
            drops: scene.drops,
            climate: scene.climate,
            seed: 1,
        };
        let fleet = SimulatedFleet::new(settings, world.vehicles, Vec::new()).unwrap();
        let office = ManagerClient::open(of_manager, manager, world.manager).unwrap();
        (Self { fleet, office }, world.profiles)
    }

    /// Goes on until so many missions are done, or fails when none is for long.
    pub(crate) fn until(&mut self, missions: u64) {
        /// Steps, not seconds: a busy machine takes as many of them.
        const LONGEST: u64 = 40_000;
        let (mut done, mut steps) = (self.office.manager.done(), 0);
        while done < missions {
            self.step();
            steps += 1;
            if self.office.manager.done() > done {
                (done, steps) = (self.office.manager.done(), 0);
            }
            if steps > LONGEST {
                let orders = dump::ordered(&self.office.manager);
                let driven: Vec<String> = self.fleet.vehicles_mut().map(dump::driven).chain(orders).collect();
                panic!("{done} of {missions} missions, and then nothing:\n{}", driven.join("\n"));
            }
        }
    }

    pub(crate) fn step(&mut self) {
        self.fleet.step().unwrap();
        self.office.step();
        std::thread::sleep(Duration::from_millis(5));
    }

    pub(crate) fn lasts(&mut self, time: Duration) {
        let since = Instant::now();
        while since.elapsed() < time {
            self.step();
        }
    }

    /// Ends it, and proves that nobody has touched anybody.
    pub(crate) fn close(self) -> RecordCertificate {
        let record = self.fleet.close().unwrap();
        let found = certify(record.as_slice()).unwrap();
        assert_eq!(found.verdict, "proved", "{found:?}");
        found
    }
}
