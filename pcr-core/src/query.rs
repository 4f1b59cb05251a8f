//! Queries on motions and regions: whether and when two agents collide, and which times, lengths, delays and waits are
//! free.
//!
//! ```text
//! legs             a motion, split where its formula changes    (internal)
//! leg_windows      pairs of legs, while the agents may be near  (internal)
//! relative_motion  the relative motion between two instants     (internal)
//! bodies           outlines at an instant, and how long nothing changes (internal)
//! contact          when two agents are in contact               Encounter, Contacts
//! clearance        the closest approach of two agents
//! conflict         contacts with their place and depth          Conflict, Conflicts, first_conflict, first_overlap
//! broad_phase      which pairs of a fleet can be in contact, and when BroadPhase
//! safe             when a part of a path is free, and the dual  safe_intervals, safe_lengths
//! boundary_search  the end of a forbidden interval              (internal)
//! start_delay      start delays that lead to a conflict         earliest_start
//! departure        waits on the way                             earliest_departure
//! time_scaling     speed scale factors                          least_duration
//! ```

mod bodies;
mod boundary_search;
mod broad_phase;
mod clearance;
mod conflict;
mod contact;
mod departure;
mod leg_windows;
mod legs;
mod relative_motion;
mod safe;
mod start_delay;
mod time_scaling;

pub use broad_phase::BroadPhase;
pub use clearance::ClosestApproach;
pub use conflict::{AgentConflict, Conflict, Conflicts, first_conflict, first_overlap};
pub use contact::{Contacts, Encounter};
pub use departure::earliest_departure;
pub(crate) use safe::{covered_by, cut, times};
pub use safe::{safe_intervals, safe_lengths};
pub use start_delay::earliest_start;
pub use time_scaling::least_duration;
