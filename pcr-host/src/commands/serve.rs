//! `pcr serve`.

mod bridge;
mod check;
mod demo;
mod listen;
mod page;
mod run;
mod standby;
mod threads;

use super::{CliError, parse_integer, within};
use clap::Args;
use pcr_serve::log::{LogLevel, LogWriter};
use std::fmt::Display;
use std::net::{SocketAddr, TcpListener};
use std::path::PathBuf;
use std::process::ExitCode;

const STATUSES: &str = "\
Exit status:
  0  ended by the end of standard input (without --stay), or by Ctrl-C;
     with --check: nothing is wrong
  2  wrong arguments, a journal that is damaged or in use, or another
     supervisor at work at the broker
  3  the journal could not be opened or written, after which no robot was
     allowed to go further; or the connection to the broker failed for good;
     or (without --stay) standard output is full";

const EXAMPLES: &str = "\
Examples:
  pcr serve --journal state                  lines of JSON (docs/guide/serve.md)
  pcr serve --journal state --listen         the same at the socket state/socket
  pcr serve --journal state --listen 7070    and over TCP, with state/token
  pcr serve --journal state --page 8080      and a page: http://localhost:8080
  pcr serve --journal state --stay --broker localhost:1883 --fleet vehicles.json
  pcr serve --journal state --standby --page 8081   beside the first one
  pcr serve --demo warehouse_graph.geojson   broker, vehicles, manager and page";

/// Supervise a fleet: decide how far each robot may go now
#[derive(Args)]
#[command(after_help = format!("{EXAMPLES}\n\n{STATUSES}"))]
pub(super) struct ServeArgs {
    /// Only say what would be wrong at the start
    #[arg(long)]
    check: bool,
    /// Directory of the journal; a start goes on from it
    #[arg(long, value_name = "DIR")]
    journal: Option<PathBuf>,
    /// Clients of the lines: at the socket DIR/socket, at unix:PATH, or over TCP at PORT or ADDRESS:PORT
    #[arg(long, value_name = "PLACE", num_args = 0..=1, default_missing_value = listen::USUAL, value_parser = listen::place)]
    listen: Vec<listen::ListenAddress>,
    /// File with the token of clients over TCP [default: DIR/token]
    #[arg(long, value_name = "FILE", hide_short_help = true)]
    token_file: Option<PathBuf>,
    /// Let --listen take clients of other machines, without encryption
    #[arg(long, hide_short_help = true)]
    allow_remote: bool,
    /// The live page and metrics: a port, or ADDRESS:PORT
    #[arg(long, value_name = "PORT", value_parser = parse_listen_address)]
    page: Option<String>,
    /// Do not end when standard input ends
    #[arg(long)]
    stay: bool,
    /// Wait, and take over when the supervisor at work ends
    #[arg(long)]
    standby: bool,
    /// How near to its hold a waiting robot's reported position has to come, in m [0.1; VDA 5050: 0.3]
    #[arg(long, value_name = "M", value_parser = |text: &str| within(text, 0.001, 10.0))]
    width: Option<f64>,
    /// Tell a robot to go on this long before it must brake, in s [2; VDA 5050: 8, also the least]
    #[arg(long, value_name = "S", value_parser = |text: &str| within(text, 0.1, 600.0))]
    lookahead: Option<f64>,
    /// A robot is silent after this time, in s
    #[arg(long, value_name = "S", default_value_t = 5.0, value_parser = |text: &str| within(text, 0.1, 86400.0))]
    silence: f64,
    /// Broker of a fleet of VDA 5050; user and password from PCR_BROKER_USER, PCR_BROKER_PASSWORD
    #[arg(long, value_name = "HOST:PORT")]
    broker: Option<String>,
    /// TLS, trusting the certificates in FILE (PEM)
    #[arg(long, value_name = "FILE")]
    authority: Option<PathBuf>,
    /// The file of vehicles (docs/guide/serve.md)
    #[arg(long, value_name = "FILE")]
    fleet: Option<PathBuf>,
    /// First levels of topics
    #[arg(long, value_names = ["M", "V"], num_args = 2, default_values = ["fleet", "uagv"])]
    topics: Vec<String>,
    /// Start a broker, vehicles on LAYOUT and a manager
    #[arg(long, value_name = "LAYOUT")]
    demo: Option<PathBuf>,
    /// Vehicles of the demo
    #[arg(long, value_name = "N", default_value_t = 8, value_parser = parse_integer::<usize>)]
    vehicles: usize,
    /// debug, info, warn or error [default: info]
    #[arg(long, value_name = "LEVEL")]
    log: Option<String>,
}

/// Where to listen, as it is written.
fn parse_listen_address(text: &str) -> Result<String, String> {
    let port = text.rsplit_once(':').map_or(text, |(_, port)| port);
    match port.parse::<u16>() {
        Ok(_) => Ok(text.to_owned()),
        Err(_) => Err("a port (0 to 65535) or ADDRESS:PORT is expected".into()),
    }
}

/// Listens at one of some addresses, and says in the log at which, with other values.
fn bound(
    option: &str,
    place: &str,
    addresses: &[SocketAddr],
    values: &[(&str, &dyn Display)],
    log: LogWriter,
) -> Result<TcpListener, CliError> {
    let wrong = |error: std::io::Error| CliError::arguments(format!("{option}: {place}: {error}"));
    let listener = TcpListener::bind(addresses).map_err(wrong)?;
    let address = listener.local_addr().map_err(wrong)?;
    let first: [(&str, &dyn Display); 2] = [("for", &option), ("address", &address)];
    log.write(LogLevel::Info, "listening", &[&first[..], values].concat());
    Ok(listener)
}

impl ServeArgs {
    pub(super) fn run(self) -> Result<ExitCode, CliError> {
        if self.check { check::check(&self) } else { run::run(self) }
    }
}
