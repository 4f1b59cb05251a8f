//! Forecasts whether all robots can finish under some orders, and about when: robots advance from gate to gate, each as
//! soon as the event that it waits for has happened. The robots that are left wait for ever.
//!
//! In a large fleet only robots that are affected by a change are advanced. The others keep to the timetable, which
//! shows that all can finish.

use super::abilities::Abilities;
use super::book::Region;
use super::gates::Timed;
use super::robot::{Robot, SHORT};
use super::timetable::{Timeline, Timetable};
use super::waits::{Wait, Waits, sort};
use super::way::Way;

/// What is looked at: the fleet, one of its robots on another way.
#[derive(Clone, Copy)]
pub(super) struct Trial<'t, 'w> {
    pub(super) robots: &'t [Robot],
    /// Without those of the robot that has another way.
    pub(super) waits: &'t Waits<'w>,
    pub(super) abilities: &'t Abilities,
    pub(super) time: f64,
    /// The robot, its way, where it is on it, when it sets off, and its regions.
    pub(super) changed: Option<(usize, &'t Way, f64, f64, &'t [Region])>,
    /// What goals before the last one of a way count.
    pub(super) earlier: f64,
    /// What the others keep to, and who is taken in any case; none: all are taken.
    pub(super) kept: Option<(&'t Timetable, &'t [usize])>,
}

/// When robots would be where.
#[derive(Clone, Debug, Default)]
pub(super) struct Forecast {
    /// Those that were taken.
    pub(super) robots: Vec<usize>,
    pub(super) lines: Vec<Timeline>,
    /// Sum of the times until goals are reached, and a little of those until all stand; by how much that is more than by the timetable,
    /// where others keep to it \[s\].
    pub(super) cost: f64,
}

/// A robot that waits for ever.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Stuck {
    /// Place of the region at which it does, among those of the robot that has another way.
    pub(super) region: Option<usize>,
}

/// Fleets of up to so many robots are taken whole.
pub(super) const WHOLE: usize = 64;

/// Robots of a larger one that are taken at most.
pub(super) const MOST: usize = 16;

/// How often others are added to them at most.
const ROUNDS: usize = 5;

/// In no set of robots.
const NONE: u32 = u32::MAX;

impl<'t, 'w: 't> Trial<'t, 'w> {
    fn way(&self, robot: usize) -> (&'t Way, f64) {
        match self.changed {
            Some((changed, way, at, ..)) if changed == robot => (way, at),
            _ => (&self.robots[robot].way, self.robots[robot].at),
        }
    }

    fn is_changed(&self, robot: usize) -> bool {
        self.changed.is_some_and(|changed| changed.0 == robot)
    }

    /// What a robot passes second.
    fn row(&self, robot: usize) -> Vec<Wait<'t>> {
        let known = self.waits.row(robot);
        let mut row: Vec<Wait<'t>> = known.to_vec();
        let regions = self.changed.iter().flat_map(|(.., regions)| regions.iter().enumerate());
        for (place, region) in regions.filter(|(_, region)| region.second() == robot) {
            row.extend(Wait::of(region, Some(place), region.robots.map(|robot| self.way(robot).1)));
        }
        if row.len() > known.len() {
            sort(&mut row);
        }
        row
    }

    /// When robots would be where, or those that would wait for ever; nobody in particular where too many would have to be taken.
    pub(super) fn forecast(&self) -> Result<Forecast, Vec<Stuck>> {
        let Some((timetable, some)) = self.kept else { return self.taken((0..self.robots.len()).collect()) };
        let mut taken = some.to_vec();
        for _ in 0..ROUNDS {
            let forecast = self.taken(std::mem::take(&mut taken))?;
            let late = self.delayed(timetable, &forecast);
            if late.is_empty() {
                return Ok(forecast);
            }
            taken = forecast.robots;
            taken.extend(late);
            if taken.len() > MOST {
                break;
            }
        }
        Err(Vec::new())
    }

    /// Who keeps to the timetable, but would have to wait longer for somebody who does not.
    fn delayed(&self, timetable: &Timetable, forecast: &Forecast) -> Vec<usize> {
        let mut is_known = vec![false; self.robots.len()];
        forecast.robots.iter().for_each(|&robot| is_known[robot] = true);
        let mut found = Vec::new();
        for (&robot, line) in forecast.robots.iter().zip(&forecast.lines) {
            let mut look = |region: &Region| {
                let second = region.second();
                if is_known[second] || region.robots[region.first] != robot {
                    return;
                }
                let at = region.robots.map(|robot| self.way(robot).1);
                if timetable.is_broken(region, line, self.time, at, self.way(second).0) {
                    is_known[second] = true;
                    found.push(second);
                }
            };
            match self.changed {
                Some((changed, .., regions)) if changed == robot => regions.iter().for_each(look),
                _ if line.is_later(&timetable.lines[robot]) => self.waits.regions(robot).for_each(&mut look),
                _ => {}
            }
        }
        found
    }

    /// Takes some robots from gate to gate.
    fn taken(&self, robots: Vec<usize>) -> Result<Forecast, Vec<Stuck>> {
        let mut places = vec![NONE; self.robots.len()];
        let mut taken: Vec<Taken<'t>> = Vec::with_capacity(robots.len());
        for (place, &robot) in robots.iter().enumerate() {
            places[robot] = place as u32;
            let changed =
                self.changed.filter(|changed| changed.0 == robot).map(|(_, way, at, departs, _)| (way, at, departs));
            let start = self.robots[robot].progress(changed, self.time, self.abilities);
            taken.push(Taken::new(Timeline::new(start, self.time), self.row(robot), self.way(robot).0.length()));
        }
        let mut waiting: Vec<Vec<usize>> = vec![Vec::new(); robots.len()];
        let mut open: Vec<usize> = (0..robots.len()).collect();
        let lost = self.abilities.stop();
        while let Some(place) = open.pop() {
            let before = taken[place].steps;
            while let Some((first, timed, is_left)) = taken[place].ahead() {
                let opens = match (places[first], self.kept) {
                    (NONE, Some((timetable, _))) => Some(timetable.lines[first].opens(timed, self.time)),
                    (first, _) => {
                        let first = &taken[first as usize];
                        let is_known = timed.gate.needs <= first.known();
                        is_known.then(|| first.line.from(timed.opens, timed.gate.needs, self.time))
                    }
                };
                match (opens, is_left) {
                    (Some(opens), false) => taken[place].wait(opens, lost),
                    (opens, true) => taken[place].meet(opens),
                    (None, false) => {
                        waiting[places[first] as usize].push(place);
                        break;
                    }
                }
            }
            if taken[place].steps > before {
                open.append(&mut waiting[place]);
            }
        }
        let stuck: Vec<Stuck> = taken.iter().filter_map(Taken::stuck).collect();
        if !stuck.is_empty() {
            return Err(stuck);
        }
        let lines: Vec<Timeline> = taken.into_iter().map(|taken| taken.line).collect();
        let cost = robots.iter().zip(&lines).map(|(&robot, line)| {
            let way = self.way(robot).0;
            let planned = match self.kept {
                Some((timetable, _)) if !self.is_changed(robot) => {
                    timetable.lines[robot].cost(way, self.time, self.earlier)
                }
                _ => 0.0,
            };
            line.cost(way, self.time, self.earlier) - planned
        });
        let cost = cost.sum();
        Ok(Forecast { robots, lines, cost })
    }
}

