//! Paths as they are read from messages: poses in a plane, with their times.

use crate::config::Pace;
use crate::messages::{FleetRobotState, PathMessage, Quaternion, Time};
use crate::refusal::Refusal;
use std::f64::consts::{PI, TAU};

/// How far a quaternion may be from one of length 1 about `z`.
const ROTATION: f64 = 1e-3;

/// A pose in the plane, and when it is reached.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlannedPose {
    /// When.
    pub time: Time,
    /// Position \[m\].
    pub position: [f64; 2],
    /// Heading, counter-clockwise from the `x` axis \[rad\].
    pub yaw: f64,
}

/// A path that was read: one pose or more, at increasing times, all numbers finite.
#[derive(Clone, Debug, PartialEq)]
pub struct PlannedPath {
    published: Time,
    poses: Vec<PlannedPose>,
}

impl PlannedPath {
    /// Reads a path. Heights are checked to be numbers, and then not used. With a pace, times are those of a robot that sets off when the path
    /// was published.
    ///
    /// # Errors
    /// [`Refusal`], with the number of the pose.
    pub fn read(message: &PathMessage, frame: &str, pace: Option<Pace>) -> Result<Self, Refusal> {
        let other_frame = |given: &str| Refusal::Frame { given: given.to_owned(), expected: frame.to_owned() };
        if message.header.frame_id != frame {
            return Err(other_frame(&message.header.frame_id));
        }
        let mut poses = Vec::with_capacity(message.poses.len());
        for (pose, stamped) in message.poses.iter().enumerate() {
            // Many planners leave the frame of single poses empty: it is that of the path.
            if !["", frame].contains(&stamped.header.frame_id.as_str()) {
                return Err(other_frame(&stamped.header.frame_id));
            }
            let at = stamped.pose.position;
            if ![at.x, at.y, at.z].into_iter().all(f64::is_finite) {
                return Err(Refusal::NotFinite { pose });
            }
            let yaw = yaw(stamped.pose.orientation, pose)?;
            poses.push(PlannedPose { time: stamped.header.stamp, position: [at.x, at.y], yaw });
        }
        let published = message.header.stamp;
        Self::new(
            published,
            match pace {
                Some(pace) => paced(&poses, pace, published)?,
                None => poses,
            },
        )
    }

    /// Reads the path of a robot in a fleet of Open-RMF: from where it is, through what is before it.
    ///
    /// # Errors
    /// [`Refusal`]; pose 0 is where it is.
    pub fn read_fleet(robot: &FleetRobotState, level: &str) -> Result<Self, Refusal> {
        let mut poses = Vec::with_capacity(robot.path.len() + 1);
        for at in std::iter::once(&robot.location).chain(&robot.path) {
            if at.level_name != level {
                return Err(Refusal::Frame { given: at.level_name.clone(), expected: level.to_owned() });
            }
            poses.push(PlannedPose { time: at.t, position: [at.x.into(), at.y.into()], yaw: at.yaw.into() });
        }
        Self::new(robot.location.t, poses)
    }

    /// A path that was published at a time.
    ///
    /// # Errors
    /// [`Refusal::Empty`], [`Refusal::NotFinite`], [`Refusal::Nanoseconds`], [`Refusal::Time`].
    pub fn new(published: Time, poses: Vec<PlannedPose>) -> Result<Self, Refusal> {
        if poses.is_empty() {
            return Err(Refusal::Empty);
        }
        let is_finite = |pose: &PlannedPose| pose.yaw.is_finite() && pose.position.into_iter().all(f64::is_finite);
        if let Some(pose) = poses.iter().position(|pose| !is_finite(pose)) {
            return Err(Refusal::NotFinite { pose });
        }
        let mut times = std::iter::once(published).chain(poses.iter().map(|pose| pose.time));
        if times.any(|time| time.nanosec >= 1_000_000_000) {
            return Err(Refusal::Nanoseconds);
        }
        let is_later = |pair: &[PlannedPose]| pair[1].time.nanoseconds() > pair[0].time.nanoseconds();
        if let Some(before) = poses.windows(2).position(|pair| !is_later(pair)) {
            return Err(Refusal::Time { pose: before + 1 });
        }
        Ok(Self { published, poses })
    }

    /// Checks that it was published at most `most` seconds before `now`, or after it.
    ///
    /// # Errors
    /// [`Refusal::Old`], [`Refusal::Future`].
    pub fn check_age(&self, now: Time, most: f64) -> Result<(), Refusal> {
        let age = now.since(self.published);
        if age > most {
            return Err(Refusal::Old { most });
        }
        if -age > most {
            return Err(Refusal::Future { most });
        }
        Ok(())
    }

    /// The poses.
    pub fn poses(&self) -> &[PlannedPose] {
        &self.poses
    }
}

/// The poses with the times of a robot that sets off at `begin`. Of poses that are the same one is left: there is no time between them.
fn paced(poses: &[PlannedPose], pace: Pace, begin: Time) -> Result<Vec<PlannedPose>, Refusal> {
    let mut made: Vec<PlannedPose> = Vec::with_capacity(poses.len());
    let mut seconds = 0.0;
    for (pose, &at) in poses.iter().enumerate() {
        if let Some(last) = made.last() {
            let length = (at.position[0] - last.position[0]).hypot(at.position[1] - last.position[1]);
            let duration = (length / pace.speed).max(wrapped(at.yaw - last.yaw).abs() / pace.turn);
            // Times are told in nanoseconds.
            if duration < 1e-9 {
                continue;
            }
            seconds += duration;
        }
        made.push(PlannedPose { time: begin.later(seconds).ok_or(Refusal::Time { pose })?, ..at });
    }
    Ok(made)
}

/// An angle within half a turn of 0 \[rad\].
pub(crate) fn wrapped(angle: f64) -> f64 {
    (angle + PI).rem_euclid(TAU) - PI
}

/// The angle of a rotation about `z` \[rad\].
fn yaw(of: Quaternion, pose: usize) -> Result<f64, Refusal> {
    let Quaternion { x, y, z, w } = of;
    if ![x, y, z, w].into_iter().all(f64::is_finite) {
        return Err(Refusal::NotFinite { pose });
    }
    let length = (x * x + y * y + z * z + w * w).sqrt();
    if (length - 1.0).abs() > ROTATION || x.hypot(y) > ROTATION {
        return Err(Refusal::Rotation { pose });
    }
    Ok(2.0 * z.atan2(w))
}
