//! Plans for robots in motion: each one continues from where it is, at its present speed, and waits at most once.
//!
//! Robots are planned one after the other in an order of priority; each one avoids the motions of those before it and
//! standing robots. If a robot can go through without a wait, it does. Otherwise it stops, waits, and continues from
//! rest: as early as it can brake, or just before one of the regions on its way; [`earliest_start`] gives the time that
//! it has to wait there. The place with the earliest arrival is used.

use super::speed_limited_path::{OwnedMotion, SpeedLimitedPath};
use pcr_core::{Encounter, Limits, Motion, earliest_start};
use pcr_planning::fleet::{ConvexBody, HostEcm, build_ecm_of};
use pcr_planning::plan::start_delays;
use serde::Serialize;

/// Distance along its path that a robot keeps from a region before which it waits \[m\].
const BEFORE: f64 = 1e-4;

/// Number of robots for which an order of priority is tried in which that robot comes first.
const FIRST: usize = 8;

/// If this many orders of priority have no plan, the others usually have none.
const FAILED: usize = 2;

/// With more robots than this, orders of priority are not tried, and plans are not improved on the way: both take long, and the
/// passing orders are kept without them.
pub(super) const SEARCHED: usize = 15;

/// A robot as it is now.
#[derive(Clone, Debug)]
pub(super) struct RobotState {
    /// The rest of its path.
    pub(super) rest: SpeedLimitedPath,
    /// \[m/s\]
    pub(super) speed: f64,
    pub(super) limits: Limits<f64>,
    /// Earliest start of the first mission, if the robot has not begun it \[s\]; otherwise 0.
    pub(super) release: f64,
    /// Its body with its margin.
    pub(super) body: ConvexBody,
}

/// A motion of every robot.
#[derive(Clone, Debug)]
pub(super) struct FleetMotionPlan {
    pub(super) drives: Vec<OwnedMotion>,
    /// The robots by priority.
    pub(super) order: Vec<usize>,
    /// Sum of the times until arrival \[s\].
    pub(super) cost: f64,
}

/// What stands in the way of a robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Blocker {
    /// Index in the list of robots.
    Robot(usize),
    /// Index in the list of obstacles.
    Obstacle(usize),
}

/// The room between a robot's way and one that stands beside it, beyond the bodies with their own margins.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ClearanceEntry {
    /// What there is \[m\].
    pub free: f64,
    /// What the two need, because they may be off their paths \[m\].
    pub needed: f64,
    /// The largest drift (`--drift`) with which that is enough \[m\]; none if even without any drift it is not.
    pub drift: Option<f64>,
}

/// A robot that stands with a mission that is not done.
#[derive(Clone, Copy, Debug)]
pub(super) struct BlockedRobot {
    pub(super) robot: usize,
    /// Whether it has begun the mission.
    pub(super) begun: bool,
    /// The robot or obstacle for which it waits.
    pub(super) blocked_by: Option<Blocker>,
    /// The room that is missing there, if room for errors is all that keeps it from its beginning.
    pub(super) clearance: Option<ClearanceEntry>,
}

/// The input of a plan.
#[derive(Debug)]
pub(super) struct ReplanProblem<'a> {
    /// Present time \[s\].
    pub(super) now: f64,
    pub(super) robots: &'a [RobotState],
    /// Obstacles, which never move, with their margins.
    pub(super) obstacles: &'a [(OwnedMotion, ConvexBody)],
}

