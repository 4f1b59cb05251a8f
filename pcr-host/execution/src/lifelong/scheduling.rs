//! Chooses the robots that look for a way in a control step: missions that have waited longest, next missions of robots near
//! their goals, and better ways for robots that wait.

use super::CoordinationMethod;
use super::forecast::ForecastInput;
use super::region_waits::FleetWaits;
use super::robot_mission::RobotMission;
use super::run_state::LifelongState;
use std::time::Instant;

/// Time between two attempts for the same mission \[s\].
pub(super) const AGAIN: f64 = 1.0;

/// A better way is searched for a robot that has waited for longer than the first value, at most once in the time of the second; for
/// other robots once in that of the third \[s\].
const REVIEW: [f64; 3] = [0.3, 2.0, 5.0];

/// Largest number of decisions between two control steps.
pub(super) const TRIES: usize = 4;

impl LifelongState {
    /// Searches ways for the missions that have waited longest, then better ways for robots that wait on the way.
    pub(super) fn decide(&mut self, now: f64) {
        if self.shunts(now) {
            return;
        }
        // Robots that share their tasks are sent for others instead.
        if self.request.method == CoordinationMethod::Orders && self.tasks.is_none() && self.moves_up(now) {
            self.look_again(now, 0);
            return;
        }
        let mut tries = self.try_missions(now);
        if self.request.method != CoordinationMethod::Orders {
            return;
        }
        // The next task of a robot is assigned when it has none.
        if self.tasks.is_none() && !self.is_urgent {
            self.look_ahead(now, &mut tries);
        }
        self.switch(now);
        self.look_again(now, tries);
    }

    /// Reverses orders for robots of a large fleet that wait: that costs less than another way. In a small fleet another way is
    /// searched often enough.
    fn switch(&mut self, now: f64) {
        /// Time between two attempts for the same robot \[s\].
        const AGAIN: f64 = 1.0;
        /// Time that has to be gained in all \[s\].
        const GAIN: f64 = 1.0;
        /// Largest number of attempts between two control steps.
        const MOST: usize = 16;
        if !self.is_large() {
            return;
        }
        let due = |robot: &usize| {
            let it = &self.robots[*robot];
            let waits = it.speed == 0.0 && !it.has_arrived() && now - it.still_since > REVIEW[0];
            waits && it.stopped_until <= now && it.turning <= now && now - self.switched[*robot] > AGAIN
        };
        let mut due: Vec<usize> = (0..self.robots.len()).filter(due).collect();
        due.sort_by(|&a, &b| self.switched[a].total_cmp(&self.switched[b]));
        let mut due = due.into_iter().take(MOST).peekable();
        while due.peek().is_some() {
            // The waits of the fleet are computed once for all attempts, and again after orders were reversed.
            let (mut tried, scene) = (Vec::new(), self.scene(now));
            let waits = &FleetWaits::of(scene.robots, scene.book);
            let found = due.by_ref().find_map(|robot| {
                let begin = Instant::now();
                let found = scene.switched(robot, waits, GAIN);
                tried.push((robot, begin.elapsed()));
                found
            });
            for (robot, time) in tried {
                self.switched[robot] = now;
                self.decisions.push(time);
            }
            if let Some(switched) = found {
                self.outcome.revised += 1;
                self.book.set_precedences(&switched.firsts);
                self.timetable.change(switched.lines);
            }
        }
    }

    /// After the last mission: searches better ways and orders for robots that are still on their ways.
    pub(super) fn finish(&mut self, tick: usize, now: f64) {
        /// After this time all robots go on without changes, so that they come to their ends \[s\].
        const FINISH: f64 = 600.0;
        if self.request.method == CoordinationMethod::Orders && now < self.request.duration + FINISH {
            self.refresh(tick, now);
            self.switch(now);
            self.look_again(now, 0);
        }
    }

