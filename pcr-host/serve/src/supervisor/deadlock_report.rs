//! Detects robots that have a mission but do not advance, and reports the reason once: the robot for which they wait in
//! the end, or the robots that wait for one another. A robot that is stopped, silent or alarmed has been reported
//! already.

use super::Supervisor;
use super::admission::AdmissionResult;
use crate::event::SupervisorEvent;
use crate::robot::SupervisedRobot;

/// Time between two searches \[s\].
const PAUSE: f64 = 1.0;

impl Supervisor {
    /// Reports why robots do not advance, once for each reason.
    pub(super) fn note_standstill(&mut self, now: f64) {
        if now < self.looked + PAUSE {
            return;
        }
        self.looked = now;
        self.robots.iter_mut().for_each(|robot| _ = robot.moved.get_or_insert(now));
        for place in 0..self.robots.len() {
            if !self.robots[place].away
                && self.is_busy(&self.robots[place])
                && self.since(place, now) > self.settings.deadlock_timeout
            {
                self.note_reason(place, now);
            }
        }
    }

    fn note_reason(&mut self, place: usize, now: f64) {
        let (mut chain, mut last) = (vec![place], place);
        while let Some(next) = self.kept_by(last) {
            if let Some(begin) = chain.iter().position(|&known| known == next) {
                chain.drain(..begin);
                let first = chain.iter().copied().min().unwrap_or(next);
                let names: Vec<&str> = chain.iter().map(|&one| self.robots[one].name.as_str()).collect();
                return self.note_stand(first, now, format!("{} wait for one another", names.join(", ")));
            }
            chain.push(next);
            last = next;
        }
        let robot = &self.robots[last];
        // These have been reported already.
        let is_known = robot.alarm.is_some() || robot.stopped.is_some() || robot.silent;
        if is_known || self.since(last, now) <= self.settings.deadlock_timeout {
            return;
        }
        let why = match (self.is_busy(robot), chain.iter().rev().nth(1)) {
            _ if robot.closure.is_some() => {
                let closure = robot.closure.as_deref().unwrap_or_default();
                format!("{} waits before {closure}, which is closed", robot.name)
            }
            (_, Some(&before)) if robot.away => {
                format!(
                    "{} is away, and keeps its place until it is removed: {} waits for it",
                    robot.name, self.robots[before].name
                )
            }
            _ if robot.away => return,
            (true, _) if robot.doing.is_some() => {
                let doing = robot.doing.as_deref().unwrap_or_default();
                format!("{} stands at {:.2} m, and {doing}", robot.name, robot.arc_length)
            }
            (true, _) => {
                format!("{} is at {:.2} m, and may go to {:.2} m", robot.name, robot.arc_length, robot.notified_limit)
            }
            (false, Some(&before)) => {
                format!("{} has nothing to do, and is in the way of {}", robot.name, self.robots[before].name)
            }
            (false, None) => return,
        };
        self.note_stand(last, now, why);
    }

    fn note_stand(&mut self, place: usize, now: f64, why: String) {
        let since = self.since(place, now);
        let robot = &mut self.robots[place];
        if !std::mem::replace(&mut robot.stands, true) {
            self.events.push(SupervisorEvent::Standstill { robot: robot.name.clone(), since, why });
        }
    }

    /// For each robot whether it has stood at its hold for longer than `patience`, perhaps because later missions pass it again and again.
    /// New missions are then ordered behind it, so that the number of robots ahead of it falls until it goes on.
    pub(super) fn overtaken(&self, now: f64) -> Vec<bool> {
        let is_overtaken = |place: usize| {
            !self.robots[place].away && self.is_held(place) && self.since(place, now) > self.settings.deadlock_timeout
        };
        (0..self.robots.len()).map(is_overtaken).collect()
    }

    fn since(&self, place: usize, now: f64) -> f64 {
        self.robots[place].moved.map_or(0.0, |moved| now - moved)
    }

    fn is_busy(&self, robot: &SupervisedRobot) -> bool {
        robot.waiting.is_some() || !robot.has_arrived(self.settings.position_uncertainty)
    }

    /// Whether a robot is on its way and stands at its hold.
    fn is_held(&self, place: usize) -> bool {
        let (robot, width) = (&self.robots[place], self.settings.position_uncertainty);
        !robot.has_arrived(width) && robot.notified_limit <= robot.arc_length + width
    }

    /// The robot for which another one waits that has a task and may not go on.
    fn kept_by(&self, place: usize) -> Option<usize> {
        let robot = &self.robots[place];
        if robot.closure.is_some() {
            return None;
        }
        if !robot.has_arrived(self.settings.position_uncertainty) {
            return robot.authority.filter(|_| self.is_held(place))?.waits_for.map(|(by, _)| by);
        }
        match self.tries.get(&robot.name).filter(|_| robot.waiting.is_some())?.last.as_ref()? {
            AdmissionResult::Waiting { by: Some(by), .. } => self.robot_index(by).ok().filter(|by| *by != place),
            _ => None,
        }
    }
}
