//! Simulated VDA 5050 vehicles and a simulated fleet manager, to try a supervisor with and to test it.
//!
//! ```text
//! random     numbers from a seed
//! drive      along a way, from stop to stop                          Drive
//! vehicle    one vehicle: messages in, messages out                  Vehicle
//! tell       what it says
//! record     where vehicles really were, and the proof of it         Record, certify
//! weather    messages that come late, twice, or in another order     Weather
//! locks      what keeps vehicles apart otherwise                     Locks
//! manager    missions without end                                    Manager
//! audit      whether two have the right to one place                 Audit
//! fleet      all of them at a broker                                 Fleet
//! office     the manager at a broker                                 Office
//! world      a layout with vehicles and their manager                World
//! yard       all of them and a supervisor without a broker           Yard
//! ```

pub mod audit;
pub mod drive;
#[cfg(feature = "mqtt")]
pub mod fleet;
pub mod locks;
pub mod manager;
#[cfg(feature = "mqtt")]
pub mod office;
pub mod random;
pub mod record;
mod tell;
pub mod vehicle;
pub mod weather;
pub mod world;
pub mod yard;
