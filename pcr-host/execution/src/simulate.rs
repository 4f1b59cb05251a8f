//! Simulation in closed loop: robots that slip, drift and are held up, observed by an inaccurate camera, under three
//! controllers.
//!
//! ```text
//! task        robots, missions, obstacles of a scenario           Task
//! forage      the paper's experiment (Section 4.2)
//! tangents    shortest ways around discs
//! course      the path of a mission, and drives along it
//! noise       random numbers by seed, robot and purpose
//! body        the true state of a robot                           Disturbance
//! supervisor  plans with collision regions every few seconds:
//!   agent       a robot as it knows it
//!   observer    where a robot can be
//!   replan      motions for the rest of the paths
//!   guard       passing orders in between
//!   braking     speeds frame by frame
//! steering    common code of the reactive controllers:
//!   potential   artificial potential field
//!   orca        optimal reciprocal collision avoidance
//! world       true positions and missions, frame by frame
//! contact     collisions on the true positions
//! outcome     results                                             Outcome, Run, Trace
//! ```
//!
//! Time advances in frames of the camera. The same task, seed and settings give the same run, down to the last digit;
//! only the time that planning takes differs between machines.

mod agent;
mod body;
mod braking;
mod contact;
mod course;
pub mod forage;
mod guard;
mod noise;
mod observer;
mod orca;
mod outcome;
mod potential;
mod replan;
mod steering;
mod supervisor;
mod tangents;
mod task;
mod vector;
mod world;

pub use body::{Disturbance, HELD_EVERY};
pub use course::{Course, Drive};
pub use outcome::{Arrival, Collision, Ended, Journey, Outcome, Planning, Run, Simulation, Trace, Waiting};
pub use task::{Mission, Obstacle, Robot, Task};
pub use vector::Vector;

use agent::Errors;
use body::{Command, Turning};
use orca::Orca;
use pcr_planning::failure::Failure;
use pcr_planning::memory;
use potential::Potential;
use replan::Waits;
use serde::Serialize;
use supervisor::{Statistics, Supervisor};
use world::World;

/// Time of a frame \[s\]: the camera of the paper sees 30 a second.
pub const FRAME: f64 = 1.0 / 30.0;

/// Frames from one look at the progress to the next.
const TOLD: usize = 100;

/// Number of frames between two checks whether memory holds the record.
const CHECKED: usize = 4096;

/// Controller of the robots.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Controller {
    /// A supervisor with collision regions.
    Pcr,
    /// Each robot by itself in an artificial potential field.
    Potential,
    /// Each robot by itself, by optimal reciprocal collision avoidance.
    Orca,
}

impl Controller {
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
pub struct Settings {
    /// Seed: the same seed gives the same disturbances.
    pub seed: u64,
    /// Time from one plan to the next \[s\].
    pub replan: f64,
    /// How the world differs from the plan.
    pub disturbance: Disturbance,
}

/// The input of a controller in a frame.
struct Frame<'a> {
    /// Time \[s\].
    time: f64,
    /// Positions with the errors of the camera \[m\].
    seen: &'a [Vector],
    /// Speeds of the wheels in the last frame \[m/s\].
    speeds: &'a [f64],
    /// For each robot whether it stands at the end of its path, as it knows by itself.
    arrived: &'a [bool],
    /// For each robot the turn in place that it has begun, as it knows by itself.
    turning: &'a [Option<Turning>],
}

/// A plan of the supervisor, for the replay.
#[derive(Clone, Debug)]
pub struct Snapshot {
    /// Time at which it was made \[s\].
    pub time: f64,
    /// Planned motions of the robots.
    pub drives: Vec<Drive>,
    /// Length that each robot had travelled on its course before the plan \[m\].
    pub offsets: Vec<f64>,
    /// Radii with margins \[m\].
    pub radii: Vec<f64>,
}

