//! Moves robots up together where no whole route is admitted: each to the next node on its way, or out of the way of the
//! robot behind it, up to a free node or around a full round (docs/theory/joint.md).
//!
//! This is a fallback, for as long as whole routes are refused. Missions are tried in the order of their age. A robot only
//! moves along edges from which a way leads back that does not turn round on them, so that it can make way again.

use super::forecast::{Forecast, ForecastInput};
use super::joint_phase::rounds;
use super::region_table::{RegionTable, RouteRegion};
use super::region_waits::FleetWaits;
use super::robot::LifelongRobot;
use super::robot_mission::RobotMission;
use super::route::{CommittedRoute, Route};
use super::route_graph::DeparturePose;
use super::run_state::LifelongState;
use super::scheduling::{AGAIN, TRIES};
use super::starvation::ROUNDS;
use super::stretch::Stretch;
use std::time::{Duration, Instant};

/// Robots are moved up together if all of them have stood at their ends for the first time while missions wait, or if nobody has
/// had a goal on its way for the second \[s\].
const QUIET: [f64; 2] = [3.0, 6.0];

/// A robot gets more way when less than this is left besides its stopping way \[m\].
const LOOK: f64 = 1.5;

/// First time for which robots are moved up together; it is doubled each time if whole routes do not go on for longer than
/// the second, or twice the time before, and is the first again otherwise \[s\].
const PERIOD: f64 = 60.0;
const SOON: f64 = 300.0;

/// Robots with more way, and the orders of the whole fleet with it.
pub(super) struct JointAdmission {
    robots: Vec<LifelongRobot>,
    book: RegionTable,
    forecast: Forecast,
    /// For each robot of the batch the number of atoms that are kept from the way before.
    kept: Vec<usize>,
}

impl LifelongState {
    /// Moves robots up together, if whole routes have been refused for some time. Returns whether it does that at present.
    pub(super) fn moves_up(&mut self, now: f64) -> bool {
        let has_goal = self.missions.iter().flatten().any(|mission| mission.admitted);
        self.joint.idle_since = if has_goal { None } else { self.joint.idle_since.or(Some(now)) };
        let is_joint = now < self.joint.until && self.quiet <= QUIET[0];
        if is_joint {
            self.advance_together(now);
            self.try_whole_routes(now);
            return true;
        }
        let idle = self.joint.idle_since.map_or(0.0, |since| now - since);
        if (self.quiet <= QUIET[0] && idle <= QUIET[1]) || now < self.joint.next_try {
            return false;
        }
        self.joint.next_try = now + AGAIN;
        if self.joint.is_round.is_empty() {
            self.joint.is_round = rounds(&self.site);
            self.joint.again = vec![0.0; self.robots.len()];
        }
        self.joint.again.fill(0.0);
        if self.advance_together(now) == 0 {
            return false;
        }
        let is_soon = now < self.joint.until + SOON.max(2.0 * self.joint.period);
        self.joint.period = if is_soon { 2.0 * self.joint.period.max(0.5 * PERIOD) } else { PERIOD };
        self.joint.until = now + self.joint.period;
        self.reserved.clear();
        true
    }

    /// The robots whose missions wait, the oldest first.
    pub(super) fn waiting(&self) -> Vec<usize> {
        let since = |robot: usize| self.missions[robot].map_or(f64::INFINITY, |mission| mission.rank);
        let is_waiting = |robot: &usize| self.missions[*robot].is_some_and(|mission| !mission.admitted);
        let mut waiting: Vec<usize> = (0..self.robots.len()).filter(is_waiting).collect();
        waiting.sort_by(|&a, &b| since(a).total_cmp(&since(b)));
        // Only the oldest, if it was overtaken often enough.
        let passed = waiting.first().and_then(|&oldest| self.missions[oldest]).map_or(0, |mission| mission.passed);
        if passed >= ROUNDS * self.robots.len() {
            waiting.truncate(1);
        }
        waiting
    }

    /// Tries whole routes for robots that come no nearer to their goals where a way leads back.
    fn try_whole_routes(&mut self, now: f64) {
        let is_moved = vec![false; self.robots.len()];
        let due = |robot: &usize| {
            let is_due = self.missions[*robot].is_some_and(|mission| mission.next_try <= now);
            is_due && self.needs_way(*robot) && Push::new(self, &is_moved, *robot, now).candidates(*robot).is_empty()
        };
        let waiting: Vec<usize> = self.waiting().into_iter().filter(due).take(TRIES).collect();
        for robot in waiting {
            if !self.is_begun(robot, now) {
                self.outcome.refused += 1;
                if let Some(mission) = &mut self.missions[robot] {
                    (mission.next_try, mission.prepared) = (now + AGAIN, Duration::ZERO);
                }
            }
        }
    }

