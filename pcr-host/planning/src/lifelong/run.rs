//! A run: missions, decisions, motion, and what comes of it.

use super::abilities::Abilities;
use super::book::Book;
use super::dispatch::{Admitted, Refused, Scene};
use super::ends::{Ends, WellFormedness};
use super::record::{Certificate, Window};
use super::robot::Robot;
use super::routes::{From, routes};
use super::site::Site;
use super::tasks::{Queue, Tasks};
use super::way::Way;
use super::{Method, Request};
use crate::random::Random;
use pcr_formats::import::Imported;
use serde::Serialize;
use std::time::{Duration, Instant};

/// Time between two controls \[s\].
const STEP: f64 = 0.1;

/// Between two tries for the same mission \[s\].
const AGAIN: f64 = 1.0;

/// A robot that stands in the way of a mission that has been refused for so long is asked to go elsewhere \[s\].
const PATIENCE: f64 = 2.0;

/// Whoever has been waiting for so long is looked for a better way \[s\], so often at most \[s\].
const REVIEW: [f64; 2] = [0.3, 2.0];

/// Decisions between two controls.
const TRIES: usize = 4;

/// Each so many controls what was done is certified.
const WINDOW: usize = 200;

/// The first part of the time, in which robots start from their ends, is not steady.
const START: f64 = 0.1;

/// Steps between two values of the slip.
const SLIPS: usize = 50;

/// How it went.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Outcome {
    /// How robots were kept apart.
    pub method: Method,
    /// Robots that found a place to start.
    pub robots: usize,
    /// Goals reached.
    pub missions: usize,
    /// The same an hour, after the first tenth of the time.
    pub missions_per_hour: f64,
    /// Mean of the times from when missions were given until goals were reached, over those of a robot alone; none without any.
    pub travel_over_unimpeded: Option<f64>,
    /// What the independent checker has found.
    pub certificate: Certificate,
    /// Controls at which a robot was beyond what its orders allow.
    pub breaches: usize,
    /// Robots that have not come to the end of their way long after the last mission: deadlocks.
    pub stuck: usize,
    /// Longest time for which nobody moved \[s\].
    pub standstill: f64,
    /// Tries for a mission that were refused; they are repeated.
    pub refused: usize,
    /// Robots that were asked to go elsewhere, as they stood in the way.
    pub moved: usize,
    /// Ways and orders that were exchanged for better ones.
    pub revised: usize,
    /// Longest time from when a mission was given until it was admitted \[s\].
    pub longest_wait: f64,
    /// The same of those that still wait in the end \[s\].
    pub waiting: f64,
    /// How many do so for longer than ten minutes.
    pub starved: usize,
}

/// A run with what was measured on the machine.
#[derive(Clone, Debug)]
pub struct Report {
    /// What is the same on every machine.
    pub outcome: Outcome,
    /// Of the layout.
    pub layout: WellFormedness,
    /// Time of each decision.
    pub decisions: Vec<Duration>,
    /// Time of all but the certificate.
    pub time: Duration,
    /// When the last goal was reached \[s\].
    pub last_arrival: f64,
}

impl Report {
    /// Time within which this part of the decisions was made \[s\].
    pub fn decided_within(&self, part: f64) -> f64 {
        let mut times = self.decisions.clone();
        times.sort_unstable();
        let place = (times.len() as f64 * part).ceil() as usize;
        times.get(place.saturating_sub(1)).map_or(0.0, Duration::as_secs_f64)
    }
}

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
    last_arrival: f64,
    /// Tasks that are not given yet, where not everybody has a mission of its own.
    tasks: Option<Queue>,
}

/// Runs a fleet on a layout.
///
/// # Errors
/// Where an edge is no path, or there is no room for anybody.
pub fn run(imported: &Imported, request: Request) -> Result<Report, String> {
    driven(Run::new(imported, request, None)?, imported, request)
}

/// Runs a fleet on a layout that has tasks to do, the robots that the tasks say; until all are done, or for the duration of the request.
/// Each task is given to the idle robot that is nearest, the oldest task first.
///
/// # Errors
/// As [`run`], and where a place is none of the layout.
pub fn run_tasks(imported: &Imported, request: Request, tasks: &Tasks) -> Result<Report, String> {
    driven(Run::new(imported, request, Some(tasks))?, imported, request)
}

