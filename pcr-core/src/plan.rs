//! Plans without collisions, agent by agent in the order of their priorities: start delays and speed profiles.
//!
//! ```text
//! order       agents one after the other, and who moves up       Unsolved
//! delays      who starts when, moving as before                  plan_delays
//! times       sets of times of fixed capacity                    (internal)
//! constraint  where an agent must not be when                    Constraint
//! lattice     the motions among which a speed plan is chosen     Drive
//! station     what is remembered of a place along the path       Station
//! outcome     a speed plan, or why there is none                 SpeedPlan
//! search      the fastest of them that meets nobody              (internal)
//! tighten     its waits made as short as contacts allow          (internal)
//! speed       both                                               plan_speed
//! speeds      a fleet of them                                    plan_speeds
//! ```

mod constraint;
mod delays;
mod lattice;
mod order;
mod outcome;
mod search;
mod speed;
mod speeds;
mod station;
mod tighten;
mod times;

pub use constraint::Constraint;
pub use delays::plan_delays;
pub use lattice::Drive;
pub use order::Unsolved;
pub use outcome::{NoSpeedPlan, SpeedPlan};
pub use speed::plan_speed;
pub use speeds::plan_speeds;
pub use station::Station;
