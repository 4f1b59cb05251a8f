//! Executes plans on graphs while robots are late: by passing orders on the geometry of discs, or by the cells of a
//! grid.
//!
//! Robots move as such plans assume: each one drives at one speed or stands, and changes between the two at once. At
//! random times a robot is stopped, whatever it is doing. Robots have no clock: the passing order is that of the plan,
//! and the robot that passes second waits.
//!
//! ```text
//! orders     passing orders for collision regions, as in the plan       Orders of pcr-core
//! switching  orders that are reversed if all arrive sooner
//! cells      the order in which robots enter each cell: an action dependency graph (Hoenig et al. 2019)
//! ```

mod cell_dependencies;
mod fixed_precedences;
mod switchable_precedences;

use crate::error::LabError;
use cell_dependencies::CellDependencyGraph;
use fixed_precedences::FixedPrecedences;
use pcr_core::Motion;
use pcr_formats::import::{GridPlan, sectioned};
use pcr_formats::scenario::Scenario;
use pcr_formats::splitmix64::SplitMix64;
use pcr_planning::certify::MotionCertificate;
use pcr_planning::fleet::Fleet;
use serde::Deserialize;
use std::time::{Duration, Instant};
use switchable_precedences::SwitchablePrecedences;

/// Time between two control steps \[s\]: a power of two, so that whole seconds are met exactly.
const STEP: f64 = 1.0 / 16.0;

/// Control steps between two looks at the whole fleet.
const LOOK: u32 = 16;

/// Mean duration of a stop, known from earlier stops; and the further duration that is expected of a stop that lasts longer \[s\].
const STOP: f64 = 15.0;
const LOOK_AGAIN: f64 = 1.0;

/// Speed of all robots \[m/s\]: a cell a step.
const SPEED: f64 = 1.0;

/// Lengths that differ by less are equal, for rounding and for turns in place, which have the length of a tiny arc \[m\].
const NEAR: f64 = 1e-5;

/// Additional radius of the discs for their orders, and distance at which robots stand before their holds \[m\]: their speeds
/// change within a nanosecond, not immediately.
const ROOM: f64 = 1e-6;

/// Ways below this are rounding \[m\].
const LEAST: f64 = 1e-9;

/// For each robot the times in which it is stopped, in increasing order \[s\].
pub type RandomStops = Vec<Vec<[f64; 2]>>;

/// The method that keeps robots apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ExecutionMethod {
    /// By the passing orders of the plan, on the geometry of discs.
    Orders,
    /// By the same orders, but an order is reversed if a late robot holds others up and has not used its right.
    Switching,
    /// By cells: a robot enters a cell only when the robot that was there before has reached its next cell.
    Cells,
}

impl ExecutionMethod {
    /// Its name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Orders => "orders",
            Self::Switching => "switching",
            Self::Cells => "cells",
        }
    }
}

/// The results of a run.
#[derive(Clone, Debug)]
pub struct GridRunResult {
    /// Mean time of arrival of the robots that have a way \[s\].
    pub travel: f64,
    /// Mean time of arrival if no robot waited for another one, from the stops alone \[s\].
    pub alone: f64,
    /// Time of the last arrival \[s\].
    pub makespan: f64,
    /// Number of robots that wait for one another for ever.
    pub stuck: usize,
    /// The motions of the run, as a scenario.
    pub done: Scenario,
    /// Result of the independent checker for these motions.
    pub proof: MotionCertificate,
    /// Computing times until the orders were known, and until all robots had arrived.
    pub times: [Duration; 2],
}

/// A rule that tells robots how far they may go.
trait ExecutionRule {
    /// Length up to which a robot may go when all are at `at` \[m\]; values above `wanted` are equivalent. It never decreases.
    fn authority(&mut self, robot: usize, at: &[f64], wanted: f64) -> f64;

    /// Called once a second with the lengths of all robots, and the expected remaining durations of their stops \[s\].
    fn on_tick(&mut self, _at: &[f64], _stopped: &[f64]) {}
}

/// No robot is in another one's way.
struct UnimpededExecution;

