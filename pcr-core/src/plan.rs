//! Plans without collisions, agent by agent in the order of their priorities: start delays and speed profiles.
//!
//! ```text
//! prioritized      one agent after the other, and changes of order
//! delays           start delays of a fleet                             plan_delays
//! time_set         sets of times of fixed capacity                     (internal)
//! constraint       lengths that an agent must avoid during a time      Constraint
//! lattice          a set of motions from which a speed plan is chosen  (internal)
//! limits           limits of a speed plan
//! uniform_lattice  the motions under one speed and acceleration        (internal)
//! speed_limit      the motions that are nowhere faster than one        (internal)
//! search_node      data for each border of cells along the path
//! result           a speed plan, or why there is none                  SpeedPlan
//! search           the fastest of these motions without a conflict     (internal)
//! shorten_waits    shortens its waits as far as contacts allow         (internal)
//! speed            speed plan of one agent                             plan_speed, plan_speed_below
//! speeds           speed plans of a fleet                              plan_speeds
//! ```

mod constraint;
mod delays;
mod lattice;
mod limits;
mod prioritized;
mod result;
mod search;
mod search_node;
mod shorten_waits;
mod speed;
mod speed_limit;
mod speeds;
mod time_set;
mod uniform_lattice;

pub use constraint::Constraint;
pub use delays::plan_delays;
pub use limits::SpeedPlanLimits;
pub use prioritized::PlanError;
pub use result::{SpeedPlan, SpeedPlanError};
pub use search_node::SearchNode;
pub use speed::{plan_speed, plan_speed_below};
pub use speeds::plan_speeds;
