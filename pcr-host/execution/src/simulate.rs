//! Simulation in closed loop: robots that slip, drift and are held up, observed by an inaccurate camera, under three
//! controllers.
//!
//! ```text
//! simulation_task     robots, missions, obstacles of a scenario
//! forage              the paper's experiment (Section 4.2)
//! shortest_paths      shortest ways around discs
//! speed_limited_path  the path of a mission, and drives along it
//! noise               random numbers by seed, robot and purpose
//! true_state          the true state of a robot                  Disturbance
//! pcr_controller      plans with collision regions every few seconds:
//!   robot_estimate    a robot as it knows it
//!   observer          where a robot can be
//!   replan            motions for the rest of the paths
//!   precedence_guard  passing orders in between
//!   missing_clearance room that is missing beside a robot that stands
//!   braking           speeds frame by frame
//! steering            common code of the reactive controllers:
//!   potential         artificial potential field
//!   orca              optimal reciprocal collision avoidance
//! true_world          true positions and missions, frame by frame
//! frame_contact       collisions on the true positions, of discs and of outlines
//! outcome             results
//! ```
//!
//! Time advances in frames of the camera. The same task, seed and settings give the same run, down to the last digit;
//! only the time that planning takes differs between machines.

mod braking;
pub mod forage;
mod frame_contact;
mod missing_clearance;
mod noise;
mod observer;
mod orca;
mod outcome;
mod outline_contact;
#[cfg(test)]
mod outline_tests;
mod pcr_controller;
mod potential;
mod precedence_guard;
mod replan;
mod robot_estimate;
mod shortest_paths;
mod simulation_task;
mod speed_limited_path;
mod steering;
mod true_state;
mod true_world;
mod vector;

pub use outcome::{
    BlockedRobotEntry, CollisionEntry, ControllerRunEntry, MissionEntry, MissionRecord, MotionTrace, PlanningEntry,
    RunEnd, SimulationReport, SimulationRun,
};
pub use replan::ClearanceEntry;
pub use simulation_task::{ReleasedMission, RobotTask, SimulationTask, StandingObstacle};
pub use speed_limited_path::{OwnedMotion, SpeedLimitedPath};
pub use true_state::Disturbance;
pub use vector::PlaneVector;

use orca::OrcaController;
use pcr_controller::{PcrController, PlanningStatistics};
use pcr_planning::failure::ComputationError;
use pcr_planning::fleet::ConvexBody;
use pcr_planning::memory_budget;
use potential::PotentialFieldController;
use replan::BlockedRobot;
use robot_estimate::ErrorBounds;
use serde::Serialize;
use true_state::{HELD_EVERY, MotionCommand, TurnState};
use true_world::TrueWorld;

/// Time of a frame \[s\]: the camera of the paper sees 30 a second.
pub const FRAME: f64 = 1.0 / 30.0;

/// Frames from one look at the progress to the next.
const TOLD: usize = 100;

/// Number of frames between two checks whether memory holds the record.
const CHECKED: usize = 4096;

/// Controller of the robots.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum ControllerKind {
    /// A supervisor with collision regions.
    Pcr,
    /// Each robot by itself in an artificial potential field.
    Potential,
    /// Each robot by itself, by optimal reciprocal collision avoidance.
    Orca,
}

impl ControllerKind {
    /// All controllers.
    pub const ALL: &[Self] = &[Self::Pcr, Self::Potential, Self::Orca];

    /// Name in the output.
    pub fn name(self) -> &'static str {
        match self {
            Self::Pcr => "pcr",
            Self::Potential => "potential",
            Self::Orca => "orca",
        }
    }
}

/// The settings of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClosedLoopOptions {
    /// Seed: the same seed gives the same disturbances.
    pub seed: u64,
    /// Time from one plan to the next \[s\].
    pub replan: f64,
    /// How the world differs from the plan.
    pub disturbance: Disturbance,
}

/// The input of a controller in a frame.
struct ControlInput<'a> {
    /// Time \[s\].
    time: f64,
    /// Positions with the errors of the camera \[m\].
    seen: &'a [PlaneVector],
    /// Speeds of the wheels in the last frame \[m/s\].
    speeds: &'a [f64],
    /// For each robot whether it stands at the end of its path, as it knows by itself.
    arrived: &'a [bool],
    /// For each robot the turn in place that it has begun, as it knows by itself.
    turning: &'a [Option<TurnState>],
}

/// A plan of the supervisor, for the replay.
#[derive(Clone, Debug)]
pub struct PlanSnapshot {
    /// Time at which it was made \[s\].
    pub time: f64,
    /// Planned motions of the robots.
    pub drives: Vec<OwnedMotion>,
    /// Length that each robot had travelled on its course before the plan \[m\].
    pub offsets: Vec<f64>,
    /// Bodies with margins.
    pub bodies: Vec<ConvexBody>,
}