impl ReplanProblem<'_> {
    /// A plan by start delays, without waits on the way. `None` unless all robots stand.
    pub(super) fn delayed(&self) -> Option<FleetMotionPlan> {
        if self.robots.iter().any(|robot| robot.speed > 0.0) {
            return None;
        }
        let through = self.all_through()?;
        let motions = self.motions(&through)?;
        let mut standing = self.standing()?;
        let goes = |motion: &&Motion<'_, f64>| motion.path().length() > 0.0;
        standing.extend(motions.iter().filter(|motion| !goes(motion)));
        let going: Vec<Motion<'_, f64>> = motions.iter().filter(goes).copied().collect();
        if !going.iter().all(|motion| is_clear(motion, &standing)) {
            return None;
        }
        let alone: Vec<Vec<usize>> = (0..going.len()).map(|robot| vec![robot]).collect();
        let mut found = start_delays(&going, &alone)?.into_iter();
        let mut delay = |motion: &Motion<'_, f64>| if goes(&motion) { found.next().flatten() } else { Some(0.0) };
        let delays = motions.iter().map(|motion| delay(motion).map(Some)).collect::<Option<Vec<_>>>()?;
        self.later(&motions, &delays)
    }

    /// Robots with these start delays \[s\]; those without one stay where they are.
    fn later(&self, motions: &[Motion<'_, f64>], delays: &[Option<f64>]) -> Option<FleetMotionPlan> {
        let drive = |(robot, delay): (&RobotState, &Option<f64>)| match delay {
            Some(delay) => ReplanProblem { now: self.begin(robot) + delay, ..*self }.through(robot),
            None => self.staying(robot),
        };
        let drives: Vec<OwnedMotion> = self.robots.iter().zip(delays).map(drive).collect::<Option<_>>()?;
        let costs = delays.iter().zip(motions).map(|(delay, motion)| Some(motion.time().hi + (*delay)? - self.now));
        let cost = costs.flatten().sum();
        let mut order: Vec<usize> = (0..delays.len()).collect();
        order.sort_by(|&a, &b| delays[a].unwrap_or(0.0).total_cmp(&delays[b].unwrap_or(0.0)));
        Some(FleetMotionPlan { drives, order, cost })
    }

    /// A plan by start delays for robots that all stand: as many as possible of the `wanted` robots go, the others stay where they are.
    /// Also returns which robots go. A robot whose path leads past one that stays has to stay as well.
    pub(super) fn most(&self, wanted: &[bool]) -> Option<(FleetMotionPlan, Vec<bool>)> {
        let through = self.all_through()?;
        let motions = self.motions(&through)?;
        let stays: Vec<OwnedMotion> = self.robots.iter().map(|robot| self.staying(robot)).collect::<Option<_>>()?;
        let stays = self.motions(&stays)?;
        let standing = self.standing()?;
        let robots = 0..wanted.len();
        let passes = |robot: usize, other: usize| {
            robot != other && wanted[robot] && !is_clear(&motions[robot], std::slice::from_ref(&stays[other]))
        };
        // For each robot, the wanted robots whose path leads past it.
        let past: Vec<Vec<usize>> =
            robots.clone().map(|other| robots.clone().filter(|&robot| passes(robot, other)).collect()).collect();
        let with: Vec<Vec<usize>> = robots.clone().map(|robot| reached(robot, &past)).collect();
        let mut goes = vec![true; wanted.len()];
        let stay = |robot: &usize| !wanted[*robot] || !is_clear(&motions[*robot], &standing);
        robots.clone().filter(stay).flat_map(|robot| &with[robot]).for_each(|&robot| goes[robot] = false);
        let going: Vec<usize> = robots.filter(|&robot| goes[robot]).collect();
        let places = |with: &Vec<usize>| with.iter().filter_map(|robot| going.binary_search(robot).ok()).collect();
        let with: Vec<Vec<usize>> = going.iter().map(|&robot| places(&with[robot])).collect();
        let delays = start_delays(&going.iter().map(|&robot| motions[robot]).collect::<Vec<_>>(), &with)?;
        let mut found = vec![None; wanted.len()];
        going.iter().zip(&delays).for_each(|(&robot, delay)| found[robot] = *delay);
        let goes: Vec<bool> = found.iter().map(Option::is_some).collect();
        Some((self.later(&motions, &found)?, goes)).filter(|(_, goes)| goes.contains(&true))
    }

    /// The motion of one robot among others that go on as they are planned.
    pub(super) fn plan_one(&self, robot: usize, drives: &[OwnedMotion]) -> Option<OwnedMotion> {
        let mut others: Vec<Motion<'_, f64>> = self.standing()?;
        let planned = self.motions(drives)?.into_iter().enumerate();
        others.extend(planned.filter(|(other, _)| *other != robot).map(|(_, motion)| motion));
        self.best(self.robots.get(robot)?, &others)
    }

    /// When a robot goes on \[s\].
    fn begin(&self, robot: &RobotState) -> f64 {
        self.now.max(robot.release)
    }

    fn all_through(&self) -> Option<Vec<OwnedMotion>> {
        self.robots.iter().map(|robot| self.through(robot)).collect()
    }

    /// A robot that stays where it is.
    fn staying(&self, robot: &RobotState) -> Option<OwnedMotion> {
        OwnedMotion::standing(robot.rest.beginning(), self.now)
    }

    fn motions<'d>(&'d self, drives: &'d [OwnedMotion]) -> Option<Vec<Motion<'d, f64>>> {
        drives.iter().zip(self.robots).map(|(drive, robot)| drive.motion_of(&robot.body)).collect()
    }

    fn standing(&self) -> Option<Vec<Motion<'_, f64>>> {
        self.obstacles.iter().map(|(drive, body)| drive.motion_of(body)).collect()
    }

    /// What stands in the way of a robot under all plans: a robot for which `stay` holds, or else an obstacle.
    pub(super) fn in_the_way(&self, robot: usize, stay: impl Fn(usize) -> bool) -> Option<Blocker> {
        let through = self.through(self.robots.get(robot)?)?;
        let motion = through.motion_of(&self.robots.get(robot)?.body)?;
        let meets = |other: &Motion<'_, f64>| !is_clear(&motion, std::slice::from_ref(other));
        let others = (0..self.robots.len()).filter(|&other| other != robot && stay(other));
        let stands = |other: &usize| {
            let stays = self.robots.get(*other).and_then(|it| Some((self.staying(it)?, &it.body)));
            stays.is_some_and(|(drive, body)| drive.motion_of(body).is_some_and(|motion| meets(&motion)))
        };
        others
            .into_iter()
            .find(stands)
            .map(Blocker::Robot)
            .or_else(|| self.standing()?.iter().position(meets).map(Blocker::Obstacle))
    }

    /// Plans by several orders of priority, the best one first.
    pub(super) fn by_priority(&self, last_order: &[usize]) -> Vec<FleetMotionPlan> {
        let alone = |robot: &RobotState| self.through(robot).and_then(|drive| Some(drive.motion(1.0)?.time().length()));
        let times: Vec<f64> = self.robots.iter().map(|robot| alone(robot).unwrap_or(0.0)).collect();
        let least: f64 = times.iter().sum();
        let mut plans: Vec<FleetMotionPlan> = Vec::new();
        for (tried, order) in self.orders(&times, last_order).into_iter().enumerate() {
            let is_best = plans.last().is_some_and(|plan| plan.cost <= least * (1.0 + 1e-12));
            if is_best || (plans.is_empty() && tried == FAILED) {
                break;
            }
            plans.extend(self.plan(order));
        }
        plans.sort_by(|a, b| a.cost.total_cmp(&b.cost));
        plans
    }

    /// The order of the last plan, those who have least or most before them first, and the first few of them first once.
    fn orders(&self, times: &[f64], last: &[usize]) -> Vec<Vec<usize>> {
        let mut rising: Vec<usize> = (0..times.len()).collect();
        rising.sort_by(|&a, &b| times[a].total_cmp(&times[b]));
        let falling: Vec<usize> = rising.iter().rev().copied().collect();
        let mut orders = vec![last.to_vec(), rising.clone(), falling];
        orders.extend(rising.iter().take(FIRST).map(|&robot| first(&rising, robot)));
        let mut different: Vec<Vec<usize>> = Vec::new();
        for order in orders {
            if order.len() == times.len() && !different.contains(&order) {
                different.push(order);
            }
        }
        different
    }

    /// The plan for an order of priority; a robot for which there is no motion is moved to the front, once each.
    pub(super) fn plan(&self, mut order: Vec<usize>) -> Option<FleetMotionPlan> {
        for _ in 0..=order.len() {
            match self.plan_in_order(&order) {
                Ok(drives) => {
                    let end = |drive: &OwnedMotion| drive.motion(1.0).map_or(0.0, |motion| motion.time().hi);
                    let cost = drives.iter().map(|drive| end(drive) - self.now).sum();
                    return Some(FleetMotionPlan { drives, order, cost });
                }
                Err(robot) if order.first() == Some(&robot) => return None,
                Err(robot) => order = first(&order, robot),
            }
        }
        None
    }

    /// A motion for each robot, or the first robot for which there is none.
    fn plan_in_order(&self, order: &[usize]) -> Result<Vec<OwnedMotion>, usize> {
        let mut drives: Vec<Option<OwnedMotion>> = vec![None; self.robots.len()];
        for &place in order {
            let robot = self.robots.get(place).ok_or(place)?;
            let planned =
                drives.iter().zip(self.robots).filter_map(|(drive, robot)| Some((drive.as_ref()?, &robot.body)));
            let standing = self.obstacles.iter().map(|(drive, body)| (drive, body));
            let others = planned.chain(standing).map(|(drive, body)| drive.motion_of(body));
            let others: Vec<Motion<'_, f64>> = others.collect::<Option<_>>().ok_or(place)?;
            let drive = self.best(robot, &others).ok_or(place)?;
            drives[place] = Some(drive);
        }
        drives.into_iter().enumerate().map(|(place, drive)| drive.ok_or(place)).collect()
    }

    /// The motion without any wait.
    fn through(&self, robot: &RobotState) -> Option<OwnedMotion> {
        let (length, speed) = (robot.rest.length(), speed_that_stops(robot));
        if length <= 0.0 {
            return OwnedMotion::standing(robot.rest.clone(), self.now);
        }
        OwnedMotion::new(
            robot.rest.clone(),
            speed,
            &robot.rest.to_rest(speed, length, robot.limits)?,
            self.begin(robot),
        )
    }

    /// The motion that arrives first among those considered.
    fn best(&self, robot: &RobotState, others: &[Motion<'_, f64>]) -> Option<OwnedMotion> {
        let through = self.through(robot)?;
        let motion = through.motion_of(&robot.body)?;
        if is_clear(&motion, others) {
            return Some(through);
        }
        let brakes = speed_that_stops(robot).powi(2) / (2.0 * robot.limits.acceleration);
        let (fleet, ecm) = row(motion, others)?;
        let entries = ecm.row(&fleet, 0).expect("the table of the fleet").map(|region| region.length().lo - BEFORE);
        let mut stops: Vec<f64> = entries.filter(|&length| length > brakes).chain([brakes]).collect();
        stops.sort_by(f64::total_cmp);
        stops.dedup();
        let drives = stops.into_iter().filter_map(|stop| self.with_stop(robot, stop, others));
        let end = |drive: &OwnedMotion| drive.motion(1.0).map_or(f64::INFINITY, |motion| motion.time().hi);
        drives.min_by(|a, b| end(a).total_cmp(&end(b)))
    }

    /// The motion that stops at a length \[m\] for as long as it has to.
    fn with_stop(&self, robot: &RobotState, stop: f64, others: &[Motion<'_, f64>]) -> Option<OwnedMotion> {
        let length = robot.rest.length();
        let speed = speed_that_stops(robot);
        if stop >= length {
            return None;
        }
        let mut pieces = robot.rest.to_rest(speed, stop, robot.limits)?;
        let stops_at = self.begin(robot) + pieces.iter().map(|(duration, _)| duration).sum::<f64>();
        let onward = robot.rest.from(stop).ok()?;
        let further = onward.to_rest(0.0, onward.length(), robot.limits)?;
        let onward = OwnedMotion::new(onward, 0.0, &further, stops_at)?;
        let (fleet, ecm) = row(onward.motion_of(&robot.body)?, others)?;
        let wait = earliest_start(ecm.row(&fleet, 0).expect("the table of the fleet"), 0.0)?;
        pieces.push((wait, 0.0));
        pieces.extend(further);
        pieces.retain(|(duration, _)| *duration > 0.0);
        let drive = OwnedMotion::new(robot.rest.clone(), speed, &pieces, self.begin(robot))?;
        let clear = is_clear(&drive.motion_of(&robot.body)?, others);
        clear.then_some(drive)
    }
}

/// Its speed, as far as it can keep to the rest of its path, and stop at the end.
fn speed_that_stops(robot: &RobotState) -> f64 {
    robot.speed.min(robot.rest.most(robot.limits))
}

/// The order with this robot moved to its front.
fn first(order: &[usize], robot: usize) -> Vec<usize> {
    let others = order.iter().copied().filter(|&other| other != robot);
    [robot].into_iter().chain(others).collect()
}

/// A robot, and all that are reached from it step by step.
fn reached(robot: usize, steps: &[Vec<usize>]) -> Vec<usize> {
    let mut reached = vec![robot];
    let mut next = 0;
    while let Some(&robot) = reached.get(next) {
        let more: Vec<usize> = steps[robot].iter().copied().filter(|other| !reached.contains(other)).collect();
        reached.extend(more);
        next += 1;
    }
    reached
}

fn is_clear(motion: &Motion<'_, f64>, others: &[Motion<'_, f64>]) -> bool {
    others.iter().all(|other| {
        let encounter = Encounter::new(motion, other);
        encounter.contacts(encounter.time()).next().is_none()
    })
}

/// The regions of a motion with others, of which it is the first.
fn row<'a>(motion: Motion<'a, f64>, others: &[Motion<'a, f64>]) -> Option<(Vec<Motion<'a, f64>>, HostEcm<f64>)> {
    let fleet: Vec<Motion<'a, f64>> = [motion].into_iter().chain(others.iter().copied()).collect();
    let ecm = build_ecm_of(&fleet, 0).ok()?;
    Some((fleet, ecm))
}
