//! Vehicles and their manager at a broker.

use super::super::brokers::{AT_BROKERS, VEHICLES, broker, interfaces};
use super::super::printed::{caution, stdout, tables};
use super::super::scenario_sources::{FLEET, layout, layout_source};
use super::super::{CONFLICTS, CliError, NO_STREAM, NOT_WRITTEN, WRONG_INPUT, complain, is_standard};
use super::FleetArgs;
use pcr_execution::lifelong::{streets, well_formedness};
use pcr_formats::import::{self, ImportOptions, ImportedLayout};
use pcr_formats::output;
use pcr_formats::vda5050::topics::TopicInterface;
use pcr_formats::vda5050::version::ProtocolVersion;
use pcr_formats::warning::WarningCode;
use pcr_serve::journal_entry::NullStore;
use pcr_serve::supervisor::Supervisor;
use pcr_serve::vda5050::mqtt::BrokerAddress;
use pcr_serve::vda5050::vehicle_adapter::VehicleConfig;
use pcr_serve::vehicles::edge_reservations::VehicleCoordination;
use pcr_serve::vehicles::lossy_channel::ChannelFaults;
use pcr_serve::vehicles::manager_client::ManagerClient;
use pcr_serve::vehicles::offline_simulation::{self, OfflineSimulation, StepError};
use pcr_serve::vehicles::record::certify;
use pcr_serve::vehicles::release_audit::ReleaseAudit;
use pcr_serve::vehicles::simulated_fleet::{SimulatedFleet, SimulatedFleetConfig};
use pcr_serve::vehicles::simulated_site::{SimulatedSite, profile};
use pcr_serve::vehicles::vehicle_motion::SimulatedTraits;
use std::fs::File;
use std::io::{self, BufRead, BufReader, BufWriter, Write};
use std::path::Path;
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// Exit status: rounding does not tell.
const UNDECIDED: u8 = 4;

/// Who is there.
#[derive(Clone, Copy, Debug)]
pub(in super::super) struct FleetSimulationOptions {
    pub(in super::super) vehicles: usize,
    pub(in super::super) manager: bool,
    pub(in super::super) pace: f64,
    pub(in super::super) drops: f64,
    pub(in super::super) weather: f64,
    pub(in super::super) seed: u64,
}

impl Default for FleetSimulationOptions {
    fn default() -> Self {
        Self { vehicles: 8, manager: true, pace: 1.0, drops: 0.0, weather: 0.0, seed: 1 }
    }
}

/// Vehicles at the safe ends of a layout, of all editions, and two kinds.
pub(in super::super) fn world(file: &Path, crew: &FleetSimulationOptions) -> Result<SimulatedSite, CliError> {
    let options =
        ImportOptions { radius: Some(profile_radius(&SimulatedTraits::default())), ..ImportOptions::default() };
    placed(layout(file, &options, FLEET, false)?, crew).map_err(|why| CliError::wrong(file, why))
}

/// The same on a generated site.
fn generated(count: usize, crew: &FleetSimulationOptions) -> Result<SimulatedSite, CliError> {
    let mut imported = streets(count);
    imported.vehicle.radius = profile_radius(&SimulatedTraits::default());
    placed(imported, crew).map_err(|why| CliError::arguments(format!("--streets {count}: {why}")))
}

/// Of a layout whose vehicle is the largest, with what is kept around it.
///
/// # Errors
/// Why the vehicles have no place, in words.
fn placed(imported: ImportedLayout, crew: &FleetSimulationOptions) -> Result<SimulatedSite, String> {
    let usual = SimulatedTraits::default();
    let small = SimulatedTraits { radius: 0.3, speed: 1.3, acceleration: 0.8, ..usual };
    let form = well_formedness(&imported, crew.seed).map_err(|error| error.to_string())?;
    let place = |id: &import::ElementId| imported.layout.nodes.iter().position(|node| node.id == *id);
    let goals = form.safe_ends.iter().filter_map(place).collect();
    SimulatedSite::new(imported.layout.clone(), goals, crew.vehicles, &ProtocolVersion::ALL, &[usual, small], crew.seed)
        .map_err(|error| error.to_string())
}

/// So many messages are lost, come twice and come late.
fn climate(part: f64) -> ChannelFaults {
    ChannelFaults { loss_rate: part, duplicate_rate: part, reorder_rate: part, delay: 3.0 }
}

fn profile_radius(can: &SimulatedTraits) -> f64 {
    let key = pcr_formats::vda5050::topics::VehicleId { manufacturer: String::new(), serial_number: String::new() };
    profile(key, can).abilities.radius_with_margin()
}

