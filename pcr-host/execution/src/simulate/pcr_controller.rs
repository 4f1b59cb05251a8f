//! The supervisor observes the robots in every frame, plans every few seconds, and keeps the passing orders in between.
//!
//! ```text
//! camera ──> observer: where each robot can be ──┬──> guard: how far it may go ──┐
//!                                                └──> replan: how it should go ──┴──> speed of each robot
//! ```
//!
//! Plans keep a margin for the errors of the camera and of the robots ([`ErrorBounds`]). A late robot causes no collision: the
//! guard holds the robots that pass after it. If no new plan is found, the old orders stay.

use super::braking::{speed_within, stopping_length};
use super::missing_clearance::missing_clearance;
use super::observer::narrowed;
use super::precedence_guard::{GuardError, PrecedenceGuard};
use super::replan::{BlockedRobot, Blocker, FleetMotionPlan, ReplanProblem, RobotState, SEARCHED};
use super::robot_estimate::{ErrorBounds, RobotEstimate, standing};
use super::simulation_task::{RobotTask, SimulationTask, StandingObstacle};
use super::speed_limited_path::{OwnedMotion, SpeedLimitedPath};
use super::true_state::{AT_TURN, TurnState};
use super::{ControlInput, FRAME, MotionCommand, PlanSnapshot, RobotController};
use pcr_core::{Interval, Limits};
use pcr_planning::failure::ComputationError;
use pcr_planning::fleet::ConvexBody;
use std::time::Instant;

/// If no robot has moved for this long plus two planning periods, the fleet is stuck \[s\].
const RESTING: f64 = 1.0;

/// A failed attempt is repeated after one planning period, then after twice the last pause, up to this many periods.
const REST: f64 = 8.0;

/// How fast a robot that is ahead of its plan falls back to it \[1/s\].
const FALLING_BACK: f64 = 2.0;

/// The controller that plans with collision regions.
#[derive(Debug)]
pub(super) struct PcrController {
    agents: Vec<RobotEstimate>,
    obstacles: Vec<(OwnedMotion, ConvexBody)>,
    errors: ErrorBounds,
    guard: PrecedenceGuard,
    plan: Option<ActivePlan>,
    /// The last attempt to plan, if it failed.
    failed: Option<PlanBackoff>,
    period: f64,
    next_plan: f64,
    /// Time for which no robot has moved \[s\].
    still: f64,
    statistics: PlanningStatistics,
    snapshots: Vec<PlanSnapshot>,
}

/// A plan, and the length that each robot had travelled on its course when the plan began \[m\].
#[derive(Debug)]
struct ActivePlan {
    plan: FleetMotionPlan,
    offsets: Vec<f64>,
}

/// A failed attempt to plan. It usually fails again until there is a new mission, a robot reaches its end, or all robots stand.
#[derive(Debug)]
struct PlanBackoff {
    /// For each robot: whether it has a mission that is in no plan yet, and whether it stands at the end of its path.
    robots: Vec<[bool; 2]>,
    /// How long the attempt is not repeated while `robots` is the same, and until what time \[s\].
    pause: f64,
    until: f64,
}

/// A plan that can be adopted, which robots then begin a new mission, and the bodies for which the plan was made.
struct PlanCandidate {
    current: ActivePlan,
    guard: PrecedenceGuard,
    taken: Vec<bool>,
    bodies: Vec<ConvexBody>,
}

/// Figures about planning.
#[derive(Clone, Debug, Default)]
pub(super) struct PlanningStatistics {
    /// Computing time of each attempt to plan \[s\].
    pub(super) times: Vec<f64>,
    /// Number of attempts that found no plan, or none with earlier arrivals.
    pub(super) kept: usize,
    /// Number of times a robot could not brake in time; this should be 0.
    pub(super) breaches: usize,
}

impl ActivePlan {
    fn length_at(&self, agent: usize, time: f64) -> f64 {
        let drive = self.plan.drives.get(agent).and_then(|drive| drive.motion(1.0));
        self.offset(agent) + drive.map_or(0.0, |motion| motion.length_at(time))
    }

    fn speed_at(&self, agent: usize, time: f64) -> f64 {
        self.plan.drives.get(agent).and_then(|drive| drive.motion(1.0)).map_or(0.0, |motion| motion.speed_at(time))
    }

