//! Trajectories that the planner returns.

use crate::trajectory::{TimedPose, Trajectory};
use mapf::motion::r2::WaypointR2;
use mapf::motion::se2::WaypointSE2;
use mapf::motion::{TimePoint, Trajectory as Planned, Waypoint};

fn seconds(time: TimePoint) -> f64 {
    time.as_secs_f64()
}

fn poses<W: Waypoint>(planned: &Planned<W>, pose: impl Fn(&W) -> TimedPose) -> Trajectory {
    Trajectory::new(planned.iter().map(|waypoint| pose(&waypoint)))
}

/// What the planner returns for robots that turn.
impl From<&Planned<WaypointSE2>> for Trajectory {
    fn from(planned: &Planned<WaypointSE2>) -> Self {
        poses(planned, |waypoint| TimedPose {
            time: seconds(waypoint.time),
            position: waypoint.position.translation.vector.into(),
            yaw: waypoint.position.rotation.angle(),
        })
    }
}

/// What it returns for robots without a heading.
impl From<&Planned<WaypointR2>> for Trajectory {
    fn from(planned: &Planned<WaypointR2>) -> Self {
        poses(planned, |waypoint| TimedPose {
            time: seconds(waypoint.time),
            position: waypoint.position.coords.into(),
            yaw: 0.0,
        })
    }
}
