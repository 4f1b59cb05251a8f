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

mod cells;
mod orders;
mod switching;

use crate::certify::Proof;
use crate::fleet::Fleet;
use crate::random::Random;
use cells::Cells;
use orders::Kept;
use pcr_core::Motion;
use pcr_formats::import::{GridPlan, sectioned};
use pcr_formats::scenario::Scenario;
use serde::Deserialize;
use std::time::{Duration, Instant};
use switching::Switching;

/// Time between two controls \[s\]: a binary fraction, with which steps of a second are met exactly.
const STEP: f64 = 1.0 / 16.0;

/// Controls between two looks at the whole fleet.
const LOOK: u32 = 16;

/// How long a stop lasts on average, which is known from stops before; of a stop that lasts longer, how much longer is expected \[s\].
const STOP: f64 = 15.0;
const LOOK_AGAIN: f64 = 1.0;

/// Speed of all robots \[m/s\]: a cell a step.
const SPEED: f64 = 1.0;

/// Lengths that differ by less are the same, for rounding and for turns in place, which have the length of a tiny arc \[m\].
const NEAR: f64 = 1e-5;

/// By so much discs are larger for their orders than they are, and so far before their holds robots stand: their speeds change within a
/// nanosecond, and not at once \[m\].
const ROOM: f64 = 1e-6;

/// Ways that are rounding and nothing else \[m\].
const LEAST: f64 = 1e-9;

/// Times in which each robot is stopped, one after the other \[s\].
pub type Stops = Vec<Vec<[f64; 2]>>;

/// How robots are kept apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum By {
    /// By the passing orders of the plan, on the geometry of discs.
    Orders,
    /// By the same orders, which are turned round where somebody who is late holds others up and has not used its right.
    Switching,
    /// By cells: one is entered only when whoever was there before has come to its next one.
    Cells,
}

impl By {
    /// What it is called in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Orders => "orders",
            Self::Switching => "switching",
            Self::Cells => "cells",
        }
    }
}

/// How it went.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// Mean time until a robot that has a way is at its end \[s\].
    pub travel: f64,
    /// The same if nobody waited for anybody: what the stops alone cost \[s\].
    pub alone: f64,
    /// Until the last one is at its end \[s\].
    pub makespan: f64,
    /// Robots that wait for one another for ever.
    pub stuck: usize,
    /// What was done, as a scenario.
    pub done: Scenario,
    /// What the independent checker says of that.
    pub proof: Proof,
    /// Until the orders were known, and until all were at their ends.
    pub times: [Duration; 2],
}

/// Something that tells robots how far they may go.
trait Holds {
    /// How far a robot may go when all are here \[m\]; more than `wanted` does not matter. It never decreases.
    fn hold(&mut self, robot: usize, at: &[f64], wanted: f64) -> f64;

    /// Once a second: where all are, and for how much longer they are expected to be stopped \[s\].
    fn look(&mut self, _at: &[f64], _stopped: &[f64]) {}
}

/// Nobody is in anybody's way.
struct Nobody;

impl Holds for Nobody {
    fn hold(&mut self, _: usize, _: &[f64], _: f64) -> f64 {
        f64::INFINITY
    }
}

/// Carries a plan out with discs of a radius \[m\], below half a cell, that are stopped at times.
///
/// # Errors
/// Where the plan has a contact of such discs, or a value is out of range.
pub fn carried_out(plan: &GridPlan, radius: f64, by: By, stops: &Stops) -> Result<Outcome, String> {
    let scenario = plan.scenario(radius + ROOM).map_err(|error| error.to_string())?;
    let fleet = Fleet::<f64>::new(&scenario).map_err(|refused| refused.to_string())?;
    let motions = fleet.motions();
    let begin = Instant::now();
    let (run, known) = match by {
        By::Orders | By::Switching => {
            let table = orders::table(&motions)?;
            let mut kept = Kept::new(&table, &motions)?;
            if by == By::Switching {
                let ends = motions.iter().map(|motion| motion.path().length()).collect();
                let mut switching = Switching::new(kept, ends);
                let known = begin.elapsed();
                (Run::new(&motions, stops).driven(&mut switching), known)
            } else {
                let known = begin.elapsed();
                (Run::new(&motions, stops).driven(&mut kept), known)
            }
        }
        By::Cells => {
            let mut cells = Cells::new(plan.cells());
            let known = begin.elapsed();
            (Run::new(&motions, stops).driven(&mut cells), known)
        }
    };
    let times = [known, begin.elapsed() - known];
    let done = run.scenario(plan.scenario(radius).map_err(|error| error.to_string())?);
    let proof = Proof::of::<f64>(&done).map_err(|refused| refused.to_string())?;
    let alone = Run::new(&motions, stops).driven(&mut Nobody);
    Ok(Outcome {
        travel: run.travel(),
        alone: alone.travel(),
        makespan: run.arrivals.iter().copied().fold(0.0, f64::max),
        stuck: (0..motions.len()).filter(|&robot| !run.has_arrived(robot)).count(),
        done,
        proof,
        times,
    })
}

