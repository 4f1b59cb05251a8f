//! Simulated VDA 5050 vehicles and a simulated fleet manager, to try and test a supervisor.
//!
//! ```text
//! vehicle_motion      along a way, from stop to stop
//! vehicle             one vehicle: messages in, messages out
//! outgoing_messages   messages of a vehicle
//! record              true positions of vehicles, and their proof      certify
//! lossy_channel       messages that come late, twice, or out of order
//! edge_reservations   locks that keep vehicles apart, for comparison
//! manager             missions without end
//! release_audit       whether two vehicles hold the same place
//! simulated_fleet     vehicles at a broker
//! manager_client      the manager at a broker
//! simulated_site      a layout with vehicles and their manager
//! offline_simulation  all of them with a supervisor, without a broker
//! ```

pub mod edge_reservations;
pub mod lossy_channel;
pub mod manager;
#[cfg(feature = "mqtt")]
pub mod manager_client;
pub mod offline_simulation;
mod outgoing_messages;
pub mod record;
pub mod release_audit;
#[cfg(feature = "mqtt")]
pub mod simulated_fleet;
pub mod simulated_site;
pub mod vehicle;
pub mod vehicle_motion;
