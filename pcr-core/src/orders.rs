//! Passing orders: who passes a collision region first. Kept, nobody collides, whatever the delays (docs/theory.md).
//!
//! ```text
//! hold        how far the second may go past one region             Hold, RegionRef::hold
//! brakes      stopping ways                                         Brakes
//! order       who passes first                                      Pass, Order, Progress
//! table       the orders of a fleet, kept                           Orders
//! check       whether everybody can finish                          Orders::check, Refused
//! admit       orders for a new path                                 Orders::admit
//! ```

mod admit;
mod brakes;
mod check;
mod hold;
mod order;
mod table;

pub use admit::Mission;
pub use brakes::Brakes;
pub use check::{Reach, Refused, Tolerances};
pub use hold::Hold;
pub use order::{Order, Pass, Progress};
pub use table::Orders;
