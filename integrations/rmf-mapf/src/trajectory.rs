//! Trajectories: poses and times, with a footprint.

/// A pose, and when it is reached.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimedPose {
    /// Time \[s\].
    pub time: f64,
    /// Position \[m\].
    pub position: [f64; 2],
    /// Heading, counter-clockwise from the `x` axis \[rad\]; to a disc it makes no difference.
    pub yaw: f64,
}

/// What an agent occupies.
#[derive(Clone, Debug, PartialEq)]
pub enum Footprint {
    /// A disc around the position, as the agents of the planner are.
    Disc {
        /// Radius \[m\].
        radius: f64,
    },
    /// A convex polygon of up to 16 corners.
    Polygon {
        /// Corners in the frame of the agent, `x` forward and `y` to the left, counter-clockwise \[m\].
        corners: Vec<[f64; 2]>,
    },
}

/// The trajectory of an agent. Between two waypoints it moves along a line at a constant speed, or turns in place, or waits; or it moves and turns
/// ([`Trajectory::with_deviation`]).
/// Before the first one it stands there, and at the last one it stays.
#[derive(Clone, Debug, PartialEq)]
pub struct Trajectory {
    pub(crate) poses: Vec<TimedPose>,
    pub(crate) footprint: Option<Footprint>,
    pub(crate) margin: f64,
    pub(crate) deviation: f64,
}

impl Trajectory {
    /// A trajectory through these poses, without a footprint yet.
    pub fn new(poses: impl IntoIterator<Item = TimedPose>) -> Self {
        Self { poses: poses.into_iter().collect(), footprint: None, margin: 0.0, deviation: 0.0 }
    }

    /// The poses of a plan in equal steps of time \[s\], as executors exchange them.
    pub fn sampled(step: f64, poses: impl IntoIterator<Item = ([f64; 2], f64)>) -> Self {
        let pose = |(k, (position, yaw))| TimedPose { time: k as f64 * step, position, yaw };
        Self::new(poses.into_iter().enumerate().map(pose))
    }

    /// Returns the trajectory with this footprint.
    #[must_use]
    pub fn with_footprint(self, footprint: Footprint) -> Self {
        Self { footprint: Some(footprint), ..self }
    }

    /// Returns the trajectory with a margin around the footprint \[m\]; without it there is none.
    #[must_use]
    pub fn with_margin(self, margin: f64) -> Self {
        Self { margin, ..self }
    }

    /// Returns the trajectory of an outline that may move and turn at once, both at constant rates. Its path is made of arcs then, which deviate by this
    /// \[m\] at most, and it is larger by three times that. Without it, or with 0, such a trajectory is refused.
    #[must_use]
    pub fn with_deviation(self, deviation: f64) -> Self {
        Self { deviation, ..self }
    }

    /// Adds waypoints in between, so that none is later than the one before by more than `longest` \[s\]. Waypoints get new indices; the
    /// second list has the new index of each old one. Nothing is added for a time that is not positive, nor on the way to a waypoint at which the
    /// agent has made half a turn: it is not said to which side.
    #[must_use]
    pub fn divided(&self, longest: f64) -> (Self, Vec<usize>) {
        let mut poses: Vec<TimedPose> = self.poses.first().copied().into_iter().collect();
        let mut indices = vec![0; poses.len()];
        // The heading of a disc makes no difference.
        let is_turning = !matches!(self.footprint, Some(Footprint::Disc { .. }));
        for pair in self.poses.windows(2) {
            let [from, to] = [pair[0], pair[1]];
            let parts = ((to.time - from.time) / longest).ceil();
            let is_divided = parts.is_finite() && parts >= 1.0 && !(is_turning && is_half_turn(from, to));
            let parts = if is_divided { parts as u32 } else { 1 };
            let turn = wrapped(to.yaw - from.yaw);
            for k in 1..parts {
                let share = f64::from(k) / f64::from(parts);
                let between = |a: f64, b: f64| a + share * (b - a);
                poses.push(TimedPose {
                    time: between(from.time, to.time),
                    position: [0, 1].map(|axis| between(from.position[axis], to.position[axis])),
                    yaw: from.yaw + share * turn,
                });
            }
            poses.push(to);
            indices.push(poses.len() - 1);
        }
        (Self { poses, ..self.clone() }, indices)
    }

    /// The waypoints.
    pub fn poses(&self) -> &[TimedPose] {
        &self.poses
    }
}

/// Distances \[m\] and angles \[rad\] that are rounding, and nothing else: single precision some metres from the origin. The footprint is larger
/// by what they move it.
pub(crate) const ROUNDING: f64 = 1e-6;

/// Whether the headings of two poses are opposite, also if a motion is off by rounding at the first one.
pub(crate) fn is_half_turn(from: TimedPose, to: TimedPose) -> bool {
    std::f64::consts::PI - wrapped(to.yaw - from.yaw).abs() <= 2.0 * ROUNDING
}

/// An angle within half a turn of 0 \[rad\].
pub(crate) fn wrapped(angle: f64) -> f64 {
    use std::f64::consts::{PI, TAU};
    (angle + PI).rem_euclid(TAU) - PI
}
