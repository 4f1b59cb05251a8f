//! The robots that are watched: what is known of each of them, and what follows from it.

use crate::answer::{Answer, Known};
use crate::config::Config;
use crate::messages::{Header, PathMessage, Time};
use crate::planned_path::PlannedPath;
use crate::refusal::Refusal;
use crate::report::RefusalReport;

/// The latest paths of all robots.
#[derive(Clone, Debug)]
pub struct Watch {
    config: Config,
    /// Of each robot what its last message was.
    paths: Vec<Result<PlannedPath, Refusal>>,
}

impl Watch {
    /// No path has come yet.
    pub fn new(config: Config) -> Self {
        let paths = config.robots.iter().map(|_| Err(Refusal::NoPath)).collect();
        Self { config, paths }
    }

    /// The configuration.
    pub fn config(&self) -> &Config {
        &self.config
    }

    /// Takes a path of the robot with this index. If it is refused, the robot has none: the one before it does not hold any more.
    pub fn take(&mut self, robot: usize, message: &PathMessage) {
        self.set(robot, PlannedPath::read(message, &self.config.frame));
    }

    /// Takes a message that could not be read.
    pub fn take_unreadable(&mut self, robot: usize, problem: String) {
        self.set(robot, Err(Refusal::Unreadable(problem)));
    }

    fn set(&mut self, robot: usize, path: Result<PlannedPath, Refusal>) {
        if let Some(place) = self.paths.get_mut(robot) {
            *place = path;
        }
    }

    /// What follows from the paths, from `now` on.
    pub fn answer(&self, now: Time) -> Answer {
        let known: Vec<Known<'_>> = (self.config.robots.iter().zip(&self.paths))
            .map(|(robot, path)| {
                let path = path.as_ref().map_err(Clone::clone);
                Known::new(robot, path.and_then(|path| path.check_age(now, self.config.max_age).map(|()| path)), now)
            })
            .collect();
        let refusals = known.iter().filter_map(|known| {
            let reason = known.motion.as_ref().err()?.to_string();
            Some(RefusalReport { topic: known.robot.path.clone(), robot: known.robot.name.clone(), reason })
        });
        let header = Header { stamp: now, frame_id: self.config.frame.clone() };
        let mut answer = Answer::new(&known, header);
        answer.conflicts.refusals = refusals.collect();
        answer
    }
}
