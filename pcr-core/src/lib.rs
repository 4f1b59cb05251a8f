//! Exact collision regions of discs that move on lines and arcs: `no_std`, allocation-free, panic-free.
//!
//! Agents are discs on given paths. For every ordered pair, the set of (time, travelled length) at which the two
//! overlap is a union of *collision regions* with a boundary in closed form. This crate computes them without
//! sampling, iteration or meshes: no speed assumption, every degenerate case included.
//!
//! Data flows one way through the modules:
//!
//! ```text
//! scalar     numbers: f32, f64, or your own format          Scalar, Wide, Unit, Angle
//! geometry   points, directions, intervals, boxes           Point, Pose, Interval
//! intervals  unions and gaps without storage                union, gaps
//! segment    lines and arcs, placed in the plane            Segment, Curve, Turn
//! path       chains of them, turns between (ρ of Eq. 1)     Path, PathRef
//! profile    speed over time (λ of Eq. 1-3), and inverse    Profile, ProfileRef, Limits
//! motion     disc + path + profile + start (Eq. 2)          Motion
//! pair       closed forms in coordination space (l₁, l₂)    (internal: P1, P3, events, cells)
//! pieces     their fixed-capacity store                     Piece
//! region     connected regions in path-time space (t, l)    RegionRef
//! ecm        all regions of a fleet                         Ecm
//! overlaps   those of two agents alone                      overlaps
//! query      conflicts, safe intervals, delays, waits       Encounter, BroadPhase, safe_intervals, earliest_start
//! orders     who passes whom, kept whatever the delays     Orders, Hold
//! plan       start delays and speeds by priorities          plan_delays, plan_speed, plan_speeds
//! crossing   the paper's descriptors (Table VII)            Crossing, crossings
//! ```
//!
//! Start at [`Ecm`], which has an example. Signs: `x` along the direction of travel, `y` to its left, angles and turns
//! counter-clockwise positive. Units: metres, seconds, radians.
//!
//! # Features
//! - `libm` (default): `f32` and `f64`;
//! - `std`: square roots by the standard library, and copies of what is called often, for which a host has room: the same bits in
//!   less time;
//! - `micromath`: `scalar::Micro`, `f32` on the refined approximations of that crate;
//! - `defmt`, `serde`: their traits on the public data types.
#![no_std]

pub mod scalar;

mod bits;
mod crossing;
mod ecm;
mod error;
mod few;
mod geometry;
#[cfg(feature = "internals")]
#[doc(hidden)]
pub mod internals;
mod intervals;
mod motion;
mod orders;
mod overlaps;
mod pair;
mod path;
mod pieces;
mod plan;
mod profile;
mod query;
mod region;
mod segment;

pub use crossing::{Crossing, crossings};
pub use ecm::{Ecm, Region};
pub use error::{Full, Invalid, Mismatch, Unchanged};
pub use geometry::{Bounds, Direction, Interval, Point, Pose, Vector};
pub use intervals::{Gaps, Union, gaps, union};
pub use motion::{LENGTH_TOLERANCE_LOG2, Motion};
pub use orders::{Brakes, Decision, Hold, Mission, Order, Orders, Pass, Progress, Reach, Refused, Tolerances};
pub use overlaps::overlaps;
pub use pair::footprint::Share;
pub use path::{Path, PathRef};
pub use pieces::Piece;
pub use plan::{Constraint, Drive, NoSpeedPlan, SpeedPlan, Station, Unsolved, plan_delays, plan_speed, plan_speeds};
pub use profile::{Limits, Phase, Profile, ProfileRef};
pub use query::{
    Approach, BroadPhase, Conflict, Conflicts, Contacts, Encounter, Met, earliest_departure, earliest_start,
    first_conflict, first_overlap, least_duration, safe_intervals, safe_lengths,
};
pub use region::{PieceRef, PieceType, RegionRef, excess};
#[cfg(feature = "libm")]
pub use scalar::Radians;
pub use scalar::Scalar;
pub use segment::{Curve, Segment, Turn};

#[cfg(all(test, feature = "libm"))]
mod recorded;
