//! Vehicles and their manager at a broker.

use super::super::brokers::{AT_BROKERS, VEHICLES, broker, interfaces};
use super::super::printed::{caution, stdout, tables};
use super::super::sources::{FLEET, layout, layout_source};
use super::super::{CONFLICTS, NO_STREAM, NOT_WRITTEN, Stop, WRONG_INPUT, complain, is_standard};
use super::Arguments;
use pcr_execution::lifelong::{streets, well_formedness};
use pcr_formats::import::{self, Imported, Options};
use pcr_formats::output;
use pcr_formats::vda5050::topics::Interface;
use pcr_formats::vda5050::version::Version;
use pcr_formats::warning::WarningCode;
use pcr_serve::entry::Nowhere;
use pcr_serve::supervisor::Supervisor;
use pcr_serve::vda5050::lane::Profile;
use pcr_serve::vda5050::mqtt::Broker;
use pcr_serve::vehicles::audit::Audit;
use pcr_serve::vehicles::drive::Abilities;
use pcr_serve::vehicles::fleet::{Fleet, Settings};
use pcr_serve::vehicles::locks::Method;
use pcr_serve::vehicles::office::Office;
use pcr_serve::vehicles::record::certify;
use pcr_serve::vehicles::weather::Climate;
use pcr_serve::vehicles::world::{World, profile};
use pcr_serve::vehicles::yard::{self, Failed, Yard};
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
pub(in super::super) struct Crew {
    pub(in super::super) vehicles: usize,
    pub(in super::super) manager: bool,
    pub(in super::super) pace: f64,
    pub(in super::super) drops: f64,
    pub(in super::super) weather: f64,
    pub(in super::super) seed: u64,
}

impl Default for Crew {
    fn default() -> Self {
        Self { vehicles: 8, manager: true, pace: 1.0, drops: 0.0, weather: 0.0, seed: 1 }
    }
}

/// Vehicles at the safe ends of a layout, of all editions, and two kinds.
pub(in super::super) fn world(file: &Path, crew: &Crew) -> Result<World, Stop> {
    let options = Options { radius: Some(profile_radius(&Abilities::default())), ..Options::default() };
    placed(layout(file, &options, FLEET, false)?, crew).map_err(|why| Stop::wrong(file, why))
}

/// The same on a generated site.
fn generated(count: usize, crew: &Crew) -> Result<World, Stop> {
    let mut imported = streets(count);
    imported.vehicle.radius = profile_radius(&Abilities::default());
    placed(imported, crew).map_err(|why| Stop::arguments(format!("--streets {count}: {why}")))
}

/// Of a layout whose vehicle is the largest, with what is kept around it.
fn placed(imported: Imported, crew: &Crew) -> Result<World, String> {
    let usual = Abilities::default();
    let small = Abilities { radius: 0.3, speed: 1.3, acceleration: 0.8, ..usual };
    let form = well_formedness(&imported, crew.seed)?;
    let place = |id: &import::Id| imported.layout.nodes.iter().position(|node| node.id == *id);
    let goals = form.safe_ends.iter().filter_map(place).collect();
    World::new(imported.layout.clone(), goals, crew.vehicles, &Version::ALL, &[usual, small], crew.seed)
}

/// So many messages are lost, come twice and come late.
fn climate(part: f64) -> Climate {
    Climate { lost: part, twice: part, late: part, delay: 3.0 }
}

fn profile_radius(can: &Abilities) -> f64 {
    let key = pcr_formats::vda5050::topics::Key { manufacturer: String::new(), serial_number: String::new() };
    profile(key, can).abilities.reach()
}

/// Vehicles at a broker, and their manager if there is one.
pub(in super::super) struct Run<W: Write> {
    fleet: Fleet<W>,
    office: Option<Office>,
}

