//! The true state of a robot: its wheels slip, it is held up, and it is never exactly on its path.
//!
//! On a path its position is ρ(s) + d. s grows by the speed of the wheels minus the slip, and not at all while the
//! robot is held up; d is a drift of at most [`Disturbance::drift`]. Between two frames the robot moves uniformly.

use super::FRAME;
use super::braking::speed_within;
use super::noise::{NoiseSource, NoiseStream};
use super::simulation_task::RobotTask;
use super::speed_limited_path::SpeedLimitedPath;
use super::vector::{PlaneVector, add, limited, norm, scale, sub};
use pcr_core::Limits;

/// Differences between the world and the plan.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disturbance {
    /// Largest error of an observed position \[m\].
    pub noise: f64,
    /// Largest share of its way that a robot loses to slip, 0 to 1.
    pub slip: f64,
    /// Longest time for which a robot is held up, on average every 10 s \[s\].
    pub delay: f64,
    /// Largest distance of a robot from its path \[m\].
    pub drift: f64,
}

/// Mean time between two times at which a robot is held up \[s\].
pub(crate) const HELD_EVERY: f64 = 10.0;

/// Time for which the slip of a robot stays the same \[s\].
const SLIPPING: f64 = 1.0;

/// Largest change of the drift in a frame, as a share of the largest drift.
const DRIFTING: f64 = 0.1;

/// A robot on a path has arrived if it is nearer to the end than this \[m\].
const AT_END: f64 = 1e-3;

/// A robot is at a turn in place if it is nearer than this \[m\].
pub(super) const AT_TURN: f64 = 1e-6;

/// A turn in place that a robot has begun.
#[derive(Clone, Copy, Debug)]
pub(super) struct TurnState {
    /// Length along its course \[m\].
    pub(super) at: f64,
    /// Time for which it has turned \[s\].
    pub(super) time: f64,
}

/// A command to a robot for a frame.
#[derive(Clone, Copy, Debug)]
pub(super) enum MotionCommand {
    /// Stand, and do not begin the mission.
    Stay,
    /// Drive along the path of the mission at this speed, except in turns in place \[m/s\].
    Along(f64),
    /// Drive with this velocity \[m/s\].
    Freely(PlaneVector),
}

/// The true state of a robot.
#[derive(Clone, Debug)]
pub(super) struct TrueRobotState {
    limits: Limits<f64>,
    disturbance: Disturbance,
    position: PlaneVector,
    drift: PlaneVector,
    /// Length travelled on the course \[m\].
    travelled: f64,
    /// Number of segments of the course up to the last turn in place.
    turned: usize,
    /// The next turn in place, if it has begun.
    turning: Option<TurnState>,
    /// Velocity of the wheels \[m/s\].
    velocity: PlaneVector,
    speed: f64,
    slip: f64,
    slips_until: f64,
    held: [f64; 2],
    wheels: NoiseStream,
    drifts: NoiseStream,
    camera: NoiseStream,
}

impl TrueRobotState {
    pub(super) fn new(robot: &RobotTask, place: usize, seed: u64, disturbance: Disturbance) -> Self {
        let noise = |purpose| NoiseStream::new(seed, place, purpose);
        Self {
            limits: robot.limits,
            disturbance,
            position: robot.home(),
            drift: [0.0; 2],
            travelled: 0.0,
            turned: 0,
            turning: None,
            velocity: [0.0; 2],
            speed: 0.0,
            slip: 0.0,
            slips_until: 0.0,
            held: [0.0; 2],
            wheels: noise(NoiseSource::Wheels),
            drifts: noise(NoiseSource::Drift),
            camera: noise(NoiseSource::Camera),
        }
    }

    /// True position.
    pub(super) fn position(&self) -> PlaneVector {
        self.position
    }

    /// Length travelled on its course \[m\]; 0 for a robot that is not bound to a path.
    pub(super) fn travelled(&self) -> f64 {
        self.travelled
    }

    /// Speed of the wheels \[m/s\].
    pub(super) fn speed(&self) -> f64 {
        self.speed
    }

    /// The turn in place that it has begun and not finished.
    pub(super) fn turning(&self) -> Option<TurnState> {
        self.turning
    }

    /// The position that the camera sees.
    pub(super) fn observed(&mut self) -> PlaneVector {
        add(self.position, self.camera.in_disc(self.disturbance.noise))
    }

    /// Puts it at the beginning of a course.
    pub(super) fn begin(&mut self) {
        (self.travelled, self.turned, self.turning) = (0.0, 0, None);
    }

    /// Whether it has reached the end of a course: along the path, or within `reach` of the end.
    pub(super) fn has_arrived(&mut self, course: &SpeedLimitedPath, reach: f64) -> bool {
        let end = course.length();
        if end - self.travelled <= course.end_tolerance(AT_END) && course.in_place(self.turned).is_none() {
            self.travelled = end;
            self.speed = 0.0;
            return true;
        }
        // A robot on a path has a reach of 0: on a circle, being near the end does not mean that it has driven round.
        norm(sub(self.position, course.point_at(end))) < reach
    }

    /// Moves it by a frame that begins at a time \[s\].
    pub(super) fn step(&mut self, time: f64, command: MotionCommand, course: Option<&SpeedLimitedPath>) {
        let part = self.part_that_counts(time);
        match command {
            MotionCommand::Stay => self.speed = 0.0,
            MotionCommand::Along(speed) => {
                let Some(course) = course else { return };
                // A robot knows the end of its path, its turns in place and its speed limits, for example from marks on the
                // floor.
                let turn = course.in_place(self.turned);
                let left = turn.map_or(course.length(), |turn| turn.at) - self.travelled;
                if let Some(turn) = turn.filter(|_| left <= AT_TURN) {
                    self.speed = 0.0;
                    let time = self.turning.map_or(0.0, |turning| turning.time) + FRAME * part;
                    self.turning = Some(TurnState { at: turn.at, time });
                    if time >= turn.duration {
                        (self.turned, self.turning) = (turn.segment + 1, None);
                    }
                    return;
                }
                let allowed = course.allowed(self.travelled, self.limits.acceleration, FRAME);
                self.speed = speed.min(allowed).min(speed_within(left, self.limits.acceleration, FRAME));
                self.travelled += self.speed * FRAME * part;
                if self.speed > 0.0 {
                    self.drift();
                }
                self.position = add(course.point_at(self.travelled), self.drift);
            }
            MotionCommand::Freely(velocity) => {
                let change = limited(sub(velocity, self.velocity), self.limits.acceleration * FRAME);
                self.velocity = limited(add(self.velocity, change), self.limits.speed);
                self.speed = norm(self.velocity);
                let before = self.drift;
                if self.speed > 0.0 {
                    self.drift();
                }
                let way = scale(self.velocity, FRAME * part);
                self.position = add(add(self.position, way), sub(self.drift, before));
            }
        }
    }

    fn drift(&mut self) {
        let step = self.drifts.in_disc(DRIFTING * self.disturbance.drift);
        self.drift = limited(add(self.drift, step), self.disturbance.drift);
    }

    /// The share of the way of its wheels that it really travels.
    fn part_that_counts(&mut self, time: f64) -> f64 {
        if time >= self.slips_until {
            self.slip = self.disturbance.slip * self.wheels.unit();
            self.slips_until = time + SLIPPING;
        }
        if time >= self.held[1] {
            let from = time - HELD_EVERY * (1.0 - self.wheels.unit()).ln();
            self.held = [from, from + self.disturbance.delay * self.wheels.unit()];
        }
        if self.held[0] <= time && time < self.held[1] { 0.0 } else { 1.0 - self.slip }
    }
}
