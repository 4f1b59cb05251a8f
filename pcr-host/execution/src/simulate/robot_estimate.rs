//! A robot, as the supervisor knows it.

use super::FRAME;
use super::braking::stopping_length;
use super::replan::RobotState;
use super::simulation_task::RobotTask;
use super::speed_limited_path::{OwnedMotion, SpeedLimitedPath};
use super::true_state::AT_TURN;
use pcr_core::{Interval, InvalidInput, Limits, Point, Pose, Radians};
use pcr_planning::failure::ComputationError;
use pcr_planning::fleet::ConvexBody;

/// Bounds on the errors of camera and robots.
#[derive(Clone, Copy, Debug)]
pub(super) struct ErrorBounds {
    /// Error of an observed position \[m\].
    pub(super) noise: f64,
    /// Distance of a robot from its path \[m\].
    pub(super) drift: f64,
}

/// A robot, as the supervisor knows it.
#[derive(Debug)]
pub(super) struct RobotEstimate {
    pub(super) limits: Limits<f64>,
    /// The body with the margins for passing orders and for plans.
    pub(super) bodies: [ConvexBody; 2],
    /// The body with its own margin.
    pub(super) body: ConvexBody,
    /// How far it may be off its path: the margin for passing orders beyond its own \[m\].
    pub(super) off: f64,
    /// The present path, and the interval of lengths in which the robot is.
    pub(super) course: SpeedLimitedPath,
    pub(super) position_interval: Interval<f64>,
    /// Reported speed of the wheels \[m/s\].
    pub(super) speed: f64,
    /// Time for which it has turned in place; 0 if it does not turn \[s\].
    pub(super) turned: f64,
    /// A mission that is in no plan yet.
    pub(super) next: Option<SpeedLimitedPath>,
    /// Begin of the first mission, if it is known in advance \[s\]; otherwise 0.
    pub(super) release: f64,
}

impl RobotEstimate {
    /// A robot that stands where its first mission begins.
    ///
    /// # Errors
    /// [`ComputationError::Robot`] if its path, or its disc with the margins, is out of range.
    pub(super) fn new(robot: &RobotTask, errors: ErrorBounds) -> Result<Self, ComputationError> {
        let course = match robot.missions.first() {
            Some(mission) => Ok(mission.course.beginning()),
            None => standing(robot.home(), 0.0),
        };
        let limits = robot.limits;
        // A robot goes straight during a frame, not along the arc: off its middle by the sagitta, and nowhere farther from the path than
        // half the way from one of its ends, however sharp the path turns.
        let way = limits.speed * FRAME;
        let least = robot.missions.iter().map(|mission| mission.course.least_radius()).fold(f64::INFINITY, f64::min);
        // Where it turns in place, it cuts the corner by how far it may be before it.
        let turns = robot.missions.iter().any(|mission| mission.course.in_place(0).is_some());
        let corner = if turns { AT_TURN } else { 0.0 };
        // Nor does it turn evenly where its path turns by another radius, or begins to; of a disc that moves nothing.
        let uneven = robot.missions.iter().map(|mission| mission.course.uneven_turn(limits.speed, FRAME));
        let turn = if robot.body.is_disc() { 0.0 } else { robot.body.reach() * uneven.fold(0.0, f64::max) };
        let off = errors.drift + (way * way / (8.0 * least)).min(way / 2.0) + corner + turn;
        let margins = [robot.margin + off, robot.margin + off + errors.drift + errors.noise];
        let inflated = |margin: f64| robot.body.inflated(margin).map_err(|_| ComputationError::Robot(robot.id));
        let agent = Self {
            limits,
            bodies: [inflated(margins[0])?, inflated(margins[1])?],
            body: inflated(robot.margin)?,
            off,
            course: course.map_err(|_| ComputationError::Robot(robot.id))?,
            position_interval: Interval::new(0.0, 0.0),
            speed: 0.0,
            turned: 0.0,
            next: None,
            release: 0.0,
        };
        let fits = |course: &SpeedLimitedPath| {
            OwnedMotion::at_unit_speed(course.clone()).is_some_and(|it| it.motion_of(&agent.bodies[1]).is_some())
        };
        match fits(&agent.course) && robot.missions.iter().all(|mission| fits(&mission.course)) {
            true => Ok(agent),
            false => Err(ComputationError::Robot(robot.id)),
        }
    }

    /// Whether it stands at the end of its path.
    pub(super) fn stands(&self) -> bool {
        self.speed <= 0.0 && self.position_interval.lo >= self.course.length()
    }

    /// The path for a plan, with or without the new mission; the interval of lengths of the robot on it; and its speed \[m/s\].
    pub(super) fn to_plan(&self, takes_up: bool) -> (&SpeedLimitedPath, Interval<f64>, f64) {
        match &self.next {
            Some(next) if takes_up => (next, Interval::new(0.0, 0.0), 0.0),
            _ => (&self.course, self.position_interval, self.speed),
        }
    }

    /// Length before which it can stop even if it drives at top speed in the next frame \[m\]: holds beyond it do not matter
    /// yet.
    pub(super) fn horizon(&self) -> f64 {
        let Limits { speed, acceleration } = self.limits;
        self.position_interval.hi + 2.0 * speed * FRAME + stopping_length(speed, acceleration, FRAME)
    }

    /// The robot as input of a plan, with one of its margins.
    pub(super) fn state(&self, margin: usize, taken: bool) -> Option<RobotState> {
        let (course, at, speed) = self.to_plan(taken);
        Some(RobotState {
            rest: course.from(at.middle()).ok()?.turned(self.turned),
            speed,
            limits: self.limits,
            release: self.release,
            body: self.bodies.get(margin)?.clone(),
        })
    }
}

/// A course to stand at a point with a heading \[rad\].
pub(super) fn standing([x, y]: [f64; 2], heading: f64) -> Result<SpeedLimitedPath, InvalidInput> {
    SpeedLimitedPath::standing(Pose { position: Point::new(x, y), heading: Radians(heading) })
}
