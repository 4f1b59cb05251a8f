//! A supervisor of a fleet for a microcontroller: it receives agents and sends their collision regions.
//!
//! The same code runs on the target and on the host, so that tests on the host apply to the target:
//!
//! ```text
//! number     what a number format has to offer besides the arithmetic    Number
//! agent      an agent as it is sent, and how it comes into storage      Agent, Step
//! message    requests and answers, regions as they are sent              Request, Answer
//! can        authority and progress in frames of CAN and CAN FD          Message
//! frame      their bytes on the line: COBS, check, version               Frame, Receiver
//! table      what a supervisor keeps of its fleet                        Table
//! traffic    the same with orders, for robots under way                  Traffic
//! service    answers requests                                            Service
//! session    does each once, whatever the line does to them              Session
//! client     who asks                                                    Client
//! robot      keeps the orders of one robot, and computes its hold        Briefing, Robot
//! scenario   the paper's 12 agents, in each format                       (generated)
//! dump       the table as text                                           region
//! ```
#![no_std]

pub mod agent;
pub mod can;
pub mod client;
pub mod dump;
pub mod frame;
pub mod message;
pub mod number;
pub mod robot;
pub mod scenario;
pub mod service;
pub mod session;
pub mod table;
pub mod traffic;

pub use agent::{Agent, Step};
pub use client::{Client, Event};
pub use message::{Answer, Request};
pub use number::Number;
pub use robot::{Briefing, Robot};
pub use service::{Replies, Service};
pub use session::{Line, Session};
pub use table::Table;
pub use traffic::Traffic;
