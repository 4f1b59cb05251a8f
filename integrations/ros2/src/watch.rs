//! The robots that are watched: what is known of each of them, and what follows from it.

use crate::answer::{Answer, Known};
use crate::closures::Closures;
use crate::config::Config;
use crate::messages::{FleetRobotState, FleetState, Header, PathMessage, Time};
use crate::order::Order;
use crate::planned_path::PlannedPath;
use crate::refusal::Refusal;
use crate::report::RefusalReport;
use std::collections::{BTreeMap, BTreeSet};

/// The latest paths of all robots.
#[derive(Clone, Debug)]
pub struct Watch {
    config: Config,
    /// Of each robot what its last message was.
    paths: Vec<Result<PlannedPath, Refusal>>,
    /// That of the paths, if it was computed.
    order: Option<Result<Order, String>>,
    /// Of each fleet the robots that are not configured.
    strangers: BTreeMap<String, Vec<String>>,
    /// Why the last fleet state could not be read.
    unreadable: Option<String>,
}

impl Watch {
    /// No path has come yet.
    pub fn new(config: Config) -> Self {
        let paths = config.robots.iter().map(|_| Err(Refusal::NoPath)).collect();
        Self { config, paths, order: None, strangers: BTreeMap::new(), unreadable: None }
    }

    /// The configuration.
    pub fn config(&self) -> &Config {
        &self.config
    }

    /// Takes a path of the robot with this index. If it is refused, the robot has none: the one before it does not hold any more.
    pub fn take(&mut self, robot: usize, message: &PathMessage) {
        let pace = self.config.robots.get(robot).and_then(|robot| robot.pace);
        self.set(robot, PlannedPath::read(message, &self.config.frame, pace));
    }

    /// Takes the state of a fleet. Robots of it that are configured and not in there have no path any more.
    pub fn take_fleet(&mut self, state: &FleetState) {
        self.unreadable = None;
        self.order = None;
        for (robot, place) in self.config.robots.iter().zip(&mut self.paths) {
            let (Some(fleet), Some(level)) = (&robot.fleet, &robot.level) else { continue };
            if *fleet == state.name {
                let mut found = state.robots.iter().filter(|found| found.name == robot.name);
                *place = match [found.next(), found.next()] {
                    [Some(found), None] => PlannedPath::read_fleet(found, level),
                    [None, _] => Err(Refusal::Missing),
                    _ => Err(Refusal::Repeated),
                };
            }
        }
        let is_known = |found: &&FleetRobotState| {
            let mut robots = self.config.robots.iter();
            robots.any(|robot| robot.fleet.as_deref() == Some(&state.name) && robot.name == found.name)
        };
        let strangers = state.robots.iter().filter(|found| !is_known(found)).map(|found| found.name.clone());
        self.strangers.insert(state.name.clone(), strangers.collect());
    }

    /// Takes a fleet state that could not be read: whose it was is not known.
    pub fn take_unreadable_fleet(&mut self, problem: &str) {
        self.order = None;
        for (robot, place) in self.config.robots.iter().zip(&mut self.paths) {
            if robot.fleet.is_some() {
                *place = Err(Refusal::Unreadable(problem.to_owned()));
            }
        }
        self.unreadable = Some(problem.to_owned());
    }

    /// Takes a message that could not be read.
    pub fn take_unreadable(&mut self, robot: usize, problem: String) {
        self.set(robot, Err(Refusal::Unreadable(problem)));
    }

    fn set(&mut self, robot: usize, path: Result<PlannedPath, Refusal>) {
        if let Some(place) = self.paths.get_mut(robot) {
            *place = path;
            self.order = None;
        }
    }

    /// For each robot the edges that are to be closed for it, or why that is not known.
    pub fn closed_edges<'a>(&self, closures: &'a mut Closures, now: Time) -> &'a [Result<BTreeSet<u16>, Refusal>] {
        closures.take(&usable(&self.paths, self.config.max_age, now), now);
        closures.of_robots(&self.config.robots, now)
    }

    /// What follows from the paths, from `now` on.
    pub fn answer(&mut self, now: Time) -> Answer {
        let known: Vec<Known<'_>> = (self.config.robots.iter().zip(usable(&self.paths, self.config.max_age, now)))
            .map(|(robot, path)| Known::new(robot, path, now))
            .collect();
        let states = self.config.fleet_states.clone().unwrap_or_default();
        let unreadable = self.unreadable.iter().map(|problem| Refusal::Unreadable(problem.clone()));
        let strangers = self.strangers.iter().flat_map(|(fleet, names)| {
            names.iter().map(|name| Refusal::UnknownRobot { fleet: fleet.clone(), name: name.clone() })
        });
        let strangers: Vec<Refusal> = strangers.chain(unreadable).collect();
        let refused = known.iter().filter_map(|known| {
            let reason = known.motion.as_ref().err()?.to_string();
            let topic = known.robot.path.as_ref().unwrap_or(&states).clone();
            Some(RefusalReport { topic, robot: known.robot.name.clone(), reason })
        });
        let others = strangers.iter().map(|refusal| RefusalReport {
            topic: states.clone(),
            robot: String::new(),
            reason: refusal.to_string(),
        });
        let refusals = refused.chain(others).collect();
        let header = Header { stamp: now, frame_id: self.config.frame.clone() };
        let mut answer = Answer::new(&known, &strangers, &mut self.order, header);
        answer.conflicts.refusals = refusals;
        answer
    }
}

/// What can be used of each robot now: its last message, unless that was refused or is too old.
fn usable(paths: &[Result<PlannedPath, Refusal>], max_age: f64, now: Time) -> Vec<Result<&PlannedPath, Refusal>> {
    let check = |path| PlannedPath::check_age(path, now, max_age).map(|()| path);
    paths.iter().map(|path| path.as_ref().map_err(Clone::clone).and_then(check)).collect()
}