fn driven(mut run: Run, imported: &Imported, request: Request) -> Result<Report, String> {
    let layout = run.ends.report(&run.site, &imported.layout);
    let mut certificate = Certificate::new();
    let mut window = Window::new(&run.site, &run.robots);
    let (mut still, mut time) = (0.0, Duration::ZERO);
    // Whoever has a way has come to its end by then.
    let rest = 1200.0;
    for tick in 0.. {
        let now = tick as f64 * STEP;
        let open = now < request.duration && run.has_work();
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
    Ok(Report { outcome: run.finished(), layout, decisions: run.decisions, time, last_arrival: run.last_arrival })
}

impl Run {
    fn new(imported: &Imported, request: Request, tasks: Option<&Tasks>) -> Result<Self, String> {
        let site = Site::new(imported)?;
        // Tests do without, as it takes a while where nothing is optimized.
        if !cfg!(debug_assertions) {
            site.warm();
        }
        let ends = Ends::of(&site, request.seed);
        let abilities = Abilities::of(&imported.vehicle);
        let starts = match tasks {
            Some(tasks) => tasks.starts(&site)?,
            None => starts(&site, &ends, request.agents, request.seed),
        };
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
        };
        Ok(Self {
            book: Book::new(&site, &robots),
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
            last_arrival: 0.0,
            tasks: tasks.map(Queue::of),
        })
    }

    /// Whether there are missions yet.
    fn has_work(&self) -> bool {
        self.tasks.as_ref().is_none_or(|tasks| !tasks.is_empty() || self.missions.iter().any(Option::is_some))
    }

    /// Gives tasks to those who have none, the nearest ones.
    fn assign(&mut self, mut tasks: Queue, now: f64) -> Queue {
        while let Some(goal) = tasks.due(now) {
            let at = self.site.points[goal];
            let away = |robot: usize| {
                let here = self.robots[robot].way.point(&self.site, self.robots[robot].at);
                (here[0] - at[0]).hypot(here[1] - at[1])
            };
            let idle = (0..self.robots.len()).filter(|&robot| self.missions[robot].is_none());
            let Some(robot) = idle.min_by(|&a, &b| away(a).total_cmp(&away(b))) else { break };
            let since = tasks.take();
            let it = &self.robots[robot];
            if it.has_arrived() && it.way.end() == goal {
                self.outcome.missions += 1;
                self.last_arrival = now;
                continue;
            }
            self.missions[robot] = Some(Mission { goal, since, alone: 0.0, admitted: false, next_try: now });
        }
        tasks
    }

    /// Gives a mission to everybody who has none.
    fn give(&mut self, now: f64) {
        if let Some(tasks) = self.tasks.take() {
            self.tasks = Some(self.assign(tasks, now));
            return;
        }
        for robot in 0..self.robots.len() {
            if self.missions[robot].is_some() {
                continue;
            }
            let it = &self.robots[robot];
            let place = self.site.atoms[it.way.atoms[it.way.atom(it.at)]].ends[1];
            let goal = goal(&self.site, &self.ends, self.request.seed, robot, self.given[robot], place);
            self.given[robot] += 1;
            let from = From { node: place, heading: None };
            let way = routes((&self.site, &self.abilities), from, |_| 0.0, |node| node == goal, Some(goal), 1);
            let alone = way.first().map_or(0.0, |atoms| {
                let way = Way::new(&self.site, place, atoms, None, &self.abilities);
                way.time(way.length()) + self.abilities.stop()
            });
            self.missions[robot] = Some(Mission { goal, since: now, alone, admitted: false, next_try: now });
        }
    }

    fn scene(&self, now: f64) -> Scene<'_> {
        Scene {
            site: &self.site,
            robots: &self.robots,
            book: &self.book,
            abilities: &self.abilities,
            ends: &self.ends.safe,
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
        let held = |robot: usize| {
            let it = &self.robots[robot];
            let waits = it.speed == 0.0 && !it.has_arrived() && now - it.still_since > REVIEW[0];
            waits && self.missions[robot].is_some_and(|it| it.admitted) && it.stopped_until <= now
        };
        let mut held: Vec<usize> =
            (0..self.robots.len()).filter(|&robot| held(robot) && now - self.reviewed[robot] > REVIEW[1]).collect();
        held.sort_by(|&a, &b| self.reviewed[a].total_cmp(&self.reviewed[b]));
        for robot in held.into_iter().take(TRIES.saturating_sub(tries)) {
            self.reviewed[robot] = now;
            self.review(robot, now);
        }
    }

    fn try_mission(&mut self, robot: usize, now: f64) {
        let Some(mission) = self.missions[robot] else { return };
        let begin = Instant::now();
        let found = self.scene(now).dispatch(robot, mission.goal);
        self.decisions.push(begin.elapsed());
        match found {
            Ok(admitted) => {
                self.take(robot, admitted);
                self.outcome.longest_wait = self.outcome.longest_wait.max(now - mission.since);
                self.missions[robot] = Some(Mission { admitted: true, ..mission });
            }
            Err(Refused { by }) => {
                self.outcome.refused += 1;
                self.missions[robot] = Some(Mission { next_try: now + AGAIN, ..mission });
                let Some(by) = by.filter(|&by| by != robot && now - mission.since > PATIENCE) else { return };
                if self.robots[by].has_arrived()
                    && let Some(admitted) = self.scene(now).make_way(by, robot, mission.goal)
                {
                    self.take(by, admitted);
                    self.outcome.moved += 1;
                }
            }
        }
    }

    /// Another way and other orders for a robot that waits on its way, if all are expected to arrive sooner.
    fn review(&mut self, robot: usize, now: f64) {
        /// So much sooner in all \[s\].
        const GAIN: f64 = 1.0;
        let Some(goal) = self.missions[robot].map(|mission| mission.goal) else { return };
        let begin = Instant::now();
        let found = self.scene(now).better(robot, goal, GAIN);
        self.decisions.push(begin.elapsed());
        if let Some(admitted) = found {
            self.take(robot, admitted);
            self.outcome.revised += 1;
        }
    }

    fn take(&mut self, robot: usize, admitted: Admitted) {
        let Admitted { way, before, regions, departs, .. } = admitted;
        let it = &mut self.robots[robot];
        self.site.covers(it.way.end()).iter().for_each(|&atom| self.parked[atom] -= 1);
        self.site.covers(way.end()).iter().for_each(|&atom| self.parked[atom] += 1);
        self.book.exchange(robot, &it.way, &way, regions);
        it.take(way, before);
        it.departs = departs;
    }

    /// Everybody goes on for a step.
    fn step(&mut self, tick: usize, now: f64, open: bool) {
        let far = |robot: usize| self.robots[robot].horizon(&self.abilities, STEP);
        let holds: Vec<f64> =
            (0..self.robots.len()).map(|robot| self.book.hold(robot, &self.robots, far(robot))).collect();
        for (robot, hold) in holds.into_iter().enumerate() {
            let it = &mut self.robots[robot];
            let stop = it.stop(&self.abilities);
            self.outcome.breaches += usize::from(stop > hold + 1e-9 && stop > it.at);
            disturb(it, robot, tick, now, open, &self.request);
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
        self.last_arrival = now;
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
        outcome.waiting = waits.iter().copied().fold(0.0, f64::max);
        outcome.starved = waits.iter().filter(|wait| **wait > 600.0).count();
        outcome.stuck = self.robots.iter().filter(|robot| !robot.has_arrived()).count();
        outcome.missions_per_hour = self.steady as f64 * 3600.0 / ((1.0 - START) * request.duration);
        outcome.travel_over_unimpeded = (self.travel.1 > 0.0).then(|| self.travel.0 / self.travel.1);
        outcome
    }
}

/// A robot is stopped, or slips, as it would be under any method.
fn disturb(robot: &mut Robot, number: usize, tick: usize, now: f64, open: bool, request: &Request) {
    let delays = request.delays;
    let mut random = Random(request.seed ^ (number as u64).wrapping_mul(0x9e37_79b9) ^ ((tick as u64) << 24));
    let rate = delays.stopped * STEP / delays.stop / (1.0 - delays.stopped);
    if open && robot.stopped_until <= now && random.unit() < rate {
        robot.stopped_until = now + 2.0 * delays.stop * random.unit();
    }
    if tick % SLIPS == number % SLIPS {
        robot.slip = delays.slip * random.unit();
    }
}

/// The goal of the mission of this number of a robot: another node than where it is, whatever anybody does.
fn goal(site: &Site, ends: &Ends, seed: u64, robot: usize, number: u64, place: usize) -> usize {
    let mut random = Random(seed.wrapping_mul(0x2545_f491).wrapping_add((robot as u64) << 32).wrapping_add(number));
    random.bits();
    loop {
        let goal = ends.nodes[random.below(ends.nodes.len())];
        if !site.collide(goal, place) {
            return goal;
        }
    }
}

/// Nodes apart from one another, safe ends first.
fn starts(site: &Site, ends: &Ends, count: usize, seed: u64) -> Vec<usize> {
    let mut random = Random(seed ^ 0x5741_5254);
    let mut starts: Vec<usize> = Vec::new();
    let mut taken = vec![false; site.atoms.len()];
    let mut nodes = random.shuffled(&ends.safe);
    nodes.extend(random.shuffled(&ends.nodes));
    if ends.nodes.len() < 2 {
        return starts;
    }
    for node in nodes {
        if starts.len() < count && !taken[site.standing(node)] {
            site.covers(node).iter().for_each(|&atom| taken[atom] = true);
            starts.push(node);
        }
    }
    starts
}