impl ExecutionRule for UnimpededExecution {
    fn authority(&mut self, _: usize, _: &[f64], _: f64) -> f64 {
        f64::INFINITY
    }
}

/// Carries out a plan with discs of a radius below half a cell \[m\], which are stopped at times.
///
/// # Errors
/// A plan with a contact of such discs, or a value out of range.
pub fn carried_out(
    plan: &GridPlan,
    radius: f64,
    by: ExecutionMethod,
    stops: &RandomStops,
) -> Result<GridRunResult, LabError> {
    let scenario = plan.scenario(radius + ROOM)?;
    let fleet = Fleet::<f64>::new(&scenario)?;
    let motions = fleet.motions();
    let begin = Instant::now();
    let (run, known) = match by {
        ExecutionMethod::Orders | ExecutionMethod::Switching => {
            let table = fixed_precedences::table(&motions)?;
            let mut kept = FixedPrecedences::new(&table, &motions)?;
            if by == ExecutionMethod::Switching {
                let ends = motions.iter().map(|motion| motion.path().length()).collect();
                let mut switching = SwitchablePrecedences::new(kept, ends);
                let known = begin.elapsed();
                (GridExecution::new(&motions, stops).driven(&mut switching), known)
            } else {
                let known = begin.elapsed();
                (GridExecution::new(&motions, stops).driven(&mut kept), known)
            }
        }
        ExecutionMethod::Cells => {
            let mut cells = CellDependencyGraph::new(plan.cells());
            let known = begin.elapsed();
            (GridExecution::new(&motions, stops).driven(&mut cells), known)
        }
    };
    let times = [known, begin.elapsed() - known];
    let done = run.scenario(plan.scenario(radius)?);
    let proof = MotionCertificate::prove::<f64>(&done)?;
    let alone = GridExecution::new(&motions, stops).driven(&mut UnimpededExecution);
    Ok(GridRunResult {
        travel: run.travel(),
        alone: alone.travel(),
        makespan: run.arrivals.iter().copied().fold(0.0, f64::max),
        stuck: (0..motions.len()).filter(|&robot| !run.has_arrived(robot)).count(),
        done,
        proof,
        times,
    })
}

/// Random stops: each second a robot that is not stopped is stopped with this probability, for 10 to 20 s. The times do not
/// depend on the motions.
pub fn random_stops(robots: usize, until: u32, rate: f64, seed: u64) -> RandomStops {
    let stops = |robot: usize| {
        let mut random = SplitMix64(seed ^ (robot as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15));
        let (mut stops, mut free) = (Vec::new(), 0);
        for time in 0..until {
            if time >= free && random.unit() < rate {
                free = time + 10 + random.below(11) as u32;
                stops.push([f64::from(time), f64::from(free)]);
            }
        }
        stops
    };
    (0..robots).map(stops).collect()
}

/// The stops of a situation that was published with a plan (JSON): the number of steps that each robot has done, `states`, and
/// the number of steps for which it is stopped then, `delay_steps`. They begin when the robot with the most steps has done
/// these.
///
/// # Errors
/// An invalid file, or one for another number of robots.
pub fn situation(text: &str, robots: usize) -> Result<RandomStops, LabError> {
    #[derive(Deserialize)]
    struct DelaySituation {
        delay_steps: Vec<u32>,
        states: Vec<u32>,
    }
    let read: DelaySituation = serde_json::from_str(text)?;
    if [read.delay_steps.len(), read.states.len()] != [robots; 2] {
        return Err(LabError::RobotCount([read.delay_steps.len(), robots]));
    }
    let begin = read.states.into_iter().max().map_or(0.0, f64::from);
    let stops = |steps: u32| if steps > 0 { vec![[begin, begin + f64::from(steps)]] } else { Vec::new() };
    Ok(read.delay_steps.into_iter().map(stops).collect())
}

/// Robots under way.
struct GridExecution<'a> {
    stops: &'a RandomStops,
    ends: Vec<f64>,
    at: Vec<f64>,
    /// For each robot the number of stops that are over.
    passed: Vec<usize>,
    /// Times of arrival \[s\].
    arrivals: Vec<f64>,
    /// For each robot its ways per step \[m\], with the number of successive steps.
    done: Vec<Vec<(f64, u32)>>,
}

