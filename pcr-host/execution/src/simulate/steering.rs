//! Common code of the reactive controllers: a robot that heads for a target.

use super::FRAME;
use super::simulation_task::SimulationTask;
use super::speed_limited_path::SpeedLimitedPath;
use super::vector::{PlaneVector, norm, scale, sub};
use pcr_core::Limits;

/// Distance of the target ahead of a robot, in radii.
const AHEAD: f64 = 2.0;

/// Distance from its goal at which a robot has arrived, in radii.
const ARRIVED: f64 = 0.5;

/// A robot that steers by itself.
#[derive(Clone, Debug)]
pub(super) struct ReactiveRobot {
    pub(super) radius: f64,
    pub(super) limits: Limits<f64>,
    course: Option<SpeedLimitedPath>,
    /// The target as a length of the course \[m\].
    target: f64,
}

/// The robots of a task.
pub(super) fn steered(task: &SimulationTask) -> Vec<ReactiveRobot> {
    let robot = |robot: &super::simulation_task::RobotTask| ReactiveRobot {
        radius: robot.radius,
        limits: robot.limits,
        course: None,
        target: 0.0,
    };
    task.robots.iter().map(robot).collect()
}

/// Distance from its goal at which a robot of this task has arrived \[m\].
pub(super) fn goal_tolerance(task: &SimulationTask) -> f64 {
    ARRIVED * task.robots.iter().map(|robot| robot.radius).fold(f64::INFINITY, f64::min)
}

/// Robots whose path ends where it begins: a robot that heads straight for the end would have nothing to do.
pub(super) fn closed(task: &SimulationTask) -> impl Iterator<Item = u64> {
    let reach = goal_tolerance(task);
    let is_closed = move |course: &SpeedLimitedPath| {
        let [begin, end] = [0.0, course.length()].map(|length| course.point_at(length));
        norm(sub(begin, end)) < reach
    };
    let closed =
        task.robots.iter().filter(move |robot| robot.missions.iter().any(|mission| is_closed(&mission.course)));
    closed.map(|robot| robot.id)
}

impl ReactiveRobot {
    pub(super) fn assign(&mut self, course: &SpeedLimitedPath) {
        self.course = Some(course.clone());
        self.target = 0.0;
    }

    /// Whether its target is the end of its path.
    pub(super) fn heads_for_end(&self) -> bool {
        self.course.as_ref().is_some_and(|course| self.target >= course.length())
    }

    /// The velocity towards the goal from where the robot was seen, slower near it \[m/s\].
    pub(super) fn towards_goal(&mut self, seen: PlaneVector) -> PlaneVector {
        self.target = self.course.as_ref().map_or(0.0, SpeedLimitedPath::length);
        self.along_path(seen)
    }

    /// The velocity towards a point of the path a little ahead from where the robot was seen, slower near the goal \[m/s\].
    pub(super) fn along_path(&mut self, seen: PlaneVector) -> PlaneVector {
        let Some(course) = &self.course else { return [0.0; 2] };
        let (end, ahead) = (course.length(), AHEAD * self.radius);
        let step = self.limits.speed * FRAME;
        while self.target < end && norm(sub(course.point_at(self.target), seen)) < ahead {
            self.target = (self.target + step).min(end);
        }
        let way = sub(course.point_at(self.target), seen);
        let distance = norm(way);
        // The largest speed from which it can stop at the goal.
        let stops = (2.0 * self.limits.acceleration * distance).sqrt();
        let speed = if self.target < end { self.limits.speed } else { self.limits.speed.min(stops) };
        if distance > 0.0 { scale(way, speed / distance) } else { [0.0; 2] }
    }
}
