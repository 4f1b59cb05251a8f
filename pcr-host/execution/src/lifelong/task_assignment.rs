//! Assigns tasks to robots. A task is done by the first robot that is at its node after the task has come; the robot that was
//! sent for it then gets another one.

use super::planning_context::PlanningContext;
use super::robot_mission::RobotMission;
use super::route_graph::DeparturePose;
use super::run_state::LifelongState;
use std::time::Instant;

/// A robot takes a task over from another one if it would be there sooner by this time \[s\].
const SOONER: f64 = 3.0;

/// Time between two looks at tasks that other robots are sent for \[s\].
const AGAIN: f64 = 1.0;

/// A robot without a task, the place where it can leave its way, and the time when it is there \[s\].
#[derive(Clone, Copy)]
struct IdleRobot {
    robot: usize,
    from: DeparturePose,
    there: f64,
}

impl LifelongState {
    /// Assigns tasks that have come to robots without a task.
    pub(super) fn assign(&mut self, now: f64) {
        self.come(now);
        let mut begin = Instant::now();
        let mut idle = self.idle(now);
        let looks_again = self.tasks.as_ref().is_some_and(|tasks| now - tasks.looked >= AGAIN);
        while let Some((task, robot)) =
            self.best(&idle, now).or_else(|| looks_again.then(|| self.sooner(&idle, now))?)
        {
            idle.retain(|other| other.robot != robot);
            self.send(robot, task, now, begin);
            begin = Instant::now();
        }
        if let Some(tasks) = &mut self.tasks {
            tasks.spent += begin.elapsed();
            tasks.looked = if looks_again { now } else { tasks.looked };
        }
    }

    /// Opens tasks that have come. Tasks at nodes where a robot stands are done.
    fn come(&mut self, now: f64) {
        let Some(tasks) = &mut self.tasks else { return };
        let known = tasks.open.len();
        tasks.release_due(now);
        let come: Vec<usize> = tasks.open[known..].iter().map(|task| task.node).collect();
        for node in come {
            if self.robots.iter().any(|robot| robot.way.node(&self.site, robot.at) == Some(node)) {
                self.visit(node, now);
            }
        }
    }

    /// The robots without a task.
    fn idle(&self, now: f64) -> Vec<IdleRobot> {
        let scene = self.scene(now);
        let idle = (0..self.robots.len()).filter(|&robot| self.missions[robot].is_none());
        idle.map(|robot| scene.idle(robot)).collect()
    }

    /// Sends a robot, and no other, for a task. The search for it began at `begin`.
    fn send(&mut self, robot: usize, task: usize, now: f64, begin: Instant) {
        let Some(tasks) = &mut self.tasks else { return };
        let prepared = std::mem::take(&mut tasks.spent) + begin.elapsed();
        let task = &mut tasks.open[task];
        let (goal, since, other) = (task.node, task.since, task.robot.replace(robot));
        self.release(other);
        self.missions[robot] = Some(RobotMission {
            goal,
            assigned_at: since,
            rank: since,
            unimpeded_time: 0.0,
            admitted: false,
            passed: 0,
            next_try: now,
            prepared,
        });
    }

    /// Takes its task from a robot.
    fn release(&mut self, robot: Option<usize>) {
        if let Some(robot) = robot {
            self.missions[robot] = None;
            self.robots[robot].way.goals.clear();
        }
    }

    /// The next pair of a task that no robot is sent for and one of these robots: a second of age counts as much as a second of
    /// travel.
    fn best(&self, idle: &[IdleRobot], now: f64) -> Option<(usize, usize)> {
        let (scene, tasks) = (self.scene(now), self.tasks.as_ref()?);
        let free = tasks.open.iter().enumerate().filter(|(_, task)| task.robot.is_none());
        let pairs = free.flat_map(|(place, task)| {
            let time = scene.network.times(scene.site, task.node);
            idle.iter().map(move |it| (it.there + time(it.from) + task.since, (place, it.robot)))
        });
        pairs.min_by(|a, b| a.0.total_cmp(&b.0)).filter(|pair| pair.0 < f64::INFINITY).map(|pair| pair.1)
    }

    /// The pair of a task that another robot is sent for and one of these robots that gains the most time.
    fn sooner(&self, idle: &[IdleRobot], now: f64) -> Option<(usize, usize)> {
        let (scene, tasks) = (self.scene(now), self.tasks.as_ref()?);
        let sent = tasks.open.iter().enumerate().filter_map(|(place, task)| Some((place, task.node, task.robot?)));
        let pairs = sent.flat_map(|(place, node, other)| {
            let time = scene.network.times(scene.site, node);
            let least = scene.time_left(other, &time) - SOONER;
            idle.iter().map(move |it| (it.there + time(it.from) - least, (place, it.robot)))
        });
        pairs.min_by(|a, b| a.0.total_cmp(&b.0)).filter(|pair| pair.0 < 0.0).map(|pair| pair.1)
    }

    /// Completes the tasks at a node where a robot is.
    fn visit(&mut self, node: usize, now: f64) {
        let Some(tasks) = &mut self.tasks else { return };
        for task in tasks.done(node) {
            self.outcome.missions += 1;
            self.last_arrival = now;
            self.release(task.robot);
        }
    }

    /// Completes the tasks on the part of its way that a robot has passed since it was at length `from`.
    pub(super) fn passed(&mut self, robot: usize, from: f64, now: f64) {
        let it = &self.robots[robot];
        let nodes = it.way.nodes(&self.site, from, it.at);
        nodes.into_iter().for_each(|node| self.visit(node, now));
    }
}

impl PlanningContext<'_> {
    fn idle(&self, robot: usize) -> IdleRobot {
        let (it, kept) = (&self.robots[robot], self.kept(robot));
        let length: f64 = kept.atoms.iter().map(|&atom| self.site.atoms[atom].length).sum();
        let there = it.way.time(it.at.max(kept.before + length)) - it.way.time(it.at);
        IdleRobot { robot, from: kept.end_pose, there }
    }

    /// Time that a robot takes to its task if no other robot is in its way \[s\]. `time` is the time from a place to the task.
    fn time_left(&self, robot: usize, time: impl Fn(DeparturePose) -> f64) -> f64 {
        let it = &self.robots[robot];
        match it.way.goals.first() {
            Some(&goal) => it.way.time(goal) - it.way.time(it.at),
            None => {
                let IdleRobot { from, there, .. } = self.idle(robot);
                there + time(from)
            }
        }
    }
}
