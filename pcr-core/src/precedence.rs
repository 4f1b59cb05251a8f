//! Passing orders: which agent passes a collision region first. Agents that keep them never collide, whatever their
//! delays (docs/theory/precedence.md).
//!
//! ```text
//! hold        how far the second agent may go at one region         Hold, RegionRef::hold
//! brakes      stopping distances                                    Brakes
//! order       which agent passes first                              Pass, Order, Progress
//! table       the orders of a fleet                                 Orders
//! refused     why orders are refused                                Refused
//! check       whether all agents can finish                         Orders::check
//! admit       orders for a new path                                 Orders::admit
//! told        which agent waits for which, and decisions            Orders::wait, Decision
//! grow        storage that grows                                    Orders::grow
//! ```

mod admission;
mod authority;
mod braking;
mod deadlock_check;
mod decision_log;
mod entry;
mod error;
mod table;
#[cfg(feature = "alloc")]
#[cfg_attr(docsrs, doc(cfg(feature = "alloc")))]
mod vec_storage;

pub use admission::PathProposal;
pub use authority::MovementAuthority;
pub use braking::BrakingModel;
pub use deadlock_check::{CheckState, CheckTolerances};
pub use decision_log::PrecedenceDecision;
pub use entry::{PassingState, Progress, RegionPrecedence};
pub use error::AdmissionError;
pub use table::PrecedenceTable;
