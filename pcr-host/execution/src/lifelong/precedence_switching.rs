//! Orders that are reversed while robots are on their ways, because a robot waits for another one that is late.

use super::forecast::Forecast;
use super::gates::authority;
use super::planning_context::PlanningContext;
use super::precedence_search::PrecedenceSearch;
use super::region_table::RouteRegion;
use super::region_waits::FleetWaits;
use super::timetable::Timeline;
use std::cell::Cell;

/// Largest number of forecasts for one switch.
const FORECASTS: usize = 6;

/// The orders of a robot that are reversed.
#[derive(Debug)]
pub(super) struct PrecedenceSwitch {
    /// Indices of regions, and the robot that now goes first there.
    pub(super) firsts: Vec<(usize, usize)>,
    /// New timelines of the robots whose times change.
    pub(super) lines: Vec<(usize, Timeline)>,
}

impl PlanningContext<'_> {
    /// Lets a robot of a large fleet go first where it waits, if it can and all together are expected to arrive sooner by `gain` \[s\].
    pub(super) fn switched(&self, robot: usize, waits: &FleetWaits<'_>, gain: f64) -> Option<PrecedenceSwitch> {
        let timetable = self.timetable?;
        let it = &self.robots[robot];
        let (places, mut regions): (Vec<usize>, Vec<RouteRegion>) = self.book.seen_by(robot).unzip();
        let held = |region: &RouteRegion| match region.first {
            1 => authority(region.gates(), self.robots[region.robots[1]].at),
            _ => f64::INFINITY,
        };
        let holds: Vec<f64> = regions.iter().map(held).collect();
        let nearest = (0..regions.len()).min_by(|&a, &b| holds[a].total_cmp(&holds[b]))?;
        if holds[nearest] > it.at + it.abilities.braking(it.abilities.speed) {
            return None;
        }
        let (base, taken) = (&timetable.lines[..], &self.waiting_for(robot)[..]);
        let cost = base[robot].cost(&it.way, self.time, self.earlier());
        let budget = &Cell::new(FORECASTS);
        let [at, stop] = [it.at, it.stop()];
        let case = PrecedenceSearch { scene: self, base, waits, taken, robot, way: &it.way, at, stop, budget };
        let mut open: Vec<bool> = regions.iter().map(|region| case.sides(region) == [true; 2]).collect();
        if !open[nearest] {
            return None;
        }
        open[nearest] = false;
        let before: Vec<usize> = regions.iter().map(|region| region.first).collect();
        regions[nearest].first = 0;
        let Forecast { robots, lines, cost: found } = case.repaired(&mut regions, &open)?;
        if found + gain > cost {
            return None;
        }
        let changed = (0..regions.len()).filter(|&k| regions[k].first != before[k]);
        let firsts = changed.map(|k| (places[k], regions[k].robots[regions[k].first])).collect();
        Some(PrecedenceSwitch { firsts, lines: robots.into_iter().zip(lines).collect() })
    }
}