impl<W: Write> Run<W> {
    pub(in super::super) fn open(
        world: World,
        broker: &Broker,
        [manager, vehicles]: &[Interface; 2],
        crew: &Crew,
        record: W,
    ) -> Result<Self, Stop> {
        let settings = Settings {
            broker: broker.clone(),
            interface: vehicles.clone(),
            pace: crew.pace,
            positions: 10.0,
            states: 2.0,
            drops: crew.drops / 3600.0,
            climate: climate(crew.weather),
            seed: crew.seed,
        };
        let fleet = Fleet::new(settings, world.vehicles, record).map_err(Stop::from)?;
        let office = crew.manager.then(|| Office::open(broker, manager.clone(), world.manager));
        Ok(Self { fleet, office: office.transpose().map_err(Stop::arguments)? })
    }

    pub(in super::super) fn step(&mut self) -> io::Result<()> {
        self.fleet.step()?;
        self.office.iter_mut().for_each(Office::step);
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

pub(super) fn run(arguments: Arguments) -> Result<ExitCode, Stop> {
    if let Some(file) = &arguments.certify {
        return certified(file);
    }
    if is_standard(arguments.record.as_ref()) {
        return Err(Stop::arguments(format!("--record -: {NO_STREAM}")));
    }
    for (name, value, lo, hi) in [
        ("--pace", arguments.pace, 0.1, 100.0),
        ("--drops", arguments.drops, 0.0, 1e4),
        ("--weather", arguments.weather, 0.0, 0.5),
        ("--time", arguments.time.unwrap_or(1.0), 0.1, 1e7),
    ] {
        if !(lo..=hi).contains(&value) {
            return Err(Stop::arguments(format!("{name}: a number from {lo} to {hi} is expected")));
        }
    }
    if arguments.vehicles == 0 {
        return Err(Stop::arguments("--vehicles: allowed is 1 or more"));
    }
    if arguments.finish && !arguments.manager && arguments.alone.is_none() {
        return Err(Stop::arguments("--finish: missions are those of --manager, or of --alone"));
    }
    let Arguments { vehicles, manager, pace, drops, weather, seed, .. } = arguments;
    let crew = Crew { vehicles, manager, pace, drops, weather, seed };
    let world = match arguments.streets {
        None => world(&layout_source(arguments.layout.clone())?, &crew)?,
        Some(count @ 2..=100) => generated(count, &crew)?,
        Some(_) => return Err(Stop::arguments("--streets: a whole number from 2 to 100 is expected")),
    };
    if let (Some(profiles), Some(record)) = (&arguments.profiles, &arguments.record)
        && !is_standard(Some(profiles))
        && output::are_at_odds(profiles, record)
    {
        return Err(Stop::arguments("--profiles and --record name the same file; two files are written"));
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
                Unrecorded::Output(error) => Stop::not_written(file, &error),
                Unrecorded::Stop(stop) => stop,
            })?,
        None => driven(world, &arguments, &crew, Box::new(io::sink())).map_err(|unrecorded| match unrecorded {
            Unrecorded::Output(error) => Stop::arguments(error.to_string()),
            Unrecorded::Stop(stop) => stop,
        })?,
    };
    // The vehicles themselves may be on standard output.
    outcome.tell(&mut tables(is_standard(arguments.profiles.as_ref())))
}

/// Why the vehicles have not come to the end of their time.
enum Unrecorded {
    /// The record could not be written.
    Output(io::Error),
    Stop(Stop),
}

impl From<Stop> for Unrecorded {
    fn from(stop: Stop) -> Self {
        Self::Stop(stop)
    }
}

impl From<io::Error> for Unrecorded {
    fn from(error: io::Error) -> Self {
        Self::Output(error)
    }
}

