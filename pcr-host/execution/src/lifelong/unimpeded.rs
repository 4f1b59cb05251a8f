//! Missions that the robots would do if no robot was in another one's way, with the same delays.

use super::random_draws::{self, STEP, disturb};
use super::robot::LifelongRobot;
use super::route::Route;
use super::route_graph::DeparturePose;
use super::run_state::LifelongState;

/// Number of goals that a way leads to: at each goal the next turn is known already.
const GOALS: u64 = 2;

impl LifelongState {
    /// Number of missions that all robots would carry out after `begin` \[s\], each alone, on its quickest ways.
    pub(super) fn alone(&self, begin: f64) -> usize {
        (0..self.robots.len()).map(|robot| self.alone_with(robot, begin)).sum()
    }

    /// The missions of one robot.
    fn alone_with(&self, number: usize, begin: f64) -> usize {
        let request = &self.request;
        let mut robot = LifelongRobot::new(self.robots[number].way.clone(), self.robots[number].abilities);
        let (mut given, mut done) = (0, 0);
        let steps = (request.duration / STEP) as usize;
        for tick in 0..steps {
            let now = tick as f64 * STEP;
            if robot.way.goals.is_empty() {
                let Some((way, before)) = self.onward(&robot, number, given) else { return done };
                given += GOALS;
                robot.take(way, before);
            }
            disturb(&mut robot, number, tick, now, true, request);
            if robot.drive(f64::INFINITY, now, STEP) && now + STEP > begin {
                done += 1;
            }
            robot.done.clear();
            robot.stops.clear();
        }
        done
    }

    /// The quickest way of a robot to its next goals, and the length that is cut off from the way before \[m\].
    fn onward(&self, robot: &LifelongRobot, number: usize, given: u64) -> Option<(Route, f64)> {
        let Self { site, ends, network, request, .. } = self;
        let kept = robot.way.committed_part(site, robot.at, robot.stop(), robot.turned);
        let (mut atoms, mut goals, mut from) = (kept.atoms.clone(), Vec::new(), kept.end_pose);
        for next in given..given + GOALS {
            let goal = random_draws::goal(site, ends, request.seed, number, next, from.node);
            let part = network.quickest(site, from, |_| 0.0, |node| node == goal, Some(goal), 1).pop()?;
            let heading = part.iter().rev().find_map(|&last| site.atoms[last].headings).map(|headings| headings[1]);
            from = DeparturePose { node: goal, heading: heading.or(from.heading) };
            atoms.extend(part);
            goals.push(atoms.len());
        }
        Some((Route::new(site, kept.from, &atoms, &goals, &robot.abilities), kept.before))
    }
}
