//! VDA 5050 (2.0, 2.1 and 3.0) between a fleet manager and vehicles; the messages are in `pcr_formats::vda5050`.
//!
//! ```text
//! remaining_elements  nodes and edges ahead, in states
//! edge_orientation    the heading of a vehicle on an edge
//! order_path          the path of an order, lengths of its nodes                OrderPath
//! vehicle_adapter     one vehicle between its manager and the supervisor
//! bridge              the vehicles of a fleet, no input or output of its own
//! tls                 certificates of brokers
//! mqtt                a connection to a broker
//! leader_election     which of several supervisors is active
//! inbox               messages that have come and wait
//! broker_session      the bridge at its broker; only one is active              BrokerSession
//! ```

pub mod bridge;
#[cfg(feature = "mqtt")]
pub mod broker_session;
mod edge_orientation;
#[cfg(feature = "mqtt")]
mod inbox;
#[cfg(feature = "mqtt")]
mod leader_election;
#[cfg(feature = "mqtt")]
pub mod mqtt;
pub mod order_path;
pub mod remaining_elements;
#[cfg(feature = "tls")]
mod tls;
pub mod vehicle_adapter;
