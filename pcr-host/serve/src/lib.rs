//! A supervisor of fleets: it decides by exact passing orders how far each robot may go, and sends that to the robots.
//! `docs/guide/serve.md` describes how to use it, and what it guarantees.
//!
//! ```text
//! owned_path        paths that own their segments                      OwnedPath
//! page_layout       what the page draws, with its ids                  PageLayout
//! closed_area       an area that a person has closed                   ClosedArea
//! robot             state of a robot                                   RobotTraits
//! event             messages that it sends without a request
//! request_error     reasons why it refuses a request                   RequestError
//! setup_error       why a connection cannot be set up                  SetupError
//! journal_entry     data that have to survive the process              JournalEntry
//! journal           a file of entries                                  Journal
//! journal_writer    a journal on a thread of its own                   JournalWriter
//! supervisor        robots, missions, positions, authorities           Supervisor
//! standby           waits for the end of another supervisor         Standby
//! query             queries about a fleet                              Query
//! lines             the line protocol                                  handle
//! line_angles       degrees in its requests
//! bridge_status     what the metrics say of the bridge                 BridgeStatus
//! metrics           metrics for Prometheus
//! log               log on standard error                              LogWriter
//! telemetry         data that the supervisor's thread publishes        Telemetry
//! outbox            lines that wait for a client
//! unanswered_lines  lines of a client without an answer, up to a number
//! server            the thread that owns the supervisor                serve, ServerHandle
//! connection_limit  connections, up to a number at a time              ConnectionPermit
//! clients           standard input and output, and TCP
//! http              the live page
//! vda5050           VDA 5050 between a fleet manager and vehicles      Vda5050Bridge, BrokerSession
//! vehicles          simulated vehicles and a fleet manager             SimulatedVehicle, FleetManager
//! ```
//!
//! One thread owns the [`Supervisor`](supervisor::Supervisor). It handles messages of other threads in any number of
//! calls; then [`settle`](supervisor::Supervisor::settle) decides, writes the journal, and returns the messages to be
//! sent. If the journal has a thread of its own, they are sent as soon as it is on the disk, and messages that arrive
//! meanwhile are processed.

pub mod bridge_status;
pub mod clients;
pub mod closed_area;
mod connection_limit;
pub mod event;
pub mod hello;
pub mod http;
pub mod journal;
pub mod journal_entry;
pub mod journal_writer;
mod line_angles;
pub mod lines;
pub mod log;
mod metrics;
pub mod outbox;
pub mod owned_path;
pub mod page_layout;
pub mod query;
mod refusals;
pub mod request_error;
pub mod robot;
pub mod server;
pub mod setup_error;
pub mod sockets;
pub mod standby;
pub mod supervisor;
pub mod telemetry;
pub mod token;
mod unanswered_lines;
pub mod vda5050;
pub mod vehicles;
