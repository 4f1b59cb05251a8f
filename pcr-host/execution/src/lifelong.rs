//! Fleets that run for hours: robots get one mission after the other. A path and its passing orders are admitted when a
//! robot needs them, and robots keep their orders, whatever the delays.
//!
//! A robot drives to its goal and on to a node where it may stand for good, so that no robot ever waits for one without
//! a mission. If its next mission is admitted on the way, it turns off. Passing orders are decided when a path is
//! admitted (`docs/theory/precedence.md`). For comparison, the same missions are run with locks and with start delays, under the
//! same random delays.
//!
//! Words that the modules share:
//! - an *atom* is an edge in one direction, or a node at which a robot can stand; a *way* is a list of atoms that follow one another;
//! - a *tie* is a pair of atoms of two ways on which the two robots can touch; a *region* is a connected set of ties, and has a
//!   passing order;
//! - a *gate* of a region is a place where the second robot has to wait until the first has reached a certain length;
//! - a *safe end* is a node where a robot can stand for good: all other nodes can be reached while robots stand at all safe ends.
//!
//! ```text
//! gates                 places where a robot has to wait for another one
//! route_element         atoms: pieces of way
//! route_graph           a layout as atoms, and how robots on two of them touch
//! endpoints             nodes where robots may stand for good                         WellFormedness
//! parking_spots         places to stand on dead ends, for more robots than such nodes
//! route_finder          quickest routes
//! kinematic_limits      speed and acceleration of a robot
//! robot                 how robots move and are delayed
//! robot_mission         what a robot has to do
//! route                 a path from node to node, and its times without waits
//! region_table          regions of the routes, and their precedence
//! timetable             when robots would be where
//! region_waits          what robots wait for on their routes
//! forecast              whether all can finish, and when
//! tasks                 first places of robots, and a stream of tasks
//! task_assignment       which robot does which task
//! reservations          locks on one edge after the other, for comparison
//! planning_context      the present fleet, and routes through it
//! precedence_search     precedence on a route
//! route_admission       routes and precedence for a mission
//! precedence_switching  precedence that is reversed while robots drive
//! unblocking            moves robots out of the way of a mission
//! stretch               more way for a robot, and sequences of it
//! joint_advance         robots that move up together, where nothing else is admitted
//! shunting              robots with missions of a file that move one after the other, where nothing else is admitted
//! joint_phase           the times at which they do
//! motion_record         motions of the robots, for the independent checker            RunCertificate
//! outcome               results of a run                                              LifelongResult
//! world_changes         what is closed, and who is stranded                           ChangeEffect
//! change_effects        closures and breakdowns that begin and end
//! speed_limits          closures that limit the speed
//! change_results        what they did                                                 ChangeResults
//! site_changes          the same in answers                                            ClosureEntry
//! own_missions          missions of a file, and what became of them
//! own_assignment        which vehicle does which of them
//! passing_cells         where two robots can be at the same time, and how they go on
//! passing_search        whether some robots can pass one another at all
//! passing_refusals      missions that are given up because they cannot
//! own_run               a run of such missions                                        run_missions, MissionRun
//! trajectory            what a robot did, as an agent of a scenario
//! random_draws          random goals, delays and starts
//! streets               a generated site of any size
//! run_state             the fleet, its missions, and results so far
//! scheduling            which robot looks for a route at what time
//! starvation            missions that wait for long go first
//! unimpeded             what robots would do if no other robot was in their way
//! run                   a run                                                         run, run_tasks, watched
//! lifelong_report       the answer of `pcr traffic --hours`                           LifelongReport
//! active_limit          how many robots of a fleet are active
//! ```

mod active_limit;
mod change_effects;
mod change_results;
#[cfg(test)]
mod change_tests;
mod endpoints;
mod forecast;
mod gates;
mod joint_advance;
mod joint_phase;
mod kinematic_limits;
mod lifelong_report;
mod motion_record;
mod outcome;
mod own_assignment;
mod own_missions;
mod own_run;
mod parking_spots;
mod passing_cells;
mod passing_refusals;
mod passing_search;
mod planning_context;
mod precedence_search;
mod precedence_switching;
mod random_draws;
mod region_table;
mod region_waits;
mod reservations;
mod robot;
mod robot_mission;
mod route;
mod route_admission;
mod route_element;
mod route_finder;
mod route_graph;
mod run;
mod run_state;
mod scheduling;
mod shunting;
pub mod site_changes;
mod speed_limits;
mod starvation;
mod streets;
mod stretch;
mod task_assignment;
mod tasks;
mod timetable;
mod trajectory;
mod unblocking;
mod unimpeded;
mod world_changes;

pub use change_results::{ChangeResult, ChangeResults, UnreachableGoal};
pub use endpoints::WellFormedness;
pub use lifelong_report::{LifelongReport, LifelongRunEntry, TrialRun};
pub use motion_record::RunCertificate;
pub use outcome::{LifelongResult, MeasuredLifelongRun, TimeShares};
pub use own_run::{MissionResult, MissionRun, MissionWait, run_missions};
pub use run::{run, run_tasks, watched};
pub use streets::{aisles, streets};
pub use tasks::TaskStream;
pub use world_changes::ChangeEffect;

pub use gates::{Gate, gates};

use crate::error::ExecutionError;
use endpoints::Endpoints;
use pcr_formats::import::ImportedLayout;
use route_graph::RouteGraph;
use serde::Serialize;

/// The nodes between which vehicles like this can carry out missions without end, the safe ends, and obstacles to it.
///
/// # Errors
/// An edge that is no path.
pub fn well_formedness(imported: &ImportedLayout, seed: u64) -> Result<WellFormedness, ExecutionError> {
    let site = RouteGraph::new(imported)?;
    Ok(Endpoints::of(&site, seed).report(&site, &imported.layout))
}

/// How robots are kept apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum CoordinationMethod {
    /// Passing orders.
    Orders,
    /// A robot sets off when no other robot has a lock on any part of its whole route.
    RouteLocks,
    /// A robot gets one edge after the other, each only if all robots can still finish.
    EdgeLocks,
    /// A robot sets off when it is expected to meet no other robot; passing orders enforce this if a robot is late.
    StartDelays,
}

impl CoordinationMethod {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Orders, Self::RouteLocks, Self::EdgeLocks, Self::StartDelays];

    /// Its name in files.
    pub fn key(self) -> &'static str {
        match self {
            Self::Orders => "orders",
            Self::RouteLocks => "route-locks",
            Self::EdgeLocks => "edge-locks",
            Self::StartDelays => "start-delays",
        }
    }

    /// Its name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Orders => "orders",
            Self::RouteLocks => "route locks",
            Self::EdgeLocks => "edge locks",
            Self::StartDelays => "start delays",
        }
    }
}

/// Random delays of robots.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct DelayModel {
    /// Share of the time for which a robot is stopped at random.
    pub stopped: f64,
    /// Mean duration of a stop \[s\].
    pub stop: f64,
    /// Largest share of its speed that a robot loses; the share changes every few seconds.
    pub slip: f64,
}

impl Default for DelayModel {
    /// Stopped for 2 % of the time, 5 s each; up to 5 % slower.
    fn default() -> Self {
        Self { stopped: 0.02, stop: 5.0, slip: 0.05 }
    }
}

/// The options of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LifelongOptions {
    /// Number of robots.
    pub agents: usize,
    /// Time for which missions come \[s\].
    pub duration: f64,
    /// Random delays.
    pub delays: DelayModel,
    /// Seed of missions and delays.
    pub seed: u64,
    /// Method that keeps robots apart.
    pub method: CoordinationMethod,
}
