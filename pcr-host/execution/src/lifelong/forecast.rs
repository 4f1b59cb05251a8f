//! Forecasts whether all robots can finish under some orders, and about when: robots advance from gate to gate, each as
//! soon as the event that it waits for has happened. The robots that are left wait for ever.
//!
//! In a large fleet only robots that are affected by a change are advanced. The others keep to the timetable, which
//! shows that all can finish.

use super::gates::TimedGate;
use super::region_table::RouteRegion;
use super::region_waits::{FleetWaits, RegionWait, sort};
use super::robot::{LifelongRobot, SHORT};
use super::route::Route;
use super::timetable::{Timeline, Timetable};
use std::borrow::Cow;

/// The input of a forecast: the fleet, with one of its robots on another way.
#[derive(Clone, Copy)]
pub(super) struct ForecastInput<'t, 'w> {
    pub(super) robots: &'t [LifelongRobot],
    /// The waits of the fleet; those of the changed robot are ignored.
    pub(super) waits: &'t FleetWaits<'w>,
    pub(super) time: f64,
    /// The changed robot: index, new way, place on it \[m\], time at which it sets off, and its new regions.
    pub(super) changed: Option<(usize, &'t Route, f64, f64, &'t [RouteRegion])>,
    /// Weight of the goals of a way before the last one.
    pub(super) earlier: f64,
    /// The timetable that the other robots keep, and the robots that are advanced in any case; `None`: all robots are advanced.
    pub(super) kept: Option<(&'t Timetable, &'t [usize])>,
}

/// Expected times of the robots.
#[derive(Clone, Debug, Default)]
pub(super) struct Forecast {
    /// The robots that were advanced.
    pub(super) robots: Vec<usize>,
    pub(super) lines: Vec<Timeline>,
    /// Weighted sum of the times until robots reach their goals and ends; if the others keep a timetable, the increase over the
    /// timetable \[s\].
    pub(super) cost: f64,
}

/// A robot that waits for ever.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct DeadlockedRobot {
    pub(super) robot: usize,
    /// Index of the region at which it waits, among those of the changed robot.
    pub(super) region: Option<usize>,
}

/// Largest fleet in which all robots are advanced.
pub(super) const WHOLE: usize = 64;

/// Largest number of robots of a larger fleet that are advanced.
pub(super) const MOST: usize = 16;

/// Largest number of times that further robots are added to these.
const ROUNDS: usize = 5;

/// Marks a robot that is not among them.
const NONE: u32 = u32::MAX;