    /// Searches ways to the next goals for robots that will soon be at their goals.
    fn look_ahead(&mut self, now: f64, tries: &mut usize) {
        let ahead = self.scene(now).ahead();
        for robot in 0..self.robots.len() {
            let Some(mission) = self.missions[robot].filter(|mission| mission.admitted && mission.next_try <= now)
            else {
                continue;
            };
            let it = &self.robots[robot];
            let [goal] = it.way.goals[..] else { continue };
            if *tries >= TRIES || it.way.time(goal) - it.progress(None, now) > ahead {
                continue;
            }
            let Some(next) = self.next_goal(robot, mission.goal) else { continue };
            *tries += 1;
            let begin = Instant::now();
            let found = self.scene(now).dispatch(robot, &[mission.goal, next]);
            self.decisions.push(begin.elapsed());
            match found {
                Some(admitted) => {
                    self.take(robot, admitted);
                    self.pass(now);
                }
                None => self.missions[robot] = Some(RobotMission { next_try: now + 2.0 * AGAIN, ..mission }),
            }
        }
    }

    /// Searches better ways for robots that wait, and from time to time for the others.
    fn look_again(&mut self, now: f64, mut tries: usize) {
        let held = |robot: usize| {
            let it = &self.robots[robot];
            let waits = it.speed == 0.0 && !it.has_arrived() && now - it.still_since > REVIEW[0];
            waits && self.missions[robot].is_some_and(|it| it.admitted) && it.stopped_until <= now
        };
        let mut held: Vec<usize> =
            (0..self.robots.len()).filter(|&robot| held(robot) && now - self.reviewed[robot] > REVIEW[1]).collect();
        held.sort_by(|&a, &b| self.reviewed[a].total_cmp(&self.reviewed[b]));
        for robot in held.into_iter().take(TRIES.saturating_sub(tries)) {
            tries += 1;
            self.reviewed[robot] = now;
            self.review(robot, now);
        }
        if tries < TRIES {
            let due = |robot: &usize| {
                !self.robots[*robot].has_arrived()
                    && self.missions[*robot].is_some_and(|it| it.admitted)
                    && now - self.reviewed[*robot] > REVIEW[2]
            };
            let next =
                (0..self.robots.len()).filter(due).min_by(|&a, &b| self.reviewed[a].total_cmp(&self.reviewed[b]));
            if let Some(robot) = next {
                self.reviewed[robot] = now;
                self.review(robot, now);
            }
        }
    }

    /// Updates the timetable of a large fleet, some robots at a time. It stays valid without that, but its times would be later
    /// and later.
    pub(super) fn refresh(&mut self, tick: usize, now: f64) {
        /// Number of control steps in which all robots are updated.
        const ROUND: usize = 50;
        if !self.is_large() {
            return;
        }
        let earlier = self.scene(now).earlier();
        let Self { robots, book, timetable, .. } = self;
        let waits = &FleetWaits::of(robots, book);
        for robot in (tick % ROUND..robots.len()).step_by(ROUND) {
            if robots[robot].has_arrived() {
                continue;
            }
            let kept = Some((&*timetable, &[robot][..]));
            let trial = ForecastInput { robots, waits, time: now, changed: None, earlier, kept };
            if let Ok(forecast) = trial.forecast() {
                let lines = forecast.robots.into_iter().zip(forecast.lines).collect();
                timetable.change(lines);
            }
        }
    }

    /// Searches another way and other orders for a robot that waits on its way, with which all together are expected to arrive sooner.
    pub(super) fn review(&mut self, robot: usize, now: f64) {
        /// Time that has to be gained in all \[s\].
        const GAIN: f64 = 1.0;
        let Some(goal) = self.missions[robot].map(|mission| mission.goal) else { return };
        let mut goals = vec![goal];
        if self.robots[robot].way.goals.len() > 1 {
            goals.extend(self.next_goal(robot, goal));
        }
        let begin = Instant::now();
        let found = self.scene(now).better(robot, &goals, GAIN);
        self.decisions.push(begin.elapsed());
        if let Some(admitted) = found {
            self.take(robot, admitted);
            self.outcome.revised += 1;
        }
    }
}