/// Vehicles at a broker, and their manager if there is one.
pub(in super::super) struct FleetRun<W: Write> {
    fleet: SimulatedFleet<W>,
    office: Option<ManagerClient>,
}

impl<W: Write> FleetRun<W> {
    pub(in super::super) fn open(
        world: SimulatedSite,
        broker: &BrokerAddress,
        [manager, vehicles]: &[TopicInterface; 2],
        crew: &FleetSimulationOptions,
        record: W,
    ) -> Result<Self, CliError> {
        let settings = SimulatedFleetConfig {
            broker: broker.clone(),
            interface: vehicles.clone(),
            pace: crew.pace,
            positions: 10.0,
            states: 2.0,
            drops: crew.drops / 3600.0,
            climate: climate(crew.weather),
            seed: crew.seed,
        };
        let fleet = SimulatedFleet::new(settings, world.vehicles, record).map_err(CliError::from)?;
        let office = crew.manager.then(|| ManagerClient::open(broker, manager.clone(), world.manager));
        Ok(Self { fleet, office: office.transpose().map_err(|error| CliError::arguments(error.to_string()))? })
    }

    pub(in super::super) fn step(&mut self) -> io::Result<()> {
        self.fleet.step()?;
        self.office.iter_mut().for_each(ManagerClient::step);
        Ok(())
    }

    fn done(&self) -> u64 {
        self.office.as_ref().map_or(0, |office| office.manager.done())
    }

    fn busy(&self) -> usize {
        self.office.as_ref().map_or(0, |office| office.manager.busy().count())
    }

    pub(in super::super) fn close(self) -> io::Result<W> {
        self.fleet.close()
    }
}

pub(super) fn run(arguments: FleetArgs) -> Result<ExitCode, CliError> {
    if let Some(file) = &arguments.certify {
        return certified(file);
    }
    if is_standard(arguments.record.as_ref()) {
        return Err(CliError::arguments(format!("--record -: {NO_STREAM}")));
    }
    for (name, value, lo, hi) in [
        ("--pace", arguments.pace, 0.1, 100.0),
        ("--drops", arguments.drops, 0.0, 1e4),
        ("--weather", arguments.weather, 0.0, 0.5),
        ("--time", arguments.time.unwrap_or(1.0), 0.1, 1e7),
    ] {
        if !(lo..=hi).contains(&value) {
            return Err(CliError::arguments(format!("{name}: a number from {lo} to {hi} is expected")));
        }
    }
    if arguments.vehicles == 0 {
        return Err(CliError::arguments("--vehicles: allowed is 1 or more"));
    }
    if arguments.finish && !arguments.manager && arguments.alone.is_none() {
        return Err(CliError::arguments("--finish: missions are those of --manager, or of --alone"));
    }
    let FleetArgs { vehicles, manager, pace, drops, weather, seed, .. } = arguments;
    let crew = FleetSimulationOptions { vehicles, manager, pace, drops, weather, seed };
    let world = match arguments.streets {
        None => world(&layout_source(arguments.layout.clone())?, &crew)?,
        Some(count @ 2..=100) => generated(count, &crew)?,
        Some(_) => return Err(CliError::arguments("--streets: a whole number from 2 to 100 is expected")),
    };
    if let (Some(profiles), Some(record)) = (&arguments.profiles, &arguments.record)
        && !is_standard(Some(profiles))
        && output::are_at_odds(profiles, record)
    {
        return Err(CliError::arguments("--profiles and --record name the same file; two files are written"));
    }
    let free = world.manager.free();
    if free < vehicles {
        let all = free + vehicles;
        let text = format!(
            "of {all} parking endpoints, {free} are free while all {vehicles} vehicles stand; a mission to one of the others waits \
             until its vehicle has left"
        );
        caution(WarningCode::ParkingEndpoints, &text);
    }
    if let Some(file) = &arguments.profiles {
        let text = profiles(&world);
        super::super::write_to(file, &text)?;
    }
    let outcome = match &arguments.record {
        // As a whole, or not at all: what vehicles did up to an error is no record of their time.
        Some(file) => output::stream(file, |out| driven(world, &arguments, &crew, Box::new(BufWriter::new(out))))
            .map_err(|unrecorded| match unrecorded {
                FleetRunError::Output(error) => CliError::not_written(file, &error),
                FleetRunError::Stop(stop) => stop,
            })?,
        None => driven(world, &arguments, &crew, Box::new(io::sink())).map_err(|unrecorded| match unrecorded {
            FleetRunError::Output(error) => CliError::arguments(error.to_string()),
            FleetRunError::Stop(stop) => stop,
        })?,
    };
    // The vehicles themselves may be on standard output.
    outcome.print(&mut tables(is_standard(arguments.profiles.as_ref())))
}