/// Everybody is stopped with this probability each second that it is not, for 10 to 20 s: the same times whatever they do.
pub fn random_stops(robots: usize, until: u32, rate: f64, seed: u64) -> Stops {
    let stops = |robot: usize| {
        let mut random = Random(seed ^ (robot as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15));
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

/// The stops of a situation that is published with a plan (JSON): how many steps each robot has done, `states`, and for how many it is
/// stopped then, `delay_steps`. They begin when whoever has done most has done that.
///
/// # Errors
/// Where it is no such file, or one for another number of robots.
pub fn situation(text: &str, robots: usize) -> Result<Stops, String> {
    #[derive(Deserialize)]
    struct Situation {
        delay_steps: Vec<u32>,
        states: Vec<u32>,
    }
    let read: Situation = serde_json::from_str(text).map_err(|error| error.to_string())?;
    if [read.delay_steps.len(), read.states.len()] != [robots; 2] {
        return Err(format!("the situation is of {} robots, the plan of {robots}", read.delay_steps.len()));
    }
    let begin = read.states.into_iter().max().map_or(0.0, f64::from);
    let stops = |steps: u32| if steps > 0 { vec![[begin, begin + f64::from(steps)]] } else { Vec::new() };
    Ok(read.delay_steps.into_iter().map(stops).collect())
}

/// Robots on their way.
struct Run<'a> {
    stops: &'a Stops,
    ends: Vec<f64>,
    at: Vec<f64>,
    /// Stops that are over.
    passed: Vec<usize>,
    /// When each has come to its end \[s\].
    arrivals: Vec<f64>,
    /// What each did: ways of a step \[m\], and for how many steps.
    done: Vec<Vec<(f64, u32)>>,
}

impl<'a> Run<'a> {
    fn new(motions: &[Motion<'_, f64>], stops: &'a Stops) -> Self {
        let count = motions.len();
        let ends = motions.iter().map(|motion| motion.path().length()).collect();
        let (at, arrivals) = (vec![0.0; count], vec![0.0; count]);
        Self { stops, ends, at, passed: vec![0; count], arrivals, done: vec![Vec::new(); count] }
    }

    /// Mean time until a robot that has a way is at its end \[s\].
    fn travel(&self) -> f64 {
        let travels: Vec<f64> = self.arrivals.iter().copied().filter(|&end| end > 0.0).collect();
        travels.iter().sum::<f64>() / travels.len().max(1) as f64
    }

    fn has_arrived(&self, robot: usize) -> bool {
        self.at[robot] >= self.ends[robot]
    }

    /// Until everybody has arrived, or nobody can go on.
    fn driven(mut self, holds: &mut dyn Holds) -> Self {
        for step in 0_u32.. {
            let time = f64::from(step) * STEP;
            let before = self.at.clone();
            if step % LOOK == 0 {
                let stopped: Vec<f64> = (0..before.len()).map(|robot| self.stopped_for(robot, time)).collect();
                holds.look(&before, &stopped);
            }
            let (mut goes, mut waits) = (false, false);
            for robot in 0..before.len() {
                let left = self.ends[robot] - before[robot];
                let mut way = 0.0;
                if self.is_stopped(robot, time) {
                    waits |= left > 0.0;
                } else if left > 0.0 {
                    let most = if left <= SPEED * STEP + NEAR { left } else { SPEED * STEP };
                    let hold = holds.hold(robot, &before, before[robot] + most);
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

    /// For how long a robot that is stopped now is expected to be: nobody knows that of a stop, but how long stops are on average \[s\].
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
            // The last step goes to the end.
            if self.ends[robot] - self.at[robot] < LEAST {
                self.at[robot] = self.ends[robot];
                self.arrivals[robot] = time;
            }
        }
    }

    /// What was done by the agents of a scenario with the same paths.
    fn scenario(&self, mut scenario: Scenario) -> Scenario {
        for (agent, done) in scenario.agents.iter_mut().zip(&self.done) {
            let sections: Vec<(f64, f64)> =
                done.iter().map(|&(way, steps)| (way * f64::from(steps), STEP * f64::from(steps))).collect();
            // Whoever stands on has no motion for it.
            let moves = sections.iter().rposition(|(way, _)| *way > 0.0).map_or(0, |last| last + 1);
            agent.motion = sectioned(&sections[..moves]);
        }
        scenario
    }
}
