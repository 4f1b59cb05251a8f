//! Whether everybody can finish under some orders, and about when: robots are taken from gate to gate, each as soon as what it waits
//! for has happened. Whoever is left has to wait for ever.
//!
//! In a large fleet only those are taken that something changes for. The others keep to the timetable, which shows that all can finish.

use super::abilities::Abilities;
use super::book::Region;
use super::gates::Timed;
use super::robot::{Robot, SHORT};
use super::timetable::{Timeline, Timetable};
use super::waits::{Wait, Waits, add, sort};
use super::way::Way;

/// What is looked at: the fleet, one of its robots on another way.
#[derive(Clone, Copy)]
pub(super) struct Trial<'t> {
    pub(super) robots: &'t [Robot],
    /// Without those of the robot that has another way.
    pub(super) waits: &'t Waits<'t>,
    pub(super) abilities: &'t Abilities,
    pub(super) time: f64,
    /// The robot, its way, where it is on it, when it sets off, and its regions.
    pub(super) changed: Option<(usize, &'t Way, f64, f64, &'t [Region])>,
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

/// Robots that are taken at most; smaller fleets are taken whole.
pub(super) const MOST: usize = 64;

/// In no set of robots.
const NONE: u32 = u32::MAX;

impl<'t> Trial<'t> {
    fn way(&self, robot: usize) -> (&'t Way, f64) {
        match self.changed {
            Some((changed, way, at, ..)) if changed == robot => (way, at),
            _ => (&self.robots[robot].way, self.robots[robot].at),
        }
    }

    fn is_changed(&self, robot: usize) -> bool {
        self.changed.is_some_and(|changed| changed.0 == robot)
    }

    /// Adds the gates of a robot.
    fn gates(&self, robot: usize, into: &mut Vec<Wait>) {
        let from = into.len();
        let known = self.waits.row(robot);
        into.extend_from_slice(known);
        let regions = self.changed.iter().flat_map(|(.., regions)| regions.iter().enumerate());
        for (place, region) in regions.filter(|(_, region)| region.second() == robot) {
            add(region, Some(place), region.robots.map(|robot| self.way(robot).1), into);
        }
        if into.len() > from + known.len() {
            sort(&mut into[from..]);
        }
    }

    /// When robots would be where, or those that would wait for ever; nobody in particular where too many would have to be taken.
    pub(super) fn forecast(&self) -> Result<Forecast, Vec<Stuck>> {
        let Some((timetable, some)) = self.kept else { return self.taken((0..self.robots.len()).collect()) };
        let mut taken = some.to_vec();
        loop {
            let forecast = self.taken(std::mem::take(&mut taken))?;
            let late = self.delayed(timetable, &forecast);
            if late.is_empty() {
                return Ok(forecast);
            }
            taken = forecast.robots;
            taken.extend(late);
            if taken.len() > MOST {
                return Err(Vec::new());
            }
        }
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
                if !region.is_over(at) && timetable.is_broken(region, line, self.time, at[region.first], self.way(second).0) {
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
        let count = robots.len();
        let mut places = vec![NONE; self.robots.len()];
        let mut lines: Vec<Timeline> = Vec::with_capacity(count);
        let mut waits: Vec<Wait> = Vec::new();
        let mut ranges = Vec::with_capacity(count);
        for (place, &robot) in robots.iter().enumerate() {
            places[robot] = place as u32;
            let it = &self.robots[robot];
            let changed =
                self.changed.filter(|changed| changed.0 == robot).map(|(_, way, at, departs, _)| (way, at, departs));
            let start = it.progress(changed, self.time, self.abilities);
            lines.push(Timeline::new(start, self.time));
            let from = waits.len();
            self.gates(robot, &mut waits);
            ranges.push((from, waits.len()));
        }
        // The next gate of each robot, and who waits for it to go on.
        let mut next: Vec<usize> = ranges.iter().map(|range| range.0).collect();
        let mut waiting: Vec<Vec<usize>> = vec![Vec::new(); count];
        let mut open: Vec<usize> = (0..count).collect();
        let lost = self.abilities.stop();
        while let Some(place) = open.pop() {
            let (way, _) = self.way(robots[place]);
            let before = next[place];
            while next[place] < ranges[place].1 {
                let Wait { timed, first, .. } = waits[next[place]];
                let Timed { gate, comes, opens } = timed;
                if gate.at >= way.length() {
                    next[place] = ranges[place].1;
                    break;
                }
                let there = self.way(first).0;
                let opens = match (places[first], self.kept) {
                    (NONE, Some((timetable, _))) => timetable.lines[first].opens(&timed, self.time),
                    (first, _) => {
                        let first = first as usize;
                        let known = match waits[next[first]..ranges[first].1].first() {
                            Some(wait) => wait.timed.gate.at.min(there.length()) - 2.0 * SHORT,
                            None => there.length(),
                        };
                        if gate.needs > known {
                            waiting[first].push(place);
                            break;
                        }
                        lines[first].from(opens, gate.needs, self.time)
                    }
                };
                lines[place].wait(gate.at, comes, opens, lost);
                next[place] += 1;
            }
            if next[place] > before {
                open.append(&mut waiting[place]);
            }
        }
        let stuck: Vec<Stuck> = (0..count)
            .filter(|&place| next[place] < ranges[place].1)
            .map(|place| Stuck { region: waits[next[place]].region })
            .collect();
        if !stuck.is_empty() {
            return Err(stuck);
        }
        let cost = robots.iter().zip(&lines).map(|(&robot, line)| {
            let way = self.way(robot).0;
            let planned = match self.kept {
                Some((timetable, _)) if !self.is_changed(robot) => timetable.lines[robot].cost(way, self.time),
                _ => 0.0,
            };
            line.cost(way, self.time) - planned
        });
        let cost = cost.sum();
        Ok(Forecast { robots, lines, cost })
    }
}