/// A controller, which tells robots how to move.
trait Control {
    /// Announces the first path of a robot, which it will get at a time \[s\].
    fn announce(&mut self, _robot: usize, _course: &Course, _release: f64) {}
    /// A robot that stands gets a path.
    fn assign(&mut self, robot: usize, course: &Course);
    /// A command for each robot.
    fn commands(&mut self, frame: &Frame<'_>) -> Vec<Command>;
    /// Distance from its goal at which a robot has arrived \[m\]; 0 for robots on paths, which know their end, and on the way
    /// to another point.
    fn reach(&self, _robot: usize) -> f64 {
        0.0
    }
    /// Whether no robot will move again without new missions.
    fn is_stuck(&self) -> bool {
        false
    }
    /// Robots that wait, and for which others.
    fn waiting(&self) -> Vec<Waits> {
        Vec::new()
    }
    /// Takes the plans that were made.
    fn take_snapshots(&mut self) -> Vec<Snapshot> {
        Vec::new()
    }
    /// Figures about planning.
    fn planning(&self) -> Option<&Statistics> {
        None
    }
}

/// Runs a task under a controller until all missions are done, or until [`time_limit`].
///
/// # Errors
/// [`Failure`] if a value is out of range or the table cannot hold the fleet.
pub fn run(task: &Task, controller: Controller, settings: Settings) -> Result<Outcome, Failure> {
    watched(task, controller, settings, &|_| {})
}

/// Simulates as [`run`], and tells from time to time which share of the missions is done, from 0 to 1.
///
/// # Errors
/// Errors of [`run`].
pub fn watched(
    task: &Task,
    controller: Controller,
    settings: Settings,
    told: &dyn Fn(f64),
) -> Result<Outcome, Failure> {
    let Disturbance { noise, drift, .. } = settings.disturbance;
    let mut control: Box<dyn Control> = match controller {
        Controller::Pcr => Box::new(Supervisor::new(task, Errors { noise, drift }, settings.replan)?),
        Controller::Potential => Box::new(Potential::new(task)),
        Controller::Orca => Box::new(Orca::new(task, noise + drift)),
    };
    let mut world = World::new(task, settings);
    world.announce(control.as_mut());
    let frames = (time_limit(task, settings.disturbance) / FRAME).ceil() as usize;
    let mut ended = Ended::TimeLimit;
    let room = (size_of::<Vector>() + size_of::<f64>()) * task.robots.len();
    for frame in 0..frames {
        if frame % CHECKED == 0 {
            // The record is kept in lists, which double as they grow.
            memory::ask((2 * (frame + CHECKED) * room) as u64, || format!("a record of {} frames", frame + CHECKED))?;
        }
        if frame % TOLD == 0 {
            told(world.share());
        }
        world.missions(frame, control.as_mut());
        if world.is_done() {
            ended = Ended::Done;
            break;
        }
        if control.is_stuck() && world.all_given() {
            ended = Ended::Standstill;
            break;
        }
        world.step(frame, control.as_mut());
    }
    let snapshots = control.take_snapshots();
    let waiting = control.waiting();
    Ok(Outcome {
        planned: control.planning().map_or_else(Vec::new, |planning| planning.times.clone()),
        run: Run::of(task, (controller, ended), &world.trace, control.planning(), &waiting),
        trace: world.trace,
        snapshots,
    })
}

/// Time after which a run is given up \[s\]: eight times the time that a robot's missions take without other robots but with
/// the slip and the times for which it is held up, for the robot with the longest ones, and a minute.
pub fn time_limit(task: &Task, disturbance: Disturbance) -> f64 {
    /// Slip and delays are taken to slow a robot down by at most this factor: with a slip of 1 it would never arrive.
    const SLOWEST: f64 = 64.0;
    let robot = |robot: &Robot| {
        let missions = robot.missions.iter();
        missions.map(|mission| mission.release.max(0.0) + mission.course.unimpeded(robot.limits)).sum::<f64>()
    };
    let Disturbance { slip, delay, .. } = disturbance;
    let slower = ((1.0 + delay / HELD_EVERY) / (1.0 - slip)).clamp(1.0, SLOWEST);
    60.0 + 8.0 * slower * task.robots.iter().map(robot).fold(0.0, f64::max)
}