/// Why the vehicles have not come to the end of their time.
enum FleetRunError {
    /// The record could not be written.
    Output(io::Error),
    Stop(CliError),
}

impl From<CliError> for FleetRunError {
    fn from(stop: CliError) -> Self {
        Self::Stop(stop)
    }
}

impl From<io::Error> for FleetRunError {
    fn from(error: io::Error) -> Self {
        Self::Output(error)
    }
}

/// An error on the way: one of the system is of the record, all others are not.
fn unwritten(error: io::Error) -> FleetRunError {
    match error.raw_os_error() {
        Some(_) => FleetRunError::Output(error),
        None => FleetRunError::Stop(CliError::arguments(error.to_string())),
    }
}

/// A flag that is set when the program is told to end: what was recorded until then is kept.
fn stopped_by_signal() -> Arc<AtomicBool> {
    let flag = Arc::new(AtomicBool::new(false));
    #[cfg(unix)]
    for signal in [signal_hook::consts::SIGINT, signal_hook::consts::SIGTERM] {
        // Where it cannot be caught, it ends the program as it does others.
        let _ = signal_hook::flag::register(signal, flag.clone());
    }
    flag
}

/// What the vehicles do in their time, at a broker or alone.
fn driven(
    world: SimulatedSite,
    arguments: &FleetArgs,
    crew: &FleetSimulationOptions,
    record: Box<dyn Write + '_>,
) -> Result<FleetRunSummary, FleetRunError> {
    if let (Some(method), Some(time)) = (&arguments.alone, arguments.time) {
        return run_offline(world, arguments, crew, method, time, record);
    }
    let mut run = FleetRun::open(world, &broker(&arguments.broker)?, &interfaces(&arguments.topics)?, crew, record)?;
    let flag = stopped_by_signal();
    let end = arguments.time.unwrap_or(f64::INFINITY);
    let mut is_told = false;
    let mut go_on = |run: &mut FleetRun<_>, until: f64, is_busy: fn(&FleetRun<_>) -> bool| -> io::Result<()> {
        while !flag.load(Ordering::Relaxed) && run.fleet.time() < until && is_busy(run) {
            run.step()?;
            if let Some(why) = run.fleet.unreached().filter(|_| !is_told) {
                complain(&format!("no broker: {why}; it is tried again"));
                is_told = true;
            }
            std::thread::sleep(Duration::from_millis(5));
        }
        Ok(())
    };
    go_on(&mut run, end, |_| true).map_err(unwritten)?;
    if let Some(why) = run.fleet.unreached() {
        return Err(CliError::Error(format!("no vehicle has reached a broker: {why}"), WRONG_INPUT).into());
    }
    let (time, done, drops) = (run.fleet.time(), run.done(), run.fleet.drops());
    let mut left = None;
    if let Some(office) = run.office.as_mut().filter(|_| arguments.finish) {
        office.manager.end();
        let mut busy = usize::MAX;
        while run.busy() < busy && !flag.load(Ordering::Relaxed) {
            busy = run.busy();
            let until = run.fleet.time() + LONGEST;
            go_on(&mut run, until, |run| run.busy() > 0).map_err(unwritten)?;
        }
        left = Some((run.busy(), run.fleet.time() - time));
    }
    let audit = run.fleet.audit().clone();
    run.close().map_err(unwritten)?;
    Ok(FleetRunSummary { vehicles: crew.vehicles, time, done, drops, audit, left, longest: None })
}

/// Where nobody has come to its end for so long, nobody ever will \[s\].
const LONGEST: f64 = 3600.0;