    fn reached(&self, agent: usize, length: f64) -> f64 {
        let motion = self.plan.drives.get(agent).and_then(|drive| drive.motion(1.0));
        motion.map_or(0.0, |motion| {
            motion.time().lo + motion.profile().first_time_at((length - self.offset(agent)).max(0.0))
        })
    }

    fn offset(&self, agent: usize) -> f64 {
        self.offsets.get(agent).copied().unwrap_or(0.0)
    }
}

impl PcrController {
    pub(super) fn new(task: &SimulationTask, errors: ErrorBounds, period: f64) -> Result<Self, ComputationError> {
        let agents =
            task.robots.iter().map(|robot| RobotEstimate::new(robot, errors)).collect::<Result<Vec<_>, _>>()?;
        let obstacle = |obstacle: &StandingObstacle| {
            let course = standing(obstacle.centre, obstacle.heading).ok();
            let drive = course.and_then(|course| OwnedMotion::standing(course, 0.0));
            let body = obstacle.body.inflated(obstacle.margin).ok();
            let both = drive.zip(body).filter(|(drive, body)| drive.motion_of(body).is_some());
            both.ok_or(ComputationError::Obstacle(obstacle.centre))
        };
        let obstacles = task.obstacles.iter().map(obstacle).collect::<Result<_, _>>()?;
        let guard = guard(&task.robots, &agents)?;
        let (statistics, snapshots) = (PlanningStatistics::default(), Vec::new());
        Ok(Self {
            agents,
            obstacles,
            errors,
            guard,
            plan: None,
            failed: None,
            period,
            next_plan: 0.0,
            still: 0.0,
            statistics,
            snapshots,
        })
    }

    pub(super) fn statistics(&self) -> &PlanningStatistics {
        &self.statistics
    }

    /// Updates the interval of lengths in which each robot can be.
    fn observe(&mut self, frame: &ControlInput<'_>) {
        let error = self.errors.noise + self.errors.drift;
        let told = frame.seen.iter().zip(frame.speeds).zip(frame.arrived);
        for (agent, ((&seen, &speed), &arrived)) in self.agents.iter_mut().zip(told) {
            // Robots report wheel speed and arrival; at the end of the path the wheel speed is below the commanded one. Without the
            // report of arrival, others would wait for ever for a robot that stands just inside a region.
            agent.speed = speed;
            let end = agent.course.length();
            agent.position_interval = match arrived {
                true => Interval::new(end, end),
                false => narrowed(agent.position_interval, speed * FRAME, seen, error, &agent.course),
            };
        }
        for (agent, turning) in self.agents.iter_mut().zip(frame.turning) {
            agent.turned = turning.map_or(0.0, |turning| turning.time);
            if let Some(TurnState { at, .. }) = turning {
                agent.position_interval =
                    Interval::new(agent.position_interval.lo.max(at - AT_TURN), agent.position_interval.hi.min(*at));
            }
        }
        let moves = self.agents.iter().any(|agent| agent.speed > 0.0 || agent.turned > 0.0);
        self.still = if moves { 0.0 } else { self.still + FRAME };
    }

    /// Looks for a plan that includes the new missions, or as many of them as possible. Without new missions, looks for a plan with
    /// earlier arrivals. Keeps the old plan if there is none.
    fn replan(&mut self, now: f64) {
        let pending: Vec<bool> = self.agents.iter().map(|agent| agent.next.is_some()).collect();
        let again = self.plan.is_some() && !pending.contains(&true);
        if again && (self.agents.len() > SEARCHED || self.all_wait(now)) {
            return;
        }
        let robots: Vec<[bool; 2]> = self.agents.iter().map(|it| [it.next.is_some(), it.stands()]).collect();
        let before = self.failed.take_if(|failed| failed.robots != robots || now >= failed.until);
        if self.failed.is_some() {
            return;
        }
        let begin = Instant::now();
        let found =
            self.for_all(now, &pending, again).or_else(|| if again { None } else { self.for_some(now, &pending) });
        self.statistics.times.push(begin.elapsed().as_secs_f64());
        match found {
            Some(found) if again && found.current.plan.cost >= self.remaining_time(now) => self.statistics.kept += 1,
            Some(found) => self.take_up(now, found),
            None => {
                self.statistics.kept += 1;
                let same = before.filter(|failed| failed.robots == robots);
                let pause = same.map_or(self.period, |failed| (2.0 * failed.pause).min(REST * self.period));
                // If all robots stand, a later attempt would find the same as this one.
                let until = if robots.iter().all(|robot| robot[1]) { f64::INFINITY } else { now + pause };
                self.failed = Some(PlanBackoff { robots, pause, until });
            }
        }
    }

