//! Runs the VDA 5050 bridge beside the thread that owns the supervisor.

use super::super::brokers::{VEHICLES, broker, interfaces};
use super::super::{NOT_WRITTEN, Stop, WRONG_INPUT};
use super::Arguments;
use pcr_formats::once::Once;
use pcr_formats::vda5050::decode::Limits;
use pcr_formats::vda5050::topics::{Interface, Key};
use pcr_serve::log::{Level, Log};
use pcr_serve::robot::Abilities;
use pcr_serve::server::{Handle, Input};
use pcr_serve::supervisor::Supervisor;
use pcr_serve::vda5050::bridge::{Bridge, Settings};
use pcr_serve::vda5050::lane::Profile;
use pcr_serve::vda5050::mqtt::Broker;
use pcr_serve::vda5050::station::{Station, Stopped};
use pcr_serve::vda5050::way::TOLERANCE;
use serde_json::Value;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::sync_channel;
use std::sync::{Arc, Mutex};
use std::thread::JoinHandle;
use std::time::{SystemTime, UNIX_EPOCH};

/// Events that may wait.
const EVENTS: usize = 1 << 16;

/// Which vehicles, and where.
pub(super) struct Fleet {
    pub(super) broker: Broker,
    pub(super) interfaces: [Interface; 2],
    pub(super) profiles: Vec<Profile>,
}

impl Fleet {
    /// What the command line says, if it does.
    pub(super) fn of(arguments: &Arguments) -> Result<Option<Self>, Stop> {
        let (Some(place), Some(file)) = (&arguments.broker, &arguments.fleet) else { return Ok(None) };
        let broker = broker(place)?;
        let broker = Broker { authority: arguments.authority.clone(), ..broker };
        let interfaces = interfaces(&arguments.topics)?;
        Ok(Some(Self { broker, interfaces, profiles: profiles(file)? }))
    }
}

/// The list in a file of vehicles, which may leave out what it is.
fn listed(value: &Value) -> Result<&Vec<Value>, String> {
    let Value::Object(members) = value else { return Err("an object is expected".into()) };
    for (name, value) in members {
        match name.as_str() {
            "format" if *value != VEHICLES.0 => {
                return Err(format!("format: {value} where {} is expected", VEHICLES.0));
            }
            "version" if *value != VEHICLES.1 => {
                return Err(format!("version: {value} where {} is expected", VEHICLES.1));
            }
            "format" | "version" | "vehicles" => {}
            unknown => return Err(format!("{unknown}: unknown; format, version and vehicles are read")),
        }
    }
    members.get("vehicles").and_then(Value::as_array).ok_or_else(|| "vehicles: a list is expected".into())
}

/// The vehicles in a file.
fn profiles(file: &Path) -> Result<Vec<Profile>, Stop> {
    let text = std::fs::read_to_string(file).map_err(|error| Stop::wrong(file, error))?;
    let Once(value) = serde_json::from_str(&text).map_err(|error| Stop::wrong(file, error))?;
    let list = listed(&value).map_err(|why| Stop::wrong(file, why))?;
    let profile =
        |(k, value): (usize, &Value)| profile(value).map_err(|why| Stop::wrong(file, format!("vehicles[{k}]: {why}")));
    let profiles: Vec<Profile> = list.iter().enumerate().map(profile).collect::<Result<_, _>>()?;
    for (k, profile) in profiles.iter().enumerate() {
        if profiles.iter().take(k).any(|other| other.key == profile.key) {
            return Err(Stop::wrong(file, format!("vehicles[{k}]: {} is there twice", profile.key)));
        }
    }
    Ok(profiles)
}

