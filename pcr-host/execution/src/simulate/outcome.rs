//! Results of a run: a record of the true positions, and the figures that follow from it.

use super::frame_contact::{contacts, separation};
use super::outline_contact::{BodyTrack, meetings};
use super::pcr_controller::PlanningStatistics;
use super::replan::{BlockedRobot, Blocker, ClearanceEntry};
use super::simulation_task::SimulationTask;
use super::steering::closed;
use super::vector::{PlaneVector, norm, sub};
use super::{ClosedLoopOptions, ControllerKind, Disturbance, FRAME, PlanSnapshot};
use pcr_formats::scenario::Labels;
use pcr_formats::warning::WarningCode;
use serde::Serialize;

/// A robot that is slower than this share of its top speed waits.
const WAITS: f64 = 0.1;

/// A run with its record.
#[derive(Clone, Debug)]
pub struct SimulationRun {
    /// The figures.
    pub run: ControllerRunEntry,
    /// The record from which they are computed.
    pub trace: MotionTrace,
    /// The plans of the supervisor.
    pub snapshots: Vec<PlanSnapshot>,
    /// Time of each planning of the supervisor \[s\].
    pub planned: Vec<f64>,
}

/// The record of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct MotionTrace {
    /// True positions \[m\] of each robot, at each frame; in between it moves uniformly.
    pub positions: Vec<Vec<PlaneVector>>,
    /// True headings \[rad\] likewise; 0 for discs. In between it turns uniformly.
    pub headings: Vec<Vec<f64>>,
    /// Lengths along the paths of their missions \[m\] likewise; 0 for robots that are not bound to a path.
    pub travelled: Vec<Vec<f64>>,
    /// The missions, by their begin.
    pub journeys: Vec<MissionRecord>,
}

/// A mission as it was carried out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MissionRecord {
    /// Index of the robot in the task.
    pub robot: usize,
    /// Frame in which the robot got its mission.
    pub begin: usize,
    /// Frame in which the robot arrived, if it did.
    pub end: Option<usize>,
    /// Goal \[m\].
    pub goal: PlaneVector,
    /// Time that the mission takes if no robot is in the way \[s\].
    pub unimpeded: f64,
}

/// The runs of a task: the JSON output, field for field in this order.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SimulationReport {
    /// Name of the scenario.
    pub name: String,
    /// Labels of the agents, by their numbers.
    #[serde(skip_serializing_if = "Labels::is_empty")]
    pub labels: Labels,
    /// Seed of the disturbances.
    pub seed: u64,
    /// Time from one plan to the next \[s\].
    pub replan: f64,
    /// Largest error of an observed position \[m\].
    pub noise: f64,
    /// Largest distance of a robot from its path \[m\].
    pub drift: f64,
    /// Largest share of its way that a robot loses to slip.
    pub slip: f64,
    /// Longest time for which a robot is held up \[s\].
    pub delay: f64,
    /// One run for each controller.
    pub runs: Vec<ControllerRunEntry>,
    /// Warnings about input that was changed or left out when it was read.
    pub warnings: Vec<String>,
}

impl SimulationReport {
    /// The results of these runs.
    pub fn from_runs(task: &SimulationTask, settings: ClosedLoopOptions, outcomes: &[SimulationRun]) -> Self {
        let ClosedLoopOptions { seed, replan, disturbance: Disturbance { noise, slip, delay, drift } } = settings;
        let runs = outcomes.iter().map(|outcome| outcome.run.clone()).collect();
        let (name, labels, mut warnings) = (task.name.clone(), task.labels.clone(), task.warnings.clone());
        if outcomes.iter().any(|outcome| outcome.run.controller == ControllerKind::Potential) {
            let why = "its path ends where it begins; the controller potential goes straight to the end, and has nothing to do";
            warnings.extend(closed(task).map(|id| WarningCode::ClosedPath.text(format_args!("agent {id}: {why}"))));
        }
        let knows_discs = |outcome: &&SimulationRun| outcome.run.controller != ControllerKind::Pcr;
        let outlines = task.robots.iter().map(|robot| (robot.id, &robot.body));
        let mut outlines = outlines.filter(|(_, body)| !body.is_disc()).map(|(id, _)| id);
        if let Some(run) = outcomes.iter().find(knows_discs)
            && let Some(id) = outlines.next()
        {
            let others = outlines.count();
            let which = if others > 0 { format!("agent {id} and {others} more") } else { format!("agent {id}") };
            let name = run.run.controller.name();
            warnings.push(WarningCode::DiscAroundOutline.text(format_args!(
                "{which}: controllers like {name} know discs only; under these each is the disc around its outline"
            )));
        }
        Self { name, labels, seed, replan, noise, drift, slip, delay, runs, warnings }
    }