/// An error on the way: one of the system is of the record, all others are not.
fn unwritten(error: io::Error) -> Unrecorded {
    match error.raw_os_error() {
        Some(_) => Unrecorded::Output(error),
        None => Unrecorded::Stop(Stop::arguments(error.to_string())),
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
    world: World,
    arguments: &Arguments,
    crew: &Crew,
    record: Box<dyn Write + '_>,
) -> Result<Outcome, Unrecorded> {
    if let (Some(method), Some(time)) = (&arguments.alone, arguments.time) {
        return alone(world, arguments, crew, method, time, record);
    }
    let mut run = Run::open(world, &broker(&arguments.broker)?, &interfaces(&arguments.topics)?, crew, record)?;
    let flag = stopped_by_signal();
    let end = arguments.time.unwrap_or(f64::INFINITY);
    let mut is_told = false;
    let mut go_on = |run: &mut Run<_>, until: f64, is_busy: fn(&Run<_>) -> bool| -> io::Result<()> {
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
        return Err(Stop::Error(format!("no vehicle has reached a broker: {why}"), WRONG_INPUT).into());
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
    Ok(Outcome { vehicles: crew.vehicles, time, done, drops, audit, left, longest: None })
}

/// Where nobody has come to its end for so long, nobody ever will \[s\].
const LONGEST: f64 = 3600.0;

/// The same without a broker.
fn alone(
    world: World,
    arguments: &Arguments,
    crew: &Crew,
    method: &str,
    time: f64,
    record: Box<dyn Write + '_>,
) -> Result<Outcome, Unrecorded> {
    let method = Method::ALL
        .into_iter()
        .find(|known| known.name() == method)
        .ok_or_else(|| Stop::arguments(format!("--alone: allowed are {}", Method::ALL.map(Method::name).join(", "))))?;
    let climate = climate(crew.weather);
    let settings = yard::Settings { method, climate, drops: crew.drops / 3600.0, step: 0.1, seed: crew.seed };
    let (width, lookahead) = AT_BROKERS;
    let own = pcr_serve::supervisor::Settings { width, lookahead, ..Default::default() };
    let supervisor = Supervisor::new(own, Box::new(Nowhere));
    let interfaces = interfaces(&arguments.topics)?;
    let mut yard = Yard::new(world, interfaces, settings, supervisor, record).map_err(unwritten)?;
    let broken = |failed: Failed| match failed {
        Failed::Journal(fault) => Stop::Error(fault.to_string(), NOT_WRITTEN).into(),
        Failed::Record(error) => unwritten(error),
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
    Ok(Outcome { vehicles: crew.vehicles, time, done, drops, audit, left, longest })
}

/// What came of it.
struct Outcome {
    vehicles: usize,
    /// \[s\]
    time: f64,
    done: u64,
    drops: u64,
    audit: Audit,
    /// Who has not come to its end, and how long after the time \[s\].
    left: Option<(usize, f64)>,
    /// Without a broker, how long somebody with an order has stood \[s\].
    longest: Option<(Method, f64)>,
}

impl Outcome {
    /// Tells it to people, and by the exit status.
    fn tell(&self, out: &mut impl Write) -> Result<ExitCode, Stop> {
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

fn profiles(world: &World) -> String {
    let vehicle = |profile: &Profile| {
        let (key, can) = (&profile.key, &profile.abilities);
        serde_json::json!({ "manufacturer": key.manufacturer, "serialNumber": key.serial_number, "radius": can.radius,
            "margin": can.margin, "speed": can.speed, "acceleration": can.acceleration, "split": profile.split })
        .to_string()
    };
    let list: Vec<String> = world.profiles.iter().map(vehicle).collect();
    let (format, version) = VEHICLES;
    format!("{{\"format\":\"{format}\",\"version\":{version},\"vehicles\":[\n{}\n]}}\n", list.join(",\n"))
}

fn certified(file: &Path) -> Result<ExitCode, Stop> {
    // Bit by bit: it may be of days.
    let text: Box<dyn BufRead> = match file == Path::new("-") {
        true => Box::new(io::stdin().lock()),
        false => {
            let text = File::open(file).map_err(|error| Stop::wrong(file, format!("cannot be read: {error}")))?;
            Box::new(BufReader::new(text))
        }
    };
    let found = certify(text).map_err(|error| Stop::wrong(file, error))?;
    let told = serde_json::to_string(&found).map_err(|error| Stop::wrong(file, error))?;
    writeln!(stdout(), "{told}")?;
    Ok(match found.verdict {
        "proved" => ExitCode::SUCCESS,
        "contact" => ExitCode::from(CONFLICTS),
        _ => ExitCode::from(UNDECIDED),
    })
}
