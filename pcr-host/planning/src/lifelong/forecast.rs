//! Whether everybody can finish under some orders, and about when: robots are taken from gate to gate, each as soon as what it waits
//! for has happened. Whoever is left has to wait for ever.

use super::book::{Book, Region};
use super::gates::Gate;
use super::robot::{Abilities, Robot, SHORT};
use super::way::Way;

/// What is looked at: the fleet, one of its robots on another way.
#[derive(Clone, Copy)]
pub(super) struct Trial<'t> {
    pub(super) robots: &'t [Robot],
    pub(super) book: &'t Book,
    pub(super) abilities: &'t Abilities,
    pub(super) time: f64,
    /// The robot, its way, where it is on it, when it sets off, and its regions.
    pub(super) changed: Option<(usize, &'t Way, f64, f64, &'t [Region])>,
}

/// When a robot would be where.
#[derive(Clone, Debug, Default)]
struct Timeline {
    /// Time of its way at which it is now \[s\].
    start: f64,
    /// Lengths beyond which it is later, and by how much in all \[m, s\].
    delays: Vec<(f64, f64)>,
}

/// A gate on a way, and whom it is about.
#[derive(Clone, Copy)]
struct Wait {
    gate: Gate,
    first: usize,
    /// Its place among the regions of the robot that has another way.
    region: Option<usize>,
}

/// When robots would be where.
#[derive(Clone, Debug, Default)]
pub(super) struct Forecast {
    lines: Vec<Timeline>,
    /// Sum of the times until goals are reached, and a little of those until all stand \[s\].
    pub(super) cost: f64,
}

/// A robot that waits for ever.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Stuck {
    pub(super) robot: usize,
    pub(super) by: usize,
    /// Place of the region among those of the robot that has another way.
    pub(super) region: Option<usize>,
}

/// What an end counts beside a goal.
const TAIL: f64 = 0.1;

impl<'t> Trial<'t> {
    fn way(&self, robot: usize) -> (&'t Way, f64) {
        match self.changed {
            Some((changed, way, at, ..)) if changed == robot => (way, at),
            _ => (&self.robots[robot].way, self.robots[robot].at),
        }
    }

    /// The gates that a robot has still to pass, the nearest first.
    fn waits(&self, robot: usize, into: &mut Vec<Wait>) {
        let (_, at) = self.way(robot);
        let mut add = |region: &Region, place: Option<usize>| {
            if region.second() != robot {
                return;
            }
            let first = region.robots[region.first];
            let (_, there) = self.way(first);
            let sides = if region.first == 0 { [there, at] } else { [at, there] };
            if region.is_over(sides) {
                return;
            }
            let gates = region.gates();
            let passed = gates.partition_point(|gate| gate.needs <= there);
            into.extend(gates[passed..].iter().map(|&gate| Wait { gate, first, region: place }));
        };
        let changed = self.changed.map(|(changed, ..)| changed);
        if changed != Some(robot) {
            let kept = |region: &&Region| changed.is_none_or(|changed| !region.robots.contains(&changed));
            self.book.row(robot).filter(kept).for_each(|region| add(region, None));
        }
        for (place, region) in self.changed.iter().flat_map(|(.., regions)| regions.iter().enumerate()) {
            add(region, Some(place));
        }
        into.sort_unstable_by(|a, b| a.gate.at.total_cmp(&b.gate.at));
    }

    /// When all would be where, or those that would wait for ever.
    pub(super) fn forecast(&self) -> Result<Forecast, Vec<Stuck>> {
        let count = self.robots.len();
        let mut lines: Vec<Timeline> = Vec::with_capacity(count);
        let mut waits: Vec<Wait> = Vec::new();
        let mut ranges = Vec::with_capacity(count);
        let mut own = Vec::new();
        for robot in 0..count {
            let (way, at) = self.way(robot);
            let it = &self.robots[robot];
            let departs = match self.changed {
                Some((changed, _, _, departs, _)) if changed == robot => departs,
                _ => it.departs,
            };
            let late = (departs - self.time).max(it.stopped_until - self.time).max(0.0);
            lines.push(Timeline { start: way.time(at) - late, delays: Vec::new() });
            self.waits(robot, &mut own);
            ranges.push((waits.len(), waits.len() + own.len()));
            waits.append(&mut own);
        }
        // The next gate of each robot, and who waits for it to go on.
        let mut next: Vec<usize> = ranges.iter().map(|range| range.0).collect();
        let mut waiting: Vec<Vec<usize>> = vec![Vec::new(); count];
        let mut open: Vec<usize> = (0..count).collect();
        let lost = self.abilities.stop();
        while let Some(robot) = open.pop() {
            let (way, _) = self.way(robot);
            let before = next[robot];
            while next[robot] < ranges[robot].1 {
                let Wait { gate, first, .. } = waits[next[robot]];
                if gate.at >= way.length() {
                    next[robot] = ranges[robot].1;
                    break;
                }
                let there = self.way(first).0;
                let known = match waits[next[first]..ranges[first].1].first() {
                    Some(wait) => wait.gate.at.min(there.length()) - 2.0 * SHORT,
                    None => there.length(),
                };
                if gate.needs > known {
                    waiting[first].push(robot);
                    break;
                }
                let opens = lines[first].time(there, gate.needs);
                let comes = lines[robot].time(way, gate.at.max(0.0));
                if opens > comes {
                    let so_far = lines[robot].delays.last().map_or(0.0, |delay| delay.1);
                    let wait = opens - comes;
                    lines[robot].delays.push((gate.at, so_far + wait + 0.5 * lost.min(wait)));
                }
                next[robot] += 1;
            }
            if next[robot] > before {
                open.append(&mut waiting[robot]);
            }
        }
        let stuck: Vec<Stuck> = (0..count)
            .filter(|&robot| next[robot] < ranges[robot].1)
            .map(|robot| {
                let Wait { first, region, .. } = waits[next[robot]];
                Stuck { robot, by: first, region }
            })
            .collect();
        if !stuck.is_empty() {
            return Err(stuck);
        }
        let cost = (0..count).map(|robot| {
            let way = self.way(robot).0;
            let goal = way.goal.map_or(0.0, |goal| lines[robot].time(way, goal));
            goal + TAIL * lines[robot].time(way, way.length())
        });
        let cost = cost.sum();
        Ok(Forecast { lines, cost })
    }
}

impl Timeline {
    fn time(&self, way: &Way, length: f64) -> f64 {
        let late = self.delays.partition_point(|delay| delay.0 < length).checked_sub(1);
        (way.time(length) - self.start).max(0.0) + late.map_or(0.0, |k| self.delays[k].1)
    }
}

impl Forecast {
    /// When a robot is at a length of its way, from now \[s\].
    pub(super) fn time(&self, robot: usize, way: &Way, length: f64) -> f64 {
        self.lines[robot].time(way, length.min(way.length()))
    }
}
