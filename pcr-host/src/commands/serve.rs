//! `pcr serve`, if the tool is built with `serve`.

#[cfg(feature = "serve")]
mod bridge;
#[cfg(feature = "serve")]
mod demo;
#[cfg(feature = "serve")]
mod run;
#[cfg(feature = "serve")]
mod threads;

#[cfg(feature = "serve")]
pub(super) use bridge::{VEHICLES, broker, interfaces};
#[cfg(feature = "serve")]
pub(super) use run::AT_BROKERS;

use super::Stop;
use clap::{ArgGroup, Args};
use std::path::PathBuf;
use std::process::ExitCode;

const STATUSES: &str = "\
Exit status:
  0  standard input has ended, and nobody else can ask
  2  wrong arguments, or a journal that is damaged or open elsewhere
  3  the journal could not be opened or written: no right was given, or none after that";

const EXAMPLES: &str = "\
Examples:
  pcr serve --journal state                    lines of JSON on standard input and output (docs/serve.md)
  pcr serve --journal state --listen 7070      the same for clients over TCP on this machine
  pcr serve --journal state --page 8080        and a page on http://localhost:8080 to watch it
  pcr serve --journal state --stay --broker localhost:1883 --fleet vehicles.json     VDA 5050
  pcr serve --demo warehouse_graph.geojson     broker, vehicles, their manager and the page";

/// Supervise a fleet: decide how far each robot may go, by exact passing orders
#[derive(Args)]
#[command(after_help = format!("{EXAMPLES}\n\n{STATUSES}"))]
#[command(group = ArgGroup::new("vda5050").args(["broker", "demo"]))]
#[cfg_attr(not(feature = "serve"), allow(dead_code))]
pub(super) struct Arguments {
    /// Directory of the journal; it outlives the program
    #[arg(long, value_name = "DIR")]
    journal: Option<PathBuf>,
    /// Clients over TCP: a port of this machine, or ADDRESS:PORT
    #[arg(long, value_name = "PORT")]
    listen: Option<String>,
    /// The live page and metrics: a port of this machine, or ADDRESS:PORT
    #[arg(long, value_name = "PORT")]
    page: Option<String>,
    /// Go on when standard input has ended
    #[arg(long)]
    stay: bool,
    /// Robots may stand so far behind a stop, in m [0.1; VDA: 0.3]
    #[arg(long, value_name = "M")]
    width: Option<f64>,
    /// Robots are told how far they may go so long before they would have to brake, in s [2; VDA 5050: 8, the least]
    #[arg(long, value_name = "S")]
    lookahead: Option<f64>,
    /// A robot is silent when it was not heard for so long, in s
    #[arg(long, value_name = "S", default_value_t = 5.0)]
    silence: f64,
    /// Broker of a fleet of VDA 5050, HOST:PORT; user and password from PCR_BROKER_USER and PCR_BROKER_PASSWORD
    #[arg(long, value_name = "HOST:PORT", requires = "fleet")]
    broker: Option<String>,
    /// Certificate (PEM) of who has signed the broker's: TLS
    #[arg(long, value_name = "FILE", requires = "broker")]
    authority: Option<PathBuf>,
    /// The vehicles, as docs/serve.md says
    #[arg(long, value_name = "FILE", requires = "broker")]
    fleet: Option<PathBuf>,
    /// First levels of the topics of the fleet manager and of the vehicles
    #[arg(long, value_names = ["MANAGER", "VEHICLES"], num_args = 2, default_values = ["fleet", "uagv"])]
    #[arg(requires = "vda5050")]
    topics: Vec<String>,
    /// Start a broker, vehicles on this layout and their manager, too
    #[arg(long, value_name = "LAYOUT", conflicts_with_all = ["broker", "fleet"])]
    demo: Option<PathBuf>,
    /// Vehicles of the demo
    #[arg(long, value_name = "N", default_value_t = 8, requires = "demo")]
    vehicles: usize,
    /// Logs on standard error: debug, info, warn or error
    #[arg(long, value_name = "LEVEL", default_value = "info")]
    log: String,
}

#[cfg(not(feature = "serve"))]
impl Arguments {
    pub(super) fn run(self) -> Result<ExitCode, Stop> {
        Err(Stop::arguments("this pcr was built without `serve`: cargo install --path pcr-host --features serve"))
    }
}

#[cfg(feature = "serve")]
impl Arguments {
    pub(super) fn run(self) -> Result<ExitCode, Stop> {
        run::run(self)
    }
}
