//! `pcr fleet`.

mod run;

pub(super) use run::{FleetRun, FleetSimulationOptions, world};

use super::{CliError, number, parse_integer};
use clap::Args;
use std::path::PathBuf;
use std::process::ExitCode;

const STATUSES: &str = "\
Exit status:
  0  done; of a record: nobody touched anybody, proved
  1  two vehicles had the right of way at one place, or some did not come to
     their ends; of a record: there was a contact
  2  wrong arguments, or a file that cannot be read or was refused
  3  the record could not be written
  4  of a record: undecided, because two came too near for its rounding, or
     because the record is incomplete";

const EXAMPLES: &str = "\
Examples:
  pcr fleet site.geojson --broker localhost:1883             8 vehicles
  pcr fleet site.geojson --broker localhost:1883 --manager   with missions
  pcr fleet site.geojson --manager --record run.txt --time 600 --pace 10
  pcr fleet --certify run.txt                                nobody touched
  pcr fleet site.geojson --alone supervisor --time 3600      without a broker
  pcr fleet site.geojson --alone edge-locks --time 3600      and with locks

User and password of the broker: PCR_BROKER_USER and PCR_BROKER_PASSWORD.";

/// Simulate VDA 5050 vehicles and their fleet manager
#[derive(Args)]
#[command(after_help = format!("{EXAMPLES}\n\n{STATUSES}"))]
pub(super) struct FleetArgs {
    /// Layout (goals: its safe ends); standard input if left out or `-`
    layout: Option<PathBuf>,
    /// A site of N streets each way, instead of a layout
    #[arg(long, value_name = "N", value_parser = |text: &str| number::<usize>(text, "a whole number from 2 to 100"))]
    streets: Option<usize>,
    /// Address of the broker
    #[arg(long, value_name = "HOST:PORT", default_value = "localhost:1883")]
    broker: String,
    /// Number of vehicles
    #[arg(long, value_name = "N", default_value_t = 8, value_parser = parse_integer::<usize>)]
    vehicles: usize,
    /// Also simulate the manager that gives them missions
    #[arg(long)]
    manager: bool,
    /// First levels of topics
    #[arg(long, value_names = ["M", "V"], num_args = 2, default_values = ["fleet", "uagv"])]
    topics: Vec<String>,
    /// Speed relative to real time, 0.1 to 100
    #[arg(long, value_name = "N", default_value_t = 1.0, value_parser = |text: &str| number::<f64>(text, "a number from 0.1 to 100"))]
    pace: f64,
    /// End after this simulated time
    #[arg(long, value_name = "S", value_parser = |text: &str| number::<f64>(text, "a number from 0.1 to 1e7"))]
    time: Option<f64>,
    /// After --time, continue until all missions are done or none is completed for 1 h
    #[arg(long)]
    finish: bool,
    /// No broker; supervisor, route-locks or edge-locks
    #[arg(long, value_name = "METHOD")]
    alone: Option<String>,
    /// Lost connections of a vehicle per hour
    #[arg(long, value_name = "N", default_value_t = 0.0, value_parser = |text: &str| number::<f64>(text, "a number from 0 to 1e4"))]
    drops: f64,
    /// Fraction of messages lost; the same fraction is repeated, and the same is late
    #[arg(long, value_name = "PART", default_value_t = 0.0, value_parser = |text: &str| number::<f64>(text, "a number from 0 to 0.5"))]
    weather: f64,
    /// The same seed makes the same vehicles
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = parse_integer::<u64>)]
    seed: u64,
    /// Write the true positions to this file, at the end
    #[arg(long, value_name = "FILE")]
    record: Option<PathBuf>,
    /// Prove from a record, or `-`, that no two touched
    #[arg(long, value_name = "FILE")]
    certify: Option<PathBuf>,
    /// Also write them for `pcr serve --fleet`, or `-`
    #[arg(long, value_name = "FILE")]
    profiles: Option<PathBuf>,
}

impl FleetArgs {
    pub(super) fn run(self) -> Result<ExitCode, CliError> {
        run::run(self)
    }
}
