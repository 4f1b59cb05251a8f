//! Runs the VDA 5050 bridge beside the thread that owns the supervisor.

use super::super::brokers::{VEHICLES, broker, interfaces};
use super::super::{CliError, NOT_WRITTEN, WRONG_INPUT};
use super::ServeArgs;
use pcr_formats::footprint::Footprint;
use pcr_formats::import::parse_json;
use pcr_formats::vda5050::decode::MessageLimits;
use pcr_formats::vda5050::topics::{TopicInterface, VehicleId};
use pcr_serve::http::Readiness;
use pcr_serve::log::{LogLevel, LogWriter};
use pcr_serve::owned_path::{OwnedPath, StartPose};
use pcr_serve::robot::RobotTraits;
use pcr_serve::server::{ServerHandle, ServerInput};
use pcr_serve::supervisor::{StandingPlace, Supervisor};
use pcr_serve::telemetry::Telemetry;
use pcr_serve::vda5050::bridge::{BridgeConfig, Vda5050Bridge};
use pcr_serve::vda5050::broker_session::{BrokerSession, SessionEnd};
use pcr_serve::vda5050::mqtt::BrokerAddress;
use pcr_serve::vda5050::order_path::TOLERANCE;
use pcr_serve::vda5050::vehicle_adapter::VehicleConfig;
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::sync_channel;
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::{SystemTime, UNIX_EPOCH};

/// Events that may wait.
const EVENTS: usize = 1 << 16;

/// Which vehicles, and where.
pub(super) struct BridgeFleetConfig {
    pub(super) broker: BrokerAddress,
    pub(super) interfaces: [TopicInterface; 2],
    pub(super) profiles: Vec<VehicleConfig>,
    /// The file of the vehicles, which is read again on SIGHUP.
    pub(super) file: Option<PathBuf>,
}