/// The same without a broker.
fn run_offline(
    world: SimulatedSite,
    arguments: &FleetArgs,
    crew: &FleetSimulationOptions,
    method: &str,
    time: f64,
    record: Box<dyn Write + '_>,
) -> Result<FleetRunSummary, FleetRunError> {
    let method = VehicleCoordination::ALL.into_iter().find(|known| known.name() == method).ok_or_else(|| {
        CliError::arguments(format!(
            "--alone: allowed are {}",
            VehicleCoordination::ALL.map(VehicleCoordination::name).join(", ")
        ))
    })?;
    let climate = climate(crew.weather);
    let settings =
        offline_simulation::OfflineConfig { method, climate, drops: crew.drops / 3600.0, step: 0.1, seed: crew.seed };
    let (width, lookahead) = AT_BROKERS;
    let own = pcr_serve::supervisor::SupervisorConfig { position_uncertainty: width, lookahead, ..Default::default() };
    let supervisor = Supervisor::new(own, Box::new(NullStore));
    let interfaces = interfaces(&arguments.topics)?;
    let mut yard = OfflineSimulation::new(world, interfaces, settings, supervisor, record).map_err(unwritten)?;
    let broken = |failed: StepError| match failed {
        StepError::Journal(fault) => CliError::Error(fault.to_string(), NOT_WRITTEN).into(),
        StepError::Record(error) => unwritten(error),
    };
    let stopped = stopped_by_signal();
    while yard.time() < time && !stopped.load(Ordering::Relaxed) {
        yard.step().map_err(broken)?;
    }
    let time = yard.time().min(time);
    let (done, drops) = (yard.manager().done(), yard.drops());
    let left = match arguments.finish && !stopped.load(Ordering::Relaxed) {
        true => {
            let (mut before, mut left) = (usize::MAX, yard.drain(LONGEST).map_err(broken)?);
            while left > 0 && left < before {
                (before, left) = (left, yard.drain(LONGEST).map_err(broken)?);
            }
            Some((left, yard.time() - time))
        }
        false => None,
    };
    let (audit, longest) = (yard.audit().clone(), Some((method, yard.longest())));
    yard.close().map_err(unwritten)?;
    Ok(FleetRunSummary { vehicles: crew.vehicles, time, done, drops, audit, left, longest })
}

/// What came of it.
struct FleetRunSummary {
    vehicles: usize,
    /// \[s\]
    time: f64,
    done: u64,
    drops: u64,
    audit: ReleaseAudit,
    /// Who has not come to its end, and how long after the time \[s\].
    left: Option<(usize, f64)>,
    /// Without a broker, how long somebody with an order has stood \[s\].
    longest: Option<(VehicleCoordination, f64)>,
}

impl FleetRunSummary {
    /// Tells it to people, and by the exit status.
    fn print(&self, out: &mut impl Write) -> Result<ExitCode, CliError> {
        let Self { vehicles, time, done, drops, audit, left, longest } = self;
        writeln!(out, "{vehicles} vehicles, {time:.0} s of theirs: {done} missions done, {drops} connections lost")?;
        writeln!(out, "two vehicles with the right of way at one place: {} of {} checks", audit.twice, audit.looks)?;
        if let Some((time, [a, b])) = &audit.first {
            writeln!(out, "first at {time:.1} s: {a} and {b}")?;
        }
        if let Some((left, time)) = left {
            writeln!(out, "{left} have not come to their ends {time:.0} s later")?;
        }
        if let Some((method, longest)) = longest {
            writeln!(out, "{}: nobody with an order stood longer than {longest:.0} s", method.name())?;
        }
        let is_sound = audit.twice == 0 && left.is_none_or(|(left, _)| left == 0);
        Ok(if is_sound { ExitCode::SUCCESS } else { ExitCode::from(CONFLICTS) })
    }
}

fn profiles(world: &SimulatedSite) -> String {
    let vehicle = |profile: &VehicleConfig| {
        let (key, can) = (&profile.key, &profile.abilities);
        let mut all = serde_json::json!({ "manufacturer": key.manufacturer, "serialNumber": key.serial_number,
            "margin": can.margin, "speed": can.speed, "acceleration": can.acceleration, "split": profile.split });
        match &can.footprint {
            Some(footprint) => all["footprint"] = serde_json::json!(footprint),
            None => all["radius"] = can.radius.into(),
        }
        all.to_string()
    };
    let list: Vec<String> = world.profiles.iter().map(vehicle).collect();
    let (format, version) = VEHICLES;
    format!("{{\"format\":\"{format}\",\"version\":{version},\"vehicles\":[\n{}\n]}}\n", list.join(",\n"))
}

fn certified(file: &Path) -> Result<ExitCode, CliError> {
    // Bit by bit: it may be of days.
    let text: Box<dyn BufRead> = match file == Path::new("-") {
        true => Box::new(io::stdin().lock()),
        false => {
            let text = File::open(file).map_err(|error| CliError::wrong(file, format!("cannot be read: {error}")))?;
            Box::new(BufReader::new(text))
        }
    };
    let found = certify(text).map_err(|error| CliError::wrong(file, error))?;
    let told = serde_json::to_string(&found).map_err(|error| CliError::wrong(file, error))?;
    writeln!(stdout(), "{told}")?;
    Ok(match found.verdict {
        "proved" => ExitCode::SUCCESS,
        "contact" => ExitCode::from(CONFLICTS),
        _ => ExitCode::from(UNDECIDED),
    })
}