    /// Whether all missions were done without a collision under [`ControllerKind::Pcr`], if that is among the runs.
    pub fn is_as_promised(&self) -> bool {
        let failed = |run: &ControllerRunEntry| run.not_done > 0 || !run.collisions.is_empty();
        !self.runs.iter().any(|run| run.controller == ControllerKind::Pcr && failed(run))
    }
}

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum RunEnd {
    /// All missions are done.
    Done,
    /// No robot would ever have moved again.
    Standstill,
    /// It was given up at [`time_limit`](super::time_limit).
    TimeLimit,
}

/// The figures of a run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ControllerRunEntry {
    /// Controller of the robots.
    pub controller: ControllerKind,
    /// Number of missions done.
    pub done: usize,
    /// Number of missions not done.
    pub not_done: usize,
    /// Time until the end of the last mission, or until the run was given up \[s\].
    pub duration: f64,
    /// How the run ended.
    pub ended: RunEnd,
    /// Mean time of a mission that was done \[s\].
    pub travel: f64,
    /// Mean time that these missions would have taken if no robot was in the way \[s\].
    pub unimpeded: f64,
    /// Mean time of such a mission in which the robot moved at less than a tenth of its top speed \[s\].
    pub waiting: f64,
    /// The missions, by their begin.
    pub missions: Vec<MissionEntry>,
    /// Robots in contact.
    pub collisions: Vec<CollisionEntry>,
    /// Least distance between two robots or obstacles \[m\]; negative where they overlap.
    pub clearance: Option<f64>,
    /// Robots that stand with a mission that is not done, and for which others they wait.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub waiting_for: Vec<BlockedRobotEntry>,
    /// Figures about planning; `None` without a supervisor.
    pub planning: Option<PlanningEntry>,
}

/// A mission.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct MissionEntry {
    /// Number of the robot.
    pub id: u64,
    /// Time at which the robot got the mission \[s\].
    pub begin: f64,
    /// Time of arrival \[s\].
    pub end: Option<f64>,
    /// Time that the mission takes if no robot is in the way \[s\].
    pub unimpeded: f64,
    /// Time in which the robot moved at less than a tenth of its top speed \[s\].
    pub waiting: f64,
}

/// A robot that stands with a mission that is not done.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct BlockedRobotEntry {
    /// Number of the robot.
    pub id: u64,
    /// Whether it has begun the mission.
    pub begun: bool,
    /// Before the mission is begun: number of the robot or obstacle that stands in its way, within their margins; `None` for an
    /// obstacle without a number, and if no passing order lets it through. Afterwards: number of the robot that passes first.
    #[serde(rename = "by")]
    pub blocked_by: Option<u64>,
    /// The room that is missing beside it, if that is all that keeps the robot from its beginning.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clearance: Option<ClearanceEntry>,
}

/// Two robots in contact.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct CollisionEntry {
    /// Number of a robot.
    pub i: u64,
    /// Number of the other robot or obstacle; `None` for an obstacle without a number.
    pub j: Option<u64>,
    /// Begin and end, in whole frames \[s\].
    pub t: [f64; 2],
    /// Largest overlap \[m\].
    pub depth: f64,
}

/// Figures about planning. The times depend on the machine and differ from run to run.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct PlanningEntry {
    /// Number of attempts to plan.
    pub count: usize,
    /// Number of attempts that found no plan, or none with earlier arrivals, so that the old passing orders stayed.
    pub kept: usize,
    /// Number of times a robot could not brake in time for its passing order. This should be 0.
    #[serde(rename = "breaches")]
    pub authority_overruns: usize,
    /// Mean time \[ms\].
    pub mean_ms: f64,
    /// Longest time \[ms\].
    pub longest_ms: f64,
}

impl ControllerRunEntry {
    pub(super) fn of(
        task: &SimulationTask,
        (controller, ended): (ControllerKind, RunEnd),
        trace: &MotionTrace,
        planning: Option<&PlanningStatistics>,
        waiting: &[BlockedRobot],
    ) -> Self {
        let missions: Vec<MissionEntry> =
            trace.journeys.iter().filter_map(|journey| arrival(task, trace, journey)).collect();
        let all: usize = task.robots.iter().map(|robot| robot.missions.len()).sum();
        let done: Vec<(&MissionEntry, f64)> =
            missions.iter().filter_map(|mission| Some((mission, mission.end? - mission.begin))).collect();
        let mean = |value: &dyn Fn(&(&MissionEntry, f64)) -> f64| {
            if done.is_empty() { 0.0 } else { done.iter().map(value).sum::<f64>() / done.len() as f64 }
        };
        // A place does not tell whether a turn in place at the end is over.
        let is_done = |robot: usize| {
            let done = trace.journeys.iter().filter(|journey| journey.robot == robot && journey.end.is_some());
            done.count() == task.robots[robot].missions.len()
        };
        let given_up = trace.positions.first().map_or(0.0, |track| (track.len() - 1) as f64 * FRAME);
        let (collisions, clearance) = collisions(task, trace, controller == ControllerKind::Pcr);
        Self {
            controller,
            done: done.len(),
            not_done: all - done.len(),
            duration: given_up,
            ended,
            travel: mean(&|(_, travel)| *travel),
            unimpeded: mean(&|(mission, _)| mission.unimpeded),
            waiting: mean(&|(mission, _)| mission.waiting),
            collisions,
            clearance,
            planning: planning.map(PlanningEntry::of),
            waiting_for: waiting
                .iter()
                .filter(|waits| !is_done(waits.robot))
                .map(|waits| BlockedRobotEntry::of(task, *waits))
                .collect(),
            missions,
        }
    }
}