    /// Whether all robots stand, each at or beyond the length at which the plan has it now.
    fn all_wait(&self, now: f64) -> bool {
        let Some(current) = &self.plan else { return false };
        self.agents
            .iter()
            .enumerate()
            .all(|(place, agent)| agent.speed <= 0.0 && agent.position_interval.hi >= current.length_at(place, now))
    }

    /// A plan for all robots, in which those in `taken` begin their new missions. It keeps the margins of a plan or, if robots are
    /// too near one another for these, the margins of passing orders.
    fn for_all(&self, now: f64, taken: &[bool], again: bool) -> Option<PlanCandidate> {
        // Robots without a new mission that stand at their ends stay there.
        if self.barred(taken, |other| !taken[other]).contains(&true) {
            return None;
        }
        let last: Vec<usize> = match &self.plan {
            Some(current) => current.plan.order.clone(),
            None => (0..self.agents.len()).collect(),
        };
        let of = |margin: usize, plans: &dyn Fn(&ReplanProblem<'_>) -> Vec<FleetMotionPlan>| {
            let robots = self.states(margin, taken)?;
            let plans = plans(&ReplanProblem { now, robots: &robots, obstacles: &self.obstacles });
            plans.into_iter().find_map(|plan| self.found(plan, self.offsets(taken), taken, margin))
        };
        let with = |plans: &dyn Fn(&ReplanProblem<'_>) -> Vec<FleetMotionPlan>| {
            [1, 0].into_iter().find_map(|margin| of(margin, plans))
        };
        if again {
            return with(&|problem| problem.plan(last.clone()).into_iter().collect());
        }
        let found = with(&|problem| problem.delayed().into_iter().collect());
        if self.agents.len() > SEARCHED { found } else { found.or_else(|| with(&|problem| problem.by_priority(&last))) }
    }

    /// Remaining time until arrival under the current plan, summed over all robots \[s\]. For robots ahead of the plan it counts from now.
    fn remaining_time(&self, now: f64) -> f64 {
        let Some(current) = &self.plan else { return f64::INFINITY };
        let left = |(place, agent): (usize, &RobotEstimate)| {
            let [at, end] =
                [agent.position_interval.middle(), agent.course.length()].map(|length| current.reached(place, length));
            (end - (at + agent.turned).min(now)).max(0.0)
        };
        self.agents.iter().enumerate().map(left).sum()
    }

    /// If all robots stand: a plan in which as many robots as possible begin their new missions while the others stay where they are.
    /// Otherwise the current plan with one new mission added.
    fn for_some(&self, now: f64, pending: &[bool]) -> Option<PlanCandidate> {
        let stands = self.agents.iter().all(RobotEstimate::stands);
        let together = |margin: usize| {
            let robots = self.states(margin, pending)?;
            let (plan, taken) = ReplanProblem { now, robots: &robots, obstacles: &self.obstacles }.most(pending)?;
            self.found(plan, self.offsets(&taken), &taken, margin)
        };
        if !stands {
            return [1, 0].into_iter().find_map(|margin| self.one_beside(now, pending, margin));
        }
        let barred = self.barred(pending, |_| true);
        let most = (0..pending.len()).filter(|&robot| pending[robot] && !barred[robot]).count();
        let count = |found: &PlanCandidate| found.taken.iter().filter(|taken| **taken).count();
        // With the smaller margin more robots may be able to go. If there is a plan already, the robots left out can go later.
        match together(1) {
            Some(found) if self.plan.is_some() || count(&found) >= most => Some(found),
            found => together(0).into_iter().chain(found).max_by_key(count),
        }
    }