impl<'a> GridExecution<'a> {
    fn new(motions: &[Motion<'_, f64>], stops: &'a RandomStops) -> Self {
        let count = motions.len();
        let ends = motions.iter().map(|motion| motion.path().length()).collect();
        let (at, arrivals) = (vec![0.0; count], vec![0.0; count]);
        Self { stops, ends, at, passed: vec![0; count], arrivals, done: vec![Vec::new(); count] }
    }

    /// Mean time of arrival of the robots that have a way \[s\].
    fn travel(&self) -> f64 {
        let travels: Vec<f64> = self.arrivals.iter().copied().filter(|&end| end > 0.0).collect();
        travels.iter().sum::<f64>() / travels.len().max(1) as f64
    }

    fn has_arrived(&self, robot: usize) -> bool {
        self.at[robot] >= self.ends[robot]
    }

    /// Runs until all robots have arrived, or none can go on.
    fn driven(mut self, holds: &mut dyn ExecutionRule) -> Self {
        for step in 0_u32.. {
            let time = f64::from(step) * STEP;
            let before = self.at.clone();
            if step % LOOK == 0 {
                let stopped: Vec<f64> = (0..before.len()).map(|robot| self.stopped_for(robot, time)).collect();
                holds.on_tick(&before, &stopped);
            }
            let (mut goes, mut waits) = (false, false);
            for robot in 0..before.len() {
                let left = self.ends[robot] - before[robot];
                let mut way = 0.0;
                if self.is_stopped(robot, time) {
                    waits |= left > 0.0;
                } else if left > 0.0 {
                    let most = if left <= SPEED * STEP + NEAR { left } else { SPEED * STEP };
                    let hold = holds.authority(robot, &before, before[robot] + most);
                    way = most.min(hold - before[robot]);
                    way = if way < LEAST && way < left { 0.0 } else { way };
                    goes |= way > 0.0;
                }
                self.go(robot, way, time + STEP);
            }
            if !goes && !waits {
                break;
            }
        }
        self
    }

    /// Expected remaining duration of a stop \[s\]: only the mean duration of stops is known.
    fn stopped_for(&mut self, robot: usize, time: f64) -> f64 {
        if !self.is_stopped(robot, time) {
            return 0.0;
        }
        self.stops[robot].get(self.passed[robot]).map_or(0.0, |stop| (STOP - (time - stop[0])).max(LOOK_AGAIN))
    }

    fn is_stopped(&mut self, robot: usize, time: f64) -> bool {
        let Some(stops) = self.stops.get(robot) else { return false };
        let passed = &mut self.passed[robot];
        while stops.get(*passed).is_some_and(|stop| stop[1] <= time) {
            *passed += 1;
        }
        stops.get(*passed).is_some_and(|stop| stop[0] <= time)
    }

    fn go(&mut self, robot: usize, way: f64, time: f64) {
        match self.done[robot].last_mut() {
            Some((last, steps)) if *last == way => *steps += 1,
            _ => self.done[robot].push((way, 1)),
        }
        if way > 0.0 {
            self.at[robot] += way;
            // The last step ends exactly at the end.
            if self.ends[robot] - self.at[robot] < LEAST {
                self.at[robot] = self.ends[robot];
                self.arrivals[robot] = time;
            }
        }
    }

    /// The motions of the run in a scenario with the same paths.
    fn scenario(&self, mut scenario: Scenario) -> Scenario {
        for (agent, done) in scenario.agents.iter_mut().zip(&self.done) {
            let sections: Vec<(f64, f64)> =
                done.iter().map(|&(way, steps)| (way * f64::from(steps), STEP * f64::from(steps))).collect();
            // Standing at the end needs no motion.
            let moves = sections.iter().rposition(|(way, _)| *way > 0.0).map_or(0, |last| last + 1);
            agent.motion = sectioned(&sections[..moves]);
        }
        scenario
    }
}
