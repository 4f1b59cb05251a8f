//! Which robot waits for which, for plans of [`mapf`], the planner of Open-RMF, that are executed with delays.
//!
//! A planner of paths says when each robot is where. Robots are late, so an executor needs another answer: which waypoint a robot may head for
//! once another one has reached which waypoint. [`Dependencies::of`] computes it from the collision regions of the paths: two robots that
//! keep to it do not touch, however late they are, and all of them arrive.
//!
//! ```
//! use mapf::motion::{Trajectory as Planned, se2::WaypointSE2};
//! use pcr_rmf_mapf::{Dependencies, Footprint, Trajectory};
//!
//! // A robot goes east through the crossing, and another one north, behind it.
//! let east = [(0.0, -2.0, 0.0, 0.0), (4.0, 2.0, 0.0, 0.0)];
//! let north = [(0.0, 0.0, -3.0, 1.5708), (2.0, 0.0, -3.0, 1.5708), (6.0, 0.0, 1.0, 1.5708)];
//! let planned = |poses: &[(f64, f64, f64, f64)]| {
//!     let waypoints = poses.iter().map(|&(time, x, y, yaw)| WaypointSE2::new_f64(time, x, y, yaw));
//!     Planned::from_iter(waypoints).expect("two waypoints or more")
//! };
//! let robot = |poses| Trajectory::from(&planned(poses)).with_footprint(Footprint::Disc { radius: 0.4 });
//!
//! let dependencies = Dependencies::of(&[robot(&east), robot(&north)])?;
//! let only: Vec<_> = dependencies.iter().collect();
//! assert_eq!(only.len(), 1);
//! // The robot that goes north heads for its last waypoint after the other one has arrived.
//! assert_eq!((only[0].agent, only[0].waypoint, only[0].waits_for, only[0].reached), (1, 2, 0, 1));
//! assert!(!dependencies.may_proceed(1, &[0, 1])?);
//! assert!(dependencies.may_proceed(1, &[1, 1])?);
//! # Ok::<(), pcr_rmf_mapf::Error>(())
//! ```
//!
//! With the waypoints of a planner, which are where robots turn, the second robot waits until the first one has arrived. With waypoints in between
//! ([`Trajectory::divided`]) it follows as close as the paths allow.

mod dependencies;
mod error;
mod motion;
mod trajectory;

pub use dependencies::{Dependencies, Dependency};
pub use error::Error;
pub use trajectory::{Footprint, TimedPose, Trajectory};