impl BlockedRobotEntry {
    fn of(task: &SimulationTask, waiting: BlockedRobot) -> Self {
        let BlockedRobot { robot, begun, blocked_by: by, clearance } = waiting;
        let by = match by {
            Some(Blocker::Robot(other)) => task.robots.get(other).map(|robot| robot.id),
            Some(Blocker::Obstacle(other)) => task.obstacles.get(other).and_then(|obstacle| obstacle.id),
            None => None,
        };
        Self { id: task.robots[robot].id, begun, blocked_by: by, clearance }
    }
}

impl PlanningEntry {
    fn of(statistics: &PlanningStatistics) -> Self {
        let PlanningStatistics { times, kept, breaches } = statistics;
        let count = times.len();
        let mean_ms = times.iter().sum::<f64>() / count.max(1) as f64 * 1e3;
        let longest_ms = times.iter().copied().fold(0.0, f64::max) * 1e3;
        Self { count, kept: *kept, authority_overruns: *breaches, mean_ms, longest_ms }
    }
}

fn arrival(task: &SimulationTask, trace: &MotionTrace, journey: &MissionRecord) -> Option<MissionEntry> {
    let robot = task.robots.get(journey.robot)?;
    let track = trace.positions.get(journey.robot)?;
    let part = track.get(journey.begin..=journey.end.unwrap_or(track.len() - 1))?;
    let slow = WAITS * robot.limits.speed * FRAME;
    let waits = part.windows(2).filter(|pair| norm(sub(pair[1], pair[0])) < slow).count();
    Some(MissionEntry {
        id: robot.id,
        begin: journey.begin as f64 * FRAME,
        end: journey.end.map(|end| end as f64 * FRAME),
        unimpeded: journey.unimpeded,
        waiting: waits as f64 * FRAME,
    })
}

/// All contacts of robots with one another and with obstacles, by their begin; and the least distance. Under controllers of discs, which leave
/// the paths, only discs have a place, and no heading.
fn collisions(task: &SimulationTask, trace: &MotionTrace, has_outlines: bool) -> (Vec<CollisionEntry>, Option<f64>) {
    let robots: Vec<_> = task.robots.iter().zip(&trace.positions).collect();
    let (mut collisions, mut clearance) = (Vec::new(), None::<f64>);
    let mut look = |i: u64, j: Option<u64>, tracks: [&[PlaneVector]; 2], radius: f64, bodies: [BodyTrack<'_>; 2]| {
        let (found, apart) = if has_outlines && bodies.iter().any(|body| !body.is_disc()) {
            meetings(&bodies[0], &bodies[1])
        } else {
            (contacts(tracks[0], tracks[1], radius), separation(tracks[0], tracks[1]) - radius)
        };
        clearance = Some(clearance.map_or(apart, |least| least.min(apart)));
        collisions.extend(found.into_iter().map(|contact| {
            let t = contact.frames.map(|frame| frame as f64 * FRAME);
            CollisionEntry { i, j, t, depth: contact.depth }
        }));
    };
    let body = |place: usize| BodyTrack::new(&task.robots[place].body, &trace.positions[place], &trace.headings[place]);
    for (place, (robot, track)) in robots.iter().enumerate() {
        for (after, (other, other_track)) in robots.iter().skip(place + 1).enumerate() {
            let bodies = [body(place), body(after + place + 1)];
            look(robot.id, Some(other.id), [track, other_track], robot.radius + other.radius, bodies);
        }
        for obstacle in &task.obstacles {
            let (stands, heading) = (vec![obstacle.centre; track.len()], vec![obstacle.heading; track.len()]);
            let bodies = [body(place), BodyTrack::new(&obstacle.body, &stands, &heading)];
            look(robot.id, obstacle.id, [track, &stands], robot.radius + obstacle.radius, bodies);
        }
    }
    collisions.sort_by(|a, b| a.t[0].total_cmp(&b.t[0]));
    (collisions, clearance.filter(|clearance| clearance.is_finite()))
}
