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

mod admit;
mod brakes;
mod check;
#[cfg(feature = "std")]
mod grow;
mod hold;
mod order;
mod refused;
mod table;
mod told;

pub use admit::Mission;
pub use brakes::Brakes;
pub use check::{Reach, Tolerances};
pub use hold::Hold;
pub use order::{Order, Pass, Progress};
pub use refused::Refused;
pub use table::Orders;
pub use told::Decision;