/// A controller, which tells robots how to move.
trait RobotController {
    /// Announces the first path of a robot, which it will get at a time \[s\].
    fn announce(&mut self, _robot: usize, _course: &SpeedLimitedPath, _release: f64) {}
    /// A robot that stands gets a path.
    fn assign(&mut self, robot: usize, course: &SpeedLimitedPath);
    /// A command for each robot.
    fn commands(&mut self, frame: &ControlInput<'_>) -> Vec<MotionCommand>;
    /// Distance from its goal at which a robot has arrived \[m\]; 0 for robots on paths, which know their end, and on the way
    /// to another point.
    fn goal_tolerance(&self, _robot: usize) -> f64 {
        0.0
    }
    /// Whether no robot will move again without new missions.
    fn is_stuck(&self) -> bool {
        false
    }
    /// Robots that wait, and for which others.
    fn waiting(&self) -> Vec<BlockedRobot> {
        Vec::new()
    }
    /// Takes the plans that were made.
    fn take_snapshots(&mut self) -> Vec<PlanSnapshot> {
        Vec::new()
    }
    /// Figures about planning.
    fn planning(&self) -> Option<&PlanningStatistics> {
        None
    }
}

/// Runs a task under a controller until all missions are done, or until [`time_limit`].
///
/// # Errors
/// [`ComputationError`] if a value is out of range or the table cannot hold the fleet.
pub fn run(
    task: &SimulationTask,
    controller: ControllerKind,
    settings: ClosedLoopOptions,
) -> Result<SimulationRun, ComputationError> {
    watched(task, controller, settings, &|_| {})
}

/// Simulates as [`run`], and tells from time to time which share of the missions is done, from 0 to 1.
///
/// # Errors
/// Errors of [`run`].
pub fn watched(
    task: &SimulationTask,
    controller: ControllerKind,
    settings: ClosedLoopOptions,
    told: &dyn Fn(f64),
) -> Result<SimulationRun, ComputationError> {
    let Disturbance { noise, drift, .. } = settings.disturbance;
    let mut control: Box<dyn RobotController> = match controller {
        ControllerKind::Pcr => Box::new(PcrController::new(task, ErrorBounds { noise, drift }, settings.replan)?),
        ControllerKind::Potential => Box::new(PotentialFieldController::new(task)),
        ControllerKind::Orca => Box::new(OrcaController::new(task, noise + drift)),
    };
    let mut world = TrueWorld::new(task, settings);
    world.announce(control.as_mut());
    let frames = (time_limit(task, settings.disturbance) / FRAME).ceil() as usize;
    let mut ended = RunEnd::TimeLimit;
    let room = (size_of::<PlaneVector>() + size_of::<f64>()) * task.robots.len();
    for frame in 0..frames {
        if frame % CHECKED == 0 {
            // The record is kept in lists, which double as they grow.
            memory_budget::ask((2 * (frame + CHECKED) * room) as u64, || {
                format!("a record of {} frames", frame + CHECKED)
            })?;
        }
        if frame % TOLD == 0 {
            told(world.share());
        }
        world.missions(frame, control.as_mut());
        if world.is_done() {
            ended = RunEnd::Done;
            break;
        }
        if control.is_stuck() && world.all_given() {
            ended = RunEnd::Standstill;
            break;
        }
        world.step(frame, control.as_mut());
    }
    let snapshots = control.take_snapshots();
    let waiting = control.waiting();
    Ok(SimulationRun {
        planned: control.planning().map_or_else(Vec::new, |planning| planning.times.clone()),
        run: ControllerRunEntry::of(task, (controller, ended), &world.trace, control.planning(), &waiting),
        trace: world.trace,
        snapshots,
    })
}

/// Time after which a run is given up \[s\]: eight times the time that a robot's missions take without other robots but with
/// the slip and the times for which it is held up, for the robot with the longest ones, and a minute.
pub fn time_limit(task: &SimulationTask, disturbance: Disturbance) -> f64 {
    /// Slip and delays are taken to slow a robot down by at most this factor: with a slip of 1 it would never arrive.
    const SLOWEST: f64 = 64.0;
    let robot = |robot: &RobotTask| {
        let missions = robot.missions.iter();
        missions.map(|mission| mission.release.max(0.0) + mission.course.unimpeded(robot.limits)).sum::<f64>()
    };
    let Disturbance { slip, delay, .. } = disturbance;
    let slower = ((1.0 + delay / HELD_EVERY) / (1.0 - slip)).clamp(1.0, SLOWEST);
    60.0 + 8.0 * slower * task.robots.iter().map(robot).fold(0.0, f64::max)
}
