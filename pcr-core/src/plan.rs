//! Plans without collisions: start delays and speed profiles, by priorities.
//!
//! ```text
//! delays      who starts when, moving as before                  plan_delays
//! times       sets of times of fixed capacity                    (internal)
//! lattice     the motions among which a speed plan is chosen     Drive
//! search      the fastest of them that meets nobody              (internal)
//! tighten     its waits made as short as contacts allow          (internal)
//! speed       both                                               plan_speed
//! ```

mod delays;
mod lattice;
mod search;
mod speed;
mod tighten;
mod times;

pub use delays::{Unsolved, plan_delays};
pub use lattice::Drive;
pub use speed::{NoSpeedPlan, SpeedPlan, Station, plan_speed};
