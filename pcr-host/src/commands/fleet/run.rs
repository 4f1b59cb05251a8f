//! Vehicles and their manager at a broker.

use super::super::serve::{broker, interfaces};
use super::super::{CONFLICTS, Stop};
use super::Arguments;
use pcr_formats::import::{self, Format, Options, Warnings};
use pcr_planning::lifelong::well_formedness;
use pcr_serve::vda5050::mqtt::Broker;
use pcr_serve::vda5050::topics::Interface;
use pcr_serve::vda5050::version::Version;
use pcr_serve::vehicles::drive::Abilities;
use pcr_serve::vehicles::fleet::{Fleet, Settings};
use pcr_serve::vehicles::office::Office;
use pcr_serve::vehicles::record::certify;
use pcr_serve::vehicles::weather::Climate;
use pcr_serve::vehicles::world::{World, profile};
use std::fs::File;
use std::io::{self, BufReader, BufWriter, Write};
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
    let text = std::fs::read_to_string(file).map_err(|error| Stop::wrong(file, error))?;
    let format = Format::of(file, &text).ok_or_else(|| Stop::wrong(file, "not a layout"))?;
    let usual = Abilities::default();
    let small = Abilities { radius: 0.3, speed: 1.3, acceleration: 0.8, ..usual };
    // The largest, and what is kept around it.
    let room = profile_radius(&usual);
    let options = Options { radius: Some(room), ..Options::default() };
    let imported = import::layout(format, &text, &options, &mut Warnings::default());
    let imported = imported.map_err(|error| Stop::wrong(file, error))?;
    let form = well_formedness(&imported, crew.seed).map_err(|why| Stop::wrong(file, why))?;
    let place = |id: &import::Id| imported.layout.nodes.iter().position(|node| node.id == *id);
    let goals = form.safe_ends.iter().filter_map(place).collect();
    let world = World::new(imported.layout.clone(), goals, crew.vehicles, &Version::ALL, &[usual, small], crew.seed);
    world.map_err(|why| Stop::wrong(file, why))
}

fn profile_radius(can: &Abilities) -> f64 {
    let key = pcr_serve::vda5050::topics::Key { manufacturer: String::new(), serial_number: String::new() };
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
        let part = crew.weather;
        let settings = Settings {
            broker: broker.clone(),
            interface: vehicles.clone(),
            pace: crew.pace,
            positions: 10.0,
            states: 2.0,
            drops: crew.drops / 3600.0,
            climate: Climate { lost: part, twice: part, late: part, delay: 3.0 },
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

    pub(in super::super) fn close(self) -> io::Result<W> {
        self.fleet.close()
    }
}

pub(super) fn run(arguments: Arguments) -> Result<ExitCode, Stop> {
    if let Some(file) = &arguments.certify {
        return certified(file);
    }
    let Some(layout) = &arguments.layout else { return Err(Stop::arguments("a layout is needed")) };
    for (name, value, lo, hi) in [
        ("--pace", arguments.pace, 0.1, 100.0),
        ("--drops", arguments.drops, 0.0, 1e4),
        ("--weather", arguments.weather, 0.0, 0.5),
    ] {
        if !(lo..=hi).contains(&value) {
            return Err(Stop::arguments(format!("{name}: allowed is {lo} to {hi}")));
        }
    }
    let Arguments { vehicles, manager, pace, drops, weather, seed, .. } = arguments;
    let crew = Crew { vehicles, manager, pace, drops, weather, seed };
    let world = world(layout, &crew)?;
    if let Some(file) = &arguments.profiles {
        let text = profiles(&world);
        super::super::write_to(file, &text)?;
    }
    let record: Box<dyn Write> = match &arguments.record {
        Some(file) => Box::new(BufWriter::new(File::create(file).map_err(|error| Stop::not_written(file, &error))?)),
        None => Box::new(io::sink()),
    };
    let mut run = Run::open(world, &broker(&arguments.broker)?, &interfaces(&arguments.topics)?, &crew, record)?;
    let flag = Arc::new(AtomicBool::new(false));
    #[cfg(unix)]
    for signal in [signal_hook::consts::SIGINT, signal_hook::consts::SIGTERM] {
        // Where it cannot be caught, it ends the program as it does others.
        let _ = signal_hook::flag::register(signal, flag.clone());
    }
    let end = arguments.time.unwrap_or(f64::INFINITY);
    while !flag.load(Ordering::Relaxed) && run.fleet.time() < end {
        run.step()?;
        std::thread::sleep(Duration::from_millis(5));
    }
    let (time, done, drops) = (run.fleet.time(), run.done(), run.fleet.drops());
    run.close()?;
    let mut out = io::stdout().lock();
    writeln!(out, "{vehicles} vehicles, {time:.0} s of theirs: {done} missions done, {drops} connections lost")?;
    Ok(ExitCode::SUCCESS)
}

fn profiles(world: &World) -> String {
    let list: Vec<_> = world
        .profiles
        .iter()
        .map(|profile| {
            let (key, can) = (&profile.key, &profile.abilities);
            serde_json::json!({ "manufacturer": key.manufacturer, "serialNumber": key.serial_number, "radius": can.radius,
                "margin": can.margin, "speed": can.speed, "acceleration": can.acceleration, "split": profile.split })
        })
        .collect();
    format!("{:#}\n", serde_json::json!({ "vehicles": list }))
}

fn certified(file: &Path) -> Result<ExitCode, Stop> {
    let text = File::open(file).map_err(|error| Stop::wrong(file, error))?;
    let found = certify(BufReader::new(text)).map_err(|error| Stop::wrong(file, error))?;
    let mut out = io::stdout().lock();
    writeln!(out, "{}", serde_json::to_string(&found).unwrap_or_default())?;
    Ok(match found.verdict {
        "proved" => ExitCode::SUCCESS,
        "contact" => ExitCode::from(CONFLICTS),
        _ => ExitCode::from(UNDECIDED),
    })
}
