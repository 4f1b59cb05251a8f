//! VDA 5050 (2.0, 2.1 and 3.0) between a fleet manager and vehicles.
//!
//! ```text
//! stamp      time stamps
//! bounds     sizes, counts and numbers of a message                 Limits
//! door       conversion of bytes to values                          Refusal
//! version    which edition of the standard                          Version
//! topics     names of topics                                        Interface, Key, Kind
//! header     header of every message                                Header
//! order      orders                                                 Order
//! state      states, positions                                      State
//! ahead      nodes and edges ahead, in states                       NodeAhead, EdgeAhead
//! messages   the other messages                                     Connection, InstantActions
//! held       an order as its receiver keeps it, updates stitched    Held
//! way        the path of an order, lengths of its nodes             Way
//! lane       one vehicle between its manager and the supervisor     Lane
//! bridge     the lanes of a fleet, no input or output of its own    Bridge
//! tls        certificates of brokers
//! mqtt       a connection to a broker                               Link
//! claim      which of several bridges is active
//! inbox      what has come and waits
//! station    the bridge at its broker; only one is active           Station
//! ```

pub mod ahead;
mod bounds;
pub mod bridge;
#[cfg(feature = "mqtt")]
mod claim;
pub mod door;
pub mod header;
pub mod held;
#[cfg(feature = "mqtt")]
mod inbox;
pub mod lane;
pub mod messages;
#[cfg(feature = "mqtt")]
pub mod mqtt;
pub mod order;
pub mod stamp;
pub mod state;
#[cfg(feature = "mqtt")]
pub mod station;
#[cfg(feature = "tls")]
mod tls;
pub mod topics;
pub mod version;
pub mod way;
