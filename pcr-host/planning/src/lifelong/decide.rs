//! Which robot looks for a way at what time: missions that have waited longest, next missions of robots that will soon
//! reach their goals, and better ways for robots that wait.

use super::Method;
use super::draws;
use super::forecast::Trial;
use super::state::{Mission, Run};
use super::waits::Waits;
use std::time::Instant;

/// Between two tries for the same mission \[s\].
pub(super) const AGAIN: f64 = 1.0;

/// Whoever has been waiting for so long is looked for a better way \[s\], so often at most \[s\], and whoever does not wait so often.
const REVIEW: [f64; 3] = [0.3, 2.0, 5.0];

/// Decisions between two controls.
pub(super) const TRIES: usize = 4;

impl Run {
    /// Looks for ways for the missions that have waited longest, then for better ways for whoever waits on the way.
    pub(super) fn decide(&mut self, now: f64) {
        let mut tries = self.try_missions(now);
        if self.request.method != Method::Orders {
            return;
        }
        // Who does the next task is settled when somebody is idle.
        if self.tasks.is_none() && !self.is_urgent {
            self.look_ahead(now, &mut tries);
        }
        self.switch(now);
        self.look_again(now, tries);
    }

    /// Turns orders round for those who wait in a large fleet: that costs less than another way, and in a small one everybody is looked for
    /// another way often enough.
    fn switch(&mut self, now: f64) {
        /// Between two tries for the same robot \[s\].
        const AGAIN: f64 = 1.0;
        /// So much sooner in all \[s\].
        const GAIN: f64 = 1.0;
        /// Tries between two controls.
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
            // The waits of the fleet are found once for all tries, and again after orders were turned round.
            let (mut tried, scene) = (Vec::new(), self.scene(now));
            let waits = &Waits::of(scene.robots, scene.book);
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
                self.book.settle(&switched.firsts);
                self.timetable.change(switched.lines);
            }
        }
    }

    /// After the last mission: better ways and orders for those who are still on their ways.
    pub(super) fn finish(&mut self, tick: usize, now: f64) {
        /// Then all go on as they are, and come to their ends \[s\].
        const FINISH: f64 = 600.0;
        if self.request.method == Method::Orders && now < self.request.duration + FINISH {
            self.refresh(tick, now);
            self.switch(now);
            self.look_again(now, 0);
        }
    }

    /// Looks for ways on to the next goals of those who soon are at their goals.
    fn look_ahead(&mut self, now: f64, tries: &mut usize) {
        let ahead = self.scene(now).ahead();
        for robot in 0..self.robots.len() {
            let Some(mission) = self.missions[robot].filter(|mission| mission.admitted && mission.next_try <= now)
            else {
                continue;
            };
            let it = &self.robots[robot];
            let [goal] = it.way.goals[..] else { continue };
            if *tries >= TRIES || it.way.time(goal) - it.progress(None, now, &self.abilities) > ahead {
                continue;
            }
            *tries += 1;
            let next = draws::goal(&self.site, &self.ends, self.request.seed, robot, self.given[robot], mission.goal);
            let begin = Instant::now();
            let found = self.scene(now).dispatch(robot, &[mission.goal, next]);
            self.decisions.push(begin.elapsed());
            match found {
                Some(admitted) => {
                    self.take(robot, admitted);
                    self.pass(now);
                }
                None => self.missions[robot] = Some(Mission { next_try: now + 2.0 * AGAIN, ..mission }),
            }
        }
    }

    /// Looks for better ways for those who wait, and now and then for the others.
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

    /// Brings the timetable of a large fleet up to date, some robots at a time: it holds without that, but would be later and later.
    pub(super) fn refresh(&mut self, tick: usize, now: f64) {
        /// Controls in which everybody's turn comes.
        const ROUND: usize = 50;
        if !self.is_large() {
            return;
        }
        let earlier = self.scene(now).earlier();
        let Self { robots, abilities, book, timetable, .. } = self;
        let waits = &Waits::of(robots, book);
        for robot in (tick % ROUND..robots.len()).step_by(ROUND) {
            if robots[robot].has_arrived() {
                continue;
            }
            let kept = Some((&*timetable, &[robot][..]));
            let trial = Trial { robots, waits, abilities, time: now, changed: None, earlier, kept };
            if let Ok(forecast) = trial.forecast() {
                let lines = forecast.robots.into_iter().zip(forecast.lines).collect();
                timetable.change(lines);
            }
        }
    }

    /// Another way and other orders for a robot that waits on its way, if all are expected to arrive sooner.
    fn review(&mut self, robot: usize, now: f64) {
        /// So much sooner in all \[s\].
        const GAIN: f64 = 1.0;
        let Some(goal) = self.missions[robot].map(|mission| mission.goal) else { return };
        let mut goals = vec![goal];
        if self.robots[robot].way.goals.len() > 1 {
            goals.push(draws::goal(&self.site, &self.ends, self.request.seed, robot, self.given[robot], goal));
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
