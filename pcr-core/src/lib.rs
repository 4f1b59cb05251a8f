//! Exact collision regions of discs and convex outlines that move on lines and arcs: `no_std`, no allocation, no panics.
//!
//! Agents are discs, or convex polygons rounded by a radius ([`Outline`]), that move along given paths. For every ordered pair of agents, the set of (time, travelled length)
//! at which the two overlap is a union of *collision regions*, whose boundary has a closed form. This crate
//! computes the regions from these closed forms, without sampling, iteration or meshes. Speeds may be anything that is
//! not negative. Degenerate positions, such as tangent or concentric segments, are covered by the same bounds
//! (`tests/tests/degenerate.rs`).
//!
//! The modules, in the order in which they depend on one another:
//!
//! ```text
//! scalar       number formats: f32, f64, or your own          Scalar, Wide, Unit, Angle
//! geometry     points, directions, intervals, boxes           Point, Pose, Interval
//! intervals    unions and gaps of intervals, without storage  union, gaps
//! segment      lines and arcs placed in the plane             Segment, Curve
//! outline      convex polygons, rounded by a radius           Outline
//! path         chains of segments, turns in place (ρ, Eq. 1)  Path, PathRef
//! profile      length over time (λ, Eq. 1-3) and its inverse  Profile, ProfileRef, Limits
//! motion       disc or outline + path + profile + start       Motion
//! fleet_storage   paths and profiles of a fleet, in a static  FleetStorage, FleetMotions
//! pair         closed forms in coordination space (l₁, l₂)    (internal: P1, P3, events, cells)
//! piece_store  storage of region pieces, fixed capacity       Piece
//! region       connected regions in path-time space (t, l)    RegionRef
//! ecm          table of all regions of a fleet                Ecm
//! overlaps     regions of two agents, without a table         overlaps
//! query        conflicts, safe intervals, delays, waits       Encounter, BroadPhase, safe_intervals, earliest_start
//! precedence   who passes first, safe under any delays        PrecedenceTable, MovementAuthority
//! plan         start delays and speed plans by priority       plan_delays, plan_speed, plan_speeds
//! crossing     the paper's descriptors (Table VII)            Crossing, crossings
//! ```
//!
//! Start at [`Ecm`], which has an example. Signs: `x` along the direction of travel, `y` to its left, angles and turns
//! counter-clockwise positive. Units: metres, seconds, radians.
//!
//! # Features
//! - `libm` (default): implements [`Scalar`] for `f32` and `f64`;
//! - `outlines` (default): agents that are convex outlines; without it all are discs, and programs are smaller;
//! - `alloc`: tables whose storage grows ([`Ecm`]);
//! - `std`: `alloc`, takes square roots from the standard library and inlines functions that are called often, for which a host
//!   has enough memory; results have the same bits and take less time;
//! - `micromath`: adds `scalar::Micro`, an `f32` that uses the approximations of the crate micromath and refines them;
//! - `defmt`, `serde`: implement the traits of these crates for the public data types.
#![cfg_attr(docsrs, feature(doc_cfg))]
#![no_std]

pub mod scalar;

mod array_vec;
mod bit_rows;
mod crossing;
mod ecm;
mod error;
mod fleet_storage;
mod geometry;
#[cfg(feature = "internals")]
#[doc(hidden)]
pub mod internals;
mod intervals;
mod lap;
mod motion;
mod outline;
mod overlaps;
mod pair;
mod path;
mod piece_store;
mod plan;
mod precedence;
mod profile;
mod query;
mod region;
mod segment;

pub use crossing::{Crossing, crossings};
pub use ecm::{Ecm, EcmCapacity, EcmEntry};
pub use error::{CapacityError, EcmError, InvalidInput, MismatchError};
pub use fleet_storage::{FleetMotions, FleetStorage, FleetStorageError, NewAgent, StagedAgent};
pub use geometry::{Aabb, Direction, Interval, Point, Pose, Vector};
pub use intervals::{Gaps, Union, gaps, union};
pub use lap::Branch;
pub use motion::{LENGTH_TOLERANCE_LOG2, Motion};
pub use outline::{Corner, Outline, OutlineRef};
pub use overlaps::overlaps;
pub use path::{Path, PathRef};
pub use piece_store::Piece;
pub use plan::{
    Constraint, PlanError, SearchNode, SpeedPlan, SpeedPlanError, SpeedPlanLimits, plan_delays, plan_speed,
    plan_speed_below, plan_speeds,
};
pub use precedence::{
    AdmissionError, BrakingModel, CheckState, CheckTolerances, MovementAuthority, PassingState, PathProposal,
    PrecedenceDecision, PrecedenceTable, Progress, RegionPrecedence,
};
pub use profile::{Limits, Phase, Profile, ProfileRef};
pub use query::{
    AgentConflict, BroadPhase, ClosestApproach, Conflict, Conflicts, Contacts, Encounter, earliest_departure,
    earliest_start, first_conflict, first_overlap, least_duration, safe_intervals, safe_lengths,
};
pub use region::{PieceRef, PieceType, RegionRef, excess};
#[cfg(feature = "libm")]
pub use scalar::Radians;
pub use scalar::Scalar;
pub use segment::{Curve, Segment, TurnSide};

#[cfg(all(test, feature = "libm"))]
mod recorded;
