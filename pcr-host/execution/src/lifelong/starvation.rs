//! Missions are tried in the order of their age, and robots in the way of the mission that has waited longest are sent elsewhere.

use super::CoordinationMethod;
use super::planning_context::PlanningContext;
use super::robot_mission::RobotMission;
use super::route_admission::AdmittedRoute;
use super::run_state::LifelongState;
use super::scheduling::{AGAIN, TRIES};
use std::time::{Duration, Instant};

/// If a mission has been refused for this long, robots in its way are asked to go elsewhere \[s\].
const PATIENCE: f64 = 2.0;

/// A mission overtaken by this many missions per robot is the only one that is admitted, apart from those of robots in its way.
pub(super) const ROUNDS: usize = 4;

/// Largest number of robots that are asked to go elsewhere for one mission at a time.
const MOVES: usize = 4;

impl LifelongState {
    /// Tries the missions that have waited longest, and returns the number of missions tried.
    pub(super) fn try_missions(&mut self, now: f64) -> usize {
        let mut waiting: Vec<(f64, usize)> = Vec::new();
        for (robot, mission) in self.missions.iter().enumerate() {
            waiting.extend(mission.filter(|mission| !mission.admitted).map(|mission| (mission.rank, robot)));
        }
        waiting.sort_by(|a, b| a.0.total_cmp(&b.0));
        let active = self.robots.len() - waiting.len();
        let oldest = waiting.first().map(|first| first.1);
        if self.reserved.first().is_some_and(|route| Some(route.0) != oldest) {
            self.reserved.clear();
        }
        let passed = oldest.and_then(|oldest| self.missions[oldest]).map_or(0, |mission| mission.passed);
        // Methods for comparison are not slowed down by it where they need not be.
        let keeps_turns = self.crowded || self.request.method == CoordinationMethod::Orders;
        self.is_urgent = keeps_turns && passed >= ROUNDS * self.robots.len();
        if self.is_urgent {
            waiting.truncate(1);
        } else if self.crowded && active >= self.most_active() {
            waiting.clear();
        }
        if self.crowded {
            self.tidy(now);
        }
        let is_due = |robot: usize| self.missions[robot].is_some_and(|mission| mission.next_try <= now);
        waiting.retain(|&(_, robot)| is_due(robot));
        waiting.truncate(TRIES);
        for &(_, robot) in &waiting {
            self.try_mission(robot, now, oldest == Some(robot));
        }
        waiting.len()
    }

    /// Largest number of robots that drive at a time if there are more robots than safe ends: the number of safe ends, or a third of the
    /// nodes if there are less than an eighth as many safe ends as robots. At least one.
    fn most_active(&self) -> usize {
        let safe = self.ends.capacity;
        let few = 8 * safe < self.robots.len();
        if few { (self.site.points.len() / 3).max(1) } else { safe }
    }

    /// Sends idle robots elsewhere if they cut off nodes where they stand.
    fn tidy(&mut self, now: f64) {
        /// Decisions between two control steps.
        const TRIES: usize = 2;
        /// Time between two attempts for the same robot \[s\].
        const AGAIN: f64 = 2.0;
        let idle = |robot: &usize| {
            !self.is_fixed(*robot, now)
                && self.robots[*robot].has_arrived()
                && self.missions[*robot].is_none_or(|it| !it.admitted)
                && now - self.reviewed[*robot] > AGAIN
                && self.ends.harm(&self.site)[self.robots[*robot].way.end()] > 0
        };
        let mut idle: Vec<usize> = (0..self.robots.len()).filter(idle).collect();
        idle.sort_by(|&a, &b| self.reviewed[a].total_cmp(&self.reviewed[b]));
        for robot in idle.into_iter().take(TRIES) {
            self.reviewed[robot] = now;
            let begin = Instant::now();
            let found = self.scene(now).tidied(robot);
            self.decisions.push(begin.elapsed());
            if let Some(admitted) = found {
                self.take(robot, admitted);
                self.outcome.moved += 1;
            }
        }
    }

