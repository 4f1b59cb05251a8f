//! Motions of robots, for the queries of `pcr-core`.
//!
//! Between two poses a robot goes along the line at a constant speed, and turns at a constant rate, the shorter way. To a disc the heading makes no
//! difference.

use crate::messages::Time;
use crate::planned_path::{PlannedPath, PlannedPose, wrapped};
use crate::refusal::Refusal;
use pcr_core::{Interval, Motion};
use pcr_rmf_mapf::{Error, Footprint, OwnedMotion, TimedPose, Trajectory};

/// The largest deviation of an outline that goes and turns at once \[m\].
const DEVIATION: f64 = 1e-3;

/// A robot on its path. Times are in seconds since an origin.
pub(crate) struct RobotMotion {
    poses: Vec<TimedPose>,
    owned: OwnedMotion,
    /// What it has travelled at each of its waypoints \[m\]: the lengths of `owned` count turns as well.
    travelled: Vec<f64>,
}

impl RobotMotion {
    pub(crate) fn new(path: &PlannedPath, origin: Time, footprint: Footprint, margin: f64) -> Result<Self, Refusal> {
        let timed =
            |pose: &PlannedPose| TimedPose { time: pose.time.since(origin), position: pose.position, yaw: pose.yaw };
        let poses: Vec<TimedPose> = path.poses().iter().map(timed).collect();
        let mut travelled = vec![0.0];
        for pair in poses.windows(2) {
            travelled.push(travelled.last().copied().unwrap_or_default() + length(pair[0], pair[1]));
        }
        let trajectory = Trajectory::new(poses.iter().copied()).with_footprint(footprint).with_margin(margin);
        let owned = OwnedMotion::new(0, &trajectory.with_deviation(DEVIATION)).map_err(|error| match error {
            Error::Invalid { problem, .. } => Refusal::Range(problem),
            Error::HalfTurn { waypoint, .. } => Refusal::HalfTurn { pose: waypoint },
            other => Refusal::Motion(other),
        })?;
        owned.motion().map_err(Refusal::Range)?;
        Ok(Self { poses, owned, travelled })
    }

    pub(crate) fn motion(&self) -> Result<Motion<'_, f64>, Refusal> {
        self.owned.motion().map_err(Refusal::Range)
    }

    /// What it has travelled at a length of the path of [`RobotMotion::motion`] \[m\].
    pub(crate) fn travelled(&self, length: f64) -> f64 {
        let lengths = self.owned.lengths();
        // A turn has one travelled length, a wait one length.
        let next = lengths.partition_point(|&known| known < length);
        if next == 0 || next == lengths.len() {
            return self.travelled[next.min(lengths.len() - 1)];
        }
        let share = (length - lengths[next - 1]) / (lengths[next] - lengths[next - 1]);
        self.travelled[next - 1] + share * (self.travelled[next] - self.travelled[next - 1])
    }

    /// Where it is at a time: at its first pose before it sets off, and at its last one in the end.
    pub(crate) fn pose_at(&self, time: f64) -> TimedPose {
        let next = self.poses.partition_point(|pose| pose.time <= time);
        let from = self.poses[next.saturating_sub(1)];
        let Some(&to) = self.poses.get(next).filter(|_| next > 0) else { return TimedPose { time, ..from } };
        let share = (time - from.time) / (to.time - from.time);
        let position = [0, 1].map(|axis| from.position[axis] + share * (to.position[axis] - from.position[axis]));
        TimedPose { time, position, yaw: from.yaw + share * wrapped(to.yaw - from.yaw) }
    }

    /// When it is at a length of the path of [`RobotMotion::motion`] first.
    pub(crate) fn time_at(&self, motion: &Motion<'_, f64>, length: f64) -> f64 {
        motion.time_in(Interval::new(length, length)).lo
    }
}

fn length(from: TimedPose, to: TimedPose) -> f64 {
    (to.position[0] - from.position[0]).hypot(to.position[1] - from.position[1])
}
