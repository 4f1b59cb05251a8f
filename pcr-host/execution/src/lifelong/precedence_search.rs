//! Finds orders on the way of one robot: by forecast; repaired if a robot would wait for ever; reversed if all arrive
//! sooner then.

use super::forecast::{DeadlockedRobot, Forecast, ForecastInput};
use super::gates::TimedGate;
use super::planning_context::PlanningContext;
use super::region_table::RouteRegion;
use super::region_waits::FleetWaits;
use super::route::Route;
use super::timetable::Timeline;
use std::cell::Cell;

/// Largest number of orders that are reversed in search of better ones; and the number that is reversed even if the decision has taken
/// long already.
const TURNS: usize = 16;
const LEAST_TURNS: usize = 4;

/// The second of these numbers, in a large fleet.
const FEW_TURNS: usize = 1;

/// Largest number of orders that are reversed if a robot would wait for ever.
const REPAIRS: usize = 12;

/// Step of the start delay of a robot \[s\], and largest number of steps.
const DELAYS: (f64, u32) = (2.0, 60);

/// A way of a robot for which orders are searched.
pub(super) struct PrecedenceSearch<'c, 'w> {
    pub(super) scene: &'c PlanningContext<'c>,
    /// Timelines of the other robots without this one.
    pub(super) base: &'c [Timeline],
    pub(super) waits: &'c FleetWaits<'w>,
    /// Robots that are advanced in any case, if not all are.
    pub(super) taken: &'c [usize],
    pub(super) robot: usize,
    pub(super) way: &'c Route,
    pub(super) at: f64,
    pub(super) stop: f64,
    /// Number of forecasts that may still be made.
    pub(super) budget: &'c Cell<usize>,
}

impl PrecedenceSearch<'_, '_> {
    pub(super) fn forecast(&self, regions: &[RouteRegion], departs: f64) -> Result<Forecast, Vec<DeadlockedRobot>> {
        let PlanningContext { robots, time, .. } = *self.scene;
        let changed = Some((self.robot, self.way, self.at, departs, regions));
        let kept = self.scene.timetable.map(|timetable| (timetable, self.taken));
        let earlier = self.scene.earlier();
        ForecastInput { robots, waits: self.waits, time, changed, earlier, kept }.forecast()
    }

    /// Whether the robot, and whether the other one, can go first at a region.
    pub(super) fn sides(&self, region: &RouteRegion) -> [bool; 2] {
        let other = &self.scene.robots[region.robots[1]];
        let at = [self.at, other.at];
        let stop = [self.stop, other.stop()];
        let lengths = [self.way.length(), other.way.length()];
        [0, 1].map(|first| region.can_be_first(first, at, stop, lengths))
    }

    /// Orders by forecast; repaired, and improved by reversing.
    pub(super) fn ordered(&self, mut regions: Vec<RouteRegion>, shift: f64) -> Option<(Vec<RouteRegion>, Forecast)> {
        regions.sort_by(|a, b| a.hull[0].lo.total_cmp(&b.hull[0].lo));
        let mut open = Vec::with_capacity(regions.len());
        let mut late = shift;
        for region in &mut regions {
            let sides = self.sides(region);
            let (ahead, behind) = self.waits(region, late);
            region.first = match sides {
                [true, true] => usize::from(ahead >= behind),
                [true, false] => 0,
                [false, true] => 1,
                [false, false] => return None,
            };
            if region.first == 1 {
                late += behind;
            }
            open.push(sides == [true, true]);
        }
        let forecast = self.repaired(&mut regions, &open)?;
        Some((regions, forecast))
    }

