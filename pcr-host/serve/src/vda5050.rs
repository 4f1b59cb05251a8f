//! VDA 5050 (2.0, 2.1 and 3.0) between a fleet manager and vehicles; the messages are in `pcr_formats::vda5050`.
//!
//! ```text
//! ahead      nodes and edges ahead, in states                       NodeAhead, EdgeAhead
//! way        the path of an order, lengths of its nodes             Way
//! lane       one vehicle between its manager and the supervisor     Lane
//! bridge     the lanes of a fleet, no input or output of its own    Bridge
//! tls        certificates of brokers
//! mqtt       a connection to a broker                               Link
//! claim      which of several bridges is active
//! inbox      what has come and waits
//! station    the bridge at its broker; only one is active           Station
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