/// A robot that is taken from gate to gate.
struct Taken<'r> {
    line: Timeline,
    /// What it has still to pass second, the nearest last.
    regions: Vec<Wait<'r>>,
    /// Gates of regions that it may have to wait at, with who is first there and the place of the region, the nearest last.
    gates: Vec<(&'r Timed, usize, Option<usize>)>,
    length: f64,
    /// Gates and regions that it has passed.
    steps: usize,
}

impl<'r> Taken<'r> {
    fn new(line: Timeline, mut regions: Vec<Wait<'r>>, length: f64) -> Self {
        regions.reverse();
        Self { line, regions, gates: Vec::new(), length, steps: 0 }
    }

    /// Whether a region comes before the next gate.
    fn meets(&self) -> bool {
        let gate = self.gates.last().map_or(f64::INFINITY, |gate| gate.0.gate.at);
        self.regions.last().is_some_and(|wait| wait.gates[0].gate.at < gate)
    }

    /// What comes next: who is first there, and the gate; of a region the last one, which tells whether it has been left.
    fn ahead(&self) -> Option<(usize, &'r Timed, bool)> {
        if self.next() >= self.length {
            return None;
        }
        match (self.meets(), self.regions.last(), self.gates.last()) {
            (true, Some(wait), _) => Some((wait.first, wait.ends()[1], true)),
            (_, _, Some(&(timed, first, _))) => Some((first, timed, false)),
            _ => None,
        }
    }

    /// Length of what comes next.
    fn next(&self) -> f64 {
        let region = self.regions.last().map_or(f64::INFINITY, |wait| wait.gates[0].gate.at);
        self.gates.last().map_or(region, |gate| gate.0.gate.at.min(region))
    }

    /// Up to which length it is known when it is there.
    fn known(&self) -> f64 {
        let next = self.next();
        if next < self.length { next - 2.0 * SHORT } else { self.length }
    }

    /// Comes to a region that the first leaves then, if that is known: its gates count unless it has been left by then.
    fn meet(&mut self, left: Option<f64>) {
        let Some(wait) = self.regions.pop() else { return };
        self.steps += 1;
        if left.is_some_and(|left| self.line.comes(wait.ends()[0].comes) >= left) {
            return;
        }
        self.gates.extend(wait.gates.iter().rev().map(|timed| (timed, wait.first, wait.place)));
        self.gates.sort_by(|a, b| b.0.gate.at.total_cmp(&a.0.gate.at));
    }

    /// Passes a gate, which opens then.
    fn wait(&mut self, opens: f64, lost: f64) {
        if let Some((timed, ..)) = self.gates.pop() {
            self.steps += 1;
            self.line.wait(timed.gate.at, timed.comes, opens, lost);
        }
    }

    fn stuck(&self) -> Option<Stuck> {
        let (_, _, is_left) = self.ahead()?;
        self.gates.last().filter(|_| !is_left).map(|gate| Stuck { region: gate.2 })
    }
}
