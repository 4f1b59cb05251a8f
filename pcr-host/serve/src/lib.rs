//! A supervisor of fleets: it decides by exact passing orders how far each robot may go, and says so. `docs/serve.md` says how to use
//! it, and what it promises.
//!
//! ```text
//! course       owned paths                                              Course, Shape
//! robot        what is known of a robot                                 Robot, Abilities
//! event        what it says by itself                                   Event
//! fault        why it refuses a request                                 Fault
//! entry        what has to outlive the process                          Entry, Keep
//! journal      a file of entries                                        Journal
//! json         JSON in which no name comes twice                        Once
//! writer       a journal on a thread of its own                         Writer, Kept
//! supervisor   robots, missions, positions, holds                       Supervisor
//! query        what can be asked                                        Question
//! lines        the line protocol                                        handle
//! metrics      what is measured, for Prometheus
//! log          what is written to standard error                        Log
//! board        what that thread shows                                   Board
//! server       the thread that owns the supervisor                      serve, Handle
//! clients      standard input and output, and TCP
//! http         the live page
//! vda5050      VDA 5050 between a fleet manager and vehicles            Bridge, Station
//! vehicles     simulated vehicles and a fleet manager                   Vehicle, Fleet
//! ```
//!
//! One thread owns the [`Supervisor`](supervisor::Supervisor); what others send it is handled in any number of calls, then
//! [`settle`](supervisor::Supervisor::settle) decides, writes the journal, and returns what may be told. With a journal on a thread
//! of its own it is told as soon as it is on the disc, and what comes meanwhile is decided.

pub mod board;
pub mod clients;
pub mod course;
pub mod entry;
pub mod event;
pub mod fault;
pub mod http;
pub mod journal;
pub mod json;
pub mod lines;
pub mod log;
pub mod metrics;
pub mod query;
pub mod robot;
pub mod server;
pub mod supervisor;
pub mod vda5050;
pub mod vehicles;
pub mod writer;
