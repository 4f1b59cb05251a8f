//! Whether everybody can finish under some orders, and about when: robots are taken from gate to gate, each as soon as what it waits
//! for has happened. Whoever is left has to wait for ever.

use super::abilities::Abilities;
use super::book::{Book, Region};
use super::gates::Timed;
use super::robot::{Robot, SHORT};
use super::way::Way;

/// What is looked at: the fleet, one of its robots on another way.
#[derive(Clone, Copy)]
pub(super) struct Trial<'t> {
    pub(super) robots: &'t [Robot],
    /// Without those of the robot that has another way.
    pub(super) waits: &'t Waits,
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
#[derive(Clone, Copy, Debug)]
struct Wait {
    timed: Timed,
    first: usize,
    /// Its place among the regions of the robot that has another way.
    region: Option<usize>,
}

/// The gates that robots have still to pass, the nearest first.
#[derive(Clone, Debug, Default)]
pub(super) struct Waits(Vec<Vec<Wait>>);

impl Waits {
    /// By the orders of the fleet, those of one robot left out.
    pub(super) fn of(robots: &[Robot], book: &Book, without: Option<usize>) -> Self {
        let all = (0..robots.len()).map(|robot| {
            let mut waits = Vec::new();
            let kept = |region: &&Region| without.is_none_or(|without| !region.robots.contains(&without));
            for region in book.row(robot).filter(|region| region.second() == robot).filter(kept) {
                add(region, None, region.robots.map(|robot| robots[robot].at), &mut waits);
            }
            sort(&mut waits);
            waits
        });
        Self(all.collect())
    }

    /// How many there are: what a forecast costs.
    pub(super) fn len(&self) -> usize {
        self.0.iter().map(Vec::len).sum()
    }
}

/// The gates of a region that the second has still to pass.
fn add(region: &Region, place: Option<usize>, at: [f64; 2], into: &mut Vec<Wait>) {
    if region.is_over(at) {
        return;
    }
    let (gates, first) = (region.gates(), region.robots[region.first]);
    let passed = gates.partition_point(|timed| timed.gate.needs <= at[region.first]);
    into.extend(gates[passed..].iter().map(|&timed| Wait { timed, first, region: place }));
}

fn sort(waits: &mut [Wait]) {
    // Made of runs that are in order: stable sorting makes use of that.
    waits.sort_by(|a, b| a.timed.gate.at.total_cmp(&b.timed.gate.at));
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
    /// Place of the region at which it does, among those of the robot that has another way.
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

    /// Adds the gates of a robot.
    fn gates(&self, robot: usize, into: &mut Vec<Wait>) {
        let from = into.len();
        let known = self.waits.0.get(robot).map_or(&[][..], Vec::as_slice);
        into.extend_from_slice(known);
        let regions = self.changed.iter().flat_map(|(.., regions)| regions.iter().enumerate());
        for (place, region) in regions.filter(|(_, region)| region.second() == robot) {
            add(region, Some(place), region.robots.map(|robot| self.way(robot).1), into);
        }
        if into.len() > from + known.len() {
            sort(&mut into[from..]);
        }
    }

    /// When all would be where, or those that would wait for ever.
    pub(super) fn forecast(&self) -> Result<Forecast, Vec<Stuck>> {
        let count = self.robots.len();
        let mut lines: Vec<Timeline> = Vec::with_capacity(count);
        let mut waits: Vec<Wait> = Vec::new();
        let mut ranges = Vec::with_capacity(count);
        for robot in 0..count {
            let it = &self.robots[robot];
            let changed =
                self.changed.filter(|changed| changed.0 == robot).map(|(_, way, at, departs, _)| (way, at, departs));
            let start = it.progress(changed, self.time, self.abilities);
            lines.push(Timeline { start, delays: Vec::new() });
            let from = waits.len();
            self.gates(robot, &mut waits);
            ranges.push((from, waits.len()));
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
                let Wait { timed: Timed { gate, comes, opens }, first, .. } = waits[next[robot]];
                if gate.at >= way.length() {
                    next[robot] = ranges[robot].1;
                    break;
                }
                let there = self.way(first).0;
                let known = match waits[next[first]..ranges[first].1].first() {
                    Some(wait) => wait.timed.gate.at.min(there.length()) - 2.0 * SHORT,
                    None => there.length(),
                };
                if gate.needs > known {
                    waiting[first].push(robot);
                    break;
                }
                let so_far = lines[robot].delays.last().map_or(0.0, |delay| delay.1);
                let comes = (comes - lines[robot].start).max(0.0) + so_far;
                let opens = (opens - lines[first].start).max(0.0) + lines[first].late(gate.needs);
                if opens > comes {
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
                let Wait { region, .. } = waits[next[robot]];
                Stuck { region }
            })
            .collect();
        if !stuck.is_empty() {
            return Err(stuck);
        }
        let cost = (0..count).map(|robot| {
            let way = self.way(robot).0;
            let goals: f64 = way.goals.iter().map(|&goal| lines[robot].time(way, goal)).sum();
            goals + TAIL * lines[robot].time(way, way.length())
        });
        let cost = cost.sum();
        Ok(Forecast { lines, cost })
    }
}

impl Timeline {
    fn time(&self, way: &Way, length: f64) -> f64 {
        (way.time(length) - self.start).max(0.0) + self.late(length)
    }

    /// By how much it is later at a length \[s\].
    fn late(&self, length: f64) -> f64 {
        let last = self.delays.partition_point(|delay| delay.0 < length).checked_sub(1);
        last.map_or(0.0, |last| self.delays[last].1)
    }
}

impl Forecast {
    /// When a robot is at a length of its way, which it would be at at this time of its way, from now \[s\].
    pub(super) fn from(&self, robot: usize, time: f64, length: f64) -> f64 {
        let line = &self.lines[robot];
        (time - line.start).max(0.0) + line.late(length)
    }
}
