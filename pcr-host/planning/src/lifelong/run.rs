//! A run: missions, decisions, motion, and what comes of it.

use super::abilities::Abilities;
use super::book::Book;
use super::dispatch::Admitted;
use super::draws::{self, STEP, disturb, starts};
use super::ends::Ends;
use super::locks::Locks;
use super::outcome::{Outcome, Report, Shares};
use super::record::{Certificate, Window};
use super::robot::Robot;
use super::routes::routes;
use super::scene::Scene;
use super::site::Site;
use super::way::Way;
use super::{Method, Request};
use pcr_formats::import::Imported;
use std::time::{Duration, Instant};

/// Between two tries for the same mission \[s\].
const AGAIN: f64 = 1.0;

/// A robot that stands in the way of a mission that has been refused for so long is asked to go elsewhere \[s\].
const PATIENCE: f64 = 2.0;

/// Whoever has been waiting for so long is looked for a better way \[s\], so often at most \[s\], and whoever does not wait so often.
const REVIEW: [f64; 3] = [0.3, 2.0, 5.0];

/// The way for the next mission is looked for so long before the goal \[s\].
const AHEAD: f64 = 10.0;

/// Robots that are asked to go elsewhere for one mission at a time.
const MOVES: usize = 4;

/// Decisions between two controls.
const TRIES: usize = 4;

/// Each so many controls what was done is certified.
const WINDOW: usize = 200;

/// The first part of the time, in which robots start from their ends, is not steady.
const START: f64 = 0.1;

/// A mission that a robot has.
#[derive(Clone, Copy, Debug)]
struct Mission {
    goal: usize,
    since: f64,
    /// Time that a robot alone would take \[s\].
    alone: f64,
    /// Whether it has a way.
    admitted: bool,
    next_try: f64,
}

struct Run {
    site: Site,
    ends: Ends,
    abilities: Abilities,
    request: Request,
    robots: Vec<Robot>,
    book: Book,
    locks: Locks,
    /// How many robots stand for good in the way of an atom.
    parked: Vec<u16>,
    missions: Vec<Option<Mission>>,
    /// Missions given to each robot.
    given: Vec<u64>,
    reviewed: Vec<f64>,
    outcome: Outcome,
    decisions: Vec<Duration>,
    travel: (f64, f64),
    steady: usize,
}

/// Runs a fleet on a layout.
///
/// # Errors
/// Where an edge is no path, or there is no room for anybody.
pub fn run(imported: &Imported, request: Request) -> Result<Report, String> {
    let mut run = Run::new(imported, request)?;
    let layout = run.ends.report(&run.site, &imported.layout);
    let mut certificate = Certificate::new();
    let mut window = Window::new(&run.site, &run.robots);
    let (mut still, mut time) = (0.0, Duration::ZERO);
    // Whoever has a way has come to its end by then.
    let rest = 1200.0;
    for tick in 0.. {
        let now = tick as f64 * STEP;
        let open = now < request.duration;
        let ended = now > request.duration + rest || (!open && run.robots.iter().all(Robot::has_arrived));
        if (tick > 0 && tick % WINDOW == 0) || ended {
            certificate.window(&run.site, &mut run.robots, &mut window, imported.vehicle.radius, now);
        }
        if ended {
            break;
        }
        let begin = Instant::now();
        if open {
            run.give(now);
            run.decide(now);
        }
        let before: f64 = run.robots.iter().map(|robot| robot.at).sum();
        run.step(tick, now, open);
        let moves = run.robots.iter().map(|robot| robot.at).sum::<f64>() > before;
        still = if moves || run.robots.iter().all(Robot::has_arrived) { 0.0 } else { still + STEP };
        run.outcome.standstill = f64::max(run.outcome.standstill, still);
        time += begin.elapsed();
    }
    run.outcome.certificate = certificate;
    Ok(Report { outcome: run.finished(), layout, decisions: run.decisions, time })
}