    /// Reverses orders if the robots together are expected to arrive sooner.
    pub(super) fn improved(
        &self,
        mut regions: Vec<RouteRegion>,
        mut forecast: Forecast,
    ) -> (Vec<RouteRegion>, Forecast) {
        let least = if self.scene.timetable.is_some() { FEW_TURNS } else { LEAST_TURNS };
        let mut turns = 0;
        for k in 0..regions.len() {
            let (ahead, behind) = self.waits(&regions[k], 0.0);
            if turns >= least && self.budget.get() == 0 {
                break;
            }
            let free = if regions[k].first == 0 { ahead == 0.0 } else { behind == 0.0 };
            if turns >= TURNS || free || self.sides(&regions[k]) != [true; 2] {
                continue;
            }
            turns += 1;
            self.budget.set(self.budget.get().saturating_sub(1));
            regions[k].first = 1 - regions[k].first;
            match self.forecast(&regions, self.scene.time) {
                Ok(other) if other.cost < forecast.cost => forecast = other,
                _ => regions[k].first = 1 - regions[k].first,
            }
        }
        (regions, forecast)
    }

    /// Time that the other robot would wait if this one went first, and that this one would wait otherwise; it is `late`
    /// already \[s\].
    fn waits(&self, region: &RouteRegion, late: f64) -> (f64, f64) {
        let now = self.way.time(self.at) - late;
        let (other, time) = (&self.base[region.robots[1]], self.scene.time);
        let theirs = |timed: &TimedGate| other.from(timed.arrival_time, timed.gate.wait_position, time);
        let own = |timed: &TimedGate| (timed.arrival_time - now).max(late);
        (
            longest(region.gates_of(1), |timed| timed.opening_time - now, theirs),
            longest(
                region.gates_of(0),
                |timed| other.from(timed.opening_time, timed.gate.required_position, time),
                own,
            ),
        )
    }

    /// Reverses orders until no robot waits for ever. The last attempt lets all others go first.
    pub(super) fn repaired(&self, regions: &mut [RouteRegion], open: &[bool]) -> Option<Forecast> {
        let mut tried = vec![false; regions.len()];
        for _ in 0..REPAIRS {
            match (self.budget.get(), self.scene.timetable) {
                (0, None) => return None,
                // The attempt that lets all others go first is made in any case.
                (0, Some(_)) => break,
                _ => {}
            }
            self.budget.set(self.budget.get() - 1);
            let stuck = match self.forecast(regions, self.scene.time) {
                Ok(forecast) => return Some(forecast),
                Err(stuck) => stuck,
            };
            let mendable = |first: usize| {
                let places = stuck.iter().filter_map(|stuck| stuck.region);
                places.into_iter().find(|&place| open[place] && !tried[place] && regions[place].first == first)
            };
            let Some(place) = mendable(0).or_else(|| mendable(1)) else { break };
            tried[place] = true;
            regions[place].first = 1 - regions[place].first;
        }
        for (region, open) in regions.iter_mut().zip(open) {
            if *open {
                region.first = 1;
            }
        }
        self.forecast(regions, self.scene.time).ok()
    }

    /// The least start delay with which the robot waits for no other robot and none for it, if all keep their expected times.
    pub(super) fn delayed(&self, mut regions: Vec<RouteRegion>) -> Option<(Vec<RouteRegion>, f64, Forecast)> {
        'delays: for k in 0..DELAYS.1 {
            let late = DELAYS.0 * f64::from(k);
            for region in &mut regions {
                let (ahead, behind) = self.waits(region, late);
                let sides = self.sides(region);
                region.first = match (sides[0] && ahead <= 0.0, sides[1] && behind <= 0.0) {
                    (true, _) => 0,
                    (false, true) => 1,
                    (false, false) => continue 'delays,
                };
            }
            let departs = self.scene.time + late;
            if let Ok(forecast) = self.forecast(&regions, departs) {
                return Some((regions, departs, forecast));
            }
        }
        None
    }
}

/// The longest wait at some gates, by the times at which they open and at which the second robot comes.
fn longest(gates: &[TimedGate], opens: impl Fn(&TimedGate) -> f64, comes: impl Fn(&TimedGate) -> f64) -> f64 {
    // No wait if the last gate is open before the second robot comes to the first one.
    let (Some(head), Some(last)) = (gates.first(), gates.last()) else { return 0.0 };
    if opens(last) <= comes(head) {
        return 0.0;
    }
    gates.iter().map(|timed| opens(timed) - comes(timed)).fold(0.0, f64::max)
}