    /// Tries the mission of a robot. If it is refused, the robots in its way are asked to go elsewhere.
    fn try_mission(&mut self, robot: usize, now: f64, is_oldest: bool) {
        let Some(mission) = self.missions[robot] else { return };
        if self.is_begun(robot, now) {
            return;
        }
        self.outcome.refused += 1;
        self.missions[robot] = Some(RobotMission { next_try: now + AGAIN, prepared: Duration::ZERO, ..mission });
        if now - mission.assigned_at <= PATIENCE || (self.crowded && !is_oldest) || !self.robots[robot].has_arrived() {
            return;
        }
        // The wanted route of the oldest mission stays reserved until it is admitted, so robots that have made way do not come back.
        if !is_oldest {
            self.reserved.clear();
        }
        if self.reserved.is_empty() {
            let wanted = self.scene(now).wanted(robot, mission.goal);
            self.reserved.extend(wanted.map(|route| (robot, route)));
        }
        self.clear(now);
        if !is_oldest {
            self.reserved.clear();
        }
    }

    /// Begins the mission of a robot, if it is admitted.
    pub(super) fn is_begun(&mut self, robot: usize, now: f64) -> bool {
        let Some(mission) = self.missions[robot].filter(|mission| !mission.admitted) else { return false };
        let begin = Instant::now();
        let found = self.scene(now).dispatch(robot, &[mission.goal]);
        self.decisions.push(mission.prepared + begin.elapsed());
        let Some(admitted) = found else { return false };
        self.take(robot, admitted);
        self.outcome.longest_wait = self.outcome.longest_wait.max(now - mission.assigned_at);
        self.missions[robot] = Some(RobotMission { admitted: true, prepared: Duration::ZERO, ..mission });
        self.pass(mission.rank);
        true
    }

    /// Counts a mission of this rank as having overtaken all older missions that wait.
    pub(super) fn pass(&mut self, rank: f64) {
        for other in self.missions.iter_mut().flatten() {
            other.passed += usize::from(!other.admitted && other.rank < rank);
            self.outcome.overtaken = self.outcome.overtaken.max(other.passed);
        }
    }

    /// Robots that stand on reserved routes go on with their own missions, or elsewhere. If none of them can, the route of one of them is
    /// reserved as well.
    fn clear(&mut self, now: f64) {
        /// Largest number of routes that are reserved at a time, each for a robot in the way of the one before.
        const DEEP: usize = 6;
        let (mut moved, mut blocked, mut level, mut is_new) = (0, None, self.reserved.len(), false);
        while level > 0 {
            level -= 1;
            let Some((robot, route)) = self.reserved.get(level) else { continue };
            let standing = self.scene(now).standing_on(*robot, route);
            // The route is clear, but its robot did not go: other robots may have come to where it was to stand.
            if standing.is_empty() && level > 0 {
                self.reserved.truncate(level);
            }
            // Both orders, because a robot behind another one can only go after that one.
            for by in standing.iter().chain(standing.iter().rev()).copied() {
                if moved >= MOVES {
                    return;
                }
                if self.is_fixed(by, now)
                    || self.missions[by].is_some_and(|mission| mission.admitted)
                    || !self.scene(now).is_on_reserved(by)
                {
                    continue;
                }
                if self.is_begun(by, now) {
                    moved += 1;
                    continue;
                }
                let begin = Instant::now();
                let found = self.scene(now).make_way(by).or_else(|route| self.make_some_way(by, now).ok_or(route));
                self.decisions.push(begin.elapsed());
                match found {
                    Ok(admitted) => {
                        self.take(by, admitted);
                        self.outcome.moved += 1;
                        moved += 1;
                    }
                    Err(route) => blocked = blocked.or(route.map(|route| (by, route))),
                }
            }
            if level == 0
                && moved == 0
                && !is_new
                && self.reserved.len() < DEEP
                && let Some(next) = blocked.take().filter(|next| self.reserved.iter().all(|route| route.0 != next.0))
            {
                self.reserved.push(next);
                is_new = true;
                level = self.reserved.len();
            }
        }
    }

    /// A way for a robot where all places are on routes that are reserved: to one that is neither on that of the oldest mission nor on that
    /// of whoever has to go first for it. The routes between these are found anew when they are next.
    fn make_some_way(&self, by: usize, now: f64) -> Option<AdmittedRoute> {
        let [first, _, .., last] = &self.reserved[..] else { return None };
        let ends = [first.clone(), last.clone()];
        let scene = PlanningContext { reserved: &ends, ..self.scene(now) };
        if scene.is_on_reserved(by) { scene.make_way(by).ok() } else { None }
    }
}