impl Run {
    fn new(imported: &Imported, request: Request) -> Result<Self, String> {
        let site = Site::new(imported)?;
        // Tests do without, as it takes a while where nothing is optimized.
        if !cfg!(debug_assertions) {
            site.warm();
        }
        let ends = Ends::of(&site, request.seed);
        let abilities = Abilities::of(&imported.vehicle);
        let starts = starts(&site, &ends, request.agents, request.seed);
        if starts.is_empty() {
            return Err("the layout has no two nodes that can be reached from one another".into());
        }
        let robots: Vec<Robot> = starts.iter().map(|&node| Robot::new(Way::standing(&site, node))).collect();
        let mut parked = vec![0; site.atoms.len()];
        starts.iter().for_each(|&node| site.covers(node).iter().for_each(|&atom| parked[atom] += 1));
        let count = robots.len();
        let outcome = Outcome {
            method: request.method,
            robots: count,
            missions: 0,
            missions_per_hour: 0.0,
            travel_over_unimpeded: None,
            certificate: Certificate::new(),
            breaches: 0,
            stuck: 0,
            standstill: 0.0,
            refused: 0,
            moved: 0,
            revised: 0,
            longest_wait: 0.0,
            waiting: 0.0,
            starved: 0,
            time: Shares::default(),
        };
        Ok(Self {
            book: Book::new(&site, &robots),
            locks: Locks::new(count),
            site,
            ends,
            abilities,
            request,
            robots,
            parked,
            missions: vec![None; count],
            given: vec![0; count],
            reviewed: vec![0.0; count],
            outcome,
            decisions: Vec::new(),
            travel: (0.0, 0.0),
            steady: 0,
        })
    }

    /// Gives a mission to everybody who has none.
    fn give(&mut self, now: f64) {
        for robot in 0..self.robots.len() {
            if self.missions[robot].is_some() {
                continue;
            }
            let it = &self.robots[robot];
            let from = it.way.kept(&self.site, it.at, it.at, it.turned).on;
            let place = from.node;
            let goal = draws::goal(&self.site, &self.ends, self.request.seed, robot, self.given[robot], place);
            self.given[robot] += 1;
            let way = routes((&self.site, &self.abilities), from, |_| 0.0, |node| node == goal, Some(goal), 1);
            let alone = way.first().map_or(0.0, |atoms| {
                let way = Way::new(&self.site, from, atoms, &[], &self.abilities);
                way.time(way.length()) + self.abilities.stop()
            });
            let admitted = !it.way.goals.is_empty();
            self.missions[robot] = Some(Mission { goal, since: now, alone, admitted, next_try: now });
        }
    }