    /// The current plan with the motion of one more robot added.
    fn one_beside(&self, now: f64, pending: &[bool], margin: usize) -> Option<PlanCandidate> {
        let current = self.plan.as_ref()?;
        let barred = self.barred(pending, |_| true);
        (0..pending.len()).filter(|&robot| pending[robot] && !barred[robot]).find_map(|robot| {
            let taken: Vec<bool> = (0..pending.len()).map(|other| other == robot).collect();
            let robots = self.states(margin, &taken)?;
            let problem = ReplanProblem { now, robots: &robots, obstacles: &self.obstacles };
            let mut plan = current.plan.clone();
            *plan.drives.get_mut(robot)? = problem.plan_one(robot, &current.plan.drives)?;
            let mut offsets = current.offsets.clone();
            *offsets.get_mut(robot)? = 0.0;
            self.found(plan, offsets, &taken, margin)
        })
    }

    /// For each robot with a new mission whether it cannot carry it out with any margin, because an obstacle, or a standing
    /// robot for which `stays` holds, is in its way.
    fn barred(&self, pending: &[bool], stays: impl Fn(usize) -> bool) -> Vec<bool> {
        let Some(robots) = self.states(0, pending) else { return vec![false; pending.len()] };
        let problem = ReplanProblem { now: 0.0, robots: &robots, obstacles: &self.obstacles };
        let stays = |other: usize| stays(other) && self.agents.get(other).is_some_and(RobotEstimate::stands);
        (0..pending.len()).map(|robot| pending[robot] && problem.in_the_way(robot, stays).is_some()).collect()
    }

    fn states(&self, margin: usize, taken: &[bool]) -> Option<Vec<RobotState>> {
        self.agents.iter().zip(taken).map(|(agent, &taken)| agent.state(margin, taken)).collect()
    }

    /// Length that each robot has travelled before a plan that is made now \[m\].
    fn offsets(&self, taken: &[bool]) -> Vec<f64> {
        self.agents.iter().zip(taken).map(|(agent, &taken)| agent.to_plan(taken).1.middle()).collect()
    }

    /// The plan with its passing orders, if every robot can still keep them.
    fn found(&self, plan: FleetMotionPlan, offsets: Vec<f64>, taken: &[bool], margin: usize) -> Option<PlanCandidate> {
        let robots = || self.agents.iter().zip(taken).map(|(agent, &taken)| (agent, agent.to_plan(taken)));
        let current = ActivePlan { plan, offsets };
        let places: Vec<Interval<f64>> = robots().map(|(_, (_, at, _))| at).collect();
        let courses: Vec<SpeedLimitedPath> = robots().map(|(_, (course, ..))| course.clone()).collect();
        let bodies = |margin: usize| self.agents.iter().map(|agent| agent.bodies[margin].clone()).collect();
        let mut guard = PrecedenceGuard::new(&courses, bodies(0)).ok()?;
        guard.take_orders(
            &places,
            |agent, length| current.reached(agent, length),
            |agent, time| current.length_at(agent, time),
        )?;
        let holds = guard.authorities(&places, |_| f64::INFINITY);
        let can_stop = robots().zip(holds).all(|((agent, (_, at, speed)), hold)| {
            let slower = (speed - agent.limits.acceleration * FRAME).max(0.0);
            at.hi + stopping_length(slower, agent.limits.acceleration, FRAME) <= hold
        });
        can_stop.then(|| PlanCandidate { current, guard, taken: taken.to_vec(), bodies: bodies(margin) })
    }

    fn take_up(&mut self, now: f64, found: PlanCandidate) {
        let PlanCandidate { current, guard, taken, bodies } = found;
        for (agent, _) in self.agents.iter_mut().zip(&taken).filter(|(_, taken)| **taken) {
            if let Some(next) = agent.next.take() {
                agent.course = next;
                agent.position_interval = Interval::new(0.0, 0.0);
                agent.speed = 0.0;
            }
        }
        self.guard = guard;
        self.still = 0.0;
        let (drives, offsets) = (current.plan.drives.clone(), current.offsets.clone());
        self.snapshots.push(PlanSnapshot { time: now, drives, offsets, bodies });
        self.plan = Some(current);
    }