fn profile(value: &Value) -> Result<Profile, String> {
    let Value::Object(members) = value else { return Err("an object is expected".into()) };
    const KNOWN: [&str; 7] = ["manufacturer", "serialNumber", "radius", "margin", "speed", "acceleration", "split"];
    if let Some(unknown) = members.keys().find(|name| !KNOWN.contains(&name.as_str())) {
        return Err(format!("{unknown}: unknown; {} are read", KNOWN.join(", ")));
    }
    let text = |name: &str| value.get(name).and_then(Value::as_str).ok_or(format!("{name}: a text is expected"));
    let number = |name: &str| value.get(name).and_then(Value::as_f64).ok_or(format!("{name}: a number is expected"));
    let abilities = Abilities {
        radius: number("radius")?,
        margin: number("margin")?,
        speed: number("speed")?,
        acceleration: number("acceleration")?,
    };
    let abilities = abilities.checked()?;
    // As much of the margin is for curves, so nothing would be left for the vehicle: each of its positions would be off its way.
    if abilities.margin <= TOLERANCE {
        return Err(format!(
            "margin: has to be more than {TOLERANCE} m: {} leaves a vehicle no room beside its way",
            abilities.margin
        ));
    }
    let split = match value.get("split") {
        None => true,
        Some(split) => split.as_bool().ok_or("split: true or false is expected")?,
    };
    Ok(Profile { key: Key::new(text("manufacturer")?, text("serialNumber")?)?, abilities, split })
}

/// Whether the journal knows the vehicles as the file does: orders were made for discs as they were.
fn known(supervisor: &Supervisor, profiles: &[Profile], log: Log) -> Result<(), Stop> {
    for robot in supervisor.robots() {
        match profiles.iter().find(|profile| profile.key.to_string() == robot.name) {
            Some(profile) if profile.abilities != robot.abilities => {
                return Err(Stop::arguments(format!(
                    "{}: radius, margin, speed or acceleration are others in the journal; remove it there (verb `remove`), or begin another \
                     journal while all vehicles stand",
                    robot.name
                )));
            }
            Some(_) => {}
            None => log.write(
                Level::Warn,
                "in the journal, but not in the file: it keeps its place",
                &[("robot", &robot.name)],
            ),
        }
    }
    Ok(())
}

/// The bridge at work.
pub(super) struct Work {
    stop: Arc<AtomicBool>,
    thread: JoinHandle<Result<(), Stopped>>,
}

/// Starts the bridge.
pub(super) fn start(handle: &Handle, supervisor: &Supervisor, fleet: Fleet, log: Log) -> Result<Work, Stop> {
    let Fleet { broker, interfaces: [manager, vehicles], profiles } = fleet;
    known(supervisor, &profiles, log)?;
    let settings = Settings { manager, vehicles: vehicles.clone(), limits: Limits::default() };
    let bridge =
        Bridge::new(settings, profiles, supervisor).map_err(|why| Stop::arguments(format!("the journal: {why}")))?;
    let now = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_nanos());
    let session = format!("{}-{now:x}", std::process::id());
    let mut station = Station::open(&broker, &vehicles, &bridge, &session).map_err(Stop::arguments)?;
    let stop = Arc::new(AtomicBool::new(false));
    let (ended, handle) = (stop.clone(), handle.clone());
    let (sender, events) = sync_channel(EVENTS);
    handle.send(Input::Tell(sender));
    let thread = super::threads::thread("bridge", move || {
        let bridge = Arc::new(Mutex::new(bridge));
        // Without the bridge the vehicles are not supervised, also when its thread panics.
        let end = Ends(handle);
        while !ended.load(Ordering::Relaxed) {
            match station.turn(&end.0, &bridge, &events) {
                Ok(lines) => {
                    lines.iter().for_each(|line| log.write(Level::Warn, "bridge", &[("why", line)]));
                }
                Err(_) if ended.load(Ordering::Relaxed) => break,
                Err(why) => return Err(why),
            }
        }
        station.close();
        Ok(())
    })?;
    Ok(Work { stop, thread })
}

impl Work {
    /// Ends it in order; an error is why it had ended by itself.
    pub(super) fn end(self) -> Result<(), Stop> {
        self.stop.store(true, Ordering::Relaxed);
        match self.thread.join() {
            Ok(Ok(()) | Err(Stopped::Ended)) => Ok(()),
            Ok(Err(why @ Stopped::Rival(_))) => Err(Stop::Error(why.to_string(), WRONG_INPUT)),
            Ok(Err(why)) => Err(Stop::Error(why.to_string(), NOT_WRITTEN)),
            // Why is on standard error already.
            Err(_) => Err(Stop::Error("the bridge to the broker has failed".into(), NOT_WRITTEN)),
        }
    }
}

/// Ends the supervisor when it is dropped.
struct Ends(Handle);

impl Drop for Ends {
    fn drop(&mut self) {
        self.0.send(Input::Stop);
    }
}
