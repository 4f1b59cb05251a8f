//! One robot as the supervisor knows it.

use super::FRAME;
use super::body::AT_TURN;
use super::braking::stopping_length;
use super::course::{Course, Drive};
use super::replan::State;
use super::task::Robot;
use crate::regions::Failure;
use pcr_core::{Interval, Invalid, Limits, Point, Pose, Radians};

/// What is known of the errors of camera and robots.
#[derive(Clone, Copy, Debug)]
pub(super) struct Errors {
    /// Of an observed position \[m\].
    pub(super) noise: f64,
    /// Of a robot from its path \[m\].
    pub(super) drift: f64,
}

/// One robot as the supervisor knows it.
#[derive(Debug)]
pub(super) struct Agent {
    pub(super) limits: Limits<f64>,
    /// Radius, with the margins for passing orders and for plans \[m\].
    pub(super) radius: f64,
    pub(super) margins: [f64; 2],
    /// The path that it is on, and where on it.
    pub(super) course: Course,
    pub(super) at: Interval<f64>,
    /// What it was told for the last frame \[m/s\].
    pub(super) speed: f64,
    /// For how long it has turned in place, if it does \[s\].
    pub(super) turned: f64,
    /// A mission that no plan takes up yet.
    pub(super) next: Option<Course>,
    /// Of a first mission that is known before it begins: when it begins \[s\]; else 0.
    pub(super) release: f64,
}

impl Agent {
    /// A robot that stands where its first mission begins.
    ///
    /// # Errors
    /// [`Failure::Robot`] where its path, or its disc with the margins, is out of range.
    pub(super) fn new(robot: &Robot, errors: Errors) -> Result<Self, Failure> {
        let course = match robot.missions.first() {
            Some(mission) => Ok(mission.course.beginning()),
            None => standing(robot.home()),
        };
        let limits = robot.limits;
        // A robot goes straight during a frame, not along the arc: off its middle by the sagitta, and nowhere farther from the path than
        // half the way from one of its ends, however sharp the path turns.
        let way = limits.speed * FRAME;
        let least = robot.missions.iter().map(|mission| mission.course.least_radius()).fold(f64::INFINITY, f64::min);
        // Where it turns in place, it cuts the corner by how far it may be before it.
        let turns = robot.missions.iter().any(|mission| mission.course.in_place(0).is_some());
        let corner = if turns { AT_TURN } else { 0.0 };
        let off = errors.drift + (way * way / (8.0 * least)).min(way / 2.0) + corner;
        let agent = Self {
            limits,
            radius: robot.radius,
            margins: [robot.margin + off, robot.margin + off + errors.drift + errors.noise],
            course: course.map_err(|_| Failure::Robot(robot.id))?,
            at: Interval::new(0.0, 0.0),
            speed: 0.0,
            turned: 0.0,
            next: None,
            release: 0.0,
        };
        let largest = agent.radius + agent.margins[1];
        let fits =
            |course: &Course| Drive::at_unit_speed(course.clone()).is_some_and(|it| it.motion(largest).is_some());
        match fits(&agent.course) && robot.missions.iter().all(|mission| fits(&mission.course)) {
            true => Ok(agent),
            false => Err(Failure::Robot(robot.id)),
        }
    }

    /// Whether it stands at the end of its path.
    pub(super) fn stands(&self) -> bool {
        self.speed <= 0.0 && self.at.lo >= self.course.length()
    }

    /// The path that a plan is for, which takes up a new mission or does not, and where the robot is on it.
    pub(super) fn to_plan(&self, takes_up: bool) -> (&Course, Interval<f64>, f64) {
        match &self.next {
            Some(next) if takes_up => (next, Interval::new(0.0, 0.0), 0.0),
            _ => (&self.course, self.at, self.speed),
        }
    }

    /// At its top speed it can stop before this in the next frame as well \[m\]: what holds it beyond does not matter yet.
    pub(super) fn horizon(&self) -> f64 {
        let Limits { speed, acceleration } = self.limits;
        self.at.hi + 2.0 * speed * FRAME + stopping_length(speed, acceleration, FRAME)
    }

    /// As a plan takes it, with one of its margins.
    pub(super) fn state(&self, margin: usize, taken: bool) -> Option<State> {
        let (course, at, speed) = self.to_plan(taken);
        let radius = self.radius + self.margins.get(margin)?;
        Some(State {
            rest: course.from(at.middle()).ok()?.turned(self.turned),
            speed,
            limits: self.limits,
            release: self.release,
            radius,
        })
    }
}

/// A place to stand.
pub(super) fn standing([x, y]: [f64; 2]) -> Result<Course, Invalid> {
    Course::standing(Pose { position: Point::new(x, y), heading: Radians(0.0) })
}
