//! The true state of a robot: its wheels slip, it is held up, and it is never exactly on its path.
//!
//! On a path its position is ρ(s) + d. s grows by the speed of the wheels minus the slip, and not at all while the
//! robot is held up; d is a drift of at most [`Disturbance::drift`]. Between two frames the robot moves uniformly.

use super::FRAME;
use super::braking::speed_within;
use super::course::Course;
use super::noise::{Noise, Purpose};
use super::task::Robot;
use super::vector::{Vector, add, limited, norm, scale, sub};
use pcr_core::Limits;

/// How the world differs from the plan.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disturbance {
    /// Largest error of an observed position \[m\].
    pub noise: f64,
    /// Largest part of its way that a robot loses to slip, 0 to 1.
    pub slip: f64,
    /// Longest time for which a robot is held up, on average every [`HELD_EVERY`] \[s\].
    pub delay: f64,
    /// How far a robot may be off its path \[m\].
    pub drift: f64,
}

/// Mean time between two times at which a robot is held up \[s\].
pub const HELD_EVERY: f64 = 10.0;

/// Time for which the slip of a robot stays the same \[s\].
const SLIPPING: f64 = 1.0;

/// Part of the largest drift by which it changes in a frame.
const DRIFTING: f64 = 0.1;

/// A robot on a path stands at its end when it is nearer than this \[m\].
const AT_END: f64 = 1e-3;

/// And at a turn in place when it is nearer than this \[m\].
pub(super) const AT_TURN: f64 = 1e-6;

/// A turn in place that a robot has begun.
#[derive(Clone, Copy, Debug)]
pub(super) struct Turning {
    /// Length along its course \[m\].
    pub(super) at: f64,
    /// For how long it has turned \[s\].
    pub(super) time: f64,
}

/// What a robot is told for a frame.
#[derive(Clone, Copy, Debug)]
pub(super) enum Command {
    /// It stands, and does not begin its mission.
    Stay,
    /// Along the path of its mission, at this speed where it does not turn in place \[m/s\].
    Along(f64),
    /// In any direction \[m/s\].
    Freely(Vector),
}

/// The true state of a robot.
#[derive(Clone, Debug)]
pub(super) struct Body {
    limits: Limits<f64>,
    disturbance: Disturbance,
    position: Vector,
    drift: Vector,
    /// Along the course \[m\].
    travelled: f64,
    /// Segments of the course up to the last turn in place.
    turned: usize,
    /// The next one, if it has begun.
    turning: Option<Turning>,
    /// Of the wheels \[m/s\].
    velocity: Vector,
    speed: f64,
    slip: f64,
    slips_until: f64,
    held: [f64; 2],
    wheels: Noise,
    drifts: Noise,
    camera: Noise,
}

impl Body {
    pub(super) fn new(robot: &Robot, place: usize, seed: u64, disturbance: Disturbance) -> Self {
        let noise = |purpose| Noise::new(seed, place, purpose);
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
            wheels: noise(Purpose::Wheels),
            drifts: noise(Purpose::Drift),
            camera: noise(Purpose::Camera),
        }
    }

    /// Where it is.
    pub(super) fn position(&self) -> Vector {
        self.position
    }

    /// Along its course \[m\]; of a robot that goes freely, 0.
    pub(super) fn travelled(&self) -> f64 {
        self.travelled
    }

    /// Speed of the wheels \[m/s\].
    pub(super) fn speed(&self) -> f64 {
        self.speed
    }

    /// The turn in place that it has begun and not done.
    pub(super) fn turning(&self) -> Option<Turning> {
        self.turning
    }

    /// What the camera sees.
    pub(super) fn observed(&mut self) -> Vector {
        add(self.position, self.camera.in_disc(self.disturbance.noise))
    }

    /// At the beginning of a course.
    pub(super) fn begin(&mut self) {
        (self.travelled, self.turned, self.turning) = (0.0, 0, None);
    }

    /// Whether it has come to the end of a course: on the path, or within `reach` of its end.
    pub(super) fn has_arrived(&mut self, course: &Course, reach: f64) -> bool {
        let end = course.length();
        if end - self.travelled <= AT_END && course.in_place(self.turned).is_none() {
            self.travelled = end;
            self.speed = 0.0;
            return true;
        }
        // Whoever keeps to its path has a reach of 0: at the end of a circle it is only once it has gone round.
        norm(sub(self.position, course.point_at(end))) < reach
    }

    /// One frame, from a time \[s\] on.
    pub(super) fn step(&mut self, time: f64, command: Command, course: Option<&Course>) {
        let part = self.part_that_counts(time);
        match command {
            Command::Stay => self.speed = 0.0,
            Command::Along(speed) => {
                let Some(course) = course else { return };
                // A robot knows the end of its path and where it turns, say from marks on the floor, and how fast it may be.
                let turn = course.in_place(self.turned);
                let left = turn.map_or(course.length(), |turn| turn.at) - self.travelled;
                if let Some(turn) = turn.filter(|_| left <= AT_TURN) {
                    self.speed = 0.0;
                    let time = self.turning.map_or(0.0, |turning| turning.time) + FRAME * part;
                    self.turning = Some(Turning { at: turn.at, time });
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
            Command::Freely(velocity) => {
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

    /// The part of the way of its wheels that a robot really makes.
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