impl BridgeFleetConfig {
    /// What the command line says, if it does.
    pub(super) fn of(arguments: &ServeArgs, log: LogWriter) -> Result<Option<Self>, CliError> {
        let (Some(place), Some(file)) = (&arguments.broker, &arguments.fleet) else { return Ok(None) };
        let broker = broker(place)?;
        let broker = BrokerAddress { authority: arguments.authority.clone(), ..broker };
        if broker.login.is_none() {
            let what = "no user for the broker (PCR_BROKER_USER): where the broker asks nobody for a name, everybody in its network can give orders \
                        to vehicles";
            log.write(LogLevel::Warn, what, &[("broker", place)]);
        }
        let interfaces = interfaces(&arguments.topics)?;
        Ok(Some(Self { broker, interfaces, profiles: profiles(file)?, file: Some(file.clone()) }))
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
fn profiles(file: &Path) -> Result<Vec<VehicleConfig>, CliError> {
    let text = std::fs::read_to_string(file).map_err(|error| CliError::wrong(file, error))?;
    let value = parse_json(&text).map_err(|error| CliError::refused(file, &error))?.to_value();
    let list = listed(&value).map_err(|why| CliError::wrong(file, why))?;
    let profile = |(k, value): (usize, &Value)| {
        profile(value).map_err(|why| CliError::wrong(file, format!("vehicles[{k}]: {why}")))
    };
    let profiles: Vec<VehicleConfig> = list.iter().enumerate().map(profile).collect::<Result<_, _>>()?;
    for (k, profile) in profiles.iter().enumerate() {
        if profiles.iter().take(k).any(|other| other.key == profile.key) {
            return Err(CliError::wrong(file, format!("vehicles[{k}]: {} is there twice", profile.key)));
        }
    }
    Ok(profiles)
}

fn profile(value: &Value) -> Result<VehicleConfig, String> {
    let Value::Object(members) = value else { return Err("an object is expected".into()) };
    const KNOWN: [&str; 10] = [
        "manufacturer",
        "serialNumber",
        "radius",
        "footprint",
        "margin",
        "speed",
        "acceleration",
        "split",
        "away",
        "places",
    ];
    if let Some(unknown) = members.keys().find(|name| !KNOWN.contains(&name.as_str())) {
        return Err(format!("{unknown}: unknown; {} are read", KNOWN.join(", ")));
    }
    let text = |name: &str| value.get(name).and_then(Value::as_str).ok_or(format!("{name}: a text is expected"));
    let number = |name: &str| value.get(name).and_then(Value::as_f64).ok_or(format!("{name}: a number is expected"));
    let footprint: Option<Footprint> =
        value.get("footprint").cloned().map(serde_json::from_value).transpose().map_err(|why| why.to_string())?;
    let radius = match &footprint {
        None => number("radius")?,
        Some(_) if members.contains_key("radius") => {
            return Err("radius: there is a radius or a footprint, not both".into());
        }
        Some(footprint) => footprint.circumscribed_radius(),
    };
    let [margin, speed, acceleration] = [number("margin")?, number("speed")?, number("acceleration")?];
    let abilities = RobotTraits { radius, footprint, margin, speed, acceleration };
    let abilities = abilities.checked().map_err(|error| error.to_string())?;
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
    let away = value.get("away").map(|away| away.as_bool().ok_or("away: true or false is expected")).transpose()?;
    let places = value.get("places").map_or(Ok(Vec::new()), places)?;
    let key = VehicleId::new(text("manufacturer")?, text("serialNumber")?).map_err(|wrong| wrong.to_string())?;
    Ok(VehicleConfig { key, abilities, split, away, places })
}

/// Where a vehicle may stand as long as it has not said where it does.
fn places(value: &Value) -> Result<Vec<StandingPlace>, String> {
    /// Largest distance from a place \[m\].
    const MOST: f64 = 1e4;
    let list = value.as_array().filter(|list| !list.is_empty()).ok_or("places: a list with a place is expected")?;
    let place = |(k, place): (usize, &Value)| {
        let wrong = |why: &str| format!("places[{k}]: {why}");
        let members = place.as_object().ok_or_else(|| wrong("an object is expected"))?;
        let number = |name: &str| {
            let number = members.get(name).and_then(Value::as_f64);
            number.ok_or_else(|| wrong(&format!("{name}: a number is expected")))
        };
        if members.len() > 3 {
            return Err(wrong("x, y and within are read"));
        }
        let (x, y, radius) = (number("x")?, number("y")?, number("within")?);
        if !(0.0..=MOST).contains(&radius) {
            return Err(wrong(&format!("within: {radius} is out of range; allowed is 0 to {MOST}")));
        }
        // As far as paths may be.
        if OwnedPath::new(StartPose { x, y, heading: 0.0 }, Vec::new()).is_err() {
            return Err(wrong("x, y: out of range"));
        }
        Ok(StandingPlace { x, y, radius })
    };
    list.iter().enumerate().map(place).collect()
}

/// Whether the journal knows the vehicles as the file does: orders were made for discs as they were.
pub(super) fn known(supervisor: &Supervisor, profiles: &[VehicleConfig], log: LogWriter) -> Result<(), CliError> {
    for robot in supervisor.robots() {
        match profiles.iter().find(|profile| profile.key.to_string() == robot.name) {
            Some(profile) if profile.abilities != robot.abilities => {
                return Err(CliError::arguments(format!(
                    "{}: radius, footprint, margin, speed or acceleration are others in the journal; remove it there (verb `remove`), or begin another \
                     journal while all vehicles stand",
                    robot.name
                )));
            }
            Some(_) => {}
            None => log.write(
                LogLevel::Warn,
                "in the journal, but not in the file: it keeps its place",
                &[("robot", &robot.name)],
            ),
        }
    }
    Ok(())
}

/// The bridge at work.
pub(super) struct BridgeThread {
    readiness: Readiness,
    stop: Arc<AtomicBool>,
    thread: JoinHandle<Result<(), SessionEnd>>,
}

/// Starts the bridge.
pub(super) fn start(
    handle: &ServerHandle,
    supervisor: &mut Supervisor,
    fleet: BridgeFleetConfig,
    log: LogWriter,
) -> Result<BridgeThread, CliError> {
    let BridgeFleetConfig { broker, interfaces: [manager, vehicles], profiles, file } = fleet;
    known(supervisor, &profiles, log)?;
    for profile in &profiles {
        let excess =
            profile.abilities.body(false).map_err(|why| CliError::arguments(format!("{}: {why}", profile.key)))?;
        let excess = excess.excess();
        if excess > 0.0 {
            let name = profile.key.to_string();
            let why = format!("{excess:.3} m larger than its outline, which is concave");
            log.write(LogLevel::Warn, "the convex hull is kept free", &[("robot", &name), ("why", &why)]);
        }
    }
    let settings = BridgeConfig { manager, vehicles: vehicles.clone(), limits: MessageLimits::default() };
    let mut bridge = Vda5050Bridge::new(settings, profiles, supervisor)
        .map_err(|why| CliError::arguments(format!("the journal: {why}")))?;
    bridge.prepare(supervisor);
    let now = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_nanos());
    let session = format!("{}-{now:x}", std::process::id());
    let mut station = BrokerSession::open(&broker, &vehicles, &bridge, &session)
        .map_err(|error| CliError::arguments(error.to_string()))?;
    let (stop, readiness) = (Arc::new(AtomicBool::new(false)), Readiness::default());
    let told = readiness.clone();
    told.tell(station.unready(&bridge), station.status(&bridge));
    let (ended, handle) = (stop.clone(), handle.clone());
    let hung_up = Arc::new(AtomicBool::new(false));
    #[cfg(unix)]
    if file.is_some() {
        // Where it cannot be caught, it ends the program as it does others: the journal bears that.
        let _ = signal_hook::flag::register(signal_hook::consts::SIGHUP, hung_up.clone());
    }
    let (sender, events) = sync_channel(EVENTS);
    handle.send(ServerInput::Tell(sender));
    let thread = super::threads::thread("bridge", move || {
        let bridge = Arc::new(Mutex::new(bridge));
        // Without the bridge the vehicles are not supervised, also when its thread panics.
        let end = StopOnDrop(handle);
        while !ended.load(Ordering::Relaxed) {
            if let Some(file) = file.as_ref().filter(|_| hung_up.swap(false, Ordering::Relaxed)) {
                reload(&end.0, &bridge, file, log);
            }
            match station.turn(&end.0, &bridge, &events) {
                Ok(lines) => {
                    lines.iter().for_each(|line| log.write(LogLevel::Warn, "bridge", &[("why", line)]));
                    let bridge = bridge.lock().unwrap_or_else(PoisonError::into_inner);
                    told.tell(station.unready(&bridge), station.status(&bridge));
                }
                Err(_) if ended.load(Ordering::Relaxed) => break,
                Err(why) => return Err(why),
            }
        }
        station.close();
        Ok(())
    })?;
    Ok(BridgeThread { readiness, stop, thread })
}

/// Reads the file of vehicles again, and says in the log what has become of that.
fn reload(handle: &ServerHandle, bridge: &Arc<Mutex<Vda5050Bridge>>, file: &Path, log: LogWriter) {
    let own = bridge.clone();
    let read = profiles(file).map_err(|error| match error {
        CliError::Error(why, _) => why,
        _ => format!("{}: not read", file.display()),
    });
    let taken = read.and_then(|profiles| {
        let reload = move |supervisor: &mut Supervisor, _: &Telemetry, _: f64| {
            own.lock().unwrap_or_else(PoisonError::into_inner).reload(supervisor, profiles)
        };
        handle.ask(reload).unwrap_or_else(|| Err("the supervisor has ended".into()))
    });
    match taken {
        Ok([added, left_out]) => {
            let [added, left_out] = [added, left_out].map(|names| names.join(", "));
            let what = "the file of vehicles was read again";
            log.write(LogLevel::Info, what, &[("added", &added), ("left_out", &left_out)]);
        }
        Err(why) => {
            let what = "the file of vehicles was read again and is not taken: nothing has changed";
            log.write(LogLevel::Error, what, &[("why", &why)]);
        }
    }
}

impl BridgeThread {
    /// Why no vehicle is released anything, as it changes.
    pub(super) fn readiness(&self) -> Readiness {
        self.readiness.clone()
    }

    /// Ends it in order; an error is why it had ended by itself.
    pub(super) fn end(self) -> Result<(), CliError> {
        self.stop.store(true, Ordering::Relaxed);
        match self.thread.join() {
            Ok(Ok(()) | Err(SessionEnd::Ended)) => Ok(()),
            Ok(Err(why @ SessionEnd::Rival(_))) => Err(CliError::Error(why.to_string(), WRONG_INPUT)),
            Ok(Err(why)) => Err(CliError::Error(why.to_string(), NOT_WRITTEN)),
            // Why is on standard error already.
            Err(_) => Err(CliError::Error("the bridge to the broker has failed".into(), NOT_WRITTEN)),
        }
    }
}

/// Ends the supervisor when it is dropped.
struct StopOnDrop(ServerHandle);

impl Drop for StopOnDrop {
    fn drop(&mut self) {
        self.0.send(ServerInput::Stop);
    }
}
