//! A run: missions, decisions, motions and results.

use super::motion_record::{CheckWindow, RunCertificate};
use super::outcome::{LifelongResult, MeasuredLifelongRun, TimeShares};
use super::random_draws::{STEP, disturb};
use super::robot::LifelongRobot;
use super::robot_mission::RobotMission;
use super::route_graph::RouteGraph;
use super::run_state::LifelongState;
use super::tasks::TaskStream;
use super::{CoordinationMethod, LifelongOptions};
use crate::error::ExecutionError;
use pcr_formats::import::ImportedLayout;
use pcr_formats::missions::SiteChanges;
use std::time::{Duration, Instant};

/// Number of control steps after which the motion is certified.
const WINDOW: usize = 200;

/// If no robot has moved for this long after the last mission, none ever will \[s\].
const REST: f64 = 300.0;

/// First share of the time, which is not counted, because the robots start from their ends.
const START: f64 = 0.1;

/// A mission that has waited for longer than this counts as starved \[s\].
const LONG: f64 = 600.0;

/// If all robots have stood at their ends for longer than this while missions wait, nothing will change \[s\].
const QUIET: f64 = 60.0;

/// Runs a fleet on a layout.
///
/// # Errors
/// An edge that is no path, or a layout without room for any robot.
pub fn run(imported: &ImportedLayout, request: LifelongOptions) -> Result<MeasuredLifelongRun, ExecutionError> {
    watched(imported, request, &SiteChanges::default(), &|_| {})
}

/// Runs a fleet as [`run`] on a site that changes, and tells from time to time how much of the time is simulated \[s\].
///
/// # Errors
/// Errors of [`run`], and changes for another method than passing orders.
pub fn watched(
    imported: &ImportedLayout,
    request: LifelongOptions,
    changes: &SiteChanges,
    told: &dyn Fn(f64),
) -> Result<MeasuredLifelongRun, ExecutionError> {
    driven(LifelongState::new(imported, request, changes, None)?, request, told)
}

/// Runs a fleet on a layout with shared tasks and the starts that belong to them, until all tasks are done or the time of the
/// request is over. A task is done by the first robot that is at its node after it has come. Robots without a task are sent for
/// old and near tasks, also in place of a robot that would be there later.
///
/// # Errors
/// As [`run`], and a node that is not in the layout.
pub fn run_tasks(
    imported: &ImportedLayout,
    request: LifelongOptions,
    tasks: &TaskStream,
) -> Result<MeasuredLifelongRun, ExecutionError> {
    driven(LifelongState::new(imported, request, &SiteChanges::default(), Some(tasks))?, request, &|_| {})
}

fn driven(
    mut run: LifelongState,
    request: LifelongOptions,
    told: &dyn Fn(f64),
) -> Result<MeasuredLifelongRun, ExecutionError> {
    let steady = if run.tasks.is_none() { run.alone(START * request.duration) } else { 0 };
    let alone = steady as f64 * 3600.0 / ((1.0 - START) * request.duration);
    let mut certificate = RunCertificate::new();
    let mut window = CheckWindow::new(&run.site, &run.robots);
    let (mut still, mut time) = (0.0, Duration::ZERO);
    for tick in 0.. {
        let now = tick as f64 * STEP;
        let open = now < request.duration && run.has_work();
        let ended = !open && (still > REST || run.robots.iter().all(LifelongRobot::has_arrived));
        if (tick > 0 && tick % WINDOW == 0) || ended {
            told(now.min(request.duration));
            certificate.window(&run.site, &mut run.robots, &mut window, now);
        }
        if ended {
            break;
        }
        let begin = Instant::now();
        if open {
            run.change_world(now);
            run.give(now);
            run.refresh(tick, now);
            run.decide(now);
        } else {
            run.finish(tick, now);
        }
        let before: f64 = run.robots.iter().map(|robot| robot.at).sum();
        run.step(tick, now, open);
        let moves = run.robots.iter().map(|robot| robot.at).sum::<f64>() > before;
        if open {
            let waits = run.missions.iter().flatten().any(|mission| !mission.admitted);
            run.quiet = if waits && run.robots.iter().all(LifelongRobot::has_arrived) { run.quiet + STEP } else { 0.0 };
        }
        still = if moves || run.robots.iter().all(LifelongRobot::has_arrived) { 0.0 } else { still + STEP };
        run.outcome.standstill = f64::max(run.outcome.standstill, still);
        time += begin.elapsed();
    }
    run.outcome.certificate = certificate;
    Ok(MeasuredLifelongRun {
        outcome: run.finished(),
        changes: run.world.results(),
        layout: run.layout,
        alone,
        decisions: run.decisions,
        time,
        last_arrival: run.last_arrival,
    })
}

