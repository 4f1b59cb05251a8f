//! Optimal reciprocal collision avoidance (van den Berg, Guy, Lin and Manocha 2011), by the crate `dodgy_2d`.
//!
//! Each robot knows the velocities of all others, and takes half of the change that avoids each of them for some time
//! ahead. Discs are enlarged by the error of the camera. A robot heads for a point of its path a little ahead, because
//! ORCA finds no way around obstacles. Obstacles are octagons around their discs.

use super::simulation_task::{SimulationTask, StandingObstacle};
use super::speed_limited_path::SpeedLimitedPath;
use super::steering::{ReactiveRobot, goal_tolerance, steered};
use super::true_state::MotionCommand;
use super::vector::{PlaneVector, add, limited, sub};
use super::{ControlInput, FRAME, RobotController};
use dodgy_2d::{Agent, AvoidanceOptions, Obstacle as Polygon, Vec2};
use std::borrow::Cow;
use std::f64::consts::TAU;

/// Other robots are avoided for this time ahead \[s\].
const HORIZON: f32 = 2.0;

/// Obstacles are avoided for this time ahead \[s\].
const OBSTACLE_HORIZON: f32 = 0.5;

/// Corners of an obstacle.
const CORNERS: u32 = 8;

pub(super) struct OrcaController {
    robots: Vec<ReactiveRobot>,
    obstacles: Vec<Polygon>,
    /// Commanded velocities for the last frame \[m/s\].
    velocities: Vec<PlaneVector>,
    /// Largest error of the camera \[m\].
    error: f64,
    reach: f64,
}

impl OrcaController {
    pub(super) fn new(task: &SimulationTask, error: f64) -> Self {
        let velocities = vec![[0.0; 2]; task.robots.len()];
        let obstacles = task.obstacles.iter().map(polygon).collect();
        Self { robots: steered(task), obstacles, velocities, error, reach: goal_tolerance(task) }
    }
}

fn vec2(vector: PlaneVector) -> Vec2 {
    Vec2::new(vector[0] as f32, vector[1] as f32)
}

/// The octagon around a disc, counter-clockwise: its inside is solid.
fn polygon(obstacle: &StandingObstacle) -> Polygon {
    let reach = obstacle.radius / (TAU / f64::from(2 * CORNERS)).cos();
    let corner = |k: u32| {
        let (sin, cos) = (TAU * f64::from(k) / f64::from(CORNERS)).sin_cos();
        vec2(add(obstacle.centre, [reach * cos, reach * sin]))
    };
    Polygon::Closed { vertices: (0..CORNERS).map(corner).collect() }
}

impl RobotController for OrcaController {
    fn assign(&mut self, robot: usize, course: &SpeedLimitedPath) {
        if let Some(robot) = self.robots.get_mut(robot) {
            robot.assign(course);
        }
    }

    fn commands(&mut self, frame: &ControlInput<'_>) -> Vec<MotionCommand> {
        let error = self.error;
        let agent = |((robot, &seen), &velocity): ((&ReactiveRobot, &PlaneVector), &PlaneVector)| Agent {
            position: vec2(seen),
            velocity: vec2(velocity),
            radius: (robot.radius + error) as f32,
            avoidance_responsibility: 1.0,
        };
        let agents: Vec<Agent> = self.robots.iter().zip(frame.seen).zip(&self.velocities).map(agent).collect();
        let obstacles: Vec<Cow<'_, Polygon>> = self.obstacles.iter().map(Cow::Borrowed).collect();
        let mut commands = Vec::with_capacity(agents.len());
        for (place, agent) in agents.iter().enumerate() {
            let (Some(robot), Some(&seen)) = (self.robots.get_mut(place), frame.seen.get(place)) else { continue };
            let neighbours: Vec<Cow<'_, Agent>> = agents
                .iter()
                .enumerate()
                .filter(|(other, _)| *other != place)
                .map(|(_, other)| Cow::Borrowed(other))
                .collect();
            let options = AvoidanceOptions {
                obstacle_margin: agent.radius,
                time_horizon: HORIZON,
                obstacle_time_horizon: OBSTACLE_HORIZON,
            };
            let (preferred, speed) = (vec2(robot.along_path(seen)), robot.limits.speed as f32);
            let chosen =
                agent.compute_avoiding_velocity(&neighbours, &obstacles, preferred, speed, FRAME as f32, &options);
            let wanted = [f64::from(chosen.x), f64::from(chosen.y)];
            if let Some(velocity) = self.velocities.get_mut(place) {
                *velocity = add(*velocity, limited(sub(wanted, *velocity), robot.limits.acceleration * FRAME));
                commands.push(MotionCommand::Freely(*velocity));
            }
        }
        commands
    }

    fn goal_tolerance(&self, robot: usize) -> f64 {
        if self.robots.get(robot).is_some_and(ReactiveRobot::heads_for_end) { self.reach } else { 0.0 }
    }
}