    /// The command for a robot in the next frame.
    fn command(&mut self, place: usize, time: f64, hold: f64) -> MotionCommand {
        let (Some(agent), Some(current)) = (self.agents.get(place), &self.plan) else { return MotionCommand::Stay };
        if agent.next.is_some() {
            return MotionCommand::Stay;
        }
        let Limits { speed: top, acceleration } = agent.limits;
        let change = acceleration * FRAME;
        let late = current.length_at(place, time + FRAME) - agent.position_interval.middle();
        let catching_up = if late > 0.0 { speed_within(late, acceleration, FRAME) } else { late * FALLING_BACK };
        let wanted = (current.speed_at(place, time + FRAME) + catching_up).clamp(0.0, top);
        let slower = (agent.speed - change).max(0.0);
        let possible = wanted.clamp(slower, agent.speed + change);
        let allowed =
            if hold.is_finite() { speed_within(hold - agent.position_interval.hi, acceleration, FRAME) } else { top };
        if allowed < slower - 1e-9 {
            self.statistics.breaches += 1;
        }
        MotionCommand::Along(possible.min(allowed).max(slower))
    }
}

fn guard(robots: &[RobotTask], agents: &[RobotEstimate]) -> Result<PrecedenceGuard, ComputationError> {
    let courses: Vec<SpeedLimitedPath> = agents.iter().map(|agent| agent.course.clone()).collect();
    let bodies = agents.iter().map(|agent| agent.bodies[0].clone()).collect();
    PrecedenceGuard::new(&courses, bodies).map_err(|why| match why {
        GuardError::Agent(place) => ComputationError::Robot(robots[place].id),
        GuardError::Full(full) => ComputationError::Full(full),
    })
}

impl RobotController for PcrController {
    fn announce(&mut self, robot: usize, course: &SpeedLimitedPath, release: f64) {
        if let Some(agent) = self.agents.get_mut(robot) {
            (agent.next, agent.release) = (Some(course.clone()), release);
        }
    }

    fn assign(&mut self, robot: usize, course: &SpeedLimitedPath) {
        if let Some(agent) = self.agents.get_mut(robot) {
            // An announced mission is in the plan already, or a plan for it is being searched.
            if std::mem::take(&mut agent.release) <= 0.0 {
                agent.position_interval = Interval::new(agent.course.length(), agent.course.length());
                agent.next = Some(course.clone());
            }
        }
        self.next_plan = f64::NEG_INFINITY;
        // From now on there is something to do.
        self.still = 0.0;
    }

    fn commands(&mut self, frame: &ControlInput<'_>) -> Vec<MotionCommand> {
        self.observe(frame);
        if frame.time >= self.next_plan {
            self.replan(frame.time);
            self.next_plan = frame.time + self.period;
        }
        let places: Vec<Interval<f64>> = self.agents.iter().map(|agent| agent.position_interval).collect();
        let holds = self
            .guard
            .authorities(&places, |place| self.agents.get(place).map_or(f64::INFINITY, RobotEstimate::horizon));
        holds.iter().enumerate().map(|(place, &hold)| self.command(place, frame.time, hold)).collect()
    }

    fn is_stuck(&self) -> bool {
        self.still > 2.0 * self.period + RESTING
    }

    fn waiting(&self) -> Vec<BlockedRobot> {
        let places: Vec<Interval<f64>> = self.agents.iter().map(|agent| agent.position_interval).collect();
        let pending: Vec<bool> = self.agents.iter().map(|agent| agent.next.is_some()).collect();
        let robots = self.states(0, &pending).unwrap_or_default();
        let problem = ReplanProblem { now: 0.0, robots: &robots, obstacles: &self.obstacles };
        let waits = |(robot, agent): (usize, &RobotEstimate)| {
            if pending[robot] {
                let blocked_by = problem.in_the_way(robot, |_| true);
                let room = |by: Blocker| missing_clearance(&self.agents, &problem, (robot, by), self.errors.drift);
                return Some(BlockedRobot { robot, begun: false, blocked_by, clearance: blocked_by.and_then(room) });
            }
            let by = || self.guard.waits_for(robot, &places).map(Blocker::Robot);
            (agent.speed <= 0.0 && !agent.stands()).then(|| BlockedRobot {
                robot,
                begun: true,
                blocked_by: by(),
                clearance: None,
            })
        };
        self.agents.iter().enumerate().filter_map(waits).collect()
    }

    fn take_snapshots(&mut self) -> Vec<PlanSnapshot> {
        std::mem::take(&mut self.snapshots)
    }

    fn planning(&self) -> Option<&PlanningStatistics> {
        Some(self.statistics())
    }
}
