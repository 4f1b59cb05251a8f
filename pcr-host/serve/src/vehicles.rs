//! Simulated VDA 5050 vehicles and a simulated fleet manager, to try and test a supervisor.
//!
//! ```text
//! drive      along a way, from stop to stop                      Drive
//! vehicle    one vehicle: messages in, messages out              Vehicle
//! tell       messages of a vehicle
//! record     true positions of vehicles, and their proof         Record, certify
//! weather    messages that come late, twice, or out of order     Weather
//! locks      locks that keep vehicles apart, for comparison      Locks
//! manager    missions without end                                Manager
//! audit      whether two vehicles hold the same place            Audit
//! fleet      vehicles at a broker                                Fleet
//! office     the manager at a broker                             Office
//! world      a layout with vehicles and their manager            World
//! yard       all of them with a supervisor, without a broker     Yard
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
