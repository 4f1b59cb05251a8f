//! Motions of robots, for the queries of `pcr-core`.
//!
//! Between two poses a robot goes along the line at a constant speed, and turns at a constant rate, the shorter way. To a disc the
//! heading makes no difference. An outline that goes and turns at once is divided: in each part it keeps the heading of the middle, and
//! is larger by what the true heading can move its corners from there.

use crate::messages::Time;
use crate::planned_path::{PlannedPath, PlannedPose, wrapped};
use crate::refusal::Refusal;
use pcr_core::{Interval, Motion};
use pcr_rmf_mapf::{Error, Footprint, OwnedMotion, TimedPose, Trajectory};
use std::f64::consts::PI;

/// An outline that goes turns by no more in a part \[rad\].
const PART: f64 = 0.05;
/// An outline turns from the heading of one part to that of the next in this share of the time of a part, or in a shorter time, in which it goes no
/// further than this \[m\]. Shorter times would be accelerations out of range.
const TURNING_SHARE: f64 = 0.02;
const TURNING_LAG: f64 = 1e-3;
/// Distances \[m\] and angles \[rad\] that are rounding.
const ROUNDING: f64 = 1e-6;

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
        let (divided, swell) = match &footprint {
            Footprint::Disc { .. } => (poses.clone(), 0.0),
            Footprint::Polygon { corners } => {
                let reach = corners.iter().map(|[x, y]| x.hypot(*y)).fold(0.0, f64::max);
                divided(&poses, reach)?
            }
        };
        let mut travelled = vec![0.0];
        for pair in divided.windows(2) {
            travelled.push(travelled.last().copied().unwrap_or_default() + length(pair[0], pair[1]));
        }
        let trajectory = Trajectory::new(divided).with_footprint(footprint).with_margin(margin + swell);
        let owned = OwnedMotion::new(0, &trajectory).map_err(|error| match error {
            Error::Invalid { problem, .. } => Refusal::Range(problem),
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

/// Poses between which an outline goes or turns, but not both; and by how much it is larger \[m\]. Its corners are within `reach`.
fn divided(poses: &[TimedPose], reach: f64) -> Result<(Vec<TimedPose>, f64), Refusal> {
    let mut made: Vec<TimedPose> = poses.first().copied().into_iter().collect();
    let mut swell = 0.0_f64;
    // The heading at the end of what is made.
    let mut heading = made.first().map_or(0.0, |pose| pose.yaw);
    for (k, pair) in poses.windows(2).enumerate() {
        let [from, to] = [pair[0], pair[1]];
        let (by, distance) = (wrapped(to.yaw - from.yaw), length(from, to));
        if PI - by.abs() <= 4.0 * ROUNDING {
            return Err(Refusal::HalfTurn { pose: k + 1 });
        }
        // Also where it is rounding: rounding may add up, and what follows takes either a line or a turn.
        let both = distance > 0.0 && by != 0.0;
        let parts = if both { (by.abs() / PART).ceil().max(1.0) } else { 1.0 };
        let duration = (to.time - from.time) / parts;
        // It stands while it turns, and then catches up.
        let lag = (distance / parts * TURNING_SHARE).min(TURNING_LAG);
        let turning = duration * TURNING_SHARE.min(TURNING_LAG * parts / distance);
        let at = |share: f64, yaw: f64| TimedPose {
            time: from.time + share * (to.time - from.time),
            position: [0, 1].map(|axis| from.position[axis] + share * (to.position[axis] - from.position[axis])),
            yaw,
        };
        for part in 0..parts as u32 {
            let middle = from.yaw + by * (f64::from(part) + 0.5) / parts;
            let begin = if both { middle } else { from.yaw };
            if begin != heading {
                let before = at(f64::from(part) / parts, begin);
                made.push(TimedPose { time: before.time + turning, ..before });
                swell = swell.max(lag + ROUNDING);
            }
            heading = if both { middle } else { to.yaw };
            let is_last = f64::from(part) + 1.0 == parts;
            made.push(if is_last {
                TimedPose { yaw: heading, ..to }
            } else {
                at((f64::from(part) + 1.0) / parts, heading)
            });
        }
        if both {
            let most = by.abs() / parts * (0.5 + TURNING_SHARE);
            swell = swell.max(2.0 * reach * (most / 2.0).sin() + lag + ROUNDING);
        }
    }
    Ok((made, swell))
}
