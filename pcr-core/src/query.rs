//! Queries on motions and regions: whether and when two agents collide, and which times, lengths, delays and waits are
//! free.
//!
//! ```text
//! legs        a motion, split where its formula changes          (internal)
//! windows     pairs of legs, while the agents may be near        (internal)
//! chord       the relative motion between two instants           (internal)
//! bodies      outlines at an instant, and how long nothing changes (internal)
//! contact     when two agents are in contact                     Encounter, Contacts
//! clearance   the closest approach of two agents                 Approach
//! conflict    contacts with their place and depth                Conflict, Conflicts, first_conflict, first_overlap
//! broad_phase which pairs of a fleet can be in contact, and when BroadPhase
//! safe        when a part of a path is free, and the dual        safe_intervals, safe_lengths
//! bracket     the end of a forbidden interval                    (internal)
//! delay       start delays that lead to a conflict               earliest_start
//! depart      waits on the way                                   earliest_departure
//! stretch     speed scale factors                                least_duration
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
