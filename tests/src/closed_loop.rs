//! Random fleets in closed loop: whatever has a plan is carried out without a contact.

use crate::generators::Dice;
use pcr_comparing::compare::crowd;
use pcr_core::{Point, Pose, Radians};
use pcr_execution::simulate::{
    ClosedLoopOptions, ControllerKind, ControllerRunEntry, Disturbance, FRAME, ReleasedMission, SimulationTask,
    SpeedLimitedPath, run,
};
use pcr_formats::scenario::{Agent, PathSegment, PlacedSegment};
use pcr_planning::plan::{PlanOptions, PlanReport};
use std::f64::consts::PI;
use std::fmt;
use std::time::Instant;

/// The disturbances of the tool where nothing else is asked for.
pub const USUAL: Disturbance = Disturbance { noise: 0.015, slip: 0.05, delay: 1.0, drift: 0.005 };

/// What the robots of a fleet have to do.
#[derive(Clone, Copy, Debug, Default)]
pub struct Missions {
    /// They set off at random times until then \[s\], which is known from the beginning.
    pub latest: f64,
    /// After that they travel back and there again so many times. Nobody knows of a way before it begins.
    pub trips: usize,
}

/// What became of some fleets.
#[derive(Clone, Debug, Default)]
pub struct Tally {
    /// Fleets without a plan, with which nothing was done.
    pub unplanned: usize,
    /// Fleets of which all robots have arrived without a contact.
    pub carried_out: usize,
    /// Fleets of which it is said of each robot that has not arrived why it never set off; all others have arrived, without a contact.
    pub told: usize,
    /// All other ones.
    pub failed: usize,
    /// Contacts of discs.
    pub contacts: usize,
    /// Robots that had to brake harder than they can.
    pub breaches: usize,
    /// Longest time of planning \[ms\].
    pub planning: Vec<f64>,
    /// Times of all plannings but the first one of each fleet \[ms\].
    pub replanning: Vec<f64>,
    /// Simulated time over that of the machine, of each fleet.
    pub speeds: Vec<f64>,
}

impl fmt::Display for Tally {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { unplanned, carried_out, told, failed, contacts, breaches, planning, replanning, speeds } = self;
        let sorted = |values: &[f64]| {
            let mut values = values.to_vec();
            values.sort_by(f64::total_cmp);
            values
        };
        let (planning, replanning, speeds) = (sorted(planning), sorted(replanning), sorted(speeds));
        let at = |values: &[f64], part: f64| values.get((values.len() as f64 * part) as usize).copied().unwrap_or(0.0);
        write!(
            f,
            "{carried_out} fleets carried out, {told} as far as their margins allow, {failed} not ({unplanned} more without a plan); {contacts} contacts, \
             {breaches} breaches; longest planning of a run: median {:.1} ms, 99 of 100 within {:.1} ms, at most {:.1} ms; {} times \
             planned anew: median {:.2} ms, 99 of 100 within {:.2} ms, at most {:.1} ms; faster than time by {:.0} at \
             least, {:.0} in the median",
            at(&planning, 0.5),
            at(&planning, 0.99),
            planning.last().copied().unwrap_or(0.0),
            replanning.len(),
            at(&replanning, 0.5),
            at(&replanning, 0.99),
            replanning.last().copied().unwrap_or(0.0),
            speeds.first().copied().unwrap_or(0.0),
            at(&speeds, 0.5)
        )
    }
}

/// Carries out the fleet of a seed, if it has a plan; what went wrong, if something did.
pub fn fleet(seed: u64, largest: usize, missions: Missions, tally: &mut Tally) -> Option<String> {
    let agents = 2 + seed as usize % (largest - 1);
    let mut scenario = crowd(agents, seed);
    let dice = &mut Dice::seeded(seed);
    for agent in scenario.agents.iter_mut().filter(|_| missions.latest > 0.0) {
        agent.t_start = dice.range(0.0, missions.latest);
    }
    let planned = PlanReport::compute(&scenario, &PlanOptions::default()).is_ok_and(|(_, solved)| solved.is_some());
    if !planned {
        tally.unplanned += 1;
        return None;
    }
    let mut task = SimulationTask::from_scenario(&scenario).expect("a fleet with a plan");
    for (robot, agent) in task.robots.iter_mut().zip(&scenario.agents) {
        let there = robot.missions.clone();
        let back = ReleasedMission { release: 0.0, course: back(agent) };
        let trip = [back].into_iter().chain(there.into_iter().map(|there| ReleasedMission { release: 0.0, ..there }));
        robot.missions.extend((0..missions.trips).flat_map(|_| trip.clone()));
    }
    let begin = Instant::now();
    let settings = ClosedLoopOptions { seed, replan: 2.0, disturbance: USUAL };
    let outcome = run(&task, ControllerKind::Pcr, settings).expect("a fleet with a plan");
    let taken = begin.elapsed().as_secs_f64();
    let ControllerRunEntry { done, not_done, collisions, planning, duration, waiting_for, .. } = &outcome.run;
    let planning = planning.expect("a supervisor plans");
    for (agent, drive) in outcome.snapshots.iter().flat_map(|plan| scenario.agents.iter().zip(&plan.drives)) {
        let motion = drive.motion(agent.radius).expect("a planned motion");
        let stands = motion.path().length() <= 0.0;
        assert!(stands || motion.time().lo >= agent.t_start, "agent {} of seed {seed} is planned too early", agent.id);
    }
    tally.contacts += collisions.len();
    tally.breaches += planning.authority_overruns;
    tally.planning.push(planning.longest_ms);
    tally.replanning.extend(outcome.planned.iter().skip(1).map(|time| 1e3 * time));
    tally.speeds.push(duration.max(FRAME) / taken);
    if *not_done == 0 && collisions.is_empty() && planning.authority_overruns == 0 {
        tally.carried_out += 1;
        return None;
    }
    // Of each robot with a mission left, the next one waits for somebody.
    let all = 1 + 2 * missions.trips;
    let done_by =
        |id: u64| outcome.run.missions.iter().filter(|mission| mission.id == id && mission.end.is_some()).count();
    let unfinished = task.robots.iter().filter(|robot| done_by(robot.id) < all).count();
    let never_begun = waiting_for.iter().filter(|waiting| !waiting.begun).count();
    let is_told = unfinished == never_begun && collisions.is_empty() && planning.authority_overruns == 0;
    *if is_told { &mut tally.told } else { &mut tally.failed } += 1;
    Some(format!(
        "{}, seed {seed}, {agents} robots: {done} done, {not_done} not, {} contacts, {} breaches, planned {} times, {} kept, {duration:.0} s in {taken:.2} s",
        if is_told { "told" } else { "failed" },
        collisions.len(),
        planning.authority_overruns,
        planning.count,
        planning.kept
    ))
}

/// The same path from its end to its beginning.
fn back(agent: &Agent) -> SpeedLimitedPath {
    let mut pose = agent.start;
    for segment in &agent.path {
        let placed = PlacedSegment { start: [pose[0], pose[1]], heading: pose[2], shape: *segment };
        let [x, y] = placed.end();
        pose = [x, y, placed.heading_at_end()];
    }
    let turned = agent.path.iter().rev().map(|segment| match *segment {
        PathSegment::Arc { radius, sweep, .. } => PathSegment::arc(radius, -sweep),
        PathSegment::Line { .. } => *segment,
        _ => panic!("{segment:?}"),
    });
    let start = Pose { position: Point::new(pose[0], pose[1]), heading: Radians(pose[2] + PI) };
    SpeedLimitedPath::new(start, &turned.collect::<Vec<_>>()).expect("a path that is in range")
}