    /// Gives more way to robots that need it, and to those in their way. Returns the number of robots.
    fn advance_together(&mut self, now: f64) -> usize {
        let mut is_moved = vec![false; self.robots.len()];
        for robot in self.waiting() {
            if is_moved[robot] || self.joint.again[robot] > now || !self.needs_way(robot) {
                continue;
            }
            let begin = Instant::now();
            let batch = Push::of(self, &is_moved, robot, now);
            let found = batch.as_ref().and_then(|batch| self.admit_together(batch, now));
            if batch.is_some() {
                self.decisions.push(begin.elapsed());
            }
            match (batch, found) {
                (Some(batch), Some(found)) => {
                    batch.iter().for_each(|stretch| is_moved[stretch.robot] = true);
                    self.take_together(&batch, found, now);
                }
                (Some(_), None) => self.joint.again[robot] = now + AGAIN,
                (None, _) => {}
            }
        }
        is_moved.into_iter().filter(|&is_moved| is_moved).count()
    }

    /// Whether a robot has no goal on its way and soon comes to the end of it.
    fn needs_way(&self, robot: usize) -> bool {
        let it = &self.robots[robot];
        it.cut.is_none() && it.way.goals.is_empty() && it.way.length() - it.stop() <= LOOK
    }

    /// The whole present way of a robot, from where it is.
    fn whole(&self, robot: usize) -> CommittedRoute {
        let it = &self.robots[robot];
        it.way.committed_part(&self.site, it.at, it.way.length(), it.turned)
    }

    /// The fleet with more way for some robots, if everybody can still finish.
    pub(super) fn admit_together(&self, batch: &[Stretch], now: f64) -> Option<JointAdmission> {
        let (mut robots, mut book, mut kept_atoms) = (self.robots.clone(), self.book.clone(), Vec::new());
        for Stretch { robot, atoms } in batch {
            let kept = self.whole(*robot);
            let atoms: Vec<usize> = kept.atoms.iter().chain(atoms).copied().collect();
            let goal = self.missions[*robot].map(|mission| mission.goal);
            let is_there = atoms.last().is_some_and(|&last| Some(self.site.atoms[last].ends[1]) == goal);
            let goals = if is_there { vec![atoms.len()] } else { Vec::new() };
            let way = Route::new(&self.site, kept.from, &atoms, &goals, &robots[*robot].abilities);
            book.exchange(*robot, &robots[*robot].way, &way, Vec::new());
            robots[*robot].take(way, kept.before);
            robots[*robot].departs = now;
            kept_atoms.push(kept.atoms.len());
        }
        // By time of arrival; or the robots that were there before first.
        [true, false]
            .into_iter()
            .find_map(|by_time| {
                let mut book = book.clone();
                for (place, Stretch { robot, .. }) in batch.iter().enumerate() {
                    let it = &robots[*robot];
                    let mut regions = book.regions(&self.site, &robots, *robot, &it.way, it.at);
                    let is_earlier = |other: usize| batch[..place].iter().any(|earlier| earlier.robot == other);
                    regions.retain(|region| !is_earlier(region.robots[1]));
                    for region in &mut regions {
                        region.first = self.first(region, &robots, by_time)?;
                    }
                    book.add(regions);
                }
                let waits = &FleetWaits::of(&robots, &book);
                let earlier = self.scene(now).earlier();
                let trial = ForecastInput { robots: &robots, waits, time: now, changed: None, earlier, kept: None };
                trial.forecast().ok().map(|forecast| (book, forecast))
            })
            .map(|(book, forecast)| JointAdmission { robots, book, forecast, kept: kept_atoms })
    }

    /// Which of the two robots of a region goes first; `None` if neither can.
    fn first(&self, region: &RouteRegion, robots: &[LifelongRobot], by_time: bool) -> Option<usize> {
        let two = region.robots.map(|robot| &robots[robot]);
        let at = two.map(|it| it.at);
        let stop = two.map(|it| it.stop());
        let lengths = two.map(|it| it.way.length());
        match [0, 1].map(|first| region.can_be_first(first, at, stop, lengths)) {
            [true, true] => {
                let comes = |side: usize| two[side].way.time(region.hull[side].lo) - two[side].way.time(at[side]);
                Some(usize::from(!by_time || comes(1) <= comes(0)))
            }
            [true, false] => Some(0),
            [false, true] => Some(1),
            [false, false] => None,
        }
    }

    pub(super) fn take_together(&mut self, batch: &[Stretch], found: JointAdmission, now: f64) {
        let JointAdmission { robots, book, forecast, kept } = found;
        for (Stretch { robot, .. }, kept) in batch.iter().zip(kept) {
            let end = robots[*robot].way.end();
            self.end_covers(*robot).iter().for_each(|&atom| self.parked[atom] -= 1);
            self.site.covers(end).iter().for_each(|&atom| self.parked[atom] += 1);
            self.locks.exchange(*robot, kept);
        }
        (self.robots, self.book) = (robots, book);
        if self.is_large() {
            self.timetable.change(forecast.robots.into_iter().zip(forecast.lines).collect());
        }
        self.outcome.moved += batch.len() - 1;
        for Stretch { robot, .. } in batch {
            let Some(mission) = self.missions[*robot] else { continue };
            if !mission.admitted && !self.robots[*robot].way.goals.is_empty() {
                self.outcome.longest_wait = self.outcome.longest_wait.max(now - mission.assigned_at);
                self.missions[*robot] = Some(RobotMission { admitted: true, prepared: Duration::ZERO, ..mission });
                self.pass(mission.rank);
            }
        }
    }
}

