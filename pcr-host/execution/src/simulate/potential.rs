//! The canonical reactive method: an artificial potential field (Khatib 1986).
//!
//! A robot moves along the negative gradient: towards its goal at its top speed, and away from every disc that is nearer
//! than the influence distance q₀ by a speed that grows with the inverse of the gap q,
//!
//! ```text
//! v_rep = g (1/q - 1/q₀) / (1/q₁ - 1/q₀),      q < q₀,
//! ```
//!
//! which is the top speed g at the gap q₁.

use super::simulation_task::SimulationTask;
use super::speed_limited_path::SpeedLimitedPath;
use super::steering::{ReactiveRobot, goal_tolerance, steered};
use super::true_state::MotionCommand;
use super::vector::{PlaneVector, add, limited, norm, scale, sub};
use super::{ControlInput, RobotController};

/// q₀, in radii of the robot.
const INFLUENCE: f64 = 2.0;

/// q₁, in radii of the robot.
const BALANCE: f64 = 0.7;

/// Gaps below this share of q₁ count as this share, so that the field has no poles.
const LEAST: f64 = 0.1;

#[derive(Debug)]
pub(super) struct PotentialFieldController {
    robots: Vec<ReactiveRobot>,
    obstacles: Vec<(PlaneVector, f64)>,
    reach: f64,
}

impl PotentialFieldController {
    pub(super) fn new(task: &SimulationTask) -> Self {
        let obstacles = task.obstacles.iter().map(|obstacle| (obstacle.centre, obstacle.radius)).collect();
        Self { robots: steered(task), obstacles, reach: goal_tolerance(task) }
    }
}

/// The speed away from a disc at this gap \[m\], as a share of the top speed.
fn repulsion(gap: f64, radius: f64) -> f64 {
    let (influence, balance) = (INFLUENCE * radius, BALANCE * radius);
    let inverse = |gap: f64| 1.0 / gap - 1.0 / influence;
    (inverse(gap.max(LEAST * balance)) / inverse(balance)).max(0.0)
}

impl RobotController for PotentialFieldController {
    fn assign(&mut self, robot: usize, course: &SpeedLimitedPath) {
        if let Some(robot) = self.robots.get_mut(robot) {
            robot.assign(course);
        }
    }

    fn commands(&mut self, frame: &ControlInput<'_>) -> Vec<MotionCommand> {
        let discs: Vec<(PlaneVector, f64)> =
            frame.seen.iter().copied().zip(self.robots.iter().map(|robot| robot.radius)).collect();
        let mut commands = Vec::with_capacity(discs.len());
        for (place, (robot, &seen)) in self.robots.iter_mut().zip(frame.seen).enumerate() {
            let mut velocity = robot.towards_goal(seen);
            let others = discs.iter().enumerate().filter(|(other, _)| *other != place).map(|(_, disc)| disc);
            for (centre, radius) in others.chain(&self.obstacles) {
                let away = sub(seen, *centre);
                let distance = norm(away);
                let speed = robot.limits.speed * repulsion(distance - robot.radius - radius, robot.radius);
                if distance > 0.0 {
                    velocity = add(velocity, scale(away, speed / distance));
                }
            }
            commands.push(MotionCommand::Freely(limited(velocity, robot.limits.speed)));
        }
        commands
    }

    fn goal_tolerance(&self, _robot: usize) -> f64 {
        self.reach
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_repulsion_is_the_top_speed_where_the_definition_says() {
        let radius = 0.1;
        assert_eq!(repulsion(INFLUENCE * radius, radius), 0.0);
        assert_eq!(repulsion(1.0, radius), 0.0);
        assert!((repulsion(BALANCE * radius, radius) - 1.0).abs() < 1e-12);
        assert!(repulsion(-1.0, radius).is_finite() && repulsion(-1.0, radius) > 5.0);
    }
}