    fn scene(&self, now: f64) -> Scene<'_> {
        Scene {
            site: &self.site,
            robots: &self.robots,
            book: &self.book,
            locks: &self.locks,
            abilities: &self.abilities,
            ends: &self.ends.safe,
            nodes: &self.ends.nodes,
            parked: &self.parked,
            time: now,
            method: self.request.method,
        }
    }

    /// Looks for ways for the missions that have waited longest, then for better ways for whoever waits on the way.
    fn decide(&mut self, now: f64) {
        let due = |mission: &Option<Mission>| mission.is_some_and(|it| !it.admitted && it.next_try <= now);
        let mut waiting: Vec<usize> = (0..self.robots.len()).filter(|&robot| due(&self.missions[robot])).collect();
        let since = |robot: usize| self.missions[robot].map_or(0.0, |mission| mission.since);
        waiting.sort_by(|&a, &b| since(a).total_cmp(&since(b)));
        let mut tries = 0;
        for robot in waiting.into_iter().take(TRIES) {
            tries += 1;
            self.try_mission(robot, now);
        }
        if self.request.method != Method::Orders {
            return;
        }
        for robot in 0..self.robots.len() {
            let Some(mission) = self.missions[robot].filter(|mission| mission.admitted && mission.next_try <= now)
            else {
                continue;
            };
            let it = &self.robots[robot];
            let [goal] = it.way.goals[..] else { continue };
            if tries >= TRIES || it.way.time(goal) - it.progress(None, now, &self.abilities) > AHEAD {
                continue;
            }
            tries += 1;
            let next = draws::goal(&self.site, &self.ends, self.request.seed, robot, self.given[robot], mission.goal);
            let begin = Instant::now();
            let found = self.scene(now).dispatch(robot, &[mission.goal, next]);
            self.decisions.push(begin.elapsed());
            match found {
                Ok(admitted) => self.take(robot, admitted),
                Err(_) => self.missions[robot] = Some(Mission { next_try: now + 2.0 * AGAIN, ..mission }),
            }
        }
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

    fn try_mission(&mut self, robot: usize, now: f64) {
        let Some(mission) = self.missions[robot] else { return };
        let begin = Instant::now();
        let found = self.scene(now).dispatch(robot, &[mission.goal]);
        self.decisions.push(begin.elapsed());
        match found {
            Ok(admitted) => {
                self.take(robot, admitted);
                self.outcome.longest_wait = self.outcome.longest_wait.max(now - mission.since);
                self.missions[robot] = Some(Mission { admitted: true, ..mission });
            }
            Err(_) => {
                self.outcome.refused += 1;
                self.missions[robot] = Some(Mission { next_try: now + AGAIN, ..mission });
                if now - mission.since > PATIENCE {
                    if let Some(route) = self.scene(now).wanted(robot, mission.goal) {
                        self.clear(robot, &[route], now, &mut MOVES.clone());
                    }
                }
            }
        }
    }

    /// Asks those who stand on the last of some routes to go where they are on none of them, and those who stand in their way likewise.
    fn clear(&mut self, robot: usize, routes: &[Vec<usize>], now: f64, tries: &mut usize) {
        let standing = self.scene(now).standing_on(robot, routes.last().map_or(&[], Vec::as_slice));
        for by in standing {
            if *tries == 0 || self.missions[by].is_some_and(|mission| mission.admitted) {
                continue;
            }
            *tries -= 1;
            let begin = Instant::now();
            let found = self.scene(now).make_way(by, routes);
            self.decisions.push(begin.elapsed());
            match found {
                Ok(admitted) => {
                    self.take(by, admitted);
                    self.outcome.moved += 1;
                }
                Err(Some(route)) if routes.len() < 6 => {
                    let mut routes = routes.to_vec();
                    routes.push(route);
                    self.clear(by, &routes, now, tries);
                }
                Err(_) => {}
            }
            // In the way of the others behind it.
            return;
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

    fn take(&mut self, robot: usize, admitted: Admitted) {
        let Admitted { way, kept, before, regions, departs, .. } = admitted;
        let it = &mut self.robots[robot];
        self.site.covers(it.way.end()).iter().for_each(|&atom| self.parked[atom] -= 1);
        self.site.covers(way.end()).iter().for_each(|&atom| self.parked[atom] += 1);
        self.book.exchange(robot, &it.way, &way, regions);
        self.locks.exchange(robot, kept);
        it.take(way, before);
        it.departs = departs;
    }

    /// Everybody goes on for a step.
    fn step(&mut self, tick: usize, now: f64, open: bool) {
        let far = |robot: usize| self.robots[robot].horizon(&self.abilities, STEP);
        if self.request.method == Method::EdgeLocks {
            self.locks.give(&self.site, &self.robots, far);
        }
        let hold = |robot: usize| match self.request.method {
            Method::EdgeLocks => self.locks.hold(robot, &self.robots[robot].way),
            _ => self.book.hold(robot, &self.robots, far(robot)),
        };
        let holds: Vec<f64> = (0..self.robots.len()).map(hold).collect();
        for (robot, hold) in holds.into_iter().enumerate() {
            let it = &mut self.robots[robot];
            let stop = it.stop(&self.abilities);
            self.outcome.breaches += usize::from(stop > hold + 1e-9 && stop > it.at);
            disturb(it, robot, tick, now, open, &self.request);
            if open {
                *share(&mut self.outcome.time, it, hold, now) += 1.0;
            }
            if it.drive(hold, now, STEP, &self.abilities) {
                self.arrived(robot, now + STEP);
            }
            if tick % 10 == robot % 10 {
                self.book.drop_over(robot, &self.robots);
            }
        }
    }

    fn arrived(&mut self, robot: usize, now: f64) {
        self.outcome.missions += 1;
        if now > START * self.request.duration && now <= self.request.duration {
            self.steady += 1;
        }
        if let Some(mission) = self.missions[robot].take() {
            self.travel.0 += now - mission.since;
            self.travel.1 += mission.alone;
        }
    }

    fn finished(&mut self) -> Outcome {
        let Self { request, .. } = *self;
        let waits = |mission: &Mission| if mission.admitted { 0.0 } else { request.duration - mission.since };
        let waits: Vec<f64> = self.missions.iter().flatten().map(waits).collect();
        let mut outcome = self.outcome.clone();
        outcome.time.norm();
        outcome.waiting = waits.iter().copied().fold(0.0, f64::max);
        outcome.starved = waits.iter().filter(|wait| **wait > 600.0).count();
        outcome.stuck = self.robots.iter().filter(|robot| !robot.has_arrived()).count();
        outcome.missions_per_hour = self.steady as f64 * 3600.0 / ((1.0 - START) * request.duration);
        outcome.travel_over_unimpeded = (self.travel.1 > 0.0).then(|| self.travel.0 / self.travel.1);
        outcome
    }
}

/// What a robot spends its time on now.
fn share<'s>(shares: &'s mut Shares, robot: &Robot, hold: f64, now: f64) -> &'s mut f64 {
    /// A robot so near its hold waits there \[m\].
    const NEAR: f64 = 0.01;
    if robot.stopped_until > now {
        &mut shares.stopped
    } else if robot.has_arrived() {
        &mut shares.idle
    } else if robot.turning > now {
        &mut shares.turning
    } else if robot.speed == 0.0 && hold - robot.at < NEAR {
        &mut shares.held
    } else if robot.way.goals.is_empty() {
        &mut shares.aside
    } else {
        &mut shares.driving
    }
}