/// A search for robots that make way for one another.
struct Push<'s> {
    state: &'s LifelongState,
    now: f64,
    /// The robot with the oldest mission, for which it is made.
    root: usize,
    /// Robots that were asked, or must not be.
    is_asked: Vec<bool>,
    /// For each robot the atoms of its new stretch.
    moves: Vec<Option<usize>>,
    /// The robots with a new stretch, in the order in which they were asked.
    asked: Vec<usize>,
}

impl<'s> Push<'s> {
    fn new(state: &'s LifelongState, is_moved: &[bool], root: usize, now: f64) -> Self {
        let (is_asked, moves) = (is_moved.to_vec(), vec![None; is_moved.len()]);
        Self { state, now, root, is_asked, moves, asked: Vec::new() }
    }

    /// More way for a robot towards its goal, and for all robots that have to make way for it.
    fn of(state: &'s LifelongState, is_moved: &[bool], root: usize, now: f64) -> Option<Vec<Stretch>> {
        let mut push = Self::new(state, is_moved, root, now);
        push.advances(root).then(|| {
            let moves = push.asked.iter().filter_map(|&robot| Some((robot, push.moves[robot]?)));
            // Whoever makes way goes first.
            moves.rev().map(|(robot, atom)| Stretch { robot, atoms: vec![atom] }).collect()
        })
    }

    /// Finds a stretch for a robot and all that are in its way. Each robot is asked once.
    fn advances(&mut self, robot: usize) -> bool {
        self.is_asked[robot] = true;
        for atom in self.candidates(robot) {
            let (moves, asked) = (self.moves.clone(), self.asked.len());
            if self.goes(robot, atom) {
                return true;
            }
            self.moves = moves;
            self.asked.truncate(asked);
        }
        false
    }

    /// The atoms on which a robot may go on, the best for its own mission first. The robot for which all others make way only goes
    /// nearer to its goal.
    fn candidates(&self, robot: usize) -> Vec<usize> {
        let LifelongState { site, network, missions, joint, robots, world, .. } = self.state;
        let pose = self.state.whole(robot).end_pose;
        let times = missions[robot].map(|mission| network.times(site, mission.goal));
        // A robot without a mission goes anywhere.
        let left = |from: DeparturePose| times.as_ref().map_or(0.0, |times| times(from));
        let here = left(pose);
        let cost = |atom: usize| {
            let it = &site.atoms[atom];
            let heading = it.headings.map(|headings| headings[1]).or(pose.heading);
            (left(DeparturePose { node: it.ends[1], heading }), it.length / it.speed)
        };
        if robots[robot].cut.is_some() {
            return Vec::new();
        }
        let open = site.leaving[pose.node].iter().filter(|&&atom| joint.is_round[atom] && world.closed[atom] == 0);
        let mut found: Vec<(f64, f64, usize)> = open.map(|&atom| (cost(atom).0, cost(atom).1, atom)).collect();
        if robot == self.root {
            found.retain(|it| it.0 < here);
        }
        found.sort_by(|a, b| (a.0 + a.1).total_cmp(&(b.0 + b.1)));
        found.into_iter().map(|it| it.2).collect()
    }

    /// Lets a robot go on along an atom, if all robots in its way can make way.
    fn goes(&mut self, robot: usize, atom: usize) -> bool {
        let LifelongState { site, robots, .. } = self.state;
        let [from, target] = site.atoms[atom].ends;
        // Two robots cannot change places, nor come to the same one.
        let excludes = |[other, end]: [usize; 2]| (end, other) == (from, target) || site.collide(end, target);
        let mut others = self.moves.iter().enumerate().filter(|(other, _)| *other != robot);
        if others.any(|(_, moved)| moved.is_some_and(|moved| excludes(site.atoms[moved].ends))) {
            return false;
        }
        self.moves[robot] = Some(atom);
        self.asked.push(robot);
        for (other, it) in robots.iter().enumerate() {
            let is_in_the_way = other != robot && it.ends_on(site, atom);
            if !is_in_the_way || self.moves[other].is_some() {
                continue;
            }
            if self.is_asked[other] || !self.makes_way(other) || !self.advances(other) {
                return false;
            }
        }
        true
    }

    /// Whether a robot may be asked to make way: it has no goal on its way any more, and no older mission.
    fn makes_way(&self, robot: usize) -> bool {
        let LifelongState { robots, missions, .. } = self.state;
        let since = |robot: usize| missions[robot].map_or(f64::INFINITY, |mission| mission.rank);
        !self.state.is_fixed(robot, self.now) && robots[robot].way.goals.is_empty() && since(self.root) <= since(robot)
    }
}