impl<'t, 'w: 't> ForecastInput<'t, 'w> {
    fn way(&self, robot: usize) -> (&'t Route, f64) {
        match self.changed {
            Some((changed, way, at, ..)) if changed == robot => (way, at),
            _ => (&self.robots[robot].way, self.robots[robot].at),
        }
    }

    fn is_changed(&self, robot: usize) -> bool {
        self.changed.is_some_and(|changed| changed.0 == robot)
    }

    /// The regions that a robot passes second.
    fn row(&self, robot: usize) -> Cow<'t, [RegionWait<'t>]> {
        let known: &'t [RegionWait<'t>] = self.waits.row(robot);
        let Some((changed, .., regions)) = self.changed else { return known.into() };
        let is_changed = robot == changed;
        let is_kept = |wait: &&RegionWait<'_>| !is_changed && wait.first != changed;
        let mut own = regions.iter().enumerate().filter(|(_, region)| region.second() == robot).peekable();
        if own.peek().is_none() && known.iter().all(|wait| is_kept(&wait)) {
            return known.into();
        }
        let at = |region: &RouteRegion| region.robots.map(|robot| self.way(robot).1);
        let own = own.filter_map(|(place, region)| RegionWait::of(region, Some(place), at(region)));
        let mut row: Vec<RegionWait<'t>> = known.iter().filter(is_kept).copied().chain(own).collect();
        sort(&mut row);
        row.into()
    }

    /// Expected times of the robots, or the robots that would wait for ever; an empty list if too many robots would have to be
    /// advanced.
    pub(super) fn forecast(&self) -> Result<Forecast, Vec<DeadlockedRobot>> {
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

    /// Robots that keep the timetable but would have to wait longer for an advanced robot.
    fn delayed(&self, timetable: &Timetable, forecast: &Forecast) -> Vec<usize> {
        let mut is_known = vec![false; self.robots.len()];
        forecast.robots.iter().for_each(|&robot| is_known[robot] = true);
        let mut found = Vec::new();
        for (&robot, line) in forecast.robots.iter().zip(&forecast.lines) {
            let mut look = |region: &RouteRegion| {
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
                _ if line.is_later(&timetable.lines[robot]) => {
                    let is_kept = |region: &&RouteRegion| self.changed.is_none_or(|it| !region.robots.contains(&it.0));
                    self.waits.regions(robot).filter(is_kept).for_each(&mut look);
                }
                _ => {}
            }
        }
        found
    }

    /// Advances some robots from gate to gate.
    fn taken(&self, robots: Vec<usize>) -> Result<Forecast, Vec<DeadlockedRobot>> {
        let mut places = vec![NONE; self.robots.len()];
        let mut taken: Vec<AdvancingRobot<'t>> = Vec::with_capacity(robots.len());
        for (place, &robot) in robots.iter().enumerate() {
            places[robot] = place as u32;
            let changed =
                self.changed.filter(|changed| changed.0 == robot).map(|(_, way, at, departs, _)| (way, at, departs));
            let start = self.robots[robot].progress(changed, self.time);
            taken.push(AdvancingRobot::new(
                Timeline::new(start, self.time),
                self.row(robot),
                self.way(robot).0.length(),
            ));
        }
        let mut waiting: Vec<Vec<usize>> = vec![Vec::new(); robots.len()];
        let mut open: Vec<usize> = (0..robots.len()).collect();
        while let Some(place) = open.pop() {
            let before = taken[place].steps;
            while let Some((first, timed, is_left)) = taken[place].ahead() {
                let opens = match (places[first], self.kept) {
                    (NONE, Some((timetable, _))) => Some(timetable.lines[first].opens(&timed, self.time)),
                    (first, _) => {
                        let first = &taken[first as usize];
                        let is_known = timed.gate.required_position <= first.known();
                        is_known.then(|| first.line.from(timed.opening_time, timed.gate.required_position, self.time))
                    }
                };
                match (opens, is_left) {
                    (Some(opens), false) => {
                        let lost = self.robots[robots[place]].abilities.stop();
                        taken[place].wait(opens, lost);
                    }
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
        let stuck: Vec<DeadlockedRobot> =
            robots.iter().zip(&taken).filter_map(|(&robot, taken)| taken.stuck(robot)).collect();
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

/// A robot that is advanced from gate to gate.
struct AdvancingRobot<'r> {
    line: Timeline,
    /// The regions that it passes second, the nearest first, and the number of these that it has reached.
    regions: Cow<'r, [RegionWait<'r>]>,
    met: usize,
    /// Reached regions at which it may have to wait, with the gates that are still ahead.
    open: Vec<RegionWait<'r>>,
    /// Length of the nearest of these gates, infinite if there is none; and the index of its region.
    nearest: (f64, usize),
    length: f64,
    /// Number of gates and regions that it has passed.
    steps: usize,
}

impl<'r> AdvancingRobot<'r> {
    fn new(line: Timeline, regions: Cow<'r, [RegionWait<'r>]>, length: f64) -> Self {
        Self { line, regions, met: 0, open: Vec::new(), nearest: (f64::INFINITY, 0), length, steps: 0 }
    }

    /// The nearest region that it has not reached.
    #[inline]
    fn region(&self) -> Option<&RegionWait<'r>> {
        self.regions.get(self.met)
    }

    /// Whether a region comes before the next gate.
    #[inline]
    fn meets(&self) -> bool {
        self.region().is_some_and(|wait| wait.ends[0].gate.wait_position < self.nearest.0)
    }

    /// The nearest gate, and its region.
    #[inline]
    fn gate(&self) -> Option<(&RegionWait<'r>, &'r TimedGate)> {
        let wait = self.open.get(self.nearest.1)?;
        Some((wait, wait.gates.first()?))
    }

    /// Finds the nearest gate; of several at the same length that of the region that was reached last.
    #[inline]
    fn find_next_gate(&mut self) {
        self.nearest = (f64::INFINITY, 0);
        for (place, wait) in self.open.iter().enumerate() {
            let at = wait.gates[0].gate.wait_position;
            if at <= self.nearest.0 {
                self.nearest = (at, place);
            }
        }
    }

    /// What is nearest ahead: the first robot there, the gate, and whether it is a region; for a region the gate is its last
    /// one, which tells when the first has left.
    #[inline]
    fn ahead(&self) -> Option<(usize, TimedGate, bool)> {
        if self.next() >= self.length {
            return None;
        }
        match (self.meets(), self.region(), self.gate()) {
            (true, Some(wait), _) => Some((wait.first, wait.ends[1], true)),
            (_, _, Some((wait, timed))) => Some((wait.first, *timed, false)),
            _ => None,
        }
    }

    /// Length of the nearest gate or region ahead.
    #[inline]
    fn next(&self) -> f64 {
        let region = self.region().map_or(f64::INFINITY, |wait| wait.ends[0].gate.wait_position);
        self.nearest.0.min(region)
    }

    /// Length up to which its times are known.
    fn known(&self) -> f64 {
        let next = self.next();
        if next < self.length { next - 2.0 * SHORT } else { self.length }
    }

    /// Reaches a region. `left` is when the first leaves it, if known: its gates count unless the first has left by then.
    fn meet(&mut self, left: Option<f64>) {
        let Some(&wait) = self.region() else { return };
        self.met += 1;
        self.steps += 1;
        if left.is_some_and(|left| self.line.comes(wait.ends[0].arrival_time) >= left) {
            return;
        }
        self.open.push(wait);
        self.find_next_gate();
    }

    /// Passes a gate that opens at `opens`.
    fn wait(&mut self, opens: f64, lost: f64) {
        let Some((wait, timed)) = self.gate() else { return };
        let left = &wait.gates[1..];
        self.steps += 1;
        self.line.wait(timed.gate.wait_position, timed.arrival_time, opens, lost);
        match left {
            [] => drop(self.open.remove(self.nearest.1)),
            _ => self.open[self.nearest.1].gates = left,
        }
        self.find_next_gate();
    }

    fn stuck(&self, robot: usize) -> Option<DeadlockedRobot> {
        let (_, _, is_left) = self.ahead()?;
        self.gate().filter(|_| !is_left).map(|(wait, _)| DeadlockedRobot { robot, region: wait.changed_region })
    }
}
