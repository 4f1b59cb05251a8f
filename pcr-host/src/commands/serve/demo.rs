//! A broker, vehicles and their manager, to try a supervisor with.

use super::super::CliError;
use super::super::brokers::interfaces;
use super::super::fleet::{self, FleetSimulationOptions};
use super::ServeArgs;
use super::bridge::BridgeFleetConfig;
use pcr_formats::vda5050::topics::TopicInterface;
use pcr_serve::log::{LogLevel, LogWriter};
use pcr_serve::page_layout::PageLayout as Drawn;
use pcr_serve::vda5050::mqtt::BrokerAddress;
use pcr_serve::vda5050::vehicle_adapter::VehicleConfig;
use std::net::{TcpListener, TcpStream};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, JoinHandle};
use std::time::Duration;

/// All of it.
pub(super) struct BrokerDemo {
    broker: BrokerAddress,
    child: Child,
    folder: PathBuf,
    interfaces: [TopicInterface; 2],
    profiles: Vec<VehicleConfig>,
    drawn: Drawn,
    stop: Arc<AtomicBool>,
    thread: Option<JoinHandle<Result<(), String>>>,
}

impl BrokerDemo {
    pub(super) fn start(layout: &Path, arguments: &ServeArgs, log: LogWriter) -> Result<Self, CliError> {
        if arguments.vehicles == 0 {
            return Err(CliError::arguments("--vehicles: allowed is 1 or more"));
        }
        let crew = FleetSimulationOptions { vehicles: arguments.vehicles, ..FleetSimulationOptions::default() };
        let world = fleet::world(layout, &crew)?;
        let interfaces = interfaces(&arguments.topics)?;
        let (child, broker, folder) = mosquitto()?;
        log.write(LogLevel::Info, "broker", &[("port", &broker.port)]);
        let profiles = world.profiles.clone();
        let name = layout.file_stem().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
        let drawn = world.manager.drawn(name);
        let mut demo = Self { broker, child, folder, interfaces, profiles, drawn, stop: Arc::default(), thread: None };
        let mut run = fleet::FleetRun::open(world, &demo.broker, &demo.interfaces, &crew, std::io::sink())?;
        let stop = demo.stop.clone();
        demo.thread = Some(super::threads::thread("vehicles", move || {
            while !stop.load(Ordering::Relaxed) {
                run.step().map_err(|error| error.to_string())?;
                thread::sleep(Duration::from_millis(10));
            }
            run.close().map(drop).map_err(|error| error.to_string())
        })?);
        Ok(demo)
    }

    /// What the supervisor has to know.
    pub(super) fn fleet(&self) -> BridgeFleetConfig {
        let Self { broker, interfaces, profiles, .. } = self;
        BridgeFleetConfig {
            broker: broker.clone(),
            interfaces: interfaces.clone(),
            profiles: profiles.clone(),
            file: None,
        }
    }

    /// What the page draws.
    pub(super) fn drawn(&self) -> &Drawn {
        &self.drawn
    }

    pub(super) fn end(mut self) -> Result<(), CliError> {
        self.stop.store(true, Ordering::Relaxed);
        match self.thread.take().map(JoinHandle::join) {
            Some(Ok(Err(why))) => Err(CliError::arguments(why)),
            _ => Ok(()),
        }
    }
}

impl Drop for BrokerDemo {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
        // What is gone already needs no end.
        let _ = self.child.kill();
        let _ = self.child.wait();
        let _ = std::fs::remove_dir_all(&self.folder);
    }
}

/// A broker of this machine only, on a port that is free.
fn mosquitto() -> Result<(Child, BrokerAddress, PathBuf), CliError> {
    let failed = |error: std::io::Error| CliError::arguments(format!("mosquitto: {error}"));
    let port = TcpListener::bind("127.0.0.1:0").and_then(|it| it.local_addr()).map_err(failed)?.port();
    let folder = std::env::temp_dir().join(format!("pcr-demo-{}", std::process::id()));
    std::fs::create_dir_all(&folder).map_err(failed)?;
    let config = folder.join("mosquitto.conf");
    let text = format!("listener {port} 127.0.0.1\nallow_anonymous true\nset_tcp_nodelay true\nlog_dest none\n");
    std::fs::write(&config, text).map_err(failed)?;
    // Debian has it where only root's search path leads.
    let started = ["mosquitto", "/usr/sbin/mosquitto", "/usr/local/sbin/mosquitto"].into_iter().find_map(|program| {
        let mut command = Command::new(program);
        command.arg("-c").arg(&config).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null()).spawn().ok()
    });
    let Some(mut child) = started else {
        let _ = std::fs::remove_dir_all(&folder);
        let how = "the demo needs the broker mosquitto: apt-get install mosquitto, or https://mosquitto.org/download";
        return Err(CliError::arguments(how));
    };
    for _ in 0..500 {
        if TcpStream::connect(("127.0.0.1", port)).is_ok() {
            return Ok((child, BrokerAddress::new("127.0.0.1", port), folder));
        }
        thread::sleep(Duration::from_millis(10));
    }
    let _ = child.kill();
    let _ = child.wait();
    Err(CliError::arguments("mosquitto does not answer"))
}