impl LifelongState {
    /// Advances all robots by a step.
    pub(super) fn step(&mut self, tick: usize, now: f64, open: bool) {
        let fars: Vec<f64> = self.robots.iter().map(|it| it.horizon(STEP)).collect();
        if self.request.method == CoordinationMethod::EdgeLocks {
            self.locks.give(&self.site, &self.robots, |robot| fars[robot]);
        }
        let hold = |robot: usize| match self.request.method {
            CoordinationMethod::EdgeLocks => self.locks.reserved_length(robot, &self.robots[robot].way),
            _ => self.book.authority(robot, &self.robots, fars[robot]),
        };
        let holds: Vec<f64> = (0..self.robots.len()).map(hold).collect();
        for (robot, hold) in holds.into_iter().enumerate() {
            let it = &mut self.robots[robot];
            let stop = it.stop();
            self.outcome.authority_overruns += usize::from(stop > hold + 1e-9 && stop > it.at);
            disturb(it, robot, tick, now, open, &self.request);
            if self.own.is_some() {
                self.note_wait(robot, hold, now);
            }
            let it = &mut self.robots[robot];
            if open {
                // A hold that lies beyond the next step and its stopping way holds the robot back from nothing.
                let held = hold < fars[robot];
                *share(&mut self.outcome.time, &self.site, it, held.then_some(hold), now) += 1.0;
            }
            let before = it.at;
            let has_come = it.drive(hold, now, STEP);
            if self.tasks.is_some() {
                self.passed(robot, before, now + STEP);
            } else if has_come {
                self.arrived(robot, now + STEP);
            }
            if tick % 10 == robot % 10 {
                self.book.drop_over(robot, &self.robots);
            }
        }
    }

    /// Counts a robot as having come to its goal.
    pub(super) fn arrived(&mut self, robot: usize, now: f64) {
        self.reached_stop(robot, now);
        self.outcome.missions += 1;
        self.last_arrival = now;
        if now > START * self.request.duration && now <= self.request.duration {
            self.steady += 1;
        }
        if let Some(mission) = self.missions[robot].take() {
            self.travel.0 += now - mission.assigned_at;
            self.travel.1 += mission.unimpeded_time;
        }
    }

    fn finished(&mut self) -> LifelongResult {
        let Self { request, .. } = *self;
        let waits =
            |mission: &RobotMission| if mission.admitted { 0.0 } else { request.duration - mission.assigned_at };
        let waits: Vec<f64> = self.missions.iter().chain(&self.world.suspended).flatten().map(waits).collect();
        let mut outcome = self.outcome.clone();
        outcome.time.norm();
        outcome.waiting = waits.iter().copied().fold(0.0, f64::max);
        outcome.starved = waits.iter().filter(|wait| **wait > LONG).count();
        outcome.stuck = self.robots.iter().filter(|robot| !robot.has_arrived()).count();
        outcome.missions_per_hour = self.steady as f64 * 3600.0 / ((1.0 - START) * request.duration);
        let idle = request.duration - self.last_arrival;
        outcome.idle_because = if outcome.missions == 0 && !waits.is_empty() {
            Some(self.why_idle(outcome.stuck))
        } else if outcome.starved > 0 && idle > LONG {
            Some(format!("nobody has reached a goal for {idle:.0} s: {}", self.why_idle(outcome.stuck)))
        } else if self.quiet > QUIET {
            Some(format!("nobody has moved for {:.0} s: {}", self.quiet, self.why_idle(outcome.stuck)))
        } else {
            None
        };
        outcome.travel_over_unimpeded = (self.travel.1 > 0.0).then(|| self.travel.0 / self.travel.1);
        outcome
    }

    /// The reason why no goal was reached.
    fn why_idle(&self, stuck: usize) -> String {
        if stuck > 0 {
            return format!("{stuck} robots on their ways wait for one another for ever");
        }
        let (scene, robots) = (self.scene(self.request.duration), 0..self.robots.len());
        let can_move = |robot: usize| {
            let here = self.robots[robot].way.end();
            (0..self.site.points.len()).any(|node| node != here && scene.is_free(robot, node))
        };
        if !robots.clone().any(can_move) {
            return format!("the {} robots take up all places where any of them could stand", robots.len());
        }
        let waiting = robots.filter_map(|robot| Some((robot, self.missions[robot]?)));
        let Some((robot, mission)) = waiting.min_by(|a, b| a.1.assigned_at.total_cmp(&b.1.assigned_at)) else {
            return "nobody had a mission".to_owned();
        };
        let refused = self.outcome.refused;
        match scene.wanted(robot, mission.goal).map(|route| scene.standing_on(robot, &route).len()) {
            None => format!("{refused} tries were refused; no route leads to the goal of the oldest mission"),
            Some(0) => format!("{refused} tries were refused; the route to the goal of the oldest mission is free"),
            Some(others) => format!(
                "{refused} tries were refused; on the route to the goal of the oldest mission stand {others} other robots, \
                 which were sent nowhere else"
            ),
        }
    }
}

/// The share to which the present activity of a robot belongs.
fn share<'s>(
    shares: &'s mut TimeShares,
    site: &RouteGraph,
    robot: &LifelongRobot,
    hold: Option<f64>,
    now: f64,
) -> &'s mut f64 {
    /// A robot within this distance of its hold waits there \[m\].
    const NEAR: f64 = 0.01;
    if robot.stopped_until > now {
        &mut shares.stopped
    } else if robot.has_arrived() {
        &mut shares.idle
    } else if robot.turning > now {
        &mut shares.turning
    } else if robot.speed == 0.0 && hold.is_some_and(|hold| hold - robot.at < NEAR) {
        &mut shares.waiting
    } else if site.atoms[robot.way.atoms[robot.way.atom(robot.at)]].is_turn() {
        &mut shares.turning
    } else if robot.way.goals.is_empty() {
        &mut shares.yielding
    } else {
        &mut shares.driving
    }
}
